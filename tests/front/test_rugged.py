"""Fronts of rugged problems and of four and more objectives, beside true ones and an evolution."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from problems import Derivatives, box

from modefront._typing import Floats
from modefront.front.dominance import nondominated
from modefront.front.front import Front
from modefront.front.indicators import hypervolume, igd_plus
from modefront.front.methods import evolve_front
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.front.point import Kind, of_kind
from modefront.front.search import Search
from modefront.work.store import Run, Store
from modefront.work.task import counted

FEW = Search(evaluations=4000)

CENTRES = np.array([[-0.9, 0.5, -0.6, 0.8], [0.6, -0.8, 0.7, -0.5]])


def waves(u: Floats) -> Floats:
    return np.asarray(u**2 + np.sin(4 * u) ** 2)


def rastrigin(theta: Floats) -> Derivatives:
    """Squares of the residuals u and sin 4u, for u = theta - c with two centres c."""
    u = theta - CENTRES
    dJ = 2 * u + 4 * np.sin(8 * u)
    H = np.array([np.diag(2 + 32 * np.cos(4 * angle) ** 2) for angle in u])
    return waves(u).sum(axis=1), dJ, H


def rastrigin_front() -> Floats:
    """Return the true front: the sum over parameters of the fronts of each."""
    x = np.linspace(-2, 2, 4001)
    total = np.zeros((1, 2))
    for c in CENTRES.T:
        chosen = np.column_stack([waves(x - c[0]), waves(x - c[1])])
        total = (total[:, None] + best(chosen)[None]).reshape(-1, 2)
        total = best(total)
    return total


def best(J: Floats, cell: float = 0.01) -> Floats:
    """Return the non-dominated rows of J (m, 2), one a cell."""
    J = J[np.lexsort((J[:, 1], J[:, 0]))]
    J = J[J[:, 1] < np.minimum.accumulate(np.concatenate([[np.inf], J[:-1, 1]]))]
    new = (np.diff(np.floor(J / cell), axis=0) != 0).any(axis=1)
    return np.asarray(J[np.concatenate([[True], new])])


def objectives(front: Front) -> Floats:
    return np.array([point.solution.J for point in front.points])


@cache
def rugged(points: int = 12) -> tuple[Front, int]:
    """Return the front of the rugged problem, and what it has cost."""
    problem = box(rastrigin, [-2.0] * 4, [2.0] * 4)
    options = Pareto(points=points)
    with counted() as costs:
        front = pareto_front(problem, np.array([4.0, 4.0]), options, seed=1, search=FEW)
    return front, costs.eigenproblems


@pytest.mark.slow(4)
def test_a_rugged_front_is_not_behind_an_evolution_with_as_many_evaluations() -> None:
    problem = box(rastrigin, [-2.0] * 4, [2.0] * 4)
    truth = rastrigin_front()
    utopia, scale = truth.min(axis=0), np.ptp(truth, axis=0)
    front, spent = rugged(points=40)
    others = []
    for seed in range(5):
        other = evolve_front(problem, "nsga2", 40, spent, np.random.default_rng(seed))
        others.append(hypervolume((np.array([x.J for x in other]) - utopia) / scale))
    assert hypervolume((objectives(front) - utopia) / scale) >= np.median(others)
    front, _ = rugged()
    J = (objectives(front) - utopia) / scale
    assert hypervolume(J) >= 0.97 * hypervolume((truth - utopia) / scale)
    called = [
        row
        for row, optimal, point in zip(J, nondominated(J), front.points, strict=True)
        if optimal and point.solution.converged and point.kind is Kind.FRONT
    ]
    R = (truth - utopia) / scale
    behind = sum((row - R).min(axis=1).max() > 0.01 for row in called)
    assert len(called) >= 12
    assert behind <= len(called) / 20


def test_no_evaluated_model_is_better_than_edges_and_weighted_models() -> None:
    front, _ = rugged()
    models = {point.label: point.solution.J for point in front.points}
    least = front.known.sum(axis=1).min()
    assert models["equal-weights"].sum() <= least * (1 + FEW.tolerance)
    for i in range(2):
        assert models[f"edge-J{i + 1}"][i] <= front.known[:, i].min() * (1 + FEW.tolerance) + 1e-9
        assert front.edges[i].best.J.tolist() == models[f"edge-J{i + 1}"].tolist()


def test_a_search_that_is_continued_evaluates_nothing_again(tmp_path: Path) -> None:
    fronts, evaluations = [], []
    search = Search(evaluations=800)
    for _ in range(2):
        problem = box(rastrigin, [-2.0] * 4, [2.0] * 4)
        work = Run(Store(tmp_path))
        with counted() as costs:
            fronts.append(
                pareto_front(
                    problem, np.ones(2), Pareto(points=4), seed=3, search=search, work=work
                )
            )
        evaluations.append(costs.eigenproblems)
        assert work.total().eigenproblems == evaluations[0], "what tasks cost is kept"
    assert evaluations[0] > 0
    assert evaluations[1] == 0
    assert objectives(fronts[0]).tolist() == objectives(fronts[1]).tolist()


def test_a_front_that_is_resumed_keeps_what_was_explored() -> None:
    front, spent = rugged()
    with counted() as costs:
        again = pareto_front(
            box(rastrigin, [-2.0] * 4, [2.0] * 4),
            np.array([4.0, 4.0]),
            Pareto(points=12),
            seed=1,
            search=FEW,
            known=front,
        )
    J, before = objectives(again), objectives(front)
    assert len(J) == len(before) > 12
    utopia, scale = before.min(axis=0), np.ptp(before, axis=0)
    assert hypervolume((J - utopia) / scale) > 0.998 * hypervolume((before - utopia) / scale)
    assert costs.eigenproblems < 0.25 * spent


# ---- four and more objectives ------------------------------------------------------------------


def product_front(n: int, *, linear: bool) -> Callable[[Floats], Derivatives]:
    """DTLZ1 without waves, or DTLZ2 (Deb et al. 2002), and one distance variable.

    The front, where the last parameter is 1/2, is the simplex sum J = 1, or the sphere of radius 1.
    """

    def function(theta: Floats) -> Derivatives:
        x, z = theta[:-1], theta[-1] - 0.5
        half = np.pi / 2
        if linear:
            c, s, dc, ds = x, 1 - x, np.ones(n - 1), -np.ones(n - 1)
        else:
            c, s = np.cos(half * x), np.sin(half * x)
            dc, ds = -half * s, half * c
        f, df = np.empty(n), np.zeros((n, n))
        for i in range(n):
            m = n - 1 - i
            factors, slopes = list(c[:m]), list(dc[:m])
            if i > 0:
                factors.append(s[m])
                slopes.append(ds[m])
            f[i] = np.prod(factors)
            for j, slope in enumerate(slopes):
                df[i, j] = slope * np.prod(factors[:j] + factors[j + 1 :])
        g = 1 + z**2
        df *= g
        df[:, -1] = 2 * z * f
        return g * f, df, np.zeros((n, n, n))

    return function


@pytest.mark.slow(4)
@pytest.mark.parametrize(("n", "linear"), [(4, True), (4, False), (5, False)])
def test_fronts_of_four_and_five_objectives_whose_edges_coincide(n: int, linear: bool) -> None:
    problem = box(product_front(n, linear=linear), [0.0] * n, [1.0] * n, n)
    front = pareto_front(problem, np.ones(n), Pareto(points=3), seed=1)
    along = [point.solution for point in of_kind(front.points, Kind.FRONT)]
    J = np.array([point.J for point in along if point.converged])
    size = J.sum(axis=1) if linear else np.linalg.norm(J, axis=1)
    assert size == pytest.approx(1, abs=1e-5)
    assert len(J) >= n + n * (n - 1) // 2
    # The corners are there, and the front between them.
    assert (J.max(axis=0) > 0.95).all()
    R = np.random.default_rng(0).dirichlet(np.ones(n), 1000)
    R = R if linear else np.sqrt(R)
    assert igd_plus(J, R) <= 0.25
