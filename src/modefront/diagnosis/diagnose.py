"""Diagnosis of model and data by a comparison at the nominal parameters."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from modefront.diagnosis.comparison import Comparison, of_few_sets, with_data
from modefront.diagnosis.explain import WrongPlaces, explained, finding_of, pairs_of
from modefront.diagnosis.measured import measured
from modefront.diagnosis.opposed import OpposedSensor, opposed_findings
from modefront.diagnosis.pairs import OutsideModel, PairFinding, pair_findings, without_outside
from modefront.diagnosis.sensors import WrongSensors, between_sets, by_sets
from modefront.diagnosis.sets import (
    SetFactor,
    SetFrequency,
    SetNumbers,
    SetShape,
    factor_findings,
    frequency_findings,
    numbering_findings,
    shape_findings,
)
from modefront.diagnosis.units import (
    DampingInPercent,
    FrequencyFactor,
    OtherQuantity,
    damping_findings,
    distance,
    shifts_to_try,
    unit_finding,
)

Finding = (
    FrequencyFactor
    | OtherQuantity
    | WrongSensors
    | WrongPlaces
    | OpposedSensor
    | SetFactor
    | SetFrequency
    | SetNumbers
    | SetShape
    | DampingInPercent
    | PairFinding
)
"""Findings, each a record with its numbers; `modefront.diagnosis.words` has the words."""


def diagnose(comparison: Comparison) -> list[Finding]:
    """Return the mistakes of a model or its data, causes before their consequences.

    What one finding explains is put right before the next ones are looked for, so that each is
    said once. Of many data sets, some are looked at; see `of_few_sets`.
    """
    comparison = of_few_sets(comparison)
    data = comparison.data
    of_model = comparison.frequency[comparison.pairs.index]
    factors, data = factor_findings(data, partial(distance, comparison))
    numbers, data = numbering_findings(data, of_model)
    in_sets, view = between_sets(comparison, measured(data))
    inside = without_outside(comparison, view)
    best = explained(comparison, inside, shifts_to_try(comparison, inside))
    sensors = finding_of(comparison, inside, best)
    unit = unit_finding(comparison, best.view, best.phi, best.shift)
    shift = 0.0
    if isinstance(unit, FrequencyFactor):
        shift = float(np.log(unit.factor))
    out: list[Finding] = [*factors, *numbers, *([unit] if unit else [])]
    if isinstance(sensors, WrongSensors):
        out += by_sets(in_sets, sensors, comparison.data.sets)
    else:
        out += [*in_sets, *([sensors] if sensors else [])]
    paired = best.phi[:, pairs_of(comparison, best)]
    out += opposed_findings(comparison.data.sensors, best.view, paired)
    out += [*frequency_findings(data), *shape_findings(data, view), *damping_findings(data)]
    if not isinstance(unit, OtherQuantity):
        # Shapes in which sensors of single data sets are put right.
        shapes = np.where(view.seen, view.psi, np.nan)
        of_pairs = pair_findings(with_data(comparison, replace(data, shape=shapes)), view, shift)
        out += [each for each in of_pairs if sensors is None or isinstance(each, OutsideModel)]
    return out
