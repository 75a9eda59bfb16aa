"""A WebSocket (RFC 6455) on an open connection. For Python 2.7 to 3.13."""

import base64
import hashlib
import os
import threading

from . import FAILURES, Problem, transport

PATIENCE = 60.0  # seconds a socket may be silent


class Link(object):
    """Messages of a WebSocket."""

    def __init__(self, connection, path, token):
        self._connection, self._sending = connection, threading.Lock()
        connection.sock.settimeout(PATIENCE)
        key = base64.b64encode(os.urandom(16)).decode("ascii")
        headers = {"upgrade": "websocket", "connection": "upgrade", "authorization": "Bearer " + token}
        headers.update({"sec-websocket-key": key, "sec-websocket-version": "13"})
        cut = transport.cut(connection, transport.now() + PATIENCE)
        try:
            connection.request("GET", path, headers=headers)
            self._answer = connection.getresponse()
            if self._answer.status != 101:
                problem = transport.refusal(self._answer.status, transport.read(self._answer, 1 << 16))
                connection.close()
                raise problem
        finally:
            cut.cancel()
        digest = hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode("ascii")).digest()
        if self._answer.getheader("sec-websocket-accept") != base64.b64encode(digest).decode("ascii"):
            raise ValueError("not a WebSocket")

    def send(self, kind, data, wait=True):
        """Send a message of less than 64 kB: 1 text, 8 close, 10 pong; `wait` for others that are being sent."""
        data, mask, size = _octets(data), _octets(os.urandom(4)), len(data)
        head = bytearray([0x80 | kind, 0x80 | min(size, 126)] + ([size >> 8, size & 255] if size > 125 else []))
        data = bytearray([octet ^ mask[i & 3] for i, octet in enumerate(data)])
        if self._sending.acquire(wait):
            try:
                self._connection.sock.sendall(bytes(head + mask + data))
            finally:
                self._sending.release()

    def receive(self):
        """Kind and bytes of the next message."""
        kind, whole = 0, bytearray()
        while True:
            first, second = self._exactly(2)
            code, last, size = first & 15, first & 0x80, second & 127
            if size > 125:
                wide, size = self._exactly(2 if size == 126 else 8), 0
                for octet in wide:
                    size = size << 8 | octet
            wrong = (code == 0) != bool(kind) if code < 3 else code not in (8, 9, 10) or size > 125 or not last
            if wrong or first & 0x70 or second & 0x80 or len(whole) + size > 1 << 28:
                raise ValueError("invalid message")
            data = self._exactly(size)
            if code == 8:
                code = data[0] << 8 | data[1] if size > 1 else 1005
                said = bytes(data[2:]).decode("utf-8", "replace") or "Closed with %d." % code
                raise Problem("not-found" if code == 4404 else "closed", said, code)
            if code == 9:
                self.send(10, data)
            if code < 3:
                kind = kind or code
                whole.extend(data)
                if last:
                    return kind, bytes(whole)

    def end(self):
        """Close it."""
        try:
            self._connection.sock.settimeout(transport.REACH)
            self.send(8, b"\x03\xe8", False)
        except FAILURES:
            pass
        transport.shut(self._connection)  # a thread that reads or sends has to return first
        self._connection.close()

    def _exactly(self, size):
        data = self._answer.fp.read(size) if size else b""
        if len(data) < size:
            raise EOFError("the server has gone")
        return _octets(data)


def _octets(data):
    return bytearray(data if isinstance(data, (bytes, bytearray)) else map(ord, data))
