"""GeoJSON: polygons, points and lines."""

from __future__ import annotations

import json

import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from coord.errors import BadFileError
from coord.importing.features import collect
from coord.importing.geojson import geojson_draft
from coord.importing.values import ImportOptions


def polygon(*rings):
    return {"type": "Polygon", "coordinates": [[*ring, ring[0]] for ring in rings]}


def point(x, y):
    return {"type": "Point", "coordinates": [x, y]}


def line(*places):
    return {"type": "LineString", "coordinates": list(places)}


def collection(*features, **more):
    found = [{"type": "Feature", "properties": p, "geometry": g} for p, g in features]
    return {"type": "FeatureCollection", "features": found, **more}


WALL = polygon([[0, 0], [20, 0], [20, 10], [0, 10]], [[1, 1], [1, 9], [19, 9], [19, 1]])
RACK = polygon([[4, 4], [6, 4], [6, 5], [4, 5]])
FLOOR = [
    ({"name": "wall"}, WALL),
    ({"name": "rack"}, RACK),
    ({"robot": "a", "role": "start", "speed": 0.5}, point(2, 2)),
    ({"robot": "a", "role": "via"}, point(8, 8)),
    ({"robot": "a", "role": "goal"}, point(17, 8)),
    ({"robot": "b"}, line([2, 8], [10, 7], [17, 2])),
    ({}, line([0, 0], [1, 1])),
    (None, None),
]


def moved(value, move):
    """All positions of a document moved."""
    if isinstance(value, list) and len(value) == 2 and all(isinstance(v, int | float) for v in value):
        return move(*value)
    if isinstance(value, list):
        return [moved(item, move) for item in value]
    return {key: moved(item, move) for key, item in value.items()} if isinstance(value, dict) else value


def covered(problem):
    return shapely.union_all([shapely.Polygon(o.vertices) for o in problem.obstacles])


def test_obstacles_robots_and_paths_come_as_they_are_drawn(bring):
    """Names, places, limits from the start's properties; a polygon with a hole in parts; the rest counted."""
    found = bring("a.geojson", json.dumps(collection(*FLOOR)))
    a, b = found.problem.robots
    assert (a.name, a.start, a.goal, a.via, a.limits.speed) == ("a", (2, 2), (17, 8), ((8, 8),), 0.5)
    assert (b.name, b.start, b.goal, b.path) == ("b", (2, 8), (17, 2), ((2, 8), (10, 7), (17, 2)))
    names = [obstacle.name for obstacle in found.problem.obstacles]
    assert names == ["wall, part 1", "wall, part 2", "rack"]
    wall = shapely.Polygon([[0, 0], [20, 0], [20, 10], [0, 10]], [[[1, 1], [1, 9], [19, 9], [19, 1]]])
    assert covered(found.problem).equals(wall.union(shapely.box(4, 4, 6, 5)))
    assert "Left out, points and lines that belong to no robot: 1." in found.remarks


def test_a_workspace_bounds_the_floor_and_what_is_outside_of_it_is_closed(bring):
    """A house of five corners: its box is the workspace, the two triangles beside the roof become obstacles."""
    house = polygon([[0, 0], [10, 0], [10, 6], [5, 10], [0, 6]])
    found = bring("a.json", json.dumps(collection(({"role": "workspace"}, house))))
    assert found.problem.workspace.bounds == (0, 0, 10, 10)
    assert covered(found.problem).area == pytest.approx(20)
    (robot,) = found.problem.robots
    assert not covered(found.problem).buffer(0.3).contains(shapely.Point(robot.start))
    assert shapely.distance(shapely.Point(robot.start), shapely.Point(robot.goal)) > 8


def test_coordinates_of_a_national_grid_are_moved_to_the_origin(bring):
    """By whole metres that the text says; everything else stays as it was."""
    here = bring("a.geojson", json.dumps(collection(*FLOOR))).problem
    far = moved(collection(*FLOOR), lambda x, y: [x + 691000.25, y + 5334000.5])
    found = bring("b.geojson", json.dumps(far), force=True)
    assert any("subtract (691000, 5334000) m" in remark for remark in found.remarks)
    for one, other in zip(here.robots, found.problem.robots, strict=True):
        assert other.start == (one.start[0] + 0.25, one.start[1] + 0.5)


def test_degrees_are_refused_unless_they_are_said_to_be_metres(bring, refused):
    """A floor of 20 m drawn in longitude and latitude; a small one in metres needs a word."""
    degrees = moved(collection(*FLOOR), lambda x, y: [11.5 + x * 1e-5, 48.1 + y * 1e-5])
    (said,) = refused("a.geojson", json.dumps(degrees))
    assert "look like degrees" in said
    assert "project them to metres first" in said
    tiny = json.dumps(collection(({}, polygon([[0, 0], [0.2, 0], [0, 0.2]]))))
    assert "look like degrees" in refused("b.geojson", tiny, force=True)[0]
    assert bring("b.geojson", tiny, metres=True).problem.obstacles


def test_a_file_that_says_its_system_is_believed(bring, refused):
    """The older form of GeoJSON names it: a projected one is metres however small, CRS84 is degrees however large."""
    utm = {"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}}
    crs84 = {"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}}
    tiny = ({}, polygon([[0, 0], [0.2, 0], [0, 0.2]]))
    assert "look like degrees" in refused("a.geojson", json.dumps(collection(*FLOOR, **crs84)))[0]
    assert bring("b.geojson", json.dumps(collection(tiny, **utm))).problem.obstacles


def test_all_faults_are_told_with_their_features(refused):
    """Shapes, positions, roles, robots without a goal, paths that begin elsewhere."""
    text = collection(
        ({"name": "bow"}, polygon([[0, 0], [10, 0], [0, 6], [10, 10]])),
        ({"robot": "a", "role": "start"}, point(2, "x")),
        ({"robot": "c", "role": "stop"}, point(2, 3)),
        ({"robot": "d", "role": "start", "speed": {"v": None}}, point(2, 3)),
        ({"robot": "e", "role": "goal"}, point(2, 3)),
        ({"robot": "f"}, line([1, 1], [2, 2])),
        ({"robot": "f", "role": "start"}, point(5, 5)),
        ({}, {"type": "Circle", "coordinates": [1, 2]}),
    )
    assert refused("a.geojson", json.dumps(text)) == [
        'a.geojson: features[1] "bow": the outlines are no polygon: self-intersection at (3.75, 3.75)',
        'a.geojson: features[2]: a position is [x, y], two numbers (got [2, "x"])',
        'a.geojson: features[3]: role of a robot\'s point must be "start", "goal" or "via" (got "stop")',
        "a.geojson: features[4]: speed is nothing that a problem file can say (got { v = None })",
        'a.geojson: features[8]: a geometry of the type "Circle" is unknown',
        'a.geojson: robot "a": has no start and no goal: a point with role "start" or "goal"',
        'a.geojson: robot "c": has no start and no goal: a point with role "start" or "goal"',
        'a.geojson: robot "d": has no start and no goal: a point with role "start" or "goal"',
        'a.geojson: robot "e": has no start: a point with role "start" or "goal"',
        'a.geojson: robot "f": its path does not begin at its start and end at its goal',
    ]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ('{"type": "FeatureCollection",\n "features": [}', "a.geojson:2: this is no JSON: "),
        ("[1]", "a.geojson:1: this is no GeoJSON"),
        ('{"type": "FeatureCollection", "features": []}', "a.geojson: there are neither polygons nor robots in it"),
        ("[" * 100_000, "a.geojson: the file is nested too deeply"),
    ],
)
def test_what_is_no_geojson_is_refused(refused, text, fault):
    """Broken, another kind of JSON, empty, too deep."""
    assert refused("a.geojson", text)[0].startswith(fault)


def test_a_geometry_by_itself_and_collections_of_geometries_are_read():
    """With or without features round them."""
    both = {
        "type": "GeometryCollection",
        "geometries": [RACK, {"type": "MultiPolygon", "coordinates": [WALL["coordinates"]]}],
    }
    for document in (both, {"type": "Feature", "properties": None, "geometry": both}):
        assert len(collect(document).all_obstacles()) == 2


JSON = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=True) | st.text(max_size=5) | st.sampled_from(["Polygon", "Point"]),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.sampled_from(["type", "coordinates", "geometry", "properties", "robot", "role"]), inner)
    ),
    max_leaves=20,
)


@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(JSON, max_size=3))
def test_whatever_features_say_there_is_a_draft_or_a_fault(tmp_path, features):
    """No document of features ends in another error."""
    file = tmp_path / "a.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    try:
        told = geojson_draft(file, tmp_path, ImportOptions()).robots
    except BadFileError as error:
        told = error.faults
    assert told
