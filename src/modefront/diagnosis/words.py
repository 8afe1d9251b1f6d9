"""Sentences on the findings of a diagnosis: the finding with its numbers, and the remedy."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from modefront.diagnosis.diagnose import Finding
from modefront.diagnosis.explain import WrongPlaces
from modefront.diagnosis.opposed import OpposedSensor
from modefront.diagnosis.pairs import BeyondCandidates, DistantPair, OutsideModel, UnseenMode
from modefront.diagnosis.places import DataDirection, UnusedGroup
from modefront.diagnosis.sensors import WrongSensors
from modefront.diagnosis.sets import SetFactor, SetFrequency, SetNumbers, SetShape
from modefront.diagnosis.units import DampingInPercent, FrequencyFactor, OtherQuantity

CAUSES: Mapping[str, tuple[str, str]] = {
    "rad/s": (
        "they look like rad/s, 2π times Hz",
        "divide the column 'frequency' by 6.2832 (2π)",
    ),
    "model in rad/s": (
        "the model looks as if its matrices gave Hz for rad/s, or the data are divided by 2π twice",
        "see that eigenvalues of K and M are (rad/s)², and multiply the data by 6.2832 (2π) "
        "where they are not in Hz",
    ),
    "rpm": ("they look like revolutions or cycles per minute", "divide 'frequency' by 60"),
    "weight": (
        "the model looks as if weight were given for mass, a factor of g = 9.81 on M",
        "divide masses and densities by 9.81",
    ),
    "weight in stiffness": (
        "the model looks as if stiffness were g = 9.81 times too great, or mass 9.81 too small",
        "give forces in N and masses in kg, or another consistent set of units",
    ),
}
"""Description and remedy of each cause of a factor."""

UNITS: Mapping[int, str] = {
    1: "masses in kg with stiffness in kN, or in t with N",
    2: "E in MPa, or lengths in mm, where all else is in SI units",
    3: "E in GPa where all else is in SI units",
    4: "lengths in mm with thicknesses and sections in m, where all else is in SI units",
    -1: "masses in t with stiffness in N, or in kg with kN",
    -2: "lengths in m where all else is in N, mm and t, or E in Pa where it should be MPa",
    -3: "E in Pa where it should be GPa",
    -4: "densities in t/mm³ where all else is in SI units, or sections in mm with lengths in m",
}
"""Slips that make measured frequencies the power of the root of 1000 times the model's."""


Mistake = Finding | UnusedGroup | DataDirection
"""Findings of a comparison, or of the reading of a study."""


def in_words(finding: Mistake) -> str:
    """Return a finding and its remedy as one text."""
    return "; ".join(_WORDS[type(finding)](finding))


def _factor(finding: FrequencyFactor) -> tuple[str, str]:
    who = (
        "the measured frequency is" if finding.modes == 1 else "all measured frequencies are about"
    )
    spread = f" ({finding.least:.3g} to {finding.greatest:.3g})" if finding.modes > 1 else ""
    what = f"{who} {finding.factor:.3g} times the model's{spread}"
    if finding.cause:
        looks, remedy = CAUSES[finding.cause]
        return f"{what}: {looks}", remedy
    if abs(np.log10(finding.factor)) < 1:
        times = finding.factor**2
        return (
            f"{what}: stiffness over mass is off by {times:.3g}",
            "check units, sections and masses, or the nominal values of the parameters",
        )
    return (
        f"{what}, a factor of units, such as {UNITS[_nearest_slip(finding.factor)]}",
        "give lengths, forces and masses in consistent units: m, N, kg or mm, N, t",
    )


def _nearest_slip(factor: float) -> int:
    """Return which slip a factor is nearest to: of 31.6, 1e3, 3.2e4 and 1e6, and their inverses."""
    sizes = {1: 1.5, 2: 3.0, 3: 4.5, 4: 6.0}
    size = abs(float(np.log10(factor)))
    nearest = min(sizes, key=lambda k: abs(sizes[k] - size))
    return nearest if factor > 1 else -nearest


def _quantity(finding: OtherQuantity) -> tuple[str, str]:
    return (
        f"the column 'frequency' looks like {finding.quantity}: mode {finding.mode} has "
        f"{finding.given:.4g}, which is {finding.model:.4g} Hz",
        "give frequencies in Hz",
    )


def _sensors(finding: WrongSensors) -> tuple[str, str]:
    deeds = [
        f"reversing {change[0]}" if len(change) == 1 else f"exchanging {change[0]} and {change[1]}"
        for change in finding.changes
    ]
    if finding.other:
        deeds[0] += f" (or {', '.join(finding.other)}: the data cannot tell)"
    where = f"in set {' and '.join(finding.sets)}" if finding.sets else "in all data"
    kind = "cross-MAC" if finding.against == "sets" else "MAC"
    what = (
        f"{' and '.join(deeds)} {where} raises {kind} {finding.mode} "
        f"from {finding.before:.2f} to {finding.after:.2f}"
    )
    reversed_ = [change[0] for change in finding.changes if len(change) == 1]
    exchanged = [" and ".join(change) for change in finding.changes if len(change) == 2]
    remedies = []
    if reversed_:
        remedies.append(
            f"check the direction of {', '.join(reversed_)}, and change the sign of "
            f"{'its column' if len(reversed_) == 1 else 'their columns'}, or of the direction "
            "in the model"
        )
    if exchanged:
        remedies.append(
            f"check the cables of {', '.join(exchanged)}, and exchange their columns or sensors"
        )
    return what, "; ".join(remedies)


def _opposed(finding: OpposedSensor) -> tuple[str, str]:
    names = " and ".join(finding.sensors)
    numbers = f"{finding.agreement:.2f}, at the median sensor {finding.usual:.2f}"
    if len(finding.sensors) == 2:
        return (
            f"sensors {names} are exchanged, as their difference moves against the model in "
            f"{finding.modes} modes: its signed COMAC is {numbers}; they move too much alike "
            "to show in the MAC",
            f"check the cables of {names}, and exchange their columns or sensors",
        )
    return (
        f"sensor {names} moves against the model in {finding.modes} modes: their signed COMAC is "
        f"{numbers}; it moves too little to show in the MAC",
        f"check the direction of {names}, and change the sign of its column, or of the direction "
        "in the model",
    )


def _places(finding: WrongPlaces) -> tuple[str, str]:
    gain = f"raises MAC {finding.mode} from {finding.before:.2f} to {finding.after:.2f}"
    if finding.counted:
        return (
            f"the sensors look as if {finding.counted} were counted from 1: one less {gain}",
            f"count {finding.counted} from 0: subtract 1 from each in [model.sensors]",
        )
    names = enumerated(finding.sensors)
    many = len(finding.sensors) > 1
    if finding.place:
        too = f", where the model has {enumerated(finding.shared)} too" if finding.shared else ""
        return (
            f"sensor {names} fits the data at {finding.place} and not at {finding.given}{too}: "
            f"this {gain}",
            f"check where {names} was in the test, and write its place in [model.sensors]",
        )
    return (
        f"direction {finding.given} of {names} does not match the data: {finding.better} {gain}",
        f"check along which axis {names} measure{'' if many else 's'}, and write direction = "
        f'"{finding.better}"' + (" in turn" if " and " in finding.better else ""),
    )


def _set_factor(finding: SetFactor) -> tuple[str, str]:
    looks = {"rad/s": ": rad/s for Hz", "model in rad/s": ": Hz for rad/s"}.get(finding.cause, "")
    if finding.cause == "rpm":
        looks = ": per minute for Hz"
    percent = 100 * (finding.factor - 1)
    size = f"{finding.factor:.3g} times" if abs(percent) > 40 else f"{percent:+.1f} % off"
    remedy = (
        "give all data sets in Hz"
        if abs(percent) > 40
        else "the structure differed (mass, temperature, supports): update with one of the sets, "
        "or say by frequency_std how far frequencies scatter"
    )
    return (
        f"all frequencies of set {finding.set} are {size} those of {finding.other}{looks}",
        remedy,
    )


def _set_frequency(finding: SetFrequency) -> tuple[str, str]:
    percent = 100 * (finding.frequency / finding.other_frequency - 1)
    return (
        f"{_disagree(finding.set, finding.others)} in the frequency of mode {finding.mode}: "
        f"{finding.frequency:.5g} and {finding.other_frequency:.5g} Hz, {percent:+.1f} %, where "
        f"{100 * finding.scatter:.2g} % is their scatter",
        _look_again(finding.set, finding.others, "value"),
    )


def _disagree(odd: str, others: Sequence[str]) -> str:
    """Return which sets disagree; where there are several others, it is the odd one."""
    if len(others) == 1:
        return f"sets {odd} and {others[0]} disagree"
    return f"set {odd} disagrees with {enumerated(others, 3)}"


def _look_again(odd: str, others: Sequence[str], noun: str) -> str:
    if len(others) == 1:
        return f"look at both again, or leave out the worse {noun}"
    return f"look at set {odd} again, or leave out its {noun}"


def _set_numbers(finding: SetNumbers) -> tuple[str, str]:
    modes, others = (
        enumerated([str(r) for r in finding.modes]),
        enumerated([str(r) for r in finding.of]),
    )
    return (
        f"modes {modes} of set {finding.set} are modes {others} of {finding.other}, by frequencies "
        "and shapes",
        f"number the modes of set {finding.set} like those of {finding.other}",
    )


def _set_shape(finding: SetShape) -> tuple[str, str]:
    others = enumerated(finding.others, 3)
    what = (
        f"{_disagree(finding.set, finding.others)} in the shape of mode {finding.mode}: "
        f"cross-MAC {finding.mac:.2f}"
    )
    if finding.resembles:
        return (
            f"{what}, but {finding.other_mac:.2f} with mode {finding.resembles} of {others}",
            f"number the modes of set {finding.set} like those of {others}",
        )
    return what, _look_again(finding.set, finding.others, "shape")


def _damping(finding: DampingInPercent) -> tuple[str, str]:
    return (
        f"damping of {finding.least:.3g} to {finding.greatest:.3g} looks like percent",
        "give the ratio to critical damping: divide the column 'damping' by 100",
    )


def _distant(finding: DistantPair) -> tuple[str, str]:
    resembling = "" if np.isnan(finding.mac) else f" (MAC {finding.mac:.2f})"
    return (
        f"measured mode {finding.mode} at {finding.frequency:.4g} Hz is paired with model mode "
        f"{finding.model_mode} at {finding.model_frequency:.4g} Hz{resembling}",
        f"set window = 1.5 in [pairing]; the nearest is model mode {finding.nearest} at "
        f"{finding.nearest_frequency:.4g} Hz",
    )


def _outside(finding: OutsideModel) -> tuple[str, str]:
    which = (
        f"its {finding.modes} modes end"
        if finding.all_modes
        else f"its {finding.modes} lowest modes, which were looked at, end"
    )
    return (
        f"measured mode {finding.mode} at {finding.frequency:.4g} Hz is outside what the model "
        f"has: {which} at {finding.highest:.4g} Hz",
        "refine the model, or leave the mode out of all groups",
    )


def _beyond(finding: BeyondCandidates) -> tuple[str, str]:
    return (
        f"measured mode {finding.mode} resembles model mode {finding.model_mode} at "
        f"{finding.model_frequency:.4g} Hz (MAC {finding.mac:.2f}), which is not looked at; the "
        f"best of those that are has MAC {finding.best:.2f}",
        f"set spare = {finding.spare} in [pairing]",
    )


def _unseen(finding: UnseenMode) -> tuple[str, str]:
    return (
        f"measured mode {finding.mode} resembles no mode of the nominal model "
        f"(best MAC {finding.best:.2f})",
        "check its shape and the places of the sensors, or leave it out of the groups",
    )


def _group(finding: UnusedGroup) -> tuple[str, str]:
    return (
        f"mesh group '{finding.name}' of {finding.cells} {finding.type} cells has no elements and "
        "holds nothing",
        f'give it a [[model.group]] name = "{finding.name}", or leave it out of the mesh',
    )


def _data_direction(finding: DataDirection) -> tuple[str, str]:
    return (
        f"sensor {finding.sensor} is along {finding.model} in the model, but takes "
        f"{finding.data} of the data",
        "write the same direction in [model.sensors] and [data.sensors]",
    )


def enumerated(names: Sequence[str], most: int = 6) -> str:
    """Return names as a text, the first of many.

    >>> enumerated(["a", "b", "c"], 2)
    'a, b and 1 more'
    """
    shown = list(names[:most])
    if len(names) > most:
        return f"{', '.join(shown)} and {len(names) - most} more"
    return " and ".join([*([", ".join(shown[:-1])] if shown[1:] else []), *shown[-1:]])


_WORDS: Mapping[type, Callable[[Any], tuple[str, str]]] = {
    BeyondCandidates: _beyond,
    DampingInPercent: _damping,
    DataDirection: _data_direction,
    DistantPair: _distant,
    FrequencyFactor: _factor,
    OpposedSensor: _opposed,
    OtherQuantity: _quantity,
    OutsideModel: _outside,
    SetFactor: _set_factor,
    SetFrequency: _set_frequency,
    SetNumbers: _set_numbers,
    SetShape: _set_shape,
    UnseenMode: _unseen,
    UnusedGroup: _group,
    WrongPlaces: _places,
    WrongSensors: _sensors,
}
"""Functions that put each finding and its remedy into words."""
