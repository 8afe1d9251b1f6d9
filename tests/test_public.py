"""The public names: all there, all documented, and clear about what is wrong with arguments."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest
import xarray as xr

import modefront as mf


@pytest.mark.parametrize("name", mf.__all__)
def test_every_public_name_is_there_and_documented(name: str) -> None:
    value = getattr(mf, name)
    assert dir(mf) == mf.__all__
    assert inspect.getdoc(value), name
    if is_dataclass(value):
        assert_documented(name, value, [field.name for field in fields(value) if field.init])
    elif callable(value) and not isinstance(value, type):
        assert_documented(name, value, list(inspect.signature(value).parameters))


def assert_documented(name: str, value: object, arguments: list[str]) -> None:
    """Assert that each argument heads lines of its own: ``name``, or ``name, other : text``."""
    text = inspect.getdoc(value) or ""
    heads = re.findall(r"^([\w*, ]+)(?: :.*)?$", text, re.MULTILINE)
    assert {*arguments} <= {word.strip("*") for head in heads for word in head.split(", ")}, name


@pytest.mark.parametrize("name", mf.fem.__all__)
def test_every_name_of_finite_elements_is_there(name: str) -> None:
    value = getattr(mf.fem, name)
    if is_dataclass(value):
        assert_documented(name, value, [field.name for field in fields(value)])


def test_an_unknown_name_is_an_attribute_error() -> None:
    name = "chains"
    with pytest.raises(AttributeError, match=f"module 'modefront' has no attribute '{name}'"):
        getattr(mf, name)


I2 = np.eye(2)
WRONG: list[tuple[Callable[[], Any], str]] = [
    (lambda: mf.chain(["k"], [], []), "masses: expected at least one, found none"),
    (
        lambda: mf.chain(["k"], [1.0, 1.0], [5.0]),
        "stiffnesses: expected 2 or 3, as there are 2 masses, found 1",
    ),
    (
        lambda: mf.chain(["k"], [1.0], [5.0], stiffness_parameters=["k", "k"]),
        "stiffness_parameters: expected one a spring, found 2",
    ),
    (
        lambda: mf.chain(["k1"], [1.0], [5.0], stiffness_parameters=["k"]),
        "stiffness_parameters: expected names of parameters, found 'k' (did you mean 'k1'?)",
    ),
    (
        lambda: mf.matrices(["k"], {"k": I2}, {"base": np.eye(3)}, {"one": 0}),
        "stiffness k: expected 3 x 3, as the other matrices, found 2 x 2",
    ),
    (
        lambda: mf.matrices(["k"], {"k": I2}, {}, {"one": 0}),
        "mass: expected 'base' or a parameter (in a study file, the name of a [[parameter]]), "
        "found nothing",
    ),
    (
        lambda: mf.matrices(["k"], {"k": I2}, {"base": I2}, {"one": -1}),
        "sensors 'one': expected a degree of freedom from 0 to 1, found -1",
    ),
    (
        lambda: mf.mesh_model(cantilever(), ["E"]),
        "parameters: expected the structure's k, found no k",
    ),
]


def cantilever() -> mf.fem.Structure:
    X, cells = mf.fem.grids.line(np.zeros(3), np.array([1.0, 0, 0]), 4)
    steel = mf.fem.Material(E=210e9, nu=0.3, rho=7850.0)
    return mf.fem.Structure(
        X,
        groups=[mf.fem.Beams("beam", cells, steel, mf.fem.circle(0.02))],
        supports=[mf.fem.Support(0)],
        sensors=[mf.fem.Sensor("tip", 4, "y")],
        parameters=[mf.fem.Parameter("k", "E", ["beam"])],
    )


@pytest.mark.parametrize(("call", "message"), WRONG, ids=[text[:50] for _, text in WRONG])
def test_wrong_arguments_are_named(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(mf.InputError) as error:
        call()
    assert str(error.value) == message


def test_a_cantilever_made_in_python_has_its_frequency() -> None:
    model = mf.mesh_model(cantilever(), ["k"])
    EI, m = 210e9 * np.pi * 0.02**4 / 64, 7850.0 * np.pi * 0.02**2 / 4
    first = 1.8751040687**2 * np.sqrt(EI / m) / (2 * np.pi)  # Bernoulli's beam, 1 m
    modes = model.modes(np.array([1.0]), 1)
    assert modes.frequency[0] == pytest.approx(first, rel=1e-3)


def test_results_are_not_changed_in_place() -> None:
    results = mf.Results(xr.Dataset({"theta": ("point", [1.0])}))
    change: Any = results
    with pytest.raises(TypeError, match=r"results are not changed: dataset.assign"):
        change["theta"] = 2.0
    assert results["theta"].values.tolist() == [1.0]
