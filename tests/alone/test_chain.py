"""The chain of motions: what is left out of the search for good borders changes nothing."""

from __future__ import annotations

import numpy as np

import coord.alone.chain as chain
from coord.alone.speed_limit import speed_limit
from coord.model.path import Path
from coord.model.robot import Limits


def test_borders_that_have_settled_are_not_probed_any_more_and_the_motion_is_the_same(monkeypatch):
    """A wide bend far from a tight one settles first: fewer probes than of all borders, and the same states."""
    pieces = [
        [8.4458, 0.0, 0.0],
        [0.0436, 0.0, -0.4444],
        [0.0436, -0.4444, -0.4444],
        [0.0436, -0.4444, 0.0],
        [18.3024, 0.0, 0.0],
        [0.3617, 0.0, -0.893],
        [0.3617, -0.893, -0.893],
        [0.3617, -0.893, 0.0],
        [0.1627, 0.0, 0.0],
    ]
    limits = Limits(1.5, 1.0, 1.0, 2.0, 1.0)
    caps = speed_limit(Path((0.0, 0.0, 0.0), np.array(pieces)), limits)
    probed = []
    search = chain._Borders._search

    def counted(self, m, step):
        probed.append(m)
        return search(self, m, step)

    monkeypatch.setattr(chain._Borders, "_search", counted)
    found = chain.chained(caps, limits)
    fewer = len(probed)
    monkeypatch.setattr(chain, "_SETTLED", 0.0)
    other = chain.chained(caps, limits)
    assert fewer < len(probed) - fewer
    assert np.array_equal(found.states, other.states)
    assert np.array_equal(found.times, other.times)
