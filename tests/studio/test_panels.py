"""The panels: sliders of the catalogue's fields, what is picked, pinned and pulled, and what a report warns of."""

from __future__ import annotations

import io
import re
from typing import Any

import numpy as np
import pytest
from PIL import Image

from serving import CABLE

from .browser import Studio
from .service import equilibrium

NAMED = {
    **CABLE,
    "forces": [{**CABLE["forces"][0], "name": "cable"}, {**CABLE["forces"][1], "name": "load"}],
}


@pytest.fixture
def cable(tab: Studio, request: pytest.FixtureRequest) -> Studio:
    """A cable at rest, in a session of this test."""
    key = re.sub(r"\W+", "-", request.node.name)
    tab.service.put(key, NAMED)
    tab.service.act(key, "play?fast=true")
    tab.service.at_rest(key)
    tab.open(key)
    tab.rests_at(equilibrium(NAMED))
    return tab


@pytest.mark.soak
@pytest.mark.parametrize(
    ("slider", "force", "field", "along"),
    [
        ("Size of load", 1, "vector", 0.8),
        pytest.param("cable stiffness", 0, "stiffness", 0.6, marks=pytest.mark.soak),  # over decades
        pytest.param("cable rest factor", 0, "rest_factor", 0.8, marks=pytest.mark.soak),
        pytest.param("cable damping", 0, "damping", 0.8, marks=pytest.mark.soak),
    ],
)
def test_a_slider_is_dragged_and_the_form_follows(cable: Studio, slider: str, force: int, field: str, along: float):
    """By mouse: what it says is in the scene, the form rests where the Python API has it, undo takes it back whole."""
    page, service, key = cable.page, cable.service, cable.key
    before = service.scene(key)["forces"][force][field]
    track = page.get_by_role("slider", name=slider)
    track.scroll_into_view_if_needed()
    box = track.bounding_box()
    assert box is not None
    y = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + box["width"] / 2, y)
    page.mouse.down()
    page.mouse.move(box["x"] + along * box["width"], y, steps=12)
    page.mouse.up()
    cable.until(lambda: service.scene(key)["forces"][force][field] != before)
    cable.settled()
    after = service.scene(key)["forces"][force][field]
    assert np.linalg.norm(after) > np.linalg.norm(before)
    changed = {**NAMED, "forces": [dict(one) for one in NAMED["forces"]]}
    changed["forces"][force][field] = after
    cable.rests_at(equilibrium(changed))
    assert service.summary(key)["undo"] == 1
    cable.press("Undo")
    cable.until(lambda: service.scene(key)["forces"][force][field] == before)
    cable.rests_at(equilibrium(NAMED))


@pytest.mark.soak
def test_a_number_is_typed_and_a_wrong_one_is_refused_in_a_sentence(cable: Studio):
    page, service, key = cable.page, cable.service, cable.key
    field = page.get_by_role("spinbutton", name="cable stiffness").or_(
        page.get_by_role("textbox", name="cable stiffness")
    )
    field.fill("2500")
    page.keyboard.press("Enter")
    cable.until(lambda: service.scene(key)["forces"][0]["stiffness"] == 2500)
    field.fill("-3")
    page.keyboard.press("Enter")
    page.get_by_role("alert").filter(has_text="stiffness").or_(page.locator(":invalid")).first.wait_for()
    assert service.scene(key)["forces"][0]["stiffness"] == 2500


@pytest.mark.soak
def test_what_is_clicked_is_told_with_units(cable: Studio):
    """A particle's place and reaction, a spring's length, force and strain: the numbers of the service."""
    page, service, key = cable.page, cable.service, cable.key
    state = service.state(key)
    page.mouse.click(*cable.place(0))
    page.get_by_role("heading", name="Particle 0", exact=True).wait_for()
    panel = page.get_by_label("Panels").inner_text()
    reaction = state["reactions"]["force"][state["reactions"]["particles"].index(0)]
    assert f"{max(map(abs, reaction)):.3g}" in panel and " N" in panel

    one, other = np.array(cable.place(2)), np.array(cable.place(3))
    page.mouse.click(*((one + other) / 2))
    page.get_by_role("heading", name="Spring 2", exact=True).wait_for()
    panel = page.get_by_label("Panels").inner_text()
    particles = np.array(state["particles"])
    length = np.linalg.norm(particles[3] - particles[2])
    springs = next(force for force in state["forces"] if force["kind"] == "springs")
    assert f"{length:.4g} m" in panel
    assert f"{springs['force'][2]:.4g} N" in panel


@pytest.mark.slow
def test_a_spring_of_rest_length_0_has_no_strain(tab: Studio):
    """Rest factor 0, a force density net: tension = k l (forces.md, springs), and (l - L0) / L0 is not defined."""
    spring = {**CABLE["forces"][0], "rest_factor": 0.0}
    tab.service.put("no-strain", {**CABLE, "forces": [spring, CABLE["forces"][1]]})
    tab.open("no-strain")
    tab.page.get_by_label("Spring number").fill("0")
    tab.page.keyboard.press("Enter")

    def told(name: str) -> str:
        row = tab.page.locator("dl div", has=tab.page.get_by_text(name, exact=True))
        return str(row.locator("dd").inner_text())

    tab.until(lambda: told("Rest length") != "reading ...")
    assert (told("Rest length"), told("Strain")) == ("0 m", "undefined: the rest length is 0")
    assert told("Force") == "2000 N tension"  # 1000 N/m, 2 m
    legend = tab.page.get_by_role("group", name="Legend")
    tab.page.get_by_role("radio", name="Strain", exact=True).check()
    legend.get_by_text("Strain: undefined, the rest lengths are 0").wait_for()
    legend.get_by_text("Force").wait_for(state="detached")  # the springs are grey
    tab.page.get_by_role("radio", name="Force", exact=True).check()
    legend.get_by_text("Force: all equal").wait_for()


def test_a_particle_is_pinned_and_released(cable: Studio):
    page, service, key = cable.page, cable.service, cable.key
    page.get_by_label("Particle number").fill("2")
    page.keyboard.press("Enter")
    cable.press("Pin")
    cable.until(lambda: 2 in [p for anchor in service.anchors(key) for p in anchor["particles"]])
    cable.press("Release")
    cable.until(lambda: 2 not in [p for anchor in service.anchors(key) for p in anchor["particles"]])
    cable.rests_at(equilibrium(NAMED))


@pytest.mark.soak
def test_a_free_particle_is_pulled_and_springs_back(cable: Studio):
    """While it is held it is where the hand is; let go, the form returns to its equilibrium."""
    page, truth = cable.page, equilibrium(NAMED)
    x, y = cable.place(2)
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(40):  # the hand goes on: the canvas may have become another size on the way
        page.mouse.move(x, y - min(80, 4 * step) + step % 2)
        page.wait_for_timeout(25)
    cable.until(lambda: np.hypot(*np.subtract(cable.seen(2), (x, y - 79))) < 4, what="the particle in the hand")
    assert np.abs(cable.particles()[2] - truth[2]).max() > 0.1
    page.mouse.up()
    cable.rests_at(truth)


@pytest.mark.soak
def test_a_locked_axis_keeps_the_others(cable: Studio):
    """With the lock on z an anchor goes up and down alone, wherever the mouse goes."""
    page, service, key = cable.page, cable.service, cable.key
    before = np.array(service.anchors(key)[0]["targets"][0])
    page.get_by_label("Drag along").or_(page.get_by_label("Lock")).first.select_option("z")
    cable.drag(0, 40, -60)
    cable.settled()
    assert service.summary(key)["undo"] == 1
    held = {p: t for a in service.anchors(key) for p, t in zip(a["particles"], a["targets"], strict=True)}
    assert held[0][:2] == pytest.approx(before[:2], abs=1e-9) and held[0][2] > before[2] + 0.1


@pytest.mark.soak
def test_a_warning_of_the_report_is_seen_with_its_particles(tab: Studio):
    """A loaded particle that nothing holds is named in a sentence; choosing that brings it into view, ringed in red."""
    loose = {**CABLE, "particles": [*CABLE["particles"], [20.0, 0.0, 0.0]]}
    loose["forces"] = [CABLE["forces"][0], {**CABLE["forces"][1], "particles": [0, 1, 2, 3, 4, 5, 6]}]
    tab.service.put("loose", loose)
    tab.open("loose")
    page = tab.page
    warning = page.get_by_role("list", name="Warnings").get_by_role("button", name="particle 6")
    assert "no spring" in warning.inner_text()
    warning.click()
    x, y = tab.place(6)
    box = page.locator("canvas").first.bounding_box()
    assert box is not None
    assert box["x"] < x < box["x"] + box["width"] and box["y"] < y < box["y"] + box["height"]
    around = {"x": x - 12, "y": y - 12, "width": 24, "height": 24}
    page.mouse.move(box["x"] + 2, box["y"] + box["height"] - 2)
    page.wait_for_timeout(300)
    with Image.open(io.BytesIO(page.screenshot(clip=around))) as picture:
        red, green, blue = np.moveaxis(np.asarray(picture.convert("RGB"), int), -1, 0)
    assert np.count_nonzero((red > 180) & (green < 100) & (blue < 180)) > 10


WATCH = """(slider) => {
    window.seen = [slider.value];
    const look = () => {
        if (slider.value !== window.seen.at(-1)) window.seen.push(slider.value);
        requestAnimationFrame(look);
    };
    look();
}"""
"""Notes every value that a slider shows."""


@pytest.mark.soak
def test_a_scene_that_arrives_late_does_not_take_a_slider_back(cable: Studio):
    """The page reads a scene of after the first stroke, which arrives after the second: the slider shows the second."""
    page, service, key = cable.page, cable.service, cable.key
    held: list[Any] = []  # a scene on its way, kept back once
    page.route(
        f"**/v1/sessions/{key}/scene",
        lambda route: route.continue_() if held else held.append((route, route.fetch())),
    )
    slider = page.get_by_role("slider", name="cable rest factor")
    page.evaluate(WATCH, slider.element_handle())
    slider.focus()
    page.keyboard.press("ArrowRight")
    cable.until(lambda: held, what="the page to read the scene")
    page.keyboard.press("ArrowRight")
    cable.until(lambda: service.summary(key)["revision"] >= 2)
    last = slider.input_value()
    route, late = held[0]
    assert late.json()["forces"][0]["rest_factor"] != float(last)
    page.wait_for_timeout(150)  # as late as a scene is on a busy machine
    route.fulfill(response=late)
    cable.until(lambda: page.evaluate("() => window.hookean.stats.revisionDrawn") >= 2)
    cable.settled()
    shown = page.evaluate("() => window.seen.map(Number)")
    assert shown == sorted(shown) and shown[-1] == float(last) == service.scene(key)["forces"][0]["rest_factor"]
