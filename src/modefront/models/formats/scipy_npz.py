"""Sparse matrices of SciPy, as `scipy.sparse.save_npz` writes them.

The arrays in the file are looked at first: their types, what they announce, how much they grow
when they are expanded. A format is a set of arrays:

=============  ==================================================
csr, csc, bsr  data, indices, indptr
coo            data, row, col (or both as coords)
dia            data, offsets
=============  ==================================================
"""

from __future__ import annotations

import math
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse

from modefront.errors import InputError
from modefront.models.formats.base import (
    Header,
    MatrixFormat,
    check_compressed,
    check_growth,
    check_header,
    wrong,
)
from modefront.models.formats.numpy_npy import array_header, check_size

PARTS: Mapping[str, tuple[str, ...]] = {
    "csr": ("data", "indices", "indptr"),
    "csc": ("data", "indices", "indptr"),
    "bsr": ("data", "indices", "indptr"),
    "coo": ("data", "row", "col"),
    "dia": ("data", "offsets"),
}

SMALL = 4096
"""Bytes of the arrays that hold the name of the format and the shape, at most."""


def header(path: Path, _: str | None) -> Header:
    """Return the header of a file; see `MatrixFormat`."""
    with _opened(path) as file:
        _, shape, arrays = _announced(path, file)
    return Header(shape, math.prod(arrays["data"]))


def read(path: Path, _: str | None) -> Any:
    """Return the matrix of a file; see `MatrixFormat`."""
    with _opened(path) as file:
        form, shape, arrays = _announced(path, file)
        check_header(path, Header(shape, math.prod(arrays["data"])))
        values = {name: _array(file, name) for name in arrays}
    data = values.pop("data")
    index = {name: part.astype(np.int64) for name, part in values.items()}
    A: Any
    if form == "coo":
        A = scipy.sparse.coo_array((data, (index["row"], index["col"])), shape=shape)
    elif form == "dia":
        A = scipy.sparse.dia_array((data, index["offsets"]), shape=shape)
    else:
        kinds = {"csr": "csr_array", "csc": "csc_array", "bsr": "bsr_array"}
        make = getattr(scipy.sparse, kinds[form])
        lines = shape[form == "csc"] // (data.shape[1] if form == "bsr" else 1)
        check_compressed(data, index["indices"], index["indptr"], lines)
        A = make((data, index["indices"], index["indptr"]), shape=shape)
        A.check_format(full_check=True)  # wrong indices would be followed out of the array
    return A


def _opened(path: Path) -> zipfile.ZipFile:
    file = zipfile.ZipFile(path)
    for each in file.infolist():
        if each.flag_bits & 1 or each.compress_type not in (
            zipfile.ZIP_STORED,
            zipfile.ZIP_DEFLATED,
        ):
            file.close()
            raise wrong(path, "a readable matrix", f"'{each.filename}', packed in another way")
    listed = file.infolist()
    try:
        check_growth(path, sum(x.file_size for x in listed), sum(x.compress_size for x in listed))
    except InputError:
        file.close()
        raise
    return file


def _announced(
    path: Path, file: zipfile.ZipFile
) -> tuple[str, tuple[int, int], dict[str, tuple[int, ...]]]:
    """Return format, shape, and the shapes of the arrays of a file; their types are right."""
    names = [name.removesuffix(".npy") for name in file.namelist()]
    if not {"format", "shape", "data"} <= set(names) or len(set(names)) < len(names):
        raise wrong(path, "a readable matrix", "The file does not contain a sparse matrix")
    form = _array(file, "format", SMALL).item()
    form = form.decode("ascii", "replace") if isinstance(form, bytes) else str(form)
    if form not in PARTS:
        raise wrong(path, f"a readable matrix: {', '.join(PARTS)}", f"the format '{form}'")
    whole = _array(file, "shape", SMALL)
    if whole.dtype.kind not in "iu" or whole.ndim != 1 or whole.size != 2 or (whole < 0).any():
        found = " x ".join(str(n) for n in whole.ravel()[:4].tolist())
        raise wrong(path, "a square matrix", f"the shape {found}")
    if missing := [name for name in PARTS[form] if name not in names]:
        raise wrong(path, f"a readable matrix: '{missing[0]}' of the format {form}", "nothing")
    shapes = {}
    for name in PARTS[form]:
        info = file.getinfo(f"{name}.npy")
        with file.open(info) as stream:
            shapes[name], _, dtype = array_header(stream)
            check_size(shapes[name], dtype, info.file_size - stream.tell())
        if name != "data" and (dtype.kind not in "iu" or len(shapes[name]) != 1):
            raise wrong(path, f"a readable matrix: whole numbers in '{name}'", f"{dtype}")
    if form == "bsr" and (len(shapes["data"]) != 3 or 0 in shapes["data"][1:]):
        found = " x ".join(map(str, shapes["data"]))
        raise wrong(path, "blocks in 'data', counted along its first dimension", found)
    rows, columns = (int(n) for n in whole)
    return form, (rows, columns), shapes


def _array(file: zipfile.ZipFile, name: str, most: int | None = None) -> Any:
    """Return an array of a file; raises ValueError where it has more bytes than ``most``."""
    info = file.getinfo(f"{name}.npy")
    if most is not None and info.file_size > most:
        raise ValueError(f"'{name}' has {info.file_size} bytes")
    with file.open(info) as stream:
        return np.lib.format.read_array(stream, allow_pickle=False)


SCIPY_NPZ = MatrixFormat(".npz", header, read)
