"""Import of jobs of a program as a study; the jobs of a CalculiX deck are made from it, and run.

What a parameter of a deck multiplies, and which jobs there are, is in ``docs/import.md``. The
matrices are linear in moduli, densities, springs and masses. Of a shell the program makes solids:
they have the thickness t in the terms t, 1/t, t² and t³.
"""

import json
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, cycle
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.errors import Fault, InputError, ModelError, reason, refuse, suggestion, writing
from modefront.fem.structure import DIRECTIONS
from modefront.inputs import fortran, wrong
from modefront.models.dofs import write_dofs
from modefront.models.matrices import MatrixModel, matrices
from modefront.models.parameters import exponents_of, form_of
from modefront.outputs import output, write_text
from modefront.programs import PROGRAMS
from modefront.programs.base import Job, JobOptions, Quantity, read_job, write_mesh
from modefront.programs.changes import (
    CHANGES,
    KEPT,
    Change,
    changes,
    deck_text,
    text_of,
    write_changes,
)
from modefront.programs.differences import Differences, Terms, condensed
from modefront.programs.inp import DEEPEST, keyword_of
from modefront.study.file import add_schema
from modefront.text import Shown, file_name, one_line

QUANTITIES: tuple[Quantity, ...] = ("stiffness", "mass")

LARGE, SHOWN = 100_000, 6
"""Degrees of freedom from which on no frequencies are computed unless asked for, and how many
frequencies otherwise."""

Functions = Mapping[str, Sequence[str] | Mapping[Quantity, Sequence[str]]]
JobFiles = Path | str | Sequence[Path | str]  # the job of a parameter, or several


@dataclass(frozen=True, eq=False, repr=False)
class Imported(Shown):
    """Terms, frequencies and remarks of an import.

    Attributes
    ----------
    nominal : the nominal job
    terms : base and terms, internal degrees of freedom being eliminated
    frequencies : (modes,) of the nominal model in Hz; None where they are not computed
    floating : whether the nominal model has rigid-body modes
    errors : error of the terms in each run for checking
    notes : what the program did to the model, and what was done about it
    changes : lines of the nominal deck that the runs change
    program : that made the jobs
    deck : text of the nominal deck; empty where it is not at hand
    """

    nominal: Job
    terms: Terms
    frequencies: Floats | None
    floating: bool
    errors: tuple[float, ...]
    notes: tuple[str, ...]
    changes: tuple[Change, ...] = ()
    program: str = ""
    deck: str = ""

    def write(self, folder: Path | str) -> list[Path]:
        """Write a study with its matrices and schema into a folder that has none; return the files.

        Raises InputError where the folder has a study already, or cannot be written to.
        """
        directory = Path(folder)
        refuse_study(directory)
        with writing(directory):
            directory.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryDirectory(dir=directory, prefix=".import-") as name:
                inner = Path(name)
                write_text(inner / "study.toml", _study(self, inner))
                write_dofs(inner / "dofs.csv", self.terms.dofs)
                if self.nominal.mesh is not None:
                    write_mesh(inner / "mesh.npz", self.nominal.mesh)
                if self.changes:
                    write_changes(inner / CHANGES, self.changes)
                    write_text(inner / f"{KEPT}{self.changes[0].file}", self.deck)
                add_schema([inner / "study.toml"])
                files = sorted(inner.iterdir(), key=lambda file: file.name == "study.toml")
                return [Path(shutil.move(file, directory / file.name)) for file in files]


def refuse_study(folder: Path) -> None:
    """Raise InputError where a folder has a study."""
    if (study := folder / "study.toml").exists():
        raise wrong(study, "a folder without a study, as nothing is overwritten", "an existing one")


# 9 arguments and many lines: the jobs, and each option of the command by keyword, in turn.
def import_model(
    program: str,
    base: Path | str,
    parameters: Mapping[str, JobFiles],
    *,
    factors: Mapping[str, float | Sequence[float]] | None = None,
    functions: Functions | None = None,
    checks: Sequence[tuple[Path | str, Mapping[str, float]]] = (),
    options: JobOptions | None = None,
    modes: int | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Imported:
    """Return the model that jobs of a finite-element program determine.

    Parameters
    ----------
    program
        ``calculix``, ``abaqus``, ``nastran``, ``ansys`` or ``opensees``.
    base
        The job at the nominal values.
    parameters
        Names of the parameters, each with the job, or jobs, in which it alone has another value.
    factors
        This value over the nominal one, for each job of the parameter; 2 unless given.
    functions
        Terms of a parameter on which the matrices depend, where not linearly: ``["t", "t^3"]``;
        or those of each, ``{"stiffness": ["E*t", "E*t^3"], "mass": ["t"]}``.
    checks
        Further jobs with the factors of parameters in them, which are compared with the terms.
    options
        What holds for all jobs.
    modes
        Frequencies to compute; a few unless given, none of a large model.
    progress
        Is told in words what is done.

    Raises
    ------
    InputError
        For jobs that cannot be read, do not belong together, or are not affine.
    """
    if program not in PROGRAMS:
        found = suggestion(program, list(PROGRAMS))
        raise InputError(Fault("", "program", f"one of {', '.join(PROGRAMS)}", found))

    nominal_path, options, names = Path(base), options or JobOptions(), tuple(parameters)
    declared = {x: _terms_of(names, functions or {}, x).values() for x in QUANTITIES}
    terms = {x: list(dict.fromkeys(chain(*each))) for x, each in declared.items()}
    runs = _runs(parameters, factors or {}, checks)

    def read(path: Path, doing: str = "reading") -> Job:
        progress(f"{doing} {path}")
        return read_job(program, path, options)

    nominal, errors = read(nominal_path), []
    differences = Differences(nominal, names, terms)
    for _, path, theta in runs:
        differences.add(str(path), read(path), theta)
    identified = differences.terms()
    for other, given in checks:
        theta = np.array([given.get(name, 1.0) for name in names])
        job = read(Path(other), "checking with")
        errors.append(differences.check(identified, str(other), job, theta))
    notes = list(nominal.notes)
    if program == "abaqus":  # nodes that others make move with the model, or are not told
        identified, gone, stayed = condensed(identified)
        what = "degrees of freedom of the program"
        notes += [f"{gone} massless {what} are eliminated exactly"] * (gone > 0)
        if stayed:
            notes.append(
                f"{stayed} {what} are kept, without nodes: they have mass, or several terms act on "
                "them, so that to eliminate them were not exact"
            )
    frequencies, floating = _frequencies(identified, modes, notes, progress)
    changed: dict[str, list[Change]] = {}  # by the first run of each parameter
    for name, path, theta in runs:
        factor = float(theta[theta != 1][0])
        of_run, differs = changes(name, nominal_path, path, factor)
        changed.setdefault(name, of_run)
        if differs:
            by, line = differs
            notes.append(
                f"{name}: the decks differ by a factor of {by:g} (line {line}), but the run is "
                f"taken for {factor:g} times the nominal value: is --factor {name}={by:g} meant?"
            )
    return Imported(
        nominal,
        identified,
        frequencies,
        floating,
        tuple(errors),
        tuple(notes),
        tuple(chain(*changed.values())),
        program,
        deck_text(nominal_path),
    )


def _terms_of(
    names: Sequence[str], functions: Functions, quantity: Quantity
) -> dict[str, Sequence[str]]:
    """Return the terms of each parameter in a matrix: those declared, or the parameter itself."""
    faults: list[Fault] = []
    out: dict[str, Sequence[str]] = {name: (name,) for name in names}
    for name, each in functions.items():
        if name not in names:
            faults.append(Fault("", "--function", "a parameter", suggestion(name, names)))
        of = each if isinstance(each, Mapping) else dict.fromkeys(QUANTITIES, each)
        for key in (key for key in of if key not in QUANTITIES):
            found = suggestion(key, QUANTITIES)
            faults.append(Fault("", f"functions '{name}'", " or ".join(QUANTITIES), found))
        out[name] = of.get(quantity, (name,))
        for term in out[name]:
            exponents, place = exponents_of(term, names), f"--function {name}"
            if exponents is None or not exponents.any():
                faults.append(Fault("", place, form_of(term + "^"), repr(term)))
            elif name in names and not exponents[names.index(name)]:
                faults.append(Fault("", place, f"terms with '{name}'", repr(term)))
    refuse(faults)
    return out


def _runs(
    parameters: Mapping[str, JobFiles],
    factors: Mapping[str, float | Sequence[float]],
    checks: Sequence[tuple[Path | str, Mapping[str, float]]],
) -> list[tuple[str, Path, Floats]]:
    """Return parameter, job and values of all parameters of every run."""
    out, named = [], [*(("--factor", name) for name in factors)]
    named += [("--check", name) for _, values in checks for name in values]
    faults = [
        Fault("", option, "a parameter", suggestion(name, parameters))
        for option, name in named
        if name not in parameters
    ]
    for k, (name, jobs) in enumerate(parameters.items()):
        paths, place = [jobs] if isinstance(jobs, str | Path) else list(jobs), f"--factor {name}"
        given = np.ravel(factors.get(name, []))
        values = given if given.size else np.full(int(len(paths) == 1), 2.0)
        faults += [
            Fault("", place, "a factor above 0, and not 1", f"{factor:g}")
            for factor in given.tolist()
            if not 0 < factor < np.inf or factor == 1
        ]
        if len(values) != len(paths):
            expected = f"{len(paths)} factors, one for each of its runs"
            faults.append(Fault("", place, expected, str(given.size)))
        thetas = np.where(np.arange(len(parameters)) == k, values[:, None], 1.0)
        out += [(name, Path(path), theta) for path, theta in zip(paths, thetas, strict=False)]
    refuse(faults)
    return out


def model_of(terms: Terms) -> MatrixModel:
    """Return the model of terms, without sensors that mean anything."""
    K, M = (terms.matrices[x] for x in QUANTITIES)
    return matrices(terms.parameters, K, M, {"first": 0}, floating=True)


def _frequencies(
    terms: Terms, modes: int | None, notes: list[str], progress: Callable[[str], None]
) -> tuple[Floats | None, bool]:
    """Return frequencies in Hz, None where they are not wanted, and whether the model floats."""
    size = terms.dofs.size
    if modes == 0 or (modes is None and size > LARGE):
        notes.append("frequencies are not computed (--modes computes them)")
        return None, False
    if not (mass := terms.matrices["mass"]):
        raise InputError(Fault("", "mass", "a mass matrix that is not zero", "only zeros"))
    progress("computing the frequencies of the nominal model")
    model = model_of(terms)
    if massless := int((sum(A.diagonal() for A in mass.values()) == 0).sum()):
        notes.append(f"{massless} degrees of freedom have no mass, which is allowed")
    count = max(min(modes or SHOWN, size - massless), 1)
    try:
        lowest = model.full_modes(np.ones(len(terms.parameters)), count)
    except ModelError as error:
        fault = Fault("", "the nominal model", "matrices with modes", str(error))
        raise InputError(fault) from None
    frequencies = np.sqrt(np.maximum(lowest.lam, 0.0)) / (2 * np.pi)
    if floating := int((lowest.lam == 0).sum()):
        notes.append(f"{floating} rigid-body modes or mechanisms: floating = true is written")
    return frequencies, floating > 0


def _study(imported: Imported, folder: Path) -> str:
    """Return the study, of which the matrices are written into a folder."""
    dofs, quantities = imported.terms.dofs, []
    nodes = dofs.node[dofs.node > 0]
    quoted = partial(json.dumps, ensure_ascii=False)  # TOML has texts as JSON has them
    for quantity in QUANTITIES:
        files: dict[str, str] = {}
        for name, A in imported.terms.matrices[quantity].items():
            files[name] = file_name(f"{quantity}-{name}", files.values())
            with output(folder / f"{files[name]}.npz") as stream:
                scipy.sparse.save_npz(stream, A, compressed=False)
        pairs = (f"{quoted(name)} = {quoted(f'{file}.npz')}" for name, file in files.items())
        quantities.append(f"{quantity} = {{ {', '.join(pairs)} }}")
    lines = [
        f"# Imported from {imported.program}: {Path(imported.nominal.name).name}. "
        "Parameters are factors of the nominal values.",
        *(f"# - {' '.join(note.split())}" for note in imported.notes),
        f"\n[study]\nname = {quoted(Path(imported.nominal.name).stem)}",
        "\n# What is left to you: measured modes, and where the sensors are.",
        '# [data]\n# file = "modes.csv"\n#\n# [model.sensors]',
        f'# a = {{ node = {int(nodes[-1]) if nodes.size else 12}, direction = "z" }}',
        '\n[model]\nkind = "matrices"\ndofs = "dofs.csv"',
        *(['mesh = "mesh.npz"'] if imported.nominal.mesh is not None else []),
        *(["floating = true"] if imported.floating else []),
        *quantities,
    ]
    if used := [d for d in DIRECTIONS[:3] if dofs.of_direction(d)]:
        base = ", ".join(f'{d} = {{ direction = "{d}" }}' for d in used)
        lines.append(f"base = {{ {base} }}")
    for name in imported.terms.parameters:
        lines.append(f"\n[[parameter]]\nname = {quoted(name)}\nnominal = 1.0\nbounds = [0.5, 2.0]")
    groups = {"frequencies": "frequency", "shapes": "shape"}
    lines += [f'\n[[group]]\nname = "{x}"\n{what} = "all"' for x, what in groups.items()]
    return "\n".join(lines) + "\n"


FACTORS, CHECK = (2.0, 0.5, 1.5, 0.75), (1.5, 0.7, 1.3, 0.8)
"""Factors of a parameter in its jobs, as many as it has terms, and of the parameters in turn in the
job with which the terms are compared."""

THICKNESS = ("*{}", "/{}", "*{}^2", "*{}^3")
"""What the thickness of a shell, of which the program makes solids, multiplies its matrices by."""

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


OF_MATERIAL: Mapping[Quantity, str] = {"stiffness": "material", "mass": "density"}
"""Kinds of targets that multiply the matrices of all elements of a material."""


@dataclass(frozen=True)
class Line:
    """A line of a deck, and where it is.

    ``row`` counts the lines of its keyword from 1, and is 0 for the keyword itself and comments;
    ``number`` is that in the deck, 0 in what it includes.
    """

    text: str
    keyword: str = ""
    elset: str = ""
    type: str = ""
    material: str = ""
    row: int = 0
    number: int = 0


class Target(NamedTuple):
    """What a parameter multiplies: a kind of `KEYWORDS`, and the material or set of elements."""

    kind: str
    name: str

    def of(self, line: Line) -> str:
        """Return the name that a line has where this one has its own."""
        return line.material if self.kind in OF_MATERIAL.values() else line.elset

    def columns(self, line: Line) -> Sequence[int]:
        """Return the places of the numbers in a line that it multiplies."""
        where = self.of(line), line.keyword
        if not line.row or where != (self.name.upper(), KEYWORDS[self.kind]):
            return ()
        if self.kind == "material":
            rows = MODULI.get(line.type or "ISO", ())
            return rows[(line.row - 1) % len(rows)] if rows else ()
        return (0,) if self.kind != "spring" or line.row > 1 else ()


# 6 arguments and many lines: the deck with its parameters, options by keyword, and jobs in turn.
def import_deck(
    deck: Path | str,
    parameters: Mapping[str, str],
    *,
    run: str = "ccx",
    functions: Functions | None = None,
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
    terms: Functions = {**_of_thickness(lines, targets), **(functions or {})}
    in_terms = [_terms_of(tuple(targets), terms, quantity) for quantity in QUANTITIES]
    factors = {name: FACTORS[: max(len(x[name]) for x in in_terms)] for name in targets}
    jobs = {f"{name}-{factor:g}": {name: factor} for name in targets for factor in factors[name]}
    check = dict(zip(targets, cycle(CHECK), strict=False))
    with writing(folder):
        folder.mkdir(exist_ok=True)
    for job, values in {"nominal": {}, **jobs, "check": check, "frequencies": {}}.items():
        progress(f"running {run} {folder / job}")
        of_targets, stored = {targets[x]: y for x, y in values.items()}, job != "frequencies"
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
    # The deck as it is; with what it includes in its place where a change is in that.
    own, text = {k: line.number for k, line in enumerate(lines, 1)}, text_of(path)
    if not all(own[change.line] for change in imported.changes):
        own, text = {k: k for k in own}, "".join(f"{line.text}\n" for line in lines)
    imported = replace(
        imported,
        nominal=replace(imported.nominal, name=str(path)),
        changes=tuple(replace(x, file=path.name, line=own[x.line]) for x in imported.changes),
        deck=text,
    )
    computed, printed = imported.frequencies, printed_frequencies(folder / "frequencies.dat")
    if computed is None or not printed.size:
        return imported
    computed, printed = (x[: min(computed.size, printed.size)] for x in (computed, printed))
    elastic = printed > 1e-3 * printed.max()  # others are those of a rigid body
    error = np.abs(computed[elastic] / printed[elastic] - 1).max(initial=0.0)
    note = f"the first {len(printed)} frequencies are those that the program prints, to {error:.0e}"
    if error >= 1e-4:  # as the digits of the program do not explain
        said = f"the program prints {' '.join(f'{x:.5g}' for x in printed)} Hz"
        note = f"{said}, up to {100 * error:.2g} % from those of its matrices"
    return replace(imported, notes=(*imported.notes, note))


def _of_thickness(
    lines: Sequence[Line], targets: Mapping[str, Target]
) -> dict[str, dict[Quantity, list[str]]]:
    """Return the terms of thicknesses in either matrix, with the parameter of their material."""
    names = {(each.kind, each.name.upper()): name for name, each in targets.items()}
    out: dict[str, dict[Quantity, list[str]]] = {}
    for name in (name for name, target in targets.items() if target.kind == "section"):
        material = next(line.material for line in lines if targets[name].columns(line))
        out[name] = {
            quantity: [
                f"{names.get((kind, material), '1')}{term.format(name)}".removeprefix("1*")
                for term in THICKNESS
            ]
            for quantity, kind in OF_MATERIAL.items()
        }
    return out


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
            names = {target.of(x) for x in lines if x.keyword == KEYWORDS[kind] and x.row} - {""}
            expected = f"a name with *{KEYWORDS[kind]}"
            faults.append(Fault(str(path), place, expected, suggestion(name, sorted(names))))
        out[parameter] = target
    refuse(faults)
    return out


def lines_of(path: Path, depth: int = 0) -> Iterator[Line]:
    """Yield the lines of a deck and of what it includes; raises InputError where there is none."""
    try:
        texts = text_of(path).splitlines()
    except OSError as error:
        raise wrong(path, "a deck of CalculiX", reason(error)) from None
    line = Line("")
    for k, text in enumerate(texts, start=1):
        number = 0 if depth else k
        if text.startswith("**"):
            yield Line(text, number=number)
        elif text.startswith("*"):
            keyword, options = keyword_of(text)
            material = options.get("MATERIAL", line.material).upper()
            material = options.get("NAME", "").upper() if keyword == "MATERIAL" else material
            elset, kind = (options.get(x, "").upper() for x in ("ELSET", "TYPE"))
            line = Line(text, keyword, elset, kind, material, number=number)
            if keyword == "INCLUDE" and depth < DEEPEST:
                yield from lines_of(path.parent / options.get("INPUT", ""), depth + 1)
            else:
                yield line
        else:
            line = replace(line, text=text, row=line.row + 1, number=number)
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
            for k in (k for k in target.columns(line) if k < len(items) and items[k].strip()):
                number = f" {fortran(items[k].strip()) * factor:.12g}"
                items[k] = re.sub(r"^( -?\d+)(e|$)", r"\1.\2", number)  # ccx wants a point
        out.append(",".join(items))
    if not found:
        raise wrong(path, "a step with *FREQUENCY", "none", "deck")
    return "\n".join(out) + "\n"


def _run(program: str, job: Path, text: str, result: str) -> None:
    made = job.with_name(job.name + result)
    made.unlink(missing_ok=True)
    write_text(job.with_name(f"{job.name}.inp"), text)
    try:
        done = subprocess.run(
            [program, job.name], cwd=job.parent, capture_output=True, text=True, errors="replace"
        )
    except OSError as error:
        raise InputError(Fault(program, "--run", "a program that runs", reason(error))) from None
    errors = done.stdout.split("*ERROR", 2)[1:]
    if errors or not made.is_file() or not made.stat().st_size:
        found = one_line(errors[0] if errors else done.stdout[-400:], 400) or "nothing"
        raise wrong(job, f"a run of {program} that writes {result}", found, "job")


def printed_frequencies(path: Path) -> Floats:
    """Return the frequencies in Hz that the program prints into a ``.dat`` file."""
    head = path.read_text("utf-8", "replace").split("P A R T I C I P A T I O N")[0]
    rows = [line.split() for line in head.splitlines()]
    return np.array([float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()])
