"""Structures and measurements that others published, read from ``../shared/data/smu``.

Matrices are triplets, K(alpha) = Kfixed + sum_j (1 + alpha_j) K_j; M does not change.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse

from modefront import Group, ModalData, Pairing, UpdatingProblem, matrices, modal_data
from modefront._typing import Floats
from modefront.analysis.certified import POOR
from modefront.models.base import Model
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.model import ReducedModel, SnapshotRequest
from modefront.pairing.match import modes_needed
from modefront.residuals.base import Scale
from modefront.solvers.scalarisation import weighted
from modefront.solvers.sqp import Options, Solution, begin, solve

FOLDER = Path(__file__).resolve().parents[1].parent / "shared" / "data" / "smu"


@dataclass(frozen=True)
class Structure:
    """A model in alpha, its bounds, and what was measured on it.

    ``true`` are the parameters from which simulated measurements come; None for real ones.
    """

    model: MatrixModel
    data: ModalData
    lower: Floats
    upper: Floats
    true: Floats | None


def read(name: str) -> Structure:
    """Return ``concrete_frame_sim``, ``steel_bridge_exp`` or ``story18_exp``."""
    with np.load(FOLDER / f"{name}.npz") as file:
        found = dict(file)
    size = int(found["N"])

    def matrix(key: str) -> scipy.sparse.csr_array:
        place = found[f"{key}_row"], found[f"{key}_col"]
        return scipy.sparse.csr_array((found[f"{key}_val"], place), shape=(size, size))

    terms = [matrix(f"K{j}") for j in range(int(found["n_par"]))]
    fixed = matrix("Kfixed") if "Kfixed_row" in found else scipy.sparse.csr_array((size, size))
    labels = found.get("names", np.array([f"alpha{j + 1}" for j in range(len(terms))]))
    parameters = [str(label) for label in labels]
    dofs = {f"dof{dof}": int(dof) for dof in found["meas_dofs0"]}
    model = matrices(
        parameters,
        {"base": sum(terms, fixed), **dict(zip(parameters, terms, strict=True))},
        {"base": matrix("M")},
        dofs,
    )
    true = found.get("alpha_true")
    if true is not None:
        modes = model.modes(true, int(found["n_modes"]), derivatives=False)
        data = modal_data(modes.frequency, modes.phi.T, tuple(dofs))
        return Structure(model, data, found["lb"], found["ub"], true)
    frequency = np.sqrt(found["lambda_exp"]) / (2 * np.pi)
    std = {}
    if "std_lambda" in found:
        of_frequency = frequency * found["std_lambda"] / (2 * found["lambda_exp"])
        std = {"frequency_std": of_frequency, "shape_std": found["std_psi"].T}
    data = modal_data(frequency, found["psi_exp"].T, tuple(dofs), **std)
    return Structure(model, data, found["lb"], found["ub"], None)


def frequencies_and_shapes(
    structure: Structure,
    pairing: Pairing | None = None,
    scale: Scale = "measured",
    *,
    reduced: bool = False,
) -> UpdatingProblem:
    """Return the problem with all frequencies in a group and all shapes in another one.

    The model is in a basis of its own where it is to be ``reduced``.
    """
    pairing = pairing or Pairing()
    model: Model = structure.model
    groups = (
        Group("frequencies", frequency="all", scale=scale),
        Group("shapes", shape="all", scale=scale),
    )
    start = np.zeros(structure.lower.size)
    if reduced:
        count = modes_needed(pairing, structure.data, model.size)
        spare = count - len(structure.data.modes)
        model = ReducedModel(
            structure.model, count, start, structure.lower, structure.upper, spare=spare
        )
    return UpdatingProblem(
        model,
        structure.data,
        groups,
        structure.lower,
        structure.upper,
        start,
        pairing,
    )


def weighted_minimum(
    problem: UpdatingProblem, w: Floats, theta: Floats, iterations: int = 200
) -> Solution:
    """Return the minimum of sum w J below a start.

    Where the model is a reduced one, snapshots are taken until its modes hold there; where these
    were poor, they have led astray, and it begins again.
    """
    model = problem.model
    found = begin(problem.evaluate(theta))
    while True:
        found = solve(problem, weighted(w), found, Options(iterations=iterations))
        if not isinstance(model, ReducedModel):
            return found
        wanted = np.unique(found.evaluation.quantities["paired_mode"].astype(int) - 1)
        (certificate,) = model.certify([(found.theta, wanted)])
        if certificate.eigenvalue.max() <= model.tolerance:
            return found
        model.take(SnapshotRequest(found.theta, model.count))
        poor = certificate.eigenvalue.max() > POOR
        found = begin(problem.evaluate(theta if poor else found.theta))
