"""The table of bad files: what is wrong, and the very words in which it is told."""

from __future__ import annotations

import pytest

HEAD = 'format = "coord-problem/1"\n[workspace]\nbounds = [0, 0, 10, 10]\n'
ROBOT = '[[robots]]\nname = "a"\nstart = [1, 1]\ngoal = [9, 1]\n'
FOOTPRINTS = "one of { disc = radius }, { square = side }, { polygon = [[x, y], ...] }"

# what follows HEAD (lines 1 to 3) and ROBOT (lines 4 to 7), beginning in line 8; the fault, told of robots[1] "a"
ROBOT_FAULTS = [
    ("speed = -1", "speed must be > 0 m/s (got -1)"),
    ("acceleration = 0", "acceleration must be > 0 m/s2 (got 0)"),
    ("deceleration = -0.5", "deceleration must be > 0 m/s2 (got -0.5)"),
    ("jerk = inf", "jerk must be finite (got inf)"),
    ("lateral_acceleration = nan", "lateral_acceleration must be finite (got nan)"),
    ("speed = true", "speed must be a number in m/s (got true)"),
    ('speed = "fast"', 'speed must be a number in m/s (got "fast")'),
    ("speed = [1]", "speed must be a number in m/s (got [1])"),
    ("speed = 2020-01-01", "speed must be a number in m/s (got 2020-01-01)"),
    ("spede = 1", 'unknown key "spede"; did you mean "speed"?'),
    ("clearance = 1", 'unknown key "clearance"; it belongs in [workspace]'),
    ("priority = nan", "priority must be finite (got nan)"),
    ("release = -1", "release must be >= 0 s (got -1)"),
    ("weight = -2.5", "weight must be >= 0 (got -2.5)"),
    ("corner_radius = -1", "corner_radius must be a number >= 0 in m (got -1)"),
    ("footprint = 0.3", f"footprint must be {FOOTPRINTS} (got 0.3)"),
    ("footprint = {}", f"footprint must be {FOOTPRINTS} (got {{}})"),
    (
        "footprint = { disc = 1, square = 1 }",
        f"footprint must be {FOOTPRINTS} (got {{ disc = 1, square = 1 }})",
    ),
    ('footprint = { disc = "x" }', 'footprint.disc must be a number in m, the radius (got "x")'),
    ("footprint = { disk = 1 }", 'unknown key "disk"; did you mean "disc"?'),
    ("footprint = { disc = 0.0 }", "the disc's radius must be > 0 m (got 0)"),
    ('heading = "north"', 'heading must be "fixed" or "path" (got "north")'),
    ("side = 1", 'side must be "quickest", "left" or "right" (got 1)'),
    ('via = [[1, 1], [2, "x"]]', 'via must be a list of points [x, y] in m (got "x" as item 2)'),
    (
        "via = [[9.9, 5]]",
        "via point 1 (9.9, 5) is 0.2 m too near to the right edge of the workspace: its centre is "
        "0.1 m from it, radius 0.3 m is needed",
    ),
    ("path = []", "path must be a list of two points [x, y] or more in m (got [])"),
    ("path = [[1, 1]]", "path must be a list of two points [x, y] or more in m (got [[1, 1]])"),
    ("path = [[1, 1], [5, 5], [9, 2]]", "a given path begins at the robot's start and ends at its goal"),
    (
        "path = [[1, 1], [9, 1]]\nside = 'left'",
        "a robot with a given path has neither side nor via: the path says it all",
    ),
    ("footprint = { square = 0.0 }", "the square's side must be > 0 m (got 0)"),
    (
        "footprint = { polygon = [[0, 0], [1, 0]] }",
        "a footprint needs at least 3 corners that are not on one line (got [[0.0, 0.0], [1.0, 0.0]])",
    ),
    (
        "footprint = { polygon = [[1, 0], [0, 1], [-1, 0], [0, -1], [0.1, 0]] }",
        "the footprint must be convex, without repeated corners",
    ),
    (
        "footprint = { polygon = [[0.1, 0], [1, 0], [0.1, 1]] }",
        "the footprint must hold its reference point (0, 0)",
    ),
    (
        "footprint = { polygon = [[0, 0], [1, nan], [0, 1]] }",
        "footprint.polygon must be finite (got nan as item 2)",
    ),
]


@pytest.mark.parametrize(("line", "fault"), ROBOT_FAULTS, ids=[line for line, _ in ROBOT_FAULTS])
def test_a_robot_with_a_fault_is_told_so(faults_of, line, fault):
    """One bad line in a robot is one fault, with its line, the robot, the value, the unit and the rule."""
    assert faults_of(f"{HEAD}{ROBOT}{line}\n") == [f'problem.toml:8: robots[1] "a": {fault}']


DEFAULTS_FAULTS = [
    ("speed = -1", "speed must be > 0 m/s (got -1)"),
    ("acceleration = -1", "acceleration must be > 0 m/s2 (got -1)"),
    ("weight = -1", "weight must be >= 0 (got -1)"),
    ("footprint = { disc = -1 }", "the disc's radius must be > 0 m (got -1)"),
    ("priority = 1", 'unknown key "priority"; it belongs in [[robots]]'),
    ('heading = "north"', 'heading must be "fixed" or "path" (got "north")'),
    ("path = [[1, 1], [9, 1]]", 'unknown key "path"; it belongs in [[robots]]'),
    ("footprint = { square = -1 }", "the square's side must be > 0 m (got -1)"),
]


@pytest.mark.parametrize(("line", "fault"), DEFAULTS_FAULTS, ids=[line for line, _ in DEFAULTS_FAULTS])
def test_a_faulty_default_is_told_once(faults_of, line, fault):
    """A fault of [defaults] is told there, not of every robot that has it."""
    text = f"{HEAD}[defaults]\n{line}\n{ROBOT}" + ROBOT.replace('"a"', '"b"').replace("1]", "5]")
    assert faults_of(text) == [f"problem.toml:5: [defaults]: {fault}"]


PLACES = [
    ("start = [1, 1]", "", 4, "start is missing; every robot needs a start"),
    ("goal = [9, 1]", "", 4, "goal is missing; every robot needs a goal"),
    ("start = [1, 1]", "start = [1]", 6, "start must be [x, y], two numbers in m (got [1])"),
    ("start = [1, 1]", "start = [1, 1, 1]", 6, "start must be [x, y], two numbers in m (got [1, 1, 1])"),
    ("start = [1, 1]", "start = [1, true]", 6, "start must be [x, y], two numbers in m (got [1, true])"),
    ("start = [1, 1]", "start = [1, nan]", 6, "start must be finite (got [1, nan])"),
    ("start = [1, 1]", "start = 5", 6, "start must be [x, y], two numbers in m (got 5)"),
    ("start = [1, 1]", "start = [\n1,\n# one\n'x']", 9, 'start must be [x, y], two numbers in m (got [1, "x"])'),
    (
        "goal = [9, 1]",
        "goal = [2e6, 1]",
        7,
        "goal must stay within 1e+06 m of the origin (got [2000000.0, 1]); move the origin nearer",
    ),
    (
        "goal = [9, 1]",
        "goal = [11, 1]",
        7,
        "goal (11, 1) is outside the workspace (x from 0 to 10 m, y from 0 to 10 m)",
    ),
    (
        "goal = [9, 1]",
        "goal = [9.8, 1]",
        7,
        "goal (9.8, 1) is 0.1 m too near to the right edge of the workspace: its centre is 0.2 m from it, "
        "radius 0.3 m is needed",
    ),
]


@pytest.mark.parametrize(("old", "new", "line", "fault"), PLACES, ids=[new or f"no {old}" for old, new, _, _ in PLACES])
def test_a_faulty_start_or_goal_is_told(faults_of, old, new, line, fault):
    """A start or goal that is missing, malformed or out of the workspace is one fault."""
    assert faults_of(HEAD + ROBOT.replace(old, new)) == [f'problem.toml:{line}: robots[1] "a": {fault}']


NAMES = [
    ("", 4, "name is missing; every robot needs a name"),
    ('name = ""', 5, "a robot needs a name that is not empty"),
    ("name = 7", 5, "name must be a text (got 7)"),
]


@pytest.mark.parametrize(("name", "line", "fault"), NAMES)
def test_a_robot_without_a_name_is_told_by_its_place(faults_of, name, line, fault):
    """Names are required; the robot is then known by its place in the file, counted from 1."""
    assert faults_of(HEAD + ROBOT.replace('name = "a"', name)) == [f"problem.toml:{line}: robots[1]: {fault}"]


OBSTACLES = [
    ('name = "r"', 8, 'obstacles[1] "r": an obstacle is one of rectangle, circle, polygon (got none)'),
    (
        "circle = { center = [5, 5], radius = 1 }\npolygon = [[4, 4], [5, 4], [4, 5]]",
        8,
        "obstacles[1]: an obstacle is one of rectangle, circle, polygon (got circle and polygon)",
    ),
    ("polgon = [[4, 4], [5, 4], [4, 5]]", 9, 'obstacles[1]: unknown key "polgon"; did you mean "polygon"?'),
    (
        "circle = { center = [5, 5] }",
        9,
        "obstacles[1]: circle must be { center = [x, y], radius = r } in m (got { center = [5, 5] })",
    ),
    ("circle = { center = [5, 5], radius = 0 }", 9, "obstacles[1]: the radius must be > 0 m (got 0)"),
    (
        "circle = { center = [5, 5], radius = 1 }\nangle = 1",
        10,
        "obstacles[1]: angle belongs to a rectangle (this is a circle)",
    ),
    (
        "rectangle = [4, 4, 3, 5]",
        9,
        "obstacles[1]: a rectangle is [xmin, ymin, xmax, ymax] with xmin < xmax and ymin < ymax "
        "(got [4.0, 4.0, 3.0, 5.0])",
    ),
    (
        "rectangle = [4, 4, 5]",
        9,
        "obstacles[1]: rectangle must be [xmin, ymin, xmax, ymax], four numbers in m (got [4, 4, 5])",
    ),
    ("rectangle = [4, 4, 5, 6]\nangle = inf", 10, "obstacles[1]: angle must be finite (got inf)"),
    ("polygon = [[4, 4], [5, 4]]", 9, "obstacles[1]: a polygon needs at least 3 vertices (got 2)"),
    ("polygon = [[4, 4], [5, 5], [6, 6]]", 9, "obstacles[1]: a polygon must enclose an area > 0 m2 (got 0)"),
    (
        "polygon = [[4, 4], [6, 6], [6, 4], [4, 5]]",
        9,
        "obstacles[1]: the outline crosses or touches itself at (4.66667, 4.66667); an outline must be simple",
    ),
    (
        "polygon = [[4, 4], [5, 4], [4, 5], [4, 4]]",
        9,
        "obstacles[1]: vertices 4 and 1 are the same point (4, 4); leave one of them out",
    ),
    (
        "polygon = [\n  [4, 4],\n  [5, 4],\n  [4, nan], # here\n]",
        12,
        "obstacles[1]: polygon must be finite (got nan as item 3)",
    ),
    (
        "polygon = [[4, 4], [5], [4, 5]]",
        9,
        "obstacles[1]: polygon must be a list of points [x, y] in m (got [5] as item 2)",
    ),
]


@pytest.mark.parametrize(("lines", "line", "fault"), OBSTACLES, ids=[lines for lines, _, _ in OBSTACLES])
def test_a_faulty_obstacle_is_told(faults_of, lines, line, fault):
    """One thing wrong with an obstacle is one fault, on the line of the value where there is one."""
    assert faults_of(f"{HEAD}{ROBOT}[[obstacles]]\n{lines}\n") == [f"problem.toml:{line}: {fault}"]


TOPS = [
    (
        'format = "coord-problem/2"\n[workspace]\nbounds = [0, 0, 10, 10]\n',
        1,
        'format must be "coord-problem/1" (got "coord-problem/2")',
    ),
    (
        "[workspace]\nbounds = [0, 0, 10, 10]\n",
        1,
        'format is missing; the file should begin with format = "coord-problem/1"',
    ),
    (HEAD.replace("[w", "nmae = 1\n[w"), 2, 'unknown key "nmae"; did you mean "name"?'),
    (HEAD.replace("[w", "clearance = 1\n[w"), 2, 'unknown key "clearance"; it belongs in [workspace]'),
    (HEAD.replace("[w", 'robots_file = "r.csv"\n[w'), 2, 'the robots file "r.csv" does not exist'),
    (HEAD.replace("[w", 'robots_file = "."\n[w'), 2, 'the robots file "." is not a regular file'),
    (HEAD.replace("[w", "robots_file = 1\n[w"), 2, "robots_file must be the name of a CSV file (got 1)"),
    (HEAD.replace("[w", "plan = 1\n[w"), 2, "[plan]: plan must be one table, written [plan] (got 1)"),
    (HEAD + "[plan]\nsead = 1\n", 5, '[plan]: unknown key "sead"; did you mean "seed"?'),
    (HEAD + "[plan]\nseed = 1.5\n", 5, "[plan]: seed must be a whole number (got 1.5)"),
    (HEAD + "[plan]\nplots = 1\n", 5, "[plan]: plots must be true or false (got 1)"),
    (HEAD + "[plan]\ntime_limit = '1'\n", 5, '[plan]: time_limit must be a number in s (got "1")'),
]


@pytest.mark.parametrize(("head", "line", "fault"), TOPS)
def test_a_fault_at_the_top_is_told(faults_of, head, line, fault):
    """Faults of the file as a whole and of its options stand for themselves."""
    assert faults_of(head + ROBOT) == [f"problem.toml:{line}: {fault}"]


WORKSPACES = [
    ("", 2, "bounds = [xmin, ymin, xmax, ymax] are missing; only with a map they may be left out"),
    (
        "bounds = [0, 0, 10, 0]",
        3,
        "bounds are [xmin, ymin, xmax, ymax], finite, xmin < xmax and ymin < ymax (got [0.0, 0.0, 10.0, 0.0])",
    ),
    ("bounds = [0, 0, 10]", 3, "bounds must be [xmin, ymin, xmax, ymax], four numbers in m (got [0, 0, 10])"),
    ("bounds = [0, 0, inf, 10]", 3, "bounds must be finite (got [0, 0, inf, 10])"),
    (
        "bounds = [0, 0, 2e6, 10]",
        3,
        "coordinates must stay within 1e+06 m (got [0.0, 0.0, 2000000.0, 10.0]); move the origin nearer",
    ),
    ("bounds = [0, 0, 10, 10]\nclearance = -0.1", 4, "clearance must be >= 0 m (got -0.1)"),
    ('bounds = [0, 0, 10, 10]\nafter_arrival = "go"', 4, 'after_arrival must be "stay" or "leave" (got "go")'),
    (
        "bounds = [0, 0, 10, 10]\nresolution = 1",
        4,
        "resolution belongs to a map that is a MovingAI map (.map) or an image (this is no map)",
    ),
    (
        "bounds = [0, 0, 10, 10]\noccupied_below = 0.5",
        4,
        "occupied_below belongs to a map that is an image (this is no map)",
    ),
    ('map = "arena.map"', 3, 'the map "arena.map" does not exist'),
    ('map = "floor.png"', 3, "a map that is an image needs resolution, the side of a cell in m"),
    ('map = "floor.yaml"', 3, 'the map "floor.yaml" does not exist'),
    ('map = "floor.yaml"\nunknown = "maybe"', 4, 'unknown must be "occupied" or "free" (got "maybe")'),
    ("bound = [0, 0, 10, 10]", 3, 'unknown key "bound"; did you mean "bounds"?'),
]


@pytest.mark.parametrize(("lines", "line", "fault"), WORKSPACES, ids=[lines for lines, _, _ in WORKSPACES])
def test_a_faulty_workspace_is_told(faults_of, lines, line, fault):
    """What is wrong with the workspace is told of [workspace], on the line of the value."""
    text = f'format = "coord-problem/1"\n[workspace]\n{lines}\n{ROBOT}'
    assert f"problem.toml:{line}: [workspace]: {fault}" in faults_of(text)


SHAPES = [
    (
        "[robots]\nname = 'a'\n",
        4,
        'robots must be a list of tables, each written [[robots]] with two brackets (got { name = "a" })',
    ),
    ("", 1, "a problem needs at least one robot, a table [[robots]] with name, start and goal"),
    (
        f"{ROBOT}[obstacles]\n",
        8,
        "obstacles must be a list of tables, each written [[obstacles]] with two brackets (got {})",
    ),
]


@pytest.mark.parametrize(("rest", "line", "fault"), SHAPES)
def test_a_table_of_the_wrong_kind_is_told(faults_of, rest, line, fault):
    """One bracket instead of two, or no robots at all, is told in those words."""
    assert faults_of(HEAD + rest) == [f"problem.toml:{line}: {fault}"]


def test_two_workspaces_are_told_once(faults_of):
    """A second [workspace] is TOML's own fault; a list of them is ours, and bounds are not missed as well."""
    text = HEAD.replace("[workspace]", "[[workspace]]") + ROBOT
    (fault,) = faults_of(text)
    assert fault.startswith(
        "problem.toml:2: [workspace]: workspace must be one table, written [workspace] (got [{ bounds"
    )


def test_names_are_shown_on_one_line(faults_of):
    """A name with a line break in it cannot break the list of faults."""
    text = HEAD + ROBOT.replace('"a"', '"a\\n\\u0007b"') + "speed = 0\n"
    assert faults_of(text) == ['problem.toml:8: robots[1] "a\\n\\x07b": speed must be > 0 m/s (got 0)']


def test_a_robot_that_accepts_any_side_and_a_fixed_heading_is_read(read):
    """The plain values of fields whose other values are not built yet are accepted."""
    floor = 'after_arrival = "stay"\n'
    text = f'{HEAD}{floor}{ROBOT}side = "quickest"\nheading = "fixed"\ncorner_radius = 0\n'
    assert read(text).robots[0].name == "a"
