"""Pictures of results, registered in `PLOTS`; matplotlib, an extra, is imported to draw one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from modefront.datasets import Dataset
from modefront.errors import Fault, InputError, writing
from modefront.outputs import output
from modefront.text import file_name

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from modefront.plots.canvas import Picture

PLOTS: Mapping[str, tuple[tuple[str, ...], str]] = {
    **dict.fromkeys(("front", "parameters", "frequencies", "mac"), ((), "")),
    "modes": (("shape",), "mode shapes"),
    "predictions": (("range",), "predictions"),
    "uncertainty": (("theta_std", "posterior_std"), "errors of the data or a posterior"),
    "corner": (("sample_theta",), "draws of a posterior"),
    "minima": ((), ""),
}
"""Pictures in the order of their files: variables or dimensions, one of which each shows, and what
results without any lack. They are drawn by functions of these names."""

STYLE = Path(__file__).with_name("style.mplstyle")


@contextmanager
def drawing() -> Iterator[None]:
    """Draw in the style of all pictures; raises InputError without matplotlib."""
    try:
        from matplotlib import rc_context, rc_params_from_file
    except ImportError:
        expected = "matplotlib, which `pip install modefront[figures]` brings"
        raise InputError(Fault("", "figures", expected, "no such package")) from None
    with rc_context(rc_params_from_file(STYLE, use_default_template=False)):
        yield


@dataclass(frozen=True)
class Plots:
    """Pictures of results; each method returns a figure of matplotlib, with ``savefig``.

    All raise InputError without matplotlib, and where the results do not hold what is drawn.
    """

    data: Dataset  # the results

    def front(self, *, log: bool = False) -> Picture:
        """Return the front in the space of errors; axes are logarithmic if ``log``."""
        return self._draw("front", log=log)

    def parameters(self) -> Picture:
        """Return the parameters of all models, with standard deviations where they are known."""
        return self._draw("parameters")

    def frequencies(self) -> Picture:
        """Return the frequencies of all models beside the measured ones."""
        return self._draw("frequencies")

    def mac(self) -> Picture:
        """Return the MAC values of all models."""
        return self._draw("mac")

    def modes(self, point: str | int | None = None) -> Picture:
        """Return the mode shapes of a model, the measured ones over them.

        ``point`` is a label or a position from 0, the reference unless given. Raises KeyError for
        an unknown label.
        """
        return self._draw("modes", point=point)

    def predictions(self) -> Picture:
        """Return the ranges of all predictions over the Pareto-optimal models."""
        return self._draw("predictions")

    def uncertainty(self) -> Picture:
        """Return the scatter of parameters and front by errors of the data."""
        return self._draw("uncertainty")

    def corner(self, parameters: Sequence[str] = ()) -> Picture:
        """Return the draws of the posterior, of each parameter and of each two of them.

        ``parameters`` are names; unless given, all, or the eight that are determined best. Raises
        KeyError for an unknown name.
        """
        return self._draw("corner", parameters=parameters)

    def minima(self) -> Picture:
        """Return all minima, and the models that fit equally well."""
        return self._draw("minima")

    def _draw(self, name: str, **options: Any) -> Picture:
        module = "modes" if name == "modes" else "quantities"
        with drawing():
            if not _is_held(self.data, name):
                expected = f"results with {PLOTS[name][1]}"
                raise InputError(Fault("", f"plot of {name}", expected, "none"))
            return getattr(import_module(f"modefront.plots.{module}"), name)(self.data, **options)


def _is_held(data: Dataset, name: str) -> bool:
    """Return whether results hold what a picture shows."""
    needed, _ = PLOTS[name]
    return not needed or any(each in data.variables or each in data.sizes for each in needed)


def pictures(data: Dataset) -> Iterator[tuple[str, Picture]]:
    """Yield name and figure of everything that the results hold, each prediction by itself."""
    for name in PLOTS:
        if _is_held(data, name):
            yield name, getattr(Plots(data), name)()
            if name == "predictions":
                yield from figures("quantities", data)


def figures(module: str, *arguments: object) -> Iterator[tuple[str, Picture]]:
    """Yield names and figures of a module: ``quantities``, ``paper`` or ``identification``."""
    with drawing():
        yield from import_module(f"modefront.plots.{module}").figures(*arguments)


def write_figures(
    named: Iterator[tuple[str, Figure]], folder: Path, form: str = "svg"
) -> list[Path]:
    """Write named figures into a folder and return their paths.

    Raises InputError where matplotlib is missing or the folder cannot be written to.
    """
    written: list[Path] = []
    metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(form)
    with writing(folder), drawing():
        folder.mkdir(parents=True, exist_ok=True)
        for name, figure in named:
            path = folder / f"{file_name(name, [each.stem for each in written])}.{form}"
            with output(path) as stream:
                figure.savefig(stream, format=form, metadata=metadata, dpi=150)
            written.append(path)
    return written
