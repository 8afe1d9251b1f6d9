"""Results that were damaged, or made by others, are refused in words."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import modefront as mf
from modefront.results.files import FILE, write
from modefront.results.schema import ATTRIBUTES, FORMAT, VARIABLES

NAMES = ("k1", "k2")


@pytest.fixture(scope="module")
def whole() -> xr.Dataset:
    model = mf.chain(NAMES, [1.0, 1.0], [100.0, 80.0], stiffness_parameters=NAMES)
    modes = model.modes(np.array([1.1, 0.9]), 2)
    data = mf.modal_data(
        modes.frequency, modes.phi.T + 0.01, model.sensors, frequency_std=0.01 * modes.frequency
    )
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    bounds = dict.fromkeys(NAMES, (0.5, 2.0))
    problem = mf.updating_problem(model, data, groups, bounds, dict.fromkeys(NAMES, 1.0))
    return mf.solve(problem, points=3, search=mf.Search(doubt=0.5)).dataset


def test_every_variable_is_in_the_schema(whole: xr.Dataset, tmp_path: Path) -> None:
    assert set(whole.data_vars) <= set(VARIABLES)
    assert set(whole.attrs) <= set(ATTRIBUTES)
    for name, values in whole.data_vars.items():
        assert values.dims == VARIABLES[str(name)].dimensions
        assert values.attrs == VARIABLES[str(name)].attributes
    write(whole, tmp_path / FILE)
    xr.testing.assert_identical(mf.read_results(tmp_path).dataset, whole)


def test_as_many_models_are_drawn_as_intervals_need(whole: xr.Dataset) -> None:
    assert whole["sample_theta"].shape == (200, 2)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda data: data.assign_attrs(format=FORMAT + 1), f"results of format {FORMAT}, found"),
        (lambda data: data.drop_vars("theta"), "variable 'theta': expected"),
    ],
)
def test_a_file_with_faults_is_not_read(
    change: Callable[[xr.Dataset], xr.Dataset], says: str, whole: xr.Dataset, tmp_path: Path
) -> None:
    write(change(whole), tmp_path / FILE)
    with pytest.raises(mf.InputError) as error:
        mf.read_results(tmp_path)
    assert str(tmp_path / FILE) in str(error.value)
    assert says in str(error.value)


def test_groups_that_hold_each_other_end(whole: xr.Dataset, tmp_path: Path) -> None:
    write(whole, tmp_path / FILE)
    with h5py.File(tmp_path / FILE, "a") as file:
        group = file.create_group("a")
        group["b"] = group
    xr.testing.assert_identical(mf.read_results(tmp_path).dataset, whole)
