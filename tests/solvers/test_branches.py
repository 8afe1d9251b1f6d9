"""Objectives that jump where other modes are paired: each smooth piece is searched on its own."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from modefront._typing import Floats
from modefront.solvers.explore import Descent, Search, explore
from modefront.solvers.problem import Evaluation, ObjectiveDerivatives
from modefront.solvers.scalarisation import weighted

BAND = (0.3, 0.7)
"""Where another mode is paired."""


@dataclass(frozen=True)
class Switching:
    """(x - 0.8)**2 on piece 0; 0.05 + 2 (x - 0.4)**2 on piece 1, which is paired in the band.

    From x = 0.2 the way down ends in the band, at 0.05; the minimum, 0, lies behind it.
    """

    piece: int | None = None
    lower: Floats = field(default_factory=lambda: np.zeros(1))
    upper: Floats = field(default_factory=lambda: np.ones(1))
    start: Floats = field(default_factory=lambda: np.array([0.2]))
    objectives: tuple[str, ...] = ("J",)
    follows: bool = True

    def evaluate(self, theta: Floats, *, derivatives: bool = True) -> Evaluation:
        del derivatives
        x = float(theta[0])
        piece = int(BAND[0] < x < BAND[1]) if self.piece is None else self.piece
        c, centre, floor = ((1.0, 0.8, 0.0), (2.0, 0.4, 0.05))[piece]
        J, dJ = c * (x - centre) ** 2 + floor, 2 * c * (x - centre)
        H = np.full((1, 1, 1), 2 * c)
        return Evaluation(
            theta, np.array([J]), ObjectiveDerivatives(np.array([[dJ]]), H), branch=(piece,)
        )

    def on_branch(self, branch: tuple[int, ...]) -> Switching:
        return replace(self, piece=branch[0]) if self.follows else self


@pytest.mark.parametrize(("follows", "least"), [(True, 0.0), (False, 0.05)])
def test_a_start_is_followed_on_its_own_piece_too(follows: bool, least: float) -> None:
    search = Search.none()
    descent = Descent(weighted(np.ones(1)))
    result = explore(Switching(follows=follows), descent, search, rng=np.random.default_rng(0))
    assert result[0].J[0] == pytest.approx(least, abs=1e-9)
    assert result[0].evaluation.branch == ((0,) if follows else (1,))
    values = [float(solution.J[0]) for solution in result]
    assert values == sorted(values)
    assert values[-1] == pytest.approx(0.05), "the minimum that the way down leads to is kept"
