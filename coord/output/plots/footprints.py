"""Footprints to draw: at a place, along a path, and in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.patches import Circle, Patch, Polygon
from matplotlib.path import Path as Outline

from coord.geometry.shapes import hull_outlines
from coord.model.arrays import Array, Point
from coord.model.footprint import Footprint
from coord.model.path import Path
from coord.output.plan_file import footprint_words
from coord.output.plots.outlines import band, line


def drawn(footprint: Footprint, place: Point, heading: float) -> Patch:
    """A footprint at a place [m]; one that turns with the path lies along the heading [rad]."""
    if not footprint.vertices:
        return Circle(place, footprint.radius)
    (ring,) = posed(footprint, np.array([(*place, heading)]))
    return Polygon(ring, closed=True)


def posed(footprint: Footprint, poses: Array) -> Array:
    """The corners (n, m, 2) [m] of a polygon at poses (n, 3): x, y [m], heading [rad]."""
    corners = np.array(footprint.vertices)
    headings = poses[:, 2] if footprint.heading == "path" else np.zeros(len(poses))
    c, s = np.cos(headings)[:, None], np.sin(headings)[:, None]
    turned = np.stack([c * corners[:, 0] - s * corners[:, 1], s * corners[:, 0] + c * corners[:, 1]], axis=2)
    return np.asarray(poses[:, None, :2] + turned)


def swept(path: Path, footprint: Footprint) -> Outline:
    """The floor that a footprint covers on a path, as matplotlib draws it."""
    if not footprint.vertices:
        return compound([band(path, footprint.radius)])
    return compound(hull_outlines(posed(footprint, line(path))))


def compound(rings: Sequence[Array]) -> Outline:
    """One shape of closed rings (n, 2), holes in the opposite sense, as matplotlib draws it."""
    return Outline.make_compound_path(*(Outline(np.vstack([ring, ring[:1]]), closed=True) for ring in rings))


def extents(footprint: Footprint) -> tuple[float, float, float, float]:
    """How far planning takes a footprint to reach to the left, down, to the right and up of its centre [m]."""
    x, y = np.array(footprint.core).T
    margin = footprint.margin
    return margin - float(x.min()), margin - float(y.min()), margin + float(x.max()), margin + float(y.max())


def words(footprint: Footprint) -> str:
    """What keeps a centre away from obstacles, in words."""
    if not footprint.is_exact:
        return f"radius {footprint.radius:.3g} m" + (", as it turns," if footprint.vertices else "")
    left, down, right, up = extents(footprint)
    if "square" in footprint_words(footprint):
        return f"square of {left + right:.3g} m"
    return f"polygon of {left + right:.3g} x {down + up:.3g} m"
