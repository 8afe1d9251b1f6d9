"""Figures of the paper for several studies."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import modefront as mf
from modefront.plots import write_figures
from modefront.plots.paper import figures
from modefront.results.results import Results
from modefront.study.examples import write_example

pytestmark = pytest.mark.usefixtures("short_chains")

SEARCH = mf.Search(doubt=0.5)


@pytest.fixture(scope="module")
def building(tmp_path_factory: pytest.TempPathFactory) -> Results:
    """The chain of the three-story building with predictions of both kinds."""
    folder = tmp_path_factory.mktemp("c0")
    write_example("three-story-c0", folder)
    problem = mf.load(folder / "study.toml").problem
    load: dict[str, Any] = {"response": "floor1", "force": "floor3", "damping": 0.02}
    push = mf.PeakResponse("push", **load)
    rare: dict[str, Any] = {
        "density": 1e-9,
        "sided": "two",
        "levels": [1e3],
        "duration": 1.0,
        "samples": 10,
    }
    never = mf.Passage("never", **load, **rare, method="monte-carlo")
    return mf.solve(
        problem,
        points=4,
        search=SEARCH,
        identifiability=mf.Identifiability(models=0),
        predictions=[push, never],
    )


@pytest.mark.slow(3)
def test_figures_show_all_studies(building: Results, tmp_path: Path) -> None:
    data = building.dataset
    studies = [("M0", data), ("again", data)]
    drawn = dict(figures(studies))
    assert list(drawn) == [f"figure-{number}" for number in range(2, 8)]
    probabilities = data["failure_probability"].values
    assert not probabilities.any(), "a figure without a point is drawn too"
    lines = {line.get_label(): line for line in drawn["figure-2"].axes[0].lines}
    front = (data["kind"].values == "front") & data["pareto"].values
    np.testing.assert_array_equal(
        np.column_stack([np.asarray(x) for x in lines["M0"].get_data()]),
        data["error"].values[front],
    )
    assert {"M0", "again", "equal weights", "optimal weights"} <= set(lines)
    assert len(drawn["figure-3"].axes) == len(drawn["figure-4"].axes) == 3
    assert len(drawn["figure-5"].axes) == 6
    paths = write_figures(figures(studies), tmp_path / "paper")
    assert [path.name for path in paths] == [f"{name}.svg" for name in drawn]


def test_modes_go_by_their_numbers_where_studies_measured_others(building: Results) -> None:
    data = building.dataset
    drawn = dict(figures([("all", data), ("others", data.isel(mode=[1, 2]))]))
    count = [len(axes.lines) for axes in drawn["figure-5"].axes]
    assert count[0] < count[1] == count[2], "nothing of the second study at mode 1"


def test_long_names_of_studies_are_not_cut(building: Results) -> None:
    names = [f"three-story C{k}, beams and plates M{k}_FE" for k in range(4)]
    for name, drawn in figures([(each, building.dataset) for each in names]):
        drawn.canvas.draw()
        (legend,) = drawn.legends
        box = legend.get_window_extent()
        assert 0 <= box.x0, name
        assert box.x1 <= drawn.bbox.width, name
        assert [text.get_text() for text in legend.get_texts()][:4] == names


def test_results_that_are_no_front_of_two_groups_are_refused(
    building: Results, tmp_path: Path
) -> None:
    data = building.dataset
    studies = [
        ("M0", data),
        ("M1", data.isel(parameter=[0, 1])),
        ("none", data.isel(point=data["kind"].values != "front")),
    ]
    with pytest.raises(mf.InputError) as wrong:
        write_figures(figures(studies), tmp_path)
    parameters, front = map(str, wrong.value.faults)
    assert parameters == (
        "M1: --figures: expected as many parameters as in the first study, 3, found 2"
    )
    assert front.startswith("none: --figures: expected a front of two groups, found 2 groups, 0")
    assert list(tmp_path.iterdir()) == []
