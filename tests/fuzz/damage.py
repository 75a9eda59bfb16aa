"""Seeds of .3dm files, ways to damage them, and a process that reads what comes out as the service's workers do."""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import random
import struct
import tempfile
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
import rhino3dm as _rhino3dm

from hookean.errors import InputError
from hookean.files.rhino.archive import scan
from hookean.files.rhino.read import parse
from hookean_server.workers.deadline import ended, limited
from hookean_server.workers.memory import limit_memory

rhino: Any = _rhino3dm
REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "rhino"
MEMORY = 1024 * 2**20


def seeds() -> dict[str, bytes]:
    """Files written here in every version, and the real ones where they are."""
    found = {
        f"{name}-v{version}": _written(make(), version) for name, make in MODELS.items() for version in range(2, 9)
    }
    return found | {path.stem: path.read_bytes() for path in sorted(REAL.glob("*.3dm"))}


def large() -> bytes:
    """A file that takes a while to read."""
    file = rhino.File3dm()
    for number in range(5000):
        file.Objects.AddPoint(rhino.Point3d(number, 0, 0))
    return _written(file, 7)


def _written(file: Any, version: int) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "seed.3dm"
        assert file.Write(str(path), version)
        return path.read_bytes()


def _points() -> Any:
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = rhino.UnitSystem.Meters
    for number in range(3):
        layer = rhino.Layer()
        layer.Name = ("anchors", "cables", "loads")[number]
        if number == 2:
            layer.ParentLayerId = file.Layers[0].Id
        file.Layers.Add(layer)
    for number in range(12):
        attributes = rhino.ObjectAttributes()
        attributes.LayerIndex = number % 3
        attributes.Name = f"P{number}"
        attributes.SetUserString("load", str(number))
        file.Objects.AddPoint(rhino.Point3d(number, number / 3, 0), attributes)
    return file


def _lines() -> Any:
    file = rhino.File3dm()
    for number in range(20):
        file.Objects.AddLine(rhino.Point3d(number, 0, 0), rhino.Point3d(number + 1, 0.1, 0))
    file.Objects.AddPolyline(rhino.Polyline([rhino.Point3d(i, i * i, 0) for i in range(8)]))
    file.Objects.AddCircle(rhino.Circle(rhino.Point3d(0, 0, 0), 2.0))
    return file


def _curves() -> Any:
    file = rhino.File3dm()
    for number in range(5):
        points = rhino.Point3dList([rhino.Point3d(i, number * np.sin(i), i * 0.5) for i in range(9)])
        file.Objects.AddCurve(rhino.NurbsCurve.Create(False, 3, points))
    return file


def _meshes() -> Any:
    file = rhino.File3dm()
    for number in range(3):
        mesh = rhino.Mesh()
        for i in range(6):
            for j in range(6):
                mesh.Vertices.Add(i, j, number + 0.1 * i * j)
        for i in range(5):
            for j in range(5):
                mesh.Faces.AddFace(6 * i + j, 6 * i + j + 6, 6 * i + j + 7, 6 * i + j + 1)
        mesh.Normals.ComputeNormals()
        file.Objects.AddMesh(mesh)
    return file


def _solids() -> Any:
    file = rhino.File3dm()
    sphere = rhino.Sphere(rhino.Point3d(0, 0, 0), 2.0)
    file.Objects.AddBrep(sphere.ToBrep())
    file.Objects.AddBrep(
        rhino.Brep.CreateFromCylinder(rhino.Cylinder(rhino.Circle(rhino.Point3d(5, 0, 0), 1.0), 3.0), True, True)
    )
    file.Objects.AddSurface(rhino.NurbsSurface.CreateFromSphere(sphere))
    return file


MODELS: dict[str, Callable[[], Any]] = {
    "points": _points,
    "lines": _lines,
    "curves": _curves,
    "meshes": _meshes,
    "solids": _solids,
}


# ways to damage


def _flips(data: bytearray, chance: random.Random, other: bytes) -> None:
    for _ in range(chance.choice((1, 1, 2, 8))):
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)


def _zeros(data: bytearray, chance: random.Random, other: bytes) -> None:
    start = chance.randrange(32, len(data))
    length = chance.choice((1, 4, 16, 512))
    data[start : start + length] = bytes(len(data[start : start + length]))


def _cut(data: bytearray, chance: random.Random, other: bytes) -> None:
    del data[chance.randrange(len(data)) :]


def _hole(data: bytearray, chance: random.Random, other: bytes) -> None:
    start = chance.randrange(32, len(data))
    del data[start : start + chance.choice((1, 4, 12, 200))]


def _splice(data: bytearray, chance: random.Random, other: bytes) -> None:
    length = chance.choice((4, 24, 300))
    start, source = chance.randrange(32, len(data)), chance.randrange(max(1, len(other) - length))
    data[start : start + length] = other[source : source + length]


def _length(data: bytearray, chance: random.Random, other: bytes) -> None:
    """Another length, or typecode, at the head of a record."""
    try:
        archive = scan(bytes(data))
    except InputError:
        return _flips(data, chance, other)
    heads = [r.start for r in (*archive.objects, *archive.layers)] + [t.start for t in archive.tables]
    start = chance.choice(heads) + chance.choice((0, 0, 12 if archive.length_size == 8 else 8))
    form = "<q" if archive.length_size == 8 else "<i"
    if chance.random() < 0.3:
        data[start + chance.randrange(4)] ^= 1 << chance.randrange(8)
        return None
    (now,) = struct.unpack_from(form, data, start + 4)
    given = chance.choice((0, now - 1, now + 1, now + 4, now * 2, 2**31 - 1, -1, chance.randrange(1 << 16)))
    struct.pack_into(form, data, start + 4, max(-(2**31), min(2**31 - 1, given)))
    return None


def _inner(data: bytearray, chance: random.Random, other: bytes) -> None:
    """Bytes inside an object or layer: counts, flags, coordinates."""
    try:
        archive = scan(bytes(data))
    except InputError:
        return _flips(data, chance, other)
    record = chance.choice((*archive.objects, *archive.layers))
    start = chance.randrange(record.start, record.end)
    data[start : start + 4] = chance.choice((bytes(4), b"\xff" * 4, b"\xff\xff\xff\x7f", chance.randbytes(4)))
    return None


MUTATORS = (_flips, _zeros, _cut, _hole, _splice, _length, _inner)


def mutant(files: dict[str, bytes], number: int) -> tuple[str, str, bytes]:
    """The damaged file of a number: of which seed, how, and its bytes."""
    chance = random.Random(number)
    names = sorted(files)
    name = names[number % len(names)]
    how = MUTATORS[number // len(names) % len(MUTATORS)]
    data = bytearray(files[name])
    how(data, chance, files[chance.choice(names)])
    return name, how.__name__[1:], bytes(data)


# reading


def outcome(data: bytes) -> dict[str, Any]:
    """What is read: a digest of every object with what matters of the model, or a problem; and warnings."""
    try:
        model = parse(data, "file.3dm").model
    except InputError as error:
        return {"problem": error.sentence}
    objects = [
        [str(o.id), o.kind, o.layer, o.name, sorted(o.user_text.items()), o.visible, o.locked, _digest(o.geometry)]
        for o in model.objects
    ]
    blocks = [[b.name, [[o.kind, _digest(o.geometry)] for o in b.members]] for b in model.blocks]
    layers = [[layer.path, layer.visible, layer.locked] for layer in model.layers]
    whole = json.dumps([model.unit, objects, blocks, layers, model.lights])
    return {
        "digest": hashlib.sha256(whole.encode()).hexdigest(),
        "count": len(objects),
        "warnings": list(model.warnings),
    }


def _digest(geometry: Any) -> str:
    return hashlib.sha256(json.dumps(geometry.Encode(), sort_keys=True).encode()).hexdigest()


class Reader:
    """A process that reads files one after the other under a worker's limits; a new one when it ended."""

    def __init__(self, seconds: float) -> None:
        self.seconds, self.replaced = seconds, 0
        self._begin()

    def _begin(self) -> None:
        self.connection, theirs = multiprocessing.Pipe()
        process = multiprocessing.get_context("spawn").Process
        self.process = process(target=_read_all, args=(theirs, self.seconds), daemon=True)
        self.process.start()
        theirs.close()

    def read(self, data: bytes) -> dict[str, Any]:
        """What became of a file."""
        self.connection.send_bytes(data)
        try:
            found: dict[str, Any] = json.loads(self.connection.recv_bytes())
            return found
        except EOFError:
            self.process.join()
            code = self.process.exitcode
            self.replaced += 1
            self._begin()
            return {"problem": ended(code), "code": code}

    def close(self) -> None:
        """End the process."""
        self.process.kill()
        self.process.join()
        self.connection.close()


def _read_all(connection: Connection, seconds: float) -> None:
    limit_memory(MEMORY)
    with suppress(EOFError):
        while True:
            data = connection.recv_bytes()
            with limited(seconds):
                found = outcome(data)
            connection.send_bytes(json.dumps(found).encode())
