"""Sums of squares with exact second derivatives: slopes at complex parameters give them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.models.parameters import Prior
from modefront.optim.problem import Evaluation, Residual, infeasible
from modefront.work.task import Costs, spend

TINY = 1e-30

Residuals = Sequence[tuple[Floats, Floats]]
"""Residuals (rows,) of each objective, and their derivatives (rows, p)."""


@dataclass(frozen=True)
class Squares:
    """A problem of smooth formulas; it has exact second derivatives if ``exact``."""

    function: Callable[[Floats], Residuals]
    lower: Floats
    upper: Floats
    start: Floats
    objectives: tuple[str, ...]
    exact: bool = True
    model: None = None
    priors: tuple[Prior, ...] = ()

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        assert (theta >= self.lower).all()
        assert (theta <= self.upper).all()
        spend(Costs(eigenproblems=1))
        residuals = [Residual(r, dr) for r, dr in self.function(theta)]
        J, dJ = _sums([(x.r, x.dr) for x in residuals])
        if not np.isfinite(J).all():
            return infeasible(theta, len(self.objectives))
        if not derivatives:
            return Evaluation(theta, J)
        H = np.array([2 * x.dr.T @ x.dr for x in residuals])
        is_exact = self.exact and second
        if is_exact:
            steps = 1j * TINY * np.eye(theta.size)
            H = np.stack([_sums(self.function(theta + s))[1].imag / TINY for s in steps], axis=2)
        return Evaluation(theta, J, dJ, H, is_exact, residuals=residuals)


def _sums(residuals: Residuals) -> tuple[Floats, Floats]:
    return np.array([r @ r for r, _ in residuals]), np.array([2 * r @ dr for r, dr in residuals])


def squares(
    function: Callable[[Floats], Residuals],
    lower: list[float],
    upper: list[float],
    n: int = 1,
    exact: bool = True,
) -> Squares:
    """A problem of n objectives within bounds."""
    lo, hi = np.array(lower), np.array(upper)
    names = tuple(f"J{i + 1}" for i in range(n))
    return Squares(function, lo, hi, lo + 0.4 * (hi - lo), names, exact)
