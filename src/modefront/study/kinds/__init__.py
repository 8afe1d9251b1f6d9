"""Kinds of models that a study file can name, one a file; those of the package are named here."""

from modefront.families import Family
from modefront.study.kinds.chain import CHAIN
from modefront.study.kinds.matrices import MATRICES
from modefront.study.kinds.mesh import MESH
from modefront.study.kinds.sensors import ModelKind

KINDS = Family[ModelKind]("modefront.models", "a ModelKind", ModelKind, (CHAIN, MATRICES, MESH))
"""All kinds by their names."""
