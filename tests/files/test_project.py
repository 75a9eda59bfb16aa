"""A .hookean file is the same model again: scene, state to the bit, view and variants; damage is one sentence.

Source: the format as `hookean.files.project` describes it; zip's local file header (PKWARE APPNOTE 4.3.7).
"""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import hookean
from hookean import InputError, Simulation, relax
from hookean.cli import app
from hookean.files import project, readers
from serving import CABLE


@pytest.fixture(scope="module")
def moved() -> Simulation:
    """A cable that has been played, pinned and lightened."""
    simulation = Simulation(hookean.Scene.read(CABLE))
    simulation.step(5)
    simulation.patch({"pin": [{"particles": [3], "targets": [[3.0, 0.0, 1.0]]}], "settings": {"tolerance": 1e-8}})
    simulation.step(2)
    return simulation


def test_what_is_saved_reopens_to_the_bit(moved: Simulation, tmp_path: Path):
    """State, anchors, edited scene; it goes on to the same next frame, and the same model gives the same bytes."""
    assert hookean.save(moved, tmp_path / "a.hookean") == []
    data = (tmp_path / "a.hookean").read_bytes()
    again = project.read(data).simulation
    assert project.write(project.Project(again)) == project.write(project.Project(moved)) == data
    assert np.array_equal(again.state.x, moved.state.x) and np.array_equal(again.state.v, moved.state.v)
    assert hookean.open(tmp_path / "a.hookean").canonical == moved.edited_scene().canonical
    with zipfile.ZipFile(io.BytesIO(data)) as file:
        assert json.loads(file.read("scene.json")) == json.loads(moved.edited_scene().canonical)
    again.step(1)
    other = project.read(data).simulation
    other.step(1)
    assert np.array_equal(again.state.x, other.state.x)


def test_view_and_variants_are_kept(moved: Simulation):
    view = {"eye": [0, 0, 0, 0, 0, 1, 5, 32], "colouring": "strain"}
    stiff = Simulation(hookean.Scene.read(CABLE))
    stiff.patch({"forces": {"0": {"stiffness": 4000.0}}})
    data = project.write(project.Project(moved, view, {"stiff": stiff}))
    found = readers.read(data)  # without its name: known by how it begins
    assert found.view == view
    assert found.variants["stiff"].edited_scene().canonical == stiff.edited_scene().canonical
    assert found.lines[-1] == "variants: stiff"


def test_the_command_line_relaxes_it(moved: Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """`hookean relax` ends where `relax` of its scene does, within the tolerance's share of the cable's length."""
    hookean.save(moved, tmp_path / "a.hookean")
    monkeypatch.chdir(tmp_path)
    ended = CliRunner().invoke(app, ["relax", "a.hookean", "-o", "rest.json"])
    assert ended.exit_code == 0, ended.output
    found = np.array(json.loads((tmp_path / "rest.json").read_text())["particles"])
    assert np.abs(found - relax(moved.edited_scene()).particles).max() < 1e-4


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda data: data[: len(data) // 2], "damaged, or not a .hookean file"),
        (lambda data: repacked(data, "hookean.json", b'{"format": "hookean", "version": 9}'), "of version 9"),
        (lambda data: repacked(data, "hookean.json", b"[]"), "hookean.json is not a JSON object"),
        (lambda data: repacked(data, "simulation.npz", b"PK"), "not a saved simulation"),
        (lambda data: repacked(data, "simulation.npz", None), "damaged, or not a .hookean file"),
        (lambda data: repacked(data, "simulation.npz", complex_speeds(data)), "not a saved simulation"),
        (lambda data: repacked(data, "view.json", b"{}", zipfile.ZIP_DEFLATED), "compressed"),
    ],
)
def test_damage_is_one_sentence(moved: Simulation, change, said: str):
    data = change(project.write(project.Project(moved)))
    with pytest.raises(InputError, match=said):
        project.read(data, "a.hookean")


def complex_speeds(data: bytes) -> bytes:
    """The saved simulation with speeds that no compiled loop takes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as file, np.load(io.BytesIO(file.read("simulation.npz"))) as arrays:
        np.savez(stream, **{**arrays, "v": arrays["v"].astype(complex)})
    return stream.getvalue()


def repacked(data: bytes, name: str, part: bytes | None, how: int = zipfile.ZIP_STORED) -> bytes:
    """The archive with another part of that name, or without it."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(stream, "w") as new:
        for info in old.infolist():
            if info.filename != name:
                new.writestr(info, old.read(info))
            elif part is not None:
                new.writestr(info.filename, part, how)
    return stream.getvalue()
