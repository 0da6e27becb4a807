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
from coord.paths.skeleton import Skeleton
from coord.paths.taut import SMALLEST_RADIUS, taut
from coord.solvers.jerk import LinkTimes, rest_to_rest

#: Shares of half a turn that each clothoid may take: one for finding the radius, others about the best radius.
_SHARE, _OTHER_SHARES = 0.5, (0.0, 1.0)

#: Radii tried for a turn: this many, evenly spaced in the logarithm up to the one that needs no slowing down; and
#: where there are few turns, which compete for less room.
_RADII, _RADII_OF_FEW, _VERY_FEW = 6, 9, 4

#: Turns up to which it pays to begin at the back, too.
_FEW = 10

#: Rounds over all turns.
_ROUNDS = 4

#: A path within this share of the time that its skeleton's length alone would take is not improved any more.
_GOOD_ENOUGH = 2e-4

#: A bend must gain this share of the time.
_LEAST_GAIN = 1e-6

#: Clothoids are cut where the speed cap has changed by this factor, for comparing times.
_CAP_RATIO = 1.5


def fitted(skeleton: Skeleton, limits: Limits, floor: Floor) -> Path | None:
    """The quickest path found along a skeleton that keeps the floor's distances; None where ``taut`` finds none.

    Where turns compete for room, the first to be widened takes it: the turns are gone through from the front, and
    if they are few once more from the back.
    """
    if not skeleton.turns:
        return straight(skeleton.start, skeleton.goal)
    tight = taut(skeleton, floor)
    if tight is None:
        return None
    clock = _Clock(limits)
    start = best = (clock(tight.pieces.tolist()), tight)
    ideal = rest_to_rest(skeleton.length, limits).arrival * (1 + _GOOD_ENOUGH)
    bends = Bends(skeleton, [Bend(max(turn.radius, SMALLEST_RADIUS) + AIR, 0.0) for turn in skeleton.turns])
    for forward in (True, False):
        if bends.fits and best[0] > ideal and (forward or 1 < len(bends.bends) <= _FEW):
            found = _widened(bends, start, ideal, forward, limits, clock, floor)
            best = min(best, found, key=lambda one: one[0])
    return best[1]


def _widened(
    bends: Bends,
    best: tuple[float, Path],
    ideal: float,
    forward: bool,
    limits: Limits,
    clock: _Clock,
    floor: Floor,
) -> tuple[float, Path]:
    """Time and path after all turns were gone through, one way or the other, until nothing changes."""
    worth = set(range(len(bends.bends)))  # in later rounds only the turns beside one that changed
    for _ in range(_ROUNDS):
        changed: set[int] = set()
        done = 0
        while done < len(bends.bends) and best[0] > ideal:
            k = done if forward else len(bends.bends) - 1 - done
            done += 1
            if k not in worth:
                continue
            count = len(bends.bends)
            for trying_radii in (True, False):
                candidates = _candidates(bends, k, limits, trying_radii)
                found = _quickest(bends, k, candidates, best[0] * (1 - _LEAST_GAIN), clock, floor)
                if found is None:
                    continue
                time, bends, path = found
                best = (time, path)
                changed |= {k - 1, k + 1}
                if len(bends.bends) < count:  # a corner is passed clear of now: the places of the others have changed
                    changed, worth = set(range(len(bends.bends))), set(range(len(bends.bends)))
                    done -= 1
                    break
        worth = changed
        if not worth:
            break
    return best


class _Clock:
    """About how long a path takes; it remembers the links between sections that most candidates share."""

    def __init__(self, limits: Limits) -> None:
        self._limits, self._links = limits, LinkTimes(limits, remember=True)

    def __call__(self, pieces: Iterable[Piece]) -> float:
        return quick_estimate(speed_limit_of(pieces, self._limits, _CAP_RATIO), self._limits, self._links)


def _candidates(bends: Bends, k: int, limits: Limits, trying_radii: bool) -> list[Bend]:
    """Bends for one turn: radii up to one that is driven at full speed; or other shares about the radius it has."""
    tightest = max(bends.skeleton.turns[k].radius, SMALLEST_RADIUS)
    widest = max(limits.speed**2 / limits.lateral_acceleration, tightest) * 1.0001
    count = _RADII_OF_FEW if len(bends.bends) <= _VERY_FEW else _RADII
    radii = [float(radius) for radius in np.geomspace(tightest, widest, count) + AIR]
    if trying_radii:
        return [Bend(radius, _SHARE) for radius in radii]
    near = int(np.abs(np.log(np.array(radii) / bends.bends[k].radius)).argmin())
    return [Bend(radius, share) for radius in radii[max(near - 1, 0) : near + 2] for share in _OTHER_SHARES]


def _quickest(
    bends: Bends, k: int, candidates: list[Bend], least: float, clock: _Clock, floor: Floor
) -> tuple[float, Bends, Path] | None:
    """The quickest of some bends at turn k that keeps the distance and takes less than ``least`` [s], if any does."""
    trials = [_changed(bends, k, bend) for bend in candidates if bend != bends.bends[k]]
    timed = [(clock(trial.pieces()), bend, trial) for bend, trial in trials if trial.fits]
    too_wide: dict[float, float] = {}  # for each share the least radius that came too near to something
    for time, bend, trial in sorted(timed, key=lambda entry: entry[0]):
        if time >= least:
            return None
        if bend.radius < too_wide.get(bend.share, math.inf) and trial.settle():
            if keeps_distance(floor, path := trial.path(), *trial.moved):
                return time, trial, path
            too_wide[bend.share] = bend.radius
    return None


def _changed(bends: Bends, k: int, bend: Bend) -> tuple[Bend, Bends]:
    """The bends with another one at turn k, past corners that it leads the path clear of."""
    trial = bends.changed(k, bend)
    while trial.vanished is not None and len(trial.bends) > 1 and trial.skeleton.turns[trial.vanished].radius > 0:
        trial = trial.without(trial.vanished)
    return bend, trial
