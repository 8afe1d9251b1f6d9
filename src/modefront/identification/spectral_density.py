r"""The likelihood of the Fourier transforms of ambient records, in a band with a few modes.

Of docs/methods/ambient.md, with one more part: a force :math:`f_r` of a mode in the band
moves :math:`(\varphi_r h_r + \rho_r + y \sigma_r) f_r`, where :math:`y = \omega/\omega_m - 1` and
the real vectors rho and sigma are the flanks of modes outside of it, as residual terms are. So
:math:`E_k = \Psi N_k \Psi^T + B`, :math:`N = H S H^*`, with
:math:`H = [\operatorname{diag} h;\ I;\ y I]`.
With :math:`P = \Psi^T B^{-1}\Psi`, all of it needs matrices of the size of the modes only,

.. math:: D = H (I + S H^* P H)^{-1} S H^*,\quad Y = I - D P,\quad
          E^{-1} = B^{-1} - \hat\Psi D \hat\Psi^T,\quad \hat\Psi = B^{-1}\Psi,\quad
          E^{-1}\Psi = \hat\Psi Y,\quad \ln\det E = \ln\det B + \ln\det(I + S H^* P H) .

Steps (scoring) and covariances are made of the gradient :math:`\sum_k \operatorname{tr}
E^{-1}\partial E\,(I - E^{-1}FF^*)` of the cost and the expected second derivatives
:math:`\sum_k \operatorname{tr} E^{-1}\partial_a E\,E^{-1}\partial_b E`. B follows each of them by a
step of its own; its errors reach the other parameters to second order only.

==============  ========================================================================
symbol          meaning
==============  ========================================================================
Phi             (sensors, modes) real shapes of unit norm; modes in the band are the first
R               (sensors, 2 x modes in the band, or none) all rho, then all sigma
Psi, H          (sensors, columns), (columns, modes); columns are modes in the band, R, modes
                beside it
S = L L^*       (modes, modes) spectral density of the modal forces, L lower triangular
B               (sensors, sensors) real; a priori diagonal, with the weight of `PRIOR` lines
C, Q            :math:`\Psi^T E^{-1}\Psi = P Y`, :math:`N C N = N - D`
==============  ========================================================================

Sources: Au, Mech. Syst. Signal Process. 26 (2012) 60-75, doi:10.1016/j.ymssp.2011.06.017 (close
modes); Li & Au, Mech. Syst. Signal Process. 132 (2019) 490-511, doi:10.1016/j.ymssp.2019.06.036
(expectation and maximisation).
"""

from dataclasses import dataclass, field, replace
from functools import cache, cached_property

import numpy as np
import scipy.linalg as la

from modefront._typing import Complexes, Floats, Ints

PRIOR = 1.0  # lines that the prior of the background weighs, beyond the number of sensors

TOLERANCE = 1e-2
"""Change of the cost below which a maximum is reached: a half is one standard deviation."""

MOST_STEPS = 60  # steps to a maximum, at most
MOST_OF_BACKGROUND = 0.9  # share of the background that a step takes away, at most
SHORTEST = 1e-3  # share of a step of the background below which it is left out
TERMS = 2  # terms of what a force moves besides, over frequency: a constant and a slope
COHERENT = 0.25  # standard deviation of either term at the ends of a band, over a mode's peak
LONGEST = 1.0  # change of ln zeta, and of ln omega in half bandwidths, in one step, at most
LEAST_DAMPING, GREATEST_DAMPING = 1e-7, 0.5  # limits of damping ratios in a search

LEAST_KNOWN = 1e-13
"""Least eigenvalue of the scaled information of what is determined, for rounding."""

TINY = 1e-100


@dataclass(frozen=True)
class Band:
    """Periodograms of the records of one setup, means over blocks of neighbouring lines."""

    omega: Floats  # (blocks,) rad/s, of the middle
    count: Floats  # (blocks,) number of lines
    power: Complexes  # (blocks, sensors, sensors) mean of F F^*, a two-sided spectral density
    order: int  # differentiations of the displacement in the records
    floor: Floats  # (sensors,) variances of the background a priori

    @property
    def total(self) -> Floats:
        """Sum of the real part of F F^* over the lines, and of the background a priori."""
        prior = (PRIOR + len(self.floor)) * np.diag(self.floor)
        return np.tensordot(self.count, self.power.real, 1) + prior

    @property
    def weight(self) -> float:
        """Number of lines, and of those that the prior is worth."""
        return float(self.count.sum() + PRIOR + len(self.floor))

    @property
    def reach(self) -> float:
        """Half the width over the middle."""
        return float(np.ptp(self.omega) / (self.omega[0] + self.omega[-1]))


@dataclass(frozen=True)
class Density:
    """A model of the spectral density in a band."""

    omega: Floats  # omega, zeta: (modes,) natural frequencies in rad/s and damping ratios
    zeta: Floats
    phi: Floats  # (sensors, modes) shapes of unit norm
    root: Complexes  # (modes, modes) L
    background: Floats  # (sensors, sensors) B
    free: int  # number of the modes that are in the band, the first ones
    # (sensors, terms x free) R, all constants first; no terms for a model without it
    coherent: Floats
    middle: float  # rad/s, where the slopes of R are 0
    # (terms x free,) of normal distributions of the columns of R a priori, about 0
    precision: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def columns(self) -> Floats:
        """Psi, (sensors, columns): shapes of free modes, R, shapes beside."""
        return np.hstack([self.phi[:, : self.free], self.coherent, self.phi[:, self.free :]])

    @property
    def moving(self) -> int:
        """Number of columns that are parameters, the first ones."""
        return self.free + self.coherent.shape[1]

    def prior(self, count: int) -> Floats:
        """Return what the prior of R adds to the second derivatives by so many parameters."""
        n, out = len(self.phi), np.zeros(count)
        out[self.free * n : self.moving * n] = self.precision.repeat(n)
        return out

    @property
    def force(self) -> Complexes:
        """S, (modes, modes)."""
        return self.root @ self.root.conj().T

    def response(self, omega: Floats, order: int) -> Complexes:
        """Return h at circular frequencies, (modes, lines)."""
        x = omega / self.omega[:, None]
        zeta = self.zeta[:, None]
        inner: Complexes = 1 - x**2 + 2j * zeta * x
        return 2 * zeta * x**order / inner

    def lifted(self, omega: Floats, order: int) -> Complexes:
        """Return H at circular frequencies, (lines, columns, modes)."""
        eye = np.eye(len(self.omega))
        of_modes = self.response(omega, order).T[:, :, None] * eye
        terms = range(self.coherent.shape[1] // max(self.free, 1))
        y = (omega / self.middle - 1)[:, None, None]
        smooth = [y**term * eye[: self.free] for term in terms]
        parts = [of_modes[:, : self.free], *smooth, of_modes[:, self.free :]]
        return np.asarray(np.concatenate(parts, axis=1), complex)

    def with_coherent(self, band: Band) -> "Density":
        """Return the same model with R = 0 as parameters, in the middle of a band.

        A priori, either term is at the ends of the band `COHERENT` of the mode's own peak.
        """
        n, size = len(self.phi), COHERENT / band.reach ** np.arange(TERMS)
        precision: Floats = n / size.repeat(self.free) ** 2
        R, middle = np.zeros((n, len(precision))), float(band.omega[[0, -1]].mean())
        return replace(self, coherent=R, middle=middle, precision=precision)

    def without(self, mode: int, band: Band) -> "Density":
        """Return the model without one of its modes, whose power becomes background."""
        kept, phi = np.delete(np.arange(len(self.omega)), mode), self.phi[:, mode]
        h = self.response(band.omega, band.order)[mode]
        power = self.force[mode, mode].real * np.average(np.abs(h) ** 2, weights=band.count)
        root: Complexes = np.linalg.qr(self.root[kept].conj().T)[1].conj().T
        terms = np.arange(self.coherent.shape[1]) % max(self.free, 1) != mode
        return replace(
            self,
            omega=self.omega[kept],
            zeta=self.zeta[kept],
            phi=self.phi[:, kept],
            root=root,
            background=self.background + power * np.outer(phi, phi),
            free=self.free - (mode < self.free),
            coherent=self.coherent[:, terms],
            precision=self.precision[terms],
        )


@dataclass(frozen=True)
class Fit:
    """A model beside the data: the cost and its derivatives by the parameters.

    The parameters are the shapes (mode by mode), R in the same way, ln omega and ln zeta of the
    free modes, and the real and imaginary part of L (row by row, the lower triangle). ``bending``
    is what the second derivatives of S by L add to those of the cost.
    """

    model: Density
    cost: float
    gradient: Floats
    information: Floats
    bending: Floats
    converged: bool = False

    def scaled(self, bending: Floats | float = 0.0) -> tuple[Floats, Floats]:
        """Return the information over its diagonal, and the scale; norms of shapes are held."""
        n, A = len(self.model.phi), self.information.copy()
        for r in range(self.model.free):
            rows = slice(r * n, (r + 1) * n)
            phi = self.model.phi[:, r]
            A[rows, rows] += np.outer(phi, phi) * max(np.trace(A[rows, rows]), 1.0)
        first = len(A) - len(self.bending)
        A[first:, first:] += bending
        diagonal = A.diagonal()
        scale = 1 / np.sqrt(np.where(diagonal > TINY, diagonal, 1.0))
        return A * np.outer(scale, scale), scale

    @cached_property
    def root(self) -> Floats:
        """A square root of the covariance of all parameters, with as many columns."""
        A, scale = self.scaled()
        value, vector = la.eigh(A)
        return scale[:, None] * vector / np.sqrt(np.maximum(value, LEAST_KNOWN))

    @property
    def freedom(self) -> float:
        """Number of parameters that the data determine; those with a prior count in part."""
        A, scale = self.scaled()
        of_data = self.information - np.diag(self.model.prior(len(A)))
        return float(np.vdot(la.pinvh(A, rtol=LEAST_KNOWN), of_data * np.outer(scale, scale)))

    def covariance(self, mode: int) -> Floats:
        """Return the covariance of ln omega, ln zeta and the shape of a free mode."""
        n, m = len(self.model.phi), self.model.free
        first = self.model.moving * n + mode
        half = self.root[[first, first + m, *range(mode * n, (mode + 1) * n)]]
        return half @ half.T


@dataclass(frozen=True)
class _Matrices:
    """The matrices of the module's text in all blocks, (blocks, columns, columns), and the cost.

    ``h`` is H, ``seen`` is F F^* hat of the data, (blocks, sensors, columns), ``own`` is
    hat^T F F^* hat, and ``weighted`` is D times the number of lines.
    """

    h: Complexes
    hat: Floats
    N: Complexes
    Y: Complexes
    D: Complexes
    C: Complexes
    seen: Complexes
    own: Complexes
    weighted: Complexes
    cost: float

    @cached_property
    def both(self) -> Complexes:
        """Sum of D hat^T F F^* over the lines, of w F^* as expected, (columns, sensors)."""
        return np.tensordot(self.weighted, self.seen.conj(), ((0, 2), (0, 2)))

    @cached_property
    def second(self) -> Complexes:
        """Sum of w w^* as expected, (columns, columns); w are the responses to the forces."""
        return (self.weighted + self.weighted @ self.own @ self.D).sum(axis=0)


def _matrices(band: Band, model: Density) -> _Matrices:
    n, B = len(model.phi), model.background
    h, psi = model.lifted(band.omega, band.order), model.columns
    inverse = np.linalg.inv(B)
    hat = inverse @ psi
    P = psi.T @ hat
    N, D, determinant = _of_responses(h @ model.root, P)
    Y = np.eye(len(P)) - D @ P
    seen = (band.power.reshape(-1, n) @ hat).reshape(len(h), *hat.shape)
    own, weighted = hat.T @ seen, band.count[:, None, None] * D
    cost = band.weight * np.linalg.slogdet(B)[1] + np.vdot(inverse, band.total)
    cost += band.count @ determinant - np.vdot(weighted.conj(), own.swapaxes(1, 2)).real
    cost += np.sum(model.precision * model.coherent**2) / 2
    return _Matrices(h, hat, N, Y, D, P @ Y, seen, own, weighted, float(cost))


def _of_responses(root: Complexes, P: Floats) -> tuple[Complexes, Complexes, Floats]:
    """Return N, D and the logarithm of det(I + N P) at all lines, from H L.

    D is H L (I + L^* H^* P H L)^-1 L^* H^*. The logarithm is infinite where rounding is all that is
    known of it: forces that cancel each other.
    """
    adjoint = root.conj().swapaxes(1, 2)
    A = adjoint @ P @ root
    trace = np.einsum("kii->k", A).real
    lost = ~(np.finfo(float).eps * trace < TOLERANCE)
    A[lost] = 0.0
    C = np.linalg.cholesky(A + np.eye(A.shape[1]))
    half = np.linalg.solve(C, adjoint)
    determinant = 2 * np.log(np.einsum("kii->ki", C).real).sum(axis=1)
    determinant[lost] = np.inf
    return root @ adjoint, half.conj().swapaxes(1, 2) @ half, determinant


def evaluate(band: Band, model: Density, known: _Matrices | None = None) -> Fit:
    """Return the cost of a model with its gradient and the expected second derivatives.

    ``known`` are its matrices where they are computed already.
    """
    x, c, m = known or _matrices(band, model), band.count, model.free
    rows, columns_of, units = _entries(len(model.root))
    d, J = _changes(band, model), np.zeros((len(rows), *model.root.shape), complex)
    J[np.arange(len(rows)), rows] = units[:, None] * model.root[:, columns_of].conj().T
    J += J.conj().swapaxes(1, 2)  # the derivatives of S by the parameters of L
    W = c[:, None, None] * (x.C - x.Y.conj().swapaxes(1, 2) @ x.own @ x.Y)
    measured = np.linalg.solve(model.background, x.both.T).T
    columns = 2 * (x.second @ x.hat.T - measured).real
    NW = np.sum(x.N * W.swapaxes(1, 2), axis=2)[:, :m]
    poles = 2 * np.sum(d * np.hstack([NW, NW]), axis=0).real
    whole = (x.h.conj().swapaxes(1, 2) @ W @ x.h).sum(axis=0).T
    forces = (J.reshape(len(J), whole.size) @ whole.ravel()).real
    columns[m : model.moving] += (model.precision * model.coherent).T
    gradient = np.concatenate([columns[: model.moving].ravel(), poles, forces])
    information = _information(model, x, c, d, J)
    information += np.diag(model.prior(len(gradient)))
    return Fit(model, x.cost, gradient, information, _bending(whole.T))


def _changes(band: Band, model: Density) -> Complexes:
    """Return the changes of ln h by ln omega and by ln zeta of free modes, (blocks, 2 free)."""
    zeta, x = model.zeta[: model.free], band.omega[:, None] / model.omega[: model.free]
    inner = 1 - x**2 + 2j * zeta * x
    return np.hstack([-band.order - (2 * x**2 - 2j * zeta * x) / inner, (1 - x**2) / inner])


@cache
def _entries(M: int) -> tuple[Ints, Ints, Complexes]:
    """Return rows, columns and units of the parameters of L."""
    i, j = np.tril_indices(M)
    parts = np.where(j < i, 2, 1)
    rows, columns = np.repeat(i, parts), np.repeat(j, parts)
    again = np.diff(rows * M + columns, prepend=-1) == 0
    return rows, columns, np.where(again, 1j, 1.0)


def _bending(G: Complexes) -> Floats:
    """Return tr G dL dL^* as second derivatives by the parameters of L.

    G is the gradient by S, without its negative part: S on the boundary of what is possible, as
    where two shapes are alike, has a singular L, by which expected derivatives alone vanish.
    """
    rows, columns, units = _entries(len(G))
    value, vector = np.linalg.eigh(G)
    G = vector * np.maximum(value, 0.0) @ vector.conj().T
    same = columns[:, None] == columns
    return 2 * same * (units.conj()[:, None] * G[np.ix_(rows, rows)] * units).real


def _information(model: Density, x: _Matrices, c: Floats, d: Complexes, J: Complexes) -> Floats:
    """Return the expected second derivatives, tr E^-1 dE E^-1 dE over the lines.

    With a = Psi N, shapes and R change E by e_j a_r^* and its adjoint, poles by d phi_r a_r^* and
    its adjoint, forces by Psi H J H^* Psi^T. Letters below: shapes, poles, forces.
    """
    (n, M), m, v = model.phi.shape, model.free, model.moving
    mode = np.tile(np.arange(m), 2)
    hat, h, D, C, Q, NC = x.hat, x.h, x.D, x.C, x.N - x.D, x.N @ x.C
    adjoint, left = x.Y.conj().swapaxes(1, 2), h.conj().swapaxes(1, 2)
    NCh, flat = NC @ h, J.reshape(M**2, M**2).T

    def gram(a: Complexes, b: Complexes) -> Complexes:
        """Return the sum of c a_rs b_tu over the lines, (r, s, t, u)."""
        out: Complexes = (a.reshape(len(c), -1).T * c) @ b.reshape(len(c), -1)
        return out.reshape(*a.shape[1:], *b.shape[1:])

    def each(a: Complexes, b: Complexes) -> Complexes:
        """Return the sum of c a_rp b_pt over the lines, (p, r, t)."""
        return np.ascontiguousarray(a.T * c) @ np.ascontiguousarray(b.swapaxes(0, 1))

    # (a_r^* E^-1)_l (a_s^* E^-1)_j + Q_rs (E^-1)_lj
    SS = gram(D[:, :v], D[:, :v]).swapaxes(1, 2) - gram(Q[:, :v, :v], D)
    total = np.tensordot(c, Q[:, :v, :v], 1)[..., None, None]
    SS = (hat @ SS @ hat.T + total * np.linalg.inv(model.background)).transpose(0, 3, 1, 2)
    SP = each(NC[:, :v, mode] * d[:, None], D[:, mode])
    SP += each(Q[:, :v, mode] * d.conj()[:, None], adjoint[:, mode])
    SP = (SP @ hat.T).transpose(1, 2, 0)
    SF = gram(NCh[:, :v], left @ adjoint).transpose(0, 3, 1, 2)
    SF = hat @ (SF.reshape(v, hat.shape[1], M**2) @ flat)
    NCp, Qp, Cp = (y[:, mode][:, :, mode] for y in (NC, Q, C))
    T, CP = NCp * d[:, None], Cp * d[:, None] * d.conj()[:, :, None]
    PP = np.sum(c[:, None, None] * (T * T.swapaxes(1, 2) + Qp * CP.swapaxes(1, 2)), axis=0)
    PF = each(NCh[:, mode].swapaxes(1, 2), ((left @ C)[:, :, mode] * d[:, None]).swapaxes(1, 2))
    PF = PF.reshape(2 * m, M**2) @ flat
    Ch = left @ C @ h
    FF = flat.T @ gram(Ch, Ch).transpose(1, 2, 3, 0).reshape(M**2, M**2) @ flat
    SS, SP, SF = (y.reshape(v * n, size) for y, size in ((SS, v * n), (SP, 2 * m), (SF, M**2)))
    return np.block(
        [[2 * SS, 2 * SP, 2 * SF], [2 * SP.T, 2 * PP, 2 * PF], [2 * SF.T, 2 * PF.T, FF]]
    ).real


def _background(band: Band, model: Density, x: _Matrices) -> tuple[Floats, Floats]:
    r"""Return Q and z of a step of scoring of the background, to Q Q^T with Q as it is for z = 0.

    With B = R R^T and changes R Z R^T, the second derivatives are :math:`\sum_k (I - V D V^T) Z
    (I - V D V^T)`, V = R^-1 Psi, and the gradient is the step of expectation and maximisation
    times the number of lines. In an orthonormal basis U of V and beside it, the parts of Z are
    solved for one by one.
    """
    c, weight, psi = band.count, band.weight, model.columns
    both = (psi @ x.both).real
    after = band.total - both - both.T + psi @ x.second.real @ psi.T
    R = la.cholesky(model.background, lower=True)
    V = la.solve_triangular(R, psi, lower=True)
    inner = la.solve_triangular(R, after - weight * model.background, lower=True)
    right = la.solve_triangular(R, inner.T, lower=True)
    U, T = la.qr(V)
    size = min(T.shape)
    value, vector = np.linalg.eigh(T[:size] @ x.D @ T[:size].T)
    bounded = vector * np.minimum(value, 1.0)[:, None]  # V D V^T <= I, but for rounding
    D = bounded @ vector.conj().swapaxes(1, 2)
    single, D, eye = np.tensordot(c, D.real, 1), D.reshape(len(c), -1), np.eye(size)
    double = ((c[:, None] * D).T @ D).real.reshape(size, size, size, size)
    A = double.transpose(0, 3, 1, 2).reshape(size**2, size**2) + weight * np.eye(size**2)
    A -= np.kron(single, eye) + np.kron(eye, single)
    Z = U.T @ right @ U
    Z[:size, :size] = la.solve(A, Z[:size, :size].ravel()).reshape(size, size)
    Z[:size, size:] = la.solve(weight * eye - single, Z[:size, size:], assume_a="pos")
    Z[size:, :size], Z[size:, size:] = Z[:size, size:].T, Z[size:, size:] / weight
    z, vector = la.eigh((Z + Z.T) / 2)
    return R @ U @ vector, z


def _with_background(
    band: Band, model: Density, x: _Matrices, share: float
) -> tuple[Density, _Matrices, float]:
    """Return the model after a step of its background, its matrices, and the share of the next.

    The step is halved until the cost falls.
    """
    Q, z = _background(band, model, x)
    z = np.maximum(z, -MOST_OF_BACKGROUND)
    while share > SHORTEST:
        trial = replace(model, background=(Q * (1 + share * z)) @ Q.T)
        after = _matrices(band, trial)
        if after.cost <= x.cost:
            return trial, after, min(2 * share, 1.0)
        share /= 2
    return model, x, 1.0


def maximise(band: Band, model: Density, most: int = MOST_STEPS) -> Fit:
    """Return the model of the greatest likelihood near a given one, by scoring.

    Scoring is Newton's method with the expected second derivatives; where a step would increase the
    cost, it is damped as Levenberg and Marquardt do. The background follows every step.
    """
    fit, damping, share = evaluate(band, _normalised(model)), 1e-3, 1.0
    for _ in range(most):
        A, scale = fit.scaled(fit.bending)
        value, vector = la.eigh(A)
        weights = vector.T @ (scale * fit.gradient) / (np.maximum(value, 1e-10) + damping)
        trial = _moved(fit.model, -scale * (vector @ weights))
        x = _matrices(band, trial)
        if not x.cost < fit.cost + TOLERANCE:
            damping = max(8 * damping, 1e-3)
            if damping > 1e8:
                break
            continue
        before = fit.cost
        trial, x, share = _with_background(band, trial, x, share)
        fit = evaluate(band, trial, x)
        damping = damping / 8
        if abs(before - fit.cost) < TOLERANCE and damping < 1e-2:
            return replace(fit, converged=True)
    return fit


def excess(band: Band, model: Density) -> float:
    r"""Return what a band holds beside a model, as the most that something else could gain.

    Data are whitened with :math:`E = L L^*`. Where W is the mean of their :math:`F F^*` over the c
    lines of a window, and w its greatest eigenvalue, what adds to E there gains up to
    :math:`2 c (w - 1 - \ln w)` in twice the cost. Windows have 1, 2, 4, ... blocks, and reach no
    end of the band: what does is the flank of what moves outside of it.
    """
    moved = model.columns @ model.lifted(band.omega, band.order) @ model.root
    E = moved @ moved.conj().swapaxes(1, 2) + model.background
    L = np.linalg.cholesky(E)
    half = np.linalg.solve(L, band.power).conj().swapaxes(1, 2)
    white = band.count[:, None, None] * np.linalg.solve(L, half)
    most, blocks = 0.0, len(L)
    for size in (2**k for k in range((blocks - 2).bit_length())):
        first = np.arange(1, blocks - size, max(size // 2, 1))
        window = first[:, None] + np.arange(size)
        c = band.count[window].sum(axis=1)
        mean = white[window].sum(axis=1) / c[:, None, None]
        w = np.maximum(np.linalg.eigvalsh(mean)[:, -1], 1.0)
        most = max(most, float((2 * c * (w - 1 - np.log(w))).max()))
    return most


def _moved(model: Density, step: Floats) -> Density:
    """Return the model after a step, which is limited in frequency and damping."""
    n, m, v = len(model.phi), model.free, model.moving
    moved, omega, zeta, root = np.split(step, np.cumsum([v * n, m, m]))
    change, L = moved.reshape(v, n).T, model.root.copy()
    phi = np.hstack([model.phi[:, :m] + change[:, :m], model.phi[:, m:]])
    rows, columns, units = _entries(len(L))
    np.add.at(L, (rows, columns), units * root)
    new_omega, new_zeta = model.omega.copy(), model.zeta.copy()
    reach = LONGEST * np.maximum(model.zeta[:m], 1e-4)
    new_omega[:m] *= np.exp(np.clip(omega, -reach, reach))
    new_zeta[:m] *= np.exp(np.clip(zeta, -LONGEST, LONGEST))
    new_zeta = np.clip(new_zeta, LEAST_DAMPING, GREATEST_DAMPING)
    return _normalised(
        replace(
            model,
            omega=new_omega,
            zeta=new_zeta,
            phi=phi,
            root=L,
            coherent=model.coherent + change[:, m:],
        )
    )


def _normalised(model: Density) -> Density:
    """Return the same model with shapes of unit norm."""
    norm = np.linalg.norm(model.phi, axis=0)
    return replace(
        model,
        phi=model.phi / norm,
        root=model.root * norm[:, None],
        coherent=model.coherent / np.resize(norm[: model.free], model.coherent.shape[1]),
    )
