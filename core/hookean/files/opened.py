"""Files opened to be moved by hand: OBJ, COMPAS JSON and scenes, told apart by their name or what they hold."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.discretize.meshes import as_mesh
from hookean.errors import InputError, refuse_pointer
from hookean.files import compas_json, obj_read
from hookean.files.drawn import Drawn, scene_of
from hookean.files.recipe_select import count, listed
from hookean.files.scene_json import parse
from hookean.scene import Scene

MODEL = b"3D Geometry File Format"
ENDINGS = ("3dm", "obj", "json")


def kind(data: bytes, name: str = "") -> str:
    """`3dm`, `obj` or `json`, by the ending of a file's name, else by how it begins. InputError for none of them."""
    ending = name.rpartition(".")[2].lower()
    if ending in ENDINGS:
        return ending
    begins = data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n")
    if begins.startswith(MODEL):
        return "3dm"
    if begins.startswith((b"{", b"[")):
        return "json"
    if any(line.split(b" ")[0] in (b"v", b"vn", b"o", b"g", b"mtllib") for line in begins.splitlines()):
        return "obj"
    raise InputError("", "is no file that can be opened; give a .3dm, .obj or .json file")


def scene_in(data: bytes, name: str = "") -> tuple[Scene, list[str]]:
    """The scene in an OBJ or JSON file, and what a person should know of it. A scene is as it says; COMPAS documents
    and OBJ are taken as drawn (see `drawn`). InputError, in OBJ with the line, in JSON with a pointer."""
    refuse_pointer(data, name)
    if kind(data, name) == "obj":
        return scene_of(obj_read.read(data))
    value = parse(data)
    if isinstance(value, dict) and ({"result", "rows"} <= value.keys() or {"status", "particles"} <= value.keys()):
        raise InputError("/", "this is a result, not a scene; give the file it came from")
    if isinstance(value, list) or compas_json.is_document(value):
        return _documents(value)
    return Scene.read(compas_json.plain_scene(value)[0]), []


def _documents(value: Any) -> tuple[Scene, list[str]]:
    """One COMPAS document, or a list of them, as drawn; a graph alone is a net of rest factor 0, as everywhere."""
    several = isinstance(value, list)
    drawn = Drawn()
    other: list[str] = []
    for i, entry in enumerate(value if several else [value]):
        pointer = f"/{i}" if several else ""
        if several and _unknown(entry):
            other.append(str(entry["dtype"])[:80])
            continue
        document = compas_json.read(entry, pointer)
        if document.kind == "graph" and not several and len(document.edges):
            scene = Scene.read(compas_json.alone(document, entry))
            held = scene.anchors[0].particles
            unheld = "no node has one edge only, so nothing is held: pin something, or it shrinks"
            return scene, [] if held is not None and len(held) else [unheld]
        _add(drawn, document, entry, pointer, other)
    if other:
        drawn.warnings.append(f"not taken of the file: {count(len(other), 'document')} of {listed(other)}")
    return scene_of(drawn)


def _add(drawn: Drawn, document: compas_json.Document, entry: Any, pointer: str, other: list[str]) -> None:
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
        whole = (lines[:, 0] != lines[:, 1]).any(axis=1) if len(lines) else np.zeros(0, bool)
        if whole.any():
            drawn.lines.append((document.name, lines[whole]))


def _unknown(entry: Any) -> bool:
    """Whether this is a document of a kind that is not read."""
    if not compas_json.is_document(entry) or not isinstance(entry["dtype"], str):
        return False
    inherited = entry.get("inheritance")
    names = [entry["dtype"], *(inherited if isinstance(inherited, list) else [])]
    return not any(isinstance(name, str) and name in compas_json.ACCEPTED for name in names)
