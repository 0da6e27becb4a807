"""From the bytes of a plan file, coord-plan/1, to records."""

from __future__ import annotations

from typing import Any

from coord.verify import form
from coord.verify.form import MalformedError
from coord.verify.records import Circle, Figures, Limits, Plan, Point, Polygon, Robot
from coord.verify.report import Findings, who
from coord.verify.shapes import Body, disc, polygon, polygon_fault

FORMAT = "coord-plan/1"

_DOCUMENT = frozenset({"format", "problem", "workspace", "obstacles", "robots", "order", "blocking", "result"})
_PROBLEM = frozenset({"name", "digest"})
_WORKSPACE = frozenset({"bounds", "clearance", "after_arrival"})
_POLYGON = frozenset({"name", "polygon", "holes"})
_CIRCLE = frozenset({"name", "circle"})
_ROBOT = frozenset(
    {"name", "footprint", "heading", "limits", "start", "goal", "release", "priority", "path", "profile"}
    | {"arrival", "solo_arrival", "solo_bound", "lower_bound", "after", "before", "how"}
)
_LIMITS = frozenset(Limits.__slots__)
_PATH = frozenset({"start", "pieces"})
_PROFILE = frozenset({"times", "states", "jerks"})
_RESULT = frozenset(Figures.__slots__)


def read(data: bytes, findings: Findings) -> Plan | None:
    """The plan in some bytes; None, and the reasons added to the findings, if they are no plan file."""
    try:
        document = form.decode(data)
        if isinstance(document, dict) and document.get("format") != FORMAT:
            raise MalformedError(f'the file must say "format": "{FORMAT}"')
        whole = form.table(document, "the plan", _DOCUMENT)
        robots = _robots(form.array(whole["robots"], "robots"), findings)
        plan = _plan(whole, robots)
    except MalformedError as error:
        findings.add("malformed", str(error))
        return None
    return None if findings.found else plan


def _plan(whole: form.Table, robots: tuple[Robot, ...]) -> Plan:
    problem = form.table(whole["problem"], "problem", _PROBLEM)
    form.text(problem["name"], "the problem's name")
    form.text(problem["digest"], "the problem's digest")
    workspace = form.table(whole["workspace"], "workspace", _WORKSPACE)
    xmin, ymin, xmax, ymax = form.numbers(workspace["bounds"], "the workspace's bounds", 4)
    if not (xmin < xmax and ymin < ymax):
        raise MalformedError("the workspace's bounds are xmin, ymin, xmax, ymax with xmin < xmax and ymin < ymax")
    return Plan(
        bounds=(xmin, ymin, xmax, ymax),
        clearance=form.number(workspace["clearance"], "the clearance", 0.0),
        leave=form.choice(workspace["after_arrival"], "after_arrival", ("stay", "leave")) == "leave",
        obstacles=tuple(_obstacle(item, k) for k, item in enumerate(form.array(whole["obstacles"], "obstacles"))),
        robots=robots,
        order=form.texts(whole["order"], "order"),
        blocking=tuple(_blocking(item) for item in form.array(whole["blocking"], "blocking")),
        figures=_result(whole["result"]),
    )


def _result(value: object) -> Figures:
    result = form.table(value, "result", _RESULT)
    return Figures(
        sum_of_arrivals=form.number(result["sum_of_arrivals"], "the result's sum_of_arrivals"),
        makespan=form.number(result["makespan"], "the result's makespan"),
        lower_bound=form.number(result["lower_bound"], "the result's lower_bound"),
        lower_bound_by=form.text(result["lower_bound_by"], "the result's lower_bound_by"),
        optimality_gap=form.number(result["optimality_gap"], "the result's optimality_gap"),
    )


def _blocking(value: object) -> tuple[str, str, str]:
    names = form.texts(value, "a blocking arc")
    if len(names) != 3 or names[2] not in ("start", "goal"):
        raise MalformedError('a blocking arc must be [first, then, "start" or "goal"]')
    return names[0], names[1], names[2]


def _obstacle(value: object, k: int) -> Circle | Polygon:
    where = f"obstacles[{k}]"
    if isinstance(value, dict) and "circle" in value:
        item = form.table(value, where, _CIRCLE)
        name = form.text(item["name"], f"{where}: the name")
        circle = form.table(item["circle"], f"{where}: the circle", frozenset({"center", "radius"}))
        center = _point(circle["center"], f"{where}: the center")
        return Circle(name, center, form.positive(circle["radius"], f"{where}: the radius"))
    item = form.table(value, where, _POLYGON)
    holes = form.array(item["holes"], f"{where}: holes")
    rings = [_ring(ring, f"{where}: ring {n}", n == 0) for n, ring in enumerate([item["polygon"], *holes])]
    return Polygon(form.text(item["name"], f"{where}: the name"), tuple(rings))


def _ring(value: object, where: str, outline: bool) -> tuple[Point, ...]:
    ring = tuple([(x, y) for x, y in form.rows(value, where, 2)])
    if len(ring) < 3:
        raise MalformedError(f"{where} needs three corners or more")
    (ox, oy), area = ring[0], 0.0
    for (ax, ay), (bx, by) in zip(ring, (*ring[1:], ring[0]), strict=True):
        area += (ax - ox) * (by - oy) - (ay - oy) * (bx - ox)
    if area == 0.0 or (area > 0.0) != outline:
        raise MalformedError(f"{where} must run {'counter-clockwise' if outline else 'clockwise, being a hole'}")
    return ring


def _robots(values: list[Any], findings: Findings) -> tuple[Robot, ...]:
    """All robots; those out of form are left out and reported."""
    if not values:
        raise MalformedError("a plan needs one robot or more")
    robots: list[Robot] = []
    for k, value in enumerate(values):
        try:
            robots.append(_robot(value, f"robots[{k}]"))
        except MalformedError as error:
            findings.add("malformed", str(error))
    seen: set[str] = set()
    for robot in robots:
        if robot.name in seen:
            findings.add("malformed", f"two robots are called {who(robot.name)}; names must differ", [robot.name])
        seen.add(robot.name)
    return tuple(robots)


def _robot(value: object, where: str) -> Robot:
    item = form.table(value, where, _ROBOT)
    name = form.text(item["name"], f"{where}: the name")
    if not name:
        raise MalformedError(f"{where}: the name must not be empty")
    where = f"{where} {who(name)}"
    turning = form.choice(item["heading"], f"{where}: heading", ("fixed", "path")) == "path"
    limits = form.table(item["limits"], f"{where}: limits", _LIMITS)
    path = form.table(item["path"], f"{where}: path", _PATH)
    if item["priority"] is not None:
        form.number(item["priority"], f"{where}: priority")
    form.text(item["how"], f"{where}: how")
    pose = form.numbers(path["start"], f"{where}: the path's start", 3)
    times, states, jerks = _profile(item["profile"], where)
    figures = [form.number(item[key], f"{where}: {key}") for key in _FIGURES]
    return Robot(
        name=name,
        body=_footprint(item["footprint"], where, turning),
        limits=Limits(*(form.positive(limits[key], f"{where}: {key}") for key in Limits.__slots__)),
        start=_point(item["start"], f"{where}: start"),
        goal=_point(item["goal"], f"{where}: goal"),
        release=form.number(item["release"], f"{where}: release", 0.0),
        pose=(pose[0], pose[1], pose[2]),
        pieces=_pieces(path["pieces"], where),
        times=times,
        states=states,
        jerks=jerks,
        arrival=figures[0],
        solo_arrival=figures[1],
        solo_bound=figures[2],
        lower_bound=figures[3],
        after=form.texts(item["after"], f"{where}: after"),
        before=form.texts(item["before"], f"{where}: before"),
    )


_FIGURES = ("arrival", "solo_arrival", "solo_bound", "lower_bound")


def _pieces(value: object, where: str) -> tuple[tuple[float, ...], ...]:
    pieces = form.rows(value, f"{where}: the path's pieces", 3)
    for k, piece in enumerate(pieces):
        if not piece[0] > 0.0:
            raise MalformedError(f"{where}: piece {k} of the path must be longer than 0 m (got {piece[0]:g})")
    return pieces


def _profile(value: object, where: str) -> tuple[tuple[float, ...], tuple[tuple[float, ...], ...], tuple[float, ...]]:
    profile = form.table(value, f"{where}: profile", _PROFILE)
    times = form.numbers(profile["times"], f"{where}: the profile's times")
    states = form.rows(profile["states"], f"{where}: the profile's states", 3)
    jerks = form.numbers(profile["jerks"], f"{where}: the profile's jerks")
    if not len(times) == len(states) == len(jerks) + 1:
        counts = f"{len(times)} times, {len(states)} states and {len(jerks)} jerks"
        raise MalformedError(f"{where}: the profile must have K+1 times, K+1 states and K jerks (got {counts})")
    return times, states, jerks


def _footprint(value: object, where: str, turning: bool) -> Body:
    where = f"{where}: footprint"
    if not isinstance(value, dict) or len(value) != 1:
        raise MalformedError(f'{where} must be {{"disc": radius}}, {{"square": side}} or {{"polygon": corners}}')
    (kind, size) = next(iter(value.items()))
    if kind == "disc":
        return disc(form.positive(size, f"{where}: the disc's radius"))
    if kind == "square":
        half = form.positive(size, f"{where}: the square's side") / 2
        return polygon([(-half, -half), (half, -half), (half, half), (-half, half)], turning)
    if kind == "polygon":
        corners = [(x, y) for x, y in form.rows(size, f"{where}: corners", 2)]
        fault = polygon_fault(corners)
        if fault:
            raise MalformedError(f"{where}: the polygon {fault}")
        return polygon(corners, turning)
    raise MalformedError(f"{where} {who(kind)} is not known")


def _point(value: object, where: str) -> Point:
    x, y = form.numbers(value, where, 2)
    return x, y
