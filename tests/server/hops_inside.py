"""The service without its worker processes: requests are worked on in this process, so that a test may give it other
functions."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import httpx

from hookean_server.app import create_app
from hookean_server.hops import functions as hops
from hookean_server.hops import routes as routes_hops
from hookean_server.hops.model import Function
from hookean_server.problems import Problem
from hookean_server.settings import Settings
from hookean_server.workers.pool import Job, Reply
from hookean_server.workers.registry import perform

ADDRESS = "http://127.0.0.1:8765"


class Inside:
    """Stands in for the pool of workers."""

    @contextmanager
    def place(self) -> Iterator[None]:
        yield

    async def run(self, job: Job) -> Reply:
        head, body = perform({"task": job.task, "options": job.options}, job.body, lambda: False)
        if "problem" in head:
            raise Problem(head["problem"], head["detail"], [(p, d) for p, d in head["errors"]])
        return Reply(head, body)


class Service:
    """The service's own routes, guards and refusals; `call` asks it as Hops does, with no token and no Accept."""

    def __init__(self) -> None:
        self.app = create_app(Settings(token="of-a-test-0123456789"))
        self.app.state.pool = Inside()

    def call(self, method: str, path: str, body: Any = None) -> httpx.Response:
        return asyncio.run(self._call(method, path, body))

    async def _call(self, method: str, path: str, body: Any) -> httpx.Response:
        transport = httpx.ASGITransport(app=self.app)
        async with httpx.AsyncClient(transport=transport, base_url=ADDRESS, timeout=None) as client:
            del client.headers["accept"]
            if body is None:
                return await client.request(method, path)
            kind = {"content-type": "application/json; charset=utf-8"}
            return await client.request(method, path, content=json.dumps(body), headers=kind)


@contextmanager
def functions(given: Mapping[str, Function]) -> Iterator[None]:
    """Other functions than the service's own."""
    own = hops.FUNCTIONS
    hops.FUNCTIONS = routes_hops.FUNCTIONS = given
    try:
        yield
    finally:
        hops.FUNCTIONS = routes_hops.FUNCTIONS = own
