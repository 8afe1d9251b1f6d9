"""The command ``modefront``; what takes long to import is imported where a command needs it."""

import io
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext, suppress
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any

import click

from modefront._version import __version__
from modefront.cli.terminal import complain, prepare, say, say_next
from modefront.errors import InputError, UnfinishedError, reason, refuse
from modefront.text import json_of, one_line

PATH = click.Path(path_type=Path)

_output = partial(click.option, "-o", "--output", type=PATH)

FORMAT = click.option("--format", "form", type=click.Choice(["table", "json"]), default="table")

SETTINGS = {"help_option_names": ["-h", "--help"], "show_default": True}

OK, UNDONE, WRONG_INPUT, INTERRUPTED = 0, 1, 2, 130
"""Exit statuses; 130 is that of shells for an interrupt."""


def _numbers(kind: type[float]) -> Callable[[str], tuple[float, ...]]:
    """Return the type of numbers with commas between them."""

    def numbers(text: str) -> tuple[float, ...]:
        try:
            return tuple(map(kind, text.split(",")))
        except ValueError:
            expected = "expected numbers with commas between them"
            raise click.BadParameter(f"{expected}, found {text!r}") from None

    return numbers


def _repeated(
    flag: str, metavar: str, text: str, *, required: bool = False
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Return an option that may be repeated, of a form and with its help."""
    more: dict[str, Any] = {"multiple": True, "metavar": metavar, "required": required}
    return click.option(flag, f"{flag.removeprefix('--')}s", help=text, **more)


LISTS = {
    "models": "The main models.",
    "points": "All models.",
    "minima": "All minima.",
    "uncertainty": "All scatter.",
    "predictions": "All predictions.",
    "findings": "All findings.",
}
"""Full lists that ``show`` prints, each with the help of its option."""


def _full_lists(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command with an option for each of `LISTS`."""
    for name, text in reversed(LISTS.items()):
        more: dict[str, Any] = {"flag_value": name, "multiple": True, "help": text}
        command = click.option(f"--{name}", "lists", **more)(command)
    return command


@click.group(invoke_without_command=True, context_settings=SETTINGS)
@click.version_option(__version__, prog_name="modefront")
@click.pass_context
def cli(context: click.Context) -> None:
    """Find all models of a structure that are Pareto optimal in its measured modes."""
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


@cli.command()
@click.argument("directory", type=PATH)
@click.option(
    "--example",
    default="three-story",
    help="One of ambient-test, calculix, eighteen-stories, footbridge, hammer-test, three-groups, "
    "three-story, three-story-c0, -c1, -fe-c0, -fe-c1 and wrong-class.",
)
def init(directory: Path, example: str) -> None:
    """Write a study that runs at once into DIRECTORY."""
    from modefront.study.examples import write_example
    from modefront.study.file import add_schema

    files = write_example(example, directory)
    studies = [path for path in files if path.name.startswith("study") and path.suffix == ".toml"]
    for path in (*files, add_schema(studies)):
        say(f"wrote {path}")
    say_next("check", directory / "study.toml")


@cli.command()
def schema() -> None:
    """Print the JSON Schema of study files, for editors."""
    from modefront.study.file import as_text

    click.echo(as_text(), nl=False)


@cli.command()
@click.argument("study", type=PATH)
@click.option("--all", "every", is_flag=True, help="All findings, not only the ten first.")
def check(study: Path, every: bool) -> None:
    """Say all that is wrong with STUDY, and prove its derivatives."""
    from modefront.cli.show import print_findings, say_estimate
    from modefront.study.check import check as check_study
    from modefront.study.estimate import estimate
    from modefront.study.file import load

    loaded, started = load(study), time.process_time()
    findings = check_study(loaded)
    print_findings(loaded, findings, every=every)
    say_estimate(estimate(loaded, started))
    say(f"a search ends after {loaded.search.evaluations:,} evaluations: [search] evaluations")
    if not findings.sound:
        first = "the derivatives cannot be proved before what is warned of first is put right"
        raise UnfinishedError(first if findings.mistakes else str(findings.cause))
    say_next("run", study)


@cli.command()
@click.argument("study", type=PATH)
@_output("directory", help="Folder of the results  [default: the study file's name with -results]")
@click.option("--fresh", is_flag=True, help="Start over; earlier work is set aside, not deleted.")
@click.option(
    "--refine",
    type=click.FloatRange(1e-3, 1),
    metavar="SIZE",
    help="More points where neighbours on the front are farther apart, in units of its ranges.",
)
@click.option(
    "--workers",
    type=click.IntRange(1, 61),
    default=1,
    metavar="N",
    help="Processes that do the work; the digits do not depend on them.",
)
@click.option("--scheduler", metavar="tcp://HOST:PORT", help="Dask cluster that does the work.")
def run(
    study: Path,
    directory: Path | None,
    fresh: bool,
    refine: float | None,
    workers: int,
    scheduler: str | None,
) -> None:
    """Do the work of STUDY; continue where an interrupted run stopped."""
    from modefront.work.workers import backend

    directory = directory or study.with_name(f"{study.stem}-results")
    carrier: AbstractContextManager[Any] = backend(workers, scheduler)
    with ExitStack() as early:
        if scheduler is None:  # they start while the study is read
            carrier = nullcontext(early.enter_context(carrier))
        from modefront.cli.progress import progress_bar
        from modefront.cli.show import print_summary, say_estimate
        from modefront.results.remarks import not_converged, uncertified
        from modefront.study.estimate import SHORT, estimate
        from modefront.study.file import load
        from modefront.study.session import of_another_program
        from modefront.study.session import run as run_study

        loaded = load(study)
        for path in of_another_program(loaded, directory):
            say(f"not taken over, and may be deleted: {path}, by another version", err=True)
        if refine is not None:
            pareto = replace(loaded.pareto, refined=refine)
            faults = pareto.faults(len(loaded.problem.groups))
            refuse(replace(fault, file=str(study), place="--refine") for fault in faults)
            loaded = replace(loaded, pareto=pareto)
        expected = estimate(loaded, time.process_time())
        if expected is not None and expected.range[1] > SHORT:
            say_estimate(expected, err=True)
        with progress_bar(loaded.name, expected.plan if expected else None) as progress:
            done = run_study(loaded, directory, fresh=fresh, progress=progress, workers=carrier)
        data = done.data
    try:
        print_summary(data, study, directory, progress.spent)
        if sys.stdout is not None:
            sys.stdout.flush()
    except BrokenPipeError:  # as by `| head`: the status is that of the run all the same
        _abandon_output()
        complain(f"modefront: nobody reads the summary; the results are in {directory}")
    for marked, what in (
        (not_converged(data), "not converged, kept and marked as such"),
        (uncertified(data), "errors above the tolerance, kept and marked"),
    ):
        if marked.any():
            raise UnfinishedError(f"{what}: {', '.join(data['label'].values[marked])}")


@cli.command()
@click.argument("directory", type=PATH)
@FORMAT
@click.option("--figures", is_flag=True, help="Draw all pictures into DIRECTORY/figures.")
@click.option(
    "--figure-format",
    "picture",
    type=click.Choice(["svg", "png", "pdf"]),
    default="svg",
    help="Format of the pictures.",
)
@_full_lists
@click.option("--all", "every", is_flag=True, help="All of these lists.")
def show(
    directory: Path, form: str, figures: bool, picture: str, lists: tuple[str, ...], every: bool
) -> None:
    """Print the results in DIRECTORY, or full lists of them."""
    from modefront.cli.show import as_json, print_results
    from modefront.results.files import read_dataset

    data = read_dataset(directory)
    if figures:
        from modefront.plots import pictures, write_figures

        named = pictures("quantities", data)
        for path in write_figures(named, directory / "figures", picture):
            say(f"wrote {path}", err=form == "json")
    if form == "json":
        print(as_json(data))
    elif figures and not (lists or every):
        say_next("report", directory)
    else:
        print_results(data, tuple(LISTS) if every else lists, directory)


@cli.command()
@click.argument("directories", nargs=-1, required=True, type=PATH)
@FORMAT
@click.option("--all", "every", is_flag=True, help="All parameters and predictions.")
def compare(directories: tuple[Path, ...], form: str, every: bool) -> None:
    """Set the results in several DIRECTORIES side by side."""
    from modefront.cli.show import print_comparison
    from modefront.results.compare import compare as compare_results

    comparison = compare_results(directories)
    if form == "json":
        print(json_of(asdict(comparison), indent=1))
    else:
        print_comparison(comparison, every=every)


@cli.command()
@click.argument("directories", nargs=-1, required=True, type=PATH)
@_output(help="HTML file  [default: report.html in the first DIRECTORY]")
@click.option(
    "--figures",
    type=PATH,
    help="Write figures 2 to 7 of the paper into this folder, in place of the HTML file.",
)
def report(directories: tuple[Path, ...], output: Path | None, figures: Path | None) -> None:
    """Write the results in DIRECTORIES as one HTML file to look at."""
    if figures is None:
        from modefront.reports.page import report as write_report

        path = write_report(directories, output)
        say(f"wrote {path} ({path.stat().st_size / 1e6:.2f} MB): open it in a browser")
        say_next("export", directories[0])
        return
    from modefront.plots import pictures, write_figures
    from modefront.results.compare import read_together

    studies = [(data.attrs.get("study") or name, data) for name, data in read_together(directories)]
    paths = write_figures(pictures("paper", studies), figures)
    for path in paths:
        say(f"wrote {path}")
    for number, what in ((6, "peaks of the frequency response"), (7, "probabilities of failure")):
        if f"figure-{number}" not in [path.stem for path in paths]:
            say(f"figure {number} is left out: no study predicts {what}")
    say_next("report", *directories)


@cli.command()
@click.argument("path", metavar="TEST", type=PATH)
@_output(help="Modal data: a CSV file, or .uff for dataset 55.", required=True)
@click.option(
    "--band",
    type=(click.FloatRange(0), click.FloatRange(0, min_open=True)),
    metavar="LOW HIGH",
    help="Band in Hz  [default: that of the test file, or all lines]",
)
@click.option(
    "--figures",
    type=PATH,
    help="Folder for pictures: stabilisation diagram, mode indicators, functions, auto-MAC.",
)
@click.option(
    "--report",
    type=PATH,
    metavar="FILE.html",
    help="One HTML file to look at, in which poles are chosen for the test file.",
)
@click.option("--keep", type=_numbers(int), metavar="1,2,…", help="Modes that stay, of the table.")
@click.option("--drop", type=_numbers(int), metavar="7,…", help="Modes that do not stay.")
@click.option(
    "--seed",
    "seeds",
    type=_numbers(float),
    metavar="4.6,13.8",
    help="Frequencies in Hz at which there is to be a mode, whatever its evidence.",
)
def identify(**given: Any) -> None:
    """Turn the frequency response functions of TEST into modal data."""
    from modefront.cli.identify import run_identify

    run_identify(**given)


@cli.command("import")
@click.argument(
    "program", type=click.Choice(["calculix", "abaqus", "nastran", "ansys", "opensees"])
)
@click.argument("base", type=PATH)
@_repeated(
    "--parameter",
    "NAME=RUN",
    "A parameter, and the job with it at a factor of its nominal value; with --run, what it "
    "multiplies: material:NAME, density:NAME, section:ELSET, spring:ELSET, mass:ELSET.",
    required=True,
)
@click.option(
    "--run", metavar="ccx", help="CalculiX, which runs jobs that are made from the deck BASE."
)
@_repeated(
    "--factor",
    "NAME=FACTOR",
    "This factor, one for each run of the parameter in their order  [default: 2]",
)
@_repeated(
    "--function",
    "NAME=TERM,…",
    "How the matrices depend on a parameter where not linearly: t=t,t^3 or L=1/L.",
)
@_repeated(
    "--check",
    "RUN:NAME=VALUE,…",
    "A job with parameters at other factors, which is compared with the terms.",
)
@click.option(
    "--dofs",
    type=PATH,
    help="CSV node,direction, one row a degree of freedom, where the program's files have none.",
)
@click.option("--deck", type=PATH, help="The deck, if it is not beside the matrices.")
@click.option("--stiffness-name", metavar="NAME", help="Name of K in a file of several matrices.")
@click.option("--mass-name", metavar="NAME", help="Name of M likewise.")
@click.option(
    "--modes", type=click.IntRange(0), help="Frequencies to compute  [default: 6 if it is quick]"
)
@_output(help="Folder for the study; one that has none.", required=True)
def import_(**given: Any) -> None:
    """Turn the matrices of a finite-element PROGRAM into a study.

    BASE is the job at the nominal values.
    """
    from modefront.cli.import_ import run_import

    run_import(**given)


@cli.command()
@click.argument("directory", type=PATH)
@click.option("--point", metavar="LABEL", help="Which model  [default: the one the data prefer]")
@click.option(
    "--study", type=PATH, help="The study of the results  [default: found where it was run]"
)
@_output(help="Folder for the files  [default: export-LABEL in DIRECTORY]")
@click.option("--modes", type=click.IntRange(1), help="Mode shapes  [default: as many as measured]")
def export(directory: Path, **given: Any) -> None:
    """Write a model of results: parameters, matrices, mode shapes."""
    from modefront.study.export import export as write_model

    exported = write_model(directory, **given)
    for file in exported.files:
        say(f"wrote {file}")
    for what in exported.missing:
        say(f"not written: {what}")
    if exported.warning:
        say(exported.warning)
    say_next("show", directory, "--points")


@contextmanager
def _signals() -> Iterator[list[int]]:
    """Let the end of a terminal or of a job interrupt as Ctrl-C does, once; yield what came.

    What is ignored, as in the background of a shell or under ``nohup``, stays ignored.
    """
    heard: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield heard
        return
    known = (getattr(signal, name, None) for name in ("SIGINT", "SIGTERM", "SIGHUP"))
    before = {x: signal.getsignal(x) for x in known if x and signal.getsignal(x) != signal.SIG_IGN}

    def interrupt(number: int, _: object) -> None:
        heard.append(number)
        for each in before:
            signal.signal(each, lambda *_: os._exit(INTERRUPTED))
        sys.unraisablehook = lambda _: None  # what stays half open complains when it is deleted
        raise KeyboardInterrupt

    for number in before:
        signal.signal(number, interrupt)
    try:
        yield heard
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _abandon_output() -> None:
    """Write nothing more to standard output, which takes no more, at the end of the program."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main() -> None:
    """Run the command and leave with its exit status; no input produces a traceback."""
    prepare()
    with _signals() as heard:
        status = _status(heard)
    sys.exit(status)


def _status(heard: list[int]) -> int:
    """Run the command and return its exit status."""
    try:
        try:
            cli.main(standalone_mode=False)
        except Exception:
            if heard:  # what an interrupt leaves half open may raise an error of its own
                raise KeyboardInterrupt from None
            raise
        if sys.stdout is not None:
            sys.stdout.flush()
        return OK
    except click.exceptions.Exit as exit_:
        return exit_.exit_code
    except (click.ClickException, InputError) as error:
        if isinstance(error, click.ClickException):
            error.show(out := io.StringIO())  # with a reference to --help
        complain(str(error) if isinstance(error, InputError) else out.getvalue().rstrip())
        return WRONG_INPUT
    except (KeyboardInterrupt, click.Abort):
        complain("modefront: interrupted; what was done is kept, run again to continue")
        return INTERRUPTED
    except BrokenPipeError:
        _abandon_output()
    except UnfinishedError as error:
        complain(f"modefront: {error}")
    except (OSError, MemoryError) as error:  # such as a full disk
        _abandon_output()
        place = f"{where}: " if (where := getattr(error, "filename", None)) else ""
        complain(f"modefront: {place}{reason(error)}; what was done is kept")
    except Exception as error:
        if os.environ.get("MODEFRONT_TRACEBACK"):
            raise
        complain(
            f"modefront: an error of the program itself: {type(error).__name__}: "
            f"{one_line(error, 1000)}\n"
            "please report it, with the output of the same command under MODEFRONT_TRACEBACK=1"
        )
    return UNDONE
