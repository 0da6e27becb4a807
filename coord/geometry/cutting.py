"""Polygons with holes into polygons without: a problem file has no word for a hole.

A polygon is cut along a vertical line through the middle of a hole, and each part again until no hole is left. The
parts meet along the cuts and cover the polygon; only where a slanted edge meets a cut is a corner rounded, to the
last digit of a double.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import shapely

from coord.geometry.shapes import Geometry
from coord.model.arrays import Array, frozen


def rings_fault(rings: Sequence[npt.ArrayLike]) -> str | None:
    """Why an outline and its holes, each (n, 2) [m], are no polygon, as a sentence, or None when they are."""
    for ring in rings:
        points = np.asarray(ring, dtype=np.float64).reshape(-1, 2)
        if not np.isfinite(points).all():
            return "all corners must be finite numbers"
        if len(np.unique(points, axis=0)) < 3:
            return "an outline needs at least 3 different corners"
    shape = _polygon(rings)
    if not shapely.is_valid(shape):
        reason = str(shapely.is_valid_reason(shape))
        place = re.search(r"\[(\S+) (\S+)\]", reason)
        where = f" at ({float(place[1]):.10g}, {float(place[2]):.10g})" if place else ""
        return f"the outlines are no polygon: {reason.partition('[')[0].lower()}{where}"
    return None


def simple_parts(rings: Sequence[npt.ArrayLike]) -> list[Array]:
    """Outlines (n, 2) [m] of simple polygons without holes that together are a polygon with its holes.

    Parameters
    ----------
    rings : the outline and then the holes, in either sense, of a polygon in which ``rings_fault`` finds no fault.
    """
    return [frozen(shapely.get_coordinates(part.exterior)[:-1], 2) for part in _without_holes(_polygon(rings))]


def rest_of_box(box: tuple[float, float, float, float], outlines: Sequence[Sequence[npt.ArrayLike]]) -> list[Array]:
    """What polygons (outline and holes each) leave of a box xmin, ymin, xmax, ymax [m], as outlines without holes."""
    rest = shapely.difference(shapely.box(*box), shapely.union_all([_polygon(rings) for rings in outlines]))
    parts = [part for polygon in _polygons(rest) for part in _without_holes(polygon)]
    return [frozen(shapely.get_coordinates(part.exterior)[:-1], 2) for part in parts]


def polygons_of_wkt(text: str) -> tuple[list[list[Array]], int]:
    """All polygons of a geometry in well-known text, each as its outline and holes (n, 2), and how many others it has.

    Raises
    ------
    ValueError
        When the text is no such geometry; the error says why.
    """
    try:
        with np.errstate(invalid="ignore"):  # numbers that are none are for ``rings_fault`` to tell
            geometry = shapely.from_wkt(text)
    except shapely.errors.ShapelyError as error:
        raise ValueError(" ".join(str(error).rpartition("Exception:")[2].split()) or "it cannot be read") from None
    parts = _flat(geometry)
    polygons = [part for part in parts if part.geom_type == "Polygon"]
    found = [
        [frozen(shapely.get_coordinates(ring)[:-1], 2) for ring in (part.exterior, *part.interiors)]
        for part in polygons
    ]
    return found, len(parts) - len(polygons)


def _flat(geometry: Geometry) -> list[Geometry]:
    """The single geometries in one, collections within collections too; empty ones left out."""
    if shapely.is_empty(geometry):
        return []
    if not hasattr(geometry, "geoms"):
        return [geometry]
    return [single for part in geometry.geoms for single in _flat(part)]


def _without_holes(polygon: Geometry) -> list[Geometry]:
    done, waiting = [], [polygon]
    while waiting:
        part = waiting.pop()
        if not part.interiors:
            done.append(part)
            continue
        xmin, ymin, xmax, ymax = part.bounds
        middles = [(ring.bounds[0] + ring.bounds[2]) / 2 for ring in part.interiors]
        cut = min(middles, key=lambda x: abs(x - (xmin + xmax) / 2))
        for box in (shapely.box(cut, ymin - 1, xmax + 1, ymax + 1), shapely.box(xmin - 1, ymin - 1, cut, ymax + 1)):
            waiting += _polygons(shapely.intersection(part, box))
    return done


def _polygons(geometry: Geometry) -> list[Geometry]:
    return [part for part in _flat(geometry) if part.geom_type == "Polygon" and part.area > 0]


def _polygon(rings: Sequence[npt.ArrayLike]) -> Geometry:
    outline, *holes = (np.asarray(ring, dtype=np.float64).reshape(-1, 2) for ring in rings)
    return shapely.Polygon(outline, holes)
