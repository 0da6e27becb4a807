"""Obstacles on the floor: circles and simple polygons, with holes where a map has rooms."""

from __future__ import annotations

import math
from dataclasses import dataclass

from coord.errors import InvalidValueError
from coord.model.arrays import Array, Point, frozen


@dataclass(frozen=True, slots=True)
class Circle:
    """A round obstacle, for instance a column; centre and radius [m]."""

    name: str
    center: Point
    radius: float

    def __post_init__(self) -> None:
        faults = []
        if not all(math.isfinite(value) for value in self.center):
            faults.append(("circle", f"the centre must be two finite numbers [m] (got {self.center})"))
        if not (math.isfinite(self.radius) and self.radius > 0):
            faults.append(("circle", f"the radius must be > 0 m (got {self.radius:g})"))
        if faults:
            raise InvalidValueError(faults)


@dataclass(frozen=True, slots=True, eq=False)
class Polygon:
    """An obstacle with straight edges: any simple polygon, concave too, with holes.

    Parameters
    ----------
    vertices : (n, 2) array [m], n >= 3, counter-clockwise, first vertex not repeated.
    holes : arrays like ``vertices``, clockwise: free floor enclosed by the obstacle.

    A polygon given clockwise is turned round. That a polygon is simple is checked where
    problems are read, by the geometry stage.
    """

    name: str
    vertices: Array
    holes: tuple[Array, ...] = ()

    def __post_init__(self) -> None:
        rings = [frozen(ring, 2) for ring in (self.vertices, *self.holes)]
        faults = [("polygon", fault) for ring in rings if (fault := _ring_fault(ring))]
        if faults:
            raise InvalidValueError(faults)
        rings = [ring if (signed_area(ring) > 0) == (k == 0) else frozen(ring[::-1], 2) for k, ring in enumerate(rings)]
        object.__setattr__(self, "vertices", rings[0])
        object.__setattr__(self, "holes", tuple(rings[1:]))

    def __reduce__(self) -> tuple[type[Polygon], tuple[object, ...]]:
        return (Polygon, (self.name, self.vertices, self.holes))

    @property
    def rings(self) -> tuple[Array, ...]:
        """The outline and the holes; the obstacle lies to the left of each."""
        return (self.vertices, *self.holes)


Obstacle = Circle | Polygon


def rectangle(name: str, bounds: tuple[float, float, float, float], angle: float = 0.0) -> Polygon:
    """A rectangle xmin, ymin, xmax, ymax [m], turned by ``angle`` [rad] about its centre."""
    xmin, ymin, xmax, ymax = bounds
    if not (xmin < xmax and ymin < ymax):
        text = f"a rectangle is [xmin, ymin, xmax, ymax] with xmin < xmax and ymin < ymax (got {list(bounds)})"
        raise InvalidValueError([("rectangle", text)])
    corners = [(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax)]
    if angle:
        cx, cy, c, s = (xmin + xmax) / 2, (ymin + ymax) / 2, math.cos(angle), math.sin(angle)
        corners = [(cx + c * (x - cx) - s * (y - cy), cy + s * (x - cx) + c * (y - cy)) for x, y in corners]
    return Polygon(name, frozen(corners, 2))


def signed_area(ring: Array) -> float:
    """Area [m2] of a ring (n, 2), positive when it runs counter-clockwise (the shoelace formula)."""
    # relative to the first vertex: far from the origin the products would lose the digits that matter
    x, y = ring[:, 0] - ring[0, 0], ring[:, 1] - ring[0, 1]
    return math.fsum((x * (y[[*range(1, len(y)), 0]] - y[[-1, *range(len(y) - 1)]])).tolist()) / 2


def _ring_fault(ring: Array) -> str | None:
    if len(ring) < 3:
        return f"a polygon needs at least 3 vertices (got {len(ring)})"
    if not all(math.isfinite(value) for value in ring.ravel().tolist()):
        return "all vertices must be finite numbers [m]"
    if signed_area(ring) == 0:
        return "a polygon must enclose an area > 0 m2 (got 0)"
    return None
