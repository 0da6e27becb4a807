"""The door of casadi's nonlinear solvers: the quickest motion through sections with a speed cap each."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi
import numpy as np

from coord.model.arrays import Array
from coord.model.robot import Limits

#: Phases of constant jerk a section: the time-optimal motion between two states with a cap has at most seven.
PHASES = 7

#: [s] Lower bound of a phase's duration, so that the solver stays away from phases that vanish.
_SHORTEST = 1e-9

_OPTIONS: dict[str, Any] = {
    "print_time": False,
    "expand": True,
    "error_on_fail": False,
    "structure_detection": "manual",
    "fatrop.print_level": 0,
    "fatrop.tol": 1e-9,
    "fatrop.max_iter": 300,
}


def quickest_phases(ends: Array, caps: Array, limits: Limits, guess: Array) -> tuple[Array, Array]:
    """Durations and jerks, (7 m,) each, of a quick motion from rest through m sections to rest.

    The program has the states at the knots and, for each phase, duration and jerk as unknowns; the cubic
    motion is integrated exactly, and the speed is held below the section's cap at its Bezier points.
    Solved by Fatrop (Vanroye et al. 2023), which uses the structure of such chains. The outcome is a local
    optimum at best and need not satisfy anything if the solver gave up: the caller checks it.

    Parameters
    ----------
    ends : (m,) arc length [m] at the end of each section, increasing.
    caps : (m,) largest speed [m/s] in each section.
    guess : (7 m, 5) rows s, v, a, duration, jerk of a first motion.
    """
    sections = len(ends)
    solver, lower, upper = _program(sections)
    parameters = [*ends.tolist(), *caps.tolist(), limits.acceleration, limits.deceleration, limits.jerk]
    first = np.concatenate([guess.ravel(), [ends[-1], 0.0, 0.0]])
    solution = solver(x0=first, p=parameters, lbg=lower, ubg=upper)
    values = np.asarray(solution["x"]).ravel()[:-3].reshape(-1, 5)
    return values[:, 3].copy(), values[:, 4].copy()


@lru_cache(maxsize=64)
def _program(sections: int) -> tuple[Any, list[float], list[float]]:
    """The solver for a number of sections, with the bounds of its rows; Fatrop wants x+ - F first, then the stage."""
    count = sections * PHASES
    p = casadi.MX.sym("p", 2 * sections + 3)
    ends, caps, (up, down, jerk) = p[:sections], p[sections : 2 * sections], casadi.vertsplit(p[2 * sections :])
    x = [casadi.MX.sym(f"x{k}", 3) for k in range(count + 1)]
    u = [casadi.MX.sym(f"u{k}", 2) for k in range(count)]
    rows: list[tuple[Any, float, float]] = []
    sizes = []
    for k in range(count):
        (s, v, a), (h, j) = casadi.vertsplit(x[k]), casadi.vertsplit(u[k])
        m = k // PHASES
        moved = (s + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j)
        rows += [(x[k + 1][i] - moved[i], 0.0, 0.0) for i in range(3)]
        stage: list[tuple[Any, float, float]] = []
        if k == 0:
            stage += [(x[0][i], 0.0, 0.0) for i in range(3)]
        elif k % PHASES == 0:
            stage += [(s - ends[m - 1], 0.0, 0.0), (v - caps[m - 1], -casadi.inf, 0.0)]
        stage += [(v - caps[m], -casadi.inf, 0.0), (v + h * a / 2 - caps[m], -casadi.inf, 0.0)]
        stage += [(v, 0.0, casadi.inf), (v + h * a / 2, 0.0, casadi.inf)]
        stage += [(a - up, -casadi.inf, 0.0), (a + down, 0.0, casadi.inf)]
        stage += [(j - jerk, -casadi.inf, 0.0), (j + jerk, 0.0, casadi.inf), (h, _SHORTEST, casadi.inf)]
        rows += stage
        sizes.append(len(stage))
    final = casadi.vertcat(ends[sections - 1], 0, 0)
    rows += [(x[count][i] - final[i], 0.0, 0.0) for i in range(3)]
    unknowns = [part for pair in zip(x, u, strict=False) for part in pair] + [x[count]]
    expressions, lower, upper = zip(*rows, strict=True)
    program = {
        "x": casadi.vertcat(*unknowns),
        "p": p,
        "f": sum(part[0] for part in u),
        "g": casadi.vertcat(*expressions),
    }
    structure: dict[str, Any] = {
        "N": count,
        "nx": [3] * (count + 1),
        "nu": [2] * count + [0],
        "ng": [*sizes, 3],
        "equality": [low == high for low, high in zip(lower, upper, strict=True)],
    }
    solver = casadi.nlpsol("quickest", "fatrop", program, _OPTIONS | structure)
    return solver, list(lower), list(upper)
