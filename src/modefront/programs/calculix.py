r"""CalculiX: ``*FREQUENCY, SOLVER=MATRIXSTORAGE`` writes ``.sti``, ``.mas`` and ``.dof``.

The matrices are upper triangles as text, with the same pattern; ``.dof`` names node and direction
of each row. CalculiX makes solids of shells, beams, membranes and trusses: their nodes become two
or more through the thickness, which all keep the number of the node. So a label stands for several
degrees of freedom,

.. math:: u_\text{node} = \tfrac1n \sum_k u_k,

unless the node itself is there too, as where a mass, a spring or a solid is attached: it is the
mean already. What the program writes for nodes that are not in the deck (knots, incompatible
modes) moves with the model, and belongs to no node.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import numpy as np

from modefront.inputs import wrong
from modefront.models.dofs import DofTable
from modefront.programs.base import JobOptions
from modefront.programs.inp import Deck, deck_of
from modefront.programs.reading import Listed, columns, entries_of, existing

SUFFIXES = (".inp", ".sti", ".mas", ".dof", ".dat", ".frd")

ADVICE = (
    "the deck needs *FREQUENCY, SOLVER=MATRIXSTORAGE; look for *ERROR in what ccx prints, as it "
    "may leave with status 0 nevertheless"
)


def read(path: Path, options: JobOptions) -> Listed:
    """Return the matrices of a job, given with or without a suffix."""
    job = path.with_suffix("") if path.suffix in SUFFIXES else path
    files = {suffix: job.with_name(job.name + suffix) for suffix in (".dof", ".sti", ".mas")}
    for file in files.values():
        existing(file, "a matrix or table of CalculiX", ADVICE)
    labels = columns(files[".dof"], ".", "ii", comment="#")
    node, direction = (column.astype(np.intp) for column in labels)
    matrices = []
    for suffix in (".sti", ".mas"):
        row, column, value = columns(files[suffix], r"\s+", "iif", comment="#")
        last = max(int(row.max(initial=0)), int(column.max(initial=0)))
        if last != node.size:
            expected = f"entries up to row {node.size}, as '{files['.dof'].name}' has"
            raise wrong(files[suffix], expected, f"entries up to row {last}; is it cut off?")
        matrices.append(entries_of(row - 1, column - 1, value, node.size))
    K, M = matrices
    if not (np.array_equal(K.row, M.row) and np.array_equal(K.col, M.col)):
        expected = f"entries at the places of '{files['.sti'].name}', one after the other"
        found = f"{M.nnz} in place of {K.nnz}, or others; is one of them cut off?"
        raise wrong(files[".mas"], expected, found)
    own, notes = job.with_name(job.name + ".inp"), list[str]()
    missing = ", and held nodes of shells and beams cannot be told from others"
    deck = deck_of(options.deck or own, notes, missing)
    if deck is not None and own.is_file() and own.stat().st_mtime > files[".sti"].stat().st_mtime:
        notes.append(f"{job.name}.inp is newer than {job.name}.sti: was it run since?")
    dofs = _table(DofTable(node, direction, np.ones(node.size)), deck)
    shared = np.unique(dofs.node[(dofs.weight > 0) & (dofs.weight < 1)]).size
    if shared:
        notes.append(f"{shared} nodes of shells and beams are means of the nodes made of them")
    if internal := int((dofs.node <= 0).sum()):
        notes.append(f"{internal} degrees of freedom that the program made belong to no node")
    nodes = np.unique(dofs.node[dofs.node > 0])
    if dead := np.setdiff1d(nodes, dofs.node[dofs.weight != 0]).size:
        notes.append(f"{dead} nodes are held: there are no sensors at them")
    mesh = deck.mesh if deck else None
    return Listed((files[".sti"], files[".mas"]), (K, M), dofs, 1e-13, mesh=mesh, notes=notes)


def _table(labels: DofTable, deck: Deck | None) -> DofTable:
    """Return the degrees of freedom with their shares in the motion of their node."""
    node, direction = labels.node.copy(), labels.direction
    if deck is not None:
        node[~np.isin(node, deck.mesh.number)] *= -1
    weight = np.zeros(node.size)
    blocks, leading = _own_blocks(labels, deck)
    order = np.lexsort((direction, labels.node))
    keys = np.column_stack([labels.node, direction])[order]
    starts = np.flatnonzero((keys[1:] != keys[:-1]).any(axis=1)) + 1
    parts, most = {}, dict[int, int]()
    for group in np.split(order, starts):  # of the node itself, and those that were made of it
        number, along = int(labels.node[group[0]]), int(direction[group[0]])
        first, behind = blocks.get(number, (0, 0))
        inside = (group >= first) & (group < behind)
        parts[number, along] = group[inside], group[~inside]
        most[number] = max(most.get(number, 0), int((~inside).sum()))
    follow = _followers(labels, deck, blocks, most, leading)
    known = set() if deck is None else set(deck.mesh.number.tolist())
    for (number, along), (itself, made) in parts.items():
        if deck and (number not in known or number in follow or (number, along) in deck.held):
            continue
        if itself.size:
            weight[itself] = 1.0 / itself.size
        elif made.size == most[number]:  # else the program eliminated one: the mean of all is held
            weight[made] = 1.0 / made.size
    return DofTable(node, direction, weight)


def _followers(
    labels: DofTable,
    deck: Deck | None,
    blocks: Mapping[int, tuple[int, int]],
    most: Mapping[int, int],
    leading: int,
) -> set[int]:
    """Return the nodes of shells and beams that follow a rigid body, and its reference nodes.

    The program eliminates all but one of the nodes that it makes of such a node. What is left does
    not tell how the node moves, nor does the motion that it prints for the reference node agree
    with that of its degrees of freedom. ``leading`` degrees of freedom are of nodes themselves.
    """
    if deck is None:
        return set()
    single = {n for n in deck.expanded - deck.others - blocks.keys() if most.get(n) == 1}
    behind = set(labels.node[leading:].tolist())
    out = single & (behind | set(deck.nodes_of(deck.bodies)))
    return out | set(deck.nodes_of(deck.guides)) if out else out


def _own_blocks(labels: DofTable, deck: Deck | None) -> tuple[dict[int, tuple[int, int]], int]:
    """Return the degrees of freedom (first, one behind the last) of nodes that move themselves.

    The second value is the number of degrees of freedom at the beginning whose nodes ascend.

    The program numbers the nodes of the deck before those that it makes of them. So the first block
    of a node whose other blocks follow later is the node itself.
    """
    node, direction = labels.node, labels.direction
    new = np.append(True, (node[1:] != node[:-1]) | (direction[1:] <= direction[:-1]))
    starts = np.append(np.flatnonzero(new), node.size).tolist()
    blocks = [(int(node[first]), first, last) for first, last in pairwise(starts)]
    places_of: dict[int, list[int]] = {}
    for k, (number, _, _) in enumerate(blocks):
        places_of.setdefault(number, []).append(k)
    pairs = enumerate(pairwise(blocks), start=1)
    leading = next((k for k, (one, other) in pairs if other[0] <= one[0]), len(blocks))
    out = {}
    for number, places in places_of.items():
        if len(places) < 2 or places[0] >= leading:
            continue
        apart = places[1] > places[0] + 1
        attached = deck is not None and number in deck.others and places[0] == leading - 1
        if apart or attached:
            out[number] = blocks[places[0]][1:]
    return out, blocks[leading - 1][2] if leading else 0
