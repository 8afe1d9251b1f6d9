"""Results for reports: small, and with names that try to be markup."""

from __future__ import annotations

import base64
import gzip
import json
import re
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import modefront as mf
from modefront import fem
from modefront.reports.page import page

HOSTILE = "<script>document.title = 'taken'</script>"
ROOT = Path(__file__).parents[2]
WITHOUT = mf.NoisePrior(weight=0)
"""No posterior, which pages show of the chain."""


@cache
def chain() -> xr.Dataset:
    """Results of a chain of three masses, with predictions: a front with a gap."""
    names = ("k1", "k2", "k3")
    model = mf.chain(names, [22.6, 22.6, 17.176], [84763.8] * 3, stiffness_parameters=names)
    frequency = np.array([4.646, 13.81, 19.48])
    shape = np.array([[0.4561, 0.8069, 1.0], [1.0, 0.3009, -0.9026], [-0.7801, 1.0, -0.6448]])
    data = mf.modal_data(frequency, shape, model.sensors, frequency_std=0.01 * frequency)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    parameters = [mf.Parameter(name, nominal=1.0, bounds=(0.2, 5.0)) for name in names]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    peak = mf.PeakResponse(
        name="hammer", force="floor3", response=["floor1"], damping=0.02, band=(1.0, 30.0)
    )
    result = mf.solve(problem, points=8, seed=1, search=mf.Search(doubt=0.5), predictions=[peak])
    return result.dataset.assign_attrs(study="three storeys", inputs="0123abcd")


@cache
def three_groups() -> xr.Dataset:
    """Results of three groups, without geometry, in two data sets."""
    K = {"k1": np.diag([1.0, 0.0]) * 100, "k2": np.array([[1.0, -1.0], [-1.0, 1.0]]) * 80}
    model = mf.matrices(("k1", "k2"), K, {"base": np.eye(2)}, {"deck": 0, "pier": 1})
    modes = model.modes(np.array([1.1, 0.9]), 2)
    shape = modes.phi.T * np.array([[1.0, 1.06], [0.97, 1.0]])
    data = mf.modal_data(
        np.array([modes.frequency, 1.01 * modes.frequency]), np.array([shape, 0.9 * shape]),
        model.sensors,
    )  # fmt: skip
    groups = [
        mf.Group("first", frequency=[1]),
        mf.Group("second", frequency=[2]),
        mf.Group("shapes", shape="all"),
    ]
    bounds = dict.fromkeys(("k1", "k2"), (0.5, 2.0))
    problem = mf.updating_problem(model, data, groups, bounds, dict.fromkeys(bounds, 1.0))
    search = mf.Search(doubt=0.5)
    return mf.solve(problem, method="weights", points=3, search=search, noise=WITHOUT).dataset


def plate(n: int = 2) -> fem.Structure:
    """A clamped plate of n x n shells with two sensors."""
    x = np.linspace(0.0, 1.0, n + 1)
    nodes = np.array([(a, b, 0.0) for b in x for a in x])
    first = np.array([j * (n + 1) + i for j in range(n) for i in range(n)])
    cells = np.column_stack([first, first + 1, first + n + 2, first + n + 1])
    half = n // 2
    return fem.Structure(
        nodes,
        [
            fem.Shells("left", cells[first % (n + 1) < half], fem.Material(2e11, 0.3, 7800), 0.01),
            fem.Shells(
                "right", cells[first % (n + 1) >= half], fem.Material(2e11, 0.3, 7800), 0.01
            ),
        ],
        supports=[fem.Support(np.flatnonzero(nodes[:, 0] == 0))],
        sensors=[
            fem.Sensor("corner", (1.0, 1.0, 0.0), "z"),
            fem.Sensor("edge", (1.0, 0.5, 0.0), "-z"),
            fem.Sensor("middle", (0.5, 0.5, 0.0), "z"),
        ],
        parameters=[fem.Parameter("El", "E", ["left"]), fem.Parameter("Er", "E", ["right"])],
    )


@cache
def mesh() -> xr.Dataset:
    """Results of a plate of finite elements."""
    model = mf.mesh_model(plate(), ("El", "Er"))
    modes = model.modes(np.array([1.2, 0.8]), 2)
    data = mf.modal_data(modes.frequency, modes.phi.T * [1.0, 1.05, 0.96], model.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    bounds = dict.fromkeys(("El", "Er"), (0.5, 2.0))
    problem = mf.updating_problem(model, data, groups, bounds, dict.fromkeys(bounds, 1.0))
    search = mf.Search(doubt=0.5)
    return mf.solve(problem, points=4, search=search, noise=WITHOUT).dataset


@cache
def many_modes() -> xr.Dataset:
    """Results of a chain of eight masses, all of whose modes are measured."""
    names = ("k1", "k2")
    springs = [names[0]] * 4 + [names[1]] * 4
    model = mf.chain(names, [1.0] * 8, [80.0] * 8, stiffness_parameters=springs)
    modes = model.modes(np.array([1.1, 0.9]), 8)
    data = mf.modal_data(modes.frequency, modes.phi.T * np.linspace(0.97, 1.03, 8), model.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    bounds = dict.fromkeys(names, (0.5, 2.0))
    problem = mf.updating_problem(model, data, groups, bounds, dict.fromkeys(bounds, 1.0))
    search = mf.Search(doubt=0.5)
    return mf.solve(problem, points=3, search=search, noise=WITHOUT).dataset


def hostile() -> xr.Dataset:
    """The results of the chain with markup and escape sequences in all names."""
    data = chain()
    label = data["label"].values.astype(object)
    label[0] = HOSTILE
    label[1] = "\x1b[31mred\x07"
    out = data.assign(label=("point", label.astype(str)))
    for name in ("parameter", "group", "sensor", "frf"):
        values = data[name].values.astype(object)
        values[0] = f"{HOSTILE}{name}"
        out = out.assign_coords({name: values.astype(str)})
    finding = [f"</script>{HOSTILE}", *data["finding"].values.astype(str)]
    out = out.drop_dims("finding").assign(finding=("finding", np.array(finding)))
    reference = str(data.attrs["reference"])
    where = data["label"].values.astype(str).tolist().index(reference)
    result = str(out["label"].values[where])
    return out.assign_attrs(study=f"</title>{HOSTILE}", inputs=HOSTILE, reference=result)


def written(folder: Path, *results: xr.Dataset) -> Path:
    """Return the file of a report of results."""
    path = folder / "report.html"
    names = [f"study-{k}" for k in range(len(results))]
    path.write_text(page(list(zip(names, results, strict=True))), encoding="utf-8")
    return path


def content(text: str) -> tuple[dict[str, Any], bytes]:
    """Return the JSON and the arrays of a page."""
    (packed,) = re.findall(r'id="data">([^<]*)</script>', text)
    whole = gzip.decompress(base64.b64decode(packed))
    length = int.from_bytes(whole[:4], "little")
    return json.loads(whole[4 : 4 + length]), whole[4 + length :]
