r"""Combinations of parameters that the data determine, from the singular values of the Jacobian.

The Jacobian :math:`\sqrt{w_i}\, s_j\, \partial r_i / \partial \theta_j` is that of the weighted
residuals, with parameters in their units s (`modefront.identifiability.scale`); directions of small
singular values hardly change any residual. With its columns scaled to length one,
:math:`\tilde g_j`, the collinearity index is :math:`1 / \sqrt{\lambda_{\min}(\tilde G^T \tilde
G)}` (Brun, Reichert & Künsch 2001, doi:10.1029/2000WR900350, eq. 2; they call 10 to 20 critical).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import scipy.linalg

from modefront._typing import Bools, Floats
from modefront.identifiability.scale import Scale, scale_at
from modefront.optim.lexicographic import TIE
from modefront.optim.problem import Evaluation
from modefront.options import Checked, number, whole
from modefront.residuals.problem import UpdatingProblem

WEAK = 1e-2  # singular value over the greatest one, below which a combination is weakly determined

ROUNDING = 1e-9
"""Change of residuals over the measured values, for a unit of a parameter, that is rounding, and
difference of singular values over the greatest one."""

CRITICAL = 10.0  # collinearity index from which parameters count as not told apart
_LARGEST = 1e8  # greatest collinearity index; columns beyond it are parallel but for rounding

NONE = 1e-7
"""Singular value over the greatest one, below which a combination is not determined at all."""

SAME = 1e-3
"""Difference of two parts of a direction, over its greatest part, below which they are equal."""

STEP = number("a share of the ranges from 0.001 to 0.5", least=1e-3, most=0.5)


@dataclass(frozen=True)
class Identifiability(Checked):
    """Limits of flat parts of the front and of manifolds of equivalent models.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    flat : share from 0 to 1 by which an objective may exceed its least value in a flat part of the
        front; 0 for no search of flat parts
    models : greatest number of equivalent models on each manifold; 0 for no manifolds
    step : distance of neighbours on a manifold, over the ranges of the parameters, from 0.001 to
        0.5
    """

    flat: Annotated[float, number("a share from 0 to 1", least=0, most=1)] = 0.01
    models: Annotated[int, whole(0, 10**6)] = 100
    step: Annotated[float, STEP] = 0.05


@dataclass(frozen=True)
class Combination:
    """A combination of parameters and how well residuals determine it."""

    direction: Floats  # (parameters,) changes of the parameters in their units, of length 1
    sensitivity: float  # change of the residuals for a unit change along it
    share: float  # that over the greatest of all combinations, 0 to 1


def combinations(
    problem: UpdatingProblem,
    evaluation: Evaluation,
    group: int | None = None,
    weights: Floats | None = None,
    scale: Scale | None = None,
) -> list[Combination]:
    """Return orthogonal combinations of the parameters, the best determined one first.

    Parameters
    ----------
    problem
        The updating problem.
    evaluation
        The model at which the residuals are linearised, with derivatives.
    group
        Number of the group whose residuals determine them, from 0; None for all groups together.
    weights
        Weights (groups,) of all groups together; 1 unless given.
    scale
        Units of the parameters there; computed unless given.
    """
    every = np.ones(len(problem.groups)) if weights is None else weights
    w = every if group is None else np.eye(len(problem.groups))[group]
    G = jacobian(problem, evaluation, w, (scale or scale_at(problem, evaluation.theta)).unit)
    return decompose(G, ROUNDING * float(np.sqrt(w @ sizes(problem) ** 2)))


def jacobian(problem: UpdatingProblem, model: Evaluation, weights: Floats, unit: Floats) -> Floats:
    """Return the changes (rows, p) of the weighted residuals by a unit of each parameter.

    No combination changes a group by more than its measured values: where it does to first order,
    as it does shapes of close modes, it does so for small steps alone.
    """
    out = []
    for w, residual, most in zip(weights, model.residuals, sizes(problem), strict=True):
        G = residual.dr * unit
        if np.linalg.norm(G, 2) > most:
            U, sigma, Vt = np.linalg.svd(G, full_matrices=False)
            G = U * np.minimum(sigma, most) @ Vt
        out += [np.sqrt(w) * G] * int(w > 0)
    return np.concatenate(out)


def cosines(gram: Floats) -> Floats:
    """Return cosines between the columns of G, (p, p), from G^T G; 0 for columns that vanish."""
    length = np.sqrt(np.diag(gram))
    product = np.outer(length, length)
    out = np.divide(gram, product, out=np.zeros_like(gram), where=product > 0)
    return np.clip(out, -1.0, 1.0)


def index(gram: Floats) -> float:
    """Return the collinearity index of all parameters; infinite for parallel ones.

    >>> round(index(np.array([[1.0, 0.6], [0.6, 1.0]])), 4)
    1.5811
    """
    least = float(np.linalg.eigvalsh(cosines(gram))[0])
    return least**-0.5 if least > _LARGEST**-2 else np.inf


def pairs(gram: Floats) -> list[tuple[int, int]]:
    """Return the pairs of parameters with a critical index, most alike first."""
    least = np.maximum(1 - np.abs(cosines(gram)), _LARGEST**-2)
    two = np.argwhere(np.triu(least <= CRITICAL**-2, 1)).tolist()
    return sorted(((i, j) for i, j in two), key=lambda pair: float(least[pair]))


def sizes(problem: UpdatingProblem) -> Floats:
    """Return the length of the measured values of each group as they enter residuals, (groups,)."""
    modes = len(problem.data.modes)
    return problem.margins(np.full(modes, 2.0), np.ones(modes))


def without_effect(problem: UpdatingProblem, evaluation: Evaluation, scale: Scale) -> list[int]:
    """Return the parameters with which no residual of any group changes, from 0."""
    return np.flatnonzero(~_changed(problem, evaluation, scale).any(axis=0)).tolist()


def _changed(problem: UpdatingProblem, evaluation: Evaluation, scale: Scale) -> Bools:
    """Return which groups change with which parameters, by more than rounding, (groups, p)."""
    length = np.sqrt(np.einsum("ijj->ij", evaluation.gauss_newton) / 2) * scale.unit
    return np.asarray(length > ROUNDING * sizes(problem)[:, None])


def unchanged_groups(problem: UpdatingProblem) -> list[int]:
    """Return the groups that no parameter changes, from 0.

    Where nothing changes at the nominal parameters, two others within the bounds are looked at:
    a derivative may vanish for symmetry.
    """
    still, first = np.ones(len(problem.objectives), dtype=bool), problem.evaluate(problem.start)
    if not first.feasible:
        return []
    u = np.random.default_rng(0).uniform(size=(2, first.theta.size))
    for theta in [first.theta, *(problem.lower + u * (problem.upper - problem.lower))]:
        if not still.any():
            break
        other = first if theta is first.theta else problem.evaluate(theta)
        if other.feasible:
            moved = np.abs(np.sqrt(other.J) - np.sqrt(first.J)) > ROUNDING * sizes(problem)
            still &= ~moved & ~_changed(problem, other, scale_at(problem, theta)).any(axis=1)
    return np.flatnonzero(still).tolist()


def decompose(G: Floats, least: float = 0.0) -> list[Combination]:
    """Return the combinations that a Jacobian (rows, parameters) determines, best first.

    Singular values up to ``least`` are rounding.

    >>> [round(one.share, 3) for one in decompose(np.array([[3.0, 0.0], [0.0, 1.5]]))]
    [1.0, 0.5]
    """
    p = G.shape[1]
    padded = np.vstack([G, np.zeros((max(0, p - len(G)), p))])
    _, sigma, Vt = np.linalg.svd(padded, full_matrices=False)
    share = np.where(sigma > least, sigma, 0.0) / (sigma[0] if sigma[0] > 0 else 1.0)
    starts = np.flatnonzero(np.diff(share, prepend=np.inf) < -ROUNDING)
    Vt = np.concatenate([_told_apart(part) for part in np.split(Vt, starts[1:])])
    return [Combination(v, float(s), float(x)) for s, x, v in zip(sigma, share, Vt, strict=True)]


def _told_apart(Vt: Floats) -> Floats:
    """Return the orthonormal rows (k, p) that a rule chooses of the space that given ones span.

    Signs of singular vectors are arbitrary, and so is the basis of those of equal singular values.
    The first row is the one that has the greatest share of a single parameter, the next one that of
    what is left; its greatest component is positive.

    >>> rows = _told_apart(np.array([[-0.6, -0.8, 0.0], [0.8, -0.6, 0.0]]))
    >>> (rows.round(9) + 0.0).tolist()
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    """
    if len(Vt) == 1:
        return Vt * np.sign(Vt[0, _first_greatest(np.abs(Vt[0]))])
    left, out = Vt, []
    for _ in range(len(Vt)):
        j = _first_greatest((left**2).sum(axis=0))
        v = left[:, j] @ left
        out.append(v / np.linalg.norm(v))
        left = left - np.outer(left @ out[-1], out[-1])
    return np.array(out)


def _first_greatest(values: Floats) -> int:
    """Return the place of the greatest value, the first of those that rounding tells apart."""
    return int(np.argmax(values >= values.max() * (1 - TIE)))


def sparse_basis(N: Floats, whole: Sequence[Floats], holds: Callable[[Floats], bool]) -> Floats:
    """Return a basis of the span of the columns of N (p, d) of directions that are short in words.

    First single parameters; then those of the directions ``whole`` (p,) that are in the span; then
    pairs of parameters; the rest has as many zeros as elimination makes. ``holds`` tells whether a
    simple direction is not determined indeed.
    """
    p, d = N.shape
    Q = np.linalg.qr(N)[0]
    outside = np.eye(p) - Q @ Q.T
    alone = [j for j in range(p) if outside[j, j] <= SAME**2 and holds(np.eye(p)[j])]
    basis = [np.eye(p)[j] for j in alone]
    for direction in whole:
        others = direction.copy()
        others[alone] = 0.0
        size = float(np.linalg.norm(others))
        if size > 0 and np.linalg.norm(outside @ others) <= SAME * size and holds(others):
            basis = _longer(basis, others / size)
    for v in _pairs_within(outside, alone):
        if len(basis) < d and holds(v):
            basis = _longer(basis, v)
    pivots = scipy.linalg.qr(Q.T, mode="r", pivoting=True)[1][:d]
    eliminated = np.linalg.solve(Q[pivots].T, Q.T)
    for row in sorted(eliminated, key=lambda row: int((np.abs(row) > SAME).sum())):
        basis = _longer(basis, row / np.linalg.norm(row)) if len(basis) < d else basis
    return np.array(basis).T


def _longer(basis: list[Floats], v: Floats) -> list[Floats]:
    """Return a basis with another direction of length 1, if that does not depend on it."""
    longer = [*basis, v]
    return longer if np.linalg.matrix_rank(np.array(longer), tol=SAME) == len(longer) else basis


def _pairs_within(outside: Floats, alone: Sequence[int]) -> list[Floats]:
    """Return the directions of two parameters that a projector (p, p) takes to nothing."""
    p, out = len(outside), []
    d = np.diag(outside)
    # The lesser eigenvalue of two rows and columns, but for rounding, rules most pairs out at once.
    mean, half = np.add.outer(d, d) / 2, np.subtract.outer(d, d) / 2
    possible = np.triu(mean - np.hypot(half, outside) <= 2 * SAME**2, 1)
    possible[list(alone)] = possible[:, list(alone)] = False
    for i, j in np.argwhere(possible).tolist():
        lam, V = np.linalg.eigh(outside[np.ix_([i, j], [i, j])])
        if lam[0] <= SAME**2:
            v = np.zeros(p)
            v[[i, j]] = V[:, 0] * np.sign(V[np.argmax(np.abs(V[:, 0])), 0])
            out.append(v)
    return out


LEAST = 1e-3  # root of the mean square of residuals that no measurement is taken to be better than


def optimal_weights(a: Floats, J: Floats) -> Floats:
    """Return w = a / J, with residuals of 1e-3 at least.

    The weight of an objective that is fitted exactly would have no bound, and what the others
    determine would drown in it.
    """
    return np.asarray(a / np.maximum(J, a * LEAST**2))


ALL = "all data"  # name of all groups together


@dataclass(frozen=True)
class Determination:
    """Combinations of parameters that each group, then all data determine at a model."""

    scale: Scale  # units of the parameters there
    idle: list[int]  # positions of parameters without effect
    # of each group, and of `ALL` where there are several, by these names
    combinations: Sequence[tuple[str, Sequence[Combination]]]
    effects: Floats  # (p, p) products of the effects of parameters on all weighted residuals


def determination(
    problem: UpdatingProblem, evaluation: Evaluation, weights: Floats | None = None
) -> Determination:
    """Return what the data determine at a model, with weights (n,) that are optimal for it.

    Others may be given: of a model that is far from the data, misfits say nothing of errors.
    """
    weights = optimal_weights(problem.properties, evaluation.J) if weights is None else weights
    scale = scale_at(problem, evaluation.theta)
    idle = without_effect(problem, evaluation, scale)
    groups: list[tuple[str, int | None]] = [(x.name, i) for i, x in enumerate(problem.groups)]
    groups += [(ALL, None)] * (len(groups) > 1)
    of = [(name, combinations(problem, evaluation, i, weights, scale)) for name, i in groups]
    unit = np.where(np.isin(np.arange(scale.unit.size), idle), 0.0, scale.unit)
    G = jacobian(problem, evaluation, weights, unit)
    return Determination(scale, idle, of, G.T @ G)


@dataclass(frozen=True)
class Sensitivities:
    """Sensitivities of the measured modes to each parameter.

    Parameters with 0 among their values are changed by a hundredth of their range instead of one
    percent.
    """

    parameters: tuple[str, ...]  # names
    modes: tuple[int, ...]  # measured modes
    frequency: Floats  # (parameters, modes) percent of the frequency for a percent of the parameter
    # (parameters,) percent of all shapes together, at the sensors and without the change of scale
    shape: Floats
    superfluous: tuple[str, ...]  # parameters to fix, so that the data determine the others


def sensitivities(problem: UpdatingProblem, fixed: tuple[str, ...] = ()) -> Sensitivities:
    """Return the sensitivities at the nominal parameters, with those that are ``fixed`` better.

    Raises ModelError where the model has no modes there.
    """
    modes, pairs = problem.modes(problem.start)
    span = problem.upper - problem.lower
    unit = np.where(problem.lower * problem.upper > 0, problem.start, span)
    slopes = modes.dfrequency[pairs.index].T * unit[:, None]
    phi, dphi = modes.phi[:, pairs.index], modes.dphi[:, pairs.index] * unit
    with np.errstate(divide="ignore", invalid="ignore"):
        frequency = slopes / modes.frequency[pairs.index]
        phi = phi / np.linalg.norm(phi, axis=0)
        dphi = dphi / np.linalg.norm(modes.phi[:, pairs.index], axis=0)[:, None]
    frequency, phi, dphi = (np.where(np.isfinite(x), x, 0.0) for x in (frequency, phi, dphi))
    across = dphi - phi[:, :, None] * np.einsum("sr,srj->rj", phi, dphi)
    shape = np.linalg.norm(across, axis=(0, 1))
    return Sensitivities(problem.model.parameters, problem.data.modes, frequency, shape, fixed)


def superfluous(
    problem: UpdatingProblem, nominal: Evaluation, weights: Floats | None = None
) -> tuple[str, ...]:
    """Return the parameters with an effect of which the others leave least at the nominal model.

    Without them no combination is hardly determined (singular value below 1 % of the greatest),
    with weights (n,) as of `determination`.
    """
    scale, names = scale_at(problem, problem.start), problem.model.parameters
    idle = without_effect(problem, nominal, scale)
    weights = optimal_weights(problem.properties, nominal.J) if weights is None else weights
    G = jacobian(problem, nominal, weights, scale.unit)
    kept = np.setdiff1d(np.flatnonzero(G.any(axis=0)), idle)
    chosen = kept[scipy.linalg.qr(G[:, kept], mode="r", pivoting=True)[1]].tolist()
    out: list[str] = []
    while len(chosen) > 1 and decompose(G[:, chosen])[-1].share < WEAK:
        out.append(names[chosen.pop()])
    return tuple(out)
