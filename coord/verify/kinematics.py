"""Whether a velocity profile is one, and keeps the limits of its robot at all times."""

from __future__ import annotations

import math

from coord.verify.bisection import Bound, descend
from coord.verify.curve import Curve, Piece, point, pose_at
from coord.verify.motion import Motion, Stretch, acceleration, arc_length, speed
from coord.verify.records import Point, Robot
from coord.verify.report import Findings, at, who
from coord.verify.tolerances import ACCELERATION, LARGEST_TIME, POSITION, RELATIVE, SPEED, TIME


def check_profile(robot: Robot, path: Curve, findings: Findings) -> bool:
    """Check that the states belong together and lead from rest at the start to rest at the end of the path.

    Returns whether the profile says at every time where the robot is; if not, nothing more can be checked of it.
    """
    faults = _faults_of_chain(robot, path)
    for fault in faults[:3]:
        findings.add("profile", f"robot {who(robot.name)}: {fault}", [robot.name])
    if robot.times[0] < robot.release - TIME:
        text = f"departs at t = {robot.times[0]:.9g} s, before its release at {robot.release:.9g} s"
        findings.add("release", f"robot {who(robot.name)} {text}", [robot.name], robot.start, robot.times[0])
    if not abs(robot.arrival - robot.times[-1]) <= TIME:
        text = f"is said to arrive at t = {robot.arrival:.12g} s, but its profile ends at {robot.times[-1]:.12g} s"
        findings.add("arrival", f"robot {who(robot.name)} {text}", [robot.name], robot.goal, robot.arrival)
    return not faults


def _faults_of_chain(robot: Robot, path: Curve) -> list[str]:
    times, states = robot.times, robot.states
    faults = []
    if not 0.0 <= times[0] <= times[-1] <= LARGEST_TIME:
        faults.append(f"the times of its profile must lie between 0 and {LARGEST_TIME:g} s")
    for k, (state, length) in enumerate(((states[0], 0.0), (states[-1], path.length))):
        s, v, a = state
        if not (abs(s - length) <= POSITION + path.slack and abs(v) <= SPEED and abs(a) <= ACCELERATION):
            words = f"its profile must {'begin' if k == 0 else 'end'} at rest at s = {length:.12g} m"
            faults.append(f"{words} (got s = {s:.12g} m, v = {v:.12g} m/s, a = {a:.12g} m/s2)")
    if robot.jerks and not path.pieces:
        faults.append("its path has no length, so its profile must have no phases")
    highest = 0.0
    for k, j in enumerate(robot.jerks):
        h = times[k + 1] - times[k]
        s, v, a = states[k]
        highest = max(highest, s)
        if not h > 0.0:
            faults.append(
                f"the times of its profile must increase (t = {times[k + 1]:.12g} s follows {times[k]:.12g} s)"
            )
            continue
        s1, v1, a1 = states[k + 1]
        ds, dv, da = s + h * (v + h * (a / 2 + h * j / 6)) - s1, v + h * (a + h * j / 2) - v1, a + h * j - a1
        if not (abs(ds) <= POSITION and abs(dv) <= SPEED and abs(da) <= ACCELERATION):
            text = f"the state at its knot {k + 1}, t = {times[k + 1]:.9g} s, does not follow from the one before"
            faults.append(f"{text} (it is off by {ds:.3g} m, {dv:.3g} m/s, {da:.3g} m/s2)")
        slowest = min(v, v + h * (a + h * j / 2), _at_turn(v, a, j, h))
        if not (-slowest * h <= POSITION and s1 >= highest - POSITION):
            text = f"drives backwards between t = {times[k]:.9g} s and {times[k + 1]:.9g} s"
            faults.append(f"it {text} (speed {slowest:.9g} m/s); speeds must be >= 0")
    return faults


def _at_turn(v: float, a: float, j: float, h: float) -> float:
    """The speed [m/s] where the acceleration passes through 0 within a phase of h seconds; v if it does not."""
    return v - a * a / (2 * j) if a * (a + j * h) < 0.0 else v


def check_limits(robot: Robot, path: Curve, findings: Findings) -> None:
    """Check speed, acceleration, deceleration and jerk of a profile at all times, by their exact extremes."""
    limits = robot.limits
    for k, j in enumerate(robot.jerks):
        h = robot.times[k + 1] - robot.times[k]
        _, v, a = robot.states[k]
        last, speeds = a + h * j, (v, v + h * (a + h * j / 2), _at_turn(v, a, j, h))
        extremes = (
            ("speed", "m/s", max(speeds), limits.speed),
            ("acceleration", "m/s2", max(a, last), limits.acceleration),
            ("deceleration", "m/s2", -min(a, last), limits.deceleration),
            ("jerk", "m/s3", abs(j), limits.jerk),
        )
        faults = [
            (name, f"{name} {value:.9g} {unit} is above the limit of {limit:.9g} {unit}")
            for name, unit, value, limit in extremes
            if not value <= limit * (1 + RELATIVE)
        ]
        if not min(speeds) >= -SPEED:
            faults.append(("speed", f"speed {min(speeds):.9g} m/s is below 0: it drives backwards"))
        when = f"between t = {robot.times[k]:.6g} s and {robot.times[k + 1]:.6g} s"
        for name, text in faults:
            place = pose_at(path, robot.states[k][0])[:2]
            findings.add(name, f"robot {who(robot.name)}: {text}, {when}", [robot.name], place, robot.times[k])
        if faults:
            return


def check_lateral(robot: Robot, whole: Motion, findings: Findings) -> None:
    """Check speed^2 |curvature| at all times, on both sides of every jump of the curvature.

    Within a stretch it is a polynomial of degree 7 in time; its Bernstein coefficients enclose it.
    """
    limit = robot.limits.lateral_acceleration
    for stretch in whole.stretches:
        piece = whole.path.pieces[stretch.piece]
        if piece.straight:
            continue
        if _largest_speed(stretch) ** 2 * _largest_curvature(piece) <= limit:
            continue
        least = descend(_spare(stretch, piece, limit), stretch.begin, stretch.end, -RELATIVE, -RELATIVE)
        if least.at is not None:
            place = point(piece, arc_length(stretch, least.at))
            text = f"lateral acceleration {(1 - least.value) * limit:.9g} m/s2 is above the limit of {limit:.9g} m/s2"
            _report(robot, "lateral_acceleration", text, place, least.at, findings)
            return
        if least.open is not None:
            place = point(piece, arc_length(stretch, least.open))
            _report(robot, "undecided", "lateral acceleration could not be decided", place, least.open, findings)
            return


def _report(robot: Robot, code: str, text: str, place: Point, time: float, findings: Findings) -> None:
    where = f"at t = {time:.9g} s near {at(place)}"
    findings.add(code, f"robot {who(robot.name)}: {text}, {where}", [robot.name], place, time)


def _largest_speed(stretch: Stretch) -> float:
    h0, h1 = stretch.begin - stretch.knot, stretch.end - stretch.knot
    a0 = stretch.a + h0 * stretch.j
    v0 = speed(stretch, stretch.begin)
    return max(abs(v0), abs(speed(stretch, stretch.end)), abs(_at_turn(v0, a0, stretch.j, h1 - h0)))


def _largest_curvature(piece: Piece) -> float:
    return max(abs(piece.curvature), abs(piece.curvature + piece.rate * piece.length))


def _spare(stretch: Stretch, piece: Piece, limit: float) -> Bound:
    """Bounds of 1 - v^2 |k| / limit between two times."""

    def bound(t0: float, t1: float) -> tuple[float, float, float]:
        h = t1 - t0
        middle = (t0 + t1) / 2
        v = _coefficients(speed(stretch, t0), speed(stretch, t1), h * acceleration(stretch, t0))
        squares = _product(v, v, _BY_2_2)
        s0, s1 = arc_length(stretch, t0), arc_length(stretch, t1)
        inner = (s0 + h * speed(stretch, t0) / 3, s1 - h * speed(stretch, t1) / 3)
        k = [piece.curvature + piece.rate * (s - piece.begin) for s in (s0, *inner, s1)]
        largest = max(map(abs, _product(squares, k, _BY_4_3)))
        here = piece.curvature + piece.rate * (arc_length(stretch, middle) - piece.begin)
        return 1 - largest / limit, 1 - speed(stretch, middle) ** 2 * abs(here) / limit, middle

    return bound


def _coefficients(first: float, last: float, rise: float) -> list[float]:
    """Bernstein coefficients of a quadratic on [0, 1] with these end values and this slope at 0."""
    return [first, first + rise / 2, last]


def _weights(m: int, n: int) -> list[tuple[int, int, int, float]]:
    """(i, l, i + l, C(m, i) C(n, l) / C(m + n, i + l)): the product rule of Bernstein coefficients."""
    pairs = [(i, q) for i in range(m + 1) for q in range(n + 1)]
    return [(i, q, i + q, math.comb(m, i) * math.comb(n, q) / math.comb(m + n, i + q)) for i, q in pairs]


_BY_2_2 = _weights(2, 2)
_BY_4_3 = _weights(4, 3)


def _product(f: list[float], g: list[float], weights: list[tuple[int, int, int, float]]) -> list[float]:
    result = [0.0] * (len(f) + len(g) - 1)
    for i, q, n, weight in weights:
        result[n] += weight * f[i] * g[q]
    return result
