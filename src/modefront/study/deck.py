r"""Import of a CalculiX deck: the jobs of its parameters are made from it, and run.

A parameter multiplies what the deck says of a name:

===================  ==========================================================  ================
what                 numbers                                                     matrices
===================  ==========================================================  ================
``material:NAME``    moduli in ``*ELASTIC`` of the material                      :math:`\theta`
``density:NAME``     ``*DENSITY`` of the material                                :math:`\theta`
``spring:ELSET``     constants of ``*SPRING``                                    :math:`\theta`
``mass:ELSET``       ``*MASS``                                                   :math:`\theta`
``section:ELSET``    thickness of ``*SHELL SECTION``, of which the program       :math:`\theta`,
                     makes solids                                                1/θ, θ², θ³
===================  ==========================================================  ================

There is a job at the nominal values, one for each term of a parameter, and one with all parameters
at other values, with which the terms are compared. The program also prints frequencies of the deck,
with which those of the imported matrices are compared.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import cycle
from pathlib import Path
from typing import NamedTuple

import numpy as np

from modefront._typing import Floats
from modefront.errors import Fault, InputError, reason, refuse, suggestion, writing
from modefront.inputs import fortran
from modefront.outputs import write_text
from modefront.programs.changes import text_of
from modefront.programs.inp import DEEPEST, keyword_of
from modefront.study.importing import Imported, import_model
from modefront.text import one_line

FACTORS, CHECK = (2.0, 0.5, 1.5, 0.75), (1.5, 0.7, 1.3, 0.8)
"""Factors of a parameter in its jobs, as many as it has terms, and of the parameters in turn in the
job with which the terms are compared."""

THICKNESS = ("{0}", "1/{0}", "{0}^2", "{0}^3")
"""Terms of the thickness of a shell, of which the program makes solids."""

MODULI: Mapping[str, tuple[Sequence[int], ...]] = {
    "ISO": ((0,),),
    "ORTHO": (range(8), (0,)),
    "ENGINEERING CONSTANTS": ((0, 1, 2, 6, 7), (0,)),
}
"""Places of moduli in the lines of ``*ELASTIC``, by its type; lines repeat for temperatures."""


KEYWORDS: Mapping[str, str] = {
    "material": "ELASTIC",
    "density": "DENSITY",
    "spring": "SPRING",
    "mass": "MASS",
    "section": "SHELL SECTION",
}
"""Keywords that hold the numbers, by the kinds of targets."""


@dataclass(frozen=True)
class Line:
    """A line of a deck, and where it is.

    ``row`` counts the lines of its keyword from 1, and is 0 for the keyword itself and comments.
    """

    text: str
    keyword: str = ""
    elset: str = ""
    type: str = ""
    material: str = ""
    row: int = 0


class Target(NamedTuple):
    """What a parameter multiplies: a kind of `KEYWORDS`, and the material or set of elements."""

    kind: str
    name: str

    def of(self, line: Line) -> str:
        """Return the name that a line has where this one has its own."""
        return line.material if self.kind in ("material", "density") else line.elset

    def columns(self, line: Line) -> Sequence[int]:
        """Return the places of the numbers in a line that it multiplies."""
        where = self.of(line), line.keyword
        if not line.row or where != (self.name.upper(), KEYWORDS[self.kind]):
            return ()
        if self.kind == "material":
            rows = MODULI.get(line.type or "ISO", ())
            return rows[(line.row - 1) % len(rows)] if rows else ()
        return (0,) if self.kind != "spring" or line.row > 1 else ()


# 6 arguments: the deck with its parameters, and options by keyword.
def import_deck(
    deck: Path | str,
    parameters: Mapping[str, str],
    *,
    run: str = "ccx",
    functions: Mapping[str, Sequence[str]] | None = None,
    modes: int | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Imported:
    """Return the model of a CalculiX deck, whose jobs are made and run.

    They are left in a folder beside the deck, ``NAME-jobs``.

    Parameters
    ----------
    deck
        The deck, with a step ``*FREQUENCY``.
    parameters
        Names of the parameters, each with what it multiplies: ``material:STEEL``.
    run
        The program.
    functions
        Terms of a parameter on which the matrices depend, where not those that are usual.
    modes
        Frequencies to compute; a few unless given, none of a large model.
    progress
        Is told in words what is done.

    Raises
    ------
    InputError
        Where the program is not installed or fails, and for names that are not in the deck.
    """
    path, folder = Path(deck), Path(deck).with_name(f"{Path(deck).stem}-jobs")
    program = shutil.which(run)
    if program is None:
        raise InputError(Fault("", "--run", "a program that is installed", f"'{run}'"))
    lines = list(lines_of(path))
    targets = _targets(path, lines, parameters)
    sections = [name for name, target in targets.items() if target.kind == "section"]
    terms = {name: [term.format(name) for term in THICKNESS] for name in sections}
    terms |= {name: list(each) for name, each in (functions or {}).items()}
    factors = {name: list(FACTORS[: len(terms.get(name, (name,)))]) for name in targets}
    jobs = {f"{name}-{factor:g}": {name: factor} for name in targets for factor in factors[name]}
    check = dict(zip(targets, cycle(CHECK), strict=False))
    with writing(folder):
        folder.mkdir(exist_ok=True)
    runs: dict[str, Mapping[str, float]] = {"nominal": {}, **jobs, "check": check}
    for job, values in {**runs, "frequencies": {}}.items():
        progress(f"running {run} {folder / job}")
        of_targets, stored = {targets[name]: x for name, x in values.items()}, job in runs
        text = job_text(path, lines, of_targets, stored=stored)
        _run(program, folder / job, text, ".sti" if stored else ".dat")
    imported = import_model(
        "calculix",
        folder / "nominal",
        {name: [folder / f"{name}-{x:g}" for x in factors[name]] for name in targets},
        factors=factors,
        functions=terms,
        checks=[(folder / "check", check)],
        modes=modes,
        progress=progress,
    )
    computed, printed = imported.frequencies, printed_frequencies(folder / "frequencies.dat")
    if computed is None or not printed.size:
        return imported
    count = min(computed.size, printed.size)
    expected = printed[:count]
    elastic = expected > 1e-3 * expected.max()  # others are those of a rigid body
    error = np.abs(computed[:count][elastic] / expected[elastic] - 1).max(initial=0.0)
    note = f"the first {count} frequencies are those that the program prints, to {error:.0e}"
    if error >= 1e-4:  # as the digits of the program do not explain
        shown = " ".join(f"{x:.5g}" for x in expected)
        of_matrices = f"up to {100 * error:.2g} % from those of its matrices"
        note = f"the program prints {shown} Hz, {of_matrices}"
    return replace(imported, notes=(*imported.notes, note))


def _targets(path: Path, lines: Sequence[Line], parameters: Mapping[str, str]) -> dict[str, Target]:
    """Return what parameters multiply; raises InputError for what is not in the deck."""
    out, faults = {}, []
    for parameter, text in parameters.items():
        kind, _, name = text.partition(":")
        target, place = Target(kind, name), f"--parameter {parameter}"
        if kind not in KEYWORDS or not name:
            expected = f"NAME=WHAT:NAME, WHAT one of {', '.join(KEYWORDS)}"
            faults.append(Fault(str(path), place, expected, repr(text)))
        elif not any(target.columns(line) for line in lines):
            names = {target.of(x) for x in lines if x.keyword == KEYWORDS[kind] and x.row}
            found = suggestion(name, sorted(names - {""}))
            faults.append(Fault(str(path), place, f"a name with *{KEYWORDS[kind]}", found))
        out[parameter] = target
    refuse(faults)
    return out


def lines_of(path: Path, depth: int = 0) -> Iterator[Line]:
    """Yield the lines of a deck and of what it includes; raises InputError where there is none."""
    try:
        texts = text_of(path).splitlines()
    except OSError as error:
        raise InputError(Fault(str(path), "file", "a deck of CalculiX", reason(error))) from None
    line = Line("")
    for text in texts:
        if text.startswith("**"):
            yield Line(text)
        elif text.startswith("*"):
            keyword, options = keyword_of(text)
            material = options.get("NAME", "").upper() if keyword == "MATERIAL" else line.material
            elset, kind = (options.get(x, "").upper() for x in ("ELSET", "TYPE"))
            line = Line(text, keyword, elset, kind, material)
            if keyword == "INCLUDE" and depth < DEEPEST:
                yield from lines_of(path.parent / options.get("INPUT", ""), depth + 1)
            else:
                yield line
        else:
            line = replace(line, text=text, row=line.row + 1)
            yield line


def job_text(
    path: Path, lines: Sequence[Line], factors: Mapping[Target, float], *, stored: bool
) -> str:
    """Return a deck with numbers times factors, which stores matrices or prints frequencies."""
    out, found = [], False
    counted = any(line.keyword == "FREQUENCY" and line.row for line in lines)
    for line in lines:
        items = line.text.split(",")
        if line.keyword == "FREQUENCY" and not line.row:
            ending = ", SOLVER=MATRIXSTORAGE" if stored else "\n10" * (not counted)
            items, found = [f"*FREQUENCY{ending}"], True
        for target, factor in factors.items():
            for k in target.columns(line):
                if k < len(items) and items[k].strip():
                    items[k] = f" {fortran(items[k].strip()) * factor:.12g}"
                    items[k] += "." * bool(re.fullmatch(r" -?\d+", items[k]))
        out.append(",".join(items))
    if not found:
        raise InputError(Fault(str(path), "deck", "a step with *FREQUENCY", "none"))
    return "\n".join(out) + "\n"


def _run(program: str, job: Path, text: str, result: str) -> None:
    """Write a job and run it; raises InputError where it has no result."""
    made = job.with_name(job.name + result)
    made.unlink(missing_ok=True)
    write_text(job.with_name(f"{job.name}.inp"), text)
    try:
        done = subprocess.run(
            [program, job.name], cwd=job.parent, capture_output=True, text=True, errors="replace"
        )
    except OSError as error:
        raise InputError(Fault(program, "--run", "a program that runs", reason(error))) from None
    errors = re.findall(r"\*ERROR[^*]*", done.stdout)
    if errors or not made.is_file() or not made.stat().st_size:
        found = one_line(errors[0] if errors else done.stdout[-400:], 400) or "nothing"
        raise InputError(Fault(str(job), "job", f"a run of {program} that writes {result}", found))


def printed_frequencies(path: Path) -> Floats:
    """Return the frequencies in Hz that the program prints into a ``.dat`` file."""
    head = path.read_text("utf-8", "replace").split("P A R T I C I P A T I O N")[0]
    rows = [line.split() for line in head.splitlines()]
    return np.array([float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()])
