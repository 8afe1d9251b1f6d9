"""Interface of kinds of residuals, whose equations are in ``docs/methods/residuals.md``.

A kind (`ResidualKind`) says which measured modes it can be formed of, makes the members of groups
(`Member`) and evaluates the residuals of several members at once (`Stack`). Kinds are named in
`modefront.residuals.groups`.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.data.modal import ModalData
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs

Scale = Literal["measured", "std"]
"""Unit by which errors are divided: one that follows from the measured values, or their std."""

NEGLIGIBLE = 1e-9  # standard deviation, over the greatest one or the frequency, that is rounding


@dataclass(frozen=True)
class Sensitivity:
    """Changes of an objective by one standard deviation of each of some measured values."""

    values: Ints  # (values,) numbers of the measured values, see `value_numbers`
    J: Floats  # (values,) changes of the objective at fixed parameters
    dJ: Floats  # (values, p) changes of its derivatives


@dataclass(frozen=True)
class ModeErrors:
    """Relative errors of the model modes that are paired with the measured ones."""

    eigenvalue: Floats  # eigenvalue, shape: (measured modes,)
    shape: Floats


@dataclass(frozen=True)
class Curvature:
    r"""What the modes give to the second derivatives of :math:`J = \|r\|^2` beyond Gauss-Newton's.

    It is the sum of ``own`` and of the second derivatives of :math:`\sum_r w_r \lambda_r + v_r^T
    \varphi_r` with w and v constant, the derivatives of J with respect to the modes.
    """

    w: Floats  # (modes,) dJ / dlam
    v: Floats  # (sensors, modes) dJ / dphi
    # (p, p) :math:`2 \sum_k r_k \nabla^2 r_k` with second derivatives of the modes left out
    own: Floats


class Member(Protocol):
    """A member of a group: residuals of a measured property, one data set after the other."""

    @property
    def count(self) -> float:
        """Count a of measured properties, mean over the data sets."""

    @property
    def sets(self) -> Ints:
        """Data set of each residual, counted from 0, shape (rows,)."""

    @property
    def remark(self) -> str:
        """Reason why any model fits the property; empty where models can miss it."""

    def margin(self, errors: ModeErrors) -> float:
        """Return the square of the greatest change of r by errors of the paired modes."""

    def sensitivities(self, modes: Modes, pairs: Pairs) -> Iterator[Sensitivity]:
        """Yield the changes of J by one standard deviation of measured values, set after set.

        A value without a standard deviation counts as exact.
        """

    def independent(self) -> tuple[float, float, float]:
        """Return a, S and d of residuals that are summed over the data sets.

        The count a of independent errors that a model can explain, the part S of the sum of their
        squares that none explains, since data sets differ, and the degrees of freedom d of S.
        """


class Stack(Protocol):
    """The residuals of members of one kind, those of one member after those of the other."""

    def squares(self, modes: Modes, count: int) -> Floats:
        """Return the sums of squares of each of ``count`` measured modes with each model mode.

        They have the shape (measured modes, modes), and are 0 of modes without a residual.
        """

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        """Return the residuals at the modes of a model, shape (rows,)."""

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        """Return the residuals and their derivatives, shape (rows, p)."""

    def with_curvature(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, Curvature]:
        """Return the residuals, their derivatives and what is needed of second derivatives."""


@runtime_checkable
class ResidualKind(Protocol):
    """A kind of residual, such as that of natural frequencies."""

    @property
    def name(self) -> str:
        """Name of the kind in groups and messages, in the singular."""

    @property
    def plural(self) -> str:
        """Name of the measured properties, in the plural."""

    @property
    def usable_std(self) -> str:
        """Which standard deviations the scale ``"std"`` needs, for messages."""

    def measured(self, data: ModalData) -> Bools:
        """Return which modes have measured values of this kind, shape (modes,)."""

    def has_usable_std(self, data: ModalData, r: int) -> bool:
        """Return whether the scale ``"std"`` is possible for the measured mode at position r."""

    def members(self, data: ModalData, modes: Sequence[int], scale: Scale) -> list[Member]:
        """Return the residuals of measured modes, given by their positions in the data."""

    def stack(self, data: ModalData, modes: Sequence[int], scale: Scale) -> Stack:
        """Return the same members as one; there is one of them at least."""


def value_numbers(data: ModalData, k: int, r: int) -> Ints:
    """Return the numbers of the values of mode r in data set k, shape (1 + sensors,).

    The first one is that of its frequency, the others are those of the components of its shape.
    """
    size = 1 + len(data.sensors)
    return (k * len(data.modes) + r) * size + np.arange(size)
