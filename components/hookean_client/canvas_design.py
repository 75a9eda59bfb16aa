"""The components of design problems: what may vary, goals, constraints, and the search; the service runs it as a job.

Variables, goals and constraints travel as text. A solution looks at how the search stands and schedules the next look;
other goals or another scene start it again from the best values so far. For Python 2.7 to 3.13.
"""

import hashlib

from . import __version__ as VERSION
from .canvas_values import flag
from .canvas_geometry import missing
from . import canvas_setup as setup
from .canvas_items import text
from .canvas_values import word
from . import canvas_words as words
from . import canvas_sweep
from . import canvas_geometry as geometry
from . import canvas_link as link
from . import canvas_scene as compose
from .canvas_geometry import Unfit, listed

LOOK = 120  # milliseconds to the next look at a search that runs
METHODS = ("auto", "least_squares", "levenberg_marquardt", "l-bfgs-b", "slsqp", "augmented_lagrangian")
NOWHERE = ("stalled", "unbounded")  # ends from whose values no search goes on well
_searches = {}  # by component in an open document


class Outputs(object):
    """What the component puts out; None where nothing is known yet."""

    values = names = goals = constraints = objective = geometry = particles = forces = reactions = scene = status = (
        report
    ) = None


class Wanted(object):
    """The inputs of a search, read: the problem and its text without values to start from."""

    def __init__(self, scene, problem, makers, placed):
        self.scene, self.problem, self.makers, self.placed = scene, problem, makers, placed
        self.falls = None
        self.text = text(problem)
        self.signature = hashlib.sha1((VERSION + self.text).encode("ascii")).hexdigest()
        count = {name: problem[name] for name in ("variables",)}
        self.unknowns = text([count, [one["name"] for one in scene["forces"]], compose.places(scene)])


class Search(canvas_sweep.Sweep):
    """A search as the canvas wants it, its job, and its last answer, of whatever goals."""

    answer = best = None  # the last answer; the values it has and what they are values of
    led = False  # whether the search began at such values

    def _submit(self, client, wanted):
        problem = wanted.problem
        self.led = self.best is not None and self.best[0] == wanted.unknowns
        if self.led:
            problem = dict(problem, start=self.best[1])
        body = text(problem).encode("ascii")
        key = hashlib.sha1(VERSION.encode("ascii") + body).hexdigest() + self._again
        self.status = client.post("/v1/design", body, headers={"idempotency-key": key}, timeout=120.0)
        self.job, self.signature = "/v1/jobs/%s" % self.status["id"], wanted.signature
        if client.get(self.job)["status"] == "cancelled":
            self._again = canvas_sweep.uuid.uuid4().hex
            return self._submit(client, wanted)
        return None

    def _read(self, client):
        status, wanted = client.get(self.job), self.wanted
        if status["status"] in canvas_sweep.ENDED:
            self.rows = client.get(self.job + "/results", None, {"format": "json"})
            self._keep(client, wanted)
        self.status = status

    def _keep(self, client, wanted):
        try:
            answer = client.get(self.job + "/results/0")
        except link.Problem as problem:
            if problem.status != 404:
                raise
            return
        if "variables" not in answer:
            return
        if answer["status"] in NOWHERE:
            self.best = None
            if self.led:  # once more, from the values of the scene
                self.job = None
                return
        self.answer = answer
        values = [one for entry in answer["variables"] for one in _flat(entry["value"])]
        if wanted is not None and wanted.signature == self.signature and answer["status"] not in NOWHERE:
            self.best = (wanted.unknowns, values)


def _flat(value):
    if not isinstance(value, list):
        return [value]
    return [one for part in value for one in _flat(part)]


def design(ghenv, forces, anchors, settings, rides, variables, goals, constraints, method, run):
    """One solution of the component: its outputs."""
    document = ghenv.Component.OnPingDocument()
    key = (words.identity(ghenv), str(getattr(document, "RuntimeID", id(document))))
    found = _searches.setdefault(key, Search())
    made = Outputs()
    given = (forces, anchors, settings, rides, variables, goals, constraints, method)
    read = words.told(ghenv, lambda: _wanted(ghenv, *given))
    if read is not None and found.wanted is not None and read.signature == found.wanted.signature:
        read = found.wanted
    wanted = read if flag(run, True) else None
    if wanted is not None or found.job is not None:
        found.look(wanted)
        if found.task is not None:
            found.task.wait(link.service.patience(link.WAIT))
        _tell(ghenv, found)
    else:
        words.note(ghenv, "" if read is None else "off")
    if read is not None and found.answer is not None:
        words.told(ghenv, lambda: _show(ghenv, made, found, read))
    return made


def _wanted(ghenv, forces, anchors, settings, rides, variables, goals, constraints, method):
    read = compose.read([str(item) for item in listed(forces)], None, "_forces")
    if not read:
        raise missing("_forces is missing; connect the outputs of force components")
    given = setup.anchors(ghenv, anchors)
    held = [dict(one, home=one["point"], target=one["target"] or one["point"]) for one in given]
    setting = compose.read(settings, "settings", "settings_")[-1:]
    carried = [compose.ride(item) for _, items in geometry.branches(rides) for item in items if item is not None]
    unit = geometry.length_unit()
    scene = compose.compose(read, held, setting[0] if setting else None, [entry for entry, _ in carried], unit)
    problem = {"scene": scene}
    for name, value in (("variables", variables), ("goals", goals), ("constraints", constraints)):
        what = name[:-1]
        entries = [one[what] for one in compose.read(listed(value), what, name)]
        for entry in entries:  # what is measured from a mesh needs it in the scene, where it stays as drawn
            if "mesh_drawn" in entry:
                scene["meshes"].setdefault(entry["mesh"], entry.pop("mesh_drawn"))
        problem[name] = [_placed(entry, given, what) for entry in entries]
    if not problem["variables"]:
        raise missing("_variables is missing; connect the output of Variables")
    if not problem["goals"] and not problem["constraints"]:
        raise missing("_goals is missing; connect the output of Goals or of Constraints")
    if listed(method):
        problem["settings"] = {"method": word(method, METHODS, "method")}
    makers = [make for _, make in carried]
    return Wanted(scene, problem, makers, lambda said: setup.placed(read, held, said))


def _placed(entry, anchors, what):
    """An entry with the number of the anchor that is at its point."""
    if "anchor_at" not in entry:
        return entry
    place = entry["anchor_at"]
    distances = [sum((p - q) ** 2 for p, q in zip(place, one["point"])) for one in anchors]
    if not distances or min(distances) > compose.WELD**2:
        raise Unfit("%s: no anchor is at (%g, %g, %g)" % ((what,) + tuple(place)))
    found = {name: value for name, value in entry.items() if name != "anchor_at"}
    return dict(found, anchor=distances.index(min(distances)))


def _tell(ghenv, found):
    """Words on how the search stands, and the next look at it."""
    task, status = found.task, found.status
    if task is not None and task.done and task.problem is not None and not link.wants_server(task.problem):
        words.note(ghenv, "refused")
        said = task.trouble.replace("/scene/", "/")
        words.error(ghenv, link.plainly(found.wanted.placed(said) if found.wanted is not None else said))
        return
    trouble = task.trouble if task is not None else None
    if trouble:
        (words.remark if task.patient else words.warning)(ghenv, trouble)
    if found.settled:
        if found.wanted is None:
            words.note(ghenv, "off")
        elif status["status"] == "failed":
            words.note(ghenv, "failed")
            words.error(ghenv, link.plainly(status["message"]))
        else:
            _tell_end(ghenv, found)
        return
    progress = (status or {}).get("progress") if found.ours else None
    words.note(ghenv, "objective %.4g" % progress["objective"] if progress else "working")
    words.schedule(ghenv, LOOK if not trouble else 500)


def _tell_end(ghenv, found):
    answer = found.answer
    if answer is None:
        return
    words.note(ghenv, "%.4g" % answer["objective"] if answer["status"] == "converged" else answer["status"])
    if answer["status"] != "converged":
        words.warning(ghenv, answer["message"])
    for sentence in answer["warnings"] + (found.rows or {}).get("warnings", []):
        words.warning(ghenv, link.plainly(found.wanted.placed(sentence)))


def _show(ghenv, made, found, wanted):
    """Outputs of the last answer, which goes on until the next one is there."""
    answer = found.answer
    result = answer["result"]
    made.values = geometry.to_tree([("{%d}" % i, _flat(entry["value"])) for i, entry in enumerate(answer["variables"])])
    made.names = [entry["name"] for entry in answer["variables"]]
    for name in ("goals", "constraints"):
        entries = [("{%d}" % i, _flat(entry["value"])) for i, entry in enumerate(answer[name])]
        setattr(made, name, geometry.to_tree(entries))
    made.objective, made.status = answer["objective"], answer["status"]
    made.particles = [geometry.to_point(place) for place in result["particles"]]
    pulls = [canvas_sweep._shown(one.get("force") or one.get("moment") or []) for one in result["forces"]]
    made.forces = geometry.to_tree([("{%d}" % i, row) for i, row in enumerate(pulls)])
    made.reactions = canvas_sweep._shown(result["reactions"]["force"])
    if len(result["geometry"]) == len(wanted.makers):
        from .canvas_moments import places

        made.geometry = [make(places(one)) for one, make in zip(result["geometry"], wanted.makers)]
    made.scene = text(answer["scene"])
    made.report = [answer["message"]] + [
        _bound(entry) for entry in answer["variables"] if any(_flat(entry["at_bound"]))
    ]


def _bound(entry):
    flags = _flat(entry["at_bound"])
    return "%s: %d of %d values are at a bound." % (entry["name"], sum(flags), len(flags))
