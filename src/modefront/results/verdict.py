"""The first answer: which model to use and why, how sure it is, and what the front says.

`modefront.findings.catalogue.VERDICT` has all it can say; docs/verdicts.md says of each what it
means and what to do.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain
from textwrap import wrap
from typing import Any

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront.findings.catalogue import VERDICT
from modefront.findings.knowledge import enumeration
from modefront.front.point import Kind, front_points, preferred
from modefront.predictions.base import predictions_in
from modefront.results.analysis import TRUST
from modefront.results.remarks import fit_of
from modefront.uncertainty.inference import LARGE, WORSE, refused

SMALL = 0.5
"""Change of errors along a front, over those expected, below which the compromise hardly counts."""

GAIN = 0.1
"""Share of its errors that a group loses without bounds, from which these are worth widening."""

NAMED = 3
"""Parameters and groups of a kind that are named."""

LINES, COLUMNS = 11, 78
"""Lines of the first answer, of which each has so many columns: a dozen with the title."""

FORETOLD = 2
"""Predictions that are named."""

TWINS = 0.9
"""Correlation of draws, without its sign, from which two parameters are known only together."""


def with_verdict(data: xr.Dataset) -> xr.Dataset:
    """Return results with the first answer, and without a reference where no model is to be used.

    It has `LINES` lines at most. What has no room is left to the tables below it. Where no model is
    to be used, nothing is said of parameters, the front and predictions; where nothing is expected
    of the errors, only how well the reference fits.
    """
    if "misfit" not in data:
        return data.assign_attrs(verdict="\n".join(_unjudged(data)))
    groups = list(map(str, data["group"].values))
    why = refusals(groups, data["misfit"].values, data["nominal_misfit"].values)
    assumed = data.attrs.get("assumed")
    said = [*_at_bounds(data), *_fixed(data)]
    said += [_say("assumed", assumed=assumed)] if assumed else []
    said += _pairs(data)
    if why:
        said.insert(0, _say("do-not-use", why=enumeration(why, NAMED)))
        data = data.assign_attrs(reference="")
    else:
        if not data.attrs.get("settled", 1):
            said.insert(0, _say("unsettled"))
        further = (_parameters(data), _front(data), _next(data), _predictions(data))
        said = [_use(data), *said, *chain.from_iterable(further)]
    return data.assign_attrs(verdict="\n".join(_with_room(said)))


def _unjudged(data: xr.Dataset) -> Iterator[str]:
    """Yield how well the reference fits, where nothing is expected of the errors."""
    reference = preferred(data.attrs)
    chosen, nominal = data["label"].values == reference, data["kind"].values == Kind.NOMINAL.value
    fit = {"fit": fit_of(data, chosen, whole=True), "nominal": fit_of(data, nominal)}
    yield _say("unjudged", reference=reference, **fit)
    error, before = (data["error"].values[x][0] for x in (chosen, nominal))
    worse = [_say("worse", group=x) for x in data["group"].values[error > WORSE * before]]
    if worse:
        yield _say("bought", why=enumeration(worse, NAMED))
    yield _say("not-judged")


def _say(kind: str, **values: Any) -> str:
    return VERDICT[kind].format(**values)


def _with_room(sentences: Sequence[str]) -> list[str]:
    """Return the first sentences for which there is room, and the first one in any case."""
    ends = np.cumsum([len(wrap(sentence, COLUMNS)) for sentence in sentences])
    return list(sentences[: max(1, int(np.searchsorted(ends, LINES, side="right")))])


def refusals(groups: Sequence[str], misfit: Floats, nominal: Floats) -> list[str]:
    """Return why the most probable model cannot be used; nothing where it can be.

    ``misfit`` and ``nominal`` (n,) are the errors of its groups, and those of the nominal model,
    over those expected.
    """
    far, worse = refused(misfit, nominal)
    return [
        *(_say("far", group=groups[i], misfit=misfit[i]) for i in np.flatnonzero(far).tolist()),
        *(_say("worse", group=groups[i]) for i in np.flatnonzero(worse).tolist()),
    ]


def _use(data: xr.Dataset) -> str:
    """Return that the reference can be used, and how well it fits."""
    misfit, groups = data["misfit"].values, data["group"].values
    worst = np.argsort(-misfit) if misfit.size > NAMED else np.arange(misfit.size)
    size = enumeration([f"{misfit[i]:.2g} ({groups[i]})" for i in worst], NAMED)
    use = _say("use", reference=data.attrs["reference"], errors=size)
    return f"{use} {_say('lacks')}" if (misfit > LARGE).any() else use


def _at_bounds(data: xr.Dataset) -> Iterator[str]:
    best, names = _row(data, Kind.MOST_PROBABLE), data["parameter"].values
    sides, values = best["at_bound"].values, best["theta"].values
    held = np.flatnonzero(sides).tolist()
    if not held:
        return
    which = {1: "upper", -1: "lower"}
    said = [f"{names[j]} is at its {which[int(sides[j])]} bound {values[j]:.4g}" for j in held]
    at = enumeration(said, NAMED)
    if "freed_theta" not in data:
        yield _say("at-bound", at=at, it="it" if len(held) == 1 else "them")
        return
    free, before, after = (data[name].values for name in ("freed_theta", "misfit", "freed_misfit"))
    beyond = [j for j in held if sides[j] * (free[j] - values[j]) > 0]
    i = int(np.argmax(before - after))
    if not beyond or before[i] - after[i] < GAIN * before[i]:
        yield _say("at-harmless-bound", at=at, gain=100 * GAIN)
        return
    yield _say(
        "at-wrong-bound",
        at=at,
        where=enumeration([f"{names[j]} = {free[j]:.3g}" for j in beyond], NAMED),
        group=data["group"].values[i],
        after=after[i],
        before=before[i],
        its="its" if len(beyond) == 1 else "their",
    )


def _fixed(data: xr.Dataset) -> Iterator[str]:
    """Yield which fixed parameter the data contradict."""
    if "fixed_parameter" not in data.attrs:
        return
    before, after = data["misfit"].values, data["unfixed_misfit"].values
    i = int(np.argmax(before - after))
    yield _say(
        "wrong-fixed",
        name=data.attrs["fixed_parameter"],
        value=data.attrs["fixed_value"],
        group=data["group"].values[i],
        after=after[i],
        before=before[i],
    )


def _pairs(data: xr.Dataset) -> Iterator[str]:
    unlike = data["likely_mode"].values != _row(data, Kind.MOST_PROBABLE)["paired_mode"].values
    if unlike.any():
        modes = enumeration([str(r) for r in data["mode"].values[unlike]])
        yield _say("unlike", modes=modes)


def _parameters(data: xr.Dataset) -> Iterator[str]:
    """Yield values and 90 % intervals of the parameters, of which the data determine most first."""
    theta = _row(data, Kind.MOST_PROBABLE)["theta"].values
    low, _, high = data["interval"].values.T
    for trust in TRUST:
        own = np.flatnonzero(data["trust"].values == trust).tolist()
        parts = [
            f"{data['parameter'].values[j]} {_interval(theta[j], low[j], high[j])}" for j in own
        ]
        if own:
            yield _say(trust, parameters=enumeration(parts, NAMED))


def _interval(value: float, low: float, high: float) -> str:
    """Return a value with the ends of its interval, in digits that tell these apart.

    >>> _interval(1.1, 1.09992, 1.10011), _interval(1.16, 0.9, 1.5)
    ('1.1 (1.0999 to 1.1001)', '1.16 (0.9 to 1.5)')
    """
    size, width = max(abs(low), abs(high)), high - low
    digits = max(3, min(int(np.ceil(np.log10(size / width))) + 1, 9)) if width > 0 else 3
    return f"{value:.{digits + 1}g} ({low:.{digits}g} to {high:.{digits}g})"


def _front(data: xr.Dataset) -> Iterator[str]:
    """Yield whether the front is a compromise, or its errors change less than noise."""
    along = front_points(data)
    if along.size < 2 or any(True for _ in _pairs(data)):
        return
    best, misfit = _row(data, Kind.MOST_PROBABLE), data["misfit"].values
    error = data["error"].values[along]
    with np.errstate(divide="ignore", invalid="ignore"):
        expected = np.where(misfit > 0, best["error"].values / misfit, np.inf)
    change = np.ptp(error, axis=0) / expected
    agree = (change < SMALL).any()
    i = int(np.argmin(change) if agree else np.argmax(change))
    kind = "agree" if agree else "compromise"
    yield _say(kind, group=data["group"].values[i], change=change[i])


def _predictions(data: xr.Dataset) -> Iterator[str]:
    """Yield the posterior and the range of the first quantity of the first predictions."""
    for each in list(predictions_in(data))[:FORETOLD]:
        for x in [x for x in each.quantities if x.variable.ranged and x.drawn][:1]:
            least, greatest, _ = x.extent
            if np.isfinite([least, greatest]).all():
                ends = {"least": least, "greatest": greatest}
                ends |= {"low": x.drawn["5 %"], "high": x.drawn["95 %"]}
                names = {"name": each.name, "place": x.place, "quantity": x.variable.key}
                yield _say("prediction", **names, **ends)


def _next(data: xr.Dataset) -> Iterator[str]:
    """Yield what to measure for the least determined parameter, and what the study could fix."""
    low, _, high = data["interval"].values.T
    share, trust = (high - low) / data["prior_width"].values, data["trust"].values
    j = int(np.argmax(share))
    if trust[j] == TRUST[0]:
        return
    name, gain = data["parameter"].values[j], data["candidate_gain"].values[:, j]
    c = int(np.argmax(gain)) if gain.size else -1
    if c >= 0 and gain[c] >= GAIN:
        sensor, frequency = (
            data["candidate_sensor"].values[c],
            data["candidate_frequency"].values[c],
        )
        what = f"at sensor {sensor}" if sensor else f"the mode near {frequency:.3g} Hz"
        yield _say("measure", what=what, name=name, gain=100 * gain[c])
    lines = _closed(data["parameter"].values.tolist(), data["sample_theta"].values, trust.tolist())
    if lines:
        yield _say("leave-open-less", lines=enumeration(lines, NAMED))


def _closed(names: Sequence[str], samples: Floats, trust: Sequence[str]) -> list[str]:
    """Return the parameters that could be tied or fixed, with the line of a study that does it.

    Of those that are known together only, one is enough: draws of two whose sum is known are
    correlated negatively, and of those whose ratio is known positively.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        joint = np.nan_to_num(np.corrcoef(samples, rowvar=False)).reshape(len(names), -1)
    lines, done = [], np.array([x == TRUST[0] for x in trust])
    for j in range(len(names)):
        if done[j]:
            continue
        done[j] = True
        along = np.where(done, 0.0, joint[j])
        twin = int(np.argmax(np.abs(along)))
        if along[twin] < -TWINS:
            lines.append(f'{names[j]}: tie = "{names[twin]}"')
        elif along[twin] > TWINS or trust[j] == TRUST[2]:
            lines.append(f"{names[j]}: fixed = true")
        if abs(along[twin]) > TWINS:
            done |= np.abs(along) > TWINS
    return lines


def _row(data: xr.Dataset, kind: Kind) -> xr.Dataset:
    return data.isel(point=data["kind"].values.tolist().index(kind.value))
