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

An objective is the sum over the members of its group. Its count :math:`a_i` of measured
properties is one for a frequency and :math:`N_0` (mean over data sets) for a shape.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.errors import ModelError
from modefront.models.base import Model
from modefront.modes.result import Modes
from modefront.pairing.match import Pairing, Pairs, match, modes_needed
from modefront.residuals.groups import Group, measured_frequencies, measured_shapes, members
from modefront.solvers.problem import Evaluation, infeasible


@dataclass(frozen=True)
class Residual:
    """A vector r (rows,) with its derivatives (rows, parameters)."""

    r: Floats
    dr: Floats


@dataclass(frozen=True)
class UpdatingProblem:
    """Objectives of a model, measured data and groups; see `modefront.solvers.problem.Problem`.

    ``lower``, ``upper`` and ``start`` are the bounds and the nominal values of the parameters.
    Raises ValueError for a group without members.
    """

    model: Model
    data: ModalData
    groups: tuple[Group, ...]
    lower: Floats
    upper: Floats
    start: Floats
    pairing: Pairing = field(default_factory=Pairing)

    def __post_init__(self) -> None:
        for group, row in zip(self.groups, self._members, strict=True):
            if not row:
                raise ValueError(f"group '{group.name}': at least one member, found none")

    @property
    def objectives(self) -> tuple[str, ...]:
        """Names of the groups."""
        return tuple(group.name for group in self.groups)

    @property
    def counts(self) -> Mapping[str, int]:
        """Eigenproblems solved so far."""
        return {"eigenproblems": self.model.counts.eigenproblems}

    @cached_property
    def properties(self) -> Floats:
        """Counts a_i of the measured properties of each group, shape (groups,)."""
        N0 = np.isfinite(self.data.shape).sum(axis=2).astype(float)
        sets = np.maximum((N0 > 0).sum(axis=0), 1)
        count = {"frequency": np.ones(len(self.data.modes)), "shape": N0.sum(axis=0) / sets}
        return np.array([sum(count[kind][r] for kind, r in row) for row in self._members])

    @cached_property
    def _members(self) -> list[list[tuple[str, int]]]:
        modes = self.data.modes
        measured = {
            "frequency": measured_frequencies(self.data),
            "shape": measured_shapes(self.data),
        }
        return [
            [("frequency", r) for r in members(group.frequency, modes, measured["frequency"])]
            + [("shape", r) for r in members(group.shape, modes, measured["shape"])]
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
        return Evaluation(theta, J, dJ, H, quantities)

    def modes(self, theta: Floats, *, derivatives: bool = True) -> tuple[Modes, Pairs]:
        """Return the model's modes at ``theta`` and which of them belong to the measured ones."""
        count = modes_needed(self.pairing, self.data, self.model.size)
        modes = self.model.modes(theta, count, derivatives=derivatives)
        return modes, match(self.pairing, self.data, modes.frequency, modes.phi)

    def residuals(self, theta: Floats) -> tuple[Residual, ...]:
        """Return the residual vector of each group, with derivatives.

        Raises ModelError where the model has no modes at ``theta``.
        """
        return self._residuals(*self.modes(theta))

    def _residuals(self, modes: Modes, pairs: Pairs) -> tuple[Residual, ...]:
        parts = {
            member: self._frequency(modes, pairs, member[1])
            if member[0] == "frequency"
            else self._shape(modes, pairs, member[1])
            for member in {member for row in self._members for member in row}
        }
        return tuple(_stack([parts[member] for member in row]) for row in self._members)

    def _frequency(self, modes: Modes, pairs: Pairs, r: int) -> Residual:
        measured = self.data.frequency[:, r]
        measured = measured[np.isfinite(measured)]
        scale = 1 / (measured * np.sqrt(measured.size))
        q = pairs.index[r]
        return Residual(
            (modes.frequency[q] - measured) * scale, np.outer(scale, modes.dfrequency[q])
        )

    def _shape(self, modes: Modes, pairs: Pairs, r: int) -> Residual:
        measured = np.isfinite(self.data.shape[:, r])
        sets = np.flatnonzero(measured.any(axis=1))
        q = pairs.index[r]
        parts = []
        for k in sets:
            at = measured[k]
            psi, phi, dphi = self.data.shape[k, r, at], modes.phi[at, q], modes.dphi[at, q]
            scale = np.sqrt(psi.size / (psi @ psi) / sets.size)
            norm = phi @ phi
            if norm == 0:
                parts.append(Residual(-scale * psi, np.zeros(dphi.shape)))
                continue
            beta = psi @ phi / norm
            dbeta = (psi @ dphi - 2 * beta * (phi @ dphi)) / norm
            parts.append(
                Residual(scale * (beta * phi - psi), scale * (np.outer(phi, dbeta) + beta * dphi))
            )
        return _stack(parts)


def updating_problem(
    model: Model,
    data: ModalData,
    groups: Sequence[Group],
    bounds: Mapping[str, tuple[float, float]],
    nominal: Mapping[str, float],
    pairing: Pairing | None = None,
) -> UpdatingProblem:
    """Return the problem of updating a model, with bounds and nominal values by parameter name.

    Raises ValueError where a parameter has no bounds or no nominal value within them, a group
    has no members, or data and model differ in their sensors.
    """
    if data.sensors != model.sensors:
        raise ValueError(f"expected data at sensors {model.sensors}, found {data.sensors}")
    for name in model.parameters:
        if name not in bounds or name not in nominal:
            raise ValueError(f"expected bounds and a nominal value of '{name}', found none")
        if not bounds[name][0] <= nominal[name] <= bounds[name][1]:
            raise ValueError(f"expected '{name}' within {bounds[name]}, found {nominal[name]}")
    return UpdatingProblem(
        model,
        data,
        tuple(groups),
        np.array([bounds[name][0] for name in model.parameters], dtype=float),
        np.array([bounds[name][1] for name in model.parameters], dtype=float),
        np.array([nominal[name] for name in model.parameters], dtype=float),
        pairing or Pairing(),
    )


def _stack(parts: Sequence[Residual]) -> Residual:
    return Residual(np.concatenate([x.r for x in parts]), np.concatenate([x.dr for x in parts]))
