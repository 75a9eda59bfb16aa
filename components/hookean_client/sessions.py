"""Sessions of the service and the frames that come from them. For Python 2.7 to 3.13."""

import json
import struct
import threading

try:
    from urllib.parse import quote
except ImportError:  # Python 2
    from urllib import quote

from . import FAILURES, Problem, transport

STATUSES = "running converged stalled diverged max_iterations time_limit cancelled".split()
HEADER = struct.Struct("<4sHHIIQQddIIBBHf")
FIELDS = "magic version size flags number revision iteration time residual n m status playing _ kinetic".split()


class Session(object):
    """A session. `play(fast="true")`, `pause`, `step(frames=3)`, `reset`, `undo`, `redo`, `branches(to=key)`."""

    def __init__(self, client, key):
        self.client, self.key, self.path = client, key, "/v1/sessions/" + quote(key, safe=":~")

    def put(self, scene, **options):
        """Make it, or give it this scene."""
        return self.client.put(self.path, scene, **options)

    def edit(self, patch, **options):
        """Edit it: pin, release, move, forces, settings, gesture."""
        return self.client.patch(self.path, patch, **options)

    def read(self, part="", **query):
        """How it stands, or its scene, topology, anchors."""
        return self.client.get(self.path + ("/" + part if part else ""), None, query)

    def state(self, format="json", **query):
        """The present shape: json, compas, or the bytes of npz, 3dm, obj."""
        return self.read("state", format=format, **query)

    def delete(self):
        """Forget it."""
        return self.client.delete(self.path)

    def frames(self):
        """Its frames as they come."""
        return Frames(self)


def _action(name):
    return lambda self, timeout=60.0, **query: self.client.post(self.path + "/" + name, None, query, timeout=timeout)


for _name in ("play", "pause", "step", "reset", "undo", "redo", "branches"):
    setattr(Session, _name, _action(_name))


class Frames(object):
    """Frames of a session, received in a thread. `session`: how it stands; `topology` changes with the scene;
    `message`: why there are none; `lost`: a sentence for each lost connection; `ended`: it does not come back."""

    def __init__(self, session):
        self.session, self.topology, self.message, self.lost = {}, "", "", []
        self.ended, self.received = False, 0
        self._of, self._frame, self._link, self._since, self._connection = session, None, None, None, None
        self._news = threading.Condition()
        thread = threading.Thread(target=self._run, name="hookean-frames")
        thread.daemon = True
        thread.start()

    def latest(self):
        """The newest frame (see `decode`) or None."""
        return self._frame

    def wait(self, fits=bool, timeout=10.0):
        """The newest frame once `fits(frame)`, or None."""
        until = transport.now() + timeout
        with self._news:
            while not (self._frame and fits(self._frame)):
                if self.ended or transport.now() >= until:
                    return None
                self._news.wait(max(0.0, until - transport.now()))
            return self._frame

    def close(self):
        """No more frames."""
        self.ended, link = True, self._link
        transport.shut(self._connection)
        if link is not None:
            link.end()
        with self._news:
            self._news.notify_all()

    def _run(self):
        from . import websocket

        pause, client = 0.25, self._of.client
        while not self.ended:
            before = self.received
            try:
                self._connection = client._connection(transport.now() + transport.ANSWER, False)
                self._link = websocket.Link(self._connection, self._of.path + "/frames", client.token)
                while not self.ended:
                    self._take(*self._link.receive())
            except Problem as problem:
                self.message = problem.detail
                self.ended |= problem.slug in ("not-found", "wrong-version")
                if problem.status == 401:
                    client._other_token(client.token, transport.now() + transport.ANSWER)
            except FAILURES as error:
                self.message = "The connection was lost: %s." % error
            if self._link is not None:
                self._link.end()
            if self._connection is not None:  # also one that became no link
                self._connection.close()
            pause = 0.25 if self.received > before else min(4.0, 2 * pause)
            self._since = transport.now() if self.received > before else self._since
            with self._news:
                self._news.notify_all()
                if not self.ended:
                    self._news.wait(pause)

    def _take(self, kind, data):
        frame, value = (decode(data), {}) if kind == 2 else (None, json.loads(data.decode("utf-8")))
        if "hello" in value:
            transport.check(value["hello"])
            self.message = ""
            if self._since is not None:
                seen, now = [(s.get("revision"), s.get("iteration")) for s in (self._frame or {}, value["session"])]
                said = "Lost for %.1f s: from revision %s, iteration %s to %s, %s."
                self.lost = self.lost[-19:] + [said % ((transport.now() - self._since,) + seen + now)]
        with self._news:
            self.received += 1
            self._frame = frame or self._frame
            self.session = value.get("session") or value.get("state") or self.session
            self.topology = value.get("topology", self.topology)
            self._news.notify_all()
        if frame is not None:
            self._link.send(1, ('{"ack": %d}' % frame["number"]).encode("ascii"))


def decode(data):
    """A frame: FIELDS and flat x y z of `particles` and `reactions`; `scalars`: the force of each spring."""
    if data[:4] != b"HKFR" or len(data) < HEADER.size:
        raise ValueError("not a frame")
    frame = dict(zip(FIELDS, HEADER.unpack(data[: HEADER.size])))
    transport.check(frame["version"])
    end, last, count = 3 * frame["n"], 3 * frame["n"] + frame["m"], len(data) // 4 - 16
    if frame["flags"] & ~7 or frame["size"] != 64 or len(data) % 4 or count < last or (count - last) % 3:
        raise ValueError("not a frame")
    floats = struct.unpack("<%df" % count, data[HEADER.size :])
    frame.update(status=STATUSES[frame["status"]], playing=bool(frame["playing"]))
    return dict(frame, particles=floats[:end], scalars=floats[end:last], reactions=floats[last:])
