"""Records put into a copy: the original's stay byte for byte."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rhino3dm as _rhino3dm

from hookean.errors import InputError
from hookean.files.rhino.archive import LAYER_TABLE, OBJECT_TABLE, scan
from hookean.files.rhino.build import Additions, carrier, plan
from hookean.files.rhino.read import parse
from hookean.files.rhino.splice import splice, without_history

rhino: Any = _rhino3dm


def records(data: bytes) -> list[bytes]:
    return [data[record.start : record.end] for record in scan(data).objects]


def spliced(data: bytes, additions: Additions) -> bytes:
    model = parse(data, "file").model
    planned = plan(additions, model.layers, ())
    carried = carrier(planned, model.layers, model.version)
    return splice(data, carried, layers=len(planned.layers), objects=len(planned.objects))


def check(data: bytes, additions: Additions) -> None:
    result = spliced(data, additions)
    old, new = scan(data), scan(result)
    assert records(result)[: len(old.objects)] == records(data)
    assert len(new.objects) == len(old.objects) + len(additions.objects)
    assert new.notes == () and new.size == len(result)
    for before, after in zip(old.tables, new.tables, strict=True):
        if before.typecode not in (LAYER_TABLE, OBJECT_TABLE):
            assert data[before.start : before.end] == result[after.start : after.end]
    was, now = rhino.File3dm.FromByteArray(data), rhino.File3dm.FromByteArray(result)
    assert len(now.Objects) == len(was.Objects) + len(additions.objects)
    assert [(a.Name, a.Id) for a in now.Layers][: len(was.Layers)] == [(a.Name, a.Id) for a in was.Layers]
    assert now.Settings.ModelUnitSystem == was.Settings.ModelUnitSystem
    assert dict(now.Strings) == dict(was.Strings)
    assert [dict(o.Attributes.GetUserStrings()) for o in now.Objects][: len(was.Objects)] == [
        dict(o.Attributes.GetUserStrings()) for o in was.Objects
    ]


def test_real_files_keep_every_record(real: Path, additions: Additions) -> None:
    data = real.read_bytes()
    if scan(data).version >= 50:
        check(data, additions)
    else:
        with pytest.raises(InputError, match="Rhino 5"):
            splice(data, data, layers=0, objects=0)


@pytest.mark.parametrize("version", [5, 6, 7, 8])
def test_written_files_keep_every_record(version: int, make: Callable[..., Path], additions: Additions) -> None:
    check(make(version).read_bytes(), additions)


def test_new_objects_stand_on_their_new_layers(make: Callable[..., Path], additions: Additions) -> None:
    file = rhino.File3dm.FromByteArray(spliced(make(7).read_bytes(), additions))
    found = {o.Attributes.Name: file.Layers[o.Attributes.LayerIndex].FullPath for o in file.Objects}
    assert found["Seil ü"] == "Frame::cables"
    assert found["line"] == "hookean::net::warp"
    assert found["polyline"] == "hookean::other"
    assert found["mesh"] == "hookean"


def test_nothing_added_is_the_same_bytes(real: Path) -> None:
    data = real.read_bytes()
    if scan(data).version < 50:
        pytest.skip("older archives are not spliced")
    assert splice(data, data, layers=0, objects=0) == data


def test_records_can_be_left_out(make: Callable[..., Path]) -> None:
    data = make(8).read_bytes()
    result = splice(data, data, layers=0, objects=0, drop_objects=(1,), drop_layers=1)
    before = records(data)
    assert records(result) == [before[0], *before[2:]]
    file = rhino.File3dm.FromByteArray(result)
    assert [layer.Name for layer in file.Layers] == ["Frame", "cables"]
    assert len(file.Objects) == 3


def test_bytes_after_the_end_mark_are_kept(make: Callable[..., Path], additions: Additions) -> None:
    data = make(8).read_bytes()
    assert spliced(data + b"tail", additions) == spliced(data, additions) + b"tail"


def test_what_does_not_fit_is_refused(make: Callable[..., Path]) -> None:
    seven, eight = make(7).read_bytes(), make(8).read_bytes()
    with pytest.raises(InputError, match=r"version 80 to a \.3dm file of version 70"):
        splice(seven, eight, layers=0, objects=1)
    with pytest.raises(InputError, match="more records"):
        splice(seven, seven, layers=0, objects=99)
    with pytest.raises(InputError, match="must have number 3"):
        splice(seven, seven, layers=1, objects=0)
    gap = scan(seven).layers[1]
    at = seven.index((1).to_bytes(4, "little"), seven.index(b"\xfc\xff\x02\x00", gap.start) + 13)
    with pytest.raises(InputError, match="not numbered"):
        splice(seven[:at] + b"\x05" + seven[at + 1 :], seven, layers=0, objects=0)


def test_history_leaves_no_path(make: Callable[..., Path]) -> None:
    path = make(8)
    data = path.read_bytes()
    name = path.name.encode("utf-16-le")
    assert name in data
    clean = without_history(data)
    assert name not in clean
    assert records(clean) == records(data)
    assert scan(clean).notes == ()
    assert len(rhino.File3dm.FromByteArray(clean).Objects) == 4
