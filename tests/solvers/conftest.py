"""A second way to the answers of the linear program: only jerks as unknowns, solved by HiGHS."""

from __future__ import annotations

import casadi
import numpy as np
import pytest


def _rows(h):
    """Rows of s, v, a at the knots, of s at the inner and v at the middle Bezier points, all linear in the jerks."""
    n = len(h)
    state, knots, inner, middle = np.zeros((3, n)), [np.zeros((3, n))], [], []
    for k in range(n):
        s, v, a = state
        inner += [s + h[k] * v / 3, s + 2 * h[k] * v / 3 + h[k] ** 2 * a / 6]
        middle.append(v + h[k] * a / 2)
        one = np.eye(n)[k]
        after_v = v + h[k] * a + h[k] ** 2 / 2 * one
        state = np.array([s + h[k] * v + h[k] ** 2 / 2 * a + h[k] ** 3 / 6 * one, after_v, a + h[k] * one])
        knots.append(state)
    return np.array(knots), np.array(inner), np.array(middle)


def _solve(cells, limits, length=None):
    h = np.asarray(cells.h)
    n = len(h)
    knots, inner, middle = _rows(h)
    upper, lower = np.asarray(cells.upper), np.asarray(cells.lower)
    rows, low, high = [], [], []

    def add(part, least, most):
        rows.append(part)
        low.append(np.broadcast_to(least, len(part)))
        high.append(np.broadcast_to(most, len(part)))

    for column, at in ((0, knots[:-1, 0]), (1, inner[0::2]), (2, inner[1::2]), (3, knots[1:, 0])):
        add(at, lower[:, column], upper[:, column])
    for at in (knots[:-1, 1], knots[1:, 1], middle):
        add(at, 0.0, np.minimum(cells.caps, limits.speed))
    add(knots[:, 2], -limits.deceleration, limits.acceleration)
    add(knots[-1:, 1], 0.0, 0.0)
    add(knots[-1:, 2], 0.0, 0.0)
    if length is not None:
        add(knots[-1:, 0], length, length)
    A, low, high = np.vstack(rows), np.concatenate(low), np.concatenate(high)
    weight = np.zeros(n) if length is None else h
    gradient = -knots[-1, 0] if length is None else np.zeros(n)
    H, A = casadi.DM(casadi.Sparsity.diag(n), weight), casadi.DM(A)
    options = {"error_on_fail": False, "highs": {"output_flag": False}}
    solver = casadi.conic("second", "highs", {"h": H.sparsity(), "a": A.sparsity()}, options)
    bounds = {"lba": np.maximum(low, -1e9), "uba": np.minimum(high, 1e9)}
    found = solver(h=H, g=gradient, a=A, lbx=-limits.jerk, ubx=limits.jerk, **bounds)
    if not solver.stats()["success"]:
        return None
    jerks = np.asarray(found["x"]).ravel()
    return jerks, float(knots[-1, 0] @ jerks), float(np.sum(h * jerks**2))


@pytest.fixture(scope="session")
def second_opinion():
    """(cells, limits, length or None) -> jerks, how far they get [m], sum of h j^2; None where there is no motion."""
    return _solve
