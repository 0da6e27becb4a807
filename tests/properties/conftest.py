"""Made-up problems: crossings of discs, with obstacles, of all sizes and speeds."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import strategies as st

from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot

SIZE = 14.0
_tenths = st.integers(3, 20).map(lambda n: n / 10)


@st.composite
def _problems(draw, most_robots=6, most_obstacles=3):
    """Two to six robots between free places, none of whose starts or goals overlap, about up to three obstacles."""
    clearance = draw(st.sampled_from([0.0, 0.05]))
    obstacles = []
    for k in range(draw(st.integers(0, most_obstacles))):
        x, y = draw(st.integers(8, 20)) / 2, draw(st.integers(8, 20)) / 2
        if draw(st.booleans()):
            obstacles.append(Circle(f"column {k}", (x, y), draw(st.integers(2, 6)) / 4))
        else:
            width, height = draw(st.integers(1, 6)) / 2, draw(st.integers(1, 6)) / 2
            angle = draw(st.sampled_from([0.0, 0.5]))
            obstacles.append(rectangle(f"rack {k}", (x, y, x + width, y + height), angle))
    robots, starts, goals = [], [], []
    for k in range(draw(st.integers(2, most_robots))):
        radius = draw(st.sampled_from([0.15, 0.3, 0.45]))

        def is_free(place, others, reach=radius + clearance):
            return (
                all(_gap(obstacle, place) >= reach for obstacle in obstacles)
                and reach <= min(place) <= max(place) <= SIZE - reach
                and all(np.hypot(place[0] - x, place[1] - y) >= reach + r for x, y, r in others)
            )

        ends = []
        for others in (starts, goals):
            seed = draw(st.integers(0, 10**6))
            rng = np.random.default_rng(seed)
            tried = (tuple((rng.integers(2, 27, 2) / 2).tolist()) for _ in range(200))
            place = next((place for place in tried if is_free(place, others)), None)
            if place is None:
                break
            ends.append(place)
        if len(ends) < 2:
            break
        starts.append((*ends[0], radius))
        goals.append((*ends[1], radius))
        limits = Limits(draw(_tenths), draw(_tenths), draw(_tenths), draw(_tenths), draw(_tenths))
        more = {"release": draw(st.sampled_from([0.0, 0.0, 2.0])), "priority": draw(st.sampled_from([None, 1.0, 2.0]))}
        robots.append(Robot(f"robot {k}", Footprint(radius), limits, *ends, **more))
    return Problem("made up", Workspace((0.0, 0.0, SIZE, SIZE), clearance), tuple(robots), tuple(obstacles))


def _gap(obstacle, place):
    if isinstance(obstacle, Circle):
        return float(np.hypot(place[0] - obstacle.center[0], place[1] - obstacle.center[1])) - obstacle.radius
    return shapely.distance(shapely.Polygon(obstacle.vertices), shapely.Point(place))


@pytest.fixture(scope="session")
def problems():
    """A hypothesis strategy of problems."""
    return _problems()
