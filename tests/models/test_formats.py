"""Files of matrices: what is right is read, and nothing is believed that a file announces."""

from __future__ import annotations

import io
import os
import struct
import zlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import scipy.io
import scipy.sparse

import modefront as mf
from modefront.models.files import read_matrix
from modefront.work.isolated import isolated

K = np.array([[4.0, -1.0, 0.0], [-1.0, 3.0, 0.5], [0.0, 0.5, 2.0]])
SPARSE = scipy.sparse.csc_array(K)
BANNER = b"%%MatrixMarket matrix "


def saved(write: Callable[..., Any], *arguments: Any, **options: Any) -> bytes:
    stream = io.BytesIO()
    write(stream, *arguments, **options)
    return stream.getvalue()


@pytest.mark.parametrize("dtype", ["f2", ">f4", ">f8", "f8", "longdouble", "i1", ">i4", "u8", "?"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_of_any_type(dtype: str, order: Any, tmp_path: Path) -> None:
    A = np.asarray(K * 2, dtype=dtype, order=order)
    A[A.astype(float) > 1e9] = 0  # negative numbers without a sign
    A = np.asarray(A + A.T if dtype != "?" else A, dtype=dtype, order=order)
    (tmp_path / "A.npy").write_bytes(saved(np.save, A))
    read = read_matrix(tmp_path / "A.npy")
    assert read.dtype == float
    np.testing.assert_array_equal(read.toarray(), A.astype(float))


@pytest.mark.parametrize("form", ["csr", "csc", "bsr", "coo", "dia"])
@pytest.mark.parametrize("compressed", [True, False])
def test_all_sparse_formats(form: str, compressed: bool, tmp_path: Path) -> None:
    content = saved(scipy.sparse.save_npz, SPARSE.asformat(form), compressed=compressed)
    (tmp_path / "A.npz").write_bytes(content)
    np.testing.assert_array_equal(read_matrix(tmp_path / "A.npz").toarray(), K)


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_arrays_of_numpy_in_one_file(save: Callable[..., None], tmp_path: Path) -> None:
    path = tmp_path / "A.npz"
    save(path, K)
    np.testing.assert_array_equal(read_matrix(path).toarray(), K)
    save(path, K=K, M=2 * K, names=np.array(["a"], object))
    with pytest.raises(mf.InputError, match="objects, which could run code, are not read"):
        read_matrix(path)
    save(path, K=K, M=2 * K)
    np.testing.assert_array_equal(read_matrix(path, "M").toarray(), 2 * K)
    with pytest.raises(mf.InputError, match=r"expected one matrix.* found K, M"):
        read_matrix(path)


@pytest.mark.parametrize("compressed", [True, False])
@pytest.mark.parametrize("make", [np.asarray, scipy.sparse.csc_array, scipy.sparse.csc_matrix])
def test_variables_of_matlab(make: Callable[..., Any], compressed: bool, tmp_path: Path) -> None:
    path = tmp_path / "A.mat"
    others = {"text": "K", "cell": np.array([1, "a"], object), "record": {"a": K}, "row": K[:1]}
    scipy.io.savemat(path, {**others, "K": make(K), "z": 1j * K}, do_compression=compressed)
    np.testing.assert_array_equal(read_matrix(path, "K").toarray(), K)
    for name, says in (
        ("z", "real numbers, found complex128"),
        ("row", "square matrix, found 1 x 3"),
        ("text", "'text' is no matrix of numbers"),
        ("record", "'record' is no matrix of numbers"),
    ):
        with pytest.raises(mf.InputError, match=says):
            read_matrix(path, name)


@pytest.mark.parametrize("dtype", ["f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"])
def test_types_of_matlab(dtype: str, tmp_path: Path) -> None:
    A = np.array([[7, 1], [1, 3]]).astype(dtype)
    scipy.io.savemat(tmp_path / "A.mat", {"A": A}, do_compression=True)
    np.testing.assert_array_equal(read_matrix(tmp_path / "A.mat").toarray(), A.astype(float))


def test_big_endian_matlab(tmp_path: Path) -> None:
    def element(kind: int, values: bytes) -> bytes:
        return struct.pack(">II", kind, len(values)) + values + b"\0" * (-len(values) % 8)

    content = element(6, struct.pack(">II", 6, 0)) + element(5, struct.pack(">ii", 2, 2))
    content += element(1, b"A") + element(9, np.array([2, 1, 1, 3], ">f8").tobytes())
    head = b"MATLAB".ljust(124) + b"\x01\x00MI"
    (tmp_path / "A.mat").write_bytes(head + element(14, content))
    np.testing.assert_array_equal(read_matrix(tmp_path / "A.mat").toarray(), [[2, 1], [1, 3]])


def write_hdf5(path: Path, A: Any) -> None:
    """Write a matrix as MATLAB's version 7.3 does."""
    with h5py.File(path, "w", userblock_size=512) as file:
        if scipy.sparse.issparse(A):
            group = file.create_group("K")
            group.attrs["MATLAB_sparse"] = np.uint64(A.shape[0])
            for key, values in (("data", A.data), ("ir", A.indices), ("jc", A.indptr)):
                group[key] = values if key == "data" else values.astype("u8")
        else:
            file["K"] = A.T


@pytest.mark.parametrize("A", [K, SPARSE], ids=["full", "sparse"])
def test_version_7_3(A: Any, tmp_path: Path) -> None:
    write_hdf5(tmp_path / "A.mat", A)
    np.testing.assert_array_equal(read_matrix(tmp_path / "A.mat").toarray(), K)


def refer(path: Path, how: str) -> None:
    """Write a file whose matrix lies in another one."""
    other = path.with_name("other.h5")
    with h5py.File(other, "w") as file:
        file["K"] = K
    other.with_suffix(".raw").write_bytes(K.tobytes())
    with h5py.File(path, "w") as file:
        if how == "external link":
            file["K"] = h5py.ExternalLink("other.h5", "K")
        elif how == "soft link":
            file["here"] = K
            file["K"] = h5py.SoftLink("/here")
        elif how == "external storage":
            raw = [("other.raw", 0, K.nbytes)]
            file.create_dataset("K", K.shape, K.dtype, external=raw)
        else:
            layout = h5py.VirtualLayout(K.shape, K.dtype)
            layout[:] = h5py.VirtualSource("other.h5", "K", K.shape)
            file.create_virtual_dataset("K", layout)


@pytest.mark.parametrize(
    ("how", "says"),
    [
        ("external link", "'K' is a link to another file, 'other.h5'"),
        ("soft link", "'K' is a link to another place"),
        ("external storage", "the data of 'K' is kept in another file"),
        ("virtual dataset", "'K' is a virtual dataset"),
    ],
)
def test_nothing_beyond_the_file_is_read(how: str, says: str, tmp_path: Path) -> None:
    refer(tmp_path / "A.mat", how)
    with pytest.raises(mf.InputError, match=says):
        read_matrix(tmp_path / "A.mat", "K")


def npz(**arrays: Any) -> bytes:
    return saved(np.savez_compressed, **arrays)


def bomb() -> bytes:
    """Return a full matrix of MATLAB in which a few bytes stand for many."""
    size = 8 * 12_000**2
    head = struct.pack("<IIII", 6, 8, 6, 0) + struct.pack("<IIii", 5, 8, 12_000, 12_000)
    head += struct.pack("<II", 1 << 16 | 1, ord("A")) + struct.pack("<II", 9, size)
    packer = zlib.compressobj(1)
    parts = [packer.compress(struct.pack("<II", 14, len(head) + size) + head)]
    parts += [packer.compress(bytes(size // 100)) for _ in range(100)]
    packed = b"".join([*parts, packer.flush()])
    return b"MATLAB".ljust(124) + b"\0\x01IM" + struct.pack("<II", 15, len(packed)) + packed


@cache
def hostile() -> dict[str, tuple[str, bytes]]:
    """Return files that announce more than they hold, or hold what ends a reader."""
    mtx = BANNER + b"coordinate real general\n3 3 1\n1 1 1.0\n"
    ones, zero = np.ones(1), np.zeros(1, int)
    return {
        "a star at the end": ("A.mtx", mtx[:-1] + b"*"),
        "a control character at the end": ("A.mtx", mtx[:-1] + b"\x1a"),
        "too many entries": ("A.mtx", BANNER + b"coordinate real general\n3 3 2000000000\n1 1 1\n"),
        "too many in an array": ("A.mtx", BANNER + b"array real general\n30000 30000\n1\n"),
        "escapes in the header": ("A.mtx", BANNER + b"\x1b]0;title\x07 real general\n3 3 1\n"),
        "a header without an end": ("A.mtx", BANNER + b"array real general\n" + b"%\n" * 200_000),
        "a torn array": ("A.npy", saved(np.save, K)[:-1]),
        "a great shape in coo": (
            "A.npz",
            npz(format=b"coo", shape=[2 * 10**9] * 2, data=ones, row=zero, col=zero),
        ),
        "a great shape in csr": (
            "A.npz",
            npz(format=b"csr", shape=[2 * 10**9] * 2, data=ones, indices=zero, indptr=[0, 1]),
        ),
        "a negative shape": (
            "A.npz",
            npz(format=b"coo", shape=[-3, -3], data=ones, row=zero, col=zero),
        ),
        "rows beyond the shape": (
            "A.npz",
            npz(format=b"coo", shape=[3, 3], data=ones, row=zero + 3, col=zero),
        ),
        "rows before the shape": (
            "A.npz",
            npz(format=b"coo", shape=[3, 3], data=ones, row=zero - 1, col=zero),
        ),
    }


def refused(path: Path, content: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("modefront.work.isolated.available_memory", lambda: 10**9)
    path.write_bytes(content)
    with pytest.raises(mf.InputError) as error:
        read_matrix(path)
    assert str(error.value).isprintable()


@pytest.mark.parametrize("kind", hostile())
def test_hostile_files(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name, content = hostile()[kind]
    refused(tmp_path / name, content, monkeypatch)


@pytest.mark.slow(3)
def test_variables_that_grow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    refused(tmp_path / "A.mat", bomb(), monkeypatch)
    data = np.zeros((12_000, 12_000))
    content = npz(format=b"dia", shape=data.shape, data=data, offsets=range(12_000))
    refused(tmp_path / "A.npz", content, monkeypatch)


SHAPE = b"{'descr':'<f8','fortran_order':False,'shape':(10**9,10**9)}"


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("A.npy", b"\x93NUMPY\x01\x00\x40\x00" + SHAPE.ljust(64), "no array of NumPy"),
        ("A.npy", b"\x93NUMPY\x01\x00\x60\xea" + 60_000 * b"(", "no array of NumPy"),
        ("A.npy", b"\x93NUM", "no array of NumPy"),
        (
            "A.npz",
            npz(format=b"coo", shape=[2.5, 2], data=[1.0], row=[0], col=[0]),
            "a readable matrix",
        ),
        (
            "A.npz",
            npz(format=b"bsr", shape=[2, 2], data=np.ones((1, 0, 2)), indices=[0], indptr=[0, 1]),
            "a readable matrix",
        ),
    ],
)
def test_headers_are_told_from_what_they_should_be_in_words(
    name: str, content: bytes, says: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(mf.InputError, match=says):
        read_matrix(tmp_path / name)


@pytest.mark.parametrize("name", ["A.mtx", "A.npy", "A.npz", "A.mat"])
@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "nothing"])
def test_what_is_no_regular_file(name: str, kind: str, tmp_path: Path) -> None:
    path = tmp_path / name
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path.symlink_to("/dev/zero")
    elif kind == "folder":
        path.mkdir()
    with pytest.raises(mf.InputError, match=f"expected a matrix, found (a {kind}|no such file)"):
        read_matrix(path)


def test_a_matrix_that_does_not_fit_into_the_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "A.npy"
    with path.open("wb") as stream:
        np.lib.format.write_array_header_1_0(
            stream, {"descr": "<f8", "fortran_order": False, "shape": (30_000, 30_000)}
        )
        stream.truncate(stream.tell() + 8 * 30_000**2)  # a file with holes, of 7 GB
    monkeypatch.setattr("modefront.work.isolated.available_memory", lambda: 2 * 10**9)
    with pytest.raises(mf.InputError, match="more than 2 GB to be read"):
        read_matrix(path)


def test_what_readers_take_before_a_file_is_not_of_its_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head = "%%MatrixMarket matrix array real symmetric\n%\n2 2\n5E3\n-2E3\n"
    (tmp_path / "A.mtx").write_text(head + "2E3\n")
    monkeypatch.setattr("modefront.work.isolated.available_memory", lambda: 2 * 10**8)
    assert read_matrix(tmp_path / "A.mtx").shape == (2, 2)


def test_a_reader_that_crashes_takes_no_process_with_it(tmp_path: Path) -> None:
    head = "%%MatrixMarket matrix array real symmetric\n%\n2 2\n5E3\n-2E3\n"
    (tmp_path / "A.mtx").write_text(head + "2E31e999")  # SciPy's reader reads beyond the end
    with pytest.raises(mf.InputError, match="expected a matrix, found a file that"):
        isolated("scipy.io:mmread", tmp_path / "A.mtx", "a matrix", 60, 10**9)
    with pytest.raises(mf.InputError, match="expected whole lines to the end"):
        read_matrix(tmp_path / "A.mtx")


def test_entries_that_are_listed_again_are_refused(tmp_path: Path) -> None:
    head = "%%MatrixMarket matrix coordinate real general\n2 2 3\n"
    (tmp_path / "A.mtx").write_text(head + "1 1 2.0\n2 2 1.0\n1 1 2.0\n")
    with pytest.raises(mf.InputError, match=r"row 1, column 1: .* each entry once, found it again"):
        read_matrix(tmp_path / "A.mtx")


@pytest.mark.parametrize("pointer", [[0, 1, 2, 0], [0, 2, 1, 3], [1, 1, 2, 3], [0, 1, 3]])
def test_pointers_that_lead_out_of_the_arrays_are_refused(
    tmp_path: Path, pointer: list[int]
) -> None:
    arrays = {"indices": np.arange(3), "indptr": np.array(pointer), "data": np.ones(3)}
    name, shape = np.array(b"csr"), np.array([3, 3])
    np.savez(tmp_path / "A.npz", format=name, shape=shape, allow_pickle=False, **arrays)
    with pytest.raises(mf.InputError, match="a readable matrix"):
        read_matrix(tmp_path / "A.npz")
