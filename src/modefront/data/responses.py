r"""Measured frequency response functions as arrays.

A test is a table of frequency response functions :math:`H_{ji}(\omega_k)` between *references*
*j* and *responses* *i* at common lines :math:`f_k`. In a hammer test one side stays and the other
roves; by Maxwell's reciprocity, :math:`H_{ji} = H_{ij}`, either side can be called the
responses: mode shapes are identified at the side called so. What was not measured is NaN.

==========================  ==============================================================
symbol                      meaning
==========================  ==============================================================
``frequency`` :math:`f_k`   lines in Hz, ascending, (lines,)
``H``                       :math:`H_{ji}(\omega_k)`, (references, responses, lines)
``variance``                :math:`E|H - E H|^2`, the same shape; None where nothing is known
==========================  ==============================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Bools, Complexes, Floats

ORDERS = {"receptance": 0, "mobility": 1, "accelerance": 2}
"""Number of differentiations of the displacement in each quantity."""


@dataclass(frozen=True)
class ForceNoise:
    r"""Noise of the force channel, the same for all responses of a reference.

    The functions of reference j are multiplied by :math:`1 - \varepsilon_j(f)` with

    .. math:: E[\varepsilon_j(f)\,\varepsilon_j^*(f')] = \sigma_j(f)\,\sigma_j(f')
              \sum_m p_{jm} e^{-2\pi\mathrm{i}(f - f') t_{jm}},\qquad \sum_m p_{jm} = 1:

    where a force window is short, the errors are smooth over frequency.

    Attributes
    ----------
    deviation : (references, lines) sigma
    times : (samples,) of each reference, t in s from the impact
    share : (samples,) of each reference, p
    """

    deviation: Floats
    times: tuple[Floats, ...]
    share: tuple[Floats, ...]

    def lines(self, kept: Bools) -> ForceNoise:
        """Return the lines that are kept, (lines,)."""
        return replace(self, deviation=self.deviation[:, kept])


def joined(parts: Sequence[ForceNoise | None]) -> ForceNoise | None:
    """Return the noise of all references; None where that of one is not known."""
    known = [part for part in parts if part is not None]
    if not known or len(known) < len(parts):
        return None
    times = tuple(t for part in known for t in part.times)
    share = tuple(p for part in known for p in part.share)
    return ForceNoise(np.concatenate([part.deviation for part in known]), times, share)


@dataclass(frozen=True)
class FrequencyResponses:
    """Frequency response functions of one data set.

    Attributes
    ----------
    frequency : (lines,) in Hz, ascending
    H : (references, responses, lines) complex, NaN where not measured
    quantity : ``"receptance"``, ``"mobility"`` or ``"accelerance"``
    references, responses : names
    variance : (references, responses, lines), E|H - E H|², or None
    scaled : whether ``variance`` is known up to a factor for each function only, as it is from
        coherence where the number of blows is not known
    decay : what an exponential window added to the decay rate of every pole, in 1/s
    force_noise : noise of the force channel, where it is known
    """

    frequency: Floats
    H: Complexes
    quantity: str
    references: tuple[str, ...]
    responses: tuple[str, ...]
    variance: Floats | None = None
    scaled: bool = False
    decay: float = 0.0
    force_noise: ForceNoise | None = None

    def __post_init__(self) -> None:
        """Raise ValueError where the arrays do not fit."""
        expected = (len(self.references), len(self.responses), len(self.frequency))
        if self.H.shape != expected:
            raise ValueError(f"expected H of shape {expected}, found {self.H.shape}")
        if self.variance is not None and self.variance.shape != expected:
            raise ValueError(f"expected variance of shape {expected}, found {self.variance.shape}")
        if self.quantity not in ORDERS:
            raise ValueError(f"expected one of {', '.join(ORDERS)}, found {self.quantity!r}")
        if not (np.isfinite(self.frequency).all() and (np.diff(self.frequency) > 0).all()):
            raise ValueError("expected ascending frequencies")

    @property
    def measured(self) -> Bools:
        """Which lines of which functions were measured, of the shape of ``H``."""
        return np.isfinite(self.H)

    def within(self, low: float, high: float) -> FrequencyResponses:
        """Return the lines of a band in Hz, its limits included, without the line at zero."""
        f = self.frequency
        return self.lines((f >= low) & (f <= high) & (f > 0))

    def lines(self, kept: Bools) -> FrequencyResponses:
        """Return the lines that are kept, (lines,)."""
        return replace(
            self,
            frequency=self.frequency[kept],
            H=self.H[..., kept],
            variance=None if self.variance is None else self.variance[..., kept],
            force_noise=None if self.force_noise is None else self.force_noise.lines(kept),
        )


# 8 arguments: the parts of measured functions, the optional ones by keyword.
def frequency_responses(
    frequency: Floats,
    H: Complexes,
    quantity: str = "accelerance",
    *,
    references: tuple[str, ...] | None = None,
    responses: tuple[str, ...] | None = None,
    coherence: Floats | None = None,
    blows: int | None = None,
    variance: Floats | None = None,
) -> FrequencyResponses:
    r"""Return frequency response functions from arrays.

    Parameters
    ----------
    frequency : (lines,) in Hz
    H : (references, responses, lines), or (responses, lines) with one reference; or, with one
        axis more in front, the same of several blows
    coherence : of the shape of one ``H``: ordinary coherence, from which

        .. math:: \operatorname{var} H = |H|^2 \frac{1 - \gamma^2}{\gamma^2 n}

        follows (Bendat & Piersol, *Random Data*, 4th ed., 2010, eq. 9.90,
        doi:10.1002/9781118032428), where n is ``blows``; without it, up to a factor
    blows : number of blows that were averaged
    variance : of the shape of ``H``: variance of the mean, where it is known

    Raises ValueError where the arrays do not fit.
    """
    H = np.asarray(H, complex)
    if H.ndim == 2:
        H = H[None]
    scaled = False
    if H.ndim == 4:
        count = np.isfinite(H).sum(axis=0)
        several = np.maximum(count, 1)
        mean = np.where(count > 0, np.nansum(H, axis=0) / several, np.nan)
        spread = np.nansum(np.abs(H - mean) ** 2, axis=0)
        if variance is None and len(H) > 1:
            variance = np.where(count > 1, spread / np.maximum(count - 1, 1) / several, np.nan)
        H = mean
    if coherence is not None and variance is None:
        gamma = np.clip(np.asarray(coherence, float).reshape(H.shape), 1e-6, 1.0)
        variance = np.abs(H) ** 2 * (1 - gamma) / gamma / (blows or 1)
        scaled = blows is None
    return FrequencyResponses(
        np.asarray(frequency, float),
        H,
        quantity,
        references or tuple(str(j + 1) for j in range(H.shape[0])),
        responses or tuple(str(i + 1) for i in range(H.shape[1])),
        None if variance is None else np.asarray(variance, float).reshape(H.shape),
        scaled,
    )
