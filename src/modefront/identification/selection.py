r"""Which modes are in the data: a pole is one where noise alone would hardly make it.

Evidence, noise and pairs are those of docs/methods/identification.md. Poles come from the
stabilisation diagram, and then from the residuals: wherever a pole would explain more of them than
noise does, one is added, until nothing stands out. Backwards, :math:`\Delta J` of a mode is the
Wald statistic of its shape, or what the fit without it loses.
"""

import numpy as np
import scipy.linalg as la
from scipy.special import chdtri, gammaln

from modefront._typing import Bools, Complexes, Floats
from modefront.identification.modal_model import COARSE, Fit, maximise, thinned
from modefront.identification.problem import Problem
from modefront.identification.scan import alike
from modefront.identification.shapes import plane_basis
from modefront.linalg.small import mac
from modefront.rounding import TINY

FALSE = 1e-3  # expected number of modes in a band that noise alone makes
MOST_ROUNDS = 20  # rounds in which poles are added, at most
OVERDAMPED = 0.9  # damping ratio from which on a pole and its conjugate are nearly one real pole

LEAST_UNLIKE = 1e-6
"""Least squared share of the derivative by a pole that no residual term can make up. In the normal
equations rounding takes some 1e-8; poles within the band have 0.1 and more."""
MOST_EVALUATIONS = 20  # of the model for a choice, which need not be at the very maximum
CLOSEST = 0.5  # distance of poles, in half bandwidths, below which only shapes tell them apart

TRACES = 10.0
"""Gain of a pole over what the ones that are added already explain of it: a missing mode bends the
fit of its neighbours, too."""

ALONE = 0.25  # squared correlation with another pole below which a pole is judged for itself
SAME = 0.95  # MAC of shapes that are the same
APART = 0.01  # probability that two modes of one pole are taken for modes of two

CLEARLY = 100.0
"""Squared difference of two poles in its deviations from which on they are no pair: close poles
are not normally distributed, and are told apart by the likelihood below."""

PAIR_FREEDOM = 6  # real numbers of a matrix, 2 by 2, beyond those of one pole


def needed(task: Problem) -> float:
    """Return 2 Delta J of which noise of unit variance makes `FALSE` poles in the band."""
    n_in, n_out = task.live
    k = n_in + n_out
    ways = gammaln(k - 1) - gammaln(n_in) - gammaln(n_out)
    poles = np.log(len(task.s) * (k - 1) / (2 * np.pi)) + ways
    return float(chdtri(2 * k, min(FALSE * np.exp(-poles), 0.5)))


def gains(fit: Fit) -> Floats:
    """Return 2 Delta J of every mode in units of the noise beside it, (modes,).

    It is the Wald statistic of a shape whose poles are held, while all else may follow: with the
    covariance B + Z A^-1 Z^T, B of the shape's own equations, A of all other alphas.
    """
    owner, unit = np.repeat([r for _, r, _ in fit.alphas], 2), np.eye(2 * len(fit.lam))
    out = [_wald(fit, unit[2 * r : 2 * r + 2], owner != r) for r in range(len(fit.lam))]
    return np.array(out) / fit.found.noise_of(fit.lam)


def _wald(fit: Fit, of: Floats, free: Bools) -> float:
    """Return 2 Delta J of a fit in which combinations of the shapes of every response vanish.

    They are real, (combinations, 2 modes); some alphas are ``free``. With the covariance of the
    combinations B + Z A^-1 Z^T, B of the responses' own equations, A of the alphas.
    """
    seen: Bools = np.any(fit.task.weights, axis=(0, 2))
    block = of @ fit.inverse[:, : of.shape[1], : of.shape[1]] @ of.T
    block = np.broadcast_to(block, (len(seen), *block.shape[1:]))[seen]
    Z = of @ fit.Z[seen][:, : of.shape[1], free]
    parts = np.concatenate([(fit.c[seen] @ of.T)[:, :, None], Z], axis=2)
    S = np.tensordot(parts, np.linalg.solve(block, parts), ((0, 1), (0, 1)))
    A = S[1:, 1:] + fit.information[np.ix_(free, free)]
    follows = S[0, 1:] @ la.lstsq(A, S[1:, 0])[0] if len(A) else 0.0
    return 2 * float(S[0, 0] - follows)


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
            fit = maximise(task, fit.lam, fit.L)
        lam, L = fit.lam, fit.L
        over = -lam.real > OVERDAMPED * np.abs(lam)
        unlike = fit.information.diagonal() / np.maximum(fit.size, TINY)
        over |= unlike[: 2 * len(lam)].reshape(-1, 2).min(axis=1, initial=1.0) < LEAST_UNLIKE
        if not over.any():
            break
        lam, L = lam[~over], L[~over]
    return fit if fit.task is task else fit.of(task)


def backward(fit: Fit, count: int | None = None) -> tuple[Fit, Floats]:
    """Return the fit without modes that gain less than needed and doubles, and what modes gain.

    The weakest go first, where a fit without them is no worse. The Wald statistic says too little
    of close modes, whose shapes are large and cancel: what they gain is what that fit loses. Where
    the ``count`` of modes is given, the strongest are kept instead. Only among modes that are
    needed are shapes known well enough to tell a split peak, which one pole for both does not
    explain as it does a pair. Of doubles, the weakest goes first.
    """
    gain, together = gains(fit), True
    while len(fit.lam):
        lam, least = fit.lam, needed(fit.task)
        if count is not None:
            least = np.sort(gain)[::-1][count - 1] if count < len(gain) else -np.inf
        gone = np.zeros(len(lam), bool)
        for r in gain.argsort()[: np.sum(gain < least)]:  # neighbours may stand for the same mode
            gone[r] = (alike(lam[r], lam[gone]) < ALONE).all()
        needless = gone.any()
        if not needless:
            double = doubles(lam, fit.phi, gain, fit)
            for pair in paired(fit).pairs if double.any() else ():
                double[list(pair)] = False
            if not double.any():
                break
            gone = double & (gain == gain[double].min())
        elif not together:
            gone = gain == gain.min()
        trial = refit(fit, lam[~gone], fit.L[~gone])
        lost = 2 * (trial.cost - fit.cost) / fit.found.noise_of(lam[gone]).min()
        together = lost - np.sort(gain[gone])[:-1].sum() < least
        if together or not needless or count is not None:
            fit, together = trial, True
            gain = gains(fit)
        elif gone.sum() == 1:
            gain[gone], together = lost, True
    return fit, gain


def grow(fit: Fit, count: int | None = None) -> Fit:
    """Return the fit with the modes that stand out of its residuals, until none does.

    A pole that is not needed after all is tried again only in another fit. Where the ``count`` of
    modes is given, as many are tried as lack.
    """
    blocked: Complexes = np.zeros(0, complex)
    for _ in range(MOST_ROUNDS):
        task, lam, gain = fit.task, fit.found.lam, fit.found.gain
        least = needed(task) if count is None else 0.0
        most = len(lam) if count is None else count - len(fit.lam)
        new: list[int] = []
        for c in gain.argsort()[::-1]:
            if gain[c] < least or len(new) >= most:
                break
            of_others = np.sum(gain[new] * alike(lam[c], lam[new]))
            if gain[c] > TRACES * of_others and (alike(lam[c], blocked) < ALONE).all():
                new.append(int(c))
        if not new:
            break
        L = np.vstack([fit.L, fit.found.L[new]])
        trial, _ = backward(refit(fit, np.append(fit.lam, lam[new]), L), count)
        gained = 2 * (fit.cost - trial.cost) / np.median(fit.found.noise[new])
        if len(trial.lam) > len(fit.lam) or gained > needed(task):
            fit, blocked = trial, blocked[:0]
        else:
            blocked = np.append(blocked, lam[new])
    return fit


def paired(fit: Fit) -> Fit:
    """Return the fit in which modes are pairs whose poles the data cannot tell apart.

    The closest are tried first that are not clearly apart by their deviations. Real parts of the
    shapes of a pair are orthonormal.
    """
    task, lam, pairs = fit.task, fit.lam, fit.pairs
    apart = np.abs(lam[:, None] - lam) / np.minimum.outer(-lam.real, -lam.real)
    close = np.argwhere(np.triu(apart < 1, 1)) if len(task.H) > 1 else np.zeros((0, 2), int)
    C, noise = fit.inverted(fit.information) / 2, fit.found.noise_of(lam)
    for r, s in close[apart[tuple(close.T)].argsort()].tolist():
        if {r, s} & {k for pair in pairs for k in pair}:
            continue
        difference = np.array([(lam[r] - lam[s]).real, (lam[r] - lam[s]).imag])
        both = np.zeros((2, len(C)))
        both[[0, 1], [2 * r, 2 * r + 1]], both[[0, 1], [2 * s, 2 * s + 1]] = 1.0, -1.0
        if difference @ np.linalg.solve(both @ C @ both.T, difference) > CLEARLY * noise[r]:
            continue
        start = fit.lam.copy()
        start[[r, s]] = (lam[r] + lam[s]) / 2
        trial = maximise(task, start, fit.L, pairs=(*pairs, (r, s)))
        if 2 * (trial.cost - fit.cost) / noise[r] < chdtri(PAIR_FREEDOM, APART):
            L = trial.L.copy()
            for pair in map(list, trial.pairs):
                L[pair] = np.linalg.solve(plane_basis(trial.phi[pair]).T, L[pair])
            pairs = trial.pairs
            fit = Fit(task, trial.lam, L, pairs)
            fit.evaluations, fit.converged = trial.evaluations, trial.converged
    return fit


def seeded(fit: Fit, omega: Floats) -> tuple[Complexes, Complexes]:
    """Return the poles of a fit and one at each frequency that lies in no bandwidth of theirs.

    Also returns their participation factors; the damping is that which explains most of the
    residuals, as far as it is not that of another pole.
    """
    found = fit.found
    out, L = fit.lam, fit.L
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


def doubles(poles: Complexes, shapes: Complexes, strength: Floats, fit: Fit | None = None) -> Bools:
    """Return which modes lie within half the bandwidth of a stronger one and have its shape.

    Nonlinearity, leakage and drift make peaks that two poles fit better than one. Of close modes,
    shapes may be alike as well: those of a ``fit`` are the same where it cannot tell them apart.
    """
    half = CLOSEST * np.maximum.outer(-poles.real, -poles.real)
    near = np.abs(poles[:, None] - poles) < half
    double: Bools = near & (mac(shapes.T, shapes.T) > SAME) & (strength[:, None] < strength)
    if fit is not None:
        for r, s in np.argwhere(double):
            double[r, s] = not _differ(fit, r, s)
    return np.asarray(double.any(axis=1))


def _differ(fit: Fit, r: int, s: int) -> bool:
    """Return whether the shape of a mode is more than a multiple of that of another one."""
    phi = fit.phi[:, np.any(fit.task.weights, axis=(0, 2))]
    factor = np.vdot(phi[s], phi[r]) / np.vdot(phi[s], phi[s])
    of = np.zeros((2, 2 * len(phi)))
    of[:, 2 * r : 2 * r + 2] = np.eye(2)
    of[:, 2 * s : 2 * s + 2] = [[-factor.real, factor.imag], [-factor.imag, -factor.real]]
    freedom, noise = 2 * phi.shape[1] - 2, fit.found.noise_of(fit.lam[[r]])[0]
    statistic = _wald(fit, of, np.ones(len(fit.gradient), bool)) / noise
    return bool(freedom and statistic > chdtri(freedom, APART))
