"""Takes the pictures of the tutorials on the studio again: `cd tests && python -m studio.tutorial`, or those of some
tasks: `... studio.tutorial roof film`."""

from __future__ import annotations

import io
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

from . import tasks
from .browser import FLAGS, Studio, context
from .conftest import CHROMIUM
from .drawing import square
from .screenshots import COLOURS
from .service import Service

ROOT = Path(__file__).parents[2]
PICTURES = ROOT / "docs" / "tutorials" / "screens"
LARGEST = 80_000
"""Bytes of a picture: with more it has fewer colours."""
AIMED = {"net-corners"}
"""Pictures in which the pointer stays where it is."""


def film(studio: Studio, see: tasks.See) -> None:
    """The film, its collapse, and the film again."""
    tasks.film(studio, see)
    tasks.pulled(studio, "1")
    tasks.solved(studio)
    tasks.collapsed(studio, see)
    tasks.restored(studio, see)


def vault(studio: Studio, see: tasks.See) -> None:
    """The net that hangs, and the vault."""
    tasks.hanging(studio)
    tasks.turned(studio, see)


def roof(studio: Studio, see: tasks.See) -> None:
    """The roof; its file is of no use here."""
    with tempfile.TemporaryDirectory() as folder:
        tasks.roof(studio, Path(folder), see)


TASKS: dict[str, Callable[[Studio, tasks.See], object]] = {
    "roof": roof,
    "vault": vault,
    "tensegrity": tasks.tensegrity,
    "film": film,
    "variants": tasks.variants,
    "net": square,
    "skin": lambda studio, see: tasks.skin(studio, ROOT / "gh_examples" / "basento" / "model.3dm", see),
}


def main() -> None:
    """Writes the pictures into the folder `screens` of the tutorials."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        service = Service(Path(folder))
        try:
            browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
            for name in sys.argv[1:] or TASKS:
                studio = Studio(context(browser).new_page(), service)
                studio.start()
                TASKS[name](studio, lambda picture: save(studio, picture))  # noqa: B023
                for session in service.summaries():
                    service.client.delete(f"/v1/sessions/{session['key']}")
        finally:
            service.end()


def save(studio: Studio, name: str) -> None:
    """The page as it is, as a small PNG."""
    studio.page.evaluate("() => document.activeElement?.blur()")
    if name not in AIMED:
        studio.page.mouse.move(2, 790)
    studio.page.wait_for_timeout(1500)  # at rest it is drawn once more, finely
    written, colours = io.BytesIO(), COLOURS
    with Image.open(io.BytesIO(studio.page.screenshot())) as seen:
        while not 0 < len(written.getvalue()) < LARGEST:
            small = seen.convert("RGB").quantize(colours, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
            written, colours = io.BytesIO(), colours // 2
            small.save(written, "PNG", optimize=True)
    (PICTURES / f"{name}.png").write_bytes(written.getvalue())
    print(f"{name}: {len(written.getvalue()) / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
