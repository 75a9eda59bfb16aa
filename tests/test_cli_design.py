"""`hookean design`: a drawing, its recipe and a problem beside it in; drawing, table, picture and answer out."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path

import pytest
import rhino3dm
from PIL import Image
from typer.testing import CliRunner

from hookean.commands.design import Stop, app

VAULT = Path(__file__).parent.parent / "gh_examples" / "hanging-vault"
PROBLEM = """scene = "model.3dm"
recipe = "recipe-chain.toml"
[[variables]]
force = "chain"
field = "rest_length"
tie = "all"
lower = 0.51
upper = 1.0
[[goals]]
kind = "position"
particles = [16]
axes = "z"
target = -6.0
"""


@pytest.fixture
def problem(tmp_path: Path) -> Path:
    for name in ("model.3dm", "recipe-chain.toml"):
        shutil.copy(VAULT / name, tmp_path)
    path = tmp_path / "problem.toml"
    path.write_text(PROBLEM)
    return path


def test_a_drawing_is_written_back_with_table_and_picture(problem: Path, tmp_path: Path) -> None:
    """The chain of 32 links hangs 6 m deep: in the drawing, in the table and in the answer."""
    out = tmp_path / "new"
    arguments = [str(problem), "-o", f"{out}/", "--csv", f"{out}/", "--picture", f"{out}/", "--report", f"{out}/a.json"]
    ran = CliRunner().invoke(app, arguments)
    assert ran.exit_code == 0, ran.output
    assert "goal position: -6 m, target -6 m" in ran.output and "chain.rest_length: 0.6542 m" in ran.output
    assert sorted(p.name for p in out.iterdir()) == ["a.json", "problem.3dm", "problem.csv", "problem.png"]
    drawn = rhino3dm.File3dm.Read(str(out / "problem.3dm"))
    layers = {item.Name: item.Index for item in drawn.Layers}
    assert {"net", "columns", "chain"} <= set(layers)  # those of the model are there, moved
    boxes = [o.Geometry.GetBoundingBox() for o in drawn.Objects if o.Attributes.LayerIndex == layers["chain"]]
    assert min(box.Min.Z for box in boxes) == pytest.approx(-6.0, abs=1e-6)
    rows = list(csv.DictReader((out / "problem.csv").read_text().splitlines()))
    links = [float(row["length [m]"]) for row in rows if row["force"] == "chain"]
    answer = json.loads((out / "a.json").read_text())
    rest = answer["variables"][0]["value"]
    assert links == pytest.approx([rest] * 32, rel=1e-4)  # k = 1e7 kN/m: strains of 5e-6
    with Image.open(out / "problem.png") as picture:
        assert picture.width > 500 and len(picture.convert("RGB").getcolors(1 << 24) or []) > 10


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('scene = "model.3dm"', 'scene = "lost.3dm"', "lost.3dm"),
        ('"recipe-chain.toml"', '"lost.toml"', "lost.toml: cannot be read"),
        ('"recipe-chain.toml"', "5", "the path of a recipe"),
        ('scene = "model.3dm"', "", "/scene: problem.toml has no scene"),
        ('force = "chain"', 'force = "rope"', "/variables/0/force"),
        ("-6.0", "nan", "/goals/0/target"),
        ("[[goals]]", "[[goal]]", "/goal"),
        ("upper = 1.0", "upper = = 1", "problem.toml"),
    ],
)
def test_bad_input_is_one_sentence(problem: Path, old: str, new: str, sentence: str) -> None:
    problem.write_text(PROBLEM.replace(old, new))
    ran = CliRunner().invoke(app, [str(problem), "-o", str(problem.parent / "sub" / "out.3dm")])
    assert ran.exit_code == 2 and sentence in ran.output and "Traceback" not in ran.output
    assert ran.output.count("\n") == 1 and not (problem.parent / "sub").exists()


def test_an_output_never_replaces_the_problem(problem: Path) -> None:
    ran = CliRunner().invoke(app, [str(problem), "--report", str(problem)])
    assert ran.exit_code == 2 and problem.read_text() == PROBLEM


def test_stopping_keeps_the_best_so_far() -> None:
    """Ctrl-C asks the search to end; a second one ends the command."""
    import signal

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a run in the background ignores it
    try:
        stop = Stop()
        with stop:
            signal.raise_signal(signal.SIGINT)
            assert stop()
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
