"""A report in Firefox, driven through WebDriver BiDi: headless, it has no WebGL."""

from __future__ import annotations

import asyncio
import csv
import json
import re
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from pages import HOSTILE, chain, hostile, written

from modefront.front.point import front_points

websocket = pytest.importorskip("tornado.websocket")

FIREFOX = Path("/usr/bin/firefox-esr")
AXE = Path(__file__).parents[2] / "report" / "node_modules" / "axe-core" / "axe.min.js"
PATIENCE = 180
"""Seconds after which the browser counts as dead."""

pytestmark = pytest.mark.skipif(not FIREFOX.exists(), reason="needs Firefox: /usr/bin/firefox-esr")


@dataclass
class Bidi:
    """A connection to the browser: commands with their answers, and events."""

    socket: Any
    context: str = ""
    events: list[dict[str, Any]] = field(default_factory=list)
    number: int = 0

    async def command(self, method: str, **params: Any) -> Any:
        """Return the result of a command."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        await self.socket.write_message(json.dumps(message))
        while True:
            answer = json.loads(await self.socket.read_message())
            if answer.get("type") == "event":
                self.events.append(answer)
            elif answer.get("id") == self.number:
                assert answer["type"] == "success", answer
                return answer["result"]

    async def evaluate(self, script: str) -> Any:
        """Return a text, a number or a truth that a script gives."""
        target = {"context": self.context}
        result = await self.command(
            "script.evaluate", expression=script, target=target, awaitPromise=True
        )
        assert result["type"] == "success", result
        return result["result"].get("value")

    async def keys(self, *keys: str) -> None:
        """Press keys, one after the other."""
        actions = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        source = {"type": "key", "id": "keyboard", "actions": actions}
        await self.command("input.performActions", context=self.context, actions=[source])

    async def pointer(self, *places: tuple[float, float]) -> None:
        """Press at the first place and release at the last one."""
        moves = [{"type": "pointerMove", "x": round(x), "y": round(y)} for x, y in places]
        actions = [moves[0], {"type": "pointerDown", "button": 0}, *moves[1:]]
        actions.append({"type": "pointerUp", "button": 0})
        source = {"type": "pointer", "id": "mouse", "actions": actions}
        await self.command("input.performActions", context=self.context, actions=[source])

    async def box(self, selector: str) -> list[float]:
        """Return left, top, width and height of an element, scrolled to the middle."""
        text = await self.evaluate(
            f"{{ const e = document.querySelector({json.dumps(selector)});"
            "e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect();"
            "JSON.stringify([b.x, b.y, b.width, b.height]) }"
        )
        out: list[float] = json.loads(text)
        return out

    @property
    def requests(self) -> list[str]:
        """Addresses that were asked for."""
        sent = [x["params"] for x in self.events if x["method"] == "network.beforeRequestSent"]
        return [x["request"]["url"] for x in sent]

    @property
    def messages(self) -> list[str]:
        """What was written on the console, warnings about WebGL apart."""
        logged = [x["params"] for x in self.events if x["method"] == "log.entryAdded"]
        texts = [str(x["text"]) for x in logged if x["level"] in ("error", "warn")]
        return [text for text in texts if "WebGL" not in text]


@contextmanager
def firefox(downloads: Path) -> Iterator[str]:
    """Start a browser with a profile of its own and yield the address of its socket."""
    profile = Path(tempfile.mkdtemp())
    settings = {
        "browser.download.folderList": 2,
        "browser.download.dir": str(downloads),
        "browser.download.useDownloadDir": True,
        "browser.download.manager.showWhenStarting": False,
        "browser.shell.checkDefaultBrowser": False,
        "datareporting.policy.dataSubmissionEnabled": False,
        "remote.active-protocols": 1,
    }
    lines = [f'user_pref("{key}", {json.dumps(value)});' for key, value in settings.items()]
    (profile / "user.js").write_text("\n".join(lines))
    command = [str(FIREFOX), "--headless", "--no-remote", "--profile", str(profile)]
    process = subprocess.Popen(
        [*command, "--remote-debugging-port", "0"],
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
    )
    assert process.stderr is not None
    # The browser waits where nobody reads what it says.
    reader = threading.Thread(target=process.stderr.read, daemon=True)
    try:
        for line in process.stderr:
            if result := re.search(r"WebDriver BiDi listening on (ws://\S+)", line):
                reader.start()
                yield f"{result[1]}/session"
                break
        else:
            pytest.skip("this Firefox does not offer WebDriver BiDi")
    finally:
        process.terminate()
        process.wait()
        if reader.ident:
            reader.join()
        process.stderr.close()
        shutil.rmtree(profile, ignore_errors=True)


MARKS = (
    "new Promise((done) => { const look = () => document.querySelector('circle.mark') ? "
    "done() : setTimeout(look, 50); look(); })"
)
"""Waits until a page is drawn."""


async def walk(address: str, file: Path, markup: Path, downloads: Path) -> None:
    """Open a report and do what a reader does."""
    socket = await websocket.websocket_connect(address, max_message_size=50_000_000)
    bidi = Bidi(socket)
    await bidi.command("session.new", capabilities={})
    tree = await bidi.command("browsingContext.getTree")
    bidi.context = tree["contexts"][0]["context"]
    await bidi.command("session.subscribe", events=["log.entryAdded", "network.beforeRequestSent"])
    await bidi.command(
        "browsingContext.setViewport",
        context=bidi.context,
        viewport={"width": 1200, "height": 900},
    )
    url = file.as_uri()
    await bidi.command("browsingContext.navigate", context=bidi.context, url=url, wait="complete")
    status = "document.querySelector('[role=status]').textContent"
    await bidi.evaluate(MARKS)
    labels = chain()["label"].values[front_points(chain())].tolist()

    assert await bidi.evaluate("document.title") == "three storeys"
    renderer = "document.querySelector('[aria-label=\"mode shape\"]').dataset.renderer"
    assert await bidi.evaluate(renderer) == "svg"
    assert await bidi.evaluate("document.querySelectorAll('svg.plain path').length") > 20

    await bidi.evaluate("document.getElementById('model').focus()")
    await bidi.keys("\ue011")  # Home
    assert await bidi.evaluate(status) == labels[0]
    await bidi.keys("\ue014", "\ue014")  # right arrow, twice
    assert await bidi.evaluate(status) == labels[2]

    x, y, width, height = await bidi.box(f"[aria-label=front] circle[data-label='{labels[4]}']")
    middle = (x + width / 2, y + height / 2)
    await bidi.pointer(middle, middle)
    assert await bidi.evaluate(status) == labels[4]

    x, y, width, height = await bidi.box("[aria-label=MAC] .brush .overlay")
    count = len(labels) // 2
    end = x + width * count / len(labels)
    await bidi.pointer((x + 1, y + 5), (x + width / 4, y + 30), (end, y + 60))
    half = f"{count} of {len(labels)} selected"
    assert half in await bidi.evaluate("document.querySelector('.brushed').textContent")
    assert await bidi.evaluate("document.querySelectorAll('[aria-label=front] .dimmed').length") > 0
    await bidi.keys("\ue00c")  # Escape
    assert (
        await bidi.evaluate("document.querySelectorAll('[aria-label=front] .dimmed').length") == 0
    )

    slide = "{ const s = document.getElementById('model'); s.value = 2;"
    await bidi.evaluate(slide + "s.dispatchEvent(new Event('input', {bubbles: true})); 0 }")
    assert await bidi.evaluate(status) == labels[1]

    await bidi.evaluate(
        "[...document.querySelectorAll('button')].find((b) => b.textContent === 'Download CSV')"
        ".click()"
    )
    kept = downloads / "three-storeys.csv"
    for _ in range(100):
        if kept.is_file() and kept.stat().st_size and not list(downloads.glob("*.part")):
            break
        await asyncio.sleep(0.1)
    with kept.open(encoding="utf-8", newline="") as stream:
        assert [row["model"] for row in csv.DictReader(stream)] == chain()["label"].values.tolist()

    if AXE.is_file():
        await bidi.evaluate(AXE.read_text(encoding="utf-8") + "\n;0")
        result = await bidi.evaluate(
            "axe.run().then((r) => JSON.stringify(r.violations.map((each) => each.id)))"
        )
        assert json.loads(result) == []
    url = markup.as_uri()
    await bidi.command("browsingContext.navigate", context=bidi.context, url=url, wait="complete")
    await bidi.evaluate(MARKS)
    assert HOSTILE in await bidi.evaluate("document.title"), "the title stays what it is"
    assert HOSTILE in await bidi.evaluate("document.querySelector('main').textContent")
    assert await bidi.evaluate("document.querySelectorAll('main script').length") == 0
    assert bidi.messages == []
    assert [
        each for each in bidi.requests if not each.startswith(("file:", "blob:", "data:"))
    ] == []
    await bidi.command("session.end")
    socket.close()


@pytest.mark.slow(3)
def test_a_report_in_firefox(tmp_path: Path) -> None:
    downloads = tmp_path / "downloads"
    downloads.mkdir()
    file = written(tmp_path, chain())
    (tmp_path / "markup").mkdir()
    markup = written(tmp_path / "markup", hostile())
    with firefox(downloads) as address:
        asyncio.run(asyncio.wait_for(walk(address, file, markup, downloads), PATIENCE))
