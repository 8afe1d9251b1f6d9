"""Results of several studies side by side, against what is computed by hand."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from modefront._typing import Floats
from modefront.errors import InputError
from modefront.predictions import Passage
from modefront.predictions.base import as_text
from modefront.results.compare import compare
from modefront.results.files import FILE, write
from modefront.results.schema import ATTRIBUTES, FORMAT, variables_of


def results(
    error: list[list[float]],
    theta: list[list[float]],
    *,
    parameters: tuple[str, ...] = ("k1", "k2"),
    groups: tuple[str, ...] = ("f", "s"),
    piece: list[int] | None = None,
) -> xr.Dataset:
    """Return results of a front of these points, and an optimally weighted model at the last."""
    e = np.array([*error, error[-1]])
    t = np.array([*theta, theta[-1]])
    count = len(error)
    point, group = ("point", "group"), ("point", "parameter")
    pareto = [
        all((e[j] >= e[i]).any() or (e[j] == e[i]).all() for j in range(count))
        for i in range(count)
    ]

    def ends(values: Floats) -> Floats:
        low, high = (end(values[[*pareto, True]], axis=0) for end in (np.min, np.max))
        return np.stack([low, high, high / low])

    failures = np.column_stack([t[:, 0], 2 * t[:, 0]])
    variables: dict[str, object] = {
        "label": (("point",), [*(f"nbi-{i + 1}" for i in range(count)), "optimal-weights"]),
        "kind": (("point",), [*["front"] * count, "optimal-weights"]),
        "pareto": (("point",), [*pareto, True]),
        "dominated_among_front": (("point",), [*(not x for x in pareto), False]),
        "error": (point, e),
        "objective": (point, e**2),
        "weight": (point, e),
        "stationary_weight": (point, e),
        "theta": (group, t),
        "converged": (("point",), [True] * (count + 1)),
        "status": (("point",), ["converged"] * (count + 1)),
        "frequency": (("point", "mode"), t[:, :1] * 10),
        "mac": (("point", "mode"), 1 - t[:, :1] / 100),
        "paired_mode": (("point", "mode"), np.ones((count + 1, 1))),
        "measured_frequency": (("mode",), [10.0]),
        "exact": (("group",), [False] * len(groups)),
        "bounds": (("parameter", "bound"), [[0.0, 2.0]] * len(parameters)),
        "minimum_of": (("minimum",), ["f"]),
        "minimum_theta": (("minimum", "parameter"), t[:1]),
        "minimum_objective": (("minimum", "group"), e[:1]),
        "failure_probability": (("point", "failure"), failures),
        "failure_probability_range": (("range", "failure"), ends(failures)),
        "frequency_range": (("range", "mode"), ends(10 * t[:, :1])),
        "finding": (("finding",), np.array([], dtype=str)),
    }
    if piece:
        variables["piece"] = (("point",), [*piece, piece[-1]])
    sizes = {"point": count + 1, "parameter": len(parameters), "group": len(groups), "failure": 2}
    sizes |= {"range": 3, "set": 1, "end": 0}
    for name, x in variables_of([Passage.kind]).items():
        if name.startswith("failure_") and name not in variables:
            of: type = {"text": str, "truth": bool}.get(x.values, float)
            shape = [sizes.get(each, 2) for each in x.dimensions]
            variables[name] = (x.dimensions, np.zeros(shape, of))
    data = xr.Dataset(
        variables,
        coords={
            "parameter": list(parameters),
            "group": list(groups),
            "mode": [1],
            "failure": ["drift: 0.1", "drift: 0.2"],
            "range": ["minimum", "maximum", "spread"],
        },
    )
    data.attrs |= {
        name: "" if attribute.values == "text" else 0 for name, attribute in ATTRIBUTES.items()
    }
    data.attrs |= {"format": FORMAT, "method": "nbi", "study": "a", "version": "1"}
    data.attrs["reference"] = "optimal-weights"
    data.attrs["prediction_kinds"] = as_text([Passage.kind])
    return data


def save(folder: Path, data: xr.Dataset) -> Path:
    folder.mkdir()
    write(data, folder / FILE)
    return folder


@pytest.fixture
def two(tmp_path: Path) -> tuple[Path, Path]:
    results_one = results(
        [[0.0, 3.0], [1.0, 2.0], [3.0, 2.5], [3.0, 0.0]], [[1, 1], [1, 1.2], [9, 9], [1, 2]]
    )
    other = results(
        [[0.0, 7.0], [2.0, 5.0], [6.0, 1.0], [7.0, 0.0]],
        [[1.4, 5.0], [1.4, 5.0], [1.4, 5.0], [1.4, 5.0]],
        parameters=("k1", "other"),
        piece=[1, 1, 2, 2],
    )
    return save(tmp_path / "one", results_one), save(tmp_path / "other", other)


def test_fronts_are_measured_in_the_space_of_errors(two: tuple[Path, Path]) -> None:
    first, second = compare(two).fronts
    assert (first.points, second.points) == (3, 4), "a dominated point does not count"
    assert first.length == pytest.approx(np.sqrt(2) + 2 * np.sqrt(2))
    assert second.length == pytest.approx(2 * np.sqrt(2) + np.sqrt(2)), "without the gap"
    assert (first.length_ratio, second.length_ratio) == pytest.approx((1.0, 1.0))
    assert first.extent == (3.0, 3.0)
    assert first.distance == pytest.approx(np.sqrt(5))
    assert first.optimal_distance == pytest.approx(3.0)


def test_results_without_a_pareto_optimal_model_are_refused(tmp_path: Path) -> None:
    data = results([[0.0, 3.0], [3.0, 0.0]], [[1.0, 1.0], [1.0, 2.0]])
    data["pareto"] = np.logical_and(data["pareto"], False)
    with pytest.raises(InputError, match="'pareto': expected at least one Pareto-optimal model"):
        compare([save(tmp_path / "one", data)])


def test_distances_are_those_in_common_parameters_over_their_bounds(
    two: tuple[Path, Path],
) -> None:
    (apart,) = compare(two).pairs
    assert apart.common == ("k1",)
    assert (apart.least, apart.greatest, apart.optimal) == pytest.approx((0.2, 0.2, 0.2))
    (same,) = compare([two[0], two[0]]).pairs
    assert (same.least, same.greatest, same.optimal) == (0.0, 0.0, 0.0)


def test_predictions_have_their_spread_and_further_ones_are_found(two: tuple[Path, Path]) -> None:
    first = compare(two).fronts[0]
    spreads = {
        prediction.name: (prediction.least, prediction.greatest) for prediction in first.predictions
    }
    assert spreads["frequency 1"] == (10.0, 10.0)
    assert spreads["mac 1"] == pytest.approx((0.99, 0.99))
    assert spreads["failure_probability drift: 0.2"] == (2.0, 2.0)
    assert {
        parameter.name: (parameter.least, parameter.greatest) for parameter in first.parameters
    } == {
        "k1": (1.0, 1.0),
        "k2": (1.0, 2.0),
    }


def test_what_cannot_be_compared_is_said_at_once(two: tuple[Path, Path], tmp_path: Path) -> None:
    odd = save(tmp_path / "odd", results([[1.0, 1.0]], [[1, 1]], groups=("f", "shapes")))
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / FILE).write_bytes(b"no netCDF")
    with pytest.raises(InputError) as wrong:
        compare((two[0], odd, tmp_path / "absent", tmp_path / "bad"))
    absent, bad, groups = map(str, wrong.value.faults)
    assert f"odd: groups: expected those of {two[0]}: f, s, found f, shapes" in groups
    assert "absent/results.nc: file: expected results of a finished run, found no such" in absent
    assert "bad/results.nc: file: expected results in netCDF" in bad


def test_a_front_of_one_point_has_no_length(two: tuple[Path, Path], tmp_path: Path) -> None:
    results_one = results([[1.0, 1.0]], [[1, 1]])
    results_one["label"] = ("point", ["edge-f", "optimal-weights"])
    results_one["kind"] = ("point", ["edge", "optimal-weights"])
    point = save(tmp_path / "point", results_one)
    first, second = compare((point, two[0])).fronts
    assert (first.points, first.length, first.extent) == (1, 0.0, (0.0, 0.0))
    assert np.isnan(second.length_ratio)


def test_models_beside_the_front_count_where_they_are_better(
    two: tuple[Path, Path], tmp_path: Path
) -> None:
    data = results([[0.0, 3.0], [3.0, 0.0]], [[1, 1], [1, 1.5]])
    error, theta = data["error"].values.copy(), data["theta"].values.copy()
    error[2], theta[2] = [0.5, 0.5], [0.5, 1.9]
    better = data.assign(error=(("point", "group"), error), theta=(data["theta"].dims, theta))
    better.attrs["reference"] = "nbi-2"
    (result, _) = compare((save(tmp_path / "better", better), two[0])).fronts
    assert result.points == 2
    assert result.distance == pytest.approx(np.sqrt(0.5))
    assert result.extent == (3.0, 3.0)
    assert [(x.least, x.greatest, x.reference) for x in result.parameters] == [
        (0.5, 1.0, 1.0),
        (1.0, 1.9, 1.5),
    ]
    assert result.reference == "nbi-2"
    assert result.reference_distance == 3.0
