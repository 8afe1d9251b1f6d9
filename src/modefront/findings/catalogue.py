"""All kinds of findings, the most important first: how severe each is, and its sentence.

In sentences, ``{name}`` is a value, and ``{it|them}`` has the words for one and several subjects.
Those of mistakes say what is wrong before the first semicolon, and what mends it behind.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum


class Severity(Enum):
    """How severe a finding is, and which question it answers."""

    MISTAKE = "what is wrong with model or data"
    FAILURE = "what was not done"
    FIT = "how well the models do"
    CAUTION = "what to beware of"
    OPEN = "what the data leave open"
    DETAIL = "how it was found; only in full lists"


MISTAKE, FAILURE, FIT, CAUTION, OPEN, DETAIL = Severity

DETERMINE = "{where}{subject} determine {rank} of {combinations} of parameters{free}"

CATALOGUE: Mapping[str, tuple[Severity, str]] = {
    "derivatives": (
        MISTAKE,
        "derivatives {verdict} finite differences{doubt} (relative {error:.1e})",
    ),
    "superfluous": (
        MISTAKE,
        "fix {subject} at the nominal value{|s}, or measure more; the data determine the other "
        "parameters without {it|them}",
    ),
    "first-this": (MISTAKE, "put this right first: it changes what the data determine"),
    "frequency-factor": (
        MISTAKE,
        "all measured frequencies are about {factor:.3g} times the model's: {looks}; {mend}",
    ),
    "other-quantity": (
        MISTAKE,
        "the column 'frequency' looks like {quantity}: mode {mode} has {given:.4g}, which is "
        "{better:.4g} Hz; give frequencies in Hz",
    ),
    "set-factor": (
        MISTAKE,
        "all frequencies of set {set} are {size} those of {other}{looks}; {mend}",
    ),
    "set-numbers": (
        MISTAKE,
        "modes {modes} of set {set} are modes {of} of {other}, by frequencies and shapes; number "
        "the modes of set {set} like those of {other}",
    ),
    "reversed-sensor": (
        MISTAKE,
        "sensor {sensor} is reversed in {where}; check the direction of {sensor}, and change the "
        "sign of its column, or of the direction in the model",
    ),
    "exchanged-sensors": (
        MISTAKE,
        "sensors {sensors} are exchanged in {where}; check the cables of {sensors}, and exchange "
        "their columns or sensors",
    ),
    "counted-from-one": (
        MISTAKE,
        "the {what} of the sensors look as if they were counted from 1; count {what} from 0: "
        "subtract 1 from each in [model.sensors]",
    ),
    "wrong-direction": (
        MISTAKE,
        "direction {given} of {sensors} does not match the data: {better} does; check along which "
        'axis {sensors} measure{s}, and write direction = "{better}"{turn}',
    ),
    "wrong-place": (
        MISTAKE,
        "sensor {sensor} fits the data at {place} and not at {given}{too}; check where {sensor} "
        "was in the test, and write its place in [model.sensors]",
    ),
    "nominal-value": (
        MISTAKE,
        "the nominal value of {name} is {given:.4g}, and the data say about {better:.4g}; check "
        "the unit of {name}, its nominal value and its bounds",
    ),
    "bound": (
        MISTAKE,
        "the {side} bound {bound:.4g} of {name} excludes the values that fit the data; widen the "
        "bounds of {name}, or find what else differs between model and structure",
    ),
    "odd-frequency": (
        MISTAKE,
        "{who} in the frequency of mode {mode}: {f:.5g} and {other:.5g} Hz, {percent:+.1f} %; "
        "{look} value",
    ),
    "odd-shape": (MISTAKE, "{who} in the shape of mode {mode}; {look} shape"),
    "damping": (
        MISTAKE,
        "damping of {least:.3g} to {greatest:.3g} looks like percent; give the ratio to critical "
        "damping: divide the column 'damping' by 100",
    ),
    "foreign-mode": (
        MISTAKE,
        "measured mode {mode}{at} resembles none of the model's; check its shape, refine the "
        "model, or leave it out of the groups",
    ),
    "outside-model": (
        MISTAKE,
        "measured mode {subject} at {measured:.4g} Hz is outside what the model has: its {modes} "
        "end at {highest:.4g} Hz; refine the model, or leave the mode out of all groups",
    ),
    "beyond-candidates": (
        MISTAKE,
        "measured mode {subject} resembles model mode {later} at {f:.4g} Hz (MAC {mac:.2f}), which "
        "is not looked at, and none of those that are (MAC {best:.2f} or less); set spare = "
        "{spare} in [pairing]",
    ),
    "distant-pair": (
        MISTAKE,
        "measured mode {subject} at {measured:.4g} Hz is paired with model mode {model} at "
        "{f:.4g} Hz{alike}, though model mode {near} at {near_f:.4g} Hz is near; set window = 1.5 "
        "in [pairing]",
    ),
    "far-from-model": (
        MISTAKE,
        "measured mode {subject} at {measured:.4g} Hz is paired with model mode {model} at "
        "{f:.4g} Hz{alike}: none that is like it is near; check its frequency and shape, or leave "
        "the mode out of all groups",
    ),
    "data-direction": (
        MISTAKE,
        "sensor {subject} is along {model} in the model, but takes {data} of the data; write the "
        "same direction in [model.sensors] and [data.sensors]",
    ),
    "unused-group": (
        MISTAKE,
        "mesh group '{subject}' of {cells} {type} cells has no elements and holds nothing; give it "
        'a [[model.group]] name = "{subject}", or leave it out of the mesh',
    ),
    "compared-pair": (
        MISTAKE,
        "modes {subject} of the data are a pair of one frequency: their shapes are any two of a "
        "plane, and group '{group}' compares them one by one; write subspace = [{modes}], and the "
        "other modes in shape = […]",
    ),
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
