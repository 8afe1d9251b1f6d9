"""Nastran: matrices of OUTPUT4 (``.op4``) or DMIG entries (``.pch``).

OUTPUT4 has no numbers of nodes: the deck beside it tells which degrees of freedom are in the a-set
(see `modefront.programs.bulk`). What it tells is accepted only if the matrices agree: there are as
many rows, and a translation of the whole strains nothing but elements that are held somewhere.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import scipy.sparse

from modefront._typing import Bools, Floats, Ints
from modefront.errors import reason
from modefront.inputs import wrong
from modefront.models.dofs import DofTable
from modefront.programs.base import JobOptions, Matrix, ProgramMesh
from modefront.programs.bulk import Bulk, read_bulk
from modefront.programs.nastran_files import read_dmig, read_op4
from modefront.programs.reading import Listed, entries_of, existing, given_table, unlabelled

DECKS = (".dat", ".bdf", ".nas", ".inp")
MATRICES = (".op4", ".pch")

SETS = ("AA", "AAX", "LL", "XX", "HH", "GG", "JJ", "2GG", "")
"""Names of pairs of matrices behind K and M, the first that there is being taken."""

ADVICE = "OUTPUT4 KAA,MAA,,,//-1/21 writes an .op4 file, EXTSEOUT or PARAM,EXTOUT,DMIGPCH a .pch"


def read(path: Path, options: JobOptions) -> Listed:
    """Return the matrices of a job, given by its .op4 or .pch file, or without suffix.

    A file with another suffix that is no deck, such as that of a Fortran unit, is one of OUTPUT4.
    """
    deck = path.suffix.lower() in DECKS
    file = path
    if not (path.suffix.lower() in MATRICES or (path.is_file() and not deck)):
        job = path.with_suffix("") if deck else path
        files = [job.with_name(job.name + suffix) for suffix in MATRICES]
        file = next((each for each in files if each.is_file()), files[0])
    file = existing(file, "matrices of Nastran", ADVICE)
    return (_from_dmig if file.suffix.lower() == ".pch" else _from_op4)(file, options)


def _pair(path: Path, names: Iterable[str], options: JobOptions) -> tuple[str, str]:
    known = list(names)
    if options.stiffness or options.mass:
        pair = (options.stiffness or "").upper(), (options.mass or "").upper()
    else:
        pairs = [(f"K{name}", f"M{name}") for name in SETS]
        pairs += [(x, "M" + x[1:]) for x in known if x.startswith("K")]
        pair = next((x for x in pairs if x[0] in known and x[1] in known), ("KAA", "MAA"))
    for name in pair:
        if name not in known:
            expected = f"a matrix '{name}'" if name else "--stiffness-name with --mass-name"
            raise wrong(path, expected, f"matrices {', '.join(known) or 'none'}")
    return pair


def _deck(path: Path, options: JobOptions, notes: list[str]) -> Bulk | None:
    deck = options.deck or next((x for x in map(path.with_suffix, DECKS) if x.is_file()), None)
    if deck is None:
        notes.append(f"there is no deck ({path.stem}.dat or .bdf), and so there are no coordinates")
        return None
    try:
        return read_bulk(deck)
    except OSError as error:
        raise wrong(deck, "a deck that can be read", reason(error)) from None


def _from_op4(path: Path, options: JobOptions) -> Listed:
    matrices = read_op4(path)
    names = _pair(path, matrices, options)
    (K, _), (M, _) = pair = [matrices[name] for name in names]
    size = K.shape[0]
    for name, (A, _) in zip(names, pair, strict=True):
        if A.shape != (size, size) or not size:
            expected = f"'{name}' with {size or 'some'} rows and columns"
            raise wrong(path, expected, " x ".join(map(str, A.shape)))
    deck = _deck(path, options, notes := list[str]())
    dofs = given_table(options, size) or unlabelled(size)
    precision = max(each for _, each in pair)
    listed = Listed((path, path), (K, M), dofs, precision, notes=notes)
    return listed if deck is None or options.dofs else _labelled(listed, deck, notes)


def _labelled(listed: Listed, deck: Bulk, notes: list[str]) -> Listed:
    """Return a job with nodes and components of the deck, of which some may be held."""
    path, size = listed.files[0], listed.dofs.size
    choices = {
        "all nodes": deck.dofs(reduced=False, singular=True),
        "its free degrees of freedom": deck.dofs(reduced=True, singular=True),
        "its free degrees of freedom that are stiff": deck.dofs(reduced=True, singular=False),
    }
    fitting = [dofs for dofs in choices.values() if len(dofs) == size]
    if not fitting:
        counts = ", ".join(f"{len(dofs)} for {name}" for name, dofs in choices.items())
        expected = f"{size} degrees of freedom, as the matrices have, in the deck (or --dofs FILE)"
        raise wrong(path, expected, counts)
    node, direction = np.array(fitting[0], dtype=np.intp).reshape(-1, 2).T
    dofs = DofTable(node, direction, np.ones(size))
    unheld = np.array([dof not in deck.held | deck.followers for dof in fitting[0]])

    def free(K: Matrix, M: Matrix) -> Bools:
        rows: Bools = unheld & (K.diagonal() + M.diagonal() != 0)
        _check_labels(path, deck, K, dofs, rows)
        return rows

    if deck.turned:
        some = ", ".join(map(str, sorted(deck.turned)[:6]))
        notes.append(f"directions are those of the nodes' own systems at node {some}")
    return replace(listed, dofs=dofs, free=free, mesh=_drawn(deck, notes))


def _drawn(deck: Bulk, notes: list[str]) -> ProgramMesh | None:
    if np.isfinite(deck.mesh.coordinates).all():
        return deck.mesh
    notes.append("nodes in coordinate systems of their own (CP): coordinates are left out")
    return None


def _check_labels(path: Path, deck: Bulk, K: Matrix, dofs: DofTable, free: Bools) -> None:
    moving = set(zip(dofs.node[free].tolist(), dofs.direction[free].tolist(), strict=True))
    held = {n for n in deck.mesh.number.tolist() if any((n, c) not in moving for c in (1, 2, 3))}
    held |= deck.turned | {n for n, _ in deck.followers} | set(deck.scalar)
    for _ in range(2 if deck.followers else 1):  # followers join elements of their masters
        held |= {n for link in deck.joined if held.intersection(link) for n in link}
    strained = free & ~np.isin(dofs.node, list(held))
    for direction in (1, 2, 3):
        r = (free & (dofs.direction == direction)).astype(float)
        force, size = K @ r, abs(K) @ r
        bad = (np.abs(force) > 1e-6 * size) & (size > 0) & strained  # less is rounding
        if bad.any():
            k = int(np.argmax(np.abs(force) * bad))
            raise wrong(
                path,
                "a stiffness matrix that fits the nodes of the deck; --dofs FILE says which "
                "degrees of freedom its rows are",
                f"a force at {dofs.label(k)} in a translation of the whole",
            )


def _from_dmig(path: Path, options: JobOptions) -> Listed:
    matrices = read_dmig(path)
    K, M = (matrices[name] for name in _pair(path, matrices, options))
    table = np.unique(np.concatenate([K[0].reshape(-1, 2), M[0].reshape(-1, 2)]), axis=0)
    keys = table @ [10, 1]

    def numbered(labels: Ints, value: Floats, _: float) -> scipy.sparse.coo_array:
        row, column = np.searchsorted(keys, labels.reshape(-1, 2, 2) @ [10, 1]).T
        return entries_of(row, column, value, keys.size)

    deck = _deck(path, options, notes := list[str]())
    return Listed(
        (path, path),
        (numbered(*K), numbered(*M)),
        DofTable(table[:, 0], table[:, 1], np.ones(len(table))),
        K[2],
        counted=False,
        mesh=_drawn(deck, notes) if deck else None,
        notes=notes,
    )
