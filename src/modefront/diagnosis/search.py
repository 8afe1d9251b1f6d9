"""The search over mistakes: best first, alone and together, and what of it is certain."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.comparison import Comparison, compare, of_few_sets
from modefront.diagnosis.evidence import Point, Quick, State, point, quick
from modefront.diagnosis.mistakes import MISTAKES
from modefront.diagnosis.mistakes.record import Mistake, Setting, Variant
from modefront.diagnosis.pairs import bad_pairs
from modefront.findings.record import Finding

CLEAR = float(np.log(100.0))
"""Difference of costs from which on one explanation is clearly better: odds of 100 to 1."""

BEAM, FITTED, VARIANTS, MOST = 6, 10, 2, 8
"""Explanations that are extended at a time, claims by which each is, variants of a claim that are
fitted, and most mistakes."""

EITHER = 3
"""Explanations that the data cannot tell apart and that are named nevertheless, at most."""

SEEN = 0.02
"""Increase of a MAC value that is worth its name."""

MORE = 4
"""Model modes with which measured ones may be paired, beyond the candidates of the study."""


@dataclass(frozen=True, eq=False)
class Step:
    """A variant of a mistake that is assumed."""

    mistake: Mistake
    variant: Variant

    @property
    def claim(self) -> tuple[str, ...]:
        """What is claimed: the kind of mistake and whom it blames."""
        return (self.mistake.kind, *self.variant.subject)

    @property
    def price(self) -> float:
        """Negative logarithm of the probability that a study has it."""
        return self.variant.price - float(np.log(self.mistake.probability))

    @property
    def finding(self) -> Finding:
        """Its record."""
        subject = ", ".join(self.variant.subject)
        return Finding(self.mistake.kind, subject, self.variant.numbers)


@dataclass(frozen=True, eq=False)
class Explanation:
    """Assumed mistakes, with the state without them at its fitted parameters.

    Attributes
    ----------
    steps : the mistakes
    state, point : data and model without them, and the end of a fit
    cost : C with the prices
    """

    steps: tuple[Step, ...]
    state: State
    point: Point
    cost: float

    @property
    def claims(self) -> frozenset[tuple[str, ...]]:
        """What is claimed."""
        return frozenset(step.claim for step in self.steps)


@dataclass(eq=False)
class Search:
    """Explanations that were tried.

    Attributes
    ----------
    comparison : the nominal model beside the measured modes
    model : the model, quickly solved
    known : explanations that were fitted, the best of those with the same claims
    """

    comparison: Comparison
    model: Quick
    known: dict[frozenset[tuple[str, ...]], Explanation] = field(default_factory=dict)
    extended: set[frozenset[tuple[str, ...]]] = field(default_factory=set)

    @classmethod
    def of(cls, comparison: Comparison) -> Search:
        """Return the search that begins with a comparison."""
        problem = comparison.problem
        count = min(problem.model.size, comparison.candidates + MORE, comparison.frequency.size)
        bounds = problem.lower, problem.upper
        model = quick(problem.model, comparison.matrices, count, problem.start, bounds)
        return cls(comparison, model)

    @property
    def plain(self) -> State:
        """Data and model as they are."""
        problem, data = self.comparison.problem, self.comparison.view
        matrices = self.comparison.matrices
        return State(
            data,
            np.zeros(data.logs.size, dtype=bool),
            None if matrices is None else matrices.selection,
            None if matrices is None else matrices.geometry,
            *(problem.start, problem.lower, problem.upper),
        )

    def state(self, steps: Sequence[Step]) -> State:
        """Return data and model without some mistakes."""
        state = self.plain
        for step in steps:
            state = step.variant.change(state)
        return state

    def fitted(self, steps: Sequence[Step], starts: Sequence[Floats]) -> Explanation | None:
        """Return the explanation by some mistakes, the best of fits from several parameters."""
        state = self.state(steps)
        starts = [np.clip(theta, state.lower, state.upper) for theta in (state.start, *starts)]
        points = [self._at(state, theta) for theta in starts]
        begin = [(at.cost, k) for k, at in enumerate(points) if at is not None]
        if not begin:
            return None
        at = self.model.fit(state, starts[min(begin)[1]])
        if at is None:
            return None
        cost = at.cost + sum(step.price for step in steps)
        new = Explanation(tuple(steps), state, at, cost)
        old = self.known.get(new.claims)
        if old is None or new.cost < old.cost:
            self.known[new.claims] = new
        return self.known[new.claims]

    def _at(self, state: State, theta: Floats) -> Point | None:
        whole = self.model.everywhere(theta)
        if whole is None:
            return None
        f, Phi = whole
        return point(state, theta, f, Phi if state.selection is None else state.selection @ Phi)

    def extend(self, old: Explanation) -> list[Explanation]:
        """Return the most promising explanations with a mistake more, after a fit of each."""
        if old.claims in self.extended:
            return [
                e for c, e in self.known.items() if len(c) == len(old.claims) + 1 and c > old.claims
            ]
        self.extended.add(old.claims)
        state, thetas = old.state, [old.state.start, old.point.theta]
        if old.steps:
            del thetas[0]
        wholes = [(theta, self.model.everywhere(theta)) for theta in thetas]
        models = [(theta, *whole) for theta, whole in wholes if whole is not None]
        promising: list[tuple[float, int, Step]] = []
        for step in self._steps(old, models):
            if step.claim not in old.claims:
                cost = self._screened(step.variant.change(state), state, models) + step.price
                promising.append((cost, len(promising), step))
        count: Counter[tuple[str, ...]] = Counter()
        out = []
        for _, _, step in sorted(promising):
            count[step.claim] += 1
            if count[step.claim] <= VARIANTS and len(count) <= FITTED:
                out.append(self.fitted((*old.steps, step), [old.point.theta]))
        return sorted((each for each in out if each is not None), key=lambda each: each.cost)

    def _screened(
        self, new: State, old: State, models: Sequence[tuple[Floats, Floats, Floats]]
    ) -> float:
        """Return the least cost of a state at the parameters that are at hand."""
        costs = [np.inf]
        for theta, f, Phi in models:
            if not np.array_equal(new.start, old.start):
                at = self._at(new, new.theta(old.x(theta)))
            else:
                phi = Phi if new.selection is None else new.selection @ Phi
                at = point(new, theta, f, phi)
            costs.append(np.inf if at is None else at.cost)
        return float(min(costs))

    def _steps(
        self, old: Explanation, models: Sequence[tuple[Floats, Floats, Floats]]
    ) -> Iterator[Step]:
        """Yield what may be assumed besides an explanation."""
        data = self.comparison.data
        select = old.state.selection
        setting = Setting(
            old.state,
            [
                point(old.state, t, f, Phi if select is None else select @ Phi)
                for t, f, Phi in models
            ],
            [f for _, f, _ in models],
            [Phi for _, _, Phi in models],
            *(data.sets, data.modes, data.sensors, self.comparison.problem.model.parameters),
        )
        for mistake in MISTAKES:
            for variant in mistake.variants(setting):
                yield Step(mistake, variant)

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
            for step in best.steps:
                rest = self.fitted([each for each in best.steps if each is not step], theta)
                if rest is not None:
                    self.extend(rest)
            # A rival may only have been fitted from where its way is barred.
            for each in list(self.known.values()):
                at = self._at(each.state, np.clip(theta[0], each.state.lower, each.state.upper))
                if at is not None and at.cost < each.point.cost:
                    self.fitted(each.steps, theta)
            if min(each.cost for each in self.known.values()) >= best.cost:
                return best

    def _evidence(self, without: Explanation, best: Explanation) -> str:
        """Return how the MAC value changes that gains most by a mistake, where one does."""
        before, after = (each.point.mac(each.state.data) for each in (without, best))
        gain = np.nan_to_num(after - before)
        r = int(np.argmax(gain))
        if gain[r] < SEEN:
            return ""
        mode = self.comparison.data.modes[r]
        return f" (without, MAC {mode} is {after[r]:.2f} after a fit, and not {before[r]:.2f})"

    def named(self, best: Explanation) -> dict[Step, Finding]:
        """Return the mistakes of the best explanation without which no other one comes near it."""
        out = {}
        for step in best.steps:
            rivals = [
                each
                for each in self.known.values()
                if step.claim not in each.claims and not _exceeds(each, best)
            ]
            near = [each for each in rivals if each.cost - best.cost < CLEAR]
            rest = best.claims - {step.claim}
            swaps = [
                other
                for each in near
                if each.claims > rest and len(each.claims) == len(best.claims)
                for other in each.steps
                if other.claim not in rest
            ]
            alike = {other.claim for other in swaps}
            if len(swaps) >= EITHER or not all(each.claims & alike for each in near):
                continue
            gain = min((each.cost for each in rivals if not each.claims & alike), default=np.inf)
            without = self.known.get(rest, self.known[frozenset()])
            out[step] = replace(
                step.finding,
                others=tuple(other.finding for other in swaps),
                evidence=self._evidence(without, best),
                gain=float(gain - best.cost),
            )
        return out


def _exceeds(other: Explanation, best: Explanation) -> bool:
    """Return whether another explanation has more mistakes than the best one and fits no better.

    All sensors but one reversed are the same as that one: a mode shape has no sign.
    """
    more = len(other.steps) > len(best.steps)
    return more and other.point.cost > best.point.cost - 1


def diagnose(comparison: Comparison) -> list[Finding]:
    """Return the mistakes of a model or its data; of many data sets, some are looked at.

    Pairs are looked at without these mistakes.
    """
    comparison = of_few_sets(comparison)
    search = Search.of(comparison)
    best = search.best()
    if best is None:
        return []
    named = search.named(best)
    found = list(named.values())
    state = search.state(list(named))
    foreign = {str(mode) for mode in np.array(comparison.data.modes)[state.foreign]}
    if found:
        problem, model = comparison.problem, comparison.matrices
        data = replace(comparison.data, frequency=state.data.frequency, shape=state.data.shape)
        if model is not None and state.selection is not None:
            problem = replace(problem, model=replace(model, selection=state.selection))
        comparison = compare(replace(problem, data=data, start=state.start))
    return [*found, *(each for each in bad_pairs(comparison) if each.subject not in foreign)]
