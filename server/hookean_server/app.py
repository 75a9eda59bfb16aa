"""The application: routes, guards and the pool put together. Transport only, no physics."""

from __future__ import annotations

import logging
import secrets
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import Depends, FastAPI
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

import hookean
from hookean_server.hops import routes as routes_hops
from hookean_server.http import openapi, queries
from hookean_server.http.access import Table
from hookean_server.http.anonymous import Visits
from hookean_server.http.conformance import Always, Manners
from hookean_server.http.guard import Guard, Origins
from hookean_server.http.limits import BodyLimit, Paced
from hookean_server.http.logs import Seen
from hookean_server.http.metrics import Metrics
from hookean_server.http.refusals import Problems
from hookean_server.http.tokens import Tokens, chosen
from hookean_server.jobs import routes as job_routes
from hookean_server.jobs.manager import Jobs
from hookean_server.lifecycle import ending
from hookean_server.problems import Problem
from hookean_server.routes import (
    about,
    analysis,
    design,
    discretize,
    docs,
    examples,
    families,
    geometry,
    page,
    recipes,
    relax,
)
from hookean_server.sessions import frames, guests, shown, surfaces
from hookean_server.sessions import routes as session_routes
from hookean_server.sessions.manager import Manager
from hookean_server.settings import Settings
from hookean_server.store import Store
from hookean_server.workers.pool import Pool

log = logging.getLogger("hookean.server")

_SLUGS = {404: "not-found", 405: "method-not-allowed", 413: "too-large", 415: "unsupported-media"}


def create_app(settings: Settings | None = None) -> FastAPI:
    """The service as an ASGI application; its workers start with its lifespan, or with the first request."""
    settings = settings or Settings()
    pool, store = Pool(settings), Store(settings.state, settings.quota, keep=settings.backups)
    sessions = Manager(settings, store)
    jobs = Jobs(settings, store, pool)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        pool.start()
        store.start()
        await sessions.start()
        about = {"version": hookean.__version__, "instance": app.state.instance, "port": settings.port}
        log.info("started", extra={"fields": about})
        await jobs.start()
        try:
            yield
        finally:
            log.info("stopping")
            await jobs.close()
            await sessions.close()
            pool.close()
            store.close()

    app = FastAPI(
        title="hookean",
        version=hookean.__version__,
        openapi_url="/v1/openapi.json",
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        lifespan=lifespan,
        exception_handlers={HTTPException: _refused, RequestValidationError: _faulty},
    )
    app.state.settings, app.state.pool, app.state.instance = settings, pool, secrets.token_hex(16)
    app.state.store, app.state.sessions, app.state.jobs = store, sessions, jobs
    app.state.tokens, app.state.metrics = Tokens(settings.token or chosen()), Metrics(app.state)
    parts = (
        about,
        ending,
        relax,
        analysis,
        design,
        discretize,
        docs,
        geometry,
        recipes,
        examples,
        families,
        routes_hops,
        page,
        session_routes,
        shown,
        surfaces,
        guests,
        frames,
        job_routes,
    )
    table = app.state.table = Table([*app.routes, *(route for part in parts for route in part.router.routes)])
    for part in parts:
        app.include_router(part.router, dependencies=[Depends(queries.known)])
    # the last one added is the outermost
    app.add_middleware(Visits, settings=settings, table=table)
    app.add_middleware(Paced, settings=settings)
    app.add_middleware(BodyLimit, settings=settings)
    app.add_middleware(Guard, settings=settings, tokens=app.state.tokens, table=table)
    app.add_middleware(Manners)
    app.add_middleware(Problems)
    app.add_middleware(Origins, settings=settings, table=table)
    app.add_middleware(Always)
    app.add_middleware(Seen, metrics=app.state.metrics)
    openapi.install(app)
    return app


async def _refused(request: Request, error: Exception) -> Response:
    """What the framework refuses: unknown addresses and methods."""
    assert isinstance(error, HTTPException)
    slug = _SLUGS.get(error.status_code, "bad-request" if error.status_code < 500 else "internal")
    detail = {
        404: "This address does not exist; GET /v1/openapi.json lists every one.",
        405: f"{request.method} is not supported here.",
    }.get(error.status_code, "The request is malformed.")
    headers = dict(error.headers or {})
    if error.status_code == 405:  # the framework names the methods of one route
        headers = {"allow": ", ".join(request.app.state.table.methods(request.scope["path"]))}
    raise Problem(slug, detail, headers=headers)


async def _faulty(request: Request, error: Exception) -> Response:
    """Faulty parameters of the address; what was given is not repeated."""
    assert isinstance(error, RequestValidationError)
    faults = [("/" + "/".join(str(s) for s in e["loc"]), str(e["msg"])) for e in error.errors()]
    raise Problem("invalid-input", f"{faults[0][0]}: {faults[0][1]}", faults)
