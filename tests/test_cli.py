"""The command line: exit codes, files written or not, one sentence for what is wrong, a light start."""

from __future__ import annotations

import csv
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from typer.testing import CliRunner

import forking
import hookean
from hookean import Scene, cli
from hookean.commands import relax as command
from hookean.commands.command import taking
from hookean.discretize import grid
from hookean.files.rhino import threedm
from hookean.files.rhino.threedm import Additions, NewObject
from hookean.forces import KINDS
from serving import HANG

REAL = Path(__file__).resolve().parents[2] / "shared" / "data" / "rhino"
CABLE = """
[[forces]]
kind = "springs"
lines = "layer:cable"
divide = 5
stiffness = 1000
[[forces]]
kind = "unary"
points = "vertices:layer:cable"
vector = [0, 0, -20]
[[anchors]]
points = "ends:layer:cable"
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with a cable and its recipe."""
    line = NewObject(np.array([[0.0, 0, 0], [10, 0, 0]]), "cable", "main")
    threedm.write_new(tmp_path / "cable.3dm", Additions((), [line]), own=False)
    (tmp_path / "recipe.toml").write_text(CABLE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*arguments: str) -> Result:
    """The command in this process; an exception that gets out fails the test."""
    return CliRunner().invoke(cli.app, list(arguments), catch_exceptions=False)


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_relax_writes_everything_asked_for(folder: Path) -> None:
    before = (folder / "cable.3dm").read_bytes()
    result = run(
        *("relax", "cable.3dm", "-o", "out.3dm", "--recipe", "recipe.toml"),
        *("--report", "out.json", "--csv", "out.csv", "--picture", "out.png"),
    )
    assert (result.exit_code, result.stderr) == (0, "")
    assert "In equilibrium" in result.stdout and "-> out.3dm" in result.stdout
    assert "  4 points merged\n" in result.stdout
    sag = re.search(r"moved by up to (\S+) m; z from -(\S+) to 0 m", result.stdout)
    assert sag and 0 <= float(sag[1]) - float(sag[2]) < 0.01  # aside it goes by a part of the 0.47 m it stretches
    assert names(folder) == ["cable.3dm", "out.3dm", "out.csv", "out.json", "out.png", "recipe.toml"]
    assert (folder / "cable.3dm").read_bytes() == before
    rows = (folder / "out.csv").read_text(encoding="utf-8").splitlines()
    head = rows[0].split(",")
    assert head[:7] == ["id", "name", "layer", "force", "kind", "element", "particles"] and "length [m]" in head
    total = sum(float(row.split(",")[head.index("length [m]")]) for row in rows[1:] if ",springs," in row)
    assert total == pytest.approx(10.4679154891668, abs=1e-6)
    assert json.loads((folder / "out.json").read_text(encoding="utf-8"))["result"]["status"] == "converged"
    assert (folder / "out.png").read_bytes().startswith(b"\x89PNG")


def test_explain_solves_and_writes_nothing(folder: Path) -> None:
    result = run("relax", "cable.3dm", "--explain", "--recipe", "recipe.toml", "-o", "out.3dm")
    assert result.exit_code == 0
    assert "forces[0] springs: 5 lines from 1 LineCurve" in result.stdout
    assert 'layer cable: 1 LineCurve "main" -> springs and unary and anchor' in result.stdout
    assert names(folder) == ["cable.3dm", "recipe.toml"]
    bare = run("relax", "cable.3dm", "--explain")
    assert "layer names and user text; nothing is marked as an anchor" in bare.stdout


def test_limits_exit_with_1_and_say_which(folder: Path) -> None:
    (folder / "limits.toml").write_text("max_force = 1\n[layer.cable]\nmax_strain = 1e-6\n", encoding="utf-8")
    arguments = ("relax", "cable.3dm", "-o", "out.3dm", "-r", "recipe.toml", "--check", "limits.toml")
    result = run(*arguments)
    assert result.exit_code == 1
    assert "limit exceeded: model: max force" in result.stderr and "layer cable: max strain" in result.stderr
    assert (folder / "out.3dm").exists()
    (folder / "limits.toml").write_text("max_force = 1e9\n", encoding="utf-8")
    assert run(*arguments).exit_code == 0


def test_a_limit_on_a_force_that_is_not_there_stops_no_output(folder: Path) -> None:
    (folder / "limits.toml").write_text("[force.rope]\nmax_force = 1\n", encoding="utf-8")
    arguments = ("-o", "out.3dm", "-r", "recipe.toml", "--check", "limits.toml", "--csv", "out.csv")
    result = run("relax", "cable.3dm", *arguments)
    assert result.exit_code == 2
    assert "hookean: limits.toml /force/rope: cable.3dm has no such force; it has" in result.stderr
    assert (folder / "out.3dm").exists() and (folder / "out.csv").exists()


def test_notes_are_told_without_explain(folder: Path) -> None:
    result = run("relax", "cable.3dm", "-o", "out.3dm", "--report", "out.json")
    note = "nothing is marked as an anchor: loose ends are held (2 particles)"
    beside = "recipe.toml in the same folder is not used; to use it, add -r recipe.toml"
    assert result.stderr == f"hookean: cable.3dm: note: {note}\nhookean: cable.3dm: note: {beside}\n"
    assert beside in run("relax", "cable.3dm", "--explain").stderr
    assert "in the same folder is not used" not in run("relax", "cable.3dm", "--explain", "-r", "recipe.toml").stderr
    assert note in json.loads((folder / "out.json").read_text(encoding="utf-8"))["warnings"]
    recipe = run("relax", "recipe.toml")
    assert recipe.stderr.startswith("hookean: recipe.toml is a recipe; pass it with -r")


def test_a_load_that_meets_nothing_exits_with_2_whatever_the_limits(folder: Path) -> None:
    """Wind on another division of the same net: nothing is written, and limits cannot pass for want of wind."""

    def square(count: int) -> dict[str, object]:
        steps = np.arange(count + 1) / count
        return {name: rows.tolist() for name, rows in vars(grid(steps, steps)).items()}

    wind = {"kind": "pressure", "name": "wind", "mesh": "b", "pressure": 1.0}
    scene: dict[str, object] = {"forces": [{"kind": "springs", "mesh": "a"}, wind]}
    scene |= {"meshes": {"a": square(4), "b": square(7)}, "anchors": [{"points": [[0, 0, 0], [1, 1, 0]]}]}
    (folder / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
    (folder / "limits.toml").write_text("max_displacement = 0.1\n", encoding="utf-8")
    said = "wind: 60 of 64 vertices met no particle; the nearest is 0.0357143 m away from (0, 0.285714, 0)"
    result = run("relax", "scene.json", "-o", "out.json", "--check", "limits.toml")
    assert result.exit_code == 2 and not (folder / "out.json").exists()
    assert result.stderr.startswith(f"hookean: scene.json /forces/1/mesh: {said}. Move them onto particles, ")
    moved = run("simulate", "scene.json")
    assert (moved.exit_code, moved.stderr) == (2, result.stderr)
    explained = run("relax", "scene.json", "--explain")
    assert explained.exit_code == 2 and said in explained.stderr
    assert "a scene with springs, pressure" in explained.stdout
    (folder / "scene.json").write_text(json.dumps({**scene, "strict": False}), encoding="utf-8")
    result = run("relax", "scene.json", "-o", "out.json")
    assert result.exit_code == 0 and f"note: /forces/1/mesh: {said}, so that part of the load is left" in result.stderr
    assert said in run("relax", "scene.json", "--explain").stdout


def test_cables_divided_otherwise_than_an_edge_are_a_note(folder: Path) -> None:
    """A line in 5 pieces over a line in 4: in the notes, in the report and by --explain, without more ado."""
    recipe = CABLE + '[[forces]]\nkind = "springs"\nname = "belt"\nlines = "layer:cable"\ndivide = 4\n'
    (folder / "recipe.toml").write_text(recipe, encoding="utf-8")
    said = "/forces/0: 4 of 6 particles lie on lines of belt, within a tenth of their length, but are not joined to it"
    explained = run("relax", "cable.3dm", "--explain", "-r", "recipe.toml")
    assert explained.exit_code == 0 and said in explained.stdout.splitlines()[-1]
    result = run("relax", "cable.3dm", "-o", "out.3dm", "-r", "recipe.toml", "--report", "out.json")
    assert result.exit_code == 0 and f"note: {said}" in result.stderr
    report = json.loads((folder / "out.json").read_text(encoding="utf-8"))
    assert any(said in warning for warning in report["result"]["report"]["warnings"])


def test_no_equilibrium_exits_with_3_and_writes_the_last_shape(folder: Path) -> None:
    (folder / "recipe.toml").write_text(CABLE + "[settings]\nmax_iterations = 1\n", encoding="utf-8")
    result = run("relax", "cable.3dm", "-o", "out.3dm", "-r", "recipe.toml")
    assert result.exit_code == 3
    assert "Not in equilibrium after 1 iteration:" in result.stderr
    assert "The last good shape was written to out.3dm." in result.stderr
    assert len(threedm.read(folder / "out.3dm").objects) > 1


def bad_files(folder: Path) -> list[str]:
    """Files that are no model: cut, empty, text, a folder, none at all."""
    data = (folder / "cable.3dm").read_bytes()
    for part in (1, 30, 50, 99):
        (folder / f"cut{part}.3dm").write_bytes(data[: len(data) * part // 100])
    (folder / "empty.3dm").touch()
    (folder / "text.3dm").write_text("a bridge\n" * 100, encoding="utf-8")
    (folder / "folder.3dm").mkdir()
    (folder / "text.json").write_text("a bridge", encoding="utf-8")
    return [
        *(f"cut{part}.3dm" for part in (1, 30, 50, 99)),
        "empty.3dm",
        "text.3dm",
        "folder.3dm",
        "no.3dm",
        "text.json",
    ]


def test_bad_files_get_one_sentence_and_exit_2(folder: Path) -> None:
    for name in bad_files(folder):
        result = run("relax", name, "-o", "out.3dm")
        assert result.exit_code == 2, name
        assert result.stdout == ""
        assert result.stderr.startswith("hookean: ") and result.stderr.count("\n") == 1, result.stderr
        assert name in result.stderr
        assert not (folder / "out.3dm").exists()


def test_an_empty_file_is_reported_as_empty(folder: Path) -> None:
    for name in ("empty.3dm", "empty.json", "empty.obj"):
        (folder / name).write_bytes(b"")
        result = run("relax", name)
        assert result.exit_code == 2, name
        assert name in result.stderr
        assert "empty" in result.stderr.split(name, 1)[1], result.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ("--recipe", "missing.toml"),
        ("--recipe", "broken.toml"),
        ("--recipe", "wrong.toml"),
        ("--recipe", "cable.3dm"),
        ("--recipe", "notes.md"),
        ("--check", "missing.toml"),
        ("--check", "broken.toml"),
        ("-o", "cable.3dm"),
        ("-o", "recipe.toml/folder/out.3dm"),
        ("-o", "new/out.dwg"),
        ("-r", "broken.toml", "-o", "new/deep/out.3dm"),
        ("-o", "new/../cable.3dm"),
        ("-o", "out.dwg"),
        ("-o", "out.3dm", "--csv", "out.3dm"),
        ("-o", "x" * 300 + ".3dm"),
        ("--csv", "cable.3dm"),
        ("--recipe", "recipe.toml", "--csv", "recipe.toml"),
        ("--recipe", "recipe.toml", "-o", "out.3dm", "--picture", "picture.jpg"),
    ],
)
def test_bad_options_get_one_sentence_and_exit_2(folder: Path, arguments: tuple[str, ...]) -> None:
    (folder / "broken.toml").write_text("[[forces", encoding="utf-8")
    (folder / "notes.md").write_text("# notes\n\nof mine", encoding="utf-8")
    (folder / "wrong.toml").write_text(CABLE.replace("layer:cable", "layer:rope"), encoding="utf-8")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    result = run("relax", "cable.3dm", *arguments)
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1 and result.stderr.startswith("hookean: ")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_many_files_go_to_a_folder_and_a_bad_one_stops_none(folder: Path) -> None:
    shutil.copy(folder / "cable.3dm", folder / "b.3dm")
    (folder / "text.3dm").write_text("no model", encoding="utf-8")
    result = run(
        *("relax", "cable.3dm", "text.3dm", "b.3dm", "-r", "recipe.toml"),
        *("-o", "out", "--csv", "out", "--report", "out"),
    )
    assert result.exit_code == 2 and result.stderr.count("\n") == 1
    assert names(folder / "out") == ["b.3dm", "b.csv", "b.report.json", "cable.3dm", "cable.csv", "cable.report.json"]
    assert run("relax", "cable.3dm", "b.3dm", "-r", "recipe.toml", "-o", "one.3dm").exit_code == 2
    assert "would be written twice" in run("relax", "cable.3dm", "cable.3dm", "-o", "out").stderr
    assert "never overwritten" in run("relax", "cable.3dm", "b.3dm", "-o", ".").stderr


def test_folders_to_write_to_are_made(folder: Path) -> None:
    """With a slash at its end a path is a folder, whatever is written and however many files there are."""
    places = ("-o", "new/", "--csv", "new/", "--report", "deep/er/", "--picture", "deep/picture.png")
    result = run("relax", "cable.3dm", "-r", "recipe.toml", *places)
    assert (result.exit_code, result.stderr) == (0, "")
    assert names(folder / "new") == ["cable.3dm", "cable.csv"]
    assert names(folder / "deep") == ["er", "picture.png"] and names(folder / "deep/er") == ["cable.report.json"]
    for path in ("new/cable.3dm", "new/cable.csv", "deep/er/cable.report.json", "deep/picture.png"):
        assert str(Path(path)) in result.stdout
    assert "nothing written" not in run("relax", "cable.3dm", "-r", "recipe.toml", "--csv", "a.csv").stdout
    assert "(nothing written; use -o to write a file)" in run("relax", "cable.3dm", "-r", "recipe.toml").stdout


def test_a_folder_made_for_nothing_is_taken_away(folder: Path) -> None:
    before = names(folder)
    (folder / "text.3dm").write_text("no model", encoding="utf-8")
    assert run("relax", "text.3dm", "-o", "new/deep/out.3dm").exit_code == 2
    assert names(folder) == sorted([*before, "text.3dm"])


def test_ctrl_c_stops_cleanly(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*arguments: object, **options: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("hookean.files.relax_file.relax_file", interrupted)
    result = run("relax", "cable.3dm", "-o", "out.3dm")
    assert result.exit_code == command.STOPPED
    assert result.stderr == "hookean: cable.3dm: stopped, nothing written\n"


def test_scenes_in_json(folder: Path) -> None:
    scene = {"forces": [{"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]]]}], "anchors": [{"points": [[0, 0, 0]]}]}
    (folder / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
    assert run("relax", "scene.json", "-o", "result.json", "-q").stdout == ""
    assert json.loads((folder / "result.json").read_text(encoding="utf-8"))["status"] == "converged"
    assert run("relax", "scene.json", "-r", "recipe.toml").exit_code == 2


def test_analyse_prints_and_writes_what_the_functions_give(folder: Path) -> None:
    scene = {
        "particles": [[-1, 0, 0], [0, 0, 0.3], [1, 0, 0]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 100},
            {"kind": "unary", "name": "snow", "particles": [1], "vector": [0, 0, -1]},
        ],
        "anchors": [{"particles": [0, 2]}, {"particles": [1], "axes": "y"}],
    }
    (folder / "truss.json").write_text(json.dumps(scene))
    asked = ("--buckling", "1", "--load-path", "20", "--load", "snow", "--mechanisms", "--frequencies", "2")
    found = run("analyse", "truss.json", *asked, "--report", "out/")
    assert found.exit_code == 0, found.output
    for line in (
        "mode 1: buckles at 5.4 times the loads",
        "states of self-stress: 0",
        "21 points",
        "mode 2: 2.12685 1/s",
    ):
        assert line in found.output
    written = json.loads((folder / "out" / "truss.analysis.json").read_text())
    wanted = hookean.load_path(hookean.Scene.read(scene), steps=20).to_dict()
    assert written["load_path"] == json.loads(json.dumps(wanted))
    assert sorted(written) == ["buckling", "frequencies", "load_path", "mechanisms"]
    assert run("analyse", "truss.json", "--buckling", "1", "--load", "wind").exit_code == 2
    assert "natural" not in run("analyse", "truss.json", "-q").output


def test_analyse_of_a_load_case_vibrates_under_its_loads(folder: Path) -> None:
    """A string of a tension that the case changes by its weight in the middle: not the frequencies of the form."""
    scene = {
        "particles": [[-1, 0, 0], [0, 0, 0], [1, 0, 0]],
        "forces": [
            {"kind": "constant_tension", "name": "string", "particles": [[0, 1], [1, 2]], "tension": 10},
            {"kind": "unary", "name": "lamp", "particles": [1], "vector": [0, 0, -8]},
        ],
        "anchors": [{"particles": [0, 2]}],
        "load_cases": {"lamp": {"forces": ["lamp"]}},
        "stages": {"freeze": {"string": {"axial_stiffness": 1000}}},
    }
    (folder / "string.json").write_text(json.dumps(scene))
    case = hookean.load_cases(hookean.Scene.read(scene)).cases["lamp"].result
    wanted = hookean.frequencies(case, 3).frequencies
    form = hookean.frequencies(hookean.Scene.read(scene), 3)
    assert wanted[0] > 1.2 * form.frequencies[0]
    assert "frequencies of the form" in form.notes[-1]
    for asked in ((), ("--frequencies", "3", "--buckling", "1"), ("--mechanisms", "--frequencies", "3")):
        found = run("analyse", "string.json", *asked, "--case", "lamp")
        assert f"mode 1: {wanted[0]:.6g} 1/s" in found.output
        assert "frequencies of the form" not in found.output
    assert run("analyse", "string.json", "--mechanisms", "--case", "storm").exit_code == 2


def test_relax_solves_a_load_case_and_checks_it(folder: Path) -> None:
    """Displacements from the form, reactions and slack of the case; the loads of the case do not act without it."""
    scene = {
        "particles": [[0, 0, 0], [2, 0, 0], [4, 0, 0]],
        "forces": [
            {"kind": "constant_tension", "name": "cable", "particles": [[0, 1], [1, 2]], "tension": 30},
            {"kind": "unary", "name": "snow load", "particles": [1], "vector": [0, 0, -10]},
        ],
        "anchors": [{"name": "ends", "particles": [0, 2]}],
        "load_cases": {"snow": {"forces": ["snow load"]}},
        "combinations": {"ULS 1": {"snow": 1.5, "prestress": 1.35}},
        "stages": {"freeze": {"cable": {"axial_stiffness": 2000, "tension_only": True}}},
    }
    (folder / "cable.json").write_text(json.dumps(scene))
    for case, name in (("snow", "snow"), ("ULS 1", "uls")):
        found = run("relax", "cable.json", "--case", case, "-o", f"{name}.json", "--csv", "t.csv", "--picture", "p.png")
        assert found.exit_code == 0, found.output
        wanted = hookean.load_cases(Scene.read(scene), [case]).cases[case].result
        assert json.loads((folder / f"{name}.json").read_text())["particles"] == wanted.particles.tolist()
    assert run("relax", "cable.json", "-o", "form.json", "--csv", "f.csv", "--picture", "f.png").exit_code == 0
    assert json.loads((folder / "form.json").read_text())["particles"] == scene["particles"]
    sag = -wanted.particles[1, 2]
    (folder / "limits.toml").write_text(
        f"max_displacement = {0.9 * sag}\nmax_slack = 0\n[anchor.ends]\nmax_reaction = 1"
    )
    found = run("relax", "cable.json", "--case", "ULS 1", "--check", "limits.toml")
    assert found.exit_code == 1
    assert f"max displacement {sag:.6g} m" in found.output and "max reaction" in found.output
    assert "slack" not in found.output
    scene["forces"][1]["vector"] = [3000, 0, 0]
    (folder / "cable.json").write_text(json.dumps(scene))
    found = run("relax", "cable.json", "--case", "snow", "--check", "limits.toml")
    assert "model: 1 elements are slack, the first is element 1 of cable; at most 0 may be" in found.output
    assert run("relax", "cable.json", "--case", "rain").exit_code == 2


def test_a_case_of_beams_has_the_closed_form(folder: Path) -> None:
    """A cantilever under P = 1 N at its end: P L^3 / 3 EI = 1/3 mm; the moment at the clamp is P L."""
    beam = {"kind": "beam", "name": "b", "particles": [[0, 1]], "E": 1e6, "G": 4e5, "A": 0.1, "Iy": 1e-3, "Iz": 1e-3,
            "J": 1e-3}  # fmt: skip
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0]],
        "forces": [beam, {"kind": "unary", "name": "P", "particles": [1], "vector": [0, 0, -1]}],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
        "load_cases": {"P": {"forces": ["P"]}},
    }
    (folder / "beam.json").write_text(json.dumps(scene))
    found = run("relax", "beam.json", "--case", "P", "-o", "out.3dm", "--csv", "out.csv")
    assert found.exit_code == 0 and "moved by up to 0.0003333 m" in found.output, found.output
    with open(folder / "out.csv", newline="") as file:
        [row] = [row for row in csv.DictReader(file) if row["kind"] == "reaction"]
    assert float(row["moment y [N m]"]) == pytest.approx(-1.0, rel=1e-6)


def test_a_recipe_has_load_cases(folder: Path) -> None:
    """The tables of a scene, for the objects of a Rhino model; rows of the case name the objects they came from."""
    ends = [[0, 0, 0], [2, 0, 0], [4, 0, 0]]
    drawn = [
        (np.array(ends[:2], float), "cables"),
        (np.array(ends[1:], float), "cables"),
        (np.array(ends[1], float), "snow"),
    ]
    drawn += [(np.array(end, float), "anchors") for end in (ends[0], ends[2])]
    threedm.write_new(folder / "cable.3dm", Additions((), [NewObject(*item) for item in drawn]), own=False)
    recipe = """
        forces = [
            {kind = "constant_tension", name = "edge", lines = "layer:cables", tension = 30},
            {kind = "unary", name = "snow load", points = "layer:snow", vector = [0, 0, -10]},
        ]
        anchors = [{points = "layer:anchors"}]
        load_cases.snow.forces = ["snow load"]
        combinations."ULS 1" = {prestress = 1.35, snow = 1.5}
        stages.freeze.edge.axial_stiffness = 2000
    """
    (folder / "cases.toml").write_text(recipe)
    found = run("relax", "cable.3dm", "-r", "cases.toml", "--case", "ULS 1", "-o", "out.3dm", "--csv", "out.csv")
    assert found.exit_code == 0, found.output
    assert "moved by up to 0.2614 m" in found.output  # as in tests/core/test_load_cases.py, which has the closed form
    rows = (folder / "out.csv").read_text().splitlines()
    assert ",cables,edge,springs,0,0 1," in rows[1]
    (folder / "cases.toml").write_text(recipe.replace("snow = 1.5", "fog = 1.5"))
    found = run("relax", "cable.3dm", "-r", "cases.toml", "--case", "ULS 1")
    assert found.exit_code == 2 and "cases.toml /combinations/ULS 1/fog: no load case is called 'fog'" in found.output


def test_patterns_writes_sheets_and_tables(folder: Path) -> None:
    mesh = grid(np.arange(5.0), np.arange(5.0))
    points = mesh.vertices + np.column_stack(
        [np.zeros((len(mesh.vertices), 2)), 0.2 * np.prod(mesh.vertices[:, :2], axis=1)]
    )
    middle = points[:, :2].mean(axis=0)
    rim = [p for p in points.tolist() if max(abs(p[0] - middle[0]), abs(p[1] - middle[1])) > 1.9]
    scene = {
        "meshes": {"roof": {"vertices": points.tolist(), "faces": mesh.faces.tolist()}},
        "forces": [{"kind": "springs", "name": "cloth", "mesh": "roof", "stiffness": 100, "rest_factor": 0.9}],
        "anchors": [{"points": rim}],
    }
    (folder / "roof.json").write_text(json.dumps(scene))
    asked = ("--rows", "2", "--compensation", "0.01", "0.02", "--allowance", "0.05", "--stretch", "0.001")
    files = ("-o", "out/roof.dxf", "--table", "out/", "--cables", "out/")
    found = run("patterns", "roof.json", *asked, *files)
    assert found.exit_code == 0, found.output
    assert "2 strips" in found.output and "cables" in found.output
    assert names(folder / "out") == ["roof.cables.csv", "roof.dxf", "roof.strips.csv"]
    lines = (folder / "out" / "roof.strips.csv").read_text().splitlines()
    assert lines[0].startswith("strip,length [m],width [m]") and len(lines) == 3
    assert "cut length [m]" in (folder / "out" / "roof.cables.csv").read_text()
    for wrong in (("--along", "bias"), ("--mesh", "wall"), ("-o", "roof.pdf"), ("--rows", "0")):
        assert run("patterns", "roof.json", *wrong).exit_code == 2


def test_report_writes_one_page(folder: Path) -> None:
    scene = {
        "particles": [[0, 0, 0], [2, 0, 0], [4, 0, 0]],
        "forces": [
            {"kind": "springs", "name": "cable", "particles": [[0, 1], [1, 2]], "rest_factor": 0.9},
            {"kind": "unary", "name": "snow", "particles": [1], "vector": [0, 0, -10]},
        ],
        "anchors": [{"particles": [0, 2]}],
        "load_cases": {"snow": {"forces": ["snow"]}},
    }
    (folder / "cable.json").write_text(json.dumps(scene))
    (folder / "limits.toml").write_text("max_displacement = 1e-6")
    assert run("report", "cable.json").exit_code == 0
    text = (folder / "cable.report.html").read_text()
    assert "<h1>cable</h1>" in text and "Case snow" in text
    found = run("report", "cable.json", "-o", "out/", "--title", "My roof", "--check", "limits.toml", "-q")
    assert found.exit_code == 1 and found.stdout == ""
    assert found.stderr.startswith("hookean: cable.json: limit exceeded: snow: ") and found.stderr.count("\n") == 1
    text = (folder / "out" / "cable.html").read_text()
    assert "<h1>My roof</h1>" in text and "exceeds the limit" in text
    (folder / "limits.toml").write_text("max_displacement = 1")
    assert run("report", "cable.json", "--check", "limits.toml").exit_code == 0
    (folder / "limits.toml").write_text("[forces.rope]\nmax_force = 1")
    assert run("report", "cable.json", "--check", "limits.toml").exit_code == 2


def test_a_report_of_a_case_without_equilibrium_exits_like_relax(folder: Path) -> None:
    """Two iterations are enough where nothing moves, and too few under wind; the report is written."""
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0]],
        "forces": [
            {"kind": "springs", "name": "cable", "particles": [[0, 1]], "stiffness": 100},
            {"kind": "unary", "name": "wind", "particles": [1], "vector": [0, 10, 0]},
        ],
        "anchors": [{"particles": [0]}],
        "load_cases": {"calm": {"forces": ["wind"], "factor": 0}, "storm": {"forces": ["wind"]}},
        "stages": {"form": "drawn"},
        "settings": {"max_iterations": 2},
    }
    (folder / "cable.json").write_text(json.dumps(scene))
    found = run("report", "cable.json")
    assert found.exit_code == 3 and (folder / "cable.report.html").exists()
    assert found.stderr.startswith("hookean: cable.json: storm: Not in equilibrium") and "calm" not in found.stderr


def test_version_forces_and_help() -> None:
    assert run("--version").stdout == f"hookean {hookean.__version__}\n"
    listed = run("forces")
    assert listed.exit_code == 0
    for kind, cls in KINDS.items():
        assert f"\n{kind}  " in f"\n{listed.stdout}"
        assert all(f"\n    {name} " in listed.stdout for name in cls.model_fields if name != "kind")
    assert "k [force/length] (default 1000" in listed.stdout
    assert run().exit_code != 1 and "relax" in run("--help").stdout
    assert run("fold").exit_code == 2


def test_commands_of_other_packages_are_found_by_their_entry_points(monkeypatch: pytest.MonkeyPatch) -> None:
    """An option stands once, in the dataclass that the command runs with; a package that is missing is named."""
    from hookean_server.lifecycle import command

    seen: list[command.Options] = []
    monkeypatch.setattr(command, "serve", taking(command.Options, lambda options: seen.append(options) or 3))
    assert run("serve", "--host", "127.0.0.2", "--port", "1234", "--no-keep").exit_code == 3
    assert seen == [command.Options("127.0.0.2", 1234, no_keep=True)]
    monkeypatch.setitem(sys.modules, "hookean_server.lifecycle.command", None)
    refused = run("serve", "--port", "0")
    assert refused.exit_code == 2 and "serve: hookean_server is not installed" in refused.stderr
    assert run("relax", "--help").exit_code == 0


def test_help_starts_light() -> None:
    heavy = ("numba", "scipy", "matplotlib", "fastapi", "pydantic", "rhino3dm", "numpy")
    code = (
        "import sys, hookean.cli\n"
        "try:\n    hookean.cli.app(['--help'])\n"
        "except SystemExit:\n    pass\n"
        f"print('loaded:', [m for m in {heavy!r} if m in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.rstrip().endswith("loaded: []"), done.stdout[-200:] + done.stderr


def test_processes_answer_with_their_codes(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The command as a process of its own."""
    monkeypatch.chdir(folder)
    good = forking.run(forking.COMMAND, "relax", "cable.3dm", "-o", "out.3dm", "-r", "recipe.toml")
    assert (good.returncode, good.stderr) == (0, "")
    bad = forking.run(forking.COMMAND, "relax", "missing.3dm", "-o", "no.3dm")
    assert bad.returncode == 2 and bad.stderr == "hookean: missing.3dm: no such file; check the path.\n"
    first = (folder / "out.3dm").read_bytes()
    forking.run(forking.COMMAND, "relax", "out.3dm", "-o", "again.3dm", "-r", "recipe.toml")
    assert (folder / "again.3dm").read_bytes() == first


@pytest.mark.parametrize("stem", ["v7_my_surfaces", "v7_my_trimmed_surface", "v7_my_points"])
def test_real_files_without_a_recipe(folder: Path, stem: str) -> None:
    source = REAL / f"{stem}.3dm"
    if not source.exists():
        pytest.skip(f"no {source}")
    result = run("relax", str(source), "-o", "out.3dm")
    expected = 0 if stem == "v7_my_surfaces" else 2
    assert result.exit_code == expected
    assert (folder / "out.3dm").exists() == (expected == 0)
    assert expected == 0 or "has nothing to relax" in result.stderr
    assert run("relax", str(source), "--explain").exit_code == 0


def test_a_scene_in_json_is_relaxed_without_what_reads_models(folder: Path) -> None:
    """The quick way from the shell to an answer: no rhino3dm, no scipy, nothing for pictures or the service, and of
    the forces those that the scene has."""
    scene = Scene(
        forces=[
            {"kind": "springs", "lines": [[[i, 0, 0], [i + 1, 0, 0]] for i in range(4)]},
            {"kind": "self_weight", "total": 4},
        ],
        anchors=[{"points": [[0, 0, 0], [4, 0, 0]]}],
    )
    (folder / "scene.json").write_text(scene.canonical)
    code = (
        "import sys, hookean.cli\n"
        "others = ('shell', 'beam', 'collide', 'fits', 'rigid_body')\n"
        "try:\n    hookean.cli.app(['relax', 'scene.json'])\n"
        "except SystemExit as end:\n    print(end.code)\n"
        "heavy = ('rhino3dm', 'scipy', 'matplotlib', 'fastapi', 'compas', *map('hookean.forces.{}'.format, others))\n"
        "print('loaded:', [m for m in heavy if m in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=HANG, cwd=folder)
    assert done.stdout.splitlines()[-2:] == ["0", "loaded: []"], done.stdout + done.stderr
