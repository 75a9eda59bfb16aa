"""The client of one server. For Python 2.7 to 3.13."""

import json
import os
import time

try:
    from urllib.parse import urlencode
except ImportError:  # Python 2
    from urllib import urlencode

from . import FAILURES, Problem, finding, transport


def found(start, python, timeout, place, parent, idle):
    """The client of the server of a folder; see `connect`."""

    def find(start, until):
        known = finding.found(place, transport.now() + transport.ANSWER)
        while not known:
            if not start:
                raise Problem("no-server", "No hookean server is running; start it with `hookean serve`.")
            finding.start(place, python, os.getpid() if parent is None else parent, idle)
            if transport.now() > until:
                raise Problem("starting", "The hookean server is starting; try again soon.")
            time.sleep(0.02)
            known = finding.found(place, transport.now() + transport.ANSWER)
        return known

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
        found = self._find(self._start if start is None else start, transport.now() + timeout)
        told = [str(found[name]) for name in ("url", "token", "instance", "proof")]
        self.url, self.token, self.instance, self.proof = told

    def relax(self, scene, **options):
        """The scene in equilibrium."""
        return self.post("/v1/relax", scene, **options)

    def session(self, key):
        """The session of a key, made or not; see `sessions`."""
        from .sessions import Session

        return Session(self, key)

    def request(self, method, path, body=None, query=None, headers=None, timeout=60.0):
        """JSON, or bytes. GET, PUT and DELETE are repeated where the connection is lost, all where there is a new
        token."""
        until, given, token = transport.now() + timeout, (path, body, query, headers), self.token
        path = str(path) + "?" + urlencode([(k, v) for k, v in (query or {}).items() if v is not None])
        if body is not None and not isinstance(body, (bytes, bytearray)):
            body = json.dumps(body).encode("utf-8")
        for more in (method in ("GET", "PUT", "DELETE"), False):
            connection = self._connection(until)
            sent = {"authorization": "Bearer " + self.token, "content-type": "application/json"}
            cut, began = transport.cut(connection, until), transport.now()
            try:
                connection.sock.settimeout(max(0.01, until - transport.now()))
                connection.request(method, path, body, dict(sent, **(headers or {})))
                answer = connection.getresponse()
                data = transport.read(answer, transport.LARGEST)
                if transport.now() > until:  # what was read may be a part of it
                    answer.close()
                    raise EOFError("cut off")
                break
            except FAILURES:
                connection.close()
                if transport.now() > until:
                    raise Problem("lost", "No answer to %s within %g s; it may still be done." % (method, timeout))
                if not more:
                    raise Problem("lost", "No answer to %s; it may or may not have been done." % method)
            finally:
                cut.cancel()
        if data is None:
            connection.close()
            said = "The answer to %s has more than %d bytes." % (method, transport.LARGEST)
            raise Problem("too-large", said, answer.status)
        if connection.sock is not None:
            self._idle.append((self.instance, began, connection))  # the answer may have waited for this process
        if answer.status == 401 and self._other_token(token, until):
            return self.request(method, *given, timeout=max(0.01, until - transport.now()))
        if answer.status >= 400 or 300 <= answer.status != 304:
            raise transport.refusal(answer.status, data)
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
            self.renew(max(0.0, until - transport.now()), False)
        except Problem:
            pass
        return self.token != token

    def _connection(self, until, start=None):
        def reach():
            return finding.reach(self.url, self.instance, self.proof, min(until, transport.now() + transport.ANSWER))

        try:
            while True:
                instance, since, connection = self._idle.pop()
                if instance == self.instance and transport.now() - since < 3.0:
                    return connection
                connection.close()
        except IndexError:
            connection = reach()
        while connection is None:
            if transport.now() > until:
                raise Problem("no-answer", "The hookean server does not answer.")
            self.renew(max(0.0, until - transport.now()), start)
            connection = reach()
        return connection


def _method(name):
    return lambda self, path, body=None, query=None, **more: self.request(name.upper(), path, body, query, **more)


for _name in ("get", "post", "put", "patch", "delete"):
    setattr(Client, _name, _method(_name))
