"""The checksums of results: the same after any way through a file, another for any other value."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr
from faultless import DATA, STUDY
from refusals import command

import modefront as mf
from modefront.results.files import FILE, checksums, read_dataset, write

pytestmark = [pytest.mark.slow(2), pytest.mark.usefixtures("short_chains")]


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
    assert json.loads(raw.attrs["checksum"]) == checksums(raw) == checksums(data)
    assert "checksum" not in data.attrs


def test_draws_are_a_group_with_dimensions_of_arviz(run: Path) -> None:
    data = read_dataset(run)
    with xr.open_datatree(run / FILE, engine="h5netcdf") as tree:  # as ArviZ opens it
        draws = tree["posterior"].to_dataset().load()
    assert draws["theta"].dims == ("chain", "draw", "parameter")
    for name in ("theta", "frf_peak", "failure_probability"):
        assert np.array_equal(draws[name][0], data[f"draw_{name}"].values, equal_nan=True)
    assert draws["parameter"].values.tolist() == data["parameter"].values.tolist()


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
        kept = json.loads(data.attrs["checksum"])
        if [x for x, y in checksums(changed).items() if y != kept[x]] != [f"variable '{name}'"]:
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


def lost_value(file: h5py.File) -> None:
    del file["paired_mode"]


@pytest.mark.parametrize(
    ("change", "place", "found"),
    [
        (other_value, "variable 'theta'", "another"),
        (other_text, "variable 'group'", "another"),
        (other_attribute, "attribute 'seed'", "another"),
        (other_unit, "variable 'frequency'", "another"),
        (lost_value, "variable 'paired_mode'", "nothing"),
    ],
)
def test_any_change_is_refused_by_its_name(
    change: Callable[[h5py.File], None],
    place: str,
    found: str,
    results: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    with h5py.File(results / FILE, "r+") as file:
        change(file)
    path, expected = results / FILE, "expected it as the run has written it"
    for name in ("show", "report", "compare"):
        assert command(name, results) == 2
        assert capsys.readouterr().err == f"{path}: {place}: {expected}, found {found}\n"


@pytest.mark.parametrize("text", [None, "", "0", "[]", "{}", "\x1b[31m"])
def test_without_checksums_nothing_is_read(text: str | None, results: Path) -> None:
    with h5py.File(results / FILE, "r+") as file:
        del file.attrs["checksum"]
        if text is not None:
            file.attrs["checksum"] = text
    expected = (
        "attribute 'checksum': expected the checksums|variable 'label': expected it as the run"
    )
    with pytest.raises(mf.InputError, match=expected):
        mf.read_results(results)


def test_what_others_add_is_no_change(results: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with h5py.File(results / FILE, "r+") as file:
        file.attrs["of ours"] = "\x1b[31m"
        file["ours"] = np.ones(3)
        file["ours"].make_scale("ours")
    assert read_dataset(results)["ours"].values.tolist() == [1.0, 1.0, 1.0]
    for option in ((), ("--all",), ("--format", "json")):
        assert command("show", results, *option) == 0
        assert "\x1b" not in capsys.readouterr().out


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
    layouts(data, results / FILE)
    read_dataset(results)
    write(data, results / FILE)
    read_dataset(results)


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
    assert checksums(other) == checksums(data)
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
    different = {json.dumps(checksums(each), sort_keys=True) for each in (data, *changes)}
    assert len(different) == len(changes) + 1
    assert checksums(xr.Dataset()) == {}
