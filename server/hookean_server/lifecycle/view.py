"""The page of a session as a program that shows something in it has it."""

from __future__ import annotations

import html
import io
import logging
import secrets
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

import numpy as np
from numpy.typing import ArrayLike, NDArray

import hookean_client
from hookean.errors import InputError
from hookean.running.placing import placed, resumed
from hookean.running.result import Result
from hookean.running.simulation import Simulation
from hookean.scene.scene import Scene
from hookean_server.lifecycle.studio import form

log = logging.getLogger("hookean.show")

PAUSE = 0.2  # seconds between looks whether something was edited
HEIGHT = 600  # CSS pixels of the page in a notebook
FRAME = """<iframe id="{name}" title="hookean studio" width="100%" height="{height}" style="border: 0"></iframe>
<p><a href="{url}" target="_blank" rel="noopener">Open in a browser</a></p>
<script>(() => {{
  // a cookie belongs to a host: the frame needs the name of the host of this page
  const here = location.hostname === "localhost" ? "localhost" : "127.0.0.1";
  document.getElementById("{name}").src = "{address}".replace("127.0.0.1", here);
}})();</script>"""


@dataclass(frozen=True)
class Picked:
    """What is picked in the page: a `particle`, or a `spring` of the topology, by its number."""

    kind: str
    index: int


@dataclass(frozen=True)
class Edited:
    """An edit made in the page: the `revision` it led to, and the `patch`, as `Simulation.patch` takes it with its
    gesture; `{"undo": True}`, `redo` and `reset` for these."""

    revision: int
    patch: dict[str, Any]


class View:
    """A scene that is shown in the studio. In a notebook it is the page.

    `key` names its session on the service. What fails raises InputError where the input is at fault, ConnectionError
    where the service does not answer or the session was deleted.
    """

    def __init__(self, client: hookean_client.Client, key: str) -> None:
        self.key = key
        self._client = client
        self._session = client.session(key)
        self._own: set[int] = set()  # revisions that this program led to
        self._seen = 0  # the last revision whose edits were reported
        self._callbacks: list[Callable[[Edited], object]] = []
        self._closed = threading.Event()
        self._lock = threading.Lock()

    def __repr__(self) -> str:
        return f"View({self.url})"

    def _repr_html_(self) -> str:
        made = self._ask("POST", "/v1/login/codes")
        address = f"{self._client.url}/?frame={quote(made['frame'])}#t={quote(made['code'])}&s={quote(self.key)}"
        name = f"hookean-{secrets.token_hex(6)}"
        return FRAME.format(name=name, address=address, url=html.escape(self.url), height=HEIGHT)

    @property
    def url(self) -> str:
        """The address of the page. It has no token: a browser that is not logged in asks for it."""
        return f"{self._client.url}/#s={quote(self.key)}"

    @property
    def pick(self) -> Picked | None:
        """What is picked in the page; None for nothing."""
        picked = self._ask("GET", f"{self._session.path}/view")["picked"]
        return None if picked is None else Picked(picked["kind"], picked["index"])

    @property
    def scene(self) -> Scene:
        """The scene with all edits, with its particles where they start."""
        return Scene.read(self._ask("GET", f"{self._session.path}/scene"))

    @property
    def particles(self) -> NDArray[np.float64]:
        """Where the particles are now, (n, 3) [length]."""
        return np.asarray(self._ask("GET", f"{self._session.path}/state")["particles"], np.float64)

    def on_edit(self, callback: Callable[[Edited], object]) -> Callable[[Edited], object]:
        """Call `callback` with each edit that others make from now on, in the page above all, in a thread of its own.
        A drag is one edit whose target changes. Returns the callback, so this is a decorator, too."""
        with self._lock:
            if not self._callbacks:
                self._seen = int(self._ask("GET", self._session.path)["revision"])
                threading.Thread(target=self._listen, name=f"hookean-view-{self.key}", daemon=True).start()
            self._callbacks.append(callback)
        return callback

    def update(
        self,
        scene: Scene | Result | Simulation | Mapping[str, Any] | None = None,
        *,
        positions: ArrayLike | None = None,
        values: ArrayLike | None = None,
        title: str = "Values",
        unit: str = "-",
    ) -> None:
        """Show something else in the page.

        `scene`: another scene, whose particles stay where they are now if they start where one of the old scene did; or
        a result or simulation in its shape. `positions` (n, 3) [length]: the particles of this scene elsewhere, at
        rest. Both replace the model, so earlier edits cannot be undone. `values`: numbers that colour the springs, one
        for each spring (in the order of the scene's forces) or one for each particle; a spring then has the mean of its
        ends. `title` and `unit` are shown in the legend.
        """
        if scene is None and positions is None and values is None:
            raise InputError("update", "nothing is given; give a scene, positions or values")
        if isinstance(scene, Result):
            scene = resumed(scene)
        if positions is not None:
            now = scene.scene if isinstance(scene, Simulation) else self.scene if scene is None else Scene.read(scene)
            scene = placed(now, positions)
        if scene is not None:
            self._put(scene)
        if values is not None:
            self._colour(values, title, unit)

    def close(self) -> None:
        """Stop calling callbacks and delete the session: the page shows that it is gone."""
        self._closed.set()
        try:
            self._session.delete()
        except hookean_client.Problem as problem:
            if problem.slug != "not-found":
                raise _error(problem) from None
        finally:
            self._client.close()

    def _put(self, scene: Scene | Simulation | Mapping[str, Any]) -> None:
        if isinstance(scene, Simulation):
            stream = io.BytesIO()
            scene.save(stream)
            body, kind = form("shown.npz", stream.getvalue())
        else:
            body, kind = Scene.read(scene).canonical.encode(), "application/json"
        self._own_edit("PUT", self._session.path, body, {"content-type": kind})

    def _colour(self, values: ArrayLike, title: str, unit: str) -> None:
        try:
            numbers = np.asarray(values, np.float64)
        except (TypeError, ValueError):
            raise InputError("values", "give numbers, one for each spring or particle") from None
        shape = self._ask("GET", f"{self._session.path}/topology")
        counts = {"springs": len(shape["springs"]), "particles": shape["particles"]}
        kind = next((kind for kind, count in counts.items() if numbers.shape == (count,)), "")
        if not counts["springs"]:
            raise InputError("values", "the scene has no springs to colour")
        if not kind:
            known = f"give {counts['springs']}, one for each spring, or {counts['particles']}, one for each particle"
            raise InputError("values", f"have the shape {numbers.shape}; {known}")
        if not np.isfinite(numbers).all():
            raise InputError("values", "have numbers that are not finite; give finite numbers")
        colours = {"title": title, "unit": unit, "of": kind, "values": numbers.tolist()}
        self._ask("PATCH", f"{self._session.path}/view", {"colours": colours})

    def _listen(self) -> None:
        """Report edits until the view is closed."""
        while not self._closed.wait(PAUSE):
            try:
                if int(self._ask("GET", self._session.path)["revision"]) == self._seen:
                    continue
                with self._lock:  # an edit of this program is under way until its revision is known
                    revision = int(self._ask("GET", self._session.path)["revision"])
                    found = self._ask("GET", f"{self._session.path}/edits", query={"after": self._seen})["edits"]
                    others = [one for one in found if one["revision"] not in self._own]
                    self._seen = max([revision, *(one["revision"] for one in found)])
                    callbacks = list(self._callbacks)
            except ConnectionError:
                continue  # the service is starting again, or ended
            for edit in others:
                self._report(callbacks, Edited(edit["revision"], edit["edit"]))

    def _report(self, callbacks: list[Callable[[Edited], object]], edited: Edited) -> None:
        for callback in callbacks:
            try:
                callback(edited)
            except Exception:
                log.exception("a callback of on_edit failed at revision %d", edited.revision)

    def _own_edit(self, method: str, path: str, body: bytes, headers: dict[str, str]) -> None:
        with self._lock:
            self._own.add(int(self._ask(method, path, body, headers)["revision"]))

    def _ask(
        self,
        method: str,
        path: str,
        body: Any = None,
        headers: Mapping[str, str] | None = None,
        query: Mapping[str, Any] | None = None,
    ) -> Any:
        try:
            return self._client.request(method, path, body, query, headers)
        except hookean_client.Problem as problem:
            raise _error(problem) from None


def _error(problem: hookean_client.Problem) -> Exception:
    """What a program gets for a problem: its input is at fault, or the service is not there."""
    if problem.errors:
        return InputError(*problem.errors[0])
    return ConnectionError(problem.detail)
