"""Findings on identifiability as sentences."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from modefront._typing import Floats
from modefront.identifiability.collinearity import pairs
from modefront.identifiability.combinations import NONE, WEAK, Combination
from modefront.identifiability.scale import Scale
from modefront.residuals.groups import Group

SAME = 1e-3
"""Difference of two parts of a direction, over its greatest part, below which they are equal."""

PARTS = 5
"""Parameters that a combination of many names, at most."""

NAMED = 20
"""Parameters that change alike, at most, that are named one by one."""

TOGETHER = 3
"""Parameters alike of which pairs are named, at most."""

MOST = 100
"""Combinations that are not determined, beyond which they are counted and not listed: a
simple basis of them takes the fourth power of their number."""

SHOWN = 3
"""Directions that are not determined, at most, that a sentence names one by one."""


def in_words(combination: Combination, names: Sequence[str]) -> str:
    """Return a combination as text, its smallest parts left out."""
    v = combination.direction
    order = np.argsort(-np.abs(v), kind="stable")
    parts = [f"{v[i]:+.2f} {names[i]}" for i in order if abs(v[i]) >= 0.1 * abs(v[order[0]])]
    return " ".join(parts[:PARTS]) + " ..." * (len(parts) > PARTS)


def measured_noun(groups: Sequence[Group]) -> str:
    """Return the noun for the data of groups: their kind of residual, "residual" for several."""
    kinds = {kind for group in groups for kind, _ in group.chosen}
    return kinds.pop() if len(kinds) == 1 else "residual"


def determined(combinations: Sequence[Combination]) -> tuple[int, int]:
    """Return how many combinations are determined, and how many of those only weakly."""
    shares = np.array([combination.share for combination in combinations])
    return int((shares > NONE).sum()), int(((shares > NONE) & (shares < WEAK)).sum())


def summary(
    subject: str,
    noun: str,
    combinations: Sequence[Combination],
    names: Sequence[str],
    scale: Scale | None = None,
    idle: Sequence[int] = (),
) -> str:
    """Return one sentence of what a group of data determines.

    ``subject`` are the data in the plural, ``noun`` names what does not change; ``idle`` are
    parameters without effect on any data, which are left out. Without a ``scale``, changes are
    relative to the parameters.
    """
    rank, weak = determined(combinations)
    p = len(names) - len(idle)
    text = f"{subject} determine {rank} of {p} combination{'s' * (p > 1)} of parameters"
    text += " that have an effect" if idle else ""
    if weak:
        text += f", {weak} of them hardly (below {100 * WEAK:g} % of the best): "
        hardly = [combination for combination in combinations if NONE < combination.share < WEAK]
        text += _listed([in_words(combination, names) for combination in hardly[::-1]])
    if rank >= p:
        return text
    free = _listed(free_in_words(combinations, names, scale, idle))
    return f"{text}; {free}: no {noun} changes"


def free_in_words(
    combinations: Sequence[Combination],
    names: Sequence[str],
    scale: Scale | None = None,
    idle: Sequence[int] = (),
) -> list[str]:
    """Return the combinations that are not determined, each as text; see `summary`."""
    scale = scale or _relative(len(names))
    free = np.array(
        [combination.direction for combination in combinations if combination.share <= NONE]
    ).T
    free[list(idle)] = 0.0
    lam, V = np.linalg.eigh(free.T @ free)
    kept = free @ V[:, lam > 0.5]  # parameters without effect are directions of their own
    if not kept.size:
        return []
    if kept.shape[1] > MOST:
        return [f"{kept.shape[1]} combinations of parameters can be changed"]
    whole = [scaling.change / scale.unit for scaling in scale.scalings]
    whole.append(scale.theta / scale.unit)
    shares = np.array([combination.share for combination in combinations])
    V = np.array([combination.direction for combination in combinations])

    def holds(v: Floats) -> bool:
        return bool(np.linalg.norm(shares * (V @ v)) <= 3 * NONE * np.linalg.norm(v))

    return [direction_in_words(v, names, scale) for v in sparse_basis(kept, whole, holds).T]


def _relative(p: int) -> Scale:
    """Return the scale of changes that are relative to positive parameters."""
    return Scale(np.ones(p), np.ones(p), np.ones(p, dtype=bool))


def no_effect_in_words(idle: Sequence[int], names: Sequence[str]) -> list[str]:
    """Return the sentence on parameters without effect, if there are any."""
    if not idle:
        return []
    single = len(idle) == 1
    named = enumeration([names[i] for i in idle]) if len(idle) <= NAMED else f"{len(idle)} of them"
    return [
        f"{named} {'has' if single else 'have'} no effect: no residual changes with "
        f"{'it' if single else 'any of them'}; keep {'it' if single else 'them'} at the nominal "
        f"value{'' if single else 's'}, or measure what {'it changes' if single else 'they change'}"
    ]


def alike_in_words(gram: Floats, names: Sequence[str], idle: Sequence[int] = ()) -> list[str]:
    """Return sentences on parameters that act nearly alike, from G^T G; those ``idle`` are none.

    Sets of more than `TOGETHER` parameters of which every two are alike are said at once.
    """
    alike = {(i, j): value for i, j, value in pairs(gram) if not {i, j} & set(idle)}
    sets: list[list[int]] = []
    for pair in alike:
        if not any(set(pair) <= set(parameters) for parameters in sets):
            sets.append(list(pair))
            for k in range(len(names)):
                if all((min(i, k), max(i, k)) in alike for i in sets[-1]):
                    sets[-1].append(k)
    out = []
    for parameters in sets:
        within = {pair: value for pair, value in alike.items() if set(pair) <= set(parameters)}
        if len(parameters) > TOGETHER:
            named = [names[i] for i in sorted(parameters)]
            listed = (
                enumeration(named) if len(parameters) <= NAMED else f"{len(parameters)} parameters"
            )
            out.append(
                f"{listed} have nearly the same effect on all residuals: fix or tie all but one"
            )
            alike = {pair: value for pair, value in alike.items() if pair not in within}
    return out + [
        f"{names[i]} and {names[j]} have nearly the same effect on all residuals: fix or tie one"
        for i, j in alike
    ]


def _listed(directions: Sequence[str]) -> str:
    more = f"; and {len(directions) - SHOWN} more" if len(directions) > SHOWN else ""
    return "; ".join(directions[:SHOWN]) + more


def direction_in_words(v: Floats, names: Sequence[str], scale: Scale | None = None) -> str:
    """Return how parameters can be changed along a direction, in units of a scale.

    >>> direction_in_words(np.array([0.5, 0.5, 0.0]), ("k1", "k2", "m"))
    'k1 and k2 can be scaled together'
    >>> direction_in_words(np.array([1.0, 0.0, -0.25]), ("k1", "k2", "m"))
    'k1 and m can be changed by powers in the ratio 1 : -0.25'
    """
    scale = scale or _relative(len(names))
    v = v / np.abs(v).max()
    members = np.flatnonzero(np.abs(v) > SAME).tolist()
    if len(members) == 1:
        return f"{names[members[0]]} can be changed alone"
    amounts = (v * scale.unit)[members]
    theta = scale.theta[members]
    powers = amounts / np.where(theta == 0, np.inf, theta)
    if _equal(powers):
        return f"{_named(members, powers, names)} can be scaled together"
    positive = bool(scale.positive[members].all())
    kind, ratio = ("powers", powers) if positive else ("amounts", amounts)
    ratio = ratio / ratio[np.argmax(np.abs(ratio))]
    if kind == "amounts" and _equal(ratio):
        how = "equal amounts"
    elif len(members) > PARTS:
        how = "amounts that compensate each other"
    else:
        how = f"{kind} in the ratio " + " : ".join(f"{x:.3g}" for x in ratio)
    return f"{_named(members, ratio, names)} can be changed by {how}" + _meaning(v, scale)


def _equal(ratio: Floats) -> bool:
    """Return whether all parts are the same, and not 0."""
    return bool((ratio != 0).all() and np.ptp(ratio) <= SAME * np.abs(ratio).max())


def _named(members: Sequence[int], ratio: Floats, names: Sequence[str]) -> str:
    """Return the names of parameters that change in a ratio, or of those that change the most."""
    if len(members) > PARTS and _equal(ratio) and len(members) == len(names):
        return f"all {len(names)} parameters"
    if len(members) <= PARTS or (_equal(ratio) and len(members) <= NAMED):
        return enumeration([names[i] for i in members])
    most = sorted(np.argsort(-np.abs(ratio), kind="stable")[:PARTS].tolist())
    named = enumeration([names[members[i]] for i in most])
    return f"{len(members)} parameters, {'among them' if _equal(ratio) else 'most of all'} {named},"


def _meaning(v: Floats, scale: Scale) -> str:
    """Return the effect of a direction that scales a matrix as a whole."""
    for scaling in scale.scalings:
        whole = scaling.change / scale.unit
        along = v * (whole @ v) / (v @ v)
        if np.linalg.norm(whole - along) <= SAME * np.linalg.norm(whole):
            return f", which scales the {scaling.of} as a whole"
    return ""


def enumeration(names: Sequence[str]) -> str:
    """Return names as a text: "a, b and c"."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def sparse_basis(
    N: Floats,
    whole: Sequence[Floats] | None = None,
    holds: Callable[[Floats], bool] = lambda _: True,
) -> Floats:
    """Return a basis of the span of the columns of N (p, d) of directions that are short in words.

    First single parameters; then those of the directions ``whole`` (p,) that are in the span, by
    default the scaling of all other parameters together; then pairs of parameters; the rest has
    as many zeros as elimination makes. ``holds`` tells whether a simple direction is not
    determined indeed.
    """
    p, d = N.shape
    Q = np.linalg.qr(N)[0]
    outside = np.eye(p) - Q @ Q.T
    alone = [j for j in range(p) if outside[j, j] <= SAME**2 and holds(np.eye(p)[j])]
    basis = [np.eye(p)[j] for j in alone]
    for direction in [np.ones(p)] if whole is None else whole:
        others = direction.copy()
        others[alone] = 0.0
        size = float(np.linalg.norm(others))
        if size > 0 and np.linalg.norm(outside @ others) <= SAME * size and holds(others):
            basis = _longer(basis, others / size)
    for v in _pairs_within(outside, alone):
        if len(basis) < d and holds(v):
            basis = _longer(basis, v)
    for row in sorted(_eliminate(Q.T), key=lambda row: int((np.abs(row) > SAME).sum())):
        basis = _longer(basis, row / np.linalg.norm(row)) if len(basis) < d else basis
    return np.array(basis).T


def _longer(basis: list[Floats], v: Floats) -> list[Floats]:
    """Return a basis with another direction of length 1, if that does not depend on it."""
    longer = [*basis, v]
    return longer if np.linalg.matrix_rank(np.array(longer), tol=SAME) == len(longer) else basis


def _pairs_within(outside: Floats, alone: Sequence[int]) -> list[Floats]:
    """Return the directions of two parameters that a projector (p, p) takes to nothing."""
    p, out = len(outside), []
    d = np.diag(outside)
    # The lesser eigenvalue of two rows and columns, but for rounding, rules most pairs out at once.
    mean, half = np.add.outer(d, d) / 2, np.subtract.outer(d, d) / 2
    possible = np.triu(mean - np.hypot(half, outside) <= 2 * SAME**2, 1)
    possible[list(alone)] = possible[:, list(alone)] = False
    for i, j in np.argwhere(possible).tolist():
        lam, V = np.linalg.eigh(outside[np.ix_([i, j], [i, j])])
        if lam[0] <= SAME**2:
            v = np.zeros(p)
            v[[i, j]] = V[:, 0] * np.sign(V[np.argmax(np.abs(V[:, 0])), 0])
            out.append(v)
    return out


def _eliminate(rows: Floats) -> Floats:
    """Return the reduced echelon form of rows, pivots chosen by size."""
    rows = rows.copy()
    for i in range(len(rows)):
        block = np.abs(rows[i:])
        r, c = divmod(int(np.argmax(block)), block.shape[1])
        rows[[i, i + r]] = rows[[i + r, i]]
        rows[i] /= rows[i, c]
        for k in range(len(rows)):
            if k != i:
                rows[k] -= rows[k, c] * rows[i]
    return rows
