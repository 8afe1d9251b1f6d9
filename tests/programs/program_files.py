"""A small structure with two parameters, and writers of the formats of programs.

The writers follow the public descriptions of the formats; nothing of them is shared with the
readers.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
import scipy.sparse

Array = npt.NDArray[np.float64]

NODES = (12, 3, 7, 40, 5)
"""Nodes in the order of the rows; each has x, y and z."""


def structure(
    E: float = 1.0, k: float = 1.0, t: float | None = None, rho: float = 1.0
) -> tuple[Array, Array]:
    """Return K and M of bars between all nodes, held by springs, 15 x 15.

    ``E`` scales half of the bars, ``k`` a spring between node 12 z and node 40 z, ``rho`` the mass
    of node 7; ``t`` adds a plate-like part with t and t cubed.
    """
    rng = np.random.default_rng(5)
    n = 3 * len(NODES)
    K, M = np.diag(np.linspace(50, 80, n)), np.diag(np.linspace(1, 2, n))
    for i in range(len(NODES)):
        for j in range(i):
            a = rng.standard_normal(3)
            b = np.zeros(n)
            b[3 * i : 3 * i + 3], b[3 * j : 3 * j + 3] = a, -a
            K += (E if i < 3 else 1.0) * 40 * np.outer(b, b)
    spring = np.zeros(n)
    spring[2], spring[11] = 1.0, -1.0
    K += k * 300 * np.outer(spring, spring)
    M[6:9, 6:9] *= rho
    if t is not None:
        part = rng.standard_normal((6, 6))
        K[:6, :6] += t * part @ part.T + t**3 * np.diag(np.arange(1.0, 7.0))
    return K, M


def labels() -> list[tuple[int, int]]:
    """Return node and direction, from 1, of every row."""
    return [(node, d) for node in NODES for d in (1, 2, 3)]


def frequencies(K: Array, M: Array) -> Array:
    """Return all frequencies in Hz."""
    lam = np.linalg.eigvals(np.linalg.solve(M, K)).real
    return np.sqrt(np.sort(lam)) / (2 * np.pi)


def dense(A: scipy.sparse.sparray) -> Array:
    """Return a matrix as an array."""
    out: Array = A.toarray()
    return out


# CalculiX


def write_calculix(job: Path, K: Array, M: Array, names: Sequence[tuple[int, int]]) -> None:
    """Write ``.sti``, ``.mas`` and ``.dof``."""
    pattern = np.triu((K != 0) | (M != 0))
    for suffix, A in ((".sti", K), (".mas", M)):
        places = sorted(zip(*np.nonzero(pattern), strict=True), key=lambda p: (p[1], p[0]))
        lines = (f"{i + 1} {j + 1} {A[i, j]:20.13e}\n" for i, j in places)
        job.with_suffix(suffix).write_text("".join(lines))
    job.with_suffix(".dof").write_text("".join(f"{n}.{d}\n" for n, d in names))


# Nastran


def _runs(column: Array) -> list[tuple[int, Array]]:
    """Return first row, from 1, and values of every run of entries that are not zero."""
    used = np.flatnonzero(column)
    parts = np.split(used, np.flatnonzero(np.diff(used) > 1) + 1) if used.size else []
    return [(int(part[0]) + 1, column[part]) for part in parts]


def write_op4(
    path: Path,
    matrices: Mapping[str, Array],
    form: str,
    *,
    order: str = "<",
    single: bool = False,
    long: bool = False,
) -> None:
    """Write a binary OUTPUT4 file; ``form`` is dense, sparse or bigmat, ``long`` has ILP64."""
    integer, width = ("q", 8) if long else ("i", 4)
    real = "f" if single and not long else "d"
    words = 1 if long or single else 2
    out = bytearray()

    def record(content: bytes) -> None:
        mark = struct.pack(f"{order}i", len(content))
        out.extend(mark + content + mark)

    def integers(*values: int) -> bytes:
        return struct.pack(f"{order}{len(values)}{integer}", *values)

    for name, A in matrices.items():
        rows = -len(A) if form == "bigmat" else len(A)
        kind = 1 if single else 2
        record(integers(len(A), rows, 6, kind) + name.ljust(2 * width).encode())
        for j, column in enumerate(A.T, start=1):
            runs = _runs(column)
            if not runs:
                continue
            if form == "dense":
                first, last = runs[0][0], runs[-1][0] + len(runs[-1][1])
                values = column[first - 1 : last - 1]
                head = integers(j, first, words * len(values))
                record(head + struct.pack(f"{order}{len(values)}{real}", *values))
                continue
            body = b""
            for first, values in runs:
                length = words * len(values)
                head = integers(length + 1, first)
                if form == "sparse":
                    head = integers(first + 65536 * (length + 1))
                body += head + struct.pack(f"{order}{len(values)}{real}", *values)
            record(integers(j, 0, len(body) // width) + body)
        end = integers(len(A) + 1, 1, words) + struct.pack(f"{order}{real}", 1.0)
        record(end)
    path.write_bytes(bytes(out))


def write_op4_text(
    path: Path, matrices: Mapping[str, Array], form: str, *, digits: int = 16, end: str = "\n"
) -> None:
    """Write a text OUTPUT4 file; ``form`` is dense, sparse or bigmat."""
    width, per = digits + 7, 80 // (digits + 7)
    lines = []

    def values(x: Array) -> None:
        for k in range(0, len(x), per):
            lines.append("".join(fortran(f"{v:{width}.{digits}E}") for v in x[k : k + per]))

    def fortran(text: str) -> str:
        """Return a number without the E before an exponent of three digits."""
        bare = text.replace("E", "") if len(text.split("E")[1]) > 3 else text
        return bare.strip().rjust(width)

    for name, A in matrices.items():
        rows = -len(A) if form == "bigmat" else len(A)
        head = f"{len(A):8d}{rows:8d}{6:8d}{2:8d}{name:8s}1P,{per}E{width}.{digits}"
        lines.append(head)
        for j, column in enumerate(A.T, start=1):
            runs = _runs(column)
            if not runs:
                continue
            if form == "dense":
                first, last = runs[0][0], runs[-1][0] + len(runs[-1][1])
                lines.append(f"{j:8d}{first:8d}{last - first:8d}")
                values(column[first - 1 : last - 1])
                continue
            count = sum(2 * len(x) + (2 if form == "bigmat" else 1) for _, x in runs)
            lines.append(f"{j:8d}{0:8d}{count:8d}")
            for first, x in runs:
                if form == "bigmat":
                    lines.append(f"{2 * len(x) + 1:8d}{first:8d}")
                else:
                    lines.append(f"{first + 65536 * (2 * len(x) + 1):12d}")
                values(x)
        lines += [f"{len(A) + 1:8d}{1:8d}{1:8d}", f"{1.0:{width}.{digits}E}"]
    path.write_text(end.join(lines) + end, newline="")


def write_dmig(path: Path, matrices: Mapping[str, Array], names: Sequence[tuple[int, int]]) -> None:
    """Write a punch file with one triangle of symmetric matrices."""
    lines = ["$TITLE   = PUNCH"]
    for name, A in matrices.items():
        lines.append(f"DMIG    {name:8s}{0:8d}{6:8d}{2:8d}{0:8d}{'':16s}{len(A):8d}")
        for j, (node, d) in enumerate(names):
            lines.append(f"DMIG*   {name:16s}{node:16d}{d:16d}")
            for i in range(j + 1):
                if A[i, j]:
                    value = f"{A[i, j]:16.9E}".replace("E", "D")
                    lines.append(f"*       {names[i][0]:16d}{names[i][1]:16d}{value}")
    path.write_text("\n".join(lines) + "\n")


# Abaqus


def write_abaqus(
    job: Path, K: Array, M: Array, names: Sequence[tuple[int, int]], *, step: int = 1
) -> None:
    """Write the format MATRIX INPUT, triangles in the order of the program's labels."""
    for kind, A in (("STIF", K), ("MASS", M)):
        lines = ["** Assembled matrix"]
        for i in range(len(A)):
            for j in range(i + 1):
                if A[i, j]:
                    a, b = names[i], names[j]
                    if a[0] > 0 > b[0]:  # as the program does: its own nodes behind
                        a, b = b, a
                    lines.append(f"{a[0]},{a[1]}, {b[0]},{b[1]}, {A[i, j]:22.15e}")
        (job.parent / f"{job.name}_{kind}{step}.mtx").write_text("\n".join(lines) + "\n")


# Ansys


def write_ansys(
    path: Path,
    K: Array,
    M: Array,
    names: Sequence[tuple[int, int]],
    held: Sequence[int] = (),
    items: Mapping[int, int] | None = None,
) -> None:
    """Write a .full file; ``held`` rows are listed with a diagonal of 1, as the program does.

    ``items`` are words of the header by their number from 1.
    """
    words: list[bytes] = []
    position = 0

    def record(content: bytes, integer: bool) -> int:
        nonlocal position
        start, count = position, len(content) // 4
        flags = 0x80000000 if integer else 0
        words.append(struct.pack("<iI", count, flags) + content + struct.pack("<i", count))
        position += count + 3
        return start

    def ints(values: Sequence[int]) -> bytes:
        return struct.pack(f"<{len(values)}i", *values)

    def matrix(A: Array) -> tuple[int, int]:
        start, terms = position, 0
        for i in range(len(A)):
            columns = [j for j in range(i + 1, len(A)) if A[i, j] and j not in held]
            columns = [] if i in held else columns
            values = [A[i, j] for j in columns] + [1.0 if i in held else A[i, i]]
            record(ints([*(j + 1 for j in columns), i + 1]), True)
            record(struct.pack(f"<{len(values)}d", *values), False)
            terms += len(values)
        return start, terms

    nodes = list(dict.fromkeys(node for node, _ in names))
    header = [0] * 160
    record(ints([4] + [0] * 99), True)
    record(ints(header), True)
    record(ints([1, 2, 3]), True)
    record(ints(nodes), True)
    stiffness, terms_of_stiffness = matrix(K)
    dofs = record(ints([sum(1 for n, _ in names if n == node) for node in nodes]), True)
    record(ints([-d if k in held else d for k, (_, d) in enumerate(names)]), True)
    mass, terms_of_mass = matrix(M)
    values = {1: -4, 2: len(K), 3: len(K) - len(held), 4: 2, 8: 3, 33: len(nodes)}
    values |= {9: terms_of_stiffness, 34: terms_of_mass, 19: stiffness, 27: mass, 36: dofs}
    for item, value in (values | dict(items or {})).items():
        header[item - 1] = value
    content = bytearray(b"".join(words))
    at = 4 * (103 + 2)
    content[at : at + 4 * len(header)] = ints(header)
    path.write_bytes(bytes(content))


# OpenSees


def write_opensees(job: Path, K: Array, M: Array, names: Sequence[tuple[int, int]]) -> None:
    """Write what the snippet of docs/programs.md writes."""
    for letter, A in (("K", K), ("M", M)):
        scipy.sparse.save_npz(f"{job}_{letter}.npz", scipy.sparse.csr_array(A))
    rows = [f"{node},{'xyz'[d - 1]}" for node, d in names]
    Path(f"{job}_dofs.csv").write_text("\n".join(["node,direction", *rows]) + "\n")
