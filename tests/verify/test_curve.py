"""Paths are evaluated to rounding, whatever they are made of."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.verify.arcs import Arc, arc_between, place, to_point, to_ring, to_segment
from coord.verify.curve import curve, pose_at
from coord.verify.quadrature import gauss_legendre

curvatures = st.one_of(st.just(0.0), st.floats(-4.0, 4.0), st.floats(-1e-6, 1e-6))
pieces = st.lists(st.tuples(st.floats(0.01, 5.0), curvatures, curvatures), min_size=1, max_size=5)


def test_the_quadrature_is_exact_for_polynomials():
    """n nodes integrate x^m over [0, 1] exactly up to m = 2n - 1, and not beyond."""
    for n in (1, 2, 5, 8):
        rule = gauss_legendre(n)
        for m in range(2 * n + 1):
            integral = sum(weight * node**m for node, weight in rule)
            assert (abs(integral - 1 / (m + 1)) < 1e-15) == (m < 2 * n)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(pieces=pieces, heading=st.floats(-4, 4))
def test_a_path_ends_where_numerical_integration_ends(build, pieces, heading):
    """Lines, arcs of any turn and clothoids, against Simpson's rule."""
    path = curve((3.0, -2.0, heading), pieces)
    assert path.goal[:2] == pytest.approx(build.end_of([3.0, -2.0, heading], pieces), abs=1e-9)
    assert path.length == pytest.approx(math.fsum(piece[0] for piece in pieces), rel=1e-15)
    assert path.goal[2] == pytest.approx(heading + sum(h * (k0 + k1) / 2 for h, k0, k1 in pieces), abs=1e-12)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(pieces=pieces, share=st.floats(0, 1))
def test_a_path_is_continuous_and_moves_no_faster_than_its_arc_length(pieces, share):
    """Two points are never farther apart than the way between them, and the heading leads from one to the other."""
    path = curve((0.0, 0.0, 0.0), pieces)
    s, h = share * path.length, 1e-4
    x0, y0, angle = pose_at(path, s)
    x1, y1, _ = pose_at(path, s + h)
    step = min(h, path.length - s)
    assert math.hypot(x1 - x0, y1 - y0) <= step + 1e-12
    assert x1 - x0 == pytest.approx(step * math.cos(angle), abs=4 * h * h + 1e-12)
    assert y1 - y0 == pytest.approx(step * math.sin(angle), abs=4 * h * h + 1e-12)


arcs = st.builds(
    lambda x, y, heading, turn, length, error: Arc(
        x, y, math.cos(heading), math.sin(heading), turn / length, length, error
    ),
    *[st.floats(-3, 3)] * 3,
    st.one_of(st.just(0.0), st.floats(-1.5, 1.5), st.floats(-1e-7, 1e-7)).filter(lambda k: k == 0 or abs(k) > 1e-25),
    st.floats(0.05, 5.0),
    st.just(0.0),
)
points = st.tuples(st.floats(-4, 4), st.floats(-4, 4))


def sampled(arc, distance, n=400):
    return min(distance(place(arc, arc.length * i / n)) for i in range(n + 1))


@settings(max_examples=120, deadline=None, derandomize=True)
@given(arc=arcs, q=points)
def test_the_distance_of_a_point_from_an_arc_is_the_least_of_all_samples(arc, q):
    """Never above a sample, and below the best of 400 by no more than their spacing explains; also where it says."""
    distance, u = to_point(arc, q)
    best = sampled(arc, lambda p: math.dist(p, q))
    assert best - arc.length / 800 - 1e-9 <= distance <= best + 1e-9
    assert math.dist(place(arc, u), q) == pytest.approx(distance, abs=1e-9)


@settings(max_examples=120, deadline=None, derandomize=True)
@given(arc=arcs, a=points, b=points)
def test_the_distance_of_a_segment_from_an_arc_is_the_least_of_all_samples(arc, a, b):
    """The same for segments, crossing ones included, whose distance is 0."""
    distance, u = to_segment(arc, a, b)
    segment = Arc(*a, *unit(a, b), 0.0, math.dist(a, b), 0.0)
    best = sampled(arc, lambda p: to_point(segment, p)[0])
    assert best - arc.length / 800 - 1e-9 <= distance <= best + 1e-9
    assert to_point(segment, place(arc, u))[0] == pytest.approx(distance, abs=1e-9)


def unit(a, b):
    size = math.dist(a, b)
    return ((b[0] - a[0]) / size, (b[1] - a[1]) / size) if size else (1.0, 0.0)


def test_crossings_of_slight_arcs_are_found():
    """An arc of radius 1e9 crosses a segment like a line does, and a half-turn away from tangency is no trouble."""
    for k in (0.0, 1e-9, -1e-9, 1e-3, 0.5):
        arc = Arc(0.0, 0.0, 1.0, 0.0, k, 2.0, 0.0)
        distance, u = to_segment(arc, (1.5, -1.0), (1.5, 3.0))
        assert distance < 1e-12
        assert place(arc, u)[0] == pytest.approx(1.5, abs=1e-12)
    assert to_ring(Arc(0.0, 0.0, 1.0, 0.0, 0.1, 2.0, 0.0), ((1.0, 5.0), (2.0, 6.0), (1.0, 6.0)))[0] > 4.5


@settings(max_examples=60, deadline=None, derandomize=True)
@given(k0=st.floats(-2, 2), rate=st.floats(-3, 3), length=st.floats(0.05, 0.5), share=st.floats(0, 1))
def test_a_clothoid_stays_within_the_error_of_its_arc(k0, rate, length, share):
    """|rate| h^3 / 48 holds at every point of the stretch."""
    path = curve((0.0, 0.0, 0.3), [(length, k0, k0 + rate * length)])
    for piece in path.pieces:
        arc = arc_between(piece, piece.begin, piece.end)
        s = piece.begin + share * piece.length
        off = math.dist(pose_at(path, s)[:2], place(arc, s - piece.begin))
        assert off <= arc.error + 1e-14
