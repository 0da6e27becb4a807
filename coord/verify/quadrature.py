"""Gauss-Legendre quadrature on [0, 1], its nodes found here from the Legendre polynomials."""

from __future__ import annotations

import math
from typing import Final


def _legendre(n: int, x: float) -> tuple[float, float]:
    """P_n and its derivative at x, by the three-term recurrence."""
    before, value = 1.0, x
    for k in range(2, n + 1):
        before, value = value, ((2 * k - 1) * x * value - (k - 1) * before) / k
    return value, n * (x * value - before) / (x * x - 1)


def gauss_legendre(n: int) -> tuple[tuple[float, float], ...]:
    """Nodes and weights (n pairs) that integrate polynomials of degree 2n - 1 over [0, 1] exactly.

    Newton's method on P_n from the usual cosine guesses; weight 2 / ((1 - x^2) P_n'(x)^2) on [-1, 1].
    """
    rule = []
    for i in range(n, 0, -1):
        x = math.cos(math.pi * (i - 0.25) / (n + 0.5))
        for _ in range(8):
            value, slope = _legendre(n, x)
            x -= value / slope
        _, slope = _legendre(n, x)
        rule.append(((1 + x) / 2, 1 / ((1 - x * x) * slope * slope)))
    return tuple(rule)


#: Eight nodes: on stretches that turn by 1 rad at most the remainder drowns in rounding.
NODES: Final = gauss_legendre(8)
