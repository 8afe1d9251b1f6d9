"""Estimated errors of reduced models beside true ones, over boxes of all widths.

    python benchmarks/certificates.py [--structures 24] [--models 9] [--seed 0]

Random structures of two to five members (chains and nets of springs, members that are scattered
over a net, beams, plates of shells) are reduced to their modes at the nominal stiffnesses and at
one model more, within bounds of four kinds: a factor of 2.5, 10 and 100 about the nominal value,
and stiffnesses of 1e-9 to 1e-2. Certificates are asked for at random models of the box, at its
corners among them: one by one, or all at once as a study does. The truth is the difference of the
eigenvalues of the basis from the Rayleigh quotients, in extended precision, of LAPACK's modes of
the full matrices; it counts where it is above the rounding of the model itself.

Printed for each box are how many estimates are infinite, the least, first-percentile, median and
greatest ratio of estimates to the truth, of eigenvalues and of shapes, how many ratios are below a
third, and the factorisations that were taken for each certificate.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse

from modefront import fem
from modefront._typing import Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.affine import Monomials, sparse_affine
from modefront.models.matrices import MatrixModel
from modefront.models.mesh import mesh_model
from modefront.models.reduced.basis import certificate_of
from modefront.models.reduced.model import ReducedModel, SnapshotRequest
from modefront.modes import dense
from modefront.work.task import counted

MODES, SPARE = 5, 3
"""Modes that are judged, and those that the basis has beyond them."""

BOXES = {
    "0.4 to 2.5": (0.4, 2.5),
    "0.1 to 10": (0.1, 10.0),
    "0.01 to 100": (0.01, 100.0),
    "1e-9 to 1e-2": (1e-9, 1e-2),
}

ROUNDING = 1e2
"""True error over the rounding of the model above which it counts."""

STEEL = fem.Material(E=210e9, nu=0.3, rho=7850.0)


def springs(ends: Ints, k: Floats, member: Ints, mass: Floats, members: int) -> MatrixModel:
    """Return masses on springs; an end of -1 is the ground."""
    size = mass.size
    terms = []
    for j in range(members):
        K = scipy.sparse.lil_array((size, size))
        for (a, b), stiffness in zip(ends[member == j], k[member == j], strict=True):
            for first, other in ((a, b), (b, a)):
                if first >= 0:
                    K[first, first] += stiffness
                    if other >= 0:
                        K[first, other] -= stiffness
        terms.append(K.tocoo())
    return MatrixModel(
        tuple(f"k{j + 1}" for j in range(members)),
        ("s",),
        scipy.sparse.csr_array(np.eye(1, size)),
        sparse_affine(terms, Monomials(np.eye(members)), size),
        sparse_affine(
            [scipy.sparse.dia_array((mass[None], 0), shape=(size, size))],
            Monomials(np.zeros((1, members))),
            size,
        ),
    ).compact()


def chain(rng: np.random.Generator, members: int) -> MatrixModel:
    """Return a chain of 200 masses, fixed at one end or both, of members one after the other."""
    n = 200
    ends = np.column_stack([np.arange(-1, n), np.append(np.arange(n), -1)])[: n + rng.integers(2)]
    cuts = np.sort(rng.choice(np.arange(10, n - 10), members - 1, replace=False))
    member = np.searchsorted(cuts, np.arange(len(ends)), side="right")
    k = n**2 * np.exp(rng.normal(0, 0.5, len(ends)))
    return springs(ends, k, member, np.exp(rng.normal(0, 0.3, n)), members)


def net(rng: np.random.Generator, members: int) -> MatrixModel:
    """Return a net of 15 x 14 masses, fixed at one edge, with members in random places."""
    nx, ny = 15, 14
    number = np.arange(nx * ny).reshape(nx, ny)
    right = np.column_stack([number[:-1].ravel(), number[1:].ravel()])
    up = np.column_stack([number[:, :-1].ravel(), number[:, 1:].ravel()])
    ground = np.column_stack([np.full(ny, -1), number[0]])
    ends = np.concatenate([right, up, ground])
    X = np.array([(i // ny, i % ny) for i in range(nx * ny)] + [(-1.0, ny / 2)])
    middle = X[ends].mean(axis=1)
    seeds = rng.uniform([0, 0], [nx, ny], (members, 2))
    member = ((middle[:, None] - seeds) ** 2).sum(axis=2).argmin(axis=1)
    k = 1e3 * np.exp(rng.normal(0, 0.5, len(ends)))
    return springs(ends, k, member, np.exp(rng.normal(0, 0.3, nx * ny)), members)


def mixed(rng: np.random.Generator, members: int) -> MatrixModel:
    """Return such a net in which every spring belongs to any member."""
    net_of_one = net(rng, 1)
    K = scipy.sparse.triu(net_of_one.pencil.K.at(np.ones(1)), 1).tocoo()
    ends = np.column_stack([K.row, K.col])
    ground = np.column_stack([np.full(14, -1), np.arange(14)])
    k = np.concatenate([-K.data, np.full(14, -K.data.mean())])
    mass = net_of_one.pencil.M.at(np.ones(1)).diagonal()
    return springs(
        np.concatenate([ends, ground]), k, rng.integers(0, members, k.size), mass, members
    )


def beams(rng: np.random.Generator, members: int) -> MatrixModel:
    """Return a beam of 40 elements in three dimensions, clamped at one end."""
    X, cells = fem.grids.line(np.zeros(3), np.array([4.0, 0.3, 0.0]), 40)
    cuts = np.sort(rng.choice(np.arange(4, 36), members - 1, replace=False))
    member = np.searchsorted(cuts, np.arange(40), side="right")
    section = fem.rectangle(0.05, 0.09)
    names = [f"k{j + 1}" for j in range(members)]
    structure = fem.Structure(
        X,
        [
            fem.Beams(name, cells[member == j], STEEL, section, (0.0, 1.0, 0.0))
            for j, name in enumerate(names)
        ],
        [fem.Support(0)],
        sensors=[fem.Sensor("s", 40, "y")],
        parameters=[fem.Parameter(name, "E", (name,)) for name in names],
    )
    return mesh_model(structure, names)


def shells(rng: np.random.Generator, members: int) -> MatrixModel:
    """Return a plate of 10 x 6 shells, clamped at one edge, with members in random places."""
    X, cells = fem.grids.plate(3.0, 1.7, 10, 6)
    X[:, 2] = 0.1 * X[:, 0] * X[:, 1]
    middle = X[cells].mean(axis=1)[:, :2]
    while True:
        seeds = rng.uniform([0, 0], [3.0, 1.7], (members, 2))
        member = ((middle[:, None] - seeds) ** 2).sum(axis=2).argmin(axis=1)
        if np.unique(member).size == members:
            break
    names = [f"k{j + 1}" for j in range(members)]
    structure = fem.Structure(
        X,
        [fem.Shells(name, cells[member == j], STEEL, 0.03) for j, name in enumerate(names)],
        [fem.Support(np.flatnonzero(X[:, 0] == 0))],
        sensors=[fem.Sensor("s", len(X) - 1, "z")],
        parameters=[fem.Parameter(name, "E", (name,)) for name in names],
    )
    return mesh_model(structure, names)


KINDS: dict[str, Callable[[np.random.Generator, int], MatrixModel]] = {
    "chain": chain,
    "net": net,
    "mixed": mixed,
    "beams": beams,
    "shells": shells,
}


@dataclass(frozen=True)
class Comparison:
    """Estimates and true errors of the modes of one model, and the rounding of its eigenvalues."""

    eigenvalue: Floats
    shape: Floats
    true_eigenvalue: Floats
    true_shape: Floats
    rounding: Floats


def quotients(K: Floats, M: Floats, X: Floats) -> Floats:
    """Return the Rayleigh quotient of each column of X, summed up in extended precision."""
    k, m, x = (A.astype(np.longdouble) for A in (K, M, X))
    return np.asarray((x * (k @ x)).sum(axis=0) / (x * (m @ x)).sum(axis=0))


def compared(model: ReducedModel, thetas: Floats) -> list[Comparison]:
    """Return estimated and true errors at some parameters (models, p)."""
    requested = np.arange(MODES)
    basis, pencil, out = model.basis, model.full.pencil, []
    for theta in thetas:
        certificate = certificate_of(model.basis, theta, requested, MODES + SPARE)
        K, M = pencil.K.at(theta).toarray(), pencil.M.at(theta).toarray()
        X = scipy.linalg.eigh(M, K)[1][:, ::-1]
        try:
            result = dense.decompose(basis.K.at(theta), basis.M.at(theta))
        except ModelError:
            continue
        ritz = basis.combine(result.Phi[:, requested])
        exact = quotients(K, M, X[:, requested])
        size = np.sqrt(np.einsum("nr,nr->r", ritz, M @ ritz))
        inside = X[:, requested] / np.sqrt(
            np.einsum("nr,nr->r", X[:, requested], M @ X[:, requested])
        )
        along = (inside * (M @ ritz)).sum(axis=0) / size
        off = ritz / size - inside * along
        rounding = np.finfo(float).eps * (
            np.abs(K) @ np.abs(X[:, requested]) * np.abs(X[:, requested])
        ).sum(axis=0)
        out.append(
            Comparison(
                certificate.eigenvalue,
                certificate.shape,
                np.abs(result.lam[requested] / exact - 1).astype(float),
                np.sqrt(np.einsum("nr,nr->r", off, M @ off)) / np.abs(along),
                rounding,
            )
        )
    return out


def models(rng: np.random.Generator, lower: Floats, upper: Floats, count: int) -> Floats:
    """Return random parameters, evenly distributed in their logarithms, every third at bounds."""
    some = np.exp(rng.uniform(np.log(lower), np.log(upper), (count, lower.size)))
    ends = np.where(rng.integers(0, 2, some.shape) == 0, lower, upper)
    return np.where((np.arange(count) % 3 == 2)[:, None], ends, some)


def box(bounds: tuple[float, float], structures: int, count: int, seed: int) -> dict[str, float]:
    """Return the errors of one box."""
    result: list[Comparison] = []
    factorisations = 0
    for number in range(structures):
        rng = np.random.default_rng([seed, number])
        kind = list(KINDS.values())[number % len(KINDS)]
        members = int(rng.choice([2, 2, 3, 5]))
        full = kind(rng, members)
        lower, upper = (np.full(members, bound) for bound in bounds)
        nominal = np.sqrt(lower * upper) if number % 4 else upper / 10
        model = ReducedModel(full, MODES + SPARE, nominal, lower, upper, spare=SPARE)
        with suppress(ModelError):
            model.take(model.first)
            if number % 3:
                model.take(SnapshotRequest(models(rng, lower, upper, 1)[0], MODES + SPARE))
        if not model.snapshots:
            continue
        thetas = models(rng, lower, upper, count)
        with counted() as costs:
            for some in [thetas] if number % 2 else thetas[:, None]:
                result += compared(model, some)
        factorisations += costs.factorisations
    estimate, shape, truth, true_shape, rounding = (
        np.concatenate([getattr(comparison, name) for comparison in result])
        for name in ("eigenvalue", "shape", "true_eigenvalue", "true_shape", "rounding")
    )
    finite = np.isfinite(estimate)
    reported = finite & (truth > ROUNDING * rounding)
    ratio = estimate[reported] / truth[reported]
    seen = finite & (true_shape > np.maximum(1e-6, np.sqrt(rounding)))
    shapes = shape[seen] / np.minimum(true_shape[seen], 1.0)
    return {
        "modes": truth.size,
        "infinite": int((~finite).sum()),
        "told": int(reported.sum()),
        "least": ratio.min(),
        "1 %": np.quantile(ratio, 0.01),
        "median": np.median(ratio),
        "greatest": ratio.max(),
        "below 1/3": int((ratio < 1 / 3).sum()),
        "shape least": shapes.min(),
        "shape median": np.median(shapes),
        "shape greatest": shapes.max(),
        "shapes below 1/3": int((shapes < 1 / 3).sum()),
        "factorisations": factorisations / (structures * count),
    }


def main() -> None:
    """Print a table of all boxes."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--structures", type=int, default=24)
    options.add_argument("--models", type=int, default=9)
    options.add_argument("--seed", type=int, default=0)
    given = options.parse_args()
    rows = {
        name: box(bounds, given.structures, given.models, given.seed)
        for name, bounds in BOXES.items()
    }
    print(f"{'':18s}" + "".join(f"{name:>14s}" for name in rows))
    for key in next(iter(rows.values())):
        print(f"{key:18s}" + "".join(f"{row[key]:14.3g}" for row in rows.values()))


if __name__ == "__main__":
    main()
