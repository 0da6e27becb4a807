"""Maps alone: the floor, and one robot between two places that are free and far apart."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from coord.importing.places import two_places

YAML = (
    "image: floor.pgm\nresolution: 0.1\norigin: [-1.0, -2.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n"
)


def rooms():
    """Grey values of two rooms of 2 x 3 m with a door of 1 m, cells of 0.1 m."""
    cells = np.full((34, 46), 254, dtype=np.uint8)
    cells[:2] = cells[-2:] = cells[:, :2] = cells[:, -2:] = 0
    cells[:22, 22:24] = 0
    return cells


def pgm(cells):
    return b"P5 %d %d 255\n" % cells.shape[::-1] + cells.tobytes()


def test_a_ros_map_comes_with_a_robot_from_one_room_to_the_other(bring, tmp_path):
    """The way is the longest there is: from a corner of one room through the door to a corner of the other."""
    (tmp_path / "floor.pgm").write_bytes(pgm(rooms()))
    found = bring("floor.yaml", YAML, radius=0.25)
    (robot,) = found.problem.robots
    assert robot.name == "robot 1"
    assert robot.footprint.radius == 0.25
    assert {robot.start[0] < 1.2, robot.goal[0] < 1.2} == {True, False}
    assert abs(robot.start[1] - robot.goal[1]) < 0.5
    assert found.problem.workspace.bounds == pytest.approx((-1.0, -2.0, 3.6, 1.4))
    assert "# An example" in found.text
    assert 'map = "../floor.yaml"' in found.text


def test_unknown_cells_are_what_the_user_says(bring, tmp_path):
    """Written into the problem, so that planning sees the same."""
    (tmp_path / "floor.pgm").write_bytes(pgm(rooms()))
    assert 'unknown = "free"' in bring("floor.yaml", YAML, unknown="free").text


@pytest.mark.parametrize("kind", ["PNG", "BMP", "JPEG", "PPM"])
def test_images_of_all_kinds_become_floors(bring, kind):
    """With the resolution given, and said in the problem."""
    stream = io.BytesIO()
    Image.fromarray(rooms()).save(stream, kind)
    name = {"PNG": "floor.png", "BMP": "floor.bmp", "JPEG": "floor.jpg", "PPM": "floor.pgm"}[kind]
    found = bring(name, stream.getvalue(), resolution=0.1, radius=0.2)
    assert found.problem.workspace.bounds == pytest.approx((0.0, 0.0, 4.6, 3.4))
    assert f'map = "../{name}"\nresolution = 0.1\noccupied_below = 0.5' in found.text


def test_a_movingai_map_comes_with_a_robot_of_its_scale(bring):
    """0.3 cells, whatever a cell is."""
    text = "type octile\nheight 3\nwidth 4\nmap\n.TT.\n.GS@\n..W.\n"
    found = bring("small.map", text, resolution=2.0)
    assert found.problem.robots[0].footprint.radius == pytest.approx(0.6)


def test_simplified_maps_are_written_as_outlines_that_cover_the_map(bring, tmp_path):
    """Ragged walls become straight; the outlines contain all that was occupied, and no more than the tolerance."""
    import shapely

    cells = rooms()
    cells[2, 3::2] = 0
    (tmp_path / "floor.pgm").write_bytes(pgm(cells))
    whole = bring("floor.yaml", YAML, radius=0.2).problem
    found = bring("floor.yaml", YAML, radius=0.2, simplify=0.15, force=True)
    assert "map =" not in found.text
    assert found.problem.workspace.bounds == pytest.approx(whole.workspace.bounds)

    def covered(problem):
        return shapely.union_all([shapely.Polygon(o.vertices, o.holes) for o in problem.obstacles])

    exact, wider = covered(whole), covered(found.problem)
    assert wider.buffer(1e-8).covers(exact)
    assert exact.buffer(0.15 + 1e-3).covers(wider)
    assert shapely.get_num_coordinates(wider) < shapely.get_num_coordinates(exact) / 2


def test_a_map_without_room_is_refused_with_a_remedy(refused):
    """Nothing free, or nothing wide enough."""
    text = "type octile\nheight 1\nwidth 3\nmap\n@.@\n"
    (said,) = refused("a.map", text, radius=0.6)
    assert said == "a.map: nowhere is room for a robot with a radius of 0.6 m; give a smaller --radius"


@settings(deadline=None)
@given(arrays(bool, st.tuples(st.integers(1, 15), st.integers(1, 15))), st.sampled_from([0.2, 0.5, 0.51, 1.2]))
def test_both_places_have_room_and_a_way_between_them(occupied, radius):
    """A disc stands clear of occupied cells and edges at both; None only where no cell has such room."""
    found = two_places(occupied, 1.0, (0.0, 0.0), radius)

    def clear(x, y):
        rows, columns = occupied.shape
        r, c = np.nonzero(occupied)
        dx, dy = np.maximum(np.maximum(c - x, x - c - 1), 0), np.maximum(np.maximum(r - y, y - r - 1), 0)
        return min(x, y, columns - x, rows - y) >= radius and (np.hypot(dx, dy) >= radius).all()

    if found is None:
        centres = [(c + 0.5, r + 0.5) for r in range(occupied.shape[0]) for c in range(occupied.shape[1])]
        reach = np.ceil(radius - 0.5 + 1e-6)
        assert not any(clear_box(occupied, x, y, reach) for x, y in centres)
    else:
        assert all(clear(*place) for place in found)


def clear_box(occupied, x, y, reach):
    """Whether all cells within some rows and columns of a place are on the map and free."""
    r, c = int(y), int(x)
    low, left, high, right = r - int(reach), c - int(reach), r + int(reach) + 1, c + int(reach) + 1
    inside = low >= 0 and left >= 0 and high <= occupied.shape[0] and right <= occupied.shape[1]
    return inside and not occupied[low:high, left:right].any()


def test_places_are_joined_and_as_far_apart_as_a_corridor_is_long():
    """A serpentine: from one end of it to the other; a larger closed room beside it would win."""
    lines = ["########", "#......#", "######.#", "#......#", "#.######", "#......#", "########"]
    occupied = np.array([[c == "#" for c in line] for line in lines])
    assert set(two_places(occupied, 1.0, (0.0, 0.0), 0.3)) == {(1.5, 1.5), (6.5, 5.5)}
