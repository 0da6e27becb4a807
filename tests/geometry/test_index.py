"""The spatial index of boxes."""

from __future__ import annotations

import numpy as np

from coord.geometry.index import touching_boxes


def test_pairs_of_boxes_that_touch_are_all_found_in_order():
    """The same pairs as comparing all with all, on 40 random floors with boxes on a coarse grid, so that many just touch."""
    rng = np.random.default_rng(1)
    for _ in range(40):
        low = rng.integers(0, 12, (30, 2)) / 2
        boxes = np.hstack([low, low + rng.integers(0, 5, (30, 2)) / 2])
        expected = [
            [i, k]
            for i in range(30)
            for k in range(i + 1, 30)
            if np.all(boxes[i, :2] <= boxes[k, 2:]) and np.all(boxes[k, :2] <= boxes[i, 2:])
        ]
        assert touching_boxes(boxes).tolist() == expected


def test_a_single_box_touches_no_other():
    """No pairs, in the right shape."""
    assert touching_boxes(np.array([[0.0, 0.0, 1.0, 1.0]])).shape == (0, 2)
