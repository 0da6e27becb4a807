"""Distances of paths from things that stand still: bounds lie below every distance, on every stretch."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.verify.approach import _clothoid, _swept, _to_edge, approach, inside_edge, resting
from coord.verify.curve import curve, heading, point, pose_at
from coord.verify.shapes import disc, minkowski, mirrored, polygon, support, turned

BOX = [(-0.6, -0.1), (0.6, -0.1), (0.6, 0.1), (-0.6, 0.1)]
small = st.floats(-2.0, 2.0)
bodies = st.sampled_from([disc(0.2), polygon(BOX, True), polygon(BOX, False)])
stills = st.sampled_from([((0.0, 0.0),), ((-1.0, 0.0), (1.0, 0.5)), ((-1.0, -1.0), (1.0, -1.0), (0.0, 1.0))])
paths = st.builds(
    lambda place, angle, length, k0, k1: curve((*place, angle), [(length, k0, k1)]),
    st.tuples(small, small),
    st.floats(-4, 4),
    st.floats(0.1, 3.0),
    small,
    small,
)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(path=paths, body=bodies, still=stills, share=st.tuples(st.floats(0, 1), st.floats(0, 1)))
def test_bounds_are_below_every_distance(path, body, still, share):
    """Of support functions for every footprint, of arcs for those that keep their heading, and for edges."""
    for piece in path.pieces:
        lo, hi = sorted(piece.begin + u * piece.length for u in share)
        poses = [(*point(piece, s), heading(piece, s)) for s in (lo + (hi - lo) * i / 60 for i in range(61))]
        least = min(resting(body, pose, still, 0.1) for pose in poses)
        bounds = [_swept(piece, body, still, 0.1)]
        if not body.turning:
            bounds.append(_clothoid(piece, body, minkowski(still, mirrored(body.ring)), still, 0.1))
        for bound in bounds:
            lower, value, at = bound(lo, hi)
            assert lower <= least + 1e-9
            pose = (*point(piece, at), heading(piece, at))
            assert value == pytest.approx(resting(body, pose, still, 0.1), abs=1e-9)
        reach = max(pose[0] + support(turned(body, pose[2]), 1.0, 0.0) + body.radius for pose in poses)
        assert _to_edge(piece, body, (1.0, 0.0), 5.0)(lo, hi)[0] <= 5.0 - reach + 1e-9


@pytest.mark.parametrize("half", [0.1, 0.4, 0.7])
def test_a_bend_hangs_below_its_chord(half):
    """Both ends of an arc are equally far from a point below it; its middle is nearer by 1 - cos."""
    path = curve((-math.sin(half), 1 - math.cos(half), -half), [(2 * half, 1.0, 1.0)])
    (piece,) = path.pieces
    still = ((0.0, -1.0),)
    assert _swept(piece, disc(0.2), still, 0.0)(0.0, 2 * half)[0] <= 0.8
    assert _to_edge(piece, disc(0.2), (0.0, -1.0), 1.0)(0.0, 2 * half)[0] <= 0.8
    assert approach(path, disc(0.2), (0.0, 2 * half), still, 0.0, (0.0, 9.0)).value == pytest.approx(0.8, abs=1e-9)


@settings(max_examples=50, deadline=None, derandomize=True)
@given(path=paths, body=bodies, still=stills, share=st.tuples(st.floats(0, 1), st.floats(0, 1)))
def test_the_least_distance_on_a_stretch_is_that_of_the_samples(path, body, still, share):
    """Within what 1 mm steps can miss, wherever the stretch begins and ends, even where it is a single place."""
    lo, hi = sorted(u * path.length for u in share)
    least = approach(path, body, (lo, hi), still, 0.1, (-9.0, 99.0))
    n = math.ceil((hi - lo) / 1e-3) + 1
    seen = min(resting(body, pose_at(path, lo + (hi - lo) * i / n), still, 0.1) for i in range(n + 1))
    assert seen - 2e-3 <= least.value <= seen + 1e-6
    assert lo - 1e-9 <= least.at <= hi + 1e-9
    assert resting(body, pose_at(path, least.at), still, 0.1) == pytest.approx(least.value, abs=1e-9)


@pytest.mark.parametrize("body", [disc(0.2), polygon([(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)], True)])
@pytest.mark.parametrize("bend", [0.0, 0.3])
def test_a_path_deep_inside_something_is_as_deep_as_it_is(body, bend):
    """Far from its outline on all sides: the distance is negative, not that from the outline."""
    path = curve((4.0, 5.0, 0.0), [(2.0, bend, bend)])
    block = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))
    least = approach(path, body, (0.0, 2.0), block, 0.0, (0.05, 0.05))
    depths = [resting(body, pose_at(path, 0.02 * i), block, 0.0) for i in range(101)]
    assert least.value < -4.0
    assert least.value == pytest.approx(min(depths), abs=1e-2)


def test_the_edge_is_left_between_the_ends_of_a_bend():
    """An arc that peaks at no simple share of its length."""
    path = curve((0.0, 0.0, 0.4), [(1.0, -1.0, -1.0)])
    least = inside_edge(path, disc(0.2), (0.0, 1.0), 0.4, 0.3)
    assert least.value == pytest.approx(0.4 - 0.2 - (1 - math.cos(0.4)), abs=1e-6)
    assert least.at == pytest.approx(0.4, abs=1e-2)
