"""Bundles: what a component's folder has to hold, and what the shipped ones have in common."""

from __future__ import annotations

import ast
import json
import re
import sys
from pathlib import Path

import pytest

from hookean.errors import InputError
from hookean_canvas.archive import guids
from hookean_canvas.components import bundles, icons

SHIPPED = bundles.names()
every_bundle = pytest.mark.parametrize("name", SHIPPED)

PARAMETER = {"name": "_points", "nickname": "_points", "description": "Points [length].", "typeHintID": "point"}
METADATA = {
    "name": "Widget",
    "nickname": "Widget",
    "category": "Hookean",
    "subcategory": "Mesh",
    "ghpython": {"inputParameters": [PARAMETER], "outputParameters": [{"name": "found"}]},
}


def bundle(to: Path, code: str = '"""Help."""\nfound = _points\n', **changes: object) -> Path:
    """A folder with a bundle, changed in some keys of its metadata; None takes one away."""
    place = to / "Widget"
    place.mkdir()
    content = {key: value for key, value in {**METADATA, **changes}.items() if value is not None}
    (place / "metadata.json").write_text(json.dumps(content), encoding="utf-8")
    (place / "code.py").write_text(code, encoding="utf-8")
    (place / "icon.png").write_bytes(icons.png("Widget"))
    return place


def test_a_bundle_reads_as_it_is_written(tmp_path):
    """Names, inputs with access and hint, outputs, and an id made from the folder's name where none is given."""
    wanted = {**PARAMETER, "scriptParamAccess": "tree", "optional": False, "graft": True}
    place = bundle(tmp_path, ghpython={"inputParameters": [wanted], "outputParameters": [{"name": "found"}]})
    found = bundles.read(place)
    assert (found.folder, found.name, found.subcategory, found.exposure) == ("Widget", "Widget", "Mesh", 2)
    assert found.inputs == (bundles.Parameter("_points", "Points [length].", "point", 2, False, mapping=2),)
    assert [p.name for p in found.outputs] == ["found"]
    assert found.guid == bundles.identity("Widget") != bundles.identity("Gadget")
    assert not found.rhino8_only


@pytest.mark.parametrize("line", ["# r: compas>=2.4", "#r: compas, numpy", "# requirements: compas"])
def test_packages_asked_for_make_it_a_component_of_rhino_8(tmp_path, line):
    """Only Rhino 8 and newer install packages by a comment."""
    assert bundles.read(bundle(tmp_path, f'{line}\n"""Help."""\nfound = _points\n')).rhino8_only


def ghpython(**changes: object) -> dict[str, object]:
    return {"ghpython": {"inputParameters": [{**PARAMETER, **changes}]}}


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"name": None}, "lacks name"),
        ({"subcategory": "Meshes"}, "subcategory 'Meshes' is not one of Engine, Forces, Geometry, Mesh, COMPAS"),
        ({"exposure": 3}, "exposure 3 is not one of"),
        ({"colour": "red"}, "has unknown keys colour"),
        ({"ghpython": {"isAdvancedMode": True}}, "components are plain scripts"),
        (ghpython(typeHintID="points"), "typeHintID 'points' is not one of none, ghdoc, float"),
        (ghpython(scriptParamAccess="branch"), "scriptParamAccess 'branch' is not one of item, list, tree"),
        (ghpython(nickname="2nd"), "'2nd' is not a variable name"),
        (ghpython(nickname="class"), "'class' is not a variable name"),
        (ghpython(flatten=True, graft=True), "flatten and graft are both true"),
        ({"ghpython": {"inputParameters": [PARAMETER], "outputParameters": [PARAMETER]}}, "_points given twice"),
    ],
)
def test_wrong_metadata_is_told_in_a_sentence(tmp_path, changes, said):
    """Which file, what is wrong, what is allowed."""
    with pytest.raises(InputError, match=re.escape(said)) as caught:
        bundles.read(bundle(tmp_path, **changes))
    assert caught.value.pointer.startswith("Widget/metadata.json")


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ('"""Help."""\nfound = (\n', "code.py:2: does not compile"),
        ("found = 1\n", "has no docstring"),
        ('"""Help."""\nangle = "φ"\n', "code.py:2: is not ASCII"),
    ],
)
def test_wrong_code_is_told_in_a_sentence(tmp_path, code, said):
    """Code that no Python of Rhino would run, or that has no help."""
    with pytest.raises(InputError, match=re.escape(said)):
        bundles.read(bundle(tmp_path, code))


@pytest.mark.parametrize("name", bundles.FILES)
def test_a_folder_with_a_file_missing_is_no_bundle(tmp_path, name):
    """Each of the three files is asked for by name."""
    place = bundle(tmp_path)
    (place / name).unlink()
    with pytest.raises(InputError, match=f"{name} missing"):
        bundles.read(place)


def test_an_icon_has_24_by_24_pixels(tmp_path):
    """Grasshopper scales no icons; another size, or another file, is refused."""
    place = bundle(tmp_path)
    icon = bytearray((place / "icon.png").read_bytes())
    icon[19] = 32
    (place / "icon.png").write_bytes(icon)
    with pytest.raises(InputError, match="24 x 24"):
        bundles.read(place)


def test_metadata_that_is_no_json_is_told(tmp_path):
    """Where the text breaks off is part of the sentence."""
    place = bundle(tmp_path)
    (place / "metadata.json").write_text("{")
    with pytest.raises(InputError, match=r"Widget/metadata.json: is not valid JSON.*line 1"):
        bundles.read(place)


def test_two_components_with_one_id_are_refused(tmp_path):
    """A copied bundle keeps the id it was copied from; that is seen."""
    (tmp_path / "a").mkdir()
    place = bundle(tmp_path / "a", instanceGuid="e47b9e32-4b3e-4d9c-9f4c-c8ac81f0fca1")
    other = place.with_name("Gadget")
    other.mkdir()
    for name in bundles.FILES:
        (other / name).write_bytes((place / name).read_bytes())
    with pytest.raises(InputError, match="same guid as Gadget"):
        bundles.read_all(place.parent)


def test_shipped_bundles_are_whole_and_told_apart():
    """All are read, with ids and names of their own, on the panels of one tab."""
    found = bundles.read_all()
    assert [b.folder for b in found] == SHIPPED
    assert {b.category for b in found} == {"Hookean"}
    assert {"Engine", "Springs", "Unary"} <= {b.folder for b in found}


@every_bundle
def test_inputs_say_by_their_names_what_is_required(name):
    """`_required`, `_with_default_` (the tooltip says which), `optional_`; every tooltip has words."""
    found = bundles.read(name)
    for parameter in found.inputs:
        assert re.fullmatch(r"_[a-z][a-z0-9_]*|[a-z][a-z0-9_]*_", parameter.name), parameter.name
        assert parameter.description.strip(), parameter.name
        assert parameter.hint in guids.HINTS
        if parameter.name.startswith("_") and parameter.name.endswith("_"):
            assert "default" in parameter.description.lower(), parameter.name
    for parameter in found.outputs:
        assert re.fullmatch(r"[a-z][a-z0-9_]*[a-z0-9]", parameter.name), parameter.name
        assert parameter.description.strip(), parameter.name
    assert found.description.strip()


@every_bundle
def test_the_script_reads_every_input_and_sets_every_output(name):
    """An input nobody reads, or an output nobody sets, is a mistake between the two files."""
    found = bundles.read(name)
    tree = ast.parse(found.code)
    read = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
    made = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    assert {p.name for p in found.inputs} <= read
    assert {p.name for p in found.outputs} <= made
    assert not {n for n in read if n.startswith("_") and n not in made and not n.startswith("__")} - {
        p.name for p in found.inputs
    }


@every_bundle
def test_the_script_imports_only_what_is_there_inside_rhino(name):
    """The client, the standard library, Rhino's own; COMPAS where the script asks for it."""
    found = bundles.read(name)
    allowed = {"hookean_client", "Rhino", "Grasshopper", "System", "scriptcontext", "rhinoscriptsyntax", "ghpythonlib"}
    allowed |= {"compas", "compas_rhino", "compas_ghpython"} if found.rhino8_only else set()
    for node in ast.walk(ast.parse(found.code)):
        names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
        names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        for top in (n.split(".")[0] for n in names):
            assert top in allowed or top in sys.stdlib_module_names, top
