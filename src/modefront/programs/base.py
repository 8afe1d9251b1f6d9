"""Finite-element programs, their options, and the jobs that are read of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

import scipy.sparse

from modefront.inputs import wrong
from modefront.isolated import IsolatedError, isolated
from modefront.models.dofs import DofTable
from modefront.programs.mesh import ProgramMesh, mesh_from

Matrix: TypeAlias = scipy.sparse.csr_array

Quantity = Literal["stiffness", "mass"]


@dataclass(frozen=True, eq=False)
class Job:
    """Matrices of one job of a program.

    Attributes
    ----------
    name : file or files, for messages
    stiffness, mass : upper triangles (N, N), rows compressed
    dofs : node and direction of each degree of freedom
    precision : relative error of the numbers as they are written
    mesh : nodes and elements where the deck is at hand; None where it is not
    notes : what the program did to the model, and what was done about it
    """

    name: str
    stiffness: Matrix
    mass: Matrix
    dofs: DofTable
    precision: float
    mesh: ProgramMesh | None = None
    notes: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return self.dofs.size

    @property
    def matrices(self) -> Mapping[Quantity, Matrix]:
        """Both matrices by their names."""
        return {"stiffness": self.stiffness, "mass": self.mass}

    @property
    def labelled(self) -> bool:
        """Whether the program's files tell nodes and directions; else there are only numbers."""
        return bool((self.dofs.node > 0).any())


@dataclass(frozen=True)
class JobOptions:
    """Options of the command line for all jobs.

    Attributes
    ----------
    stiffness, mass : names of the matrices in files that hold several; None for the usual ones
    dofs : a table of degrees of freedom, for files that do not tell nodes; None where they do
    deck : the input file, for coordinates and elements; None for one beside the matrices
    """

    stiffness: str | None = None
    mass: str | None = None
    dofs: Path | None = None
    deck: Path | None = None


@dataclass(frozen=True)
class Program:
    """A finite-element program.

    Attributes
    ----------
    name : as the command line names it
    module : has the function ``read`` that takes a path and options, and returns `Listed`
    eliminates : whether degrees of freedom of negative nodes are to be eliminated where that is
        exact; they are kept otherwise
    """

    name: str
    module: str
    eliminates: bool = False

    def job(self, path: Path, options: JobOptions) -> Job:
        """Return a job; raises InputError where its files cannot be read, whatever the cause."""
        texts = (options.stiffness, options.mass, options.dofs, options.deck)
        arguments = (self.module, *(str(text or "") for text in texts))
        reader = "modefront.programs.reading:read_job"
        try:
            arrays, (name, precision, notes) = isolated(reader, path, arguments=arguments)
        except IsolatedError as error:
            raise wrong(path, f"a job of {self.name}", str(error)) from None
        dofs = DofTable(*(arrays.pop(part) for part in ("node", "direction", "weight")))
        K, M = (
            Matrix(tuple(arrays.pop(f"{A}{k}") for k in range(3)), shape=(dofs.size, dofs.size))
            for A in "KM"
        )
        mesh = mesh_from(arrays) if arrays else None
        return Job(name, K, M, dofs, precision, mesh, tuple(notes))


def whole(triangle: Matrix) -> Matrix:
    """Return the symmetric matrix of an upper triangle."""
    strict = scipy.sparse.triu(triangle, k=1, format="csr")
    return Matrix(triangle + strict.T)
