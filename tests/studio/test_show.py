"""`hookean.show`: a scene from Python in the page, what is picked and edited there, and the page in a notebook."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene
from hookean_server.lifecycle.discovery import ask, find
from hookean_server.lifecycle.show import _children as started
from serving import CABLE, HANG

from .browser import Studio
from .conftest import Opened
from .service import Service


@pytest.fixture
def shown(service: Service, monkeypatch: pytest.MonkeyPatch) -> Iterator[hookean.View]:
    """A cable that Python shows, as the service that runs has it."""
    monkeypatch.setenv("HOOKEAN_STATE", str(service.folder / "state"))
    view = hookean.show(CABLE, name="from-python", browser=False)
    yield view
    view.close()


def test_the_page_shows_what_python_shows_and_reports_picks_and_edits(tab: Studio, shown: hookean.View):
    """A click is `pick`; an edit in the page calls back, one of this program does not; positions and results are drawn
    as given."""
    tab.open("from-python")
    assert shown.url == tab.page.url and shown.pick is None
    edits: queue.Queue[object] = queue.Queue()
    shown.on_edit(lambda edit: edits.put(edit.patch))
    tab.page.mouse.click(*tab.place(2))
    tab.page.get_by_role("heading", name="Particle 2", exact=True).wait_for()
    tab.until(lambda: (now := shown.pick) and (now.kind, now.index) == ("particle", 2))

    result = hookean.relax(Scene.read(CABLE))
    shown.update(result)
    tab.rests_at(result.particles)
    raised = result.particles + [0.0, 0.5, 1.0]
    shown.update(positions=raised)
    tab.rests_at(raised)
    assert np.array_equal(shown.particles, raised)

    tab.press("Pin")
    assert edits.get(timeout=HANG) == {"pin": [{"particles": [2], "targets": [raised[2].tolist()]}]}
    assert edits.empty()
    assert len(shown.scene.anchors) == 2


@pytest.mark.soak
def test_values_colour_the_springs_with_a_legend(tab: Studio, shown: hookean.View):
    """One number for each spring, or for each particle: the ends of the legend are the smallest and the largest number
    of a spring, the mean of its ends."""
    tab.open("from-python")
    legend = tab.page.get_by_label("Legend")
    shown.update(values=[10, 20, 30, 40, 55], title="Utilisation", unit="%")
    legend.get_by_text("Utilisation [%]").wait_for()
    assert legend.locator(".ends").inner_text().split() == ["10", "55"]
    shown.update(values=[0, 2, 4, 6, 8, 11], title="Sag", unit="m")
    legend.get_by_text("Sag [m]").wait_for()
    tab.until(lambda: legend.locator(".ends").inner_text().split() == ["1", "9.5"])
    tab.page.get_by_role("radio", name="Force", exact=True).check()
    legend.get_by_text("Force: all equal").wait_for()  # the cable is straight as yet


@pytest.mark.soak
def test_a_notebook_has_the_page_in_a_cell(open_studio: Opened, shown: hookean.View, tmp_path: Path):
    """A page of another port, in a browser that was never logged in, draws the cable in its frame."""
    tab = open_studio(alone=True)
    (tmp_path / "notebook.html").write_text(f"<!doctype html><link rel=icon href=data:,>{shown._repr_html_()}")
    serving = partial(SimpleHTTPRequestHandler, directory=str(tmp_path))
    with ThreadingHTTPServer(("127.0.0.1", 0), serving) as notebook:
        threading.Thread(target=notebook.serve_forever, daemon=True).start()
        tab.page.goto(f"http://localhost:{notebook.server_port}/notebook.html")
        notebook.shutdown()
    inside = tab.page.frame_locator("iframe")
    inside.get_by_role("application", name="The form").wait_for()
    frame = next(frame for frame in tab.page.frames if frame is not tab.page.main_frame)
    frame.wait_for_function("() => window.hookean?.particles().length === 18")
    assert "t=" not in frame.evaluate("() => location.hash")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, "nothing is given"),
        ({"positions": [[0, 0, 0]]}, r"have the shape \(1, 3\); give \(6, 3\)"),
        ({"positions": [[0, 0, np.nan]] * 6}, "not finite"),
        ({"values": [1, 2]}, "give 5, one for each spring, or 6, one for each particle"),
        ({"values": "red"}, "give numbers"),
        ({"scene": {"forces": [{"kind": "sprngs"}]}}, "unknown kind"),
    ],
)
def test_what_cannot_be_shown_is_refused_in_a_sentence(shown: hookean.View, given: dict[str, object], said: str):
    with pytest.raises(InputError, match=said):
        shown.update(**given)
    assert np.array_equal(shown.particles, np.array(CABLE["particles"], float))


def test_a_name_is_one_that_an_address_can_have():
    with pytest.raises(InputError, match="give 1 to 160 letters, digits"):
        hookean.show(CABLE, name="a/b", browser=False)


def test_a_deleted_session_is_reported(shown: hookean.View, service: Service):
    service.client.delete("/v1/sessions/from-python")
    for use in (lambda: shown.pick, lambda: shown.update(CABLE), lambda: shown.update(values=[1, 2, 3, 4, 5])):
        with pytest.raises(ConnectionError, match=r"session from-python was deleted; show the scene again"):
            use()
    assert service.client.get("/v1/sessions/from-python").status_code == 404


def test_a_page_whose_session_was_deleted_shows_the_next_one_of_its_name(tab: Studio, shown: hookean.View):
    """The same name shows the next scene in the same page, a view that was closed before or not."""
    tab.open("from-python")
    shown.close()
    tab.page.get_by_text("This session was deleted").wait_for()
    again = hookean.show({**CABLE, "particles": [[x, 1, 0] for x in range(6)]}, name="from-python", browser=False)
    tab.rests_at(again.particles)
    tab.page.get_by_text("This session was deleted").wait_for(state="detached")


@pytest.mark.soak
def test_a_service_is_started_where_none_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """The same folder as `hookean serve` uses has its address afterwards; the next `show` joins it."""
    monkeypatch.setenv("HOOKEAN_STATE", str(tmp_path / "state"))
    first = hookean.show(CABLE, browser=False)
    second = hookean.show(CABLE, browser=False)
    try:
        assert first.url.partition("#")[0] == second.url.partition("#")[0] and first.url != second.url
    finally:
        found = find(tmp_path / "state")
        assert found is not None and ask(found, "POST", "/v1/shutdown") is not None
        assert started.pop().wait(HANG) == 0
