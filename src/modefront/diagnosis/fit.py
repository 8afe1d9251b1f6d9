r"""Quick update of the model to the measured modes, by a few Gauss-Newton steps.

A mistake in the data is one only where no update explains them: the nominal model may be as far
from the structure as a reversed sensor makes the data look. So data as they are and data corrected
are both fitted, by

.. math:: J = \sum_r \ln^2 \frac{f_q}{\hat f_r} + \sum_r \|\beta \varphi_q - \psi_r\|^2
   + \mu \sum_j \big((\theta_j - \theta_{0j}) / u_j\big)^2

within the bounds, the pairs taken anew at every step; u are the nominal values, or the ranges
between the bounds where these are 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats, Ints
from modefront.diagnosis.measured import (
    Measured,
    assigned,
    log_frequencies,
    mac_values,
    pair_costs,
)
from modefront.errors import ModelError
from modefront.models.base import Model
from modefront.modes.result import Modes

STEPS = 8
"""Steps, at most."""

PRIOR = 4e-3
"""Weight mu of the distance from the nominal parameters."""

ENOUGH = 1e-3
"""Relative decrease of J below which the steps end."""


@dataclass(frozen=True)
class Fit:
    """Differences between model and measured modes that remain after an update.

    Attributes
    ----------
    costs : (modes,) share of each measured mode in J
    distance : share of the distance from the nominal parameters
    """

    costs: Floats
    distance: float

    @property
    def cost(self) -> float:
        """J."""
        return float(self.costs.sum()) + self.distance


@dataclass(frozen=True, eq=False)
class Updating:
    """A model within its bounds that is fitted to measured modes.

    Attributes
    ----------
    model : gives the modes at the sensors
    count : number of model modes that are looked at
    lower, upper, start : (parameters,) bounds and nominal values
    shift : logarithm of the factor by which all measured frequencies are too great
    """

    model: Model
    count: int
    lower: Floats
    upper: Floats
    start: Floats
    shift: float

    def fit(self, view: Measured) -> Fit | None:
        """Return the best fit of measured modes; None where the nominal model has no modes."""
        theta, damping = self.start, 1e-3
        unit = np.where(self.start != 0, np.abs(self.start), self.upper - self.lower)
        state = self._state(view, theta)
        if state is None:
            return None
        r, dr, mode = state
        away = np.sqrt(PRIOR) / unit
        for _ in range(STEPS):
            G = np.concatenate([dr * unit, np.diag(away * unit)])
            g = np.concatenate([r, away * (theta - self.start)])
            total = float(g @ g)
            H = G.T @ G
            step = np.linalg.solve(H + damping * np.diag(np.diag(H) + 1e-12), -G.T @ g)
            new = np.clip(theta + np.clip(step, -0.5, 0.5) * unit, self.lower, self.upper)
            ahead = self._state(view, new)
            drift = away * (new - self.start)
            value = np.inf if ahead is None else float(ahead[0] @ ahead[0] + drift @ drift)
            if ahead is None or value >= total:
                damping = max(10 * damping, 1e-2)
                if damping > 1e3:
                    break
                continue
            theta, (r, dr, mode), damping = new, ahead, damping / 5
            if total - value < ENOUGH * total:
                break
        costs = np.bincount(mode, r**2, minlength=view.log_frequency.size).astype(float)
        drift = away * (theta - self.start)
        return Fit(costs, float(drift @ drift))

    def _state(self, view: Measured, theta: Floats) -> tuple[Floats, Floats, Ints] | None:
        """Return residuals, their derivatives and the measured mode of each."""
        try:
            modes = self.model.modes(theta, self.count)
        except ModelError:
            return None
        logs = log_frequencies(modes.frequency)
        values = mac_values(view.psi, view.seen, modes.phi)
        index, _ = assigned(pair_costs(values, view.log_frequency, logs, self.shift))
        r, dr, mode = _residuals(view, modes, index, self.shift)
        if not (np.isfinite(r).all() and np.isfinite(dr).all()):
            return None
        return r, dr, mode


def _residuals(
    view: Measured, modes: Modes, index: Ints, shift: float
) -> tuple[Floats, Floats, Ints]:
    """Return residuals (rows,), their derivatives (rows, parameters) and measured modes (rows,)."""
    f = modes.frequency
    known = np.isfinite(view.log_frequency) & (f[index] > 1e-6 * f.max())
    parts = [np.log(f[index[known]]) - view.log_frequency[known] + shift]
    slopes = [modes.dfrequency[index[known]] / f[index[known], None]]
    owners = [np.flatnonzero(known)]
    usable = (view.seen.sum(axis=2) > 1) & (view.psi != 0).any(axis=2)
    share = 1 / np.sqrt(np.maximum(usable.sum(axis=0), 1))
    for k, i in np.argwhere(usable).tolist():
        seen = view.seen[k, i]
        chi, dchi = modes.phi[seen, index[i]], modes.dphi[seen, index[i]]
        psi, b = view.psi[k, i, seen], float(chi @ chi)
        owners.append(np.full(psi.size, i))
        if b == 0:
            parts.append(share[i] * psi)
            slopes.append(np.zeros(dchi.shape))
            continue
        beta = psi @ chi / b
        dbeta = (psi @ dchi - 2 * beta * (chi @ dchi)) / b
        parts.append(share[i] * (beta * chi - psi))
        slopes.append(share[i] * (np.outer(chi, dbeta) + beta * dchi))
    return np.concatenate(parts), np.concatenate(slopes), np.concatenate(owners)
