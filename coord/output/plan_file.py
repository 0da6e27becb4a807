"""The plan file, format ``coord-plan/1``: the bytes that the checker reads and that other programs rely on."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Final, NoReturn

from coord.errors import BadFileError, Fault
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Obstacle
from coord.model.result import Plan, RobotPlan

FORMAT: Final = "coord-plan/1"


def serialise(plan: Plan) -> bytes:
    """Write a plan as the bytes of ``plan.json``.

    The same plan gives the same bytes: keys in a fixed order, floats by ``repr``, which reads back exactly,
    and no wall times. One field of a robot is one line, so that the file can be read and compared by eye.

    Raises
    ------
    ValueError
        When a number is not finite: a plan with such a number is a defect, and JSON has no word for it.
    """
    problem, workspace = plan.problem, plan.problem.workspace
    fields = {
        "format": _json(FORMAT),
        "problem": _json({"name": problem.name, "digest": problem.digest}),
        "workspace": _json(
            {
                "bounds": _floats(workspace.bounds),
                "clearance": float(workspace.clearance),
                "after_arrival": workspace.after_arrival,
            }
        ),
        "obstacles": _lines(_json(_obstacle(obstacle)) for obstacle in problem.obstacles),
        "robots": _lines(_robot(robot) for robot in plan.robots),
        "order": _json(list(plan.order)),
        "blocking": _json([[arc.first, arc.then, arc.at] for arc in plan.blocking]),
        "result": _json(
            {
                "sum_of_arrivals": float(plan.sum_of_arrivals),
                "makespan": float(plan.makespan),
                "lower_bound": float(plan.lower_bound),
                "lower_bound_by": plan.lower_bound_by,
                "optimality_gap": float(plan.optimality_gap),
            }
        ),
    }
    body = ",\n".join(f'"{key}": {value}' for key, value in fields.items())
    return f"{{\n{body}\n}}\n".encode()


def parse(data: bytes, file: str = "plan.json") -> Plan:
    """Read the bytes of a plan file back into a plan; ``file`` is the name used in faults.

    The form of the file is checked, not what it promises: whether a plan keeps its limits and distances
    is for ``coord.verify`` to say.

    Raises
    ------
    BadFileError
        With all faults at once, when the bytes are not a well-formed plan file.
    """
    from coord.output.plan_form import plan_of  # pydantic is slow to import and only reading needs it

    try:
        document = json.loads(data.decode(), object_pairs_hook=_unique, parse_constant=_refuse_constant)
    except UnicodeDecodeError as error:
        raise BadFileError([Fault(file, None, "", f"not UTF-8 text: {error.reason} at byte {error.start}")]) from error
    except json.JSONDecodeError as error:
        raise BadFileError([Fault(file, error.lineno, "", f"not JSON: {error.msg}")]) from error
    except RecursionError as error:
        raise BadFileError([Fault(file, None, "", "nested too deeply for a plan file")]) from error
    except ValueError as error:
        raise BadFileError([Fault(file, None, "", str(error))]) from error
    return plan_of(document, file)


def _robot(robot: RobotPlan) -> str:
    limits, path, profile = robot.robot.limits, robot.path, robot.profile
    priority = robot.robot.priority
    fields: dict[str, object] = {
        "name": robot.robot.name,
        "footprint": footprint_words(robot.robot.footprint),
        "heading": robot.robot.footprint.heading if robot.robot.footprint.vertices else "fixed",
        "limits": {
            "speed": float(limits.speed),
            "acceleration": float(limits.acceleration),
            "deceleration": float(limits.deceleration),
            "jerk": float(limits.jerk),
            "lateral_acceleration": float(limits.lateral_acceleration),
        },
        "start": _floats(robot.robot.start),
        "goal": _floats(robot.robot.goal),
        "release": float(robot.robot.release),
        "priority": None if priority is None else float(priority),
        "path": {"start": _floats(path.start), "pieces": path.pieces.tolist()},
        "profile": {
            "times": profile.times.tolist(),
            "states": profile.states.tolist(),
            "jerks": profile.jerks.tolist(),
        },
        "arrival": float(robot.arrival),
        "solo_arrival": float(robot.solo_arrival),
        "solo_bound": float(robot.solo_bound),
        "lower_bound": float(robot.lower_bound),
        "after": list(robot.after),
        "before": list(robot.before),
        "how": robot.how,
    }
    return "{" + ",\n  ".join(f'"{key}": {_json(value)}' for key, value in fields.items()) + "}"


def footprint_words(footprint: Footprint) -> dict[str, object]:
    """A footprint as plan and problem files write it: {"disc": radius}, {"square": side} or {"polygon": corners}.

    Only a square that ``coord.model.footprint.square`` would make is written as one; any other is a polygon, so
    that what is read back is the same to the last bit.
    """
    if not footprint.vertices:
        return {"disc": float(footprint.radius)}
    half = float(footprint.vertices[2][0])
    if half > 0 and footprint.vertices == ((-half, -half), (half, -half), (half, half), (-half, half)):
        return {"square": 2 * half}
    return {"polygon": [_floats(vertex) for vertex in footprint.vertices]}


def _obstacle(obstacle: Obstacle) -> Mapping[str, object]:
    if isinstance(obstacle, Circle):
        circle = {"center": _floats(obstacle.center), "radius": float(obstacle.radius)}
        return {"name": obstacle.name, "circle": circle}
    holes = [hole.tolist() for hole in obstacle.holes]
    return {"name": obstacle.name, "polygon": obstacle.vertices.tolist(), "holes": holes}


def _lines(items: Iterable[str]) -> str:
    text = ",\n ".join(items)
    return f"[\n {text}\n]" if text else "[]"


def _floats(values: Iterable[float]) -> list[float]:
    return [float(value) for value in values]


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def _unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
    """An object of JSON; ``json`` would silently keep the last of two values under one key."""
    result = dict(pairs)
    if len(result) < len(pairs):
        key, count = Counter(key for key, _ in pairs).most_common(1)[0]
        raise ValueError(f'the key "{key}" stands {count} times in one object')
    return result


def _refuse_constant(text: str) -> NoReturn:
    raise ValueError(f"{text} is not a number of JSON; all numbers must be finite")
