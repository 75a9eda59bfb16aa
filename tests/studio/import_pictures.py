"""Takes the pictures of the tutorial on the import sheet again: `cd tests && python -m studio.import_pictures`."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

from . import tasks
from .browser import FLAGS, Studio, context
from .conftest import CHROMIUM
from .screenshots import COLOURS
from .service import Service

ROOT = Path(__file__).parents[2]
PICTURES = ROOT / "docs" / "tutorials" / "screens"


def main() -> None:
    """Writes the pictures into the folder `screens` of the tutorials."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        service = Service(Path(folder))
        try:
            browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
            studio = Studio(context(browser).new_page(), service)
            studio.start()
            tasks.skin(studio, ROOT / "gh_examples" / "basento" / "model.3dm", lambda name: save(studio, name))
        finally:
            service.end()


def save(studio: Studio, name: str) -> None:
    """The page as it is, as a small PNG."""
    studio.page.evaluate("() => document.activeElement?.blur()")
    studio.page.mouse.move(2, 790)
    studio.page.wait_for_timeout(1500)  # at rest it is drawn once more, finely
    with Image.open(io.BytesIO(studio.page.screenshot())) as seen:
        small = seen.convert("RGB").quantize(COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    small.save(PICTURES / f"{name}.png", "PNG", optimize=True)


if __name__ == "__main__":
    main()
