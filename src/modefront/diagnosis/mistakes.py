"""Mistakes as records: what each blames, what it changed in data or model, and its price.

A kind is one entry of `MISTAKES`, and a function that yields its records beside an explanation; its
sentence, and what mends it, are in the catalogue of findings.
"""

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations, permutations, product
from typing import Any, TypeAlias

import numpy as np

from modefront._typing import Floats, Ints
from modefront.data.modal import ModalData
from modefront.diagnosis import evidence
from modefront.diagnosis import state as measured
from modefront.diagnosis.state import NOTHING, State, loss, median, stacked
from modefront.findings.knowledge import enumeration
from modefront.findings.record import UNITS, Finding, found
from modefront.models.geometry import ALONG, Geometry, axis_name
from modefront.modes.result import Modes
from modefront.pairing.match import assigned
from modefront.rounding import ACCUMULATED

MANY = 6  # names that a sentence has, at most

BETTER = ("better", "factor", "looks", "place", "sensor", "what", "of", "quantity", "later")
"""Names and numbers of sentences that tell mistakes of the same claim from each other."""

IMPRECISE = "imprecise-member"  # kind that is no mistake, and never named

FOREIGN = ("foreign-mode", "outside-model")  # kinds that leave out all of a mode

Edit: TypeAlias = tuple[str, Any, Any]
"""An array of the state, a place in it, and what is right there, or the function that makes it."""

Cost: TypeAlias = float | Callable[[State, State], float]
"""What the values without a mistake cost because of their unit, or how two states say it."""


@dataclass(frozen=True, eq=False)
class Mistake:
    """A mistake that may have been made."""

    finding: Finding  # its record among all that is found
    edits: Sequence[Edit]  # what it has changed; NaN leaves values out
    # negative logarithm of its probability; as it is yielded, among the mistakes of its kind
    price: float = 0.0
    cost: Cost = 0.0
    # whether it has moved values to other sensors or modes: it is undone before others, which are
    # said of the right ones
    moves: bool = False

    @property
    def claim(self) -> tuple[str, str]:
        """What is claimed: the kind, and whom it blames."""
        return self.finding.kind, self.finding.subject

    @property
    def key(self) -> tuple[object, ...]:
        """What tells it from others: the claim, and what is better, without the numbers beside."""
        return (*self.claim, *map(self.finding.numbers.get, BETTER))

    def undone(self, state: State) -> State:
        """Return a state without it."""
        parts: Any = {name: getattr(state, name).copy() for name, _, _ in self.edits}
        lost = 0
        for name, place, better in self.edits:
            given = getattr(state, name)[place]
            parts[name][place] = better(given) if callable(better) else better
            lost += np.isfinite(given).sum() - np.isfinite(parts[name][place]).sum()
        new = replace(state, **parts, left_out=state.left_out + NOTHING * lost)
        cost = self.cost(state, new) if callable(self.cost) else self.cost
        return replace(new, left_out=new.left_out + cost) if cost else new


@dataclass(frozen=True, eq=False)
class Explanation:
    """Assumed mistakes, the state without them, the end of a fit, and C there with the prices."""

    fits: evidence.Fits
    mistakes: tuple[Mistake, ...]
    state: State
    point: evidence.Points
    cost: float

    @property
    def claims(self) -> frozenset[tuple[str, str]]:
        """What is claimed."""
        return frozenset(each.claim for each in self.mistakes)

    @property
    def blamed(self) -> frozenset[tuple[str, str]]:
        """What is claimed to be a mistake."""
        return frozenset(claim for claim in self.claims if claim[0] != IMPRECISE)

    @property
    def data(self) -> ModalData:
        """The measured modes as they are given, with the names of sets, modes and sensors."""
        return self.fits.comparison.data

    @property
    def modes(self) -> Modes:
        """The modes of the model at the fitted parameters."""
        modes = self.fits.of(self.state, self.point.x)
        assert modes is not None
        return modes

    @property
    def measured(self) -> list[int]:
        """Sensors with data, as they are given or in the state."""
        known = self.state.known.any(axis=0) | np.isfinite(self.data.shape).any(axis=(0, 1))
        return np.flatnonzero(known).tolist()


def over(factor: float) -> Callable[[Floats], Floats]:
    """Return the function that divides values by a factor."""
    return lambda values: values / factor


# Units and values.

RAD = 2 * np.pi

REACH = 0.25  # logarithm of a factor beside a known one that parameters make up for
MEND = "check units, sections and masses, or the nominal values of the parameters"


def frequency_factor(old: Explanation) -> Iterator[Mistake]:
    """Yield known factors on all frequencies, and others that pairs, or modes in order, show."""
    units, logs, shown = [(0.0, *unit) for unit in UNITS], old.state.logs, set()
    measured, f = np.flatnonzero(np.isfinite(logs)), old.modes.frequency
    elastic, ascending = np.log(f[f > evidence.RIGID * f.max()]), np.sort(logs[measured])
    if measured.size and elastic.size:
        of_pairs = np.median((logs - evidence.log_frequencies(f)[old.point.pairs])[measured])
        in_order = np.median(ascending[: elastic.size] - elastic[: measured.size])
        shown = {round(float(x), 4) for x in (of_pairs, in_order, *ascending[0] - elastic[:3])}
    for log in sorted(shown):
        if np.abs(np.log([factor for factor, _, _ in UNITS]) - log).min() >= REACH:
            looks = f"stiffness over mass is off by {np.exp(2 * log):.3g}"
            units.append((2 * np.log(len(UNITS)), float(np.exp(log)), looks, MEND))
    for price, factor, looks, mend in units:
        said = found("frequency-factor", "frequencies", factor=factor, looks=looks, mend=mend)
        yield Mistake(said, [("frequency", ..., over(factor))], price)


# Quantities g that are no frequencies, with a and b of f = a g^b.
QUANTITIES = {"periods in s": (1.0, -1.0), "eigenvalues in (rad/s)²": (1 / RAD, 0.5)}


def other_quantity(old: Explanation) -> Iterator[Mistake]:
    """Yield quantities that are no frequencies.

    Scatter of ln g is that of ln f over b, and its density that of ln f times b.
    """
    known, f = np.flatnonzero(np.isfinite(old.state.logs)), old.state.frequency
    for quantity, (a, b) in QUANTITIES.items() if known.size else ():
        given, mode = float(np.exp(old.state.logs[known[0]])), old.data.modes[known[0]]
        numbers = {"quantity": quantity, "mode": mode, "given": given, "better": a * given**b}
        said = found("other-quantity", "frequencies", **numbers)
        right = [("frequency", ..., lambda g, a=a, b=b: a * g**b)]
        yield Mistake(said, right, cost=-np.log(abs(b)) * np.isfinite(f).sum())


def damping_in_percent(old: Explanation) -> Iterator[Mistake]:
    """Yield damping over 100."""
    if (known := old.state.damping[np.isfinite(old.state.damping)]).size:
        said = found("damping", "damping", least=float(known.min()), greatest=float(known.max()))
        yield Mistake(said, [("damping", ..., over(100.0))])


SLIPS = (10.0, 0.1, 100.0, 0.01, 2.0, 0.5)  # factors by a lost decimal point or aliasing
FAR = 4.0  # logarithm of the range in which others are


def wrong_frequency(old: Explanation) -> Iterator[Mistake]:
    """Yield known factors on the frequency of each mode, and others that the model has.

    Each of the latter is as many as the widths of normal distributions in their range.
    """
    modes, logs, f = old.data.modes, old.state.logs, old.modes.frequency
    unknown = float(np.log(FAR / (evidence.FREQUENCY * np.sqrt(2 * np.pi)) / len(SLIPS)))
    for r in np.flatnonzero(np.isfinite(logs)).tolist():
        slips = [(0.0, factor, f", and {1 / factor:g} times it would fit") for factor in SLIPS]
        q, log = int(old.point.pairs[r]), logs[r] - evidence.log_frequencies(f)[old.point.pairs[r]]
        if np.abs(log - np.log(SLIPS)).min() >= REACH:
            slips.append((unknown, float(np.exp(log)), ""))
        numbers: dict[str, Any] = {"model": q + 1, "f": float(old.fits.comparison.frequency[q])}
        numbers |= {"alike": evidence.alike(old.point.mac[r]), "measured": float(np.exp(logs[r]))}
        for price, factor, looks in slips:
            said = found("far-from-model", str(modes[r]), **numbers, looks=looks)
            yield Mistake(said, [("frequency", np.s_[:, r], over(factor))], price)


POWERS = (1, -1, 2, -2, 3, -3, 6, -6, 9, -9)  # powers of ten by which a value is off


def wrong_nominal_value(old: Explanation) -> Iterator[Mistake]:
    """Yield powers of ten on each parameter that is changed by factors, and on its bounds."""
    start, names = old.state.start, old.fits.comparison.problem.model.parameters
    for j, power in product(np.flatnonzero(old.fits.unit == 0).tolist(), POWERS):
        better = {"given": float(start[j]), "better": start[j] * 10.0**power}
        said = found("nominal-value", names[j], name=names[j], **better)
        yield Mistake(said, [("start", j, over(10.0**-power))])


# Data sets that disagree.

LOOKS = {RAD: ": rad/s for Hz", 1 / RAD: ": Hz for rad/s", 60.0: ": per minute for Hz"}
"""Causes of factors on the frequencies of a set."""

DIFFERED = (
    "the structure differed (mass, temperature, supports): update with one of the sets, or say by "
    "frequency_std how far frequencies scatter"
)


def without(k: int, sets: Sequence[str]) -> str:
    """Return the names of all sets but one."""
    return enumeration([*sets[:k], *sets[k + 1 :]], 2)


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
        said = {"set": name, "other": without(k, sets), "size": size, "looks": looks, "mend": mend}
        yield Mistake(Finding("set-factor", name, said), [("frequency", k, over(factor))])


def other_numbers(old: Explanation) -> Iterator[Mistake]:
    """Yield numbers for the modes of each set most like the others'; of unlike ones, their own."""
    state, sets, modes = old.state, old.data.sets, old.data.modes
    of_sets = ("frequency", "damping", "shape", "std")
    for k, name in enumerate(sets if len(sets) > 1 else ()):
        rest = replace(state, **{x: np.delete(getattr(state, x), k, axis=0) for x in of_sets})
        mac = evidence.mac_values(state.psi[k], state.seen[k], rest.mean.T)
        distance = np.minimum(4 * np.abs(np.log(state.frequency[k])[:, None] - rest.logs), 1.0)
        cost = np.nan_to_num(1 - mac) + np.nan_to_num(distance)
        known = np.isfinite(mac) | np.isfinite(distance)
        index = assigned(np.where(known, cost, 1.0 - np.eye(len(cost))))
        rows = np.flatnonzero(index != np.arange(index.size))
        if rows.size:
            own, of = (enumeration([str(modes[i]) for i in r], MANY) for r in (rows, index[rows]))
            numbers = {"set": name, "other": without(k, sets), "modes": own, "of": of}
            order = partial(np.take, indices=np.argsort(index), axis=0)
            edits = [(x, k, order) for x in of_sets]
            yield Mistake(Finding("set-numbers", name, numbers), edits, moves=True)


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
            others, subject = [j for j in known if j != k], str(mode)
            if len(others) > 1:
                subject += f", {sets[k]}"
                who = f"set {sets[k]} disagrees with {enumeration([sets[j] for j in others], 3)}"
                look = f"look at set {sets[k]} again, or leave out its"
                value, other = f[k], np.exp(median(np.log(f[others, None]))[0])
            else:
                who = f"sets {sets[known[1]]} and {sets[known[0]]} disagree"
                look = "look at both again, or leave out the worse"
                other, value = f[known]
            numbers: dict[str, Any] = {"f": float(value), "other": float(other)}
            numbers["percent"] = float(100 * (value / other - 1))
            said = found(f"odd-{part}", subject, mode=mode, who=who, look=look, **numbers)
            yield Mistake(said, [(part, np.s_[k, r], np.nan)], cost=count[k] * np.log(wrong))


# Modes of the model.


def foreign_mode(old: Explanation) -> Iterator[Mistake]:
    """Yield modes that the model does not have, or has not so high.

    Data sets differ as before, and all else of such a mode is new.
    """
    modes, of_model = old.data.modes, old.modes.frequency
    for r, f in enumerate(np.exp(old.state.logs).tolist()):
        numbers = {"mode": modes[r], "at": "" if np.isnan(f) else f" at {f:.4g} Hz", "measured": f}
        numbers |= {"modes": of_model.size, "highest": float(of_model.max())}
        said = found(FOREIGN[int(f > of_model.max())], str(modes[r]), **numbers)
        edits = [("frequency", np.s_[:, r], np.nan), ("shape", np.s_[:, r], np.nan)]
        yield Mistake(said, edits, cost=partial(_as_before, r=r))


def _as_before(given: State, new: State, r: int) -> float:
    return float(given.noise - new.noise + NOTHING * (1 + given.known[r].sum()))


def later_mode(old: Explanation) -> Iterator[Mistake]:
    """Yield measured modes that are like model modes beyond those among which pairs are sought."""
    state, own, f = old.state, old.point, old.modes.frequency
    free = old.fits.at(stacked([replace(state, candidates=np.array(f.size))]), own.x[None]).of(0)
    for r in np.flatnonzero(free.pairs >= state.candidates).tolist():
        later, modes = int(free.pairs[r]) + 1, old.data.modes
        numbers = {"later": later, "f": float(old.fits.comparison.frequency[later - 1])}
        numbers |= {"mac": free.mac[r], "best": own.mac[r], "spare": later - len(modes)}
        said = Finding("beyond-candidates", str(modes[r]), numbers)
        price = float(np.log(f.size - state.candidates))
        yield Mistake(said, [("candidates", ..., later)], price)


MEMBERS = 2  # members that are tried: those of which the cost is less ahead of a step

THOUSANDS = (3, -3, 6, -6, 9, -9)  # powers of ten by which units differ


def wrong_member(old: Explanation) -> Iterator[Mistake]:
    """Yield the members that promise most, several times as stiff or heavy as in the model.

    Factors up to 2, or their inverse, are no mistake: many members differ so.
    """
    parts = old.fits.parts
    single = np.flatnonzero([not x.whole for x in parts])
    if old.state.part or not single.size:
        return
    ahead, dx = old.fits.by_parts(old.state, old.point.x)
    first = single[np.argsort(ahead[single], kind="stable")[:MEMBERS]]
    price = float(np.log(single.size / first.size))
    for k in first.tolist():
        several = ("greater", 4.0) if dx[k] > 0 else ("smaller", 0.25)
        for kind, (size, factor) in (("wrong-member", several), (IMPRECISE, ("", 1.0))):
            said = found(kind, "model", what=parts[k].of, place=parts[k].place, better=size)
            yield Mistake(said, [("start", -1, factor), ("part", ..., k + 1)], price)


def wrong_unit(old: Explanation) -> Iterator[Mistake]:
    """Yield powers of ten on the stiffness or mass of groups that no parameter scales."""
    parts = enumerate(old.fits.parts if not old.state.part else ())
    for (k, part), power in product([x for x in parts if x[1].whole], THOUSANDS):
        numbers = {"what": part.of, "place": part.place, "factor": 10.0**-power}
        said = Finding("wrong-unit", f"{part.of} {part.place}", numbers)
        yield Mistake(said, [("start", -1, 10.0**power), ("part", ..., k + 1)])


# Shapes and columns of sensors.


def exchanged_shapes(old: Explanation) -> Iterator[Mistake]:
    """Yield each two modes, as if in all data sets each had the shape of the other."""
    known = np.isfinite(old.state.logs) & old.state.known.any(axis=1)
    for pair in combinations(np.flatnonzero(known).tolist(), 2):
        names = [str(old.data.modes[r]) for r in pair]
        said = found("exchanged-shapes", ", ".join(names), modes=enumeration(names))
        edits = [("shape", np.s_[:, pair], partial(np.flip, axis=1))]
        yield Mistake(said, edits, moves=True)


def parts_of_data(sets: tuple[str, ...]) -> list[tuple[list[int], str]]:
    """Return data sets in which a sensor may be wrong, with their names.

    In all, in one, or in two of three: of more sets, most are right.
    """
    every = range(len(sets))
    sizes = (1, 2) if len(sets) == 3 else (1,) * (len(sets) > 1)
    some = [list(x) for n in sizes for x in combinations(every, n)]
    names = [f"set{'s' * (len(x) > 1)} {enumeration([sets[k] for k in x])}" for x in some]
    return [(list(every), "all data"), *zip(some, names, strict=True)]


FACTORS = (10.0, 0.1, 100.0, 0.01, 1e3, 1e-3, 9.81, 1 / 9.81, 2.0, 0.5)
"""Factors on the values of a sensor by another unit or sensitivity."""


def wrong_factor(old: Explanation) -> Iterator[Mistake]:
    """Yield sensors that are reversed, or in other units."""
    where, names = parts_of_data(old.data.sets), old.data.sensors
    moving = [s for s in old.measured if np.nan_to_num(old.state.shape[..., s]).any()]
    for (sets, name), s, factor in product(where, moving, (-1.0, *FACTORS)):
        kind = "reversed-sensor" if factor < 0 else "sensor-factor"
        said = found(kind, f"{names[s]}, {name}", sensor=names[s], where=name, factor=factor)
        edits = [("shape", np.s_[sets, :, s], over(factor))]
        yield Mistake(said, edits, cost=partial(_density, sets=sets, s=s, factor=factor))


def _density(given: State, _: State, sets: list[int], s: int, factor: float) -> float:
    """Return the cost of the values of a sensor as they are given, and not over a factor.

    A density of values is one over their unit, which changes with the factor and the mean square.
    """
    values, count = given.psi[sets, :, s], given.seen[sets].sum(axis=2)
    of_size = count * np.log1p(values**2 / np.maximum(count, 1) * (factor**-2 - 1)) / 2
    return float(of_size.sum() + given.seen[sets, :, s].sum() * np.log(abs(factor)))


def _arranged(shape: Floats, order: Ints) -> Floats:
    """Return shapes with their components in another order, and nothing where that is -1."""
    return np.where(order < 0, np.nan, shape[..., order])


def exchanged_sensors(old: Explanation) -> Iterator[Mistake]:
    """Yield pairs of sensors, in all data sets or some."""
    where, names = parts_of_data(old.data.sets), old.data.sensors
    for pair, (sets, name) in product(combinations(old.measured, 2), where):
        both, order = [names[s] for s in pair], np.arange(len(names))
        order[[*pair]] = pair[::-1]
        subject = ", ".join([*both, name])
        said = found("exchanged-sensors", subject, sensors=enumeration(both), where=name)
        yield Mistake(said, [("shape", sets, partial(_arranged, order=order))], moves=True)


def opposite_order(old: Explanation) -> Iterator[Mistake]:
    """Yield the opposite order of all sensors."""
    order = np.arange(len(old.data.sensors))
    order[old.measured] = old.measured[::-1]
    edits = [("shape", ..., partial(_arranged, order=order))]
    yield Mistake(found("opposite-order", "sensors"), edits, moves=True)


def shifted_values(old: Explanation) -> Iterator[Mistake]:
    """Yield rows of shapes, or all, in which a value is lost or too many, and the rest moved."""
    names, (K, _, n) = old.data, old.state.shape.shape
    where: dict[str, tuple[slice, slice]] = {"all data": np.s_[:, :]}
    for k, name in enumerate(names.sets):
        where |= {f"set {name}": np.s_[k : k + 1, :]} if K > 1 else {}
        for r, mode in enumerate(names.modes):
            where[f"mode {mode}" + f" of set {name}" * (K > 1)] = np.s_[k : k + 1, r : r + 1]
    every = np.arange(n)
    for (name, rows), start in product(where.items(), range(n - 1)):
        lost, too_many = np.insert(every[:-1], start, -1), np.append(np.delete(every, start), -1)
        for what, order in (("lost", lost), ("too many", too_many)):
            said = found("shifted-values", name, where=name, sensor=names.sensors[start], what=what)
            yield Mistake(said, [("shape", rows, partial(_arranged, order=order))], moves=True)


def unsigned_shapes(old: Explanation) -> Iterator[Mistake]:
    """Yield signs for shapes of which none has any but for one value, as if they were magnitudes.

    The signs are those of the model that fits the frequencies alone.
    """
    state, fits = old.state, old.fits
    signs = np.sign(np.nan_to_num(fits.plain.shape))
    if np.minimum((signs > 0).sum(axis=2), (signs < 0).sum(axis=2)).sum() > 1:
        return
    unknown = replace(state, shape=np.full(state.shape.shape, np.nan))
    (end,) = fits.fitted([unknown])
    if modes := fits.of(state, end.x):
        phi = fits.rows(state) @ modes.phi
        mac = evidence.mac_values(np.abs(state.mean), state.known, np.abs(phi))
        cost = evidence.pair_costs(mac, state.logs, evidence.log_frequencies(modes.frequency))
        signs = np.sign(phi[:, assigned(cost[:, : state.candidates])].T)
        edits = [("shape", ..., partial(np.multiply, signs))]
        yield Mistake(found("unsigned-shapes", "shapes"), edits)


def reversed_value(old: Explanation) -> Iterator[Mistake]:
    """Yield single components, of shapes that one data set alone has, with the other sign.

    Of magnitudes, only one that has a sign which no more of its shape have than another one.
    """
    state, names = old.state, old.data
    once = state.seen & (state.seen.any(axis=2).sum(axis=0) == 1)[:, None]
    if any(each.finding.kind == "unsigned-shapes" for each in old.mistakes):
        signs = np.sign(np.nan_to_num(old.fits.plain.shape))
        once &= (signs != 0) & (signs * signs.sum(axis=2, keepdims=True) <= 0)
    for k, r, s in np.argwhere(once).tolist():
        mode, sensor = names.modes[r], names.sensors[s]
        said = found("reversed-value", f"{mode}, {sensor}", mode=mode, sensor=sensor)
        yield Mistake(said, [("shape", np.s_[k, r, s], np.negative)])


def odd_sensor(old: Explanation) -> Iterator[Mistake]:
    """Yield sensors without signal, where the model has nothing either, or with noise alone."""
    zero, noise = "near zero in all modes", "noise: they fit no place, sign or unit"
    for s, name in ((s, old.data.sensors[s]) for s in old.measured):
        for what, edit in ((zero, ("nodes", s, -1)), (noise, ("shape", np.s_[..., s], np.nan))):
            yield Mistake(found("odd-sensor", name, sensor=name, what=what), [edit])


def copied_sensor(old: Explanation) -> Iterator[Mistake]:
    """Yield sensors that have the values of another one, digit by digit, whatever their signs.

    A copy says nothing on its own: its values cost as much as those that fit as well as is usual.
    """
    shape, names = np.abs(old.state.shape), old.data.sensors
    for s, t in permutations(old.measured, 2):
        same = np.array_equal(shape[:, :, s], shape[:, :, t], equal_nan=True)
        if not same or not np.nan_to_num(shape[..., s]).any():
            continue
        sets = old.state.seen[:, :, s].sum(axis=0)
        of_model, of_noise = (sets > 0).sum(), np.maximum(sets - 1, 0).sum()
        usual = np.log(evidence.SHAPE) * of_model + np.log(measured.SHAPE) * of_noise
        subject = ", ".join(sorted((names[s], names[t])))
        said = found("copied-sensor", subject, sensor=names[s], other=names[t])
        yield Mistake(said, [("shape", np.s_[..., s], np.nan)], cost=usual)


# Places and directions of sensors.

PLACES = 4  # places of each sensor that are tried: those where the model moves most as measured

OFTEN_SHARED = 2.0  # logarithm of how much likelier a wrong place is that another sensor is at


def wrong_place(old: Explanation) -> Iterator[Mistake]:
    """Yield sensors at other nodes, directions kept; in a chain, at other degrees of freedom."""
    state, fits, names = old.state, old.fits, old.data.sensors
    given, along, rows = state.nodes, state.along, fits.rows(state)
    can = np.asarray(fits.moves.any(axis=2))  # nodes x axes
    there = {s: np.flatnonzero(can[:, along[s] != 0].any(axis=1)) for s in old.measured}
    phi = old.modes.phi[:, old.point.pairs] * old.point.beta
    shapes = (fits.moves @ phi).transpose(2, 0, 1)
    x = np.where(state.known, state.mean, np.nan)
    for s, nodes in ((s, nodes[nodes != given[s]]) for s, nodes in there.items()):
        r = (shapes[:, nodes] @ along[s] - x[:, [s]]) / (old.point.sigma * state.motion[s])
        cost = loss(np.nan_to_num(r), evidence.OF_MODEL).sum(axis=0)
        apart, size = np.abs(rows - rows[s]).max(axis=1), np.abs(rows[s]).max()
        others = [names[t] for t in np.flatnonzero(apart <= ACCUMULATED * size) if t != s]
        too = f", where the model has {enumeration(others, MANY)} too" if others else ""
        price = np.log(max(len(nodes) / PLACES, 1)) - OFTEN_SHARED * bool(others)
        for k in nodes[np.argsort(cost, kind="stable")[:PLACES]].tolist():
            place, own = (_place(fits.geometry, x) for x in (k, given[s]))
            said = found("wrong-place", names[s], sensor=names[s], place=place, too=too, given=own)
            yield Mistake(said, [("nodes", s, k)], float(price))


def _place(geometry: Geometry, k: int) -> str:
    if len(geometry.axes) == 1:  # a chain, above the ground
        return f"degree of freedom {k - 1}"
    if geometry.numbers is not None:
        return f"node {geometry.numbers[k]}"
    return f"({', '.join(f'{x:.4g}' for x in geometry.nodes[k])})"


def wrong_direction(old: Explanation) -> Iterator[Mistake]:
    """Yield other directions: of single sensors, of all along an axis, of two axes exchanged."""
    given, axes, names = old.state.along, old.fits.geometry.axes, old.data.sensors
    along, turned = np.where(abs(given).max(axis=1) > ALONG, abs(given).argmax(axis=1), -1), []
    for (a, b), sign in product(permutations(axes, 2), (1.0, -1.0)):
        some, turn = np.flatnonzero(along == a).tolist(), np.zeros((3, 3))
        turn[a, b] = sign
        turned += [([s], turn) for s in some] + [(some, turn)] * (len(some) > 1)
    for a, b in combinations(axes, 2):
        both, swap = np.flatnonzero((along == a) | (along == b)).tolist(), np.eye(3)
        swap[[a, b]] = swap[[b, a]]
        turned += [(both, swap)] * bool(0 < (along == a).sum() < len(both))
    for some, turn in turned:
        each = given[some], given[some] @ turn
        before, after = (list(dict.fromkeys(map(axis_name, x))) for x in each)
        numbers: dict[str, Any] = {"sensors": enumeration([names[s] for s in some], MANY)}
        numbers |= {"s": "s" * (len(some) == 1), "turn": " in turn" * (len(after) > 1)}
        numbers |= {"given": enumeration(before), "better": enumeration(after)}
        said = found("wrong-direction", ", ".join(names[s] for s in some), **numbers)
        yield Mistake(said, [("along", some, each[1])])


def counted_from_one(old: Explanation) -> Iterator[Mistake]:
    """Yield all sensors at the node, or the degree of freedom, before their own."""
    what = "degrees of freedom" if len(old.fits.geometry.axes) == 1 else "nodes"
    edits = [("nodes", ..., lambda nodes: np.maximum(nodes - 1, -1))]
    before = Mistake(found("counted-from-one", what, what=what), edits)
    if old.state.nodes.all() and old.fits.rows(before.undone(old.state)).any(axis=1).all():
        yield before


MISTAKES: Sequence[Callable[[Explanation], Iterator[Mistake]]] = (
    frequency_factor,
    other_quantity,
    set_factor,
    other_numbers,
    exchanged_shapes,
    wrong_factor,
    exchanged_sensors,
    opposite_order,
    unsigned_shapes,
    copied_sensor,
    shifted_values,
    counted_from_one,
    wrong_direction,
    wrong_place,
    reversed_value,
    odd_sensor,
    wrong_nominal_value,
    odd_value,
    wrong_frequency,
    damping_in_percent,
    foreign_mode,
    later_mode,
    wrong_unit,
    wrong_member,
)
"""What is looked for; where two explain the data equally well, the first one is tried first."""

USUAL, OFTEN = 0.02, 0.05
PROBABILITY = defaultdict(
    lambda: USUAL,
    {"frequency-factor": OFTEN, "reversed-sensor": OFTEN, "wrong-direction": OFTEN}
    | {"odd-frequency": OFTEN, "odd-shape": OFTEN, "far-from-model": OFTEN, "damping": OFTEN}
    | {"other-quantity": 0.005, "copied-sensor": 0.5, IMPRECISE: OFTEN},
)
"""Probability with which a study has a mistake of a kind; with the same digits twice, a copy."""
