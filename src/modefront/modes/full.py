r"""Modes at all degrees of freedom, and the static response beside them, without derivatives.

What the lowest modes leave out of a response is small but for its static part, and

.. math:: K u_s = f

has all of it, that of massless degrees of freedom too. Where K is singular (rigid-body modes)
there is none. An eigenvalue below the rounding that

.. math:: \varphi^T \operatorname{diag}(K)\, \varphi

leaves in it is that of a rigid-body mode, and is zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.modes import sparse


@dataclass(frozen=True)
class FullModes:
    """The lowest modes of a model at one theta, and its static response.

    Attributes
    ----------
    lam : (modes,) eigenvalues omega**2 in (rad/s)**2, ascending; 0 for rigid-body modes
    Phi : (N, modes) mass-normalised modes; the sign is arbitrary
    static : (N, loads) displacement under each load; None with rigid-body modes
    """

    lam: Floats
    Phi: Floats
    static: Floats | None


def without_rounding(lam: Floats, Phi: Floats, diagonal: Floats) -> Floats:
    """Return the eigenvalues, with those that are nothing but rounding set to zero."""
    out: Floats = np.where(lam < sparse.SINGULAR * (diagonal @ Phi**2), 0.0, lam)
    return out
