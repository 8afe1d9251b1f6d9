"""Findings of a check as tables and sentences of 80 columns."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

import numpy as np
from rich.console import Console
from rich.table import Table

from modefront.cli.layout import Screen
from modefront.cli.tables import safe, table
from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.measured import comac
from modefront.diagnosis.sensitivity import Sensitivities
from modefront.findings.knowledge import enumeration
from modefront.results.remarks import MOST, digest
from modefront.study.check import Findings, spoils
from modefront.study.definition import Study

WIDTH = 80
"""Characters of a line."""

NAME = 22
"""Longest name that a table shows in full."""

ACROSS = 7
"""Modes side by side in the table of sensitivities."""

ROWS = 12
"""Sensors and parameters that tables show, at most, unless all are asked for."""


def print_findings(study: Study, findings: Findings, *, every: bool = False) -> None:
    """Print what a check found, with the ten first findings or ``every`` one."""
    output = Screen(Console(highlight=False, width=WIDTH))
    screen, problem = output.console, study.problem
    _say(output, f"{study.file}: {study.name}")
    _say(
        output,
        f"  {problem.model.size} degrees of freedom, {len(study.parameters)} parameters, "
        f"{len(problem.data.modes)} measured modes at {len(problem.data.sensors)} sensors "
        f"in {len(problem.data.sets)} data set{'s' * (len(problem.data.sets) > 1)}",
    )
    evaluation = problem.evaluate(problem.start)
    screen.print(_modes(findings.beside))
    for each in _sensors(findings.beside, every=every):
        screen.print(each)
    for each in _sensitivities(findings.sensitivities, every=every):
        screen.print(each)
    groups = table("groups", ["group", "a", "J nominal", "error nominal"])
    for name, a, J in zip(problem.objectives, problem.properties, evaluation.J, strict=True):
        groups.add_row(_short(name), f"{a:g}", f"{J:.5g}", f"{np.sqrt(J / a):.4g}")
    screen.print(groups)
    verdict = "agree with" if findings.sound else "DIFFER FROM"
    doubt = " at a model with these warnings" if findings.mistakes and not findings.sound else ""
    _say(
        output,
        f"derivatives {verdict} finite differences{doubt} "
        f"(relative {findings.derivative_error:.1e})",
    )
    sentences = [*(f"warning: {text}" for text in findings.warnings[: len(findings.mistakes)])]
    warnings = [f"warning: {text}" for text in findings.warnings[len(findings.mistakes) :]]
    if spoils(findings.mistakes):
        sentences += [*warnings, "put this right first: it changes what the data determine"]
    else:
        sentences += [*findings.determined[-1:], *warnings]
        sentences += [*_advice(findings.sensitivities), *findings.determined[:-1]]
    for line in digest(sentences, f"modefront check --all {study.file}", None if every else MOST):
        _say(output, line)
    if not findings.warnings:
        _say(output, "no warnings")


def _say(screen: Screen, text: str) -> None:
    """Print a sentence in lines of 80 columns, those after the first one indented."""
    lines = textwrap.wrap(
        screen.shown(text),
        WIDTH,
        subsequent_indent="    ",
        break_long_words=False,
        break_on_hyphens=False,
    )
    for line in lines:
        screen.console.print(line, markup=False, soft_wrap=True)


def _short(name: object, longest: int = NAME) -> str:
    """Return a name that fits into a table; of a long one, beginning and end."""
    text = str(name)
    if len(text) > longest:
        half = (longest - 1) // 2
        text = f"{text[: longest - 1 - half]}…{text[-half:]}"
    return safe(text)


def _modes(beside: Comparison) -> Table:
    """Return the measured modes beside those of the nominal model."""
    columns = ["mode", "measured Hz", "model Hz", "error %", "MAC", "model mode"]
    out = table("nominal model beside the measured modes", columns)
    measured = beside.data.mean_frequency
    for r, mode in enumerate(beside.data.modes):
        q, mac = int(beside.pairs.index[r]), float(beside.pairs.mac[r])
        f = float(beside.frequency[q])
        error = "" if np.isnan(measured[r]) else _percent(100 * (f / measured[r] - 1))
        out.add_row(
            str(mode),
            "" if np.isnan(measured[r]) else f"{measured[r]:.4g}",
            f"{f:.4g}",
            error,
            "" if np.isnan(mac) else f"{mac:.4f}",
            str(q + 1),
        )
    return out


def _percent(value: float) -> str:
    return f"{value:+.1f}" if abs(value) < 1e4 else f"{value:+.1e}"


def _sensors(beside: Comparison, *, every: bool) -> Iterator[Table]:
    """Yield the COMAC of the sensors, several side by side; the worst ones of many."""
    if not beside.view.has_shape.any():
        return
    values = comac(beside.view, beside.phi[:, beside.pairs.index])
    names = beside.data.sensors
    order = np.argsort(np.where(np.isnan(values), 2.0, values), kind="stable").tolist()
    most = ROWS * 2
    shown = order if every or len(order) <= most else order[:most]
    rest = len(order) - len(shown)
    title = "COMAC by sensor, the least first" + (f"; {rest} more with --all" if rest else "")
    beside_each_other = 3 if max(len(names[s]) for s in shown) < 15 else 2
    out = table(title, ["sensor", "COMAC"] * beside_each_other)
    for column in out.columns[::2]:
        column.justify = "left"
    rows = -(-len(shown) // beside_each_other)
    for i in range(rows):
        cells: list[str] = []
        for s in shown[i::rows]:
            text = "" if np.isnan(values[s]) else f"{values[s]:.4f}"
            cells += [_short(names[s]), text]
        out.add_row(*cells)
    yield out


def _sensitivities(sensitivities: Sensitivities, *, every: bool) -> Iterator[Table]:
    """Yield the sensitivities, parameters × modes; of many parameters, the first ones."""
    count = len(sensitivities.parameters)
    shown = range(count if every else min(count, ROWS))
    rest = count - len(shown)
    longest = max((len(sensitivities.parameters[j]) for j in shown), default=0)
    name, size = min(longest, NAME), len(sensitivities.modes)
    for first in range(0, max(size, 1), ACROSS):
        modes = list(range(first, min(first + ACROSS, size)))
        last = first + ACROSS >= size
        title = "sensitivity, % for 1 % of a parameter"
        title = title if not first else "sensitivity, further modes"
        if rest and last:
            title += f"\n{rest} more parameters with --all"
        columns = ["parameter", *(f"f{sensitivities.modes[r]}" for r in modes)]
        out = table(title, [*columns, "shapes"] if last else columns)
        for j in shown:
            cells = [_fixed(sensitivities.frequency[j, r]) for r in modes]
            out.add_row(
                _short(sensitivities.parameters[j], name),
                *cells,
                *([_fixed(sensitivities.shape[j])] * last),
            )
        yield out


def _fixed(value: float) -> str:
    if np.isnan(value):
        return ""
    return f"{value:.3f}" if abs(value) < 10 else f"{value:.2g}"


def _advice(sensitivities: Sensitivities) -> list[str]:
    """Return which parameters to fix or to group, as sentences."""
    groups: dict[str, list[str]] = {}
    for name, text in zip(sensitivities.parameters, sensitivities.advice, strict=True):
        groups.setdefault(text, []).append(name)
    out = []
    for text, names in groups.items():
        if text.startswith("group with "):
            first = text.removeprefix("group with ")
            out.append(
                f"group {enumeration(names)} with {first}: the data hardly tell them apart, and "
                "one parameter can scale them all"
            )
        elif text == "fix: not determined":
            out.append(
                f"fix {enumeration(names)} at the nominal value{'s' * (len(names) > 1)}, or "
                "measure more: the data determine the other parameters without "
                f"{'them' if len(names) > 1 else 'it'}"
            )
    return out
