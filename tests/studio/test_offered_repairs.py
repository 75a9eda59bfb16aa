"""What goes wrong is named plainly and repaired by a button: a step too long, nothing held, a form out of view."""

from __future__ import annotations

import numpy as np
import pytest

from .browser import Studio, net


def test_a_step_that_is_too_long_is_repaired_by_a_button(tab: Studio):
    """The sentence names the time step without pointers; the button sets the step that the service advises."""
    scene = net(4)
    scene["settings"] = {"solver": "verlet", "time_step": 1.0}
    tab.service.put("repair-step", scene)
    tab.open("repair-step")
    warnings = tab.page.get_by_role("list", name="Warnings")
    warnings.get_by_text("The time step: 1 s is too large").wait_for()
    assert "/settings" not in warnings.inner_text() and "/forces" not in warnings.inner_text()
    tab.page.get_by_role("button", name="Use step").click()
    tab.until(lambda: tab.service.scene("repair-step")["settings"]["time_step"] < 0.1)
    tab.press("Undo")
    tab.until(lambda: tab.service.scene("repair-step")["settings"]["time_step"] == 1.0)


@pytest.mark.soak
def test_where_nothing_is_held_the_page_says_so_and_holds_the_rim(tab: Studio):
    """The rim of 4 x 4 vertices has 12 of them; the sentence goes with them."""
    tab.service.put("repair-rim", {**net(4), "anchors": []})
    tab.open("repair-rim")
    said = tab.page.get_by_text("Nothing is held:")
    said.wait_for()
    tab.press("Hold the rim")
    said.wait_for(state="detached")
    held = np.sort(np.concatenate([anchor["particles"] for anchor in tab.service.anchors("repair-rim")]))
    assert held.tolist() == [i for i in range(16) if i // 4 in (0, 3) or i % 4 in (0, 3)]


@pytest.mark.soak
def test_a_form_out_of_view_is_brought_back(tab: Studio):
    tab.service.put("repair-view", net(4))
    tab.open("repair-view")
    tab.place(0)
    tab.page.get_by_label("The form").focus()
    for _ in range(25):
        tab.page.keyboard.press("Shift+ArrowRight")
    tab.page.get_by_role("button", name="The form is out of view").click()
    x, y = tab.place(5)
    box = tab.page.get_by_label("The form").bounding_box()
    assert box and box["x"] < x < box["x"] + box["width"] and box["y"] < y < box["y"] + box["height"]
