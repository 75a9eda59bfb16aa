"""What workers do for jobs of design: check a problem, search, show the best shape so far. Pure functions of bytes.

A request, as it is kept, is JSON: {"scene": ..., "design": {"variables", "goals", "constraints", "settings"}}. Its item
is a row, a line feed and the whole answer; a checkpoint is an array: the count of equilibria, and the best values.
"""

from __future__ import annotations

import io
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import Design, DesignStatus, once
from hookean.designing.checks import checked
from hookean.designing.search import design
from hookean.designing.sensitivity import sensitivity
from hookean.errors import InputError
from hookean.running.run import bounded
from hookean.running.sweep import columns, figures
from hookean.scene.scene import Scene, Settings
from hookean.scene.text import parse
from hookean.system.system import compile
from hookean_server.http import answers
from hookean_server.problems import faulty
from hookean_server.workers.analysis_task import read_scene
from hookean_server.workers.task import Cancelled, Clock, Done

OFTEN, KEEP = 0.2, 1.0  # seconds between words on a search, and between its checkpoints
FIELDS = ("scene", "variables", "goals", "constraints", "settings", "start")
LARGEST = 5_000_000  # numbers in an answer


def split(value: Any) -> dict[str, Any]:
    """The request, as it is kept, of a body that is a problem."""
    if not isinstance(value, dict):
        raise InputError("/", "an object with a scene, variables and goals is expected")
    for name in value:
        if name not in FIELDS:
            raise InputError(f"/{name}", f"unknown field; known: {', '.join(FIELDS)}")
    if "scene" not in value:
        raise InputError("/scene", "this is required")
    return {"scene": value["scene"], "design": {name: item for name, item in value.items() if name != "scene"}}


def about(scene: Scene, given: Any, prefix: str) -> dict[str, Any]:
    """What a job's table says of a problem that fits its scene. Faults have pointers behind `prefix`."""
    if not isinstance(given, dict):
        raise InputError(prefix or "/", "an object with variables and goals is expected")
    if "scene" in given:
        raise InputError(f"{prefix}/scene", "the scene belongs beside the design")
    try:
        search = checked({**{name: part for name, part in given.items() if name != "start"}, "scene": scene})
        if given.get("start") is not None:
            search.unknowns.begin(given["start"])
    except InputError as error:
        raise faulty(
            "invalid-input", [InputError(_under(prefix, f.pointer), f.sentence) for f in error.faults]
        ) from None
    return {
        "kind": "design",
        "total": 1,
        "names": search.unknowns.names,
        "columns": [("objective", ""), *columns(scene)],
    }


def _under(prefix: str, pointer: str) -> str:
    if pointer.startswith("/scene") or not prefix:
        return pointer
    return prefix + (pointer if pointer.startswith("/") else f"/{pointer}").rstrip("/")


def search(options: dict[str, Any], body: bytes, link: Any) -> Done:
    """Search the values of a request's problem, from the best ones behind it where there are some; reports progress."""
    problem, settings, kept = _problem(body, options)
    count, start = _unpacked(kept)
    teller = _Teller(count, getattr(link, "say", None), link, options["seconds"])
    found = design(problem, progress=teller.progress, cancelled=teller.cancelled, start=start, keep=teller.keep)
    if teller.late and found.status is DesignStatus.CANCELLED:
        found.message = f"Stopped after {options['seconds']:g} s, the longest time of a job; this is the best so far."
    found.scene = found.scene.replaced(settings=settings)
    return Done(_item(found))


def shape(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The item as its last checkpoint has it. `status` and `message` are given."""
    problem, settings, kept = _problem(body, options)
    count, start = _unpacked(kept)
    first: list[bool] = []

    def second() -> bool:
        first.append(True)
        return len(first) > 1

    found = design(problem, cancelled=second, start=start)
    found.scene = found.scene.replaced(settings=settings)
    found.message, found.iterations = options["message"], count
    answer = {**found.to_dict(), "status": options["status"]}
    return Done(b"\n" + answers.dump(answer, "list"))


def differentiate(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """Value and gradient of the goals of a body, at the equilibrium of its scene."""
    clock = Clock()
    request = split(parse(body))
    scene = bounded(read_scene(request["scene"]), options["seconds"])
    clock.lap("decode")
    given = request["design"]
    unused = [name for name in ("constraints", "settings", "start") if name in given]
    if unused:
        raise InputError(f"/{unused[0]}", "a sensitivity has goals and variables only")
    found = sensitivity({"variables": (), **given, "scene": scene})
    if sum(each.size for each in found.gradient) > LARGEST:
        raise InputError("/variables", f"the answer would have more than {LARGEST:,} numbers; tie the elements")
    clock.lap("differentiate")
    text = answers.dump({**found.to_dict(), "gradient": found.gradient}, options.get("arrays") or "list")
    clock.lap("encode")
    return Done(text, timing=clock.parts)


def _problem(body: bytes, options: dict[str, Any]) -> tuple[dict[str, Any], Settings, bytes]:
    """The problem of a request, with a limit of time for each solve; the settings without it; what is behind it."""
    request = parse(body[: options["size"]])
    given = Scene.model_validate(request["scene"])
    scene = bounded(given, min(options["seconds"], options["longest"]))
    problem = {**request["design"], "scene": scene}
    start = problem.pop("start", None)
    kept = body[options["size"] :]
    return problem, given.settings, kept or (b"" if start is None else _packed(0, np.asarray(start, dtype=np.float64)))


class _Teller:
    """Reports equilibria and the best objective to the server a few times a second, and once a second its values."""

    def __init__(self, count: int, say: Callable[..., None] | None, link: Cancelled, seconds: float) -> None:
        self.count, self.say, self.link, self.seconds = count, say, link, seconds
        self.began = self.said = self.kept = time.monotonic()
        self.best: NDArray[np.float64] | None = None
        self.late = False

    def cancelled(self) -> bool:
        """Whether the search should end."""
        self.late = time.monotonic() > self.began + self.seconds
        return self.late or self.link()

    def keep(self, values: NDArray[np.float64]) -> None:
        """The best values so far."""
        self.best = values

    def progress(self, iteration: int, objective: float) -> None:
        """One equilibrium of the search."""
        now = time.monotonic()
        if self.say is None or now < self.said + OFTEN or not np.isfinite(objective):
            return
        self.said = now
        data = b""
        if now >= self.kept + KEEP and self.best is not None:
            self.kept, data = now, _packed(self.count + iteration, self.best)
        self.say({"iteration": self.count + iteration, "objective": float(objective)}, data)


def _item(found: Design) -> bytes:
    scene = found.scene
    names = once(entry["name"] for entry in found.variables)
    values = dict(zip(names, (entry["value"] for entry in found.variables), strict=True))
    row = {"number": 0, "parameters": values, **figures(found.result, compile(scene))}
    row.update(status=str(found.status), message=found.message, iterations=found.iterations, objective=found.objective)
    return answers.dump(row, "list") + b"\n" + answers.dump(found.to_dict(), "list")


def _packed(count: int, values: NDArray[np.float64]) -> bytes:
    stream = io.BytesIO()
    np.save(stream, np.concatenate([[float(count)], values]), allow_pickle=False)
    return stream.getvalue()


def _unpacked(kept: bytes) -> tuple[int, NDArray[np.float64] | None]:
    """The count of equilibria and the best values of a checkpoint, if there is one."""
    if not kept:
        return 0, None
    values = np.load(io.BytesIO(kept), allow_pickle=False)
    return int(values[0]), values[1:]
