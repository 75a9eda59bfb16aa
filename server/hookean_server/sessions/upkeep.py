"""What is done for sessions besides their use: old edits join the base, sessions unused for long are forgotten."""

from __future__ import annotations

import logging
import time
from contextlib import suppress
from typing import TYPE_CHECKING

from hookean_server.problems import Problem
from hookean_server.sessions import rows
from hookean_server.sessions.live import Live
from hookean_server.sessions.process import SessionProcess
from hookean_server.sessions.register import Deleted

if TYPE_CHECKING:
    from hookean_server.sessions.manager import Manager

log = logging.getLogger("hookean.sessions")

AGAIN = 50  # edits until old ones are made part of the base again
SECONDS = 600.0  # that it may take


async def fold(manager: Manager, live: Live) -> None:
    """Make edits that cannot be taken back any more part of the base, in a process of its own; where that fails, the
    next edit tries again."""
    process: SessionProcess | None = None
    try:
        found: rows.Stored | None = await manager.store.run(rows.load(live.key))
        if found is None or live.gone:  # what was read is of another session under its key
            return
        process = await SessionProcess.begun(manager.settings.worker_memory, lambda *_: None)
        body, sizes = b"".join((found.base, *found.edits)), [len(part) for part in (found.base, *found.edits)]
        head, base = await process.call("fold", body, seconds=SECONDS, sizes=sizes, revisions=found.revisions)
        if count := head["count"]:
            revision = found.revisions[count - 1]
            await manager.store.run(rows.rebase(live.key, found.since, found.number + count, revision, base))
        live.edits -= count
        live.fold_at = live.edits + AGAIN
    except Problem as problem:
        log.warning("edits of a session could not be merged into its base: %s", problem.detail)
    finally:
        if process is not None:
            process.kill()
        live.folding = False


async def forget(manager: Manager, seconds: float) -> None:
    """So many seconds have passed: forget sessions that nobody used for long, which reading is, too."""
    now = time.monotonic()
    used = [key for key, live in manager.sessions.items() if not live.rests or now - live.used < seconds]
    with suppress(Problem):
        for key in await manager.store.run(rows.age(seconds, manager.settings.session_seconds, used)):
            if (live := manager.sessions.get(key)) is not None:
                with suppress(Deleted):
                    await _outlived(manager, live, now)
            elif key not in manager.making:  # nobody knows of it: who began it has left
                await manager.store.run(rows.delete(key))


async def _outlived(manager: Manager, live: Live, since: float) -> None:
    """Forget a session, unless somebody has used it `since`, or does now."""
    async with manager.held(live):
        if live.used < since and not live.in_use:
            await manager.store.run(rows.delete(live.key))
            manager.drop(live)
