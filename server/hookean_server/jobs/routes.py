"""Jobs over HTTP: long relaxations, sweeps and designs, their progress as events, their results as a table."""

from __future__ import annotations

import json
import re
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Header, Path, Query, Request
from starlette.responses import Response, StreamingResponse

from hookean_server.http.handling import answered, read_json
from hookean_server.jobs import description, rows, tables
from hookean_server.jobs.manager import Jobs, summary
from hookean_server.jobs.runner import Live
from hookean_server.problems import Problem
from hookean_server.workers.pool import Job, Reply

router = APIRouter(tags=["jobs"])

Key = Annotated[str | None, Header(description="For a day, the same key with the same body is the same job")]
Id = Annotated[str, Path(max_length=64, description="Id of a job")]
LARGEST = 2**31
_KEEP = {"cache-control": "no-store"}


def _jobs(request: Request) -> Jobs:
    found: Jobs = request.app.state.jobs
    return found


@router.post("/v1/jobs", status_code=202, summary="Relax in the background, sweep or design", **description.created())
async def create(request: Request, idempotency_key: Key = None) -> Response:
    """A scene is relaxed in the background, for as long as it takes; with a `sweep` once for each of its items; with a
    `design` the values are searched for which it meets goals. It is stored before this is answered, and continues after
    a restart."""
    return await _created(request, idempotency_key)


@router.post("/v1/design", status_code=202, summary="Search values that meet goals", **description.designed())
async def create_design(request: Request, idempotency_key: Key = None) -> Response:
    """A design problem as a job: the values of its variables for which the scene's equilibrium meets goals and
    constraints are searched in the background. Events report equilibria and the best objective; the result of item 0 is
    the answer with the best values so far. The same as `POST /v1/jobs` with a `design` beside the scene."""
    return await _created(request, idempotency_key, "design")


async def _created(request: Request, idempotency_key: str | None, kind: str = "") -> Response:
    key = idempotency_key or ""
    if idempotency_key is not None and not re.fullmatch(r"[\x21-\x7e]{1,255}", key):
        said = "1 to 255 visible ASCII characters are expected"
        raise Problem("invalid-input", f"Idempotency-Key: {said}", [("/Idempotency-Key", said)])
    with request.app.state.pool.place():
        location, body, before = await _jobs(request).add(await read_json(request), key, kind)
    replayed = {"idempotency-replayed": "true"} if before else {}
    return Response(body, 202, {"location": location, **replayed, **_KEEP}, "application/json")


@router.get("/v1/jobs", summary="All jobs", responses=description.told("Jobs"))
async def listing(request: Request) -> dict[str, Any]:
    """Every job with its state, the oldest first."""
    return {"jobs": [summary(live) for live in _jobs(request).jobs.values()]}


@router.get("/v1/jobs/{job}", summary="Status of a job", responses=description.told("Job"))
async def read(request: Request, job: Id) -> dict[str, Any]:
    """How many items are done; of a relaxation or design also how far it is."""
    return summary(_jobs(request).find(job))


@router.delete("/v1/jobs/{job}", status_code=204, summary="Cancel a job", responses=description.cancelled())
async def cancel(request: Request, job: Id) -> Response:
    """It ends within two seconds, whatever its workers do; its results so far can be read. A job that has ended
    is not changed."""
    await _jobs(request).cancel(job)
    return Response(status_code=204)


@router.get(
    "/v1/jobs/{job}/events",
    summary="Progress as server-sent events",
    responses=description.streamed(),
    response_class=StreamingResponse,
)
async def events(
    request: Request,
    job: Id,
    last_event_id: Annotated[
        str | None, Header(description="Only events after this one are sent; default: all")
    ] = None,
) -> Response:
    """`progress` of a relaxation (iteration, residual) or a design (iteration, objective), `item` with the row of each
    item that is done, and once `done`, `failed` or `cancelled` with the job; a comment each 15 s. After the last one it
    answers 204, which ends an EventSource."""
    jobs = _jobs(request)
    live = jobs.find(job)
    given = (last_event_id or "").strip()
    after = int(given) if re.fullmatch(r"[0-9]{1,9}", given) else 0
    if live.ended and after > live.event:
        return Response(status_code=204)
    headers = {**_KEEP, "x-accel-buffering": "no"}
    return StreamingResponse(tables.events(jobs, live, after), 200, headers, "text/event-stream")


@router.get(
    "/v1/jobs/{job}/results",
    summary="The table of results",
    responses=description.table(),
    response_class=StreamingResponse,
)
async def results(
    request: Request,
    job: Id,
    form: Annotated[
        Literal["json", "csv"] | None, Query(alias="format", description="Default: by the header Accept")
    ] = None,
) -> Response:
    """A row of figures for each item that is done, in the order of the sweep; readable while it runs."""
    jobs = _jobs(request)
    live = jobs.find(job)
    about, _ = await jobs.about(live)
    if form is None:
        form = "csv" if "text/csv" in request.headers.get("accept", "") else "json"
    if form == "csv":
        headers = {**_KEEP, "content-disposition": f'attachment; filename="{job}.csv"'}
        return StreamingResponse(tables.as_csv(about, jobs.pages(live)), 200, headers, "text/csv")
    return StreamingResponse(tables.as_json(live, about, jobs.pages(live)), 200, _KEEP, "application/json")


@router.get("/v1/jobs/{job}/results/{number}", summary="The whole result of one item", responses=description.item())
async def result(
    request: Request,
    job: Id,
    number: Annotated[int, Path(ge=0, le=LARGEST, description="Place in the sweep, from 0")],
) -> Response:
    """The result as `POST /v1/relax` gives it; of a design values, goals and constraints with the result. An item of a
    sweep is solved once more for this, to the same bits; a relaxation or design that runs, or was stopped, is shown as
    it was within the last second or two."""
    jobs = _jobs(request)
    live = jobs.find(job)
    row: rows.Row | None = await jobs.store.run(rows.item(job, number))
    if row is None:
        raise Problem("not-found", f"Item {number} is not done; there are {live.kept.total}, counted from 0.")
    if row.status == "failed":
        return Response(tables.line_of(row), headers=_KEEP, media_type="application/json")
    if row.status == rows.PARTIAL or (row.status == rows.STOPPED and live.kept.kind == "relaxation"):
        return Response(await _partial(request, live, row), headers=_KEEP, media_type="application/json")
    if live.kept.kind != "sweep":
        return Response(row.body.partition(b"\n")[2], headers=_KEEP, media_type="application/json")
    settings = request.app.state.settings
    _, body = await jobs.about(live)
    options = {"number": number, "seconds": settings.solve_seconds}
    reply = await _worked(request, Job("item", options, body, settings.solve_seconds + settings.grace_seconds))
    return Response(reply.body, headers=_KEEP, media_type="application/json")


async def _partial(request: Request, live: Live, row: rows.Row) -> bytes:
    """The shape of a relaxation that is not done, as it was last kept."""
    said, _, state = row.body.partition(b"\n")
    _, body = await _jobs(request).about(live)
    values = json.loads(said)
    status = "cancelled" if live.cancelled else "running" if not live.ended else "stalled"
    message = values.get("message") or f"The shape after {values['iteration']} iterations."
    seconds = request.app.state.settings.solve_seconds
    options = {"size": len(body), "status": status, "message": message, "seconds": seconds, "longest": seconds}
    task = "shape" if live.kept.kind == "relaxation" else "design shape"
    reply = await _worked(request, Job(task, options, body + state, seconds))
    return reply.body.partition(b"\n")[2]


async def _worked(request: Request, job: Job) -> Reply:
    pool = request.app.state.pool
    with pool.place():
        return await answered(request, pool.run(job))
