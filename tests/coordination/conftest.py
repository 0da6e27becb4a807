"""Crowds: robots that start and end on a lattice with room to pass between any two places."""

from __future__ import annotations

import importlib
from pathlib import Path

import numpy as np
import pytest

from coord.model.footprint import Footprint
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot

ANALYSIS = Path(__file__).resolve().parents[2] / "analysis"


def _crowd(seed, count=15, cells=6, shape=Footprint(0.3), spacing=1.6):  # noqa: B008 - a frozen value
    """Robots between distinct places of a square lattice, no two of which are nearer than ``spacing`` [m]."""
    rng = np.random.default_rng(seed)
    places = [(spacing * (k % cells + 1), spacing * (k // cells + 1)) for k in rng.permutation(cells * cells).tolist()]
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    robots = [Robot(f"r{k}", shape, limits, places[2 * k], places[2 * k + 1]) for k in range(count)]
    side = spacing * (cells + 1)
    return Problem("crowd", Workspace((0.0, 0.0, side, side), 0.05), tuple(robots))


@pytest.fixture(scope="session")
def crowd():
    """A function (seed, count, cells, shape, spacing) that makes a problem."""
    return _crowd


@pytest.fixture
def arrival(monkeypatch):
    """The benchmark of arrival, with what confirms a reason."""
    if not ANALYSIS.is_dir():
        pytest.skip("the benchmark lives in analysis/, which is not here")
    monkeypatch.syspath_prepend(str(ANALYSIS))
    return importlib.import_module("arrival")
