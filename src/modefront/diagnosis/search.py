"""The search over mistakes: best first, alone and together, and what of it is certain."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, pairwise
from operator import attrgetter

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.comparison import Comparison, of_few_sets
from modefront.diagnosis.evidence import (
    ENOUGH,
    TOGETHER,
    Fits,
    Points,
    State,
    points,
    roughly,
    stacked,
)
from modefront.diagnosis.mistakes import sensors, values
from modefront.diagnosis.mistakes.record import Mistake, Setting
from modefront.findings.record import Finding, found
from modefront.pairing.match import match

CLEAR = float(np.log(100.0))
"""Difference of costs from which on one explanation is clearly better: odds of 100 to 1."""

PROMISING, TRIED, FITTED, VARIANTS = 200, 40, 10, 2
"""Changes of shapes of each kind that are compared with others, claims that are tried in pairs,
those by which an explanation is extended, and mistakes of a claim that are fitted."""

BEAM = 6
"""Single mistakes to which others are added beside the best explanation."""

FOLLOWED = 2
"""Steps of a fit after which mistakes that move the parameters are compared with others."""

EITHER = 3
"""Explanations that the data cannot tell apart and that are named nevertheless, at most."""

WINDOW = 1.5
"""Window of frequencies that is advised."""

LEFT = 1.0
"""Difference of costs that fits leave."""

SEEN = 0.02
"""Increase of a MAC value that is worth its name."""

MISTAKES: Sequence[Callable[[Setting], Iterator[Mistake]]] = (
    values.frequency_factor,
    values.other_quantity,
    values.set_factor,
    values.other_numbers,
    sensors.wrong_factor,
    sensors.exchanged_sensors,
    sensors.copied_sensor,
    sensors.shifted_values,
    sensors.counted_from_one,
    sensors.wrong_direction,
    sensors.wrong_place,
    values.wrong_nominal_value,
    values.excluding_bound,
    values.odd_value,
    values.wrong_frequency,
    values.damping_in_percent,
    values.foreign_mode,
    values.later_mode,
)
"""What is looked for; where two explain the data equally well, the first one is tried first."""

Claims = frozenset[tuple[str, ...]]


def key_of(mistakes: Sequence[Mistake]) -> object:
    """Return what tells an explanation from others."""
    return frozenset((*x.claim, str(x.numbers)) for x in mistakes), is_ordered(mistakes)


def is_ordered(mistakes: Sequence[Mistake]) -> bool:
    """Return whether values are moved back to their sensors first, so that others name these."""
    return not any(b.moves > a.moves for a, b in pairwise(mistakes))


@dataclass(frozen=True, eq=False)
class Explanation:
    """Assumed mistakes, the state without them, the end of a fit, and C there with the prices."""

    mistakes: tuple[Mistake, ...]
    state: State
    point: Points
    cost: float

    @cached_property
    def claims(self) -> Claims:
        """What is claimed."""
        return frozenset(each.claim for each in self.mistakes)


COST = attrgetter("cost")


def undone(state: State, mistakes: Iterable[Mistake]) -> State:
    """Return the state without some mistakes."""
    for each in mistakes:
        state = each.change(state)
    return state


def promising(found: Sequence[Mistake], setting: Setting) -> list[Mistake]:
    """Return those of each kind by which shapes come nearest to the model, and all others."""
    old, costs = setting.state, np.full(len(found), -np.inf)
    for k in range(0, len(found), TOGETHER):
        states = [one.change(old) for one in found[k : k + TOGETHER]]
        rough = [roughly(states, old, *x) for x in zip(setting.points, setting.solved, strict=True)]
        for i, (state, cost) in enumerate(zip(states, np.min(rough, axis=0), strict=True), k):
            if state.data.shape is not old.data.shape:
                costs[i] = cost + found[i].price
    chosen, counts = [], Counter[str]()
    for k in np.argsort(costs, kind="stable").tolist():
        counts[found[k].kind] += 1
        if counts[found[k].kind] <= PROMISING or np.isinf(costs[k]):
            chosen.append(k)
    return [found[k] for k in sorted(chosen)]


class Search:
    """Explanations of a comparison that were fitted, each with its best fit, as ``known``."""

    def __init__(self, comparison: Comparison) -> None:
        self.comparison, self.fits = comparison, Fits(comparison)
        self.known: dict[object, Explanation] = {}

    def fit(self, several: Sequence[tuple[Mistake, ...]], *starts: Floats) -> None:
        """Fit the explanations by some mistakes each, from the best of some parameters."""
        states = [undone(self.fits.plain, mistakes) for mistakes in several]
        tried = [[np.clip(x, s.lower, s.upper) for x in (s.start, *starts)] for s in states]
        ends = self.fits.fitted(states, self.fits.least(states, tried)[1])
        for mistakes, state, at in zip(several, states, ends, strict=True):
            if at is not None:
                cost = float(at.cost) + sum(each.price for each in mistakes)
                new = Explanation(mistakes, state, at, cost)
                key = key_of(mistakes)
                self.known[key] = min(self.known.get(key, new), new, key=COST)

    def extend(self, old: Explanation) -> None:
        """Fit the most promising explanations with a mistake more."""
        thetas = [old.point.theta] if old.mistakes else [old.state.start, old.point.theta]
        solved = [x for theta in thetas if (x := self.fits.solved(theta))]
        at = points(stacked([old.state] * len(solved)), solved)
        names, parameters = self.comparison.data, self.comparison.problem.model.parameters
        each = [at.at(k) for k in range(len(solved))]
        setting = Setting(old.state, solved, each, names, parameters)
        found = [one for find in MISTAKES for one in find(setting) if one.claim not in old.claims]
        found = promising(found, setting)
        costs = self._screened([(one,) for one in found], old.state, thetas)
        # Others have made up for a wrong parameter: what it costs where they are says little.
        order = np.argsort(costs, kind="stable").tolist()
        moved = [k for k in order if found[k].kind == "nominal-value"][:TRIED]
        costs[moved] = self._screened([(found[k],) for k in moved], old.state, thetas, FOLLOWED)
        claims: dict[tuple[str, ...], list[Mistake]] = {}
        for k in np.argsort(costs, kind="stable").tolist():
            claims.setdefault(found[k].claim, []).append(found[k])
        some = list(claims.values())
        added = [(one,) for variants in some[:FITTED] for one in variants[:VARIANTS]]
        if not old.mistakes:
            pairs = list(combinations([variants[0] for variants in some[:TRIED]], 2))
            order = np.argsort(self._screened(pairs, old.state, thetas), kind="stable").tolist()
            added += [pairs[k] for k in order[:FITTED]]
        self.fit([(*old.mistakes, *new) for new in added], old.point.theta)

    def _screened(
        self,
        several: Sequence[tuple[Mistake, ...]],
        old: State,
        thetas: Sequence[Floats],
        steps: int = 0,
    ) -> Floats:
        """Return the costs without more mistakes, at parameters at hand or some steps away."""
        states = [undone(old, mistakes) for mistakes in several]
        tried = [
            thetas if new.start is old.start else [new.theta(old.x(theta)) for theta in thetas]
            for new in states
        ]
        costs, best = self.fits.least(states, tried)
        if steps:
            ends = self.fits.fitted(states, best, steps)
            costs = np.array([np.inf if x is None else x.cost for x in ends])
        return costs + [sum(each.price for each in mistakes) for mistakes in several]

    def best(self) -> Explanation | None:
        """Return the best explanation; the best ones are extended, the first one first."""
        self.fit([()])
        if not self.known:
            return None
        (plain,), extended = self.known.values(), set[object]()
        while True:
            best = min(self.known.values(), key=COST)
            fewer = [tuple(x for x in best.mistakes if x is not one) for one in best.mistakes]
            self.fit([x for x in fewer if key_of(x) not in self.known], best.point.theta)
            # What one explains may be hidden by another one, so that it is not worth its price.
            alone = [x for x in self.bests().values() if len(x.mistakes) == 1]
            alone = [x for x in alone if x.point.cost < plain.point.cost - LEFT][:BEAM]
            level = [
                best,
                *(self.known[k] for x in fewer if (k := key_of(x)) in self.known),
                *alone,
            ]
            new = next((x for x in level if key_of(x.mistakes) not in extended), None)
            if new is not None:
                extended.add(key_of(new.mistakes))
                self.extend(new)
                continue
            # A rival may only have been fitted from where its way is barred.
            rivals = list(self.known.values())
            inside = [[np.clip(best.point.theta, x.state.lower, x.state.upper)] for x in rivals]
            costs, _ = self.fits.least([x.state for x in rivals], inside)
            nearer = costs < np.array([x.point.cost for x in rivals]) - ENOUGH
            self.fit([rivals[k].mistakes for k in np.flatnonzero(nearer)], best.point.theta)
            if min(self.known.values(), key=COST) is best:
                break
        ordered = {key: each for key, each in self.known.items() if is_ordered(each.mistakes)}
        first = min(ordered.values(), key=COST)
        if first.cost > best.cost + LEFT:
            return best
        self.known = ordered
        return first

    def bests(self) -> dict[Claims, Explanation]:
        """Return the best explanation of each set of claims, the best one first."""
        out: dict[Claims, Explanation] = {}
        for each in sorted(self.known.values(), key=COST):
            out.setdefault(each.claims, each)
        return out

    def named(self, best: Explanation) -> dict[Mistake, Finding]:
        """Return the mistakes of the best explanation without which no other one comes near it.

        Another one is no rival that has more mistakes and fits no better: all sensors but one
        reversed are the same as that one, as a mode shape has no sign. Bounds only explain here:
        whether one is to blame is judged as in a run.
        """
        out, bests, most = {}, self.bests(), best.point.cost - LEFT
        serious = [
            each
            for each in bests.values()
            if len(each.mistakes) <= len(best.mistakes) or each.point.cost <= most
        ]
        for one in [each for each in best.mistakes if each.kind != "bound"]:
            rivals = [each for each in serious if one.claim not in each.claims]
            near = [each for each in rivals if each.cost - best.cost < CLEAR]
            rest = best.claims - {one.claim}
            swaps = [
                other
                for each in near
                if each.claims > rest and len(each.claims) == len(best.claims)
                for other in each.mistakes
                if other.claim not in rest and other.kind != "bound"
            ]
            alike = {other.claim for other in swaps}
            if len(swaps) >= EITHER or not all(each.claims & alike for each in near):
                continue
            gain = min((each.cost for each in rivals if not each.claims & alike), default=np.inf)
            out[one] = replace(
                one.finding,
                others=tuple(other.finding for other in swaps),
                evidence=self._evidence(bests.get(rest, bests[frozenset()]), best),
                gain=float(gain - best.cost),
            )
        return out

    def _evidence(self, without: Explanation, best: Explanation) -> str:
        """Return how the MAC value changes that gains most by a mistake, where one does."""
        before, after = without.point.mac, best.point.mac
        rise = np.where(best.state.foreign, 0.0, np.nan_to_num(after - before))
        r = int(np.argmax(rise))
        if rise[r] < SEEN:
            return ""
        mode = self.comparison.data.modes[r]
        return f" (without, MAC {mode} is {after[r]:.2f} after a fit, and not {before[r]:.2f})"


def diagnose(comparison: Comparison) -> list[Finding]:
    """Return the mistakes of a model or its data; of many data sets, some are looked at."""
    search = Search(of_few_sets(comparison))
    best = search.best()
    if best is None:
        return []
    named = search.named(best)
    return [*named.values(), *distant_pairs(search, undone(search.fits.plain, named))]


def distant_pairs(search: Search, state: State) -> Iterator[Finding]:
    """Yield the pairs of a state that a window mends, where they are clearly better with it."""
    rule, data = search.comparison.problem.pairing, search.comparison.data
    solved = search.fits.solved(state.start)
    if rule.method == "order" or solved is None:
        return
    data = replace(data, frequency=state.data.frequency, shape=state.data.shape)
    data = replace(data, shape_covariance=None)  # it is of other shapes
    f, phi = solved.frequency, (state.rows @ solved.phi)[:, : state.candidates]
    pairs, mended = (
        match(each, data, f[: state.candidates], phi)
        for each in (rule, replace(rule, window=WINDOW))
    )
    one = stacked([state])
    cost, least = (points(one, [solved], x.index[None]).cost[0] for x in (pairs, mended))
    changed = (pairs.index != mended.index) & ~state.foreign & (cost > least + CLEAR)
    for r in np.flatnonzero(changed).tolist():
        q, near, value = int(pairs.index[r]), int(mended.index[r]), pairs.mac[r]
        yield found(
            "distant-pair",
            str(data.modes[r]),
            measured=float(np.exp(state.data.logs[r])),
            model=q + 1,
            f=float(f[q]),
            alike="" if np.isnan(value) else f" (MAC {value:.2f})",
            near=near + 1,
            there=float(f[near]),
        )
