"""All sentences by their kinds: of findings, the most important first, and of the verdict.

A row has a kind and its sentence. A heading is how severe the findings below it are. In sentences,
``{name}`` is a value, and ``{it|them}`` has the words for one and several subjects. Those of
mistakes say what is wrong before the first semicolon, and what mends it behind.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from enum import Enum


class Severity(Enum):
    """How severe a finding is, and which question it answers."""

    MISTAKE = "what is wrong with model or data"
    FAILURE = "what was not done"
    FIT = "how well the models do"
    CAUTION = "what to beware of"
    OPEN = "what the data leave open"
    DETAIL = "how it was found; only in full lists"


_FINDINGS = """\
# MISTAKE
derivatives | derivatives {verdict} finite differences{doubt} (relative {error:.1e})
superfluous | fix {subject} at the nominal value{|s}, or measure more; the data determine the other
    parameters without {it|them}
first-this | put this right first: it changes what the data determine
frequency-factor | all measured frequencies are about {factor:.3g} times the model's: {looks};
    {mend}
other-quantity | the column 'frequency' looks like {quantity}: mode {mode} has {given:.4g}, which
    is {better:.4g} Hz; give frequencies in Hz
set-factor | all frequencies of set {set} are {size} those of {other}{looks}; {mend}
set-numbers | modes {modes} of set {set} are modes {of} of {other}, by frequencies and shapes;
    number the modes of set {set} like those of {other}
reversed-sensor | sensor {sensor} is reversed in {where}; check the direction of {sensor}, and
    change the sign of its column, or of the direction in the model
exchanged-sensors | sensors {sensors} are exchanged in {where}; check the cables of {sensors}, and
    exchange their columns or sensors
copied-sensor | sensor {sensor} has the same digits as {other} and should not; look for its own
    values in the test, or leave them empty
sensor-factor | the values of sensor {sensor} in {where} are {factor:.3g} times what the others say;
    check unit and sensitivity of {sensor}, and divide its column by {factor:.3g}
shifted-values | shapes of {where} look as if a value were {what} at sensor {sensor} and the rest
    moved; compare the columns with the test, and put them below their sensors
counted-from-one | the {what} of the sensors look as if they were counted from 1; count {what} from
    0: subtract 1 from each in [model.sensors]
wrong-direction | direction {given} of {sensors} does not match the data: {better} does; check
    along which axis {sensors} measure{s}, and write direction = "{better}"{turn}
wrong-place | sensor {sensor} fits the data at {place} and not at {given}{too}; check where
    {sensor} was in the test, and write its place in [model.sensors]
nominal-value | the nominal value of {name} is {given:.4g}, and the data say about {better:.4g};
    check the unit of {name}, its nominal value and its bounds
bound | {at}. With {where}, errors of {group} are {after:.2g} of those expected instead of
    {before:.2g}; widen {its} bounds, or ask what the model lacks
odd-frequency | {who} in the frequency of mode {mode}: {f:.5g} and {other:.5g} Hz, {percent:+.1f}
    %; {look} value
odd-shape | {who} in the shape of mode {mode}; {look} shape
damping | damping of {least:.3g} to {greatest:.3g} looks like percent; give the ratio to critical
    damping: divide the column 'damping' by 100
foreign-mode | measured mode {mode}{at} resembles none of the model's; check its shape, refine the
    model, or leave it out of the groups
outside-model | measured mode {subject} at {measured:.4g} Hz is outside what the model has: its
    {modes} lowest modes end at {highest:.4g} Hz; refine the model, or leave the mode out of all
    groups
beyond-candidates | measured mode {subject} resembles model mode {later} at {f:.4g} Hz (MAC
    {mac:.2f}), which is not looked at, and none of those that are (MAC {best:.2f} or less); set
    spare = {spare} in [pairing]
distant-pair | measured mode {subject} at {measured:.4g} Hz is paired with model mode {model} at
    {f:.4g} Hz{alike}, though model mode {near} at {there:.4g} Hz is near; set window = 1.5 in
    [pairing]
far-from-model | measured mode {subject} at {measured:.4g} Hz is paired with model mode {model} at
    {f:.4g} Hz{alike}: none that is like it is near{looks}; check its frequency and shape, or leave
    the mode out of all groups
data-direction | sensor {subject} is along {model} in the model, but takes {data} of the data;
    write the same direction in [model.sensors] and [data.sensors]
unused-group | mesh group '{subject}' of {cells} {type} cells has no elements and holds nothing;
    give it a [[model.group]] name = "{subject}", or leave it out of the mesh
compared-pair | modes {subject} of the data are a pair of one frequency: their shapes are any two
    of a plane, and group '{group}' compares them one by one; write subspace = [{modes}], and the
    other modes in shape = […]
no-model-near | the derivatives differ from finite differences for {subject}: a small change leads
    to no model: {why}; check its value and units
close-modes | the derivatives differ from finite differences of group '{group}' for {subject},
    mostly by measured mode {mode} (relative {error:.1e}): model mode {model} and its neighbour are
    {apart:.2g} % apart, and close modes turn into each other within a small change of the parameter
unlike-effects | the derivatives differ from finite differences of group '{group}' for {subject},
    mostly by measured mode {mode} (relative {error:.1e}): parameters differ by {ratio:.0e} in
    their effect; check units of the matrices, and whether a stiffness vanishes
little-effect | the derivatives differ from finite differences of group '{group}' for {subject},
    mostly by measured mode {mode} (relative {error:.1e}): the parameter has so little effect that a
    step beyond its own size is needed to see any; check its value, its units, and whether a
    stiffness vanishes
not-smooth | the derivatives differ from finite differences of group '{group}' for {subject}, mostly
    by measured mode {mode} (relative {error:.1e}): the model does not change smoothly there, or
    digits are lost in it; check its units, and whether a stiffness or mass vanishes; derivatives of
    a Python model have to be those of its matrices
# FAILURE
not-converged | not converged: {subject}
inaccurate | modes are less accurate than asked for at {subject}
no-test | {subject} has no test of convergence: it stopped when its {evaluations} evaluations were
    spent, and its points do not count as converged
# FIT
one-model | one model is the best in every group: the front is a single point
front | the front has {points} points; {optimal} of them are Pareto optimal: no known model is
    better in one group and as good in the others
misfit | all {models} Pareto-optimal models have {whole}; {subject} has {reference}{nominal}
# CAUTION
branches | the front is not connected: it has {branches} branches
spacing | neighbours on the front are up to {gap:.3g} apart, though {requested:g} is requested: no
    point between them was found
not-optimal | no local Pareto optimum, as a weight is negative: {subject}
jump | the objectives jump next to {subject}, as where measured modes are paired with other modes
    of the model: no step from there improves the model
poor-pair | measured mode{|s} {subject} {resembles its|resemble their} model mode{|s} poorly (MAC
    below {poor}){places}
changed-pair | measured mode {subject} is paired with model mode {before} at {first} and {after} at
    {second}
changed-pairs | measured mode{|s} {subject} {is|are} paired with different model modes along the
    front{counts}
at-bounds | parameters at a bound: {subject}
many-at-bounds | {parameters} parameters are at a bound in some models: {subject} and others
coincident | mode {subject} of the nominal model coincides with another one: its derivatives are not
    defined
nominal-at-bound | the nominal value of {subject} is one of its bounds, {bound:g}
no-model-at-bounds | at the {subject} bounds of all parameters: {why}
elements | {subject}
many-sets | {subject} data sets are many: mistakes are sought in {searched} of them, chosen evenly
many-parameters | {subject} parameters are many: a run takes some {size:.2g} GB and long, as every
    step solves for all of them; let one parameter scale several parts, or keep those at their
    nominal values that the data do not determine
# OPEN
budget | the search ended at its budget, and better models are likely for {subject}: raise [search]
    evaluations
no-optimal-weights | there is no {subject}: {why}. {then}
doubtful-edge | the edge of {subject} may not be the best: {starts} random starts led to {minima}
    different minima, and at most one of them to it. Ask for more with [search] evaluations, or
    choose a pairing that changes less
unknown-end | the front has a gap: where branch {subject} {end} is not known
no-effect | {where}{subject} {has|have} no effect: no residual changes with {it|any of them}; keep
    {it|them} at the nominal value{|s}, or measure what {it changes|they change}
undetermined | the data {degree} {subject}: fix or tie one, or measure more
undetermined-many | the data {degree} {several} of {every} combinations of parameters: take fewer
    parameters, or measure more
all-data | {where}{subject} determine {rank} of {combinations} of parameters{free}
separate | {models} separate models fit {subject} equally well
manifold | {manifolds} of models fit{s|} {subject} equally well{where} {reach} ({count})
flat | the front is flat at {edge}: beside it, {flat} of {points} points are within {tolerance:g} %
    of the least J of {subject}{then}
uncut | the front is flat at {edge}: {flat} of {points} points are within {tolerance:g} % of the
    least J of {subject}; where that part ends was not found, so it is not cut
group-data | {where}{subject} determine {rank} of {combinations} of parameters{free}
not-followed | {models} more model{ fits|s fit} {subject} equally well: what is connected to
    {it|them} is not known, as the {spent} eigenproblems that [identifiability] models allows were
    spent before
alike | {where}{subject} have nearly the same effect on all residuals: fix or tie {one|all but one}
no-deviations | no standard deviation is above 0: none is used
source | uncertainty of the data is taken from {subject}
exact-data | {values} measured values have no standard deviation above 0: they count as exact
held | the posterior is given {subject} at a bound
replicates | bootstrap: {failed} of {solutions} solutions did not converge
no-scatter | no standard deviations are known at {subject}
approximate | standard deviations are approximate at {subject}: {why}
determined | {where}{subject} determine {rank} of {combinations} of parameters{free}
ranges | over all {models} Pareto-optimal models, that is for all weights of the groups, {subject}
spread | predictions of the Pareto-optimal models differ: {subject}. This is what the choice of
    weights leaves open; what errors of the data leave open is the posterior
no-posterior | there is no posterior: no models are drawn from it
open-in-posterior | the posterior of predictions is that of what the data determine: where they
    leave {subject} open, the models are those of {reference}
no-room | {subject} has no room for differences between bounds: see draws
no-draws | no models are drawn: the posterior is wider than the bounds ({subject})
no-deviation | no posterior standard deviation of {subject}: models within one of {reference}
    cannot be solved, or {undefined}
unsolved-draws | {count} of {drawn} models drawn from the posterior {what} for {subject}: they are
    left out
other | {subject}
# DETAIL
exact-fit | the model can fit {subject} exactly, where the optimal weights are not defined:
    optimal-weights is the regular minimum
iteration-ends | the fixed-point iteration of the weights ends at an exact fit and confirms nothing
iteration-agrees | the fixed-point iteration of the weights finds the same optimally weighted model
iteration-differs | the optimal weights are not unique: their fixed-point iteration finds a second
    set
branch-ends | the front has a gap: branch {subject} ends at J = {end}, branch {other} starts at J =
    {start}
between-branches | dominated by a known model that is no point of the front, such as the start of a
    branch: {subject}
remark | {subject}
reduced | reduced basis from {full} full eigensolutions and {corrected} corrected with their
    factors: relative errors of eigenvalues up to {eigenvalue:.1e} (estimated; tolerance
    {tolerance:.0e}), of shapes up to {shape:.1e}
not-reduced | predictions are not reduced: they took {full} full eigensolutions
above-tolerance | above the tolerance: {subject}
within-tolerance | within the tolerance: {subject}
coverage | hypervolume {hypervolume:.5f} up to 1.1 (what the front dominates; more is better), IGD+
    {igd:.2e} (mean distance of all nondominated models that are known from it; 0 is best), largest
    gap {gap:.3f} between neighbours, all in units of the ranges of the objectives over the
    edges{missing}
effort | {spent} eigenproblems in all, {front} of them for the points of the front
"""

_VERDICT = """\
do-not-use | Do not use any of these models: {why}.
far | errors of {group} are {misfit:.2g} times those expected
worse | {group} fits worse than at the nominal model
use | Use {reference}: its errors over those expected are {errors}.
unjudged | Use {reference}: it has {fit}; the nominal model has {nominal}.
bought | But {why}: ask what the model lacks.
not-judged | How sure it is, or whether to use no model, is not judged with weight = 0 in [noise];
    without that line it is.
lacks | They are larger than noise: the model lacks something.
at-bound | {at}: widen {it}, or ask what the model lacks.
at-harmless-bound | {at}: wider bounds lower no errors by more than {gain:.0f} %.
wrong-fixed | With {name} = {value:.3g}, which is fixed, errors of {group} are {after:.2g} of those
    expected instead of {before:.2g}: write fixed = false in its [[parameter]].
assumed | Assumed: {assumed}; say yours in [noise].
unlike | Shapes at these sensors do not tell which modes of the model are those measured as
    {modes}: frequencies decide here. The front pairs them by the MAC, and may be wrong.
unsettled | The chains that draw from the posterior do not agree: intervals are rough, and no
    parameter is called determined. Narrower bounds, fewer parameters or more data help.
determined | Determined (90 %): {parameters}.
partly | Partly (90 %): {parameters}.
not determined | Not determined (90 %): {parameters}.
measure | Measure {what}: the interval of {name} becomes {gain:.0f} % narrower.
leave-open-less | Or leave open less, in [[parameter]] of {lines}.
agree | Along the front errors of {group} change by {change:.2g} of those expected: the compromise
    hardly matters.
compromise | The front is a compromise: along it errors of {group} change by {change:.2g} times
    those expected.
prediction | {name}, {place}: {quantity} {low:.3g} to {high:.3g} (90 %), {least:.3g} to
    {greatest:.3g} over the front.
"""


def _rows(table: str) -> Iterator[tuple[Severity, str, str]]:
    """Yield severity, kind and sentence of each row."""
    severity = Severity.DETAIL
    for row in re.sub(r"\n {4}", " ", table).splitlines():
        kind, _, sentence = row.partition(" | ")
        if sentence:
            yield severity, kind, sentence
        else:
            severity = Severity[kind.removeprefix("# ")]


CATALOGUE: Mapping[str, tuple[Severity, str]] = {
    kind: (severity, sentence) for severity, kind, sentence in _rows(_FINDINGS)
}
"""Severity and sentence of each kind of findings, by its name."""

VERDICT: Mapping[str, str] = {kind: sentence for _, kind, sentence in _rows(_VERDICT)}
"""Sentences of the first answer, and reasons of a refusal, by their names."""
