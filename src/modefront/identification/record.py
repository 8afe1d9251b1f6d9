"""What every method of identification returns: modes with their standard deviations."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from modefront._typing import Complexes, Floats
from modefront.data.responses import FrequencyResponses
from modefront.identification.shapes import RealShape
from modefront.identification.stabilisation import StabilisationDiagram

MOST_COVARIED = 200
"""Responses of which covariances of shapes are kept: a file of 40 modes then has 25 MB."""


@dataclass(frozen=True)
class Evidence:
    """What speaks for a mode, and what to look at.

    Attributes
    ----------
    gain : how much better the fit is than that without the mode, 2 Delta J over the noise, over the
        least that a mode needs
    support : share of the orders of the diagram, from the first one with its pole, that have it
    visibility : its greatest share, over all functions, in the sum of all modes at its frequency
    flags : reasons to look at it
    """

    gain: float = np.nan
    support: float = np.nan
    visibility: float = np.nan
    flags: tuple[str, ...] = ()


@dataclass(frozen=True)
class ModeEstimate:
    """One mode with its standard deviations, in physical units.

    Attributes
    ----------
    pole : rad/s
    frequency, damping : Hz, ratio
    frequency_std, damping_std : their standard deviations
    shape : the complex shape and the real one
    shape_std : (responses,) standard deviations of the real shape of unit norm; NaN where the
        response was not measured, or shows nothing but noise of any mode
    participation : (references,) factors that go with the complex shape as given, before rotation
    evidence : what speaks for it
    shape_covariance : (responses, responses) of the real shape, None for more than `MOST_COVARIED`
    """

    pole: complex
    frequency: float
    damping: float
    frequency_std: float
    damping_std: float
    shape: RealShape
    shape_std: Floats
    participation: Complexes
    evidence: Evidence = Evidence()
    shape_covariance: Floats | None = None


@dataclass(frozen=True)
class Rejected:
    """A pole that is no mode, in Hz and as a ratio, and why."""

    frequency: float
    damping: float
    reason: str


@dataclass(frozen=True)
class Residuals:
    """Correlation and size of the errors of the data, from the residuals of a fit.

    Attributes
    ----------
    chi2 : weighted sum of squares over the degrees of freedom; 1 where the variance is right
    correlation : (lags,) of a line with the next ones
    force : (references,) b, variance of the noise of the force channel, relative
    share : (references, responses) norm of the residual over that of the function; NaN where the
        function was not measured
    """

    chi2: float
    correlation: Complexes
    force: Floats
    share: Floats

    @property
    def widening(self) -> float:
        """Factor on the variance of what is the mean of many lines, by their correlation."""
        return float(1 + 2 * self.correlation[1:].real.sum())


@dataclass(frozen=True)
class FittedFunctions:
    """Measured functions beside those of the modal model.

    Attributes
    ----------
    data : the functions within the band
    synthesised : functions of the model, of the shape of ``data.H``
    variance : the variance that weighted the data
    residuals : what the residuals say
    residual_terms : number of residual terms on either side of the band
    """

    data: FrequencyResponses
    synthesised: Complexes
    variance: Floats
    residuals: Residuals
    residual_terms: int


@dataclass(frozen=True)
class Identification:
    """Modes of one data set.

    Attributes
    ----------
    responses : names of the sensors, the components of shapes
    band : the lowest and the highest line in Hz
    modes : accepted modes by frequency
    rejected : what was found besides, and why it is no mode
    diagram : poles of all orders
    functions : measured and fitted functions
    evaluations : number of evaluations of the model in the last fit
    converged : whether it met its tolerance
    """

    responses: tuple[str, ...]
    band: tuple[float, float]
    modes: tuple[ModeEstimate, ...]
    rejected: tuple[Rejected, ...]
    diagram: StabilisationDiagram
    functions: FittedFunctions
    evaluations: int
    converged: bool

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Positions of modes of one pole, whose shapes are some basis of a plane."""
        poles = [mode.pole for mode in self.modes]
        return tuple((k, k + 1) for k, two in enumerate(pairwise(poles)) if two[0] == two[1])
