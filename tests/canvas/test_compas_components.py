"""The COMPAS components as they are shipped, with the client inside, on Rhino 8's Python and on this one."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from hookean import Scene, relax
from hookean_canvas.components import bundles, inline
from hookean_canvas.run import stand_in
from pythons import interpreter
from serving import HANG, Home
from soak import sampled

NAMES = ("CompasStructure", "CompasSprings", "CompasLoad", "CompasAnchors", "CompasRelax")
RUN = Path(__file__).with_name("compas_canvas_run.py")


def rhino8(cache: Any) -> str:
    """A Python 3.9 with compas and nothing of ours, made once; skips where that cannot be."""
    found = interpreter("3.9")
    if found is None:
        pytest.skip("this machine has no Python 3.9")
    folder = Path(cache.mkdir("compas-3.9"))
    python = folder / "bin" / "python"
    if not (folder / "made").exists():
        subprocess.run([found, "-m", "venv", "--clear", folder], check=True, capture_output=True)
        command = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "compas>=2.4"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
        if done.returncode:
            pytest.skip(f"pip cannot install compas for Python 3.9: {done.stderr.strip()[-200:]}")
        (folder / "made").touch()
    return str(python)


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    found = Home(tmp_path_factory.mktemp("compas") / "state")
    found.serve()
    yield found
    found.end()


@pytest.fixture(scope="module", params=sampled(["here", "rhino8"], 2))
def told(request: pytest.FixtureRequest, home: Home, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What the components made of a net with a stay, in an empty folder."""
    python = sys.executable if request.param == "here" else rhino8(request.config.cache)
    folder = tmp_path_factory.mktemp("canvas")
    codes = {name: inline.inlined(bundles.read(name).code) for name in NAMES}
    (folder / "codes.json").write_text(json.dumps(codes))
    words = [python, "-I", str(RUN), str(stand_in.__file__), str(folder / "codes.json")]
    done = subprocess.run(
        words, cwd=folder, env=home.environment, capture_output=True, text=True, timeout=HANG, check=False
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    assert found["python"] == ([3, 9] if request.param == "rhino8" else list(sys.version_info[:2]))
    return found


def by_the_engine() -> dict[str, Any]:
    """The same net, told by hand."""
    at = [[float(i), float(j), 0.0] for i in range(5) for j in range(5)]
    rows = [[5 * i + j, 5 * i + j + 1] for i in range(5) for j in range(4)]
    columns = [[5 * i + j, 5 * i + j + 5] for i in range(4) for j in range(5)]
    scene = {
        "particles": [*at, [2, 2, 3]],
        "forces": [
            {"kind": "springs", "particles": rows + columns, "stiffness": 10, "rest_factor": 0.5},
            {"kind": "springs", "particles": [[12, 25]], "stiffness": 5},
            {"kind": "unary", "particles": list(range(25)), "vector": [0, 0, -1]},
        ],
        "anchors": [{"particles": [0, 4, 20, 24, 25]}],
    }
    return relax(Scene.read(scene)).to_dict()


@pytest.mark.soak
def test_the_form_and_its_forces_are_the_engines(told: dict[str, Any]) -> None:
    wanted = by_the_engine()
    assert (told["status"], told["troubles"], told["classes"]) == ("converged", [], ["Mesh", "Graph"])
    for found, point in zip(told["points"], wanted["particles"][:25], strict=True):
        assert found == pytest.approx(list(point), abs=1e-4)
    assert told["drawn"] == told["points"]
    assert sorted(told["tension"]) == pytest.approx(sorted(wanted["forces"][0]["force"]), abs=1e-3)
    assert told["stay"] == pytest.approx(wanted["forces"][1]["force"][0], abs=1e-4)
    assert told["line"] == pytest.approx(wanted["forces"][1]["length"][0], abs=1e-5)
    reactions = dict(zip(wanted["reactions"]["particles"], wanted["reactions"]["force"], strict=True))
    for found, key in zip(told["reactions"], (0, 4, 20, 24), strict=True):
        assert found == pytest.approx(list(reactions[key]), abs=1e-3)
    assert told["residual"] <= 1e-6 and told["report"].startswith("In equilibrium after")


def test_what_does_not_fit_is_one_sentence(told: dict[str, Any]) -> None:
    """Nothing comes out, and the component says what to do; what is only missing is a warning."""
    wanted = {
        "no structure": ("Warning", "A structure is missing; connect a COMPAS Mesh or Graph."),
        "no mesh": ("Error", "Pointcloud or Point is expected, not str."),
        "no attribute": ("Error", 'has no attribute "ea"; set it for all edges, or give a number.'),
        "no load": ("Error", "No vertex has a load in px, py, pz [force]"),
        "no vertex": ("Error", "99 is not a vertex of the mesh; its 25 keys are 0 to 24."),
        "no force": ("Warning", "Forces are missing; connect COMPAS Springs."),
        "no structures": ("Warning", "Structures are missing; connect a COMPAS Mesh or Graph."),
        "no force at all": ("Error", 'the text "load" is not a hookean object'),
        "no geometry": ("Warning", "Geometry is missing; connect meshes, lines or curves."),
    }
    for name, (level, sentence) in wanted.items():
        *outputs, [(found, said)] = told["faults"][name]
        assert outputs == [None] * len(outputs), name
        assert found == level and sentence in said, (name, said)
    status, _, report, messages = told["faults"]["an anchor beside"]
    assert status == "converged" and [level for level, _ in messages] == ["Warning"]
    assert "its point met no particle; the nearest is" in messages[0][1] and messages[0][1] in report


@pytest.mark.parametrize("version", ["2.7", "3.9", "3.13"])
def test_every_python_of_rhino_imports_the_converters_without_compas(version: str) -> None:
    found = interpreter(version)
    if found is None:
        pytest.skip(f"this machine has no Python {version}")
    code = (
        "import sys; sys.dont_write_bytecode = True; sys.path.insert(0, sys.argv[1])\n"
        "from hookean_client import compas, compas_canvas\n"
        "assert 'compas' not in sys.modules and compas.kind(type('P', (), {'x': 0, 'y': 0, 'z': 0})()) == 'point'\n"
        "print(compas.__name__)"
    )
    words = [found, "-c", code, str(bundles.folder())]
    done = subprocess.run(words, capture_output=True, text=True, timeout=HANG, check=False)
    assert (done.stdout.strip(), done.returncode) == ("hookean_client.compas", 0), done.stderr
