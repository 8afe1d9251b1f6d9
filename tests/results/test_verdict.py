"""Every sentence of the verdict is on its page, with an example, its meaning and what to do."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from modefront.datasets import Array, ArrayDataset
from modefront.findings import record
from modefront.findings.record import VERDICT, meaning_of
from modefront.front.point import Kind
from modefront.results.assemble import intervals, with_intervals
from modefront.results.findings import _scatter
from modefront.results.verdict import _closed, _front
from modefront.uncertainty.inference import Inference
from modefront.uncertainty.sampling import Draws
from modefront.uncertainty.scatter import LinearisationWarning

DOCS = Path(__file__).parents[2] / "docs"
DATA = ("frequency", "shape", "frequency_std", "shape_std")
TEXT = Path(record.__file__).with_name("verdicts.md").read_text(encoding="utf-8")
FORM = r"^### ([^\n]+)\n(?:<!-- [^\n]+ -->\n)?(.+?)(?=^##|\Z)"
SECTIONS = dict(re.findall(FORM, TEXT, re.MULTILINE | re.DOTALL))
HOW_TO = ("choose", "read-a-front", "modes-swap", "undetermined", "large-models")


def test_the_page_has_every_sentence_and_no_other() -> None:
    assert list(SECTIONS) == list(VERDICT)


@pytest.mark.parametrize("kind", VERDICT)
def test_the_example_is_what_the_sentence_says_and_advice_follows(kind: str) -> None:
    example, _, advice = SECTIONS[kind].partition("\n")
    assert re.fullmatch(VERDICT[kind].pattern, example.removeprefix("> "))
    assert len(advice.split()) > 5
    said = {name for name, x in VERDICT.items() if re.search(x.pattern, example)}
    assert {kind} <= said <= {kind, "far", "worse"}, "reasons are within the sentence"
    assert set(VERDICT[kind].meaning) <= set(meaning_of(example))


@pytest.mark.parametrize("name", HOW_TO)
def test_lines_to_paste_are_toml(name: str) -> None:
    lines_of_page(name, (DOCS / f"{name}.md").read_text(encoding="utf-8"))


def test_lines_to_paste_of_the_verdict_are_toml() -> None:
    lines_of_page("verdicts", TEXT)


def lines_of_page(name: str, text: str) -> None:
    """Read the lines to paste of a page."""
    lines = re.findall(r"^ *```toml\n(.*?)```", text, re.MULTILINE | re.DOTALL)
    assert lines or name == "read-a-front"
    for each in lines:
        assert tomllib.loads(each)


def test_an_interval_has_nine_of_ten_draws_and_the_most_probable_value() -> None:
    draws = np.random.default_rng(0).exponential(size=(4000, 5)) * [1, -1, 1, 1, -1]
    best = np.array([0, 0, 0.5, 0.02, -4.0])
    found = intervals(draws, best)
    inside = (draws >= found[:, 0]) & (draws <= found[:, 2])
    assert inside.mean(axis=0) == pytest.approx([0.9] * 5, abs=1e-3)
    assert found[0, 0] == 0 == found[1, 2]
    assert found[2, 0] == pytest.approx(-np.log(0.95), rel=0.2), "equal tails"
    assert found[3:, 0] == pytest.approx(best[3:], rel=0.02)


def test_a_bound_holds_a_parameter_where_no_search_beyond_it_converges() -> None:
    lower, upper = np.zeros(2), np.ones(2)
    of: Any = {"lower": lower, "upper": upper, "start": upper / 2, "priors": (None, None)}
    noise: Any = SimpleNamespace(problem=SimpleNamespace(objectives=(), **of), assumed="")
    draws = np.clip([0.5, 1.0] + 0.02 * np.random.default_rng(0).normal(size=(200, 2)), 0, 1)
    none, fit = np.zeros((200, 0)), {"misfit": np.ones(1), "nominal_misfit": np.ones(1)}
    fit |= {"lack_of_fit": np.full(1, np.nan)}
    found = Draws(draws, none, none, *np.ones((2, 2)))
    inference = Inference(found, fit, None, None, None, np.zeros((0, 1)))
    values = {
        "kind": (("point",), np.array(["most-probable"])),
        "theta": (("point", "parameter"), np.array([[0.5, 1.0]])),
        "at_bound": (("point", "parameter"), np.array([[0, 1]])),
        "error": (("point", "group"), np.ones((1, 1))),
        "bounds": (("parameter", "bound"), np.column_stack([lower, upper])),
    }
    data = ArrayDataset({name: Array(*x) for name, x in values.items()})
    assert with_intervals(data, noise, inference)["trust"].values.tolist() == [
        "determined",
        "partly",
    ]


def test_what_to_fix_is_what_check_names_and_never_all() -> None:
    draws, fixed = np.random.default_rng(0).normal(size=(200, 3)), ": fixed = true"
    nominal = np.ones((1, 3))
    values = {
        "kind": (("point",), np.array(["nominal"])),
        "parameter": (("parameter",), np.array(["k1", "k2", "k3"])),
        "theta": (("point", "parameter"), nominal),
        "sample_theta": (("draw", "parameter"), draws),
        "trust": (("parameter",), np.array(["not determined"] * 3)),
    }
    data = ArrayDataset({name: Array(*x) for name, x in values.items()})
    assert _closed(data, ()) == [f"k1{fixed}", f"k2{fixed}"]
    assert _closed(data, ["k3"]) == [f"k3{fixed}"]
    draws[:, 0] = -draws[:, 2]
    assert _closed(data, ["k3"]) == ['k3: tie = "k1"']
    nominal[0, 2] = 2.0  # a tied parameter has the nominal value of the other one
    assert _closed(data, ["k3"]) == [f"k3{fixed}"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ([0.1, 6.0], "of a change by 0.1 of those"),
        ([5.0, 6.0, 0.1], "of b change by 6 times"),
        ([0.2, 6.0, 0.1], "of a change by 0.2 of those"),
        ([0.3], "of a change by 0.3 of those"),
    ],
)
def test_a_front_is_a_compromise_where_two_groups_change(change: list[float], said: str) -> None:
    errors = np.array([np.full(len(change), np.nan), 0 * np.array(change), change])
    values = {
        "kind": (("point",), np.array(["most-probable", "front", "front"])),
        "group": (("group",), np.array(["a", "b", "c"][: len(change)])),
        "front_misfit": (("point", "group"), errors),
        "mac_mode": (("mode",), np.ones(1)),
        "paired_mode": (("point", "mode"), np.ones((3, 1))),
    }
    (found,) = _front(ArrayDataset({name: Array(*x) for name, x in values.items()}))
    assert said in found


def test_points_that_tables_leave_out_are_not_named_as_approximate() -> None:
    kinds = {"nbi-1": Kind.FRONT, "identifiable-2": Kind.IDENTIFIABLE, "nominal": Kind.NOMINAL}
    curved = SimpleNamespace(warnings=[LinearisationWarning.SADDLE])
    analysis: Any = SimpleNamespace(
        source="sets", scatter=dict.fromkeys(kinds, curved), posterior=None, replicates=[]
    )
    front: Any = SimpleNamespace(
        points=[SimpleNamespace(label=x, kind=k) for x, k in kinds.items()]
    )
    data = SimpleNamespace(**dict.fromkeys(DATA, np.ones((1, 1))))
    problem: Any = SimpleNamespace(data=data)
    said = [x for x in _scatter(problem, front, analysis) if x.kind == "approximate"]
    assert [x.subject for x in said] == ["nbi-1"]
