"""Who may: hosts, origins and tokens, checked for requests and WebSockets alike before anything is read."""

from __future__ import annotations

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hookean_server.claimed import NAMES
from hookean_server.problems import Problem, is_function
from hookean_server.settings import Settings
from hookean_server.tokens import Tokens, cookie_name, cookies

SAFE = {"GET", "HEAD", "OPTIONS"}
CORS = {
    "access-control-allow-methods": "GET, POST, PUT, PATCH, DELETE",
    "access-control-allow-headers": (
        "authorization, content-type, if-match, if-none-match, idempotency-key, last-event-id"
    ),
    "access-control-max-age": "600",
}
EXPOSED = ", ".join(("etag", "location", "retry-after", "server-timing", "x-request-id", *NAMES))


def needs_token(method: str, path: str) -> bool:
    """Whether an address is for those who hold the token. Open: health, pages of problems, page files, Hops' calls."""
    if method in ("GET", "HEAD") and (path == "/v1/health" or path.startswith(("/problems/", "/page/"))):
        return False
    return not is_hops(method, path)


def is_hops(method: str, path: str) -> bool:
    """Whether this is one of Hops' own calls: pure functions, which no page may call. GET / lists them, POST /solve
    runs them; any other name at the root is one, or one that there is not."""
    if method in ("GET", "HEAD"):
        return path == "/" or is_function(path)
    return (method, path) == ("POST", "/solve")


class Guard:
    """Refuses other hosts, other sites' pages, and whoever has no token; compressed bodies and huge headers too."""

    def __init__(self, app: ASGIApp, settings: Settings, tokens: Tokens) -> None:
        self.app, self.settings, self.tokens = app, settings, tokens
        self.names = {"127.0.0.1", "localhost", "[::1]", *(h.lower() for h in settings.hosts)}
        self.origins = {o.lower() for o in settings.origins}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""
        if scope["type"] in ("http", "websocket"):
            headers = _Headers(scope)
            self._check_host(scope, headers)
            if scope.get("preflight"):  # of a listed origin; the answer's headers are added further out
                await send({"type": "http.response.start", "status": 204, "headers": []})
                await send({"type": "http.response.body", "body": b""})
                return
            self._check_origin(scope, headers)
            self._check_token(scope, headers)
            if any(encoding not in ("identity", "") for encoding in headers.all(b"content-encoding")):
                said = "The body is compressed; send it as it is, without Content-Encoding."
                raise Problem("unsupported-media", said)
        await self.app(scope, receive, send)

    def _check_host(self, scope: Scope, headers: _Headers) -> None:
        if headers.size > self.settings.header_limit:
            raise Problem("headers-too-large", f"At most {self.settings.header_limit} bytes of headers are taken.")
        hosts = headers.all(b"host")
        if len(hosts) != 1 or not self._ours(hosts[0], scope):
            raise Problem("forbidden-host", "Address this service as 127.0.0.1, localhost or [::1] with its port.")

    def _ours(self, host: str, scope: Scope) -> bool:
        name, colon, port = host.rpartition(":")
        if not colon or host.endswith("]"):
            name, port = host, "80"
        served = scope.get("server") or (None, None)
        return name in self.names and port == str(served[1] if served[1] is not None else 80)

    def _check_origin(self, scope: Scope, headers: _Headers) -> None:
        origins, sites = headers.all(b"origin"), headers.all(b"sec-fetch-site")
        method = scope.get("method", "")
        if origins and is_hops(method, scope["path"]):
            raise Problem("forbidden-origin", "Hops' calls are for Hops: pages of any origin are refused.")
        if scope["type"] == "http" and method in SAFE:
            return
        if len(origins) > 1 or any(o != headers.own and o not in self.origins for o in origins):
            raise Problem("forbidden-origin", "This came from a page of another origin, which may not do this.")
        if not _same_site(sites) and not (origins and origins[0] in self.origins):
            raise Problem("forbidden-origin", "This came from a page of another site, which may not do this.")

    def _check_token(self, scope: Scope, headers: _Headers) -> None:
        method = scope.get("method", "")
        if scope["type"] == "http" and not needs_token(method, scope["path"]):
            return
        given = headers.all(b"authorization", lower=False)
        if given:
            if len(given) == 1 and self.tokens.named(given[0]):
                return
        elif self._by_cookie(scope, headers):
            return
        raise Problem(
            "unauthorized",
            "Send the service's token: Authorization: Bearer, with what the command `hookean token` prints.",
            headers={"www-authenticate": 'Bearer realm="hookean"'},
        )

    def _by_cookie(self, scope: Scope, headers: _Headers) -> bool:
        """A page's cookie counts for requests of that page alone: browsers send it to every port of this machine, and
        for requests that other pages cause."""
        ours = all(o == headers.own for o in headers.all(b"origin")) and _same_site(headers.all(b"sec-fetch-site"))
        name = cookie_name(scope["server"][1] if scope.get("server") else 80)
        given = [v for header in headers.all(b"cookie", lower=False) for v in cookies(header, name)]
        return ours and self.tokens.logged_in(given)


class Origins:
    """Lets pages of listed origins read answers, and answers what their browsers ask first. None are listed: CORS is
    off."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app, self.origins = app, set(settings.origins)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""
        if scope["type"] != "http" or not self.origins:
            await self.app(scope, receive, send)
            return
        given = [v.decode("latin-1") for k, v in scope["headers"] if k == b"origin"]
        listed = len(given) == 1 and given[0] in self.origins

        async def told(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(raw=list(message.get("headers", [])))
                headers.add_vary_header("Origin")
                if listed:
                    headers["access-control-allow-origin"] = given[0]
                    headers["access-control-expose-headers"] = EXPOSED
                    if scope.get("preflight"):
                        headers.update(CORS)
                message["headers"] = headers.raw
            await send(message)

        asks = scope["method"] == "OPTIONS" and any(k == b"access-control-request-method" for k, _ in scope["headers"])
        scope["preflight"] = asks and listed and not is_hops("POST", scope["path"])
        await self.app(scope, receive, told)


def _same_site(sites: list[str]) -> bool:
    return all(site in ("none", "same-origin") for site in sites)


class _Headers:
    def __init__(self, scope: Scope) -> None:
        self.raw: list[tuple[bytes, bytes]] = scope["headers"]
        target = len(scope.get("raw_path") or b"") + len(scope["query_string"])
        self.size = sum(len(k) + len(v) + 4 for k, v in self.raw) + target
        self.own = "http://" + ",".join(self.all(b"host"))  # the origin of our own pages

    def all(self, name: bytes, *, lower: bool = True) -> list[str]:
        found = [v.decode("latin-1").strip() for k, v in self.raw if k == name]
        return [v.lower() for v in found] if lower else found
