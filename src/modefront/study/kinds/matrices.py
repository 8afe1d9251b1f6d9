"""``kind = "matrices"``: K(theta) = base + sum_j theta_j K_j from files, and M(theta) likewise."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import scipy.sparse

from modefront.errors import Fault, InputError, suggestion
from modefront.models.base import Model
from modefront.models.files import read_matrix
from modefront.models.matrices import BASE, matrices
from modefront.study.kinds.sensors import read_sensors
from modefront.study.reader import Table, describe, is_name


def read_matrices(table: Table, parameters: Sequence[str], folder: Path) -> Model | None:
    """Return the model that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    stiffness = _terms(table, "stiffness", parameters, folder)
    mass = _terms(table, "mass", parameters, folder)
    size = _common_size(table, {"stiffness": stiffness, "mass": mass})
    sensors = read_sensors(table, size)
    if len(table.faults) > before or sensors is None:
        return None
    return matrices(parameters, stiffness, mass, sensors)


def _terms(
    model: Table, key: str, parameters: Sequence[str], folder: Path
) -> dict[str, scipy.sparse.csr_array]:
    """Return the matrices of one table of terms, each read from its file."""
    expected = f"a table of files, {BASE} = ... and one a parameter"
    table = model.table(key, expected)
    out: dict[str, scipy.sparse.csr_array] = {}
    if table is None:
        return out
    if not table.values:
        table.fault("", "at least one matrix", "none")
    for name, value in table.values.items():
        if name != BASE and name not in parameters:
            table.fault(name, f"'{BASE}' or a parameter", suggestion(name, [BASE, *parameters]))
        elif not is_name(value):
            table.fault(name, "the name of a file", describe(value))
        else:
            try:
                out[name] = read_matrix(folder / value)
            except InputError as error:
                table.faults += [
                    Fault(one.file, f"{table.place} {name}, {one.place}", one.expected, one.found)
                    for one in error.faults
                ]
    return out


def _common_size(
    model: Table, matrices: dict[str, dict[str, scipy.sparse.csr_array]]
) -> int | None:
    """Return N if all matrices are N x N; a fault names the ones that differ from most."""
    sizes = {
        f"{key} {name}": A.shape[0] for key, terms in matrices.items() for name, A in terms.items()
    }
    if not sizes:
        return None
    counts = list(sizes.values())
    common = max(set(counts), key=lambda size: (counts.count(size), size))
    for place, size in sizes.items():
        if size != common:
            others = f"{common} x {common}, as the other matrices"
            model.fault(place, others, f"{size} x {size}")
    mass = matrices["mass"]
    if mass and all(A.count_nonzero() == 0 for A in mass.values()):
        model.fault("mass", "a mass matrix that is not zero", "only zeros")
    return common
