"""One turn of a path: clothoid, arc, clothoid, touching a disc in its middle.

The curve turns by an angle phi with the peak curvature 1/R; on each side a share f of half the turn is made by
a clothoid, the rest by the arc. Its middle touches the disc (centre, rho) from outside. Then both tangents are
tangents of a larger disc about the same centre, of radius m = R P_y + rho cos(phi/2), and the curve begins a
length l = R P_x - rho sin(phi/2) before the foot of the centre on the tangent; (P_x, P_y) is the middle of the
curve with R = 1 that starts at the origin along the x axis.
"""

from __future__ import annotations

import math
from functools import lru_cache


@lru_cache(maxsize=65536)
def middle(half_turn: float, share: float) -> tuple[float, float]:
    """(P_x, P_y) of the curve with peak curvature 1, for half a turn [rad] and the clothoid's share of it."""
    # the clothoid turns by tau over the length 2 tau; its ends are power series in tau (Fresnel integrals)
    tau = share * half_turn
    x = y = 0.0
    term, n = 2 * tau, 0
    while abs(term) > 1e-17:
        x += term / (4 * n + 1)
        term *= tau / (2 * n + 1)
        y += term / (4 * n + 3)
        term *= -tau / (2 * n + 2)
        n += 1
    begin, end = share * half_turn, half_turn
    return x + math.sin(end) - math.sin(begin), y + math.cos(begin) - math.cos(end)


def effective_radius(radius: float, rho: float, turn: float, share: float) -> float:
    """Radius m [m] of the disc whose tangents the curve joins."""
    _, y = middle(turn / 2, share)
    return radius * y + rho * math.cos(turn / 2)


def lead_in(radius: float, rho: float, turn: float, share: float) -> float:
    """Length l [m] on each tangent that the curve takes away."""
    x, _ = middle(turn / 2, share)
    return radius * x - rho * math.sin(turn / 2)


def pieces(radius: float, turn: float, share: float, side: int) -> list[tuple[float, float, float]]:
    """The curve as pieces of linear curvature: length, curvature at the start and at the end."""
    curvature = side / radius
    clothoid, arc = share * turn * radius, (1 - share) * turn * radius
    parts = [(clothoid, 0.0, curvature), (arc, curvature, curvature), (clothoid, curvature, 0.0)]
    return [part for part in parts if part[0] > 0]
