"""What a JSON file or body holds, as a scene's plain values: a scene, COMPAS documents inside it, or documents alone.

A Mesh or a Graph alone is a net of rest factor 0 along its edges, its vertices in their order; other documents, and
several in a list, are taken as drawn (see `drawn`).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from hookean.errors import InputError
from hookean.files import compas_json, compas_write
from hookean.files.compas_json import Document

if TYPE_CHECKING:
    from hookean.files.drawn import Drawn


@dataclass(frozen=True, eq=False)
class Plain:
    """`scene` as `Scene.model_validate` takes it; `documents` that come back moved, by a mesh's name or a geometry's
    number; `whole` the Mesh or Graph that is all there is; `stored` is true where the scene is the one that hookean
    stored in it. `warnings` on what was left out, `unheld` a sentence where nothing is held and all of it shrinks."""

    scene: Any
    documents: dict[str | int, Document] = field(default_factory=dict)
    whole: Document | None = None
    stored: bool = False
    warnings: tuple[str, ...] = ()
    unheld: str = ""


def plain(value: Any) -> Plain:
    """JSON values without COMPAS documents. InputError with a pointer where one of them is not as COMPAS writes it, or
    documents alone hold nothing to relax."""
    if isinstance(value, dict) and ({"result", "rows"} <= value.keys() or {"status", "particles"} <= value.keys()):
        raise InputError("/", "is a result, not a scene; give the input file of that run")
    if isinstance(value, list):
        return _drawn(value)
    if not compas_json.is_document(value):
        scene, documents, _ = compas_json.plain_scene(value)
        return Plain(scene, documents)
    document = compas_json.read(value)
    scene, why = compas_write.stored(value, document)
    if scene is not None:
        return Plain(scene, whole=document, stored=True)
    if document.kind == "mesh" and document.faces or document.kind == "graph" and len(document.edges):
        scene = compas_json.alone(document, value)
        where = "a closed mesh has no naked vertices" if document.kind == "mesh" else "no node has one edge only"
        unheld = "" if scene["anchors"] else f"{where}, so nothing is held: pin some of it, or it shrinks"
        return Plain(scene, {0: document}, document, warnings=why, unheld=unheld)
    return _drawn([value], why, alone=True)


def drawn(value: Any) -> Drawn | None:
    """What COMPAS documents alone hold, as drawn; None for a scene, or a document in which hookean stored one.
    InputError as `plain`."""
    if isinstance(value, list):
        return _taken_together(value)
    if not compas_json.is_document(value):
        plain(value)
        return None
    if compas_write.stored(value, compas_json.read(value))[0] is not None:
        return None
    return _taken_together([value], alone=True)


def _drawn(entries: list[Any], why: tuple[str, ...] = (), *, alone: bool = False) -> Plain:
    """Documents as drawn."""
    # what draws loads rhino3dm, which scenes need not
    from hookean.files.drawn import tables_of

    scene, warnings, unheld = tables_of(_taken_together(entries, alone=alone))
    return Plain(scene, warnings=(*why, *warnings), unheld=unheld)


def _taken_together(entries: list[Any], *, alone: bool = False) -> Drawn:
    from hookean.files.drawn import Drawn
    from hookean.files.recipe.select import count, listed

    found = Drawn()
    other: list[str] = []
    for i, entry in enumerate(entries):
        pointer = "" if alone else f"/{i}"
        if not alone and _unknown(entry):
            other.append(str(entry["dtype"])[:80])
        else:
            _add(found, compas_json.read(entry, pointer), entry, pointer, other)
    if other:
        found.warnings.append(f"not read from the file: {count(len(other), 'document')} of {listed(other)}")
    return found


def _add(drawn: Drawn, document: Document, entry: Any, pointer: str, other: list[str]) -> None:
    from hookean.discretize.meshes import as_mesh
    from hookean.files.recipe.select import count

    if document.kind == "mesh":
        sides = sum(len(face) > 4 for face in document.faces)
        if sides:
            drawn.warnings.append(f"{count(sides, 'face')} of more than four corners cut into triangles")
        plain = compas_json.plain_mesh(entry, pointer)[1]
        if len(plain["faces"]):
            drawn.meshes.append((document.name, as_mesh((plain["vertices"], plain["faces"]))))
    elif document.kind in ("point", "pointcloud"):
        drawn.points.append((document.name, document.points))
    elif document.kind == "vector":
        other.append(str(entry["dtype"]))
    else:
        lines = document.lines
        whole = (lines[:, 0] != lines[:, 1]).any(axis=1)
        if whole.any():
            drawn.lines.append((document.name, lines[whole]))


def _unknown(entry: Any) -> bool:
    """Whether this is a document of a kind that is not read."""
    if not compas_json.is_document(entry) or not isinstance(entry["dtype"], str):
        return False
    inherited = entry.get("inheritance")
    names = [entry["dtype"], *(inherited if isinstance(inherited, list) else [])]
    return not any(isinstance(name, str) and name in compas_json.ACCEPTED for name in names)
