"""What components ask the service, and how it stands.

Nothing holds the canvas up for longer than `canvas_link.WAIT` seconds: what takes longer goes on in a thread, and a
solution is scheduled that fetches it. For Python 2.7 to 3.13.
"""

import hashlib
import json

from . import canvas_link as link
from . import canvas_words as words
from .canvas_packed import packed, unpacked

PAUSE = 0.02  # seconds between two solutions, at least; runs of one follow each other without
_turns = {}  # by component


class Turn(object):
    """How long a component has held up this solution, and its tasks, which stay for the next ones."""

    def __init__(self, tasks):
        self.tasks, self.began, self.last = tasks, link.now(), link.now()
        self.trouble = ""  # what was said of the server

    def left(self):
        """Seconds it may still hold the canvas up."""
        return link.WAIT - (link.now() - self.began)


def turn(ghenv):
    """The turn of a component: a new one for each solution, shared by its runs in it."""
    key = words.identity(ghenv)
    known = _turns.get(key)
    if known is None or (words.run_of(ghenv) <= 1 and link.now() - known.last > PAUSE):
        _turns[key] = known = Turn(known.tasks if known else {})
    known.last = link.now()
    return known


def call(ghenv, method, path, body=None, query=None):
    """The answer of an address of the service, None until it is there; the same question is asked once."""

    def work(client):
        return client.request(method, path, packed(body), query, timeout=600.0)

    text = json.dumps([method, path, query, body], sort_keys=True, default=str)
    return unpacked(ask(ghenv, (words.run_of(ghenv), method, path), digest(text), work))


def ask(ghenv, slot, signature, work):
    """The value of a task of this component, None until it is there. The same signature is asked once; words on the
    component show its status, and a solution is scheduled where it is worth while."""
    now = turn(ghenv)
    known = now.tasks.get(slot)
    if known is None or known[0] != signature or known[1].stale:
        before = known[1].trouble if known is not None and link.wants_server(known[1].problem) else None
        now.tasks[slot] = known = (signature, link.Task(work, before))
    task = known[1]
    task.wait(link.GLANCE if task.trouble else link.service.patience(now.left()))
    now.last = link.now()
    return settled(ghenv, task)


def settled(ghenv, task):
    """What a task has found so far, with words on how it stands; schedules the next look at it."""
    trouble = task.trouble
    if task.done and task.problem is None:
        words.note(ghenv, "")
        return task.value
    if task.done and not link.wants_server(task.problem):
        words.note(ghenv, "refused")
        words.error(ghenv, link.plainly(trouble))
        return None
    if trouble and not words.shows(ghenv, turn(ghenv).trouble):
        turn(ghenv).trouble = trouble
        (words.remark if task.patient else words.warning)(ghenv, trouble)
    words.note(ghenv, "no server" if trouble and not task.patient else "working")
    words.schedule(ghenv, 1000 * link.AGAIN if task.done else 200 if trouble else 50)
    return None


def digest(text):
    """The same short text for the same text."""
    return hashlib.sha1(text.encode("utf-8")).hexdigest()
