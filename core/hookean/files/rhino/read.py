"""From the bytes of a .3dm file to a Model: the frames scanned first, then rhino3dm, then both compared."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from uuid import UUID

from hookean.atomic_write import read_bytes
from hookean.errors import InputError
from hookean.files.rhino.archive import Archive, ObjectRecord, scan
from hookean.files.rhino.model import (
    METRES,
    OWN_KEY,
    SEPARATOR,
    TOP_LAYER,
    Block,
    Colour,
    Layer,
    Lost,
    Model,
    Object,
    is_own,
    rhino,
)
from hookean.files.rhino.old import FIRST_WITH_TEXT, clean_layer_names
from hookean.files.rhino.splice import OLDEST_SPLICED

MOST_NAMED = 3  # lost objects named in one warning
_NO_ID = UUID(int=0)


@dataclass(frozen=True, slots=True, eq=False)
class Loaded:
    """A file's bytes, their frames, rhino3dm's reading of the same bytes and the model made of it."""

    data: bytes
    archive: Archive
    file: Any
    model: Model


def load(path: str | os.PathLike[str], oldest: int = 2) -> Loaded:
    """Read a .3dm file; raises InputError if it is not one, is damaged, or is older than version `oldest`."""
    name = Path(path).name or str(path)
    data = read_bytes(path, name)
    return parse(data, name, oldest)


def parse(data: bytes, name: str, oldest: int = 2) -> Loaded:
    """Like `load`, for bytes; `name` is how errors call the file."""
    archive = scan(data, name)
    if archive.version < oldest:
        raise InputError(
            name,
            f"a .3dm file of version {archive.version}, older than the required {oldest}; "
            "open it in Rhino and save it as a newer version.",
        )
    try:
        file = rhino.File3dm.FromByteArray(data)
        if file is not None and archive.version < OLDEST_SPLICED:
            clean_layer_names(file)
        model = None if file is None else _Reader(data, archive, file, name).model()
    except (ValueError, RuntimeError, IndexError, AttributeError, TypeError, MemoryError) as error:
        raise _unreadable(archive, name) from error
    if model is None:
        raise _unreadable(archive, name)
    return Loaded(data, archive, file, model)


def _unreadable(archive: Archive, name: str) -> InputError:
    if archive.version > 80:
        return InputError(
            name,
            f"a .3dm file of version {archive.version // 10}, newer than the 8 that can be read; "
            "save it as Rhino 8 or earlier.",
        )
    found = f" ({archive.notes[0].rstrip('.')})" if archive.notes else ""
    return InputError(
        name, f"damaged .3dm file: its contents cannot be read{found}; open it in Rhino and save it again."
    )


class _Reader:
    """Makes a Model of a scanned archive and rhino3dm's file."""

    def __init__(self, data: bytes, archive: Archive, file: Any, name: str) -> None:
        self.data = data
        self.archive = archive
        self.file = file
        self.name = name
        self.layers = _layers(file)
        by_id = {layer.id: layer for layer in self.layers}
        self.states = [_state(layer, by_id) for layer in self.layers]
        self.warnings = list(archive.notes)

    def model(self) -> Model:
        record_ids = {record.id for record in self.archive.objects}
        # lights come along as objects but have a table of their own
        every = [(item.Attributes, item.Geometry) for item in self.file.Objects]
        lights = [a for a, g in every if isinstance(g, rhino.Light) and a.Id not in record_ids]
        given = [(a, g) for a, g in every if not (isinstance(g, rhino.Light) and a.Id not in record_ids)]
        places = self._places([a.Id for a, _ in given])
        objects = [
            self._object(attributes, geometry, place)
            for (attributes, geometry), place in zip(given, places, strict=True)
            if geometry is not None
        ]
        members = {item.id: item for item, hidden in objects if hidden}
        unit = self.file.Settings.ModelUnitSystem.name
        lost = self._lost([item.id for item, _ in objects])
        free = tuple(item for item, hidden in objects if not hidden)
        self._warn(unit, lost, len(lights), free)
        return Model(
            name=self.name,
            version=self.archive.version,
            unit=unit,
            metres=METRES.get(unit),
            tolerance=float(self.file.Settings.ModelAbsoluteTolerance),
            layers=self.layers,
            objects=free,
            blocks=self._blocks(members),
            lights=len(lights),
            text=dict(self.file.Strings),
            lost=lost,
            warnings=tuple(self.warnings),
        )

    def _places(self, ids: Sequence[UUID]) -> list[int]:
        if len(ids) == len(self.archive.objects):
            return list(range(len(ids)))
        known = {record.id: place for place, record in reversed(list(enumerate(self.archive.objects)))}
        return [known.get(id, -1) for id in ids]

    def _object(self, attributes: Any, geometry: Any, place: int) -> tuple[Object, bool]:
        on = attributes.LayerIndex
        layer, (visible, locked) = None, (True, False)
        if 0 <= on < len(self.layers):
            layer, (visible, locked) = self.layers[on], self.states[on]
        mode, source = attributes.Mode, attributes.ColorSource
        text = {**dict(geometry.GetUserStrings()), **dict(attributes.GetUserStrings())}
        from_object = source == rhino.ObjectColorSource.ColorFromObject
        item = Object(
            id=attributes.Id,
            index=place,
            name=attributes.Name or "",
            layer="" if layer is None else layer.path,
            geometry=geometry,
            kind=type(geometry).__name__,
            user_text=text,
            visible=visible and bool(attributes.Visible) and mode != rhino.ObjectMode.Hidden,
            locked=locked or mode == rhino.ObjectMode.Locked,
            colour=_colour(attributes.ObjectColor if from_object or layer is None else layer.colour),
            by_parent=source == rhino.ObjectColorSource.ColorFromParent,
            is_instance=isinstance(geometry, rhino.InstanceReference),
            own=layer is not None and layer.own,
            marked=OWN_KEY in text or (self.archive.version < FIRST_WITH_TEXT and layer is not None and layer.own),
            page=attributes.ActiveSpace == rhino.ActiveSpace.PageSpace,
        )
        return item, bool(attributes.IsInstanceDefinitionObject)

    def _blocks(self, members: Mapping[UUID, Object]) -> tuple[Block, ...]:
        blocks = []
        for definition in self.file.InstanceDefinitions:
            ids = definition.GetObjectIds()
            found = tuple(members[id] for id in ids if id in members)
            if len(found) < len(ids):
                self.warnings.append(f'{len(ids) - len(found)} members of block "{definition.Name}" are missing.')
            blocks.append(Block(definition.Id, definition.Name, found))
        return tuple(blocks)

    def _lost(self, delivered: Sequence[UUID]) -> tuple[Lost, ...]:
        records = self.archive.objects
        short = len(records) - len(delivered)
        if short <= 0:
            return ()
        left = Counter(delivered)
        missing: list[ObjectRecord] = []
        for record in records:
            if record.id is not None and left[record.id] > 0:
                left[record.id] -= 1
            else:
                missing.append(record)
        # an id given twice is changed on reading, so its record only seems missing: count those last
        twice = Counter(record.id for record in records)
        missing.sort(key=lambda record: twice[record.id])
        classes: dict[UUID, list[UUID | None]] = {}
        for record in missing[:short]:
            classes.setdefault(record.class_id, []).append(record.id)
        return tuple(Lost(class_id, tuple(ids)) for class_id, ids in classes.items())

    def _renamed(self) -> int:
        """How many layers have a name that is not in their record: the file misleads rhino3dm on how to read them."""
        records = [self.data[record.start : record.end] for record in self.archive.layers]
        named = [layer.name.encode("utf-16-le", "surrogatepass") for layer in self.layers]
        return sum(name not in record for name, record in zip(named, records, strict=False))

    def _warn(self, unit: str, lost: tuple[Lost, ...], lights: int, free: tuple[Object, ...]) -> None:
        if unit not in METRES:
            self.warnings.append(f"the file's unit system is {unit}, so its lengths in metres are unknown.")
        for group in lost:
            which = ", ".join(str(id or "unknown") for id in group.ids[:MOST_NAMED])
            self.warnings.append(
                f"{group.count} object{'s' * (group.count != 1)} of class {group.class_id} cannot be read and "
                f"{'is' if group.count == 1 else 'are'} left out of the model, but kept in the file: id {which}"
                f"{' ...' if group.count > MOST_NAMED else ''}."
            )
        if len(self.layers) < len(self.archive.layers):
            self.warnings.append(f"{len(self.archive.layers) - len(self.layers)} layers cannot be read.")
        if renamed := self._renamed():
            self.warnings.append(f"{renamed} layers have other names in the file than here; check them.")
        if lights < self.archive.lights:
            self.warnings.append(f"{self.archive.lights - lights} lights cannot be read; they stay in the file.")
        drawn = sum(item.own and not item.marked for item in free)
        if drawn:
            self.warnings.append(
                f"{drawn} objects below the layer {TOP_LAYER} were not added by hookean; they are not read as "
                "input: to use them, move them to another layer."
            )


def _layers(file: Any) -> tuple[Layer, ...]:
    raw = list(file.Layers)
    by_id = {layer.Id: layer for layer in raw}
    layers = []
    for index, layer in enumerate(raw):
        names, parent, seen = [layer.Name or ""], layer.ParentLayerId, {layer.Id}
        while parent in by_id and parent not in seen:
            seen.add(parent)
            names.append(by_id[parent].Name or "")
            parent = by_id[parent].ParentLayerId
        path = SEPARATOR.join(reversed(names))
        layers.append(
            Layer(
                index=index,
                id=layer.Id,
                name=layer.Name or "",
                path=path,
                parent=None if layer.ParentLayerId in (None, _NO_ID) else layer.ParentLayerId,
                visible=bool(layer.Visible),
                locked=bool(layer.Locked),
                colour=_colour(layer.Color),
                own=is_own(path),
            )
        )
    return tuple(layers)


def _state(layer: Layer | None, by_id: Mapping[UUID, Layer]) -> tuple[bool, bool]:
    """Visible and locked of a layer with all layers above it."""
    visible, locked = True, False
    seen: set[UUID] = set()
    while layer is not None and layer.id not in seen:
        seen.add(layer.id)
        visible, locked = visible and layer.visible, locked or layer.locked
        layer = None if layer.parent is None else by_id.get(layer.parent)
    return visible, locked


def _colour(value: Sequence[int]) -> Colour:
    red, green, blue, alpha = value
    return int(red), int(green), int(blue), int(alpha)
