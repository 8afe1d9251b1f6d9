r"""Residuals of mode shapes, and of the spans of close ones (``docs/methods/residuals.md``).

In each of the K data sets in which a shape was measured, at :math:`N_0` sensors,

.. math:: r = X c - \psi, \qquad c = (X^T X)^{-1} X^T \psi, \qquad
    \psi = \frac{\hat\varphi}{u \sqrt K}, \qquad X = \frac{\Phi}{u \sqrt K},

where :math:`\Phi` (components, m) is the shape of the paired mode, or those of all m modes of a
cluster. A standard deviation that is 0 or rounding, such as that of the component to which a shape
was normalised, is replaced by the median of the others in its shape. With covariances,
:math:`1/u` is the matrix :math:`L^{-1} D^{-1}`.

From :math:`X^T r = 0` (Golub & Pereyra 1973, doi:10.1137/0710036)

.. math:: c' = -(X^T X)^{-1} (X'^T r + X^T X' c), \qquad r' = X' c + X c',

and what the modes give to the second derivatives of :math:`\|r\|^2` beyond those of Gauss and
Newton, with :math:`\partial \|r\|^2 / \partial X = 2 r c^T` constant, is
:math:`2 r^T (X'_i c'_j + X'_j c'_i)`.

With the fit :math:`\pi = X c` of :math:`\psi`, and :math:`a = \psi^T \psi`, now over a unit
that is given (the standard deviations, or 1), the objective of a data set is
:math:`J = w (a - \pi^T \pi)` with :math:`w = 1` for standard deviations and :math:`w = N_0 / a` for
equation (1). An error of measurement changes it by

.. math:: \frac{\partial J}{\partial \psi} = -2 w (\pi - s \psi),

where s = 1 for a given w, and :math:`s = \pi^T \pi / a` for the one that changes with
:math:`\psi`.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from modefront._typing import Bools, Floats, Ints
from modefront.data.modal import ModalData
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs
from modefront.residuals import base


class _Shape(NamedTuple):
    """A shape of a data set: its sensors, factors 1 / (u sqrt K), L^-1 or None, and psi."""

    mode: int
    set: int
    sensors: Ints
    weight: Floats
    inverse: Floats | None
    psi: Floats


class _Rows(NamedTuple):
    """All shapes: what `_Shape` has, (shapes, components), 0 beyond the components that there are.

    Also positions of the modes by which each is fitted, (shapes, m), and which components it has;
    the L^-1 are (shapes, components, components), or None for ones.
    """

    fitted: Ints
    there: Bools
    sensors: Ints
    weight: Floats
    psi: Floats
    inverse: Floats | None


@dataclass(frozen=True, eq=False)
class ShapeResiduals:
    """Residuals of the shapes of the measured modes at some positions of the data.

    Those of one mode are a member of a group, those of several a stack of them. With a ``cluster``
    of positions, each shape is fitted by all model modes that belong to these.
    """

    data: ModalData
    modes: Sequence[int]
    scale: base.Scale
    cluster: tuple[int, ...] = ()

    @cached_property
    def shapes(self) -> list[_Shape]:
        """The shape of each mode in each data set that has it."""
        out = list[_Shape]()
        for mode in self.modes:
            measured = np.isfinite(self.data.shape[:, mode])
            sets = np.flatnonzero(measured.any(axis=1)).tolist()
            for k in sets:
                sensors, inverse = np.flatnonzero(measured[k]), None
                values = self.data.shape[k, mode, sensors]
                if self.scale == "measured":
                    weight = np.full(values.size, np.sqrt(values.size / (values @ values)))
                else:
                    unit, inverse = self._units(k, mode, sensors)
                    weight = 1 / unit
                weight = weight / np.sqrt(len(sets))
                psi = weight * values if inverse is None else inverse @ (weight * values)
                out.append(_Shape(mode, k, sensors, weight, inverse, psi))
        return out

    def _units(self, k: int, mode: int, sensors: Ints) -> tuple[Floats, Floats | None]:
        """Return the deviations D of a data set's components, and L^-1 where they have one."""
        C = self.data.covariance_of(k, mode, sensors)
        if C is None:
            return without_negligible(self.data.shape_std[k, mode, sensors]), None
        std = np.sqrt(C.diagonal())
        L = np.linalg.cholesky(C / np.outer(std, std))
        return std, la.solve_triangular(L, np.eye(std.size), lower=True)

    @property
    def count(self) -> float:
        """Mean number of components over the data sets that have the shape."""
        return float(self.sets.size / len(self.shapes))

    @property
    def sets(self) -> Ints:
        """Data set of each component."""
        return np.concatenate([np.full(x.sensors.size, x.set) for x in self.shapes])

    @property
    def remark(self) -> str:
        """Reason why any model fits the shape, empty where models can miss it."""
        m = len(self.cluster) or 1
        if max(x.sensors.size for x in self.shapes) > m:
            return ""
        sensors = "a single sensor" if m == 1 else f"{m} sensors for as many modes"
        return f"a shape that is measured at {sensors} fits any model"

    def margin(self, errors: base.ModeErrors) -> float:
        """Return the square of the greatest change of r by errors of the paired modes."""
        squares = []
        for x in self.shapes:
            if x.inverse is None:
                squares.append(x.psi @ x.psi)
            else:
                values = self.data.shape[x.set, x.mode, x.sensors]
                size = np.linalg.norm(x.inverse * x.weight, 2)
                squares.append(size**2 * (values @ values))
        return float(errors.shape[self.modes[0]] ** 2 * sum(squares))

    def sensitivities(self, modes: Modes, pairs: Pairs) -> Iterator[base.Sensitivity]:
        """Yield the change of J by one standard deviation of each measured component."""
        q, K = pairs.index[list(self.cluster or self.modes)], len(self.shapes)
        relative = self.scale == "measured"
        for r, k, sensors, *_ in self.shapes:
            std, C = self.data.shape_std[k, r, sensors], self.data.covariance_of(k, r, sensors)
            unit, inverse = (np.ones(std.size), None) if relative else self._units(k, r, sensors)
            psi, places = self.data.shape[k, r, sensors] / unit, np.ix_(sensors, q)
            X, dX = modes.phi[places] / unit[:, None], modes.dphi[places] / unit[:, None, None]
            if inverse is not None:
                psi, X, dX = inverse @ psi, inverse @ X, np.tensordot(inverse, dX, 1)
            _, _, (r0,), (dprojection,) = _fitted(X[None], dX[None], psi[None])
            projection = r0 + psi
            w, s, ds = 1.0, 1.0, np.zeros(dX.shape[-1])
            if relative:
                a = psi @ psi
                w, s = psi.size / a, projection @ projection / a
                ds = 2 * projection @ dprojection / a
            J = -2 * w * (projection - s * psi)
            dJ = -2 * w * (dprojection - np.outer(psi, ds))
            if inverse is not None:
                J, dJ = inverse.T @ J, inverse.T @ dJ
            root = np.diag(np.where(std > 0, std, 0.0)) if C is None else np.linalg.cholesky(C)
            root, number = root.T / K, base.value_numbers(self.data, k, r)[1:][sensors]
            yield base.Sensitivity(number, root @ (J / unit), root @ (dJ / unit[:, None]))

    def independent(self) -> tuple[float, float, float]:
        """Return counts and scatter: each set has a factor of its own, fitted.

        Sets with the same sensors and standard deviations in proportion have one shape, at best the
        first singular vector; all others count as independent of each other.
        """
        shapes, m = self.shapes, len(self.cluster) or 1
        total = float(sum(max(x.sensors.size - m, 0) for x in shapes))
        alike = all(
            x.inverse is None and np.array_equal(x.sensors, shapes[0].sensors) for x in shapes
        )
        if len(shapes) > 1 and m == 1 and alike:
            share = np.array([x.weight / x.weight[0] for x in shapes])
            if np.ptp(share / share[0]) <= base.NEGLIGIBLE:
                psi, own = np.array([x.psi for x in shapes]), shapes[0].sensors.size - 1.0
                S = float((np.linalg.svd(psi, compute_uv=False)[1:] ** 2).sum())
                return own, S, total - own
        return total, 0.0, 0.0

    @cached_property
    def rows(self) -> _Rows:
        """All shapes, a row each."""
        sizes = np.array([x.sensors.size for x in self.shapes])
        there = np.arange(sizes.max()) < sizes[:, None]
        sensors, (weight, psi) = np.zeros(there.shape, dtype=np.intp), np.zeros((2, *there.shape))
        for name, out in (("sensors", sensors), ("weight", weight), ("psi", psi)):
            out[there] = np.concatenate([getattr(x, name) for x in self.shapes])
        inverse = None
        if any(x.inverse is not None for x in self.shapes):
            inverse = np.tile(np.eye(there.shape[1]), (len(there), 1, 1))
            for whole, x in zip(inverse, self.shapes, strict=True):
                if x.inverse is not None:
                    whole[: x.sensors.size, : x.sensors.size] = x.inverse
        fitted = np.array([self.cluster or (x.mode,) for x in self.shapes])
        return _Rows(fitted, there, sensors, weight, psi, inverse)

    def squares(self, modes: Modes, count: int) -> Floats:
        """Return the sums of squares with each model mode, (measured modes, modes)."""
        out, rows = np.zeros((count, modes.frequency.size)), self.rows
        if rows.fitted.shape[1] == 1:  # no pair of modes alone has a residual from a span
            X = self._over(modes.phi[rows.sensors])
            c, b = np.einsum("rs,rsq->rq", rows.psi, X), np.einsum("rsq,rsq->rq", X, X)
            seen = np.divide(c**2, b, out=np.zeros(b.shape), where=b > 0)
            np.add.at(out, rows.fitted[:, 0], np.vecdot(rows.psi, rows.psi)[:, None] - seen)
        return out

    def r(self, modes: Modes, pairs: Pairs) -> Floats:
        """Return the residuals, shape (rows,)."""
        X = self._over(modes.phi[self._places(pairs)])
        psi = self.rows.psi
        return ((X @ (_inverse(X) @ psi[:, :, None]))[:, :, 0] - psi)[self.rows.there]

    def with_slopes(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats]:
        """Return the residuals and their derivatives, (rows, p), which are 0 of a shape that is."""
        _, _, _, r, dr = self._fit(modes, pairs)
        return r[self.rows.there], dr[self.rows.there]

    def with_curvature(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, base.Curvature]:
        """Return these and what is needed of second derivatives."""
        rows, (dX, c, dc, r, dr) = self.rows, self._fit(modes, pairs)
        of_dX = (r[:, None] @ dX.reshape(*r.shape, -1)).reshape(-1, dX.shape[3])
        v, own = np.zeros(modes.phi.shape), 2 * of_dX.T @ dc.reshape(of_dX.shape)
        turned = r if rows.inverse is None else np.einsum("rab,ra->rb", rows.inverse, r)
        np.add.at(v, self._places(pairs), 2 * (rows.weight * turned)[:, :, None] * c[:, None])
        curvature = base.Curvature(np.zeros(modes.lam.size), v, own + own.T)
        return r[rows.there], dr[rows.there], curvature

    def _places(self, pairs: Pairs) -> tuple[Ints, Ints]:
        """Return sensors and model modes of the entries of X, (shapes, components, m)."""
        return self.rows.sensors[:, :, None], pairs.index[self.rows.fitted][:, None]

    def _over(self, values: Floats) -> Floats:
        """Return values (shapes, components, ...) over the unit u sqrt K."""
        weight, inverse = self.rows.weight, self.rows.inverse
        out = weight.reshape(*weight.shape, *[1] * (values.ndim - 2)) * values
        if inverse is None:
            return out
        return (inverse @ out.reshape(*out.shape[:2], -1)).reshape(out.shape)

    def _fit(self, modes: Modes, pairs: Pairs) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """Return dX (shapes, components, m, p), and what `_fitted` does."""
        places = self._places(pairs)
        dX = self._over(modes.dphi[places])
        return dX, *_fitted(self._over(modes.phi[places]), dX, self.rows.psi)


def _inverse(X: Floats) -> Floats:
    """Return the pseudoinverse (shapes, m, components) of X (shapes, components, m)."""
    if X.shape[2] > 1:
        return np.asarray(np.linalg.pinv(X), dtype=float)
    b = np.vecdot(X[:, :, 0], X[:, :, 0])[:, None, None]
    return np.divide(X, b, out=np.zeros(X.shape), where=b > 0).transpose(0, 2, 1)


def _fitted(X: Floats, dX: Floats, psi: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return c (shapes, m) of the fits X c of psi (shapes, components), dc, r = X c - psi, dr."""
    inverse, (n, rows, m, p) = _inverse(X), dX.shape
    c = inverse @ psi[:, :, None]
    r = X @ c - psi[:, :, None]
    along = (c.transpose(0, 2, 1)[:, None] @ dX)[:, :, 0]
    turned = (r.transpose(0, 2, 1) @ dX.reshape(n, rows, -1)).reshape(n, m, p)
    dc = -inverse @ (along + inverse.transpose(0, 2, 1) @ turned)
    return c[:, :, 0], dc, r[:, :, 0], along + X @ dc


@dataclass(frozen=True)
class ShapeKind:
    """Mode shapes, or spans of close ones; see `modefront.residuals.base.ResidualKind`.

    The members of a group under a kind that is ``joint`` are one cluster of measured modes.
    """

    name: str
    plural: str
    joint: bool
    usable_std = "standard deviations of all measured components, one of them above 0"

    def measured(self, data: ModalData) -> Bools:
        """Return which modes have a component of their shape in any data set."""
        return np.asarray(np.isfinite(data.shape).any(axis=(0, 2)))

    def has_usable_std(self, data: ModalData, r: int) -> bool:
        """Return whether all components of a mode have standard deviations, not all of them 0."""
        measured, std = np.isfinite(data.shape[:, r]), data.shape_std[:, r]
        known = (np.isfinite(std) | ~measured).all(axis=1) & ((std > 0) & measured).any(axis=1)
        return bool((known | ~measured.any(axis=1)).all())

    def members(
        self, data: ModalData, modes: Sequence[int], scale: base.Scale
    ) -> list[base.Member]:
        """Return the residuals of the shape of each mode."""
        cluster = tuple(modes) if self.joint else ()
        return [ShapeResiduals(data, [r], scale, cluster) for r in modes]

    def stack(self, data: ModalData, modes: Sequence[int], scale: base.Scale) -> ShapeResiduals:
        """Return the residuals of the shapes of some modes."""
        return ShapeResiduals(data, modes, scale, tuple(modes) if self.joint else ())


def without_negligible(std: Floats) -> Floats:
    """Return standard deviations with negligible ones replaced by the median of the others."""
    real = std > base.NEGLIGIBLE * std.max()
    return np.where(real, std, np.median(std[real]))
