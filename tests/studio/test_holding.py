"""What the page offers where nothing is held, and the edge of a mesh that is carried along."""

from __future__ import annotations

import numpy as np
import pytest

from hookean.discretize import grid

from .browser import Studio

SIDE = 4
EDGE = [i for i in range(SIDE**2) if i % SIDE in (0, SIDE - 1) or i // SIDE in (0, SIDE - 1)]


@pytest.mark.soak
def test_the_rim_of_a_carried_mesh_is_held_and_selected(tab: Studio):
    """Springs are given by particles, and the mesh rides on them, as in the figures: its edge is the rim all the
    same. That nothing is held is read once, above the button."""
    mesh = {name: rows.tolist() for name, rows in vars(grid(np.arange(SIDE), np.arange(SIDE))).items()}
    pairs = {tuple(sorted((face[i], face[i - 1]))) for face in mesh["faces"] for i in range(4)}
    scene = {
        "particles": mesh["vertices"],
        "meshes": {"skin": mesh},
        "forces": [{"kind": "springs", "particles": sorted(pairs)}],
        "geometry": [{"name": "skin", "kind": "mesh", "mesh": "skin"}],
    }
    tab.service.put("hold-carried", scene)
    tab.open("hold-carried")
    status = tab.page.get_by_label("Status")
    assert status.get_by_text("nothing is held", exact=False).count() == 1
    tab.press("Hold the rim")
    [held] = tab.until(lambda: tab.service.anchors("hold-carried"))
    assert sorted(held["particles"]) == EDGE
    tab.page.get_by_label("Particle number").fill("0")
    tab.page.keyboard.press("Enter")
    tab.page.get_by_text("Select several").click()
    tab.press("Edge loop")
    tab.page.get_by_text(f"{len(EDGE)} particles selected").wait_for()


@pytest.mark.soak
def test_a_closed_form_is_held_where_it_stands(tab: Studio):
    """A cube has neither rim nor ends: its four lowest corners are offered."""
    corners = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
    cube = {"meshes": {"cube": {"vertices": corners, "faces": faces}}, "forces": [{"kind": "springs", "mesh": "cube"}]}
    tab.service.put("hold-cube", cube)
    tab.open("hold-cube")
    tab.press("Hold the lowest particles")
    [held] = tab.until(lambda: tab.service.anchors("hold-cube"))
    assert {held["targets"][i][2] for i in range(len(held["targets"]))} == {0.0} and len(held["particles"]) == 4


THRICE = """() => new Promise((done) => {
    const button = [...document.querySelectorAll("button")].find((one) => one.textContent === "Move the held ones");
    const press = (left) => left ? (button.click(), setTimeout(press, 30, left - 1)) : done();
    press(3);
})"""


@pytest.mark.slow
def test_held_particles_move_once_for_each_press(tab: Studio):
    """Presses that follow each other faster than the page reads where the anchors are: each that it takes moves them
    on, so that the way is as many steps as edits were made."""
    mesh = {name: rows.tolist() for name, rows in vars(grid(np.arange(SIDE), np.arange(SIDE))).items()}
    springs = {"kind": "springs", "mesh": "net"}
    held = {"particles": mesh["vertices"], "anchors": [{"particles": [0]}]}
    tab.service.put("move-thrice", {**held, "meshes": {"net": mesh}, "forces": [springs]})
    tab.open("move-thrice")
    tab.page.get_by_text("Select several").click()
    tab.press("All")
    tab.page.get_by_label("Move by z").fill("0.5")
    tab.page.keyboard.press("Enter")
    tab.page.evaluate(THRICE)
    tab.settled()
    [anchor] = tab.service.anchors("move-thrice")
    made = tab.service.summary("move-thrice")["undo"]
    assert made >= 2
    assert anchor["targets"] == [[0.0, 0.0, 0.5 * made]]
