"""Time and memory of reading large matrices: 500,000 degrees of freedom, 40 million entries.

python benchmarks/import_programs.py [--dofs 500000] [--entries 40000000] [FORMAT …]

Each format is written into a temporary folder (some gigabytes) and read in a process of its own;
another one does the whole import: the nominal job, a run with a parameter that scales half of the
model, their difference, and the study with its matrices. K and M have the same pattern, bands of
runs of three, as solid elements give; the number of entries is that of both triangles of one
matrix. Printed are entries, seconds of the processor and of the clock, and the greatest memory.
"""

from __future__ import annotations

import argparse
import multiprocessing
import resource
import shutil
import tempfile
import time
from collections.abc import Callable
from multiprocessing.context import SpawnContext
from pathlib import Path
from typing import BinaryIO

import numpy as np
import numpy.typing as npt
import scipy.sparse

from modefront.programs.base import JobOptions, read_job
from modefront.study.importing import import_model

Array = npt.NDArray[np.float64]


def triangle(n: int, entries: int) -> scipy.sparse.csr_array:
    """Return an upper triangle of which the symmetric matrix has about as many entries."""
    rng = np.random.default_rng(0)
    blocks = max(int(entries / n / 2 / 3), 1)  # blocks of 3 in the row, the diagonal one included
    first = 3 * np.unique(np.concatenate([[0], rng.integers(1, n // 60, 3 * blocks)]))[:blocks]
    offsets = (first[:, None] + np.arange(3)).ravel()
    column = np.arange(n)[:, None] + offsets
    row = np.broadcast_to(np.arange(n)[:, None], column.shape)
    inside = column < n
    values = rng.standard_normal(1009)[np.arange(int(inside.sum())) % 1009]  # written faster so
    indptr = np.append(0, np.cumsum(inside.sum(axis=1)))
    A = scipy.sparse.csr_array((values, column[inside].astype(np.int32), indptr), shape=(n, n))
    diagonal = row[inside] == column[inside]
    A.data[diagonal] = 1e3
    return A


def labels(n: int) -> tuple[list[int], list[int]]:
    """Return node and direction of every row."""
    return (np.arange(n) // 3 + 1).tolist(), (np.arange(n) % 3 + 1).tolist()


def write_calculix(job: Path, A: scipy.sparse.csr_array) -> None:
    entries = A.tocoo()
    _write_text(job.with_suffix(".sti"), [entries.row + 1, entries.col + 1], entries.data, b" ")
    shutil.copy(job.with_suffix(".sti"), job.with_suffix(".mas"))
    nodes, directions = labels(A.shape[0])
    with job.with_suffix(".dof").open("w") as file:
        file.writelines(f"{n}.{d}\n" for n, d in zip(nodes, directions, strict=True))


def write_abaqus(job: Path, A: scipy.sparse.csr_array) -> None:
    entries = A.tocoo()
    nodes, directions = map(np.array, labels(A.shape[0]))
    parts = [x[i] for i in (entries.row, entries.col) for x in (nodes, directions)]
    names = [job.parent / f"{job.name}_{kind}1.mtx" for kind in ("STIF", "MASS")]
    _write_text(names[0], parts, entries.data, b",")
    shutil.copy(*names)


def _write_text(path: Path, columns: list[Array], values: Array, separator: bytes) -> None:
    """Write whole numbers and a value in every line; there are few different values."""
    different, which = np.unique(values, return_inverse=True)
    table = np.array([b"%22.15e\n" % x for x in different], dtype="S23").view("S1")
    texts = table.reshape(-1, 23)
    step = 10**6
    with path.open("wb") as file:
        for k in range(0, len(values), step):
            parts = [_digits(column[k : k + step], separator) for column in columns]
            chosen = texts[which[k : k + step]]
            file.write(np.concatenate([*parts, chosen], axis=1).tobytes())


def _digits(numbers: Array, separator: bytes) -> npt.NDArray[np.bytes_]:
    """Return numbers up to 9,999,999 as text with spaces before and a separator behind them."""
    powers = 10 ** np.arange(6, -1, -1)
    shown = (numbers[:, None] // powers % 10 + ord("0")).astype(np.uint8)
    shown[numbers[:, None] < powers] = ord(" ")
    out = np.concatenate([shown, np.full((len(numbers), 1), separator[0], np.uint8)], axis=1)
    return out.view("S1")


def write_nastran(job: Path, A: scipy.sparse.csr_array) -> None:
    """Write binary OUTPUT4 with BIGMAT, both triangles, strings of three."""
    full = (A + scipy.sparse.triu(A, k=1).T).tocsc()
    full.sort_indices()
    n = full.shape[0]
    with job.with_suffix(".op4").open("wb") as file:
        for name in (b"KAA     ", b"MAA     "):
            _record(file, np.array([n, -n, 6, 2], "<i4").tobytes() + name)
            for j in range(n):
                rows = full.indices[full.indptr[j] : full.indptr[j + 1]]
                values = full.data[full.indptr[j] : full.indptr[j + 1]]
                starts = np.flatnonzero(np.append(True, np.diff(rows) != 1))
                lengths = np.diff(np.append(starts, rows.size))
                words = np.zeros(2 * starts.size + 2 * rows.size, "<i4")
                position = 2 * np.arange(starts.size) + 2 * starts
                words[position], words[position + 1] = 2 * lengths + 1, rows[starts] + 1
                body = np.ones(words.size, bool)
                body[position] = body[position + 1] = False
                words[body] = values.view("<i4")
                head = np.array([j + 1, 0, words.size], "<i4")
                _record(file, head.tobytes() + words.tobytes())
            end = np.array([n + 1, 1, 2], "<i4").tobytes() + np.array([1.0]).tobytes()
            _record(file, end)


def _record(file: BinaryIO, content: bytes) -> None:
    mark = np.array([len(content)], "<i4").tobytes()
    file.write(mark + content + mark)


def write_ansys(job: Path, A: scipy.sparse.csr_array) -> None:
    """Write a .full file: a record of columns and one of values for each row."""
    n = A.shape[0]
    _, directions = labels(n)
    parts: list[np.ndarray] = []
    position = 0

    def record(words: np.ndarray, flags: int) -> int:
        nonlocal position
        start = position
        parts.append(np.array([words.size, flags], "<i4"))
        parts.append(words)
        parts.append(np.array([words.size], "<i4"))
        position += words.size + 3
        return start

    header = np.zeros(160, "<i4")
    integer = -(2**31)
    record(np.array([4] + [0] * 99, "<i4"), integer)
    record(header, integer)
    record(np.array([1, 2, 3], "<i4"), integer)
    record(np.arange(1, -(-n // 3) + 1, dtype="<i4"), integer)
    counts = np.full(-(-n // 3), 3, "<i4")
    counts[-1] = n - 3 * (counts.size - 1)
    header[[0, 1, 2, 8, 33]] = -4, n, n, A.nnz, A.nnz
    for pointer in (18, 26):
        header[pointer] = position
        for i in range(n):
            columns = A.indices[A.indptr[i] : A.indptr[i + 1]].astype("<i4") + 1
            values = A.data[A.indptr[i] : A.indptr[i + 1]].astype("<f8")
            order = np.append(np.arange(1, columns.size), 0)  # the diagonal comes last
            record(columns[order], integer)
            record(values[order].view("<i4"), 0)
    header[35] = position
    record(counts, integer)
    record(np.array(directions, "<i4"), integer)
    with job.with_suffix(".full").open("wb") as file:
        for k in range(0, len(parts), 10**5):
            file.write(np.concatenate(parts[k : k + 10**5]).tobytes())


WRITERS: dict[str, Callable[[Path, scipy.sparse.csr_array], None]] = {
    "calculix": write_calculix,
    "abaqus": write_abaqus,
    "nastran": write_nastran,
    "ansys": write_ansys,
}


def measure(program: str, job: Path, out: multiprocessing.Queue[tuple[float, ...]]) -> None:
    """Read a job and report time and memory."""
    clock, processor = time.perf_counter(), time.process_time()
    result = read_job(program, job, JobOptions())
    times = time.process_time() - processor, time.perf_counter() - clock
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    out.put((result.dofs.size, result.stiffness.nnz, result.mass.nnz, *times, memory))


def measure_import(program: str, job: Path, out: multiprocessing.Queue[tuple[float, ...]]) -> None:
    """Import a job and a run with one parameter, write the study, and report time and memory."""
    clock, processor = time.perf_counter(), time.process_time()
    imported = import_model(program, job, {"E": job.with_name("run")}, modes=0)
    imported.write(job.with_name("study"))
    times = time.process_time() - processor, time.perf_counter() - clock
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    terms = imported.terms
    counts = (A.nnz for A in terms.matrices["stiffness"].values())
    out.put((terms.dofs.size, *counts, *times, memory))


def stiffer(A: scipy.sparse.csr_array) -> scipy.sparse.csr_array:
    """Return a matrix of which half of the rows are twice as great."""
    scale = np.where(np.arange(A.shape[0]) < A.shape[0] // 2, 2.0, 1.0)
    return scipy.sparse.csr_array(
        (A.data * np.repeat(scale, np.diff(A.indptr)), A.indices, A.indptr), shape=A.shape
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--dofs", type=int, default=500_000)
    parser.add_argument("--entries", type=int, default=40_000_000)
    parser.add_argument("formats", nargs="*", default=list(WRITERS))
    given = parser.parse_args()
    A = triangle(given.dofs, given.entries)
    both = 2 * A.nnz - given.dofs
    print(f"{given.dofs} degrees of freedom, {both} entries of K, as many of M", flush=True)
    print(
        "format                DOF  entries of K, and of M or of the term    CPU s  clock s    GiB"
    )
    context = multiprocessing.get_context("spawn")
    for program in given.formats:
        with tempfile.TemporaryDirectory() as folder:
            job = Path(folder) / "job"
            WRITERS[program](job, A)
            _report(program, context, measure, job)
            WRITERS[program](job.with_name("run"), stiffer(A))
            _report(f"{program}, import", context, measure_import, job)


def _report(
    name: str,
    context: SpawnContext,
    target: Callable[[str, Path, multiprocessing.Queue[tuple[float, ...]]], None],
    job: Path,
) -> None:
    """Run a measurement in a process of its own, and print what it reports."""
    queue = context.Queue()
    process = context.Process(target=target, args=(name.split(",")[0], job, queue))
    process.start()
    size, first, second, cpu, clock, memory = queue.get()
    process.join()
    counts = f"{int(first):14d} {int(second):14d}"
    print(f"{name:17s} {int(size):7d} {counts} {cpu:8.1f} {clock:8.1f} {memory:6.2f}", flush=True)


if __name__ == "__main__":
    main()
