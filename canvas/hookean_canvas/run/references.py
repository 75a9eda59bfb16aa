"""Geometry that a definition refers to in Rhino, taken from a .3dm file.

Where a parameter or an input refers to objects of a Rhino file, the definition holds their ids alone. An object of that
id is taken; where the file has none, as ids change when objects are drawn again, all objects on the layer, or with the
name, that is the parameter's nickname. A parameter that is empty and has no wire gets those of its nickname as well.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any
from uuid import UUID

from hookean.files.rhino.model import Object
from hookean.files.rhino.read import load
from hookean_canvas.run.graph import Graph, Node, Port
from hookean_canvas.run.natives import PARAMETERS
from hookean_canvas.run.rhino import rhino3dm
from hookean_canvas.run.stored import Unread
from hookean_canvas.run.trees import Tree

GEOMETRY = ("point", "line", "curve", "mesh", "brep", "surface", "geometry", "any", "plane", "box")
"""Kinds of parameters that may refer to objects."""


def fill(definition: Graph, file: Path) -> None:
    """Put what is referred to in the place of the references; those that the file lacks keep the reason.

    InputError where the file cannot be read. `definition` is changed in place.
    """
    objects = [one for one in load(file).model.objects if not one.page]
    by_id = {one.id: one for one in objects}
    for node in definition.nodes:
        for port in node.inputs:
            named = _named(objects, port.nickname or node.nickname)
            if port.data is not None and not port.sources:
                port.data = _filled(port.data, by_id, named, _lacking(file, port.nickname or node.label))
            elif _empty(node, port) and named:
                port.data = Tree.of(_plain(one.geometry) for one in named)


def _lacking(file: Path, name: str) -> Callable[[UUID], Unread]:
    """What stands for a reference to an object that the file has not."""

    def lacks(reference: UUID) -> Unread:
        where = f"{file.name} has no object {reference} and nothing on a layer or with a name {name}"
        return Unread(["RefID"], f"{where}; name the objects so, or internalise them in Grasshopper", reference)

    return lacks


def _filled(data: Tree, by_id: dict[UUID, Object], named: Sequence[Object], lacks: Callable[[UUID], Unread]) -> Tree:
    """A tree with objects in the place of references; those of the name in the place of the first that is unknown."""
    found = Tree()
    for path, values in data.branches():
        here: list[Any] = []
        lost: list[UUID] = []
        for value in values:
            reference = value.reference if isinstance(value, Unread) else None
            if reference is None:
                here.append(value)
            elif reference in by_id:
                here.append(_plain(by_id[reference].geometry))
            else:
                lost.append(reference)
        if lost:
            here += [_plain(one.geometry) for one in named] or [lacks(one) for one in lost]
        found.add(path, here)
    return found


def _named(objects: Sequence[Object], name: str) -> list[Object]:
    """Objects on a layer of this name, or with this name; the last part of a layer's path counts as well."""
    wanted = name.strip().lower()
    if not wanted:
        return []
    on_layer = [one for one in objects if wanted in (one.layer.lower(), one.layer.lower().rsplit("::", 1)[-1])]
    return on_layer or [one for one in objects if one.name.lower() == wanted]


def _empty(node: Node, port: Port) -> bool:
    """Whether it is a parameter for geometry that has no data and no wire."""
    kind = PARAMETERS.get(node.guid, ("", ""))[1]
    return node.floating and kind in GEOMETRY and not port.sources and not port.data


def _plain(geometry: Any) -> Any:
    """Points as values; all else as it is."""
    return geometry.Location if isinstance(geometry, rhino3dm.Point) else geometry
