"""A browser for the replay page."""

import base64
import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from irlx.report.replay.page import page_of
from made_page import made_data

ARGUMENTS = (
    "--no-sandbox",
    "--disable-gpu",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)


@pytest.fixture(scope="session")
def browser():
    """Chromium of the machine, which draws WebGL by software."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("chromium is not installed")
    api = pytest.importorskip("playwright.sync_api", reason="playwright: pip install irlx[browser]")
    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=list(ARGUMENTS))
        yield browser
        browser.close()


class Opened:
    """A page that has drawn itself, and what it has asked for and said on the way."""

    def __init__(self, page):
        self.page = page
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self._listeners = {
            "request": lambda request: self.requests.append(request.url),
            "pageerror": lambda error: self.complaints.append(str(error)),
            "console": self._hear,
        }
        for event, listener in self._listeners.items():
            page.on(event, listener)

    def leave(self):
        """Hear nothing any more: the tab is used again."""
        for event, listener in self._listeners.items():
            self.page.remove_listener(event, listener)

    def _hear(self, message):
        # The driver, not the page, warns that pictures are read back from the (software) graphics card.
        if message.type in ("error", "warning") and "GPU stall" not in message.text:
            self.complaints.append(message.text)

    def run(self, script, *arguments):
        """Value of a script in the page."""
        return self.page.evaluate(script, *arguments)

    def seek(self, frame):
        """Move the slider, as a person does, and wait until the scene is drawn."""
        self.run(
            """frame => {
                const slider = document.getElementById('slider');
                slider.value = String(frame);
                slider.dispatchEvent(new Event('input', { bubbles: true }));
            }""",
            frame,
        )
        self.settle()

    def settle(self):
        """Wait until what has been asked for is drawn."""
        self.run("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def colours(self, selector):
        """How many different colours a part of the page has, and its mean colour, of a picture of it."""
        picture = self.page.locator(selector).first.screenshot()
        return self.run(STATISTICS, base64.b64encode(picture).decode("ascii"))


STATISTICS = """async coded => {
    const image = new Image();
    image.src = 'data:image/png;base64,' + coded;
    await image.decode();
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    const [seen, sum] = [new Set(), [0, 0, 0]];
    for (let k = 0; k < data.length; k += 4) {
        seen.add((data[k] << 16) | (data[k + 1] << 8) | data[k + 2]);
        for (let c = 0; c < 3; c += 1) sum[c] += data[k + c];
    }
    let hash = 0;
    for (let k = 0; k < data.length; k += 1) hash = (Math.imul(hash, 31) + data[k]) | 0;
    return { different: seen.size, mean: sum.map(value => (4 * value) / data.length), hash };
}"""


UNDRAWN = """
const ofCanvas = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
    if (!kind.startsWith('webgl')) return ofCanvas.call(this, kind, ...rest);
    const all = WebGL2RenderingContext;
    const lists = [all.SCISSOR_BOX, all.VIEWPORT];
    const counts = [all.ACTIVE_UNIFORMS, all.ACTIVE_ATTRIBUTES];
    const known = {
        canvas: this,
        getContextAttributes: () => ({ alpha: true, antialias: true, depth: true }),
        getShaderPrecisionFormat: () => ({ rangeMin: 127, rangeMax: 127, precision: 23 }),
        getParameter: name => (name === all.VERSION ? 'WebGL 2.0' : lists.includes(name) ? [0, 0, 0, 0] : 16),
        getProgramParameter: (_, name) => (counts.includes(name) ? 0 : true),
        getShaderParameter: () => true,
        getProgramInfoLog: () => '',
        getShaderInfoLog: () => '',
        getExtension: () => null,
        isContextLost: () => false,
        checkFramebufferStatus: () => all.FRAMEBUFFER_COMPLETE,
    };
    const other = name => all[name] ?? (name.startsWith?.('create') ? () => ({}) : () => undefined);
    return new Proxy(known, { get: (_, name) => known[name] ?? other(name) });
};
"""
"""Gives pages a graphics card that takes everything and draws nothing."""


@pytest.fixture(scope="session")
def tab(browser, tmp_path_factory):
    """`with tab(*scripts) as page`: a tab whose pages run the scripts before their own.

    Tabs are used again, each one more costs a process; so does the way from a file to an address of another
    kind and back, wherefore what a tab shows between two pages is a file as well.
    """
    empty = tmp_path_factory.mktemp("empty") / "empty.html"
    empty.write_text("", encoding="utf-8")
    free = []

    @contextmanager
    def given(*scripts: str):
        if free:
            page, session = free.pop()
        else:
            page = browser.new_context().new_page()
            session = page.context.new_cdp_session(page)
            session.send("Page.enable")
        known = [
            session.send("Page.addScriptToEvaluateOnNewDocument", {"source": script}) for script in scripts
        ]
        yield page
        for script in known:
            session.send("Page.removeScriptToEvaluateOnNewDocument", script)
        page.goto(empty.as_uri())
        free.append((page, session))

    return given


@pytest.fixture(scope="session")
def open_page(tab):
    """`open_page(path, width=, height=, scheme=, still=, before=, where=, drawn=)`: the page of a file.

    Ready, and paused but for `still=False`; a script `before` it is run before its own. Not `drawn` are pages
    of which nobody looks at the scene: to draw without a graphics card takes most of the time.
    """

    @contextmanager
    def opened(
        path: Path,
        width=1000,
        height=620,
        scheme="light",
        still=True,
        before=None,
        where="#t=0",
        drawn=True,
    ) -> Iterator[Opened]:
        with tab(*(script for script in (before, None if drawn else UNDRAWN) if script)) as page:
            page.set_viewport_size({"width": width, "height": height})
            page.emulate_media(color_scheme=scheme, reduced_motion="reduce" if still else "no-preference")
            shown = Opened(page)
            page.goto(path.as_uri() + where)
            page.evaluate("() => window.irlx.ready.then(() => true)")
            shown.settle()
            yield shown
            page.evaluate("() => localStorage.clear()")
            shown.leave()
        assert shown.complaints == []

    return opened


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """`made(**changes)`: file of the page made by hand."""
    folder = tmp_path_factory.mktemp("page")

    def write(**changes):
        path = folder / f"page_{len(list(folder.iterdir()))}.html"
        data = made_data(**changes)
        path.write_bytes(page_of(data["title"], json.dumps(data).encode()))
        return path

    return write
