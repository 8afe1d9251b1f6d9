"""The lowest modes of a sparse model, in full and with the factors that found them."""

from __future__ import annotations

from dataclasses import dataclass

import scipy.sparse

from modefront._typing import Floats
from modefront.linalg.factorisation import Factorisation


@dataclass(frozen=True)
class Shifted:
    """The factor of K - sigma M."""

    sigma: float
    factor: Factorisation


@dataclass(frozen=True)
class Spectrum:
    """The lowest modes at one theta.

    Attributes
    ----------
    lam : (modes,) eigenvalues, ascending
    Phi, MPhi : (N, modes) mass-normalised modes, and M times them
    M : the mass matrix
    noise : (modes,) rounding to be expected in ``lam``
    beyond : estimate of the next eigenvalue; infinite where there is none
    proved : how many modes were proved to be the lowest ones
    factors : the factors of K - sigma M below all modes and above the proved ones
    """

    lam: Floats
    Phi: Floats
    MPhi: Floats
    M: scipy.sparse.csr_array
    noise: Floats
    beyond: float
    proved: int
    factors: tuple[Shifted, Shifted]
