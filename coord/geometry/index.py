"""Which of many boxes are near each other, and what hangs together: the spatial index."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import shapely

from coord.model.arrays import Array


def touching_boxes(boxes: Array) -> npt.NDArray[np.intp]:
    """Pairs (m, 2) of indices i < k of boxes (n, 4: xmin, ymin, xmax, ymax) that touch, in ascending order."""
    tree = shapely.STRtree(shapely.box(*boxes.T))
    first, second = tree.query(tree.geometries, predicate="intersects")
    pairs = np.stack([first, second], axis=1)
    pairs = pairs[first < second]
    return np.asarray(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))])


def connected(count: int, a: npt.NDArray[np.intp], b: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Labels (count,) of the connected components of a graph with edges a[k] - b[k]: the least member of each."""
    label = np.arange(count)
    while True:  # labels flow to the least of a component, in ever larger strides
        least = label.copy()
        np.minimum.at(least, a, label[b])
        np.minimum.at(least, b, label[a])
        least = least[least]
        if np.array_equal(least, label):
            return label
        label = least
