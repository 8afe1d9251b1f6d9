r"""The residuals of frequencies and mode shapes, and the objectives that they form.

Equation (1) of Christodoulou et al. (2008, doi:10.1016/j.cma.2008.04.010), as vectors with
:math:`J = \|r\|^2`: for measured mode r, mean over the data sets k in which it was measured,

.. math::
    J_{\omega_r} = \frac1K \sum_k \Big(\frac{\omega_r - \hat\omega_r}{\hat\omega_r}\Big)^2, \qquad
    J_{\varphi_r} = \frac1K \sum_k
        \frac{\|\beta \varphi_r - \hat\varphi_r\|^2}{\|\hat\varphi_r\|^2 / N_0}, \qquad
    \beta = \frac{\hat\varphi_r^T \varphi_r}{\|\varphi_r\|^2}

at the :math:`N_0` sensors that measured the mode in the data set, and

.. math:: \beta' = (\hat\varphi^T \varphi' - 2 \beta \varphi^T \varphi') / \|\varphi\|^2 .

On request residuals are over the standard deviations of the measurements instead:
:math:`(\omega_r - \hat\omega_r) / \hat\sigma` and, component by component,
:math:`(\beta \varphi - \hat\varphi) / \hat\sigma` with :math:`\beta` the least squares of these. A
component whose standard deviation is 0 or rounding, such as one to which a shape was normalised,
takes the median of the others in its shape.

An objective is the sum over the members of its group. Its count :math:`a_i` of measured
properties is one for a frequency and :math:`N_0` (mean over data sets) for a shape.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from modefront._typing import Floats, Ints
from modefront.data.modal import ModalData
from modefront.errors import ModelError
from modefront.models.base import Model
from modefront.models.parameters import Parameter, in_order, parameters_of
from modefront.models.reduced.options import Reduction
from modefront.modes.result import Modes
from modefront.pairing.match import Pairing, Pairs, match, mean_mac, modes_needed
from modefront.residuals.groups import (
    Group,
    Scale,
    measured_frequencies,
    measured_shapes,
    members,
)
from modefront.solvers.problem import Evaluation, Residual, infeasible

NEGLIGIBLE = 1e-9
"""Standard deviation, over the greatest one or the frequency, below which it is rounding."""

Member = tuple[str, int, Scale]
"""A member of a group: frequency or shape, position of the measured mode, scale."""


@dataclass(frozen=True)
class UpdatingProblem:
    """Objectives of a model, measured data and groups; see `modefront.solvers.problem.Problem`.

    ``lower``, ``upper`` and ``start`` are the bounds and the nominal values of the parameters.
    ``pairs`` are the model modes, from 0, that are paired with the measured ones whatever their MAC
    is; None where they are matched. Raises ValueError for a group without members.
    """

    model: Model
    data: ModalData
    groups: tuple[Group, ...]
    lower: Floats
    upper: Floats
    start: Floats
    pairing: Pairing = field(default_factory=Pairing)
    pairs: tuple[int, ...] | None = None

    def __post_init__(self) -> None:
        for group, row in zip(self.groups, self.members, strict=True):
            if not row:
                raise ValueError(f"group '{group.name}': at least one member, found none")
            for kind, r, scale in row:
                if scale == "std":
                    check_std(self.data, kind, r)

    @property
    def objectives(self) -> tuple[str, ...]:
        """Names of the groups."""
        return tuple(group.name for group in self.groups)

    @cached_property
    def properties(self) -> Floats:
        """Counts a_i of the measured properties of each group, shape (groups,)."""
        N0 = np.isfinite(self.data.shape).sum(axis=2).astype(float)
        sets = np.maximum((N0 > 0).sum(axis=0), 1)
        count = {"frequency": np.ones(len(self.data.modes)), "shape": N0.sum(axis=0) / sets}
        return np.array([sum(count[kind][r] for kind, r, _ in row) for row in self.members])

    @cached_property
    def members(self) -> list[list[Member]]:
        """The members of each group."""
        modes = self.data.modes
        measured = {
            "frequency": measured_frequencies(self.data),
            "shape": measured_shapes(self.data),
        }
        return [
            [
                (kind, r, group.scale)
                for kind, chosen in (("frequency", group.frequency), ("shape", group.shape))
                for r in members(chosen, modes, measured[kind])
            ]
            for group in self.groups
        ]

    def evaluate(self, theta: Floats, *, derivatives: bool = True) -> Evaluation:
        """Return the objectives at ``theta``, with frequencies, MAC values and pairs kept."""
        try:
            modes, pairs = self.modes(theta, derivatives=derivatives)
        except ModelError:
            return infeasible(theta, len(self.groups))
        residuals = self._residuals(modes, pairs)
        n, p = len(residuals), theta.size
        J = np.array([residual.r @ residual.r for residual in residuals])
        dJ, H = np.zeros((n, p)), np.zeros((n, p, p))
        if derivatives:
            dJ = np.array([2 * residual.r @ residual.dr for residual in residuals])
            H = np.array([2 * residual.dr.T @ residual.dr for residual in residuals])
        quantities = {
            "frequency": modes.frequency[pairs.index],
            "mac": pairs.mac,
            "paired_mode": pairs.index + 1.0,
            "coincident": modes.coincident[pairs.index].astype(float),
        }
        branch = tuple(pairs.index.tolist())
        return Evaluation(theta, J, dJ, H, quantities, residuals if derivatives else (), branch)

    def on_branch(self, branch: tuple[int, ...]) -> UpdatingProblem:
        """Return the problem with these pairs of modes at all parameters."""
        return replace(self, pairs=branch)

    def modes(self, theta: Floats, *, derivatives: bool = True) -> tuple[Modes, Pairs]:
        """Return the model's modes at ``theta`` and which of them belong to the measured ones."""
        count = modes_needed(self.pairing, self.data, self.model.size)
        modes = self.model.modes(theta, count, derivatives=derivatives)
        if self.pairs is not None:
            index = np.array(self.pairs, dtype=np.intp)
            mac = mean_mac(self.data, modes.phi)[np.arange(index.size), index]
            return modes, Pairs(index, mac)
        return modes, match(self.pairing, self.data, modes.frequency, modes.phi)

    def residuals(self, theta: Floats) -> tuple[Residual, ...]:
        """Return the residual vector of each group, with derivatives.

        Raises ModelError where the model has no modes at ``theta``.
        """
        return self._residuals(*self.modes(theta))

    def _residuals(self, modes: Modes, pairs: Pairs) -> tuple[Residual, ...]:
        parts = {
            member: self.residual(modes, pairs, member)
            for member in {member for row in self.members for member in row}
        }
        return tuple(_stack([parts[member] for member in row]) for row in self.members)

    def residual(self, modes: Modes, pairs: Pairs, member: Member) -> Residual:
        """Return the residual vector of one member, data set after data set."""
        kind, r, scale = member
        return (self._frequency if kind == "frequency" else self._shape)(modes, pairs, r, scale)

    def margins(self, eigenvalue: Floats, shape: Floats) -> Floats:
        """Return how far the root of each objective may be off, (groups,).

        ``eigenvalue`` and ``shape`` (measured modes,) are relative errors of the paired modes.
        """
        out = []
        for row in self.members:
            square = 0.0
            for kind, r, scale in row:
                if kind == "frequency":
                    weight, measured = self.weighted_frequencies[r, scale]
                    parts, error = [weight * measured], eigenvalue[r] / 2
                else:
                    parts = [psi for _, _, psi in self.weighted_shapes[r, scale]]
                    error = shape[r]
                square += error**2 * sum(part @ part for part in parts)
            out.append(np.sqrt(square))
        return np.array(out)

    def _frequency(self, modes: Modes, pairs: Pairs, r: int, scale: Scale) -> Residual:
        weight, measured = self.weighted_frequencies[r, scale]
        q = pairs.index[r]
        return Residual(
            (modes.frequency[q] - measured) * weight, weight[:, None] * modes.dfrequency[q]
        )

    def _shape(self, modes: Modes, pairs: Pairs, r: int, scale: Scale) -> Residual:
        q = pairs.index[r]
        phi, dphi = modes.phi[:, q], modes.dphi[:, q]
        return _stack(
            [
                _misfit(psi, weight * phi[at], weight[:, None] * dphi[at])
                for at, weight, psi in self.weighted_shapes[r, scale]
            ]
        )

    @cached_property
    def weighted_frequencies(self) -> dict[tuple[int, Scale], tuple[Floats, Floats]]:
        """Weights (sets,) of the residuals of each frequency, and the measured values."""
        out = {}
        for r, scale in self._chosen("frequency"):
            at = np.isfinite(self.data.frequency[:, r])
            measured = self.data.frequency[at, r]
            unit = measured if scale == "measured" else self.data.frequency_std[at, r]
            weight = 1 / (unit * np.sqrt(measured.size))
            out[r, scale] = weight, measured
        return out

    @cached_property
    def weighted_shapes(self) -> dict[tuple[int, Scale], list[tuple[Ints, Floats, Floats]]]:
        """Sensors, weights and weighted measured components of each shape, for each data set."""
        out: dict[tuple[int, Scale], list[tuple[Ints, Floats, Floats]]] = {}
        for r, scale in self._chosen("shape"):
            measured = np.isfinite(self.data.shape[:, r])
            sets = np.flatnonzero(measured.any(axis=1))
            out[r, scale] = []
            for k in sets:
                at = np.flatnonzero(measured[k])
                psi = self.data.shape[k, r, at]
                if scale == "measured":
                    weight = np.full(psi.size, np.sqrt(psi.size / (psi @ psi)))
                else:
                    weight = 1 / usable_std(self.data.shape_std[k, r, at])
                weight = weight / np.sqrt(sets.size)
                out[r, scale].append((at, weight, weight * psi))
        return out

    def _chosen(self, kind: str) -> set[tuple[int, Scale]]:
        return {(r, scale) for row in self.members for one, r, scale in row if one == kind}


def _misfit(psi: Floats, phi: Floats, dphi: Floats) -> Residual:
    """Return beta phi - psi and its derivatives, with beta the least squares."""
    norm = phi @ phi
    if norm == 0:
        return Residual(-psi, np.zeros(dphi.shape))
    beta = psi @ phi / norm
    dbeta = (psi @ dphi - 2 * beta * (phi @ dphi)) / norm
    return Residual(beta * phi - psi, phi[:, None] * dbeta + beta * dphi)


def usable_std(std: Floats) -> Floats:
    """Return standard deviations with negligible ones replaced by the median of the others.

    Raises ValueError where none is above 0 or one is not known.
    """
    if not np.isfinite(std).all() or not (std > 0).any():
        raise ValueError("standard deviations of all measured components, one of them above 0")
    real = std > NEGLIGIBLE * std.max()
    return np.where(real, std, np.median(std[real]))


def check_std(data: ModalData, kind: str, r: int) -> None:
    """Raise ValueError where the standard deviations of a frequency or shape are not usable."""
    if kind == "shape":
        for values, std in zip(data.shape[:, r], data.shape_std[:, r], strict=True):
            measured = np.isfinite(values)
            if measured.any():
                usable_std(std[measured])
        return
    at = np.isfinite(data.frequency[:, r])
    if not (data.frequency_std[at, r] > NEGLIGIBLE * data.frequency[at, r]).all():
        raise ValueError(f"standard deviations above {NEGLIGIBLE:g} of all measured frequencies")


def updating_problem(
    model: Model,
    data: ModalData,
    groups: Sequence[Group],
    bounds: Mapping[str, tuple[float, float]] | None = None,
    nominal: Mapping[str, float] | None = None,
    pairing: Pairing | None = None,
    *,
    parameters: Sequence[Parameter] = (),
    reduction: Reduction | None = None,
) -> UpdatingProblem:
    """Return the problem of updating a model.

    Its parameters are given as such, in any order, or as bounds and nominal values by their names;
    it is solved in full unless a ``reduction`` says otherwise. Raises ValueError where a parameter
    is not given once, has bounds of no width or a nominal value beyond them, a group has no
    members, or data and model differ in their sensors.
    """
    if data.sensors != model.sensors:
        raise ValueError(f"expected data at sensors {model.sensors}, found {data.sensors}")
    given = parameters or parameters_of(bounds or {}, nominal or {})
    chosen = in_order(given, model.parameters)
    if reduction is not None:
        model = reduction.of(model, data, pairing or Pairing(), chosen)
    return UpdatingProblem(
        model,
        data,
        tuple(groups),
        np.array([each.lower for each in chosen]),
        np.array([each.upper for each in chosen]),
        np.array([each.nominal for each in chosen]),
        pairing or Pairing(),
    )


def _stack(parts: Sequence[Residual]) -> Residual:
    if len(parts) == 1:
        return parts[0]
    return Residual(np.concatenate([x.r for x in parts]), np.concatenate([x.dr for x in parts]))
