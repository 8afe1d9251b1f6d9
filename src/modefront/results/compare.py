r"""Results of several model classes and configurations side by side.

All is measured in the space of errors :math:`e_i = \sqrt{J_i / a_i}`, which has the same meaning
for every class (Christodoulou et al. 2008, doi:10.1016/j.cma.2008.04.010). The length of a front is
that of the shortest tree that joins its Pareto-optimal points, without gaps. Ranges and distances
are those of all Pareto-optimal models, edges and weighted ones included; those of predictions count
models that are equivalent to these, too, as the results say.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import scipy

from modefront._typing import Floats
from modefront.datasets import Dataset
from modefront.errors import Fault, InputError, noted, refuse
from modefront.front.point import Kind, front_points, position, preferred
from modefront.predictions.base import kinds_in
from modefront.results.files import read_dataset
from modefront.text import Shown

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, repr=False)
class Spread(Shown):
    """Least and greatest value over the Pareto-optimal models, and the reference's; or NaN."""

    name: str
    least: float
    greatest: float
    reference: float = float("nan")


# 14 fields: the columns of a table.
@dataclass(frozen=True, repr=False)
class Summary(Shown):
    """One front, in the space of errors; a row of the comparison, whose columns these are.

    ``points`` is the number of Pareto-optimal points, ``length_ratio`` that to the first front,
    ``extent`` (groups,) the range of each error, ``distance`` that of the closest model from the
    origin, ``optimal_distance`` and ``reference_distance`` those of the optimally weighted model
    and of the one that the data prefer. What there is none of is NaN.
    """

    name: str
    study: str
    method: str
    points: int
    eigenproblems: int
    length: float
    length_ratio: float
    extent: tuple[float, ...]
    distance: float
    optimal_distance: float
    reference: str
    reference_distance: float
    parameters: tuple[Spread, ...]
    predictions: tuple[Spread, ...]


@dataclass(frozen=True, repr=False)
class Apart(Shown):
    """Distance of two fronts in their common parameters, over the bounds of the first one.

    ``least`` and ``greatest`` (Hausdorff) are distances of a Pareto-optimal model of one from the
    nearest of the other one, ``optimal`` and ``reference`` those of these models; or NaN.
    """

    first: str
    second: str
    common: tuple[str, ...]
    least: float
    greatest: float
    optimal: float
    reference: float


@dataclass(frozen=True, repr=False)
class Comparison(Shown):
    """Several results side by side."""

    groups: tuple[str, ...]  # names of the objectives of all
    fronts: tuple[Summary, ...]  # one summary of each
    pairs: tuple[Apart, ...]  # distances of each two

    @property
    def rows(self) -> dict[str, list[object]]:
        """Quantities by their names, with a value of each front."""
        ranges = [f"range of error, {group}" for group in self.groups]
        columns = [
            {
                "study": x.study,
                "method": x.method,
                "Pareto-optimal points": x.points,
                "eigenproblems": x.eigenproblems,
                "length of the front": x.length,
                "  over that of the first": x.length_ratio,
                **dict(zip(ranges, x.extent, strict=True)),
                "least distance from origin": x.distance,
                "reference model": x.reference,
                "  its distance from origin": x.reference_distance,
            }
            for x in self.fronts
        ]
        return {name: [column[name] for column in columns] for name in columns[0]}

    @property
    def table(self) -> "pd.DataFrame":
        """One column a study, one row a quantity of its front."""
        import pandas as pd

        names = short_names([x.name for x in self.fronts])
        return pd.DataFrame(self.rows, index=names, dtype=object).T

    def __repr__(self) -> str:
        """Return the table."""
        return str(self.table.to_string(float_format="{:.4g}".format))


def compare(folders: Path | str | Sequence[Path | str]) -> Comparison:
    """Return the comparison of the results in folders.

    Parameters
    ----------
    folders
        Folder with a ``results.nc``, or several of studies with the same groups.

    Returns
    -------
    Comparison
        Groups, one summary a front, and the distance of each two fronts, all in the space of the
        errors sqrt(J / a).

    Raises
    ------
    InputError
        Where there are no results, or their groups are not the same, or no model is Pareto optimal.
    """
    results = read_together(folders)
    for folder, data in results:
        if not data["pareto"].values.any():
            expected = "at least one Pareto-optimal model"
            raise InputError(Fault(folder, "variable 'pareto'", expected, "none"))
    first = results[0][1]
    fronts = tuple(_summary(name, data, _length(first)) for name, data in results)
    pairs = tuple(_apart(one, other) for one, other in combinations(results, 2))
    return Comparison(tuple(first["group"].values.tolist()), fronts, pairs)


def short_names(folders: Sequence[str]) -> list[str]:
    """Return the last names of folders, whole paths where these are the same."""
    short = [Path(folder).resolve().name for folder in folders]
    return short if len(set(short)) == len(short) else list(folders)


def read_together(folders: Path | str | Sequence[Path | str]) -> list[tuple[str, Dataset]]:
    """Return the results in a folder or several, each with the name of its folder.

    Raises InputError where there are none, or where their groups are not the same.
    """
    listed = [Path(each) for each in ([folders] if isinstance(folders, Path | str) else folders)]
    if not listed:
        raise InputError(Fault("", "folders", "one folder of results or more", "none"))
    faults: list[Fault] = []
    results: list[tuple[str, Dataset]] = []
    for folder in listed:
        with noted(faults):
            results.append((str(folder), read_dataset(folder)))
    groups = [", ".join(data["group"].values) for _, data in results]
    for (name, _), other in zip(results, groups, strict=True):
        if other != groups[0]:
            faults.append(Fault(name, "groups", f"those of {results[0][0]}: {groups[0]}", other))
    refuse(faults)
    return results


def _of_front(data: Dataset) -> Dataset:
    """Return the Pareto-optimal points of the front; its one point where it is no more."""
    front = front_points(data)
    if front.size == 0:
        front = np.flatnonzero(data["kind"].values == Kind.EDGE.value)[:1]
    return data.isel(point=front[data["pareto"].values[front]] if front.size > 1 else front)


def _length(data: Dataset) -> float:
    front = _of_front(data)
    lengths = scipy.spatial.distance.cdist(front["error"].values, front["error"].values)
    if "piece" in front:
        piece = front["piece"].values
        lengths[piece[:, None] != piece] = 0.0
    return float(scipy.sparse.csgraph.minimum_spanning_tree(lengths).sum()) if len(lengths) else 0.0


def _models(data: Dataset) -> list[Dataset]:
    """Return the Pareto-optimal models, the reference, and the optimally weighted one, if any."""
    of = data["pareto"].values, [position(data)], data["kind"].values == Kind.OPTIMAL.value
    return [data.isel(point=each) for each in of]


def _least(values: Floats) -> float:
    return min(values.ravel().tolist(), default=np.nan)


def _summary(name: str, data: Dataset, first: float) -> Summary:
    length, (models, chosen, optimal) = _length(data), _models(data)
    quantities = ["frequency", "mac", *(x.name for kind in kinds_in(data) for x in kind.ranged)]
    nearest, best = (_least(np.linalg.norm(x["error"].values, axis=1)) for x in (models, optimal))
    return Summary(
        name,
        str(data.attrs.get("study", "")),
        str(data.attrs["method"]),
        int(_of_front(data).sizes["point"]),
        int(data.attrs["model_evaluations"]),
        length,
        length / first if first > 0 else np.nan,
        tuple(np.ptp(models["error"].values, axis=0).tolist()),
        nearest,
        best,
        str(data.attrs["reference"]) or f"{preferred(data.attrs)}, not to be used",
        float(np.linalg.norm(chosen["error"].values)),
        tuple(_spreads("theta", "", models, chosen)),
        tuple(x for name in quantities for x in _spreads(name, f"{name} ", models, chosen)),
    )


def _spreads(variable: str, prefix: str, models: Dataset, chosen: Dataset) -> Iterator[Spread]:
    names, values = models[models[variable].dims[1]].values, models[variable].values
    if f"{variable}_range" in models:
        values = models[f"{variable}_range"].values[:2]
    for name, column, (value,) in zip(names, values.T, chosen[variable].values.T, strict=True):
        known = column[np.isfinite(column)].tolist() or [np.nan]
        yield Spread(f"{prefix}{name}", min(known), max(known), float(value))


def _apart(first_results: tuple[str, Dataset], second_results: tuple[str, Dataset]) -> Apart:
    (first, a), (second, b) = first_results, second_results
    names, others = (x["parameter"].values.tolist() for x in (a, b))
    common = tuple(name for name in names if name in others)
    if not common:
        return Apart(first, second, (), *[np.nan] * 4)
    here, there = ([each.index(name) for name in common] for each in (names, others))
    span = np.diff(a["bounds"].values[here], axis=1)[:, 0]
    # Distances of the Pareto-optimal models, of the references, and of the optimally weighted ones.
    best, chosen, optimal = (
        scipy.spatial.distance.cdist(
            x["theta"].values[:, here] / span, y["theta"].values[:, there] / span
        )
        for x, y in zip(_models(a), _models(b), strict=True)
    )
    greatest = float(max(best.min(axis=0).max(), best.min(axis=1).max()))
    return Apart(first, second, common, _least(best), greatest, _least(optimal), _least(chosen))
