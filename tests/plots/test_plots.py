"""Pictures of results: what they show, for every method and any number of groups."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import modefront as mf
from modefront.plots import write_figures
from modefront.plots.quantities import PLOTS, Plots, figures
from modefront.results.results import Results

pytestmark = pytest.mark.usefixtures("short_chains")

SEARCH = mf.Search(doubt=0.5)
OPEN = mf.Identifiability(models=0)
FREQUENCIES, SHAPES = mf.Group("freq $x$", frequency="all"), mf.Group("shapes", shape="all")
LOW, HIGH = mf.Group("low", shape=[1]), mf.Group("high", shape=[2])


def problem(groups: list[mf.Group]) -> mf.UpdatingProblem:
    """Return the problem of a chain of two stiffnesses with standard deviations of its data."""
    names = ["k1", "$k_2$"]
    model = mf.chain(names, [1.0, 1.0], [900.0, 800.0], stiffness_parameters=names)
    modes = model.modes(np.array([1.1, 0.9]), 2)
    f = modes.frequency * [1.02, 0.99]
    shape = modes.phi.T + np.array([[0.02, 0.0], [0.0, -0.03]])
    std = np.full(shape.shape, 0.02)
    data = mf.modal_data(f, shape, model.sensors, frequency_std=0.01 * f, shape_std=std)
    bounds, nominal = dict.fromkeys(names, (0.2, 5.0)), dict.fromkeys(names, 1.0)
    return mf.updating_problem(model, data, groups, bounds, nominal)


def solved(groups: list[mf.Group], **options: Any) -> Results:
    return mf.solve(problem(groups), search=SEARCH, identifiability=OPEN, **options)


@pytest.fixture(scope="module")
def two() -> Results:
    push = mf.PeakResponse("push", response=["floor1", "floor2"], force="floor2", damping=0.02)
    return solved([FREQUENCIES, SHAPES], points=5, predictions=[push])


@pytest.fixture(scope="module")
def three() -> Results:
    return solved([FREQUENCIES, LOW, HIGH], points=3, noise=mf.NoisePrior(weight=0))


@pytest.fixture(scope="module")
def single_group() -> Results:
    return solved([FREQUENCIES], noise=mf.NoisePrior(weight=0))


def lines(figure: Figure) -> list[Any]:
    return [line for axes in figure.axes for line in axes.lines]


def texts(figure: Figure) -> str:
    return " ".join(text.get_text() for text in figure.findobj() if hasattr(text, "get_text"))


def test_the_front_of_two_groups_is_drawn_in_the_space_of_errors(two: Results) -> None:
    figure = two.plot.front()
    (axes,) = figure.axes
    assert axes.get_xlabel() == r"error of freq \$x\$"
    drawn = {line.get_label(): np.column_stack(line.get_data()) for line in axes.lines}
    data = two.dataset
    front = data["kind"].values == "front"
    chosen = front & data["pareto"].values
    np.testing.assert_array_equal(drawn["Pareto optimal"], data["error"].values[chosen])
    nominal = data["kind"].values == "nominal"
    np.testing.assert_array_equal(drawn["nominal"], data["error"].values[nominal])
    assert two.plot.front(log=True).axes[0].get_xscale() == "log"


def test_a_nominal_model_that_cannot_be_solved_takes_no_other_one_away(two: Results) -> None:
    error = two.dataset["error"].copy()
    error[two.dataset["kind"].values == "nominal"] = np.inf
    (axes,) = Plots(two.dataset.assign(error=error)).front(log=True).axes
    (path, *_), front = axes.lines, two.dataset["kind"].values == "front"
    assert np.asarray(path.get_ydata()).max() == error.values[front, 1].max()


def test_lattice_points_of_three_groups_are_not_joined(three: Results) -> None:
    figure = three.plot.front()
    pairs = [axes for axes in figure.axes if axes.get_xlabel().startswith("error")]
    assert pairs[0].get_xlabel() == r"error of freq \$x\$"
    for axes in pairs:
        assert all(line.get_linestyle() == "None" for line in axes.lines)
    for name in ("frequencies", "mac", "parameters"):
        figure = getattr(three.plot, name)()
        assert len(figure.axes) == 2, "a panel for each of two parameters or modes"
        for line in lines(figure):
            assert line.get_linestyle() in ("None", "--", ":") or line.get_marker() == "_"


def test_a_single_group_is_drawn_too(single_group: Results) -> None:
    figure = single_group.plot.front()
    ticks = [tick.get_text() for tick in figure.axes[0].get_yticklabels()]
    assert [tick.replace("\\$", "$") for tick in ticks] == single_group["label"].values.tolist()


def test_standard_deviations_are_drawn_as_bars(two: Results) -> None:
    figure = two.plot.parameters()
    assert [axes.get_title("left") for axes in figure.axes] == ["k1", r"\$k_2\$"]
    ends = [np.ptp(line.get_ydata()) for line in figure.axes[0].lines if line.get_marker() == "_"]
    std = two["theta_std"].values[two["kind"].values != "edge", 0]
    expected = 2 * np.append(std[np.isfinite(std)], two["posterior_std"].values[0])
    np.testing.assert_allclose(sorted(ends), sorted(expected))


def test_the_ranges_of_predictions_are_over_the_reference(two: Results) -> None:
    figure = two.plot.predictions()
    (axes,) = figure.axes
    names = [tick.get_text() for tick in axes.get_yticklabels()]
    assert len(names) == 4
    assert names[0].startswith("push, floor1: peak (")
    widths = [line.get_xdata() for line in axes.lines if line.get_linewidth() == 5][:2]
    peak = two["frf_peak"].values[:, 0]
    best = two["label"].values.tolist().index(two.attrs["reference"])
    ratio = (peak / peak[best])[two["pareto"].values]
    assert list(np.asarray(widths[0])) == pytest.approx([ratio.min(), ratio.max()])
    wide = two["frf_peak_range"].copy()
    wide[:2, 0] = [0.5 * peak[best], 3 * peak[best]]  # of equivalent models, beyond the points
    std = two["posterior_frf_peak_std"].copy()
    std[0] = 0.6 * peak[best]
    changed = two.dataset.assign(frf_peak_range=wide, posterior_frf_peak_std=std)
    (axes,) = Plots(changed).predictions().axes
    for width, ends in ((5, [0.5, 3]), (1.2, [0.4, 1.6])):
        first = next(line.get_xdata() for line in axes.lines if line.get_linewidth() == width)
        assert list(np.asarray(first)) == pytest.approx(ends)


def test_draws_of_the_posterior_are_drawn_in_pairs(two: Results, three: Results) -> None:
    (pair,) = (axes for axes in two.plot.corner().axes if axes.get_ylabel())
    drawn = [np.asarray(line.get_xydata()) for line in pair.lines]
    assert any(np.array_equal(x, two["sample_theta"].values) for x in drawn)
    assert len(two.plot.corner(["k1"]).axes) == 1
    with pytest.raises(KeyError, match="no parameter 'k3'"):
        two.plot.corner(["k3"])
    with pytest.raises(mf.InputError, match="expected results with draws of a posterior"):
        three.plot.corner()


def test_what_results_do_not_hold_is_said(three: Results) -> None:
    with pytest.raises(mf.InputError, match="expected results with predictions, found none"):
        three.plot.predictions()
    bare = three.dataset.drop_vars([x for x in three.dataset.variables if "std" in str(x)])
    with pytest.raises(mf.InputError, match="errors of the data"):
        Plots(bare).uncertainty()


def test_all_pictures_are_written(two: Results, tmp_path: Path) -> None:
    paths = write_figures(figures(two.dataset), tmp_path)
    assert {path.stem for path in paths} >= {*PLOTS, "frf-push"} - {"modes"}
    assert all(path.read_bytes().startswith(b"<?xml") for path in paths)


@pytest.mark.parametrize(
    ("form", "start"), [("svg", b"<?xml"), ("png", b"\x89PNG"), ("pdf", b"%PDF")]
)
def test_the_file_of_a_picture_is_the_same_again(
    form: str, start: bytes, two: Results, tmp_path: Path
) -> None:
    first, again = (
        write_figures(iter([("front", two.plot.front())]), tmp_path / name, form)[0].read_bytes()
        for name in "ab"
    )
    assert first.startswith(start)
    assert first == again


@pytest.mark.slow(3)
def test_every_picture_is_shown_by_notebooks(three: Results) -> None:
    for _, figure in figures(three.dataset):
        assert figure._repr_svg_().lstrip().startswith("<?xml")


def test_matplotlib_is_asked_for(two: Results, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(mf.InputError, match=re.escape("pip install modefront[figures]")):
        two.plot.front()


def with_shapes(results: Results, *, geometry: bool) -> xr.Dataset:
    """Return results with mode shapes at sensors, and at the nodes of a frame in space."""
    chosen = ["drawn_node", "line", "face", "basis", "sensor", "set", "model_mode"]
    data = results.dataset.drop_dims(chosen, errors="ignore")
    count = data.sizes["point"], data.sizes["mode"]
    shape = np.tile([[0.5, 1.0], [1.0, -0.7]], (count[0], 1, 1))
    out = data.assign(
        shape=(("point", "mode", "sensor"), shape),
        measured_shape=(("set", "mode", "sensor"), -3 * shape[:1]),
    ).assign_coords(sensor=["floor1", "floor2"], set=["1"])
    if not geometry:
        return out
    basis = np.zeros((1, 4, 3))
    basis[0, :, 0] = [0.0, 0.5, 1.0, 1.0]
    return out.assign(
        node=(("drawn_node", "axis"), np.eye(4)[:, :3] + [0, 0, 1]),
        line_nodes=(("line", "line_end"), [[0, 1], [1, 2]]),
        face_nodes=(("face", "corner"), [[1, 2, 3, -1]]),
        sensor_node=(("sensor",), [1, 2]),
        sensor_direction=(("sensor", "axis"), [[1.0, 0, 0], [1.0, 0, 0]]),
        shape_basis=(("basis", "drawn_node", "axis"), basis),
        shape_coefficient=(("point", "mode", "basis"), np.ones((*count, 1))),
    )


def test_measured_shapes_are_drawn_over_the_model(two: Results) -> None:
    figure = Plots(with_shapes(two, geometry=False)).modes()
    assert len(figure.axes) == 2
    model, measured = (
        next(line for line in figure.axes[0].lines if line.get_label() == name)
        for name in ("model", "measured")
    )
    assert list(np.asarray(model.get_ydata())) == pytest.approx([0.5, 1.0])
    assert list(np.asarray(measured.get_ydata())) == pytest.approx(
        [0.5, 1.0]
    )  # in the scale of the model
    assert "mode 1: " in texts(figure)
    with pytest.raises(KeyError, match="nominal"):
        Plots(with_shapes(two, geometry=False)).modes("none")


@pytest.mark.parametrize("kind", ["chain", "mesh"])
def test_shapes_are_drawn_at_all_nodes(two: Results, kind: str) -> None:
    data = with_shapes(two, geometry=True)
    data.attrs["geometry"] = kind
    figure = Plots(data).modes("nominal")
    figure.canvas.draw()
    assert [axes.name for axes in figure.axes] == ["rectilinear" if kind == "chain" else "3d"] * 2


def test_legends_of_long_names_stay_in_the_picture(three: Results) -> None:
    groups = [f"group with a name of some length, number {i}" for i in range(3)]
    labels = [
        f"edge-{groups[i % 3]}" if kind == "edge" else str(label)
        for i, (label, kind) in enumerate(
            zip(three.dataset["label"].values, three.dataset["kind"].values, strict=True)
        )
    ]
    data = three.dataset.assign_coords(group=groups).assign(label=("point", labels))
    for figure in (Plots(data).uncertainty(), Plots(data).minima()):
        figure.canvas.draw()
        for legend in figure.legends:
            box = legend.get_window_extent()
            assert box.x0 >= -1
            assert box.x1 <= figure.bbox.width + 1
