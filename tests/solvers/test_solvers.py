"""Problems with known answers, for every solver."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import moocore
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from problems import (
    FLAT_CORNERS,
    Derivatives,
    Known,
    bowls,
    box,
    circles,
    concave,
    curved,
    disconnected,
    flat_bowls,
    many_minima,
    patches,
    sphere,
    three_wells,
    valley,
)

from modefront._typing import Floats
from modefront.solvers.attainment import Attainment
from modefront.solvers.continuation import continuation, neighbours, simplex
from modefront.solvers.dominance import nondominated
from modefront.solvers.edges import edge_of_each, sample, typical_sizes
from modefront.solvers.explore import Descent, Search, evolve, explore
from modefront.solvers.gaps import branch_numbers, gaps
from modefront.solvers.indicators import hypervolume, igd_plus, largest_gap
from modefront.solvers.nbi import nbi
from modefront.solvers.payoff import payoff
from modefront.solvers.problem import Evaluation, ObjectiveDerivatives, Problem
from modefront.solvers.scalarisation import LogSum, level, weighted
from modefront.solvers.sqp import Options, Solution, Status, begin, solve
from modefront.solvers.weights import iterate_weights, optimal_minima, regular
from modefront.work.costs import counted
from modefront.work.task import Immediate, Key, R, Task


def sizes_of(problem: Known) -> Floats:
    sizes = typical_sizes(sample(problem, rng=np.random.default_rng(0)))
    assert sizes is not None
    return sizes


def edges_of(problem: Known) -> list[Solution]:
    result = edge_of_each(problem, sizes_of(problem), seeds(len(problem.objectives)), Search())
    assert all(result)
    return [edge.best for edge in result if edge]


def seeds(count: int) -> list[np.random.SeedSequence]:
    return [np.random.SeedSequence(i) for i in range(count)]


def front_of(problem: Known, points: int = 11) -> list[Solution]:
    edges = edges_of(problem)
    target = payoff(edges, sizes_of(problem))
    assert target is not None
    return nbi(problem, edges, target, simplex(len(edges), points - 1))


# ---- one programme ---------------------------------------------------------------------------


@pytest.mark.parametrize("function", [circles, curved])
def test_weighted_sums_have_their_minimum(function: Callable[[Floats], Derivatives]) -> None:
    problem = box(function, [-2, -2], [2, 2])
    start = begin(problem.evaluate(np.array([1.5, -1.0])))
    result = solve(problem, weighted(np.array([1.0, 3.0])), start)
    x = 0.75
    assert result.status is Status.CONVERGED
    y = x**2 if function is curved else 0.0
    assert result.theta == pytest.approx([x, y], abs=1e-6)


def test_bounds_hold_exactly() -> None:
    problem = box(circles, [0.6, 0.5], [2, 2])
    result = solve(problem, weighted(np.array([1.0, 0.1])), begin(problem.evaluate(problem.start)))
    assert result.converged
    assert result.theta.tolist() == [0.6, 0.5]


def test_levels_are_met() -> None:
    problem = box(curved, [-2, -2], [2, 2])
    programme = level(1, 0, 0.16, np.ones(2))
    result = solve(problem, programme, begin(problem.evaluate(np.array([0.1, 0.3]))))
    assert result.converged
    assert result.theta == pytest.approx([0.4, 0.16], abs=1e-6)
    # Its weights are those of the weighted sum with the same solution.
    assert result.weights[0] / result.weights[1] == pytest.approx(0.6 / 0.4, rel=1e-5)


def test_what_was_learned_makes_the_neighbour_cheaper() -> None:
    problem = box(curved, [-2, -2], [2, 2])
    first = solve(problem, weighted(np.array([1.0, 1.0])), begin(problem.evaluate(problem.start)))
    programme = weighted(np.array([1.0, 1.1]))
    warm = solve(problem, programme, first)
    cold = solve(problem, programme, begin(first.evaluation))
    assert warm.converged
    assert warm.evaluations < cold.evaluations


def test_points_without_a_model_are_stepped_back_from() -> None:
    def hole(theta: Floats) -> tuple[Floats, Floats, Floats]:
        J, dJ, H = circles(theta)
        return (J if theta[0] < 0.6 else J * np.inf), dJ, H

    problem = box(hole, [-2, -2], [2, 2])
    result = solve(problem, weighted(np.array([1.0, 1.0])), begin(problem.evaluate(-np.ones(2))))
    assert result.converged
    assert result.theta == pytest.approx([0.5, 0], abs=1e-6)
    nowhere = begin(problem.evaluate(np.ones(2)))
    assert solve(problem, weighted(np.ones(2)), nowhere).status is Status.INFEASIBLE


def test_an_exhausted_search_says_so() -> None:
    problem = box(curved, [-2, -2], [2, 2])
    start = begin(problem.evaluate(np.array([1.9, -1.9])))
    result = solve(problem, weighted(np.ones(2)), start, Options(iterations=1))
    assert result.status is Status.EXHAUSTED
    assert not result.converged


# ---- global search ---------------------------------------------------------------------------


def test_all_minima_are_kept() -> None:
    problem = box(many_minima, [-4, -4], [4, 4])
    first = Descent(weighted(np.array([1.0, 0.0])))
    result = explore(problem, first, Search(), rng=np.random.default_rng(0))
    places = sorted(tuple(np.round(solution.theta).astype(int).tolist()) for solution in result)
    assert places == [(-1, -2), (-1, 2), (1, -2), (1, 2)]


def test_the_evolution_strategy_finds_a_basin() -> None:
    problem = box(circles, [-5, -5], [5, 5])
    theta = evolve(
        problem, Descent(weighted(np.array([1.0, 0.0]))), np.random.default_rng(0), Search()
    )
    assert np.abs(theta).max() < 0.5


def test_a_start_without_derivatives_is_not_taken_for_a_minimum() -> None:
    """Such as a point of an evolutionary method: its gradient is not known, which is not zero."""
    problem = box(many_minima, [-4, -4], [4, 4])
    start = begin(problem.evaluate(np.array([0.6, 1.6]), derivatives=False))
    search = Search(starts=0, limit=0, evolutions=0)
    descent = Descent(weighted(np.array([1.0, 0.0])))
    result = explore(problem, descent, search, [start], rng=np.random.default_rng(0))
    places = [np.round(solution.theta, 3).tolist() for solution in result]
    assert [1.0, 2.0] in places
    assert [0.6, 1.6] not in places


def test_the_evolution_strategy_is_left_to_rugged_objectives() -> None:
    def cost(limit: int, evolutions: int) -> int:
        problem = box(many_minima, [-4, -4], [4, 4])
        search = Search(starts=3, limit=limit, evolutions=evolutions)
        first = Descent(weighted(np.array([1.0, 0.0])))
        with counted() as costs:
            explore(problem, first, search, rng=np.random.default_rng(0))
        return costs.eigenproblems

    assert cost(60, 4) == cost(60, 0), "the starts met the rule"
    assert cost(3, 4) > cost(3, 0), "the starts did not suffice"


def test_searches_are_repeated_exactly_with_the_same_seed() -> None:
    runs = []
    for _ in range(2):
        problem = box(many_minima, [-4, -4], [4, 4])
        rng = np.random.default_rng(5)
        with counted() as costs:
            result = explore(problem, Descent(weighted(np.ones(2))), Search(), rng=rng)
        runs.append([*(solution.theta.tolist() for solution in result), costs.eigenproblems])
    assert runs[0] == runs[1]


def test_half_finished_searches_from_one_place_are_finished_twice_at_most() -> None:
    @dataclass
    class Detour:
        """A search that lingers at (1, 1) and then goes to the minimum far away."""

        finished: int = 0

        def value(self, J: Floats) -> float:
            return float(J[0])

        def equal(self, J: Floats, other: Floats) -> bool:
            return bool(J[0] == other[0])

        def solve(self, problem: Problem, start: Solution, options: Options) -> Solution:
            rough = options.step > 1e-6
            self.finished += not rough
            end = np.ones(2) + 1e-3 * start.theta if rough else np.zeros(2)
            return replace(begin(problem.evaluate(end)), status=Status.CONVERGED)

    local = Detour()
    problem = box(circles, [-2.0, -2.0], [2.0, 2.0])
    result = explore(problem, local, Search(starts=12), rng=np.random.default_rng(0))
    assert [solution.theta.tolist() for solution in result] == [[0.0, 0.0]]
    assert local.finished == 2


# ---- edges -----------------------------------------------------------------------------------


def test_edges_are_lexicographic() -> None:
    assert edges_of(box(valley, [0.1, 0.1], [3, 3]))[1].theta == pytest.approx([1, 1], abs=1e-6)
    best = edges_of(box(many_minima, [-4, -4], [4, 4]))[0]
    assert best.theta == pytest.approx([1, -2], abs=1e-7)


# ---- fronts ----------------------------------------------------------------------------------


@pytest.mark.parametrize("function", [circles, curved])
def test_the_front_of_two_bowls(function: Callable[[Floats], Derivatives]) -> None:
    front = front_of(box(function, [-2, -2], [2, 2]))
    J = np.array([point.J for point in front])
    assert all(point.converged for point in front)
    assert np.sqrt(J).sum(axis=1) == pytest.approx(1, abs=1e-6)
    # The points lie on the normals: J1 - J2 changes by equal steps.
    assert np.diff(J[:, 0] - J[:, 1]) == pytest.approx(0.2, abs=1e-6)
    assert nondominated(J).all()


def test_a_concave_front_is_covered_evenly() -> None:
    front = front_of(box(concave, [-2, -2], [2, 2]), points=15)
    J = np.array([point.J for point in front])
    assert all(point.converged for point in front)
    # On the front x1 = x2 = s: J = 1 - exp(-2 (s -+ c)**2) with |s| <= c.
    s = np.array([point.theta.mean() for point in front])
    c = 1 / np.sqrt(2)
    assert J == pytest.approx(1 - np.exp(-2 * (s[:, None] - [c, -c]) ** 2), abs=1e-6)
    assert nondominated(J).all()
    gaps_between = np.linalg.norm(np.diff(J, axis=0), axis=1)
    assert gaps_between.max() < 1.5 * gaps_between.min()


def test_a_disconnected_front_keeps_dominated_points_and_ends_its_pieces() -> None:
    problem = box(disconnected, [0, -1], [0.651, 1])
    front = front_of(problem, points=25)
    J = np.array([point.J for point in front])
    optimal = nondominated(J)
    assert not optimal.all()
    assert all(point.converged for point in front)
    (gap,) = gaps(problem, front, optimal, np.ptp(J, axis=0))
    assert gap.end is not None
    assert gap.start is not None
    # The first piece ends at its minimum of J2, the second one begins where it undercuts that.
    x = np.linspace(0, 0.651, 1_000_001)
    f = 1 - x - np.sin(4 * np.pi * x) / 4
    hidden = x[np.flatnonzero((f > np.minimum.accumulate(f) + 1e-12) & (x < 0.6))]
    left, right = hidden[0], hidden[-1]
    assert gap.end.J[0] == pytest.approx(left, abs=1e-4)
    assert gap.start.J[0] == pytest.approx(right, abs=1e-4)
    pieces = branch_numbers(J, optimal, [gap])
    assert set(pieces[optimal]) <= {0, 1, 2}
    assert ((pieces == 1) <= (J[:, 0] <= left + 1e-6)).all()
    assert ((pieces == 2) <= (J[:, 0] >= right - 1e-6)).all()


def test_the_front_of_three_bowls_is_their_triangle() -> None:
    front = front_of(box(bowls, [-2, -2], [2, 2], 3), points=5)
    assert len(front) > 15, "the lattice goes on beyond the simplex"
    assert all(point.converged for point in front)
    for point in front:
        # Each point is stationary for the weights that come with it, and none is negative.
        w = point.weights / point.weights.sum()
        assert point.theta == pytest.approx(w[1:], abs=2e-5)
        assert (w > 0).all()


def sphere_front(rng: np.random.Generator) -> Floats:
    u = np.abs(rng.normal(size=(2000, 3)))
    out: Floats = u / np.linalg.norm(u, axis=1)[:, None]
    return out


def flat_bowls_front(rng: np.random.Generator) -> Floats:
    inside = rng.dirichlet(np.ones(3), 2000) @ FLAT_CORNERS
    return np.array([flat_bowls(theta)[0] for theta in inside])


def patches_front(_: np.random.Generator) -> Floats:
    grid = np.linspace(0, 1, 71)
    J = np.array([patches(np.array([x, y, 0.0]))[0] for x in grid for y in grid])
    return J[nondominated(J)]


@dataclass(frozen=True)
class TwoBasins:
    """Programmes that are best in the right basin, but next to the left edge from the right only.

    The edges are at theta = 0 and 1, the basins at 0.1 and 0.9.
    """

    scale: Floats
    label: str = "nbi"

    def goes_on(self, _: Floats) -> bool:
        return False

    def distance(self, beta: Floats, other: Floats) -> Floats:
        return np.asarray(np.abs(beta - other).max(axis=-1))

    def place(self, edge: int, _: Floats) -> Floats:
        return np.eye(2)[edge]

    def solve(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        left = beta[0] > 0.5 and start.theta[0] < 0.5
        return at_theta(0.1 if left else 0.9)

    solve_again = solve

    def is_better(self, beta: Floats, J: Floats, known: Floats) -> bool:
        return bool(J.sum() < known.sum())


def at_theta(theta: float) -> Solution:
    """Return a solution with J = (1 - theta, 1 - theta)."""
    none = np.zeros((2, 1, 1))
    point = Evaluation(
        np.array([theta]), np.full(2, 1 - theta), ObjectiveDerivatives(none[0], none)
    )
    return Solution(point, none, np.ones(2), 0.0, Status.CONVERGED, 1)


def test_a_point_far_from_its_neighbour_is_solved_from_there_though_the_way_back_agrees() -> None:
    problem = box(circles, [0], [1])
    edges = [at_theta(0.0), at_theta(1.0)]
    points = continuation(problem, TwoBasins(np.ones(2)), edges, simplex(2, 3))
    assert [point.theta[0] for point in points] == [0.0, 0.9, 0.9, 1.0]


def test_steps_that_are_expected_have_other_names_where_they_turn_out_to_be_others() -> None:
    functions: dict[Key, Any] = {}

    class Recording(Immediate):
        def run(self, tasks: Sequence[Task[R]], ahead: Sequence[Task[Any]] = (), /) -> list[R]:
            for task in (*tasks, *ahead):
                assert functions.setdefault(task.key, task.function) is task.function
            return super().run(tasks, ahead)

    problem = box(three_wells, [-1, -1.5], [2, 1.5])
    edges = edges_of(problem)
    target = payoff(edges, sizes_of(problem))
    assert target is not None
    nbi(problem, edges, target, simplex(2, 10), work=Recording())
    assert {"from", "again-from"} <= {key[3] for key in functions}


@pytest.mark.parametrize("resumed", [True, False])
def test_a_resumed_front_leaves_points_that_did_not_converge_to_their_neighbours(
    resumed: bool,
) -> None:
    again: dict[Key, Solution] = {}

    class Recording(Immediate):
        def run(self, tasks: Sequence[Task[R]], ahead: Sequence[Task[Any]] = (), /) -> list[R]:
            results = super().run(tasks, ahead)
            for task, result in zip(tasks, results, strict=True):
                if task.key[3] == "again" and isinstance(result, Solution):
                    again[task.key] = result
            return results

    problem = box(curved, [-2, -2], [2, 2])
    edges = edges_of(problem)
    target = payoff(edges, sizes_of(problem))
    assert target is not None
    front = nbi(problem, edges, target, simplex(2, 4))
    before = [
        replace(point, status=Status.STALLED) if k == 2 else point for k, point in enumerate(front)
    ]
    work = Recording()
    points = nbi(problem, edges, target, simplex(2, 4), work, before=before, resumed=resumed)
    (stalled,) = (x for key, x in again.items() if key[2] == (2, 2))
    assert stalled.status is (Status.STALLED if resumed else Status.CONVERGED)
    assert np.allclose(stalled.theta, front[2].theta, rtol=0, atol=0 if resumed else 1e-6)
    assert stalled.beta is not None
    assert stalled.beta.tolist() == [0.5, 0.5]
    if resumed:
        assert stalled.evaluations == 1
    assert all(point.converged for point in points)
    assert np.allclose([x.J for x in points], [x.J for x in front], rtol=0, atol=1e-9)


def test_a_piece_of_the_front_between_the_edges_is_reached_from_its_own_minimum() -> None:
    problem = box(three_wells, [-1, -1.5], [2, 1.5])
    sizes = sizes_of(problem)
    result = edge_of_each(problem, sizes, seeds(2), Search())
    edges = [solution.best for solution in result if solution]
    assert [round(edge.theta[1]) for edge in edges] == [-1, 1]
    target = payoff(edges, sizes)
    assert target is not None
    alone = nbi(problem, edges, target, simplex(2, 10))
    assert not any(abs(point.theta[1]) < 0.5 for point in alone)
    minima = [minimum for each in result if each for minimum in each.minima]
    front = nbi(problem, edges, target, simplex(2, 10), minima=minima)
    assert sum(abs(point.theta[1]) < 0.5 for point in front) >= 6
    optimal = nondominated(np.array([point.J for point in front]))
    assert all(point.converged for point in front)
    assert sum(optimal[i] for i, point in enumerate(front) if abs(point.theta[1]) < 0.5) >= 6


@pytest.mark.parametrize(
    ("function", "lower", "upper", "known", "within", "beyond"),
    [
        # The sphere bulges out of its simplex; of the flat triangle, parts lie beside it; of the
        # four patches, two are not reached from an edge without leaving the front.
        (sphere, [0, 0, 0], [1, 1, 1], sphere_front, 0.040, 0.028),
        (flat_bowls, [-2, -2], [2, 2], flat_bowls_front, 0.016, 0.0145),
        (patches, [0, 0, 0], [1, 1, 1], patches_front, 0.060, 0.029),
    ],
)
def test_fronts_of_three_objectives_are_covered_beyond_the_simplex(
    function: Callable[[Floats], Derivatives],
    lower: list[float],
    upper: list[float],
    known: Callable[[np.random.Generator], Floats],
    within: float,
    beyond: float,
) -> None:
    problem = box(function, lower, upper, 3)
    sizes = sizes_of(problem)
    result = edge_of_each(problem, sizes, seeds(3), Search())
    edges = [solution.best for solution in result if solution]
    minima = [minimum for each in result if each for minimum in each.minima]
    target = payoff(edges, sizes, minima)
    assert target is not None
    front = nbi(problem, edges, target, simplex(3, 10), minima=minima)
    J = np.array([point.J for point in front]) / target.scale
    R = known(np.random.default_rng(0)) / target.scale
    assert igd_plus(J, R) <= beyond
    assert igd_plus(J[:66], R) >= within
    assert all(point.converged for point in front)
    # No point of the true front is dominated: the points found lie on it.
    assert igd_plus(R, J) <= 0.03


def test_nothing_is_evaluated_where_the_front_ends() -> None:
    problem = box(bowls, [-2, -2], [2, 2], 3)
    corners = [
        begin(problem.evaluate(np.array(evaluation))) for evaluation in ([0.0, 0.0], [1, 0], [0, 1])
    ]
    target = payoff(corners, np.ones(3))
    assert target is not None
    programmes = Attainment(target, np.array([corner.theta for corner in corners]))
    # Beyond the first corner, J1 = 0 holds the bound: Phi beta = (-0.2, 0.5, 0.5).
    beyond = np.array([1.2, -0.1, -0.1])
    with counted() as costs:
        result = programmes.solve(problem, beyond, corners[0])
    assert costs.eigenproblems == 0
    assert result.status is Status.STALLED
    assert result.evaluation is corners[0].evaluation
    within = programmes.solve(problem, np.array([0.8, 0.1, 0.1]), corners[0])
    assert within.converged


def test_more_objectives_than_parameters_can_meet_on_a_normal() -> None:
    centres = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.2], [0.4, 1.4]])

    def five(theta: Floats) -> Derivatives:
        r = theta - centres
        return (r**2).sum(axis=1), 2 * r, np.array([2 * np.eye(2)] * 5)

    front = front_of(box(five, [-2, -2], [2, 2], 5), points=4)
    assert len(front) >= 35
    assert all(point.converged for point in front)
    # The Pareto set is the convex hull of the centres: each point is a mean of them.
    for point in front:
        w = point.weights / point.weights.sum()
        assert (w > 0).all()
        assert point.theta == pytest.approx(w @ centres, abs=2e-5)


def test_the_second_point_costs_few_evaluations() -> None:
    problem = box(curved, [-2, -2], [2, 2])
    edges = edges_of(problem)
    target = payoff(edges, sizes_of(problem))
    assert target is not None
    with counted() as costs:
        nbi(problem, edges, target, simplex(2, 19))
    assert costs.eigenproblems == pytest.approx(57, rel=0.05), "three a point"


def test_one_best_model_is_a_front_of_one_point() -> None:
    def same(theta: Floats) -> tuple[Floats, Floats, Floats]:
        J, dJ, H = circles(theta)
        return J[[0, 0]], dJ[[0, 0]], H

    problem = box(same, [-2, -2], [2, 2])
    assert payoff(edges_of(problem), sizes_of(problem)) is None


@given(st.integers(1, 5), st.integers(1, 6))
def test_the_lattice_is_the_simplex(n: int, divisions: int) -> None:
    lattice = simplex(n, divisions)
    assert lattice.beta.sum(axis=1) == pytest.approx(1)
    assert (lattice.beta >= 0).all()
    assert len({tuple(row) for row in lattice.beta}) == len(lattice.beta)
    assert lattice.beta[0, 0] == 1
    assert lattice.beta[-1, -1] == 1
    for place in map(tuple, lattice.counts.tolist()):
        near = neighbours(place)
        assert len(set(near)) == n * (n - 1)
        for other in near:
            assert place in neighbours(other)
            assert np.abs(np.array(place) - other).sum() == 2


# ---- weights ---------------------------------------------------------------------------------


def test_optimal_weights_are_a_over_J_and_the_iteration_agrees() -> None:
    def offset(theta: Floats) -> tuple[Floats, Floats, Floats]:
        J, dJ, H = curved(theta)
        return J + np.array([0.3, 0.2]), dJ, H

    problem = box(offset, [-2, -2], [2, 2])
    a, sizes = np.array([3.0, 5.0]), sizes_of(problem)
    best = optimal_minima(problem, a, sizes, Search(), [], rng=np.random.default_rng(0))[0]
    again = solve(problem, weighted(a / best.J), begin(best.evaluation))
    assert again.theta == pytest.approx(best.theta, abs=1e-6)
    start = solve(problem, weighted(np.ones(2)), begin(problem.evaluate(problem.start)))
    iterated = iterate_weights(problem, a, sizes, start)
    assert iterated is not None
    assert iterated.converged
    assert iterated.theta == pytest.approx(best.theta, abs=1e-5)
    programme = LogSum(a)
    for shift in np.random.default_rng(1).normal(scale=1e-3, size=(20, 2)):
        nearby = problem.evaluate(best.theta + shift).J
        assert programme.value(nearby) >= programme.value(best.J)


def test_singular_minima_are_told_from_regular_ones() -> None:
    problem = box(circles, [-2, -2], [2, 2])
    sizes = sizes_of(problem)
    rng = np.random.default_rng(0)
    result = optimal_minima(problem, np.ones(2), sizes, Search(), [], rng=rng)
    assert not any(regular(solution.J, sizes) for solution in result)
    exact = begin(problem.evaluate(np.zeros(2)))
    assert iterate_weights(problem, np.ones(2), sizes, exact) is None


# ---- dominance -------------------------------------------------------------------------------


@given(st.integers(0, 2**31), st.integers(1, 4))
def test_dominance_is_that_of_equation_4(seed: int, n: int) -> None:
    J = np.random.default_rng(seed).integers(0, 4, size=(12, n)).astype(float)
    expected = [not any((other <= row).all() and (other < row).any() for other in J) for row in J]
    assert nondominated(J).tolist() == expected
    assert nondominated(1e-9 * J + 5e-9).tolist() == expected


def test_rounding_dominates_nothing() -> None:
    J = np.array([[1.0, 2.0], [1.0 + 1e-14, 2.0], [0.0, 3.0], [np.inf, 0.0]])
    assert nondominated(J).tolist() == [True, True, True, False]


# ---- indicators ------------------------------------------------------------------------------


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31), st.integers(2, 4))
def test_indicators_are_those_of_moocore(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    Y, R = rng.uniform(0, 1.3, size=(9, n)), rng.uniform(size=(20, n))
    assert igd_plus(Y, R) == pytest.approx(float(moocore.igd_plus(Y, ref=R)))
    assert hypervolume(Y) == pytest.approx(float(moocore.hypervolume(Y, ref=np.full(n, 1.1))))


def test_the_largest_gap_is_that_between_neighbours() -> None:
    x = np.array([0.0, 0.1, 0.15, 0.6, 0.7])
    Y = np.column_stack([x, 1 - x])
    order = np.random.default_rng(0).permutation(5)
    assert largest_gap(Y[order]) == pytest.approx(0.45 * np.sqrt(2))
    assert largest_gap(np.vstack([Y, Y])) == pytest.approx(0.45 * np.sqrt(2))
    assert largest_gap(Y[:1]) == 0
