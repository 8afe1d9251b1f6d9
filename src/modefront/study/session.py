"""A study from its problem to its results, in memory or in a folder."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import modefront
from modefront.errors import Fault, InputError
from modefront.predict import Prediction
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.explore import Search
from modefront.study.file import Study
from modefront.study.knowledge import learn
from modefront.study.run import Front, ignore, pareto_front
from modefront.study.store import PIECES, Store
from modefront.study.tables.identifiability import Identifiability
from modefront.study.tables.settings import Pareto
from modefront.study.tables.uncertainty import Uncertainty

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
    identifiability: Identifiability | None = None,
    uncertainty: Uncertainty | None = None,
    predictions: Sequence[Prediction] = (),
) -> xr.Dataset:
    """Return all Pareto-optimal models, edges and weighted models of a problem.

    ``points`` lie along each edge of the simplex of objectives; an edge may exceed the least value
    of its group by the share ``tolerance``; ``identifiability`` and ``uncertainty`` say what is
    done about what the data do not determine and about their errors; ``predictions`` are made with
    every model. Raises UnfinishedError where no minimum of a group can be found.
    """
    from modefront.study.predictions import predicted
    from modefront.study.results import dataset

    store = Store(None, lambda: problem.counts, ignore, {})
    front = pareto_front(
        problem,
        problem.properties,
        points=points,
        tolerance=tolerance,
        seed=seed,
        search=search,
        checkpoint=store,
    )
    knowledge = learn(
        problem,
        front,
        points=points,
        tolerance=tolerance,
        seed=seed,
        identifiability=identifiability or Identifiability(),
        uncertainty=uncertainty or Uncertainty(),
        checkpoint=store,
        expect=ignore,
    )
    data = dataset(problem, front, knowledge, {})
    data = predicted(data, problem, predictions, seed, store)
    data.attrs |= _attributes(front, store, seed)
    return data


def run(
    study: Study, folder: Path, *, fresh: bool = False, progress: Progress | None = None
) -> xr.Dataset:
    """Do the work of a study, write ``results.nc`` into a folder and return what it holds.

    Pieces of work that an earlier run of the same inputs has left there are not done again;
    ``fresh`` sets them aside. Raises InputError where the folder cannot be written to and
    UnfinishedError where the work cannot be done.
    """
    from modefront.study.predictions import pieces_of, predicted
    from modefront.study.results import FILE, dataset, write

    progress = progress or Progress()
    pieces = folder / PIECES / f"{study.work[:12]}-{modefront.__version__}"
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
    front = pareto_front(
        problem,
        problem.properties,
        points=study.pareto.points,
        tolerance=study.pareto.tolerance,
        seed=study.seed,
        search=study.search,
        given=[(one.name, np.array(one.weights)) for one in study.weighted],
        checkpoint=store,
        expect=lambda pieces: progress.expect(pieces + pieces_of(study)),
    )
    knowledge = learn(
        problem,
        front,
        points=study.pareto.points,
        tolerance=study.pareto.tolerance,
        seed=study.seed,
        identifiability=study.identifiability,
        uncertainty=study.uncertainty,
        checkpoint=store,
        expect=lambda more: progress.expect(len(store.costs) + more),
    )
    data = dataset(problem, front, knowledge, {"study": study.name, "inputs": study.digest})
    data = predicted(data, problem, study.predictions, study.seed, store, study.file)
    data.attrs |= _attributes(front, store, study.seed)
    _keep_other(folder / FILE, study.digest)
    write(data, folder / FILE)
    return data


def _attributes(front: Front, store: Store, seed: int) -> dict[str, str | int | float]:
    """Return what else is known: version, seed, cost, and remarks on what was found."""
    return {
        "version": modefront.__version__,
        "seed": seed,
        "model_evaluations": store.total()["eigenproblems"],
        "nbi_evaluations": store.total("nbi-")["eigenproblems"],
        "front_is_a_point": int(front.scale is None),
    }


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
