"""Type checkers without plugins accept the code of the docs, know what fields hold, and report mistakes."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
# compas has no types of its own
PLAIN = "[mypy]\nstrict = true\n[mypy-compas.*]\nignore_missing_imports = true\n"

CLAIMS = """
from typing import assert_type

import numpy as np
from numpy.typing import NDArray

import hookean
from hookean import Anchor, Anchors, Floor, Force, Geometry, InputError, MeshData, Patch, Scene, Script, Settings, Units
from hookean import PullToMesh, SelfWeight, Simulation, SoapFilm, Springs, Unary, relax, simulate

corners = [[0, 0, 0], [1, 0.5, 0]]
springs = Springs(particles=[[0, 1]], stiffness=1000, rest_length=[1, 2.5], damping=np.ones(1))
loads: list[Force] = [Unary(points=((0, 0, 0),), vector=(0, 0, -1.0)), SelfWeight(total=2.0), SoapFilm(mesh="m")]
pull = PullToMesh(points=corners, vertices=corners, faces=[[0, 1, 2], [0, 1, 2, 3]])
buffer = {"dtype": "<f8", "shape": [1, 3], "base64": ""}
scene = Scene(
    units={"length": "mm"},
    particles=buffer,
    masses=2,
    meshes={"m": MeshData(vertices=corners, faces=[[0, 1, 1]]), "n": {"vertices": corners, "faces": []}},
    forces=[springs, *loads, {"kind": "unary", "particles": [0], "vector": [0, 0, 1]}],
    anchors=(Anchors(particles=[0]), Anchor(points=corners, targets=corners), {"points": corners}),
    geometry=[Geometry(kind="points", points=corners)],
    settings=Settings(floor=True, tolerance=1e-9),
)
changed: Scene = scene.model_copy(update={"settings": {"floor": Floor()}, "units": Units(time="ms")})
read: Scene = Scene.read({"forces": [springs]})

assert_type(scene.particles, NDArray[np.float64])
assert_type(springs.particles, NDArray[np.int64] | None)
assert_type(springs.stiffness, float | NDArray[np.float64] | None)
assert_type(scene.forces, tuple[Force, ...])
assert_type(scene.anchors[0].targets, NDArray[np.float64] | None)
assert_type(scene.meshes["m"].faces, NDArray[np.int64])
assert_type(scene.settings.floor, Floor | None)
assert_type(scene.units, Units)

wind = {"drives": [{"force": "wind", "column": "vector", "source": "v", "scale": [0, 0, 1]}]}
edit = {"pin": [{"particles": [1]}], "forces": {"a": {"stiffness": 5}}}
running = Simulation(scene, Script(anchors=[{"anchor": 0, "times": [0, 1], "shifts": [[0, 0, 0], [0, 0, 1]]}]))
running.patch(edit)
running.patch(Patch(release=[1]))
for frame in simulate(read, 3, script=wind, stream=["time [s],v", "0,1"]):
    assert_type(frame.time, float)
try:
    relax(running.scene)
except InputError as error:
    assert_type(error.pointer, str)
    assert_type(error.faults[0].sentence, str)

Springs(particles=[[0, 1]], stifness=5)  # wrong: call-arg
Unary(points=corners)  # wrong: call-arg
Scene(forces=springs)  # wrong: arg-type
Scene(settings={"tolerance": 1}, strict=[True])  # wrong: arg-type
Settings(tolerance="small")  # wrong: arg-type
Springs(particles=[[0, 1]], stiffness=springs)  # wrong: arg-type
Scene(anchors=[springs])  # wrong: list-item
hookean.Sprigs  # wrong: attr-defined
"""


@pytest.fixture(scope="module")
def blocks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A module of each page's Python, and one of claims, in a folder that knows nothing of this repository."""
    folder = tmp_path_factory.mktemp("types")
    for page in PAGES:
        found = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
        if found:
            name = re.sub(r"[^a-z]", "_", page.relative_to(ROOT).with_suffix("").as_posix().lower())
            (folder / f"page_{name}.py").write_text("\n".join(found), "utf-8")
    (folder / "claims.py").write_text(CLAIMS, "utf-8")
    (folder / "plain.ini").write_text(PLAIN, "utf-8")
    return folder


@pytest.mark.soak
def test_mypy_without_plugins_accepts_the_docs_and_finds_mistakes(blocks: Path) -> None:
    """mypy --strict: no word on the pages and on the claims but on the lines that are wrong, each for its reason."""
    assert len(list(blocks.glob("page_*.py"))) >= 16
    command = [sys.executable, "-m", "mypy", "--config-file", "plain.ini", "--cache-dir", "cache", "."]
    found = subprocess.run(command, cwd=blocks, capture_output=True, text=True, check=False)
    said = [line for line in found.stdout.splitlines() if ": error: " in line]
    wanted = [
        (f"claims.py:{number}", line.split("# wrong: ")[1])
        for number, line in enumerate(CLAIMS.splitlines(), 1)
        if "# wrong: " in line
    ]
    told = [(line.split(": error: ")[0], line.rpartition("[")[2].rstrip("]")) for line in said]
    assert told == wanted, found.stdout + found.stderr


@pytest.mark.soak
def test_pyright_accepts_the_docs(blocks: Path) -> None:
    """The standard rules; no mistake on any page."""
    pages = map(str, blocks.glob("page_*.py"))
    command = [sys.executable, "-m", "pyright", "--pythonpath", sys.executable, "--level", "error", *pages]
    found = subprocess.run(command, cwd=blocks, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stdout
