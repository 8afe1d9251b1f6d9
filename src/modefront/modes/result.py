"""The modes of a model at its sensors, with derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from modefront._typing import Bools, Floats


@dataclass(frozen=True)
class Modes:
    """The lowest modes of a model, in ascending order, seen at its sensors.

    Attributes
    ----------
    lam : (modes,) eigenvalues omega**2 in (rad/s)**2
    phi : (sensors, modes) mass-normalised mode shapes at the sensors; the sign is arbitrary
    dlam : (modes, parameters) derivatives of ``lam``; for coinciding modes, those of the
        ascending eigenvalues as the parameter alone increases
    dphi : (sensors, modes, parameters) derivatives of ``phi``; for coinciding modes, only the
        part that leaves their common subspace, which is the well-defined one
    coincident : (modes,) true where a mode is so close to another one that derivatives of the
        single mode are not defined to eight digits, and only those of the subspace are

    ``dlam`` and ``dphi`` have no columns where no derivatives were asked for.
    """

    lam: Floats
    phi: Floats
    dlam: Floats
    dphi: Floats
    coincident: Bools

    @cached_property
    def frequency(self) -> Floats:
        """Natural frequencies in Hz, shape (modes,); zero for rigid-body modes."""
        out: Floats = np.sqrt(np.maximum(self.lam, 0.0)) / (2 * np.pi)
        return out

    @cached_property
    def dfrequency(self) -> Floats:
        """Derivatives of the natural frequencies in Hz, shape (modes, parameters)."""
        omega = np.sqrt(np.maximum(self.lam, 0.0))
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = np.where(omega > 0, 1 / (4 * np.pi * omega), 0.0)
        out: Floats = self.dlam * scale[:, None]
        return out
