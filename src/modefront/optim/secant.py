r"""Second derivatives of the objectives that are learned from differences of their first ones.

Each objective has :math:`\partial^2 J = H + S`, with H known (Gauss-Newton's) and S the rest. A
step s from one evaluation to another tells of S that

.. math:: S s = y, \qquad y = \partial J(\theta + s) - \partial J(\theta) - H(\theta + s)\, s,

and the least symmetric change (Powell's; Dennis & Schnabel, *Numerical Methods for Unconstrained
Optimization*, 1983, section 9.2), with s and S over the ranges of the parameters,

.. math:: S \leftarrow S + v u^T + u v^T - (v^T s)\, u u^T, \qquad v = y - S s,
    \quad u = \frac{s}{s^T s}

makes it so. Unlike the correction of rank one, v v^T / v^T s, it is never greater than what the
step tells, so that what earlier steps have told is kept: with many parameters, of which steps show
one direction each, the correction of rank one takes two to three times as many.

S vanishes with the residuals: before it is corrected it is sized by :math:`s^T y / s^T S s` where
that is below 1 (Dennis, Gay & Welsch 1981, doi:10.1145/355958.355965). An objective of which H
knows nothing, such as one residual, is none of squares, and its S is not sized.
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation


def learned_from(S: Floats, before: Evaluation, after: Evaluation, span: Floats) -> Floats:
    """Return S (n, p, p) with what the difference of two evaluations tells of it.

    ``span`` (p,) are the ranges of the parameters; S is with respect to the parameters themselves.
    """
    s = after.theta - before.theta
    if not s.any():
        return S
    y = after.dJ - before.dJ - after.H @ s
    claimed = np.abs(S @ s @ s)
    size = np.minimum(np.abs(y @ s), claimed) / np.where(claimed > 0, claimed, 1.0)
    size[~after.H.any(axis=(1, 2))] = 1.0
    S = size[:, None, None] * S
    v, along = y - S @ s, s / span**2
    u = along / (s @ along)
    vu = v[:, :, None] * u
    return np.asarray(S + vu + vu.transpose(0, 2, 1) - (v @ s)[:, None, None] * np.outer(u, u))
