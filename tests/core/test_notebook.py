"""What a person types at a prompt: scenes and results print in a few lines, plot, give tables and write files."""

from __future__ import annotations

import csv
import inspect
import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import hookean
from hookean import InputError, Result, Scene, relax
from hookean.forces import KINDS
from samples import cable


@pytest.fixture(scope="module")
def result() -> Result:
    return relax(cable())


@pytest.mark.slow
def test_scenes_and_results_print_in_a_few_lines(result: Result) -> None:
    """Every number has its unit; a notebook shows the same, and of a result a picture that lies in the page."""
    for shown in (cable(), result):
        lines = repr(shown).splitlines()
        assert 3 < len(lines) < 10 and all(len(line) < 120 for line in lines)
        page = shown._repr_html_()
        assert page.startswith("<div><b>") and "http" not in page
    assert "cable (springs)" in repr(cable()) and "units: m, N, s" in repr(cable())
    assert repr(result).startswith("Result: converged.") and " N" in repr(result)
    assert "data:image/png;base64," in result._repr_html_()


def test_text_of_a_person_is_no_markup(result: Result) -> None:
    """Names of forces come from files of others: what is markup in them is shown, not obeyed."""
    forces = [{"kind": "springs", "name": "<script>x</script>", "lines": [[[0, 0, 0], [1, 0, 0]]]}]
    page = Scene(forces=forces)._repr_html_()
    assert "<script" not in page and "&lt;script&gt;" in page


@pytest.mark.parametrize("model", [Scene, hookean.Settings, *KINDS.values()])
def test_signatures_are_readable(model: type) -> None:
    """Less than a screen, with the names that the source has for types; once up to 10 kB."""
    text = str(inspect.signature(model))
    assert len(text) < 1000 and "Validator" not in text and "0x" not in text


def test_a_plot_is_a_picture_of_its_size(result: Result, tmp_path: Path) -> None:
    picture = result.plot(size=(400, 300), view="front")
    assert Image.open(io.BytesIO(picture._repr_png_())).size == (400, 300)
    picture.save(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == picture.png
    with pytest.raises(InputError, match=r"ends in \.png"):
        picture.save(tmp_path / "a.gif")
    with pytest.raises(InputError, match="view"):
        result.plot(view="sideways")


def test_a_table_has_a_row_for_each_element(result: Result) -> None:
    """Columns have their units in their names; frames of pandas and polars are made from the rows."""
    rows = result.table("cable")
    assert list(rows[0]) == ["particle 1", "particle 2", "length [m]", "force [N]", "strain [-]"]
    assert [row["force [N]"] for row in rows] == result.force("cable")["force"].tolist()
    loads = result.table("load")
    assert loads[3] == {
        "particle": 3,
        **{f"force {axis} [N]": size for axis, size in (("x", 0.0), ("y", 0.0), ("z", -20.0))},
        **{f"moment {axis} [N m]": 0.0 for axis in "xyz"},
    }
    with pytest.raises(InputError, match="no force is called 'rope'; there are 'cable', 'load'"):
        result.table("rope")


@pytest.mark.parametrize("package", ["pandas", "polars"])
def test_frames_take_the_rows(result: Result, package: str) -> None:
    frame = pytest.importorskip(package).DataFrame(result.table("cable"))
    assert frame.shape == (5, 5)


@pytest.mark.parametrize("ending", [".3dm", ".json", ".obj", ".csv", ".png"])
def test_a_result_is_saved_by_its_ending(result: Result, tmp_path: Path, ending: str) -> None:
    """What can hold a model opens again as the same scene, or with its shape."""
    path = tmp_path / f"cable{ending}"
    assert result.save(path) == []
    if ending == ".3dm":
        assert hookean.open(path) == cable()
    elif ending == ".obj":
        points = np.array([line.split()[1:] for line in path.read_text().splitlines() if line.startswith("v ")], float)
        assert points == pytest.approx(result.particles, abs=1e-6)
    elif ending == ".csv":
        rows = list(csv.DictReader(path.read_text().splitlines()))
        assert [float(r["force [N]"]) for r in rows if r["kind"] == "springs"] == result.force("cable")[
            "force"
        ].tolist()


def test_what_cannot_be_saved_is_refused_in_a_sentence(result: Result, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"a\.stl: has an unknown ending; end the name in \.3dm, \.json"):
        result.save(tmp_path / "a.stl")
    with pytest.raises(InputError, match="folder"):
        result.save(tmp_path / "missing" / "a.json")
    assert list(tmp_path.iterdir()) == []


RECIPE = """
[[forces]]
kind = "springs"
lines = "*"
divide = 4

[[anchors]]
points = "ends:*"
"""


def test_files_open_as_scenes(result: Result, tmp_path: Path) -> None:
    """By a recipe as a file, as its text or as its tables; without one as drawn."""
    from hookean.files.rhino import threedm
    from hookean.files.rhino.threedm import Additions, NewObject
    from hookean.scene.text import parse_tables

    model = tmp_path / "rope.3dm"
    rope = NewObject(np.array([[0.0, 0, 0], [4, 0, 0]]), "rope")
    threedm.write_new(model, Additions((), [rope]), unit="Meters", own=False)
    (tmp_path / "rope.toml").write_text(RECIPE)
    scenes = [hookean.open(model, recipe) for recipe in (tmp_path / "rope.toml", RECIPE, parse_tables(RECIPE))]
    assert scenes[0] == scenes[1] == scenes[2]
    assert relax(scenes[0]).force("springs")["length"].tolist() == [1.0] * 4
    with pytest.raises(InputError, match="no such file"):
        hookean.open(tmp_path / "missing.3dm")
    with pytest.raises(InputError, match=r"missing\.toml: no such file"):
        hookean.open(model, tmp_path / "missing.toml")
    (tmp_path / "odd.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match=r"odd\.toml: is not UTF-8 text"):
        hookean.open(model, tmp_path / "odd.toml")


def test_a_scene_of_which_nothing_is_drawn_is_saved_and_opens_again(tmp_path: Path) -> None:
    """A particle alone has no line, mesh or reaction: the file holds the scene alone."""
    scene = Scene(particles=[[1, 2, 3]])
    relax(scene).save(tmp_path / "one.3dm")
    assert hookean.open(tmp_path / "one.3dm") == scene
