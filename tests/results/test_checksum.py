"""The checksum of results: the same after any way through a file, another for any other value."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr
from faultless import DATA, STUDY
from refusals import command

import modefront as mf
from modefront.reports.page import topics
from modefront.results.files import FILE, checksum, read_dataset, write

pytestmark = pytest.mark.slow(2)

SAYS = "results.nc has values that do not fit its checksum"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run a study, and return its results."""
    folder = tmp_path_factory.mktemp("run")
    (folder / "study.toml").write_text(STUDY)
    (folder / "modes.csv").write_text(DATA)
    assert command("run", folder / "study.toml", "-o", folder / "results") == 0
    return folder / "results"


@pytest.fixture
def results(run: Path, tmp_path: Path) -> Path:
    """Return a copy of the results."""
    (tmp_path / FILE).write_bytes((run / FILE).read_bytes())
    return tmp_path


def test_what_a_run_writes_fits(run: Path) -> None:
    data = read_dataset(run)
    raw = xr.load_dataset(run / FILE, engine="h5netcdf")
    assert raw.attrs["checksum"] == checksum(raw) == checksum(data)
    assert "changed" not in data.attrs
    mf.read_results(run)  # without a warning


def test_every_variable_with_a_doubled_value_has_another_checksum(run: Path) -> None:
    data = xr.load_dataset(run / FILE, engine="h5netcdf")
    tried, same = 0, []
    for name, variable in data.variables.items():
        values = variable.values.copy()
        if values.dtype.kind not in "bif":
            continue
        doubled = np.flatnonzero(np.isfinite(values) & (values != 0))
        if not doubled.size:
            continue
        tried += 1
        values.flat[doubled[0]] = 0 if values.dtype.kind == "b" else 2 * values.flat[doubled[0]]
        changed = xr.Dataset({**data.variables, name: variable.copy(data=values)}, attrs=data.attrs)
        if checksum(changed) == data.attrs["checksum"]:
            same.append(name)
    assert tried > 50
    assert same == []


def other_value(file: h5py.File) -> None:
    file["theta"][0, 0] *= 1.5


def other_text(file: h5py.File) -> None:
    file["group"][0] = "other"


def other_attribute(file: h5py.File) -> None:
    file.attrs["seed"] = file.attrs["seed"] + 1


def other_unit(file: h5py.File) -> None:
    file["frequency"].attrs["units"] = "rad/s"


@pytest.mark.parametrize("change", [other_value, other_text, other_attribute, other_unit])
def test_any_change_is_said(change: Callable[[h5py.File], None], results: Path) -> None:
    with h5py.File(results / FILE, "r+") as file:
        change(file)
    assert SAYS in read_dataset(results).attrs["changed"]


def test_a_lost_checksum_is_said_everywhere(
    results: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with h5py.File(results / FILE, "r+") as file:
        del file.attrs["checksum"]
    says = "results.nc has no checksum"
    assert command("show", results) == 0
    assert says in " ".join(capsys.readouterr().out.split())
    assert command("show", results, "--format", "json") == 0
    answer = json.loads(capsys.readouterr().out)
    assert says in answer["remarks"][0]
    assert says in answer["attributes"]["changed"]
    caution = topics(read_dataset(results))["What to beware of"]
    assert says.lower() in caution[0].lower()
    with pytest.warns(UserWarning, match=says):
        mf.read_results(results)


def layouts(data: xr.Dataset, path: Path) -> None:
    """Write results as other programs might: compressed, in chunks, in another order."""
    names = list(map(str, data.variables))[::-1]
    turned = xr.Dataset({x: data.variables[x] for x in names}, attrs=data.attrs)
    filters = {
        name: {"zlib": True, "shuffle": True, "chunksizes": data[name].shape}
        for name in names
        if data[name].dtype.kind == "f" and data[name].size > 1
    }
    turned.to_netcdf(path, engine="h5netcdf", encoding=filters)


def test_the_layout_of_a_file_does_not_count(results: Path) -> None:
    data = xr.load_dataset(results / FILE, engine="h5netcdf")
    assert checksum(data) == data.attrs["checksum"]
    layouts(data, results / FILE)
    assert "changed" not in read_dataset(results).attrs
    write(data, results / FILE)
    assert "changed" not in read_dataset(results).attrs


def test_types_that_a_file_may_change_do_not_count() -> None:
    values = {
        "float": ("x", np.array([1.0, np.nan, -0.0])),
        "truth": ("x", np.array([True, False, True])),
        "count": ("x", np.array([1, 2, 3], np.int32)),
        "text": ("x", ["a", "", "\xe9\n"]),
        "empty": ("y", np.zeros(0)),
        "scalar": ((), 3.0),
    }
    data = xr.Dataset(values, {"x": ["u", "v", "w"]}, {"n": 1, "list": [1.0, 2.0], "one": [1.0]})
    other = data.assign(
        count=("x", np.array([1, 2, 3])),
        text=("x", np.array(["a", "", "\xe9\n"], object)),
        float=("x", np.array([1.0, -np.nan, -0.0])),
    )
    other.attrs = {"one": np.float64(1.0), "list": np.array([1.0, 2.0]), "n": np.int64(1)}
    assert checksum(other) == checksum(data)
    changes: list[xr.Dataset] = [
        data.assign(float=("x", np.array([1.0, np.nan, 0.0]))),
        data.assign(text=("x", ["a", "\xe9\n", ""])),
        data.assign(text=("x", ['a", "', "\xe9\n", ""])),
        data.assign(scalar=((), 3.0000000000000004)),
        data.rename(count="counts"),
        data.rename(y="z"),
        data.drop_vars("empty"),
        data.assign_coords(x=["u", "w", "v"]),
        data.assign_attrs(n=2),
        data.assign_attrs(m=2),
    ]
    assert len({checksum(each) for each in (data, *changes)}) == len(changes) + 1
    with warnings.catch_warnings(action="error"):
        checksum(xr.Dataset())
