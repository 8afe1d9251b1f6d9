r"""Second derivatives of the objectives that are learned from differences of their first ones.

Each objective has :math:`\partial^2 J = H + S`, with H known (Gauss-Newton's) and S the rest. A
step s from one evaluation to another tells of S that

.. math:: S s = y, \qquad y = \partial J(\theta + s) - \partial J(\theta) - H(\theta + s)\, s,

and the symmetric correction of rank one (Conn, Gould & Toint 1991, doi:10.1007/BF01594934)

.. math:: S \leftarrow S + \frac{v v^T}{v^T s}, \qquad v = y - S s

makes it so. S vanishes with the residuals: before it is corrected it is sized by
:math:`s^T y / s^T S s` where that is below 1 (Dennis, Gay & Welsch 1981,
doi:10.1145/355958.355965).
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.solvers.problem import Evaluation

SURE = 1e-6
"""Cosine between v and s from which a correction is made: below it, v is divided by rounding. With
the usual 1e-8 (Nocedal & Wright, *Numerical Optimization*, 2006, equation 6.26), fronts of
three objectives cost the same."""


def learned_from(S: Floats, before: Evaluation, after: Evaluation) -> Floats:
    """Return S (n, p, p) with what the difference of two evaluations tells of it."""
    s = after.theta - before.theta
    y = after.dJ - before.dJ - after.H @ s
    claimed = np.abs(S @ s @ s)
    size = np.minimum(np.abs(y @ s), claimed) / np.where(claimed > 0, claimed, 1.0)
    S = size[:, None, None] * S
    v = y - S @ s
    along = v @ s
    sure = np.abs(along) > SURE * np.linalg.norm(v, axis=1) * np.linalg.norm(s)
    scale = np.where(sure, 1 / np.where(sure, along, 1.0), 0.0)
    return np.asarray(S + scale[:, None, None] * v[:, :, None] * v[:, None, :])
