"""Manifolds of equally good models that are known: curves, closed and bounded, surfaces, points."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
import scipy.optimize
from problems import Derivatives, Known, box, many_minima

from modefront._typing import Floats
from modefront.solvers.explore import Descent, Search, explore
from modefront.solvers.manifold import Extent, Manifold, equivalent_models, follow
from modefront.solvers.problem import Evaluation
from modefront.solvers.scalarisation import LogSum, Scalarisation, weighted
from modefront.work.costs import Costs

ONE = weighted(np.ones(1))


def squares(r: Floats, dr: Floats) -> Derivatives:
    """One objective from its residuals (rows,) and their derivatives (rows, p)."""
    return np.array([r @ r]), (2 * r @ dr)[None], (2 * dr.T @ dr)[None]


def circle(theta: Floats) -> Derivatives:
    return squares(np.array([theta @ theta - 0.49]), 2 * theta[None])


def two_circles(theta: Floats) -> Derivatives:
    """Circles around (-1, 0) and (1, 0) of radius 0.5: r is the product of the two equations."""
    a, b = theta - np.array([-1.0, 0]), theta - np.array([1.0, 0])
    f, g = a @ a - 0.25, b @ b - 0.25
    return squares(np.array([f * g]), (2 * f * b + 2 * g * a)[None])


def sphere(theta: Floats) -> Derivatives:
    return squares(np.array([theta @ theta - 0.64]), 2 * theta[None])


def fitted_badly(theta: Floats) -> Derivatives:
    """The curve y = x**2 on which a constant residual is left over, and z has its own."""
    x, y, z = theta
    r = np.array([y - x**2, z - 0.2, 0.3])
    return squares(r, np.array([[-2 * x, 1, 0], [0, 0, 1], [0, 0, 0]]))


def of(function: Callable[[Floats], Derivatives], lower: list[float], upper: list[float]) -> Known:
    return box(function, lower, upper, 1)


def thetas(models: Sequence[Evaluation]) -> Floats:
    return np.array([model.theta for model in models])


def test_a_circle_is_followed_until_it_closes(costs: Costs) -> None:
    problem = of(circle, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.CLOSED)
    theta = thetas(result.models)
    assert np.hypot(*theta.T) == pytest.approx(0.7, abs=1e-8)
    angles = np.unwrap(np.arctan2(theta[:, 1], theta[:, 0]))
    steps = np.diff(angles)
    assert (np.sign(steps) == np.sign(steps[0])).all(), "in order along the curve"
    around = np.append(np.abs(steps), 2 * np.pi - np.abs(steps).sum())
    # h = 0.05 of ranges of 2: chords of 0.1, but where the two ends meet.
    *chords, last = np.sort(0.7 * around)
    assert chords == pytest.approx([0.1] * len(chords), rel=0.01)
    assert 0.1 < last < 0.15
    assert costs.eigenproblems == pytest.approx(134, rel=0.05), "three a model"


def test_a_circle_that_the_bounds_cut_ends_on_them() -> None:
    problem = of(circle, [-1, -0.3], [1, 0.5])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert result.extent is Extent.BOUNDED
    theta = thetas(result.models)
    ends = sorted(theta[[0, -1], 1].tolist())
    assert ends == [-0.3, 0.5]
    assert np.hypot(*theta.T) == pytest.approx(0.7, abs=1e-8)


def test_disjoint_curves_are_all_followed_and_none_twice() -> None:
    problem = of(two_circles, [-2, -2], [2, 2])
    minima = explore(problem, Descent(ONE), Search(starts=20), rng=np.random.default_rng(0))
    assert len(minima) > 2
    result = equivalent_models(
        problem, ONE, [minimum.evaluation for minimum in minima], h=0.03, limit=200
    )
    assert [manifold.extent for manifold in result] == [Extent.CLOSED] * 2
    sides = [np.sign(thetas(manifold.models)[:, 0]) for manifold in result]
    assert sorted(float(side.mean()) for side in sides) == [-1.0, 1.0]


def test_a_sphere_is_covered() -> None:
    problem = of(sphere, [-1, -1, -1], [1, 1, 1])
    start = problem.evaluate(np.array([0.0, 0.0, 0.8]))
    result = follow(problem, ONE, start, h=0.15, limit=400)
    assert (result.dimension, result.extent) == (2, Extent.CLOSED)
    theta = thetas(result.models)
    assert np.linalg.norm(theta, axis=1) == pytest.approx(0.8, abs=1e-8)
    rng = np.random.default_rng(0)
    directions = rng.normal(size=(2000, 3))
    anywhere = 0.8 * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    away = np.linalg.norm(anywhere[:, None] - theta, axis=2).min(axis=1)
    # Steps are 0.3 in theta; no place on the sphere is farther than that from a sample.
    assert away.max() < 0.3
    apart = np.linalg.norm(theta[:, None] - theta, axis=2) + 9 * np.eye(len(theta))
    assert apart.min() > 0.3 * 0.5


def test_a_sphere_within_narrow_bounds_ends_on_them() -> None:
    problem = of(sphere, [-1, -1, 0.3], [1, 1, 1])
    start = problem.evaluate(np.array([0.0, 0.0, 0.8]))
    result = follow(problem, ONE, start, h=0.1, limit=400)
    assert result.extent is Extent.BOUNDED
    assert thetas(result.models)[:, 2].min() == pytest.approx(0.3, abs=0.1 * 0.7 * 0.3 + 1e-9)


def test_isolated_minima_are_counted() -> None:
    problem = box(many_minima, [-4, -4], [4, 4])
    programme = weighted(np.array([1.0, 0.0]))
    minima = explore(problem, Descent(programme), Search(), rng=np.random.default_rng(0))
    result = equivalent_models(problem, programme, [minimum.evaluation for minimum in minima])
    assert [manifold.extent for manifold in result] == [Extent.ISOLATED] * 4
    assert [manifold.dimension for manifold in result] == [0] * 4


@pytest.mark.parametrize("programme", [ONE, LogSum(np.array([4.0]))])
def test_residuals_that_stay_do_not_hide_a_curve(programme: Scalarisation) -> None:
    problem = of(fitted_badly, [-1, -0.5, 0], [1, 2, 1])
    start = problem.evaluate(np.array([0.1, 0.01, 0.2]))
    result = follow(problem, programme, start, h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.BOUNDED)
    x, y, z = thetas(result.models).T
    assert y == pytest.approx(x**2, abs=1e-7)
    assert z == pytest.approx(0.2, abs=1e-7)
    assert sorted([x[0], x[-1]]) == [-1, 1]


def test_a_parameter_pressed_against_its_bound_stays_there() -> None:
    problem = of(fitted_badly, [-1, -0.5, 0.5], [1, 2, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.1, 0.01, 0.5])), h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.BOUNDED)
    assert thetas(result.models)[:, 2].tolist() == [0.5] * len(result.models)


def test_a_surface_is_followed_from_a_corner_along_the_bounds() -> None:
    def plane(theta: Floats) -> Derivatives:
        return squares(np.array([theta.sum() - 1.0]), np.ones((1, 3)))

    problem = of(plane, [0, 0, 0], [1, 1, 1])
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
    def bowl(theta: Floats) -> Derivatives:
        x, y = theta
        return squares(np.array([1 + x**2, y]), np.array([[2 * x, 0], [0, 1]]))

    problem = of(bowl, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.zeros(2)), h=0.05, limit=20)
    assert (result.dimension, result.extent) == (0, Extent.ISOLATED)
    assert costs.eigenproblems == 5, "no step was tried"


def test_a_direction_that_bends_is_no_part_of_a_manifold() -> None:
    """J = (1 + x**2)**2 + (y - z)**2: of three parameters, two residuals change in one only."""

    def valley(theta: Floats) -> Derivatives:
        x, y, z = theta
        return squares(np.array([1 + x**2, y - z]), np.array([[2 * x, 0, 0], [0, 1, -1]]))

    problem = of(valley, [-1, -1, -1], [1, 1, 2])
    result = follow(problem, ONE, problem.evaluate(np.array([0.0, 0.3, 0.3])), h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.BOUNDED)
    x, y, z = thetas(result.models).T
    assert x == pytest.approx(0, abs=1e-8)
    assert y == pytest.approx(z, abs=1e-8)
    assert sorted([y[0], y[-1]]) == pytest.approx([-1, 1], abs=1e-12)


@pytest.mark.parametrize("programme", [ONE, LogSum(np.array([4.0]))])
def test_residuals_that_turn_leave_a_line(programme: Scalarisation) -> None:
    """r = (1 + y**2) (cos x, sin x): J is least at y = 0, where r does not change with y but x."""

    def turning(theta: Floats) -> Derivatives:
        x, y = theta
        e, de = np.array([np.cos(x), np.sin(x)]), np.array([-np.sin(x), np.cos(x)])
        return squares((1 + y**2) * e, np.column_stack([(1 + y**2) * de, 2 * y * e]))

    problem = of(turning, [-2, -1], [4, 1.5])
    start = problem.evaluate(np.array([0.5, 0.0]))
    result = follow(problem, programme, start, h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.BOUNDED)
    x, y = thetas(result.models).T
    assert y == pytest.approx(0, abs=1e-6)
    assert sorted([x[0], x[-1]]) == [-2, 4]
    assert np.abs(np.diff(x)).max() <= 0.3 + 1e-9


def turning_circle(theta: Floats) -> Derivatives:
    """r = (1 + (|x|**2 - 0.49)**2) x / |x|: J is 1 on a circle along which r turns once."""
    rho2 = theta @ theta
    rho = np.sqrt(rho2)
    g, e = 1 + (rho2 - 0.49) ** 2, theta / rho
    dg = 4 * (rho2 - 0.49) * theta
    return squares(g * e, np.outer(e, dg) + g * (np.eye(2) - np.outer(e, e)) / rho)


def test_residuals_that_turn_leave_a_closed_curve(costs: Costs) -> None:
    problem = of(turning_circle, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert (result.dimension, result.extent) == (1, Extent.CLOSED)
    theta = thetas(result.models)
    assert np.hypot(*theta.T) == pytest.approx(0.7, abs=1e-7)
    angles = np.unwrap(np.arctan2(theta[:, 1], theta[:, 0]))
    steps = np.diff(angles)
    assert (np.sign(steps) == np.sign(steps[0])).all(), "in order along the curve"
    assert np.abs(steps).sum() > 2 * np.pi - 0.3
    assert 0.7 * np.abs(steps).max() < 0.15
    assert costs.eigenproblems == pytest.approx(349, rel=0.05), "eight a model"


def test_a_circle_on_which_residuals_turn_ends_on_the_bounds() -> None:
    problem = of(turning_circle, [-1, -0.3], [1, 0.5])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert result.extent is Extent.BOUNDED
    theta = thetas(result.models)
    assert sorted(theta[[0, -1], 1].tolist()) == [-0.3, 0.5]
    assert np.hypot(*theta.T) == pytest.approx(0.7, abs=1e-7)


def test_no_more_models_than_wanted() -> None:
    problem = of(circle, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=7)
    assert (len(result.models), result.extent) == (7, Extent.CUT)


def test_a_curve_that_ends_where_the_model_does_is_lost() -> None:
    def half(theta: Floats) -> Derivatives:
        J, dJ, H = circle(theta)
        return (J if theta[0] > 0.2 else J * np.inf), dJ, H

    problem = of(half, [-1, -1], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.array([0.7, 0.0])), h=0.05, limit=200)
    assert result.extent is Extent.LOST
    assert thetas(result.models)[:, 0].min() < 0.25


def hyperplane(theta: Floats) -> Derivatives:
    """Two residuals of six parameters: a manifold of dimension 4 that is flat."""
    A = np.array([[1.0, 1, 1, 1, 1, 1], [1.0, -1, 0, 0, 0.5, 0]])
    return squares(A @ theta - np.array([3.0, 0.25]), A)


def bent(theta: Floats) -> Derivatives:
    """A sphere in five dimensions."""
    return squares(np.array([theta @ theta - 0.81]), 2 * theta[None])


def extents_by_slsqp(
    residuals: Callable[[Floats], Floats], start: Floats, lower: Floats, upper: Floats
) -> Floats:
    """How far each parameter goes where residuals vanish, (2, p), by another method."""
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
    ("function", "start", "lower", "upper", "dimension", "evaluations"),
    [
        (hyperplane, [0.6, 0.5, 0.4, 0.5, 0.3, 0.7], [0.0] * 6, [0.9, 1, 1, 0.8, 1, 1], 4, 27),
        (bent, [0.6, 0.4, -0.4, 0.2, -0.3], [-1.0, -0.2, -1, -1, -1], [1.0, 1, 1, 1, 0.5], 4, 324),
    ],
)
def test_of_many_dimensions_each_parameter_is_followed_as_far_as_it_goes(
    function: Callable[[Floats], Derivatives],
    start: list[float],
    lower: list[float],
    upper: list[float],
    dimension: int,
    evaluations: int,
    costs: Costs,
) -> None:
    problem = of(function, lower, upper)
    theta = np.array(start)
    if function is hyperplane:
        A = np.array([[1.0, 1, 1, 1, 1, 1], [1.0, -1, 0, 0, 0.5, 0]])
        theta = theta + np.linalg.pinv(A) @ (np.array([3.0, 0.25]) - A @ theta)
    result = follow(problem, ONE, problem.evaluate(theta), h=0.05, limit=100)
    assert (result.dimension, result.extent) == (dimension, Extent.SPANNED)
    other = thetas(result.models)
    assert max(model.J[0] for model in result.models) < 1e-14

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
    assert result.evaluations == pytest.approx(evaluations, rel=0.05)


def test_a_manifold_is_followed_once_from_wherever_its_minima_lie(costs: Costs) -> None:
    """Twenty minima of one manifold of dimension 4, all over it."""
    problem = of(hyperplane, [0] * 6, [1] * 6)
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
    assert (result.dimension, result.minima) == (4, 20)
    assert result.evaluations == costs.eigenproblems - before
    assert result.evaluations == pytest.approx(97, rel=0.05)


def test_another_programme_shares_a_manifold_that_is_as_good_for_it() -> None:
    """Two objectives, both of x + y only; a third one, of x alone, has another manifold."""

    def three(theta: Floats) -> Derivatives:
        parts = [np.array([1.0, 1, 0]), np.array([2.0, 2, 0]), np.array([1.0, 0, 0])]
        r = [theta[0] + theta[1] - 1, 2 * (theta[0] + theta[1] - 1), theta[0] - 0.5]
        J = np.square(r)
        dJ = np.array([2 * a * d for a, d in zip(r, parts, strict=True)])
        return J, dJ, np.array([2 * np.outer(d, d) for d in parts])

    problem = box(three, [0, 0, 0], [1, 1, 1], 3)
    evaluation = problem.evaluate(np.array([0.4, 0.6, 0.5]))
    idle = np.array([False, False, True])
    known: list[Manifold] = []
    for weights in np.eye(3)[:2]:
        known += equivalent_models(problem, weighted(weights), [evaluation], known=known, idle=idle)
    assert [manifold.twin for manifold in known] == [None, 0]
    assert known[1].models == known[0].models
    assert known[1].evaluations < 10 < known[0].evaluations
    assert thetas(known[0].models)[:, 2].tolist() == [0.5] * len(known[0].models)
    other = problem.evaluate(np.array([0.5, 0.5, 0.5]))
    (last,) = equivalent_models(problem, weighted(np.eye(3)[2]), [other], known=known, idle=idle)
    assert last.twin is None


def test_minima_that_differ_in_idle_parameters_are_one() -> None:
    def valley(theta: Floats) -> Derivatives:
        return squares(np.array([theta[0] - 0.5]), np.array([[1.0, 0]]))

    problem = of(valley, [0, 0], [1, 1])
    minima = [problem.evaluate(np.array([0.5, y])) for y in (0.1, 0.5, 0.9)]
    (result,) = equivalent_models(problem, ONE, minima, idle=np.array([False, True]))
    assert (result.extent, result.minima, len(result.models)) == (Extent.ISOLATED, 3, 1)


def test_a_model_from_which_all_steps_leave_the_bounds_is_no_curve() -> None:
    def line(theta: Floats) -> Derivatives:
        return squares(np.array([theta.sum()]), np.ones((1, 2)))

    problem = of(line, [0, 0], [1, 1])
    result = follow(problem, ONE, problem.evaluate(np.zeros(2)), h=0.05, limit=50)
    assert (result.dimension, result.extent, len(result.models)) == (0, Extent.ISOLATED, 1)


def test_no_more_evaluations_than_allowed(costs: Costs) -> None:
    problem = of(hyperplane, [0] * 6, [1] * 6)
    A = np.array([[1.0, 1, 1, 1, 1, 1], [1.0, -1, 0, 0, 0.5, 0]])
    theta = np.linalg.pinv(A) @ np.array([3.0, 0.25])
    start = problem.evaluate(theta)
    before = costs.eigenproblems
    first, second = equivalent_models(
        problem, ONE, [start, problem.evaluate(0.1 * theta)], evaluations=21
    )
    assert costs.eigenproblems - before == 21 + 1
    assert (first.extent, first.dimension) == (Extent.SPENT, 4)
    assert len(first.models) > 2
    assert (second.extent, len(second.models)) == (Extent.SPENT, 1)


def test_a_surface_that_is_too_large_to_cover_is_spanned() -> None:
    def plane(theta: Floats) -> Derivatives:
        return squares(np.array([theta.sum() - 1.5]), np.ones((1, 3)))

    problem = of(plane, [0, 0, 0], [1, 1, 1])
    result = follow(problem, ONE, problem.evaluate(np.full(3, 0.5)), h=0.02, limit=20)
    assert (result.dimension, result.extent) == (2, Extent.SPANNED)
    theta = thetas(result.models)
    assert len(theta) <= 20
    assert theta.min(axis=0) == pytest.approx(np.zeros(3), abs=1e-8)
    assert theta.max(axis=0) == pytest.approx(np.ones(3), abs=1e-8)
