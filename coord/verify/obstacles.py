"""Every robot against the floor: obstacles and the edge of the workspace, all along its path.

Time does not matter here: a robot is somewhere on its path at all times.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from coord.verify.approach import approach, inside_edge
from coord.verify.curve import Curve, Piece, point, pose_at
from coord.verify.floor import Floor, Part, holders
from coord.verify.records import Circle, Plan, Point, Polygon, Robot
from coord.verify.report import Findings, at, who
from coord.verify.shapes import inner_point
from coord.verify.tolerances import BOX, DISTANCE

_EDGES = (("left", (-1.0, 0.0)), ("lower", (0.0, -1.0)), ("right", (1.0, 0.0)), ("upper", (0.0, 1.0)))


def check_workspace(robot: Robot, path: Curve, plan: Plan, findings: Findings) -> None:
    """Check that a robot keeps the clearance to the edge of the workspace."""
    xmin, ymin, xmax, ymax = plan.bounds
    for (side, n), level in zip(_EDGES, (-xmin, -ymin, xmax, ymax), strict=True):
        least = inside_edge(path, robot.body, n, level, plan.clearance - DISTANCE)
        words = f"the {side} edge of the workspace"
        if least.at is not None:
            _report(robot, path, "workspace", words, (least.value, least.at), plan.clearance, findings)
        elif least.open is not None:
            _report_open(robot, path, words, least.open, findings)


def check_obstacles(robots: Sequence[Robot], paths: Sequence[Curve], plan: Plan, findings: Findings) -> None:
    """Check that no robot begins inside an obstacle, and that none comes too near to one.

    Both together mean that none is ever inside one: a point inside its footprint would have to pass the edge first.
    """
    starts = [inner_point(robot.body, path.start) for robot, path in zip(robots, paths, strict=True)]
    inside = set()
    for k, number in holders(starts, plan.obstacles):
        inside.add((k, number))
        text = f"robot {who(robots[k].name)} starts inside {_called(plan.obstacles, number)}, at {at(starts[k])}"
        findings.add("obstacle", text, [robots[k].name], starts[k])
    floor = Floor(plan.obstacles)
    if not floor.parts:
        return
    for k, (robot, path) in enumerate(zip(robots, paths, strict=True)):
        if findings.full:
            return
        _check_parts(robot, path, plan, floor, {number for i, number in inside if i == k}, findings)


def _check_parts(robot: Robot, path: Curve, plan: Plan, floor: Floor, reported: set[int], findings: Findings) -> None:
    """One robot against all that is near its path; one finding an obstacle, the worst."""
    worst: dict[int, tuple[float, float]] = {}
    need = plan.clearance - DISTANCE
    for piece, parts in _near(robot, path, plan.clearance, floor):
        for number in parts:
            part = floor.parts[number]
            if part.obstacle in reported or (piece is not None and _clear(piece, robot, part, plan.clearance)):
                continue
            span = (0.0, 0.0) if piece is None else (piece.begin, piece.end)
            value = worst.get(part.obstacle, (need,))[0]
            least = approach(path, robot.body, span, part.ring, part.radius, (need, value))
            if least.at is not None and least.value < value:
                worst[part.obstacle] = (least.value, least.at)
            elif least.open is not None:
                _report_open(robot, path, _called(plan.obstacles, part.obstacle), least.open, findings)
    for number, found in sorted(worst.items(), key=lambda item: item[1][1]):
        _report(robot, path, "obstacle", _called(plan.obstacles, number), found, plan.clearance, findings)


def _near(robot: Robot, path: Curve, clearance: float, floor: Floor) -> list[tuple[Piece | None, list[int]]]:
    """The parts near each piece of a path (or near its only point, then without a piece)."""
    margin = robot.body.reach + clearance + BOX
    if not path.pieces:
        x, y, _ = path.start
        return [(None, sorted(set(floor.near((0, x - margin, y - margin, x + margin, y + margin)))))]
    result: list[tuple[Piece | None, list[int]]] = []
    for piece in path.pieces:
        found: set[int] = set()
        n = max(1, min(math.ceil(piece.length / floor.cell), 10_000))
        step = piece.length / n
        sagitta = 0.0 if piece.straight else step / 2
        x, y = piece.x, piece.y
        for i in range(1, n + 1):
            x1, y1 = point(piece, piece.begin + step * i)
            m = margin + sagitta
            found.update(floor.near((0, min(x, x1) - m, min(y, y1) - m, max(x, x1) + m, max(y, y1) + m)))
            x, y = x1, y1
        if found:
            result.append((piece, sorted(found)))
    return result


def _clear(piece: Piece, robot: Robot, part: Part, clearance: float) -> bool:
    """Whether the disc round a robot, driving along a line, keeps away from a whole part; a quick first look."""
    if not piece.straight:
        return False
    margin = robot.body.reach + clearance + part.radius
    sides, alongs = [], []
    for x, y in part.ring:
        wx, wy = x - piece.x, y - piece.y
        sides.append(piece.cos * wy - piece.sin * wx)
        alongs.append(piece.cos * wx + piece.sin * wy)
    return (
        min(sides) >= margin or max(sides) <= -margin or min(alongs) >= piece.length + margin or max(alongs) <= -margin
    )


def _called(obstacles: Sequence[Circle | Polygon], number: int) -> str:
    name = obstacles[number].name
    return f"obstacle {who(name)}" if name else f"obstacles[{number}]"


def _report(
    robot: Robot,
    path: Curve,
    code: str,
    what: str,
    found: tuple[float, float],
    clearance: float,
    findings: Findings,
) -> None:
    value, s = found
    place: Point = pose_at(path, s)[:2]
    text = f"reaches {-value:.6g} m into" if value < 0.0 else f"comes within {value:.9g} m of"
    text = f"robot {who(robot.name)} {text} {what} near {at(place)}, {s:.6g} m along its path"
    findings.add(code, f"{text}; the clearance is {clearance:g} m", [robot.name], place)


def _report_open(robot: Robot, path: Curve, what: str, s: float, findings: Findings) -> None:
    place = pose_at(path, s)[:2]
    text = f"whether robot {who(robot.name)} keeps the clearance to {what} could not be decided near {at(place)}"
    findings.add("undecided", text, [robot.name], place)
