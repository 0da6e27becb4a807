"""Who can meet whom, where in the coordination plane, and when."""
