"""The server's component: how the service stands, started, stopped and opened in the browser in threads.

For Python 2.7 to 3.13.
"""

import binascii
import os
import threading
import webbrowser

try:
    from urllib.request import pathname2url
except ImportError:  # Python 2
    from urllib import pathname2url

from . import canvas_words as words
from . import Problem, connect, state_folder
from . import canvas_geometry as geometry
from . import canvas_link as link

OLD = 0.05  # seconds after which a solution looks again
PAGE = """<!doctype html>
<meta charset="utf-8"><meta name="referrer" content="no-referrer"><title>hookean studio</title>
<meta http-equiv="refresh" content="0; url=%(address)s">
<p><a href="%(address)s">Open the studio</a></p>
"""
_looks = {}  # by component: (what was asked for, Task, what was shown last)


class Stand(object):
    """What the component puts out."""

    def __init__(self, status=None, url=None, version=None, sessions=None):
        self.status, self.url, self.version, self.sessions = status, url, version, sessions


class Look(link.Task):
    """A look at the server that does not start it by itself."""

    def _find(self):
        return None


def stand(ghenv, start, stop, studio):
    """One solution of the component."""
    asked = tuple(_flag(flag) for flag in (start, stop, studio))
    key = words.identity(ghenv)
    before, task, shown = _looks.get(key, (None, None, Stand()))
    if task is None or before != asked or (task.done and link.now() - task.until > OLD):
        risen = [flag and not (before and before[i]) for i, flag in enumerate(asked)]
        task = Look(lambda _: _work(asked[0] and not asked[1], risen[1], risen[2]), task and task.trouble)
    task.wait(link.service.patience(link.WAIT))
    shown = task.value if task.done and task.problem is None else shown
    _looks[key] = (asked, task, shown)
    trouble = task.trouble
    if trouble:
        shown = Stand(trouble, None, None, [])
        words.warning(ghenv, trouble)
        words.note(ghenv, "no server")
        words.schedule(ghenv, 1000 * link.AGAIN)
    elif not task.done:
        words.note(ghenv, "working")
        words.schedule(ghenv, 100)
    else:
        words.note(ghenv, "running")
    return shown


def _flag(given):
    items = geometry.listed(given)
    return bool(items) and str(items[0]) not in ("False", "0")


def _work(start, stop, studio):
    client = connect(start=start, timeout=0.0)
    try:
        if stop:
            client.post("/v1/shutdown", timeout=5.0)
            raise Problem("stopped", "The hookean server has been stopped; its sessions are saved.")
        health = client.get("/v1/health", timeout=5.0)
        if studio:
            _show(client)
        rows = client.get("/v1/sessions", timeout=5.0)["sessions"]
    finally:
        client.close()
    lines = [_line(row) for row in rows]
    status = "The hookean server is running, version %s, %d sessions." % (health["version"], len(rows))
    return Stand(status, client.url, health["version"], lines)


def _show(client):
    """Open the studio in a browser by a file that only this user can read, which has a code for one log-in: everybody
    on this machine can read what a program is given as arguments. It is removed when the code is worth nothing."""
    made = client.post("/v1/login/codes", timeout=5.0)
    path = os.path.join(state_folder(), "open-%s.html" % binascii.hexlify(os.urandom(8)).decode("ascii"))
    with os.fdopen(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600), "w") as file:
        file.write(PAGE % {"address": "%s/#t=%s" % (client.url, made["code"])})
    _later(made["seconds"], _remove, path)
    url = pathname2url(path)  # on Windows it begins with three slashes
    webbrowser.open("file:" + ("" if url.startswith("//") else "//") + url)


def _later(seconds, work, given):
    waiting = threading.Timer(seconds, work, [given])
    waiting.daemon = True
    waiting.start()


def _remove(path):
    try:
        os.unlink(path)
    except EnvironmentError:
        pass


def _line(row):
    """A session in a line; one that sleeps since the start of the server has less."""
    if row.get("residual") is None:
        return "%s: asleep" % (row.get("label") or row["key"])
    said = "%s: %s, iteration %s, residual %.3g"
    return said % (row.get("label") or row["key"], row["status"], row["iteration"], row["residual"])
