"""Extensions from outside the package, each from its registration to the report."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from own_residuals import OneSet
from refusals import command
from two_masses import STUDY, write_study

import modefront as mf
from modefront._typing import Bools, Floats
from modefront.front.methods import METHODS
from modefront.modes.result import Modes
from modefront.options import Table
from modefront.pairing.match import Pairs
from modefront.residuals.base import Curvature, Member, ModeErrors, Scale
from modefront.study.file import FAMILIES

CHAIN = STUDY[STUDY.index("[model]") : STUDY.index("[[parameter]]")]


@pytest.fixture(autouse=True)
def nothing_stays_registered() -> Iterator[None]:
    before = [dict(family.added) for family in FAMILIES]
    yield
    for family, added in zip(FAMILIES, before, strict=True):
        family.added = added


def run(path: Path, capsys: pytest.CaptureFixture[str]) -> tuple[xr.Dataset, str]:
    """Return the results of a study and what all commands print of it."""
    output = path.parent / "results"
    for arguments in (["check", path], ["run", path, "-o", output], ["show", output, "--all"]):
        assert command(*arguments) == 0, capsys.readouterr().err
    assert command("report", output) == 0
    return mf.read_results(output).dataset, capsys.readouterr().out


# A kind of model


def read_springs(table: Table, parameters: Sequence[str]) -> Any:
    """Return the two masses with springs from a file."""
    name = table.text("springs", "the name of a file of stiffnesses")
    if name is None:
        return None
    k = [float(x) for x in table.path(name).read_text().split()]
    return mf.chain(
        parameters, [2.0, 1.0], k, stiffness_parameters=parameters, sensors={"low": 0, "high": 1}
    )


SPRINGS = mf.ModelKind("springs", read_springs)


def test_a_kind_of_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own = write_study(tmp_path, "")
    expected = mf.run(mf.load(own)).dataset
    text = own.read_text().replace(CHAIN, '[model]\nkind = "springs"\nsprings = "k.txt"\n\n')
    own.write_text(text)
    (tmp_path / "k.txt").write_text("3000 2000")
    with pytest.raises(mf.InputError, match="kind: expected one of 'chain', 'matrices', 'mesh', f"):
        mf.load(own)
    mf.register(SPRINGS)
    data, _ = run(own, capsys)
    np.testing.assert_array_equal(data["theta"].values, expected["theta"].values)
    own.write_text(text.replace("springs = ", "string = "))
    with pytest.raises(mf.InputError, match="did you mean 'springs'"):
        mf.load(own)


# A kind of residual: of the squares of frequencies


@dataclass(frozen=True, eq=False, kw_only=True)
class Eigenvalue(OneSet):
    """Relative errors of eigenvalues."""

    measured: Floats

    def margin(self, errors: ModeErrors) -> float:
        return float(errors.eigenvalue[self.mode[0]] ** 2)

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        return np.asarray(modes.lam[pairs.index[self.mode]] / self.measured - 1)

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        return self.r(modes, pairs), modes.dlam[pairs.index[self.mode]] / self.measured[:, None]

    def with_curvature(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, Curvature]:
        r, dr = self.with_slopes(modes, pairs)
        w = np.zeros(modes.lam.size)
        np.add.at(w, pairs.index[self.mode], 2 * r / self.measured)
        p = dr.shape[1]
        return r, dr, Curvature(w, np.zeros(modes.phi.shape), np.zeros((p, p)))


class EigenvalueKind:
    """Eigenvalues of the measured frequencies."""

    name = "eigenvalue"
    plural = "eigenvalues"
    usable_std = "none"

    def measured(self, data: mf.ModalData) -> Bools:
        return np.asarray(np.isfinite(data.frequency[0]))

    def has_usable_std(self, data: mf.ModalData, r: int) -> bool:
        return False

    def members(self, data: mf.ModalData, modes: Sequence[int], scale: Scale) -> list[Member]:
        return [self.stack(data, [r], scale) for r in modes]

    def stack(self, data: mf.ModalData, modes: Sequence[int], scale: Scale) -> Eigenvalue:
        lam = (2 * np.pi * data.frequency[0, list(modes)]) ** 2
        return Eigenvalue(mode=np.asarray(modes), measured=lam)


def test_a_kind_of_residual(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mf.register(EigenvalueKind())
    own = write_study(tmp_path, "")
    own.write_text(own.read_text().replace('frequency = "all"', 'eigenvalue = "all"'))
    data, out = run(own, capsys)
    edge = data.isel(point=data["label"].values == "edge-frequencies")
    ratio = edge["frequency"].values[0] / mf.load(own).problem.data.frequency[0]
    assert edge["objective"].values[0, 0] == pytest.approx(((ratio**2 - 1) ** 2).sum(), abs=1e-12)
    assert "derivatives agree" in out
    own.write_text(own.read_text().replace('eigenvalue = "all"', 'eigenvalues = "all"'))
    with pytest.raises(mf.InputError, match="did you mean 'eigenvalue'"):
        mf.load(own)


@pytest.mark.slow(2)
def test_residuals_without_standard_deviations_have_no_posterior(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mf.register(EigenvalueKind())
    own = write_study(tmp_path, "")
    text = own.read_text().replace('frequency = "all"', 'eigenvalue = "all"')
    own.write_text(text.replace("weight = 0", "weight = 4"))
    assert mf.load(own).noise.weight == 4
    found = mf.check(own)
    assert not found.mistakes, "nothing is wrong with such residuals"
    assert "not-expected" in [x.kind for x in found.cautions]
    data, out = run(own, capsys)
    assert "interval" not in data
    assert "most-probable" not in data["kind"].values
    assert "residuals without standard deviations" in " ".join(out.split())


# A front method


def algorithm(population: int) -> Any:
    """Return NSGA-II with other operators."""
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.operators.sampling.lhs import LHS

    return NSGA2(pop_size=population, sampling=LHS())


def test_a_front_method(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pymoo")
    options = 'method = "latin"\npopulation = 8\nevaluations = 40\n'
    own = write_study(tmp_path, "")
    own.write_text(own.read_text().replace("points = 3\n", options))
    with pytest.raises(mf.InputError, match=r"method: expected one of 'nbi', .*, found 'latin'"):
        mf.load(own)
    mf.register(mf.Method("latin", "NSGA-II from a Latin hypercube", None, algorithm))
    data, out = run(own, capsys)
    front = data["kind"].values == "front"
    assert set(data["label"].values[front]) == {f"latin-{k + 1}" for k in range(front.sum())}
    assert data.attrs["front_evaluations"] == 40
    assert "latin-1" in out


# A reader of files


def read_columns(path: Path, sensors: Sequence[str] | None) -> mf.ModalData:
    """Return modes from a file with a line a mode: frequency and components of the shape."""
    table = np.loadtxt(path, ndmin=2)
    names = sensors or [f"s{k}" for k in range(table.shape[1] - 1)]
    return mf.modal_data(table[:, 0], table[:, 1:], tuple(names))


@pytest.mark.slow(2)
def test_a_reader_of_modal_data(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own = write_study(tmp_path, "")
    measured = mf.load(own).problem.data
    table = np.column_stack([measured.frequency[0], measured.shape[0]])
    np.savetxt(tmp_path / "modes.txt", table, "%.17g")
    own.write_text(own.read_text().replace("modes.csv", "modes.txt"))
    with pytest.raises(mf.InputError, match=r"ends in \.csv, \.uff or \.unv, found 'modes\.txt'"):
        mf.load(own)
    mf.register(mf.DataReader(".txt", read_columns))
    data, _ = run(own, capsys)
    np.testing.assert_array_equal(data["measured_frequency"].values, measured.frequency[0])
    (tmp_path / "modes.txt").write_text("1.0 nonsense")
    with pytest.raises(mf.InputError, match=r"modes\.txt: file: expected a file of modal d"):
        mf.load(own)


def test_what_is_no_extension_is_refused() -> None:
    for wrong in (7, METHODS["nbi"], SPRINGS.__class__("chain", read_springs)):
        with pytest.raises(mf.InputError, match="register: expected"):
            mf.register(wrong)


def test_entry_points_bring_extensions(tmp_path: Path) -> None:
    """A kind of model and a class of predictions, in a process of its own, as the command is."""
    text = Path(__file__).read_text(encoding="utf-8")
    start, end = text.index("def read_springs"), text.index("\n\ndef test_a_kind_of_model")
    springs = text[start:end].replace(
        "table: Table, parameters: Sequence[str]) -> Any", "table, parameters)"
    )
    (tmp_path / "springs.py").write_text(f"import modefront as mf\n{springs}")
    text = (Path(__file__).parents[1] / "predictions" / "test_own.py").read_text(encoding="utf-8")
    own = "from refusals import command\nfrom two_masses import write_study\n"
    (tmp_path / "periods.py").write_text(text.split("TABLE =")[0].replace(own, ""))
    (tmp_path / "both-1.dist-info").mkdir()
    (tmp_path / "both-1.dist-info" / "METADATA").write_text("Name: both\nVersion: 1\n")
    (tmp_path / "both-1.dist-info" / "entry_points.txt").write_text(
        "[modefront.models]\nsprings = springs:SPRINGS\n"
        "[modefront.predictions]\nperiod = periods:Period\n"
    )
    study = write_study(tmp_path, '\n[[predict.period]]\nname = "slow"\nmode = 5\n')
    (tmp_path / "k.txt").write_text("3000 2000")
    model = '[model]\nkind = "springs"\nsprings = "k.txt"\n\n'
    study.write_text(study.read_text().replace(CHAIN, model))
    done = subprocess.run(
        [sys.executable, "-m", "modefront", "check", str(study)],
        env=os.environ
        | {"PYTHONPATH": os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.endswith("expected a mode from 1 to 2, found 5"), "the model of springs has two"
