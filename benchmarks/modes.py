"""Time of an evaluation, with and without derivatives, as ratios to SciPy in the same run.

    python benchmarks/modes.py [--sizes 546 4998 ...] [--peers-up-to 50000] [--repeats 5]

The model is a cantilever plate of a lattice of springs with face diagonals and unit masses. Its
length is divided into 12 regions; the stiffness of each is a parameter. Compared are

- eigsh: ``scipy.sparse.linalg.eigsh(K, M=M, sigma=0)``, the same number of modes, no derivatives;
- differences: derivatives by central differences with it, two solutions a parameter (one is timed).

Times are medians; the analysis of the pattern, once a model, is printed for itself.

A second table is of curved sheets of shells, 3 m x 2 m and clamped at one edge: the thinner they
are, the greater is the rounding in their modes. A factorisation more than two stands for a run of
the eigensolver that had to be repeated.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from modefront import fem
from modefront._typing import Floats
from modefront.linalg.affine import Monomials, sparse_affine
from modefront.models.matrices import MatrixModel
from modefront.models.mesh import mesh_model
from modefront.modes import sparse
from modefront.work.task import counted

SHAPES = {546: (13, 7, 2), 4998: (34, 7, 7), 49980: (70, 34, 7), 199920: (119, 80, 7)}
"""Free nodes along each axis, for each number of degrees of freedom."""

PARAMETERS, SENSORS, MODES = 12, 40, 5

SHEETS = 20e-3, 2e-3, 0.2e-3
"""Thicknesses of the sheets in m."""

GRID, MORE = (36, 24), (9, 18, 30)
"""Elements along each edge of a sheet, and numbers of its modes."""

DIRECTIONS = (
    (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1),
    (0, 1, -1),
)  # fmt: skip


def plate(free: tuple[int, int, int]) -> MatrixModel:
    """Return the cantilever with so many free nodes along each axis; x = 0 is clamped."""
    shape = free[0] + 1, *free[1:]
    node = np.arange(np.prod(shape)).reshape(shape)
    clamped = 3 * free[1] * free[2]
    size = 3 * node.size - clamped
    rows, columns, values, regions = [], [], [], []
    for direction in DIRECTIONS:
        sides = list(zip(direction, shape, strict=True))
        a = node[tuple(slice(max(0, -d), n - max(0, d)) for d, n in sides)].ravel()
        b = node[tuple(slice(max(0, d), n + min(0, d)) for d, n in sides)].ravel()
        e = np.array(direction) / np.linalg.norm(direction)
        dof = np.concatenate([3 * a[:, None] + np.arange(3), 3 * b[:, None] + np.arange(3)], axis=1)
        k = np.outer(np.r_[e, -e], np.r_[e, -e])
        rows.append(np.repeat(dof, 6, axis=1).ravel())
        columns.append(np.tile(dof, 6).ravel())
        values.append(np.tile(k.ravel(), a.size))
        regions.append(np.repeat(a // (free[1] * free[2]) * PARAMETERS // shape[0], 36))
    row, column, value, region = map(np.concatenate, (rows, columns, values, regions))
    inner = (row >= clamped) & (column >= clamped)
    K = []
    for j in range(PARAMETERS):
        part = inner & (region == j)
        entries = value[part], (row[part] - clamped, column[part] - clamped)
        K.append(scipy.sparse.coo_array(entries, shape=(size, size)))
    dofs = np.linspace(0, size - 1, SENSORS).astype(int)
    selection = scipy.sparse.csr_array(
        (np.ones(SENSORS), (np.arange(SENSORS), dofs)), shape=(SENSORS, size)
    )
    return MatrixModel(
        tuple(f"k{j + 1}" for j in range(PARAMETERS)),
        tuple(f"s{j + 1}" for j in range(SENSORS)),
        selection,
        sparse_affine(K, Monomials(np.eye(PARAMETERS)), size),
        sparse_affine([scipy.sparse.eye_array(size)], Monomials(np.zeros((1, PARAMETERS))), size),
    ).compact()


def median(run: Callable[[], object], repeats: int) -> float:
    """Return the median time of a run, in seconds."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def main() -> None:
    """Print a line a size."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--sizes", type=int, nargs="+", default=list(SHAPES), choices=SHAPES)
    options.add_argument("--peers-up-to", type=int, default=49980)
    options.add_argument("--repeats", type=int, default=5)
    given = options.parse_args()
    theta = np.linspace(0.8, 1.2, PARAMETERS)
    print(f"{PARAMETERS} parameters, {MODES} modes, {SENSORS} sensors; times in s")
    print("   DOF  first  modes  with derivatives  modes/eigsh  with/eigsh  with/differences")
    for size in given.sizes:
        repeats = given.repeats if size < 10000 else 1
        print(line(size, theta, repeats, size <= given.peers_up_to), flush=True)
    print("\nsheet, mm  modes  factorisations  time  over eigsh")
    for thickness in SHEETS:
        for count in MORE:
            print(sheet(thickness, count, given.repeats), flush=True)


def line(size: int, theta: Floats, repeats: int, peers: bool) -> str:
    """Return the line of one size."""
    model = plate(SHAPES[size])
    first = median(lambda: model.modes(theta, MODES, derivatives=False), 1)
    alone = median(lambda: model.modes(theta, MODES, derivatives=False), repeats)
    both = median(lambda: model.modes(theta, MODES), repeats)
    out = f"{size:6d}{first:7.3f}{alone:7.3f}{both:18.3f}"
    if not peers:
        return out + "   (no peers)"
    K, M = model.stiffness.at(theta), model.mass.at(theta)
    eigsh = median(lambda: scipy.sparse.linalg.eigsh(K, MODES, M, sigma=0), repeats)
    differences = 2 * PARAMETERS * eigsh
    return out + f"{alone / eigsh:13.3f}{both / eigsh:12.3f}{both / differences:18.4f}"


def sheet(thickness: float, count: int, repeats: int) -> str:
    """Return the line of one sheet and number of modes."""
    X, cells = fem.grids.plate(3.0, 2.0, *GRID)
    X[:, 2] = 0.1 * X[:, 0] * X[:, 1]
    shells = fem.Shells("sheet", cells, fem.Material(E=210e9, nu=0.3, rho=7850.0), thickness)
    support = fem.Support(np.flatnonzero(X[:, 0] == 0))
    corner = fem.Sensor("corner", len(X) - 1, "z")
    pencil = mesh_model(fem.Structure(X, (shells,), (support,), sensors=(corner,)), ()).pencil
    none = np.zeros(0)
    with counted() as costs:
        sparse.lowest(pencil, none, count)
    time = median(lambda: sparse.lowest(pencil, none, count), repeats)
    K, M = pencil.K.at(none), pencil.M.at(none)
    eigsh = median(lambda: scipy.sparse.linalg.eigsh(K, count, M, sigma=0), repeats)
    return (
        f"{1e3 * thickness:9.1f}{count:7d}{costs.factorisations:16d}{time:6.2f}{time / eigsh:12.2f}"
    )


if __name__ == "__main__":
    main()
