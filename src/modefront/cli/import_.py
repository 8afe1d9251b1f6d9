"""``modefront import``: its options and its output."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from modefront.cli.terminal import say
from modefront.errors import Fault, InputError
from modefront.programs import PROGRAMS
from modefront.programs.base import JobOptions
from modefront.programs.importing import Imported, Request, describe, read_jobs, write_study


@dataclass(frozen=True)
class Given:
    """Options of the command that may be repeated, as they are written.

    Attributes
    ----------
    parameters : ``NAME=RUN``
    factors : ``NAME=2.0``
    functions : ``NAME=TERM,TERM``
    checks : ``RUN:NAME=VALUE,NAME=VALUE``
    """

    parameters: Sequence[str]
    factors: Sequence[str]
    functions: Sequence[str]
    checks: Sequence[str]


def run_import(
    program: str,
    nominal: Path,
    given: Given,
    options: JobOptions,
    output: Path,
    modes: int | None,
) -> None:
    """Read the jobs of a program, write a study, and print what was found."""
    request = Request(
        PROGRAMS[program],
        nominal,
        [(name, Path(run)) for name, run in map(_parameter, given.parameters)],
        [(name, _number("--factor", text)) for name, text in map(_factor, given.factors)],
        dict(map(_function, given.functions)),
        [_check(text) for text in given.checks],
        options,
        modes,
    )
    imported = read_jobs(request, lambda text: say(text, err=True))
    files = write_study(imported, program, output)
    _print(imported, files, len(given.checks))


def _print(imported: Imported, files: Sequence[Path], checks: int) -> None:
    terms = imported.terms
    say(f"{terms.dofs.size} degrees of freedom")
    for note in imported.notes:
        say(f"  {note}")
    for term in terms.terms:
        say(f"{term.name}: {describe(term)}")
    for error in imported.errors:
        say(f"affine: the run for checking differs by {error:.1e} of the greatest entry")
    if not checks:
        say("not checked: --check RUN:NAME=VALUE,… compares with one more run")
    if imported.frequencies is not None:
        shown = " ".join(f"{f:.5g}" for f in imported.frequencies)
        say(f"frequencies of the nominal model: {shown} Hz")
        say("  if your program prints other frequencies, check the units (N, kg, m; N, t, mm)")
    for file in files:
        say(f"wrote {file}")
    say(f"next: add [data] and [model.sensors] to {files[-1]}, then modefront check it")


def _pair(option: str, text: str, form: str) -> tuple[str, str]:
    name, sign, value = text.partition("=")
    if not sign or not name.strip() or not value.strip():
        raise InputError(Fault("", option, form, repr(text)))
    return name.strip(), value.strip()


def _parameter(text: str) -> tuple[str, str]:
    return _pair("--parameter", text, "NAME=RUN")


def _factor(text: str) -> tuple[str, str]:
    return _pair("--factor", text, "NAME=FACTOR")


def _function(text: str) -> tuple[str, list[str]]:
    name, terms = _pair("--function", text, "NAME=TERM,TERM, such as t=t,t^3")
    return name, [term.strip() for term in terms.split(",")]


def _check(text: str) -> tuple[Path, dict[str, float]]:
    form = "RUN:NAME=VALUE,NAME=VALUE"
    run, sign, values = text.rpartition(":")
    if not sign or not run.strip():
        raise InputError(Fault("", "--check", form, repr(text)))
    pairs = [_pair("--check", part, form) for part in values.split(",")]
    return Path(run), {name: _number("--check", value) for name, value in pairs}


def _number(option: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 0 < abs(value) < float("inf"):
        raise InputError(Fault("", option, "a number that is not 0", repr(text)))
    return value
