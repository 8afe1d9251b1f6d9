r"""The cost of explanations, many at once: how improbable data and parameters are under each.

Data sets differ from what they have in common by noise (`modefront.diagnosis.state`), and that
differs from the model by what no parameter describes: frequencies by their logarithms, shapes of
mean square 1, c of the data and beta chi of the model. Mode r of the data and mode q of a model are
as far apart as

.. math:: c_{rq} = 1 - \mathrm{MAC}_{rq} + \kappa \min(|\ln f_q - \ln \hat f_r|, d).

Shapes alone cannot tell a mode with a reversed sensor from another mode, nor frequencies alone
which of two close modes is which. The parameters are expected near their nominal values, by their
logarithms where their bounds are positive. They are fitted by Gauss-Newton steps with weights
:math:`(\nu + 1) / (\nu + r_k^2 / \sigma^2)`, the pairs taken anew at every step.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.state import State, loss, ratio, scaled, stacked
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine, first_axis
from modefront.models.base import Model
from modefront.models.geometry import chain_geometry
from modefront.models.matrices import MatrixModel
from modefront.modes.result import Modes
from modefront.pairing.match import assigned
from modefront.residuals.problem import UpdatingProblem
from modefront.rounding import ACCUMULATED, TINY

RIGID = 1e-6
"""Share of the greatest frequency below which a mode is a rigid body's: rounding leaves 3e-7."""

KAPPA, FARTHEST = 0.4, 2.5
"""Cost of a factor e between frequencies, in units of a MAC value, up to the logarithm d."""

OF_PARAMETERS, OF_MODEL = 8.0, 4.0
"""Degrees of freedom nu of parameters, and of what no parameter describes."""

FREQUENCY, SHAPE = 0.03, 0.08  # scales that are expected of what no parameter describes
OFF = 0.4  # scale of the parameters: of their logarithms, or over their unit

WIDER = 4.0
"""Factor beyond positive bounds up to which fits go, so that no mistake stands for a bound."""

STEPS, LONGEST, ENOUGH, DAMPING = 10, 0.7, 0.05, 1e-3
"""Steps of a fit, their longest component, the decrease of the cost that ends them, and the share
of the diagonal of H that is added to it in the first."""

LARGE, SAMPLES = 80, 4
"""Degrees of freedom from which on a model is reduced, and models of its basis beside the nominal
one."""

KEPT, NUMBERS = 2**25, 2**18
"""Numbers of the models that are kept, as many explanations are compared at the same parameters,
and of an array of those that are compared at once: both bound the memory."""


class Points(NamedTuple):
    """States at parameters, or one without the axis in front.

    These are x of the parameters, cost C without the price of the explanation, this cost ahead,
    after a step of a fit with residuals to first order, model mode of each measured one, the MAC of
    these pairs (NaN without a shape), factors that make model shapes of the measured ones (modes,),
    scale of the residuals of shapes, gradient (p,) and Gauss-Newton matrix (p, p) of the cost in x.
    """

    x: Floats
    cost: Floats
    ahead: Floats
    pairs: Ints
    mac: Floats
    beta: Floats
    sigma: Floats
    g: Floats
    H: Floats

    def at(self, k: int) -> "Points":
        """Return one of several states."""
        return Points(*(each[k] for each in self))


def step(g: Floats, H: Floats, damping: float) -> Floats:
    """Return the step of a fit (..., p): that of Gauss and Newton with more of H's diagonal."""
    diagonal = np.einsum("...ii->...i", H)[..., None] + ACCUMULATED
    H = H + damping * diagonal * np.eye(g.shape[-1])
    return np.clip(np.linalg.solve(H, -g[..., None])[..., 0], -LONGEST, LONGEST)


def mac_values(psi: Floats, known: Any, phi: Floats) -> Floats:
    """Return the MAC of shapes (..., modes, sensors) and a model's, (..., modes, model modes).

    ``phi`` is (..., sensors, model modes). It is NaN with fewer than two known components.
    """
    psi = psi * known
    norm = (psi**2).sum(axis=-1, keepdims=True) * (known @ phi**2)
    values = ratio((psi @ phi) ** 2, norm)
    return np.where(known.sum(axis=-1, keepdims=True) < 2, np.nan, values)


def pair_costs(mac: Floats, logs: Floats, of_model: Floats) -> Floats:
    """Return c, (..., modes, model modes), of a MAC and logarithms of frequencies; see above."""
    distance = np.abs(of_model[..., None, :] - logs[..., None])
    return np.nan_to_num(1 - mac) + KAPPA * np.nan_to_num(np.minimum(distance, FARTHEST))


def log_frequencies(frequency: Floats) -> Floats:
    """Return logarithms of a model's frequencies; those of rigid-body modes are far below all."""
    least = RIGID * frequency.max(axis=-1, keepdims=True, initial=0.0)
    return np.log(np.maximum(frequency, np.maximum(least, TINY)))


# More than 60 lines: the cost and its slopes share all residuals.
def points(state: State, xs: Sequence[Floats], modes: Sequence[Modes], pairs: Any = None) -> Points:
    """Return states, with an axis in front, each beside modes, with the best or given pairs."""
    x, frequency = np.stack(xs), np.stack([each.frequency for each in modes])
    logs, phi = log_frequencies(frequency), state.rows @ np.stack([each.phi for each in modes])
    known, c, scale = state.known, state.mean, state.motion[:, None]
    mac = mac_values(c, known, phi)
    if pairs is None:
        some = zip(pair_costs(mac, state.logs, logs), state.candidates.tolist(), strict=True)
        pairs = np.array([assigned(each[:, :count]) for each, count in some])
    (n, p), k = x.shape, np.arange(len(x))[:, None]
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
    elastic = np.isfinite(state.logs) & (f > RIGID * frequency.max(axis=1)[:, None])
    r_f = np.where(elastic, logs - state.logs, 0.0)
    of_frequencies, sigma_f = scaled(r_f, FREQUENCY, OF_MODEL, elastic)
    prior = loss(x / OFF, OF_PARAMETERS).sum(axis=-1)
    total = of_shapes + of_frequencies + prior + state.noise
    unit = np.where(state.unit == 0, state.theta(x), state.unit)[:, None]
    of_each = list(zip(state.rows, modes, pairs, strict=True))
    df = np.stack([each.dfrequency[i] for _, each, i in of_each]) * unit
    dchi = np.stack([first_axis(R, each.dphi[:, i]) for R, each, i in of_each])
    dr = beta[..., None] * dchi.swapaxes(1, 2) * unit[:, None]
    square = (weight * chi**2).sum(axis=-1, keepdims=True)
    along = ratio(np.einsum("brs,brsp->brp", weight * chi, dr), square)
    dr = used[..., None] * (dr - chi[..., None] * along[:, :, None]) / scale[..., None]
    of_f, of_s = sigma_f[:, None], sigma[:, None]
    r = np.concatenate([r_f / of_f, x / OFF, r_s.reshape(flat.shape) / of_s], axis=1)
    J = [elastic[..., None] * ratio(df, f[..., None]) / of_f[..., None]]
    J += [np.broadcast_to(np.eye(p) / OFF, (n, p, p)), dr.reshape(n, -1, p) / of_s[..., None]]
    nu = np.repeat([OF_MODEL, OF_PARAMETERS, OF_MODEL], [each.shape[1] for each in J])
    w, slopes = (nu + 1) / (nu + r**2), np.concatenate(J, axis=1)
    g = np.einsum("bmp,bm->bp", slopes, w * r)
    H = slopes.swapaxes(1, 2) @ (w[..., None] * slopes)
    dx = step(g, H, DAMPING)[..., None]
    ahead = total + ((g[..., None] + H @ dx / 2) * dx).sum(axis=(1, 2))
    return Points(x, total, ahead, pairs, mac, beta[..., 0], sigma, g, H)


def point(state: State, x: Floats, modes: Modes, pairs: Ints | None = None) -> Points:
    """Return one state beside modes, with the best or given pairs."""
    return points(stacked([state]), [x], [modes], None if pairs is None else pairs[None]).at(0)


def unlikeness(states: Sequence[State], modes: Modes) -> Floats:
    """Return how unlike a model the modes of all data sets are in each of several states.

    Each is compared with the model mode that is nearest to it by c, whatever it was before.
    """
    state = stacked(states)
    mac = mac_values(state.psi, state.seen, state.rows[:, None] @ modes.phi)
    cost = pair_costs(mac, np.log(state.frequency), log_frequencies(modes.frequency))
    return np.asarray(cost.min(axis=-1).sum(axis=(-2, -1)))


class Fits:
    """Costs and fits of explanations of a comparison, of which ``plain`` is without mistakes.

    A model with matrices is solved at all degrees of freedom, a large one in the space of its modes
    at some parameters.
    """

    def __init__(self, comparison: Comparison) -> None:
        self.comparison, problem, data = comparison, comparison.problem, comparison.data
        matrices = comparison.matrices
        count = min(problem.model.size, comparison.frequency.size)
        model: Model = problem.model
        geometry, rows = None, np.eye(len(data.sensors))
        basis = rows
        if matrices is not None:
            model, basis = in_space_of_modes(matrices, count, problem)
            geometry, rows = matrices.geometry, matrices.selection @ basis
            if geometry is None or len(geometry.axes) == 1:
                geometry = chain_geometry(matrices.size, matrices.selection)
        std = ratio(data.frequency_std, data.frequency)
        start, ends = problem.start, np.stack([problem.lower, problem.upper])
        positive, size = ends[0] > 0, np.where(start == 0, ends[1] - ends[0], np.abs(start))
        logs = np.log(np.where(positive, ends / size, 1.0)) + np.log([[1 / WIDER], [WIDER]])
        self.ends = np.where(positive, logs, (ends - start) / size)
        self.plain = State(
            frequency=data.frequency,
            damping=data.damping,
            shape=data.shape,
            std=np.where(std > 0, std, np.nan),
            left_out=np.zeros(()),
            candidates=np.array(comparison.candidates),
            rows=rows,
            start=start,
            unit=np.where(positive, 0.0, size),
            basis=basis,
            geometry=geometry,
        )
        self.together = max(1, NUMBERS // (data.shape.size * (1 + len(start))))

        @lru_cache(max(64, KEPT // (basis.shape[1] * count * (1 + len(start)))))
        def solved(theta: bytes) -> Modes | None:
            """Return the modes at parameters; None where there are none."""
            with suppress(ModelError):
                modes = model.modes(np.frombuffer(theta), count)
                known = np.isfinite(modes.dlam).all() and np.isfinite(modes.dphi).all()
                return modes if known else None
            return None

        self.modes = solved

    def at(self, states: Sequence[State], xs: Sequence[Floats]) -> list[Points | None]:
        """Return states at parameters x of each; None where the model has no modes."""
        out: list[Points | None] = [None] * len(states)
        tried = (self.modes(each.theta(x).tobytes()) for each, x in zip(states, xs, strict=True))
        known = [(k, modes) for k, modes in enumerate(tried) if modes]
        for first in range(0, len(known), self.together):
            some, modes = zip(*known[first : first + self.together], strict=True)
            many = points(stacked([states[k] for k in some]), [xs[k] for k in some], modes)
            for i, k in enumerate(some):
                out[k] = many.at(i)
        return out

    def ahead(self, states: Sequence[State], xs: Sequence[Floats]) -> Floats:
        """Return the costs of states a step from x of each; infinite where no modes are."""
        return np.array([float(x.ahead) if x else np.inf for x in self.at(states, xs)])

    def fitted(self, states: Sequence[State], xs: Sequence[Floats]) -> list[Points | None]:
        """Return the points at the end of fits from parameters x; None where there are no modes."""
        here = self.at(states, xs)
        damping = {k: DAMPING for k, each in enumerate(here) if each}
        for _ in range(STEPS):
            before = [(k, each) for k, each in enumerate(here) if each and k in damping]
            ahead = [np.clip(x.x + step(x.g, x.H, damping[k]), *self.ends) for k, x in before]
            ends = self.at([states[k] for k, _ in before], ahead)
            for (k, old), new in zip(before, ends, strict=True):
                if new is None or new.cost > old.cost:
                    damping[k] = max(10 * damping[k], 0.1)
                    continue
                here[k] = new
                damping[k] /= 5
                if old.cost - new.cost < ENOUGH:
                    del damping[k]
        return here


def in_space_of_modes(
    matrices: MatrixModel, count: int, problem: UpdatingProblem
) -> tuple[MatrixModel, Floats]:
    """Return a model with all of its coordinates as sensors, and its basis V (N, n).

    A large one is reduced to modes at the nominal parameters and at others by chance.
    """
    V = np.eye(matrices.size)
    if matrices.size > max(LARGE, 4 * count):
        logs = np.random.default_rng(0).uniform(-OFF, OFF, (SAMPLES, len(problem.start)))
        shapes = []
        for factors in (1.0, *np.exp(2 * logs)):
            with suppress(ModelError):
                theta = np.clip(problem.start * factors, problem.lower, problem.upper)
                shapes.append(matrices.full_modes(theta, count).Phi)
        V, size, _ = np.linalg.svd(np.hstack(shapes), full_matrices=False)
        V = V[:, size > 1e-7 * size[0]]
    sparse, parts = matrices.sparse(), dict[str, Any]()
    for name in ("stiffness", "mass"):
        A = getattr(sparse, name)
        terms = A.project([V], V)
        parts[name] = DenseAffine((terms + terms.transpose(0, 2, 1)) / 2, A.coefficients)
    every = scipy.sparse.eye_array(V.shape[1], format="csr")
    return replace(matrices, selection=every, **parts), V
