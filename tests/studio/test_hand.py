"""The hand: what is dragged, pinned and pulled in the page is what the service solves and the Python API finds."""

from __future__ import annotations

import numpy as np
import pytest

from serving import SOAK

from .browser import Studio, Wire
from .service import equilibrium

CABLE = "9.4-cable"


@pytest.fixture
def cable(tab: Studio, request: pytest.FixtureRequest) -> Studio:
    """The figure in a session of this test."""
    tab.service.put(request.node.name, tab.service.example(CABLE))
    tab.open(request.node.name)
    return tab


def test_an_anchor_is_dragged_and_the_form_follows(studio: Studio):
    """Gallery, cable, an anchor taken by mouse: the particles follow while it moves, and come to rest where the figure
    with that anchor moved comes to rest by the Python API."""
    key = studio.choose(CABLE)
    scene, service = studio.service.example(CABLE), studio.service
    studio.press("Solve")
    studio.rests_at(equilibrium(scene))
    before = studio.particles()

    x, y = studio.place(0)
    studio.page.mouse.move(x, y)
    studio.page.mouse.down()
    for step in range(1, 13):
        studio.page.mouse.move(x + 8 * step, y + 5 * step)
        studio.page.wait_for_timeout(20)
    followed = lambda: np.abs(studio.particles() - before).max(axis=1)[:-1].min() > 1e-3  # noqa: E731
    studio.until(followed, what="all but the other anchor to follow")
    studio.until(lambda: np.hypot(*np.subtract(studio.seen(0), (x + 96, y + 60))) < 3, what="the anchor in the hand")
    studio.page.mouse.up()
    studio.settled()

    [held] = [anchor for anchor in service.anchors(key) if 0 in anchor["particles"]]
    target = held["targets"][held["particles"].index(0)]
    assert np.abs(target - before[0]).max() > 0.1
    studio.rests_at(equilibrium(scene, {"pin": [{"particles": [0], "targets": [target]}]}))
    assert np.abs(studio.particles()[0] - target).max() < 1e-6
    assert service.summary(key)["undo"] == 1  # a gesture is one edit


AWAY = """([particle, across]) => {
    const canvas = document.querySelector("canvas");
    const { x, y } = window.hookean.project(particle);
    const told = { pointerId: 1, isPrimary: true, clientY: y, bubbles: true };
    const fire = (kind, clientX) => canvas.dispatchEvent(new PointerEvent(kind, { ...told, clientX }));
    for (const [kind, at] of [["down", x], ["move", x + across / 2], ["move", x + across], ["up", x + across]])
        fire(`pointer${kind}`, at);
}"""


def test_the_eye_stays_where_it_is_after_a_drag(cable: Studio):
    """A form that leaves the picture by itself is followed; one that was dragged out of it, be it between two pictures,
    is not: the next press would miss what it aims at."""
    stays = cable.place(9)
    cable.page.evaluate(AWAY, [0, -3000])
    cable.until(lambda: cable.seen(0)[0] < -1000, what="the anchor to be drawn far outside")
    cable.settled()
    assert np.abs(np.subtract(cable.place(9), stays)).max() < 1.0


AT_ONCE = """([button, particle, across]) => {
    const canvas = document.querySelector("canvas");
    const { x, y } = window.hookean.project(particle);
    const told = { pointerId: 1, isPrimary: true, clientY: y, bubbles: true };
    const fire = (kind, clientX) => canvas.dispatchEvent(new PointerEvent(kind, { ...told, clientX }));
    [...document.querySelectorAll("button")].find((one) => one.textContent.trim() === button).click();
    for (const [kind, at] of [["down", x], ["move", x + across], ["up", x + across]]) fire(`pointer${kind}`, at);
}"""


@pytest.mark.slow
def test_an_anchor_that_undo_brings_back_stays_one_when_it_is_dragged_at_once(cable: Studio):
    """The page has not read of it yet: a drag that takes it for a free particle would release it at its end."""
    key, service, page = cable.key, cable.service, cable.page
    held = lambda: {i for anchor in service.anchors(key) for i in anchor["particles"]}  # noqa: E731
    page.get_by_label("Particle number").fill("0")
    page.keyboard.press("Enter")
    cable.press("Release")
    cable.until(lambda: 0 not in held())
    page.get_by_role("button", name="Pin", exact=True).wait_for()
    cable.place(0)
    page.evaluate(AT_ONCE, ["Undo", 0, 40])
    cable.until(lambda: service.summary(key)["undo"] == 1, what="the drag")
    cable.settled()
    assert 0 in held()


BETWEEN = """async () => {
    const canvas = document.querySelector("canvas");
    const named = (name) => [...document.querySelectorAll("button")].find((one) => one.textContent.trim() === name);
    const pause = (time = 0) => new Promise((done) => setTimeout(done, time));
    for (let i = 0; i < 60; i++) {
        const { x, y } = window.hookean.project(0);
        named(i % 2 ? "Redo" : "Undo").click();
        for (let last = performance.now() + 500; performance.now() < last; await pause()) {
            if (window.hookean.particles().length) continue;
            const told = { pointerId: 1, isPrimary: true, clientX: x, clientY: y, bubbles: true };
            canvas.dispatchEvent(new PointerEvent("pointerdown", told));
            const { cursor } = canvas.style;
            canvas.dispatchEvent(new PointerEvent("pointerup", told));
            return cursor;
        }
        await pause(100);
    }
    return "the page was never between two topologies";
}"""


@pytest.mark.slow
def test_an_anchor_is_taken_between_a_topology_and_its_picture(cable: Studio):
    """Undo of what was drawn gives another topology: a press before its first picture takes the anchor all the same."""
    key, service = cable.key, cable.service
    service.edit(key, {"draw": {"add": {"points": [[3, 0, 2]]}}})
    cable.until(lambda: len(cable.particles()) == 12)
    cable.place(0)
    assert cable.page.evaluate(BETWEEN) == "grabbing"


TYPED = """(told) => {
    const fields = [...document.querySelectorAll('[aria-label="Position of particle 0"] input')];
    fields.forEach((field, i) => {
        field.value = told[i];
        for (const kind of ["input", "change"]) field.dispatchEvent(new Event(kind, { bubbles: true }));
    });
}"""


@pytest.mark.slow
def test_coordinates_typed_one_after_the_other_are_all_kept(cable: Studio):
    """The page reads where an anchor is held after each edit: the next coordinate does not bring back the old ones."""
    service, page = cable.service, cable.page
    page.get_by_label("Particle number").fill("0")
    page.keyboard.press("Enter")
    page.get_by_role("group", name="Position of particle 0").get_by_role("spinbutton").first.wait_for()
    page.evaluate(TYPED, ["-1", "0.5", "0.25"])
    cable.settled()
    [held] = [anchor for anchor in service.anchors(cable.key) if 0 in anchor["particles"]]
    assert held["targets"][held["particles"].index(0)] == [-1.0, 0.5, 0.25]


WATCHED = """() => {
    window.missing = 0;
    const look = () => {
        if (!window.hookean.project(0)) window.missing += 1;
        window.watching = setTimeout(look);
    };
    look();
}"""


@pytest.mark.soak
def test_what_is_drawn_can_be_taken_at_any_moment(cable: Studio):
    """While anchors and loads are read anew after an edit too: a press on nothing would turn the view instead."""
    key = cable.key
    cable.press("Play")
    cable.page.evaluate(WATCHED)
    for _ in range(3 if SOAK else 1):
        cable.drag(0, 60, 40)
        cable.settled()
        cable.press("Undo")
        cable.until(lambda: cable.service.summary(key)["undo"] == 0)
    assert cable.page.evaluate("() => (clearTimeout(window.watching), window.missing)") == 0


@pytest.mark.soak
def test_pause_step_undo_redo_and_reset(cable: Studio):
    """Each does in the service what its name says, and the page shows it."""
    key, service = cable.key, cable.service
    start = np.array(service.client.get(f"/v1/sessions/{key}/topology").json()["start"])
    cable.press("Play")
    cable.until(lambda: service.summary(key)["playing"])
    cable.until(lambda: np.abs(cable.particles() - start).max() > 1e-3, what="motion")
    cable.press("Pause")
    cable.until(lambda: not service.summary(key)["playing"])
    paused = service.summary(key)["iteration"]
    cable.rests_at(service.particles(key))
    cable.press("Step")
    cable.until(lambda: service.summary(key)["iteration"] > paused)
    cable.rests_at(service.particles(key))
    stepped = service.summary(key)["iteration"]
    cable.page.wait_for_timeout(300)
    assert service.summary(key)["iteration"] == stepped

    ends = service.anchors(key)
    cable.drag(0, 60, 40)
    cable.settled()
    moved = service.anchors(key)
    assert moved != ends
    cable.press("Undo")
    cable.until(lambda: service.anchors(key) == ends)
    cable.press("Redo")
    cable.until(lambda: service.anchors(key) == moved)
    cable.press("Pause")
    cable.press("Reset")
    cable.until(lambda: service.summary(key)["iteration"] == 0)
    cable.rests_at(service.particles(key))


@pytest.mark.soak
def test_a_pause_holds_though_an_edit_overtakes_its_answer(cable: Studio):
    """What is still on its way of a drag, or is typed quickly, does not set going what a hand has just stopped."""
    key, service, page = cable.key, cable.service, cable.page
    wire = Wire(cable)
    cable.press("Play")
    cable.until(lambda: service.summary(key)["playing"])
    page.wait_for_function("() => document.querySelector('[aria-pressed=true]')?.textContent === 'Play'")
    revision = service.summary(key)["revision"]
    wire.keep()
    cable.press("Pause")
    page.get_by_label("Drag").first.fill("0.25")
    page.keyboard.press("Enter")
    cable.until(lambda: service.summary(key)["revision"] > revision)
    wire.give()
    cable.settled()
    assert not service.summary(key)["playing"]


@pytest.mark.soak
def test_the_same_picture_after_loading_anew(cable: Studio):
    """The page holds no state: what it shows is what the service has."""
    key = cable.key
    cable.press("Solve")
    cable.until(lambda: cable.service.summary(key)["status"] == "converged")
    cable.rests_at(cable.service.particles(key))
    drawn, places = cable.particles(), []
    for _ in range(2):
        cable.page.reload()
        cable.drawing()
        assert cable.key == key
        cable.rests_at(drawn, 1e-12)
        places.append([cable.place(0), *map(cable.seen, range(1, 11))])
    assert np.abs(np.subtract(*places)).max() < 0.01
