"""Which places, segments and arcs keep the distance from grown obstacles: the tests behind the path search."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import shapely

from coord.geometry.growth import Grown
from coord.geometry.shapes import Geometry
from coord.model.arrays import Array

#: [m] Contact is no hit: a tangent touches the disc it leaves.
_TOUCH = 1e-9

#: [1] A cosine above 1 by less than this is a contact.
_GRAZE = 1e-9

#: [rad] Blocked stretches of a circle shorter than this come from rounding at a contact.
_SLIVER = 1e-7


class Floor:
    """Grown obstacles with an index, and the distance the search keeps from each part."""

    def __init__(self, grown: Grown, rho: Array) -> None:
        """Use ``rho`` (m,) [m] for the parts: a little more than needed, less near the start and the goal."""
        self.grown = grown
        self.rho = rho
        self.boxes = _boxes(grown, rho)
        self._tree = shapely.STRtree(self.boxes)

    def hit_parts(self, segments: Array) -> npt.NDArray[np.intp]:
        """Pairs (k, 2) of a segment's index and a part's, where segments (n, 4) come too near to a part."""
        return _near_pairs(self._tree, self.grown.parts, self.rho, segments)

    def parts_within(self, distance: float, segments: Array) -> npt.NDArray[np.intp]:
        """Parts whose grown boxes come so near [m] to any of the segments (n, 4), ascending."""
        lines = shapely.linestrings(segments.reshape(-1, 2, 2))
        return np.unique(self._tree.query(lines, predicate="dwithin", distance=distance)[1])

    def sizes(self, parts: npt.NDArray[np.intp]) -> Array:
        """The smaller sides (n,) [m] of the grown boxes of parts."""
        bounds = shapely.bounds(self.boxes[parts])
        return np.asarray((bounds[:, 2:] - bounds[:, :2]).min(axis=1))

    def is_hit(self, segments: Array, errors: Array) -> npt.NDArray[np.bool_]:
        """Whether segments (n, 4), each widened by its error (n,) [m], come too near to any part."""
        return _any(len(segments), _near_pairs(self._tree, self.grown.parts, self.rho, segments, errors))

    def near_parts(self, box: tuple[float, float, float, float]) -> npt.NDArray[np.intp]:
        """Parts whose grown boxes meet a box, ascending."""
        if not len(self.grown.parts):
            return np.empty(0, dtype=np.intp)
        return np.sort(self._tree.query(shapely.box(*box)))

    def edges_of(self, parts: npt.NDArray[np.intp]) -> tuple[Array, Array]:
        """Segments (e, 4) [m] of the cores of parts, and the distance (e,) [m] to keep from each."""
        index = self.grown.edges_of(parts)
        return self.grown.edges[index], self.rho[self.grown.edge_parts[index]]


def blocked_angles(
    center: Array, radius: float, edges: Array, rho: Array, box: tuple[float, float, float, float]
) -> Array:
    """Open stretches (k, 2) [rad] of a circle that come nearer than rho (e,) to segments (e, 4) or leave the box.

    Each begins in [0, 2 pi) and may end beyond 2 pi. Exact: the circle meets the boundary of a segment
    grown by rho (two half circles and two lines) at angles in closed form; between two of those angles
    it is wholly inside or wholly outside, which its middle tells.
    """
    x, y = center.tolist()
    reach = rho + radius
    (ax, ay, bx, by), (xmin, ymin, xmax, ymax) = edges.T, box
    near = (np.abs(ax + bx - 2 * x) < np.abs(ax - bx) + 2 * reach) & (
        np.abs(ay + by - 2 * y) < np.abs(ay - by) + 2 * reach
    )
    is_inside = xmin < x - radius and x + radius < xmax and ymin < y - radius and y + radius < ymax
    if is_inside and not near.any():
        return np.empty((0, 2))
    edges, rho = edges[near], rho[near]
    angles = np.empty(0) if is_inside else _box_angles(center, radius, box)
    if len(edges):
        angles = np.concatenate([_segment_angles(center, radius, edges, rho), angles])
    elif not len(angles):
        return np.empty((0, 2))
    cuts = np.unique(angles[np.isfinite(angles)] % (2 * np.pi))
    if not len(cuts):
        cuts = np.array([0.0])
    ends = np.append(cuts[1:], cuts[0] + 2 * np.pi)
    middle = (cuts + ends) / 2
    at = center + radius * np.stack([np.cos(middle), np.sin(middle)], axis=1)
    inside = (_segment_distance(at, edges) < rho[None] - _TOUCH).any(axis=1) | _outside(at, box)
    inside &= ends - cuts > _SLIVER
    return _joined(cuts[inside], ends[inside])


class Screen:
    """Some parts of a floor, for testing many segments against them."""

    def __init__(self, floor: Floor, parts: npt.NDArray[np.intp]) -> None:
        """Index the chosen parts."""
        self._parts, self._rho = floor.grown.parts[parts], floor.rho[parts]
        self._tree = shapely.STRtree(floor.boxes[parts])

    def is_hit(self, segments: Array) -> npt.NDArray[np.bool_]:
        """Whether segments (n, 4) come too near to any of the parts."""
        return _any(len(segments), _near_pairs(self._tree, self._parts, self._rho, segments))


def _near_pairs(
    tree: shapely.STRtree, parts: Geometry, rho: Array, segments: Array, errors: Array | None = None
) -> npt.NDArray[np.intp]:
    """Pairs (k, 2) of a segment (n, 4) and an indexed part nearer than the part's rho and the segment's error."""
    if not len(segments) or not len(parts):
        return np.empty((0, 2), dtype=np.intp)
    lines = shapely.linestrings(segments.reshape(-1, 2, 2))
    probes = lines
    if errors is not None:
        low, high = np.minimum(segments[:, :2], segments[:, 2:]), np.maximum(segments[:, :2], segments[:, 2:])
        probes = shapely.box(*(low - errors[:, None]).T, *(high + errors[:, None]).T)
    line, part = tree.query(probes, predicate="intersects")
    far = rho[part] if errors is None else rho[part] + errors[line]
    near = shapely.dwithin(parts[part], lines[line], np.maximum(far - _TOUCH, 0.0))
    return np.stack([line[near], part[near]], axis=1)


def _any(count: int, pairs: npt.NDArray[np.intp]) -> npt.NDArray[np.bool_]:
    hit = np.zeros(count, dtype=np.bool_)
    hit[pairs[:, 0]] = True
    return hit


def _boxes(grown: Grown, rho: Array) -> npt.NDArray[np.object_]:
    if not len(grown.parts):
        return np.empty(0, dtype=object)
    bounds = shapely.bounds(grown.parts)
    return np.asarray(shapely.box(*(bounds[:, :2] - rho[:, None]).T, *(bounds[:, 2:] + rho[:, None]).T))


def _joined(starts: Array, ends: Array) -> Array:
    """Stretches (k, 2) with those that follow each other without a gap made one."""
    if not len(starts):
        return np.empty((0, 2))
    gap = starts[1:] > ends[:-1]
    return np.stack([starts[np.append(True, gap)], ends[np.append(gap, True)]], axis=1)


def _segment_angles(center: Array, radius: float, edges: Array, rho: Array) -> Array:
    """Angles at which the circle meets the discs about the ends of edges and the lines beside them."""
    found = []
    for end in (edges[:, :2], edges[:, 2:]):
        gap = end - center
        far = np.hypot(gap[:, 0], gap[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            opening = _arccos((far**2 + radius**2 - rho**2) / (2 * far * radius))
        toward = np.arctan2(gap[:, 1], gap[:, 0])
        found += [toward - opening, toward + opening]
    along = edges[:, 2:] - edges[:, :2]
    length = np.hypot(along[:, 0], along[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = along / length[:, None]
        normal = np.stack([-unit[:, 1], unit[:, 0]], axis=1)
        offset = ((center - edges[:, :2]) * normal).sum(axis=1)
        toward = np.arctan2(normal[:, 1], normal[:, 0])
        for line in (rho - offset, -rho - offset):
            opening = _arccos(line / radius)
            found += [toward - opening, toward + opening]
    return np.concatenate(found)


def _arccos(cosine: Array) -> Array:
    """Arc cosine; at contact rounding may leave the cosine a hair above 1, and the contact must not be lost."""
    return np.asarray(np.arccos(np.where(np.abs(cosine) < 1 + _GRAZE, np.clip(cosine, -1.0, 1.0), np.nan)))


def _box_angles(center: Array, radius: float, box: tuple[float, float, float, float]) -> Array:
    xmin, ymin, xmax, ymax = box
    walls = (
        (0.0, xmax - center[0]),
        (np.pi / 2, ymax - center[1]),
        (np.pi, center[0] - xmin),
        (-np.pi / 2, center[1] - ymin),
    )
    angles: list[float] = []
    for toward, line in walls:
        if abs(line) <= radius:
            opening = float(np.arccos(line / radius))
            angles += [toward - opening, toward + opening]
    return np.array(angles)


def _segment_distance(points: Array, edges: Array) -> Array:
    """Distances (p, e) [m] of points from segments."""
    a, along = edges[:, :2], edges[:, 2:] - edges[:, :2]
    gap = points[:, None] - a[None]
    square = (along**2).sum(axis=1)
    share = np.clip((gap * along[None]).sum(axis=2) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    rest = gap - share[..., None] * along[None]
    return np.asarray(np.hypot(rest[..., 0], rest[..., 1]))


def _outside(points: Array, box: tuple[float, float, float, float]) -> npt.NDArray[np.bool_]:
    xmin, ymin, xmax, ymax = box
    x, y = points.T
    return np.asarray((x < xmin - _TOUCH) | (x > xmax + _TOUCH) | (y < ymin - _TOUCH) | (y > ymax + _TOUCH))
