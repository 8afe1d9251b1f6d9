"""OpenSees: the files that the snippet in docs/import.md writes for a job.

``job_K`` and ``job_M`` are matrices (``.npz`` of SciPy or ``.mtx``), ``job_dofs.csv`` the node and
direction of each equation; ``job_nodes.csv`` (node, x, y, z) and ``job_elements.csv`` (element and
its nodes) may be there for pictures.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import scipy.sparse

from modefront.errors import InputError, reason
from modefront.models.dofs import read_dofs
from modefront.models.formats.scipy_npz import SCIPY_NPZ
from modefront.programs.base import (
    DOUBLE,
    Entries,
    Job,
    JobOptions,
    Program,
    existing,
    upper,
    wrong,
)
from modefront.programs.mesh import ProgramMesh, mesh_of
from modefront.programs.text import matrix_market

ADVICE = "the snippet in docs/import.md writes it"
CELLS = {1: "vertex", 2: "line", 3: "triangle", 4: "quad", 8: "hexahedron"}


def read(path: Path, options: JobOptions) -> Job:
    """Return the matrices of a job, given by the beginning of the names of its files."""
    table = options.dofs or path.with_name(path.name + "_dofs.csv")
    dofs = read_dofs(existing(table, "nodes and directions of OpenSees", ADVICE))
    matrices = []
    for letter in "KM":
        file = path.with_name(f"{path.name}_{letter}.npz")
        if not file.is_file():
            file = path.with_name(f"{path.name}_{letter}.mtx")
        matrix = _matrix(existing(file, "a matrix of OpenSees", ADVICE))
        if matrix.shape != (dofs.size, dofs.size):
            expected = f"{dofs.size} rows and columns, as '{table.name}' has rows"
            raise wrong(file, expected, " x ".join(map(str, matrix.shape)))
        entries = Entries(matrix.row, matrix.col, matrix.data)
        matrices.append(upper(file, dofs.size, entries, dofs))
    return Job(str(path), matrices[0], matrices[1], dofs, DOUBLE, mesh=_mesh(path))


def _matrix(path: Path) -> scipy.sparse.coo_array:
    if path.suffix == ".mtx":
        return matrix_market(path)
    try:
        matrix = SCIPY_NPZ.read(path, None)
    except InputError:
        raise
    except Exception as error:  # what is raised for a damaged file is not documented
        raise wrong(path, "a sparse matrix of SciPy", reason(error)) from None
    if matrix.dtype.kind not in "biuf":
        raise wrong(path, "real numbers", str(matrix.dtype))
    return scipy.sparse.coo_array(matrix).astype(float)


def _mesh(path: Path) -> ProgramMesh | None:
    nodes = path.with_name(path.name + "_nodes.csv")
    if not nodes.is_file():
        return None
    points = {}
    try:
        for row in _rows(nodes):
            points[int(row[0])] = np.array([float(x) for x in row[1:]] + [0.0] * (4 - len(row)))
        cells: dict[str, list[list[int]]] = {}
        elements = path.with_name(path.name + "_elements.csv")
        for row in _rows(elements) if elements.is_file() else ():
            kind = CELLS.get(len(row) - 1)
            if kind:
                cells.setdefault(kind, []).append([int(x) for x in row[1:]])
    except (ValueError, IndexError) as error:
        raise wrong(
            nodes, "rows node,x,y,z (and element,node,… of elements)", reason(error)
        ) from None
    return mesh_of(points, cells)


def _rows(path: Path) -> list[list[str]]:
    with path.open(encoding="utf-8-sig", newline="") as stream:
        rows = [[x.strip() for x in row if x.strip()] for row in csv.reader(stream)]
    return [row for row in rows if row and row[0].lstrip("-").isdigit()]


OPENSEES = Program("opensees", read)
