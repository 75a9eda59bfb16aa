"""Trouble: the service dies, forgets, or is edited by two; the page says so, goes on, and shows nothing old as new."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from serving import CABLE

from .browser import Studio, Wire, net
from .conftest import Opened
from .service import Service, equilibrium

# what a browser reports of a service that ends, in the middle of an answer too
GONE = ["ERR_CONNECTION", "ERR_CONTENT_LENGTH_MISMATCH", "WebSocket", "502", "failed: "]


@pytest.fixture
def mortal(tmp_path: Path, browser: object) -> Iterator[Service]:
    """A service that no other test uses."""
    found = Service(tmp_path)
    yield found
    found.end()


@pytest.mark.soak
def test_the_page_goes_on_when_the_service_was_killed(open_studio: Opened, mortal: Service):
    """kill -9: the page says that it is reconnecting; the service that is started again has another token and knows no
    cookie, so that the page asks to be let in, and is there again, on the same revision, once any page of this browser
    was; what was edited before is there, what is edited after arrives."""
    mortal.put("cable", CABLE)
    studio = open_studio(at=mortal)
    studio.start()
    studio.allowed = GONE
    studio.open("cable")
    studio.press("Solve")
    truth = equilibrium(CABLE)
    studio.rests_at(truth)
    studio.drag(0, 40, 30)
    studio.settled()
    edited = mortal.summary("cable")
    assert edited["undo"] == 1
    ends = mortal.anchors("cable")

    mortal.kill()
    studio.page.get_by_text("Reconnecting").wait_for()
    assert not studio.page.get_by_text("Live", exact=True).is_visible()
    studio.allowed = [*GONE, "401"]
    mortal.start()
    studio.page.get_by_text("hookean token --url").wait_for()
    other = studio.page.context.new_page()
    other.goto(f"{mortal.url}/#t={mortal.token}")
    other.get_by_role("heading", name="Figures").wait_for()
    other.close()
    studio.page.bring_to_front()
    studio.page.evaluate("() => window.dispatchEvent(new Event('focus'))")  # as the window system would send it
    studio.page.get_by_text("Live", exact=True).wait_for()
    assert mortal.summary("cable")["revision"] == edited["revision"]
    assert mortal.anchors("cable") == ends
    studio.rests_at(mortal.particles("cable"))
    studio.press("Undo")
    studio.until(lambda: mortal.summary("cable")["undo"] == 0)
    studio.press("Solve")
    studio.rests_at(truth)


def test_a_session_that_is_forgotten_elsewhere_is_told_to_be_gone(tab: Studio):
    tab.allowed = ["404", "WebSocket"]
    tab.service.put("short-lived", CABLE)
    tab.open("short-lived")
    tab.service.client.delete("/v1/sessions/short-lived")
    tab.page.get_by_text("Not found", exact=True).wait_for()


def test_a_link_to_no_session_says_so(tab: Studio):
    tab.allowed = ["404", "WebSocket"]
    tab.page.goto(f"{tab.service.url}/#s=never-made")
    tab.page.get_by_text("Not found", exact=True).wait_for()


@pytest.mark.soak
def test_two_people_edit_one_session(open_studio: Opened):
    """Each sees what the other did; at the end both show the same, and that is what the service has."""
    one, other = open_studio(), open_studio(alone=True)
    other.start()
    service = one.service
    service.put("shared", CABLE)
    one.open("shared")
    other.open("shared")
    one.press("Solve")
    truth = equilibrium(CABLE)
    one.rests_at(truth)
    other.rests_at(truth)
    one.drag(0, 50, 30)
    other.until(lambda: np.abs(other.particles()[0] - truth[0]).max() > 0.05, what="what the other did")
    other.drag(5, -50, 30)
    one.until(lambda: np.abs(one.particles()[5] - truth[5]).max() > 0.05, what="what the other did")
    one.settled()
    held = [{"particles": a["particles"], "targets": a["targets"]} for a in service.anchors("shared")]
    rest = equilibrium(CABLE, {"pin": held})
    one.press("Solve")
    one.rests_at(rest)
    other.rests_at(rest)


@pytest.mark.soak
def test_grasshopper_gives_the_session_another_scene(tab: Studio):
    """A scene with other particles under the same key: the page shows it, and nothing of the one before."""
    tab.service.put("redrawn", CABLE)
    tab.open("redrawn")
    longer = {**CABLE, "particles": [*CABLE["particles"], [12.0, 0.0, 0.0]]}
    longer["forces"] = [{**CABLE["forces"][0], "particles": [[i, i + 1] for i in range(6)]}, CABLE["forces"][1]]
    longer["anchors"] = [{"particles": [0, 6]}]
    tab.service.put("redrawn", longer)
    tab.until(lambda: len(tab.particles()) == 7)
    tab.press("Solve")
    tab.rests_at(equilibrium(longer))


@pytest.mark.soak
def test_what_is_done_before_the_service_greets_again_is_done(tab: Studio):
    """An anchor is dragged when the connection is there again, and the service's greeting still on its way: the edit
    counts, and the form goes on to its equilibrium."""
    service = tab.service
    service.put("greeted", CABLE)
    tab.open("greeted")
    wire = Wire(tab)
    tab.press("Solve")
    tab.until(lambda: service.summary("greeted")["status"] == "converged")
    tab.settled()
    revision = service.summary("greeted")["revision"]
    wire.keep()
    wire.cut()
    tab.until(lambda: len(wire.sockets) == 2 and wire.kept)
    tab.drag(0, 40, 30, steps=1)
    tab.until(lambda: service.summary("greeted")["revision"] > revision)
    wire.give()
    tab.until(lambda: service.summary("greeted")["status"] == "converged")


@pytest.mark.soak
def test_a_frame_that_cannot_be_read_is_told_of(tab: Studio):
    """Also while a drag is under way, whose edits are told the same: the page shows nothing that it has not read."""
    service, page = tab.service, tab.page
    service.put("broken", CABLE)
    tab.open("broken")
    wire = Wire(tab)
    revision = service.summary("broken")["revision"]
    wire.keep()
    tab.drag(0, 40, 30)
    tab.until(lambda: service.summary("broken")["revision"] > revision)
    wire.sockets[-1].send(b"no frame")
    page.get_by_text("Not compatible").wait_for()
    told = page.get_by_text("a frame that is shorter than its header")
    told.wait_for()
    page.wait_for_timeout(500)
    assert told.is_visible()
    assert page.get_by_role("button", name="Play").is_disabled()


@pytest.mark.slow
def test_a_session_that_is_slow_is_told_from_one_that_does_not_answer(tab: Studio):
    """It plays and no frame comes: with a service that answers it is slow; with one whose process sends nothing, or one
    that does not answer, it is not; and the next frame ends all. The age of what is shown is that of its last frame.
    Pause goes by another connection, as this one's orders wait for each other."""
    service, page = tab.service, tab.page
    service.put("slow", net(4))
    tab.open("slow")
    wire = Wire(tab)
    tab.allowed = ["failed: .*/v1/sessions/slow", "ERR_FAILED"]
    tab.press("Play")
    page.get_by_role("button", name="Play", pressed=True).wait_for()
    wire.keep()
    page.get_by_text("Slow: last update").wait_for()
    assert page.get_by_text("updates arrive slowly").is_visible()
    hangs = {"json": service.summary("slow"), "headers": {"hookean-silence": "9.0"}}
    page.route(re.compile("/v1/sessions/slow$"), lambda route: route.fulfill(**hangs))
    page.get_by_text("in a long step, or hangs").wait_for()
    page.route(re.compile("/v1/sessions/slow$"), lambda route: route.abort())
    page.get_by_text("No answer: last update").wait_for()
    page.get_by_text("the service does not answer").wait_for()
    assert int(re.search(r"(\d+) s ago", page.locator(".chip").first.inner_text())[1]) >= 3
    with page.expect_request(re.compile("/v1/sessions/slow/pause$")):
        tab.press("Pause")
    tab.until(lambda: not service.summary("slow")["playing"])
    wire.give()
    page.get_by_text("Live", exact=True).wait_for()
