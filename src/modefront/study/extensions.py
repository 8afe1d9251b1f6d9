"""One call that makes an extension of the user known to all that reads, runs and shows studies."""

from __future__ import annotations

from typing import Any, TypeVar

from modefront.errors import wrong
from modefront.families import Family
from modefront.front.methods import METHODS
from modefront.predictions.registry import CLASSES
from modefront.residuals.groups import KINDS as RESIDUALS
from modefront.study.kinds import KINDS as MODELS
from modefront.study.measured import READERS
from modefront.text import NAME, clean

T = TypeVar("T")

FAMILIES: tuple[Family[Any], ...] = (CLASSES, MODELS, RESIDUALS, METHODS, READERS)
"""All families that users extend."""


def register(extension: T) -> T:
    """Make an extension known, and return it.

    Entry points of installed packages do the same: ``modefront.predictions``,
    ``modefront.models``, ``modefront.residuals``, ``modefront.methods`` and ``modefront.readers``.

    Parameters
    ----------
    extension
        A class of predictions with what `Prediction` has, a `ModelKind`, a kind of residual with
        what `modefront.residuals.base.ResidualKind` has, a `Method` of fronts, or a `DataReader`.
        It takes the place of one that was registered before under its name.

    Raises
    ------
    InputError
        Where it is none of these, or its name is that of another one.
    """
    for family in FAMILIES:
        if family.takes(extension):
            family.add(extension)
            return extension
    expected = ", ".join(family.what for family in FAMILIES)
    raise wrong("register", f"one of {expected}", clean(repr(extension), NAME))
