"""Manifolds of equally good models that are known: curves, closed and bounded, surfaces, points."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
import scipy.optimize
from exact import Residuals, squares

from modefront._typing import Floats
from modefront.analysis import manifold
from modefront.analysis.manifold import Extent, Manifold, equivalent_models
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.scalarisation import LogSum, Scalarisation, weighted
from modefront.work.task import Costs

ONE = weighted(np.ones(1))


def follow(
    problem: Problem, programme: Scalarisation, start: Evaluation, h: float, limit: int
) -> Manifold:
    """The manifold through one minimum."""
    (result,) = equivalent_models(problem, programme, [start], h=h, limit=limit)
    return result


def circle(theta: Floats) -> Residuals:
    return [(np.array([theta @ theta - 0.49]), 2 * theta[None])]


def two_circles(theta: Floats) -> Residuals:
    """Circles around (-1, 0) and (1, 0) of radius 0.5: r is the product of the two equations."""
    a, b = theta - np.array([-1.0, 0]), theta - np.array([1.0, 0])
    f, g = a @ a - 0.25, b @ b - 0.25
    return [(np.array([f * g]), (2 * f * b + 2 * g * a)[None])]


def sphere(theta: Floats) -> Residuals:
    return [(np.array([theta @ theta - 0.64]), 2 * theta[None])]


def fitted_badly(theta: Floats) -> Residuals:
    """The curve y = x**2 on which a constant residual is left over, and z has its own."""
    x, y, z = theta
    r = np.array([y - x**2, z - 0.2, 0.3])
    return [(r, np.array([[-2 * x, 1, 0], [0, 0, 1], [0, 0, 0]]))]


def thetas(models: Sequence[Evaluation]) -> Floats:
    return np.array([model.theta for model in models])


def test_a_circle_is_followed_until_it_closes(costs: Costs) -> None:
    problem = squares(circle, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.CLOSED)
    theta = thetas(result.models)
    assert np.hypot(*theta.T) == pytest.approx(0.7, abs=2e-7)
    angles = np.unwrap(np.arctan2(theta[:, 1], theta[:, 0]))
    steps = np.diff(angles)
    assert (np.sign(steps) == np.sign(steps[0])).all(), "in order along the curve"
    # h = 0.05 of ranges of 2: chords of 0.1, but where the two ends meet.
    chords, last = 0.7 * np.abs(steps), 0.7 * (2 * np.pi - np.abs(steps).sum())
    assert np.delete(chords, chords.argmin()) == pytest.approx(0.1, rel=0.01)
    assert 0.07 < last < 0.15
    assert costs.eigenproblems == pytest.approx(128, rel=0.05), "three a model"


def test_a_circle_that_the_bounds_cut_ends_on_them() -> None:
    problem = squares(circle, [-1, -0.3], [1, 0.5])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert result.extent is Extent.BOUNDED
    theta = thetas(result.models)
    ends = sorted(theta[[0, -1], 1].tolist())
    assert ends == [-0.3, 0.5]
    assert np.hypot(*theta.T) == pytest.approx(0.7, abs=2e-7)


def test_disjoint_curves_are_all_followed_and_none_twice() -> None:
    problem = squares(two_circles, [-2, -2], [2, 2])
    minima = [problem.evaluate(np.array(x)) for x in ([-0.5, 0.0], [1.0, 0.5], [-1.0, -0.5])]
    result = equivalent_models(problem, ONE, minima, h=0.03, limit=200)
    assert [each.extent for each in result] == [Extent.CLOSED] * 2
    sides = [np.sign(thetas(each.models)[:, 0]) for each in result]
    assert sorted(float(side.mean()) for side in sides) == [-1.0, 1.0]


def test_a_sphere_is_covered() -> None:
    problem = squares(sphere, [-1, -1, -1], [1, 1, 1])
    start = problem.evaluate(np.array([0.0, 0.0, 0.8]))
    result = follow(problem, ONE, start, h=0.15, limit=400)
    assert (result.dimension, result.extent) == (2, Extent.CLOSED)
    theta = thetas(result.models)
    assert np.linalg.norm(theta, axis=1) == pytest.approx(0.8, abs=2e-7)
    rng = np.random.default_rng(0)
    directions = rng.normal(size=(2000, 3))
    anywhere = 0.8 * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    away = np.linalg.norm(anywhere[:, None] - theta, axis=2).min(axis=1)
    # Steps are 0.3 in theta; no place on the sphere is farther than that from a sample.
    assert away.max() < 0.3
    apart = np.linalg.norm(theta[:, None] - theta, axis=2) + 9 * np.eye(len(theta))
    assert apart.min() > 0.3 * 0.5


def test_a_sphere_within_narrow_bounds_ends_on_them() -> None:
    problem = squares(sphere, [-1, -1, 0.3], [1, 1, 1])
    start = problem.evaluate(np.array([0.0, 0.0, 0.8]))
    result = follow(problem, ONE, start, h=0.1, limit=400)
    assert result.extent is Extent.BOUNDED
    assert thetas(result.models)[:, 2].min() == pytest.approx(0.3, abs=0.1 * 0.7 * 0.3 + 1e-9)


def many_minima(theta: Floats) -> Residuals:
    """J1 vanishes at (+-1, +-2), four models."""
    x, y = theta
    dr = np.array([[2 * x, 0], [0, 2 * y]])
    return [(np.array([x**2 - 1, y**2 - 4]), dr), (theta - np.array([1.5, -2.5]), np.eye(2))]


def test_isolated_minima_are_counted() -> None:
    problem = squares(many_minima, [-4, -4], [4, 4], 2)
    programme = weighted(np.array([1.0, 0.0]))
    minima = [problem.evaluate(np.array([x, y])) for x in (-1.0, 1.0) for y in (-2.0, 2.0)]
    result = equivalent_models(problem, programme, [*minima, minima[2]])
    assert [each.extent for each in result] == [Extent.ISOLATED] * 4
    assert [each.dimension for each in result] == [0] * 4


@pytest.mark.parametrize("programme", [ONE, LogSum(np.array([4.0]))])
def test_residuals_that_stay_do_not_hide_a_curve(programme: Scalarisation) -> None:
    problem = squares(fitted_badly, [-1, -0.5, 0], [1, 2, 1])
    start = problem.evaluate(np.array([0.1, 0.01, 0.2]))
    result = follow(problem, programme, start, h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.BOUNDED)
    x, y, z = thetas(result.models).T
    assert y == pytest.approx(x**2, abs=1e-7)
    assert z == pytest.approx(0.2, abs=1e-7)
    assert sorted([x[0], x[-1]]) == [-1, 1]


def test_a_parameter_pressed_against_its_bound_stays_there() -> None:
    problem = squares(fitted_badly, [-1, -0.5, 0.5], [1, 2, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.1, 0.01, 0.5])), h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.BOUNDED)
    assert thetas(result.models)[:, 2].tolist() == [0.5] * len(result.models)


def test_a_surface_is_followed_from_a_corner_along_the_bounds() -> None:
    def plane(theta: Floats) -> Residuals:
        return [(np.array([theta.sum() - 1.0]), np.ones((1, 3)))]

    problem = squares(plane, [0, 0, 0], [1, 1, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([1.0, 0, 0])), h=0.2, limit=100)
    assert (result.dimension, result.extent) == (2, Extent.BOUNDED)
    theta = thetas(result.models)
    assert theta.sum(axis=1) == pytest.approx(1, abs=1e-8)
    assert theta.min() == 0
    # A triangle with sides of 1.41, in steps of 0.2: nowhere farther from a sample than a step.
    rng = np.random.default_rng(0)
    anywhere = rng.dirichlet(np.ones(3), 500)
    away = np.linalg.norm(anywhere[:, None] - theta, axis=2).min(axis=1)
    assert away.max() < 0.2


def test_residuals_that_bend_but_do_not_change_hold_a_minimum(costs: Costs) -> None:
    def bowl(theta: Floats) -> Residuals:
        x, y = theta
        return [(np.array([1 + x**2, y]), np.array([[2 * x, 0], [0, 1]]))]

    problem = squares(bowl, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.zeros(2)), h=0.05, limit=20)
    assert (result.dimension, result.extent) == (0, Extent.ISOLATED)
    assert costs.eigenproblems == 2, "no step was tried"


def test_a_direction_that_bends_is_no_part_of_a_manifold() -> None:
    """J = (1 + x**2)**2 + (y - z)**2: of three parameters, two residuals change in one only."""

    def valley(theta: Floats) -> Residuals:
        x, y, z = theta
        return [(np.array([1 + x**2, y - z]), np.array([[2 * x, 0, 0], [0, 1, -1]]))]

    problem = squares(valley, [-1, -1, -1], [1, 1, 2])
    result = follow(problem, ONE, problem.evaluate(np.array([0.0, 0.3, 0.3])), h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.BOUNDED)
    x, y, z = thetas(result.models).T
    assert x == pytest.approx(0, abs=1e-8)
    assert y == pytest.approx(z, abs=1e-8)
    assert sorted([y[0], y[-1]]) == pytest.approx([-1, 1], abs=1e-12)


@pytest.mark.parametrize("programme", [ONE, LogSum(np.array([4.0]))])
def test_residuals_that_turn_leave_a_line(programme: Scalarisation) -> None:
    """r = (1 + y**2) (cos x, sin x): J is least at y = 0, where r does not change with y but x."""

    def turning(theta: Floats) -> Residuals:
        x, y = theta
        e, de = np.array([np.cos(x), np.sin(x)]), np.array([-np.sin(x), np.cos(x)])
        return [((1 + y**2) * e, np.column_stack([(1 + y**2) * de, 2 * y * e]))]

    problem = squares(turning, [-2, -1], [4, 1.5])
    start = problem.evaluate(np.array([0.5, 0.0]))
    result = follow(problem, programme, start, h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.BOUNDED)
    x, y = thetas(result.models).T
    assert y == pytest.approx(0, abs=1e-6)
    assert sorted([x[0], x[-1]]) == [-2, 4]
    assert np.abs(np.diff(x)).max() <= 0.3 + 1e-9


def turning_circle(theta: Floats) -> Residuals:
    """r = (1 + (|x|**2 - 0.49)**2) x / |x|: J is 1 on a circle along which r turns once."""
    rho2 = theta @ theta
    rho = np.sqrt(rho2)
    g, e = 1 + (rho2 - 0.49) ** 2, theta / rho
    dg = 4 * (rho2 - 0.49) * theta
    return [(g * e, np.outer(e, dg) + g * (np.eye(2) - np.outer(e, e)) / rho)]


def test_residuals_that_turn_leave_a_closed_curve(costs: Costs) -> None:
    problem = squares(turning_circle, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.CLOSED)
    theta = thetas(result.models)
    assert np.hypot(*theta.T) == pytest.approx(0.7, abs=1e-7)
    angles = np.unwrap(np.arctan2(theta[:, 1], theta[:, 0]))
    steps = np.diff(angles)
    assert (np.sign(steps) == np.sign(steps[0])).all(), "in order along the curve"
    assert np.abs(steps).sum() > 2 * np.pi - 0.3
    assert 0.7 * np.abs(steps).max() < 0.15
    assert costs.eigenproblems == pytest.approx(131, rel=0.05), "three a model"


def test_a_circle_on_which_residuals_turn_ends_on_the_bounds() -> None:
    problem = squares(turning_circle, [-1, -0.3], [1, 0.5])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert result.extent is Extent.BOUNDED
    theta = thetas(result.models)
    assert sorted(theta[[0, -1], 1].tolist()) == [-0.3, 0.5]
    assert np.hypot(*theta.T) == pytest.approx(0.7, abs=1e-7)


def test_no_more_models_than_wanted() -> None:
    problem = squares(circle, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=7)
    assert (len(result.models), result.extent) == (7, Extent.CUT)


def test_a_curve_that_ends_where_the_model_does_is_lost() -> None:
    def half(theta: Floats) -> Residuals:
        ((r, dr),) = circle(theta)
        return [(r if theta[0].real > 0.2 else r * np.inf, dr)]

    problem = squares(half, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert result.extent is Extent.LOST
    assert thetas(result.models)[:, 0].min() < 0.25


def hyperplane(theta: Floats) -> Residuals:
    """Two residuals of six parameters: a manifold of dimension 4 that is flat."""
    A = np.array([[1.0, 1, 1, 1, 1, 1], [1.0, -1, 0, 0, 0.5, 0]])
    return [(A @ theta - np.array([3.0, 0.25]), A)]


def bent(theta: Floats) -> Residuals:
    """A sphere in five dimensions."""
    return [(np.array([theta @ theta - 0.81]), 2 * theta[None])]


def extents_by_slsqp(
    residuals: Callable[[Floats], Floats], start: Floats, lower: Floats, upper: Floats
) -> Floats:
    """Ranges of each parameter where residuals vanish, (2, p), by another method."""
    out = np.zeros((2, start.size))
    for j in range(start.size):
        for row, sign in enumerate((1.0, -1.0)):
            result = scipy.optimize.minimize(
                lambda x, j=j, sign=sign: sign * x[j],
                start,
                method="SLSQP",
                bounds=list(zip(lower, upper, strict=True)),
                constraints={"type": "eq", "fun": residuals},
                options={"maxiter": 300, "ftol": 1e-12},
            )
            assert np.abs(residuals(result.x)).max() < 1e-6
            out[row, j] = result.x[j]
    return out


@pytest.mark.parametrize(
    ("function", "start", "lower", "upper", "dimension", "most"),
    [
        (hyperplane, [0.6, 0.5, 0.4, 0.5, 0.3, 0.7], [0.0] * 6, [0.9, 1, 1, 0.8, 1, 1], 4, 20),
        (bent, [0.6, 0.4, -0.4, 0.2, -0.3], [-1.0, -0.2, -1, -1, -1], [1.0, 1, 1, 1, 0.5], 4, 500),
    ],
)
def test_of_many_dimensions_each_parameter_is_followed_as_far_as_it_goes(
    function: Callable[[Floats], Residuals],
    start: list[float],
    lower: list[float],
    upper: list[float],
    dimension: int,
    most: int,
    costs: Costs,
) -> None:
    """Which of steps that are equally good is made depends on rounding: so does their number."""
    problem = squares(function, lower, upper)
    theta = np.array(start)
    if function is hyperplane:
        A = np.array([[1.0, 1, 1, 1, 1, 1], [1.0, -1, 0, 0, 0.5, 0]])
        theta = theta + np.linalg.pinv(A) @ (np.array([3.0, 0.25]) - A @ theta)
    result = follow(problem, ONE, problem.evaluate(theta), h=0.05, limit=100)
    assert (result.dimension, result.extent) == (dimension, Extent.SPANNED)
    other = thetas(result.models)
    assert max(model.J[0] for model in result.models) < 1e-12

    def residuals(x: Floats) -> Floats:
        if function is hyperplane:
            return A @ x - np.array([3.0, 0.25])
        return np.array([x @ x - 0.81])

    # An extremum on the sphere is flat: a walk ends where a step of H gains less than 1 %.
    expected = extents_by_slsqp(residuals, theta, problem.lower, problem.upper)
    reached = np.array([other.min(axis=0), other.max(axis=0)])
    assert np.abs(reached - expected).max() < 0.02 * np.ptp([lower, upper])
    assert (reached[0] >= expected[0] - 1e-6).all()
    assert (reached[1] <= expected[1] + 1e-6).all()
    assert costs.eigenproblems == result.evaluations + 1
    assert result.evaluations <= most


def test_a_manifold_is_followed_once_from_wherever_its_minima_lie(costs: Costs) -> None:
    """Twenty minima of one manifold of dimension 4, all over it."""
    problem = squares(hyperplane, [0] * 6, [1] * 6)
    A = np.array([[1.0, 1, 1, 1, 1, 1], [1.0, -1, 0, 0, 0.5, 0]])
    rng = np.random.default_rng(0)
    minima: list[Evaluation] = []
    while len(minima) < 20:
        theta = rng.uniform(size=6)
        theta = theta + np.linalg.pinv(A) @ (np.array([3.0, 0.25]) - A @ theta)
        if (theta >= 0).all() and (theta <= 1).all():
            minima.append(problem.evaluate(theta))
    before = costs.eigenproblems
    (result,) = equivalent_models(problem, ONE, minima)
    assert result.dimension == 4
    assert result.evaluations == costs.eigenproblems - before
    assert result.evaluations <= 95


def test_another_programme_shares_a_manifold_that_is_as_good_for_it() -> None:
    """Two objectives, both of x + y only; a third one, of x alone, has another manifold."""

    def three(theta: Floats) -> Residuals:
        parts = [np.array([1.0, 1, 0]), np.array([2.0, 2, 0]), np.array([1.0, 0, 0])]
        r = [theta[0] + theta[1] - 1, 2 * (theta[0] + theta[1] - 1), theta[0] - 0.5]
        return [(np.array([a]), d[None]) for a, d in zip(r, parts, strict=True)]

    problem = squares(three, [0, 0, 0], [1, 1, 1], 3)
    evaluation = problem.evaluate(np.array([0.4, 0.6, 0.5]))
    idle = np.array([False, False, True])
    known: list[Manifold] = []
    for weights in np.eye(3)[:2]:
        known += equivalent_models(problem, weighted(weights), [evaluation], known=known, idle=idle)
    assert [each.twin for each in known] == [None, 0]
    assert known[1].models == known[0].models
    assert known[1].evaluations < 10 < known[0].evaluations
    assert thetas(known[0].models)[:, 2].tolist() == [0.5] * len(known[0].models)
    other = problem.evaluate(np.array([0.5, 0.5, 0.5]))
    (last,) = equivalent_models(problem, weighted(np.eye(3)[2]), [other], known=known, idle=idle)
    assert last.twin is None


def test_minima_that_differ_in_idle_parameters_are_one() -> None:
    def valley(theta: Floats) -> Residuals:
        return [(np.array([theta[0] - 0.5]), np.array([[1.0, 0]]))]

    problem = squares(valley, [0, 0], [1, 1])
    minima = [problem.evaluate(np.array([0.5, y])) for y in (0.1, 0.5, 0.9)]
    (result,) = equivalent_models(problem, ONE, minima, idle=np.array([False, True]))
    assert (result.extent, len(result.models)) == (Extent.ISOLATED, 1)


def test_a_model_from_which_all_steps_leave_the_bounds_is_no_curve() -> None:
    def line(theta: Floats) -> Residuals:
        return [(np.array([theta.sum()]), np.ones((1, 2)))]

    problem = squares(line, [0, 0], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.zeros(2)), h=0.05, limit=50)
    assert (result.dimension, result.extent, len(result.models)) == (0, Extent.ISOLATED, 1)


def test_no_more_evaluations_than_allowed(costs: Costs, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(manifold, "SPEND", 2)
    problem = squares(hyperplane, [0] * 6, [1] * 6)
    A = np.array([[1.0, 1, 1, 1, 1, 1], [1.0, -1, 0, 0, 0.5, 0]])
    theta = np.linalg.pinv(A) @ np.array([3.0, 0.25])
    start = problem.evaluate(theta)
    before = costs.eigenproblems
    minima = [start, problem.evaluate(0.1 * theta)]
    first, second = equivalent_models(problem, ONE, minima, limit=6)
    assert costs.eigenproblems - before == 12 + 1
    assert (first.extent, first.dimension) == (Extent.SPENT, 4)
    assert len(first.models) > 2
    assert (second.extent, len(second.models)) == (Extent.SPENT, 1)


def test_a_surface_that_is_too_large_to_cover_is_spanned() -> None:
    def plane(theta: Floats) -> Residuals:
        return [(np.array([theta.sum() - 1.5]), np.ones((1, 3)))]

    problem = squares(plane, [0, 0, 0], [1, 1, 1])
    result = follow(problem, ONE, problem.evaluate(np.full(3, 0.5)), h=0.02, limit=20)
    assert (result.dimension, result.extent) == (2, Extent.SPANNED)
    theta = thetas(result.models)
    assert len(theta) <= 20
    assert theta.min(axis=0) == pytest.approx(np.zeros(3), abs=1e-8)
    assert theta.max(axis=0) == pytest.approx(np.ones(3), abs=1e-8)


@pytest.mark.parametrize("function", [circle, fitted_badly])
def test_without_second_derivatives_no_residual_changes_along_a_curve(
    function: Callable[[Floats], Residuals],
) -> None:
    """Gauss-Newton's take their place, without differences: as many evaluations a model."""
    p = 2 if function is circle else 3
    start = np.array([0.7, 0.0] if function is circle else [0.1, 0.01, 0.2])
    found = []
    for exact in (True, False):
        problem = squares(function, [-1] * p, [1] * p, exact=exact)
        found.append(follow(problem, ONE, problem.evaluate(start), h=0.05, limit=200))
    first, other = found
    assert (other.dimension, other.extent) == (1, first.extent)
    assert len(other.models) == pytest.approx(len(first.models), abs=1)
    assert other.evaluations < 1.3 * first.evaluations
    assert max(model.J[0] for model in other.models) < found[0].models[0].J[0] + 1e-9
