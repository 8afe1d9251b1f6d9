r"""An independent optimiser of updating problems, to measure modefront's results against.

Nothing of modefront's modes, pairs, residuals or solvers is used, but for the typical sizes of the
objectives, which are part of the question. Equation (1) of Christodoulou
et al. (2008, doi:10.1016/j.cma.2008.04.010) is evaluated from dense matrices with LAPACK's
complete spectrum, and derivatives are sums over all modes,

.. math::
    \lambda_q' = \varphi_q^T G \varphi_q, \quad
    \varphi_q' = \sum_{m \ne q} \frac{\varphi_m^T G \varphi_q}{\lambda_q - \lambda_m} \varphi_m
    - \tfrac12 (\varphi_q^T M' \varphi_q) \varphi_q, \quad G = K' - \lambda_q M' .

Sums of squares are minimised by damped Gauss-Newton steps within the bounds (SciPy's
``lsq_linear``, active sets), everything else by SciPy's SLSQP in :math:`z`, the parameters over
their ranges:

==============  ==================================================================================
least           min J_i, from many starts
edge            min sum of the other J_j / c_j subject to r_i = r_i*, where r_i* is the residual at
                a minimum of J_i: only as many combinations of its rows as are independent there
weighted        min sum w_j J_j, each from the one before it and from the starts
logarithmic     min sum a_j ln J_j from the weighted models, by weighted sums with w = a / J
bounded         min J_k subject to J_j <= given values
==============  ==================================================================================

No solution is trusted for what its solver says: every model is evaluated, and what counts is J.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.linalg
from scipy.optimize import linear_sum_assignment, lsq_linear, minimize
from updating_problems import Case

from modefront._typing import Bools, Floats, Ints
from modefront.pairing.match import FEWEST
from modefront.residuals.groups import ModeNumbers
from modefront.work.task import seed_sequence

SEED = 1
"""Seed of the runs of modefront."""

SAMPLE = 16
"""Random parameters that the typical sizes of the objectives are medians of."""

EXACT = 1e-10
"""An objective below this share of its typical size is fitted exactly."""

TIE = 1e-8
"""Share by which an objective may exceed another one and still be as small.

Along a valley the others fall with the root of what the first one gives: 1e-6 of it may be worth
half a percent of them.
"""

STRICT = 1e-12
"""The share where a tie is not enough."""

DOUBTFUL = 1e-3
"""Gain from which on it is checked that it needs no tie."""

MARGINS, BACK = (1e-9, 1e-8), 6
"""Shares by which limits are lowered, since an optimiser exceeds them by its own tolerance; steps
at most that bring a model back to them."""

ROUNDING = 1e-14
"""The same of exact fits, over the typical size of the objective."""

RANKS = (1e-3, 1e-5, 1e-7)
"""Singular values, over the greatest, above which rows of residuals are held; each is tried."""

EPSILON = 10.0 ** -np.arange(1, 11)
"""Shares of the other objectives that lead to an edge, each from the one before it."""

STEP, BENT = 1e-4, 1e-9
"""Step of differences over the range of a parameter; curvature over the greatest one, up to which
it is their error."""

UNSEEN = 1e-6
"""Motion of the sensors in a mode, over that in others, below which it is rounding."""

SWEEP = 10.0 ** np.linspace(-4, 4, 9)
"""Ratios of two weights."""


@dataclass(frozen=True)
class Part:
    """The residual (rows,) of a group, with its derivatives (rows, parameters)."""

    r: Floats
    dr: Floats


@dataclass(frozen=True)
class Known:
    """A model that was found: its parameters, its objectives, and by what it was found."""

    theta: Floats
    J: Floats
    label: str


@dataclass
class Equation:
    """Equation (1) of a case, evaluated independently; counts its evaluations."""

    case: Case
    evaluations: int = 0
    _last: tuple[bytes, list[Part] | None] = field(default=(b"", None))

    @cached_property
    def lower(self) -> Floats:
        """Lower bounds (parameters,)."""
        return self.case.problem.lower

    @cached_property
    def span(self) -> Floats:
        """Ranges of the parameters."""
        return self.case.problem.upper - self.case.problem.lower

    @cached_property
    def a(self) -> Floats:
        """Counts of measured properties of each group, means over the data sets."""
        measured = np.isfinite(self.case.problem.data.shape)
        sets = measured.any(axis=2).sum(axis=0)
        components = measured.sum(axis=(0, 2)) / np.maximum(sets, 1)
        return np.array([float(len(f) + components[s].sum()) for f, s in self._groups])

    @cached_property
    def sizes(self) -> Floats:
        """Typical sizes of the objectives: medians over random parameters.

        The parameters are those of modefront: of three groups, the sum of two over these sizes
        says what the best in the others is.
        """
        rng = np.random.default_rng(seed_sequence(SEED, "sample"))
        thetas = self.lower + self.span * rng.uniform(size=(SAMPLE, self.span.size))
        J = np.array([self.J(theta) for theta in thetas])
        return np.maximum(np.median(J[np.isfinite(J).all(axis=1)], axis=0), np.finfo(float).tiny)

    @cached_property
    def _groups(self) -> list[tuple[list[int], list[int]]]:
        modes = range(1, len(self.case.problem.data.modes) + 1)

        def positions(chosen: ModeNumbers) -> list[int]:
            return [m - 1 for m in (modes if chosen == "all" else chosen)]

        return [
            (positions(x.modes_of("frequency")), positions(x.modes_of("shape")))
            for x in self.case.problem.groups
        ]

    def J(self, theta: Floats) -> Floats:
        """Return the objectives, infinite where the stiffness matrix is not positive definite."""
        parts = self.parts(theta)
        if parts is None:
            return np.full(len(self.case.problem.groups), np.inf)
        return np.array([part.r @ part.r for part in parts])

    def parts(self, theta: Floats) -> list[Part] | None:
        """Return the residuals of each group; None where stiffness is not positive definite."""
        key = theta.tobytes()
        if self._last[0] != key:
            self._last = key, self._evaluate(theta)
        return self._last[1]

    def pairs(self, theta: Floats) -> tuple[int, ...]:
        """Return the model mode of each measured one, from 0."""
        return tuple(self._modes(theta)[2].tolist())

    def _modes(self, theta: Floats) -> tuple[Floats, Floats, Ints]:
        """Return all eigenvalues and modes, and which of them belong to the measured ones."""
        case, data = self.case, self.case.problem.data
        lam, Phi = scipy.linalg.eigh(case.stiffness.at(theta), case.mass.at(theta))
        m, pairing = data.frequency.shape[1], case.problem.pairing
        if pairing.method == "order":
            return lam, Phi, np.arange(m)
        few = min(lam.size, m + (FEWEST if pairing.spare is None else pairing.spare))
        f = np.sqrt(np.maximum(lam[:few], 1e-300)) / (2 * np.pi)
        ratio = f / np.nanmean(data.frequency, axis=0)[:, None]
        outside = np.abs(np.log(ratio)) > np.log(pairing.window or np.inf)
        return lam, Phi, _pairs(data.shape, case.sensors @ Phi[:, :few], outside)

    def _evaluate(self, theta: Floats) -> list[Part] | None:
        self.evaluations += 1
        case, data = self.case, self.case.problem.data
        lam, Phi, index = self._modes(theta)
        if lam[case.rigid] <= 0:
            return None
        f = np.sqrt(np.maximum(lam, 0.0)) / (2 * np.pi)
        slopes = case.stiffness.slopes(theta), case.mass.slopes(theta)
        frequency, shape = [], []
        for r, q in enumerate(index):
            dlam, dphi = _derivatives(*slopes, lam, Phi, int(q))
            df = dlam / (8 * np.pi**2 * f[q]) if q >= case.rigid else np.zeros(dlam.size)
            measured = data.frequency[np.isfinite(data.frequency[:, r]), r]
            root = np.sqrt(measured.size)
            part = Part((f[q] / measured - 1) / root, df / measured[:, None] / root)
            frequency.append(part)
            shape.append(_shapes(data.shape[:, r], case.sensors @ Phi[:, q], case.sensors @ dphi))
        out = []
        for frequencies, shapes in self._groups:
            chosen = [frequency[k] for k in frequencies] + [shape[k] for k in shapes]
            out.append(
                Part(np.concatenate([x.r for x in chosen]), np.concatenate([x.dr for x in chosen]))
            )
        return out


def _pairs(measured: Floats, phi: Floats, outside: Bools) -> Ints:
    """Return the model mode of each measured one (sets, modes, sensors), by mean MAC.

    Those ``outside`` the window of frequencies (measured modes, modes) are the last choice.
    """
    size = np.abs(phi).max(axis=0)
    phi = np.where(size > UNSEEN * size.max(), phi, 0.0)
    known = np.isfinite(measured)
    psi = np.where(known, measured, 0.0)
    norm = (psi**2).sum(axis=2)[:, :, None] * (known @ phi**2)
    mac = ((psi @ phi) ** 2 / np.maximum(norm, np.finfo(float).tiny)).sum(axis=0)
    mac = mac / known.any(axis=2).sum(axis=0)[:, None] - 1e3 * outside
    best: Ints = np.argmax(mac, axis=1)
    if np.unique(best).size == best.size:
        return best
    assigned: Ints = linear_sum_assignment(-mac)[1]
    return assigned


def _derivatives(dK: Floats, dM: Floats, lam: Floats, Phi: Floats, q: int) -> tuple[Floats, Floats]:
    """Return dlam (parameters,) and dphi (N, parameters) of a mode."""
    phi = Phi[:, q]
    K, M = dK @ phi, dM @ phi  # (parameters, N)
    G = Phi.T @ (K - lam[q] * M).T  # (modes, parameters)
    apart = lam[q] - lam
    apart[q] = 1.0
    coefficient = G / apart[:, None]
    coefficient[q] = -0.5 * (M @ phi)
    return G[q], Phi @ coefficient


def _shapes(psi: Floats, phi: Floats, dphi: Floats) -> Part:
    """Return the residual of a shape (sets, sensors) in all data sets that have it."""
    known = np.isfinite(psi)
    sets = np.flatnonzero(known.any(axis=1))
    parts = [_shape(psi[k, known[k]], phi[known[k]], dphi[known[k]]) for k in sets]
    r, dr = (np.concatenate(x) for x in zip(*((x.r, x.dr) for x in parts), strict=True))
    return Part(r / np.sqrt(sets.size), dr / np.sqrt(sets.size))


def _shape(psi: Floats, phi: Floats, dphi: Floats) -> Part:
    """Return the residual of a shape over the root mean square of the measured one."""
    norm = phi @ phi
    beta = psi @ phi / norm
    dbeta = (psi @ dphi - 2 * beta * (phi @ dphi)) / norm
    unit = np.sqrt(psi @ psi / psi.size)
    return Part((beta * phi - psi) / unit, (np.outer(phi, dbeta) + beta * dphi) / unit)


def agreement(equation: Equation, rng: np.random.Generator, points: int = 3) -> float:
    """Return the greatest difference of J from that of modefront over the typical sizes.

    Derivatives are compared by their relative error.
    """
    worst = 0.0
    for _ in range(points):
        theta = equation.lower + equation.span * rng.uniform(0.2, 0.8, equation.span.size)
        parts, other = equation.parts(theta), equation.case.problem.evaluate(theta)
        if parts is None or not other.feasible:
            continue
        J = np.array([part.r @ part.r for part in parts])
        dJ = np.array([2 * part.r @ part.dr for part in parts])
        worst = max(worst, float((np.abs(J - other.J) / equation.sizes).max()))
        error = np.abs(dJ - other.dJ).max(axis=1) / np.abs(dJ).max(axis=1)
        worst = max(worst, 1e-3 * float(error.max()))
    return worst


def worth(equation: Equation, i: int, theta: Floats, more: float) -> float:
    r"""Return by how much the others fall, at a minimum of J_i, if J_i may be greater by ``more``.

    The others are summed over their typical sizes, with gradient g. With the second derivatives H
    of J_i, :math:`\tfrac12 s^T H s \le` ``more`` holds a step s, and :math:`g^T s` is
    :math:`\sqrt{2\, \text{more}\; g^T H^{-1} g}` at most. Along directions in which J_i does not
    change, a minimum has to be best in the others: these count for nothing.
    """
    z = (theta - equation.lower) / equation.span
    free = np.flatnonzero((z > STEP) & (z < 1 - STEP))
    parts = equation.parts(theta)
    if more <= 0 or parts is None or not free.size:
        return 0.0
    others = np.where(np.arange(equation.sizes.size) != i, 1 / equation.sizes, 0.0)
    g = _sum(others)(parts)[1] * equation.span
    dr = (parts[i].dr * equation.span)[:, free]
    bend = []  # of the residuals; what their first derivatives give is exact
    for unit in np.diag(equation.span)[free]:
        ahead, behind = (equation.parts(theta + step * unit) for step in (STEP, -STEP))
        if ahead is None or behind is None:
            return 0.0
        change = ((ahead[i].dr - behind[i].dr) * equation.span)[:, free]
        bend.append(parts[i].r @ change / (2 * STEP))
    S = np.array(bend)
    curvature, V = np.linalg.eigh(2 * dr.T @ dr + S + S.T)
    bent = curvature > BENT * curvature[-1]
    along = (V.T @ g[free])[bent]
    return float(np.sqrt(2 * more * np.sum(along**2 / curvature[bent])))


# ---- optimisers ------------------------------------------------------------------------------


def least_squares(
    equation: Equation, w: Floats, theta: Floats, iterations: int = 60, tolerance: float = 1e-9
) -> Floats:
    """Return a local minimum of sum w J: damped Gauss-Newton steps within the bounds."""
    root, span = np.sqrt(w), equation.span
    lower, upper = equation.lower, equation.lower + span

    def stacked(theta: Floats) -> tuple[Floats, Floats] | None:
        parts = equation.parts(theta)
        if parts is None:
            return None
        r = np.concatenate([s * part.r for s, part in zip(root, parts, strict=True) if s > 0])
        dr = np.concatenate([s * part.dr for s, part in zip(root, parts, strict=True) if s > 0])
        return r, dr * span

    theta = np.clip(theta, lower, upper)
    here = stacked(theta)
    if here is None:
        return theta
    mu, small = 1e-3, 0
    for _ in range(iterations):
        r, dr = here
        value = float(r @ r)
        scale = np.linalg.norm(dr, ord="fro") or 1.0
        z_lower, z_upper = (lower - theta) / span, (upper - theta) / span
        step = _bounded(
            np.vstack([dr, mu * scale * np.eye(span.size)]),
            np.append(-r, np.zeros(span.size)),
            z_lower,
            z_upper,
        )
        trial = np.clip(theta + step * span, lower, upper)
        other = stacked(trial)
        predicted = value - float(np.sum((r + dr @ step) ** 2))
        if other is None or other[0] @ other[0] >= value:
            mu = max(mu, 1e-9) * 6
            if mu > 10 or predicted <= 1e-15 * value:
                break
            continue
        ratio = (value - float(other[0] @ other[0])) / max(predicted, 1e-300)
        gain = value - float(other[0] @ other[0])
        theta, here = trial, other
        if ratio > 0.75:
            mu = mu / 8 if mu > 1e-10 else 0.0
        elif ratio < 0.25:
            mu = max(mu, 1e-9) * 3
        small = small + 1 if gain <= tolerance * value else 0
        if small >= 3 or value < 1e-28:
            break
    return theta


def _bounded(A: Floats, b: Floats, lower: Floats, upper: Floats) -> Floats:
    """Return the least squares of A x - b within bounds, by active sets where any are needed."""
    x: Floats = scipy.linalg.lstsq(A, b, check_finite=False, lapack_driver="gelsy")[0]
    if ((x >= lower) & (x <= upper)).all():
        return x
    held = np.minimum(lower, 0.0) - 1e-15, np.maximum(upper, 0.0) + 1e-15
    result: Floats = lsq_linear(A, b, bounds=held, method="bvls").x
    return result


def programme(
    equation: Equation,
    objective: Callable[[list[Part]], tuple[float, Floats]],
    constraints: Sequence[tuple[str, Callable[[list[Part]], tuple[Floats, Floats]]]],
    theta: Floats,
    iterations: int = 80,
) -> Floats:
    """Return where SLSQP ends from ``theta``; derivatives are with respect to theta."""
    lower, span = equation.lower, equation.span

    def parts_at(z: Floats) -> list[Part] | None:
        return equation.parts(lower + span * np.clip(z, 0.0, 1.0))

    def value(z: Floats) -> float:
        parts = parts_at(z)
        return 1e10 if parts is None else objective(parts)[0]

    def slope(z: Floats) -> Floats:
        parts = parts_at(z)
        return np.zeros(span.size) if parts is None else objective(parts)[1] * span

    def constraint(
        kind: str, function: Callable[[list[Part]], tuple[Floats, Floats]], rows: int
    ) -> dict[str, object]:
        def fun(z: Floats) -> Floats:
            parts = parts_at(z)
            return np.full(rows, -1e5) if parts is None else function(parts)[0]

        def jac(z: Floats) -> Floats:
            parts = parts_at(z)
            return np.zeros((rows, span.size)) if parts is None else function(parts)[1] * span

        return {"type": kind, "fun": fun, "jac": jac}

    z = np.clip((theta - lower) / span, 0.0, 1.0)
    first = parts_at(z)
    if first is None:
        return theta
    held = [constraint(kind, f, f(first)[0].size) for kind, f in constraints]
    result = minimize(
        value,
        z,
        jac=slope,
        bounds=[(0.0, 1.0)] * z.size,
        constraints=held,
        method="SLSQP",
        options={"maxiter": iterations, "ftol": 1e-12},
    )
    out: Floats = lower + span * np.clip(result.x, 0.0, 1.0)
    return theta if not np.isfinite(out).all() else out


def _sum(w: Floats) -> Callable[[list[Part]], tuple[float, Floats]]:
    """Return the function sum w J with its derivatives."""

    def function(parts: list[Part]) -> tuple[float, Floats]:
        value = sum(float(s * (x.r @ x.r)) for s, x in zip(w, parts, strict=True))
        slope = sum(
            (2 * s * (x.r @ x.dr) for s, x in zip(w, parts, strict=True)),
            np.zeros(parts[0].dr.shape[1]),
        )
        return value, slope

    return function


def equal_residuals(
    equation: Equation, i: int, theta: Floats, rank: float, c: Floats
) -> Floats | None:
    """Return the best model in the others of those with the same residuals of a group.

    None where the residuals leave no freedom.
    """
    parts = equation.parts(theta)
    if parts is None:
        return None
    U, s, _ = np.linalg.svd(parts[i].dr * equation.span, full_matrices=False)
    kept = s > rank * s[0] if s[0] > 0 else s > 0
    if int(kept.sum()) >= equation.span.size:
        return None
    rows, target = (U[:, kept] / s[kept]).T, parts[i].r.copy()

    def held(parts: list[Part]) -> tuple[Floats, Floats]:
        return rows @ (parts[i].r - target), rows @ parts[i].dr

    w = np.where(np.arange(c.size) != i, 1 / c, 0.0)
    J = np.array([x.r @ x.r for x in parts])
    w = w / max(float(w @ J), 1e-12)
    return programme(equation, _sum(w), [("eq", held)], theta)


def bounded(
    equation: Equation, k: int, limits: Floats, theta: Floats, iterations: int = 60
) -> Floats:
    """Return a minimum of J_k subject to J_j <= limits_j for all others."""
    n = limits.size
    others = [j for j in range(n) if j != k]
    w = np.eye(n)[k] / limits[k]

    def slack(parts: list[Part]) -> tuple[Floats, Floats]:
        J = np.array([parts[j].r @ parts[j].r for j in others])
        dJ = np.array([2 * parts[j].r @ parts[j].dr for j in others])
        return 1 - J / limits[others], -dJ / limits[others][:, None]

    return programme(equation, _sum(w), [("ineq", slack)], theta, iterations)


def logarithmic(equation: Equation, theta: Floats, turns: int = 100) -> tuple[Floats, bool]:
    r"""Return where sum a ln J has gone down to from a model, and whether it is a minimum.

    As the logarithm is concave, :math:`\sum a J / J_0` is above it and touches it at
    :math:`J_0`: whatever makes the former less makes the latter less, too.
    """
    a = equation.a / equation.a.sum()
    floor = EXACT * equation.sizes
    J, small = equation.J(theta), 0
    for _ in range(turns):
        if not np.isfinite(J).all() or (floor > J).any():
            return theta, False
        theta = least_squares(equation, a / J, theta, 8, 1e-13)
        after = equation.J(theta)
        gain = float(a @ np.log(J / np.maximum(after, 1e-300)))
        J, small = after, small + 1 if gain < 1e-8 else 0
        if small >= 3:
            return theta, bool((floor < J).all())
    return theta, False


# ---- all references of a problem -------------------------------------------------------------


@dataclass(frozen=True)
class Reference:
    """All models that were found, and the typical sizes (groups,) of the objectives."""

    known: list[Known]
    sizes: Floats
    a: Floats

    @property
    def J(self) -> Floats:
        """Objectives (models, groups)."""
        return np.array([known_point.J for known_point in self.known])

    @property
    def floor(self) -> Floats:
        """Values below which an objective is fitted exactly."""
        return EXACT * self.sizes

    def least(self, i: int) -> float:
        """Return the least value of an objective."""
        return float(self.J[:, i].min())

    def edge(self, i: int, value: float) -> tuple[float, Known]:
        """Return the least sum of the others where J_i is not above ``value``, and the model."""
        J = self.J
        tied = J[:, i] <= value * (1 + TIE) + ROUNDING * self.sizes[i]
        others = self.others(i, J)
        k = int(np.argmin(np.where(tied, others, np.inf)))
        return float(others[k]) if tied[k] else np.inf, self.known[k]

    def others(self, i: int, J: Floats) -> Floats:
        """Return the sum of the other objectives over their sizes."""
        keep = np.arange(self.sizes.size) != i
        total: Floats = (J / self.sizes)[..., keep].sum(axis=-1)
        return total

    def weighted(self, w: Floats) -> tuple[float, Known]:
        """Return the least weighted sum, and the model."""
        values = self.J @ w
        k = int(np.argmin(values))
        return float(values[k]), self.known[k]

    def regular(self) -> tuple[float, Known] | None:
        """Return the least sum a ln J of regular minima, and the model; None where there is none.

        A minimum is regular where no objective is fitted exactly; it is none where another model
        dominates it.
        """
        J = self.J
        best: tuple[float, Known] | None = None
        for known_point in self.known:
            if known_point.label != "logarithmic" or not (self.floor < known_point.J).all():
                continue
            if (dominance(J, known_point.J, self.floor) > 0.002).any():
                continue
            value = float(self.a @ np.log(known_point.J))
            if best is None or value < best[0]:
                best = value, known_point
        return best


def dominance(J: Floats, point: Floats, floor: Floats) -> Floats:
    """Return by which share rows of J are better than a point in one objective and worse in none.

    It is 0 for rows that are worse in any objective by more than rounding. Of two exact fits, below
    the floor, none is better.
    """
    worse = (point * (1 + TIE) + ROUNDING / EXACT * floor < J).any(axis=1)
    before = np.maximum(point, floor)
    gain = ((before - np.maximum(J, floor)) / before).max(axis=1)
    out: Floats = np.where(worse, 0.0, np.maximum(gain, 0.0))
    return out


def strict_gain(equation: Equation, point: Floats, model: Known, k: int, floor: Floats) -> float:
    """Return by which share a model shows that J_k of a point can fall while no other one grows.

    On a cliff, J_k falls by percents where the others grow by no more than a tie. A model that
    needs the tie is brought back by the shortest steps that make the others as small as at the
    point, and so is where the optimiser ends from there with lower limits. Where none of them can
    be brought back, the model counts as it is.
    """
    others = np.arange(point.size) != k
    limits = np.maximum(point, floor)
    starts = [model.theta, *(bounded(equation, k, limits * (1 - m), model.theta) for m in MARGINS)]
    gains = []
    for start in starts:
        J = equation.J(_brought_back(equation, start, limits, others))
        if (limits * (1 + STRICT) >= J)[others].all():
            gains.append(1 - max(J[k], floor[k]) / limits[k])
    if not gains:
        return float(1 - max(model.J[k], floor[k]) / limits[k])
    return float(max(0.0, *gains))


def _brought_back(equation: Equation, theta: Floats, limits: Floats, held: Bools) -> Floats:
    """Return parameters at which the objectives that are held do not exceed their limits."""
    for _ in range(BACK):
        parts = equation.parts(theta)
        if parts is None:
            break
        J = np.array([part.r @ part.r for part in parts])
        above = held & (limits < J)
        if not above.any():
            break
        dJ = np.array([2 * part.r @ part.dr for part in parts])[above] * equation.span
        scale = limits[above]
        missing = (limits[above] * (1 - STRICT / 2) - J[above]) / scale
        step = np.linalg.lstsq(dJ / scale[:, None], missing, rcond=None)[0]
        theta = theta + equation.span * step
        theta = equation.lower + equation.span * np.clip(
            (theta - equation.lower) / equation.span, 0.0, 1.0
        )
    return theta


@dataclass
class _Collection:
    """Models of an equation that were found so far."""

    equation: Equation
    known: list[Known] = field(default_factory=list)

    def add(self, theta: Floats | None, label: str) -> None:
        """Add a model, if it is one."""
        if theta is not None:
            J = self.equation.J(theta)
            if np.isfinite(J).all():
                self.known.append(Known(theta, J, label))

    def best(self, w: Floats, count: int) -> list[Floats]:
        """Return the best models in a weighted sum that are far from one another."""
        out: list[Floats] = []
        for known_point in sorted(self.known, key=lambda known_point: float(known_point.J @ w)):
            if all(np.abs((known_point.theta - x) / self.equation.span).max() > 1e-3 for x in out):
                out.append(known_point.theta)
            if len(out) == count:
                break
        return out


def reference(
    equation: Equation, starts: int = 4, seed: int = 0, given: Sequence[Floats] = ()
) -> Reference:
    """Return all that is found of a problem from the nominal model and from random starts.

    The models that are ``given`` are known from the beginning.
    """
    result = _started(equation, starts, seed)
    for theta in given:
        result.add(theta, "given")
    n, c = equation.sizes.size, equation.sizes
    weights, equal = _weights(n) / c, np.ones(n)
    result.add(least_squares(equation, equal, result.best(equal, 1)[0]), "weighted")
    for ordered in (weights, weights[::-1]):
        for w in ordered:
            result.add(least_squares(equation, w, result.best(w, 1)[0], 30), "weighted")
    for i in range(n):
        _edge(result, i, starts, seed)
    for w in [equal, 1 / c]:
        theta = result.best(w, 1)[0]
        scaled = w / max(float(w @ equation.J(theta)), 1e-12)
        result.add(programme(equation, _sum(scaled), [], theta), "weighted")
    shares = weights * c
    balanced = weights[shares.max(axis=1) / shares.min(axis=1) < 101]
    near = [
        int(np.argmin([known_point.J @ w for known_point in result.known]))
        for w in [equal, *balanced]
    ]
    for k in sorted(set(near))[:5]:
        theta, regular = logarithmic(equation, result.known[k].theta)
        result.add(theta, "logarithmic" if regular else "weighted")
    return Reference(result.known, c, equation.a)


def edge_reference(equation: Equation, i: int, starts: int = 4, seed: int = 0) -> Reference:
    """Return the reference of the edge of one group only."""
    result = _started(equation, starts, seed)
    _edge(result, i, starts, seed)
    return Reference(result.known, equation.sizes, equation.a)


def _started(equation: Equation, starts: int, seed: int) -> _Collection:
    """Return minima of the sum of J over their sizes, from many starts."""
    result = _Collection(equation)
    nominal = equation.case.problem.start
    for theta in [nominal, equation.case.true, *_random(equation, starts, seed)]:
        result.add(least_squares(equation, 1 / equation.sizes, theta), "weighted")
    return result


def _random(equation: Equation, starts: int, seed: int) -> list[Floats]:
    rng = np.random.default_rng(seed)
    return [equation.lower + equation.span * rng.random(equation.span.size) for _ in range(starts)]


def _edge(result: _Collection, i: int, starts: int, seed: int) -> None:
    """Add minima of J_i, and models at its edge: by epsilon, and at equal residuals."""
    equation, c = result.equation, result.equation.sizes
    unit = np.eye(c.size)[i] / c
    nearly = np.where(np.arange(c.size) == i, 1.0, 1e-6) / c
    nominal = equation.case.problem.start
    for theta in [nominal, *_random(equation, starts, seed)[:2], *result.best(unit, 2)]:
        result.add(least_squares(equation, unit, theta, 60, 1e-11), f"least-{i}")
    for theta in result.best(nearly, 2):
        for epsilon in EPSILON:
            w = np.where(np.arange(c.size) == i, 1.0, epsilon) / c
            theta = least_squares(equation, w, theta, 25, 1e-10)
            result.add(theta, f"edge-{i}")
        result.add(least_squares(equation, unit, theta, 20, 1e-12), f"edge-{i}")
    for theta in result.best(nearly, 2):
        for rank in RANKS:
            equal = equal_residuals(equation, i, theta, rank, c)
            result.add(equal, f"edge-{i}")
            if equal is not None:
                result.add(least_squares(equation, unit, equal, 20, 1e-12), f"edge-{i}")


def _weights(n: int) -> Floats:
    """Return weights (vectors, n) over many decades, in an order in which neighbours are close."""
    if n == 2:
        return np.column_stack([np.ones(SWEEP.size), SWEEP])
    out = [np.ones(n)]
    for i in range(n):
        for size in (1e-2, 1e2, 1e4):
            out.append(np.where(np.arange(n) == i, size, 1.0))
    return np.array(out)


def better(
    equation: Equation, point: Floats, theta: Floats, known: Iterable[Known], floor: Floats
) -> tuple[float, list[Known]]:
    """Return by which share the last J_k of a point can be made less while no other one grows.

    The starts are the point itself and the nearest ``known`` models; returns the models, too.
    """
    near = sorted(
        known,
        key=lambda known_point: float(
            np.abs(np.log((known_point.J + floor) / (point + floor))).max()
        ),
    )
    k = point.size - 1
    result: list[Known] = []
    for start in [theta, *(near.theta for near in near[:2])]:
        position = bounded(equation, k, np.maximum(point, floor), start)
        J = equation.J(position)
        if np.isfinite(J).all():
            result.append(Known(position, J, "bounded"))
    result.sort(key=lambda known_point: float(known_point.J[k]))
    J = np.array([known_point.J for known_point in [*result, *near]])
    held = (point * (1 + TIE) + ROUNDING / EXACT * floor >= J)[:, :k].all(axis=1)
    gain = np.where(held, (point[k] - J[:, k]) / max(point[k], floor[k]), 0.0)
    best = [*result, *near][int(gain.argmax())]
    share = float(max(0.0, gain.max()))
    if share > DOUBTFUL:
        share = strict_gain(equation, point, best, k, floor)
    return share, [best, *result]
