"""A model from parameters alone: the page's shape at rest is what the Python API finds of the same family, and its
parameters stay editable."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, family, relax

from .browser import Studio


@pytest.mark.parametrize(
    ("name", "typed"),
    [
        ("saddle", {"rise": 2, "held": "edges"}),
        *(
            pytest.param(*one, marks=pytest.mark.soak)
            for one in [("radial_net", {"rays": 8}), ("cable", {}), ("tensegrity", {})]
        ),
    ],
)
def test_a_model_is_made_and_solved(studio: Studio, name: str, typed: dict[str, Any]):
    """The form, whose fields are those of the schema, sends what was typed; a hypar 10 x 10 m among them."""
    page = studio.page
    title = name.replace("_", " ").capitalize()
    page.get_by_text("New model").click()
    page.get_by_label("Shape").select_option(label=title)
    if name == "saddle":  # as large in another unit
        page.get_by_label("Unit of length").select_option("mm")
        sizes = [page.get_by_label(label).input_value() for label in ("Depth", "Edge stiffness")]
        assert [float(size) for size in sizes] == [10_000, 0.1]  # 10 m and 100 kN/m
        page.get_by_label("Unit of length").select_option("m")
    for field, value in typed.items():
        control = page.get_by_label(field.capitalize())
        if isinstance(value, str):
            control.select_option(value)
        else:
            control.fill(str(value))
            page.keyboard.press("Tab")
    studio.press(f"Make the {title.lower()}")
    studio.drawing()
    scene = family(name, {"force": "kN"}, **typed)
    assert studio.service.scene(studio.key) == scene.model_dump(mode="json")
    studio.press("Solve")
    studio.service.at_rest(studio.key)
    truth = relax(scene).particles
    assert np.abs(studio.service.particles(studio.key) - truth).max() < 1e-3  # of 10 m


@pytest.mark.soak
def test_parameters_are_changed_undone_and_refused_after_a_pin(studio: Studio):
    """The number of faces makes the model again with (n + 1)^2 particles; a pin forbids it until it is undone."""
    page, service = studio.page, studio.service
    made = service.client.post("/v1/sessions", json=family("grid", across=4, along=4).model_dump(mode="json")).json()
    studio.open(made["key"])
    shape = page.get_by_role("group", name="Grid")
    field = shape.get_by_role("spinbutton", name="Across")

    def type_across(value: int) -> None:
        field.fill(str(value))
        page.keyboard.press("Tab")

    type_across(6)
    studio.until(lambda: len(studio.particles()) == 35)
    shape.get_by_role("combobox", name="Held").select_option("edges")
    studio.until(lambda: len(service.anchors(studio.key)[0]["particles"]) == 20)
    studio.press("Undo")
    studio.press("Undo")
    studio.until(lambda: len(studio.particles()) == 25)
    assert Scene.read(service.scene(studio.key)).canonical == family("grid", across=4, along=4).canonical
    service.edit(studio.key, {"pin": [{"particles": [12]}]})
    type_across(5)
    said = page.get_by_text("edited after it was made (anchors)")
    said.first.wait_for()
    studio.press("Undo")
    type_across(5)
    studio.until(lambda: len(studio.particles()) == 30)
