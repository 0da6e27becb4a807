"""Zones: for each conflict of two robots the stretches of their paths on which they must not be at the same time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coord.coordination.scene import Scene
from coord.timing.meeting import Meeting
from coord.timing.passing import Timing
from coord.tolerances import SAME_PLACE


@dataclass(slots=True, eq=False)
class Zone:
    """A conflict region's two sides, and who goes through first.

    As long as one robot is in its stretch and the other is not in its own, they keep their distance: the region
    lies inside the rectangle of the two.

    Parameters
    ----------
    robots : indices of the two, the first of the file first.
    enter, leave : [m], where each one's stretch begins and ends: minus infinity for who starts in it and is in the
        other's way there, infinity for who rests in it for ever after.
    owner : who may go through first; None as long as that is open.
    is_over : whether one of the two has left it, for good, as robots never go back.
    """

    robots: tuple[int, int]
    enter: tuple[float, float]
    leave: tuple[float, float]
    owner: int | None = None
    is_over: bool = False

    def side(self, i: int) -> int:
        """Which of the two a robot is."""
        return self.robots.index(i)

    def other(self, i: int) -> int:
        """The other one of the two."""
        return self.robots[1 - self.side(i)]

    def begins(self, i: int) -> float:
        """Where the stretch of a robot begins [m]."""
        return self.enter[self.side(i)]

    def ends(self, i: int) -> float:
        """Where the stretch of a robot ends [m]."""
        return self.leave[self.side(i)]

    def parks(self, i: int) -> bool:
        """Whether a robot stays in its stretch for ever, once it is there."""
        return self.ends(i) == np.inf

    def is_open_to(self, i: int) -> bool:
        """Whether a robot may be in its stretch."""
        return self.is_over or self.owner == i


def zones_of(scene: Scene) -> list[Zone]:
    """All zones of a scene; who starts in one in the other's way owns it."""
    alone = {k: Timing(ego.alone, (), (), "alone") for k, ego in enumerate(scene.egos)}
    found = []
    for i in range(len(scene.egos)):
        later = sorted(k for k in scene.neighbours[i] if k > i)
        found += [_zone(scene, i, meeting) for meeting in scene.meetings(i, later, alone)]
    return [zone for zone in found if not _is_only_touched(scene, zone)]


def _is_only_touched(scene: Scene, zone: Zone) -> bool:
    """Whether one of the robots comes to rest at the very edge of its stretch, and so never is in it."""
    return any(
        zone.begins(i) >= scene.egos[i].length - SAME_PLACE and not zone.parks(i) and scene.egos[i].length > 0
        for i in zone.robots
    )


def _zone(scene: Scene, i: int, meeting: Meeting) -> Zone:
    k, ends, (low, high) = meeting.other, meeting.ends, meeting.region.s_range
    first, last = float(meeting.region.sigma[0]), float(meeting.region.sigma[-1])
    lengths = (scene.egos[i].length, scene.egos[k].length)
    starts_in = (not ends.start_free and low <= SAME_PLACE, ends.other_waits and first <= SAME_PLACE)
    stays_in = (
        not ends.goal_free and high >= lengths[0] - SAME_PLACE,
        ends.other_parks and last >= lengths[1] - SAME_PLACE,
    )
    owner = i if starts_in[0] else k if starts_in[1] else None
    return Zone(
        (i, k),
        (-np.inf if starts_in[0] else low, -np.inf if starts_in[1] else first),
        (np.inf if stays_in[0] else min(high, lengths[0]), np.inf if stays_in[1] else min(last, lengths[1])),
        owner,
    )
