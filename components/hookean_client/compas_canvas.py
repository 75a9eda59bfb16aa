"""What the COMPAS components on Grasshopper's canvas do, in one call each; see `canvas`.

Forces and anchors of COMPAS structures are texts like those of all our components, so that they and the others go into
the same engine.
"""

from __future__ import absolute_import

from .canvas_geometry import Unfit
from . import canvas_ask as asking
from . import canvas_geometry as geometry
from . import canvas_items as items
from .canvas_geometry import listed
from .canvas_geometry import missing
from .canvas_items import text
from .canvas_packed import unpacked
from . import canvas_words as words
from . import Problem, compas
from . import canvas_fall as fall
from . import canvas_scene as scene


def springs(ghenv, structure, name=None, **columns):
    """Springs on the edges of a structure as text for the engine; columns are numbers or names of attributes."""
    given = {column: _values(value) for column, value in columns.items()}
    given = {column: value for column, value in given.items() if value is not None}
    return _told(ghenv, lambda: _force(ghenv, compas.springs(_structure(structure), **given), name))


def load(ghenv, structure, vector=None, vertices=None, name=None):
    """Loads on vertices as text for the engine."""
    vectors = [geometry.point(one) for one in listed(vector)] or None
    return _told(ghenv, lambda: _force(ghenv, compas.load(_structure(structure), vectors, _keys(vertices)), name))


def anchors(ghenv, structure, vertices=None, targets=None, x=True, y=True, z=True):
    """Anchors on vertices as text for the engine: those of the keys `vertices`, else those with an attribute for held
    ones."""

    def make():
        found = _structure(structure)
        held = compas.anchors(found, _keys(vertices))
        aims = geometry.points(targets) or None
        return items.anchors(words.source(ghenv), compas.values(held["points"]), aims, (x, y, z))

    return _told(ghenv, make)


def structures(ghenv, items):
    """A Mesh of each of Rhino's meshes and one Graph of all lines, in order of appearance."""

    def make():
        given = listed(items)
        if not given:
            raise missing("geometry is missing; connect meshes, lines or curves")
        found, drawn = [], []
        for item in given:
            if geometry.is_mesh(item):
                plain = geometry.mesh(item)
                found.append(compas.to_mesh(plain["vertices"], [_corners(face) for face in plain["faces"]]))
            else:
                drawn.append(item)
        return found + ([compas.to_graph(geometry.lines(drawn)[0])] if drawn else [])

    return _told(ghenv, make)


class Relaxed(object):
    """What `relax` found: `structures` and `geometry` as they came in, and `status`, `residual` [-], `report`."""

    structures = geometry = status = residual = report = None


def relax(ghenv, given, forces, anchors_=None, settings_=None):
    """Structures in equilibrium under forces; empty while the service has not answered."""
    found = Relaxed()

    def make():
        branches = [(path, [_structure(item) for item in items]) for path, items in _branches(given)]
        flat = [item for _, items in branches for item in items]
        if not flat:
            raise missing("structures are missing; connect a COMPAS Mesh or Graph")
        made, tolerance = _scene(flat, forces, anchors_, settings_)
        answer = asking.call(ghenv, "POST", "/v1/relax", made)
        if answer is None:
            return
        moved = iter(compas.relaxed(flat, answer, tolerance))
        rows = [(path, [next(moved) for _ in items]) for path, items in branches]
        found.structures = geometry.to_tree(rows)
        found.geometry = geometry.to_tree([(path, _drawn(items)) for path, items in rows])
        found.status, found.residual = answer["status"], answer["residual"]
        found.report = _report(ghenv, answer, fall.sentence(made, fall.unmatched(answer["report"])))

    _told(ghenv, make)
    return found


def _scene(flat, forces, anchors_, settings_):
    """The scene, and the distance [length] within which vertices are one particle."""
    parts = scene.read(_flat(forces), None, "forces")
    if not parts:
        raise missing("forces are missing; connect COMPAS Springs")
    setting = (scene.read(_flat(settings_), "settings", "settings") or [None])[0]
    held, given = [], _flat(anchors_)
    for place in geometry.points([one for one in given if not isinstance(one, compas.TEXT)]):
        held.append({"name": "", "home": place, "target": place, "axes": "xyz"})
    for one in scene.read([one for one in given if isinstance(one, compas.TEXT)], "anchors", "anchors"):
        for item in one["items"]:
            place, aim = unpacked(item["point"]), unpacked(item["target"])
            told = {"name": one["source"]["title"], "home": place, "target": aim or place, "axes": item["axes"]}
            held.append(told)
    made = scene.compose(parts, held, setting, [])
    tolerance = made.setdefault("weld_tolerance", compas.TOLERANCE)
    made["particles"] = compas.numbers(flat, tolerance)[0]
    return made, tolerance


def _report(ghenv, answer, falls):
    """Sentences on how it ended; what a person should look at is a warning too. `falls`: why it falls, or None."""
    told = answer["report"]
    lines = [answer["message"]]
    lines += ["%d coordinates were merged with other particles." % told["merged"]] if told["merged"] else []
    worth = ([falls] if falls else []) + list(told["warnings"]) + [_missed(one) for one in told["missed"]]
    for sentence in worth + ([answer["message"]] if answer["status"] != "converged" else []):
        words.warning(ghenv, sentence)
    words.note(ghenv, answer["status"].replace("_", " "))
    return "\n".join(lines + worth)


def _missed(one):
    """A sentence on an anchor or load with points that met no particle, by its name if it has one."""
    said = one["message"].partition(": ")[2] if one["name"] else one["message"]
    return said.replace("weld_tolerance", "the tolerance in Settings") + "."


def _force(ghenv, made, name):
    source = words.source(ghenv)
    names = [str(one) for one in listed(name)]
    return text(dict(made, source=dict(source, title=names[0]) if names else source))


def _told(ghenv, make):
    """What `make()` makes; a sentence on the component, and None, where it cannot."""
    try:
        return make()
    except Unfit as unfit:
        said, missing = str(unfit), getattr(unfit, "missing", False)
    except Problem as problem:
        said, missing = problem.detail, False
    words.say(ghenv, "Warning" if missing else "Error", said[:1].upper() + said[1:] + "." * (not said.endswith(".")))
    return None


def _structure(item):
    if item is None:
        raise missing("a structure is missing; connect a COMPAS Mesh or Graph")
    found = geometry.value(item)
    compas.kind(found)
    return found


def _values(given):
    """Numbers, or the name of an attribute; None where nothing is given."""
    items = listed(given)
    numbers = []
    for item in items:
        try:
            numbers.append(geometry.number(item))
        except Unfit:
            if len(items) > 1:
                raise
            return str(item)
    return numbers or None


def _keys(given):
    """Keys of vertices as text, so that 3, 3.0 and "3" are the same; None where none are given."""
    items = listed(given)
    whole = [int(item) if isinstance(item, float) and item == int(item) else item for item in items]
    return [str(item).strip() for item in whole] or None


def _branches(given):
    """Pairs of a path and items; a list may hold structures that could be walked through themselves."""
    if hasattr(given, "Paths"):
        return geometry.branches(given)
    items = given if isinstance(given, (list, tuple)) else [given]
    return [("{0}", [item for item in items if item is not None])]


def _flat(given):
    return [item for _, items in geometry.branches(given) for item in items if item is not None]


def _corners(face):
    return face[:3] if len(face) == 4 and face[3] == face[2] else face


def _drawn(items):
    """Rhino's geometry of structures: meshes, lines, polylines, points."""
    found = []
    for item in items:
        what, places = compas.kind(item), compas.points(item)
        at = dict(zip(compas.keys(item), places))
        if what == "mesh":
            number = {key: i for i, key in enumerate(at)}
            faces = [[number[key] for key in face] for face in compas.faces(item)]
            faces = [part for face in faces for part in _quads(face)]
            found.append(geometry.to_mesh({"vertices": places, "faces": faces}))
        elif what in ("graph", "line"):
            found += [geometry.to_line([at[a], at[b]]) for a, b in compas.edges(item)]
        elif what in ("polyline", "polygon"):
            found.append(geometry.to_polyline(places + places[:1] * (what == "polygon")))
        else:
            found += [geometry.to_point(place) for place in places]
    return found


def _quads(face):
    """A face of more than four sides as a fan of triangles."""
    return [face] if len(face) < 5 else [[face[0], face[i], face[i + 1]] for i in range(1, len(face) - 1)]
