"""Results of a job as a table, JSON or CSV, and its events; written row by row as the store gives them."""

from __future__ import annotations

import asyncio
import csv
import io
import json
from collections.abc import AsyncIterator
from typing import Any

from hookean.files import cells
from hookean_server.jobs import rows
from hookean_server.jobs.manager import Jobs, summary
from hookean_server.jobs.runner import Live

HEARTBEAT = 15.0  # seconds
LOOK = 0.25  # seconds between looks at whether the service ends
PAGE = 500


def line_of(row: rows.Row) -> bytes:
    """The row of figures of an item, JSON without a line feed."""
    return row.body.partition(b"\n")[0]


async def as_json(live: Live, about: dict[str, Any], pages: AsyncIterator[list[rows.Row]]) -> AsyncIterator[bytes]:
    """`{"id", ..., "parameters", "warnings", "columns", "rows"}`."""
    head = {**summary(live), "parameters": about["names"], "warnings": about.get("warnings", [])}
    head["columns"] = [{"name": name, "unit": unit} for name, unit in about["columns"]]
    yield json.dumps(head).encode()[:-1] + b', "rows": ['
    first = True
    async for page in pages:
        if page:
            yield (b"" if first else b",\n") + b",\n".join(line_of(row) for row in page)
            first = False
    yield b"]}"


async def as_csv(about: dict[str, Any], pages: AsyncIterator[list[rows.Row]]) -> AsyncIterator[bytes]:
    """A line for each item: number, parameters, status, columns with their units, message."""
    names, columns = about["names"], about["columns"]
    titles = [f"{name} [{unit}]" if unit else name for name, unit in columns]
    yield _lines([["number", *names, "status", *titles, "message"]])
    async for page in pages:
        yield _lines([_cells(json.loads(line_of(row)), names, [name for name, _ in columns]) for row in page])


def _cells(row: dict[str, Any], names: list[str], columns: list[str]) -> list[Any]:
    given = [row["parameters"].get(name) for name in names]
    found = {name: row.get(name) for name in columns}
    for name, (smallest, largest) in row.get("forces", {}).items():
        found[f"{name}.smallest"], found[f"{name}.largest"] = smallest, largest
    shown = [v if isinstance(v, str | int | float) else "" if v is None else json.dumps(v) for v in given]
    return [row["number"], *shown, row["status"], *(found[name] for name in columns), row["message"]]


def _lines(table: list[list[Any]]) -> bytes:
    stream = io.StringIO()
    csv.writer(stream).writerows(cells.row(row) for row in table)
    return stream.getvalue().encode()


async def events(jobs: Jobs, live: Live, after: int) -> AsyncIterator[bytes]:
    """Server-sent events after a number: `progress` of a relaxation or design, `item` for each that is done, and once,
    at the end, `done`, `failed` or `cancelled`. A comment each 15 s shows that it is alive."""
    yield b"retry: 1000\n\n"
    while not jobs.pool.stopping.is_set():
        news, ended, last = live.news, live.ended, live.event
        for number, said in list(live.progress):
            if number > after:
                yield _event(number, "progress", json.dumps(said).encode())
                after = number
        page: list[rows.Row] = await jobs.store.run(rows.rows(live.kept.id, after, PAGE, by="event"))
        for row in page:
            yield _event(row.event, "item", line_of(row))
            after = row.event
        if len(page) == PAGE:
            continue
        if ended:
            yield _event(last + 1, live.kept.status, json.dumps(summary(live)).encode())
            return
        if not await _written(jobs, news):
            yield b": still here\n\n"


async def _written(jobs: Jobs, news: asyncio.Event) -> bool:
    """Wait for news; whether there are any before the next heartbeat is due."""
    waited = 0.0
    while waited < HEARTBEAT:
        try:
            async with asyncio.timeout(LOOK):
                await news.wait()
            return True
        except TimeoutError:
            waited += LOOK
        if jobs.pool.stopping.is_set():
            return True
    return False


def _event(number: int, name: str, data: bytes) -> bytes:
    return f"id: {number}\nevent: {name}\ndata: ".encode() + data + b"\n\n"
