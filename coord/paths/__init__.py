"""The geometry of the way: shortest tangent paths round grown obstacles."""
