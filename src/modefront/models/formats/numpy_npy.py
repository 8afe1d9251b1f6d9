"""Arrays of NumPy; objects in them are refused, so that nothing is unpickled."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from modefront.models.formats.base import MatrixFormat


def read(path: Path, _: str | None) -> Any:
    """Return the array of a file; see `MatrixFormat`."""
    with path.open("rb") as stream:
        return np.lib.format.read_array(stream, allow_pickle=False)


NUMPY_NPY = MatrixFormat(".npy", read)
