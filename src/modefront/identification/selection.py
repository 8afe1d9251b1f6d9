r"""Which modes are in the data: a likelihood ratio decides, forwards and backwards.

Candidates are the clusters of the stabilisation diagram. With n data and k parameters a mode, a
mode is kept where it lowers the Bayesian information criterion (Schwarz 1978),

.. math:: 2\,\Delta J / \chi^2 > k \ln n,\qquad k = 2 + 2 (n_\mathrm{ref} - 1) + 2 n_\mathrm{resp},

with the noise level :math:`\chi^2` of the fit. Backwards, :math:`2\Delta J` of a mode that is left
out is the Wald statistic of its shape, from the covariance that the fit has anyway. Forwards,
what a pole of the diagram would explain of the residuals ranks the candidates, and the best are
tried in the model.

A mode that data need is not yet a mode of the structure: weak nonlinearity, leakage and drift
need poles too. A mode is *accepted* where, besides, its frequency lies within the band, its
damping ratio is below `MOST_DAMPING`, frequency and damping are determined (`WIDEST`), its poles
are on most orders from the first one on (`SUPPORT`), and it does not double a stronger one.
All others stay in the model, so that they do not bias their neighbours, and are listed as
rejected with the reason.

Source: Schwarz, Estimating the dimension of a model, Ann. Stat. 6 (1978) 461-464,
doi:10.1214/aos/1176344136.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modefront._typing import Bools, Complexes, Floats
from modefront.identification.modal_model import (
    CHUNK,
    COARSE,
    RESIDUALS,
    Fit,
    Problem,
    evaluate,
    maximise,
    primitives,
    synthesise,
)
from modefront.identification.stabilisation import Cluster

LIKELY = 0.5
"""Least support of a cluster from which the model starts."""

LEAST_ORDERS = 3
"""Orders on which a cluster has to be before it is a candidate."""

TRIES = 2
"""Candidates that are tried before no mode is added."""

MOST_ADDED = 8
"""Modes that are added to those of the clusters, at most."""

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

TRIAL_EVALUATIONS = 12
"""Evaluations of the model for a candidate on trial."""


def noise_level(task: Problem, fit: Fit) -> float:
    """Return chi^2, the cost over the degrees of freedom; at least 1, the variance of the data.

    Where the noise of neighbouring lines is correlated, as much less is known.
    """
    n_out = int(np.sum(task.weight.any(axis=(0, 2))))
    freedom = max(task.count - n_out * fit.inverse.shape[1] - len(fit.gradient), 1)
    return max(2 * fit.cost / freedom, 1.0) * task.correlation


def price(task: Problem) -> float:
    """Return k ln n, what a mode has to gain."""
    measured = task.weight.max(axis=2, initial=0.0) > 0
    n_in, n_out = (int(np.count_nonzero(measured.any(axis=axis))) for axis in (1, 0))
    return float((2 * n_in + 2 * n_out) * np.log(max(task.count, 2)))


def choose_level(task: Problem, fit: Fit) -> Problem:
    """Return the problem with the number of residual terms of the least BIC, poles held."""
    best, least = task, np.inf
    measured = int(np.count_nonzero(task.weight.any(axis=2)))
    model = fit.model
    for powers in RESIDUALS:
        trial = replace(task, powers=powers)
        cost = evaluate(trial, model.lam, model.L, model.held).cost
        value = 2 * cost / noise_level(task, fit) + measured * len(powers) * np.log(task.count)
        if value < least:
            best, least = trial, value
    return best


def gains(task: Problem, fit: Fit) -> Floats:
    """Return for every mode the Wald statistic of its shape in units of the noise, (modes,)."""
    out = np.zeros(len(fit.model))
    for r in range(len(out)):
        rows = slice(2 * r, 2 * r + 2)
        block = fit.inverse[:, rows, rows]
        c = np.stack([fit.model.phi[r].real, fit.model.phi[r].imag], axis=1)
        seen = task.weight.any(axis=(0, 2))
        out[r] = np.einsum(
            "ia,ia->", c[seen], np.linalg.solve(block[seen], c[seen, :, None])[..., 0]
        )
    return 2 * out / noise_level(task, fit)


def start(task: Problem, clusters: Sequence[Cluster], omega: float, count: int | None) -> Fit:
    """Return the fit from the likely clusters, or from the best ``count`` of them."""
    likely = [each for each in clusters if each.support >= LIKELY and each.size >= LEAST_ORDERS]
    if count is not None:
        likely = sorted(clusters, key=lambda cluster: -cluster.support * cluster.size)[:count]
    lam = (np.array([cluster.pole for cluster in likely], complex) / omega).astype(complex)
    n_in = task.weight.shape[0]
    L: Complexes = np.array([cluster.participation for cluster in likely], complex).reshape(
        len(lam), n_in
    )
    return maximise(task, lam, L, MOST_EVALUATIONS, COARSE)


def backward(task: Problem, fit: Fit) -> Fit:
    """Return the fit without modes that gain less than their price, the weakest first."""
    while len(fit.model):
        gain = gains(task, fit)
        if gain.min() >= price(task):
            return fit
        fit = without(task, fit, int(gain.argmin()))
    return fit


def refit(task: Problem, fit: Fit, tolerance: float = COARSE, most: int = MOST_EVALUATIONS) -> Fit:
    """Return the fit from the poles of another one, without poles that are residual terms.

    Poles that become overdamped, and those of which changes are changes of the residual terms,
    stand for what modes outside the band leave. They would make the information of all other
    parameters singular.
    """
    while True:
        fit = maximise(task, fit.model.lam, fit.model.L, most, tolerance)
        lam = fit.model.lam
        over = -lam.real > OVERDAMPED * np.abs(lam)
        over |= fit.unlike[: 2 * len(lam)].reshape(-1, 2).min(axis=1, initial=1.0) < LEAST_UNLIKE
        if not over.any():
            return fit
        fit = replace(fit, model=replace(fit.model, lam=lam[~over], L=fit.model.L[~over]))


def without(task: Problem, fit: Fit, mode: int) -> Fit:
    """Return the fit that is left without one mode."""
    kept = np.arange(len(fit.model)) != mode
    return maximise(task, fit.model.lam[kept], fit.model.L[kept], MOST_EVALUATIONS, COARSE)


def forward(task: Problem, fit: Fit, candidates: Complexes) -> tuple[Fit, Complexes]:
    """Return the fit with one more mode where a candidate pays its price, else the same fit.

    Also returns the candidates that are left: one that was added once and does not stay is not
    added again.
    """
    r = np.where(task.weight > 0, task.H - synthesise(task, fit.model), 0)
    gain, L = candidate_gains(task, r, candidates)
    level = noise_level(task, fit)
    trials: list[complex] = []
    for candidate in gain.argsort()[::-1]:
        lam = complex(candidates[candidate])
        if len(trials) == TRIES or 2 * gain[candidate] / level < price(task) / 2:
            break
        if any(abs(lam - pole) < CLOSEST * abs(pole.real) for pole in trials):
            continue
        trials.append(lam)
        model = fit.model
        L_all = np.vstack([model.L, L[candidate]])
        trial = maximise(task, np.append(model.lam, lam), L_all, TRIAL_EVALUATIONS, COARSE)
        if splits(trial.model.lam):
            continue
        gained = 2 * (fit.cost - trial.cost) / noise_level(task, trial)
        if gained > price(task) and gains(task, trial).min() > price(task):
            return trial, candidates[np.abs(candidates - lam) > -lam.real]
    return fit, candidates


def splits(poles: Complexes) -> bool:
    """Return whether the last pole comes within `CLOSEST` of another one.

    Nonlinearity and leakage make peaks that two poles with nearly opposite residues fit better than
    one; neither has the shape of the mode then.
    """
    width = np.maximum(-poles[:-1].real, -poles[-1].real)
    return bool((np.abs(poles[:-1] - poles[-1]) < CLOSEST * width).any())


def distinct(poles: Complexes) -> Complexes:
    """Return poles of which none lies within half the half bandwidth of another."""
    kept: list[complex] = []
    for pole in sorted(poles, key=lambda pole: pole.real):
        if all(abs(pole - other) > -CLOSEST * other.real for other in kept):
            kept.append(complex(pole))
    return np.array(kept, complex)


def candidate_gains(task: Problem, r: Complexes, lam: Complexes) -> tuple[Floats, Complexes]:
    """Return gains and participation factors of candidates, in portions of them."""
    size = max(CHUNK // len(task.s), 1)
    parts = [_gains(task, r, lam[first : first + size]) for first in range(0, len(lam), size)]
    if not parts:
        return np.zeros(0), np.zeros((0, len(task.weight)), complex)
    return np.concatenate([gain for gain, _ in parts]), np.concatenate([L for _, L in parts])


def _gains(task: Problem, r: Complexes, lam: Complexes) -> tuple[Floats, Complexes]:
    """Return how much of the cost a pole could take at most without moving the others.

    Also returns the participation factors of the residues that do so, (poles, references).
    """
    E = primitives(replace(task, powers=()), lam, squares=False)
    e, o = E[::2], E[1::2]
    w = task.weight.reshape(-1, len(task.s))
    G = np.empty((len(w), len(lam), 2, 2))
    G[..., 0, 0], G[..., 1, 1] = w @ (np.abs(e) ** 2).T, w @ (np.abs(o) ** 2).T
    G[..., 0, 1] = G[..., 1, 0] = w @ (e.conj() * o).real.T
    weighted = (task.weight * r).reshape(w.shape)
    b = np.stack([(weighted @ e.conj().T).real, (weighted @ o.conj().T).real], axis=-1)
    ok = G[..., 0, 0] > 0
    G[~ok] = np.eye(2)
    x = np.linalg.solve(G, b[..., None])[..., 0]
    gain = np.einsum("fca,fca->c", b, x)
    residue = (x[..., 0] + 1j * x[..., 1]).T.reshape(len(lam), *task.weight.shape[:2])
    return gain, np.linalg.svd(residue, full_matrices=False)[0][:, :, 0]


def doubles(poles: Complexes, shapes: Complexes, strength: Floats) -> Bools:
    """Return which modes lie within half the bandwidth of a stronger one and have its shape."""
    out = np.zeros(len(poles), bool)
    for r in range(len(poles)):
        for s in np.flatnonzero(strength > strength[r]):
            near = abs(poles[r] - poles[s]) < CLOSEST * max(-poles[r].real, -poles[s].real)
            inner = np.abs(np.vdot(shapes[r], shapes[s])) ** 2
            mac = inner / (np.sum(np.abs(shapes[r]) ** 2) * np.sum(np.abs(shapes[s]) ** 2))
            out[r] |= bool(near and mac > 0.95)
    return out
