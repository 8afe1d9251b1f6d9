r"""Fronts of rugged problems beside NSGA-II and SMS-EMOA with the same number of evaluations.

python benchmarks/rugged.py [--seeds N] [--only NAME ...]

For every problem: the hypervolume of the true front, of modefront's points (the front, its edges
and weighted models), of all models that it found, and of the last populations of NSGA-II and
SMS-EMOA, which may evaluate as often as modefront did and have as many models as modefront's front
has points: 20 and 100. (The hypervolume of 23 models on the convex front is 1.029 at most, however
they are chosen, that of 100 is 1.040.) Also how many of the points that modefront calls Pareto
optimal and converged lie behind the true front by more than 1 % of its ranges. All hypervolumes are
in units of the ranges of the true front, up to 1.1 of each. A point lies behind by the greatest
amount by which one true point is better in all objectives. Needs the packages of the group
``benchmark``.

The true fronts are known: those of sums over the parameters are sums of fronts of one parameter
each, thinned to 1e-3 of the ranges; others have closed forms, or are evaluated on
grids and refined by random steps from what is best there.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import Any

import moocore
import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.algorithms.moo.sms import SMSEMOA
from pymoo.core.problem import ElementwiseProblem
from pymoo.optimize import minimize

from modefront._typing import Floats
from modefront.front.dominance import nondominated
from modefront.front.front import Front
from modefront.front.indicators import REFERENCE, hypervolume
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.front.point import Kind, of_kind
from modefront.optim.problem import Evaluation
from modefront.work.task import Costs, counted, spend

Derivatives = tuple[Floats, Floats, Floats]

BEHIND = 0.01
"""Distance behind the true front, over its ranges, from which a point counts as behind."""


@dataclass(frozen=True)
class Case:
    """A vector problem, whose evaluations are counted, with points (m, n) of its true front."""

    name: str
    function: Callable[[Floats], Derivatives]
    lower: Floats
    upper: Floats
    truth: Callable[[], Floats]
    n: int = 2

    @property
    def objectives(self) -> tuple[str, ...]:
        """Names of the objectives."""
        return tuple(f"J{i + 1}" for i in range(self.n))

    @property
    def start(self) -> Floats:
        """A first guess off the middle."""
        return self.lower + 0.37 * (self.upper - self.lower)

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        """Return the objectives, and their derivatives if wanted."""
        spend(Costs(eigenproblems=1))
        J, dJ, H = self.function(theta)
        return Evaluation(theta, J, dJ, H) if derivatives else Evaluation(theta, J)


# ---- problems ----------------------------------------------------------------------------------


def best_rows(rows: Floats, size: float) -> Floats:
    """Return the rows (m, k) whose last two columns are not dominated, one a cell of the ranges."""
    rows = rows[np.lexsort((rows[:, -1], rows[:, -2]))]
    least = np.minimum.accumulate(np.concatenate([[np.inf], rows[:-1, -1]]))
    rows = rows[rows[:, -1] < least]
    J = rows[:, -2:]
    cell = np.floor((J - J.min(axis=0)) / (size * np.maximum(np.ptp(J, axis=0), 1e-300)))
    return rows[np.concatenate([[True], (np.diff(cell, axis=0) != 0).any(axis=1)])]


def thinned(J: Floats, size: float = 1e-3) -> Floats:
    """Return the non-dominated rows of J (m, 2), one a cell of this size of the ranges."""
    return best_rows(J, size)


def sum_of_fronts(fronts: list[Floats]) -> Floats:
    """Return the front of a sum of objectives each of which has parameters of its own."""
    total = thinned(fronts[0])
    for values in fronts[1:]:
        part = thinned(values)
        total = thinned((total[:, None] + part[None]).reshape(-1, 2))
    return total


def rastrigin(p: int, amplitude: float = 1.0, waves: float = 4.0) -> Case:
    r"""Return residuals u and a sin(waves u) of p parameters, whose targets are two.

    :math:`J_i = \sum_j u_{ij}^2 + a \sin^2(\omega u_{ij})`, :math:`u_i = \theta - c_i`.
    """
    rng = np.random.default_rng(p)
    c = np.array([rng.uniform(-1.2, -0.4, p), rng.uniform(0.4, 1.2, p)])
    c = np.where(rng.uniform(size=p) < 0.5, c, c[::-1])

    def function(theta: Floats) -> Derivatives:
        u = theta - c
        s, k = np.sin(waves * u), np.cos(waves * u)
        J = (u**2 + amplitude * s**2).sum(axis=1)
        dJ = 2 * u + 2 * amplitude * waves * s * k
        H = np.zeros((2, p, p))
        H[:, np.arange(p), np.arange(p)] = 2 + 2 * amplitude * waves**2 * k**2
        return J, dJ, H

    def truth() -> Floats:
        x = np.linspace(-3, 3, 60_001)
        u = x - c[:, :, None]
        f = u**2 + amplitude * np.sin(waves * u) ** 2
        return sum_of_fronts([f[:, j].T for j in range(p)])

    return Case(
        f"Rastrigin {p} (a={amplitude:g})", function, np.full(p, -3.0), np.full(p, 3.0), truth
    )


def rotated(p: int, amplitude: float = 1.0, waves: float = 4.0) -> Case:
    """Return residuals as before of parameters that are turned: no coordinate stands alone."""
    base = rastrigin(p, amplitude, waves)
    Q = np.linalg.qr(np.random.default_rng(100 + p).normal(size=(p, p)))[0]

    def function(theta: Floats) -> Derivatives:
        J, dJ, H = base.function(Q @ theta)
        return J, dJ @ Q, Q.T @ H @ Q

    return Case(f"Rastrigin {p} turned", function, base.lower, base.upper, base.truth)


def rugged_zdt3(p: int, amplitude: float = 0.3, waves: float = 3 * np.pi) -> Case:
    """Return ZDT3 with waves in its distance from the front, which is in five pieces.

    The root of ZDT3's first objective is taken of 0.01 more, so that it has a derivative; the
    second objective is positive.
    """
    lower, upper = np.concatenate([[0.0], np.full(p - 1, -1.0)]), np.ones(p)

    def shape(x: Floats) -> Floats:
        return np.asarray(2.1 - np.sqrt(x + 0.01) - x * np.sin(10 * np.pi * x))

    def function(theta: Floats) -> Derivatives:
        x, z = theta[0], theta[1:] - 0.3 * np.sin(3 * theta[0])
        w = 10 * np.pi
        J = np.array([x, shape(x) + (z**2 + amplitude * np.sin(waves * z) ** 2).sum()])
        dz = 2 * z + amplitude * waves * np.sin(2 * waves * z)
        slope = -0.5 / np.sqrt(x + 0.01) - np.sin(w * x) - x * w * np.cos(w * x)
        dJ = np.zeros((2, p))
        dJ[0, 0], dJ[1, 0], dJ[1, 1:] = 1.0, slope - 0.9 * np.cos(3 * x) * dz.sum(), dz
        return J, dJ, np.zeros((2, p, p))

    def truth() -> Floats:
        x = np.linspace(0, 1, 200_001)
        return thinned(np.column_stack([x, shape(x)]))

    return Case(f"rugged ZDT3 {p}", function, lower, upper, truth)


def crossing() -> Case:
    """Return objectives that jump where modes cross, as modes are taken in their order.

    Two structures stand side by side: a chain of two masses and two springs t1, t2 along x, and
    another one of springs t3, t4 along y. Of the four modes, in the order of their frequencies,
    all are measured: :math:`J_1` sums squares of logarithms of frequency ratios, :math:`J_2`
    squares of differences of shapes in the four displacements, each mode of length one.
    """
    lower, upper = np.full(4, 0.4), np.full(4, 2.5)

    def chain(k1: Any, k2: Any) -> tuple[list[Any], list[Any]]:
        half = np.sqrt((k1 / 2) ** 2 + k2**2)
        lam = [k2 + k1 / 2 - half, k2 + k1 / 2 + half]
        angle = [np.arctan((k1 + k2 - value) / k2) for value in lam]
        return lam, [[np.cos(values), np.sin(values)] for values in angle]

    def modes(theta: Any) -> tuple[Any, Any]:
        """Return eigenvalues (..., 4) and shapes (..., 4, 4) of theta (..., 4), unsorted."""
        t1, t2, t3, t4 = np.moveaxis(theta, -1, 0)
        (lam_x, phi_x), (lam_y, phi_y) = chain(t1, t2), chain(1.1 * t3, 0.9 * t4)
        none = 0 * t1
        rows = [np.stack([*values, none, none], axis=-1) for values in phi_x]
        rows += [np.stack([none, none, *values], axis=-1) for values in phi_y]
        return np.stack([*lam_x, *lam_y], axis=-1), np.stack(rows, axis=-2)

    def order(theta: Floats) -> Any:
        return np.argsort(modes(theta)[0], axis=-1, kind="stable")

    def values(theta: Any, order: Any) -> Any:
        lam, phi = modes(theta)
        lam = np.take_along_axis(lam, order, axis=-1)
        phi = np.take_along_axis(phi, order[..., None], axis=-2)
        r1, r2 = np.log(lam / measured_lam), phi - measured_phi
        return np.stack([(r1**2).sum(axis=-1), (r2**2).sum(axis=(-1, -2))], axis=-1)

    true = np.array([1.0, 1.3, 1.25, 1.0])
    rng = np.random.default_rng(12)
    lam, phi = modes(true)
    sorted_as = order(true)
    measured_lam = lam[sorted_as] * np.exp(0.15 * rng.normal(size=4))
    measured_lam = np.sort(measured_lam)
    measured_phi = phi[sorted_as] + 0.2 * rng.normal(size=(4, 4))

    def function(theta: Floats) -> Derivatives:
        held, h = order(theta), 1e-30
        steps = values(theta + 1j * h * np.eye(4), np.tile(held, (4, 1)))
        return values(theta, held), steps.imag.T / h, np.zeros((2, 4, 4))

    def rows(theta: Floats) -> Floats:
        return np.hstack([theta, values(theta, order(theta))])

    def truth() -> Floats:
        grid = np.linspace(0.4, 2.5, 32)
        rest = np.stack(np.meshgrid(grid, grid, grid), axis=-1).reshape(-1, 3)
        result = np.empty((0, 4 + 2))
        for t1 in grid:
            theta = np.column_stack([np.full(len(rest), t1), rest])
            result = best_rows(np.vstack([result, rows(theta)]), 2e-3)
        rng = np.random.default_rng(0)
        for width in 0.07 * 0.7 ** np.arange(18):
            near = np.repeat(result[:, :4], 40, axis=0)
            theta = np.clip(near + width * rng.normal(size=near.shape), lower, upper)
            result = best_rows(np.vstack([result, rows(theta)]), 1e-3)
        return result[:, 4:]

    return Case("crossing modes", function, lower, upper, truth)


def jumps(p: int = 4) -> Case:
    """Return distances from two targets, with steps where pairs of 'frequencies' change order.

    In each of the cells between the crossings, the residuals are shifted by an amount of its own.
    """
    rng = np.random.default_rng(7)
    c = np.array([rng.uniform(-0.8, -0.3, p), rng.uniform(0.3, 0.8, p)])
    levels = rng.uniform(0, 0.35, size=(2, p, 5))

    def function(theta: Floats) -> Derivatives:
        cell = np.clip(((theta + 1.5) / 0.6).astype(int), 0, 4)
        u = theta - c
        shift = levels[:, np.arange(p), cell]
        J = (u**2 + shift).sum(axis=1)
        return J, 2 * u, np.array([2 * np.eye(p)] * 2)

    def truth() -> Floats:
        x = np.linspace(-1.5, 1.5, 30_001)
        cell = np.clip(((x + 1.5) / 0.6).astype(int), 0, 4)
        f = [((x - c[:, [j]]) ** 2 + levels[:, j, cell]).T for j in range(p)]
        return sum_of_fronts(f)

    return Case(f"jumps {p}", function, np.full(p, -1.5), np.full(p, 1.5), truth)


def ellipsoids(name: str, curvatures: Floats) -> Case:
    """Return squared distances from two targets with these curvatures: a convex front."""
    p = curvatures.size
    rng = np.random.default_rng(3)
    Q = np.linalg.qr(rng.normal(size=(p, p)))[0]
    c = np.array([np.full(p, -0.5), np.full(p, 0.5)]) @ Q

    def function(theta: Floats) -> Derivatives:
        u = theta - c
        A = Q.T @ (curvatures[:, None] * Q)
        return np.einsum("ij,jk,ik->i", u, A, u), 2 * u @ A, np.array([2 * A] * 2)

    def truth() -> Floats:
        t = np.linspace(0, 1, 2_001)
        size = curvatures.sum()
        return size * np.column_stack([t**2, (1 - t) ** 2])

    return Case(name, function, np.full(p, -2.0), np.full(p, 2.0), truth)


def concave(p: int = 3) -> Case:
    """Return Fonseca and Fleming's problem."""
    b = 1 / np.sqrt(p)

    def function(theta: Floats) -> Derivatives:
        d = theta - np.array([[b], [-b]])
        e = np.exp(-(d**2).sum(axis=1))
        outer = d[:, :, None] * d[:, None, :]
        return 1 - e, 2 * d * e[:, None], e[:, None, None] * (2 * np.eye(p) - 4 * outer)

    def truth() -> Floats:
        s = np.linspace(-b, b, 2_001)
        return 1 - np.exp(-p * (s[:, None] - np.array([b, -b])) ** 2)

    return Case("concave", function, np.full(p, -2.0), np.full(p, 2.0), truth)


def cases() -> list[Case]:
    """Return all problems of the table."""
    return [
        rastrigin(5),
        rastrigin(10),
        rotated(5),
        rugged_zdt3(5),
        crossing(),
        jumps(),
        ellipsoids("convex", np.ones(3)),
        concave(),
        ellipsoids("badly conditioned", np.logspace(0, 6, 5)),
        ellipsoids("50 parameters", np.linspace(1, 10, 50)),
    ]


# ---- comparison --------------------------------------------------------------------------------


class Described(ElementwiseProblem):
    """The same objectives for pymoo, without derivatives."""

    def __init__(self, case: Case) -> None:
        self.case = case
        super().__init__(n_var=case.lower.size, n_obj=case.n, xl=case.lower, xu=case.upper)

    def _evaluate(self, x: Floats, out: dict[str, Floats], *_: object, **__: object) -> None:
        out["F"] = self.case.function(x)[0]


def evolution(case: Case, method: Any, population: int, evaluations: int, seed: int) -> Floats:
    """Return the objectives of the last population."""
    algorithm = method(pop_size=population)
    result = minimize(Described(case), algorithm, ("n_eval", evaluations), seed=seed, verbose=False)
    return np.atleast_2d(result.F)


def behind(J: Floats, truth: Floats) -> Floats:
    """Return by how much one row of the truth is better in all objectives, at most, (points,)."""
    return np.array([(values - truth).min(axis=1).max() for values in J])


def volume(J: Floats, utopia: Floats, scale: Floats) -> float:
    """Return the hypervolume of objectives in units of ranges."""
    Y = (J - utopia) / scale
    if Y.shape[1] == 2:
        return hypervolume(Y)
    return float(moocore.hypervolume(Y, ref=np.full(Y.shape[1], REFERENCE)))


@dataclass(frozen=True)
class Row:
    """Results of one run."""

    truth: float
    volume: float
    found: float
    others: dict[str, float]
    evaluations: int
    points: int
    called: int
    behind: int
    farthest: float
    seconds: float


def claimed(front: Front) -> Floats:
    """Return the objectives of the points along the front that are called optimal and converged.

    A point is called optimal where no model that was evaluated dominates it.
    """
    J = np.array([point.solution.J for point in front.points])
    optimal = nondominated(np.vstack([J, front.known]), scale=front.scale)
    chosen = [
        point.solution.J
        for point, good in zip(front.points, optimal, strict=False)
        if good and point.solution.converged and point.kind is Kind.FRONT
    ]
    return np.array(chosen).reshape(-1, J.shape[1])


def compare(case: Case, seed: int, size: int = 20) -> Row:
    """Return the row of one case, with so many points and models of a population."""
    truth = case.truth()
    utopia, scale = truth.min(axis=0), np.ptp(truth, axis=0)
    started = time.perf_counter()
    with counted() as costs:
        front = pareto_front(case, np.full(case.n, 5.0), Pareto(points=size), seed=seed)
    seconds = time.perf_counter() - started
    spent = costs.eigenproblems
    J = np.array([point.solution.J for point in front.points])
    others = {
        f"{name}-{size}": volume(evolution(case, method, size, spent, seed), utopia, scale)
        for name, method in (("NSGA-II", NSGA2), ("SMS-EMOA", SMSEMOA))
    }
    called = claimed(front)
    far = behind((called - utopia) / scale, (truth - utopia) / scale)
    return Row(
        volume(truth, utopia, scale),
        volume(J, utopia, scale),
        volume(front.known, utopia, scale),
        others,
        spent,
        len(of_kind(front.points, Kind.FRONT)),
        len(called),
        int((far > BEHIND).sum()),
        float(far.max(initial=0.0)),
        seconds,
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--only", nargs="*", help="names that begin so")
    chosen = parser.parse_args()
    print(
        "problem               seed evaluations points called behind farthest  truth modefront "
        " found"
    )
    for case in cases():
        if chosen.only and not case.name.startswith(tuple(chosen.only)):
            continue
        for seed, size in product(range(1, chosen.seeds + 1), (20, 100)):
            row = compare(case, seed, size)
            others = " ".join(f"{name} {value:.4f}" for name, value in row.others.items())
            print(
                f"{case.name:21} {seed:4} {row.evaluations:11} {row.points:6} {row.called:6} "
                f"{row.behind:6} {row.farthest:8.3f} {row.truth:6.4f} {row.volume:9.4f} "
                f"{row.found:6.4f}  {others}"
                f"  {row.seconds:.0f} s",
                flush=True,
            )


if __name__ == "__main__":
    main()
