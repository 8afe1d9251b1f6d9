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
from modefront.uncertainty.noise import Source


def redraw(data: ModalData, source: Source, rng: np.random.Generator) -> ModalData:
    """Return data as they might have been measured."""
    if source == "std":
        f_std, phi_std = (np.nan_to_num(x) for x in (data.frequency_std, data.shape_std))
        return replace(
            data,
            frequency=data.frequency + f_std * rng.standard_normal(f_std.shape),
            shape=data.shape + phi_std * rng.standard_normal(phi_std.shape),
        )
    wanted = _measured(data)
    while True:
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
        if (_measured(again) == wanted).all():
            return again


def _measured(data: ModalData) -> Bools:
    """Return which frequencies and shapes are measured in any set, (2, modes)."""
    return np.array(
        [np.isfinite(data.frequency).any(axis=0), np.isfinite(data.shape).any(axis=(0, 2))]
    )
