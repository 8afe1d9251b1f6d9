"""Results as an object: points by their kind, models with matrices and modes, tables."""

import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, compress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Never

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.datasets import Dataset
from modefront.errors import ModelError
from modefront.findings.record import Finding
from modefront.front.point import Kind, front_points, position, preferred
from modefront.models.base import matrices_at
from modefront.models.matrices import MatrixModel
from modefront.plots import drawing
from modefront.residuals.problem import UpdatingProblem
from modefront.results.files import read_dataset
from modefront.results.remarks import findings_of, verdict
from modefront.results.shapes import PairedShapes, paired_shapes, write_vtu
from modefront.text import Shown

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from modefront.plots.quantities import Plots

SHOWN = (Kind.NOMINAL, Kind.MOST_PROBABLE, Kind.OPTIMAL, Kind.EQUAL, Kind.EDGE)
"""Kinds of models in the short representation, in its order."""

ALONE = "expected results with their study, read_results(folder, study), found results alone"

LINES, WIDTH, ROWS, COLUMNS = 11, 96, 6, 6
"""Lines of sentences in the short representation, their characters; models and groups."""


@dataclass(frozen=True, repr=False)
class FullShapes(Shown):
    """Modes of a model at all degrees of freedom.

    Attributes
    ----------
    frequency : (modes,) frequencies in Hz, ascending
    shape : (N, modes) mass-normalised mode shapes; the sign is arbitrary
    """

    frequency: Floats
    shape: Floats


@dataclass(frozen=True, repr=False)
class ReportedModel(Shown):
    """A model of the results.

    Attributes
    ----------
    label : name of the point, such as ``nbi-3`` or ``optimal-weights``
    kind : why it is reported, such as ``front`` or ``edge``
    theta : parameter values by name, in the units of the model
    objective : J by group, without unit
    frequency : (modes,) frequencies in Hz paired with the measured modes
    mac : (modes,) MAC values of the pairs
    problem : the updating problem; None where the results were read without their study
    """

    label: str
    kind: str
    theta: Mapping[str, float]
    objective: Mapping[str, float]
    frequency: Floats
    mac: Floats
    problem: UpdatingProblem | None = None

    @property
    def parameters(self) -> Mapping[str, float]:
        """Values of all parameters by name, those of fixed and tied ones too."""
        given = self.problem.whole[1] if self.problem and self.problem.whole else ()
        return {x.name: self.theta.get(x.tie or x.name, x.nominal) for x in given} or self.theta

    @property
    def stiffness(self) -> scipy.sparse.csc_array:
        """Stiffness matrix K(theta), (N, N); raises ModelError for a model without matrices."""
        return scipy.sparse.csc_array(self._matrices.stiffness.at(self._values))

    @property
    def mass(self) -> scipy.sparse.csc_array:
        """Mass matrix M(theta), (N, N); raises ModelError for a model without matrices."""
        return scipy.sparse.csc_array(self._matrices.mass.at(self._values))

    def modes(self, count: int | None = None) -> FullShapes:
        """Return the ``count`` lowest modes at all degrees of freedom, as many as were measured.

        Raises ModelError for a model without matrices, and where it has no such modes.
        """
        modes = self._matrices.full_modes(self._values, count or len(self.frequency))
        return FullShapes(np.sqrt(modes.lam) / (2 * np.pi), modes.Phi)

    @property
    def _values(self) -> Floats:
        return np.array(list(self.theta.values()))

    @property
    def _matrices(self) -> MatrixModel:
        if self.problem is None:
            raise ModelError(f"the matrices of a model: {ALONE}")
        if (model := matrices_at(self.problem.model, self._values)) is None:
            kind = type(self.problem.model).__name__
            raise ModelError(f"expected a model with matrices, found {kind}")
        return model


@dataclass(frozen=True, repr=False)
class Results(Shown):
    """Results of a study, over the dataset that ``results.nc`` holds.

    Variables are looked up as in the dataset, ``results["theta"]``, and so is all that is not
    listed here: ``results.sizes``, ``results.isel(point=0)``.

    Attributes
    ----------
    data : all variables and attributes; results.md lists them
    problem : the updating problem; None where the results were read without their study
    """

    data: Dataset
    problem: UpdatingProblem | None = None

    @cached_property
    def dataset(self) -> "xr.Dataset":
        """All variables and attributes as a dataset of `xarray`."""
        import xarray as xr

        values = {name: (x.dims, x.values, x.attrs) for name, x in self.data.variables.items()}
        return xr.Dataset(values, attrs=self.data.attrs)

    def __getitem__(self, name: str) -> "xr.DataArray":
        """Return a variable; raises KeyError where there is none of this name."""
        return self.dataset[name]

    def __setitem__(self, name: Never, value: Never) -> None:
        """Raise TypeError: results are not changed."""
        raise TypeError("results are not changed: dataset.assign(...) returns a changed dataset")

    def __contains__(self, name: object) -> bool:
        return name in self.data

    def __len__(self) -> int:
        return self.data.sizes["point"]

    def __iter__(self) -> Iterator[ReportedModel]:
        return map(self.model, range(len(self)))

    def __getattr__(self, name: str) -> Any:
        """Return an attribute of the dataset."""
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.dataset, name)

    @property
    def plot(self) -> "Plots":
        """Pictures: ``plot.front()``, ``plot.parameters()`` and so on, see `Plots`.

        Raises InputError without matplotlib.
        """
        with drawing():
            from modefront.plots.quantities import Plots

            return Plots(self.data)

    @property
    def front(self) -> "xr.Dataset":
        """The points along the front, in their order."""
        return self.dataset.isel(point=front_points(self.data))

    @property
    def edges(self) -> "xr.Dataset":
        """The models that are best in one group each."""
        return self._of(Kind.EDGE)

    @property
    def nominal(self) -> ReportedModel:
        """The model at the nominal parameters."""
        return self.model(Kind.NOMINAL.value)

    @property
    def reference(self) -> ReportedModel:
        """The model that the data prefer: most probable, else of optimal, else equal weights."""
        return self.model(preferred(self.data.attrs))

    @property
    def verdict(self) -> list[str]:
        """The first answer: which model to use, how sure it is, and what the front says."""
        return verdict(self.data)

    @property
    def findings(self) -> list[Finding]:
        """What was noticed besides, the most important first: kind, subject, numbers, sentence."""
        return findings_of(self.data, full=True)

    @property
    def optimal(self) -> ReportedModel | None:
        """The optimally weighted model; None where there is no regular minimum."""
        labels = self._of(Kind.OPTIMAL)["label"].values
        return self.model(str(labels[0])) if labels.size else None

    def model(self, point: str | int) -> ReportedModel:
        """Return a model by its label, or by its position from 0.

        Raises KeyError for an unknown label, IndexError for a position that there is not.
        """
        row = self.data.isel(point=position(self.data, point))
        label, kind = (str(row[name].values) for name in ("label", "kind"))
        theta, J = (
            dict(zip(row[names].values.tolist(), row[values].values.tolist(), strict=True))
            for names, values in (("parameter", "theta"), ("group", "objective"))
        )
        f, mac = row["frequency"].values, row["mac"].values
        return ReportedModel(label, kind, theta, J, f, mac, self.problem)

    def shapes(self, point: str | int) -> PairedShapes:
        """Return the mode shapes of a model at all nodes and sensors, beside the measured ones.

        ``point`` is a label or a position from 0. Raises ModelError for results that were read
        without their study, KeyError for an unknown label.
        """
        if self.problem is None:
            raise ModelError(f"mode shapes of a model: {ALONE}")
        return paired_shapes(self.data.isel(point=position(self.data, point)), self.problem)

    def write_vtu(self, path: Path | str, point: str | int) -> None:
        """Write the mode shapes of a model for ParaView, at all nodes, and the measured ones.

        Raises what `shapes` raises, ModelError for a model without geometry, and InputError
        without meshio or where the file cannot be written.
        """
        write_vtu(Path(path), self.shapes(point))

    def table(self, *points: str) -> "pd.DataFrame":
        """Return one row a model, of all points or those of these labels.

        Columns are the kind, whether it is Pareto optimal, J of each group, the parameters, errors
        of the frequencies in % and MAC values.
        """
        import pandas as pd

        data = self.data
        error = 100 * (data["frequency"].values / data["measured_frequency"].values - 1)
        columns: dict[str, Any] = {"kind": data["kind"].values, "pareto": data["pareto"].values}
        for title, names, values in (
            ("J {}", "group", data["objective"].values),
            ("{}", "parameter", data["theta"].values),
            ("error f{} %", "mode", error),
            ("MAC {}", "mode", data["mac"].values),
        ):
            columns |= dict(zip(map(title.format, data[names].values), values.T, strict=True))
        frame = pd.DataFrame(columns, index=pd.Index(data["label"].values, name="model"))
        return frame.loc[list(points)] if points else frame

    def _of(self, kind: Kind) -> "xr.Dataset":
        return self.dataset.isel(point=self.data["kind"].values == kind.value)

    def __repr__(self) -> str:
        """Return the verdict, or the first findings without one, and errors of the first models."""
        import pandas as pd

        front, name = self.front["pareto"].values, str(self.attrs.get("study", "")) or "results"
        optimal = f"{int(front.sum())} of {front.size} points of the front are Pareto optimal"
        said = [f"{name}: {optimal}", *(self.verdict or map(str, findings_of(self.data)))]
        blocks = [textwrap.wrap(text, WIDTH) for text in said]
        room = np.cumsum([len(block) for block in blocks]) <= LINES
        lines = list(chain.from_iterable(compress(blocks, room)))
        kinds = self["kind"].values
        order = [i for kind in SHOWN for i in np.flatnonzero(kinds == kind.value)][:ROWS]
        index = pd.Index(self["label"].values[order], name="model")
        groups = [f"error {group}" for group in self["group"].values[:COLUMNS]]
        table = pd.DataFrame(self["error"].values[order, :COLUMNS], index, groups)
        return "\n".join([*lines, "", table.to_string(float_format="{:.4g}".format)])


def read_results(folder: Path | str, problem: UpdatingProblem | None = None) -> Results:
    """Return the results in a folder.

    Parameters
    ----------
    folder
        Folder with a ``results.nc``.
    problem
        The updating problem, with which models have matrices and modes; ``load(path).problem`` of a
        study file. None for results alone.

    Raises
    ------
    InputError
        Where there are no results, where they are of another format, and where they are not as a
        run has written them.
    """
    return Results(read_dataset(Path(folder)), problem)
