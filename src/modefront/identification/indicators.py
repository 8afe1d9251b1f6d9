"""Indicator functions, whose peaks and dips over frequency are modes.

They are the complex and the multivariate ones of docs/methods/deviations.md.
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.data.responses import FrequencyResponses

LEAST = 1e-12
"""Share of the mean motion by which none at all is told apart."""


def complex_indicators(data: FrequencyResponses) -> Floats:
    """Return the complex mode indicator functions, (references, lines), the greatest first."""
    H = np.where(data.measured, data.H, 0).transpose(2, 0, 1)
    out: Floats = np.linalg.svd(H, compute_uv=False).T ** 2
    return out


def multivariate_indicators(data: FrequencyResponses) -> Floats:
    """Return the multivariate mode indicator functions, (references, lines), the least first."""
    H = np.where(data.measured, data.H, 0).transpose(2, 1, 0)
    inphase, quadrature = (H.imag, H.real) if data.quantity == "mobility" else (H.real, H.imag)
    A = inphase.swapaxes(1, 2) @ inphase
    B = quadrature.swapaxes(1, 2) @ quadrature
    total = A + B
    size = np.trace(total, axis1=1, axis2=2)[:, None, None] / total.shape[1]
    total = total + (LEAST * np.maximum(size, np.finfo(float).tiny)) * np.eye(total.shape[1])
    root = np.linalg.inv(np.linalg.cholesky(total))
    out: Floats = np.linalg.eigvalsh(root @ A @ root.swapaxes(1, 2)).T
    return np.clip(out, 0, 1)
