"""Modes of several data sets side by side, and the standard deviation between sets.

Modes of different sets are the same where frequencies lie within half a bandwidth, 0.5 % or
`WIDTH` standard deviations, and shapes agree at common sensors, but for those of close modes, which
each set may turn within their plane. Shapes are compared in the sign and scale of the first set
that has the mode. Equations: docs/methods/deviations.md.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg as la
from scipy.optimize import linear_sum_assignment
from scipy.special import gammaincinv

from modefront._typing import Floats, Ints
from modefront.data.modal import ModalData
from modefront.data.modal_test import joined
from modefront.identification.record import MOST_COVARIED, Identification, ModeEstimate
from modefront.identification.scan import alike

WIDTH = 5.0  # distance within which frequencies may belong to the same mode
LEAST_MAC = 0.5  # MAC from which on shapes may be of the same mode
SIGNIFICANT = 0.95  # level of the test of homogeneity; the 5 % that is usual
ROUNDING = 1e-12  # least variance of a component of a shape
MOST_STEPS = 50  # steps of Gauss and Newton, at most
TOLERANCE = 1e-10  # change of the norm of a setup's part of a shape below which the shape is found

TINY = 1e-100


@dataclass(frozen=True)
class CombinedModes:
    """Modes of all sets; NaN where a set does not have a mode."""

    # what studies read: real shapes of unit norm; deviations and covariances of shapes have the
    # spread of the sets in them
    data: ModalData
    damping_std: Floats  # (sets, modes) standard deviations, spread included
    spread: Floats  # (modes, 2) deviations of frequency and damping between sets; 0 if these agree
    index: tuple[tuple[int, ...], ...]  # (sets, modes) which mode of each set it is; -1 for none


def combine(sets: Sequence[str], identifications: Sequence[Identification]) -> CombinedModes:
    """Return the modes of several data sets under common numbers, by frequency."""
    sensors = tuple(dict.fromkeys(name for each in identifications for name in each.responses))
    groups = mode_groups([(each.responses, each.modes) for each in identifications])
    K, R, S = len(identifications), len(groups), len(sensors)
    index = tuple(tuple(group.get(k, -1) for group in groups) for k in range(K))
    pole, pole_std = np.full((2, 2, K, R), np.nan)  # frequencies, then damping ratios
    phi, phi_std = np.full((K, R, S), np.nan), np.full((K, R, S), np.nan)
    C = np.full((K, R, S, S), np.nan) if S <= MOST_COVARIED else None
    for r, group in enumerate(groups):
        for k, number in group.items():
            mode = identifications[k].modes[number]
            pole[:, k, r] = mode.frequency, mode.damping
            pole_std[:, k, r] = mode.frequency_std, mode.damping_std
            places = [sensors.index(name) for name in identifications[k].responses]
            phi_std[k, r, places] = mode.shape_std
            phi[k, r, places] = np.where(np.isfinite(mode.shape_std), mode.shape.shape, np.nan)
            if C is not None and mode.shape_covariance is not None:
                C[k, r][np.ix_(places, places)] = mode.shape_covariance
    paired = dict[int, int]()  # the other mode of each one of a pair, in the first set that has it
    for each, of_set in zip(identifications, index, strict=True):
        for pair in each.pairs:
            r, s = (of_set.index(k) for k in pair)
            if r not in paired and s not in paired:
                paired |= {r: s, s: r}
    spread = np.zeros((R, 2))
    for r in range(R):
        spread[r] = [between(*x) for x in zip(pole[..., r], pole_std[..., r], strict=True)]
        if r in paired:
            continue
        before = phi_std[:, r] ** 2
        phi[:, r], phi_std[:, r] = _shapes(phi[:, r], phi_std[:, r])
        if C is not None:
            C[:, r] += (phi_std[:, r] ** 2 - before)[:, None] * np.eye(S)
    f_std, z_std = np.hypot(pole_std, spread.T[:, None])
    pairs = tuple((r + 1, s + 1) for r, s in paired.items() if r < s)
    parts = (*pole, phi, f_std, phi_std, pairs, C)
    data = ModalData(tuple(sets), tuple(range(1, R + 1)), sensors, *parts)
    if C is not None:
        faulty = [[data.covariance_fault(k, r) is not None for r in range(R)] for k in range(K)]
        # Of functions without noise, there is only rounding.
        C = np.where(np.array(faulty)[..., None, None], np.nan, C)
        data = replace(data, shape_covariance=C if np.isfinite(C).any() else None)
    return CombinedModes(data, z_std, spread, index)


def between(x: Floats, std: Floats) -> float:
    """Return tau, the standard deviation between sets; 0 where they agree.

    >>> round(between(np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.1, 0.1])), 2)
    0.99
    >>> between(np.array([1.0, 1.1, 0.9]), np.array([0.1, 0.1, 0.1]))
    0.0
    """
    good = np.isfinite(x) & (std > 0)
    if good.sum() < 2:
        return 0.0
    x, weight = x[good], 1 / std[good] ** 2
    Q = float(np.sum(weight * (x - np.average(x, weights=weight)) ** 2))
    freedom = len(x) - 1
    if 2 * gammaincinv(freedom / 2, SIGNIFICANT) >= Q:
        return 0.0
    return float(np.sqrt((Q - freedom) / (weight.sum() - np.sum(weight**2) / weight.sum())))


ModesOfSet = tuple[Sequence[str], Sequence[ModeEstimate]]  # sensors and modes of one set


def mode_groups(sets: Sequence[ModesOfSet], least: float = LEAST_MAC) -> list[dict[int, int]]:
    """Return, for every mode of the structure, which mode of each set it is.

    All modes of a set are assigned at once, to as many modes of the sets before as agree, and by
    the greatest sum of their squared correlations. Shapes have a MAC of ``least`` or more.
    """
    groups: list[dict[int, int]] = []
    for k in joined([names for names, _ in sets]):
        own = sets[k]
        score = np.zeros((len(own[1]), len(groups)))
        for r, g in np.ndindex(score.shape):
            score[r, g] = max(_agreement(own, r, sets[j], s, least) for j, s in groups[g].items())
        rows, columns = linear_sum_assignment(score, maximize=True)
        known = {int(r): int(g) for r, g in zip(rows, columns, strict=True) if score[r, g] > 0}
        groups += [{} for _ in range(len(own[1]) - len(known))]
        new = iter(groups[score.shape[1] :])
        for r in range(len(own[1])):
            (groups[known[r]] if r in known else next(new))[k] = r
    return sorted(groups, key=lambda x: np.mean([sets[k][1][r].frequency for k, r in x.items()]))


def _agreement(of_a: ModesOfSet, a: int, of_b: ModesOfSet, b: int, least: float) -> float:
    """Return one more than the squared correlation of modes, 0 where they cannot be the same.

    It is that of shapes at common sensors, the MAC, times that of poles: close modes differ in
    damping where data of a set turn their shapes. MAC of planes is the squared cosine of the least
    angle between them. Data of a set may turn the shapes of modes that are close within their
    plane: one of a mode has to lie in that of the other one and those whose half bandwidths meet
    its own. Shapes that their covariances do not tell apart may be the same, too.
    """
    x, y = of_a[1][a], of_b[1][b]
    half = [mode.damping * mode.frequency for mode in (x, y)]
    reach = max(WIDTH * np.hypot(x.frequency_std, y.frequency_std), *half, 0.005 * x.frequency)
    common = [name for name in of_a[0] if name in of_b[0]]
    if abs(x.frequency - y.frequency) > reach or not common:
        return 0.0
    shapes, planes, places = [], [], []
    for mode, own, (names, modes) in zip((x, y), half, (of_a, of_b), strict=True):
        close = [
            each.shape.plane
            for each in modes
            if abs(each.frequency - mode.frequency) <= each.damping * each.frequency + own
        ]
        places.append([names.index(name) for name in common])
        shapes.append(la.orth(mode.shape.plane[places[-1]]))
        planes.append(la.orth(np.hstack(close)[places[-1]]))
    (own_a, own_b), (plane_a, plane_b) = shapes, planes

    def mac(first: Floats, second: Floats) -> float:
        return float(np.linalg.norm(first.T @ second, 2) ** 2) if first.size * second.size else 0.0

    near = max(mac(own_a, plane_b), mac(plane_a, own_b))
    if near <= least and _apart((x, y), places) > WIDTH:
        return 0.0
    return 1 + mac(own_a, own_b) * float(alike(x.pole, np.array(y.pole)))


def _apart(modes: Sequence[ModeEstimate], places: Sequence[Sequence[int]]) -> float:
    """Return how many deviations shapes of any scale are apart at common sensors.

    It is the misfit of one shape for both, and infinite where covariances are not known.
    """
    shapes, covariances, common = [], [], np.arange(len(places[0]))
    for mode, own in zip(modes, places, strict=True):
        C = mode.shape_covariance
        if C is None or not np.isfinite(C := C[np.ix_(own, own)]).all():
            return np.inf
        size = float(np.linalg.norm(mode.shape.shape[own])) or 1.0
        shapes.append(mode.shape.shape[own] / size)
        covariances.append(C / size**2 + ROUNDING * np.eye(len(own)))
    misfit = merged_shape([common, common], shapes, covariances, len(common))[2]
    return float(np.sqrt(max(misfit, 0.0)))


def _shapes(phi: Floats, std: Floats) -> tuple[Floats, Floats]:
    """Return shapes in the sign of the first set, and deviations with the spread of the sets."""
    having = np.flatnonzero(np.isfinite(phi).any(axis=1))
    known, factor = np.full(phi.shape[1], np.nan), np.ones((len(phi), 1))
    for k in having[joined([np.flatnonzero(np.isfinite(x)).tolist() for x in phi[having]])]:
        both = np.isfinite(known) & np.isfinite(phi[k])
        own = phi[k][both]
        if own.any():
            factor[k] = float(own @ known[both]) / float(own @ own) or 1.0
        known = np.where(np.isfinite(known), known, factor[k] * phi[k])
    scaled, size = phi * factor, np.abs(factor)
    tau = np.array([between(*x) for x in zip(scaled.T, (std * size).T, strict=True)])
    return phi * np.sign(factor), np.hypot(std, tau / size)


def merged_shape(
    places: Sequence[Ints], shapes: Sequence[Floats], covariances: Sequence[Floats], count: int
) -> tuple[Floats, Floats, float]:
    """Return the shape of unit norm at all sensors, its covariance, and the misfit of the setups.

    Both are NaN where none measured.

    Its parts are along the shapes of all setups, by weighted least squares (Au, Mech. Syst. Signal
    Process. 25 (2011) 163-179). Where these differ by more than their covariances say, that of the
    shape is as much greater. ``places`` are the numbers of the sensors of each setup, ``count`` is
    that of all of them. Each setup has to share sensors with another one.
    """
    parts = [
        (i, u, T @ la.inv(C + np.outer(u, u)) @ T)
        for i, u, C in zip(places, shapes, covariances, strict=True)
        for T in [np.eye(len(u)) - np.outer(u, u)]
    ]
    known, along, phi = np.unique(np.concatenate(places)), np.ones(len(parts)), np.zeros(count)
    for _ in range(MOST_STEPS):
        A = np.zeros((count, count))
        for (i, _, W), scale in zip(parts, along, strict=True):
            A[np.ix_(i, i)] += W / scale**2
        value, vector = la.eigh(A[np.ix_(known, known)])
        phi[known], before = vector[:, 0], along
        along = np.array([max(abs(float(u @ phi[i])), TOLERANCE) for i, u, _ in parts])
        if np.abs(along - before).max() < TOLERANCE:
            break
    freedom = sum(len(u) - 1 for u in shapes) - len(known) + 1
    widening = max(value[0] / max(freedom, 1), 1.0)
    half = vector[:, 1:] * np.sqrt(widening / np.maximum(value[1:], TINY))
    covariance = np.full((count, count), np.nan)
    covariance[np.ix_(known, known)] = half @ half.T
    phi[np.setdiff1d(np.arange(count), known)] = np.nan
    return phi, covariance, float(value[0])
