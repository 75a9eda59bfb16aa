"""Geometry that a definition refers to in Rhino comes from a .3dm file: by its id, else by a layer or a name."""

from __future__ import annotations

from pathlib import Path
from uuid import UUID, uuid5

import pytest
import rhino3dm
from typer.testing import CliRunner

from hookean.errors import InputError
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.command import app
from hookean_canvas.definitions.write import Definition
from hookean_canvas.run import checking

ABSENT = UUID("0d6b1f4e-7d5c-4f0e-9d43-3f1c5c1b2a10")


def rails(folder: Path) -> tuple[Path, list[UUID]]:
    """A file with a line of 3 m on the layer net::rails, one of 5 m named mast, and a point; ids in this order."""
    file = rhino3dm.File3dm()
    file.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
    file.Layers.AddLayer("net", (0, 0, 0, 255))
    below = rhino3dm.Layer()
    below.Name = "rails"
    below.ParentLayerId = file.Layers[0].Id
    file.Layers.Add(below)
    ids = []
    for length, layer, name in ((3.0, 1, ""), (5.0, 0, "mast")):
        attributes = rhino3dm.ObjectAttributes()
        attributes.LayerIndex, attributes.Name = layer, name
        line = rhino3dm.LineCurve(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(length, 0, 0))
        ids.append(file.Objects.AddCurve(line, attributes))
    ids.append(file.Objects.AddPoint(rhino3dm.Point3d(1, 2, 3)))
    target = folder / "form.3dm"
    file.Write(str(target), 7)
    return target, [UUID(str(one)) for one in ids]


def refer(chunk: Chunk, *references: UUID) -> None:
    """References to objects of a Rhino file in a parameter, as Grasshopper stores them."""
    data = chunk.add("PersistentData").put("Count", Type.INT32, 1)
    branch = data.add("Branch", 0).put("Count", Type.INT32, len(references)).put("Path", Type.STRING, "{0}")
    for i, reference in enumerate(references):
        branch.add("Item", i).put("RefID", Type.GUID, reference)


def lengths(folder: Path, nickname: str, *references: UUID, kind: str = "Curve") -> Path:
    """A definition that shows the lengths of the curves of a parameter, or its points."""
    d = Definition(f"rails {nickname}", "Rails", "Curves of a Rhino file.")
    held = d.parameter(kind, nickname)
    if references:
        refer(held.container, *references)
    d.panel("found", d.native("Length", curve=held) if kind == "Curve" else held)
    target = folder / "rails.ghx"
    d.save(target)
    return target


def shown(definition: Path, file: Path) -> list[object]:
    found = checking.check(definition, rhino=file)
    assert found.faults == []
    return found.outcome.panels["found"].values_in_order()


def test_objects_are_found_by_their_ids_in_the_order_of_the_references(tmp_path: Path) -> None:
    file, ids = rails(tmp_path)
    assert shown(lengths(tmp_path, "Crv", ids[1], ids[0]), file) == [5.0, 3.0]
    (place,) = shown(lengths(tmp_path, "Pt", ids[2], kind="Point"), file)
    assert (place.X, place.Y, place.Z) == (1.0, 2.0, 3.0)  # type: ignore[attr-defined]


@pytest.mark.parametrize(("nickname", "length"), [("rails", 3.0), ("NET::Rails", 3.0), ("mast", 5.0)])
def test_unknown_ids_and_empty_parameters_get_what_is_on_the_layer_or_has_the_name(
    nickname: str, length: float, tmp_path: Path
) -> None:
    file, ids = rails(tmp_path)
    assert shown(lengths(tmp_path, nickname, ABSENT, uuid5(ABSENT, "other")), file) == [length]
    assert shown(lengths(tmp_path, nickname), file) == [length]
    assert shown(lengths(tmp_path, nickname, ids[0], ABSENT), file) == [3.0, length]


def test_what_the_file_lacks_is_one_sentence_with_the_id_and_the_name(tmp_path: Path) -> None:
    file, ids = rails(tmp_path)
    definition = lengths(tmp_path, "Edge", ids[0], ABSENT)
    with pytest.raises(InputError) as caught:
        checking.check(definition, rhino=file)
    assert str(caught.value).count("\n") == 0
    assert f"form.3dm has no object {ABSENT} and nothing on a layer or with a name Edge" in str(caught.value)
    with pytest.raises(InputError, match=r"give the file with --rhino form\.3dm, or internalise it in Grasshopper"):
        checking.check(definition)


def test_the_command_takes_the_file_and_refuses_one_that_is_no_rhino_file(tmp_path: Path) -> None:
    file, ids = rails(tmp_path)
    definition = lengths(tmp_path, "Crv", ids[0])
    done = CliRunner().invoke(app, ["run", str(definition), "--rhino", str(file)])
    assert done.exit_code == 0 and "found: 3" in done.output
    file.write_bytes(b"not a Rhino file")
    done = CliRunner().invoke(app, ["run", str(definition), "--rhino", str(file)])
    assert done.exit_code == 2 and len(done.output.strip().splitlines()) == 1
