"""Grown obstacles: merging and cutting change neither the floor that is taken nor where paths may turn."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

import coord.geometry.growth
from coord.geometry.growth import grow
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle

BOUNDS = (0.0, 0.0, 20.0, 15.0)
L_SHAPE = Polygon("l", np.array([(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)], float) + 5)


def distance_to(grown, points):
    """Least distance to all parts, less what the centre keeps from each."""
    places = shapely.points(points)
    return np.min(
        [shapely.distance(part, places) - rho for part, rho in zip(grown.parts, grown.rho, strict=True)], axis=0
    )


def random_polygons(rng, count):
    shapes = []
    for k in range(count):
        angles = np.sort(rng.uniform(0, 2 * np.pi, 12))
        at = rng.uniform((3, 3), (17, 12))
        radii = rng.uniform(0.5, 3.0, 12)[:, None]
        shapes.append(Polygon(f"p{k}", at + radii * np.stack([np.cos(angles), np.sin(angles)], axis=1)))
    return [shape for shape in shapes if shapely.Polygon(shape.vertices).is_valid]


@pytest.mark.parametrize("most", [12, 64])
def test_merged_and_cut_parts_take_the_same_floor(monkeypatch, most):
    """At 2,000 places the distance to the nearest part is that to the nearest obstacle, up to rounding."""
    monkeypatch.setattr(coord.geometry.growth, "_MOST_VERTICES", most)
    rng = np.random.default_rng(1)
    for _ in range(10):
        polygons = random_polygons(rng, 6)
        obstacles = [*polygons, Circle("c", (4.0, 4.0), 1.0)]
        points = rng.uniform((0, 0), (20, 15), (2000, 2))
        cores = [shapely.Polygon(polygon.vertices) for polygon in polygons]
        expected = np.min([shapely.distance(core, shapely.points(points)) for core in cores], axis=0) - 0.3
        expected = np.minimum(expected, np.hypot(*(points - 4.0).T) - 1.3)
        got = distance_to(grow(obstacles, Footprint(0.3), 0.0, BOUNDS), points)
        assert got == pytest.approx(expected, abs=1e-9)


def test_parts_are_small():
    """A polygon of 500 vertices is cut until no part has more than 64."""
    angles = np.linspace(0, 2 * np.pi, 500, endpoint=False)
    blob = Polygon("b", 7 + np.stack([np.cos(angles), np.sin(angles)], axis=1) * (3 + np.cos(40 * angles))[:, None])
    assert max(shapely.get_num_coordinates(part) for part in grow([blob], Footprint(0.2), 0.0, BOUNDS).parts) <= 65


def test_obstacles_that_touch_become_one_part():
    """Sharing an edge, a corner, or some floor; a circle stays its own part."""
    parts = [rectangle("a", (1, 1, 2, 2)), rectangle("b", (2, 1, 3, 2)), rectangle("c", (2.5, 1.5, 4, 3))]
    assert len(grow(parts, Footprint(0.1), 0.0, BOUNDS).parts) == 1
    assert (
        len(
            grow(
                [*parts, rectangle("d", (5, 5, 6, 6)), Circle("e", (1.5, 1.5), 0.1)], Footprint(0.1), 0.0, BOUNDS
            ).parts
        )
        == 3
    )


def test_an_obstacle_alone_keeps_its_vertices_to_the_last_bit():
    """Nothing is rounded on the way through shapely."""
    wild = Polygon("w", np.array([(0.1, 0.2), (1 / 3, 0.7), (0.3, np.pi)]))
    (part,) = grow([wild], Footprint(0.1), 0.0, BOUNDS).parts
    assert {tuple(vertex) for vertex in shapely.get_coordinates(part).tolist()} == {
        tuple(v) for v in wild.vertices.tolist()
    }


def test_paths_turn_at_convex_corners_only():
    """An L has five of them, the sixth is reflex; the directions at each span the angle by which the outline turns."""
    corners = grow([L_SHAPE], Footprint(0.2), 0.0, BOUNDS).corners
    assert sorted(map(tuple, corners.places.tolist())) == [(5, 5), (5, 9), (6, 9), (9, 5), (9, 6)]
    assert corners.span == pytest.approx(np.full(5, np.pi / 2))
    at = corners.places.tolist().index([9.0, 5.0])
    assert corners.first[at] % (2 * np.pi) == pytest.approx(3 * np.pi / 2)


def test_a_circle_turns_paths_in_all_directions():
    """Its one corner is the centre, with a full turn."""
    grown = grow([Circle("c", (3.0, 4.0), 1.0)], Footprint(0.25), 0.0, BOUNDS)
    assert grown.corners.places.tolist() == [[3.0, 4.0]]
    assert grown.corners.span.tolist() == [2 * np.pi]
    assert grown.rho.tolist() == [1.25]


def test_a_hole_turns_paths_at_none_of_its_convex_looking_corners():
    """Seen from within a square room all corners are reflex; a pillar that juts into the room gives two."""
    outline = np.array([(1, 1), (9, 1), (9, 9), (1, 9)], float)
    square = np.array([(2, 2), (8, 2), (8, 8), (2, 8)], float)
    assert len(grow([Polygon("r", outline, (square,))], Footprint(0.2), 0.0, BOUNDS).corners.places) == 4
    notched = np.array([(2, 2), (4, 2), (4, 4), (5, 4), (5, 2), (8, 2), (8, 8), (2, 8)], float)
    inside = grow([Polygon("r", outline, (notched,))], Footprint(0.2), 0.0, BOUNDS).corners.places[4:].tolist()
    assert sorted(inside) == [[4.0, 4.0], [5.0, 4.0]]


def test_the_centre_keeps_its_reach_from_the_edge():
    """The box of places is the workspace, inset by the reach on all sides; without obstacles there are no parts."""
    grown = grow([], Footprint(0.4), 0.0, BOUNDS)
    assert grown.box == (0.4, 0.4, 19.6, 14.6)
    assert len(grown.parts) == len(grown.edges) == len(grown.corners.places) == 0
