r"""Exact derivatives of modes, seen by sensors, from the modes below a gap and two factors.

The equations are those of ``docs/methods/derivatives.md``. Lanczos iteration from each right-hand
side, :math:`B^{-1}b = \beta_1 q_1`, of :math:`T = P B^{-1} M` makes it a tridiagonal :math:`T_k`.
With :math:`I + \tau_r T_k = L D L^T`, the form :math:`c^T (K - \lambda_r M)^+ b` is
:math:`\sum_k p_k u_k / d_k`, where :math:`L u = \beta_1 e_1` and :math:`L p = (c^T q_k)_k` are
found on the way: only what c sees is formed, for all r at once. The condition number is that of
:math:`1 + \tau_r / (\lambda - \sigma)` for :math:`\lambda` beyond the known modes: each mode takes
the factor that makes it smallest. The form is symmetric, so b may be the forces (direct) or the
sensors (adjoint, one solution for all modes), whichever is expected to need fewer solutions.

Second derivatives need all of every solution. Where there are so many forces that a factor costs
less than the iterations, each mode has one of its own, of :math:`K - \lambda_r M`, with which a
solution takes no iteration.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, dia_array, eye_array, vstack

from modefront._typing import Bools, Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.factorisation import Factorisation, Pencil
from modefront.linalg.products import combine, gram, times
from modefront.modes.result import Solved
from modefront.rounding import TINY


@dataclass(frozen=True)
class Spectrum:
    """The lowest modes at one theta."""

    pencil: Pencil
    theta: Floats
    lam: Floats  # (modes,) eigenvalues, ascending
    Phi: Floats  # Phi, MPhi: (N, modes) mass-normalised modes, and M times them
    MPhi: Floats
    M: csr_array  # the mass matrix
    noise: Floats  # (modes,) rounding to be expected in ``lam``
    beyond: float  # estimate of the next eigenvalue; infinite where there is none
    proved: int  # how many modes were proved to be the lowest ones
    factors: tuple[Factorisation, Factorisation]  # below all modes, and above the proved ones


# Relative error of a quotient, as bounded by rounding in its gap, above which it is left out. The
# bound is ten to a hundred times the rounding itself.
COINCIDENT = 1e-6

TOLERANCE = 1e-10  # residual of a solution over that of zero
STEPS = 1000  # steps after which the iteration is given up
COLUMNS = 64  # right-hand sides that are solved together: more would only take more memory
ENTRIES = 2**22  # of a block of right-hand sides at most, unless it has `FEWEST` columns
FEWEST = 8  # right-hand sides that are solved together however large the model is


def at_sensors(sensors: csr_array, spectrum: Spectrum, count: int) -> tuple[Floats, Floats, Bools]:
    """Return dlam (count, p), dphi (sensors, count, p) and which modes coincide with another one.

    ``sensors`` has the shape (sensors, N); the identity gives the derivatives everywhere.
    Raises ModelError where the iteration fails.
    """
    pencil, theta, lam = spectrum.pencil, spectrum.theta, spectrum.lam
    c, p, same = count, theta.size, _same(spectrum)
    while c < spectrum.proved and same[c, :c].any():
        c += 1
    r = np.arange(c)
    dM = pencil.M.derivative_rows(theta, spectrum.Phi[:, :c])
    scale = dia_array((np.repeat(lam[:c], p)[None], 0), shape=(c * p, c * p))
    force = pencil.K.derivative_rows(theta, spectrum.Phi[:, :c]) - scale @ dM
    S = (force @ spectrum.Phi).reshape(c, p, -1)  # S[r, i, j] = phi_j^T (K_i' - lam_r M_i') phi_r
    dlam = S[r, :, r]
    coincident = np.asarray(same[:c, :c].sum(axis=0) > 1)
    for group in {tuple(np.flatnonzero(same[k, :c])) for k in np.flatnonzero(coincident)}:
        block = S[np.ix_(group, np.arange(p), group)]
        dlam[list(group)] = np.linalg.eigvalsh(np.moveaxis(block, 1, 0)).T

    gap = lam[:count, None] - lam
    inside = S[:count] * np.where(same[:count], 0.0, 1 / np.where(same[:count], 1.0, gap))[:, None]
    inside[r[:count], :, r[:count]] = -0.5 * (dM @ spectrum.Phi).reshape(c, p, -1)[r, :, r][:count]
    dphi = np.tensordot(sensors @ spectrum.Phi, inside, axes=(1, 2))
    dphi -= outside(sensors, force[: count * p].tocsr(), spectrum, count)
    return dlam[:count], dphi, coincident[:count]


def _same(spectrum: Spectrum) -> Bools:
    """Return which modes coincide, each one with itself, shape (modes, modes)."""
    lam, noise = spectrum.lam, spectrum.noise + np.finfo(float).eps * np.abs(spectrum.lam)
    distance = np.abs(lam[:, None] - lam)
    return np.asarray(distance * COINCIDENT <= np.maximum(noise, noise[:, None]))


def everywhere(
    sensors: csr_array, spectrum: Spectrum, count: int, r: Ints, b: Floats, _: Ints
) -> Solved:
    """Return one mode with adjoints at all DOFs; raises ModelError where the iteration fails."""
    pencil, theta = spectrum.pencil, spectrum.theta
    k, p, phi = int(r[0]), theta.size, spectrum.Phi[:, r]
    dM = pencil.M.derivative_rows(theta, phi)
    force = pencil.K.derivative_rows(theta, phi) - spectrum.lam[k] * dM
    right = vstack([force, csr_array(b.T @ sensors)], format="csr")
    gap = np.where(_same(spectrum)[:, k], np.inf, spectrum.lam - spectrum.lam[k])
    out = combine(spectrum.Phi, (right @ spectrum.Phi / gap).T)
    nearest, steps = _nearest(spectrum, count)
    shifted, identity = spectrum.factors[nearest[k]], eye_array(len(phi)).tocsr()
    # A factor costs about as many solutions as its columns have entries.
    if steps[k] * right.shape[0] > pencil.analysis.factor_nnz / pencil.size:
        shifted = _pinned(spectrum, k)
    tau = np.array([[shifted.sigma - spectrum.lam[k]]])
    for some, columns in _chunks(right):
        out[:, some] += _forms(shifted, spectrum, columns, tau, identity)[:, 0]
    dphi = -out[:, :p] - 0.5 * phi * (dM @ phi).T
    return phi, dphi[:, None], out[:, p:]


def _pinned(spectrum: Spectrum, k: int) -> Factorisation:
    """Return the factor of K - lam_k M with a spring where mode k moves most.

    Forces that do no work on the mode leave the spring at rest, as all forces together would do
    work on it otherwise: the solution is one without a spring, and holds some of the mode.
    """
    K, M = (A.at(spectrum.theta) for A in (spectrum.pencil.K, spectrum.pencil.M))
    dof = int((spectrum.Phi[:, k] * spectrum.MPhi[:, k]).argmax())
    row = slice(K.indptr[dof], K.indptr[dof + 1])
    K.data[row][K.indices[row] == dof] *= 2
    return spectrum.pencil.factor(K.data, M.data, float(spectrum.lam[k]))


def outside(sensors: csr_array, force: csr_array, spectrum: Spectrum, count: int) -> Floats:
    """Return sensors (K - lam_r M)^+ f_ri, shape (sensors, count, p); f has rows (r, i)."""
    nearest, steps = _nearest(spectrum, count)
    p = force.shape[0] // count
    out = np.zeros((sensors.shape[0], count, p))
    groups = [np.flatnonzero(nearest == which) for which in (0, 1)]
    direct = p * steps.sum()
    adjoint = sensors.shape[0] * sum(steps[r].max() for r in groups if r.size)
    for which, group in enumerate(groups):
        shifted = spectrum.factors[which]
        tau = shifted.sigma - spectrum.lam[group]
        rows = force[(group[:, None] * p + np.arange(p)).ravel()]
        if not rows.nnz:
            continue
        if adjoint < direct:
            for some, right in _chunks(sensors):
                product = _forms(shifted, spectrum, right, tau[:, None], rows)
                terms = np.diagonal(product.reshape(group.size, p, *product.shape[1:]), 0, 0, 2)
                out[some[:, None], group] = terms.transpose(1, 2, 0)
        else:
            for some, right in _chunks(rows):
                product = _forms(shifted, spectrum, right, tau[some // p][None], sensors)
                out[:, group[some // p], some % p] = product[:, 0]
    return out


def _nearest(spectrum: Spectrum, count: int) -> tuple[Ints, Floats]:
    """Return the better factor for each mode, and how many steps it is expected to take."""
    sigma = np.array([shifted.sigma for shifted in spectrum.factors])
    tau = sigma[:, None] - spectrum.lam[:count]
    condition = 1 + tau / np.maximum(spectrum.beyond - sigma, TINY)[:, None]
    condition = np.maximum(condition, 1 / condition)
    root = np.sqrt(condition)
    nearest = np.argmin(condition, axis=0)
    rate = ((root - 1) / (root + 1))[nearest, np.arange(count)]
    return nearest, 1 + np.log(TOLERANCE) / np.log(np.clip(rate, 1e-12, 0.999))


def _chunks(rows: Floats | csr_array) -> Iterator[tuple[Ints, Floats]]:
    """Yield the numbers of some rows at a time, and these as columns."""
    count, size = rows.shape
    width = min(COLUMNS, max(FEWEST, ENTRIES // size))
    for k in range(0, count, width):
        some = np.arange(k, min(k + width, count))
        chosen = rows[some]
        dense = chosen if isinstance(chosen, np.ndarray) else chosen.toarray()
        yield some, np.ascontiguousarray(dense.T)


def _forms(
    shifted: Factorisation, spectrum: Spectrum, right: Floats, tau: Floats, left: csr_array
) -> Floats:
    """Return left (K - lam_r M)^+ right, shape (rows of left, shifts, columns of right).

    ``tau`` holds sigma - lam_r: (shifts, 1), or one for each column, (1, columns). ``d``,
    ``lower`` (left of d in L), ``u`` and ``P`` belong to the last step.
    """
    dual = right - combine(spectrum.MPhi, gram(spectrum.Phi, right))
    W = shifted.solve(dual)
    W -= combine(spectrum.Phi, gram(spectrum.MPhi, W))  # on the M-complement of the known modes
    if not tau.any():  # that is the solution
        return (left @ W)[:, None]
    first = beta = _norm(W, dual)
    Q_old, dual_old = np.zeros_like(W), np.zeros_like(W)
    lower = np.zeros((tau.shape[0], beta.size))
    d, u = np.ones_like(lower), lower + beta
    P = np.zeros((left.shape[0], *lower.shape))
    out = np.zeros_like(P)
    for step in range(STEPS):
        scale = np.divide(1.0, beta, out=np.zeros_like(beta), where=beta > 0)
        W *= scale
        dual *= scale
        MQ = times(spectrum.M, W)
        alpha = np.einsum("nc,nc->c", W, MQ)
        if step:
            lower = tau * beta / d
            u = -lower * u
        d = 1 + tau * (alpha - lower * beta)
        P *= -lower
        P += (left @ W)[:, None]
        out += P * (u / d)
        Q_old *= -beta
        dual_old *= -beta
        Q_old += shifted.solve(MQ)
        Q_old -= alpha * W
        dual_old += MQ
        dual_old -= alpha * dual
        Q_old -= combine(spectrum.Phi, gram(spectrum.MPhi, Q_old))
        Q_old, W = W, Q_old
        dual_old, dual = dual, dual_old
        beta = _norm(W, dual)
        if (np.abs(tau * beta * u / d) <= TOLERANCE * first).all():
            return out
    raise ModelError("the derivatives do not converge: the matrices are too ill-conditioned")


def _norm(W: Floats, dual: Floats) -> Floats:
    """Return the norm of each column of W in B, given B W."""
    return np.sqrt(np.maximum(np.einsum("nc,nc->c", W, dual), 0.0))
