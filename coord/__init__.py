"""coord plans the motion of many robots on a floor, offline, and certifies every plan."""
