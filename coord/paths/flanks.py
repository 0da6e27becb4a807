"""One detour as an exponential rise, a flat top and an exponential fall.

The flanks are fits y = A exp(B x), by least squares in ln y:

    B = (n Sum(x ln y) - Sum x Sum ln y) / (n Sum x^2 - (Sum x)^2)
    ln A = (Sum ln y Sum x^2 - Sum x Sum(x ln y)) / (n Sum x^2 - (Sum x)^2)

to the upper hull of the envelope and of one foot on either side of it. A fit lies below some of its points, and
two flanks meet in a corner; so the fits are raised above the hull, joined with the flat top h by
y = (rise^-p + h^-p + fall^-p)^(-1/p), and all of it is raised until it clears the envelope. Then come
the feet.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from coord.model.arrays import Array
from coord.model.route import Fit
from coord.paths.detours import Detour
from coord.paths.feet import Foot, fitting
from coord.tolerances import SAME_PLACE

#: Points of the hull that a flank is fitted to.
_POINTS = 60

#: [1] Error of ln y where the curve is cut, and rounds at most to get there.
_CONVERGED, _MOST_ROUNDS = 1e-12, 50


@dataclass(frozen=True, slots=True, eq=False)
class Flanks:
    """The fitted flanks of a detour; ``rise`` and ``fall`` : points (n, 2) [m] of the hull that they are fitted to.

    ``lifts`` : by how much ln y of rise and fall must be raised to lie above these points.
    """

    detour: Detour
    fits: tuple[Fit, Fit]
    lifts: tuple[float, float]
    rise: Array
    fall: Array


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """The joined curve y(x): ``raised`` times as high as its formula says, ``extra`` times as high as it has to be."""

    flanks: Flanks
    p: float
    extra: float
    raised: float
    left: Foot
    right: Foot

    @property
    def at_angle(self) -> tuple[bool, bool]:
        """Whether it leaves the line, and comes back to it, at an angle."""
        return self.left.at_angle, self.right.at_angle

    @property
    def first(self) -> float:
        """Where the curve leaves the line: x [m]."""
        return self.left.x - self.left.length

    @property
    def last(self) -> float:
        """Where the curve is back on the line: x [m]."""
        return self.right.x + self.right.length

    def __call__(self, x: Array) -> tuple[Array, Array, Array]:
        """Height y [m], y' [1] and y'' [1/m] at x (n,) [m]."""
        y, m, v = _joined(self.flanks, self.p, self.raised, x)
        values = np.stack([y, y * m, y * (m * m + v)])
        for sign, foot in ((1.0, self.left), (-1.0, self.right)):
            outside = sign * (x - foot.x) < 0
            values[:, outside] = foot.below(sign * (x[outside] - foot.x)) * np.array([[1.0], [sign], [1.0]])
        return values[0], values[1], values[2]


def flanks(detour: Detour, reach: tuple[float, float], shares: tuple[float, float]) -> Flanks | None:
    """Fit both flanks, with feet ``reach`` [m] before and behind the envelope; None where a flank is upright.

    ``shares`` : of the height, between which points are fitted. What is higher belongs to the flat top: along a roof
    that hardly rises an exponential would hardly fall, and would need a floor's length to do so.
    """
    x = np.concatenate([[detour.first - reach[0]], detour.x, [detour.last + reach[1]]])
    y = np.concatenate([[0.0], detour.envelope, [0.0]])
    hull = _upper_hull(x, y)
    tops = hull[hull[:, 1] >= detour.height * (1 - 1e-9)]
    rise = _points(hull[hull[:, 0] <= tops[0, 0]], shares, detour.height)
    fall = _points(hull[hull[:, 0] >= tops[-1, 0]][::-1] * (-1, 1), shares, detour.height) * (-1, 1)
    if any(np.ptp(points[:, 0]) < SAME_PLACE or points[:, 1].min() <= 0 for points in (rise, fall)):
        return None
    up, lift_up = _fit("rise", rise, detour.middle)
    down, lift_down = _fit("fall", fall, detour.middle)
    return Flanks(detour, (up, down), (lift_up, lift_down), rise, fall)


def curve(flanks: Flanks, p: float, extra: float, at_angle: tuple[bool, bool]) -> Curve | None:
    """The curve that clears the envelope, raised by the factor ``extra`` beyond that; None where it needs more room.

    ``at_angle`` : whether its first and its last foot go to the ends of the detour's room, and meet the line there.
    """
    detour = flanks.detour
    y, _, _ = _joined(flanks, p, 1.0, detour.x)
    raised = float((detour.envelope / y).max()) * extra
    feet: list[Foot] = []
    for side, room in ((0, detour.middle - detour.least), (1, detour.most - detour.middle)):
        cut_at = partial(_foot, flanks, p, raised, side)
        foot = fitting(cut_at, detour.middle, room, at_angle=at_angle[side])
        if foot is None:
            return None
        feet.append(foot)
    return Curve(flanks, p, extra, raised, feet[0], feet[1])


def _upper_hull(x: Array, y: Array) -> Array:
    """Upper hull (n, 2) of points with increasing x (Andrew's monotone chain)."""
    hull: list[tuple[float, float]] = []
    for px, py in zip(x.tolist(), y.tolist(), strict=True):
        while len(hull) > 1:
            (ax, ay), (bx, by) = hull[-2], hull[-1]
            if (bx - ax) * (py - ay) - (by - ay) * (px - ax) < 0:
                break
            hull.pop()
        hull.append((px, py))
    return np.array(hull)


def _points(hull: Array, shares: tuple[float, float], height: float) -> Array:
    """Points on the rising hull, evenly spaced in x, between two shares of the height."""
    begin, end = np.interp([share * height for share in shares], hull[:, 1], hull[:, 0]).tolist()
    x = np.linspace(begin, end, _POINTS)
    return np.column_stack([x, np.interp(x, hull[:, 0], hull[:, 1])])


def _fit(flank: str, points: Array, middle: float) -> tuple[Fit, float]:
    """The least-squares fit of ln y, and its largest residual."""
    x, ln_y = points[:, 0] - middle, np.log(points[:, 1])
    # centred: the sums of the formula lose no digits then
    centre, level = math.fsum(x.tolist()) / len(x), math.fsum(ln_y.tolist()) / len(x)
    dx, dy = x - centre, ln_y - level
    squares = math.fsum((dx * dx).tolist())
    B = math.fsum((dx * dy).tolist()) / squares
    ln_A = level - B * centre
    residual = ln_y - (ln_A + B * x)
    spread = math.fsum((dy * dy).tolist())
    r_squared = 1 - math.fsum((residual * residual).tolist()) / spread
    return Fit(flank, math.exp(ln_A), B, r_squared), float(residual.max())


def _joined(flanks: Flanks, p: float, raised: float, x: Array) -> tuple[Array, Array, Array]:
    """Height y [m], (ln y)' [1/m] and (ln y)'' [1/m2] of the joined curve.

    ln y is a smooth minimum of three straight lines in x: its slope is their mean slope, weighted with
    w_i ~ exp(-p g_i), and its second derivative -p times the variance of the slopes.
    """
    u = x - flanks.detour.middle
    rise, fall = flanks.fits
    lines = np.stack(
        [
            math.log(rise.A) + flanks.lifts[0] + rise.B * u,
            np.full(len(u), math.log(flanks.detour.height)),
            math.log(fall.A) + flanks.lifts[1] + fall.B * u,
        ]
    )
    slopes = np.array([[rise.B], [0.0], [fall.B]])
    least = lines.min(axis=0)
    weights = np.exp(-p * (lines - least))
    total = weights.sum(axis=0)
    share = weights / total
    mean = (share * slopes).sum(axis=0)
    variance = (share * (slopes - mean) ** 2).sum(axis=0)
    return raised * np.exp(least - np.log(total) / p), mean, -p * variance


def _foot(flanks: Flanks, p: float, raised: float, side: int, share: float) -> Foot:
    """Where the rise (side 0) or the fall (1) has a share of the detour's height, with a foot of length 1/B."""
    fit, lift = flanks.fits[side], flanks.lifts[side]
    cut = share * flanks.detour.height
    # the joined curve is below its rise, so it reaches the height of the cut later than the rise does; ln y is
    # concave, so Newton's method comes from there and never passes
    x = flanks.detour.middle + (math.log(cut / raised) - math.log(fit.A) - lift) / fit.B
    for _ in range(_MOST_ROUNDS):
        y, m, v = (float(value[0]) for value in _joined(flanks, p, raised, np.array([x])))
        missing = math.log(cut / y)
        if missing < _CONVERGED:
            break
        x += missing / m
    return Foot(x, y, y * abs(m), y * (m * m + v), 1 / abs(m))
