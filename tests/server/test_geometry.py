"""The geometry in a .3dm file, over HTTP: the numbers that rhino3dm reads from it."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
import rhino3dm

from fuzz import damage
from hookean.discretize.breps import mesh_faces
from hookean.files.rhino import plain as threedm_plain
from hookean.files.rhino import threedm
from hookean_server.routes.geometry import KINDS

from .conftest import problem

Point = rhino3dm.Point3d
SURFACE = rhino3dm.Sphere(Point(0, 0, 0), 2.0).ToBrep().Surfaces[0].ToNurbsSurface()


def drawn() -> list[tuple[str, Any]]:
    """An object of each kind, by layer."""
    corners = [Point(0, 0, 0), Point(1, 0, 0), Point(1, 1, 0)]
    cloud, mesh = rhino3dm.PointCloud(), rhino3dm.Mesh()
    for x in range(3):
        cloud.Add(Point(x, 0.1, 0.2))
    for corner in (*corners, Point(0, 1, 0)):
        mesh.Vertices.AddPoint3d(corner.X, corner.Y, corner.Z)
    mesh.Faces.AddFace(0, 1, 2, 3)
    bent = rhino3dm.Arc(Point(0, 0, 0), 2.0, 1.5).ToNurbsCurve()
    box = rhino3dm.Brep.CreateFromBox(rhino3dm.Box(rhino3dm.BoundingBox(0, 0, 0, 1, 2, 3)))
    return [
        ("point", rhino3dm.Point(Point(1.1, 2.2, 3.3))),
        ("points", cloud),
        ("line", rhino3dm.LineCurve(corners[0], corners[1])),
        ("polyline", rhino3dm.PolylineCurve(corners)),
        ("curve", bent),
        ("surface", SURFACE),
        ("brep", box),
        ("mesh", mesh),
        ("none", rhino3dm.TextDot("left out", corners[0])),
    ]


@pytest.fixture(scope="module")
def drawing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = rhino3dm.File3dm()
    file.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Millimeters
    for kind, geometry in drawn():
        layer, attributes = rhino3dm.Layer(), rhino3dm.ObjectAttributes()
        layer.Name, attributes.Name = f"layer of {kind}", f"a {kind}"
        attributes.LayerIndex = file.Layers.Add(layer)
        file.Objects.Add(geometry, attributes)
    path: Path = tmp_path_factory.mktemp("drawing") / "each.3dm"
    assert file.Write(str(path), 7)
    return path


def read(client: httpx.Client, data: bytes, **query: Any) -> httpx.Response:
    return client.post("/v1/geometry/3dm", files={"file": ("../a.3dm", data)}, params=query)


def test_every_kind_of_object(client: httpx.Client, drawing: Path) -> None:
    answer = read(client, drawing.read_bytes(), u=6, v=5)
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert (found["unit"], found["metres"]) == ("Millimeters", 0.001)
    assert [o["kind"] for o in found["objects"]] == list(threedm_plain.KINDS) == KINDS
    assert all((o["layer"], o["name"]) == (f"layer of {o['kind']}", f"a {o['kind']}") for o in found["objects"])
    assert any("left out" in sentence for sentence in found["warnings"])
    by = {o["kind"]: o for o in found["objects"]}
    assert by["point"]["points"] == [[1.1, 2.2, 3.3]] and len(by["points"]["points"]) == 3
    assert by["line"]["points"] == [[0, 0, 0], [1, 0, 0]] and len(by["polyline"]["points"]) == 3
    assert by["mesh"]["faces"] == [[0, 1, 2, 3]]
    assert set(by["curve"]) >= {"degree", "points", "knots", "weights"}
    assert by["surface"]["mesh"]["faces"] == mesh_faces(SURFACE, 6, 5).faces.tolist()
    assert len(by["brep"]["mesh"]["faces"]) > 100 and "degree_u" not in by["brep"]


def test_damaged_objects_are_left_out_by_name_and_no_other(tmp_path: Path) -> None:
    """No number that is not finite comes out, and a damaged mesh does not cost the rest of the file."""
    file, holed = rhino3dm.File3dm(), rhino3dm.Mesh()
    for x in (0.0, 1.0, 2.0):
        holed.Vertices.Add(x, 0.0, 0.0)
    holed.Faces.AddFace(0, 1, 77)
    bent = rhino3dm.NurbsCurve.Create(False, 2, [Point(0, 0, 0), Point(float("nan"), 1, 0), Point(2, 0, 0)])
    bad = [rhino3dm.Point(Point(float("nan"), 0, 0)), bent, holed]
    for geometry in (*bad, rhino3dm.Point(Point(1, 2, 3))):
        file.Objects.Add(geometry, rhino3dm.ObjectAttributes())
    assert file.Write(str(tmp_path / "damaged.3dm"), 8)
    found = threedm_plain.plain(threedm.read(tmp_path / "damaged.3dm"))
    assert [one["points"].tolist() for one in found["objects"]] == [[[1.0, 2.0, 3.0]]]
    assert [sentence.split()[0] for sentence in found["warnings"]] == ["Point", "NurbsCurve", "Mesh"]


def test_it_is_what_the_core_reads(client: httpx.Client, drawing: Path) -> None:
    wanted = threedm_plain.plain(threedm.read(drawing))
    found = read(client, drawing.read_bytes(), arrays="buffer").json()
    for one, other in zip(wanted["objects"], found["objects"], strict=True):
        assert set(one) == set(other) and "mesh" not in one
        for name in set(one) & {"points", "vertices", "knots", "knots_u", "weights"}:
            array = np.frombuffer(base64.b64decode(other[name]["base64"]), other[name]["dtype"])
            assert (array.reshape(other[name]["shape"]) == one[name]).all()


def test_faulty_requests(client: httpx.Client, drawing: Path) -> None:
    data = drawing.read_bytes()
    for part in (0.2, 0.9):
        found = problem(read(client, data[: int(part * len(data))]), 422, "invalid-input")
        assert found["errors"][0]["pointer"] == "/file" and "/tmp" not in str(found)
    problem(read(client, data, u=3), 422, "invalid-input")
    problem(read(client, data, u=0, v=1), 422, "invalid-input")
    problem(read(client, data, u=2000, v=2000), 422, "invalid-input")
    form = {"files": {"file": ("a.3dm", data)}, "data": {"recipe": "{}"}}
    found = problem(client.post("/v1/geometry/3dm", **form), 422, "invalid-input")
    assert found["errors"][0]["pointer"] == "/recipe"


def test_damaged_files_are_the_files_fault(client: httpx.Client) -> None:
    files = damage.seeds()
    for number in range(0, 2000, 400):
        _, _, data = damage.mutant(files, number)
        answer = read(client, data, u=3, v=2)
        assert answer.status_code in (200, 422), (number, answer.text[:300])
