"""Following the edge: straight on until something is in the way, then along its edge until the line is met again.

The leave rule is that of Bug2 (Lumelsky & Stepanov 1987): the edge is left where the straight line is met
nearer to the goal than it was left, and is free from there. Each time the shorter way round is taken, or the
one asked for. The robot knows the whole floor, so that is only a shape, not a search in the dark.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from coord.geometry.blocked import Floor
from coord.geometry.clearance import keeps_distance
from coord.geometry.shapes import part_distances
from coord.model.arrays import Point, frozen
from coord.model.path import Path, straight
from coord.model.robot import Limits
from coord.model.route import Shaped
from coord.paths.bends import AIR
from coord.paths.contour import Contour, Walk
from coord.paths.skeleton import NoWay, skeleton
from coord.paths.strokes import Chain, Fillet, Stroke, fillet, wrapped
from coord.paths.taut import SMALLEST_RADIUS, taut
from coord.tolerances import SAME_PLACE

#: [m] Where nothing else is asked for, fillets between line and edge have this radius: that of given paths, too.
CORNER = 0.2

#: [rad] Strokes that differ by less in heading follow each other without a corner.
_SMOOTH = 1e-7

#: Fillets are made smaller by this factor until they fit; after so many times there is none.
_SMALLER, _TRIES = 0.5, 16

#: Rounds in which all fillets are made smaller until the whole path keeps the distance.
_ROUNDS = 4

#: [m] Pieces shorter than this are left out.
_SHORTEST = 1e-12


def follow(
    floor: Floor, start: Point, goal: Point, limits: Limits, side: str | None = None, corner_radius: float = CORNER
) -> Shaped | str:
    """The path that follows the edges of what blocks the straight line.

    Parameters
    ----------
    limits : of the robot; what a tight fillet costs is decided by its lateral acceleration, not here.
    side : "left" or "right" of every obstacle, seen from start to goal; None: the shorter way round each.
    corner_radius : of the fillets between line and edge [m], where they fit; at least 1 cm if that fits.

    Returns
    -------
    The path; where fillets do not keep the distance, the taut path of the shortest way, and a remark. In words
    why there is no path where an edge leads nowhere.
    """
    del limits
    if math.dist(start, goal) <= SAME_PLACE:
        return Shaped(straight(start, goal), "straight")
    outer = _outer(floor, start, goal)
    chains = _way(Contour(outer), start, goal, side)
    if not isinstance(chains, str):
        for k in range(_ROUNDS):
            path = _joined(chains, max(corner_radius, SMALLEST_RADIUS) * _SMALLER ** (2 * k), start)
            if (
                path is not None
                and math.dist(path.end, goal) < SAME_PLACE
                and keeps_distance(_inner(floor, outer), path)
            ):
                return Shaped(path, "follow")
        chains = "no fillet at a corner of the edge keeps the distance"
    if side is not None:
        return chains
    found = skeleton(floor, start, goal)
    shortest = None if isinstance(found, NoWay) else taut(found, floor)
    if shortest is None:
        return chains
    return Shaped(shortest, "taut", remarks=(f"The shortest way instead of the obstacles' edge: {chains}.",))


def _outer(floor: Floor, start: Point, goal: Point) -> Floor:
    """The floor as the edge is followed: a little farther out, but start and goal stay outside."""
    nearest = part_distances(floor.grown.parts, np.array([start, goal]))
    return Floor(floor.grown, np.maximum(floor.rho, np.minimum(np.maximum(floor.rho + AIR, SMALLEST_RADIUS), nearest)))


def _inner(floor: Floor, outer: Floor) -> Floor:
    """The floor for the certificate: a part that start or goal touch gives its margin back, its edge is exact."""
    touches = outer.rho < floor.rho + AIR
    return Floor(floor.grown, np.where(touches, np.maximum(floor.rho - AIR, 0.0), floor.rho))


def _way(contour: Contour, start: Point, goal: Point, side: str | None) -> list[Chain] | str:
    """Lines and edges in turn, as chains between corners, or why there are none."""
    heading, length = math.atan2(goal[1] - start[1], goal[0] - start[0]), math.dist(start, goal)
    line = Stroke(*start, heading, length, 0.0)
    free = contour.free(line)
    strokes: list[Stroke] = []
    at = 0.0
    while True:
        end = next((last for first, last in free if first <= at + SAME_PLACE and last > at), at)
        if end > at:
            strokes.append(line.part(at, end))
        if end >= length - SAME_PLACE:
            return _chains(strokes)
        leaves = [first for first, _ in free if first > end + SAME_PLACE] + [length]
        walk = _shorter(contour, line, end, leaves, side)
        if isinstance(walk, str):
            return f"after {end:.2f} m of the straight line {walk}"
        strokes += walk.strokes
        at = walk.leave


def _shorter(contour: Contour, line: Stroke, hit: float, leaves: list[float], side: str | None) -> Walk | str:
    directions = {"left": (-1,), "right": (1,)}.get(side or "", (-1, 1))
    walks = [contour.walk(line, hit, leaves, direction) for direction in directions]
    found = [walk for walk in walks if isinstance(walk, Walk)]
    if found:
        return min(found, key=lambda walk: walk.length)
    reasons = list(dict.fromkeys(walk for walk in walks if isinstance(walk, str)))
    return " and on the other side ".join(reasons)


def _chains(strokes: Sequence[Stroke]) -> list[Chain]:
    chains = [[strokes[0]]]
    for one, two in pairwise(strokes):
        if abs(wrapped(two.heading - one.pose(one.length)[2])) < _SMOOTH:
            chains[-1].append(two)
        else:
            chains.append([two])
    return [Chain(chain) for chain in chains]


def _joined(chains: Sequence[Chain], radius: float, start: Point) -> Path | None:
    """The path of chains with fillets of up to this radius [m] between them; None where one does not fit."""
    last = len(chains) - 1
    room = [chain.length / (1 if k in (0, last) else 2) for k, chain in enumerate(chains)]
    corners: list[Fillet] = []
    for k in range(last):
        found = _largest(chains[k], chains[k + 1], radius, (room[k], room[k + 1]))
        if found is None:
            return None
        corners.append(found)
    pieces: list[tuple[float, float, float]] = []
    for k, chain in enumerate(chains):
        before = corners[k - 1].behind if k else 0.0
        behind = corners[k].before if k < last else 0.0
        pieces += [(stroke.length, stroke.curvature, stroke.curvature) for stroke in chain.cut(before, behind)]
        if k < last:
            pieces.append(corners[k].piece)
    first = chains[0].strokes[0]
    return Path((*start, first.heading), frozen([piece for piece in pieces if piece[0] > _SHORTEST], 3))


def _largest(one: Chain, two: Chain, radius: float, room: tuple[float, float]) -> Fillet | None:
    for k in range(_TRIES):
        found = fillet(one, two, radius * _SMALLER**k, room)
        if found is not None:
            return found
    return None
