"""Bounds of distances lie below every distance, on every interval, however coarse."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from coord.verify.bisection import descend
from coord.verify.curve import curve, point
from coord.verify.motion import Stretch, arc_length, speed
from coord.verify.separation import _curved, _heading, _Leg, _linear
from coord.verify.shapes import CENTRE, disc, gap, minkowski, mirrored, polygon, turned

small = st.floats(-2.0, 2.0)
bodies = st.sampled_from(
    [
        disc(0.2),
        polygon([(-0.6, -0.1), (0.6, -0.1), (0.6, 0.1), (-0.6, 0.1)], True),
        polygon([(-0.3, -0.2), (0.5, -0.2), (0, 0.4)], False),
    ]
)


def legs(bent):
    """A robot on one piece, with one jerk, for two seconds; its speed stays positive."""

    def made(place, heading, k, k1, state, body):
        path = curve((*place, heading), [(2.0, k, k1)] if bent else [(2.0, 0.0, 0.0)])
        stretch = Stretch(0.0, 2.0, 0.0, 0.0, *state, 0)
        return _Leg(body, stretch, path.pieces[0])

    state = st.tuples(st.floats(0, 1), small, st.floats(-6, 6))
    curvature = st.floats(-0.5, 0.5)
    return st.builds(made, st.tuples(small, small), st.floats(-4, 4), curvature, curvature, state, bodies)


def distance(first, second, t):
    k1, k2 = turned(first.body, _heading(first, t)), turned(second.body, _heading(second, t))
    p, q = (point(leg.piece, arc_length(leg.stretch, t)) for leg in (first, second))
    return gap((p[0] - q[0], p[1] - q[1]), minkowski(k2, mirrored(k1)))[0] - first.body.radius - second.body.radius


def usable(leg, t0, t1):
    """Whether the leg neither rolls back nor leaves its piece between two times."""
    times = [t0 + (t1 - t0) * i / 50 for i in range(51)]
    within = all(0 <= arc_length(leg.stretch, t) <= leg.piece.length for t in times)
    return within and all(speed(leg.stretch, t) >= 0 for t in times)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(
    pair=st.one_of(
        st.tuples(legs(False), legs(False)), st.tuples(legs(True), legs(True)), st.tuples(legs(False), legs(True))
    ),
    t0=st.floats(0, 0.5),
    h=st.floats(0.01, 1.5),
)
def test_the_bound_of_two_moving_robots_is_below_every_distance(pair, t0, h):
    """On lines and in bends, with footprints that turn or not; and the value given is a distance."""
    first, second = pair
    t1 = t0 + h
    assume(usable(first, t0, t1) and usable(second, t0, t1))
    bounds = [_curved(first, second)]
    if first.piece.straight and second.piece.straight:
        k1, k2 = turned(first.body, first.piece.heading), turned(second.body, second.piece.heading)
        bounds.append(_linear(first, second, minkowski(k2, mirrored(k1)), t0))
    least = min(distance(first, second, t0 + h * i / 100) for i in range(101))
    for bound in bounds:
        lower, value, at = bound(t0, t1)
        assert lower <= least + 1e-9
        assert value == pytest.approx(distance(first, second, at), abs=1e-9)


def test_robots_that_come_close_between_two_equal_distances():
    """One ahead starts with jerk 6 while the other follows at 1 m/s: 1 + h^3 - h is 1 at both ends, 0.615 inside."""
    line = curve((0.0, 0.0, 0.0), [(9.0, 0.0, 0.0)]).pieces[0]
    ahead = _Leg(disc(0.1), Stretch(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 6.0, 0), line)
    behind = _Leg(disc(0.1), Stretch(0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0), line)
    least = 1 - 2 / 3 * math.sqrt(1 / 3) - 0.2
    for pair in ((ahead, behind), (behind, ahead)):
        for bound in (_linear(*pair, CENTRE, 0.0), _curved(*pair)):
            assert bound(0.0, 1.0)[0] <= least
            assert descend(bound, 0.0, 1.0, 0.0, 9.0).value == pytest.approx(least, abs=1e-6)
