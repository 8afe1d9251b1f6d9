"""What every method of identification returns: modes with their standard deviations."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from modefront._typing import Complexes, Floats
from modefront.data.responses import FrequencyResponses
from modefront.identification.shapes import RealShape
from modefront.identification.stabilisation import StabilisationDiagram

MOST_COVARIED = 200  # responses with covariances of shapes: a file of 40 modes then has 25 MB


# 11 fields: what a mode is, and what speaks for it.
@dataclass(frozen=True)
class ModeEstimate:
    """One mode with its standard deviations, in physical units."""

    pole: complex  # rad/s
    frequency_std: float  # frequency_std, damping_std: standard deviations, Hz and ratio
    damping_std: float
    shape: RealShape  # the complex shape and the real one
    # (responses,) standard deviations of the real shape of unit norm; NaN where the response was
    # not measured, or shows nothing but noise of any mode
    shape_std: Floats
    participation: Complexes  # (references,) factors of the complex shape before its rotation
    # (responses, responses) of the real shape, None for more than `MOST_COVARIED`
    shape_covariance: Floats | None = None
    gain: float = np.nan  # 2 Delta J of the fit over the noise, over the least that a mode needs
    support: float = np.nan  # share of the orders from the first one with its pole that have it
    visibility: float = np.nan  # greatest share, in any function, of all modes at its frequency
    flags: tuple[str, ...] = ()  # reasons to look at it

    @property
    def frequency(self) -> float:
        """Natural frequency in Hz."""
        return abs(self.pole) / (2 * np.pi)

    @property
    def damping(self) -> float:
        """Damping ratio."""
        return -self.pole.real / abs(self.pole)


@dataclass(frozen=True)
class Rejected:
    """A pole that is no mode, in Hz and as a ratio, and why."""

    frequency: float
    damping: float
    reason: str


@dataclass(frozen=True)
class Residuals:
    """Correlation and size of the errors of the data, from the residuals of a fit."""

    chi2: float  # weighted sum of squares over degrees of freedom; 1 where the variance is right
    correlation: Complexes  # (lags,) of a line with the next ones
    force: Floats  # (references,) b, variance of the noise of the force channel, relative
    share: Floats  # (references, responses) norm over that of the function; NaN if not measured

    @property
    def widening(self) -> float:
        """Factor on the variance of what is the mean of many lines, by their correlation."""
        return float(1 + 2 * self.correlation[1:].real.sum())


# 11 fields: modes, what was measured, and how it was fitted.
@dataclass(frozen=True)
class Identification:
    """Modes of one data set."""

    responses: tuple[str, ...]  # names of the sensors, the components of shapes
    band: tuple[float, float]  # the lowest and the highest line in Hz
    modes: tuple[ModeEstimate, ...]  # accepted modes by frequency
    rejected: tuple[Rejected, ...]  # what was found besides, and why it is no mode
    diagram: StabilisationDiagram  # poles of all orders
    data: FrequencyResponses  # the functions within the band
    synthesised: Complexes  # functions of the modal model, of the shape of ``data.H``
    residuals: Residuals  # what the residuals say
    residual_terms: int = 0  # number of residual terms on either side of the band
    evaluations: int = 0  # number of evaluations of the model in the last fit
    converged: bool = True  # whether it met its tolerance

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Positions of modes of one pole, whose shapes are some basis of a plane."""
        poles = [mode.pole for mode in self.modes]
        return tuple((k, k + 1) for k, two in enumerate(pairwise(poles)) if two[0] == two[1])
