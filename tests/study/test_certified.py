"""Studies on reduced models: the same results as in full, for a few full solutions."""

from __future__ import annotations

import re
import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse
import xarray as xr
from interruptions import interrupt_after
from refusals import command
from texts import two_of_each

import modefront as mf
from modefront._typing import Floats
from modefront.analysis.certified import AIM, certified_best, certified_front
from modefront.fem import grids
from modefront.front.front import Edge, Front
from modefront.front.pareto import pareto_front
from modefront.models.reduced.model import ReducedModel
from modefront.optim.sqp import Solution, given
from modefront.results.files import read_dataset
from modefront.study.check import check
from modefront.study.definition import Study
from modefront.work.store import Run
from modefront.work.task import Costs, Executor, R, Task, counted

pytestmark = [pytest.mark.slow(2), pytest.mark.usefixtures("short_chains")]

N = 14
STUDY = (
    """
[study]
name = "membrane"
seed = 2

[data]
file = "modes.csv"

[model]
kind = "matrices"
stiffness = { base = "K0.npz", k1 = "K1.npz", k2 = "K2.npz" }
mass = { base = "M.npz" }
sensors = { a = 25, b = 62, c = 107, d = 150, e = 172 }
reduction = 1e-8

"""
    + two_of_each(0.4, 2.5)
    + """
[pareto]
points = 3

[search]
doubt = 0.5
"""
)


def write_study(folder: Path) -> Path:
    """Write the study of a membrane with a stiff and a soft half, and of noisy modes of it."""
    X, cells = grids.plate(1.3, 1.0, N, N)
    number = np.full(len(X), -1)
    inside = (X[:, 0] > 0) & (X[:, 1] > 0) & (X[:, 1] < 1)
    number[inside] = np.arange(inside.sum())
    edges = np.concatenate([cells[:, [k, (k + 1) % 4]] for k in range(4)])
    middle = X[edges].mean(axis=1)[:, 0]
    terms = {}
    for name, part in (
        ("K0", middle > 1),
        ("K1", middle < 0.5),
        ("K2", (middle - 0.75) ** 2 < 0.0625),
    ):
        A = np.zeros((len(X), len(X)))
        for i, j in edges[part]:
            A[[i, j], [i, j]] += 1
            A[i, j] -= 1
            A[j, i] -= 1
        terms[name] = 1e4 * A[np.ix_(inside, inside)]
    size = int(inside.sum())
    terms["M"] = np.diag(np.where(np.arange(size) % 7 == 0, 0.0, 1.0))
    for name, A in terms.items():
        scipy.sparse.save_npz(folder / f"{name}.npz", scipy.sparse.csr_array(A))
    sensors = (25, 62, 107, 150, 172)
    model = mf.matrices(
        ["k1", "k2"],
        {"base": terms["K0"], "k1": terms["K1"], "k2": terms["K2"]},
        {"base": terms["M"]},
        dict(zip("abcde", sensors, strict=True)),
    )
    modes = model.modes(np.array([0.8, 1.6]), 3, derivatives=False)
    rng = np.random.default_rng(1)
    frequency = modes.frequency * (1 + 0.01 * rng.standard_normal(3))
    phi = modes.phi / np.abs(modes.phi).max(axis=0) + 0.03 * rng.standard_normal(modes.phi.shape)
    lines = ["set,mode,frequency,damping,a,b,c,d,e"]
    for r in range(3):
        lines.append(",".join(["x", str(r + 1), str(frequency[r]), "", *map(str, phi[:, r])]))
    (folder / "modes.csv").write_text("\n".join(lines))
    file = folder / "study.toml"
    file.write_text(STUDY)
    return file


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_study(tmp_path_factory.mktemp("membrane"))


@pytest.fixture(scope="module")
def whole(file: Path) -> xr.Dataset:
    return mf.run(mf.load(file), file.with_name("whole")).dataset


def variant(file: Path, name: str, old: str, new: str) -> Path:
    assert old in file.read_text()
    out = file.with_name(f"{name}.toml")
    out.write_text(file.read_text().replace(old, new))
    return out


@pytest.mark.slow(8)
def test_the_front_is_that_of_full_solutions(file: Path) -> None:
    """Without a posterior, whose chains would take most of the full solutions."""
    front = variant(file, "front", "[search]", "[noise]\nweight = 0\n\n[search]")
    whole = mf.run(mf.load(front)).dataset
    study = mf.load(variant(front, "off", "reduction = 1e-8", 'reduction = "off"'))
    full = mf.run(study).dataset
    assert "certified" not in full
    assert full.attrs["reduced_solutions"] == 0
    assert full.attrs["full_eigensolutions"] == full.attrs["model_evaluations"]
    assert whole["label"].values.tolist() == full["label"].values.tolist()
    span = np.diff(whole["bounds"].values, axis=1)[:, 0]
    assert (np.abs(whole["theta"].values - full["theta"].values) / span).max() < 1e-5
    assert whole["converged"].values.all()


def test_estimated_errors_are_the_true_ones(file: Path, whole: xr.Dataset) -> None:
    study = mf.load(variant(file, "errors", "reduction = 1e-8", 'reduction = "off"'))
    model = study.problem.model
    for i in range(whole.sizes["point"]):
        theta = whole["theta"].values[i]
        r = whole["paired_mode"].values[i].astype(int) - 1
        lam = model.modes(theta, 6, derivatives=False).lam[r]
        result = (2 * np.pi * whole["frequency"].values[i]) ** 2
        truth = np.abs(result / lam - 1)
        estimate = whole["eigenvalue_error"].values[i]
        assert (truth <= 3 * estimate + 1e-12).all()
        assert (estimate <= 2 * truth + 1e-12).all()


def test_a_few_full_solutions_are_enough_and_all_models_hold(whole: xr.Dataset) -> None:
    assert whole["certified"].values.all()
    for i in np.flatnonzero(~whole["minimum_certified"].values):
        of = str(whole["minimum_of"].values[i])
        J = whole["minimum_objective"].sel(group=of).values
        least = J[whole["minimum_of"].values == of].min()
        assert J[i] > 1.5 * least, "only what is clearly no best model may not hold"
        if whole["minimum_converged"].values[i]:  # at a jump, pairs may differ in the full model
            assert whole["minimum_eigenvalue_error"].values[i].max() < 1e-3
    assert float(whole["eigenvalue_error"].max()) <= whole.attrs["eigenvalue_tolerance"] == 1e-8
    assert whole.attrs["full_eigensolutions"] == 1
    # Both of the snapshot, one that probes the bounds, and one of each model that is reported.
    models = np.vstack([whole["theta"].values, whole["minimum_theta"].values])
    assert whole.attrs["factorisations"] <= 3 + len(np.unique(models, axis=0))
    assert 4 < whole.attrs["corrected_eigensolutions"] <= 10, "four of them at the bounds"
    assert whole.attrs["reduced_solutions"] < 2500, "most by the chains of the posterior"
    total = whole.attrs["full_eigensolutions"] + whole.attrs["reduced_solutions"]
    assert whole.attrs["model_evaluations"] == total


def test_an_interrupted_run_goes_on_to_the_same_digits(
    file: Path, whole: xr.Dataset, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    interrupt_after(20, monkeypatch)
    with pytest.raises(KeyboardInterrupt):
        mf.run(mf.load(file), tmp_path)
    xr.testing.assert_identical(mf.run(mf.load(file), tmp_path).dataset, whole)


def test_a_run_that_is_done_solves_nothing_again(file: Path, whole: xr.Dataset) -> None:
    study = mf.load(file)
    model = study.problem.model
    assert isinstance(model, ReducedModel)
    with counted() as costs:
        xr.testing.assert_identical(mf.run(study, file.with_name("whole")).dataset, whole)
    assert replace(costs, factorisations=0) == Costs(), "but for the units of parameters"


def test_run_shows_the_cost_and_show_the_errors(
    file: Path,
    whole: xr.Dataset,
    capfd: pytest.CaptureFixture[str],
) -> None:
    folder = file.with_name("shown")
    assert command("run", file, "-o", folder) == 0
    out = " ".join(capfd.readouterr().out.split())
    n = whole.attrs["full_eigensolutions"]
    corrected = whole.attrs["corrected_eigensolutions"]
    assert f"{n} full eigensolutions in" in out
    assert re.search(r"\d reduced in", out)
    assert command("show", folder, "--findings") == 0
    out = " ".join(capfd.readouterr().out.split())
    assert f"reduced basis from {n} full eigensolutions and {corrected} corrected" in out
    assert command("show", folder, "--points") == 0
    out = capfd.readouterr().out
    assert "estimated relative errors" in out
    assert "eigenvalue" in out


PREDICTION = """
[[predict.frf]]
name = "pushed"
force = "a"
response = ["b"]
damping = 0.02

"""


def test_predictions_are_made_in_full_and_that_is_said(
    file: Path,
    whole: xr.Dataset,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
) -> None:
    folder = shutil.copytree(file.with_name("whole"), tmp_path / "results")
    study = variant(file, "predicted", "[pareto]", f"{PREDICTION}[pareto]")
    assert command("run", study, "-o", folder) == 0
    capfd.readouterr()
    assert command("show", folder, "--findings") == 0
    out = " ".join(capfd.readouterr().out.split())
    data = read_dataset(folder)
    basis = whole.attrs["full_eigensolutions"]
    n = data.sizes["point"] + 4  # two models along each of two axes of the posterior
    assert data.attrs["prediction_eigensolutions"] == n
    assert data.attrs["full_eigensolutions"] == basis + n
    assert whole.attrs["prediction_eigensolutions"] == 0
    assert f"reduced basis from {basis} full eigensolutions" in out
    assert f"predictions are not reduced: they took {n} full eigensolutions" in out
    assert np.isfinite(data["posterior_frf_peak_std"].values).all()


def test_what_cannot_be_met_in_the_memory_is_said_and_is_an_exit_of_1(
    file: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    bytes_of_basis = 8 * 8 * N * (N - 1)
    small = variant(file, "small", "seed = 2", f"seed = 2\nmemory = {bytes_of_basis / 2**30}")
    folder = file.with_name("small")
    assert command("run", small, "-o", folder) == 1
    out, err = capfd.readouterr()
    out = " ".join(out.split())
    data = read_dataset(folder)
    failed = data["label"].values[~data["certified"].values]
    assert failed.size
    assert data.attrs["full_eigensolutions"] == 1
    assert "modes are less accurate than asked for" in out
    assert command("show", folder, "--findings") == 0
    listed = " ".join(capfd.readouterr().out.split())
    assert "modes are less accurate than asked for at" in listed
    assert f"errors above the tolerance, kept and marked: {', '.join(failed)}" in err


@pytest.mark.slow(3)
def test_a_model_without_a_basis_says_so(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = write_study(tmp_path)
    for name in ("K0", "K1", "K2", "M"):
        A = scipy.sparse.load_npz(tmp_path / f"{name}.npz").toarray()[50:140, 50:140]
        scipy.sparse.save_npz(tmp_path / f"{name}.npz", scipy.sparse.csr_array(A))
    text = file.read_text().replace("a = 25", "a = 5").replace("b = 62", "b = 32")
    text = (
        text.replace("c = 107", "c = 57").replace("d = 150", "d = 70").replace("e = 172", "e = 89")
    )
    file.write_text(text.replace("points = 3", "points = 2"))
    status = command("run", file)
    capfd.readouterr()
    assert status in (0, 1)
    assert command("show", tmp_path / "study-results", "--findings") == 0
    out = capfd.readouterr().out
    assert "no reduced basis: the model has only 90 degrees of freedom" in out


class Recorded(Run):
    """A run that remembers the names of its tasks, and which errors its snapshots accept."""

    def __init__(self) -> None:
        super().__init__()
        self.names: list[str] = []
        self.enough: dict[str, float] = {}

    def run(self, tasks: Sequence[Task[R]], /) -> list[R]:
        self.names += [task.name for task in tasks]
        snapshots = [task for task in tasks if task.stage == "snapshot"]
        self.enough |= {task.name: task.arguments[1].enough for task in snapshots}
        return super().run(tasks)


def searched(study: Study, work: Executor, known: Front | None) -> Front:
    problem, a = study.problem, study.problem.properties
    return pareto_front(problem, a, study.pareto, search=study.search, work=work, known=known)


def test_models_that_have_moved_get_a_snapshot_before_certificates(file: Path) -> None:
    study, run = mf.load(file), Recorded()
    moved = given(study.problem.evaluate(np.array([2.3, 0.5])))

    def search(*, work: Executor, known: Front | None) -> Front:
        """Find another branch in the second round."""
        front = searched(study, work, known)
        if known is None:
            return front
        points = [replace(x, solution=moved) if x.label == "nbi-1" else x for x in front.points]
        return replace(front, points=points)

    front = certified_front(study.problem, search, run)
    rounds = [name for name in run.names if name.startswith(("snapshot-ahead", "certificate"))]
    first = next(k for k, name in enumerate(rounds) if name.startswith("certificate"))
    assert "snapshot-ahead-1-round-2" in rounds[:first]
    accepted = [run.enough[f"snapshot-ahead-1-round-{number}"] for number in (1, 2)]
    assert accepted == [AIM * 1e-8, 1e-8]
    assert isinstance(study.problem.model, ReducedModel)
    known = study.problem.model.errors
    errors = [known[x.solution.theta.tobytes()][0].max() for x in front.points]
    assert max(errors) <= 1e-8


def test_a_minimum_as_good_as_the_best_one_gets_a_snapshot_before_certificates(file: Path) -> None:
    study, run = mf.load(file), Recorded()
    far = study.problem.evaluate(np.array([2.3, 0.5]))

    def search(*, work: Executor, known: Front | None) -> Front:
        """Find a minimum far away that is as good as the edge."""
        front = searched(study, work, known)
        edge, *others = front.edges
        twin = given(replace(far, J=edge.best.J))
        return replace(front, edges=[Edge(edge.best, [*edge.minima, twin]), *others])

    front = certified_front(study.problem, search, run)
    assert {name[-7:] for name in run.names if name.startswith("certificate")} == {"round-2"}
    theta = front.edges[0].minima[-1].theta
    assert isinstance(study.problem.model, ReducedModel)
    assert study.problem.model.errors[theta.tobytes()][0].max() <= 1e-9


def test_the_best_model_gets_snapshots_until_it_holds_in_the_full_one(file: Path) -> None:
    study, run = mf.load(file), Recorded()
    problem, starts = study.problem, []
    assert isinstance(problem.model, ReducedModel)
    problem.model.snapshots = (problem.model.first,)
    errors = problem.model.errors

    def find(known: Sequence[Floats], work: Executor) -> list[Solution]:
        """Find a model that the basis does not know."""
        starts.append(known)
        return [given(problem.evaluate(np.array([2.3, 0.5])))]

    (best,) = certified_best(problem, find, [problem.start], run)
    assert errors[best.theta.tobytes()][0].max() <= 1e-8
    assert [name for name in run.names if name.startswith("snapshot")]
    assert len(starts) > 1
    assert np.array_equal(starts[1], [best.theta]), "from where it was before"


def test_bounds_are_checked_in_the_full_model(file: Path) -> None:
    bounds = "nominal = 1.0\nbounds = [0.4, 2.5]\n\n[[parameter]]"
    weak = bounds.replace("[0.4", "[-1e-5")
    study = mf.load(variant(file, "weak", bounds, weak))
    problem = study.problem
    model = problem.model
    assert isinstance(model, ReducedModel)
    assert model.modes(problem.lower, 3, derivatives=False).lam[0] > 0, "the basis does not see it"
    assert any(
        "at the lower bounds" in warning and "indefinite" in warning
        for warning in check(study).warnings
    )
