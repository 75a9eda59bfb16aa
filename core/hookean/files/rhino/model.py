"""What a .3dm file holds, as plain records around rhino3dm's geometry."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any
from uuid import UUID, uuid5

import rhino3dm as _rhino3dm

from hookean.errors import InputError

rhino: Any = _rhino3dm  # its type stubs lack names that exist

Colour = tuple[int, int, int, int]

TOP_LAYER = "hookean"
SEPARATOR = "::"
OWN_KEY = "hookean"  # user text key on every object added by hookean

METRES: dict[str, float] = {
    "Angstroms": 1e-10,
    "Nanometers": 1e-9,
    "Microns": 1e-6,
    "Millimeters": 1e-3,
    "Centimeters": 1e-2,
    "Decimeters": 1e-1,
    "Meters": 1.0,
    "Dekameters": 1e1,
    "Hectometers": 1e2,
    "Kilometers": 1e3,
    "Megameters": 1e6,
    "Gigameters": 1e9,
    "Microinches": 2.54e-8,
    "Mils": 2.54e-5,
    "Inches": 0.0254,
    "Feet": 0.3048,
    "Yards": 0.9144,
    "Miles": 1609.344,
    "PrinterPoints": 0.0254 / 72,
    "PrinterPicas": 0.0254 / 6,
    "NauticalMiles": 1852.0,
    "AstronomicalUnits": 1.495978707e11,
    "LightYears": 9.4607304725808e15,
    "Parsecs": 3.08567758149137e16,
}

MAX_EXPANDED = 100_000  # nested blocks multiply: ten levels of ten members are 1e10 objects


@dataclass(frozen=True, slots=True)
class Layer:
    """A layer: its number and id, full `path` ("a::b"), own flags, colour RGBA 0-255 and parent's id or None.

    `own` is true for the layer `hookean` and all below it.
    """

    index: int
    id: UUID
    name: str
    path: str
    parent: UUID | None
    visible: bool
    locked: bool
    colour: Colour
    own: bool


@dataclass(frozen=True, slots=True, eq=False)
class Object:
    """An object of the file.

    `index` is its place among the file's object records, `layer` the full path of its layer, `geometry` a
    rhino3dm geometry in the file's length units, `kind` its rhino3dm class name. `user_text` joins that of
    the geometry and of the attributes (which win). `visible` and `locked` take the layers above into
    account. `colour` is RGBA as displayed; `by_parent`: a block instance gives it. `own` is true below
    the layer `hookean`, `marked` if hookean added it. `page` is true in a layout rather than the model.
    """

    id: UUID
    index: int
    name: str
    layer: str
    geometry: Any
    kind: str
    user_text: Mapping[str, str]
    visible: bool
    locked: bool
    colour: Colour
    by_parent: bool
    is_instance: bool
    own: bool
    marked: bool
    page: bool


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """A block definition with its members in their own coordinates."""

    id: UUID
    name: str
    members: tuple[Object, ...]


@dataclass(frozen=True, slots=True)
class Lost:
    """Objects in the file's bytes that rhino3dm did not deliver: uuid of their class and their ids."""

    class_id: UUID
    ids: tuple[UUID | None, ...]

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.ids)


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A .3dm file as read.

    `version` is the archive's (4, 50, 60, 70, 80); `unit` rhino3dm's unit system name and `metres` one unit
    in metres (None if the file sets none or a custom one); `tolerance` in units; `objects` without members
    of block definitions and without the `lights` (a count); `text` the document's user text; `lost` and
    `warnings` what was not delivered and what else a person should know.
    """

    name: str
    version: int
    unit: str
    metres: float | None
    tolerance: float
    layers: tuple[Layer, ...]
    objects: tuple[Object, ...]
    blocks: tuple[Block, ...]
    lights: int
    text: Mapping[str, str]
    lost: tuple[Lost, ...]
    warnings: tuple[str, ...] = field(default=())

    def foreign(self) -> tuple[Object, ...]:
        """The objects that hookean did not add: what to read as input."""
        return tuple(item for item in self.objects if not item.own)

    def layer(self, path: str) -> Layer | None:
        """The layer of this full path (case does not matter, as in Rhino), or None."""
        return next((layer for layer in self.layers if layer.path.casefold() == path.casefold()), None)


def is_own(path: str) -> bool:
    """Whether a layer path is `hookean` or below it."""
    return path.split(SEPARATOR, 1)[0].casefold() == TOP_LAYER


def expand(model: Model, objects: Iterable[Object] | None = None) -> tuple[Object, ...]:
    """`objects` (default: all of the model's) with every block instance replaced by its members' geometry,
    copied and transformed to its place, nested blocks too.

    A copy has an id derived from the instance's and the member's, the member's layer, and the user text of
    both (the instance's wins). Raises InputError where a block contains itself, its definition is missing,
    or more than 100,000 objects come out, nested instances included: before anything is copied.
    """
    blocks = {block.id: block for block in model.blocks}
    given = model.objects if objects is None else tuple(objects)
    sizes = _sizes([item for item in given if item.is_instance], blocks, model.name)
    found: list[Object] = []
    for item in given:
        if item.is_instance:
            found.extend(_expanded(item, blocks, sizes, model.name))
        else:
            found.append(item)
    return tuple(found)


def _block(instance: Object, blocks: Mapping[UUID, Block], name: str) -> Block:
    block = blocks.get(instance.geometry.ParentIdefId)
    if block is None:
        raise InputError(
            name, f"block instance {instance.id} has no definition in the file; purge or explode it in Rhino."
        )
    return block


def _sizes(instances: Iterable[Object], blocks: Mapping[UUID, Block], name: str) -> dict[UUID, int]:
    """How many objects and instances are in each block that is used, nested ones included; 0 where there is no object
    in any. Each block is looked at once, however often and however deep it is nested."""
    sizes: dict[UUID, int] = {}
    total = 0
    for instance in instances:
        top = _block(instance, blocks, name)
        ways = [(top, iter([] if top.id in sizes else top.members))]
        inside = {top.id: 0}
        while ways:
            block, members = ways[-1]
            for member in members:
                below = _block(member, blocks, name) if member.is_instance else None
                if below is None or sizes.get(below.id):
                    inside[block.id] += 1 + (sizes[below.id] if below else 0)
                elif below.id in inside:
                    raise InputError(name, f'block "{below.name}" contains itself; explode it in Rhino.')
                elif below.id not in sizes:
                    ways.append((below, iter(below.members)))
                    inside[below.id] = 0
                    break
            else:
                ways.pop()
                sizes.setdefault(block.id, inside.pop(block.id))
                if ways and sizes[block.id]:
                    inside[ways[-1][0].id] += 1 + sizes[block.id]
        total += sizes[top.id]
        if total > MAX_EXPANDED:
            raise InputError(name, f"its blocks expand to more than {MAX_EXPANDED} objects; use fewer instances.")
    return sizes


def _expanded(instance: Object, blocks: Mapping[UUID, Block], sizes: Mapping[UUID, int], name: str) -> Iterator[Object]:
    """The objects of an instance in the order of its members, those of nested instances in their places."""
    waiting = [(instance, rhino.Transform.Identity())]
    while waiting:
        item, outer = waiting.pop()
        if not item.is_instance:
            yield replace(item, geometry=_transformed(item, outer, name))
        elif sizes[item.geometry.ParentIdefId]:
            xform = rhino.Transform.Multiply(outer, item.geometry.Xform)
            members = blocks[item.geometry.ParentIdefId].members
            waiting.extend((_placed(member, item), xform) for member in reversed(members))


def _placed(member: Object, instance: Object) -> Object:
    """A member of a block as an object of the block's instance."""
    return replace(
        member,
        id=uuid5(instance.id, str(member.id)),
        index=instance.index,
        user_text={**member.user_text, **instance.user_text},
        visible=member.visible and instance.visible,
        locked=member.locked or instance.locked,
        colour=instance.colour if member.by_parent else member.colour,
        by_parent=member.by_parent and instance.by_parent,
        own=instance.own,
        page=instance.page,
    )


def _transformed(item: Object, xform: Any, name: str) -> Any:
    copy = item.geometry.Duplicate()
    # an arc scaled in one direction is no arc any more: Transform refuses until it is made deformable
    if copy is None or not (copy.Transform(xform) or (copy.MakeDeformable() and copy.Transform(xform))):
        raise InputError(name, f"{item.kind} in a block cannot be moved to its place; explode the block in Rhino.")
    return copy


def points_in(cloud: Any) -> list[Any]:
    """The points of a point cloud; rhino3dm raises TypeError for those of an empty one."""
    return list(cloud.GetPoints()) if cloud.Count else []
