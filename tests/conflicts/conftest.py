"""Paths and motions for the tests of conflicts, and the plain truth about them by dense sampling."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from coord.conflicts.chords import chords
from coord.conflicts.core import conflict_core
from coord.conflicts.region import conflict_regions
from coord.conflicts.rest import runs_over
from coord.model.footprint import Footprint, polygon, square
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest


def _wild_path(rng, kinds=("line", "arc", "clothoid")):
    """Up to four pieces within about 10 m, of the given kinds."""
    rows = []
    for _ in range(rng.integers(1, 5)):
        kind = rng.choice(kinds)
        k0, k1 = rng.uniform(-1.5, 1.5, 2)
        bends = {"line": (0.0, 0.0), "arc": (k0, k0), "clothoid": (k0, k1)}[kind]
        length = rng.uniform(0.3, 4.0) if kind == "line" else rng.uniform(0.2, 0.9) / max(map(abs, bends))
        rows.append((length, *bends))
    return Path((rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-math.pi, math.pi)), rows)


def _stop_and_go(rng, length, limits):
    """Rest to rest over a length in one to three goes, with pauses in between, departing after a while."""
    cuts = np.sort(rng.uniform(0.05, 0.95, rng.integers(0, 3))) * length
    parts = np.diff(np.concatenate([[0.0], cuts, [length]]))
    times, states, jerks, at = [rng.choice([0.0, rng.uniform(0.0, 5.0)])], [(0.0, 0.0, 0.0)], [], 0.0
    for part in parts.tolist():
        if jerks:
            times.append(times[-1] + rng.uniform(0.5, 6.0))
            states.append((at, 0.0, 0.0))
            jerks.append(0.0)
        go = rest_to_rest(part, limits)
        times += (times[-1] + go.times[1:]).tolist()
        states += [(at + s, v, a) for s, v, a in go.states[1:].tolist()]
        jerks += go.jerks.tolist()
        at = states[-1][0]
    return VelocityProfile(times, states, jerks)


@pytest.fixture(scope="session")
def wild_path():
    """(rng, kinds) -> a path."""
    return _wild_path


@pytest.fixture(scope="session")
def stop_and_go():
    """(rng, length, limits) -> a motion with pauses."""
    return _stop_and_go


@pytest.fixture(scope="session")
def drives():
    """rng -> limits."""
    return lambda rng: Limits(*rng.uniform((0.3, 0.2, 0.2, 0.3, 0.2), (2.5, 1.5, 1.5, 4.0, 1.5)).tolist())


def _distances(ego, other, s, sigma):
    """(len(s), len(sigma)) true distances between the points of two paths."""
    gap = ego.point(s)[:, None] - other.point(sigma)[None]
    return np.hypot(gap[..., 0], gap[..., 1])


def _wild_pairs(seed, count, kinds, least=0.2, places=240):
    """Pairs of random paths, how near they may come, places on both, and the true distances between these."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        ego, other, reach = _wild_path(rng, kinds), _wild_path(rng, kinds), rng.uniform(least, 1.2)
        s, sigma = np.linspace(0, ego.length, places), np.linspace(0, other.length, 250)
        yield ego, other, reach, s, sigma, _distances(ego, other, s, sigma)


@pytest.fixture(scope="session")
def wild_pairs():
    """(seed, count, kinds) -> pairs of paths with their truth."""
    return _wild_pairs


@pytest.fixture(scope="session")
def distances():
    """(ego, other, s, sigma) -> all true distances."""
    return _distances


def _ends(ego, other, reach):
    """The exact tests at ego's start and goal, as the regions need them."""
    start, goal = tuple(ego.poses[0, :2].tolist()), ego.end
    return {"start_free": runs_over(other, start, reach) is None, "goal_free": runs_over(other, goal, reach) is None}


@pytest.fixture(scope="session")
def regions():
    """(ego, other, reach) -> regions with the ends as the planner sets them."""
    return lambda ego, other, reach: conflict_regions(chords(ego), chords(other), reach, **_ends(ego, other, reach))


def _forbidden(found, s, sigma):
    """(len(s), len(sigma)) whether the regions forbid it; where two cells meet, either counts."""
    taken = np.zeros((len(s), len(sigma)), bool)
    for region in found:
        nodes = region.sigma
        for k in range(len(nodes) - 1):
            inside = (sigma >= nodes[k]) & (sigma <= nodes[k + 1])
            width = nodes[k + 1] - nodes[k]
            share = (sigma[inside] - nodes[k]) / width if width > 0 else np.zeros(inside.sum())
            low = region.low[k, 0] + (region.low[k, 1] - region.low[k, 0]) * share
            high = region.high[k, 0] + (region.high[k, 1] - region.high[k, 0]) * share
            taken[:, inside] |= (s[:, None] > low[None]) & (s[:, None] < high[None])
    return taken


@pytest.fixture(scope="session")
def forbidden():
    """(regions, s, sigma) -> table of what is forbidden."""
    return _forbidden


def _regular(corners, radius, turn=0.0):
    """A footprint with so many corners on a circle, the first at an angle, that keeps its heading."""
    angles = turn + 2 * math.pi * np.arange(corners) / corners
    return polygon((radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)).tolist(), "fixed")


@pytest.fixture(scope="session")
def regular():
    """(corners, radius, turn) -> a regular polygon."""
    return _regular


def _wild_shape(rng):
    """A disc, a square, a regular polygon turned at will or a lopsided triangle, of 0.1 to 0.7 m."""
    kind = rng.integers(4)
    if kind == 0:
        return Footprint(rng.uniform(0.1, 0.6))
    if kind == 1:
        return square(rng.choice([0.3, 0.6, 1.1]))
    if kind == 2:
        return _regular(rng.integers(3, 8), rng.uniform(0.2, 0.7), rng.uniform(0, 7))
    return polygon((rng.uniform(0.1, 0.7, (3, 1)) * [[-1.0, -0.3], [0.9, -0.2], [0.1, 1.0]]).tolist(), "fixed")


@pytest.fixture(scope="session")
def wild_shape():
    """rng -> a footprint."""
    return _wild_shape


def _body(footprint):
    """What the core of a footprint is to shapely."""
    return shapely.MultiPoint(footprint.core).convex_hull


def _gaps(ego, other, s, sigma, shapes):
    """(len(s), len(sigma)) true distances between the bodies of two robots, 0 where they overlap."""
    bodies = [
        shapely.transform(np.repeat(_body(shape), len(at)), lambda xy, at=at: _moved(xy, at))
        for shape, at in zip(shapes, (ego.point(s), other.point(sigma)), strict=True)
    ]
    gap = shapely.distance(bodies[0][:, None], bodies[1][None])
    return np.maximum(gap - shapes[0].margin - shapes[1].margin, 0.0)


def _moved(xy, at):
    return xy + np.repeat(at, len(xy) // len(at), axis=0)


@pytest.fixture(scope="session")
def gaps():
    """(ego, other, s, sigma, (ego's, other's footprint)) -> all true distances between their bodies."""
    return _gaps


def _shape_regions(ego, other, shapes, clearance):
    """Regions of two footprints with the ends as the planner sets them."""
    mine, theirs = shapes
    reach = mine.margin + theirs.margin + clearance
    seen = conflict_core(theirs.core, mine.core)
    free = [runs_over(other, tuple(place), reach, seen) is None for place in (ego.poses[0, :2].tolist(), ego.end)]
    core = conflict_core(mine.core, theirs.core)
    return conflict_regions(chords(ego), chords(other), reach, core, start_free=free[0], goal_free=free[1])


@pytest.fixture(scope="session")
def shape_regions():
    """(ego, other, (ego's, other's footprint), clearance) -> regions."""
    return _shape_regions
