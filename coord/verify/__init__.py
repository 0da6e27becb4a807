"""The independent checker: standard library only, imports nothing of coord."""
