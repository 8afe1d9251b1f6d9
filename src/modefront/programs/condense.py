r"""Degrees of freedom that belong to no node of the user, eliminated where that is exact.

Where those (i) have no mass, the others (c) move with

.. math:: S = K_{cc} - K_{ci} K_{ii}^{-1} K_{ic},

at every θ as long as all stiffness that acts on i is multiplied by one and the same function of θ:
S then is a part of the term of that function. Groups of such degrees of freedom that do not touch
each other are taken one by one. All others are kept: no result is lost, and none is approximate.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import connected_components

from modefront._typing import Bools, Ints
from modefront.errors import Fault, InputError
from modefront.models.dofs import DofTable
from modefront.programs.base import Matrix, whole
from modefront.programs.differences import Term, Terms
from modefront.rounding import ACCUMULATED


def condensed(terms: Terms) -> tuple[Terms, int, int]:
    """Return the terms without internal degrees of freedom, and how many went and stayed.

    Raises InputError for Lagrange multipliers: constraints cannot be eliminated so.
    """
    internal = np.flatnonzero(terms.dofs.node < 0)
    if internal.size == 0:
        return terms, 0, 0
    stiffness = {name: whole(A) for name, A in terms.of("stiffness").items()}
    mass = terms.of("mass")
    acting = [abs(A[internal][:, internal]) for A in stiffness.values()]
    _, groups = connected_components(sum(acting[1:], acting[0]), directed=False)
    owner = _owners(stiffness, mass, internal, groups)
    diagonal = sum(np.abs(A.diagonal()[internal]) for A in stiffness.values())
    zero = np.flatnonzero(diagonal == 0)
    if zero.size:
        label = f"node {terms.dofs.node[internal[zero[0]]]}"
        expected = "degrees of freedom with stiffness; constraints with Lagrange multipliers "
        expected += "(contact, connectors, incompressible elements) cannot be imported"
        raise InputError(Fault("", label, expected, f"none at {zero.size} of the program's own"))
    gone = np.zeros(internal.size, bool)
    for name in stiffness:
        part = owner[groups] == list(stiffness).index(name)
        if part.any():
            stiffness[name], done = _eliminated(stiffness[name], internal[part], groups[part])
            gone[part] = done
    kept = np.setdiff1d(np.arange(terms.dofs.size), internal[gone])

    def restricted(term: Term) -> Term:
        both = {
            x: stiffness[term.name] if x == "stiffness" else A for x, A in term.matrices.items()
        }
        rows = {x: scipy.sparse.triu(A[kept][:, kept], format="csr") for x, A in both.items()}
        return replace(term, matrices={x: A for x, A in rows.items() if A.nnz})

    dofs = DofTable(terms.dofs.node[kept], terms.dofs.direction[kept], terms.dofs.weight[kept])
    reduced = Terms(
        terms.parameters, restricted(terms.base), tuple(map(restricted, terms.terms)), dofs
    )
    return reduced, int(gone.sum()), int((~gone).sum())


def _owners(
    stiffness: Mapping[str, Matrix], mass: Mapping[str, Matrix], internal: Ints, groups: Ints
) -> Ints:
    """Return for each group the only term that acts on it; -1 where several do, or mass."""
    count = int(groups.max()) + 1
    acting = np.zeros((count, len(stiffness)), bool)
    for column, A in enumerate(stiffness.values()):
        entries = abs(A[internal]).sum(axis=1) > 0
        acting[groups[entries], column] = True
    heavy = np.zeros(count, bool)
    for M in mass.values():
        heavy[groups[abs(whole(M)[internal]).sum(axis=1) > 0]] = True
    alone = (acting.sum(axis=1) == 1) & ~heavy
    return np.where(alone, acting.argmax(axis=1), -1)


def _eliminated(A: Matrix, internal: Ints, groups: Ints) -> tuple[Matrix, Bools]:
    """Return a matrix with the effect of internal degrees of freedom in it, and which went."""
    order = np.argsort(groups, kind="stable")
    _, starts, sizes = np.unique(groups[order], return_index=True, return_counts=True)
    rows, columns, values = [], [], []
    done = np.zeros(internal.size, bool)
    dense = A[internal][:, internal].tocsr()
    for size in np.unique(sizes).tolist():
        members = order[starts[sizes == size][:, None] + np.arange(size)]
        blocks = np.zeros((len(members), size, size))
        position = np.full(internal.size, -1)
        position[members] = np.arange(len(members))[:, None]
        place = np.zeros(internal.size, np.intp)
        place[members] = np.arange(size)
        entries = dense[members.ravel()].tocoo()
        source = members.ravel()[entries.row]
        blocks[position[source], place[source], place[entries.col]] = entries.data
        singular = np.linalg.svd(blocks, compute_uv=False)
        good = singular[:, -1] > ACCUMULATED * singular[:, 0]
        inverse, members = np.linalg.inv(blocks[good]), members[good]
        done[members] = True
        rows.append(np.repeat(members, size, axis=1).ravel())
        columns.append(np.tile(members, (1, size)).ravel())
        values.append(inverse.ravel())
    triplets = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    inverse = scipy.sparse.csr_array(triplets, shape=(internal.size, internal.size))
    others = np.ones(A.shape[0])
    others[internal[done]] = 0.0
    coupling = A[internal] @ scipy.sparse.diags_array(others)
    return (A - coupling.T @ inverse @ coupling).tocsr(), done
