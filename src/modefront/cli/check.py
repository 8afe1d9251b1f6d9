"""Findings of a check as tables and sentences."""

import numpy as np

from modefront.cli.layout import Screen, number, plural
from modefront.diagnosis.comparison import Comparison
from modefront.findings.knowledge import enumeration
from modefront.findings.record import found
from modefront.results.remarks import MOST, digest
from modefront.study.check import Findings
from modefront.study.definition import Study

ROWS = 12  # sensors and parameters that are shown, at most, unless all are asked for


def print_findings(study: Study, findings: Findings, *, every: bool = False) -> None:
    """Print what a check found, with the ten first findings or ``every`` one."""
    screen, problem, most = Screen.of_output(), study.problem, None if every else ROWS
    screen.say(f"{study.file}: {study.name}")
    sizes = {
        "parameter": len(study.parameters),
        "measured mode": len(problem.data.modes),
        "sensor": len(problem.data.sensors),
        "data set": len(problem.data.sets),
    }
    counts = ", ".join(plural(count, noun) for noun, count in sizes.items())
    silent = np.isnan(problem.data.shape).all(axis=(0, 1))
    if silent.any() and not silent.all():  # else no shapes are measured
        counts += f"; {plural(int(silent.sum()), 'sensor')} without data"
    screen.say(f"{problem.model.size} degrees of freedom, {counts}", start="  ")
    _print_modes(screen, findings.beside)
    if (np.isfinite(problem.data.shape).sum(axis=2) > 1).any():
        comac, sensors = findings.beside.comac, problem.data.sensors
        order = np.argsort(np.where(np.isnan(comac), 2.0, comac), kind="stable").tolist()
        worst = [f"{sensors[s]} {number(comac[s], '.4f', 'unknown')}" for s in order[:most]]
        rest = [f"{len(order[most:])} more with --all"] * (most is not None and len(order) > most)
        screen.say("")
        screen.say(f"COMAC by sensor, the least first: {', '.join([*worst, *rest])}")
    of = findings.sensitivities
    columns = ["parameter", *(f"f{mode}" for mode in of.modes), "shapes"]
    shares = np.column_stack([of.frequency, of.shape]).round(3)
    rows = [
        [name, *(number(x + 0.0, ".3f" if abs(x) < 10 else ".2g", "") for x in row)]
        for name, row in zip(of.parameters, shares, strict=True)
    ]
    more = f"; {len(rows) - ROWS} more with --all" * (most is not None and len(rows) > ROWS)
    screen.table(f"sensitivity, % for 1 % of a parameter{more}", columns, rows[:most])
    values = zip(problem.properties, problem.evaluate(problem.start).J, strict=True)
    rows = [
        [name, f"{a:g}", f"{J:.5g}", f"{np.sqrt(J / a):.4g}"]
        for name, (a, J) in zip(problem.objectives, values, strict=True)
    ]
    screen.table("groups", ["group", "a", "J nominal", "error nominal"], rows)
    screen.say("")
    screen.say(findings.derivatives)
    sentences = [f"warning: {text}" for text in findings.warnings]
    if findings.spoilt:
        sentences.append(str(found("first-this")))
    else:
        names, known = of.superfluous, findings.determined
        fixed = [found("superfluous", enumeration(names), many=len(names) > 1)] if names else []
        sentences += map(str, (*fixed, *known[-1:], *known[:-1]))
    for line in digest(sentences, f"modefront check --all {study.file}", None if every else MOST):
        screen.say(line)
    if not findings.warnings:
        screen.say("no warnings")


def _print_modes(screen: Screen, beside: Comparison) -> None:
    rows, pairs, measured = [], beside.pairs, beside.data.mean_frequency
    for r, (mode, q, mac) in enumerate(zip(beside.data.modes, pairs.index, pairs.mac, strict=True)):
        f = float(beside.frequency[q])
        error = 100 * (f / measured[r] - 1)
        cells = [number(measured[r], ".4g", ""), f"{f:.4g}"]
        cells.append(number(error, "+.1f" if abs(error) < 1e4 else "+.1e", ""))
        rows.append([str(mode), *cells, number(mac, ".4f", ""), str(q + 1)])
    columns = ["mode", "measured Hz", "model Hz", "error %", "MAC", "model mode"]
    screen.table("nominal model beside the measured modes", columns, rows)
