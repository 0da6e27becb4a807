"""Read-only arrays: the values of the model never change after they were made."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Point: TypeAlias = tuple[float, float]


def frozen(values: npt.ArrayLike, columns: int | None = None) -> Array:
    """Copy values into a read-only array of floats, shaped (n, columns) when columns is given."""
    array = np.array(values, dtype=np.float64)
    if columns is not None:
        array = array.reshape(-1, columns)
    array.flags.writeable = False
    return array
