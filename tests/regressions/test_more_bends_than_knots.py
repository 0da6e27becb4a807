"""A path through a warehouse had more bends than the largest relaxation has knots, and planning ended with an error."""

from __future__ import annotations

import numpy as np
import pytest

from coord.timing import outer


@pytest.mark.parametrize("further", [0, 100, 511, 800, 5000])
def test_there_are_never_more_knots_than_the_largest_relaxation_has(further):
    """However many are asked for, they rise from the departure to the arrival."""
    knots = outer._knots(3.0, 90.0, np.linspace(2.0, 95.0, further).tolist())
    assert 48 <= len(knots) - 1 <= outer.MOST_CELLS
    assert (knots[0], knots[-1]) == (3.0, 90.0)
    assert np.all(np.diff(knots) > 0)
