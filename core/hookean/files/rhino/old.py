"""What differs in .3dm archives of version 4 and older."""

from __future__ import annotations

import re
from typing import Any
from uuid import UUID

from hookean.errors import InputError
from hookean.files.rhino.build import Additions, written
from hookean.files.rhino.geometry import Points
from hookean.files.rhino.model import rhino

FIRST_WITH_TEXT = 4  # user text of objects is not kept before

_SUFFIX = re.compile(r" \([0-9a-f]{4}\)$")


def clean_layer_names(file: Any) -> None:
    """Take the ending like " (9f38)" off names of nested layers, where writing an old archive put it.

    Old archives want every layer name once, so rhino3dm marks nested ones by a number made of their parent's
    id. It is asked for the numbers: a name that only looks the same is left alone.
    """
    marked = [layer for layer in file.Layers if layer.ParentLayerId.int and _SUFFIX.search(layer.Name or "")]
    if not marked:
        return
    suffixes = _suffixes(sorted({layer.ParentLayerId for layer in marked}))
    for layer in marked:
        suffix = suffixes.get(layer.ParentLayerId)
        while suffix and layer.Name.endswith(suffix):
            layer.Name = layer.Name[: -len(suffix)]


def warnings(version: int, additions: Additions, *, text: bool = False) -> tuple[str, ...]:
    """Warnings on writing these additions, and document text, to an old archive; raises InputError if this is
    impossible."""
    found = [
        f"a .3dm file of version {version} is rewritten as a whole: details of old objects may change and mesh "
        "coordinates are rounded to single precision; save it as Rhino 5 or later to keep them as they are."
    ]
    for place, item in enumerate(additions.objects):
        if version < 3 and (isinstance(item.geometry, (Points, rhino.PointCloud))):
            raise InputError(
                f"/objects/{place}/geometry",
                f"a .3dm file of version {version} cannot store point sets; "
                "give points, or save it as Rhino 5 or later.",
            )
    if version < FIRST_WITH_TEXT and (text or any(item.user_text for item in additions.objects)):
        what = "new objects and of the document" if text else "new objects"
        found.append(
            f"a .3dm file of version {version} cannot store user text, so that of the {what} is left out; "
            "save it as Rhino 5 or later to keep it."
        )
    return tuple(found)


def _suffixes(parents: list[UUID]) -> dict[UUID, str]:
    probe = rhino.File3dm()
    for number, parent in enumerate(parents):
        above, below = rhino.Layer(), rhino.Layer()
        above.Name, above.Id = f"above {number}", parent
        below.Name, below.ParentLayerId = f"below {number}", parent
        probe.Layers.Add(above)
        probe.Layers.Add(below)
    back = rhino.File3dm.FromByteArray(written(probe, 4))
    names = {layer.ParentLayerId: layer.Name for layer in back.Layers if layer.ParentLayerId.int}
    found = ((parent, _SUFFIX.search(name)) for parent, name in names.items())
    return {parent: match.group() for parent, match in found if match}
