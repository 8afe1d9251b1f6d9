r"""Load cases, and a model from its loads to its outputs: what predictions need of a model.

Loads and outputs are weighted sums: with the rows :math:`l` of sensors and outputs (named sums of
degrees of freedom) and their weights,

.. math::
    f = \sum_p w_p\, l_p^T, \qquad f = -M r \ \text{for a moving base}, \qquad
    y = \sum_p w_p\, l_p u

where :math:`r` is the motion of all degrees of freedom with the base and u, for a moving base,
the displacement relative to it. In modes, as `modefront.response.system` has it, these are
:math:`\Gamma = \Phi^T f`, :math:`Y = l \Phi`, :math:`Y_s = l K^{-1} f` and :math:`Y_b = l r`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from modefront._typing import Floats
from modefront.modes.result import Modes

NamedWeights = Mapping[str, float]
"""Weights by the name of a sensor or output: a force of that size, or a term of a sum."""


@dataclass(frozen=True)
class LoadCase:
    """Loads and outputs of a model: either forces, or one motion of the base.

    Attributes
    ----------
    outputs : weighted sums of sensors and outputs, such as a storey drift
    forces : distributions of force, one an input; none where the base moves
    base : the direction in which the base moves, of the model's directions; None for forces
    """

    outputs: tuple[NamedWeights, ...]
    forces: tuple[NamedWeights, ...] = ()
    base: str | None = None


@dataclass(frozen=True)
class Transfer:
    """A model at one theta from the loads of a load case to its outputs, in its lowest modes.

    Attributes
    ----------
    modes : the modes at the sensors, without derivatives
    input : (modes, inputs) modal loads
    output : (outputs, modes) mode shapes at the outputs
    static : (outputs, inputs) static response; None with rigid-body modes
    rigid : (outputs, 1) motion of the outputs with the base; None for forces
    """

    modes: Modes
    input: Floats
    output: Floats
    static: Floats | None
    rigid: Floats | None
