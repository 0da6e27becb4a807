"""One turn: clothoid, arc, clothoid about a disc."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.model.path import Path
from coord.paths.turns import effective_radius, lead_in, middle, pieces

half_turns, shares = st.floats(0.01, 1.5), st.sampled_from([0.0, 0.3, 0.5, 1.0])


@settings(deadline=None, derandomize=True, max_examples=100)
@given(half_turns, shares)
def test_the_middle_of_the_unit_curve_is_that_of_the_path(half, share):
    """The series give the place that the path's own evaluation gives, within 1e-9 m; the whole curve turns by twice half."""
    curve = Path((0.0, 0.0, 0.0), pieces(1.0, 2 * half, share, 1))
    assert curve.poses[-1, 2] == pytest.approx(2 * half, abs=1e-12)
    assert curve.pose(curve.length / 2)[0] == pytest.approx((*middle(half, share), half), abs=1e-9)


@settings(deadline=None, derandomize=True, max_examples=100)
@given(half_turns, shares, st.floats(0.1, 2.0), st.floats(1.0, 5.0), st.sampled_from([1, -1]))
def test_the_curve_touches_its_disc_in_the_middle_and_joins_both_tangents(half, share, rho, ratio, side):
    """Placed by lead-in and effective radius it is never nearer to the centre than rho, reaches it in the middle, ends on the tangent."""
    radius, turn = rho * ratio, 2 * half
    m, lead = effective_radius(radius, rho, turn, share), lead_in(radius, rho, turn, share)
    curve = Path((-lead, -side * m, 0.0), pieces(radius, turn, share, side))
    distance = np.hypot(*curve.point(np.linspace(0, curve.length, 501)).T)
    assert distance.min() == pytest.approx(rho, abs=1e-7 * (1 + radius))
    assert distance[250] == pytest.approx(rho, abs=1e-7 * (1 + radius))
    # the foot of the centre on the second tangent lies a lead-in behind the curve's end
    c, s = math.cos(turn), side * math.sin(turn)
    foot = (m * math.sin(turn), -side * m * math.cos(turn))
    assert curve.end == pytest.approx((foot[0] + lead * c, foot[1] + lead * s), abs=1e-7 * (1 + radius))
    assert np.abs(curve.pieces[:, 1:]).max() == pytest.approx(1 / radius)


def test_without_clothoids_and_at_the_discs_radius_it_is_the_arc_itself():
    """R = rho, share 0: the effective radius is rho, nothing leads in."""
    assert effective_radius(0.7, 0.7, 1.2, 0.0) == pytest.approx(0.7)
    assert lead_in(0.7, 0.7, 1.2, 0.0) == pytest.approx(0.0, abs=1e-15)
    assert pieces(0.7, 1.2, 0.0, -1) == [pytest.approx((0.84, -1 / 0.7, -1 / 0.7))]
