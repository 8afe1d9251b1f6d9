"""A class of predictions from outside the package, from its table in a study file to the report."""

from __future__ import annotations

import base64
import gzip
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self

import numpy as np
import pytest
import xarray as xr
from refusals import command
from two_masses import write_study

import modefront as mf
from modefront._typing import Floats
from modefront.errors import Fault
from modefront.models.base import Model
from modefront.options import check_fields, text, whole
from modefront.predictions import ResultVariable, Setting
from modefront.predictions.base import kinds_in
from modefront.reports.page import payload, topics
from modefront.results.compare import _models, _spreads


@dataclass(frozen=True)
class Period:
    """The period of a mode of the model."""

    name: Annotated[str, text("a name")]
    mode: Annotated[int, whole(1, 9)] = 1

    kind: ClassVar = mf.PredictionKind(
        "period",
        "period",
        (ResultVariable("period_length", "period", "period of the mode", "s"),),
        (Setting("period_mode", "mode of the model", "count"),),
    )

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def places(self) -> tuple[str, ...]:
        return (f"{self.name}: mode {self.mode}",)

    @property
    def heading(self) -> str:
        return f"{self.name}: period of mode {self.mode}"

    @property
    def settings(self) -> Mapping[str, Sequence[Any]]:
        return {"period_mode": [self.mode]}

    def faults(self, model: Model, _: mf.ModalData) -> Iterator[Fault]:
        if self.mode > model.size:
            yield Fault("", "mode", f"a mode from 1 to {model.size}", str(self.mode))

    def complete(self, _: mf.UpdatingProblem) -> Self:
        return self

    def evaluate(
        self, problem: mf.UpdatingProblem, theta: Floats, _: np.random.SeedSequence
    ) -> Mapping[str, Floats]:
        f = problem.model.modes(theta, self.mode, derivatives=False).frequency
        return {"period": 1 / f[-1:]}

    def check(
        self, _problem: mf.UpdatingProblem, _theta: Floats, _seed: np.random.SeedSequence
    ) -> Mapping[str, Floats]:
        return {}


TABLE = '\n[[predict.period]]\nname = "slow"\n'


@pytest.fixture(scope="module", autouse=True)
def registered() -> None:
    assert mf.register(Period) is Period
    assert mf.register(Period) is Period, "a class may be registered again"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("own")
    study = mf.load(write_study(root, TABLE))
    mf.run(study, root / "results")
    return root / "results"


@pytest.fixture(scope="module")
def data(folder: Path) -> xr.Dataset:
    return mf.read_results(folder).dataset


def test_results_hold_its_values_and_their_meaning(data: xr.Dataset) -> None:
    assert [kind.table for kind in kinds_in(data)] == ["period"]
    T = data["period_length"]
    assert T.dims == ("point", "period")
    assert T.attrs == {"long_name": "period of the mode", "units": "s"}
    assert T.values[:, 0] == pytest.approx(1 / data["frequency"].values[:, 0])
    least, greatest, _ = data["period_length_range"].values[:, 0]
    optimal = T.values[data["pareto"].values, 0]
    assert (least, greatest) == (optimal.min(), optimal.max())
    # 1 / f varies relatively as f does.
    (best,) = np.flatnonzero(data["label"].values == data.attrs["reference"])
    share = data["posterior_frequency_std"].values[0] / data["frequency"].values[best, 0]
    std = data["posterior_period_length_std"].values[0]
    assert std == pytest.approx(share * T.values[best, 0], rel=0.01)


def test_studies_are_compared_by_ranges_of_equivalent_models_too(data: xr.Dataset) -> None:
    wide = data["period_length_range"].copy()
    wide[:2, 0] = [0.01, 9.0]
    models, chosen, _ = _models(data.assign(period_length_range=wide))
    (spread,) = _spreads("period_length", "", models, chosen)
    assert (spread.least, spread.greatest) == (0.01, 9.0)
    assert spread.reference == chosen["period_length"].values[0, 0]


def test_the_study_file_checks_it(tmp_path: Path) -> None:
    path = write_study(tmp_path, TABLE + "mode = 3\n")
    with pytest.raises(mf.InputError, match=r"\('slow'\) mode: expected a mode from 1 to 2, fou"):
        mf.load(path)
    path = write_study(tmp_path, TABLE + "mood = 1\n")
    with pytest.raises(mf.InputError, match="did you mean 'mode'"):
        mf.load(path)
    path = write_study(tmp_path, TABLE.replace("period", "periods"))
    with pytest.raises(mf.InputError, match="did you mean 'period'"):
        mf.load(path)


def test_everything_shows_it(
    folder: Path, data: xr.Dataset, capsys: pytest.CaptureFixture[str]
) -> None:
    for arguments in (["show", "--predictions"], ["show"], ["compare", "--all", folder]):
        assert command(*arguments, folder) == 0
        assert "period" in capsys.readouterr().out, arguments
    _, packed = payload([("results", data)])
    assert b'"title":"slow","place":"slow: mode 1"' in gzip.decompress(base64.b64decode(packed))
    (axes,) = mf.read_results(folder).plot.predictions().axes
    assert axes.get_yticklabels()[0].get_text().startswith("slow, mode 1: period")
    compared = mf.compare([folder, folder]).fronts[0].predictions
    assert "period_length slow: mode 1" in [spread.name for spread in compared]
    assert any("period of slow" in x for said in topics(data).values() for x, _ in said)


def test_a_kind_that_results_cannot_hold_is_refused(tmp_path: Path) -> None:
    start, taken = mf.load(write_study(tmp_path, "")), "objective"
    kind = mf.PredictionKind(
        taken, taken, (ResultVariable(f"{taken}_std", "size", "what is taken"),)
    )
    taking: type[Any] = type("Taking", (Period,), {"kind": kind})
    with pytest.raises(mf.InputError, match="expected variables that nothing else of the resul"):
        replace(start, predictions=[taking("other")])
    with pytest.raises(mf.InputError, match="name: expected one that begins with a_, found b_x"):
        mf.PredictionKind("a", "a", (ResultVariable("b_x", "x", "x"),))
    with pytest.raises(mf.InputError, match="expected a frozen dataclass"):
        mf.register(type("Bare", (), {}))
    with pytest.raises(mf.InputError, match="expected a table of its own, found 'period', of"):
        mf.register(type("Other", (Period,), {}))


def test_a_kind_without_ranges_is_predicted_where_equivalent_models_count_too(
    tmp_path: Path,
) -> None:
    variable = ResultVariable("plain_length", "period", "period of the mode", "s", ranged=False)
    kind = mf.PredictionKind("plain", "plain", (variable,))
    plain: type[Any] = type("Plain", (Period,), {"kind": kind})
    study = mf.load(write_study(tmp_path, ""))
    data = mf.run(replace(study, predictions=[plain("slow")], slack=0.1)).data
    frequency = data["frequency"].values[:, 0]
    assert data["plain_length"].values[:, 0] == pytest.approx(1 / frequency)
    assert "plain_length_range" not in data
