"""The search over mistakes: best first, alone and together, and what of it is certain."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import reduce
from itertools import chain, combinations, pairwise
from operator import attrgetter

import numpy as np

from modefront.diagnosis.comparison import Comparison, of_few_sets
from modefront.diagnosis.evidence import ENOUGH, Fits, alike
from modefront.diagnosis.mistakes import FOREIGN, MISTAKES, PROBABILITY, Explanation, Mistake
from modefront.diagnosis.state import State, stacked
from modefront.findings.knowledge import enumeration
from modefront.findings.record import Finding, found
from modefront.pairing.match import POOR, match

CLEAR = float(np.log(100.0))  # difference of costs that is clear: odds of 100 to 1
# Mistakes of each kind of which costs are looked at; each unit needs modes of its own.
PROMISING = defaultdict(lambda: 100, {"wrong-unit": 2})
FITTED = 30  # mistakes of all kinds that are fitted

BEAM, MOST = 3, 6  # single claims to which others are added at first, and mistakes, at most
EITHER = 3  # explanations that the data cannot tell apart and that are named nevertheless, at most
WINDOW = 1.5  # window of frequencies that is advised
LEFT = 1.0  # difference of costs that fits leave
NEAR = 2 * CLEAR  # difference of costs up to which explanations of several mistakes are fitted
SEEN = 0.02  # increase of a MAC value that is worth its name

COST = attrgetter("cost")


def mixed(mistakes: Sequence[Mistake]) -> float:
    """Return the price of moving values after mistakes were said of them: they are moved first."""
    return LEFT * any(b.moves > a.moves for a, b in pairwise(mistakes))


def key_of(mistakes: Sequence[Mistake]) -> object:
    """Return what tells an explanation from others; of two orders, one is known."""
    return frozenset(each.key for each in mistakes)


def undone(state: State, mistakes: Iterable[Mistake]) -> State:
    """Return the state without some mistakes."""
    return reduce(lambda given, each: each.undone(given), mistakes, state)


class Search:
    """Explanations of a comparison that were fitted, each with its best fit, as ``known``."""

    def __init__(self, comparison: Comparison) -> None:
        self.fits = Fits(comparison)
        self.known: dict[object, Explanation] = {}

    def fit(self, several: Sequence[tuple[Mistake, ...]], near: Explanation | None = None) -> None:
        """Fit explanations by some mistakes each, from the best of nominal and near parameters."""
        states = [undone(self.fits.plain, mistakes) for mistakes in several]
        ends = self.fits.fitted(states, (near.state, near.point.x) if near else None)
        for mistakes, state, at in zip(several, states, ends, strict=True):
            if np.isfinite(at.cost):
                cost = float(at.cost) + sum(x.price for x in mistakes) + mixed(mistakes)
                key, new = key_of(mistakes), Explanation(self.fits, mistakes, state, at, cost)
                self.known[key] = min(self.known.get(key, new), new, key=COST)

    def extend(self, old: Explanation) -> None:
        """Fit the most promising explanations with a mistake more."""
        kinds = defaultdict(list)
        for one in chain.from_iterable(find(old) for find in MISTAKES):
            kinds[one.finding.kind].append(one)
        some = list[Mistake]()
        for kind, every in kinds.items():
            price = float(np.log(len(every) / PROBABILITY[kind]))
            new, most = [x for x in every if x.claim not in old.claims], PROMISING[kind]
            if len(new) > most:  # those without which modes are most like the model's
                given = (one.undone(old.state) for one in new)
                far = self.fits.unlike(given, old.point.x, old.state.start)
                new = [new[k] for k in np.flatnonzero(far <= np.sort(far)[most - 1])]
            some += [replace(x, price=x.price + price) for x in new]
        if not some:
            return
        tried = [((*old.mistakes, one), one) for one in some]
        states = [one.undone(old.state) for one in some]
        for one, state in list(zip(some, states, strict=True)) if old.mistakes else ():
            if any(x.moves for x in (*old.mistakes, one)):  # others may be said of values as given
                first = undone(self.fits.plain, (one, *old.mistakes))
                if not np.array_equal(first.shape, state.shape, equal_nan=True):
                    tried.append(((one, *old.mistakes), one))
                    states.append(first)
        # Parameters have made up for mistakes: what one costs where these are says little.
        costs = self.fits.ahead(states, (old.state, old.point.x))
        costs += [one.price + mixed(mistakes) for mistakes, one in tried]
        near = min(map(COST, self.known.values())) + NEAR if old.mistakes else np.inf
        first = np.argsort(costs, kind="stable")[:FITTED].tolist()
        self.fit([tried[k][0] for k in first if costs[k] < near], old)

    def best(self) -> Explanation | None:
        """Return the best explanation; the best ones are extended, the first one first."""
        if self.fits.nominal is None:
            return None
        self.fit([()])
        (plain,), extended = self.known.values(), set[object]()
        while True:
            best = min(self.known.values(), key=COST)
            alone = sorted((x for x in self.known.values() if len(x.mistakes) == 1), key=COST)
            fewer = list(combinations(best.mistakes, max(len(best.mistakes) - 1, 0)))
            swaps = [x.mistakes[0] for x in alone if x.claims <= best.claims]
            swapped = [[y if x.claim == y.claim else x for x in best.mistakes] for y in swaps]
            tried = (*fewer, *map(tuple, swapped))
            self.fit([some for some in tried if key_of(some) not in self.known], best)
            # What one explains may be hidden by another one, so that it is not worth its price. A
            # fitted factor on a part gains by chance.
            least = plain.point.cost - LEFT
            gaining = [x for x in alone if x.point.cost < least and not x.state.part]
            firsts = sorted({x.claims: x for x in reversed(gaining)}.values(), key=COST)[:BEAM]
            same = [x for x in self.known.values() if x.claims == best.claims]
            near = [x for x in sorted(same, key=COST, reverse=True) if x.cost < best.cost + CLEAR]
            unlike = list({x.cost // ENOUGH: x for x in near}.values())[: -BEAM - 1 : -1]
            level = [(), *(x.mistakes for x in (*firsts, *unlike)), *fewer]
            keys = [key_of(some) for some in level if len(some) < MOST]
            fitted = (self.known[key] for key in keys if key in self.known and key not in extended)
            if new := next((x for x in fitted if x.claims == x.blamed), None):
                extended.add(key_of(new.mistakes))
                self.extend(new)
                continue
            # A rival may only have been fitted from where its way is barred.
            rivals = list(self.known.values())
            costs = self.fits.ahead([x.state for x in rivals], (best.state, best.point.x))
            nearer = costs < np.array([x.point.cost for x in rivals]) - ENOUGH
            self.fit([rivals[k].mistakes for k in np.flatnonzero(nearer)], best)
            if min(map(COST, self.known.values())) > best.cost - ENOUGH:
                return best

    def named(self, best: Explanation) -> dict[Mistake, Finding]:
        """Return the mistakes of the best explanation without which no other one comes near it.

        One with more mistakes that fits no better is no rival: all sensors but one reversed are the
        same as that one, as a mode shape has no sign.
        """
        out, count, most = dict[Mistake, Finding](), len(best.blamed), best.point.cost - LEFT
        known = sorted(self.known.values(), key=COST)
        rivals = [x for x in known if len(x.blamed) <= count or x.point.cost <= most]
        near = [x for x in rivals if x.cost - best.cost < CLEAR and len(x.blamed) == count]
        for one in (x for x in best.mistakes if x.claim in best.blamed):
            rest = best.blamed - {one.claim}
            # What may be instead, and of it, and of the mistake itself, what is better.
            firsts, swaps = dict[tuple[str, str], Mistake](), dict[object, Mistake]()
            for each in (x for x in near if x.blamed >= rest):
                for x in (x for x in each.mistakes if x.claim in each.blamed - rest):
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
                text = f" (without, MAC {best.data.modes[r]} is {after[r]:.2f} after a fit,"
                evidence = f"{text} and not {before[r]:.2f})" * bool(after[r] - before[r] >= SEEN)
                out[one] = replace(one.finding, others=others, evidence=evidence, gain=float(gain))
        return out


def diagnose(comparison: Comparison) -> list[Finding]:
    """Return the mistakes of a model or its data; of many data sets, some are looked at."""
    search = Search(of_few_sets(comparison))
    best = search.best()
    if best is None:
        return []
    named = search.named(best)
    return [*named.values(), *distant_pairs(search, named), *poor_pairs(search, best, named)]


def poor_pairs(search: Search, best: Explanation, named: Iterable[Mistake]) -> Iterator[Finding]:
    """Yield the modes, if any, that no model mode is like after a fit without some mistakes."""
    mistakes, names = tuple(named), search.fits.comparison.data.modes
    search.fit([mistakes], best)
    mac = search.known.get(key_of(mistakes), best).point.mac
    said = {x for one in mistakes for x in one.finding.subject.split(", ")}
    poor = [str(names[r]) for r in np.flatnonzero(mac < POOR) if str(names[r]) not in said]
    if poor:
        yield found("poor-pair", enumeration(poor), many=len(poor) > 1, poor=POOR)


def distant_pairs(search: Search, named: Iterable[Mistake]) -> Iterator[Finding]:
    """Yield the pairs without some mistakes that a window mends, if they are clearly better."""
    fits, problem = search.fits, search.fits.comparison.problem
    rule, data = problem.pairing, problem.data
    foreign = [one for one in named if one.finding.kind in FOREIGN]
    state = undone(fits.plain, [one for one in named if one not in foreign])
    modes = fits.of(state, 0 * state.start)
    if rule.method == "order" or modes is None:
        return
    # The covariance is of other shapes.
    data = replace(data, frequency=state.frequency, shape=state.shape, shape_covariance=None)
    low, rules = int(state.candidates), (rule, replace(rule, window=WINDOW))
    f, phi = modes.frequency[:low], fits.rows(state) @ modes.phi[:, :low]
    pairs, mended = (match(each, data, f, phi) for each in rules)
    every = stacked([state, state]), np.zeros((2, len(state.start)))
    cost, least = fits.at(*every, np.stack([pairs.index, mended.index])).cost
    changed = (pairs.index != mended.index) & (cost > least + CLEAR)
    for r in np.flatnonzero(changed).tolist():
        q, near, value = int(pairs.index[r]), int(mended.index[r]), float(pairs.mac[r])
        if str(data.modes[r]) not in [one.finding.subject for one in foreign]:
            measured = {"measured": float(np.exp(state.logs[r])), "alike": alike(value)}
            model = {"model": q + 1, "f": float(f[q]), "near": near + 1, "there": float(f[near])}
            yield Finding("distant-pair", str(data.modes[r]), {**measured, **model})
