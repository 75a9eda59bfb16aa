"""The import sheet: what each layer of a Rhino file is, chosen by mouse or keyboard before it becomes a session."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hookean import relax
from hookean.commands.examples import find
from hookean.files.readers import read_path
from hookean.files.recipe.draft import draft
from hookean.files.rhino import threedm
from hookean.files.rhino.threedm import Additions, NewObject
from hookean.values.mesh import Mesh
from soak import sampled

from . import tasks
from .browser import LAPTOP, PHONE, Studio
from .conftest import Opened
from .test_readable import serious

SIDE = 4
CORNERS = np.array([[0.0, 0, 0], [4, 0, 1], [4, 4, 0], [0, 4, 1]])


@pytest.fixture
def roof(tmp_path: Path) -> Path:
    """A file in mm with a net on the layer skin, a rope on each side of it, its corners, and a box."""
    grid = np.array([[i, j, (i + j) / 4 - i * j / 8] for i in range(SIDE + 1) for j in range(SIDE + 1)])
    number = np.arange((SIDE + 1) ** 2).reshape(SIDE + 1, SIDE + 1)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], 2).reshape(-1, 4)
    sides = [
        NewObject(1e3 * np.linspace(a, b, SIDE + 1), "Edge ropes")
        for a, b in zip(CORNERS, np.roll(CORNERS, -1, 0), strict=True)
    ]
    box = Mesh(
        1e3 * np.array([[i, j, k] for i in (6.0, 7) for j in (0.0, 1) for k in (0.0, 1)]),
        np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]),
    )
    corners = [NewObject(1e3 * corner, "supports", f"corner {i}") for i, corner in enumerate(CORNERS)]
    drawn = [NewObject(Mesh(1e3 * grid, faces), "skin"), *sides, *corners, NewObject(box, "house")]
    path = tmp_path / "roof.3dm"
    threedm.write_new(path, Additions((), drawn), unit="Millimeters", own=False)
    return path


def truth(path: Path, choices: dict[str, Any]) -> Any:
    """What the Python API finds of the file with these choices."""
    recipe = json.dumps(draft(threedm.read(path), choices).recipe)
    return relax(read_path(path, (recipe, "recipe")).scene)


def becomes(studio: Studio) -> list[str]:
    """The last column of the rows of layers."""
    found: list[str] = (
        studio.page.get_by_role("dialog").locator("tbody tr:not(.single) td:last-child").all_inner_texts()
    )
    return found


@pytest.mark.soak
def test_the_first_proposal_becomes_the_model(studio: Studio, roof: Path) -> None:
    """Ropes, skin and supports have their roles by the names of their layers; the house is left out."""
    tasks.chosen(studio, roof)
    assert becomes(studio) == ["40 springs", "16 springs", "4 held points", ""]
    studio.page.get_by_text("The model has 25 particles, 4 of them held.").wait_for()
    studio.press("Make the model")
    studio.drawing()
    tasks.solved(studio)
    found = truth(roof, {})
    assert np.abs(studio.service.particles(studio.key) - found.particles).max() < 1e-4 * 4
    assert studio.page.get_by_role("dialog").count() == 0


def test_roles_values_and_units_are_chosen(studio: Studio, roof: Path) -> None:
    """A membrane in kN instead of the net; ropes with a stiffness of their own. Forces are those of the Python API."""
    tasks.chosen(studio, roof)
    studio.page.get_by_role("dialog").get_by_label("Unit of force").select_option("kN")
    tasks.counted(studio)
    tasks.given(studio, "skin, surfaces", "Membrane", Prestress="1.5")
    tasks.given(studio, "Edge ropes, curves", "Cables", Stiffness="40", Rest_factor="0.97")
    assert becomes(studio)[0] == "16 faces of membrane"
    studio.press("Make the model")
    studio.drawing()
    tasks.solved(studio)
    skin = {"layer": "skin", "family": "surfaces", "role": "membrane", "values": {"prestress": 1.5}}
    ropes = {"layer": "Edge ropes", "family": "curves", "role": "cables"}
    ropes["values"] = {"stiffness": 40, "rest_factor": 0.97}  # type: ignore[assignment]
    found = truth(roof, {"units": {"length": "m", "force": "kN"}, "rows": [skin, ropes]})
    state = studio.service.state(studio.key)
    assert np.abs(np.asarray(state["particles"]) - found.particles).max() < 1e-4 * 4
    for one, other in zip(state["forces"], found.forces, strict=True):
        for name in ("force", "tension"):
            if name in other:
                assert np.allclose(one[name], other[name], rtol=1e-3, atol=1e-3 * np.abs(other[name]).max())


@pytest.mark.soak
def test_a_skin_is_drawn_tight_between_feet_and_fingers(studio: Studio) -> None:
    """The model of the tutorial is that of the figure's recipe, but for the edge cables that this has: made here by
    the Python API without them."""
    path = find("basento").folder / "model.3dm"
    tasks.skin(studio, path, lambda name: None)
    recipe = tomllib.loads((path.parent / "recipe.toml").read_text())
    recipe["forces"] = [table for table in recipe["forces"] if table["name"] == "skin"]
    found = relax(read_path(path, (json.dumps(recipe), "recipe")).scene)
    assert len(found.particles) == 33 * 9
    size = np.ptp(found.particles, axis=0).max()
    assert np.abs(studio.service.particles(studio.key) - found.particles).max() < 1e-4 * size
    state = studio.service.state(studio.key)
    assert len(state["reactions"]["particles"]) == 10
    assert np.allclose(state["forces"][0]["force"], found.forces[0]["force"], rtol=1e-3, atol=1e-3 * 100)


@pytest.mark.soak
def test_choices_are_undone_by_button_and_by_key(studio: Studio, roof: Path) -> None:
    page = studio.page
    tasks.chosen(studio, roof)
    before = becomes(studio)
    menu = page.get_by_label("Role of skin, surfaces")
    tasks.given(studio, "skin, surfaces", "Left out")
    studio.until(lambda: becomes(studio)[0] == "")
    studio.press("Undo")
    assert menu.input_value() == "net" and becomes(studio) == before
    tasks.given(studio, "Edge ropes, curves", "Cables", Divide="3")
    studio.until(lambda: becomes(studio)[1] == "12 springs")
    page.keyboard.press("Control+z")
    studio.until(lambda: becomes(studio)[1] == "16 springs")


@pytest.mark.soak
def test_one_object_has_a_role_of_its_own(studio: Studio, roof: Path) -> None:
    page = studio.page
    tasks.chosen(studio, roof)
    studio.press("Objects of supports, points")
    page.get_by_label("Role of corner 2").select_option(label="Left out")
    studio.until(lambda: becomes(studio)[2] == "3 held points")
    page.get_by_label("Role of corner 2").select_option(label="As the layer")
    studio.until(lambda: becomes(studio)[2] == "4 held points")


@pytest.mark.soak
def test_it_is_done_by_keyboard_alone(studio: Studio, roof: Path) -> None:
    """The menu of a role is reached by Tab, keeps the focus when it has changed, and Enter on the button makes the
    model; Esc closes the sheet, and no session is made."""
    page = studio.page
    sessions = len(studio.service.summaries())
    tasks.chosen(studio, roof)
    page.keyboard.press("Escape")
    page.get_by_role("dialog").wait_for(state="detached")
    assert len(studio.service.summaries()) == sessions and "#s=" not in page.url
    tasks.chosen(studio, roof)
    tab_to(studio, "Role of house, surfaces")
    page.keyboard.press("n")  # the role that begins with it
    tasks.counted(studio)
    assert focused(studio) == "Role of house, surfaces"
    studio.until(lambda: becomes(studio)[3] == "12 springs")
    tab_to(studio, "Make the model")
    page.keyboard.press("Enter")
    studio.drawing()
    assert len(studio.particles()) == 25 + 8


def focused(studio: Studio) -> str:
    """The name of what has the focus."""
    found: str = studio.page.evaluate(
        "() => document.activeElement.getAttribute('aria-label') ?? document.activeElement.textContent"
    )
    return found


def tab_to(studio: Studio, name: str) -> None:
    """Press Tab until a control has the focus."""
    for _ in range(60):
        if focused(studio) == name:
            return
        studio.page.keyboard.press("Tab")
    raise AssertionError(f"Tab does not reach {name}")


@pytest.mark.soak
def test_what_is_no_model_is_explained(studio: Studio, roof: Path) -> None:
    """Without springs the button is off; a value that is not allowed is refused in the field, and a fault by layer."""
    page = studio.page
    tasks.chosen(studio, roof)
    for row in ("skin, surfaces", "Edge ropes, curves"):
        tasks.given(studio, row, "Left out")
    page.get_by_text("Nothing becomes springs or a membrane yet").wait_for()
    assert page.get_by_role("button", name="Make the model").is_disabled()
    tasks.given(studio, "Edge ropes, curves", "Cables", Held="loose ends")
    page.get_by_text('Layer "Edge ropes": "loose:layer:Edge ropes" gives no points').wait_for()
    field = page.get_by_label("Stiffness of Edge ropes, curves [N/m]")
    tasks.enter(studio, field, "-1")
    page.get_by_role("alert").filter(has_text="at least 0 allowed").wait_for()


@pytest.mark.soak
def test_the_recipe_is_edited_and_saved(studio: Studio, roof: Path, tmp_path: Path) -> None:
    """What is saved is what the command line accepts; what is changed by hand is what the model is made of."""
    page = studio.page
    tasks.chosen(studio, roof)
    page.get_by_text("Recipe", exact=True).click()
    with page.expect_download() as saving:
        studio.press("Save the recipe")
    assert saving.value.suggested_filename == "roof-recipe.json"
    saving.value.save_as(tmp_path / "recipe.json")
    text = (tmp_path / "recipe.json").read_text()
    assert json.loads(text) == draft(threedm.read(roof)).recipe
    page.get_by_label("Recipe").fill(text.replace('"layer:skin"', '"layer:skim"'))
    studio.allowed = ["422"]
    studio.press("Make the model")
    page.get_by_role("dialog").get_by_role("alert").filter(has_text="did you mean layer:skin").wait_for()
    page.get_by_label("Recipe").fill(text.replace('"stiffness": 1000', '"stiffness": 750'))
    studio.press("Make the model")
    studio.drawing()
    assert studio.service.scene(studio.key)["forces"][0]["stiffness"] == 750


@pytest.mark.soak
@pytest.mark.parametrize("size", sampled([PHONE, LAPTOP], 2))
def test_it_is_readable(open_studio: Opened, roof: Path, size: dict[str, int]) -> None:
    """It fits the window, and axe finds nothing serious."""
    studio = open_studio(size)
    studio.start()
    tasks.chosen(studio, roof)
    box = studio.page.get_by_role("dialog").bounding_box()
    assert box and box["x"] >= 0 and box["x"] + box["width"] <= size["width"] and box["height"] <= size["height"]
    assert serious(studio) == []
