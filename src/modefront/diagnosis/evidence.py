r"""The cost of an explanation: how improbable data and parameters are under it.

Data sets differ from what they have in common by noise (`modefront.diagnosis.measured`), and that
differs from the model by what no parameter describes: frequencies by their logarithms, shapes of
mean square 1, both after `modefront.diagnosis.measured`. The parameters are expected near their
nominal values, by their logarithms where their bounds are positive. They are fitted by Gauss-Newton
steps with weights :math:`(\nu + 1) / (\nu + r_k^2 / \sigma^2)`, the pairs taken anew at every step.

========  ==============================================================================
symbol    meaning
========  ==============================================================================
c         (modes, sensors) shapes that the data sets have in common, of mean square 1
beta      (modes,) factors that make model shapes of them
x         (parameters,) logarithms of the parameters, or parameters over their unit
========  ==============================================================================
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.sparse

from modefront._typing import Bools, Floats, Ints
from modefront.diagnosis.measured import (
    NOTHING,
    RIGID,
    Measured,
    log_frequencies,
    loss,
    mac_values,
    pair_costs,
    scaled,
)
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine, SparseAffine
from modefront.models.base import Model
from modefront.models.geometry import Geometry
from modefront.models.matrices import MatrixModel
from modefront.pairing.match import assigned
from modefront.rounding import ACCUMULATED

OF_PARAMETERS, OF_MODEL = 8.0, 4.0
"""Degrees of freedom nu of parameters, and of what no parameter describes."""

FREQUENCY, SHAPE = 0.03, 0.08
"""Scales that are expected of what no parameter describes."""

OFF = 0.4
"""Scale of the parameters: of their logarithms, or over their unit."""

STEPS, LONGEST, ENOUGH = 10, 0.7, 0.05
"""Steps of a fit, their longest component, and the decrease of the cost that ends them."""

LARGE, SAMPLES = 80, 4
"""Degrees of freedom from which on a model is reduced, and models of its basis beside the nominal
one."""


@dataclass(frozen=True, eq=False)
class State:
    """Data and model under an explanation.

    Attributes
    ----------
    data : the measured modes
    foreign : (modes,) modes that the model does not have
    candidates : number of the lowest model modes among which pairs are sought
    selection : (sensors, N) weights of the degrees of freedom; None for a model without matrices
    geometry : places and directions of the sensors; None for a model without matrices
    start, lower, upper : (parameters,) nominal values and bounds
    """

    data: Measured
    foreign: Bools
    candidates: int
    selection: scipy.sparse.csr_array | None
    geometry: Geometry | None
    start: Floats
    lower: Floats
    upper: Floats

    @cached_property
    def is_positive(self) -> Bools:
        """Which parameters are changed by factors."""
        return (self.lower > 0) & (self.start > 0)

    @cached_property
    def unit(self) -> Floats:
        """Units of the other parameters: nominal values, or the ranges where these are 0."""
        return np.where(self.start != 0, np.abs(self.start), self.upper - self.lower)

    def x(self, theta: Floats) -> Floats:
        """Return the distance of parameters from the nominal ones in x."""
        ratio = np.where(self.is_positive, theta / np.where(self.start != 0, self.start, 1.0), 1.0)
        return np.where(self.is_positive, np.log(ratio), (theta - self.start) / self.unit)

    def theta(self, x: Floats) -> Floats:
        """Return the parameters at a distance from the nominal ones, within the bounds."""
        with np.errstate(over="ignore"):
            factors = np.exp(np.where(self.is_positive, x, 0.0))
        values = np.where(self.is_positive, self.start * factors, self.start + x * self.unit)
        return np.clip(values, self.lower, self.upper)


def places(model: MatrixModel) -> Geometry:
    """Return where sensors are: of nodes that move along a single axis, degrees of freedom."""
    if model.geometry is not None and len(model.geometry.axes) > 1:
        return model.geometry
    (n, N), dof = model.selection.shape, np.arange(model.size)
    motion = scipy.sparse.csr_array((np.ones(N), (3 * dof, dof)), shape=(3 * N, N))
    directions = np.column_stack([model.selection.sum(axis=1), np.zeros((n, 2))])
    greatest = abs(model.selection).argmax(axis=1)
    return Geometry(np.zeros((N, 3)), (), motion, greatest, directions)


@dataclass(frozen=True, eq=False)
class Point:
    """A state at parameters.

    Attributes
    ----------
    theta : (parameters,) parameters
    cost : C, without the price of the explanation
    index : (modes,) model mode of each measured one
    beta : (modes,) factors that make model shapes of the measured ones
    chi : (modes, sensors) shapes of the model at the sensors, 0 where not measured
    sigma, sigma_f : scales of the residuals of shapes and frequencies
    """

    theta: Floats
    cost: float
    index: Ints
    beta: Floats
    chi: Floats
    sigma: float
    sigma_f: float

    def mac(self, data: Measured) -> Floats:
        """Return the MAC of the pairs, (modes,); NaN without a shape."""
        values = mac_values(data.mean, data.known, self.chi.T)
        return np.asarray(np.diag(values))


class Whole(NamedTuple):
    """Frequencies (modes,) in Hz and shapes at all degrees of freedom (N, modes) at parameters.

    Of a model without matrices, shapes at the sensors.
    """

    theta: Floats
    frequency: Floats
    Phi: Floats


def point_of(state: State, whole: Whole) -> Point:
    """Return the state beside a model, with the best pairs."""
    phi = whole.Phi if state.selection is None else state.selection @ whole.Phi
    return point(state, whole.theta, whole.frequency, phi)


def point(
    state: State, theta: Floats, frequency: Floats, phi: Floats, index: Ints | None = None
) -> Point:
    """Return the state beside a model's frequencies (model modes,) and shapes at the sensors."""
    data = state.data
    known = data.known & ~state.foreign[:, None]
    logs = log_frequencies(frequency)
    cost = pair_costs(mac_values(data.mean, known, phi), data.logs, logs)
    cost[state.foreign] = 0.0
    index = assigned(cost[:, : state.candidates]) if index is None else index
    used = known & (known.sum(axis=1) > 1)[:, None]
    chi = np.where(data.known, phi[:, index].T, 0.0)
    c, weight = data.mean, used / data.motion**2
    for _ in range(3):
        square = (weight * chi**2).sum(axis=1)
        beta = np.divide((weight * chi * c).sum(axis=1), square, where=square > 0, out=0 * square)
        r = (beta[:, None] * chi - c) / data.motion
        size = np.abs(r[used])
        middle = float(np.partition(size, size.size // 2)[size.size // 2]) if size.size else 0.0
        typical = max(1.5 * middle, SHAPE / 4)
        weight = used / (1 + (r / typical) ** 2 / OF_MODEL) / data.motion**2
    of_shapes, sigma = scaled(r[used], SHAPE, OF_MODEL)
    elastic = ~state.foreign & np.isfinite(data.logs) & (frequency[index] > RIGID * frequency.max())
    of_frequencies, sigma_f = scaled((logs[index] - data.logs)[elastic], FREQUENCY, OF_MODEL)
    alone = NOTHING * float(data.known[state.foreign].sum() + state.foreign.sum())
    prior = loss(state.x(theta) / OFF, OF_PARAMETERS).sum()
    total = of_shapes + of_frequencies + alone + prior + data.noise
    return Point(theta, float(total), index, beta, chi, sigma, sigma_f)


@dataclass(frozen=True, eq=False)
class Quick:
    """A model of which ``count`` modes are quickly solved for, if in a basis (N, n) of modes."""

    model: Model
    basis: Floats | None
    count: int

    def everywhere(self, theta: Floats) -> Whole | None:
        """Return the modes at all degrees of freedom; None where there are none."""
        with suppress(ModelError):
            if not isinstance(self.model, MatrixModel):
                modes = self.model.modes(theta, self.count, derivatives=False)
                return Whole(theta, modes.frequency, modes.phi)
            full = self.model.full_modes(theta, self.count)
            f = np.sqrt(np.maximum(full.lam, 0.0)) / (2 * np.pi)
            return Whole(theta, f, full.Phi if self.basis is None else self.basis @ full.Phi)
        return None

    def fit(self, state: State, theta: Floats, steps: int = STEPS) -> Point | None:
        """Return the point at the end of a fit from ``theta``; None where there are no modes."""
        ahead = self._linear(state, theta)
        if ahead is None:
            return None
        here, damping = ahead, 1e-3
        for _ in range(steps):
            best, g, H = here
            step = np.linalg.solve(H + damping * np.diag(np.diag(H) + ACCUMULATED), -g)
            step = np.clip(step, -LONGEST, LONGEST)
            ahead = self._linear(state, state.theta(state.x(best.theta) + step))
            if ahead is None or ahead[0].cost > best.cost:
                damping = max(10 * damping, 0.1)
                continue
            here, damping = ahead, damping / 5
            if best.cost - here[0].cost < ENOUGH:
                break
        return here[0]

    def _linear(self, state: State, theta: Floats) -> tuple[Point, Floats, Floats] | None:
        """Return the point at ``theta`` with gradient and Gauss-Newton matrix of its cost in x."""
        modes, model = None, self.model
        if isinstance(model, MatrixModel) and state.selection is not None:
            rows = state.selection if self.basis is None else state.selection @ self.basis
            model = replace(model, selection=scipy.sparse.csr_array(rows))
        with suppress(ModelError):
            modes = model.modes(theta, self.count)
        if modes is None or not (np.isfinite(modes.dlam).all() and np.isfinite(modes.dphi).all()):
            return None
        at, data = point(state, theta, modes.frequency, modes.phi), state.data
        unit = np.where(state.is_positive, theta, state.unit)
        f = modes.frequency[at.index]
        known = ~state.foreign & np.isfinite(data.logs) & (f > RIGID * modes.frequency.max())
        used = data.known & ~state.foreign[:, None] & (data.known.sum(axis=1) > 1)[:, None]
        chi, beta = np.where(used, at.chi, 0.0), at.beta[:, None]
        dchi = np.where(used.T[..., None], modes.dphi[:, at.index] * unit, 0.0).transpose(1, 0, 2)
        b = (chi**2).sum(axis=1)[:, None]
        dbeta = np.einsum("rs,rsj->rj", data.mean - 2 * beta * chi, dchi)
        dbeta = np.divide(dbeta, b, out=np.zeros(dbeta.shape), where=b > 0)
        dr = chi[..., None] * dbeta[:, None] + beta[..., None] * dchi
        sigma = at.sigma * data.motion
        parts = (
            (np.log(f[known]) - data.logs[known]) / at.sigma_f,
            state.x(theta) / OFF,
            ((beta * chi - data.mean) / sigma)[used],
        )
        slopes = (
            modes.dfrequency[at.index[known]] / f[known, None] * unit / at.sigma_f,
            np.eye(theta.size) / OFF,
            (dr / sigma[:, None])[used],
        )
        nus = OF_MODEL, OF_PARAMETERS, OF_MODEL
        weights = [(nu + 1) / (nu + r**2) for r, nu in zip(parts, nus, strict=True)]
        r, J, w = np.concatenate(parts), np.concatenate(slopes), np.concatenate(weights)
        return at, J.T @ (w * r), J.T @ (w[:, None] * J)


def quick(model: Model, matrices: MatrixModel | None, count: int, state: State) -> Quick:
    """Return a model that is quickly solved: a large one in the space of modes at some parameters.

    ``matrices`` are those that the model has at the nominal parameters of ``state``.
    """
    if matrices is None or matrices.size <= max(LARGE, 4 * count):
        return Quick(model if matrices is None else matrices, None, count)
    rng = np.random.default_rng(0)
    factors = np.exp(rng.uniform(-OFF, OFF, (SAMPLES, state.start.size)) * 2)
    shapes = [matrices.full_modes(state.start, count).Phi]
    for factor in factors:
        with suppress(ModelError):
            theta = np.clip(state.start * factor, state.lower, state.upper)
            shapes.append(matrices.full_modes(theta, count).Phi)
    V, size, _ = np.linalg.svd(np.hstack(shapes), full_matrices=False)
    V = V[:, size > 1e-7 * size[0]]
    K, M = (_projected(A, V) for A in (matrices.stiffness, matrices.mass))
    rows = scipy.sparse.csr_array(matrices.selection @ V)
    return Quick(
        replace(matrices, selection=rows, stiffness=K, mass=M, outputs={}, base={}), V, count
    )


def _projected(A: DenseAffine | SparseAffine, V: Floats) -> DenseAffine:
    """Return V^T A V."""
    terms = V.T @ A.terms @ V if isinstance(A, DenseAffine) else A.project([V], V)
    return DenseAffine((terms + terms.transpose(0, 2, 1)) / 2, A.coefficients)
