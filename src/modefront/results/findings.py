"""Findings of the analysis of a front as sentences, the most important first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import IntEnum

import numpy as np

from modefront._typing import Floats
from modefront.analysis.front import FrontAnalysis, followed
from modefront.analysis.manifold import Extent, Manifold
from modefront.front.front import Front
from modefront.front.point import Kind, label, of_kind
from modefront.identifiability.words import (
    PARTS,
    alike_in_words,
    determined,
    enumeration,
    measured_noun,
    no_effect_in_words,
    summary,
)
from modefront.optim.problem import AT_BOUND
from modefront.residuals.problem import UpdatingProblem
from modefront.results.analysis import Determination
from modefront.uncertainty.validity import LinearisationWarning


class Rank(IntEnum):
    """Order of findings."""

    BUDGET = 0
    WEIGHTS = 1
    IDLE = 2
    ALL_DATA = 3
    MANIFOLD = 4
    FLAT = 5
    OF_GROUP = 6
    SPENT = 7
    ALIKE = 8
    SCATTER = 9
    LINEARISATION = 10
    DETERMINED = 11


Finding = tuple[Rank, str]
"""A sentence with its place in the order."""

FEW = 10
"""Points that are named one by one in a sentence."""

VARIED = 1e-3
"""Change of a parameter along a manifold, over its range, from which it is named."""


def findings(
    problem: UpdatingProblem,
    front: Front,
    analysis: FrontAnalysis,
    determinations: Sequence[Determination],
) -> list[str]:
    """Return the sentences; ``front`` holds all points, those of ``analysis`` too."""
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
    return [text for _, text in sorted(out, key=lambda finding: finding[0])]


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
    return [(Rank.WEIGHTS, f"there is no {label(Kind.OPTIMAL)}: {why}. {then}")]


def _open(front: Front) -> list[Finding]:
    """Return what the search had not finished when its budget was spent."""
    if not front.open:
        return []
    what = enumeration(front.open)
    text = f"the search ended at its budget, and better models are likely for {what}: raise "
    return [(Rank.BUDGET, f"{text}[search] evaluations")]


def _doubtful(problem: UpdatingProblem, front: Front) -> Iterator[Finding]:
    """Yield which edges may not be the best there are."""
    for name, edge in zip(problem.objectives, front.edges, strict=True):
        if edge.doubtful:
            yield (
                Rank.WEIGHTS,
                f"the edge of {name} may not be the best: {edge.starts} random starts led to "
                f"{edge.found} different minima, and at most one of them to it. Ask for more with "
                "[search] doubt = 0.01, or choose a pairing that changes less",
            )


def _unknown_ends(front: Front) -> list[Finding]:
    """Return which ends of branches are not known."""
    out = []
    for k, gap in enumerate(front.gaps):
        if gap.end is None:
            out.append(f"the front has a gap: where branch {k + 1} ends is not known")
        if gap.start is None:
            out.append(f"the front has a gap: where branch {k + 2} starts is not known")
    return [(Rank.WEIGHTS, text) for text in out]


def _identifiability(problem: UpdatingProblem, reference: Determination) -> Iterator[Finding]:
    """Yield the determined combinations of parameters at the reference."""
    names, groups, where = problem.model.parameters, problem.groups, reference.point.label
    for text in no_effect_in_words(reference.idle, names):
        yield Rank.IDLE, f"at {where}: {text}"
    for i, (name, combinations) in enumerate(reference.combinations):
        whole = i == len(groups)
        noun = measured_noun(groups if whole else [groups[i]])
        full = determined(combinations) == (len(names) - len(reference.idle), 0)
        rank = Rank.DETERMINED if full else Rank.ALL_DATA if whole else Rank.OF_GROUP
        text = summary(name, noun, combinations, names, reference.scale, reference.idle)
        yield rank, f"at {where}: {text}"
    for text in alike_in_words(reference.effects, names, reference.idle):
        yield Rank.ALIKE, f"at {where}: {text}"


def _flat(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Iterator[Finding]:
    """Yield at which edges the front is flat."""
    part = analysis.identifiable
    if part is None:
        return
    total = len(of_kind(front.points, Kind.FRONT))
    within = f"within {100 * analysis.tolerance:g} % of the least J of"
    for name, count in zip(problem.objectives, part.flat.tolist(), strict=True):
        if count:
            yield (
                Rank.FLAT,
                f"the front is flat at {label(Kind.EDGE, name)}: beside it, {count} of {total} "
                f"points are {within} {name}"
                + ("" if part.points else "; without them it is one point"),
            )
    for name, count in zip(problem.objectives, part.uncut.tolist(), strict=True):
        if count:
            yield (
                Rank.FLAT,
                f"the front is flat at {label(Kind.EDGE, name)}: {count} of {total} points are "
                f"{within} {name}; where that part ends was not found, so it is not cut",
            )


def _separate(analysis: FrontAnalysis) -> list[Finding]:
    """Return how many isolated models are equivalent."""
    out: list[Finding] = []
    for of, manifolds in analysis.manifolds:
        isolated = sum(manifold.extent is Extent.ISOLATED for manifold in manifolds)
        if isolated > 1:
            out.append((Rank.MANIFOLD, f"{isolated} separate models fit {of} equally well"))
        left = sum(
            manifold.extent is Extent.SPENT and len(manifold.models) == 1 for manifold in manifolds
        )
        if left:
            spent = sum(manifold.evaluations for manifold in manifolds)
            out.append(
                (
                    Rank.SPENT,
                    f"{left} more model{'s fit' if left > 1 else ' fits'} {of} equally well: what "
                    f"is connected to {'them' if left > 1 else 'it'} is not known, as the "
                    f"{spent} eigenproblems that [identifiability] models allows were spent before",
                )
            )
    return out


def _connected(problem: UpdatingProblem, analysis: FrontAnalysis) -> list[Finding]:
    """Return how far manifolds go, those of one group and dimension at once."""
    known = followed(analysis.manifolds)
    shared: dict[int, list[str]] = {k: [of] for k, (of, _) in enumerate(known)}
    for of, manifolds in analysis.manifolds:
        for manifold in manifolds:
            if manifold.twin is not None and of not in shared[manifold.twin]:
                shared[manifold.twin].append(of)
    alike: dict[tuple[str, int], list[Manifold]] = {}
    for k, (_, manifold) in enumerate(known):
        if len(manifold.models) > 1:
            alike.setdefault((enumeration(shared[k]), manifold.dimension), []).append(manifold)
    return [(Rank.MANIFOLD, _extent(problem, of, some)) for (of, _), some in alike.items()]


KINDS = {1: "curve", 2: "surface"}


def _extent(problem: UpdatingProblem, of: str, manifolds: Sequence[Manifold]) -> str:
    """Return how far manifolds of one dimension go, of several the greatest."""
    greatest = max(manifolds, key=lambda greatest: len(greatest.models))
    kind = KINDS.get(greatest.dimension, "manifold")
    spent = f"{greatest.evaluations} eigenproblem{'s' * (greatest.evaluations != 1)}"
    count = f"{len(greatest.models)} models, by {spent}, {greatest.extent.value}"
    more = "" if greatest.dimension in KINDS else f" of dimension {greatest.dimension}"
    far = _far(problem, np.array([model.theta for model in greatest.models]))
    if len(manifolds) == 1:
        return f"a {kind}{more} of models fits {of} equally well: {far} ({count})"
    return (
        f"{len(manifolds)} separate {kind}s{more} of models fit {of} equally well; "
        f"on the greatest {far} ({count})"
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


def _scatter(problem: UpdatingProblem, front: Front, analysis: FrontAnalysis) -> Iterator[Finding]:
    """Yield where the uncertainty of the data is taken from, and where it is not valid."""
    data = problem.data
    if analysis.source is None:
        given = np.isfinite(data.frequency_std).any() or np.isfinite(data.shape_std).any()
        used = (data.frequency_std > 0).any() or (data.shape_std > 0).any()
        if given and not used:
            yield Rank.SCATTER, "no standard deviation is above 0: none is used"
        return
    why = {"std": "their standard deviations", "sets": "the scatter of the data sets"}
    yield Rank.SCATTER, f"uncertainty of the data is taken from {why[analysis.source]}"
    unknown = _without_std(problem) if analysis.source == "std" else 0
    if unknown:
        yield (
            Rank.SCATTER,
            f"{unknown} measured values have no standard deviation above 0: they count as exact",
        )
    labels = [point.label for point in front.points if point.kind is not Kind.NOMINAL]
    missing = [name for name in labels if name not in analysis.scatter]
    if missing:
        where = _places(missing, len(labels))
        yield Rank.LINEARISATION, f"no standard deviations are known at {where}"
    for warning in LinearisationWarning:
        warned = [
            name
            for name in labels
            if name in analysis.scatter and warning in analysis.scatter[name].warnings
        ]
        if warned:
            where = _places(warned, len(labels))
            yield (
                Rank.LINEARISATION,
                f"standard deviations are approximate at {where}: {warning.value}",
            )


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
        yield Rank.SCATTER, f"the posterior is given {enumeration(held)} at a bound"


def _replicates(analysis: FrontAnalysis) -> Iterator[Finding]:
    """Yield how many solutions with data drawn again failed."""
    solutions = [solution for each in analysis.replicates for solution in each.values()]
    failed = sum(not solution.converged for solution in solutions)
    if failed:
        yield (
            Rank.SCATTER,
            f"bootstrap: {failed} of {len(solutions)} solutions did not converge",
        )
