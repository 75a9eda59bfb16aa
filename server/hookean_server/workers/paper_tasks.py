"""What leaves for others: the report of a scene, and its result as a file for another program. They run in workers."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, Literal

from hookean.analysis.load_cases import load_cases
from hookean.errors import InputError
from hookean.files.exchange.write import exchange
from hookean.files.report import report
from hookean.running.result import Result
from hookean.running.run import relax
from hookean.scene.scene import Scene
from hookean.values.columns import Model
from hookean.values.fields import Field
from hookean_server.workers.analysis_task import placed, request
from hookean_server.workers.task import Cancelled, Clock, Done


class Report(Model):
    """What a report has."""

    title: str = Field(default="Report", max_length=200, description="Title of the report")
    pictures: bool = Field(default=True, description="Whether there is a picture of the form and of each case")


class Export(Model):
    """Which file, and of what."""

    format: Literal["dxf", "vtu", "inp", "ifc", "compas.json"] = Field(description="Ending of the file")
    case: str | None = Field(default=None, description="Load case or combination by name; null: the relaxed scene")


MEDIA = {"dxf": "image/vnd.dxf", "ifc": "application/x-step", "compas.json": "application/json"}
"""Media types of files by their ending; others are plain bytes."""


def write_report(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The report of the scene in `body` as one HTML page."""
    clock = Clock()
    scene, given = request(body, Report, None)  # as given: the report has the digest of the scene
    clock.lap("decode")
    try:
        page = report(scene, **given.model_dump())
    except InputError as error:
        raise InputError(placed(error.pointer), error.sentence) from None
    clock.lap("report")
    return Done(page.encode(), "text/html; charset=utf-8", timing=clock.parts)


def write_export(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The result of the scene in `body`, relaxed or under a load case, as a file for another program."""
    clock = Clock()
    scene, given = request(body, Export, options["seconds"])
    clock.lap("decode")
    name = f"result.{given.format}"
    with tempfile.TemporaryDirectory(prefix="hookean-") as folder:
        target = Path(folder) / name
        try:
            exchange(_result(scene, given.case), target)
        except InputError as error:
            raise InputError(placed(error.pointer), error.sentence.replace(folder, "")) from None
        data = target.read_bytes()
    clock.lap("export")
    named = {"content-disposition": f'attachment; filename="{name}"'}
    return Done(data, MEDIA.get(given.format, "application/octet-stream"), named, clock.parts)


def _result(scene: Scene, case: str | None) -> Result:
    """The relaxed scene, or that of a case; InputError where it has no result to write."""
    if case is not None:
        return load_cases(scene, [case]).cases[case].result
    found = relax(scene)
    if not found.converged:
        raise InputError("model", f"is not in equilibrium: {found.message}")
    return found
