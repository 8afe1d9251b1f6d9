"""Frames a second of an animated mode shape: python benchmarks/report_frames.py RESULTS.

Needs Chromium. Without a GPU the number is that of a software renderer, and says little.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from modefront.reports.page import page as page_with
from modefront.reports.page import write_html
from modefront.results.files import read_dataset

ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
COUNT = """
() => new Promise((done) => {
  const times = [];
  const next = (now) => {
    times.push(now);
    if (now - times[0] < 3000) requestAnimationFrame(next);
    else done(1000 * (times.length - 1) / (now - times[0]));
  };
  requestAnimationFrame(next);
})
"""


def frames(results: Path) -> float:
    """Return the frames a second while the mode shape of a report moves."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        file = Path(folder) / "report.html"
        write_html(page_with([(results.name, read_dataset(results))]), file)
        browser = playwright.chromium.launch(
            executable_path=Path("/usr/bin/chromium"), args=ARGUMENTS
        )
        page = browser.new_page()
        page.goto(file.as_uri())
        page.get_by_role("button", name="Animate").click()
        rate: float = page.evaluate(COUNT)
        browser.close()
        return rate


if __name__ == "__main__":
    print(f"{frames(Path(sys.argv[1])):.1f} frames a second")
