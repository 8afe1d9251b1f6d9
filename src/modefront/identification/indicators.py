r"""Indicator functions, whose peaks and dips over frequency are modes.

*Complex mode indicator functions* are the squared singular values of the functions at every line,
:math:`\sigma_k^2(H(\omega))` over references and responses: as many curves as references, of which
the second one peaks where a mode is repeated (Shih, Tsuei, Allemang & Brown, Complex mode
indication function and its applications to spatial domain parameter estimation, Mech. Syst. Signal
Process. 2 (1988) 367-377, doi:10.1016/0888-3270(88)90060-X).

*Multivariate mode indicator functions* are the eigenvalues of

.. math:: A F = \mu\,(A + B) F,\qquad A = R^T R,\quad B = I^T I,

R and I the real and the imaginary part of the functions, for mobilities exchanged: the least
:math:`\mu` dips from 1 towards 0 where some forces F make the structure vibrate in quadrature, as
at a mode (Williams, Crowley & Vold, The multivariate mode indicator function in modal analysis,
IMAC III (1985) 66-70).
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
