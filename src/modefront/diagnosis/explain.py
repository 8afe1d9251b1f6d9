r"""Which single explanation of poor shapes is best: changed sensors, other places, or none.

Explanations and factors on all frequencies compete by the cost of pairing at the nominal model; a
reversed sensor may make modes look exchanged, and frequencies off by a factor. The best one of each
kind is then proved: data as they are and as explained are both fitted within the bounds
(`modefront.diagnosis.fit`), since a nominal model that is merely poor is no mistake. Of those that
are proved, the one is named that fits best: the symptom of a mistake may look like another one at
the nominal parameters, and does not after a fit.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats, Ints
from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.fit import Fit
from modefront.diagnosis.measured import Measured, assigned, mac_values, pair_costs
from modefront.diagnosis.places import Relocation, moved, relocations
from modefront.diagnosis.sensors import (
    LEAST,
    Change,
    WrongSensors,
    applied,
    searched,
    wrong_sensors,
)
from modefront.diagnosis.units import FROM_ONE
from modefront.models.matrices import MatrixModel

PROVED = 0.5
"""Cost after a fit with an explanation, over that without, below which it is proved."""

CERTAIN = 0.2
"""The same where a quarter of the gain is enough."""

HOPELESS = 0.4
"""Cost of a mode from which on it is not explained."""

PRICE = 0.03
"""Cost of each change of an explanation, for each mode: where two do the same, the simpler one."""


@dataclass(frozen=True)
class WrongPlaces:
    """The model has sensors at other places, or along other directions, than the data.

    Where ``place`` says where a sensor fits, ``given`` says where the model has it.

    Attributes
    ----------
    counted : "degrees of freedom" or "nodes" that are counted from 1; empty for directions
    sensors : names of the sensors that have another direction
    given, better : their direction in the model, and the one that fits
    mode : measured mode that gains most
    before, after : its MAC with the model
    place : where a single sensor fits; empty where the mistake is another one
    shared : sensors that measure the same degree of freedom in the model
    """

    counted: str
    sensors: tuple[str, ...]
    given: str
    better: str
    mode: int
    before: float
    after: float
    place: str = ""
    shared: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Explanation:
    """Data and shapes of the model under an assumption.

    Attributes
    ----------
    changes : sensors of the data that are reversed or exchanged
    relocation : other places of the sensors in the model
    view : the measured modes with the changes
    phi : (sensors, model modes) shapes of the model at the places
    shift : logarithm of the factor on all measured frequencies
    cost : cost of the pairs, with the price of the explanation
    """

    changes: tuple[Change, ...]
    relocation: Relocation | None
    view: Measured
    phi: Floats
    shift: float
    cost: float

    @property
    def is_plain(self) -> bool:
        """Whether nothing is assumed of the sensors."""
        return not self.changes and self.relocation is None


def explained(comparison: Comparison, view: Measured, shifts: list[float]) -> Explanation:
    """Return the best explanation that a fit proves; the plain one where there is none.

    ``shifts`` are the logarithms of factors on all frequencies that are tried.
    """
    explanations = [each for shift in shifts for each in _explanations(comparison, view, shift)]
    plain = min((each for each in explanations if each.is_plain), key=lambda each: each.cost)
    kinds: dict[str, Explanation] = {}
    for each in sorted(explanations, key=lambda each: each.cost):
        if not each.is_plain and each.cost < plain.cost:
            kinds.setdefault(_kind(each), each)
    proved = [_proved(comparison, view, each, plain.cost) for each in kinds.values()]
    known = [each for each in proved if each is not None]
    return min(known, key=lambda each: each[1])[0] if known else plain


def _kind(explanation: Explanation) -> str:
    """Return of what kind an explanation is; the best of each kind is tried."""
    if explanation.relocation is None:
        return "changes"
    if explanation.relocation.place:
        return "place"
    return explanation.relocation.counted or "direction"


def _explanations(comparison: Comparison, view: Measured, shift: float) -> Iterator[Explanation]:
    phi = comparison.phi
    changes = tuple(searched(comparison, view, shift))
    everywhere = range(view.psi.shape[0])
    plain = _explanation(comparison, (), None, view, phi, shift)
    yield plain
    if changes:
        changed = applied(changes, view, everywhere)
        yield _explanation(comparison, changes, None, changed, phi, shift)
    if not view.has_shape.any():
        return
    at_others = moved(comparison, view, pairs_of(comparison, plain))
    for relocation in (*relocations(comparison), *at_others):
        relocated = relocation.selection @ comparison.Phi
        yield _explanation(comparison, (), relocation, view, relocated, shift)


def _explanation(
    comparison: Comparison,
    changes: tuple[Change, ...],
    relocation: Relocation | None,
    view: Measured,
    phi: Floats,
    shift: float,
) -> Explanation:
    mac = mac_values(view.psi, view.seen, phi)
    cost = pair_costs(mac, view.log_frequency, comparison.log_frequency, shift)
    total = assigned(cost)[1] + _price(changes, relocation, shift) * cost.shape[0]
    return Explanation(changes, relocation, view, phi, shift, total)


def _price(changes: Sequence[Change], relocation: Relocation | None, shift: float) -> float:
    """Return the cost of an explanation for each mode; a place is one of many, and costs twice."""
    relocated = 0 if relocation is None else 1 + bool(relocation.place)
    return PRICE * (len(changes) + relocated) + FROM_ONE * abs(shift)


def _proved(
    comparison: Comparison, view: Measured, best: Explanation, plain: float
) -> tuple[Explanation, float] | None:
    """Return the part of an explanation with which a fit is clearly better, and what it costs.

    A reduced basis knows the sensors of its model alone: the costs of pairing at the nominal model,
    ``plain`` without the explanation, have to do there.
    """
    count = int(view.has_shape.sum())
    is_fitted = isinstance(comparison.problem.model, MatrixModel)

    def costing(proved: Explanation, fit: Fit | None) -> tuple[Explanation, float]:
        if fit is None or not is_fitted:
            return proved, proved.cost
        price = _price(proved.changes, proved.relocation, proved.shift)
        return proved, fit.cost + price * proved.view.log_frequency.size

    last = comparison.updating(best.shift).fit(view)
    if best.relocation is not None:
        model = comparison.problem.model
        if not isinstance(model, MatrixModel):
            share = CERTAIN if best.relocation.place else PROVED
            is_clear = best.cost < share * plain and plain - best.cost > LEAST * count
            return costing(best, None) if is_clear else None
        relocated = replace(model, selection=best.relocation.selection)
        fit = comparison.updating(best.shift, relocated).fit(view)
        is_better = _is_better(fit, last, count, certain=bool(best.relocation.place))
        return costing(best, fit) if is_better else None
    everywhere, updating = range(view.psi.shape[0]), comparison.updating(best.shift)
    kept, fit = list(best.changes), updating.fit(best.view)
    while kept and not _is_better(fit, last, count):
        kept.pop()
        fit = updating.fit(applied(kept, view, everywhere))
    for change in list(kept) if len(kept) > 1 else ():
        rest = [each for each in kept if each is not change]
        without = updating.fit(applied(rest, view, everywhere))
        if not _is_better(fit, without, count):
            kept, fit = rest, without
    if not kept:
        return None
    changed = applied(kept, view, everywhere)
    found = _explanation(comparison, tuple(kept), None, changed, best.phi, best.shift)
    return costing(found, fit)


def _is_better(new: Fit | None, old: Fit | None, count: int, *, certain: bool = False) -> bool:
    """Return whether a fit of ``count`` shapes is clearly better than another one.

    Modes that neither explains say nothing. The less is left, the less it takes to be clear. Where
    the new one is the best of many, little has to be left: it has to be ``certain``.
    """
    if new is None or old is None:
        return new is not None
    explained = np.minimum(new.costs, old.costs) < HOPELESS
    left = float(new.costs[explained].sum()) + new.distance
    before = float(old.costs[explained].sum()) + old.distance
    gained = before - left
    if left < CERTAIN * before and gained > LEAST / 4 * count:
        return True
    return not certain and left < PROVED * before and gained > LEAST * count


def pairs_of(comparison: Comparison, explanation: Explanation) -> Ints:
    """Return the model mode of each measured mode under an explanation, (modes,)."""
    mac = mac_values(explanation.view.psi, explanation.view.seen, explanation.phi)
    logs = explanation.view.log_frequency
    return assigned(pair_costs(mac, logs, comparison.log_frequency, explanation.shift))[0]


def finding_of(
    comparison: Comparison, view: Measured, explanation: Explanation
) -> WrongSensors | WrongPlaces | None:
    """Return the mistake that an explanation assumes; None for the plain one."""
    if explanation.is_plain:
        return None
    mac = mac_values(explanation.view.psi, explanation.view.seen, explanation.phi)
    index = pairs_of(comparison, explanation)
    rows = np.arange(index.size)
    before, after = mac_values(view.psi, view.seen, comparison.phi)[rows, index], mac[rows, index]
    if explanation.relocation is None:
        return wrong_sensors(explanation.changes, comparison, before, after, (), "model")
    r = int(np.nanargmax(after - before))
    names = comparison.data.sensors
    return WrongPlaces(
        explanation.relocation.counted,
        tuple(names[s] for s in explanation.relocation.sensors),
        explanation.relocation.given,
        explanation.relocation.better,
        comparison.data.modes[r],
        float(before[r]),
        float(after[r]),
        explanation.relocation.place,
        _shared(comparison, explanation.relocation) if explanation.relocation.place else (),
    )


def _shared(comparison: Comparison, relocation: Relocation) -> tuple[str, ...]:
    """Return the sensors that the model has where it has the one that is moved."""
    matrices, s = comparison.matrices, relocation.sensors[0]
    if matrices is None:
        return ()
    rows = matrices.selection
    others = [t for t in range(rows.shape[0]) if t != s and not abs(rows[[t]] - rows[[s]]).sum()]
    return tuple(comparison.data.sensors[t] for t in others)
