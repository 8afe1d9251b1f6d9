"""Predictions through the whole path of a study, against solutions that share nothing with it."""

import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from interruptions import interrupt_at
from refusals import command
from scipy.signal import lsim
from two_masses import FRF, MASSES, PASSAGE, QUICK, ZETA, direct, matrices, run, write_study

import modefront as mf
from modefront._typing import Floats
from modefront.errors import InputError, ModelError, UnfinishedError
from modefront.models.base import Transfer
from modefront.models.matrices import MatrixModel
from modefront.plots import write_figures
from modefront.plots.quantities import figures
from modefront.predictions import Passage, PeakResponse
from modefront.predictions.reliability import gaussian_response
from modefront.results.files import read_dataset
from modefront.study.examples import write_example
from modefront.work.store import Store
from modefront.work.task import Task

AXES = 4
"""Models along the two axes of the posterior that each prediction is made with besides."""


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    return run(tmp_path_factory.mktemp("all"), FRF + PASSAGE)


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, xr.Dataset]:
    """The folder and the results of a run with few samples."""
    folder = tmp_path_factory.mktemp("quick")
    return folder, run(folder, FRF + QUICK)


def assert_peaks(
    data: xr.Dataset,
    name: str,
    zeta: Floats,
    load: Floats,
    output: Floats,
    order: int,
    rigid: float,
) -> None:
    """Assert that |T| of the direct solution has its greatest value where it was found."""
    i = data["frf"].values.tolist().index(name)
    low, high = data["frf_band"].values[i]

    def size(theta: Floats, f: Floats) -> Floats:
        w = 2j * np.pi * f
        return np.abs(w**order * direct(theta, zeta, load, output, f) + rigid)

    for theta, peak, frequency in zip(
        data["theta"].values,
        data["frf_peak"].values[:, i],
        data["frf_peak_frequency"].values[:, i],
        strict=True,
    ):
        # Ever finer grids about the greatest value; two peaks may be nearly as high.
        middle, width = (low + high) / 2, high - low
        for count in (8001, 801, 801, 801, 801):
            grid = np.linspace(middle - width / 2, middle + width / 2, count)[1:-1]
            sizes = size(theta, grid)
            middle, width = grid[sizes.argmax()], width / 100
        assert size(theta, np.array([frequency]))[0] == pytest.approx(peak, rel=1e-10)
        assert peak == pytest.approx(sizes.max(), rel=1e-12)
        assert frequency == pytest.approx(middle, rel=1e-7)


@pytest.mark.slow(3)
def test_peaks_are_those_of_the_direct_solution(results: xr.Dataset) -> None:
    force = np.array([0.0, 2.0])
    for name, output in (("low", [1.0, 0.0]), ("drift", [-1.0, 1.0])):
        assert_peaks(results, f"pushed: {name}", ZETA, force, np.array(output), 1, 0.0)
    # Measured damping: 0.03 in the mean of the first mode, and so in the second one.
    for name, output in (("low", [1.0, 0.0]), ("middle", [0.5, 0.5])):
        zeta = np.array([0.03, 0.03])
        assert_peaks(results, f"shaken: {name}", zeta, -MASSES, np.array(output), 2, 0.0)
    zeta = np.array([0.02, 0.02])
    assert_peaks(results, "ridden: high", zeta, -MASSES, np.array([0.0, 1.0]), 2, 1.0)


@pytest.mark.slow(3)
def test_a_moving_base_is_the_force_of_inertia(results: xr.Dataset) -> None:
    for name in ("low", "middle"):
        first, other = (
            results["frf_peak"].sel(frf=f"{key}: {name}") for key in ("shaken", "as if shaken")
        )
        assert first.values == pytest.approx(other.values, rel=1e-12)


@pytest.mark.slow(1)
def test_a_response_without_a_peak_is_said_to_have_none(results: xr.Dataset) -> None:
    assert np.isnan(results["frf_peak"].sel(frf="overdamped: low")).all()
    assert np.isnan(results["frf_peak_range"].sel(frf="overdamped: low")).all()


@pytest.mark.slow(1)
def test_ranges_are_those_of_the_front_and_not_of_its_points(results: xr.Dataset) -> None:
    """Of these three points no one is near the least probability, which is within the front."""
    optimal = results.isel(point=results["pareto"].values)
    for name in ("frequency", "frf_peak", "frf_peak_frequency", "failure_probability"):
        least, greatest, spread = results[f"{name}_range"].values
        among = np.array([optimal[name].min("point"), optimal[name].max("point")])
        known = np.isfinite(among).all(axis=0)
        assert (least[known] <= among[0, known]).all()
        assert (greatest[known] >= among[1, known]).all()
        assert np.isnan(least[~known]).all()
        np.testing.assert_array_equal(spread, greatest / least)
    least = results["failure_probability_range"].sel(range="minimum").values
    assert (least < 0.5 * optimal["failure_probability"].min("point").values).all()
    assert results["range"].values.tolist() == ["minimum", "maximum", "spread"]


def monte_carlo(theta: Floats, dt: float, samples: int, seed: int) -> Floats:
    """Return the greatest drift of each sample, by SciPy's integrator of the whole structure."""
    K, M, omega, phi = matrices(theta)
    C = M @ phi @ np.diag(0.04 * omega) @ phi.T @ M
    soil, damping = 2 * np.pi * 4.0, 0.6
    A = np.zeros((6, 6))
    A[:2, 2:4] = np.eye(2)
    A[2:4, :2], A[2:4, 2:4] = -np.linalg.solve(M, K), -np.linalg.solve(M, C)
    A[2:4, 4:] = -np.array([soil**2, 2 * damping * soil])
    A[4, 5], A[5, 4:] = 1.0, [-(soil**2), -2 * damping * soil]
    B = np.zeros((6, 1))
    B[5] = 1.0
    drifts = np.zeros((2, 6))
    drifts[0, 0], drifts[1, :2] = 1.0, [-1.0, 1.0]
    steps = round(6.0 / dt)
    t = np.arange(steps + 1) * dt
    q = np.interp(t[:-1] + dt / 2, [0.0, 2.0, 4.0], [0.0, 1.0, 0.5])
    rng = np.random.default_rng(seed)
    out = np.zeros(samples)
    pulse = np.zeros(steps + 1)
    pulse[0] = 1.0
    _, h, _ = lsim((A, B, drifts, np.zeros((2, 1))), pulse, t, interp=False)
    for k in range(samples):
        w = np.sqrt(np.pi * 0.05 / dt) * q * rng.standard_normal(steps)
        x = [np.convolve(w, column)[:steps] for column in h[1:].T]
        out[k] = np.abs(x).max()
    return out


@pytest.mark.slow(1)
def test_drift_probabilities_are_those_of_an_own_monte_carlo(results: xr.Dataset) -> None:
    samples = 1500
    for position in (0, results["kind"].values.tolist().index("optimal-weights")):
        theta = results["theta"].values[position]
        largest = monte_carlo(theta, 0.01, samples, seed=position + 7)
        for i, level in enumerate((0.02, 0.025)):
            P = results["failure_probability"].values[position, i]
            error = P * results["failure_variation"].values[position, i]
            counted = float(np.mean(largest > level))
            assert 0.01 < counted < 0.9
            chosen = np.sqrt(counted * (1 - counted) / samples)
            assert abs(P - counted) < 4 * np.hypot(error, chosen)


@pytest.mark.slow(1)
def test_what_a_probability_depends_on_is_told_with_it(results: xr.Dataset) -> None:
    reported = {
        "level": [0.02, 0.025],
        "duration": [6.0] * 2,
        "step": [0.01] * 2,
        "density": [0.05] * 2,
        "sided": ["one-sided"] * 2,
        "samples": [1500] * 2,
        "method": ["importance"] * 2,
        "modes": [2] * 2,
        "load": ["base along x"] * 2,
        "halved_at": ["optimal-weights"] * 2,
    }
    for name, values in reported.items():
        assert results[f"failure_{name}"].values.tolist() == values
    # Responses are smooth at this step: halving it makes little difference.
    ratio, error = results["failure_halved"].values, results["failure_halved_error"].values
    assert np.all(np.abs(ratio - 1) < 0.1 + 4 * error)


def assert_same(first: xr.Dataset, other: xr.Dataset) -> None:
    xr.testing.assert_identical(first.drop_attrs(), other.drop_attrs())
    assert first.attrs == other.attrs


@pytest.mark.slow(4)
def test_an_interrupted_run_predicts_the_same_digits(
    quick: tuple[Path, xr.Dataset], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for task in ("predict-shaken-point-nbi-2", "predict-drifts-point-edge", "half-step"):
        interrupt_at(task, monkeypatch)
        with pytest.raises(KeyboardInterrupt):
            run(tmp_path, FRF + QUICK)
        assert not (tmp_path / "results" / "results.nc").exists()
    assert_same(run(tmp_path, FRF + QUICK), quick[1])


@pytest.mark.slow(4)
def test_other_predictions_do_no_old_work_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run(tmp_path, FRF)
    written: list[str] = []
    write = Store.write

    def note(store: Store, task: Task[Any], *rest: Any) -> None:
        written.append(task.name)
        write(store, task, *rest)

    monkeypatch.setattr(Store, "write", note)
    again = run(tmp_path, FRF.replace("damping = [0.02, 0.03]", "damping = 0.05"))
    evaluated = again.sizes["point"] + AXES + 1
    assert len(written) == evaluated
    assert all(name.startswith("predict-pushed-") for name in written)
    assert (tmp_path / "results" / "results.1.nc").exists(), "other results are kept"
    run(tmp_path, "")
    assert len(written) == evaluated


@pytest.mark.slow(1)
def test_eigenproblems_of_predictions_are_counted(results: xr.Dataset, tmp_path: Path) -> None:
    plain = run(tmp_path, "")
    predictions = 5 + 1
    more = results.attrs["model_evaluations"] - plain.attrs["model_evaluations"]
    of_ranges = more - predictions * (plain.sizes["point"] + AXES) - 1
    assert 0 < of_ranges < plain.attrs["model_evaluations"]
    assert results.attrs["prediction_eigensolutions"] == more
    for name in plain.variables:
        np.testing.assert_array_equal(plain[name], results[name])


def test_a_time_step_too_long_for_a_model_that_was_found(tmp_path: Path) -> None:
    study = write_study(tmp_path, PASSAGE.replace("step = 0.01", "step = 0.024"))
    text = study.read_text()
    # The nominal model is too soft by far, and its step is long enough.
    study.write_text(text.replace("nominal = 1.0", "nominal = 0.5"))
    with pytest.raises(
        InputError, match=r"\('drifts'\) step: expected at most 0\.02\d* s.*'nbi-1'"
    ):
        mf.run(mf.load(study), tmp_path / "results")
    assert not (tmp_path / "results" / "results.nc").exists()


def test_a_model_without_the_modes_that_are_wanted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = mf.load(write_study(tmp_path, FRF))

    transfer = MatrixModel.transfer

    def refuse(model: MatrixModel, theta: Floats, *rest: Any) -> Transfer:
        if (theta != study.problem.start).any():
            raise ModelError("no such modes")
        return transfer(model, theta, *rest)

    monkeypatch.setattr(MatrixModel, "transfer", refuse)
    with pytest.raises(UnfinishedError, match="no prediction 'pushed' of 'nbi-1': no such modes"):
        mf.run(study, tmp_path / "results")


def test_several_inputs_have_noise_of_their_own(tmp_path: Path) -> None:
    """Independent noises of densities 4 S and S at two places add up in the variance."""
    quiet = PASSAGE.replace("samples = 1500", "samples = 2").replace("filter", "# ")
    both = quiet.replace('base = "x"', 'force = [{ low = 2.0 }, "high"]')
    study = mf.load(write_study(tmp_path, both))
    (passage,) = study.predictions
    assert isinstance(passage, Passage)
    problem = passage.problem(study.problem, np.ones(2))
    assert problem.system.input.shape == (2, 2)
    total = gaussian_response(problem).deviation ** 2
    parts = np.zeros_like(total)
    for force in ("{ low = 2.0 }", '"high"'):
        study = mf.load(write_study(tmp_path, quiet.replace('base = "x"', f"force = {force}")))
        (prediction,) = study.predictions
        assert isinstance(prediction, Passage)
        parts += gaussian_response(prediction.problem(study.problem, np.ones(2))).deviation ** 2
    assert total == pytest.approx(parts, rel=1e-9, abs=1e-12 * parts.max())


@pytest.mark.slow(3)
def test_in_memory_and_from_a_file_are_the_same(
    quick: tuple[Path, xr.Dataset], tmp_path: Path
) -> None:
    study = mf.load(write_study(tmp_path, FRF + QUICK))
    assert [prediction.name for prediction in study.predictions][-1] == "drifts"
    data = mf.solve(
        *(study.problem,),
        points=3,
        seed=3,
        search=study.search,
        predictions=study.predictions,
        noise=study.noise,
    ).dataset
    for name in quick[1].variables:
        np.testing.assert_array_equal(data[name], quick[1][name])


SHAKEN_BUILDING = """
[[predict.frf]]
name = "shaken"
base = "x"
response = ["floor3", "back", "side"]
damping = 0.02

[model.outputs]
back = { node = 112, direction = "-x" }
side = { node = 112, direction = "y" }
"""


def test_outputs_of_a_mesh(tmp_path: Path) -> None:
    write_example("three-story-fe-c0", tmp_path)
    study = tmp_path / "study.toml"
    study.write_text(study.read_text() + SHAKEN_BUILDING)
    loaded = mf.load(study)
    (shaken,) = loaded.predictions
    assert isinstance(shaken, PeakResponse)
    result = shaken.evaluate(loaded.problem, loaded.problem.start, np.random.SeedSequence(0))
    # Both ends of a floor move alike, and along x alone.
    assert result["peak"][1] == pytest.approx(result["peak"][0], rel=1e-3)
    assert not result["peak"][2] > 1e-3 * result["peak"][0]
    first = loaded.problem.modes(loaded.problem.start, derivatives=False)[0].frequency[0]
    assert result["frequency"][0] == pytest.approx(first, rel=1e-3)
    # One mode of displacement: its participation 1.2 to 1.3, 1 / (2 zeta omega^2) of the base's.
    amplitude = result["peak"][0] * 2 * 0.02 * (2 * np.pi * first) ** 2
    assert 1.15 < amplitude < 1.35


@pytest.mark.slow(4)
def test_show_prints_and_draws_predictions(
    quick: tuple[Path, xr.Dataset],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    folder, data = quick
    shutil.copytree(folder / "results", tmp_path / "results")
    assert command("show", tmp_path / "results", "--predictions", "--figures") == 0
    out = capsys.readouterr().out
    words = " ".join(out.split())
    for text in (
        "pushed: force at 2 high; mobility, greatest peak from 0 to 20 Hz, 2 modes, damping 0.02",
        "two-sided barrier) within 6 s, at rest at first; one-sided spectral density 0.05, time",
        "at optimal-weights: probability with half the time step over that with the step given",
        f"{data['frf_peak_range'].values[1, 0]:.5g}",
        "spread",
    ):
        assert text in words
    names = ["front", "parameters", "frequencies", "mac", "modes", "predictions"]
    names += ["frf-pushed", "frf-shaken", "frf-as-if-shaken", "frf-ridden", "frf-overdamped"]
    names += ["failure-drifts", "uncertainty", "minima"]
    paths = [tmp_path / "results" / "figures" / f"{name}.svg" for name in names]
    assert out.splitlines()[: len(names)] == [f"wrote {path}" for path in paths]
    assert "next: modefront report" in words
    drawn = [path.read_bytes() for path in paths]
    assert all(b"</svg>" in content for content in drawn)
    assert [
        p.read_bytes() for p in write_figures(figures(read_dataset(tmp_path / "results")), tmp_path)
    ] == drawn

    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert command("show", tmp_path / "results", "--figures") == 2
    assert "pip install modefront[figures]" in capsys.readouterr().err


@pytest.mark.slow(4)
def test_models_are_drawn_without_a_front_too(results: xr.Dataset, tmp_path: Path) -> None:
    single = results.isel(point=results["kind"].values != "front")
    paths = write_figures(figures(single), tmp_path)
    assert len(paths) == 14
    assert all(path.read_bytes().endswith(b"</svg>\n") for path in paths)
    plain = results.drop_dims(["frf", "failure", "range"])
    names = [path.name for path in write_figures(figures(plain), tmp_path / "plain")]
    assert names[:4] == ["front.svg", "parameters.svg", "frequencies.svg", "mac.svg"]
    assert not [name for name in names if name.startswith(("frf", "failure", "predictions"))]
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="a folder that can be written to"):
        write_figures(figures(plain), tmp_path / "file")
