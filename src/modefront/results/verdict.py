"""The first answer: which model to use and why, how sure it is, and what the front says."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront.findings.knowledge import enumeration
from modefront.front.point import Kind
from modefront.results.intervals import TRUST
from modefront.results.selection import front_points

FAR = 10.0
"""Errors over those expected, from which no model is advised: far above what is called noise."""

LARGE = 2.0
"""Errors over those expected, from which they are said to be larger."""

WORSE = 1.1
"""Error of a group over that of the nominal model, from which the nominal one is better there."""

SMALL = 0.5
"""Change of errors along a front, over those expected, below which the compromise hardly counts."""

GAIN = 0.1
"""Share of its errors that a group loses without bounds, from which these are worth widening."""

NAMED = 3
"""Parameters of a kind that are named."""


def verdict(data: xr.Dataset) -> list[str]:
    """Return the sentences, at most eight; none of results without expectations of the errors.

    Where no model can be used, nothing is said of parameters and of the front.
    """
    if "misfit" not in data:
        return []
    refused = _refused(data)
    context = [*_at_bounds(data), *_assumed(data)]
    if refused:
        return [f"Do not use any of these models: {enumeration(refused)}.", *context]
    return [_use(data), *context, *_parameters(data), *_front(data)]


def _refused(data: xr.Dataset) -> list[str]:
    """Return why no model can be used; nothing where the reference can be."""
    best, nominal = (
        _row(data, kind)["error"].values for kind in (Kind.MOST_PROBABLE, Kind.NOMINAL)
    )
    groups = list(map(str, data["group"].values))
    return refusals(groups, data["misfit"].values, best / nominal)


def refusals(groups: Sequence[str], misfit: Floats, to_nominal: Floats) -> list[str]:
    """Return why the most probable model cannot be used; nothing where it can be.

    ``misfit`` and ``to_nominal`` (n,) are the errors of its groups over those expected and over
    those of the nominal model.
    """
    far, worse = misfit > FAR, (to_nominal > WORSE) & (misfit > LARGE)
    return [
        *(
            f"errors of {groups[i]} are {misfit[i]:.2g} times those expected"
            for i in np.flatnonzero(far)
        ),
        *(
            f"{groups[i]} fits worse than at the nominal model"
            for i in np.flatnonzero(worse & ~far)
        ),
    ]


def _use(data: xr.Dataset) -> str:
    """Return that the reference can be used, and how well it fits."""
    misfit = data["misfit"].values
    parts = zip(misfit, data["group"].values, strict=True)
    size = ", ".join(f"{x:.2g} ({name})" for x, name in parts)
    larger = " They are larger than noise: the model lacks something."
    return (
        f"Use {data.attrs['reference']}: its errors over those expected are {size}."
        + larger * bool((misfit > LARGE).any())
    )


def _at_bounds(data: xr.Dataset) -> Iterator[str]:
    """Yield which bounds hold parameters of the reference, and what it gains without them."""
    best = _row(data, Kind.MOST_PROBABLE)
    sides, values = best["at_bound"].values, best["theta"].values
    names = data["parameter"].values
    at = [
        f"{name} is at its {'upper' if side > 0 else 'lower'} bound {value:.4g}"
        for name, side, value in zip(names, sides, values, strict=True)
    ]
    held = np.flatnonzero(sides)
    if not held.size:
        return
    more = f" and {held.size - NAMED} more" * (held.size > NAMED)
    said = f"{enumeration([at[j] for j in held[:NAMED]])}{more}"
    if "freed_theta" not in data:
        yield f"{said}: widen {'it' if held.size == 1 else 'them'}, or ask what the model lacks."
        return
    free, before, after = (data[name].values for name in ("freed_theta", "misfit", "freed_misfit"))
    beyond = [j for j in held if sides[j] * (free[j] - values[j]) > 0]
    i = int(np.argmax(before - after))
    if not beyond or before[i] - after[i] < GAIN * before[i]:
        yield f"{said}: wider bounds lower no errors by more than {100 * GAIN:.0f} %."
        return
    where = enumeration([f"{names[j]} = {free[j]:.3g}" for j in beyond[:NAMED]])
    further = f" and {len(beyond) - NAMED} more" * (len(beyond) > NAMED)
    yield (
        f"{said}. With {where}{further}, errors of {data['group'].values[i]} are {after[i]:.2g} of "
        f"those expected instead of {before[i]:.2g}: widen "
        f"{'its bounds' if len(beyond) == 1 else 'their bounds'}, or ask what the model lacks."
    )


def _assumed(data: xr.Dataset) -> Iterator[str]:
    """Yield which errors are assumed."""
    if data.attrs.get("assumed"):
        yield f"Assumed: {data.attrs['assumed']}; say yours in [noise]."


def _parameters(data: xr.Dataset) -> Iterator[str]:
    """Yield values and 90 % intervals of the parameters, of which the data determine most first."""
    theta = _row(data, Kind.MOST_PROBABLE)["theta"].values
    low, _, high = data["interval"].values.T
    for trust in TRUST:
        own = np.flatnonzero(data["trust"].values == trust).tolist()
        parts = [
            f"{data['parameter'].values[j]} {theta[j]:.4g} ({low[j]:.3g} to {high[j]:.3g})"
            for j in own[:NAMED]
        ]
        if own:
            yield f"{trust.capitalize()} (90 %): {_some(parts, len(own))}."


def _some(parts: Sequence[str], count: int) -> str:
    return ", ".join(parts) + f" and {count - len(parts)} more" * (count > len(parts))


def _front(data: xr.Dataset) -> Iterator[str]:
    """Yield whether the front is a compromise, or its errors change less than noise."""
    along = front_points(data)
    if along.size < 2:
        return
    best, misfit = _row(data, Kind.MOST_PROBABLE), data["misfit"].values
    error = data["error"].values[along]
    with np.errstate(divide="ignore", invalid="ignore"):
        expected = np.where(misfit > 0, best["error"].values / misfit, np.inf)
    change = np.ptp(error, axis=0) / expected
    if (change < SMALL).any():
        i = int(np.argmin(change))
        name = data["group"].values[i]
        yield (
            f"Along the front errors of {name} change by {change[i]:.2g} of those expected: the "
            "compromise hardly matters."
        )
    else:
        i = int(np.argmax(change))
        name = data["group"].values[i]
        yield (
            f"The front is a compromise: along it errors of {name} change by {change[i]:.2g} times "
            "those expected."
        )


def _row(data: xr.Dataset, kind: Kind) -> xr.Dataset:
    """Return the first model of a kind."""
    return data.isel(point=data["kind"].values.tolist().index(kind.value))
