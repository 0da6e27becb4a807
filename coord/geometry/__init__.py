"""The door of shapely: growth of obstacles, distances, spatial indexes."""
