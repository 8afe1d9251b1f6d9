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

from pathlib import Path

import numpy as np
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.errors import refusing
from modefront.inputs import wrong
from modefront.models.dofs import DofTable
from modefront.models.files import read_entries
from modefront.programs.base import JobOptions, Listed, entries_of, existing, given_table

MATRICES = {"stiffness": ("_K", "K", "_stiff", "_STIFF"), "mass": ("_M", "M", "_mass", "_MASS")}

ROTATED = "directions are those of the nodes' own systems (NROTAT), which the files do not tell"

ADVICE = "a modal analysis writes file.full (WRFULL,1 stops there), *EXPORT,…,MMF job_K.mmf"


def read(path: Path, options: JobOptions) -> Listed:
    """Return the matrices of a job: a .full file, or the beginning of the names of two others."""
    full = path if path.suffix.lower() == ".full" else path.with_name(path.name + ".full")
    if full is path or full.is_file():
        file = existing(full, "a file of Ansys", ADVICE)
        with refusing(file, "whole records of an assembled matrix of Ansys (.full)", ValueError):
            return _from_full(_Words(file), file)
    files, matrices, suffixes = [], [], (".mmf", ".mtx", ".mmx", ".txt")
    for what, endings in MATRICES.items():
        names = [path.with_name(path.name + end + suffix) for end in endings for suffix in suffixes]
        file = next(filter(Path.is_file, names), names[0])
        found = existing(file, f"the {what} of Ansys", ADVICE)
        matrices.append(read_entries(found, form=".mtx"))
        files.append(found)
    dofs = _labels(path, options, matrices[0].shape[0])
    return Listed((files[0], files[1]), matrices, dofs, notes=[ROTATED])


class _Words:
    """Words of 4 bytes of a file, and where in them the next record is."""

    def __init__(self, path: Path) -> None:
        data = np.fromfile(path, dtype=np.uint8)
        self.words, self.position = data[: data.size // 4 * 4].view("<i4"), 103

    def record(self, position: int | None = None, kind: str = "<i4") -> np.ndarray:
        """Return the content of the record at a position, the next one unless given."""
        start = self.position if position is None else position
        count = int(self.words[start]) if 0 <= start < self.words.size else -1
        self.position = start + count + 3
        if count < 0 or self.position > self.words.size or self.words[start + count + 2] != count:
            raise ValueError("a file that is cut off, or another")
        if (int(self.words[start + 1]) >> 24) & 0xFF not in (0x80, 0):  # integers, or doubles
            raise ValueError("records that are compressed: /FCOMP,FULL,0 writes others")
        return np.ascontiguousarray(self.words[start + 2 : start + 2 + count]).view(kind)


def _from_full(words: _Words, path: Path) -> Listed:
    header = words.record()

    def long(low: int, high: int) -> int:
        """Return a number of two words of the header, counted from 1."""
        return (int(header[low - 1]) & 0xFFFFFFFF) + (int(header[high - 1]) << 32)

    if words.words[0] != 100 or header.size < 64 or header[0] >= 0:
        raise ValueError("another file")
    if header[13]:
        raise ValueError("unsymmetric matrices (NROPT, contact, rotors, fluids)")
    if header[20]:
        found = f"{header[20]} constraint equations (CE, RBE3, rigid contact), which are kept apart"
        raise ValueError(f"{found}: *EXPORT applies them")
    size, terms = int(header[1]), long(34, 22)
    if terms == 0:
        raise ValueError("no mass matrix (ANTYPE,MODAL writes one)")
    words.record()
    nodes, counts, identifiers = words.record(), words.record(long(36, 37)), words.record()
    if identifiers.size != size or counts.sum() != size or counts.size != nodes.size:
        raise ValueError(f"{identifiers.size} of {counts.sum()} degrees of freedom, not {size}")
    node = np.repeat(nodes, counts).astype(np.intp)
    dofs = DofTable(node, np.abs(identifiers).astype(np.intp), np.ones(size))
    K = _rows(words, long(19, 20), long(9, 10), size)
    if header[10]:  # lumped
        diagonal = np.arange(size)
        M = entries_of(diagonal, diagonal, words.record(long(27, 28), "<f8"), size)
    else:
        M = _rows(words, long(27, 28), terms, size)
    notes = [ROTATED, *["there is a damping matrix, which is left out"] * bool(header[34])]
    return Listed((path, path), (K, M), dofs, free=lambda *_: identifiers > 0, notes=notes)


def _rows(words: _Words, position: int, terms: int, size: int) -> scipy.sparse.coo_array:
    columns, values = list[np.ndarray](), list[np.ndarray]()
    words.position = position
    for _ in range(size):
        columns.append(words.record())
        values.append(words.record(kind="<f8"))
    length = np.array([index.size for index in columns])
    column = np.concatenate(columns) - 1
    if length.sum() != terms or [x.size for x in values] != length.tolist():
        raise ValueError(f"{column.size} terms of {size} rows, not {terms} with as many values")
    diagonal = column[np.cumsum(length) - 1]
    if (diagonal != np.arange(size)).any():
        raise ValueError("rows that are not in their order, each to its diagonal")
    return entries_of(np.repeat(diagonal, length), column, np.concatenate(values), size)


def _labels(path: Path, options: JobOptions, size: int) -> DofTable:
    mapping = path.with_name(path.name + ".mapping")
    maps = [path.with_name(f"{path.name}_{name}.mmf") for name in ("nod2bcs", "back")]
    if mapping.is_file() and not options.dofs:
        directions = {x: k for k, x in enumerate(("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"), 1)}
        lines = mapping.read_text(encoding="utf-8", errors="replace").splitlines()
        rows = [x for x in map(str.split, lines) if len(x) > 2 and "".join(x[:2]).isdigit()]
        listed = sorted((int(a), int(b), directions.get(c.upper(), 0)) for a, b, c, *_ in rows)
        number, node, direction = np.array(listed, dtype=np.intp).reshape(-1, 3).T
        if not np.array_equal(number, np.arange(1, len(listed) + 1)):
            raise wrong(mapping, "one line for each equation: equation, node, direction", "others")
        return DofTable(node, direction, np.ones(len(listed)))
    is_mapped = all(file.is_file() for file in maps) and not options.dofs
    return _maps(*maps) if is_mapped else given_table(options, size)


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
