r"""Data drawn again, to see how far models and fronts scatter without a linearisation.

From several data sets, as many sets are drawn with replacement (the bootstrap; Efron & Tibshirani
1993, *An Introduction to the Bootstrap*, chapter 6); a draw in which something is measured in no
set is drawn again. From standard deviations, every value is drawn from a Gaussian around it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from modefront._typing import Bools
from modefront.data.modal import ModalData
from modefront.errors import UnfinishedError
from modefront.uncertainty.noise import Source

ATTEMPTS = 1000
"""Drawings of data sets after which it is given up to have everything measured in one."""


def redraw(data: ModalData, source: Source, rng: np.random.Generator) -> ModalData:
    """Return data as they might have been measured.

    Raises UnfinishedError where drawings of data sets hardly ever have all that was measured.
    """
    if source == "std":
        f_std, phi_std = (np.nan_to_num(x) for x in (data.frequency_std, data.shape_std))
        return replace(
            data,
            frequency=data.frequency + f_std * rng.standard_normal(f_std.shape),
            shape=data.shape + phi_std * rng.standard_normal(phi_std.shape),
        )
    measured = _measured(data)
    for _ in range(ATTEMPTS):
        drawn = rng.integers(len(data.sets), size=len(data.sets))
        again = replace(
            data,
            sets=tuple(f"{data.sets[k]} ({i + 1})" for i, k in enumerate(drawn.tolist())),
            frequency=data.frequency[drawn],
            damping=data.damping[drawn],
            shape=data.shape[drawn],
            frequency_std=data.frequency_std[drawn],
            shape_std=data.shape_std[drawn],
        )
        if (_measured(again) == measured).all():
            return again
    raise UnfinishedError(
        f"none of {ATTEMPTS} drawings of the data sets has everything in it that was measured: "
        "too much is measured in few sets; without bootstrap, the scatter is linearised"
    )


def _measured(data: ModalData) -> Bools:
    """Return which frequencies and shapes are measured in any set, (2, modes)."""
    return np.array(
        [np.isfinite(data.frequency).any(axis=0), np.isfinite(data.shape).any(axis=(0, 2))]
    )
