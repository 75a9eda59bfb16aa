"""What workers can do, by name, and how their failures become problems. Runs in a worker."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from hookean_server.workers.channel import problem_of
from hookean_server.workers.task import Cancelled, Done

log = logging.getLogger("hookean.worker")


def perform(request: dict[str, Any], body: bytes, cancelled: Cancelled) -> tuple[dict[str, Any], bytes]:
    """Do `request["task"]` on `body`; a JSON head and the answer's body. Never raises."""
    options = request["options"]
    slug = "invalid-scene" if request["task"] == "relax" else "invalid-input"
    try:
        done = _tasks()[request["task"]](options, body, cancelled)
    except Exception as error:
        return problem_of(error, slug, request["task"], log).to_wire(), b""
    return {"type": done.media_type, "headers": done.headers, "timing": done.timing}, done.body


def _tasks() -> dict[str, Callable[[dict[str, Any], bytes, Cancelled], Done]]:
    from hookean_server.hops import functions
    from hookean_server.jobs import designs, work
    from hookean_server.workers import (
        analysis_task,
        case_tasks,
        discretize_task,
        example_task,
        family_task,
        file_tasks,
        paper_tasks,
        relax_task,
    )

    return {
        "relax": relax_task.relax_scene,
        "analyse": analysis_task.analyse,
        "freeze": case_tasks.freeze_form,
        "case": case_tasks.solve_one,
        "cases": case_tasks.gather_cases,
        "report": paper_tasks.write_report,
        "export": paper_tasks.write_export,
        "discretize": discretize_task.discretize,
        "hops": functions.solve,
        "file": file_tasks.relax_upload,
        "scene": file_tasks.scene_upload,
        "geometry": file_tasks.geometry_upload,
        "recipe": file_tasks.recipe_upload,
        "example": example_task.read_example,
        "family": family_task.make_family,
        "job": work.check,
        "batch": work.batch,
        "item": work.item,
        "relaxation": work.relaxation,
        "shape": work.shape,
        "design": designs.search,
        "design shape": designs.shape,
        "sensitivity": designs.differentiate,
    }
