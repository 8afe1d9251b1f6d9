"""The parts of sequential quadratic programming, and programmes with a maximum."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
import scipy.optimize
from exact import Residuals, squares
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from problems import Derivatives, Known, bowls, box, circles, curved, sphere

from modefront._typing import Floats
from modefront.optim.linearised import augmented, projected, surplus
from modefront.optim.problem import Evaluation, Residual
from modefront.optim.scalarisation import Scalarisation, achievement, below, total, weighted
from modefront.optim.sqp import Options, Solution, Status, begin, learned_from, solve

SEEDS = st.integers(0, 2**31)
LEVELS = 1e-4 * np.ones(2), np.eye(2), np.zeros(2)
SUM = weighted(np.ones(2))


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
    programme = below(np.array([0.0, 1.0]), np.array([1.0, 0.0]), 0.16)
    result = solve(problem, programme, begin(problem.evaluate(np.array([0.1, 0.3]))))
    assert result.converged
    assert result.theta == pytest.approx([0.4, 0.16], abs=1e-6)
    # Its weights are those of the weighted sum with the same solution.
    assert result.weights[0] / result.weights[1] == pytest.approx(0.6 / 0.4, rel=1e-5)


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


def test_factors_are_moved_by_their_logarithms() -> None:
    """Squares of ln(theta / (2, 5)) are one step away where theta are factors about 1."""

    def decades(theta: Floats) -> Derivatives:
        r = np.log(theta / [2.0, 5.0])
        H = np.diag((1 - r) / theta**2)
        return np.array([r @ r]), 2 * (r / theta)[None], 2 * H[None]

    factors = replace(box(decades, [0.1, 0.1], [10.0, 10.0], 1), start=np.ones(2))
    lengths = replace(factors, start=np.full(2, 5.0))
    one, other = (
        solve(x, weighted(np.ones(1)), begin(x.evaluate(np.full(2, 4.0))), Options(radius=1.0))
        for x in (factors, lengths)
    )
    for result in (one, other):
        assert result.converged
        assert result.theta == pytest.approx([2.0, 5.0], rel=1e-6)
    assert one.evaluations == 1 < other.evaluations
    corner = solve(factors, weighted(np.array([-1.0])), begin(factors.evaluate(np.ones(2))))
    assert set(corner.theta) <= {0.1, 10.0}


@pytest.mark.parametrize("seed", range(12))
def test_rounding_of_residuals_is_no_jump(seed: int) -> None:
    """Residuals of 1e-4 with errors of 1e-13: the objective has relative errors of 1e-9."""
    rng = np.random.default_rng(seed)
    A, b = rng.normal(size=(6, 3)) * [1.0, 0.1, 0.01], 1e-4 * rng.normal(size=6)

    class Rounded(Known):
        def evaluate(
            self, theta: Floats, *, derivatives: bool = True, second: bool = False
        ) -> Evaluation:
            r = A @ (theta + theta**2 / 2) - b
            r += 1e-13 * np.sin(1e12 * theta.sum() + np.arange(6))
            dr = A * (1 + theta)
            H = 2 * (dr.T @ dr + np.diag(r @ A))
            J, dJ = np.array([r @ r]), 2 * r[None] @ dr
            return Evaluation(theta, J, dJ, H[None], True, residuals=[Residual(r, dr)])

    x = box(circles, [-0.9] * 3, [0.9] * 3, 1)
    problem = Rounded(x.function, x.lower, x.upper, x.start, x.objectives)
    tight = Options(step=1e-8, reduction=1e-24)
    assert solve(problem, weighted(np.ones(1)), begin(problem.evaluate(x.start)), tight).converged


@pytest.mark.parametrize(("step", "status"), [(0.2, Status.CONVERGED), (3.0, Status.JUMP)])
def test_a_jump_is_told_from_a_minimum_and_its_other_side_is_tried(
    step: float, status: Status
) -> None:
    """(x - 1)**2 + y**2 falls up to x = 0.3, where it jumps up by a step."""

    def jumping(theta: Floats) -> Derivatives:
        behind = step * (theta[0] > 0.3)
        J = np.array([(theta[0] - 1) ** 2 + theta[1] ** 2 + behind])
        return J, 2 * (theta - [1.0, 0.0])[None], 2 * np.eye(2)[None]

    problem = box(jumping, [-2, -2], [2, 2], 1)
    result = solve(problem, weighted(np.ones(1)), begin(problem.evaluate(-np.ones(2))))
    assert result.status is status
    assert result.J[0] == pytest.approx(step if result.converged else 0.49, abs=1e-2)
    assert result.evaluations < 50


@pytest.mark.parametrize("programme", [SUM, achievement(*LEVELS)])
@settings(max_examples=15)
@given(seed=SEEDS)
def test_a_jump_is_followed_where_a_problem_knows_it(programme: Scalarisation, seed: int) -> None:
    """Two bowls around (1, 0) and (1, 1), which end at the curve x + y**2 = 0.2."""

    def smooth(theta: Floats) -> Derivatives:
        r = theta - np.array([[1.0, 0.0], [1.0, 1.0]])
        wall = theta[0] + theta[1] ** 2 - 0.2
        J = np.append((r**2).sum(axis=1), wall)
        dJ = np.vstack([2 * r, [1.0, 2 * theta[1]]])
        return J, dJ, np.array([2 * np.eye(2)] * 2 + [np.zeros((2, 2))])

    @dataclass(frozen=True)
    class Jumping(Known):
        def continued(self, inside: Evaluation, beyond: Evaluation) -> Known:
            assert smooth(inside.theta)[0][2] <= 0 < smooth(beyond.theta)[0][2]
            return box(smooth, [-2, -2], [2, 2], 3)

    def jumping(theta: Floats) -> Derivatives:
        J, dJ, H = smooth(theta)
        return J[:2] + 9.0 * (J[2] > 0), dJ[:2], H[:2]

    x = box(jumping, [-2, -2], [2, 2])
    problem = Jumping(x.function, x.lower, x.upper, x.start, x.objectives)
    theta = np.random.default_rng(seed).uniform(-2, [-1.0, 1.5])
    assume(smooth(theta)[0][2] < -0.1)
    result = solve(problem, programme, begin(problem.evaluate(theta)))
    y = np.linspace(-2, 2, 4001)
    J = (0.8 + y**2) ** 2 + np.array([y, y - 1]) ** 2  # along the curve
    value = J.sum(axis=0) if programme is SUM else LEVELS[0] @ J + J.max(axis=0)
    assert total(programme, result.J) == pytest.approx(value.min(), abs=1e-4)
    assert result.status is Status.JUMP


@settings(max_examples=15)
@given(seed=SEEDS)
def test_two_jumps_that_meet_are_followed_together(seed: int) -> None:
    """A bowl around (1, 1), which ends at the curves x + y**2 = 0.2 and x / 2 + y = 0.3."""

    def walls(theta: Floats) -> tuple[Floats, Floats]:
        x, y = theta
        g = np.array([x + y**2 - 0.2, x / 2 + y - 0.3])
        return g, np.array([[1.0, 2 * y], [0.5, 1.0]])

    @dataclass(frozen=True)
    class Jumping(Known):
        passed: tuple[int, ...] = ()

        def continued(self, inside: Evaluation, beyond: Evaluation) -> Known | None:
            crossed = [
                k for k in np.flatnonzero(walls(beyond.theta)[0] > 0) if k not in self.passed
            ]
            return jumping(*self.passed, int(crossed[0])) if crossed else None

    def jumping(*passed: int) -> Known:
        def function(theta: Floats) -> Derivatives:
            (g, dg), rows = walls(theta), list(passed)
            J = ((theta - 1) ** 2).sum() + 9.0 * (np.delete(g, rows) > 0).any()
            H = np.array([2 * np.eye(2), *[np.zeros((2, 2))] * len(rows)])
            return np.append(J, g[rows]), np.vstack([2 * (theta - 1), dg[rows]]), H

        x = box(function, [-2, -2], [2, 2], 1 + len(passed))
        return Jumping(x.function, x.lower, x.upper, x.start, x.objectives, passed)

    theta = np.random.default_rng(seed).uniform(-2, [0.0, 0.3])
    assume((walls(theta)[0] < -0.1).all())
    problem = jumping()
    result = solve(problem, weighted(np.ones(1)), begin(problem.evaluate(theta)))
    x = (np.sqrt(0.6) - 0.7) / 0.5
    np.testing.assert_allclose(result.theta, [x, 0.3 - x / 2], atol=1e-5)
    assert result.status is Status.JUMP
    assert result.evaluations < 80


def test_an_exhausted_search_says_so() -> None:
    problem = box(curved, [-2, -2], [2, 2])
    start = begin(problem.evaluate(np.array([1.9, -1.9])))
    result = solve(problem, weighted(np.ones(2)), start, Options(iterations=1))
    assert result.status is Status.EXHAUSTED
    assert not result.converged


@pytest.mark.parametrize(
    ("share", "places"),
    [
        (0.9, [0.2, 0.5, 1.0]),
        (0.5, [0.2, 0.35, 0.5]),
        (0.2, [0.2, 0.275, 0.3125]),
        (-0.5, [0.2, 0.0875, 0.059375]),
        (np.inf, [0.2, 0.5, 0.275, 0.425, 0.3125, 0.284375]),
    ],
)
def test_steps_are_as_long_as_what_they_promise_is_kept(share: float, places: list[float]) -> None:
    """Steps of 0.15 and more that fall by a share of what they promise, or up to where J ends."""
    tried: list[float] = []

    def slope(theta: Floats) -> Derivatives:
        tried.append(float(theta[0]))
        J = -(share if np.isfinite(share) else 1.0) * theta
        ends = theta[0] > 0.3 and not np.isfinite(share)
        return np.where(ends, np.inf, J), -np.ones((1, 1)), np.zeros((1, 1, 1))

    problem = replace(box(slope, [0.0], [1.0], 1), start=np.array([0.05]))
    start = begin(problem.evaluate(problem.start))
    limit = Options(iterations=len(places) + 1)
    assert solve(problem, weighted(np.ones(1)), start, limit).status in (
        Status.EXHAUSTED,
        Status.CONVERGED,
    )
    assert tried[1 : len(places) + 1] == pytest.approx(places, abs=1e-9)


def rosenbrock(theta: Floats) -> Residuals:
    x, y = theta
    return [(np.array([10 * (y - x**2), 1 - x]), np.array([[-20 * x, 10.0], [-1.0, 0.0]]))]


def beale(theta: Floats) -> Residuals:
    x, y = theta
    k = np.arange(1, 4)
    slopes = np.column_stack([y**k - 1, x * k * y ** (k - 1)])
    return [(np.array([1.5, 2.25, 2.625]) - x * (1 - y**k), slopes)]


def wood(theta: Floats) -> Residuals:
    A = np.sqrt([[0, 100, 0, 0], [1, 0, 0, 0], [0, 0, 0, 90], [0, 0, 1, 0], [0, 10, 0, 10]])
    A = np.vstack([A * [1, 1, -1, 1], np.sqrt(0.1) * np.array([0, 1, 0, -1])])
    A[2, 2], A[3, 2], A[1, 0] = 0.0, -1.0, -1.0
    bend = np.zeros((6, 4))
    bend[0, 0], bend[2, 2] = -10.0, -np.sqrt(90)
    r = A @ theta + bend @ theta**2 + [0, 1, 0, 1, -2 * np.sqrt(10), 0]
    return [(r, A + 2 * bend * theta)]


@pytest.mark.parametrize(
    ("function", "start", "best", "exact", "most"),
    [
        (rosenbrock, [-1.2, 1.0], [1, 1], True, 10),
        (rosenbrock, [-1.2, 1.0], [1, 1], False, 35),
        (beale, [1.0, 1.0], [3, 0.5], True, 12),
        (beale, [1.0, 1.0], [3, 0.5], False, 9),
        (wood, [-3.0, -1.0, -3.0, -1.0], [1, 1, 1, 1], True, 34),
        (wood, [-3.0, -1.0, -3.0, -1.0], [1, 1, 1, 1], False, 70),
    ],
)
def test_bent_valleys_take_few_evaluations(
    function: Callable[[Floats], Residuals],
    start: list[float],
    best: list[float],
    exact: bool,
    most: int,
) -> None:
    """Problems of Moré, Garbow & Hillstrom (1981), with exact second derivatives or without."""
    problem = squares(function, [-5.0] * len(start), [5.0] * len(start), 1, exact)
    result = solve(problem, weighted(np.ones(1)), begin(problem.evaluate(np.array(start))))
    assert result.converged
    assert result.theta == pytest.approx(best, abs=1e-4)
    assert result.evaluations <= most


@pytest.mark.parametrize(("slope", "first"), [(0.0, {0.5, -1.5}), (1e-9, {-1.5}), (-1e-9, {0.5})])
def test_a_saddle_is_left_along_its_curvature_half_the_way_to_the_bound(
    slope: float, first: set[float]
) -> None:
    tried: list[Floats] = []

    def saddle(theta: Floats) -> Derivatives:
        tried.append(theta)
        x, y = theta
        J = np.array([x**2 - y**2 + slope * y])
        return J, np.array([[2 * x, slope - 2 * y]]), np.diag([2.0, -2.0])[None]

    problem = box(saddle, [-1.0, -3.0], [1.0, 1.0], 1)
    start = begin(problem.evaluate(np.zeros(2)))
    result = solve(problem, weighted(np.ones(1)), start, Options(radius=1.0))
    assert tried[1][0] == 0
    assert float(tried[1][1].round(6)) in first
    assert result.converged
    assert abs(result.theta[1]) in (3.0, 1.0)


# ---- merit -----------------------------------------------------------------------------------


def test_the_projection_on_the_simplex_is_defined_however_great_the_numbers() -> None:
    assert projected(np.array([3e17, 1.0, 5.0])).tolist() == [1.0, 0.0, 0.0]
    assert projected(np.array([-3e20, -3e20])).tolist() == [0.5, 0.5]


@given(SEEDS, st.integers(1, 6))
def test_the_projection_is_the_nearest_point_of_the_simplex(seed: int, m: int) -> None:
    rng = np.random.default_rng(seed)
    x = 2 * rng.normal(size=m)
    nearest = projected(x)
    assert (nearest >= 0).all()
    assert nearest.sum() == pytest.approx(1)
    # The angle to every corner is obtuse.
    assert ((np.eye(m) - nearest) @ (x - nearest)).max() <= 1e-12


@given(SEEDS, st.integers(1, 5), st.floats(0.1, 1e4))
def test_the_augmented_maximum_is_that_of_rockafellar(seed: int, m: int, nu: float) -> None:
    rng = np.random.default_rng(seed)
    y, kappa = rng.normal(size=m), projected(rng.normal(size=m))

    def above(tau: float) -> float:
        return tau + float((np.maximum(0, kappa + nu * (y - tau)) ** 2 - kappa**2).sum()) / 2 / nu

    bracket = (y.min() - 2 / nu, y.max() + 2 / nu)
    least = scipy.optimize.minimize_scalar(above, bounds=bracket, options={"xatol": 1e-12}).fun
    value = kappa @ y + surplus(y, kappa, nu)
    assert value == pytest.approx(least, abs=1e-6 / nu + 1e-9)
    assert y.max() - 1 / nu - 1e-12 <= value <= y.max() + 1e-12


@given(SEEDS, st.floats(0.1, 1e3))
def test_equal_functions_have_no_surplus(seed: int, nu: float) -> None:
    kappa = projected(np.random.default_rng(seed).normal(size=4))
    assert surplus(np.full(4, 0.7), kappa, nu) == pytest.approx(0, abs=1e-12)


def test_an_undefined_point_is_worse_than_any_other() -> None:
    nowhere = Evaluation(np.zeros(1), np.array([np.inf]))
    assert augmented(weighted(np.ones(1)), np.zeros(0), 10.0, nowhere) == np.inf


# ---- learned second derivatives --------------------------------------------------------------


@given(SEEDS, st.integers(1, 4), st.integers(1, 3))
def test_second_derivatives_of_quadratic_objectives_are_learned(seed: int, p: int, n: int) -> None:
    """After p steps along different directions, S is the part that is not known."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(n, p, p))
    full = np.einsum("ijk,ilk->ijl", root, root) + np.eye(p)
    assume(np.linalg.cond(full).max() < 1e3)

    def evaluation(theta: Floats) -> Evaluation:
        return Evaluation(theta, np.zeros(n), full @ theta, np.zeros((n, p, p)))

    S, position = np.zeros((n, p, p)), evaluation(rng.normal(size=p))
    for step in np.linalg.qr(rng.normal(size=(p, p)))[0]:
        new = evaluation(position.theta + step)
        S, position = learned_from(S, position, new), new
        assert S @ step == pytest.approx(full @ step), "the last step is reproduced"
        assert S == pytest.approx(S.transpose(0, 2, 1))


def test_only_what_adds_to_known_second_derivatives_shrinks_with_them() -> None:
    """A residual alone has no known part: its curvature changes sign without being forgotten."""
    s = np.array([1.0, 0.0])

    def at(theta: Floats, slope: Floats, H: Floats) -> Evaluation:
        return Evaluation(theta, np.zeros(1), slope[None], H[None])

    for H, kept in ((np.zeros((2, 2)), 1.0), (np.diag([0.0, 1.0]), 0.0)):
        S = np.diag([1.0, 1.0])[None]
        new = learned_from(S, at(0 * s, 0 * s, H), at(s, 0 * s, H))
        assert new[0] == pytest.approx(np.diag([0.0, kept]))


# ---- programmes with a maximum ---------------------------------------------------------------


def minimax(problem: Known, programme: Scalarisation) -> float:
    """Return the least f + max that SLSQP finds from many starts."""
    rng, best = np.random.default_rng(0), np.inf
    p, rows = problem.lower.size, programme.maximised

    def J(theta: Floats) -> Floats:
        return problem.function(np.clip(theta, problem.lower, problem.upper))[0]

    for _ in range(12):
        theta = rng.uniform(problem.lower, problem.upper)
        result = scipy.optimize.minimize(
            lambda x: programme.value(J(x[:p])) + x[p],
            np.append(theta, rows.at(J(theta)).max()),
            method="SLSQP",
            bounds=[*zip(problem.lower, problem.upper, strict=True), (None, None)],
            constraints={"type": "ineq", "fun": lambda x: x[p] - rows.at(J(x[:p]))},
            options={"ftol": 1e-13, "maxiter": 300},
        )
        reached = J(result.x[:p])
        best = min(best, programme.value(reached) + rows.at(reached).max())
    return best


@pytest.mark.parametrize(
    ("function", "lower", "upper"),
    [
        (bowls, [-2.0, -2.0], [2.0, 2.0]),
        (bowls, [0.1, -2.0], [2.0, 0.3]),
        (sphere, [0.0, 0.0, 0.0], [1.0, 1.0, 1.0]),
    ],
)
@pytest.mark.parametrize("seed", range(3))
def test_the_least_maximum_is_that_of_an_independent_solver(
    function: Callable[[Floats], Derivatives], lower: list[float], upper: list[float], seed: int
) -> None:
    rng = np.random.default_rng(seed)
    problem = box(function, lower, upper, 3)
    point = rng.dirichlet(np.ones(3)) - 0.2
    programme = achievement(np.full(3, 1e-3), np.diag(rng.uniform(0.5, 2, 3)), point)
    starts = rng.uniform(problem.lower, problem.upper, (12, len(lower)))
    result = [solve(problem, programme, begin(problem.evaluate(theta))) for theta in starts]
    assert all(solution.converged for solution in result)
    assert max(solution.evaluations for solution in result) <= 20
    values = [
        programme.value(solution.J) + programme.maximised.at(solution.J).max()
        for solution in result
    ]
    assert min(values) == pytest.approx(minimax(problem, programme), abs=1e-6)
    # The weights are those of a stationary Lagrangian: no parameter within its bounds gains.
    for solution in result:
        slope = solution.weights @ solution.evaluation.dJ
        inside = (solution.theta > problem.lower + 1e-6) & (solution.theta < problem.upper - 1e-6)
        assert slope[inside] == pytest.approx(0, abs=1e-4)
        assert (solution.weights > 0).all()


@pytest.mark.parametrize("slope", [1e1, 1e2, 1e3, 1e4])
def test_a_penalty_is_exact_whatever_its_slope_if_that_is_above_the_multiplier(
    slope: float,
) -> None:
    """The least J2 where J1 and J3 are equal, from far away; the multiplier is 0.5."""
    problem = box(bowls, [-2.0, -2.0], [2.0, 2.0], 3)
    start = begin(problem.evaluate(np.array([-1.7, 1.9])))
    rows = np.array([[1.0, 0.0, -1.0], [-1.0, 0.0, 1.0]])
    result = solve(problem, achievement(np.eye(3)[1], rows, np.zeros(2), slope), start)
    assert result.converged
    assert result.evaluations < 30
    assert result.theta == pytest.approx([1.0, 0.5], abs=1e-6)


def test_a_point_between_equal_functions_is_no_minimum_where_the_curvature_is_negative() -> None:
    """Max of x - y**2 and -x - y**2: from x = y = 0, y leads on to its bounds."""

    def ridge(theta: Floats) -> Derivatives:
        x, y = theta
        J = np.array([x - y**2, -x - y**2])
        H = np.zeros((2, 2, 2))
        H[:, 1, 1] = -2.0
        return J, np.array([[1.0, -2 * y], [-1.0, -2 * y]]), H

    problem = box(ridge, [-1.0, -1.0], [1.0, 1.0])
    programme = achievement(np.zeros(2), np.eye(2), np.zeros(2))
    result = solve(problem, programme, begin(problem.evaluate(np.zeros(2))))
    assert result.status is Status.CONVERGED
    assert np.abs(result.theta) == pytest.approx([0.0, 1.0], abs=1e-6)
    assert result.J.max() == pytest.approx(-1.0, abs=1e-6)


def least_of(
    function: Callable[[Floats], Derivatives], start: list[float], options: Options
) -> Solution:
    """Return the minimum of a single objective of two parameters within -1 and 2."""
    problem = box(function, [-1.0, -1.0], [2.0, 2.0], 1)
    first = begin(problem.evaluate(np.array(start)))
    return solve(problem, weighted(np.ones(1)), first, options)


def test_a_search_rests_where_only_rounding_is_left() -> None:
    """J = 1 + x**2, and rounding of a great model along y."""

    def noisy(theta: Floats) -> Derivatives:
        noise = 1e-11 * np.sin(1e9 * theta[::-1])
        J = np.array([1.0 + theta[0] ** 2 + noise[0]])
        return J, np.array([2 * theta * [1.0, 0.0] + noise]), np.array([np.diag([2.0, 1e-10])])

    result = least_of(noisy, [0.7, 0.3], Options(1e-8, reduction=1e-24))
    assert result.status is Status.CONVERGED
    assert abs(result.theta[0]) < 1e-8
    assert result.evaluations < 25


def test_a_search_does_not_rest_while_its_steps_get_shorter() -> None:
    """Steps along y go a quarter of the way, and promise less than rounding below y = 1e-3."""

    def slow(theta: Floats) -> Derivatives:
        x, y = theta
        J = np.array([1.0 + x**2 + y**4])
        return J, np.array([[2 * x, 4 * y**3]]), np.array([np.diag([2.0, 16 * y**2])])

    result = least_of(slow, [0.7, 0.9], Options(1e-5, reduction=1e-24))
    assert result.status is Status.CONVERGED
    assert abs(result.theta[1]) < 1.3e-4
