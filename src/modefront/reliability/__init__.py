"""First-passage probabilities of linear structures under Gaussian noise."""

from types import MappingProxyType
from typing import Final

from modefront.reliability.estimate import Estimate, Estimator, StepEffect, step_effect
from modefront.reliability.methods import (
    additive_rules,
    directional_importance_sampling,
    importance_sampling,
    monte_carlo,
)
from modefront.reliability.problem import FirstPassage, KanaiTajimi, Sided, StepError, WhiteNoise

METHODS: Final = MappingProxyType(
    {
        "importance": importance_sampling,
        "directional": directional_importance_sampling,
        "additive": additive_rules,
        "monte-carlo": monte_carlo,
    }
)
"""The methods by the names that a user gives them; all are called alike."""

__all__ = [
    "METHODS",
    "Estimate",
    "Estimator",
    "FirstPassage",
    "KanaiTajimi",
    "Sided",
    "StepEffect",
    "StepError",
    "WhiteNoise",
    "additive_rules",
    "directional_importance_sampling",
    "importance_sampling",
    "monte_carlo",
    "step_effect",
]
