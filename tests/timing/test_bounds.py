"""Certified bounds: nothing that drives beats them, and they are worth having."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from coord.timing.bounds import inner_claims, least_arrival

#: [m] Lattice units: steps of 0.5 s with jerks of -1, 0, 1 m/s3 move by multiples of this.
UNIT = 1 / 48


def on_lattice(problem):
    """The scene with an ego whose way is a whole number of lattice units, and releases on the lattice."""
    ego = dataclasses.replace(problem.robots[-1], start=(-7.0, 8.0))
    return dataclasses.replace(problem, robots=(*problem.robots[:-1], ego))


def best_on_lattice(length, taken, most=160):
    """Earliest arrival of all motions in steps of half a second with jerk -1, 0 or 1 that keep clear; by brute force.

    Speed in eighths, acceleration in halves, distance in 1/48 m; v(t) is monotone within a step. ``taken`` tells
    which arc lengths (m,) are forbidden at a time.
    """
    states, goal = np.array([[0, 0, 0]]), round(length / UNIT)
    for step in range(most):
        found = []
        for j in (-1, 0, 1):
            s, v, a = states.T
            after = np.stack([s + 3 * v + 3 * a + j, v + 2 * a + j, a + j], axis=1)
            fits = (np.abs(after[:, 2]) <= 1) & (after[:, 1] >= 0) & (after[:, 1] <= 8) & (after[:, 0] <= goal)
            for share in np.linspace(0.0, 1.0, 11):
                h = 0.5 * share
                at = s * UNIT + h * (v / 8 + h * (a / 4 + h * j / 6))
                fits &= ~taken(0.5 * (step + share), at)
            found.append(after[fits])
        states = np.unique(np.concatenate(found), axis=0)
        if (states == [goal, 0, 0]).all(axis=1).any():
            return 0.5 * (step + 1)
    return np.inf


@pytest.mark.parametrize("seed", range(10))
def test_no_motion_on_a_lattice_beats_the_bound(lanes, timed, interval, seed):
    """Across lanes at the worst moments: the best of all motions on a lattice is no earlier, and at most 5 % later."""
    problem = on_lattice(lanes(seed))
    egos, timings, _ = timed(problem)
    mine = SimpleNamespace(robot=egos[-1].robot, path=egos[-1].path)
    others = [
        SimpleNamespace(robot=one.robot, path=one.path, profile=timing.profile)
        for one, timing in zip(egos[:-1], timings, strict=False)
    ]

    def taken(t, s):
        bad = np.zeros(len(s), bool)
        for other in others:
            low, high = interval(mine, other, problem.workspace.clearance + 0.01, np.array([t]))
            bad |= (s > low[0]) & (s < high[0])
        return bad

    bound, best = timings[-1].lower_bound, best_on_lattice(egos[-1].length, taken)
    assert egos[-1].solo_bound <= bound <= timings[-1].profile.arrival
    assert bound <= best <= 1.05 * bound


def test_bounds_are_close_to_the_arrivals(lanes, crossroads, timed):
    """Of the delayed robots of 60 scenes, half are within 0.1 % of their bound and nine in ten within 5 %."""
    gaps = []
    for problem in [lanes(seed) for seed in range(30)] + [crossroads(seed, 5) for seed in range(30)]:
        found = timed(problem)
        if found is not None:
            gaps += [one.profile.arrival / one.lower_bound - 1 for one in found[1] if one.how != "alone"]
    assert len(gaps) >= 25
    assert np.median(gaps) < 1e-3
    assert np.quantile(gaps, 0.9) < 0.05


@pytest.mark.parametrize("seed", range(6))
def test_with_bends_every_arrival_respects_its_bound(bent_crossing, timed, seed):
    """solo bound <= bound <= arrival for each robot, gentle or not."""
    for profile in ("fastest", "gentle"):
        found = timed(bent_crossing(seed), profile)
        if found is None:
            continue
        for ego, timing in zip(*found[:2], strict=True):
            assert ego.solo_bound <= timing.lower_bound <= timing.profile.arrival


def test_what_is_known_of_pairs_of_claims_changes_no_bound(lanes, timed):
    """As claims are added one after the other, the bound with the pairs kept is the same as without, and never falls."""
    raised = 0
    for seed in range(12):
        found = timed(lanes(seed))
        if found is None:
            continue
        ego, meetings, claims, known, before = found[0][-1], found[2][-1], [], {}, 0.0
        for meeting in meetings:
            claims += inner_claims(ego, meeting)
            bound = least_arrival(ego, claims, 1e3, known=known)
            assert bound == least_arrival(ego, claims, 1e3) >= before
            raised, before = raised + (bound > before > 0), bound
    assert raised > 0
