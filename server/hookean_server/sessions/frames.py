"""Frames of a session over a WebSocket: binary frames out, acknowledgements, edits and commands in.

The newest frame wins: at most two are on their way to a client, and one that is slow skips those in between; it holds
up neither the session nor other clients. Text messages are JSON. Out: `hello` first, `state` when anything but the
particles changed, and the answer to each message that has an `id`. In: `{"ack": n}` for each frame received,
`{"id": 1, "edit": {...}}`, `{"id": 2, "do": "play" | "relax" | "pause" | "step" | "reset" | "undo" | "redo", ...}`.
"""

from __future__ import annotations

import asyncio
import json
from contextlib import suppress
from typing import Any

from fastapi import APIRouter
from starlette.websockets import WebSocket, WebSocketDisconnect

from hookean.errors import InputError
from hookean.scene.text import parse
from hookean_server.http.access import reading
from hookean_server.http.guard import READ_ONLY
from hookean_server.http.guests import SUBPROTOCOL
from hookean_server.problems import Problem
from hookean_server.sessions.live import Live, summary
from hookean_server.sessions.manager import Manager
from hookean_server.sessions.wire import VERSION

router = APIRouter()

IN_FLIGHT = 2
_NEWS = ("revision", "status", "playing", "undo", "redo", "warnings")
CLOSED = {"not-found": 4404, "busy": 4429, "shutting-down": 1012}


@router.websocket("/v1/sessions/{key}/frames")
@reading
async def frames(socket: WebSocket, key: str, changes: bool = False) -> None:
    """One client that watches one session; `changes`: it takes frames of changes."""
    sessions: Manager = socket.app.state.sessions
    spoken = SUBPROTOCOL if SUBPROTOCOL in socket.scope.get("subprotocols", []) else None
    try:
        live = await sessions.watch(key)
    except Problem as problem:
        with suppress(OSError, WebSocketDisconnect):
            await socket.accept(spoken)
            await socket.close(CLOSED.get(problem.slug, 1011), problem.detail[:120])
        return
    try:
        with suppress(OSError, WebSocketDisconnect):  # the client may have left already
            await socket.accept(spoken)
            await _served(_Client(socket, sessions, live, changes=changes))
    finally:
        sessions.unwatch(live)


async def _served(client: _Client) -> None:
    """Until either side ends it."""
    tasks = [asyncio.create_task(client.send()), asyncio.create_task(client.receive())]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        code = 1012 if client.sessions.closing else 4404 if client.live.gone else client.code
        with suppress(RuntimeError, OSError, WebSocketDisconnect):
            await client.socket.close(code, client.reason[:120])


class _Client:
    def __init__(self, socket: WebSocket, sessions: Manager, live: Live, *, changes: bool) -> None:
        self.socket, self.sessions, self.live, self.changes = socket, sessions, live, changes
        self.sent = 0  # number of the last frame sent, as the server counts them
        self.on_their_way: list[int] = []
        self.code, self.reason = 1000, ""
        self.room = asyncio.Event()
        self.lock = asyncio.Lock()

    async def send(self) -> None:
        """Frames as they come and the client has room, and what else is new."""
        live, told = self.live, ""
        hello = {"hello": VERSION, "topology": live.topology, "session": summary(live), "view": live.views}
        await self._text(hello)
        while not (self.sessions.closing or live.gone):
            news = live.news
            now = json.dumps([live.topology, live.process is None, live.notes, live.views,
                              [live.described.get(n) for n in _NEWS],
                              live.described.get("message") if not live.playing else ""])  # fmt: skip
            if now != told:
                told = now
                await self._text({"state": summary(live), "topology": live.topology, "view": live.views})
            if len(self.on_their_way) < IN_FLIGHT:
                self.room.clear()
                if live.frame and live.frame_number != self.sent:
                    await self._frame()
                    continue
                live.want_frame()
                await news.wait()
            else:
                await _either(self.room, news)

    async def _frame(self) -> None:
        live = self.live
        skipped = live.frame_number - self.sent - 1 if self.sent else 0
        follows = self.changes and self.sent and not skipped
        frame = (follows and live.changes) or live.frame
        self.sent = live.frame_number
        number = int.from_bytes(live.frame[12:16], "little")
        self.on_their_way.append(number)
        self.sessions.frames_sent += 1
        self.sessions.frames_skipped += max(0, skipped)
        async with self.lock:
            await self.socket.send_bytes(frame)

    async def receive(self) -> None:
        """Acknowledgements at once; edits and commands in their order."""
        orders: asyncio.Queue[dict[str, Any]] = asyncio.Queue(64)
        worker = asyncio.create_task(self._obey(orders))
        try:
            while True:
                message = await self.socket.receive()
                if message["type"] == "websocket.disconnect":
                    return
                value = _message(message.get("text"))
                if "ack" in value:
                    self._received(value["ack"])
                else:
                    await orders.put(value)
        except Problem as problem:
            self.code, self.reason = 1003, problem.detail
        finally:
            worker.cancel()

    def _received(self, number: int) -> None:
        """A frame was received, and all before it. Numbers begin again with each process of the session, so frames are
        found by their order, not by how large their numbers are."""
        sent = self.on_their_way
        if number in sent:
            self.on_their_way = sent[len(sent) - sent[::-1].index(number) :]
        else:
            self.on_their_way = [n for n in sent if n > number]
        self.room.set()

    async def _obey(self, orders: asyncio.Queue[dict[str, Any]]) -> None:
        while True:
            order = await orders.get()
            answer: dict[str, Any] = {"id": order.get("id")}
            try:
                await self._done(order)
            except Problem as problem:
                answer["problem"] = json.loads(problem.body(f"{self.live.key}"))
            async with self.lock:
                if "problem" not in answer:  # as it stands now: a newer state may have been sent first
                    answer["session"] = summary(self.live)
                await self.socket.send_text(json.dumps(answer))

    async def _done(self, order: dict[str, Any]) -> None:
        live, do = self.live, order.get("do")
        if self.socket.scope.get("guest"):
            raise Problem("read-only", READ_ONLY)
        if "edit" in order:
            await self.sessions.edit(live, json.dumps(order["edit"]).encode(), order.get("revision"))
        elif do in ("reset", "undo", "redo"):
            await self.sessions.edit(live, json.dumps({do: True}).encode())
        elif do == "step" and isinstance(order.get("frames", 1), int) and 1 <= order.get("frames", 1) <= 100_000:
            await self.sessions.command(live, "step", frames=order.get("frames", 1))
        elif do == "play":
            await self.sessions.command(live, "play", fast=order.get("fast") is True)
        elif do in ("relax", "pause"):
            await self.sessions.command(live, do)
        else:
            said = "A message is an ack, an edit, or do: play, relax, pause, step, reset, undo, redo."
            raise Problem("invalid-input", said)

    async def _text(self, value: dict[str, Any]) -> None:
        async with self.lock:
            await self.socket.send_text(json.dumps(value))


async def _either(one: asyncio.Event, other: asyncio.Event) -> None:
    tasks = [asyncio.ensure_future(one.wait()), asyncio.ensure_future(other.wait())]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()


def _message(text: str | None) -> dict[str, Any]:
    """A message of a client; raises Problem if it is invalid."""
    try:
        value = parse(text) if text is not None else None
    except InputError as error:
        raise Problem("bad-request", f"A message that is not JSON: {error.sentence}") from None
    whole = isinstance(value, dict) and (isinstance(value["ack"], int) if "ack" in value else True)
    if not whole:
        raise Problem("bad-request", "Messages are JSON objects in text; ack is the number of a frame.")
    assert isinstance(value, dict)
    return value
