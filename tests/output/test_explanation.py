"""The story before planning, as a text and as an object."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest

from coord.explain import Encounter, Explanation, explain
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.output.explanation import MOST_ENCOUNTERS, record, text

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FLOOR = Workspace((0.0, 0.0, 12.0, 12.0), 0.05)
ACROSS = ((1.0, 6.0), (11.0, 6.0))
RACK = rectangle("rack 3", (5.0, 5.0, 7.0, 12.0))
COLUMN = Circle("column", (6.0, 6.0), 1.0)

Way = tuple[tuple[float, float], tuple[float, float]]


def robot(name: str, way: Way, priority: float | None = None, release: float = 0.0, side: str = "quickest") -> Robot:
    return Robot(name, Footprint(0.3), LIMITS, *way, priority=priority, release=release, side=side)


def story(*robots: Robot, obstacles: tuple[Circle | Polygon, ...] = (), **options: object) -> Explanation:
    return explain(Problem("hall", FLOOR, robots, obstacles), Options(**options))  # type: ignore[arg-type]


def lines_with(explanation: Explanation, *parts: str) -> list[str]:
    return [line.strip() for line in text(explanation).splitlines() if all(part in line for part in parts)]


def leaving(priorities: tuple[float | None, float | None]) -> Explanation:
    """Blue starts on red's way and leaves it downwards: it goes before red whatever the priorities are."""
    red, blue = robot("red", ACROSS, priorities[0]), robot("blue", ((6.0, 6.0), (6.0, 1.0)), priorities[1])
    return story(red, blue)


@pytest.fixture
def eight() -> Explanation:
    """Eight robots on parallel ways, and one that starts in the way of the first and parks in that of the last."""
    rows = [robot(f"row {k}", ((1.0, 1.0 + 1.2 * k), (11.0, 1.0 + 1.2 * k)), k + 1.0) for k in range(8)]
    return story(*rows, robot("late", ((6.0, 1.0), (6.0, 9.4)), 99.0))


def test_the_text_names_every_arc_with_both_robots_and_the_place(eight: Explanation):
    """Each on a line of its own, under a heading that says which of the two goes first."""
    assert {arc.at for arc in swap().arcs} == {"start", "goal"}
    for explanation in (eight, leaving((1.0, 2.0)), swap()):
        assert len(explanation.arcs) > 0
        for arc in explanation.arcs:
            place = f"({arc.place[0]:.2f}, {arc.place[1]:.2f})" if arc.place else ""
            verb = "stands in" if arc.at == "start" else "would park in"
            assert len(lines_with(explanation, f'"{arc.first}" before "{arc.then}"', verb, place)) == 1


def swap() -> Explanation:
    return story(robot("red", ACROSS), robot("blue", (ACROSS[1], ACROSS[0])), keep_paths=True)


def test_every_deviation_from_the_priorities_is_told_with_its_arc():
    """The sentence of the contract: who, before whom, that its priority is lower, and what would be in the way where."""
    (line,) = lines_with(leaving((1.0, 2.0)), '"blue" goes before "red"')
    assert line == (
        '"blue" goes before "red" although its priority is lower (2 comes after 1): '
        """"blue" stands in "red"'s way at (6.00, 6.00) until it leaves."""
    )


def test_a_robot_that_would_park_in_the_way_is_told_as_the_reason():
    """Red would park where blue passes, so blue goes first."""
    told = story(robot("red", ((6.0, 1.0), (6.0, 6.0)), 1.0), robot("blue", ACROSS, 2.0))
    (line,) = lines_with(told, '"blue" goes before "red"')
    assert line.endswith(""": "red" would park in "blue"'s way at (6.00, 6.00).""")


def test_a_chain_of_arcs_is_told_arc_by_arc_and_the_others_that_are_overtaken_are_counted(eight: Explanation):
    """Row 7 must pass before late parks, and late must leave before row 0 passes: so row 7 goes before rows 0 to 6."""
    (line,) = lines_with(eight, '"row 7" goes before "row 0"')
    parks = """"late" would park in "row 7"'s way at (6.00, 9.40)"""
    stands = """"late" stands in "row 0"'s way at (6.00, 1.00) until it leaves"""
    assert f"(8 comes after 1): {parks}; and {stands}." in line
    assert "6 more robots" in line
    assert len(lines_with(eight, "although")) == 2
    assert lines_with(eight, "the order of the priorities") == []


@pytest.mark.parametrize(
    ("priorities", "rule"),
    [
        ((1.0, 2.0), "its priority is lower (2 comes after 1)"),
        ((1.0, None), 'it has no priority, and "red" has'),
        ((None, None), "alone it would arrive earlier (at 7.50 s, not 12.50 s)"),
        ((1.0, 1.0), "it comes later in the file"),
    ],
)
def test_a_deviation_says_by_which_rule_the_other_would_come_first(
    priorities: tuple[float | None, float | None], rule: str
):
    """Priority, having one, the longer way alone, the place in the file: the first that differs."""
    assert len(lines_with(leaving(priorities), f'"blue" goes before "red" although {rule}')) == 1


def test_where_no_arc_forbids_it_the_order_is_that_of_the_priorities():
    """Blue has the higher priority and no deviation is told."""
    told = leaving((2.0, 1.0))
    assert lines_with(told, "blue, red") == ["blue, red"]
    assert lines_with(told, "although") == []
    assert len(lines_with(told, "the order of the priorities")) == 1


def test_a_robot_whose_side_does_not_exist_says_why():
    """The rack reaches the upper edge: to the right of it, and no way on the left, because of the rack."""
    told = story(robot("red", ACROSS), obstacles=(RACK,))
    assert len(lines_with(told, '"red": right of "rack 3", ', " m, ", " s")) == 1
    assert len(lines_with(told, "left: no way: there is no gap", '"rack 3"')) == 1
    (left,) = (way for way in record(told)["robots"][0]["sides"] if way["side"] == "left")  # type: ignore[index]
    assert (left["length"], left["time"], left["is_bound"]) == (None, None, False)
    assert left["reason"].startswith("there is no gap")


def test_the_other_side_is_told_with_its_length_and_time_and_how_much_slower_it_is():
    """A box of which one side is nearer: the difference is that of the times told."""
    told = story(robot("red", ACROSS), obstacles=(rectangle("box", (5.0, 5.0, 7.0, 8.0)),))
    (trip,) = told.trips
    assert trip.route is not None
    (left,) = (way for way in trip.route.ways if way.side == "left")
    assert left.length is not None
    assert left.time is not None
    assert lines_with(told, "left:") == [
        f"left: {left.length:.2f} m, {left.time:.2f} s, {left.time - trip.route.time:.2f} s slower"
    ]
    level = story(robot("red", ACROSS), obstacles=(COLUMN,))
    assert len(lines_with(level, "as quick")) == 1


def test_a_side_that_was_asked_for_is_told_as_such():
    """The longer way round, because the problem says so."""
    told = story(robot("red", ACROSS, side="left"), obstacles=(COLUMN,))
    assert len(lines_with(told, '"red": left of "column" as asked for')) == 1


def test_an_exponential_detour_is_told_with_a_and_b_and_r_squared_of_rise_and_fall():
    """As numbers in the object, rounded in the text."""
    told = story(robot("red", ACROSS), obstacles=(Circle("column", (6.0, 6.1), 0.5),), shape="exponential")
    fits = told.trips[0].route.fits  # type: ignore[union-attr]
    assert [fit.flank for fit in fits] == ["rise", "fall"]
    for fit in fits:
        figures = f"A = {fit.A:.4g} m, B = {fit.B:.4g} 1/m, R2 = {fit.r_squared:.4f}"
        assert len(lines_with(told, f"{fit.flank}: y = A exp(B x)", figures)) == 1
    assert record(told)["robots"][0]["fits"] == [  # type: ignore[index]
        {"flank": fit.flank, "A": fit.A, "B": fit.B, "r_squared": fit.r_squared} for fit in fits
    ]


def test_where_the_exponential_shape_gives_up_it_says_so_and_why():
    """Out of a pocket that is shut towards the goal the way turns back, and has no one height over the line."""
    pocket = Polygon("pocket", [(4, 4), (7, 4), (7, 8), (4, 8), (4, 7.7), (6.7, 7.7), (6.7, 4.3), (4, 4.3)])
    told = story(robot("red", ((6.0, 6.0), (11.0, 6.0))), obstacles=(pocket,), shape="exponential")
    assert told.trips[0].route.fits == ()  # type: ignore[union-attr]
    (remark,) = told.trips[0].route.remarks  # type: ignore[union-attr]
    assert lines_with(told, "Fitted turns instead of exponential ones") == [remark]
    assert record(told)["robots"][0]["remarks"] == [remark]  # type: ignore[index]


def test_a_robot_without_a_way_says_why_and_what_helps_and_ends_the_story_without_an_order():
    """Its goal stands in the rack."""
    told = story(robot("red", ((1.0, 6.0), (6.0, 6.0))), robot("blue", ((1.0, 2.0), (11.0, 2.0))), obstacles=(RACK,))
    (diagnosis,) = told.diagnoses
    assert lines_with(told, '"red": no way') == ['"red": no way']
    assert lines_with(told, diagnosis.text) == [diagnosis.text]
    assert lines_with(told, "Remedy") == [f"Remedy: {diagnosis.remedy}"]
    assert lines_with(told, "There is no plan as long as") == ['There is no plan as long as "red" has no way.']
    assert lines_with(told, '"blue": straight, 10.00 m')


def test_a_ring_is_told_instead_of_an_order_with_what_helps():
    """Two robots that swap places on one line and keep their paths."""
    told = swap()
    (ring,) = told.diagnoses
    assert len(lines_with(told, "blocking-cycle", ring.text)) == 1
    assert lines_with(told, "Remedy") == [f"Remedy: {ring.remedy}"]
    assert lines_with(told, "the order of the priorities") == []


def test_who_was_re_routed_is_told_and_without_any_there_is_no_such_section():
    """Blue starts on red's line and red's start is on blue's: one goes round."""
    ring = robot("red", ((2.0, 6.0), (10.0, 6.0))), robot("blue", ((6.0, 6.0), (2.0, 6.4)))
    told = story(*ring)
    (one,) = told.rerouted
    assert lines_with(told, one.text) == [one.text]
    assert len(lines_with(told, "Re-routed")) == 1
    assert lines_with(story(*ring, keep_paths=True), "Re-routed") == []


def test_more_than_thirty_meetings_are_counted_in_the_text_and_all_in_the_object(eight: Explanation):
    """So that a text about a thousand robots stays readable."""
    many = tuple(Encounter(("row 0", "late"), (0.0, k / 10), ((0.0, 1.0), (0.0, 1.0))) for k in range(47))
    told = replace(eight, encounters=many)
    assert len(lines_with(told, "at (0.00, ", "of its path")) == MOST_ENCOUNTERS == 30
    assert lines_with(told, "17 more") == ["and 17 more; --json tells all"]
    assert len(lines_with(told, "Meetings: 47, of 1 pair")) == 1
    assert len(record(told)["meetings"]) == 47  # type: ignore[arg-type]


def test_a_meeting_is_told_with_its_place_and_the_stretch_of_each_path():
    """A crossing at (6, 6)."""
    told = story(robot("red", ACROSS), robot("blue", ((6.0, 1.0), (6.0, 11.0))))
    (line,) = lines_with(told, "at (", "of its path")
    assert line.startswith(("at (6.0", "at (5.9"))
    assert '"red" from 4.35 to 5.65 m' in line
    assert '"blue" from 4.35 to 5.65 m' in line


def test_robots_that_never_meet_are_said_to():
    """Neither meetings nor arcs: every order would do."""
    told = story(robot("red", ACROSS), robot("blue", ((1.0, 2.0), (11.0, 2.0))))
    assert lines_with(told, "No two paths come too near")
    assert lines_with(told, "Nobody starts or parks in anybody's way.")


def test_a_release_and_a_robot_that_stays_are_told():
    """A robot whose goal is its start stays; a release delays the arrival by as much."""
    told = story(robot("red", ACROSS, release=3.0), robot("blue", ((6.0, 2.0), (6.0, 2.0))))
    assert lines_with(told, "released at 3.00 s: alone it arrives at 15.50 s")
    assert record(told)["robots"][0]["solo_arrival"] == pytest.approx(15.5)  # type: ignore[index]
    assert lines_with(told, '"blue": stays where it is, 0.00 m, 0.00 s')


def test_the_object_has_the_same_keys_whatever_came_of_it_and_finite_numbers_or_null(eight: Explanation):
    """With an order, with a ring, without a way, with a fit that has no R squared."""
    lost = story(robot("red", ((1.0, 6.0), (6.0, 6.0))), obstacles=(RACK,))
    bent = story(robot("red", ACROSS), obstacles=(Circle("column", (6.0, 6.1), 0.5),), shape="exponential")
    (trip,) = bent.trips
    assert trip.quickest is not None
    fits = tuple(replace(fit, r_squared=math.nan) for fit in trip.quickest.fits)
    flat = replace(bent, trips=(replace(trip, quickest=replace(trip.quickest, fits=fits)),))
    found = [record(one) for one in (eight, swap(), lost, flat)]
    for one in found:
        assert json.loads(json.dumps(one, allow_nan=False)) == json.loads(json.dumps(one))
        assert list(one) == list(found[0])
        assert all(list(part) == list(found[0]["robots"][0]) for part in one["robots"])  # type: ignore[index, attr-defined]
    assert found[3]["robots"][0]["fits"][0]["r_squared"] is None  # type: ignore[index]
    assert found[2]["robots"][0]["length"] is None  # type: ignore[index]
    assert (found[0]["order"] is None, found[1]["order"]) == (False, None)


def test_the_object_says_what_the_explanation_holds(eight: Explanation):
    """Order, urgency, arcs, deviations with their arcs, diagnoses: the same values under plain keys."""
    found = record(eight)
    assert found["order"] == list(eight.order or ())
    assert found["most_urgent_first"] == list(eight.urgent)
    arcs = [{"first": arc.first, "then": arc.then, "at": arc.at, "place": list(arc.place or ())} for arc in eight.arcs]
    assert found["blocking"] == arcs
    told = found["deviations"]
    assert [(one["robot"], one["before"], one["others"]) for one in told] == [  # type: ignore[attr-defined]
        ("row 7", "row 0", 6),
        ("late", "row 0", 6),
    ]
    for one, kept in zip(told, eight.deviations, strict=True):  # type: ignore[call-overload]
        assert [(arc["first"], arc["then"]) for arc in one["because"]] == [(arc.first, arc.then) for arc in kept.chain]
    assert record(swap())["diagnoses"][0]["code"] == "blocking-cycle"  # type: ignore[index]
