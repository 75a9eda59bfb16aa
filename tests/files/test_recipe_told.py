"""What a person is told who brings an own file to a recipe: its size, its layers, what to write instead."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hookean.errors import InputError
from hookean.files.recipe.recipe import understand
from hookean.files.relax_file import relax_file
from hookean.files.rhino import threedm
from hookean.files.rhino.threedm import Additions, NewLayer, NewObject
from hookean.scene.text import parse_tables
from hookean.values.mesh import Mesh

LINE = np.array([[0.0, 0, 0], [10, 0, 0]])
SQUARE = Mesh(np.array([[2.0 * i, 4.0 * j, 0.5 * i * j] for i in range(2) for j in range(2)]), np.array([[0, 2, 3, 1]]))


@pytest.fixture
def draw(tmp_path: Path) -> Callable[..., Path]:
    """Writes objects to a file as a person would draw them."""

    def build(*objects: NewObject, unit: str = "Meters", layers: Sequence[NewLayer] = ()) -> Path:
        path = tmp_path / "drawn.3dm"
        threedm.write_new(path, Additions(layers, objects), unit=unit, own=False)
        return path

    return build


def refused(path: Path, recipe: str | dict[str, Any]) -> str:
    with pytest.raises(InputError) as caught:
        understand(threedm.read(path), parse_tables(recipe, "r.toml") if isinstance(recipe, str) else recipe)
    return str(caught.value)


def test_springs_stretched_absurdly_tell_the_size_and_the_units(draw: Callable[..., Path]):
    """A model of mm with loads made for metres: 20 N on a spring of 2 mm and 1000 N/m, whose elongation is 20 mm."""
    path = draw(NewObject(LINE / 5, "net"), unit="Millimeters")
    recipe = """
    units = {length = "m"}
    forces = [
      {kind = "springs", name = "net", lines = "*", stiffness = 1000},
      {kind = "unary", points = "vertices:*", vector = [20, 0, 0]},
    ]
    anchors = [{points = "start:*"}]
    """
    (note,) = relax_file(path, None, recipe).warnings
    assert note == (
        'springs of "net" stretch to 11 times their rest length: the model measures 2 x 0 x 0 mm, and its numbers '
        "are in m and N; adjust stiffness and loads to the size"
    )
    assert relax_file(path, None, recipe.replace("[20, 0, 0]", "[17, 0, 0]")).warnings == []


def test_explain_tells_size_units_and_names(draw: Callable[..., Path]):
    path = draw(NewObject(SQUARE, "net", "sail"), unit="Millimeters")
    recipe = parse_tables('[[forces]]\nkind = "springs"\nmesh = "layer:net"', "r")
    lines = understand(threedm.read(path), recipe).lines
    assert "size: 2 x 4 x 0.5 mm; stiffness and loads must suit it" in lines
    assert "no units in the recipe: its lengths are mm, its forces N, stiffness N/mm" in lines
    assert 'layer net: 1 Mesh "sail" -> springs' in lines and "nothing is held" in lines
    lines = understand(threedm.read(path), {**recipe, "units": {"length": "m"}}).lines
    assert "size: 2 x 4 x 0.5 mm, 1 mm read as 0.001 m; stiffness and loads must suit it" in lines
    assert not [line for line in lines if "no units" in line]


def test_a_load_on_held_particles_alone_is_noted(draw: Callable[..., Path]):
    recipe = """
    forces = [
      {kind = "springs", lines = "*"},
      {kind = "unary", name = "snow", points = "ends:*", vector = [0, 0, -1]},
    ]
    anchors = [{points = "ends:*"}]
    """
    path = draw(NewObject(LINE, "cable"))
    assert relax_file(path, None, recipe).warnings == ['load "snow" acts on held particles only, so it has no effect']
    assert relax_file(path, None, recipe.replace('anchors = [{points = "ends:*"}]',
                                                 'anchors = [{points = "start:*"}]')).warnings == []  # fmt: skip


@pytest.mark.parametrize(
    ("layers", "selector", "said"),
    [
        (["", ""], "layer:membrane", 'its objects have no layer: select them with "*", name:NAME or id:UUID'),
        (["", ""], "ends:layer:membrane", 'select them with "ends:*", ends:name:NAME or ends:id:UUID'),
        (["Default"], "layer:membrane", 'its only layer with visible objects is "Default": write "layer:Default", or'),
        (["Default"], "ends:layer:x", 'write "ends:layer:Default", or "ends:*"'),
        (["roof", "walls"], "layer:roofs", '"roof", "walls"; did you mean layer:roof?'),
        (["roof::cables", "walls"], "ends:layer:cable", "; did you mean ends:layer:cables?"),
        (["roof", "walls"], "layer:xyz", '"roof", "walls"'),
        (["roof"], "name:ti", "did you mean name:tie?"),
    ],
)
def test_layers_that_are_not_there_are_told_with_what_to_write(
    draw: Callable[..., Path], layers: list[str], selector: str, said: str
):
    path = draw(*(NewObject(LINE + [0, i, 0], layer or "none", "tie") for i, layer in enumerate(layers)))
    if "" in layers:
        path = unlayered(path)
    place = "anchors = [{points" if ":layer" in selector else 'forces = [{kind = "springs", lines'
    assert said in refused(path, f'{place} = "{selector}"}}]')


def unlayered(path: Path) -> Path:
    """The same lines in a file that has no layers at all."""
    import rhino3dm

    model = rhino3dm.File3dm()
    for item in rhino3dm.File3dm.Read(str(path)).Objects:
        model.Objects.AddCurve(item.Geometry)
    assert model.Write(str(path), 7)
    return path


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("rest_factor = 0,5", ": rest_factor = 0,5; write decimals with a point: 0.5"),
        ("rest_factor = 0,5 # soft", "write decimals with a point: 0.5"),
        ("stiffness 1000", "line 4"),
        ("stiffness 1000", ": stiffness 1000"),
        (
            'rest_factor = "0.5"',
            '/forces/0/rest_factor: the text "0.5" given; write the number without quotes: rest_factor = 0.5',
        ),
        ('rest_factor = "0,5"', "write the number without quotes: rest_factor = 0.5"),
        ('surface = "layer:nowhere"', '/forces/0/surface: springs has no field "surface"; did you mean mesh?'),
        ("stifness = 3", 'springs has no field "stifness"; did you mean stiffness?'),
        ("colour = 3", 'springs has no field "colour"; its fields: '),
    ],
)
def test_values_and_names_that_mean_something_else(draw: Callable[..., Path], line: str, said: str):
    """Told with the line or the field, before the selectors, which may be wrong as well."""
    path = draw(NewObject(SQUARE, "net"))
    assert said in refused(path, f'[[forces]]\nkind = "springs"\nmesh = "layer:none"\n{line}\n')


@pytest.mark.parametrize(
    ("recipe", "said"),
    [
        ('[[forces]]\nkind = "load"', 'unknown kind "load"; did you mean unary (a load on each of its points)'),
        ('[[forces]]\nkind = "Gravity"', "or self_weight?"),
        ('[[forces]]\nkind = "unary"\npoints = "*"\nvector = -0.002', "such as vector = [0, 0, -0.002]"),
        ('[forces]\nkind = "springs"', "/forces: give tables, in TOML each under [[forces]]"),
        (
            '[[anchors]]\npoints = "ends:*"',
            "the file has 1 Brep; allowed are curves; for points of meshes and surfaces",
        ),
        (
            '[[anchors]]\npoints = "ends:layer:skin"',
            "finds 1 Brep; allowed are curves; for points of meshes and surfaces",
        ),
        ('[[forces]]\nkind = "springs"\nlines = "*"', "for the edges of a mesh or surface give mesh = instead of"),
        ('[[anchors]]\npoints = "corners:*"\ndivide = [8, 8]', "closed meshes have none"),
        ('[[anchors]]\npoints = "naked:layer:skin"\ndivide = [8, 8]', "closed meshes have none"),
        ('[settings]\ntolerance = "1e-6"', "/settings/tolerance: the text"),
    ],
)
def test_tables_that_mean_something_else(draw: Callable[..., Path], recipe: str, said: str):
    """On a closed Brep, a sphere."""
    import rhino3dm

    ball = rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 2.0).ToBrep()
    assert said in refused(draw(NewObject(ball, "skin")), recipe)


def test_a_text_that_is_no_recipe_is_told_by_its_name():
    with pytest.raises(InputError, match=r"README\.md: is not TOML or JSON; give a file that ends in \.toml or \.json"):
        parse_tables("# hookean\n\nform finding", "README.md")
