"""Local axes in which a study file gives directions."""

from __future__ import annotations

from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.fem.dofs import DIRECTIONS
from modefront.toml import Table, is_number

PARALLEL = 1e-9
"""Sine of the angle of two axes below which they are one."""


def read_axes(place: Table) -> Floats | None:
    """Return local axes (3, 3), x, y and z in rows; None for those of the model."""
    expected = "two vectors [[...], [...]]: the local x axis, and one in the local x-y plane"
    rows = place.take(
        "axes",
        expected,
        lambda x: (
            isinstance(x, list)
            and len(x) == 2
            and all(isinstance(v, list) and len(v) == 3 and all(map(is_number, v)) for v in x)
            and float(np.linalg.norm(np.cross(*x)))
            > PARALLEL * float(np.prod(np.linalg.norm(x, axis=1)))
        ),
        None,
    )
    if rows is None:
        return None
    first, second = np.asarray(rows, dtype=float)
    x, z = first / np.linalg.norm(first), np.cross(first, second)
    z /= np.linalg.norm(z)
    return np.stack([x, np.cross(z, x), z])


def in_axes(place: Table, direction: Any, axes: Floats | None) -> Any:
    """Return a direction in the axes of the model, None where it has none there."""
    if axes is None:
        return direction
    if isinstance(direction, str):
        axis = direction.removeprefix("-")
        if axis not in DIRECTIONS[:3]:
            place.fault("direction", "x, y or z where axes are given", f"'{direction}'")
            return None
        row = axes[DIRECTIONS.index(axis)]
        return (-row if direction != axis else row).tolist()
    return (np.asarray(direction, dtype=float) @ axes).tolist()
