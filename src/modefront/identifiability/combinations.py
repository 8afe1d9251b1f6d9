r"""Which combinations of parameters the data determine.

The Jacobian of the weighted residuals with respect to relative changes of the parameters,

.. math:: G = \big[\sqrt{w_i}\, \partial r_i / \partial \ln|\theta|\big]_i ,

has singular values :math:`\sigma_k` and right singular vectors :math:`v_k`. A direction v with a
small :math:`\sigma` hardly changes any residual: the data do not determine it. (Where a value is
zero, changes are relative to the range.) What is known of the second derivatives is
:math:`H_i = 2\, \partial r_i^T \partial r_i`; so G also follows from them, up to a rotation of its
rows that changes neither :math:`\sigma` nor v, to half of the digits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.problem import Evaluation, Problem

WEAK = 1e-2
"""Singular value over the greatest one, below which a combination is weakly determined."""

NONE = 1e-7
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
    problem: UpdatingProblem,
    theta: Floats,
    group: int | None = None,
    weights: Floats | None = None,
) -> list[Combination]:
    """Return orthogonal combinations of the parameters at ``theta``, best determined first.

    ``group`` counts from 0; None takes the residuals of all groups together, each times the root
    of its weight (groups,), by default 1. Raises ModelError where the model has no modes there.
    """
    residuals = problem.residuals(theta)
    roots = np.sqrt(np.ones(len(residuals)) if weights is None else weights)
    chosen = range(len(residuals)) if group is None else [group]
    G = np.concatenate([roots[i] * residuals[i].dr for i in chosen])
    return decompose(G * relative_unit(problem, theta))


def combinations_at(
    problem: Problem, at: Evaluation, group: int | None = None, weights: Floats | None = None
) -> list[Combination]:
    """Return the same from an evaluation with derivatives, without another one."""
    w = np.ones(len(at.J)) if weights is None else weights
    H = at.H[group] if group is not None else np.tensordot(w, at.H, axes=1)
    unit = relative_unit(problem, at.theta)
    lam, V = np.linalg.eigh(H / 2 * np.outer(unit, unit))
    return decompose(np.sqrt(np.maximum(lam, 0.0))[:, None] * V.T)


def relative_unit(problem: Problem, theta: Floats) -> Floats:
    """Return what changes of the parameters are relative to, shape (parameters,)."""
    return np.where(theta != 0, np.abs(theta), problem.upper - problem.lower)


def decompose(G: Floats) -> list[Combination]:
    """Return the combinations that a Jacobian (rows, parameters) determines, best first.

    >>> [round(one.share, 3) for one in decompose(np.array([[3.0, 0.0], [0.0, 1.5]]))]
    [1.0, 0.5]
    """
    p = G.shape[1]
    padded = np.vstack([G, np.zeros((max(0, p - len(G)), p))])
    _, sigma, Vt = np.linalg.svd(padded, full_matrices=False)
    top = sigma[0] if sigma[0] > 0 else 1.0
    return [
        Combination(v * np.sign(v[np.argmax(np.abs(v))]), float(s), float(s / top))
        for s, v in zip(sigma, Vt, strict=True)
    ]


LEAST = 1e-3
"""Root of the mean square of residuals that no measurement is taken to be better than."""


def optimal_weights(a: Floats, J: Floats) -> Floats:
    """Return w = a / J, with residuals of 1e-3 at least.

    The weight of an objective that is fitted exactly would have no bound, and what the others
    determine would drown in it.
    """
    return np.asarray(a / np.maximum(J, a * LEAST**2))
