"""Whatever the motions: the checker and dense sampling by the planner's own code agree.

Sampling cannot prove that a distance is kept, but with known speeds it says how far it can be off; the clearance of
the plan is set just beyond that on either side, so that both verdicts are due, not only allowed.
"""

from __future__ import annotations

import math

import numpy as np
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from coord.model.arrays import frozen
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.verify import verify

STEPS = 4000

curvatures = st.one_of(st.just(0.0), st.floats(-1.5, 1.5))
bends = st.lists(st.tuples(st.floats(0.2, 3.0), curvatures, curvatures), min_size=1, max_size=3)
lines = st.tuples(st.tuples(st.floats(1.0, 6.0), st.just(0.0), st.just(0.0))).map(list)
footprints = st.sampled_from(
    [
        {"disc": 0.3},
        {"disc": 0.05},
        {"square": 0.5},
        {"polygon": [[-0.5, -0.2], [0.4, -0.2], [0.6, 0.0], [0.4, 0.2], [-0.5, 0.2]]},
    ]
)


@st.composite
def robots(draw, name):
    """A robot somewhere on a floor of a few metres, on lines and bends, with a rest on the way or none."""
    pieces = draw(st.one_of(lines, bends))
    length = math.fsum(piece[0] for piece in pieces)
    share = draw(st.sampled_from([1.0, 1.0, 0.4]))
    runs = [(share * length, 1.0), ((1 - share) * length, 0.0)] if share < 1 else [(length, 0.0)]
    return {
        "name": name,
        "start": (draw(st.floats(-3, 3)), draw(st.floats(-3, 3))),
        "pieces": pieces,
        "turned": draw(st.floats(-3.2, 3.2)),
        "footprint": draw(footprints),
        "heading": draw(st.sampled_from(["fixed", "path"])),
        "departure": draw(st.sampled_from([0.0, 0.0, 1.3])),
        "runs": runs,
        "limits": {"lateral_acceleration": 100.0},
    }


def made(build, given):
    rest = {key: value for key, value in given.items() if key not in ("name", "start")}
    return build.robot(given["name"], given["start"], **rest)


def motion(robot):
    profile = robot["profile"]
    path = Path(tuple(robot["path"]["start"]), frozen(robot["path"]["pieces"], 3))
    return path, VelocityProfile(profile["times"], profile["states"], profile["jerks"])


def shapes(robot, poses):
    """Footprints at poses (m, 3): shapely points or polygons, and the radius to add."""
    kind, size = next(iter(robot["footprint"].items()))
    if kind == "disc":
        return shapely.points(poses[:, :2]), size
    half = size / 2 if kind == "square" else 0.0
    corners = np.array(size if kind == "polygon" else [[-half, -half], [half, -half], [half, half], [-half, half]])
    angle = poses[:, 2] if robot["heading"] == "path" else np.zeros(len(poses))
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    x, y = c * corners[:, 0] - s * corners[:, 1], s * corners[:, 0] + c * corners[:, 1]
    return shapely.polygons(np.stack([x + poses[:, :1], y + poses[:, 1:2]], axis=2)), 0.0


def quickness(robot):
    """How far any point of a footprint moves for a metre of the path, at most."""
    (kind,) = robot["footprint"]
    corner = {"disc": 0.0, "square": 0.8, "polygon": 0.8}[kind] if robot["heading"] == "path" else 0.0
    return 1 + corner * max(abs(k) for piece in robot["path"]["pieces"] for k in piece[1:])


@settings(max_examples=40, deadline=None, derandomize=True)
@given(first=robots("a"), second=robots("b"))
def test_verdict_and_least_clearance_of_two_robots_agree_with_sampling(build, first, second):
    """Certified when the clearance is below what sampling can miss, refused when it is above what sampling saw."""
    pair = [made(build, first), made(build, second)]
    end = max(robot["arrival"] for robot in pair)
    t = np.linspace(0, end, STEPS + 1)
    geometry, radius, step = [], 0.0, 0.0
    for robot in pair:
        path, profile = motion(robot)
        shape, r = shapes(robot, path.pose(profile.state(t)[:, 0]))
        geometry.append(shape)
        radius += r
        step += quickness(robot) * robot["limits"]["speed"] * end / STEPS / 2
    distances = shapely.distance(*geometry) - radius
    seen = float(distances.min())
    assume(seen > 2 * step)

    report = verify(build.data(build.plan(pair, clearance=seen - step)))
    assert report.certified, report
    least = report.min_clearance
    assert seen - step <= least.value <= seen + 1e-6
    k = min(int(least.time / end * STEPS), STEPS - 1) if least.time < end else STEPS - 1
    assert distances[k] <= least.value + 2 * step + 1e-6

    report = verify(build.data(build.plan(pair, clearance=seen + 2e-6)))
    assert {fault.code for fault in report.faults} == {"collision"}
    exact = least.value
    assert verify(build.data(build.plan(pair, clearance=exact - 1e-6))).certified
    assert not verify(build.data(build.plan(pair, clearance=exact + 1e-6))).certified


@settings(max_examples=40, deadline=None, derandomize=True)
@given(first=robots("a"), second=robots("b"))
def test_what_overlaps_in_any_sample_is_never_certified(build, first, second):
    """Robots put on top of each other by force, at any clearance, even none."""
    second = {**second, "start": first["start"], "departure": first["departure"]}
    report = verify(build.data(build.plan([made(build, first), made(build, second)], clearance=0.0)))
    assert "collision" in {fault.code for fault in report.faults}
    assert report.min_clearance.value == 0.0


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    given_robot=robots("a"),
    angles=st.lists(st.floats(0, 6.28), min_size=3, max_size=6, unique_by=lambda a: round(a, 1)),
    sizes=st.lists(st.floats(0.3, 2.0), min_size=6, max_size=6),
    place=st.tuples(st.floats(-4, 4), st.floats(-4, 4)),
    round_one=st.booleans(),
)
def test_obstacles_agree_with_sampling(build, given_robot, angles, sizes, place, round_one):
    """One robot and one obstacle, round or star-shaped and often concave: both verdicts, where they are due."""
    robot = made(build, given_robot)
    path, _ = motion(robot)
    s = np.linspace(0, path.length, STEPS + 1)
    geometry, radius = shapes(robot, path.pose(s))
    if round_one:
        obstacle, shape, grown = build.circle("o", *place, sizes[0]), shapely.Point(place), sizes[0]
    else:
        corners = [
            (place[0] + r * math.cos(a), place[1] + r * math.sin(a))
            for a, r in zip(sorted(angles), sizes, strict=False)
        ]
        shape, grown = shapely.Polygon(corners), 0.0
        assume(shape.is_valid and shape.exterior.is_ccw and shape.area > 0.01)
        obstacle = build.polygon("o", *corners)
    seen = float((shapely.distance(geometry, shape) - radius - grown).min())
    step = quickness(robot) * path.length / STEPS / 2
    assume(abs(seen) > 2 * step or seen <= 0)
    if seen > 0:
        assert verify(build.data(build.plan([robot], obstacles=[obstacle], clearance=seen - step))).certified
    report = verify(build.data(build.plan([robot], obstacles=[obstacle], clearance=max(seen, 0.0) + 2e-6)))
    assert {fault.code for fault in report.faults} == {"obstacle"}


@settings(max_examples=40, deadline=None, derandomize=True)
@given(given_robot=robots("a"), turn=st.integers(0, 3))
def test_the_edge_of_the_workspace_agrees_with_sampling(build, given_robot, turn):
    """One side of the workspace is moved to where sampling says it is needed."""
    robot = made(build, given_robot)
    path, _ = motion(robot)
    geometry, radius = shapes(robot, path.pose(np.linspace(0, path.length, STEPS + 1)))
    low, high = (
        shapely.bounds(geometry)[:, :2].min(axis=0) - radius,
        shapely.bounds(geometry)[:, 2:].max(axis=0) + radius,
    )
    step = quickness(robot) * path.length / STEPS / 2
    for beyond, certified in ((step, True), (-2e-6, False)):
        bounds = [-50.0, -50.0, 50.0, 50.0]
        out = 0.05 + beyond
        bounds[turn] = float(low[turn] - out if turn < 2 else high[turn - 2] + out)
        report = verify(build.data(build.plan([robot], bounds=bounds)))
        assert report.certified == certified, report
        assert {fault.code for fault in report.faults} <= {"workspace"}


@settings(max_examples=30, deadline=None, derandomize=True)
@given(given_robot=robots("a"))
def test_lateral_acceleration_agrees_with_sampling(build, given_robot):
    """The limit is set to what sampling saw, a little more and a little less."""
    robot = made(build, given_robot)
    path, profile = motion(robot)
    times = np.unique(np.concatenate([np.linspace(0, robot["arrival"], 6 * STEPS), robot["profile"]["times"]]))
    states = profile.state(times)
    sides = [np.abs(path.curvature(np.clip(states[:, 0] + e, 0, path.length))) for e in (-1e-9, 1e-9)]
    seen = float((states[:, 1] ** 2 * np.maximum(*sides)).max())
    assume(seen > 1e-3)
    for share, certified in ((1.01, True), (1 - 1e-6, False)):
        robot["limits"]["lateral_acceleration"] = seen * share
        report = verify(build.data(build.plan([robot])))
        assert report.certified == certified, (report, seen)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(
    ends=st.lists(st.tuples(*[st.integers(-12, 12)] * 4, st.integers(0, 8)), min_size=3, max_size=12, unique=True),
    scale=st.sampled_from([1.0, 30.0]),
    leave=st.booleans(),
)
def test_the_closest_of_many_robots_is_found_wherever_it_is(build, ends, scale, leave):
    """The least clearance over all pairs and times, crowded or far apart, against sampling of all pairs."""
    robots = [
        build.robot(f"r{k}", (scale * x, scale * y), (scale * u, scale * v), departure=float(t))
        for k, (x, y, u, v, t) in enumerate(ends)
    ]
    end = max(robot["arrival"] for robot in robots)
    t = np.linspace(0, end, STEPS + 1)
    places = []
    for robot in robots:
        path, profile = motion(robot)
        place = path.pose(profile.state(t)[:, 0])[:, :2]
        if leave:
            place[t > robot["arrival"]] = np.nan
        places.append(place)
    pairs = [(i, j) for j in range(len(robots)) for i in range(j)]
    seen = float(np.nanmin([np.hypot(*(places[i] - places[j]).T) for i, j in pairs])) - 0.6
    step = end / STEPS + 1e-9  # and rounding, where nobody moves
    after = "leave" if leave else "stay"
    bounds = [-5000.0, -5000.0, 5000.0, 5000.0]
    for clearance in (0.0, 0.05, max(seen - step - 1e-6, 0.0), max(seen + 1e-5, 0.0)):
        report = verify(build.data(build.plan(robots, clearance=clearance, after_arrival=after, bounds=bounds)))
        assert max(seen - step, 0.0) <= report.min_clearance.value <= max(seen, 0.0) + 1e-6
        if clearance < seen - step:
            assert report.certified, report
        if clearance > seen + 1e-6:
            assert {fault.code for fault in report.faults} == {"collision"}
