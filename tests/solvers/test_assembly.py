"""Programs put together term by term, against optima that are known, and the bound from whatever multipliers."""

from __future__ import annotations

import numpy as np
import pytest

from coord.solvers.assembly import Assembly

INF = np.array([np.inf])


def columns(*which):
    return np.array(which)


def test_the_point_of_a_line_that_is_nearest_to_the_origin():
    """On x + 2 y = 5 the least x^2 + y^2 is at (1, 2); twice half of it is said, once for both and once for each."""
    program = Assembly(2)
    program.squares(np.ones(2), (columns(0, 1), 1.0))
    program.squares(np.ones(1), (columns(0), 1.0))
    program.squares(np.ones(1), (columns(1), 1.0))
    program.rows(np.array([5.0]), np.array([5.0]), (columns(0), 1.0), (columns(1), 2.0))
    found = program.solve()
    assert found.is_solved
    assert found.x == pytest.approx([1.0, 2.0], abs=1e-5)


def test_terms_of_the_same_unknown_add_up():
    """2 x + x >= 6 with x as small as can be: 2."""
    program = Assembly(1)
    program.cost[0] = 1.0
    program.rows(np.array([6.0]), INF, (columns(0), 2.0), (columns(0), 1.0))
    assert program.solve().x == pytest.approx([2.0], abs=1e-5)


def test_what_is_known_to_be_zero_has_no_column():
    """x + 7 z <= 3 where z is known to be zero, with x as large as can be: 3; its box is passed over as well."""
    program = Assembly(1)
    program.cost[0] = -1.0
    program.rows(-INF, np.array([3.0]), (columns(0), 1.0), (columns(-1), 7.0))
    program.box(columns(-1), 5.0, 6.0)
    program.squares(np.ones(1), (columns(-1), 1.0))
    assert program.solve().x == pytest.approx([3.0], abs=1e-5)


def test_boxes_are_added_to_those_before():
    """Within [0, 4] and within [1, 9] is within [1, 4]."""
    program = Assembly(2)
    program.cost[:] = 1.0, -1.0
    program.box(columns(0, 1), 0.0, 4.0)
    program.box(columns(0, 1), 1.0, 9.0)
    program.rows(-INF, np.array([100.0]), (columns(0), 1.0))
    assert program.solve().x == pytest.approx([1.0, 4.0], abs=1e-5)


@pytest.mark.parametrize("noise", [0.0, 1e-3, 1.0, 100.0])
@pytest.mark.parametrize("seed", range(5))
def test_no_multipliers_make_the_bound_greater_than_the_optimum(seed, noise):
    """Random linear programs with rows bounded on one side, on both and by the same: with the solver's it is close."""
    rng = np.random.default_rng(seed)
    n, m = 6, 9
    program, some = Assembly(n, 1e-9), rng.uniform(0.2, 0.8, n)
    program.cost[:] = rng.normal(size=n)
    program.box(np.arange(n), 0.0, 1.0)
    matrix = rng.normal(size=(m, n))
    low, high = matrix @ some - rng.uniform(0, 1, m), matrix @ some + rng.uniform(0, 1, m)
    low[:3], high[3:6] = -np.inf, np.inf
    low[-1] = high[-1] = matrix[-1] @ some
    program.rows(low, high, *((np.full(m, k), matrix[:, k]) for k in range(n)))
    found = program.solve()
    optimum = float(program.cost @ found.x)
    bound = program.least_cost(found.multipliers + rng.normal(0, noise, m) if noise else found.multipliers)
    assert bound <= optimum + 1e-6
    if not noise:
        assert bound == pytest.approx(optimum, abs=1e-5)
