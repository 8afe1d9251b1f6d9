r"""The cost of explanations, many at once: how improbable data and parameters are under each.

Data sets differ from what they have in common by noise (`modefront.diagnosis.measured`), and that
differs from the model by what no parameter describes: frequencies by their logarithms, shapes of
mean square 1. Mode r of the data and mode q of a model are as far apart as

.. math:: c_{rq} = 1 - \mathrm{MAC}_{rq} + \kappa \min(|\ln f_q - \ln \hat f_r|, d).

Shapes alone cannot tell a mode with a reversed sensor from another mode, nor frequencies alone
which of two close modes is which. The parameters are expected near their nominal values, by their
logarithms where their bounds are positive. They are fitted by Gauss-Newton steps with weights
:math:`(\nu + 1) / (\nu + r_k^2 / \sigma^2)`, the pairs taken anew at every step.

========  ==============================================================================
symbol    meaning
========  ==============================================================================
c         (modes, sensors) shapes that the data sets have in common, of mean square 1
beta      (modes,) factors that make model shapes of them
x         (parameters,) logarithms of the parameters, or parameters over their unit
========  ==============================================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse

from modefront._typing import Bools, Floats, Ints
from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.measured import NOTHING, Measured, loss, mac_values, ratio, scaled
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine, SparseAffine, first_axis
from modefront.models.base import Model
from modefront.models.geometry import Geometry
from modefront.models.matrices import MatrixModel
from modefront.pairing.match import assigned
from modefront.residuals.problem import UpdatingProblem
from modefront.rounding import ACCUMULATED, TINY

RIGID = 1e-6
"""Frequency over the greatest one below which a mode is one of a rigid body: rounding leaves the
root of 1e-13."""

KAPPA, FARTHEST = 0.4, 2.5
"""Cost of a factor e between frequencies, in units of a MAC value, up to the logarithm d."""

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

KEPT, TOGETHER = 64, 256
"""Models that are kept, as many explanations are compared at the same parameters, and explanations
that are compared at once, which bounds the memory."""


@dataclass(frozen=True, eq=False)
class State:
    """Data and model under an explanation, or under each of several, as further axes in front.

    Attributes
    ----------
    data : the measured modes
    foreign : (modes,) modes that the model does not have
    candidates : number of the lowest model modes among which pairs are sought
    rows : (sensors, n) weights of the coordinates of the model's modes at each sensor
    basis : (N, n) motion of the degrees of freedom with these coordinates
    geometry : places and directions of the sensors; None for a model without matrices
    start, lower, upper : (parameters,) nominal values and bounds
    """

    data: Measured
    foreign: Bools
    candidates: Ints
    rows: Floats
    basis: Floats
    geometry: Geometry | None
    start: Floats
    lower: Floats
    upper: Floats

    @property
    def is_positive(self) -> Bools:
        """Which parameters are changed by factors."""
        return (self.lower > 0) & (self.start > 0)

    @property
    def unit(self) -> Floats:
        """Units of the other parameters: nominal values, or the ranges where these are 0."""
        return np.where(self.start != 0, np.abs(self.start), self.upper - self.lower)

    def x(self, theta: Floats) -> Floats:
        """Return the distance of parameters from the nominal ones in x."""
        logs = np.log(np.where(self.is_positive, ratio(theta, self.start), 1.0))
        return np.where(self.is_positive, logs, (theta - self.start) / self.unit)

    def theta(self, x: Floats) -> Floats:
        """Return the parameters at a distance from the nominal ones, within the bounds."""
        with np.errstate(over="ignore"):
            factors = np.exp(np.where(self.is_positive, x, 0.0))
        values = np.where(self.is_positive, self.start * factors, self.start + x * self.unit)
        return np.clip(values, self.lower, self.upper)


def stacked(records: Sequence[Any]) -> Any:
    """Return several records of arrays as one; all have the basis and the geometry of the first."""
    first, parts = records[0], {}
    for name in [each.name for each in fields(first)]:
        some = [getattr(each, name) for each in records]
        shared = name in ("basis", "geometry")
        parts[name] = some[0] if shared else stacked(some) if name == "data" else np.stack(some)
    return type(first)(**parts)


class Solved(NamedTuple):
    """Modes of a model at parameters, in the coordinates of the rows of a state.

    These are frequencies (modes,) in Hz and shapes (n, modes), and where they are asked for their
    derivatives by each parameter, (modes, p) and (n, modes, p).
    """

    theta: Floats
    frequency: Floats
    phi: Floats
    slopes: tuple[Floats, ...] = ()


class Points(NamedTuple):
    """States at parameters, or one without the axis in front.

    These are parameters, cost C without the price of the explanation, model mode of each measured
    one, the MAC of these pairs (NaN without a shape), factors that make model shapes of the
    measured ones (modes,), the scale of the residuals of shapes, and where the model's modes have
    slopes, gradient (p,) and Gauss-Newton matrix (p, p) of the cost in x.
    """

    theta: Floats
    cost: Floats
    pairs: Ints
    mac: Floats
    beta: Floats
    sigma: Floats
    g: Floats
    H: Floats

    def at(self, k: int) -> Points:
        """Return one of several states."""
        return Points(*(each[k] for each in self))


def log_frequencies(frequency: Floats) -> Floats:
    """Return logarithms of a model's frequencies; those of rigid-body modes are far below all."""
    least = RIGID * frequency.max(axis=-1, keepdims=True, initial=0.0)
    return np.log(np.maximum(frequency, np.maximum(least, TINY)))


# More than 60 lines: the cost and its slopes share all residuals.
def points(state: State, solved: Sequence[Solved], pairs: Any = None) -> Points:
    """Return states, with an axis in front, each beside modes, with the best or given pairs."""
    theta, frequency, phi = (np.stack(x) for x in list(zip(*solved, strict=True))[:3])
    data, foreign, logs = state.data, state.foreign, log_frequencies(frequency)
    phi = state.rows @ phi
    known, c, scale = data.known & ~foreign[..., None], data.mean, data.motion[:, None]
    mac = mac_values(c, known, phi)
    distance = np.abs(logs[:, None] - data.logs[..., None])
    cost = np.where(np.isnan(mac), 0.0, 1 - mac)
    cost += KAPPA * np.where(np.isnan(distance), 0.0, np.minimum(distance, FARTHEST))
    cost[foreign] = 0.0
    if pairs is None:
        some = zip(cost, state.candidates.tolist(), strict=True)
        pairs = np.array([assigned(each[:, :count]) for each, count in some])
    k = np.arange(len(theta))[:, None]
    f, logs, mac = frequency[k, pairs], logs[k, pairs], mac[k, np.arange(pairs.shape[1]), pairs]
    used = known & (known.sum(axis=-1, keepdims=True) > 1)
    chi, weight = used * phi.swapaxes(1, 2)[k, pairs], used / scale**2
    flat = used.reshape(len(used), -1)
    for _ in range(3):
        square = (weight * chi**2).sum(axis=-1, keepdims=True)
        beta = ratio((weight * chi * c).sum(axis=-1, keepdims=True), square)
        r_s = used * (beta * chi - c) / scale
        of_shapes, sigma = scaled(r_s.reshape(flat.shape), SHAPE, OF_MODEL, flat)
        weight = used / (1 + (r_s / sigma[:, None, None]) ** 2 / OF_MODEL) / scale**2
    elastic = ~foreign & np.isfinite(data.logs) & (f > RIGID * frequency.max(axis=1)[:, None])
    r_f, x = np.where(elastic, logs - data.logs, 0.0), state.x(theta) / OFF
    of_frequencies, sigma_f = scaled(r_f, FREQUENCY, OF_MODEL, elastic)
    alone = NOTHING * (foreign * (1 + data.known.sum(axis=-1))).sum(axis=-1)
    prior = loss(x, OF_PARAMETERS).sum(axis=-1)
    total = of_shapes + of_frequencies + alone + prior + data.noise
    g = H = np.zeros((len(theta), 0))
    if solved[0].slopes:
        n, p = theta.shape
        unit = np.where(state.is_positive, theta, state.unit)[:, None]
        df = np.stack([each.slopes[0][i] for each, i in zip(solved, pairs, strict=True)]) * unit
        of_each = zip(state.rows, solved, pairs, strict=True)
        dchi = np.stack([first_axis(R, x.slopes[1][:, i]) for R, x, i in of_each]).swapaxes(1, 2)
        dr = beta[..., None] * dchi * unit[:, None]
        square = (weight * chi**2).sum(axis=-1, keepdims=True)
        along = ratio(np.einsum("brs,brsp->brp", weight * chi, dr), square)
        dr = used[..., None] * (dr - chi[..., None] * along[:, :, None]) / scale[..., None]
        of_f, of_s = sigma_f[:, None], sigma[:, None]
        r = np.concatenate([r_f / of_f, x, r_s.reshape(flat.shape) / of_s], axis=1)
        J = [elastic[..., None] * ratio(df, f[..., None]) / of_f[..., None]]
        J += [np.broadcast_to(np.eye(p) / OFF, (n, p, p)), dr.reshape(n, -1, p) / of_s[..., None]]
        nu = np.repeat([OF_MODEL, OF_PARAMETERS, OF_MODEL], [x.shape[1] for x in J])
        w, slopes = (nu + 1) / (nu + r**2), np.concatenate(J, axis=1)
        g = np.einsum("bmp,bm->bp", slopes, w * r)
        H = slopes.swapaxes(1, 2) @ (w[..., None] * slopes)
    return Points(theta, total, pairs, mac, beta[..., 0], sigma, g, H)


def roughly(states: Sequence[State], old: State, at: Points, solved: Solved) -> Floats:
    """Return the costs of other shapes beside a model, with pairs, factors and scales as before.

    ``at`` is the ``old`` state beside the model; what does not change the shapes is left out.
    """
    data = old.data
    new = replace(data, shape=np.stack([each.data.shape for each in states]))
    of_model = at.beta[:, None] * (old.rows @ solved.phi[:, at.pairs]).T
    expected = data.factors(data.mean) * of_model * (data.size / new.size)[..., None]
    r = np.nan_to_num((new.psi - expected) / (at.sigma * data.motion))
    costs = (new.seen * (loss(r, OF_MODEL) + np.log(at.sigma))).sum(axis=(1, 2, 3))
    return np.asarray(costs + [each.data.left_out for each in states])


def places(model: MatrixModel) -> Geometry:
    """Return where sensors are: of nodes that move along a single axis, degrees of freedom."""
    if model.geometry is not None and len(model.geometry.axes) > 1:
        return model.geometry
    (n, N), dof = model.selection.shape, np.arange(model.size)
    motion = scipy.sparse.csr_array((np.ones(N), (3 * dof, dof)), shape=(3 * N, N))
    directions = np.column_stack([model.selection.sum(axis=1), np.zeros((n, 2))])
    greatest = abs(model.selection).argmax(axis=1)
    return Geometry(np.zeros((N, 3)), (), motion, greatest, directions)


class Fits:
    """Costs and fits of explanations of a comparison.

    A model with matrices is solved at all degrees of freedom, a large one in the space of its modes
    at some parameters.
    """

    def __init__(self, comparison: Comparison) -> None:
        problem, matrices = comparison.problem, comparison.matrices
        self.count = min(problem.model.size, comparison.frequency.size)
        model: Model = problem.model
        geometry, rows = None, np.eye(len(problem.data.sensors))
        basis = rows
        if matrices is not None:
            model, basis = in_space_of_modes(matrices, self.count, problem)
            geometry, rows = places(matrices), matrices.selection @ basis
        foreign, low = np.zeros(len(problem.data.modes), bool), np.array(comparison.candidates)
        bounds = problem.start, problem.lower, problem.upper
        self.plain = State(comparison.view, foreign, low, rows, basis, geometry, *bounds)

        @lru_cache(KEPT)
        def solve(theta: bytes, derivatives: bool) -> Solved | None:
            values = np.frombuffer(theta)
            with suppress(ModelError):
                modes = model.modes(values, self.count, derivatives=derivatives)
                if not derivatives:
                    return Solved(values, modes.frequency, modes.phi)
                if np.isfinite(modes.dlam).all() and np.isfinite(modes.dphi).all():
                    slopes = modes.dfrequency, modes.dphi
                    return Solved(values, modes.frequency, modes.phi, slopes)
            return None

        self._solve = solve

    def solved(self, theta: Floats, derivatives: bool = False) -> Solved | None:
        """Return the modes at parameters; None where there are none."""
        return self._solve(theta.tobytes(), derivatives)

    def least(
        self, states: Sequence[State], tried: Sequence[Sequence[Floats]]
    ) -> tuple[Floats, list[Floats]]:
        """Return the least cost of each state at some parameters, and these.

        It is infinite where the model has modes at none of them.
        """
        costs = np.full((len(states), max(map(len, tried), default=1)), np.inf)
        places = [(k, i, theta) for k, thetas in enumerate(tried) for i, theta in enumerate(thetas)]
        known = [(k, i, x) for k, i, theta in places if (x := self.solved(theta))]
        for first in range(0, len(known), TOGETHER):
            rows, columns, solved = zip(*known[first : first + TOGETHER], strict=True)
            costs[rows, columns] = points(stacked([states[k] for k in rows]), solved).cost
        best = costs.argmin(axis=1).tolist()
        return costs.min(axis=1), [x[i] for x, i in zip(tried, best, strict=True)]

    def fitted(
        self, states: Sequence[State], thetas: Sequence[Floats], steps: int = STEPS
    ) -> list[Points | None]:
        """Return the points at the end of fits from parameters; None where there are no modes."""
        solved = {k: x for k, theta in enumerate(thetas) if (x := self.solved(theta, True))}
        here: dict[int, Points] = {}
        if solved:
            at = points(stacked([states[k] for k in solved]), list(solved.values()))
            here = {k: at.at(i) for i, k in enumerate(solved)}
        damping = dict.fromkeys(solved, 1e-3)
        for _ in range(steps):
            ahead = []
            for k in damping:
                theta, *_, g, H = here[k]
                step = np.linalg.solve(H + damping[k] * np.diag(np.diag(H) + ACCUMULATED), -g)
                x = states[k].x(theta) + np.clip(step, -LONGEST, LONGEST)
                ahead.append(states[k].theta(x))
            ends = self.fitted([states[k] for k in damping], ahead, 0)
            for k, new in zip(list(damping), ends, strict=True):
                if new is None or new.cost > here[k].cost:
                    damping[k] = max(10 * damping[k], 0.1)
                    continue
                gain, here[k] = here[k].cost - new.cost, new
                damping[k] /= 5
                if gain < ENOUGH:
                    del damping[k]
        return [here.get(k) for k in range(len(states))]


def in_space_of_modes(
    matrices: MatrixModel, count: int, problem: UpdatingProblem
) -> tuple[MatrixModel, Floats]:
    """Return a model with all of its coordinates as sensors, and its basis V (N, n).

    A large one is reduced to modes at the nominal parameters and at others by chance.
    """
    V, K, M = np.eye(matrices.size), matrices.stiffness, matrices.mass
    if matrices.size > max(LARGE, 4 * count):
        logs, shapes = (
            np.random.default_rng(0).uniform(-OFF, OFF, (SAMPLES, len(problem.start))),
            [],
        )
        for factor in (1.0, *np.exp(2 * logs)):
            with suppress(ModelError):
                theta = np.clip(problem.start * factor, problem.lower, problem.upper)
                shapes.append(matrices.full_modes(theta, count).Phi)
        V, size, _ = np.linalg.svd(np.hstack(shapes), full_matrices=False)
        V = V[:, size > 1e-7 * size[0]]
        K, M = _projected(K, V), _projected(M, V)
    every = scipy.sparse.eye_array(V.shape[1], format="csr")
    parts: dict[str, Any] = {"sensors": (), "outputs": {}, "base": {}, "geometry": None}
    return replace(matrices, selection=every, stiffness=K, mass=M, **parts), V


def _projected(A: DenseAffine | SparseAffine, V: Floats) -> DenseAffine:
    """Return V^T A V."""
    terms = V.T @ A.terms @ V if isinstance(A, DenseAffine) else A.project([V], V)
    return DenseAffine((terms + terms.transpose(0, 2, 1)) / 2, A.coefficients)
