"""A robot that comes last on one route: its profile against all who have one, who do not make way for it.

Others that pass its start, and those that park on its way, it has to be ahead of. Whether it can is asked first, of the
meetings with these alone: where there is a proof that no motion does, nothing else is worked out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coord.alone.inverse import time_at
from coord.alone.ramp import launch
from coord.conflicts.core import conflict_core
from coord.conflicts.rest import closest
from coord.coordination.blocking import Block, place_of
from coord.coordination.company import Company
from coord.coordination.prioritised import timing, waiting
from coord.model.options import Options
from coord.model.route import Route
from coord.timing.bounds import inner_claims
from coord.timing.ego import Ego, ego
from coord.timing.meeting import Meeting, first_run_into
from coord.timing.passing import Timing
from coord.timing.ties import equally_early


@dataclass(frozen=True, slots=True, eq=False)
class Joined:
    """A robot on one route, after all who have a profile.

    Parameters
    ----------
    timing : None where it finds no time to drive on this route.
    blocks : between it and everybody near, but for ``late`` : those by which others with a profile should come later.
    shut : those of ``late`` by which it is proved that there is no such time; there may be more.
    """

    i: int
    route: Route
    ego: Ego
    timing: Timing | None
    blocks: tuple[Block, ...]
    late: tuple[Block, ...]
    shut: tuple[Block, ...]

    @property
    def own(self) -> frozenset[Block]:
        """The places of others that its path runs over."""
        return frozenset(block for block in (*self.blocks, *self.late) if block.driving == self.i)


def joined(company: Company, i: int, route: Route, options: Options, blocks: Sequence[Block] | None = None) -> Joined:
    """A robot on a route, with its profile against all who have one; ``blocks`` : between it and all, if known."""
    one = ego(company.problem.robots[i], route.path, route.alone)
    near = company.near(i, route.path)
    blocks = company.blocks(i, route.path, near) if blocks is None else blocks
    late = tuple(block for block in blocks if block.first == i and block.then in company.profiles)
    # who passes its start comes first: against that goals that it could go round do not matter
    ahead_of = dict.fromkeys(block.then for block in sorted(late, key=lambda block: block.driving == i))
    first = company.meetings(i, route.path, list(ahead_of), blocks)
    hopeless = next((meeting.other for meeting in first if is_shut(one, meeting)), None)
    found = None
    if hopeless is None:
        meetings = company.meetings(i, route.path, near, blocks, known=first)
        found = _timed(one, meetings, options, is_last=all(k in company.profiles for k in near), may_wait=not late)
    others, shut = (block for block in blocks if block not in late), (block for block in late if block.then == hopeless)
    return Joined(i, route, one, found, tuple(others), late, tuple(shut))


def _timed(one: Ego, meetings: list[Meeting], options: Options, *, is_last: bool, may_wait: bool) -> Timing | None:
    """Its profile against some others; ``may_wait`` : as long as it takes, since nobody needs its place."""
    found = timing(
        one,
        meetings,
        profile=options.profile,
        method=options.method,
        certify=options.certify,
    )
    if found is not None and found.how == "start delay" and is_last and options.method == "velocity":
        found = next(iter(equally_early(one, meetings, found)), found)
    if may_wait:
        return found or waiting(one, meetings)
    if found is not None and first_run_into(meetings, found.profile) is not None:
        return None  # no order promises that waiting helps
    return found


def is_shut(one: Ego, meeting: Meeting) -> bool:
    """Whether no motion at all is clear of another robot's, by what is truly forbidden: neither after it nor before."""
    return any(math.isinf(claim.after) and not claim.can_precede for claim in inner_claims(one, meeting))


def comes_too_late(company: Company, i: int, block: Block) -> bool:
    """Whether somebody passes a robot's start before the robot can be away from there, whatever its path."""
    robot, driving = company.problem.robots[i], company.problem.robots[block.driving]
    when, gap = passing(company, block)
    needed = robot.footprint.margin + driving.footprint.margin + company.problem.workspace.clearance - gap
    return robot.release + float(launch(robot.limits).time(needed)[0]) > when


def passing(company: Company, block: Block) -> tuple[float, float]:
    """When [s] the driving robot of a block is closest to the place, and how near [m] the cores of both are then."""
    robots, path = company.problem.robots, company.paths[block.driving]
    core = conflict_core(robots[block.driving].footprint.core, robots[block.resting].footprint.core)
    gap, s = closest(path, place_of(robots, block), core)
    return float(time_at(company.profiles[block.driving], np.array([s]))[0]), gap
