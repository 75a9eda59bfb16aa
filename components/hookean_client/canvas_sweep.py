"""The sweep's component: one scene, lists of values, a row of figures for each; solved by the service as a job.

A solution looks at how the job stands and schedules the next look; another scene or other values cancel it. For
Python 2.7 to 3.13.
"""

import hashlib
import json
import uuid

from . import __version__ as VERSION
from .canvas_values import flag
from .canvas_geometry import missing
from . import canvas_setup as setup
from .canvas_items import text
from .canvas_items import plain
from .canvas_values import word
from . import canvas_words as words
from . import canvas_fall as fall
from . import canvas_geometry as geometry
from . import canvas_link as link
from . import canvas_scene as compose
from .canvas_geometry import TEXT, Unfit, listed

LOOK = 300  # milliseconds to the next look at a job that runs
MOST = 100000  # items of one sweep
ENDED = ("done", "failed", "cancelled")
FIGURES = ("iterations", "residual", "energy", "displacement", "reaction")
_sweeps = {}  # by component in an open document


class Outputs(object):
    """What the component puts out; None where nothing is known yet."""

    parameters = results = names = statuses = table = progress = None


class Sweep(object):
    """A sweep as the canvas wants it, and its job; `look` does in threads what has to be done."""

    def __init__(self):
        self.wanted = self.job = self.status = self.rows = self.task = self.refused = None
        self._again, self.signature = "", None  # that of the job

    def look(self, wanted):
        """Begin what has to be done for a sweep (None: none), if nothing is under way; returns at once."""
        self.wanted, task = wanted, self.task
        if task is not None and not task.done:
            return
        if task is not None and task.problem is not None:
            if link.wants_server(task.problem) and not task.stale:
                return
            if not link.wants_server(task.problem) and self.refused is wanted:
                return
        if self.settled:
            return
        before = task.trouble if task is not None and link.wants_server(task.problem) else None
        self.task = link.Task(lambda client: self._work(client, wanted), before)

    @property
    def ours(self):
        """Whether the job is that of the wanted sweep."""
        return self.job is not None and self.wanted is not None and self.signature == self.wanted.signature

    @property
    def settled(self):
        """Whether there is nothing more to do."""
        ended = self.job is None or self.status["status"] in ENDED
        return ended if self.wanted is None else self.ours and ended and self.status["status"] != "cancelled"

    def _work(self, client, wanted):
        try:
            if wanted is None or wanted.signature != self.signature:
                self._cancel(client, wanted)
            if wanted is not None and (self.job is None or self.status["status"] == "cancelled"):
                self._submit(client, wanted)
            if self.job is not None:
                self._read(client)
        except link.Problem as problem:
            if problem.status == 404:  # the job was forgotten; it is made again
                self.job, self._again = None, uuid.uuid4().hex
                return
            if not link.wants_server(problem):
                self.refused = wanted
            raise

    def _cancel(self, client, wanted):
        if self.job is not None and self.status["status"] not in ENDED:
            client.delete(self.job)
            self.status = dict(self.status, status="cancelled")
        if wanted is not None:
            self.job = None

    def _submit(self, client, wanted):
        """The same sweep is the same job, also in a definition that is opened again, unless it was cancelled."""
        for _ in range(2):
            key = wanted.signature + self._again
            self.status = client.post("/v1/jobs", wanted.body, headers={"idempotency-key": key}, timeout=120.0)
            self.job, self.signature = "/v1/jobs/%s" % self.status["id"], wanted.signature
            self.rows, wanted.falls = None, fall.sentence(wanted.scene)
            if client.get(self.job)["status"] != "cancelled":
                return
            self._again = uuid.uuid4().hex

    def _read(self, client):
        known = self.status["done"] + self.status["failed"] if self.rows is not None else -1
        status = client.get(self.job)
        if status["done"] + status["failed"] != known or status["status"] in ENDED:
            self.rows = client.get(self.job + "/results", None, {"format": "json"})
        self.status = status


class Wanted(object):
    """The inputs of a sweep, read: its items as patches, by name the values of each, and the request."""

    def __init__(self, scene, names, columns, placed):
        self.scene, self.names, self.columns, self.placed = scene, names, columns, placed
        self.falls = None  # why its form falls freely, once the service has taken it
        self.patches = [_patch(names, values) for values in zip(*columns)]
        self.body = text({"scene": scene, "sweep": {"patches": self.patches}}).encode("ascii")
        self.signature = hashlib.sha1(VERSION.encode("ascii") + self.body).hexdigest()


def sweep(ghenv, forces, anchors, settings, scene, parameters, values, mode, results, run):
    """One solution of the component: its outputs."""
    document = ghenv.Component.OnPingDocument()
    key = (words.identity(ghenv), str(getattr(document, "RuntimeID", id(document))))
    found = _sweeps.setdefault(key, Sweep())
    made, given = Outputs(), (forces, anchors, settings, scene, parameters, values, mode)
    read = words.told(ghenv, lambda: _wanted(ghenv, *given))
    if read is not None and found.wanted is not None and read.signature == found.wanted.signature:
        read = found.wanted
    wanted = read if flag(run, False) else None
    if wanted is not None and wanted.falls:
        words.warning(ghenv, wanted.falls)
    if wanted is not None or found.job is not None:
        found.look(wanted)
        if found.task is not None:
            found.task.wait(link.service.patience(link.WAIT))
        _tell(ghenv, found)
    else:
        words.note(ghenv, "" if read is None else "off")
    if read is not None:
        words.told(ghenv, lambda: _show(made, found, read, results))
    return made


# inputs


def _wanted(ghenv, forces, anchors, settings, scene, parameters, values, mode):
    names = [_parameter(item) for item in listed(parameters)]
    if not names:
        raise missing("_parameters is missing; give names of fields, such as Springs.stiffness")
    rows = [[_value(item) for item in items] for _, items in geometry.branches(values)]
    rows = [row for row in rows if row]
    if len(rows) != len(names):
        said = "values: %d branches for %d parameters; give a branch of values for each parameter"
        raise Unfit(said % (len(rows), len(names)))
    columns = _columns(rows, word(mode, ("product", "zip"), "mode"))
    made, placed = _scene(ghenv, forces, anchors, settings, scene)
    return Wanted(made, names, columns, placed)


def _parameter(item):
    """A name such as Springs.stiffness, or settings.tolerance, as a pair."""
    owner, dot, column = str(item).strip().rpartition(".")
    if not (dot and owner and column):
        said = "parameters: %s is not a parameter; give the name of a force or settings, a dot and a field"
        raise Unfit(said % geometry.called(item))
    return owner, column


def _value(item):
    """A value as JSON has it: a number, a flag, a word or a vector."""
    return plain(geometry.value(item))


def _columns(rows, mode):
    """The values of each parameter, item by item: every one with every other, the last fastest; or side by side."""
    if mode == "zip":
        if len(set(map(len, rows))) > 1:
            raise Unfit(
                "values: %s in a branch; zip needs equal numbers of values" % ", ".join(str(len(r)) for r in rows)
            )
        return rows
    count = 1
    for row in rows:
        count *= len(row)
    if count > MOST:
        raise Unfit("values: %d items; at most %d are allowed" % (count, MOST))
    columns, after = [], count
    for row in rows:
        after //= len(row)
        columns.append([row[i // after % len(row)] for i in range(count)])
    return columns


def _patch(names, values):
    made = {}
    for (owner, column), one in zip(names, values):
        place = made.setdefault("settings", {}) if owner == "settings" else made.setdefault("forces", {})
        (place if owner == "settings" else place.setdefault(owner, {}))[column] = one
    return made


def _scene(ghenv, forces, anchors, settings, scene):
    """The scene of the engine's inputs, or the one that is given as text; and what puts the names of components into a
    sentence on it."""
    given, texts = listed(scene), listed(forces)
    if given and texts:
        raise Unfit("a scene and forces are connected; connect one of them")
    if given:
        try:
            found = json.loads(given[0]) if isinstance(given[0], TEXT) else None
        except ValueError:
            found = None
        if not isinstance(found, dict):
            raise Unfit("scene: it is not the JSON text of a scene")
        return found, lambda said: said
    if not texts:
        raise missing("_forces is missing; connect the outputs of force components, or a scene")

    held = [dict(one, home=one["point"], target=one["target"] or one["point"]) for one in setup.anchors(ghenv, anchors)]
    setting = compose.read(settings, "settings", "settings_")[-1:]
    read = compose.read([str(item) for item in texts], None, "_forces")
    made = compose.compose(read, held, setting[0] if setting else None, [], geometry.length_unit())
    return made, lambda said: setup.placed(read, held, said)


# sentences and outputs


def _tell(ghenv, found):
    """Words on how the job stands, and the next look at it."""
    task, status = found.task, found.status
    if task is not None and task.done and task.problem is not None and not link.wants_server(task.problem):
        words.note(ghenv, "refused")
        said = task.trouble.replace("/scene/", "/")
        said = found.wanted.placed(said) if found.wanted is not None else said
        words.error(ghenv, link.plainly(said.replace("/sweep/forces/", "/")))
        return
    trouble = task.trouble if task is not None else None
    if trouble:
        (words.remark if task.patient else words.warning)(ghenv, trouble)
    for sentence in found.rows.get("warnings", ()) if found.ours and found.rows else ():
        words.warning(ghenv, link.plainly(found.wanted.placed(sentence)))
    if found.settled:
        told = "off" if found.wanted is None else "%d of %d" % (status["done"], status["total"])
        words.note(ghenv, told)
        if found.wanted is not None and status["status"] == "failed":
            words.error(ghenv, status["message"])
        return
    told = "%d of %d" % (status["done"], status["total"]) if found.ours else "working"
    words.note(ghenv, "no server" if trouble and not task.patient else told)
    words.schedule(ghenv, LOOK if not trouble else 500)


def _show(made, found, wanted, results):
    """Outputs of a job: values of parameters and of results by branches, item by item; None for what is not done."""
    made.parameters = geometry.to_tree([("{%d}" % i, _shown(column)) for i, column in enumerate(wanted.columns)])
    if found.rows is None or found.signature != wanted.signature:
        return
    table, count = found.rows, len(wanted.patches)
    rows = [None] * count
    for row in table["rows"]:
        rows[row["number"]] = row
    known = [(column["name"], column["unit"]) for column in table["columns"]]
    chosen = _chosen(known, [str(item).strip() for item in listed(results)])
    made.results = geometry.to_tree(
        [("{%d}" % i, [_figure(row, n) for row in rows]) for i, (n, _) in enumerate(chosen)]
    )
    made.names = ["%s [%s]" % (name, unit) if unit else name for name, unit in chosen]
    made.statuses = [row and row["status"] for row in rows]
    made.table = _text(wanted, rows, made.names, [name for name, _ in chosen])
    made.progress = found.status["message"]


def _shown(column):
    return [geometry.to_vector(value) if isinstance(value, list) else value for value in column]


def _chosen(known, wanted):
    """Columns by their names, all where none are wanted."""
    if not wanted:
        return known
    by_name = {name: (name, unit) for name, unit in known}
    for name in wanted:
        if name not in by_name:
            there = ", ".join(name for name, _ in known)
            raise Unfit('results: unknown "%s"; known: %s' % (name, there))
    return [by_name[name] for name in wanted]


def _figure(row, name):
    """A figure of an item; None where it has none, or is not done."""
    if row is None or name in FIGURES:
        return row and row.get(name)
    owner, _, end = name.rpartition(".")
    pair = (row.get("forces") or {}).get(owner)
    return pair and pair[end == "largest"]


def _text(wanted, rows, titles, names):
    """The table as text, a line for each item, values apart by commas."""
    heads = ["%s.%s" % name for name in wanted.names]
    lines = [", ".join(["number"] + heads + ["status"] + titles)]
    for number, row in enumerate(rows):
        cells = [_cell(column[number]) for column in wanted.columns] + [row["status"] if row else ""]
        figures = [_figure(row, name) for name in names]
        lines.append(", ".join([str(number)] + cells + ["" if one is None else repr(one) for one in figures]))
    return "\n".join(lines)


def _cell(value):
    return " ".join(repr(part) for part in value) if isinstance(value, list) else str(value)
