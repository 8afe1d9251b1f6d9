"""Damping in percent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront.data.modal import ModalData

MEDIAN, GREATEST = 0.15, 0.4
"""Median and greatest damping ratio beyond which percent must be meant."""


@dataclass(frozen=True)
class DampingInPercent:
    """Damping ratios so great that percent must be meant.

    Attributes
    ----------
    least, greatest : range of the damping ratios
    """

    least: float
    greatest: float


def damping_findings(data: ModalData) -> list[DampingInPercent]:
    """Return whether damping looks like percent."""
    known = data.damping[np.isfinite(data.damping) & (data.damping > 0)]
    if not known.size or (np.median(known) <= MEDIAN and known.max() <= GREATEST):
        return []
    return [DampingInPercent(float(known.min()), float(known.max()))]
