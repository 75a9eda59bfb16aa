"""Out: every format that the page gives is read again by the library whose format it is, and says what is seen."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import compas
import numpy as np
import pytest
import rhino3dm
from numpy.typing import NDArray
from PIL import Image

from hookean import Scene, Simulation
from hookean import open as open_scene

from .browser import Studio
from .conftest import Opened

FIGURE = "9.24-membrane"


@pytest.fixture
def membrane(lasting: Studio, browser: Any) -> Studio:
    """The membrane at rest, as drawn, in a page for all tests here."""
    service = lasting.service
    if FIGURE not in [session["key"] for session in service.summaries()]:
        service.put(FIGURE, service.example(FIGURE))
        service.act(FIGURE, "play?fast=true")
        service.at_rest(FIGURE)
    if not lasting.page.url.endswith(f"#s={FIGURE}"):
        lasting.open(FIGURE)
        lasting.rests_at(service.particles(FIGURE))
    return lasting


def taken(studio: Studio, button: str, ending: str) -> Path:
    """What a button downloads."""
    with studio.page.expect_download() as coming:
        studio.press(button)
    name = coming.value.suggested_filename
    assert name.endswith(ending) and "/" not in name
    return Path(coming.value.path())


def same_points(found: NDArray[np.float64], drawn: NDArray[np.float64], within: float = 1e-6) -> bool:
    """Whether two lists have the same points, whatever their order and how often each is named."""
    distances = np.linalg.norm(found[:, None] - drawn[None], axis=2)
    return bool(distances.min(axis=1).max() < within and distances.min(axis=0).max() < within)


@pytest.mark.soak
def test_stl_glb_and_svg_have_the_form_that_is_seen(membrane: Studio):
    """STL: two triangles for each quadrilateral, normals of length 1; GLB: the particles and lines between them; SVG: a
    line for each spring, as long as the canvas shows it. Numbers are of single precision; those of SVG have two digits
    behind the point."""
    drawn = membrane.particles()
    corners = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    stl = taken(membrane, "STL", ".stl").read_bytes()
    triangles = np.frombuffer(stl, corners, offset=84)
    topology = membrane.service.client.get(f"/v1/sessions/{FIGURE}/topology").json()
    faces = {frozenset(face) for mesh in topology["meshes"].values() for face in mesh["faces"]}
    assert len(triangles) == int.from_bytes(stl[80:84], "little") == sum(len(face) - 2 for face in faces)
    assert same_points(triangles["corners"].reshape(-1, 3), drawn, 1e-5)
    assert np.linalg.norm(triangles["normal"], axis=1) == pytest.approx(1, abs=1e-6)

    glb = taken(membrane, "GLB", ".glb").read_bytes()
    assert glb[:4] == b"glTF" and int.from_bytes(glb[8:12], "little") == len(glb)
    size = int.from_bytes(glb[12:16], "little")
    told, binary = json.loads(glb[20 : 20 + size]), glb[28 + size :]
    places, *rest = told["bufferViews"]
    found = np.frombuffer(binary, "<f4", places["byteLength"] // 4).reshape(-1, 3)
    assert np.abs(found - drawn).max() < 1e-5 and told["nodes"][0]["scale"] == [1, 1, 1]
    assert told["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] == 0  # else viewers show dark metal
    assert all(np.frombuffer(binary, "<u4", v["byteLength"] // 4, v["byteOffset"]).max() < len(drawn) for v in rest)

    svg = ElementTree.parse(taken(membrane, "SVG", ".svg")).getroot()
    [lines] = [[*group] for group in svg if group.get("id") == "springs"]
    assert len(lines) == len(topology["springs"]) > 0
    x1, y1, x2, y2 = (float(lines[0].get(name, "nan")) for name in ("x1", "y1", "x2", "y2"))
    one, other = map(membrane.seen, topology["springs"][0])
    assert (x1 - x2, y1 - y2) == pytest.approx(np.subtract(one, other), abs=0.02)


@pytest.mark.soak
def test_the_rhino_file_has_the_shape_that_is_seen(membrane: Studio):
    """Read by rhino3dm: a mesh whose vertices are the particles, with its unit."""
    model = rhino3dm.File3dm.Read(str(taken(membrane, "Rhino .3dm", ".3dm")))
    meshes = [item.Geometry for item in model.Objects if isinstance(item.Geometry, rhino3dm.Mesh)]
    found = np.array([[v.X, v.Y, v.Z] for mesh in meshes for v in mesh.Vertices])
    assert same_points(found, membrane.particles(), 1e-5)  # of single precision, as vertices in such files
    assert model.Settings.ModelUnitSystem == rhino3dm.UnitSystem.Meters


@pytest.mark.soak
def test_the_obj_has_the_shape_that_is_seen(membrane: Studio):
    lines = [line.split() for line in taken(membrane, "OBJ", ".obj").read_text().splitlines()]
    found = np.array([line[1:4] for line in lines if line and line[0] == "v"], float)
    faces = [[int(corner.split("/")[0]) for corner in line[1:]] for line in lines if line and line[0] == "f"]
    assert same_points(found, membrane.particles())
    assert faces and max(map(max, faces)) <= len(found)


@pytest.mark.soak
def test_the_compas_document_has_the_shape_that_is_seen(membrane: Studio):
    """Read by COMPAS: its Mesh."""
    mesh = compas.json_load(str(taken(membrane, "COMPAS JSON", ".json")))
    assert isinstance(mesh, compas.datastructures.Mesh)
    found = np.array([mesh.vertex_coordinates(vertex) for vertex in mesh.vertices()])
    assert same_points(found, membrane.particles())
    assert mesh.number_of_faces() > 0


def test_the_table_has_every_force_and_reaction_with_its_unit(membrane: Studio):
    """Forces of the springs and reactions of the anchors: the service's own, and they balance the loads."""
    rows = list(csv.reader(taken(membrane, "CSV", ".csv").read_text("utf-8-sig").splitlines()))
    state = membrane.service.state(membrane.key)
    cells = {round(float(cell), 6) for row in rows for cell in row if cell.replace(".", "").lstrip("-").isdigit()}
    springs = next(force for force in state["forces"] if force["kind"] == "springs")["force"]
    assert len(rows) > len(springs) and {round(force, 6) for force in springs} <= cells
    assert {round(part, 6) for reaction in state["reactions"]["force"] for part in reaction} <= cells
    assert "[N]" in str(rows) or '"N"' in str(rows) or "'N'" in str(rows)


@pytest.mark.soak
def test_the_simulation_goes_on_in_python(membrane: Studio):
    """The npz is what Simulation.load reads."""
    simulation = Simulation.load(taken(membrane, "npz", ".npz"))
    assert np.abs(np.asarray(simulation.frame().particles) - membrane.particles()).max() < 1e-6


def test_the_picture_is_what_is_seen(membrane: Studio):
    """A PNG in the canvas's shape, at full quality, with the form in it where the page has it, and the legend: in its
    corner a ramp of colours, 160 CSS pixels wide below two lines of 20."""
    with Image.open(taken(membrane, "PNG", ".png")) as picture:
        assert picture.format == "PNG"
        pixels = np.asarray(picture.convert("RGB"), int)
    box = membrane.page.locator("canvas").first.bounding_box()
    assert box is not None
    height, width, _ = pixels.shape
    assert width >= box["width"] - 1 and abs(width / height - box["width"] / box["height"]) < 0.02
    differs = np.abs(pixels - pixels[2, 2]).sum(axis=2) > 24
    assert 0.01 < differs.mean() < 0.9
    row, left, right = (round(at * width / box["width"]) for at in (61, 18, 174))
    assert len(np.unique(pixels[row, left:right], axis=0)) > 30
    for particle in (0, len(membrane.particles()) // 2):
        x, y = membrane.place(particle)
        column, row = (round((at - start) * width / box["width"]) for at, start in ((x, box["x"]), (y, box["y"])))
        assert differs[max(0, row - 6) : row + 7, max(0, column - 6) : column + 7].any()


@pytest.mark.soak
def test_the_link_shows_the_same_scene(membrane: Studio, open_studio: Opened):
    """Copied, and opened in another window of the same browser."""
    membrane.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    membrane.press("Copy link")
    membrane.page.get_by_text("The link was copied").wait_for()
    link = membrane.page.evaluate("() => navigator.clipboard.readText()")
    assert membrane.key in link and membrane.service.token not in link
    other = open_studio()
    assert other.page.context == membrane.page.context
    other.page.goto(link)
    other.drawing()
    other.rests_at(membrane.particles(), 1e-6)


def test_what_is_saved_reopens_as_the_same_model(membrane: Studio):
    """Save gives one file: opened here, it has the same scene, shape to the bit, view, and a group of 20,000 numbers;
    Python reads the same."""
    page, service = membrane.page, membrane.service
    many = np.random.default_rng(5).integers(0, 441, 20_000).tolist()
    page.evaluate("(many) => localStorage.setItem('hookean-groups-9.24-membrane', many)", json.dumps({"many": many}))
    page.reload()
    membrane.drawing()
    membrane.press("Top")
    page.get_by_role("radio", name="Strain").check()
    seen = membrane.place(0)
    saved = taken(membrane, "Save", ".hookean")
    before, shape = service.scene(membrane.key), service.particles(membrane.key)
    page.goto(service.url)
    page.get_by_label("File to open").set_input_files(
        {"name": "roof.hookean", "mimeType": "application/octet-stream", "buffer": saved.read_bytes()}
    )
    membrane.until(lambda: "#s=" in page.url)
    membrane.drawing()
    assert service.scene(membrane.key) == before
    assert np.array_equal(service.particles(membrane.key), shape)
    assert np.abs(np.subtract(membrane.place(0), seen)).max() < 1.0  # CSS pixels
    assert page.get_by_role("radio", name="Strain").is_checked()
    assert page.get_by_role("heading", name="roof").is_visible()
    assert json.loads(page.evaluate("(key) => localStorage.getItem('hookean-groups-' + key)", membrane.key)) == {
        "many": many
    }
    named = saved.with_suffix(".hookean")
    named.write_bytes(saved.read_bytes())
    assert open_scene(named).canonical == Scene.read(before).canonical


@pytest.mark.soak
def test_no_export_doubles_faces(membrane: Studio):
    """A membrane of 20 x 20 faces has 400 of them in every file, read by the library whose format it is."""
    items = rhino3dm.File3dm.Read(str(taken(membrane, "Rhino .3dm", ".3dm"))).Objects
    meshes = [item.Geometry for item in items if isinstance(item.Geometry, rhino3dm.Mesh)]
    assert sum(len(mesh.Faces) for mesh in meshes) == 400
    assert sum(line.startswith("f ") for line in taken(membrane, "OBJ", ".obj").read_text().splitlines()) == 400
    assert compas.json_load(str(taken(membrane, "COMPAS JSON", "-compas.json"))).number_of_faces() == 400
