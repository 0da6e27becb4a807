"""The story before planning: a text for people, an object for programs."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Final

from coord.model.arrays import Point
from coord.model.result import BlockingArc
from coord.model.route import Route, Way
from coord.output.summary import paragraphs
from coord.paths.no_way import listed

if TYPE_CHECKING:
    from coord.explain import Deviation, Encounter, Explanation, Trip

#: More meetings than this are counted, not shown.
MOST_ENCOUNTERS: Final = 30

#: The order is wrapped here.
_WIDTH: Final = 100

#: [s] A smaller difference of times rounds to 0.00 s.
_LATE: Final = 0.005


def text(explanation: Explanation) -> str:
    """The story: ways, meetings, who blocks whom, the order and why it is not that of the priorities."""
    problem = explanation.problem
    counts = [_count(len(problem.robots), "robot"), _count(len(problem.obstacles), "obstacle")]
    head = f'{problem.name or "problem"}: {", ".join(counts)}, shape "{explanation.shape}"'
    sections = [
        ("Ways, seen from start to goal; times alone on the floor, from rest to rest", _ways(explanation)),
        *([("Re-routed", (one.text for one in explanation.rerouted))] if explanation.rerouted else []),
        (_encounters_head(explanation), _encounters(explanation)),
        ("Who blocks whom: the first must go before the second", _arcs(explanation)),
        ("Order, first planned first", _order(explanation)),
    ]
    return "\n\n".join([head, *("\n".join([title, *(f"  {line}" for line in lines)]) for title, lines in sections)])


def record(explanation: Explanation) -> dict[str, object]:
    """The object that ``coord explain --json`` prints; numbers in SI units, null where there is none."""
    return {
        "problem": explanation.problem.name,
        "shape": explanation.shape,
        "robots": [_trip_record(trip) for trip in explanation.trips],
        "meetings": [
            {
                "robots": list(one.robots),
                "place": list(one.place),
                "stretches": [list(stretch) for stretch in one.stretches],
            }
            for one in explanation.encounters
        ],
        "blocking": [_arc_record(arc) for arc in explanation.arcs],
        "most_urgent_first": list(explanation.urgent),
        "order": None if explanation.order is None else list(explanation.order),
        "deviations": [
            {
                "robot": one.robot,
                "before": one.before,
                "others": one.others,
                "because": [_arc_record(arc) for arc in one.chain],
            }
            for one in explanation.deviations
        ],
        "together": [list(group) for group in explanation.together],
        "rerouted": [
            {
                "robot": one.robot,
                "ring": list(one.ring),
                "around": [_arc_record(arc) for arc in one.around],
                "extra_length": one.extra_length,
                "extra_time": one.extra_time,
                "text": one.text,
            }
            for one in explanation.rerouted
        ],
        "diagnoses": [asdict(diagnosis) for diagnosis in explanation.diagnoses],
    }


def _trip_record(trip: Trip) -> dict[str, object]:
    route = trip.quickest
    return {
        "name": trip.robot.name,
        "priority": trip.robot.priority,
        "release": trip.robot.release,
        "shape": route and route.shape,
        "side": route and route.side,
        "past": list(trip.past),
        "length": route and route.path.length,
        "time": route and route.time,
        "solo_arrival": route and trip.robot.release + route.time,
        "sides": [
            {"side": way.side, "length": way.length, "time": way.time, "is_bound": way.is_bound, "reason": way.reason}
            for way in (route.ways if route else ())
        ],
        "fits": [
            {"flank": fit.flank, "A": _finite(fit.A), "B": _finite(fit.B), "r_squared": _finite(fit.r_squared)}
            for fit in (route.fits if route else ())
        ],
        "remarks": list(route.remarks) if route else [],
    }


def _arc_record(arc: BlockingArc) -> dict[str, object]:
    place = None if arc.place is None else list(arc.place)
    return {"first": arc.first, "then": arc.then, "at": arc.at, "place": place}


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _ways(explanation: Explanation) -> Iterator[str]:
    for trip in explanation.trips:
        name, route = trip.robot.name, trip.quickest
        if route is None:
            yield f'"{name}": no way'
            if trip.diagnosis is not None:
                yield f"  {trip.diagnosis.text}"
                yield f"  Remedy: {trip.diagnosis.remedy}"
            continue
        yield f'"{name}": {_way(trip, route)}, {route.path.length:.2f} m, {route.time:.2f} s'
        for way in route.ways:
            if way.side != route.side:
                yield f"  {way.side}: {_other_side(way, route)}"
        for fit in route.fits:
            yield f"  {fit.flank}: y = A exp(B x) with A = {fit.A:.4g} m, B = {fit.B:.4g} 1/m, R2 = {fit.r_squared:.4f}"
        yield from (f"  {remark}" for remark in route.remarks)
        if trip.robot.release > 0:
            release = trip.robot.release
            yield f"  released at {release:.2f} s: alone it arrives at {release + route.time:.2f} s"


def _way(trip: Trip, route: Route) -> str:
    """Which way a robot takes, in words."""
    robot = trip.robot
    if route.path.length == 0:
        return "stays where it is"
    if route.shape == "given":
        return "its given path"
    through = f"through {_count(len(robot.via), 'place')} to pass" if robot.via else ""
    if not route.side:
        return through or "straight"
    side = "left of some and right of others of" if route.side == "both" else f"{route.side} of"
    asked = " as asked for" if robot.side != "quickest" else ""
    return f"{side} {listed(trip.past)}{asked}" + (f", {through}" if through else "")


def _other_side(way: Way, route: Route) -> str:
    if way.length is None or way.time is None:
        return f"no way: {way.reason}"
    if way.is_bound:
        return f"not below {way.length:.2f} m, {way.time:.2f} s"
    late = way.time - route.time
    than = "as quick" if abs(late) < _LATE else f"{abs(late):.2f} s {'slower' if late > 0 else 'quicker'}"
    return f"{way.length:.2f} m, {way.time:.2f} s, {than}"


def _encounters_head(explanation: Explanation) -> str:
    found = explanation.encounters
    pairs = len({one.robots for one in found})
    return f"Meetings: {len(found)}, of {_count(pairs, 'pair')}" if found else "Meetings"


def _encounters(explanation: Explanation) -> Iterator[str]:
    found = explanation.encounters
    if not found:
        yield "No two paths come too near to each other."
    yield from map(_encounter, found[:MOST_ENCOUNTERS])
    if len(found) > MOST_ENCOUNTERS:
        yield f"and {len(found) - MOST_ENCOUNTERS} more; --json tells all"


def _encounter(one: Encounter) -> str:
    stretches = (
        f'"{name}" from {first:.2f} to {last:.2f} m of its path'
        for name, (first, last) in zip(one.robots, one.stretches, strict=True)
    )
    return f"at {_at(one.place)}: {', '.join(stretches)}"


def _arcs(explanation: Explanation) -> Iterator[str]:
    if not explanation.arcs:
        yield "Nobody starts or parks in anybody's way."
    for arc in explanation.arcs:
        yield f'"{arc.first}" before "{arc.then}": {_because(arc)}'


def _because(arc: BlockingArc) -> str:
    if arc.at == "start":
        return f'''"{arc.first}" stands in "{arc.then}"'s way at {_at(arc.place)} until it leaves'''
    return f'''"{arc.then}" would park in "{arc.first}"'s way at {_at(arc.place)}'''


def _order(explanation: Explanation) -> Iterator[str]:
    lost = [trip.robot.name for trip in explanation.trips if trip.quickest is None]
    if lost:
        have = "has" if len(lost) == 1 else "have"
        yield f"There is no plan as long as {listed(lost)} {have} no way."
    told = [trip.diagnosis for trip in explanation.trips]
    rings = [one for one in explanation.diagnoses if one not in told]
    if rings:
        yield from paragraphs(rings).splitlines()
    if explanation.order is None:
        return
    for group in explanation.together:
        yield f"{listed(group)} stand in each other's way in a ring, so they leave together, if they can."
    yield from textwrap.wrap(", ".join(explanation.order), _WIDTH, break_long_words=False, break_on_hyphens=False)
    trips = {trip.robot.name: trip for trip in explanation.trips}
    groups = {name: group for group in explanation.together for name in group}
    yield from (_deviation(one, trips, groups.get(one.robot, ())) for one in explanation.deviations)
    if not explanation.deviations:
        yield "This is the order of the priorities; no arc forbids it."


def _deviation(one: Deviation, trips: Mapping[str, Trip], group: Sequence[str]) -> str:
    reason = "; and ".join(_because(arc) for arc in one.chain)
    reason = reason or f"it leaves together with {listed([name for name in group if name != one.robot])}"
    others = f' So it goes before {_count(one.others, "more robot")} behind "{one.before}", too.' if one.others else ""
    rule = _less_urgent(trips[one.robot], trips[one.before])
    return f'"{one.robot}" goes before "{one.before}" although {rule}: {reason}.{others}'


def _less_urgent(trip: Trip, other: Trip) -> str:
    """By which rule of urgency another robot comes first."""
    mine, theirs = trip.robot.priority, other.robot.priority
    if mine is None and theirs is not None:
        return f'it has no priority, and "{other.robot.name}" has'
    if mine is not None and theirs is not None and mine != theirs:
        return f"its priority is lower ({mine:g} comes after {theirs:g})"
    if mine is None and trip.arrival != other.arrival:
        return f"alone it would arrive earlier (at {trip.arrival:.2f} s, not {other.arrival:.2f} s)"
    return "it comes later in the file"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _at(place: Point | None) -> str:
    # 0.0 is added because a place just below zero would read -0.00
    return "an unknown place" if place is None else f"({round(place[0], 2) + 0.0:.2f}, {round(place[1], 2) + 0.0:.2f})"
