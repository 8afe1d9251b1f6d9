"""Options of the analysis of identifiability."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from modefront.options import Checked, number, whole

SHARE = number("a share from 0 to 1", least=0, most=1)
STEP = number("a share of the ranges from 0.001 to 0.5", least=1e-3, most=0.5)


@dataclass(frozen=True)
class Identifiability(Checked):
    """Limits of flat parts of the front and of manifolds of equivalent models.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    flat : share from 0 to 1 by which an objective may exceed its least value in a flat part of the
        front; 0 for no search of flat parts
    models : greatest number of equivalent models on each manifold; 0 for no manifolds
    step : distance of neighbours on a manifold, over the ranges of the parameters, from 0.001 to
        0.5
    """

    flat: Annotated[float, SHARE] = 0.01
    models: Annotated[int, whole(0, 10**6)] = 100
    step: Annotated[float, STEP] = 0.05
