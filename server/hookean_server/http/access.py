"""Which operations are open without a token, and which operation an address is.

An operation is closed unless its endpoint is marked here, so a new one is closed. The guard finds it in the
application's own routes: an alias of an address is the same operation.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from enum import Enum
from typing import Any, TypeVar

from starlette.routing import BaseRoute, Route, WebSocketRoute

Endpoint = TypeVar("Endpoint", bound=Callable[..., Any])


class Access(Enum):
    """The clients that may call an operation."""

    TOKEN = "clients with the token, or with a cookie of this server from its own page"
    PROGRAM = "clients with the token itself"
    CODE = "clients with the token itself, or with an unused code"
    OPEN = "all programs on this machine"
    HOPS = "all programs on this machine except web pages: Hops has no token"


_MARKED: dict[Callable[..., Any], Access] = {}
_READING: set[Callable[..., Any]] = set()


def marked(access: Access) -> Callable[[Endpoint], Endpoint]:
    """Mark an endpoint, below the decorator of its route."""

    def mark(endpoint: Endpoint) -> Endpoint:
        _MARKED[endpoint] = access
        return endpoint

    return mark


def reading(endpoint: Endpoint) -> Endpoint:
    """Mark an endpoint that clients with a read-only link may call, below the decorator of its route: it changes
    nothing, and returns nothing of other sessions."""
    _READING.add(endpoint)
    return endpoint


def of(endpoint: Callable[..., Any] | None) -> Access:
    """The clients that may call an endpoint; an address without an endpoint needs the token."""
    return Access.TOKEN if endpoint is None else _MARKED.get(endpoint, Access.TOKEN)


class Table:
    """The routes of the application in their order."""

    def __init__(self, routes: Iterable[BaseRoute]) -> None:
        every = list(routes)
        self.routes = [route for route in every if isinstance(route, Route)]
        self.sockets = [route for route in every if isinstance(route, WebSocketRoute)]

    def access(self, method: str, path: str) -> Access:
        """The clients that may make a request: the mark of its endpoint."""
        return of(self.endpoint(method, path))

    def endpoint(self, method: str, path: str) -> Callable[..., Any] | None:
        """The route that answers a request; None if there is no such route. HEAD is answered as GET."""
        method = "GET" if method == "HEAD" else method
        found = (r.endpoint for r in self.routes if method in (r.methods or ()) and r.path_regex.match(path))
        return next(found, None)

    def reads(self, method: str | None, path: str, key: str) -> bool:
        """Whether a request only reads, and of sessions only that of the key; a socket has no method."""
        method = "GET" if method == "HEAD" else method
        by_method = (route for route in self.routes if method in (route.methods or ()))
        for route in self.sockets if method is None else by_method:
            if match := route.path_regex.match(path):
                return route.endpoint in _READING and match.groupdict().get("key", key) == key
        return False

    def declared_reading(self, method: str, template: str) -> bool:
        """Whether clients with a read-only link may call the operation of a template, of their session."""
        return any(
            r.endpoint in _READING for r in self.routes if r.path_format == template and method in (r.methods or ())
        )

    def declared(self, method: str, template: str) -> Access:
        """The clients that may call the operation of a template, such as /v1/sessions/{key}."""
        found = (r.endpoint for r in self.routes if r.path_format == template and method in (r.methods or ()))
        return of(next(found, None))

    def methods(self, path: str) -> list[str]:
        """The methods of an address, in alphabetical order."""
        found = {method for route in self._closest(path) for method in route.methods or ()}
        return sorted(found | {"HEAD"} if "GET" in found else found)

    def is_for_hops(self, path: str) -> bool:
        """Whether an address is one of Hops' own, whatever its method."""
        return any(of(route.endpoint) is Access.HOPS for route in self._closest(path))

    def _closest(self, path: str) -> list[Route]:
        """The routes that match an address with the fewest parameters."""
        matching = [route for route in self.routes if route.path_regex.match(path)]
        fewest = min((len(route.param_convertors) for route in matching), default=0)
        return [route for route in matching if len(route.param_convertors) == fewest]


def is_plain(path: str) -> bool:
    """Whether an address, decoded, has no control characters: patterns of routes overlook a line end at its end."""
    return re.search(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]", path) is None
