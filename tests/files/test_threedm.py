"""Models read from .3dm files, and results written into copies of them."""

from __future__ import annotations

import itertools
import os
import zlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np
import pytest
import rhino3dm as _rhino3dm

from hookean.errors import InputError
from hookean.files.rhino.archive import scan
from hookean.files.rhino.splice import splice
from hookean.files.rhino.threedm import Additions, Model, expand, read, write

rhino: Any = _rhino3dm
Make = Callable[..., Path]


def records(path: Path) -> list[bytes]:
    data = path.read_bytes()
    return [data[record.start : record.end] for record in scan(data).objects]


def same_head(before: Model, after: Model) -> bool:
    fields = ("version", "unit", "metres", "tolerance", "lights", "lost", "text")
    return all(getattr(before, name) == getattr(after, name) for name in fields)


def look(model: Model) -> list[Any]:
    return [(o.id, o.name, o.layer, dict(o.user_text), o.visible, o.locked, o.colour) for o in model.foreign()]


# reading


def test_real_files_are_delivered_whole(real: Path) -> None:
    model, file = read(real), rhino.File3dm.Read(str(real))
    assert [item.id for item in model.objects] == [item.Attributes.Id for item in file.Objects]
    assert [layer.path for layer in model.layers] == [layer.FullPath for layer in file.Layers]
    assert model.lost == () and model.warnings == ()
    assert model.metres == {"Millimeters": 1e-3, "Inches": 0.0254, "Meters": 1.0}[model.unit]
    assert model.foreign() == model.objects


def test_a_model_in_full(make: Make) -> None:
    model = read(make(8))
    assert (model.version, model.unit, model.metres, model.tolerance) == (80, "Centimeters", 0.01, 0.005)
    assert model.text == {"author": "Ada"}
    assert [layer.path for layer in model.layers] == ["Frame", "Frame::cables", "Hidden"]
    assert model.layers[1].parent == model.layers[0].id and model.layers[0].parent is None
    line, point, instance = model.objects
    assert (line.name, line.layer, line.kind, line.index) == ("Seil ü", "Frame::cables", "LineCurve", 0)
    assert line.user_text == {"EA": "1200 kN", "on geometry": "yes"}
    assert line.colour == model.layers[1].colour == (10, 20, 30, 255)
    assert line.visible and not point.visible and point.layer == "Hidden"
    assert instance.is_instance and not line.is_instance
    assert [len(block.members) for block in model.blocks] == [1]
    assert model.layer("frame::CABLES") is model.layers[1] and model.layer("none") is None


def test_modes_colours_and_lights(tmp_path: Path) -> None:
    file = rhino.File3dm()
    for name in ("A", "B"):
        layer = rhino.Layer()
        layer.Name, layer.Locked = name, name == "B"
        file.Layers.Add(layer)
    wanted = ((0, "Normal"), (0, "Hidden"), (0, "Locked"), (1, "Normal"))
    for number, mode in wanted:
        attributes = rhino.ObjectAttributes()
        attributes.LayerIndex, attributes.Mode = number, getattr(rhino.ObjectMode, mode)
        attributes.ColorSource = rhino.ObjectColorSource.ColorFromObject
        attributes.ObjectColor = (1, 2, 3, 255)
        attributes.ActiveSpace = rhino.ActiveSpace.PageSpace if number else rhino.ActiveSpace.ModelSpace
        file.Objects.AddPoint(rhino.Point3d(0, 0, 0), attributes)
    path = tmp_path / "modes.3dm"
    assert file.Write(str(path), 7)
    model = read(path)
    assert [(o.visible, o.locked) for o in model.objects] == [
        (True, False),
        (False, False),
        (True, True),
        (True, True),
    ]
    assert {o.colour for o in model.objects} == {(1, 2, 3, 255)}
    assert [o.page for o in model.objects] == [False, False, False, True]


def test_blocks_expand_where_they_stand(make: Make) -> None:
    model = read(make(8))
    *rest, placed = expand(model)
    assert [item.id for item in rest] == [item.id for item in model.objects[:2]]
    where = placed.geometry.Location
    # (1, 0, 0) turned by 90 degrees about z, then moved by 5 in x
    assert np.allclose([where.X, where.Y, where.Z], [5, 1, 0], atol=1e-12)
    assert placed.layer == "Frame::cables" and placed.index == 3
    assert expand(model)[-1].id == placed.id
    assert model.blocks[0].members[0].geometry.Location.X == 1
    assert expand(model, model.objects[:1]) == model.objects[:1]


def test_nested_blocks_expand_and_endless_ones_are_refused(make: Make) -> None:
    model = read(make(8))
    inner, instance = model.blocks[0], model.objects[2]
    outer = replace(inner, id=UUID(int=9), name="outer", members=(instance, inner.members[0]))
    reference = rhino.InstanceReference(outer.id, rhino.Transform.Translation(0, 0, 7))
    nested = replace(model, blocks=(inner, outer), objects=(replace(instance, geometry=reference),))
    first, second = (item.geometry.Location for item in expand(nested))
    assert np.allclose([first.X, first.Y, first.Z, second.X, second.Z], [5, 1, 7, 1, 7], atol=1e-12)
    looped = replace(nested, blocks=(inner, replace(outer, members=nested.objects)))
    with pytest.raises(InputError, match="contains itself"):
        expand(looped)
    with pytest.raises(InputError, match="no definition"):
        expand(replace(model, blocks=()))
    levels, below = [], instance
    for level in range(6):  # 10 in each of 6 levels: a million
        block = replace(inner, id=UUID(int=100 + level), members=(below,) * 10 if level else inner.members * 10)
        levels.append(block)
        here = rhino.InstanceReference(block.id, rhino.Transform.Identity())
        below = replace(instance, geometry=here)
    with pytest.raises(InputError, match="more than 100000"):
        expand(replace(model, blocks=tuple(levels), objects=(below,)))


def towers(model: Model, levels: int, wide: int, last: tuple[Any, ...]) -> Model:
    """A model of one instance of a block with `wide` instances of the next one, and so on; `last` is in the last."""
    inner, below = model.blocks[0], model.objects[2]
    blocks = []
    for level in range(levels):
        block = replace(inner, id=UUID(int=100 + level), members=(below,) * wide if level else last)
        blocks.append(block)
        below = replace(below, geometry=rhino.InstanceReference(block.id, rhino.Transform.Identity()))
    return replace(model, blocks=tuple(blocks), objects=(below,))


@pytest.mark.slow
@pytest.mark.parametrize(("levels", "wide"), [(1500, 1), (1500, 2), (2, 1500), (60, 1500)])
def test_nested_blocks_without_an_object_come_to_nothing(make: Make, levels: int, wide: int) -> None:
    """However deep and wide they are: up to 1500^59 instances, each block looked at once."""
    model = read(make(8))
    assert expand(towers(model, levels, wide, ())) == ()
    leaf = model.blocks[0].members[:1]
    if wide > 1 and levels > 2:
        with pytest.raises(InputError, match="more than 100000"):
            expand(towers(model, levels, wide, leaf))
    else:
        assert len(expand(towers(model, levels, wide, leaf))) == wide ** (levels - 1)


def test_endless_blocks_are_refused_at_any_depth(make: Make) -> None:
    model = towers(read(make(8)), 1500, 2, ())
    first = replace(model.blocks[0], members=model.objects)
    with pytest.raises(InputError, match="contains itself"):
        expand(replace(model, blocks=(first, *model.blocks[1:])))


def test_an_unknown_class_is_named_and_kept(
    make: Make, tmp_path: Path, unknown: Callable[..., Any], additions: Additions
) -> None:
    path, out = tmp_path / "unknown.3dm", tmp_path / "out.3dm"
    data, odd = unknown(make(8).read_bytes())
    path.write_bytes(data)
    model = read(path)
    assert [(group.class_id, group.count) for group in model.lost] == [(odd, 1)]
    assert model.lost[0].ids == (scan(data).objects[0].id,)
    assert str(odd) in model.warnings[0]
    assert [item.index for item in model.objects] == [1, 3]  # 2 is the block's member
    write(path, out, additions)
    assert records(out)[:4] == records(path)
    assert read(out).lost == model.lost
    assert len(read(out).objects) == 2 + 6


def test_an_old_file_with_an_unknown_class_is_not_written(
    make: Make, tmp_path: Path, unknown: Callable[..., Any], additions: Additions
) -> None:
    path = tmp_path / "unknown.3dm"
    path.write_bytes(unknown(make(4).read_bytes())[0])
    assert read(path).lost[0].count == 1
    with pytest.raises(InputError, match="1 objects that would be lost"):
        write(path, tmp_path / "out.3dm", additions)
    assert not (tmp_path / "out.3dm").exists()


def test_ids_given_twice_are_not_lost(tmp_path: Path) -> None:
    file = rhino.File3dm()
    for x in (1, 2):
        file.Objects.AddPoint(rhino.Point3d(x, 0, 0))
    path = tmp_path / "twice.3dm"
    assert file.Write(str(path), 8)
    data = path.read_bytes()
    first, second = (record.id for record in scan(data).objects)
    assert first is not None and second is not None
    at = data.index(second.bytes_le) - 1  # the attributes' version byte; their checksum is their last four bytes
    end = at + int.from_bytes(data[at - 8 : at], "little") - 4
    body = data[at:end].replace(second.bytes_le, first.bytes_le)
    path.write_bytes(data[:at] + body + zlib.crc32(body).to_bytes(4, "little") + data[end + 4 :])
    assert [record.id for record in scan(path.read_bytes()).objects] == [first, first]
    model = read(path)
    assert model.lost == () and [item.index for item in model.objects] == [0, 1]


def refused(path: Path, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        read(path)
    assert caught.value.pointer == path.name
    assert caught.value.sentence.endswith(".") and "\n" not in str(caught.value)


def test_what_is_no_model_is_named(tmp_path: Path, make: Make) -> None:
    folder, text, empty = tmp_path / "folder.3dm", tmp_path / "text.3dm", tmp_path / "empty.3dm"
    folder.mkdir()
    text.write_text("not a model")
    empty.write_bytes(b"")
    refused(folder, "is a folder")
    refused(text, "not a .3dm file")
    refused(empty, "empty")
    refused(tmp_path / "missing.3dm", "no such file")
    refused(tmp_path / "nul\0.3dm", "not a valid file path")
    with pytest.raises(InputError, match="older than the required 50"):
        read(make(4), oldest=50)


def test_a_file_of_a_later_rhino_is_not_written(make: Make, tmp_path: Path, additions: Additions) -> None:
    newer = tmp_path / "newer.3dm"
    newer.write_bytes(make(8).read_bytes().replace(b"      80", b"      90", 1))
    with pytest.raises(InputError, match="newer than Rhino 8"):
        write(newer, tmp_path / "out.3dm", additions)


def test_contents_that_cannot_be_decoded_are_refused(make: Make, tmp_path: Path) -> None:
    """Sound frames around damaged contents: rhino3dm gives nothing, a sentence is given."""
    path = tmp_path / "damaged.3dm"
    data = make(8).read_bytes()
    record = scan(data).objects[0]
    assert record.id is not None
    at = data.index(record.id.bytes_le)  # under a checksum that rhino3dm holds to
    path.write_bytes(data[:at] + bytes([data[at] ^ 255]) + data[at + 1 :])
    assert len(scan(path.read_bytes()).objects) == 4
    refused(path, "contents cannot be read")


def test_a_file_cut_anywhere_is_refused(real: Path, tmp_path: Path) -> None:
    data = real.read_bytes()
    cut = tmp_path / "cut.3dm"
    for end in sorted({len(data) * k // 60 for k in range(60)} | {len(data) - k for k in range(1, 30)}):
        cut.write_bytes(data[:end])
        refused(cut, "empty|damaged|not a .3dm file")


# writing


def test_real_files_keep_every_record(real: Path, tmp_path: Path, additions: Additions) -> None:
    out = tmp_path / "out.3dm"
    before = read(real)
    result = write(real, out, additions)
    after = read(out)
    assert same_head(before, after)
    assert look(after) == look(before)
    kept = after.layers[: len(before.layers)]
    if before.version < 4:  # such files hold no layer ids; every reading makes new ones
        kept = tuple(replace(layer, id=old.id) for layer, old in zip(kept, before.layers, strict=True))
    assert kept == before.layers
    own = [item for item in after.objects if item.own]
    assert tuple(item.id for item in own) == result.ids and len(own) == 6
    if before.version >= 50:
        assert records(out)[: len(before.objects)] == records(real)
        assert result.warnings == ()
    else:
        assert "rewritten as a whole" in result.warnings[0]


@pytest.mark.parametrize("version", [3, 4, 5, 6, 7, 8])
def test_written_files_keep_every_record(version: int, make: Make, tmp_path: Path, additions: Additions) -> None:
    path, out = make(version), tmp_path / "out.3dm"
    before = read(path)
    result = write(path, out, additions)
    after = read(out)
    assert same_head(before, after)
    assert look(after) == look(before)
    assert [layer.path for layer in after.layers] == [
        "Frame",
        "Frame::cables",
        "Hidden",
        "hookean",
        "hookean::net",
        "hookean::net::warp",
        "hookean::other",
    ]
    assert len(after.objects) == len(before.objects) + 6
    assert len(after.blocks) == len(before.blocks)
    assert any("rewritten as a whole" in line for line in result.warnings) == (version < 5)
    assert any("cannot store user text" in line for line in result.warnings) == (version < 4)
    if version >= 5:
        assert records(out)[:4] == records(path)


def test_version_2_takes_all_but_point_sets(make: Make, tmp_path: Path, additions: Additions) -> None:
    path, out = make(2), tmp_path / "out.3dm"
    with pytest.raises(InputError, match=r"/objects/4/geometry: .* cannot store point sets"):
        write(path, out, additions)
    few = Additions(additions.layers, additions.objects[:4])
    write(path, out, few)
    assert len(read(out).objects) == len(read(path).objects) + 4
    assert read(out).version == 2


def test_what_was_added_reads_back(make: Make, tmp_path: Path, additions: Additions) -> None:
    out = tmp_path / "out.3dm"
    write(make(7), out, additions)
    model = read(out)
    found = {item.name: item for item in model.objects if item.own}
    assert found["point"].user_text["reaction"] == "12 kN"
    assert found["point"].colour == (200, 0, 0, 255) and found["line"].colour == (1, 2, 3, 255)
    assert found["line"].geometry.PointAtEnd.Y == 1 / 3
    mesh = found["mesh"].geometry
    assert mesh.Vertices.Point3dAt(1).X == 1 / 3  # to the last bit, not float32
    assert [mesh.Faces[k] for k in range(2)] == [(0, 1, 2, 2), (0, 2, 3, 3)]
    assert mesh.VertexColors[3][:3] == (9, 8, 7)
    assert found["cloud"].geometry.Count == 3 and found["circle"].kind == "NurbsCurve"
    assert found["polyline"].layer == "hookean::other" and found["polyline"].marked


@pytest.mark.slow
@pytest.mark.parametrize("version", [3, 4, 5, 6, 7, 8])
def test_results_do_not_pile_up(version: int, make: Make, tmp_path: Path, additions: Additions) -> None:
    path = make(version)
    runs = [tmp_path / f"run{k}.3dm" for k in range(4)]
    first = write(path, runs[0], additions)
    for before, after in itertools.pairwise(runs):
        again = write(before, after, additions)
        assert again.dropped == 6 and again.ids == first.ids
    assert runs[2].stat().st_size == runs[3].stat().st_size
    assert look(read(runs[3])) == look(read(path))
    assert len(read(runs[3]).layers) == len(read(runs[0]).layers)
    if version >= 5:
        assert runs[3].read_bytes() == runs[0].read_bytes()
        write(runs[0], runs[1], Additions())
        assert runs[1].read_bytes() == path.read_bytes()  # all of it gone, the source as it was


def test_drawn_objects_on_our_layers_are_kept(make: Make, tmp_path: Path, additions: Additions) -> None:
    first, drawn, out = (tmp_path / f"{name}.3dm" for name in ("first", "drawn", "out"))
    write(make(7), first, additions)
    file = rhino.File3dm.Read(str(first))
    attributes = rhino.ObjectAttributes()
    attributes.Name = "by hand"
    attributes.LayerIndex = next(layer.Index for layer in file.Layers if layer.FullPath == "hookean::net")
    file.Objects.AddPoint(rhino.Point3d(0, 0, 0), attributes)
    assert file.Write(str(drawn), 7)
    assert "1 objects below the layer hookean were not added" in read(drawn).warnings[0]
    result = write(drawn, out, Additions())
    model = read(out)
    assert result.dropped == 6
    assert [item.name for item in model.objects if item.own] == ["by hand"]
    assert [layer.path for layer in model.layers][-2:] == ["hookean", "hookean::net"]


def test_a_layer_in_the_middle_is_used_again(make: Make, tmp_path: Path, additions: Additions) -> None:
    first, later, out = (tmp_path / f"{name}.3dm" for name in ("first", "later", "out"))
    write(make(7), first, additions)
    file = rhino.File3dm.Read(str(first))
    layer = rhino.Layer()
    layer.Name = "Later"
    number = file.Layers.Add(layer)
    attributes = rhino.ObjectAttributes()
    attributes.LayerIndex, attributes.Name = number, "late"
    file.Objects.AddPoint(rhino.Point3d(0, 0, 0), attributes)
    assert file.Write(str(later), 7)
    write(later, out, additions)
    model = read(out)
    assert [one.path for one in model.layers] == [one.path for one in read(later).layers]
    assert {o.name: o.layer for o in model.objects}["late"] == "Later"
    assert {o.name: o.layer for o in model.objects}["line"] == "hookean::net::warp"


def test_members_of_blocks_stay(make: Make, tmp_path: Path) -> None:
    """A block a person made of our objects keeps its members, and their layer."""
    file = rhino.File3dm.Read(str(make(7)))
    layer = rhino.Layer()
    layer.Name = "hookean"
    number = file.Layers.Add(layer)
    attributes = rhino.ObjectAttributes()
    attributes.LayerIndex = number
    attributes.SetUserString("hookean", "1")
    point = (rhino.Point(rhino.Point3d(1, 1, 1)),)
    file.InstanceDefinitions.Add("ours", "", "", "", rhino.Point3d(0, 0, 0), point, (attributes,))
    path, out = tmp_path / "block.3dm", tmp_path / "out.3dm"
    assert file.Write(str(path), 7)
    assert write(path, out, Additions()).dropped == 0
    assert out.read_bytes() == path.read_bytes()


def test_the_source_is_never_the_target(make: Make, tmp_path: Path, additions: Additions) -> None:
    path = make(8)
    before = path.read_bytes()
    os.link(path, tmp_path / "hard.3dm")
    targets: list[str | Path] = [path, tmp_path / "x" / ".." / path.name, tmp_path / "hard.3dm", os.path.relpath(path)]
    (tmp_path / "x").mkdir()
    try:
        (tmp_path / "soft.3dm").symlink_to(path)
        targets.append(tmp_path / "soft.3dm")
    except OSError:
        pass  # Windows without the right to make links
    for target in targets:
        with pytest.raises(InputError, match="never overwritten"):
            write(path, target, additions)
    assert path.read_bytes() == before


def test_bad_targets_are_named(make: Make, tmp_path: Path, additions: Additions) -> None:
    path = make(8)
    with pytest.raises(InputError, match="is a folder"):
        write(path, tmp_path, additions)
    with pytest.raises(InputError, match="does not exist"):
        write(path, tmp_path / "none" / "out.3dm", additions)
    with pytest.raises(InputError, match="not a valid file path"):
        write(path, tmp_path / "a\0b.3dm", additions)


@pytest.mark.parametrize("step", ["replace", "fsync", "check"])
def test_a_failure_leaves_the_old_target(
    step: str, make: Make, tmp_path: Path, additions: Additions, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, folder = make(8), tmp_path / "out"
    folder.mkdir()
    target = folder / "result.3dm"
    target.write_bytes(b"the old result")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    if step == "check":
        monkeypatch.setattr("hookean.files.rhino.threedm._check_spliced", fail)
    else:
        monkeypatch.setattr(f"hookean.atomic_write.os.{step}", fail)
    with pytest.raises(InputError, match="No space left"):
        write(path, target, additions)
    assert target.read_bytes() == b"the old result"
    assert [item.name for item in folder.iterdir()] == ["result.3dm"]
    monkeypatch.undo()
    write(path, target, additions)
    assert len(read(target).objects) == 9
    assert [item.name for item in folder.iterdir()] == ["result.3dm"]


def test_a_copy_that_lacks_an_object_is_not_kept(
    make: Make, tmp_path: Path, additions: Additions, monkeypatch: pytest.MonkeyPatch
) -> None:
    def short(*args: Any, **options: Any) -> bytes:
        return splice(*args, **{**options, "drop_objects": (0,)})

    monkeypatch.setattr("hookean.files.rhino.threedm.splice", short)
    with pytest.raises(InputError, match="objects of the source differ"):
        write(make(8), tmp_path / "out.3dm", additions)
    assert not (tmp_path / "out.3dm").exists()
