"""A plan's obstacles are the cells of its map, as the checker reads them itself."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coord.verify.cells import map_faults
from coord.verify.grid import MapDescription, NotReadHereError, read_cells
from coord.verify.records import Circle, Polygon

MAP = "type octile\nheight 4\nwidth 6\nmap\n@@@@@@\n@.GS.@\n@..T.@\n@@@@@@\n"


def ring(*corners):
    return tuple((float(x), float(y)) for x, y in corners)


#: What tracing makes of MAP: its frame, and a tree by itself.
FRAME = Polygon("map 1", (ring((0, 0), (6, 0), (6, 4), (0, 4)), ring((1, 1), (1, 3), (5, 3), (5, 1))))
TREE = Polygon("map 2", (ring((3, 1), (4, 1), (4, 2), (3, 2)),))


@pytest.fixture
def floor(tmp_path):
    """The map above as a file."""
    file = tmp_path / "floor.map"
    file.write_text(MAP)
    return MapDescription(file)


def test_the_outlines_of_all_occupied_cells_are_accepted(floor):
    """Whatever their order, and also in two parts that meet along a line."""
    assert map_faults(floor, [FRAME, TREE]) == []
    west = Polygon("a", (ring((0, 0), (1, 0), (1, 4), (0, 4)),))
    rest = Polygon("b", (ring((1, 0), (6, 0), (6, 4), (1, 4), (1, 3), (5, 3), (5, 1), (1, 1)),))
    assert map_faults(floor, [TREE, rest, west]) == []


def test_a_lost_outline_is_told_with_the_place_of_a_cell(floor):
    """The tree of the map has its middle at (3.5, 1.5) m and is missing in the plan."""
    (fault,) = map_faults(floor, [FRAME])
    assert fault == (
        "the cell at (3.5, 1.5) m, column 4 from the left, row 3 from the top, "
        "is occupied on the map, but no obstacle of the plan covers it"
    )
    (fault,) = map_faults(floor, [TREE])
    assert fault.startswith("the cell at (0.5, 0.5) m")
    assert fault.endswith("covers it; so are 15 others")


def test_what_was_added_is_told_too(floor):
    """An outline over a free cell, and one beyond the edge of the map."""
    extra = Polygon("map 3", (ring((1, 1), (2, 1), (2, 2), (1, 2)),))
    (fault,) = map_faults(floor, [FRAME, TREE, extra])
    assert "(1.5, 1.5) m" in fault
    assert "free on the map, but an obstacle of the plan covers it" in fault
    beyond = Polygon("map 3", (ring((6, 0), (8, 0), (8, 1), (6, 1)),))
    assert map_faults(floor, [FRAME, TREE, beyond]) == ["the plan's obstacles of the map cover 2 cells beyond its edge"]


@pytest.mark.parametrize(
    "odd",
    [
        Polygon("odd", (ring((3, 1), (4, 1), (4, 2)),)),
        Polygon("odd", (ring((3, 1), (4, 1), (4, 2.001), (3, 2.001)),)),
        Circle("odd", (3.5, 1.5), 1.0),
    ],
)
def test_what_does_not_run_along_cells_is_refused(floor, odd):
    """A slanted edge, a corner a millimetre off, a circle: none is made of cells, whatever it covers."""
    faults = map_faults(floor, [FRAME, odd])
    assert faults[0] == 'obstacle "odd" does not run along the cells of the map'
    assert len(faults) == 2


@pytest.mark.parametrize("plain", [False, True])
@given(values=st.lists(st.integers(0, 9), min_size=6, max_size=6), negate=st.booleans(), unknown=st.booleans())
def test_a_ros_map_is_occupied_by_its_thresholds(tmp_path_factory, plain, values, negate, unknown):
    """Both kinds of PGM; p = (white - v)/white, or v/white negated; unknown cells as the problem says."""
    folder = tmp_path_factory.mktemp("map")
    body = " ".join(map(str, values)).encode() if plain else bytes(values)
    (folder / "floor.pgm").write_bytes((b"P2" if plain else b"P5") + b"\n# a comment\n3 2\n9\n" + body)
    text = f"image: floor.pgm # beside it\nresolution: 0.5\norigin: [-1.0, 2.0, 0.0]\nnegate: {int(negate)}\n"
    (folder / "floor.yaml").write_text(text + "occupied_thresh: 0.65\nfree_thresh: 0.25\n")
    cells = read_cells(MapDescription(folder / "floor.yaml", unknown="occupied" if unknown else "free"))
    limit = 0.25 if unknown else 0.65
    expected = [int((v / 9 if negate else (9 - v) / 9) >= limit) for v in values]
    assert [list(row) for row in cells.rows] == [expected[3:], expected[:3]]
    assert (cells.resolution, cells.origin) == (0.5, (-1.0, 2.0))


def test_an_origin_may_stand_below_its_key(tmp_path):
    """As YAML writers like to have it: an item a line."""
    (tmp_path / "a.pgm").write_bytes(b"P5 1 1 65535\n\x00\x01")
    text = (
        "image: 'a.pgm'\nresolution: 1\norigin:\n- 3.0\n- -4\n- 0\nnegate: 0\noccupied_thresh: 0.6\nfree_thresh: 0.2\n"
    )
    (tmp_path / "a.yaml").write_text(text)
    cells = read_cells(MapDescription(tmp_path / "a.yaml"))
    assert cells.origin == (3.0, -4.0)
    assert cells.rows == (b"\1",)


def test_an_image_is_occupied_below_its_share_of_white(tmp_path):
    """Grey 100 of 200 is occupied below 0.6, not below 0.5."""
    (tmp_path / "a.pgm").write_bytes(b"P5 2 1 200\n" + bytes([100, 200]))
    for below, row in ((0.6, b"\1\0"), (0.5, b"\0\0")):
        assert read_cells(MapDescription(tmp_path / "a.pgm", 0.1, below)).rows == (row,)


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.png", b"\x89PNG\r\n"),
        ("a.pgm", b"P5 2 2 255\n\0"),
        ("a.pgm", b"P5 2"),
        ("a.pgm", b"P2 1 1 9\nx"),
        ("a.map", b"nothing"),
        ("a.map", MAP.replace("@....@", "@...@").replace(".GS.", ".G").encode()),
        ("a.yaml", b"image: a.pgm\n"),
    ],
)
def test_what_the_checker_cannot_read_it_says(tmp_path, name, data):
    """Other images, files cut short, headers that are none: never an empty list of faults."""
    (tmp_path / name).write_bytes(data)
    with pytest.raises(NotReadHereError):
        map_faults(MapDescription(tmp_path / name), [])
