"""Files of every format, and the rows of which one is cut, deleted, doubled, swapped or torn.

Rows are lines of text, words or records of binary files, and elements of arrays. What a reader
makes of a spoilt file is an error, or the same data. Where no file says otherwise, a format names
in `Format.unnoticed` the rows, by a pattern, of which this cannot be asked: rows that nothing
declares can be gone, and values that nothing names can have changed places.
"""

from __future__ import annotations

import io
import re
import struct
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np
import scipy.io
import scipy.sparse
from program_files import (
    dense,
    labels,
    structure,
    write_abaqus,
    write_ansys,
    write_calculix,
    write_dmig,
    write_op4,
    write_op4_text,
    write_opensees,
)

from modefront.data.csv import read_csv
from modefront.data.modal_test import read_test
from modefront.data.uff import read_uff55
from modefront.fem.mesh import read_with_meshio
from modefront.models.files import read_matrix
from modefront.programs import base

Kind = Literal["cut", "delete", "double", "swap", "field"]
KINDS: tuple[Kind, ...] = ("cut", "delete", "double", "swap", "field")

Rows = list[bytes]


@dataclass(frozen=True)
class Change:
    """What is done to rows: ``at`` is a row, or the byte at which the file is cut."""

    kind: Kind
    at: int
    other: int = 0


@dataclass(frozen=True)
class Format:
    """A format: how its files are written, which one is spoilt, and what a reader makes of them.

    Attributes
    ----------
    write : writes right files into a folder
    file : the one that is spoilt
    read : returns what is read in a folder, in a form that can be compared
    split, join : the rows of a file, and the file of rows
    kinds : what is done to rows
    ends : patterns of ends that a file may have
    unnoticed : patterns of rows, by what is done to them, whose change nothing in a file tells;
        ``cut`` names the rows that may be lost at the end
    """

    write: Callable[[Path], object]
    file: str
    read: Callable[[Path], object]
    split: Callable[[bytes], Rows] = lambda content: content.splitlines(keepends=True)
    join: Callable[[Rows], bytes] = b"".join
    kinds: Sequence[Kind] = KINDS
    ends: Sequence[str] = ()
    unnoticed: Mapping[Kind, Sequence[str]] = field(default_factory=dict)


def spoilt(form: Format, content: bytes, change: Change) -> bytes:
    """Return the content of a file after a change; positions beyond the rows begin again."""
    if change.kind == "cut":
        return content[: change.at % len(content)]
    rows = form.split(content)
    i, j = change.at % len(rows), change.other % len(rows)
    if change.kind == "delete":
        del rows[i]
    elif change.kind == "double":
        rows.insert(i, rows[i])
    elif change.kind == "swap":
        rows[i], rows[j] = rows[j], rows[i]
    else:
        rows[i] = re.sub(rb"[ ,]*[^ ,\r\n]+([\r\n]*)$", rb"\1", rows[i])
    return form.join(rows)


def cannot_be_noticed(form: Format, content: bytes, change: Change) -> bool:
    """Return whether nothing in a file could tell that it was changed so."""

    def alike(*rows: bytes) -> bool:
        patterns = form.unnoticed.get(change.kind, ())
        return any(all(re.match(p.encode(), row) for row in rows) for p in patterns)

    if change.kind == "cut":
        at = change.at % len(content)
        if any(re.search(p.encode(), content[:at].rstrip()) for p in form.ends):
            return True
        lost = content[at:].lstrip(b"\r\n")
        at_end = at == 0 or content[at - 1 : at] == b"\n" or content[at : at + 1] in (b"\r", b"\n")
        return at_end and all(alike(row) for row in form.split(lost))
    rows = form.split(content)
    chosen = [rows[change.at % len(rows)]]
    if change.kind == "swap":
        chosen.append(rows[change.other % len(rows)])
    return alike(*chosen)


def plain(value: object) -> object:
    """Return data as tuples, numbers and texts that can be compared."""
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return tuple(plain(each) for each in value)
    return value


def words(size: int) -> Callable[[bytes], Rows]:
    """Return a function that splits a file into words of some bytes."""
    return lambda content: [content[k : k + size] for k in range(0, len(content), size)]


# Tests


def _uff55(shapes: np.ndarray, kind: int) -> list[str]:
    """Return modes (modes, nodes, components) as datasets 55: 2 real, 3 complex."""
    out = []
    for mode, values in enumerate(shapes, start=1):
        size = values.shape[1]
        out += ["    -1", "    55", "set a", *["NONE"] * 4]
        out += [f"{1:10d}{kind:10d}{2:10d}{8:10d}{2 if kind == 2 else 5:10d}{size:10d}"]
        reals = (4.0 * mode, 1.0, 0.01, 0.0) if kind == 2 else (-0.3, 25.0 * mode, 0, 0, 0, 0)
        out += [f"{2:10d}{len(reals):10d}{1:10d}{mode:10d}", _reals(reals)]
        for node, row in enumerate(values, start=3):
            parts = row.real if kind == 2 else np.column_stack([row.real, row.imag]).ravel()
            out += [f"{node:10d}", *(_reals(parts[k : k + 6]) for k in range(0, len(parts), 6))]
        out += ["    -1"]
    return out


def _reals(values: Iterable[float]) -> str:
    return "".join(f"{x:13.5E}" for x in values)


def _geometry(number: int, nodes: int) -> list[str]:
    out = ["    -1", f"{number:6d}"]
    for node in range(3, 3 + nodes):
        head, point = f"{node:10d}{0:10d}{0:10d}{0:10d}", _reals((node, 0.5, 1.0 / node))
        out += [head + point] if number == 15 else [head, point]
    return [*out, "    -1"]


def _elements(nodes: int) -> list[str]:
    out = ["    -1", "  2412"]
    for k in range(3, 1 + nodes):
        out += [f"{k:10d}{91:10d}{1:10d}{1:10d}{7:10d}{3:10d}", f"{k:10d}{k + 1:10d}{k + 2:10d}"]
    return [*out, "    -1"]


def modes_55(kind: int, size: int, nodes: int, geometry: int) -> Callable[[Path], object]:
    """Return what writes three modes with nodes and elements."""
    rng = np.random.default_rng(kind + size + nodes)
    shapes = rng.standard_normal((3, nodes, size)) * (1 + 0.1j * (kind != 2))
    lines = [*_geometry(geometry, nodes), *_elements(nodes), *_uff55(shapes, kind)]
    return lambda folder: (folder / "a.uff").write_text("\n".join(lines) + "\n")


def read_55(folder: Path) -> object:
    modes = read_uff55(folder / "a.uff")
    data, places = modes.data, (modes.shape, modes.nodes, modes.position, modes.axes)
    return plain((data.sets, data.modes, (data.frequency, data.damping, *places)))


def _functions(count: int) -> tuple[np.ndarray, np.ndarray]:
    f = np.arange(1, count + 1) * 0.5
    poles = np.array([-0.3 + 15j, -0.4 + 40j])
    residues = np.random.default_rng(count).standard_normal((3, 2))
    s = 2j * np.pi * f
    return f, np.array(
        [sum(r / (s - p) * s**2 for r, p in zip(row, poles, strict=True)) for row in residues]
    )


def write_58(folder: Path) -> None:
    f, H = _functions(20)
    out = []
    for node, row in enumerate(H, start=1):
        numbers = np.column_stack([row.real, row.imag]).ravel()
        out += ["    -1", "    58", *["NONE"] * 5]
        out += [f"    4         0    0         0 NONE      {node:10d}   3 NONE               3   3"]
        out += [f"         5{len(f):10d}         1{_reals((f[0], f[1] - f[0], 0.0))}"]
        for name in (18, 12, 13, 0):
            out += [f"{name:10d}    0    0    0 NONE                 NONE                "]
        out += [*(_reals(numbers[k : k + 6]) for k in range(0, len(numbers), 6)), "    -1"]
    (folder / "a.uff").write_text("\n".join(out) + "\n")


def read_functions(name: str) -> Callable[[Path], object]:
    def read(folder: Path) -> object:
        (one,) = read_test(folder / name).sets
        data = one.data
        names = data.references, data.responses
        return plain((data.frequency, data.H, names, data.quantity, data.variance))

    return read


def _table(path: Path, header: Sequence[str], columns: np.ndarray) -> None:
    lines = [",".join(f"{x:.9g}" for x in row) for row in columns]
    path.write_text("\n".join([",".join(header), *lines]) + "\n")


def write_frf_csv(folder: Path) -> None:
    f, H = _functions(12)
    header = ["frequency", *(f"{name}_{part}" for name in "abc" for part in ("re", "im"))]
    columns = [f, *(part for row in H for part in (row.real, row.imag))]
    _table(folder / "a.csv", header, np.column_stack(columns))


def write_polar_csv(folder: Path) -> None:
    f, H = _functions(12)
    header = ["frequency", *(f"{name}_{part}" for name in "abc" for part in ("magnitude", "deg"))]
    columns = [f, *(part for row in H for part in (np.abs(row), np.angle(row, deg=True)))]
    _table(folder / "a.csv", header, np.column_stack(columns))


def write_blow(folder: Path) -> None:
    t = np.arange(48) * 0.01
    rng = np.random.default_rng(1)
    force = np.where(t < 0.03, 1.0 + t, 0.0) + 1e-3 * rng.standard_normal(48)
    responses = [np.exp(-5 * t) * np.sin(w * t) + 1e-3 * rng.standard_normal(48) for w in (30, 80)]
    _table(folder / "a.csv", ["time", "force", "a", "b"], np.column_stack([t, force, *responses]))


def write_modal_csv(folder: Path) -> None:
    rng = np.random.default_rng(1)
    rows = [
        f"{name},{mode},{4.0 * mode + rng.random():.9g},0.01,"
        + ",".join(f"{x:.9g}" for x in rng.standard_normal(3))
        for name in "ab"
        for mode in (1, 2, 3)
    ]
    (folder / "a.csv").write_text("\n".join(["set,mode,frequency,damping,x,y,z", *rows]) + "\n")


def read_modal_csv(folder: Path) -> object:
    data = read_csv(folder / "a.csv")
    parts = (data.frequency, data.damping, data.shape, data.shape_std)
    return plain(
        (
            data.sensors,
            {
                (name, mode): [x[k, r] for x in parts]
                for k, name in enumerate(data.sets)
                for r, mode in enumerate(data.modes)
            },
        )
    )


# Matrices


def _matrix() -> np.ndarray:
    K, _ = structure()
    return np.asarray(np.round(K[:5, :5], 6))


def write_mtx(layout: str, symmetry: str) -> Callable[[Path], object]:
    def write(folder: Path) -> None:
        A = _matrix() if layout == "array" else scipy.sparse.coo_array(_matrix())
        scipy.io.mmwrite(folder / "a.mtx", A, symmetry=symmetry, comment="one\n two")

    return write


def read_matrix_of(name: str) -> Callable[[Path], object]:
    return lambda folder: plain(
        read_matrix(folder / name, "K" if "mat" in name else None).toarray()
    )


def write_npz(form: str) -> Callable[[Path], object]:
    def write(folder: Path) -> None:
        A = scipy.sparse.bmat([[_matrix(), None], [None, _matrix()]]).asformat(form)
        scipy.sparse.save_npz(folder / "a.npz", A, compressed=False)

    return write


def split_npz(content: bytes) -> Rows:
    """Return the elements of all arrays, each with the name of its array and its type."""
    if not content.startswith(b"PK"):
        return [b"?"]
    with np.load(io.BytesIO(content)) as file:
        return [
            f"{name} {x.dtype.str} {x.ndim} ".encode() + row.tobytes()
            for name in file.files
            for x in [file[name]]
            for row in np.atleast_1d(x)
        ]


def join_npz(rows: Rows) -> bytes:
    arrays = _gathered(rows)
    out = io.BytesIO()
    np.savez(out, **arrays)
    return out.getvalue()


def _gathered(rows: Rows) -> dict[str, Any]:
    """Return arrays of rows, each array of the rows of its name, in their order."""
    parts: dict[str, list[np.ndarray]] = {}
    for row in rows:
        name, dtype, ndim, values = row.split(b" ", 3)
        one = np.frombuffer(values, dtype.decode())
        parts.setdefault(name.decode(), []).append(one if ndim == b"2" else one[0])
    scalars = ("format",)
    return {
        name: np.array(values[0]) if name in scalars and len(values) == 1 else np.array(values)
        for name, values in parts.items()
    }


def write_npy(folder: Path) -> None:
    np.save(folder / "a.npy", _matrix())


def split_npy(content: bytes) -> Rows:
    """Return the header and the rows of values."""
    return [content[:128], *words(40)(content[128:])]


def write_mat5(sparse: bool, packed: bool) -> Callable[[Path], object]:
    def write(folder: Path) -> None:
        A = scipy.sparse.csc_array(_matrix()) if sparse else _matrix()
        scipy.io.savemat(folder / "a.mat", {"K": A, "z": 2.0}, do_compression=packed)

    return write


def write_mat73(folder: Path) -> None:
    A = scipy.sparse.csc_array(_matrix())
    rows = [("K/data", "<f8", A.data), ("K/ir", "<u8", A.indices), ("K/jc", "<u8", A.indptr)]
    joined = [
        f"{name} {dtype} 1 ".encode() + x.astype(dtype).tobytes()
        for name, dtype, xs in rows
        for x in xs
    ]
    (folder / "a.mat").write_bytes(join_mat73(joined))


def split_mat73(content: bytes) -> Rows:
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            return [
                f"K/{name} {x.dtype.str} 1 ".encode() + each.tobytes()
                for name, x in file["K"].items()
                for each in x[()]
            ]
    except OSError:
        return [b"?"]


def join_mat73(rows: Rows) -> bytes:
    out = io.BytesIO()
    with h5py.File(out, "w", userblock_size=512) as file:
        for name, values in _gathered(rows).items():
            file[name] = values
        file["K"].attrs["MATLAB_sparse"] = np.uint64(5)
    return out.getvalue()


# Programs


def read_job(program: str, given: str) -> Callable[[Path], object]:
    def read(folder: Path) -> object:
        job = base.read_job(program, folder / given, base.JobOptions())
        mesh = None
        if job.mesh is not None:
            cells = {kind: sorted(map(tuple, x.tolist())) for kind, x in job.mesh.cells.items()}
            mesh = (job.mesh.number, job.mesh.coordinates, cells)
        order = np.lexsort((job.dofs.direction, job.dofs.node))
        K, M = (dense(A)[np.ix_(order, order)] for A in (job.stiffness, job.mass))
        of_dofs = [x[order] for x in (job.dofs.node, job.dofs.direction, job.dofs.weight)]
        return plain((K, M, of_dofs, mesh))

    return read


def _job(folder: Path) -> None:
    K, M = structure()
    write_calculix(folder / "c", K, M, labels())
    nodes = "".join(f"{n}, {k}., 0., 1.\n" for k, n in enumerate((12, 3, 7, 40, 5)))
    more = "2, 12, 3,\n7, 5\n*NSET, NSET=all\n12, 3\n*BOUNDARY\n12, 1, 2\n"
    deck = f"** a deck\n*NODE\n{nodes}*ELEMENT, TYPE=C3D4\n1, 12, 3, 7, 40\n{more}"
    (folder / "c.inp").write_text(deck)
    write_abaqus(folder / "b", K, M, labels())
    (folder / "b.inp").write_text(deck)
    write_ansys(folder / "a.full", K, M, labels(), held=[4])
    write_opensees(folder / "o", K, M, labels())
    (folder / "o_nodes.csv").write_text("12,0,0,0\n3,1,0,0\n7,1,1,0\n40,0,1,0\n5,2,0,1.25\n")
    (folder / "o_elements.csv").write_text("1,12,3\n2,12,3,7,40\n3,40,5\n")
    write_dmig(folder / "d.pch", {"KAAX": K, "MAAX": M}, labels())
    grids = "".join(f"GRID,{n},,{k}.,0.,1.\n" for k, n in enumerate((12, 3, 7, 40, 5)))
    deck = (
        f"SPC=1\nBEGIN BULK\n{grids}CTETRA,1,1,12,3,7,40\nCBAR,2,1,12,5\nSPC1,1,123,99\nENDDATA\n"
    )
    (folder / "d.bdf").write_text(deck)


def _op4(form: str, text: bool) -> Callable[[Path], object]:
    writer = write_op4_text if text else write_op4

    def write(folder: Path) -> None:
        K, M = structure()
        writer(folder / "a.op4", {"KAA": K, "MAA": M}, form)

    return write


def records(content: bytes) -> Rows:
    """Return the records of Fortran."""
    out, at = [], 0
    while at + 4 <= len(content):
        size = 8 + struct.unpack("<i", content[at : at + 4])[0]
        out.append(content[at : at + size])
        at += size
    return [*out, content[at:]] if at < len(content) else out


def ansys_records(content: bytes) -> Rows:
    """Return the records of Ansys, whose lengths count words of 4 bytes."""
    out, at = [], 0
    while at + 4 <= len(content):
        size = 12 + 4 * struct.unpack("<i", content[at : at + 4])[0]
        out.append(content[at : at + size])
        at += size
    return [*out, content[at:]] if at < len(content) else out


def write_mesh(form: str, name: str) -> Callable[[Path], object]:
    import meshio

    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 0]], dtype=float)
    cells = [("quad", [[0, 1, 2, 3], [1, 4, 2, 0]]), ("triangle", [[1, 4, 2]])]
    cells = cells[: 1 if form == "gmsh" else 2]  # format 4.1 of one kind of cells
    tags = {"gmsh:physical": [np.full(len(x), k) for k, (_, x) in enumerate(cells, start=1)]}
    tags["gmsh:geometrical"] = tags["gmsh:physical"]
    mesh = meshio.Mesh(corners, cells, cell_data=tags if form == "gmsh22" else {})
    mesh.field_data = {"a": np.array([1, 2]), "b": np.array([2, 2])}

    def write(folder: Path) -> None:
        mesh.write(folder / name, file_format=form, binary=False)

    return write


def read_mesh(name: str) -> Callable[[Path], object]:
    return lambda folder: plain(list(read_with_meshio(folder / name)))


WORDS: tuple[Kind, ...] = ("cut", "delete", "double")
"""Words of a binary file that change places are values that nothing names."""

INTEGERS, NUMBERS = r" *-?\d+( +-?\d+){%d}\s*$", r"( *-?\d\.\d{5}E[+-]\d\d){%d}\s*$"

VALUES_55 = [
    *(INTEGERS % n for n in (0, 3)),  # nodes; record 7
    NUMBERS % 4,  # record 8
    # values, and lines of 2412, which is not read
    f"{INTEGERS % 2}|{INTEGERS % 5}|{NUMBERS % 3}|{NUMBERS % 6}|set a|NONE",
    r" *\d+ +0 +0 +0 .*\.",  # nodes of dataset 15
]
"""Lines of the same layout: which node, mode or element each of them is of, nothing says."""

ANY = ".*"

DECK: Mapping[Kind, Sequence[str]] = {
    "delete": [r"\*[BE]|1, 12, 3|2, 12|12, 1, 2"],
    "field": [r"\d+, \d\., 0\.|12, 1, 2|\*BOUNDARY"],  # a coordinate that is not given is 0
    "swap": [r"\*|\d+(, \d+)*,?\s*$"],
    "cut": [ANY],
}
"""A deck says neither where it ends nor how many lines a keyword has: programs read what comes."""

LINE_OF_CSV = r"[-\d.]"

FORMATS: dict[str, Format] = {
    **{
        f"UFF 55, {kind}, {size} a node, {nodes} nodes, {geometry}": Format(
            *(modes_55(kind, size, nodes, geometry), "a.uff", read_55),
            ends=["-1$"],
            unnoticed={"swap": VALUES_55, "field": ["set a"]},
        )
        for kind, size, nodes, geometry in (
            (2, 3, 4, 2411),
            (2, 6, 3, 15),
            (3, 3, 3, 2411),
            (3, 6, 2, 15),
            (2, 3, 1, 15),
        )
    },
    "UFF 58": Format(
        *(write_58, "a.uff", read_functions("a.uff")),
        ends=["-1$"],
        unnoticed={"swap": [NUMBERS % 6, NUMBERS % 4, r" +\d+    0    0    0 NONE", " +4 +0"]},
    ),
    "functions in CSV": Format(
        *(write_frf_csv, "a.csv", read_functions("a.csv")),
        unnoticed={"delete": [LINE_OF_CSV], "cut": [LINE_OF_CSV]},
    ),
    "functions in CSV, polar": Format(
        *(write_polar_csv, "a.csv", read_functions("a.csv")),
        unnoticed={"delete": [LINE_OF_CSV], "cut": [LINE_OF_CSV]},
    ),
    "blow in CSV": Format(
        *(write_blow, "a.csv", read_functions("a.csv")),
        unnoticed={"delete": ["0,", "0.47,"], "cut": [LINE_OF_CSV]},
    ),
    "modes in CSV": Format(
        *(write_modal_csv, "a.csv", read_modal_csv),
        unnoticed={"delete": ["[ab],"], "cut": ["[ab],"]},
    ),
    **{
        f"Matrix Market, {layout}, {symmetry}": Format(
            *(write_mtx(layout, symmetry), "a.mtx", read_matrix_of("a.mtx")),
            unnoticed={"swap": [r"-?[\d.]+(E[+-]?\d+)?\s*$"] if layout == "array" else []},
        )
        for layout in ("coordinate", "array")
        for symmetry in ("general", "symmetric")
    },
    **{
        f"SciPy, {form}": Format(
            *(write_npz(form), "a.npz", read_matrix_of("a.npz"), split_npz, join_npz, KINDS[:4]),
            unnoticed={
                "swap": [f"{name} " for name in ("data", "indices", "row", "col", "offsets")]
            },
        )
        for form in ("csr", "csc", "coo", "dia", "bsr")
    },
    "NumPy": Format(
        *(write_npy, "a.npy", read_matrix_of("a.npy"), split_npy, b"".join, KINDS[:4]),
    ),
    **{
        f"MATLAB 5, {'sparse' * sparse or 'full'}{', packed' * packed}": Format(
            *(
                write_mat5(sparse, packed),
                "a.mat",
                read_matrix_of("a.mat"),
                words(8),
                b"".join,
                WORDS,
            ),
        )
        for sparse in (False, True)
        for packed in (False, True)
    },
    "MATLAB 7.3": Format(
        *(write_mat73, "a.mat", read_matrix_of("a.mat"), split_mat73, join_mat73, KINDS[:4]),
        unnoticed={"swap": ["K/data", "K/ir"]},
    ),
    **{
        f"OP4, {form}, records": Format(
            *(
                _op4(form, False),
                "a.op4",
                read_job("nastran", "a.op4"),
                records,
                b"".join,
                KINDS[:4],
            ),
            unnoticed={"delete": [r"[\x14\x18\x1c]\x00\x00\x00"]},  # massless degrees of freedom
        )
        for form in ("dense", "sparse", "bigmat")
    },
    "OP4, words": Format(
        *(_op4("sparse", False), "a.op4", read_job("nastran", "a.op4"), words(4), b"".join, WORDS),
    ),
    **{
        f"OP4 as text, {form}": Format(
            *(_op4(form, True), "a.op4", read_job("nastran", "a.op4")),
            unnoticed={"swap": [r" \d\.\d+E[+-]\d\d\s*$"]},  # masses
        )
        for form in ("dense", "sparse", "bigmat")
    },
    "DMIG": Format(
        *(_job, "d.pch", read_job("nastran", "d.pch")),
        unnoticed={
            "delete": [r"\* ", r"DMIG\*", r"\$"],
            "swap": [r"\* |DMIG\*|\$"],
            "cut": [r"\* |DMIG\*"],
        },
    ),
    "bulk data": Format(
        *(_job, "d.bdf", read_job("nastran", "d.pch")),
        unnoticed={
            "delete": ["GRID,|C|SPC"],
            "field": ["SPC|GRID"],  # a coordinate that is not given is 0
            "swap": ["SPC|C|GRID|ENDDATA"],  # other entries are not read, nor what follows the end
        },
    ),
    "CalculiX, stiffness": Format(*(_job, "c.sti", read_job("calculix", "c"))),
    "CalculiX, mass": Format(*(_job, "c.mas", read_job("calculix", "c"))),
    "CalculiX, degrees of freedom": Format(
        *(_job, "c.dof", read_job("calculix", "c")), unnoticed={"swap": [ANY]}
    ),
    "CalculiX, deck": Format(*(_job, "c.inp", read_job("calculix", "c")), unnoticed=DECK),
    "Abaqus": Format(
        *(_job, "b_STIF1.mtx", read_job("abaqus", "b")),
        unnoticed={"delete": [r"\d"], "cut": [r"\d"]},
    ),
    "Abaqus, deck": Format(*(_job, "b.inp", read_job("abaqus", "b")), unnoticed=DECK),
    "Ansys, words": Format(
        *(_job, "a.full", read_job("ansys", "a.full"), words(4), b"".join, WORDS)
    ),
    "Ansys, records": Format(
        *(_job, "a.full", read_job("ansys", "a.full"), ansys_records, b"".join, KINDS[:4]),
        unnoticed={"swap": [r"(?s)..\x00\x00\x00\x00\x00\x00"]},  # values of rows
    ),
    "OpenSees, matrix": Format(
        *(_job, "o_K.npz", read_job("opensees", "o"), split_npz, join_npz, KINDS[:4]),
        unnoticed={"swap": ["data ", "indices "]},
    ),
    "OpenSees, degrees of freedom": Format(
        *(_job, "o_dofs.csv", read_job("opensees", "o")), unnoticed={"swap": [r"\d"]}
    ),
    "OpenSees, nodes": Format(*(_job, "o_nodes.csv", read_job("opensees", "o"))),
    "OpenSees, elements": Format(
        *(_job, "o_elements.csv", read_job("opensees", "o")),
        unnoticed={"delete": [r"\d"], "cut": [r"\d"], "field": [r"\d"]},
    ),
    **{
        f"mesh, {form}": Format(
            *(write_mesh(form, name), name, read_mesh(name)),
            unnoticed={"swap": [r"[-\d. e+]+$"]},
        )
        for form, name in (
            ("gmsh22", "a.msh"),
            ("gmsh", "a.msh"),
            ("vtk42", "a.vtk"),
        )
    },
}
"""Formats by names."""
