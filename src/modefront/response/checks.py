"""Checks of arguments for the packages response and reliability.

Every error is an `InputError` that names the argument, what was expected and what was found.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from modefront.errors import wrong

FloatArray = NDArray[np.float64]


def real_array(
    name: str, value: ArrayLike, shape: Sequence[int | None], meaning: str
) -> FloatArray:
    """Return `value` as a read-only array of finite floats of the given shape.

    `shape` has one entry a dimension, None where any size of at least one is right; `meaning`
    says in words what the dimensions are.
    """
    array = np.array(value, dtype=np.float64)
    fits = array.ndim == len(shape) and all(
        size == wanted or (wanted is None and size > 0)
        for size, wanted in zip(array.shape, shape, strict=True)
    )
    if not fits:
        sizes = ", ".join("n" if size is None else str(size) for size in shape)
        raise wrong(name, f"shape ({sizes}) ({meaning})", array.shape)
    if not np.all(np.isfinite(array)):
        index = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise wrong(name, "finite numbers", f"{array[index]} at index {index}")
    array.setflags(write=False)
    return array


def positive(name: str, value: float, unit: str) -> float:
    """Return `value` if it is a finite number above zero."""
    if not (np.isfinite(value) and value > 0):
        raise wrong(name, f"a positive number ({unit})", value)
    return float(value)


def positive_count(name: str, value: int) -> int:
    """Return `value` if it is a whole number above zero."""
    if not (np.isfinite(value) and value >= 1 and int(value) == value):
        raise wrong(name, "a whole number of at least 1", value)
    return int(value)


def no_negative(name: str, array: FloatArray, meaning: str) -> FloatArray:
    """Return `array` if none of its elements is below zero."""
    if np.any(array < 0):
        index = tuple(int(i) for i in np.argwhere(array < 0)[0])
        raise wrong(name, f"no negative {meaning}", f"{array[index]} at index {index}")
    return array
