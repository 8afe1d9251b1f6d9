"""All kinds of findings, the most important first: how severe each is, and its sentence.

In sentences, ``{name}`` is a value, and ``{it|them}`` has the words for one and several subjects.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum


class Severity(Enum):
    """How severe a finding is, and which question it answers."""

    FAILURE = "what was not done"
    FIT = "how well the models do"
    CAUTION = "what to beware of"
    OPEN = "what the data leave open"
    DETAIL = "how it was found; only in full lists"


FAILURE, FIT, CAUTION, OPEN, DETAIL = Severity

DETERMINE = "{where}{subject} determine {rank} of {combinations} of parameters{free}"

CATALOGUE: Mapping[str, tuple[Severity, str]] = {
    "changed": (FAILURE, "{subject}"),
    "not-converged": (FAILURE, "not converged: {subject}"),
    "inaccurate": (FAILURE, "modes are less accurate than asked for at {subject}"),
    "no-test": (
        FAILURE,
        "{subject} has no test of convergence: it stopped when its {evaluations} evaluations were "
        "spent, and its points do not count as converged",
    ),
    "one-model": (FIT, "one model is the best in every group: the front is a single point"),
    "front": (
        FIT,
        "the front has {points} points; {optimal} of them are Pareto optimal: no known model "
        "is better in one group and as good in the others",
    ),
    "misfit": (
        FIT,
        "all {models} Pareto-optimal models have {whole}; {subject} has {reference}{nominal}",
    ),
    "branches": (CAUTION, "the front is not connected: it has {branches} branches"),
    "spacing": (
        CAUTION,
        "neighbours on the front are up to {gap:.3g} apart, though {requested:g} is requested: no "
        "point between them was found",
    ),
    "not-optimal": (CAUTION, "{subject}: no local Pareto optimum (a weight is negative)"),
    "jump": (
        CAUTION,
        "the objectives jump next to {subject}, as where measured modes are paired with other "
        "modes of the model: no step from there improves the model",
    ),
    "poor-pair": (
        CAUTION,
        "measured mode{|s} {subject} {resembles its|resemble their} model mode{|s} poorly (MAC "
        "below {poor}){places}",
    ),
    "changed-pair": (
        CAUTION,
        "measured mode {subject} is paired with model mode {before} at {first} and {after} at "
        "{second}",
    ),
    "changed-pairs": (
        CAUTION,
        "measured mode{|s} {subject} {is|are} paired with different model modes along the front"
        "{counts}",
    ),
    "at-bounds": (CAUTION, "parameters at a bound: {subject}"),
    "many-at-bounds": (
        CAUTION,
        "{parameters} parameters are at a bound in some models: {subject} and others",
    ),
    "budget": (
        OPEN,
        "the search ended at its budget, and better models are likely for {subject}: raise "
        "[search] evaluations",
    ),
    "no-optimal-weights": (OPEN, "there is no {subject}: {why}. {then}"),
    "doubtful-edge": (
        OPEN,
        "the edge of {subject} may not be the best: {starts} random starts led to {minima} "
        "different minima, and at most one of them to it. Ask for more with [search] evaluations, "
        "or choose a pairing that changes less",
    ),
    "unknown-end": (OPEN, "the front has a gap: where branch {subject} {end} is not known"),
    "no-effect": (
        OPEN,
        "{where}{subject} {has|have} no effect: no residual changes with {it|any of them}; keep "
        "{it|them} at the nominal value{|s}, or measure what {it changes|they change}",
    ),
    "all-data": (OPEN, DETERMINE),
    "separate": (OPEN, "{models} separate models fit {subject} equally well"),
    "manifold": (
        OPEN,
        "{manifolds} of models fit{s|} {subject} equally well{where} {reach} ({count})",
    ),
    "flat": (
        OPEN,
        "the front is flat at {edge}: beside it, {flat} of {points} points are within "
        "{tolerance:g} % of the least J of {subject}{then}",
    ),
    "uncut": (
        OPEN,
        "the front is flat at {edge}: {flat} of {points} points are within {tolerance:g} % of the "
        "least J of {subject}; where that part ends was not found, so it is not cut",
    ),
    "group-data": (OPEN, DETERMINE),
    "not-followed": (
        OPEN,
        "{models} more model{ fits|s fit} {subject} equally well: what is connected to {it|them} "
        "is not known, as the {spent} eigenproblems that [identifiability] models allows were "
        "spent before",
    ),
    "alike": (
        OPEN,
        "{where}{subject} have nearly the same effect on all residuals: fix or tie {one|all but "
        "one}",
    ),
    "no-deviations": (OPEN, "no standard deviation is above 0: none is used"),
    "source": (OPEN, "uncertainty of the data is taken from {subject}"),
    "exact-data": (
        OPEN,
        "{values} measured values have no standard deviation above 0: they count as exact",
    ),
    "held": (OPEN, "the posterior is given {subject} at a bound"),
    "replicates": (OPEN, "bootstrap: {failed} of {solutions} solutions did not converge"),
    "no-scatter": (OPEN, "no standard deviations are known at {subject}"),
    "approximate": (OPEN, "standard deviations are approximate at {subject}: {why}"),
    "determined": (OPEN, DETERMINE),
    "ranges": (
        OPEN,
        "over all {models} Pareto-optimal models, that is for all weights of the groups, {subject}",
    ),
    "spread": (
        OPEN,
        "predictions of the Pareto-optimal models differ: {subject}. This is what the choice of "
        "weights leaves open; what errors of the data leave open is the posterior",
    ),
    "no-posterior": (OPEN, "there is no posterior: no models are drawn from it"),
    "open-in-posterior": (
        OPEN,
        "the posterior of predictions is that of what the data determine: where they leave "
        "{subject} open, the models are those of {reference}",
    ),
    "no-room": (OPEN, "{subject} has no room for differences between bounds: see draws"),
    "no-draws": (OPEN, "no models are drawn: the posterior is wider than the bounds ({subject})"),
    "no-deviation": (
        OPEN,
        "no posterior standard deviation of {subject}: models within one of {reference} cannot be "
        "solved, or {undefined}",
    ),
    "unsolved-draws": (
        OPEN,
        "{count} of {drawn} models drawn from the posterior {what} for {subject}: they are left "
        "out",
    ),
    "other": (OPEN, "{subject}"),
    "exact-fit": (
        DETAIL,
        "the model can fit {subject} exactly, where the optimal weights are not defined: "
        "optimal-weights is the regular minimum",
    ),
    "iteration-ends": (
        DETAIL,
        "the fixed-point iteration of the weights ends at an exact fit and confirms nothing",
    ),
    "iteration-agrees": (
        DETAIL,
        "the fixed-point iteration of the weights finds the same optimally weighted model",
    ),
    "iteration-differs": (
        DETAIL,
        "the optimal weights are not unique: their fixed-point iteration finds a second set",
    ),
    "branch-ends": (
        DETAIL,
        "the front has a gap: branch {subject} ends at J = {end}, branch {other} starts at J = "
        "{start}",
    ),
    "between-branches": (
        DETAIL,
        "{subject}: dominated by a known model that is no point of the front, such as the start "
        "of a branch",
    ),
    "remark": (DETAIL, "{subject}"),
    "reduced": (
        DETAIL,
        "reduced basis from {full} full eigensolutions and {corrected} corrected with their "
        "factors: relative errors of eigenvalues up to {eigenvalue:.1e} (estimated; tolerance "
        "{tolerance:.0e}), of shapes up to {shape:.1e}",
    ),
    "not-reduced": (
        DETAIL,
        "predictions are not reduced: they took {full} full eigensolutions",
    ),
    "above-tolerance": (DETAIL, "above the tolerance: {subject}"),
    "within-tolerance": (DETAIL, "within the tolerance: {subject}"),
    "coverage": (
        DETAIL,
        "hypervolume {hypervolume:.5f} up to 1.1 (what the front dominates; more is better), IGD+ "
        "{igd:.2e} (mean distance of all nondominated models that are known from it; 0 is best), "
        "largest gap {gap:.3f} between neighbours, all in units of the ranges of the objectives "
        "over the edges{missing}",
    ),
    "effort": (
        DETAIL,
        "{spent} eigenproblems in all, {front} of them for the points of the front",
    ),
}
"""Severity and sentence of each kind, by its name."""
