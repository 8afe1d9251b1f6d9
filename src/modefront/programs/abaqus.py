"""Abaqus: ``*MATRIX GENERATE`` with ``*MATRIX OUTPUT`` writes ``job_STIF1.mtx``, ``job_MASS1.mtx``.

In the format MATRIX INPUT a line is ``node, direction, node, direction, value``; in the format
COORDINATE it is ``row column value``. Either triangle is listed, or both. Nodes that Abaqus makes
itself have negative numbers: they are a part of the model, and `modefront.programs.condense`
eliminates them where that is exact. Supports are diagonal entries of 1e36: these rows are left out.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import scipy.sparse

from modefront._typing import Ints
from modefront.errors import reason
from modefront.models.dofs import DofTable, read_dofs
from modefront.programs.base import (
    DOUBLE,
    Entries,
    Job,
    JobOptions,
    Program,
    columns,
    existing,
    kept,
    refuse_mass_alone,
    upper,
    wrong,
)
from modefront.programs.inp import read_deck
from modefront.programs.mesh import ProgramMesh

HELD = 0.9e36
"""Diagonal entries from which a degree of freedom is a support."""

SLOTS = 32
"""More than the greatest number of a direction."""

ADVICE = "*MATRIX GENERATE, STIFFNESS, MASS with *MATRIX OUTPUT, STIFFNESS, MASS writes them"


def read(path: Path, options: JobOptions) -> Job:
    """Return the matrices of a job, given by its name or by its file of the stiffness."""
    stiffness, mass = _files(path)
    widths = [len(_fields(file)) for file in (stiffness, mass)]
    if widths == [3, 3]:
        return _by_rows([stiffness, mass], options)
    parts = [_labelled_entries(file) for file in (stiffness, mass)]
    dofs, tables = _common(parts[0][0], parts[1][0])
    K, M = (
        upper(file, dofs.size, Entries(*table, part[1]), dofs)
        for file, table, part in zip((stiffness, mass), tables, parts, strict=True)
    )
    return _job(stiffness, K, M, dofs, True, options)


def _files(path: Path) -> tuple[Path, Path]:
    """Return the files of stiffness and mass of a job."""
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
    stiffness = existing(files[0], "the stiffness of Abaqus", ADVICE)
    name = re.sub(r"_STIF(\d+)(\.\w+)$", r"_MASS\1\2", stiffness.name)
    if name == stiffness.name:
        name = re.sub(r"_stif(\d+)(\.\w+)$", r"_mass\1\2", stiffness.name)
    return stiffness, existing(stiffness.with_name(name), "the mass of Abaqus", ADVICE)


def _first(path: Path) -> str:
    """Return the first line of numbers."""
    with path.open(encoding="latin-1") as text:
        for line in text:
            if line.strip() and line.lstrip()[0] not in "*%":
                return line
    raise wrong(path, "entries of a matrix", "none")


def _fields(path: Path) -> list[str]:
    """Return the numbers of the first line of a matrix: five, or three."""
    fields = [x for x in re.split(r"[,\s]+", _first(path).strip()) if x]
    if len(fields) not in (3, 5):
        expected = "lines 'node, direction, node, direction, value' or 'row column value'"
        raise wrong(path, expected, " ".join(fields[:6]))
    return fields


def _labelled_entries(path: Path) -> tuple[tuple[Ints, ...], np.ndarray]:
    """Return nodes and directions of rows and columns, and the values."""
    commas = "," in _first(path)
    *labels, values = columns(path, "," if commas else r"\s+", "iiiif", comment="*")
    return tuple(labels), values


def _common(
    stiffness: tuple[Ints, ...], mass: tuple[Ints, ...]
) -> tuple[DofTable, list[tuple[Ints, Ints]]]:
    """Return the table of all labels, nodes made by the program last, and rows and columns."""
    keys = [
        [part[k].astype(np.int64) * SLOTS + part[k + 1] for k in (0, 2)]
        for part in (stiffness, mass)
    ]
    used = np.unique(np.concatenate([np.unique(key) for pair in keys for key in pair]))
    order = np.argsort(used < SLOTS, kind="stable")  # nodes made by the program are below 1
    place = np.empty(used.size, np.intp)
    place[order] = np.arange(used.size)
    tables: list[tuple[Ints, Ints]] = [
        (place[np.searchsorted(used, row)], place[np.searchsorted(used, column)])
        for row, column in keys
    ]
    node, direction = used[order] // SLOTS, used[order] % SLOTS
    return DofTable(node, direction, (node > 0).astype(float)), tables


def _by_rows(files: list[Path], options: JobOptions) -> Job:
    """Return the job of files in the format COORDINATE; rows below 0 are nodes of the program."""
    parts = []
    for file in files:
        commas = "," in _first(file)
        separator = "," if commas else r"\s+"
        parts.append(columns(file, separator, "iif", comment="%" if not commas else "*"))
    highest = max(int(index.max()) for part in parts for index in part[:2])
    lowest = min(0, *(int(index.min()) for part in parts for index in part[:2]))
    size = highest - lowest
    nobody = np.concatenate([np.zeros(highest, np.intp), -np.arange(1, 1 - lowest)])
    dofs = DofTable(nobody, np.zeros(size, np.intp), (nobody >= 0).astype(float))
    if options.dofs is not None:
        given = read_dofs(options.dofs)
        if given.size != highest:
            raise wrong(options.dofs, f"{highest} rows, one a degree of freedom", str(given.size))
        grown = (np.append(given.node, nobody[highest:]), np.append(given.direction, -lowest * [0]))
        dofs = DofTable(*grown, np.append(given.weight, np.zeros(-lowest)))
    K, M = (
        upper(
            file, size, Entries(_place(part[0], highest), _place(part[1], highest), part[2]), dofs
        )
        for file, part in zip(files, parts, strict=True)
    )
    return _job(files[0], K, M, dofs, options.dofs is not None, options)


def _place(index: Ints, highest: int) -> Ints:
    return np.where(index > 0, index - 1, highest - 1 - index)


def _job(
    path: Path,
    K: scipy.sparse.csr_array,
    M: scipy.sparse.csr_array,
    dofs: DofTable,
    labelled: bool,
    options: JobOptions,
) -> Job:
    """Return the job without degrees of freedom that are held."""
    notes: list[str] = []
    refuse_mass_alone(path, K, M, dofs)
    free = np.flatnonzero((K.diagonal() < HELD) & (K.diagonal() + M.diagonal() != 0) | _tied(K))
    if free.size < dofs.size:
        notes.append(f"{dofs.size - free.size} degrees of freedom that are held are left out")
        K, M = kept(K, free), kept(M, free)
        dofs = DofTable(dofs.node[free], dofs.direction[free], dofs.weight[free])
    if not labelled:
        notes.append("sensors can be given by degrees of freedom only, unless --dofs names nodes")
    mesh = _mesh(path, options, notes)
    return Job(str(path), K, M, dofs, DOUBLE, labelled=labelled, mesh=mesh, notes=tuple(notes))


def _tied(K: scipy.sparse.csr_array) -> np.ndarray:
    """Return which rows have entries beside the diagonal, as those of Lagrange multipliers."""
    off = scipy.sparse.coo_array(K)
    beside = (off.row != off.col) & (off.data != 0)
    out = np.zeros(K.shape[0], bool)
    out[off.row[beside]] = out[off.col[beside]] = True
    return out & (K.diagonal() < HELD)


def _mesh(path: Path, options: JobOptions, notes: list[str]) -> ProgramMesh | None:
    job = re.sub(r"_STIF\d+$", "", path.stem, flags=re.IGNORECASE)
    try:
        deck = read_deck(options.deck or path.with_name(job + ".inp"))
    except OSError as error:
        notes.append(f"without the deck ({reason(error)}) there are no coordinates")
        return None
    if deck.parts:
        notes.append("the deck numbers nodes in parts: coordinates are left out")
        return None
    return deck.mesh


ABAQUS = Program("abaqus", read, eliminates=True)
