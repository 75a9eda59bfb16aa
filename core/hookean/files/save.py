"""A result written to a file by the ending of its name, and a scene read from one."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hookean.atomic_write import put
from hookean.errors import InputError
from hookean.files.exchange.write import EXCHANGED, ending_of, exchange
from hookean.running.result import Result
from hookean.running.simulation import Simulation
from hookean.scene.scene import Scene
from hookean.system.system import compile

ENDINGS = ".3dm, .json, .obj, .csv, .png, .dxf, .vtu, .inp, .ifc or .compas.json"


def save(result: Result | Simulation, path: str | os.PathLike[str]) -> list[str]:
    """Write a result to a file, or a Simulation to a .hookean file, which has its scene and its state:
    .3dm and .obj with its shape, .json with everything, .csv with a row for each element, contact with a floor
    and reaction, .png with a picture; for other programs .dxf, .vtu (ParaView), .inp (Abaqus), .ifc and .compas.json (a
    COMPAS Graph) with elements, forces, supports, loads, reactions. Returns sentences on what the file does not hold.

    Raises InputError for another ending, for a result without its scene, or where the file cannot be written.
    """
    target = Path(path)
    ending = ending_of(target)
    if isinstance(result, Simulation) != (ending == ".hookean"):
        needed = "a .hookean file holds a Simulation" if ending == ".hookean" else "save it in a .hookean file"
        raise InputError(target.name or str(path), f"{type(result).__name__} given; {needed}")
    if isinstance(result, Simulation):
        from hookean.files import project

        project.save(result, target)
        return []
    if ending not in ENDINGS.replace(",", "").replace(" or ", " ").split():
        raise InputError(target.name or str(path), f"has an unknown ending; end the name in {ENDINGS}")
    if ending == ".png":
        from hookean.pictures.picture import render

        render(result, target, scene=result.scene)
        return []
    if result.scene is None:
        raise InputError("result", "has no scene, which writing a file needs; save a result of relax or simulate")
    if ending in EXCHANGED:
        return exchange(result, target)
    from hookean.files.readers import Source
    from hookean.files.relax_file import check_output, conclude

    check_output(None if ending == ".csv" else target, Path("result.json"))
    read = Source(result.scene, [], unit=str(result.units.length))
    table = ending == ".csv"
    found = conclude(read, Path("result"), compile(result.scene), result, None if table else target)
    if table:
        put(target, found.csv.encode(), lambda back: None)
    return found.unwritten


def open(path: str | os.PathLike[str], recipe: str | os.PathLike[str] | Mapping[str, Any] | None = None) -> Scene:
    """The scene in a .3dm, .obj, .json, .npz or .hookean file; of a .3dm by a recipe: a file, its text
    (TOML or JSON) or its tables; without one by layer names. Raises InputError where the file or
    the recipe has a fault."""
    from hookean.files.readers import read_path

    if isinstance(recipe, Mapping):
        import json

        return read_path(Path(path), (json.dumps(recipe), "recipe")).scene
    if recipe is None:
        return read_path(Path(path)).scene
    text = os.fspath(recipe)
    if "\n" in text or "=" in text or text.lstrip().startswith("{"):
        return read_path(Path(path), (text, "recipe")).scene
    from hookean.atomic_write import read_bytes

    place = Path(text)
    try:
        text = read_bytes(place, place.name).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(place.name, "is not UTF-8 text; save it as UTF-8") from None
    return read_path(Path(path), (text, place.name)).scene
