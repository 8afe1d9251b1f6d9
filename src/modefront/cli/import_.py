"""``modefront import``: its options and its output."""

from collections import defaultdict
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from modefront.cli.layout import plural
from modefront.cli.terminal import say
from modefront.errors import wrong
from modefront.programs.base import JobOptions
from modefront.study.importing import Imported, import_deck, import_model, refuse_study


def run_import(program: str, base: Path, output: Path, **given: Any) -> None:
    """Read the jobs of a program, or make and run those of a deck; write a study, and print it."""
    refuse_study(output)
    terms = [_pair("--function", x, "NAME=TERM,TERM, such as t=t,t^3") for x in given["functions"]]
    common: dict[str, Any] = {
        "functions": {name: [term.strip() for term in x.split(",")] for name, x in terms},
        "modes": given["modes"],
        "progress": partial(say, err=True),
    }
    if given["run"] is not None:
        if program != "calculix":
            raise wrong("--run", "calculix", f"'{program}', whose jobs you make")
        for option in (x for x in ("factors", "checks") if given[x]):
            expected = "no such option beside --run, which makes the jobs itself"
            raise wrong(f"--{option[:-1]}", expected, given[option][0])
        whats = [_pair("--parameter", text, "NAME=WHAT:NAME") for text in given["parameters"]]
        imported = import_deck(base, dict(whats), run=given["run"], **common)
        _print(imported, imported.write(output))
        return
    runs, factors = defaultdict[str, list[Path]](list), defaultdict[str, list[float]](list)
    for text in given["parameters"]:
        name, run = _pair("--parameter", text, "NAME=RUN")
        runs[name].append(Path(run))
    for text in given["factors"]:
        name, factor = _pair("--factor", text, "NAME=FACTOR")
        factors[name].append(_number("--factor", factor))
    checks, form = [], "RUN:NAME=VALUE,NAME=VALUE"
    for text in given["checks"]:
        run, _, values = text.rpartition(":")
        if not run.strip():
            raise wrong("--check", form, repr(text))
        pairs = [_pair("--check", part, form) for part in values.split(",")]
        checks.append((Path(run), {name: _number("--check", value) for name, value in pairs}))
    options = JobOptions(*(given[x] for x in ("stiffness_name", "mass_name", "dofs", "deck")))
    common |= {"factors": factors, "checks": checks, "options": options}
    imported = import_model(program, base, runs, **common)
    _print(imported, imported.write(output))


def _print(imported: Imported, files: Sequence[Path]) -> None:
    terms = imported.terms
    say(f"{terms.dofs.size} degrees of freedom")
    for note in imported.notes:
        say(f"  {note}")
    for name, (count, found) in terms.ranks.items():
        rank = "" if found is None else f", of rank {found}"
        size = f"{plural(count, 'degree')} of freedom"
        of = [quantity for quantity, known in terms.matrices.items() if name in known]
        say(f"{name}: {' and '.join(of)}, at {size}{rank}")
    for error in imported.errors:
        say(f"the run for checking is what the terms say, to {error:.1e} of the greatest entry")
    if not imported.errors:
        say("not checked: --check RUN:NAME=VALUE,… compares with one more run")
    if imported.frequencies is not None:
        shown = " ".join(f"{f:.5g}" for f in imported.frequencies)
        say(f"frequencies of the nominal model: {shown} Hz")
        if not any("program prints" in note for note in imported.notes):
            say("  if your program prints other frequencies, check the units (N, kg, m; N, t, mm)")
    for file in files:
        say(f"wrote {file}")
    say(f"next: add [data] and [model.sensors] to {files[-1]}, then modefront check {files[-1]}")


def _pair(option: str, text: str, form: str) -> tuple[str, str]:
    name, sign, value = text.partition("=")
    if not sign or not name.strip() or not value.strip():
        raise wrong(option, form, repr(text))
    return name.strip(), value.strip()


def _number(option: str, text: str) -> float:
    with suppress(ValueError):
        if 0 < abs(float(text)) < float("inf"):
            return float(text)
    raise wrong(option, "a number that is not 0", repr(text))
