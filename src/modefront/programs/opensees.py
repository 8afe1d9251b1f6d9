"""OpenSees: the files that the snippet in docs/import.md writes for a job.

``job_K`` and ``job_M`` are matrices (``.npz`` of SciPy or ``.mtx``), ``job_dofs.csv`` the node and
direction of each equation; ``job_nodes.csv`` (node, x, y, z) and ``job_elements.csv`` (element and
its nodes) may be there for pictures.
"""

from pathlib import Path
from typing import Any

import numpy as np

from modefront.data.csv import table_rows
from modefront.errors import refusing
from modefront.inputs import ended
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
    nodes, elements = (path.with_name(f"{path.name}_{x}.csv") for x in ("nodes", "elements"))
    if not nodes.is_file():
        return base.Listed((files[0], files[1]), entries, dofs)
    points = _rows(nodes, "node,x,y,z", float)
    members = _rows(elements, "element,node,…", int) if elements.is_file() else {}
    base.refuse_unknown_nodes(elements, points, (n for row in members.values() for n in row))
    kinds = {1: "vertex", 2: "line", 3: "triangle", 4: "quad", 8: "hexahedron"}
    known = ((kinds[len(row)], row) for row in members.values() if len(row) in kinds)
    placed = {n: np.array([*x, 0.0, 0.0, 0.0][:3]) for n, x in points.items()}
    return base.Listed((files[0], files[1]), entries, dofs, mesh=base.mesh_of(placed, known))


def _rows(path: Path, form: str, number: type) -> dict[int, list[Any]]:
    """Return the numbers behind the first, a whole one, of every row below the header, if any."""
    ended(path)
    out: dict[int, list[Any]] = {}
    for k, (line, fields) in enumerate(table_rows(path, f"rows {form}")):
        first, *others = (x.strip() for x in fields if x.strip())
        if k == 0 and not first.lstrip("-").isdigit():
            continue
        with refusing(path, f"rows {form}", ValueError, place=f"line {line}"):
            key, row = int(first), list(map(number, others))
            if key in out:
                raise ValueError(f"{key} again")
            if number is float and len(row) != len(next(iter(out.values()), row[:3])):
                raise ValueError(f"{len(row)} coordinates")
            if not np.isfinite(row).all():
                raise ValueError("numbers that are not finite")
            out[key] = row
    return out
