"""Pictures of results; matplotlib, an extra, is imported to draw one."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from modefront.errors import Fault, InputError, writing
from modefront.outputs import output
from modefront.text import file_name

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from modefront.plots.canvas import Picture

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


def pictures(module: str, *arguments: object) -> "Iterator[tuple[str, Picture]]":
    """Yield names and figures of a module: ``quantities``, ``paper`` or ``identification``."""
    with drawing():
        yield from import_module(f"modefront.plots.{module}").figures(*arguments)


def write_figures(
    named: "Iterator[tuple[str, Figure]]", folder: Path, form: str = "svg"
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
