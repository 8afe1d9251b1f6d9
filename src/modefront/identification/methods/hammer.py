r"""From frequency response functions of one data set to its modes.

1. Poles over a range of orders (`lscf`), their diagram and its clusters (`stabilisation`).
2. The modal model from the likely clusters (`modal_model`); modes that do not pay are left out,
   poles that do are added (`selection`), and the variance is that of the data or, where nothing
   is known, that of the residuals (`noise`).
3. Standard deviations (`statistics`); modes that are no modes of the structure are rejected.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from modefront._typing import Bools, Complexes, Floats
from modefront.data.responses import ORDERS, FrequencyResponses
from modefront.identification import lscf, modal_model, selection
from modefront.identification.modal_model import Fit, Problem
from modefront.identification.noise import fitted_variance, variance_from_differences
from modefront.identification.record import (
    FittedFunctions,
    Identification,
    ModeEstimate,
    Rejected,
)
from modefront.identification.stabilisation import (
    MOST_DAMPING,
    Cluster,
    StabilisationDiagram,
    stabilisation_diagram,
)
from modefront.identification.statistics import mode_estimates, residuals

Weighting = Literal["given", "scaled", "residuals"]

LEAST_LINES = 20
"""Lines of a band, at least: a mode with its residual terms has twelve numbers a function."""

MOST_POLES = 60
"""Poles at the highest order: some seven for each of eight modes, as usual in diagrams."""

MOST_ORDERS = 25
"""Orders of a diagram; more add no information to clusters of poles."""

CHOICE_LINES = 4096
"""Lines from which the modes are chosen where there are more lines, those of sharp peaks apart."""

PEAK_WIDTH = 20.0
"""Half bandwidths on either side of a sharp peak within which all lines are kept."""

PRINCIPAL = 48
"""Principal responses from which the modes are chosen where there are more responses."""

SUPPORT = 0.5
"""Least share of the orders, from the first one with this pole, that have it."""

WIDEST = 1.0
"""Greatest standard deviation of damping over damping, and of a frequency over half its bandwidth
or over the distance of lines."""

LEAST_LEFT = 0.1
"""Least share of the noise of a line that its residual is taken to hold."""

VISIBLE = 1 / 3
"""Least share of a mode in the sum of all at its frequency, where it is greatest."""

LEAST_COLLINEARITY = 0.5
"""Least phase collinearity of a mode."""

SEED = 20080410
"""Of the random combinations of the singular value decomposition."""


def identify(
    data: FrequencyResponses,
    band: tuple[float, float] | None = None,
    modes: int | None = None,
    orders: Sequence[int] | None = None,
) -> Identification:
    """Return the modes of one data set within a band in Hz, by default all of it.

    ``modes`` is their number where it is known; ``orders`` are those of the stabilisation diagram.
    Raises ValueError where the band has too few lines or nothing was measured in it.
    """
    data = data.within(*(band or (0.0, np.inf)))
    if len(data.frequency) < LEAST_LINES:
        raise ValueError(f"expected {LEAST_LINES} lines in the band, found {len(data.frequency)}")
    if not np.any(np.abs(np.nan_to_num(data.H)) > 0):
        raise ValueError("expected functions that are not zero, found only zeros")
    variance = _known_variance(data)
    first = variance_from_differences(data) if variance is None else variance
    small, small_variance = _principal(data, first)
    diagram, clusters = _diagram(small, small_variance, orders)
    kept = _lines_of_choice(small.frequency, diagram)
    small, small_variance = small.lines(kept), small_variance[..., kept]
    task, omega, _ = modal_model.problem(small, small_variance, 1)
    task, fit = _select(task, omega, diagram, clusters, modes, weighting(small))
    level = modal_model.RESIDUALS.index(task.powers)
    task, omega, size = modal_model.problem(data, first, level)
    model = fit.model
    start = modal_model.evaluate(task, model.lam, model.L, model.held)
    task = _reweighted(task, start, weighting(data))
    if weighting(data) != "given":
        fit = selection.refit(task, start)
        task = _reweighted(task, fit, weighting(data))
        start = fit
    fit = selection.refit(task, start, modal_model.FINE, modal_model.MOST_EVALUATIONS)
    solution = _Solution(data, task, fit, omega, size, diagram)
    return _result(solution, clusters, modes is not None)


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


def _known_variance(data: FrequencyResponses) -> Floats | None:
    if data.variance is None or weighting(data) == "residuals":
        return None
    return fitted_variance(np.where(data.measured, data.variance, np.nan), data.H)


def _principal(data: FrequencyResponses, variance: Floats) -> tuple[FrequencyResponses, Floats]:
    """Return principal responses of unit variance, by a randomised singular value decomposition.

    Halko, Martinsson & Tropp, SIAM Rev. 53 (2011) 217-288, doi:10.1137/090771806.
    """
    n_in, n_out, lines = data.H.shape
    if n_out <= PRINCIPAL:
        return data, variance
    level = np.sqrt(np.nanmedian(variance, axis=(0, 2)))
    level = np.where(np.isfinite(level) & (level > 0), level, np.inf)
    H = (np.where(data.measured, data.H, 0) / level[:, None]).transpose(1, 0, 2)
    # real combinations, as complex ones would have other residues at poles of negative frequency
    flat = np.ascontiguousarray(H).reshape(n_out, -1).view(float)
    draws = np.random.default_rng(SEED).standard_normal((flat.shape[1], PRINCIPAL + 10))
    basis = np.linalg.qr(flat @ draws)[0]
    U = basis @ np.linalg.svd(basis.T @ flat, full_matrices=False)[0][:, :PRINCIPAL]
    principal = (U.T @ flat).view(complex).reshape(PRINCIPAL, n_in, lines).transpose(1, 0, 2)
    names = tuple(f"principal {i + 1}" for i in range(PRINCIPAL))
    small = replace(data, H=principal, responses=names, variance=None)
    return small, variance_from_differences(small)


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


def _diagram(
    data: FrequencyResponses, variance: Floats, orders: Sequence[int] | None
) -> tuple[StabilisationDiagram, list[Cluster]]:
    H = np.where(data.measured, data.H, 0)
    weight = np.nan_to_num(1 / variance).mean(axis=0)
    weight = weight / weight.max()
    omega = 2 * np.pi * data.frequency
    rate = 2 * np.pi * lscf.ARC / (omega[-1] - omega[0])
    if orders is None:
        most = max(MOST_POLES // H.shape[0], 6)
        most = min(most, len(omega) // 4)
        orders = sorted(set(np.linspace(2, most, min(MOST_ORDERS, most - 1)).astype(int).tolist()))
    z = lscf.generalised_frequency(omega, omega[0], rate)
    sums = lscf.moments(H, weight, z, max(orders))
    windowed = lscf.poles(sums, orders, omega[0], rate)
    estimates = [lscf.without_decay(poles, data.decay) for poles in windowed]
    s: Complexes = np.asarray(1j * omega + data.decay, complex)
    return stabilisation_diagram(estimates, H, s, ORDERS[data.quantity])


def _select(
    task: Problem,
    omega: float,
    diagram: StabilisationDiagram,
    clusters: list[Cluster],
    modes: int | None,
    kind: Weighting,
) -> tuple[Problem, Fit]:
    """Return the problem, with its residual terms and variance, and the modes that data need."""
    fit = selection.start(task, clusters, omega, modes)
    task = selection.choose_level(task, fit)
    fit = selection.refit(task, fit)
    if kind != "given":
        task = _reweighted(task, fit, kind)
        fit = selection.refit(task, fit)
    if modes is not None:
        return task, fit
    candidates = selection.distinct(diagram.pole) / omega
    for _ in range(selection.MOST_ADDED):
        fit = selection.backward(task, fit)
        more, candidates = selection.forward(task, fit, candidates)
        if more is fit:
            break
        fit = more
        if kind != "given":
            task = _reweighted(task, fit, kind)
            fit = selection.refit(task, fit)
    task = selection.choose_level(task, fit)
    fit = selection.refit(task, fit)
    return task, selection.backward(task, fit)


def _reweighted(task: Problem, fit: Fit, kind: Weighting) -> Problem:
    """Return the problem weighted by the smooth variance of the residuals of a fit.

    Where the variance is given it stays; where it is known up to a factor it gets that.
    """
    if kind == "given":
        return task
    H = modal_model.synthesise(task, fit.model)
    used = task.weight > 0
    left = np.maximum(1 - modal_model.leverage(task, fit), LEAST_LEFT)
    raw = np.where(used, np.abs(task.H - H) ** 2 / left, np.nan)
    if kind == "scaled":
        lines = np.maximum(used.sum(axis=2, keepdims=True), 1)
        factor = np.where(used, raw * task.weight, 0).sum(axis=2, keepdims=True) / lines
        return replace(task, weight=task.weight / np.where(factor > 0, factor, 1.0))
    variance = fitted_variance(raw, np.where(used, H, np.nan))
    return replace(task, weight=np.where(used, 1 / variance, 0.0))


@dataclass(frozen=True)
class _Solution:
    """The last fit to the data, with its units of frequency and of functions."""

    data: FrequencyResponses
    task: Problem
    fit: Fit
    omega: float
    size: float
    diagram: StabilisationDiagram


def _result(solution: _Solution, clusters: list[Cluster], given: bool) -> Identification:
    """Return accepted and rejected modes; ``given`` is whether their number is."""
    task, fit, omega = solution.task, solution.fit, solution.omega
    misfit = residuals(task, fit)
    estimates = mode_estimates(task, fit, misfit, omega)
    reasons = _reasons(solution, estimates, given)
    kept = [mode for mode, why in zip(estimates, reasons, strict=True) if not why]
    rejected = [
        Rejected(float(mode.frequency), float(mode.damping), why)
        for mode, why in zip(estimates, reasons, strict=True)
        if why
    ]
    rejected += _passed_over(clusters, fit.model.lam * omega)
    weight = np.where(task.weight > 0, task.weight, np.nan)
    functions = FittedFunctions(
        solution.data,
        modal_model.synthesise(task, fit.model) * solution.size,
        solution.size**2 / weight,
        misfit,
        modal_model.RESIDUALS.index(task.powers),
    )
    f = solution.data.frequency
    return Identification(
        solution.data.responses,
        (float(f[0]), float(f[-1])),
        tuple(sorted(kept, key=lambda mode: mode.frequency)),
        tuple(sorted(rejected, key=lambda pole: pole.frequency)),
        solution.diagram,
        functions,
        fit.evaluations,
        fit.converged,
    )


def support(diagram: StabilisationDiagram, pole: Complexes, strength: Floats) -> Floats:
    """Return the share of the orders, from the first one with a mode's pole, that have it.

    ``pole`` and ``strength`` are those of all modes. At each order a pole of the diagram belongs to
    one mode, the stronger ones first, so that two modes need two poles.
    """
    present = np.zeros((len(pole), len(diagram.orders)), bool)
    reach = np.maximum(0.005 * np.abs(pole), -0.5 * pole.real)
    for k, order in enumerate(diagram.orders):
        left = diagram.pole[diagram.order == order]
        for r in strength.argsort()[::-1]:
            distance = np.abs(left - pole[r])
            if distance.min(initial=np.inf) < reach[r]:
                present[r, k] = True
                left = np.delete(left, distance.argmin())
    since = np.maximum.accumulate(present, axis=1).sum(axis=1)
    out: Floats = present.sum(axis=1) / np.maximum(since, 1)
    return out


def _reasons(solution: _Solution, estimates: Sequence[ModeEstimate], given: bool) -> list[str]:
    """Return why each mode is none; empty where it is one."""
    task, fit, frequency = solution.task, solution.fit, solution.data.frequency
    spacing = float(np.median(np.diff(frequency)))
    strength = selection.gains(task, fit)
    doubled = selection.doubles(fit.model.lam, fit.model.phi, strength)
    shares = support(solution.diagram, fit.model.lam * solution.omega, strength)
    out = []
    for mode, double, share, seen in zip(
        estimates, doubled, shares, _visibility(task, fit), strict=True
    ):
        half = max(mode.damping * mode.frequency, spacing)
        why = ""
        if not frequency[0] <= mode.frequency <= frequency[-1]:
            why = "outside the band"
        elif mode.damping > MOST_DAMPING:
            why = "damped too heavily for a mode"
        elif double:
            why = "doubles a stronger mode of the same shape"
        elif mode.frequency_std > WIDEST * half or mode.damping_std > WIDEST * mode.damping:
            why = (
                f"not determined: {mode.frequency_std:.2g} Hz, damping {mode.damping_std:.2g} "
                "standard deviation"
            )
        elif share < SUPPORT and not given:
            why = f"on {share:.0%} of the orders only"
        elif mode.shape.collinearity < LEAST_COLLINEARITY:
            why = f"its shape has no common phase: phase collinearity {mode.shape.collinearity:.2f}"
        elif seen < VISIBLE and not given:
            why = f"at most {seen:.0%} of any function at its own frequency"
        out.append(why)
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


def _passed_over(clusters: Sequence[Cluster], poles: Complexes) -> list[Rejected]:
    """Return the clusters that the likelihood did not need, none of the poles being near."""
    out = []
    for cluster in clusters:
        reach = np.maximum(0.02 * abs(cluster.pole), -poles.real)
        if cluster.size >= selection.LEAST_ORDERS and not (abs(cluster.pole - poles) < reach).any():
            frequency, damping = (
                abs(cluster.pole) / (2 * np.pi),
                -cluster.pole.real / abs(cluster.pole),
            )
            out.append(Rejected(frequency, damping, "the data do not need it"))
    return out
