"""The page of a report: one file, whose content-security policy lets no request leave it.

Its data is gzip of four bytes that hold the length of the JSON, the JSON, and the arrays behind
each other, all little-endian. Coordinates and columns of the basis of mode shapes are 16-bit
integers with a common unit: columns that matter less have smaller integers, which compress well.
"""

import base64
import gzip
import hashlib
import html
import re
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront._version import __version__
from modefront.datasets import Dataset
from modefront.errors import Fault, InputError, writing
from modefront.findings.record import Severity, meaning_of
from modefront.front.methods import METHODS
from modefront.front.point import front_points, position
from modefront.outputs import write_text
from modefront.predictions.base import Quantity, RecordedPrediction, predictions_in
from modefront.results.compare import read_together, short_names
from modefront.results.remarks import findings_of, verdict
from modefront.text import json_of

LARGEST = 32767  # of a 16-bit integer

CITE = (
    "The modefront developers, modefront {version}: structural model updating with all "
    "Pareto-optimal models. Software, BSD-3-Clause.",
    "K. Christodoulou, E. Ntotsios, C. Papadimitriou and P. Panetsos, Structural model updating "
    "and prediction variability using Pareto optimal models, Computer Methods in Applied Mechanics "
    "and Engineering 198 (2008) 138–149, doi:10.1016/j.cma.2008.04.010.",
)
"""What to cite, the program and the paper whose methods it implements."""


def payload(results: Sequence[tuple[str, Dataset]]) -> tuple[str, str]:
    """Return the title of a report, and its data in base64.

    ``results`` are sound datasets, as `modefront.results.files.read_dataset` returns them, with the
    names of their folders.
    """
    arrays, (folders, data) = _Arrays(), zip(*results, strict=True)
    with np.errstate(all="ignore"):  # what is no number is shown as unknown
        fronts = [_front(*of, arrays) for of in zip(short_names(folders), data, strict=True)]
    title = fronts[0]["study"] or fronts[0]["name"]
    title = f"{len(fronts)} studies compared" if fronts[1:] else title
    report = {
        "title": title,
        "version": __version__,
        "cite": [text.format(version=__version__) for text in CITE],
        "fronts": fronts,
    }
    infinite = {"Infinity": 10**400, "-Infinity": -(10**400)}  # which JavaScript reads as such
    text = json_of(report, infinite, separators=(",", ":")).encode()
    return title, packed(len(text).to_bytes(4, "little") + text + arrays)


def packed(content: bytes) -> str:
    """Return content as a page carries it."""
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode("ascii")


class _Arrays(bytearray):
    """The binary part: arrays behind each other, each at a multiple of four bytes."""

    def whole(self, values: Floats) -> dict[str, Any]:
        """Add numbers as 16-bit integers of a common unit, and return where they are."""
        values = np.asarray(values, dtype=float)
        unit = float(np.abs(values).max(initial=0.0)) / LARGEST or 1.0
        return self._add("int16", np.rint(values / unit).astype("<i2")) | {"scale": unit}

    def numbers(self, values: Any) -> dict[str, Any]:
        """Add integers, and return where they are."""
        return self._add("int32", np.asarray(values).astype("<i4"))

    def _add(self, kind: str, values: np.ndarray[Any, Any]) -> dict[str, Any]:
        at = len(self)
        self.extend(values.tobytes())
        self.extend(bytes(-len(self) % 4))
        return {"at": at, "type": kind, "shape": values.shape}


VARIABLES = (
    *("theta", "objective", "error", "frequency", "mac", "theta_std", "frequency_std", "mac_std"),
    *("mac_matrix", "paired_mode", "model_frequency", "shape", "measured_shape"),
)
"""Variables of the page, which has other capitals in their names; null where there are none."""


def _front(name: str, data: Dataset, arrays: _Arrays) -> dict[str, Any]:
    def known(of: str) -> Any:
        return data[of].values.tolist() if of in data.variables else None

    kinds, interval = known("kind"), data.variables.get("interval")
    reported = [i for i, kind in enumerate(kinds) if kind != "nominal"]
    posterior = {x: known(f"posterior_{x}_std") for x in ("frequency", "mac")}
    posterior["theta"] = known("posterior_std")
    return {
        "name": name,
        **{x: str(data.attrs.get(x, "")) for x in ("study", "inputs", "version", "method")},
        "reference": position(data),
        "nominal": kinds.index("nominal") if "nominal" in kinds else None,
        **{f"{x}s": known(x) or [] for x in ("group", "parameter", "mode", "sensor", "set")},
        "label": known("label"),
        "kind": kinds,
        "pareto": known("pareto"),
        "converged": known("converged"),
        "piece": known("piece") or [1] * len(kinds),
        "order": front_points(data).tolist() or reported or [0],
        **{re.sub("_(.)", lambda x: x[1].upper(), name): known(name) for name in VARIABLES},
        "posterior": posterior if posterior["theta"] else None,
        "bounds": data["bounds"].values,
        "interval": None if interval is None else interval.values[:, [0, -1]],
        "noise": _noise(data),
        "measured": data["measured_frequency"].values,
        "measuredStd": _measured_std(data),
        "ends": known("end_objective") or [],
        "geometry": _geometry(data, arrays),
        "predictions": [
            _prediction(each, x)
            for each in predictions_in(data)
            for x in each.quantities
            if x.variable.ranged
        ],
        "words": [
            {"heading": x, "sentences": [{"text": text, "meaning": why} for text, why in said]}
            for x, said in topics(data).items()
        ],
    }


def _noise(data: Dataset) -> Floats:
    """Return by how much each error changes at the reference, for that expected; NaN if unknown."""
    error = data["error"].values[position(data)]
    if "scatter_share" in data:  # which no model explains
        error = error * (1 - data["scatter_share"].values)
    misfit = data["misfit"].values if "misfit" in data else np.zeros(error.shape)
    return np.divide(error, misfit, out=np.full(error.shape, np.nan), where=misfit > 0)


def _measured_std(data: Dataset) -> Floats:
    """Return the standard deviation of the mean of each measured frequency; NaN where unknown."""
    if "set_frequency" not in data:
        return np.full(data.sizes["mode"], np.nan)
    f, std = data["set_frequency"].values, data["set_frequency_std"].values
    known = np.isfinite(f)
    count = known.sum(axis=0)
    deviation = np.where(known, f - np.nansum(f, axis=0) / count, 0.0)
    scatter = np.sqrt((deviation**2).sum(axis=0) / (count - 1) / count)
    given = np.sqrt((np.where(known, std, 0.0) ** 2).sum(axis=0)) / count
    return np.where(np.isfinite(given), given, np.where(count > 1, scatter, np.nan))


def _geometry(data: Dataset, arrays: _Arrays) -> dict[str, Any] | None:
    if "node" not in data:
        return None
    nodes = data["node"].values
    return {
        "kind": "chain" if data.attrs.get("geometry") == "chain" else "mesh",
        "nodes": arrays.whole(nodes - (nodes.min(axis=0) if len(nodes) else 0.0)),
        "lines": arrays.numbers(data["line_nodes"].values),
        "faces": arrays.numbers(data["face_nodes"].values),
        "sensorNode": data["sensor_node"].values,
        "sensorDirection": data["sensor_direction"].values,
        "basis": arrays.whole(data["shape_basis"].values),
        "columns": data.sizes["basis"],
        "coefficient": data["shape_coefficient"].values.astype("f4").astype(str).astype(float),
    }


def _prediction(of: RecordedPrediction, x: Quantity) -> dict[str, Any]:
    return {
        "title": of.name,
        "place": x.label,
        "quantity": x.variable.key,
        "unit": x.variable.unit,
        "log": x.variable.logarithmic,
        "values": x.values,
        "range": x.extent,
        "std": x.std,
        "drawn": [x.drawn[end] for end in ("5 %", "95 %")] if x.drawn else None,
        "note": f"Load: {of.load}." if of.load else "",
    }


def topics(data: Dataset) -> dict[str, list[tuple[str, list[str]]]]:
    """Return the sentences on each question by its heading, which the first answer has none of.

    Each has what it means and what to do, in paragraphs.
    """
    of: dict[Severity, list[tuple[str, list[str]]]] = {x: [] for x in Severity}
    for x in findings_of(data):
        text = str(x)
        of[x.severity].append((f"{text[:1].upper()}{text[1:]}".rstrip(".") + ".", x.meaning))
    failed = of[Severity.FAILURE] or [("All models that were solved for converged.", [])]
    every: dict[str, list[tuple[str, list[str]]]] = {
        "": [(text, meaning_of(text)) for text in verdict(data)],
        "How well the best models do": of[Severity.FIT],
        "What to beware of": [*failed, *of[Severity.CAUTION]],
        "What the data leave open": of[Severity.OPEN],
        "What was studied": [(_study(data), [])],
    }
    return {heading: sentences for heading, sentences in every.items() if sentences}


def _study(data: Dataset) -> str:
    groups, method = data["group"].values.tolist(), str(data.attrs["method"])
    title = METHODS[method].title if method in METHODS else method
    nouns = ("parameter", "measured mode", "group", "eigenproblem")
    sizes = [data.sizes[x] for x in ("parameter", "mode", "group")]
    sizes.append(int(data.attrs["model_evaluations"]))
    counts = [f"{n} {noun}{'s' * (n != 1)}" for n, noun in zip(sizes, nouns, strict=True)]
    remark = f" {data.attrs['remark']}." if data.attrs.get("remark") else ""
    return (
        f"A model with {counts[0]} is compared with {counts[1]} in {counts[2]} of measured "
        f"properties: {', '.join(groups)}. The front is found by {title}, and {counts[3]} were "
        f"solved in all.{remark}"
    )


def page(results: Sequence[tuple[str, Dataset]]) -> str:
    """Return the page of sound results, given with the names of their folders."""
    return page_of(*payload(results), "report.js")


def page_of(title: str, data: str, name: str) -> str:
    """Return the page with a title, data in base64, and the script of a name."""
    folder, names = files("modefront.reports"), ("page.html", "style.css", name)
    whole, style, script = ((folder / x).read_text(encoding="utf-8") for x in names)
    policy = (
        f"default-src 'none'; script-src '{_digest(script)}'; style-src '{_digest(style)}'; "
        "base-uri 'none'; form-action 'none'"
    )
    title = html.escape("".join(c if c.isprintable() else " " for c in title))
    return whole.format(policy=policy, title=title, style=style, data=data, script=script)


def report(folders: Path | str | Sequence[Path | str], output: Path | str | None = None) -> Path:
    """Write the results in folders as one HTML file, and return its path.

    Parameters
    ----------
    folders
        Folder of results, or several of studies with the same groups.
    output
        File to write; ``report.html`` in the first folder unless given.

    Raises
    ------
    InputError
        For results that are not sound, and a file that cannot be written.
    """
    results = read_together(folders)
    path = Path(output or Path(results[0][0]) / "report.html")
    write_html(page(results), path)
    return path


def write_html(text: str, path: Path) -> None:
    """Write a page whole or not at all; raises InputError where the file cannot be written."""
    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError(Fault(str(path), "-o", "a file that ends in .html", f"'{path.name}'"))
    with writing(path, "-o"):
        write_text(path, text, lasting=True)


def _digest(text: str) -> str:
    """Return what a content-security policy calls a text."""
    digest = hashlib.sha256(text.encode()).digest()
    return f"sha256-{base64.b64encode(digest).decode('ascii')}"
