"""What shuts a place in."""

from __future__ import annotations

import numpy as np
import pytest

from coord.geometry.enclosure import enclosing
from coord.model.obstacle import Circle, Polygon, rectangle

BOUNDS = (0.0, 0.0, 20.0, 15.0)


def test_the_smaller_room_is_the_one_that_is_shut_in():
    """A goal in a corner behind two walls: both are named, the column far away is not, and not even a point gets through."""
    walls = [rectangle("a", (0.0, 4.0, 5.0, 4.2)), rectangle("b", (4.8, 0.0, 5.0, 4.2)), Circle("c", (15.0, 10.0), 1.0)]
    assert enclosing(walls, BOUNDS, 0.3, (10.0, 10.0), (2.0, 2.0)) == ("goal", ["a", "b"], None)
    assert enclosing(walls, BOUNDS, 0.3, (2.0, 2.0), (10.0, 10.0)) == ("start", ["a", "b"], None)


@pytest.mark.parametrize("door", [0.2, 0.5, 0.59])
def test_the_widest_passage_is_measured(door):
    """A door of a width lets half of it through, to a thousandth."""
    walls = [rectangle("a", (9.0, 0.0, 10.0, 7.0)), rectangle("b", (9.0, 7.0 + door, 10.0, 15.0))]
    which, names, gap = enclosing(walls, BOUNDS, 0.3, (3.0, 7.0), (15.0, 7.0))
    assert (which, names) == ("start", ["a", "b"]) or (which, names) == ("goal", ["a", "b"])
    assert gap == pytest.approx(door / 2, abs=1e-3)


def test_a_vault_has_one_wall():
    """An obstacle with a hole encloses what is in it."""
    vault = Polygon(
        "vault",
        np.array([(4, 3), (16, 3), (16, 12), (4, 12)], float),
        (np.array([(8, 6), (8, 9), (12, 9), (12, 6)], float),),
    )
    assert enclosing([vault], BOUNDS, 0.3, (2.0, 2.0), (10.0, 7.0)) == ("goal", ["vault"], None)
