"""Everyone arrives: with room between all places, and whatever step of the timing stage fails."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.errors import SolverError
from coord.model.footprint import Footprint, square
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan

#: [m] Between neighbouring places of the lattice: two radii and two clearances beside a disc or square at rest.
SPACING = 1.7

SHAPES = {"discs": [Footprint(0.3)], "squares": [square(0.55)], "mixed": [Footprint(0.2), square(0.5), Footprint(0.35)]}


def crowd(seed, count, cells=6, shapes=tuple(SHAPES["discs"])):
    """Robots of mixed speeds, priorities and releases between distinct places of a lattice."""
    rng = np.random.default_rng(seed)
    places = [(SPACING * (k % cells + 1), SPACING * (k // cells + 1)) for k in rng.permutation(cells * cells).tolist()]
    robots = []
    for k in range(count):
        limits = Limits(*rng.choice([0.5, 1.0, 1.5], 5).tolist())
        more = {"priority": rng.choice([None, 1.0, 2.0, 3.0]), "release": float(rng.choice([0.0, 0.0, 4.0]))}
        robots.append(Robot(f"r{k}", shapes[k % len(shapes)], limits, *places[2 * k : 2 * k + 2], **more))
    side = SPACING * (cells + 1)
    return Problem("crowd", Workspace((0.0, 0.0, side, side), 0.05), tuple(robots))


@pytest.mark.parametrize("shapes", SHAPES)
@pytest.mark.parametrize("seed", range(4))
def test_everybody_of_an_open_crowd_arrives(shapes, seed):
    """15 robots on 30 of 36 places, with rings of all kinds: certified, nobody earlier than alone on its quickest path."""
    result = plan(crowd(seed, 15, shapes=tuple(SHAPES[shapes])))
    assert result.certified
    found = result.plan
    for one in found.robots:
        assert one.solo_arrival <= one.arrival + 1e-9
        assert one.solo_bound <= one.lower_bound <= one.arrival
        assert one.how != "waited"
    bounds = {one.robot.name: (one.solo_bound, one.solo_arrival) for one in found.robots}
    assert {name for name, (bound, alone) in bounds.items() if bound > alone} <= {one.robot for one in found.rerouted}


def test_some_of_these_crowds_have_rings():
    """Otherwise the theorem above would say little: in four crowds somebody goes round, and ever with a reason."""
    seen = 0
    for seed in range(4):
        for told in plan(crowd(seed, 15)).plan.rerouted:
            seen += 1
            assert told.around
            assert told.robot in told.ring
            assert all(told.robot in (arc.first, arc.then) for arc in told.around)
            assert all({arc.first, arc.then} <= set(told.ring) for arc in told.around)
    assert seen >= 3


@settings(deadline=None, derandomize=True, max_examples=12)
@given(st.integers(0, 10**6), st.integers(4, 12))
def test_whoever_goes_before_a_more_urgent_robot_is_bound_to_by_arcs(seed, count):
    """For every pair against the priorities a chain of arcs leads from the one planned earlier to one at least as urgent as the other."""
    found = plan(crowd(seed, count, cells=5)).plan
    urgency = {one.robot.name: np.inf if one.robot.priority is None else one.robot.priority for one in found.robots}
    followers = {name: {arc.then for arc in found.blocking if arc.first == name} for name in urgency}
    for early, late in itertools.combinations(found.order, 2):
        if urgency[early] <= urgency[late]:
            continue
        bound, todo = set(), [early]
        while todo:
            new = followers[todo.pop()] - bound
            bound |= new
            todo += new
        assert min(urgency[name] for name in bound) <= urgency[late]


#: No profile is smoothed.
FASTEST = Options(profile="fastest")

#: Crowds of which the plans need splices, programs and ways round.
SEEDS = (14, 21, 26, 32)


def _library(*_, **__):
    raise SolverError("out of order")


#: Steps of the timing stage, and what they give when they fail.
FAILURES = {
    "splice": ("coord.timing.choices.spliced", lambda *_: []),
    "program": ("coord.timing.choices.through_tube", lambda *_, **__: None),
    "program's library": ("coord.timing.choices.through_tube", _library),
    "splice's library": ("coord.timing.choices.spliced", _library),
    "branch and bound": ("coord.timing.passing.branch_and_bound", lambda _: (0, True)),
    "start delay": ("coord.timing.passing.start_delay", lambda *_: None),
    "everything": ("coord.coordination.prioritised.time_robot", lambda *_, **__: None),
}


@pytest.mark.parametrize("failure", FAILURES)
def test_everybody_arrives_whatever_step_of_the_timing_stage_fails(monkeypatch, failure):
    """Four crowds with rings and priorities: certified; and all but a missing start delay, which a program replaces, make a difference."""
    before = [plan(crowd(seed, 12, cells=5), FASTEST) for seed in SEEDS]
    monkeypatch.setattr(*FAILURES[failure])
    after = [plan(crowd(seed, 12, cells=5), FASTEST) for seed in SEEDS]
    assert all(result.certified for result in after)
    same = [result.document for result in before] == [result.document for result in after]
    assert failure == "start delay" or not same
    waited = [one.how for result in after for one in result.plan.robots].count("waited")
    if failure == "everything":
        assert waited == 4 * 12


def test_everybody_arrives_when_all_steps_fail_together(monkeypatch):
    """Splice, program, branch and bound and start delay: only driving alone and waiting are left."""
    for target, value in (*FAILURES.values(), ("coord.timing.closing.through_tube", lambda *_, **__: None)):
        if "coord.timing." in target:
            monkeypatch.setattr(target, value)
    for seed in SEEDS:
        result = plan(crowd(seed, 12, cells=5))
        assert result.certified
        assert {one.how for one in result.plan.robots} <= {"alone", "waited"}


def test_everybody_arrives_where_the_library_fails_among_equally_early_profiles(monkeypatch):
    """Four crowds: certified, and at least one robot waits that would have rolled."""
    before = [plan(crowd(seed, 12, cells=5), FASTEST).document for seed in SEEDS]
    monkeypatch.setattr("coord.timing.ties.spliced", _library)
    after = [plan(crowd(seed, 12, cells=5), FASTEST) for seed in SEEDS]
    assert all(result.certified for result in after)
    assert before != [result.document for result in after]


#: Steps that are switched off one by one; a program is also sought where the gap to the bound is closed.
SWITCHES = {
    "splice": ("coord.timing.choices.spliced", "coord.timing.ties.spliced"),
    "program": ("coord.timing.choices.through_tube", "coord.timing.closing.through_tube"),
    "branch and bound": ("coord.timing.passing.branch_and_bound",),
}


@pytest.mark.long
@pytest.mark.parametrize("step", SWITCHES)
def test_arrival_does_not_hang_on_any_single_step(monkeypatch, step):
    """200 crowds without a ring of handed-over places: certified with the step switched off, some of them otherwise than with it."""
    problems = [crowd(seed, 7, cells=4, shapes=SHAPES[list(SHAPES)[seed % 3]]) for seed in range(100, 300)]
    before = [plan(problem, FASTEST).document for problem in problems[:40]]
    instead = (
        (lambda _: (0, True)) if step == "branch and bound" else (lambda *_, **__: [] if step == "splice" else None)
    )
    for target in SWITCHES[step]:
        monkeypatch.setattr(target, instead)
    after = [plan(problem, FASTEST) for problem in problems]
    assert all(result.certified for result in after)
    assert not any("room to pass" in told.text for result in after for told in result.plan.rerouted)
    assert before != [result.document for result in after[:40]]
