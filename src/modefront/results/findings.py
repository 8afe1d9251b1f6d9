"""Findings of the analysis of a front, the most important first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.analysis.front import FrontAnalysis, followed
from modefront.analysis.manifold import Extent, Manifold
from modefront.findings.knowledge import (
    PARTS,
    alike,
    determined,
    enumeration,
    measured_noun,
    no_effect,
    summary,
)
from modefront.findings.record import Finding, as_text, found, in_order
from modefront.front.front import Front
from modefront.front.point import Kind, label, of_kind
from modefront.optim.problem import AT_BOUND
from modefront.residuals.problem import UpdatingProblem
from modefront.results.analysis import Determination, Values
from modefront.uncertainty.validity import LinearisationWarning

FEW = 10
"""Points that are named one by one in a sentence."""

VARIED = 1e-3
"""Change of a parameter along a manifold, over its range, from which it is named."""


def findings(
    problem: UpdatingProblem,
    front: Front,
    analysis: FrontAnalysis,
    determinations: Sequence[Determination],
) -> list[Finding]:
    """Return the findings; ``front`` holds all points, those of ``analysis`` too."""
    out = [
        *_open(front),
        *_weights(problem, front),
        *_doubtful(problem, front),
        *_unknown_ends(front),
        *_identifiability(problem, determinations[0]),
        *_flat(problem, front, analysis),
        *_separate(analysis),
        *_connected(problem, analysis),
        *_scatter(problem, front, analysis),
        *_held(problem, analysis),
        *_replicates(analysis),
    ]
    return in_order(out)


def as_values(findings: Sequence[Finding]) -> Values:
    """Return the variables of results that hold findings: sentences, and records."""
    return {
        "finding": [str(finding) for finding in findings],
        "finding_record": [as_text(finding) for finding in findings],
    }


def _weights(problem: UpdatingProblem, front: Front) -> list[Finding]:
    """Return why there is no optimally weighted model, where there is none."""
    if front.optimal:
        return []
    exact = [name for name, fits in zip(problem.objectives, front.exact, strict=True) if fits]
    if exact:
        why = (
            f"the model can fit {enumeration(exact)} exactly, where the optimal weights are not "
            "defined, and sum a ln J has no regular minimum"
        )
    else:
        why = "no regular minimum of sum a ln J was found"
    if front.reference.kind is Kind.MOST_PROBABLE:
        then = f"use {label(Kind.MOST_PROBABLE)}"
    else:
        then = (
            f"{label(Kind.EQUAL)} takes the place of {label(Kind.OPTIMAL)}; a weight in [noise] "
            f"gives {label(Kind.MOST_PROBABLE)}, which is better"
        )
    return [found("no-optimal-weights", label(Kind.OPTIMAL), why=why, then=then)]


def _open(front: Front) -> list[Finding]:
    """Return what the search had not finished when its budget was spent."""
    return [found("budget", enumeration(front.open))] if front.open else []


def _doubtful(problem: UpdatingProblem, front: Front) -> Iterator[Finding]:
    """Yield which edges may not be the best there are."""
    for name, edge in zip(problem.objectives, front.edges, strict=True):
        if edge.doubtful:
            yield found("doubtful-edge", name, starts=edge.starts, minima=edge.found)


def _unknown_ends(front: Front) -> list[Finding]:
    """Return which ends of branches are not known."""
    out = []
    for k, gap in enumerate(front.gaps):
        if gap.end is None:
            out.append(found("unknown-end", str(k + 1), end="ends"))
        if gap.start is None:
            out.append(found("unknown-end", str(k + 2), end="starts"))
    return out


def _identifiability(problem: UpdatingProblem, reference: Determination) -> Iterator[Finding]:
    """Yield the determined combinations of parameters at the reference."""
    names, groups = problem.model.parameters, problem.groups
    where = f"at {reference.point.label}: "
    yield from no_effect(reference.idle, names, where)
    for i, (name, combinations) in enumerate(reference.combinations):
        whole = i == len(groups)
        noun = measured_noun(groups if whole else [groups[i]])
        full = determined(combinations) == (len(names) - len(reference.idle), 0)
        kind = "determined" if full else "all-data" if whole else "group-data"
        of = (reference.scale, reference.idle)
        yield summary(name, noun, combinations, names, *of, kind=kind, where=where)
    yield from alike(reference.effects, names, reference.idle, where)


def _flat(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Iterator[Finding]:
    """Yield at which edges the front is flat."""
    part = analysis.identifiable
    if part is None:
        return
    total = len(of_kind(front.points, Kind.FRONT))
    said: dict[str, Any] = {"points": total, "tolerance": 100 * analysis.tolerance}
    for name, count in zip(problem.objectives, part.flat.tolist(), strict=True):
        if count:
            then = "" if part.points else "; without them it is one point"
            edge = label(Kind.EDGE, name)
            yield found("flat", name, edge=edge, flat=count, then=then, **said)
    for name, count in zip(problem.objectives, part.uncut.tolist(), strict=True):
        if count:
            yield found("uncut", name, edge=label(Kind.EDGE, name), flat=count, **said)


def _separate(analysis: FrontAnalysis) -> list[Finding]:
    """Return how many isolated models are equivalent."""
    out = []
    for of, manifolds in analysis.manifolds:
        isolated = sum(manifold.extent is Extent.ISOLATED for manifold in manifolds)
        if isolated > 1:
            out.append(found("separate", of, models=isolated))
        left = sum(
            manifold.extent is Extent.SPENT and len(manifold.models) == 1 for manifold in manifolds
        )
        if left:
            spent = sum(manifold.evaluations for manifold in manifolds)
            out.append(found("not-followed", of, many=left > 1, models=left, spent=spent))
    return out


def _connected(problem: UpdatingProblem, analysis: FrontAnalysis) -> list[Finding]:
    """Return how far manifolds go, those of one group and dimension at once."""
    known = followed(analysis.manifolds)
    shared: dict[int, list[str]] = {k: [of] for k, (of, _) in enumerate(known)}
    for of, manifolds in analysis.manifolds:
        for manifold in manifolds:
            if manifold.twin is not None and of not in shared[manifold.twin]:
                shared[manifold.twin].append(of)
    connected: dict[tuple[str, int], list[Manifold]] = {}
    for k, (_, manifold) in enumerate(known):
        if len(manifold.models) > 1:
            connected.setdefault((enumeration(shared[k]), manifold.dimension), []).append(manifold)
    return [_extent(problem, of, some) for (of, _), some in connected.items()]


KINDS = {1: "curve", 2: "surface"}


def _extent(problem: UpdatingProblem, of: str, manifolds: Sequence[Manifold]) -> Finding:
    """Return how far manifolds of one dimension go, of several the greatest."""
    greatest = max(manifolds, key=lambda greatest: len(greatest.models))
    kind = KINDS.get(greatest.dimension, "manifold")
    spent = f"{greatest.evaluations} eigenproblem{'s' * (greatest.evaluations != 1)}"
    count = f"{len(greatest.models)} models, by {spent}, {greatest.extent.value}"
    more = "" if greatest.dimension in KINDS else f" of dimension {greatest.dimension}"
    far = _far(problem, np.array([model.theta for model in greatest.models]))
    many = len(manifolds) > 1
    named = f"{len(manifolds)} separate {kind}s{more}" if many else f"a {kind}{more}"
    where = "; on the greatest" if many else ":"
    return found("manifold", of, many=many, manifolds=named, where=where, reach=far, count=count)


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


def _scatter(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Iterator[Finding]:
    """Yield where the uncertainty of the data is taken from, and where it is not valid."""
    data = problem.data
    if analysis.source is None:
        given = np.isfinite(data.frequency_std).any() or np.isfinite(data.shape_std).any()
        used = (data.frequency_std > 0).any() or (data.shape_std > 0).any()
        if given and not used:
            yield found("no-deviations")
        return
    why = {"std": "their standard deviations", "sets": "the scatter of the data sets"}
    yield found("source", why[analysis.source])
    unknown = _without_std(problem) if analysis.source == "std" else 0
    if unknown:
        yield found("exact-data", values=unknown)
    labels = [point.label for point in front.points if point.kind is not Kind.NOMINAL]
    missing = [name for name in labels if name not in analysis.scatter]
    if missing:
        yield found("no-scatter", _places(missing, len(labels)))
    for warning in LinearisationWarning:
        warned = [
            name
            for name in labels
            if name in analysis.scatter and warning in analysis.scatter[name].warnings
        ]
        if warned:
            yield found("approximate", _places(warned, len(labels)), why=warning.value)


def _places(labels: Sequence[str], points: int) -> str:
    """Return the labels of points, or how many of them there are."""
    return ", ".join(labels) if len(labels) <= FEW else f"{len(labels)} of {points} points"


def _without_std(problem: UpdatingProblem) -> int:
    data = problem.data
    return int(
        (np.isfinite(data.frequency) & ~(data.frequency_std > 0)).sum()
        + (np.isfinite(data.shape) & ~(data.shape_std > 0)).sum()
    )


def _held(problem: UpdatingProblem, analysis: FrontAnalysis) -> Iterator[Finding]:
    """Yield which parameters the posterior holds at a bound."""
    if analysis.posterior is None:
        return
    parameters = zip(problem.model.parameters, analysis.posterior.held, strict=True)
    held = [name for name, is_held in parameters if is_held]
    if held:
        yield found("held", enumeration(held))


def _replicates(analysis: FrontAnalysis) -> Iterator[Finding]:
    """Yield how many solutions with data drawn again failed."""
    solutions = [solution for each in analysis.replicates for solution in each.values()]
    failed = sum(not solution.converged for solution in solutions)
    if failed:
        yield found("replicates", failed=failed, solutions=len(solutions))
