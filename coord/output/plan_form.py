"""The form of a plan file: which fields there are, of which type, and how they become a plan."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, Strict, ValidationError

from coord.errors import BadFileError, Fault, InvalidValueError
from coord.model.arrays import frozen
from coord.model.footprint import Footprint, polygon, square
from coord.model.obstacle import Circle, Obstacle, Polygon
from coord.model.path import Path
from coord.model.problem import Problem, Workspace
from coord.model.profile import VelocityProfile
from coord.model.result import BlockingArc, Plan, RobotPlan
from coord.model.robot import Limits, Robot


def _float(value: object) -> object:
    """Whole numbers are numbers too; one that no float can hold is none, instead of an OverflowError."""
    if isinstance(value, int) and not isinstance(value, bool):
        return float(value) if abs(value) < 2**1023 else float("inf")
    return value


def _encodable(text: str) -> str:
    if any("\ud800" <= letter <= "\udfff" for letter in text):  # half a character: no file or terminal takes it
        raise ValueError("must be whole Unicode characters")
    return text


Number = Annotated[float, Strict(), Field(allow_inf_nan=False), BeforeValidator(_float)]
Text = Annotated[str, Strict(), AfterValidator(_encodable)]
Pair = tuple[Number, Number]
Triple = tuple[Number, Number, Number]


class _Form(BaseModel):
    model_config = ConfigDict(extra="forbid")


class _Name(_Form):
    name: Text
    digest: Text


class _Workspace(_Form):
    bounds: tuple[Number, Number, Number, Number]
    clearance: Number
    after_arrival: Text


class _Circle(_Form):
    center: Pair
    radius: Number


class _Obstacle(_Form):
    name: Text
    polygon: list[Pair] | None = None
    holes: list[list[Pair]] = []
    circle: _Circle | None = None


class _Footprint(_Form):
    disc: Number | None = None
    square: Number | None = None
    polygon: list[Pair] | None = None


class _Limits(_Form):
    speed: Number
    acceleration: Number
    deceleration: Number
    jerk: Number
    lateral_acceleration: Number


class _Path(_Form):
    start: Triple
    pieces: list[Triple]


class _Profile(_Form):
    times: list[Number]
    states: list[Triple]
    jerks: list[Number]


class _Robot(_Form):
    name: Text
    footprint: _Footprint
    heading: Literal["fixed", "path"]
    limits: _Limits
    start: Pair
    goal: Pair
    release: Number
    priority: Number | None
    path: _Path
    profile: _Profile
    arrival: Number
    solo_arrival: Number
    solo_bound: Number
    lower_bound: Number
    after: list[Text]
    before: list[Text]
    how: Text


class _Result(_Form):
    sum_of_arrivals: Number
    makespan: Number
    lower_bound: Number
    lower_bound_by: Text
    optimality_gap: Number


class _Plan(_Form):
    format: Literal["coord-plan/1"]
    problem: _Name
    workspace: _Workspace
    obstacles: list[_Obstacle]
    robots: list[_Robot]
    order: list[Text]
    blocking: list[tuple[Text, Text, Literal["start", "goal"]]]
    result: _Result


def plan_of(document: object, file: str) -> Plan:
    """Turn the parsed JSON of a plan file into a plan.

    Raises
    ------
    BadFileError
        With all faults at once: fields that are missing, unknown or of the wrong type, values that break
        the rules of the model, and names that no robot has.
    """
    try:
        form = _Plan.model_validate(document)
    except ValidationError as error:
        raise BadFileError([_fault(file, fault["loc"], fault["msg"]) for fault in error.errors()]) from error
    faults = [Fault(file, None, subject, text) for subject, text in _inconsistencies(form)]
    if not form.robots:
        faults.append(Fault(file, None, "robots", "a plan has at least one robot"))
    robots, obstacles, problem = [], [], None
    for k, robot in enumerate(form.robots):
        try:
            robots.append(_robot(robot))
        except InvalidValueError as error:
            faults += [Fault(file, None, f'robots[{k}] "{robot.name}"', text) for _, text in error.faults]
    for k, obstacle in enumerate(form.obstacles):
        try:
            obstacles.append(_obstacle(obstacle))
        except InvalidValueError as error:
            faults += [Fault(file, None, f'obstacles[{k}] "{obstacle.name}"', text) for _, text in error.faults]
    try:
        problem = _problem(form, robots, obstacles)
    except InvalidValueError as error:
        faults += [Fault(file, None, name, text) for name, text in error.faults if robots or name != "robots"]
    if faults or problem is None:
        raise BadFileError(faults)
    blocking = tuple(BlockingArc(first, then, at) for first, then, at in form.blocking)
    result = form.result
    return Plan(problem, tuple(robots), tuple(form.order), blocking, result.lower_bound, result.lower_bound_by)


def _problem(form: _Plan, robots: list[RobotPlan], obstacles: list[Obstacle]) -> Problem:
    workspace = Workspace(form.workspace.bounds, form.workspace.clearance, form.workspace.after_arrival)
    return Problem(
        name=form.problem.name,
        workspace=workspace,
        robots=tuple(robot.robot for robot in robots),
        obstacles=tuple(obstacles),
        digest=form.problem.digest,
    )


def _robot(form: _Robot) -> RobotPlan:
    robot = Robot(
        name=form.name,
        footprint=_footprint(form.footprint, form.heading),
        limits=Limits(**dict(form.limits)),
        start=form.start,
        goal=form.goal,
        priority=form.priority,
        release=form.release,
    )
    profile = form.profile
    pieces = [piece for piece in form.path.pieces if piece[0] > 0]  # of others there is a fault already
    return RobotPlan(
        robot=robot,
        path=Path(form.path.start, frozen(pieces, 3)),
        profile=VelocityProfile(frozen(profile.times), frozen(profile.states, 3), frozen(profile.jerks)),
        solo_arrival=form.solo_arrival,
        solo_bound=form.solo_bound,
        lower_bound=form.lower_bound,
        after=tuple(form.after),
        before=tuple(form.before),
        how=form.how,
    )


def _footprint(form: _Footprint, heading: str) -> Footprint:
    given = [(kind, size) for kind, size in form if size is not None]
    if len(given) != 1:
        got = " and ".join(kind for kind, _ in given) or "none"
        raise InvalidValueError([("footprint", f'a footprint is one of "disc", "square", "polygon" (got {got})')])
    ((kind, size),) = given
    if kind == "disc":
        return Footprint(size)  # turning changes nothing about a disc
    return square(size, heading) if kind == "square" else polygon(size, heading)


def _obstacle(form: _Obstacle) -> Obstacle:
    if form.circle is not None and form.polygon is None and not form.holes:
        return Circle(form.name, form.circle.center, form.circle.radius)
    if form.polygon is not None and form.circle is None:
        return Polygon(form.name, frozen(form.polygon, 2), tuple(frozen(hole, 2) for hole in form.holes))
    raise InvalidValueError([("polygon", 'an obstacle is either a "polygon" (with "holes") or a "circle"')])


def _inconsistencies(form: _Plan) -> Iterable[tuple[str, str]]:
    """What the types alone cannot say: lengths that must agree, numbers that must grow, names that must exist."""
    names = [robot.name for robot in form.robots]
    for k, robot in enumerate(form.robots):
        subject, profile = f'robots[{k}] "{robot.name}"', robot.profile
        knots = len(profile.times)
        if not knots or len(profile.states) != knots or len(profile.jerks) != knots - 1:
            counts = f"{knots} times, {len(profile.states)} states and {len(profile.jerks)} jerks"
            yield subject, f"a profile has K + 1 times, K + 1 states and K jerks (got {counts})"
        elif any(later <= earlier for earlier, later in zip(profile.times, profile.times[1:], strict=False)):
            yield subject, "the times of a profile must increase"
        elif profile.times[-1] != robot.arrival:
            yield subject, f"arrival must be the profile's last time {profile.times[-1]!r} s (got {robot.arrival!r} s)"
        if any(length <= 0 for length, _, _ in robot.path.pieces):
            yield subject, "all pieces of a path must be longer than 0 m"
        for other in sorted({*robot.after, *robot.before} - set(names)):
            yield subject, f'no robot is named "{other}"'
    if sorted(form.order) != sorted(names):
        yield "order", "must name every robot exactly once"
    for first, then, _ in form.blocking:
        for other in sorted({first, then} - set(names)):
            yield "blocking", f'no robot is named "{other}"'


def _fault(file: str, location: tuple[int | str, ...], message: str) -> Fault:
    subject = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in location).lstrip(".")
    return Fault(file, None, subject, message[:1].lower() + message[1:])
