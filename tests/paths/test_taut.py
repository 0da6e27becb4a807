"""Taut paths: skeletons as lines and arcs."""

from __future__ import annotations

import numpy as np
import pytest


@pytest.mark.parametrize("seed", range(400, 420))
def test_a_taut_path_is_its_skeleton_without_corners(route, floors, seed):
    """The same length, lines and arcs alternating, headings continuous: points 1 mm apart turn by no more than the bend allows."""
    floor = floors(seed, 6)
    found = route(*floor)
    if found is None:
        return
    bones, path = found
    assert path.length == pytest.approx(bones.length, abs=1e-8)
    assert np.all(path.pieces[:, 1] == path.pieces[:, 2])
    assert (path.pieces[:, 1] != 0).sum() == len(bones.turns)
    at = path.point(np.arange(0.0, path.length, 1e-3))
    step = np.diff(at, axis=0)
    turn = np.abs(np.diff(np.unwrap(np.arctan2(step[:, 1], step[:, 0]))))
    sharpest = np.abs(path.pieces[:, 1]).max()
    assert turn.max(initial=0.0) <= 1.01e-3 * sharpest + 1e-6
