import json
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from coord.errors import BadFileError
from coord.model.arrays import Array
from coord.model.footprint import Footprint, polygon, square
from coord.model.result import Plan
from coord.output.plan_file import parse, serialise
from coord.verify import verify


def faults_of(data: bytes) -> str:
    with pytest.raises(BadFileError) as caught:
        parse(data, "p.json")
    return str(caught.value)


def changed(plan: Plan, change: Callable[[dict[str, Any]], object]) -> bytes:
    document = json.loads(serialise(plan))
    change(document)
    return json.dumps(document).encode()


def test_reading_what_was_written_and_writing_it_again_gives_the_same_bytes(sample: Plan, parked: Plan, many: Plan):
    """Nothing that the file keeps is lost or rounded on the way."""
    for plan in (sample, parked, many):
        data = serialise(plan)
        assert serialise(parse(data)) == data


def test_reading_gives_back_every_number_exactly(sample: Plan):
    """Floats are written by repr, which reads back exactly."""
    read = parse(serialise(sample))
    for a, b in zip(sample.robots, read.robots, strict=True):
        pairs: list[tuple[Array, Array]] = [
            (a.path.pieces, b.path.pieces),
            (a.profile.times, b.profile.times),
            (a.profile.states, b.profile.states),
            (a.profile.jerks, b.profile.jerks),
        ]
        assert all(np.array_equal(first, second) for first, second in pairs)
        assert a.robot == b.robot
        assert (a.solo_arrival, a.solo_bound, a.lower_bound, a.how) == (
            b.solo_arrival,
            b.solo_bound,
            b.lower_bound,
            b.how,
        )
    assert read.problem.workspace == sample.problem.workspace
    assert read.blocking[0].place is None


def test_the_file_has_exactly_the_fields_of_the_format_in_their_order(sample: Plan):
    """Other programs rely on these names."""
    document = json.loads(serialise(sample))
    head = ["format", "problem", "workspace", "obstacles", "robots", "order", "blocking", "result"]
    assert list(document) == head
    robot = "name footprint heading limits start goal release priority path profile arrival solo_arrival solo_bound"
    assert list(document["robots"][0]) == [*robot.split(), "lower_bound", "after", "before", "how"]
    assert [list(obstacle) for obstacle in document["obstacles"]] == [
        ["name", "polygon", "holes"],
        ["name", "circle"],
        ["name", "polygon", "holes"],
    ]
    assert document["blocking"] == [["red", "blue", "goal"]]
    assert document["result"]["sum_of_arrivals"] == sum(robot["arrival"] for robot in document["robots"])
    assert document["robots"][1]["priority"] == 2.0
    assert document["robots"][0]["priority"] is None


def test_whole_numbers_are_written_as_floats_so_that_equal_plans_are_equal_bytes(sample: Plan):
    """A start of (1, 4) and one of (1.0, 4.0) are the same start."""
    first = sample.robots[0]
    whole = replace(first, robot=replace(first.robot, start=(1, 4), release=0))
    assert serialise(replace(sample, robots=(whole, *sample.robots[1:]))) == serialise(sample)


def test_a_number_that_is_not_finite_is_never_written(sample: Plan):
    """JSON has no word for it, and a plan with it is a defect."""
    with pytest.raises(ValueError, match="JSON"):
        serialise(replace(sample, lower_bound=float("nan")))


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"\xff\xfe", "not UTF-8"),
        (b'{\n"format": ', "p.json:2: not JSON"),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"format": NaN}', "NaN is not a number of JSON"),
        (b'{"order": [], "order": []}', '"order" stands 2 times'),
        (b"[]", "p.json"),
        (b"9" * 5000, "p.json"),
    ],
)
def test_what_is_no_json_object_is_a_bad_file(data: bytes, reason: str):
    """Bytes that are no plan file end in a sentence, never in another exception."""
    assert reason in faults_of(data)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda d: d.update(format="coord-plan/9"), "format: input should be 'coord-plan/1'"),
        (lambda d: d.pop("order"), "order: field required"),
        (lambda d: d.update(extra=1), "extra: extra inputs are not permitted"),
        (lambda d: d["robots"][0].update(arrival=True), "robots[0].arrival"),
        (lambda d: d["robots"][0].update(arrival=10**400), "robots[0].arrival"),
        (lambda d: d["robots"][0].update(name="\ud800"), "robots[0].name"),
        (lambda d: d["robots"][0]["limits"].update(jerk=-1.0), 'robots[0] "red": jerk must be > 0'),
        (lambda d: d["robots"][0]["profile"]["jerks"].pop(), "K + 1 times"),
        (lambda d: d["robots"][0]["profile"]["times"].reverse(), "must increase"),
        (lambda d: d["robots"][0].update(arrival=1.0), "arrival must be the profile's last time"),
        (lambda d: d["robots"][0]["path"]["pieces"][0].__setitem__(0, 0.0), "longer than 0 m"),
        (lambda d: d["robots"][0]["after"].append("ghost"), 'no robot is named "ghost"'),
        (lambda d: d["robots"][0].update(name="blue"), 'the name "blue" is used 2 times'),
        (lambda d: d["order"].pop(), "order: must name every robot exactly once"),
        (lambda d: d["blocking"].append(["red", "ghost", "goal"]), 'no robot is named "ghost"'),
        (lambda d: d["obstacles"][0].pop("polygon"), 'either a "polygon"'),
        (lambda d: d["obstacles"][1]["circle"].update(radius=0.0), 'obstacles[1] "column"'),
        (lambda d: d["workspace"].update(clearance=-1.0), "clearance must be >= 0"),
        (lambda d: d.update(robots=[], order=[]), "at least one robot"),
    ],
)
def test_each_broken_rule_of_the_form_is_named(sample: Plan, change: Callable[[dict[str, Any]], object], reason: str):
    """The sentence says which field of which robot breaks which rule."""
    assert reason in faults_of(changed(sample, change))


def test_all_faults_are_reported_at_once(sample: Plan):
    """Nobody shall mend a file one fault a run."""

    def change(document: dict[str, Any]) -> None:
        document["robots"][0]["limits"].update(jerk=-1.0, speed=0.0)
        document["obstacles"][1]["circle"]["radius"] = -2.0
        document["order"].pop()

    assert faults_of(changed(sample, change)).count("\n") == 3


KITE = [(0.5, 0.1), (0.0, 0.3), (-0.4, 0.0), (0.0, -0.2)]


def with_footprint(plan: Plan, footprint: Footprint) -> Plan:
    """The plan, its first robot of this shape."""
    first = replace(plan.robots[0], robot=replace(plan.robots[0].robot, footprint=footprint))
    return replace(plan, robots=(first, *plan.robots[1:]))


@pytest.mark.parametrize(
    ("footprint", "shape", "heading"),
    [
        (Footprint(0.3), {"disc": 0.3}, "fixed"),
        (Footprint(0.3, heading="path"), {"disc": 0.3}, "fixed"),
        (square(0.6), {"square": 0.6}, "fixed"),
        (square(0.6, "path"), {"square": 0.6}, "path"),
        (polygon(KITE), {"polygon": [list(corner) for corner in KITE]}, "path"),
        (polygon(KITE, "fixed"), {"polygon": [list(corner) for corner in KITE]}, "fixed"),
        (polygon([(0.3, 0.3), (-0.3, 0.3), (-0.3, -0.3), (0.3, -0.3)]), None, "path"),
    ],
)
def test_a_footprint_is_written_as_the_problem_file_writes_it(
    sample: Plan, footprint: Footprint, shape: dict[str, Any] | None, heading: str
):
    """A disc is a disc whichever way it heads; a square whose corners begin elsewhere is a polygon."""
    written = json.loads(serialise(with_footprint(sample, footprint)))["robots"][0]
    assert written["footprint"] == (shape or {"polygon": [list(corner) for corner in footprint.vertices]})
    assert written["heading"] == heading


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.one_of(
        st.builds(square, st.floats(0.002, 1e6), st.sampled_from(["fixed", "path"])),
        st.builds(
            lambda count, x, y, turn, heading: polygon(
                [
                    (x * math.cos(turn + 2 * math.pi * k / count), y * math.sin(turn + 2 * math.pi * k / count))
                    for k in range(count)
                ],
                heading,
            ),
            st.integers(3, 12),
            st.floats(0.05, 10.0),
            st.floats(0.05, 10.0),
            st.floats(0.0, 6.0),
            st.sampled_from(["fixed", "path"]),
        ),
        st.builds(Footprint, st.floats(0.001, 1e6)),
    )
)
def test_a_footprint_reads_back_as_it_was_to_the_last_bit(sample: Plan, footprint: Footprint):
    """Squares and polygons of any size, turning or not; the checker reads them too."""
    data = serialise(with_footprint(sample, footprint))
    assert parse(data).robots[0].robot.footprint == footprint
    assert verify(data).verdict != "malformed"


def test_a_footprint_that_is_none_is_named(sample: Plan):
    """Two shapes at once, no shape, and a polygon that is not convex are no footprints."""
    for shape, reason in (
        ({"disc": 0.3, "square": 0.6}, "(got disc and square)"),
        ({}, "(got none)"),
        ({"polygon": [[1, 1], [-1, 1], [0, 0], [0, -1]]}, "the footprint must be convex"),
        ({"square": -1.0}, "the square's side must be > 0 m (got -1)"),
    ):
        told = faults_of(changed(sample, lambda d, shape=shape: d["robots"][0].update(footprint=shape)))
        assert 'robots[0] "red"' in told
        assert reason in told
    assert "robots[0].heading" in faults_of(changed(sample, lambda d: d["robots"][0].update(heading="north")))
