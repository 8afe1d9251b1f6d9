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

With the fit :math:`\pi = \beta \chi` of :math:`\psi`, and :math:`a = \psi^T \psi`, now over a unit
that is given (the standard deviations, or 1), the objective of a data set is
:math:`J = w (a - \pi^T \pi)` with :math:`w = 1` for standard deviations and :math:`w = N_0 / a` for
equation (1). An error of measurement changes it by

.. math:: \frac{\partial J}{\partial \psi} = -2 w (\pi - s \psi),

where s = 1 for a given w, and :math:`s = \pi^T \pi / a` for the one that changes with
:math:`\psi`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.data.modal import ModalData
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs
from modefront.residuals.base import (
    NEGLIGIBLE,
    Curvature,
    Member,
    ModeErrors,
    Scale,
    Sensitivity,
    joined,
    known_std,
    together,
    value_numbers,
)
from modefront.residuals.span import fitted


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
class _Components:
    """The measured components of a mode, those of a data set together.

    Attributes
    ----------
    sets, sensors, weight, psi : (components,) data set, sensor, and what `MeasuredShape` has
    sizes : (shapes,) number of components of each data set that has the shape
    parts : (shapes,) where these are
    """

    sets: Ints
    sizes: Ints
    parts: list[slice]
    sensors: Ints
    weight: Floats
    psi: Floats


@dataclass(frozen=True, eq=False)
class ShapeResiduals:
    """Residuals of the shape of the measured mode at position ``mode`` of the data.

    With a ``cluster`` of positions, the shape is fitted by all model modes that belong to these
    (`modefront.residuals.subspace`).
    """

    data: ModalData
    mode: int
    scale: Scale
    cluster: tuple[int, ...] = ()

    @cached_property
    def _measured(self) -> Bools:
        """Which components were measured, shape (sets, sensors)."""
        return np.isfinite(self.data.shape[:, self.mode])

    @cached_property
    def components(self) -> _Components:
        """All components, those of one data set after those of the other."""
        rows, sensors = np.nonzero(self._measured)
        sizes = np.unique(rows, return_counts=True)[1]
        parts = [slice(*each) for each in pairwise([0, *np.cumsum(sizes).tolist()])]
        values = self.data.shape[rows, self.mode, sensors]
        if self.scale == "measured":
            squares = np.array([values[part] @ values[part] for part in parts])
            weight = np.repeat(np.sqrt(sizes / squares), sizes)
        else:
            std = self.data.shape_std[rows, self.mode, sensors]
            weight = 1 / joined([without_negligible(std[part]) for part in parts] or [std])
        weight = weight / np.sqrt(sizes.size)
        return _Components(rows, sizes, parts, sensors, weight, weight * values)

    @cached_property
    def shapes(self) -> list[MeasuredShape]:
        """The shape in each data set that has it."""
        x = self.components
        return [
            MeasuredShape(int(x.sets[part.start]), x.sensors[part], x.weight[part], x.psi[part])
            for part in x.parts
        ]

    @cached_property
    def _square(self) -> float:
        psi = self.components.psi
        return float(sum(psi[part] @ psi[part] for part in self.components.parts))

    @property
    def count(self) -> float:
        """Mean number of components over the data sets that have the shape."""
        return float(self.sets.size / max(self.components.sizes.size, 1))

    @property
    def sets(self) -> Ints:
        """Data set of each component."""
        return self.components.sets

    @property
    def remark(self) -> str:
        """Reason why any model fits the shape, empty where models can miss it."""
        m = len(self.cluster) or 1
        if self.components.sizes.max() > m:
            return ""
        sensors = "a single sensor" if m == 1 else f"{m} sensors for as many modes"
        return f"a shape that is measured at {sensors} fits any model"

    def margin(self, errors: ModeErrors) -> float:
        """Return the square of the greatest change of r by errors of the paired modes."""
        return float(errors.shape[self.mode] ** 2 * self._square)

    def sensitivities(self, modes: Modes, pairs: Pairs) -> Iterator[Sensitivity]:
        """Yield the change of J by one standard deviation of each measured component."""
        q = pairs.index[list(self.cluster or (self.mode,))]
        for part in self.shapes:
            std = self.data.shape_std[part.k, self.mode, part.sensors]
            relative = self.scale == "measured"
            unit = np.ones(std.size) if relative else without_negligible(std)
            psi = self.data.shape[part.k, self.mode, part.sensors] / unit
            places = np.ix_(part.sensors, q)
            fit = fitted(
                modes.phi[places] / unit[:, None], modes.dphi[places] / unit[:, None, None], psi
            )
            projection, dprojection = fit.r + psi, fit.dr
            w, s, ds = 1.0, 1.0, np.zeros(fit.dr.shape[1])
            if relative:
                a = psi @ psi
                w, s = psi.size / a, projection @ projection / a
                ds = 2 * projection @ dprojection / a
            step = known_std(std) / len(self.shapes)
            yield Sensitivity(
                value_numbers(self.data, part.k, self.mode)[1:][part.sensors],
                -2 * w * (projection - s * psi) / unit * step,
                -2 * w * (dprojection - np.outer(psi, ds)) / unit[:, None] * step[:, None],
            )

    def independent(self) -> tuple[float, float, float]:
        """Return counts and scatter: each set has a factor of its own, fitted.

        Sets with the same sensors and standard deviations in proportion have one shape, at best the
        first singular vector; all others count as independent of each other.
        """
        x, m = self.components, len(self.cluster) or 1
        total, K = float(np.maximum(x.sizes - m, 0).sum()), x.sizes.size
        if K > 1 and m == 1 and np.ptp(x.sizes) == 0:
            psi, weight, sensors = (v.reshape(K, -1) for v in (x.psi, x.weight, x.sensors))
            share = weight / weight[:, :1]
            if (sensors == sensors[0]).all() and np.ptp(share / share[0]) <= NEGLIGIBLE:
                S = float((np.linalg.svd(psi, compute_uv=False)[1:] ** 2).sum())
                return float(x.sizes[0] - 1), S, total - float(x.sizes[0] - 1)
        return total, 0.0, 0.0


@dataclass(frozen=True, eq=False)
class ShapeStack:
    """Residuals of shapes; see `modefront.residuals.base.Stack`.

    Attributes
    ----------
    blocks : shapes one after the other, those of as many components together
    """

    blocks: tuple[ShapeBlock, ...]

    def squares(self, modes: Modes, count: int) -> Floats:
        """Return the sums of squares with each model mode, (measured modes, modes)."""
        out = np.zeros((count, modes.frequency.size))
        for block in self.blocks:
            np.add.at(out, block.mode[:, 0], block.squares(modes))
        return out

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        """Return the residuals, shape (rows,)."""
        return joined([block.r(modes, pairs) for block in self.blocks])

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        """Return the residuals and their derivatives, (rows, p), which are 0 of a shape that is."""
        parts = [block.with_slopes(modes, pairs) for block in self.blocks]
        return joined([r for r, _ in parts]), joined([dr for _, dr in parts])

    def with_curvature(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, Curvature]:
        """Return these and what is needed of second derivatives."""
        r, dr, parts = zip(*(x.with_curvature(modes, pairs) for x in self.blocks), strict=True)
        return joined(r), joined(dr), together(parts)


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

    def squares(self, modes: Modes) -> Floats:
        """Return the sums of squares of each shape with each model mode, (shapes, modes)."""
        c = np.einsum("rs,rsq->rq", self.psi * self.weight, modes.phi[self.sensors])
        b = np.einsum("rs,rsq->rq", self.weight**2, modes.phi[self.sensors] ** 2)
        seen = np.divide(c**2, b, out=np.zeros(b.shape), where=b > 0)
        return np.asarray(np.vecdot(self.psi, self.psi)[:, None] - seen)

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        """Return the residuals, shape (rows,)."""
        chi, _, beta = self._scaled(modes, pairs)
        return (beta * chi - self.psi).ravel()

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        """Return the residuals and their derivatives, (rows, p), which are 0 of a shape that is."""
        r, dr, *_ = self._slopes(modes, pairs)
        return r.ravel(), dr

    def with_curvature(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, Curvature]:
        """Return these and what is needed of second derivatives, from chi^T r = 0."""
        r, dr, beta, dchi, dbeta = self._slopes(modes, pairs)
        v, own = np.zeros(modes.phi.shape), 2 * _times(r, dchi).T @ dbeta
        np.add.at(v, (self.sensors, pairs.index[self.mode]), 2 * beta * self.weight * r)
        return r.ravel(), dr, Curvature(np.zeros(modes.lam.size), v, own + own.T)

    def _slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """Return r (shapes, components), dr (rows, p), beta (shapes, 1), and dchi and dbeta."""
        chi, b, beta = self._scaled(modes, pairs)
        dchi = self.weight[:, :, None] * modes.dphi[self.sensors, pairs.index[self.mode]]
        slope = _times(self.psi, dchi) - 2 * beta * _times(chi, dchi)
        dbeta = np.divide(slope, b, out=np.zeros(slope.shape), where=b > 0)
        dr = chi[:, :, None] * dbeta[:, None] + beta[:, :, None] * dchi
        return beta * chi - self.psi, dr.reshape(-1, dr.shape[2]), beta, dchi, dbeta

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
        parts = [ShapeResiduals(data, r, scale).components for r in modes]
        sizes = np.concatenate([part.sizes for part in parts])
        numbers = np.repeat(modes, [part.sizes.size for part in parts])[:, None]
        columns = [
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("sensors", "weight", "psi")
        ]
        ends = np.append(0, np.cumsum(sizes))
        changes = np.flatnonzero(np.diff(sizes)) + 1
        return ShapeStack(
            tuple(
                ShapeBlock(
                    numbers[first:last],
                    *(x[ends[first] : ends[last]].reshape(last - first, -1) for x in columns),
                )
                for first, last in pairwise([0, *changes.tolist(), sizes.size])
            )
        )


def without_negligible(std: Floats) -> Floats:
    """Return standard deviations with negligible ones replaced by the median of the others."""
    real = std > NEGLIGIBLE * std.max()
    return np.where(real, std, np.median(std[real]))
