"""Relaxing one scene: JSON in, JSON out. Runs in a worker; no physics here."""

from __future__ import annotations

from typing import Any

from hookean.errors import InputError
from hookean.files.documents import plain
from hookean.running.run import bounded, relax
from hookean.scene.scene import Scene
from hookean.scene.text import parse
from hookean_server.http import answers, claimed
from hookean_server.workers.task import Cancelled, Clock, Done


def relax_scene(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The result of the scene in `body`.

    Options: `arrays` (`list`, `buffer` or none: as in the request), `meshes` (`plain`, `compas` or none: as in the
    request), `seconds`, the longest solve [s]. Raises InputError and pydantic's ValidationError for a faulty scene.
    """
    clock = Clock()
    value = parse(body)
    read = plain(value)
    scene = bounded(Scene.model_validate(read.scene), options["seconds"])
    if read.unheld:
        raise InputError("/", read.unheld)
    clock.lap("decode")
    result = relax(scene, cancelled=cancelled)
    result.report.warnings[:0] = read.warnings
    clock.lap("solve")
    arrays = options.get("arrays") or ("buffer" if answers.has_buffers(value) else "list")
    meshes = options.get("meshes") or ("compas" if read.documents else "plain")
    text = answers.encode(result, scene, arrays, read.documents if meshes == "compas" else None)
    clock.lap("encode")
    return Done(text, headers=claimed.headers(result, result.report.sentences()), timing=clock.parts)
