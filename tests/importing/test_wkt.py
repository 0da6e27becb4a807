"""Well-known text, a geometry a line."""

from __future__ import annotations

TEXT = """\
# two racks

rack 1: POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 2, 1 1))
MULTIPOLYGON (((10 0, 12 0, 12 3, 10 0)), ((20 0, 22 0, 22 3, 20 0)))
GEOMETRYCOLLECTION (POINT (1 1), POLYGON ((10 10, 12 10, 11 12, 10 10)))
"""


def test_every_polygon_becomes_an_obstacle_with_its_name(bring):
    """Named before a colon or by its line; holes and multipolygons in parts; a robot beside them to begin with."""
    found = bring("a.wkt", TEXT)
    names = [obstacle.name for obstacle in found.problem.obstacles]
    assert names == ["rack 1, part 1", "rack 1, part 2", "obstacle 4, part 1", "obstacle 4, part 2", "obstacle 5"]
    assert found.problem.workspace.bounds == (-1.6, -1.6, 23.6, 13.6)
    assert len(found.problem.robots) == 1
    assert "Left out, points and lines, which cover no floor: 1." in found.remarks


def test_faulty_lines_are_told_all_at_once(refused):
    """Not closed, crossing itself, no geometry, numbers that are none."""
    lines = [
        "a: POLYGON ((0 0, 4 0, 4 4, 0 4))",
        "b: POLYGON ((0 0, 4 4, 4 0, 0 4, 0 0))",
        "123",
        "POLYGON ((0 0, 4 nan, 4 0, 0 0))",
    ]
    faults = refused("a.wkt", "\n".join(lines))
    assert faults[0].startswith("a.wkt:1: this is no well-known text: Points of LinearRing")
    assert faults[1] == "a.wkt:2: the outlines are no polygon: self-intersection at (2, 2)"
    assert faults[2] == 'a.wkt:3: this is no well-known text: it begins with no geometry (got "123")'
    assert faults[3] == "a.wkt:4: all corners must be finite numbers"


def test_a_file_without_polygons_is_refused(refused):
    """Points alone are no floor."""
    assert refused("a.wkt", "POINT (1 2)\n") == ["a.wkt: there is no polygon in it, so nothing to import"]
