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
from modefront.models.reduced.basis import certificate_of
from modefront.models.reduced.model import ReducedModel, SnapshotRequest
from modefront.optim.scalarisation import weighted
from modefront.optim.sqp import Options, Solution, begin, solve
from modefront.pairing.match import modes_needed
from modefront.residuals.base import Scale

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
        result = dict(file)
    size = int(result["N"])

    def matrix(key: str) -> scipy.sparse.csr_array:
        place = result[f"{key}_row"], result[f"{key}_col"]
        return scipy.sparse.csr_array((result[f"{key}_val"], place), shape=(size, size))

    terms = [matrix(f"K{j}") for j in range(int(result["n_par"]))]
    fixed = matrix("Kfixed") if "Kfixed_row" in result else scipy.sparse.csr_array((size, size))
    labels = result.get("names", np.array([f"alpha{j + 1}" for j in range(len(terms))]))
    parameters = [str(label) for label in labels]
    dofs = {f"dof{dof}": int(dof) for dof in result["meas_dofs0"]}
    model = matrices(
        parameters,
        {"base": sum(terms, fixed), **dict(zip(parameters, terms, strict=True))},
        {"base": matrix("M")},
        dofs,
    )
    true = result.get("alpha_true")
    if true is not None:
        modes = model.modes(true, int(result["n_modes"]), derivatives=False)
        data = modal_data(modes.frequency, modes.phi.T, tuple(dofs))
        return Structure(model, data, result["lb"], result["ub"], true)
    frequency = np.sqrt(result["lambda_exp"]) / (2 * np.pi)
    std = {}
    if "std_lambda" in result:
        of_frequency = frequency * result["std_lambda"] / (2 * result["lambda_exp"])
        std = {"frequency_std": of_frequency, "shape_std": result["std_psi"].T}
    data = modal_data(frequency, result["psi_exp"].T, tuple(dofs), **std)
    return Structure(model, data, result["lb"], result["ub"], None)


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
    result = begin(problem.evaluate(theta))
    while True:
        result = solve(problem, weighted(w), result, Options(iterations=iterations))
        if not isinstance(model, ReducedModel):
            return result
        requested = np.unique(result.evaluation.quantities["paired_mode"].astype(int) - 1)
        certificate = certificate_of(model.basis, result.theta, requested)
        if certificate.eigenvalue.max() <= model.tolerance:
            return result
        model.take(SnapshotRequest(result.theta, model.count))
        poor = certificate.eigenvalue.max() > POOR
        result = begin(problem.evaluate(theta if poor else result.theta))
