"""What to add to a .3dm file, and the file rhino3dm writes it to before its records are spliced."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from uuid import UUID, uuid5

from numpy.typing import ArrayLike

from hookean.errors import InputError
from hookean.files.rhino.geometry import build
from hookean.files.rhino.model import OWN_KEY, SEPARATOR, TOP_LAYER, Colour, Layer, rhino

NAMESPACE = UUID("5f6d2c2e-7a0b-5c5e-9b1f-6a1f3c0e8d11")  # of all ids that hookean derives


@dataclass(frozen=True, slots=True)
class NewLayer:
    """A layer to add: its name, the path of the layer above it ("" for `hookean` itself), colour RGBA 0-255."""

    name: str
    parent: str = ""
    colour: Colour = (0, 0, 0, 255)
    visible: bool = True

    @property
    def path(self) -> str:
        """Its path below `hookean`."""
        return f"{self.parent}{SEPARATOR}{self.name}" if self.parent else self.name


@dataclass(frozen=True, slots=True, eq=False)
class NewObject:
    """An object to add: a geometry (see `geometry.build`), the path of its layer below `hookean`
    ("" for `hookean` itself; missing layers are made), name, colour RGBA or None for its layer's, user text,
    and colours `(n, 3)` 0-255 of a mesh's or point set's points."""

    geometry: object
    layer: str = ""
    name: str = ""
    colour: Colour | None = None
    user_text: Mapping[str, str] = field(default_factory=dict)
    colours: ArrayLike | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Additions:
    """New layers and objects for a .3dm file, coordinates in the file's length units."""

    layers: Sequence[NewLayer] = ()
    objects: Sequence[NewObject] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """Additions checked and placed: rhino3dm layers (name, parent's number, id, look) and objects to add.

    Layer numbers count on from the layers kept. `own`: the objects carry hookean's mark.
    """

    layers: tuple[tuple[str, int | None, UUID, NewLayer], ...]
    objects: tuple[tuple[Any, Any], ...]
    notes: tuple[str, ...]

    @property
    def ids(self) -> tuple[UUID, ...]:
        """The new objects' ids, in the order given."""
        return tuple(attributes.Id for _, attributes in self.objects)


def plan(additions: Additions, kept: Sequence[Layer], taken: Iterable[UUID], own: bool = True) -> Plan:
    """Check additions and give every layer its number and every object its id.

    `kept` are the layers that stay (one of the same path is used again), `taken` the ids in use. Ids derive
    from content, so the same additions get the same ids. Raises InputError naming the faulty addition.
    """
    used = {*taken, *(layer.id for layer in kept)}
    numbers = {layer.path.casefold(): layer.index for layer in kept}
    layers: list[tuple[str, int | None, UUID, NewLayer]] = []
    for path, look in _wanted(additions, own):
        if path.casefold() not in numbers:
            above, _, name = path.rpartition(SEPARATOR)
            parent = numbers[above.casefold()] if above else None
            numbers[path.casefold()] = len(kept) + len(layers)
            layers.append((name, parent, _new_id(f"layer {path}", used), look))
    objects, notes = [], []
    for place, item in enumerate(additions.objects):
        pointer = f"/objects/{place}"
        built = build(item.geometry, item.colours, f"{pointer}/geometry")
        path = _full(item.layer, own)
        attributes = _attributes(item, numbers[path.casefold()], own, pointer)
        attributes.Id = _new_id(f"object {path} {item.name} {built.digest}", used)
        objects.append((built.geometry, attributes))
        if built.note:
            notes.append(f"{pointer}: {built.note}.")
    return Plan(tuple(layers), tuple(objects), tuple(notes))


def add_layers(file: Any, planned: Plan, parents: Sequence[UUID]) -> None:
    """Add the planned layers to a rhino3dm file whose first layers have the ids `parents`."""
    ids = [*parents, *(id for _, _, id, _ in planned.layers)]
    for name, parent, id, look in planned.layers:
        layer = rhino.Layer()
        layer.Name, layer.Id = name, id
        layer.Color, layer.Visible = look.colour, look.visible
        if parent is not None:
            layer.ParentLayerId = ids[parent]
        file.Layers.Add(layer)


def add_objects(file: Any, planned: Plan) -> None:
    """Add the planned objects to a rhino3dm file."""
    for geometry, attributes in planned.objects:
        file.Objects.Add(geometry, attributes)


def carrier(planned: Plan, kept: Sequence[Layer], version: int, text: Mapping[str, str] | None = None) -> bytes:
    """A .3dm file of archive version 50-80 with the planned layers, numbered after those kept, objects, and document
    text."""
    file = rhino.File3dm()
    for key, value in (text or {}).items():
        file.Strings[key] = value
    for layer in kept:
        placeholder = rhino.Layer()
        placeholder.Name, placeholder.Id = f"{layer.index} {layer.id}", layer.id
        file.Layers.Add(placeholder)
    add_layers(file, planned, [layer.id for layer in kept])
    add_objects(file, planned)
    return written(file, version // 10)


def written(file: Any, version: int) -> bytes:
    """The bytes rhino3dm writes for a file in Rhino version `version`."""
    with tempfile.TemporaryDirectory(prefix=f"hookean-{os.getpid()}-") as folder:
        path = os.path.join(folder, "new.3dm")
        if not file.Write(path, version):
            raise InputError("file", f"could not be written as .3dm version {version}; try another version.")
        return Path(path).read_bytes()


def _wanted(additions: Additions, own: bool) -> list[tuple[str, NewLayer]]:
    """Full paths of all layers in order of need, parents first, with how they look."""
    looks: dict[str, NewLayer] = {}
    for place, layer in enumerate(additions.layers):
        pointer = f"/layers/{place}"
        if SEPARATOR in layer.name:
            raise InputError(f"{pointer}/name", f'"{layer.name}" contains "::"; give the parent layer as parent.')
        _check_path(layer.path, pointer)
        _check_colour(layer.colour, f"{pointer}/colour")
        looks[_full(layer.path, own).casefold()] = layer
    for place, item in enumerate(additions.objects):
        if item.layer or not own:
            _check_path(item.layer, f"/objects/{place}/layer")
    wanted: dict[str, tuple[str, NewLayer]] = {}
    for path in (*(layer.path for layer in additions.layers), *(item.layer for item in additions.objects)):
        parts = _full(path, own).split(SEPARATOR)
        for depth in range(1, len(parts) + 1):
            whole = SEPARATOR.join(parts[:depth])
            key = whole.casefold()
            wanted.setdefault(key, (whole, looks.get(key, NewLayer(parts[depth - 1]))))
    return list(wanted.values())


def _full(path: str, own: bool) -> str:
    if not own:
        return path
    return f"{TOP_LAYER}{SEPARATOR}{path}" if path else TOP_LAYER


def _attributes(item: NewObject, layer: int, own: bool, pointer: str) -> Any:
    attributes = rhino.ObjectAttributes()
    attributes.LayerIndex = layer
    attributes.Name = _text(item.name, f"{pointer}/name")
    if item.colour is not None:
        _check_colour(item.colour, f"{pointer}/colour")
        attributes.ColorSource = rhino.ObjectColorSource.ColorFromObject
        attributes.ObjectColor = item.colour
    for key, value in item.user_text.items():
        where = f"{pointer}/user_text/{key}"
        if not _text(key, where) or not _text(value, where):
            raise InputError(where, "an empty key or value; Rhino stores no empty user text, so remove it.")
        attributes.SetUserString(key, value)
    if own:
        attributes.SetUserString(OWN_KEY, "1")
    return attributes


def _new_id(content: str, used: set[UUID]) -> UUID:
    count = 0
    while (id := uuid5(NAMESPACE, f"{content} {count}")) in used:
        count += 1
    used.add(id)
    return id


def _check_path(path: str, pointer: str) -> None:
    for name in path.split(SEPARATOR):
        if not name or name != name.strip() or _text(name, pointer) != name:
            raise InputError(
                pointer,
                f'the layer path "{path}" has an empty name or spaces around one; write it like "mesh::warp".',
            )


def _check_colour(colour: Colour, pointer: str) -> None:
    if len(colour) != 4 or any(not isinstance(c, int) or not 0 <= c <= 255 for c in colour):
        raise InputError(pointer, f"the colour {colour}; give red, green, blue, alpha as whole numbers 0-255.")


def _text(value: object, pointer: str) -> str:
    if not isinstance(value, str):
        raise InputError(pointer, f"a {type(value).__name__} where text is needed; turn it into text.")
    if "\0" in value or any("\ud800" <= c <= "\udfff" for c in value):
        raise InputError(pointer, "text with a null character or half a surrogate pair; remove it.")
    return value
