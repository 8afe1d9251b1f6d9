r"""Residuals of mode shapes.

For measured mode r, in each of the K data sets in which its shape was measured, with the
:math:`N_0` components that the sensors measured,

.. math:: r = \frac{\beta \varphi - \hat\varphi}{u \sqrt K}, \qquad
    \beta = \frac{\psi^T \chi}{\|\chi\|^2}, \qquad
    \beta' = (\psi^T \chi' - 2 \beta \chi^T \chi') / \|\chi\|^2,

where :math:`\psi = \hat\varphi / (u \sqrt K)` and :math:`\chi = \varphi / (u \sqrt K)`: the factor
is the least squares one, since a mode has no scale. The unit u is
:math:`\|\hat\varphi\| / \sqrt{N_0}`, as in equation (1), or the standard deviation of each
component. A standard deviation that is 0 or rounding, such as that of the component to which a
shape was normalised, is replaced by the median of the others in its shape.

With :math:`c = \psi^T \chi`, :math:`a = \psi^T \psi` and :math:`b = \chi^T \chi`, now over a unit
that is given (the standard deviations, or 1), the objective of a data set is
:math:`J = w (a - c^2 / b)` with :math:`w = 1` for standard deviations and :math:`w = N_0 / a` for
equation (1). An error of measurement changes it by

.. math:: \frac{\partial J}{\partial \psi} = -2 w \Big(\frac{c}{b} \chi - s \psi\Big),

where s = 1 for a given w, and :math:`s = c^2 / (a b)` for the one that changes with :math:`\psi`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.data.modal import ModalData
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs
from modefront.residuals.base import (
    NEGLIGIBLE,
    Member,
    ModeErrors,
    Scale,
    Sensitivity,
    joined,
    known_std,
    value_numbers,
)


@dataclass(frozen=True)
class MeasuredShape:
    """A shape as one data set has it.

    Attributes
    ----------
    k : data set, counted from 0
    sensors : (components,) sensors that measured it
    weight : (components,) factors 1 / (u sqrt K)
    psi : (components,) measured components times their factors
    """

    k: int
    sensors: Ints
    weight: Floats
    psi: Floats


@dataclass(frozen=True, eq=False)
class ShapeResiduals:
    """Residuals of the shape of the measured mode at position ``mode`` of the data."""

    data: ModalData
    mode: int
    scale: Scale

    @cached_property
    def _measured(self) -> Bools:
        """Which components were measured, shape (sets, sensors)."""
        return np.isfinite(self.data.shape[:, self.mode])

    @cached_property
    def shapes(self) -> list[MeasuredShape]:
        """The shape in each data set that has it."""
        sets = np.flatnonzero(self._measured.any(axis=1))
        out = []
        for k in sets.tolist():
            sensors = np.flatnonzero(self._measured[k])
            values = self.data.shape[k, self.mode, sensors]
            if self.scale == "measured":
                weight = np.full(values.size, np.sqrt(values.size / (values @ values)))
            else:
                weight = 1 / without_negligible(self.data.shape_std[k, self.mode, sensors])
            weight = weight / np.sqrt(sets.size)
            out.append(MeasuredShape(k, sensors, weight, weight * values))
        return out

    @property
    def count(self) -> float:
        """Mean number of components over the data sets that have the shape."""
        return float(self.sets.size / max(len(self.shapes), 1))

    @cached_property
    def sets(self) -> Ints:
        """Data set of each component."""
        sizes = [part.sensors.size for part in self.shapes]
        return np.repeat([part.k for part in self.shapes], sizes)

    @property
    def remark(self) -> str:
        """Reason why any model fits the shape, empty where models can miss it."""
        if max(part.sensors.size for part in self.shapes) > 1:
            return ""
        return "a shape that is measured at a single sensor fits any model"

    def margin(self, errors: ModeErrors) -> float:
        """Return the square of the greatest change of r by errors of the paired modes."""
        return float(
            errors.shape[self.mode] ** 2 * sum(part.psi @ part.psi for part in self.shapes)
        )

    def sensitivities(self, modes: Modes, pairs: Pairs) -> Iterator[Sensitivity]:
        """Yield the change of J by one standard deviation of each measured component."""
        q = pairs.index[self.mode]
        for part in self.shapes:
            std = self.data.shape_std[part.k, self.mode, part.sensors]
            relative = self.scale == "measured"
            unit = np.ones(std.size) if relative else without_negligible(std)
            psi = self.data.shape[part.k, self.mode, part.sensors] / unit
            chi = modes.phi[part.sensors, q] / unit
            dchi = modes.dphi[part.sensors, q] / unit[:, None]
            c, a, b = psi @ chi, psi @ psi, chi @ chi
            dc, db = psi @ dchi, 2 * chi @ dchi
            projection = c * chi / b
            dprojection = (np.outer(chi, dc) + c * dchi) / b - np.outer(projection, db) / b
            w, s, ds = 1.0, 1.0, np.zeros(dc.size)
            if relative:
                w, s = psi.size / a, c**2 / (a * b)
                ds = 2 * c * dc / (a * b) - s * db / b
            step = known_std(std) / len(self.shapes)
            yield Sensitivity(
                value_numbers(self.data, part.k, self.mode)[1:][part.sensors],
                -2 * w * (projection - s * psi) / unit * step,
                -2 * w * (dprojection - np.outer(psi, ds)) / unit[:, None] * step[:, None],
            )

    def floor_of_std(self) -> float:
        """Return the sum of the variances of the residuals.

        Errors along the shape count as its scale: no residual has them.
        """
        out = 0.0
        for part in self.shapes:
            std = known_std(self.data.shape_std[part.k, self.mode, part.sensors])
            out += float((part.weight * std) ** 2 @ (1 - part.psi**2 / (part.psi @ part.psi)))
        return out

    def floor_of_sets(self) -> float:
        """Return the same for the variance of the data sets, at sensors that all of them have."""
        sets = [part.k for part in self.shapes]
        common = np.asarray(self._measured[sets].all(axis=0))
        if len(sets) < 2 or common.sum() < 2:
            return 0.0
        # Shapes of any scale and sign: each is brought to the first by least squares.
        values = self.data.shape[sets, self.mode][:, common]
        factor = (values @ values[0]) / (values**2).sum(axis=1)
        mean = factor @ values
        out = 0.0
        for part in self.shapes:
            psi, chi = part.psi[common[part.sensors]], part.weight[common[part.sensors]] * mean
            away = psi - (psi @ chi) / (chi @ chi) * chi
            out += float((away @ away) * (part.psi @ part.psi) / (psi @ psi))
        return out * len(sets) / (len(sets) - 1)


@dataclass(frozen=True, eq=False)
class ShapeStack:
    """Residuals of shapes; see `modefront.residuals.base.Stack`.

    Attributes
    ----------
    blocks : shapes one after the other, those of as many components together
    """

    blocks: tuple[ShapeBlock, ...]

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        """Return the residuals, shape (rows,)."""
        return joined([block.r(modes, pairs) for block in self.blocks])

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        """Return the residuals and their derivatives, (rows, p), which are 0 of a shape that is."""
        parts = [block.with_slopes(modes, pairs) for block in self.blocks]
        return joined([r for r, _ in parts]), joined([dr for _, dr in parts])


@dataclass(frozen=True, eq=False)
class ShapeBlock:
    """Shapes with as many measured components.

    Attributes
    ----------
    mode : (shapes, 1) position of the measured mode in the data
    sensors, weight, psi : (shapes, components) those of each `MeasuredShape`
    """

    mode: Ints
    sensors: Ints
    weight: Floats
    psi: Floats

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        """Return the residuals, shape (rows,)."""
        chi, _, beta = self._scaled(modes, pairs)
        return (beta * chi - self.psi).ravel()

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        """Return the residuals and their derivatives, (rows, p), which are 0 of a shape that is."""
        chi, b, beta = self._scaled(modes, pairs)
        dchi = self.weight[:, :, None] * modes.dphi[self.sensors, pairs.index[self.mode]]
        slope = _times(self.psi, dchi) - 2 * beta * _times(chi, dchi)
        dbeta = np.divide(slope, b, out=np.zeros(slope.shape), where=b > 0)
        dr = chi[:, :, None] * dbeta[:, None] + beta[:, :, None] * dchi
        return (beta * chi - self.psi).ravel(), dr.reshape(-1, dr.shape[2])

    def _scaled(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, Floats]:
        """Return chi (shapes, components), its squared length b and beta, (shapes, 1)."""
        chi = self.weight * modes.phi[self.sensors, pairs.index[self.mode]]
        b = np.vecdot(chi, chi)[:, None]
        c = np.vecdot(self.psi, chi)[:, None]
        return chi, b, np.divide(c, b, out=np.zeros(b.shape), where=b > 0)


def _times(chi: Floats, dchi: Floats) -> Floats:
    """Return each row of chi (shapes, components) times dchi (shapes, components, p)."""
    return np.asarray((chi[:, None] @ dchi)[:, 0])


class ShapeKind:
    """Mode shapes; see `modefront.residuals.base.ResidualKind`."""

    name = "shape"
    plural = "shapes"
    usable_std = "standard deviations of all measured components, one of them above 0"

    def measured(self, data: ModalData) -> Bools:
        """Return which modes have a component of their shape in any data set."""
        return np.asarray(np.isfinite(data.shape).any(axis=(0, 2)))

    def has_usable_std(self, data: ModalData, r: int) -> bool:
        """Return whether all components of a mode have standard deviations, not all of them 0."""
        for values, std in zip(data.shape[:, r], data.shape_std[:, r], strict=True):
            measured = np.isfinite(values)
            if measured.any() and not (
                np.isfinite(std[measured]).all() and (std[measured] > 0).any()
            ):
                return False
        return True

    def members(self, data: ModalData, modes: Sequence[int], scale: Scale) -> list[Member]:
        """Return the residuals of the shape of each mode."""
        return [ShapeResiduals(data, r, scale) for r in modes]

    def stack(self, data: ModalData, modes: Sequence[int], scale: Scale) -> ShapeStack:
        """Return the residuals of the shapes of some modes."""
        parts = [(r, part) for r in modes for part in ShapeResiduals(data, r, scale).shapes]
        blocks = []
        for _, alike in groupby(parts, lambda each: each[1].sensors.size):
            numbers, shapes = zip(*alike, strict=True)
            sensors, weight, psi = (
                np.array([getattr(shape, name) for shape in shapes])
                for name in ("sensors", "weight", "psi")
            )
            blocks.append(ShapeBlock(np.array(numbers)[:, None], sensors, weight, psi))
        return ShapeStack(tuple(blocks))


def without_negligible(std: Floats) -> Floats:
    """Return standard deviations with negligible ones replaced by the median of the others."""
    real = std > NEGLIGIBLE * std.max()
    return np.where(real, std, np.median(std[real]))
