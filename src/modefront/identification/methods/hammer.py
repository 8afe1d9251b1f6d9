r"""Hammer tests: from frequency response functions of one data set to its modes.

The steps are those of docs/methods/identification.md. Modes are chosen from principal responses
with common weights, of which all responses have one set of equations, then tested again in the fit
of all functions, each with its own variance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from modefront._typing import Bools, Floats
from modefront.data.responses import FrequencyResponses
from modefront.identification import modal_model, selection
from modefront.identification.modal_model import Fit, Problem
from modefront.identification.noise import fitted_variance, variance_from_differences
from modefront.identification.record import (
    Evidence,
    FittedFunctions,
    Identification,
    ModeEstimate,
    Rejected,
)
from modefront.identification.shapes import auto_mac
from modefront.identification.stabilisation import (
    MOST_DAMPING,
    StabilisationDiagram,
    diagram_of,
    support,
)
from modefront.identification.statistics import mode_estimates, residuals

Weighting = Literal["given", "scaled", "residuals"]

LEAST_LINES = 20
"""Lines of a band, at least: a mode with its residual terms has twelve numbers a function."""

CHOICE_LINES = 4096
"""Lines from which the modes are chosen where there are more lines, those of sharp peaks apart."""

PEAK_WIDTH = 20.0
"""Half bandwidths on either side of a sharp peak within which all lines are kept."""

PRINCIPAL = 48
"""Principal responses from which the modes are chosen where there are more responses."""

LEAST_LEFT = 0.1
"""Least share of the noise of a line that its residual is taken to hold."""

FEW = 0.5
"""Share of the orders below which a mode is flagged, and phase collinearity."""

VISIBLE = 1 / 3
"""Share in the sum of all modes at its frequency below which a mode is flagged."""

NEIGHBOURS = 0.05
"""Relative distance of frequencies within which modes of the same shape may be one."""

SEED = 20080410
"""Of the random combinations of the singular value decomposition."""


def identify(
    data: FrequencyResponses,
    band: tuple[float, float] | None = None,
    modes: int | None = None,
    seeds: Sequence[float] = (),
) -> Identification:
    """Return the modes of one data set within a band in Hz, by default all of it.

    ``modes`` is their number where it is known; ``seeds`` are frequencies in Hz at which a mode is
    kept whatever its evidence. Raises ValueError where the band has too few lines or nothing was
    measured in it.
    """
    data = data.within(*(band or (0.0, np.inf)))
    if len(data.frequency) < LEAST_LINES:
        raise ValueError(f"expected {LEAST_LINES} lines in the band, found {len(data.frequency)}")
    if not np.any(np.abs(np.nan_to_num(data.H)) > 0):
        raise ValueError("expected functions that are not zero, found only zeros")
    kind = weighting(data)
    if data.variance is None or kind == "residuals":
        first = variance_from_differences(data)
    else:
        first = fitted_variance(np.where(data.measured, data.variance, np.nan), data.H)
    small, shared = _principal(data, first)
    diagram, clusters = diagram_of(small, shared)
    if not data.measured[:, data.measured.any(axis=(0, 2))].all():
        small, shared = data, first
    kept = _lines_of_choice(small.frequency, diagram)
    task, omega, _ = modal_model.problem(small.lines(kept), shared[..., kept], 1)
    task, fit = _choice(task, selection.start(task, clusters, omega), kind, modes)
    level = modal_model.RESIDUALS.index(task.powers)
    task, omega, size = modal_model.problem(data, first, level)
    model = fit.model
    task = _reweighted(task, modal_model.evaluate(task, model.lam, model.L, model.held), kind)
    fit = selection.refit(task, model.lam, model.L)
    task = _reweighted(task, fit, kind)
    fit = selection.grow(task, selection.backward(task, fit, selection.needed(task), modes), modes)
    fine = modal_model.FINE, modal_model.MOST_EVALUATIONS
    while True:
        last = selection.refit(task, fit.model.lam, fit.model.L, *fine)
        fit = selection.backward(task, last, selection.needed(task), modes)
        if fit is last:
            break
    if len(seeds):
        start = selection.seeded(task, fit, 2 * np.pi * np.array(seeds) / omega)
        fit = selection.refit(task, *start, *fine)
    return _result(_Solution(data, task, fit, omega, size, diagram))


def weighting(data: FrequencyResponses) -> Weighting:
    """Return the origin of the variance: given, given up to a factor, or residuals alone.

    Where it is unknown for one of the functions that were measured, it is that of the residuals for
    all of them, so that none is left out.
    """
    if data.variance is None:
        return "residuals"
    known: Bools = np.any(data.measured & np.isfinite(data.variance), axis=2)
    if not known[data.measured.any(axis=2)].all():
        return "residuals"
    return "scaled" if data.scaled else "given"


def _principal(data: FrequencyResponses, variance: Floats) -> tuple[FrequencyResponses, Floats]:
    """Return responses over their noise, principal ones where they are many, and their variance.

    It is that of the mean response, (references, 1, lines). The singular value decomposition is
    randomised: Halko, Martinsson & Tropp, SIAM Rev. 53 (2011) 217-288, doi:10.1137/090771806.
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
        draws = np.random.default_rng(SEED).standard_normal((flat.shape[1], PRINCIPAL + 10))
        basis = np.linalg.qr(flat @ draws)[0]
        U = basis @ np.linalg.svd(basis.T @ flat, full_matrices=False)[0][:, :PRINCIPAL]
        H = (U.T @ flat).view(complex).reshape(PRINCIPAL, n_in, lines).transpose(1, 0, 2)
        names = tuple(f"principal {i + 1}" for i in range(PRINCIPAL))
    return replace(data, H=H, responses=names, variance=None), shared


def _lines_of_choice(frequency: Floats, diagram: StabilisationDiagram) -> Bools:
    """Return the lines from which modes are chosen: every n-th one, and all of sharp peaks.

    Leaving lines out biases nothing, and those between peaks are many that say the same.
    """
    stride = -(-len(frequency) // CHOICE_LINES)
    kept: Bools = np.arange(len(frequency)) % stride == 0
    if stride == 1:
        return kept
    spacing = float(np.median(np.diff(frequency)))
    for pole in diagram.pole[diagram.stable]:
        half = max(-pole.real / (2 * np.pi), spacing)
        if half < PEAK_WIDTH * stride * spacing / 2:
            kept |= np.abs(frequency - abs(pole) / (2 * np.pi)) < PEAK_WIDTH * half
    return kept


def _choice(task: Problem, fit: Fit, kind: Weighting, modes: int | None) -> tuple[Problem, Fit]:
    """Return the problem, with its residual terms and variance, and the modes that data need."""
    for _ in range(2):
        task = selection.choose_level(task, fit)
        fit = selection.refit(task, fit.model.lam, fit.model.L)
        task = _reweighted(task, fit, kind)
        fit = selection.backward(task, fit, selection.needed(task), modes)
        fit = selection.grow(task, fit, modes)
    return task, fit


def _reweighted(task: Problem, fit: Fit, kind: Weighting) -> Problem:
    """Return the problem weighted by the smooth variance of the residuals of a fit.

    Where the variance is given it stays; where it is known up to a factor it gets that.
    """
    if kind == "given":
        return task
    H = modal_model.synthesise(task, fit.model)
    used, raw = task.weight > 0, np.abs(task.H - H) ** 2
    if task.weight.shape == task.H.shape:
        raw /= np.maximum(1 - modal_model.leverage(task, fit), LEAST_LEFT)
    else:
        raw = raw.mean(axis=1, keepdims=True) * task.count / selection.freedom(task, fit)
        H = np.sqrt(np.mean(np.abs(H) ** 2, axis=1, keepdims=True))
    raw = np.where(used, raw, np.nan)
    if kind == "scaled":
        lines = np.maximum(used.sum(axis=2, keepdims=True), 1)
        factor = np.where(used, raw * task.weight, 0).sum(axis=2, keepdims=True) / lines
        return replace(task, weight=task.weight / np.where(factor > 0, factor, 1.0))
    variance = fitted_variance(raw, np.where(used, H, np.nan))
    return replace(task, weight=np.where(used, 1 / variance, 0.0))


@dataclass(frozen=True)
class _Solution:
    """The last fit to the data, with its units of frequency and of functions.

    ``apart`` is the fit in which no two modes have one pole.
    """

    data: FrequencyResponses
    task: Problem
    apart: Fit
    omega: float
    size: float
    diagram: StabilisationDiagram

    @cached_property
    def found(self) -> selection.Scan:
        """What poles explain of the residuals."""
        return selection.scan(self.task, self.apart)

    @cached_property
    def fit(self) -> Fit:
        """The fit with pairs."""
        every = np.ones(len(self.apart.model), bool)
        return selection.paired(self.task, self.apart, every, self.found)


def _result(solution: _Solution) -> Identification:
    """Return the modes of the last fit; those outside the band stand for residual terms."""
    task, fit, omega = solution.task, solution.fit, solution.omega
    misfit = residuals(task, fit)
    estimates = _with_split(mode_estimates(task, fit, misfit, omega), solution)
    f = solution.data.frequency
    reasons = [_reason(mode, f) for mode in estimates]
    kept = [k for k, why in enumerate(reasons) if not why]
    rejected = [
        Rejected(float(mode.frequency), float(mode.damping), why)
        for mode, why in zip(estimates, reasons, strict=True)
        if why
    ]
    evidence = _evidence(solution, estimates, kept)
    modes = [replace(estimates[k], evidence=evidence[k]) for k in kept]
    weight = np.where(task.weight > 0, task.weight, np.nan)
    functions = FittedFunctions(
        solution.data,
        modal_model.synthesise(task, fit.model) * solution.size,
        solution.size**2 / weight,
        misfit,
        modal_model.RESIDUALS.index(task.powers),
    )
    return Identification(
        solution.data.responses,
        (float(f[0]), float(f[-1])),
        tuple(sorted(modes, key=lambda mode: mode.frequency)),
        tuple(sorted(rejected, key=lambda pole: pole.frequency)),
        solution.diagram,
        functions,
        fit.evaluations,
        fit.converged,
    )


def _with_split(estimates: Sequence[ModeEstimate], solution: _Solution) -> list[ModeEstimate]:
    """Return estimates of which those of pairs deviate by half the difference of their poles, too.

    It is that of the fit in which they are apart: the data do not exclude it.
    """
    out, lam = list(estimates), solution.apart.model.lam
    for pair in solution.fit.model.pairs:
        size = np.abs(lam[list(pair)])
        split = float(np.ptp(size)) * solution.omega / (4 * np.pi)
        of_damping = float(np.ptp(lam[list(pair)].real / size)) / 2
        for r in pair:
            out[r] = replace(
                out[r],
                frequency_std=float(np.hypot(out[r].frequency_std, split)),
                damping_std=float(np.hypot(out[r].damping_std, of_damping)),
            )
    return out


def _reason(mode: ModeEstimate, frequency: Floats) -> str:
    """Return why a pole that data need stands for residual terms; empty where it is a mode."""
    if not frequency[0] <= mode.frequency <= frequency[-1]:
        return "outside the band"
    return "damped too heavily for a mode" if mode.damping > MOST_DAMPING else ""


def _evidence(
    solution: _Solution, estimates: Sequence[ModeEstimate], kept: Sequence[int]
) -> list[Evidence]:
    """Return what speaks for every mode; only those that are ``kept`` are neighbours."""
    task, fit = solution.task, solution.fit
    gain, least = selection.gains(task, solution.apart, solution.found), selection.needed(task)
    shares = support(solution.diagram, fit.model.lam * solution.omega, gain)
    visible, mac = _visibility(task, fit), auto_mac(fit.model.phi)
    spacing = float(np.median(np.diff(solution.data.frequency)))
    out = []
    for r, mode in enumerate(estimates):
        flags = []
        if gain[r] < least:
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
            elif len(fit.model.phi[r]) > 1 and mac[r, k] > selection.SAME:
                flags.append(
                    f"shape of {other.frequency:.5g} Hz (MAC {mac[r, k]:.2f}): one peak split in "
                    "two, or sensors that cannot tell them apart"
                )
            elif len(task.H) == 1 and apart < max(half, other.damping * other.frequency):
                flags.append(
                    f"within the half bandwidth of {other.frequency:.5g} Hz: one peak split in "
                    "two, or two modes that one reference cannot tell apart"
                )
        out.append(
            Evidence(float(gain[r] / least), float(shares[r]), float(visible[r]), tuple(flags))
        )
    return out


def _visibility(task: Problem, fit: Fit) -> Floats:
    """Return the greatest share of every mode, over all functions, at its own frequency."""
    model = fit.model
    out = np.zeros(len(model))
    if not len(model):
        return out
    resonances = replace(task, s=1j * np.abs(model.lam) + task.s[0].real, powers=())
    E = modal_model.primitives(resonances, model.lam, squares=False)
    a = model.L.T[:, None, :] * model.phi.T[None]  # (references, responses, modes)
    measured = task.weight.any(axis=2)
    for r in range(len(model)):
        parts = np.abs(a.real * E[::2, r] + a.imag * E[1::2, r])
        share = parts[..., r] / np.maximum(parts.sum(axis=-1), np.finfo(float).tiny)
        out[r] = share[measured].max(initial=0.0)
    return out
