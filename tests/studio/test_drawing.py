"""A model from an empty page, by clicks and keys alone, and from files of other programs: what is drawn, changed and
chosen is what the Python API makes of the same, and every step is undone by itself."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from hookean import Scene, Simulation, relax
from hookean.files.readers import read

from .browser import PHONE, Studio
from .conftest import Opened
from .drawing import blank, clicked, count, drawn, spots, square
from .tasks import enter, opened
from .test_readable import AXE

pytestmark = pytest.mark.slow

OBJ = b"""o roof
v 0 0 0
v 1 0 0
v 2 0 0
v 0 1 0
v 1 1 0.5
v 2 1 0
v 0 2 0
v 1 2 0
v 2 2 0
f 1 2 5 4
f 2 3 6 5
f 4 5 8 7
f 5 6 9 8
g ties
v 1 1 3
l 5 10
g masts
v 1.05 1 3.1
p 11
"""
"""A roof of four faces, a tie from its middle, and the head of a mast 0.112 m beside the end of the tie."""


def violations(studio: Studio) -> list[str]:
    """What axe finds wrong with the page as it is."""
    if not AXE.is_file():
        pytest.skip("axe-core is not installed: python hatch_build.py check")
    studio.page.evaluate(AXE.read_text())
    run = "async () => (await axe.run()).violations.map(({ id, nodes }) => `${id} ${nodes.map((n) => n.html)}`)"
    found: list[str] = studio.page.evaluate(run)
    return found


def test_a_net_is_drawn_by_clicks_held_loaded_and_solved(studio: Studio) -> None:
    """Four clicks on the sheet, divided twice, held along its edge, loaded: its shape at rest is that of the scene with
    the same net, which the Python API finds."""
    page = studio.page
    square(studio, lambda _: None)
    at = np.linspace(-2.0, 2.0, 5)
    grid = np.array([[x, y, 0.0] for y in at for x in at])
    inner = np.abs(grid).max(axis=1) < 2
    faces = [[i, i + 1, i + 6, i + 5] for i in range(19) if i % 5 < 4]
    truth = relax(
        Scene.read(
            {
                "units": {"force": "kN"},
                "meshes": {"net": {"vertices": grid, "faces": faces}},
                "forces": [
                    {"kind": "springs", "mesh": "net", "stiffness": 20, "rest_factor": 0.8},
                    {"kind": "unary", "points": grid[inner], "vector": [0, 0, -1]},
                ],
                "anchors": [{"points": grid[~inner]}],
            }
        )
    ).particles
    mine = studio.service.particles(studio.key)
    order = [np.lexsort(np.round(shape[:, :2], 3).T) for shape in (mine, truth)]
    assert np.abs(mine[order[0]] - truth[order[1]]).max() < 1e-4  # of 4 m; both to the accuracy of a run
    opened(studio, "Display")
    page.get_by_label("Labels", exact=True).select_option(label="Names")
    page.get_by_role("img", name="Written beside the form: edge").wait_for()
    page.get_by_label("Section plane", exact=True).select_option("x")
    enter(studio, page.get_by_label("Section at x, typed"), "-1.5")
    page.get_by_label("Section at x [m]", exact=True).press("Home")
    assert page.get_by_label("Section at x, typed").input_value() == "-2"
    assert not violations(studio)


@pytest.mark.soak
def test_lines_are_drawn_changed_and_undone(studio: Studio) -> None:
    """Clicks, typed coordinates, a corner on a particle and one on a midpoint; pieces, an extrusion, and what is
    deleted. The Python API makes the same scene by the same edits; each click is undone by itself."""
    page, service = studio.page, studio.service
    blank(studio)
    studio.press("Top")
    clicked(studio, [0, 0, 0], [3, 0, 0])
    drawn(studio, 2)
    field = page.get_by_label("Next corner")
    field.fill("@0 3 1")
    page.keyboard.press("Enter")
    drawn(studio, 3)
    field.fill("@1e-9 0 0")  # within the weld tolerance of the last corner, so it is that one
    page.keyboard.press("Enter")
    clicked(studio, [0, 0, 0])  # on the first particle
    studio.until(lambda: len(service.scene(studio.key)["forces"][0]["particles"]) == 3)
    page.locator("canvas").first.focus()
    page.keyboard.press("Enter")
    clicked(studio, [1.5, 0, 0])  # the middle of the first line
    drawn(studio, 4)
    page.locator("canvas").first.focus()
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    studio.until(lambda: page.get_by_role("button", name="Lines", exact=True).get_attribute("aria-pressed") == "false")
    page.get_by_text("Change what is selected").click()
    enter(studio, page.get_by_label("Spring number"), "2")
    enter(studio, page.get_by_label("Pieces"), "3")
    studio.press("Divide springs")
    drawn(studio, 6)
    enter(studio, page.get_by_label("Spring number"), "0")
    enter(studio, page.get_by_label("Extrude by z"), "2")
    studio.press("Extrude edges")
    drawn(studio, 8)
    page.get_by_text("Select several", exact=True).click()
    studio.press("All")
    page.get_by_label("Name of the group").fill("all")
    studio.press("Keep as a group")
    enter(studio, page.get_by_label("Particle number"), "5")
    page.locator("canvas").first.focus()
    page.keyboard.press("Delete")
    drawn(studio, 7)
    groups = page.get_by_role("list", name="Groups")
    groups.get_by_text("7 particles").wait_for()
    rope = {"kind": "springs", "name": "drawn lines"}
    twin = Simulation(Scene.read({"units": {"force": "kN"}}))
    for edit in (
        {"add": {"points": [[0, 0, 0]]}},
        {"add": {"points": [[3, 0, 0]], "forces": [{**rope, "particles": [[0, 1]]}]}},
        {"add": {"points": [[3, 3, 1]], "forces": [{**rope, "particles": [[1, 2]]}]}},
        {"add": {"forces": [{**rope, "particles": [[2, 0]]}]}},
        {"divide": {"springs": [0]}},
        {"divide": {"springs": [2], "pieces": 3}},
        {"extrude": {"edges": [[0, 3]], "by": [0, 0, 2], "mesh": "drawn faces"}},
        {"delete": {"particles": [5]}},
    ):
        twin.draw(edit)
    assert Scene.read(service.scene(studio.key)).canonical == twin.edited_scene().canonical
    for particles in (8, 6, 4, 3):
        studio.press("Undo")
        drawn(studio, particles)
        groups.get_by_text(f"{particles} particles").wait_for()
    for undone in (2, 1, 0):
        studio.press("Undo")
        studio.until(lambda undone=undone: lines(studio) == undone, what=f"{undone} lines")
    studio.press("Undo")
    studio.until(lambda: count(studio) == 0)


def lines(studio: Studio) -> int:
    forces = studio.service.scene(studio.key)["forces"]
    return len(forces[0]["particles"]) if forces else 0


@pytest.mark.soak
def test_an_obj_file_gets_roles_and_its_recipe_is_kept(open_studio: Opened, tmp_path: Path) -> None:
    """Roles by the groups of the file, an anchor that snaps to the end of the tie with its distance, on a phone; the
    scene is that of `hookean relax --recipe` with the recipe that is saved with the model."""
    studio = open_studio(PHONE)
    studio.start()
    page = studio.page
    page.get_by_label("File to open").set_input_files({"name": "net.obj", "mimeType": "", "buffer": OBJ})
    sheet = page.get_by_role("dialog", name="Import net.obj")
    sheet.get_by_label("Role of roof, surfaces").select_option(label="Shell")
    sheet.get_by_label("Role of masts, points").select_option(label="Anchors")
    sheet.get_by_text("1 of them 0.112 m or more from the nearest particle").wait_for()
    enter(studio, sheet.get_by_label(re.compile("^Snap of masts")), "0.2")
    sheet.get_by_text("1 of them moved to the nearest particle, by 0.112 m at most").wait_for()
    assert not violations(studio)
    studio.press("Make the model")
    studio.drawing()
    opened(studio, "Save and export")
    page.get_by_text("Recipe of net.obj").click()
    recipe = page.get_by_label("Recipe of the file").input_value()
    truth = read(OBJ, "net.obj", (recipe, "")).scene
    made = studio.service.scene(studio.key)
    assert [force["kind"] for force in made["forces"]] == ["membrane", "shell", "springs"]
    assert made["anchors"] == json.loads(truth.canonical)["anchors"]
    assert made["forces"] == json.loads(truth.canonical)["forces"]
    assert [1.0, 1.0, 3.0] in made["anchors"][-1]["points"]
    with page.expect_download() as saving:
        studio.press("Save")
    saving.value.save_as(tmp_path / "net.hookean")
    first = studio.key
    page.evaluate("() => localStorage.clear()")
    page.get_by_role("link", name="All sessions").click()
    page.get_by_label("File to open").set_input_files(tmp_path / "net.hookean")
    page.wait_for_url(lambda url: re.search(r"#s=[0-9a-f]{32}$", url) is not None and first not in url)
    studio.drawing()
    opened(studio, "Save and export")
    page.get_by_text("Recipe of net.obj").click()
    assert page.get_by_label("Recipe of the file").input_value() == recipe


@pytest.mark.soak
def test_a_phone_draws_by_taps(open_studio: Opened) -> None:
    """A tap is a corner, a drag turns the view; the panel has names for all and fits its 390 pixels."""
    studio = open_studio(PHONE)
    studio.start()
    page = studio.page
    blank(studio)
    studio.press("Top")
    for x, y in list(spots(studio, [0, 0, 0], [2, 0, 0])):
        page.touchscreen.tap(x, y)
    drawn(studio, 2)
    assert np.abs(studio.particles() - [[0, 0, 0], [2, 0, 0]]).max() == 0
    studio.press("Undo")  # takes the corner back, too: the line goes on from the first one
    drawn(studio, 1)
    x, y = next(spots(studio, [0, 1, 0]))
    page.touchscreen.tap(x, y)
    drawn(studio, 2)
    assert studio.service.scene(studio.key)["forces"][0]["particles"] == [[0, 1]]
    assert np.abs(studio.particles() - [[0, 0, 0], [0, 1, 0]]).max() == 0
    page.get_by_text("Change what is selected").click()
    assert page.evaluate("() => document.documentElement.scrollWidth") <= PHONE["width"]
    assert not violations(studio)
