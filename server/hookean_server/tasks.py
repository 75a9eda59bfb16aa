"""What workers can do, by name, and how their failures become problems. Runs in a worker."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from pydantic import ValidationError

from hookean.errors import InputError
from hookean.scene import faults
from hookean_server.problems import Problem, faulty, not_stored

log = logging.getLogger("hookean.worker")
Cancelled = Callable[[], bool]


@dataclass
class Done:
    """A finished task: its answer, and how long its parts took [s]."""

    body: bytes
    media_type: str = "application/json"
    headers: dict[str, str] = field(default_factory=dict)
    timing: dict[str, float] = field(default_factory=dict)


class Clock:
    """Times the parts of a task for the header Server-Timing."""

    def __init__(self) -> None:
        self.parts: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        """The time since the last lap was spent on `name`."""
        now = time.perf_counter()
        self.parts[name] = self.parts.get(name, 0.0) + now - self._last
        self._last = now


def perform(request: dict[str, Any], body: bytes, cancelled: Cancelled) -> tuple[dict[str, Any], bytes]:
    """Do `request["task"]` on `body`; a JSON head and the answer's body. Never raises."""
    options = request["options"]
    slug = "invalid-scene" if request["task"] == "relax" else "invalid-input"
    try:
        done = _tasks()[request["task"]](options, body, cancelled)
    except Problem as problem:
        return _failed(problem), b""
    except InputError as error:
        return _failed(faulty(slug, list(error.faults))), b""
    except ValidationError as error:
        return _failed(faulty(slug, faults(error))), b""
    except RecursionError:
        return _failed(faulty(slug, [InputError("/", "nested too deeply")])), b""
    except UnicodeError:
        return _failed(faulty(slug, [InputError("/", "a text has characters that are no Unicode")])), b""
    except OSError as error:
        log.error("%s could not write: %s", request["task"], error.strerror)
        return _failed(not_stored(error)), b""
    except MemoryError:
        return _failed(
            Problem("too-large", "This needs more memory than one request may use.", [("/", "too large")])
        ), b""
    except Exception:
        log.exception("%s failed", request["task"])
        return _failed(Problem("internal", "The service failed on this input; its log tells more.")), b""
    return {"type": done.media_type, "headers": done.headers, "timing": done.timing}, done.body


def _tasks() -> dict[str, Callable[[dict[str, Any], bytes, Cancelled], Done]]:
    from hookean_server import files, hops, operations, routes_examples, solve
    from hookean_server.jobs import work

    return {
        "relax": solve.relax_scene,
        "discretize": operations.discretize,
        "hops": hops.solve,
        "file": files.relax_upload,
        "scene": files.scene_upload,
        "geometry": files.geometry_upload,
        "example": routes_examples.read_example,
        "job": work.check,
        "batch": work.batch,
        "item": work.item,
        "relaxation": work.relaxation,
        "shape": work.shape,
    }


def _failed(problem: Problem) -> dict[str, Any]:
    return {"problem": problem.slug, "detail": problem.detail, "errors": problem.errors, "headers": problem.headers}
