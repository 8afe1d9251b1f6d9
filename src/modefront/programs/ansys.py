r"""Ansys: the assembled matrices of a ``.full`` file, or Matrix Market files of ``*EXPORT``.

A ``.full`` file is a sequence of records: length in words of 4 bytes, a word of flags, the words,
and the length again. The second record is a header whose pointers count words: where degrees of
freedom, stiffness and mass begin. Of the degrees of freedom, one record has their number for each
node, one their identifiers, negative where they are held; the order of nodes is that of an earlier
record. A matrix has two records for each row, columns and values, of which the last is that of the
diagonal; held rows are listed too and left out here.

========  ===========================================================
item      meaning (words of the header, counted from 1)
========  ===========================================================
1         -4 for an assembled matrix
2         number of rows
9, 10     terms of the stiffness (low and high word); 34, 22 mass
11, 14    lumped mass; unsymmetric
19, 20    stiffness; 27, 28 mass; 36, 37 degrees of freedom
21        constraint equations, which are kept apart
========  ===========================================================
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from modefront._typing import Floats, Ints
from modefront.inputs import counted, wrong
from modefront.models.dofs import DofTable
from modefront.models.files import read_entries
from modefront.programs.base import JobOptions
from modefront.programs.reading import Entries, Listed, existing, given_table, unlabelled

MATRICES = {"stiffness": ("_K", "K", "_stiff", "_STIFF"), "mass": ("_M", "M", "_mass", "_MASS")}

ADVICE = "a modal analysis writes file.full (WRFULL,1 stops there), *EXPORT,…,MMF job_K.mmf"


def read(path: Path, options: JobOptions) -> Listed:
    """Return the matrices of a job: a .full file, or the beginning of the names of two others."""
    full = path if path.suffix.lower() == ".full" else path.with_name(path.name + ".full")
    if full is path or full.is_file():
        return _from_full(existing(full, "a file of Ansys", ADVICE))
    return _from_market(path, options)


# .full


@dataclass(frozen=True, eq=False)
class _Words:
    path: Path
    words: np.ndarray

    def record(self, start: int) -> tuple[np.ndarray, int]:
        """Return the words of the record at a position, and the position of the next."""
        size = self.words.size - 3
        count = int(self.words[start]) if 0 <= start <= size else -1
        if not 0 <= count <= size - start or self.words[start + count + 2] != count:
            raise wrong(self.path, "whole records of Ansys", "a file that is cut off, or another")
        flags = (int(self.words[start + 1]) >> 24) & 0xFF
        if flags not in (0x80, 0):  # integers, or doubles
            raise wrong(self.path, "records that are not compressed (/FCOMP,FULL,0)", "others")
        return self.words[start + 2 : start + 2 + count], start + count + 3

    def long(self, header: np.ndarray, low: int, high: int) -> int:
        """Return a number of two words of the header, counted from 1."""
        return (int(header[low - 1]) & 0xFFFFFFFF) + (int(header[high - 1]) << 32)


def _from_full(path: Path) -> Listed:
    data = np.fromfile(path, dtype=np.uint8)
    words = _Words(path, data[: data.size // 4 * 4].view("<i4"))
    header, position = words.record(103)
    if words.words[0] != 100 or header.size < 64 or header[0] >= 0:
        raise wrong(path, "an assembled matrix of Ansys (.full)", "another file")
    if header[13]:
        expected = "symmetric matrices"
        raise wrong(path, expected, "unsymmetric ones (NROPT, contact, rotors, fluids)")
    if header[20]:
        expected = "matrices without constraint equations (CE, RBE3, rigid contact), which are "
        expected += "kept apart: *EXPORT, which applies them"
        raise wrong(path, expected, f"{header[20]} constraint equations")
    size = int(header[1])
    _, position = words.record(position)
    nodes, _ = words.record(position)
    counts, position = words.record(words.long(header, 36, 37))
    identifiers, _ = words.record(position)
    if identifiers.size != size or counts.sum() != size or counts.size != nodes.size:
        raise wrong(path, f"{size} degrees of freedom", f"{identifiers.size} of {counts.sum()}")
    node = np.repeat(nodes, counts).astype(np.intp)
    dofs = DofTable(node, np.abs(identifiers).astype(np.intp), np.ones(size))
    terms = words.long(header, 34, 22)
    stiffness = _rows(words, words.long(header, 19, 20), words.long(header, 9, 10), size)
    if terms == 0:
        raise wrong(path, "a mass matrix (ANTYPE,MODAL)", "none")
    position = words.long(header, 27, 28)
    if header[10]:  # lumped
        value, _ = words.record(position)
        if value.size != 2 * size:
            raise wrong(path, f"{size} lumped masses", f"{value.size // 2}")
        diagonal = np.arange(size)
        mass = Entries(diagonal, diagonal, np.ascontiguousarray(value).view("<f8"))
    else:
        mass = _rows(words, position, terms, size)
    notes = ["there is a damping matrix, which is left out"] if int(header[34]) else []
    return Listed((path, path), (stiffness, mass), dofs, identifiers > 0, notes=notes)


def _rows(words: _Words, position: int, terms: int, size: int) -> Entries:
    columns, values, count = list[np.ndarray](), list[np.ndarray](), 0
    while count < terms:
        index, position = words.record(position)
        value, position = words.record(position)
        if index.size == 0 or value.size != 2 * index.size:
            raise wrong(words.path, "columns and values of a row", "others")
        columns.append(index)
        values.append(value)
        count += index.size
    counted(words.path, "records of rows", "terms of a matrix", terms, count)
    counted(words.path, "records of rows", "rows", size, len(columns))
    length = np.array([index.size for index in columns])
    column = np.concatenate(columns) - 1
    diagonal = column[np.cumsum(length) - 1]
    if (diagonal != np.arange(size)).any():
        raise wrong(words.path, "rows in their order, each to its diagonal", "others")
    row = np.repeat(diagonal, length)
    return Entries(row, column, np.concatenate(values).view("<f8"))


def _from_market(path: Path, options: JobOptions) -> Listed:
    files, matrices, suffixes = [], [], (".mmf", ".mtx", ".mmx", ".txt")
    for what, endings in MATRICES.items():
        names = [path.with_name(path.name + end + suffix) for end in endings for suffix in suffixes]
        file = next((name for name in names if name.is_file()), names[0])
        matrices.append(read_entries(existing(file, f"the {what} of Ansys", ADVICE), form=".mtx"))
        files.append(file)
    size = matrices[0].shape[0]
    if matrices[1].shape[0] != size:
        raise wrong(path, f"a mass matrix of {size} rows", str(matrices[1].shape[0]))
    dofs = given_table(options, size) or _labels(path, size)
    K, M = (Entries(matrix.row, matrix.col, matrix.data) for matrix in matrices)
    return Listed((files[0], files[1]), (K, M), dofs)


def _labels(path: Path, size: int) -> DofTable:
    mapping = path.with_name(path.name + ".mapping")
    maps = [path.with_name(f"{path.name}_{name}.mmf") for name in ("nod2bcs", "back")]
    if mapping.is_file():
        directions = {x: k for k, x in enumerate(("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"), 1)}
        lines = mapping.read_text(encoding="utf-8", errors="replace").splitlines()
        rows = [x for x in map(str.split, lines) if len(x) > 2 and "".join(x[:2]).isdigit()]
        listed = sorted((int(a), int(b), directions.get(c.upper(), 0)) for a, b, c, *_ in rows)
        number, node, direction = np.array(listed, dtype=np.intp).reshape(-1, 3).T
        if not np.array_equal(number, np.arange(1, len(listed) + 1)):
            expected = "one line for each equation: equation, node, direction"
            raise wrong(mapping, expected, "others")
        table = DofTable(node, direction, np.ones(len(listed)))
    elif all(file.is_file() for file in maps):
        table = _maps(maps[0], maps[1])
    else:
        return unlabelled(size)
    if table.size != size:
        raise wrong(path, f"{size} degrees of freedom in the table of nodes", str(table.size))
    return table


def _maps(nod2bcs: Path, back: Path) -> DofTable:
    """Return the table of the maps NOD2BCS (equations, nodal values) and BACK (nodes)."""
    listed = read_entries(back, square=False, form=".mtx")
    if listed.nnz < np.prod(listed.shape, dtype=float):
        raise wrong(back, "a node in every row", f"{listed.nnz} in {listed.shape}")
    nodes: Ints = listed.toarray().ravel().astype(np.intp)
    picked = read_entries(nod2bcs, square=False, form=".mtx")
    per_node = picked.shape[1] // max(nodes.size, 1)
    if picked.shape[1] != per_node * nodes.size or picked.nnz < picked.shape[0]:
        raise wrong(nod2bcs, f"a whole number of columns for {nodes.size} nodes", str(picked.shape))
    column = np.zeros(picked.shape[0], np.intp)
    entries: Floats = picked.data
    column[picked.row[entries != 0]] = picked.col[entries != 0]
    return DofTable(nodes[column // per_node], column % per_node + 1, np.ones(column.size))
