"""A small builder of plan files, with jerk-limited profiles of its own; nothing of the planner is used."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

import pytest

Json = dict[str, Any]

LIMITS = {"speed": 1.0, "acceleration": 0.5, "deceleration": 0.4, "jerk": 1.0, "lateral_acceleration": 0.5}


def ramp(speed: float, acceleration: float, jerk: float) -> list[tuple[float, float]]:
    """(duration, jerk) of the phases from rest to a speed, ending without acceleration."""
    rise = min(acceleration / jerk, math.sqrt(speed / jerk))
    hold = speed / (jerk * rise) - rise
    return [(rise, jerk), (hold, 0.0), (rise, -jerk)]


def phases(length: float, limits: Json) -> list[tuple[float, float]]:
    """(duration, jerk) of the quickest motion from rest to rest over a length."""
    return _phases(length, tuple(sorted(limits.items())))


@lru_cache(maxsize=1000)
def _phases(length: float, sorted_limits: tuple[tuple[str, float], ...]) -> list[tuple[float, float]]:
    limits = dict(sorted_limits)

    def parts(v: float) -> tuple[list[tuple[float, float]], list[tuple[float, float]], float]:
        up = ramp(v, limits["acceleration"], limits["jerk"])
        down = [(h, -j) for h, j in ramp(v, limits["deceleration"], limits["jerk"])]
        return up, down, length - v / 2 * sum(h for h, _ in up + down)

    speed = limits["speed"]
    if parts(speed)[2] < 0:
        low = 0.0
        while low < (middle := (low + speed) / 2) < speed:
            low, speed = (middle, speed) if parts(middle)[2] >= 0 else (low, middle)
        speed = low
    up, down, rest = parts(speed)
    return [(h, j) for h, j in [*up, (rest / speed, 0.0), *down] if h > 1e-12]


def profile(runs: Sequence[tuple[float, float]], limits: Json, departure: float = 0.0) -> Json:
    """A profile that drives some lengths one after the other, each (length, rest after it [s])."""
    times, states, jerks = [departure], [[0.0, 0.0, 0.0]], []
    total = 0.0
    for length, rest in runs:
        total += length
        for h, j in [*phases(length, limits), *([(rest, 0.0)] if rest else [])]:
            s, v, a = states[-1]
            times.append(times[-1] + h)
            h = times[-1] - times[-2]
            states.append([s + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j])
            jerks.append(j)
        states[-1] = [total, 0.0, 0.0]
    return {"times": times, "states": states, "jerks": jerks}


def end_of(start: Sequence[float], pieces: Sequence[Sequence[float]]) -> list[float]:
    """Where a path ends, by Simpson's rule with many steps."""
    x, y, heading = start
    for length, k0, k1 in pieces:
        n, rate = 2000, (k1 - k0) / length
        h = length / n
        angles = [heading + (k0 + rate * u / 2) * u for u in (h * i / 2 for i in range(2 * n + 1))]
        weights = [1.0, *([4.0, 2.0] * n)[:-1], 1.0]
        x += h / 6 * math.fsum(w * math.cos(a) for w, a in zip(weights, angles, strict=True))
        y += h / 6 * math.fsum(w * math.sin(a) for w, a in zip(weights, angles, strict=True))
        heading = angles[-1]
    return [x, y]


def robot(name: str, start: Sequence[float], goal: Sequence[float] | None = None, **given: Any) -> Json:
    """One robot; a straight line to its goal, or ``pieces`` [[length, k0, k1], ...] from ``heading``.

    ``runs`` are the lengths driven one after the other with rests between; all at once without it.
    """
    limits = {**LIMITS, **given.get("limits", {})}
    if "pieces" in given:
        pieces, heading = [list(map(float, piece)) for piece in given["pieces"]], given.get("turned", 0.0)
        goal = end_of([*start, heading], pieces)
    else:
        assert goal is not None
        dx, dy = goal[0] - start[0], goal[1] - start[1]
        heading, length = math.atan2(dy, dx), math.hypot(dx, dy)
        pieces = [[length, 0.0, 0.0]] if length else []
    length = math.fsum(piece[0] for piece in pieces)
    departure = float(given.get("departure", 0.0))
    runs = given.get("runs", [(length, 0.0)] if length else [])
    motion = profile(runs, limits, departure)
    motion["states"][-1][0] = length
    release = float(given.get("release", 0.0))
    alone = release + sum(h for h, _ in phases(length, limits)) if length else release
    arrival = motion["times"][-1]
    return {
        "name": name,
        "footprint": given.get("footprint", {"disc": 0.3}),
        "heading": given.get("heading", "fixed"),
        "limits": limits,
        "start": list(map(float, start)),
        "goal": list(map(float, goal)),
        "release": release,
        "priority": given.get("priority"),
        "path": {"start": [*map(float, start), heading], "pieces": pieces},
        "profile": motion,
        "arrival": arrival,
        "solo_arrival": max(alone, arrival),
        "solo_bound": min(alone, arrival),
        "lower_bound": min(alone, arrival),
        "after": [],
        "before": [],
        "how": "alone",
    }


def plan(robots: Sequence[Json], **given: Any) -> Json:
    """A whole plan on a floor of 100 m, with figures that agree."""
    arrivals = [item["arrival"] for item in robots]
    total, bound = sum(arrivals), sum(item["solo_bound"] for item in robots)
    return {
        "format": "coord-plan/1",
        "problem": {"name": "test", "digest": ""},
        "workspace": {
            "bounds": given.get("bounds", [-50.0, -50.0, 50.0, 50.0]),
            "clearance": given.get("clearance", 0.05),
            "after_arrival": given.get("after_arrival", "stay"),
        },
        "obstacles": given.get("obstacles", []),
        "robots": list(robots),
        "order": [item["name"] for item in robots],
        "blocking": [],
        "result": {
            "sum_of_arrivals": total,
            "makespan": max(arrivals),
            "lower_bound": bound,
            "lower_bound_by": "solo_bound",
            "optimality_gap": (total - bound) / total if total else 0.0,
        },
    }


def polygon(name: str, *vertices: Sequence[float], holes: Sequence[Any] = ()) -> Json:
    """An obstacle with straight edges."""
    return {"name": name, "polygon": [list(map(float, v)) for v in vertices], "holes": list(holes)}


def rectangle(name: str, xmin: float, ymin: float, xmax: float, ymax: float) -> Json:
    """A rectangular obstacle."""
    return polygon(name, (xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax))


def circle(name: str, x: float, y: float, radius: float) -> Json:
    """A round obstacle."""
    return {"name": name, "circle": {"center": [float(x), float(y)], "radius": float(radius)}}


def data(document: Json) -> bytes:
    """The bytes of a plan file."""
    return json.dumps(document).encode()


@pytest.fixture(scope="session")
def build() -> SimpleNamespace:
    """The functions of the builder."""
    return SimpleNamespace(
        robot=robot,
        plan=plan,
        polygon=polygon,
        rectangle=rectangle,
        circle=circle,
        data=data,
        profile=profile,
        phases=phases,
        end_of=end_of,
        limits=LIMITS,
    )
