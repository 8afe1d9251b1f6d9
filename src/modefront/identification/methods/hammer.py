r"""Hammer tests: from frequency response functions of one data set to its modes.

The steps are those of docs/methods/identification.md. Modes are chosen from principal responses
with common weights, of which all responses have one set of equations, then tested again in the fit
of all functions, each with its own variance.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modefront._typing import Bools, Floats
from modefront.data.responses import FrequencyResponses
from modefront.identification import selection, stabilisation
from modefront.identification.modal_model import Fit
from modefront.identification.noise import fitted_variance, square, variance_from_differences
from modefront.identification.problem import RESIDUALS, primitives, problem
from modefront.identification.record import Identification, ModeEstimate, Rejected
from modefront.identification.statistics import mode_estimates, residuals
from modefront.linalg.small import mac
from modefront.rounding import TINY

LEAST_LINES = 20  # of a band: two modes with residual terms have twelve numbers a function
PRINCIPAL = 48  # principal responses from which the modes are chosen where there are more responses
FEW = 0.5  # share of the orders below which a mode is flagged, and phase collinearity
VISIBLE = 1 / 3  # share in the sum of all modes at its frequency below which a mode is flagged
NEIGHBOURS = 0.05  # relative distance of frequencies within which modes of one shape may be one


def identify(
    data: FrequencyResponses,
    band: tuple[float, float] | None = None,
    modes: int | None = None,
    seeds: Sequence[float] = (),
) -> Identification:
    """Return the modes of one data set within a band in Hz, by default all of it.

    ``modes`` is their number where it is known; ``seeds`` are frequencies in Hz at which a mode is
    kept whatever its evidence. The band has `LEAST_LINES`, and functions that are not zero.
    """
    data = data.within(*(band or (0.0, np.inf)))
    kind = weighting(data)
    if data.variance is None or kind == "residuals":
        first = variance_from_differences(data.H)
    else:
        first = fitted_variance(np.where(data.measured, data.variance, np.nan), data.H)
    small, shared = _principal(data, first)
    diagram = stabilisation.diagram_of(small, shared)
    if not data.measured[:, data.measured.any(axis=(0, 2))].all():
        small, shared = data, first
    task, omega, _ = problem(small, shared)
    lam, L = diagram.pole[diagram.clusters] / omega, diagram.participation[diagram.clusters]
    fit = selection.refit(Fit(task, lam, L), lam, L)
    fit = selection.refit(_reweighted(fit, kind), fit.lam, fit.L)
    fit = selection.grow(selection.backward(fit, modes)[0], modes)
    task, omega, size = problem(data, first)
    fit = Fit(task, fit.lam, fit.L)
    for _ in range(2):
        fit = selection.refit(_reweighted(fit, kind), fit.lam, fit.L)
    while True:
        last = selection.refit(fit, fit.lam, fit.L, fine=True)
        fit, gain = selection.backward(last, modes)
        if fit is last:
            break
    if len(seeds):
        start = selection.seeded(fit, 2 * np.pi * np.array(seeds) / omega)
        fit = selection.refit(fit, *start, fine=True)
        gain = selection.gains(fit)
    return _result(data, fit, gain, omega, size, diagram)


def weighting(data: FrequencyResponses) -> str:
    """Return the origin of the variance: given, given up to a factor, or residuals alone.

    Where it is unknown for one of the functions that were measured, it is that of the residuals for
    all of them, so that none is left out.
    """
    variance = np.nan if data.variance is None else data.variance
    known: Bools = np.any(data.measured & np.isfinite(variance), axis=2)
    if not known[data.measured.any(axis=2)].all():
        return "residuals"
    return "scaled" if data.scaled else "given"


def _principal(data: FrequencyResponses, variance: Floats) -> tuple[FrequencyResponses, Floats]:
    """Return responses over their noise, principal ones where they are many, and their variance.

    It is that of the mean response, (references, 1, lines).
    """
    n_in, n_out, lines = data.H.shape
    live = data.measured.any(axis=(0, 2))
    level = np.ones(n_out)
    level[live] = np.sqrt(np.nanmedian(variance[:, live], axis=(0, 2)))
    level = np.where(live & (level > 0), level, np.inf)
    H = np.asarray(np.where(data.measured, data.H, 0) / level[:, None], complex)
    relative = np.where(np.isfinite(variance), variance, 0) / level[:, None] ** 2
    known = np.maximum(np.sum(relative > 0, axis=1, keepdims=True), 1)
    shared = np.sum(relative, axis=1, keepdims=True) / known
    shared = np.where(shared > 0, shared, np.inf)
    names = data.responses
    if n_out > PRINCIPAL:
        # real combinations: complex ones would not be conjugate at conjugate poles
        flat = np.ascontiguousarray(H.transpose(1, 0, 2)).reshape(n_out, -1).view(float)
        U = np.linalg.eigh(flat @ flat.T)[1][:, -PRINCIPAL:]
        H = (U.T @ flat).view(complex).reshape(PRINCIPAL, n_in, lines).transpose(1, 0, 2)
        names = tuple(f"principal {i + 1}" for i in range(PRINCIPAL))
    return replace(data, H=H, responses=names, variance=None), shared


def _reweighted(fit: Fit, kind: str) -> Fit:
    """Return a fit whose data are weighted by the smooth variance of its residuals.

    Where the variance is given it stays; where it is known up to a factor it gets that.
    """
    task, H = fit.task, fit.functions
    if kind == "given":
        return fit
    used, raw = task.weight > 0, square(fit.residual)
    raw *= task.count / fit.freedom
    if task.weight.shape != H.shape:
        raw = raw.mean(axis=1, keepdims=True)
        H = np.sqrt(np.mean(square(H), axis=1, keepdims=True))
    raw = np.where(used, raw, np.nan)
    if kind == "scaled":
        lines = np.maximum(used.sum(axis=2, keepdims=True), 1)
        factor = np.where(used, raw * task.weight, 0).sum(axis=2, keepdims=True) / lines
        weight = task.weight / np.where(factor > 0, factor, 1.0)
    else:
        weight = np.where(used, 1 / fitted_variance(raw, np.where(used, H, np.nan)), 0.0)
    return fit.of(replace(task, weight=weight))


def _result(
    data: FrequencyResponses,
    apart: Fit,
    gain: Floats,
    omega: float,
    size: float,
    diagram: stabilisation.StabilisationDiagram,
) -> Identification:
    """Return the modes of the last fit, in which no two have one pole yet, and what each gains.

    Those outside the band stand for residual terms.
    """
    fit = selection.paired(apart)
    task, misfit, f = fit.task, residuals(fit), data.frequency
    estimates = mode_estimates(fit, misfit, omega)
    for pair in map(list, fit.pairs):  # the data do not exclude the poles apart
        of_pair = apart.lam[pair]
        ratios = of_pair.real / np.abs(of_pair)
        splits = np.ptp(np.abs(of_pair)) * omega / (4 * np.pi), np.ptp(ratios) / 2
        for r in pair:
            own = estimates[r].frequency_std, estimates[r].damping_std
            f_std, zeta_std = np.hypot(own, splits).tolist()
            estimates[r] = replace(estimates[r], frequency_std=f_std, damping_std=zeta_std)
    kept, rejected = list[int](), list[Rejected]()
    for k, mode in enumerate(estimates):
        inside = f[0] <= mode.frequency <= f[-1]
        why = "damped too heavily for a mode" if inside else "outside the band"
        if inside and mode.damping <= stabilisation.MOST_DAMPING:
            kept.append(k)
        else:
            rejected.append(Rejected(mode.frequency, mode.damping, why))
    shares = stabilisation.support(diagram, fit.lam * omega, gain)
    judged = _judged(fit, f, gain / selection.needed(task), shares, estimates, kept)
    return Identification(
        data.responses,
        (float(f[0]), float(f[-1])),
        tuple(sorted((judged[k] for k in kept), key=lambda mode: mode.frequency)),
        tuple(sorted(rejected, key=lambda pole: pole.frequency)),
        diagram,
        data,
        fit.functions * size,
        misfit,
        len(RESIDUALS) // 2,
        fit.evaluations,
        fit.converged,
    )


# 6 arguments: what speaks for a mode, and its neighbours.
def _judged(
    fit: Fit,
    frequency: Floats,
    gain: Floats,
    shares: Floats,
    estimates: Sequence[ModeEstimate],
    kept: Sequence[int],
) -> list[ModeEstimate]:
    """Return all modes with what speaks for each; only those that are ``kept`` are neighbours."""
    visible, alike = _visibility(fit), mac(fit.phi.T, fit.phi.T)
    spacing = float(np.median(np.diff(frequency)))
    out = []
    for r, mode in enumerate(estimates):
        flags = []
        if gain[r] < 1:
            flags.append("kept by hand: noise alone may explain as much")
        if shares[r] < FEW:
            flags.append(f"on {shares[r]:.0%} of the orders")
        if visible[r] < VISIBLE:
            flags.append(f"at most {visible[r]:.0%} of any function at its frequency")
        if mode.shape.collinearity < FEW:
            flags.append(f"no common phase: MPC {mode.shape.collinearity:.2f}")
        half = max(mode.damping * mode.frequency, spacing)
        if mode.frequency_std > half or mode.damping_std > mode.damping:
            flags.append("frequency or damping hardly determined")
        for k in kept:
            other = estimates[k]
            apart = abs(other.frequency - mode.frequency)
            if k == r or apart > NEIGHBOURS * mode.frequency:
                continue
            if other.pole == mode.pole:
                flags.append("one of a pair: both shapes are a basis of a plane")
            elif len(fit.phi[r]) > 1 and alike[r, k] > selection.SAME:
                flags.append(
                    f"shape of {other.frequency:.5g} Hz (MAC {alike[r, k]:.2f}): one peak split in "
                    "two, or sensors that cannot tell them apart"
                )
            elif len(fit.task.H) == 1 and apart < max(half, other.damping * other.frequency):
                flags.append(
                    f"within the half bandwidth of {other.frequency:.5g} Hz: one peak split in "
                    "two, or two modes that one reference cannot tell apart"
                )
        g, share, seen = float(gain[r]), float(shares[r]), float(visible[r])
        out.append(replace(mode, gain=g, support=share, visibility=seen, flags=tuple(flags)))
    return out


def _visibility(fit: Fit) -> Floats:
    """Return the greatest share of every mode, over all functions, at its own frequency."""
    task = fit.task
    resonances = replace(task, s=1j * np.abs(fit.lam) + task.s[0].real)
    E = primitives(resonances, fit.lam, squares=False)[: 2 * len(fit.lam)]
    a = (fit.L.T[:, None, :] * fit.phi.T)[task.weight.any(axis=2)]  # (functions, modes)
    parts = np.abs(a.real[..., None] * E[::2] + a.imag[..., None] * E[1::2])
    shares = parts / np.maximum(parts.sum(axis=1, keepdims=True), TINY)
    return np.einsum("irr->ir", shares).max(axis=0, initial=0.0)
