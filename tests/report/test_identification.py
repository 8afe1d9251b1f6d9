"""The page of an identification."""

import base64
import gzip
import json
import re
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import sync_playwright

from modefront.errors import InputError
from modefront.identification.modal_test import identify
from modefront.reports.identification import write_identification
from modefront.study.examples import write_example

CHROMIUM = Path("/usr/bin/chromium")


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("test")
    write_example("hammer-test", folder)
    test = folder / "test-m0.toml"
    places = "\n".join(f"floor{k} = [0, 0, {k}, 1, 0, 0]" for k in (1, 2, 3))
    text, _ = test.read_text(encoding="utf-8").split('[[set]]\nname = "set2"')
    test.write_text(f"{text}\n[geometry]\n{places}\n", encoding="utf-8")
    return write_identification(identify(test, drop=[2], seeds=[18.5]), folder / "page.html")


def content(page: Path) -> Any:
    (data,) = re.findall(r'id="data">(.*?)</script>', page.read_text(encoding="utf-8"), re.DOTALL)
    return json.loads(gzip.decompress(base64.b64decode(data)))


def test_the_page_is_small_and_holds_what_was_identified(written: Path) -> None:
    assert written.stat().st_size < 1e6
    report = content(written)
    first = report["sets"][0]
    chosen = [(mode["number"], mode["seed"]) for mode in first["modes"]]
    assert sorted(chosen, key=str) == [(1, None), (3, None), (None, 18.5)], "numbers of the table"
    assert first["positions"] == [[0, 0, 1], [0, 0, 2], [0, 0, 3]]
    assert first["directions"][0] == [1, 0, 0]
    assert len(first["complexIndicators"]) == len(first["multivariateIndicators"]) == 2
    assert len(first["functions"]) == 6


def test_a_page_that_is_no_html_is_refused(written: Path) -> None:
    test = identify(written.with_name("m0-set1-floor3.csv"))
    with pytest.raises(InputError, match=r"ends in \.html"):
        write_identification(test, written.with_name("page.txt"))


@pytest.mark.slow(5)
@pytest.mark.skipif(not CHROMIUM.exists(), reason="needs Chromium: /usr/bin/chromium")
def test_clicks_write_the_lines_for_the_test_file(written: Path) -> None:
    said: list[str] = []
    with sync_playwright() as started:
        browser = started.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 390, "height": 844})
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(written.as_uri())
        for name in ("stabilisation diagram", "modes", "mode indicators", "functions"):
            page.get_by_role("region", name=name, exact=True).wait_for()
        lines = page.get_by_label("lines for the test file")
        page.get_by_role("button", name="leave out mode 3").press("Enter")
        page.get_by_role("button", name="leave out mode at 18.5 Hz").press("Enter")
        assert lines.inner_text().splitlines() == ["[identify]", "drop = [2, 3]"]
        page.get_by_role("button", name="leave out mode 3").press("Enter")
        page.evaluate(
            """() => {
              const marks = [...document.querySelectorAll("circle.mark")];
              marks[marks.length - 1].dispatchEvent(new MouseEvent("click"));
            }"""
        )
        assert re.match(r"\[identify\]\ndrop = \[2", lines.inner_text())
        before = page.locator(".stage circle").first.get_attribute("cx")
        page.wait_for_function(  # the shape moves
            "x => document.querySelector('.stage circle').getAttribute('cx') !== x", arg=before
        )
        long = "x => { x.textContent = '# lines that wrap '.repeat(9); "
        assert lines.evaluate(long + "return document.documentElement.scrollWidth }") == 390
        browser.close()
    assert said == []
