"""A model as one file, .hookean: its scene, its state, how it was looked at, and variants of it.

A zip archive that is not compressed, so nothing read from it is larger than the file. `hookean.json` comes first and
names the format; `scene.json` is the scene with all edits, for people and other programs; `simulation.npz` is what
`Simulation.save` writes; `view.json` is any JSON object; `variants/0.npz` and so on are simulations, whose names are in
`hookean.json`.
"""

from __future__ import annotations

import io
import json
import os
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hookean.errors import InputError
from hookean.files import saved
from hookean.running.simulation import Simulation

ENDING = ".hookean"
FIRST = "hookean.json"
VERSION = 1
MOST_VARIANTS = 100
OPENED = (1980, 1, 1, 0, 0, 0)  # the same model gives the same bytes


@dataclass(eq=False)
class Project:
    """What a .hookean file has."""

    simulation: Simulation
    view: dict[str, Any] = field(default_factory=dict)
    variants: dict[str, Simulation] = field(default_factory=dict)


def begins(data: bytes) -> bool:
    """Whether a file that begins with these bytes is a .hookean file: the name of its first part follows the 30 bytes
    of a zip header."""
    return data.startswith(saved.BEGINS) and data[30:].startswith(FIRST.encode())


def write(project: Project) -> bytes:
    """The bytes of a .hookean file. InputError for more than 100 variants."""
    if len(project.variants) > MOST_VARIANTS:
        raise InputError("variants", f"{len(project.variants)} given; a file holds at most {MOST_VARIANTS}")
    head = {"format": "hookean", "version": VERSION, "variants": list(project.variants)}
    parts = {
        FIRST: json.dumps(head).encode(),
        "scene.json": project.simulation.edited_scene().canonical.encode(),
        "simulation.npz": _saved(project.simulation),
        "view.json": json.dumps(project.view, sort_keys=True).encode(),
    }
    parts.update({f"variants/{i}.npz": _saved(one) for i, one in enumerate(project.variants.values())})
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as file:
        for name, data in parts.items():
            file.writestr(zipfile.ZipInfo(name, OPENED), data)
    return stream.getvalue()


def read(data: bytes, where: str = "") -> Project:
    """The project in the bytes of a file; InputError, at `where`, if it is damaged, compressed or newer than this."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as file:
            infos = {info.filename: info for info in file.infolist()}
            if any(info.compress_type != zipfile.ZIP_STORED for info in infos.values()):
                raise InputError(where, "compressed; save the model again, a .hookean file is not compressed")
            head = _object(file.read(FIRST), where, FIRST)
            _check(head, where)
            view = _object(file.read("view.json"), where, "view.json") if "view.json" in infos else {}
            simulation = saved.read(file.read("simulation.npz"), f"{where} simulation.npz".strip())
            variants = {
                name: saved.read(file.read(f"variants/{i}.npz"), f"{where} variants/{i}.npz".strip())
                for i, name in enumerate(head.get("variants", []))
            }
    except (zipfile.BadZipFile, KeyError, MemoryError, OSError, NotImplementedError, RuntimeError):
        raise InputError(where, "damaged, or not a .hookean file; save the model again") from None
    return Project(simulation, view, variants)


def save(simulation: Simulation, path: str | os.PathLike[str], view: Mapping[str, Any] | None = None) -> None:
    """Write a simulation to a .hookean file, whole or not at all. InputError where it cannot be written."""
    from pathlib import Path

    from hookean.atomic_write import put

    put(Path(path), write(Project(simulation, dict(view or {}))), lambda back: None)


def _saved(simulation: Simulation) -> bytes:
    stream = io.BytesIO()
    simulation.save(stream)
    return stream.getvalue()


def _object(data: bytes, where: str, name: str) -> dict[str, Any]:
    try:
        value = json.loads(data)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise InputError(where, f"damaged: {name} is not a JSON object; save the model again")
    return value


def _check(head: dict[str, Any], where: str) -> None:
    """Whether this version of hookean reads it."""
    if head.get("format") != "hookean" or not isinstance(version := head.get("version"), int):
        raise InputError(where, f"damaged: {FIRST} does not name the format; save the model again")
    if version > VERSION:
        raise InputError(where, f"of version {version}, which a newer hookean wrote; up to {VERSION} is read here")
    names = head.get("variants", [])
    if not isinstance(names, list) or len(names) > MOST_VARIANTS or not all(isinstance(n, str) for n in names):
        raise InputError(where, f"damaged: the variants in {FIRST} are not a list of names; save the model again")
