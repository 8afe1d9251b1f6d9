"""Findings, results and comparisons in the terminal, an overview or full lists, and as JSON."""

from collections.abc import Callable, Mapping, Sequence
from itertools import chain, groupby
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from modefront._typing import Floats
from modefront.cli.layout import BLANK, Line, Screen, number, plural
from modefront.cli.terminal import command, say_next
from modefront.datasets import Dataset
from modefront.findings.knowledge import enumeration
from modefront.findings.record import Severity, found, meaning_of
from modefront.front.point import INTERNAL, Kind, position, preferred
from modefront.predictions import ResultVariable
from modefront.predictions.base import Quantity, predictions_in, quantity
from modefront.results.compare import Comparison, Spread, short_names
from modefront.results.remarks import MOST, digest, findings_of, verdict
from modefront.study.estimate import Estimate
from modefront.text import json_of
from modefront.work.task import Costs

if TYPE_CHECKING:  # `show` is quick without them
    from modefront.study.check import Findings
    from modefront.study.definition import Study

FEWEST = 2  # rows of a kind that a table keeps, however long it is


def models_in(screen: Screen, data: Dataset, most: int, full: str) -> list[Line]:
    """Return the lines of the first models, ``most`` or fewer where that is possible.

    ``full`` is the command that prints what is left out.
    """
    models, best = _first_models(data), position(data)
    theta, f = data["theta"].values, data["frequency"].values[best]
    change = np.abs(theta[best] - theta[models[0]]) / np.ptp(data["bounds"].values, axis=1)
    error = np.abs(f / data["measured_frequency"].values - 1)
    predicted = [
        [
            f"  {each.name}, {x.place}: {x.variable.title}",
            *(f"{number(x.values[i], '.3g')} {_deviation(x) * (i == best)}" for i in models),
        ]
        for each in predictions_in(data)
        for x in each.quantities
        if x.variable in each.kind.ranged[:1]  # the main ones
    ]
    greatest = {"parameter": change, "mode": error}
    order = {name: np.argsort(-np.nan_to_num(x), kind="stable") for name, x in greatest.items()}
    order |= {"group": np.arange(data.sizes["group"]), "prediction": np.arange(len(predicted))}
    size = {name: len(x) for name, x in order.items()}
    while True:
        rows: dict[str, Any] = {x: np.sort(order[x][:n]) for x, n in size.items()}
        predictions = [predicted[i] for i in rows.pop("prediction")]
        for count in range(len(models), 0, -1):
            chosen = data.isel(point=models[:count], **rows)
            lines = _table(screen, chosen, [row[: count + 1] for row in predictions])
            if count <= 2 or BLANK not in lines:  # they fit side by side
                break
        left = {name: len(x) - size[name] for name, x in order.items()}
        less = {"parameter": "that change{} less", "mode": "that fit{} better"}
        said = [
            f"{plural(n, f'more {name}')} {less.get(name, '').format('s' * (n == 1))}".rstrip()
            for name, n in {**left, "edge": len(models) - count}.items()
            if n
        ]
        lines += screen.sentence(f"and {', '.join(said)}: {full}") if said else []
        longest = max(size, key=lambda name: size[name])
        if len(lines) <= most or size[longest] <= FEWEST:
            return lines
        # Each row that is left out saves a line at least, and names or blocks save more.
        size[longest] = max(size[longest] - max((len(lines) - most) // 6, 1), FEWEST)


def _first_models(data: Dataset) -> list[int]:
    """Return the positions of the nominal model, the reference and the edges."""
    kinds = data["kind"].values
    nominal, edges = (np.flatnonzero(kinds == x.value) for x in (Kind.NOMINAL, Kind.EDGE))
    return list(dict.fromkeys([*nominal.tolist(), position(data), *edges.tolist()]))


def _table(screen: Screen, data: Dataset, predictions: Sequence[list[str]] = ()) -> list[Line]:
    """Return the table of models, with rows of predictions, and what explains it."""
    theta, best, measured = data["theta"].values, position(data), data["measured_frequency"].values
    std, explained = _deviations(data)
    bound = data["at_bound"].values if "at_bound" in data else np.zeros(theta.shape)
    rows = []
    for j, name in enumerate(data["parameter"].values):
        rows.append([f"  {name}"])
        for i, value in enumerate(theta[:, j]):
            at = {-1: " min", 1: " max"}.get(int(bound[i, j]), "")
            scatter = f" ± {std[j]:.2g}" * bool(i == best and np.isfinite(std[j]) and not at)
            rows[-1].append(f"{number(value, '#.4g').removesuffix('.')}{scatter}{at}")
    rows.append(["modes: error of the frequency in %, and MAC"])
    frequency, macs = data["frequency"].values, data["mac"].values
    for r, mode in enumerate(data["mode"].values):
        rows.append([f"  {mode}" + f": {measured[r]:.4g} Hz" * bool(np.isfinite(measured[r]))])
        for f, mac in zip(frequency[:, r], macs[:, r], strict=True):
            error = 100 * (f / measured[r] - 1)
            first = f"{f:.4g} Hz" if np.isnan(error) else f"{round(error, 2) + 0.0:+.2f}"
            rows[-1].append("none" if np.isnan(f) else f"{first}  {number(mac, '.3f')}")
    rows.append(["errors of the groups, root mean square"])
    for group, errors in zip(data["group"].values, data["error"].values.T, strict=True):
        rows.append([f"  {group}", *(number(x, ".3g") for x in errors)])
    rows += [["predictions"], *predictions] if predictions else []
    out = screen.grid("", ["parameters", *map(str, data["label"].values)], rows)
    notes = [f"±: {explained}"] * bool(np.isfinite(std).any())
    notes += ["min, max: at its lower or upper bound"] * bool(bound.any())
    return [*out, *screen.sentence("; ".join(notes))] if notes else out


def _deviations(data: Dataset) -> tuple[Floats, str]:
    """Return standard deviations (p,) of the parameters of the reference, and what they are."""
    if "sample_theta" in data:
        std = data["sample_theta"].values.std(axis=0, ddof=1)
        return std, f"standard deviation of the posterior{_rough(data)}"
    if "theta_std" in data:
        return data["theta_std"].values[position(data)], "standard deviation by errors of the data"
    if "posterior_std" in data:
        return data["posterior_std"].values, "standard deviation of the posterior"
    return np.full(data.sizes["parameter"], np.nan), ""


def _rough(data: Dataset) -> str:
    """Return why the posterior is not to be relied on; nothing where it is."""
    rough = ", rough: draws are too few, or the model is not to be used"
    return "" if data.attrs.get("settled", 1) else rough


def print_predictions(screen: Screen, data: Dataset) -> None:
    """Print all predictions of all models that are no points of the front, and their ranges."""
    if "range" not in data.sizes:
        screen.say("The study asks for no predictions.")
        return
    kinds, labels = data["kind"].values, data["label"].values
    models = [i for i, kind in enumerate(kinds) if kind not in {"front", *INTERNAL}]

    def row(name: str, x: Quantity) -> dict[str, str]:
        form = (".3e" if x.variable.logarithmic else ".5g") if x.variable.ranged else ".2g"
        known, out = x.values[np.isfinite(x.values)], {"": name}
        if x.variable.ranged:
            out |= {"minimum": number(x.extent[0], form), "maximum": number(x.extent[1], form)}
            out["spread"] = number(x.extent[2], ".4g")
        else:
            out["maximum"] = number(known.max() if known.size else np.nan, form)
        if x.std is not None:
            out["posterior"] = _deviation(x)
        shown = ("mean", "5 %", "95 %") if x.drawn else ()
        out |= {f"drawn {end}": number(x.drawn[end], form) for end in shown}
        return out | {str(labels[i]): number(x.values[i], form) for i in models}

    def table(title: str, rows: Sequence[Mapping[str, str]]) -> None:
        columns = list(dict.fromkeys(chain.from_iterable(rows)))
        screen.table(title, columns, [[row.get(x, "") for x in columns] for row in rows])

    frequency = ResultVariable("frequency", "frequency", "frequency", "Hz")
    table(
        "frequencies: range over the Pareto-optimal models; spread is greatest over least",
        [row(f"f{r}, Hz", quantity(data, frequency, i)) for i, r in enumerate(data["mode"].values)],
    )
    if "posterior_frequency_std" in data:
        screen.say(
            f"posterior: standard deviation around {preferred(data.attrs)}; of P as a factor, "
            "e to that of ln P"
        )
    if "statistic" in data.sizes:
        screen.say(
            f"drawn: over {plural(data.sizes['draw'], 'model')} drawn from the posterior; the mean "
            "of P is the robust failure probability"
        )
    for each in predictions_in(data):
        table(each.heading, [row(f"{x.place}: {x.variable.title}", x) for x in each.quantities])
        check = each.kind.check
        if check is not None and check.label.name in data:
            label = data[check.label.name].values[each.positions[0]]
            for variable in check.variables:
                values = [number(data[variable.name].values[i], ".3f") for i in each.positions]
                screen.say(f"at {label}: {variable.meaning}: {', '.join(values)}")


def _deviation(of: Quantity) -> str:
    """Return the standard deviation by the posterior, that of a logarithm as a factor."""
    if of.std is None:
        return ""
    shown = f"×÷ {np.exp(of.std):.3g}" if of.variable.logarithmic else f"± {of.std:.3g}"
    return "none" if np.isnan(of.std) else shown


def print_points(screen: Screen, data: Dataset) -> None:
    """Print objectives, errors, parameters, modes and weights of all models."""
    marks = [
        "*" * int(pareto) + "!" * int(not converged)
        for pareto, converged in zip(data["pareto"].values, data["converged"].values, strict=True)
    ]
    columns = [("J {}", "objective", ".5g"), ("error {}", "error", ".4g"), ("{}", "theta", ".5g")]
    _print(screen, data, "models: * Pareto optimal among these, ! not converged", columns, marks)
    measured = data["measured_frequency"].values
    error = np.round(100 * (data["frequency"].values / measured - 1), 2) + 0.0
    title = f"frequencies in Hz and MAC; measured: {', '.join(number(x, '.4g') for x in measured)}"
    of_modes = [("error f{} %", error, "+.2f"), ("MAC {}", "mac", ".4f")]
    _print(screen, data, title, [("f{}", "frequency", ".4g"), *of_modes])
    if "certified" in data:
        marks = ["!" * int(not x) for x in data["certified"].values]
        columns = [("eigenvalue {}", "eigenvalue_error", ".1e"), ("shape {}", "shape_error", ".1e")]
        _print(screen, data, "estimated relative errors: ! above the tolerance", columns, marks)
    weighted = data.isel(point=np.flatnonzero(~np.isnan(data["weight"].values).all(axis=1)))
    _print(screen, weighted, "weights", (("{}", "weight", ".5g"),))


def print_uncertainty(screen: Screen, data: Dataset) -> None:
    """Print how far models and objectives scatter, and the posterior, where they are known."""
    for kind, title in (
        ("", "scatter by errors of the data: standard deviations, linearised"),
        ("bootstrap_", "scatter over data drawn again: standard deviations"),
    ):
        if f"{kind}theta_std" in data:
            columns = [("J {}", f"{kind}objective_std", ".3g"), ("{}", f"{kind}theta_std", ".3g")]
            _print(screen, data, title, columns)
    if "scatter_doubt" in data:
        doubts = zip(data["label"].values, data["scatter_doubt"].values, strict=True)
        rows = [[str(x), str(y)] for x, y in doubts if y]
        screen.table("where linearised standard deviations are approximate", ["model", "why"], rows)
    if "posterior_std" in data:
        rows = []
        for text, name in (("{}", ""), ("f{} Hz", "frequency_"), ("MAC {}", "mac_")):
            std = data[f"posterior_{name}std"]
            pairs = zip(data[std.dims[0]].values, std.values, strict=True)
            rows += [[text.format(title), number(x, ".3g", "")] for title, x in pairs]
        title = f"posterior around {preferred(data.attrs)}: standard deviations{_rough(data)}"
        screen.table(title, ["of", "std"], rows)
        if "r_hat" in data:
            low, _, high = data["interval"].values.T
            numbers = low, high, data["r_hat"].values, data["effective_draws"].values
            forms = "#.4g", "#.4g", ".3f", ".0f"
            rows = [
                [str(name), *map(number, row, forms)]
                for name, *row in zip(data["parameter"].values, *numbers, strict=True)
            ]
            heads = ["of", "5 %", "95 %", "R-hat of chains", "effective draws"]
            screen.table("intervals by draws from the posterior", heads, rows)
    elif "theta_std" not in data:
        screen.say("The results hold no uncertainty: the data have no errors that are known.")


def print_findings_of(screen: Screen, data: Dataset) -> None:
    """Print the verdict and all findings, each with what it means and what to do."""
    said = [([text], meaning_of(text)) for text in verdict(data)]
    for _, of_kind in groupby(findings_of(data, full=True), attrgetter("kind")):
        every = list(of_kind)
        said.append(([*map(str, every)], every[0].meaning))
    screen.say("")
    for sentences, meaning in said:
        for sentence in sentences:
            screen.say(sentence, start="- ")
        for line in "\n".join(meaning).splitlines():
            if not line.startswith("```"):
                screen.say(line, start="    ")


MINIMA = ("J {}", "minimum_objective", ".5g"), ("{}", "minimum_theta", ".5g")

LISTS: Mapping[str, Callable[[Screen, Dataset], None]] = {
    "models": lambda screen, data: screen.show(
        [BLANK, *_table(screen, data.isel(point=_first_models(data)))]
    ),
    "points": print_points,
    "minima": lambda screen, data: _print(
        screen, data, "minima of the groups and of the weighted residuals", MINIMA, of="minimum_of"
    ),
    "uncertainty": print_uncertainty,
    "predictions": print_predictions,
    "findings": print_findings_of,
}
"""Full lists by the name of their option, in the order in which they are printed."""


# 6 arguments: the table, its rows and its columns.
def _print(
    screen: Screen,
    data: Dataset,
    title: str,
    columns: Sequence[tuple[str, str | Floats, str]],
    marks: Sequence[str] = (),
    of: str = "label",
) -> None:
    """Print a table with a row for each of what ``of`` names, and ``marks`` beside these.

    Columns have a title with a place for a name, the variable (rows, names), or values (rows,
    modes), and the format.
    """
    known = [
        (x, data[y].values, data[y].dims[1], form) if isinstance(y, str) else (x, y, "mode", form)
        for x, y, form in columns
    ]
    titles = [text.format(name) for text, _, names, _ in known for name in data[names].values]
    rows = [
        [str(name), *marks[i : i + 1], *(number(x, form) for _, y, _, form in known for x in y[i])]
        for i, name in enumerate(data[of].values)
    ]
    first = ["model" if of == "label" else "of", *[""] * bool(marks)]
    screen.table(title, [*first, *titles], rows, keys=len(first))


HEIGHT, LEAST = 30, 3
"""Lines of the first screen, about, and of it for findings, at least."""


def say_estimate(expected: Estimate | None, *, err: bool = False) -> None:
    """Print how long a run will probably take, and what would make it shorter."""
    if expected is None:
        return
    screen = Screen(stderr=err)
    screen.say(expected.text)
    if expected.advice:
        screen.say(f"shorter with: {'; '.join(expected.advice)}")


def print_summary(data: Dataset, study: Path, folder: Path, costs: Costs) -> None:
    """Print what a run has found and what this run of it has cost, in a few lines."""
    screen = Screen()
    screen.say(f"{data.attrs.get('study', '')}: results in {folder}", style="bold")
    failures = [str(x) for x in findings_of(data) if x.severity is Severity.FAILURE]
    said = verdict(data)
    whole = command("show", folder, "--findings")
    for line in [*said, *failures] if said else digest(list(map(str, findings_of(data))), whole):
        screen.say(line, start="  ")
    spent = {
        "full eigensolutions": (costs.eigenproblems, costs.full_time),
        "corrected": (costs.corrected, costs.corrected_time),
        "reduced": (costs.reduced, costs.reduced_time),
        "certificates": (costs.certificates, costs.certificate_time),
    }
    said = [f"{count} {what} in {s:.3g} s" for what, (count, s) in spent.items() if count]
    screen.say(f"this time: {', '.join(said) or 'nothing was solved'}")
    if not data.attrs["reference"]:
        screen.say(f"mistakes of model and data, if any: {command('check', study)}")
    say_next("show", folder)


def print_results(
    data: Dataset, lists: Sequence[str] = (), folder: Path | str = "DIRECTORY"
) -> None:
    """Print the first screen of the results in a folder, or the full lists of these names."""
    screen, attrs, show = Screen(), data.attrs, command("show", folder)
    lines = screen.sentence(attrs.get("study") or "results", style="bold")
    if lists:
        by = f"modefront {attrs['version']}, method {attrs['method']}, seed {attrs['seed']}"
        screen.show([*lines, *screen.sentence(by)])
        for name in (name for name in LISTS if name in lists):
            LISTS[name](screen, data)
        screen.say("")
    else:
        lines += [line for text in verdict(data) for line in screen.sentence(text)]
        most = HEIGHT - len(lines) - LEAST - 4
        lines += [BLANK, *models_in(screen, data, most, f"{show} --models"), BLANK]
        room, full = max(HEIGHT - len(lines) - 2, LEAST), f"{show} --findings"
        sentences = list(map(str, findings_of(data)))
        blocks = [screen.sentence(text, start="- ") for text in sentences]
        ends = np.cumsum([len(block) for block in blocks])
        count = int(np.searchsorted(ends, room - 1, side="right"))
        rest = digest(sentences, full, count)[count:] or [f"what these findings mean: {full}"]
        screen.show([*lines, *chain.from_iterable(blocks[:count]), *screen.sentence(*rest)])
    screen.say(f"all: {show} --all")
    screen.say(f"next: {command('report', folder)}")


def as_json(data: Dataset) -> str:
    """Return the dataset as JSON: attributes, and each variable with dimensions and values."""
    found = findings_of(data, full=True)
    sections = {
        "verdict": verdict(data),
        "attributes": {str(k): np.asarray(value).tolist() for k, value in data.attrs.items()},
        "variables": {
            str(x): {"dimensions": list(map(str, data[x].dims)), "values": data[x].values.tolist()}
            for x in data.variables
        },
        "remarks": [str(finding) for finding in found],
        "findings": [finding.as_plain() for finding in found],
    }
    return json_of(sections, indent=1)


SHOWN = 6  # parameters, and predictions, that are printed unless all are asked for


def print_comparison(comparison: Comparison, *, every: bool = False) -> None:
    """Print a comparison, one column a study, with the first parameters, or ``every`` one."""
    screen = Screen()
    fronts, folders = comparison.fronts, [summary.name for summary in comparison.fronts]
    short, most = short_names(folders), None if every else SHOWN
    names, columns = dict(zip(folders, short, strict=True)), ["", *short]
    screen.say("Studies side by side", style="bold")
    screen.say(
        "Errors are root mean squares, which mean the same in all studies. Ranges are those of all "
        "Pareto-optimal models, edges and weighted ones included; of predictions, of equivalent "
        "models too."
    )
    rows = [[name, *map(_cell, row)] for name, row in comparison.rows.items()]
    screen.table("", columns, rows)
    for title in ("parameters", "predictions"):
        known = [{x.name: _cell(x) for x in getattr(front, title)} for front in fronts]
        # Predictions of modes come after those of the studies.
        names_of = dict.fromkeys(name for row in known for name in row)
        order = sorted(names_of, key=lambda name: name.startswith(("frequency ", "mac ")))
        cells = [[name, *(row.get(name, "") for row in known)] for name in order]
        screen.table(f"{title}: reference model, and least to greatest", columns, cells[:most])
        if cells[SHOWN:] and most:
            whole = command("compare", "--all", *folders)
            screen.say(f"and {len(cells) - SHOWN} more {title}: {whole}")
    pairs = []
    for x in comparison.pairs:
        many = most is not None and len(x.common) > most
        common = f"{len(x.common)} parameters" if many else ", ".join(x.common) or "none"
        distances = map(_cell, (x.least, x.greatest, x.reference))
        pairs.append([f"{names[x.first]} and {names[x.second]}", common, *distances])
    screen.table(
        "distances in the common parameters, over their bounds in the first: of the two nearest "
        "models, of the farthest one from the other study, and of the reference models",
        ["studies", "common", "least", "greatest", "references"],
        pairs,
    )
    say_next("report", *folders)


def _cell(value: object) -> str:
    """Return a value of a comparison: of a range that of the reference, and its ends."""
    if isinstance(value, Spread):
        ends = f"{_cell(value.least)} to {_cell(value.greatest)}"
        return f"{_cell(value.reference)} ({ends})"
    return number(value, ".4g", "") if isinstance(value, float) else str(value)


ROWS = 12  # sensors and parameters that are shown, at most, unless all are asked for


def print_findings(study: "Study", findings: "Findings", *, every: bool = False) -> None:
    """Print what a check found, with the ten first findings or ``every`` one."""
    screen, problem, most = Screen(), study.problem, None if every else ROWS
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
    rows, beside = [], findings.beside
    pairs, measured = beside.pairs, beside.data.mean_frequency
    for r, (mode, q, mac) in enumerate(zip(beside.data.modes, pairs.index, pairs.mac, strict=True)):
        f = float(beside.frequency[q])
        error = 100 * (f / measured[r] - 1)
        cells = [number(measured[r], ".4g", ""), f"{f:.4g}"]
        cells.append(number(error, "+.1f" if abs(error) < 1e4 else "+.1e", ""))
        rows.append([str(mode), *cells, number(mac, ".4f", ""), str(q + 1)])
    columns = ["mode", "measured Hz", "model Hz", "error %", "MAC", "model mode"]
    screen.table("nominal model beside the measured modes", columns, rows)
    if (np.isfinite(problem.data.shape).sum(axis=2) > 1).any():
        comac, sensors = beside.comac, problem.data.sensors
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
