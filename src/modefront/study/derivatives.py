r"""Derivatives of the residuals against finite differences, with the likely cause of differences.

Central differences along directions d with two steps are extrapolated,

.. math:: \frac{4\,\Delta(h/2) - \Delta(h)}{3}, \qquad
    \Delta(h) = \frac{r(\theta + h d) - r(\theta - h d)}{2 h} .

A direction is one parameter; of many parameters, several are changed together. The residuals are
compared, and not the objectives, whose derivatives cancel near a minimum; modes keep their pairs. A
step changes the residuals by a given small amount, root mean square: steps that follow narrow
bounds, or the length of many residuals together, would drown in rounding, and those that follow
wide ones see no tangent.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.pairing.match import Pairs
from modefront.residuals.problem import UpdatingProblem
from modefront.rounding import TINY

AGREEMENT = 1e-5
"""Greatest relative error of derivatives that finite differences explain."""

STEP = 2e-3
"""Change of a residual in its own unit, root mean square, that a finite difference makes."""

SHARE = 0.02
"""Share of a parameter, or of its range where it is zero, that a step takes at most."""

MOST = 60
"""Directions in which derivatives are compared, at most."""


@dataclass(frozen=True)
class Agreement:
    """Agreement of derivatives with finite differences.

    Attributes
    ----------
    error : greatest difference over the greatest derivative of the residuals of a group; NaN where
        the model is not defined around the point
    theta : the point
    objective : number of the group with this difference
    step : (p,) change of the parameters for a difference, in the direction with this difference
    """

    error: float
    theta: Floats
    objective: int
    step: Floats


def compared(problem: UpdatingProblem) -> Agreement:
    """Return the agreement of the derivatives of the residuals near the nominal parameters.

    Where bounds leave no room for a step, it leaves them.
    """
    span = problem.upper - problem.lower
    squares = np.einsum("ijj->ij", problem.evaluate(problem.start).H) / 2
    size = np.sqrt((squares / problem.properties[:, None]).max(axis=0))
    most = SHARE / STEP * np.where(problem.start != 0, np.abs(problem.start), span)
    unit = np.minimum(np.divide(1.0, size, out=span.copy(), where=size > 0), most)
    room = np.minimum(STEP * unit, span / 2)
    theta = np.clip(problem.start, problem.lower + room, problem.upper - room)
    evaluation = problem.evaluate(theta)
    directions = _directions(unit)
    if not evaluation.feasible:
        return Agreement(float("nan"), theta, 0, STEP * directions[0])
    _, pairs = problem.modes(theta, derivatives=False)
    exact = [residual.dr @ directions.T for residual in evaluation.residuals]
    scale = [float(np.linalg.norm(x, axis=0).max()) or 1.0 for x in exact]
    error = np.empty((len(exact), len(directions)))
    for column, d in enumerate(directions):
        slopes = _slopes(problem, pairs, theta, d)
        error[:, column] = [
            np.linalg.norm(slope - x[:, column]) / size
            for slope, x, size in zip(slopes, exact, scale, strict=True)
        ]
    i, k = np.unravel_index(int(np.argmax(error)), error.shape)  # the first NaN, if there is any
    return Agreement(float(error[i, k]), theta, int(i), STEP * directions[k])


def _directions(unit: Floats) -> Floats:
    """Return directions (k, p), one a parameter, or several parameters together."""
    count = min(len(unit), MOST)
    out = np.zeros((count, len(unit)))
    signs = np.random.default_rng(0).choice((-1.0, 1.0), len(unit))
    place = np.arange(len(unit)) % count
    together = np.bincount(place)[place]
    out[place, np.arange(len(unit))] = unit * np.where(together > 1, signs / np.sqrt(together), 1)
    return out


def _slopes(
    problem: UpdatingProblem, pairs: Pairs, theta: Floats, direction: Floats
) -> list[Floats]:
    """Return the slopes of the residuals of pairs, with a shorter step where the model needs one.

    NaN where the model is not defined with the shortest.
    """

    def changed(h: float) -> list[Floats]:
        modes, _ = problem.modes(theta + h * direction, derivatives=False)
        return problem.vectors(modes, pairs)

    for h in (STEP, STEP / 8, STEP / 64):
        try:
            half, whole = (
                [(a - b) / (2 * k) for a, b in zip(changed(k), changed(-k), strict=True)]
                for k in (h / 2, h)
            )
            return [(4 * x - y) / 3 for x, y in zip(half, whole, strict=True)]
        except ModelError:
            continue
    return [np.full(1, np.nan) for _ in problem.groups]


def cause_of(problem: UpdatingProblem, agreement: Agreement) -> str:
    """Return which parameter and mode derivatives are wrong for, and the likely cause."""
    names = [problem.model.parameters[j] for j in np.flatnonzero(agreement.step)]
    of = ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
    theta, step = agreement.theta, agreement.step
    for point in (theta, theta + step, theta - step):
        try:
            problem.modes(point, derivatives=False)
        except ModelError as error:
            return f"for {of}: a small change leads to no model: {error}; check its value and units"
    group = problem.objectives[agreement.objective]
    mode, why = _mode_and_cause(problem, theta, step)
    return (
        f"of group '{group}' for {of}, mostly by measured mode {mode} "
        f"(relative {agreement.error:.1e}): {why}"
    )


def _mode_and_cause(problem: UpdatingProblem, theta: Floats, step: Floats) -> tuple[int, str]:
    """Return the measured mode that changes least smoothly, and what that is likely due to."""
    points = [problem.evaluate(theta + k * step, derivatives=False) for k in (-1, -0.5, 0, 0.5, 1)]
    values = {name: np.array([x.quantities[name] for x in points]) for name in ("frequency", "mac")}
    bend = np.zeros(len(problem.data.modes))
    for of in values.values():
        # Fourth differences: what is left of a smooth curve is close to nothing.
        fourth = of[0] - 4 * of[1] + 6 * of[2] - 4 * of[3] + of[4]
        bend = np.maximum(bend, np.abs(np.nan_to_num(fourth / np.abs(of[2]).clip(TINY))))
    r = int(np.argmax(bend))
    mode = problem.data.modes[r]
    frequency = np.sort(problem.modes(theta, derivatives=False)[0].frequency)
    k = int(points[2].quantities["paired_mode"][r]) - 1
    near = [abs(frequency[i] / frequency[k] - 1) for i in (k - 1, k + 1) if 0 <= i < len(frequency)]
    if frequency[k] > 0 and near and min(near) < 1e-3:
        return mode, (
            f"model mode {k + 1} and its neighbour are {100 * min(near):.2g} % apart, and close "
            "modes turn into each other within a small change of the parameter"
        )
    effects = np.sqrt(np.einsum("ijj->j", problem.evaluate(theta).H) / 2) * np.abs(theta)
    known = effects[effects > 0]
    if known.size and known.max() > 1e12 * known.min():
        return mode, (
            f"parameters differ by {known.max() / known.min():.0e} in their effect: check units "
            "of the matrices, and whether a stiffness vanishes"
        )
    if (np.abs(step) > np.abs(theta) + TINY).any():
        return mode, (
            "the parameter has so little effect that a step beyond its own size is needed to see "
            "any: check its value, its units, and whether a stiffness vanishes"
        )
    return mode, (
        "the model does not change smoothly there, or digits are lost in it: check its units, and "
        "whether a stiffness or mass vanishes; derivatives of a Python model have to be those of "
        "its matrices"
    )
