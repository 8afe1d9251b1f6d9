"""OpenSees: the files that the snippet in docs/import.md writes for a job.

``job_K`` and ``job_M`` are matrices (``.npz`` of SciPy or ``.mtx``), ``job_dofs.csv`` the node and
direction of each equation; ``job_nodes.csv`` (node, x, y, z) and ``job_elements.csv`` (element and
its nodes) may be there for pictures.
"""

from pathlib import Path
from typing import Any

import numpy as np

from modefront.data.csv import table_rows
from modefront.errors import reason
from modefront.inputs import ended, once, wrong
from modefront.models.dofs import read_dofs
from modefront.models.files import read_entries
from modefront.programs import base

ADVICE = "the snippet in docs/import.md writes it"


def read(path: Path, options: base.JobOptions) -> base.Listed:
    """Return the matrices of a job, given by the beginning of the names of its files."""
    table = options.dofs or path.with_name(path.name + "_dofs.csv")
    dofs = read_dofs(base.existing(table, "nodes and directions of OpenSees", ADVICE))
    files, entries = [], []
    for letter in "KM":
        names = [path.with_name(f"{path.name}_{letter}{ending}") for ending in (".npz", ".mtx")]
        file = names[0] if names[0].is_file() else names[1]
        matrix = read_entries(base.existing(file, "a matrix of OpenSees", ADVICE))
        matrix.sum_duplicates()  # what a sum of elements is kept as
        files.append(file)
        entries.append(matrix)
    return base.Listed((files[0], files[1]), entries, dofs, mesh=_mesh(path))


def _mesh(path: Path) -> base.ProgramMesh | None:
    nodes = path.with_name(path.name + "_nodes.csv")
    if not nodes.is_file():
        return None
    elements = path.with_name(path.name + "_elements.csv")
    try:
        points = {n: np.array([*x, 0.0, 0.0, 0.0][:3]) for n, *x in _rows(nodes, float)}
        rows = _rows(elements, int) if elements.is_file() else []
    except ValueError as error:
        expected = "rows node,x,y,z (and element,node,… of elements)"
        raise wrong(nodes, expected, reason(error)) from None
    base.refuse_unknown_nodes(elements, points, (n for row in rows for n in row[1:]))
    kinds = {1: "vertex", 2: "line", 3: "triangle", 4: "quad", 8: "hexahedron"}
    return base.mesh_of(points, ((kinds[len(x)], x) for _, *x in rows if len(x) in kinds))


def _rows(path: Path, number: type) -> list[list[Any]]:
    """Return rows of whole numbers, each once, and others, without a header."""
    ended(path)
    listed = table_rows(path, "rows node,x,y,z, or element,node,…")
    rows = [[x.strip() for x in row if x.strip()] for _, row in listed]
    begin = 0 if rows and rows[0][0].lstrip("-").isdigit() else 1
    out = [[int(row[0]), *map(number, row[1:])] for row in rows[begin:]]
    once(path, "rows", "each node or element", (row[0] for row in out))
    lengths = {len(row) for row in out}
    if number is float and (len(lengths) > 1 or max(lengths, default=4) > 4):
        raise ValueError("rows of different lengths, or of more than three coordinates")
    if number is float and not np.isfinite(out).all():
        raise ValueError("numbers that are not finite")
    return out
