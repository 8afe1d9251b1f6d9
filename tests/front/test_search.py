"""The search: what it keeps, what a request and a budget mean, and each proposer alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from problems import (
    Derivatives,
    Known,
    bowls,
    box,
    circles,
    concave,
    curved,
    disconnected,
    many_minima,
    three_wells,
)

import modefront as mf
from modefront._typing import Bools, Floats
from modefront.front.dominance import undominated
from modefront.front.front import Front
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.front.point import Kind, of_kind
from modefront.front.proposers.evolution import Evolution
from modefront.front.proposers.polish import Polish
from modefront.front.proposers.starts import SURE, Minima, Starts
from modefront.front.search import (
    BATCH,
    USUAL,
    Offer,
    Outcome,
    Place,
    Search,
    State,
    at,
    evaluated_all,
    recorded,
)
from modefront.front.simplex import lattice, payoff
from modefront.front.subproblems import SAMPLE, LatticePoint, Least, Subproblem, Weights
from modefront.optim.problem import Evaluation, Problem, infeasible
from modefront.optim.sqp import Solution, Status, begin
from modefront.optim.sqp import given as given_model
from modefront.work.task import Task, counted

ONES = np.ones(2)
TOLERANCE = Search().tolerance


@dataclass(frozen=True)
class Seen(Known):
    """A problem that remembers the objectives of all its evaluations."""

    all: list[Floats] = field(default_factory=list)

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        evaluation = super().evaluate(theta, derivatives=derivatives, second=second)
        self.all.append(evaluation.J)
        return evaluation


def seen(problem: Known) -> Seen:
    return Seen(problem.function, problem.lower, problem.upper, problem.start, problem.objectives)


def waves(seed: int, n: int) -> Seen:
    """Return a problem of n sums of squares of u and of sin 3u, about random centres."""
    rng = np.random.default_rng(seed)
    centres, height = rng.uniform(-1, 1, (n, 2)), float(rng.uniform(0, 0.7))

    def function(theta: Floats) -> Derivatives:
        u = theta - centres
        J = 0.1 + (u**2 + height * np.sin(3 * u) ** 2).sum(axis=1)
        H = np.array([np.diag(2 + 18 * height * np.cos(6 * row)) for row in u])
        return J, 2 * u + 3 * height * np.sin(6 * u), H

    return seen(box(function, [-2, -2], [2, 2], n))


def front_points(front: Front) -> list[Solution]:
    return [point.solution for point in of_kind(front.points, Kind.FRONT)]


def assert_nothing_is_better(front: Front, problem: Seen, tolerance: float = TOLERANCE) -> None:
    """Assert that no evaluated model beats an edge, a weighted model or a point, in its order."""
    J = np.array(problem.all)
    J = J[np.isfinite(J).all(axis=1)]
    for i, edge in enumerate(front.edges):
        order = Least(i, front.sizes, "edge")
        assert max(order.gain(row, edge.best) for row in J) <= tolerance, f"edge {i}"
    for point in of_kind(front.points, Kind.EQUAL):
        w = np.ones(J.shape[1])
        assert point.solution.J @ w <= (J @ w).min() * (1 + tolerance)
    along = front_points(front)
    assert front.target is not None
    for beta, k in zip(front.lattice, front.places.tolist(), strict=True):
        if beta.max() == 1 and not front.target.worst:
            assert np.array_equal(along[k].theta, front.edges[int(beta.argmax())].best.theta)
            continue
        each = LatticePoint(beta, (), front.target)
        assert max(each.gain(row, along[k]) for row in J) <= tolerance, f"point {beta}"


# ---- what is kept ----------------------------------------------------------------------------


@pytest.mark.slow(3)
@settings(max_examples=4)
@given(st.integers(0, 2**31), st.integers(2, 3))
def test_no_evaluated_model_is_better_than_what_is_reported(seed: int, n: int) -> None:
    problem = waves(seed, n)
    front = pareto_front(problem, np.ones(n), Pareto(points=4), seed=seed % 7)
    assert_nothing_is_better(front, problem)


@pytest.mark.parametrize(
    ("function", "lower", "upper"),
    [
        pytest.param(three_wells, [-1.0, -1.5], [2.0, 1.5], marks=pytest.mark.slow(3)),
        (disconnected, [0.0, -1.0], [0.651, 1.0]),
        (many_minima, [-4.0, -4.0], [4.0, 4.0]),
    ],
)
def test_nor_on_fronts_with_gaps_and_many_basins(
    function: Callable[[Floats], Derivatives], lower: list[float], upper: list[float]
) -> None:
    problem = seen(box(function, lower, upper))
    front = pareto_front(problem, ONES, Pareto(points=7), seed=3)
    assert_nothing_is_better(front, problem)


@pytest.mark.parametrize("method", ["nbi", "weights"])
def test_one_seed_gives_one_front(method: str) -> None:
    fronts = []
    for _ in range(2):
        problem = waves(5, 2)
        front = pareto_front(problem, ONES, Pareto(method=method, points=5), seed=4)
        fronts.append((front, np.array(problem.all)))
    (one, evaluated), (other, again) = fronts
    assert again.tobytes() == evaluated.tobytes()
    assert other.known.tobytes() == one.known.tobytes()
    assert [x.label for x in other.points] == [x.label for x in one.points]
    for x, y in zip(one.points, other.points, strict=True):
        assert x.solution.theta.tobytes() == y.solution.theta.tobytes()
        assert x.solution.weights.tobytes() == y.solution.weights.tobytes()
        assert x.solution.status is y.solution.status
    assert [len(edge.minima) for edge in one.edges] == [len(edge.minima) for edge in other.edges]


def test_given_weights_lead_to_models_of_their_names() -> None:
    w = np.array([1.0, 3.0])
    front = pareto_front(box(curved, [-2, -2], [2, 2]), ONES, Pareto(points=3), given=[("mine", w)])
    (point,) = of_kind(front.points, Kind.GIVEN)
    assert point.label == "mine"
    assert point.solution.theta == pytest.approx([0.75, 0.75**2], abs=1e-6)
    (equal,) = of_kind(front.points, Kind.EQUAL)
    assert equal.solution.theta == pytest.approx([0.5, 0.25], abs=1e-6)


def test_a_known_front_is_solved_for_again_and_nothing_else_is_sought() -> None:
    def shifted(theta: Floats) -> Derivatives:
        return circles(theta - [0.01, 0.0])

    known = pareto_front(box(circles, [-2, -2], [2, 2]), ONES, Pareto(points=7), seed=1)
    with counted() as first:
        fresh = pareto_front(box(shifted, [-2, -2], [2, 2]), ONES, Pareto(points=7), seed=1)
    with counted() as costs:
        again = pareto_front(
            box(shifted, [-2, -2], [2, 2]), ONES, Pareto(points=7), seed=1, known=known
        )
    assert costs.eigenproblems < 0.5 * first.eigenproblems
    J, expected = (np.array([x.J for x in front_points(each)]) for each in (again, fresh))
    assert J == pytest.approx(expected, abs=1e-5)
    assert all(x.converged for x in front_points(again))


@pytest.mark.slow(3)
def test_other_minima_of_a_known_front_are_solved_for_again() -> None:
    def shifted(theta: Floats) -> Derivatives:
        return three_wells(theta - [0.01, 0.0])

    lower, upper = [-1.5, -1.5], [2, 1.5]
    known = pareto_front(box(three_wells, lower, upper), ONES, Pareto(points=3))
    assert max(len(edge.minima) for edge in known.edges) > 1
    again = pareto_front(box(shifted, lower, upper), ONES, Pareto(points=3), known=known)
    for edge, before in zip(again.edges, known.edges, strict=True):
        thetas = np.array([x.theta - [0.01, 0.0] for x in edge.minima])
        assert thetas == pytest.approx(np.array([x.theta for x in before.minima]), abs=1e-4)
        assert (edge.starts, edge.found) == (before.starts, before.found)


# ---- what is asked for -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("function", "points"),
    [(circles, 2), (concave, 8), pytest.param(three_wells, 3, marks=pytest.mark.slow(2))],
)
def test_a_front_of_two_groups_has_at_most_twice_the_points_that_are_asked_for(
    function: Callable[[Floats], Derivatives], points: int
) -> None:
    front = pareto_front(box(function, [-1.5, -1.5], [2, 1.5]), ONES, Pareto(points=points))
    assert points <= 2 * len(front_points(front))
    assert len(front_points(front)) <= 2 * points


def test_a_model_that_is_as_good_as_can_be_has_the_usual_starts_only() -> None:
    """Both objectives are least, 0.1 and 0.2, where one model is best, among minima of waves."""

    def function(theta: Floats) -> Derivatives:
        u = theta - np.array([0.3, -0.6])
        J = 0.1 + (u**2 + np.sin(4 * u) ** 2).sum()
        dJ, H = 2 * u + 4 * np.sin(8 * u), np.diag(2 + 32 * np.cos(8 * u))
        return np.array([J, 2 * J]), np.array([dJ, 2 * dJ]), np.array([H, 2 * H])

    usual = range(USUAL, USUAL + BATCH)
    for least, starts in ((None, range(usual.stop, 100)), (np.array([0.1, 0.2]), usual)):
        problem = box(function, [-2, -2], [2, 2])
        front = pareto_front(problem, ONES, Pareto(points=3), seed=1, least=least)
        for edge in front.edges:
            np.testing.assert_allclose(edge.best.J, [0.1, 0.2], atol=1e-9)
            assert edge.starts in starts
            assert not edge.doubtful


@pytest.mark.parametrize("budget", [1, 50, 150])
def test_at_its_budget_a_search_ends_and_says_what_did_not_converge(budget: int) -> None:
    problem = waves(11, 2)
    search = Search(evaluations=budget)
    front = pareto_front(problem, ONES, Pareto(points=20), seed=1, search=search)
    # Typical sizes are found, and each model that is reported has its derivatives, at any rate.
    assert len(problem.all) <= max(budget, SAMPLE) + len(front.points)
    open_points = [point for point in front.points if not point.solution.converged]
    assert open_points
    assert {point.solution.status for point in open_points} <= {Status.EXHAUSTED, Status.STALLED}
    for point in front.points:
        assert point.solution.feasible
        assert point.solution.evaluation.derivatives
    whole = waves(11, 2)
    assert all(
        point.solution.converged
        for point in pareto_front(whole, ONES, Pareto(points=20), seed=1).points
    )
    assert len(whole.all) > len(problem.all)
    assert front.open


def test_a_model_that_takes_a_place_after_the_search_is_solved_for_from_there() -> None:
    names, rng = ("k1", "k2", "k3"), np.random.default_rng(3)
    sensors, springs = {"low": 0, "middle": 2, "top": 4}, [22e3, 18e3, 24e3, 20e3, 16e3]
    truth = mf.chain(names, [10.0] * 5, springs, sensors=sensors).modes(np.ones(3), 4)
    shapes = truth.phi.T / np.abs(truth.phi.T).max(axis=1, keepdims=True)
    shapes = shapes + 0.02 * rng.standard_normal((2, 4, 3))
    frequency = truth.frequency * (1 + 0.004 * rng.standard_normal((2, 4)))
    scales = ["k1", "k2", "k3", "", "k2"]
    model = mf.chain(names, [10.0] * 5, [2e4] * 5, stiffness_parameters=scales, sensors=sensors)
    data = mf.modal_data(frequency, shapes, tuple(sensors), frequency_std=0.004 * frequency)
    groups = [
        mf.Group("frequencies", frequency="all", scale="std"),
        *(mf.Group("low", shape=[1, 2]), mf.Group("high", shape=[3, 4])),
    ]
    parameters = [mf.Parameter(name, nominal=1.0, bounds=(0.3, 3.0)) for name in names]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    front = pareto_front(problem, np.array([4.0, 6.0, 6.0]), Pareto(points=4), seed=1)
    assert not front.open, "far from its budget"
    assert all(point.solution.converged for point in front.points)


def test_the_edge_of_an_exact_fit_is_no_model_on_the_way_there() -> None:
    names = ("k1", "k2", "k3")
    springs = 1e3 * np.random.default_rng(27).uniform(0.7, 1.3, 4)
    truth = mf.chain(names, [1.0] * 4, springs.tolist()).modes(np.ones(3), 3)
    scales = ["k1", "k2", "k3", "k2"]
    model = mf.chain(names, [1.0] * 4, [1e3] * 4, stiffness_parameters=scales)
    data = mf.modal_data(truth.frequency, truth.phi.T, model.sensors)
    first, others = mf.Group("first", shape=[1]), mf.Group("others", shape=[2, 3])
    groups = [mf.Group("frequencies", frequency="all"), first, others]
    parameters = [mf.Parameter(name, nominal=1.0, bounds=(0.3, 3.0)) for name in names]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    edge = pareto_front(problem, np.array([3.0, 4.0, 8.0]), Pareto(points=4), seed=1).edges[0].best
    assert edge.converged
    assert edge.J[0] < 1e-18, "three parameters fit three frequencies"


@pytest.mark.slow(3)
def test_what_a_search_leaves_open_at_its_budget_is_a_finding() -> None:
    names = ["k1", "k2", "k3"]
    model = mf.chain(names, [2.0, 1.5, 1.0], [3e3, 2e3, 4e3], stiffness_parameters=names)
    truth = model.modes(np.array([1.1, 0.9, 1.05]), 3)
    rng = np.random.default_rng(0)
    frequency = truth.frequency * (1 + 0.01 * rng.standard_normal((3, 3)))
    shapes = truth.phi.T + 0.03 * rng.standard_normal((3, 3, 3))
    data = mf.modal_data(frequency, shapes, model.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    parameters = [mf.Parameter(name, nominal=1.0, bounds=(0.5, 2.0)) for name in names]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    text = "the search ended at its budget"
    for budget, left in ((30, "edge-"), (60, "points between the edges")):
        short = mf.solve(
            problem, points=5, search=Search(evaluations=budget), noise=mf.NoisePrior(weight=0)
        )
        assert [x for x in short["finding"].values.tolist() if x.startswith(text) and left in x]
    of_front = short["kind"].values == "front"
    assert np.isnan(short["theta_std"].values[of_front]).any(), "of points that were not solved"
    whole = mf.solve(problem, points=5, noise=mf.NoisePrior(weight=0))
    assert not [x for x in whole["finding"].values.tolist() if x.startswith(text)]


# ---- equations and bounds --------------------------------------------------------------------


def dented(theta: Floats) -> Derivatives:
    """The curve of `disconnected`, rising less: each normal crosses it once."""
    x, y = theta
    w = 4 * np.pi
    J = np.array([x, 1 - x - np.sin(w * x) / 8 + y**2])
    H = np.zeros((2, 2, 2))
    H[1] = [[w**2 * np.sin(w * x) / 8, 0], [0, 2.0]]
    return J, np.array([[1.0, 0.0], [-1 - w * np.cos(w * x) / 8, 2 * y]]), H


def front_with(programme: str, function: Callable[[Floats], Derivatives]) -> tuple[Front, Bools]:
    """Return a front of 25 points, and which of these no evaluated model dominates."""
    problem = seen(box(function, [0, -1], [0.651, 1]))
    front = pareto_front(problem, ONES, Pareto(points=25, programme=programme), seed=1)
    J = np.array([x.J for x in front_points(front)])
    assert front.target is not None
    return front, undominated(J, np.array(problem.all), front.target.scale)


@pytest.mark.parametrize("function", [dented, disconnected])
def test_equations_lead_to_the_points_of_das_and_dennis(
    function: Callable[[Floats], Derivatives],
) -> None:
    front, optimal = front_with("equations", function)
    points = front_points(front)
    assert front.target is not None
    assert len(points) == 25
    for k, x in enumerate(points):
        assert x.converged
        assert x.beta == pytest.approx([1 - k / 24, k / 24])
        assert x.beta is not None
        excess = LatticePoint(x.beta, (), front.target).order.excess(x.J)
        assert excess == pytest.approx(excess.mean(), abs=1e-6)
        assert x.theta[1] == pytest.approx(0.0, abs=1e-6)
    assert 0 < (~optimal).sum() < 10, "equations lead into the gap"


@pytest.mark.parametrize("function", [dented, disconnected])
def test_bounds_lead_to_points_that_no_evaluated_model_dominates(
    function: Callable[[Floats], Derivatives],
) -> None:
    front, optimal = front_with("bounds", function)
    assert optimal.all()
    assert len(optimal) < 25, "those in the gap lead to its ends"
    assert len(front.gaps) == 1


def test_where_nothing_is_dominated_both_programmes_agree() -> None:
    problem = box(concave, [-2, -2], [2, 2])
    fronts = [
        pareto_front(problem, ONES, Pareto(points=9, programme=name), seed=1)
        for name in ("bounds", "equations")
    ]
    bounds, equations = (np.array([x.J for x in front_points(front)]) for front in fronts)
    assert bounds == pytest.approx(equations, abs=1e-3)
    assert bounds[1:-1] == pytest.approx(equations[1:-1], abs=1e-6)


# ---- proposers -------------------------------------------------------------------------------


def state_of(problem: Known, subproblems: list[Subproblem], thetas: list[list[float]]) -> State:
    """Return a state in which models at some parameters are known, with derivatives."""
    state = State(problem)
    for theta in thetas:
        solution = begin(problem.evaluate(np.array(theta)))
        state.archive.add(solution.J, solution)
    state.add(subproblems)
    return state


def anchors(problem: Known) -> list[Subproblem]:
    n = len(problem.objectives)
    edges = [Least(i, np.ones(n), name) for i, name in enumerate(problem.objectives)]
    return [*edges, Weights(np.ones(n), ("weights", "equal", ""), 1e-10)]


def points_between(problem: Known, corners: list[list[float]], points: int) -> list[Subproblem]:
    edges = [given_model(problem.evaluate(np.array(theta))) for theta in corners]
    n = len(edges)
    target = payoff(edges, np.ones(n))
    assert target is not None
    counts = lattice(n, points - 1)
    return [LatticePoint(row / (points - 1), tuple(row.tolist()), target) for row in counts]


def test_polish_closes_every_incumbent() -> None:
    problem = box(curved, [-2, -2], [2, 2])
    between = points_between(problem, [[0, 0], [1, 1]], 7)
    state = state_of(problem, [*anchors(problem), *between], [[0.1, 0.3], [1.2, 0.9]])
    assert not any(place.closed for place in state.places)
    polish = Polish()
    state.search("test", [polish])
    assert all(place.closed for place in state.places)
    assert all(place.incumbent.converged for place in state.places)
    J = np.array([place.incumbent.J for place in state.places])
    assert np.sqrt(J).sum(axis=1) == pytest.approx(1, abs=1e-6)
    assert not list(polish.offers(state, 6))


@pytest.mark.parametrize("status", [Status.JUMP, Status.CONVERGED])
def test_a_model_at_a_jump_gives_way_to_any_that_is_better(status: Status) -> None:
    """A little is no gain that counts, and a minimum has better neighbours by rounding alone."""
    problem = box(curved, [-2, -2], [2, 2])
    state = state_of(problem, anchors(problem), [[0.1, 0.3]])
    place = state.places[-1]
    place.incumbent, place.closed = replace(place.incumbent, status=status), True
    better = begin(problem.evaluate(np.array([0.1, 0.3 - 1e-6])))
    assert 0 < place.subproblem.gain(better.J, place.incumbent) < TOLERANCE
    outcome = Outcome(better, better.theta[None], better.J[None], 1)
    assert state.tell(None, None, outcome) == 0
    assert place.closed
    assert place.incumbent.status is status
    assert (place.incumbent.evaluation is better.evaluation) == (status is Status.JUMP)


def test_points_are_solved_from_the_nearest_that_lie_on_their_normals() -> None:
    problem = box(circles, [-2, -2], [2, 2])
    edges = [[0.0, 0.0], [1.0, 0.0]]
    state = state_of(problem, points_between(problem, edges, 5), edges)
    polish = Polish()
    state.search("test", [polish])
    assert not list(polish.offers(state, 6)), "each was solved from its neighbours, once"
    first, before, middle, behind, _ = state.places
    found, middle.incumbent = middle.incumbent, first.incumbent
    offers = [x for x in Polish().offers(state, 6) if x.place is middle]
    assert any(offers[0].start is x.incumbent for x in (before, behind))
    polish = Polish()
    state.search("test", [polish])
    assert middle.incumbent.J == pytest.approx(found.J, abs=1e-6)
    assert False not in polish.idle, "the search from there has gained"
    assert not list(polish.offers(state, 6))


def test_a_point_on_another_branch_than_its_neighbours_is_solved_from_these() -> None:
    """A minimum in x at 1 is worse by a tenth than that at 0, on the same normals."""

    def branches(theta: Floats) -> Derivatives:
        x, t = theta
        well = np.poly1d([1, -2.2, 1.3, 0, 0])
        slope, bend = well.deriv()(x), well.deriv(2)(x)
        J = np.array([t**2, (t - 1) ** 2]) + well(x) + 0.1
        dJ = np.array([[slope, 2 * t], [slope, 2 * (t - 1)]])
        return J, dJ, np.array([[[bend, 0], [0, 2.0]]] * 2)

    problem = box(branches, [-1, -1], [2, 2])
    edges = [[0.0, 0.0], [0.0, 1.0]]
    points = points_between(problem, edges, 5)
    state = state_of(problem, points, [*edges, [0.0, 0.3], [0.0, 0.7]])
    middle = state.places[2]
    start = begin(problem.evaluate(np.array([1.0, 0.4])))
    middle.incumbent, middle.closed = points[2].solve(problem, start), True
    assert middle.incumbent.theta == pytest.approx([1.0, 0.5], abs=1e-4)
    state.search("test", [Polish()])
    assert middle.incumbent.theta == pytest.approx([0.0, 0.5], abs=1e-4)


def ended(J: float, tries: int, gains: int, counts: list[int]) -> tuple[Minima, Place]:
    """Return minima of one objective, of values J, J + 1 and so on, and the place of the first."""
    ends = [begin(Evaluation(np.zeros(1), np.array([J + k]))) for k in range(len(counts))]
    return Minima(tries, gains, ends, counts), Place(Least(0, np.ones(1), "J"), ends[0])


@given(st.integers(2, 60), st.integers(0, 60), st.lists(st.integers(1, 5), min_size=1))
def test_the_chance_of_a_start_is_what_is_not_covered(
    tries: int, gains: int, counts: list[int]
) -> None:
    known, place = ended(1.0, tries, min(gains, tries), counts)
    w = len(counts)
    N = sum(counts)
    assert known.unseen() == (min(w * (w + 1) / (N * (N - 1)), 1.0) if N > 1 else 1.0)
    assert known.hits(place, TOLERANCE) == counts[0]
    rare = counts[0] < SURE
    least = min(known.unseen(), (known.gains + 1) / (tries + 2))
    assert known.chance(place, TOLERANCE) == (known.unseen() if rare else least)
    assert Minima(9).unseen() == 1.0, "nothing is known of what starts say that met no minimum"
    assert Minima(9, lost=9).chance(place, TOLERANCE) == 0.1, "the next one is likely to be lost"


def test_starts_that_lead_to_the_same_value_are_counted_together() -> None:
    known, place = ended(1.0, 5, 1, [1, 1])
    for J in (1.0 + 0.5 * TOLERANCE, 2.0, 5.0):
        known.note(place, given_model(Evaluation(np.zeros(1), np.array([J]))), TOLERANCE)
    assert known.counts == [2, 2, 1]
    assert known.hits(place, TOLERANCE) == 2
    better = replace(place, incumbent=begin(Evaluation(np.zeros(1), np.array([0.5]))))
    assert known.hits(better, TOLERANCE) == 0


def test_of_minima_as_low_as_an_edge_those_behind_it_are_counted_together() -> None:
    J = np.array([[1.0, 3.0], [1.0, 5.0], [1.0, 9.0], [1.0, 3.0], [2.0, 1.0], [1.0, 7.0]])
    ends = [given_model(Evaluation(np.zeros(1), x)) for x in J]
    place, known = Place(Least(0, np.ones(2), "J"), ends[0]), Minima()
    for end in ends:
        known.note(place, end, TOLERANCE)
    assert known.counts == [2, 3, 1]


def test_starts_that_end_at_the_limit_of_iterations_have_met_no_minimum() -> None:
    known, place = ended(1.0, 10, 1, [1, 1])
    for J in (1.0, 2.0, 5.0):
        known.note(place, begin(Evaluation(np.zeros(1), np.array([J]))), TOLERANCE)
    assert known.counts == [1, 1]
    assert known.unseen() == 1.0, "two starts that met two minima"


def test_starts_begin_at_the_problem_s_own_and_cover_each_range_evenly() -> None:
    problem = box(many_minima, [-4, -4], [4, 4])
    state = state_of(problem, anchors(problem)[:1], [[0.0, 0.0]])
    thetas = [
        offer.start.theta for offer in Starts(np.random.default_rng(0)).offers(state, USUAL + 1)
    ]
    assert thetas[0].tolist() == problem.start.tolist()
    block = np.array(thetas[1:])
    assert block.shape == (USUAL, 2)
    cells = np.floor((block + 4) / 8 * USUAL).astype(int)
    assert (np.sort(cells, axis=0) == np.arange(USUAL)[:, None]).all()


def test_starts_that_are_all_lost_end() -> None:
    problem = box(many_minima, [-4, -4], [4, 4])
    state = state_of(problem, anchors(problem)[:1], [[0.0, 0.0]])
    starts, tries = Starts(np.random.default_rng(0)), 0
    lost = Outcome(begin(infeasible(np.zeros(2), 2)), np.zeros((0, 2)), np.zeros((0, 2)), 1)
    while (offer := next(starts.offers(state, 1))).chance >= Search().doubt:
        starts.learn(state, offer, lost, 0.0)
        tries += 1
    assert 1 / Search().doubt - 1 <= tries <= 1 / Search().doubt


def test_as_many_starts_at_a_time_as_are_needed() -> None:
    problem = box(many_minima, [-4, -4], [4, 4])
    state = state_of(problem, anchors(problem)[:1], [[0.0, 0.0]])
    starts = Starts(np.random.default_rng(0))
    known = starts.of(state.places[0])
    known.ends, known.counts, known.tries = [state.places[0].incumbent], [5], 5
    chances = [offer.chance for offer in starts.offers(state, 6)]
    assert sum(chance >= Search().doubt for chance in chances) == 2, "after seven, one is enough"


def test_starts_find_all_minima_and_then_stop() -> None:
    """The least of two unequal wells, and of a third one, are told apart by their values."""

    def wells(theta: Floats) -> Derivatives:
        (x,) = theta
        r = np.array([x**3 - 3 * x, 0.1 * x - 0.3])
        dr = np.array([3 * x**2 - 3, 0.1])
        J = np.array([r @ r])
        return J, np.array([[2 * r @ dr]]), np.array([[[2 * dr @ dr]]])

    problem = box(wells, [-3.0], [3.0], 1)
    state = state_of(problem, [Least(0, np.ones(1), "J1")], [[0.0]])
    starts = Starts(np.random.default_rng(0))
    state.search("test", [Polish(), starts])
    known = starts.of(state.places[0])
    ends = sorted(round(float(x.theta[0]), 1) for x in known.ends)
    assert ends == [-1.7, 0.0, 1.7]
    assert state.places[0].incumbent.theta == pytest.approx([np.sqrt(3)], abs=0.02)
    assert known.chance(state.places[0], TOLERANCE) < Search().doubt


def test_an_edge_that_hardly_any_start_leads_to_is_doubtful() -> None:
    def rugged(theta: Floats) -> Derivatives:
        """A bowl with waves of random phases, all over it, beside a smooth one."""
        phase = np.array([1.0, 2.5, 4.1, 0.3])
        waves, k = np.sin(23 * theta + phase), 23.0
        J = np.array([9 + theta @ theta / 8 + 2 * waves.sum(), 1 + theta @ theta])
        dJ = np.array([theta / 4 + 2 * k * np.cos(k * theta + phase), 2 * theta])
        H = np.array([np.diag(0.25 - 2 * k**2 * waves), 2 * np.eye(4)])
        return J, dJ, H

    problem = box(rugged, [-1.0] * 4, [1.0] * 4)
    search = Search(evaluations=2000)
    front = pareto_front(problem, ONES, Pareto(points=4), seed=1, search=search)
    rough, smooth = front.edges
    assert rough.doubtful
    assert rough.found > rough.starts / 2
    assert not smooth.doubtful
    assert smooth.found == 1
    assert all(x.converged for x in front_points(front)), "the other half is for the points"


@given(st.integers(0, 2**31))
def test_children_lie_within_the_bounds(seed: int) -> None:
    problem = box(circles, [-0.1, -2.0], [1.0, 0.1])
    edges = [[0.0, 0.0], [1.0, 0.0]]
    state = state_of(problem, anchors(problem), [*edges, [0.5, 0.1], [-0.1, -2.0]])
    rng = np.random.default_rng(seed)
    evolution = Evolution(rng, lambda _: 0.0)
    assert not list(evolution.offers(state, 6)), "what is open is polished first"
    for place in state.places:
        place.closed = True
    offer, *more = evolution.offers(state, 6)
    assert [x.chance for x in (offer, *more)] == [1 / 2, 1 / 3, 1 / 4, 1 / 5, 1 / 6, 1 / 7]
    (children,) = offer.arguments
    assert children.shape == (USUAL, 2)
    assert (children >= problem.lower).all()
    assert (children <= problem.upper).all()
    assert offer.place is None
    outcome = recorded(offer.function, None, problem, *offer.arguments)
    assert outcome.evaluations == USUAL


def test_evolution_alone_comes_close_to_an_edge() -> None:
    problem = box(circles, [-5, -5], [5, 5])
    state = state_of(problem, anchors(problem), [[-4.0, 3.0], [4.0, -3.0], [2.0, 4.0]])
    for place in state.places:
        place.closed = True
    rng = np.random.default_rng(0)
    evolution = Evolution(rng, lambda _: 0.0)
    for _ in range(40):
        for place in state.places:
            place.closed = True
        offer = next(evolution.offers(state, 6))
        (outcome,) = state.run([Task(("children",), offer.function, (problem, *offer.arguments))])
        state.tell(None, offer.start, outcome)
    assert np.abs(state.places[0].incumbent.theta).max() < 0.5


@dataclass
class Given:
    """A proposer from outside: models that somebody has an idea of, once."""

    thetas: Floats
    told: list[tuple[Outcome, float]] = field(default_factory=list)
    asked: int = 0

    def offers(self, state: State, most: int, /) -> Iterator[Offer]:
        """Yield one evaluation of all models."""
        self.asked += 1
        assert most > 0
        if not self.told:
            yield Offer(None, at(self.thetas[0]), 0.9, evaluated_all, (self.thetas,))

    def learn(self, state: State, offer: Offer, outcome: Outcome, gain: float, /) -> None:
        """Remember what was found."""
        self.told.append((outcome, gain))


def test_a_proposer_from_outside_is_asked_and_told() -> None:
    problem = box(three_wells, [-1, -1.5], [2, 1.5])
    edges = [[0.0, -1.0], [1.0, 1.0]]
    state = state_of(problem, points_between(problem, edges, 9), edges)
    mine = Given(np.array([[0.5, 0.0], [0.8, 0.0], [-1.0, -1.5]]))
    state.search("test", [Polish(), mine])
    assert mine.asked >= 2
    ((outcome, _),) = mine.told
    assert outcome.evaluations == 3
    assert len(outcome.J) == 2, "the third is dominated"
    # Whatever is better than an incumbent takes its place, and is polished from there.
    assert sum(abs(place.incumbent.theta[1]) < 0.5 for place in state.places) >= 5
    assert all(place.closed and place.incumbent.converged for place in state.places)


def test_offers_below_the_doubt_are_not_made_and_the_likeliest_come_first() -> None:
    @dataclass
    class Hoping(Given):
        chance: float = 0.0

        def offers(self, state: State, most: int, /) -> Iterator[Offer]:
            for offer in super().offers(state, most):
                yield replace(offer, chance=self.chance)

    problem = box(circles, [-2, -2], [2, 2])
    state = state_of(problem, anchors(problem), [[0.5, 0.0]])
    one, two = (
        Hoping(np.ones((1, 2)), chance=0.04),
        Hoping(np.ones((2, 2)), chance=0.06),
    )
    three = Hoping(np.ones((3, 2)), chance=0.5)
    state.search("test", [one, two, three])
    assert not one.told
    assert one.asked == two.asked == 2
    assert state.turn == 1
    assert state.evaluations == 5
    assert at(np.ones(2)).theta.tolist() == [1.0, 1.0]


def test_what_gains_most_for_its_cost_comes_first() -> None:
    problem = box(circles, [-2, -2], [2, 2])
    state = state_of(problem, anchors(problem), [[0.5, 0.0]])
    order: list[int] = []

    @dataclass
    class Costly(Given):
        count: int = 0

        def offers(self, state: State, most: int, /) -> Iterator[Offer]:
            if len(self.told) < 3:
                theta = np.ones((self.count, 2))
                yield Offer(None, at(theta[0]), 0.5, evaluated_all, (theta,))

        def learn(self, state: State, offer: Offer, outcome: Outcome, gain: float, /) -> None:
            super().learn(state, offer, outcome, gain)
            order.append(self.count)

    class Cheap(Costly):
        pass

    costly, cheap = Costly(np.zeros((0, 2)), count=30), Cheap(np.zeros((0, 2)), count=2)
    state.search("test", [costly, cheap])
    assert order == [30, 2, 2, 30, 2, 30], "nothing is known of the first ones"


def test_an_evolution_goes_on_while_unseen_minima_are_likely() -> None:
    problem = box(circles, [-5, -5], [5, 5])
    state = state_of(problem, anchors(problem), [[0.5, 0.0]])
    for place in state.places:
        place.closed = True
    rng = np.random.default_rng(0)
    idle = Evolution(rng, lambda _: 0.4, idle=98)
    (offer,) = idle.offers(state, 1)
    assert offer.chance == 0.4
    assert offer.expected == 0.4 / 100


def test_a_start_that_is_better_than_its_solution_stays() -> None:
    problem = box(circles, [-2, -2], [2, 2])
    (point,) = points_between(problem, [[0.0, 0.0], [1.0, 0.0]], 2)[1:2]
    state = state_of(problem, [point], [[0.5, 0.0]])
    (place,) = state.places
    start = place.incumbent
    worse = begin(problem.evaluate(np.array([0.5, 0.1]), second=True))
    lost = point.gain(start.J, worse)
    state.limits = Search(tolerance=0.9 * lost)
    outcome = Outcome(worse, worse.theta[None], worse.J[None], 1)
    state.tell(place, start, outcome)
    assert place.incumbent is start
    state.limits, place.closed = Search(tolerance=1.1 * lost), False
    state.tell(place, start, outcome)
    assert place.incumbent is worse


def test_at_the_budget_models_that_wait_for_evaluation_are_of_all_places() -> None:
    problem = box(circles, [-2, -2], [2, 2])
    state = state_of(problem, anchors(problem), [[0.5, 0.0]])
    for place in state.places:
        place.closed = True
    state.evaluations, state.limits = 1, Search(evaluations=1)
    state.search("test", [Given(np.ones((1, 2)))])
    assert state.open == {place.subproblem.key for place in state.places}


def test_models_that_cannot_be_evaluated_do_not_compete() -> None:
    def hole(theta: Floats) -> Derivatives:
        J, dJ, H = bowls(theta)
        return (J if theta[0] < 0.6 else J + np.inf), dJ, H

    problem = box(hole, [-2, -2], [2, 2], 3)
    state = state_of(problem, anchors(problem), [[0.1, 0.1]])
    before = [place.incumbent for place in state.places]
    outcome = recorded(lambda of: begin(of.evaluate(np.array([1.0, 0.0]))), None, problem)
    assert state.tell(state.places[0], before[0], outcome) == 0.0
    assert all(x is place.incumbent for x, place in zip(before, state.places, strict=True))
    assert len(state.archive.models) == 1


def test_a_solution_that_failed_is_no_model_of_the_archive() -> None:
    problem = box(bowls, [-2, -2], [2, 2], 3)
    theta = np.array([0.3, 0.2])

    def broken(of: Problem) -> Solution:
        found = of.evaluate(theta)
        return begin(replace(found, J=np.full(3, np.nan)))

    outcome = recorded(broken, None, problem)
    assert not outcome.result.feasible
    (model,) = outcome.models
    assert model.J == pytest.approx(problem.evaluate(theta).J)


@pytest.mark.parametrize(("status", "closed"), [("EXHAUSTED", False), ("CONVERGED", True)])
def test_what_gained_until_the_limit_of_iterations_is_searched_on(
    status: str, closed: bool
) -> None:
    problem = box(circles, [-1, -1], [2, 2])
    state = state_of(problem, anchors(problem)[:1], [[0.5, 0.5]])
    place = state.places[0]

    def moved(of: Problem, share: float) -> Solution:
        better = of.evaluate(share * place.incumbent.theta)
        return replace(begin(better), status=Status[status])

    state.tell(place, place.incumbent, recorded(moved, None, problem, 0.5))
    assert place.incumbent.theta.tolist() == [0.25, 0.25]
    assert place.closed == closed
    state.tell(place, place.incumbent, recorded(moved, None, problem, 1.0))
    assert place.closed, "it gains no more"
