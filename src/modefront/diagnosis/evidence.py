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

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from functools import cache, lru_cache
from itertools import islice
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from scipy.sparse import csr_array

from modefront._typing import Floats, Ints
from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.members import Part, parts_of, with_factors
from modefront.diagnosis.state import State, loss, ratio, scaled, stacked
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine, first_axis
from modefront.models.geometry import chain_geometry
from modefront.models.matrices import MatrixModel
from modefront.modes.result import Modes
from modefront.pairing.match import assigned
from modefront.residuals.problem import UpdatingProblem
from modefront.rounding import ACCUMULATED, TINY

RIGID = 1e-6  # frequency of a rigid body over the greatest, at most: rounding leaves 3e-7
KAPPA, FARTHEST = 0.4, 2.5  # kappa, and the logarithm d up to which frequencies differ; see above
OF_PARAMETERS, OF_MODEL = 8.0, 4.0  # nu of parameters, and of what no parameter describes
FREQUENCY, SHAPE = 0.03, 0.08  # scales that are expected of what no parameter describes
OFF = 0.4  # scale of the parameters: of their logarithms, or over their unit

WIDER = 4.0  # factor beyond positive bounds up to which fits go: no mistake stands for a bound
FACTOR = 2.0  # factor on a member, or its inverse, up to which fits go from where they begin
ALL = -1  # number that stands for all parts of the model, each with a factor

STEPS, LONGEST = 10, 0.7  # steps of a fit, and their longest component
ENOUGH, DAMPING = 0.05, 1e-3  # decrease of C that ends them, and share of H's diagonal in the first

LARGE, SAMPLES = 80, 4  # size of models that are reduced, and models of a basis beside the nominal
KEPT, NUMBERS = 2**25, 2**18  # numbers of models that are kept, and of arrays: bound the memory

Near: TypeAlias = tuple[State, Floats] | None  # another state, and x of its parameters


class Points(NamedTuple):
    """States at parameters, or one without the axis in front."""

    x: Floats  # of the parameters
    cost: Floats  # C without the price of the explanation
    ahead: Floats  # this cost after a step of a fit with residuals to first order
    pairs: Ints  # model mode of each measured one
    mac: Floats  # of these pairs; NaN without a shape
    beta: Floats  # (modes,) factors that make model shapes of the measured ones
    sigma: Floats  # scale of the residuals of shapes
    g: Floats  # g, H: gradient (p,) and Gauss-Newton matrix (p, p) of the cost in x
    H: Floats

    def of(self, k: Any) -> "Points":
        """Return one of several states, or some."""
        return Points(*(each[k] for each in self))

    def update(self, k: Ints, new: "Points") -> None:
        """Put others in the places k."""
        for values, others in zip(self, new, strict=True):
            values[k] = others


def step(g: Floats, H: Floats, damping: Any) -> Floats:
    """Return the step of a fit (..., p): that of Gauss and Newton with more of H's diagonal."""
    diagonal = np.einsum("...ii->...i", H)[..., None] + ACCUMULATED
    H = H + np.asarray(damping)[..., None, None] * diagonal * np.eye(g.shape[-1])
    return np.clip(np.linalg.solve(H, -g[..., None])[..., 0], -LONGEST, LONGEST)


def mac_values(psi: Floats, known: Any, phi: Floats) -> Floats:
    """Return the MAC (..., modes, model modes); NaN of shapes with fewer than two components."""
    psi = psi * known
    norm = (psi**2).sum(axis=-1, keepdims=True) * (known @ phi**2)
    values = ratio((psi @ phi) ** 2, norm)
    return np.where(known.sum(axis=-1, keepdims=True) < 2, np.nan, values)


def pair_costs(mac: Floats, logs: Floats, of_model: Floats) -> Floats:
    """Return c, (..., modes, model modes), of a MAC and logarithms of frequencies; see above."""
    distance = np.abs(of_model[..., None, :] - logs[..., None])
    return np.nan_to_num(1 - mac) + KAPPA * np.nan_to_num(np.minimum(distance, FARTHEST))


def alike(mac: float) -> str:
    """Return how alike the shapes of a pair are, in words."""
    return "" if np.isnan(mac) else f" (MAC {mac:.2f})"


def log_frequencies(frequency: Floats) -> Floats:
    """Return logarithms of a model's frequencies; those of rigid-body modes are far below all."""
    least = RIGID * frequency.max(axis=-1, keepdims=True, initial=0.0)
    return np.log(np.maximum(frequency, np.maximum(least, TINY)))


class Fits:
    """Costs and fits of explanations of a comparison, of which ``plain`` is without mistakes.

    A model is solved at all degrees of freedom, a large one in the space of some of its modes.
    """

    def __init__(self, comparison: Comparison) -> None:
        self.comparison, problem, data = comparison, comparison.problem, comparison.data
        matrices, sensors = comparison.matrices, len(data.sensors)
        count = min(problem.model.size, comparison.frequency.size)
        model: Any = problem.model
        # Of a model without matrices, nothing is known but how it moves its sensors.
        self.given, self.parts = np.eye(sensors), list[Part]()
        self.geometry = chain_geometry(sensors, csr_array(self.given))
        self.moves = np.zeros((sensors + 2, 3, sensors))
        if matrices is not None:
            if matrices.geometry is None or len(matrices.geometry.axes) == 1:
                self.geometry = chain_geometry(matrices.size, matrices.selection)
            else:
                self.geometry = matrices.geometry
            model, basis = in_space_of_modes(matrices, count, problem)
            self.parts, self.given = parts_of(matrices, basis), matrices.selection @ basis
            moves = (self.geometry.motion @ basis).reshape(-1, 3, basis.shape[1])
            self.moves = np.concatenate([moves, 0 * moves[:1]])
        start, ends = problem.start, np.stack([problem.lower, problem.upper])
        positive, size = ends[0] > 0, np.where(start == 0, ends[1] - ends[0], np.abs(start))
        logs = np.log(np.where(positive, ends / size, 1.0)) + np.log([[1 / WIDER], [WIDER]])
        self.ends, self.unit = np.where(positive, logs, (ends - start) / size), size * ~positive
        if self.parts:
            start = np.append(start, 1.0)
            self.ends = np.column_stack([self.ends, np.log([1 / FACTOR, FACTOR])])
        std = ratio(data.frequency_std, data.frequency)
        measured = data.frequency, data.damping, data.shape, np.where(std > 0, std, np.nan)
        sensors_at = self.geometry.sensor_nodes, self.geometry.sensor_directions
        candidates = np.array(comparison.candidates)
        self.plain = State(*measured, np.zeros(()), candidates, *sensors_at, np.array(0), start)
        self.together = max(1, NUMBERS // (data.shape.size * (1 + len(start))))

        @cache
        def scaled(part: int) -> Any:
            """Return the model with the factor on a part, or on each with ALL."""
            some = self.parts if part == ALL else self.parts[part - 1 : part] if part else ()
            return with_factors(model, some) if self.parts else model

        @lru_cache(max(64, KEPT // (self.given.shape[1] * count * (1 + len(start)))))
        def solved(part: int, theta: bytes, derivatives: bool) -> Modes | None:
            with suppress(ModelError):
                modes = scaled(part).modes(np.frombuffer(theta), count, derivatives=derivatives)
                slopes = (modes.dlam, modes.dphi) if derivatives else ()
                return modes if all(np.isfinite(x).all() for x in slopes) else None
            return None

        self._solved = solved
        self.nominal = self.of(self.plain, 0 * start)

    def of(self, state: State, x: Floats) -> Modes | None:
        """Return the modes of a state, at all coordinates, at parameters x; None where none."""
        return self._solved(int(state.part), self.theta(state, x).tobytes(), True)

    def units(self, count: int) -> Floats:
        """Return units of what is added to parameters; 0 where factors change them, as of parts."""
        return np.pad(self.unit, (0, count - self.unit.size))

    def theta(self, state: State, x: Floats) -> Floats:
        """Return parameters with logarithms x of the factors, or x units more, than nominal."""
        unit = self.units(x.shape[-1])
        return np.asarray(state.start * np.exp(np.where(unit == 0, x, 0.0)) + unit * x)

    def x(self, state: State, theta: Floats) -> Floats:
        """Return x of parameters."""
        unit = self.units(theta.size)
        factors = np.where(unit == 0, ratio(theta, state.start), 1.0)
        return np.log(factors) + ratio(theta - state.start, unit)

    def rows(self, state: State) -> Floats:
        """Return weights (..., sensors, n) of the coordinates of the model's modes at sensors."""
        rows = np.tile(self.given, (*state.nodes.shape[:-1], 1, 1))
        turned = (state.along != self.geometry.sensor_directions).any(axis=-1)
        moved = (state.nodes != self.geometry.sensor_nodes) | turned
        rows[moved] = np.einsum("si,sin->sn", state.along[moved], self.moves[state.nodes[moved]])
        return rows

    def by_parts(self, state: State, x: Floats) -> tuple[Floats, Floats]:
        """Return the cost ahead with a factor on each part, and its log's step, by one model."""
        p, q = x.size - 1, len(self.parts)
        wide = replace(state, start=np.append(state.start[:p], np.ones(q)), part=np.array(ALL))
        end = self.at(stacked([wide]), np.append(x[:p], np.zeros(q))[None]).of(0)
        own = np.column_stack([np.tile(np.arange(p), (q, 1)), p + np.arange(q)])
        g, H = end.g[own], end.H[own[:, :, None], own[:, None]]
        dx = step(g, H, DAMPING)
        ahead = end.cost + (g * dx + (H @ dx[..., None])[..., 0] * dx / 2).sum(axis=1)
        return ahead, dx[:, -1]

    def batches(self, states: Iterable[State]) -> Iterator[State]:
        """Yield states as one, so many together as fit into the memory."""
        left = iter(states)
        while some := list(islice(left, self.together)):
            yield stacked(some)

    def unlike(self, states: Iterable[State], x: Floats, start: Floats) -> Floats:
        """Return how far by c all modes of all sets are from the nearest of a model, by states.

        The model is at parameters x beside nominal values ``start``, else at those of the state.
        """
        out = []
        for state in self.batches(states):
            there = x * (state.start == start).all(axis=1, keepdims=True)
            _, exists, frequency, _, phi = self._modes(state, there, derivatives=False)
            mac, logs = mac_values(state.psi, state.seen, phi[:, None]), log_frequencies(frequency)
            cost = pair_costs(mac, np.log(state.frequency), logs[:, None]).min(axis=-1)
            out.append(np.where(exists, cost.sum(axis=(-2, -1)), np.inf))
        return np.concatenate(out)

    def _modes(self, state: State, x: Floats, *, derivatives: bool) -> tuple[Any, ...]:
        """Return modes of states, whether there are any, their frequencies, sensors' rows, shapes.

        Those of the nominal model stand where there are none.
        """
        thetas = zip(state.part.tolist(), self.theta(state, x), strict=True)
        found = [self._solved(part, theta.tobytes(), derivatives) for part, theta in thetas]
        modes: Any = [each or self.nominal for each in found]
        frequency, rows = np.stack([each.frequency for each in modes]), self.rows(state)
        phi = rows @ np.stack([each.phi for each in modes])
        return modes, np.array([bool(each) for each in found]), frequency, rows, phi

    # More than 60 lines: the cost and its slopes share all residuals.
    def at(self, state: State, x: Floats, pairs: Any = None) -> Points:
        """Return states at parameters x, with best or given pairs; no modes cost infinity."""
        modes, exists, frequency, rows, phi = self._modes(state, x, derivatives=True)
        logs, n = log_frequencies(frequency), len(x)
        known, c, scale = state.known, state.mean, state.motion[:, None]
        mac = mac_values(c, known, phi)
        if pairs is None:
            some = zip(pair_costs(mac, state.logs, logs), state.candidates.tolist(), strict=True)
            pairs = np.array([assigned(each[:, :count]) for each, count in some])
        row, mode = np.arange(n)[:, None], np.arange(pairs.shape[1])
        f, logs, mac = frequency[row, pairs], logs[row, pairs], mac[row, mode, pairs]
        used = known & (known.sum(axis=-1, keepdims=True) > 1)
        chi, weight = used * phi.swapaxes(1, 2)[row, pairs], used / scale**2
        flat, sigma = used.reshape(n, -1), np.full(n, SHAPE)
        for _ in range(3):
            square = (weight * chi**2).sum(axis=-1, keepdims=True)
            beta = ratio((weight * chi * c).sum(axis=-1, keepdims=True), square)
            r_s = used * (beta * chi - c) / scale
            of_shapes, sigma = scaled(r_s.reshape(flat.shape), SHAPE, OF_MODEL, flat, sigma)
            weight = used / (1 + (r_s / sigma[:, None, None]) ** 2 / OF_MODEL) / scale**2
        elastic = np.isfinite(state.logs) & (f > RIGID * frequency.max(axis=1)[:, None])
        r_f = np.where(elastic, logs - state.logs, 0.0)
        of_frequencies, sigma_f = scaled(r_f, FREQUENCY, OF_MODEL, elastic)
        prior = loss(x / OFF, OF_PARAMETERS).sum(axis=-1)
        total = np.where(exists, of_shapes + of_frequencies + prior + state.noise, np.inf)
        # The slopes of all residuals, each times the root of its weight.
        of_each = list(zip(modes, pairs, rows, strict=True))
        D = np.stack([first_axis(R, m.dphi[:, i]) for m, i, R in of_each]).swapaxes(1, 2)
        square = (weight * chi**2).sum(axis=-1)[..., None, None]
        D = D - chi[..., None] * ratio((weight * chi)[:, :, None] @ D, square)
        r_s /= sigma[:, None, None]
        r_f, of_f = r_f / sigma_f[:, None], elastic / sigma_f[:, None]
        root_s, root_f = (np.sqrt((OF_MODEL + 1) / (OF_MODEL + r**2)) for r in (r_s, r_f))
        D *= (used * root_s * beta / scale / sigma[:, None, None])[..., None]
        df = np.stack([m.dfrequency[i] for m, i, _ in of_each])
        df = ratio(df, f[..., None]) * (of_f * root_f)[..., None]
        J = np.concatenate([D.reshape(n, -1, x.shape[1]), df], axis=1)
        r = np.concatenate([(root_s * r_s).reshape(flat.shape), root_f * r_f], axis=1)
        unit = self.units(x.shape[1])
        unit = np.where(unit == 0, self.theta(state, x), unit)
        of_prior = (OF_PARAMETERS + 1) / (OF_PARAMETERS + (x / OFF) ** 2) / OFF**2
        g = unit * (r[:, None] @ J)[:, 0] + of_prior * x
        H = unit[:, :, None] * (J.swapaxes(1, 2) @ J) * unit[:, None]
        H += of_prior[..., None] * np.eye(x.shape[1])
        dx = step(g, H, DAMPING)[..., None]
        ahead = total + ((g[..., None] + H @ dx / 2) * dx).sum(axis=(1, 2))
        return Points(x, total, ahead, pairs, mac, beta[..., 0], sigma, g, H)

    def begun(self, states: Iterable[State], near: Near = None) -> Iterator[tuple[State, Points]]:
        """Yield states after states, from nominal or another state's parameters, the better."""
        for state in self.batches(states):
            best = self.at(state, 0 * state.start)
            if near:
                other, x = near
                new = self.at(state, np.clip(self.x(state, self.theta(other, x)), *self.ends))
                better = np.flatnonzero(new.ahead < best.ahead)
                best.update(better, new.of(better))
            yield state, best

    def ahead(self, states: Iterable[State], near: Near) -> Floats:
        """Return the costs of states after a first step of their fits."""
        return np.concatenate([best.ahead for _, best in self.begun(states, near)])

    def fitted(self, states: Iterable[State], near: Near = None) -> list[Points]:
        """Return the points at the end of fits, each from the better one of its starts."""
        out: list[Points] = []
        for state, here in self.begun(states, near):
            damping = np.where(np.isfinite(here.cost), DAMPING, np.nan)
            for _ in range(STEPS):
                k = np.flatnonzero(np.isfinite(damping))
                if not k.size:
                    break
                x = here.x[k] + step(here.g[k], here.H[k], damping[k])
                new = self.at(state.of(k), np.clip(x, *self.ends))
                gain, better = here.cost[k] - new.cost, new.cost <= here.cost[k]
                here.update(k[better], new.of(better))
                damping[k] = np.where(better, damping[k] / 5, np.maximum(10 * damping[k], 0.1))
                damping[k[better & (gain < ENOUGH)]] = np.nan
            out += [here.of(i) for i in range(len(here.cost))]
        return out


def in_space_of_modes(
    matrices: MatrixModel, count: int, problem: UpdatingProblem
) -> tuple[MatrixModel, Floats]:
    """Return a model with its coordinates as sensors, and its basis V (N, n).

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
    return replace(matrices, selection=csr_array(np.eye(V.shape[1])), **parts), V
