"""Draws docs/pictures/page_*.png: the replay page in a browser.

python docs/pictures/draw_page.py [NAME]...    (needs irlx[browser,plot], and chromium)

A picture more is a line more in PICTURES.
"""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image
from playwright.sync_api import Browser, sync_playwright

import irlx

HERE = Path(__file__).resolve().parent
PROGRAMS = HERE.parents[1] / "programs"
ARGUMENTS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run")
COLOURS, OF_LINES = 255, 72
"""Of a picture, and of its lines: so few that it stays small, and hardly anyone sees it."""
VIVID = 90
"""How far apart red, green and blue of a pixel are that is not grey."""


@dataclass(frozen=True)
class Picture:
    """The page of a program at a time (s), in a window of `width` and `height`, with a tab open."""

    name: str
    program: str
    time: float
    width: int = 1360
    height: int = 850
    scheme: str = "light"
    tab: str = "Program"
    scale: float = 1.0


PICTURES = (
    Picture("square", "koch/square_cyclic.irl", 6.0),
    Picture("phone", "koch/square_cyclic.irl", 8.6, 390, 844, "dark", "Curves", 1.5),
    Picture("window", "window/window.irl", 3.6, scheme="dark"),
)


def main() -> None:
    """Draw the pictures that are named, all without a name."""
    asked = sys.argv[1:] or [picture.name for picture in PICTURES]
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        chromium = shutil.which("chromium") or shutil.which("chromium-browser")
        browser = playwright.chromium.launch(executable_path=chromium, args=list(ARGUMENTS))
        for picture in PICTURES:
            if picture.name in asked:
                draw(picture, browser, Path(folder))


def draw(picture: Picture, browser: Browser, folder: Path) -> None:
    """Run the program, open its page, and write the picture."""
    path = folder / f"{picture.name}.html"
    irlx.run(PROGRAMS / picture.program).save(path)
    page = browser.new_page(
        viewport={"width": picture.width, "height": picture.height},
        color_scheme=picture.scheme,
        device_scale_factor=picture.scale,
    )
    page.goto(f"{path.as_uri()}#t={picture.time}")
    page.evaluate("() => window.irlx.ready.then(() => true)")
    page.get_by_role("tab", name=picture.tab).click()
    page.wait_for_timeout(500)
    seen = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    page.close()
    few = seen.quantize(palette=palette_of(seen), dither=Image.Dither.NONE)
    few.save(HERE / f"page_{picture.name}.png", optimize=True)


def palette_of(picture: Image.Image) -> Image.Image:
    """Colours for a picture: those of its large areas, and of the thin lines and dots that tell something.

    A part of the choice is made among its vivid pixels alone, which are so few that they would get none.
    """
    pixels = np.asarray(picture).reshape(-1, 3)
    vivid = pixels[np.ptp(pixels, axis=1) > VIVID]
    lines = Image.fromarray(vivid[np.newaxis])
    parts = ((picture, COLOURS - OF_LINES), (lines, OF_LINES))
    chosen = [part.quantize(count, kmeans=1).getpalette() for part, count in parts]
    palette = Image.new("P", (1, 1))
    palette.putpalette([value for colours in chosen for value in colours])
    return palette


if __name__ == "__main__":
    main()
