"""``kind = "matrices"``: K(theta) = base + sum_j c_j(theta) K_j from files, M(theta) likewise."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse

from modefront.errors import Fault, InputError, suggestion
from modefront.models.base import Model
from modefront.models.dofs import DofTable, read_dofs
from modefront.models.files import read_matrix
from modefront.models.matrices import matrices
from modefront.models.terms import BASE, exponents_of, form_of
from modefront.programs.mesh import ProgramMesh, read_mesh
from modefront.study.kinds.base import ModelKind
from modefront.study.kinds.sensors import read_base, read_outputs, read_sensors
from modefront.toml import Table


def read_matrices(table: Table, parameters: Sequence[str]) -> Model | None:
    """Return the model that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    stiffness = _terms(table, "stiffness", parameters)
    mass = _terms(table, "mass", parameters)
    size = _common_size(table, {"stiffness": stiffness, "mass": mass})
    dofs = _dofs(table, size)
    mesh = table.text("mesh", "the name of a file of nodes and elements", None)
    if mesh is not None:
        _read_mesh(table, mesh)
    sensors = read_sensors(table, size, dofs=dofs)
    floating = table.take("floating", "true or false", lambda x: isinstance(x, bool), False)
    outputs = read_outputs(table, size, sensors, dofs)
    base = read_base(table, size, dofs)
    if len(table.faults) > before or sensors is None:
        return None
    return matrices(
        parameters, stiffness, mass, sensors, floating=floating, outputs=outputs, base=base
    )


def _terms(model: Table, key: str, parameters: Sequence[str]) -> dict[str, scipy.sparse.coo_array]:
    """Return the matrices of one table of terms, each read from its file."""
    expected = f"a table of files, {BASE} = ... and one a parameter"
    table = model.table(key, expected)
    out: dict[str, scipy.sparse.coo_array] = {}
    if table is None:
        return out
    if not table.values:
        table.fault("", "at least one matrix", "none")
    for name in table.values:
        if exponents_of(name, parameters) is None:
            table.fault(name, form_of(name), suggestion(name, [BASE, *parameters]))
            continue
        file = _file(table, name)
        if file is None:
            continue
        try:
            out[name] = read_matrix(table.path(file[0]), file[1])
        except InputError as error:
            table.faults += [
                Fault(
                    fault.file, f"{table.place} {name}, {fault.place}", fault.expected, fault.found
                )
                for fault in error.faults
            ]
    return out


def _dofs(table: Table, size: int | None) -> DofTable | None:
    """Return the nodes and directions of the degrees of freedom, where a file names them."""
    name = table.text("dofs", "the name of a table of degrees of freedom", None)
    if name is None:
        return None
    path = table.path(name)
    try:
        dofs = read_dofs(path)
    except InputError as error:
        table.faults.extend(error.faults)
        return None
    if size is not None and dofs.size != size:
        table.fault("dofs", f"{size} rows, one a degree of freedom", f"{dofs.size} in '{name}'")
        return None
    return dofs


def _read_mesh(table: Table, name: str) -> ProgramMesh | None:
    """Return nodes and elements for pictures, None where the file has faults."""
    try:
        return read_mesh(table.path(name))
    except InputError as error:
        table.faults.extend(error.faults)
        return None


def _file(table: Table, key: str) -> tuple[str, str | None] | None:
    """Return the name of a file and, where given, that of a matrix in it."""
    if not isinstance(table.values[key], dict):
        name = table.text(key, "the name of a file")
        return None if name is None else (name, None)
    before = len(table.faults)
    inner = table.table(key)
    if inner is None:
        return None
    file = inner.text("file", "the name of a file")
    variable = inner.text("name", "the name of a matrix in the file", None)
    inner.close()
    return None if file is None or len(table.faults) > before else (file, variable)


def _common_size(
    model: Table, matrices: dict[str, dict[str, scipy.sparse.coo_array]]
) -> int | None:
    """Return N if all matrices are N x N; a fault names the ones that differ from most."""
    found = {f"{key} {name}": A for key, terms in matrices.items() for name, A in terms.items()}
    if not found:
        return None
    sizes = {place: int(A.shape[0]) for place, A in found.items()}
    counts = list(sizes.values())
    common = max(set(counts), key=lambda size: (counts.count(size), size))
    for place, size in sizes.items():
        if size != common:
            others = f"{common} x {common}, as the other matrices"
            model.fault(place, others, f"{size} x {size}")
    mass = matrices["mass"]
    if mass and not any(A.nnz for A in mass.values()):
        model.fault("mass", "a mass matrix that is not zero", "only zeros")
    elif set(counts) == {common} and all(matrices.values()):
        there = np.unique(np.concatenate([A.row for A in found.values()]))
        if there.size < common:
            gap = np.flatnonzero(there != np.arange(there.size))
            missing = int(gap[0]) if gap.size else there.size
            expected = "stiffness or mass at every degree of freedom"
            model.fault("", expected, f"neither at {missing} (from 0)")
    return common


MATRICES = ModelKind("matrices", read_matrices)
