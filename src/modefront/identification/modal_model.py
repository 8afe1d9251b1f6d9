r"""The maximum-likelihood modal model by variable projection.

The functions of modes and the likelihood are those of docs/methods/identification.md; of records
with an exponential window :math:`e^{-dt}`, at :math:`s = \mathrm{i}\omega + d`, so that poles are
those without it. Of the real residuals R, k = -2 and 0 are the lower and the upper one. Variable
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
                     (modes, responses); the greatest :math:`|L_{rj}|` of a mode is 1
E                    primitives, (functions, lines): e, o of all modes, then residuals,
                     then :math:`e_2, o_2`
alpha                Re and Im of lam, then Re and Im of the L that are not held at 1
c                    Re and Im of phi of one response, then its residuals by reference
===================  =====================================================================

Sources: Golub & Pereyra 1973, doi:10.1137/0710036; El-Kafafy, De Troyer, Peeters & Guillaume, Mech.
Syst. Signal Process. 37 (2013) 422-439, doi:10.1016/j.ymssp.2013.01.001.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.linalg as la

from modefront._typing import Complexes, Floats, Ints
from modefront.identification.problem import Problem, combined, gram, primitives, products
from modefront.identification.scan import Scan, scan

FINE, COARSE = 1e-4, 1e-2
"""Squared steps in standard deviations that end an iteration: for results, and for choices."""

MOST_EVALUATIONS = 40
"""Evaluations after which a fit has failed; simulated tests take three to fifteen."""

TINY = float(np.finfo(float).tiny)

BEND = 1 / 8
"""Width of a block of lines over the distance of the nearest pole."""


@dataclass(frozen=True)
class ModalModel:
    """Parameters of the model in the scale of a `Problem`.

    Attributes
    ----------
    lam : (modes,) poles
    L : (modes, references) participation factors; that of ``held`` is 1
    held : (modes,) index of the reference with the greatest factor
    phi : (modes, responses)
    residual : (powers, references, responses)
    pairs : modes that have one and the same pole; their shapes are a basis of a plane
    """

    lam: Complexes
    L: Complexes
    held: Ints
    phi: Complexes
    residual: Floats
    pairs: tuple[tuple[int, int], ...] = ()

    def __len__(self) -> int:
        return len(self.lam)


# 12 fields: a model, what was fitted, and the equations of linear and nonlinear parameters there.
@dataclass(frozen=True)
class Fit:
    """A model with the cost and the curvature there; linear parameters are eliminated.

    Attributes
    ----------
    task : what was fitted
    model : the parameters
    cost : J, sum of squared weighted residuals
    gradient : (alphas,) half the gradient of J
    information : (alphas, alphas) projected Gauss-Newton matrix without the term in U
    curvature : (alphas, alphas) with it
    inverse : (responses, linear, linear) inverse of G; one where the responses share their weights
    Z : (responses, linear, alphas), G^-1 Phi^T D
    U : (responses, linear, alphas), derivatives of the columns of Phi on the residual
    unlike : (alphas,) share of each column of D, squared, that no linear parameter can make up
    evaluations : number of evaluations of the model
    converged : whether the iteration met its tolerance
    """

    task: Problem
    model: ModalModel
    cost: float
    gradient: Floats
    information: Floats
    curvature: Floats
    inverse: Floats
    Z: Floats
    U: Floats
    unlike: Floats
    evaluations: int = 1
    converged: bool = False

    @cached_property
    def functions(self) -> Complexes:
        """Functions of the model, (references, responses, lines)."""
        return synthesise(self.task, self.model)

    @cached_property
    def residual(self) -> Complexes:
        """The data without them, 0 where not measured."""
        return np.where(self.task.weight > 0, self.task.H - self.functions, 0)

    @cached_property
    def observed(self) -> Floats:
        """Half the second derivatives of J by alpha, (alphas, alphas).

        Where these have no minimum, as with a pole on the imaginary axis: the information.
        """
        task, model, n = self.task, self.model, len(self.model)
        weighted = task.s**task.order * (task.weight * self.residual).conj()
        upper, lower = (1 / (task.s - lam[:, None]) for lam in (model.lam, model.lam.conj()))
        # products of the residuals with squares and cubes of the functions of poles
        second, third = ((weighted @ (upper**p).T).conj() + weighted @ (lower**p).T for p in (2, 3))
        by_pole = 2 * np.einsum("rj,ri,jir->r", model.L.conj(), model.phi.conj(), third)
        by_factor = np.einsum("ri,jir->rj", model.phi.conj(), second)
        factors = free_factors(model.held, model.L.shape[1])
        both = [(r, r, z) for r, z in enumerate(by_pole)]
        both += [(r, k, by_factor[r, j]) for k, (r, j) in enumerate(factors, start=n)]
        out = _rows(self.U).T @ _rows(self.Z - self.inverse @ self.U / 2)
        out = self.information + out + out.T
        for r, k, z in both:
            for row, column in {(r, k), (k, r)}:
                block = out[2 * row : 2 * row + 2, 2 * column : 2 * column + 2]
                block -= [[z.real, z.imag], [z.imag, -z.real]]
        free = directions(model)
        size = np.sqrt(np.maximum((free.T @ self.information @ free).diagonal(), TINY))
        least = np.linalg.eigvalsh(free.T @ out @ free / np.outer(size, size)).min(initial=1.0)
        return out if least > 1e-12 else self.information

    def inverted(self, A: Floats) -> Floats:
        """Return A^-1 in the directions in which alpha is free; large where it is singular."""
        free = directions(self.model)
        A = free.T @ A @ free
        least = 1e-30 * A.diagonal().max(initial=0.0) + TINY
        scale = 1 / np.sqrt(np.maximum(A.diagonal(), least))
        value, vector = np.linalg.eigh(A * np.outer(scale, scale))
        half = free @ (scale[:, None] * vector / np.sqrt(np.maximum(value, 1e-13)))
        out: Floats = half @ half.T
        return out

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
        E = primitives(self.task, self.model.lam, squares=False)
        T = design(self.model.L, len(self.task.powers))
        return scan(self.task, self.residual, self.misfit, E, T)


def evaluate(
    task: Problem,
    lam: Complexes,
    L: Complexes,
    held: Ints,
    pairs: tuple[tuple[int, int], ...] = (),
) -> Fit:
    """Return the model with the best shapes for the given poles and participation factors."""
    E = primitives(task, lam)
    M = gram(task, E)
    first = 2 * len(lam) + len(task.powers)
    T = design(L, len(task.powers))
    TM = T.transpose(0, 2, 1)[:, None] @ M[..., :first, :]  # (references, responses, linear, Q)
    G = (TM[..., :first] @ T[:, None]).sum(axis=0)
    inverse = _inverse(G)
    c = _best(inverse, T, _project(task, E[:first], None)[0])
    rho, cost = _project(task, E, np.einsum("jqa,ia->jiq", T, c))
    # a second round takes back what the normal equations lost; it is small, so that its changes of
    # rho and of the cost are exact to rounding
    lost = _best(inverse, T, rho[..., :first])
    right = (G @ lost[..., None])[..., 0]
    c = c + lost
    rho = rho - (lost[None, :, None] @ TM)[:, :, 0]
    n, powers = len(lam), len(task.powers)
    phi = (c[:, : 2 * n : 2] + 1j * c[:, 1 : 2 * n : 2]).T
    residual = c[:, 2 * n :].reshape(len(c), L.shape[1], powers).transpose(2, 1, 0)
    model = ModalModel(lam, L, held, phi, residual, pairs)
    row, coefficient = derivatives(model, E.shape[0])
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
    Z = inverse @ cross
    U = _second(model, rho, len(task.powers))
    information = direct - _rows(cross).T @ _rows(Z)
    slope = (rho[..., row] * coefficient).sum(axis=(0, 1, 3))
    return Fit(
        task,
        model,
        cost - float(np.sum(lost * right)),
        -slope,
        information,
        information + _rows(U).T @ _rows(inverse @ U),
        inverse,
        Z,
        U,
        information.diagonal() / np.maximum(direct.diagonal(), TINY),
    )


def synthesise(task: Problem, model: ModalModel) -> Complexes:
    """Return the functions of a model, (references, responses, lines)."""
    E = primitives(task, model.lam, squares=False)
    a = model.L.T[:, None, :] * model.phi.T[None]
    modal = np.stack([a.real, a.imag], axis=-1).reshape(*a.shape[:2], -1)
    return combined(np.concatenate([modal, model.residual.transpose(1, 2, 0)], axis=-1), E)


def thinned(fit: Fit, lam: Complexes) -> Problem:
    """Return the problem of a fit with means of lines over which functions of poles bend little.

    They are poles of the fit and those that come, ``lam``. Means are those of the residuals, which
    bend less than the functions, and vanish with them.
    """
    task, first = fit.task, [0]
    f = task.s.imag
    distance = np.abs(task.s - np.concatenate([fit.model.lam, lam, [0]])[:, None]).min(axis=0)
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
    H = synthesise(out, fit.model) + mean
    return replace(out, H=np.where(weight > 0, H, 0))


def _rows(values: Floats) -> Floats:
    """Return a matrix with the last axis as columns, of which there may be none."""
    return values.reshape(math.prod(values.shape[:-1]), values.shape[-1])


def _best(inverse: Floats, T: Floats, rho: Floats) -> Floats:
    """Return the linear parameters, (responses, linear), from products with the primitives."""
    right = np.einsum("jqa,jiq->ia", T, rho)
    out: Floats = (inverse @ right[..., None])[..., 0]
    return out


def maximise(
    task: Problem,
    lam: Complexes,
    L: Complexes,
    most: int = MOST_EVALUATIONS,
    tolerance: float = FINE,
    pairs: tuple[tuple[int, int], ...] = (),
) -> Fit:
    """Return the maximum-likelihood fit from initial poles and participation factors.

    Levenberg-Marquardt in alpha. The iteration ends where the squared length of a step, in
    standard deviations of the parameters, is below ``tolerance``, and fails after ``most``
    evaluations. Modes of ``pairs`` keep one pole.
    """
    held = np.abs(L).argmax(axis=1)
    L = L / L[np.arange(len(L)), held][:, None]
    for pair in map(list, pairs):
        held[pair] = la.qr(L[pair], mode="economic", pivoting=True)[2][:2]
        L[pair] = np.linalg.solve(L[np.ix_(pair, held[pair])], L[pair])
    fit = evaluate(task, lam, L, held, pairs)
    damping, evaluations = 0.0, 1
    converged = not len(lam)
    while evaluations < most and not converged:
        step = _step(fit, damping)
        decrement = float(step @ fit.curvature @ step)
        noise = max(2 * fit.cost / max(task.count, 1), 1.0)
        trial = evaluate(task, *_moved(fit.model, step), held, pairs)
        evaluations += 1
        if trial.cost <= fit.cost * (1 + 1e-14):
            converged = 2 * decrement <= tolerance * noise
            damping = 0.0 if damping < 1e-6 else damping / 10
            fit = trial
        elif 2 * decrement <= tolerance * noise:
            converged = True
        else:
            damping = max(10 * damping, 1e-4)
            if damping > 1e8:
                break
    return replace(fit, evaluations=evaluations, converged=converged)


def leverage(fit: Fit) -> Floats:
    """Return the share of the noise of each line that the fit takes, of the shape of ``H``.

    It is the mean over the real and the imaginary part of the diagonal of the projection on the
    columns of Phi and of the rest of D.
    """
    E, T, X = columns(fit)
    first = T.shape[1]
    S = X @ fit.inverted(fit.information) @ X.swapaxes(2, 3)
    S[:, :, :first, :first] += (T[:, None] @ fit.inverse) @ T[:, None].swapaxes(2, 3)
    p, q = np.triu_indices(len(E))
    coefficients = S[..., p, q] * np.where(p == q, 1.0, 2.0)
    out = np.empty(fit.task.H.shape)
    for lines, values in products(E):
        out[..., lines] = coefficients @ values
    return fit.task.weight * out / 2


def _project(task: Problem, E: Complexes, coefficients: Floats | None) -> tuple[Floats, float]:
    """Return the weighted products of residuals with the primitives, and the cost.

    The residuals are those of combinations of the first primitives, or the data themselves.
    """
    r = task.H
    if coefficients is not None:
        r = r - combined(coefficients, E[: coefficients.shape[-1]])
    weighted = task.weight * r
    rho: Floats = weighted.view(float) @ E.view(float).T
    return rho, float(np.vdot(r, weighted).real)


def _inverse(G: Floats) -> Floats:
    """Return the inverses of symmetric matrices, scaled to a unit diagonal first."""
    diagonal = np.einsum("iaa->ia", G)
    scale = 1 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    scaled = G * scale[:, :, None] * scale[:, None, :]
    unit = np.eye(G.shape[1])
    scaled = scaled + unit * np.where(diagonal > 0, 1e-14, 1.0)[:, None, :]
    out: Floats = np.linalg.inv(scaled) * scale[:, :, None] * scale[:, None, :]
    return (out + out.transpose(0, 2, 1)) / 2


def design(L: Complexes, powers: int) -> Floats:
    """Return T, (references, primitives, linear): columns of Phi in the primitives."""
    n, n_in = L.shape
    T = np.zeros((n_in, 2 * n + powers, 2 * n + powers * n_in))
    r = np.arange(n)
    T[:, 2 * r, 2 * r] = T[:, 2 * r + 1, 2 * r + 1] = L.real.T
    T[:, 2 * r, 2 * r + 1], T[:, 2 * r + 1, 2 * r] = -L.imag.T, L.imag.T
    for j in range(n_in):
        k = np.arange(powers)
        T[j, 2 * n + k, 2 * n + powers * j + k] = 1.0
    return T


def free_factors(held: Ints, references: int) -> list[tuple[int, int]]:
    """Return (mode, reference) of the participation factors that are parameters."""
    return [(r, j) for r, kept in enumerate(held) for j in range(references) if j != kept]


def derivatives(model: ModalModel, functions: int) -> tuple[Ints, Floats]:
    """Return the columns of D in the primitives, of which each has two.

    They are the numbers of the primitives, (alphas, 2), and their coefficients, (references,
    responses, alphas, 2).
    """
    n, n_in = model.L.shape
    free = free_factors(model.held, n_in)
    a = model.L.T[:, None, :] * model.phi.T[None]  # (references, responses, modes)
    row = np.zeros((n + len(free), 2), int)
    row[:n] = (functions - 2 * n + 2 * np.arange(n))[:, None] + [0, 1]
    value = np.zeros((n_in, model.phi.shape[1], n + len(free)), complex)
    value[..., :n] = a
    for k, (r, j) in enumerate(free, start=n):
        row[k] = 2 * r, 2 * r + 1
        value[j, :, k] = model.phi[r]
    turned = np.stack([value, 1j * value], axis=-1).reshape(*value.shape[:2], -1)
    return row.repeat(2, axis=0), np.stack([turned.real, turned.imag], axis=-1)


def columns(fit: Fit) -> tuple[Complexes, Floats, Floats]:
    """Return the primitives, T, and X: columns of D without what Phi makes up.

    X is (references, responses, primitives, alphas).
    """
    E = primitives(fit.task, fit.model.lam)
    T = design(fit.model.L, len(fit.task.powers))
    row, coefficient = derivatives(fit.model, len(E))
    X = np.zeros((*coefficient.shape[:2], len(E), len(row)))
    X[:, :, : T.shape[1]] = -(T[:, None] @ fit.Z)
    for k in range(2):
        X[:, :, row[:, k], np.arange(len(row))] += coefficient[..., k]
    return E, T, X


def _second(model: ModalModel, rho: Floats, powers: int) -> Floats:
    """Return U, (responses, linear, alphas): derivatives of the columns of Phi on the residual.

    With z = rho_e + i rho_o, the product of the residual with x e + y o is Re(conj(x + iy) z).
    """
    n, n_in = model.L.shape
    free = free_factors(model.held, n_in)
    base = 2 * n + powers
    single = rho[..., : 2 * n : 2] + 1j * rho[..., 1 : 2 * n : 2]
    double = rho[..., base::2] + 1j * rho[..., base + 1 :: 2]
    seen = np.einsum("rj,jir->ir", model.L.conj(), double)
    U = np.zeros((rho.shape[1], 2 * n + powers * n_in, 2 * n + 2 * len(free)))
    for r in range(n):
        U[:, 2 * r, 2 * r], U[:, 2 * r + 1, 2 * r] = seen[:, r].real, seen[:, r].imag
        U[:, 2 * r, 2 * r + 1], U[:, 2 * r + 1, 2 * r + 1] = seen[:, r].imag, -seen[:, r].real
    for k, (r, j) in enumerate(free, start=n):
        z = single[j, :, r]
        U[:, 2 * r, 2 * k], U[:, 2 * r + 1, 2 * k] = z.real, z.imag
        U[:, 2 * r, 2 * k + 1], U[:, 2 * r + 1, 2 * k + 1] = z.imag, -z.real
    return U


def directions(model: ModalModel) -> Floats:
    """Return the directions in which alpha is free, (alphas, free): all, unless there are pairs.

    Both modes of a pair have one pole. Factors of either at the references that are held for both
    stay: another basis of the plane of their shapes would change them, and not the functions.
    """
    n = len(model)
    factors = free_factors(model.held, model.L.shape[1])
    out, gone = np.eye(2 * (n + len(factors))), np.zeros(n + len(factors), bool)
    for r, s in model.pairs:
        out[2 * s : 2 * s + 2, 2 * r : 2 * r + 2] = np.eye(2)
        gone[s] = True
        for k, factor in enumerate(factors, start=n):
            gone[k] |= factor in ((r, model.held[s]), (s, model.held[r]))
    return out[:, ~gone.repeat(2)]


def _step(fit: Fit, damping: float) -> Floats:
    free = directions(fit.model)
    curvature = free.T @ fit.curvature @ free
    diagonal = curvature.diagonal()
    rounding = np.finfo(float).eps ** 2 * diagonal.max()  # of a dead channel it is all there is
    scale = 1 / np.sqrt(np.where(diagonal > rounding, diagonal, 1.0))
    scaled = curvature * np.outer(scale, scale) + (damping + 1e-12) * np.eye(len(scale))
    slope = scale * (free.T @ fit.gradient)
    step: Floats = -free @ (scale * la.solve(scaled, slope, assume_a="sym"))
    n = len(fit.model)
    sigma, omega = fit.model.lam.real, fit.model.lam.imag
    # poles stay in the second quadrant, and none goes beyond its neighbourhood; each for itself,
    # as one that is drawn to the imaginary axis would hold up all others
    room = np.empty(2 * n)
    room[::2], room[1::2] = 0.7 * np.abs(sigma), np.minimum(10 * np.abs(sigma), 0.5 * omega)
    step[: 2 * n] = np.clip(step[: 2 * n], -room, room)
    return step


def _moved(model: ModalModel, step: Floats) -> tuple[Complexes, Complexes]:
    n = len(model)
    lam = model.lam + step[: 2 * n : 2] + 1j * step[1 : 2 * n : 2]
    L = model.L.copy()
    for k, (r, j) in enumerate(free_factors(model.held, L.shape[1]), start=n):
        L[r, j] += step[2 * k] + 1j * step[2 * k + 1]
    return lam, L
