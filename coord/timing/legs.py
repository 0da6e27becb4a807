"""Legs from rest to rest: drive as if alone, brake as late as possible, stand, and go on from there."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from coord.alone.chain import chained
from coord.alone.check import keeps_limits
from coord.alone.speed_limit import SpeedLimit
from coord.model.arrays import frozen
from coord.model.profile import State, VelocityProfile, integrate
from coord.model.robot import Limits
from coord.solvers.jerk import SHORTEST_PHASE, rest_to_rest
from coord.timing.ego import Ego

#: [m] A shorter rest of a section is left out of what lies ahead: the robot is too slow there to mind its cap.
_SLIVER = 1e-6

#: Halvings of the phase in which braking begins: enough for the last digit of a time.
_HALVINGS = 60


def onward(ego: Ego, s: float, departure: float) -> VelocityProfile:
    """The quickest motion from rest at s [m] to the goal that leaves at a time [s], as ``fastest`` finds it.

    Raises
    ------
    SolverError
        When ruckig fails, which no known input makes it do.
    """
    if s <= 0:
        return ego.alone.shifted(departure - ego.alone.departure)
    limits, ahead = ego.robot.limits, ego.caps.ends > s + _SLIVER
    caps = SpeedLimit(frozen(ego.caps.ends[ahead] - s), frozen(ego.caps.caps[ahead]))
    best = rest_to_rest(ego.length - s, dataclasses.replace(limits, speed=float(caps.caps.min())))
    chain = None if caps.is_constant else chained(caps, limits)
    if chain is not None and chain.arrival < best.arrival and keeps_limits(chain, limits, caps):
        best = chain
    states = best.states + np.array([s, 0.0, 0.0])
    states[-1, 0] = ego.length
    return VelocityProfile(best.times + departure, frozen(states, 3), best.jerks)


def last_moment(leg: VelocityProfile, place: float, limits: Limits) -> float:
    """The last time [s] on a leg from which full braking ends no farther than a place [m], but for rounding.

    Later braking never stops sooner, so there is one such time: the leg's arrival where its goal is not beyond.
    """
    reached = [_halt((s, v, a), limits) for s, v, a in leg.states.tolist()]
    beyond = next((k for k, end in enumerate(reached) if end > place), None)
    if beyond is None:
        return leg.arrival
    if beyond == 0:
        return leg.departure
    state, jerk = leg.states[beyond - 1].tolist(), float(leg.jerks[beyond - 1])
    low, high = 0.0, float(leg.times[beyond] - leg.times[beyond - 1])
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if _halt(integrate((state[0], state[1], state[2]), [middle], [jerk])[1], limits) <= place:
            low = middle
        else:
            high = middle
    return float(leg.times[beyond - 1]) + low


def braked(leg: VelocityProfile, moment: float, limits: Limits) -> VelocityProfile:
    """The leg up to a moment [s], and from there full braking to rest.

    Nothing that goes on from the same state is slower at any place, so every speed cap that the leg keeps is kept.
    """
    kept = leg.times < moment - SHORTEST_PHASE
    s, v, a = leg.state(moment)[0].tolist()
    phases = [(h, j) for h, j in _braking(v, a, limits) if h >= SHORTEST_PHASE]
    states = integrate((s, v, a), [h for h, _ in phases], [j for _, j in phases])
    states[-1] = (states[-1][0], 0.0, 0.0)
    times = moment + np.cumsum([0.0, *(h for h, _ in phases)])
    return VelocityProfile(
        np.concatenate([leg.times[kept], times]),
        np.concatenate([leg.states[kept], states]),
        np.concatenate([leg.jerks[: int(kept.sum())], [j for _, j in phases]]),
    )


def followed(way: VelocityProfile | None, leg: VelocityProfile) -> VelocityProfile:
    """A way that ends at rest, the wait there, and a leg that leaves from there; just the leg where there is no way."""
    if way is None:
        return leg
    if leg.departure - way.arrival < SHORTEST_PHASE:
        times, states, jerks = leg.times[1:], leg.states[1:], leg.jerks
    else:
        times, states, jerks = leg.times, leg.states, np.concatenate([[0.0], leg.jerks])
    return VelocityProfile(
        np.concatenate([way.times, times]),
        np.concatenate([way.states, states]),
        np.concatenate([way.jerks, jerks]),
    )


def _halt(state: State, limits: Limits) -> float:
    """Where full braking from a state ends [m]."""
    phases = _braking(state[1], state[2], limits)
    return integrate(state, [h for h, _ in phases], [j for _, j in phases])[-1][0]


def _braking(v: float, a: float, limits: Limits) -> list[tuple[float, float]]:
    """Phases (duration, jerk) of full braking to rest: down to a deceleration b, hold it, and up to 0.

    The speed lost is (b^2 - a^2) / (2 j) + b hold + b^2 / (2 j) = v; b is the limit, or less where the hold would be
    negative.
    """
    j = limits.jerk
    b = math.sqrt(max(j * v + a * a / 2, 0.0))
    hold = 0.0
    if b > limits.deceleration:
        b = limits.deceleration
        hold = max((v + (a * a / 2 - b * b) / j) / b, 0.0)
    b = max(b, -a)
    return [((a + b) / j, -j), (hold, 0.0), (b / j, j)]
