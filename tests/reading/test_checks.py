"""Starts and goals with too little room."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from coord.reading.checks import first_overlaps

HEAD = 'format = "coord-problem/1"\n[workspace]\nbounds = [0, 0, 10, 10]\nclearance = 0.1\n'


def robot(name: str, start: tuple[float, float], goal: tuple[float, float], radius: float = 0.4) -> str:
    """A robot in five lines."""
    places = f"start = {[*start]}\ngoal = {[*goal]}"
    return f'[[robots]]\nname = "{name}"\n{places}\nfootprint = {{ disc = {radius} }}\n'


@pytest.mark.parametrize("place", [(0.5, 0.5), (9.5, 9.5), (0.5, 9.5), (9.5, 0.5)])
def test_touching_the_clearance_of_two_edges_is_allowed(read, place):
    """A disc of 0.4 m with a clearance of 0.1 m may stand 0.5 m from an edge."""
    assert read(HEAD + robot("a", place, (5, 5))).robots[0].start == place


@pytest.mark.parametrize(
    ("place", "edge"), [((0.499, 5), "left"), ((5, 0.499), "lower"), ((9.501, 5), "right"), ((5, 9.501), "upper")]
)
def test_a_millimetre_less_is_too_near_to_an_edge(faults_of, place, edge):
    """The fault names the edge and how much is missing."""
    (told,) = faults_of(HEAD + robot("a", (5, 5), place))
    assert told.startswith(
        f'problem.toml:8: robots[1] "a": goal ({place[0]}, {place[1]}) is 0.001 m too near to the {edge} edge'
    )


OBSTACLES = [
    "rectangle = [5, 5, 7, 7]",
    "circle = { center = [6, 6], radius = 1 }",
    "polygon = [[5, 5], [7, 5], [7, 7], [5, 7]]",
    "rectangle = [5, 5.5, 7, 6.5]\nangle = 3.141592653589793",
]


@pytest.mark.parametrize("obstacle", OBSTACLES)
def test_touching_the_clearance_of_an_obstacle_is_allowed(read, obstacle):
    """Distance equal to radius and clearance is kept, as far as doubles tell."""
    assert read(f"{HEAD}{robot('a', (4.5, 6), (1, 1))}[[obstacles]]\n{obstacle}\n").obstacles


@pytest.mark.parametrize("obstacle", OBSTACLES)
@pytest.mark.parametrize(
    ("x", "words"),
    [
        (4.51, 'is 0.01 m too near to obstacle "rack": its centre is 0.49 m from it'),
        (5.25, 'is 0.75 m too deep in obstacle "rack": its centre is 0.25 m inside it'),
    ],
)
def test_a_start_near_or_in_an_obstacle_is_told_with_its_depth(faults_of, obstacle, x, words):
    """How deep the disc with its clearance stands in the obstacle, for round and straight ones alike."""
    text = f'{HEAD}{robot("a", (x, 6), (1, 1))}[[obstacles]]\nname = "rack"\n{obstacle}\n'
    assert faults_of(text) == [
        f'problem.toml:7: robots[1] "a": start ({x}, 6) {words}, radius 0.4 m + clearance 0.1 m are needed'
    ]


def test_of_two_obstacles_the_deeper_one_is_told(faults_of):
    """A start in several obstacles is one fault."""
    obstacles = "[[obstacles]]\nrectangle = [4, 4, 6, 6]\n[[obstacles]]\nrectangle = [3, 3, 7, 7]\n"
    (told,) = faults_of(HEAD + robot("a", (5, 5), (1, 1)) + obstacles)
    assert 'too deep in obstacle "obstacle 2": its centre is 2 m inside' in told


def test_two_robots_may_start_at_exactly_their_distance(read):
    """Radii and clearance together are enough, 0.4 + 0.2 + 0.1 m."""
    assert len(read(HEAD + robot("a", (1, 1), (1, 5)) + robot("b", (1.7, 1), (5, 5), 0.2)).robots) == 2


def test_overlapping_starts_and_goals_are_told_of_the_later_robot(faults_of):
    """Overlapping discs and discs that only miss the clearance are told in different words."""
    text = HEAD + robot("a", (1, 1), (1, 5)) + robot("b", (1.65, 1), (5, 5), 0.2) + robot("c", (8, 8), (1, 5.3), 0.2)
    assert faults_of(text) == [
        'problem.toml:12: robots[2] "b": start (1.65, 1) is too near to the start of robots[1] "a": 0.65 m apart, '
        "radii 0.2 m + 0.4 m + clearance 0.1 m are needed",
        'problem.toml:18: robots[3] "c": goal (1, 5.3) overlaps the goal of robots[1] "a": 0.3 m apart, '
        "radii 0.2 m + 0.4 m + clearance 0.1 m are needed",
    ]


def test_a_start_on_another_robots_goal_is_allowed(read):
    """Places may be handed over: two robots can swap."""
    assert len(read(HEAD + robot("a", (1, 1), (5, 5)) + robot("b", (5, 5), (1, 1))).robots) == 2


def test_robots_with_other_faults_are_checked_as_far_as_they_are_known(faults_of):
    """A bad speed does not hide a bad start; a bad radius does, for then nobody knows."""
    bad_speed = robot("a", (0.2, 5), (5, 5)) + "speed = 0\n"
    bad_radius = robot("b", (0.2, 5.1), (5, 7), -1)
    told = faults_of(HEAD + bad_speed + bad_radius)
    assert [fault.split(": ")[0] for fault in told] == ["problem.toml:7", "problem.toml:10", "problem.toml:15"]


@settings(deadline=None)
@given(
    arrays(float, st.tuples(st.integers(0, 30), st.just(3)), elements=st.integers(0, 12).map(float)),
    st.sampled_from([0.0, 0.5]),
)
def test_the_sweep_finds_what_comparing_all_pairs_finds(discs, clearance):
    """For each disc the first earlier one it overlaps, by the definition; touching is none."""
    points, radii = discs[:, :2], discs[:, 2] / 8 + 0.1
    expected = [
        next(
            (m for m in range(n) if np.hypot(*(points[n] - points[m])) < radii[n] + radii[m] + clearance - 1e-9),
            -1,
        )
        for n in range(len(points))
    ]
    assert first_overlaps(points, radii, clearance).tolist() == expected
