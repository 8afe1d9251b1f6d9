"""What data do not determine, in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modefront._typing import Floats
from modefront.identifiability.combinations import NONE, WEAK, Combination
from modefront.residuals.groups import Group

SAME = 1e-3
"""Difference of two parts of a direction, over its greatest part, below which they are equal."""

PARTS = 5
"""Parameters that a combination of many names, at most."""

SHOWN = 3
"""Directions that are not determined, at most, that a sentence names one by one."""


def in_words(combination: Combination, names: Sequence[str]) -> str:
    """Return a combination as text, its smallest parts left out."""
    v = combination.direction
    order = np.argsort(-np.abs(v), kind="stable")
    parts = [f"{v[i]:+.2f} {names[i]}" for i in order if abs(v[i]) >= 0.1 * abs(v[order[0]])]
    return " ".join(parts[:PARTS]) + " ..." * (len(parts) > PARTS)


def measured_thing(groups: Sequence[Group]) -> str:
    """Return what is measured of these groups: "shape", "frequency" or "residual"."""
    if not any(group.frequency for group in groups):
        return "shape"
    return "residual" if any(group.shape for group in groups) else "frequency"


def determined(combinations: Sequence[Combination]) -> tuple[int, int]:
    """Return how many combinations are determined, and how many of those only weakly."""
    shares = np.array([one.share for one in combinations])
    return int((shares > NONE).sum()), int(((shares > NONE) & (shares < WEAK)).sum())


def summary(
    subject: str, thing: str, combinations: Sequence[Combination], names: Sequence[str]
) -> str:
    """Return one sentence of what a group of data determines.

    ``subject`` are the data in the plural, ``thing`` is what does not change.
    """
    rank, weak = determined(combinations)
    p = len(names)
    text = f"{subject} determine {rank} of {p} combination{'s' * (p > 1)} of parameters"
    if weak:
        text += f", {weak} of them hardly (below {100 * WEAK:g} % of the best): "
        hardly = [one for one in combinations if NONE < one.share < WEAK]
        text += _listed([in_words(one, names) for one in hardly[::-1]])
    if rank == p:
        return text
    free = np.array([one.direction for one in combinations if one.share <= NONE]).T
    said = _listed([direction_in_words(v, names) for v in sparse_basis(free).T])
    return f"{text}; {said}: no {thing} changes"


def _listed(directions: Sequence[str]) -> str:
    more = f"; and {len(directions) - SHOWN} more" if len(directions) > SHOWN else ""
    return "; ".join(directions[:SHOWN]) + more


def direction_in_words(v: Floats, names: Sequence[str]) -> str:
    """Return how parameters can be changed along a direction of relative changes.

    >>> direction_in_words(np.array([0.5, 0.5, 0.0]), ("k1", "k2", "m"))
    'k1 and k2 can be scaled together'
    >>> direction_in_words(np.array([1.0, 0.0, -0.25]), ("k1", "k2", "m"))
    'k1 and m can be changed by powers in the ratio 1 : -0.25'
    """
    v = v / v[np.argmax(np.abs(v))]
    members = np.flatnonzero(np.abs(v) > SAME).tolist()
    if len(members) > PARTS:
        return _of_many(v, members, names)
    named = enumeration([names[i] for i in members])
    if len(members) == 1:
        return f"{named} can be changed alone"
    if (np.abs(v[members] - 1) <= SAME).all():
        return f"{named} can be scaled together"
    return f"{named} can be changed by powers in the ratio " + " : ".join(
        f"{v[i]:.3g}" for i in members
    )


def _of_many(v: Floats, members: Sequence[int], names: Sequence[str]) -> str:
    """Return the same of more parameters than are named."""
    if (np.abs(v[members] - 1) <= SAME).all():
        if len(members) == len(names):
            return f"all {len(names)} parameters can be scaled together"
        return f"{enumeration([names[i] for i in members])} can be scaled together"
    most = sorted(np.argsort(-np.abs(v), kind="stable")[:PARTS].tolist())
    return (
        f"{len(members)} parameters, most of all {enumeration([names[i] for i in most])}, "
        "can be changed by powers in a fixed ratio"
    )


def enumeration(names: Sequence[str]) -> str:
    """Return names as a text: "a, b and c"."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def sparse_basis(N: Floats) -> Floats:
    """Return a basis of the span of the columns of N (p, d) that can be said simply.

    First single parameters; then, if it is in the span, the scaling of all others together; the
    rest has as many zeros as elimination makes.
    """
    p, d = N.shape
    Q = np.linalg.qr(N)[0]
    alone = [j for j in range(p) if np.linalg.norm(Q[j]) > 1 - SAME**2 / 2]
    basis = [np.eye(p)[j] for j in alone]
    others = np.setdiff1d(np.arange(p), alone)
    ones = np.zeros(p)
    ones[others] = 1.0
    outside = ones - Q @ (Q.T @ ones)
    if len(basis) < d and np.linalg.norm(outside) <= SAME * np.linalg.norm(ones):
        basis.append(ones)
    known = np.array(basis).reshape(-1, p).T
    if known.size:
        rest = Q - known @ np.linalg.lstsq(known, Q, rcond=None)[0]
        Q = np.linalg.svd(rest, full_matrices=False)[0][:, : d - known.shape[1]]
    return np.column_stack([known, _eliminate(Q.T).T])


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
