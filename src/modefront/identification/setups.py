r"""Shapes of several setups as one, by the sensors that they share.

Setup k has the sensors :math:`i_k`, and the shape :math:`u_k` of unit norm with the covariance
:math:`C_k`, which has no part along :math:`u_k`: the scale is not measured. The shape
:math:`\varphi` at all sensors minimises

.. math:: \sum_k r_k^T (C_k + u_k u_k^T)^{-1} r_k,\qquad
          r_k = (I - u_k u_k^T)\,\frac{\varphi_{i_k}}{u_k^T\varphi_{i_k}} ,

and its covariance is the inverse of the second derivatives. To second order it is the likelihood of
all setups at once, with frequencies, damping and forces of their own (Au & Zhang, Fast Bayesian
ambient modal identification incorporating multiple setups, J. Eng. Mech. 138 (2012) 800-815,
doi:10.1061/(ASCE)EM.1943-7889.0000385).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.linalg as la

from modefront._typing import Floats, Ints

MOST_STEPS = 50
"""Steps of Gauss and Newton, at most."""

TOLERANCE = 1e-10
"""Change of a shape of unit norm from which on it is found."""


def merged_shape(
    places: Sequence[Ints], shapes: Sequence[Floats], covariances: Sequence[Floats], count: int
) -> tuple[Floats, Floats]:
    """Return the shape of unit norm at all sensors and its covariance; NaN where none measured.

    ``places`` are the numbers of the sensors of each setup, ``count`` is that of all of them. Each
    setup has to share sensors with another one.
    """
    weights = [la.inv(C + np.outer(u, u)) for C, u in zip(covariances, shapes, strict=True)]
    phi = _chained(places, shapes, count)
    known = np.isfinite(phi)
    phi = np.where(known, phi, 0.0)
    for _ in range(MOST_STEPS):
        A = np.outer(phi, phi) / (phi @ phi)
        A[~known, ~known] = 1.0
        A *= sum(float(np.trace(W)) for W in weights)
        b = np.zeros(count)
        for i, u, W in zip(places, shapes, weights, strict=True):
            along = float(u @ phi[i])
            r = phi[i] / along - u
            J = (np.eye(len(i)) - np.outer(phi[i], u) / along) / along
            A[np.ix_(i, i)] += J.T @ W @ J
            b[i] += J.T @ W @ r
        step = la.solve(A, b, assume_a="sym")
        phi = phi - step
        phi /= np.linalg.norm(phi)
        if np.abs(step).max() < TOLERANCE:
            break
    covariance = la.inv(A)
    tangent = np.eye(count) - np.outer(phi, phi)
    covariance = tangent @ covariance @ tangent
    phi[~known] = np.nan
    covariance[~known] = covariance[:, ~known] = np.nan
    return phi, covariance


def _chained(places: Sequence[Ints], shapes: Sequence[Floats], count: int) -> Floats:
    """Return a shape to start from: setups one after another, scaled at sensors known so far."""
    phi = np.full(count, np.nan)
    left = list(range(len(places)))
    while left:
        common = [np.linalg.norm(shapes[k][np.isfinite(phi[places[k]])]) for k in left]
        k = left.pop(int(np.argmax(common)))
        i, u = places[k], shapes[k]
        both = np.isfinite(phi[i])
        power = float(u[both] @ u[both])
        scale = float(phi[i][both] @ u[both]) / power if power else 1.0
        phi[i] = np.where(both, phi[i], scale * u)
    out: Floats = phi / np.sqrt(np.nansum(phi**2))
    return out
