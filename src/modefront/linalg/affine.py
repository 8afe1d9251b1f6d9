r"""Matrices that depend on the parameters through products of powers.

.. math::
    A(\theta) = \sum_j c_j(\theta) A_j, \qquad
    c_j(\theta) = \prod_i (\theta_i - \theta_{0i})^{e_{ji}}

The origin :math:`\theta_0` is 0 but for matrices of which only values and first derivatives at one
:math:`\theta_0` are known, and are exact there. All terms share one storage (dense, or one sparsity
pattern), so that assembly is one matrix-vector product with the data of the terms.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from itertools import pairwise
from typing import Self

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array, sparray

from modefront._typing import Bools, Floats, Ints, Ints32
from modefront.linalg.products import gram, times

ROWS = 2**15  # rows of a term that are projected at once, to bound the memory
FEW = 2**10  # rows that are added at once, which stay in the cache
SPARSE = 1.5  # fraction of zero rows above which the rows are compressed


def first_axis(A: Floats, B: Floats) -> Floats:
    """Return sum_j A_ij B_j for a matrix A (m, k) and an array B (k, ...), shape (m, ...)."""
    return (A @ B.reshape(len(B), -1)).reshape(len(A), *B.shape[1:])


@dataclass(frozen=True)
class Monomials:
    """Coefficients c_j(theta) = prod_i (theta_i - origin_i) ** exponents[j, i]."""

    exponents: Floats  # (terms, parameters) e
    origin: Floats | float = 0.0  # (parameters,) theta_0

    @cached_property
    def _constant(self) -> Floats | None:
        """1 of each coefficient that is constant, where all others are parameters; else None."""
        e = self.exponents
        linear = np.isin(e, (0, 1)).all() and (e.sum(axis=1) <= 1).all()
        return np.asarray(1.0 - e.any(axis=1)) if linear else None

    @cached_property
    def varies(self) -> bool:
        """Whether any coefficient depends on a parameter."""
        return bool(self.exponents.any())

    @property
    def curved(self) -> bool:
        """Whether any coefficient has second derivatives."""
        return bool(self._second[0].size)

    @cached_property
    def _second(self) -> tuple[Ints, Ints, Ints, Floats, Floats]:
        """Second derivatives that are not zero, as factors times products of powers.

        Returns terms, parameters i and j, factors (all of the same shape) and exponents (.., p).
        """
        e = self.exponents
        used = e != 0
        j, i, k = np.nonzero(used[:, :, None] & used[:, None])
        factor = e[j, i] * np.where(i == k, e[j, i] - 1, e[j, k])
        j, i, k, factor = (x[factor != 0] for x in (j, i, k, factor))
        lowered, row = e[j], np.arange(j.size)
        lowered[row, i] -= 1
        lowered[row, k] -= 1
        return j, i, k, factor, lowered

    def second_derivatives(self, theta: Floats, forms: Floats) -> Floats:
        """Return sum_j f_j d2 c_j / dtheta_i dtheta_k for each row f of forms (n, terms)."""
        j, i, k, factor, lowered = self._second
        out = np.zeros((len(forms), theta.size, theta.size))
        values = forms[:, j] * (factor * np.prod((theta - self.origin) ** lowered, axis=1))
        np.add.at(out.transpose(1, 2, 0), (i, k), values.T)
        return out

    def held(self, fixed: Mapping[int, float], tied: Mapping[int, int]) -> tuple[Self, Floats]:
        """Return the coefficients of the other parameters, and a factor (terms,) for each term.

        ``fixed`` parameters have one value, and ``tied`` ones that of another parameter. The origin
        has to be 0.
        """
        e, factors = self.exponents.copy(), np.ones(len(self.exponents))
        for j, value in fixed.items():
            factors *= value ** e[:, j]
        for j, i in tied.items():
            e[:, i] += e[:, j]
        return replace(self, exponents=np.delete(e, [*fixed, *tied], axis=1)), factors

    def values(self, theta: Floats) -> Floats:
        """Return c(theta), shape (terms,)."""
        theta = theta - self.origin
        if self._constant is not None:
            return self._constant + self.exponents @ theta
        return np.prod(theta**self.exponents, axis=1)

    def jacobian(self, theta: Floats) -> Floats:
        """Return dc/dtheta, shape (terms, parameters)."""
        e = self.exponents
        if self._constant is not None:
            return e
        out = np.zeros(e.shape)
        for i in np.flatnonzero(e.any(axis=0)):
            lowered = e.copy()
            lowered[:, i] = np.where(e[:, i] == 0, 0, e[:, i] - 1)
            out[:, i] = e[:, i] * np.prod((theta - self.origin) ** lowered, axis=1)
        return out


@dataclass(frozen=True, eq=False)
class Members:
    """What each of several members adds to the terms of a matrix: R^T A R, R its rows."""

    of: str  # the matrix, "stiffness" or "mass"
    group: str  # what they are of; empty for none
    nodes: Ints  # (members, ...) between which each is
    rows: csr_array  # (members k, N) all R, one below the other
    shares: Sequence[tuple[Ints, Floats]]  # terms they add to, (members,), and A (members, k, k)


@dataclass(frozen=True)
class DenseAffine:
    """A(theta) with dense terms, shape (terms, N, N)."""

    terms: Floats
    coefficients: Monomials

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return int(self.terms.shape[1])

    @property
    def used(self) -> Bools:
        """Which parameters the matrix depends on, shape (parameters,)."""
        nonzero = self.terms.any(axis=(1, 2))
        return np.asarray(self.coefficients.exponents[nonzero].any(axis=0))

    def at(self, theta: Floats) -> Floats:
        """Return A(theta), shape (N, N)."""
        return first_axis(self.coefficients.values(theta)[None], self.terms)[0]

    def derivatives_times(self, theta: Floats, vectors: Floats) -> Floats:
        """Return dA/dtheta_i V for vectors V of shape (N, m); the result is (N, m, parameters)."""
        if not self.coefficients.varies:
            return np.zeros((*vectors.shape, self.coefficients.exponents.shape[1]))
        products = self.terms @ vectors
        return first_axis(self.coefficients.jacobian(theta).T, products).transpose(1, 2, 0)

    def derivative_forms(self, theta: Floats, left: Floats, right: Floats, of: Ints) -> Floats:
        """Return v_k^T dA/dtheta_i R, R the matrix of[k], for vectors v: (m, parameters, columns).

        ``left`` are the vectors (N, m), ``right`` the matrices (N, matrices, columns).
        """
        rows = self.derivatives_times(theta, left).transpose(1, 2, 0)
        return np.asarray(rows @ right.transpose(1, 0, 2)[of])

    def second_derivatives(self, theta: Floats, left: Floats, right: Floats) -> Floats:
        """Return sum_m left_m^T (d2A / dtheta_i dtheta_k) right_m for each row of left, (n, p, p).

        ``left`` has the shape (n, N, m) and ``right`` (N, m).
        """
        if not self.coefficients.curved:
            return np.zeros((len(left), theta.size, theta.size))
        products = (self.terms @ right).reshape(len(self.terms), -1)
        return self.coefficients.second_derivatives(theta, left.reshape(len(left), -1) @ products.T)

    def held(self, fixed: Mapping[int, float], tied: Mapping[int, int]) -> "DenseAffine":
        """Return A as a function of the other parameters; see `Monomials.held`."""
        coefficients, factors = self.coefficients.held(fixed, tied)
        return DenseAffine(self.terms * factors[:, None, None], coefficients)

    def sparse(self) -> "SparseAffine":
        """Return the same matrix with sparse terms."""
        terms = [coo_array(term) for term in self.terms]
        return sparse_affine(terms, self.coefficients, self.size)


@dataclass(frozen=True, eq=False)
class SparseAffine:
    """A(theta) with sparse terms on one pattern, by rows of the full symmetric matrix."""

    indptr: Ints32  # (N + 1,) where each row starts in ``indices``
    indices: Ints32  # (entries,) columns, ascending within each row
    terms: csc_array  # (entries, terms) values of each term; sparse, since most terms are local
    coefficients: Monomials  # c(theta)

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return self.indptr.size - 1

    @property
    def used(self) -> Bools:
        """Which parameters the matrix depends on, shape (parameters,)."""
        nonzero = np.diff(self.terms.indptr) > 0
        return np.asarray(self.coefficients.exponents[nonzero].any(axis=0))

    def held(self, fixed: Mapping[int, float], tied: Mapping[int, int]) -> "SparseAffine":
        """Return A as a function of the other parameters; see `Monomials.held`."""
        coefficients, factors = self.coefficients.held(fixed, tied)
        terms = csc_array(self.terms * factors[None])
        return SparseAffine(self.indptr, self.indices, terms, coefficients)

    def has_pattern_of(self, other: "SparseAffine") -> bool:
        """Return whether both matrices have the same pattern."""
        pairs = (self.indptr, other.indptr), (self.indices, other.indices)
        return all(np.array_equal(*pair) for pair in pairs)

    def at(self, theta: Floats) -> csr_array:
        """Return A(theta), N x N; it holds every entry of the pattern, zero or not."""
        values = self.terms @ self.coefficients.values(theta)
        return csr_array((values, self.indices, self.indptr), shape=(self.size, self.size))

    @cached_property
    def diagonals(self) -> csr_array:
        """The diagonal of each term, (N, terms)."""
        row, terms = expanded(self.indptr), self.terms
        chosen = np.flatnonzero((self.indices == row)[terms.indices])
        place = row[terms.indices[chosen]], expanded(terms.indptr)[chosen]
        return csr_array((terms.data[chosen], place), shape=(self.size, terms.shape[1]))

    def dense(self) -> DenseAffine:
        """Return the same matrix with dense terms."""
        out = np.zeros((self.terms.shape[1], self.size, self.size))
        out[:, expanded(self.indptr), self.indices] = self.terms.toarray().T
        return DenseAffine(out, self.coefficients)

    def derivative(self, theta: Floats, i: int) -> csr_array:
        """Return dA/dtheta_i, N x N, without the entries that are zero."""
        entries = self.terms @ self.coefficients.jacobian(theta)[:, i], self.indices, self.indptr
        out = csr_array(entries, shape=(self.size, self.size), copy=True)
        out.eliminate_zeros()
        return out

    def derivatives_times(self, theta: Floats, vectors: Floats) -> Floats:
        """Return dA/dtheta_i V for vectors V of shape (N, m); the result is (N, m, parameters)."""
        rows, m = self.derivative_rows(theta, vectors).toarray(), vectors.shape[1]
        return np.ascontiguousarray(rows.reshape(m, theta.size, self.size).transpose(2, 0, 1))

    def derivative_rows(self, theta: Floats, vectors: Floats) -> csr_array:
        """Return the same products as rows (vector, parameter), sparse: (m * parameters, N).

        The row of vector r and parameter i is r * parameters + i. A term that touches few
        degrees of freedom costs as little.
        """
        (stack, dof, _), dc, m = self._stack, self.coefficients.jacobian(theta), vectors.shape[1]
        rows, columns, values = [np.zeros(0, np.intp)], [np.zeros(0, np.intp)], [np.zeros(0)]
        products = times(stack, vectors) if dc.any() else vectors[:0]
        for j, some in self._pieces(FEW):
            for i in np.flatnonzero(dc[j]):
                rows.append(np.repeat(np.arange(m) * theta.size + i, dof[some].size))
                columns.append(np.tile(dof[some], m))
                values.append(dc[j, i] * products[some].T.ravel())
        entries = np.concatenate(rows), np.concatenate(columns)
        return csr_array((np.concatenate(values), entries), shape=(m * theta.size, self.size))

    def derivative_forms(self, theta: Floats, left: Floats, right: Floats, of: Ints) -> Floats:
        """Return the same as `DenseAffine.derivative_forms`, without what a term does not touch."""
        stack, dof, starts = self._stack
        products, forms = times(stack, left), np.zeros((starts.size - 1, of.size, right.shape[2]))
        for j, rows in self._pieces(FEW):
            matrices = right[_place(dof[rows])].transpose(1, 0, 2)[of]
            forms[j] += (products[rows].T[:, None] @ matrices)[:, 0]
        return first_axis(self.coefficients.jacobian(theta).T, forms).transpose(1, 0, 2)

    def second_derivatives(self, theta: Floats, left: Floats, right: Floats) -> Floats:
        """Return the same as `DenseAffine.second_derivatives`."""
        if not self.coefficients.curved:
            return np.zeros((len(left), theta.size, theta.size))
        stack, dof, starts = self._stack
        products, forms = times(stack, right), np.zeros((len(left), starts.size - 1))
        for j, rows in self._pieces(FEW):
            forms[:, j] += np.einsum("krm,rm->k", left[:, dof[rows]], products[rows])
        return self.coefficients.second_derivatives(theta, forms)

    def each(self, thetas: Floats, vectors: Floats) -> Floats:
        """Return A(theta_k) v_k for every row of thetas (m, p) and column of vectors (N, m)."""
        if not self.coefficients.varies:
            return times(self.at(thetas[0]), vectors)
        stack, dof, _ = self._stack
        coefficients = np.transpose([self.coefficients.values(theta) for theta in thetas])
        products, out = times(stack, vectors), np.zeros(vectors.shape)
        for j, rows in self._pieces(FEW):
            out[_place(dof[rows])] += products[rows] * coefficients[j]
        return out

    def project(self, left: Sequence[Floats], right: Floats) -> Floats:
        """Return L^T A_j R for every term, shape (terms, columns of L, columns of R).

        L is given as ``left``, some of its columns after the others. R should have fewer.
        """
        stack, dof, starts = self._stack
        products, ends = times(stack, right), np.cumsum([block.shape[1] for block in left])
        out = np.zeros((starts.size - 1, ends[-1], right.shape[1]))
        for j, rows in self._pieces(ROWS):
            own, some = dof[rows], products[rows]
            place, length = _place(own), int(own[-1] - own[0]) + 1
            if not isinstance(place, slice) and length <= SPARSE * own.size:
                # Rows of zeros for those between are cheaper than to collect the others.
                place = slice(int(own[0]), int(own[0]) + length)
                some = np.zeros((length, right.shape[1]))
                some[own - own[0]] = products[rows]
            for block, end in zip(left, ends, strict=True):
                out[j, end - block.shape[1] : end] += gram(block[place], some)
        return out

    def _pieces(self, size: int) -> Iterator[tuple[int, slice]]:
        """Yield terms and some of their rows in the stack, up to ``size`` at once."""
        for j, (first, last) in enumerate(pairwise(self._stack[2].tolist())):
            for k in range(first, last, size):
                yield j, slice(k, min(k + size, last))

    @cached_property
    def _stack(self) -> tuple[csr_array, Ints, Ints]:
        """The rows of the terms that are not zero, one below the other.

        Returns the rows (rows, N), their degrees of freedom (rows,) and where each term starts
        (terms + 1,).
        """
        terms = self.terms if self.terms.has_sorted_indices else self.terms.sorted_indices()
        entry, row = terms.indices, expanded(self.indptr)
        keys = expanded(terms.indptr) * self.size + row[entry]  # ascending
        first = np.flatnonzero(np.append(True, keys[1:] != keys[:-1])[: keys.size])
        indptr = np.append(first, keys.size)
        keys = keys[first]
        starts = np.searchsorted(keys, np.arange(terms.shape[1] + 1) * self.size)
        parts = terms.data, self.indices[entry], indptr
        return csr_array(parts, shape=(keys.size, self.size)), keys % self.size, starts


def sparse_rows(values: Floats, columns: Ints, width: int) -> csr_array:
    """Return the matrix (n, width) with values (n, k) in columns (n, k), without its zeros."""
    pointer = np.arange(len(values) + 1) * values.shape[1]
    parts = values.flatten(), columns.flatten(), pointer  # copies, as zeros are taken out in place
    out = csr_array(parts, shape=(len(values), width))
    out.eliminate_zeros()
    return out


def sparse_affine(terms: Sequence[sparray], coefficients: Monomials, size: int) -> SparseAffine:
    """Return sum_j c_j(theta) A_j for symmetric sparse matrices A_j of shape (N, N).

    The pattern is the union of theirs; entries that are zero in all of them are left out.
    """
    matrices = [csr_array(A, dtype=float, copy=True) for A in terms]
    for A in matrices:
        A.sum_duplicates()
        A.eliminate_zeros()
    keys = [expanded(A.indptr) * size + A.indices for A in matrices]
    union = reduce(merged, keys)
    values = np.concatenate([A.data for A in matrices])
    rows = np.concatenate([np.searchsorted(union, each) for each in keys])
    parts = values, rows, np.cumsum([0, *(each.size for each in keys)])
    data = csc_array(parts, shape=(union.size, len(matrices)))
    indptr = np.searchsorted(union, np.arange(size + 1) * size)
    indices = (union % size).astype(np.int32)
    return SparseAffine(indptr.astype(np.int32), indices, data, coefficients)


def _place(dof: Ints) -> slice | Ints:
    """Return ascending degrees of freedom as a range, if they are one."""
    first, last = int(dof[0]), int(dof[-1]) + 1
    return slice(first, last) if last - first == dof.size else dof


def merged(first: Ints, *others: Ints) -> Ints:
    """Return all numbers of ascending runs, ascending, each once: merged, which is far quicker."""
    ranked = np.sort(np.concatenate([first, *others]), kind="stable")
    return ranked[np.append(True, ranked[1:] != ranked[:-1])[: ranked.size]]


def expanded(indptr: Ints32) -> Ints:
    """Return the row (or column) of each entry of compressed rows (or columns)."""
    return np.repeat(np.arange(indptr.size - 1), np.diff(indptr))
