"""Models drawn from the posterior against closed forms and numerical integration."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import scipy.stats
from exact import Residuals, squares
from scipy.special import ndtr, ndtri

import modefront as mf
from modefront._typing import Floats
from modefront.models.parameters import Prior
from modefront.models.reduced.model import ReducedModel, SnapshotRequest
from modefront.optim.problem import Evaluation
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.inference import log_values, maximum
from modefront.uncertainty.prior import NoiseModel, NoisePrior, Standardised
from modefront.uncertainty.sampling import (
    CHAINS,
    SOLVED,
    Model,
    Peak,
    agreement,
    draw_models,
    find_peak,
    mixture,
)
from modefront.work.store import Run, Store
from modefront.work.task import IMMEDIATE, Count, Executor, Task, counted

NU = 4.0


def noise_of(
    function: Callable[[Floats], Residuals], lower: list[float], upper: list[float], a: list[float]
) -> NoiseModel:
    """Return residuals in units of expected errors, one group after the other."""
    problem = squares(function, lower, upper, len(a))
    n = len(a)
    return NoiseModel(
        cast(UpdatingProblem, problem), np.array(a), np.zeros(n), np.zeros(n), np.ones(n), NU, ""
    )


def test_one_group_of_linear_residuals_has_students_distribution() -> None:
    """t about least squares, a + nu - p degrees of freedom, scale^2 = (J + nu) / dof (A^T A)^-1."""
    rng = np.random.default_rng(0)
    A = 20 * rng.normal(size=(6, 2))
    y = A @ [0.5, -0.3] + rng.normal(size=6)
    noise = noise_of(lambda theta: [(A @ theta - y, A)], [-3, -3], [3, 3], [6.0])
    best = maximum(noise, np.zeros(2))
    exact, (J,), *_ = np.linalg.lstsq(A, y)
    assert best.theta == pytest.approx(exact, abs=1e-5)
    at = Standardised(noise.problem).evaluate(ndtri((best.theta + 3) / 6))
    of = Peak(at, noise.logs, np.zeros(0))
    assert of.dof == pytest.approx([6 + NU - 2], rel=1e-3)
    assert of.scale == pytest.approx([J + NU], rel=1e-3)
    draws = draw_models(noise, [best.theta], 400, 1, IMMEDIATE).theta
    size = np.sqrt(np.diag(np.linalg.inv(A.T @ A)) * (J + NU) / 8)
    for x, middle, scale in zip(draws.T, exact, size, strict=True):
        p = scipy.stats.kstest((x - middle) / scale, scipy.stats.t(8).cdf).pvalue
        assert p > 0.01


def grid_quantiles(noise: NoiseModel, n: int, q: list[float]) -> Floats:
    """Return quantiles (p, q) of both parameters by integration over a grid."""
    lower, upper = noise.problem.lower, noise.problem.upper
    axes = [np.linspace(a, b, n) for a, b in zip(lower, upper, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    values = log_values(noise, grid).reshape(n, n)
    density = np.exp(-(values - values.min()) / 2)
    out = []
    for axis, other in ((0, 1), (1, 0)):
        total = np.cumsum(density.sum(axis=other))
        out.append(np.interp(q, total / total[-1], axes[axis]))
    return np.array(out)


def banana(theta: Floats) -> Residuals:
    x, y = theta
    r = np.array([(y - x**2) / 0.1, (x - 0.3) / 0.25])
    return [(r, np.array([[-20 * x, 10], [4, 0 * x]]))]


def basins(theta: Floats) -> Residuals:
    x, y = theta
    r = np.array([(x**2 - 1) / 0.3, (y - 0.2 * x) / 0.2])
    return [(r, np.array([[2 * x / 0.3, 0 * x], [0 * x - 1, 0 * x + 5]]))]


def flat(theta: Floats) -> Residuals:
    x, y = theta
    return [(np.array([(x - 0.4) / 0.2]), np.array([[5 + 0 * x, 0 * y]]))]


@pytest.mark.slow(2)
@pytest.mark.parametrize(
    ("function", "a", "count"),
    [(banana, 2.0, 1600), (basins, 2.0, 400), (flat, 1.0, 400)],
    ids=lambda x: str(x)[:20],
)
def test_intervals_are_those_of_integration(
    function: Callable[[Floats], Residuals], a: float, count: int
) -> None:
    """A curved valley, two basins and a parameter without effect: to a tenth of the interval.

    Of the curved valley, whose tail is long, 400 draws have one to a tenth two times in three.
    """
    noise = noise_of(function, [-2, -2], [2, 3], [a])
    best = maximum(noise, np.array([0.9, 0.3]))
    draws = draw_models(noise, [best.theta], count, 2, IMMEDIATE).theta
    expected = grid_quantiles(noise, 201, [0.05, 0.95])
    found = np.quantile(draws, [0.05, 0.95], axis=0).T
    width = np.ptp(expected, axis=1)[:, None]
    assert (np.abs(found - expected) < 0.12 * width).all()


@pytest.mark.slow(4)
def test_variances_that_trade_off_are_proposed() -> None:
    """One group is fitted exactly far from where the other one would be: both errors change."""
    rng = np.random.default_rng(1)
    A, B = 100 * rng.normal(size=(2, 2)), 20 * rng.normal(size=(6, 2))
    y = B @ [0.15, 0.15] + rng.normal(size=6)

    def groups(theta: Floats) -> list[tuple[Floats, Floats]]:
        errors = np.tensordot(B, theta, axes=1) - y.reshape(-1, *[1] * (theta.ndim - 1))
        return [(np.tensordot(A, theta, axes=1), A), (errors, B)]

    noise = noise_of(groups, [-0.15, -0.15], [0.3, 0.3], [2.0, 6.0])
    best = maximum(noise, np.zeros(2))
    at, curved = find_peak(noise, best.theta)
    assert Peak(at, noise.logs, curved).narrow(rng)
    work, shares = Noting(), [0.05, 0.25, 0.5, 0.75, 0.95]
    found = draw_models(noise, [best.theta], 200, 1, work)
    assert found.settled
    assert work.done <= 30, "rounds of chains; it takes 40 with independent variances alone"
    for x, quantiles in zip(found.theta.T, grid_quantiles(noise, 121, shares), strict=True):
        assert [(x < q).mean() for q in quantiles] == pytest.approx(shares, abs=0.12)


@pytest.mark.parametrize(
    "mean", [pytest.param(x, marks=pytest.mark.slow(3)) for x in (-1.5, 0.1)] + [1.02]
)
def test_draws_at_bounds_are_those_of_the_truncated_gaussian(mean: float) -> None:
    """One linear residual of known variance whose minimum is beyond, near or between the bounds."""
    std = 0.3

    def line(theta: Floats) -> Residuals:
        x, _ = theta
        return [(np.array([(x - mean) / std]), np.array([[1 / std + 0 * x, 0 * x]]))]

    noise = replace(noise_of(line, [0, 0], [1, 1], [1.0]), weight=1e8)
    draws = draw_models(noise, [maximum(noise, np.full(2, 0.5)).theta], 300, 5, IMMEDIATE).theta
    ends = (np.array([0, 1]) - mean) / std
    exact = scipy.stats.truncnorm(*ends, loc=mean, scale=std)
    assert scipy.stats.kstest(draws[:, 0], exact.cdf).pvalue > 0.01
    assert scipy.stats.kstest(draws[:, 1], scipy.stats.uniform.cdf).pvalue > 0.01


def test_draws_are_as_far_from_a_prior_as_the_data_are() -> None:
    """One linear residual of known variance: a Gaussian, 14 standard deviations from nominal."""

    def line(theta: Floats) -> Residuals:
        return [((theta - 0.75) / 0.01, np.array([[1 / 0.01]]))]

    noise = replace(noise_of(line, [0], [1], [1.0]), weight=1e8)
    noise = replace(noise, problem=replace(noise.problem, priors=(Prior("normal", 0.02),)))
    best = maximum(noise, np.array([0.4])).theta
    assert best == pytest.approx([0.68], rel=1e-6)
    draws = draw_models(noise, [best], 300, 5, IMMEDIATE).theta
    exact = scipy.stats.norm(0.68, 0.01 / np.sqrt(1.25))
    assert scipy.stats.kstest(draws[:, 0], exact.cdf).pvalue > 0.01


@dataclass
class Noting(Executor):
    """An executor that notes how many tasks are still expected, beside those that are done."""

    done: int = 0
    expected: list[tuple[int, Count]] = field(default_factory=list)

    def run(self, tasks: Sequence[Task[Any]], /) -> list[Any]:
        self.done += len(tasks)
        return [task() for task in tasks]

    def expect(self, stages: Mapping[str, Count]) -> None:
        self.expected += [(self.done, count) for count in stages.values()]


def test_twins_beyond_a_bound_fill_the_triangle() -> None:
    """Only the sum of two parameters is known, and is greater than bounds allow on average."""

    def total(theta: Floats) -> Residuals:
        x, y = theta
        return [(np.array([(x + y - 1.5) / 0.05]), np.array([[20 + 0 * x, 20 + 0 * x]]))]

    noise = replace(noise_of(total, [0, 0], [1, 1], [1.0]), weight=1e8)
    work = Noting()
    draws = draw_models(noise, [np.array([0.75, 0.75])], 250, 6, work).theta
    assert work.expected[1:], "more rounds are said to come, as far as the size of the draws tells"
    for done, (few, many) in work.expected[1:]:
        left = work.done - done - CHAINS  # draws are weighed at the end
        assert few <= left <= many < 6 * left
    assert draws.sum(axis=1).std() == pytest.approx(0.05, rel=0.15)
    for x in draws.T:  # uniform from 0.5 to 1 but for the noise
        assert scipy.stats.kstest(x, scipy.stats.uniform(0.5, 0.5).cdf).statistic < 0.12


def test_draws_are_those_of_the_seed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("modefront.uncertainty.sampling.ROUND", 10)
    noise = noise_of(banana, [-2, -2], [2, 3], [2.0])
    theta = maximum(noise, np.array([0.3, 0.1])).theta
    draws = [draw_models(noise, [theta], 15, seed, IMMEDIATE).theta for seed in (3, 3, 4)]
    assert draws[0].shape == (15, 2)
    assert draws[0].tolist() == draws[1].tolist()
    assert draws[0].tolist() != draws[2].tolist()


def test_draws_that_are_kept_are_not_taken_for_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("modefront.uncertainty.sampling.ROUND", 10)
    noise = noise_of(banana, [-2, -2], [2, 3], [2.0])
    theta = maximum(noise, np.array([0.3, 0.1])).theta
    for count in (15, 40):
        kept = draw_models(noise, [theta], count, 3, Run(Store(tmp_path))).theta
        assert kept.tolist() == draw_models(noise, [theta], count, 3, IMMEDIATE).theta.tolist()


def many(theta: Floats) -> Residuals:
    """Ten of thirty directions are known, along a curve; nothing says anything of the others."""
    u = np.moveaxis(theta, 0, -1)
    x, y = u[..., :10], u[..., 10:20]
    r = np.moveaxis((x + 0.3 * y**2 - 0.4) / 0.05, -1, 0)
    dr = np.zeros((10, 30))
    dr[:, :10], dr[:, 10:20] = np.eye(10) / 0.05, np.diag(0.6 * y / 0.05)
    return [(r, dr)]


@pytest.mark.slow(6)
def test_thirty_parameters_with_flat_directions() -> None:
    """Parameters without effect are uniform, and y is where the known sum lets x be."""
    noise = replace(noise_of(many, [-1] * 30, [1] * 30, [10.0]), weight=1e8)
    found = draw_models(noise, [np.r_[np.full(10, 0.4), np.zeros(20)]], 400, 7, IMMEDIATE)
    assert found.settled
    x, y, free = np.split(found.theta, 3, axis=1)
    assert (x + 0.3 * y**2).std(axis=0) == pytest.approx(np.full(10, 0.05), rel=0.2)
    for column in (*free.T, *y.T):
        assert scipy.stats.kstest(column, scipy.stats.uniform(-1, 2).cdf).pvalue > 1e-3


def test_second_derivatives_lead_to_models_in_fewer_evaluations() -> None:
    """Than first ones alone; the model is the same one."""

    def valley(theta: Floats) -> Residuals:
        x, y = theta
        r = np.array([(y + 0.2 * x**2) / 0.05, (x - 0.2) / 0.1])
        return [(r, np.array([[8 * x, 20 + 0 * x], [10 + 0 * x, 0 * x]]))]

    noise = noise_of(valley, [-3, -3], [3, 3], [2.0])
    at, curved = find_peak(noise, np.zeros(2))
    counts = []
    for second in (curved, 0 * curved):
        target = Counting(noise.problem)
        peak, u = Peak(at, noise.logs, second), np.array([0.8, -0.9, 0.3])
        found = peak.model(target, u)
        assert found is not None
        assert peak.behind(found) == pytest.approx(u, abs=SOLVED)
        counts.append(target.evaluations)
    assert counts[0] < counts[1]


def test_a_peak_does_not_lead_beyond_a_jump_where_it_leads_to_other_models() -> None:
    """The measured mode is paired with one mode on the right, and with another one on the left."""

    def pairs(theta: Floats) -> Residuals:
        x, y = theta
        return [(np.array([(x - np.where(x > 0, 1, -1)) / 0.3]), np.array([[1 / 0.3, 0 * y]]))]

    noise = noise_of(pairs, [-2, -2], [2, 2], [1.0])
    at, curved = find_peak(noise, np.array([1.0, 0.0]))
    peak = Peak(at, noise.logs, curved)
    target = Standardised(noise.problem)
    for x in (0.9, -0.9):
        model = Model(target.evaluate(target.z(np.array([x, 0.1]))), peak.expected)
        assert np.linalg.det(peak.forward(model)[1]) > 0
        assert peak.reaches(target, model) == (x > 0)


@dataclass(eq=False)
class Counting(Standardised):
    """A standardised problem that counts its evaluations."""

    evaluations: int = 0

    def evaluate(self, *args: Any, **options: Any) -> Evaluation:
        self.evaluations += 1
        return super().evaluate(*args, **options)


def test_a_peak_that_leads_to_no_other_one_is_its_own() -> None:
    """Two sensors hardly tell modes apart: a maximum with other pairs lies near by its residuals.

    By integration, 11 % of the posterior lie above k1 = 2.
    """
    names, sensors = ("k0", "k1"), {"second": 1, "fourth": 3}
    scales = [*names, None, None]
    model = mf.chain(names, [1.0] * 4, [1e4] * 4, stiffness_parameters=scales, sensors=sensors)
    shape = np.array([[[0.63245535, 1.01084785], [1.03912, -0.9296344]]])
    data = mf.modal_data(np.array([[5.57981691, 16.28516949]]), shape, model.sensors)
    parameters = [mf.Parameter(name, nominal=1.0, bounds=(0.3, 3.0)) for name in names]
    groups = [mf.Group("shapes", shape="all")]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    noise = NoisePrior().of(problem, None)
    assert noise is not None
    found = [find_peak(noise, np.array(x)) for x in ([1.51, 0.835], [1.5, 0.84], [1.005, 0.598])]
    peaks = mixture(noise, found)
    assert [x.at.quantities["paired_mode"].tolist() for x in peaks] == [[1, 2], [1, 3]]


def test_chains_that_stay_apart_do_not_agree() -> None:
    """Two basins of which chains know one each; one chain that crawls has a small sample."""
    rng = np.random.default_rng(0)
    same = rng.normal(size=(4, 200, 2))
    ratio, size = agreement(same)
    assert ratio.max() < 1.02
    assert size.min() > 300
    apart = same + np.array([0, 0, 3, 3])[:, None, None] * [1, 0]
    first, second = agreement(apart)[0]
    assert first > 1.3 > 1.02 > second
    crawling = np.cumsum(same, axis=1)
    assert agreement(crawling)[1].min() < 40


def as_defined(x: Floats) -> tuple[float, float]:
    """R-hat and effective size of chains (chains, steps): section 4 of the source, term by term.

    The size is the least of that of ranks, and of those for the 5 % and the 95 % quantile.
    """
    half = x.shape[1] // 2
    split = np.concatenate([x[:, :half], x[:, -half:]])
    S = split.size
    ends = [(split <= np.quantile(split, q)).astype(float) for q in (0.05, 0.95)]
    ratios, sizes = [], []
    for k, y in enumerate((split, np.abs(split - np.median(split)), *ends)):
        ranks = scipy.stats.rankdata(y).reshape(y.shape)
        z = y if k >= 2 else scipy.stats.norm.ppf((ranks - 3 / 8) / (S + 1 / 4))
        W = float(np.mean([np.var(chain, ddof=1) for chain in z]))
        total = (half - 1) / half * W + np.var(z.mean(axis=1), ddof=1)
        rho = [1.0]
        for t in range(1, half):
            own = [(c[: half - t] - c.mean()) @ (c[t:] - c.mean()) / half for c in z]
            rho.append(float(1 - (W - np.mean(own)) / total))
        pairs: list[float] = []
        for t in range(0, half - half % 2, 2):
            if rho[t] + rho[t + 1] <= 0:
                break
            pairs.append(min(rho[t] + rho[t + 1], *pairs[-1:], np.inf))
        ratios.append(np.sqrt(total / W))
        sizes.append(S / max(2 * sum(pairs) - 1, 1 / np.log10(S)))
    return float(max(ratios[:2])), float(min(sizes[0], *sizes[2:]))


@pytest.mark.parametrize(("steps", "memory"), [(20, 0.0), (21, 0.6), (60, 0.9), (60, -0.5)])
def test_agreement_and_size_are_as_they_are_defined(steps: int, memory: float) -> None:
    rng = np.random.default_rng(steps)
    x = np.zeros((4, steps, 2))
    for t in range(steps):
        x[:, t] = memory * x[:, max(t - 1, 0)] + np.exp(0.3 * rng.normal(size=(4, 2)))
    expected = np.transpose([as_defined(x[:, :, j]) for j in range(2)])
    np.testing.assert_allclose(agreement(x), expected, rtol=1e-10)


@pytest.mark.parametrize("z", [-3.0, -0.4, 0.0, 2.5])
def test_parameters_have_their_priors_between_the_bounds(z: float) -> None:
    """Uniform, normal in any unit, and lognormal with a bound that logarithms do not have."""
    problem = SimpleNamespace(
        objectives=(),
        start=np.array([1.0, 2e3, 0.9]),
        lower=np.array([0.2, -1e3, 0.0]),
        upper=np.array([5.0, 7e3, 1.0]),
        priors=(None, Prior("normal", 1.5e3), Prior("lognormal", 0.4)),
    )
    of, at, step = Standardised(cast(UpdatingProblem, problem)), np.full(3, z), 1e-5
    theta, slope = of.theta(at)
    normal, lognormal = (-3 / 1.5, 5 / 1.5), (-np.inf, np.log(1 / 0.9) / 0.4)
    x, y = (scipy.stats.truncnorm(*ends).ppf(ndtr(z)) for ends in (normal, lognormal))
    expected = [0.2 + 4.8 * ndtr(z), 2e3 + 1.5e3 * x, 0.9 * np.exp(0.4 * y)]
    assert theta == pytest.approx(expected, rel=1e-7)
    differences = (of.theta(at + step)[0] - of.theta(at - step)[0]) / (2 * step)
    assert slope == pytest.approx(differences, rel=1e-6)
    assert of.z(theta) == pytest.approx(at, abs=1e-9)


@pytest.mark.parametrize(("size", "rounds"), [(5.0, 6), (60.0, 12)])
def test_chains_end_at_half_their_length_where_each_stays_where_it_is(
    size: float, rounds: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of 12 rounds that as many draws as all chains have steps in a round may take."""
    calls = []

    def apart(x: Floats) -> tuple[Floats, Floats]:
        calls.append(x.shape)
        return np.full(x.shape[2], 2.0), np.full(x.shape[2], size)

    monkeypatch.setattr("modefront.uncertainty.sampling.agreement", apart)
    monkeypatch.setattr("modefront.uncertainty.sampling.ROUND", 5)
    noise = noise_of(flat, [-2, -2], [2, 3], [1.0])
    work = Noting()
    found = draw_models(noise, [np.array([0.4, 0.0])], 5 * CHAINS, 1, work)
    assert (len(calls), found.settled) == (rounds, False)
    assert calls == [(CHAINS, 5 * (k + 1), 2) for k in range(rounds)]
    assert work.done == 1 + (1 + rounds) * CHAINS + CHAINS, "the peak, the warm-up, and weights"
    assert found.theta.shape == (5 * CHAINS, 2)


def test_derivatives_beyond_all_bounds_leave_a_peak() -> None:
    """Shapes of modes that nearly meet change by 1e9 along one direction: rounding is above 1."""
    rng = np.random.default_rng(3)
    steep = 1e9 * rng.normal(size=(40, 1)) @ rng.normal(size=(1, 6))

    def meet(theta: Floats) -> Residuals:
        return [(steep @ theta, steep)]

    noise = noise_of(meet, [-1] * 6, [1] * 6, [40.0])
    peak = Peak(Standardised(noise.problem).evaluate(np.zeros(6)), noise.logs, np.zeros(0))
    assert np.linalg.eigvalsh(peak.precision(np.ones(1))).min() > 0
    assert not peak.narrow(rng)


@pytest.mark.parametrize(
    ("mean", "std", "count"),
    [(0.2, 0.2, 150), pytest.param(0.9, 0.05, 50, marks=pytest.mark.slow(3))],
)
def test_draws_in_a_poor_basis_are_weighted(
    mean: float, std: float, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Chains are those of a posterior off by half a standard deviation, or far away."""

    def line(theta: Floats, mean: float, std: float) -> Residuals:
        x, _ = theta
        return [(np.array([(x - mean) / std]), np.array([[1 / std + 0 * x, 0 * x]]))]

    exact, poor = (
        replace(noise_of(partial(line, mean=m, std=s), [0, 0], [1, 1], [1.0]), weight=1e8)
        for m, s in ((0.1, 0.2), (mean, std))
    )
    monkeypatch.setattr("modefront.uncertainty.sampling._nearer", lambda *_: poor)
    found = draw_models(exact, [np.array([0.1, 0.5])], count, 8, IMMEDIATE)
    assert found.settled == (std == 0.2)
    assert found.effective.max() < 0.95 * count
    if found.settled:
        known = scipy.stats.truncnorm(-0.5, 4.5, loc=0.1, scale=0.2)
        assert scipy.stats.kstest(found.theta[:, 0], known.cdf).pvalue > 0.01
        assert scipy.stats.kstest(found.theta[:, 1], scipy.stats.uniform.cdf).pvalue > 0.01


@pytest.mark.slow(3)
def test_draws_in_a_basis_know_modes_above_one_that_is_not_measured(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A chain of 120 stories in three parts; its posterior is nearly Gaussian about the peak."""
    names, measured = ("k1", "k2", "k3"), [0, 1, 3, 4]
    stories = [name for name in names for _ in range(40)]
    model = mf.chain(names, [20.0] * 120, [8e7] * 120, stiffness_parameters=stories)
    truth, rng = np.array([0.9, 1.3, 0.8]), np.random.default_rng(3)
    true = model.modes(truth, 5)
    frequency = true.frequency[measured] * (1 + 0.005 * rng.normal(size=4))
    data = mf.modal_data(frequency, true.phi.T[measured, ::8], model.sensors[::8])
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    parameters = [mf.Parameter(x, nominal=1.0, bounds=(0.3, 3.0)) for x in names]
    problem = mf.updating_problem(
        model, data, groups, parameters=parameters, reduction=mf.Reduction(1e-8)
    )
    basis = problem.model
    assert isinstance(basis, ReducedModel)
    for theta in rng.uniform(0.5, 2.0, (12, 3)):
        basis.take(SnapshotRequest(theta, basis.count))
    noise = NoisePrior().of(problem, None)
    assert noise is not None
    top = maximum(noise, truth)
    monkeypatch.setattr("modefront.uncertainty.sampling.SMALL", 0)
    with counted() as costs:
        draws = draw_models(noise, [top.theta], 100, 1, IMMEDIATE)
    assert draws.settled
    assert costs.reduced < 2000
    std = np.sqrt(np.diag(np.linalg.inv(noise.precision(noise.problem.evaluate(top.theta)))))
    assert np.all(np.abs(draws.theta.mean(axis=0) - top.theta) < 0.5 * std)
    assert draws.theta.std(axis=0) == pytest.approx(std, rel=0.4)
