"""The quadratic programme of one step: conditions of optimality, and an independent solver."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize
from hypothesis import given, settings
from hypothesis import strategies as st

from modefront._typing import Floats
from modefront.optim.qp import QuadraticProgramme, solve_qp

SEEDS = st.integers(0, 2**31)


def programme(
    B: Floats,
    g: Floats,
    half: Floats | float = 1.0,
    C: Floats | None = None,
    c: Floats | None = None,
) -> QuadraticProgramme:
    """Return a programme in a box of these half widths."""
    hi = np.broadcast_to(half, g.shape).astype(float)
    C, c = np.zeros((0, g.size)) if C is None else C, np.zeros(0) if c is None else c
    return QuadraticProgramme(B, g, -hi, hi, C, c)


def value(qp: QuadraticProgramme, s: Floats) -> float:
    greatest = (qp.c + qp.C @ s).max() if qp.c.size else 0.0
    return float(qp.g @ s + 0.5 * s @ qp.B @ s + greatest)


def least(qp: QuadraticProgramme) -> float:
    """Return the least value that SLSQP finds, from several starts."""
    p, m = qp.g.size, qp.c.size
    bounds = [*zip(qp.lo, qp.hi, strict=True), *[(None, None)] * bool(m)]
    constraints = [{"type": "ineq", "fun": lambda x: x[p] - qp.c - qp.C @ x[:p]}] if m else []

    def objective(x: Floats) -> float:
        s = x[:p]
        return float(qp.g @ s + 0.5 * s @ qp.B @ s + x[p:].sum())

    best = np.inf
    for share in (0.0, 0.5, -0.5):
        s = share * qp.hi
        start = np.append(s, (qp.c + qp.C @ s).max()) if m else s
        result = scipy.optimize.minimize(
            objective,
            start,
            method="SLSQP",
            bounds=bounds,
            constraints=constraints,
            options={"ftol": 1e-14, "maxiter": 500},
        )
        best = min(best, value(qp, np.clip(result.x[:p], qp.lo, qp.hi)))
    return best


def optimal(qp: QuadraticProgramme, tolerance: float = 1e-7) -> Floats:
    """Assert that the conditions of Karush, Kuhn and Tucker hold; return the step."""
    s, active = solve_qp(qp)
    inside = (s > qp.lo) & (s < qp.hi)
    assert (s >= qp.lo).all()
    assert (s <= qp.hi).all()
    kappa = qp.multipliers(s, active, inside)
    reached = qp.c + qp.C @ s
    if qp.c.size:
        assert kappa.min() >= -tolerance
        assert kappa.sum() == pytest.approx(1)
        assert reached[kappa > tolerance] == pytest.approx(reached.max(), abs=1e-8)
    slope = qp.g + qp.B @ s + qp.C.T @ kappa
    scale = tolerance * max(1.0, float(np.abs(qp.g + qp.C.T @ kappa).max()))
    assert (np.abs(slope[inside]) <= scale).all()
    assert (slope[~inside & (s > qp.lo)] <= scale).all(), "the upper bounds press"
    assert (slope[~inside & (s < qp.hi)] >= -scale).all(), "the lower bounds press"
    return s


def convex(rng: np.random.Generator, p: int, rank: int) -> Floats:
    root = rng.normal(size=(p, rank))
    return np.asarray(root @ root.T)


@settings(max_examples=60)
@given(SEEDS, st.integers(1, 6), st.integers(0, 5))
def test_the_solution_is_optimal(seed: int, p: int, m: int) -> None:
    rng = np.random.default_rng(seed)
    qp = programme(
        convex(rng, p, p) + 0.1 * np.eye(p),
        3 * rng.normal(size=p),
        rng.uniform(0.5, 2, p),
        rng.normal(size=(m, p)),
        rng.normal(size=m),
    )
    s = optimal(qp)
    assert value(qp, s) <= least(qp) + 1e-7


@given(SEEDS, st.integers(2, 5), st.integers(0, 4))
def test_degenerate_functions_do_no_harm(seed: int, p: int, m: int) -> None:
    """Functions given twice that all meet at the start, shut bounds."""
    rng = np.random.default_rng(seed)
    C = rng.normal(size=(m, p))
    hi = rng.uniform(0.5, 2, p) * (rng.uniform(size=p) < 0.8)
    qp = programme(
        convex(rng, p, p) + 0.1 * np.eye(p), 3 * rng.normal(size=p), hi, np.vstack([C, C])
    )
    qp = replace(qp, c=np.zeros(2 * m), lo=qp.lo * (rng.uniform(size=p) < 0.7))
    assert value(qp, solve_qp(qp)[0]) <= least(qp) + 1e-7


@given(SEEDS, st.integers(2, 6), st.integers(0, 4))
def test_flat_directions_are_gone_to_the_end(seed: int, p: int, m: int) -> None:
    """Without any curvature in some directions, the slope leads to the box or the functions do."""
    rng = np.random.default_rng(seed)
    B = convex(rng, p, int(rng.integers(0, p)))
    qp = programme(B, rng.normal(size=p), C=3 * rng.normal(size=(m, p)), c=rng.normal(size=m))
    s = solve_qp(qp)[0]
    assert value(qp, s) <= least(qp) + 1e-4 * max(1.0, float(np.abs(B).max()))


@given(SEEDS, st.integers(1, 6), st.integers(1, 4), st.floats(1e2, 1e5))
def test_equations_are_met_by_steep_functions(seed: int, p: int, k: int, slope: float) -> None:
    """Of the corners of a simplex the greatest is least where all of them are."""
    rng, k = np.random.default_rng(seed), min(k, p)
    corners = scipy.linalg.null_space(np.ones((1, k + 1)))
    A = np.linalg.qr(rng.normal(size=(p, k)))[0].T
    b = A @ rng.uniform(-0.3, 0.3, p)
    B, g = convex(rng, p, p) / p + 0.1 * np.eye(p), 0.3 * rng.normal(size=p)
    qp = programme(B, g, 2.0, slope * corners @ A, -slope * corners @ b)
    s = optimal(qp, 1e-6)
    assert A @ s == pytest.approx(b, abs=1e-7)


@given(SEEDS, st.integers(1, 5), st.integers(0, 4))
def test_negative_curvature_descends_at_least(seed: int, p: int, m: int) -> None:
    rng = np.random.default_rng(seed)
    B = rng.normal(size=(p, p))
    C, c = rng.normal(size=(m, p)), rng.normal(size=m)
    qp = programme(B + B.T, rng.normal(size=p), 1.0, C=C, c=c)
    s = solve_qp(qp)[0]
    assert (np.abs(s) <= 1).all()
    assert value(qp, s) < value(qp, np.zeros(p)) + 1e-12


def test_curvature_of_what_stays_equal_counts_alone() -> None:
    """Max of s1 and -s1: B is negative along s1, but s1 = 0 is where they meet."""
    C = np.array([[1.0, 0.0], [-1.0, 0.0]])
    qp = programme(np.diag([-0.5, 2.0]), np.array([0.0, -1.0]), C=C, c=np.zeros(2))
    s, active = solve_qp(qp)
    assert s == pytest.approx([0.0, 0.5])
    assert sorted(active) == [0, 1]
    kappa = qp.multipliers(s, active, np.ones(2, dtype=bool))
    assert kappa == pytest.approx([0.5, 0.5])


def test_one_function_is_a_part_of_the_slope() -> None:
    g, C = np.array([1.0, -2.0]), np.array([[0.5, 1.0]])
    alone = solve_qp(programme(np.eye(2), g + C[0], 3.0))[0]
    assert solve_qp(programme(np.eye(2), g, 3.0, C=C, c=np.ones(1)))[0] == pytest.approx(alone)


def test_a_very_steep_objective() -> None:
    """Curvature of 1e23 in a box of 0.005: what is left over of a least distance is rounding."""
    T = 1e-12 * np.array([[-1.2546525, 2.7558925], [1.8330812, -14.992864], [7.4447152, 4.1560792]])
    target = np.array([0.0016321922652506, 0.01227940154453663, 0.00619583705559531])
    hi = np.full(3, 0.00469227039043077)
    n = np.linalg.svd(T)[0][:, 2]
    B = np.asarray(np.linalg.pinv(T @ T.T, rcond=1e-10, hermitian=True), dtype=float)
    b = float(n @ target)
    steep = 1e3 * np.abs(B).max()
    C, c = steep * np.array([n, -n]), steep * np.array([-b, b])
    s = solve_qp(programme(B, -B @ (target - n * b), hi, C, c))[0]
    assert s[1:] == pytest.approx(hi[1:], rel=1e-6)
    assert n @ s == pytest.approx(b, rel=1e-6)


# ---- many variables: held and let go many at once --------------------------------------------


@pytest.mark.parametrize("share", [1.0, 0.2, 0.02])
@pytest.mark.parametrize("m", [0, 4])
@pytest.mark.parametrize("p", [48, 120])
def test_many_variables_end_at_the_box_or_within(p: int, m: int, share: float) -> None:
    rng = np.random.default_rng(p)
    half = rng.uniform(0.5, 2, p)
    g = 3 * rng.normal(size=p) / share
    B = convex(rng, p, 2 * p) / p + 0.1 * np.eye(p)
    C, c = 5 * rng.normal(size=(m, p)) / share, rng.normal(size=m)
    optimal(programme(B, g, half, C, c))


@pytest.mark.parametrize("share", [1.0, 0.05])
def test_many_variables_held_by_few_residuals(share: float) -> None:
    """Of all s with the least value any is a solution: an independent method finds no lower one."""
    rng = np.random.default_rng(3)
    slopes, r = rng.normal(size=(30, 90)), rng.normal(size=30)
    qp = programme(2 * slopes.T @ slopes, 2 * slopes.T @ r, 0.4 * share)
    found = scipy.optimize.lsq_linear(slopes, -r, (qp.lo, qp.hi), tol=1e-14).x
    assert value(qp, solve_qp(qp)[0]) == pytest.approx(value(qp, found), abs=1e-8)


def test_many_variables_with_negative_curvature_end_at_a_vertex_of_their_box() -> None:
    """The slopes of the solution press against the box, and it is far below the start."""
    rng = np.random.default_rng(5)
    p = 80
    root, S = rng.normal(size=(20, p)), rng.normal(size=(p, p))
    qp = programme(root.T @ root + S + S.T, rng.normal(size=p), 0.1)
    s, _ = solve_qp(qp)
    inside = (s > qp.lo) & (s < qp.hi)
    slope = qp.g + qp.B @ s
    assert np.abs(slope[inside]).max() < 1e-6
    assert (slope[s >= qp.hi] < 1e-6).all()
    assert (slope[s <= qp.lo] > -1e-6).all()
    assert value(qp, s) < -0.05 * np.abs(qp.g).sum()
