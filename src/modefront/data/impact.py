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
force and responses alike, the functions are exactly those at :math:`s = \mathrm{i}\omega + 1/\tau`,
which the identification takes into account (Fladung & Brown, Multiple reference impact testing,
IMAC XI (1993)).

A record that stays at its greatest value, and gets there by more than the resolution of its
numbers, is overloaded. A second hit is a push beyond `SECOND` of the peak after the first impact
has ended.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
import scipy.fft

from modefront._typing import Complexes, Floats
from modefront.data.responses import ForceNoise, FrequencyResponses, frequency_responses
from modefront.rounding import ACCUMULATED

Estimator = Literal["H1", "H2", "Hv"]
ESTIMATORS: tuple[Estimator, ...] = get_args(Estimator)

SECOND = 0.1
"""Force of a second hit over that of the first."""

SAME = 1e-9
"""Difference of two samples, over the greatest, that is none: converters have 24 bits."""

TAPER = 0.1
"""Share of the force window over which it falls to zero."""


@dataclass(frozen=True)
class Windows:
    """Estimator and windows that make functions of records.

    Attributes
    ----------
    estimator : H1, H2 or Hv
    force_window : seconds after the peak beyond which the force is set to zero, or None
    exponential : time constant tau of the exponential window in seconds, by default a quarter of
        the record; infinity is no window, for responses that die out by themselves
    """

    estimator: Estimator = "H1"
    force_window: float | None = None
    exponential: float | None = None

    def __post_init__(self) -> None:
        """Raise ValueError for an unknown estimator."""
        if self.estimator not in ESTIMATORS:
            raise ValueError(f"expected estimator 'H1', 'H2' or 'Hv', found {self.estimator!r}")

    def of_force(self, force: Floats, t: Floats) -> Floats:
        """Return the force window of every blow, (blows, samples)."""
        if self.force_window is None:
            return np.ones(force.shape)
        peaks = t[np.abs(force).argmax(axis=1)][:, None]
        past = (t - peaks - self.force_window * (1 - TAPER)) / (self.force_window * TAPER)
        return 0.5 + 0.5 * np.cos(np.pi * np.clip(past, 0, 1))

    def decay(self, t: Floats) -> float:
        """Return the decay rate of the exponential window for records over times ``t``."""
        return 1 / (len(t) * t[1] / 4 if self.exponential is None else self.exponential)


@dataclass(frozen=True)
class ImpactResponses:
    """Functions from impacts.

    Attributes
    ----------
    data : the functions, with the variance of their mean from the scatter of the blows
    coherence : (responses, lines)
    left_out : (blows,) why each blow is not in the mean; empty where it is
    remaining : (responses,) rms at the end of the windowed records over the greatest
    """

    data: FrequencyResponses
    coherence: Floats
    left_out: tuple[str, ...]
    remaining: Floats


def impact_responses(
    force: Floats,
    response: Floats,
    rate: float,
    quantity: str = "accelerance",
    windows: Windows | None = None,
    responses: tuple[str, ...] | None = None,
) -> ImpactResponses:
    """Return the functions of one reference from several blows.

    Parameters
    ----------
    force : (blows, samples)
    response : (blows, responses, samples)
    rate : samples per second
    quantity : what responses over force are
    windows : estimator and windows
    responses : names

    Double hits and overloads are left out and said. What the exponential window adds to all decay
    rates is noted in the data, and `identify` takes it off. Raises ValueError where no blow is
    left, or where the arrays do not fit.
    """
    windows = windows or Windows()
    force, response = np.asarray(force, float), np.asarray(response, float)
    if force.ndim != 2 or response.ndim != 3 or response.shape[::2] != force.shape:
        expected = "force (blows, samples) and response (blows, responses, samples)"
        raise ValueError(f"expected {expected}, found {force.shape} and {response.shape}")
    blows = zip(force, response, strict=True)
    reasons = tuple(_reason(x, y, rate, windows.force_window) for x, y in blows)
    if all(reasons):
        faults = "; ".join(f"blow {b}: {why}" for b, why in enumerate(reasons, start=1))
        raise ValueError(f"expected at least one good blow, found none: {faults}")
    used = np.array([not why for why in reasons])
    force, response = force[used], response[used]
    t = np.arange(force.shape[1]) / rate
    decay = windows.decay(t)
    window = windows.of_force(force, t) * np.exp(-decay * t)
    y = response * np.exp(-decay * t)
    X, Y = scipy.fft.rfft(force * window), scipy.fft.rfft(y)
    H, coherence = _estimates(X, Y, windows.estimator)
    data = frequency_responses(
        scipy.fft.rfftfreq(force.shape[1], 1 / rate),
        H,
        quantity,
        responses=responses,
        variance=_variance(H, X, Y)[None] if len(X) > 1 else None,
    )
    noise = _force_noise(force, window, X, t)
    data = replace(data, decay=decay, force_noise=noise)
    size = max(y.shape[-1] // 20, 1)
    parts = y[..., : y.shape[-1] // size * size].reshape(*y.shape[:2], -1, size)
    rms = np.sqrt(np.mean(parts**2, axis=(0, 3)))
    remaining = rms[:, -1] / np.maximum(rms.max(axis=1), np.finfo(float).tiny)
    return ImpactResponses(data, coherence, reasons, remaining)


def _estimates(X: Complexes, Y: Complexes, estimator: Estimator) -> tuple[Complexes, Floats]:
    """Return the functions and the coherence, (responses, lines), of spectra of all blows."""
    S_xx = np.sum(np.abs(X) ** 2, axis=0)
    S_yx = np.sum(Y * X[:, None].conj(), axis=0)
    S_yy = np.sum(np.abs(Y) ** 2, axis=0)
    if estimator == "H1":
        H = _over(S_yx, S_xx)
    elif estimator == "H2":
        H = _over(S_yy, S_yx.conj())
    else:
        H = _over(S_yx, np.abs(S_yx)) * np.sqrt(_over(S_yy, S_xx).real)
    coherence: Floats = _over(np.abs(S_yx), S_xx).real * _over(np.abs(S_yx), S_yy).real
    return H, coherence


def _variance(H: Complexes, X: Complexes, Y: Complexes) -> Floats:
    r"""Return the variance of the functions from the scatter of the blows, (responses, lines).

    With :math:`e_b = Y_b - H X_b` and :math:`h_b = |X_b|^2 / S_{xx}`, it is
    :math:`\sum_b |X_b e_b|^2 / (1 - h_b) / S_{xx}^2`, also where hard blows have more noise than
    soft ones (MacKinnon & White, J. Econom. 29 (1985) 305-325, doi:10.1016/0304-4076(85)90158-7:
    HC2); coherence knows one level of noise only.
    """
    power = np.abs(X) ** 2
    share = _over(power, np.sum(power, axis=0)).real[:, None]
    e = np.abs(Y - H * X[:, None]) ** 2
    left = np.maximum(1 - share, np.finfo(float).eps)
    out: Floats = _over(np.sum(share * e / left, axis=0), np.sum(power, axis=0)).real
    return out


def _force_noise(force: Floats, window: Floats, X: Complexes, t: Floats) -> ForceNoise:
    """Return the effect of noise of the force channel on the functions, from samples after impacts.

    The second half of the records has no force; its scatter is the noise.
    """
    quiet = force[:, force.shape[1] // 2 :]
    level = np.mean((quiet - quiet.mean(axis=1, keepdims=True)) ** 2, axis=1)
    energy = window**2
    power = np.abs(X) ** 2
    of_blows = (level * energy.sum(axis=1))[:, None]
    variance = _over(np.sum(power * of_blows, axis=0), np.sum(power, axis=0) ** 2).real
    kept = energy[0] > 1e-4 * energy[0].max()
    times = t[kept] - t[np.abs(force[0]).argmax()]
    share = energy[0, kept] / energy[0, kept].sum()
    return ForceNoise(np.sqrt(np.nan_to_num(variance))[None], (times,), (share,))


def _over(a: Complexes | Floats, b: Complexes | Floats) -> Complexes:
    """Return a / b, NaN where the power b is no more than rounding of its greatest value."""
    good = np.abs(b) > ACCUMULATED**2 * np.abs(b).max(initial=0.0)
    out: Complexes = np.where(good, a / np.where(good, b, 1.0), np.nan).astype(complex)
    return out


def _reason(x: Floats, y: Floats, rate: float, force_window: float | None) -> str:
    """Return the fault of one blow; empty for a good one."""
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
    push = x[end:] * np.sign(x[peak])  # a filter that rings after the impact pulls first
    again = np.flatnonzero(push > SECOND * size[peak])
    if len(again):
        return f"a second hit {(end + again[0] - peak) / rate:.3g} s after the first"
    return ""


def _clipped(x: Floats) -> bool:
    """Return whether a record stays at its greatest value, and gets there in a leap.

    Digits of a coarse converter stay at the top of a smooth wave too, one step above the next.
    """
    if not np.any(x):
        return False
    size = np.abs(x)
    top = size >= size.max() * (1 - SAME)
    steps = np.abs(np.diff(x))
    least = steps[steps > SAME * size.max()].min(initial=np.inf)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], top, [False]]).astype(int)))
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        leaps = [steps[start - 1]] if start else []
        leaps += [steps[end - 1]] if end < len(x) else []
        if end - start >= 3 and max(leaps, default=0.0) > 2 * least:
            return True
    return False
