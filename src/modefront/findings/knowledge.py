"""What data determine of the parameters, and what they leave open, as findings."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from modefront._typing import Floats, Ints
from modefront.findings.record import Finding, found
from modefront.identifiability.combinations import (
    NONE,
    SAME,
    WEAK,
    Combination,
    Determination,
    pairs,
    sparse_basis,
)
from modefront.identifiability.scale import Scale
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.inference import Freed, excluding

PARTS, NAMED, TOGETHER, SHOWN = 5, 20, 3, 3
"""Numbers of what is named one by one, at most: parameters of a combination, parameters that change
alike, those of which pairs are named, and directions that are not determined."""

MOST = 100
"""Combinations that are not determined, beyond which they are counted and not listed: a
simple basis of them takes the fourth power of their number."""


def enumeration(names: Sequence[str], most: int | None = None) -> str:
    """Return names as a text, the first of many; one more is named, too.

    >>> enumeration(["a", "b", "c"], 2), enumeration(["a", "b", "c", "d"], 2)
    ('a, b and c', 'a, b and 2 more')
    """
    rest = 0 if most is None else len(names) - most
    *first, last = [*names[:most], f"{rest} more"] if rest > 1 else names
    return f"{', '.join(first)} and {last}" if first else last


def in_words(combination: Combination, names: Sequence[str]) -> str:
    """Return the parameters of a combination that have the greatest parts in it."""
    v = np.abs(combination.direction)
    order = [names[i] for i in np.argsort(-v, kind="stable") if v[i] >= 0.1 * v.max()]
    return enumeration([*order[:PARTS], *(["others"] if len(order) > PARTS else [])])


def summaries(problem: UpdatingProblem, of: Determination, where: str = "") -> Iterator[Finding]:
    """Yield what each group, then all data determine at a model; ``where`` begins the sentences."""
    names, groups = problem.model.parameters, problem.groups
    p = len(names) - len(of.idle)
    for i, (subject, combinations) in enumerate(of.combinations):
        kinds = {kind for group in groups[i : i + 1] or groups for kind, _ in group.chosen}
        noun = kinds.pop() if len(kinds) == 1 else "residual"
        full = sum(x.share >= WEAK for x in combinations) == p
        kind = "group-determined" if full else "group-data"
        if i == len(groups):
            kind = "determined" if full else "all-data"
        rank = sum(x.share > NONE for x in combinations)
        text = " that have an effect" if of.idle else ""
        if hardly := [in_words(x, names) for x in combinations[::-1] if NONE < x.share < WEAK]:
            text += f", but hardly {_listed(list(dict.fromkeys(hardly)))}"
        if rank < p:
            free = _listed(free_in_words(combinations, names, of.scale, of.idle))
            text += f"; {free}: no {noun} changes"
        count = f"{p} combination{'s' * (p > 1)}"
        yield found(kind, subject, where=where, rank=rank, combinations=count, free=text)


def free_in_words(
    combinations: Sequence[Combination], names: Sequence[str], scale: Scale, idle: Sequence[int]
) -> list[str]:
    """Return the combinations that are not determined, each as text; ``idle`` have no effect."""
    free = np.array([x.direction for x in combinations if x.share <= NONE]).T
    free[list(idle)] = 0.0
    lam, V = np.linalg.eigh(free.T @ free)
    kept = free @ V[:, lam > 0.5]  # parameters without effect are directions of their own
    if not kept.size:
        return []
    if kept.shape[1] > MOST:
        return [f"{kept.shape[1]} combinations of parameters can have any values"]
    whole = [x / scale.unit for x in (*scale.scalings.values(), scale.theta)]
    shares = np.array([combination.share for combination in combinations])
    V = np.array([combination.direction for combination in combinations])

    def holds(v: Floats) -> bool:
        return bool(np.linalg.norm(shares * (V @ v)) <= 3 * NONE * np.linalg.norm(v))

    return [direction_in_words(v, names, scale) for v in sparse_basis(kept, whole, holds).T]


def no_effect(idle: Sequence[int], names: Sequence[str], where: str = "") -> list[Finding]:
    """Return that parameters have no effect, if there are any."""
    if not idle:
        return []
    named = enumeration([names[i] for i in idle]) if len(idle) <= NAMED else f"{len(idle)} of them"
    return [found("no-effect", named, many=len(idle) > 1, where=where)]


def alike(
    gram: Floats, names: Sequence[str], idle: Sequence[int] = (), where: str = ""
) -> list[Finding]:
    """Return which parameters act nearly alike, from G^T G; those ``idle`` are none.

    Sets of more than `TOGETHER` parameters of which every two are alike are said at once.
    """
    two = dict.fromkeys(pair for pair in pairs(gram) if not set(pair) & set(idle))
    sets: list[list[int]] = []
    for pair in two:
        if not any(set(pair) <= set(parameters) for parameters in sets):
            sets.append(list(pair))
            for k in range(len(names)):
                if all((min(i, k), max(i, k)) in two for i in sets[-1]):
                    sets[-1].append(k)
    out = []
    for parameters in sets:
        if len(parameters) > TOGETHER:
            named = enumeration([names[i] for i in sorted(parameters)])
            subject = named if len(parameters) <= NAMED else f"{len(parameters)} parameters"
            out.append(found("alike", subject, many=True, where=where))
            two = dict.fromkeys(pair for pair in two if not set(pair) <= set(parameters))
    return out + [found("alike", f"{names[i]} and {names[j]}", where=where) for i, j in two]


def _listed(directions: Sequence[str]) -> str:
    more = f"; and {len(directions) - SHOWN} more" if len(directions) > SHOWN else ""
    return "; ".join(directions[:SHOWN]) + more


def direction_in_words(v: Floats, names: Sequence[str], scale: Scale) -> str:
    """Return how parameters can be changed along a direction, in units of a scale.

    >>> scale = Scale(np.ones(3), np.ones(3), np.ones(3, dtype=bool))
    >>> direction_in_words(np.array([0.5, 0.5, 0.0]), ("k1", "k2", "m"), scale)
    'k1 and k2 can be scaled together'
    >>> direction_in_words(np.array([1.0, 0.0, -0.25]), ("k1", "k2", "m"), scale)
    'k1 and m cannot be told apart'
    """
    v = v / np.abs(v).max()
    members = np.flatnonzero(np.abs(v) > SAME).tolist()
    if len(members) == 1:
        return f"{names[members[0]]} can have any value"
    amounts = (v * scale.unit)[members]
    theta = scale.theta[members]
    powers = amounts / np.where(theta == 0, np.inf, theta)
    if _equal(powers):
        return f"{_named(members, powers, names)} can be scaled together"
    ratio = powers if scale.positive[members].all() else amounts
    ratio = ratio / ratio[np.argmax(np.abs(ratio))]
    named = _named(members, ratio, names)
    for of, change in scale.scalings.items():
        whole = change / scale.unit
        along = v * (whole @ v) / (v @ v)
        if np.linalg.norm(whole - along) <= SAME * np.linalg.norm(whole):
            return f"{named} can scale the {of} as a whole"
    return f"{named} cannot be told apart"


def _equal(ratio: Floats) -> bool:
    """Return whether all parts are the same, and not 0."""
    return bool((ratio != 0).all() and np.ptp(ratio) <= SAME * np.abs(ratio).max())


def _named(members: Sequence[int], ratio: Floats, names: Sequence[str]) -> str:
    """Return the names of parameters that change in a ratio, or of those that change the most."""
    count, equal = len(members), _equal(ratio)
    if equal and PARTS < count == len(names):
        return f"all {count} parameters"
    if count <= PARTS or (equal and count <= NAMED):
        return enumeration([names[i] for i in members])
    most = sorted(np.argsort(-np.abs(ratio), kind="stable")[:PARTS].tolist())
    named = enumeration([names[members[i]] for i in most])
    return f"{count} parameters, {'among them' if equal else 'most of all'} {named},"


def held(names: Sequence[str], sides: Ints, theta: Floats) -> str:
    """Return which bounds hold a model theta (p,), from ``sides`` (p,) as of `at_bounds`."""
    which = {1: "upper", -1: "lower"}
    some = np.flatnonzero(sides).tolist()
    said = [f"{names[j]} is at its {which[int(sides[j])]} bound {theta[j]:.4g}" for j in some]
    return enumeration(said, SHOWN)


# 6 arguments: whose bounds they are, the most probable model, and that between wider ones.
def bound(
    names: Sequence[str],
    groups: Sequence[str],
    sides: Ints,
    theta: Floats,
    misfit: Floats,
    free: Freed,
) -> Finding | None:
    """Return which bounds exclude what fits the data; None where none does. See `excluding`."""
    wrong = excluding(sides, theta, misfit, free)
    if not wrong:
        return None
    i, at = int(np.argmax(misfit - free.misfit)), held(names, sides, theta)
    where = enumeration([f"{names[j]} = {free.theta[j]:.3g}" for j in wrong], SHOWN)
    errors: dict[str, Any] = {"after": float(free.misfit[i]), "before": float(misfit[i])}
    its, named = "its" if len(wrong) == 1 else "their", enumeration([names[j] for j in wrong])
    return found("bound", named, at=at, where=where, group=str(groups[i]), its=its, **errors)
