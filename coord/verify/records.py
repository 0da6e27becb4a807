"""A plan as read: frozen records, their form checked, nothing else."""

from __future__ import annotations

from dataclasses import dataclass

from coord.verify.shapes import Body

Point = tuple[float, float]
Row = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Limits:
    """speed [m/s], acceleration, deceleration [m/s2], jerk [m/s3], lateral_acceleration [m/s2]."""

    speed: float
    acceleration: float
    deceleration: float
    jerk: float
    lateral_acceleration: float


@dataclass(frozen=True, slots=True)
class Robot:
    """One robot of a plan: what it is, where it goes, how it moves, and what is claimed about it.

    ``pose`` and ``pieces`` are its path, ``times``, ``states`` (s, v, a) and ``jerks`` its velocity profile.
    """

    name: str
    body: Body
    limits: Limits
    start: Point
    goal: Point
    release: float
    pose: tuple[float, float, float]
    pieces: tuple[Row, ...]
    times: Row
    states: tuple[Row, ...]
    jerks: Row
    arrival: float
    solo_arrival: float
    solo_bound: float
    lower_bound: float
    after: tuple[str, ...]
    before: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Circle:
    """A round obstacle."""

    name: str
    center: Point
    radius: float


@dataclass(frozen=True, slots=True)
class Polygon:
    """An obstacle with straight edges; it lies to the left of its rings: the outline, then the holes."""

    name: str
    rings: tuple[tuple[Point, ...], ...]


@dataclass(frozen=True, slots=True)
class Figures:
    """The result a plan reports: sums, bound [s] and gap [1]."""

    sum_of_arrivals: float
    makespan: float
    lower_bound: float
    lower_bound_by: str
    optimality_gap: float


@dataclass(frozen=True, slots=True)
class Plan:
    """The whole document."""

    bounds: tuple[float, float, float, float]
    clearance: float
    leave: bool
    obstacles: tuple[Circle | Polygon, ...]
    robots: tuple[Robot, ...]
    order: tuple[str, ...]
    blocking: tuple[tuple[str, str, str], ...]
    figures: Figures
