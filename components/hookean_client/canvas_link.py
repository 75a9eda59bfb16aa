"""The service behind components: found, started and asked in threads, so that the canvas never waits for long.

A component asks with `Task`s and looks at them in this solution and the next ones. What fails for want of a server is
tried again by itself. For Python 2.7 to 3.13.
"""

import threading
import time

from . import FAILURES, Problem, connect

WAIT = 0.25  # seconds a component may hold the canvas up in a solution
GLANCE = 0.005  # seconds that let threads work
LATE = 0.4  # seconds of silence after which this is reported
PATIENT = 5.0  # seconds of silence of a server that has answered before that are not reported
AGAIN = 0.4  # seconds until what failed for want of a server is tried again
now = getattr(time, "monotonic", time.time)
SENTENCES = {
    "starting": "The hookean server is starting; this continues automatically.",
    "no-server": "No hookean server is running; start one with `hookean serve` in a terminal.",
    "no-python": (
        "No hookean server is running, and this component cannot start one; run `hookean serve` once in a terminal, or "
        "set HOOKEAN_PYTHON to the Python that has hookean."
    ),
    "lost": "The connection to the hookean server was lost; this continues when it is back.",
    "no-answer": "The hookean server does not answer; this continues when it does.",
    "silent": "The hookean server has not answered for %.1f s; this continues when it does.",
    "wrong-version": "The running hookean server is not compatible with this component. %s",
    "not-started": "The hookean server could not be started. %s",
}


class Service(object):
    """This user's server, as all components of this process share it."""

    def __init__(self):
        self._client, self._seen, self._lock = None, 0.0, threading.Lock()
        self._since = None  # since when it has been asked for in vain

    def client(self):
        """A client whose server answered just now; raises `Problem`. May take two seconds."""
        self._since = self._since or now()
        with self._lock:
            if self._client is None:
                self._client = connect(timeout=0.0)
            elif now() - self._seen > 1.0:
                self._asked("/v1/health")
            self._seen, self._since = now(), None
            return self._client

    def patience(self, seconds):
        """For how long a component may wait: hardly, if others have waited without an answer."""
        since = self._since
        return seconds if since is None else max(GLANCE, min(seconds, WAIT - (now() - since)))

    def _asked(self, path):
        try:
            self._client.get(path, timeout=1.0)
        except Problem:
            client, self._client = self._client, None
            client.close()
            raise

    def uses(self, client):
        """Whether it is still this client."""
        return client is self._client

    def doubt(self):
        """Ask it whether it is there before the next use."""
        self._seen = 0.0

    def lose(self):
        """Look for the server again next time; it did not answer now."""
        self.forget()
        self._since = now() - WAIT

    def forget(self):
        """Look for the server again next time."""
        client, self._client, self._since = self._client, None, None
        if client is not None:
            client.close()


service = Service()


class Task(object):
    """`work(client)` in a thread: `value` or `problem` once it is `done`. `before`: the trouble there was before it,
    which stands until then."""

    def __init__(self, work, before=None):
        self.value, self.problem, self._before = None, None, before
        self.since, self.until, self.client = now(), 0.0, None
        self._work, self._done = work, threading.Event()
        thread = threading.Thread(target=self._run, name="hookean-task")
        thread.daemon = True
        thread.start()

    def _run(self):
        try:
            self.client = self._find()
            self.value = self._work(self.client)
        except Problem as problem:
            self.problem = problem
            if wants_server(problem):
                service.lose()
        except FAILURES as error:
            self.problem = Problem("failed", "This failed: %s: %s." % (type(error).__name__, error), 500)
        if self.client is not None and not service.uses(self.client):
            self.client.close()  # forgotten meanwhile
        self.until = now()
        self._done.set()

    def _find(self):
        return service.client()

    @property
    def done(self):
        """Whether it has ended."""
        return self._done.is_set()

    def wait(self, seconds):
        """Whether it has ended, after at most so many seconds."""
        self._done.wait(max(0.0, seconds))
        return self.done

    @property
    def stale(self):
        """Whether it failed for want of a server, long enough ago to be tried again."""
        return self.done and wants_server(self.problem) and now() - self.until >= AGAIN

    @property
    def trouble(self):
        """A sentence where it failed, or has not answered for long; else None."""
        if self.problem is not None:
            return sentence(self.problem)
        silent = now() - self.since
        if self.done or silent < LATE:
            return None if self.done else self._before
        return SENTENCES["silent"] % silent

    @property
    def patient(self):
        """Whether there is nothing wrong so far but that it takes long: the server answered when this began."""
        return not self.done and self.client is not None and self._before is None and now() - self.since < PATIENT


def wants_server(problem):
    """Whether a problem is one of the server, not of the request."""
    return problem is not None and (problem.status == 0 or problem.status in (429, 502, 503, 504))


def sentence(problem):
    """A problem in one sentence for a person at the canvas."""
    said = SENTENCES.get(problem.slug) if problem.status == 0 else None
    if said is None:
        return problem.detail
    return said % problem.detail if "%s" in said else said


def plainly(said):
    """A refusal with the place it speaks of in words: "/length/0: 3 given" becomes "Length 0: 3 given."."""
    place, colon, rest = said.partition(": ")
    if colon and place[:1] == "/":
        words = place.strip("/").replace("/", " ")
        said = (words[:1].upper() + words[1:] + ": " if words else "") + rest
    return said if said.endswith((".", "?", "!")) else said + "."
