"""Least squares fits of a measured shape by shapes of a model, and their derivatives.

The equations are derived at the top of `modefront.residuals.subspace`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats


@dataclass(frozen=True)
class Fitted:
    """The fit X c of a shape.

    Attributes
    ----------
    c, dc : (m,) and (m, p) factors and their derivatives
    r, dr : (components,) and (components, p) X c - psi and its derivatives
    """

    c: Floats
    dc: Floats
    r: Floats
    dr: Floats


def fitted(X: Floats, dX: Floats, psi: Floats) -> Fitted:
    """Return the fit of psi (components,) by X (components, m), dX (components, m, p)."""
    inverse = np.linalg.pinv(X)
    c = inverse @ psi
    r = X @ c - psi
    along = np.einsum("smp,m->sp", dX, c)
    dc = -inverse @ (along + inverse.T @ np.einsum("smp,s->mp", dX, r))
    return Fitted(c, dc, r, along + X @ dc)
