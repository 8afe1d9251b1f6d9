r"""Laplace's approximation of the posterior with Jeffreys' prior of the variances of the errors.

Its peak is the optimally weighted model (compare Christodoulou & Papadimitriou 2007, Mechanical
Systems and Signal Processing 21, 4-23); docs/uncertainty.md has its covariance. A parameter that is
pressed against a bound is held there, and directions in which no residual changes keep their prior.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats
from modefront.optim.problem import Evaluation, Problem
from modefront.uncertainty.scatter import held_at_bounds, spaces


@dataclass(frozen=True)
class Posterior:
    """A Gaussian approximation around the most probable model.

    Attributes
    ----------
    axes : (p, m) principal axes over the ranges of the parameters, one standard deviation long
    held : (p,) parameters that a bound holds
    free : (p, d) directions that keep their prior, orthonormal over the ranges of the parameters
    """

    axes: Floats
    held: Bools
    free: Floats

    @property
    def covariance(self) -> Floats:
        """Covariance (p, p) of the parameters; 0 for those that are held."""
        return self.axes @ self.axes.T


def laplace(problem: Problem, evaluation: Evaluation, a: Floats) -> Posterior | None:
    """Return the posterior around a minimum of sum a ln J; ``a`` (n,) counts the properties.

    The evaluation has second derivatives. None where the point is no regular minimum: an objective
    vanishes, or the curvature is not positive in all directions that residuals determine.
    """
    J = evaluation.J
    if not (J > 0).all():
        return None
    w = a / J
    span = problem.upper - problem.lower
    held = held_at_bounds(problem, evaluation, w)
    Q, free = spaces(problem, evaluation, w, held)
    B = span[:, None] * Q
    second = np.tensordot(w, evaluation.H, axes=1) - evaluation.dJ.T @ (
        (a / J**2)[:, None] * evaluation.dJ
    )
    half = B.T @ second @ B / 2
    lam, V = np.linalg.eigh(half)
    if lam.size and lam[0] <= 0:
        return None
    return Posterior(B @ V / np.sqrt(lam), held, span[:, None] * free)
