"""Messages between the service and its processes: a JSON head, then a body of bytes, never pickles. A failure is a head
with a problem."""

from __future__ import annotations

import json
import logging
from multiprocessing.connection import Connection
from typing import Any

from pydantic import ValidationError

from hookean.errors import InputError
from hookean.values.faults import faults
from hookean_server.problems import Problem, faulty, not_stored

Message = tuple[dict[str, Any], bytes]


def send(connection: Connection, head: dict[str, Any], body: bytes = b"") -> None:
    """Send a message."""
    connection.send_bytes(json.dumps(head).encode())
    connection.send_bytes(body)


def receive(connection: Connection, head: bytes | None = None) -> Message:
    """The next message, of which the head may have been read. Raises EOFError and OSError where the other end is gone,
    ValueError where the head is no JSON."""
    return json.loads(connection.recv_bytes() if head is None else head), connection.recv_bytes()


def problem_of(error: Exception, slug: str, what: str, log: logging.Logger, *, scene: str = "") -> Problem:
    """The problem that a client gets for an exception. `slug` is that of faulty input, `scene` that of faulty scenes
    where it is another; `what` names the work in the log."""
    match error:
        case Problem():
            return error
        case InputError():
            return faulty(slug, list(error.faults))
        case ValidationError():
            return faulty(scene or slug, faults(error))
        case RecursionError():
            return faulty(scene or slug, [InputError("/", "nested too deeply")])
        case UnicodeError():
            return faulty(scene or slug, [InputError("/", "a text has characters that are not Unicode")])
        case OSError():
            log.error("%s could not write: %s", what, error.strerror)
            return not_stored(error)
        case MemoryError():
            said = "This needs more memory than one request or session may use."
            return Problem("too-large", said, [("/", "too large")])
    log.error("%s failed", what, exc_info=error)
    return Problem("internal", "Internal error on this input; the log of the service has the details.")
