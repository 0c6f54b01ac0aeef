"""The page in a real browser: it shows the robot, in two windows alike, and what is pressed happens."""

import shutil
from io import BytesIO

import numpy as np
import pytest

import irlx

pytest.importorskip("viser", reason="viser is not installed: pip install 'irlx[test]'")
playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.req("REP-05"),
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium"),
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
]
ARGUMENTS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)
LONG = 120_000
"""Without a graphics card all of it takes its time, ms."""


@pytest.fixture(scope="module")
def viewer(folder):
    with irlx.view(folder / "p.irl", port=0, block=False, open_page=False) as found:
        yield found


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=CHROMIUM, args=list(ARGUMENTS))
        yield found
        found.close()


def opened(browser, viewer, asked):
    page = browser.new_page(viewport={"width": 800, "height": 520})
    page.set_default_timeout(LONG)
    page.on("request", lambda request: asked.append(request.url))
    page.goto(viewer.url)
    page.wait_for_selector("canvas")
    page.get_by_text("Summary", exact=True).wait_for()
    return page


def picture(page):
    from PIL import Image

    content = page.screenshot(timeout=LONG, animations="disabled")
    return np.asarray(Image.open(BytesIO(content)).convert("RGB")).astype(int)


def test_the_page(browser, viewer):
    asked = []
    viewer.seek(0)
    first = opened(browser, viewer, asked)
    assert "before the first move" in first.content()
    page = picture(first)
    scene = page[:, :500]
    # Something is drawn: the robot has colours, the floor is nearly white.
    coloured = scene.max(axis=2) - scene.min(axis=2) > 60
    assert coloured.mean() > 0.004
    assert len(np.unique(scene.reshape(-1, 3), axis=0)) > 500

    second = opened(browser, viewer, asked)
    viewer.seek(viewer.rows // 3)
    for one in (first, second):
        one.get_by_text("line 6 ·").wait_for()
        assert one.locator("[data-lit]").inner_text().endswith("MOVE_INC LIN (0, 0, -60);")
    moved = picture(first)[:, :500]
    assert (np.abs(moved - scene).max(axis=2) > 40).mean() > 0.002

    second.get_by_role("button", name=">|", exact=True).click()
    first.get_by_text(f"tick {viewer.rows - 1} ·").wait_for()
    assert viewer.row == viewer.rows - 1

    before = viewer.shown
    first.get_by_text("Obstacles", exact=True).click()
    first.get_by_role("button", name="Run again").click()
    first.get_by_text("ran: ").wait_for()
    assert viewer.shown is not before
    assert viewer.row == 0
    hosts = {url.split("/")[2] for url in asked if url.startswith(("http", "ws"))}
    assert hosts == {viewer.url.split("/")[2]}
