"""Results on parameters that data do not determine, and on errors of the data."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from texts import two_of_each

import modefront as mf
from modefront._typing import Floats
from modefront.results.remarks import findings_of

pytestmark = pytest.mark.usefixtures("short_chains")

NAMES = ("k1", "k2", "k3")
MODEL = mf.chain(NAMES, [2.0, 1.5, 1.0], [3e3, 2e3, 4e3], stiffness_parameters=NAMES)
SEARCH = mf.Search(doubt=0.5)


def problem_of(*, sets: int = 1, std: float = 0.0, seed: int = 0) -> mf.UpdatingProblem:
    """A chain whose data no model fits, in several sets or with standard deviations."""
    rng = np.random.default_rng(seed)
    modes = MODEL.modes(np.array([1.2, 0.8, 1.1]), 3)
    f = modes.frequency * (1 + np.array([0.03, -0.02, 0.02]))
    phi = modes.phi.T * (1 + 0.05 * rng.normal(size=(3, 3)))
    f = f * (1 + 0.003 * rng.normal(size=(sets, 3)) * (sets > 1))
    phi = phi + 0.01 * rng.normal(size=(sets, 3, 3)) * (sets > 1)
    known = {}
    if std:
        size = np.abs(phi).max(axis=2, keepdims=True) * np.ones(phi.shape)
        known = {"frequency_std": std * f, "shape_std": std * size}
    data = mf.modal_data(f, phi, MODEL.sensors, **known)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    return mf.updating_problem(
        MODEL, data, groups, dict.fromkeys(NAMES, (0.1, 9.0)), dict.fromkeys(NAMES, 1.0)
    )


@cache
def results(source: str, drawings: int = 2) -> xr.Dataset:
    problem = problem_of(sets=8) if source == "sets" else problem_of(std=0.002)
    return mf.solve(
        problem,
        points=2,
        seed=1,
        search=SEARCH,
        uncertainty=mf.Uncertainty("auto", bootstrap=drawings),
        noise=mf.NoisePrior(weight=0),
    ).dataset


def value_of(data: xr.Dataset, name: str, label: str) -> Floats:
    return np.asarray(data[name].values[data["label"].values.tolist().index(label)])


def test_combinations_are_in_the_results_and_in_words() -> None:
    data = results("std")
    chosen = (data["combination_at"].values == "optimal-weights") & (
        data["combination_of"].values == "shapes"
    )
    share = data["combination_share"].values[chosen]
    assert (share[:2] > 1e-3).all()
    assert share[2] < 1e-7
    direction = data["combination_direction"].values[chosen][2]
    assert direction == pytest.approx(np.ones(3) / np.sqrt(3), abs=1e-6)
    text = (
        "at optimal-weights: group shapes determines 2 of 3 combinations of parameters; "
        "k1, k2 and k3 can be scaled together: no shape changes"
    )
    assert text in data["finding"].values.tolist()
    assert text in list(map(str, findings_of(data, full=True)))
    assert np.diag(data["collinearity"].values) == pytest.approx(1)


def test_the_scale_of_all_stiffnesses_is_followed_to_the_bounds() -> None:
    data = results("std")
    chosen = data["equal_of"].values == "shapes"
    theta = data["equal_theta"].values[chosen]
    assert set(data["equal_extent"].values[chosen]) == {"bounded"}
    assert set(data["equal_dimension"].values[chosen]) == {1}
    edge = value_of(data, "theta", "edge-shapes")
    assert theta / theta[:, :1] == pytest.approx(np.tile(edge / edge[0], (len(theta), 1)), rel=1e-6)
    assert theta.min() == pytest.approx(0.1, rel=1e-9)
    assert theta.max() == pytest.approx(9.0, rel=1e-9)
    steps = np.linalg.norm(np.diff(theta, axis=0), axis=1) / 8.9
    assert steps.max() < 0.06
    assert (np.diff(theta[:, 0]) * np.sign(theta[-1, 0] - theta[0, 0]) > 0).all()
    J = data["equal_objective"].values[chosen, 1]
    assert np.ptp(J) < 1e-9 * J[0]


def test_exact_fits_of_the_frequencies_are_points() -> None:
    data = results("std")
    chosen = data["equal_of"].values == "frequencies"
    assert set(data["equal_extent"].values[chosen]) == {"isolated"}
    theta = data["equal_theta"].values[chosen]
    assert (data["equal_objective"].values[chosen, 0] < 1e-15).all()
    for k in theta:
        modes = MODEL.modes(k, 3).frequency
        assert modes == pytest.approx(problem_of(std=0.002).data.frequency[0], rel=1e-7)


@pytest.mark.slow(4)
@pytest.mark.parametrize("source", ["std", "sets"])
def test_linearised_scatter_is_that_of_synthetic_data(source: str) -> None:
    """100 drawings tell a standard deviation to 7 %; where it is smooth, the linear one agrees.

    Of K sets the bootstrap has the variance of their distribution, (K - 1) / K of the estimate, and
    8 sets tell it to twice the error.
    """
    factor, limit = (np.sqrt(7 / 8), 0.28) if source == "sets" else (1.0, 0.14)
    data = results(source, 100)
    for label in ("edge-frequencies", "edge-shapes", "equal-weights", "optimal-weights", "nbi-2"):
        for name in ("theta", "objective"):
            linear = factor * value_of(data, f"{name}_std", label)
            drawn = value_of(data, f"bootstrap_{name}_std", label)
            kept = linear > 1e-3 * linear.max()
            assert linear[kept] == pytest.approx(drawn[kept], rel=limit), (label, name)
    covariance = value_of(data, "theta_covariance", "optimal-weights")
    assert np.sqrt(np.diag(covariance)) == pytest.approx(
        value_of(data, "theta_std", "optimal-weights")
    )
    assert value_of(data, "theta_std", "nbi-2") == pytest.approx(
        value_of(data, "theta_std", "edge-shapes")
    )


@pytest.mark.slow(6)
def test_points_of_three_groups_scatter_as_synthetic_data_do() -> None:
    """60 drawings tell a standard deviation to 9 %: within the simplex, on its border, beyond.

    Where errors change which objectives bound a point, the linear scatter is doubted.
    """
    base = problem_of(std=0.002)
    groups = (
        mf.Group("frequencies", frequency="all"),
        mf.Group("shape 1", shape=[1]),
        mf.Group("others", shape=[2, 3]),
    )
    problem = mf.UpdatingProblem(base.model, base.data, groups, base.lower, base.upper, base.start)
    data = mf.solve(
        problem, points=4, seed=1, search=SEARCH, uncertainty=mf.Uncertainty("std", bootstrap=60)
    ).dataset
    along = data["front_part"].values == "whole"
    inside = (data["lattice"].values >= 0).all(axis=1)
    within = np.isin(data["label"].values, data["lattice_label"].values[inside])
    assert (along & within).sum() > 2, "some lie within the simplex"
    assert (along & ~within).any(), "some lie beyond it"
    doubt = data["scatter_doubt"].values
    assert set(doubt[along]) <= {"", "switches"}
    sound = along & (doubt == "")
    assert sound.sum() > along.sum() / 2
    for name in ("theta", "objective"):
        linear = data[f"{name}_std"].values[sound]
        drawn = data[f"bootstrap_{name}_std"].values[sound]
        kept = linear > 1e-3 * linear.max(axis=0)
        assert linear[kept] == pytest.approx(drawn[kept], rel=0.26), name
        assert np.median(linear[kept] / drawn[kept]) == pytest.approx(1, abs=0.1), name


def test_predictions_scatter_with_the_parameters() -> None:
    data = results("std")
    theta, C = (
        value_of(data, "theta", "equal-weights"),
        value_of(data, "theta_covariance", "equal-weights"),
    )
    df = MODEL.modes(theta, 3).dfrequency
    expected = np.sqrt(np.diag(df @ C @ df.T))
    assert value_of(data, "frequency_std", "equal-weights") == pytest.approx(expected, rel=1e-5)


def test_the_posterior_is_that_of_the_optimally_weighted_model() -> None:
    data = results("std")
    problem = problem_of(std=0.002)
    theta, C = value_of(data, "theta", "optimal-weights"), data["posterior_covariance"].values
    a = problem.properties

    def half(theta: Floats) -> float:
        return float(a @ np.log(problem.evaluate(theta, derivatives=False).J)) / 2

    # Along each axis of the covariance, half of I rises by 1/2 at one standard deviation.
    lam, V = np.linalg.eigh(C)
    for size, v in zip(np.sqrt(lam), V.T, strict=True):
        step = 0.05 * size * v
        rise = half(theta + step) + half(theta - step) - 2 * half(theta)
        assert rise == pytest.approx(0.05**2, rel=0.02)
    df = MODEL.modes(theta, 3).dfrequency
    expected = np.sqrt(np.diag(df @ C @ df.T))
    assert data["posterior_frequency_std"].values == pytest.approx(expected, rel=1e-5)


def test_what_is_not_asked_for_is_not_there() -> None:
    problem = problem_of(std=0.002)
    data = mf.solve(
        problem,
        points=2,
        search=SEARCH,
        identifiability=mf.Identifiability(flat=0, models=0),
        uncertainty=mf.Uncertainty("none"),
        noise=mf.NoisePrior(weight=0),
    ).dataset
    assert "theta_std" not in data
    assert "bootstrap_theta" not in data
    assert data.sizes["equal"] == 0
    assert "posterior_std" in data


def test_a_front_that_is_a_point_has_no_scatter_to_speak_of() -> None:
    modes = MODEL.modes(np.array([1.2, 0.8, 1.1]), 3)
    data = mf.modal_data(
        modes.frequency, modes.phi.T, MODEL.sensors, frequency_std=0.01 * modes.frequency
    )
    problem, without = replace(problem_of(), data=data), mf.NoisePrior(weight=0)
    result = mf.solve(problem, points=4, search=SEARCH, noise=without).dataset
    assert result.attrs["front_is_a_point"]
    assert np.isnan(result["theta_std"].values).all()
    assert any("no standard deviations are known at" in text for text in result["finding"].values)


STUDY = (
    """
[study]
name = "valley"

[data]
file = "modes.csv"

[model]
kind = "chain"
masses = [2.0, 1.0]
stiffnesses = [3000.0, 2000.0]
stiffness_parameters = ["k1", "k2"]

"""
    + two_of_each()
    + """
[pareto]
points = 3

[search]
doubt = 0.5

[identifiability]
models = 5
step = 0.2

[uncertainty]
source = "sets"
bootstrap = 2

[noise]
weight = 0
"""
)


def write_data(folder: Path) -> None:
    (folder / "modes.csv").write_text(
        "set,mode,frequency,damping,floor1,floor2\n"
        "a,1,4.2,,0.6,1.0\na,2,10.5,,1.0,-0.7\nb,1,4.1,,0.62,1.0\nb,2,10.4,,1.0,-0.68\n"
    )


THREE = """[[group]]
name = "shapes"
shape = [1]

[[group]]
name = "shape 2"
shape = [2]
"""


def test_the_scatter_of_three_groups_runs_on_with_the_same_digits(tmp_path: Path) -> None:
    write_data(tmp_path)
    head, tail = STUDY.split('[[group]]\nname = "shapes"\nshape = "all"\n')
    (tmp_path / "study.toml").write_text(head + THREE + tail)
    first = mf.run(mf.load(tmp_path / "study.toml"), tmp_path / "results").dataset
    tasks = tmp_path / "results" / "tasks"
    for file in [*tasks.rglob("second-derivatives-nbi-*.npz"), *tasks.rglob("bootstrap-*.npz")]:
        file.unlink()
    again = mf.run(mf.load(tmp_path / "study.toml"), tmp_path / "results").dataset
    assert again.identical(first)
    along = first["front_part"].values == "whole"
    assert np.isfinite(first["theta_std"].values[along]).all()
    assert np.isfinite(first["bootstrap_theta_std"].values[along]).any()


@pytest.mark.parametrize("tolerance", [0.0, 0.05])
def test_a_study_runs_on_with_the_same_digits_and_shows_all(
    tolerance: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from modefront.cli.show import LISTS, print_results

    write_data(tmp_path)
    text = STUDY.replace("points = 3", f"points = 3\ntolerance = {tolerance}")
    (tmp_path / "study.toml").write_text(text)
    study = mf.load(tmp_path / "study.toml")
    first = mf.run(study, tmp_path / "results").dataset
    for file in (tmp_path / "results" / "tasks").rglob("second-derivatives-*.npz"):
        file.unlink()
    again = mf.run(mf.load(tmp_path / "study.toml"), tmp_path / "results").dataset
    assert again.identical(first)
    solved = ~np.isin(first["kind"].values, ["nominal", "most-probable"])
    assert np.isfinite(first["theta_std"].values[solved]).all()
    message = first["finding"].values.tolist()
    assert not any(
        "no standard deviations are known" in text or "bootstrap" in text for text in message
    )
    assert again.attrs["model_evaluations"] == first.attrs["model_evaluations"]
    print_results(mf.read_results(tmp_path / "results").dataset, list(LISTS))
    out = " ".join(capsys.readouterr().out.split())
    for text in (
        "scatter by errors of the data: standard deviations, linearised",
        "scatter over data drawn again: standard deviations",
        "posterior around optimal-weights",
        "k1 and k2 can be scaled together: no shape changes",
        "a curve of models fits shapes equally well: k1 from",
        "(5 models, by",
        "uncertainty of the data is taken from the scatter of the data sets",
    ):
        assert text in out
