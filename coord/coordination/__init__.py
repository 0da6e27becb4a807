"""Who goes first, and the loop over all robots."""
