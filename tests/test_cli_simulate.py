"""`hookean simulate`: a row for each frame, ways to end with their exit codes, and what is kept of a broken run."""

from __future__ import annotations

import csv
import io
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from typer.testing import CliRunner

from hookean import Scene, Simulation, cli
from hookean.files.rhino import threedm
from samples import cable
from serving import HANG, hears, wait_for

LIFT = '[[anchors]]\nanchor = "ends"\ntimes = [0, 1]\nshifts = [[0, 0, 0], [0, 0, 1]]\n'
WIND = '[[drives]]\nforce = "1"\ncolumn = "vector"\nsource = "speed [m/s]"\nscale = [0, 0.5, -20]\npower = 2\n'
ROWS = "time [s],speed [m/s]\n0,1\n0.5,2\n1.0,1\n"
RECIPE = """
forces = [
  {kind = "springs", name = "cable", lines = "layer:cable", divide = 5, stiffness = 1000},
  {kind = "unary", points = "vertices:layer:cable", vector = [0, 0, -20]},
]
anchors = [{name = "ends", points = "ends:layer:cable"}]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with the cable of the chapter, a script of its anchors, one of the wind, and wind."""
    (tmp_path / "cable.json").write_text(cable().canonical)
    (tmp_path / "slow.json").write_text(cable(tolerance=1e-2, drag=10).canonical)
    for name, text in (("lift.toml", LIFT), ("wind.toml", WIND), ("wind.csv", ROWS), ("recipe.toml", RECIPE)):
        (tmp_path / name).write_text(text, encoding="utf-8")
    line = threedm.NewObject(np.array([[0.0, 0, 0], [10, 0, 0]]), "cable", "main")
    threedm.write_new(tmp_path / "cable.3dm", threedm.Additions((), [line]), own=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*arguments: str, given: str | None = None) -> Result:
    """The command in this process; an exception that gets out fails the test."""
    return CliRunner().invoke(cli.app, ["simulate", *arguments], input=given, catch_exceptions=False)


def rows(text: str) -> list[dict[str, str]]:
    """The rows of a table by column."""
    return list(csv.DictReader(io.StringIO(text)))


def test_a_row_for_each_frame_with_units_in_the_head(folder: Path):
    """The numbers are those of a Simulation stepped alike; ten digits are written."""
    done = run("cable.json", "--script", "lift.toml", "--frames", "8", "--csv", "-")
    assert done.exit_code == 0
    table = rows(done.stdout)
    assert list(table[0]) == [
        "time [s]", "iteration", "residual [-]", "kinetic energy [N m]", "largest force of cable [N]",
        "largest force of load [N]", "largest displacement [m]", "largest reaction [N]",
    ]  # fmt: skip
    simulation = Simulation(cable(), LIFT)
    for row in table:
        result = simulation.result()
        force = result.force("cable")["force"]
        moved = np.linalg.norm(result.particles - simulation.system.x, axis=1).max()
        reaction = np.linalg.norm(result.reactions["force"], axis=1).max()
        expected = [result.time, result.energy["kinetic"], force[np.argmax(np.abs(force))], 20.0, moved, reaction]
        columns = list(row)[:1] + list(row)[3:]
        assert [float(row[c]) for c in columns] == pytest.approx(expected, rel=1e-9)
        simulation.step()
    assert len(table) == 9
    assert "8 frames, 1.6 s." in done.stderr


def test_it_ends_at_rest_and_writes_the_shape(folder: Path):
    """Without --frames it goes on to rest: exit code 0, the result as JSON and the picture beside it."""
    done = run("slow.json", "--script", "lift.toml", "-o", "out.json", "--picture", "out.png", "--csv", "out.csv")
    assert done.exit_code == 0
    assert "In equilibrium" in done.stdout
    written = json.loads((folder / "out.json").read_text("utf-8"))
    assert written["status"] == "converged"
    assert written["particles"][0] == [0, 0, 1]
    assert (folder / "out.png").read_bytes().startswith(b"\x89PNG")
    assert float(rows((folder / "out.csv").read_text("utf-8"))[-1]["residual [-]"]) <= 1e-2


def test_a_rhino_file_moves_by_its_recipe(folder: Path):
    """The same cable drawn as a line: the same frames; the copy has the result on a layer of its own."""
    drawn = run("cable.3dm", "-r", "recipe.toml", "--frames", "4", "--csv", "-", "-o", "out.3dm")
    given = run("cable.json", "--frames", "4", "--csv", "-")
    assert drawn.exit_code == given.exit_code == 0
    for mine, other in zip(rows(drawn.stdout), rows(given.stdout), strict=True):
        assert [float(v) for v in mine.values()] == pytest.approx([float(v) for v in other.values()], rel=1e-9)
    assert any(layer.startswith("hookean") for layer in (o.layer for o in threedm.read(folder / "out.3dm").objects))


def test_a_stream_from_a_file_and_from_a_pipe_give_the_same_rows(folder: Path):
    """It ends with the stream: rows to 1 s, so five frames and the one in which it ends."""
    filed = run("cable.json", "--script", "wind.toml", "--stream", "wind.csv", "--csv", "-")
    piped = run("cable.json", "--script", "wind.toml", "--stream", "-", "--csv", "-", given=ROWS)
    assert filed.exit_code == piped.exit_code == 0
    assert filed.stdout == piped.stdout
    assert rows(filed.stdout)[-1]["time [s]"] == "1.2"


def test_a_wrong_row_says_its_line_and_leaves_the_frames_before_it(folder: Path):
    """Exit code 2, one sentence, and everything until then is written."""
    done = run("cable.json", "--script", "wind.toml", "--stream", "-", "--csv", "out.csv", "-o", "out.json",
               given=ROWS + "2,calm\n")  # fmt: skip
    assert done.exit_code == 2
    assert "standard input line 5: speed is 'calm'; give a finite number in m/s" in done.stderr
    assert [row["time [s]"] for row in rows((folder / "out.csv").read_text("utf-8"))] == [
        "0", "0.2", "0.4", "0.6", "0.8", "1"
    ]  # fmt: skip
    assert json.loads((folder / "out.json").read_text("utf-8"))["time"] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nix.json"], "nix.json"),
        (["cable.json", "--script", "nix.toml"], "nix.toml cannot be read"),
        (["cable.json", "--script", "wind.toml"], "wind.toml /drives: speed [m/s] needs a stream; give one"),
        (["cable.json", "--stream", "wind.csv"], "no drive uses it"),
        (
            ["cable.json", "--script", "recipe.toml"],
            "recipe.toml /forces/0/kind is a field of recipes; pass this file with --recipe",
        ),
        (["cable.3dm", "-r", "lift.toml"], "lift.toml /anchors/0/times is a field of scripts"),
        (["cable.3dm", "-r", "wind.toml", "--script", "recipe.toml"], "wind.toml /drives is a field of scripts"),
        (["cable.json", "--script", "wind.toml", "--stream", "gone.csv"], "gone.csv cannot be read"),
        (["cable.json", "--csv", "cable.json"], "never overwritten"),
        (["cable.json", "--picture", "a.jpg"], "is not a .png file"),
        (["cable.json", "-o", "a.stl"], "must end in .3dm, .json, .obj"),
        (["cable.json", "-o", "a.json", "--csv", "a.json"], "would be written twice"),
        (["cable.json", "--csv", "wind.csv/a.csv"], "the folder cannot be made"),
        (["cable.json", "-o", "new/a.stl"], "must end in .3dm, .json, .obj"),
        (["cable.json", "-o", "new/../cable.json"], "never overwritten"),
    ],
)
def test_bad_input_is_one_sentence_and_nothing_is_written(folder: Path, arguments: list[str], said: str):
    """Exit code 2; the folder is as it was."""
    before = sorted(path.name for path in folder.iterdir())
    done = run(*arguments)
    assert done.exit_code == 2
    assert said in done.stderr.replace("nix.json: ", "nix.json ")
    assert done.stderr.count("\n") == 1
    assert sorted(path.name for path in folder.iterdir()) == before


def test_folders_to_write_to_are_made(folder: Path):
    """A slash at the end says folder; files in it are named as the input, and the last line names them."""
    done = run("cable.json", "--frames", "2", "-o", "new/", "--csv", "new/deep/", "--picture", "new/a.png")
    assert done.exit_code == 0
    for path in ("new/cable.json", "new/deep/cable.csv", "new/a.png"):
        assert (folder / path).is_file() and str(Path(path)) in done.stdout


def test_what_never_rests_ends_at_the_most_iterations_with_3(folder: Path):
    """Without damping and drag the cable swings for ever."""
    scene = cable(drag=0, max_iterations=100).model_dump()
    scene["forces"][0]["damping"] = 0.0
    (folder / "swing.json").write_text(Scene(**scene).canonical)
    done = run("swing.json")
    assert done.exit_code == 3
    assert "not at rest after 5 frames" in done.stderr


def test_what_diverges_ends_with_3_and_its_frames(folder: Path):
    """A step beyond stability: told before, and told again."""
    (folder / "wild.json").write_text(cable(time_step=0.5).canonical)
    done = run("wild.json", "--csv", "out.csv")
    assert done.exit_code == 3
    assert "Diverged" in done.stderr
    assert "is too large for this mass and the stiffness of /forces/0" in done.stderr
    assert len(rows((folder / "out.csv").read_text("utf-8"))) >= 2


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT for one child")
def test_ctrl_c_writes_what_was_seen(folder: Path):
    """A live stream is waited for; Ctrl-C ends it with 130, and rows, picture and shape are there."""
    arguments = ["cable.json", "--script", "wind.toml", "--stream", "-", "--csv", "out.csv", "-o", "out.json"]
    process = subprocess.Popen(
        [sys.executable, "-m", "hookean.cli", "simulate", *arguments],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        preexec_fn=hears,
    )  # fmt: skip
    assert process.stdin is not None
    process.stdin.write(ROWS)
    process.stdin.flush()
    table = folder / "out.csv"
    wait_for(lambda: table.exists() and table.read_text("utf-8").count("\n") == 7)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=HANG)
    assert process.returncode == 130
    assert "stopped after 5 frames, 1 s." in said
    assert rows(table.read_text("utf-8"))[-1]["time [s]"] == "1"
    assert json.loads((folder / "out.json").read_text("utf-8"))["time"] == pytest.approx(1.0)


full = pytest.mark.skipif(not os.path.exists("/dev/full"), reason="a disk that is always full")


@full
def test_a_table_on_a_full_disk_is_one_sentence(folder: Path):
    """Exit code 2, not 1: no limit is exceeded; and no traceback."""
    done = run("cable.json", "--frames", "2", "--csv", "/dev/full")
    assert done.exit_code == 2 and "/dev/full: cannot be written (No space left on device)" in done.stderr


@full
@pytest.mark.slow
def test_a_full_disk_behind_standard_output_is_one_sentence(folder: Path):
    """As `hookean relax cable.json > file` on one."""
    command = [sys.executable, "-m", "hookean.cli", "simulate", "cable.json", "--frames", "1"]
    with open("/dev/full", "wb") as nowhere:
        done = subprocess.run(command, stdout=nowhere, stderr=subprocess.PIPE, text=True, timeout=HANG, check=False)
    assert done.returncode == 2
    assert done.stderr.splitlines() == [
        "hookean: standard output cannot be written (No space left on device); check free space"
    ]
