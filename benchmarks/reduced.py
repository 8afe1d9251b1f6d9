"""Costs of a front with a reduced basis, over one full eigensolution, in one run.

    python benchmarks/reduced.py [--kind shell] [--sizes 1000 10000 ...] [--full-up-to 5000]
        [--exact-up-to 25000]

A plate of shells, or a block of tetrahedra, has six regions whose stiffness is a parameter within
0.4 and 2.5. The "measured" six modes at twenty sensors are those of a model with other stiffnesses
in twelve parts and with noise, so that frequencies and shapes disagree. Printed are, for the whole
work of a study (edges by global search, weighted models, 20 points of the front):

- the time and the memory of one full eigensolution, without and with derivatives;
- eigensolutions in full, corrected with the factor of another one, and reduced ones,
  factorisations, the greatest estimated error and the time of the work, over that of one full
  eigensolution without derivatives: processor time, and the time that passes;
- the greatest memory of the process, over that after one factorisation;
- the greatest estimated error, at the models that were found, of the basis from the nominal model
  alone, with derivatives and with the modes at the bounds;
- for the sizes up to ``--exact-up-to``: the least and the greatest ratio of an estimated error to
  the true one, over all points and modes. The truth is that of Rayleigh quotients in extended
  precision, of full modes and of the basis, since rounding in a full eigenvalue is often greater
  than the error;
- for the sizes up to ``--full-up-to``: the same work with full solutions, its time and the greatest
  difference of the parameters, over their ranges; and the greatest error, at the models that were
  found, of as many modes of the nominal model as the basis has columns (a plain modal basis).
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import scipy.sparse
import xarray as xr

import modefront as mf
from modefront import fem
from modefront._typing import Floats, Ints
from modefront.identifiability.combinations import Identifiability
from modefront.linalg.affine import DenseAffine
from modefront.models.matrices import MatrixModel
from modefront.models.mesh import mesh_model
from modefront.models.reduced.basis import certificate_of
from modefront.models.reduced.model import ReducedModel
from modefront.modes import dense
from modefront.modes.sparse import lowest
from modefront.pairing.match import FEWEST
from modefront.work.task import counted

MODES, REGIONS, PARTS, SENSORS, POINTS = 6, 6, 12, 20, 20
BOUNDS = 0.4, 2.5
NAMES = [f"k{j + 1}" for j in range(REGIONS)]
TOLD = 1e-2
"""True error of an eigenvalue, over the bound of its rounding, above which it is compared."""

STEEL = fem.Material(E=210e9, nu=0.3, rho=7850.0)

Model = Callable[[int, int], MatrixModel]


def shell(size: int, regions: int) -> MatrixModel:
    """Return a plate of 3 m x 2 m, clamped at one edge, with about ``size`` degrees of freedom."""
    n = round(np.sqrt(size / 6 / 1.5))
    X, cells = fem.grids.plate(3.0, 2.0, round(1.5 * n), n)
    X[:, 2] = 0.1 * X[:, 0] * X[:, 1]
    return _model(X, cells, regions, lambda name, part: fem.Shells(name, part, STEEL, 0.02))


def solid(size: int, regions: int) -> MatrixModel:
    """Return a block of 3 m x 0.7 m x 0.4 m, clamped at one end, of tetrahedra with 10 nodes."""
    box = np.array([3.0, 0.7, 0.4])
    grids = [np.rint(n * box).astype(int) for n in np.arange(2.0, 60.0, 0.05)]
    grid = min(grids, key=lambda k: abs(6 * k[0] * (2 * k[1] + 1) * (2 * k[2] + 1) - size))
    X, bricks = fem.grids.box((3.0, 0.7, 0.4), (int(grid[0]), int(grid[1]), int(grid[2])))
    X, cells = fem.grids.tetrahedra(X, bricks)
    return _model(X, cells, regions, lambda name, part: fem.Solids(name, part, STEEL))


def _model(
    X: Floats,
    cells: np.ndarray,
    regions: int,
    group: Callable[[str, np.ndarray], fem.Shells | fem.Solids],
) -> MatrixModel:
    """Return the model with regions along x, each with a parameter, clamped at x = 0."""
    middle = X[cells].mean(axis=1)[:, 0] / X[:, 0].max()
    region = np.minimum((middle * regions).astype(int), regions - 1)
    names = [f"k{j + 1}" for j in range(regions)]
    grid = np.linspace(0.1, 1.0, SENSORS // 2)
    along = [(x, y) for x in grid for y in (0.0, 1.0)]
    low, high = X.min(axis=0), X.max(axis=0)
    flat = X[:, :2]
    nodes = [
        int(np.argmin(((flat - low[:2] - np.array(position) * (high - low)[:2]) ** 2).sum(axis=1)))
        for position in along
    ]
    structure = fem.Structure(
        X,
        [group(name, cells[region == j]) for j, name in enumerate(names)],
        [fem.Support(np.flatnonzero(X[:, 0] == 0))],
        sensors=[fem.Sensor(f"s{i + 1}", node, "z") for i, node in enumerate(nodes)],
        parameters=[fem.Parameter(name, "E", (name,)) for name in names],
    )
    return mesh_model(structure, names)


KINDS: dict[str, Model] = {"shell": shell, "solid": solid}


def measured(kind: Model, seed: int = 0) -> mf.ModalData:
    """Return the modes of a coarse model with noise, the same for every size."""
    rng = np.random.default_rng(seed)
    truth = kind(5000, PARTS)
    modes = truth.modes(rng.uniform(0.7, 1.5, PARTS), MODES, derivatives=False)
    frequency = modes.frequency * (1 + 0.005 * rng.standard_normal(MODES))
    phi = modes.phi.T * (1 + 0.03 * rng.standard_normal(modes.phi.T.shape))
    return mf.modal_data(frequency, phi, truth.sensors)


def problem_of(model: MatrixModel | ReducedModel, data: mf.ModalData) -> mf.UpdatingProblem:
    """Return the problem of fitting the measured frequencies and shapes."""
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    return mf.updating_problem(
        model, data, groups, dict.fromkeys(NAMES, BOUNDS), dict.fromkeys(NAMES, 1.0)
    )


def work(model: MatrixModel | ReducedModel, data: mf.ModalData) -> xr.Dataset:
    """Return edges by global search, weighted models and the front, and not what is known of it."""
    return mf.solve(
        problem_of(model, data),
        points=POINTS,
        identifiability=Identifiability(flat=0, models=0),
    ).dataset


def timed(work: Callable[[], object]) -> tuple[float, float]:
    """Return the processor time that some work takes, and the time that passes, in seconds."""
    started, begun = time.process_time(), time.perf_counter()
    work()
    return time.process_time() - started, time.perf_counter() - begun


def memory() -> float:
    """Return the greatest memory of this process so far, in GiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20


def reduced_model(full: MatrixModel, count: int) -> ReducedModel:
    """Return the full model in a basis."""
    lower, upper = (np.full(REGIONS, bound) for bound in BOUNDS)
    return ReducedModel(full, count, np.ones(REGIONS), lower, upper, spare=count - MODES)


def modal_error(full: MatrixModel, columns: int, result: xr.Dataset) -> float:
    """Return the greatest error of eigenvalues from so many modes of the nominal model."""
    pencil = full.pencil
    Phi = lowest(pencil, np.ones(REGIONS), columns).Phi[:, :columns]
    K, M = (DenseAffine(A.project([Phi], Phi), A.coefficients) for A in (pencil.K, pencil.M))
    errors = []
    for i in range(result.sizes["point"]):
        theta = result["theta"].values[i]
        lam = dense.decompose(K.at(theta), M.at(theta)).lam
        exact = (2 * np.pi * result["frequency"].values[i]) ** 2
        errors.append(lam[result["paired_mode"].values[i].astype(int) - 1] / exact - 1)
    return float(np.max(errors))


def requests_of(result: xr.Dataset) -> list[tuple[Floats, Ints]]:
    """Return the parameters and the paired modes of the models that were found."""
    paired = result["paired_mode"].values.astype(int) - 1
    return [(theta, np.unique(r)) for theta, r in zip(result["theta"].values, paired, strict=True)]


def sharpness(full: MatrixModel, model: ReducedModel, result: xr.Dataset) -> Floats:
    """Return estimated errors over true ones, wherever these can be told from rounding."""
    basis = model.basis
    ratios = []
    for theta, r in requests_of(result):
        certificate = certificate_of(model.basis, theta, r)
        K, M = full.pencil.K.at(theta), full.pencil.M.at(theta)
        exact = lowest(full.pencil, theta, model.count)
        ritz = basis.combine(dense.decompose(basis.K.at(theta), basis.M.at(theta)).Phi[:, r])
        truth = quotients(K, M, ritz) / quotients(K, M, exact.Phi[:, r]) - 1
        ratios.append(
            (certificate.eigenvalue / truth)[truth > TOLD * exact.noise[r] / exact.lam[r]]
        )
    return np.concatenate(ratios)


def quotients(K: scipy.sparse.csr_array, M: scipy.sparse.csr_array, X: Floats) -> np.ndarray:
    """Return the Rayleigh quotient of each column of X, summed up in extended precision."""

    def form(A: scipy.sparse.csr_array, x: np.ndarray) -> np.longdouble:
        rows = np.repeat(np.arange(A.shape[0]), np.diff(A.indptr))
        return np.longdouble((A.data * x[rows] * x[A.indices]).sum())

    return np.array([form(K, x) / form(M, x) for x in X.T.astype(np.longdouble)])


def line(
    kind: Model, size: int, data: mf.ModalData, compare: bool, exact: bool
) -> dict[str, float]:
    """Return the measurements of one size."""
    full = kind(size, REGIONS)
    out: dict[str, float] = {"size": full.size, "memory_model": memory()}
    count = MODES + FEWEST
    full.pencil.factor(full.pencil.K.at(np.ones(REGIONS)).data, np.zeros(0), 0.0)
    out["memory_factor"] = memory()
    out["modes"], out["modes_elapsed"] = timed(
        lambda: full.modes(np.ones(REGIONS), count, derivatives=False)
    )
    out["memory_modes"] = memory()
    out["derivatives"], _ = timed(lambda: full.modes(np.ones(REGIONS), count))
    model = reduced_model(full, count)
    result: list[xr.Dataset] = []
    with counted() as costs:
        out["work"], out["work_elapsed"] = timed(lambda: result.append(work(model, data)))
    out["memory_work"] = memory()
    data_of = result[0]
    out["ratio"] = out["work"] / out["modes"]
    out["ratio_elapsed"] = out["work_elapsed"] / out["modes_elapsed"]
    out["ratio_memory"] = out["memory_work"] / out["memory_factor"]
    out["columns"] = model.columns
    for name in ("full", "corrected"):
        out[f"{name}_eigensolutions"] = data_of.attrs[f"{name}_eigensolutions"]
    for name in ("factorisations", "reduced_solutions"):
        out[name] = data_of.attrs[name]
    out["error"] = float(data_of["eigenvalue_error"].max())
    out["converged"] = float(data_of["converged"].mean())
    alone = reduced_model(full, count)
    nominal = [certificate_of(alone.basis, *x) for x in requests_of(data_of)]
    out["error_nominal"] = max(float(certificate.eigenvalue.max()) for certificate in nominal)
    out |= {name: value for name, value in vars(costs).items() if name.endswith("_time")}
    if exact:
        ratios = sharpness(full, model, data_of)
        out["sharpness_least"] = float(ratios.min())
        out["sharpness_greatest"] = float(ratios.max())
    if compare:
        out["work_full"], _ = timed(lambda: result.append(work(full, data)))
        difference = result[1]["theta"].values - result[0]["theta"].values
        out["difference"] = float(np.abs(difference).max() / (BOUNDS[1] - BOUNDS[0]))
        out["error_modal"] = modal_error(full, model.columns, data_of)
    return out


def main() -> None:
    """Print a line a size."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--kind", choices=KINDS, default="shell")
    options.add_argument("--sizes", type=int, nargs="+", default=[1000, 5000, 20000])
    options.add_argument("--full-up-to", type=int, default=5000)
    options.add_argument("--exact-up-to", type=int, default=25000)
    options.add_argument("--save", type=Path, help="append the lines to a file, for the figure")
    given = options.parse_args()
    kind = KINDS[given.kind]
    data = measured(kind)
    # What Python imports on the way is no part of the times.
    work(shell(300, REGIONS), measured(shell))
    for size in given.sizes:
        row = line(kind, size, data, size <= given.full_up_to, size <= given.exact_up_to)
        print("\n".join(f"{name:22s} {value:.5g}" for name, value in row.items()), flush=True)
        if given.save:
            with given.save.open("a") as stream:
                stream.write(json.dumps({"kind": given.kind, **row}) + "\n")


if __name__ == "__main__":
    main()
