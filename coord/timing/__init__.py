"""One robot's velocity profile against those planned before it."""
