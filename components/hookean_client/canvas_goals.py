"""Variables, goals and constraints of design problems as text. For Python 2.7 to 3.13."""

import hashlib

from . import canvas_geometry as geometry
from . import canvas_words as words
from .canvas_geometry import TEXT, Unfit, listed, missing
from .canvas_items import plain, text
from .canvas_packed import packed
from .canvas_scene import read
from .canvas_values import flag, word

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
    "direction",
    "curvature",
    "buckling_factor",
)
ALONE = ("frequency", "buckling_factor")  # measured of all that there is
AXES = ("x", "y", "z", "xy", "xz", "yz", "xyz")
PARTICLES = ("drawn", "mass")  # fields of particles at points
TIES = ("each", "all")


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
            raise missing("_force is missing; give the name of a force, or points of anchors")
        own = {"tie": _tie(tie)}
        if owners:
            own["field"] = _text(field)
            if not own["field"]:
                raise missing("_field is missing; give the name of a column, such as rest_length")
        own.update(_some(axes=_axes(axes), lower=_number(lower, "lower"), upper=_number(upper, "upper")))
        title = _text(name)
        if title:
            own["name"] = title
        return [_item("variable", dict(owner, **own)) for owner in owners + held]

    return words.told(ghenv, work)


def goals(ghenv, kind, places, **given):
    """Goals as text: `target`, or a range from `lower` to `upper` (neither: minimised), and `weight`."""
    return words.told(ghenv, lambda: _measured("goal", kind, places, given, ("target", "lower", "upper", "weight")))


def constraints(ghenv, kind, places, **given):
    """Constraints as text: `lower`, `upper`."""

    def work():
        if not listed(given["lower"]) and not listed(given["upper"]):
            raise missing("lower_ or upper_ is missing; give one or both")
        return _measured("constraint", kind, places, given, ("lower", "upper"))

    return words.told(ghenv, work)


def _measured(what, kind, places, given, limits):
    """Entries of one quantity: at points, of forces, of anchors or of meshes."""
    if not listed(kind):
        raise missing("_kind is missing; give one of %s" % ", ".join(KINDS))
    kind = _kind(kind)
    own = {"kind": kind}
    own.update(_some(axes=_axes(given.get("axes")), column=_text(given.get("column")) or None))
    for switch in ("equal", "total", "size"):
        if flag(given.get(switch), False):
            own[switch] = True
    elements = [int(geometry.number(item)) for item in listed(given.get("elements"))]
    if elements:
        own["elements"] = elements
    for limit in limits:
        own.update(_some(**{limit: _values(given[limit], limit)}))
    if _text(given.get("name")):
        own["name"] = _text(given["name"])
    return [_item(what, dict(own, **owner)) for owner in _owners(kind, *places)]


def _owners(kind, points, forces, anchors, meshes):
    """Of what a quantity is measured, an entry each: all points together, of offsets beside each mesh."""
    at, drawn = geometry.points(points), [geometry.mesh(item) for item in listed(meshes)]
    named = [{"mesh": mesh_name(one)} for one in drawn]
    if kind == "offset":
        if not at or not named:
            raise missing("connect points and meshes; an offset is the distance of points from a mesh")
        return [dict(mesh, points=at, mesh_drawn=packed(one)) for mesh, one in zip(named, drawn)]
    owners = [{"force": _name(item)} for item in listed(forces)]
    owners += [{"anchor_at": place} for place in geometry.points(anchors)]
    owners += named
    if at:
        owners.append({"points": at})
    if not owners and kind not in ALONE:
        raise missing("connect points, names of forces, anchors or meshes of which %s is measured" % kind)
    return owners or [{}]


def _kind(given):
    """A kind by its name or number; other names are those of later versions of the service."""
    item, name = listed(given)[0], _text(given).lower()
    if isinstance(item, geometry.NUMBERS) or name.isdigit():
        return word([item], KINDS, "kind")
    return name


def mesh_name(plain):
    """The name that a mesh has in the scene."""
    return "mesh-" + hashlib.sha1(text(packed(plain)).encode("ascii")).hexdigest()[:12]


def _item(what, entry):
    return text({"kind": what, what: entry})


def _tie(given):
    """A word, or lists of elements that have one value each."""
    rows = [items for _, items in geometry.branches(given) if items]
    if not rows:
        return "each"
    if len(rows) == 1 and len(rows[0]) == 1:
        return word(rows[0], TIES, "tie")
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
        [value] = read([item], None, "_force")
        return str(value.get("name") or value["source"]["title"])
    found = str(item).strip()
    return int(found) if found.isdigit() else found


def _axes(given):
    found = _text(given).lower()
    if found and found not in AXES:
        raise Unfit("axes: %s is unknown; known: %s" % (geometry.called(found), ", ".join(AXES)))
    return found or None


def _number(given, name):
    items = listed(given)
    if len(items) > 1:
        raise Unfit("%s: %d numbers given; give one, and other variables their own component" % (name, len(items)))
    try:
        return geometry.number(items[0]) if items else None
    except Unfit as unfit:
        raise Unfit("%s: %s" % (name, unfit))


def _values(given, name):
    """One number, several, or points as rows of three."""
    try:
        found = [plain(item) for item in listed(given)]
    except Unfit as unfit:
        raise Unfit("%s: %s" % (name, unfit))
    if any(isinstance(one, (bool,) + TEXT) for one in found):
        raise Unfit("%s: numbers or points are expected" % name)
    return None if not found else found[0] if len(found) == 1 and not isinstance(found[0], list) else found
