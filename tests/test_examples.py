"""Every example: a fresh run gives the numbers of its expected.json, and those come from where they say."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread
from scipy.spatial import KDTree
from typer.testing import CliRunner

from hookean import Scene
from hookean.cli import app
from hookean.commands import example as command
from hookean.commands.examples import Example, _figures, examples, figure, find, gallery, home
from hookean.files.relax_file import read_scene
from hookean.system.system import compile
from soak import SOAK, sampled

ALL = examples()


LONG = {"miura", "sphere", "9.32-ribbon", "planar_quads", "bending_gridshell", "rigid_boxes", "9.28-rest-factor-zero"}
"""Examples of more than a second."""


@pytest.mark.thinned
@pytest.mark.parametrize(
    "example", [pytest.param(e, id=e.name, marks=[pytest.mark.soak] if e.name in LONG else []) for e in ALL]
)
def test_a_fresh_run_gives_the_expected_numbers(example: Example, tmp_path: Path) -> None:
    outcome = example.run()
    numbers = outcome.numbers
    if SOAK:  # a picture takes a second
        example.draw(outcome, tmp_path / "picture.png")
        assert imread(tmp_path / "picture.png").std() > 0.01, "it is blank"
    assert set(numbers) == set(example.expected.numbers)
    off = {n: float(numbers[n]) for n, e in example.expected.numbers.items() if not e.holds(numbers[n])}
    assert not off, {name: (value, str(example.expected.numbers[name])) for name, value in off.items()}


# runs one script after the other, behind a finder in front of all others that knows of no hookean
WITHOUT = """
import contextlib, io, json, runpy, sys, traceback
class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("hookean", "hookean_server", "hookean_client"):
            raise ImportError("an oracle imports no hookean")
sys.meta_path.insert(0, Refuse())
before = sys.path[:]
for script in sys.stdin:
    said, failure = io.StringIO(), ""
    try:
        with contextlib.redirect_stdout(said):
            runpy.run_path(script.rstrip("\\n"), run_name="__main__")
    except BaseException:
        failure = traceback.format_exc()
    sys.path[:] = before
    print(json.dumps([failure, said.getvalue()]), flush=True)
"""


@pytest.fixture(scope="module")
def without() -> Iterator[Callable[[Path], dict[str, float]]]:
    """What a script prints in a Python without hookean, one for all of them."""
    environment = {**os.environ, "PYTHONPATH": ""}
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "encoding": "utf-8"}
    with subprocess.Popen([sys.executable, "-c", WITHOUT], env=environment, **pipes) as process:

        def printed(script: Path) -> dict[str, float]:
            process.stdin.write(f"{script}\n")
            process.stdin.flush()
            failure, said = json.loads(process.stdout.readline())
            assert not failure, failure
            return json.loads(said)

        yield printed


@pytest.mark.parametrize("example", sampled(ALL, 12), ids=lambda e: e.name)
def test_numbers_of_scripts_are_what_the_scripts_print_without_hookean(
    example: Example, without: Callable[[Path], dict[str, float]]
) -> None:
    sources = {n: e.source.split()[1].rstrip(":") for n, e in example.expected.numbers.items() if e.source[0] == "s"}
    for script in sorted(set(sources.values())):
        printed = without(example.folder / script)
        for name in (n for n, s in sources.items() if s == script):
            expected = example.expected.numbers[name]
            assert expected.holds(printed[name]), (name, printed[name], str(expected))


@pytest.mark.parametrize("example", sampled(ALL, 4), ids=lambda e: e.name)
def test_a_folder_has_all_that_the_gallery_shows(example: Example) -> None:
    inside = {path.name for path in example.folder.iterdir()}
    assert {"scene.py", "example.py", "expected.json", "README.md", "picture.png"} <= inside
    assert ("model.3dm" in inside) == ("recipe.toml" in inside) == example.drawn
    pixels = imread(example.folder / "picture.png")[..., :3]
    assert pixels.shape[1] >= 1500
    drawn = (pixels < 0.95).any(axis=2)
    assert 0.01 < drawn.mean() < 0.5, "blank, or filled"
    assert not drawn[[0, -1]].any() and not drawn[:, [0, -1]].any(), "cut off at its edge"


# recipes by their files: the function of scene.py that makes the same scene, and its parameters
ARC, WIDE = {"by_arc_length": True}, {"span": 14.0}
STRETCHED = {"arc_length": 10.0, "stiffness": 75.0, "rest_factor": 1.0}
DRAWN: dict[str, tuple[str, dict[str, Any]]] = {
    **{f"{example.name}/recipe": ("scene", {}) for example in ALL if example.drawn},
    "9.17-arc-to-catenary/recipe-line": ("scene", STRETCHED),
    "9.17-arc-to-catenary/recipe-wide": ("scene", WIDE),
    "9.17-arc-to-catenary/recipe-arc-length": ("scene", ARC),
    "9.17-arc-to-catenary/recipe-wide-arc-length": ("scene", ARC | WIDE),
    "9.27-naked-vertices/recipe-points": ("scene", {"anchors": figure("9.27-naked-vertices").POINTS}),
    "9.28-rest-factor-zero/recipe-film": ("scene", {"film": True, "tension": 1.0}),
    "9.28-rest-factor-zero/recipe-film-fine": ("scene", {"film": True, "tension": 1.0, "divisions": 64}),
    "9.29-diagonals/recipe-edges": ("scene", {"diagonals": "none"}),
    "9.29-diagonals/recipe-one": ("scene", {"diagonals": "one"}),
    "9.30-creases/recipe-creased": ("scene", {"diagonal_factor": 0.95}),
    "9.30-creases/recipe-sharper": ("scene", {"diagonal_factor": 0.9}),
    "9.31-diagonal-patterns/recipe-b": ("scene", {"diagonals": "other"}),
    "9.31-diagonal-patterns/recipe-c": ("warp_and_weft", {}),
    "hanging-vault/recipe-chain": ("chain", {}),
    "sphere/recipe-springs": ("scene", {"shell": 0.0}),
    "hypar-roof/recipe": ("scene", {}),
    "wind/recipe": ("scene", {"speed": 0.0}),
}


RECIPES = [f"{path.parent.name}/{path.stem}" for path in sorted(home().glob("*/recipe*.toml"))]


def disturbed(scene: Scene) -> tuple[np.ndarray, ...]:
    """Where the particles of a scene are, from their least coordinates; mass, what is held, and the forces of their
    elements in a motion that is a smooth function of the place."""
    system = compile(scene)
    state = system.start()
    place = state.x - state.x.min(axis=0)
    state.x = state.x + 0.05 * np.sin(place[:, [1, 2, 0]] + 0.7 * place + 0.3)
    state.v = np.cos(place[:, [2, 0, 1]] - 0.4 * place)
    return place, system.mass, state.free, system.evaluate(state, still=False)[0]


@pytest.mark.slow
@pytest.mark.parametrize("recipe", sampled(RECIPES, 3))
def test_model_and_recipe_are_the_scene_that_scene_py_makes(recipe: str) -> None:
    """The same particles, supports and forces while they move, and settings that solve alike.

    Points of NURBS are the same to 1e-8 m, vertices of meshes, which a file has in single precision, to 1e-7 of 15 m;
    forces to ten times that of the stiffness they meet.
    """
    folder, _, file = recipe.partition("/")
    name, parameters = DRAWN[recipe]
    made = getattr(figure(folder), name)(**parameters)
    drawn = read_scene(home() / folder / "model.3dm", home() / folder / f"{file}.toml")
    near = 1.5e-6 if folder == "sphere" else 1e-8
    (x, *of_script), (y, *of_file) = disturbed(made), disturbed(drawn)
    away, here = KDTree(y).query(x)
    assert len(x) == len(y) and len(set(here.tolist())) == len(x) and away.max() < near
    stiffest = max(np.max(getattr(force, "stiffness", 1.0)) for force in made.forces)
    for one, other in zip(of_script, of_file, strict=True):
        assert one == pytest.approx(other[here], rel=1e-7, abs=10.0 * near * stiffest)
    assert made.settings.model_dump(exclude={"floor"}) == drawn.settings.model_dump(exclude={"floor"})
    assert made.units == drawn.units and (made.settings.floor is None) == (drawn.settings.floor is None)


def test_a_run_that_found_no_equilibrium_is_told():
    """An outcome names the runs behind its panels that ended otherwise: none of their numbers is taken for one."""
    from hookean import Scene, relax
    from hookean.commands.examples import Outcome
    from hookean.pictures.sheet import Panel

    scene = {"particles": [[0, 0, 0]], "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, -1]}]}
    lost = relax(Scene.read({**scene, "settings": {"max_iterations": 10}}))
    assert Outcome({}, [Panel(lost)]).failures == [lost.message]


def test_the_gallery_shows_every_example():
    """gh_examples/README.md is what `make figures` would write now."""
    same = (home() / "README.md").read_text(encoding="utf-8") == gallery(ALL)
    assert same, "gh_examples/README.md is not what the examples say: run make figures"


@pytest.mark.parametrize(
    ("figures", "said"),
    [
        (["9.4"], "Figure 9.4"),
        (["9.7", "9.8"], "Figures 9.7 and 9.8"),
        (["9.23", "9.24", "9.25"], "Figures 9.23 to 9.25"),
        (["9.1", "9.3", "9.4"], "Figures 9.1, 9.3 and 9.4"),
        (["section 9.7"], "Section 9.7"),
    ],
)
def test_headings_name_all_figures(figures: list[str], said: str):
    assert _figures(figures) == said


def test_without_a_figure_all_are_listed():
    told = CliRunner().invoke(app, ["example"], env={"COLUMNS": "200"})
    assert told.exit_code == 0
    assert all(example.name in told.stdout and example.expected.title in told.stdout for example in ALL)


def test_a_figure_is_found_by_its_number_its_name_and_its_folder():
    """Every figure of every example is one to ask for; of two that show one, the folder of that number comes first."""
    for example in ALL:
        assert find(example.name) == example
        assert find(example.name.partition("-")[2] or example.name).expected.title == example.expected.title
        assert all(figure in find(figure).expected.figures for figure in example.expected.figures)
    assert find("9.13").name == "9.12-hooke"


def test_one_runs_and_says_its_numbers_with_their_sources(tmp_path: Path):
    picture = tmp_path / "extension.png"
    told = CliRunner().invoke(app, ["example", "9.11", "--picture", str(picture)])
    assert told.exit_code == 0
    assert "10.4679155 m  (as expected: 10.46 ± 0.01)" in told.stdout and "closed form: F = k X" in told.stdout
    assert picture.read_bytes() == (find("9.11").folder / "picture.png").read_bytes(), "run make figures"


def test_a_number_that_is_off_ends_with_1(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    folder = tmp_path / "9.11"
    for name, target in (("9.11", folder), ("9.4", tmp_path / "9.4-cable")):  # the cable that both are made of
        assert command.run(name, None, str(target)) == 0
    expected = (find("9.11").folder / "expected.json").read_text(encoding="utf-8").replace("10.46,", "10.4,")
    (folder / "expected.json").write_text(expected, encoding="utf-8")
    monkeypatch.setattr("hookean.commands.examples.home", lambda: tmp_path)
    told = CliRunner().invoke(app, ["example", "9.11"])
    assert told.exit_code == 1 and "(NOT as expected: 10.4 ± 0.01)" in told.stdout
    told = CliRunner().invoke(app, ["example", "--figures", str(tmp_path / "new" / "drawn")])
    assert told.exit_code == 1 and "9.11: not as expected: length" in told.stdout
    assert (tmp_path / "new" / "drawn" / "9.11" / "picture.png").is_file()
    assert (tmp_path / "new" / "drawn" / "README.md").is_file()


def test_a_copy_relaxes_by_itself_and_is_not_written_over(tmp_path: Path):
    """`--copy` takes scene, model and recipe along; into a folder that is there it goes under its own name, once."""
    told = CliRunner().invoke(app, ["example", "9.24", "--copy", str(tmp_path)])
    folder = tmp_path / "9.24-membrane"
    assert told.exit_code == 0 and f"copied to {folder}" in told.stdout.replace("\n", "")
    assert {path.name for path in folder.iterdir()} >= {"scene.py", "model.3dm", "recipe.toml", "README.md"}
    ran = ["relax", str(folder / "model.3dm"), "-r", str(folder / "recipe.toml"), "-o", str(tmp_path / "out.3dm")]
    assert CliRunner().invoke(app, ran).exit_code == 0
    again = CliRunner().invoke(app, ["example", "9.24", "--copy", str(tmp_path)])
    assert again.exit_code == 2 and "exists already" in again.stderr


def test_a_copy_runs_with_its_numbers_beside_the_originals(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Twice the load: other numbers, told with the ones before; that is no failure. A copy by any path."""
    monkeypatch.chdir(tmp_path)
    told = CliRunner().invoke(app, ["example", "9.11", "--picture", "new/p.png", "--copy", "mine"])
    assert told.exit_code == 0 and (tmp_path / "new" / "p.png").is_file() and "as expected" in told.stdout
    assert f"hookean example .{os.sep}mine" in told.stdout
    scene = (tmp_path / "mine" / "scene.py").read_text(encoding="utf-8")
    (tmp_path / "mine" / "scene.py").write_text(scene.replace("load=20.0", "load=40.0"), encoding="utf-8")
    for path in ("./mine", "mine", str(tmp_path / "mine")):
        told = CliRunner().invoke(app, ["example", path])
        assert told.exit_code == 0 and "(was 10.46 ± 0.01)" in told.stdout, told.stderr
        assert "10.4679155" not in told.stdout and "expected" not in told.stdout
    monkeypatch.chdir(tmp_path / "mine")
    assert CliRunner().invoke(app, ["example", ".", "--picture", "drawn/"]).exit_code == 0
    assert (tmp_path / "mine" / "drawn" / "mine.png").is_file()
    (tmp_path / "mine" / "expected.json").unlink()
    assert "copy the example again" in CliRunner().invoke(app, ["example", "."]).stderr


@pytest.mark.parametrize("typed", ["Figure 9.24", "fig. 9.24", "fig9.24", " 9.24 ", "9.24-Membrane", "Membrane"])
def test_a_figure_is_found_as_people_write_it(typed: str):
    assert find(typed).name == "9.24-membrane"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["9.99"], "no example has this figure or name; did you mean "),
        (["bolt"], "no example has this figure or name; list all with: hookean example"),
        (["membran"], "did you mean 9.1-square-membrane or 9.24-membrane"),
        (["9.11", "--picture", "a.jpg"], "is not a .png file"),
        (["--copy", "nowhere"], "--copy needs a figure: hookean example 9.24 --copy nowhere"),
        (["--picture", "a.png"], "--picture needs a figure: hookean example 9.24 --picture a.png"),
        (["./nowhere"], "is not a folder with an example.py"),
        (["--figures", os.devnull], "cannot be written"),
    ],
)
def test_what_cannot_be_done_gets_one_sentence_and_exit_2(arguments: list[str], said: str):
    told = CliRunner().invoke(app, ["example", *arguments])
    assert told.exit_code == 2 and said in told.stderr
    assert len(told.stderr.strip().splitlines()) == 1
