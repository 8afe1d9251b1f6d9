r"""Residuals of shapes of close modes: distances from the span of the model's shapes.

Shapes of close modes turn into each other with small errors of model and data, and those of modes
that coincide are any basis of their span. The members of a group under ``subspace`` are one cluster
of measured modes; each measured shape is fitted by all m model modes that are paired with them.
With :math:`\psi` and :math:`X` (components, m) over the units of `modefront.residuals.shape`,

.. math:: r = X c - \psi, \qquad c = (X^T X)^{-1} X^T \psi,

does not depend on the basis of the span; with m = 1 it is the residual of a shape. From
:math:`X^T r = 0` (Golub & Pereyra 1973, doi:10.1137/0710036)

.. math:: c' = -(X^T X)^{-1} (X'^T r + X^T X' c), \qquad r' = X' c + X c',

and what the modes give to the second derivatives of :math:`\|r\|^2` beyond those of Gauss and
Newton, with :math:`\partial \|r\|^2 / \partial X = 2 r c^T` constant, is
:math:`2 r^T (X'_i c'_j + X'_j c'_i)`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.data.modal import ModalData
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs
from modefront.residuals.base import Curvature, Member, Scale, joined, together
from modefront.residuals.shape import MeasuredShape, ShapeKind, ShapeResiduals
from modefront.residuals.span import fitted


@dataclass(frozen=True, eq=False)
class SubspaceStack:
    """Distances from the span of a cluster; see `modefront.residuals.base.Stack`.

    Attributes
    ----------
    cluster : positions of the measured modes
    shapes : their shapes, mode after mode and set after set
    """

    cluster: Ints
    shapes: tuple[MeasuredShape, ...]

    def squares(self, modes: Modes, count: int) -> Floats:
        """Return zeros: no pair of modes alone has a residual."""
        return np.zeros((count, modes.lam.size))

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        """Return the residuals, shape (rows,)."""
        parts = []
        for x in self.shapes:
            X = x.weight[:, None] * modes.phi[np.ix_(x.sensors, pairs.index[self.cluster])]
            parts.append(X @ (np.linalg.pinv(X) @ x.psi) - x.psi)
        return joined(parts)

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        """Return the residuals and their derivatives, shape (rows, p)."""
        r, dr, _ = self.with_curvature(modes, pairs)
        return r, dr

    def with_curvature(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, Curvature]:
        """Return these and what is needed of second derivatives."""
        parts = [self._of_shape(x, modes, pairs) for x in self.shapes]
        r, dr, curvatures = zip(*parts, strict=True)
        return joined(r), joined(dr), together(curvatures)

    def _of_shape(
        self, x: MeasuredShape, modes: Modes, pairs: Pairs
    ) -> tuple[Floats, Floats, Curvature]:
        places = np.ix_(x.sensors, pairs.index[self.cluster])
        dX = x.weight[:, None, None] * modes.dphi[places]
        fit = fitted(x.weight[:, None] * modes.phi[places], dX, x.psi)
        v = np.zeros(modes.phi.shape)
        v[places] = 2 * np.outer(x.weight * fit.r, fit.c)
        own = 2 * np.einsum("s,smi,mj->ij", fit.r, dX, fit.dc)
        return fit.r, fit.dr, Curvature(np.zeros(modes.lam.size), v, own + own.T)


class SubspaceKind:
    """Spans of close shapes; see `modefront.residuals.base.ResidualKind`."""

    name = "subspace"
    plural = "subspaces"
    usable_std = ShapeKind.usable_std

    def measured(self, data: ModalData) -> Bools:
        """Return which modes have a component of their shape in any data set."""
        return ShapeKind().measured(data)

    def has_usable_std(self, data: ModalData, r: int) -> bool:
        """Return whether all components of a mode have standard deviations, not all of them 0."""
        return ShapeKind().has_usable_std(data, r)

    def members(self, data: ModalData, modes: Sequence[int], scale: Scale) -> list[Member]:
        """Return the distances of the shape of each mode from the span of all."""
        return [ShapeResiduals(data, r, scale, tuple(modes)) for r in modes]

    def stack(self, data: ModalData, modes: Sequence[int], scale: Scale) -> SubspaceStack:
        """Return the same members as one."""
        shapes = [x for r in modes for x in ShapeResiduals(data, r, scale).shapes]
        return SubspaceStack(np.array(modes, dtype=np.intp), tuple(shapes))
