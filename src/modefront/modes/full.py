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
import scipy.linalg

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine
from modefront.linalg.pencil import Pencil
from modefront.modes import dense, sparse


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


def dense_modes(
    K: DenseAffine, M: DenseAffine, theta: Floats, count: int, loads: Floats
) -> FullModes:
    """Return the ``count`` lowest modes and the static response to loads (N, loads).

    Raises ModelError where K or M is indefinite, or there are fewer modes with a finite frequency.
    """
    Kt = K.at(theta)
    decomposition = dense.decompose(Kt, M.at(theta), count)
    lam, Phi = decomposition.lam, decomposition.Phi
    if lam.size < count:
        raise ModelError(f"{count} modes asked for, but only {lam.size} have a finite frequency")
    lam = _without_rounding(lam, Phi, np.diag(Kt))
    static = None
    if lam[0] > 0:
        try:
            static = scipy.linalg.cho_solve(scipy.linalg.cho_factor(Kt), loads)
        except np.linalg.LinAlgError:
            raise ModelError("the stiffness matrix is singular to working precision") from None
    return FullModes(lam[:count], Phi[:, :count], static)


def sparse_modes(pencil: Pencil, theta: Floats, count: int, loads: Floats) -> FullModes:
    """Return the same for sparse matrices; raises ModelError as `modefront.modes.sparse.modes`."""
    spectrum = sparse.lowest(pencil, theta, count)
    lam = _without_rounding(spectrum.lam, spectrum.Phi, pencil.K.at(theta).diagonal())
    below = spectrum.factors[0]
    regular = below.sigma == 0 and lam[0] > 0
    static = None
    if regular:  # the factors take one right-hand side at least
        static = below.factor.solve(np.ascontiguousarray(loads)) if loads.size else loads
    return FullModes(lam[:count], spectrum.Phi[:, :count], static)


def _without_rounding(lam: Floats, Phi: Floats, diagonal: Floats) -> Floats:
    """Return the eigenvalues, with those that are nothing but rounding set to zero."""
    out: Floats = np.where(lam < sparse.SINGULAR * (diagonal @ Phi**2), 0.0, lam)
    return out
