"""The search over mistakes: best first, alone and together, and what of it is certain."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import combinations, pairwise

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.comparison import Comparison, compare, of_few_sets
from modefront.diagnosis.evidence import Point, State, Whole, places, point, point_of, quick
from modefront.diagnosis.mistakes import sensors, values
from modefront.diagnosis.mistakes.record import TRIED, Mistake, Setting
from modefront.findings.record import Finding, found
from modefront.pairing.match import match

CLEAR = float(np.log(100.0))
"""Difference of costs from which on one explanation is clearly better: odds of 100 to 1."""

BEAM, FITTED, VARIANTS, MOST = 6, 10, 2, 8
"""Single mistakes to which others are added, claims by which each explanation is extended, mistakes
of a claim that are fitted, and most mistakes."""

FOLLOWED = 2
"""Steps of a fit after which mistakes that move the parameters are compared with others."""

KEPT = 16
"""Models that are kept, as many explanations are compared at the same parameters."""

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
    values.odd_frequency,
    values.odd_shape,
    values.wrong_frequency,
    values.damping_in_percent,
    values.foreign_mode,
    values.later_mode,
)
"""What is looked for; where two explain the data equally well, the first one is tried first."""

Claims = frozenset[tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class Explanation:
    """Assumed mistakes, the state without them, the end of a fit, and C there with the prices."""

    mistakes: tuple[Mistake, ...]
    state: State
    point: Point
    cost: float

    @property
    def claims(self) -> Claims:
        """What is claimed."""
        return frozenset(each.claim for each in self.mistakes)

    @property
    def is_ordered(self) -> bool:
        """Whether values are moved back to their sensors first, so that others name these."""
        return not any(b.moves > a.moves for a, b in pairwise(self.mistakes))

    @property
    def key(self) -> tuple[frozenset[tuple[str, ...]], bool]:
        """What tells the explanation from others."""
        return frozenset(each.variant for each in self.mistakes), self.is_ordered


@dataclass(eq=False)
class Search:
    """Explanations of a comparison: those ``known`` were fitted, those ``extended`` also added to.

    Each is kept with its best fit; ``plain`` are data and model as they are.
    """

    comparison: Comparison
    known: dict[object, Explanation] = field(default_factory=dict)
    extended: set[object] = field(default_factory=set)

    def __post_init__(self) -> None:
        problem, matrices = self.comparison.problem, self.comparison.matrices
        count = min(problem.model.size, self.comparison.frequency.size)
        self.plain = State(
            self.comparison.view,
            np.zeros(len(problem.data.modes), dtype=bool),
            self.comparison.candidates,
            None if matrices is None else matrices.selection,
            None if matrices is None else places(matrices),
            *(problem.start, problem.lower, problem.upper),
        )
        self.model = quick(problem.model, matrices, count, self.plain)
        solve = self.model.everywhere
        self.whole = lru_cache(KEPT)(lambda theta: solve(np.frombuffer(theta)))

    def fitted(self, mistakes: Sequence[Mistake], starts: Sequence[Floats]) -> Explanation | None:
        """Return the explanation by some mistakes, after a fit from the best of some parameters."""
        state = self.plain
        for each in mistakes:
            state = each.change(state)
        starts = [np.clip(theta, state.lower, state.upper) for theta in (state.start, *starts)]
        costs = [self._cost(state, theta) for theta in starts]
        at = self.model.fit(state, starts[int(np.argmin(costs))]) if min(costs) < np.inf else None
        if at is None:
            return None
        cost = at.cost + sum(each.price for each in mistakes)
        new = Explanation(tuple(mistakes), state, at, cost)
        known = self.known.setdefault(new.key, new)
        if new.cost < known.cost:
            self.known[new.key] = new
        return self.known[new.key]

    def _cost(self, state: State, theta: Floats) -> float:
        """Return the cost of a state at parameters; infinite where the model has no modes."""
        whole = self.whole(theta.tobytes())
        return np.inf if whole is None else point_of(state, whole).cost

    def extend(self, old: Explanation) -> None:
        """Fit the most promising explanations with a mistake more."""
        if old.key in self.extended:
            return
        self.extended.add(old.key)
        thetas = [old.point.theta] if old.mistakes else [old.state.start, old.point.theta]
        wholes = [x for theta in thetas if (x := self.whole(theta.tobytes())) is not None]
        points = [point_of(old.state, whole) for whole in wholes]
        names, parameters = self.comparison.data, self.comparison.problem.model.parameters
        setting = Setting(old.state, wholes, points, names, parameters)
        found = [one for find in MISTAKES for one in find(setting) if one.claim not in old.claims]
        screened = [self._screened((one,), old.state, wholes) for one in found]
        # Others have made up for a wrong parameter: what it costs where they are says little.
        order = np.argsort(screened, kind="stable").tolist()
        moved = [k for k in order if found[k].change(old.state).start is not old.state.start]
        for k in moved[:TRIED]:
            screened[k] = self._screened((found[k],), old.state, wholes, FOLLOWED)
        claims: dict[tuple[str, ...], list[Mistake]] = {}
        for k in np.argsort(screened, kind="stable").tolist():
            claims.setdefault(found[k].claim, []).append(found[k])
        some = list(claims.values())
        added: list[tuple[Mistake, ...]] = [
            (one,) for variants in some[:FITTED] for one in variants[:VARIANTS]
        ]
        if not old.mistakes:
            pairs = list(combinations([variants[0] for variants in some[:TRIED]], 2))
            costs = [self._screened(pair, old.state, wholes) for pair in pairs]
            added += [pairs[k] for k in np.argsort(costs, kind="stable")[:FITTED]]
        for new in added:
            self.fitted((*old.mistakes, *new), [old.point.theta])

    def _screened(
        self, mistakes: Sequence[Mistake], old: State, wholes: Sequence[Whole], steps: int = 0
    ) -> float:
        """Return the least cost without more mistakes, at parameters at hand or some steps away."""
        new = old
        for each in mistakes:
            new = each.change(new)
        price = sum(each.price for each in mistakes)
        if new.start is old.start:
            return min(point_of(new, whole).cost for whole in wholes) + price
        thetas = [new.theta(old.x(whole.theta)) for whole in wholes]
        costs = [self._cost(new, theta) for theta in thetas]
        k = int(np.argmin(costs))
        at = self.model.fit(new, thetas[k], steps) if steps else None
        return (costs[k] if at is None else at.cost) + price

    def best(self) -> Explanation | None:
        """Return the best explanation, by extending the best ones, and by leaving mistakes out."""
        plain = self.fitted((), [])
        if plain is None:
            return None
        self.extend(plain)
        least = plain.cost
        for size in range(1, MOST + 1):
            of_size = [x for x in self.bests().values() if len(x.mistakes) == size]
            level = [x for x in of_size if x.point.cost < plain.point.cost - LEFT]
            if size > 1 and not (level and level[0].cost <= least):
                break
            least = min([least, *(each.cost for each in level[:1])])
            for each in level[: BEAM if size == 1 else 1]:
                self.extend(each)
        while True:
            best = min(self.known.values(), key=lambda each: each.cost)
            theta = [best.point.theta]
            for one in best.mistakes:
                rest = self.fitted([each for each in best.mistakes if each is not one], theta)
                if rest is not None:
                    self.extend(rest)
            # A rival may only have been fitted from where its way is barred.
            for each in list(self.known.values()):
                inside = np.clip(theta[0], each.state.lower, each.state.upper)
                if self._cost(each.state, inside) < each.point.cost:
                    self.fitted(each.mistakes, theta)
            if min(each.cost for each in self.known.values()) >= best.cost:
                break
        ordered = {key: each for key, each in self.known.items() if each.is_ordered}
        first = min(ordered.values(), key=lambda each: each.cost)
        if first.cost > best.cost + LEFT:
            return best
        self.known = ordered
        return first

    def bests(self) -> dict[Claims, Explanation]:
        """Return the best explanation of each set of claims, the best one first."""
        out: dict[Claims, Explanation] = {}
        for each in sorted(self.known.values(), key=lambda each: each.cost):
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
        before, after = (each.point.mac(each.state.data) for each in (without, best))
        rise = np.where(best.state.foreign, 0.0, np.nan_to_num(after - before))
        r = int(np.argmax(rise))
        if rise[r] < SEEN:
            return ""
        mode = self.comparison.data.modes[r]
        return f" (without, MAC {mode} is {after[r]:.2f} after a fit, and not {before[r]:.2f})"


def diagnose(comparison: Comparison) -> list[Finding]:
    """Return the mistakes of a model or its data; of many data sets, some are looked at.

    Pairs are looked at without these mistakes.
    """
    comparison = of_few_sets(comparison)
    search = Search(comparison)
    best = search.best()
    if best is None:
        return []
    named, state = search.named(best), search.plain
    for one in named:
        state = one.change(state)
    if named:
        problem, model = comparison.problem, comparison.matrices
        data = replace(comparison.data, frequency=state.data.frequency, shape=state.data.shape)
        data = replace(data, shape_covariance=None)  # it is of other shapes
        if model is not None and state.selection is not None:
            problem = replace(problem, model=replace(model, selection=state.selection))
        comparison = compare(replace(problem, data=data, start=state.start))
    return [*named.values(), *distant_pairs(comparison, state)]


def distant_pairs(comparison: Comparison, state: State) -> Iterator[Finding]:
    """Yield the pairs of a study that a window mends, where they are clearly better with it."""
    problem, low = comparison.problem, state.candidates
    f, phi, rule = comparison.frequency, comparison.phi, problem.pairing
    if rule.method == "order":
        return
    pairs, mended = (
        match(each, problem.data, f[:low], phi[:, :low])
        for each in (rule, replace(rule, window=WINDOW))
    )
    cost, least = (point(state, problem.start, f, phi, x.index).cost for x in (pairs, mended))
    changed = (pairs.index != mended.index) & ~state.foreign & (cost > least + CLEAR)
    for r in np.flatnonzero(changed).tolist():
        q, near, value = int(pairs.index[r]), int(mended.index[r]), pairs.mac[r]
        yield found(
            "distant-pair",
            str(problem.data.modes[r]),
            measured=float(np.exp(state.data.logs[r])),
            model=q + 1,
            f=float(f[q]),
            alike="" if np.isnan(value) else f" (MAC {value:.2f})",
            near=near + 1,
            there=float(f[near]),
        )
