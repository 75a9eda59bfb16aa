"""Six tasks of a designer in the page, by mouse and keyboard alone, from the start page: each function does one, and
returns the keys of the sessions it leaves. `see` receives the name of each step worth a picture."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from serving import wait_for

from .browser import Studio

See = Callable[[str], None]


def made(studio: Studio, shape: str, **typed: str) -> None:
    """A new model of a family, with what is typed into the fields of its parameters, by their labels."""
    filled(studio, shape, **typed)
    create(studio, shape)


def filled(studio: Studio, shape: str, **typed: str) -> None:
    """The form of a new model."""
    page = studio.page
    page.get_by_text("New model").click()
    page.get_by_label("Shape").select_option(label=shape)
    for name, value in typed.items():
        enter(studio, page.locator("form").get_by_label(name.replace("_", " ")), value)


def create(studio: Studio, shape: str) -> None:
    """The model of a form that is filled in."""
    studio.press(f"Make the {shape.lower()}")
    studio.drawing()


def enter(studio: Studio, field: Any, text: str) -> None:
    """A text or a choice into a field, which is sent when the field is left."""
    if field.evaluate("(found) => found.tagName") == "SELECT":
        field.select_option(text)
        return
    field.click()
    studio.page.keyboard.press("Control+A")
    studio.page.keyboard.type(text)
    studio.page.keyboard.press("Tab")


def solved(studio: Studio) -> None:
    """Press Solve and wait for equilibrium, and until the page draws it."""
    studio.press("Solve")
    wait_for(lambda: rests(studio))
    studio.page.get_by_label("Status").locator(".stability").wait_for()
    studio.rests_at(studio.service.particles(studio.key), within=1e-3)


def rests(studio: Studio) -> bool:
    """Whether the present shape is in equilibrium: right after an edit the status is still that of the shape before."""
    state, summary = studio.service.state(studio.key), studio.service.summary(studio.key)
    tolerance = studio.service.scene(studio.key)["settings"]["tolerance"]
    return state["status"] == "converged" and state["residual"] <= tolerance and not summary["playing"]


def opened(studio: Studio, *panels: str) -> None:
    """Only these panels open, the first of them in sight."""
    for summary in studio.page.locator(".panel > summary").all():
        is_open = summary.evaluate("(found) => found.parentElement.open")
        if is_open != (summary.inner_text().strip() in panels):
            summary.click()


def add(studio: Studio, kind: str, place: str, **values: str) -> None:
    """A force of a kind, by its title, on a place, with values by the titles of their fields."""
    page = studio.page
    if not page.get_by_label("Kind").is_visible():
        page.get_by_text("Add a force of any kind").click()
    page.get_by_label("Kind").select_option(label=kind)
    page.get_by_label("On", exact=True).select_option(label=place)
    form = page.locator("form.addforce")
    for name, value in values.items():
        enter(studio, form.get_by_label(name, exact=True), value)
    form.get_by_role("button", name=f"Add {kind.lower()}", exact=True).click()


def roof(studio: Studio, folder: Path, see: See) -> tuple[str, str]:
    """A hypar 10 x 10 m with edge cables, its form found; then snow of 0.6 kN/m2 of its plan; saved and reopened."""
    page, service = studio.page, studio.service
    filled(studio, "Saddle", Rise="2.5", Edge_stiffness="60")
    see("roof-new")
    create(studio, "Saddle")
    first = studio.key
    solved(studio)
    see("roof-form")
    opened(studio, "Forces")
    add(studio, "Area weight", "Mesh net", Weight="0.6", Per="plan")
    studio.until(lambda: service.scene(first)["forces"][-1]["kind"] == "area_weight")
    solved(studio)
    see("roof-snow")
    opened(studio, "Save and export")
    with page.expect_download() as saving:
        studio.press("Save")
    file = folder / saving.value.suggested_filename
    saving.value.save_as(file)
    page.get_by_role("link", name="All sessions").click()
    page.get_by_label("File to open").set_input_files(file)
    page.wait_for_url(lambda url: re.search(r"#s=[0-9a-f]{32}$", url) is not None and first not in url)
    studio.drawing()
    see("roof-reopened")
    return first, studio.key


def hanging(studio: Studio) -> str:
    """A net on a plan of 8 x 6 m that hangs from its edges."""
    size = {"Width": "8", "Depth": "6", "Across": "8", "Along": "6"}
    made(studio, "Grid", **size, Held="edges", Stiffness="4", Rest_factor="0", Load="2")
    solved(studio)
    return studio.key


def turned(studio: Studio, see: See) -> None:
    """The net that hangs, turned over: loads the other way, and the form of these."""
    see("vault-hanging")
    opened(studio, "Forces")
    studio.press("Turn the loads over")
    studio.page.get_by_text("1 load turned over").wait_for()
    solved(studio)
    see("vault-turned")


def tensegrity(studio: Studio, see: See) -> str:
    """A prism of four struts, 3 m high, that finds its twist."""
    made(studio, "Tensegrity", Struts="4", Height="3")
    solved(studio)
    opened(studio, "Tables")
    see("tensegrity")
    return studio.key


def film(studio: Studio, see: See) -> str:
    """A catenoid between two rings of 5 m radius, 5 m apart, with the upper one selected by a box."""
    page = studio.page
    made(studio, "Catenoid", Rays="24", Rings="8")
    solved(studio)
    see("film-form")
    opened(studio, "Selection")
    studio.press("Front")
    page.get_by_text("Select several").click()
    studio.press("Box")
    (left, top), (right, _) = studio.place(8 * 24 + 12), studio.place(8 * 24)
    page.mouse.move(left - 25, top - 25)
    page.mouse.down()
    page.mouse.move(right + 25, top + 25, steps=8)
    page.mouse.up()
    page.get_by_text("24 particles selected").wait_for()
    see("film-ring")
    return studio.key


def pulled(studio: Studio, by: str) -> None:
    """The selected ring moved by so many metres."""
    enter(studio, studio.page.get_by_label("Move by z"), by)
    studio.press("Move the held ones")
    studio.page.get_by_text("24 held particles moved").wait_for()
    studio.press("Close the notice")


def collapsed(studio: Studio, see: See) -> None:
    """The film, 6 m high, pulled until no film spans the rings."""
    pulled(studio, "2")
    studio.press("Solve")
    studio.page.get_by_label("Status").get_by_text("the film has collapsed").wait_for()
    studio.press("Fit")
    see("film-collapse")


def restored(studio: Studio, see: See) -> None:
    """The rings as near as at first, and the film between them again."""
    pulled(studio, "-3")
    solved(studio)
    studio.press("Fit")
    see("film-back")


def variants(studio: Studio, see: See) -> tuple[str, str]:
    """A roof kept as a variant, then with more rise; the variant over it, the table, and both side by side."""
    page, service = studio.page, studio.service
    made(studio, "Saddle", Across="8", Along="8", Rise="2")
    first = studio.key
    solved(studio)
    opened(studio, "Compare")
    page.get_by_label("Name of the variant").fill("low")
    studio.press("Keep as a variant")
    page.get_by_role("button", name="low", exact=True).wait_for()
    opened(studio, "Shape")
    enter(studio, page.get_by_role("group", name="Saddle").get_by_role("spinbutton", name="Rise"), "4")
    studio.until(lambda: service.scene(first)["family"]["parameters"]["rise"] == 4)
    solved(studio)
    opened(studio, "Compare")
    studio.press("low")
    page.get_by_role("region", name="Table of differences").wait_for()
    studio.press("Front")
    page.get_by_role("group", name="Legend").get_by_text("Variant low").wait_for()
    see("variants-overlay")
    page.get_by_role("radio", name="Side by side").check()
    page.get_by_role("img", name="The variant low").wait_for()
    studio.press("Perspective")
    see("variants-beside")
    [other] = [one["key"] for one in service.summaries() if one["label"].endswith(" · low")]
    return first, other


def chosen(studio: Studio, file: Path) -> None:
    """A file opened from the start page, until the import sheet shows its layers."""
    studio.page.get_by_label("File to open").set_input_files(file)
    studio.page.get_by_role("dialog", name=f"Import {file.name}").wait_for()


def counted(studio: Studio) -> None:
    """Wait until the service has counted what the roles of the import sheet become."""
    studio.page.get_by_text("Counting what these roles become").wait_for(state="detached")


def given(studio: Studio, row: str, role: str, **values: str) -> None:
    """A role for a row of the import sheet, and values by the names of their fields."""
    sheet = studio.page.get_by_role("dialog")
    sheet.get_by_label(f"Role of {row}", exact=True).select_option(label=role)
    counted(studio)
    for name, value in values.items():
        enter(studio, sheet.get_by_label(re.compile(f"^{name.replace('_', ' ')} of {re.escape(row)}")), value)
        counted(studio)


def imported(studio: Studio, file: Path, folder: Path, see: See) -> Path:
    """A curve of a Rhino file as a cable of 24 pieces in inches that hangs from its ends, other layers left out; its
    form found, and saved as a Rhino file."""
    page = studio.page
    chosen(studio, file)
    page.get_by_role("dialog").get_by_label("Unit of length").select_option("in")
    counted(studio)
    given(studio, "line layer, curves", "Left out")
    given(studio, "blue circles, curves", "Left out")
    given(studio, "green NURBS wiggle, curves", "Cables", Divide="24", Stiffness="50", Load="-2")
    page.get_by_text("24 springs, 25 loads, 2 held points").wait_for()
    see("import-sheet")
    studio.press("Make the model")
    studio.drawing()
    solved(studio)
    see("import-form")
    opened(studio, "Save and export")
    with page.expect_download() as saving:
        studio.press("Rhino .3dm")
    saved = folder / "relaxed.3dm"
    saving.value.save_as(saved)
    return saved


def skin(studio: Studio, file: Path, see: See) -> None:
    """The model of Basento: a skin drawn tight between four feet and six fingers, in kN."""
    chosen(studio, file)
    studio.page.get_by_role("dialog").get_by_label("Unit of force").select_option("kN")
    counted(studio)
    see("import-proposal")
    values = {"Stiffness": "100", "Held": "nothing", "Divide_u": "32", "Divide_v": "8"}
    given(studio, "skin, surfaces", "Net", **values)
    given(studio, "feet, points", "Anchors")
    given(studio, "fingers, points", "Anchors")
    see("import-sheet")
    studio.press("Make the model")
    studio.drawing()
    solved(studio)
    studio.press("Fit")
    see("import-form")
