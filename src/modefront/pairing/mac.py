"""The modal assurance criterion."""

from __future__ import annotations

import numpy as np

from modefront._typing import Complexes, Floats


def mac(phi: Floats | Complexes, psi: Floats | Complexes) -> Floats:
    r"""Return the MAC of each column of ``phi`` with each column of ``psi``.

    .. math:: \mathrm{MAC} = |\varphi^H \psi|^2 / (\varphi^H \varphi\; \psi^H \psi)

    Source: Allemang, Sound and Vibration 37 (8), 2003, equation 2.

    Parameters
    ----------
    phi
        Mode shapes (sensors, modes), real or complex, in any scale.
    psi
        Other mode shapes (sensors, other modes).

    Returns
    -------
    Floats
        MAC values (modes, other modes), from 0 to 1; 0 where a shape vanishes at all sensors.

    Examples
    --------
    >>> mac(np.array([[1.0], [1.0j]]), np.array([[1.0, 1.0], [1.0j, -1.0j]])).round(6).tolist()
    [[1.0, 0.0]]
    """
    cross = np.abs(phi.conj().T @ psi) ** 2
    norm = np.outer((np.abs(phi) ** 2).sum(axis=0), (np.abs(psi) ** 2).sum(axis=0))
    out: Floats = np.divide(cross, norm, out=np.zeros(norm.shape), where=norm > 0)
    return out
