"""What residuals of a user's own have in common."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from modefront._typing import Ints
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs
from modefront.residuals.base import Sensitivity


@dataclass(frozen=True, eq=False)
class OneSet:
    """Residuals of modes of one data set; a member and a stack at the same time."""

    mode: Ints
    count: float = 1.0
    remark: str = ""

    @property
    def sets(self) -> Ints:
        return np.zeros(1, dtype=np.intp)

    def sensitivities(self, modes: Modes, pairs: Pairs) -> Iterator[Sensitivity]:
        yield from ()

    def independent(self) -> tuple[float, float, float]:
        return 1.0, 0.0, 0.0
