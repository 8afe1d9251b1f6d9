"""Members of a model, and models in which some are scaled by further parameters."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.findings.knowledge import enumeration
from modefront.linalg.affine import DenseAffine, Members, Monomials
from modefront.models.matrices import MatrixModel
from modefront.rounding import COMPUTED

MEMBERS = 200  # members that are looked at one by one, at most; of more, groups are looked at
MATRICES = ("stiffness", "mass")


class Part(NamedTuple):
    """A part of the terms of a matrix."""

    of: str  # the matrix, "stiffness" or "mass"
    place: str  # where it is, in words
    whole: bool  # whether it is all of a group, or a single member
    terms: Ints  # (k,) terms to which it adds
    shares: Floats  # (k, n, n) what it adds to each


def parts_of(matrices: MatrixModel, V: Floats) -> list[Part]:
    """Return members without parameters of their own, and groups without any, in a basis V."""
    of_all = list((matrices.members or partial(pairs, matrices))())
    single, out = sum(len(x.nodes) for x in of_all) <= MEMBERS, list[Part]()
    varied = {of: getattr(matrices, of).coefficients.exponents.any(axis=1) for of in MATRICES}
    count = {of: np.zeros(known.size) for of, known in varied.items()}
    for x in of_all:
        np.add.at(count[x.of], np.array([j for j, _ in x.shares]), 1)
    for x in of_all:
        R = (x.rows @ V).reshape(len(x.nodes), -1, V.shape[1])
        terms = np.array([j for j, _ in x.shares])
        own = (varied[x.of] & (count[x.of] == 1))[terms].all(axis=0)
        if x.group and not varied[x.of][terms[:, 0]].any():
            whole = [np.tensordot(R, A @ R, ((0, 1), (0, 1))) for _, A in x.shares]
            out.append(Part(x.of, f"of all {x.group}", True, terms[:, 0], np.array(whole)))
        shares = np.array([R.swapaxes(1, 2) @ (A @ R) for _, A in x.shares if single])
        for i in np.flatnonzero(~own).tolist() if single else ():
            names = [str(k) for k in x.nodes[i].tolist() if k >= 0]
            s = "s" * (len(names) > 1)
            where = f"of {x.group} at node{s}" if x.group else f"at degree{s} of freedom"
            place = f"{where} {enumeration(names)}"
            out.append(Part(x.of, place, False, terms[:, i], shares[:, i]))
    return out


def pairs(matrices: MatrixModel) -> Iterator[Members]:
    r"""Yield what joins degrees of freedom in matrices of which nothing else is known.

    .. math:: A = \sum_{a<b} |A_{ab}| s s^T + \operatorname{diag}(d), \quad
        s = e_a + \operatorname{sign}(A_{ab}) e_b

    Springs between masses that move along a line, and those to the ground, are so; d is left out
    where it is negative.
    """
    sparse: Any = matrices.sparse()
    for of in MATRICES:
        A = getattr(sparse, of)
        if A.indices.size > 4 * MEMBERS:
            continue
        row, each = np.repeat(np.arange(A.size), np.diff(A.indptr)), A.terms.tocoo()
        a, b, terms, v = row[each.row], A.indices[each.row], each.col, each.data
        d = np.zeros((A.terms.shape[1], A.size))
        np.add.at(d, (terms, a), np.where(a == b, v, -np.abs(v)))
        above = a < b
        j, n = np.nonzero(d > COMPUTED * np.abs(v).max(initial=0.0))
        nodes = np.concatenate([np.stack([a, b], 1)[above], np.stack([n, np.full(n.size, -1)], 1)])
        values = np.concatenate([v[above], d[j, n]])
        k, both = np.arange(len(nodes)), np.sign(values) * (nodes[:, 1] >= 0)
        entries = np.concatenate([np.ones(k.size), both]), (np.tile(k, 2), nodes.T.ravel() % A.size)
        rows = scipy.sparse.csr_array(entries, shape=(k.size, A.size))
        share = np.concatenate([terms[above], j]), np.abs(values)[:, None, None]
        yield Members(of, "", nodes, rows, [share])


def with_factors(model: MatrixModel, parts: Sequence[Part]) -> MatrixModel:
    """Return a model in a basis with factors on parts of it as parameters, or with an idle one."""
    new, count = dict[str, Any](), max(1, len(parts))
    for of in MATRICES:
        A = getattr(model, of)
        own = [(k, x) for k, x in enumerate(parts) if x.of == of]
        e = np.pad(A.coefficients.exponents.astype(float), ((0, 0), (0, count)))
        p = e.shape[1] - count
        origin = np.append(np.zeros(p) + A.coefficients.origin, np.ones(count))
        more = [e[x.terms] + np.eye(p + count)[p + k] for k, x in own]
        terms = np.concatenate([A.terms, *(x.shares for _, x in own)])
        new[of] = DenseAffine(terms, Monomials(np.concatenate([e, *more]), origin))
    return replace(model, parameters=(*model.parameters, *("factor",) * count), **new)
