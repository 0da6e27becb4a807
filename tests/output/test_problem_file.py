"""Problem files written by coord: they read back as what they say, and a person can read them."""

from __future__ import annotations

import tomllib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.model.footprint import Footprint, polygon, square
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.output.problem_file import Draft, draft_of, outline, written
from coord.reading.problem_file import read_problem

LIMITS = Limits(1.0, 0.5, 0.4, 1.1, 0.3)
NUMBERS = st.floats(-1e6, 1e6) | st.integers(-(10**6), 10**6)
VALUES = NUMBERS | st.booleans() | st.text() | st.lists(st.tuples(NUMBERS, NUMBERS), max_size=40)


@settings(deadline=None)
@given(st.dictionaries(st.sampled_from("abcdef"), VALUES), st.text(), st.text())
def test_whatever_is_written_reads_back_exactly(fields, name, remark):
    """Numbers to the last digit, texts with quotes and line breaks, long lists over several lines; a comment is none."""
    found = tomllib.loads(written(Draft(name, (remark,), fields, robots=({"#": remark, **fields},))))

    def plain(value):
        return [list(item) for item in value] if isinstance(value, list) else value

    expected = {key: plain(value) for key, value in fields.items()}
    assert found["name"] == name
    assert found.get("workspace", {}) == expected
    assert found["robots"] == [expected]


def test_half_a_surrogate_pair_becomes_a_replacement_character():
    """JSON can bring such texts; TOML cannot say them."""
    assert tomllib.loads(written(Draft("a\ud800b")))["name"] == "a\ufffdb"


def same(a: Problem, b: Problem) -> None:
    """Two problems say the same, digests apart."""
    assert (a.name, a.workspace, a.robots, dict(a.options)) == (b.name, b.workspace, b.robots, dict(b.options))
    assert len(a.obstacles) == len(b.obstacles)
    for one, other in zip(a.obstacles, b.obstacles, strict=True):
        assert one.name == other.name
        if isinstance(one, Circle):
            assert one == other
        else:
            assert [ring.tolist() for ring in one.rings] == [ring.tolist() for ring in other.rings]


def test_a_problem_written_reads_back_as_the_same_problem(tmp_path):
    """All kinds of footprints, ways and obstacles; what robots share stands in [defaults] once."""
    robots = (
        Robot("disc", Footprint(0.3), LIMITS, (1.0, 1.0), (9.0, 1.0), priority=2.0, side="left", via=((5.0, 2.0),)),
        Robot("square", square(0.5), LIMITS, (1.0, 3.0), (9.0, 3.0), release=1.5, weight=2.0),
        Robot(
            "arrow",
            polygon([(-0.3, -0.2), (0.5, 0.0), (-0.3, 0.2)]),
            LIMITS,
            (1.0, 5.0),
            (9.0, 5.0),
            path=((1.0, 5.0), (5.0, 5.5), (9.0, 5.0)),
        ),
    )
    wedge = Polygon("wedge", [(3, 6.5), (4, 6.5), (3.3, 7)])
    obstacles = (rectangle("rack", (4, 3.5, 6, 4.2)), Circle("post", (2, 6.5), 0.2), wedge)
    problem = Problem("all kinds", Workspace((0, 0, 10, 8), 0.05), robots, obstacles, {"seed": 3, "shape": "taut"})
    text = written(draft_of(problem, ["A remark."]))
    assert text.startswith("# A remark.\n")
    assert text.count("jerk") == 1
    file = tmp_path / "problem.toml"
    file.write_text(text, encoding="utf-8")
    same(read_problem(file), problem)


def test_an_obstacle_with_a_hole_is_written_in_parts():
    """A frame becomes two halves whose areas add up."""
    frame = Polygon("room", [(0, 0), (4, 0), (4, 4), (0, 4)], ([(1, 1), (1, 3), (3, 3), (3, 1)],))
    robot = Robot("a", Footprint(0.3), LIMITS, (2.0, 2.0), (2.0, 2.0))
    draft = draft_of(Problem("p", Workspace((0, 0, 4, 4)), (robot,), (frame,)))
    assert [table["name"] for table in draft.obstacles] == ["room, part 1", "room, part 2"]
    assert all(len(table["polygon"]) == 8 for table in draft.obstacles)


@pytest.mark.parametrize(
    ("ring", "kind"),
    [
        ([(0, 0), (2, 0), (2, 1), (0, 1)], "rectangle"),
        ([(2, 1), (2, 0), (0, 0), (0, 1)], "rectangle"),
        ([(0, 0), (2, 1), (2, 0), (0, 1)], "polygon"),
        ([(0, 0), (2, 0), (2, 1)], "polygon"),
    ],
)
def test_an_upright_rectangle_is_written_as_one(ring, kind):
    """In either sense and from any corner; four corners that cross are no rectangle."""
    assert kind in outline("a", ring)
