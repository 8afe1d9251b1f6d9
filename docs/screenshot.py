"""Takes the picture of a report in the README: python docs/screenshot.py [results].

Needs Chromium at /usr/bin/chromium. Without the folder of results, the three-story example with its
predictions is run first (seconds of work).
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

import modefront as mf
from modefront.reports.page import page as page_with
from modefront.reports.page import write_html
from modefront.results.files import read_dataset
from modefront.study.examples import write_example

HERE = Path(__file__).parent
CHROMIUM = Path("/usr/bin/chromium")
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
POINT = 14
"""Point of the front that is chosen."""


def example(folder: Path) -> Path:
    """Run the three-story example with its predictions and return the folder of its results."""
    write_example("three-story-c0", folder)
    study = folder / "study.toml"
    predictions = (HERE / "predictions.toml").read_text(encoding="utf-8")
    study.write_text(study.read_text(encoding="utf-8") + predictions, encoding="utf-8")
    mf.run(mf.load(study), folder / "results")
    return folder / "results"


def screenshot(results: Path, file: Path, target: Path) -> None:
    """Write the report of results into a file, and the picture of its views."""
    write_html(page_with([(results.name, read_dataset(results))]), file)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        page = browser.new_page(viewport={"width": 1240, "height": 800})
        page.goto(file.as_uri())
        page.get_by_role("slider", name="model").fill(str(POINT))
        page.locator(".walker").evaluate("(bar) => window.scrollTo(0, bar.offsetTop - 12)")
        page.wait_for_timeout(500)
        page.screenshot(path=target)
        browser.close()


def main() -> None:
    """Write docs/report.png."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        results = Path(sys.argv[1]) if len(sys.argv) > 1 else example(folder)
        screenshot(results, folder / "report.html", HERE / "report.png")


if __name__ == "__main__":
    main()
