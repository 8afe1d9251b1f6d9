r"""Random updating problems of small structures, half of them with data of another class of models.

A seed makes a problem, and nothing else does. The matrices are sums of powers of the parameters,

.. math:: K(\theta) = K_0 + \sum_j s_j^{a_j} K_j, \qquad M(\theta) = M_0 + \sum_j s_j^{b_j} M_j,
    \qquad s_j = \theta_j \;\text{or}\; 10^{\theta_j} .

==========  ======================================================================================
class       structure
==========  ======================================================================================
truss       plane truss of 3 to 6 bays; areas of groups of bars
tower       space truss of 2 to 4 levels; areas of groups of bars
grillage    beams in two directions with torsion, held along an edge or at corners
building    2 to 8 floors with three degrees of freedom and small eccentricities: close modes
free-beam   beam without supports: rigid-body modes
plate-strip beam whose thicknesses enter stiffness by their cubes, and the mass
chain       shear chain
cantilever  beam clamped at its foot
==========  ======================================================================================

Masses may be unknown, too. Data of a wrong class come from the same structure with members that
vary within their groups, with a taper, with springs that the model lacks or with a support that
gives way; those of a chain also from a tapered cantilever.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.linalg
from updating_problems import Case, beam

import modefront as mf
from modefront._typing import Bools, Floats, Ints
from modefront.models.base import Model

SEEN = 0.05
"""Motion of the sensors in a mode, over the greatest one, above which the mode is measured."""

FREE, WINDOW = {"free-beam": 2}, 100.0
"""Rigid-body modes of classes without supports; ratio of frequencies above which no modes pair."""


@dataclass(frozen=True)
class Powers:
    """Dense terms (parameters + 1, N, N) of a matrix; the first is the constant one.

    Attributes
    ----------
    terms : the terms
    exponents : (parameters,) powers of the parameters
    decades : whether the parameters are logarithms to the base 10
    """

    terms: Floats
    exponents: Floats
    decades: bool

    def at(self, theta: Floats) -> Floats:
        """Return the matrix at ``theta``, (N, N)."""
        s = 10.0**theta if self.decades else theta
        out: Floats = np.tensordot(np.append(1.0, s**self.exponents), self.terms, axes=1)
        return out

    def slopes(self, theta: Floats) -> Floats:
        """Return the derivatives at ``theta``, (parameters, N, N)."""
        s = 10.0**theta if self.decades else theta
        ds = np.log(10) * s if self.decades else np.ones(s.size)
        factor = self.exponents * s ** (self.exponents - 1) * ds
        return np.asarray(factor[:, None, None] * self.terms[1:])


@dataclass(frozen=True)
class Matrices:
    """Both matrices as a function of the parameters, for `modefront.function_model`."""

    stiffness: Powers
    mass: Powers

    def __call__(self, theta: Floats) -> tuple[Floats, Floats, list[Floats], list[Floats]]:
        """Return K, M and their derivatives."""
        K, M = self.stiffness, self.mass
        return K.at(theta), M.at(theta), list(K.slopes(theta)), list(M.slopes(theta))


@dataclass(frozen=True)
class Member:
    """A part of a structure: its degrees of freedom, its matrices, and where it is (0 to 1)."""

    dofs: Ints
    K: Floats
    M: Floats
    place: float


@dataclass(frozen=True)
class Skeleton:
    """A structure of which nothing is unknown yet.

    Attributes
    ----------
    text : what it is, in a few words
    members : parts with stiffness
    sites : parts with mass only
    sensors : (candidates, N) weights of the degrees of freedom
    free : (N,) degrees of freedom without support
    powers : a and b of the parameters of members that may be drawn
    """

    text: str
    members: Sequence[Member]
    sites: Sequence[Member]
    sensors: Floats
    free: Bools
    powers: Sequence[tuple[int, int]] = ((1, 0),)


@dataclass(frozen=True)
class Truth:
    """The structure that is measured: matrices and sensors (candidates, N) of its own."""

    K: Floats
    M: Floats
    sensors: Floats
    text: str = ""


@dataclass(frozen=True)
class Problem:
    """A random problem: the case, its class, and how its data differ from a model of its class."""

    case: Case
    kind: str
    wrong: str
    groups: int = field(default=2)


# ---- structures ------------------------------------------------------------------------------


def _site(dofs: Sequence[int], m: Sequence[float], place: float) -> Member:
    return Member(np.array(dofs), np.zeros((len(dofs), len(dofs))), np.diag(m), place)


def _bar(X: Floats, first: int, second: int, EA: float, m: float, place: float) -> Member:
    d = X.shape[1]
    axis = X[second] - X[first]
    L = float(np.linalg.norm(axis))
    n = np.append(-axis, axis) / L
    dofs = np.append(d * first + np.arange(d), d * second + np.arange(d))
    M = m * L / 6 * np.kron(np.array([[2.0, 1.0], [1.0, 2.0]]), np.eye(d))
    return Member(dofs, EA / L * np.outer(n, n), M, place)


def _truss(rng: np.random.Generator) -> Skeleton:
    bays, h = int(rng.integers(3, 7)), float(rng.uniform(0.8, 1.5))
    X = np.array([(i, y) for i in range(bays + 1) for y in (0.0, h)])
    pairs = [(2 * i, 2 * i + 1) for i in range(bays + 1)]
    for i in range(bays):
        a, b = 2 * i, 2 * i + 1
        pairs += [(a, a + 2), (b, b + 2), (a, b + 2) if rng.random() < 0.5 else (b, a + 2)]
    members = [_bar(X, a, b, 1e3, 0.3, X[[a, b], 0].mean() / bays) for a, b in pairs]
    sites = [_site([2 * i, 2 * i + 1], [0.5, 0.5], X[i, 0] / bays) for i in range(len(X))]
    free = np.ones(2 * len(X), bool)
    held = [0, 1, 2, 3] if rng.random() < 0.5 else [0, 1, 4 * bays + 1]
    free[held] = False
    return Skeleton(f"truss of {bays} bays", members, sites, np.eye(free.size), free, _AREAS)


def _tower(rng: np.random.Generator) -> Skeleton:
    levels, legs = int(rng.integers(2, 5)), int(rng.integers(3, 5))
    angle = 2 * np.pi * np.arange(legs) / legs + 0.1
    X = np.array(
        [
            ((1.5 - 0.2 * i) * np.cos(t), (1.4 - 0.2 * i) * np.sin(t), 1.6 * i)
            for i in range(levels + 1)
            for t in angle
        ]
    )
    pairs = []
    for i in range(levels):
        for j in range(legs):
            k, foot, top = (j + 1) % legs, i * legs, (i + 1) * legs
            pairs += [(foot + j, top + j), (foot + j, top + k), (top + j, top + k)]
        if legs == 4:
            pairs.append(((i + 1) * legs, (i + 1) * legs + 2))
    height = X[-1, 2]
    members = [_bar(X, a, b, 1e3, 0.2, X[[a, b], 2].mean() / height) for a, b in pairs]
    nodes = range(legs, len(X))
    sites = [_site([3 * i, 3 * i + 1, 3 * i + 2], [1.0] * 3, X[i, 2] / height) for i in nodes]
    free = np.arange(3 * len(X)) >= 3 * legs
    text = f"tower of {levels} levels, {legs} legs"
    return Skeleton(text, members, sites, np.eye(free.size), free, _AREAS)


def _grillage(rng: np.random.Generator) -> Skeleton:
    nx, ny = int(rng.integers(3, 5)), int(rng.integers(2, 5))
    X = np.array([(i * rng.uniform(1.0, 1.05), 1.2 * j) for i in range(nx) for j in range(ny)])
    ends = [(i * ny + j, (i + 1) * ny + j) for i in range(nx - 1) for j in range(ny)]
    ends += [(i * ny + j, i * ny + j + 1) for i in range(nx) for j in range(ny - 1)]
    members = []
    for a, b in ends:
        axis = X[b] - X[a]
        L = float(np.hypot(*axis))
        c, s = axis / L
        K, M = np.zeros((6, 6)), np.zeros((6, 6))
        bent, twisted = np.ix_([0, 1, 3, 4], [0, 1, 3, 4]), np.ix_([2, 5], [2, 5])
        K[bent], M[bent] = _bending(L, 100.0, 1.0)
        K[twisted] = 30.0 / L * np.array([[1, -1], [-1, 1]])
        M[twisted] = 0.02 * L / 6 * np.array([[2, 1], [1, 2]])
        T = np.kron(np.eye(2), np.array([[1, 0, 0], [0, s, -c], [0, c, s]]))
        dofs = np.append(3 * a + np.arange(3), 3 * b + np.arange(3))
        place = X[[a, b], 0].mean() / X[-1, 0]
        members.append(Member(dofs, T.T @ K @ T, T.T @ M @ T, place))
    sites = [_site([3 * i], [1.0], X[i, 0] / X[-1, 0]) for i in range(len(X))]
    free = np.ones(3 * len(X), bool)
    if rng.random() < 0.5:
        free[: 3 * ny] = False
    else:
        free[[0, 3 * (ny - 1), 3 * (nx - 1) * ny, 3 * (nx * ny - 1)]] = False
    text = f"grillage of {nx} x {ny}"
    return Skeleton(text, members, sites, np.eye(free.size)[::3], free, ((1, 0), (3, 1)))


def _building(rng: np.random.Generator) -> Skeleton:
    floors = int(rng.integers(2, 9))
    N, members, sites, sensors = 3 * floors, [], [], []
    ratio, twist = rng.uniform(0.95, 1.1), rng.uniform(0.9, 1.6)
    for i in range(floors):
        ex, ey = 0.05 * rng.normal(size=2)
        k = 800.0 * (1 - 0.4 * i / floors)
        for v, size in (((1, 0, -ey), 1.0), ((0, 1, ex), ratio), ((0, 0, 1), twist)):
            w = np.append(-np.array(v), v) if i else np.array(v, float)
            dofs = np.arange(3 * max(i - 1, 0), 3 * i + 3)
            members.append(
                Member(dofs, size * k * np.outer(w, w), np.zeros((w.size, w.size)), i / floors)
            )
        sites.append(_site([3 * i, 3 * i + 1, 3 * i + 2], [2.0, 2.0, 1.7], i / floors))
        for v in ((1, 0, -0.8), (0, 1, 0.9), (0, 1, -0.9)):
            sensors.append(np.eye(N)[3 * i : 3 * i + 3].T @ v)
    text = f"building of {floors} floors"
    return Skeleton(text, members, sites, np.array(sensors), np.ones(N, bool))


def _bending(L: float, EI: float, m: float) -> tuple[Floats, Floats]:
    """Return stiffness and consistent mass (4, 4) of a beam in bending."""
    K, M = beam(np.array([L, 0.0]), 1.0, EI, m)
    across = np.ix_([1, 2, 4, 5], [1, 2, 4, 5])
    return K[across], M[across]


def _line(
    rng: np.random.Generator, name: str, held: Sequence[int], powers: Sequence[tuple[int, int]]
) -> Skeleton:
    """Return a beam of 4 to 10 elements; ``held`` are degrees of freedom, the last ones from -1."""
    n = int(rng.integers(4, 11))
    members = [
        Member(np.arange(2 * i, 2 * i + 4), *_bending(1.0, 100.0, 1.0), (i + 0.5) / n)
        for i in range(n)
    ]
    sites = [_site([2 * i], [0.4], i / n) for i in range(n + 1)]
    free = np.ones(2 * (n + 1), bool)
    free[list(held)] = False
    return Skeleton(f"{name} of {n} elements", members, sites, np.eye(free.size)[::2], free, powers)


def _free_beam(rng: np.random.Generator) -> Skeleton:
    return _line(rng, "free beam", (), ((1, 0), (3, 1)))


def _plate_strip(rng: np.random.Generator) -> Skeleton:
    held = [(0, 1), (0, -2), (0, 1, -2), (0, 1, -2, -1)][int(rng.integers(4))]
    return _line(rng, f"plate strip, {len(held)} held,", held, ((3, 1),))


def _cantilever(rng: np.random.Generator) -> Skeleton:
    return _line(rng, "cantilever", (0, 1), ((1, 0),))


def _chain(rng: np.random.Generator) -> Skeleton:
    n = int(rng.integers(3, 16))
    members = [Member(np.array([0]), np.array([[500.0]]), np.zeros((1, 1)), 0.0)]
    spring = 500.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    for i in range(1, n):
        members.append(Member(np.array([i - 1, i]), spring, np.zeros((2, 2)), i / n))
    sites = [_site([i], [1.0], i / n) for i in range(n)]
    return Skeleton(f"chain of {n}", members, sites, np.eye(n), np.ones(n, bool))


_AREAS = ((1, 1), (1, 0))

CLASSES: dict[str, Callable[[np.random.Generator], Skeleton]] = {
    "truss": _truss,
    "tower": _tower,
    "grillage": _grillage,
    "building": _building,
    "free-beam": _free_beam,
    "plate-strip": _plate_strip,
    "chain": _chain,
    "cantilever": _cantilever,
}


# ---- what is measured ------------------------------------------------------------------------


def _assembled(parts: Sequence[Member], what: str, factors: Floats, N: int) -> Floats:
    out = np.zeros((N, N))
    for part, factor in zip(parts, factors, strict=True):
        out[np.ix_(part.dofs, part.dofs)] += factor * getattr(part, what)
    return out


def _truth(
    skeleton: Skeleton,
    s: Floats,
    sites: Floats,
    powers: tuple[int, int],
    wrong: str,
    kind: str,
    rng: np.random.Generator,
) -> Truth:
    """Return the structure with factors of its members and sites, changed as ``wrong`` says."""
    if wrong == "cantilever":
        return _tapered_cantilever(len(skeleton.members), rng)
    members, free, N = skeleton.members, skeleton.free.copy(), skeleton.free.size
    if "scatter" in wrong:
        s = s * np.exp(rng.uniform(0.05, 0.1) * rng.normal(size=s.size))
    if "taper" in wrong:
        s = s * (1 - rng.uniform(0.2, 0.5) * np.array([part.place for part in members]))
    K = _assembled(members, "K", s ** powers[0], N)
    M = _assembled(members, "M", s ** powers[1], N)
    M += _assembled(skeleton.sites, "M", sites, N)
    diagonal = np.diag(K).copy()
    if "springs" in wrong:
        stiff = (0.002, 0.02) if kind in FREE else (0.05, 0.3)
        for dof in rng.choice(np.flatnonzero(free), int(rng.integers(1, 4))):
            K[dof, dof] += rng.uniform(*stiff) * diagonal[dof]
    if "support" in wrong:
        held = np.flatnonzero(~free)
        for dof in rng.choice(held, min(held.size, 2), replace=False):
            K[dof, dof] += rng.uniform(1.0, 10.0) * diagonal[dof]
            free[dof] = True
    return Truth(K[free][:, free], M[free][:, free], skeleton.sensors[:, free])


def _tapered_cantilever(n: int, rng: np.random.Generator) -> Truth:
    """Return a cantilever of n elements that has a chain's first frequency, or about that."""
    taper = 1 - rng.uniform(0.2, 0.7) * (np.arange(n) + 0.5) / n
    K, M = np.zeros((2 * n + 2, 2 * n + 2)), np.zeros((2 * n + 2, 2 * n + 2))
    for i, t in enumerate(taper):
        place = slice(2 * i, 2 * i + 4)
        stiffness, mass = _bending(1.0, t**3, 1.0)
        K[place, place] += stiffness
        M[place, place] += t * mass
    K, M = K[2:, 2:], M[2:, 2:]
    first = scipy.linalg.eigh(K, M, eigvals_only=True, subset_by_index=[0, 0])[0]
    of_chain = 500.0 * (2 * np.sin(np.pi / (4 * n + 2))) ** 2
    return Truth(K * rng.uniform(0.8, 1.2) * of_chain / first, M, np.eye(2 * n)[::2])


def _measured(
    truth: Truth,
    rows: Ints,
    rigid: int,
    noise: tuple[float, float],
    lowest: bool,
    rng: np.random.Generator,
) -> tuple[Floats, Floats]:
    """Return frequencies (sets, modes) and shapes (sets, modes, sensors) with gaps.

    The modes are the ``lowest``, or some of those that the sensors see.
    """
    lam, Phi = scipy.linalg.eigh(truth.K, truth.M)
    shape = (truth.sensors[rows] @ Phi).T
    size = np.linalg.norm(shape, axis=1)
    most = min(int(rng.integers(2, 7)), truth.sensors.shape[0])
    last = min(rigid + most + int(rng.integers(0, 3)), lam.size)
    seen = [k for k in range(rigid, last) if size[k] > SEEN * size[rigid:last].max()]
    if lowest or len(seen) < 2:
        seen = [*range(rigid, min(rigid + most, lam.size))]
    skipped = rng.choice(seen, max(len(seen) - most, 0), replace=False)
    chosen = np.array([k for k in seen if k not in skipped])
    f, shape = np.sqrt(lam[chosen]) / (2 * np.pi), shape[chosen]
    sets = int(rng.choice([1, 2, 3], p=[0.6, 0.25, 0.15]))
    f = f * (1 + noise[0] * rng.normal(size=(sets, f.size)))
    unit = np.sqrt((shape**2).mean(axis=1, keepdims=True))
    shape = shape + noise[1] * unit * rng.normal(size=(sets, *shape.shape))
    m = rows.size
    for k in range(sets if sets > 1 else 0):
        count = int(rng.integers(min(max(2, m // 2), m), m + 1))
        missing = rng.choice(m, m - count, replace=False)
        shape[k][:, missing] = np.nan
        if k and chosen.size > 2 and rng.random() < 0.5:
            lost = int(rng.integers(chosen.size))
            f[k, lost], shape[k, lost] = np.nan, np.nan
    order = np.argsort(np.nanmean(f, axis=0))
    return f[:, order], shape[:, order]


def _groups(n: int, modes: int, rng: np.random.Generator) -> list[mf.Group]:
    """Return n groups, or fewer where the modes do not suffice."""
    every = [*range(1, modes + 1)]
    low, high = every[: (modes + 1) // 2], every[(modes + 1) // 2 :]
    frequencies = mf.Group("frequencies", frequency="all")
    if n == 2:
        if rng.random() < 0.6:
            return [frequencies, mf.Group("shapes", shape="all")]
        return [mf.Group("low", low, low), mf.Group("high", high, high)]
    if n == 3:
        if rng.random() < 0.5 or modes < 3:
            return [frequencies, mf.Group("low", shape=low), mf.Group("high", shape=high)]
        return [mf.Group(f"part{k + 1}", every[k::3], every[k::3]) for k in range(3)]
    if n == 4 or modes < 4:
        return [
            mf.Group("low-f", frequency=low),
            mf.Group("high-f", frequency=high),
            mf.Group("low-s", shape=low),
            mf.Group("high-s", shape=high),
        ]
    return [frequencies, *(mf.Group(f"s{k + 1}", shape=every[k::4]) for k in range(4))]


# ---- problems --------------------------------------------------------------------------------


def _owners(parts: Sequence[Member], count: int, rng: np.random.Generator) -> Ints:
    """Return the group (parts,) of each part: along the structure, or at random."""
    if rng.random() < 0.5:
        rank = np.argsort(np.argsort([part.place for part in parts], kind="stable"))
        return np.asarray(rank * count // len(parts))
    some = rng.integers(0, count, len(parts) - count)
    return np.asarray(rng.permutation(np.append(np.arange(count), some)))


def _wrong(kind: str, rng: np.random.Generator) -> str:
    """Return how the data of a wrong class are made."""
    if kind == "chain" and rng.random() < 0.5:
        return "cantilever"
    possible = ["scatter", "taper", "springs"]
    if kind not in ("chain", "building", *FREE):
        possible.append("support")
    return "+".join(rng.choice(possible, int(rng.integers(1, 3)), replace=False))


def make(seed: int, *, exact: bool = False) -> Problem:
    """Return the problem of a seed; ``exact``: of the right class, without noise."""
    kind = list(CLASSES)[seed % len(CLASSES)]
    rng = np.random.default_rng([zlib.crc32(b"random structures"), seed])
    skeleton = CLASSES[kind](rng)
    is_wrong = (seed // len(CLASSES) + seed) % 2 == 1 and not exact
    wrong = _wrong(kind, rng) if is_wrong else ""
    N, members, sites = skeleton.free.size, skeleton.members, skeleton.sites
    masses = int(rng.integers(0, min(3, len(sites) - 1) + 1))
    count = int(rng.integers(min(3, len(members)), min(20 - masses, len(members)) + 1))
    powers = skeleton.powers[int(rng.integers(len(skeleton.powers)))]
    owner = _owners(members, count, rng)
    # One group of sites more than there are parameters: the masses that are known.
    site_owner = _owners(sites, masses + 1, rng) if masses else np.zeros(len(sites), int)
    decades = bool(rng.random() < 0.25)
    ratio = np.full(count + masses, float(rng.choice([1.5, 2.0, 5.0, 10.0])))
    ratio[count:] = np.minimum(ratio[count:], 2.0)
    true = np.clip(np.exp(0.25 * rng.normal(size=ratio.size)), 1 / ratio**0.9, ratio**0.9)
    if not exact and rng.random() < 0.1:
        true[int(rng.integers(count))] = 1.1 * ratio[0]
    size = int(rng.integers(2, 13))
    seen = np.flatnonzero(np.abs(skeleton.sensors[:, skeleton.free]).sum(axis=1) > 0)
    least = 5 if kind in FREE else 2
    rows = np.sort(rng.choice(seen, min(max(size, least), seen.size), replace=False))
    noise = (0.0, 0.0) if exact else (10 ** rng.uniform(-2.7, -1.8), 10 ** rng.uniform(-2.3, -1.5))
    site_true = np.append(true[count:], 1.0)[site_owner]
    truth = _truth(skeleton, true[owner], site_true, powers, wrong, kind, rng)
    order = bool(rng.random() < 0.1) and not wrong and kind not in FREE
    f, shape = _measured(truth, rows, FREE.get(kind, 0), noise, order, rng)

    free, p = skeleton.free, count + masses
    K, M = np.zeros((p + 1, N, N)), np.zeros((p + 1, N, N))
    for j in range(count):
        own = (owner == j).astype(float)
        K[j + 1] = _assembled(members, "K", own, N)
        M[j + 1 if powers[1] else 0] += _assembled(members, "M", own, N)
    for j in range(masses + 1):
        own = (site_owner == j).astype(float)
        M[count + j + 1 if j < masses else 0] += _assembled(sites, "M", own, N)
    K, M = (A[:, free][:, :, free] for A in (K, M))
    exponents = np.ones(p), np.ones(p)
    exponents[0][:count], exponents[1][:count] = powers[0], max(powers[1], 1)
    stiffness, mass = Powers(K, exponents[0], decades), Powers(M, exponents[1], decades)
    n = int(rng.choice([2, 3, 4, 5], p=[0.62, 0.25, 0.09, 0.04]))
    groups = _groups(n, f.shape[1], rng)
    pairing = mf.Pairing("order" if order else "mac")
    if kind in FREE:  # the shapes of rigid-body modes have no basis of their own
        pairing = mf.Pairing(window=WINDOW, spare=3 + FREE[kind])
    sensors = skeleton.sensors[rows][:, free]
    lower, upper, nominal = 1 / ratio, ratio, np.ones(p)
    if decades:
        lower, upper, nominal, true = (np.log10(x) for x in (lower, upper, nominal, true))
    problem = _problem(
        (stiffness, mass), sensors, (f, shape), groups, pairing, np.array([lower, nominal, upper])
    )
    text = f"{skeleton.text}, {f.shape[1]} modes at {rows.size} sensors in {f.shape[0]} sets"
    text += f", {masses} masses" * bool(masses) + ", powers of ten" * decades
    case = Case(
        kind,
        seed,
        text,
        problem,
        stiffness,
        mass,
        sensors,
        np.clip(true, lower, upper),
        exact,
        FREE.get(kind, 0),
    )
    return Problem(case, kind, wrong, len(groups))


def _problem(
    terms: tuple[Powers, Powers],
    sensors: Floats,
    data: tuple[Floats, Floats],
    groups: list[mf.Group],
    pairing: mf.Pairing,
    values: Floats,
) -> mf.UpdatingProblem:
    """Return the problem for modefront; ``values`` are bounds and nominal values (3, p)."""
    names = [f"t{j + 1}" for j in range(values.shape[1])]
    places = {
        f"s{i + 1}": [(int(dof), float(row[dof])) for dof in np.flatnonzero(row)]
        for i, row in enumerate(sensors)
    }
    parameters = [
        mf.Parameter(name, float(x), (float(a), float(b)))
        for name, (a, x, b) in zip(names, values.T, strict=True)
    ]
    if terms[0].decades:
        model: Model = mf.function_model(parameters, places, Matrices(*terms))
    else:
        model = mf.matrices(names, _named(names, terms[0]), _named(names, terms[1]), places)
    measured = mf.modal_data(*data, tuple(places))
    return mf.updating_problem(model, measured, groups, pairing=pairing, parameters=parameters)


def _named(names: Sequence[str], A: Powers) -> dict[str, Floats]:
    """Return the terms of a matrix by their names, those that are not zero."""
    labels = [
        name if power == 1 else f"{name}^{power:.0f}"
        for name, power in zip(names, A.exponents, strict=True)
    ]
    return {
        label: term
        for label, term in zip(["base", *labels], A.terms, strict=True)
        if label == "base" or np.any(term)
    }
