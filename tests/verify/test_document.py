"""Files that are no plan are told apart from plans that are wrong, whatever the bytes."""

from __future__ import annotations

import copy
import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.verify import verify


@pytest.fixture(scope="module")
def good(build):
    robots = [build.robot("a", (0, 0), (4, 0)), build.robot("b", (0, 3), (4, 3), footprint={"square": 0.5})]
    obstacles = [build.circle("post", 10, 10, 1), build.rectangle("rack", -9, -9, -7, -7)]
    return build.plan(robots, obstacles=obstacles)


def changed(document, path, value):
    """A copy with one value replaced; a missing last key is added, ``None`` removes it."""
    result = copy.deepcopy(document)
    *way, last = path
    item = result
    for key in way:
        item = item[key]
    if value is KeyError:
        del item[last]
    else:
        item[last] = value
    return result


def test_the_plan_all_faults_start_from_is_certified(good, build):
    """Without this, none of the tests below would mean anything."""
    report = verify(build.data(good))
    assert report.certified
    assert report.faults == ()
    assert report.robots == 2


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff\xfe{}",
        b"{",
        b"[]",
        b"null",
        b"1e400",
        b'{"format": "coord-plan/2"}',
        b'{"format": "coord-plan/1"}',
        b"[" * 200_000 + b"]" * 200_000,
        b'{"a":' * 100_000 + b"1" + b"}" * 100_000,
        b"9" * 10_000,
    ],
    ids=[
        "empty",
        "utf16",
        "cut",
        "list",
        "null",
        "huge",
        "format",
        "keys",
        "deep lists",
        "deep objects",
        "long number",
    ],
)
def test_bytes_that_are_no_plan_are_malformed(data):
    """Nothing is raised, and the one finding says why."""
    report = verify(data)
    assert report.verdict == "malformed"
    assert not report.certified
    assert report.faults[0].text


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity", "1e999", "true", "null", '"1"', "1e13"])
def test_a_number_that_is_not_finite_or_no_number_is_malformed(good, build, word):
    """NaN compares false with everything and would slip through every check of a limit."""
    text = build.data(changed(good, ("robots", 0, "profile", "jerks", 0), 77.125)).decode()
    assert text.count("77.125") == 1
    assert verify(text.replace("77.125", word).encode()).verdict == "malformed"


def test_a_repeated_key_is_malformed(good, build):
    """Two readers could take two different values."""
    text = build.data(good).decode().replace('"clearance": 0.05', '"clearance": 0.05, "clearance": 0.0')
    report = verify(text.encode())
    assert report.verdict == "malformed"
    assert "clearance" in report.faults[0].text


def paths_of(item, path=()):
    """The path of every key in a document."""
    if isinstance(item, dict):
        for key, value in item.items():
            yield (*path, key)
            yield from paths_of(value, (*path, key))
    elif isinstance(item, list):
        for k, value in enumerate(item):
            yield from paths_of(value, (*path, k))


def test_every_missing_and_every_unknown_key_is_malformed(good, build):
    """All keys are needed, and no others are known, at every level."""
    keys = list(paths_of(good))
    assert len(keys) > 50
    for path in keys:
        assert verify(build.data(changed(good, path, KeyError))).verdict == "malformed", path
        extra = (*path[:-1], "surprise")
        assert verify(build.data(changed(good, extra, 1))).verdict == "malformed", extra


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("robots",), []),
        (("robots", 1, "name"), "a"),
        (("robots", 0, "name"), ""),
        (("robots", 0, "name"), "\ud800"),
        (("robots", 0, "footprint"), {"disc": 0}),
        (("robots", 0, "footprint"), {"disc": 0.3, "square": 1}),
        (("robots", 0, "footprint"), {"triangle": 1}),
        (("robots", 0, "footprint"), {"polygon": [[-1, -1], [1, -1], [0, 0], [1, 1], [-1, 1]]}),
        (("robots", 0, "footprint"), {"polygon": [[1, 1], [2, 1], [2, 2]]}),
        (("robots", 0, "footprint"), {"polygon": [[0, 1], [-0.6, -0.8], [1, 0.3], [-1, 0.3], [0.6, -0.8]]}),
        (("robots", 0, "heading"), "sideways"),
        (("robots", 0, "limits", "jerk"), 0),
        (("robots", 0, "release"), -1),
        (("robots", 0, "priority"), "first"),
        (("robots", 0, "start"), [0, 0, 0]),
        (("robots", 0, "after"), "b"),
        (("robots", 0, "path", "pieces", 0, 0), 0),
        (("robots", 0, "profile", "jerks"), []),
        (("robots", 0, "profile", "times"), []),
        (("workspace", "clearance"), -0.1),
        (("workspace", "bounds"), [0, 0, 0, 1]),
        (("workspace", "after_arrival"), "park"),
        (("obstacles", 0, "circle", "radius"), -1),
        (("obstacles", 1, "polygon"), [[0, 0], [1, 0]]),
        (("obstacles", 1, "polygon"), [[0, 0], [0, 1], [1, 1], [1, 0]]),
        (("obstacles", 1, "holes"), [[[-8.5, -8.5], [-8, -8.5], [-8, -8]]]),
        (("blocking",), [["a", "b"]]),
        (("blocking",), [["a", "b", "middle"]]),
        (("result", "makespan"), None),
    ],
)
def test_values_out_of_form_are_malformed(good, build, path, value):
    """Signs, lengths, words, shapes: what the format rules out is not even looked at."""
    assert verify(build.data(changed(good, path, value))).verdict == "malformed"


def test_all_robots_out_of_form_are_named(good, build):
    """Faults are reported all at once."""
    document = changed(changed(good, ("robots", 0, "start"), 1), ("robots", 1, "goal"), 1)
    report = verify(build.data(document))
    assert len(report.faults) == 2
    assert '"a"' in report.faults[0].text
    assert '"b"' in report.faults[1].text


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("robots", 0, "start"), [1.1e6, 0]),
        (("robots", 0, "path", "pieces", 0, 0), 2e6),
        (("robots", 0, "path", "pieces", 0), [4.0, 1e5, 1e5]),
        (("robots", 0, "profile", "times", -1), 2e6),
        (("obstacles", 0, "circle", "center"), [0, -2e6]),
        (("obstacles", 1, "polygon", 1), [2e6, -9]),
        (("workspace", "bounds"), [-2e6, 0, 1, 1]),
    ],
)
def test_what_doubles_do_not_resolve_is_refused(good, build, path, value):
    """The margins hold up to 1e6 m and 1e6 s."""
    assert verify(build.data(changed(good, path, value))).verdict == "refused"


@settings(max_examples=80, deadline=None, derandomize=True)
@given(data=st.data())
def test_no_single_changed_value_makes_the_checker_fail(good, build, data):
    """Whatever a value is replaced by, there is a verdict; never an exception."""
    path = data.draw(st.sampled_from([*paths_of(good), ("robots", 0, "profile", "states", 3, 1)]))
    leaf = st.one_of(
        st.none(),
        st.booleans(),
        st.sampled_from([0.0, -1.0, 1e-300, -1e-300, 1e12, -1e12, 1e6, 5e-324, [], {}, "", [0.0], [[0.0, 0.0]]]),
        st.floats(allow_nan=False, allow_infinity=False),
    )
    report = verify(json.dumps(changed(good, path, data.draw(leaf))).encode())
    assert report.verdict in ("certified", "refused", "undecided", "malformed")
    assert report.certified == (not report.faults)
