"""A first course through a tube: as soon everywhere as the bounds passed after allow, with the jerk forgotten."""

from __future__ import annotations

import numpy as np

from coord.timing.ego import Ego
from coord.timing.grid import Course
from coord.timing.reach import soonest
from coord.timing.tube import Tube

#: Moments at which the course is known.
_MOMENTS = 400

#: [m] Bounds at and beyond the goal do not hold anybody up.
_AT_GOAL = 1e-6


def hasty_course(ego: Ego, tube: Tube) -> Course:
    """The course that is nowhere later than any motion; bounds passed before are kept if any motion keeps them."""
    departure = ego.alone.departure
    times, bounds = np.empty(0), np.empty(0)
    for bound in tube.upper:
        values = np.minimum(np.append(bound.values[:1, 0], bound.values[:, 1]), np.append(bound.values[:, 0], np.inf))
        holds = values < ego.length - _AT_GOAL
        times, bounds = np.append(times, bound.times[holds]), np.append(bounds, values[holds])
    order = np.argsort(times, kind="stable")
    last = max(float(times.max(initial=departure)), departure) + (ego.alone.arrival - departure)
    moments = np.unique(np.append(np.linspace(departure, last, _MOMENTS), times[times > departure]))
    s = np.maximum.accumulate(soonest(ego, moments, times[order], np.maximum(bounds[order], 0.0)))
    there = np.flatnonzero(s >= ego.length - _AT_GOAL)
    end = int(there[0]) + 1 if len(there) else len(s)
    return Course(moments[:end], np.append(s[: end - 1], ego.length))
