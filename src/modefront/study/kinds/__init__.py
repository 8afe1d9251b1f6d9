"""Kinds of models that a study file can name, one a file: a new one is named here, nowhere else."""

from __future__ import annotations

from collections.abc import Mapping

from modefront.study.kinds.chain import CHAIN
from modefront.study.kinds.matrices import MATRICES
from modefront.study.kinds.mesh import MESH
from modefront.study.kinds.sensors import ModelKind

KINDS: Mapping[str, ModelKind] = {kind.name: kind for kind in (CHAIN, MATRICES, MESH)}
"""All kinds by their names."""
