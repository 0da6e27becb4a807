"""Proof by halving: a function is nowhere below a value, or a place is shown where it is."""

from __future__ import annotations

import math
from collections.abc import Callable
from heapq import heappop, heappush
from typing import NamedTuple

from coord.verify.tolerances import HALVINGS, HALVINGS_REFUSED, RESOLUTION

#: (a, b) -> a lower bound of the function on [a, b], a value that it takes there, and where.
Bound = Callable[[float, float], tuple[float, float, float]]


class Least(NamedTuple):
    """What is known of the least value of a function.

    ``value`` and ``at`` : the least value seen below the one given, and where; ``at`` is None where none was.
    ``open`` : a place at which neither proof nor counterexample was found, None where all is decided.
    """

    value: float
    at: float | None
    open: float | None = None


def descend(bound: Bound, lo: float, hi: float, need: float, best: float) -> Least:
    """Show that a function is >= need on [lo, hi], and look for values below best.

    Without a value below need, and with ``open`` None, the function is proved >= need on all of [lo, hi], and
    its least value is not below the ``value`` returned by more than the resolution. A best value below need says that
    the need was missed elsewhere already: then, as after a value below need, only worse ones are looked for, not long.
    """
    at: float | None = None
    cut = worth(need, best)
    heap = [(-math.inf, lo, hi)]  # the least promising stretch first: that finds the least value soonest
    halvings = 0
    while heap and heap[0][0] < cut:
        _, a, b = heappop(heap)
        lower, value, where = bound(a, b)
        if value < best:
            best, at = value, where
            cut = worth(need, best)
        if lower >= cut:
            continue
        middle = (a + b) / 2
        halvings += 1
        if best < need and halvings > HALVINGS_REFUSED:
            break
        if not a < middle < b or halvings > HALVINGS:
            if best >= need and not lower >= need:
                return Least(best, at, a)
            continue
        key = lower if lower > -math.inf else -math.inf  # what is no number is the worst there is
        heappush(heap, (key, a, middle))
        heappush(heap, (key, middle, b))
    return Least(best, at)


def worth(need: float, best: float) -> float:
    """Below what a lower bound must be for a stretch to be worth a closer look."""
    return best - RESOLUTION if best < need else max(need, best - RESOLUTION)


def joined(one: Least, then: Least) -> Least:
    """Two searches as one, where the second began with the value the first had found."""
    better = one if then.at is None else then
    return Least(better.value, better.at, then.open if one.open is None else one.open)
