"""Conditions of each kind of programme on the changes of its solution, and when these are valid.

Linearised (`modefront.uncertainty.scatter`), they are valid as long as no active set changes and
the solution remains the same minimum: in doubt where one of these is within a standard deviation.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from modefront._typing import Floats
from modefront.front.subproblems import RHO, active_bounds
from modefront.optim.problem import Evaluation
from modefront.uncertainty.noise import Noise


class LinearisationWarning(Enum):
    """Reason why the linearised scatter of a point may not be valid."""

    SADDLE = "the second derivatives are not positive definite: the front folds or jumps there"
    MEETS = "a parameter reaches its bound within one standard deviation"
    LEAVES = "a parameter leaves its bound within one standard deviation"
    SWITCHES = "other groups determine the point within one standard deviation"
    ENDS = "a branch of the front ends within one standard deviation"
    RIVAL = "another minimum becomes better within one standard deviation"
    UNSOLVED = "the solution has not converged"


def std(changes: Floats) -> Floats:
    """Return the standard deviations over the sources, which are the first dimension."""
    return np.asarray(np.sqrt((changes**2).sum(axis=0)))


@dataclass(frozen=True)
class Conditions:
    r"""Conditions of a programme on the changes: C dtheta + D dw - e dtau = f, e^T dw = h.

    Arrays are C (n, p), D (n,), a diagonal of ones and zeros, f (sources, n), and e (n, k), h
    (sources, k) with k either 0 or 1. D is 0 for equations. ``switch`` tells of dw, of the changes
    of J at this solution's data and of dtau, whether errors of one standard deviation change the
    active set.
    """

    C: Floats
    D: Floats
    e: Floats
    f: Floats
    h: Floats
    switch: Callable[[Floats, Floats, Floats], bool] = lambda _, __, ___: False


def _open(C: Floats, D: Floats, f: Floats) -> Conditions:
    return Conditions(C, D, np.zeros((len(D), 0)), f, np.zeros((len(f), 0)))


def given_weights(noise: Noise) -> Conditions:
    """Return the conditions of weights that stay."""
    _, n, p = noise.dJ.shape
    return _open(np.zeros((n, p)), np.ones(n), np.zeros(noise.J.shape))


def optimal_weights(point: Evaluation, a: Floats, noise: Noise) -> Conditions:
    """Return the conditions of w = a / J."""
    second = a / point.J**2
    return _open(second[:, None] * point.dJ, np.ones(a.size), -second * noise.J)


def level(point: Evaluation, objective: int, dv: Floats, noise: Noise) -> Conditions:
    """Return the conditions of the least of the others at J_objective = v; dv is (sources,)."""
    is_held = np.arange(point.J.size) == objective
    f = np.zeros(noise.J.shape)
    f[:, objective] = dv - noise.J[:, objective]
    return _open(is_held[:, None] * point.dJ, (~is_held).astype(float), f)


@dataclass(frozen=True)
class Target:
    """The simplex of normal-boundary intersection, and its changes with the data.

    Attributes
    ----------
    utopia, dutopia : (n,) and (sources, n) the least objectives
    P, dP : (n, n) and (sources, n, n) the corners above them, one column each
    """

    utopia: Floats
    P: Floats
    dutopia: Floats
    dP: Floats


def simplex(E: Floats, dE: Floats, top: Floats | None = None) -> Target:
    """Return the simplex between edges, or that of the ranges up to ``top`` (n,), which stay.

    E (n, n) has a column an edge, which changes by dE (sources, n, n).
    """
    utopia, dutopia = np.diag(E), np.einsum("mii->mi", dE)
    if top is None:
        return Target(utopia, E - utopia[:, None], dutopia, dE - dutopia[:, :, None])
    return Target(utopia, np.diag(top - utopia), dutopia, -dutopia[:, :, None] * np.eye(top.size))


# 6 arguments: those of the problem, and what is solved.
def boundary(
    point: Evaluation,
    w: Floats,
    target: Target,
    beta: Floats,
    noise: Noise,
    equations: bool = False,
) -> tuple[Floats, Conditions]:
    """Return the weights in their right size and the conditions of a point of NBI.

    ``beta`` (n,) is the point of the simplex that it was projected from, by the ``equations`` of
    Das & Dennis or with bounds.
    """
    n = target.P.sum(axis=1)
    dn = target.dP.sum(axis=2)
    active = np.ones(n.size, dtype=np.bool_) if equations else active_bounds(w * n)
    w = w / (w[active] @ n[active])
    above = point.J - target.utopia - target.P @ beta  # n c
    tau = float((above / n)[active].mean())
    moved = target.dutopia + target.dP @ (beta + tau) - noise.J
    f = np.where(active, moved, -RHO * dn / n**2)
    e = np.where(active, n, 0.0)[:, None]
    h = -(dn[:, active] @ w[active])[:, None]
    slack = tau * n - above

    def switch(dw: Floats, dJ: Floats, dtau: Floats) -> bool:
        hardly = w * n - RHO <= std(dw * n + w * dn)
        close = slack <= std(moved - dJ + dtau * n)
        return bool(np.where(active, hardly, close).any())

    fixed = {} if equations else {"switch": switch}
    return w, Conditions(active[:, None] * point.dJ, (~active).astype(float), e, f, h, **fixed)
