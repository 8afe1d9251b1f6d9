r"""Frequency response functions from the records of impacts.

Every blow is a record of force x and responses y. With spectra X and Y after the windows, and sums
over blows :math:`S_{xx} = \sum |X|^2`, :math:`S_{yx} = \sum Y X^*`, :math:`S_{yy} = \sum |Y|^2`,

.. math:: H_1 = \frac{S_{yx}}{S_{xx}},\qquad H_2 = \frac{S_{yy}}{S_{xy}},\qquad
          H_v = \frac{S_{yx}}{|S_{yx}|}\sqrt{\frac{S_{yy}}{S_{xx}}},\qquad
          \gamma^2 = \frac{|S_{yx}|^2}{S_{xx} S_{yy}} .

H1 is free of bias by noise of the responses, H2 of noise of the force, and Hv, their geometric
mean, lies between (Rocklin, Crowley & Vold, A comparison of H1, H2, and Hv frequency response
functions, IMAC III (1985)). The force window keeps the impact and sets the rest to zero. The
exponential window :math:`e^{-t/\tau}` lets responses die out within the record; as it multiplies
force and responses alike, every pole is moved by exactly :math:`-1/\tau`, and is moved back after
the identification (Fladung & Brown, Multiple reference impact testing, IMAC XI (1993)).

Responses and force that reach a full scale several times are overloads. A second hit is a force
beyond `SECOND` of the peak after the first impact has ended.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy.fft

from modefront._typing import Complexes, Floats
from modefront.data.responses import FrequencyResponses, frequency_responses

Estimator = Literal["H1", "H2", "Hv"]

SECOND = 0.1
"""Force of a second hit over that of the first."""

CLIPPED = 3
"""Samples in a row at the greatest value that make an overload."""

TAPER = 0.1
"""Share of the force window over which it falls to zero."""


@dataclass(frozen=True)
class ImpactResponses:
    """Functions from impacts.

    Attributes
    ----------
    data : the functions, with the variance of their mean from coherence
    coherence : (responses, lines)
    decay : added to the decay rate of every pole in 1/s, to be taken off what is identified
    used : (blows,) which blows are in the mean
    warnings : what is odd about the others
    """

    data: FrequencyResponses
    coherence: Floats
    decay: float
    used: tuple[bool, ...]
    warnings: tuple[str, ...]


def impact_responses(
    force: Floats,
    response: Floats,
    rate: float,
    quantity: str = "accelerance",
    *,
    estimator: Estimator = "H1",
    force_window: float | None = None,
    exponential: float | None = None,
    reference: str = "1",
    responses: tuple[str, ...] | None = None,
) -> ImpactResponses:
    """Return the functions of one reference from several blows.

    Parameters
    ----------
    force : (blows, samples)
    response : (blows, responses, samples)
    rate : samples per second
    force_window : seconds after the peak beyond which the force is set to zero
    exponential : time constant tau of the exponential window in seconds

    Double hits and overloads are left out and said. Raises ValueError where none is left, where
    the arrays do not fit, or for an unknown estimator.
    """
    force, response = np.asarray(force, float), np.asarray(response, float)
    if force.ndim != 2 or response.ndim != 3 or response.shape[::2] != force.shape:
        expected = "force (blows, samples) and response (blows, responses, samples)"
        raise ValueError(f"expected {expected}, found {force.shape} and {response.shape}")
    reasons = [_reason(x, y, rate, force_window) for x, y in zip(force, response, strict=True)]
    warnings = [f"blow {b + 1} is left out: {why}" for b, why in enumerate(reasons) if why]
    used = np.array([not why for why in reasons])
    if not used.any():
        raise ValueError("expected at least one good blow; " + "; ".join(warnings))
    X, Y = _spectra(force[used], response[used], rate, force_window, exponential)
    S_xx = np.sum(np.abs(X) ** 2, axis=0)
    S_yx = np.sum(Y * X[:, None].conj(), axis=0)
    S_yy = np.sum(np.abs(Y) ** 2, axis=0)
    if estimator == "H1":
        H = _over(S_yx, S_xx)
    elif estimator == "H2":
        H = _over(S_yy, S_yx.conj())
    elif estimator == "Hv":
        H = _over(S_yx, np.abs(S_yx)) * np.sqrt(_over(S_yy, S_xx).real)
    else:
        raise ValueError(f"expected estimator 'H1', 'H2' or 'Hv', found {estimator!r}")
    coherence = _over(np.abs(S_yx), S_xx).real * _over(np.abs(S_yx), S_yy).real
    blows = int(used.sum())
    unbiased = np.clip((blows * coherence - 1) / max(blows - 1, 1), 0.0, 1.0)
    data = frequency_responses(
        scipy.fft.rfftfreq(force.shape[1], 1 / rate),
        H,
        quantity,
        references=(reference,),
        responses=responses,
        coherence=unbiased[None] if blows > 1 else None,
        blows=blows if blows > 1 else None,
    )
    decay = 1 / exponential if exponential else 0.0
    return ImpactResponses(data, coherence, decay, tuple(map(bool, used)), tuple(warnings))


def without_decay(pole: complex, decay: float) -> tuple[float, float]:
    """Return frequency in Hz and damping ratio of a pole without the exponential window.

    >>> f, zeta = without_decay(complex(-2.0, 100.0), 1.0)
    >>> round(f, 4), round(zeta, 4)
    (15.9163, 0.01)
    """
    lam = pole + decay
    return abs(lam) / (2 * np.pi), -lam.real / abs(lam)


def _over(a: Complexes | Floats, b: Complexes | Floats) -> Complexes:
    """Return a / b, NaN where b is no more than rounding of its greatest value."""
    good = np.abs(b) > 1e-24 * np.abs(b).max(initial=0.0)
    out: Complexes = np.where(good, a / np.where(good, b, 1.0), np.nan).astype(complex)
    return out


def _reason(x: Floats, y: Floats, rate: float, force_window: float | None) -> str:
    """Return what is wrong with one blow; empty where nothing is."""
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        return "not all samples are numbers"
    if not np.any(x):
        return "there is no force"
    size = np.abs(x)
    peak = int(size.argmax())
    if _clipped(x):
        return "the force is overloaded"
    over = [i + 1 for i, channel in enumerate(y) if _clipped(channel)]
    if over:
        return f"response {over[0]} is overloaded"
    after = np.flatnonzero(size[peak:] < SECOND / 2 * size[peak])
    end = peak + int(after[0]) if len(after) else len(x)
    if force_window is not None:
        end = max(end, peak + int(force_window * rate))
    again = np.flatnonzero(size[end:] > SECOND * size[peak])
    if len(again):
        return f"a second hit {(end + again[0] - peak) / rate:.3g} s after the first"
    return ""


def _clipped(x: Floats) -> bool:
    top = np.abs(x) >= np.abs(x).max() * (1 - 1e-9)
    runs = np.convolve(top, np.ones(CLIPPED), "valid")
    return bool(np.any(x) and (runs >= CLIPPED).any())


def _spectra(
    force: Floats,
    response: Floats,
    rate: float,
    force_window: float | None,
    exponential: float | None,
) -> tuple[Floats, Floats]:
    """Return the spectra of force and responses after the windows."""
    samples = force.shape[1]
    t = np.arange(samples) / rate
    decay = np.exp(-t / exponential) if exponential else np.ones(samples)
    if force_window is not None:
        peaks = np.abs(force).argmax(axis=1)[:, None] / rate
        past = (t - peaks - force_window * (1 - TAPER)) / (force_window * TAPER)
        force = force * (0.5 + 0.5 * np.cos(np.pi * np.clip(past, 0, 1)))
    return scipy.fft.rfft(force * decay), scipy.fft.rfft(response * decay)
