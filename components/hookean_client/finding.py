"""Finding this user's server by its file, making it prove who it is, and starting it.

Files are believed that no other user could have written. A server proves, on the connection that is used afterwards,
that it knows the key in its file; nothing secret is sent before. For Python 2.7 to 3.13.
"""

import binascii
import errno
import hashlib
import hmac
import json
import os
import stat
import subprocess
import sys
import threading
import time

try:
    import http.client as httplib
except ImportError:  # Python 2
    import httplib

from . import FAILURES, Problem, transport

STARTING = 30.0  # seconds a start may take
ADVICE = "check who made it, then remove it, or set HOOKEAN_STATE to a folder that is yours alone."
_lock = threading.Lock()
_children = {}  # started from here, by folder


def found(place, until):
    """The contents of the file of a running server that has proven it wrote it; None if there is no such server."""
    check(place)
    said = told(place, "server.json")
    connection = reach(said.get("url"), said.get("instance"), said.get("proof"), until)
    if not connection:
        return None
    connection.close()
    transport.check(said.get("wire"))
    _unlink(os.path.join(place, "starting"))
    return said


def reach(url, instance, proof, until):
    """A connection to a server that has proven who it is, or None. Once closed it is not opened again: somebody else
    may have its port then."""
    connection, cut = httplib.HTTPConnection(""), None
    try:
        host, _, port = url.split("//")[-1].rpartition(":")
        connection = httplib.HTTPConnection(host.strip("[]"), int(port), timeout=transport.REACH)
        connection.connect()
        connection.auto_open = 0
        connection.sock.settimeout(max(0.01, until - transport.now()))
        cut = transport.cut(connection, until)
        nonce = binascii.hexlify(os.urandom(32)).decode("ascii")
        connection.request("GET", "/v1/proof?nonce=" + nonce)
        said = json.loads(transport.read(connection.getresponse(), 1 << 16).decode("utf-8"))["proof"]
        text = "hookean %s %s %s %s" % (instance, connection.sock.getpeername()[0], port, nonce)
        # the time of this comparison reveals nothing useful: the next nonce has another proof
        right = said == hmac.new(proof.encode("ascii"), text.encode("ascii"), hashlib.sha256).hexdigest()
        if right:
            return connection
    except FAILURES:
        pass
    finally:
        if cut:
            cut.cancel()
    connection.close()
    return None


def check(place):
    """Raise the Problem `distrusted` where other users may write to the folder, or have put a file there."""
    if not hasattr(os, "getuid"):
        return
    try:
        about = os.stat(place)
    except EnvironmentError:
        return
    if about.st_uid != os.getuid():
        raise Problem("distrusted", "%s belongs to another user; %s" % (place, ADVICE))
    if about.st_mode & 0o022:
        said = "Other users may write to %s; chmod 700 it, or set HOOKEAN_STATE to another folder."
        raise Problem("distrusted", said % place)
    for path in (os.path.join(place, name) for name in ("server.json", "python.json")):
        try:
            private = _private(os.lstat(path))
        except EnvironmentError:
            continue
        if not private:
            raise Problem("distrusted", "%s is not a file that you alone can write to; %s" % (path, ADVICE))


def told(place, name):
    """The contents of a file of the folder; empty if it does not exist, or another user could have written it."""
    path = os.path.join(place, name)
    try:
        if not hasattr(os, "getuid"):
            with open(path) as file:
                return dict(json.load(file))
        # no link is followed, and no pipe waited for
        flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
        with os.fdopen(os.open(path, flags)) as file:
            return dict(json.load(file)) if _private(os.fstat(file.fileno())) else {}
    except FAILURES:
        return {}


def _private(about):
    return about.st_uid == os.getuid() and not about.st_mode & 0o022 and stat.S_ISREG(about.st_mode)


def start(place, python, parent, idle):
    """Start a server, unless one is being started."""
    path, log = os.path.join(place, "starting"), os.path.join(place, "start.log")
    with _lock:
        child = _children.get(place)
        if child is not None:
            if child.poll() is None:
                return
            del _children[place]
            _unlink(path)
            if child.returncode > 0:
                with open(log) as file:
                    raise Problem("not-started", "It did not start: " + file.read().strip().split("\n")[-1][:300])
        python = python or os.environ.get("HOOKEAN_PYTHON") or told(place, "python.json").get("python")
        if not python:
            raise Problem("no-python", "Set HOOKEAN_PYTHON to the Python with hookean, or run `hookean serve` once.")
        command = [str(python), "-m", "hookean.cli", "serve", "--any-port"]
        command += ["--parent-pid", str(parent), "--idle-exit", str(idle)]
        ours = False
        try:
            if not os.path.isdir(place):
                os.makedirs(place, 0o700)
            if os.path.exists(path) and time.time() - os.stat(path).st_mtime > STARTING:
                _unlink(path)
            os.close(os.open(path, os.O_CREAT | os.O_EXCL, 0o600))
            ours = True
            _children[place] = _spawn(command, place, log)
        except EnvironmentError as error:
            if ours or error.errno not in (errno.EEXIST, errno.ENOENT):
                _unlink(path)
                raise Problem("not-started", "%s cannot be started (%s)." % (python, error))


def _spawn(command, place, log):
    kept = dict(os.environ, HOOKEAN_STATE=place)
    for name in ("PYTHONHOME", "PYTHONPATH", "PYTHONSTARTUP"):
        kept.pop(name, None)
    options = {"cwd": place, "env": kept, "close_fds": True}
    if os.name == "nt":
        options["creationflags"] = 0x08000000 | 0x00000200  # no window, own group
    else:
        options.update({"start_new_session": True} if sys.version_info > (3,) else {"preexec_fn": os.setsid})
    with open(log, "w+b") as file:
        if os.name != "nt" or sys.version_info > (3, 7):
            options.update(stdin=file, stdout=file, stderr=file)
        return subprocess.Popen(command, **options)


def _unlink(path):
    try:
        os.unlink(path)
    except OSError:
        pass
