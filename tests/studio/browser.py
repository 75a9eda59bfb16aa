"""The page in a browser, as a person has it: what is found is found by role and name."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize import grid
from serving import HANG

from .service import Service

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, ConsoleMessage, Page, Request, Response, WebSocketRoute

FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--js-flags=--expose-gc",
    # pages that draw the same things share what the software renderer has compiled: a tenth less of its time
    "--enable-angle-features=preferGlobalPipelineCache",
]
LATEST = """([what, ...told]) => new Promise((done) => {
    const look = (tries) => {
        const now = window.hookean[what](...told);
        if (!tries || (now && now.length !== 0)) done(what === "particles" ? [...now] : now);
        else setTimeout(() => look(tries - 1), 10);
    };
    look(500);
})"""
"""What the page tells of what it draws; for a moment after an edit it draws nothing that is of now."""
ALTERING = ("on", "once", "add_init_script", "route", "route_web_socket", "expose_function", "expose_binding")
"""Methods of a page whose effect remains when it goes elsewhere."""
LAPTOP = {"width": 1280, "height": 800}
PHONE = {"width": 390, "height": 844}


@dataclass
class Studio:
    """One browser with its cookies, logged in to a service, and the page in it."""

    page: Page
    service: Service
    wrong: list[str] = field(default_factory=list)
    """What should not have happened: errors on the console, refused requests, violated policies."""
    allowed: list[str] = field(default_factory=list)
    """Patterns of what may happen all the same, as where the service is killed."""

    listeners: list[tuple[Any, Callable[..., None]]] = field(default_factory=list)
    called: list[str] = field(default_factory=list)
    """Methods among `ALTERING` that a test has called."""

    def watch(self) -> None:
        """Note from now on what goes wrong, and whether the page gets what outlives its documents."""
        self.listeners = [
            ("console", self._said),
            ("pageerror", lambda error: self.wrong.append(f"exception: {error}")),
            ("requestfailed", self._failed),
            ("response", self._answered),
        ]
        for event, listener in self.listeners:
            self.page.on(event, listener)
        for name in ALTERING:
            setattr(self.page, name, partial(self._alter, name, getattr(self.page, name)))

    def unwatch(self) -> None:
        """The page as it was before `watch`."""
        for name in ALTERING:
            vars(self.page).pop(name, None)
        for event, listener in self.listeners:
            self.page.remove_listener(event, listener)

    def _alter(self, name: str, call: Callable[..., Any], *given: Any, **named: Any) -> Any:
        self.called.append(name)
        return call(*given, **named)

    def _said(self, message: ConsoleMessage) -> None:
        # how fast the graphics of a machine without a card are is not the page's
        if message.type in ("error", "warning") and "GL Driver Message (OpenGL, Performance" not in message.text:
            self.wrong.append(f"console {message.type}: {message.text}")

    def _failed(self, request: Request) -> None:
        if request.failure != "net::ERR_ABORTED":  # left for another page
            self.wrong.append(f"failed: {request.url} {request.failure}")

    def _answered(self, response: Response) -> None:
        if response.status >= 400:
            self.wrong.append(f"{response.status}: {response.request.method} {response.url}")

    def unexpected(self) -> list[str]:
        return [said for said in self.wrong if not any(re.search(pattern, said) for pattern in self.allowed)]

    # where one goes

    def start(self) -> None:
        """The start page, with the token behind the # of its address as `hookean token --url` prints it."""
        self.page.goto(f"{self.service.url}/#t={self.service.token}")
        self.page.get_by_role("heading", level=1).first.wait_for()

    def open(self, key: str) -> None:
        """A session by its link, once its particles are drawn."""
        self.page.goto(f"{self.service.url}/#s={key}")
        self.drawing()

    def drawing(self) -> None:
        """Wait until particles are drawn."""
        self.page.wait_for_function(
            "() => window.hookean?.particles().length > 0 && window.hookean.stats.framesDrawn > 0"
        )

    def choose(self, name: str) -> str:
        """A figure of the gallery, by the title its card has; the key of its session."""
        listed = self.service.client.get("/v1/examples").json()["examples"]
        [card] = [f"{example['figure']} {example['title']}" for example in listed if example["id"] == name]
        self.page.get_by_role("button", name=card).click()
        self.drawing()
        return self.key

    def press(self, name: str) -> None:
        """A button, by its name."""
        self.page.get_by_role("button", name=name, exact=True).click()

    @property
    def key(self) -> str:
        """The session whose link the address is."""
        found = re.search(r"#s=([^&]+)", self.page.url)
        assert found, self.page.url
        return found[1]

    # what is seen

    def stats(self) -> dict[str, Any]:
        found: dict[str, Any] = self.page.evaluate("() => structuredClone(window.hookean.stats)")
        return found

    def particles(self) -> NDArray[np.float64]:
        """What is drawn, in the scene's unit of length."""
        return np.array(self.page.evaluate(LATEST, ["particles"]), float).reshape(-1, 3)

    def place(self, particle: int) -> tuple[float, float]:
        """Where a particle is drawn, in CSS pixels, once the eye has come to rest."""
        places = [(0.0, 0.0), self.seen(particle)]
        while np.abs(np.subtract(*places[-2:])).max() > 0.5:
            self.page.wait_for_timeout(150)
            places.append(self.seen(particle))
        return places[-1]

    def seen(self, particle: int) -> tuple[float, float]:
        """Where a particle is drawn just now, in CSS pixels."""
        found = self.page.evaluate(LATEST, ["project", particle])
        assert found, f"particle {particle} is behind the eye"
        return found["x"], found["y"]

    def drag(self, particle: int, across: float, down: float, steps: int = 12) -> tuple[float, float]:
        """Take a particle by mouse and let it go so many CSS pixels away; where that is."""
        x, y = self.place(particle)
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        for step in range(1, steps + 1):
            self.page.mouse.move(x + across * step / steps, y + down * step / steps)
            self.page.wait_for_timeout(20)
        self.page.mouse.up()
        return x + across, y + down

    def settled(self) -> None:
        """Wait until no edit has come for a while: the last of a gesture lands after the hand has let go."""
        revisions = [-1]
        while revisions[-1] != (now := self.service.summary(self.key)["revision"]):
            revisions.append(now)
            self.page.wait_for_timeout(800)

    def rests_at(self, truth: NDArray[np.float64], within: float = 1e-4) -> None:
        """Wait until every particle is drawn where it belongs [length]."""
        drawn = self.particles
        self.until(lambda: (now := drawn()).shape == truth.shape and np.abs(now - truth).max() < within)

    def until(self, true: Callable[[], Any], seconds: float = HANG / 3, what: str = "") -> Any:
        """What `true()` is, once it is; the page goes on meanwhile."""
        over = time.monotonic() + seconds
        while time.monotonic() < over:
            if found := true():
                return found
            self.page.wait_for_timeout(50)
        raise AssertionError(f"waited {seconds} s for {what or 'what did not come'}")


def context(browser: Any, **options: Any) -> BrowserContext:
    """A browser of somebody: own cookies, nothing from before."""
    made: BrowserContext = browser.new_context(**{"viewport": LAPTOP, "accept_downloads": True, **options})
    made.set_default_timeout(1000 * HANG / 3)  # ms; kernels are compiled meanwhile
    return made


def net(side: int) -> dict[str, Any]:
    """A square net held at its corners that swings for ever, with its skin."""
    mesh = {name: rows.tolist() for name, rows in vars(grid(np.arange(side), np.arange(side))).items()}
    return {
        "particles": mesh["vertices"],
        "meshes": {"net": mesh},
        "forces": [
            {"kind": "springs", "mesh": "net", "stiffness": 500.0, "damping": 0.0},
            {"kind": "unary", "particles": list(range(side * side)), "vector": [0.0, 0.0, -0.02]},
        ],
        "anchors": [{"particles": [0, side - 1, side * (side - 1), side * side - 1]}],
        "settings": {"solver": "verlet", "drag": 0, "time_step": 0.01, "max_iterations": 10**9, "tolerance": 0},
    }


class Wire:
    """Between the page, loaded anew, and the frames of its session: what the service tells can be kept back."""

    def __init__(self, studio: Studio) -> None:
        self.sockets: list[WebSocketRoute] = []
        self.kept: list[str | bytes] | None = None
        studio.page.route_web_socket(re.compile(r"/frames\?"), self._between)
        studio.page.reload()
        studio.drawing()

    def keep(self) -> None:
        """Keep back what the service tells from now on."""
        self.kept = []

    def give(self) -> None:
        """Tell the page what was kept, and the rest as it comes."""
        kept, self.kept = self.kept or [], None
        for told in kept:
            self.sockets[-1].send(told)

    def cut(self) -> None:
        """End the connection."""
        self.sockets[-1].close(code=1011)

    def _between(self, socket: WebSocketRoute) -> None:
        self.sockets.append(socket)
        socket.connect_to_server().on_message(
            lambda told: socket.send(told) if self.kept is None else self.kept.append(told)
        )
