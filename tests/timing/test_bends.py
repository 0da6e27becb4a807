"""What bends cost at least: no motion beats it, and the quickest comes close."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from coord.alone.chain import chained
from coord.alone.fastest import fastest
from coord.alone.inverse import time_at
from coord.alone.speed_limit import SpeedLimit, speed_limit
from coord.model.footprint import Footprint
from coord.model.path import Path, straight
from coord.model.robot import Limits, Robot
from coord.timing.bends import narrower, passages
from coord.timing.ego import earliest, ego, sharpened, still_needed


def scene(seed, clothoids=True):
    """A random way with one to three bends, arcs or clothoids, and a robot on it."""
    rng = np.random.default_rng(seed)
    pieces = [(float(rng.uniform(1, 6)), 0.0, 0.0)]
    for _ in range(rng.integers(1, 4)):
        k, side = float(rng.uniform(0.5, 5.0)), rng.choice([-1.0, 1.0])
        turn = [(float(rng.uniform(0.02, 1.0)), side * k, side * k)]
        if clothoids and rng.integers(2):
            lead = float(rng.uniform(0.2, 1.0))
            turn = [(lead, 0.0, side * k), *turn, (lead, side * k, 0.0)]
        pieces += [*turn, (float(rng.uniform(0.3, 6)), 0.0, 0.0)]
    limits = Limits(*np.round(rng.uniform((0.6, 0.3, 0.3, 0.5, 0.2), (1.8, 1.2, 1.2, 3.0, 0.8)), 2).tolist())
    path = Path((0.0, 0.0, 0.0), pieces)
    robot = Robot("e", Footprint(0.3), limits, (0.0, 0.0), path.end, release=float(rng.choice([0.0, 3.0])))
    return rng, ego(robot, path)


def some_motions(rng, one):
    """The quickest profile, and others that are slower in all sorts of ways, within all limits."""
    limits, path = one.robot.limits, one.path
    yield fastest(path, limits)
    for _ in range(3):
        share = rng.uniform(0.6, 1.0, 4)
        lower = Limits(limits.speed * share[0], limits.acceleration * share[1], limits.deceleration * share[2],
                       limits.jerk * share[3], limits.lateral_acceleration)  # fmt: skip
        yield fastest(path, lower)
        caps = speed_limit(path, limits)
        slow = chained(SpeedLimit(caps.ends, caps.caps * rng.uniform(0.5, 1.0, len(caps.caps))), limits)
        if slow is not None:
            yield slow


@pytest.mark.parametrize("rounds", [0, 3])
@pytest.mark.parametrize(("seed", "clothoids"), [*((k, False) for k in range(16)), (0, True), (3, True)])
def test_no_motion_is_anywhere_earlier_or_has_less_to_go(seed, clothoids, rounds):
    """Profiles of all sorts, alone on random ways with bends, at 400 places; however closely it is looked."""
    rng, one = scene(seed, clothoids)
    one = sharpened(one, rounds)
    s = np.linspace(0.0, one.length, 400)
    early, still = earliest(one, s), still_needed(one, s)
    for motion in some_motions(rng, one):
        at = time_at(motion, s)
        assert np.all(at + one.robot.release >= early - 1e-6)
        assert np.all(motion.arrival - at >= still - 1e-6)
        assert motion.arrival + one.robot.release >= one.solo_bound


@pytest.mark.parametrize("seed", range(6))
def test_reached_and_due_are_the_inverses(seed):
    """A little short of the last place reached by a time the least time is no later, a little beyond it no earlier."""
    _, one = scene(seed, clothoids=False)
    long_ago = np.full(200, -1e3)
    times = np.linspace(0.0, one.bends.total, 200)
    for places, needed, sign in (
        (one.bends.reached(times), one.bends.earliest, 1.0),
        (one.bends.due(times), one.bends.needed, -1.0),
    ):
        assert np.all(needed(places - sign * 1e-9, long_ago) <= times + 1e-6)
        beyond = places + sign * 1e-9
        inside = (beyond > 0) & (beyond < one.length)
        assert inside.sum() > 50
        assert np.all(needed(beyond, long_ago)[inside] >= times[inside] - 1e-6)


@pytest.mark.parametrize("crawl", [0.05, 0.1, 0.2, 0.3])
@pytest.mark.parametrize("ahead", [0.005, 0.015, 0.03, 0.06, 0.12])
def test_who_speeds_up_into_a_short_bend_is_not_denied_it(crawl, ahead):
    """Crawling up to a little before a bend of 7 cm, from there on as quick as can be: no bound was ever later."""
    limits = Limits(1.28, 0.81, 0.63, 1.13, 0.3)
    path = Path((0.0, 0.0, 0.0), [(2.0, 0, 0), (0.066, 2.0, 2.0), (2.96, 0, 0), (0.066, -2.0, -2.0), (3.0, 0, 0)])
    one = ego(Robot("e", Footprint(0.3), limits, (0.0, 0.0), path.end), path)
    caps = speed_limit(path, limits)
    motion = chained(SpeedLimit(np.insert(caps.ends, 0, 2.0 - ahead), np.insert(caps.caps, 0, crawl)), limits)
    s = np.linspace(0.0, one.length, 2000)
    assert np.all(motion.arrival - time_at(motion, s) >= still_needed(one, s) - 1e-6)
    assert np.all(time_at(motion, s) >= earliest(one, s) - 1e-6)


def test_the_quickest_profile_is_close_to_the_bound():
    """Alone on ways of arcs and straights: half are 0.3 % above, nine in ten 1.5 %; with the jerk forgotten half are 2 %."""
    with_jerk, without = [], []
    for seed in range(40):
        _, one = scene(seed, clothoids=False)
        alone = one.alone.arrival - one.robot.release
        with_jerk.append(alone / (one.solo_bound - one.robot.release) - 1)
        without.append(alone / one.relaxed.arrival - 1)
    assert np.quantile(with_jerk, 0.9) < 0.015
    assert np.median(with_jerk) < 0.003
    assert np.median(without) > 0.02


def test_a_closer_look_leaves_a_third():
    """Cells cut three times: of what the bounds lack of the quickest profile, on half the ways no more than a third."""
    shares = []
    for seed in range(20):
        _, one = scene(seed, clothoids=False)
        lacks = [one.alone.arrival - sharpened(one, rounds).solo_bound for rounds in (0, 3)]
        assert lacks[1] <= lacks[0] + 1e-9
        shares.append(lacks[1] / lacks[0])
    assert np.median(shares) < 1 / 3


def test_with_jerk_all_but_free_bends_cost_no_more_than_without_it():
    """At 2000 m/s3 the bound is that of the motion without jerk to a thousandth."""
    for seed in range(10):
        _, one = scene(seed, clothoids=False)
        limits = dataclasses.replace(one.robot.limits, jerk=2000.0)
        found = passages(one.path, limits, one.relaxed)
        assert found.total == pytest.approx(one.relaxed.arrival, rel=1e-3)


def test_a_path_of_one_cap_has_no_bends():
    """On a straight line the closed forms are exact already."""
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    path = straight((0.0, 0.0), (5.0, 0.0))
    robot = Robot("e", Footprint(0.3), limits, (0.0, 0.0), (5.0, 0.0))
    assert passages(path, limits, ego(robot, path).relaxed) is None


def lattice_layers(length, steps, is_allowed):
    """The states (n, 3) after each step that lie on some way to rest at the goal, of all motions on a lattice.

    Steps last half a second, with jerk -1, 0 or 1 m/s3: speed in eighths, acceleration in halves, place in 1/48 m.
    """
    goal = round(length * 48)
    layers, links = [np.array([[0, 0, 0]])], []
    for _ in range(steps):
        found, parents = [], []
        s, v, a = layers[-1].T
        for j in (-1, 0, 1):
            after = np.stack([s + 3 * v + 3 * a + j, v + 2 * a + j, a + j], axis=1)
            keep = (np.abs(after[:, 2]) <= 1) & (after[:, 1] >= 0) & (after[:, 1] <= 8) & (after[:, 0] <= goal)
            for share in np.linspace(0.0, 1.0, 21):
                h = 0.5 * share
                keep &= is_allowed(s / 48 + h * (v / 8 + h * (a / 4 + h * j / 6)), v / 8 + h * (a / 2 + h * j / 2))
            found.append(after[keep])
            parents.append(np.flatnonzero(keep))
        states, index = np.unique(np.concatenate(found), axis=0, return_inverse=True)
        layers.append(states)
        links.append((np.concatenate(parents), index.ravel()))
    alive = (layers[-1] == [goal, 0, 0]).all(axis=1)
    kept = [layers[-1][alive]]
    for states, (parent, child) in zip(layers[-2::-1], links[::-1], strict=True):
        before = np.zeros(len(states), bool)
        before[parent[alive[child]]] = True
        alive = before
        kept.append(states[alive])
    return kept[::-1]


def test_a_lattice_of_motions_through_a_bend_is_never_earlier():
    """Of all motions on a lattice that get to the goal, none is anywhere before the earliest time, nor has less to go."""
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.25)
    path = Path((0.0, 0.0, 0.0), [(3.0, 0.0, 0.0), (1.0, 1.0, 1.0), (3.0, 0.0, 0.0)])
    robot = Robot("e", Footprint(0.3), limits, (0.0, 0.0), path.end)
    one = ego(robot, path)
    steps = next(n for n in range(10, 60) if len(lattice_layers(7.0, n, slow_in_the_bend)[0]))
    layers = lattice_layers(7.0, steps, slow_in_the_bend)
    assert 0.5 * steps >= one.solo_bound
    assert 0.5 * steps <= 1.15 * one.solo_bound  # else the lattice would prove little
    for step, states in enumerate(layers):
        s = np.array([states[:, 0].max(), states[:, 0].min()]) / 48
        assert 0.5 * step >= earliest(one, s)[0] - 1e-6
        assert 0.5 * (steps - step) >= still_needed(one, s)[0] - 1e-6


def slow_in_the_bend(s, v):
    """At most half a metre a second from 3 m to 4 m."""
    return (v <= 0.5 + 1e-9) | (s <= 3.0 + 1e-9) | (s >= 4.0 - 1e-9)


def needed_between(one, places):
    """Least times [s] from each of the arc lengths to each."""
    alone = time_at(one.relaxed, one.bends.marks)
    at = time_at(one.relaxed, places)
    i = np.searchsorted(one.bends.marks, places, side="left")
    k = np.searchsorted(one.bends.marks, places, side="right") - 1
    extra = np.where(k[None] > i[:, None], one.bends.between[np.minimum(i, len(alone) - 1)[:, None], k[None]], 0.0)
    return at[None] - at[:, None] + extra


@pytest.mark.parametrize(("seed", "clothoids"), [*((k, False) for k in range(16)), (0, True), (3, True)])
def test_no_motion_is_quicker_from_any_place_to_any_later_one(seed, clothoids):
    """The same motions, and every state on them is one with which a robot may come by: 120 places, all pairs."""
    rng, one = scene(seed, clothoids)
    if one.bends is None:
        return
    places = np.unique(np.append(np.linspace(0.0, one.length, 80), one.bends.marks))
    least = needed_between(one, places)
    for motion in some_motions(rng, one):
        at = time_at(motion, places)
        later = places[None] > places[:, None]
        assert np.all((at[None] - at[:, None] >= least - 1e-6)[later])


def test_leaving_a_sharp_bend_costs_more_than_without_jerk():
    """From 1 m before a bend at 0.25 m/s to 1 m behind it: on most ways some tenths of a second more."""
    extra = [one.bends.between.max() for _, one in map(scene, range(16)) if one.bends is not None]
    assert np.median(extra) > 0.1


@pytest.mark.parametrize("seed", range(8))
def test_narrower_cells_go_on_from_those_that_are_known(seed):
    """Twice one round is two rounds, and no bound falls by it."""
    _, one = scene(seed)
    assert one.bends is not None
    once = narrower(one.bends, one.relaxed, 1)
    twice, both = narrower(once, one.relaxed, 1), narrower(one.bends, one.relaxed, 2)
    for name in ("late", "long", "early", "still", "between"):
        assert np.array_equal(getattr(twice, name), getattr(both, name))
        assert np.all(getattr(both, name) >= getattr(one.bends, name) - 1e-9)
    assert one.bends.total - 1e-9 <= once.total <= both.total + 1e-9
