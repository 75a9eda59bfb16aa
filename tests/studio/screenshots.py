"""Takes the studio's pictures of six figures anew, for the README and the gallery: `make screenshots`."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

from .browser import FLAGS, Studio, context
from .conftest import CHROMIUM
from .service import Service

EXAMPLES = Path(__file__).parents[2] / "gh_examples"
FIGURES = {
    "9.4-cable": "particle",
    "9.11-uneven-extension": "spring",
    "9.24-membrane": "",
    "9.31-diagonal-patterns": "",
    "9.32-ribbon": "",
    "hanging-vault": "",
}
"""What is picked in each, by its number 0."""
COLOURS = 256


def take(studio: Studio, figure: str, picked: str) -> bytes:
    """The page of a figure at rest, as a small PNG."""
    page = studio.page
    page.goto(studio.service.url)
    key = studio.choose(figure)
    studio.press("Solve")
    studio.service.at_rest(key, 900.0)  # s: the ribbon takes its time
    studio.rests_at(studio.service.particles(key))
    studio.press("Fit")
    if picked:
        page.get_by_label(f"{picked.capitalize()} number").fill("0")
        page.keyboard.press("Enter")
    page.evaluate("() => document.activeElement?.blur()")
    page.mouse.move(2, 790)
    studio.place(0)
    page.wait_for_timeout(1000)  # at rest it is drawn once more, finely
    with Image.open(io.BytesIO(page.screenshot())) as seen:
        small = seen.convert("RGB").quantize(COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    written = io.BytesIO()
    small.save(written, "PNG", optimize=True)
    return written.getvalue()


def main() -> None:
    """Writes studio.png into the folders of the figures."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        service = Service(Path(folder))
        try:
            browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
            studio = Studio(context(browser).new_page(), service)
            studio.start()
            for figure, picked in FIGURES.items():
                picture = take(studio, figure, picked)
                (EXAMPLES / figure / "studio.png").write_bytes(picture)
                print(f"{figure}: {len(picture) / 1e3:.0f} kB")
        finally:
            service.end()


if __name__ == "__main__":
    main()
