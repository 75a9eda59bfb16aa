"""What is read in the page beside forces: the surface, load cases, a recording; numbers are those of the Python API.

One page and one session for all tests of this file, in their order.
"""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hookean
from hookean.discretize import grid, naked_vertices
from hookean.files import project
from serving import wait_for

from .browser import LAPTOP, Studio
from .service import Service

pytestmark = pytest.mark.slow
SHOWN = 6e-4
"""Relative: panels print four digits."""
LEGEND = 5e-3
"""Relative: the legend prints three digits."""


def roof() -> dict[str, Any]:
    """A small saddle with snow, of springs whose strength is known."""
    scene: dict[str, Any] = json.loads(hookean.family("saddle", {"force": "kN"}, across=4, along=4, rise=2.5).canonical)
    net, edge = (force["name"] for force in scene["forces"])
    scene["forces"].append({"kind": "area_weight", "name": "snow", "mesh": "net", "weight": 0.6, "per": "plan"})
    scene["load_cases"] = {"snow": {"forces": ["snow"]}}
    scene["combinations"] = {"ULS": {"snow": 1.5}}
    lines = {net: {"axial_stiffness": 500, "strength": 50}, edge: {"axial_stiffness": 5000, "strength": 200}}
    scene["stages"] = {"freeze": lines}
    return scene


@pytest.fixture
def studio(lasting: Studio, browser: Any, service: Service) -> Studio:
    """The roof at rest, in a page for all tests here."""
    if "#s=" not in lasting.page.url:
        service.put("reading", roof())
        service.act("reading", "relax")
        service.at_rest("reading")
        lasting.open("reading")
    return lasting


def unfold(studio: Studio, panel: str) -> None:
    found = studio.page.locator(".panel > summary", has=studio.page.get_by_role("heading", name=panel, exact=True))
    if not found.evaluate("(one) => one.parentElement.open"):
        found.click()


def present(studio: Studio) -> hookean.Simulation:
    """The session as the Python API continues it."""
    answer = studio.service.client.get(f"/v1/sessions/{studio.key}/state", params={"format": "npz"})
    return hookean.Simulation.load(io.BytesIO(answer.content))


def number(text: str) -> float:
    found = re.search(r"-?\d[\d.]*(?:e-?\d+)?", text)
    assert found, text
    return float(found[0])


def loads(result: hookean.Result) -> np.ndarray:
    """What acts on each particle, a load on a face in even parts on its corners [force]."""
    sums = np.zeros_like(result.particles)
    for force, shape in zip(result.forces, result.scene.forces, strict=True):
        if shape.role == "load":
            corners = np.asarray(force["particles"])
            np.add.at(sums, corners, (force["force"] / corners.shape[1])[:, None])
    return sums


def test_the_surface_is_coloured_and_its_extremes_are_those_of_python(studio: Studio):
    page = studio.page
    unfold(studio, "Surface")
    page.get_by_role("checkbox", name="Water", exact=True).check()
    page.get_by_role("checkbox", name="Height lines").check()
    truth = hookean.surface(present(studio), drops=200)
    for seen, values in (
        ("Slope", truth.slope),
        ("Displacement", truth.displacement),
        ("Gaussian curvature", truth.gaussian_curvature),
    ):
        page.get_by_role("radio", name=seen, exact=True).check()
        ends = page.locator("dl", has=page.get_by_role("term").filter(has_text="Smallest")).get_by_role("definition")
        ends.first.wait_for()
        found = [number(one) for one in ends.all_inner_texts()]
        assert found == pytest.approx([np.nanmin(values), np.nanmax(values)], rel=SHOWN, abs=1e-9)
        page.get_by_role("group", name="Legend").get_by_text(seen).wait_for()
    staying = int(truth.water.stays.sum())
    page.get_by_text(f"{staying} of 32 drops stay" if staying else "All 32 drops run off.").wait_for()
    assert page.get_by_role("spinbutton", name=re.compile("Step of height lines")).get_attribute("placeholder") == str(
        truth.heights.step
    )
    page.get_by_role("radio", name="Nothing").check()


@pytest.mark.soak
def test_load_cases_are_solved_and_the_largest_values_listed(studio: Studio):
    page = studio.page
    unfold(studio, "Load cases")
    studio.press("Solve the load cases")
    page.get_by_label("Show the case").wait_for()
    truth = hookean.load_cases(hookean.Scene.read(studio.service.scene(studio.key)))
    table = page.get_by_role("region", name="Largest of all load cases")
    rows = {row.split("\t")[0]: row.split("\t")[1:] for row in table.inner_text().splitlines()[1:] if "\t" in row}
    envelope = truth.envelope
    moved = envelope.displacement.largest
    assert float(rows["Displacement [m]"][0]) == pytest.approx(moved.max(), rel=SHOWN)
    assert float(rows["Reaction [kN]"][0]) == pytest.approx(envelope.reaction.largest.max(), rel=SHOWN)
    used = [f["columns"]["utilisation"].largest.max() for f in envelope.forces if "utilisation" in f["columns"]]
    shown = [float(cells[0]) for name, cells in rows.items() if name.endswith("utilisation [%]")]
    assert shown == pytest.approx(100 * np.array(used), rel=SHOWN)
    assert all(cells[-1] == "ULS" for cells in rows.values())

    legend = page.get_by_role("group", name="Legend")
    # of the largest values of all cases, neither loads nor directions of reactions are known
    studio.until(lambda: "up to" not in legend.inner_text(), what="no arrows")
    page.get_by_label("Show the case").select_option("ULS")
    page.get_by_role("radio", name="Utilisation").check()
    legend.get_by_text("Utilisation [%]").wait_for()
    largest = np.linalg.norm(loads(truth.cases["ULS"].result), axis=1).max()
    up_to = legend.get_by_text(re.compile(r"Load\s+up to")).inner_text()
    assert number(up_to) == pytest.approx(largest, rel=LEGEND)
    page.get_by_label("Show the case").select_option("form")  # bears no case, so it has no utilisation
    page.get_by_role("radio", name="Utilisation").wait_for(state="detached")
    page.get_by_role("group", name="Legend").get_by_text("Force [kN]").wait_for()
    page.get_by_label("Show the case").select_option("ULS")
    page.get_by_role("group", name="Legend").get_by_text("Utilisation [%]").wait_for()
    drawn = truth.cases["ULS"].result.particles
    studio.until(lambda: np.abs(studio.particles() - drawn).max() < 1e-4)
    # what is written on the canvas is of the case, too, and the panel of what is picked is not
    page.get_by_label("Spring number").fill("0")
    page.keyboard.press("Enter")
    page.get_by_text("Present values. The canvas shows: ULS.").wait_for()
    page.get_by_label("Labels", exact=True).select_option("forces")
    written = page.get_by_role("img", name="Written beside the form")
    force = truth.cases["ULS"].result.forces[0]["force"][0]
    assert number(written.locator("text").text_content() or "") == pytest.approx(force, rel=LEGEND)
    page.get_by_label("Particles to measure").evaluate("(one) => (one.closest('details').open = true)")
    page.get_by_label("Particles to measure").fill("0 12")
    measured = page.get_by_role("img", name="Measured lengths").locator("text").first
    assert number(measured.text_content() or "") == pytest.approx(np.linalg.norm(drawn[12] - drawn[0]), rel=SHOWN)
    page.get_by_label("Particles to measure").fill("")
    page.get_by_label("Labels", exact=True).select_option("none")
    page.get_by_label("Spring number").fill("")
    page.keyboard.press("Enter")
    before = studio.service.summary(studio.key)["revision"]
    studio.drag(0, 40, -60)  # turns the view: what is not of now cannot be moved
    assert studio.service.summary(studio.key)["revision"] == before
    page.get_by_role("group", name="Shown shape").get_by_role("button", name="Back to now").click()
    studio.rests_at(studio.service.particles(studio.key))
    assert page.get_by_label("Show the case").input_value() == ""


@pytest.mark.soak
def test_a_recording_is_scrubbed_charted_and_saved(studio: Studio, tmp_path: Path):
    page, service, key = studio.page, studio.service, studio.key
    unfold(studio, "Time")
    unfold(studio, "Charts")
    service.act(key, "reset")
    start = service.particles(key)
    studio.until(lambda: np.abs(studio.particles() - start).max() < 1e-4)
    page.get_by_label("Particle number").fill("12")
    page.keyboard.press("Enter")
    studio.press("Record")
    studio.press("Play")
    wait_for(lambda: np.abs(service.particles(key) - start).max() > 0.01)
    studio.press("Pause")
    studio.until(lambda: np.abs(studio.particles() - service.particles(key)).max() < 1e-4)
    studio.press("Stop recording")

    moment = page.get_by_role("slider", name="Moment of the recording")
    moment.focus()
    page.keyboard.press("Home")
    page.get_by_role("group", name="Shown shape").get_by_text("Recording at 0.00 s").wait_for()
    studio.until(lambda: np.abs(studio.particles() - start).max() < 1e-4)
    page.get_by_label("Name of the bookmark").fill("flat")
    studio.press("Bookmark")
    page.keyboard.press("End")
    with page.expect_download() as charts:
        studio.press("Save charts")
    rows = list(csv.reader(io.StringIO(Path(charts.value.path()).read_text())))
    assert rows[0] == ["time [s]", "x [m]", "y [m]", "z [m]"]
    assert [float(value) for value in rows[1][1:]] == pytest.approx(start[12], abs=1e-5)
    assert [float(value) for value in rows[-1][1:]] == pytest.approx(service.particles(key)[12], abs=1e-4)

    page.get_by_label("Pictures per second", exact=True).last.select_option("15")
    with page.expect_download() as video:
        studio.press("Save video")
    saved = tmp_path / "video"
    video.value.save_as(saved)
    assert video.value.suggested_filename == "reading.webm" and saved.read_bytes()[:4] == b"\x1a\x45\xdf\xa3"  # EBML
    page.get_by_role("list", name="Bookmarks").get_by_role("button", name="flat", exact=True).click()
    studio.until(lambda: np.abs(studio.particles() - start).max() < 1e-4)
    service.edit(key, {"settings": {"drag": 1.0}})  # an edit is of the present shape
    page.get_by_role("group", name="Shown shape").wait_for(state="detached")

    count = page.get_by_text(" frames in ").inner_text()
    page.reload()  # this browser keeps both as long as the session
    studio.drawing()
    unfold(studio, "Time")
    page.get_by_text(count).wait_for()
    page.get_by_role("list", name="Bookmarks").get_by_role("button", name="flat", exact=True).click()
    studio.until(lambda: np.abs(studio.particles() - start).max() < 1e-4)

    unfold(studio, "Save and export")  # a file has both, too, beside what other programs read in it
    with page.expect_download() as saving:
        studio.press("Save")
    file = tmp_path / "recorded.hookean"
    saving.value.save_as(file)
    assert len(project.read(file.read_bytes()).simulation.result().particles) == len(start)
    page.get_by_role("link", name="All sessions").click()
    page.get_by_label("File to open").set_input_files(file)
    page.wait_for_url(lambda url: re.search(r"#s=[0-9a-f]{32}$", url) is not None and key not in url)
    studio.drawing()
    unfold(studio, "Time")
    page.get_by_text(count).wait_for()
    page.get_by_role("list", name="Bookmarks").get_by_role("button", name="flat", exact=True).click()
    studio.until(lambda: np.abs(studio.particles() - start).max() < 1e-4)
    service.client.delete(f"/v1/sessions/{studio.key}")
    studio.open(key)


def test_nothing_here_is_hard_to_reach(studio: Studio):
    """Every control has a name, and nothing of these panels is wider than a phone."""
    page = studio.page
    axe = Path(__file__).parents[2] / "studio" / "node_modules" / "axe-core" / "axe.min.js"
    if axe.is_file():
        page.evaluate(axe.read_text())
        found = page.evaluate("() => axe.run('aside').then((done) => done.violations.map((one) => one.id))")
        assert found == []
    page.set_viewport_size({"width": 390, "height": 844})
    assert page.evaluate("() => document.documentElement.scrollWidth") <= 390
    page.set_viewport_size(LAPTOP)


@pytest.mark.soak
def test_cloth_is_coloured_by_its_utilisation(studio: Studio):
    """Numbers of the page in percent; those of cloth are offered for models that have cloth."""
    page, service = studio.page, studio.service
    assert not page.get_by_role("radio", name="Utilisation of cloth").count()
    mesh = grid(np.arange(5.0), np.arange(5.0), np.add.outer(np.arange(5.0), -np.arange(5.0)) * 0.2)
    cloth = {"warp_stiffness": 800.0, "weft_stiffness": 600.0, "shear_stiffness": 20.0, "warp_strength": 60.0}
    service.put("cloth", {
        "particles": mesh.vertices.tolist(),
        "meshes": {"skin": {"vertices": mesh.vertices.tolist(), "faces": mesh.faces.tolist()}},
        "materials": {"cloth": cloth},
        "forces": [{"kind": "membrane", "mesh": "skin", "material": "cloth", "warp": [1, 0, 0],
                    "prestress": [3.0, 2.5, 0.0]},
                   {"kind": "area_weight", "mesh": "skin", "weight": 5.0}],
        "anchors": [{"particles": naked_vertices(mesh).tolist()}],
    })  # fmt: skip
    service.act("cloth", "relax")
    service.at_rest("cloth")
    studio.open("cloth")
    unfold(studio, "Surface")
    page.get_by_role("radio", name="Utilisation of cloth", exact=True).check()
    ends = page.locator("dl", has=page.get_by_role("term").filter(has_text="Smallest")).get_by_role("definition")
    ends.first.wait_for()
    truth = 100.0 * hookean.surface(present(studio)).cloth.utilisation
    assert [number(one) for one in ends.all_inner_texts()] == pytest.approx([truth.min(), truth.max()], rel=SHOWN)
    page.get_by_role("group", name="Legend").get_by_text("Utilisation of cloth [%]").wait_for()
