"""Which operations are open, under every name of their addresses: the routes of the application are walked over a real
socket, without a token, with everything that is done to an address to get past a guard."""

from __future__ import annotations

import itertools
import re
import socket
from collections.abc import Iterator
from urllib.parse import unquote

import pytest
from starlette.routing import Route, WebSocketRoute

from hookean_server.app import create_app
from hookean_server.http.access import Access, of
from hookean_server.routes import about as routes_about
from serving import HANG, app
from soak import sampled

from .conftest import Served

OPEN = {
    ("GET", "/v1/health"),
    ("GET", "/v1/proof"),
    ("GET", "/problems/{slug}"),
    ("GET", "/page/{path:path}"),
    ("GET", "/docs"),
    ("GET", "/docs/{path:path}"),
    ("GET", "/"),
    ("GET", "/{function}"),
    ("POST", "/solve"),
}
"""All that is open, by hand; whatever is not in here needs the token."""
SUFFIXES = ("", "%0a", "%0A", "%0d", "%0d%0a", "%00", "%09", "%20", "%e2%80%a8", "/", "//", ";", ";a=b", "/.", "/..")
SUFFIXES += (".", "..", "%2f", "%5c", "%3f", "?", "#", "%23", "%25%30%61", "%250a", "%c2%85", "%ff", "%u000a")


def every_route() -> list[tuple[str, str]]:
    """Method and template of every route of the application's own table, sockets as GET."""
    app = create_app()
    found = [(m, r.path) for r in app.state.table.routes for m in sorted((r.methods or set()) - {"HEAD"})]
    assert len(found) > 50
    return found


ROUTES = every_route()


def spelled(path: str) -> list[str]:
    """An address by every other name that somebody may try: before, behind, in the middle, in another case."""
    first, rest = path[:2], path[2:]
    names = [path + suffix for suffix in SUFFIXES]
    names += [
        path.upper(),
        path.title(),
        "/" + path,
        "/." + path,
        "/.." + path,
        "/page/.." + path,
        "/page/%2e%2e" + path,
    ]
    names += [f"/%{ord(first[1]):02x}{rest}" if len(first) > 1 else path, f"http://127.0.0.1{path}", "/%2f" + path[1:]]
    names += ["/problems/.." + path, "/v1/health/.." + path, "/v1/health%0a" + path, "/v1/health;" + path]
    return list(dict.fromkeys(names))


class Line:
    """One connection on which requests are made by hand, without a token."""

    def __init__(self, served: Served) -> None:
        self.served, self.sock = served, socket.create_connection(("127.0.0.1", served.port), timeout=HANG)
        self.file = self.sock.makefile("rb")

    def status(self, method: str, target: str) -> int:
        """What the service answers; the body is read and thrown away."""
        head = f"{method} {target} HTTP/1.1\r\nHost: 127.0.0.1:{self.served.port}\r\nContent-Length: 0\r\n\r\n"
        self.sock.sendall(head.encode("latin-1"))
        status = int(self.file.readline().split()[1])
        length, closes = 0, False
        while (line := self.file.readline().strip().lower()) != b"":
            length = int(line[15:]) if line.startswith(b"content-length:") else length
            closes |= line == b"connection: close"
        self.file.read(0 if method == "HEAD" else length)
        if closes:
            self.close()
            self.__init__(self.served)  # type: ignore[misc]
        return status

    def close(self) -> None:
        self.file.close()
        self.sock.close()


@pytest.fixture
def line(served: Served) -> Iterator[Line]:
    found = Line(served)
    yield found
    found.close()


def concrete(template: str) -> str:
    return re.sub(r"\{.*?\}", "busy", template.replace("{action:action}", "play"))


def is_open(method: str, target: str) -> bool:
    """Whether an address, decoded once, is one of the open ones: the rule by hand, beside the guard's own."""
    if not target.startswith("/"):
        return False
    path = unquote(target.partition("?")[0])
    if re.search(r"[\x00-\x1f\x7f-\x9f\u2028]", path):
        return False
    for opened, template in OPEN:
        pattern = re.escape(template).replace(r"\{path:path\}", ".*").replace(r"\{slug\}", "[^/]+")
        pattern = pattern.replace(r"\{function\}", "[^/]+")
        if method in {opened, "HEAD" if opened == "GET" else opened} and re.fullmatch(pattern, path, re.S):
            return path != "/metrics"
    return False


@pytest.mark.parametrize(("method", "template"), sampled(ROUTES, 3))
def test_no_alias_of_a_closed_address_is_open(line: Line, method: str, template: str) -> None:
    """Every route with some fifty names for its address: 401 or 404 without a token, and 405 where the method is not
    that of an open one, unless the name is by itself one of the open operations."""
    path = concrete(template)
    for target, sent in itertools.product(spelled(path), {method, "HEAD" if method == "GET" else method}):
        status = line.status(sent, target)
        if is_open(sent, target):
            assert status in (200, 307, 400, 404, 405, 415, 422), (sent, target, status)
        else:
            assert status in (401, 404) or status in (400, 405) and not target.startswith("/"), (sent, target, status)
        if template in ("/metrics", "/v1/openapi.json", "/v1/forces"):
            assert status != 200, (sent, target)


def test_figures_are_closed_however_they_are_asked_for(line: Line) -> None:
    """The address of the figures with a line end behind it was taken for a name of Hops, and for the figures."""
    for target in (
        "/metrics",
        "/metrics%0a",
        "/metrics%0A",
        "/metrics%0d%0a",
        "/metrics%00",
        "//metrics",
        "/%6detrics",
    ):
        for method in ("GET", "HEAD"):
            assert line.status(method, target) in (401, 404), (method, target)


def test_what_is_open_is_this_and_nothing_else() -> None:
    app = create_app()
    found = {
        (method, route.path)
        for route in app.state.table.routes
        for method in (route.methods or set()) - {"HEAD"}
        if of(route.endpoint) in (Access.OPEN, Access.HOPS)
    }
    assert found == OPEN


def test_the_table_is_that_of_the_application() -> None:
    """Every route that the framework knows is in the table that the guard reads, in the same order."""
    app = create_app()

    def flat(routes: list[object]) -> list[tuple[str, object]]:
        found: list[tuple[str, object]] = []
        for route in routes:
            if isinstance(route, Route):
                found.append((route.path, route.endpoint))
            elif not isinstance(route, WebSocketRoute):
                found += flat(getattr(getattr(route, "original_router", None), "routes", []))
        return found

    assert flat(list(app.routes)) == [(route.path, route.endpoint) for route in app.state.table.routes]


def test_a_route_that_nobody_marked_is_closed() -> None:
    async def new() -> None: ...

    assert of(new) is of(None) is Access.TOKEN and of(routes_about.health) is Access.OPEN


def test_every_operation_says_who_may_call_it() -> None:
    """The description names its schemes; an operation has one, or is open explicitly; as the guard has it."""
    document = app().openapi()
    schemes = document["components"]["securitySchemes"]
    assert schemes["token"]["scheme"] == schemes["code"]["scheme"] == "bearer"
    assert (schemes["cookie"]["type"], schemes["cookie"]["in"], schemes["cookie"]["name"]) == (
        "apiKey",
        "cookie",
        "hookean-8765",
    )
    opened = set()
    for path, item in document["paths"].items():
        for method, operation in item.items():
            security = operation["security"]
            assert all(set(one) <= set(schemes) and len(one) == 1 for one in security)
            assert ("401" in operation["responses"]) == bool(security), (method, path)
            if not security:
                opened.add((method.upper(), path))
    assert opened == OPEN - {("GET", path) for path in ("/page/{path:path}", "/docs", "/docs/{path:path}")}
    assert document["paths"]["/v1/token"]["post"]["security"] == [{"token": []}], "a cookie changes no token"
