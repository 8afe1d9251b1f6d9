"""Records of impacts as files hold them: one blow at a time, made into channels.

A blow is the record of the force and those of the responses over the same time. Blows at the same
reference, with the same responses, are averaged (`modefront.data.impact`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.data.channels import EXPECTED, Channel
from modefront.data.impact import ImpactResponses, Windows, impact_responses
from modefront.data.responses import ForceNoise
from modefront.errors import Fault, InputError, refuse
from modefront.rounding import LARGEST

TIME, FORCE = "time", "force"
"""Columns of a CSV file with the records of a blow."""

EVEN = 1e-3
"""Relative difference within which steps of time are even: files hold few digits."""


@dataclass(frozen=True)
class Blow:
    """The records of one impact.

    Attributes
    ----------
    file, place : where they were read
    reference : where the hammer hits; empty where the file does not say
    time : (samples,) in s
    force : (samples,)
    responses : records by name, (samples,) each
    quantity : of the functions that responses over force make; empty where the file does not say
    """

    file: str
    place: str
    reference: str
    time: Floats
    force: Floats
    responses: Mapping[str, Floats]
    quantity: str = ""


@dataclass(frozen=True)
class Contents:
    """Contents of a file: functions, or the records of blows where there are no functions.

    Attributes
    ----------
    channels, blows : functions, and records
    unused : what of the map of columns of a set names none of the file
    """

    channels: tuple[Channel, ...] = ()
    blows: tuple[Blow, ...] = ()
    unused: frozenset[str] = frozenset()


def blow_of_columns(file: str, header: Sequence[str], values: Floats, reference: str) -> Blow:
    """Return the blow in the columns of a CSV file: time, force, and one for every response."""
    faults = [
        Fault(file, f"line 1, column {name!r}", "each column once", "another")
        for name in dict.fromkeys(header)
        if list(header).count(name) > 1
    ]
    if FORCE not in header:
        found = "no such column"
        faults.append(Fault(file, f"line 1, column {FORCE!r}", "the record of the force", found))
    names = [name for name in header if name not in (TIME, FORCE)]
    if not names:
        expected = "columns of at least one response"
        faults.append(Fault(file, "line 1", expected, ", ".join(header)))
    refuse(faults)
    column = dict(zip(header, values.T, strict=True))
    responses = {name: np.nan_to_num(column[name], nan=0.0) for name in names}  # empty columns
    return Blow(file, "columns", reference, column[TIME], column[FORCE], responses)


@dataclass(frozen=True)
class Averaged:
    """Functions of all blows of a data set.

    Attributes
    ----------
    channels : the functions
    warnings : which blows are left out and why, and what has not died out
    decay : that of the exponential window in 1/s
    force_noise : that of each reference; None where a reference was hit for several measurements
    """

    channels: tuple[Channel, ...]
    warnings: tuple[str, ...]
    decay: float
    force_noise: Mapping[str, ForceNoise | None]


def averaged_blows(blows: Sequence[Blow], windows: Windows, quantity: str) -> Averaged:
    """Return the functions of all references.

    ``quantity`` is that of the test file, or empty. Raises InputError where records do not fit, or
    no blow of a reference is left.
    """
    _check_time(blows)
    groups: dict[tuple[str, tuple[str, ...]], list[Blow]] = {}
    for blow in blows:
        groups.setdefault((blow.reference, tuple(blow.responses)), []).append(blow)
    channels: list[Channel] = []
    warnings = []
    noise: dict[str, ForceNoise | None] = {}
    for (reference, _), group in groups.items():
        result = _averaged(group, windows)
        channels += _channels(group[0], result, quantity)
        noise[reference] = None if reference in noise else result.data.force_noise
        for blow, why in zip(group, result.left_out, strict=True):
            if why:
                warnings.append(f"{blow.file}: {blow.place}: the blow is left out: {why}")
        if (worst := result.remaining.max()) > 0.05:  # more leaks
            warnings.append(
                f"{group[0].file}: responses still have {worst:.0%} of their size at the end of "
                "the record: expect errors of leakage; [impact] exponential takes a shorter time "
                "constant"
            )
    return Averaged(tuple(channels), tuple(warnings), result.data.decay, noise)


def _check_time(blows: Sequence[Blow]) -> None:
    first, faults = blows[0].time, list[Fault]()
    for blow in blows:
        steps = np.diff(blow.time)
        if len(steps) < 2 or steps.min() <= 0 or np.ptp(steps) > EVEN * steps.mean():
            faults.append(Fault(blow.file, blow.place, "a time axis of even steps", "another"))
        elif len(blow.time) != len(first) or abs(np.ptp(blow.time) / np.ptp(first) - 1) > EVEN:
            expected = f"records of {_extent(first)}, as in {blows[0].file}"
            faults.append(Fault(blow.file, blow.place, expected, _extent(blow.time)))
        elif not all((np.abs(x) <= LARGEST).all() for x in (blow.force, *blow.responses.values())):
            faults.append(Fault(blow.file, blow.place, EXPECTED, "others"))
    refuse(faults[:5])


def _extent(time: Floats) -> str:
    return f"{len(time)} samples over {np.ptp(time):.6g} s"


def _averaged(blows: Sequence[Blow], windows: Windows) -> ImpactResponses:
    first = blows[0]
    names = tuple(x for x in first.responses if any(np.ptp(blow.responses[x]) for blow in blows))
    if not names:
        place = f"blows at {first.reference!r}"
        raise InputError(Fault(first.file, place, "a response that moves", "none"))
    try:
        return impact_responses(
            np.array([blow.force for blow in blows]),
            np.array([[blow.responses[name] for name in names] for blow in blows]),
            (len(first.time) - 1) / float(np.ptp(first.time)),
            windows=windows,
            responses=names,
        )
    except ValueError as error:
        expected, _, found = str(error).partition(", found none: ")
        place = f"blows at {first.reference!r}"
        expected = expected.removeprefix("expected ")
        raise InputError(Fault(first.file, place, expected, found)) from None


def _channels(first: Blow, averaged: ImpactResponses, quantity: str) -> list[Channel]:
    """Return the functions; those of responses that never move are zeros."""
    data = averaged.data
    out = []
    for name in dict.fromkeys([*data.responses, *first.responses]):
        H = np.zeros(len(data.frequency), complex)
        coherence = variance = None
        if name in data.responses:
            i = data.responses.index(name)
            H = data.H[0, i]
            if data.variance is not None:
                coherence, variance = averaged.coherence[i], data.variance[0, i]
        where = first.file, f"response {name!r}", first.reference, name
        kind = first.quantity or quantity
        out.append(Channel(*where, data.frequency, H, kind, coherence, variance))
    return out
