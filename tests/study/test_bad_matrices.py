"""Files of matrices that are none, and studies of matrices that contradict them."""

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.sparse
from faultless import CHAIN, K2, MATRICES, STUDY
from refusals import Check, edited, refuses

MTX = "%%MatrixMarket matrix"


def npy(A: object) -> bytes:
    stream = io.BytesIO()
    np.save(stream, np.asarray(A), allow_pickle=True)
    return stream.getvalue()


def npz(**arrays: Any) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def sparse(A: object) -> bytes:
    stream = io.BytesIO()
    scipy.sparse.save_npz(stream, scipy.sparse.csc_array(A))
    return stream.getvalue()


def compressed(indices: list[int], indptr: list[int]) -> bytes:
    """Return a file of a 2 x 2 matrix whose indices need not be right."""
    return npz(format=b"csr", shape=(2, 2), data=np.ones(2), indices=indices, indptr=indptr)


EYE = [[1.0, 0.0], [0.0, 1.0]]
UNREADABLE = "expected a readable matrix"

MATRIX_FILES = [
    # file, content, what is said of it
    ("K0.mtx", b"", "expected a matrix, found an empty file"),
    ("K0.mtx", b"\xff\xfe\x00", UNREADABLE),
    ("K0.mtx", b"1 0\n0 1\n", UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n2 2 3\n1 1 1.0\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n2 2 1\n3 3 1.0\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n2 2 1\n1 1 abc\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n{'9' * 30} 2 1\n1 1 1\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate integer general\n2 2 1\n1 1 {'9' * 30}\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} array real general\n-2 2\n1\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} coordinate real general\n{'9' * 13} {'9' * 13} 0\n".encode(), UNREADABLE),
    ("K0.mtx", f"{MTX} array real general\n0 0\n".encode(), "a square matrix, found 0 x 0"),
    ("K0.mtx", f"{MTX} array real general\n0 2\n".encode(), "a square matrix, found 0 x 2"),
    ("K0.mtx", f"{MTX} array real general\n2 1\n1\n1\n".encode(), "a square matrix, found 2 x 1"),
    (
        "K0.mtx",
        f"{MTX} coordinate complex general\n2 2 1\n1 1 1.0 2.0\n".encode(),
        "real numbers, found complex128",
    ),
    (
        "K0.mtx",
        f"{MTX} coordinate real skew-symmetric\n2 2 1\n2 1 1.0\n".encode(),
        "row 0, column 1 (from 0): expected a symmetric matrix, found -1, and 1 across",
    ),
    (
        "K0.mtx",
        f"{MTX} coordinate real general\n2 2 1\n2 2 nan\n".encode(),
        "row 1, column 1 (from 0): expected finite numbers up to 1e+100, found nan",
    ),
    ("K1.npy", b"", "expected a matrix, found an empty file"),
    ("K1.npy", b"garbage", UNREADABLE),
    ("K1.npy", npy(EYE)[:-5], UNREADABLE),
    ("K1.npy", npy(EYE)[:20], UNREADABLE),
    ("K1.npy", npz(A=EYE), UNREADABLE),
    ("K1.npy", npy([[{}, {}], [{}, {}]]), UNREADABLE + " ... objects, which could run code"),
    ("K1.npy", npy([["1", "0"], ["0", "1"]]), "real numbers, found <U1"),
    ("K1.npy", npy(np.array(EYE) * 1j), "real numbers, found complex128"),
    ("K1.npy", npy(1.0), "a square matrix, found a single number"),
    ("K1.npy", npy([1.0, 2.0]), "a square matrix, found 2"),
    ("K1.npy", npy(np.ones((2, 3))), "a square matrix, found 2 x 3"),
    ("K1.npy", npy(np.ones((2, 2, 2))), "a square matrix, found 2 x 2 x 2"),
    ("K1.npy", npy(np.ones((0, 0))), "a square matrix, found 0 x 0"),
    ("K1.npy", npy([[1, np.inf], [np.inf, 1]]), "column 1 (from 0): expected finite numbers"),
    ("K1.npy", npy([[1, 2], [3, 1]]), "symmetric matrix, found 2, and 3 across the diagonal"),
    ("K1.npy", npy([[1e308, 0], [0, 1]]), "numbers up to 1e+100, found 1e+308"),
    ("K1.npy", npy(np.eye(3)), "k1: expected 2 x 2, as the other matrices, found 3 x 3"),
    ("K2.npz", b"", "expected a matrix, found an empty file"),
    ("K2.npz", b"PK\x03\x04garbage", UNREADABLE),
    ("K2.npz", sparse(EYE)[:-30], UNREADABLE),
    ("K2.npz", sparse(EYE)[:200] + b"damage" + sparse(EYE)[206:], UNREADABLE),
    ("K2.npz", npz(A=EYE, B=EYE), "expected one matrix, or { file = ... to say which, found A, B"),
    ("K2.npz", npz(format=b"xyz", shape=(2, 2), data=[1.0]), UNREADABLE),
    (
        "K2.npz",
        npz(format=np.array([{}]), shape=(2, 2), data=[1.0]),
        UNREADABLE + " ... objects, which could",
    ),
    ("K2.npz", compressed([0, 10**8], [0, 1, 2]), UNREADABLE),
    ("K2.npz", compressed([0, 1], [0, 10**6, 2]), UNREADABLE),
    ("K2.npz", sparse(np.ones((2, 3))), "a square matrix, found 2 x 3"),
    ("K2.npz", sparse([[1.0, 2.0], [0.0, 1.0]]), "symmetric matrix, found 2, and 0 across"),
    ("K2.npz", sparse(np.eye(3)), "k2: expected 2 x 2, as the other matrices, found 3 x 3"),
    ("K2.npz", sparse(np.zeros((2, 2))), "'k2': expected a parameter that the model uses, found"),
    ("K2.npz", sparse(-K2), "[model]: expected modes at the nominal parameters, found ... indefi"),
    ("M.mtx", f"{MTX} coordinate real general\n2 2 0\n".encode(), "mass matrix that is not zero"),
    (
        "M.mtx",
        f"{MTX} coordinate real symmetric\n2 2 2\n1 1 1\n2 2 -1\n".encode(),
        "[model]: expected modes at the nominal parameters, found the mass matrix is indefinite",
    ),
]


@pytest.mark.parametrize(("name", "content", "says"), MATRIX_FILES)
def test_matrices_that_are_none(
    name: str, content: bytes, says: str, folder: Path, refused: Check
) -> None:
    (folder / name).write_bytes(content)
    of_file = "as the other" not in says and "model" not in says and "not zero" not in says
    refused(folder / "matrices.toml", f"{name}: [model] ... {says}" if of_file else says)


BASE, FIRST, MASS = 'base = "K0.mtx"', 'k1 = "K1.npy"', 'mass = { base = "M.mtx" }'
TERMS = "expected a table of files, base = ... and one a parameter, found "

MATRIX_KEYS = [
    (MASS, f"{MASS}\nfloating = 1", "[model] floating: expected true or false, found 1"),
    (
        f"{{ {BASE}, {FIRST},",
        '{ k1 = "K2.npz",',
        "[model]: expected a structure that is held, or floating = true for rigid-body modes, "
        "found a singular stiffness matrix at the nominal parameters",
    ),
    (MASS, "", f"[model] mass: {TERMS}nothing"),
    (MASS, 'mass = "M.mtx"', f"[model] mass: {TERMS}'M.mtx'"),
    (MASS, "mass = [1]", f"[model] mass: {TERMS}[1]"),
    (MASS, "mass = {}", "[model] mass: expected at least one matrix, found none"),
    (MASS, 'maas = { base = "M.mtx" }', "expected a known key, found 'maas' (did you mean 'mass'"),
    (MASS, 'mass = { bas = "M.mtx" }', "[model] mass bas: ... found 'bas' (did you mean 'base'?)"),
    ("stiffness = {", "stifness = {", f"[model] stiffness: {TERMS}nothing"),
    (
        FIRST,
        'k3 = "K1.npy"',
        "[model] stiffness k3: expected 'base' or a parameter (in a study file, the name of a "
        "[[parameter]]), found 'k3'",
    ),
    (FIRST, "k1 = 1", "[model] stiffness k1: expected the name of a file, found 1"),
    (FIRST, "k1 = nan", "[model] stiffness k1: expected the name of a file, found nan"),
    (FIRST, "k1 = true", "[model] stiffness k1: expected the name of a file, found true"),
    (FIRST, "k1 = [[1.0]]", "[model] stiffness k1: expected the name of a file, found [[1.0]]"),
    (FIRST, 'k1 = ""', "[model] stiffness k1: expected the name of a file, found ''"),
    (FIRST, 'k1 = "a\\u0000.npy"', "k1: expected the name of a file, found 'a\\x00.npy'"),
    (FIRST, 'k1 = "K1.bin"', "k1, file: expected a name that ends in .mtx, .npz, .npy, .mat, fo"),
    (
        FIRST,
        'k1 = "all.mat"',
        'k1, file: expected one matrix, or { file = "...", name = "..." } to',
    ),
    (FIRST, 'k1 = "all.mat"', "to say which, found K0, K1"),
    (FIRST, 'k1 = "none.mat"', "to say which, found none"),
    (FIRST, 'k1 = "no.mat"', "no.mat: [model] stiffness k1, file: ... found no such file"),
    (FIRST, 'k1 = "bad.mat"', "bad.mat: [model] stiffness k1, file: expected a readable matrix"),
    (FIRST, 'k1 = { file = "all.mat", name = "k1" }', "a variable in it, found 'k1' (did you mean"),
    (
        FIRST,
        'k1 = { file = "all.mat", name = "text" }',
        "k1, file: expected a readable matrix, found 'text' is no matrix of numbers",
    ),
    (FIRST, 'k1 = { file = "all.mat", name = 1 }', "stiffness k1 name: expected the name of a mat"),
    (
        FIRST,
        'k1 = { name = "K1" }',
        "stiffness k1 file: expected the name of a file, found nothing",
    ),
    (FIRST, 'k1 = { file = "all.mat", nam = "K1" }', "expected a known key, found 'nam' (did you"),
    (
        FIRST,
        'k1 = { file = "K1.npy", name = "K1" }',
        "expected a .mat or .npz file, as only these have",
    ),
    (FIRST, 'k1 = "K.npy"', "K.npy: [model] stiffness k1, file: expected a matrix, found no such"),
    (BASE, 'base = "no.mtx"', "no.mtx: [model] stiffness base, file: ... found no such file"),
    (BASE, 'base = "no.npz"', "no.npz: [model] stiffness base, file: ... found no such file"),
    (BASE, 'base = "folder.mtx"', "folder.mtx: [model] stiffness base, file: ... found a folder"),
    (
        f", {FIRST}",
        "",
        "[[parameter]] 'k1': expected a parameter that the model uses, found no use",
    ),
    (
        "low = 0",
        "low = 2",
        "[model] sensors low: expected degrees of freedom from 0 to 1 ... , found 2",
    ),
    (
        "sensors = {",
        "sensers = {",
        "[model] sensors: expected a table of sensors ... found nothing",
    ),
    ("[model]\n", "[model]\nmasses = [1.0]\n", "[model]: expected a known key, found 'masses'"),
    (
        "x = [0, 1]",
        "x = [0, 2]",
        "[model] base x: expected degrees of freedom from 0 to 1 ... , found 2",
    ),
    (
        "x = [0, 1]",
        "x = [0, 1.5]",
        "[model] base x: expected a degree of freedom from 0, or a list",
    ),
    ("x = [0, 1]", "x = []", "[model] base x: expected a degree of freedom from 0, or a list"),
    (
        "base = { x",
        "bas = { x",
        "[model]: expected a known key, found 'bas' (did you mean 'base'?)",
    ),
    ("base = { x = [0, 1] }", "base = [0, 1]", "base: expected a table, direction = list of the"),
    (
        "x = [0, 1]",
        "y = [0, 1]",
        "base: expected one of the directions of the base, 'y', found 'x'",
    ),
]


test_contradictions_of_a_study_of_matrices = refuses(
    *MATRIX_KEYS, study=edited(STUDY, (CHAIN, MATRICES))
)
