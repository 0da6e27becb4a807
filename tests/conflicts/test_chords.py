"""Paths as chains of chords."""

from __future__ import annotations

import numpy as np
import pytest

from coord.conflicts.chords import chords
from coord.model.path import straight
from coord.tolerances import CHORD_SAGITTA


def test_points_of_a_path_lie_within_the_error_of_their_chords(wild_path):
    """At 2,000 places of 50 paths the point at the same share of the chord is no farther away than the error says."""
    rng = np.random.default_rng(1)
    for _ in range(50):
        path = wild_path(rng)
        chain = chords(path)
        s = np.linspace(0, path.length, 2000)[:-1]
        k = np.searchsorted(chain.s, s, side="right") - 1
        share = (s - chain.s[k]) / np.diff(chain.s)[k]
        on_chord = chain.points[k] + (chain.points[k + 1] - chain.points[k]) * share[:, None]
        assert np.all(np.hypot(*(path.point(s) - on_chord).T) <= chain.errors[k] + 1e-12)
        assert chain.errors.max() <= CHORD_SAGITTA
        assert chain.s[0] == 0.0
        assert chain.s[-1] == path.length


def test_a_line_is_one_chord_without_error():
    """And a path without length is one chord without length."""
    assert chords(straight((0, 0), (3, 4))).s.tolist() == [0.0, 5.0]
    assert chords(straight((0, 0), (3, 4))).errors.tolist() == [0.0]
    nowhere = chords(straight((1, 2), (1, 2)))
    assert (nowhere.s.tolist(), nowhere.points.tolist()) == ([0.0, 0.0], [[1.0, 2.0], [1.0, 2.0]])


def test_finer_chords_have_smaller_errors(wild_path):
    """The bound asked for is kept, and not by more than needed: at most twice as many chords as a quarter of it."""
    path = wild_path(np.random.default_rng(2), ("arc",))
    coarse, fine = chords(path, 1e-2), chords(path, 1e-6)
    assert coarse.errors.max() <= 1e-2
    assert fine.errors.max() <= 1e-6
    assert len(fine.errors) == pytest.approx(100 * len(coarse.errors), rel=0.5)
