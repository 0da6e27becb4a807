"""How far a support function can sink between two places: the bound that turns two evaluations into a proof.

A function with f'' <= B on [a, b], B >= 0, hangs below its chord by (b - a)^2 / 8 * B at most, so
min f >= min(f(a), f(b)) - (b - a)^2 / 8 * B. The least of several such functions obeys the same.
"""

from __future__ import annotations

import math


def bend(
    n: tuple[float, float],
    heading: float,
    turn: float,
    curvatures: tuple[float, float],
    rate: float,
    accelerations: tuple[float, float],
    speed: float,
    corner: float,
) -> float:
    """An upper bound of n.x'' over all points x of a moving body [m/s2], maybe negative.

    x'' = a T + k v^2 N for the reference point; a corner at distance rho from it adds
    rho (k^2 v^2 + |k a| + |k'| v^2) at most if the body turns with its path.

    Parameters
    ----------
    n : unit vector.
    heading, turn : heading [rad] somewhere in the interval, and how far it is from it anywhere in there.
    curvatures, accelerations : at both ends of the interval; both are linear in between.
    rate : change of curvature by arc length [1/m2].
    speed : largest in the interval [m/s].
    corner : rho [m], 0 for what does not turn.
    """
    c, s = math.cos(heading), math.sin(heading)
    along, aside = n[0] * c + n[1] * s, n[1] * c - n[0] * s
    (k0, k1), (a0, a1) = curvatures, accelerations
    k, a, square = max(abs(k0), abs(k1)), max(abs(a0), abs(a1)), speed * speed
    bound = max(a0 * along, a1 * along) + a * turn + square * (max(0.0, k0 * aside, k1 * aside) + k * turn)
    if corner:
        bound += corner * (k * k * square + k * a + abs(rate) * square)
    return bound
