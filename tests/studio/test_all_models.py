"""Every figure of the gallery and every format in the page: opened, a load added, solved, seen, saved, opened again as
the same model. One of each, all in `make soak`; all share a page."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from hookean.commands.examples import examples
from soak import sampled

from .browser import Studio

pytestmark = pytest.mark.slow
NAMES = [example.name for example in examples()]
FORMATS = {"3dm": "3dm", "obj": "obj", "compas": "json", "scene": "json", "hookean": "hookean"}
FIGURE = "9.24-membrane"


def opened(studio: Studio, name: str, data: bytes) -> str:
    """Open a file as a person does, by the import sheet where there is one; the key of its session."""
    page = studio.page
    page.goto(studio.service.url)
    file = {"name": name, "mimeType": "application/octet-stream", "buffer": data}
    page.get_by_label("File to open").set_input_files(file)
    sheet = page.get_by_role("button", name="Make the model")
    studio.until(lambda: "#s=" in page.url or sheet.is_visible())
    if sheet.is_visible():
        sheet.click()
        studio.until(lambda: "#s=" in page.url)
    studio.drawing()
    return studio.key


def used(studio: Studio) -> None:
    """A load on its particles, solved or stopped, seen, saved, and opened again as the same model."""
    page, service, key = studio.page, studio.service, studio.key
    count = service.summary(key)["particles"]
    load = {"kind": "unary", "name": "more", "particles": list(range(count)), "vector": [0, 0, -1e-3]}
    service.edit(key, {"add": [load]})
    studio.press("Solve")
    studio.until(lambda: service.summary(key)["iteration"] > 0 or not service.summary(key)["playing"])
    studio.press("Pause")
    studio.until(lambda: not service.summary(key)["playing"])
    studio.until(lambda: np.isfinite(studio.particles()).all())
    with Image.open(io.BytesIO(page.locator("canvas").first.screenshot())) as picture:
        pixels = np.asarray(picture.convert("RGB"), int)
    assert (np.abs(pixels - pixels[2, 2]).sum(axis=2) > 24).sum() > 40  # the form is seen on its ground
    with page.expect_download() as coming:
        studio.press("Save")
    data = Path(coming.value.path()).read_bytes()
    before, shape = service.scene(key), service.particles(key)
    again = opened(studio, "again.hookean", data)
    try:
        assert again != key
        assert service.scene(again) == before
        assert np.array_equal(service.particles(again), shape)
    finally:
        for one in (key, again):
            service.client.delete(f"/v1/sessions/{one}")


@pytest.mark.parametrize("name", sampled(NAMES, len(NAMES)))
def test_a_figure_is_used_in_the_page(studio: Studio, name: str) -> None:
    studio.choose(name)
    used(studio)


@pytest.mark.soak
@pytest.mark.parametrize("form", FORMATS)
def test_a_format_is_used_in_the_page(studio: Studio, form: str) -> None:
    """The membrane as a file of the format."""
    service = studio.service
    service.put("whole", service.example(FIGURE))
    path = "/v1/sessions/whole/scene" if form == "scene" else f"/v1/sessions/whole/state?format={form}"
    opened(studio, f"membrane.{FORMATS[form]}", service.client.get(path).content)
    used(studio)
