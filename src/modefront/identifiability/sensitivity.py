r"""Sensitivities of the measured modes to the parameters, and which of these to fix.

The table has :math:`(\theta_j / f_r)\, \partial f_r / \partial \theta_j`, the change of a frequency
in percent for one percent of a parameter, and the change of all shapes together,
:math:`(\sum_r \|\theta_j\, \partial \varphi_r / \partial \theta_j\|^2 / \|\varphi_r\|^2)^{1/2}`,
each at the sensors and without the change of scale. Parameters with 0 among their values are
changed by a hundredth of their range instead.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from modefront._typing import Floats
from modefront.identifiability.combinations import WEAK, decompose, optimal_weights, without_effect
from modefront.identifiability.scale import scale_at
from modefront.optim.problem import Evaluation
from modefront.residuals.problem import UpdatingProblem


@dataclass(frozen=True)
class Sensitivities:
    """Sensitivities of the measured modes to each parameter."""

    parameters: tuple[str, ...]  # names
    modes: tuple[int, ...]  # measured modes
    frequency: Floats  # (parameters, modes) percent of the frequency for a percent of the parameter
    shape: Floats  # (parameters,) percent of all shapes together
    superfluous: tuple[str, ...]  # parameters to fix, so that the data determine the others


def sensitivities(problem: UpdatingProblem) -> Sensitivities:
    """Return the sensitivities at the nominal parameters.

    Raises ModelError where the model has no modes there.
    """
    modes, pairs = problem.modes(problem.start)
    unit = np.where(problem.lower > 0, problem.start, problem.upper - problem.lower)
    slopes = modes.dfrequency[pairs.index].T * unit[:, None]
    phi, dphi = modes.phi[:, pairs.index], modes.dphi[:, pairs.index] * unit
    with np.errstate(divide="ignore", invalid="ignore"):
        frequency = slopes / modes.frequency[pairs.index]
        phi = phi / np.linalg.norm(phi, axis=0)
        dphi = dphi / np.linalg.norm(modes.phi[:, pairs.index], axis=0)[:, None]
    frequency, phi, dphi = (np.where(np.isfinite(x), x, 0.0) for x in (frequency, phi, dphi))
    across = dphi - phi[:, :, None] * np.einsum("sr,srj->rj", phi, dphi)
    names, fixed = problem.model.parameters, superfluous(problem, problem.evaluate(problem.start))
    shape = np.linalg.norm(across, axis=(0, 1))
    return Sensitivities(names, problem.data.modes, frequency, shape, fixed)


def superfluous(problem: UpdatingProblem, nominal: Evaluation) -> tuple[str, ...]:
    """Return the parameters with an effect of which the others leave least at the nominal model.

    Without them no combination is hardly determined (singular value below 1 % of the greatest).
    """
    scale, names = scale_at(problem, problem.start), problem.model.parameters
    idle = without_effect(problem, nominal, scale)
    roots = np.sqrt(optimal_weights(problem.properties, nominal.J))
    residuals = zip(roots, nominal.residuals, strict=True)
    G = np.concatenate([w * residual.dr for w, residual in residuals]) * scale.unit
    kept = np.setdiff1d(np.flatnonzero(G.any(axis=0)), idle)
    chosen = kept[scipy.linalg.qr(G[:, kept], mode="r", pivoting=True)[1]].tolist()
    out: list[str] = []
    while len(chosen) > 1 and decompose(G[:, chosen])[-1].share < WEAK:
        out.append(names[chosen.pop()])
    return tuple(out)
