r"""Which combinations of parameters the data determine.

The Jacobian of all residuals with respect to relative changes of the parameters,
:math:`G = \partial r / \partial \ln|\theta|`, has singular values :math:`\sigma_i` and right
singular vectors :math:`v_i`. A direction v with a small :math:`\sigma` hardly changes any residual:
the data do not determine it. (Where a nominal value is zero, changes are relative to the range.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.residuals.problem import UpdatingProblem

WEAK = 1e-2
"""Singular value over the greatest one, below which a combination is weakly determined."""

NONE = 1e-8
"""Singular value over the greatest one, below which a combination is not determined at all."""


@dataclass(frozen=True)
class Combination:
    """A combination of parameters and how well residuals determine it.

    Attributes
    ----------
    direction : (parameters,) relative changes of the parameters, of length 1
    sensitivity : change of the residuals for a unit change along it
    share : that over the greatest of all combinations, 0 to 1
    """

    direction: Floats
    sensitivity: float
    share: float


def combinations(
    problem: UpdatingProblem, theta: Floats, group: int | None = None
) -> list[Combination]:
    """Return orthogonal combinations of the parameters at ``theta``, best determined first.

    ``group`` counts from 0; None takes the residuals of all groups together.
    Raises ModelError where the model has no modes at ``theta``.
    """
    residuals = problem.residuals(theta)
    chosen = residuals if group is None else residuals[group : group + 1]
    unit = np.where(theta != 0, np.abs(theta), problem.upper - problem.lower)
    G = np.concatenate([residual.dr for residual in chosen]) * unit
    p = theta.size
    padded = np.vstack([G, np.zeros((max(0, p - len(G)), p))])
    _, sigma, Vt = np.linalg.svd(padded, full_matrices=False)
    top = sigma[0] if sigma[0] > 0 else 1.0
    return [
        Combination(v * np.sign(v[np.argmax(np.abs(v))]), float(s), float(s / top))
        for s, v in zip(sigma, Vt, strict=True)
    ]


def in_words(combination: Combination, names: tuple[str, ...]) -> str:
    """Return a combination as text, its smallest parts left out."""
    v = combination.direction
    order = np.argsort(-np.abs(v), kind="stable")
    parts = [f"{v[i]:+.2f} {names[i]}" for i in order if abs(v[i]) >= 0.1 * abs(v[order[0]])]
    return " ".join(parts)
