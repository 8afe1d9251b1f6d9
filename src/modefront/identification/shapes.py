"""Real mode shapes from complex ones, and the share of the imaginary part.

Rotations, differentials and planes of pairs are derived in docs/methods/deviations.md.
"""

from dataclasses import dataclass

import numpy as np

from modefront._typing import Complexes, Floats
from modefront.rounding import TINY


@dataclass(frozen=True)
class RealShape:
    """A complex shape turned to be as real as it can be."""

    complex_shape: Complexes  # (responses,) rotated, its real part of unit norm
    shape: Floats  # (responses,) its real part
    collinearity: float  # MPC, modal phase collinearity, from 0 to 1
    norm: float  # that of the real part before it was scaled
    turn: complex  # the rotation, exp(-i theta); its sign makes the greatest component positive
    # (responses, 1 or 2) orthonormal shapes of which none changes in the span of them: the shape
    # itself, and the other one of a pair
    plane: Floats

    def differential(self, dphi: Complexes) -> Floats:
        """Return du for changes of the shape that was given, both (responses, changes)."""
        u, y = self.shape, self.complex_shape.imag
        change = self.turn * dphi / self.norm
        dtheta = (u @ change.imag + y @ change.real) / max(1 - float(y @ y), TINY)
        dx = change.real + np.outer(y, dtheta)
        return dx - self.plane @ (self.plane.T @ dx)


def real_shape(phi: Complexes) -> RealShape:
    """Return the rotation of a shape that loses least; its greatest component is positive."""
    return real_shapes(phi[None])[0]


def real_shapes(phi: Complexes) -> list[RealShape]:
    """Return the real shape of a mode, or those of a pair that has the basis of `plane_basis`."""
    turn = np.exp(-0.5j * np.angle(np.sum(phi**2)))
    psi = turn * phi
    if psi[0].real[np.abs(psi[0].real).argmax()] < 0:
        turn, psi = -turn, -psi
    norm = np.maximum(np.linalg.norm(psi.real, axis=1), TINY)
    psi = psi / norm[:, None]
    power = np.maximum(np.sum(np.abs(psi) ** 2, axis=1), TINY)
    mpc = np.minimum((np.abs(np.sum(psi**2, axis=1)) / power) ** 2, 1.0)
    each = zip(psi, mpc.tolist(), norm.tolist(), strict=True)
    return [RealShape(x, x.real, share, size, complex(turn), psi.real.T) for x, share, size in each]


def plane_basis(phi: Complexes) -> Complexes:
    """Return B so that the real parts of the shapes B phi, (2, responses), are orthonormal.

    They are the plane nearest to that of the shapes, (2, responses); the greatest component of
    either is positive.
    """
    span = np.linalg.svd(phi, full_matrices=False)[2]
    plane = np.linalg.svd(np.vstack([span.real, span.imag]), full_matrices=False)[2][:2]
    plane *= np.sign(plane[[0, 1], np.abs(plane).argmax(axis=1)])[:, None]
    B: Complexes = plane @ np.linalg.pinv(phi)
    x = (B @ phi).real
    return np.asarray(np.linalg.solve(np.linalg.cholesky(x @ x.T), B), complex)
