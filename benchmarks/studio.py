"""Figures of the studio with a large model: frames on the page's main thread, what a drag costs, what it sends.

Run it with `make bench-studio` on a quiet machine. It starts a server of its own and a headless Chromium, opens a net
of 99,856 particles, and prints one line for each figure with the bar it is held to. Times are of the processor, but for
frames, of which the median counts; the process that draws in place of a graphics card is left out.
"""

from __future__ import annotations

import argparse
import os
import shutil
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil
from playwright.sync_api import CDPSession, Page, Response, sync_playwright
from service import Server, net, show

BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--js-flags=--expose-gc"]
FRAMES, MOVES = 200, 25
PATIENCE = 120.0  # seconds for whatever is waited for

Sum = dict[str, float]


class Watched:
    """A page on a session, and what it and the server use of the processor [ms]."""

    def __init__(self, page: Page, server: Server, key: str) -> None:
        self.page, self.server, self.key = page, server, key
        self.devtools: CDPSession = page.context.new_cdp_session(page)
        self.read: list[tuple[str, int]] = []  # address and bytes of what was read by HTTP
        self.sent: list[int] = []  # bytes of each message of the sockets
        page.on("response", self._answered)
        self.devtools.send("Network.enable")
        self.devtools.on("Network.webSocketFrameReceived", self._heard)
        page.goto(f"{server.url}/#t={server.headers['authorization'].removeprefix('Bearer ')}")
        page.get_by_role("heading", level=1).first.wait_for()
        page.goto(f"{server.url}/#s={key}")
        page.wait_for_function("() => window.hookean?.stats.framesDrawn > 0")

    def _answered(self, response: Response) -> None:
        self.read.append((response.url, int(response.headers.get("content-length", 0))))

    def _heard(self, event: Any) -> None:
        data, code = event["response"]["payloadData"], event["response"]["opcode"]
        self.sent.append(len(data) if code == 1 else 3 * len(data) // 4)

    def stats(self) -> dict[str, Any]:
        found: dict[str, Any] = self.page.evaluate("() => structuredClone(window.hookean.stats)")
        return found

    def processor(self) -> Sum:
        """Milliseconds of processor time so far: of the server and its sessions, of the page, of what draws for it."""
        browser = next(p for p in psutil.Process().children(recursive=True) if "chrom" in p.name())
        while (above := browser.parent()) is not None and "chrom" in above.name():
            browser = above
        found = {"server": 0.0, "page": 0.0, "scripts": 0.0, "renderer": 0.0}
        for process in (psutil.Process(self.server.process.pid), browser):
            for one in [process, *process.children(recursive=True)]:
                if process is not browser:
                    found["server"] += spent(one)
                elif "--type=renderer" in one.cmdline():
                    found["page"] += spent(one)
                    found["scripts"] += spent(one, main=True)
                elif "--type=gpu-process" in one.cmdline():
                    found["renderer"] += spent(one)
        return found

    def heap(self) -> float:
        """Bytes of the page's scripts and arrays, once all is thrown away that can be; the least of some."""
        found = []
        for _ in range(4):
            self.devtools.send("HeapProfiler.collectGarbage")
            told: dict[str, Any] = self.devtools.send("Runtime.getHeapUsage")
            found.append(told["usedSize"] + told.get("backingStorageSize", 0.0))
            self.page.wait_for_timeout(300)
        return float(min(found))

    def until(self, true: Callable[[], Any]) -> None:
        over = time.monotonic() + PATIENCE
        while not true():
            if time.monotonic() > over:
                raise SystemExit("the page does not go on")
            self.page.wait_for_timeout(20)

    def place(self, particle: int) -> Sum:
        """Where a particle is drawn, once the eye has come to rest [CSS pixels]."""
        before: Sum = {}
        ask = "(particle) => window.hookean.project(particle)"
        while not (now := self.page.evaluate(ask, particle)) or now != before:
            before = now
            self.page.wait_for_timeout(700)
        return before

    def press(self, name: str) -> None:
        self.page.get_by_role("button", name=name, exact=True).click()


def spent(process: psutil.Process, main: bool = False) -> float:
    """Processor time of all threads of a process, or of the main one [ms], to the nanosecond where the system tells."""
    threads = Path(f"/proc/{process.pid}/task")
    if not threads.is_dir():
        times = process.cpu_times()
        return 1000.0 * float(times.user + times.system)
    counted = [threads / str(process.pid)] if main else threads.iterdir()
    return sum(int((thread / "schedstat").read_text().split()[0]) for thread in counted) / 1e6


def parts(stats: dict[str, Any], count: int) -> str:
    """What the last frames took on the main thread, by what was done with them: medians [ms]."""
    lists = [stats[f"{name}Milliseconds"][-count:] for name in ("decode", "colour", "upload")]
    return " + ".join(f"{statistics.median(found):.2f}" if found else "-" for found in lists) + " ms"


def frames(watched: Watched, count: int) -> None:
    """What a frame of a net in motion takes on the main thread."""
    watched.press("Play")
    first = watched.stats()["framesDrawn"]
    watched.until(lambda: watched.stats()["framesDrawn"] > first + 5)
    before, weight = watched.stats(), watched.heap()
    watched.until(lambda: watched.stats()["framesDrawn"] >= before["framesDrawn"] + count)
    after, heavier = watched.stats(), watched.heap()
    watched.press("Pause")
    drawn = after["framesDrawn"] - before["framesDrawn"]
    show("decode + colour + upload of a frame, median", parts(after, count), "<= 12 ms together")
    show(f"heap after {drawn} more frames", f"{(heavier - weight) / 1e6:+.2f} MB", "flat")


def drag(watched: Watched, playing: bool, count: int) -> None:
    """What a move of an anchor takes until the frame with it is drawn."""
    page = watched.page
    watched.press("Play" if playing else "Pause")
    page.wait_for_timeout(1500)
    at = watched.place(0)
    page.mouse.move(at["x"], at["y"])
    page.mouse.down()
    used: list[Sum] = []
    waits: list[float] = []
    for step in range(1, count + 1):
        before = watched.processor()
        revision, began = watched.stats()["revisionDrawn"], time.monotonic()
        if step == 2:  # the first one takes hold
            read, sent, all_of_it = len(watched.read), len(watched.sent), before
        page.mouse.move(at["x"] + 6 + 2 * step, at["y"] - step)
        page.wait_for_function("(before) => window.hookean.stats.revisionDrawn > before", arg=revision, polling=16)
        waits.append(1000 * (time.monotonic() - began))
        after = watched.processor()
        used.append({name: after[name] - before[name] for name in after})
        page.wait_for_timeout(30)
    whole = {name: (after[name] - all_of_it[name]) / (count - 1) for name in after}
    got = watched.read[read:]
    told = watched.sent[sent:]
    took = parts(watched.stats(), count - 1)
    page.mouse.up()
    page.wait_for_timeout(1500)
    middle = {name: statistics.median(one[name] for one in used[1:]) for name in used[0]}
    how = "while it plays" if playing else "paused"
    show(f"a drag {how}: processor, server + page", f"{middle['server']:.0f} + {middle['page']:.0f} ms", "<= 150 ms")
    show(f"a drag {how}: all processor time by moves", f"{whole['server']:.0f} + {whole['page']:.0f} ms", "<= 150 ms")
    show(f"a drag {how}: of the page its main thread, not compositing", f"{middle['scripts']:.0f} ms", "none")
    show(f"a drag {how}: processor of the software renderer", f"{middle['renderer']:.0f} ms", "none")
    show(f"a drag {how}: to the frame with it, here", f"{statistics.median(waits):.0f} ms", "none: load counts")
    show(f"a drag {how}: decode + colour + upload, median", took, "<= 12 ms together")
    show(f"a drag {how}: socket, each move", f"{sum(told) / (count - 1) / 1e3:.0f} kB in {len(told)} messages", "none")
    show(f"a drag {how}: HTTP", f"{len(got)} requests, {sum(size for _, size in got) / 1e6:.2f} MB", "none read")
    if playing:
        watched.press("Pause")
    for action in ("undo", "reset"):
        watched.server.client.post(f"/v1/sessions/{watched.key}/{action}").raise_for_status()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, default=316, help="particles on each side of the net")
    parser.add_argument("--frames", type=int, default=FRAMES)
    parser.add_argument("--moves", type=int, default=MOVES)
    told = parser.parse_args()
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        raise SystemExit("there is no Chromium here")
    print(f"{told.side**2:,} particles; {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    scene = net(told.side)
    scene["settings"] = {"drag": 0.2, "max_iterations": 10**9, "tolerance": 0}
    with tempfile.TemporaryDirectory(prefix="hookean-bench-") as folder, sync_playwright() as driver:
        server = Server(Path(folder) / "sessions.db")
        try:
            server.client.put("/v1/sessions/net", json=scene).raise_for_status()
            launched = driver.chromium.launch(executable_path=browser, args=FLAGS)
            page = launched.new_page(viewport={"width": 1280, "height": 800})
            page.set_default_timeout(1000 * PATIENCE)
            watched = Watched(page, server, "net")
            drag(watched, False, told.moves)
            drag(watched, True, told.moves)
            frames(watched, told.frames)
            if os.environ.get("PICTURE"):
                page.screenshot(path=os.environ["PICTURE"])
            launched.close()
        finally:
            server.process.terminate()
            server.process.wait()


if __name__ == "__main__":
    main()
