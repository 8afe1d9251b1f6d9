r"""Random updating problems, each from a kind and a seed, for benchmarks and tests.

Stiffness and mass are affine, :math:`K(\theta) = K_0 + \sum_j \theta_j K_j`. Measurements are the
modes of a random true model at the sensors, exact or with normal errors of 0.5 % of a frequency
and 2 % of the root mean square of a shape.

=========  ======================================================================================
kind       structure
=========  ======================================================================================
chain      shear chain of 8 to 40 storeys, 2 to 6 modes at every second floor or at random ones
frame      plane frame of Euler-Bernoulli beams, 6 to 17 parameters, 2 to 5 modes
story18    the published 18-storey frame, 2 to 4 modes at 6 floors
bridge     the published steel bridge in a basis of its modes, 17 stiffnesses, 5 modes
concrete   the published concrete frame in a basis of its modes, 12 stiffnesses, 3 modes
=========  ======================================================================================

The bridge and the concrete frame are reduced to Ritz vectors once: the modes of the nominal model
and of models with one stiffness changed. What is updated is this reduced model, so a benchmark
needs no certificates, and its eigenproblems are small. Its coordinates are orthonormal in the mass
matrix: others, such as the motions of the sensors, leave no digits to compare.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Protocol

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
from smu import FOLDER

import modefront as mf
from modefront._typing import Floats, Ints

FREQUENCY_ERROR, SHAPE_ERROR = 0.005, 0.02
"""Standard deviations of simulated errors, over a frequency and the size of a shape."""

RITZ = 1e-4
"""Least singular value of the modes, over the greatest, that is kept in a basis of them."""

STOREYS = (8, 10, 12, 14, 16, 18, 20, 24, 30, 40)
SHARES = (0.14, 0.17, 0.17, 0.14, 0.1, 0.1, 0.08, 0.05, 0.03, 0.02)
"""Heights of chains, and how often they come."""


class Matrix(Protocol):
    """A matrix that depends on parameters."""

    @property
    def terms(self) -> Floats:
        """Dense terms (parameters + 1, N, N) that it is made of."""

    def at(self, theta: Floats) -> Floats:
        """Return the matrix at ``theta``, (N, N)."""

    def slopes(self, theta: Floats) -> Floats:
        """Return its derivatives at ``theta``, (parameters, N, N)."""


@dataclass(frozen=True)
class Affine:
    """Dense terms (parameters + 1, N, N) of an affine matrix; the first is the constant one."""

    terms: Floats

    def at(self, theta: Floats) -> Floats:
        """Return the matrix at ``theta``, (N, N)."""
        out: Floats = np.tensordot(np.append(1.0, theta), self.terms, axes=1)
        return out

    def slopes(self, theta: Floats) -> Floats:
        """Return the derivatives, (parameters, N, N), which do not depend on ``theta``."""
        return self.terms[1:]


@dataclass(frozen=True)
class Case:
    """An updating problem with the matrices that it was made of.

    Attributes
    ----------
    kind, seed : what it was made from
    text : what it is, in a few words
    problem : for modefront
    stiffness, mass : K(theta) and M(theta)
    sensors : (sensors, N) weights of the degrees of freedom at each sensor
    true : parameters from which the measurements come
    exact : whether the measurements are without error
    rigid : number of rigid-body modes
    """

    kind: str
    seed: int
    text: str
    problem: mf.UpdatingProblem
    stiffness: Matrix
    mass: Matrix
    sensors: Floats
    true: Floats
    exact: bool
    rigid: int = 0

    @property
    def name(self) -> str:
        """Kind and seed."""
        return f"{self.kind}-{self.seed}"


@dataclass(frozen=True)
class _Structure:
    """A structure before anything was measured on it, and the bounds of its parameters."""

    text: str
    stiffness: Floats
    mass: Floats
    sensors: Floats
    modes: int
    lower: Floats
    upper: Floats
    nominal: Floats
    true: Floats


PUBLISHED = {
    "story18": ("story18_exp", 0, (2, 4)),
    "bridge": ("steel_bridge_exp", 9, (5, 5)),
    "concrete": ("concrete_frame_sim", 7, (3, 3)),
}
"""File of a published model, modes of each model in its basis, least and most measured modes."""

KINDS = ("chain", "frame", *PUBLISHED)


def available(kind: str, folder: Path = FOLDER) -> bool:
    """Return whether the data of a kind are there."""
    return kind not in PUBLISHED or (folder / f"{PUBLISHED[kind][0]}.npz").is_file()


def make(kind: str, seed: int, folder: Path = FOLDER) -> Case:
    """Return the problem of a kind and a seed; ``folder`` is that of the published models."""
    rng = np.random.default_rng([zlib.crc32(kind.encode()), seed])
    if kind in PUBLISHED:
        structure = _published(kind, folder, rng)
    else:
        structure = {"chain": _chain, "frame": _frame}[kind](rng)
    return _measured(kind, seed, structure, rng)


def chain_case(
    storeys: int, modes: int, seed: int, *, grouping: str = "kinds", exact: bool = False
) -> Case:
    """Return a chain with a stiffness a storey that is measured at every second floor.

    ``grouping`` is ``"kinds"``, frequencies and shapes, ``"modes"``, lower and higher ones, or
    ``"three"``, frequencies, lower and higher shapes.
    """
    rng = np.random.default_rng([zlib.crc32(b"given chain"), storeys, modes, seed])
    structure = _shear_chain(storeys, modes, np.arange(1, storeys, 2), rng, masses=0)
    return _measured("given", seed, structure, rng, exact=exact, grouping=grouping)


# ---- structures ------------------------------------------------------------------------------


def _chain(rng: np.random.Generator) -> _Structure:
    storeys = int(rng.choice(STOREYS, p=SHARES))
    modes = int(rng.integers(2, 7))
    dofs = np.arange(1, storeys, 2)
    if rng.random() < 0.3:
        count = int(rng.integers(max(3, storeys // 4), storeys // 2 + 2))
        dofs = np.sort(rng.choice(storeys, count, replace=False))
    return _shear_chain(storeys, modes, dofs, rng, masses=int(rng.random() < 0.15))


def _shear_chain(
    storeys: int, modes: int, dofs: Ints, rng: np.random.Generator, masses: int
) -> _Structure:
    """Return a chain; the masses of its upper half are one more parameter where wanted."""
    taper = np.linspace(1.0, rng.uniform(0.4, 1.0), storeys)
    k = 2e8 * taper * rng.uniform(0.85, 1.15, storeys)
    m = 1e5 * rng.uniform(0.9, 1.1, storeys)
    p = storeys + masses
    K, M = np.zeros((p + 1, storeys, storeys)), np.zeros((p + 1, storeys, storeys))
    for i in range(storeys):
        K[i + 1, i, i] += k[i]
        if i > 0:
            K[i + 1, i - 1, i - 1] += k[i]
            K[i + 1, i, i - 1] -= k[i]
            K[i + 1, i - 1, i] -= k[i]
    upper = np.arange(storeys) >= storeys // 2 if masses else np.zeros(storeys, bool)
    M[0] = np.diag(np.where(upper, 0.0, m))
    if masses:
        M[-1] = np.diag(np.where(upper, m, 0.0))
    text = f"{storeys} storeys{', mass of upper half' * masses}"
    return _within(text, K, M, dofs, modes, rng, alpha=rng.random() < 0.25)


def _within(
    text: str,
    K: Floats,
    M: Floats,
    dofs: Ints,
    modes: int,
    rng: np.random.Generator,
    *,
    alpha: bool,
) -> _Structure:
    """Return a structure with bounds 0.5 to 2 of its factors, or -0.5 to 1 of their changes."""
    p = len(K) - 1
    true = np.exp(rng.normal(scale=0.2, size=p)).clip(0.55, 1.8)
    lower, upper, nominal = np.full(p, 0.5), np.full(p, 2.0), np.ones(p)
    if alpha:
        K, M = K.copy(), M.copy()
        K[0], M[0] = K.sum(axis=0), M.sum(axis=0)
        lower, upper, nominal, true = lower - 1, upper - 1, nominal - 1, true - 1
        text += ", changes"
    return _Structure(text, K, M, np.eye(K.shape[1])[dofs], modes, lower, upper, nominal, true)


def _frame(rng: np.random.Generator) -> _Structure:
    """Return a plane frame; its members are dealt out to the parameters in groups."""
    bays, levels = int(rng.integers(1, 4)), int(rng.integers(2, 6))
    x = np.append(0.0, np.cumsum(rng.uniform(4.0, 7.0, bays)))
    z = np.append(0.0, np.cumsum(rng.uniform(3.0, 4.5, levels)))
    position = np.arange((bays + 1) * (levels + 1)).reshape(levels + 1, bays + 1)
    columns = [(position[i, j], position[i + 1, j]) for i in range(levels) for j in range(bays + 1)]
    beams = [
        (position[i + 1, j], position[i + 1, j + 1]) for i in range(levels) for j in range(bays)
    ]
    members = np.array(columns + beams)
    nodes = np.array([(x[j], z[i]) for i in range(levels + 1) for j in range(bays + 1)])
    p = int(rng.integers(6, min(17, len(members)) + 1))
    owner = rng.permutation(np.append(np.arange(p), rng.integers(0, p, len(members) - p)))
    N = 3 * len(nodes)
    K, M = np.zeros((p + 1, N, N)), np.zeros((p + 1, N, N))
    for j, (first, second) in zip(owner, members, strict=True):
        horizontal = nodes[first, 1] == nodes[second, 1]
        stiffness, mass = beam(nodes[second] - nodes[first], *_section(rng, bool(horizontal)))
        place = np.ix_(*2 * [np.append(3 * first + np.arange(3), 3 * second + np.arange(3))])
        K[j + 1][place] += stiffness
        M[0][place] += mass
    free = np.arange(3 * (bays + 1), N)
    if rng.random() < 0.3:  # pinned
        free = np.append(np.arange(2, 3 * (bays + 1), 3), free)
    K, M = (A[:, free][:, :, free] for A in (K, M))
    sideways = [int(np.flatnonzero(free == 3 * position[i, 0])[0]) for i in range(1, levels + 1)]
    others = [k for k in range(len(free)) if free[k] % 3 < 2 and k not in sideways]
    extra = rng.choice(others, min(len(others), int(rng.integers(0, 5))), replace=False)
    dofs = np.sort(np.append(sideways, extra)).astype(int)
    text = f"{bays} x {levels} frame"
    return _within(text, K, M, dofs, int(rng.integers(2, 6)), rng, alpha=rng.random() < 0.25)


def _section(rng: np.random.Generator, horizontal: bool) -> tuple[float, float, float]:
    """Return EA in N, EI in N m^2 and mass a metre in kg of a column or a loaded beam."""
    EI = 2.1e11 * (2.5e-4 if horizontal else 1.5e-4) * rng.uniform(0.5, 1.5)
    return 2.1e11 * 1e-2, EI, (2500.0 if horizontal else 120.0) * rng.uniform(0.8, 1.2)


def beam(axis: Floats, EA: float, EI: float, m: float) -> tuple[Floats, Floats]:
    """Return stiffness and consistent mass (6, 6) of a beam in the plane, along ``axis`` (2,)."""
    L = float(np.hypot(*axis))
    c, s = axis / L
    K, M = np.zeros((6, 6)), np.zeros((6, 6))
    K[np.ix_([0, 3], [0, 3])] = EA / L * np.array([[1, -1], [-1, 1]])
    M[np.ix_([0, 3], [0, 3])] = m * L / 6 * np.array([[2, 1], [1, 2]])
    bending = np.array(
        [
            [12, 6 * L, -12, 6 * L],
            [6 * L, 4 * L**2, -6 * L, 2 * L**2],
            [-12, -6 * L, 12, -6 * L],
            [6 * L, 2 * L**2, -6 * L, 4 * L**2],
        ]
    )
    inertia = np.array(
        [
            [156, 22 * L, 54, -13 * L],
            [22 * L, 4 * L**2, 13 * L, -3 * L**2],
            [54, 13 * L, 156, -22 * L],
            [-13 * L, -3 * L**2, -22 * L, 4 * L**2],
        ]
    )
    across = np.ix_([1, 2, 4, 5], [1, 2, 4, 5])
    K[across], M[across] = EI / L**3 * bending, m * L / 420 * inertia
    turn = np.kron(np.eye(2), np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]))
    return turn.T @ K @ turn, turn.T @ M @ turn


@cache
def _terms(path: Path, count: int) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Return K, M (terms, n, n), the weights (sensors, n) of the sensors, and the bounds.

    Above 100 degrees of freedom these are Ritz coordinates: ``count`` modes of every model.
    """
    with np.load(path) as file:
        result = dict(file)
    size, p = int(result["N"]), int(result["n_par"])

    def matrix(key: str) -> scipy.sparse.csc_array:
        place = result[f"{key}_row"], result[f"{key}_col"]
        return scipy.sparse.csc_array((result[f"{key}_val"], place), shape=(size, size))

    K = [matrix(f"K{j}") for j in range(p)]
    base = matrix("Kfixed") if "Kfixed_row" in result else scipy.sparse.csc_array((size, size))
    M, sensors = matrix("M"), result["meas_dofs0"].astype(int)
    nominal = sum(K, base)
    if size > 100:
        changed = [nominal, *(nominal + sign * 0.6 * A for A in K for sign in (-1.0, 1.0))]
        T = _ritz(changed, M, count)
    else:
        T = np.eye(size)
    stiffness, mass = (np.array([T.T @ (A @ T) for A in terms]) for terms in ((nominal, *K), (M,)))
    mass = np.concatenate([mass, np.zeros((p, *mass.shape[1:]))])
    stiffness, mass = ((A + A.transpose(0, 2, 1)) / 2 for A in (stiffness, mass))
    return stiffness, mass, T[sensors], result["lb"], result["ub"]


def _ritz(
    stiffness: list[scipy.sparse.csc_array], mass: scipy.sparse.csc_array, count: int
) -> Floats:
    """Return the span of ``count`` modes of each model, (N, n), orthonormal in the mass matrix."""
    start = np.ones(mass.shape[0])
    modes = [scipy.sparse.linalg.eigsh(K, count, mass, sigma=0.0, v0=start)[1] for K in stiffness]
    T = np.hstack(modes)
    for _ in range(2):  # once more, for the digits that the small eigenvalues cost
        s, U = scipy.linalg.eigh(T.T @ (mass @ T))
        kept = s > RITZ**2 * s[-1]
        T = T @ (U[:, kept] / np.sqrt(s[kept]))
    return T


def _published(kind: str, folder: Path, rng: np.random.Generator) -> _Structure:
    name, count, (least, most) = PUBLISHED[kind]
    K, M, sensors, lower, upper = _terms(folder / f"{name}.npz", count)
    true = np.clip(rng.normal(scale=0.2, size=lower.size), 0.9 * lower, 0.9 * upper)
    text, modes = f"{name}, {K.shape[1]} coordinates", int(rng.integers(least, most + 1))
    return _Structure(text, K, M, sensors, modes, lower, upper, np.zeros(lower.size), true)


# ---- measurements and groups -----------------------------------------------------------------


def _measured(
    kind: str,
    seed: int,
    structure: _Structure,
    rng: np.random.Generator,
    *,
    exact: bool | None = None,
    grouping: str | None = None,
) -> Case:
    stiffness, mass = Affine(structure.stiffness), Affine(structure.mass)
    top = [0, structure.modes - 1]
    lam, Phi = scipy.linalg.eigh(
        stiffness.at(structure.true), mass.at(structure.true), subset_by_index=top
    )
    f, shape = np.sqrt(lam) / (2 * np.pi), (structure.sensors @ Phi).T
    exact = bool(rng.random() < 0.25) if exact is None else exact
    if not exact:
        f = f * (1 + FREQUENCY_ERROR * rng.normal(size=f.size))
        size = np.sqrt((shape**2).mean(axis=1, keepdims=True))
        shape = shape + SHAPE_ERROR * size * rng.normal(size=shape.shape)
    order = np.argsort(f)
    grouping = grouping or str(rng.choice(["kinds", "modes", "three"], p=[0.6, 0.2, 0.2]))
    groups = _groups(grouping, structure.modes)
    p = structure.lower.size
    names = [f"t{j + 1}" for j in range(p)]
    sensors = {
        f"s{i + 1}": [(int(dof), float(row[dof])) for dof in np.flatnonzero(row)]
        for i, row in enumerate(structure.sensors)
    }
    K, M = (
        {
            name: A.terms[j]
            for j, name in enumerate(["base", *names])
            if j == 0 or np.any(A.terms[j])
        }
        for A in (stiffness, mass)
    )
    problem = mf.updating_problem(
        mf.matrices(names, K, M, sensors),
        mf.modal_data(f[order], shape[order], tuple(sensors)),
        groups,
        dict(zip(names, zip(structure.lower, structure.upper, strict=True), strict=True)),
        dict(zip(names, structure.nominal, strict=True)),
    )
    text = f"{structure.text}, {structure.modes} modes at {len(sensors)} sensors"
    text += ", exact" if exact else ""
    return Case(
        kind, seed, text, problem, stiffness, mass, structure.sensors, structure.true, exact
    )


def _groups(grouping: str, modes: int) -> list[mf.Group]:
    """Return frequencies and shapes, lower and higher modes, or three groups."""
    lower, higher = [range(1, modes // 2 + 1), range(modes // 2 + 1, modes + 1)]
    if grouping == "kinds":
        return [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    if grouping == "modes":
        return [
            mf.Group("lower", frequency=list(lower), shape=list(lower)),
            mf.Group("higher", frequency=list(higher), shape=list(higher)),
        ]
    return [
        mf.Group("frequencies", frequency="all"),
        mf.Group("lower-shapes", shape=list(lower)),
        mf.Group("higher-shapes", shape=list(higher)),
    ]
