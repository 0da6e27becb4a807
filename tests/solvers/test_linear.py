"""The linear program of motion through a tube, against a second formulation and a second solver."""

from __future__ import annotations

import numpy as np
import pytest

from coord.model.robot import Limits
from coord.solvers.knots import CREEP, Cells
from coord.solvers.linear import farthest, smoothest

UNIT = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def cells(h, limits, *, below=None, above=None, cap=None):
    """Cells with s <= below[1] before cell below[0], s >= above[1] from cell above[0] on, and one slower cell."""
    n = len(h)
    upper, lower, caps = np.full((n, 4), np.inf), np.full((n, 4), -np.inf), np.full(n, limits.speed)
    if below:
        upper[: below[0]] = below[1]
    if above:
        lower[above[0] :] = above[1]
    if cap:
        caps[cap[0]] = cap[1]
    return Cells(np.asarray(h, float), upper, lower, caps)


def random_programs(count, *, tubes):
    """Random limits, cells, caps and (if asked for) tubes that hold back the first half and push on the second."""
    rng = np.random.default_rng(5)
    for k in range(count):
        n = (8, 12, 16, 24, 32, 40, 48, 56, 64)[k % 9]
        limits = Limits(*rng.uniform(0.3, 2.0, 4), 1.0)
        h = rng.uniform(0.1, 0.8, n)
        way = h.sum() * limits.speed
        kind = k % 3 if tubes else -1
        below = (n // 2, rng.uniform(0.03, 0.25) * way) if kind in (0, 2) else None
        above = (n // 2 + 2, rng.uniform(0.03, 0.2) * way) if kind in (1, 2) else None
        cap = (int(rng.integers(1, n - 1)), 0.5 * limits.speed) if rng.integers(2) else None
        yield cells(h, limits, below=below, above=above, cap=cap), limits


def test_without_bounds_the_farthest_place_is_that_of_the_fastest_motion():
    """16 cells of 1 s with speed 1, a = 1/2, j = 1/2: the ramps take 3 s and 1.5 m each, the rest is driven at full speed."""
    limits = Limits(1.0, 0.5, 0.5, 0.5, 0.5)
    assert farthest(cells(np.ones(16), limits), limits) == pytest.approx(16 - 3, abs=1e-5)


def agrees(program, limits, second_opinion):
    """Both solvers call it impossible, or both get equally far and there equally smooth."""
    far, second = farthest(program, limits), second_opinion(program, limits)
    assert (far is None) == (second is None)
    if far is None or second is None:
        return False
    assert far == pytest.approx(second[1], abs=1e-5)
    jerks = smoothest(program, limits, 0.9 * far)
    other = second_opinion(program, limits, 0.9 * far)
    assert (jerks is None) == (other is None)
    if jerks is not None and other is not None:
        assert np.abs(jerks).max() <= limits.jerk + 1e-6
        assert np.sum(program.h * jerks**2) == pytest.approx(other[2], rel=1e-4, abs=1e-6)
    return True


def test_piqp_and_highs_agree_on_programs_with_speed_caps(second_opinion):
    """States as unknowns and PIQP, jerks as unknowns and HiGHS: the same optimum for 27 random programs."""
    assert sum(agrees(*one, second_opinion) for one in random_programs(27, tubes=False)) == 27


def test_piqp_and_highs_agree_on_programs_with_tubes(second_opinion):
    """Upper and lower bounds on s, both or one of them; at least two thirds of the 27 have a solution."""
    assert sum(agrees(*one, second_opinion) for one in random_programs(27, tubes=True)) >= 18


def test_contradicting_bounds_have_no_motion():
    """Below 1 m and above 2 m at once, or a tube that nobody can keep up with, give None, not an error."""
    h = np.full(16, 0.5)
    assert farthest(cells(h, UNIT, below=(16, 1.0), above=(8, 2.0)), UNIT) is None
    assert farthest(cells(h, UNIT, above=(2, 5.0)), UNIT) is None
    assert smoothest(cells(h, UNIT), UNIT, 100.0) is None


def test_more_time_gets_farther(second_opinion):
    """Stretching the last cells never brings the robot less far."""
    reached = [
        farthest(cells([*np.full(12, 0.4), *np.full(4, last)], UNIT, cap=(6, 0.6)), UNIT) for last in (0.2, 0.4, 0.8)
    ]
    assert all(far is not None for far in reached)
    assert reached == sorted(reached)


def test_the_smoothest_motion_keeps_the_tube_and_never_stops_on_its_way():
    """Integrated again, its Bezier points of s keep the bounds, and the speed stays above the creep between the ends."""
    program = cells(np.full(32, 0.5), UNIT, below=(16, 2.0), above=(24, 6.0))
    far = farthest(program, UNIT)
    assert far is not None
    jerks = smoothest(program, UNIT, 0.95 * far)
    assert jerks is not None
    s = v = a = 0.0
    for h, j, upper, lower in zip(program.h, jerks, program.upper, program.lower, strict=True):
        after = (s + h * v + h**2 * a / 2 + h**3 * j / 6, v + h * a + h**2 * j / 2, a + h * j)
        points = np.array([s, s + h * v / 3, s + 2 * h * v / 3 + h**2 * a / 6, after[0]])
        assert np.all(points <= upper + 1e-6)
        assert np.all(points >= lower - 1e-6)
        s, v, a = after
        assert v > -1e-6
    assert (s, v, a) == pytest.approx((0.95 * far, 0.0, 0.0), abs=1e-6)
    assert CREEP > 0


def test_the_same_program_gives_the_same_bytes_whatever_was_solved_before():
    """Solvers are built once a size and used again; they keep no trace of other programs."""
    h = np.full(24, 0.5)
    first, other = cells(h, UNIT, cap=(8, 0.4)), cells(h * 1.7, Limits(2.0, 1.0, 0.7, 3.0, 1.0), cap=(3, 0.9))
    before = farthest(first, UNIT), smoothest(first, UNIT, 3.0)
    farthest(other, Limits(2.0, 1.0, 0.7, 3.0, 1.0))
    after = farthest(first, UNIT), smoothest(first, UNIT, 3.0)
    assert before[0] == after[0]
    assert before[1] is not None
    assert after[1] is not None
    assert before[1].tobytes() == after[1].tobytes()
