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
from typing import Any

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.errors import Fault, InputError, ModelError, refuse, refusing, suggestion, writing
from modefront.fem.structure import DIRECTIONS
from modefront.inputs import wrong
from modefront.models.dofs import name_of, write_dofs
from modefront.models.matrices import MatrixModel, matrices
from modefront.models.parameters import BASE, exponents_of, form_of
from modefront.outputs import output, write_text
from modefront.programs import PROGRAMS
from modefront.programs import changes as decks
from modefront.programs.base import Job, JobOptions, Quantity, read_job, write_mesh
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
    changes: tuple[decks.Change, ...] = ()
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
                    decks.write_changes(inner / decks.CHANGES, self.changes)
                    write_text(inner / f"{decks.KEPT}{self.changes[0].file}", self.deck)
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
    declared = _terms_of(names, functions or {})
    terms = {x: list(dict.fromkeys(chain(*each.values()))) for x, each in declared.items()}
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
    changed: dict[str, list[decks.Change]] = {}  # by the first run of each parameter
    for name, path, theta in runs:
        factor = float(theta[theta != 1][0])
        of_run, differs = decks.changes(name, nominal_path, path, factor)
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
        decks.deck_text(nominal_path),
    )


def _terms_of(names: Sequence[str], given: Functions) -> dict[Quantity, dict[str, Sequence[str]]]:
    """Return the terms of each parameter in either matrix: those declared, or itself."""
    expected = "another name, as this is that of the term without parameters"
    faults = [Fault("", f"--parameter {BASE}", expected, f"'{BASE}'")] * (BASE in names)
    out: dict[Any, dict[str, Sequence[str]]] = {x: {y: (y,) for y in names} for x in QUANTITIES}
    for name, each in given.items():
        if name not in names:
            faults.append(Fault("", "--function", "a parameter", suggestion(name, names)))
        of = each if isinstance(each, Mapping) else dict.fromkeys(QUANTITIES, each)
        for quantity, terms in of.items():
            if quantity not in out:
                found = suggestion(quantity, QUANTITIES)
                faults.append(Fault("", f"functions '{name}'", " or ".join(QUANTITIES), found))
                continue
            out[quantity][name] = terms
            for term in terms:
                exponents, place = exponents_of(term, names), f"--function {name}"
                if exponents is None or not exponents.any():
                    faults.append(Fault("", place, form_of(term + "^"), repr(term)))
                elif name in names and not exponents[names.index(name)]:
                    faults.append(Fault("", place, f"terms with '{name}'", repr(term)))
    refuse(dict.fromkeys(faults))
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
    with refusing("", "matrices with modes", ModelError, place="the nominal model"):
        lowest = model.full_modes(np.ones(len(terms.parameters)), count)
    frequencies = np.sqrt(np.maximum(lowest.lam, 0.0)) / (2 * np.pi)
    if floating := int((lowest.lam == 0).sum()):
        notes.append(f"{floating} rigid-body modes or mechanisms: floating = true is written")
    return frequencies, floating > 0


def _study(imported: Imported, folder: Path) -> str:
    """Return the study, of which the matrices are written into a folder."""
    dofs, quantities = imported.terms.dofs, []
    moving = (dofs.node > 0) & (dofs.weight != 0) & np.isin(dofs.direction, (1, 2, 3))
    last = np.flatnonzero(moving)[-1:]
    node, k = next(zip(dofs.node[last], dofs.direction[last], strict=True), (12, 3))
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
        f'# a = {{ node = {node}, direction = "{name_of(int(k))}" }}',
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

TARGETS: Mapping[str, tuple[str, str]] = {
    "material": ("ELASTIC", "MATERIAL"),
    "density": ("DENSITY", "MATERIAL"),
    "spring": ("SPRING", "ELSET"),
    "mass": ("MASS", "ELSET"),
    "section": ("SHELL SECTION", "ELSET"),
}
"""What a parameter may multiply: the keyword of its numbers, and the option that names it."""

OF_MATERIAL: Mapping[Quantity, str] = {"stiffness": "material", "mass": "density"}
"""Kinds of targets that multiply the matrices of all elements of a material."""

STEP = re.compile(r"^\*\s*FREQUENCY\s*(?:,.*)?$(?=(?:\n\*\*.*)*(\n(?!\*).)?)", re.M | re.I)
"""The line of a keyword *FREQUENCY, and whether a line that is none of a keyword is behind it."""

Lines = Sequence[tuple[str, int]]  # of a deck and of what it includes: text and number


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
    lines, names = list(lines_of(path)), tuple(parameters)
    multiplied, materials = targets_of(path, lines, parameters)
    terms: Functions = {**_of_thickness(parameters, materials), **(functions or {})}
    in_terms = _terms_of(names, terms).values()
    factors = {name: FACTORS[: max(len(x[name]) for x in in_terms)] for name in names}
    jobs = {f"{name}-{factor:g}": {name: factor} for name in names for factor in factors[name]}
    check = dict(zip(names, cycle(CHECK), strict=False))
    with writing(folder):
        folder.mkdir(exist_ok=True)
    for job, values in {"nominal": {}, **jobs, "check": check, "frequencies": {}}.items():
        progress(f"running {run} {folder / job}")
        stored = job != "frequencies"
        text = job_text(path, lines, multiplied, values, stored=stored)
        _run(program, folder / job, text, ".sti" if stored else ".dat")
    imported = import_model(
        "calculix",
        folder / "nominal",
        {name: [folder / f"{name}-{x:g}" for x in factors[name]] for name in names},
        factors=factors,
        functions=terms,
        checks=[(folder / "check", check)],
        modes=modes,
        progress=progress,
    )
    own, text = [replace(x, line=lines[x.line - 1][1]) for x in multiplied], decks.text_of(path)
    if not all(change.line for change in own):  # what the deck includes is kept in its place
        own, text = multiplied, "".join(f"{line}\n" for line, _ in lines)
    nominal = replace(imported.nominal, name=str(path))
    imported = replace(imported, nominal=nominal, changes=tuple(own), deck=text)
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
        if error >= 1e-3 and any(x.startswith("section:") for x in parameters.values()):
            note += ": shells so thin lose digits by section:NAME, and keep them by material:NAME"
    return replace(imported, notes=(*imported.notes, note))


def _of_thickness(
    parameters: Mapping[str, str], materials: Mapping[str, str]
) -> dict[str, dict[Quantity, list[str]]]:
    """Return the terms of thicknesses in either matrix, with the parameter of their material."""
    names = {text.upper(): name for name, text in parameters.items()}
    out: dict[str, dict[Quantity, list[str]]] = {name: {} for name in materials}
    for name, material in materials.items():
        for quantity, kind in OF_MATERIAL.items():
            factor = names.get(f"{kind}:{material}".upper(), "1")
            terms = [f"{factor}{term.format(name)}" for term in THICKNESS]
            out[name][quantity] = [term.removeprefix("1*") for term in terms]
    return out


def targets_of(
    path: Path, lines: Lines, parameters: Mapping[str, str]
) -> tuple[list[decks.Change], dict[str, str]]:
    """Return the lines, from 1, of which parameters multiply numbers, and materials by thicknesses.

    Raises InputError for what is not in the deck.
    """
    known: dict[str, dict[str, list[decks.Change]]] = {kind: {} for kind in TARGETS}
    options, of_shells, keyword, row = {"MATERIAL": ""}, dict[str, str](), "", 0
    for k, (text, _) in enumerate(lines, start=1):
        if text.startswith("*"):
            if not text.startswith("**"):
                material, (keyword, options) = options["MATERIAL"], keyword_of(text.upper())
                named = options.get("NAME", "") if keyword == "MATERIAL" else material
                options.setdefault("MATERIAL", named)
                row = 0
            continue
        row += 1
        for kind, (of, option) in TARGETS.items():
            if of == keyword and (spans := _spans(kind, options.get("TYPE", "ISO"), row, text)):
                changes = known[kind].setdefault(options.get(option, ""), [])
                changes.append(decks.Change("", path.name, k, text, spans))
        if keyword == "SHELL SECTION":
            of_shells[options.get("ELSET", "")] = options["MATERIAL"]
    out, materials, faults = list[decks.Change](), dict[str, str](), list[Fault]()
    for parameter, text in parameters.items():
        kind, _, name = text.partition(":")
        if kind not in TARGETS or not name:
            expected, found = f"NAME=WHAT:NAME, WHAT one of {', '.join(TARGETS)}", repr(text)
        elif name.upper() in known[kind]:
            out += [replace(x, parameter=parameter) for x in known[kind][name.upper()]]
            materials |= {parameter: of_shells[name.upper()]} if kind == "section" else {}
            continue
        else:
            expected = f"a name with *{TARGETS[kind][0]}"
            found = suggestion(name, sorted({*known[kind]} - {""}))
        faults.append(Fault(str(path), f"--parameter {parameter}", expected, found))
    refuse(faults)
    return out, materials


def _spans(kind: str, elastic: str, row: int, text: str) -> tuple[tuple[int, int], ...]:
    """Return the ends of the numbers that a parameter multiplies in a line behind its keyword."""
    columns: Sequence[int] = (0,) if kind != "spring" or row > 1 else ()
    if kind == "material":
        rows = MODULI.get(elastic, ((),))
        columns = rows[(row - 1) % len(rows)]
    parts = re.finditer(r"([^,]*)(?:,|$)", text)
    found = [decks.NUMBER.search(text, *part.span(1)) for part in parts]
    return tuple(x.span() for k in columns if k < len(found) and (x := found[k]))


def lines_of(path: Path, depth: int = 0) -> Iterator[tuple[str, int]]:
    """Yield the lines of a deck and of what it includes, with their numbers, 0 in what it includes.

    Raises InputError where there is none.
    """
    with refusing(path, "a deck of CalculiX", OSError):
        texts = decks.text_of(path).splitlines()
    for k, text in enumerate(texts, start=1):
        keyword, options = keyword_of(text)
        if text.startswith("*") and keyword == "INCLUDE" and depth < DEEPEST:
            yield from lines_of(path.parent / options.get("INPUT", ""), depth + 1)
        else:
            yield text, 0 if depth else k


def job_text(
    path: Path,
    lines: Lines,
    multiplied: Sequence[decks.Change],
    factors: Mapping[str, float],
    *,
    stored: bool,
) -> str:
    """Return a deck with numbers times factors, which stores matrices or prints frequencies."""
    out = {k: text for k, (text, _) in enumerate(lines, start=1)}
    out |= decks.times(out, [x for x in multiplied if x.parameter in factors], factors, digits=12)
    ending = ", SOLVER=MATRIXSTORAGE" if stored else ""
    text, steps = STEP.subn(
        lambda step: f"*FREQUENCY{ending}" + "\n10" * (not stored and not step[1]),
        "\n".join(out.values()) + "\n",
    )
    if not steps:
        raise wrong(path, "a step with *FREQUENCY", "none", "deck")
    return text


def _run(program: str, job: Path, text: str, result: str) -> None:
    made = job.with_name(job.name + result)
    made.unlink(missing_ok=True)
    write_text(job.with_name(f"{job.name}.inp"), text)
    with refusing(program, "a program that runs", OSError, place="--run"):
        done = subprocess.run(
            [program, job.name], cwd=job.parent, capture_output=True, text=True, errors="replace"
        )
    errors = done.stdout.split("*ERROR", 2)[1:]
    if errors or not made.is_file() or not made.stat().st_size:
        found = one_line(errors[0] if errors else done.stdout[-400:], 400) or "nothing"
        raise wrong(job, f"a run of {program} that writes {result}", found, "job")


def printed_frequencies(path: Path) -> Floats:
    """Return the frequencies in Hz that the program prints into a ``.dat`` file."""
    head = path.read_text("utf-8", "replace").split("P A R T I C I P A T I O N")[0]
    rows = [line.split() for line in head.splitlines()]
    return np.array([float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()])
