"""The fitted path: every turn of the skeleton as wide as pays.

The shortest way turns as tightly as it may, and a tight turn must be driven slowly. A wider turn about the same
corner is longer and quicker. Every turn becomes clothoid, arc, clothoid with a peak curvature of its own,
touching the corner's offset; radius and share of the clothoids are chosen turn by turn by the time the whole
path takes, as long as the path keeps its distance. The taut path is one of the choices, so that there is
always an outcome.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from coord.alone.chain import quick_estimate
from coord.alone.speed_limit import speed_limit_of
from coord.geometry.blocked import Floor
from coord.geometry.clearance import keeps_distance
from coord.model.path import Path, straight
from coord.model.robot import Limits
from coord.paths.bends import AIR, Bend, Bends, Piece
from coord.paths.skeleton import Skeleton, Turn
from coord.paths.taut import SMALLEST_RADIUS, taut
from coord.solvers.jerk import LinkTimes, rest_to_rest

#: Shares of half a turn that each clothoid may take: one for finding the radius, others about the best radius.
_SHARE, _OTHER_SHARES = 0.5, (0.0, 1.0)

#: Radii tried for a turn: this many, evenly spaced in the logarithm up to the one that needs no slowing down.
_RADII = 6

#: Rounds over all turns.
_ROUNDS = 2

#: A path within this share of the time that its skeleton's length alone would take is not improved any more.
_GOOD_ENOUGH = 2e-4

#: A bend must gain this share of the time.
_LEAST_GAIN = 1e-6

#: Clothoids are cut where the speed cap has changed by this factor, for comparing times.
_CAP_RATIO = 1.5


def fitted(skeleton: Skeleton, limits: Limits, floor: Floor) -> Path | None:
    """The quickest path found along a skeleton that keeps the floor's distances; None where ``taut`` finds none."""
    if not skeleton.turns:
        return straight(skeleton.start, skeleton.goal)
    best = taut(skeleton, floor)
    if best is None:
        return None
    clock = _Clock(limits)
    least = clock(best.pieces.tolist())
    ideal = rest_to_rest(skeleton.length, limits).arrival * (1 + _GOOD_ENOUGH)
    bends = Bends(skeleton, [Bend(max(turn.radius, SMALLEST_RADIUS) + AIR, 0.0) for turn in skeleton.turns])
    if not bends.fits:
        return best
    for _ in range(_ROUNDS):
        changed = False
        for k, turn in enumerate(skeleton.turns):
            if least <= ideal:
                return best
            radii = _radii(turn, limits)
            for trying_radii in (True, False):
                now = bends.bends[k]
                candidates = [Bend(radius, _SHARE) for radius in radii]
                if not trying_radii:
                    near = int(np.abs(np.log(np.array(radii) / now.radius)).argmin())
                    candidates = [Bend(r, share) for r in radii[max(near - 1, 0) : near + 2] for share in _OTHER_SHARES]
                found = _quickest(bends, k, candidates, least * (1 - _LEAST_GAIN), clock, floor)
                if found is not None:
                    least, bends, best = found
                    changed = True
        if not changed:
            break
    return best


class _Clock:
    """About how long a path takes; it remembers the links between sections that most candidates share."""

    def __init__(self, limits: Limits) -> None:
        self._limits, self._links = limits, LinkTimes(limits, remember=True)

    def __call__(self, pieces: Iterable[Piece]) -> float:
        return quick_estimate(speed_limit_of(pieces, self._limits, _CAP_RATIO), self._limits, self._links)


def _radii(turn: Turn, limits: Limits) -> list[float]:
    """Radii [m] for a turn, from the tightest up to one that is driven at full speed."""
    tightest = max(turn.radius, SMALLEST_RADIUS)
    widest = max(limits.speed**2 / limits.lateral_acceleration, tightest) * 1.0001
    return [float(radius) for radius in np.geomspace(tightest, widest, _RADII) + AIR]


def _quickest(
    bends: Bends, k: int, candidates: list[Bend], least: float, clock: _Clock, floor: Floor
) -> tuple[float, Bends, Path] | None:
    """The quickest of some bends at turn k that keeps the distance and takes less than ``least`` [s], if any does."""
    trials = [bends.changed(k, bend) for bend in candidates if bend != bends.bends[k]]
    timed = [(clock(trial.pieces()), trial) for trial in trials if trial.fits]
    too_wide: dict[float, float] = {}  # for each share the least radius that came too near to something
    for time, trial in sorted(timed, key=lambda entry: entry[0]):
        bend = trial.bends[k]
        if time >= least:
            return None
        if bend.radius < too_wide.get(bend.share, math.inf) and trial.settle():
            if keeps_distance(floor, path := trial.path(), *trial.moved):
                return time, trial, path
            too_wide[bend.share] = bend.radius
    return None
