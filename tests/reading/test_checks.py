"""Starts and goals with too little room."""

from __future__ import annotations

import time

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


def shaped(name: str, start: tuple[float, float], goal: tuple[float, float], shape: str, rest: str = "") -> str:
    """A robot of any footprint, in five lines and the rest."""
    places = f"start = {[*start]}\ngoal = {[*goal]}"
    return f'[[robots]]\nname = "{name}"\n{places}\nfootprint = {{ {shape} }}\n{rest}'


BLOCK = "polygon = [[-0.2, -0.1], [0.6, -0.1], [0.6, 0.3], [-0.2, 0.3]]"


@pytest.mark.parametrize("place", [(0.3, 0.2), (9.3, 9.6), (0.3, 9.6), (9.3, 0.2)])
def test_a_polygon_that_keeps_its_heading_may_touch_the_clearance_of_two_edges(read, place):
    """Each side of the footprint counts as it is: 0.2 m to the left, 0.6 m to the right, 0.1 m down, 0.3 m up."""
    assert read(HEAD + shaped("a", place, (5, 5), BLOCK, 'heading = "fixed"')).robots[0].start == place


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ((0.25, 5), "0.05 m too near to the left edge of the workspace: its footprint is 0.05 m from it, clearance"),
        ((9.35, 5), "0.05 m too near to the right edge of the workspace: its footprint is 0.05 m from it, clearance"),
        ((5, 0.05), "0.15 m too near to the lower edge of the workspace: its footprint reaches 0.05 m beyond it"),
        ((5, 9.65), "0.05 m too near to the upper edge of the workspace: its footprint is 0.05 m from it, clearance"),
        ((10.2, 5), "outside the workspace"),
    ],
)
def test_a_polygon_too_near_to_an_edge_is_told_from_its_own_outline(faults_of, place, words):
    """What is missing is measured from the side that is nearest."""
    (told,) = faults_of(HEAD + shaped("a", (5, 5), place, BLOCK, 'heading = "fixed"'))
    assert told.startswith(f'problem.toml:8: robots[1] "a": goal ({place[0]}, {place[1]}) is {words}')


@pytest.mark.parametrize("obstacle", OBSTACLES)
def test_a_square_may_touch_the_clearance_of_an_obstacle_with_its_side(read, obstacle):
    """A square of 0.8 m needs 0.4 m beside a wall where its circumscribed disc would need 0.566 m."""
    assert read(f"{HEAD}{shaped('a', (4.5, 6), (1, 1), 'square = 0.8')}[[obstacles]]\n{obstacle}\n").obstacles


@pytest.mark.parametrize("obstacle", OBSTACLES)
@pytest.mark.parametrize(
    ("x", "words"),
    [
        (4.51, 'is 0.01 m too near to obstacle "rack": its footprint is 0.09 m from it, clearance 0.1 m is needed'),
        (5.25, 'is 0.75 m too deep in obstacle "rack": its footprint is 0.65 m deep in it, clearance 0.1 m is needed'),
    ],
)
def test_a_square_near_or_in_an_obstacle_is_told_with_its_depth(faults_of, obstacle, x, words):
    """Exact for straight obstacles and round ones: how far the square itself is from them, or has to move."""
    text = f'{HEAD}{shaped("a", (x, 6), (1, 1), "square = 0.8")}[[obstacles]]\nname = "rack"\n{obstacle}\n'
    assert faults_of(text) == [f'problem.toml:7: robots[1] "a": start ({x}, 6) {words}']


def test_a_square_fits_into_the_corner_of_a_concave_obstacle(read, faults_of):
    """Only the outline counts, not its hull: a niche of 1 m holds a square of 0.8 m, one of 0.81 m it does not."""
    niche = "[[obstacles]]\npolygon = [[4, 4], [7, 4], [7, 7], [4, 7], [4, 6], [6, 6], [6, 5], [4, 5]]\n"
    assert read(HEAD + shaped("a", (5, 5.5), (1, 1), "square = 0.8") + niche).robots
    (told,) = faults_of(HEAD + shaped("a", (5, 5.5), (1, 1), "square = 0.81") + niche)
    assert 'is 0.005 m too near to obstacle "obstacle 1": its footprint is 0.095 m from it' in told


def test_a_footprint_that_turns_needs_room_for_its_circumscribed_disc(faults_of):
    """It is planned as that disc, so it is refused as that disc, and told so."""
    text = HEAD + shaped("a", (0.45, 5), (5, 5), "square = 0.6", 'heading = "path"\n')
    text += "[[obstacles]]\nname = 'rack'\nrectangle = [5.5, 4, 7, 6]\n"
    assert faults_of(text) == [
        'problem.toml:7: robots[1] "a": start (0.45, 5) is 0.0743 m too near to the left edge of the workspace: '
        "its centre is 0.45 m from it, its circumscribed disc of radius 0.424264 m + clearance 0.1 m are needed",
        'problem.toml:8: robots[1] "a": goal (5, 5) is 0.0243 m too near to obstacle "rack": its centre is 0.5 m from '
        "it, its circumscribed disc of radius 0.424264 m + clearance 0.1 m are needed",
    ]


def test_squares_that_keep_their_heading_may_stand_side_by_side(read):
    """Two squares of 0.8 m need 0.9 m between their centres along an axis, where discs round them need 1.23 m."""
    assert (
        len(
            read(
                HEAD + shaped("a", (1, 1), (1, 5), "square = 0.8") + shaped("b", (1.9, 1), (5, 5), "square = 0.8")
            ).robots
        )
        == 2
    )


def test_overlapping_polygons_are_told_with_their_distance(faults_of):
    """Squares are measured from side to side, with discs from rim to side; what turns counts as a disc."""
    text = HEAD + shaped("a", (1, 1), (1, 5), "square = 0.8") + shaped("b", (1.85, 1), (5, 5), "square = 0.8")
    text += shaped("c", (1, 1.7), (8, 5), "disc = 0.4") + shaped(
        "d", (1, 2.7), (8, 8), "square = 1", "heading = 'path'\n"
    )
    assert faults_of(text) == [
        'problem.toml:12: robots[2] "b": start (1.85, 1) is too near to the start of robots[1] "a": '
        "their footprints are 0.05 m apart, clearance 0.1 m is needed",
        'problem.toml:17: robots[3] "c": start (1, 1.7) overlaps the start of robots[1] "a": '
        "their footprints overlap by 0.1 m, clearance 0.1 m is needed",
        'problem.toml:22: robots[4] "d": start (1, 2.7) overlaps the start of robots[3] "c": 1 m apart, '
        "radii 0.707107 m + 0.4 m + clearance 0.1 m are needed "
        "(what turns counts as its circumscribed disc, of radius 0.707107 m)",
    ]


def test_without_a_clearance_squares_may_touch_but_not_overlap(read, faults_of):
    """A side that two squares share is no overlap; a millimetre is."""
    head = HEAD.replace("0.1", "0")
    text = head + shaped("a", (1, 1), (1, 5), "square = 0.8") + shaped("b", (1.8, 1.3), (5, 5), "square = 0.8")
    assert len(read(text).robots) == 2
    (told,) = faults_of(text.replace("1.8", "1.799"))
    assert told.endswith('overlaps the start of robots[1] "a": their footprints overlap by 0.001 m')


def test_via_points_need_room_like_starts_and_goals(faults_of):
    """Each is told on its own line, by its number; other robots may stand there, they will have left."""
    via = "via = [\n[5, 5],\n[0.2, 5],\n[6, 6],\n[6, 6],\n]\n"
    text = HEAD + shaped("a", (1, 1), (8, 8), "disc = 0.4", via) + shaped("b", (5, 5), (1, 8), "disc = 0.4")
    text += "[[obstacles]]\nname = 'rack'\nrectangle = [5.9, 5.9, 6.1, 6.1]\n"
    told = faults_of(text)
    assert [fault.split(" is ")[0] for fault in told] == [
        'problem.toml:12: robots[1] "a": via point 2 (0.2, 5)',
        'problem.toml:13: robots[1] "a": via point 3 (6, 6)',
        'problem.toml:14: robots[1] "a": via point 4 (6, 6)',
    ]


def test_a_thousand_squares_on_one_spot_are_told_in_seconds(faults_of):
    """Only pairs that change the answer are measured."""
    head = 'format = "coord-problem/1"\n[workspace]\nbounds = [-1, -1, 101, 101]\n[defaults]\nfootprint = { square = 0.6 }\n'
    robot = '[[robots]]\nname = "{0}"\nstart = [{3}, {4}]\ngoal = [{1}, {2}]\n'
    text = head + "".join(
        robot.format(k + 1, k % 100, k // 100, 50 + 0.05 * (k % 50), 50 + 0.05 * (k // 50)) for k in range(1_000)
    )
    started = time.perf_counter()
    told = faults_of(text)
    assert time.perf_counter() - started < 20  # 1 s when it was written; measuring all pairs would be minutes
    assert len(told) > 700
