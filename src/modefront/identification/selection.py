r"""Which modes are in the data: a pole is one where noise alone would hardly make it.

Without a mode the cost J of the fit is greater by :math:`\Delta J`. Where there is no mode, what a
pole somewhere in the band explains of noise is the greatest singular value of a residue,
:math:`\Delta J = \sigma_1^2`, of a matrix of references times responses of unit complex normal
numbers. The expected number of poles with more than x in a band of N lines, to the leading term,
is in docs/methods/identification.md:
the tail of the greatest eigenvalue of a complex Wishart matrix times the area of the poles
that N lines tell apart, :math:`\int\mathrm{d}\omega\,\mathrm{d}\sigma/4\sigma^2` with damping from
half a line on, as the correlation of two poles is :math:`4\sigma_1\sigma_2/|\lambda_1 +
\lambda_2^*|^2`. A mode is accepted where that number is below `FALSE`.

Poles come from the stabilisation diagram, and then from the residuals: wherever a pole would
explain more of the whitened residuals than noise does in every other test, one is added, until
nothing stands out. Backwards, :math:`\Delta J` of a mode is the Wald statistic of its shape.

Two modes are a *pair* where the data cannot tell their poles apart. Residues of two close poles are
:math:`C(sI - M)^{-1}B` with a matrix M, 2 by 2, whose eigenvalues are the poles. With one pole,
:math:`M = \lambda I`, the cost is greater by half a :math:`\chi^2` of six degrees of freedom, and
any basis of the plane of both shapes gives the same functions.

Sources: Johnstone, On the distribution of the largest eigenvalue in principal components analysis,
Ann. Stat. 29 (2001) 295-327, doi:10.1214/aos/1009210544 (the matrix); Adler & Taylor, *Random
Fields and Geometry*, 2007, doi:10.1007/978-0-387-48116-6, chapter 15 (maxima over a family).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.linalg as la
from scipy.special import gammaln
from scipy.stats import chi2

from modefront._typing import Bools, Complexes, Floats
from modefront.identification.modal_model import (
    CHUNK,
    COARSE,
    RESIDUALS,
    Fit,
    Problem,
    evaluate,
    free_factors,
    maximise,
    synthesise,
)
from modefront.identification.shapes import auto_mac, plane_basis
from modefront.identification.stabilisation import Cluster

FALSE = 1e-3
"""Expected number of modes in a band that noise alone makes."""

EVEN = 0.5
"""The same number from which on a pole is tried in the model."""

LIKELY = 0.5
"""Least support of a cluster from which the model starts."""

LEAST_ORDERS = 3
"""Orders on which a cluster has to be before the model starts from it."""

MOST_ROUNDS = 20
"""Rounds in which poles are added, at most."""

HEAVIEST = 0.1
"""Greatest damping ratio of the poles that are looked for in residuals."""

OVERDAMPED = 0.9
"""Damping ratio from which on a pole and its conjugate are nearly one and the same real pole."""

LEAST_UNLIKE = 1e-6
"""Least squared share of the derivative by a pole that no residual term can make up. In the normal
equations rounding takes some 1e-8; poles within the band have 0.1 and more."""

MOST_EVALUATIONS = 20
"""Evaluations of the model for a choice, which need not be at the very maximum."""

CLOSEST = 0.5
"""Distance of poles over the greater of their half bandwidths below which they are not told apart
without a difference of shapes."""

TRACES = 10.0
"""Gain of a pole over what the ones that are added already explain of it: a missing mode bends the
fit of its neighbours, too."""

ALONE = 0.25
"""Squared correlation with another pole below which a pole is judged for itself."""

SAME = 0.95
"""MAC of shapes that are the same."""

APART = 0.01
"""Probability that two modes of one pole are taken for modes of two."""

CLEARLY = 100.0
"""Squared difference of two poles in its deviations from which on they are no pair: close poles
are not normally distributed, and are told apart by the likelihood below."""

PAIR_FREEDOM = 6
"""Real numbers of a matrix, 2 by 2, beyond those of one pole."""


def freedom(task: Problem, fit: Fit) -> int:
    """Return the degrees of freedom of the residuals."""
    n_out = int(np.sum(task.weights.any(axis=(0, 2))))
    return max(task.count - n_out * fit.inverse.shape[1] - len(fit.gradient), 1)


def noise_level(task: Problem, fit: Fit) -> float:
    """Return chi^2, the cost over the degrees of freedom; at least 1, the variance of the data.

    Where the noise of neighbouring lines is correlated, as much less is known.
    """
    return max(2 * fit.cost / freedom(task, fit), 1.0) * task.correlation


def needed(task: Problem, expected: float = FALSE) -> float:
    """Return 2 Delta J of which noise of unit variance makes so many poles in the band."""
    measured: Bools = np.any(task.weights, axis=2)
    n_in, n_out = (int(np.count_nonzero(measured.any(axis=axis))) for axis in (1, 0))
    k = n_in + n_out
    ways = gammaln(k - 1) - gammaln(n_in) - gammaln(n_out)
    poles = np.log(len(task.s) * (k - 1) / (2 * np.pi)) + ways
    return float(chi2.isf(min(expected * np.exp(-poles), 0.5), 2 * k))


def choose_level(task: Problem, fit: Fit) -> Problem:
    """Return the problem with the number of residual terms of the least BIC, poles held.

    Source: Schwarz, Ann. Stat. 6 (1978) 461-464, doi:10.1214/aos/1176344136.
    """
    best, least = task, np.inf
    measured = int(np.count_nonzero(task.weights.any(axis=2)))
    model = fit.model
    for powers in RESIDUALS:
        trial = replace(task, powers=powers)
        cost = evaluate(trial, model.lam, model.L, model.held).cost
        value = 2 * cost / noise_level(task, fit) + measured * len(powers) * np.log(task.count)
        if value < least:
            best, least = trial, value
    return best


def gains(task: Problem, fit: Fit) -> Floats:
    """Return 2 Delta J of every mode in units of the noise, (modes,).

    It is the Wald statistic of a shape whose poles are held, while all else may follow: with the
    covariance B + Z A^-1 Z^T, B of the shape's own equations, A of all other alphas.
    """
    seen: Bools = np.any(task.weights, axis=(0, 2))
    out, n = np.zeros(len(fit.model)), len(fit.model)
    owner = np.append(
        np.arange(n).repeat(2),
        np.repeat([r for r, _ in free_factors(fit.model.held, len(task.H))], 2),
    )
    for r, phi in enumerate(fit.model.phi[:, seen]):
        rows, others = slice(2 * r, 2 * r + 2), owner != r
        block = np.broadcast_to(fit.inverse[:, rows, rows], (len(seen), 2, 2))[seen]
        Z = fit.Z[seen][:, rows][..., others]
        c = np.stack([phi.real, phi.imag], axis=1)[..., None]
        both = np.linalg.solve(block, np.concatenate([c, Z], axis=2))
        W = both.reshape(-1, both.shape[2])
        S = np.concatenate([c, Z], axis=2).reshape(W.shape).T @ W
        A = S[1:, 1:] + fit.information[np.ix_(others, others)]
        follows = S[0, 1:] @ la.lstsq(A, S[1:, 0])[0] if len(A) else 0.0
        out[r] = S[0, 0] - follows
    return 2 * out / noise_level(task, fit)


def start(task: Problem, clusters: Sequence[Cluster], omega: float) -> Fit:
    """Return the fit from the likely clusters."""
    likely = [each for each in clusters if each.support >= LIKELY and each.size >= LEAST_ORDERS]
    lam = np.array([cluster.pole / omega for cluster in likely], complex)
    L: Complexes = np.array([cluster.participation for cluster in likely], complex)
    return refit(task, lam, L.reshape(len(lam), len(task.H)))


def refit(
    task: Problem,
    lam: Complexes,
    L: Complexes,
    tolerance: float = COARSE,
    most: int = MOST_EVALUATIONS,
) -> Fit:
    """Return the fit from given poles, without those that are residual terms.

    Poles that become overdamped, and those of which changes are changes of the residual terms,
    stand for what modes outside the band leave. They would make the information of all other
    parameters singular.
    """
    while True:
        fit = maximise(task, lam, L, most, tolerance)
        lam, L = fit.model.lam, fit.model.L
        over = -lam.real > OVERDAMPED * np.abs(lam)
        over |= fit.unlike[: 2 * len(lam)].reshape(-1, 2).min(axis=1, initial=1.0) < LEAST_UNLIKE
        if not over.any():
            return fit
        lam, L = lam[~over], L[~over]


def backward(task: Problem, fit: Fit, least: float, count: int | None = None) -> Fit:
    """Return the fit without modes that gain less, the weakest first, and without doubles.

    Where the ``count`` of modes is given, the strongest are kept instead.
    """
    while len(fit.model):
        gain, lam = gains(task, fit), fit.model.lam
        weak = gain < least if count is None else gain.argsort().argsort() < len(gain) - count
        gone = doubles(lam, fit.model.phi, gain)
        if gone.any():  # shapes of a pair may be alike by chance
            gone[[k for pair in paired(task, fit, gone).model.pairs for k in pair]] = False
        for r in gain.argsort()[: weak.sum()]:  # neighbours may stand for one and the same mode
            gone[r] |= (alike(lam[r], lam[gone]) < ALONE).all()
        if not gone.any():
            return fit
        fit = refit(task, fit.model.lam[~gone], fit.model.L[~gone])
    return fit


def grow(task: Problem, fit: Fit, count: int | None = None) -> Fit:
    """Return the fit with the modes that stand out of its residuals, until none does."""
    blocked: Complexes = np.zeros(0, complex)
    for _ in range(MOST_ROUNDS):
        lam, L = standing_out(task, fit, blocked, count)
        if not len(lam):
            break
        model = fit.model
        trial = refit(task, np.append(model.lam, lam), np.vstack([model.L, L]))
        trial = backward(task, trial, needed(task), count)
        gained = 2 * (fit.cost - trial.cost) / noise_level(task, trial)
        if len(trial.model) <= len(model) and gained < needed(task):
            blocked = np.append(blocked, lam)
        else:
            fit = trial
    return fit


def standing_out(
    task: Problem, fit: Fit, blocked: Complexes, count: int | None = None
) -> tuple[Complexes, Complexes]:
    """Return poles that explain more of the residuals than noise would, and their factors.

    Where the ``count`` of modes is given, they are as many as lack.
    """
    lam, gain, L = explained(task, task.H - synthesise(task, fit.model))
    gain = gain / noise_level(task, fit)
    least = needed(task, EVEN) if count is None else 0.0
    most = len(lam) if count is None else count - len(fit.model)
    chosen: list[int] = []
    for c in gain.argsort()[::-1]:
        if gain[c] < least or len(chosen) >= most:
            break
        of_others = np.sum(gain[chosen] * alike(lam[c], lam[chosen]))
        if gain[c] > TRACES * of_others and (alike(lam[c], blocked) < ALONE).all():
            chosen.append(int(c))
    return lam[chosen], L[chosen]


def paired(task: Problem, fit: Fit, among: Bools) -> Fit:
    """Return the fit in which modes are pairs whose poles the data cannot tell apart.

    The closest are tried first, of which one at least is ``among`` some, (modes,), and which are
    not clearly apart by their deviations. Real parts of the shapes of a pair are orthonormal.
    """
    lam, pairs = fit.model.lam, fit.model.pairs
    apart = np.abs(lam[:, None] - lam) / np.maximum.outer(-lam.real, -lam.real)
    close = np.argwhere(np.triu(apart < 1, 1)) if len(task.H) > 1 else np.zeros((0, 2), int)
    C = np.linalg.pinv(fit.information, hermitian=True) * noise_level(task, fit) / 2
    for r, s in close[apart[tuple(close.T)].argsort()].tolist():
        if {r, s} & {k for pair in pairs for k in pair} or not among[[r, s]].any():
            continue
        difference = np.array([(lam[r] - lam[s]).real, (lam[r] - lam[s]).imag])
        both = np.zeros((2, len(C)))
        both[[0, 1], [2 * r, 2 * r + 1]], both[[0, 1], [2 * s, 2 * s + 1]] = 1.0, -1.0
        if difference @ np.linalg.solve(both @ C @ both.T, difference) > CLEARLY:
            continue
        model = fit.model
        start = model.lam.copy()
        start[[r, s]] = (lam[r] + lam[s]) / 2
        trial = maximise(task, start, model.L, pairs=(*pairs, (r, s)))
        lost = 2 * (trial.cost - fit.cost) / noise_level(task, fit)
        if lost < chi2.isf(APART, PAIR_FREEDOM):
            L = trial.model.L.copy()
            for pair in map(list, trial.model.pairs):
                L[pair] = np.linalg.solve(plane_basis(trial.model.phi[pair]).T, L[pair])
            pairs = trial.model.pairs
            fit = replace(
                evaluate(task, trial.model.lam, L, trial.model.held, pairs),
                evaluations=trial.evaluations,
                converged=trial.converged,
            )
    return fit


def seeded(task: Problem, fit: Fit, omega: Floats) -> tuple[Complexes, Complexes]:
    """Return the poles of a fit and one at each frequency that lies in no bandwidth of theirs.

    Also returns their participation factors; the damping is that which explains most of the
    residuals.
    """
    lam, gain, factors = explained(task, task.H - synthesise(task, fit.model))
    out, L = fit.model.lam, fit.model.L
    for each in omega:
        if (np.abs(np.abs(out) - each) < -out.real).any():
            continue
        near = np.where(np.abs(lam.imag - each) <= -lam.real, gain, -1.0).argmax()
        out = np.append(out, complex(lam[near].real, each))
        L = np.vstack([L, factors[near]])
    return out, L


def alike(pole: complex, others: Complexes) -> Floats:
    """Return the squared correlation of a pole's function with those of others."""
    out: Floats = 4 * pole.real * others.real / np.abs(pole + others.conj()) ** 2
    return out


def explained(task: Problem, r: Complexes) -> tuple[Complexes, Floats, Complexes]:
    """Return poles all over the band, 2 Delta J of each in residuals r, and its factors.

    Half bandwidths go up by factors of two from the distance of lines, as do the steps.
    """
    f, step = task.s.imag, float(np.median(np.diff(task.s.imag)))
    doublings = max(int(np.log2(max(HEAVIEST * f[-1] / step, 1))), 0) + 1
    parts = [-(step * 2**m) + 1j * f[:: 2**m] for m in range(doublings)]
    lam = np.concatenate([part[-part.real < HEAVIEST * part.imag] for part in parts])
    n_in, n_out, lines = r.shape
    weighted = np.where(task.weight > 0, task.weight * r, 0).reshape(-1, lines)
    w = task.weight.reshape(-1, lines)
    gain, L = np.zeros(len(lam)), np.ones((len(lam), n_in), complex)
    size = max(CHUNK // lines, 1)
    for first in range(0, len(lam), size):
        part = slice(first, first + size)
        e = task.s[:, None] ** task.order / (task.s[:, None] - lam[part])
        G = (w @ (e.real**2 + e.imag**2)).reshape(n_in, -1, e.shape[1])
        b = (weighted @ e.conj()).reshape(n_in, n_out, -1)
        z = (b / np.sqrt(np.where(G > 0, G, np.inf))).transpose(2, 0, 1)
        value, vector = np.linalg.eigh(z @ z.conj().swapaxes(1, 2))
        gain[part] = 2 * value[:, -1]
        scale = np.sqrt(np.maximum(G.mean(axis=1).T, np.finfo(float).tiny))
        L[part] = vector[:, :, -1] / scale
    return lam, gain, L


def doubles(poles: Complexes, shapes: Complexes, strength: Floats) -> Bools:
    """Return which modes lie within half the bandwidth of a stronger one and have its shape.

    Nonlinearity, leakage and drift make peaks that two poles fit better than one.
    """
    half = CLOSEST * np.maximum.outer(-poles.real, -poles.real)
    near = np.abs(poles[:, None] - poles) < half
    weaker = strength[:, None] < strength
    return np.asarray(np.any(near & (auto_mac(shapes) > SAME) & weaker, axis=1))
