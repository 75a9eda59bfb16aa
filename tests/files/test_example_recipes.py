"""Every recipe of the examples goes through the command's way: relaxed, tabled and written."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pytest

from hookean.commands.examples import home
from hookean.files.relax_file import relax_file
from hookean.files.rhino import threedm
from hookean.values.units import METRES, Units
from soak import sampled

LONG = ("sphere/recipe.toml",)  # its example runs it
RECIPES = [p for p in sorted(home().glob("*/recipe*.toml")) if f"{p.parent.name}/{p.name}" not in LONG]


@pytest.mark.slow
@pytest.mark.parametrize("recipe", sampled(RECIPES, 3), ids=lambda p: f"{p.parent.name}/{p.stem}")
def test_a_recipe_of_the_examples_gives_a_table_and_a_file(recipe: Path, tmp_path: Path):
    """Every element, reaction and contact with a floor has its row, every number of it a unit, and nothing is noted
    on strain."""
    found = relax_file(recipe.parent / "model.3dm", tmp_path / "out.3dm", recipe.read_text(encoding="utf-8"))
    assert found.result.converged
    table = list(csv.DictReader(io.StringIO(found.csv)))
    result = found.result
    held = len(result.reactions["particles"]) + len(result.contacts["particles"])
    assert len(table) == sum(len(force.get("particles", ())) for force in result.forces) + held
    assert all(
        "[" in head for head in table[0] if head not in ("id", "name", "layer", "force", "kind", "element", "particles")
    )
    assert len(threedm.read(tmp_path / "out.3dm").objects) > len(threedm.read(recipe.parent / "model.3dm").objects)
    assert not [note for note in found.warnings if "rest length" in note]


@pytest.mark.parametrize(
    ("dimension", "unit"),
    [("length^2", "mm^2"), ("force/length^2", "kN/mm^2"), ("length/time", "mm/s"), ("force length^2", "kN mm^2")],
)
def test_dimensions_made_of_others_have_a_unit_and_a_factor(dimension: str, unit: str):
    """A number in mm and kN becomes one in m and N by 1000 for kN and 1/1000 for each mm."""
    mine, other = Units(length="mm", force="kN"), Units()
    assert mine.of(dimension) == unit
    power = {"length^2": 2, "force/length^2": -2, "length/time": 1, "force length^2": 2}[dimension]
    force = 1e3 if "force" in dimension else 1.0
    assert mine.factor(dimension, other) == pytest.approx(force * METRES["mm"] ** power, rel=1e-12)


def test_every_output_of_every_force_has_a_unit():
    """No column of a table fails for want of a unit, and limits could be held to it."""
    from hookean.forces import KINDS

    for cls in KINDS.values():
        for dimension in cls.outputs.values():
            assert isinstance(Units().of(dimension), str)
            assert Units().factor(dimension, Units()) == 1.0
