"""The variance of frequency response functions, smooth over frequency.

Where nothing is known, the first raw values are fourth differences over neighbouring lines, which
no smooth function passes, made robust by running medians. The model is that of
docs/methods/deviations.md.
"""

import numpy as np
from scipy.ndimage import median_filter

from modefront._typing import Complexes, Floats
from modefront.rounding import TINY

WINDOW = 21  # lines of a running median
LINES_A_HAT = 30  # lines a hat function, enough for its coefficient to be known within some 20 %
MOST_HATS = 16  # hat functions over the band: noise of sensors and amplifiers is smooth
MOST_BLOCKS = 600  # blocks of lines that raw values are averaged over before the fit
ITERATIONS = 60  # multiplicative steps, after which coefficients change by less than their errors
ROUNDING = 1e-14  # least variance over the mean square of a function: files hold some seven digits


def square(values: Complexes) -> Floats:
    """Return squared absolute values; without their roots that takes a third of the time."""
    return values.real**2 + values.imag**2


def variance_from_differences(H: Complexes) -> Floats:
    """Return the variance that neighbouring lines show, of the shape of ``H``; NaN stays.

    It is the running median of squared differences, which peaks do not reach.
    """
    known = np.where(np.isfinite(H), H, 0) / np.sqrt(70)  # 1 + 16 + 36 + 16 + 1
    raw = np.pad(square(np.diff(known, 4)), [(0, 0), (0, 0), (2, 2)], mode="edge")
    medians = median_filter(raw, (1, 1, WINDOW), mode="nearest") / np.log(2)  # of mean 1: ln 2
    power = ROUNDING * np.mean(square(known), axis=-1, keepdims=True)
    least = np.maximum(power, 1e-3 * np.median(medians, axis=-1, keepdims=True))
    return np.where(np.isfinite(H), np.maximum(medians, least + TINY), np.nan)


def fitted_variance(raw: Floats, H: Complexes) -> Floats:
    """Return the smooth variance of each function from raw values at its lines.

    ``raw`` and ``H`` are (references, responses, lines), NaN where nothing is known; the result is
    known at all lines of each function with at least one raw value.
    """
    lines = raw.shape[-1]
    flat = raw.reshape(-1, lines)
    power = np.nan_to_num(square(H.reshape(-1, lines)))
    number = int(np.clip(lines // LINES_A_HAT, 2, MOST_HATS))
    knots = np.linspace(0, max(lines - 1, 1), number)
    hats = np.array([np.interp(np.arange(lines), knots, unit) for unit in np.eye(number)])
    known = np.isfinite(flat)
    blocks = np.linspace(0, lines, min(lines, MOST_BLOCKS) + 1).astype(int)[:-1]

    def block(values: Floats) -> Floats:
        return np.add.reduceat(values, blocks, axis=-1)

    count = block(known.astype(float))
    share = 1 / np.maximum(count, 1)
    q = block(np.where(known, flat, 0.0)) * share
    p = block(np.where(known, power, 0.0)) * share
    D = block(hats) / block(np.ones(lines))
    mean = q.sum(axis=1, keepdims=True) / np.maximum((count > 0).sum(axis=1, keepdims=True), 1)
    mean = np.maximum(mean, TINY)
    q = q / mean
    size = np.maximum(p.mean(axis=1, keepdims=True), TINY)
    p = p / size
    c, b = np.full((len(q), len(D)), 0.5), np.full((len(q), 1), 0.5)
    for _ in range(ITERATIONS):
        v = np.maximum(c @ D + b * p, 1e-12)
        up, down = count * q / v**2, count / v
        c = c * ((up @ D.T) / np.maximum(down @ D.T, 1e-300))
        b = b * (
            (up * p).sum(axis=1, keepdims=True)
            / np.maximum((down * p).sum(axis=1, keepdims=True), 1e-300)
        )
    v = c @ hats + b * power / size
    floor = np.maximum(1e-4 * np.median(v, axis=1, keepdims=True), TINY)
    out = np.maximum(v, floor) * mean
    out = np.maximum(out, ROUNDING * power.mean(axis=1, keepdims=True))
    out[~known.any(axis=1)] = np.nan
    return out.reshape(raw.shape)
