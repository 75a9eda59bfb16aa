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
import os
import struct

try:
    from http.client import HTTPException
except ImportError:  # Python 2
    from httplib import HTTPException

__version__ = "0.1.0"
WIRE = 1
FAILURES = (EnvironmentError, HTTPException, EOFError, ValueError, TypeError, AttributeError, LookupError)
FAILURES += (RuntimeError,)  # JSON nested too deeply


class Problem(Exception):
    """`slug`, `status` (0: no answer), `detail`, `errors`: pairs of pointer and sentence."""

    def __init__(self, slug, detail, status=0, errors=()):
        Exception.__init__(self, detail.encode("ascii", "replace").decode("ascii"))
        self.slug, self.detail, self.status, self.errors = slug, detail, status, errors


def connect(start=True, python=None, timeout=15.0, folder=None, parent=None, idle=30.0):
    """The client of this user's server, started where none runs, by `python`, HOOKEAN_PYTHON or what `hookean serve`
    recorded; it ends with the process `parent` (None: this one; 0: none) and after `idle` minutes without use. A start
    that takes longer than `timeout` goes on."""
    from .client import found

    return found(start, python, timeout, folder or state_folder(), parent, idle)


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
