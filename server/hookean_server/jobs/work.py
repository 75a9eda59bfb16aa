"""What workers do for jobs: check one, solve items of a sweep, relax for as long as it takes. Pure functions of bytes.

A request, as it is kept, is JSON: {"scene": ..., "sweep": ... or null}, or as `designs` has it. A row is one line of
JSON.
"""

from __future__ import annotations

import hashlib
import io
import json
import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from hookean.errors import InputError
from hookean.files.documents import plain
from hookean.running.patch import Patch, apply
from hookean.running.result import Result, Status, gather
from hookean.running.run import bounded, relax_state
from hookean.running.sweep import Sweep, Table, columns, figures, parameters
from hookean.scene.scene import Scene
from hookean.scene.text import parse
from hookean.solvers import Solver, solver
from hookean.system.balance import balance
from hookean.system.state import State
from hookean.system.system import System, compile
from hookean.values.faults import faults
from hookean_server.http import answers
from hookean_server.jobs import designs
from hookean_server.problems import faulty
from hookean_server.workers.task import Cancelled, Done

log = logging.getLogger("hookean.worker")

BATCH = 0.25  # seconds after which a batch is handed back, however much of it is done
OFTEN, KEEP = 0.2, 1.0  # seconds between words on a relaxation, and between its checkpoints
CACHED = 4  # scenes that stay compiled
_local = threading.local()


def check(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """A request as it is kept, checked up to its first item; the header `about` describes its table."""
    value = parse(body)
    if options.get("kind") == "design":
        return _design(designs.split(value), "")
    if not isinstance(value, dict):
        raise InputError("/", "an object with a scene, and optionally a sweep or a design, is expected")
    for name in value:
        if name not in ("scene", "sweep", "design"):
            raise InputError(f"/{name}", "unknown field; known: scene, sweep, design")
    if "scene" not in value:
        raise InputError("/scene", "this is required")
    if value.get("design") is not None:
        if value.get("sweep") is not None:
            raise InputError("/sweep", "give either a sweep or a design")
        return _design(value, "/design")
    system, plain = _scene(value["scene"])
    scene = system.scene
    total, names = 1, []
    if value.get("sweep") is not None:
        sweep = _placed("/sweep", Sweep.read, value["sweep"])
        if sweep.count > options["items"]:
            raise InputError("/sweep", f"{sweep.count} items; this service takes at most {options['items']}")
        total, names = sweep.count, sweep.names
        _placed("/sweep", _first, scene, sweep)
    about = {"kind": "sweep" if value.get("sweep") is not None else "relaxation", "total": total, "names": names}
    about["columns"] = columns(scene)
    about["warnings"] = [*system.report.left_out(), *system.report.warnings]
    kept = answers.dump({"scene": plain, "sweep": value.get("sweep")}, "list")
    return Done(kept, headers={"about": json.dumps(about)})


def _design(value: dict[str, Any], prefix: str) -> Done:
    """A request of a design, checked at the drawn shape; its faults are behind `prefix`."""
    system, plain = _scene(value["scene"])
    about = designs.about(system.scene, value["design"], prefix)
    about["warnings"] = [*system.report.left_out(), *system.report.warnings]
    kept = answers.dump({"scene": plain, "design": value["design"]}, "list")
    return Done(kept, headers={"about": json.dumps(about)})


def _scene(value: Any) -> tuple[System, Any]:
    """The system of a scene, and its JSON without documents; its faults are those of an invalid scene, under /scene."""
    found: list[InputError]
    try:
        read = plain(value)
        scene = Scene.model_validate(read.scene)
        if read.unheld:
            raise InputError("/", read.unheld)
        system = compile(scene)
        refusal = solver(scene.settings.solver).refuse(system)
        if refusal:
            raise InputError("/settings/solver", refusal)
        return system, read.scene
    except InputError as error:
        found = list(error.faults)
    except ValidationError as error:
        found = faults(error)
    raise faulty("invalid-scene", [InputError(_under("/scene", f.pointer), f.sentence) for f in found])


def _first(scene: Scene, sweep: Sweep) -> None:
    """Try the patch of the first item, without solving."""
    system = compile(scene)
    apply(system, system.start(), Patch.read(sweep.patch(0)))


def _placed(pointer: str, function: Callable[..., Any], *given: Any) -> Any:
    try:
        return function(*given)
    except InputError as error:
        raise InputError(_under(pointer, error.pointer), error.sentence) from None


def _under(pointer: str, rest: str) -> str:
    return pointer if rest in ("", "/") else pointer + (rest if rest.startswith("/") else f"/{rest}")


# sweeps


def batch(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """Rows of the items `numbers`, as many as are done in a quarter of a second, one at least."""
    return Done(b"\n".join(solve(body, options["numbers"], options["seconds"], cancelled)))


def solve(request: bytes, numbers: Sequence[int], seconds: float, cancelled: Cancelled | None = None) -> list[bytes]:
    """Rows of items, in their order, as many as are done in a quarter of a second, one at least; none if cancelled.
    `seconds`: the longest solve of one. The same bytes wherever it runs."""
    table, sweep = _compiled(request, seconds)
    began = time.monotonic()
    rows: list[bytes] = []
    for number in numbers:
        row = _row(table, sweep, number, seconds, cancelled)
        if row["status"] == Status.CANCELLED:
            break
        rows.append(json.dumps(row, separators=(",", ":"), allow_nan=False).encode())
        if time.monotonic() - began > BATCH:
            break
    return rows


def failed(request: bytes, number: int, message: str) -> bytes:
    """The row of an item that could not be solved."""
    sweep = json.loads(request)["sweep"]
    given = parameters(Sweep.read(sweep).patch(number)) if sweep is not None else {}
    return json.dumps(_failed(number, given, message), separators=(",", ":")).encode()


def _failed(number: int, given: dict[str, Any], message: str) -> dict[str, Any]:
    return {"number": number, "parameters": given, "status": "failed", "message": message}


def _row(table: Table, sweep: Sweep, number: int, seconds: float, cancelled: Cancelled | None) -> dict[str, Any]:
    patch = sweep.patch(number)
    given = parameters(patch)
    try:
        result = table.result(_within(patch, seconds), cancelled)
    except InputError as error:
        return _failed(number, given, str(error))
    except MemoryError:
        return _failed(number, given, "This needs more memory than one worker may use.")
    except Exception:
        log.exception("an item of a sweep failed")
        return _failed(number, given, "Internal error on this item; the log of the service has the details.")
    return {"number": number, "parameters": given, **figures(result, table.system)}


def _within(patch: dict[str, Any], seconds: float) -> dict[str, Any]:
    """The patch with a time limit of at most `seconds`."""
    settings = patch.get("settings", {})
    limit = settings.get("time_limit") if isinstance(settings, dict) else None
    if not isinstance(limit, int | float) or limit <= seconds:
        return patch
    return {**patch, "settings": {**settings, "time_limit": seconds}}


def _compiled(request: bytes, seconds: float) -> tuple[Table, Sweep]:
    """Scene and sweep of a request; compiled ones are kept, those of each thread its own."""
    kept: OrderedDict[bytes, tuple[Table, Sweep]] = _local.__dict__.setdefault("kept", OrderedDict())
    key = hashlib.sha256(request).digest() + repr(seconds).encode()
    if key not in kept:
        value = parse(request)
        sweep = Sweep.read(value["sweep"] if value["sweep"] is not None else {"patches": [{}]})
        kept[key] = Table(bounded(Scene.model_validate(value["scene"]), seconds)), sweep
        while len(kept) > CACHED:
            kept.popitem(last=False)
    kept.move_to_end(key)
    return kept[key]


def item(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The whole result of one item, solved once more: the same bits as in its row."""
    table, sweep = _compiled(body, options["seconds"])
    result = table.result(_within(sweep.patch(options["number"]), options["seconds"]), cancelled)
    return Done(answers.encode(result, table.system.scene, "list", None))


# long relaxations


def relaxation(options: dict[str, Any], body: bytes, link: Any) -> Done:
    """Relax the scene of a request, from the state behind it where there is one; reports progress.

    The answer is a row, a line feed and the whole result; of one that was cancelled, which is in a hurry, its state.
    """
    request, kept = body[: options["size"]], body[options["size"] :]
    scene = bounded(Scene.model_validate(parse(request)["scene"]), options["seconds"])
    system = compile(scene)
    state = _state(kept, system)
    left = max(0, scene.settings.max_iterations - state.iteration)
    system.scene = scene.replaced(settings=scene.settings.replaced(max_iterations=left))
    method = solver(scene.settings.solver)
    _look_often(method, system)
    teller = _Teller(state, getattr(link, "say", None))
    result = relax_state(system, state, method, teller.progress, link)
    if result.status is Status.CANCELLED:
        return Done(_line(result, system) + _state_bytes(state))
    return Done(_relaxed(result, system))


class _Teller:
    """Reports iteration and residual to the server a few times a second, and once a second the state."""

    def __init__(self, state: State, say: Callable[..., None] | None) -> None:
        self.state, self.say = state, say
        self.said = self.kept = time.monotonic()

    def progress(self, iteration: int, residual: float) -> None:
        """One look of the run."""
        now = time.monotonic()
        if self.say is None or now < self.said + OFTEN or not np.isfinite(residual):
            return
        self.said = now
        data = b""
        if now >= self.kept + KEEP and np.isfinite(self.state.x).all() and np.isfinite(self.state.v).all():
            self.kept, data = now, _state_bytes(self.state)
        self.say({"iteration": iteration, "residual": float(residual), "time": self.state.time}, data)


def shape(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """Row and whole result of a relaxation as its last checkpoint has it. `status` and `message` are given."""
    request, kept = body[: options["size"]], body[options["size"] :]
    system = compile(Scene.model_validate(parse(request)["scene"]))
    state = _state(kept, system)
    method = solver(system.scene.settings.solver)
    found = balance(system, state)
    result = gather(
        system, state, found, None, Status(options["status"]), options["message"], method.name, moving=method.physical
    )
    return Done(_relaxed(result, system))


def _line(result: Result, system: System) -> bytes:
    row = {"number": 0, "parameters": {}, **figures(result, system)}
    return json.dumps(row, separators=(",", ":"), allow_nan=False).encode() + b"\n"


def _relaxed(result: Result, system: System) -> bytes:
    return _line(result, system) + answers.encode(result, system.scene, "list", None)


def _look_often(method: Solver, system: System) -> None:
    """Let a run be looked at each half second or so, however long it takes. By the size of the system, not the clock:
    the numbers stay the same."""
    size = sum(group.block.indices.size for group in system.groups)
    longest = min(method.longest, max(25, 10 * (8_000_000 // (size + 4_000))))
    vars(method)["longest"] = longest


def _state_bytes(state: State) -> bytes:
    stream = io.BytesIO()
    arrays: dict[str, Any] = state.arrays()
    np.savez(stream, allow_pickle=False, **arrays)
    return stream.getvalue()


def _state(kept: bytes, system: System) -> State:
    """The state of a checkpoint, or the start."""
    start = system.start()
    if not kept:
        return start
    with np.load(io.BytesIO(kept), allow_pickle=False) as file:
        arrays: dict[str, NDArray[Any]] = {name: file[name] for name in file.files}
    state = State.of(arrays)
    return state if state.fits(start) else start
