"""The quickest motion through a tube on a path with bends, in rounds.

In which cells the robot is in a bend follows from when it enters and leaves the bends, and these times are as unknown
as the arrival. So all of them are knots of the time grid that may move: each round solves the program taken as linear
about the last round's motion, moves the knots by no more than it trusts that, and builds the grid anew.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array
from coord.model.robot import Limits
from coord.solvers.knots import Cells
from coord.solvers.movable import Freedom, Motion, moved
from coord.timing.ego import Ego
from coord.timing.grid import Course, cells_between, course_through, time_knots
from coord.timing.tube import Tube

#: [s] By so much knots may move in the rounds on the first mesh, the motion itself being sought in the first; and in
#: those on finer ones.
_TRUST, _TRUST_FINE = (0.0, 1.0, 0.7, 0.5, 0.35, 0.2, 0.1, 0.05), (0.2, 0.14, 0.1, 0.07, 0.05, 0.03, 0.015)

#: Rounds at most on one mesh. While knots move as far as is trusted, to some effect, the trust grows, up to this [s].
_MOST_ROUNDS, _GROWTH, _TRUST_MOST = 24, 1.5, 3.0

#: [s] With no more trust than this no border may move past an event of the tube, for the bounds do not hold there; else
#: past events nearer than twice as much as is trusted, but no more than the second of these.
_FINAL, _PASSED = 0.15, 0.35

#: Nor once the round after it finds that so many times what seemed to lack, and so much more [m], lacks in truth.
_MISLED, _MISLED_BY = 10.0, 0.02

#: That round is taken back, with this share of its trust.
_BACK = 0.25

#: What lacks is less for it when it is below this share.
_RATHER = 0.97

#: The arrival may move by so many times as much.
_ARRIVAL = 4.0

#: [s] Borders of sections are passed at least so long after each other and after the departure.
_APART = 0.02

#: [m] Bounds are narrowed by this, so that the motion fits in truth where it fits as taken for linear; and by so many
#: times as much each time that it turned out not to.
_NARROWED, _NARROWER = 2e-4, 3.0

#: [m] Less than this lacks where a motion is found; and where more lacks, times the mesh, finer meshes do not help.
LACK, _MUCH = 1e-5, 0.065

#: Rounds end when so many of them have not brought what lacks below this share of what lacked before.
_TRIES, _LESS = 2, 0.8

#: [1] Rounds end when the arrival changes by less than this share.
_NEAR = 5e-4


@dataclass(frozen=True, slots=True, eq=False)
class Settled:
    """A motion of the rounds.

    Parameters
    ----------
    passes : (m,) times [s] at which the borders of sections are passed.
    lacks : what lacks at bounds [m].
    is_near : whether the last rounds have changed the arrival but little.
    """

    motion: Motion
    passes: Array
    lacks: float
    is_near: bool

    @property
    def arrival(self) -> float:
        """When it is at the goal [s]."""
        return float(self.motion.times[-1])

    @property
    def course(self) -> Course:
        """Where it is when."""
        return course_through(self.motion.times, self.motion.states)


def first_guess(ego: Ego, course: Course, departure: float, most: float) -> Settled:
    """Where the rounds begin: a course, which is at the goal by ``most`` [s] at the latest."""
    arrival = float(np.clip(course.times[-1], departure + _APART * (len(ego.caps.caps) + 1), most))
    passes = course.within(departure, arrival).passes(ego.caps.ends[:-1])
    standing = Motion(np.array([departure, arrival]), np.zeros((2, 3)), np.zeros(1))
    return Settled(standing, passes, np.inf, False)


def rounds(
    ego: Ego, tube: Tube, limits: Limits, mesh: float, most: float, guess: Settled, *, is_first: bool,
    many: bool = False,
) -> Iterator[Settled]:  # fmt: skip
    """Better and better motions on one mesh; it ends where more rounds are of no use.

    Whoever asks for more after one that is near has found that it does not fit in truth.

    ``many`` : whether the grid may have thousands of cells.
    """
    departure, before, stuck, is_strict = float(guess.motion.times[0]), guess, 0, False
    trusts = iter(_TRUST if is_first else _TRUST_FINE)
    trust = used = next(trusts)
    growth, narrowed = _GROWTH if is_first else 1.0, _NARROWED
    for count in range(_MOST_ROUNDS):
        passes = _in_order(guess.passes, departure, guess.arrival)
        times = time_knots(tube, departure, guess.arrival, limits, mesh, passes.tolist(), many=many)
        if times is None:
            return
        at = np.abs(times[:, None] - passes).argmin(axis=0)
        cells = _narrowed(cells_between(tube, times, ego.length, ego.caps, times[at]), narrowed)
        freedom = _freedom(tube, times, at, trust, most, is_strict)
        found = moved(cells, limits, ego.length, guess.motion.at(times), freedom)
        if found is None:
            return
        motion, lacks = found
        if used > _FINAL and lacks > _MISLED * guess.lacks + _MISLED_BY and not is_strict:
            guess, trust, used, is_strict = before, _BACK * used, 0.0, True
            continue
        gain = guess.arrival - float(motion.times[-1])
        has_moved = count > 1 or not is_first  # the very first round seeks a motion with all knots where they are
        is_near = has_moved and max(lacks, guess.lacks) < LACK and abs(gain) < _NEAR * guess.arrival
        is_far = 0 < trust <= 1.001 * np.abs((motion.times - times)[[*at, -1]]).max()
        is_better = lacks < _RATHER * guess.lacks or (lacks < LACK and gain > _NEAR * guess.arrival)
        stuck = stuck + 1 if lacks > max(LACK, _LESS * guess.lacks) and not (is_far and is_better) else 0
        before, guess = guess, Settled(motion, motion.times[at], lacks, is_near)
        yield guess
        if is_near:
            narrowed *= _NARROWER
        following = min(growth * trust, _TRUST_MOST) if is_far and is_better else next(trusts, None)
        if following is None or stuck == _TRIES:
            return
        trust, used = following, trust


def is_hopeless(settled: Settled, mesh: float) -> bool:
    """Whether so much lacks on a mesh that a finer one would not help."""
    return settled.lacks > _MUCH * mesh


def _in_order(passes: Array, departure: float, arrival: float) -> Array:
    """The times with at least ``_APART`` between them, and from the departure and to the arrival [s]."""
    apart = _APART * np.arange(1, len(passes) + 1)
    later = np.maximum.accumulate(np.maximum(passes, departure + apart) - apart) + apart
    until = arrival - apart[::-1]
    return np.asarray(np.minimum(later, until))


def _narrowed(cells: Cells, by: float) -> Cells:
    return replace(cells, upper=cells.upper - by, lower=cells.lower + by)


def _freedom(tube: Tube, times: Array, at: npt.NDArray[np.intp], trust: float, most: float, is_strict: bool) -> Freedom:
    """Knots at borders of sections move, and the others with them; the tube's events stay, but for those nearby."""
    anchors, fixed = np.zeros(len(times), bool), np.zeros(len(times), bool)
    anchors[[0, -1, *at]] = fixed[0] = True
    moving = np.append(times[at], times[-1])
    events = np.array([t for t in tube.events if times[0] < t < times[-1]])
    if len(events):
        may_be_passed = (np.abs(events[:, None] - moving).min(axis=1) < 2 * min(trust, _PASSED)) & (trust > _FINAL)
        may_be_passed &= not is_strict
        events = events[~may_be_passed]
        stays = np.abs(times[:, None] - events).argmin(axis=0) if len(events) else np.empty(0, np.intp)
        anchors[stays] = fixed[stays] = True
    later = min(_ARRIVAL * trust, max(most - float(times[-1]), 0.0))
    return Freedom(anchors, fixed, trust, _ARRIVAL * trust, later)
