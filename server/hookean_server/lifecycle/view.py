"""The page of a session, for the program that shows something in it."""

from __future__ import annotations

import html
import io
import json
import logging
import secrets
import threading
from collections.abc import Callable, Mapping
from typing import Any
from urllib.parse import quote

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.errors import InputError
from hookean.running.placing import placed, resumed
from hookean.running.result import Result
from hookean.running.showing import Edited, Picked, View
from hookean.running.simulation import Simulation
from hookean.scene.scene import Scene
from hookean_server.lifecycle.discovery import Found, find, folder
from hookean_server.lifecycle.studio import Refused, form, request

Shown = Scene | Result | Simulation | Mapping[str, Any]

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


class Page(View):
    """A session of the service, by its `key`, as `hookean.View` describes it."""

    def __init__(self, found: Found, key: str) -> None:
        self.key = key
        self._found = found
        self._path = f"/v1/sessions/{quote(key, safe='')}"
        self._own: set[int] = set()  # revisions that this program led to
        self._seen = 0  # the last revision whose edits were reported
        self._callbacks: list[Callable[[Edited], object]] = []
        self._closed = threading.Event()
        self._lock = threading.Lock()

    def __repr__(self) -> str:
        return f"View({self.url})"

    def _repr_html_(self) -> str:
        made = self._ask("POST", "/v1/login/codes")
        address = f"{self._found.url}/?frame={quote(made['frame'])}#t={quote(made['code'])}&s={quote(self.key)}"
        name = f"hookean-{secrets.token_hex(6)}"
        return FRAME.format(name=name, address=address, url=html.escape(self.url), height=HEIGHT)

    @property
    def url(self) -> str:
        return f"{self._found.url}/#s={quote(self.key)}"

    @property
    def pick(self) -> Picked | None:
        picked = self._ask("GET", f"{self._path}/view")["picked"]
        return None if picked is None else Picked(picked["kind"], picked["index"])

    @property
    def scene(self) -> Scene:
        return Scene.read(self._ask("GET", f"{self._path}/scene"))

    @property
    def particles(self) -> NDArray[np.float64]:
        return np.asarray(self._ask("GET", f"{self._path}/state")["particles"], np.float64)

    def on_edit(self, callback: Callable[[Edited], object]) -> Callable[[Edited], object]:
        with self._lock:
            if not self._callbacks:
                self._seen = int(self._ask("GET", self._path)["revision"])
                threading.Thread(target=self._listen, name=f"hookean-view-{self.key}", daemon=True).start()
            self._callbacks.append(callback)
        return callback

    def begin(self, scene: Shown) -> None:
        """Make the session, or show this in the one that has its key."""
        self._put(resumed(scene) if isinstance(scene, Result) else scene)

    def update(
        self,
        scene: Shown | None = None,
        *,
        positions: ArrayLike | None = None,
        values: ArrayLike | None = None,
        title: str = "Values",
        unit: str = "-",
    ) -> None:
        if scene is None and positions is None and values is None:
            raise InputError("update", "nothing is given; give a scene, positions or values")
        self._ask("GET", self._path)  # a session that was deleted is not made again
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
        self._closed.set()
        if self._request("DELETE", self._path)[0] not in (204, 404):
            raise ConnectionError(f"The session {self.key} could not be deleted; try again.")

    def _put(self, scene: Scene | Simulation | Mapping[str, Any]) -> None:
        if isinstance(scene, Simulation):
            stream = io.BytesIO()
            scene.save(stream)
            body, kind = form("shown.npz", stream.getvalue())
        else:
            body, kind = Scene.read(scene).canonical.encode(), "application/json"
        self._own_edit(body, kind)

    def _colour(self, values: ArrayLike, title: str, unit: str) -> None:
        try:
            numbers = np.asarray(values, np.float64)
        except (TypeError, ValueError):
            raise InputError("values", "give numbers, one for each spring or particle") from None
        shape = self._ask("GET", f"{self._path}/topology")
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
        self._ask("PATCH", f"{self._path}/view", json.dumps({"colours": colours}).encode())

    def _listen(self) -> None:
        """Report edits until the view is closed."""
        while not self._closed.wait(PAUSE):
            try:
                if int(self._ask("GET", self._path)["revision"]) == self._seen:
                    continue
                with self._lock:  # an edit of this program is under way until its revision is known
                    revision = int(self._ask("GET", self._path)["revision"])
                    found = self._ask("GET", f"{self._path}/edits?after={self._seen}")["edits"]
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

    def _own_edit(self, body: bytes, kind: str) -> None:
        with self._lock:
            self._own.add(int(self._ask("PUT", f"{self._path}?label={quote(self.key)}", body, kind)["revision"]))

    def _ask(self, method: str, path: str, body: bytes = b"", kind: str = "application/json") -> Any:
        """The answer of the service; what it refuses is an InputError where it names the place."""
        status, answer = self._request(method, path, body, kind)
        if status < 400:
            return answer
        if status == 404:
            raise ConnectionError(f"The session {self.key} was deleted; show the scene again with hookean.show.")
        for error in answer.get("errors", []):
            raise InputError(error["pointer"], error["detail"])
        raise ConnectionError(str(answer.get("detail")))

    def _request(
        self, method: str, path: str, body: bytes = b"", kind: str = "application/json"
    ) -> tuple[int, dict[str, Any]]:
        try:
            return request(self._found, method, path, body, kind)
        except Refused as error:
            found = find(folder())  # it may have been started again
            if found is None or found == self._found:
                raise ConnectionError(str(error)) from None
            self._found = found
            return self._request(method, path, body, kind)
