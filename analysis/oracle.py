"""Slow and simple second opinions on shortest paths; they share no code with coord's own search.

``tangent_length`` builds the whole graph of tangents and arcs round all obstacles, tests every link, and walks it
with Dijkstra's plain algorithm: the shortest way itself. ``visibility_length`` walks round polygons that enclose the
true offsets: a way that can be driven, so never shorter than the shortest. ``separated`` proves that there is no
way. Points of the plane are complex numbers here.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Obstacle
from coord.model.problem import Workspace
from coord.tolerances import PLANNING_MARGIN

#: [m] A link that comes nearer by less than this only touches.
_TOUCH = 1e-9

#: [rad] Directions at a corner may miss its cone by this, which is rounding.
_CONE = 1e-9

#: [m] Corners of the visibility graph lie this far outside the polygons that block its lines.
_OUTSIDE = 1e-7

#: The place of the goal among the corners of the visibility graph: any line may end there.
_GOAL = (np.zeros(1, dtype=complex),) * 3

_TURN = 2 * math.pi


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """What a robot's reference point must keep from.

    ``cores`` : (m,) shapes; ``rho`` : (m,) distances [m] from them; ``box`` : xmin, ymin, xmax, ymax [m].
    """

    cores: Any
    rho: np.ndarray
    box: tuple[float, float, float, float]


def scene(
    workspace: Workspace,
    obstacles: Sequence[Obstacle],
    footprint: Footprint,
    ends: Sequence[complex] = (),
    margin: float = PLANNING_MARGIN,
) -> Scene:
    """The obstacles, each by itself, grown by a robot's shape, by the clearance and by the planning margin.

    The margin [m] is cut where an end of the way would be too near, as the planner promises to do.
    """
    d = workspace.clearance
    cores = np.array([_swept(obstacle, footprint) for obstacle in obstacles], dtype=object)
    radii = [obstacle.radius if isinstance(obstacle, Circle) else 0.0 for obstacle in obstacles]
    rho = np.array(radii) + footprint.margin + d + margin
    for end in ends:
        rho = np.minimum(rho, shapely.distance(cores, shapely.Point(end.real, end.imag)))
    x, y = np.array(footprint.core).T
    reach = footprint.margin + d
    xmin, ymin, xmax, ymax = workspace.bounds
    box = (xmin + reach - x.min(), ymin + reach - y.min(), xmax - reach - x.max(), ymax - reach - y.max())
    return Scene(cores, rho, tuple(float(side) for side in box))


def tangent_length(floor: Scene, start: complex, goal: complex, at_most: float = math.inf) -> float:
    """Length [m] of the shortest way from start to goal; infinite where there is none.

    With ``at_most``, the length [m] of a way that is known, only places are looked at that a way no longer than
    that can pass: the answer is the same, and infinite can no longer come out.
    """
    discs = _discs(floor, start, goal, at_most)
    links = _free_links(floor, discs, start, goal, at_most)
    return _dijkstra(discs, links, _chains(floor, discs, links))


def visibility_length(floor: Scene, start: complex, goal: complex, at_most: float, quarter: int = 16) -> float:
    """Length [m] of the shortest polyline round polygons that enclose the offsets; infinite if above ``at_most``.

    Offsets become polygons of ``quarter`` segments a quarter turn, whose sides lie outside the true arcs.
    """
    # one segment of a buffer's arc may be up to half as wide again as the others
    wide = floor.rho / math.cos(1.5 * math.pi / (4 * quarter))
    block = shapely.union_all(shapely.buffer(floor.cores, wide, quad_segs=quarter))
    outer = shapely.union_all(shapely.buffer(floor.cores, wide + _OUTSIDE, quad_segs=quarter))
    corners = [_outward(ring) for ring in _rings(outer)]
    at, before, after = (np.concatenate(column) for column in zip(_GOAL, *corners, strict=True))
    at[0] = goal
    chosen = _inside(at, floor.box) & (abs(at - start) + abs(at - goal) <= at_most + _TOUCH)
    at, before, after = at[chosen], before[chosen], after[chosen]
    shapely.prepare(block)
    best = np.full(len(at), math.inf)
    heap, done = [(abs(goal - start), 0.0, -1)], np.zeros(len(at), dtype=np.bool_)
    while heap:
        _, length, k = heapq.heappop(heap)
        if k == 0:
            return length
        if k > 0 and done[k]:
            continue
        here = start if k < 0 else complex(at[k])
        done[k] |= k > 0
        reached = length + abs(at - here)
        nearer = np.flatnonzero((reached < best) & (reached + abs(goal - at) <= at_most + _TOUCH))
        line = at[nearer] - here
        touches = _passes(line, before[nearer], after[nearer])
        if k > 0:
            touches &= _passes(line, before[k], after[k])
        nearer = nearer[touches]
        seen = nearer[~shapely.intersects(block, _lines(np.full(len(nearer), here), at[nearer]))]
        best[seen] = reached[seen]
        for m in seen.tolist():
            heapq.heappush(heap, (float(reached[m] + abs(goal - at[m])), float(reached[m]), m))
    return math.inf


def separated(floor: Scene, start: complex, goal: complex, quarter: int = 32) -> bool:
    """Whether it is proved that no way leads from start to goal: not even round polygons inside the offsets."""
    blocked = shapely.union_all(shapely.buffer(floor.cores, floor.rho - _TOUCH, quad_segs=quarter))
    free = shapely.difference(shapely.box(*floor.box), blocked)
    rooms = shapely.get_parts(free)
    ends = [shapely.Point(end.real, end.imag) for end in (start, goal)]
    return not any(all(shapely.distance(room, end) <= _TOUCH for end in ends) for room in rooms)


def _swept(obstacle: Obstacle, footprint: Footprint) -> Any:
    """Places of the reference point at which the footprint's core meets the obstacle's: a sum of triangles."""
    is_round = isinstance(obstacle, Circle)
    core = shapely.Point(obstacle.center) if is_round else shapely.Polygon(obstacle.vertices, obstacle.holes)
    if len(footprint.core) == 1:
        return core
    pieces = [core] if is_round else shapely.get_parts(shapely.constrained_delaunay_triangles(core))
    body = -np.array(footprint.core)
    sums = [(shapely.get_coordinates(piece)[:, None] + body).reshape(-1, 2) for piece in pieces]
    return shapely.union_all([shapely.convex_hull(shapely.MultiPoint(each)) for each in sums])


@dataclass(frozen=True, slots=True, eq=False)
class _Discs:
    """Directed discs, the start and the goal last: centres, radii [m], sides (+1 counter-clockwise), cones [rad]."""

    center: np.ndarray
    radius: np.ndarray
    side: np.ndarray
    first: np.ndarray
    span: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class _Links:
    """Tangents: the discs they leave and reach, the directions from those discs' centres [rad], lengths [m]."""

    leave: np.ndarray
    reach: np.ndarray
    leaving: np.ndarray
    arriving: np.ndarray
    length: np.ndarray


def _discs(floor: Scene, start: complex, goal: complex, at_most: float) -> _Discs:
    rows: list[tuple[complex, float, float, float]] = []
    for core, rho in zip(floor.cores, floor.rho.tolist(), strict=True):
        if shapely.get_dimensions(core) == 0:
            rows.append((complex(core.x, core.y), rho, 0.0, _TURN))
        for ring in _rings(core):
            into, out = ring - np.roll(ring, 1), np.roll(ring, -1) - ring
            turn = np.angle(out / into)
            for k in np.flatnonzero(turn > 0).tolist():
                rows.append((complex(ring[k]), rho, float(np.angle(-1j * into[k])), float(turn[k])))
    near = [
        row for row in rows if max(abs(row[0] - start) - row[1], 0) + max(abs(row[0] - goal) - row[1], 0) <= at_most
    ]
    both = [(*row, side) for row in near for side in (1.0, -1.0)]
    both += [(start, 0.0, 0.0, _TURN, 1.0), (goal, 0.0, 0.0, _TURN, 1.0)]
    center, radius, first, span, side = (np.array(column) for column in zip(*both, strict=True))
    return _Discs(center, radius, side, first, span)


def _free_links(floor: Scene, discs: _Discs, start: complex, goal: complex, at_most: float) -> _Links:
    """All directed tangents that keep every distance."""
    tree = shapely.STRtree(_boxes(floor))
    count = len(discs.center)
    found = []
    for i in range(count):
        if i == count - 1:  # nothing leaves the goal
            break
        j, leaving, arriving, p, q = _tangents(discs, i)
        fits = _inside(p, floor.box) & _inside(q, floor.box) & (j != count - 2)
        fits &= abs(p - start) + abs(q - p) + abs(goal - q) <= at_most + _TOUCH
        fits[fits] = ~_is_hit(floor, tree, p[fits], q[fits])
        found.append((np.full(int(fits.sum()), i), j[fits], leaving[fits], arriving[fits], abs(q - p)[fits]))
    return _Links(*(np.concatenate(column) for column in zip(*found, strict=True)))


def _tangents(discs: _Discs, i: int) -> tuple[np.ndarray, ...]:
    """From disc i: discs reached, directions at both ends, both ends.

    A disc passed on its side s lies at s r to the left of the tangent. So along a tangent of heading h the way from
    centre to centre rises by w = s_j r_j - s_i r_i to the left, and h = arg D - asin(w / |D|).
    """
    D = discs.center - discs.center[i]
    w = discs.side * discs.radius - discs.side[i] * discs.radius[i]
    j = np.flatnonzero((abs(D) > abs(w)) & (abs(D) > 0))
    D, w = D[j], w[j]
    heading = np.angle(D) - np.arcsin(w / abs(D))
    left = 1j * np.exp(1j * heading)
    p = discs.center[i] - discs.side[i] * discs.radius[i] * left
    q = discs.center[j] - discs.side[j] * discs.radius[j] * left
    leaving, arriving = heading - discs.side[i] * math.pi / 2, heading - discs.side[j] * math.pi / 2
    fits = _in_range(leaving, discs.first[i], discs.span[i]) & _in_range(arriving, discs.first[j], discs.span[j])
    return tuple(column[fits] for column in (j, leaving, arriving, p, q))


def _is_hit(floor: Scene, tree: shapely.STRtree, p: np.ndarray, q: np.ndarray) -> np.ndarray:
    lines = _lines(p, q)
    line, core = tree.query(lines, predicate="intersects")
    near = shapely.distance(floor.cores[core], lines[line]) < floor.rho[core] - _TOUCH
    hit = np.zeros(len(p), dtype=np.bool_)
    hit[line[near]] = True
    return hit


def _chains(floor: Scene, discs: _Discs, links: _Links) -> list[list[tuple[int, float]]]:
    """For each end of a link (2k where link k leaves, 2k + 1 where it arrives) the next one round its disc, if free."""
    count = len(links.length)
    disc = np.stack([links.leave, links.reach], axis=1).ravel()
    angle = np.stack([links.leaving, links.arriving], axis=1).ravel()
    edges, rho = _edges(floor)
    following: list[list[tuple[int, float]]] = [[] for _ in range(2 * count)]
    order = np.argsort(disc, kind="stable")
    for nodes in np.split(order, np.flatnonzero(np.diff(disc[order])) + 1):
        d = int(disc[nodes[0]]) if len(nodes) else -1
        if d < 0 or d >= len(discs.center) - 2:
            continue
        offset = (angle[nodes] - discs.first[d] + _CONE) % _TURN
        ahead = np.argsort(discs.side[d] * offset, kind="stable")
        nodes, offset = nodes[ahead], discs.side[d] * offset[ahead]
        turn = np.diff(offset)
        is_whole = discs.span[d] >= _TURN
        if is_whole:  # a column can be gone round for ever
            nodes, turn = np.append(nodes, nodes[0]), np.append(turn, _TURN + offset[0] - offset[-1])
        begin = angle[nodes[:-1]] if discs.side[d] > 0 else angle[nodes[1:]]
        free = _arcs_free(floor.box, complex(discs.center[d]), float(discs.radius[d]), begin, turn, edges, rho)
        for k in np.flatnonzero(free).tolist():
            following[nodes[k]].append((int(nodes[k + 1]), float(turn[k] * discs.radius[d])))
    return following


def _arcs_free(
    box: tuple[float, float, float, float],
    center: complex,
    radius: float,
    begin: np.ndarray,
    turn: np.ndarray,
    edges: np.ndarray,
    rho: np.ndarray,
) -> np.ndarray:
    """Whether arcs from ``begin`` on over ``turn`` [rad] stay in the box and keep rho (e,) from all edges (e, 2).

    Their ends are ends of free tangents, so an arc that is too near to a core is too near to one of its edges.
    """
    free = np.ones(len(begin), dtype=np.bool_)
    for direction in (0.0, math.pi / 2, math.pi, -math.pi / 2):
        farthest = np.array([center + radius * complex(math.cos(direction), math.sin(direction))])
        if not _inside(farthest, box)[0]:
            free &= ~_in_range(np.full(len(begin), direction), begin, turn, 0.0)
    toward = edges[:, 1] - edges[:, 0]
    nearest = _on_segments(np.array([center]), edges, toward)[0]
    near = abs(nearest - center) < radius + rho
    if near.any():
        gap = _arc_distances(center, radius, begin, turn, edges[near])
        free &= (gap >= rho[near] - _TOUCH).all(axis=1)
    return free


def _arc_distances(
    center: complex, radius: float, begin: np.ndarray, turn: np.ndarray, edges: np.ndarray
) -> np.ndarray:
    """Exact distances (k, e) [m] of arcs from segments.

    The least is taken at an end of the arc, at an end of the segment, at the foot of the centre on the segment, or
    is 0 where they cross.
    """
    a, toward = edges[:, 0], edges[:, 1] - edges[:, 0]
    ends = center + radius * np.exp(1j * np.stack([begin, begin + turn]).ravel())
    from_ends = abs(_on_segments(ends, edges, toward) - ends[:, None]).reshape(2, len(begin), len(edges))
    least = from_ends.min(axis=0)
    length = abs(toward)
    unit = np.where(length > 0, toward / np.where(length > 0, length, 1.0), 1.0)
    foot = ((center - a) / unit).real
    half = np.sqrt(np.maximum(radius**2 - ((center - a) / unit).imag ** 2, 0.0))
    for along in (np.zeros(len(edges)), length, np.clip(foot, 0.0, length), foot - half, foot + half):
        place = a + np.clip(along, 0.0, length) * unit - center
        is_there = _in_range(np.angle(place)[None], begin[:, None], turn[:, None], 0.0) | (abs(place) == 0)[None]
        least = np.where(is_there, np.minimum(least, abs(abs(place) - radius)[None]), least)
    return np.asarray(least)


def _dijkstra(discs: _Discs, links: _Links, following: list[list[tuple[int, float]]]) -> float:
    start, goal = len(discs.center) - 2, len(discs.center) - 1
    reach, length = links.reach.tolist(), links.length.tolist()
    heap = [(0.0, 2 * k) for k in np.flatnonzero(links.leave == start).tolist()]
    done = set()
    while heap:
        here, node = heapq.heappop(heap)
        if node in done:
            continue
        done.add(node)
        k, arrived = divmod(node, 2)
        if arrived and reach[k] == goal:
            return float(here)
        for other, more in following[node] if arrived else [(node + 1, length[k]), *following[node]]:
            if other not in done:
                heapq.heappush(heap, (here + more, other))
    return math.inf


def _in_range(angle: np.ndarray, first: Any, span: Any, slack: float = _CONE) -> np.ndarray:
    return np.asarray((angle - first + slack) % _TURN <= span + 2 * slack)


def _inside(at: np.ndarray, box: tuple[float, float, float, float]) -> np.ndarray:
    xmin, ymin, xmax, ymax = box
    x, y = at.real, at.imag
    return (x >= xmin - _TOUCH) & (x <= xmax + _TOUCH) & (y >= ymin - _TOUCH) & (y <= ymax + _TOUCH)


def _on_segments(points: np.ndarray, edges: np.ndarray, toward: np.ndarray) -> np.ndarray:
    """The places (p, e) of segments (e, 2) that are nearest to points (p,)."""
    square = np.maximum(abs(toward) ** 2, 1e-300)
    share = ((points[:, None] - edges[:, 0]) * toward.conj()).real / square
    return np.asarray(edges[:, 0] + np.clip(share, 0.0, 1.0) * toward)


def _lines(p: np.ndarray, q: np.ndarray) -> Any:
    return shapely.linestrings(np.stack([p.real, p.imag, q.real, q.imag], axis=1).reshape(-1, 2, 2))


def _boxes(floor: Scene) -> Any:
    xmin, ymin, xmax, ymax = shapely.bounds(floor.cores).T
    return shapely.box(xmin - floor.rho, ymin - floor.rho, xmax + floor.rho, ymax + floor.rho)


def _edges(floor: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Segments (e, 2) of all cores, a point twice for a column, and the distance (e,) [m] to keep from each."""
    rows: list[tuple[complex, complex]] = []
    rho: list[float] = []
    for core, own in zip(floor.cores, floor.rho.tolist(), strict=True):
        rings = [np.array([complex(core.x, core.y)])] if shapely.get_dimensions(core) == 0 else _rings(core)
        for ring in rings:
            rows += zip(ring.tolist(), np.roll(ring, -1).tolist(), strict=True)
            rho += [own] * len(ring)
    return np.array(rows).reshape(-1, 2), np.array(rho)


def _rings(shape: Any) -> list[np.ndarray]:
    """Outlines counter-clockwise and holes clockwise, as complex numbers, the first one not repeated."""
    rings = []
    for part in shapely.get_parts(shapely.orient_polygons(shape)):
        if shapely.get_dimensions(part) == 2:
            for ring in (part.exterior, *part.interiors):
                x, y = shapely.get_coordinates(ring)[:-1].T
                rings.append(x + 1j * y)
    return rings


def _outward(ring: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The convex corners of a ring, and the ways from them to the corners before and after."""
    into, out = ring - np.roll(ring, 1), np.roll(ring, -1) - ring
    convex = np.angle(out / into) > 0
    return ring[convex], -into[convex], out[convex]


def _passes(line: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Whether lines only touch corners: both neighbours lie on one side. No other line is part of a shortest way."""
    left, right = (line.conj() * before).imag, (line.conj() * after).imag
    return np.asarray((left * right >= 0) | (np.minimum(abs(left), abs(right)) <= _TOUCH * abs(line)))
