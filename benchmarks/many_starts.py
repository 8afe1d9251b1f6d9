r"""Minima of weighted sums from many random starts, for models of a wrong class.

Each sum is minimised by Gauss-Newton from random starts, and the best are followed further. Where
pairs of modes change on the way of a step, the objectives are discontinuous and gradients lead
nowhere: there, an evolution strategy (CMA-ES, Hansen, arXiv:1604.00772) goes on, near and far.
"""

from __future__ import annotations

import warnings

import cma
import numpy as np
from independent import EPSILON, EXACT, Equation, least_squares
from scipy.optimize import lsq_linear

from modefront._typing import Floats

STARTS, SHORT, KEPT = 40, 12, 3
"""Random starts for each weighted sum, iterations of each, and the best that are followed."""

HEAVY = 1e-4
"""Share of the other objectives with which an edge is sought from random starts."""

PROMISED = 1e-3
"""Gain that a Gauss-Newton step promises, over the value, below which a model is a minimum."""

EVOLVED, RUNS, AGREED = 1500, 8, 1e-2
"""Evaluations of an evolution strategy where pairs of modes change; runs at most; difference of
their best two values, over these, up to which there are enough."""

FAR, NEAR = 0.3, 0.03
"""Spreads of an evolution strategy at first: of runs from anywhere, and of one from the best."""


def many_starts(equation: Equation, starts: int = STARTS, seed: int = 0) -> list[Floats]:
    """Return minima of weighted sums from random starts: of each J_i, of all, and towards edges."""
    rng = np.random.default_rng([seed, starts])
    c, unit, out = equation.sizes, np.eye(equation.sizes.size), []
    edges = [(unit[i] + HEAVY * (1 - unit[i])) / c for i in range(c.size)]
    for k, w in enumerate([*edges, *(unit / c), np.ones(c.size), 1 / c]):
        near = []
        for _ in range(starts):
            theta = equation.lower + equation.span * rng.random(equation.span.size)
            theta = least_squares(equation, w, theta, SHORT, 1e-4)
            near.append((float(w @ equation.J(theta)), theta))
        near = [x for x in sorted(near, key=lambda x: x[0]) if np.isfinite(x[0])]
        apart: list[Floats] = []
        for _, theta in near:
            if all(np.abs((theta - x) / equation.span).max() > 1e-2 for x in apart):
                apart.append(theta)
        minima = [least_squares(equation, w, theta, 60, 1e-11) for theta in apart[:KEPT]]
        if any(at_switch(equation, w, theta) for theta in minima):
            minima.append(_by_evolution(equation, w, minima, rng))
        for found in minima:
            out.append(found)
            for epsilon in EPSILON[EPSILON < HEAVY] if k < c.size else ():
                heavy = (unit[k] + epsilon * (1 - unit[k])) / c
                found = least_squares(equation, heavy, found, 25)
                out.append(found)
    return out


def at_switch(equation: Equation, w: Floats, theta: Floats) -> bool:
    """Return whether sum w J would fall from a model, if pairs of modes did not change on the way.

    The objectives are discontinuous there; the least value may be at such a place.
    """
    parts, span, root = equation.parts(theta), equation.span, np.sqrt(w)
    if parts is None:
        return False
    r = np.concatenate([s * part.r for s, part in zip(root, parts, strict=True)])
    dr = np.concatenate([s * part.dr for s, part in zip(root, parts, strict=True)]) * span
    low = (equation.lower - theta) / span
    damped = np.vstack([dr, 1e-3 * np.linalg.norm(dr) * np.eye(span.size)])
    ends = np.minimum(low, 0) - 1e-12, np.maximum(low + 1, 0) + 1e-12
    step = lsq_linear(damped, np.append(-r, np.zeros(span.size)), ends, method="bvls").x
    value, after = float(r @ r), r + dr @ step
    if value <= EXACT * float(w @ equation.sizes) or after @ after > (1 - PROMISED) * value:
        return False
    thetas = theta + span * np.outer(10.0 ** -np.arange(7), step)
    return len({equation.pairs(x) for x in [theta, *thetas]}) > 1


def _by_evolution(
    equation: Equation, w: Floats, known: list[Floats], rng: np.random.Generator
) -> Floats:
    """Return the best model for sum w J of runs from random starts, until two of them agree."""

    def value(theta: Floats) -> float:
        return float(w @ equation.J(theta))

    found: list[Floats] = []
    while len(found) < RUNS:
        theta = equation.lower + equation.span * rng.random(equation.span.size)
        found.append(_evolved(equation, w, theta, FAR))
        found.sort(key=value)
        if len(found) > 1 and value(found[1]) <= (1 + AGREED) * value(found[0]):
            break
    return _evolved(equation, w, min([*found, *known], key=value), NEAR)


def _evolved(equation: Equation, w: Floats, theta: Floats, spread: float) -> Floats:
    """Return a better model for sum w J that an evolution strategy finds, or the same one."""
    options = {"bounds": [0, 1], "seed": 1, "verbose": -9, "maxfevals": EVOLVED, "tolfun": 0}

    def value(z: Floats) -> float:
        return min(float(w @ equation.J(equation.lower + equation.span * z)), 1e30)

    z = np.clip((theta - equation.lower) / equation.span, 0, 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        best = cma.CMAEvolutionStrategy(z, spread, options).optimize(value).result.xbest
    if best is None or value(best) >= value(z):
        return theta
    return least_squares(equation, w, equation.lower + equation.span * np.clip(best, 0, 1), 20)
