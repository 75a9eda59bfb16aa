"""New .3dm files, and additions that cannot be written."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm as _rhino3dm

from hookean.errors import InputError
from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, Points, read, write, write_new
from hookean.values.mesh import Mesh

rhino: Any = _rhino3dm


@pytest.mark.parametrize("version", [5, 6, 7, 8])
def test_a_new_file_is_the_same_bytes_each_time(version: int, tmp_path: Path, additions: Additions) -> None:
    paths = [tmp_path / f"new{k}.3dm" for k in range(2)]
    for path in paths:
        result = write_new(path, additions, unit="Feet", tolerance=0.02, version=version, text={"by": "Ada"})
    assert paths[0].read_bytes() == paths[1].read_bytes()
    model = read(paths[0])
    assert (model.version, model.unit, model.metres, model.tolerance) == (version * 10, "Feet", 0.3048, 0.02)
    assert model.text == {"by": "Ada"}
    assert tuple(item.id for item in model.objects) == result.ids
    assert model.layers[0].path == "hookean" and model.foreign() == ()


def test_a_new_file_as_drawn_has_no_mark(tmp_path: Path, additions: Additions) -> None:
    path = tmp_path / "drawn.3dm"
    lines = Additions(objects=(NewObject([[0, 0, 0], [1, 0, 0]], "cables"),))
    write_new(path, lines, own=False)
    model = read(path)
    assert [(item.layer, item.own, item.marked) for item in model.foreign()] == [("cables", False, False)]
    write(path, tmp_path / "out.3dm", additions)
    assert len(read(tmp_path / "out.3dm").foreign()) == 1


def test_equal_objects_get_ids_of_their_own(tmp_path: Path) -> None:
    line = NewObject([[0, 0, 0], [1, 0, 0]], "a")
    result = write_new(tmp_path / "a.3dm", Additions(objects=(line, line, replace(line, layer="b"))))
    assert len(set(result.ids)) == 3
    again = write_new(tmp_path / "b.3dm", Additions(objects=(line,)))
    assert again.ids == result.ids[:1]


@pytest.mark.parametrize(
    ("options", "pointer"),
    [({"unit": "Cubits"}, "unit"), ({"version": 4}, "version"), ({"tolerance": 0.0}, "tolerance")],
)
def test_bad_options_are_named(options: dict[str, Any], pointer: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        write_new(tmp_path / "new.3dm", Additions(), **options)
    assert caught.value.pointer == pointer


SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])


@pytest.mark.parametrize(
    ("item", "where", "words"),
    [
        (NewObject([[0, 0, np.nan], [1, 0, 0]]), "/geometry", "not finite"),
        (NewObject([[0, 0], [1, 0]]), "/geometry", "last axis"),
        (NewObject([[0, 0, 0]]), "/geometry", "shape"),
        (NewObject("line"), "/geometry", "type str"),
        (NewObject(Points(np.zeros((0, 3)))), "/geometry", "at least 1"),
        (NewObject(Mesh(SQUARE, np.array([[0, 1, 9, 9]]))), "/geometry", "outside 0..3"),
        (NewObject(Mesh(SQUARE, np.array([[0, 1, 1, 1]]))), "/geometry", "only faces of zero area"),
        (NewObject(Mesh(SQUARE, np.array([[0, 1, 2, 3]])), colours=[[1, 2, 3]]), "/geometry", "colours of shape"),
        (NewObject(Mesh(SQUARE, np.array([[0, 1, 2, 3]])), colours=[[1, 2, 300]] * 4), "/geometry", "outside 0-255"),
        (NewObject(SQUARE, colours=[[1, 2, 3]] * 4), "/geometry", "only meshes and Points support them"),
        (NewObject(rhino.Mesh()), "/geometry", "not valid|not finite"),
        (NewObject(rhino.LineCurve(rhino.Point3d(np.nan, 0, 0), rhino.Point3d(1, 0, 0))), "/geometry", "not finite"),
        (NewObject(SQUARE, layer="a:: b"), "/layer", "spaces around"),
        (NewObject(SQUARE, colour=(1, 2, 256, 0)), "/colour", "0-255"),
        (NewObject(SQUARE, user_text={"key": ""}), "/user_text/key", "empty"),
        (NewObject(SQUARE, user_text={"key": "a\0b"}), "/user_text/key", "null"),
        (NewObject(SQUARE, name="\ud800"), "/name", "surrogate"),
        (NewObject(SQUARE, user_text={"key": 5}), "/user_text/key", "int"),  # type: ignore[dict-item]
    ],
)
def test_bad_objects_are_named(item: NewObject, where: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=words) as caught:
        write_new(tmp_path / "new.3dm", Additions(objects=(NewObject(SQUARE), item)))
    assert caught.value.pointer == f"/objects/1{where}"
    assert list(tmp_path.iterdir()) == []


def test_bad_layers_are_named(tmp_path: Path) -> None:
    for layer, pointer in ((NewLayer("a::b"), "/layers/0/name"), (NewLayer(""), "/layers/0")):
        with pytest.raises(InputError) as caught:
            write_new(tmp_path / "new.3dm", Additions(layers=(layer,)))
        assert caught.value.pointer == pointer


def test_what_has_no_extent_is_told(tmp_path: Path) -> None:
    path = tmp_path / "new.3dm"
    collapsed = Mesh(np.array([*SQUARE, SQUARE[0]]), np.array([[0, 1, 2, 3], [0, 4, 1, 1]]))
    given = ([[1, 1, 1], [1, 1, 1]], [[0, 0, 0], [0, 0, 0], [1, 0, 0]], collapsed)
    result = write_new(path, Additions(objects=tuple(NewObject(item) for item in given)))
    assert [line.split(":")[0] for line in result.warnings] == ["/objects/0", "/objects/1", "/objects/2"]
    point, line, mesh = (item.geometry for item in read(path).objects)
    assert isinstance(point, rhino.Point) and line.PointCount == 2 and mesh.Faces.Count == 1
