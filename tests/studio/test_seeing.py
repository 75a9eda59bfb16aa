"""Colours that read true, views without perspective, and a phone on which the form stays in sight."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from .browser import PHONE, Studio, net
from .conftest import Opened

SIDE = 8
SMALL = """() => [...document.querySelectorAll(".work :is(button, select, summary, input, a)")]
    .filter((e) => e.offsetParent)
    .map((e) => (["checkbox", "radio"].includes(e.type) ? (e.closest("label") ?? e) : e))
    .map((e) => [e.getBoundingClientRect().height, e.textContent || e.ariaLabel])
    .filter(([height]) => height < 40)"""
"""What is too low for a finger; a box with its label is one target."""
UNTOLD = """() => [...document.querySelectorAll(".work :is(button, select, summary, input)")]
    .filter((e) => !e.closest("[title]") && !e.closest("dialog"))
    .map((e) => e.ariaLabel || e.textContent || e.closest("label")?.textContent)"""
"""Controls without a tooltip, of their own or of what is around them."""
EVERYTHING = """() => document.querySelectorAll("details.panel, details.seldom").forEach((e) => (e.open = true))"""


def shown(studio: Studio, key: str, scene: dict[str, Any]) -> Studio:
    studio.service.put(key, scene)
    studio.open(key)
    return studio


@pytest.mark.soak
def test_a_flat_field_reads_equal(tab: Studio):
    """No spring of a net at its start is stretched: the legend has one number, not a scale."""
    shown(tab, "seen-flat", net(SIDE))
    tab.page.get_by_text("Force: all equal, 0 N").wait_for()


def test_outliers_do_not_set_the_scale_and_are_marked(tab: Studio):
    """Of 112 springs stretched to strains from 0.01 to 0.02 and one to 5, k L0 e of stiffness 500 and length 1 ends
    near 10 N, not at 2500 N; the legend counts the one."""
    scene = net(SIDE)
    count = 2 * SIDE * (SIDE - 1)
    strain = np.linspace(0.01, 0.02, count)
    strain[count // 2] = 5.0
    scene["forces"][0] = {"kind": "springs", "mesh": "net", "stiffness": 500.0, "strain": strain.tolist()}
    shown(tab, "seen-outliers", scene)
    legend = tab.page.get_by_role("group", name="Legend")
    legend.get_by_role("button", name="beyond").click()
    high = float(legend.locator(".ends span").last.inner_text())
    assert high < 0.02 / 1.01 * 500 + 1


@pytest.mark.slow
def test_the_view_that_is_on_is_pressed_until_it_is_turned_by_hand(tab: Studio):
    """By button and by key; a zoom keeps it, a turn by mouse leaves none."""
    shown(tab, "seen-looks", net(3))
    views = tab.page.get_by_role("group", name="View")
    pressed = views.get_by_role("button", pressed=True)
    tab.until(lambda: pressed.all_inner_texts() == ["Perspective"])
    tab.press("Top")
    tab.until(lambda: pressed.all_inner_texts() == ["Top"])
    tab.page.get_by_role("application").press("3")
    tab.until(lambda: pressed.all_inner_texts() == ["Front"])
    tab.page.mouse.move(300, 600)
    tab.page.mouse.wheel(0, 200)
    tab.place(0)
    assert pressed.all_inner_texts() == ["Front"]
    tab.page.mouse.down()
    tab.page.mouse.move(340, 570, steps=4)
    tab.page.mouse.up()
    tab.until(lambda: pressed.all_inner_texts() == [])


@pytest.mark.soak
def test_named_views_are_orthographic(tab: Studio):
    """Particles that differ only in depth are drawn at the same place, to less than a pixel; a drag from above keeps
    the height of what is dragged, to the bit."""
    scene = net(3)
    scene["particles"] = [[x, y, z] for x in (0.0, 2.0) for y in (0.0, 2.0) for z in (0.0, 2.0)]
    scene["meshes"] = {}
    pairs = [[i, j] for i in range(8) for j in range(i)]
    scene["forces"] = [{"kind": "springs", "particles": pairs, "stiffness": 100.0}]
    scene["anchors"] = [{"particles": [0, 3, 5, 6]}]
    shown(tab, "seen-box", scene)
    points = np.array(scene["particles"])
    for view, along, across in (("Top", 2, [0, 1]), ("Front", 1, [0, 2]), ("Right", 0, [1, 2])):
        tab.press(view)
        tab.place(0)
        places = np.array([tab.seen(i) for i in range(8)])
        for i in range(8):
            [other] = [j for j in range(8) if j != i and (points[j, across] == points[i, across]).all()]
            assert points[other, along] != points[i, along]
            assert np.abs(places[i] - places[other]).max() < 1.0, view  # CSS pixels
        if view == "Top":
            tab.drag(3, 20, -15)  # the upper of two
            tab.until(lambda: tab.service.anchors("seen-box")[0]["targets"][1] != [0.0, 2.0, 2.0])
            tab.settled()
            assert tab.service.anchors("seen-box")[0]["targets"][1][2] == 2.0
            tab.press("Undo")
            tab.settled()


def test_on_a_phone_the_form_stays_in_sight_and_targets_fit_fingers(open_studio: Opened):
    """At the last control of the panels the canvas is still inside the window; every target is 40 px high, and has a
    tooltip, in all panels."""
    studio = shown(open_studio(PHONE), "seen-phone", net(SIDE))
    studio.page.evaluate(EVERYTHING)
    studio.page.get_by_label("Solver").scroll_into_view_if_needed()
    box = studio.page.get_by_label("The form").bounding_box()
    assert box is not None and box["y"] >= 0 and box["y"] + box["height"] <= PHONE["height"]
    assert studio.page.evaluate(SMALL) == []
    assert studio.page.evaluate(UNTOLD) == []
