r"""Sensitivities of the measured modes to the parameters, and what to fix or to group.

The table has :math:`(\theta_j / f_r)\, \partial f_r / \partial \theta_j`, the change of a frequency
in percent for one percent of a parameter, and the change of all shapes together,
:math:`(\sum_r \|\theta_j\, \partial \varphi_r / \partial \theta_j\|^2 / \|\varphi_r\|^2)^{1/2}`,
each at the sensors and without the change of scale. Parameters with 0 among their values are
changed by a hundredth of their range instead.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from modefront._typing import Floats
from modefront.identifiability.combinations import WEAK, decompose, optimal_weights, without_effect
from modefront.identifiability.scale import scale_at
from modefront.residuals.problem import UpdatingProblem

ALIKE = 0.98
"""Cosine of the changes that two parameters make from which on they are grouped."""


@dataclass(frozen=True)
class Sensitivities:
    """Sensitivities of the measured modes to each parameter.

    Attributes
    ----------
    parameters : names
    modes : measured modes
    frequency : (parameters, modes) percent of the frequency for a percent of the parameter
    shape : (parameters,) percent of all shapes together
    advice : for each parameter "fix", "group with NAME" or nothing
    """

    parameters: tuple[str, ...]
    modes: tuple[int, ...]
    frequency: Floats
    shape: Floats
    advice: tuple[str, ...]


def sensitivities(problem: UpdatingProblem) -> Sensitivities:
    """Return the sensitivities at the nominal parameters.

    Raises ModelError where the model has no modes there.
    """
    modes, pairs = problem.modes(problem.start)
    index = pairs.index
    positive = problem.lower > 0
    unit = np.where(positive, problem.start, (problem.upper - problem.lower))
    f = modes.frequency[index]
    slope = modes.dfrequency[index].T * unit[:, None]
    frequency = np.divide(slope, f, out=np.zeros(slope.shape), where=f > 0)
    phi, dphi = modes.phi[:, index], modes.dphi[:, index] * unit
    square = (phi**2).sum(axis=0)
    along = np.divide(
        np.einsum("sr,srj->rj", phi, dphi),
        square[:, None],
        out=np.zeros(dphi.shape[1:]),
        where=square[:, None] > 0,
    )
    change = ((dphi - phi[:, :, None] * along) ** 2).sum(axis=0)
    share = np.divide(
        change, square[:, None], out=np.zeros(change.shape), where=square[:, None] > 0
    )
    shape = np.sqrt(np.asarray(share.sum(axis=0)))
    return Sensitivities(
        problem.model.parameters, problem.data.modes, frequency, shape, tuple(advice(problem))
    )


def advice(problem: UpdatingProblem) -> list[str]:
    """Return which parameters to fix or to group, because the data do not determine them.

    Parameters without effect are fixed. Of those that act alike, the later ones are grouped with
    the first. Of the rest, the parameters of which the others leave least, as long as some
    combination is hardly determined (singular value below 1 % of the greatest).
    """
    names = problem.model.parameters
    out = [""] * len(names)
    nominal, scale = problem.evaluate(problem.start), scale_at(problem, problem.start)
    for j in without_effect(problem, nominal, scale):
        out[j] = "fix: no effect"
    roots = np.sqrt(optimal_weights(problem.properties, nominal.J))
    residuals = problem.residuals(problem.start)
    G = (
        np.concatenate([w * residual.dr for w, residual in zip(roots, residuals, strict=True)])
        * scale.unit
    )
    size = np.linalg.norm(G, axis=0)
    kept = [j for j in range(len(names)) if not out[j] and size[j] > 0]
    for position, j in enumerate(kept):
        for i in kept[:position]:
            if not out[i] and abs(G[:, i] @ G[:, j]) > ALIKE * size[i] * size[j]:
                out[j] = f"group with {names[i]}"
                break
    kept = [j for j in kept if not out[j]]
    for j in _superfluous(G, kept):
        out[j] = "fix: not determined"
    return out


def _superfluous(G: Floats, kept: Sequence[int]) -> list[int]:
    """Return the columns of G to leave out so that all combinations of the rest are determined."""
    if not kept:
        return []
    order = scipy.linalg.qr(G[:, kept], mode="r", pivoting=True)[1]
    chosen = [kept[int(i)] for i in order]
    out: list[int] = []
    while len(chosen) > 1 and decompose(G[:, chosen])[-1].share < WEAK:
        out.append(chosen.pop())
    return out
