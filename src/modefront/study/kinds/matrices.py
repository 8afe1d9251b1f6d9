"""``kind = "matrices"``: K(theta) = base + sum_j theta_j K_j from files, and M(theta) likewise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy.sparse

from modefront.errors import InputError, suggestion
from modefront.models.base import Model
from modefront.models.files import matrix_size, read_matrix
from modefront.models.matrices import BASE, matrices
from modefront.study.kinds.base import ModelKind
from modefront.study.kinds.sensors import read_base, read_outputs, read_sensors
from modefront.toml import Table


def read_matrices(table: Table, parameters: Sequence[str]) -> Model | None:
    """Return the model that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    files = {key: _terms(table, key, parameters) for key in ("stiffness", "mass")}
    size = _common_size(table, files)
    stiffness, mass = (_matrices(terms, size) for terms in files.values())
    if size is not None:
        _check_entries(table, {"stiffness": stiffness, "mass": mass}, size)
    sensors = read_sensors(table, size)
    floating = table.take("floating", "true or false", lambda x: isinstance(x, bool), False)
    outputs, base = read_outputs(table, size, sensors), read_base(table, size)
    if len(table.faults) > before or sensors is None:
        return None
    return matrices(
        parameters, stiffness, mass, sensors, floating=floating, outputs=outputs, base=base
    )


@dataclass(frozen=True)
class _Term:
    """A term of an affine matrix: the table that names it, its file, and what that announces.

    Attributes
    ----------
    table, key : where the file is named
    path, name : the file, and the name of the matrix in it, None for the only one
    size : number of rows that the file announces
    """

    table: Table
    key: str
    path: Path
    name: str | None
    size: int

    def matrix(self) -> scipy.sparse.coo_array | None:
        """Return the matrix; None with a fault where it cannot be read."""
        try:
            return read_matrix(self.path, self.name)
        except InputError as error:
            _note(self.table, self.key, error)
            return None


def _note(table: Table, key: str, error: InputError) -> None:
    """Note what is wrong with a file under the key that names it."""
    table.faults += [
        replace(fault, place=f"{table.place} {key}, {fault.place}") for fault in error.faults
    ]


def _matrices(terms: Mapping[str, _Term], size: int | None) -> dict[str, scipy.sparse.coo_array]:
    """Return the matrices that can be read; none of them is opened that has another size."""
    chosen = {name: term.matrix() for name, term in terms.items() if term.size == size}
    return {name: A for name, A in chosen.items() if A is not None}


def _terms(model: Table, key: str, parameters: Sequence[str]) -> dict[str, _Term]:
    """Return the terms of one table, each with the size that its file announces."""
    expected = f"a table of files, {BASE} = ... and one a parameter"
    table = model.table(key, expected)
    out: dict[str, _Term] = {}
    if table is None:
        return out
    if not table.values:
        table.fault("", "at least one matrix", "none")
    for name in table.values:
        if name != BASE and name not in parameters:
            table.fault(name, f"'{BASE}' or a parameter", suggestion(name, [BASE, *parameters]))
            continue
        file = _file(table, name)
        if file is None:
            continue
        try:
            path = table.path(file[0])
            out[name] = _Term(table, name, path, file[1], matrix_size(path, file[1]))
        except InputError as error:
            _note(table, name, error)
    return out


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


def _common_size(model: Table, files: Mapping[str, Mapping[str, _Term]]) -> int | None:
    """Return the N of most N x N matrices; a fault names the ones that differ from it."""
    found = {f"{key} {name}": term for key, terms in files.items() for name, term in terms.items()}
    if not found:
        return None
    sizes = {place: term.size for place, term in found.items()}
    counts = list(sizes.values())
    common = max(set(counts), key=lambda size: (counts.count(size), size))
    for place, size in sizes.items():
        if size != common:
            others = f"{common} x {common}, as the other matrices"
            model.fault(place, others, f"{size} x {size}")
    return common


def _check_entries(
    model: Table, matrices: Mapping[str, Mapping[str, scipy.sparse.coo_array]], size: int
) -> None:
    """Note a mass that is zero, and degrees of freedom with neither stiffness nor mass."""
    found = [A for terms in matrices.values() for A in terms.values()]
    mass = matrices["mass"]
    if mass and not any(A.nnz for A in mass.values()):
        model.fault("mass", "a mass matrix that is not zero", "only zeros")
    elif all(matrices.values()) and not model.faults:
        there = np.zeros(size, dtype=bool)
        for A in found:
            there[A.row] = True
        if not there.all():
            expected = "stiffness or mass at every degree of freedom"
            model.fault("", expected, f"neither at {int(np.argmin(there))} (from 0)")


MATRICES = ModelKind("matrices", read_matrices)
