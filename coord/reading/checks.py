"""Do starts, goals and via points have room: inside the workspace, clear of obstacles, clear of each other.

A polygon that keeps its heading is taken as it is; one that turns with the path as its circumscribed disc, as
planning takes it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from coord.geometry.shapes import nearer, placed, polygons_too_near, separation, too_near
from coord.model.arrays import Array, Point, frozen
from coord.model.footprint import Footprint
from coord.model.obstacle import Obstacle
from coord.reading.floor import Floor
from coord.reading.locate import KeyPath
from coord.reading.report import Report, shown
from coord.reading.robots import ReadRobot
from coord.tolerances import DISTANCE

_SIDES = ("left", "lower", "right", "upper")

Indices: TypeAlias = npt.NDArray[np.intp]
#: Says of pairs, as indices (k,) and (k,), which of them count.
Confirm: TypeAlias = Callable[[Indices, Indices], npt.NDArray[np.bool_]]


@dataclass(frozen=True, slots=True, eq=False)
class Rests:
    """All starts, all goals, or all via points.

    Parameters
    ----------
    which : "start", "goal" or "via".
    places : n places in the file. points : (n, 2) array [m]. footprints : n.
    """

    which: str
    places: Sequence[KeyPath]
    points: Array
    footprints: Sequence[Footprint]

    @property
    def radii(self) -> Array:
        """Radii (n,) [m] of the discs about the points that hold the footprints."""
        return np.array([footprint.radius for footprint in self.footprints], dtype=np.float64)


def check_rests(robots: Sequence[ReadRobot], floor: Floor, report: Report) -> None:
    """Report every start, goal and via point with too little room, of all robots whose places and shapes are known.

    Touching is allowed: a distance may fall short of what is needed by ``tolerances.DISTANCE``. Each place is
    reported once a kind of fault: the obstacle it is deepest in, the first robot it overlaps. Via points may be
    where other robots are: they are passed, each at its time.
    """
    clearance = floor.workspace.clearance
    for which in ("start", "goal", "via"):
        rests = _rests(which, robots)
        if floor.bounded:
            _check_edges(rests, floor.workspace.bounds, clearance, report)
        _check_obstacles(rests, floor.obstacles, clearance, report)
        if which == "start" or (which == "goal" and floor.workspace.after_arrival == "stay"):
            _check_each_other(rests, clearance, report)


def _rests(which: str, robots: Sequence[ReadRobot]) -> Rests:
    places: list[KeyPath] = []
    points, footprints = [], []
    for robot in robots:
        if robot.footprint is None:
            continue
        here: list[tuple[KeyPath, Point | None]]
        if which == "via":
            here = [(("robots", robot.k, "via", n), point) for n, point in enumerate(robot.via)]
        else:
            here = [(("robots", robot.k, which), getattr(robot, which))]
        for place, point in here:
            if point is not None:
                places.append(place)
                points.append(point)
                footprints.append(robot.footprint)
    return Rests(which, places, frozen(points, 2), footprints)


def _check_edges(rests: Rests, bounds: tuple[float, float, float, float], clearance: float, report: Report) -> None:
    x, y = rests.points.T
    xmin, ymin, xmax, ymax = bounds
    distances = np.stack([x - xmin, y - ymin, xmax - x, ymax - y], axis=1)
    extents = np.array([_extents(footprint) for footprint in rests.footprints], dtype=np.float64).reshape(-1, 4)
    missing = extents + clearance - distances
    for n in np.flatnonzero(missing.max(axis=1, initial=-np.inf) > DISTANCE).tolist():
        side = int(missing[n].argmax())
        distance, gap = float(distances[n, side]), float(distances[n, side] - extents[n, side])
        if distance < 0:
            text = f"outside the workspace (x from {xmin:g} to {xmax:g} m, y from {ymin:g} to {ymax:g} m)"
        else:
            beyond = f"reaches {-gap:.3g} m beyond it" if gap < 0 else f"is {gap:.3g} m from it"
            words = _room(rests.footprints[n], f"is {distance:.3g} m from it", beyond, clearance)
            text = f"{missing[n, side]:.3g} m too near to the {_SIDES[side]} edge of the workspace: {words}"
        _add(rests, n, f"is {text}", report)


def _extents(footprint: Footprint) -> tuple[float, float, float, float]:
    """How far a footprint reaches to the left, down, to the right and up [m]."""
    if not footprint.is_exact:
        return (footprint.radius,) * 4
    x, y = zip(*footprint.vertices, strict=True)
    return (-min(x), -min(y), max(x), max(y))


def _check_obstacles(rests: Rests, obstacles: Sequence[Obstacle], clearance: float, report: Report) -> None:
    who, what, missing, distances = _too_near(rests, obstacles, clearance)
    deepest = np.lexsort((what, -missing, who))
    first = np.unique(who[deepest], return_index=True)[1]
    for pair in deepest[first].tolist():
        n, name, distance = int(who[pair]), shown(obstacles[what[pair]].name), float(distances[pair])
        where = f"is {-distance:.3g} m inside it" if distance < 0 else f"is {distance:.3g} m from it"
        words = _room(rests.footprints[n], where, where.replace("inside", "deep in"), clearance)
        how = "deep in" if distance < 0 else "near to"
        _add(rests, n, f"is {missing[pair]:.3g} m too {how} obstacle {name}: {words}", report)


def _too_near(rests: Rests, obstacles: Sequence[Obstacle], clearance: float) -> tuple[Indices, Indices, Array, Array]:
    """Which rests are too near to which obstacles, by how much [m], and at what distance [m].

    The distance is that of the footprint as drawn where it keeps its heading, that of the centre else.
    """
    exact = np.array([footprint.is_exact for footprint in rests.footprints], dtype=bool)
    discs, polygons = np.flatnonzero(~exact), np.flatnonzero(exact)
    reach = rests.radii + clearance
    who, what, distances = too_near(obstacles, rests.points[discs], reach[discs])
    rings = [rests.footprints[n].vertices for n in polygons.tolist()]
    others, things, gaps = polygons_too_near(obstacles, rests.points[polygons], rings, clearance)
    missing = np.concatenate([reach[discs][who] - distances, clearance - gaps])
    who = np.concatenate([discs[who], polygons[others]])
    return who, np.concatenate([what, things]), missing, np.concatenate([distances, gaps])


def _check_each_other(rests: Rests, clearance: float, report: Report) -> None:
    partner = first_overlaps(rests.points, rests.radii, clearance, _confirm(rests, clearance))
    for n in np.flatnonzero(partner >= 0).tolist():
        _add(rests, n, _overlap(rests, n, int(partner[n]), clearance, report), report)


def _confirm(rests: Rests, clearance: float) -> Confirm | None:
    """Which of the rests whose discs overlap really do; nothing to ask where all footprints count as discs."""
    if not any(footprint.is_exact for footprint in rests.footprints):
        return None
    margins = np.array([footprint.margin for footprint in rests.footprints], dtype=np.float64)
    cores = placed(rests.points, [footprint.core for footprint in rests.footprints])
    inner = np.array([_inner_radius(footprint) for footprint in rests.footprints])

    def confirm(a: Indices, b: Indices) -> npt.NDArray[np.bool_]:
        # a crowd on one spot has millions of pairs; of most, the discs inside the footprints overlap already
        result = np.hypot(*(rests.points[a] - rests.points[b]).T) < inner[a] + inner[b] + clearance - DISTANCE
        unsure = np.flatnonzero(~result)
        a, b = a[unsure], b[unsure]
        result[unsure] = nearer(cores[a], cores[b], margins[a] + margins[b] + clearance)
        return np.asarray(result)

    return confirm


def _overlap(rests: Rests, n: int, m: int, clearance: float, report: Report) -> str:
    """How two robots stand too near to each other, as the rest of a sentence about the first."""
    one, other = rests.footprints[n], rests.footprints[m]
    whose = f"the {rests.which} of {report.subject(rests.places[m])}"
    turning = [footprint for footprint in (one, other) if footprint.vertices and not footprint.is_exact]
    if one.is_exact or other.is_exact:
        first, second = placed(rests.points[[n, m]], [one.core, other.core])
        gap = separation(first, second) - one.margin - other.margin
        where = f"their footprints overlap by {-gap:.3g} m" if gap < 0 else f"their footprints are {gap:.3g} m apart"
        needed = f", clearance {clearance:g} m is needed" if clearance else ""
    else:
        distance = float(np.hypot(*(rests.points[n] - rests.points[m])))
        gap, where = distance - one.radius - other.radius, f"{distance:.6g} m apart"
        needed = f", radii {one.radius:g} m + {other.radius:g} m"
        needed += f" + clearance {clearance:g} m are needed" if clearance else " are needed"
    if turning:
        radii = " and ".join(f"{footprint.radius:.6g} m" for footprint in turning)
        needed += f" (what turns counts as its circumscribed disc, of radius {radii})"
    return f"{'overlaps' if gap < 0 else 'is too near to'} {whose}: {where}{needed}"


def first_overlaps(points: Array, radii: Array, clearance: float, confirm: Confirm | None = None) -> Indices:
    """For each disc the first in the list, before itself, that it overlaps, or -1.

    Parameters
    ----------
    points : (n, 2) array [m]. radii : (n,) array [m]. clearance : distance kept [m]; touching is no overlap.
    confirm : says of pairs of discs that overlap which of them count; without it all do.

    A sweep: sorted along one axis, each disc is compared with the next, the next but one and so on, all discs at
    once, until none is near enough along that axis. Time grows with the crowd, memory does not.
    """
    count = len(points)
    first = np.full(count, count, dtype=np.intp)
    if not count:
        return first
    axis = int(np.ptp(points, axis=0).argmax())
    order = np.argsort(points[:, axis], kind="stable")
    along, across, radius = points[order, axis], points[order, 1 - axis], radii[order]
    farthest = 2 * float(radii.max()) + clearance
    for step in range(1, count):
        ahead = along[step:] - along[:-step]
        if ahead.min() >= farthest:
            break
        limit = np.maximum(radius[step:] + radius[:-step] + clearance - DISTANCE, 0.0)
        hit = np.flatnonzero(ahead**2 + (across[step:] - across[:-step]) ** 2 < limit**2)
        a, b = order[hit], order[hit + step]
        earlier, later = np.minimum(a, b), np.maximum(a, b)
        if confirm is not None:
            news = np.flatnonzero(earlier < first[later])
            news = news[confirm(earlier[news], later[news])]
            earlier, later = earlier[news], later[news]
        np.minimum.at(first, later, earlier)
    return np.where(first < count, first, -1)


def _inner_radius(footprint: Footprint) -> float:
    """Radius [m] of the largest disc about the reference point that the footprint holds."""
    if not footprint.is_exact:
        return footprint.radius
    edges = pairwise([*footprint.vertices, footprint.vertices[0]])
    return min((ax * by - ay * bx) / math.hypot(bx - ax, by - ay) for (ax, ay), (bx, by) in edges)


def _room(footprint: Footprint, centre: str, shape: str, clearance: float) -> str:
    """Where the footprint is, or its centre where it counts as a disc, and what distance is needed."""
    if footprint.is_exact:
        return f"its footprint {shape}" + (f", clearance {clearance:g} m is needed" if clearance else "")
    radius = f"radius {footprint.radius:g} m"
    if footprint.vertices:
        radius = f"its circumscribed disc of radius {footprint.radius:.6g} m"
    return f"its centre {centre}, {radius}" + (
        f" + clearance {clearance:g} m are needed" if clearance else " is needed"
    )


def _add(rests: Rests, n: int, text: str, report: Report) -> None:
    x, y = rests.points[n]
    place = rests.places[n]
    what = f"via point {int(place[3]) + 1}" if rests.which == "via" else rests.which
    report.add(place, f"{what} ({x:g}, {y:g}) {text}")
