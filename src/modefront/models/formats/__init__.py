"""Formats of matrix files, one a file: a new one is named here, and nowhere else."""

from __future__ import annotations

from modefront.models.formats.base import MatrixFormat
from modefront.models.formats.matlab import MATLAB
from modefront.models.formats.matrix_market import MATRIX_MARKET
from modefront.models.formats.numpy_npy import NUMPY_NPY
from modefront.models.formats.scipy_npz import SCIPY_NPZ

FORMATS: tuple[MatrixFormat, ...] = (MATRIX_MARKET, SCIPY_NPZ, NUMPY_NPY, MATLAB)
"""All formats."""
