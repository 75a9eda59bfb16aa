"""The start page: who is let in, the figures, the sessions that there are, and files that become sessions."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import quote, urlsplit

import numpy as np
import pytest

from hookean import Scene, Simulation
from hookean.files import project
from serving import CABLE, HANG
from soak import sampled

from .browser import Studio
from .conftest import Opened
from .service import Service, equilibrium

ROOT = Path(__file__).parents[2]
RHINO = ROOT.parent / "shared" / "data" / "rhino"


def drop(studio: Studio, name: str, content: bytes) -> None:
    """Let a file fall on the page, as from the desktop."""
    files = """([name, bytes]) => {
        const carried = new DataTransfer();
        carried.items.add(new File([new Uint8Array(bytes)], name));
        for (const what of ["dragenter", "dragover", "drop"]) {
            const event = new DragEvent(what, { dataTransfer: carried, bubbles: true, cancelable: true });
            (document.querySelector("main") ?? document.body).dispatchEvent(event);
        }
    }"""
    studio.page.evaluate(files, [name, list(content)])


# who is let in


def test_the_token_logs_in_once_and_leaves_the_address(open_studio: Opened):
    """Neither address nor history keeps the token; the cookie cannot be read by scripts; a reload needs no token."""
    studio = open_studio(alone=True)
    studio.start()
    page, token = studio.page, studio.service.token
    page.get_by_role("heading", name="Figures").wait_for()
    assert token not in page.url and token not in page.content()
    assert token not in page.evaluate("() => document.cookie + JSON.stringify(localStorage)")
    page.reload()
    page.get_by_role("heading", name="Figures").wait_for()


def test_who_has_no_token_is_told_what_to_do(open_studio: Opened):
    """The door says which command prints the address; a wrong token is refused in a sentence, the right one let in."""
    studio = open_studio(alone=True)
    studio.allowed = ["401"]
    page = studio.page
    page.goto(studio.service.url)
    page.get_by_text("hookean token --url").wait_for()
    page.get_by_label(re.compile("token", re.I)).fill("not-the-token-of-this-service")
    studio.press("Log in")
    page.get_by_role("alert").filter(has_text=re.compile("token", re.I)).wait_for()
    page.get_by_label(re.compile("token", re.I)).fill(studio.service.token)
    studio.press("Log in")
    page.get_by_role("heading", name="Figures").wait_for()


@pytest.mark.soak
def test_the_command_lets_a_browser_in(open_studio: Opened, tmp_path: Path):
    """The file that `hookean studio` gives a browser leads it to the page, logged in; then the file is gone, and the
    address and the history have no code."""
    studio = open_studio(alone=True)
    page, seen, stub = studio.page, tmp_path / "seen", tmp_path / "browser.py"
    stub.write_text(f"import pathlib, sys\npathlib.Path({str(seen)!r}).write_text(sys.argv[1])\n")
    state = {"HOOKEAN_STATE": str(studio.service.folder / "state"), "BROWSER": f"{sys.executable} {stub} %s"}
    command = [sys.executable, "-m", "hookean.cli", "studio"]
    with subprocess.Popen(command, env={**os.environ, **state}, stdout=subprocess.DEVNULL) as process:
        studio.until(lambda: seen.exists() and seen.read_text())
        page.goto(seen.read_text(), wait_until="commit")
        page.get_by_role("heading", name="Figures").wait_for()
        assert process.wait(HANG) == 0
    assert page.url == f"{studio.service.url}/" and not Path(urlsplit(seen.read_text()).path).exists()
    page.reload()
    page.get_by_role("heading", name="Figures").wait_for()


def test_a_link_needs_a_login_of_its_own(open_studio: Opened):
    """The link to a session holds no secret: in another browser it leads to the door."""
    studio = open_studio(alone=True)
    studio.allowed = ["401"]
    studio.service.put("linked", CABLE)
    studio.page.goto(f"{studio.service.url}/#s=linked")
    studio.page.get_by_text("hookean token --url").wait_for()


# figures and sessions


@pytest.mark.soak
def test_every_figure_is_in_the_gallery_with_its_picture(studio: Studio):
    page = studio.page
    listed = studio.service.client.get("/v1/examples").json()["examples"]
    assert len(listed) > 20
    for example in listed:
        card = page.get_by_role("button", name=f"{example['figure']} {example['title']}")
        card.scroll_into_view_if_needed()
        picture = card.locator("img").element_handle()
        page.wait_for_function("image => image.complete && image.naturalWidth > 0", arg=picture)


@pytest.mark.soak
def test_a_session_that_another_program_made_is_listed_shown_and_renamed(studio: Studio):
    """Grasshopper makes sessions by PUT, under keys of its own. The list of sessions has the name that it is given."""
    key = "roof.gh:4f8c-11"
    studio.service.put(key, CABLE)
    studio.page.get_by_role("link", name=key).click()
    studio.drawing()
    studio.rests_at(np.array(CABLE["particles"], float))
    studio.page.get_by_label("Name of the session").fill("Roof over the yard")
    studio.page.keyboard.press("Enter")
    studio.page.get_by_role("heading", level=1, name="Roof over the yard").wait_for()
    studio.page.go_back()
    studio.page.get_by_role("heading", name="Figures").wait_for()
    studio.page.get_by_role("link", name="Roof over the yard").wait_for()


def test_a_session_is_forgotten_when_that_is_confirmed(studio: Studio):
    studio.service.put("forgotten", CABLE)
    studio.page.on("dialog", lambda dialog: dialog.accept())
    studio.page.get_by_role("button", name="Delete forgotten").click()
    studio.page.get_by_role("link", name="forgotten", exact=True).wait_for(state="detached")
    assert "forgotten" not in [session["key"] for session in studio.service.summaries()]


# files


def test_a_rhino_file_is_dropped_and_becomes_a_session(studio: Studio):
    """What is drawn is what the service read of the file, where it is in the file."""
    if not RHINO.is_dir():
        pytest.skip("the files of Rhino are not here")
    name = "v7_my_curves.3dm"
    drop(studio, name, (RHINO / name).read_bytes())
    studio.press("Make the model")
    studio.drawing()
    drawn = studio.service.particles(studio.key)
    assert len(drawn) > 1
    studio.rests_at(drawn, 1e-3 * np.ptp(drawn))


@pytest.mark.soak
def test_a_model_of_a_figure_is_dropped_and_becomes_a_session(studio: Studio):
    drop(studio, "model.3dm", (ROOT / "gh_examples" / "9.4-cable" / "model.3dm").read_bytes())
    studio.press("Make the model")
    studio.drawing()
    assert len(studio.particles()) == len(studio.service.particles(studio.key))


@pytest.mark.soak
def test_an_obj_and_a_scene_are_opened_from_a_file(studio: Studio, tmp_path: Path):
    square = tmp_path / "square.obj"
    square.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    studio.page.get_by_label("File to open").set_input_files(square)
    studio.press("Make the model")
    studio.drawing()
    assert len(studio.particles()) == 4
    scene = tmp_path / "cable.json"
    scene.write_text(json.dumps(CABLE))
    studio.page.goto(studio.service.url)
    studio.page.get_by_label("File to open").set_input_files(scene)
    studio.drawing()
    studio.press("Solve")
    studio.rests_at(equilibrium(CABLE))


def test_a_view_with_invalid_values_is_named_and_the_model_opens(studio: Studio):
    """A view that another program wrote: what is valid of it is used, the rest is named in one sentence, here and in an
    address; one that was cut says so."""
    view = {
        "eye": "above",
        "colouring": "heat",
        "scale": {"kind": "auto", "low": "0"},
        "surface": 3,
        "groups": {"ends": [0, 99]},
        "groupColours": "red",
        "layers": [1],
        "picked": 7,
        "marked": [1, 2],
    }
    drop(studio, "cable.hookean", project.write(project.Project(Simulation(Scene.read(CABLE)), view)))
    studio.drawing()
    wrong = "camera, colouring, colour scale, groups, colours of groups, layers, picked element, surface"
    page = studio.page
    page.get_by_text(f"The view in the file has invalid values, which were left out: {wrong}.").wait_for()
    page.get_by_text("Select several").click()
    assert page.get_by_text("2 particles selected.").count() == 1
    page.keyboard.press("Escape")
    for told, said in (
        ('{"layers": 1}', "has invalid values, which were left out: layers."),
        ("eJyr", "is incomplete"),
    ):
        page.goto(f"{studio.service.url}/#s={studio.key}&v={quote(told)}")
        page.get_by_text(f"The view in the address {said}").wait_for()


NONE = [b"3D Geometry File Format " + bytes(200), b"not a model at all", b""]


@pytest.mark.parametrize("content", sampled(NONE, 3))
def test_a_file_that_is_none_is_refused_in_a_sentence(studio: Studio, content: bytes):
    studio.allowed = [r"\b4\d\d\b"]
    drop(studio, "broken.3dm", content)
    alert = studio.page.get_by_role("alert").filter(has_text="broken.3dm")
    alert.wait_for()
    assert "Traceback" not in alert.inner_text() and len(alert.inner_text()) < 500
    assert "#s=" not in studio.page.url


@pytest.mark.soak
def test_what_the_store_lost_is_named(open_studio: Opened, tmp_path: Path):
    """The database is deleted while the service is down: the start page names the session and where the copy is."""
    service = Service(tmp_path)
    try:
        assert service.client.put("/v1/sessions/roof", json=CABLE, params={"label": "The roof"}).status_code == 201
        service.kill()
        for file in (tmp_path / "state").glob("sessions.db*"):
            if not file.name.endswith((".manifest", ".lock")):
                file.unlink()
        service.start()
        studio = open_studio(at=service)
        studio.start()
        told = studio.page.get_by_role("status", name="The store")
        told.wait_for()
        assert "The roof" in told.inner_text() and "damaged-" in told.inner_text()
        studio.page.goto("about:blank")  # before its service ends
    finally:
        service.end()
