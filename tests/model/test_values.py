"""Robots, obstacles, workspaces, problems and options: what they refuse, all at once, and how they travel."""

from __future__ import annotations

import dataclasses
import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.errors import BadFileError, Fault, InvalidValueError, NoPlanError
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle, signed_area
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.result import Diagnosis
from coord.model.robot import Limits, Robot

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
NAN, INF = math.nan, math.inf


def robot(name="r", start=(0.0, 0.0), goal=(1.0, 0.0), **more):
    return Robot(name, Footprint(0.3), LIMITS, start, goal, **more)


def fields(make):
    """The fields of all the faults that a constructor reports."""
    with pytest.raises(InvalidValueError) as caught:
        make()
    assert all(sentence in str(caught.value) for _, sentence in caught.value.faults)
    return [field for field, _ in caught.value.faults]


@pytest.mark.parametrize("bad", [0.0, -1.0, NAN, INF, -INF])
def test_limits_must_be_positive_and_finite(bad):
    """Every limit that is not is named, in one error."""
    names = [field.name for field in dataclasses.fields(Limits)]
    for name in names:
        assert fields(lambda name=name: dataclasses.replace(LIMITS, **{name: bad})) == [name]
    assert fields(lambda: Limits(*[bad] * 5)) == names


def test_a_fault_of_a_limit_says_the_value_the_rule_and_the_unit():
    """What the user sees is enough to put it right."""
    with pytest.raises(InvalidValueError, match=r"speed must be > 0 m/s \(got -1\)"):
        Limits(-1.0, 1.0, 1.0, 1.0, 1.0)
    with pytest.raises(InvalidValueError, match=r"jerk must be > 0 m/s3 \(got nan\)"):
        Limits(1.0, 1.0, 1.0, NAN, 1.0)


@pytest.mark.parametrize("radius", [0.0, -0.1, NAN, INF])
def test_a_footprint_needs_a_size(radius):
    """A disc of no, negative or endless radius is refused."""
    assert fields(lambda: Footprint(radius)) == ["footprint"]


def test_a_robot_reports_all_that_is_wrong_with_it():
    """Name, start, goal, priority, release and weight in one error."""
    wrong = fields(lambda: robot("", (NAN, 0.0), (0.0, INF), priority=NAN, release=-1.0, weight=-2.0))
    assert wrong == ["name", "start", "goal", "priority", "release", "weight"]


def test_a_workspace_reports_all_that_is_wrong_with_it():
    """Bounds the wrong way round, a negative clearance and an unknown word in one error."""
    assert fields(lambda: Workspace((0.0, 0.0, 0.0, 1.0), -1.0, "vanish")) == ["bounds", "clearance", "after_arrival"]
    assert fields(lambda: Workspace((0.0, 0.0, NAN, 1.0))) == ["bounds"]
    assert fields(lambda: Workspace((0.0, 0.0, 1.1e6, 1.0))) == ["bounds"]
    Workspace((-1e6, -1e6, 1e6, 1e6), 0.0, "leave")


def test_a_problem_needs_robots_with_different_names():
    """No robots at all, or a name used twice, is refused; the sentence counts the uses."""
    floor = Workspace((0.0, 0.0, 9.0, 9.0))
    assert fields(lambda: Problem("p", floor, ())) == ["robots"]
    with pytest.raises(InvalidValueError, match='the name "a" is used 3 times') as caught:
        Problem("p", floor, (robot("a"), robot("b"), robot("a"), robot("a"), robot("b")))
    assert len(caught.value.faults) == 2


def test_a_circle_reports_all_that_is_wrong_with_it():
    """Centre and radius in one error."""
    assert fields(lambda: Circle("c", (NAN, 0.0), -1.0)) == ["circle", "circle"]


@pytest.mark.parametrize(
    "vertices", [[(0, 0), (1, 1)], [(0, 0), (1, 1), (2, 2)], [(0, 0), (1, 0), (NAN, 1)], [(0, 0), (1, 0), (INF, 1)]]
)
def test_a_polygon_needs_an_area_of_finite_numbers(vertices):
    """Two vertices, a line, or numbers that are none are refused, in holes too."""
    assert fields(lambda: Polygon("p", np.array(vertices, float))) == ["polygon"]
    square = np.array([(0, 0), (9, 0), (9, 9), (0, 9)], float)
    assert (
        fields(lambda: Polygon("p", square, (np.array(vertices, float), np.array(vertices, float)))) == ["polygon"] * 2
    )


def test_rings_run_with_the_obstacle_on_their_left():
    """However they are given, outlines run counter-clockwise and holes clockwise, with the same vertices."""
    outline = np.array([(0, 0), (9, 0), (9, 9), (0, 9)], float)
    hole = np.array([(1, 1), (2, 1), (2, 2)], float)
    for turned in (outline, outline[::-1]):
        for inner in (hole, hole[::-1]):
            polygon = Polygon("p", turned, (inner,))
            assert [signed_area(ring) for ring in polygon.rings] == [81.0, -0.5]
            assert sorted(map(tuple, polygon.vertices.tolist())) == sorted(map(tuple, outline.tolist()))


@settings(deadline=None, derandomize=True, max_examples=60)
@given(st.floats(-9, 9), st.floats(-9, 9), st.floats(0.1, 9), st.floats(0.1, 9), st.floats(-7, 7))
def test_a_turned_rectangle_keeps_its_size_and_centre(x, y, width, height, angle):
    """Area, sides and centre do not depend on the angle, and the first edge points along it."""
    turned = rectangle("r", (x, y, x + width, y + height), angle).vertices
    assert signed_area(turned) == pytest.approx(width * height)
    assert turned.mean(axis=0) == pytest.approx((x + width / 2, y + height / 2))
    assert turned[1] - turned[0] == pytest.approx((width * math.cos(angle), width * math.sin(angle)))


def test_a_rectangle_the_wrong_way_round_is_refused():
    """xmin < xmax and ymin < ymax is the rule, and the error shows the numbers."""
    with pytest.raises(InvalidValueError, match=r"got \[1, 0, 0, 1\]"):
        rectangle("r", (1, 0, 0, 1))


@settings(deadline=None, derandomize=True, max_examples=60)
@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_the_area_does_not_depend_on_where_the_ring_lies(x, y):
    """Far from the origin the unit square still has an area of 1 m2."""
    assert signed_area(np.array([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)])) == pytest.approx(1.0, abs=1e-8)


def test_options_tell_what_is_not_built_yet_from_what_is_unknown():
    """Both are refused, never ignored, and all at once."""
    with pytest.raises(InvalidValueError, match='order "search" is not supported yet') as caught:
        Options(shape="nicest", order="search", time_limit=0.0, gap_target=NAN, seed=-1)
    assert [field for field, _ in caught.value.faults] == ["shape", "order", "time_limit", "gap_target", "seed"]
    assert 'shape "nicest" is unknown' in str(caught.value)


def everything():
    polygon = Polygon("p", np.array([(0, 0), (9, 0), (9, 9)], float), (np.array([(5, 1), (6, 1), (6, 2)], float),))
    problem = Problem("x", Workspace((0, 0, 9, 9), 0.1), (robot("a", priority=2.0),), (polygon, Circle("c", (1, 1), 2)))
    return [
        problem,
        Options(seed=3),
        InvalidValueError([("speed", "too slow"), ("name", "too long")]),
        BadFileError([Fault("f.toml", 3, "robots[0]", "no"), Fault("f.toml", None, "", "nor this")]),
        NoPlanError([Diagnosis("no-way", ("a",), "shut in", (1.0, 2.0), 3.0, "open it")]),
    ]


@pytest.mark.parametrize("value", everything(), ids=lambda value: type(value).__name__)
def test_values_and_errors_survive_pickling(value):
    """They can be sent between processes: what they say is the same afterwards, polygons stay read-only."""
    copy = pickle.loads(pickle.dumps(value))  # noqa: S301
    assert type(copy) is type(value)
    if isinstance(value, Exception):
        assert str(copy) == str(value)
        assert vars(copy) == vars(value)
    if isinstance(value, Problem):
        assert copy.robots == value.robots
        assert copy.workspace == value.workspace
        ring, again = value.obstacles[0].rings[1], copy.obstacles[0].rings[1]
        assert again.tobytes() == ring.tobytes()
        assert not again.flags.writeable
    if isinstance(value, Options):
        assert copy == value


def test_values_cannot_be_changed():
    """Assigning to a field of a frozen value is an error."""
    for value, field in ((robot(), "name"), (LIMITS, "speed"), (Footprint(1.0), "radius"), (Options(), "seed")):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(value, field, 1)


def test_errors_can_be_caught_by_their_plain_kind():
    """A wrong value is a ValueError too, and a fault's sentence names file and line where it has one."""
    assert issubclass(InvalidValueError, ValueError)
    assert str(Fault("f.toml", 7, 'robots[0] "a"', "speed must be > 0")) == 'f.toml:7: robots[0] "a": speed must be > 0'
    assert str(Fault("f.toml", None, "", "not a file")) == "f.toml: not a file"
