"""A read-only link: the same session and view in another browser, live, where nothing can be changed; and the view of a
saved model in the address that `hookean studio` opens."""

from __future__ import annotations

import json
from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest

from hookean_server.lifecycle.studio import view_in

from .browser import Studio, net
from .conftest import Opened

pytestmark = pytest.mark.slow

EDITING = ("Play", "Solve", "Undo", "Reset", "Pin", "Release", "Copy a read-only link", "Copy link", "All sessions")


def seen(studio: Studio, particle: int) -> np.ndarray:
    """Where a particle is seen, from the middle of the canvas, as parts of its height."""
    box = studio.page.get_by_role("application").bounding_box()
    x, y = studio.place(particle)
    return np.array([x - box["x"] - box["width"] / 2, y - box["y"] - box["height"] / 2]) / box["height"]


@pytest.mark.soak
def test_a_read_only_link_shows_the_same_view_live_and_changes_nothing(tab: Studio, open_studio: Opened):
    """The camera is the same to a pixel in 800, colours, selection and a group of many are the same; frames come while
    its owner plays; a drag turns the view and keys do nothing; once revoked, it reports that."""
    page, service = tab.page, tab.service
    service.put("shared", net(5))
    chosen = np.flatnonzero(np.random.default_rng(3).random(60_000) < 0.5)
    many = json.dumps({"many": chosen.tolist()})
    page.evaluate("(many) => localStorage.setItem('hookean-groups-shared', many)", many)
    tab.open("shared")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    tab.press("Front")
    page.get_by_role("radio", name="Strain").check()
    page.get_by_label("Particle number").fill("7")
    page.keyboard.press("Enter")
    there = seen(tab, 3)
    tab.press("Copy a read-only link")
    page.get_by_text("The read-only link was copied.").wait_for()
    link = page.evaluate("() => navigator.clipboard.readText()")
    assert service.token not in link and parse_qs(urlsplit(link).fragment)["s"] == ["shared"]

    guest = open_studio(alone=True)
    guest.page.goto(link)
    guest.drawing()
    assert np.abs(seen(guest, 3) - there).max() < 1 / 800
    assert guest.page.get_by_role("radio", name="Strain").is_checked()
    guest.page.get_by_role("heading", name="Particle 7", exact=True).wait_for()
    assert f"{len(chosen):,} particles" in guest.page.locator("ul[aria-label=Groups] li").text_content(timeout=20_000)
    assert guest.page.get_by_text("Read only", exact=True).is_visible()
    for name in EDITING:
        assert not guest.page.get_by_role("button", name=name, exact=True).count(), name
    assert not guest.page.get_by_role("heading", name="Forces", exact=True).count()

    flat = guest.particles()
    service.act("shared", "play")
    guest.until(lambda: np.abs(guest.particles() - flat).max() > 0.01)
    revision = service.act("shared", "pause")["revision"]
    guest.rests_at(service.particles("shared"))
    guest.drag(12, 60, 40)
    for key in ("Space", "p", "Control+z", "."):
        guest.page.keyboard.press(key)
    assert np.abs(seen(guest, 3) - there).max() > 0.01, "the drag has turned the view"
    now = service.summary("shared")
    assert (now["revision"], now["playing"]) == (revision, False)

    guest.allowed = ["401"]
    tab.press("Revoke the read-only link")
    guest.page.get_by_text("This read-only link is no longer valid").wait_for()


def test_the_address_of_a_saved_model_has_its_view(tab: Studio):
    """As `hookean studio FILE.hookean` opens it: colours, camera and selection are those of the file, and the address
    keeps neither the token nor the view."""
    service = tab.service
    service.put("saved", net(4))
    eye = [1.5, 1.5, 0.0, 0.0, -1.0, 0.0, 8.0, 32.0]
    view = {"eye": eye, "colouring": "strain", "marked": [1, 2], "layers": {"particles": False}}
    data = service.client.get(
        "/v1/sessions/saved/state", params={"format": "hookean", "view": json.dumps(view)}
    ).content
    tab.page.goto(f"{service.url}/#t={service.token}&s=saved{view_in(data)[0]}")
    tab.drawing()
    assert tab.page.get_by_role("radio", name="Strain").is_checked()
    assert not tab.page.get_by_role("checkbox", name="Particles").is_checked()
    assert tab.page.get_by_text("2 particles selected.").count() == 1
    # the middle of the net is the target, around which 8 m are seen; this corner is 1.5 m nearer to the eye
    eye_to_target = 4.0 / np.tan(np.radians(16.0))
    assert seen(tab, 0) == pytest.approx([-1.5 / 8 * eye_to_target / (eye_to_target - 1.5), 0.0], abs=1 / 800)
    assert tab.page.url == f"{service.url}/#s=saved"
