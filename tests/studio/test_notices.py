"""Notices: they cover neither controls nor the form, on any screen, and Esc closes them. And what the page adds and
goes to rest by, by its buttons."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from serving import CABLE
from soak import sampled

from .browser import LAPTOP, PHONE, Studio
from .conftest import Opened
from .test_exports import taken

UNDER = """() => {
    const seen = [...document.querySelectorAll(".notice")].map((one) => one.getBoundingClientRect());
    if (!seen.length || seen.some((box) => box.height < 10 || box.bottom > innerHeight + 1)) return ["no notice"];
    const found = new Set();
    for (const box of seen)
        for (let x = box.left + 1; x < box.right; x += 4)
            for (let y = box.top + 1; y < box.bottom; y += 4)
                for (const one of document.elementsFromPoint(x, y))
                    if (!one.closest(".notice") && one.matches("button, a, input, select, summary, canvas, p, li"))
                        found.add(one.outerHTML.slice(0, 80));
    return [...found];
}"""
"""Controls, texts and the canvas that are below a notice."""
SIZES = pytest.mark.parametrize("size", [LAPTOP, PHONE], ids=["laptop", "phone"])
BROKEN: Any = {"name": "broken.obj", "mimeType": "", "buffer": b"v 1\n"}
MESH = {
    "meshes": {"roof": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "faces": [[0, 1, 2, 3]]}},
    "forces": [{"kind": "springs", "mesh": "roof", "edges": "all", "stiffness": 100, "rest_factor": 0.5}],
    "anchors": [{"points": [[0, 0, 0], [1, 0, 0], [1, 1, 0]]}],
}
"""Its particles have no numbers in the scene, only places."""


def session(open_studio: Opened, scene: dict[str, Any], name: str, size: dict[str, int] = LAPTOP) -> Studio:
    """A session of a scene, paused at its start."""
    studio = open_studio(size)
    studio.service.put(name, scene)
    studio.open(name)
    return studio


@pytest.mark.soak
@pytest.mark.parametrize("size", sampled([LAPTOP, PHONE], 2))
def test_a_refusal_covers_nothing_on_the_start_page(open_studio: Opened, size: dict[str, int]) -> None:
    """Also where the page was scrolled; Esc closes it."""
    studio = open_studio(size)
    studio.start()
    studio.allowed.append("422")
    page = studio.page
    page.get_by_role("button", name="Open a file").wait_for()
    for last in (False, True):
        if last:
            page.get_by_role("button", name=re.compile("Figure")).last.scroll_into_view_if_needed()
        page.get_by_label("File to open").set_input_files(BROKEN)
        alert = page.get_by_role("alert").filter(has_text="broken.obj was not opened")
        alert.wait_for()
        assert page.evaluate(UNDER) == []
        page.keyboard.press("Escape")
        alert.wait_for(state="hidden")


@pytest.mark.thinned
@SIZES
def test_a_notice_covers_nothing_in_a_session_and_closes_with_esc(open_studio: Opened, size: dict[str, int]) -> None:
    """What is picked stays picked at the first Esc; on a laptop the canvas keeps its size."""
    studio = session(open_studio, CABLE, f"notice-{size['width']}", size)
    page = studio.page
    page.get_by_label("Particle number").fill("2")
    page.keyboard.press("Enter")
    picked = page.get_by_role("heading", name="Particle 2")
    picked.wait_for()
    before = page.locator("canvas").first.bounding_box()
    page.get_by_role("button", name="Add self weight").click()
    notice = page.get_by_role("status").filter(has_text="Self weight of")
    notice.wait_for()
    assert page.evaluate(UNDER) == []
    if size == LAPTOP:
        assert page.locator("canvas").first.bounding_box() == before
    page.evaluate("() => document.activeElement.blur()")
    page.keyboard.press("Escape")
    notice.wait_for(state="hidden")
    assert picked.is_visible()
    page.keyboard.press("Escape")
    picked.wait_for(state="hidden")


@pytest.mark.soak
def test_a_load_on_a_scene_of_a_mesh_is_added_undone_and_removed(open_studio: Opened) -> None:
    studio = session(open_studio, MESH, "mesh-load")
    page, service = studio.page, studio.service

    def kinds() -> list[str]:
        return [force["kind"] for force in service.scene("mesh-load")["forces"]]

    studio.press("Add a load")
    page.get_by_text("acts on every free particle").wait_for()
    studio.press("Add self weight")
    page.get_by_text("in total acts on all particles").wait_for()
    assert kinds() == ["springs", "unary", "self_weight"]
    page.get_by_role("button", name="Remove self weight").wait_for()
    studio.press("Undo")
    studio.until(lambda: kinds() == ["springs", "unary"])
    page.get_by_role("button", name="Remove self weight").wait_for(state="hidden")
    page.get_by_role("button", name="Remove load").click()
    studio.until(lambda: kinds() == ["springs"])
    studio.press("Undo")
    studio.until(lambda: kinds() == ["springs", "unary"])


@pytest.mark.soak
def test_to_rest_is_what_relax_finds(open_studio: Opened) -> None:
    studio = session(open_studio, CABLE, "to-rest")
    wanted = relax(Scene.read(CABLE))
    studio.press("Solve")
    studio.page.get_by_text("In equilibrium after").wait_for()
    studio.service.at_rest("to-rest")
    assert studio.service.summary("to-rest")["iteration"] == wanted.iterations
    assert np.array_equal(studio.service.particles("to-rest"), wanted.particles)
    studio.rests_at(wanted.particles)


@pytest.mark.soak
@pytest.mark.parametrize("form", sampled([("Scene", ".json"), ("Rhino .3dm", ".3dm"), ("npz", ".npz")], 3))
def test_what_was_saved_opens_as_the_same_model(open_studio: Opened, form: tuple[str, str], tmp_path: Path) -> None:
    button, ending = form
    studio = session(open_studio, MESH, f"saved-{ending[1:]}")
    page, service = studio.page, studio.service
    studio.press("Add a load")
    page.get_by_text("acts on every free particle").wait_for()
    scene = service.scene(studio.key)
    file = tmp_path / f"model{ending}"
    file.write_bytes(taken(studio, button, ending).read_bytes())
    page.get_by_role("link", name="All sessions").click()
    page.get_by_label("File to open").set_input_files(file)
    page.wait_for_url(re.compile(r"#s="))
    studio.drawing()
    assert studio.key != f"saved-{ending[1:]}"
    assert service.scene(studio.key) == scene


@pytest.mark.soak
def test_a_file_that_is_not_the_model_comes_with_a_sentence(open_studio: Opened) -> None:
    studio = session(open_studio, MESH, "lacks")
    for button, ending, lacks in (("OBJ", ".obj", "not forces, loads"), ("CSV", ".csv", "cannot be opened")):
        taken(studio, button, ending)
        studio.page.get_by_text(lacks).wait_for()
