"""No point of a moving footprint bends faster than the bound says."""

from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from coord.verify.support import bend

small = st.floats(-2.0, 2.0)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(
    angle=st.floats(-4, 4),
    heading=st.floats(-4, 4),
    k=small,
    rate=small,
    state=st.tuples(st.floats(0, 2), small, small),
    h=st.floats(0.01, 0.5),
    corner=st.tuples(small, small),
    turning=st.booleans(),
)
def test_second_derivatives_stay_below_the_bound(angle, heading, k, rate, state, h, corner, turning):
    """n.x'' at 41 times, from x = p + R(theta) w, theta' = k v, theta'' = k a + k' v^2, is never above it."""
    n = (math.cos(angle), math.sin(angle))
    v0, a0, j = state

    def moving(t):
        s, v, a = t * (v0 + t * (a0 / 2 + t * j / 6)), v0 + t * (a0 + t * j / 2), a0 + t * j
        return s, v, a, k + rate * s, heading + s * (k + rate * s / 2)

    samples = [moving(h * i / 40) for i in range(41)]
    middle = samples[20]
    turn = max(abs(sample[4] - middle[4]) for sample in samples)
    monotone = all(sample[1] >= 0 for sample in samples)
    if not monotone:
        return
    w = corner if turning else (0.0, 0.0)
    bound = bend(
        n,
        middle[4],
        turn,
        (samples[0][3], samples[-1][3]),
        rate,
        (samples[0][2], samples[-1][2]),
        max(sample[1] for sample in samples),
        math.hypot(*w),
    )
    largest = -math.inf
    for _, v, a, bent, theta in samples:
        c, s = math.cos(theta), math.sin(theta)
        x, y = c * w[0] - s * w[1], s * w[0] + c * w[1]
        first, second = bent * v, bent * a + rate * v * v
        ax = a * c - bent * v * v * s - second * y - first * first * x
        ay = a * s + bent * v * v * c + second * x - first * first * y
        largest = max(largest, n[0] * ax + n[1] * ay)
    assert largest <= bound + 1e-9


def test_the_bound_is_exact_where_nothing_turns():
    """On a line n.x'' is a n.T; there is nothing to add."""
    assert bend((0.6, 0.8), 0.0, 0.0, (0.0, 0.0), 0.0, (-1.0, 0.5), 3.0, 0.0) == 0.3
    assert bend((0.0, 1.0), 0.0, 0.0, (0.0, 0.0), 0.0, (-1.0, 0.5), 3.0, 0.0) == 0.0
    assert bend((0.0, 1.0), 0.0, 0.0, (0.5, 0.5), 0.0, (0.0, 0.0), 3.0, 0.0) == 4.5
    assert bend((0.0, -1.0), 0.0, 0.0, (0.5, 0.5), 0.0, (0.0, 0.0), 3.0, 0.0) == 0.0
