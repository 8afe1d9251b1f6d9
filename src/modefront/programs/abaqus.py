"""Abaqus: ``*MATRIX GENERATE`` with ``*MATRIX OUTPUT`` writes ``job_STIF1.mtx``, ``job_MASS1.mtx``.

In the format MATRIX INPUT a line is ``node, direction, node, direction, value``; in the format
COORDINATE it is ``row column value``. Either triangle is listed, or both. Nodes that Abaqus makes
itself have negative numbers: they are a part of the model, and `modefront.programs.differences`
eliminates them where that is exact. Supports are diagonal entries of 1e36: these rows are left out.
"""

import re
from pathlib import Path

import numpy as np
import scipy.sparse

from modefront._typing import Bools
from modefront.inputs import wrong
from modefront.models.dofs import DofTable
from modefront.programs import base
from modefront.programs.inp import deck_of

ADVICE = "*MATRIX GENERATE, STIFFNESS, MASS with *MATRIX OUTPUT, STIFFNESS, MASS writes them"


def read(path: Path, options: base.JobOptions) -> base.Listed:
    """Return the matrices of a job, given by its name or by its file of the stiffness."""
    files = _files(path)
    rows = [_first(file)[0] for file in files] == [3, 3]
    dofs, (K, M) = _by_rows(files, options) if rows else _by_labels(files)
    notes: list[str] = []
    job = re.sub(r"_STIF\d+$", "", files[0].stem, flags=re.IGNORECASE)
    deck = deck_of(options.deck or files[0].with_name(job + ".inp"), notes)
    notes += base.turned(deck.turned if deck else ())
    if deck is not None and deck.parts:
        notes.append("the deck numbers nodes in parts: coordinates are left out")
    mesh = None if deck is None or deck.parts else deck.mesh

    def free(K: base.Matrix, M: base.Matrix) -> Bools:
        off = scipy.sparse.coo_array(K)
        beside = (off.row != off.col) & (off.data != 0)
        used: Bools = K.diagonal() + M.diagonal() != 0
        used[off.row[beside]] = used[off.col[beside]] = True  # those of Lagrange multipliers too
        return used & (K.diagonal() < 0.9e36)  # supports are diagonal entries of 1e36

    return base.Listed(files, (K, M), dofs, free=free, counted=False, mesh=mesh, notes=notes)


def _files(path: Path) -> tuple[Path, Path]:
    match = re.fullmatch(r"(.*)_STIF(\d+)", path.stem, re.IGNORECASE)
    if path.suffix.lower() == ".mtx" and match:
        files = [path]
    else:
        job = path.with_suffix("") if path.suffix.lower() in (".inp", ".odb", ".sim") else path
        pattern = re.compile(re.escape(job.name) + r"_STIF\d+\.mtx", re.IGNORECASE)
        folder = job.parent if job.parent.is_dir() else Path()
        files = sorted(file for file in folder.iterdir() if pattern.fullmatch(file.name))
        if len(files) > 1:
            names = ", ".join(file.name for file in files)
            raise wrong(path, "matrices of one step, or the name of one of them", names)
        files = files or [job.with_name(job.name + "_STIF1.mtx")]
    stiffness = base.existing(files[0], "the stiffness of Abaqus", ADVICE)
    name = re.sub(r"_STIF(?=\d+\.\w+$)", "_MASS", stiffness.name)
    name = re.sub(r"_stif(?=\d+\.\w+$)", "_mass", name)
    return stiffness, base.existing(stiffness.with_name(name), "the mass of Abaqus", ADVICE)


def _first(path: Path) -> tuple[int, str | None]:
    """Return how many numbers the first line has, five or three, and what is between them."""
    with path.open(encoding="latin-1") as text:
        lines = (line for line in text if line.strip() and line.lstrip()[0] not in "*%")
        if (line := next(lines, None)) is None:
            raise wrong(path, "entries of a matrix", "none")
    fields = [x for x in re.split(r"[,\s]+", line.strip()) if x]
    if len(fields) not in (3, 5):
        expected = "lines 'node, direction, node, direction, value' or 'row column value'"
        raise wrong(path, expected, " ".join(fields[:6]))
    return len(fields), "," if "," in line else None


def _by_labels(files: tuple[Path, Path]) -> tuple[DofTable, list[scipy.sparse.coo_array]]:
    """Return the table of all labels, nodes made by the program last, and rows and columns."""
    parts, slots = [], 32  # more than the greatest number of a direction
    for file in files:
        *labels, value = base.columns(file, _first(file)[1], "iiiif", comment="*")
        node, direction, other, its = (x.astype(np.int64) for x in labels)
        parts.append((node * slots + direction, other * slots + its, value))
    used = np.unique(np.concatenate([np.unique(key) for part in parts for key in part[:2]]))
    order = np.argsort(used < slots, kind="stable")  # nodes made by the program are below 1
    place = np.argsort(order)
    entries = []
    for row, column, value in parts:
        i, j = (place[np.searchsorted(used, key)] for key in (row, column))
        entries.append(base.entries_of(i, j, value, used.size))
    node, direction = used[order] // slots, used[order] % slots
    return DofTable(node, direction, (node > 0).astype(float)), entries


def _by_rows(
    files: tuple[Path, Path], options: base.JobOptions
) -> tuple[DofTable, list[scipy.sparse.coo_array]]:
    """Return what files in the format COORDINATE list; rows below 0 are nodes of the program."""
    parts = []
    for file in files:
        separator = _first(file)[1]
        parts.append(base.columns(file, separator, "iif", comment="*" if separator == "," else "%"))
    highest = max(int(index.max()) for part in parts for index in part[:2])
    made = -min(0, *(int(index.min()) for part in parts for index in part[:2]))
    own = base.given_table(options, highest)
    node, none = np.append(own.node, -np.arange(1, 1 + made)), np.zeros(made, np.intp)
    dofs = DofTable(node, np.append(own.direction, none), np.append(own.weight, none))
    entries = []
    for *places, value in parts:
        row, column = (np.where(x > 0, x - 1, highest - 1 - x) for x in places)
        entries.append(base.entries_of(row, column, value, dofs.size))
    return dofs, entries
