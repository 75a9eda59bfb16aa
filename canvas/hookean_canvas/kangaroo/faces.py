"""Breps, surfaces and boxes that are wired into an input for meshes: Grasshopper makes meshes of them at such an input.

Ours are scripts, which take what comes; so a parameter for meshes goes between. Where the data comes from is followed
through what hands it on or moves it.
"""

from __future__ import annotations

from collections.abc import Sequence
from uuid import UUID

from hookean_canvas.archive import Chunk
from hookean_canvas.archive.guids import PARAMETERS, RELAY
from hookean_canvas.archive.parts import sources
from hookean_canvas.kangaroo.ids import key
from hookean_canvas.kangaroo.streams import Streams

_HELD = {PARAMETERS[name] for name in ("Brep", "Surface", "Box")}
_PASS = {PARAMETERS[name] for name in ("Data", "Geometry")} | {RELAY}
_MADE = frozenset(
    """
Sphere|Center Box|Box 2Pt|Box Rectangle|Domain Box|Bounding Box|Surface Box|Cylinder|Cone|Sphere Fit|Sphere 4Pt|Extrude
Extrude Linear|Extrude Along|Extrude Point|Cap Holes|Cap Holes Ex|Loft|Pipe|Pipe Variable|Boundary Surfaces
Surface From Points|Ruled Surface|Edge Surface|Sum Surface|Patch|Plane Surface|4Point Surface|Sweep1|Sweep2|Revolution
Rail Revolution|Network Surface|Offset Surface|Offset Surface Loose|Brep Join|Deconstruct Brep|Isotrim|Merge Faces
Untrim|Solid Union|Solid Difference|Solid Intersection|Trim Solid|Split Brep|Surface Split|Boundary Volume
""".strip()
    .replace("\n", "|")
    .split("|")
)
"""Grasshopper's own components that make Breps, surfaces or boxes, by name."""
_HANDING = frozenset(
    """
Merge|Entwine|Graft Tree|Flatten Tree|Simplify Tree|Clean Tree|Tree Branch|Tree Item|Explode Tree|Flip Matrix|List Item
Reverse List|Shift List|Cull Index|Cull Pattern|Cull Nth|Dispatch|Sub List|Split List|Weave|Duplicate Data|Stream Filter
Stream Gate|Data Dam|Data Recorder|Move|Rotate|Rotate Axis|Rotate 3D|Scale|Scale NU|Mirror|Orient|Transform
Polar Array|Linear Array|Move To Plane
""".strip()
    .replace("\n", "|")
    .split("|")
)
"""Those that hand on what they get, or move it, by name."""


def takes_meshes(ours: str, theirs: Sequence[str]) -> bool:
    """Whether an input takes meshes, by the names of ours and Kangaroo's."""
    name = ours.strip("_")
    return name in ("mesh", "meshes", "target", "source", "others") or (
        name == "connection" and "mesh" in map(key, theirs)
    )


def are_faces(streams: Streams, source: UUID) -> bool:
    """Whether Breps, surfaces or boxes come out of an output, as far as the names of what makes them tell."""
    waiting, seen = [source], {source}
    while waiting:
        part = streams.owner(waiting.pop())
        if part is None or part.chunk.value("Lib") is not None and part.guid not in _PASS | _HELD:
            continue
        if part.guid in _HELD or part.name in _MADE:
            return True
        if part.guid in _PASS or part.name in _HANDING:
            new = {one for port in streams.inputs_before(part) for one in sources(port)} - seen
            seen |= new
            waiting += new
    return False


def handed(streams: Streams, port: Chunk) -> list[UUID]:
    """Where an input's geometry comes from: the parameter for meshes before it, which goes by its id, or its wires."""
    wired = sources(port)
    return [port.value("InstanceGuid")] if any(are_faces(streams, one) for one in wired) else wired
