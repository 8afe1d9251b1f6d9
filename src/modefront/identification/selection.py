r"""Which modes are in the data: a pole is one where noise alone would hardly make it.

Evidence, noise and pairs are those of docs/methods/identification.md. Poles come from the
stabilisation diagram, and then from the residuals: wherever a pole would explain more of them than
noise does in every other test, one is added, until nothing stands out. Backwards,
:math:`\Delta J` of a mode is the Wald statistic of its shape.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.linalg as la
from scipy.special import gammaln
from scipy.stats import chi2

from modefront._typing import Bools, Complexes, Floats
from modefront.identification.lscf import Poles
from modefront.identification.modal_model import (
    COARSE,
    Fit,
    evaluate,
    free_factors,
    maximise,
    synthesise,
    thinned,
)
from modefront.identification.noise import square
from modefront.identification.problem import RESIDUALS, Problem
from modefront.identification.scan import alike
from modefront.identification.shapes import auto_mac, plane_basis

FALSE = 1e-3
"""Expected number of modes in a band that noise alone makes."""

EVEN = 0.5
"""The same number from which on a pole is tried in the model."""

MOST_ROUNDS = 20
"""Rounds in which poles are added, at most."""

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


def needed(task: Problem, expected: float = FALSE) -> float:
    """Return 2 Delta J of which noise of unit variance makes so many poles in the band."""
    n_in, n_out = task.live
    k = n_in + n_out
    ways = gammaln(k - 1) - gammaln(n_in) - gammaln(n_out)
    poles = np.log(len(task.s) * (k - 1) / (2 * np.pi)) + ways
    return float(chi2.isf(min(expected * np.exp(-poles), 0.5), 2 * k))


def choose_level(fit: Fit) -> Fit:
    """Return the fit with the number of residual terms of the least AIC, poles held.

    A term too few shifts frequencies, one too many costs next to nothing. Source: Akaike, IEEE
    Trans. Autom. Control 19 (1974) 716-723, doi:10.1109/TAC.1974.1100705.
    """
    few, model, found = thinned(fit, fit.model.lam), fit.model, fit.found
    measured = int(np.count_nonzero(fit.task.weights.any(axis=2)))
    noise = float(np.median(found.noise[found.lam.real == found.lam.real.min()]))
    best = min(
        (evaluate(replace(few, powers=p), model.lam, model.L, model.held) for p in RESIDUALS),
        key=lambda trial: 2 * trial.cost / noise + 2 * measured * len(trial.task.powers),
    )
    return of_all_lines(best, replace(fit.task, powers=best.task.powers))


def gains(fit: Fit) -> Floats:
    """Return 2 Delta J of every mode in units of the noise beside it, (modes,).

    It is the Wald statistic of a shape whose poles are held, while all else may follow: with the
    covariance B + Z A^-1 Z^T, B of the shape's own equations, A of all other alphas.
    """
    seen: Bools = np.any(fit.task.weights, axis=(0, 2))
    out, n = np.zeros(len(fit.model)), len(fit.model)
    owner = np.append(
        np.arange(n).repeat(2),
        np.repeat([r for r, _ in free_factors(fit.model.held, len(fit.task.H))], 2),
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
    return 2 * out / fit.found.noise_of(fit.model.lam)


def start(task: Problem, poles: Poles, omega: float) -> Fit:
    """Return the fit from poles in rad/s, ``omega`` of which are the unit of the task."""
    lam, L = poles.value / omega, poles.participation
    return refit(evaluate(task, lam, L, np.abs(L).argmax(axis=1)), lam, L)


def refit(fit: Fit, lam: Complexes, L: Complexes, fine: bool = False) -> Fit:
    """Return the fit of the same data from other poles, without those that are residual terms.

    The maximum is sought on means of lines, and on all lines only where it is to be ``fine``.
    Poles that become overdamped, and those of which changes are changes of the residual terms,
    stand for what modes outside the band leave. They would make the information of all other
    parameters singular.
    """
    task, few = fit.task, thinned(fit, lam)
    while True:
        fit = maximise(few, lam, L, MOST_EVALUATIONS, COARSE)
        if fine:
            fit = maximise(task, fit.model.lam, fit.model.L)
        lam, L = fit.model.lam, fit.model.L
        over = -lam.real > OVERDAMPED * np.abs(lam)
        over |= fit.unlike[: 2 * len(lam)].reshape(-1, 2).min(axis=1, initial=1.0) < LEAST_UNLIKE
        if not over.any():
            break
        lam, L = lam[~over], L[~over]
    return of_all_lines(fit, task)


def of_all_lines(fit: Fit, task: Problem) -> Fit:
    """Return a fit to means of the lines of a problem as one to these lines."""
    if fit.task is task:
        return fit
    r = task.H - synthesise(task, fit.model)
    return replace(fit, task=task, cost=float(np.sum(task.weight * square(r))))


def backward(fit: Fit, count: int | None = None) -> Fit:
    """Return the fit without modes that gain less than needed, the weakest first, and doubles.

    Where the ``count`` of modes is given, the strongest are kept instead.
    """
    while len(fit.model):
        gain, lam, least = gains(fit), fit.model.lam, needed(fit.task)
        gone = doubles(lam, fit.model.phi, gain)
        if gone.any():  # shapes of a pair may be alike by chance
            both = paired(fit, gone).model.pairs
            gone[[k for pair in both for k in pair]] = False
        if count is not None:
            least = np.sort(gain)[::-1][count - 1] if count < len(gain) else -np.inf
        gone = with_weak(gone, gain, least, lam)
        if not gone.any():
            return fit
        fit = refit(fit, lam[~gone], fit.model.L[~gone])
    return fit


def with_weak(gone: Bools, gain: Floats, least: float, lam: Complexes) -> Bools:
    """Return which modes go, with those that gain less than ``least``, the weakest first.

    One of some neighbours goes alone: they may stand for one and the same mode.
    """
    for r in gain.argsort()[: np.sum(gain < least)]:
        gone[r] |= (alike(lam[r], lam[gone]) < ALONE).all()
    return gone


def grow(fit: Fit, count: int | None = None) -> Fit:
    """Return the fit with the modes that stand out of its residuals, until none does.

    A pole that is not needed after all is not tried again. Where the ``count`` of modes is given,
    as many are tried as lack.
    """
    blocked: Complexes = np.zeros(0, complex)
    for _ in range(MOST_ROUNDS):
        task, model, lam, gain = fit.task, fit.model, fit.found.lam, fit.found.gain
        least = needed(task, EVEN) if count is None else 0.0
        most = len(lam) if count is None else count - len(model)
        new: list[int] = []
        for c in gain.argsort()[::-1]:
            if gain[c] < least or len(new) >= most:
                break
            of_others = np.sum(gain[new] * alike(lam[c], lam[new]))
            if gain[c] > TRACES * of_others and (alike(lam[c], blocked) < ALONE).all():
                new.append(int(c))
        if not new:
            break
        L = np.vstack([model.L, fit.found.L[new]])
        trial = backward(refit(fit, np.append(model.lam, lam[new]), L), count)
        gained = 2 * (fit.cost - trial.cost) / np.median(fit.found.noise[new])
        before, after = model.lam, trial.model.lam
        stays = [
            (alike(x, after) > ALONE).sum() > (alike(x, before) > ALONE).sum() for x in lam[new]
        ]
        if len(trial.model) > len(model) or gained > needed(task):
            fit = trial
        blocked = np.append(blocked, lam[new][~np.array(stays)])
    return fit


def paired(fit: Fit, among: Bools) -> Fit:
    """Return the fit in which modes are pairs whose poles the data cannot tell apart.

    The closest are tried first, of which one at least is ``among`` some, (modes,), and which are
    not clearly apart by their deviations. Real parts of the shapes of a pair are orthonormal.
    """
    task, lam, pairs = fit.task, fit.model.lam, fit.model.pairs
    apart = np.abs(lam[:, None] - lam) / np.minimum.outer(-lam.real, -lam.real)
    close = np.argwhere(np.triu(apart < 1, 1)) if len(task.H) > 1 else np.zeros((0, 2), int)
    C, noise = fit.inverted(fit.information) / 2, fit.found.noise_of(lam)
    for r, s in close[apart[tuple(close.T)].argsort()].tolist():
        if {r, s} & {k for pair in pairs for k in pair} or not among[[r, s]].any():
            continue
        difference = np.array([(lam[r] - lam[s]).real, (lam[r] - lam[s]).imag])
        both = np.zeros((2, len(C)))
        both[[0, 1], [2 * r, 2 * r + 1]], both[[0, 1], [2 * s, 2 * s + 1]] = 1.0, -1.0
        if difference @ np.linalg.solve(both @ C @ both.T, difference) > CLEARLY * noise[r]:
            continue
        model = fit.model
        start = model.lam.copy()
        start[[r, s]] = (lam[r] + lam[s]) / 2
        trial = maximise(task, start, model.L, pairs=(*pairs, (r, s)))
        lost = 2 * (trial.cost - fit.cost) / noise[r]
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


def seeded(fit: Fit, omega: Floats) -> tuple[Complexes, Complexes]:
    """Return the poles of a fit and one at each frequency that lies in no bandwidth of theirs.

    Also returns their participation factors; the damping is that which explains most of the
    residuals, as far as it is not that of another pole.
    """
    found = fit.found
    out, L = fit.model.lam, fit.model.L
    for each in omega:
        if (np.abs(np.abs(out) - each) < -out.real).any():
            continue
        within = np.abs(found.lam.imag - each) <= -found.lam.real
        like = np.array([alike(pole, found.lam) for pole in out]).reshape(-1, len(within))
        own = found.gain * found.noise * (like.max(axis=0, initial=0.0) < ALONE)
        near = np.where(within, own, -1.0).argmax()
        out = np.append(out, complex(found.lam[near].real, each))
        L = np.vstack([L, found.L[near]])
    return out, L


def doubles(poles: Complexes, shapes: Complexes, strength: Floats) -> Bools:
    """Return which modes lie within half the bandwidth of a stronger one and have its shape.

    Nonlinearity, leakage and drift make peaks that two poles fit better than one.
    """
    half = CLOSEST * np.maximum.outer(-poles.real, -poles.real)
    near = np.abs(poles[:, None] - poles) < half
    weaker = strength[:, None] < strength
    return np.asarray(np.any(near & (auto_mac(shapes) > SAME) & weaker, axis=1))
