"""Nearest first: nobody has priority; whoever is nearest to a conflict goes through, the other stops before it.

A simulation from event to event, in which nobody knows what will be: a robot drives as if alone. At the last moment at
which it could still stop before a conflict that nobody has claimed, the conflict goes to whichever of the two has less
way to go to it; a difference of less than a centimetre is none, then the first of the file has it. Who has not got it
stops before it, waits until the other has left it, and goes on from rest. Two things are no matter of distance: who
starts on the other's way has to leave first, and who would park on it has to let the other pass, since the other could
never arrive else. A robot that is not released yet does not compete.

What has been claimed is kept, also while the robot that claimed it waits for somebody else: so robots may end up
waiting for each other in a ring. Then nobody moves any more, and that is a jam.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from coord.alone.inverse import time_at
from coord.coordination import diagnose
from coord.coordination.order import topological_order
from coord.coordination.scene import Scene
from coord.coordination.zones import Zone, zones_of
from coord.errors import NoPlanError
from coord.model.profile import VelocityProfile
from coord.model.result import BlockingArc, Diagnosis
from coord.timing.ego import Ego
from coord.timing.legs import braked, followed, last_moment, onward
from coord.timing.passing import Timing
from coord.timing.stopping import LEAST_MOVE

#: [m] Differences of distance below this are none: the outer bounds of a region differ by about as much.
_SAME_DISTANCE: Final = 0.01

#: What happens, in the order in which it is dealt with at one time.
_LEAVES, _RESTS, _MUST_DECIDE = range(3)


@dataclass(slots=True, eq=False)
class _Driver:
    """One robot under way: what it has driven up to its last rest, and the leg since then.

    ``zones`` : its conflicts in the order in which it comes to them; ``waits_for`` : the one it stops before;
    ``legs`` : how many it has begun, so that events of a leg that was cut short are known as such.
    """

    ego: Ego
    zones: list[Zone]
    way: VelocityProfile | None = None
    leg: VelocityProfile | None = None
    waits_for: Zone | None = None
    legs: int = 0
    has_arrived: bool = False

    def place(self, t: float) -> float:
        if self.leg is not None:
            return self.leg.place(t)
        return 0.0 if self.way is None else self.way.length


@dataclass(slots=True, eq=False)
class _Floor:
    """All robots and the events to come: (time, what, robot, number of its leg, index of its zone)."""

    drivers: list[_Driver]
    events: list[tuple[float, int, int, int, int]] = field(default_factory=list)

    def push(self, t: float, what: int, i: int, zone: int = -1) -> None:
        heapq.heappush(self.events, (t, what, i, self.drivers[i].legs, zone))


def plan_nearest_first(
    scene: Scene,
    names: Sequence[str],
    arcs: Sequence[BlockingArc],
    done: Callable[[int], None],
    time_is_up: Callable[[], bool] = lambda: False,
) -> tuple[list[int], dict[int, Timing]]:
    """A profile for every robot, and an order: by arrival, as far as the blocking arcs allow.

    There is no order of planning, so this one only says whom ``after`` and ``before`` of a timing speak of.

    Parameters
    ----------
    done : called with the number of robots that have arrived.
    time_is_up : asked at every event.

    Raises
    ------
    NoPlanError
        When the time is up, or in a jam.
    """
    zones = zones_of(scene)
    floor = _Floor([_Driver(ego, []) for ego in scene.egos])
    for zone in zones:
        for i in zone.robots:
            floor.drivers[i].zones.append(zone)
    for i, driver in enumerate(floor.drivers):
        driver.zones.sort(key=lambda zone, i=i: zone.begins(i))  # type: ignore[misc]
        floor.push(driver.ego.robot.release, _RESTS, i)
    arrived = 0
    while floor.events:
        if time_is_up():
            raise NoPlanError([diagnose.time_is_up(arrived, len(names))])
        if _next(floor):
            arrived += 1
            done(arrived)
    if arrived < len(names):
        raise NoPlanError(_jams(floor, names))
    profiles = [followed(driver.way, driver.leg) for driver in floor.drivers if driver.leg is not None]
    urgent = sorted(range(len(names)), key=lambda i: (profiles[i].arrival, i))
    order = topological_order(urgent, names, arcs)
    if order is None:
        raise RuntimeError("robots block each other in a ring although all rings were opened")
    return order, _timings(floor, profiles, order)


def _next(floor: _Floor) -> bool:
    """Let the next event happen; whether it is an arrival."""
    t, what, i, number, index = heapq.heappop(floor.events)
    driver = floor.drivers[i]
    if number != driver.legs:
        return False
    if what == _RESTS:
        if driver.leg is not None and driver.leg.length >= driver.ego.length:
            driver.has_arrived = True
            return True
        if driver.leg is not None:
            driver.way, driver.leg = followed(driver.way, driver.leg), None
        _try_to_go(floor, i, t)
        return False
    zone = driver.zones[index]
    if what == _LEAVES:
        zone.is_over = True
        other = zone.other(i)
        if floor.drivers[other].leg is None and floor.drivers[other].waits_for is zone:
            _try_to_go(floor, other, t)
        return False
    _settle(floor, zone, i, t)
    if zone.is_open_to(i):
        _look_ahead(floor, i, index + 1)
    else:
        driver.waits_for = zone
        _brake(floor, i, t)
    return False


def _try_to_go(floor: _Floor, i: int, t: float) -> None:
    """Leave a rest for the goal, if everything before which no stop is left is open."""
    driver = floor.drivers[i]
    place = driver.place(t)
    for zone in driver.zones:
        if zone.begins(i) < place + LEAST_MOVE:
            _settle(floor, zone, i, t)
            if not zone.is_open_to(i):
                driver.waits_for = zone
                return
    driver.waits_for = None
    _drive(floor, i, onward(driver.ego, place, t), place)
    _look_ahead(floor, i, sum(zone.begins(i) < place + LEAST_MOVE for zone in driver.zones))


def _brake(floor: _Floor, i: int, t: float) -> None:
    """Stop as soon as possible; the moment was chosen so that this is before the zone."""
    driver = floor.drivers[i]
    if driver.leg is None:
        raise RuntimeError("a robot at rest cannot brake")
    _drive(floor, i, braked(driver.leg, t, driver.ego.robot.limits), driver.place(t))


def _drive(floor: _Floor, i: int, leg: VelocityProfile, place: float) -> None:
    """Follow a leg from a place on it [m]: when it ends, and when which zones are left."""
    driver = floor.drivers[i]
    driver.leg = leg
    driver.legs += 1
    floor.push(leg.arrival, _RESTS, i)
    left = [k for k, zone in enumerate(driver.zones) if place < zone.ends(i) <= leg.length and not zone.is_over]
    if leg.length <= 0:  # its goal is its start: it was there, and is gone
        left = [k for k, zone in enumerate(driver.zones) if not zone.parks(i)]
    for k, when in zip(left, time_at(leg, [driver.zones[k].ends(i) for k in left]).tolist(), strict=True):
        floor.push(when, _LEAVES, i, k)


def _look_ahead(floor: _Floor, i: int, index: int) -> None:
    """Mark the moment for the next zone, from an index on, that is not open yet."""
    driver = floor.drivers[i]
    for k in range(index, len(driver.zones)):
        zone = driver.zones[k]
        if not zone.is_open_to(i) and driver.leg is not None:
            moment = last_moment(driver.leg, zone.begins(i), driver.ego.robot.limits)
            floor.push(moment, _MUST_DECIDE, i, k)
            return


def _settle(floor: _Floor, zone: Zone, i: int, t: float) -> None:
    """Give a zone that is still nobody's to one of its two robots, when robot i comes to it."""
    if zone.owner is not None or zone.is_over:
        return
    other = zone.other(i)
    if zone.parks(i):
        zone.owner = other
    elif zone.parks(other) or t < floor.drivers[other].ego.robot.release:
        zone.owner = i
    else:
        ways = [zone.begins(k) - floor.drivers[k].place(t) for k in zone.robots]
        zone.owner = zone.robots[ways[1] < ways[0] - _SAME_DISTANCE]


def _timings(floor: _Floor, profiles: Sequence[VelocityProfile], order: Sequence[int]) -> dict[int, Timing]:
    rank = {i: k for k, i in enumerate(order)}
    timings = {}
    for i in order:
        driver, profile = floor.drivers[i], profiles[i]
        earlier = [zone for zone in driver.zones if rank[zone.other(i)] < rank[i]]
        after = {zone.other(i) for zone in earlier if zone.owner != i}
        before = {zone.other(i) for zone in earlier} - after
        how = "stop" if driver.way is not None else "alone"
        if how == "alone" and profile.departure > driver.ego.alone.departure:
            how = "start delay"
        bound = min(driver.ego.solo_bound, profile.arrival)
        timings[i] = Timing(profile, tuple(sorted(after)), tuple(sorted(before)), how, bound)
    return timings


def _jams(floor: _Floor, names: Sequence[str]) -> list[Diagnosis]:
    """One diagnosis for each ring of robots that wait for each other."""
    waits = {}
    for i, driver in enumerate(floor.drivers):
        if driver.waits_for is not None and not driver.has_arrived:
            since = driver.ego.robot.release if driver.way is None else driver.way.arrival
            rest = 0.0 if driver.way is None else driver.way.length
            x, y = driver.ego.path.point([rest])[0].tolist()
            waits[i] = (driver.waits_for.other(i), diagnose.Wait(names[i], (x, y), since))
    rings: list[list[int]] = []
    for i in waits:
        chain = [i]
        while waits[chain[-1]][0] in waits and waits[chain[-1]][0] not in chain:
            chain.append(waits[chain[-1]][0])
        last = waits[chain[-1]][0]
        ring = chain[chain.index(last) :] if last in chain else chain
        if not any(set(ring) & set(known) for known in rings):
            rings.append(ring)
    behind = len(waits) - sum(len(ring) for ring in rings)
    return [diagnose.jam([waits[i][1] for i in ring], behind) for ring in rings]
