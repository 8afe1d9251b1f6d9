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

from itertools import pairwise
from pathlib import Path

import numpy as np

from modefront.inputs import wrong
from modefront.models.dofs import DofTable
from modefront.programs.base import JobOptions, Listed, columns, entries_of, existing
from modefront.programs.inp import Deck, deck_of

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
        row, column, value = columns(files[suffix], None, "iif", comment="#")
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
        notes.append(f"{dead} {'node is' if dead == 1 else 'nodes are'} held: no sensors there")
    mesh = deck.mesh if deck else None
    return Listed((files[".sti"], files[".mas"]), (K, M), dofs, 1e-13, mesh=mesh, notes=notes)


def _table(labels: DofTable, deck: Deck | None) -> DofTable:
    """Return the degrees of freedom with their shares in the motion of their node."""
    alone, leading = _own_nodes(labels, deck)
    # Whether it is not one of those that were made of the node.
    itself = np.isin(labels.node, list(alone)) & (np.arange(labels.size) < leading)
    pairs = np.column_stack([labels.node, labels.direction])
    _, group = np.unique(pairs, axis=0, return_inverse=True)
    nodes, owner = np.unique(labels.node, return_inverse=True)
    of_group = np.bincount(group.ravel(), itself), np.bincount(group.ravel(), ~itself)
    own, made = (count[group.ravel()] for count in of_group)
    most = np.zeros(nodes.size)
    np.maximum.at(most, owner, made)
    # Where the program eliminated one of them, the mean of all is held.
    counted = itself | ((own == 0) & (made == most[owner]))
    node = labels.node.copy()
    if deck is not None:
        node[~np.isin(node, deck.mesh.number)] *= -1
        single = set(nodes[most == 1].tolist()) & (deck.expanded - deck.others - alone)
        # Of what follows a rigid body, the program eliminates all but one of the nodes it makes
        # of a node. What is left does not tell how that moves, nor does the motion that it prints
        # for the reference node agree with that of its degrees of freedom.
        follow = single & {*labels.node[leading:].tolist(), *deck.nodes_of(deck.bodies)}
        follow |= set(deck.nodes_of(deck.guides)) if follow else set()
        held = [pair in deck.held for pair in map(tuple, pairs.tolist())]
        counted &= (node > 0) & ~np.isin(node, list(follow)) & ~np.array(held, bool)
    return DofTable(node, labels.direction, counted / np.where(itself, own, made).clip(1))


def _own_nodes(labels: DofTable, deck: Deck | None) -> tuple[set[int], int]:
    """Return the nodes that move themselves, and the number of degrees of freedom that ascend.

    The program numbers the nodes of the deck before those that it makes of them. So of a node that
    comes again behind the beginning, in which nodes ascend, the first is the node itself.
    """
    node, direction = labels.node, labels.direction
    new = np.append(True, (node[1:] != node[:-1]) | (direction[1:] <= direction[:-1]))
    starts, numbers = np.append(np.flatnonzero(new), node.size), node[new].tolist()
    ascending = (k for k, (one, other) in enumerate(pairwise(numbers), start=1) if other <= one)
    leading = next(ascending, len(numbers))
    own, last = set(numbers[:leading]).intersection(numbers[leading:]), numbers[leading - 1]
    if numbers[leading : leading + 1] == [last] and not (deck and last in deck.others):
        own.remove(last)  # the first of those that are made of it
    return own, int(starts[leading])
