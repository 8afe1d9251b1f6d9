"""Results in the terminal: complete, in its width and in its characters."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from functools import partial

import numpy as np
import pytest
import xarray as xr

import modefront as mf
from modefront.cli.layout import Screen
from modefront.cli.show import LISTS, print_comparison, print_results
from modefront.results.compare import Apart, Comparison, Spread, Summary
from modefront.results.remarks import findings_of

pytestmark = pytest.mark.usefixtures("short_chains")

SEARCH = mf.Search(doubt=0.5)
NAMES = ["k1", "the stiffness of the second story"]


def solved(
    groups: Sequence[mf.Group], points: int, noise: mf.NoisePrior | None = None
) -> xr.Dataset:
    """Return the results of a chain of two stiffnesses."""
    model = mf.chain(NAMES, [1.0, 1.0], [900.0, 800.0], stiffness_parameters=NAMES)
    modes = model.modes(np.array([1.1, 0.9]), 2)
    f, shape = modes.frequency * [1.02, 0.99], modes.phi.T + np.array([[0.02, 0.0], [0.0, -0.03]])
    std = np.full(shape.shape, 0.02)
    data = mf.modal_data(f, shape, model.sensors, frequency_std=0.01 * f, shape_std=std)
    bounds, nominal = dict.fromkeys(NAMES, (0.2, 5.0)), dict.fromkeys(NAMES, 1.0)
    problem = mf.updating_problem(model, data, groups, bounds, nominal)
    push = mf.PeakResponse("push", response=["floor1"], force="floor2", damping=0.02)
    how = mf.Identifiability(models=0)
    return mf.solve(
        problem,
        points=points,
        search=SEARCH,
        identifiability=how,
        predictions=[push],
        noise=noise,
    ).dataset


@pytest.fixture(scope="module")
def two() -> xr.Dataset:
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    return solved(groups, 4)


@pytest.fixture(scope="module")
def three() -> xr.Dataset:
    low, high = mf.Group("low", shape=[1]), mf.Group("high", shape=[2])
    without = mf.NoisePrior(weight=0)
    return solved([mf.Group("frequencies", frequency="all"), low, high], 2, without)


def said(data: xr.Dataset) -> list[str]:
    """Return the sentences of findings without details."""
    return list(map(str, findings_of(data)))


@pytest.mark.parametrize("width", [40, 80, 120])
@pytest.mark.parametrize("lists", [(), tuple(LISTS)])
def test_every_line_fits_and_nothing_is_cut(
    width: int,
    lists: tuple[str, ...],
    two: xr.Dataset,
    three: xr.Dataset,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    for data in (two, three):
        print_results(data, lists)
        out = capsys.readouterr().out
        assert "…" not in out
        words = " ".join(out.split())
        assert [line for line in out.splitlines() if len(line) > width] == []
        for label in data["label"].values if lists else ("nominal",):
            assert str(label) in words
        for name in ("k1", "story", "push"):
            assert name in words


def test_the_first_screen_sets_the_nominal_model_beside_the_reference_and_the_edges(
    two: xr.Dataset, capsys: pytest.CaptureFixture[str]
) -> None:
    print_results(two)
    out = capsys.readouterr().out
    row = next(line for line in out.splitlines() if line.startswith("  k1"))
    best = two["label"].values.tolist().index(two.attrs["reference"])
    std = two["sample_theta"].values[:, 0].std(ddof=1)
    assert row.split()[1] == "1.000"
    assert f"{two['theta'].values[best, 0]:#.4g} ± {std:.2g}" in row
    mode = next(line for line in out.splitlines() if line.startswith("  1: "))
    error = 100 * (two["frequency"].values[best, 0] / two["measured_frequency"].values[0] - 1)
    assert f"{error:+.2f}  {two['mac'].values[best, 0]:.3f}" in mode
    assert "hypervolume" not in out
    print_results(two, ["findings"])
    assert "hypervolume" in capsys.readouterr().out


def test_intervals_are_shown_with_what_their_chains_are_worth(
    two: xr.Dataset, capsys: pytest.CaptureFixture[str]
) -> None:
    print_results(two, ["uncertainty"])
    lines = capsys.readouterr().out.splitlines()
    row = [line.split() for line in lines if line.startswith("k1 ")][-1]
    low, _, high = two["interval"].values[0]
    r_hat, count = two["r_hat"].values[0], two["effective_draws"].values[0]
    assert row == ["k1", f"{low:#.4g}", f"{high:#.4g}", f"{r_hat:.3f}", f"{count:.0f}"]
    assert 0.9 < r_hat < 1.05
    assert 1 < count <= len(two["sample_theta"])


def test_no_deviation_is_shown_of_what_no_data_determine(
    two: xr.Dataset, capsys: pytest.CaptureFixture[str]
) -> None:
    known = two.drop_vars("sample_theta")
    print_results(known.assign(theta_std=xr.full_like(known["theta_std"], np.inf)))
    lines = capsys.readouterr().out.splitlines()
    (line,) = (x for x in lines if x.lstrip().startswith("k1 "))
    assert "±" not in line


def test_a_frequency_that_was_not_measured_is_none(
    two: xr.Dataset, capsys: pytest.CaptureFixture[str]
) -> None:
    measured = two["measured_frequency"].copy()
    measured[1] = np.nan
    print_results(two.assign(measured_frequency=measured), list(LISTS))
    out = capsys.readouterr().out
    assert "measured:" in out
    assert "nan" not in out


def test_pairs_that_change_on_a_lattice_are_said_once(three: xr.Dataset) -> None:
    paired = three["paired_mode"].values.copy()
    front = np.flatnonzero(three["kind"].values == "front")
    paired[front[1:], 0] = 2
    changed = three.assign(paired_mode=(("point", "mode"), paired))
    messages = [text for text in map(str, findings_of(changed, full=True)) if "paired with" in text]
    assert messages == [
        "measured mode 1 is paired with different model modes along the front: "
        f"2 at {front.size - 1}, 1 at 1 of {front.size} points"
    ]
    assert messages[0] in said(changed)


def test_many_points_are_counted_and_neighbours_joined(two: xr.Dataset) -> None:
    converged = np.ones(two.sizes["point"], dtype=bool)
    converged[:3] = False
    some = two.assign(converged=(("point",), converged))
    assert "not converged: nbi-1 to nbi-3" in list(map(str, findings_of(some, full=True)))


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "utf-8"])
def test_every_terminal_shows_names_and_obeys_none(
    encoding: str, two: xr.Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    written = io.BytesIO()
    stream = io.TextIOWrapper(written, encoding=encoding, newline="\n")
    monkeypatch.setattr("modefront.cli.show.Screen", partial(Screen, file=stream, width=80))
    labels = two["label"].values.astype(object)
    labels[0] = "\x1b]0;owned\x07[bold]\u202eθ"
    hostile = two.assign(label=(("point",), labels.astype(str)))
    hostile = hostile.assign_coords(parameter=["k\x1b[31m\n1", "名前"])
    print_results(hostile)
    print_results(hostile, list(LISTS))
    stream.flush()
    out = written.getvalue().decode(encoding)
    assert not {c for c in out if not c.isprintable()} - {"\n"}
    assert "[bold]" in out
    assert r"k\x1b[31m\n1" in out


def test_no_model_is_worse_than_the_sentence_on_all_models_says(two: xr.Dataset) -> None:
    measured = two["measured_frequency"].values
    frequency = np.where(two["frequency"].values > 0, 1.0104 * measured, np.nan)
    mac = np.full(frequency.shape, 0.9988)
    some = two.assign(frequency=(("point", "mode"), frequency), mac=(("point", "mode"), mac))
    (message,) = [line for line in said(some) if "Pareto-optimal models have" in line]
    assert "within 1.1 % of the measured ones and MAC values of 0.998 or more" in message


def wide(groups: int, parameters: int, modes: int) -> xr.Dataset:
    """Return results with names of a length and numbers of a size that a chain does not have."""
    rng = np.random.default_rng(groups + parameters + modes)
    names = [f"stiffness of storey {j}" for j in range(parameters)]
    of = [f"group {i} of {groups}" for i in range(groups)]
    labels = ["nominal", "optimal-weights", *(f"edge-{name}" for name in of)]
    kinds = ["nominal", "optimal-weights", *["edge"] * groups]
    n = len(labels)
    measured = np.sort(rng.uniform(1, 90, modes))
    theta = rng.uniform(0.3, 4.0, (n, parameters))
    return xr.Dataset(
        {
            "label": ("point", labels),
            "kind": ("point", kinds),
            "pareto": ("point", [False] + [True] * (n - 1)),
            "converged": ("point", [True] * n),
            "status": ("point", ["converged"] * n),
            "theta": (("point", "parameter"), theta),
            "theta_std": (("point", "parameter"), 0.05 * theta),
            "bounds": (("parameter", "bound"), np.tile([0.2, 5.0], (parameters, 1))),
            "measured_frequency": ("mode", measured),
            "frequency": (("point", "mode"), measured * rng.uniform(0.9, 1.1, (n, modes))),
            "mac": (("point", "mode"), rng.uniform(0.8, 1, (n, modes))),
            "paired_mode": (("point", "mode"), np.tile(np.arange(1.0, modes + 1), (n, 1))),
            "error": (("point", "group"), rng.uniform(0.01, 1, (n, groups))),
            "stationary_weight": (("point", "group"), np.full((n, groups), np.nan)),
            "finding": ("finding", [f"finding {i} " + 30 * "word " for i in range(20)]),
        },
        {"parameter": names, "group": of, "mode": np.arange(1, modes + 1)},
        {
            "reference": "optimal-weights",
            "front_is_a_point": False,
            "version": "0",
            "method": "nbi",
            "seed": 0,
            "study": "s",
        },
    )


def test_a_model_at_a_jump_is_one_to_beware_of_and_no_failure() -> None:
    data = wide(2, 3, 3)
    status = ["given", "converged", "converged", "jump"]
    data = data.assign(status=("point", status), converged=("point", [x != "jump" for x in status]))
    (jump,) = [line for line in said(data) if "jump" in line]
    assert "jump next to edge-group 1 of 2" in jump
    assert not any("not converged" in line for line in said(data))


@pytest.mark.parametrize(
    ("groups", "parameters", "modes"),
    [(2, 3, 3), (3, 17, 12), (7, 30, 20), (1, 60, 40)],
)
def test_the_first_screen_is_a_screen(
    groups: int, parameters: int, modes: int, capsys: pytest.CaptureFixture[str]
) -> None:
    data = wide(groups, parameters, modes)
    answer = "\n".join("Use this model. " + 60 * "x" for _ in range(11))
    print_results(data.assign_attrs(verdict=answer))
    assert len(capsys.readouterr().out.splitlines()) <= 31
    print_results(data)
    out = capsys.readouterr().out
    lines = out.splitlines()
    assert len(lines) <= 30
    assert max(map(len, lines)) <= 80
    assert "…" not in out
    words = " ".join(out.split())
    assert "next: modefront report DIRECTORY" in words
    assert "findings: modefront show DIRECTORY --findings" in words
    shown = sum(bool(re.match(r"  stiffness of storey \d+ +[\d.]+ ", line)) for line in lines)
    if shown < parameters:
        left = parameters - shown
        assert f"{left} more parameter{'s' * (left > 1)} that change" in words
        assert "modefront show DIRECTORY --models" in words
    print_results(data, ["models"])
    words = " ".join(capsys.readouterr().out.split())
    assert all(f"stiffness of storey {j} " in words for j in range(parameters))


def test_a_comparison_says_which_reference_is_not_to_be_used(
    two: xr.Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    of = {"one": two, "other": two.assign_attrs(reference="")}
    monkeypatch.setattr("modefront.results.compare.read_together", lambda _: list(of.items()))
    named = mf.compare(list(of)).rows["reference model"]
    assert named == [two.attrs["reference"], "most-probable, not to be used"]


def test_a_comparison_of_many_parameters_is_cut_with_a_word_on_the_rest(
    capsys: pytest.CaptureFixture[str],
) -> None:
    spreads = tuple(Spread(f"stiffness {j}", 0.5, 2.0, 1.0) for j in range(9))
    predictions = (Spread("frequency 1", 1.0, 2.0, 1.5), Spread("peak push", 3.0, 4.0, 3.5))
    fronts = [
        Summary(
            name, name, "nbi", 5, 99, 1.0, 1.0, (0.1, 0.2), 0.3, 0.4, "optimal-weights", 0.4,
            spreads, predictions,
        )
        for name in ("a/one", "b/two")
    ]  # fmt: skip
    names = tuple(spread.name for spread in spreads)
    pair = Apart("a/one", "b/two", names, 0.1, 0.2, 0.3, 0.3)
    comparison = Comparison(("frequencies", "shapes"), tuple(fronts), (pair,))
    print_comparison(comparison)
    out = capsys.readouterr().out
    assert len(out.splitlines()) <= 50
    assert max(map(len, out.splitlines())) <= 80
    assert "and 3 more parameters: modefront compare --all a/one b/two" in out
    assert "9 parameters" in out
    assert out.index("peak push") < out.index("frequency 1"), "what the study asks for comes first"
    print_comparison(comparison, every=True)
    out = capsys.readouterr().out
    assert "stiffness 8" in out
    assert "more parameters" not in out
