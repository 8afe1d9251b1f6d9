"""Vector problems with known answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, infeasible
from modefront.work.task import Costs, spend

Derivatives = tuple[Floats, Floats, Floats]


@dataclass(frozen=True)
class Known:
    """A problem from a function that returns J, dJ and a known part H of the second derivatives."""

    function: Callable[[Floats], Derivatives]
    lower: Floats
    upper: Floats
    start: Floats
    objectives: tuple[str, ...]

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        assert (theta >= self.lower).all()
        assert (theta <= self.upper).all()
        spend(Costs(eigenproblems=1))
        J, dJ, H = self.function(theta)
        if not np.isfinite(J).all():
            return infeasible(theta, len(self.objectives))
        return Evaluation(theta, J, dJ, H) if derivatives else Evaluation(theta, J)


def box(
    function: Callable[[Floats], Derivatives], lower: list[float], upper: list[float], n: int = 2
) -> Known:
    lo, hi = np.array(lower), np.array(upper)
    names = tuple(f"J{i + 1}" for i in range(n))
    return Known(function, lo, hi, lo + 0.4 * (hi - lo), names)


def circles(theta: Floats) -> Derivatives:
    """Squared distances from (0, 0) and (1, 0): the Pareto set is the segment between them.

    On the front, sqrt(J1) + sqrt(J2) = 1.
    """
    r = theta - np.array([[0.0, 0.0], [1.0, 0.0]])
    return (r**2).sum(axis=1), 2 * r, np.array([2 * np.eye(2)] * 2)


def curved(theta: Floats) -> Derivatives:
    """Distances as before, in coordinates that bend: no second derivatives are known."""
    x, y = theta
    u = np.array([x, y - x**2])
    du = np.array([[1.0, 0.0], [-2 * x, 1.0]])
    J, dJ, _ = circles(u)
    return J, dJ @ du, np.zeros((2, 2, 2))


def concave(theta: Floats) -> Derivatives:
    """Fonseca and Fleming's problem: a front that bends the wrong way for weights."""
    c = 1 / np.sqrt(theta.size)
    d = theta - np.array([[c], [-c]])
    e = np.exp(-(d**2).sum(axis=1))
    dJ = 2 * d * e[:, None]
    outer = d[:, :, None] * d[:, None, :]
    H = e[:, None, None] * (2 * np.eye(theta.size) - 4 * outer)
    return 1 - e, dJ, H


def disconnected(theta: Floats) -> Derivatives:
    """J1 = x, J2 = f(x) + y**2 with f(x) = 1 - x - sin(4 pi x) / 4: falling, rising, falling.

    f falls to 0.612 at x = 0.151, rises, and comes back to that level at x = 0.43.
    """
    x, y = theta
    w = 4 * np.pi
    J = np.array([x, 1 - x - np.sin(w * x) / 4 + y**2])
    dJ = np.array([[1.0, 0.0], [-1 - w * np.cos(w * x) / 4, 2 * y]])
    H = np.zeros((2, 2, 2))
    H[1] = [[w**2 * np.sin(w * x) / 4, 0], [0, 2.0]]
    return J, dJ, H


def valley(theta: Floats) -> Derivatives:
    """J2 vanishes on the curve x y = 1; of its points, (1, 1) is the best one in J1."""
    x, y = theta
    r1 = np.array([x - 0.5, y - 0.5])
    r2, dr2 = np.array([x * y - 1]), np.array([[y, x]])
    J = np.array([r1 @ r1, r2 @ r2])
    return J, np.array([2 * r1, 2 * r2 @ dr2]), np.array([2 * np.eye(2), 2 * dr2.T @ dr2])


def three_wells(theta: Floats) -> Derivatives:
    """Squared distances of x from 0 and 1, in three wells along y with offsets of their own.

    Those near y = -1, 0 and 1 have about (0, 1), (0.05, 0.05) and (0.6, 0) and 0.01: the outer ones
    hold the edges, and the one between them nearly all of the front.
    """
    x, y = theta
    barrier = 20 * np.array([y**2 * (y**2 - 1) ** 2, 2 * y * (y**2 - 1) * (3 * y**2 - 1)])
    offsets = np.array([[0.06, 0.3, 0.25], [0.06, -0.5, 0.45]])
    J = np.array([x**2, (x - 1) ** 2]) + offsets @ [1, y, y**2] + barrier[0]
    slopes = offsets @ [0, 1, 2 * y] + barrier[1]
    return J, np.array([[2 * x, slopes[0]], [2 * (x - 1), slopes[1]]]), np.zeros((2, 2, 2))


def many_minima(theta: Floats) -> Derivatives:
    """J1 vanishes at (+-1, +-2), four models; J2 decides between them."""
    x, y = theta
    r, dr = np.array([x**2 - 1, y**2 - 4]), np.diag([2 * x, 2 * y])
    d = theta - np.array([1.5, -2.5])
    J = np.array([r @ r, d @ d])
    return J, np.array([2 * r @ dr, 2 * d]), np.array([2 * dr.T @ dr, 2 * np.eye(2)])


def bowls(theta: Floats) -> Derivatives:
    """Squared distances from the three corners of a triangle: its inside is the Pareto set."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    r = theta - corners
    return (r**2).sum(axis=1), 2 * r, np.array([2 * np.eye(2)] * 3)


def sphere(theta: Floats) -> Derivatives:
    """DTLZ2 (Deb et al. 2002) with one distance variable: its front is an octant of the sphere.

    theta = (x, y, z): angles over pi / 2, and z, which is 1 / 2 on the front.
    """
    a, b = np.pi / 2 * theta[:2]
    g = 1 + (theta[2] - 0.5) ** 2
    dg, half = 2 * (theta[2] - 0.5), np.pi / 2
    ca, sa, cb, sb = np.cos(a), np.sin(a), np.cos(b), np.sin(b)
    f = np.array([ca * cb, ca * sb, sa])
    fa, fb = half * np.array([-sa * cb, -sa * sb, ca]), half * np.array([-ca * sb, ca * cb, 0.0])
    fab = half**2 * np.array([sa * sb, -sa * cb, 0.0])
    fbb = half**2 * np.array([-ca * cb, -ca * sb, 0.0])
    H = np.empty((3, 3, 3))
    H[:, 0, 0], H[:, 1, 1], H[:, 2, 2] = -(half**2) * f * g, fbb * g, 2 * f
    H[:, 0, 1] = H[:, 1, 0] = fab * g
    H[:, 0, 2] = H[:, 2, 0] = fa * dg
    H[:, 1, 2] = H[:, 2, 1] = fb * dg
    return g * f, np.column_stack([fa * g, fb * g, dg * f]), H


FLAT_CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 0.25]])


def flat_bowls(theta: Floats) -> Derivatives:
    """Squared distances from the corners of a flat triangle: a convex front."""
    r = theta - FLAT_CORNERS
    return (r**2).sum(axis=1), 2 * r, np.array([2 * np.eye(2)] * 3)


def patches(theta: Floats) -> Derivatives:
    """DTLZ7 (Deb et al. 2002) with one distance variable, 0 on the front, which is four patches."""
    x, z = theta[:2], theta[2]
    w = 3 * np.pi
    s, c = np.sin(w * x), np.cos(w * x)
    g = 1 + z**2
    # f3 = 3 (1 + g) - sum x (1 + sin w x), with 1 + g = 1 + 1 + z**2 in the place of 1 + g.
    f3 = 3 * (1 + g) - (x * (1 + s)).sum()
    J = np.array([x[0], x[1], f3])
    slope = -(1 + s + x * w * c)
    dJ = np.array([[1.0, 0, 0], [0, 1.0, 0], [slope[0], slope[1], 6 * z]])
    H = np.zeros((3, 3, 3))
    H[2] = np.diag([*(-(2 * w * c - x * w**2 * s)), 6.0])
    return J, dJ, H
