"""Lines that differ between the decks of runs: their numbers are a factor times the nominal ones.

From it, updated values can be written as lines of the deck.
"""

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from modefront.errors import refusing
from modefront.inputs import file_size, fortran
from modefront.outputs import write_text

NUMBER = re.compile(r"(?<![\w.])[+-]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d+|[+-]\d+)?(?![\w.])")
"""A number in a deck."""

COMMENTS = ("**", "$", "!", "#")  # how these begin, in one program or another

SUFFIXES = (".inp", ".dat", ".bdf", ".nas", ".mac", ".py", ".tcl")
FIELDS = (".dat", ".bdf", ".nas")  # of Nastran, whose lines without commas have fields of 8 columns
CHANGES, KEPT = "changes.json", "deck-"
"""File of the changes in the folder of a study, and beginning of the name of the nominal deck."""


@dataclass(frozen=True)
class Change:
    """A line of the nominal deck that a run changes."""

    parameter: str  # name
    file: str  # the nominal deck
    line: int  # number from 1
    text: str  # the line
    spans: tuple[tuple[int, int], ...]  # ends of each number that the factor multiplies

    def updated(self, factor: float) -> str:
        """Return the line with its numbers times a factor."""
        return times({self.line: self.text}, [self], {self.parameter: factor})[self.line]


def times(
    lines: Mapping[int, str], changes: Iterable[Change], theta: Mapping[str, float], digits: int = 9
) -> dict[int, str]:
    """Return the changed lines, by their numbers, with their numbers times the parameters."""
    factors: dict[int, dict[tuple[int, int, int], float]] = {}
    for each in changes:
        line = factors.setdefault(each.line, {})
        places = [_field(each, *span) for span in each.spans]
        line |= {place: line.get(place, 1.0) * theta[each.parameter] for place in places}
    out = {k: lines[k] for k in factors}
    for k, text in out.items():
        for (first, last, width), factor in sorted(factors[k].items(), reverse=True):
            number = _number(fortran(lines[k][first:last]) * factor, digits, width)
            text = f"{text[:first]}{number}{text[last:]}"
        out[k] = text
    return out


def _field(change: Change, first: int, last: int) -> tuple[int, int, int]:
    """Return where a number is replaced, and how wide the other one is to be; 0 for any width."""
    text, width = change.text, 16 if "*" in change.text[:8] else 8
    begin = 8 + (first - 8) // width * width
    is_free = "," in text or Path(change.file).suffix.lower() not in FIELDS
    if is_free or begin < 8 or last > begin + width or text[begin:first].strip():
        return first, last, 0
    return begin, min(begin + width, len(text)), width


def _number(value: float, digits: int, width: int) -> str:
    """Return a number; in a field of a ``width`` with as many digits as it has room for."""
    mantissa, e, exponent = f"{value:.{digits}g}".partition("e")
    # Some programs take a number without a decimal point for an integer.
    mantissa += "" if "." in mantissa else "."
    if not width:
        return f"{mantissa}{e}{exponent}"
    out = f"{mantissa}{int(exponent):+}" if e else mantissa
    return out.rjust(width) if len(out) <= width else _number(value, digits - 1, width)


def changes(
    parameter: str, nominal: Path, run: Path, factor: float
) -> tuple[list[Change], tuple[float, int] | None]:
    """Return the lines in which a run multiplies numbers of the nominal deck by a factor.

    None where other numbers change too. If all have another factor, this and a line of it are
    returned as well.
    """
    deck, lines = _deck(nominal), [deck_text(job).splitlines() for job in (nominal, run)]
    if not deck or len(lines[0]) != len(lines[1]):
        return [], None
    out, found, whole = list[Change](), dict[float, int](), True
    for number, (old, new) in enumerate(zip(*lines, strict=True), start=1):
        if old == new:
            continue
        spans, factors = _changed(old, new)
        of_factor = all(abs(x / factor - 1) <= 1e-6 for x in factors)
        if spans and of_factor:
            out.append(Change(parameter, deck.name, number, old, tuple(spans)))
        if not old.lstrip().startswith(COMMENTS):
            whole &= of_factor or not spans
            for x in factors:
                found.setdefault(float(f"{x:.6g}"), number)
    value, line = next(iter(found.items()), (0.0, 0))
    is_other = len(found) == 1 and value > 0 and abs(value / factor - 1) >= 1e-5
    return out if whole else [], (value, line) if is_other else None


def deck_text(job: Path) -> str:
    """Return the deck of a job; empty where there is none."""
    return text_of(deck) if (deck := _deck(job)) else ""


def text_of(deck: Path) -> str:
    """Return the text of a deck, with its own ends of lines.

    Bytes that are no UTF-8, such as those of comments in Latin-1, stay as they are when written.
    """
    return deck.read_bytes().decode("utf-8", "surrogateescape")


def write_deck(study: Path, theta: Mapping[str, float], folder: Path) -> str:
    """Write the deck of a study with updated values: that which its folder keeps, or the job's own.

    It is left out where one is no parameter, or a parameter has no lines, and where it is not there
    as it was imported: what was not written, and why, is returned, else nothing.
    """
    changes = read_changes(study / CHANGES) if (study / CHANGES).is_file() else []
    decks = [study / f"{beginning}{each.file}" for each in changes[:1] for beginning in (KEPT, "")]
    kept = next((path for path in decks if path.is_file()), None)
    known = {each.parameter for each in changes}
    if kept is None or known - set(theta):
        return ""
    if unknown := [name for name in theta if name not in known]:
        return f"{changes[0].file}: which numbers belong to {', '.join(unknown)} is not known"
    lines = dict(enumerate(text_of(kept).splitlines(keepends=True), start=1))
    for each in changes:
        if lines.get(each.line, "").splitlines() != [each.text]:
            return f"{each.file}: line {each.line} of {kept} is not as it was imported: {each.text}"
    lines |= times(lines, changes, theta)
    write_text(folder / changes[0].file, "".join(lines.values()))
    return ""


def _deck(path: Path) -> Path | None:
    stems = (path, path.with_suffix(""))  # names of jobs may have a point
    files = (*(stem.with_name(stem.name + x) for stem in stems for x in SUFFIXES), path)
    decks = (x for x in files if x.suffix.lower() in SUFFIXES and x.is_file())
    return next((x for x in decks if x.stat().st_size < 2**26), None)


def _changed(old: str, new: str) -> tuple[list[tuple[int, int]], list[float]]:
    """Return where numbers of a line are others, and their factors, 0 where there is none.

    There is one factor of 0, and no place, where anything else is different.
    """
    before, after = list(NUMBER.finditer(old)), list(NUMBER.finditer(new))
    rest = ["".join(NUMBER.sub("#", text).split()) for text in (old, new)]
    if len(before) != len(after) or rest[0] != rest[1]:
        return [], [0.0]
    pairs = [(a.span(), fortran(a[0]), fortran(b[0])) for a, b in zip(before, after, strict=True)]
    others = [(span, y / x if x else 0.0) for span, x, y in pairs if x != y]
    return [span for span, _ in others], [factor for _, factor in others]


def write_changes(path: Path, changes: Sequence[Change]) -> None:
    """Write changes as JSON."""
    write_text(path, json.dumps([asdict(each) for each in changes], indent=1) + "\n")


def read_changes(path: Path) -> list[Change]:
    """Return the changes in a file; raises InputError for any other file."""
    file_size(path, expected := "changes of a deck")
    with refusing(path, expected, OSError, ValueError, TypeError, KeyError):
        listed = json.loads(path.read_text(encoding="utf-8"))
        for each in listed:
            each["spans"] = tuple((int(a), int(b)) for a, b in each["spans"])
        return [Change(**each) for each in listed]
