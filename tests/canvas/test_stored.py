"""Data stored in parameters: what Grasshopper writes for each kind of value is read, what is damaged is reported."""

from __future__ import annotations

import base64
import os
import struct
import zlib
from pathlib import Path
from typing import Any
from uuid import UUID

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from canvas.native_values import made, near, plain
from canvas.natives_table import XY
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type, guids
from hookean_canvas.definitions.write import Definition
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from hookean_canvas.run.natives import BY_NAME, shapes
from hookean_canvas.run.stored import Unread, stored
from hookean_canvas.run.unsupported import unsupported


def text(value: str) -> bytes:
    """A text of MS-NRBF: its length in 7 bits a byte, and UTF-8."""
    data = value.encode()
    assert len(data) < 128
    return bytes([len(data)]) + data


def internalised(geometry: Any, name: str = "Rhino.Geometry.Mesh") -> bytes:
    """Geometry as Grasshopper internalises it: raw deflate around MS-NRBF, section 2.3.2.1 and 2.4.3.3.

    The stream: header, library, an object with four members, of which `data` is a reference, the bytes, the end.
    """
    held = geometry.Encode()
    data = base64.b64decode(held["data"])
    members = ["version", "archive3dm", "opennurbs", "data"]
    stream = b"\x00" + struct.pack("<iiii", 1, -1, 1, 0)
    stream += b"\x0c" + struct.pack("<i", 2) + text("RhinoCommon, Version=7.0.0.0, Culture=neutral")
    stream += b"\x05" + struct.pack("<i", 1) + text(name) + struct.pack("<i", 4) + b"".join(map(text, members))
    stream += bytes([0, 0, 0, 7]) + bytes([8, 8, 8, 2]) + struct.pack("<i", 2)
    stream += struct.pack("<iii", held["version"], held["archive3dm"], held["opennurbs"])
    stream += b"\x09" + struct.pack("<i", 3)
    stream += b"\x0f" + struct.pack("<iiB", 3, len(data), 2) + data + b"\x0b"
    packed = zlib.compressobj(wbits=-15)
    return packed.compress(stream) + packed.flush()


def item(name: str, kind: Type, value: Any) -> Chunk:
    return Chunk("Item", 0).put(name, kind, value)


MESH = BY_NAME["Mesh Plane"].run((made(XY), 2.0, 1.0), 2, 2)[0]


def test_an_internalised_mesh_is_read_with_all_its_digits() -> None:
    exact = shapes.mesh([[0, 0, 0], [1e6 + 1 / 3, 0, 0], [0, 1 / 7, 0]], [(0, 1, 2)])
    found = stored(item("ON_Data", Type.BYTEARRAY, internalised(exact)))
    assert plain(found) == plain(exact)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (item("ON_Data", Type.BYTEARRAY, internalised(shapes.polyline([(0, 0, 0), (1, 2, 3)]))),
         [(0, 0, 0), (1, 2, 3)]),
        (item("plane", Type.PLANE, (1, 2, 3, 1, 0, 0, 0, 1, 0)), ((1, 2, 3), (1, 0, 0), (0, 1, 0))),
        (item("Plane", Type.PLANE, (1, 0, 0, 1, 0, 0, 0, 1, 0)).put("Size", Type.INTERVAL2D, (-1.0, 1.0, 0.0, 3.0)),
         [(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0), (0, 0, 0)]),
        (item("Line", Type.LINE, (0, 0, 0, 1, 2, 3)), [(0, 0, 0), (1, 2, 3)]),
        (item("Interval", Type.INTERVAL1D, (1.0, 2.0)), (1.0, 2.0)),
        (item("number", Type.DOUBLE, 2.5), 2.5),
        (item("boolean", Type.BOOL, True), True),
        (item("string", Type.STRING, "a"), "a"),
        (item("anything", Type.LINE, (0, 0, 0, 1, 2, 3)), [(0, 0, 0), (1, 2, 3)]),
        (item("anything", Type.BOUNDINGBOX, (0, 0, 0, 1, 2, 3)), ((0, 0, 0), (1, 2, 3))),
        (Chunk("Item", 0), None),
    ],
)  # fmt: skip
def test_a_stored_value_of_each_kind_is_read(given: Chunk, expected: Any) -> None:
    assert near(plain(stored(given)), expected)


def test_a_material_of_a_preview_is_its_colour() -> None:
    held = item("ambient", Type.DRAWING_COLOR, (255, 128, 128, 128)).put(
        "diffuse", Type.DRAWING_COLOR, (255, 11, 125, 9)
    )
    held.put("rdk_id", Type.GUID, UUID(int=0)).put("shine", Type.DOUBLE, 0.5).put("transparency", Type.DOUBLE, 0.0)
    found = stored(held)
    assert (found.R, found.G, found.B) == (11, 125, 9)


def test_data_of_any_kind_is_read_from_the_chunk_below_its_type() -> None:
    outer = item("TypeName", Type.STRING, "Grasshopper.Kernel.Types.GH_Mesh")
    outer.add("Data").put("ON_Data", Type.BYTEARRAY, internalised(MESH))
    assert plain(stored(outer)) == plain(MESH)


@settings(derandomize=True)
@given(st.integers(0, 400), st.integers(0, 255))
def test_damaged_geometry_is_reported_not_raised(place: int, byte: int) -> None:
    whole = internalised(MESH)
    data = bytearray(zlib.decompress(whole, -15))
    data[place % len(data)] = byte
    found = stored(item("ON_Data", Type.BYTEARRAY, zlib.compress(bytes(data))[2:-4]))
    assert found is not None
    cut = stored(item("ON_Data", Type.BYTEARRAY, whole[: place % (len(whole) // 2)]))
    assert isinstance(cut, Unread)


def with_mesh(chunk: Chunk | None) -> Chunk:
    """A definition with a mesh parameter that feeds Mesh Edges; `chunk` is the item stored in it."""
    d = Definition("internal", "Internal", "An internalised mesh.")
    parameter = d.parameter("Mesh", "Mesh")
    d.panel("naked", d.native("List Length", list=d.native("Mesh Edges", mesh=parameter)["Naked Edges"]))
    root = d.archive()
    held = next(one for one in root.walk() if one.value("InstanceGuid") == parameter.id)
    data = held.add("PersistentData").put("Count", Type.INT32, 1)
    branch = data.add("Branch", 0).put("Count", Type.INT32, 1).put("Path", Type.STRING, "{0}")
    if chunk is not None:
        branch.chunks.append(chunk)
    return root


def test_an_internalised_mesh_runs_from_a_file(tmp_path: Path) -> None:
    """A plane of 2 by 2 quads has 8 naked edges."""
    archive.write(with_mesh(item("ON_Data", Type.BYTEARRAY, internalised(MESH))), tmp_path / "mesh.gh")
    outcome = Canvas(graph.read(tmp_path / "mesh.gh")).run(20.0)
    assert outcome.panels["naked"].values_in_order() == [8] and not outcome.messages


def test_a_reference_to_a_rhino_file_is_named_with_what_to_do() -> None:
    with pytest.raises(InputError, match=r"data stored in Mesh: .*internalise it in Grasshopper"):
        Canvas(graph.of(with_mesh(item("RefID", Type.GUID, UUID(int=5)))))


def test_all_objects_that_cannot_be_run_are_counted_by_kind() -> None:
    d = Definition("counts", "Counts", "Two of one kind, one of another.")
    [d.point(0, 0, i) for i in range(3)]
    root = d.archive()
    points = [one for one in root.walk() if one.name == "Object" and one.value("Name") == "Construct Point"]
    for chunk, name in zip(points, ("Loft", "Loft", "Patch"), strict=True):
        chunk.put("GUID", Type.GUID, next(guid for guid, names in guids.NAMES.items() if name in names))
        inner = chunk.chunk("Container")
        assert inner is not None
        inner.put("Name", Type.STRING, name)
    assert sorted((what, count) for (what, _), count in unsupported(graph.of(root)).items()) == [
        ("Loft", 2),
        ("Patch", 1),
    ]


# real files, in a folder that HOOKEAN_DEFINITIONS names

FOLDER = os.environ.get("HOOKEAN_DEFINITIONS", "")
FILES = sorted([*Path(FOLDER).rglob("*.gh"), *Path(FOLDER).rglob("*.ghx")]) if FOLDER else []


@pytest.mark.skipif(not FILES, reason="HOOKEAN_DEFINITIONS names no folder with .gh or .ghx files")
def test_internalised_data_of_real_files_is_read() -> None:
    unread = []
    for file in FILES:
        for node in graph.read(file).nodes:
            for port in node.inputs:
                values = port.data.values_in_order() if port.data is not None else []
                unread += [(file.name, node.name, v) for v in values if isinstance(v, Unread) and "ON_Data" in v.items]
    assert unread == []


def test_a_domain_in_u_and_v_is_read_whatever_its_name() -> None:
    found = stored(item("anything", Type.INTERVAL2D, (0.0, 1.0, 2.0, 3.0)))
    assert (found.u, found.v) == ((0.0, 1.0), (2.0, 3.0))
