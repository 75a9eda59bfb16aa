"""Points that goals give together with the plane of a rigid body, such as the ends of an axis: its particles, too."""

from __future__ import annotations

from typing import TYPE_CHECKING
from uuid import UUID, uuid5

from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.guids import PYTHON3_SCRIPT
from hookean_canvas.archive.parts import bounds_of, inputs, outputs, parts, sources
from hookean_canvas.kangaroo import make
from hookean_canvas.kangaroo.space import size
from hookean_canvas.kangaroo.swap import connect

if TYPE_CHECKING:
    from hookean_canvas.kangaroo.plan import Importing

CARRYING = ("*axles", "*mates", "*solids")
"""Scripts with the outputs `carriers` and `carried`."""


def carry(work: Importing) -> None:
    """Give the bodies of a definition the points that its goals join them at."""
    there = {part.id: part.container for part in parts(work.root)}
    made: dict[str, list[Chunk]] = {}
    for part in work.streams.parts:
        swap = work.plan.get(id(part.chunk))
        for number, piece in enumerate(swap.pieces if swap and part.id else ()):
            chunk = there.get(uuid5(part.id, f"hookean piece {number}")) if part.id else None
            if chunk is not None:
                made.setdefault(piece.bundle, []).append(chunk)
    joining = [chunk for bundle in CARRYING for chunk in made.get(bundle, []) if _has_planes(chunk)]
    for bodies in made.get("*bodies", []) if joining else ():
        _insert(work, bodies, joining)


def _has_planes(chunk: Chunk) -> bool:
    return any(sources(port) for port in inputs(chunk) if str(port.value("Name")).startswith("plane"))


def _insert(work: Importing, bodies: Chunk, joining: list[Chunk]) -> None:
    """A script between the points of bodies and their force."""
    recipe, id_ = make.recipe("*carried"), uuid5(bodies.value("InstanceGuid"), "hookean carried")
    result = uuid5(id_, "out points")
    chunk = make.component(recipe, id_, "", [uuid5(id_, f"in {slot.name}") for slot in recipe.inputs], [result])
    of = {port.value("Name"): port.value("InstanceGuid") for port in outputs(bodies)}
    for part in parts(work.root):
        for port in inputs(part.container) if part.container is not None else ():
            if of["points"] in sources(port):
                connect(port, [result if source == of["points"] else source for source in sources(port)])
    points, planes, carriers, carried = inputs(chunk)
    connect(points, [of["points"]])
    connect(planes, [of["planes"]])
    for port, name in ((carriers, "carriers"), (carried, "carried")):
        port.put("Mapping", Type.INT32, 1)  # flattened
        connect(port, [_output(one, name) for one in joining])
    make.put_object(work.objects, PYTHON3_SCRIPT, chunk)
    x, y, wide, _ = bounds_of(bodies) or (0.0, 0.0, 0.0, 0.0)
    box = size([slot.name for slot in recipe.inputs], [slot.name for slot in recipe.outputs])
    work.space.put(chunk, work.space.free(x + wide + 40.0, y, *box))


def _output(chunk: Chunk, name: str) -> UUID:
    ids = (port.value("InstanceGuid") for port in outputs(chunk) if port.value("Name") == name)
    return next(id_ for id_ in ids if isinstance(id_, UUID))
