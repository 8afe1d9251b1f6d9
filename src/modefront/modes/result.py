r"""The modes of a model: at its sensors, with derivatives, and at all degrees of freedom.

Second derivatives are exact, by second-order adjoints.
Of :math:`g = \sum_r w_r \lambda_r + b_r^T \varphi_r` with constant weights, let
:math:`F_i = K_i - \lambda_r M_i` and :math:`A^+` be the pseudoinverse of :math:`K - \lambda_r M` on
the M-complement of mode r, an index i being a derivative; :math:`z = A^+ b`,
:math:`s = b^T \varphi` and :math:`y = w \varphi - z`, of each mode r. Differentiating

.. math:: (K - \lambda M) \varphi = 0, \qquad \varphi^T M \varphi = 1

twice gives :math:`\lambda_{ij}` (times :math:`\varphi^T` from the left), the part of
:math:`\varphi_{ij}` in the M-complement (times :math:`A^+`) and that along :math:`\varphi`. What is
left of :math:`g_{ij}` is, mode by mode, :math:`T_{ij} + T_{ji} + C_{ij}` with

.. math::
    T_{ij} &= \big(F_i y - s M_i \varphi - \tfrac12 s M \varphi_i\big)^T \varphi_j
        + \lambda_i \big(z^T (M \varphi_j + M_j \varphi)
        - \tfrac12 w\, \varphi^T M_j \varphi\big) \\
    C_{ij} &= y^T F_{ij} \varphi - \tfrac12 s\, \varphi^T M_{ij} \varphi .

K and M may be singular, and modes close: what is needed is in the first derivatives but for z. The
price is one product of each term of K and M with z, and one of N x p with N x p numbers, a mode.
Source: the equations of Fox & Kapoor 1968, doi:10.2514/3.5008, differentiated once more.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.linalg.affine import DenseAffine, SparseAffine, first_axis
from modefront.text import Shown

Solved: TypeAlias = tuple[Floats, Floats, Floats]
"""Some mass-normalised modes r at all degrees of freedom (N, modes), their derivatives
(N, modes, p), and adjoints z (N, adjoints)."""

Solve: TypeAlias = Callable[[Ints, Floats, Ints], Solved]
"""Returns modes r with the adjoints of weights b (sensors, adjoints), each that of the mode at
position ``owner`` (adjoints,) in r, when second derivatives are requested."""


@dataclass(frozen=True, eq=False)
class SecondDerivatives:
    """Second derivatives of modes at one theta, computed when they are requested."""

    K: DenseAffine | SparseAffine  # K, M: stiffness and mass matrix
    M: DenseAffine | SparseAffine
    theta: Floats  # (p,) parameters
    solve: Solve  # gives the modes at all degrees of freedom, and adjoints
    most: int  # number of modes that are solved for at once, at most

    def of_sums(self, modes: "Modes", r: Ints, w: Floats, v: Floats) -> Floats:
        """Return the Hessians of sum_r w_r lam_r + v_r^T phi_r for several w and v, (n, p, p).

        ``r`` are some of the modes, ``w`` has the shape (n, some) and ``v`` (n, sensors, some).
        """
        if not r.size:
            return np.zeros((len(w), self.theta.size, self.theta.size))
        if r.size > self.most:
            some, others = slice(self.most), slice(self.most, None)
            first = self.of_sums(modes, r[some], w[:, some], v[:, :, some])
            return first + self.of_sums(modes, r[others], w[:, others], v[:, :, others])
        # The forms are w times that of each eigenvalue, and that of each adjoint.
        of, owner = np.nonzero(v.any(axis=1))
        b = v[of, :, owner]
        s = np.vecdot(b, modes.phi[:, r[owner]].T)
        (Phi, dPhi, Z), mass = self.solve(r, b.T, owner), self.M.at(self.theta)
        (N, m, p), mode = dPhi.shape, np.append(np.arange(r.size), owner)
        vectors, dlam = np.hstack([Phi, -Z]), modes.dlam[r[mode]]
        MdPhi = (mass @ dPhi.reshape(N, -1)).reshape(N, m, p)
        forms = self.K.derivative_forms(self.theta, vectors, dPhi, mode)
        inner = 0.5 * MdPhi.transpose(1, 2, 0) @ dPhi.transpose(1, 0, 2)
        c = np.zeros((mode.size, p))
        c[m:] = np.einsum("nk,nki->ki", Z, MdPhi[:, owner])
        if self.M.coefficients.varies:
            right = np.concatenate([dPhi, Phi[:, :, None]], axis=2)
            of_mass = self.M.derivative_forms(self.theta, vectors, right, mode)
            forms -= modes.lam[r[mode], None, None] * of_mass[:, :, :p]
            inner += of_mass[:m, :, :p]
            c -= np.append(np.full(m, 0.5), np.ones(owner.size))[:, None] * of_mass[:, :, p]
        forms[m:] -= s[:, None, None] * inner[owner]
        weights = np.hstack([w, np.arange(len(w))[:, None] == of])
        T = first_axis(weights, forms) + dlam.T @ (weights[:, :, None] * c)
        out: Floats = T + T.transpose(0, 2, 1)
        if self.K.coefficients.curved or self.M.coefficients.curved:
            y, sphi = w[:, None] * Phi, np.zeros((len(w), N, m))
            y[of, :, owner] -= Z.T
            sphi[of, :, owner] = (s * Phi[:, owner]).T
            out += self.K.second_derivatives(self.theta, y, Phi)
            out -= self.M.second_derivatives(self.theta, modes.lam[r] * y + 0.5 * sphi, Phi)
        return out


@dataclass(frozen=True, repr=False)
class ModeDerivatives(Shown):
    """Derivatives of modes with respect to the parameters."""

    # (modes, parameters) derivatives of eigenvalues; for coinciding modes, those of the ascending
    # eigenvalues as the parameter alone increases
    dlam: Floats
    # (sensors, modes, parameters) derivatives of mode shapes; for coinciding modes, only the part
    # that leaves their common subspace, which is the well-defined one
    dphi: Floats
    # (modes,) true where a mode is so close to another one that derivatives of the single mode are
    # not defined to eight digits, and only those of the subspace are
    coincident: Bools
    second: SecondDerivatives | None = None  # computed when requested; None where not known


@dataclass(frozen=True, repr=False)
class Modes(Shown):
    """The lowest modes of a model, in ascending order, seen at its sensors."""

    lam: Floats  # (modes,) eigenvalues omega**2 in (rad/s)**2
    phi: Floats  # (sensors, modes) mass-normalised shapes at the sensors; the sign is arbitrary
    derivatives: ModeDerivatives | None = None  # by the parameters; None where not requested

    @property
    def dlam(self) -> Floats:
        """Derivatives of ``lam``; raises ValueError where they were not requested."""
        return self._requested.dlam

    @property
    def dphi(self) -> Floats:
        """Derivatives of ``phi``; raises ValueError where they were not requested."""
        return self._requested.dphi

    @property
    def coincident(self) -> Bools:
        """Which modes have no derivatives of their own, (modes,); none without derivatives."""
        none = np.zeros(self.lam.size, dtype=np.bool_)
        return none if self.derivatives is None else self.derivatives.coincident

    def second_derivatives(self, w: Floats, v: Floats) -> Floats | None:
        """Return the Hessians of sum_r w_r lam_r + v_r^T phi_r for several w and v, (n, p, p).

        ``w`` has the shape (n, modes) and ``v`` (n, sensors, modes). None where second derivatives
        are not known, or a mode with weights coincides with another one. Raises ValueError where
        derivatives were not requested, and ModelError where an iteration for them fails.
        """
        r, second = np.flatnonzero(w.any(axis=0) | v.any(axis=(0, 1))), self._requested.second
        if second is None or self.coincident[r].any():
            return None
        return second.of_sums(self, r, w[:, r], v[:, :, r])

    @property
    def _requested(self) -> ModeDerivatives:
        if self.derivatives is None:
            raise ValueError("expected modes with derivatives, found modes without")
        return self.derivatives

    @cached_property
    def frequency(self) -> Floats:
        """Natural frequencies in Hz, shape (modes,); zero for rigid-body modes."""
        return np.sqrt(np.maximum(self.lam, 0.0)) / (2 * np.pi)

    @cached_property
    def dfrequency(self) -> Floats:
        """Derivatives of ``frequency``, (modes, parameters); ValueError if they are not there."""
        return self.dlam * self.frequency_by_lam[:, None]

    @cached_property
    def frequency_by_lam(self) -> Floats:
        """Derivatives of the frequencies by their eigenvalues, (modes,); 0 for rigid-body modes."""
        omega = np.sqrt(np.maximum(self.lam, 0.0))
        return np.divide(1, 4 * np.pi * omega, out=np.zeros(omega.shape), where=omega > 0)


@dataclass(frozen=True)
class FullModes:
    """The lowest modes of a model at one theta, and its static response."""

    lam: Floats  # (modes,) eigenvalues omega**2 in (rad/s)**2, ascending; 0 for rigid-body modes
    Phi: Floats  # (N, modes) mass-normalised modes; the sign is arbitrary
    static: Floats | None  # (N, loads) displacement under each load; None with rigid-body modes
