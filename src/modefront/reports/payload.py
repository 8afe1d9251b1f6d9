"""The data of a report: JSON and arrays, compressed, as the page's script reads them.

The whole is gzip of four bytes that hold the length of the JSON, the JSON, and the arrays behind
each other, all little-endian. Coordinates and columns of the basis of mode shapes are 16-bit
integers with a common unit: columns that matter less have smaller integers, which compress well.
"""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront._version import __version__
from modefront.findings.catalogue import Severity
from modefront.findings.selection import front_points, verdict
from modefront.front.methods import METHODS
from modefront.front.point import preferred
from modefront.predictions import ResultVariable
from modefront.predictions.registry import RecordedPrediction, predictions_in
from modefront.results.compare import short_names
from modefront.results.remarks import findings_of

INFINITE = 10**400
"""An integer that JavaScript reads as Infinity, for which JSON has no word."""

LARGEST = 32767
"""Of a 16-bit integer."""

CITE = (
    "The modefront developers, modefront {version}: structural model updating with all "
    "Pareto-optimal models. Software, BSD-3-Clause.",
    "K. Christodoulou, E. Ntotsios, C. Papadimitriou and P. Panetsos, Structural model updating "
    "and prediction variability using Pareto optimal models, Computer Methods in Applied Mechanics "
    "and Engineering 198 (2008) 138–149, doi:10.1016/j.cma.2008.04.010.",
)
"""What to cite, the program and the paper whose methods it implements."""


def payload(results: Sequence[tuple[str, xr.Dataset]]) -> tuple[str, str]:
    """Return the title of a report, and its data in base64.

    ``results`` are sound datasets, as `modefront.results.files.read_dataset` returns them, with the
    names of their folders.
    """
    arrays = _Arrays()
    names = short_names([name for name, _ in results])
    with np.errstate(all="ignore"):  # what is no number is shown as unknown
        fronts = [
            _front(name, data, arrays) for name, (_, data) in zip(names, results, strict=True)
        ]
    studies = [front["study"] or front["name"] for front in fronts]
    title = studies[0] if len(studies) == 1 else f"{len(studies)} studies compared"
    report = {
        "title": title,
        "version": __version__,
        "cite": [text.format(version=__version__) for text in CITE],
        "fronts": fronts,
    }
    text = json.dumps(report, separators=(",", ":"), allow_nan=False).encode()
    content = len(text).to_bytes(4, "little") + text + arrays.content
    packed = gzip.compress(content, 9, mtime=0)
    return title, base64.b64encode(packed).decode("ascii")


class _Arrays:
    """The binary part: arrays behind each other, each at a multiple of four bytes."""

    def __init__(self) -> None:
        self.content = bytearray()

    def whole(self, values: Floats) -> dict[str, Any]:
        """Add numbers as 16-bit integers of a common unit, and return where they are."""
        values = np.asarray(values, dtype=float)
        unit = float(np.abs(values).max(initial=0.0)) / LARGEST or 1.0
        return self._add("int16", np.rint(values / unit).astype("<i2")) | {"scale": unit}

    def numbers(self, values: Any) -> dict[str, Any]:
        """Add integers, and return where they are."""
        return self._add("int32", np.asarray(values).astype("<i4"))

    def _add(self, kind: str, values: np.ndarray[Any, Any]) -> dict[str, Any]:
        out = {"at": len(self.content), "type": kind, "shape": list(values.shape)}
        self.content += values.tobytes()
        self.content += bytes(-len(self.content) % 4)
        return out


def _front(name: str, data: xr.Dataset, arrays: _Arrays) -> dict[str, Any]:
    """Return all that the page shows of one study."""
    labels, kinds = texts(data["label"].values), texts(data["kind"].values)
    front = front_points(data).tolist()
    posterior = {
        "theta": "posterior_std",
        "frequency": "posterior_frequency_std",
        "mac": "posterior_mac_std",
    }
    return {
        "name": name,
        "study": str(data.attrs.get("study", "")),
        "inputs": str(data.attrs.get("inputs", "")),
        "version": str(data.attrs["version"]),
        "method": str(data.attrs["method"]),
        "reference": labels.index(preferred(data.attrs)),
        "nominal": kinds.index("nominal") if "nominal" in kinds else None,
        "groups": _texts(data, "group"),
        "parameters": _texts(data, "parameter"),
        "modes": [int(mode) for mode in data["mode"].values],
        "sensors": _texts(data, "sensor"),
        "sets": _texts(data, "set"),
        "label": labels,
        "kind": kinds,
        "pareto": data["pareto"].values.astype(bool).tolist(),
        "converged": data["converged"].values.astype(bool).tolist(),
        "piece": (
            [int(x) for x in data["piece"].values] if "piece" in data else [1] * data.sizes["point"]
        ),
        "order": front or [i for i, kind in enumerate(kinds) if kind != "nominal"] or [0],
        **{name: plain(data[name].values) for name in POINTS},
        **{key: _optional(data, name) for key, name in OPTIONAL.items()},
        "posterior": (
            {key: plain(data[name].values) for key, name in posterior.items()}
            if all(name in data for name in posterior.values())
            else None
        ),
        "bounds": plain(data["bounds"].values),
        "interval": plain(data["interval"].values[:, [0, -1]]) if "interval" in data else None,
        "noise": plain(_noise(data)),
        "measured": plain(data["measured_frequency"].values),
        "measuredStd": plain(_measured_std(data)),
        "ends": _optional(data, "end_objective") or [],
        "geometry": _geometry(data, arrays),
        "predictions": list(_predictions(data)),
        "words": [
            {"heading": topic.heading, "sentences": list(topic.sentences)} for topic in topics(data)
        ],
    }


POINTS = ("theta", "objective", "error", "frequency", "mac")
"""Variables that every point has."""

OPTIONAL: Mapping[str, str] = {
    "thetaStd": "theta_std",
    "frequencyStd": "frequency_std",
    "macStd": "mac_std",
    "macMatrix": "mac_matrix",
    "pairedMode": "paired_mode",
    "modelFrequency": "model_frequency",
    "shape": "shape",
    "measuredShape": "measured_shape",
}
"""Further variables, by their names on the page."""


def _texts(data: xr.Dataset, name: str) -> list[str]:
    return texts(data[name].values) if name in data.coords else []


def _optional(data: xr.Dataset, name: str) -> Any:
    return plain(data[name].values) if name in data else None


def _noise(data: xr.Dataset) -> Floats:
    """Return the error that is expected of each group at the reference; NaN where unknown."""
    chosen = data["label"].values == preferred(data.attrs)
    if "misfit" not in data or not chosen.any():
        return np.full(data.sizes["group"], np.nan)
    misfit = data["misfit"].values
    error = data["error"].values[chosen][0]
    return np.divide(error, misfit, out=np.full(error.shape, np.nan), where=misfit > 0)


def _measured_std(data: xr.Dataset) -> Floats:
    """Return the standard deviation of the mean of each measured frequency; NaN where unknown."""
    if "set_frequency" not in data:
        return np.full(data.sizes["mode"], np.nan)
    f, std = data["set_frequency"].values, data["set_frequency_std"].values
    known = np.isfinite(f)
    count = known.sum(axis=0)
    deviation = np.where(known, f - np.nansum(f, axis=0) / count, 0.0)
    scatter = np.sqrt((deviation**2).sum(axis=0) / (count - 1) / count)
    given = np.sqrt((np.where(known, std, 0.0) ** 2).sum(axis=0)) / count
    out: Floats = np.where(np.isfinite(given), given, np.where(count > 1, scatter, np.nan))
    return out


def _geometry(data: xr.Dataset, arrays: _Arrays) -> dict[str, Any] | None:
    if "node" not in data:
        return None
    nodes = data["node"].values
    return {
        "kind": "chain" if data.attrs.get("geometry") == "chain" else "mesh",
        "nodes": arrays.whole(nodes - (nodes.min(axis=0) if len(nodes) else 0.0)),
        "lines": arrays.numbers(data["line_nodes"].values),
        "faces": arrays.numbers(data["face_nodes"].values),
        "sensorNode": [int(x) for x in data["sensor_node"].values],
        "sensorDirection": plain(data["sensor_direction"].values),
        "basis": arrays.whole(data["shape_basis"].values),
        "columns": data.sizes["basis"],
        "coefficient": plain(data["shape_coefficient"].values.astype(np.float32)),
    }


def _predictions(data: xr.Dataset) -> Iterator[dict[str, Any]]:
    """Yield every quantity that all models predict, one a place."""
    for prediction in predictions_in(data):
        for k in prediction.positions:
            for variable in prediction.kind.ranged:
                yield _prediction(data, prediction, variable, k)


def _prediction(
    data: xr.Dataset, prediction: RecordedPrediction, variable: ResultVariable, k: int
) -> dict[str, Any]:
    name, dimension = variable.name, prediction.kind.dimension
    start = f"posterior_{dimension}_log" if variable.logarithmic else f"posterior_{name}"
    std = data.get(f"{start}_std")
    drawn = data.get(f"posterior_{name}")
    load = data.get(f"{dimension}_load")
    ends = None
    if drawn is not None:
        statistic = texts(data["statistic"].values)
        if "5 %" in statistic and "95 %" in statistic:
            ends = drawn.values[[statistic.index("5 %"), statistic.index("95 %")], k]
    return {
        "title": prediction.name,
        "place": str(data[dimension].values[k]),
        "quantity": variable.key,
        "unit": variable.unit,
        "log": variable.logarithmic,
        "values": plain(data[name].values[:, k]),
        "range": plain(data[f"{name}_range"].values[:, k]),
        "std": None if std is None else plain(std.values[k]),
        "drawn": None if ends is None else plain(ends),
        "note": f"Load: {load.values[k]}." if load is not None else "",
    }


def plain(values: Any) -> Any:
    """Return numbers as JSON has them: null for NaN, an integer beyond all numbers for infinity."""
    array = np.asarray(values)
    if array.ndim:
        return [plain(part) for part in array]
    value = array.item()
    if isinstance(value, float):
        if np.isnan(value):
            return None
        if np.isinf(value):
            return INFINITE if value > 0 else -INFINITE
        if array.dtype == np.float32:
            return float(f"{value:.7g}")
    return value


@dataclass(frozen=True)
class Topic:
    """Sentences on one question; those of the first answer have no heading."""

    heading: str
    sentences: tuple[str, ...]


def texts(values: Any) -> list[str]:
    """Return the texts of an array."""
    return [str(x) for x in values.tolist()]


def topics(data: xr.Dataset) -> list[Topic]:
    """Return the sentences: the first answer, then those on each question."""
    found = findings_of(data)

    def of(*severities: Severity) -> tuple[str, ...]:
        return tuple(
            f"{text[:1].upper()}{text[1:]}".rstrip(".") + "."
            for text in (str(x) for x in found if x.severity in severities)
        )

    failed = of(Severity.FAILURE) or ("All models that were solved for converged.",)
    all_topics = (
        Topic("", tuple(verdict(data))),
        Topic("How well the best models do", of(Severity.FIT)),
        Topic("What to beware of", (*failed, *of(Severity.CAUTION))),
        Topic("What the data leave open", of(Severity.OPEN)),
        Topic("What was studied", (_study(data),)),
    )
    return [topic for topic in all_topics if topic.sentences]


def _study(data: xr.Dataset) -> str:
    groups, method = texts(data["group"].values), str(data.attrs["method"])
    title = METHODS[method].title if method in METHODS else method
    sizes = {
        "parameter": data.sizes["parameter"],
        "measured mode": data.sizes["mode"],
        "group": len(groups),
        "eigenproblem": int(data.attrs["model_evaluations"]),
    }
    counts = [f"{count} {noun}{'s' * (count != 1)}" for noun, count in sizes.items()]
    remark = f" {data.attrs['remark']}." if data.attrs.get("remark") else ""
    return (
        f"A model with {counts[0]} is compared with {counts[1]} in {counts[2]} of measured "
        f"properties: {', '.join(groups)}. The front is found by {title}, and {counts[3]} were "
        f"solved in all.{remark}"
    )
