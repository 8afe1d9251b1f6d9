"""What is known beyond the points of a front, as variables of results and in words."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from modefront._typing import Bools, Floats
from modefront.analysis.front import FrontAnalysis, followed
from modefront.fronts.front import Front
from modefront.fronts.methods import METHODS
from modefront.fronts.point import Kind, label, of_kind
from modefront.identifiability.collinearity import cosines, index
from modefront.identifiability.combinations import (
    Combination,
    combinations_at,
    gram,
    optimal_weights,
    without_effect,
)
from modefront.identifiability.scale import scale_at
from modefront.identifiability.words import (
    PARTS,
    alike_in_words,
    determined,
    enumeration,
    measured_thing,
    no_effect_in_words,
    summary,
)
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.manifold import Extent, Manifold
from modefront.solvers.sqp import Solution
from modefront.uncertainty.doubts import Doubt
from modefront.uncertainty.prediction import linear

Variables = dict[str, tuple[tuple[str, ...], object, str]]
"""Name: dimensions, values, meaning."""

Finding = tuple[int, str]
"""A sentence, and where it belongs among the others: the least is the most important."""

WEIGHTS, IDLE, ALL_DATA, MANIFOLD, FLAT, OF_GROUP, SPENT, ALIKE, SCATTER, DOUBTFUL = range(10)
DETERMINED = 10
"""No optimal weights or unknown ends of branches, parameters without effect, what all data leave
open, ... what is determined in full."""

ALL = "all data"
FEW = 10
"""Points that are named one by one in a sentence."""

VARIED = 1e-3
"""Change of a parameter along a manifold, over its range, from which it is named."""

AT_BOUND = 1e-9
"""Distance from a bound, over the range, up to which a parameter is at it."""


def analysis_variables(
    problem: UpdatingProblem, front: Front, analysis: FrontAnalysis
) -> Variables:
    """Return the variables; ``front`` holds all points, those of ``analysis`` too."""
    out: Variables = {}
    said: list[Finding] = []
    for found, more in (
        ({}, _weights(problem, front)),
        ({}, _unknown_ends(front)),
        _identifiability(problem, front),
        (_bounds(problem, front), []),
        _flat(problem, front, analysis),
        _manifolds(problem, analysis),
        _scatter(problem, front, analysis),
        _posterior(problem, front, analysis),
        _replicates(problem, front, analysis),
    ):
        out |= found
        said += more
    texts = [text for _, text in sorted(said, key=lambda one: one[0])]
    meaning = "what is not determined, in words, the most important first"
    out["finding"] = (("finding",), np.array(texts, dtype=str), meaning)
    return out


def _weights(problem: UpdatingProblem, front: Front) -> list[Finding]:
    """Return why there is no optimally weighted model, where there is none."""
    if front.reference.kind is Kind.OPTIMAL:
        return []
    exact = [name for name, fits in zip(problem.objectives, front.exact, strict=True) if fits]
    if exact:
        why = (
            f"the model can fit {enumeration(exact)} exactly, where the optimal weights are not "
            "defined, and no regular minimum of sum a ln J is better than the models of the front"
        )
    else:
        why = "no minimum of sum a ln J was found that is better than the models of the front"
    if front.reference.kind is Kind.BOUNDED:
        then = (
            f"{label(Kind.BOUNDED)} takes the place of {label(Kind.OPTIMAL)}: no group counts as "
            "known better than the errors of its data allow"
        )
    else:
        then = (
            f"{label(Kind.EQUAL)} takes the place of {label(Kind.OPTIMAL)}; standard deviations "
            "of the data of every group, or several data sets, give "
            f"{label(Kind.BOUNDED)}, which are better"
        )
    return [(WEIGHTS, f"there is no {label(Kind.OPTIMAL)}: {why}. {then}")]


def _unknown_ends(front: Front) -> list[Finding]:
    """Return which ends of branches are not known."""
    out = []
    for k, gap in enumerate(front.gaps):
        if gap.end is None:
            out.append(f"the front has a gap: where branch {k + 1} ends is not known")
        if gap.start is None:
            out.append(f"the front has a gap: where branch {k + 2} starts is not known")
    return [(WEIGHTS, text) for text in out]


def _identifiability(problem: UpdatingProblem, front: Front) -> tuple[Variables, list[Finding]]:
    """Return combinations at the model that the data prefer and at each edge; say the first."""
    names, groups = problem.model.parameters, problem.groups
    points = [front.reference, *of_kind(front.points, Kind.EDGE)]
    rows: list[tuple[str, str, Combination, Floats]] = []
    said: list[Finding] = []
    effects = np.zeros((len(names), len(names)))
    for point in points:
        place, at = point.label, point.solution.at
        weights = optimal_weights(problem.properties, at.J)
        scale = scale_at(problem, at.theta)
        idle = without_effect(problem, at, scale)
        main = point is front.reference
        if main:
            said += [(IDLE, f"at {place}: {text}") for text in no_effect_in_words(idle, names)]
        for i in [*range(len(groups)), None] if len(groups) > 1 else [0]:
            of = ALL if i is None else groups[i].name
            found = combinations_at(problem, at, i, weights, scale)
            rows += [(place, of, one, scale.unit) for one in found]
            if main:
                thing = measured_thing(groups if i is None else [groups[i]])
                text = f"at {place}: {summary(of, thing, found, names, scale, idle)}"
                full = determined(found) == (len(names) - len(idle), 0)
                said.append((DETERMINED if full else ALL_DATA if i is None else OF_GROUP, text))
        if main:
            effects = gram(at, weights, scale)
            effects[idle] = effects[:, idle] = 0.0
            alike = alike_in_words(effects, names, idle)
            said += [(ALIKE, f"at {place}: {text}") for text in alike]
    place = front.reference.label
    active = [j for j in range(len(names)) if effects[j, j] > 0]
    meaning = "combination of parameters: changes in units of combination_unit, length 1"
    return {
        "combination_at": (("combination",), [row[0] for row in rows], "point where it was found"),
        "combination_of": (("combination",), [row[1] for row in rows], "group, or all data"),
        "combination_direction": (
            ("combination", "parameter"),
            np.array([row[2].direction for row in rows]),
            meaning,
        ),
        "combination_unit": (
            ("combination", "parameter"),
            np.array([row[3] for row in rows]),
            "change of each parameter by which some stiffness or mass is lost to first order, or "
            "its range, if that is less",
        ),
        "combination_sensitivity": (
            ("combination",),
            [row[2].sensitivity for row in rows],
            "singular value: change of the weighted residuals for a unit change along it",
        ),
        "combination_share": (
            ("combination",),
            [row[2].share for row in rows],
            "that over the greatest one of the same data; 0 where it is rounding",
        ),
        "collinearity": (
            ("parameter", "parameter_other"),
            cosines(effects),
            f"cosines between the effects of parameters on all weighted residuals at {place}; "
            "0 for parameters without effect",
        ),
        "collinearity_index": (
            (),
            index(effects, active) if active else np.nan,
            "1 / root of the least eigenvalue of these; infinite where some effects depend; of "
            "the parameters that have an effect",
        ),
    }, said


def _bounds(problem: UpdatingProblem, front: Front) -> Variables:
    theta = np.array([point.solution.at.theta for point in front.points])
    margin = AT_BOUND * (problem.upper - problem.lower)
    at = np.where(theta >= problem.upper - margin, 1, 0)
    at = np.where(theta <= problem.lower + margin, -1, at)
    meaning = "-1 at the lower bound, 1 at the upper one, 0 between them"
    return {"at_bound": (("point", "parameter"), at, meaning)}


def _flat(
    problem: UpdatingProblem, front: Front, analysis: FrontAnalysis
) -> tuple[Variables, list[Finding]]:
    boundary = METHODS[front.method].programme == "boundary"
    parts = {Kind.FRONT: "whole" if boundary else ""}
    parts |= dict.fromkeys((Kind.IDENTIFIABLE, Kind.IDENTIFIABLE_EDGE), "identifiable")
    part = [parts.get(point.kind, "") for point in front.points]
    found = analysis.identifiable
    first = label(Kind.IDENTIFIABLE, index=1)
    last = label(Kind.IDENTIFIABLE, index=len(found.points) if found else 0)
    flat = found.flat if found else np.zeros(len(problem.objectives), dtype=int)
    total = part.count("whole")
    said = []
    for name, count in zip(problem.objectives, flat.tolist(), strict=True):
        if count and found:
            text = (
                f"the front is flat at edge-{name}: beside it, {count} of {total} points are "
                f"within {100 * analysis.tolerance:g} % of the least J of {name}; "
            )
            said.append(
                text + f"{first} to {last} are the front without them"
                if found.points
                else text + "without them it is one point"
            )
    for name, count in zip(
        problem.objectives, (found.uncut if found else flat).tolist(), strict=True
    ):
        if count and found:
            said.append(
                f"the front is flat at edge-{name}: {count} of {total} points are within "
                f"{100 * analysis.tolerance:g} % of the least J of {name}; where that part ends "
                "was not found, so it is not cut"
            )
    return {
        "front_part": (
            ("point",),
            part,
            "whole: the front between the edges; identifiable: the front without flat parts",
        ),
        "flat": (("group",), flat, "points in the flat part at the edge of the group, besides it"),
    }, [(FLAT, text) for text in said]


def _manifolds(
    problem: UpdatingProblem, analysis: FrontAnalysis
) -> tuple[Variables, list[Finding]]:
    names = problem.model.parameters
    rows = [
        (of, number, manifold, at)
        for of, manifolds in analysis.manifolds
        for number, manifold in enumerate(manifolds, start=1)
        for at in manifold.models
    ]
    said = _separate(analysis) + _connected(problem, analysis)
    p, n = len(names), len(problem.objectives)
    return {
        "equal_of": (
            ("equal",),
            np.array([row[0] for row in rows], dtype=str),
            "group or method that these models fit equally well",
        ),
        "equal_manifold": (
            ("equal",),
            np.array([row[1] for row in rows], dtype=int),
            "number of the connected set to which the model belongs, from 1",
        ),
        "equal_dimension": (
            ("equal",),
            np.array([row[2].dimension for row in rows], dtype=int),
            "dimension of that set; 0 is an isolated model",
        ),
        "equal_extent": (
            ("equal",),
            np.array([row[2].extent.name.lower() for row in rows], dtype=str),
            "how far the set was followed: "
            + "; ".join(f"{one.name.lower()}: {one.value}" for one in Extent),
        ),
        "equal_theta": (
            ("equal", "parameter"),
            np.array([row[3].theta for row in rows]).reshape(-1, p),
            "parameter values",
        ),
        "equal_objective": (
            ("equal", "group"),
            np.array([row[3].J for row in rows]).reshape(-1, n),
            "J_i",
        ),
    }, said


def _separate(analysis: FrontAnalysis) -> list[Finding]:
    """Return what there is to say of isolated models that are equally good."""
    said: list[Finding] = []
    for of, manifolds in analysis.manifolds:
        isolated = sum(one.extent is Extent.ISOLATED for one in manifolds)
        if isolated > 1:
            said.append((MANIFOLD, f"{isolated} separate models fit {of} equally well"))
        left = sum(one.extent is Extent.SPENT and len(one.models) == 1 for one in manifolds)
        if left:
            spent = sum(one.evaluations for one in manifolds)
            said.append(
                (
                    SPENT,
                    f"{left} more model{'s fit' if left > 1 else ' fits'} {of} equally well: what "
                    f"is connected to {'them' if left > 1 else 'it'} is not known, as the "
                    f"{spent} eigenproblems that [identifiability] models allows were spent before",
                )
            )
    return said


def _connected(problem: UpdatingProblem, analysis: FrontAnalysis) -> list[Finding]:
    """Return what there is to say of manifolds, those of one group and dimension at once."""
    known = followed(analysis.manifolds)
    shared: dict[int, list[str]] = {k: [of] for k, (of, _) in enumerate(known)}
    for of, manifolds in analysis.manifolds:
        for one in manifolds:
            if one.twin is not None and of not in shared[one.twin]:
                shared[one.twin].append(of)
    alike: dict[tuple[str, int], list[Manifold]] = {}
    for k, (_, one) in enumerate(known):
        if len(one.models) > 1:
            alike.setdefault((enumeration(shared[k]), one.dimension), []).append(one)
    return [(MANIFOLD, _extent(problem, of, some)) for (of, _), some in alike.items()]


KINDS = {1: "curve", 2: "surface"}


def _extent(problem: UpdatingProblem, of: str, manifolds: Sequence[Manifold]) -> str:
    """Return how far manifolds of one dimension go, of several the greatest."""
    one = max(manifolds, key=lambda one: len(one.models))
    kind = KINDS.get(one.dimension, "manifold")
    spent = f"{one.evaluations} eigenproblem{'s' * (one.evaluations != 1)}"
    found = f"{len(one.models)} of them, by {spent}, {one.extent.value}"
    more = "" if one.dimension in KINDS else f" of dimension {one.dimension}"
    far = _far(problem, np.array([at.theta for at in one.models]))
    if len(manifolds) == 1:
        return f"a {kind}{more} of models fits {of} equally well ({found}): {far}"
    return (
        f"{len(manifolds)} separate {kind}s{more} of models fit {of} equally well; "
        f"on the greatest ({found}): {far}"
    )


def _far(problem: UpdatingProblem, theta: Floats) -> str:
    """Return how far parameters go among models (models, p), those that go the farthest first."""
    names, span = problem.model.parameters, problem.upper - problem.lower
    least, most = theta.min(axis=0), theta.max(axis=0)
    share = (most - least) / span
    varied = np.flatnonzero(share > VARIED)
    all_the_way = np.flatnonzero(share >= 1 - AT_BOUND)
    parts = []
    if all_the_way.size > PARTS:
        count = f"all {len(names)}" if all_the_way.size == len(names) else str(all_the_way.size)
        parts.append(f"{count} parameters from bound to bound")
        varied = np.setdiff1d(varied, all_the_way)
    named = varied if varied.size <= PARTS else varied[np.argsort(-share[varied], kind="stable")]
    parts += [f"{names[j]} from {least[j]:.3g} to {most[j]:.3g}" for j in named[:PARTS].tolist()]
    if varied.size > PARTS:
        parts.append(f"and {varied.size - PARTS} more (equal_theta)")
    return ", ".join(parts)


def _scatter(
    problem: UpdatingProblem, front: Front, analysis: FrontAnalysis
) -> tuple[Variables, list[Finding]]:
    if analysis.source is None:
        data = problem.data
        given = np.isfinite(data.frequency_std).any() or np.isfinite(data.shape_std).any()
        used = (data.frequency_std > 0).any() or (data.shape_std > 0).any()
        unused = (SCATTER, "no standard deviation is above 0: none is used")
        return {}, [unused] if given and not used else []
    labels = [point.label for point in front.points]
    m, n, p = len(labels), len(problem.objectives), len(problem.model.parameters)
    r = len(problem.data.modes)
    theta, J = np.full((m, p, p), np.nan), np.full((m, n, n), np.nan)
    theta_std = np.full((m, p), np.nan)
    predicted = {name: np.full((m, r), np.nan) for name in ("frequency", "mac")}
    for i, text in enumerate(labels):
        found = analysis.scatter.get(text)
        if found is None:
            continue
        theta[i], J[i] = found.covariance, found.J.T @ found.J
        theta_std[i] = _std(found.covariance, found.free)
        slopes = analysis.slopes.get(text)
        if slopes is not None:
            for name, values in predicted.items():
                values[i] = np.sqrt(np.diag(linear(found.covariance, slopes[name])))
    why = {"std": "their standard deviations", "sets": "the scatter of the data sets"}
    by = f"by errors of the data, from {why[analysis.source]}"
    said = [(SCATTER, f"uncertainty of the data is taken from {why[analysis.source]}")]
    unknown = _without_std(problem) if analysis.source == "std" else 0
    if unknown:
        text = f"{unknown} measured values have no standard deviation above 0: they count as exact"
        said.append((SCATTER, text))
    solved = [point.label for point in front.points if point.kind is not Kind.NOMINAL]
    missing = [label for label in solved if label not in analysis.scatter]
    if missing:
        said.append((DOUBTFUL, f"no scatter is known at {_places(missing, len(solved))}"))
    known = [(label, analysis.scatter[label]) for label in labels if label in analysis.scatter]
    for doubt in Doubt:
        there = [label for label, one in known if doubt in one.doubts]
        if there:
            where = _places(there, len(solved))
            text = f"the linearised scatter is doubtful at {where}: {doubt.value}"
            said.append((DOUBTFUL, text))
    doubts = {label: ", ".join(doubt.name.lower() for doubt in one.doubts) for label, one in known}
    return {
        "theta_std": (
            ("point", "parameter"),
            theta_std,
            f"standard deviation of theta {by}; infinite where no data determine it",
        ),
        "theta_covariance": (
            ("point", "parameter", "parameter_other"),
            theta,
            f"covariance of theta {by}, without directions that no data determine",
        ),
        "objective_std": (
            ("point", "group"),
            np.sqrt(np.einsum("mii->mi", J)),
            f"standard deviation of J {by}",
        ),
        "objective_covariance": (("point", "group", "group_other"), J, f"covariance of J {by}"),
        "frequency_std": (
            ("point", "mode"),
            predicted["frequency"],
            f"standard deviation of the predicted frequency in Hz {by}",
        ),
        "mac_std": (
            ("point", "mode"),
            predicted["mac"],
            f"standard deviation of the MAC with the data as they are {by}",
        ),
        "scatter_doubt": (
            ("point",),
            np.array([doubts.get(label, "") for label in labels], dtype=str),
            "why the linearised scatter may not be so; empty where nothing says that. "
            + "; ".join(f"{one.name.lower()}: {one.value}" for one in Doubt),
        ),
    }, said


def _places(labels: Sequence[str], points: int) -> str:
    """Return the labels of points, or how many of them there are."""
    return ", ".join(labels) if len(labels) <= FEW else f"{len(labels)} of {points} points"


def _without_std(problem: UpdatingProblem) -> int:
    data = problem.data
    return int(
        (np.isfinite(data.frequency) & ~(data.frequency_std > 0)).sum()
        + (np.isfinite(data.shape) & ~(data.shape_std > 0)).sum()
    )


def _std(covariance: Floats, free: Floats) -> Floats:
    """Return standard deviations, infinite for parameters that have a part in what is free."""
    return np.where(left_open(free), np.inf, np.sqrt(np.diag(covariance)))


def left_open(free: Floats) -> Bools:
    """Return the parameters that have a part in directions (p, d)."""
    out: Bools = (np.abs(free) > 1e-9 * np.abs(free).max(initial=1e-300)).any(axis=1)
    return out


def _posterior(
    problem: UpdatingProblem, front: Front, analysis: FrontAnalysis
) -> tuple[Variables, list[Finding]]:
    found = analysis.posterior
    if found is None:
        return {}, []
    names = problem.model.parameters
    said = []
    held = [name for name, at in zip(names, found.held, strict=True) if at]
    if held:
        said.append(f"the posterior is given {enumeration(held)} at a bound")
    slopes = analysis.slopes[front.reference.label]
    return {
        "posterior_std": (
            ("parameter",),
            _std(found.covariance, found.free),
            f"standard deviation of theta around {front.reference.label}, with the variance of the "
            "errors of each group unknown; infinite where no data determine it",
        ),
        "posterior_covariance": (
            ("parameter", "parameter_other"),
            found.covariance,
            "covariance of theta likewise, without directions that no data determine",
        ),
        "posterior_frequency_std": (
            ("mode",),
            np.sqrt(np.diag(linear(found.covariance, slopes["frequency"]))),
            "standard deviation of the predicted frequency in Hz likewise",
        ),
        "posterior_mac_std": (
            ("mode",),
            np.sqrt(np.diag(linear(found.covariance, slopes["mac"]))),
            "standard deviation of the MAC likewise",
        ),
    }, [(SCATTER, text) for text in said]


def _replicates(
    problem: UpdatingProblem, front: Front, analysis: FrontAnalysis
) -> tuple[Variables, list[Finding]]:
    if not analysis.replicates:
        return {}, []
    p, n = len(problem.model.parameters), len(problem.objectives)
    found = [[one.get(point.label) for point in front.points] for one in analysis.replicates]
    theta = _stacked(found, p, lambda one: one.at.theta)
    J = _stacked(found, n, lambda one: one.at.J)
    # The nominal model and points of evolutionary methods solve nothing.
    solved = [point.label in analysis.replicates[0] for point in front.points]
    failed = np.isnan(theta[:, solved]).all(axis=2)
    said = []
    if failed.any():
        said.append(f"bootstrap: {failed.sum()} of {failed.size} solutions did not converge")
    by = "with the data drawn again; NaN where it did not converge"
    return {
        "bootstrap_theta": (("replicate", "point", "parameter"), theta, f"theta {by}"),
        "bootstrap_objective": (("replicate", "point", "group"), J, f"J {by}"),
        "bootstrap_theta_std": (
            ("point", "parameter"),
            _spread(theta),
            "standard deviation of theta over the data drawn again",
        ),
        "bootstrap_objective_std": (
            ("point", "group"),
            _spread(J),
            "standard deviation of J over the data drawn again",
        ),
    }, [(SCATTER, text) for text in said]


def _stacked(
    found: Sequence[Sequence[Solution | None]], width: int, of: Callable[[Solution], Floats]
) -> Floats:
    """Return values (replicates, points, width), NaN where a solution did not converge."""
    nothing = np.full(width, np.nan)
    return np.array(
        [[of(one) if one and one.converged else nothing for one in row] for row in found]
    )


def _spread(values: Floats) -> Floats:
    """Return the standard deviation over the first dimension of what is there; NaN below two."""
    there = np.isfinite(values)
    count = there.sum(axis=0)
    mean = np.where(there, values, 0.0).sum(axis=0) / np.maximum(count, 1)
    square = np.where(there, (values - mean) ** 2, 0.0).sum(axis=0)
    return np.where(count > 1, np.sqrt(square / np.maximum(count - 1, 1)), np.nan)
