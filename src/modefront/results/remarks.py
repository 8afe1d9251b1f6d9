"""Findings of results, those of their analysis included, in the order of what matters."""

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from modefront._typing import Bools
from modefront.datasets import Dataset
from modefront.findings.knowledge import enumeration
from modefront.findings.record import Finding, Severity, found, from_text, in_order
from modefront.front.point import Kind, front_points, preferred
from modefront.optim.problem import at_bounds
from modefront.pairing.match import POOR
from modefront.predictions.base import predictions_in
from modefront.rounding import ACCUMULATED

MOST, NAMED, FEW, RANGES = 10, 6, 2, 4
"""Findings that are printed, unless all are asked for; points, or runs of them, that a sentence
names; modes whose pairs change and parameters at bounds on a first screen; ranges in a sentence."""

NEGATIVE = 1e-6
"""Size of a negative weight, the sum of all being 1, that solutions do not leave by rounding: ten
times the tolerance of a step (`modefront.optim.sqp.Options`)."""

ARRIVED = 1e-5
"""Distance of two optimally weighted models, over the ranges, below which they are the same: a
hundred times the tolerance of a step, which minima that are nearly flat miss by as much."""

WIDE = 1.02  # ratio of greatest to least prediction from which a spread is worth a sentence


def verdict(data: Dataset) -> list[str]:
    """Return the sentences of the first answer."""
    return str(data.attrs.get("verdict", "")).splitlines()


def not_converged(data: Dataset) -> Bools:
    """Return which points should have converged and did not."""
    solved = ~np.isin(data["status"].values, ["sampled", "jump"])
    return ~data["converged"].values & solved


def uncertified(data: Dataset) -> Bools:
    """Return which models have eigenvalues that do not meet the tolerance."""
    return ~data["certified"].values if "certified" in data else np.zeros(data.sizes["point"], bool)


def digest(sentences: Sequence[str], where: str, most: int | None = MOST) -> list[str]:
    """Return the first of some sentences, with how many more and the option that prints them.

    >>> digest(["a", "b", "c"], "see FILE", 2)
    ['a', 'b', 'and 1 more finding: see FILE']
    """
    rest = 0 if most is None else len(sentences) - most
    if rest <= 0:
        return list(sentences)
    more = f"and {rest} more finding" if most else f"{rest} finding"
    return [*sentences[:most], f"{more}{'s' * (rest > 1)}: {where}"]


def findings_of(data: Dataset, *, full: bool = False) -> list[Finding]:
    """Return the findings of results, the most important first.

    ``full`` has details of branches, numerics and coverage too, and names all models and modes.
    """
    most = sys.maxsize if full else FEW
    texts = data["finding"].values.tolist()
    records = data["finding_record"].values.tolist() if "finding_record" in data else texts
    parts = [_failures, _front, _misfit, _ranges, *([_weights, _numerics] if full else [])]
    out = [finding for part in parts for finding in part(data)]
    out += [*_pairs(data, most), *_at_bounds(data, most), *map(from_text, records, texts)]
    return in_order(x for x in out if full or x.severity is not Severity.DETAIL)


def _failures(data: Dataset) -> Iterator[Finding]:
    status, pareto = data["status"].values, data["pareto"].values
    if (status == "sampled").any():
        spent = int(data.attrs["front_evaluations"])
        yield found("no-test", str(data.attrs["method"]), evaluations=spent)
    marked = {"not-converged": not_converged(data), "inaccurate": uncertified(data)}
    marked["jump"], weight = status == "jump", data["stationary_weight"].values
    marked["not-optimal"] = (weight < -NEGATIVE).any(axis=1) & ~np.isnan(weight).any(axis=1)
    if "piece" in data:
        on_front = data["kind"].values == Kind.FRONT.value
        marked["between-branches"] = on_front & ~pareto & ~data["dominated_among_front"].values
    yield from (found(kind, places(data, x)) for kind, x in marked.items() if x.any())


def _front(data: Dataset) -> Iterator[Finding]:
    """Yield how many points and branches the front has, and where these end."""
    front, pareto = front_points(data), data["pareto"].values
    optimal = int(pareto[front].sum())
    if data.attrs["front_is_a_point"]:
        yield found("one-model")
    elif front.size:
        said = "all" if optimal == front.size else optimal
        yield found("front", points=int(front.size), optimal=said)
    if gaps := data.sizes.get("end", 0) // 2:
        yield found("branches", branches=gaps + 1)
        for k, ends in enumerate(data["end_objective"].values.reshape(gaps, 2, -1), start=1):
            if np.isfinite(ends).all():
                end, start = ("(" + ", ".join(f"{x:.5g}" for x in J) + ")" for J in ends)
                yield found("branch-ends", str(k), other=k + 1, end=end, start=start)
    gap, requested = data.attrs.get("largest_gap", 0.0), data.attrs.get("refined", np.inf)
    if gap > requested:
        yield found("spacing", gap=float(gap), requested=float(requested))


def places(data: Dataset, chosen: Bools) -> str:
    """Return the labels of chosen points (points,); how many there are where these are many.

    Neighbours on a front of two objectives are named by the first and the last one.
    """
    labels = data["label"].values.tolist()
    front = front_points(data).tolist() if data.sizes["group"] == 2 else []
    along = {i: k for k, i in enumerate(front)}
    at = enumerate(np.flatnonzero(chosen).tolist())
    # Neighbours have the same distance of their places along the front and among those chosen.
    parts: list[str] = []
    for _, near in groupby(at, lambda x: along[x[1]] - x[0] if x[1] in along else labels[x[1]]):
        run = [labels[i] for _, i in near]
        parts += [f"{run[0]} to {run[-1]}"] if run[2:] else run
    if len(parts) > NAMED:
        return f"{int(chosen.sum())} of {len(labels)} models"
    return ", ".join(parts)


def _misfit(data: Dataset) -> Iterator[Finding]:
    """Yield how far models are from the data: all Pareto-optimal ones, the reference, the nominal.

    Pareto-optimal are edges and weighted models too: the best models are never left out.
    """
    chosen, best = data["pareto"].values, preferred(data.attrs)
    nominal, beside = data["kind"].values == Kind.NOMINAL.value, ""
    if np.isfinite(data["frequency"].values[nominal]).any():
        beside = f"; the nominal model has {fit_of(data, nominal)}"
    if count := int(chosen.sum()):
        whole, own = fit_of(data, chosen, whole=True), fit_of(data, data["label"].values == best)
        yield found("misfit", best, models=count, whole=whole, reference=own, nominal=beside)


def fit_of(data: Dataset, chosen: Bools, *, whole: bool = False) -> str:
    """Return the worst error of a frequency and the least MAC of models, in a whole sentence."""
    with np.errstate(divide="ignore", invalid="ignore"):
        f = data["frequency"].values[chosen] / data["measured_frequency"].values
    error, mac = 100 * np.abs(f[np.isfinite(f)] - 1), data["mac"].values[chosen]
    mac, parts = mac[np.isfinite(mac)], []
    if error.size:
        within = f"frequencies within {_percent(error.max())} % of the measured ones"
        parts.append(within if whole else f"{_percent(error.max())} %")
    if mac.size:
        least = _mac(mac.min())
        parts.append(f"MAC values of {least} or more" if whole else least)
    return " and ".join(parts) or "nothing that is measured"


def _percent(value: float) -> str:
    """Return an error in % with two digits, rounded up: no model has a greater one.

    >>> _percent(1.04), _percent(0.78), _percent(123.4)
    ('1.1', '0.78', '124')
    """
    if value < 0.01:
        return "0.01"
    decimals = max(1 - int(np.floor(np.log10(value))), 0)
    up = np.ceil(10**decimals * value * (1 - ACCUMULATED)) / 10**decimals
    return f"{up:.2g}" if up < 10 else f"{up:.0f}"


def _mac(value: float) -> str:
    """Return a MAC with three digits, rounded down: no model has a smaller one.

    >>> _mac(0.9996), _mac(1.0), _mac(0.812)
    ('0.999', '1.000', '0.812')
    """
    return f"{np.floor(1e3 * value + 1e-9) / 1e3:.3f}"


def _weights(data: Dataset) -> Iterator[Finding]:
    optimal = data["theta"].values[data["kind"].values == Kind.OPTIMAL.value]
    if not optimal.size:
        return
    if exact := data["group"].values[data["exact"].values].tolist():
        yield found("exact-fit", ", ".join(exact))
    iterated = data["minimum_theta"].values[data["minimum_of"].values == "iterated-weights"]
    away = np.abs(iterated - optimal[:1]) / np.ptp(data["bounds"].values, axis=1)
    if not len(away):
        yield found("iteration-ends")
    else:
        yield found("iteration-agrees" if away.max() < ARRIVED else "iteration-differs")


def _pairs(data: Dataset, most: int) -> Iterator[Finding]:
    """Yield which measured modes resemble model modes poorly, or change their model mode.

    The first ``most`` poor pairs have their places; where modes change them is said of as many, and
    of a front of two objectives, on which points have neighbours.
    """
    poor = data["mac"].values < POOR
    at = zip(data["mode"].values, poor.T, strict=True)
    if named := [f"{r} ({places(data, column)})" for r, column in at if column.any()]:
        yield found("poor-pair", enumeration(named, most), many=len(named) > 1, poor=POOR)
    front = front_points(data)
    labels, paired = data["label"].values[front], data["paired_mode"].values[front]
    out, changed = [], []
    for r, column in zip(data["mode"].values, paired.T, strict=True):
        counts = Counter(sorted(column[np.isfinite(column)])).most_common()
        changes = np.flatnonzero(np.diff(column)).tolist()
        if len(counts) < 2:
            continue
        changed.append(str(r))
        if data.sizes["group"] == 2 and len(changes) <= 2:
            for i in changes:
                before, after = (f"{column[k]:.0f}" for k in (i, i + 1))
                ends = {"first": labels[i], "second": labels[i + 1]}
                out.append(found("changed-pair", str(r), before=before, after=after, **ends))
            continue
        each = ", ".join(f"{number:.0f} at {count}" for number, count in counts)
        out.append(found("changed-pairs", str(r), counts=f": {each} of {front.size} points"))
    if len(out) > most:
        out = [found("changed-pairs", ", ".join(changed), many=True, counts="")]
    yield from out


def _at_bounds(data: Dataset, most: int) -> Iterator[Finding]:
    """Yield which parameters are at a bound and where, the first ``most`` of them."""
    at_bound = at_bounds(data["theta"].values, *data["bounds"].values.T) != 0
    held = np.flatnonzero(at_bound.any(axis=0))
    names = data["parameter"].values[held]
    if held.size:
        at = zip(names, held, strict=True)
        named = [f"{name} ({places(data, at_bound[:, j])})" for name, j in at]
        yield found("at-bounds", enumeration(named, most))


def _ranges(data: Dataset) -> Iterator[Finding]:
    """Yield how far parameters and predictions go over the Pareto-optimal models."""
    theta, span = data["theta"].values[data["pareto"].values], np.ptp(data["bounds"].values, axis=1)
    if len(theta) > 1:
        low, high = theta.min(axis=0), theta.max(axis=0)
        order = np.argsort((low - high) / np.where(span > 0, span, 1.0), kind="stable").tolist()
        names, first = data["parameter"].values, order[:RANGES]
        said = ", ".join(f"{names[j]} from {low[j]:.3g} to {high[j]:.3g}" for j in first)
        rest = len(order) - len(first)
        less = f" ({rest} parameter{'s' * (rest > 1)} more var{'y' if rest > 1 else 'ies'} less)"
        yield found("ranges", said + less * (rest > 0), models=len(theta))
    every = (x for each in predictions_in(data) for x in each.quantities)
    wide = (x for x in every if WIDE < x.extent[2] < np.inf)
    if widest := sorted(wide, key=lambda x: -x.extent[2])[:3]:
        texts = (f"{x.variable.key} of {x.label} {_times(x.extent[2])}" for x in widest)
        yield found("spread", "; ".join(texts))


def _times(ratio: float) -> str:
    """Return a ratio in words.

    >>> _times(1.31), _times(2.34), _times(4512.3), _times(3.2e7)
    ('by 31 %', 'by a factor of 2.3', 'by a factor of 4,500', 'by more than 7 powers of ten')
    """
    if ratio < 2:
        return f"by {100 * (ratio - 1):.2g} %"
    if ratio < 1e6:
        return f"by a factor of {float(f'{ratio:.2g}'):,.7g}"
    return f"by more than {int(np.log10(ratio))} powers of ten"


def _numerics(data: Dataset) -> Iterator[Finding]:
    """Yield how exact the modes of a reduced basis are, how well the front is covered, the cost."""
    attrs = data.attrs
    if attrs.get("remark"):
        yield found("remark", str(attrs["remark"]))
    if "certified" in data:
        full, corrected, predicted = (
            int(attrs.get(f"{x}_eigensolutions", 0)) for x in ("full", "corrected", "prediction")
        )
        said: dict[str, Any] = {"tolerance": float(attrs["eigenvalue_tolerance"])}
        said |= {x: float(data[f"{x}_error"].values.max()) for x in ("eigenvalue", "shape")}
        yield found("reduced", full=full - predicted, corrected=corrected, **said)
        if predicted:
            yield found("not-reduced", full=predicted)
    gap, volume, igd = (float(attrs[x]) for x in ("largest_gap", "hypervolume", "igd_plus"))
    if not (np.isnan(gap) and np.isnan(volume)):
        missing = "; for the hypervolume: pip install modefront[metrics]" * bool(np.isnan(volume))
        yield found("coverage", hypervolume=volume, igd=igd, gap=gap, missing=missing)
    spent, front = (int(attrs[f"{of}_evaluations"]) for of in ("model", "front"))
    yield found("effort", spent=spent, front=front)
