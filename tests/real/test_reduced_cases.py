"""Reduced bases on published models: a concrete frame and a steel bridge that was measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse

import modefront as mf
from modefront._typing import Floats
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.model import ReducedModel
from modefront.pairing.match import modes_needed
from modefront.solvers.scalarisation import weighted
from modefront.solvers.sqp import Options, begin, solve

EXACT = 1e-5
"""Sum of the residuals at the true model, as found in a basis, and far below any other minimum."""

SMU = Path(__file__).parents[3] / "shared" / "data" / "smu"

pytestmark = pytest.mark.skipif(not SMU.is_dir(), reason=f"the published models are not at {SMU}")


def model_of(name: str) -> tuple[MatrixModel, dict[str, Floats]]:
    """Return a model with K(alpha) = sum_j (1 + alpha_j) K_j and what else is known of it."""
    with np.load(SMU / f"{name}.npz") as file:
        data = {key: file[key] for key in file.files}
    size, p = int(data["N"]), int(data["n_par"])

    def matrix(label: str) -> scipy.sparse.csr_array:
        entries = data[f"{label}_row"], data[f"{label}_col"]
        A = scipy.sparse.csr_array((data[f"{label}_val"], entries), shape=(size, size))
        return (A + A.T) / 2

    terms = {f"a{j + 1}": matrix(f"K{j}") for j in range(p)}
    base = sum(terms.values())
    if "Kfixed_row" in data:
        base = base + matrix("Kfixed")
    sensors = {f"s{i + 1}": int(dof) for i, dof in enumerate(data["meas_dofs0"])}
    model = mf.matrices(tuple(terms), {"base": base, **terms}, {"base": matrix("M")}, sensors)
    return model, data


def problem_of(
    model: MatrixModel, data: mf.ModalData, known: dict[str, Floats], reduced: bool
) -> mf.UpdatingProblem:
    lower, upper = known["lb"], known["ub"]
    start = np.zeros(lower.size)
    pairing = mf.Pairing()
    count = modes_needed(pairing, data, model.size)
    groups = [mf.Group("frequencies", "all"), mf.Group("shapes", shape="all")]
    used = ReducedModel(model, count, start, lower, upper) if reduced else model
    names = model.parameters
    bounds = {name: (float(a), float(b)) for name, a, b in zip(names, lower, upper, strict=True)}
    return mf.updating_problem(used, data, groups, bounds, dict.fromkeys(names, 0.0), pairing)


def frame() -> mf.UpdatingProblem:
    """Return the problem of finding the true stiffnesses of the frame from three exact modes."""
    model, known = model_of("concrete_frame_sim")
    modes = model.modes(known["alpha_true"], int(known["n_modes"]), derivatives=False)
    data = mf.modal_data(modes.frequency, modes.phi.T, model.sensors)
    return problem_of(model, data, known, reduced=True)


def to_an_exact_fit(problem: mf.UpdatingProblem, rng: np.random.Generator) -> Floats:
    """Return the model that fits exactly, from a random start and others where it needs them.

    The bounds include models without a member, and there local minima that fit nothing: from
    these another random start is taken, and counted in with the first.
    """
    model = problem.model
    assert isinstance(model, ReducedModel)
    programme = weighted(np.ones(2))
    options = Options(iterations=200, learn=False)
    while True:
        found = begin(problem.evaluate(rng.uniform(problem.lower, problem.upper)))
        while True:
            found = solve(problem, programme, found, options)
            if found.at.J.sum() > EXACT:
                break
            wanted = np.unique(found.at.quantities["paired_mode"].astype(int) - 1)
            if model.certify(found.at.theta, wanted).eigenvalue.max() <= model.tolerance:
                return found.at.theta
            model.take(found.at.theta)
            found = begin(problem.evaluate(found.at.theta))


def test_the_frame_is_found_from_a_hundred_random_starts() -> None:
    problem, rng = frame(), np.random.default_rng(0)
    truth = model_of("concrete_frame_sim")[1]["alpha_true"]
    for _ in range(100):
        assert np.abs(to_an_exact_fit(problem, rng) - truth).max() < 1e-3
    assert problem.model.counts.eigenproblems <= 3


def bridge(*, reduced: bool) -> mf.UpdatingProblem:
    """Return the problem of updating the bridge to its measured modes."""
    model, known = model_of("steel_bridge_exp")
    frequency = np.sqrt(known["lambda_exp"]) / (2 * np.pi)
    data = mf.modal_data(frequency, known["psi_exp"].T, model.sensors)
    return problem_of(model, data, known, reduced=reduced)


def weighted_model(problem: mf.UpdatingProblem, w: Floats) -> Floats:
    """Return the local minimum of weighted residuals below the nominal model."""
    model = problem.model
    found = begin(problem.evaluate(problem.start))
    while True:
        found = solve(problem, weighted(w), found, Options(iterations=200))
        assert found.converged
        if not isinstance(model, ReducedModel):
            return found.at.theta
        wanted = np.unique(found.at.quantities["paired_mode"].astype(int) - 1)
        if model.certify(found.at.theta, wanted).eigenvalue.max() <= model.tolerance:
            return found.at.theta
        model.take(found.at.theta)
        found = begin(problem.evaluate(found.at.theta))


@pytest.mark.parametrize("weight", [10.0, 100.0])
def test_models_of_the_bridge_are_the_same_with_and_without_reduction(weight: float) -> None:
    w = np.array([weight, 1.0])
    problem, full = bridge(reduced=True), bridge(reduced=False)
    found, expected = weighted_model(problem, w), weighted_model(full, w)
    # Fits this poor ask for more of the derivatives of shapes than of the modes themselves.
    assert (np.abs(found - expected) / (full.upper - full.lower)).max() < 1e-3
    least = w @ full.evaluate(expected).J
    assert w @ full.evaluate(found).J == pytest.approx(least, rel=1e-6)
    assert w @ problem.evaluate(found).J == pytest.approx(least, rel=1e-6)
    assert problem.model.counts.eigenproblems <= 3
