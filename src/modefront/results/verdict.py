"""The first answer: which model to use and why, how sure it is, and what the front says.

The page ``findings/verdicts.md`` has all it can say, and of each what it means and what to do.
"""

from collections.abc import Iterator, Sequence
from itertools import chain
from textwrap import wrap
from typing import Any

import numpy as np

from modefront.datasets import Dataset
from modefront.findings.knowledge import SHOWN, bound, enumeration, held
from modefront.findings.record import VERDICT
from modefront.front.point import Kind, front_points, preferred
from modefront.predictions.base import predictions_in
from modefront.results.assemble import TRUST
from modefront.results.remarks import fit_of
from modefront.uncertainty.inference import CHANCE, GAIN, LARGE, WORSE, Freed, refused

SMALL = 0.5
"""Change of errors along a front, over those expected, below which the compromise hardly counts."""

LINES, COLUMNS = 11, 78
"""Lines of the first answer, of which each has so many columns: a dozen with the title."""

TWINS = 0.9
"""Correlation of draws, without its sign, from which two parameters are known only together."""


def with_verdict(data: Dataset, spare: Sequence[str] = ()) -> Dataset:
    """Return results with the first answer, and without a reference where no model is to be used.

    ``spare`` are the parameters to fix for the data to determine the others, as `check` names them.

    It has `LINES` lines at most. What has no room is left to the tables below it. Where no model is
    to be used, nothing is said of parameters, the front and predictions; where nothing is expected
    of the errors, only how well the reference fits.
    """
    if "misfit" not in data:
        return data.assign_attrs({"verdict": "\n".join(_unjudged(data))})
    groups, misfit = data["group"].values, data["misfit"].values
    far, worse = refused(misfit, data["nominal_misfit"].values)
    of_far = zip(groups[far], misfit[far], strict=True)
    why = [_say("far", group=group, misfit=value) for group, value in of_far]
    why += [_say("worse", group=group) for group in groups[worse]]
    said = [*_at_bounds(data), *_wrong(data)]
    if assumed := data.attrs.get("assumed"):
        said.append(_say("assumed", assumed=assumed))
    said += _pairs(data)
    if why:
        said.insert(0, _say("do-not-use", why=enumeration(why, SHOWN)))
        data = data.assign_attrs({"reference": ""})
    else:
        if not data.attrs.get("settled", 1):
            said.insert(0, _say("unsettled"))
        further = (_parameters(data), _front(data), _next(data, spare), _predictions(data))
        said = [_use(data), *said, *chain.from_iterable(further)]
    ends = np.cumsum([len(wrap(sentence, COLUMNS)) for sentence in said])
    said = said[: max(1, int(np.searchsorted(ends, LINES, side="right")))]
    return data.assign_attrs({"verdict": "\n".join(said)})


def _unjudged(data: Dataset) -> Iterator[str]:
    """Yield how well the reference fits, where nothing is expected of the errors."""
    reference = preferred(data.attrs)
    chosen, nominal = data["label"].values == reference, data["kind"].values == Kind.NOMINAL.value
    fit = {"fit": fit_of(data, chosen, whole=True), "nominal": fit_of(data, nominal)}
    yield _say("unjudged", reference=reference, **fit)
    error, before = (data["error"].values[x][0] for x in (chosen, nominal))
    worse = [_say("worse", group=x) for x in data["group"].values[error > WORSE * before]]
    if worse:
        yield _say("bought", why=enumeration(worse, SHOWN))
    yield _say("not-judged")


def _say(kind: str, **values: Any) -> str:
    return VERDICT[kind].sentence.format(**values)


def _use(data: Dataset) -> str:
    misfit, groups = data["misfit"].values, data["group"].values
    worst = np.argsort(-misfit) if misfit.size > SHOWN else range(misfit.size)
    size = enumeration([f"{misfit[i]:.2g} ({groups[i]})" for i in worst], SHOWN)
    use = _say("use", reference=data.attrs["reference"], errors=size)
    lacks = (misfit > LARGE) | (data["lack_of_fit"].values < CHANCE)
    small = groups[data["too_small"].values < CHANCE].tolist()
    more = [_say("lacks")] if lacks.any() else []
    more += [_say("too-small", groups=enumeration(small, SHOWN))] if small else []
    return " ".join([use, *more])


def _at_bounds(data: Dataset) -> Iterator[str]:
    best = _row(data, Kind.MOST_PROBABLE)
    names, groups = (list(map(str, data[name].values)) for name in ("parameter", "group"))
    sides, theta = best["at_bound"].values, best["theta"].values
    if not sides.any():
        return
    at = held(names, sides, theta)
    if "freed_theta" not in data:
        yield _say("at-bound", at=at, it="it" if np.count_nonzero(sides) == 1 else "them")
        return
    free = Freed(data["freed_theta"].values, data["freed_misfit"].values, data.attrs["freed_less"])
    wrong = bound(names, groups, sides, theta, data["misfit"].values, free)
    if wrong is None:
        yield _say("at-harmless-bound", at=at, gain=100 * GAIN)
    else:
        yield f"{wrong}."


def _wrong(data: Dataset) -> Iterator[str]:
    """Yield which prior and which fixed value the data contradict."""
    if "prior_parameter" in data.attrs:
        names = ("parameter", "value", "away")
        yield _say("wrong-prior", **{name: data.attrs[f"prior_{name}"] for name in names})
    if "fixed_parameter" in data.attrs:
        before, after = data["misfit"].values, data["unfixed_misfit"].values
        i = int(np.argmax(before - after))
        errors = {"group": data["group"].values[i], "after": after[i], "before": before[i]}
        name, value = (data.attrs[f"fixed_{x}"] for x in ("parameter", "value"))
        yield _say("wrong-fixed", name=name, value=value, **errors)


def _pairs(data: Dataset) -> Iterator[str]:
    unlike = data["mac_mode"].values != _row(data, Kind.MOST_PROBABLE)["paired_mode"].values
    if unlike.any():
        modes = enumeration([str(r) for r in data["mode"].values[unlike]])
        yield _say("unlike", modes=modes)


def _parameters(data: Dataset) -> Iterator[str]:
    """Yield values and 90 % intervals of the parameters, of which the data determine most first."""
    theta = _row(data, Kind.MOST_PROBABLE)["theta"].values
    low, _, high = data["interval"].values.T
    of = zip(data["parameter"].values, map(_interval, theta, low, high), strict=True)
    parts = np.array([f"{name} {interval}" for name, interval in of])
    for trust in TRUST:
        own = parts[data["trust"].values == trust].tolist()
        if own:
            yield _say(trust, parameters=enumeration(own, SHOWN))


def _interval(value: float, low: float, high: float) -> str:
    """Return a value with the ends of its interval, in digits that tell these apart.

    >>> _interval(1.1, 1.09992, 1.10011), _interval(1.16, 0.9, 1.5)
    ('1.1 (1.0999 to 1.1001)', '1.16 (0.9 to 1.5)')
    """
    size, width = max(abs(low), abs(high)), high - low
    digits = max(3, min(int(np.ceil(np.log10(size / width))) + 1, 9)) if width > 0 else 3
    return f"{value:.{digits + 1}g} ({low:.{digits}g} to {high:.{digits}g})"


def _front(data: Dataset) -> Iterator[str]:
    """Yield whether the front is a compromise, or at most one group changes by more than noise."""
    along = front_points(data)
    if along.size < 2 or any(True for _ in _pairs(data)):
        return
    change = np.ptp(data["front_misfit"].values[along], axis=0)
    # Where one group alone changes, its best model gives nothing up.
    *_, second, first = np.argsort(change, kind="stable")[[0, *range(change.size)]]
    kind, i = ("agree", second) if change[second] < SMALL else ("compromise", first)
    yield _say(kind, group=data["group"].values[i], change=change[i])


def _predictions(data: Dataset) -> Iterator[str]:
    """Yield the posterior and the range of the first quantity of the first predictions."""
    for each in list(predictions_in(data))[:2]:
        for x in [x for x in each.quantities if x.variable.ranged and x.drawn][:1]:
            if np.isfinite(x.extent[:2]).all():
                ends = dict(zip(("least", "greatest"), x.extent[:2], strict=True))
                ends |= {"low": x.drawn["5 %"], "high": x.drawn["95 %"]}
                names = {"name": each.name, "place": x.place, "quantity": x.variable.key}
                yield _say("prediction", **names, **ends)


def _next(data: Dataset, spare: Sequence[str]) -> Iterator[str]:
    """Yield what to measure for the least determined parameter, and what the study could fix."""
    low, _, high = data["interval"].values.T
    share, trust = (high - low) / data["prior_width"].values, data["trust"].values
    j = int(np.argmax(share))
    if trust[j] == TRUST[0]:
        return
    name, gain = data["parameter"].values[j], data["candidate_gain"].values[:, j]
    c = int(np.argmax(gain)) if gain.size else -1
    if c >= 0 and gain[c] >= GAIN:
        sensor, frequency = (data[f"candidate_{x}"].values[c] for x in ("sensor", "frequency"))
        what = f"at sensor {sensor}" if sensor else f"the mode near {frequency:.3g} Hz"
        yield _say("measure", what=what, name=name, gain=100 * gain[c])
    if lines := _closed(data, spare):
        yield _say("leave-open-less", lines=enumeration(lines, SHOWN))


def _closed(data: Dataset, spare: Sequence[str]) -> list[str]:
    """Return the parameters that could be tied or fixed, with the line of a study that does it.

    These are the ``spare`` ones; without any, those that are not determined, of which one is left.
    Of those that are known together only, one is enough: draws of two whose sum is known are
    correlated negatively, and of those whose ratio is known positively.
    """
    names, trust = data["parameter"].values.tolist(), data["trust"].values.tolist()
    nominal = _row(data, Kind.NOMINAL)["theta"].values
    with np.errstate(invalid="ignore", divide="ignore"):
        joint = np.corrcoef(data["sample_theta"].values, rowvar=False)
    joint = np.nan_to_num(joint).reshape(len(names), -1)
    lines, done = [], np.array([x == TRUST[0] for x in trust])
    for j in map(names.index, spare or names):
        if done[j]:
            continue
        done[j] = True
        along = np.where(done, 0.0, joint[j])
        twin = int(np.argmax(np.abs(along)))
        if along[twin] < -TWINS and nominal[j] == nominal[twin]:
            lines.append(f'{names[j]}: tie = "{names[twin]}"')
        elif abs(along[twin]) > TWINS or trust[j] == TRUST[2] or spare:
            lines.append(f"{names[j]}: fixed = true")
        if abs(along[twin]) > TWINS:
            done |= np.abs(along) > TWINS
    return lines[: len(names) - 1]


def _row(data: Dataset, kind: Kind) -> Dataset:
    return data.isel(point=data["kind"].values.tolist().index(kind.value))
