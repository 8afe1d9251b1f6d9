r"""Standard deviations of frequencies, damping ratios and shapes.

Errors of the data reach the parameters by the equations of docs/methods/deviations.md. Two things
break the independence of errors, and are measured on the residuals: noise of the force channel,
which all responses of a reference share, and correlation of neighbouring lines, by windows and zero
padding.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy.fft
import scipy.linalg as la
from scipy.special import chdtri

from modefront._typing import Complexes, Floats
from modefront.identification.modal_model import Fit
from modefront.identification.noise import square
from modefront.identification.problem import Problem, gram
from modefront.identification.record import MOST_COVARIED, ModeEstimate, Residuals
from modefront.identification.shapes import real_shape, real_shapes
from modefront.rounding import TINY

SIGNIFICANT = 3.0  # standard errors beyond which a correlation of the residuals is one
SILENT = 1e-3  # probability that a response that holds nothing but noise is taken for one that does
MOST_LAGS = 60  # lines over which correlations of the residuals are measured
MOST_TIMES = 400  # samples of the noise of the force; they are taken together where there are more
CHUNK = 1 << 20  # numbers in an array of effects of errors that are computed at once


def residuals(fit: Fit) -> Residuals:
    """Return correlation and size of the errors from the residuals of a fit."""
    task, r = fit.task, fit.residual
    size = np.where(task.weight > 0, square(task.H), 0).sum(axis=2)
    share = np.sqrt(square(r).sum(axis=2) / np.where(size > 0, size, np.nan))
    known = np.array([np.mean(x.deviation**2) for x in task.force_noise])
    force = known if task.force_noise else _force(fit)
    return Residuals(fit.misfit, _correlation(task, r), force, share)


def _correlation(task: Problem, r: Complexes) -> Complexes:
    """Return the correlations of a line with the next ones: those of the window, or measured.

    Measured ones count as long as they are significant.
    """
    if task.decay:
        return windowed_correlation(task.decay, len(task.s))
    e = np.sqrt(task.weight) * r
    total = max(float(np.sum(square(e))), TINY)
    out = [1.0 + 0.0j]
    for lag in range(1, min(MOST_LAGS, len(task.s) // 10) + 1):
        both = (task.weight[..., lag:] > 0) & (task.weight[..., :-lag] > 0)
        rho = complex(np.vdot(e[..., :-lag], e[..., lag:])) / total
        if rho.real < SIGNIFICANT / np.sqrt(2 * max(int(both.sum()), 1)):
            break
        out.append(rho)
    return np.array(out)


def windowed_correlation(decay: float, lines: int) -> Complexes:
    r"""Return the correlations of a line with the next ones after an exponential window, (lines,).

    ``decay`` is that of the window over the length T of the record, :math:`x = dT`. White noise of
    the record has the correlations

    .. math:: \rho_k = \int_0^T w^2 e^{-2\pi\mathrm{i}kt/T}\,\mathrm{d}t \Big/
              \int_0^T w^2\,\mathrm{d}t = \frac{1}{1 + \pi\mathrm{i}k/x},\qquad w = e^{-dt}.

    >>> windowed_correlation(2.0, 2).round(3)
    array([1.   +0.j   , 0.288-0.453j])
    """
    return np.asarray(1 / (1 + 1j * np.pi * np.arange(lines) / max(decay, TINY)), complex)


def correlated_gram(task: Problem, E: Complexes, correlation: Complexes) -> Floats:
    r"""Return Gram matrices for correlated lines, (references, responses, Q, Q).

    They are :math:`\sum_{kl} \operatorname{Re}(a_{pk}^* \rho_{k-l} a_{ql})` of the weighted
    primitives :math:`a = \sqrt{w} E`: in time, products of their transforms times that of the
    correlations, which is the energy of the noise.
    """
    lines, lags = E.shape[1], len(correlation)
    size = scipy.fft.next_fast_len(lines + lags)
    kernel = np.zeros(size, complex)
    kernel[:lags] = correlation
    kernel[size - lags + 1 :] = correlation[:0:-1].conj()
    energy = scipy.fft.fft(kernel).real.repeat(2) / size
    M = np.empty((*task.weight.shape[:2], len(E), len(E)))
    for place in np.ndindex(M.shape[:2]):
        a = scipy.fft.fft(np.sqrt(task.weight[place]) * E, size).view(float)
        M[place] = (a * energy) @ a.T
    return M


def _force(fit: Fit) -> Floats:
    """Return b of each reference; 0 where it is not significant."""
    w, H, r = fit.task.weight, fit.functions, fit.residual
    S = np.sum(w * H.conj() * r, axis=1)
    power, squares = w * square(H), w**2 * square(H) * square(r)
    per_line = square(S) - squares.sum(axis=1)
    below = (power.sum(axis=1) ** 2 - (power**2).sum(axis=1)).sum(axis=1)
    b = per_line.sum(axis=1)
    good = (b > SIGNIFICANT * np.sqrt((per_line**2).sum(axis=1))) & (below > 0)
    return np.where(good, b / np.where(below > 0, below, 1.0), 0.0)


def mode_estimates(fit: Fit, residuals: Residuals, omega: float) -> list[ModeEstimate]:
    """Return all modes of a fit with standard deviations; ``omega`` is the unit of the poles."""
    n = 2 * len(fit.lam)
    pole = [k for k, _, v in fit.alphas if v is None]
    shapes = [real_shape(phi) for phi in fit.phi]
    for r, s in fit.pairs:
        shapes[r], shapes[s] = real_shapes(fit.phi[[r, s]])
    inverse, follows = fit.inverted(fit.information), fit.Z[:, :n]
    Q = _covariances(fit, residuals)
    own, C = Q[:, :n, :n], inverse @ Q[:, n:, n:].sum(axis=0) @ inverse
    whole = fit.phi.shape[1] <= MOST_COVARIED
    spread = []
    for r, shape in enumerate(shapes):
        rows = slice(2 * r, 2 * r + 2)
        moved = follows[:, rows].reshape(2 * len(Q), -1)
        cross = (Q[:, rows, n:] @ inverse).reshape(moved.shape) @ moved.T
        both = la.block_diag(*own[:, rows, rows]) + moved @ C @ moved.T - cross - cross.T
        half = shape.differential(both[::2] + 1j * both[1::2]).T
        covariance = shape.differential(half[::2] + 1j * half[1::2])
        spread.append(covariance if whole else covariance.diagonal().copy())
    for steps, c in _force_influence(fit, residuals.force, inverse, follows):
        C = C + steps @ steps.T
        for r, shape in enumerate(shapes):
            change = shape.differential(c[:, 2 * r] + 1j * c[:, 2 * r + 1])
            spread[r] += change @ change.T if whole else np.vecdot(change, change)
    scale = max(residuals.chi2, 1.0)
    # Some responses show nothing that noise would not make of all shapes.
    known = fit.c[:, None] @ np.linalg.pinv(scale * own, hermitian=True) @ fit.c[..., None]
    gone = ~fit.task.weight.any(axis=(0, 2)) | (known[:, 0, 0] < chdtri(n, SILENT))
    out = []
    for r, covariance in enumerate(spread):
        covariance *= scale
        covariance[gone] = np.nan
        if whole:
            covariance[:, gone] = np.nan
        lam, of_pole = fit.lam[r], C[2 * pole[r] :, 2 * pole[r] :][:2, :2] * scale
        size = float(abs(lam))
        df = np.array([lam.real, lam.imag]) / size
        two = np.array([df, np.array([-1 / size, 0.0]) + lam.real / size**2 * df])
        f_std, zeta_std = np.sqrt(np.einsum("ka,ab,kb->k", two, of_pole, two)).tolist()
        pole_of, hertz_std = complex(lam) * omega, f_std * omega / (2 * np.pi)
        std = np.sqrt(np.maximum(covariance.diagonal() if whole else covariance, 0.0))
        kept, L = covariance if whole else None, fit.L[r]
        out.append(ModeEstimate(pole_of, hertz_std, zeta_std, shapes[r], std, L, kept))
    return out


def _covariances(fit: Fit, residuals: Residuals) -> Floats:
    """Return covariances of what independent errors dy of each response do, one matrix each.

    They are those of G^-1 Phi^T dy, (2 modes), and D_perp^T dy, (alphas). Noise of the force is
    taken out of the variance: it is not independent.
    """
    task, n = fit.task, len(fit.lam)
    E, T, X = fit.columns()
    first, weight = T.shape[1], task.weight
    if residuals.force.any():
        variance = residuals.force[:, None]
        if task.force_noise:
            variance = np.array([x.deviation**2 for x in task.force_noise])
        share = variance[:, None] * weight * square(fit.functions)
        weight = weight * np.maximum(1 - share, 0)
    alone = replace(task, weight=weight)
    rho = residuals.correlation
    M = correlated_gram(alone, E, rho) if len(rho) > 1 else gram(alone, E)
    P = np.zeros((*M.shape[:3], 2 * n + X.shape[3]))
    P[:, :, :first, : 2 * n] = T[:, None] @ fit.inverse[:, :, : 2 * n]
    P[..., 2 * n :] = X
    return (P.swapaxes(2, 3) @ (M @ P)).sum(axis=0) / 2


def _force_influence(
    fit: Fit, force: Floats, inverse: Floats, follows: Floats
) -> Iterator[tuple[Floats, Floats]]:
    """Yield changes of alpha and of the shapes by independent errors of the force, in portions.

    Those of the shapes are (responses, 2 modes, errors).
    """
    n = follows.shape[1]
    E, T, X = fit.columns()
    for j in np.flatnonzero(force).tolist():
        weighted = fit.task.weight[j] * fit.functions[j]
        for products in _force_products(fit.task, E, weighted, j, force[j]):
            y = np.concatenate([products.real, products.imag], axis=2)
            alpha = inverse @ np.einsum("iqa,iqk->ak", X[j], y, optimize=True)
            yield alpha, fit.inverse[:, :n] @ (T[j].T @ y[:, : T.shape[1]]) - follows @ alpha


def _force_products(
    task: Problem, E: Complexes, weighted: Complexes, j: int, b: float
) -> Iterator[Complexes]:
    """Yield products of the primitives with what errors of force j do, (responses, Q, errors).

    Errors are independent at every line or, where the noise is known in time, at every sample;
    samples closer than lines of the band can tell apart are taken together.
    """
    portion = max(CHUNK // max(weighted.shape[0] * len(E), 1), 1)
    if not task.force_noise:
        for start in range(0, len(task.s), portion):
            lines = slice(start, start + portion)
            yield E[:, lines].conj() * (np.sqrt(b / 2) * weighted[:, None, lines])
        return
    f, noise = task.s.imag, task.force_noise[j]
    step = max(np.pi / (f[-1] - f[0]), float(np.ptp(noise.times)) / MOST_TIMES)
    bins = np.floor((noise.times - noise.times.min()) / step).astype(int)
    share = np.bincount(bins, noise.share)
    kept = share > 0
    times = np.bincount(bins, noise.share * noise.times)[kept] / share[kept]
    error = noise.deviation[:, None] * np.exp(-1j * np.outer(f, times)) * np.sqrt(share[kept] / 2)
    effects = weighted[:, None] * E.conj()
    for start in range(0, len(times), portion):
        yield effects @ error[:, start : start + portion]
