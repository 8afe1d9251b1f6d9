r"""Which modes are in the data: a pole is one where noise alone would hardly make it.

Evidence, noise and pairs are those of docs/methods/identification.md. Poles come from the
stabilisation diagram, and then from the residuals: wherever a pole would explain more of them than
noise does in every other test, one is added, until nothing stands out. Backwards,
:math:`\Delta J` of a mode is the Wald statistic of its shape.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import scipy.fft
import scipy.linalg as la
from scipy.ndimage import percentile_filter
from scipy.special import gammaln
from scipy.stats import chi2

from modefront._typing import Bools, Complexes, Floats
from modefront.identification.modal_model import (
    COARSE,
    RESIDUALS,
    TINY,
    Fit,
    Problem,
    evaluate,
    free_factors,
    maximise,
    synthesise,
)
from modefront.identification.noise import square
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

NEIGHBOURHOOD = 32
"""Half bandwidths on either side of a pole in which poles of the same damping tell the noise."""

UPPER = 0.8
"""Share of these poles that explain less than the level that tells the noise."""

DRAWS, SEED = 1000, 1
"""Matrices of noise that tell what poles explain of it, and the seed of their random numbers."""

MOST_PLACES = 1 << 18
"""Places of the grid of lines, at most."""

PORTION = 32
"""Responses whose products with poles are computed at once."""

ROUNDING = 1e-12
"""Share of the greatest energy of a pole's function in the lines below which there is none."""

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


def needed(task: Problem, expected: float = FALSE) -> float:
    """Return 2 Delta J of which noise of unit variance makes so many poles in the band."""
    n_in, n_out = _live(task)
    k = n_in + n_out
    ways = gammaln(k - 1) - gammaln(n_in) - gammaln(n_out)
    poles = np.log(len(task.s) * (k - 1) / (2 * np.pi)) + ways
    return float(chi2.isf(min(expected * np.exp(-poles), 0.5), 2 * k))


def _live(task: Problem) -> tuple[int, int]:
    """Return how many references and responses were measured."""
    measured: Bools = np.any(task.weights, axis=2)
    return int(measured.any(axis=1).sum()), int(measured.any(axis=0).sum())


def choose_level(task: Problem, fit: Fit) -> Problem:
    """Return the problem with the number of residual terms of the least BIC, poles held.

    Source: Schwarz, Ann. Stat. 6 (1978) 461-464, doi:10.1214/aos/1176344136.
    """
    best, least = task, np.inf
    measured = int(np.count_nonzero(task.weights.any(axis=2)))
    model, found = fit.model, scan(task, fit)
    noise = float(np.median(found.noise[found.lam.real == found.lam.real.min()]))
    for powers in RESIDUALS:
        trial = replace(task, powers=powers)
        cost = evaluate(trial, model.lam, model.L, model.held).cost
        value = 2 * cost / noise + measured * len(powers) * np.log(task.count)
        if value < least:
            best, least = trial, value
    return best


def gains(task: Problem, fit: Fit, found: Scan) -> Floats:
    """Return 2 Delta J of every mode in units of the noise that a scan found, (modes,).

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
    return 2 * out / found.noise_of(fit.model.lam)


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
        found, lam = scan(task, fit), fit.model.lam
        gain = gains(task, fit, found)
        gone = doubles(lam, fit.model.phi, gain)
        if gone.any():  # shapes of a pair may be alike by chance
            both = paired(task, fit, gone, found).model.pairs
            gone[[k for pair in both for k in pair]] = False
        if count is not None:
            least = np.sort(gain)[::-1][count - 1] if count < len(gain) else -np.inf
        gone = with_weak(gone, gain, least, lam)
        if not gone.any():
            return fit
        fit = refit(task, fit.model.lam[~gone], fit.model.L[~gone])
    return fit


def with_weak(gone: Bools, gain: Floats, least: float, lam: Complexes) -> Bools:
    """Return which modes go, with those that gain less than ``least``, the weakest first.

    One of some neighbours goes alone: they may stand for one and the same mode.
    """
    for r in gain.argsort()[: np.sum(gain < least)]:
        gone[r] |= (alike(lam[r], lam[gone]) < ALONE).all()
    return gone


def grow(task: Problem, fit: Fit, count: int | None = None) -> Fit:
    """Return the fit with the modes that stand out of its residuals, until none does.

    A pole that is not needed after all is not tried again.
    """
    blocked: Complexes = np.zeros(0, complex)
    for _ in range(MOST_ROUNDS):
        found = scan(task, fit)
        lam, L = standing_out(task, fit, found, blocked, count)
        if not len(lam):
            break
        model = fit.model
        trial = refit(task, np.append(model.lam, lam), np.vstack([model.L, L]))
        trial = backward(task, trial, needed(task), count)
        gained = 2 * (fit.cost - trial.cost) / np.median(found.noise_of(lam))
        stays = [_near(pole, trial.model.lam) > _near(pole, model.lam) for pole in lam]
        if len(trial.model) > len(model) or gained > needed(task):
            fit = trial
        blocked = np.append(blocked, lam[~np.array(stays)])
    return fit


def _near(pole: complex, others: Complexes) -> int:
    """Return how many poles are hardly told apart from one."""
    return int(np.count_nonzero(alike(pole, others) > ALONE))


def standing_out(
    task: Problem, fit: Fit, found: Scan, blocked: Complexes, count: int | None = None
) -> tuple[Complexes, Complexes]:
    """Return poles that explain more of the residuals than noise would, and their factors.

    Where the ``count`` of modes is given, they are as many as lack.
    """
    lam, gain, L = found.lam, found.gain, found.L
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


def paired(task: Problem, fit: Fit, among: Bools, found: Scan) -> Fit:
    """Return the fit in which modes are pairs whose poles the data cannot tell apart.

    The closest are tried first, of which one at least is ``among`` some, (modes,), and which are
    not clearly apart by their deviations. Real parts of the shapes of a pair are orthonormal.
    """
    lam, pairs = fit.model.lam, fit.model.pairs
    apart = np.abs(lam[:, None] - lam) / np.maximum.outer(-lam.real, -lam.real)
    close = np.argwhere(np.triu(apart < 1, 1)) if len(task.H) > 1 else np.zeros((0, 2), int)
    C, noise = np.linalg.pinv(fit.information, hermitian=True) / 2, found.noise_of(lam)
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


def seeded(task: Problem, fit: Fit, omega: Floats) -> tuple[Complexes, Complexes]:
    """Return the poles of a fit and one at each frequency that lies in no bandwidth of theirs.

    Also returns their participation factors; the damping is that which explains most of the
    residuals.
    """
    found = scan(task, fit)
    out, L = fit.model.lam, fit.model.L
    for each in omega:
        if (np.abs(np.abs(out) - each) < -out.real).any():
            continue
        within = np.abs(found.lam.imag - each) <= -found.lam.real
        near = np.where(within, found.gain * found.noise, -1.0).argmax()
        out = np.append(out, complex(found.lam[near].real, each))
        L = np.vstack([L, found.L[near]])
    return out, L


def alike(pole: complex, others: Complexes) -> Floats:
    """Return the squared correlation of a pole's function with those of others."""
    out: Floats = 4 * pole.real * others.real / np.abs(pole + others.conj()) ** 2
    return out


@dataclass(frozen=True)
class Scan:
    """Poles all over the band, and what each explains of the residuals of a fit.

    Attributes
    ----------
    lam : (poles,) half bandwidths go up by factors of two from the distance of lines, as do steps
    gain : (poles,) 2 Delta J of each in units of its noise
    L : (poles, references) its participation factors
    noise : (poles,) variance of the noise, as poles of the same damping find it in the
        neighbourhood; at least that of the residuals, and 1, the variance of the data
    """

    lam: Complexes
    gain: Floats
    L: Complexes
    noise: Floats

    def noise_of(self, lam: Complexes) -> Floats:
        """Return the variance of the noise at other poles, (others,)."""
        return np.array([self.noise[alike(pole, self.lam).argmax()] for pole in lam])


@cache
def _expected(rows: int, columns: int) -> float:
    """Return the quantile of the greatest squared singular value of noise of unit variance."""
    rng = np.random.default_rng(SEED)
    z = (rng.standard_normal((2, DRAWS, rows, columns)) * [[[[1]]], [[[1j]]]]).sum(axis=0)
    greatest = np.linalg.eigvalsh(z @ z.conj().swapaxes(1, 2))[:, -1] / 2
    return float(np.quantile(greatest, UPPER))


def scan(task: Problem, fit: Fit) -> Scan:
    """Return what poles all over the band explain of the residuals of a fit.

    On an even grid of lines, the products of the residuals with a pole are a convolution.
    """
    r, front, f = task.H - synthesise(task, fit.model), task.s**task.order, task.s.imag
    step = max(float(np.diff(f).min()), float(np.ptp(f)) / MOST_PLACES)
    place = np.rint((f - f[0]) / step).astype(int)
    count = int(place[-1]) + 1
    size = scipy.fft.next_fast_len(2 * count)
    offset = step * scipy.fft.fftfreq(size, 1 / size)

    def on_grid(values: Any) -> Any:
        out = np.zeros((*values.shape[:-1], size), values.dtype)
        np.add.at(out.T, place, values.T)
        return scipy.fft.fft(out)

    weight, n_in = task.weights, len(r)
    parts = [slice(first, first + PORTION) for first in range(0, r.shape[1], PORTION)]
    products = [on_grid(weight[:, part] * r[:, part] * front.conj()) for part in parts]
    own = parts if task.weight.shape == r.shape else [slice(None)] * len(parts)
    energies = [on_grid(task.weight[:, part] * square(front)) for part in own]
    out: list[list[Any]] = []
    for m in range(max(int(np.log2(max(HEAVIEST * f[-1] / step, 1))), 0) + 1):
        half, grid = step * 2**m, slice(0, count, 2**m)
        kernel = 1 / (half + task.s[0].real + 1j * offset)
        of_pole, of_energy = scipy.fft.fft(kernel), scipy.fft.fft(square(kernel))
        lam = -half + 1j * (f[0] + step * np.arange(count)[grid])
        S, total = np.zeros((len(lam), n_in, n_in), complex), np.zeros((n_in, len(lam)))
        for product, energy in zip(products, energies, strict=True):
            G = np.maximum(scipy.fft.ifft(energy * of_energy).real[..., grid], 0.0)
            root = np.sqrt(np.where(ROUNDING * G.max(initial=0.0) < G, G, np.inf))
            z = (scipy.fft.ifft(product * of_pole)[..., grid] / root).transpose(2, 0, 1)
            S += z @ z.conj().swapaxes(1, 2)
            total += G.mean(axis=1)
        value, vector = np.linalg.eigh(S)
        factors = vector[:, :, -1] / np.sqrt(np.maximum(total.T, TINY))
        noise = percentile_filter(value[:, -1], 100 * UPPER, 2 * NEIGHBOURHOOD + 1, mode="nearest")
        kept = half < HEAVIEST * lam.imag
        out.append([x[kept] for x in (lam, 2 * value[:, -1], factors, noise)])
    lam, gain, L, noise = (np.concatenate(each) for each in zip(*out, strict=True))
    least = max(2 * fit.cost / freedom(task, fit), 1.0) * task.correlation
    noise = np.maximum(noise / _expected(*_live(task)), least)
    return Scan(lam, gain / noise, L, noise)


def doubles(poles: Complexes, shapes: Complexes, strength: Floats) -> Bools:
    """Return which modes lie within half the bandwidth of a stronger one and have its shape.

    Nonlinearity, leakage and drift make peaks that two poles fit better than one.
    """
    half = CLOSEST * np.maximum.outer(-poles.real, -poles.real)
    near = np.abs(poles[:, None] - poles) < half
    weaker = strength[:, None] < strength
    return np.asarray(np.any(near & (auto_mac(shapes) > SAME) & weaker, axis=1))
