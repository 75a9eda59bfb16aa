"""What a simulation is exported to opens again as the same model, or a sentence names what the format lacks.

Every figure of the chapter, edited: an anchor moved, a particle pinned, a load added, a stiffness changed. The oracle
is the canonical text of the edited scene; for OBJ the counts of faces, lines and vertices in its text.
"""

from __future__ import annotations

import base64
import io
import json
import zipfile
import zlib
from pathlib import Path
from typing import Any

import compas
import numpy as np
import pytest
import rhino3dm

from hookean import InputError, Scene, Simulation, relax
from hookean.commands.examples import examples
from hookean.files import compas_write, embedded, saved
from hookean.files.readers import read
from hookean.files.relax_file import open_file, read_scene, relax_file
from hookean.running.in_motion import in_motion
from hookean_server.sessions.exports import export
from samples import cable
from soak import sampled

FIGURES = {example.name: example for example in examples()}
ENDINGS = {"scene": "json", "compas": "json", "3dm": "3dm", "npz": "npz", "obj": "obj"}


def edited(scene: Scene) -> Simulation:
    """A simulation that has moved and been edited in every way."""
    simulation = Simulation(in_motion(scene)[0])
    simulation.step(2)
    count = simulation.system.slots.count
    free = np.flatnonzero(simulation.state.free[:count].any(axis=1))
    free = free if len(free) else np.arange(count)
    held = next((h for h in simulation.system.held if len(h.particles)), None)
    if held is not None:
        simulation.patch({"move": [{"anchor": held.number, "targets": (held.targets + [0, 0, 0.01]).tolist()}]})
    simulation.patch({"pin": [{"particles": [int(free[-1])], "name": "hand", "axes": "xz"}]})
    simulation.patch({"add": [{"kind": "unary", "name": "snow", "particles": free.tolist(), "vector": [0, 0, -1e-3]}]})
    simulation.patch({"settings": {"tolerance": 1e-7}})
    simulation.step()
    return simulation


def put(folder: Path, simulation: Simulation, form: str) -> Path:
    """What the studio exports, as a file."""
    path = folder / f"{form}.{ENDINGS[form]}"
    path.write_bytes(export(simulation, form, "list")[1])
    return path


def scene_in(data: bytes) -> tuple[Scene, tuple[str, ...]]:
    """The scene of a file without its name, and the warnings on it: as the service reads it."""
    found = read(data)
    return found.scene, found.warnings


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(FIGURES, 12))
def test_a_figure_opens_again_as_the_same_model(name: str, tmp_path: Path) -> None:
    simulation = edited(FIGURES[name].scene())
    wanted = simulation.edited_scene().canonical
    for form in ("scene", "compas", "3dm", "npz"):
        path = put(tmp_path, simulation, form)
        assert read_scene(path).canonical == wanted, form  # as the command line reads it
        if form in ("scene", "compas"):  # as the studio reads it, without its name
            assert scene_in(path.read_bytes())[0].canonical == wanted
    again = saved.read((tmp_path / "npz.npz").read_bytes())
    assert np.array_equal(again.state.x, simulation.state.x) and np.array_equal(again.state.v, simulation.state.v)

    text = put(tmp_path, simulation, "obj").read_text()
    said = [line.split() for line in text.splitlines()]
    assert sum(words[0] == "v" for words in said) == len(simulation.system.x)
    elements = [(words[0], frozenset(words[1:])) for words in said if words[0] in "fl"]
    assert len(elements) == len(set(elements))
    faces = [simulation.system.places.faces(mesh) for mesh in simulation.scene.meshes]
    whole = {frozenset(face.tolist()) for mesh in faces for face in mesh}
    assert sum(kind == "f" for kind, _ in elements) == len(whole)
    held = (simulation.state.free == 0).all(axis=1)
    assert sum(len(words) - 1 for words in said if words[0] == "p") == held.sum()
    assert "not forces, loads, stiffness" in text.splitlines()[1]
    assert "not forces, loads, stiffness" in export(simulation, "obj", "list")[2][0]
    drawn, _ = scene_in(text.encode())
    kept = held[np.unique([int(word) - 1 for kind, words in elements for word in words])]
    if held.any() and not kept.any():
        with pytest.raises(InputError, match="No anchor holds a particle"):  # what it held had no line and no face
            Simulation(drawn)
        return
    opened = Simulation(drawn)
    assert len(opened.system.x) <= len(simulation.system.x)
    pairs = [group.block.indices for group in opened.system.groups if group.block.indices.shape[1] == 2]
    once = np.sort(np.concatenate(pairs), axis=1)
    assert len(np.unique(once, axis=0)) == len(once)
    assert (opened.state.free == 0).all(axis=1).sum() == kept.sum() or not held.any()


@pytest.mark.slow
def test_relaxing_what_was_exported_gives_the_same_shape(tmp_path: Path) -> None:
    """Of each format the equilibrium of the edited scene, by the command's own function; of .npz from the saved
    shape on."""
    simulation = edited(FIGURES["9.24-membrane"].scene())
    wanted = relax(simulation.edited_scene()).particles
    for form in ("scene", "compas", "3dm", "npz"):
        done = relax_file(put(tmp_path, simulation, form))
        assert done.result.status == "converged" and np.abs(done.result.particles - wanted).max() < 1e-4
    own = Simulation.load(tmp_path / "npz.npz").relax()
    assert np.array_equal(done.result.particles, own.particles)


@pytest.mark.parametrize(("form", "target"), [("3dm", "out.3dm"), ("compas", "out.json"), ("npz", "out.3dm")])
def test_what_is_relaxed_into_a_file_opens_again(form: str, target: str, tmp_path: Path) -> None:
    simulation = edited(cable())
    relax_file(put(tmp_path, simulation, form), tmp_path / target)
    assert read_scene(tmp_path / target).canonical == simulation.edited_scene().canonical


def test_a_rhino_file_with_drawn_lines_is_read_as_drawn(tmp_path: Path) -> None:
    """The scene stored in it counts where nothing else in the file can be relaxed."""
    path = put(tmp_path, edited(cable()), "3dm")
    file = rhino3dm.File3dm.Read(str(path))
    drawn = rhino3dm.ObjectAttributes()
    drawn.LayerIndex = file.Layers.AddLayer("ropes", (0, 0, 0, 255))
    file.Objects.AddLine(rhino3dm.Point3d(0, 0, 9), rhino3dm.Point3d(1, 0, 9), drawn)
    assert file.Write(str(path), 8)
    scene = read_scene(path)
    assert len(scene.forces) == 1 and len(Simulation(scene).system.x) == 2
    assert open_file(put(tmp_path, edited(cable()), "3dm")).lines[0].startswith("3dm.3dm: the scene stored in this")


@pytest.mark.parametrize("name", ["9.24-membrane", "9.4-cable"])
def test_compas_reads_the_document_and_keeps_the_model(name: str) -> None:
    """Supports and loads are attributes of vertices; what compas writes again is the same model, what was moved is as
    drawn, and says so."""
    simulation = edited(FIGURES[name].scene())
    wanted = simulation.edited_scene().canonical
    made = compas.json_loads(export(simulation, "compas", "list")[1].decode())
    mesh = hasattr(made, "faces")
    vertices = list(made.vertices() if mesh else made.nodes())
    attribute = made.vertex_attribute if mesh else made.node_attribute
    assert sum(attribute(v, "is_support") is True for v in vertices) == (~simulation.state.free.all(axis=1)).sum()
    total = sum(attribute(v, "pz") or 0.0 for v in vertices)
    assert total == pytest.approx(simulation.system.evaluate(simulation.state, only="load")[0][:, 2].sum())
    assert made.attributes["units"]["length"] == simulation.scene.units.length
    assert scene_in(compas.json_dumps(made).encode())[0].canonical == wanted
    attribute(vertices[0], "z", 77.0)
    scene, warnings = scene_in(compas.json_dumps(made).encode())
    assert scene.canonical != wanted and warnings[0] == compas_write.CHANGED


def test_the_command_warns_of_a_changed_document(tmp_path: Path) -> None:
    path = put(tmp_path, edited(cable()), "compas")
    value = json.loads(path.read_text())
    value["data"]["node"]["0"]["x"] = -1.0
    path.write_text(json.dumps(value))
    assert open_file(path).warnings == (compas_write.CHANGED,)


def test_a_model_without_springs_is_a_compas_graph() -> None:
    simulation = Simulation(Scene.read({"particles": [[0, 0, 0]], "forces": [{"kind": "self_weight", "total": 1}]}))
    made = compas.json_loads(export(simulation, "compas", "list")[1].decode())
    assert list(made.nodes()) == [0] and scene_in(compas.json_dumps(made).encode())[0] == simulation.scene


# hostile and damaged


@pytest.mark.parametrize(
    "text", ["", "%%%", base64.b64encode(b"no zlib").decode(), base64.b64encode(zlib.compress(b"{}")[:-4]).decode()]
)
def test_a_damaged_scene_is_refused_in_a_sentence(text: str) -> None:
    with pytest.raises(InputError, match="damaged") as refused:
        embedded.unpacked(text, "a.3dm")
    assert refused.value.pointer == "a.3dm"


def test_a_scene_that_unpacks_to_more_than_the_limit_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(embedded, "LARGEST", 1000)
    bomb = base64.b64encode(zlib.compress(b" " * 10_000_000)).decode()
    with pytest.raises(InputError, match="damaged"):
        embedded.unpacked(bomb, "a.json")


def test_only_saved_simulations_are_read() -> None:
    """No pickles, nothing compressed, no other arrays, nothing cut: each a sentence."""
    stream = io.BytesIO()
    edited(cable()).save(stream)
    good = stream.getvalue()
    assert saved.read(good, "a.npz").state.revision == 4
    packed = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(good)) as file, zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as other:
        for part in file.namelist():
            other.writestr(part, file.read(part))
    others = io.BytesIO()
    np.savez(others, a=np.zeros(3))
    pickled = io.BytesIO()
    np.savez(pickled, allow_pickle=True, x=np.array([{}], dtype=object))
    for data in (packed.getvalue(), others.getvalue(), pickled.getvalue(), good[: len(good) // 2], b"PK\x03\x04", b""):
        with pytest.raises(InputError) as refused:
            saved.read(data, "a.npz")
        assert refused.value.pointer == "a.npz" and "Simulation.save" in refused.value.sentence
    huge: dict[str, Any] = dict(np.load(io.BytesIO(good)))
    array = io.BytesIO()
    np.lib.format.write_array_header_1_0(array, {"descr": "<f8", "fortran_order": False, "shape": (10**12, 3)})
    claimed = io.BytesIO()
    with zipfile.ZipFile(claimed, "w") as file:
        for name, value in huge.items():
            part = io.BytesIO()
            np.save(part, value)
            file.writestr(f"{name}.npy", array.getvalue() if name == "x" else part.getvalue())
    with pytest.raises(InputError, match=r"Simulation\.save"):
        saved.read(claimed.getvalue(), "a.npz")
