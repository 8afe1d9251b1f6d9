"""A study from its problem to its results, in memory or in a folder."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from threadpoolctl import threadpool_limits

from modefront._typing import Floats
from modefront._version import __version__
from modefront.errors import Fault, InputError
from modefront.identifiability.combinations import unchanged_groups
from modefront.predict import Prediction
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.explore import Search
from modefront.study.asking import Asking
from modefront.study.certified import certificate_attributes, certified_front, certified_points
from modefront.study.check import refuse_unchanged_groups
from modefront.study.file import Study
from modefront.study.knowledge import learn
from modefront.study.quality import indicators
from modefront.study.run import Front, ignore, pareto_front
from modefront.study.store import PIECES, Store
from modefront.study.tables.identifiability import Identifiability
from modefront.study.tables.settings import Pareto
from modefront.study.tables.uncertainty import Uncertainty
from modefront.uncertainty.noise import noise_floor

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
    method: str = Pareto.method,
    points: int | None = None,
    refined: float | None = None,
    population: int = Pareto.population,
    evaluations: int = Pareto.evaluations,
    tolerance: float = 0.0,
    seed: int = 0,
    search: Search | None = None,
    identifiability: Identifiability | None = None,
    uncertainty: Uncertainty | None = None,
    predictions: Sequence[Prediction] = (),
) -> xr.Dataset:
    """Return all Pareto-optimal models, edges and weighted models of a problem.

    The arguments are those of the study file, and ``refined``, for two groups, the distance of
    neighbours on the front above which there are to be more points between them, in units of the
    ranges of the objectives; ``predictions`` are made with every model. Raises UnfinishedError
    where no minimum of a group can be found, InputError where no parameter changes a group.
    """
    session = _Session(
        problem,
        Store(None, lambda: problem.counts, ignore, {}),
        Pareto(method, points, tolerance, population, evaluations),
        seed,
        search=search,
        refined=refined,
        identifiability=identifiability or Identifiability(),
        uncertainty=uncertainty or Uncertainty(),
        predictions=predictions,
    )
    return session.results()


def run(
    study: Study,
    folder: Path,
    *,
    fresh: bool = False,
    refined: float | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Do the work of a study, write ``results.nc`` into a folder and return what it holds.

    Pieces of work that an earlier run of the same inputs has left there are not done again;
    ``fresh`` sets them aside; ``refined`` is that of `solve`. Raises InputError where the folder
    cannot be written to or no parameter changes a group, and UnfinishedError where the work cannot
    be done.
    """
    from modefront.study.predictions import pieces_of
    from modefront.study.results import FILE, write

    progress = progress or Progress()
    pieces = folder / PIECES / f"{study.work[:12]}-{__version__}"
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
    session = _Session(
        problem,
        store,
        study.pareto,
        study.seed,
        search=study.search,
        given=[(one.name, np.array(one.weights)) for one in study.weighted],
        refined=refined,
        identifiability=study.identifiability,
        uncertainty=study.uncertainty,
        predictions=study.predictions,
        file=study.file,
        expect=progress.expect,
        later=pieces_of(study),
    )
    data = session.results()
    data.attrs |= {"study": study.name, "inputs": study.digest, "remark": study.remark}
    _keep_other(folder / FILE, study.digest)
    write(data, folder / FILE)
    return data


def check_refinable(study: Study, refined: float | None) -> None:
    """Raise InputError where a front is to be refined that is not one of two groups by NBI."""
    groups = len(study.problem.objectives)
    if refined is not None and (groups != 2 or study.pareto.method != "nbi"):
        found = f"{groups} groups, method '{study.pareto.method}'"
        raise InputError(Fault(str(study.file), "--refine", "two groups and method 'nbi'", found))


@dataclass(frozen=True)
class _Session:
    """All the work on a problem, kept in a store, of which ``expect`` is told the extent.

    ``later`` is how many pieces of work follow what is asked for first.
    """

    problem: UpdatingProblem
    store: Store
    pareto: Pareto
    seed: int
    search: Search | None
    refined: float | None
    identifiability: Identifiability
    uncertainty: Uncertainty
    predictions: Sequence[Prediction]
    given: Sequence[tuple[str, Floats]] = ()
    file: Path = Path("study")
    expect: Callable[[int], None] = ignore
    later: int = 0

    def results(self) -> xr.Dataset:
        """Do the work and return all that it finds.

        Raises InputError where no parameter changes a group.
        Dense problems of a hundred unknowns are slower on several threads of the BLAS than on one.
        """
        with threadpool_limits(1, user_api="blas"):
            found = self.store.arrays("unchanged-groups", self._unchanged_groups)["groups"]
            refuse_unchanged_groups(self.problem, str(self.file), found.astype(int).tolist())
            return self._results()

    def _results(self) -> xr.Dataset:
        from modefront.study.posterior_predictions import around, predicted_around
        from modefront.study.predictions import pieces, predicted
        from modefront.study.results import dataset

        problem, store, pareto = self.problem, self.store, self.pareto
        work = partial(
            pareto_front,
            problem,
            problem.properties,
            method=pareto.method,
            points=pareto.points,
            refined=self.refined,
            population=pareto.population,
            evaluations=pareto.evaluations,
            tolerance=pareto.tolerance,
            seed=self.seed,
            search=self.search,
            given=self.given,
            floor=self._noise_floor(),
        )
        front = certified_front(
            problem, work, store, lambda pieces: self.expect(pieces + self.later)
        )
        knowledge = learn(
            problem,
            front,
            points=pareto.points,
            tolerance=pareto.tolerance,
            seed=self.seed,
            identifiability=self.identifiability,
            uncertainty=self.uncertainty,
            checkpoint=store,
            expect=lambda more: self.expect(len(store.costs) + more + self.later),
        )
        extra = certified_points(problem, knowledge.points, store)
        data = dataset(problem, front, replace(knowledge, points=extra))
        asking = Asking(problem, self.predictions, self.seed, store, self.file)
        near = around(data, asking, knowledge.posterior, self.uncertainty.draws)
        more = pieces(self.predictions, data.sizes["point"] + near.models)
        self.expect(len(store.costs) + more)
        data = predicted_around(predicted(data, asking), asking, near)
        data.attrs |= self._attributes(front)
        return data

    def _unchanged_groups(self) -> dict[str, Floats]:
        """Return the positions of groups that no parameter changes, to be kept."""
        return {"groups": np.array(unchanged_groups(self.problem), dtype=float)}

    def _noise_floor(self) -> Floats | None:
        """Return what errors of the data make of the objectives; None where one is not known."""
        source = self.uncertainty.of(self.problem.data)
        if source is None:
            return None
        floor = noise_floor(self.problem, source)
        return floor if (floor > 0).all() else None

    def _attributes(self, front: Front) -> dict[str, str | int | float]:
        """Return what else is known: version, seed, cost, and remarks on what was found."""
        total, along = self.store.total(), self.store.total(f"{front.method}-")
        by_nbi = self.store.total("nbi-")
        out: dict[str, str | int | float] = {
            "version": __version__,
            "seed": self.seed,
            "model_evaluations": total["eigenproblems"] + total["reduced"],
            "method": front.method,
            "front_evaluations": along["eigenproblems"] + along["reduced"],
            "nbi_evaluations": by_nbi["eigenproblems"] + by_nbi["reduced"],
            "full_eigensolutions": total["eigenproblems"],
            "prediction_eigensolutions": self.store.total("predict-")["eigenproblems"],
            "corrected_eigensolutions": total["corrected"],
            "factorisations": total["factorisations"],
            "reduced_solutions": total["reduced"],
            "front_is_a_point": int(front.target is None),
            **({} if self.refined is None else {"refined": self.refined}),
            **indicators(front),
        }
        return out | certificate_attributes(self.problem)


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
