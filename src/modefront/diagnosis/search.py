"""The search over mistakes: best first, alone and together, and what of it is certain."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain, combinations, pairwise
from operator import attrgetter

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.comparison import Comparison, of_few_sets
from modefront.diagnosis.evidence import ENOUGH, Fits, point, unlikeness
from modefront.diagnosis.mistakes import sensors, values
from modefront.diagnosis.mistakes.record import Explanation, Mistake
from modefront.diagnosis.state import State
from modefront.findings.record import Finding
from modefront.pairing.match import match

CLEAR = float(np.log(100.0))
"""Difference of costs from which on one explanation is clearly better: odds of 100 to 1."""

PROMISING, FITTED, VARIANTS = 100, 10, 3
"""Mistakes of each kind of which costs are looked at, claims by which an explanation is extended,
and mistakes of a claim that are fitted."""

BEAM, MOST = 6, 6
"""Single claims to which others are added, before they are to the best explanation, and most
mistakes."""

EITHER = 3  # explanations that the data cannot tell apart and that are named nevertheless, at most
WINDOW = 1.5  # window of frequencies that is advised
LEFT = 1.0  # difference of costs that fits leave

MIXED = LEFT
"""Price of an explanation in which mistakes are said of values that are moved later: where both
orders fit alike, the one that moves them first is said first."""

SEEN = 0.02  # increase of a MAC value that is worth its name

MISTAKES: Sequence[Callable[[Explanation], Iterator[Mistake]]] = (
    values.frequency_factor,
    values.other_quantity,
    values.set_factor,
    values.other_numbers,
    values.exchanged_shapes,
    sensors.wrong_factor,
    sensors.exchanged_sensors,
    sensors.opposite_order,
    sensors.unsigned_shapes,
    sensors.copied_sensor,
    sensors.shifted_values,
    sensors.counted_from_one,
    sensors.wrong_direction,
    sensors.wrong_place,
    sensors.reversed_value,
    sensors.odd_sensor,
    values.wrong_nominal_value,
    values.odd_value,
    values.wrong_frequency,
    values.damping_in_percent,
    values.foreign_mode,
    values.later_mode,
)
"""What is looked for; where two explain the data equally well, the first one is tried first."""

USUAL, OFTEN = 0.02, 0.05
PROBABILITY = defaultdict(
    lambda: USUAL,
    {"frequency-factor": OFTEN, "reversed-sensor": OFTEN, "wrong-direction": OFTEN}
    | {"odd-frequency": OFTEN, "odd-shape": OFTEN, "far-from-model": OFTEN, "damping": OFTEN}
    | {"other-quantity": 0.005, "copied-sensor": 0.5},
)
"""Probability with which a study has a mistake of a kind; with the same digits twice, a copy."""

FOREIGN = ("foreign-mode", "outside-model")  # kinds that leave out all of a mode

COST = attrgetter("cost")


def mixed(mistakes: Sequence[Mistake]) -> float:
    """Return the price of moving values to their sensors after others were said of these."""
    return MIXED * any(b.moves > a.moves for a, b in pairwise(mistakes))


def key_of(mistakes: Sequence[Mistake]) -> object:
    """Return what tells an explanation from others; of two orders, one is known."""
    return frozenset(each.key for each in mistakes)


def undone(state: State, mistakes: Iterable[Mistake]) -> State:
    """Return the state without some mistakes."""
    for each in mistakes:
        state = each.change(state)
    return state


class Search:
    """Explanations of a comparison that were fitted, each with its best fit, as ``known``."""

    def __init__(self, comparison: Comparison) -> None:
        self.fits = Fits(comparison)
        self.known: dict[object, Explanation] = {}

    def fit(self, several: Sequence[tuple[Mistake, ...]], near: Explanation | None = None) -> None:
        """Fit explanations by some mistakes each, from the best of nominal and near parameters."""
        states = [undone(self.fits.plain, mistakes) for mistakes in several]
        xs = [[np.zeros(len(self.fits.plain.start))] * len(states)]
        if near:
            xs += [[near.point.x] * len(states), self._same(states, near)]
        best = np.argmin([self.fits.ahead(states, x) for x in xs], axis=0)
        ends = self.fits.fitted(states, [xs[i][k] for k, i in enumerate(best)])
        for mistakes, state, at in zip(several, states, ends, strict=True):
            if at is not None:
                cost = float(at.cost) + sum(x.price for x in mistakes) + mixed(mistakes)
                key, new = key_of(mistakes), Explanation(self.fits, mistakes, state, at, cost)
                self.known[key] = min(self.known.get(key, new), new, key=COST)

    def _same(self, states: Iterable[State], near: Explanation) -> list[Floats]:
        """Return x of the same parameters in other states, within the bounds."""
        theta = near.state.theta(near.point.x)
        return [np.clip(state.x(theta), *self.fits.ends) for state in states]

    def extend(self, old: Explanation) -> None:
        """Fit the most promising explanations with a mistake more."""
        kinds = defaultdict(list)
        for one in chain.from_iterable(find(old) for find in MISTAKES):
            kinds[one.kind].append(one)
        some = []
        for kind, every in kinds.items():
            price = float(np.log(len(every) / PROBABILITY[kind]))
            new = [replace(x, price=x.price + price) for x in every if x.claim not in old.claims]
            some += self._alike(new, old)
        tried = [((*old.mistakes, one), one) for one in some]
        states = [one.change(old.state) for one in some]
        if any(each.moves for each in old.mistakes):  # it may be said of the values as given
            tried += [((one, *old.mistakes), one) for one in some]
            states += [undone(self.fits.plain, mistakes) for mistakes, _ in tried[len(some) :]]
        # Parameters have made up for mistakes: what one costs where these are says little.
        xs = ([x] * len(states) for x in (old.point.x, 0 * old.point.x))
        costs = np.min([self.fits.ahead(states, x) for x in xs], axis=0)
        costs += [one.price + mixed(mistakes) for mistakes, one in tried]
        claims: dict[tuple[str, ...], dict[object, tuple[Mistake, ...]]] = {}
        for mistakes, one in (tried[k] for k in np.argsort(costs, kind="stable")):
            claims.setdefault(one.claim, {}).setdefault(key_of(mistakes), mistakes)
        best = list(claims.values())[:FITTED]
        self.fit([x for each in best for x in list(each.values())[:VARIANTS]], old)

    def _alike(self, some: list[Mistake], old: Explanation) -> list[Mistake]:
        """Return mistakes; of many, those without which modes are most like those of the model."""
        together = self.fits.together
        if len(some) <= PROMISING:
            return some
        unlike = [
            unlikeness([x.change(old.state) for x in some[k : k + together]], old.modes)
            for k in range(0, len(some), together)
        ]
        costs = np.concatenate(unlike)
        return [some[k] for k in np.flatnonzero(costs <= np.sort(costs)[PROMISING - 1])]

    def best(self) -> Explanation | None:
        """Return the best explanation; the best ones are extended, the first one first."""
        self.fit([()])
        if not self.known:
            return None
        (plain,), extended = self.known.values(), set[object]()
        while True:
            best = min(self.known.values(), key=COST)
            fewer = list(combinations(best.mistakes, max(len(best.mistakes) - 1, 0)))
            self.fit([some for some in fewer if key_of(some) not in self.known], best)
            # What one explains may be hidden by another one, so that it is not worth its price.
            gaining = [x for x in self.known.values() if x.point.cost < plain.point.cost - LEFT]
            alone = sorted((x for x in gaining if len(x.mistakes) == 1), key=COST)
            most = list(dict.fromkeys(x.claims for x in alone))[:BEAM]
            level = [*(x.mistakes for x in alone if x.claims in most), best.mistakes, *fewer]
            keys = [key_of(some) for some in level if len(some) < MOST]
            new = [key for key in keys if key in self.known and key not in extended]
            if new:
                extended.add(new[0])
                self.extend(self.known[new[0]])
                continue
            # A rival may only have been fitted from where its way is barred.
            rivals = list(self.known.values())
            states = [each.state for each in rivals]
            costs = self.fits.ahead(states, self._same(states, best))
            nearer = costs < np.array([x.point.cost for x in rivals]) - ENOUGH
            self.fit([rivals[k].mistakes for k in np.flatnonzero(nearer)], best)
            if min(map(COST, self.known.values())) > best.cost - ENOUGH:
                return best

    def named(self, best: Explanation) -> dict[Mistake, Finding]:
        """Return the mistakes of the best explanation without which no other one comes near it.

        Another one is no rival that has more mistakes and fits no better: all sensors but one
        reversed are the same as that one, as a mode shape has no sign.
        """
        out, count, most = dict[Mistake, Finding](), len(best.mistakes), best.point.cost - LEFT
        known = sorted(self.known.values(), key=COST)
        rivals = [x for x in known if len(x.mistakes) <= count or x.point.cost <= most]
        near = [x for x in rivals if x.cost - best.cost < CLEAR and len(x.mistakes) == count]
        for one in best.mistakes:
            rest = best.claims - {one.claim}
            # What may be instead, and of it, and of the mistake itself, what is better.
            firsts, swaps = dict[tuple[str, ...], Mistake](), dict[object, Mistake]()
            for x in (x for each in near if each.claims >= rest for x in each.mistakes):
                if x.claim not in rest:
                    firsts.setdefault(x.claim, x)
                    swaps.setdefault(x.key, x)
            costs = [x.cost for x in rivals if not x.claims & firsts.keys()]
            gain = min(costs, default=np.inf) - best.cost
            if len(firsts) <= EITHER and gain >= CLEAR:
                said = list(dict.fromkeys((*firsts.values(), *swaps.values())))[:EITHER]
                others = tuple(x.finding for x in said if x is not one)
                # The MAC value that changes most shows it, where one does.
                without = next(x for x in known if x.claims in (rest, frozenset()))
                before, after = without.point.mac, best.point.mac
                r = int(np.argmax(np.nan_to_num(after - before)))
                text = (
                    f" (without, MAC {best.data.modes[r]} is {after[r]:.2f} after a fit, and not "
                )
                evidence = f"{text}{before[r]:.2f})" * bool(after[r] - before[r] >= SEEN)
                out[one] = replace(one.finding, others=others, evidence=evidence, gain=float(gain))
        return out


def diagnose(comparison: Comparison) -> list[Finding]:
    """Return the mistakes of a model or its data; of many data sets, some are looked at."""
    search = Search(of_few_sets(comparison))
    best = search.best()
    if best is None:
        return []
    named = search.named(best)
    return [*named.values(), *distant_pairs(search, named)]


def distant_pairs(search: Search, named: Iterable[Mistake]) -> Iterator[Finding]:
    """Yield the pairs without some mistakes that a window mends, if they are clearly better."""
    rule, data, fits = (
        search.fits.comparison.problem.pairing,
        search.fits.comparison.data,
        search.fits,
    )
    state = undone(fits.plain, [one for one in named if one.kind not in FOREIGN])
    modes = fits.modes(state.start.tobytes())
    if rule.method == "order" or modes is None:
        return
    foreign = {one.subject[0] for one in named if one.kind in FOREIGN}
    # The covariance is of other shapes.
    data = replace(data, frequency=state.frequency, shape=state.shape, shape_covariance=None)
    low, rules = int(state.candidates), (rule, replace(rule, window=WINDOW))
    f, phi = modes.frequency[:low], (state.rows @ modes.phi)[:, :low]
    pairs, mended = (match(each, data, f, phi) for each in rules)
    cost, least = (point(state, 0 * state.start, modes, x.index).cost for x in (pairs, mended))
    changed = (pairs.index != mended.index) & (cost > least + CLEAR)
    for r in np.flatnonzero(changed).tolist():
        q, near, value = int(pairs.index[r]), int(mended.index[r]), pairs.mac[r]
        if str(data.modes[r]) not in foreign:
            alike = "" if np.isnan(value) else f" (MAC {value:.2f})"
            numbers = {"measured": float(np.exp(state.logs[r])), "alike": alike, "model": q + 1}
            numbers |= {"f": float(f[q]), "near": near + 1, "there": float(f[near])}
            yield Finding("distant-pair", str(data.modes[r]), numbers)
