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
TOLERANCE = 1e-2  # change of the cost at a maximum, at most: a half is one standard deviation
MOST_STEPS = 60  # steps to a maximum, at most
MOST_OF_BACKGROUND = 0.9  # share of the background that a step takes away, at most
SHORTEST = 1e-3  # share of a step of the background below which it is left out
TERMS = 2  # terms of what a force moves besides, over frequency: a constant and a slope
COHERENT = 0.25  # standard deviation of either term at the ends of a band, over a mode's peak
LONGEST = 1.0  # change of ln zeta, and of ln omega in half bandwidths, in one step, at most
LEAST_DAMPING, GREATEST_DAMPING = 1e-7, 0.5  # limits of damping ratios in a search
LEAST_KNOWN = 1e-13  # least eigenvalue of the scaled information that is more than rounding
TINY = 1e-100


@dataclass(frozen=True)
class Band:
    """Periodograms of the records of one setup, means over blocks of neighbouring lines."""

    omega: Floats  # (blocks,) rad/s, of the middle
    count: Floats  # (blocks,) number of lines
    power: Complexes  # (blocks, sensors, sensors) mean of F F^*, a two-sided spectral density
    order: int  # differentiations of the displacement in the records
    floor: Floats  # (sensors,) variances of the background a priori

    @cached_property
    def total(self) -> Floats:
        """Sum of the real part of F F^* over the lines, and of the background a priori."""
        prior = (PRIOR + len(self.floor)) * np.diag(self.floor)
        return np.tensordot(self.count, self.power.real, 1) + prior

    @cached_property
    def weight(self) -> float:
        """Number of lines, and of those that the prior is worth."""
        return float(self.count.sum() + PRIOR + len(self.floor))


@dataclass(frozen=True)
class Density:
    """A model of the spectral density in a band."""

    omega: Floats  # omega, zeta: (modes,) natural frequencies in rad/s and damping ratios
    zeta: Floats
    phi: Floats  # (sensors, modes) shapes of unit norm
    root: Complexes  # (modes, modes) L
    background: Floats  # (sensors, sensors) B
    free: int  # number of the modes that are in the band, the first ones
    coherent: Floats  # (sensors, terms x free) R, all constants first; no terms for none
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

    def factors(self, omega: Floats, order: int) -> tuple[Complexes, Complexes]:
        """Return H L and the lower triangular root of E at circular frequencies."""
        half = self.lifted(omega, order) @ self.root
        moved = self.columns @ half
        E = moved @ moved.conj().swapaxes(1, 2) + self.background
        return half, np.asarray(np.linalg.cholesky(E), complex)

    def with_coherent(self, band: Band) -> "Density":
        """Return the same model with R = 0 as parameters, in the middle of a band.

        A priori, either term is at the ends of the band `COHERENT` of the mode's own peak.
        """
        first, last = band.omega[[0, -1]]
        reach = (last - first) / (first + last)  # half the width over the middle
        n, size = len(self.phi), COHERENT / reach ** np.arange(TERMS)
        precision: Floats = n / size.repeat(self.free) ** 2
        R, middle = np.zeros((n, len(precision))), float(first + last) / 2
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


class Fit:
    """A model beside the data: the cost and its derivatives by the parameters.

    The parameters are the shapes (mode by mode), R in the same way, ln omega and ln zeta of the
    free modes, and the real and imaginary part of L (row by row, the lower triangle).

    Matrices of the module's text are those of all blocks, (blocks, columns, columns). ``h`` is H,
    ``seen`` is F F^* hat of the data, (blocks, sensors, columns), ``own`` is hat^T F F^* hat, and
    ``weighted`` is D times the number of lines.
    """

    def __init__(self, band: Band, model: Density) -> None:
        self.band, self.model, self.converged = band, model, False
        n, B, psi = len(model.phi), model.background, model.columns
        inverse, self.h = np.linalg.inv(B), model.lifted(band.omega, band.order)
        self.hat = inverse @ psi
        P, root = psi.T @ self.hat, self.h @ model.root
        adjoint = root.conj().swapaxes(1, 2)
        A = adjoint @ P @ root
        # Of forces that cancel each other, rounding is all that is known of the determinant.
        lost = ~(np.finfo(float).eps * np.einsum("kii->k", A).real < TOLERANCE)
        A[lost] = 0.0
        L = np.linalg.cholesky(A + np.eye(A.shape[1]))
        half = np.linalg.solve(L, adjoint)
        determinant = 2 * np.log(np.einsum("kii->ki", L).real).sum(axis=1)
        determinant[lost] = np.inf
        self.N, self.D = root @ adjoint, half.conj().swapaxes(1, 2) @ half
        self.Y = np.asarray(np.eye(len(P)) - self.D @ P, complex)
        self.C = P @ self.Y
        self.seen = (band.power.reshape(-1, n) @ self.hat).reshape(len(self.h), *self.hat.shape)
        self.own, self.weighted = self.hat.T @ self.seen, band.count[:, None, None] * self.D
        cost = band.weight * np.linalg.slogdet(B)[1] + np.vdot(inverse, band.total)
        cost += band.count @ determinant
        cost -= np.vdot(self.weighted.conj(), self.own.swapaxes(1, 2)).real
        self.cost = float(cost + np.sum(model.precision * model.coherent**2) / 2)

    @cached_property
    def both(self) -> Complexes:
        """Sum of D hat^T F F^* over the lines, of w F^* as expected, (columns, sensors)."""
        return np.tensordot(self.weighted, self.seen.conj(), ((0, 2), (0, 2)))

    @cached_property
    def second(self) -> Complexes:
        """Sum of w w^* as expected, (columns, columns); w are the responses to the forces."""
        return (self.weighted + self.weighted @ self.own @ self.D).sum(axis=0)

    @cached_property
    def of_poles(self) -> Complexes:
        """Changes of ln h by ln omega and by ln zeta of free modes, (blocks, 2 free)."""
        model, order = self.model, self.band.order
        zeta, x = model.zeta[: model.free], self.band.omega[:, None] / model.omega[: model.free]
        inner = 1 - x**2 + 2j * zeta * x
        return np.hstack([-order - (2 * x**2 - 2j * zeta * x) / inner, (1 - x**2) / inner])

    @cached_property
    def of_forces(self) -> Complexes:
        """Changes of S by the parameters of L, (parameters, modes, modes)."""
        root = self.model.root
        rows, columns, units = _entries(len(root))
        J = np.zeros((len(rows), *root.shape), complex)
        J[np.arange(len(rows)), rows] = units[:, None] * root[:, columns].conj().T
        return J + J.conj().swapaxes(1, 2)

    @cached_property
    def slope(self) -> Complexes:
        """Changes of the cost by N, (blocks, columns, columns)."""
        expected = self.C - self.Y.conj().swapaxes(1, 2) @ self.own @ self.Y
        return self.band.count[:, None, None] * expected

    @cached_property
    def slope_of_forces(self) -> Complexes:
        """Changes of the cost by S, (modes, modes)."""
        return (self.h.conj().swapaxes(1, 2) @ self.slope @ self.h).sum(axis=0)

    @cached_property
    def gradient(self) -> Floats:
        """Changes of the cost by the parameters."""
        model, m = self.model, self.model.free
        measured = np.linalg.solve(model.background, self.both.T).T
        columns = 2 * (self.second @ self.hat.T - measured).real
        columns[m : model.moving] += (model.precision * model.coherent).T
        NW = np.sum(self.N * self.slope.swapaxes(1, 2), axis=2)[:, :m]
        poles = 2 * np.sum(self.of_poles * np.hstack([NW, NW]), axis=0).real
        whole = self.slope_of_forces.T.ravel()
        forces = (self.of_forces.reshape(len(self.of_forces), whole.size) @ whole).real
        return np.concatenate([columns[: model.moving].ravel(), poles, forces])

    @cached_property
    def bending(self) -> Floats:
        """Second derivatives of the cost by the parameters of L, of those of S, tr G dL dL^*.

        G is the gradient by S, without its negative part: S on the boundary of what is possible, as
        where two shapes are alike, has a singular L, by which expected derivatives alone vanish.
        """
        value, vector = np.linalg.eigh(self.slope_of_forces)
        rows, columns, units = _entries(len(value))
        G = vector * np.maximum(value, 0.0) @ vector.conj().T
        same = columns[:, None] == columns
        return 2 * same * (units.conj()[:, None] * G[np.ix_(rows, rows)] * units).real

    @cached_property
    def information(self) -> Floats:
        """Expected second derivatives of the cost, tr E^-1 dE E^-1 dE over the lines.

        With a = Psi N, shapes and R change E by e_j a_r^* and its adjoint, poles by d phi_r a_r^*
        and its adjoint, forces by Psi H J H^* Psi^T. Letters below: shapes, poles, forces.
        """
        model, c, d, J = self.model, self.band.count, self.of_poles, self.of_forces
        (n, M), m, v = model.phi.shape, model.free, model.moving
        mode = np.tile(np.arange(m), 2)
        hat, h, D, C, Q, NC = self.hat, self.h, self.D, self.C, self.N - self.D, self.N @ self.C
        adjoint, left = self.Y.conj().swapaxes(1, 2), h.conj().swapaxes(1, 2)
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
        parts = [[2 * SS, 2 * SP, 2 * SF], [2 * SP.T, 2 * PP, 2 * PF], [2 * SF.T, 2 * PF.T, FF]]
        out = np.block(parts).real
        return out + np.diag(model.prior(len(out)))

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


@cache
def _entries(M: int) -> tuple[Ints, Ints, Complexes]:
    """Return rows, columns and units of the parameters of L."""
    i, j = np.tril_indices(M)
    parts = np.where(j < i, 2, 1)
    rows, columns = np.repeat(i, parts), np.repeat(j, parts)
    again = np.diff(rows * M + columns, prepend=-1) == 0
    return rows, columns, np.where(again, 1j, 1.0)


def _with_background(x: Fit, share: float) -> tuple[Fit, float]:
    r"""Return a model after a step of its background, beside the data, and the share of the next.

    It is a step of scoring, halved until the cost falls. With B = R R^T and changes R Z R^T, the
    second derivatives are :math:`\sum_k (I - V D V^T) Z (I - V D V^T)`, V = R^-1 Psi, and the
    gradient is the step of expectation and maximisation times the number of lines. In an
    orthonormal basis U of V and beside it, the parts of Z are solved for one by one.
    """
    band, model, psi = x.band, x.model, x.model.columns
    c, weight, both = band.count, band.weight, (psi @ x.both).real
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
    z, Q = np.maximum(z, -MOST_OF_BACKGROUND), R @ U @ vector
    while share > SHORTEST:
        trial = Fit(band, replace(model, background=(Q * (1 + share * z)) @ Q.T))
        if trial.cost <= x.cost:
            return trial, min(2 * share, 1.0)
        share /= 2
    return x, 1.0


def maximise(band: Band, model: Density, most: int = MOST_STEPS) -> Fit:
    """Return the model of the greatest likelihood near a given one, by scoring.

    Scoring is Newton's method with the expected second derivatives; where a step would increase the
    cost, it is damped as Levenberg and Marquardt do. The background follows every step.
    """
    fit, damping, share = Fit(band, _normalised(model)), 1e-3, 1.0
    for _ in range(most):
        A, scale = fit.scaled(fit.bending)
        value, vector = la.eigh(A)
        weights = vector.T @ (scale * fit.gradient) / (np.maximum(value, 1e-10) + damping)
        trial = Fit(band, _moved(fit.model, -scale * (vector @ weights)))
        if not trial.cost < fit.cost + TOLERANCE:
            damping = max(8 * damping, 1e-3)
            if damping > 1e8:
                break
            continue
        before = fit.cost
        fit, share = _with_background(trial, share)
        damping = damping / 8
        if abs(before - fit.cost) < TOLERANCE and damping < 1e-2:
            fit.converged = True
            break
    return fit


def excess(band: Band, model: Density) -> float:
    r"""Return what a band holds beside a model, as the most that something else could gain.

    Data are whitened with :math:`E = L L^*`. Where W is the mean of their :math:`F F^*` over the c
    lines of a window, and w its greatest eigenvalue, what adds to E there gains up to
    :math:`2 c (w - 1 - \ln w)` in twice the cost. Windows have 1, 2, 4, ... blocks, and reach no
    end of the band: what does is the flank of what moves outside of it.
    """
    L = model.factors(band.omega, band.order)[1]
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
    w, z, R = model.omega.copy(), model.zeta.copy(), model.coherent + change[:, m:]
    reach = LONGEST * np.maximum(model.zeta[:m], 1e-4)
    w[:m] *= np.exp(np.clip(omega, -reach, reach))
    z[:m] *= np.exp(np.clip(zeta, -LONGEST, LONGEST))
    z = np.clip(z, LEAST_DAMPING, GREATEST_DAMPING)
    return _normalised(replace(model, omega=w, zeta=z, phi=phi, root=L, coherent=R))


def _normalised(model: Density) -> Density:
    """Return the same model with shapes of unit norm."""
    norm = np.linalg.norm(model.phi, axis=0)
    R = model.coherent / np.resize(norm[: model.free], model.coherent.shape[1])
    return replace(model, phi=model.phi / norm, root=model.root * norm[:, None], coherent=R)
