"""A mistake as a record: who may have made it where, and how likely.

A mistake has a probability with which a study has one; its variants share it. A variant says whom
it blames, how data or model look without it, and the names and numbers of the sentence that
`modefront.findings.catalogue` has of its kind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.diagnosis.evidence import OF_MODEL, Point, State
from modefront.diagnosis.student import loss
from modefront.findings.knowledge import enumeration

RARE, USUAL, OFTEN = 0.005, 0.02, 0.05
"""Probabilities with which a study has a mistake."""

TRIED = 40
"""Variants of a mistake that are tried where there are many: those that promise most."""

MANY = 6
"""Names that a sentence has, at most."""

Change: TypeAlias = Callable[[State], State]


@dataclass(frozen=True, eq=False)
class Setting:
    """What variants are sought for: a state, and the model beside it at some parameters.

    Attributes
    ----------
    state : data and model
    points : the state at the nominal and at fitted parameters
    frequencies, shapes : of the model at each point: (model modes,) in Hz, and (N, model modes)
    sets, modes, sensors, parameters : names
    """

    state: State
    points: Sequence[Point]
    frequencies: Sequence[Floats]
    shapes: Sequence[Floats]
    sets: tuple[str, ...]
    modes: tuple[int, ...]
    sensors: tuple[str, ...]
    parameters: tuple[str, ...]

    @property
    def measured(self) -> list[int]:
        """Sensors with data."""
        known: list[int] = np.flatnonzero(self.state.data.known.any(axis=0)).tolist()
        return known

    @property
    def compared(self) -> range:
        """Data sets, where there are others to compare them with."""
        return range(len(self.sets) if len(self.sets) > 1 else 0)

    def others(self, k: int) -> str:
        """Return the names of the data sets besides one."""
        return enumeration([name for i, name in enumerate(self.sets) if i != k], 2)

    def gain(self, s: int, rows: scipy.sparse.csr_array) -> Floats:
        """Return by how much the cost falls with sensor s at other rows (places, N), (places,)."""
        data, out = self.state.data, np.full(rows.shape[0], -np.inf)
        used = data.known[:, s] & ~self.state.foreign
        c = data.mean[used, s]
        for point, Phi in zip(self.points, self.shapes, strict=True):
            scale = point.sigma * data.motion[s]
            beta, old = point.beta[used], point.beta[used] * point.chi[used, s]
            new = (rows @ Phi[:, point.index[used]]) * beta
            before, after = (loss((x - c) / scale, OF_MODEL).sum(axis=-1) for x in (old, new))
            out = np.maximum(out, before - after)
        return out


@dataclass(frozen=True, eq=False)
class Variant:
    """A mistake of a certain sensor, data set or parameter.

    Attributes
    ----------
    subject : what it blames
    change : returns a state without it
    numbers : names and numbers of its sentence
    price : what it costs beside the price of its mistake
    """

    subject: tuple[str, ...]
    change: Change
    numbers: Mapping[str, Any] = field(default_factory=dict)
    price: float = 0.0


Variants: TypeAlias = Callable[[Setting], Iterator[Variant]]


@dataclass(frozen=True, eq=False)
class Mistake:
    """A kind of mistake.

    Attributes
    ----------
    kind : name
    probability : with which a study has one
    variants : yields the variants in a setting
    """

    kind: str
    probability: float
    variants: Variants


def mistake(kind: str, probability: float) -> Callable[[Variants], Mistake]:
    """Return the decorator of a function that yields variants, which makes a mistake of it."""
    return lambda variants: Mistake(kind, probability, variants)


def promising(found: Iterable[tuple[float, Variant]]) -> Iterator[Variant]:
    """Yield the variants by which the cost promises to fall most, of pairs with that fall."""
    for _, variant in sorted(found, key=lambda each: -each[0])[:TRIED]:
        yield variant


def one_of(count: float) -> float:
    """Return the price of one of ``count`` variants."""
    return float(np.log(max(count, 1)))


def changed(part: str, new: Callable[[Floats], Floats]) -> Change:
    """Return the change of a part of the data into what a function makes of it."""

    def change(state: State) -> State:
        values: Any = {part: new(getattr(state.data, part).copy())}
        return replace(state, data=replace(state.data, **values))

    return change
