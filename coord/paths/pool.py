"""All tangents that a search has drawn, in one growing table, so that many can be looked at in one go."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array

#: What is known of a tangent that was not found free.
UNTESTED, HIT = -1, -2


class Pool:
    """Tangents by number. Arrays have room for more than there are, so no array may be kept while more join."""

    def __init__(self) -> None:
        """Begin with none."""
        self._count = 0
        self._whole = np.empty((2, 64), dtype=np.intp)
        self._real = np.empty((8, 64))

    @property
    def nodes(self) -> npt.NDArray[np.intp]:
        """To which node each leads."""
        return np.asarray(self._whole[0])

    @property
    def tested(self) -> npt.NDArray[np.intp]:
        """The round in which each was found free, UNTESTED or HIT."""
        return np.asarray(self._whole[1])

    @property
    def leaving(self) -> Array:
        """The direction [rad] from the corner it leaves to where it begins."""
        return np.asarray(self._real[0])

    @property
    def arriving(self) -> Array:
        """The direction [rad] from the corner it leads to to where it ends."""
        return np.asarray(self._real[1])

    @property
    def length(self) -> Array:
        """The length [m]."""
        return np.asarray(self._real[2])

    @property
    def left(self) -> Array:
        """How far [m] it is from the end straight to the goal."""
        return np.asarray(self._real[3])

    def segments(self, chosen: npt.NDArray[np.intp]) -> Array:
        """Both ends (k, 4) [m] of some tangents."""
        return np.asarray(self._real[4:, chosen].T)

    def add(
        self, nodes: npt.NDArray[np.intp], *, leaving: Array, arriving: Array, starts: Array, ends: Array, left: Array
    ) -> npt.NDArray[np.intp]:
        """Let untested tangents with ends (2, n) join; their numbers."""
        numbers = self._count + np.arange(len(nodes))
        self._count += len(nodes)
        room = self._whole.shape[1]
        if self._count > room:
            more = max(self._count, 2 * room) - room
            self._whole = np.hstack([self._whole, np.empty((2, more), dtype=np.intp)])
            self._real = np.hstack([self._real, np.empty((8, more))])
        self._whole[0, numbers], self._whole[1, numbers] = nodes, UNTESTED
        self._real[:, numbers] = np.vstack([leaving, arriving, np.hypot(*(ends - starts)), left, starts, ends])
        return numbers
