"""Rhino's .3dm files: read a model, and write results into a copy of it.

Everything hookean adds lives below one layer named `hookean`; what was there stays as it is, to the byte.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from uuid import UUID

from hookean.atomic_write import check_target, put
from hookean.errors import InputError
from hookean.files.rhino.archive import scan
from hookean.files.rhino.build import (
    Additions,
    NewLayer,
    NewObject,
    Plan,
    add_layers,
    add_objects,
    carrier,
    plan,
    written,
)
from hookean.files.rhino.geometry import Points
from hookean.files.rhino.model import (
    METRES,
    Block,
    Colour,
    Layer,
    Lost,
    Model,
    Object,
    expand,
    rhino,
)
from hookean.files.rhino.old import FIRST_WITH_TEXT, warnings
from hookean.files.rhino.read import Loaded, load, parse
from hookean.files.rhino.splice import OLDEST_SPLICED, splice, without_history

__all__ = [
    "Additions",
    "Block",
    "Colour",
    "Layer",
    "Lost",
    "Model",
    "NewLayer",
    "NewObject",
    "Object",
    "Points",
    "Written",
    "expand",
    "read",
    "write",
    "write_new",
]

StrPath = str | os.PathLike[str]
Told = Callable[[Sequence[str]], Mapping[str, str]]
"""Document text to add, made of the warnings that come with writing."""
OWN_TEXT = "hookean:"  # what keys of document text begin with that an earlier run added
NEWEST_WRITTEN = 80  # Rhino 8, the newest archive version rhino3dm writes


@dataclass(frozen=True, slots=True)
class Written:
    """What `write` did: ids of the new objects in the order given, how many old objects of hookean were left
    out, and warnings for a person to read."""

    ids: tuple[UUID, ...]
    dropped: int
    warnings: tuple[str, ...]


def read(path: StrPath, *, oldest: int = 2) -> Model:
    """The model in a .3dm file, lengths in its own units.

    Raises InputError if the file does not exist, is not a .3dm file, is damaged or cut short, or its archive
    version is older than `oldest` (50 is Rhino 5). Objects rhino3dm leaves out silently are in `Model.lost`.
    """
    return load(path, oldest).model


def write(source: StrPath, target: StrPath, additions: Additions, text: Told | None = None) -> Written:
    """Write a copy of the .3dm file `source` with new layers and objects to `target`, in the same version.

    From Rhino 5 on every object of the source stays byte for byte and in order; older files take a round
    trip through rhino3dm, with a warning. Objects and document text an earlier run added are left out, so
    results do not pile up. `text` is the document text to add. `target` is replaced in one step or not at all; it may
    not be the source. Raises InputError.
    """
    check_target(target, source)
    loaded = load(source)
    if loaded.archive.version >= OLDEST_SPLICED:
        return _splice(loaded, target, additions, text)
    return _round_trip(loaded, target, additions, text)


def write_new(
    path: StrPath,
    additions: Additions,
    *,
    unit: str = "Meters",
    tolerance: float = 0.001,
    version: int = 8,
    own: bool = True,
    text: Mapping[str, str] | Told | None = None,
) -> Written:
    """Write a new .3dm file of Rhino version 5 to 8 with these layers and objects.

    `unit` is a rhino3dm unit system name, `tolerance` in that unit, `text` the document's user text, or what makes it
    of the warnings. With
    `own=False` the layers stand at the top rather than below `hookean`, as in a file a person drew. The same
    arguments give the same bytes. Raises InputError.
    """
    name = Path(path).name
    if unit not in METRES:
        raise InputError("unit", f'"{unit}"; give one of {", ".join(METRES)}.')
    if version not in (5, 6, 7, 8):
        raise InputError("version", f"{version}; give 5, 6, 7 or 8.")
    if not 0 < tolerance < float("inf"):
        raise InputError("tolerance", f"{tolerance}; give a positive length.")
    check_target(path)
    planned = plan(additions, (), (), own)
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = getattr(rhino.UnitSystem, unit)
    file.Settings.ModelAbsoluteTolerance = tolerance
    for key, value in (text(planned.notes) if callable(text) else text or {}).items():
        file.Strings[key] = value
    add_layers(file, planned, ())
    add_objects(file, planned)
    data = without_history(written(file, version))
    put(path, data, lambda back: _check_new(back, name, planned))
    return Written(planned.ids, 0, planned.notes)


@dataclass(frozen=True, slots=True)
class _Cut:
    """What to leave out of a copy: places of object records, and how many layers at the end."""

    objects: tuple[int, ...]
    layers: int


def _splice(loaded: Loaded, target: StrPath, additions: Additions, text: Told | None) -> Written:
    model, archive = loaded.model, loaded.archive
    if archive.version > NEWEST_WRITTEN:
        raise InputError(
            model.name, f"a .3dm file of version {archive.version}, newer than Rhino 8; save it as Rhino 8."
        )
    cut = _cut(loaded)
    kept = model.layers[: len(model.layers) - cut.layers]
    planned = plan(additions, kept, _taken(loaded, cut))
    notes = (*model.warnings, *planned.notes)
    strings = _merged(model, text, notes)
    data = splice(
        loaded.data,
        carrier(planned, kept, archive.version, strings),
        layers=len(planned.layers),
        objects=len(planned.objects),
        drop_objects=cut.objects,
        drop_layers=cut.layers,
        text=strings != model.text,
        name=model.name,
    )
    put(target, data, lambda back: _check_spliced(back, loaded, cut, planned, strings))
    return Written(planned.ids, len(cut.objects), notes)


def _merged(model: Model, text: Told | None, notes: Sequence[str]) -> dict[str, str]:
    """The document text of the copy: that of the source, and what is added in place of what an earlier run added."""
    if text is None:
        return dict(model.text)
    kept = {key: value for key, value in model.text.items() if not key.startswith(OWN_TEXT)}
    return kept | {key: value for key, value in text(notes).items() if value}  # Rhino keeps no empty text


def _cut(loaded: Loaded) -> _Cut:
    """Old objects of hookean, and its layers at the end that nothing else uses.

    Layers go by their number, so one in the middle cannot leave; it stays and is used again.
    """
    model, archive = loaded.model, loaded.archive
    ids = Counter(record.id for record in archive.objects)
    places = {item.index for item in model.objects if item.own and item.marked and ids[item.id] == 1}
    places.discard(-1)
    left = [record for place, record in enumerate(archive.objects) if place not in places]
    used = {record.layer_index for record in left} | {archive.current_layer}
    used |= {item.Attributes.LayerIndex for item in loaded.file.Objects if item.Attributes.Id not in ids}
    count = 0
    if None not in {record.layer_index for record in left}:
        while count < len(model.layers):
            layer = model.layers[-1 - count]
            if not layer.own or _above(layer.index, used, model.layers):
                break
            count += 1
    return _Cut(tuple(sorted(places)), count)


def _above(index: int, used: set[int | None], layers: tuple[Layer, ...]) -> bool:
    """Whether a used layer is this one or below it."""
    path = layers[index].path.casefold()
    within = (number for number in used if number is not None and 0 <= number < len(layers))
    return any(f"{layers[number].path.casefold()}::".startswith(f"{path}::") for number in within)


def _taken(loaded: Loaded, cut: _Cut) -> set[UUID]:
    gone = set(cut.objects)
    kept = {record.id for place, record in enumerate(loaded.archive.objects) if place not in gone}
    return {id for id in kept if id is not None}


def _round_trip(loaded: Loaded, target: StrPath, additions: Additions, text: Told | None) -> Written:
    model, file = loaded.model, loaded.file
    if model.lost:
        raise InputError(
            model.name,
            f"holds {sum(group.count for group in model.lost)} objects that would be lost in a copy of version "
            f"{model.version}; open it in Rhino and save it as Rhino 5 or later.",
        )
    notes = warnings(model.version, additions, text=text is not None)
    dropped = [item for item in model.objects if item.own and item.marked]
    for item in dropped:
        file.Objects.Delete(item.id)
    taken = {item.Attributes.Id for item in file.Objects}
    planned = plan(additions, model.layers, taken)
    add_layers(file, planned, [layer.id for layer in model.layers])
    add_objects(file, planned)
    notes = (*model.warnings, *notes, *planned.notes)
    strings = _merged(model, text if model.version >= FIRST_WITH_TEXT else None, notes)
    for key in model.text.keys() - strings.keys():
        file.Strings.Delete(key)
    for key, value in strings.items():
        file.Strings[key] = value
    # every writing adds a line on the program to the comments at the start of the file
    file.StartSectionComments = "".join(f"{line}\n" for line in dict.fromkeys(file.StartSectionComments.splitlines()))
    data = written(file, model.version)
    put(target, data, lambda back: _check_counts(back, loaded, len(dropped), planned, strings))
    return Written(planned.ids, len(dropped), notes)


def _check_spliced(back: bytes, loaded: Loaded, cut: _Cut, planned: Plan, strings: Mapping[str, str]) -> None:
    gone = set(cut.objects)
    old = loaded.archive.objects
    before = [loaded.data[r.start : r.end] for place, r in enumerate(old) if place not in gone]
    after = [back[r.start : r.end] for r in scan(back, loaded.model.name).objects[: len(before)]]
    if before != after:
        raise _unsafe(loaded.model.name, "objects of the source differ")
    result = _check_counts(back, loaded, len(gone), planned, strings)
    if result.layers[: len(loaded.model.layers) - cut.layers] != loaded.model.layers[: -cut.layers or None]:
        raise _unsafe(loaded.model.name, "layers of the source differ")


def _check_counts(back: bytes, loaded: Loaded, dropped: int, planned: Plan, strings: Mapping[str, str]) -> Model:
    result, model = parse(back, loaded.model.name).model, loaded.model
    _check_ids(result, planned)
    expected = len(model.objects) - dropped + len(planned.objects)
    if len(result.objects) != expected or result.lost != model.lost or result.lights != model.lights:
        raise _unsafe(model.name, f"{len(result.objects)} objects instead of {expected}")
    if (result.unit, result.text, len(result.blocks)) != (model.unit, strings, len(model.blocks)):
        raise _unsafe(model.name, "units, user text or blocks differ")
    return result


def _check_new(back: bytes, name: str, planned: Plan) -> None:
    result = parse(back, name).model
    _check_ids(result, planned)
    layers = max(1, len(planned.layers))  # a file without any gets one
    if len(result.objects) != len(planned.objects) or len(result.layers) != layers:
        raise _unsafe(name, f"{len(result.objects)} objects instead of {len(planned.objects)}")


def _check_ids(result: Model, planned: Plan) -> None:
    """Every new object is there, on the layer meant for it."""
    layers = {item.id: item.layer for item in result.objects}
    for _, attributes in planned.objects:
        if layers.get(attributes.Id) != result.layers[attributes.LayerIndex].path:
            raise _unsafe(result.name, f"object {attributes.Id} is missing or on another layer")


def _unsafe(name: str, what: str) -> InputError:
    return InputError(
        name, f"the copy does not read back as intended ({what}) and was not kept; save the file again with Rhino."
    )
