"""Tasks of whole runs: other processes can do them, and names of users mix with none of them."""

from __future__ import annotations

import io
import pickle
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from refusals import edited
from two_masses import FRF, PASSAGE, write_study

import modefront as mf
from modefront.work.codec import dump
from modefront.work.store import Run, Store
from modefront.work.task import Costs, R, Task

SHAPES = """[[group]]
name = "shapes"
shape = "all"
"""

THREE = """[[group]]
name = "first shape"
shape = [1]

[[group]]
name = "second shape"
shape = [2]
"""

REST = """
[identifiability]
models = 3

[uncertainty]
source = "sets"
bootstrap = 2
draws = 2
"""


def study(folder: Path, *edits: tuple[str, str], more: str = "") -> mf.Study:
    path = write_study(folder, more)
    path.write_text(edited(path.read_text(), *edits))
    return mf.load(path)


def plain(folder: Path) -> mf.Study:
    return study(folder)


def everything(folder: Path) -> mf.Study:
    """Return a study with a tolerance, three groups, weights, replicates and predictions."""
    weights = '{ frequencies = 2.0, "first shape" = 1.0, "second shape" = 1.0 }'
    weighted = f'[[weighted]]\nname = "mine"\nweights = {weights}\n'
    quick = PASSAGE.replace("samples = 1500", "samples = 10")
    edits = (SHAPES, THREE + weighted), ("points = 3", "points = 3\ntolerance = 0.2")
    pushed = FRF[: FRF.index("[[predict.frf]]", FRF.index("pushed"))]
    return study(folder, *edits, more=pushed + quick + REST)


def kept(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Return the records of the next run by the names of their tasks, as they come to be kept."""
    records: dict[str, Any] = {}
    write = Store.write

    def note(store: Store, task: Task[Any], result: Any, costs: Costs, seconds: float) -> None:
        dump(result, stream := io.BytesIO())
        records[task.name] = stream.getvalue(), costs.eigenproblems
        write(store, task, result, costs, seconds)

    monkeypatch.setattr(Store, "write", note)
    return records


@pytest.mark.slow(5)
@pytest.mark.parametrize("of", [plain, everything])
def test_every_task_of_a_run_gives_the_same_record_after_pickle(
    of: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        here = kept(patch)
        whole = mf.run(of(tmp_path), tmp_path / "whole")
    run = Run.run

    def through_pickle(work: Run, tasks: Sequence[Task[R]], /) -> list[R]:
        copies = [pickle.loads(pickle.dumps(task)) for task in tasks]
        return [pickle.loads(pickle.dumps(result)) for result in run(work, copies)]

    monkeypatch.setattr(Run, "run", through_pickle)
    other = kept(monkeypatch)
    again = mf.run(of(tmp_path), tmp_path / "apart")
    assert list(other) == list(here)
    assert other == here
    xr.testing.assert_identical(again.dataset, whole.dataset)
    stages = {name.split("-")[0] for name in here}
    assert {"edges", "front", "optimal", "nominal"} <= stages
    if of is everything:
        assert {"near", "bootstrap", "second", "predict", "manifold"} <= stages


def named(folder: Path, name: str) -> mf.Results:
    """Return the results of a study with a tolerance and one weighted model of this name."""
    folder.mkdir()
    weighted = f'[[weighted]]\nname = "{name}"\nweights = {{ frequencies = 2.0, shapes = 1.0 }}\n'
    edits = (SHAPES, SHAPES + weighted), ("points = 3", "points = 3\ntolerance = 0.2")
    return mf.run(study(folder, *edits), folder / "results")


@pytest.mark.slow(3)
def test_weights_named_like_work_have_no_part_in_it(tmp_path: Path) -> None:
    """``near-shapes`` is how the task is named that seeks the reported edge of the shapes."""
    ordinary = named(tmp_path / "mine", "mine")
    for text in ("near-shapes", "edge-x"):
        alike = named(tmp_path / text, text)
        labels = [text if x == "mine" else x for x in ordinary["label"].values.tolist()]
        assert alike["label"].values.tolist() == labels
        for name in ordinary.data_vars:
            first, other = ordinary[name].values, alike[name].values
            if first.dtype.kind in "fib":
                np.testing.assert_array_equal(first, other, err_msg=str(name))


def test_weights_named_like_a_point_of_the_study_are_refused(tmp_path: Path) -> None:
    with pytest.raises(mf.InputError, match=r"\[\[weighted\]\].*'edge-shapes'"):
        named(tmp_path / "one", "edge-shapes")


def test_groups_whose_names_differ_in_case_only_have_files_of_their_own(tmp_path: Path) -> None:
    names = ('name = "frequencies"', 'name = "Shapes"'), ('name = "shapes"', 'name = "shapes"')
    mf.run(study(tmp_path, *names), tmp_path / "results")
    files = [path.name for path in (tmp_path / "results").rglob("*.npz")]
    assert any("Shapes" in name for name in files)
    assert any("shapes" in name for name in files)
    assert len({name.casefold() for name in files}) == len(files), "one drive may take them for one"
