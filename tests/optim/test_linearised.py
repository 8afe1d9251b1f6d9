"""A programme in the unit box: its derivatives, and by what a step is judged, in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from exact import Residuals, Squares, squares

from modefront._typing import Floats
from modefront.optim.linearised import NOISE, PENALTY, Linearised, UnitBox, augmented, surplus
from modefront.optim.scalarisation import Linear, achievement, weighted

LOWER, UPPER = np.array([0.5, -1.0, 0.2, 0.0]), np.array([8.0, 2.0, 3.0, 5.0])
START = np.array([3.1, 0.1, 1.2, 0.1])  # 3.1 is nearer to 2 than to 4.25; 1.2 to 1.6 than to 0.77
THETA = np.array([1.3, 0.4, 1.9, 2.0])
LEVELS = achievement(
    np.array([0.7, -0.2]), np.array([[1.0, 0.5], [-2.0, 1.0], [0.3, -0.1]]), np.array([0.1, -3, 2])
)
KAPPA = np.array([0.2, 0.5, 0.3])


def bent(theta: Floats) -> Residuals:
    """Residuals of two objectives, analytic also at complex parameters."""
    a, b, c, d = theta
    first = np.array([a * b - 1, c**2 - d]), np.array([[b, a, 0, 0], [0, 0, 2 * c, -1]])
    second = np.array([a - c * d, b + d**2, 1.0]), np.zeros((3, 4), dtype=theta.dtype)
    second[1][0] = [1, 0, -d, -c]
    second[1][1] = [0, 1, 0, 2 * d]
    return first, second


def problem() -> Squares:
    given = squares(bent, LOWER.tolist(), UPPER.tolist(), 2)
    return Squares(bent, LOWER, UPPER, START, given.objectives)


def at(programme: Linear = LEVELS, theta: Floats = THETA) -> Linearised:
    of = problem()
    return Linearised(UnitBox(of), programme, of.evaluate(theta, second=True))


def test_a_factor_is_moved_by_its_logarithm_and_derivatives_go_with_it() -> None:
    unit, h = UnitBox(problem()), 1e-4
    assert unit.factor.tolist() == [True, False, False, False]
    x = at().x
    u = (THETA - LOWER) / (UPPER - LOWER)
    u[0] = np.log(1.3 / 0.5) / np.log(8.0 / 0.5)
    assert x.theta == pytest.approx(u, rel=1e-14)
    for j, step in enumerate(np.eye(4)):
        ahead, behind, far, back = (
            at(theta=unit.after(THETA, s * h * step)).x for s in (1, -1, 2, -2)
        )
        assert ahead.theta - x.theta == pytest.approx(h * step, abs=1e-15)
        dJ = (8 * (ahead.J - behind.J) - (far.J - back.J)) / (12 * h)
        H = (8 * (ahead.dJ - behind.dJ) - (far.dJ - back.dJ)) / (12 * h)
        assert x.dJ[:, j] == pytest.approx(dJ, rel=1e-8, abs=1e-7)
        assert x.H[:, j] == pytest.approx(H, rel=1e-8, abs=1e-6)
        for one, first, other in zip(x.residuals, ahead.residuals, behind.residuals, strict=True):
            assert one.dr[:, j] == pytest.approx((first.r - other.r) / (2 * h), abs=1e-4)
    assert unit.after(THETA, np.full(4, 9.0)).tolist() == UPPER.tolist()
    assert unit.after(THETA, np.full(4, -9.0)).tolist() == LOWER.tolist()


def test_a_step_is_judged_by_what_the_programme_is_along_it() -> None:
    local, C = at(), LEVELS.maximised.matrix
    x, s = local.x, np.array([0.02, -0.01, 0.03, 0.01])
    weights = np.array([0.7, -0.2]) + KAPPA @ C
    assert local.weights(KAPPA) == pytest.approx(weights)
    assert local.slope(KAPPA) == pytest.approx(weights @ x.dJ)
    change = 0.7 * x.dJ[0] @ s - 0.2 * x.dJ[1] @ s
    y, after = C @ x.J - [0.1, -3, 2], C @ (x.J + x.dJ @ s) - [0.1, -3, 2]
    change += after.max() - y.max()
    share = abs(change / (0.7 * x.J[0] - 0.2 * x.J[1] + y.max()))
    assert not local.unchanging(s, 0.99 * share)
    assert local.unchanging(s, 1.01 * share)
    plain = at(weighted(np.ones(2)))
    share = abs(x.dJ.sum(axis=0) @ s) / x.J.sum()
    assert not plain.unchanging(s, 0.99 * share)
    assert plain.unchanging(s, 1.01 * share)
    rows = np.abs([0.7, -0.2]) + KAPPA @ np.abs(C)
    assert local.noise(KAPPA) == pytest.approx(NOISE * rows @ (x.J + 2 * np.sqrt(x.J)))
    model = x.J + x.dJ @ s + (x.H @ s @ s) / 2
    linear = [((each.r + each.dr @ s) ** 2).sum() for each in x.residuals]
    assert local.promised(s) == pytest.approx(np.maximum(model, linear))
    assert (local.promised(s) > np.minimum(model, linear)).all()
    assert local.after(s).theta == pytest.approx(local.unit.after(THETA, s))


def test_a_prediction_is_the_fall_of_the_augmented_lagrangian_of_linear_objectives() -> None:
    """The penalty falls slowly, and is greater where the rest rises by more than the last term."""
    local, rng, seen = at(), np.random.default_rng(0), set()
    y, now = local.y, local.evaluation
    for penalty in 10.0 ** rng.integers(0, 5, 60):
        s, B = rng.normal(scale=0.03, size=4), np.diag(10.0 ** rng.integers(-2, 4, 4))
        fall, used = local.predicted(B, s, KAPPA, penalty)
        there = replace(now, J=local.x.J + local.x.dJ @ s)
        before, after = (augmented(LEVELS, KAPPA, used, x) for x in (now, there))
        assert fall == pytest.approx(before - after - s @ B @ s / 2, abs=1e-9)
        plain = -local.slope(KAPPA) @ s - s @ B @ s / 2
        drop = surplus(y, KAPPA, penalty) - surplus(y + local.dy @ s, KAPPA, penalty)
        least = [penalty] if drop <= 0 else [PENALTY, penalty / 10, -2 * plain * penalty / drop]
        seen.add((len(least), int(np.argmax(least))))
        assert used == pytest.approx(max(least))
    assert seen == {(1, 0), (3, 0), (3, 1), (3, 2)}
