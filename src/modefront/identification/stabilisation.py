"""The stabilisation diagram, clusters of its stable poles, and mode indicator functions.

They are those of docs/methods/identification.md and docs/methods/deviations.md.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy.linalg as la
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from modefront._typing import Bools, Complexes, Floats, Ints
from modefront.data.responses import ORDERS, FrequencyResponses
from modefront.identification import lscf
from modefront.linalg.small import mac
from modefront.rounding import TINY

MOST_POLES = 160  # poles at the highest order: some four for each of forty modes
MOST_ORDERS = 25  # orders of a diagram; more add no information to clusters of poles
CUT = 0.05  # distance within which poles of neighbouring orders are stable, and of one cluster
LEAST_ORDERS = 3  # orders on which a cluster has to be before a fit starts from it
SHAPE_LINES = 4096  # from which shapes are taken where there are more, those at poles apart
NEXT = 8  # lines on either side of a pole that its shape is taken from
LEAST = 1e-12  # share of the mean motion by which none at all is told apart by an indicator
MOST_DAMPING = 0.3  # damping ratio from which on a pole is no mode


@dataclass(frozen=True)
class StabilisationDiagram:
    """Poles of all orders."""

    order: Ints  # (poles,) order at which each was found
    pole: Complexes  # (poles,) rad/s
    participation: Complexes  # (poles, references)
    stable: Bools  # (poles,) whether the nearest pole of the order below is within `CUT`
    orders: tuple[int, ...]  # all orders
    clusters: Ints  # positions of the poles nearest to the medians of clusters, by frequency

    @property
    def frequency(self) -> Floats:
        """Natural frequencies in Hz."""
        return np.abs(self.pole) / (2 * np.pi)

    @property
    def damping(self) -> Floats:
        """Damping ratios."""
        return -self.pole.real / np.abs(self.pole)


def diagram_of(data: FrequencyResponses, variance: Floats) -> StabilisationDiagram:
    """Return the diagram of functions by least squares (`lscf`).

    ``variance`` weights the lines; any of its axes may be 1. A cluster is on `LEAST_ORDERS` orders.
    """
    weight = np.mean(1 / variance, axis=(0, 1))
    omega = 2 * np.pi * data.frequency
    rate = 2 * np.pi * lscf.ARC / (omega[-1] - omega[0])
    most = min(max(MOST_POLES // len(data.H), 6), len(omega) // 4)
    orders = sorted(set(np.linspace(2, most, min(MOST_ORDERS, most - 1)).astype(int).tolist()))
    z: Complexes = np.exp(1j * rate * (omega - omega[0]))
    sums = lscf.moments(data.H, weight / weight.max(), z, max(orders))
    kept = []
    for order in orders:
        lam, L = lscf.poles(sums, order, omega[0], rate, data.decay)
        good = -lam.real < MOST_DAMPING * np.abs(lam)
        kept.append((lam[good], L[good]))
    s: Complexes = np.asarray(1j * omega + data.decay, complex)
    # shapes are taken from every n-th line, and from those next to poles
    lines: Bools = np.arange(len(s)) % -(-len(s) // SHAPE_LINES) == 0
    pole, participation = (np.concatenate(parts) for parts in zip(*kept, strict=True))
    nearest = np.searchsorted(s.imag, pole.imag)[:, None] + np.arange(-NEXT, NEXT + 1)
    lines[np.clip(nearest, 0, len(s) - 1)] = True
    H, q = data.H[..., lines], ORDERS[data.quantity]
    shapes = [shapes_of(*poles, H, s[lines], q) for poles in kept]
    distance = [np.full(len(shapes[0]), np.inf)]
    for ((below, _), psi_below), ((now, _), psi) in pairwise(zip(kept, shapes, strict=True)):
        distance.append(_distances(now, psi, below, psi_below).min(axis=1, initial=np.inf))
    order, stable = np.repeat(orders, list(map(len, shapes))), np.concatenate(distance) < CUT
    clusters = _clusters(order, pole, np.flatnonzero(stable), np.concatenate(shapes)[stable])
    return StabilisationDiagram(order, pole, participation, stable, tuple(orders), clusters)


def shapes_of(lam: Complexes, L: Complexes, H: Complexes, s: Complexes, q: int) -> Complexes:
    """Return shapes of the poles of one order, (poles, responses), by linear least squares."""
    n, n_in = L.shape
    size = abs(s[-1])
    front = (s / size) ** q
    modal = front * size / (s - lam[:, None])
    residual = np.stack([front, front * (size / s) ** 2])
    normal = np.zeros((n + 2 * n_in, n + 2 * n_in), complex)
    right = np.zeros((n + 2 * n_in, H.shape[1]), complex)
    for j in range(n_in):
        basis = np.zeros((n + 2 * n_in, len(s)), complex)
        basis[:n] = L[:, j, None] * modal
        basis[n + 2 * j : n + 2 * j + 2] = residual
        normal += basis.conj() @ basis.T
        right += basis.conj() @ H[j].T
    scale = 1 / np.sqrt(np.maximum(normal.diagonal().real, TINY))
    scaled = normal * np.outer(scale, scale) + 1e-13 * np.eye(len(scale))
    return (scale[:, None] * la.solve(scaled, scale[:, None] * right))[:n]


def _distances(a: Complexes, psi_a: Complexes, b: Complexes, psi_b: Complexes) -> Floats:
    """Return d of every pole of one list and every pole of another."""
    size = np.maximum(np.abs(a)[:, None], np.abs(b)[None])
    return np.abs(a[:, None] - b) / size + np.maximum(1 - mac(psi_a.T, psi_b.T), 0)


def _clusters(order: Ints, pole: Complexes, stable: Ints, psi: Complexes) -> Ints:
    """Return the pole of each cluster of stable ones that is nearest to the median of its members.

    ``psi`` are the shapes of the stable ones.
    """
    number = np.ones(len(stable), int)
    if len(stable) > 1:
        d = _distances(pole[stable], psi, pole[stable], psi)
        tree = linkage(squareform((d + d.T) / 2, checks=False), "average")
        number = fcluster(tree, CUT, "distance")
    chosen = []
    for members in (stable[number == k] for k in np.unique(number)):
        middle = np.median(pole[members].real) + 1j * np.median(pole[members].imag)
        if len(np.unique(order[members])) >= LEAST_ORDERS:
            chosen.append(int(members[np.abs(pole[members] - middle).argmin()]))
    return np.array(sorted(chosen, key=lambda k: pole[k].imag), int)


def support(diagram: StabilisationDiagram, pole: Complexes, strength: Floats) -> Floats:
    """Return the share of the orders, from the first one with a mode's pole, that have it.

    ``pole`` and ``strength`` are those of all modes. At each order a pole of the diagram belongs to
    one mode, the stronger ones first, so that two modes need two poles.
    """
    present = np.zeros((len(pole), len(diagram.orders)), bool)
    reach = np.maximum(0.005 * np.abs(pole), -0.5 * pole.real)
    for k, order in enumerate(diagram.orders):
        left = diagram.pole[diagram.order == order]
        for r in strength.argsort()[::-1]:
            distance = np.abs(left - pole[r])
            if distance.min(initial=np.inf) < reach[r]:
                present[r, k] = True
                left = np.delete(left, distance.argmin())
    since = np.maximum.accumulate(present, axis=1).sum(axis=1)
    return present.sum(axis=1) / np.maximum(since, 1)


def complex_indicators(data: FrequencyResponses) -> Floats:
    """Return the complex mode indicator functions, (references, lines), the greatest first."""
    H = np.where(data.measured, data.H, 0).transpose(2, 0, 1)
    return np.linalg.svd(H, compute_uv=False).T ** 2


def multivariate_indicators(data: FrequencyResponses) -> Floats:
    """Return the multivariate mode indicator functions, (references, lines), the least first."""
    H = np.where(data.measured, data.H, 0).transpose(2, 1, 0)
    inphase, quadrature = (H.imag, H.real) if data.quantity == "mobility" else (H.real, H.imag)
    A = inphase.swapaxes(1, 2) @ inphase
    total = A + quadrature.swapaxes(1, 2) @ quadrature
    size = np.trace(total, axis1=1, axis2=2)[:, None, None] / total.shape[1]
    total = total + (LEAST * np.maximum(size, TINY)) * np.eye(total.shape[1])
    root = np.linalg.inv(np.linalg.cholesky(total))
    out: Floats = np.linalg.eigvalsh(root @ A @ root.swapaxes(1, 2)).T
    return np.clip(out, 0, 1)
