"""Client of the hookean service: finds this user's server, or starts it once, and speaks with it.

    session = hookean_client.connect().session("document:component")
    session.put(scene)
    frames = session.frames()
    session.play()
    frame = frames.latest()  # the newest; None before the first

For Python 2.7 to 3.13. What fails raises `Problem`; nothing waits longer than its `timeout` [s]; a server first
shows that it is this user's.
"""

import base64
import json
import os
import socket
import struct
import threading
import time

try:
    import http.client as httplib
    from urllib.parse import quote, urlencode
except ImportError:  # Python 2
    import httplib
    from urllib import quote, urlencode

__version__ = "0.1.0"
WIRE = 1
REACH, ANSWER = 0.2, 2.0  # seconds to reach a server, and for it to prove who it is
STATUSES = "running converged stalled diverged max_iterations time_limit cancelled".split()
HEADER = struct.Struct("<4sHHIIQQddIIBBHf")
FIELDS = "magic version size flags number revision iteration time residual n m status playing _ kinetic".split()
LARGEST = 1 << 30  # bytes of an answer
PIECE = 1 << 20  # bytes of it that are read at once
FAILURES = (EnvironmentError, httplib.HTTPException, EOFError, ValueError, TypeError, AttributeError, LookupError)
FAILURES += (RuntimeError,)  # JSON nested too deeply
_now = getattr(time, "monotonic", time.time)


class Problem(Exception):
    """`slug`, `status` (0: no answer), `detail`, `errors`: pairs of pointer and sentence."""

    def __init__(self, slug, detail, status=0, errors=()):
        Exception.__init__(self, detail.encode("ascii", "replace").decode("ascii"))
        self.slug, self.detail, self.status, self.errors = slug, detail, status, errors


def connect(start=True, python=None, timeout=15.0, folder=None, parent=None, idle=30.0):
    """The client of this user's server, started where none runs, by `python`, HOOKEAN_PYTHON or what `hookean serve`
    recorded; it ends with the process `parent` (None: this one; 0: none) and after `idle` minutes without use. A start
    that takes longer than `timeout` goes on."""
    from . import finding

    place = folder or state_folder()

    def find(start, until):
        found = finding.found(place, _now() + ANSWER)
        while not found:
            if not start:
                raise Problem("no-server", "No hookean server is running; start it with `hookean serve`.")
            finding.start(place, python, os.getpid() if parent is None else parent, idle)
            if _now() > until:
                raise Problem("starting", "The hookean server is starting; try again soon.")
            time.sleep(0.02)
            found = finding.found(place, _now() + ANSWER)
        return found

    client = Client(find, start)
    client.renew(timeout)
    return client


class Client(object):
    """One server. `get`, `post`, `put`, `patch` and `delete` take what `request` does."""

    def __init__(self, find, start=False):
        self.url = self.token = self.instance = self.proof = ""
        self._find, self._start, self._idle = find, start, []

    def renew(self, timeout=15.0, start=None):
        """Find the server again, or start it."""
        found = self._find(self._start if start is None else start, _now() + timeout)
        told = [str(found[name]) for name in ("url", "token", "instance", "proof")]
        self.url, self.token, self.instance, self.proof = told

    def relax(self, scene, **options):
        """The scene in equilibrium."""
        return self.post("/v1/relax", scene, **options)

    def session(self, key):
        """The session of a key, made or not."""
        return Session(self, key)

    def request(self, method, path, body=None, query=None, headers=None, timeout=60.0):
        """JSON, or bytes. GET, PUT and DELETE are repeated where the connection is lost, all where there is a new
        token."""
        until, given, token = _now() + timeout, (path, body, query, headers), self.token
        path = str(path) + "?" + urlencode([(k, v) for k, v in (query or {}).items() if v is not None])
        if body is not None and not isinstance(body, (bytes, bytearray)):
            body = json.dumps(body).encode("utf-8")
        for more in (method in ("GET", "PUT", "DELETE"), False):
            connection = self._connection(until)
            sent = {"authorization": "Bearer " + self.token, "content-type": "application/json"}
            cut, began = _cut(connection, until), _now()
            try:
                connection.sock.settimeout(max(0.01, until - _now()))
                connection.request(method, path, body, dict(sent, **(headers or {})))
                answer = connection.getresponse()
                data = _read(answer, LARGEST)
                if _now() > until:  # what was read may be a part of it
                    answer.close()
                    raise EOFError("cut off")
                break
            except FAILURES:
                connection.close()
                if _now() > until:
                    raise Problem("lost", "No answer to %s within %g s; it may still be done." % (method, timeout))
                if not more:
                    raise Problem("lost", "No answer to %s; it may or may not have been done." % method)
            finally:
                cut.cancel()
        if data is None:
            connection.close()
            raise Problem("too-large", "The answer to %s has more than %d bytes." % (method, LARGEST), answer.status)
        if connection.sock is not None:
            self._idle.append((self.instance, began, connection))  # the answer may have waited for this process
        if answer.status == 401 and self._other_token(token, until):
            return self.request(method, *given, timeout=max(0.01, until - _now()))
        if answer.status >= 400 or 300 <= answer.status != 304:
            raise _refusal(answer.status, data)
        if data and (answer.getheader("content-type") or "").startswith("application/json"):
            try:
                return json.loads(data.decode("utf-8"))
            except FAILURES:
                raise Problem("broken", "The answer to %s is not valid JSON." % method, answer.status)
        return data or None

    def close(self):
        """End connections."""
        while self._idle:
            self._idle.pop()[2].close()

    def _other_token(self, token, until):
        try:
            self.renew(max(0.0, until - _now()), False)
        except Problem:
            pass
        return self.token != token

    def _connection(self, until, start=None):
        from . import finding

        def reach():
            return finding.reach(self.url, self.instance, self.proof, min(until, _now() + ANSWER))

        try:
            while True:
                instance, since, connection = self._idle.pop()
                if instance == self.instance and _now() - since < 3.0:
                    return connection
                connection.close()
        except IndexError:
            connection = reach()
        while connection is None:
            if _now() > until:
                raise Problem("no-answer", "The hookean server does not answer.")
            self.renew(max(0.0, until - _now()), start)
            connection = reach()
        return connection


def _method(name):
    return lambda self, path, body=None, query=None, **more: self.request(name.upper(), path, body, query, **more)


for _name in ("get", "post", "put", "patch", "delete"):
    setattr(Client, _name, _method(_name))


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
        until = _now() + timeout
        with self._news:
            while not (self._frame and fits(self._frame)):
                if self.ended or _now() >= until:
                    return None
                self._news.wait(max(0.0, until - _now()))
            return self._frame

    def close(self):
        """No more frames."""
        self.ended, link = True, self._link
        _shut(self._connection)
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
                self._connection = client._connection(_now() + ANSWER, False)
                self._link = websocket.Link(self._connection, self._of.path + "/frames", client.token)
                while not self.ended:
                    self._take(*self._link.receive())
            except Problem as problem:
                self.message = problem.detail
                self.ended |= problem.slug in ("not-found", "wrong-version")
                if problem.status == 401:
                    client._other_token(client.token, _now() + ANSWER)
            except FAILURES as error:
                self.message = "The connection was lost: %s." % error
            if self._link is not None:
                self._link.end()
            if self._connection is not None:  # also one that became no link
                self._connection.close()
            pause = 0.25 if self.received > before else min(4.0, 2 * pause)
            self._since = _now() if self.received > before else self._since
            with self._news:
                self._news.notify_all()
                if not self.ended:
                    self._news.wait(pause)

    def _take(self, kind, data):
        frame, value = (decode(data), {}) if kind == 2 else (None, json.loads(data.decode("utf-8")))
        if "hello" in value:
            _check(value["hello"])
            self.message = ""
            if self._since is not None:
                seen, now = [(s.get("revision"), s.get("iteration")) for s in (self._frame or {}, value["session"])]
                said = "Lost for %.1f s: from revision %s, iteration %s to %s, %s."
                self.lost = self.lost[-19:] + [said % ((_now() - self._since,) + seen + now)]
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
    _check(frame["version"])
    end, last, count = 3 * frame["n"], 3 * frame["n"] + frame["m"], len(data) // 4 - 16
    if frame["flags"] & ~7 or frame["size"] != 64 or len(data) % 4 or count < last or (count - last) % 3:
        raise ValueError("not a frame")
    floats = struct.unpack("<%df" % count, data[HEADER.size :])
    frame.update(status=STATUSES[frame["status"]], playing=bool(frame["playing"]))
    return dict(frame, particles=floats[:end], scalars=floats[end:last], reactions=floats[last:])


def buffer(values, code="d"):
    """An array as base64 for a scene: numbers, or rows of them; code: d decimal, q whole."""
    flat = list(values)
    shape = [len(flat)]
    while flat and hasattr(flat[0], "__len__"):
        shape.append(len(flat[0]))
        flat = [value for row in flat for value in row]
    raw = base64.b64encode(struct.pack("<%d%s" % (len(flat), code), *flat)).decode("ascii")
    return {"dtype": "<f8" if code == "d" else "<i8", "shape": shape, "base64": raw}


def state_folder():
    """Where this user's server is found; HOOKEAN_STATE moves it."""
    if os.name == "nt":
        given, top = "LOCALAPPDATA", "~/AppData/Local"
    elif os.path.isdir("/System/Library"):
        given, top = "", "~/Library/Application Support"
    else:
        given, top = "XDG_STATE_HOME", "~/.local/state"
    top = os.environ.get(given, "").strip() or os.path.expanduser(top)
    return os.environ.get("HOOKEAN_STATE") or os.path.join(top, "hookean")


def _cut(connection, until):
    """What ends a connection at a time, whatever drips down it, unless it is cancelled before."""
    timer = threading.Timer(max(0.01, until - _now()), _shut, [connection, connection.sock])
    timer.daemon = True
    timer.start()
    return timer


def _shut(connection, sock=None):
    try:
        sock = sock or connection.sock
        getattr(sock, "_sock", sock).shutdown(socket.SHUT_RDWR)
    except FAILURES:
        pass


def _read(answer, most):
    """The body; None where it has more than `most` bytes."""
    data, whole = None, False
    try:
        data = None if (answer.length or 0) > most else _pieces(answer, most + 1)
        whole = data is not None and len(data) <= most
        if whole and answer.length:
            raise EOFError("the server has gone")
        return data if whole else None
    finally:
        if not whole:
            answer.close()


def _pieces(answer, count):
    """Up to `count` bytes of the body; Python 3.9 fills a buffer with as many zeros as it is asked to read."""
    pieces, left, piece = [], count, b"-"
    while left and piece:
        piece = answer.read(min(left, PIECE))
        pieces.append(piece)
        left -= len(piece)
    return b"".join(pieces)


def _refusal(status, data):
    try:
        said = json.loads(data.decode("utf-8"))
        errors = [(e["pointer"], e["detail"]) for e in said.get("errors", [])]
        return Problem(said["type"].split("/")[-1], said["detail"], status, errors)
    except FAILURES:
        return Problem("unknown", "The server answered with %d." % status, status)


def _check(wire):
    if wire != WIRE:
        said = "Its frames have version %s, not %d; stop it with `hookean serve --stop`." % (wire, WIRE)
        raise Problem("wrong-version", said)
