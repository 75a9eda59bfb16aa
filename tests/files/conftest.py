"""Real .3dm files to read, and small ones written by rhino3dm in every version it writes."""

from __future__ import annotations

import uuid
import zlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm as _rhino3dm

from hookean.files.rhino import threedm
from hookean.files.rhino.archive import scan
from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, Points
from hookean.values.mesh import Mesh

rhino: Any = _rhino3dm
DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "rhino"
FILES: list[Path | None] = [*sorted(DATA.glob("*.3dm"))] or [None]


LARGEST = "v3_UntrimmedSurfaces"


@pytest.fixture(
    params=[pytest.param(f, marks=[pytest.mark.soak] if f and f.stem == LARGEST else []) for f in FILES],
    ids=lambda path: path.stem if path else "none",
)
def real(request: pytest.FixtureRequest) -> Path:
    """Each of the real files; the largest in `make soak` only."""
    if request.param is None:
        pytest.skip(f"no .3dm files in {DATA}")
    return Path(request.param)


@pytest.fixture
def make(tmp_path: Path) -> Callable[..., Path]:
    """Writes a small model of a given version: nested layers, a block, a light, user text, a hidden object."""

    def build(version: int, name: str = "") -> Path:
        file = sample()
        path = tmp_path / (name or f"made{version}.3dm")
        assert file.Write(str(path), version)
        return path

    return build


def sample() -> Any:
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = rhino.UnitSystem.Centimeters
    file.Settings.ModelAbsoluteTolerance = 0.005
    file.Strings["author"] = "Ada"
    for number, (name, parent) in enumerate((("Frame", None), ("cables", 0), ("Hidden", None))):
        layer = rhino.Layer()
        layer.Name, layer.Color = name, (10 * number, 20, 30, 255)
        layer.Visible = name != "Hidden"
        if parent is not None:
            layer.ParentLayerId = file.Layers[parent].Id
        file.Layers.Add(layer)
    attributes = rhino.ObjectAttributes()
    attributes.LayerIndex, attributes.Name = 1, "Seil ü"
    attributes.SetUserString("EA", "1200 kN")
    line = rhino.LineCurve(rhino.Point3d(0, 0, 0), rhino.Point3d(1 / 3, 2, 0))
    line.SetUserString("on geometry", "yes")
    file.Objects.Add(line, attributes)
    hidden = rhino.ObjectAttributes()
    hidden.LayerIndex = 2
    file.Objects.AddPoint(rhino.Point3d(1, 2, 3), hidden)
    member = rhino.ObjectAttributes()
    member.LayerIndex = 1
    file.InstanceDefinitions.Add(
        "node", "", "", "", rhino.Point3d(0, 0, 0), (rhino.Point(rhino.Point3d(1, 0, 0)),), (member,)
    )
    turn = rhino.Transform.Rotation(np.pi / 2, rhino.Vector3d(0, 0, 1), rhino.Point3d(0, 0, 0))
    move = rhino.Transform.Translation(5, 0, 0)
    xform = rhino.Transform.Multiply(move, turn)
    file.Objects.AddInstanceObject(rhino.InstanceReference(file.InstanceDefinitions[0].Id, xform))
    return file


@pytest.fixture
def additions() -> Additions:
    """One object of every kind, on layers given and not given."""
    square = Mesh(np.array([[0, 0, 0], [1 / 3, 0, 0], [1, 1, 0], [0, 1, 0.1]]), np.array([[0, 1, 2, 2], [0, 2, 3, 3]]))
    return Additions(
        layers=(NewLayer("net", colour=(200, 0, 0, 255)), NewLayer("warp", "net", (0, 200, 0, 255))),
        objects=(
            NewObject(np.array([0.1, 1 / 3, 0.0]), "net", "point", user_text={"reaction": "12 kN"}),
            NewObject(np.array([[0, 0, 0], [1, 1 / 3, 0.0]]), "net::warp", "line", (1, 2, 3, 255)),
            NewObject(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.0]]), "other", "polyline"),
            NewObject(square, "", "mesh", colours=np.array([[9, 8, 7]] * 4)),
            NewObject(Points(np.eye(3)), "net", "cloud"),
            NewObject(rhino.Circle(2.0).ToNurbsCurve(), "net", "circle"),
        ),
    )


@pytest.fixture
def unknown() -> Callable[[bytes], tuple[bytes, uuid.UUID]]:
    """Gives the first object of some .3dm bytes a class nobody knows, checksum and all."""

    def change(data: bytes) -> tuple[bytes, uuid.UUID]:
        record = scan(data).objects[0]
        odd = uuid.UUID("0dd0dd0d-1234-4abc-8def-0123456789ab")
        at = data.index(record.class_id.bytes_le, record.start)
        new = odd.bytes_le + zlib.crc32(odd.bytes_le).to_bytes(4, "little")
        return data[:at] + new + data[at + 20 :], odd

    return change


@pytest.fixture
def draw(tmp_path: Path) -> Callable[..., Any]:
    """Writes objects to a file as a person would draw them, and reads it."""

    def build(*objects: NewObject, unit: str = "Meters", layers: Sequence[NewLayer] = ()) -> Any:
        path = tmp_path / "drawn.3dm"
        threedm.write_new(path, Additions(layers, objects), unit=unit, own=False)
        return threedm.read(path)

    return build
