"""The page of all comparisons is what its script makes, but for what is measured."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import calibration
import check
import concrete_frame
import elements
import nafems
import numpy as np
import pytest
import rugged
import verify

PAGE = Path(__file__).parents[1] / "docs" / "verification.md"
PEERS = "identification_beside_ema", "identification_beside_oma"
EVALUATIONS = re.compile(r", \d+ evaluations$")


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is computed: every comparison finds something at once."""
    import three_story

    def replaced(where: Any, name: str, value: Any) -> None:
        monkeypatch.setattr(where, name, lambda *_: value)

    replaced(three_story, "command", None)
    replaced(three_story, "front", {key: np.ones(9) for key in three_story.PUBLISHED["M0"]})
    replaced(nafems, "differences", (None, np.zeros(1)))
    replaced(elements, "relative", np.zeros(1))
    replaced(calibration, "judged", [SimpleNamespace(held=True)])
    replaced(check, "spoilt_case", SimpleNamespace(made=["k1"]))
    replaced(check, "diagnosed", [(["k1"], None)])
    replaced(concrete_frame, "run", 1)
    replaced(rugged, "compare", SimpleNamespace(others={"a": 1}, truth=1, evaluations=9, volume=1))
    replaced(verify, "noisy", np.zeros(1))
    found = SimpleNamespace(found=1, errors=np.ones(3))
    beside = SimpleNamespace(
        ORDERS=(1,),
        by_modefront=lambda *_: None,
        by_ema=lambda _: lambda *_: None,
        errors=lambda *_: np.ones(3),
        compare=lambda _: {"modefront": found, "other": found},
    )
    for name in PEERS:
        monkeypatch.setitem(sys.modules, name, beside)


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("installed", [True, False])
def test_the_page_has_the_parts_and_rows_that_the_script_makes(
    installed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in () if installed else PEERS:
        monkeypatch.setitem(sys.modules, name, None)
    text = PAGE.read_text(encoding="utf-8")
    _, *parts = re.split(r"^(?=## )", text, flags=re.MULTILINE)
    assert len(parts) == len(verify.PARTS)
    for part, shown in zip(verify.PARTS, parts, strict=True):
        assert shown.startswith(verify.heading(part))
        rows = shown.removeprefix(verify.heading(part)).strip().splitlines()[2:]
        names = [EVALUATIONS.sub("", row.split(" | ")[0].strip("| ")) for row in rows]
        assert names == [EVALUATIONS.sub("", row.what) for row in part.rows()], part.title


def test_the_page_counts_what_holds() -> None:
    text = PAGE.read_text(encoding="utf-8")
    verdicts = re.findall(r" \| (holds|\*\*falls short\*\*|not compared) \|$", text, re.MULTILINE)
    assert f"{verdicts.count('holds')} of {len(verdicts)} comparisons hold." in text
