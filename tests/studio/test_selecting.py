"""Several particles at once: box, lasso, row, range of forces, invert; groups in a file; held and moved as one."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from .browser import Studio, net
from .test_exports import taken

SIDE = 5


@pytest.fixture
def sheet(tab: Studio, request: pytest.FixtureRequest) -> Studio:
    """A net of 5 x 5 particles from above, numbered 5 i + j at x = i, y = j, with the ways to select open."""
    tab.service.put(request.node.name, net(SIDE))
    tab.open(request.node.name)
    tab.press("Top")
    tab.place(0)
    tab.page.get_by_text("Select several").click()
    return tab


def drag(studio: Studio, *places: tuple[float, float]) -> None:
    """From place to place with the button down."""
    mouse = studio.page.mouse
    mouse.move(*places[0])
    mouse.down()
    for place in places[1:]:
        mouse.move(*place, steps=8)
    mouse.up()


def around(studio: Studio, first: int, last: int, by: float = 20) -> list[tuple[float, float]]:
    """The corners of the box about two particles, `by` CSS pixels wider."""
    places = [studio.seen(first), studio.seen(last)]
    (left, right), (top, bottom) = (sorted(axis) for axis in zip(*places, strict=True))
    return [(left - by, top - by), (right + by, top - by), (right + by, bottom + by), (left - by, bottom + by)]


def held(studio: Studio) -> list[int]:
    return sorted(p for anchor in studio.service.anchors(studio.key) for p in anchor["particles"])


@pytest.mark.soak
def test_a_part_is_selected_by_name_numbered_and_measured(sheet: Studio) -> None:
    """The anchor is the corners 0, 4, 20, 24 of a square of 4 m; from corner to corner it is 4 m, 8 m in total, with a
    right angle between; numbers and lengths are drawn where the particles are."""
    page = sheet.page
    page.get_by_label("Select a part").select_option(label="Anchor 0")
    counts(sheet, 4)
    page.locator("summary", has_text=re.compile("^Measure$")).click()
    page.get_by_label("Show the numbers").check()
    labels = page.get_by_role("img", name="Measured lengths")
    assert labels.locator(".number").all_text_contents() == ["0", "4", "20", "24"]
    page.get_by_label("Particles to measure").fill("0 4 24")
    told = page.get_by_label("Measured", exact=True).inner_text().split("\n")
    assert [told[i] for i in (1, 3, 5, 7)] == ["4 m (x 0, y 4, z 0)", "4 m (x 4, y 0, z 0)", "8 m", "90°"]
    line = labels.locator("line").first
    box = page.locator("canvas").first.bounding_box()
    assert box is not None
    drawn = [float(line.get_attribute(name) or "nan") for name in ("x1", "y1")]
    assert drawn == pytest.approx(np.subtract(sheet.seen(0), (box["x"], box["y"])), abs=1)  # CSS pixel
    page.get_by_label("Particles to measure").fill("0 99")
    page.get_by_text("There is no particle 99 in this model.").wait_for()


def counts(studio: Studio, number: int) -> None:
    word = "particle" if number == 1 else "particles"
    studio.page.get_by_text(f"{number} {word} selected").wait_for()


def test_box_lasso_invert_and_row_select_what_they_enclose(sheet: Studio) -> None:
    """Of the grid: 2 x 3 by a box, 2 more with Shift, 2 fewer with Alt, a triangle of 3 by a lasso, the row of one
    spring. The corners that were held are 0, 4, 20, 24."""
    page = sheet.page
    sheet.press("Box")
    corners = around(sheet, 6, 13)
    drag(sheet, corners[0], corners[2])
    counts(sheet, 6)
    page.keyboard.down("Shift")
    corners = around(sheet, 16, 17)
    drag(sheet, corners[0], corners[2])
    page.keyboard.up("Shift")
    counts(sheet, 8)
    page.keyboard.down("Alt")
    drag(sheet, corners[0], corners[2])
    page.keyboard.up("Alt")
    counts(sheet, 6)
    sheet.press("Hold the selected")
    sheet.until(lambda: held(sheet) == [0, 4, 6, 7, 8, 11, 12, 13, 20, 24])
    sheet.press("Undo")
    sheet.until(lambda: held(sheet) == [0, 4, 20, 24])
    sheet.press("Invert")
    counts(sheet, 19)
    sheet.press("Lasso")
    (x0, y0), (x1, y1), (x2, y2) = sheet.seen(0), sheet.seen(1), sheet.seen(5)
    out = 0.3 * (x2 - x0)
    drag(sheet, (x0 - out, y0 + out), (x2 + 2 * out, y2 + out), (x1 - out, y1 - 2 * out), (x0 - out, y0 + out))
    counts(sheet, 3)
    sheet.press("Lasso")
    ends = [[5, 10], [6, 11], [7, 12]]
    springs = sheet.service.client.get(f"/v1/sessions/{sheet.key}/topology").json()["springs"]
    page.get_by_label("Spring number").fill(str(next(i for i, pair in enumerate(springs) if sorted(pair) == ends[1])))
    page.keyboard.press("Enter")
    sheet.press("Row")
    counts(sheet, SIDE)
    sheet.press("Hold the selected")
    sheet.until(lambda: held(sheet) == [0, 1, 4, 6, 11, 16, 20, 21, 24])


@pytest.mark.soak
def test_a_range_of_forces_selects_and_a_group_is_kept_and_moved(sheet: Studio, tmp_path: Path) -> None:
    """No spring is stretched at the start: all have 0 N. The held ones of a group move as one edit; a .hookean file
    has the group."""
    page = sheet.page
    page.get_by_label("From force").fill("0.1")
    page.keyboard.press("Tab")
    sheet.press("Select by force")
    counts(sheet, 0)
    page.get_by_label("From force").fill("")
    page.keyboard.press("Tab")
    sheet.press("Select by force")
    counts(sheet, SIDE**2)
    page.get_by_label("Name of the group").fill("whole")
    sheet.press("Keep as a group")
    sheet.press("None")
    counts(sheet, 0)
    sheet.press("whole")
    counts(sheet, SIDE**2)
    page.get_by_label("Move by z").fill("2")
    page.keyboard.press("Tab")
    sheet.press("Move the held ones")

    def heights() -> list[float]:
        return [target[2] for anchor in sheet.service.anchors(sheet.key) for target in anchor["targets"]]

    sheet.until(lambda: heights() == [2.0] * 4)
    sheet.press("Undo")
    sheet.until(lambda: heights() == [0.0] * 4)
    file = tmp_path / "model.hookean"
    file.write_bytes(taken(sheet, "Save", ".hookean").read_bytes())
    page.get_by_role("link", name="All sessions").click()
    page.get_by_label("File to open").set_input_files(file)
    page.wait_for_url(re.compile(r"#s=[0-9a-f]{32}$"))
    sheet.drawing()
    page.get_by_text("Select several").click()
    sheet.press("whole")
    counts(sheet, SIDE**2)


def stiffness(studio: Studio) -> Any:
    """Of the springs of the net, as the scene has it."""
    return studio.service.scene(studio.key)["forces"][0]["stiffness"]


@pytest.mark.soak
def test_springs_between_the_selected_get_a_force(sheet: Studio) -> None:
    """Their own stiffness and a constant tension on what is selected: the 4 + 3 springs among 2 x 3 particles; the
    others keep theirs, and Undo takes it back."""
    page = sheet.page
    sheet.press("Box")
    corners = around(sheet, 6, 13)
    drag(sheet, corners[0], corners[2])
    counts(sheet, 6)
    field = page.get_by_label("Stiffness of the selected springs")
    assert field.input_value() == "500"
    field.fill("900")
    field.press("Enter")
    sheet.until(lambda: isinstance(stiffness(sheet), list))
    assert sorted(stiffness(sheet)) == [500.0] * (2 * SIDE * (SIDE - 1) - 7) + [900.0] * 7
    among = {6, 7, 8, 11, 12, 13}
    springs = sheet.service.client.get(f"/v1/sessions/{sheet.key}/topology").json()["springs"]
    assert {i for i, ends in enumerate(springs) if among >= {*ends}} == {
        i for i, value in enumerate(stiffness(sheet)) if value == 900
    }
    sheet.until(lambda: field.input_value() == "900")
    sheet.press("Undo")
    sheet.until(lambda: stiffness(sheet) == 500)
    page.get_by_text("Add a force of any kind").click()
    page.get_by_label("Kind").select_option(label="Constant tension")
    page.get_by_label("On", exact=True).select_option(label="What is picked")
    page.get_by_role("button", name="Add constant tension", exact=True).click()
    sheet.until(lambda: len(sheet.service.scene(sheet.key)["forces"]) == 3)
    assert len(sheet.service.scene(sheet.key)["forces"][-1]["particles"]) == 7


def middle(studio: Studio, face: list[int]) -> tuple[float, float]:
    """Where the middle of a face is seen from above [CSS pixels]."""
    x, y = np.mean([studio.seen(corner) for corner in face], axis=0)
    return float(x), float(y)


@pytest.mark.soak
def test_single_faces_are_selected_and_get_a_force(sheet: Studio) -> None:
    """Two of 4 x 4 faces by clicks, their strip and the one across, 2 x 2 by a box; pressure and then area weight act
    on these four alone, which become one mesh; each addition is undone by itself."""
    page, service = sheet.page, sheet.service

    def faces(number: int) -> None:
        page.get_by_text(re.compile(f"^{number} faces selected. Click a face")).wait_for()

    page.get_by_label("Faces", exact=True).check()
    for face in ([6, 7, 11, 12], [7, 8, 12, 13]):
        page.mouse.click(*middle(sheet, face))
    faces(2)
    sheet.press("Strip")
    faces(SIDE - 1)
    sheet.press("Strip across")
    faces(SIDE - 1)
    page.get_by_label("Face numbers").fill("3 99")
    page.keyboard.press("Enter")
    page.get_by_text("There is no face 99; the model has 16, counted from 0.").wait_for()
    sheet.press("Box")
    corners = around(sheet, 6, 18)
    drag(sheet, corners[0], corners[2])
    faces(4)
    page.get_by_text("Add a force of any kind").click()
    for kind in ("Pressure", "Area weight"):
        page.get_by_label("Kind").select_option(label=kind)
        assert page.get_by_label("On", exact=True).input_value() == "faces"  # the usual place while faces are selected
        page.get_by_role("button", name=f"Add {kind.lower()}", exact=True).click()
        sheet.until(lambda kind=kind: service.scene(sheet.key)["forces"][-1]["name"] == kind.lower())
    scene = service.scene(sheet.key)
    assert [force["mesh"] for force in scene["forces"][-2:]] == ["pressure", "pressure"]
    mesh = scene["meshes"]["pressure"]
    drawn = np.array(mesh["vertices"])[np.array(mesh["faces"])]
    assert sorted(map(tuple, drawn.mean(axis=1).tolist())) == [(x, y, 0) for x in (1.5, 2.5) for y in (1.5, 2.5)]
    sheet.press("Undo")
    sheet.until(lambda: service.scene(sheet.key)["forces"][-1]["kind"] == "pressure")
    sheet.press("Undo")
    sheet.until(lambda: "pressure" not in service.scene(sheet.key)["meshes"])
    faces(4)
    sheet.press("Their edge")
    counts(sheet, 8)
