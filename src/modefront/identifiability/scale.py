r"""The scale in which changes of parameters are large or small.

The unit :math:`s_j` of a parameter is the least change by which, to first order, some motion loses
all of its stiffness (the greatest eigenvalue of :math:`s_j\, \partial K/\partial\theta_j` with
respect to :math:`K` has modulus 1), some degree of freedom loses all of its mass, or the whole
range between its bounds is gone through. It does not depend on how matrices are parametrised; of
models without matrices, only the range is known.

A combination of parameters that scales all of K or all of M is looked for in the same matrices:
:math:`\sum_j y_j\, \partial K / \partial \theta_j = K` at :math:`\sum_j y_j\, \partial M /
\partial \theta_j = 0`, and so on. Mode shapes do not change along it.
"""

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from weakref import ref

import numpy as np
import scipy.linalg
import scipy.sparse

from modefront._typing import Bools, Floats
from modefront.linalg.affine import DenseAffine, SparseAffine
from modefront.linalg.factorisation import SingularMatrixError
from modefront.models.base import matrices_at
from modefront.models.matrices import MatrixModel
from modefront.modes import sparse
from modefront.residuals.problem import UpdatingProblem

STEPS = 12  # steps of the power iteration, after which the greatest eigenvalue is known to a tenth

SINGULAR = 1e-13
"""Eigenvalue of K with a unit diagonal, over the greatest and their number, that is rounding."""

WHOLE = 1e-6
"""Remainder of a matrix, over all of it, below which a combination of parameters scales it, and
singular value of the derivatives of K and M, over the greatest, below which they depend."""

RIGID = 1e-3  # frequency over the greatest one below which a measured mode is one of a rigid body
SETTLED = 1e-3  # relative change of an eigenvalue at which power iteration ends

SHIFT = 1e-3
"""Share of the least measured eigenvalue that is added to a K with rigid-body modes, times M."""


@dataclass(frozen=True)
class Scale:
    """Units of changes of the parameters at one model."""

    theta: Floats  # (p,) parameters there
    unit: Floats  # (p,) s
    positive: Bools  # (p,) which parameters are above 0 in all of their range
    # the matrices and their derivatives there; None of a model without matrices
    model: MatrixModel | None = None

    @cached_property
    def scalings(self) -> dict[str, Floats]:
        """Changes (p,) of the parameters for a factor of e of the whole K, M, or both, by its name.

        Of several that do, to first order, it is the one nearest to theta, in units. They are
        looked for when they are first asked for.
        """
        theta, unit, model = self.theta, self.unit, self.model
        if model is None:
            return {}
        (RK, K), (RM, M) = (_rows(matrix, theta) for matrix in (model.stiffness, model.mass))
        both = np.vstack([RK, RM])
        scaled = {
            "stiffness matrix": (K, 0 * M),
            "mass matrix": (0 * K, M),
            "stiffness matrix and the mass matrix": (K, M),
        }
        out = {}
        for of, parts in scaled.items():
            b = np.concatenate(parts)
            y = theta + unit * np.linalg.lstsq(both * unit, b - both @ theta, rcond=WHOLE)[0]
            if np.linalg.norm(both @ y - b) <= WHOLE * np.linalg.norm(b):
                out[of] = y
        return out


def scale_at(problem: UpdatingProblem, theta: Floats) -> Scale:
    """Return the scale of a problem at ``theta``, shape (parameters,); the last one is kept."""
    for of, last in _LAST:
        if of() is problem and np.array_equal(last.theta, theta):
            return last
    unit, model = problem.upper - problem.lower, matrices_at(problem.model, theta)
    if model is not None:
        f = problem.data.mean_frequency[np.isfinite(problem.data.mean_frequency)]
        elastic = f[f > RIGID * f.max(initial=0.0)]
        shift = SHIFT * (2 * np.pi * float(elastic.min())) ** 2 if elastic.size else 0.0
        per_K, per_M = _of_stiffness(model, theta, shift), _of_mass(model.mass, theta)
        unit = 1 / np.maximum(np.maximum(per_K, per_M), 1 / unit)
    scale = Scale(theta.copy(), unit, problem.lower > 0, model)
    # with a problem that is no more, its model goes
    _LAST[:] = [(ref(problem, lambda _: _LAST.clear()), scale)]
    return scale


_LAST: list[tuple[ref[UpdatingProblem], Scale]] = []


def _of_stiffness(model: MatrixModel, theta: Floats, shift: float) -> Floats:
    """Return the greatest |eigenvalue| of dK_j with respect to K, (p,); 0 where K is indefinite.

    Where the structure can move as a rigid body, K + shift M takes the place of K.
    """
    stiffness = model.stiffness
    if not isinstance(stiffness, DenseAffine):
        return _sparse(model, stiffness, theta, shift)
    K = stiffness.at(theta)
    d = 1 / np.sqrt(np.maximum(np.diag(K), np.finfo(float).tiny))
    lam = scipy.linalg.eigvalsh(K * np.outer(d, d), check_finite=False)
    if lam[0] <= SINGULAR * lam.size * lam[-1]:
        M = model.mass.at(theta)
        K = K + shift * (M if isinstance(M, np.ndarray) else M.toarray())
    changes = stiffness.coefficients.jacobian(theta).T
    dK = [np.tensordot(change, stiffness.terms, axes=1) for change in changes]
    try:
        return np.array([np.abs(scipy.linalg.eigvalsh(A, K)).max(initial=0.0) for A in dK])
    except np.linalg.LinAlgError:
        return np.zeros(theta.size)


def _sparse(model: MatrixModel, stiffness: SparseAffine, theta: Floats, shift: float) -> Floats:
    """Return the same for sparse matrices, by power iteration in the norm of K where need be."""
    known = _of_single_terms(stiffness, theta)
    if np.isfinite(known).all():
        return known
    factor = sparse.regular_factor(model.pencil, theta) if model.floating else None
    if factor is None:
        K, M = model.pencil.K.at(theta).data, model.pencil.M.at(theta).data
        with suppress(SingularMatrixError):
            factor = model.pencil.factor(K, M, -shift if model.floating else 0.0)
        if factor is None or factor.negative:
            return np.zeros(theta.size)
    start = np.random.default_rng(0).standard_normal((stiffness.size, 1))
    F = stiffness.derivatives_times(theta, start)[:, 0]
    dK = [stiffness.derivative(theta, j) for j in range(theta.size)]
    out, X = np.where(np.isfinite(known), known, 0.0), np.zeros(F.shape)
    active = np.flatnonzero(F.any(axis=0) & np.isnan(known))
    X[:, active] = factor.solve(F[:, active])
    for _ in range(STEPS):
        energy = np.einsum("nj,nj->j", X, F)  # of each x in the norm of K, squared
        active = active[energy[active] > 0]
        if not active.size:
            break
        X[:, active] /= np.sqrt(energy[active])
        F[:, active] = np.stack([dK[j] @ X[:, j] for j in active], axis=1)
        X[:, active] = factor.solve(F[:, active])
        before, after = out[active], np.einsum("nj,nj->j", X[:, active], F[:, active])
        out[active] = np.sqrt(np.maximum(after, 0.0))
        active = active[np.abs(out[active] - before) > SETTLED * out[active]]
    return out


def _of_single_terms(stiffness: SparseAffine, theta: Floats) -> Floats:
    r"""Return what the terms of K alone tell of its greatest eigenvalues, (p,); NaN where nothing.

    Where :math:`K = \sum_k c_k K_k` with semidefinite terms and positive coefficients, no
    eigenvalue of dK with respect to K is above the greatest :math:`|\partial c_k| / c_k`, and a
    degree of freedom that only this term has is an eigenvector with that eigenvalue. Terms with
    negative entries on their diagonals are not semidefinite.
    """
    c, dc = stiffness.coefficients.values(theta), stiffness.coefficients.jacobian(theta)
    D = _diagonals(stiffness)
    if not (c > 0).all() or (D < 0).any():
        return np.full(theta.size, np.nan)
    rates = np.abs(dc) / c[:, None]
    alone = ((D > 0) & ((D > 0).sum(axis=1) == 1)[:, None]).any(axis=0)
    out = rates.max(axis=0)
    return np.where(alone[rates.argmax(axis=0)] | (out == 0), out, np.nan)


def _of_mass(mass: DenseAffine | SparseAffine, theta: Floats) -> Floats:
    """Return the greatest relative change of an entry on the diagonal of M, (p,)."""
    diagonals = _diagonals(mass)  # (N, terms)
    M = diagonals @ mass.coefficients.values(theta)
    dM = np.abs(diagonals @ mass.coefficients.jacobian(theta))
    has_mass = np.abs(M) > 0
    return np.asarray((dM[has_mass] / np.abs(M[has_mass])[:, None]).max(axis=0, initial=0.0))


def _diagonals(matrix: DenseAffine | SparseAffine) -> Floats:
    """Return the diagonal of each term as a column, (N, terms)."""
    if isinstance(matrix, DenseAffine):
        return np.asarray(np.einsum("tii->it", matrix.terms))
    return np.asarray(matrix.diagonals.toarray())


def _rows(matrix: DenseAffine | SparseAffine, theta: Floats) -> tuple[Floats, Floats]:
    """Return R dA/dtheta and R A, where R keeps all lengths of what the terms of A span.

    Entries count over the roots of those on the diagonal, whatever their units are.
    """
    c, dc = matrix.coefficients.values(theta), matrix.coefficients.jacobian(theta)
    d = np.abs(_diagonals(matrix) @ c)
    d = 1 / np.sqrt(np.where(d > 0, d, d.max(initial=0.0) or 1.0))
    if isinstance(matrix, DenseAffine):
        T = (matrix.terms * np.outer(d, d)).reshape(len(matrix.terms), -1).T
        gram = T.T @ T
    else:
        row = np.repeat(np.arange(matrix.size), np.diff(matrix.indptr))
        terms, weights = matrix.terms, d[row] * d[matrix.indices]
        scaled = (terms.data * weights[terms.indices], terms.indices, terms.indptr)
        T = scipy.sparse.csc_array(scaled, shape=terms.shape)
        gram = (T.T @ T).toarray()
    length = np.sqrt(np.diag(gram))
    over = np.where(length > 0, length, 1.0)
    lam, V = np.linalg.eigh(gram / np.outer(over, over))
    R = np.sqrt(np.maximum(lam, 0.0))[:, None] * V.T * length
    size = float(np.linalg.norm(R @ c)) or 1.0
    return R @ dc / size, R @ c / size
