"""Query parameters that an operation does not have, or that are given twice, are refused: a misspelt one, or one of
the two, would otherwise have no effect, and nobody would know."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from fastapi.dependencies.models import Dependant
from starlette.requests import HTTPConnection

from hookean_server.problems import Problem


def known(connection: HTTPConnection) -> None:
    """Raise the problem `invalid-input` for a query parameter of `/v1/...` that the operation does not have, or that is
    given more than once: no operation takes lists."""
    given = connection.query_params
    if not given or not connection.url.path.startswith("/v1/"):
        return
    allowed = sorted(set(_names(connection.scope["route"].dependant)))
    faults = [(f"/query/{name}", _sentence(allowed)) for name in dict.fromkeys(given.keys()) if name not in allowed]
    faults += [
        (f"/query/{name}", f"given {count} times; give it once")
        for name, count in Counter(name for name, _ in given.multi_items()).items()
        if count > 1 and name in allowed
    ]
    if faults:
        raise Problem("invalid-input", f"{faults[0][0]}: {faults[0][1]}", faults)


def _sentence(allowed: list[str]) -> str:
    return f"unknown parameter; allowed are {', '.join(allowed)}" if allowed else "this address takes no parameters"


def _names(dependant: Dependant) -> Iterator[str]:
    """Of an operation's parameters and of what these depend on."""
    yield from (field.alias for field in dependant.query_params)
    for inner in dependant.dependencies:
        yield from _names(inner)
