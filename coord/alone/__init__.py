"""One robot on one path with nobody else: the fastest profile and its bounds."""
