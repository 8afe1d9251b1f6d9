"""Pages of the documentation that are made from the program, or run by it."""

from __future__ import annotations

import importlib.util
import inspect
import re
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import modefront as mf
from modefront.front.point import Kind
from modefront.predictions import Passage, PeakResponse
from modefront.results.schema import ATTRIBUTES, DIMENSIONS, VARIABLES, variables_of

pytestmark = pytest.mark.usefixtures("short_chains")

DOCS = Path(__file__).parents[1] / "docs"
RESULTS = DOCS.parent / "src" / "modefront" / "results" / "results.md"


def script(name: str) -> ModuleType:
    """Return a script of the documentation as a module."""
    spec = importlib.util.spec_from_file_location(name, DOCS / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_of_results_has_every_variable() -> None:
    text = RESULTS.read_text(encoding="utf-8")
    assert script("make_tables").page(RESULTS, text) == text, "run: python docs/make_tables.py"
    for name in (*variables_of((PeakResponse.kind, Passage.kind)), *ATTRIBUTES):
        assert f"| `{name}`" in text
    of = VARIABLES["candidate_frequency"]
    assert (of.dimensions, of.values, of.unit, of.required) == (
        ("candidate",),
        "number",
        "Hz",
        False,
    )
    assert VARIABLES["collinearity_index"].dimensions == ()
    assert (VARIABLES["theta"].unit, VARIABLES["pareto"].values) == ("", "truth")
    assert {x for each in VARIABLES.values() for x in each.dimensions} <= set(DIMENSIONS)


def test_the_page_of_the_study_file_is_what_its_reader_makes() -> None:
    text = (DOCS / "study-file.md").read_text(encoding="utf-8")
    made = script("make_tables").page(DOCS / "study-file.md", text)
    assert made == text, "run: python docs/make_tables.py"


def test_the_page_of_results_lists_every_kind_of_models() -> None:
    text = RESULTS.read_text(encoding="utf-8")
    models = text[text.index("## Models") : text.index("| variable |")]
    assert re.findall(r"^\| `([a-z-]+)` \|", models, re.MULTILINE) == [
        kind.value for kind in sorted(Kind, key=lambda kind: kind is Kind.NOMINAL)
    ]


def test_a_page_without_a_table_of_the_schema_is_refused() -> None:
    with pytest.raises(ValueError, match="expected one table each"):
        script("make_tables").page(RESULTS, "<!-- table: Models -->\n<!-- end -->\n")


def test_what_is_between_the_comments_is_replaced_and_nothing_else() -> None:
    make = script("make_tables")
    text = RESULTS.read_text(encoding="utf-8")
    spoiled = text.replace("| `frf_peak` ", "| `frf_0` ")
    assert spoiled != text
    assert make.page(RESULTS, spoiled) == text
    assert make.page(RESULTS, "by hand\n" + text) == "by hand\n" + text


def blocks(page: Path) -> list[tuple[str, str]]:
    """Return the code blocks of a page with the output that is printed behind each."""
    text = page.read_text(encoding="utf-8")
    pattern = r"```python\n(.*?)```\n(?:\n```text\n(.*?)```\n)?"
    return re.findall(pattern, text, re.DOTALL)


def test_the_page_of_pictures_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for code, _ in blocks(DOCS / "plots.md"):
        exec(compile(code, "docs/plots.md", "exec"), {})
    assert {path.name for path in tmp_path.iterdir()} == {"front.png", "modes.pdf", "modes.vtu"}


def test_the_prediction_of_the_page_can_be_made() -> None:
    names: dict[str, object] = {"__name__": __name__}
    for code, _ in blocks(DOCS / "predictions.md"):
        text = code.replace("@mf.register\n", "")
        exec(compile(text, "docs/predictions.md", "exec", dont_inherit=True), names)
    period: Any = names["Period"]
    assert period("slow", 2).places == ("slow: mode 2",)


@pytest.mark.slow(5)
@pytest.mark.parametrize(("page", "count"), [("python.md", 12), ("extend.md", 3)])
def test_the_cells_of_pages_in_python_run(
    page: str, count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = (DOCS / page).read_text(encoding="utf-8")
    cells = re.findall(r"```{code-cell}\n((?!:tags:).*?)```\n", text, re.DOTALL)
    assert len(cells) == count
    names: dict[str, Any] = {}
    for code in cells:
        exec(compile(code, f"docs/{page}", "exec"), names)


def part(caption: str) -> list[Path]:
    """Return the pages of a part of the site."""
    index = (DOCS / "index.md").read_text(encoding="utf-8")
    (listed,) = re.findall(rf":caption: {caption}\n:maxdepth: 1\n(.*?)```", index, re.DOTALL)
    return [DOCS / f"{name}.md" for name in listed.split()]


def test_no_page_that_teaches_is_long() -> None:
    for page in [*part("Tutorials"), *part("How to")]:
        words = len(page.read_text(encoding="utf-8").split())
        assert words <= 1500, f"{page}: {words} words"


def test_a_page_of_theory_has_equations_sources_and_the_code_that_has_them() -> None:
    labels: list[str] = []
    for page in part("Theory"):
        text = page.read_text(encoding="utf-8")
        made = re.findall(r"^\$\$.*?\$\$ \((eq-[a-z]+)\)$", text, re.MULTILINE | re.DOTALL)
        assert len(made) == text.count("$$") / 2 >= 2, f"{page}: equations without a number"
        assert "doi:10." in text, page
        modules = re.findall(r"\]\(([./]*src/modefront/[a-z0-9_/]+\.py)\)", text)
        assert modules, page
        assert all((page.parent / module).is_file() for module in modules), page
        assert len(text.split()) <= 1200, page
        labels += made
    assert len(set(labels)) == len(labels)
    for page in DOCS.rglob("*.md"):
        used = re.findall(r"\{eq\}`([^`]*)`", page.read_text(encoding="utf-8"))
        assert set(used) <= set(labels), page


def test_no_page_names_the_problems_that_decided_something() -> None:
    names = r"\b(frame|concrete|steel|rugged|chain|jumps)-\d+\b|(?<!-)\bseeds? \d+"
    for page in DOCS.rglob("*.md"):
        assert not re.search(names, page.read_text(encoding="utf-8")), page


def test_every_public_name_is_on_the_page_of_python() -> None:
    text = (DOCS / "reference-python.md").read_text(encoding="utf-8")
    block = r"^\.\. automodule:: (\S+)\n((?:   :.*\n)*)"
    shown = dict(re.findall(block, text, re.MULTILINE))
    for module, names in (("modefront", mf.__all__), ("modefront.fem", mf.fem.__all__)):
        assert {":members:", ":imported-members:"} <= set(shown[module].split())
        values = [getattr(mf if module == "modefront" else mf.fem, name) for name in names]
        for name, value in zip(names, values, strict=True):
            made = inspect.ismodule(value) or isinstance(value, type) or inspect.isroutine(value)
            assert made or re.search(rf"^\.\. py:\w+:: {name}$", text, re.MULTILINE), name
        left_out = set(re.findall(r":exclude-members: (.*)", shown[module])[0].split(", "))
        assert left_out < set(names)
        assert {f"{module}.{name}" for name in left_out} <= set(shown)
