r"""Harmonics of machines in ambient records: sines beside the random part of the likelihood.

Symbols are those of docs/methods/ambient.md. With the amplitudes c integrated out, as in
restricted likelihood, the rest :math:`F_k - c\,d_k` counts as :math:`1 - d_k^2
\operatorname{tr}(A^{-1} E_k^{-1}) / n` lines, :math:`A = \sum_k d_k^2 E_k^{-1}`: one less in all.

The amplitude of a machine that drifts is steadier than a random one. With :math:`a(t)` the modal
response to lines about a mode, :math:`\kappa = \overline{|a|^4} / \overline{|a|^2}^2` is 2 for a
normal response and 1 for a harmonic; over n samples whose response has the correlations
:math:`\rho` at all lags, its variance is :math:`4 \sum |\rho|^4 / n`.
"""

from dataclasses import replace

import numpy as np
from scipy.ndimage import correlate1d
from scipy.optimize import minimize_scalar
from scipy.special import betainccinv, chdtri

from modefront._typing import Bools, Complexes, Floats
from modefront.identification.spectra import Transforms
from modefront.identification.spectral_density import Band, Density

NEAR = 5  # lines on either side of a sine that tell its amplitudes
BLOCK = 128  # lines that tell how much more there is about them than the model has


def without_sine(
    lines: Transforms, band: Band, model: Density, held: Bools, false: float
) -> tuple[Transforms, int | None] | None:
    """Return transforms without one sine, and the mode in whose place it is; None for no sine.

    It gains more than noise makes ``false`` times in all lines, beside all modes or in place of one
    that is not ``held``, and then more than the mode does by as many parameters as it has more.
    Records do not tell modes that are narrower than lines from sines; wide ones are none.
    """
    n, spacing = len(lines.F), lines.omega[1] - lines.omega[0]
    chance = false / len(lines.omega)
    least = chdtri(2 * n + 1, chance)
    wide = replace(model, zeta=np.maximum(model.zeta, spacing / 2 / model.omega))
    like_lines = model.zeta * model.omega < NEAR * spacing
    for r in np.flatnonzero(like_lines[: model.free] & ~held).tolist():
        middle = int(np.searchsorted(lines.omega, model.omega[r]))
        near = slice(max(middle - 2 * NEAR, 0), middle + 2 * NEAR)
        root = model.root * (np.arange(len(model.root)) != r)[:, None]
        cost, white, _ = _likelihood(lines, near, replace(model, root=root))
        taken, gain = _taken(lines, near, white @ white.conj().mT, middle - near.start)
        narrow = wide.zeta[r] > model.zeta[r]
        likely = _likelihood(lines, near, wide)[0] - cost + gain > n - 1
        if 2 * gain > least and (narrow or likely):
            return taken, r
    near = slice(*np.searchsorted(lines.omega, band.omega[[0, -1]]))
    F, root = lines.F[:, near].T, _likelihood(lines, near, model)[1]
    white = np.einsum("kji,kj->ki", root.conj(), F)
    M, blocks = [], max(len(F) // BLOCK, 1)
    for part in np.array_split(white, blocks):  # the model counts as n lines beside each block
        known = (part.T @ part.conj() + n * np.eye(n)) / (len(part) + n)
        M += [np.linalg.inv(known)] * len(part)
    gains = _gains(F, root @ np.array(M) @ root.conj().mT)
    count = len(F) // blocks
    if gains.max() < 2 * (count + n) * betainccinv(n + 0.5, count, chance):
        return None
    return _taken(lines, near, root @ root.conj().mT, int(gains.argmax()) / 2)[0], None


def kurtosis(lines: Transforms, model: Density, mode: int, reach: float) -> tuple[float, float]:
    """Return kappa of a mode within so many half bandwidths, and its deviation for a normal one."""
    omega, spacing = model.omega[mode], lines.omega[1] - lines.omega[0]
    distance = np.abs(lines.omega - omega)
    inside = np.flatnonzero(distance <= max(reach * model.zeta[mode] * omega, 4 * spacing))
    near = slice(inside[0], inside[-1] + 1)
    _, root, half = _likelihood(lines, near, model)
    N = (half @ half[:, mode].conj()[..., None])[..., 0]
    seen = N.conj() @ model.columns.T
    weighted = np.einsum("ki,kij->kj", seen, root @ root.conj().mT)
    size = 4 * len(inside)
    a = np.abs(np.fft.ifft(np.sum(weighted * lines.F[:, near].T, axis=1), size)) ** 2
    rho = np.abs(np.fft.ifft(np.sum(weighted * seen.conj(), axis=1).real, size))
    std = 2 * np.sqrt(np.mean((rho / rho[0]) ** 4))
    return float(np.mean(a**2) / np.mean(a) ** 2), float(std)


def _likelihood(
    lines: Transforms, near: slice, model: Density
) -> tuple[float, Complexes, Complexes]:
    """Return the cost of lines, and R with E^-1 = R R^* and H L at each of them."""
    half, C = model.factors(lines.omega[near], lines.order)
    root = np.asarray(np.linalg.inv(C), complex).conj().mT
    misfit = np.sum(np.abs(np.einsum("kji,kj->ki", root.conj(), lines.F[:, near].T)) ** 2)
    determinant = 2 * np.log(np.einsum("kii->ki", C).real).sum(axis=1)
    return float(lines.share[near] @ determinant + misfit), root, half


def _gains(F: Complexes, inverse: Complexes) -> Floats:
    """Return 2 Delta J of sines half a line apart."""
    weighted = (-1.0) ** np.arange(len(F))[:, None] * np.einsum("kij,kj->ki", inverse, F)
    out = np.zeros((len(F), 2))
    for column, offset in enumerate((0.0, 0.5)):
        d = np.sinc(np.arange(-NEAR, NEAR + 1) - offset)
        A = correlate1d(inverse, d**2, axis=0, mode="constant")
        b = correlate1d(weighted, d, axis=0, mode="constant")[..., None]
        out[:, column] = 2 * np.sum(b.conj() * np.linalg.solve(A, b), axis=(1, 2)).real
    return out.ravel()


def _taken(
    lines: Transforms, near: slice, inverse: Complexes, place: float
) -> tuple[Transforms, float]:
    """Return transforms without the most likely sine about a place in ``near``, and its gain."""
    F, k = lines.F[:, near], np.arange(len(inverse))

    def fitted(p: float) -> tuple[float, Floats, Complexes]:
        some = slice(max(int(p) - NEAR, 0), int(p) + NEAR + 2)
        d, weight = np.sinc(k[some] - p) * (-1.0) ** k[some], inverse[some]
        A = np.tensordot(d**2, weight, 1)
        b = np.einsum("k,kij,jk->i", d, weight, F[:, some])
        c, lost = np.linalg.solve(A, b), np.zeros(len(k))
        lost[some] = d**2 * np.einsum("ij,kji->k", np.linalg.inv(A), weight).real / len(c)
        return float((b.conj() @ c).real), lost, c

    first = min(np.arange(place - 1.5, place + 1.5, 0.1), key=lambda p: -fitted(p)[0])
    bounds = first - 0.1, first + 0.1
    best = minimize_scalar(lambda p: -fitted(p)[0], bounds=bounds, method="bounded").x
    gain, lost, c = fitted(best)
    share, at = lines.share.copy(), np.arange(len(lines.omega)) - near.start
    share[near] *= 1 - lost
    left = lines.F - np.outer(c, np.sinc(at - best) * (-1.0) ** at)
    omega = lines.omega[near.start] + best * (lines.omega[1] - lines.omega[0])
    return replace(lines, F=left, share=share, sines=(*lines.sines, float(omega))), gain
