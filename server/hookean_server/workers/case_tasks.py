"""Load cases in three kinds of tasks: freezing the form, one case each, and their envelope. They run in workers.

Between them goes JSON, a line each: the head (names and notes), the form's result, the elastic model.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from hookean.analysis.envelope import envelope
from hookean.analysis.freezing import Frozen, freeze
from hookean.analysis.load_cases import solve_case, wanted
from hookean.errors import InputError
from hookean.scene.scene import Scene
from hookean.values.columns import Model
from hookean.values.fields import Field
from hookean.values.units import Units
from hookean_server.http import answers
from hookean_server.workers.analysis_task import placed, request
from hookean_server.workers.task import Cancelled, Clock, Done


class Cases(Model):
    """Which cases."""

    cases: tuple[str, ...] | None = Field(default=None, description="Load cases and combinations by name; null: all")


def freeze_form(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The form of the scene in `body`, frozen: three lines of JSON, see the head of this file."""
    clock = Clock()
    scene, given = request(body, Cases, options["seconds"])
    try:
        names = wanted(scene, given.cases)
        frozen = freeze(scene)
    except InputError as error:
        raise InputError(placed(error.pointer), error.sentence) from None
    assert frozen.form is not None
    clock.lap("form")
    head = {"names": names, "notes": list(frozen.notes), "units": scene.units.model_dump()}
    model = {
        "scene": frozen.scene.model_dump(mode="json"),
        "particles": frozen.particles,
        "rotations": frozen.rotations,
        "lines": [
            {"force": number, "length": frozen.lengths[number], "tension": tension}
            for number, tension in frozen.tensions.items()
        ],
        "cloth": [{"force": number, "stress": stress} for number, stress in frozen.cloth.items()],
        "slides": list(frozen.slides.items()),
        "expansions": list(frozen.expansions.items()),
        "temperatures": list(frozen.temperatures.items()),
    }
    lines = json.dumps(head).encode(), answers.dump(frozen.form.to_dict(), "list"), answers.dump(model, "list")
    return Done(b"\n".join(lines), timing=clock.parts)


def solve_one(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The case `options["name"]` of the elastic model in `body`."""
    clock = Clock()
    value = json.loads(body)
    lines = value["lines"]
    frozen = Frozen(
        Scene.model_validate(value["scene"]),
        np.array(value["particles"], dtype=float).reshape(-1, 3),
        lengths={line["force"]: np.array(line["length"], dtype=float) for line in lines},
        tensions={line["force"]: np.array(line["tension"], dtype=float) for line in lines},
        cloth={part["force"]: np.array(part["stress"], dtype=float).reshape(-1, 3) for part in value["cloth"]},
        slides={number: (whole, strain) for number, (whole, strain) in value["slides"]},
        expansions=dict(value["expansions"]),
        temperatures={number: np.array(own, dtype=float) for number, own in value["temperatures"]},
        rotations=np.array(value["rotations"], dtype=float).reshape(-1, 4),
    )
    try:
        found = solve_case(frozen, options["name"])
    except InputError as error:
        raise InputError(placed(error.pointer), error.sentence) from None
    clock.lap("case")
    return Done(answers.dump(found.to_dict(), "list"), timing=clock.parts)


def gather_cases(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The answer of all cases: `body` has the head, the form's result and a line for each case."""
    clock = Clock()
    head, form, *cases = (json.loads(line) for line in body.split(b"\n"))
    shown = {
        case["name"]: (
            case["result"]["forces"],
            case["result"]["reactions"],
            np.array(case["displacements"], dtype=float).reshape(-1, 3),
        )
        for case in cases
    }
    found = {
        "form": form,
        "notes": head["notes"],
        "cases": cases,
        "envelope": envelope(shown, Units.model_validate(head["units"])).to_dict(),
        "units": head["units"],
    }
    clock.lap("envelope")
    return Done(answers.dump(found, "list"), timing=clock.parts)
