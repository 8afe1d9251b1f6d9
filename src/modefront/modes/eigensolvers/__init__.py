"""Eigensolvers, one file a member: a new one is named here, and nowhere else."""

from __future__ import annotations

from modefront.modes.eigensolvers.base import AffineMatrices, Eigensolver, EigensolverKind
from modefront.modes.eigensolvers.dense import DENSE_SOLVER
from modefront.modes.eigensolvers.sparse import SPARSE_SOLVER

__all__ = ["EIGENSOLVERS", "AffineMatrices", "Eigensolver", "EigensolverKind", "eigensolver"]

EIGENSOLVERS: tuple[EigensolverKind, ...] = (DENSE_SOLVER, SPARSE_SOLVER)
"""All eigensolvers; the first one that takes the matrices of a model solves its eigenproblems."""


def eigensolver(model: AffineMatrices) -> Eigensolver:
    """Return the eigensolver of a model; raises TypeError where none takes its matrices."""
    for kind in EIGENSOLVERS:
        if kind.takes(model):
            return kind.make(model)
    raise TypeError("stiffness and mass have to be both dense or both sparse")
