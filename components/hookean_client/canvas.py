"""What components on Grasshopper's canvas share. A component's code is little more than one call:

    force = canvas.force(ghenv, "springs", lines=_connection, stiffness=_stiffness_)

Everything here runs inside one run of a component in script mode. Bad input is never raised: it becomes one sentence
on the component, and what is returned is None. Nothing holds the canvas up for longer than `canvas_link.WAIT` seconds:
what takes longer goes on in a thread, and a solution is scheduled that fetches it. For Python 2.7 to 3.13.
"""

import hashlib
import json
import sys

from . import __version__ as VERSION
from . import canvas_geometry as geometry
from . import canvas_link as link
from . import canvas_scene as scene
from .canvas_geometry import Unfit, listed, matched

__all__ = ["VERSION", "Unfit", "geometry", "listed", "matched"]
TAKES = dict(
    [(name, "curve") for name in ("divide", "shatter", "explode", "end_points", "length", "split_at_corners")]
    + [(name, "surface") for name in ("mesh_surface", "mesh_faces")]
    + [(name, "points") for name in ("remove_duplicate_points", "arc", "interpolate", "fold_angle", "mesh_map")]
    + [(name, "points") for name in ("interconnect_points", "moebius_transformation")]
    + [(name, "lines") for name in ("remove_duplicate_lines", "catenary", "bipartite", "pipes")]
    + [("clean", "meshes")]
)  # what an operation takes; all others take a mesh
SHAPES = {"source": "mesh", "target": "mesh", "end": "points", "tip_1": "points", "tip_2": "points",
          "vertices": "indices"}  # fmt: skip
# options that are geometry, or lists
WHOLE = ("count", "u", "v", "degree", "level", "iterations", "sides", "turns")  # options that are whole numbers
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
    key = identity(ghenv)
    known = _turns.get(key)
    if known is None or (run_of(ghenv) <= 1 and link.now() - known.last > PAUSE):
        _turns[key] = known = Turn(known.tasks if known else {})
    known.last = link.now()
    return known


def identity(ghenv):
    """The id of a component as text."""
    return str(ghenv.Component.InstanceGuid)


def run_of(ghenv):
    """Which run of its solution a component is in, from 1."""
    return int(getattr(ghenv.Component, "RunCount", 1) or 1)


# words on the component


def say(ghenv, level, sentence):
    """A sentence on the component, once in a solution; `level`: Error, Warning or Remark."""
    from Grasshopper.Kernel import GH_RuntimeMessageLevel

    if not _says(ghenv, sentence):
        ghenv.Component.AddRuntimeMessage(getattr(GH_RuntimeMessageLevel, level), sentence)


def _says(ghenv, sentence):
    """Whether a component shows this message already."""
    from Grasshopper.Kernel import GH_RuntimeMessageLevel as levels

    known = getattr(ghenv.Component, "RuntimeMessages", lambda _: ())
    return any(sentence in list(known(level)) for level in (levels.Error, levels.Warning, levels.Remark))


def error(ghenv, sentence):
    """What went wrong; the component turns red."""
    say(ghenv, "Error", sentence)


def warning(ghenv, sentence):
    """What a person should know; the component turns orange."""
    say(ghenv, "Warning", sentence)


def remark(ghenv, sentence):
    """What may be of interest."""
    say(ghenv, "Remark", sentence)


def note(ghenv, text):
    """A few words under the component; "" takes them away."""
    ghenv.Component.Message = text


def schedule(ghenv, milliseconds):
    """Solve this component again after so long."""
    component, document = ghenv.Component, ghenv.Component.OnPingDocument()
    if document is None:
        return
    from Grasshopper.Kernel import GH_Document

    document.ScheduleSolution(
        int(milliseconds), GH_Document.GH_ScheduleDelegate(lambda _: component.ExpireSolution(False))
    )


# what the engine is told


def force(ghenv, kind, **fields):
    """A force as text for the engine, by the names of its fields (docs/forces.md); None where its place is missing."""
    return _told(ghenv, lambda: scene.force(source(ghenv), kind, fields))


def anchors(ghenv, points, targets=None, x=True, y=True, z=True):
    """Anchors as text for the engine: points, where to hold them (none: there) and in which directions."""
    return _told(ghenv, lambda: scene.anchors(source(ghenv), points, targets, (x, y, z)))


def settings(ghenv, **fields):
    """Settings as text for the engine: those of a scene, its `weld_tolerance`, the units `length`, `force` and `time`,
    `fast`, whether it runs as quickly as it can, and `all_particles`, whether points of any force become particles."""
    return _told(ghenv, lambda: scene.settings(fields))


def source(ghenv):
    """Who an item comes from: component, its name for people, and the run."""
    component = ghenv.Component
    title = str(getattr(component, "NickName", "") or getattr(component, "Name", ""))
    return {"component": identity(ghenv), "title": title, "run": run_of(ghenv)}


def _told(ghenv, make):
    try:
        return make()
    except Unfit as unfit:
        text = str(unfit)
        level = "Warning" if getattr(unfit, "missing", False) else "Error"
        say(ghenv, level, text[:1].upper() + text[1:] + "." * (not text.endswith(".")))
        return None


def engine(ghenv, forces, anchors_=None, settings_=None, geometry_=None, reset=True, on=True):
    """One solution of the engine; see `canvas_engine`."""
    from . import canvas_engine

    return canvas_engine.solve(ghenv, forces, anchors_, settings_, geometry_, reset, on)


# what the service is asked


def call(ghenv, method, path, body=None, query=None):
    """The answer of an address of the service, None until it is there; the same question is asked once."""

    def work(client):
        return client.request(method, path, link.packed(body), query, timeout=600.0)

    text = json.dumps([method, path, query, body], sort_keys=True, default=str)
    return link.unpacked(ask(ghenv, (run_of(ghenv), method, path), _digest(text), work))


def discretize(ghenv, operation, item, many=False, **options):
    """What an operation of the service makes of geometry, as Rhino's geometry by name; None until it is there. With
    `many`, one for each item of a list, options matched to the items."""
    return _told(ghenv, lambda: _discretize(ghenv, operation, item, many, options))


def _discretize(ghenv, operation, item, many, options):
    takes = TAKES.get(operation, "mesh")
    if not listed(item):
        raise scene.missing("%s is missing; connect %s" % (takes, "one" if takes in ("curve", "surface") else "it"))
    each = listed(item) if many else [item]
    names = sorted(name for name in options if options[name] is not None)
    columns = [listed(options[name]) if many else [options[name]] for name in names]
    rows = matched(each, *columns)
    bodies = []
    for i, one in enumerate(rows[0]):
        body = {name: _option(name, column[i]) for name, column in zip(names, rows[1:])}
        bodies.append(dict(body, **{takes: _plain(takes, one)}))

    def work(client):
        path = "/v1/discretize/" + operation
        return [client.post(path, link.packed(body), {"arrays": "buffer"}, timeout=600.0) for body in bodies]

    signature = _digest(json.dumps([operation, bodies], sort_keys=True))
    found = ask(ghenv, (run_of(ghenv), operation), signature, work)
    if found is None:
        return None
    made = [_made(link.unpacked(one)) for one in found]
    return made if many else made[0]


def _plain(takes, item):
    if takes == "lines":
        return geometry.lines(item)[0]
    if takes == "points":
        return geometry.points(item)
    if takes == "meshes":
        return [geometry.mesh(one) for one in listed(item)]
    if takes == "indices":
        return [int(geometry.number(one)) for one in listed(item)]
    return getattr(geometry, takes)(item if takes == "mesh" else listed(item)[0])


def _option(name, value):
    """An option as JSON has it: whole numbers stay whole, vectors become lists, one of a list stands alone."""
    if name in SHAPES:
        return _plain(SHAPES[name], value)
    items = [geometry.value(value)] if geometry.is_point(value) else listed(value)
    if len(items) > 1:
        return [_option(name, one) for one in items]
    value = items[0]
    if hasattr(value, "X") and hasattr(value, "Z"):
        return geometry.point(value)
    if isinstance(value, (bool,) + geometry.TEXT):
        return value
    try:
        value = geometry.number(value)
    except Unfit as unfit:
        raise Unfit("%s: %s" % (name, unfit))
    return int(value) if value == int(value) and name in WHOLE else value


def _made(answer):
    """Rhino's geometry of an answer by the names in it."""
    found = {}
    for name, value in answer.items():
        if name.endswith("polylines"):
            value = [geometry.to_polyline(one) for one in value]
        elif name.endswith("points"):
            value = [geometry.to_point(one) for one in value]
        elif name.endswith("lines"):
            value = [geometry.to_line(one) for one in value]
        elif name == "mesh":
            value = geometry.to_mesh(value)
        elif name == "normals":
            value = [geometry.to_vector(one) for one in value]
        found[name] = value
    return found


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
        note(ghenv, "")
        return task.value
    if task.done and not link.wants_server(task.problem):
        note(ghenv, "refused")
        error(ghenv, link.plainly(trouble))
        return None
    if trouble and not _says(ghenv, turn(ghenv).trouble):
        turn(ghenv).trouble = trouble
        (remark if task.patient else warning)(ghenv, trouble)
    note(ghenv, "no server" if trouble and not task.patient else "working")
    schedule(ghenv, 1000 * link.AGAIN if task.done else 200 if trouble else 50)
    return None


def server(ghenv, start=False, stop=False, studio=False):
    """One solution of the server's component; see `canvas_server`."""
    from . import canvas_server

    return canvas_server.stand(ghenv, sys.modules[__name__], start, stop, studio)


def _digest(text):
    return hashlib.sha1(text.encode("utf-8")).hexdigest()
