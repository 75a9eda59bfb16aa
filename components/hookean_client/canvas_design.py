"""The components of design problems: what may vary, goals, constraints, and the search; the service runs it as a job.

Variables, goals and constraints travel as text. A solution looks at how the search stands and schedules the next look;
other goals or another scene start it again from the best values so far. For Python 2.7 to 3.13.
"""

import hashlib

from . import canvas, canvas_engine, canvas_sweep
from . import canvas_geometry as geometry
from . import canvas_link as link
from . import canvas_scene as compose
from . import canvas_tools as tools
from .canvas_geometry import TEXT, Unfit, listed

LOOK = 120  # milliseconds to the next look at a search that runs
KINDS = (
    "position",
    "length",
    "force",
    "force_density",
    "load_path",
    "output",
    "reaction",
    "area",
    "volume",
    "planarity",
    "fairness",
    "offset",
    "strain_energy",
    "frequency",
)
AXES = ("x", "y", "z", "xy", "xz", "yz", "xyz")
METHODS = ("auto", "least_squares", "levenberg_marquardt", "l-bfgs-b", "slsqp", "augmented_lagrangian")
PARTICLES = ("drawn", "mass")  # fields of particles at points
TIES = ("each", "all")
_searches = {}  # by component in an open document


class Outputs(object):
    """What the component puts out; None where nothing is known yet."""

    values = names = goals = constraints = objective = geometry = particles = forces = reactions = scene = status = (
        report
    ) = None


# texts


def variables(ghenv, forces, field, anchors, axes, tie, lower, upper, name):
    """What may vary as text: a column of each force that is named, where anchors hold their particles, or what of
    particles at points varies: where they are drawn, or their mass."""

    def work():
        owners = [{"force": _name(item)} for item in listed(forces)]
        places = geometry.points(anchors)
        if not owners and places and _text(field) in PARTICLES:
            owners, places = [{"points": places}], []
        held = [{"anchor_at": place} for place in places]
        if owners and held:
            raise Unfit("forces and anchors are connected; connect one of them")
        if not owners and not held:
            raise compose.missing("_force is missing; give the name of a force, or points of anchors")
        own = {"tie": _tie(tie)}
        if owners:
            own["field"] = _text(field)
            if not own["field"]:
                raise compose.missing("_field is missing; give the name of a column, such as rest_length")
        own.update(_some(axes=_axes(axes), lower=_number(lower, "lower"), upper=_number(upper, "upper")))
        title = _text(name)
        if title:
            own["name"] = title
        return [_item("variable", dict(owner, **own)) for owner in owners + held]

    return canvas._told(ghenv, work)


def goals(ghenv, kind, places, **given):
    """Goals as text: `target`, or a range from `lower` to `upper` (neither: minimised), and `weight`."""
    return canvas._told(ghenv, lambda: _measured("goal", kind, places, given, ("target", "lower", "upper", "weight")))


def constraints(ghenv, kind, places, **given):
    """Constraints as text: `lower`, `upper`."""

    def work():
        if not listed(given["lower"]) and not listed(given["upper"]):
            raise compose.missing("lower_ or upper_ is missing; give one or both")
        return _measured("constraint", kind, places, given, ("lower", "upper"))

    return canvas._told(ghenv, work)


def _measured(what, kind, places, given, limits):
    """Entries of one quantity: at points, of forces, of anchors or of meshes."""
    if not listed(kind):
        raise compose.missing("_kind is missing; give one of %s" % ", ".join(KINDS))
    kind = tools.word(kind, KINDS, "kind") if str(listed(kind)[0]).strip() in KINDS + _numbers() else _text(kind)
    own = {"kind": kind}
    own.update(_some(axes=_axes(given.get("axes")), column=_text(given.get("column")) or None))
    for flag in ("equal", "total", "size"):
        if listed(given.get(flag)) and tools.flag(given[flag], False):
            own[flag] = True
    elements = [int(geometry.number(item)) for item in listed(given.get("elements"))]
    if elements:
        own["elements"] = elements
    for limit in limits:
        own.update(_some(**{limit: _values(given[limit], limit)}))
    if _text(given.get("name")):
        own["name"] = _text(given["name"])
    points, forces, anchors, meshes = places
    owners = [{"force": _name(item)} for item in listed(forces)]
    owners += [{"anchor_at": place} for place in geometry.points(anchors)]
    owners += [{"mesh": mesh_name(geometry.mesh(item))} for item in listed(meshes)]
    at = geometry.points(points)
    if at:
        owners.append({"points": at})
    if not owners:
        raise compose.missing("connect points, names of forces, anchors or meshes of which %s is measured" % kind)
    return [_item(what, dict(own, **owner)) for owner in owners]


def _numbers():
    return tuple(str(i) for i in range(len(KINDS)))


def mesh_name(plain):
    """The name that a mesh has in the scene."""
    return "mesh-" + hashlib.sha1(compose.text(link.packed(plain)).encode("ascii")).hexdigest()[:12]


def _item(what, entry):
    return compose.text({"kind": what, what: entry})


def _tie(given):
    """A word, or lists of elements that have one value each."""
    rows = [items for _, items in geometry.branches(given) if items]
    if not rows:
        return "each"
    if len(rows) == 1 and len(rows[0]) == 1:
        return tools.word(rows[0], TIES, "tie")
    try:
        return [[int(geometry.number(item)) for item in row] for row in rows]
    except Unfit as unfit:
        raise Unfit("tie: %s" % unfit)


def _some(**values):
    return {name: value for name, value in values.items() if value is not None}


def _text(given):
    items = listed(given)
    return str(items[0]).strip() if items else ""


def _name(item):
    """The name of a force: text, or the output of a force component."""
    if isinstance(item, TEXT) and '"source"' in item:
        [value] = compose.read([item], None, "_force")
        return str(value.get("name") or value["source"]["title"])
    found = str(item).strip()
    return int(found) if found.isdigit() else found


def _axes(given):
    found = _text(given).lower()
    if found and found not in AXES:
        raise Unfit("axes: unknown %s; known: %s" % (geometry.called(found), ", ".join(AXES)))
    return found or None


def _number(given, name):
    items = listed(given)
    try:
        return geometry.number(items[0]) if items else None
    except Unfit as unfit:
        raise Unfit("%s: %s" % (name, unfit))


def _values(given, name):
    """One number, several, or points as rows of three."""
    try:
        found = [compose._value(item) for item in listed(given)]
    except Unfit as unfit:
        raise Unfit("%s: %s" % (name, unfit))
    if any(isinstance(one, (bool,) + TEXT) for one in found):
        raise Unfit("%s: numbers or points are expected" % name)
    return None if not found else found[0] if len(found) == 1 and not isinstance(found[0], list) else found


# the search


class Wanted(object):
    """The inputs of a search, read: the problem and its text without values to start from."""

    def __init__(self, scene, problem, makers, placed):
        self.scene, self.problem, self.makers, self.placed = scene, problem, makers, placed
        self.falls = None
        self.text = compose.text(problem)
        self.signature = hashlib.sha1((canvas.VERSION + self.text).encode("ascii")).hexdigest()
        count = {name: problem[name] for name in ("variables",)}
        self.unknowns = compose.text([count, [one["name"] for one in scene["forces"]], compose.places(scene)])


class Search(canvas_sweep.Sweep):
    """A search as the canvas wants it, its job, and its last answer, of whatever goals."""

    answer = best = None  # the last answer; the values it has and what they are values of

    def _submit(self, client, wanted):
        problem = wanted.problem
        if self.best is not None and self.best[0] == wanted.unknowns:
            problem = dict(problem, start=self.best[1])
        body = compose.text(problem).encode("ascii")
        key = hashlib.sha1(canvas.VERSION.encode("ascii") + body).hexdigest() + self._again
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
        self.answer = answer
        values = [one for entry in answer["variables"] for one in _flat(entry["value"])]
        if wanted is not None and wanted.signature == self.signature:
            self.best = (wanted.unknowns, values)


def _flat(value):
    if not isinstance(value, list):
        return [value]
    return [one for part in value for one in _flat(part)]


def design(ghenv, forces, anchors, settings, rides, variables, goals, constraints, method, run):
    """One solution of the component: its outputs."""
    document = ghenv.Component.OnPingDocument()
    key = (canvas.identity(ghenv), str(getattr(document, "RuntimeID", id(document))))
    found = _searches.setdefault(key, Search())
    made = Outputs()
    given = (forces, anchors, settings, rides, variables, goals, constraints, method)
    read = canvas._told(ghenv, lambda: _wanted(ghenv, *given))
    if read is not None and found.wanted is not None and read.signature == found.wanted.signature:
        read = found.wanted
    wanted = read if tools.flag(run, True) else None
    if wanted is not None or found.job is not None:
        found.look(wanted)
        if found.task is not None:
            found.task.wait(link.service.patience(link.WAIT))
        _tell(ghenv, found)
    else:
        canvas.note(ghenv, "" if read is None else "off")
    if read is not None and found.answer is not None:
        canvas._told(ghenv, lambda: _show(ghenv, made, found, read))
    return made


def _wanted(ghenv, forces, anchors, settings, rides, variables, goals, constraints, method):
    read = compose.read([str(item) for item in listed(forces)], None, "_forces")
    if not read:
        raise compose.missing("_forces is missing; connect the outputs of force components")
    given = canvas_engine._anchors(ghenv, anchors)
    held = [dict(one, home=one["point"], target=one["target"] or one["point"]) for one in given]
    setting = compose.read(settings, "settings", "settings_")[-1:]
    carried = [compose.ride(item) for _, items in geometry.branches(rides) for item in items if item is not None]
    unit = canvas_engine._length_unit()
    scene = compose.compose(read, held, setting[0] if setting else None, [entry for entry, _ in carried], unit)
    problem = {"scene": scene}
    for name, value in (("variables", variables), ("goals", goals), ("constraints", constraints)):
        what = name[:-1]
        entries = [one[what] for one in compose.read(listed(value), what, name)]
        problem[name] = [_placed(entry, given, what) for entry in entries]
    if not problem["variables"]:
        raise compose.missing("_variables is missing; connect the output of Variables")
    if not problem["goals"] and not problem["constraints"]:
        raise compose.missing("_goals is missing; connect the output of Goals or of Constraints")
    if listed(method):
        problem["settings"] = {"method": tools.word(method, METHODS, "method")}
    makers = [make for _, make in carried]
    return Wanted(scene, problem, makers, lambda said: canvas_engine.placed(read, held, said))


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
        canvas.note(ghenv, "refused")
        said = task.trouble.replace("/scene/", "/")
        canvas.error(ghenv, link.plainly(found.wanted.placed(said) if found.wanted is not None else said))
        return
    trouble = task.trouble if task is not None else None
    if trouble:
        (canvas.remark if task.patient else canvas.warning)(ghenv, trouble)
    if found.settled:
        if found.wanted is None:
            canvas.note(ghenv, "off")
        elif status["status"] == "failed":
            canvas.note(ghenv, "failed")
            canvas.error(ghenv, link.plainly(status["message"]))
        else:
            _tell_end(ghenv, found)
        return
    progress = (status or {}).get("progress") if found.ours else None
    canvas.note(ghenv, "objective %.4g" % progress["objective"] if progress else "working")
    canvas.schedule(ghenv, LOOK if not trouble else 500)


def _tell_end(ghenv, found):
    answer = found.answer
    if answer is None:
        return
    canvas.note(ghenv, "%.4g" % answer["objective"] if answer["status"] == "converged" else answer["status"])
    if answer["status"] != "converged":
        canvas.warning(ghenv, answer["message"])
    for sentence in answer["warnings"] + (found.rows or {}).get("warnings", []):
        canvas.warning(ghenv, link.plainly(found.wanted.placed(sentence)))


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
    made.scene = compose.text(answer["scene"])
    made.report = [answer["message"]] + [
        _bound(entry) for entry in answer["variables"] if any(_flat(entry["at_bound"]))
    ]


def _bound(entry):
    flags = _flat(entry["at_bound"])
    return "%s: %d of %d values are at a bound." % (entry["name"], sum(flags), len(flags))
