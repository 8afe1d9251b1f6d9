r"""What errors of measurement do to the objectives and to their derivatives.

Errors of the data change :math:`J_i` and :math:`\partial J_i` at fixed parameters. To first order
both are sums over independent sources m of standard deviation one,

.. math:: \delta J_i = \sum_m \varepsilon_m \, \delta_m J_i , \qquad
    \delta\, \partial J_i = \sum_m \varepsilon_m \, \delta_m \partial J_i .

**From standard deviations** of the measured values y, each value is a source:
:math:`\delta_m J_i = \sigma_m \partial J_i / \partial y_m`. Per data set, with :math:`K_r` sets
that measured the mode, :math:`\psi` the measured shape, :math:`c = \psi^T \varphi`,
:math:`a = \psi^T \psi` and :math:`b = \varphi^T \varphi`,

.. math:: J_\omega = \frac1{K_r} \Big(\frac{f}{y} - 1\Big)^2, \qquad
    J_\varphi = \frac{N_0}{K_r} \Big(1 - \frac{c^2}{a b}\Big) ,

or, of residuals over standard deviations, :math:`(f - y)^2 / (K_r \sigma^2)` and
:math:`(a - c^2 / b) / K_r` with both shapes over :math:`\sigma`. A value without a standard
deviation counts as exact.

**From several data sets**, each set is a source: the objectives are means over sets, and a mean has
the variance of its terms over their number,

.. math:: \delta_k J_r = \frac{J_{r,k} - J_r}{\sqrt{K_r (K_r - 1)}}

(the infinitesimal jackknife; Efron 1982, doi:10.1137/1.9781611970319, chapter 6). Nothing is
assumed of how errors within a set depend on each other; a mode measured once counts as exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.modes.result import Modes
from modefront.pairing.match import Pairs
from modefront.residuals.groups import Scale
from modefront.residuals.problem import UpdatingProblem, usable_std
from modefront.work.codec import record

Source = Literal["std", "sets"]
"""Where the uncertainty of the data is taken from."""


@record
@dataclass(frozen=True)
class Noise:
    """Changes of the objectives, (sources, n), and of their derivatives, (sources, n, p)."""

    J: Floats
    dJ: Floats


def available(data: ModalData) -> tuple[Source, ...]:
    """Return what tells the uncertainty of data."""
    std = (data.frequency_std > 0).any() or (data.shape_std > 0).any()
    frequencies = np.isfinite(data.frequency).sum(axis=0)
    shapes = np.isfinite(data.shape).any(axis=2).sum(axis=0)
    sets = max(frequencies.max(), shapes.max()) > 1
    return (*(("std",) if std else ()), *(("sets",) if sets else ()))


def noise(problem: UpdatingProblem, theta: Floats, source: Source) -> Noise:
    """Return what errors of the data do at ``theta``; solves one eigenproblem.

    Raises ModelError where the model has no modes there.
    """
    modes, pairs = problem.modes(theta)
    return (_from_std if source == "std" else _from_sets)(problem, modes, pairs)


def noise_floor(problem: UpdatingProblem, source: Source) -> Floats:
    r"""Return the objectives (n,) that errors of the data alone would cause, of a perfect model.

    They are sums of the variances of the residuals: :math:`\sigma^2` over the same units, or, from
    several data sets, the variance of single sets about their mean. Errors along a shape count as
    its scale: no residual has them. A group of which no error is known has 0.
    """
    out = np.zeros(len(problem.groups))
    for i, row in enumerate(problem.members):
        for kind, r, scale in row:
            part = _frequency_floor if kind == "frequency" else _shape_floor
            out[i] += part(problem, r, scale, source)
    return out


def _frequency_floor(problem: UpdatingProblem, r: int, scale: Scale, source: Source) -> float:
    weight, measured = problem.weighted_frequencies[r, scale]
    if source == "std":
        std = problem.data.frequency_std[np.isfinite(problem.data.frequency[:, r]), r]
        return float(((weight * np.where(std > 0, std, 0.0)) ** 2).sum())
    if measured.size < 2:
        return 0.0
    return float((weight**2).sum() * measured.var(ddof=1))


def _shape_floor(problem: UpdatingProblem, r: int, scale: Scale, source: Source) -> float:
    data, parts = problem.data, problem.weighted_shapes[r, scale]
    seen = np.isfinite(data.shape[:, r])
    sets = np.flatnonzero(seen.any(axis=1))
    if source == "std":
        out = 0.0
        for k, (at, weight, psi) in zip(sets, parts, strict=True):
            std = data.shape_std[k, r, at]
            variance = (weight * np.where(std > 0, std, 0.0)) ** 2
            out += float(variance @ (1 - psi**2 / (psi @ psi)))
        return out
    common = np.asarray(seen[sets].all(axis=0))
    if sets.size < 2 or common.sum() < 2:
        return 0.0
    # Shapes of any scale and sign: each is brought to the first by least squares.
    values = data.shape[sets, r][:, common]
    factor = (values @ values[0]) / (values**2).sum(axis=1)
    mean = factor @ values
    out = 0.0
    for at, weight, psi in parts:
        own, phi = psi[common[at]], weight[common[at]] * mean
        away = own - (own @ phi) / (phi @ phi) * phi
        out += float((away @ away) * (psi @ psi) / (own @ own))
    return out * sets.size / (sets.size - 1)


def _from_std(problem: UpdatingProblem, modes: Modes, pairs: Pairs) -> Noise:
    data = problem.data
    K, R, S = data.shape.shape
    n, p = len(problem.groups), len(problem.model.parameters)
    J, dJ = np.zeros((K, R, 1 + S, n)), np.zeros((K, R, 1 + S, n, p))
    for i, row in enumerate(problem.members):
        for kind, r, scale in row:
            q = pairs.index[r]
            if kind == "frequency":
                sets = np.flatnonzero(np.isfinite(data.frequency[:, r]))
                for k in sets:
                    y, std = data.frequency[k, r], data.frequency_std[k, r]
                    own = _of_frequency(modes.frequency[q], modes.dfrequency[q], y, std, scale)
                    _add(J[k, r, :1, i], dJ[k, r, :1, i], own, np.array([std]), sets.size)
                continue
            seen = np.isfinite(data.shape[:, r])
            sets = np.flatnonzero(seen.any(axis=1))
            for k in sets:
                at, std = seen[k], data.shape_std[k, r, seen[k]]
                own = _of_shape(
                    modes.phi[at, q], modes.dphi[at, q], data.shape[k, r, at], std, scale
                )
                rows = 1 + np.flatnonzero(at)
                part, dpart = np.zeros(rows.size), np.zeros((rows.size, p))
                _add(part, dpart, own, std, sets.size)
                J[k, r, rows, i] += part
                dJ[k, r, rows, i] += dpart
    J, dJ = J.reshape(-1, n), dJ.reshape(-1, n, p)
    used = J.any(axis=1) | dJ.any(axis=(1, 2))
    return Noise(J[used], dJ[used])


def _add(J: Floats, dJ: Floats, own: tuple[Floats, Floats], std: Floats, sets: int) -> None:
    """Add derivatives with respect to measured values, times their standard deviations."""
    size = np.where(std > 0, std, 0.0) / sets
    J += own[0] * size
    dJ += own[1] * size[:, None]


def _of_frequency(
    f: float, df: Floats, y: float, std: float, scale: Scale
) -> tuple[Floats, Floats]:
    """Return d/dy of J and of dJ, shapes (1,) and (1, p), for one data set."""
    if scale == "std":
        return np.array([-2 * (f - y) / std**2]), -2 * df[None] / std**2
    return np.array([-2 * (f / y - 1) * f / y**2]), -2 * df[None] / y**2 * (2 * f / y - 1)


def _of_shape(
    phi: Floats, dphi: Floats, psi: Floats, std: Floats, scale: Scale
) -> tuple[Floats, Floats]:
    """Return d/dpsi of J and of dJ, shapes (sensors,) and (sensors, p), for one data set."""
    if scale == "std":
        s = usable_std(std)
        phi, dphi, psi = phi / s, dphi / s[:, None], psi / s
    c, a, b = psi @ phi, psi @ psi, phi @ phi
    dc, db = psi @ dphi, 2 * phi @ dphi
    projection = c * phi / b
    dprojection = (np.outer(phi, dc) + c * dphi) / b - np.outer(projection, db) / b
    if scale == "std":
        return 2 * (psi - projection) / s, -2 * dprojection / s[:, None]
    share = c**2 / (a * b)
    dshare = 2 * c * dc / (a * b) - share * db / b
    factor = -2 * psi.size / a
    return factor * (projection - share * psi), factor * (dprojection - np.outer(psi, dshare))


def _from_sets(problem: UpdatingProblem, modes: Modes, pairs: Pairs) -> Noise:
    data = problem.data
    n, p = len(problem.groups), len(problem.model.parameters)
    J, dJ = np.zeros((len(data.sets), n)), np.zeros((len(data.sets), n, p))
    for i, row in enumerate(problem.members):
        for member in row:
            kind, r, _ = member
            values = data.frequency[:, r, None] if kind == "frequency" else data.shape[:, r]
            rows = np.isfinite(values).sum(axis=1)
            sets = np.flatnonzero(rows)
            K = sets.size
            if K < 2:
                continue
            residual = problem.residual(modes, pairs, member)
            of = np.repeat(sets, rows[sets])
            own = np.array([K * _square(residual.r[of == k]) for k in sets])
            slope = np.array([2 * K * residual.r[of == k] @ residual.dr[of == k] for k in sets])
            J[sets, i] += (own - own.mean()) / np.sqrt(K * (K - 1))
            dJ[sets, i] += (slope - slope.mean(axis=0)) / np.sqrt(K * (K - 1))
    return Noise(J, dJ)


def _square(r: Floats) -> float:
    return float(r @ r)
