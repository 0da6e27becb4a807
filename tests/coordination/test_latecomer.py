"""Who comes last: what is said to be impossible is, and what is known already is not worked out otherwise."""

from __future__ import annotations

import dataclasses
import math

import pytest

from coord.coordination.blocking import Block
from coord.coordination.company import Company
from coord.coordination.latecomer import comes_too_late, is_shut, joined, passing
from coord.coordination.prioritised import timing
from coord.model.footprint import Footprint, square
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.plan import plan
from coord.timing.ego import ego

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FLOOR = Workspace((-12.0, -12.0, 12.0, 12.0), 0.05)


def company_without(problem, i):
    """Everybody but robot i with the motion that a plan without it has, on the quickest routes; and its route."""
    others = dataclasses.replace(problem, robots=(*problem.robots[:i], *problem.robots[i + 1 :]))
    made = plan(others)
    assert made.certified
    (route,) = find_routes(dataclasses.replace(problem, robots=(problem.robots[i],)))
    parts = [*made.plan.robots[:i], None, *made.plan.robots[i:]]
    paths = [route.path if part is None else part.path for part in parts]
    return Company(problem, paths, {k: part.profile for k, part in enumerate(parts) if part is not None}), route


def everything(company, i, route):
    """A robot alone, whom it meets, and who blocks whom."""
    near = company.near(i, route.path)
    blocks = company.blocks(i, route.path, near)
    return ego(company.problem.robots[i], route.path, route.alone), near, blocks


@pytest.mark.parametrize("shape", [Footprint(0.3), square(0.5)], ids=["disc", "square"])
def test_where_a_meeting_is_shut_the_timing_finds_nothing(crowd, shape):
    """What is truly forbidden proves it: against all others, too, no profile is found; and it does come up."""
    shut = 0
    for seed in range(4):
        problem = crowd(seed, count=8, shape=shape, spacing=1.4)
        for i in range(0, 8, 3):
            company, route = company_without(problem, i)
            one, near, blocks = everything(company, i, route)
            late = {block.then for block in blocks if block.first == i}
            first = company.meetings(i, route.path, [k for k in near if k in late], blocks)
            if any(is_shut(one, meeting) for meeting in first):
                shut += 1
                assert timing(one, company.meetings(i, route.path, near, blocks), profile="fastest") is None
                found = joined(company, i, route, Options())
                assert found.timing is None
                assert found.shut
                assert set(found.shut) <= set(found.late)
    assert shut >= 2


def test_meetings_known_already_take_their_places_among_the_others(crowd):
    """The same list as worked out at once, with the very meetings that were known."""
    problem = crowd(3, count=10, spacing=1.4)
    company, route = company_without(problem, 4)
    _, near, blocks = everything(company, 4, route)
    whole = company.meetings(4, route.path, near, blocks)
    others = list(dict.fromkeys(meeting.other for meeting in whole))
    assert len(others) >= 3
    known = company.meetings(4, route.path, others[1::2][::-1], blocks)
    again = company.meetings(4, route.path, near, blocks, known=known)
    assert [(meeting.other, meeting.box) for meeting in again] == [(meeting.other, meeting.box) for meeting in whole]
    assert {id(meeting) for meeting in known} <= {id(meeting) for meeting in again}


@pytest.mark.parametrize("aside", [0.0, 0.4])
@pytest.mark.parametrize("shape", [Footprint(0.3), square(0.6)], ids=["disc", "square"])
def test_a_start_is_left_too_late_exactly_when_no_launch_gets_away_in_time(shape, aside):
    """From rest with full jerk over the distance that lacks, released a moment earlier it gets away, later not."""
    van = Robot("van", shape, LIMITS, (-9.0, 0.0), (9.0, 0.0))
    new = Robot("new", shape, LIMITS, (2.0, aside), (2.0, 9.0))
    company, _ = company_without(Problem("start", FLOOR, (van, new)), 1)
    when, gap = passing(company, Block(1, 0, "start"))
    needed = 0.65 - gap if not shape.vertices else 0.05 - gap
    assert gap == pytest.approx(aside if not shape.vertices else aside - 0.6)
    # with jerk j alone over so short a way: s = j t^3 / 6, up to the acceleration a at t = a / j
    rise, way = 0.5, 0.5**3 / 6
    assert needed > way
    extra = (-0.125 + math.sqrt(0.125**2 + 2 * 0.5 * (needed - way))) / 0.5
    last = when - rise - extra
    for change, is_late in ((-1e-3, False), (1e-3, True)):
        robots = (van, dataclasses.replace(new, release=last + change))
        changed = Company(Problem("start", FLOOR, robots), company.paths, company.profiles)
        assert comes_too_late(changed, 1, Block(1, 0, "start")) == is_late
