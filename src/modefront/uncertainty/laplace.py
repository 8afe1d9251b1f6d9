r"""The posterior of the parameters, with the variance of the errors of each group unknown.

Let the residuals of group i, :math:`a_i` of them, be independent and Gaussian with an unknown
variance :math:`s_i`, and :math:`J_i` the sum of their squares. Then

.. math:: p(D \mid \theta, s) = \prod_i (2 \pi s_i)^{-a_i/2} e^{-J_i(\theta) / (2 s_i)} .

With Jeffreys' prior :math:`p(s_i) \propto 1 / s_i` each variance is integrated out,

.. math:: \int_0^\infty s^{-a/2 - 1} e^{-J / (2 s)} ds = \Gamma(a/2) \, (J/2)^{-a/2},

and with a uniform prior within the bounds

.. math:: -\ln p(\theta \mid D) = \tfrac12 \sum_i a_i \ln J_i(\theta) + \text{const} = \tfrac12 I .

So the optimally weighted model, equation (8), is the most probable one (compare Christodoulou &
Papadimitriou 2007, Mechanical Systems and Signal Processing 21, 4-23), and
Laplace's approximation has the covariance

.. math:: C = \Big(\tfrac12 \nabla^2 I\Big)^{-1}, \qquad
    \nabla^2 I = \sum_i \frac{a_i}{J_i} H_i - \sum_i \frac{a_i}{J_i^2} \partial J_i \partial J_i^T .

A parameter that is pressed against a bound is held there: C is that of the others given it.
Directions in which no residual changes keep their prior; they are named and left out of C. Where a
group can be fitted exactly the posterior cannot be normalised; C is then that of the regular peak.
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
