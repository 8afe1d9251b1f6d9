r"""The most probable model, and what the posterior says of it: draws, misfit, bounds, measurements.

A bound that excludes the truth also drives other parameters to theirs. All bounds that hold the
model are widened at once, and only those beyond which it then lies are to blame. Of the fixed
parameters, each promises to lower -2 ln p by what its slope and the Gauss-Newton matrix say where
all others follow (Rao's score); those that promise most are freed and tried, one at a time.

docs/uncertainty.md has the covariance with the rows R (rows, p) of further residuals. New
measurements are as exact as those that there are, :math:`\tau` by median, with the variance of the
group of their kind; the factor of a shape is fitted.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.special import chdtri, fdtr, fdtrc

from modefront._typing import Bools, Floats, Ints
from modefront.errors import ModelError
from modefront.models.reduced.model import ReducedModel, SnapshotRequest
from modefront.optim.problem import DISTINCT, Evaluation, at_bounds
from modefront.optim.sqp import Options, Solution, begin, solve
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.prior import PULL, Distance, NoiseModel
from modefront.uncertainty.sampling import Draws, draw_models
from modefront.uncertainty.scatter import Posterior
from modefront.work.codec import record
from modefront.work.task import Executor, Task

CHANCE = 0.01  # probability that a fixed parameter, bound or model is blamed wrongly
LARGE, FAR = 2.0, 10.0
"""Errors over those expected, from which they are said to be larger, and from which no model is
advised: far above what is called noise."""

WORSE = 1.1  # error of a group over the nominal model's, from which that one is better there
TRIED = 3  # fixed parameters that are tried at most

GAIN = 0.1  # share of its errors that a group loses without bounds that are worth widening
SHAPES = ("shape", "subspace")  # kinds of residuals that have what a further sensor measures

STARTS = 12  # searches at most, from the most probable of the known models
APART = 0.02  # distance of two starts, over the ranges of the parameters, below which one is enough

_TIGHT = Options(reduction=1e-17)
"""Steps end at the tolerance of the parameters, whatever f: a sum of logarithms has any size."""


def most_probable(
    problem: UpdatingProblem, noise: NoiseModel, known: Sequence[Floats], work: Executor
) -> list[Solution]:
    """Return the maxima of the posterior below known models theta (p,), the greatest first.

    They are solutions of the problem, with the weights at which they are stationary in it.
    """
    thetas = np.unique(np.array([problem.start, *known]), axis=0)
    (values,) = work.run([Task(("most-probable", "known"), log_values, (noise, thetas))])
    span = problem.upper - problem.lower
    starts: list[Floats] = []
    for k in np.argsort(values, kind="stable").tolist():
        apart = [np.abs((thetas[k] - x) / span).max() > APART for x in starts]
        if np.isfinite(values[k]) and all(apart) and len(starts) < STARTS:
            starts.append(thetas[k])
    tasks = [Task(("most-probable", k + 1), maximum, (noise, x)) for k, x in enumerate(starts)]
    models: list[Task[Solution]] = []
    out: list[Solution] = []
    for x in sorted(work.run(tasks), key=lambda x: noise.programme.value(x.J)):
        if all(np.abs((x.theta - y.theta) / span).max() > DISTINCT for y in out):
            out.append(x)
            key = ("most-probable", "model", len(out))
            models.append(Task(key, _in_problem, (problem, noise, x)))
    return work.run(models)


def log_values(noise: NoiseModel, thetas: Floats) -> Floats:
    """Return -2 ln p of models (models, p), infinite where they are not defined."""
    target, programme = noise.target, noise.programme
    found = [target.evaluate(theta, derivatives=False) for theta in thetas]
    return np.array([programme.value(x.J) if x.feasible else np.inf for x in found])


def maximum(noise: NoiseModel, start: Floats) -> Solution:
    """Return the maximum of the posterior to which a start (p,) leads, in the units of J'."""
    target = noise.target
    return solve(target, noise.programme, begin(target.evaluate(start, second=True)), _TIGHT)


def _in_problem(problem: UpdatingProblem, noise: NoiseModel, found: Solution) -> Solution:
    """Return a maximum as a solution of the problem, in its units; idle parameters are nominal.

    Its frequencies and MAC values are those of the most likely pairs, which its objectives, as
    those of the front, do not know.
    """
    effects = np.vstack([each.dr for each in found.evaluation.residuals[:-1]])
    theta = np.where(effects.any(axis=0), found.theta, problem.start)
    evaluation = problem.evaluate(theta, second=True)
    J, own = found.J[:-1], evaluation.J
    unit = np.divide(J, own, out=np.ones(J.size), where=own > 0)
    w = noise.programme.gradient(found.J)[:-1] * unit
    pairs = {**found.evaluation.quantities, "mac_mode": evaluation.quantities["paired_mode"]}
    return replace(found, evaluation=replace(evaluation, quantities=pairs), weights=w)


def refused(misfit: Floats, nominal: Floats) -> tuple[Bools, Bools]:
    """Return the groups (n,) that forbid a model: far from the data, or worse than the nominal one.

    Errors of both, ``misfit`` and ``nominal`` (n,), are over those expected.
    """
    far = misfit > FAR
    return far, (misfit > WORSE * nominal) & (misfit > LARGE) & ~far


@record
@dataclass(frozen=True)
class Freed:
    """The most probable model between wider bounds, or with a parameter more."""

    theta: Floats  # (p,) its parameters
    misfit: Floats  # (n,) its root mean square errors over those expected
    less: float  # by which -2 ln p is less


@dataclass(frozen=True)
class Inference:
    """The posterior, and what its maximum says."""

    draws: Draws  # models drawn from the posterior
    fit: Mapping[str, Any]  # how its maximum fits, as values of results
    freed: Freed | None  # the maximum between wider bounds; None where no bound holds it
    # name and value of the fixed parameter that is wrong, and the errors (n,) over those expected
    # with it free; None where none lowers them beyond chance
    unfixed: tuple[str, float, Floats] | None
    # name and value of the parameter whose prior the data contradict most, and its distance from
    # the nominal one in standard deviations, without this prior; None where chance explains it
    contradicted: tuple[str, float, float] | None
    along: Floats  # (models, n) errors of the models of the front over those expected

    def gaussian(self, span: Floats) -> Posterior:
        """Return the Gaussian with the covariance of the draws, of ranges ``span`` (p,)."""
        p = span.size
        lam, V = np.linalg.eigh(np.cov(self.draws.theta / span, rowvar=False).reshape(p, p))
        moved = lam > np.finfo(float).eps * lam.max(initial=0.0)
        axes = span[:, None] * V[:, moved] * np.sqrt(lam[moved])
        return Posterior(axes, np.zeros(p, dtype=np.bool_), np.zeros((p, 0)))


# 6 arguments: the posterior and the models that are known, how many are drawn, and how.
def infer(
    noise: NoiseModel,
    maxima: Sequence[Solution],
    front: Sequence[Floats],
    count: int,
    seed: int,
    work: Executor,
) -> Inference:
    """Return what follows from the posterior with maxima, the greatest first, by draws.

    The models (p,) of the ``front`` are compared with what is expected, too.
    """
    theta = maxima[0].theta
    (along,) = work.run([Task(("most-probable", "front"), _misfits, (noise, front))])
    (fit,) = work.run([Task(("most-probable", "fit"), _fit, (noise, theta))])
    (free,) = work.run([Task(("most-probable", "freed"), freed, (noise, theta))])
    # One round where the model cannot be used.
    rounds = 1 if np.any(refused(fit["misfit"], fit["nominal_misfit"])) else None
    draws = draw_models(noise, [x.theta for x in maxima], count, seed, work, rounds)
    fit["mac_mode"] = maxima[0].evaluation.quantities["mac_mode"]
    wrong = unfixed(noise, theta, fit["misfit"], work), contradicted(noise, theta, work)
    return Inference(draws, fit, free, *wrong, along)


def _misfits(noise: NoiseModel, thetas: Sequence[Floats]) -> Floats:
    """Return the errors (models, n) of models (p,) over those expected."""
    found = [noise.problem.evaluate(theta, derivatives=False).J for theta in thetas]
    return np.array([noise.over_expected(J) for J in found]).reshape(-1, noise.a.size)


def _fit(noise: NoiseModel, theta: Floats) -> dict[str, Any]:
    """Return how a model fits, and what could be measured besides, as values of results."""
    problem = noise.problem
    found, nominal = problem.evaluate(theta), problem.evaluate(problem.start, derivatives=False)
    misfit, before = (noise.over_expected(x.J) for x in (found, nominal))
    lacks, less = chances(noise, found)
    return {
        "misfit": misfit,
        "nominal_misfit": before,
        "lack_of_fit": lacks,
        "too_small": less,
        "scatter_share": np.divide(noise.S, found.J, out=np.zeros(found.J.size), where=found.J > 0),
        **candidates(noise, found),
    }


def chances(noise: NoiseModel, found: Evaluation) -> tuple[Floats, Floats]:
    """Return probabilities (n,), times n, of the errors of a most probable model.

    Those of errors as large beside the scatter of the data sets, a test of lack of fit, NaN of one
    set; and of errors as small beside those expected. NaN of less than one error, or an expectation
    that is worth less.
    """
    C, w = np.linalg.inv(noise.precision(found, PULL)), noise.logs.gradient(found.J)
    left = noise.a - w * np.einsum("ijk,kj->i", found.gauss_newton, C) / 2
    mean = np.maximum(found.J - noise.S, 0.0) / np.maximum(left, 1.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        large = fdtrc(left, noise.d, mean / (noise.S / noise.d))
    small = fdtr(left, noise.weight, mean / noise.level)
    n, least = left.size, np.minimum(left, noise.weight)
    return n * np.where(left >= 1, large, np.nan), n * np.where(least >= 1, small, np.nan)


def freed(noise: NoiseModel, theta: Floats) -> Freed | None:
    """Return the most probable model without the bounds that hold theta (p,).

    They are widened again while they hold that model, and what that gains grows or is more than
    right ones may. None where no bound holds theta, or no search without them converges.
    """
    lower, upper, found, gain = noise.problem.lower, noise.problem.upper, None, 0.0
    held = sides = at_bounds(theta, lower, upper)
    while held.any():
        below, above = wider(lower, upper)
        lower, upper = np.where(held < 0, below, lower), np.where(held > 0, above, upper)
        problem = replace(noise.problem, lower=lower, upper=upper)
        last, before = _lower(replace(noise, problem=problem), theta), gain
        if last is None:
            break
        gain = last.less - (found.less if found else 0.0)
        held = np.where(at_bounds(last.theta, lower, upper) == sides, held, 0)
        if found and held.any() and gain < min(before, chdtri(1, CHANCE)):
            break
        found = last
    return found


def excluding(sides: Ints, theta: Floats, misfit: Floats, free: Freed) -> list[int]:
    """Return the parameters whose bounds ``sides`` (p,), see `at_bounds`, exclude what fits.

    None unless -2 ln p becomes less without bounds by more than right ones may, and the errors of a
    group, which are ``misfit`` (n,) at the model theta (p,), by a tenth.
    """
    beyond = np.flatnonzero(sides * (free.theta - theta) > 0).tolist()
    i = int(np.argmax(misfit - free.misfit))
    is_chance = free.less < chdtri(1, CHANCE / np.count_nonzero(sides))
    return [] if is_chance or misfit[i] - free.misfit[i] < GAIN * misfit[i] else beyond


def unfixed(
    noise: NoiseModel, theta: Floats, misfit: Floats, work: Executor
) -> tuple[str, float, Floats] | None:
    """Return name and value of the fixed parameter with which, if free, a model is most probable.

    Beside them are the errors (n,) over those expected, as ``misfit`` is. None where none is fixed,
    and where -2 ln p becomes less by no more than right ones may. Where errors are large, the
    promises, which are linearised, only say which parameters are tried first.
    """
    problem = noise.problem
    fixed = [x for x in problem.whole[1] if x.fixed] if problem.whole else []
    if not fixed:
        return None
    every = replace(noise, problem=problem.with_free([x.name for x in fixed]))
    known = problem.model.parameters
    at = every, _placed(every, known, theta), known
    (promises,) = work.run([Task(("most-probable", "promises"), _promises, at)])
    least, far = float(chdtri(1, CHANCE / len(fixed))), (misfit > LARGE).any()
    order = [k for k in np.argsort(-promises).tolist() if far or promises[k] > least]
    tasks, tried = [], [fixed[k].name for k in order[:TRIED]]
    for k, name in enumerate(tried):
        one = replace(noise, problem=problem.with_free([name]))
        start = _placed(one, known, theta)
        tasks.append(Task(("most-probable", "unfixed", k + 1), _tried, (one, start)))
    found = [(x, name) for x, name in zip(work.run(tasks), tried, strict=True) if x is not None]
    best, name = max(found, key=lambda x: x[0].less, default=(None, ""))
    if best is None or best.less < least:
        return None
    names = problem.with_free([name]).model.parameters
    return name, float(best.theta[names.index(name)]), best.misfit


def contradicted(
    noise: NoiseModel, theta: Floats, work: Executor
) -> tuple[str, float, float] | None:
    """Return the prior that data contradict most at a most probable model, as in `Inference`.

    Of a right one the distance from the nominal value takes no more of -2 ln p, with what the data
    gain without it, than by chance: the sum is the square of a normal variable.
    """
    priors, distance = noise.problem.priors, Distance(noise.problem, 0.0).residuals
    known = [j for j, prior in enumerate(priors) if prior]
    tasks = list[Task[Freed | None]]()
    for j in known:
        problem = replace(noise.problem, priors=(*priors[:j], None, *priors[j + 1 :]))
        of = replace(noise, problem=problem), theta
        tasks.append(Task(("most-probable", "prior", j), _lower, of))
    of_each = zip(known, work.run(tasks), strict=True)
    found = [(x.less + distance(theta)[0][j] ** 2, j, x.theta) for j, x in of_each if x is not None]
    less, j, there = max(found, key=lambda x: x[0], default=(0.0, 0, theta))
    if less < chdtri(1, CHANCE / max(len(known), 1)):
        return None
    return noise.problem.model.parameters[j], float(there[j]), float(abs(distance(there)[0][j]))


def _placed(noise: NoiseModel, known: Sequence[str], theta: Floats) -> Floats:
    """Return all parameters, those known theta, others nominal: there a reduced basis begins."""
    model, out = noise.problem.model, noise.problem.start.copy()
    out[[model.parameters.index(x) for x in known]] = theta
    if isinstance(model, ReducedModel):
        model.nominal = out
    return out


def _promises(noise: NoiseModel, theta: Floats, known: Sequence[str]) -> Floats:
    """Return by how much -2 ln p becomes less with each parameter that is not known so far."""
    problem = noise.problem
    found = problem.evaluate(theta)
    slope, A = noise.logs.gradient(found.J) @ found.dJ / 2, noise.precision(found)
    free = np.isin(problem.model.parameters, known)
    moved = free & (at_bounds(theta, problem.lower, problem.upper) == 0)
    Q, R = A[np.ix_(moved, moved)], A[np.ix_(moved, ~free)]
    left = np.diag(A)[~free] - (R * np.linalg.solve(Q, R)).sum(axis=0)
    return slope[~free] ** 2 / left


def _tried(noise: NoiseModel, theta: Floats) -> Freed | None:
    """Return the model to which theta (p,) leads, in a basis that lacks nothing of it."""
    model, columns, found = noise.problem.model, 0, _lower(noise, theta)
    while isinstance(model, ReducedModel) and found is not None and model.columns > columns:
        columns = model.columns
        with suppress(ModelError):
            model.take(SnapshotRequest(found.theta, model.count))
        found = _lower(noise, theta)
    return found


def wider(lower: Floats, upper: Floats) -> tuple[Floats, Floats]:
    """Return bounds (p,) that are farther away by the range, or by the ratio of positive ones."""
    positive = lower > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(positive, upper / lower, 1.0)
        below = np.where(positive, lower / ratio, 2 * lower - upper)
        above = np.where(positive, upper * ratio, 2 * upper - lower)
    return below, above


def _lower(noise: NoiseModel, theta: Floats) -> Freed | None:
    """Return the model to which theta (p,) leads; None where the search does not converge."""
    start, found = noise.target.evaluate(theta, derivatives=False), maximum(noise, theta)
    if not found.converged:
        return None
    less = noise.programme.value(start.J) - noise.programme.value(found.J)
    return Freed(found.theta, noise.over_expected(found.J[:-1]), less)


def candidates(noise: NoiseModel, evaluation: Evaluation) -> dict[str, Any]:
    """Return what could be measured besides the data, as values of results.

    That are a model mode at all sensors, by its frequency, or all measured modes at a further
    sensor, by what groups have of these, and the shares (candidates, p) by which the standard
    deviation of a parameter becomes less. ``evaluation`` is most probable.
    """
    span = noise.problem.upper - noise.problem.lower
    C = np.linalg.inv(noise.precision(evaluation) * np.outer(span, span))
    found = list(_further(noise, evaluation))
    gain = np.zeros((len(found), span.size))
    for k, (_, _, rows) in enumerate(found):
        R = rows * span
        X = C @ R.T
        less = np.einsum("jr,jr->j", np.linalg.solve(np.eye(len(R)) + R @ X, X.T).T, X)
        gain[k] = 1 - np.sqrt(np.maximum(1 - less / np.diag(C), 0.0))
    return {
        "candidate_frequency": np.array([f for f, *_ in found]),
        "candidate_sensor": [name for _, name, _ in found],
        "candidate_gain": gain,
    }


def _further(noise: NoiseModel, evaluation: Evaluation) -> Iterator[tuple[float, str, Floats]]:
    """Yield the frequency of a mode or the name of a sensor, and the residuals' rows (., p)."""
    problem, data = noise.problem, noise.problem.data
    modes, pairs = problem.modes(evaluation.theta)
    w = noise.logs.gradient(evaluation.J)

    def size(kinds: Sequence[str], std: Floats, values: Floats) -> float:
        """Return the root of the weight of groups of these kinds over the error, 0 of none."""
        known = np.isfinite(values) & (values != 0)
        tau = float(np.median((std / np.where(known, values, 1.0))[known])) if known.any() else 1.0
        groups = zip(w, problem.groups, strict=True)
        own = [v for v, x in groups if any(map(x.modes_of, kinds))]
        return float(np.sqrt(np.mean(own or [0.0]))) / tau

    top = np.nanmax(np.abs(data.shape), axis=2, initial=0.0, keepdims=True)
    seen_at = np.where(np.isfinite(data.shape), top, 0.0)
    of_shape = size(SHAPES, data.shape_std, seen_at)
    of_frequency = size(["frequency"], data.frequency_std, data.frequency)

    def shape(q: int, sensors: Bools) -> tuple[Floats, Floats]:
        """Return a shape over expected errors, and its derivatives, at some sensors."""
        unit = of_shape / np.abs(modes.phi[:, q]).max()
        return unit * modes.phi[sensors, q], unit * modes.dphi[sensors, q]

    parts_of = (x for group in problem.groups for x in group.positions(data))
    used = [r for kind, some in parts_of if kind.name in SHAPES for r in some]
    measured: Bools = np.asarray(np.isfinite(data.shape).any(axis=0))
    seen: Bools = np.asarray(measured.any(axis=0) & (of_shape > 0))
    for q in sorted(set(range(modes.lam.size)) - set(pairs.index.tolist())):
        parts, f = [], modes.frequency[q]
        if of_frequency and f > 0:
            parts.append(of_frequency * modes.dfrequency[q][None] / f)
        if modes.phi[seen, q].any():
            chi, dchi = shape(q, seen)
            parts.append(dchi - np.outer(chi, chi @ dchi / (chi @ chi)))
        if parts:
            yield float(f), "", np.vstack(parts)
    for s in np.flatnonzero(~seen).tolist():
        rows = []
        for r in sorted(set(used)):
            others, q = measured[r], pairs.index[r]
            if modes.phi[others, q].any():
                (x,), (dx,) = shape(q, np.arange(seen.size) == s)
                chi, dchi = shape(q, others)
                b = chi @ chi
                rows.append((dx - x * (chi @ dchi) / b) / np.sqrt(1 + x**2 / b))
        if rows:
            yield 0.0, data.sensors[s], np.array(rows)
