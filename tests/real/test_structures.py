"""Structures that others measured or published; without their data, these tests are skipped."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse
from smu import FOLDER, Structure, frequencies_and_shapes, read

from modefront import ModalData, Pairing
from modefront.diagnosis.comparison import compare
from modefront.diagnosis.search import diagnose
from modefront.linalg.affine import SparseAffine
from modefront.optim.scalarisation import weighted
from modefront.optim.sqp import begin
from modefront.optim.sqp import solve as descend
from modefront.results.remarks import findings_of
from modefront.study.check import check, excluding_bounds
from modefront.study.file import load
from modefront.study.session import run
from modefront.work.task import Costs

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"there is no folder {FOLDER}")


@pytest.mark.slow(10)
def test_random_starts_find_the_true_concrete_frame(costs: Costs) -> None:
    """913 of its 2,302 degrees of freedom have no mass; some starts are next to a mechanism."""
    frame = read("concrete_frame_sim")
    assert frame.true is not None
    problem = frequencies_and_shapes(frame, Pairing("order"))
    rng = np.random.default_rng(7)
    for theta in rng.uniform(frame.lower, frame.upper, (6, 12)):
        result = descend(problem, weighted(np.ones(2)), begin(problem.evaluate(theta)))
        np.testing.assert_allclose(result.theta, frame.true, atol=1e-5)
    assert costs.eigenproblems < 6 * 25


@pytest.mark.slow(60)
def test_small_sensors_of_the_steel_bridge_that_are_reversed() -> None:
    """At ``dof887`` it lowers MAC 5 from 0.90 to 0.81: a mode must not be left out for that."""
    problem = frequencies_and_shapes(read("steel_bridge_exp"))
    assert diagnose(compare(problem)) == []
    for name in ("dof936", "dof300", "dof887", "dof851"):
        shape = problem.data.shape.copy()
        shape[..., problem.data.sensors.index(name)] *= -1
        data = replace(problem.data, shape=shape)
        (result,) = diagnose(compare(replace(problem, data=data)))
        assert f"sensor {name} is reversed in all data" in str(result)


def test_modes_of_the_steel_bridge_come_in_another_order_than_in_the_test() -> None:
    bridge = read("steel_bridge_exp")
    problem = frequencies_and_shapes(bridge)
    _, pairs = problem.modes(problem.start, derivatives=False)
    assert (pairs.index + 1).tolist() == [2, 1, 3, 4, 5]
    assert (pairs.mac > 0.9).all()
    _, ordered = frequencies_and_shapes(bridge, Pairing("order")).modes(problem.start)
    assert (ordered.mac[:2] < 0.1).all()


def write_data(data: ModalData, path: Path) -> None:
    names = [*data.sensors, "frequency_std", *(f"{name}_std" for name in data.sensors)]
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["set", "mode", "frequency", "damping", *names])
        for r, mode in enumerate(data.modes):
            values = [*data.shape[0, r], data.frequency_std[0, r], *data.shape_std[0, r]]
            rows.writerow(["test", mode, data.frequency[0, r], "", *map(repr, map(float, values))])


def write_study(structure: Structure, folder: Path) -> Path:
    """Write a structure as its matrices, data and a study come from users: sparse and in files."""
    model = structure.model
    for key, matrix in (("K", model.stiffness), ("M", model.mass)):
        assert isinstance(matrix, SparseAffine)
        shape = matrix.size, matrix.size
        for j in range(matrix.terms.shape[1]):
            values = matrix.terms[:, [j]].toarray()[:, 0]
            A = scipy.sparse.csr_array((values, matrix.indices, matrix.indptr), shape=shape)
            scipy.sparse.save_npz(folder / f"{key}{j}.npz", A)
    write_data(structure.data, folder / "modes.csv")
    terms = ", ".join(f'{name} = "K{j + 1}.npz"' for j, name in enumerate(model.parameters))
    sensors = ", ".join(
        f"{name} = {dof}"
        for name, dof in zip(model.sensors, model.selection.indices.tolist(), strict=True)
    )
    parameters = "".join(
        f'[[parameter]]\nname = "{name}"\nnominal = 0\nbounds = [{lower}, {upper}]\n'
        for name, lower, upper in zip(
            model.parameters, structure.lower, structure.upper, strict=True
        )
    )
    study = folder / "study.toml"
    study.write_text(f"""
[study]
name = "steel bridge"
[data]
file = "modes.csv"
[model]
kind = "matrices"
reduction = 1e-8
stiffness = {{ base = "K0.npz", {terms} }}
mass = {{ base = "M0.npz" }}
sensors = {{ {sensors} }}
{parameters}
[[group]]
name = "frequencies"
frequency = "all"
scale = "std"
[[group]]
name = "shapes"
shape = "all"
scale = "std"
[pareto]
points = 3
[search]
doubt = 0.5
[identifiability]
flat = 0
models = 0
[uncertainty]
source = "none"
""")
    return study


@pytest.mark.slow(60)
def test_the_front_of_the_steel_bridge_over_its_standard_deviations(tmp_path: Path) -> None:
    """474 of its 946 degrees of freedom have no mass; what scales a shape has no deviation."""
    study = load(write_study(read("steel_bridge_exp"), tmp_path))
    findings = check(study)
    assert findings.sound
    assert any("K_" in warning for warning in findings.warnings)
    # `check` and the verdict judge bounds by one measure: wider ones lower no error by a tenth.
    assert excluding_bounds(study) == ()
    results = run(study, tmp_path / "results")
    assert any("what wider bounds gain may be chance" in line for line in results.verdict)
    data = results.dataset
    assert bool(data["converged"].all())
    theta, bounds = data["theta"].values, data["bounds"].values
    theta = theta[data["kind"].values != "nominal"]
    at_bounds = (theta <= bounds[:, 0]) | (theta >= bounds[:, 1])
    assert at_bounds.any(axis=1).all()
    named = next(
        line
        for line in list(map(str, findings_of(data, full=True)))
        if line.startswith("parameters at a bound")
    )
    for name in data["parameter"].values[at_bounds.any(axis=0)]:
        assert name in named
