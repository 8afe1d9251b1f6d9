"""The interface of kinds of models in a study file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from modefront.models.base import Model
from modefront.toml import Table


@dataclass(frozen=True)
class ModelKind:
    """A kind of model that a study file can name.

    Attributes
    ----------
    name : value of ``kind`` in the table ``[model]``
    read : returns the model of that table, given the names of the parameters, or None where the
        table has faults; files are opened by `modefront.toml.Table.path`, so that they are known
    is_reducible : whether a model may be large enough for a reduced basis
    """

    name: str
    read: Callable[[Table, Sequence[str]], Model | None]
    is_reducible: bool = True
