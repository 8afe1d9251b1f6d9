"""The modes of a model: at its sensors, with derivatives, and at all degrees of freedom."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from modefront._typing import Bools, Floats
from modefront.modes.second_derivatives import SecondDerivatives


@dataclass(frozen=True)
class ModeDerivatives:
    """Derivatives of modes with respect to the parameters.

    Attributes
    ----------
    dlam : (modes, parameters) derivatives of eigenvalues; for coinciding modes, those of the
        ascending eigenvalues as the parameter alone increases
    dphi : (sensors, modes, parameters) derivatives of mode shapes; for coinciding modes, only the
        part that leaves their common subspace, which is the well-defined one
    coincident : (modes,) true where a mode is so close to another one that derivatives of the
        single mode are not defined to eight digits, and only those of the subspace are
    second : the second derivatives, computed when requested; None where they are not known
    """

    dlam: Floats
    dphi: Floats
    coincident: Bools
    second: SecondDerivatives | None = None


@dataclass(frozen=True)
class Modes:
    """The lowest modes of a model, in ascending order, seen at its sensors.

    Attributes
    ----------
    lam : (modes,) eigenvalues omega**2 in (rad/s)**2
    phi : (sensors, modes) mass-normalised mode shapes at the sensors; the sign is arbitrary
    derivatives : with respect to the parameters; None where they were not requested
    """

    lam: Floats
    phi: Floats
    derivatives: ModeDerivatives | None = None

    @property
    def dlam(self) -> Floats:
        """Derivatives of ``lam``; raises ValueError where they were not requested."""
        return self._requested.dlam

    @property
    def dphi(self) -> Floats:
        """Derivatives of ``phi``; raises ValueError where they were not requested."""
        return self._requested.dphi

    @property
    def coincident(self) -> Bools:
        """Which modes have no derivatives of their own, (modes,); none without derivatives."""
        none = np.zeros(self.lam.size, dtype=np.bool_)
        return none if self.derivatives is None else self.derivatives.coincident

    def second_derivatives(self, w: Floats, v: Floats) -> Floats | None:
        """Return the Hessians of sum_r w_r lam_r + v_r^T phi_r for several w and v, (n, p, p).

        ``w`` has the shape (n, modes) and ``v`` (n, sensors, modes). None where second derivatives
        are not known, or a mode with weights coincides with another one. Raises ValueError where
        derivatives were not requested, and ModelError where an iteration for them fails.
        """
        r, second = np.flatnonzero(w.any(axis=0) | v.any(axis=(0, 1))), self._requested.second
        if second is None or self.coincident[r].any():
            return None
        return second.of_sums(r, w[:, r], v[:, :, r])

    @property
    def _requested(self) -> ModeDerivatives:
        if self.derivatives is None:
            raise ValueError("expected modes with derivatives, found modes without")
        return self.derivatives

    @cached_property
    def frequency(self) -> Floats:
        """Natural frequencies in Hz, shape (modes,); zero for rigid-body modes."""
        out: Floats = np.sqrt(np.maximum(self.lam, 0.0)) / (2 * np.pi)
        return out

    @cached_property
    def dfrequency(self) -> Floats:
        """Derivatives of the natural frequencies in Hz, shape (modes, parameters).

        Raises ValueError where derivatives were not requested.
        """
        out: Floats = self.dlam * self.frequency_by_lam[:, None]
        return out

    @cached_property
    def frequency_by_lam(self) -> Floats:
        """Derivatives of the frequencies by their eigenvalues, (modes,); 0 for rigid-body modes."""
        omega = np.sqrt(np.maximum(self.lam, 0.0))
        return np.divide(1, 4 * np.pi * omega, out=np.zeros(omega.shape), where=omega > 0)


@dataclass(frozen=True)
class FullModes:
    """The lowest modes of a model at one theta, and its static response.

    Attributes
    ----------
    lam : (modes,) eigenvalues omega**2 in (rad/s)**2, ascending; 0 for rigid-body modes
    Phi : (N, modes) mass-normalised modes; the sign is arbitrary
    static : (N, loads) displacement under each load; None with rigid-body modes
    """

    lam: Floats
    Phi: Floats
    static: Floats | None
