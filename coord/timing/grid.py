"""The time grid of the programs: knots where the tube has its events, and in each cell its bounds and its speed cap.

A cap that varies along the path is no linear constraint. It becomes one when it is settled beforehand in which
cells the robot is in a bend: there the bend's cap holds wherever the robot is, and in all other cells the robot
keeps out of the bend. What is settled is taken from a course, a rough motion, and corrected by the next solution.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.alone.speed_limit import SpeedLimit
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.knots import Cells
from coord.timing.tube import Tube, lower_on_cells, off_chords, upper_on_cells
from coord.tolerances import LIMIT_MARGIN, REGION_MARGIN, SAME_PLACE

#: First cells after an event of the tube last this share of acceleration / jerk; then they grow.
_FIRST_CELL = 0.25
_GROWTH = 1.5

#: [s] Longest cell.
_LONGEST = 1.0

#: On long stretches without an event or a window cells may last this share of the stretch.
_OF_STRETCH = 1 / 40

#: [m] Cells on which a bound is off its chord by more than this, times the mesh, are cut, so often at most; but none
#: that is shorter [s]: the solver fails where cells differ too much.
_BENT, _CUTS, _UNCUT = 0.025, 6, 5e-3

#: Cells of a grid.
_FEWEST_CELLS, _MOST_CELLS, _MOST_CELLS_OF_MANY = 8, 640, 4096

#: [s] Events nearer than this to each other are one.
_SAME_TIME = 1e-6

#: [s] See ``border_times``.
_A_MOMENT = 5e-3

#: Parts of a cell between which a course is taken for straight.
_PARTS = 8

#: [m] The tube is narrowed by this, so that the solver's rounding stays inside.
_TUBE_MARGIN = 2 * REGION_MARGIN


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """Roughly when the robot is where: arc lengths (n,) [m], nondecreasing, at times (n,) [s], linear in between."""

    times: Array
    s: Array

    def at(self, times: Array) -> Array:
        """Arc lengths (m,) [m] at the times (m,) [s]."""
        return np.asarray(np.interp(times, self.times, self.s))

    @property
    def profile(self) -> VelocityProfile:
        """The same with even speed in between: no motion that a robot could make, but it can be looked at as one."""
        speeds = np.append(np.diff(self.s) / np.diff(self.times), 0.0)
        states = np.stack([self.s, speeds, np.zeros_like(speeds)], axis=1)
        return VelocityProfile(self.times, states, np.zeros(len(speeds) - 1))

    def until(self, departure: float, arrival: float) -> Course:
        """The same course with its times stretched to a departure and an arrival [s]."""
        first, last = self.times[0], self.times[-1]
        return Course(departure + (self.times - first) * ((arrival - departure) / (last - first)), self.s)

    def within(self, departure: float, arrival: float) -> Course:
        """The same course from a departure until an arrival [s], later ones waited for at its end."""
        keep = (self.times > departure) & (self.times < arrival)
        times = np.concatenate([[departure], self.times[keep], [arrival]])
        return Course(times, self.at(times))

    def passes(self, s: Array) -> Array:
        """The first times (m,) [s] at which the arc lengths s (m,) [m] are reached."""
        k = np.clip(np.searchsorted(self.s, s, side="left"), 1, len(self.s) - 1)
        rise = self.s[k] - self.s[k - 1]
        share = np.divide(s - self.s[k - 1], rise, out=np.zeros_like(s), where=rise > 0)
        return np.asarray(self.times[k - 1] + np.clip(share, 0.0, 1.0) * (self.times[k] - self.times[k - 1]))


def time_knots(
    tube: Tube, departure: float, arrival: float, limits: Limits, mesh: float, further: Sequence[float] = (), *,
    many: bool = False, cut: bool = True,
) -> Array | None:  # fmt: skip
    """Knots at the tube's events and ``further`` ones [s], dense behind and before each.

    None where these would be more than a program may have, or where there is no time at all. ``mesh`` scales all
    cells; ``many``: there may be thousands; ``cut``: whether cells are cut where bounds are bent.
    """
    if arrival - departure < _SAME_TIME:
        return None
    spans = tube.spans
    events = {departure, arrival, *tube.events, *further}
    knots = sorted(t for t in events if departure <= t <= arrival)
    shortest = max(_FIRST_CELL * min(limits.acceleration, limits.deceleration) / limits.jerk, 0.02) * mesh
    times = [departure]
    for start, end in itertools.pairwise(knots):
        if end - start < _SAME_TIME:  # two events at once
            times[-1] = end if len(times) > 1 else times[-1]
            continue
        middle = (start + end) / 2
        is_taken = any(a < middle < b for a, b in spans)
        longest = (_LONGEST if is_taken else max(_LONGEST, (end - start) * _OF_STRETCH)) * mesh
        times += _graded(start, end, min(shortest, longest), longest)
    most = _MOST_CELLS_OF_MANY if many else _MOST_CELLS
    times = _bent_ones_cut(tube, times, _BENT * mesh, most) if cut else times
    if len(times) - 1 > most:
        return None
    while len(times) - 1 < _FEWEST_CELLS:
        k = int(np.argmax(np.diff(times)))
        times.insert(k + 1, (times[k] + times[k + 1]) / 2)
    times[-1] = arrival
    return np.array(times)


def _bent_ones_cut(tube: Tube, times: list[float], off: float, most: int) -> list[float]:
    """Knots with further ones in the middle of cells on which some bound is farther ``off`` its chord [m].

    ``most`` : no more than so many cells.
    """
    for _ in range(_CUTS):
        at = np.array(times)
        cut = (off_chords(tube, at) > off) & (np.diff(at) > _UNCUT)
        if not cut.any() or len(cut) + np.count_nonzero(cut) > most:
            break
        times = sorted([*times, *((at[:-1] + at[1:]) / 2)[cut].tolist()])
    return times


def _graded(start: float, end: float, first: float, longest: float) -> list[float]:
    """Knots after ``start`` up to ``end``: cells grow from both ends towards the middle."""
    half, sizes = (end - start) / 2, [first]
    while sum(sizes) < half:
        sizes.append(min(sizes[-1] * _GROWTH, longest))
    scale = half / sum(sizes)
    widths = np.array(sizes + sizes[::-1]) * scale
    return [*(start + np.cumsum(widths)[:-1]).tolist(), end]


def border_times(caps: SpeedLimit, course: Course) -> list[float]:
    """When a course passes from one section of the speed limit to the next [s]; a moment later where the cap rises.

    The quickest course could not be there any sooner, and must not be asked to by a rounding.
    """
    if caps.is_constant:
        return []
    later = np.where(np.diff(caps.caps) > 0, _A_MOMENT, 0.0)
    return [float(time) for time in course.passes(caps.ends[:-1]) + later]


def course_through(times: Array, states: Array) -> Course:
    """The course of a motion with states (n, 3) at times (n,), the jerk constant in between."""
    h = np.diff(times)[:, None]
    u = h * np.arange(_PARTS) / _PARTS
    s, v, a = (states[:-1, k, None] for k in range(3))
    jerk = np.diff(states[:, 2])[:, None] / h
    within = s + u * (v + u * (a / 2 + u * jerk / 6))
    at = np.append((times[:-1, None] + u).ravel(), times[-1])
    return Course(at, np.maximum.accumulate(np.append(within.ravel(), states[-1, 0])))


def cells_in(tube: Tube, times: Array, length: float, caps: SpeedLimit, course: Course | None) -> Cells:
    """The cells between the knots with the bounds of the tube, and the caps of the sections where the course is."""
    if caps.is_constant or course is None:
        return _cells(tube, times, length, *_anywhere(caps, len(times) - 1))
    borders = caps.ends[:-1]
    first = np.searchsorted(borders, course.at(times[:-1]) + SAME_PLACE, side="right")
    last = np.searchsorted(borders, course.at(times[1:]) - SAME_PLACE, side="left")
    return _cells(tube, times, length, *_stretches(caps, first, np.maximum(first, last)))


def cells_between(tube: Tube, times: Array, length: float, caps: SpeedLimit, passes: Array) -> Cells:
    """The same where the borders of the sections are passed at the knots ``passes`` (m,) [s]."""
    section = np.searchsorted(passes, (times[:-1] + times[1:]) / 2)
    return _cells(tube, times, length, *_stretches(caps, section, section))


def _cells(tube: Tube, times: Array, length: float, top: Array, first: Array, last: Array) -> Cells:
    """Cells within the tube and between two places each, with the largest speeds (N,) [m/s]."""
    n = len(times) - 1
    upper, lower = np.repeat(last[:, None], 4, axis=1), np.repeat(first[:, None], 4, axis=1)
    for bound in tube.upper:
        np.minimum(upper, upper_on_cells(bound, times, _TUBE_MARGIN), out=upper)
    for bound in tube.lower:
        np.maximum(lower, np.minimum(lower_on_cells(bound, times, _TUBE_MARGIN), length), out=lower)
    return Cells(np.diff(times), upper, lower, top[:n] * (1 - LIMIT_MARGIN))


def _anywhere(caps: SpeedLimit, n: int) -> tuple[Array, Array, Array]:
    """The lowest cap for all cells (n,), and no bound on the places."""
    return np.full(n, float(caps.caps.min(initial=np.inf))), np.full(n, -np.inf), np.full(n, np.inf)


def _stretches(caps: SpeedLimit, first: npt.NDArray[np.intp], last: npt.NDArray[np.intp]) -> tuple[Array, Array, Array]:
    """For cells (n,) from one section to another the cap [m/s], and the stretch about them where no cap is lower."""
    values, borders = caps.caps.tolist(), caps.ends[:-1]
    known: dict[tuple[int, int], tuple[float, float, float]] = {}
    pairs = list(zip(first.tolist(), last.tolist(), strict=True))
    for i, k in dict.fromkeys(pairs):
        cap = min(values[i : k + 1])
        begin, end = i, k
        while begin > 0 and values[begin - 1] >= cap:
            begin -= 1
        while end < len(values) - 1 and values[end + 1] >= cap:
            end += 1
        low = borders[begin - 1] + _TUBE_MARGIN if begin > 0 else -np.inf
        high = borders[end] - _TUBE_MARGIN if end < len(values) - 1 else np.inf
        known[i, k] = (cap, float(low), float(high))
    top, low_ends, high_ends = np.array([known[pair] for pair in pairs]).T
    return top, low_ends, high_ends
