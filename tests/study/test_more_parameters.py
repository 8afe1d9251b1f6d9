"""More parameters than data: the model that the data prefer, and the sentences on it."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from interruptions import interrupt_after

import modefront as mf
from modefront._typing import Floats
from modefront.analysis import certified
from modefront.front.front import Front
from modefront.front.search import Search
from modefront.identifiability.combinations import Identifiability

pytestmark = pytest.mark.usefixtures("short_chains")

NAMES = tuple(f"k{i + 1}" for i in range(6))
SEARCH = Search(doubt=0.5)
TRUTH = np.array([1.2, 0.8, 1.1, 0.9, 1.3, 0.75])
GROUPS = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]


def problem(*, std: bool) -> mf.UpdatingProblem:
    """A chain of six stiffnesses, of which two modes are measured at three floors."""
    model = mf.chain(
        *(NAMES, [1000.0] * 6, [2e6] * 6),
        stiffness_parameters=NAMES,
        sensors={"low": 1, "middle": 3, "top": 5},
    )
    rng = np.random.default_rng(3)
    modes = model.modes(TRUTH, 2)
    f_std, shape_std = 0.005 * modes.frequency, np.full((2, 3), 0.02 * np.abs(modes.phi).max())
    f = modes.frequency + f_std * rng.normal(size=2)
    shape = modes.phi.T + shape_std * rng.normal(size=(2, 3))
    data = mf.modal_data(
        *(f, shape, model.sensors),
        frequency_std=f_std if std else None,
        shape_std=shape_std if std else None,
    )
    bounds, nominal = dict.fromkeys(NAMES, (0.4, 2.5)), dict.fromkeys(NAMES, 1.0)
    return mf.updating_problem(model, data, GROUPS, bounds, nominal)


@cache
def solved(*, std: bool) -> tuple[xr.Dataset, Front]:
    """Return the results, and the front with all models that were evaluated for it."""
    fronts, search = list[Front](), certified.certified_front

    def kept(*given: Any) -> Front:
        fronts.append(search(*given))
        return fronts[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(certified, "certified_front", kept)
        data = mf.solve(
            *(problem(std=std),),
            points=5,
            seed=2,
            search=SEARCH,
            identifiability=Identifiability(models=0),
        ).dataset
    return data, fronts[0]


def row(data: xr.Dataset, label: str) -> xr.Dataset:
    return data.isel(point=data["label"].values.tolist().index(label))


@pytest.mark.slow(2)
@pytest.mark.parametrize("std", [True, False])
def test_the_most_probable_model_is_preferred_where_all_is_fitted_exactly(std: bool) -> None:
    data, _ = solved(std=std)
    assert data.attrs["reference"] == "most-probable"
    best = row(data, "most-probable")
    assert bool(best["converged"])
    assert (best["error"].values < [0.005, 0.03]).all(), "six values, and as many parameters"
    low, _, high = data["interval"].values.T
    assert ((low <= TRUTH) & (TRUTH <= high)).sum() >= 5
    assert (data["trust"].values != "determined").any()
    assert "most-probable" in set(data["combination_at"].values)


def test_without_expectation_equal_weights_are_and_what_to_do_is_said() -> None:
    data = mf.solve(
        problem(std=False),
        points=3,
        search=SEARCH,
        identifiability=Identifiability(models=0),
        noise=mf.NoisePrior(weight=0),
    ).dataset
    assert "most-probable" not in data["label"].values
    assert "interval" not in data
    if "optimal-weights" in data["label"].values:
        assert data.attrs["reference"] == "optimal-weights"
    else:
        assert data.attrs["reference"] == "equal-weights"
        (message,) = [text for text in data["finding"].values if "no optimal-weights" in text]
        assert "equal-weights takes the place of optimal-weights" in message
        assert "a weight in [noise]" in message


def dominated(J: Floats, known: Floats, scale: Floats) -> bool:
    """Return whether a known model dominates J, with the tolerance that results state."""
    for other in (known - J) / scale:
        gain, loss = float(-other.min()), float(other.max())
        if gain > 1e-6 and loss <= min(1e-6, 1e-7 * gain):
            return True
    return False


@pytest.mark.slow(2)
@pytest.mark.parametrize("std", [True, False])
def test_pareto_is_what_no_model_reported_or_evaluated_dominates(std: bool) -> None:
    data, front = solved(std=std)
    assert front.scale is not None
    known = [data["objective"].values, data["minimum_objective"].values, front.known]
    known += [data["end_objective"].values, data["equal_objective"].values]
    everything = np.vstack([J[np.isfinite(J).all(axis=1)] for J in known])
    expected = [not dominated(J, everything, front.scale) for J in data["objective"].values]
    assert data["pareto"].values.tolist() == expected
    along = data["kind"].values == "front"
    J = data["objective"].values
    among = [
        on and dominated(chosen, J[along], front.scale) for on, chosen in zip(along, J, strict=True)
    ]
    assert data["dominated_among_front"].values.tolist() == among


@pytest.mark.slow(2)
@pytest.mark.parametrize("std", [True, False])
def test_no_edge_is_worse_than_any_evaluated_model(std: bool) -> None:
    data, front = solved(std=std)
    labels = data["label"].values.tolist()
    for i, name in enumerate(("frequencies", "shapes")):
        edge = data["objective"].values[labels.index(f"edge-{name}")]
        assert edge[i] <= front.known[:, i].min() * (1 + 1e-6) + 1e-10
        as_good = front.known[front.known[:, i] <= edge[i] * (1 + 1e-6)]
        assert (as_good[:, 1 - i] >= edge[1 - i] * (1 - 1e-3) - 1e-10).all()


STUDY = """
[study]
name = "more parameters than data"
seed = 2

[data]
file = "modes.csv"

[model]
kind = "chain"
masses = [1000.0, 1000.0, 1000.0, 1000.0]
stiffnesses = [2e6, 2e6, 2e6, 2e6]
stiffness_parameters = ["k1", "k2", "k3", "k4"]
sensors = { low = 1, top = 3 }

[[group]]
name = "frequencies"
frequency = "all"

[[group]]
name = "shapes"
shape = "all"

[pareto]
points = 4

[search]
doubt = 0.5

[identifiability]
models = 0
""" + "".join(
    f'\n[[parameter]]\nname = "k{i + 1}"\nnominal = 1.0\nbounds = [0.4, 2.5]\n' for i in range(4)
)

DATA = """set,mode,frequency,frequency_std,damping,low,low_std,top,top_std
a,1,2.45,0.012,,0.62,0.02,1.0,0.02
a,2,7.25,0.036,,1.0,0.02,-0.71,0.02
"""


@pytest.mark.slow(3)
def test_a_run_that_is_interrupted_goes_on_to_the_same_digits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "modes.csv").write_text(DATA)
    (tmp_path / "study.toml").write_text(STUDY)
    study = mf.load(tmp_path / "study.toml")
    whole = mf.run(study, tmp_path / "whole").dataset
    assert whole.attrs["reference"] == "most-probable"
    # As many values as parameters: all are fitted, and no model is better by more than rounding.
    assert whole.attrs["front_is_a_point"]
    assert (whole["pareto"].values == (whole["kind"].values != "nominal")).all()
    written = len(list((tmp_path / "whole").rglob("*.npz")))
    for tasks in (3, written - 2):
        interrupt_after(tasks, monkeypatch)
        with pytest.raises(KeyboardInterrupt):
            mf.run(mf.load(tmp_path / "study.toml"), tmp_path / f"broken-{tasks}")
        again = mf.run(mf.load(tmp_path / "study.toml"), tmp_path / f"broken-{tasks}").dataset
        assert again.identical(whole)
