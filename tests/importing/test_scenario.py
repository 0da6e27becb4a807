"""Scenarios of the Moving AI Lab."""

from __future__ import annotations

import pytest

MAP = "type octile\nheight 4\nwidth 6\nmap\n......\n.@@...\n......\n.....T\n"


def rows(*places, head="version 1\n", name="small.map", size=(6, 4)):
    """A scenario with these starts and goals (x, y, x, y)."""
    return head + "".join(
        "\t".join(map(str, (k // 10, name, *size, *place, 3.0))) + "\n" for k, place in enumerate(places)
    )


@pytest.fixture(autouse=True)
def small_map(tmp_path):
    """The map beside the scenario."""
    (tmp_path / "small.map").write_text(MAP)


@pytest.mark.parametrize(("options", "size"), [({}, 1.0), ({"resolution": 0.5}, 0.5)])
def test_robots_stand_in_the_middle_of_their_cells_with_y_upwards(bring, options, size):
    """Cell (0, 0) is the upper left one; discs are 0.3 cells; the map is named relative to the problem."""
    found = bring("a.scen", rows((0, 0, 5, 2), (3, 3, 0, 1)), **options)
    first, second = found.problem.robots
    assert (first.start, first.goal) == ((0.5 * size, 3.5 * size), (5.5 * size, 1.5 * size))
    assert (second.start, second.goal) == ((3.5 * size, 0.5 * size), (0.5 * size, 2.5 * size))
    assert first.footprint.radius == pytest.approx(0.3 * size)
    assert 'map = "../small.map"' in found.text
    assert found.problem.workspace.bounds == (0.0, 0.0, 6 * size, 4 * size)


def test_rows_that_do_not_fit_are_left_out_and_counted(bring):
    """On an obstacle, on another robot's start or goal, off the map, on another map: each with its reason."""
    text = rows((0, 0, 5, 0), (1, 1, 0, 3), (0, 3, 5, 3), (0, 0, 0, 2), (0, 3, 5, 0), (9, 0, 0, 3), (0, 3, 4, 3))
    found = bring("a.scen", text, robots=7)
    assert [robot.name for robot in found.problem.robots] == ["robot 1", "robot 7"]
    (said,) = [remark for remark in found.remarks if remark.startswith("Left out")]
    for reason in ("start without room (2)", "goal without room (1)"):
        assert reason in said
    assert "start too near to that of a robot taken before (1)" in said
    assert "goal too near to that of a robot taken before (1)" in said
    assert "No more than 2 robots fit." in found.remarks
    assert all(f"# {word}" in found.text for word in ("Imported", "Left out"))


def test_the_first_rows_are_taken_as_many_as_wanted(bring):
    """Two of twelve, and nothing more is said."""
    lanes = [(k % 6, 2 * (k // 6), (k + 1) % 6, 2 * (k // 6)) for k in range(12)]
    found = bring("a.scen", rows(*lanes), robots=2)
    assert [robot.name for robot in found.problem.robots] == ["robot 1", "robot 2"]
    assert not any("--robots" in remark for remark in found.remarks)


def test_without_a_number_ten_robots_are_taken(bring):
    """And the text says how to get more."""
    lanes = [(k % 6, 2 * (k // 6), (k + 1) % 6, 2 * (k // 6)) for k in range(12)]
    found = bring("a.scen", rows(*lanes))
    assert len(found.problem.robots) == 10
    assert "More rows are imported with --robots." in found.remarks


def test_larger_robots_need_room_for_all_of_them(bring):
    """A disc of 0.7 m does not stand beside an occupied cell, nor in a corner of the map."""
    found = bring("a.scen", rows((0, 0, 4, 1), (4, 1, 4, 2), (3, 1, 4, 2)), radius=0.7)
    assert [robot.name for robot in found.problem.robots] == ["robot 2"]


def test_a_map_may_be_given_and_its_folder_in_the_row_is_not_needed(bring, tmp_path):
    """maps/small.map is found beside the scenario as small.map, or wherever --map says."""
    assert bring("a.scen", rows((0, 0, 5, 2), name="maps/small.map")).problem.robots
    (tmp_path / "other.map").write_text(MAP)
    found = bring("b.scen", rows((0, 0, 5, 2), name="x.map"), map=tmp_path / "other.map", force=True)
    assert 'map = "../other.map"' in found.text


def test_faulty_rows_are_told_all_at_once_with_their_lines(refused):
    """Too few columns, a negative cell, words for numbers."""
    text = "version 1\n0\ta.map\t3\n" + rows((0, 0, -1, 2), head="") + rows(("a", 0, 0, 0), head="")
    faults = refused("a.scen", text)
    assert [fault.partition(": a row is bucket, map,")[0] for fault in faults] == ["a.scen:2", "a.scen:3", "a.scen:4"]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("version 2\n", 'a.scen:1: version must be 1 (got "2")'),
        ("version 1\n", "a.scen: the scenario has no rows"),
        (rows((0, 0, 1, 0), name="x.map"), 'a.scen:2: the map "x.map" is not found beside the scenario'),
        (rows((0, 0, 1, 0), size=(7, 4)), "a.scen:2: the row is for a map of 7 x 4 cells"),
        (rows((1, 1, 1, 0)), "a.scen:2: no robot has room (start without room: 1)"),
    ],
)
def test_what_is_no_scenario_is_refused(refused, text, fault):
    """Another version, nothing in it, no map, a map of another size, nobody left."""
    (said,) = refused("a.scen", text)
    assert said.startswith(fault)
