"""Forces of every kind, added to any scene by the catalogue's schema: selected, undone, removed; the scene has them."""

from __future__ import annotations

from typing import Any

import pytest

from serving import CABLE
from soak import sampled

from .browser import Studio, net

SQUARE = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n"


def add(studio: Studio, kind: str, place: str = "", **values: str) -> None:
    """A force by the form: its kind by title, on a place, with values by their fields' titles."""
    page = studio.page
    if not page.get_by_label("Kind").is_visible():
        page.get_by_text("Add a force of any kind").click()
    page.get_by_label("Kind").select_option(label=kind)
    if place:
        page.get_by_label("On", exact=True).select_option(label=place)
    form = page.locator("form.addforce")
    for name, value in values.items():
        form.get_by_label(name, exact=True).fill(value)
    form.get_by_role("button", name=f"Add {kind.lower()}", exact=True).click()


def forces(studio: Studio) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = studio.service.scene(studio.key)["forces"]
    return found


def focused(studio: Studio) -> Any:
    return studio.page.evaluate("() => document.activeElement?.dataset?.force")


@pytest.mark.parametrize("scene", sampled(["mesh", "lines", "file"], 3))
def test_loads_and_self_weight_are_added_to_any_scene(tab: Studio, scene: str):
    """Each is in the scene and has the focus; Undo takes it back, Remove removes it."""
    if scene == "file":
        tab.start()
        tab.page.get_by_label("File to open").set_input_files(
            {"name": "net.obj", "mimeType": "model/obj", "buffer": SQUARE}
        )
        tab.press("Make the model")
        tab.drawing()
    else:
        tab.service.put(f"add-{scene}", {"lines": CABLE, "mesh": net(4)}[scene])
        tab.open(f"add-{scene}")
    before = forces(tab)
    tab.press("Add a load" if scene == "mesh" else "Add self weight")
    tab.until(lambda: len(forces(tab)) == len(before) + 1)
    name = forces(tab)[-1]["name"]
    tab.until(lambda: focused(tab) == name, what="the focus on the new force")
    add(tab, "Vortex", "Every particle", Strength="0.5")
    tab.until(lambda: focused(tab) == "vortex")
    assert forces(tab)[-1]["strength"] == 0.5
    tab.press("Undo")
    tab.until(lambda: [f["name"] for f in forces(tab)][-1] == name)
    tab.press(f"Remove {name}")
    tab.until(lambda: len(forces(tab)) == len(before))


@pytest.mark.soak
def test_kinds_for_meshes_lines_and_rows_of_particles(tab: Studio):
    """Pressure acts on the mesh, springs join what is numbered, a surface has rows of points, a floor
    no place; and a wrong number of particles is a sentence."""
    tab.service.put("add-kinds", net(4))
    tab.open("add-kinds")
    add(tab, "Pressure", "Mesh net", Pressure="2")
    tab.until(lambda: forces(tab)[-1]["kind"] == "pressure")
    assert (forces(tab)[-1]["mesh"], forces(tab)[-1]["pressure"]) == ("net", 2.0)
    add(tab, "Springs", "Particles by number", Numbers="0 15", Stiffness="7")
    tab.until(lambda: focused(tab) == "springs")
    assert forces(tab)[-1]["stiffness"] == 7.0
    plane = {"Control points": "0 0 1, 3 0 1; 0 3 1, 3 3 1", "Knots u": "0 0 1 1", "Knots v": "0 0 1 1"}
    add(tab, "Pull to surface", "Every particle", **plane, **{"Degree u": "1", "Degree v": "1"})
    tab.until(lambda: focused(tab) == "pull to surface")
    assert forces(tab)[-1]["control_points"] == [[[0, 0, 1], [3, 0, 1]], [[0, 3, 1], [3, 3, 1]]]
    add(tab, "Co planar", "Particles by number", Numbers="0 1 2 5", Group="0 0 0 0")
    tab.until(lambda: focused(tab) == "co planar")
    tab.page.get_by_label("Kind").select_option(label="Floor")
    assert tab.page.get_by_text("which this kind needs").count() == 0  # it needs no place at all
    tab.press("Add floor")
    tab.until(lambda: focused(tab) == "floor")
    tab.page.get_by_label("Kind").select_option(label="Pull to mesh")
    assert tab.page.get_by_label("Target").locator("option").all_inner_texts() == ["default: none", "net"]
    add(tab, "Angle", "Particles by number", Numbers="0 1")
    tab.page.get_by_text("2 particles given; Angle needs").wait_for()
    assert forces(tab)[-1]["kind"] == "floor"


@pytest.mark.slow
def test_a_choice_without_a_default_says_none(tab: Studio):
    """A beam releases nothing at its ends where nothing is chosen."""
    tab.service.put("add-default", CABLE)
    tab.open("add-default")
    tab.page.get_by_text("Add a force of any kind").click()
    tab.page.get_by_label("Kind").select_option(label="Beam")
    release = tab.page.get_by_label("Release start", exact=True)
    assert release.locator("option").first.inner_text() == "default: none"
    assert tab.page.get_by_label("Release end", exact=True).locator("option").first.inner_text() == "default: none"
