"""Decompositions of small matrices, straight from LAPACK, and the MAC.

Of matrices of some ten rows, numpy's functions of the same name take more time to look at their
arguments than to decompose them. Here these are real, and results have the same digits.
"""

import numpy as np
import scipy.linalg

from modefront._typing import Complexes, Floats

_lapack = scipy.linalg.lapack

_ROUNDING = float(np.finfo(float).eps)


def eigh(A: Floats) -> tuple[Floats, Floats]:
    """Return the eigenvalues, ascending, and eigenvectors of a symmetric matrix (n, n).

    Raises LinAlgError where they cannot be computed, as of a matrix that is not finite.
    """
    lam, V, failed = _lapack.dsyevd(A, lower=1)
    if failed:
        raise np.linalg.LinAlgError("eigenvalues did not converge")
    return lam, np.ascontiguousarray(V)


def svd(A: Floats) -> tuple[Floats, Floats, Floats]:
    """Return U (m, m), the singular values, descending, and V^T (n, n) of a matrix (m, n).

    Raises LinAlgError where they cannot be computed, as of a matrix that is not finite.
    """
    U, sigma, Vt, failed = _lapack.dgesdd(A)
    if failed:
        raise np.linalg.LinAlgError("singular values did not converge")
    return np.ascontiguousarray(U), sigma, np.ascontiguousarray(Vt)


def lstsq(A: Floats, b: Floats) -> Floats:
    """Return the shortest x (n,) that makes A x - b least, for a matrix (m, n) and b (m,).

    Singular values that are rounding of the greatest one count as 0. Raises LinAlgError where it
    cannot be computed, as of a matrix that is not finite.
    """
    m, n = A.shape
    if not m:
        return np.zeros(n)
    rounding = _ROUNDING * max(m, n)
    lwork, liwork, _ = _lapack.dgelsd_lwork(m, n, 1, rounding)
    right = np.zeros(max(m, n))
    right[:m] = b
    x, _, _, failed = _lapack.dgelsd(A, right, int(lwork), liwork, rounding)
    if failed:
        raise np.linalg.LinAlgError("singular values did not converge")
    return np.asarray(x[:n])


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
    return np.divide(cross, norm, out=np.zeros(norm.shape), where=norm > 0)
