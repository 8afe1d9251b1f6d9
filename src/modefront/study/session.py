"""A study from its problem to its results, in memory or in a folder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from threadpoolctl import threadpool_limits

import modefront
from modefront._typing import Floats
from modefront.analysis.certified import (
    certificate_attributes,
    certified_front,
    certified_points,
)
from modefront.analysis.coverage import coverage
from modefront.analysis.front import AnalysisOptions, analyse_front
from modefront.errors import Fault, InputError
from modefront.fronts.driver import pareto_front
from modefront.fronts.front import Front
from modefront.fronts.point import Kind, Point
from modefront.identifiability.combinations import unchanged_groups
from modefront.predict import Prediction
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.explore import Search
from modefront.solvers.sqp import Solution, given
from modefront.study.check import refuse_unchanged_groups
from modefront.study.file import Study
from modefront.study.prediction_runner import PredictionRunner
from modefront.study.tables.identifiability import Identifiability
from modefront.study.tables.settings import Pareto
from modefront.study.tables.uncertainty import Uncertainty
from modefront.uncertainty.noise import noise_floor
from modefront.work.progress import Progress
from modefront.work.serial import Serial
from modefront.work.store import FOLDER, Store
from modefront.work.task import Task

if TYPE_CHECKING:
    import xarray as xr


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
        Serial(),
        Pareto(method, points, tolerance, population, evaluations, refined),
        seed,
        search=search,
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

    Tasks that an earlier run of the same inputs has done are not done again; ``fresh`` sets their
    results aside; ``refined`` is that of `solve`. Raises InputError where the folder cannot be
    written to or no parameter changes a group, and UnfinishedError where the work cannot be done.
    """
    from modefront.study.results import FILE, write

    tasks = folder / FOLDER / f"{study.work[:12]}-{modefront.__version__}"
    try:
        tasks.mkdir(parents=True, exist_ok=True)
        if fresh:
            _set_aside(tasks)
            _set_aside(folder / FILE)
    except OSError as error:
        fault = Fault(str(folder), "folder", "a folder that can be written to", str(error))
        raise InputError(fault) from None
    pareto = study.pareto if refined is None else replace(study.pareto, refined=refined)
    session = _Session(
        study.problem,
        Serial(Store(tasks), progress or Progress()),
        pareto,
        study.seed,
        search=study.search,
        given=[(weights.name, np.array(weights.weights)) for weights in study.weighted],
        identifiability=study.identifiability,
        uncertainty=study.uncertainty,
        predictions=study.predictions,
        file=study.file,
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
    """All the work on a problem, by an executor."""

    problem: UpdatingProblem
    work: Serial
    pareto: Pareto
    seed: int
    search: Search | None
    identifiability: Identifiability
    uncertainty: Uncertainty
    predictions: Sequence[Prediction]
    given: Sequence[tuple[str, Floats]] = ()
    file: Path = Path("study")

    def results(self) -> xr.Dataset:
        """Do the work and return its results.

        Raises InputError where no parameter changes a group.
        Dense problems of a hundred unknowns are slower on several threads of the BLAS than on one.
        """
        with threadpool_limits(1, user_api="blas"):
            task = Task(("check-groups",), unchanged_groups, (self.problem,))
            (unchanged,) = self.work.run([task])
            refuse_unchanged_groups(self.problem, str(self.file), unchanged)
            return self._results()

    def _results(self) -> xr.Dataset:
        from modefront.study.posterior_predictions import around, predicted_around
        from modefront.study.predictions import extent, predicted
        from modefront.study.results import dataset

        problem, work = self.problem, self.work
        search = partial(
            pareto_front,
            problem,
            problem.properties,
            self.pareto,
            seed=self.seed,
            search=self.search,
            given=self.given,
            floor=self._noise_floor(),
        )
        front = certified_front(problem, search, work)
        options = AnalysisOptions(self.pareto, self.identifiability, self.uncertainty, self.seed)
        analysis = analyse_front(problem, front, options, work)
        (nominal,) = work.run([Task(("nominal",), _nominal, (problem,))])
        extra = [*analysis.points, Point(Kind.NOMINAL, nominal)]
        analysis = replace(analysis, points=certified_points(problem, extra, work))
        data = dataset(problem, front, analysis)
        runner = PredictionRunner(problem, self.predictions, self.seed, work, self.file)
        near = around(data, runner, analysis.posterior, self.uncertainty.draws)
        work.expect(extent(self.predictions, data.sizes["point"] + near.models))
        data = predicted_around(predicted(data, runner), runner, near)
        data.attrs |= self._attributes(front)
        return data

    def _noise_floor(self) -> Floats | None:
        """Return the objectives that errors of the data explain; None where one is not known."""
        source = self.uncertainty.of(self.problem.data)
        if source is None:
            return None
        floor = noise_floor(self.problem, source)
        return floor if (floor > 0).all() else None

    def _attributes(self, front: Front) -> dict[str, str | int | float]:
        """Return version, seed, costs, and the coverage of the front."""
        total = self.work.total()
        along = self.work.total(lambda stage: stage == "front")
        predictions = self.work.total(lambda stage: stage == "predict")
        out: dict[str, str | int | float] = {
            "version": modefront.__version__,
            "seed": self.seed,
            "model_evaluations": total.model_evaluations,
            "method": front.method,
            "front_evaluations": along.model_evaluations,
            "nbi_evaluations": along.model_evaluations if front.method == "nbi" else 0,
            "full_eigensolutions": total.eigenproblems,
            "prediction_eigensolutions": predictions.eigenproblems,
            "corrected_eigensolutions": total.corrected,
            "factorisations": total.factorisations,
            "reduced_solutions": total.reduced,
            "front_is_a_point": int(front.target is None),
            **({} if self.pareto.refined is None else {"refined": self.pareto.refined}),
            **coverage(front),
        }
        return out | certificate_attributes(self.problem)


def _nominal(problem: UpdatingProblem) -> Solution:
    """Return the model at the nominal parameters."""
    return given(problem.evaluate(problem.start))


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
