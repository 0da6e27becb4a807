"""A meeting: one region of ego with one robot planned before it; its window is built only when it matters."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from coord.alone.inverse import time_at
from coord.conflicts.region import ConflictRegion, refined
from coord.conflicts.window import BEND, Window, stay_within, window
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.timing.clear import Excess, excess

#: A window is looked at roughly in so many spans of its strips.
_SPANS = 16

#: In a refined window cells and what is lost to bent motions are so many times as large.
_FINER = 0.25


@dataclass(frozen=True, slots=True)
class Ends:
    """Which resting places are in the way, by exact tests: ego's own for the other, the other's for ego."""

    start_free: bool
    goal_free: bool
    other_waits: bool
    other_parks: bool


@dataclass(slots=True, eq=False)
class Meeting:
    """A conflict region with the motion of the other robot through it.

    ``box`` : earliest and latest time [s] at which the other is in the region, least and largest forbidden
    arc length [m] of ego. ``bend`` : by how much [m] the window's lines may miss the other's motion.
    """

    region: ConflictRegion
    other: int
    profile: VelocityProfile
    ends: Ends
    length: float
    bend: float = BEND
    box: tuple[float, float, float, float] = field(init=False)
    _window: Window | None = field(init=False, default=None)
    _spans: tuple[Array, Array, Array] | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        first, last = time_at(self.profile, self.region.sigma[[0, -1]]).tolist()
        if self.region.sigma[0] <= 0 and self.ends.other_waits:
            first = 0.0
        if self.region.sigma[-1] >= self.profile.length:
            last = np.inf if self.ends.other_parks else self.profile.arrival
        self.box = (first, last, *self.region.s_range)

    @property
    def window(self) -> Window:
        """The forbidden arc lengths over time."""
        if self._window is None:
            ends = self.ends
            waits, parks = ends.other_waits, ends.other_parks
            raw = window(self.region, self.other, self.profile, waits=waits, parks=parks, bend=self.bend)
            if raw is None:  # the other never gets there: a window of no width
                raw = Window(self.other, np.array([0.0, 1.0]), np.array([[np.inf] * 2]), np.array([[-np.inf] * 2]))
            self._window = stay_within(raw, ends.start_free, ends.goal_free, self.length)
        return self._window

    def refined(self) -> Meeting:
        """The same with a window that is nearer to the truth, by millimetres, and takes several times as long."""
        region = refined(self.region, _FINER)
        return Meeting(region, self.other, self.profile, self.ends, self.length, _FINER * self.bend)

    def is_avoided(self, profile: VelocityProfile) -> bool:
        """Whether a look at the box alone shows that a profile does not meet the other here."""
        return self._side(profile) is not None

    def passes_after(self, profile: VelocityProfile) -> bool:
        """Whether a profile that is clear of the other passes after it, not before."""
        side = self.side(profile)
        return excess(profile, self.window).passes_after if side is None else side

    def side(self, profile: VelocityProfile) -> bool | None:
        """Whether a rough look shows that a profile passes after (True) or before (False); None where it does not."""
        if self._spans is None:
            side = self._side(profile)
            if side is not None:
                return side
            self._spans = _spans(self.window)
        times, low, high = self._spans
        s = profile.places(times)
        if bool((s[1:] <= low).all()):
            return True
        return False if bool((s[:-1] >= high).all()) else None

    def _side(self, profile: VelocityProfile) -> bool | None:
        """Whether the box alone shows that a profile passes after (True) or before (False); None where it does not."""
        first, last, low, high = self.box
        if profile.place(min(last, max(profile.arrival, first))) <= low:
            return True
        return False if profile.place(first) >= high else None

    def excess(self, profile: VelocityProfile) -> Excess | None:
        """How far the profile is from passing on one side; None where the box shows that it does."""
        return None if self.is_avoided(profile) else excess(profile, self.window)


def _spans(window: Window) -> tuple[Array, Array, Array]:
    """Times (m+1,) [s] between strips of a window, and the least and largest forbidden arc length (m,), (m,) [m]."""
    edges = np.unique(np.linspace(0, len(window.low), _SPANS + 1).astype(np.intp))
    low = np.minimum.reduceat(window.low.min(axis=1), edges[:-1])
    return window.times[edges], low, np.maximum.reduceat(window.high.max(axis=1), edges[:-1])


def first_violated(meetings: list[Meeting], profile: VelocityProfile) -> tuple[int, Excess] | None:
    """The meeting, by index, at which a profile first runs into another robot; None where it is clear of all."""
    found: tuple[int, Excess] | None = None
    for index, meeting in enumerate(meetings):
        if found is not None and meeting.box[0] > found[1].time:
            continue
        if meeting.side(profile) is not None:
            continue
        gap = excess(profile, meeting.window)
        if not gap.is_clear and (found is None or gap.time < found[1].time):
            found = (index, gap)
    return found


def first_run_into(meetings: list[Meeting], profile: VelocityProfile) -> int | None:
    """The first of those, by index, whose refined window is violated, too; None where a profile is clear of all."""
    for index in all_violated(meetings, profile):
        if all_violated([meetings[index].refined()], profile):
            return index
    return None


def all_violated(meetings: list[Meeting], profile: VelocityProfile) -> list[int]:
    """All meetings, by index, at which a profile runs into another robot."""
    gaps = ((index, meeting.excess(profile)) for index, meeting in enumerate(meetings))
    return [index for index, gap in gaps if gap is not None and not gap.is_clear]
