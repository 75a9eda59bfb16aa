"""One file gives one scene, whoever opens it: the command line, the studio, HTTP. One list of readers serves all."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import compas.data
import httpx
import pytest
from compas.datastructures import Graph, Mesh
from compas.geometry import Line, Pointcloud, Polygon, Polyline
from typer.testing import CliRunner

from hookean import InputError, Scene, relax
from hookean.cli import app
from hookean.commands.examples import find
from hookean.files.readers import READERS, Source, endings, read, reader
from hookean.files.relax_file import open_file
from hookean.running.in_motion import in_motion
from serving import CABLE
from soak import sampled

from .conftest import problem

ROOT = Path(__file__).resolve().parents[2]
SHEET = "".join(f"v {i} {j} {0.03 * (i * j) ** 2}\n" for i in range(4) for j in range(4)) + "".join(
    f"f {4 * i + j + 1} {4 * i + j + 5} {4 * i + j + 6} {4 * i + j + 2}\n" for i in range(3) for j in range(3)
)
ROPE = "# lengths in mm\nv 0 0 0\nv 1000 0 0\nv 2000 0 500\no rope\nl 1 2 3\nvn 0 0 1\n"
CUBE = Mesh.from_polyhedron(6)


def written(value: Any) -> str:
    text: str = compas.data.json_dumps(value)
    return text


def tent() -> Mesh:
    mesh = Mesh.from_meshgrid(4.0, nx=4)
    mesh.vertex_attribute(12, "z", 2.0)
    mesh.name = "tent"
    return mesh


DRAWN = [Line([0, 0, 0], [1, 0, 0]), Polyline([[1, 0, 0], [2, 0, 1], [3, 0, 0]])]
FILES: dict[str, str | bytes] = {
    "sheet.obj": SHEET,
    "ROPE.OBJ": ROPE,
    "scene.json": json.dumps(CABLE),
    "scene with a document.json": json.dumps(
        {**CABLE, "geometry": [json.loads(written(Polyline(CABLE["particles"])))]}
    ),
    "mesh.json": written(tent()),
    "graph.json": written(Graph.from_lines([[[0, 0, 0], [1, 0, 3]], [[1, 0, 3], [2, 0, 0]]])),
    "line.json": written(DRAWN[0]),
    "list.json": written([*DRAWN, tent(), Polygon([[5, 0, 0], [6, 0, 0], [5, 1, 0]]), Pointcloud([[0, 0, 0]])]),
    "drawn.3dm": find("9.26").folder.joinpath("model.3dm").read_bytes(),
}


def body(name: str) -> bytes:
    data = FILES[name]
    return data if isinstance(data, bytes) else data.encode()


def opened(client: httpx.Client, name: str, data: bytes, **more: Any) -> dict[str, Any]:
    """The session that the studio opens of a file, and its scene."""
    made = client.post("/v1/sessions", files={"file": (name, data), **more})
    assert made.status_code == 201, made.text
    scene = client.get(f"{made.headers['location']}/scene").json()
    client.delete(made.headers["location"])
    return {**made.json(), "scene": Scene.read(scene)}


def by_command(folder: Path, *words: str) -> dict[str, Any]:
    """The report of `hookean relax`."""
    done = CliRunner().invoke(app, ["relax", *words, "--report", str(folder / "report.json")])
    assert done.exit_code in (0, 3), done.output
    found: dict[str, Any] = json.loads((folder / "report.json").read_text())
    return found


@pytest.mark.parametrize("name", sampled(FILES, 3))
def test_a_file_is_one_scene_to_all(client: httpx.Client, tmp_path: Path, name: str) -> None:
    """The digest in the report of the command, the scene of the studio's session and, of JSON, the result over HTTP."""
    path = tmp_path / name
    path.write_bytes(body(name))
    scene = open_file(path).scene
    report = by_command(tmp_path, str(path))
    assert report["digest"] == scene.digest
    session = opened(client, name, body(name))
    assert session["scene"].digest == in_motion(scene)[0].digest
    assert set(report["warnings"]) >= {said for said in session["warnings"] if "steps of" not in said}
    if name.endswith(".json"):
        answer = client.post("/v1/relax", content=body(name), headers={"content-type": "application/json"})
        assert answer.status_code == 200, answer.text
        wanted = relax(scene)
        assert answer.json()["particles"] == wanted.particles.tolist()
        assert answer.json()["message"] == wanted.message == report["result"]["message"]
    if name.endswith(".3dm"):
        answer = client.post("/v1/relax/3dm", files={"file": (name, body(name))}, params={"answer": "report"})
        assert answer.json()["digest"] == scene.digest


def test_a_model_with_its_recipe_is_one_scene_to_all(client: httpx.Client, tmp_path: Path) -> None:
    folder = find("9.24").folder
    model, recipe = folder / "model.3dm", folder / "recipe.toml"
    digest = open_file(model, recipe.read_text()).scene.digest
    assert by_command(tmp_path, str(model), "-r", str(recipe))["digest"] == digest
    form = {"file": ("model.3dm", model.read_bytes()), "recipe": (None, recipe.read_text())}
    assert client.post("/v1/relax/3dm", files=form, params={"answer": "report"}).json()["digest"] == digest
    session = opened(client, "model.3dm", model.read_bytes(), recipe=(None, recipe.read_text()))
    assert (
        session["scene"].digest == in_motion(Scene.read(open_file(model, recipe.read_text()).scene.canonical))[0].digest
    )
    faulty = {**tomllib.loads(recipe.read_text()), "forces": [{"kind": "springs", "lines": "layer:none"}]}
    made = client.post("/v1/sessions", files={**form, "recipe": (None, json.dumps(faulty))})
    assert problem(made, 422, "invalid-input")["errors"][0]["pointer"].startswith("/recipe/forces/0")


@pytest.mark.parametrize("target", ["out.obj", "out.3dm", "out.json"])
def test_an_obj_file_is_relaxed_by_the_command(tmp_path: Path, target: str) -> None:
    """Into a file of each kind; an OBJ file has the solved particles to the last digit, and is read again."""
    source = tmp_path / "sheet.obj"
    source.write_text(SHEET)
    found = by_command(tmp_path, str(source), "-o", str(tmp_path / target))
    assert found["result"]["status"] == "converged" and found["result"]["iterations"] > 0
    if target == "out.json":
        assert json.loads((tmp_path / target).read_text())["particles"] == found["result"]["particles"]
        return
    if target == "out.obj":
        text = (tmp_path / target).read_text()
        rows = [[float(c) for c in line.split()[1:]] for line in text.splitlines() if line.startswith("v ")]
        assert rows == found["result"]["particles"] and "# hookean:status converged\n" in text
        again = read(text.encode(), target)
        assert not again.warnings and len(again.scene.meshes) == 1


def test_commands_name_what_is_wrong_with_a_file(tmp_path: Path) -> None:
    """The file, the line, what is allowed: in one line, and exit code 2."""
    faults = {
        "a.obj": ("v 0 0\n", "a.obj: line 1: a vertex needs three coordinates"),
        "lid.obj": (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
            "lid.obj: the mesh is closed",
        ),
        "cube.json": (written(CUBE), "cube.json: a closed mesh has no naked vertices, so nothing is held"),
        "a.stl": ("solid\n", "a.stl cannot be opened; give a .3dm, .obj, .json, .npz or .hookean file"),
        "b.json": ('{"forces": [{"kind": "springs", "lines": 7}]}', "b.json /forces/0/lines"),
        "c.json": ('{"status": "converged", "particles": []}', "c.json is a result, not a scene"),
        "d.json": ("[]", "d.json has no lines or faces"),
    }
    for name, (text, said) in faults.items():
        path = tmp_path / name
        path.write_text(text)
        for command in ("relax", "simulate"):
            done = CliRunner().invoke(app, [command, str(path)])
            assert (done.exit_code, said in done.stderr) == (2, True), (command, name, done.stderr)
            assert len(done.stderr.splitlines()) == 1
    done = CliRunner().invoke(app, ["relax", str(tmp_path / "b.json"), "-r", str(find("9.24").folder / "recipe.toml")])
    assert done.exit_code == 2 and "recipes are for files with drawn objects" in done.stderr


def test_what_nothing_holds_opens_in_the_studio_and_is_not_relaxed(client: httpx.Client) -> None:
    """There it can be pinned; relaxed as it is it would shrink to a point."""
    cube = written(CUBE)
    session = opened(client, "cube.json", cube.encode())
    assert "pin some of it" in session["warnings"][0]
    answer = client.post("/v1/relax", content=cube, headers={"content-type": "application/json"})
    assert "pin some of it" in problem(answer, 422, "invalid-scene")["detail"]


def test_the_command_explains_what_it_reads(tmp_path: Path) -> None:
    path = tmp_path / "rope.obj"
    path.write_text(ROPE)
    done = CliRunner().invoke(app, ["relax", str(path), "--explain"])
    assert done.exit_code == 0 and "rope.obj: an OBJ file, read as drawn, with springs" in done.output
    assert "not read from the file: normals" in done.output


def test_the_list_of_readers_is_the_only_one() -> None:
    """What the page lets one choose, what the help of commands names, and what sentences name follow from it."""
    suffixes = [known.suffix for known in READERS]
    assert endings() == ".3dm, .obj, .json, .npz or .hookean" == f"{', '.join(suffixes[:-1])} or {suffixes[-1]}"
    page = (ROOT / "studio" / "src" / "ui" / "opening.tsx").read_text(encoding="utf-8")
    assert f'"{",".join(suffixes)}"' in page
    for command in ("relax", "simulate", "studio"):
        text = CliRunner().invoke(app, [command, "--help"], env={"COLUMNS": "200", "NO_COLOR": "1"}).output
        assert endings() in text, command
    for known in READERS:
        assert reader(b"", f"a{known.suffix.upper()}") is known
        assert isinstance(known.read, type(read)) and known.name.startswith("a")
    with pytest.raises(InputError):
        reader(b"")
    assert Source(Scene(), []).unheld == ""
