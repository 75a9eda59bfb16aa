"""Solve shows how far it is and can be stopped; a wrong unit is repaired; sliders are fine, and wide with Shift;
notices have plain sentences."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import family

from .browser import Studio, net


@pytest.mark.soak
def test_a_solver_on_its_way_shows_residual_and_target_and_keeps_its_shape(tab: Studio) -> None:
    """A net that swings for ever: the status tells the residual and its target until Pause, which keeps the shape."""
    scene = net(6)
    scene["settings"] = {**scene["settings"], "tolerance": 1e-12}
    tab.service.put("solving", scene)
    tab.open("solving")
    start = tab.service.particles("solving")
    tab.press("Solve")
    solver = tab.page.get_by_role("group", name="Solver")
    solver.get_by_text("target 1e-12").wait_for()
    assert solver.get_by_role("progressbar").count() == 1
    assert tab.service.summary("solving")["solving"]
    tab.until(lambda: np.abs(tab.particles() - start).max() > 1e-3)
    tab.press("Pause")
    solver.wait_for(state="detached")
    assert np.abs(tab.service.particles("solving") - start).max() > 1e-3
    assert not tab.service.summary("solving")["solving"]


def test_a_model_drawn_in_mm_and_read_in_m_is_repaired_and_the_repair_undone(tab: Studio) -> None:
    """10 km long is larger than anything built: the button reads the same numbers in mm."""
    tab.service.put("repair-unit", family("cable", span=10_000.0).model_dump(mode="json"))
    tab.open("repair-unit")
    tab.page.get_by_text("The model is 10000 m long: its lengths may be meant in mm.").wait_for()
    tab.press("Unit: mm")
    tab.until(lambda: tab.service.scene("repair-unit")["units"]["length"] == "mm")
    assert tab.service.scene("repair-unit")["particles"][-1] == [10_000.0, 0.0, 0.0]
    tab.page.get_by_role("button", name="Unit: mm").wait_for(state="detached")
    tab.press("Undo")
    tab.until(lambda: tab.service.scene("repair-unit")["units"]["length"] == "m")


def test_a_slider_is_fine_wide_with_shift_and_takes_any_typed_value(tab: Studio) -> None:
    """To the end of a slider a stiffness of 100 becomes 3 times as much, with Shift 100 times; 12345 can be typed."""
    tab.service.put("sliders", family("grid", across=2, along=2).model_dump(mode="json"))
    tab.open("sliders")
    page = tab.page

    def stiffness() -> Any:
        return tab.service.scene("sliders")["forces"][0]["stiffness"]

    slider = page.get_by_role("slider", name="net stiffness")
    slider.focus()
    page.keyboard.press("End")
    tab.until(lambda: 295 < stiffness() < 305)
    page.get_by_role("spinbutton", name="net stiffness").fill("100")
    page.keyboard.press("Enter")
    tab.until(lambda: stiffness() == 100)
    slider.focus()
    page.keyboard.down("Shift")
    page.wait_for_function("(one) => Number(one.max) === 4", arg=slider.element_handle())
    page.keyboard.press("End")
    page.keyboard.up("Shift")
    tab.until(lambda: 9900 < stiffness() < 10_100)
    page.get_by_role("spinbutton", name="net stiffness").fill("12345")
    page.keyboard.press("Enter")
    tab.until(lambda: stiffness() == 12345)


@pytest.mark.soak
def test_a_refusal_has_no_pointers_but_in_its_details(tab: Studio) -> None:
    """A session without a label has no key in its title, either."""
    body = family("catenoid", rings=3, rays=8).model_dump(mode="json")
    key = tab.service.client.post("/v1/sessions", json=body).json()["key"]
    tab.open(key)
    tab.page.get_by_role("heading", level=1, name="Untitled model").wait_for()
    field = tab.page.get_by_role("spinbutton", name="Height")
    field.fill("9")
    tab.page.keyboard.press("Enter")
    alert = tab.page.get_by_role("alert").filter(has_text="where the film collapses")
    alert.wait_for()
    assert alert.inner_text().startswith("Height: 9 is more than")
