"""A study from its problem to its results, in memory or in a folder."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import modefront
from modefront.errors import Fault, InputError
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.explore import Search
from modefront.study.certified import certificate_attributes, certified_front
from modefront.study.file import Study
from modefront.study.run import Front, ignore, pareto_front
from modefront.study.store import PIECES, Store
from modefront.study.tables.settings import Pareto

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Progress:
    """Who is told how many pieces of work there are, and of each that is done."""

    expect: Callable[[int], None] = ignore
    done: Callable[[str], None] = ignore


def solve(
    problem: UpdatingProblem,
    *,
    points: int = Pareto.points,
    tolerance: float = 0.0,
    seed: int = 0,
    search: Search | None = None,
) -> xr.Dataset:
    """Return all Pareto-optimal models, edges and weighted models of a problem.

    ``points`` lie along each edge of the simplex of objectives; an edge may exceed the least value
    of its group by the share ``tolerance``. Raises UnfinishedError where
    no minimum of a group can be found.
    """
    from modefront.study.results import dataset

    store = Store(None, lambda: problem.counts, ignore, {})
    work = partial(
        pareto_front,
        problem,
        problem.properties,
        points=points,
        tolerance=tolerance,
        seed=seed,
        search=search,
    )
    front = certified_front(problem, work, store, ignore)
    return dataset(problem, front, _attributes(problem, front, store, seed))


def run(
    study: Study, folder: Path, *, fresh: bool = False, progress: Progress | None = None
) -> xr.Dataset:
    """Do the work of a study, write ``results.nc`` into a folder and return what it holds.

    Pieces of work that an earlier run of the same inputs has left there are not done again;
    ``fresh`` sets them aside. Raises InputError where the folder cannot be written to and
    UnfinishedError where the work cannot be done.
    """
    from modefront.study.results import FILE, dataset, write

    progress = progress or Progress()
    pieces = folder / PIECES / f"{study.digest[:12]}-{modefront.__version__}"
    try:
        pieces.mkdir(parents=True, exist_ok=True)
        if fresh:
            _set_aside(pieces)
            _set_aside(folder / FILE)
    except OSError as error:
        fault = Fault(str(folder), "folder", "a folder that can be written to", str(error))
        raise InputError(fault) from None
    problem = study.problem
    store = Store(pieces, lambda: problem.counts, progress.done, {})
    work = partial(
        pareto_front,
        problem,
        problem.properties,
        points=study.pareto.points,
        tolerance=study.pareto.tolerance,
        seed=study.seed,
        search=study.search,
        given=[(one.name, np.array(one.weights)) for one in study.weighted],
    )
    front = certified_front(problem, work, store, progress.expect)
    data = dataset(problem, front, {"study": study.name, "inputs": study.digest})
    data.attrs |= _attributes(problem, front, store, study.seed)
    data.attrs["remark"] = study.remark
    _keep_other(folder / FILE, study.digest)
    write(data, folder / FILE)
    return data


def _attributes(
    problem: UpdatingProblem, front: Front, store: Store, seed: int
) -> dict[str, str | int | float]:
    """Return what else is known: version, seed, cost, and remarks on what was found."""
    total, along = store.total(), store.total("nbi-")
    out: dict[str, str | int | float] = {
        "version": modefront.__version__,
        "seed": seed,
        "model_evaluations": total["eigenproblems"] + total["reduced"],
        "nbi_evaluations": along["eigenproblems"] + along["reduced"],
        "full_eigensolutions": total["eigenproblems"],
        "factorisations": total["factorisations"],
        "reduced_solutions": total["reduced"],
        "front_is_a_point": int(front.scale is None),
    }
    return out | certificate_attributes(problem)


def _set_aside(path: Path) -> None:
    """Rename a file or a folder to a name that is free."""
    if path.exists():
        number = 1
        while (aside := path.with_name(f"{path.stem}.{number}{path.suffix}")).exists():
            number += 1
        path.rename(aside)


def _keep_other(path: Path, digest: str) -> None:
    """Set results aside that belong to other inputs."""
    import xarray as xr

    if path.is_file():
        try:
            with xr.open_dataset(path, engine="h5netcdf") as data:
                same = data.attrs.get("inputs") == digest
        except (OSError, ValueError, KeyError):
            same = False
        if not same:
            _set_aside(path)
