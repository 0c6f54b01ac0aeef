"""Draws view.png, the page of `irlx view`: needs the extra view, playwright, and a Chromium.

python docs/pictures/draw_view.py [CHROMIUM]
"""

from __future__ import annotations

import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

import irlx
from irlx.solids.placement import Placement

FOLDER = Path(__file__).parent
PROGRAM = FOLDER.parents[1] / "programs" / "window" / "window.irl"
CHROMIUM = "/usr/bin/chromium"
ARGUMENTS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)
WITHOUT_NOTES = "[class*=Notification] { display: none !important }"
"""Chromium draws without a graphics card here, of which the page would warn."""
SIZE = {"width": 1240, "height": 760}
SLOW = 150_000
"""How long a picture may take without a graphics card, ms."""


def main(chromium: str = CHROMIUM) -> None:
    """Move a side of the window, run again, and take the picture in the middle of the run."""
    with (
        irlx.view(PROGRAM, tick_ms=40, port=0, block=False, open_page=False) as viewer,
        sync_playwright() as driver,
    ):
        viewer.place("window_left", Placement((0.42, 0.405, 0.48)))
        viewer.run_again()
        viewer.obstacles.hold("window_left", 0.25)
        viewer.seek(round(0.45 * viewer.rows))
        browser = driver.chromium.launch(executable_path=chromium, args=ARGUMENTS)
        page = browser.new_page(viewport=SIZE)
        page.goto(viewer.url)
        page.wait_for_selector("canvas")
        page.add_style_tag(content=WITHOUT_NOTES)
        page.wait_for_timeout(6000)
        page.screenshot(path=FOLDER / "view.png", timeout=SLOW, animations="disabled")
        browser.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
