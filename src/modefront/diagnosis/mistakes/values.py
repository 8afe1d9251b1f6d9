"""Units and values of data and parameters; sets that disagree; foreign modes; wrong members."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import combinations, product
from typing import Any

import numpy as np

from modefront._typing import Ints
from modefront.diagnosis.evidence import FREQUENCY, RIGID, log_frequencies, mac_values
from modefront.diagnosis.mistakes.record import IMPRECISE, MANY, Explanation, Mistake, changed
from modefront.diagnosis.state import NOTHING, State, median, stacked
from modefront.findings.knowledge import enumeration
from modefront.findings.record import UNITS
from modefront.pairing.match import assigned

RAD = 2 * np.pi

REACH = 0.25  # logarithm of a factor beside a known one that parameters make up for
POWERS = (1, -1, 2, -2, 3, -3, 6, -6, 9, -9)  # powers of ten by which a value is off


def frequency_factor(old: Explanation) -> Iterator[Mistake]:
    """Yield known factors on all frequencies, and others that pairs, or modes in order, show."""
    known = np.log([factor for factor, _, _ in UNITS])
    found, logs, shown = [(0.0, *unit) for unit in UNITS], old.state.logs, set()
    measured, f = np.flatnonzero(np.isfinite(logs)), old.modes.frequency
    elastic, ascending = np.log(f[f > RIGID * f.max()]), np.sort(logs[measured])
    if measured.size and elastic.size:
        of_pairs = np.median((logs - log_frequencies(f)[old.point.pairs])[measured])
        in_order = np.median(ascending[: elastic.size] - elastic[: measured.size])
        shown = {round(float(x), 4) for x in (of_pairs, in_order, *ascending[0] - elastic[:3])}
    for log in sorted(shown):
        if np.abs(known - log).min() >= REACH:
            looks = f"stiffness over mass is off by {np.exp(2 * log):.3g}"
            mend = "check units, sections and masses, or the nominal values of the parameters"
            found.append((2 * np.log(len(UNITS)), float(np.exp(log)), looks, mend))
    for price, factor, looks, mend in found:
        numbers = {"factor": factor, "looks": looks, "mend": mend}
        change = changed("frequency", ..., factor)
        yield Mistake("frequency-factor", ("frequencies",), change, numbers, price)


# Quantities g that are no frequencies, with a and b of f = a g^b.
QUANTITIES = {"periods in s": (1.0, -1.0), "eigenvalues in (rad/s)²": (1 / RAD, 0.5)}


def other_quantity(old: Explanation) -> Iterator[Mistake]:
    """Yield quantities that are no frequencies.

    Scatter of ln g is that of ln f over b, and its density that of ln f times b.
    """
    known, f = np.flatnonzero(np.isfinite(old.state.logs)), old.state.frequency
    for quantity, (a, b) in QUANTITIES.items() if known.size else ():
        given, cost = np.exp(old.state.logs[known[0]]), -np.log(abs(b)) * np.isfinite(f).sum()
        numbers: dict[str, Any] = {"quantity": quantity, "mode": old.data.modes[known[0]]}
        numbers |= {"given": float(given), "better": float(a * given**b)}
        change = changed("frequency", ..., lambda g, a=a, b=b: a * g**b, cost)
        yield Mistake("other-quantity", ("frequencies",), change, numbers)


def damping_in_percent(old: Explanation) -> Iterator[Mistake]:
    """Yield damping over 100."""
    if (known := old.state.damping[np.isfinite(old.state.damping)]).size:
        numbers = {"least": float(known.min()), "greatest": float(known.max())}
        change = changed("damping", ..., 100.0)
        yield Mistake("damping", ("damping",), change, numbers)


SLIPS = (10.0, 0.1, 100.0, 0.01, 2.0, 0.5)  # factors by a lost decimal point or aliasing
FAR = 4.0  # logarithm of the range in which others are


def wrong_frequency(old: Explanation) -> Iterator[Mistake]:
    """Yield known factors on the frequency of each mode, and others that the model has.

    Each of the latter is as many as the widths of normal distributions in their range.
    """
    modes, logs, f = old.data.modes, old.state.logs, old.modes.frequency
    unknown = float(np.log(FAR / (FREQUENCY * np.sqrt(2 * np.pi)) / len(SLIPS)))
    for r in np.flatnonzero(np.isfinite(logs)).tolist():
        found = [(0.0, factor, f", and {1 / factor:g} times it would fit") for factor in SLIPS]
        q, mac = int(old.point.pairs[r]), old.point.mac[r]
        log = logs[r] - log_frequencies(f)[q]
        if np.abs(log - np.log(SLIPS)).min() >= REACH:
            found.append((unknown, float(np.exp(log)), ""))
        alike = "" if np.isnan(mac) else f" (MAC {mac:.2f})"
        numbers = {"model": q + 1, "f": float(old.fits.comparison.frequency[q]), "alike": alike}
        numbers["measured"] = float(np.exp(logs[r]))
        for price, factor, looks in found:
            change, said = changed("frequency", np.s_[:, r], factor), numbers | {"looks": looks}
            yield Mistake("far-from-model", (str(modes[r]),), change, said, price)


def wrong_nominal_value(old: Explanation) -> Iterator[Mistake]:
    """Yield powers of ten on each parameter that is changed by factors, and on its bounds."""
    start, names = old.state.start, old.fits.comparison.problem.model.parameters
    for j, power in product(np.flatnonzero(old.state.unit[: len(names)] == 0).tolist(), POWERS):
        numbers = {"name": names[j], "given": float(start[j]), "better": start[j] * 10.0**power}
        change = changed("start", j, 10.0**-power)
        yield Mistake("nominal-value", (names[j],), change, numbers)


LOOKS = {RAD: ": rad/s for Hz", 1 / RAD: ": Hz for rad/s", 60.0: ": per minute for Hz"}
"""Causes of factors on the frequencies of a set."""

DIFFERED = (
    "the structure differed (mass, temperature, supports): update with one of the sets, or say by "
    "frequency_std how far frequencies scatter"
)


def set_factor(old: Explanation) -> Iterator[Mistake]:
    """Yield the median ratio of the frequencies of each set to those of the others."""
    f, sets = old.state.frequency, old.data.sets
    for k, name in enumerate(sets if len(sets) > 1 else ()):
        ratios = np.log(f[k]) - median(np.log(np.delete(f, k, axis=0)))
        if np.isfinite(ratios).sum() < 2:
            continue
        factor = float(np.exp(np.nanmedian(ratios)))
        size, looks, mend = f"{100 * (factor - 1):+.1f} % off", "", DIFFERED
        if abs(factor - 1) > 0.4:
            looks = next((x for y, x in LOOKS.items() if abs(np.log(factor / y)) < 0.1), "")
            size, mend = f"{factor:.3g} times", "give all data sets in Hz"
        numbers = {"set": name, "other": enumeration([*sets[:k], *sets[k + 1 :]], 2)}
        numbers |= {"size": size, "looks": looks, "mend": mend}
        yield Mistake("set-factor", (name,), changed("frequency", k, factor), numbers)


PARTS = ("frequency", "damping", "shape", "std")


def other_numbers(old: Explanation) -> Iterator[Mistake]:
    """Yield numbers for the modes of each set most like the others'; of unlike ones, their own."""
    state, sets, modes = old.state, old.data.sets, old.data.modes
    for k, name in enumerate(sets if len(sets) > 1 else ()):
        rest = replace(state, **{x: np.delete(getattr(state, x), k, axis=0) for x in PARTS})
        mac = mac_values(state.psi[k], state.seen[k], rest.mean.T)
        distance = np.minimum(4 * np.abs(np.log(state.frequency[k])[:, None] - rest.logs), 1.0)
        cost = np.nan_to_num(1 - mac) + np.nan_to_num(distance)
        known = np.isfinite(mac) | np.isfinite(distance)
        index = assigned(np.where(known, cost, 1.0 - np.eye(len(cost))))
        rows = np.flatnonzero(index != np.arange(index.size))
        if rows.size:
            numbers = {"set": name, "other": enumeration([*sets[:k], *sets[k + 1 :]], 2)}
            for what, r in (("modes", rows), ("of", index[rows])):
                numbers[what] = enumeration([str(modes[i]) for i in r], MANY)
            change = partial(_renumbered, k=k, index=index)
            yield Mistake("set-numbers", (name,), change, numbers, moves=True)


def _renumbered(state: State, k: int, index: Ints) -> State:
    parts: Any = {name: getattr(state, name).copy() for name in PARTS}
    for name, values in parts.items():
        values[k, index] = getattr(state, name)[k]
    return replace(state, **parts)


def exchanged_shapes(old: Explanation) -> Iterator[Mistake]:
    """Yield each two modes, as if in all data sets each had the shape of the other."""
    state, modes = old.state, old.data.modes
    known = np.flatnonzero(np.isfinite(state.logs) & state.known.any(axis=1))
    for pair in combinations(known.tolist(), 2):
        names = tuple(str(modes[r]) for r in pair)
        change = changed("shape", np.s_[:, pair], partial(np.flip, axis=1))
        numbers = {"modes": enumeration(names)}
        yield Mistake("exchanged-shapes", names, change, numbers, moves=True)


WRONG = {"frequency": 0.2, "shape": 1.0}  # scale of wrong values: of ln f, and of shapes


def odd_value(old: Explanation) -> Iterator[Mistake]:
    """Yield the frequency and the shape of each mode in each of several sets.

    Of two sets nobody knows which one is wrong: both blame the mode.
    """
    sets, modes, state = old.data.sets, old.data.modes, old.state
    for (part, wrong), (r, mode) in product(WRONG.items(), enumerate(modes)):
        count = np.isfinite(getattr(state, part)[:, r].reshape(len(sets), -1)).sum(axis=1)
        known, f = np.flatnonzero(count).tolist(), state.frequency[:, r]
        for k in known if len(known) > 1 else ():
            others, subject = [j for j in known if j != k], [str(mode)]
            if len(others) > 1:
                subject.append(sets[k])
                who = f"set {sets[k]} disagrees with {enumeration([sets[j] for j in others], 3)}"
                look = f"look at set {sets[k]} again, or leave out its"
                value, other = f[k], np.exp(median(np.log(f[others, None]))[0])
            else:
                who = f"sets {sets[known[1]]} and {sets[known[0]]} disagree"
                look = "look at both again, or leave out the worse"
                other, value = f[known]
            numbers: dict[str, Any] = {"mode": mode, "who": who, "look": look, "f": float(value)}
            numbers |= {"other": float(other), "percent": float(100 * (value / other - 1))}
            change = changed(part, np.s_[k, r], np.nan, count[k] * np.log(wrong))
            yield Mistake(f"odd-{part}", tuple(subject), change, numbers)


def foreign_mode(old: Explanation) -> Iterator[Mistake]:
    """Yield modes that the model does not have, or has not so high."""
    modes, of_model = old.data.modes, old.modes.frequency
    for r, f in enumerate(np.exp(old.state.logs).tolist()):
        numbers = {"mode": modes[r], "at": "" if np.isnan(f) else f" at {f:.4g} Hz", "measured": f}
        numbers |= {"modes": of_model.size, "highest": float(of_model.max())}
        kind = "outside-model" if f > of_model.max() else "foreign-mode"
        yield Mistake(kind, (str(modes[r]),), partial(_foreign, r=r), numbers)


def _foreign(state: State, r: int) -> State:
    """Return the state without a mode, of which data sets differ as before, and all else is new."""
    frequency, shape = state.frequency.copy(), state.shape.copy()
    frequency[:, r] = shape[:, r] = np.nan
    new = replace(state, frequency=frequency, shape=shape)
    cost = state.noise - new.noise + NOTHING * (1 + state.known[r].sum())
    return replace(new, left_out=state.left_out + cost)


def later_mode(old: Explanation) -> Iterator[Mistake]:
    """Yield measured modes that are like model modes beyond those among which pairs are sought."""
    state, own, f = old.state, old.point, old.modes.frequency
    free = old.fits.at(stacked([replace(state, candidates=np.array(f.size))]), own.x[None]).of(0)
    for r in np.flatnonzero(free.pairs >= state.candidates).tolist():
        later, modes = int(free.pairs[r]) + 1, old.data.modes
        numbers = {"later": later, "f": float(old.fits.comparison.frequency[later - 1])}
        numbers |= {"mac": free.mac[r], "best": own.mac[r], "spare": later - len(modes)}
        change, price = partial(replace, candidates=np.array(later)), f.size - int(state.candidates)
        yield Mistake("beyond-candidates", (str(modes[r]),), change, numbers, float(np.log(price)))


NEAREST = 2  # members that are tried: those of which the cost is less ahead of a step

THOUSANDS = (3, -3, 6, -6, 9, -9)  # powers of ten by which units differ


def _scaled(state: State, part: int, factor: float) -> State:
    """Return the state with a factor on a part of the model as its last parameter."""
    start = state.start.copy()
    start[-1] = factor
    return replace(state, start=start, part=np.array(part + 1))


def wrong_member(old: Explanation, *, usual: bool = False) -> Iterator[Mistake]:
    """Yield the members that promise most, several times as stiff or heavy as in the model.

    What is ``usual`` is a factor of up to 2, or its inverse: many members differ so.
    """
    parts = old.fits.parts
    single = np.flatnonzero([not x.whole for x in parts])
    if old.state.part or not single.size:
        return
    ahead, dx = old.fits.by_parts(old.state, old.point.x)
    first = single[np.argsort(ahead[single], kind="stable")[:NEAREST]]
    price = float(np.log(single.size / first.size))
    for k in first.tolist():
        size, factor = ("greater", 4.0) if dx[k] > 0 else ("smaller", 0.25)
        kind, size, factor = (IMPRECISE, "", 1.0) if usual else ("wrong-member", size, factor)
        numbers = {"what": parts[k].of, "place": parts[k].place, "better": size}
        yield Mistake(kind, ("model",), partial(_scaled, part=k, factor=factor), numbers, price)


def wrong_unit(old: Explanation) -> Iterator[Mistake]:
    """Yield powers of ten on the stiffness or mass of groups that no parameter scales."""
    parts = enumerate(old.fits.parts if not old.state.part else ())
    for (k, part), power in product([x for x in parts if x[1].whole], THOUSANDS):
        numbers = {"what": part.of, "place": part.place, "factor": 10.0**-power}
        change = partial(_scaled, part=k, factor=10.0**power)
        yield Mistake("wrong-unit", (f"{part.of} {part.place}",), change, numbers)
