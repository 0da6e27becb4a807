"""One robot more: whoever is kept moves as before to the last bit, and whoever joins is certified or told why not."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from coord.coordination.blocking import arc_of, find_blocks
from coord.coordination.extending import extended
from coord.coordination.kept import LACKING, OFF_THE_FLOOR, kept
from coord.errors import InvalidValueError, NoPlanError
from coord.model.footprint import Footprint, square
from coord.model.obstacle import Circle, rectangle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.output.plan_file import parse, serialise
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FLOOR = Workspace((-12.0, -12.0, 12.0, 12.0), 0.05)
DISC = Footprint(0.3)

VAN = Robot("van", DISC, LIMITS, (-9.0, 0.0), (9.0, 0.0))
CART = Robot("cart", DISC, LIMITS, (0.0, -9.0), (0.0, 9.0))
FAR = Robot("far", DISC, LIMITS, (-9.0, 11.0), (9.0, 11.0))


def scene(*robots, obstacles=(), floor=FLOOR):
    return Problem("scene", floor, tuple(robots), tuple(obstacles))


def planned(problem, options=None):
    """A certified plan, read back from its bytes."""
    result = plan(problem, options)
    assert result.certified, result.diagnoses
    return parse(result.document)


def extend(problem, old, options=None):
    return plan(problem, options, extend=kept(problem, old))


def records(document):
    """Each robot's part of a plan file, as text."""
    return {part["name"]: json.dumps(part) for part in json.loads(document)["robots"]}


def part_of(made, name):
    return next(part for part in made.robots if part.robot.name == name)


def without(problem, name):
    return dataclasses.replace(problem, robots=tuple(robot for robot in problem.robots if robot.name != name))


def with_robot(problem, name, **more):
    robots = tuple(dataclasses.replace(one, **more) if one.name == name else one for one in problem.robots)
    return dataclasses.replace(problem, robots=robots)


def motion(part):
    profile, path = part.profile, part.path
    arrays = (profile.times, profile.states, profile.jerks, path.pieces)
    return (path.start, *(array.tolist() for array in arrays))


@pytest.mark.parametrize("seed", range(3))
def test_with_nothing_new_the_plan_comes_out_with_the_same_bytes(crowd, seed):
    """Read back, extended by nobody and written again, a plan is the same file."""
    problem = crowd(seed)
    result = plan(problem)
    assert extend(problem, parse(result.document)).document == result.document


@pytest.mark.parametrize(("seed", "shape"), [(0, DISC), (1, DISC), (2, square(0.5))], ids=["disc", "other", "square"])
def test_whoever_is_missing_joins_and_all_others_keep_their_records(crowd, seed, shape):
    """Each robot of a crowd in turn: certified with all other records unchanged to the byte, or told who is in the way."""
    problem = crowd(seed, count=8, shape=shape)
    joined = 0
    for robot in problem.robots:
        before = plan(without(problem, robot.name))
        assert before.certified
        after = extend(problem, parse(before.document))
        if after.plan is None:
            (told,) = after.diagnoses
            assert told.code == "cannot-join"
            assert told.robots[0] == robot.name
            assert plan(problem).certified
            continue
        joined += 1
        assert after.certified, after.diagnoses
        old, new = records(before.document), records(after.document)
        assert {name: new[name] for name in old} == old
        assert after.plan.order == (*before.plan.order, robot.name)
        check_arcs(after.plan)
    assert joined >= 6


def check_arcs(made):
    """The blocking graph of a plan is that of its paths, but for arcs that its order does not follow."""
    robots, everybody = made.problem.robots, range(len(made.robots))
    pairs = [(i, k) for i in everybody for k in everybody if i < k]
    paths, clearance = [part.path for part in made.robots], made.problem.workspace.clearance
    arcs = [arc_of(robots, block) for block in find_blocks(robots, paths, pairs, clearance)]
    rank = {name: k for k, name in enumerate(made.order)}
    assert list(made.blocking) == [arc for arc in arcs if rank[arc.first] < rank[arc.then]]


def test_the_sums_and_bounds_are_those_of_all_robots():
    """Sum, makespan and bound of an extended plan are what its records say."""
    problem = scene(VAN, CART, FAR)
    result = extend(problem, planned(scene(CART, FAR)))
    said = json.loads(result.document)["result"]
    assert said["sum_of_arrivals"] == pytest.approx(sum(part.arrival for part in result.plan.robots))
    assert said["makespan"] == max(part.arrival for part in result.plan.robots)
    assert said["lower_bound"] == pytest.approx(sum(part.solo_bound for part in result.plan.robots))
    van = part_of(result.plan, "van")
    assert (*van.after, *van.before) == ("cart",)
    assert van.solo_bound <= van.lower_bound <= van.arrival


def test_a_robot_on_somebodys_path_leaves_in_time():
    """Its start is on the van's line; it is gone when the van comes, whose record is the same; the arc is no rule here."""
    before = plan(scene(VAN))
    problem = scene(VAN, Robot("new", DISC, LIMITS, (5.0, 0.0), (5.0, 8.0)))
    result = extend(problem, parse(before.document))
    assert result.certified
    assert records(result.document)["van"] == records(before.document)["van"]
    assert result.plan.blocking == ()
    assert part_of(result.plan, "new").before == ("van",)


def test_a_robot_that_cannot_leave_in_time_is_told_and_a_full_run_helps():
    """Released long after the van has passed its start: who, where, when; planned anew, the van waits."""
    problem = scene(VAN, Robot("new", DISC, LIMITS, (5.0, 0.0), (5.0, 8.0), release=60.0))
    old = planned(scene(VAN))
    result = extend(problem, old)
    assert (result.plan, result.document) == (None, b"")
    (told,) = result.diagnoses
    assert told.code == "cannot-join"
    assert told.robots == ("new", "van")
    assert told.place == (5.0, 0.0)
    van = old.robots[0]
    assert van.path.point(van.profile.state([told.time])[:, 0]).tolist()[0] == pytest.approx([5.0, 0.0], abs=1e-6)
    assert '"van" passes its start (5.00, 0.00)' in told.text
    assert "without extending" in told.remedy
    assert plan(problem).certified


def test_a_goal_on_the_way_is_passed_before_or_gone_round():
    """Where the cart parks late the new robot drives straight; where it has parked already, round it, and that is told."""
    for release, is_straight in ((30.0, True), (0.0, False)):
        parks = Robot("parks", DISC, LIMITS, (1.0, -3.0), (1.0, 0.0), release=release)
        problem = scene(parks, dataclasses.replace(VAN, start=(-3.0, 0.0), name="new"))
        result = extend(problem, planned(scene(parks)))
        assert result.certified
        new = part_of(result.plan, "new")
        assert (len(new.path.pieces) == 1) == is_straight
        assert [
            (told.robot, [(arc.first, arc.then, arc.at) for arc in told.around]) for told in result.plan.rerouted
        ] == ([] if is_straight else [("new", [("new", "parks", "goal")])])
        if not is_straight:
            (told,) = result.plan.rerouted
            assert told.text.startswith('"new" goes round "parks" at its goal')
            assert told.extra_length > 0


@pytest.mark.parametrize("reason", ["kept", "given", "lane"])
def test_a_goal_that_is_neither_passed_before_nor_gone_round_is_told(reason):
    """With paths kept, with a given path, or in a lane: who parks where and when; a full run goes first."""
    walls = [rectangle(f"wall {k}", (-12.0, y, 12.0, y + 0.2)) for k, y in enumerate((-0.8, 0.6))]
    obstacles = walls if reason == "lane" else []
    parks = Robot("parks", DISC, LIMITS, (1.0, 0.0), (2.0, 0.0))
    given = (VAN.start, VAN.goal) if reason == "given" else ()
    new = dataclasses.replace(VAN, name="new", start=(-9.0, 0.0), goal=(9.0, 0.0), path=given)
    options = Options(keep_paths=reason == "kept")
    old = planned(scene(parks, obstacles=obstacles), options)
    result = extend(scene(parks, new, obstacles=obstacles), old, options)
    (told,) = result.diagnoses
    assert told.code == "cannot-join"
    assert told.robots == ("new", "parks")
    assert told.time == old.robots[0].arrival
    assert told.place == (2.0, 0.0)
    assert ("nor may leave its path" in told.text) == (reason != "lane")


CHANGES = {
    "footprint": {"footprint": Footprint(0.25)},
    "limits": {"limits": Limits(0.9, 0.5, 0.5, 1.0, 0.5)},
    "start": {"start": (0.0, -8.5)},
    "goal": {"goal": (0.0, 8.5)},
    "release": {"release": 3.0},
    "given path": {"path": ((0.0, -9.0), (1.0, 0.0), (0.0, 9.0))},
    "via points or side": {"via": ((1.0, 0.0),)},
}


@pytest.mark.parametrize("what", CHANGES)
def test_a_robot_whose_fields_changed_is_planned_anew_and_named(what):
    """Whatever has changed about the cart is said; the others move as before, and only they keep their places."""
    problem = scene(VAN, CART, FAR)
    before = plan(problem)
    changed = with_robot(problem, "cart", **CHANGES[what])
    holding = kept(changed, parse(before.document))
    assert holding.anew == {1: f"its {what} changed"}
    result = plan(changed, extend=holding)
    assert result.certified, result.diagnoses
    assert result.plan.order == (*(name for name in before.plan.order if name != "cart"), "cart")
    for name in ("van", "far"):
        assert motion(part_of(result.plan, name)) == motion(part_of(before.plan, name))
    assert records(result.document)["far"] == records(before.document)["far"]
    assert part_of(result.plan, "cart").robot == changed.robots[1]


ROUND = {
    "left": {"side": "left"},
    "right": {"side": "right"},
    "past places": {"via": ((3.0, -5.0), (-3.0, 5.0))},
    "past places on a side": {"via": ((3.0, -5.0),), "side": "left"},
    "given": {"path": ((0.0, -9.0), (4.0, 0.0), (0.0, 9.0)), "corner_radius": 0.5},
}


@pytest.mark.parametrize("how", ROUND)
@pytest.mark.parametrize("shape", ["fitted", "follow"])
def test_a_way_that_was_asked_for_and_taken_is_kept(how, shape):
    """A plan keeps no sides, places and given paths; that its path has them can be seen."""
    problem = scene(dataclasses.replace(CART, **ROUND[how]), FAR, obstacles=[Circle("pond", (0.3, 0.0), 2.0)])
    result = plan(problem, Options(shape=shape))
    assert result.certified
    again = extend(problem, parse(result.document))
    assert again.document == result.document


@pytest.mark.parametrize(
    ("then", "now"),
    [
        ({"side": "left"}, {"side": "right"}),
        ({"side": "right"}, {"side": "left"}),
        ({"via": ((3.0, -5.0), (3.0, 5.0))}, {"via": ((3.0, 5.0), (3.0, -5.0))}),
        ({"path": ROUND["given"]["path"]}, {"path": ROUND["given"]["path"], "corner_radius": 0.5}),
    ],
    ids=["left", "right", "other order", "other corners"],
)
def test_another_side_order_or_corner_is_seen(then, now):
    """Planned one way and asked for the other, the robot is planned anew, as asked for."""
    problem = scene(dataclasses.replace(CART, **then), FAR, obstacles=[Circle("pond", (0.3, 0.0), 2.0)])
    old = planned(problem)
    changed = with_robot(problem, "cart", **({"side": "quickest", "via": (), "path": ()} | now))
    holding = kept(changed, old)
    assert list(holding.anew) == [0]
    assert list(kept(changed, planned(changed)).anew) == []


def test_a_changed_priority_leaves_the_motion_and_is_named():
    """The record is the same but for the priority that it tells."""
    problem = scene(VAN, CART)
    before = plan(problem)
    changed = with_robot(problem, "cart", priority=1.0)
    holding = kept(changed, parse(before.document))
    assert (holding.anew, holding.unheeded) == ({}, (1,))
    result = plan(changed, extend=holding)
    assert result.certified
    old, new = records(before.document), records(result.document)
    assert new["van"] == old["van"]
    assert new["cart"] == old["cart"].replace('"priority": null', '"priority": 1.0')


def test_who_met_a_robot_that_is_gone_moves_on_but_promises_less():
    """Without the van the cart's lists and bound are those of a robot alone; who never met the van is the same."""
    problem = scene(VAN, CART, FAR)
    before = plan(problem)
    assert before.plan.order.index("van") < before.plan.order.index("cart")
    old = parse(before.document)
    less = without(problem, "van")
    holding = kept(less, old)
    assert (holding.dropped, holding.anew) == (("van",), {})
    result = plan(less, extend=holding)
    assert result.certified
    cart, was = part_of(result.plan, "cart"), part_of(before.plan, "cart")
    assert was.lower_bound > was.solo_bound
    assert (cart.after, cart.before, cart.lower_bound) == ((), (), was.solo_bound)
    assert motion(cart) == motion(was)
    assert records(result.document)["far"] == records(before.document)["far"]


def test_a_new_obstacle_sends_those_on_whose_path_it_stands_round_it():
    """They are named, with the reason; all others keep their records."""
    robots = [VAN, FAR]
    before = plan(scene(*robots))
    problem = scene(*robots, obstacles=[rectangle("crate", (2.0, -0.5, 3.0, 0.4))])
    holding = kept(problem, parse(before.document))
    assert holding.anew == {0: OFF_THE_FLOOR}
    result = plan(problem, extend=holding)
    assert result.certified
    assert records(result.document)["far"] == records(before.document)["far"]


def test_an_obstacle_beside_all_paths_changes_nothing():
    """It touches the distance that the van keeps, exactly."""
    before = plan(scene(VAN, FAR))
    problem = scene(VAN, FAR, obstacles=[rectangle("crate", (2.0, 0.35, 3.0, 1.0)), Circle("post", (0.0, -1.35), 1.0)])
    result = extend(problem, parse(before.document))
    assert result.certified
    assert records(result.document) == records(before.document)


def test_a_smaller_floor_and_a_robot_that_never_moves():
    """Who drives outside the new edge is planned anew; who stands within it is kept."""
    rests = Robot("rests", DISC, LIMITS, (-5.0, -5.0), (-5.0, -5.0))
    wide = dataclasses.replace(VAN, path=((-9.0, 0.0), (0.0, -9.0), (9.0, 0.0)))
    old = planned(scene(rests, wide))
    floor = Workspace((-10.0, -6.0, 10.0, 6.0), 0.05)
    problem = scene(rests, dataclasses.replace(wide, path=()), floor=floor)
    holding = kept(problem, old)
    assert holding.anew == {1: OFF_THE_FLOOR}
    assert plan(problem, extend=holding).certified


def test_with_a_larger_clearance_those_too_near_are_planned_anew():
    """Van and cart cross with hardly more than 0.05 m between them: with 0.3 m to keep, the later one is planned anew."""
    robots = [VAN, CART, FAR]
    before = plan(scene(*robots), Options(profile="fastest"))
    problem = scene(*robots, floor=dataclasses.replace(FLOOR, clearance=0.3))
    holding = kept(problem, parse(before.document))
    (i,) = holding.anew
    assert robots[i].name == next(name for name in reversed(before.plan.order) if name != "far")
    assert "it no longer keeps clear of" in holding.anew[i]
    result = plan(problem, extend=holding)
    assert result.certified, result.diagnoses
    first = robots[1 - i].name
    assert motion(part_of(result.plan, first)) == motion(part_of(before.plan, first))
    back = kept(scene(*robots), parse(result.document))
    assert back.anew == {}
    assert [part.lower_bound for part in back.parts.values()] == [part.solo_bound for part in back.parts.values()]


def test_robots_that_stay_now_are_planned_anew_where_they_park_in_the_way():
    """With "leave" the cart passed where the van had vanished; with "stay" the van, planned later, parks when it has."""
    short = dataclasses.replace(VAN, goal=(0.0, 0.0))
    late = dataclasses.replace(CART, release=30.0)
    gone = dataclasses.replace(FLOOR, after_arrival="leave")
    old = planned(scene(short, late, floor=gone))
    problem = scene(short, late)
    holding = kept(problem, old)
    assert old.order == ("cart", "van")
    assert list(holding.anew) == [0]
    result = plan(problem, extend=holding)
    assert result.certified, result.diagnoses
    assert result.plan.robots[0].arrival > 30.0 > old.robots[0].arrival
    back = kept(scene(short, late, floor=gone), parse(result.document))
    assert back.anew == {}
    again = plan(back.problem, extend=back)
    assert again.certified
    assert all(arc.at == "start" for arc in again.plan.blocking)


@pytest.mark.parametrize("seed", range(3))
def test_half_a_crowd_joins_the_other_half(crowd, seed):
    """Rings among those who join are opened; the first half keeps its records; each has room or is told why not."""
    problem = crowd(seed, count=12)
    half = dataclasses.replace(problem, robots=problem.robots[::2])
    before = plan(half)
    result = extend(problem, parse(before.document))
    if result.plan is None:
        assert {told.code for told in result.diagnoses} <= {"cannot-join", "blocking-cycle"}
        assert all(told.remedy for told in result.diagnoses)
        return
    assert result.certified, result.diagnoses
    old, new = records(before.document), records(result.document)
    assert {name: new[name] for name in old} == old
    check_arcs(result.plan)


def test_two_who_join_and_block_each_other_in_a_ring():
    """Each starts on the other's way: one goes round, as in a full run, and says so."""
    pair = [Robot("a", DISC, LIMITS, (-2.0, 0.0), (9.0, 0.0)), Robot("b", DISC, LIMITS, (2.0, 0.3), (-9.0, 0.0))]
    result = extend(scene(FAR, *pair), planned(scene(FAR)))
    assert result.certified
    (told,) = result.plan.rerouted
    assert set(told.ring) == {"a", "b"}
    stuck = extend(scene(FAR, *pair), planned(scene(FAR)), Options(keep_paths=True))
    assert [told.code for told in stuck.diagnoses] == ["blocking-cycle"]
    assert stuck.diagnoses[0].remedy.startswith("Plan all robots anew, without extending.")


def test_a_robot_that_leaves_its_place_makes_room_for_one_who_starts_there():
    """The new robot's way leads over a start that is left late: it waits, and the arc says why."""
    late = Robot("late", DISC, LIMITS, (0.0, 0.0), (0.0, 9.0), release=20.0)
    problem = scene(late, dataclasses.replace(VAN, name="new"))
    result = extend(problem, planned(scene(late)))
    assert result.certified
    assert [(arc.first, arc.then, arc.at) for arc in result.plan.blocking] == [("late", "new", "start")]
    assert part_of(result.plan, "new").arrival > 20.0


def test_the_time_limit_ends_the_run():
    """With the time up before the first robot joins there is a diagnosis, and no plan."""
    holding = kept(scene(VAN, CART), planned(scene(VAN)))
    with pytest.raises(NoPlanError) as failure:
        extended(holding, Options(), time_is_up=lambda: True)
    assert [told.code for told in failure.value.diagnoses] == ["time-limit"]


def test_who_joins_by_stopping_stops(crowd):
    """Method "stop" is used for those who join; the others keep their motion, however that was found."""
    problem = scene(VAN, CART)
    old = planned(scene(VAN))
    result = extend(problem, old, Options(method="stop", profile="fastest"))
    assert result.certified
    assert motion(part_of(result.plan, "van")) == motion(old.robots[0])


def test_without_an_order_nobody_comes_last():
    """Method "nearest" cannot extend, and says what can; nor can what holds of a plan for another problem."""
    holding = kept(scene(VAN, CART), planned(scene(VAN)))
    with pytest.raises(InvalidValueError, match="nearest"):
        plan(holding.problem, Options(method="nearest"), extend=holding)
    with pytest.raises(InvalidValueError, match="this very problem"):
        plan(scene(VAN, CART), extend=holding)


def test_reasons_are_in_the_order_of_the_problem():
    """Those the plan lacks and those it has otherwise, together."""
    problem = scene(Robot("new", DISC, LIMITS, (5.0, 5.0), (6.0, 5.0)), VAN, CART, FAR)
    old = planned(scene(CART, with_robot(scene(VAN), "van", release=1.0).robots[0], FAR))
    assert list(kept(problem, old).anew.items()) == [(0, LACKING), (1, "its release changed")]


def test_what_is_kept_serialises_to_the_very_text_it_was_read_from(crowd):
    """Line by line of the file, not only as values."""
    problem = crowd(4, count=8)
    before = plan(without(problem, "r3"))
    after = extend(problem, parse(before.document))
    assert after.certified
    body = before.document[before.document.index(b'"robots": [') : before.document.index(b'"order"')]
    for text in body.split(b'\n {"name"')[1:]:
        assert text.rstrip(b"],\n ") in after.document
    assert np.array_equal(serialise(after.plan), after.document)
