"""Groups of measured properties: which residuals each objective sums."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from modefront.data.modal import ModalData

Members = Sequence[int] | Literal["all"]
Scale = Literal["measured", "std"]


@dataclass(frozen=True)
class Group:
    """An objective J_i: the residuals of these frequencies and shapes, summed.

    Attributes
    ----------
    name : how the group is called in results
    frequency, shape : numbers of measured modes, counted from 1, or ``"all"``
    scale : what residuals are divided by: the measured values, as in equation (1), or their
        standard deviations
    """

    name: str
    frequency: Members = ()
    shape: Members = ()
    scale: Scale = "measured"


def members(chosen: Members, modes: Sequence[int], measured: Sequence[bool]) -> tuple[int, ...]:
    """Return positions in ``modes`` of the chosen ones.

    ``"all"`` is all that are measured. Raises ValueError for a mode that is not measured or is
    named twice.
    """
    if chosen == "all":
        return tuple(r for r, known in enumerate(measured) if known)
    known = [mode for mode, there in zip(modes, measured, strict=True) if there]
    for mode in chosen:
        if mode not in known:
            raise ValueError(f"one of the measured modes {known}, found {mode}")
    if len(set(chosen)) < len(chosen):
        raise ValueError(f"each mode once, found {list(chosen)}")
    return tuple(list(modes).index(mode) for mode in chosen)


def measured_frequencies(data: ModalData) -> list[bool]:
    """Return which modes have a frequency in any data set."""
    return list(map(bool, np.asarray(np.isfinite(data.frequency).any(axis=0))))


def measured_shapes(data: ModalData) -> list[bool]:
    """Return which modes have a component of their shape in any data set."""
    return list(map(bool, np.asarray(np.isfinite(data.shape).any(axis=(0, 2)))))
