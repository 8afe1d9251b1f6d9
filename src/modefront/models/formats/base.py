"""What a format of matrix files is, and what every format refuses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modefront.errors import Fault, InputError

MOST = 2**31 - 1
"""Degrees of freedom, as many as indices of 32 bits can count."""


@dataclass(frozen=True)
class MatrixFormat:
    """A format of files that hold matrices.

    Attributes
    ----------
    suffix : ending of the names of its files
    read : returns the matrix, an array or a sparse one, of a path and the name of a matrix in the
        file, None for the only one; it may raise anything for a damaged file
    has_names : whether a file holds several matrices with names
    """

    suffix: str
    read: Callable[[Path, str | None], Any]
    has_names: bool = False


def wrong(path: Path, expected: str, found: str, place: str = "file") -> InputError:
    """Return the error of a file, or of a place in it."""
    return InputError(Fault(str(path), place, expected, found))


def check_square(path: Path, shape: tuple[int, ...]) -> None:
    """Raise InputError where a shape is not square, or too large to be solved."""
    if len(shape) != 2 or shape[0] != shape[1] or shape[0] == 0:
        raise wrong(path, "a square matrix", " x ".join(map(str, shape)) or "a single number")
    if shape[0] > MOST:
        raise wrong(path, "a readable matrix", f"{shape[0]} rows, more than {MOST}")
