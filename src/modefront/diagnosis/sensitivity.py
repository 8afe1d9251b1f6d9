r"""Sensitivities of the measured modes to the parameters, and which of these to fix.

The table has :math:`(\theta_j / f_r)\, \partial f_r / \partial \theta_j`, the change of a frequency
in percent for one percent of a parameter, and the change of all shapes together,
:math:`(\sum_r \|\theta_j\, \partial \varphi_r / \partial \theta_j\|^2 / \|\varphi_r\|^2)^{1/2}`,
each at the sensors and without the change of scale. Parameters with 0 among their values are
changed by a hundredth of their range instead.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from modefront._typing import Floats
from modefront.identifiability.combinations import WEAK, decompose, optimal_weights, without_effect
from modefront.identifiability.scale import scale_at
from modefront.residuals.problem import UpdatingProblem


@dataclass(frozen=True)
class Sensitivities:
    """Sensitivities of the measured modes to each parameter.

    Attributes
    ----------
    parameters : names
    modes : measured modes
    frequency : (parameters, modes) percent of the frequency for a percent of the parameter
    shape : (parameters,) percent of all shapes together
    superfluous : parameters to fix, so that the data determine the others
    """

    parameters: tuple[str, ...]
    modes: tuple[int, ...]
    frequency: Floats
    shape: Floats
    superfluous: tuple[str, ...]


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
    names = problem.model.parameters
    fixed = tuple(names[j] for j in superfluous(problem))
    return Sensitivities(names, problem.data.modes, frequency, shape, fixed)


def superfluous(problem: UpdatingProblem) -> list[int]:
    """Return the parameters with an effect of which the others leave least.

    Without them no combination is hardly determined (singular value below 1 % of the greatest).
    """
    nominal, scale = problem.evaluate(problem.start), scale_at(problem, problem.start)
    idle = without_effect(problem, nominal, scale)
    roots = np.sqrt(optimal_weights(problem.properties, nominal.J))
    residuals = zip(roots, problem.residuals(problem.start), strict=True)
    G = np.concatenate([w * residual.dr for w, residual in residuals]) * scale.unit
    kept = np.setdiff1d(np.flatnonzero(G.any(axis=0)), idle)
    chosen = kept[scipy.linalg.qr(G[:, kept], mode="r", pivoting=True)[1]].tolist()
    out: list[int] = []
    while len(chosen) > 1 and decompose(G[:, chosen])[-1].share < WEAK:
        out.append(chosen.pop())
    return out
