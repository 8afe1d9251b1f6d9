"""The file of a report: one page that allows nothing from outside, and its data."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from pages import HOSTILE, ROOT, chain, content, hostile, mesh, plate, three_groups
from refusals import command

import modefront as mf
from modefront.front.point import front_points
from modefront.hdf5 import write_netcdf
from modefront.models.base import geometry_of
from modefront.reports.page import page, topics
from modefront.results.files import CHECKSUM, FILE, checksums, write
from modefront.results.shapes import drawing, mode_shapes

pytestmark = pytest.mark.usefixtures("short_chains")

MEGABYTE = 1e6
REPORT = ROOT / "report"
PACKAGE = ROOT / "src" / "modefront" / "reports"


def test_the_policy_allows_the_script_and_the_style_of_the_page_and_nothing_else() -> None:
    text = page([("results", chain())])
    (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', text)
    assert policy.startswith("default-src 'none'; ")
    for tag in ("script", "style"):
        (inner,) = re.findall(rf"<{tag}>(.*?)</{tag}>", text, re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(inner.encode()).digest()).decode()
        assert f"{tag}-src 'sha256-{digest}'" in policy
    assert "unsafe" not in policy
    body = text[: text.index("<style>")] + text[text.index("<body>") : text.index('id="data"')]
    assert not re.search(r"\b(src|href)=", body)


def test_the_script_names_no_place_outside() -> None:
    bundle = (ROOT / "src" / "modefront" / "reports" / "report.js").read_text(encoding="utf-8")
    hosts = set(re.findall(r"https?://([\w.-]+)", bundle))
    assert hosts == {"www.w3.org"}, "names of namespaces alone"
    assert "</script" not in bundle
    lock = (ROOT / "report" / "package-lock.json").read_text(encoding="utf-8")
    assert '"resolved"' not in lock


def test_the_page_of_the_three_story_example_is_small() -> None:
    assert len(page([("results", chain())]).encode()) < 1.5 * MEGABYTE


def test_the_page_holds_what_the_results_hold() -> None:
    data = chain()
    report, _ = content(page([("some/folder", data)]))
    (front,) = report["fronts"]
    assert report["title"] == "three storeys"
    assert (front["name"], front["inputs"]) == ("folder", "0123abcd")
    assert front["label"] == data["label"].values.tolist()
    assert front["order"] == front_points(data).tolist()
    np.testing.assert_array_equal(np.array(front["theta"]), data["theta"].values)
    assert front["label"][front["reference"]] == data.attrs["reference"]
    (prediction, position) = front["predictions"]
    assert prediction["values"] == data["frf_peak"].values[:, 0].tolist()
    assert (prediction["place"], position["unit"]) == ("hammer: floor1", "Hz")
    assert front["measuredStd"] == pytest.approx(
        (0.01 * data["measured_frequency"].values).tolist()
    )


def test_what_is_shipped_is_built_from_the_sources() -> None:
    """As hashes in the first line of the script say: continuous integration builds it again."""
    built = (PACKAGE / "report.js").read_bytes()
    first, _, script = built.partition(b"\n")
    names = sorted(
        [
            *(x.relative_to(REPORT).as_posix() for x in (REPORT / "src").rglob("*") if x.is_file()),
            *("build.mjs", "package.json", "package-lock.json", "tsconfig.json"),
        ]
    )
    sources = hashlib.sha256()
    for name in names:
        sources.update(name.encode() + b"\0" + (REPORT / name).read_bytes() + b"\0")
    of_tests = (PACKAGE / "identification.js").read_bytes().partition(b"\n")[2]
    style = (PACKAGE / "style.css").read_bytes()
    text = re.search(rb"sources (\w+), built (\w+)", first)
    assert text is not None
    assert text[1].decode() == sources.hexdigest(), "npm run build in the folder report"
    assert text[2].decode() == hashlib.sha256(script + of_tests + style).hexdigest(), (
        "it was edited by hand"
    )


def test_what_is_not_known_is_null_and_what_is_infinite_is_infinite() -> None:
    data = chain()
    theta = data["theta_std"].values.copy()
    theta[0, :2] = np.inf, np.nan
    report, _ = content(page([("x", data.assign(theta_std=(data["theta_std"].dims, theta)))]))
    first = report["fronts"][0]["thetaStd"][0]
    assert first[0] > 1e300  # JavaScript reads it as Infinity
    assert first[1] is None


def test_names_with_markup_stay_text() -> None:
    text = page([("x", hostile())])
    assert HOSTILE not in text
    assert "<title>&lt;/title&gt;" in text
    report, _ = content(text)
    assert report["fronts"][0]["label"][0] == HOSTILE


def shapes_of(report: dict[str, Any], arrays: bytes, point: int, mode: int) -> np.ndarray[Any, Any]:
    """Return the displacements that the page draws, as its script unpacks them."""
    geometry = report["fronts"][0]["geometry"]
    stored = geometry["basis"]
    count = int(np.prod(stored["shape"]))
    basis = np.frombuffer(arrays, "<i2", count, stored["at"]).reshape(stored["shape"])
    coefficient = np.array(geometry["coefficient"][point][mode])
    out: np.ndarray[Any, Any] = np.tensordot(coefficient, basis * stored["scale"], 1)
    return out


@pytest.mark.parametrize("results", [chain, mesh])
def test_drawn_shapes_are_those_at_the_sensors(results: Callable[[], xr.Dataset]) -> None:
    data = results()
    report, arrays = content(page([("x", data)]))
    nodes, directions = data["sensor_node"].values, data["sensor_direction"].values
    for point in range(data.sizes["point"]):
        for mode in range(data.sizes["mode"]):
            u = shapes_of(report, arrays, point, mode)
            assert np.sqrt((u**2).sum(axis=1)).max() == pytest.approx(1.0, abs=5e-3)
            seen = (u[nodes] * directions).sum(axis=1)
            np.testing.assert_allclose(seen, data["shape"].values[point, mode], atol=5e-3)


def test_shapes_have_the_mac_of_the_results() -> None:
    for data in (chain(), mesh(), three_groups()):
        paired = data["paired_mode"].values.astype(int) - 1
        of_pairs = np.take_along_axis(data["mac_matrix"].values, paired[:, :, None], axis=2)
        np.testing.assert_allclose(of_pairs[:, :, 0], data["mac"].values, atol=1e-9)
        of_model = np.take_along_axis(data["model_frequency"].values, paired, axis=1)
        np.testing.assert_allclose(of_model, data["frequency"].values, rtol=1e-8)


def test_a_common_basis_keeps_shapes_of_many_models_small() -> None:
    """A plate of 3,000 degrees of freedom at 40 models: a few columns hold all shapes."""
    model = mf.mesh_model(plate(22), ("El", "Er"))
    modes = model.modes(np.array([1.0, 1.0]), 3)
    data = mf.modal_data(modes.frequency, modes.phi.T, model.sensors)
    groups = [mf.Group("frequencies", frequency="all")]
    bounds = dict.fromkeys(("El", "Er"), (0.5, 2.0))
    problem = mf.updating_problem(model, data, groups, bounds, dict.fromkeys(bounds, 1.0))
    t = np.linspace(0, 1, 12)
    thetas = np.column_stack([0.8 + 0.4 * t, 1.2 - 0.4 * t])
    result = mode_shapes(problem, thetas, np.tile([1.0, 2.0, 3.0], (len(t), 1)))
    assert len(result["shape_basis"]) <= 12
    geometry = geometry_of(model)
    assert geometry is not None
    Phi = model.full_modes(thetas[5], 3).Phi
    u = geometry.displacement(Phi)[:, drawing(geometry)[0]]
    u /= np.sqrt((u**2).sum(axis=2)).max(axis=1)[:, None, None]
    drawn = np.tensordot(result["shape_coefficient"][5], result["shape_basis"], 1)
    drawn *= np.sign((drawn * u).sum(axis=(1, 2)))[:, None, None]
    np.testing.assert_allclose(drawn, u, atol=5e-3)


def test_only_the_surface_of_solids_is_drawn() -> None:
    x = np.arange(4.0)
    nodes = np.array([(a, b, c) for c in x for b in x for a in x])

    def node(i: int, j: int, k: int) -> int:
        return i + 4 * j + 16 * k

    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    cells = [
        [node(i + a, j + b, k + c) for c in (0, 1) for a, b in ring]
        for k in range(3)
        for j in range(3)
        for i in range(3)
    ]
    structure = mf.fem.Structure(
        nodes,
        [mf.fem.Solids("block", cells, mf.fem.Material(1.0, 0.3, 1.0))],
        supports=[mf.fem.Support(np.flatnonzero(nodes[:, 2] == 0), ("x", "y", "z"))],
        sensors=[mf.fem.Sensor("top", (3.0, 3.0, 3.0), "x")],
    )
    geometry = geometry_of(mf.mesh_model(structure, ()))
    assert geometry is not None
    drawn, _, faces = drawing(geometry)
    assert len(faces) == 6 * 9
    assert len(drawn) == 4**3 - 2**3


def test_words_say_what_was_found_and_what_is_open() -> None:
    every = topics(chain())
    text = {heading: " ".join(x for x, _ in said) for heading, said in every.items()}
    assert "3 measured modes in 2 groups" in text["What was studied"]
    assert "normal-boundary intersection" in text["What was studied"]
    assert text[""].startswith("Use most-probable: its errors over those expected are ")
    assert "Pareto-optimal models have frequencies" in text["How well the best models do"]
    assert "the nominal model has 8.2 %" in text["How well the best models do"]
    assert "k1 from" in text["What the data leave open"]
    assert "differ: peak of hammer: floor1 by" in text["What the data leave open"]
    assert "converged" in text["What to beware of"]
    known = {heading: [bool(meaning) for _, meaning in said] for heading, said in every.items()}
    assert all(known[""] + known["How well the best models do"] + known["What the data leave open"])


def test_what_did_not_converge_is_named() -> None:
    data = chain()
    converged = data["converged"].values.copy()
    converged[2] = False
    spoiled = data.assign(converged=("point", converged))
    messages = [text for said in topics(spoiled).values() for text, _ in said]
    assert f"Not converged: {data['label'].values[2]}." in messages


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "results").mkdir()
    write(chain(), tmp_path / "results" / FILE)
    return tmp_path


def test_the_command_writes_one_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command("report", folder / "results", "-o", folder / "a.html") == 0
    assert f"wrote {folder / 'a.html'}" in capsys.readouterr().out
    assert (folder / "a.html").read_text(encoding="utf-8") == page([("results", chain())])
    assert command("report", folder / "results") == 0
    assert sorted(path.name for path in folder.iterdir()) == ["a.html", "results"]
    assert (folder / "results" / "report.html").is_file()


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda data: data.drop_vars("mac"), "variable 'mac'"),
        (lambda data: data.assign_attrs(reference="none"), "attribute 'reference'"),
        (lambda data: data.assign(theta=data["theta"] * np.nan), "variable 'theta'"),
        (lambda data: data.isel(axis=slice(2)), "variable 'node'"),
        (lambda data: data.drop_vars("sensor"), "variable 'sensor'"),
    ],
)
def test_results_that_were_damaged_are_refused(
    change: Callable[[xr.Dataset], xr.Dataset],
    says: str,
    folder: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = folder / "results" / FILE
    whole = chain().assign_attrs({CHECKSUM: json.dumps(checksums(chain()))})
    with path.open("w+b") as stream:
        write_netcdf(change(whole), stream, {})
    assert command("report", folder / "results", "-o", folder / "a.html") == 2
    assert f"{folder / 'results' / FILE}: {says}: expected" in capsys.readouterr().err
    assert not (folder / "a.html").exists()


def test_other_groups_and_other_files_are_refused(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "other").mkdir()
    write(three_groups(), folder / "other" / FILE)
    out = folder / "a.html"
    both = (folder / "results", folder / "other")
    assert command("report", *both, "-o", out) == 2
    assert "groups: expected those of" in capsys.readouterr().err
    assert command("report", folder / "none", "-o", out) == 2
    assert command("report", folder / "results", "-o", folder / "a.pdf") == 2
    assert "a file that ends in .html" in capsys.readouterr().err
    nowhere = folder / "none" / "a.html"
    assert command("report", folder / "results", "-o", nowhere) == 2
    assert not list(folder.glob("*.html*"))


def test_results_of_a_study_without_modes_of_points_are_shown() -> None:
    """Such as those of an earlier version of this format."""
    data = chain().drop_dims(["set", "sensor", "model_mode", "drawn_node", "basis", "axis"])
    report, _ = content(page([("x", data)]))
    assert report["fronts"][0]["shape"] is None
    assert report["fronts"][0]["geometry"] is None
