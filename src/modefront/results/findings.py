"""Findings of the analysis of a front, the most important first."""

from collections.abc import Iterator, Sequence
from itertools import compress
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.analysis.front import FrontAnalysis, followed
from modefront.analysis.manifold import Extent, Manifold
from modefront.findings.knowledge import PARTS, alike, enumeration, no_effect, summaries
from modefront.findings.record import Finding, as_text, found, in_order
from modefront.front.front import Front
from modefront.front.point import INTERNAL, Kind, label, of_kind
from modefront.identifiability.combinations import Determination
from modefront.optim.problem import AT_BOUND
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.scatter import LinearisationWarning

Determinations = Sequence[tuple[str, Determination]]
"""What is determined at the reference, then at each edge, with the labels of these."""

FEW = 10  # points that are named one by one in a sentence
VARIED = 1e-3  # change of a parameter along a manifold, over its range, from which it is named


def findings(
    problem: UpdatingProblem, front: Front, analysis: FrontAnalysis, determined: Determinations
) -> list[Finding]:
    """Return the findings; ``front`` holds all points, those of ``analysis`` too."""
    (label_of_reference, reference), names = determined[0], problem.model.parameters
    where = f"at {label_of_reference}: "
    out = [*_search(problem, front), *no_effect(reference.idle, names, where)]
    out += summaries(problem, reference, where)
    out += alike(reference.effects, names, reference.idle, where)
    out += [*_flat(problem, front, analysis), *_manifolds(problem, analysis)]
    return in_order([*out, *_scatter(problem, front, analysis)])


def as_values(findings: Sequence[Finding]) -> dict[str, list[str]]:
    """Return the variables of results that hold findings: sentences, and records."""
    return {"finding": list(map(str, findings)), "finding_record": list(map(as_text, findings))}


def _search(problem: UpdatingProblem, front: Front) -> Iterator[Finding]:
    if front.open:
        yield found("budget", enumeration(front.open))
    if not front.optimal:
        why, probable = "no regular minimum of sum a ln J was found", label(Kind.MOST_PROBABLE)
        if exact := list(compress(problem.objectives, front.exact)):
            why = (
                f"the model can fit {enumeration(exact)} exactly, where the optimal weights are "
                "not defined, and sum a ln J has no regular minimum"
            )
        then = f"use {probable}"
        if front.reference.kind is not Kind.MOST_PROBABLE:
            then = (
                f"{label(Kind.EQUAL)} takes the place of {label(Kind.OPTIMAL)}; a weight in "
                f"[noise] gives {probable}, which is better"
            )
        yield found("no-optimal-weights", label(Kind.OPTIMAL), why=why, then=then)
    for name, edge in zip(problem.objectives, front.edges, strict=True):
        if edge.doubtful:
            yield found("doubtful-edge", name, starts=edge.starts, minima=edge.found)
    for k, gap in enumerate(front.gaps, start=1):
        for at, branch, end in ((gap.end, k, "ends"), (gap.start, k + 1, "starts")):
            if at is None:
                yield found("unknown-end", str(branch), end=end)


def _flat(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Iterator[Finding]:
    part = analysis.identifiable
    total = len(of_kind(front.points, Kind.FRONT))
    said: dict[str, Any] = {"points": total, "tolerance": 100 * analysis.tolerance}
    then: dict[str, Any] = {"then": "" if part.target else "; without them it is one point"}
    for kind, counts, more in (("flat", part.flat, then), ("uncut", part.uncut, {})):
        for name, count in zip(problem.objectives, counts.tolist(), strict=True):
            if count:
                edge = label(Kind.EDGE, name)
                yield found(kind, name, edge=edge, flat=count, **said, **more)


def _manifolds(problem: UpdatingProblem, analysis: FrontAnalysis) -> Iterator[Finding]:
    """Yield which models are equivalent: how many isolated ones, and how far manifolds go.

    Manifolds of one group and dimension are in one finding.
    """
    known = followed(analysis.manifolds)
    shared: dict[int, list[str]] = {k: [of] for k, (of, _) in enumerate(known)}
    for of, manifolds in analysis.manifolds:
        isolated = sum(manifold.extent is Extent.ISOLATED for manifold in manifolds)
        if isolated > 1:
            yield found("separate", of, models=isolated)
        left = sum(x.extent is Extent.SPENT and len(x.models) == 1 for x in manifolds)
        if left:
            spent = sum(manifold.evaluations for manifold in manifolds)
            yield found("not-followed", of, many=left > 1, models=left, spent=spent)
        for manifold in manifolds:
            if manifold.twin is not None and of not in shared[manifold.twin]:
                shared[manifold.twin].append(of)
    connected: dict[tuple[str, int], list[Manifold]] = {}
    for k, (_, manifold) in enumerate(known):
        if len(manifold.models) > 1:
            connected.setdefault((enumeration(shared[k]), manifold.dimension), []).append(manifold)
    yield from (_extent(problem, of, some) for (of, _), some in connected.items())


KINDS = {1: "curve", 2: "surface"}


def _extent(problem: UpdatingProblem, of: str, manifolds: Sequence[Manifold]) -> Finding:
    """Return how far manifolds of one dimension go, of several the greatest."""
    greatest, many = max(manifolds, key=lambda x: len(x.models)), len(manifolds) > 1
    kind = KINDS.get(greatest.dimension, "manifold")
    more = "" if greatest.dimension in KINDS else f" of dimension {greatest.dimension}"
    said = f"{len(manifolds)} separate {kind}s{more}" if many else f"a {kind}{more}"
    where = "; on the greatest" if many else ":"
    reach = _far(problem, np.array([model.theta for model in greatest.models]))
    spent = f"{greatest.evaluations} eigenproblem{'s' * (greatest.evaluations != 1)}"
    count = f"{len(greatest.models)} models, by {spent}, {greatest.extent.value}"
    return found("manifold", of, many=many, manifolds=said, where=where, reach=reach, count=count)


def _far(problem: UpdatingProblem, theta: Floats) -> str:
    """Return how far parameters go among models (models, p), those that go the farthest first."""
    names, span = problem.model.parameters, problem.upper - problem.lower
    least, most = theta.min(axis=0), theta.max(axis=0)
    share = (most - least) / span
    varied = np.flatnonzero(share > VARIED)
    all_the_way = np.flatnonzero(share >= 1 - AT_BOUND)
    parts = []
    if all_the_way.size > PARTS:
        count = "all " * (all_the_way.size == len(names)) + str(all_the_way.size)
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
    values = np.concatenate([data.frequency.ravel(), data.shape.ravel()])
    std = np.concatenate([data.frequency_std.ravel(), data.shape_std.ravel()])
    if analysis.source is None:
        if np.isfinite(std).any() and not (std > 0).any():
            yield found("no-deviations")
    else:
        why = {"std": "their standard deviations", "sets": "the scatter of the data sets"}
        yield found("source", why[analysis.source])
        exact = int((np.isfinite(values) & ~(std > 0)).sum())
        if analysis.source == "std" and exact:
            yield found("exact-data", values=exact)
        kinds = {Kind.NOMINAL.value, Kind.MOST_PROBABLE.value, *INTERNAL}
        labels = [point.label for point in front.points if point.kind.value not in kinds]
        known = analysis.scatter
        if missing := [name for name in labels if name not in known]:
            yield found("no-scatter", _places(missing, len(labels)))
        for warning in LinearisationWarning:
            if warned := [x for x in labels if x in known and warning in known[x].warnings]:
                yield found("approximate", _places(warned, len(labels)), why=warning.value)
    if analysis.posterior is not None and any(analysis.posterior.held):
        held = compress(problem.model.parameters, analysis.posterior.held)
        yield found("held", enumeration(list(held)))
    solutions = [solution for each in analysis.replicates for solution in each.values()]
    if failed := sum(not solution.converged for solution in solutions):
        yield found("replicates", failed=failed, solutions=len(solutions))


def _places(labels: Sequence[str], points: int) -> str:
    return ", ".join(labels) if len(labels) <= FEW else f"{len(labels)} of {points} points"
