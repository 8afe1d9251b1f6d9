"""A study from its problem to its results, in memory or in a folder."""

import hashlib
import os
from contextlib import AbstractContextManager, suppress
from dataclasses import replace
from functools import cache, partial
from itertools import count
from pathlib import Path
from typing import Any, Unpack

from threadpoolctl import threadpool_limits

from modefront._version import __version__
from modefront.analysis import certified
from modefront.analysis.front import analyse_front
from modefront.datasets import Dataset
from modefront.errors import writing
from modefront.front.front import Front
from modefront.front.indicators import coverage
from modefront.front.options import Pareto, ParetoOptions
from modefront.front.pareto import pareto_front
from modefront.front.point import Kind, Point, of_kind
from modefront.identifiability.combinations import superfluous, unchanged_groups
from modefront.inputs import wrong
from modefront.models.base import is_reduced
from modefront.optim.sqp import given
from modefront.outputs import remove_unfinished, write_text
from modefront.residuals.problem import UpdatingProblem
from modefront.results.assemble import dataset, with_intervals
from modefront.results.files import FILE, write, written_for
from modefront.results.predictions import PredictionRunner, with_predictions
from modefront.results.results import Results
from modefront.results.shapes import mode_shapes, with_mode_shapes
from modefront.results.verdict import with_verdict
from modefront.study.check import refuse_too_many, refuse_unchanged_groups
from modefront.study.definition import Study, StudyOptions
from modefront.study.file import as_study
from modefront.uncertainty.inference import infer, most_probable
from modefront.uncertainty.sampling import DRAWS
from modefront.work.progress import Progress
from modefront.work.store import FOLDER, NOTE, Run, Store, locked
from modefront.work.task import Executor, Task, Within
from modefront.work.workers import Workers, backend


def solve(problem: UpdatingProblem, **options: Unpack[StudyOptions]) -> Results:
    """Return the Pareto-optimal models, the edges and the weighted models of a problem.

    Parameters
    ----------
    problem
        The updating problem, see `updating_problem`.
    options
        Fields of `Study` as keywords, ``seed=1, search=Search(doubt=0.5)``, and fields of its
        ``pareto``, ``method="weights", points=10``, in place of its own.

    Raises
    ------
    InputError
        For options that are not possible, and if no parameter changes a group.
    UnfinishedError
        If no minimum of a group is found.
    """
    chosen: dict[str, Any] = {**options}
    front = {key: chosen.pop(key) for key in ParetoOptions.__annotations__ if key in chosen}
    pareto = replace(chosen.pop("pareto", None) or Pareto(), **front)
    chosen = {key: value for key, value in chosen.items() if value is not None}
    return run(Study(problem, pareto=pareto, **chosen))


# 7 arguments: the study, and how it is run by keyword.
def run(
    study: Study | UpdatingProblem | Path | str,
    folder: Path | str | None = None,
    *,
    fresh: bool = False,
    refined: float | None = None,
    progress: Progress | None = None,
    workers: int | AbstractContextManager[Workers] = 1,
    scheduler: str | None = None,
) -> Results:
    """Return the results of a study or a problem, and write them to ``results.nc`` in a folder.

    Parameters
    ----------
    study
        The study, the path of its file, or a problem with the options that are usual. A study that
        was read from a file continues where an interrupted run stopped: tasks that are done are not
        done again. One that was made in Python starts over.
    folder
        Folder for ``results.nc`` and the results of the tasks; made where there is none. None to
        write nothing.
    fresh
        Whether a study from a file starts over as well. Earlier results are renamed, never deleted.
    refined
        Distance of neighbours on the front, in place of that of the study's `Pareto`.
    progress
        Receives reports of tasks that are begun and done; None for no reports.
    workers
        Number of processes that do the work, or what `modefront.work.workers.backend` returns.
        Where there are several, a script calls this function under
        ``if __name__ == "__main__":``, since each of them imports the script.
    scheduler
        Address of the scheduler of a Dask cluster that does the work, like ``tcp://HOST:PORT``.

    The digits of the results do not depend on who does the work.

    Raises
    ------
    InputError
        If the folder cannot be written to, the front cannot be refined, no parameter changes a
        group, or the model cannot be sent to another process.
    UnfinishedError
        If the work cannot be done; what is done is kept.
    """
    work = workers if isinstance(workers, AbstractContextManager) else backend(workers, scheduler)
    study = as_study(study)
    if refined is not None:
        study = replace(study, pareto=replace(study.pareto, refined=refined))
    study, progress = study.completed(), progress or Progress()

    def done(store: Store | None = None) -> Dataset:
        # Dense problems of a hundred unknowns are slower on several threads than on one.
        with work as opened, threadpool_limits(1, user_api="blas"):
            progress.workers = opened.workers
            return worked(study, Run(store, progress, opened))

    if folder is None:
        return Results(done(), study.problem)
    folder = Path(folder)
    tasks = _tasks(study, folder)
    for path in (path for path in (tasks.parent, tasks) if path.is_symlink()):
        found = f"a link to {path.readlink()}: remove it, or choose another folder with -o"
        raise wrong(path, "a folder of its own", found, "folder")
    with writing(folder):
        tasks.parent.mkdir(parents=True, exist_ok=True)
    with locked(folder):
        with writing(tasks):
            for path in (tasks, folder / FILE) if fresh or not study.work else ():
                _set_aside(path)
            tasks.mkdir(exist_ok=True)
        remove_unfinished(folder, FILE)
        remove_unfinished(tasks)
        try:
            data = done(Store(tasks))
        finally:  # an interrupt may come when a file is there and nobody knows of it yet
            remove_unfinished(tasks)
        if (folder / FILE).is_file() and written_for(folder / FILE) != study.digest:
            _set_aside(folder / FILE)
        write(data, folder / FILE)
        if study.origin is not None:
            with suppress(ValueError, OSError):  # another drive; a note is no loss
                note = os.path.relpath(study.origin.file.absolute(), folder.absolute())
                write_text(tasks / NOTE, Path(note).as_posix() + "\n")
    return Results(data, study.problem)


def of_another_program(study: Study, folder: Path) -> list[Path]:
    """Return what other versions of the program have kept of a study's work, and this one not."""
    kept = sorted((folder / FOLDER).glob(f"{study.work[:12]}-*")) if study.work else []
    return [] if _tasks(study, folder).exists() else kept


def _tasks(study: Study, folder: Path) -> Path:
    return folder / FOLDER / f"{study.work[:12]}-{__version__}-{_program()}"


@cache
def _program() -> str:
    """Return a hash of the program: results that another one has kept may not fit into a run."""
    files = sorted(Path(__file__).parents[1].rglob("*.py"))
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:12]


def worked(study: Study, work: Run) -> Dataset:
    """Do the work of a study, and return its results; see `run`."""
    problem, seed, file = study.problem, study.seed, str(study.file)
    refuse_too_many(problem, file)
    (unchanged,) = work.run([Task(("check-groups",), unchanged_groups, (problem,))])
    refuse_unchanged_groups(problem, file, unchanged)
    weighted = [(each.name, each.of(problem.objectives)) for each in study.weighted]
    of_search: dict[str, Any] = {"seed": seed, "search": study.search, "given": weighted}
    of_search |= {"options": study.pareto, "least": problem.least}
    search = partial(pareto_front, problem, problem.properties, **of_search)
    # What follows from the points of a refined front, snapshots included, is another repetition.
    refined = study.pareto.refined
    again: Executor = work if refined is None else Within(work, ("refined", repr(refined)))
    front = certified.certified_front(problem, search, again if is_reduced(problem.model) else work)
    noise = study.noise.of(problem, study.uncertainty.of(problem.data))
    inference = None
    if noise is not None:
        minima = [x for edge in front.edges for x in edge.minima]
        known = [x.theta for x in (*(point.solution for point in front.points), *minima)]
        find = partial(most_probable, problem, noise)
        maxima = certified.certified_best(problem, find, known, again)
        front = replace(front, points=[*front.points, Point(Kind.MOST_PROBABLE, maxima[0])])
        draws = max(DRAWS, study.uncertainty.draws)
        along = [x.solution.theta for x in of_kind(front.points, Kind.FRONT)]
        inference = infer(noise, maxima, along, draws, seed, again)
    options = study.pareto, study.identifiability, study.uncertainty
    analysis = analyse_front(problem, front, *options, seed, again)
    of, weights = study.noise.weighed(problem, study.uncertainty.of(problem.data))
    at = {("nominal",): problem.evaluate, ("nominal", "weighed"): of.evaluate}
    nominal, beside = work.run([Task(key, each, (problem.start,)) for key, each in at.items()])
    more = [*analysis.identifiable.points, Point(Kind.NOMINAL, given(nominal))]
    certified.certify(problem, [point.solution for point in more], again)
    data = dataset(problem, replace(front, points=[*front.points, *more]), analysis)
    theta, paired = data["theta"].values, data["paired_mode"].values
    (shapes,) = again.run([Task(("shapes",), mode_shapes, (problem, theta, paired))])
    data = with_mode_shapes(data, problem, shapes)
    gaussian, drawn = analysis.posterior, None
    if noise is not None and inference is not None:
        data = with_intervals(data, noise, inference)
        gaussian, drawn = inference.gaussian(problem.upper - problem.lower), inference.draws.theta
    runner = PredictionRunner(problem, study.predictions, seed, again, study.file)
    draws = study.uncertainty.draws
    data = with_predictions(data, runner, study.slack, gaussian, draws, drawn)
    spare = superfluous(of, beside, weights) if beside.feasible else ()
    return with_verdict(data, spare).assign_attrs(_attributes(study, work, front))


def _attributes(study: Study, work: Run, front: Front) -> dict[str, str | int | float]:
    total = work.total(lambda stage: stage != "shapes")
    along, predicted, shapes = (work.total(x.__eq__) for x in ("front", "predict", "shapes"))
    refined = study.pareto.refined
    out: dict[str, str | int | float] = {
        "study": study.name,
        "inputs": study.digest,
        "remark": study.origin.remark if study.origin else "",
        "version": __version__,
        "seed": study.seed,
        "model_evaluations": total.model_evaluations,
        "method": front.method,
        "front_evaluations": along.model_evaluations,
        "full_eigensolutions": total.eigenproblems,
        "prediction_eigensolutions": predicted.eigenproblems,
        "shape_eigensolutions": shapes.model_evaluations,
        "corrected_eigensolutions": total.corrected,
        "factorisations": total.factorisations,
        "reduced_solutions": total.reduced,
        "front_is_a_point": int(front.target is None),
        **({} if refined is None else {"refined": refined}),
        **coverage(front),
    }
    return out | certified.certificate_attributes(study.problem)


def _set_aside(path: Path) -> None:
    if path.exists():
        names = (path.with_name(f"{path.stem}.{k}{path.suffix}") for k in count(1))
        path.rename(next(name for name in names if not name.exists()))
