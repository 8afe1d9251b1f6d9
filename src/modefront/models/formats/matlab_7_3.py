"""Contents of files of MATLAB's version 7.3, which are HDF5: for processes that read files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np

from modefront.hdf5 import inner

Headers = dict[str, tuple[list[int], int]]
"""Shape and number of entries of each variable."""


def headers(path: Path) -> tuple[dict[str, np.ndarray[Any, Any]], Headers]:
    """Return no arrays, and the header of each variable of a file."""
    with h5py.File(path, "r") as file:
        out: Headers = {}
        for name in file:
            if name.startswith("#"):
                continue  # where MATLAB keeps the parts of cells
            item = inner(file, name)
            if isinstance(item, h5py.Dataset):
                out[name] = [int(n) for n in item.shape or ()], int(item.size or 0)
            elif "MATLAB_sparse" in item.attrs:
                columns = int(inner(item, "jc").size) - 1
                entries = int(inner(item, "data").size) if "data" in item else 0
                out[name] = [int(item.attrs["MATLAB_sparse"]), columns], entries
        return {}, out


def variable(path: Path, name: str) -> tuple[dict[str, np.ndarray[Any, Any]], list[int]]:
    """Return the arrays of a variable, and the shape of a sparse one.

    A full one is ``values``, of which HDF5 keeps columns as rows. A sparse one has ``columns``,
    and unless it is zero ``rows`` and ``data``.
    """
    with h5py.File(path, "r") as file:
        item = inner(file, name)
        if isinstance(item, h5py.Dataset):
            values = np.asarray(item[()])
            if values.dtype.kind not in "biuf":
                raise ValueError(f"'{name}' is no matrix of real numbers: {values.dtype}")
            return {"values": values.T}, []
        columns = inner(item, "jc")[()]
        shape = [int(item.attrs["MATLAB_sparse"]), int(columns.size) - 1]
        if "data" not in item:  # a matrix of zeros has none
            return {"columns": columns}, shape
        parts = {"columns": columns, "rows": inner(item, "ir")[()], "data": inner(item, "data")[()]}
        return parts, shape
