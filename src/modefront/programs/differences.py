r"""Affine terms of matrices from runs of a program at several values of the parameters.

With the parameters as factors of their nominal values, so that all are 1 in the nominal run,

.. math::
    A(\theta) = A_0 + \sum_k c_k(\theta) A_k, \qquad
    A(\theta_r) - A(\mathbb 1) = \sum_k \bigl(c_k(\theta_r) - 1\bigr) A_k,

which the runs r solve for the terms; the base is what is left of the nominal run. A parameter in
which the matrices are linear takes one run, at any factor; one with the functions t and t³ two.
Differences of large numbers are noise where nothing has changed: ``docs/import.md`` says what is
dropped. Terms of few degrees of freedom keep the rank that they have above the rounding.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import connected_components

from modefront._typing import Bools, Floats, Ints
from modefront.errors import Fault, InputError, wrong
from modefront.linalg.affine import Monomials
from modefront.models.dofs import DofTable, name_of
from modefront.models.parameters import BASE, term_exponents
from modefront.programs.base import Job, Matrix, Quantity
from modefront.rounding import ACCUMULATED

AFFINE = 1e-10  # greatest error of the terms at other values of the parameters, over the change
ROUNDING = 20.0  # roundings that may add up in an entry
CANCELLED = 1e-14  # size over the greatest of what has cancelled: some fifty roundings
COVERED = 0.99  # share of an error within the terms of a parameter, from which it may come from it


@dataclass(frozen=True, eq=False)
class Terms:
    """Base and terms of both matrices."""

    parameters: tuple[str, ...]  # names
    # symmetric ones that are not zero, by the names of the terms: `BASE`, and then those of
    # `modefront.models.parameters`
    matrices: Mapping[Quantity, Mapping[str, Matrix]]
    # by the names of the terms without the base: number of degrees of freedom on which each acts,
    # and the rank of its stiffness, or of the mass without one; None if not found
    ranks: Mapping[str, tuple[int, int | None]]
    dofs: DofTable  # degrees of freedom, those of the nominal run

    @property
    def coefficients(self) -> Monomials:
        """Coefficients of the terms without the base."""
        return Monomials(term_exponents([*self.ranks], self.parameters))


class Differences:
    """Matrices of a nominal run, and the differences of other runs from it, added one by one.

    The names of the terms that a matrix may have are given for each quantity.
    """

    def __init__(
        self, nominal: Job, parameters: Sequence[str], terms: Mapping[Quantity, Sequence[str]]
    ) -> None:
        self.parameters, self.names = tuple(parameters), terms
        self.nominal, self.precision = nominal, nominal.precision
        self._runs: list[tuple[Floats, Mapping[Quantity, Matrix]]] = []

    def add(self, label: str, job: Job, values: Floats) -> None:
        """Take the differences of a job at factors (parameters,) of the nominal values.

        Raises InputError where its degrees of freedom are others, or nothing differs.
        """
        order = matching(self.nominal, job, label)
        differences: dict[Quantity, Matrix] = {}
        for quantity, A in self.nominal.matrices.items():
            D = scipy.sparse.coo_array(job.matrices[quantity][order][:, order] - A)
            size, greatest = np.abs(D.data), np.abs(A.data).max(initial=0.0)
            noise = (size <= 1e-13 * greatest) & (size <= 1e-10 * _joint(D, A))
            differences[quantity] = _with(D, ~noise & (D.data != 0))
        if not any(D.nnz for D in differences.values()):
            changed = self._changed(values)
            expected = f"other matrices than those of '{self.nominal.name}', as {changed}"
            found = "the same: did the run fail, or is the change below the digits of the files?"
            raise wrong(label, expected, found)
        self.precision = max(self.precision, job.precision)
        self._runs.append((values, differences))

    def _changed(self, values: Floats) -> str:
        pairs = zip(self.parameters, values, strict=True)
        return ", ".join(f"{name} = {value:g}" for name, value in pairs if value != 1)

    def terms(self) -> Terms:
        """Return base and terms, those that are not zero; raises InputError for missing ones."""
        matrices, ranks = dict[Quantity, dict[str, Matrix]](), dict[str, tuple[int, int | None]]()
        noise = ROUNDING * self.precision
        for quantity, A in self.nominal.matrices.items():
            rest, found = A, dict[str, Matrix]()
            for name, row in zip(self.names[quantity], self._weights(quantity), strict=True):
                term = scipy.sparse.csr_array(A.shape)
                for weight, (_, differences) in zip(row, self._runs, strict=True):
                    if abs(weight) > CANCELLED * np.abs(row).max():
                        term = term + weight * differences[quantity]
                limit = noise * np.abs(row).sum()
                term = _above(_reduced(_above(term.tocsr(), A, limit), A, limit)[0], A, 0.0)
                if term.nnz:
                    found[name], rest = term, rest - term
                    if name not in ranks:
                        ranks[name] = _reduced(term, A, noise)[1:]
            rest = _above(rest.tocsr(), A, noise)
            matrices[quantity] = {BASE: rest, **found} if rest.nnz else found
        idle = ~term_exponents([*ranks], self.parameters).any(axis=0)
        for name in np.array(self.parameters)[idle][:1]:
            raise wrong(str(name), "a term of the stiffness or the mass", "zeros")
        return Terms(self.parameters, matrices, ranks, self.nominal.dofs)

    def _weights(self, quantity: Quantity) -> Floats:
        """Return the weights (terms, runs) of the differences of the runs in each term."""
        names, parameters = self.names[quantity], self.parameters
        of = Monomials(term_exponents(names, parameters))
        c = np.array([of.values(values) - 1.0 for values, _ in self._runs])
        c = c.reshape(len(self._runs), len(names))
        for i, parameter in enumerate(parameters):
            own = np.flatnonzero(of.exponents[:, i] != 0)
            if own.size and (rank := np.linalg.matrix_rank(c[:, own])) < own.size:
                listed = ", ".join(names[k] for k in own.tolist())
                expected = f"at least {own.size} runs with other values for the terms {listed}"
                raise wrong(f"--parameter {parameter}", expected, f"{rank} that tell them apart")
        if not c.size or np.linalg.matrix_rank(c) < c.shape[1]:
            raise wrong("--parameter", f"runs that tell {c.shape[1]} terms apart", f"{len(c)}")
        return np.asarray(np.linalg.pinv(c))

    def check(self, terms: Terms, label: str, job: Job, values: Floats) -> float:
        """Return the relative error of the terms at another job; refuse one that is not affine."""
        order = matching(self.nominal, job, label)
        shifts = terms.coefficients.values(values) - 1.0
        worst = 0.0
        for quantity, A in self.nominal.matrices.items():
            E = change = (job.matrices[quantity][order][:, order] - A).tocsr()
            for name, shift in zip(terms.ranks, shifts, strict=True):
                if name in terms.matrices[quantity]:
                    E = E - shift * terms.matrices[quantity][name]
            noise = ROUNDING * max(self.precision, job.precision)
            noise *= max(1.0, float(np.abs(shifts).max(initial=1.0)))
            entries = scipy.sparse.coo_array(E)
            far = _with(entries, np.abs(entries.data) > noise * _joint(entries, A))
            scale = np.abs(change.data).max(initial=0.0)
            if far.nnz and np.abs(far.data).max() > AFFINE * scale:
                raise self._not_affine(label, values, terms, quantity, far / scale)
            greatest = np.abs(A.data).max(initial=0.0) or 1.0
            worst = max(worst, float(np.abs(E.tocsr().data).max(initial=0.0) / greatest))
        return worst

    def _not_affine(
        self, label: str, values: Floats, terms: Terms, quantity: Quantity, E: Matrix
    ) -> InputError:
        moved = [name for name, x in zip(self.parameters, values, strict=True) if x != 1]
        shares = {name: _share(E, terms, quantity, [name]) for name in moved}
        guilty = [name for name, share in shares.items() if share >= COVERED] or moved
        if _share(E, terms, quantity, moved) < COVERED:
            entries = scipy.sparse.coo_array(E)
            place = terms.dofs.label(int(entries.row[np.abs(entries.data).argmax()]))
            expected = f"only {', '.join(moved)} to differ from '{self.nominal.name}'"
            return wrong(label, expected, f"other changes of the {quantity}, at {place}")
        names, first = " and ".join(f"'{name}'" for name in guilty), guilty[0]
        functions = "*".join(guilty) if len(guilty) > 1 else f"{first},{first}^3"
        expected = f"matrices that are affine in {names} to {AFFINE:g} (or functions of it that "
        expected += f"are declared, as in --function {first}={functions}, with as many runs)"
        found = f"a {quantity} that differs by {np.abs(E.data).max():.2g} of its change at "
        return wrong(label, expected, found + self._changed(values))


def _share(E: Matrix, terms: Terms, quantity: Quantity, names: Sequence[str]) -> float:
    """Return the share of the squares of E within the entries of the terms of parameters."""
    columns = [terms.parameters.index(name) for name in names]
    acting = terms.coefficients.exponents[:, columns].any(axis=1)
    chosen, known = np.array([*terms.ranks])[acting].tolist(), terms.matrices[quantity]
    patterns = (abs(known[name]).sign() for name in chosen if name in known)
    inside = E.multiply(sum(patterns, scipy.sparse.csr_array(E.shape)).sign()).tocsr()
    return float((inside.data**2).sum() / (E.data**2).sum())


def matching(nominal: Job, job: Job, label: str) -> Ints | slice:
    """Return where each nominal degree of freedom is among those of ``job``; refuse others.

    They are matched by node and direction, and those of the same label in their order.
    """
    tables, size = (nominal.dofs, job.dofs), nominal.dofs.size
    if not all((table.node > 0).any() for table in tables):  # there are only numbers
        if size != job.dofs.size:
            expected = f"{size} degrees of freedom, as '{nominal.name}' has"
            raise wrong(label, expected, job.dofs.size)
        return slice(None)
    labels = [np.column_stack([table.node, table.direction]) for table in tables]
    orders = [np.lexsort(each.T[::-1]) for each in labels]
    known = [each[order] for each, order in zip(labels, orders, strict=True)]
    if not np.array_equal(known[0], known[1]):
        expected = f"the degrees of freedom of '{nominal.name}' ({size})"
        before, after = (Counter(map(tuple, labels.tolist())) for labels in known)
        node, direction = min((before - after) or (after - before))
        found = f"{after[node, direction] or 'none'} at node {node} {name_of(direction)}"
        raise wrong(label, expected, f"{found}, {job.dofs.size} in all")
    return np.asarray(orders[1][np.argsort(orders[0])])


def _joint(E: scipy.sparse.coo_array, A: Matrix) -> Floats:
    """Return, for each entry of E, the geometric mean of the diagonal entries of A beside it."""
    scale = np.sqrt(np.abs(A.diagonal()))
    return np.asarray(scale[E.row] * scale[E.col])


def _above(D: Matrix, A: Matrix, noise: float) -> Matrix:
    """Return the entries of D that are above the rounding of those of A at the same places."""
    entries = scipy.sparse.coo_array(D)
    A.sum_duplicates()
    limit = noise * np.abs(np.asarray(A[entries.row, entries.col]).ravel())
    return _with(entries, (np.abs(entries.data) > limit) & (entries.data != 0))


def _with(entries: scipy.sparse.coo_array, chosen: Bools) -> Matrix:
    places = entries.row[chosen], entries.col[chosen]
    return scipy.sparse.coo_array((entries.data[chosen], places), shape=entries.shape).tocsr()


def _reduced(term: Matrix, A: Matrix, noise: float) -> tuple[Matrix, int, int | None]:
    """Return a term of its rank above the rounding, its size and this rank, None for large ones."""
    dofs = np.unique(np.concatenate(term.nonzero()))
    if dofs.size == 0 or dofs.size > 60:  # decomposing many takes long
        return term, dofs.size, None if dofs.size else 0
    values, vectors = np.linalg.eigh(term[dofs][:, dofs].toarray())
    limit = max(noise * float(np.abs(A.diagonal()[dofs]).max()), ACCUMULATED * np.abs(values).max())
    strong = np.abs(values) > limit
    rank = int(strong.sum())
    if rank in (0, dofs.size):
        return term, dofs.size, rank or dofs.size
    part = (vectors[:, strong] * values[strong]) @ vectors[:, strong].T
    part[np.abs(part) <= CANCELLED * np.abs(part).max()] = 0.0
    small = scipy.sparse.coo_array((part + part.T) / 2)
    triplets = small.data, (dofs[small.row], dofs[small.col])
    return scipy.sparse.coo_array(triplets, shape=term.shape).tocsr(), dofs.size, rank


def condensed(terms: Terms) -> tuple[Terms, int, int]:
    """Return the terms without internal degrees of freedom, and how many went and stayed.

    Those that are joined go together, where one term alone acts on them, without mass. Raises
    InputError for Lagrange multipliers: constraints cannot be eliminated so.
    """
    internal = np.flatnonzero(terms.dofs.node < 0)
    if internal.size == 0:
        return terms, 0, 0
    stiffness, mass = dict(terms.matrices["stiffness"]), terms.matrices["mass"]
    inner = {name: abs(A[internal]) for name, A in stiffness.items()}
    zero = np.flatnonzero(sum(A[:, internal].diagonal() for A in inner.values()) == 0)
    if zero.size:
        label = f"node {terms.dofs.node[internal[zero[0]]]}"
        expected = "degrees of freedom with stiffness; constraints with Lagrange multipliers "
        expected += "(contact, connectors, incompressible elements) cannot be imported"
        raise InputError(Fault("", label, expected, f"none at {zero.size} of the program's own"))
    _, group = connected_components(sum(A[:, internal] for A in inner.values()), directed=False)

    def touched(rows: Matrix) -> Bools:
        return np.bincount(group, rows.sum(axis=1)) > 0

    acting = np.column_stack([touched(A) for A in inner.values()])
    heavy = np.any([touched(abs(M[internal])) for M in mass.values()], axis=0)
    alone, gone = (acting.sum(axis=1) == 1) & ~heavy, np.zeros(internal.size, bool)
    for acts, name in zip(acting.T, stiffness, strict=True):
        part = (alone & acts)[group]
        stiffness[name], gone[part] = _eliminated(stiffness[name], internal[part], group[part])
    kept = np.setdiff1d(np.arange(terms.dofs.size), internal[gone])

    both: dict[Quantity, Mapping[str, Matrix]] = {"stiffness": stiffness, "mass": mass}
    rows = {x: {name: A[kept][:, kept].tocsr() for name, A in of.items()} for x, of in both.items()}
    matrices = {x: {name: A for name, A in of.items() if A.nnz} for x, of in rows.items()}
    dofs = DofTable(terms.dofs.node[kept], terms.dofs.direction[kept], terms.dofs.weight[kept])
    return replace(terms, matrices=matrices, dofs=dofs), int(gone.sum()), int((~gone).sum())


def _eliminated(A: Matrix, internal: Ints, groups: Ints) -> tuple[Matrix, Bools]:
    """Return a matrix with the effect of groups of degrees of freedom in it, and which went."""
    order = np.argsort(groups, kind="stable")
    _, starts, sizes = np.unique(groups[order], return_index=True, return_counts=True)
    done, inner = np.zeros(internal.size, bool), A[internal][:, internal].tocsr()
    inverse = scipy.sparse.csr_array(inner.shape)
    for size in np.unique(sizes).tolist():
        members = order[starts[sizes == size][:, None] + np.arange(size)]
        row, column = np.repeat(members, size, axis=1), np.tile(members, (1, size))
        blocks = np.asarray(inner[row.ravel(), column.ravel()]).reshape(-1, size, size)
        singular = np.linalg.svd(blocks, compute_uv=False)
        good = singular[:, -1] > ACCUMULATED * singular[:, 0]
        done[members[good]] = True
        triplets = np.linalg.inv(blocks[good]).ravel(), (row[good].ravel(), column[good].ravel())
        inverse = inverse + scipy.sparse.csr_array(triplets, shape=inner.shape)
    others = np.ones(A.shape[0])
    others[internal[done]] = 0.0
    coupling = A[internal] @ scipy.sparse.diags_array(others)
    return (A - coupling.T @ inverse @ coupling).tocsr(), done
