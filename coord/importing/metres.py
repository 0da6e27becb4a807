"""Whether coordinates are metres, and where their origin is."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

#: [1] No floor in metres is smaller than this, and a site in degrees larger would be more than 50 km wide.
_SMALLEST_FLOOR = 0.5

#: [m] Farther from the origin than this, coordinates are moved: they would be hard to read, and lose digits.
_FAR = 1e5

#: Words in the names of reference systems that count in degrees.
_DEGREES = ("CRS84", "EPSG::4326", "EPSG:4326", "EPSG::4258")


def fault_of_degrees(points: Sequence[tuple[float, float]], document: Mapping[str, Any], metres: bool) -> str:
    """Why coordinates are no metres, or nothing.

    GeoJSON counts in degrees of longitude and latitude unless it says otherwise, yet floor plans are drawn in
    metres. What all lies within half a degree, and could be longitude and latitude, is taken for degrees.
    """
    if metres or not points:
        return ""
    crs = document.get("crs")
    properties = crs.get("properties") if isinstance(crs, dict) else None
    name = str(properties.get("name", "")) if isinstance(properties, dict) else ""
    xs, ys = zip(*points, strict=True)
    is_small = max(max(xs) - min(xs), max(ys) - min(ys)) < _SMALLEST_FLOOR
    could_be = max(map(abs, xs)) <= 180 and max(map(abs, ys)) <= 90
    if any(word in name for word in _DEGREES) or (not name and is_small and could_be):
        return (
            "the coordinates look like degrees of longitude and latitude; project them to metres first "
            "(a local UTM zone, for instance), or say --metres if they are metres"
        )
    return ""


def origin_for(points: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """The place [m] that becomes the origin: (0, 0) unless that is far away."""
    xs, ys = zip(*points, strict=True)
    if max(map(abs, (*xs, *ys))) <= _FAR:
        return (0.0, 0.0)
    return (float(math.floor(min(xs))), float(math.floor(min(ys))))
