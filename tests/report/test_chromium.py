"""A report in Chromium: it is opened from disk, looked at, walked along and listened to."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import pytest
from pages import HOSTILE, ROOT, chain, hostile, many_modes, mesh, three_groups, written
from playwright.sync_api import Browser, FloatRect, Locator, Page, Playwright, sync_playwright

from modefront.front.point import front_points

CHROMIUM = Path("/usr/bin/chromium")
AXE = ROOT / "report" / "node_modules" / "axe-core" / "axe.min.js"
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]

pytestmark = [
    pytest.mark.slow(2),
    pytest.mark.skipif(not CHROMIUM.exists(), reason="needs Chromium: /usr/bin/chromium"),
]


@dataclass
class Opened:
    """A page, with what it has said and asked for."""

    page: Page
    messages: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def view(self, name: str) -> Locator:
        return self.page.get_by_role("region", name=name, exact=True)

    def box(self, locator: Locator, *, scroll: bool = True) -> FloatRect:
        """Return where an element is, scrolled to the middle of the window."""
        if scroll:
            locator.evaluate("(element) => element.scrollIntoView({ block: 'center' })")
        box = locator.bounding_box()
        assert box is not None
        return box

    @property
    def chosen(self) -> str:
        return self.page.get_by_role("status").inner_text()


@pytest.fixture(scope="module")
def playwright() -> Iterator[Playwright]:
    with sync_playwright() as started:
        yield started


@pytest.fixture(scope="module")
def chromium(playwright: Playwright) -> Iterator[Browser]:
    browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
    yield browser
    browser.close()


Scheme = Literal["light", "dark"]
Open = Callable[..., Opened]


@pytest.fixture
def opened(chromium: Browser) -> Iterator[Open]:
    pages: list[Opened] = []

    def open_(file: Path, *, width: int = 1280, scheme: Scheme = "light") -> Opened:
        page = chromium.new_page(
            viewport={"width": width, "height": 900}, color_scheme=scheme, accept_downloads=True
        )
        out = Opened(page)
        page.on("console", lambda message: out.messages.append(message.text))
        page.on("pageerror", lambda error: out.messages.append(str(error)))
        page.on("request", lambda request: out.requests.append(request.url))
        page.goto(file.as_uri())
        page.get_by_role("status").wait_for()
        pages.append(out)
        return out

    yield open_
    for each in pages:
        each.page.close()
        assert each.messages == [], "nothing on the console"
        assert [url for url in each.requests if not url.startswith(("file:", "blob:"))] == []
        assert len([url for url in each.requests if url.startswith("file:")]) == 1


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("chain"), chain())


@pytest.fixture(scope="module")
def labels() -> list[str]:
    """Return the labels of the front of the chain, in its order."""
    return list(chain()["label"].values[front_points(chain())])


def test_every_view_has_its_name(report: Path, opened: Open) -> None:
    page = opened(report)
    for name in ("front", "parameters", "frequencies", "MAC", "mode shape", "predictions"):
        assert page.view(name).is_visible()
    assert page.page.title() == "three storeys"
    assert page.view("mode shape").get_attribute("data-renderer") == "webgl"
    assert "0123abcd" in page.view("how to cite").inner_text()
    data, beside = chain(), page.view("tables").inner_text()
    best = data["theta"].values[data["label"].values.tolist().index(data.attrs["reference"]), 0]
    assert f"{best:#.4g} ± {data['posterior_std'].values[0]:#.2g}" in beside, "as in `show`"
    assert f"standard deviation of the posterior at {data.attrs['reference']}" in beside


def test_the_slider_and_arrow_keys_walk_along_the_front(
    report: Path, opened: Open, labels: list[str]
) -> None:
    page = opened(report)
    slider = page.page.get_by_role("slider", name="model", exact=True)
    slider.press("Home")
    assert page.chosen == labels[0]
    for label in labels[1:]:
        slider.press("ArrowRight")
        assert page.chosen == label
    assert slider.get_attribute("aria-valuetext") == labels[-1]
    slider.fill("3")
    assert page.chosen == labels[2]
    page.page.get_by_role("heading", level=1).click()
    page.page.keyboard.press("ArrowLeft")
    assert page.chosen == labels[1]
    page.page.get_by_role("button", name="next model").click()
    assert page.chosen == labels[2]


def test_a_click_in_one_view_chooses_in_all(report: Path, opened: Open, labels: list[str]) -> None:
    page = opened(report)
    label = labels[3]
    page.view("front").locator(f"circle[data-label='{label}']").click()
    assert page.chosen == label
    assert label in page.view("mode shape").inner_text()
    assert label in page.view("tables").locator("thead").first.inner_text()
    k1 = float(chain()["theta"].values[front_points(chain())[3], 0])
    assert f"{k1:.4g}" in (page.view("parameters").locator(".value").first.text_content() or "")
    page.view("predictions").locator(f"circle[data-label='{labels[5]}']").first.click()
    assert page.chosen == labels[5]
    page.page.get_by_role("button", name="nominal", exact=True).click()
    assert page.chosen == "nominal"


def test_a_brush_in_one_view_shows_in_all(report: Path, opened: Open, labels: list[str]) -> None:
    page = opened(report)
    box = page.box(page.view("MAC").locator(".brush .overlay"))
    page.page.mouse.move(box["x"] + 1, box["y"] + 5)
    page.page.mouse.down()
    page.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 60, steps=4)
    page.page.mouse.up()
    half = len(labels) // 2
    clear = page.page.get_by_text(f"{half} of {len(labels)} selected")
    assert clear.is_visible()
    for name in ("front", "predictions"):
        marks = page.view(name).locator("svg").first.locator("circle.mark")
        dimmed = [
            "dimmed" in (marks.nth(k).get_attribute("class") or "") for k in range(marks.count())
        ]
        assert dimmed == [label not in labels[:half] for label in labels]
    clear.click()
    assert page.view("front").locator(".dimmed").count() == 0


def test_a_brush_of_the_front_and_escape(report: Path, opened: Open) -> None:
    page = opened(report)
    box = page.box(page.view("front").locator(".brush .overlay"))
    page.page.mouse.move(box["x"] + 2, box["y"] + 2)
    page.page.mouse.down()
    page.page.mouse.move(box["x"] + box["width"] - 2, box["y"] + box["height"] / 2, steps=4)
    page.page.mouse.up()
    assert page.page.get_by_text("selected – clear").is_visible()
    assert page.view("parameters").locator(".dimmed").count() > 0
    page.page.keyboard.press("Escape")
    assert page.page.get_by_text("selected – clear").is_hidden()


def test_an_aspiration_picks_the_nearest_model(report: Path, opened: Open) -> None:
    page = opened(report)
    data = chain()
    form = page.view("aspiration")
    form.get_by_label("frequencies within").fill("50")
    form.get_by_label("MAC above").fill("0.5")
    form.get_by_role("button", name="Find").click()
    assert "meets this" in form.inner_text()
    form.get_by_label("frequencies within").fill("0.001")
    form.get_by_label("MAC above").fill("0.9999")
    form.get_by_role("button", name="Find").click()
    assert "comes nearest" in form.inner_text()
    # Dragged to the least error of the frequencies, whatever the shapes: their edge.
    goal = page.view("front").locator(".goal")
    plot = page.box(page.view("front").locator(".brush .overlay"))
    box = page.box(goal.locator(".grip"), scroll=False)
    page.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.page.mouse.down()
    page.page.mouse.move(plot["x"] + 1, plot["y"] + 1, steps=5)
    page.page.mouse.up()
    best = data.isel(point=data["pareto"].values)  # edges and weighted models too
    assert page.chosen == best["label"].values[best["error"].values[:, 0].argmin()]
    assert "Nearest to the aspiration point" in form.inner_text()


def test_axes_and_modes_are_changed(report: Path, opened: Open) -> None:
    page = opened(report)
    front = page.view("front")
    front.get_by_text("objective J", exact=True).click()
    assert "J of shapes" in (front.locator("svg").first.text_content() or "")
    front.get_by_text("log", exact=True).click()
    page.view("mode shape").get_by_label("measured mode").select_option("2")
    measured = f"{chain()['measured_frequency'].values[2]:.2f} Hz"
    assert measured in page.view("mode shape").inner_text()


def test_nothing_moves_before_it_is_asked_to(report: Path, opened: Open) -> None:
    page = opened(report)
    stage = page.view("mode shape").locator(".stage")
    stage.scroll_into_view_if_needed()
    assert page.page.evaluate("document.getAnimations().length") == 0
    before = stage.screenshot()
    page.page.wait_for_timeout(300)
    assert stage.screenshot() == before
    play = page.view("mode shape").get_by_role("button", name="Animate")
    play.click()
    page.page.wait_for_timeout(700)
    assert stage.screenshot() != before
    page.view("mode shape").get_by_role("button", name="Stop").click()
    assert stage.screenshot() == before


def test_the_table_of_all_models_is_downloaded(report: Path, opened: Open) -> None:
    page = opened(report)
    with page.page.expect_download() as waiting:
        page.view("tables").get_by_role("button", name="Download CSV").click()
    download = waiting.value
    assert download.suggested_filename == "three-storeys.csv"
    with Path(download.path()).open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    data = chain()
    assert [row["model"] for row in rows] == data["label"].values.tolist()
    assert [float(row["k1"]) for row in rows] == data["theta"].values[:, 0].tolist()
    assert [float(row["MAC 2"]) for row in rows] == data["mac"].values[:, 1].tolist()


def test_names_with_markup_stay_text(tmp_path: Path, opened: Open) -> None:
    page = opened(written(tmp_path, hostile()))
    assert page.page.title() == f"</title>{HOSTILE}"
    assert page.page.locator("body script").count() == 0
    assert HOSTILE in page.view("parameters").inner_text() or (
        HOSTILE in page.view("tables").inner_text()
    )
    page.view("tables").locator("summary").click()
    assert HOSTILE in page.view("tables").inner_text()


def test_long_names_are_shown_whole_and_pairs_are_outlined(tmp_path: Path, opened: Open) -> None:
    names = ["stiffness of the columns of the first storey", "k" * 60, "k3"]
    page = opened(written(tmp_path, chain().assign_coords(parameter=names)))
    texts = page.view("parameters").locator("text.name")
    texts.nth(len(names) - 1).wait_for()  # pictures are drawn again once their width is known
    for name, text in zip(names, texts.all(), strict=True):
        lines = text.locator("tspan").all_text_contents()
        assert "".join(lines).replace(" ", "") == name.replace(" ", "")
        box = text.bounding_box()
        assert box is not None
        assert box["x"] >= 0
    assert page.view("MAC").locator("td.paired").count() == chain().sizes["mode"]


def test_a_mesh_is_deformed(tmp_path: Path, opened: Open) -> None:
    page = opened(written(tmp_path, mesh()))
    view = page.view("mode shape")
    assert view.get_attribute("data-renderer") == "webgl"
    names = view.locator(".overlay text").all_text_contents()
    assert set(names) == {"corner", "edge", "middle"}
    turned = view.locator(".stage").screenshot()
    view.locator(".stage").press("ArrowUp")
    assert view.locator(".stage").screenshot() != turned


def test_three_groups_have_parallel_coordinates_and_pairs(tmp_path: Path, opened: Open) -> None:
    page = opened(written(tmp_path, three_groups()))
    front = page.view("front")
    assert front.locator("svg").count() >= 1 + 3
    assert front.locator("path.across").count() == len(front_points(three_groups()))
    tops = front.locator(".pairs svg").evaluate_all(
        "(all) => all.map((x) => x.getBoundingClientRect().top)"
    )
    assert tops[0] == tops[1] < tops[2], "two in a row, whatever part of a pixel the card has"
    shape = page.view("mode shape")
    assert "they stand in their order" in shape.inner_text()
    assert shape.locator(".overlay text").all_text_contents() == ["deck", "pier"]
    stage, arrows = shape.locator(".stage"), shape.locator(".pointer")
    assert arrows.count() == 2 * (1 + 2)  # the model and two data sets at each of two sensors
    inside = "(all, box) => all.every((x) => { const r = x.getBoundingClientRect(); "
    inside += "return r.left >= box.x && r.right <= box.x + box.width; })"
    assert arrows.evaluate_all(inside, stage.bounding_box())
    mark = front.locator(".pairs circle.mark").last
    mark.click()
    assert page.chosen == mark.get_attribute("data-label")


def test_several_fronts_are_in_one_report(tmp_path: Path, opened: Open, labels: list[str]) -> None:
    other = chain().assign_attrs(study="another one")
    page = opened(written(tmp_path, chain(), other))
    assert page.view("front").locator("circle.mark").count() == 2 * len(labels)
    assert "three storeys" in page.view("summary").inner_text()
    page.page.get_by_label("study", exact=True).select_option("1")
    assert "another one" in page.view("summary").inner_text()
    page.view("front").locator(f"circle[data-label='{labels[2]}']").last.click()
    assert page.chosen == labels[2]


def test_without_webgl_shapes_are_drawn_as_svg(playwright: Playwright, report: Path) -> None:
    arguments = ["--no-sandbox", "--disable-3d-apis"]
    browser = playwright.chromium.launch(executable_path=CHROMIUM, args=arguments)
    page = browser.new_page()
    page.goto(report.as_uri())
    view = page.get_by_role("region", name="mode shape", exact=True)
    view.wait_for()
    assert view.get_attribute("data-renderer") == "svg"
    view.locator("svg.plain path").nth(20).wait_for(state="attached")
    browser.close()


@pytest.mark.slow(8)
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 360])
def test_a_page_fits_and_axe_finds_nothing(
    scheme: Scheme, width: int, report: Path, opened: Open
) -> None:
    page = opened(report, width=width, scheme=scheme)
    inner = page.page.evaluate("[document.documentElement.scrollWidth, innerWidth]")
    assert inner[0] <= inner[1]
    if not AXE.is_file():
        pytest.skip("needs axe-core: npm ci, in the folder report")
    for summary in page.page.locator("details > summary").all():  # outer ones come first
        summary.click()
    page.page.evaluate(AXE.read_text(encoding="utf-8"))
    result = page.page.evaluate("axe.run().then((result) => result.violations)")
    assert [(each["id"], [node["html"] for node in each["nodes"]]) for each in result] == []


def test_nothing_overlaps_on_a_phone_and_on_paper(tmp_path: Path, opened: Open) -> None:
    page = opened(written(tmp_path, many_modes()), width=390)
    cells = page.view("MAC").locator("tbody td")
    assert cells.count() == 8 * 8
    wide = "(all) => all.filter((x) => x.scrollWidth > x.clientWidth).length"
    assert cells.evaluate_all(wide) == 0
    for summary in page.page.locator("details > summary").all():  # outer ones come first
        summary.click()
    page.page.emulate_media(media="print")
    boxes = page.page.locator(".scroll")
    assert boxes.count() >= 3
    cut = "(all) => all.filter((x) => x.scrollHeight > x.clientHeight).length"
    assert boxes.evaluate_all(cut) == 0
