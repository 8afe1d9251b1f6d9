r"""The maximum-likelihood modal model by variable projection.

The functions of modes and the likelihood are those of docs/methods/identification.md; of records
with an exponential window :math:`e^{-dt}`, at :math:`s = \mathrm{i}\omega + d`, so that poles are
those without it. Of the real residuals R, those of negative powers are the lower ones. Variable
projection is that of docs/methods/deviations.md. Every column of :math:`\Phi` and D is a
combination of a few *primitives*, real functions of frequency that all responses share: with a
residue a = x + iy,

.. math:: \frac{a}{s-\lambda}+\frac{a^*}{s-\lambda^*} = x\,e + y\,o,\qquad
          \frac{\partial}{\partial\operatorname{Re}\lambda} = x\,e_2 + y\,o_2,\qquad
          \frac{\partial}{\partial\operatorname{Im}\lambda} = x\,o_2 - y\,e_2 ,

e and o the sum and i times the difference of :math:`1/(s-\lambda)` and
:math:`1/(s-\lambda^*)`, :math:`e_2` and :math:`o_2` of their squares. The Gram matrices of the
primitives, weighted by 1/v of each function, are one matrix product; all else is small.

===================  =====================================================================
symbol               meaning
===================  =====================================================================
lam, L, phi          poles (modes,), participation (modes, references), shapes
                     (modes, responses)
E                    primitives, (functions, lines): e, o of all modes, then residuals,
                     then :math:`e_2, o_2`
alpha                Re and Im of lam, then of the changes of L across itself
c                    Re and Im of phi of one response, then its residuals by reference
===================  =====================================================================

Sources: Golub & Pereyra 1973, doi:10.1137/0710036; El-Kafafy, De Troyer, Peeters & Guillaume, Mech.
Syst. Signal Process. 37 (2013) 422-439, doi:10.1016/j.ymssp.2013.01.001.
"""

from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np
import scipy.linalg as la

from modefront._typing import Complexes, Floats, Ints
from modefront.identification.noise import square
from modefront.identification.problem import RESIDUALS, Problem, combined, gram, primitives
from modefront.identification.scan import Scan, scan

FINE, COARSE = 1e-4, 1e-2  # squared steps, in deviations, that end it: for results, for choices
MOST_EVALUATIONS = 40  # after which a fit has failed; simulated tests take three to fifteen
ROUNDING = 1e-13  # share of the squares of a column that may be rounding
BEND = 1 / 8  # width of a block of lines over the distance of the nearest pole

Pairs = tuple[tuple[int, int], ...]


class Fit:
    """A model with given poles and participation factors, and the best shapes for them.

    Its parameters are in the scale of the ``task``, the `Problem` that was fitted. ``pairs`` are
    modes that have one and the same pole; their shapes are a basis of a plane.

    ===========  =============================================================================
    attribute    meaning
    ===========  =============================================================================
    phi, c       shapes (modes, responses), and Re and Im of them, (responses, 2 modes)
    terms        residual terms (powers, references, responses)
    cost         J, sum of squared weighted residuals; linear parameters are eliminated
    gradient     (alphas,) half the gradient of J
    information  (alphas, alphas) projected Gauss-Newton matrix A
    inverse      (responses, linear, linear) inverse of G; one where the responses share their
                 weights
    Z            (responses, linear, alphas), G^-1 Phi^T D
    size         (alphas,) squares of the columns of D; parts that Phi can make up are in them
    evaluations  number of evaluations of the model
    converged    whether the iteration met its tolerance
    ===========  =============================================================================
    """

    def __init__(self, task: Problem, lam: Complexes, L: Complexes, pairs: Pairs = ()) -> None:
        self.task, self.lam, self.L, self.pairs = task, lam, L, pairs
        self.evaluations, self.converged = 1, False
        E, T = primitives(task, lam), design(L)
        M, n, first = gram(task, E), 2 * len(lam), T.shape[1]
        TM = T.transpose(0, 2, 1)[:, None] @ M[..., :first, :]  # (references, responses, linear, Q)
        G = (TM[..., :first] @ T[:, None]).sum(axis=0)
        self.inverse = _inverse(G)
        nothing = np.zeros((*task.H.shape[:2], 0))
        c = _best(self.inverse, T, _project(task, E[:first], nothing)[0])
        rho, cost = _project(task, E, np.einsum("jqa,ia->jiq", T, c))
        # a second round takes back what the normal equations lost; it is small, so that its changes
        # of rho and of the cost are exact to rounding
        lost = _best(self.inverse, T, rho[..., :first])
        right = (G @ lost[..., None])[..., 0]
        c = c + lost
        rho = rho - (lost[None, :, None] @ TM)[:, :, 0]
        self.cost = cost - float(np.sum(lost * right))
        self.c, self.phi = c[:, :n], np.asarray((c[:, :n:2] + 1j * c[:, 1:n:2]).T, complex)
        self.terms = c[:, n:].reshape(len(c), L.shape[1], len(RESIDUALS)).transpose(2, 1, 0)
        row, coefficient = self.derivatives(len(E))
        direct = np.zeros((row.size, row.size))
        for j, i in np.ndindex(M.shape[:2]):
            of_ji = coefficient[j, i : i + 1] if M.shape[1] > 1 else coefficient[j]
            flat = of_ji.reshape(len(of_ji), -1)
            direct += (flat.T @ flat) * M[j, i][np.ix_(row.ravel(), row.ravel())]
        direct = direct.reshape(*row.shape, *row.shape).sum(axis=(1, 3))
        cross = np.zeros((c.shape[0], c.shape[1], len(row)))
        for j, part in enumerate(TM):
            for k in range(2):
                cross += part[..., row[:, k]] * coefficient[j, :, None, :, k]
        self.Z, self.size = self.inverse @ cross, direct.diagonal()
        self.information = direct - np.tensordot(cross, self.Z, ((0, 1), (0, 1)))
        self.gradient = -(rho[..., row] * coefficient).sum(axis=(0, 1, 3))

    def of(self, task: Problem) -> "Fit":
        """Return the same model beside other data, with all that was known of it but the cost."""
        out = copy(self)
        for name in ("functions", "residual", "found"):
            vars(out).pop(name, None)
        out.task = task
        out.cost = float(np.sum(task.weight * square(out.residual)))
        return out

    @cached_property
    def alphas(self) -> list[tuple[int, int, Complexes | None]]:
        """Number and mode of each complex parameter, and direction, (references,), of factors.

        Modes of a pair share the number of their pole. Directions are across the factors of a mode,
        or of both of a pair: what moves within them changes shapes, and not the functions.
        """
        first = np.arange(len(self.lam))
        for r, s in self.pairs:
            first[s] = r
        pole = np.unique(first, return_inverse=True)[1].tolist()
        spans = [self.L[first == k].conj() for k in first]
        across = [(r, v) for r, span in enumerate(spans) for v in la.null_space(span).T]
        start = max(pole, default=-1) + 1
        return [
            *((k, r, None) for r, k in enumerate(pole)),
            *((k, r, v) for k, (r, v) in enumerate(across, start)),
        ]

    def derivatives(self, functions: int) -> tuple[Ints, Floats]:
        """Return the columns of D in so many primitives, of which each has two.

        They are the numbers of the primitives, (alphas, 2), and their coefficients, (references,
        responses, alphas, 2).
        """
        count, n = len({k for k, _, _ in self.alphas}), len(self.lam)
        row = np.zeros((count, 2), int)
        value = np.zeros((self.L.shape[1], self.phi.shape[1], count), complex)
        for k, r, v in self.alphas:
            row[k] = np.arange(2) + 2 * r + (functions - 2 * n if v is None else 0)
            value[..., k] += np.outer(self.L[r] if v is None else v, self.phi[r])
        turned = np.stack([value, 1j * value], axis=-1).reshape(*value.shape[:2], -1)
        return row.repeat(2, axis=0), np.stack([turned.real, turned.imag], axis=-1)

    def columns(self) -> tuple[Complexes, Floats, Floats]:
        """Return the primitives, T, and X: columns of D without what Phi makes up.

        X is (references, responses, primitives, alphas).
        """
        E, T = primitives(self.task, self.lam), design(self.L)
        row, coefficient = self.derivatives(len(E))
        X = np.zeros((*coefficient.shape[:2], len(E), len(row)))
        X[:, :, : T.shape[1]] = -(T[:, None] @ self.Z)
        for k in range(2):
            X[:, :, row[:, k], np.arange(len(row))] += coefficient[..., k]
        return E, T, X

    def synthesised(self, task: Problem) -> Complexes:
        """Return the functions of the model at the lines of a problem."""
        E = primitives(task, self.lam, squares=False)
        a = self.L.T[:, None, :] * self.phi.T[None]
        modal = np.stack([a.real, a.imag], axis=-1).reshape(*a.shape[:2], -1)
        return combined(np.concatenate([modal, self.terms.transpose(1, 2, 0)], axis=-1), E)

    @cached_property
    def functions(self) -> Complexes:
        """Functions of the model, (references, responses, lines)."""
        return self.synthesised(self.task)

    @cached_property
    def residual(self) -> Complexes:
        """The data without them, 0 where not measured."""
        return np.where(self.task.weight > 0, self.task.H - self.functions, 0)

    def inverted(self, A: Floats, damping: float = 0.0) -> Floats:
        """Return A^-1 of a matrix by alpha, large where it is singular; of A (I + damping)."""
        least = np.where(self.size > 0, ROUNDING * self.size, 1.0)
        scale = 1 / np.sqrt(np.maximum(A.diagonal(), least))
        value, vector = np.linalg.eigh(A * np.outer(scale, scale))
        half = scale[:, None] * vector / np.sqrt(np.maximum(value, ROUNDING) + damping)
        return half @ half.T

    @property
    def freedom(self) -> int:
        """Degrees of freedom of the residuals."""
        linear = self.task.live[1] * self.inverse.shape[1]
        return max(self.task.count - linear - len(self.gradient), 1)

    @property
    def misfit(self) -> float:
        """Variance of the residuals in units of that of the data."""
        return 2 * self.cost / self.freedom

    @cached_property
    def found(self) -> Scan:
        """What poles all over the band explain of the residuals."""
        E = primitives(self.task, self.lam, squares=False)
        return scan(self.task, self.residual, self.misfit, E, design(self.L))


def thinned(fit: Fit, lam: Complexes) -> Problem:
    """Return the problem of a fit with means of lines over which functions of poles bend little.

    They are poles of the fit and those that come, ``lam``. Means are those of the residuals, which
    bend less than the functions, and vanish with them.
    """
    task, first = fit.task, [0]
    f = task.s.imag
    distance = np.abs(task.s - np.concatenate([fit.lam, lam, [0]])[:, None]).min(axis=0)
    beyond = np.searchsorted(f, f + BEND * distance).tolist()
    while first[-1] < len(f):
        first.append(max(beyond[first[-1]], first[-1] + 1))
    if 2 * len(first) > len(f):
        return task
    blocks = first[:-1]
    s = np.asarray(np.add.reduceat(task.s, blocks) / np.diff(first), complex)
    weight = np.add.reduceat(task.weight, blocks, axis=-1)
    mean = np.add.reduceat(task.weight * fit.residual, blocks, axis=-1)
    mean /= np.where(weight > 0, weight, np.inf)
    out = replace(task, s=s, weight=weight)
    return replace(out, H=np.where(weight > 0, fit.synthesised(out) + mean, 0))


def _best(inverse: Floats, T: Floats, rho: Floats) -> Floats:
    """Return the linear parameters, (responses, linear), from products with the primitives."""
    return (inverse @ np.einsum("jqa,jiq->ia", T, rho)[..., None])[..., 0]


def maximise(
    task: Problem,
    lam: Complexes,
    L: Complexes,
    most: int = MOST_EVALUATIONS,
    tolerance: float = FINE,
    pairs: Pairs = (),
) -> Fit:
    """Return the maximum-likelihood fit from initial poles and participation factors.

    Levenberg-Marquardt in alpha. The iteration ends where the squared length of a step, in
    standard deviations of the parameters, is below ``tolerance``, and fails after ``most``
    evaluations. Modes of ``pairs`` keep one pole.
    """
    fit = Fit(task, lam, L / np.abs(L).max(axis=1, keepdims=True), pairs)
    damping, evaluations, converged = 0.0, 1, not len(lam)
    while evaluations < most and not converged:
        lam, L, decrement = _moved(fit, damping)
        noise = max(2 * fit.cost / max(task.count, 1), 1.0)
        trial = Fit(task, lam, L, pairs)
        evaluations += 1
        converged = 2 * decrement <= tolerance * noise
        if trial.cost <= fit.cost * (1 + 1e-14):
            fit, damping = trial, 0.0 if damping < 1e-6 else damping / 10
        else:
            damping = max(10 * damping, 1e-4)
    fit.evaluations, fit.converged = evaluations, converged
    return fit


def _project(task: Problem, E: Complexes, coefficients: Floats) -> tuple[Floats, float]:
    """Return the weighted products of residuals with the primitives, and the cost.

    The residuals are those of combinations of the first primitives.
    """
    r = task.H - combined(coefficients, E[: coefficients.shape[-1]])
    weighted = task.weight * r
    rho: Floats = weighted.view(float) @ E.view(float).T
    return rho, float(np.vdot(r, weighted).real)


def _inverse(G: Floats) -> Floats:
    """Return the inverses of symmetric matrices, scaled to a unit diagonal first."""
    diagonal = np.einsum("iaa->ia", G)
    scale = 1 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    scaled = G * scale[:, :, None] * scale[:, None, :]
    scaled = scaled + np.eye(G.shape[1]) * np.where(diagonal > 0, 1e-14, 1.0)[:, None, :]
    out: Floats = np.linalg.inv(scaled) * scale[:, :, None] * scale[:, None, :]
    return (out + out.transpose(0, 2, 1)) / 2


def design(L: Complexes) -> Floats:
    """Return T, (references, primitives, linear): columns of Phi in the primitives."""
    (n, n_in), powers = L.shape, len(RESIDUALS)
    T = np.zeros((n_in, 2 * n + powers, 2 * n + powers * n_in))
    for j, r in np.ndindex(n_in, n):
        a = L[r, j]
        T[j, 2 * r : 2 * r + 2, 2 * r : 2 * r + 2] = [[a.real, -a.imag], [a.imag, a.real]]
    for j in range(n_in):
        T[j, 2 * n :, 2 * n + powers * j :][:, :powers] = np.eye(powers)
    return T


def _moved(fit: Fit, damping: float) -> tuple[Complexes, Complexes, float]:
    """Return poles and factors after a step, and its squared length in deviations, over 2."""
    step: Floats = -fit.inverted(fit.information, damping) @ fit.gradient
    lam, L = fit.lam.copy(), fit.L.copy()
    # poles stay in the second quadrant, and none goes beyond its neighbourhood; each for itself,
    # as one that is drawn to the imaginary axis would hold up all others
    for k, r, v in fit.alphas:
        own = step[2 * k : 2 * k + 2]
        if v is None:
            pole = fit.lam[r]
            room = np.array([-0.7 * pole.real, min(-10 * pole.real, 0.5 * pole.imag)])
            own[:] = np.clip(own, -room, room)
            lam[r] += complex(*own)
        else:
            L[r] += complex(*own) * v
    return lam, L, float(step @ fit.information @ step)
