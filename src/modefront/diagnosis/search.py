"""The search over mistakes: best first, alone and together, and what of it is certain."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.comparison import Comparison, compare, of_few_sets
from modefront.diagnosis.evidence import Point, Quick, State, Whole, places, point, point_of, quick
from modefront.diagnosis.mistakes import sensors, sets, values
from modefront.diagnosis.mistakes.record import TRIED, Mistake, Setting
from modefront.findings.record import Finding, found
from modefront.pairing.match import match

CLEAR = float(np.log(100.0))
"""Difference of costs from which on one explanation is clearly better: odds of 100 to 1."""

BEAM, FITTED, VARIANTS, MOST = 6, 10, 2, 8
"""Explanations that are extended at a time, claims by which each is, mistakes of a claim that are
fitted, and most mistakes."""

FOLLOWED = 2
"""Steps of a fit after which mistakes that move the parameters are compared with others."""

EITHER = 3
"""Explanations that the data cannot tell apart and that are named nevertheless, at most."""

WINDOW = 1.5
"""Window of frequencies that is advised."""

SEEN = 0.02
"""Increase of a MAC value that is worth its name."""

MISTAKES: Sequence[Callable[[Setting], Iterator[Mistake]]] = (
    values.frequency_factor,
    values.other_quantity,
    sets.set_factor,
    sets.other_numbers,
    sensors.wrong_factor,
    sensors.exchanged_sensors,
    sensors.copied_sensor,
    sensors.shifted_values,
    sensors.counted_from_one,
    sensors.wrong_direction,
    sensors.wrong_place,
    values.wrong_nominal_value,
    values.excluding_bound,
    sets.odd_frequency,
    sets.odd_shape,
    values.wrong_frequency,
    values.damping_in_percent,
    sets.foreign_mode,
    sets.later_mode,
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


@dataclass(eq=False)
class Search:
    """Explanations of a comparison: those ``known`` were fitted, those ``extended`` also added to.

    Of explanations with the same claims, the best one is kept; ``plain`` are data and model as they
    are.
    """

    comparison: Comparison
    model: Quick
    plain: State
    known: dict[Claims, Explanation] = field(default_factory=dict)
    extended: set[Claims] = field(default_factory=set)

    @classmethod
    def of(cls, comparison: Comparison) -> Search:
        """Return the search that begins with a comparison."""
        problem, matrices = comparison.problem, comparison.matrices
        count = min(problem.model.size, comparison.frequency.size)
        bounds = problem.lower, problem.upper
        plain = State(
            comparison.view,
            np.zeros(len(problem.data.modes), dtype=bool),
            comparison.candidates,
            None if matrices is None else matrices.selection,
            None if matrices is None else places(matrices),
            problem.start,
            *bounds,
        )
        return cls(comparison, quick(problem.model, matrices, count, problem.start, bounds), plain)

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
        self.known[new.claims] = min(
            self.known.get(new.claims, new), new, key=lambda each: each.cost
        )
        return self.known[new.claims]

    def _cost(self, state: State, theta: Floats) -> float:
        """Return the cost of a state at parameters; infinite where the model has no modes."""
        whole = self.model.everywhere(theta)
        return np.inf if whole is None else point_of(state, whole).cost

    def extend(self, old: Explanation) -> list[Explanation]:
        """Return the most promising explanations with a mistake more, after a fit of each."""
        if old.claims in self.extended:
            return []
        self.extended.add(old.claims)
        thetas = [old.point.theta] if old.mistakes else [old.state.start, old.point.theta]
        wholes = [x for theta in thetas if (x := self.model.everywhere(theta)) is not None]
        points = [point_of(old.state, whole) for whole in wholes]
        names, parameters = self.comparison.data, self.comparison.problem.model.parameters
        setting = Setting(old.state, wholes, points, names, parameters)
        promising: list[tuple[float, int, Mistake]] = []
        for find in MISTAKES:
            for one in find(setting):
                if one.claim not in old.claims:
                    cost = self._screened(one.change(old.state), old.state, wholes) + one.price
                    promising.append((cost, len(promising), one))
        count: Counter[tuple[str, ...]] = Counter()
        added: list[tuple[Mistake, ...]] = []
        firsts: dict[tuple[str, ...], Mistake] = {}
        for _, _, one in sorted(self._followed(promising, old.state, wholes)):
            firsts.setdefault(one.claim, one)
            count[one.claim] += 1
            if count[one.claim] <= VARIANTS and len(count) <= FITTED:
                added.append((one,))
        if not old.mistakes:
            pairs = list(combinations(list(firsts.values())[:TRIED], 2))
            costs = [
                self._screened(b.change(a.change(old.state)), old.state, wholes) + a.price + b.price
                for a, b in pairs
            ]
            added += [pairs[k] for k in np.argsort(costs, kind="stable")[:FITTED]]
        out = [self.fitted((*old.mistakes, *new), [old.point.theta]) for new in added]
        return [each for each in out if each is not None]

    def _screened(self, new: State, old: State, wholes: Sequence[Whole]) -> float:
        """Return the least cost of a state at the parameters that are at hand."""
        if new.start is not old.start:
            return min(self._cost(new, new.theta(old.x(whole.theta))) for whole in wholes)
        return min(point_of(new, whole).cost for whole in wholes)

    def _followed(
        self, screened: list[tuple[float, int, Mistake]], old: State, wholes: Sequence[Whole]
    ) -> list[tuple[float, int, Mistake]]:
        """Return mistakes with their costs, after some steps where they move the parameters.

        The others have made up for a wrong one, so what it costs where they are says little.
        """
        out, followed = [], 0
        for cost, place, one in sorted(screened):
            new = one.change(old)
            if new.start is not old.start and followed < TRIED:
                followed += 1
                thetas = [new.theta(old.x(whole.theta)) for whole in wholes]
                best = min(thetas, key=lambda theta: self._cost(new, theta))
                at = self.model.fit(new, best, FOLLOWED)
                cost = cost if at is None else at.cost + one.price
            out.append((cost, place, one))
        return out

    def best(self) -> Explanation | None:
        """Return the best explanation, by extending the best ones, and by leaving mistakes out."""
        plain = self.fitted((), [])
        if plain is None:
            return None
        beam = [plain]
        for width in (BEAM, *[1] * (MOST - 1)):
            least, fits = min((old.cost, old.point.cost) for old in beam)
            children = {each.claims: each for old in beam for each in self.extend(old)}
            better = [each for each in children.values() if each.point.cost < fits - 1]
            beam = sorted(better, key=lambda each: each.cost)[:width]
            if not beam or (width == 1 and beam[0].cost > least):
                break
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
                return best

    def named(self, best: Explanation) -> dict[Mistake, Finding]:
        """Return the mistakes of the best explanation without which no other one comes near it.

        Another one is no rival that has more mistakes and fits no better: all sensors but one
        reversed are the same as that one, as a mode shape has no sign.
        """
        out = {}
        for one in best.mistakes:
            rivals = [
                each
                for each in self.known.values()
                if one.claim not in each.claims
                and (
                    len(each.mistakes) <= len(best.mistakes)
                    or each.point.cost <= best.point.cost - 1
                )
            ]
            near = [each for each in rivals if each.cost - best.cost < CLEAR]
            rest = best.claims - {one.claim}
            swaps = [
                other
                for each in near
                if each.claims > rest and len(each.claims) == len(best.claims)
                for other in each.mistakes
                if other.claim not in rest
            ]
            alike = {other.claim for other in swaps}
            if len(swaps) >= EITHER or not all(each.claims & alike for each in near):
                continue
            gain = min((each.cost for each in rivals if not each.claims & alike), default=np.inf)
            out[one] = replace(
                one.finding,
                others=tuple(other.finding for other in swaps),
                evidence=self._evidence(self.known.get(rest, self.known[frozenset()]), best),
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
    search = Search.of(comparison)
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
