"""Kinds of models that a study file can name: one file a kind."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from modefront.models.base import Model
from modefront.study.kinds.chain import read_chain
from modefront.study.kinds.matrices import read_matrices
from modefront.study.kinds.mesh import read_mesh_model
from modefront.toml import Table

Reader = Callable[[Table, Sequence[str], Path], Model | None]

KINDS: Mapping[str, Reader] = {
    "chain": read_chain,
    "matrices": read_matrices,
    "mesh": read_mesh_model,
}
"""Readers of the ``[model]`` table: (table, names of parameters, folder) to a model or faults."""
