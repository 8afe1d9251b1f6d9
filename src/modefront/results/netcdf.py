"""A netCDF file read in whole, in a process that it may end: what ends well here does so again."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np

from modefront.hdf5 import check_file


def try_file(path: Path) -> tuple[dict[str, np.ndarray[Any, Any]], dict[str, Any]]:
    """Read all variables and attributes, and return nothing of them.

    Raises ForeignError where the file refers to others, ValueError for values that are neither
    numbers nor texts.
    """
    with h5py.File(path, "r") as file:
        check_file(file)
    with h5netcdf.File(path, "r") as data:
        for variable in (data, *data.variables.values()):
            values = [variable.attrs[name] for name in variable.attrs]
            if variable is not data:
                values.append(variable[...])
            for value in values:
                if (kind := np.asarray(value).dtype).kind not in "OUSTbiuf":
                    raise ValueError(f"values of the type {kind}, neither numbers nor texts")
    return {}, {}
