"""The README tells the truth: its scenes run as they are printed there."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

import forking

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def block(language: str, holding: str) -> str:
    """The fenced block of a language that holds a text."""
    return next(b for b in re.findall(rf"```{language}\n(.*?)```", TEXT, re.S) if holding in b)


def test_the_python_scene_prints_what_its_comments_say(capsys):
    """Tensions 97.8 91.5 89.3 91.5 97.8 N, as the README's comment has them."""
    code = block("python", "relax(scene)")
    exec(compile(code, "README.md", "exec"), {})
    said = capsys.readouterr().out
    assert said.startswith("In equilibrium after ")
    told = [float(t) for t in re.search(r"tension in N: ([\d. ]+)", code).group(1).split()]
    printed = [float(t) for t in re.search(r"\[([\d. ]+)\]", said).group(1).split()]
    assert printed == pytest.approx(told, abs=0.05)


def test_the_curl_line_sends_the_same_scene():
    """The JSON of the curl line relaxes to the Python scene's tensions."""
    from hookean import Scene, relax

    words = shlex.split(block("sh", "curl"))
    body = words[words.index("-d") + 1]
    assert words[words.index("-H") + 1] == "Content-Type: application/json"
    result = relax(Scene.read(body))
    assert result.force("springs")["force"] == pytest.approx(
        [97.82876, 91.49025, 89.27747, 91.49025, 97.82876], abs=1e-3
    )
    json.loads(body)


def test_the_file_line_writes_what_it_says(tmp_path, monkeypatch):
    """The command as printed, run in the project's folder with its outputs in another; exit code 0."""
    words = shlex.split(block("sh", "hookean relax"))
    assert words[0] == "hookean"
    for option in ("-o", "--picture", "--csv"):
        place = words.index(option) + 1
        words[place] = str(tmp_path / Path(words[place]).name)
    monkeypatch.chdir(ROOT)
    done = forking.run(forking.COMMAND, *words[1:])
    assert done.returncode == 0, done.stderr
    for name in ("membrane.3dm", "membrane.png", "membrane.csv"):
        assert (tmp_path / name).stat().st_size > 1000


def test_the_line_of_a_run_in_motion_writes_what_it_says(tmp_path, monkeypatch):
    """The command as printed, with its outputs in a folder that is not there yet; a row for each frame."""
    words = shlex.split(block("sh", "hookean simulate"))
    for option in ("--picture", "--csv"):
        place = words.index(option) + 1
        words[place] = str(tmp_path / words[place])
    monkeypatch.chdir(ROOT)
    done = forking.run(forking.COMMAND, *words[1:])
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "frames.csv").read_text(encoding="utf-8").count("\n") > 10
    assert (tmp_path / "out" / "motion.png").stat().st_size > 1000


def test_what_the_readme_links_is_there():
    """Every link and picture within the project."""
    found = re.findall(r"\]\(([^)#:]+)\)|src=\"([^\"]+)\"", TEXT)
    assert len(found) > 8
    assert [a or b for a, b in found if not (ROOT / (a or b)).exists()] == []


def test_the_readmes_picture_is_the_example_and_not_blank():
    """docs/membrane.png: many colours, and the legend's ends are the result's extreme forces."""
    from matplotlib.image import imread

    from hookean.files.relax_file import relax_file
    from hookean.pictures.picture import legend

    pixels = imread(ROOT / "docs" / "membrane.png")
    assert len(np.unique((pixels[::4, ::4, :3] * 255).astype(int).reshape(-1, 3), axis=0)) > 100
    folder = ROOT / "gh_examples" / "9.24-membrane"
    recipe = (folder / "recipe.toml").read_text(encoding="utf-8")
    result = relax_file(folder / "model.3dm", None, recipe).result
    low, high, unit = legend(result)
    forces = np.concatenate([f["force"] for f in result.forces if f["kind"] == "springs"])
    assert (low, high, unit) == (forces.min(), forces.max(), "N")
