"""The posterior of predictions: closed forms, differences, integration, and sentences."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.integrate
import scipy.stats
import xarray as xr
from interruptions import interrupt_at
from refusals import command
from two_masses import FRF, QUICK, ZETA, direct, run, write_study

import modefront as mf
from modefront._typing import Floats
from modefront.predictions import Passage, PeakResponse, Prediction
from modefront.results.remarks import findings_of
from modefront.study.examples import write_example
from modefront.uncertainty.prediction import STEP, SUMMARY
from modefront.work.progress import Progress, State

pytestmark = pytest.mark.slow(2)

K, MASS, DAMPING = 400.0, 2.0, 0.03
ONE_MASS = mf.chain(["k"], [MASS], [K], stiffness_parameters=["k"])
TWO_MASSES = mf.chain(["k1", "k2"], [2.0, 1.0], [3e3, 2e3], stiffness_parameters=["k1", "k2"])
PEAK = PeakResponse("peak", "floor1", "floor1", band=(0.5, 5.0), modes=1, damping=DAMPING)
SEED = np.random.SeedSequence(0)


def problem_of(
    *, lower: float = 0.2, upper: float = 5.0, scatter: float = 0.05
) -> mf.UpdatingProblem:
    """A structure of one mass, whose frequency differs from set to set."""
    f = np.sqrt(K / MASS) / (2 * np.pi) * (1 + scatter * np.array([-1.5, -0.5, 0.5, 1.5]))
    data = mf.modal_data(f[:, None], np.ones((4, 1, 1)), ONE_MASS.sensors)
    groups = [mf.Group("frequencies", frequency="all")]
    return mf.updating_problem(
        ONE_MASS, data, groups, {"k": (lower, upper)}, {"k": min(1.0, upper)}
    )


def solved(
    problem: mf.UpdatingProblem, predictions: Sequence[Prediction], draws: int = 0
) -> xr.Dataset:
    return mf.solve(
        problem,
        points=2,
        search=mf.Search(doubt=0.5),
        uncertainty=mf.Uncertainty("none", draws=draws),
        noise=mf.NoisePrior(weight=0),
        predictions=predictions,
    ).dataset


def passage(
    levels: tuple[float, ...], *, duration: float = 5.0, step: float = 0.02, samples: int = 100
) -> Passage:
    return Passage(
        *("passage", "floor1", 1.0, "two", levels, duration, "floor1"),
        step=step,
        samples=samples,
        modes=1,
        damping=DAMPING,
    )


def peak(k: Floats) -> Floats:
    """Greatest receptance of one mass on a spring of stiffness k K."""
    return np.asarray(1 / (2 * DAMPING * np.sqrt(1 - DAMPING**2) * k * K))


def optimal(data: xr.Dataset) -> xr.Dataset:
    return data.isel(point=data["label"].values.tolist().index("optimal-weights"))


def test_the_peak_of_one_mass_in_closed_form() -> None:
    data = solved(problem_of(), [PEAK])
    (theta,), (s,) = optimal(data)["theta"].values, data["posterior_std"].values
    # q = c / theta: (q(theta + d) - q(theta - d)) / 2 d = -c / (theta^2 - d^2), d = h s
    exact = s * peak(theta) / theta
    result = data["posterior_frf_peak_std"].values[0]
    assert result == pytest.approx(exact / (1 - (STEP * s / theta) ** 2), rel=1e-6)
    assert result == pytest.approx(exact, rel=0.01)
    # The frequency of the peak grows with the root of the stiffness.
    f = np.sqrt(theta * K / MASS * (1 - 2 * DAMPING**2)) / (2 * np.pi)
    assert data["posterior_frf_peak_frequency_std"].values[0] == pytest.approx(
        s * f / (2 * theta), rel=0.01
    )


def test_predictions_of_two_masses_against_own_gradients(drawn: xr.Dataset) -> None:
    """The peaks of a direct solution, differentiated along each parameter by small steps."""
    data = drawn
    theta, C = optimal(data)["theta"].values, data["posterior_covariance"].values
    force, outputs = np.array([0.0, 2.0]), np.array([[1.0, 0.0], [-1.0, 1.0]])

    def greatest(theta: Floats) -> Floats:
        """The greatest |T| of each output on a fine grid, refined by a parabola."""
        out = []
        for output, middle in zip(outputs, (4.15, 10.5), strict=True):
            x = np.linspace(-0.4, 0.4, 4001)
            size = np.abs((middle + x) * direct(theta, ZETA, force, output, middle + x))
            top = size.argmax() + np.arange(-2, 3)
            a, b, c = np.polyfit(x[top], size[top], 2)
            out.append(2 * np.pi * (c - b**2 / (4 * a)))
        return np.array(out)

    assert greatest(theta) == pytest.approx(optimal(data)["frf_peak"].values[:2], rel=1e-6)
    h = 1e-4
    slope = np.column_stack(
        [(greatest(theta + h * e) - greatest(theta - h * e)) / (2 * h) for e in np.eye(2)]
    )
    expected = slope @ C @ slope.T
    names = ["pushed: low", "pushed: drift"]
    result = data["posterior_frf_peak_covariance"].sel(frf=names, frf_other=names).values
    assert result == pytest.approx(expected, rel=0.01)
    std = data["posterior_frf_peak_std"].sel(frf=names).values
    assert std == pytest.approx(np.sqrt(np.diag(result)), rel=1e-12)


def test_peaks_of_the_three_stories_by_small_differences(tmp_path: Path) -> None:
    """Steps of 1e-6 along each of the parameters, not of half a deviation along the axes."""
    write_example("three-story-c0", tmp_path)
    problem = mf.load(tmp_path / "study.toml").problem
    prediction = PeakResponse("peak", "floor1", "floor3", band=(0.5, 25.0), modes=3, damping=0.02)
    data = solved(problem, [prediction])
    theta, C = optimal(data)["theta"].values, data["posterior_covariance"].values
    steps = 1e-6 * np.eye(theta.size)
    for quantity, name in (("peak", "frf_peak"), ("frequency", "frf_peak_frequency")):

        def value(theta: Floats, quantity: str = quantity) -> float:
            return float(prediction.evaluate(problem, theta, SEED)[quantity][0])

        slope = [(value(theta + d) - value(theta - d)) / 2e-6 for d in steps]
        expected = np.sqrt(np.array(slope) @ C @ slope)
        assert data[f"posterior_{name}_std"].values[0] == pytest.approx(expected, rel=2e-3)


def test_failure_probabilities_by_their_logarithms() -> None:
    """With other random numbers and another method; P is lognormal."""
    prediction = passage((0.2, 0.27), samples=8000)
    problem = problem_of()
    data = solved(problem, [prediction])
    s = data["posterior_failure_log_std"].values
    theta, std = optimal(data)["theta"].values, data["posterior_std"].values
    other = replace(prediction, method="directional")
    seed = np.random.SeedSequence(5)
    up, down = (
        other.evaluate(problem, theta + h * std, seed)["probability"] for h in (STEP, -STEP)
    )
    assert s == pytest.approx(np.abs(np.log(up / down)) / (2 * STEP), rel=0.1)
    C = data["posterior_failure_log_covariance"].values
    assert np.diag(C) == pytest.approx(s**2)
    assert C[0, 1] == pytest.approx(s[0] * s[1])
    P = optimal(data)["failure_probability"].values
    expected = scipy.stats.lognorm.std(s, scale=P)
    assert data["posterior_failure_probability_std"].values == pytest.approx(expected, rel=1e-9)


def test_draws_against_integration_over_the_truncated_gaussian() -> None:
    """One parameter, with the upper bound at less than half a standard deviation."""
    n, upper = 150, 1.02
    prediction = passage((0.25,))
    problem = problem_of(upper=upper)
    data = solved(problem, [PEAK, prediction], draws=n)
    (middle,), (std,) = optimal(data)["theta"].values, data["posterior_std"].values
    assert upper - middle < 0.5 * std
    ends = (0.2 - middle) / std, (upper - middle) / std
    gaussian = scipy.stats.truncnorm(*ends, loc=middle, scale=std)
    theta = data["draw_theta"].values[:, 0]
    assert (theta <= upper).all()
    assert scipy.stats.kstest(theta, gaussian.cdf).pvalue > 0.01
    np.testing.assert_array_equal(data["statistic"].values, SUMMARY)

    result = dict(zip(SUMMARY, data["posterior_frf_peak"].values[:, 0], strict=True))
    mean, square = (gaussian.expect(lambda k, m=m: peak(k) ** m) for m in (1, 2))
    spread = np.sqrt(square - mean**2)
    assert result["mean"] == pytest.approx(mean, abs=3 * spread / np.sqrt(n))
    assert result["standard deviation"] == pytest.approx(spread, rel=0.2)
    for name, share in (("5 %", 0.05), ("50 %", 0.5), ("95 %", 0.95)):
        k = peak(np.ones(1)) / result[name]  # the peak is inverse to the stiffness
        assert gaussian.sf(k) == pytest.approx(share, abs=3 * np.sqrt(share * (1 - share) / n))

    # The robust failure probability: the same estimator at the nodes of a quadrature.
    nodes, weights = np.polynomial.legendre.leggauss(9)
    first = max(0.2, middle - 5 * std)
    k = (upper + first) / 2 + (upper - first) / 2 * nodes
    seed = np.random.SeedSequence(11)
    P = np.array([prediction.evaluate(problem, np.array([x]), seed)["probability"][0] for x in k])
    density = weights * gaussian.pdf(k) * (upper - first) / 2
    assert density.sum() == pytest.approx(1, abs=1e-3)
    robust = density @ P
    drawn = dict(zip(SUMMARY, data["posterior_failure_probability"].values[:, 0], strict=True))
    error = drawn["standard deviation"] / np.sqrt(n)
    estimate = np.sqrt(2) * robust * optimal(data)["failure_variation"].values[0]
    assert drawn["mean"] == pytest.approx(robust, abs=3 * np.hypot(error, estimate))
    assert drawn["mean"] > 1.05 * optimal(data)["failure_probability"].values[0]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("drawn")


@pytest.fixture(scope="module")
def drawn(folder: Path) -> xr.Dataset:
    return run(folder, with_draws(5))


def with_draws(count: int) -> str:
    return FRF + QUICK + f"[uncertainty]\ndraws = {count}\n"


@pytest.mark.slow(5)
def test_an_interrupted_run_has_the_same_digits(
    drawn: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for task in ("shaken-axis-2", "drifts-axis-3", "drifts-draw-2"):
        interrupt_at(task, monkeypatch)
        with pytest.raises(KeyboardInterrupt):
            run(tmp_path, with_draws(5))
        assert not (tmp_path / "results" / "results.nc").exists()
    again = run(tmp_path, with_draws(5))
    xr.testing.assert_identical(again.drop_attrs(), drawn.drop_attrs())
    assert again.attrs == drawn.attrs


@pytest.mark.slow(5)
def test_more_draws_cost_only_themselves(drawn: xr.Dataset, tmp_path: Path) -> None:
    run(tmp_path, FRF + QUICK)
    folder = tmp_path / "results" / "tasks"
    before = set(folder.rglob("*.npz"))
    study = mf.load(write_study(tmp_path, with_draws(7)))
    states: list[State] = []
    data = mf.run(study, tmp_path / "results", progress=Progress(states.append)).dataset
    new = set(folder.rglob("*.npz")) - before
    assert len(new) == 6 * 7
    assert all("-draw-" in path.name for path in new)
    for name in ("draw_theta", "draw_frf_peak", "draw_failure_probability"):
        np.testing.assert_array_equal(data[name][:5], drawn[name])
    np.testing.assert_array_equal(data["posterior_frf_peak_std"], drawn["posterior_frf_peak_std"])
    # The last extent that is told is that of the work: of 8 models, 4 on axes, 7 drawn, and ranges.
    last = states[-1]
    assert last.extent is not None
    assert (last.of_stage, last.of_stage, last.running) == (*last.extent, 0)
    of_predictions = {state.done for state in states if state.stage == "predict"}
    assert max(of_predictions) - min(of_predictions) == 6 * (8 + 2 * 2 + 7 + 1) + 1


def exact_problem() -> mf.UpdatingProblem:
    """Two masses whose data a model fits exactly, so that there is no regular optimum."""
    modes = TWO_MASSES.modes(np.array([1.2, 0.8]), 2)
    data = mf.modal_data(modes.frequency[None], modes.phi.T[None], TWO_MASSES.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    bounds = {"k1": (0.2, 5.0), "k2": (0.2, 5.0)}
    return mf.updating_problem(TWO_MASSES, data, groups, bounds, {"k1": 1.0, "k2": 1.0})


def test_what_there_is_no_posterior_or_no_prediction_of_is_not_there(drawn: xr.Dataset) -> None:
    of_them = [x for x in drawn if str(x).startswith(("posterior_f", "draw_"))]
    assert len(of_them) == 15
    exact = solved(exact_problem(), [replace(PEAK, band=(0.5, 20.0), modes=2)], draws=3)
    assert "frf_peak" in exact
    plain = solved(problem_of(), [])
    undrawn = solved(problem_of(), [PEAK])
    for data in (exact, plain, undrawn):
        assert "draw" not in data.sizes
        assert "statistic" not in data.sizes
    for data in (exact, plain):
        assert not any("frf" in str(x) or "failure" in str(x) for x in data if "post" in str(x))
    missing = "there is no posterior: no models are drawn from it"
    assert missing in list(map(str, findings_of(exact, full=True)))
    assert missing not in list(map(str, findings_of(plain, full=True)))
    with pytest.raises(mf.InputError, match="draws: expected 0 without predictions, found 3"):
        solved(problem_of(), [], draws=3)


def test_models_that_cannot_be_solved_are_counted() -> None:
    """A time step too long for models that are stiffer than the optimal one by 0.2 std."""
    problem = problem_of(scatter=0.02)
    first = solved(problem, [])
    (theta,), (std,) = optimal(first)["theta"].values, first["posterior_std"].values
    step = np.pi / 2 / np.sqrt((theta + 0.2 * std) * K / MASS)
    prediction = passage((0.06, 0.08), step=step, duration=40 * step)
    data = solved(problem, [PEAK, prediction], draws=20)
    (stiff,) = np.nonzero(data["draw_theta"].values[:, 0] > theta + 0.2 * std)
    assert 0 < stiff.size < 20
    assert np.isnan(data["draw_failure_probability"].values[stiff]).all()
    assert np.isfinite(data["posterior_failure_probability"].values).all()
    assert np.isfinite(data["posterior_frf_peak_std"].values).all()
    assert np.isnan(data["posterior_failure_log_std"].values).all()
    message = list(map(str, findings_of(data, full=True)))
    assert (
        f"{stiff.size} of 20 models drawn from the posterior cannot be solved for passage: they "
        "are left out"
    ) in message
    assert any("no posterior standard deviation of passage: 0.06" in text for text in message)


def test_peaks_that_models_do_not_have_are_counted() -> None:
    data = solved(problem_of(), [replace(PEAK, band=(0.5, 2.26))], draws=20)
    missing = np.isnan(data["draw_frf_peak"].values).sum()
    assert 0 < missing < 20
    text = f"{missing} of 20 models drawn from the posterior have no peak for peak: floor1"
    assert any(line.startswith(text) for line in list(map(str, findings_of(data, full=True))))


def test_bounds_that_hold_hardly_any_of_the_posterior_end_with_a_statement() -> None:
    (theta,) = optimal(solved(problem_of(), []))["theta"].values
    data = solved(problem_of(lower=theta - 1e-6, upper=theta + 1e-6), [PEAK], draws=3)
    assert "draw_theta" not in data
    assert "posterior_frf_peak_std" not in data
    message = list(map(str, findings_of(data, full=True)))
    assert any("wider than the bounds (" in text for text in message)
    assert "optimal-weights has no room for differences between bounds: see draws" in message


def test_predictions_do_not_scatter_where_bounds_hold_all_parameters() -> None:
    data = solved(problem_of(upper=0.5), [PEAK])
    assert data["posterior_std"].values.tolist() == [0.0]
    assert data["posterior_frf_peak_std"].values.tolist() == [0.0]
    assert optimal(data)["frf_peak"].values == pytest.approx(float(peak(np.array(0.5))))


def test_what_the_data_leave_open_is_said() -> None:
    """Shapes alone leave the scale of all stiffnesses open."""
    data = mf.modal_data(
        np.full((1, 2), np.nan), np.array([[[0.6, 1.0], [1.0, -0.7]]]), TWO_MASSES.sensors
    )
    groups = [mf.Group("shapes", shape="all")]
    names = TWO_MASSES.parameters
    bounds, nominal = dict.fromkeys(names, (0.2, 5.0)), dict.fromkeys(names, 1.0)
    problem = mf.updating_problem(TWO_MASSES, data, groups, bounds, nominal)
    result = solved(problem, [replace(PEAK, band=(0.5, 20.0), modes=2)], draws=3)
    theta = result["draw_theta"].values
    assert theta.std() > 0
    assert (
        "the posterior of predictions is that of what the data determine: where they leave k1 and "
        "k2 open, the models are those of optimal-weights"
    ) in list(map(str, findings_of(result, full=True)))


def test_show_tells_the_posterior_beside_the_range(
    drawn: xr.Dataset, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command("show", folder / "results", "--predictions") == 0
    out = " ".join(capsys.readouterr().out.split())
    s = drawn["posterior_failure_log_std"].values[1]
    for text in (
        f"± {drawn['posterior_frf_peak_std'].values[0]:.3g}",
        f"±  {np.exp(s):.3g}",
        f"{drawn['posterior_failure_probability'].values[0, 0]:.3e}",
        "drawn: over 5 models drawn from the posterior; the mean of P is the robust failure",
        "posterior: standard deviation around optimal-weights; of P as a factor",
    ):
        assert text.replace("±  ", "×÷ ") in out, text
    assert command("show", folder / "results", "--format", "json") == 0
    assert '"posterior_frf_peak_covariance"' in capsys.readouterr().out


@pytest.mark.slow(4)
def test_what_is_kept_is_not_taken_for_that_of_more_points(tmp_path: Path) -> None:
    write_example("three-story", tmp_path)
    study = replace(
        mf.load(tmp_path / "study.toml"),
        search=mf.Search(doubt=0.9),
        identifiability=mf.Identifiability(models=0),
        noise=mf.NoisePrior(weight=0),
        predictions=[PeakResponse("peak", "floor3", "floor1", damping=DAMPING)],
    )
    coarse, fine = (
        replace(study, pareto=mf.Pareto(points=3, refined=size)) for size in (None, 0.3)
    )
    mf.run(coarse, tmp_path / "results")
    assert mf.run(fine, tmp_path / "results").dataset.identical(mf.run(fine).dataset)
