"""What components give one another as JSON text: a force is {"kind": "springs", "source": ..., and its fields}, arrays
as buffers; anchors and settings likewise. For Python 2.7 to 3.13.
"""

import json

from . import canvas_geometry as geometry
from .canvas_geometry import Unfit, listed, matched, missing
from .canvas_packed import packed

PLACES = ("lines", "points", "mesh", "particles")
EVERYWHERE = ("self_weight", "impulse")  # without a place they act on all particles
SHARED = ("control_points", "charges", "charge", "corners", "image", "path")  # rows of numbers as text
TEXTS = ("release_start", "release_end")  # of which each element may have its own
WHOLE = ("sub_iterations", "max_iterations")
SOLVERS = ("verlet", "yoshida", "momentum", "relaxation", "newton", "force_density")
UNITS = ("length", "force", "time")


def text(value):
    """A value as it travels, the same for the same value."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"))


def force(source, kind, fields):
    """The text of a force; see `canvas.force`."""
    fields = {name: value for name, value in fields.items() if not _empty(value)}
    made = {"kind": kind, "source": source}
    if "matrix" in fields:
        made["matrix"] = geometry.matrix(fields.pop("matrix"))
    lists, spread = _columns(kind, fields), None
    if "target" in fields:
        made.update(geometry.mesh(fields["target"]))
    made.update(_shared(kind, fields))
    if "curve" in fields:
        made["curve"] = geometry.straight(listed(fields["curve"])[0])
    place = [name for name in PLACES if name in fields]
    if "lines" in place and all(geometry.is_mesh(item) for item in listed(fields["lines"])):
        fields["mesh"] = fields.pop("lines")
        place = ["mesh"]
    if kind == "floor" or (kind in EVERYWHERE and not place):
        made.update((name, values[0]) for name, values in lists.items())
        return text(made)
    if len(place) > 1:
        raise Unfit("%s: %s are connected; connect one of them" % (kind, " and ".join(place)))
    if not place:
        raise missing("%s: its place is missing; connect lines, points or a mesh" % kind)
    if place == ["mesh"]:
        made["mesh"] = geometry.mesh(fields["mesh"])
        made.update((name, _single(values)) for name, values in lists.items())
        return text(packed(made))
    items = _rows(kind, fields[place[0]], place[0])
    names = sorted(lists)
    rows = matched(items, *[lists[name] for name in names])
    if place == ["lines"]:
        made["lines"], spread = geometry.lines(rows[0], points=kind == "collide_lines")
    else:
        made[place[0]] = rows[0]
    for name, values, given in zip(names, rows[1:], [lists[name] for name in names]):
        if len(given) > 1 and spread is not None:
            values = [value for value, times in zip(values, spread) for _ in range(times)]
        made[name] = values if name == "targets" else _single(values if len(given) > 1 else given)
    return text(packed(made))


def _empty(value):
    return all(_empty(one) for one in value) if isinstance(value, tuple) else not listed(value)


def _columns(kind, fields):
    """Values of all fields that are no places, as lists."""
    found = {}
    for name, value in fields.items():
        if name not in PLACES + ("target", "curve") + SHARED:
            try:
                found[name] = [plain(item) for item in listed(value)]
            except Unfit as unfit:
                raise Unfit("%s, %s: %s" % (kind, name, unfit))
            if name not in TEXTS and any(isinstance(one, (bool, str)) for one in found[name]):
                if any(one != found[name][0] for one in found[name]):
                    raise Unfit("%s, %s: several values are connected; it takes one for all" % (kind, name))
                found[name] = found[name][:1]
    return found


def _shared(kind, fields):
    """Values of a force as a whole, of which there is not one for each element: surfaces, images, points, numbers."""
    made = {}
    for name in [one for one in SHARED if one in fields]:
        items = listed(fields[name])
        try:
            if name == "control_points":
                made.update(geometry.surface(items[0]))
                made[name] = made.pop("points")
            elif name in ("corners", "charges"):
                made[name] = geometry.points(items)
            else:
                rows = [item.replace(",", " ").split() if isinstance(item, geometry.TEXT) else [item] for item in items]
                rows = [
                    [int(geometry.number(n)) if name == "path" else geometry.number(n) for n in row] for row in rows
                ]
                flat = name == "charge" or all(len(row) == 1 for row in rows)
                made[name] = [n for row in rows for n in row] if flat else rows
        except KeyError:
            raise Unfit(
                "%s: trimmed faces and Breps of several are no NURBS surface; connect one untrimmed face" % kind
            )
        except Unfit as unfit:
            raise Unfit("%s, %s: %s" % (kind, name, unfit))
    return made


def plain(item):
    """A number, a flag, a word or a vector of an input."""
    if isinstance(item, bool) or str(item) in ("True", "False"):
        return str(item) == "True"
    if isinstance(item, geometry.TEXT) and "," not in item:
        try:
            return geometry.number(item)
        except Unfit:
            return str(item)
    if isinstance(item, geometry.TEXT + (list, tuple)) or hasattr(item, "Z"):
        return geometry.point(item)
    return geometry.number(item)


def _single(values):
    return values[0] if len(values) == 1 else values


def _rows(kind, given, place):
    """The items of a place: lines as they are, points, or rows of points where a tuple of lists is given."""
    try:
        if place == "lines":
            return listed(given)
        if place == "particles":
            return [int(geometry.number(item)) for item in listed(given)]
        if not isinstance(given, tuple):
            return geometry.points(given)
        corners = [geometry.points(one) for one in given]
    except Unfit as unfit:
        raise Unfit("%s: %s" % (kind, unfit))
    if not all(corners):
        raise missing("%s: a point of each element is missing; connect all %d" % (kind, len(corners)))
    return [list(row) for row in zip(*matched(*corners))]


def anchors(source, points, targets, axes):
    """The text of anchors: an item for each point that is held in any direction."""
    places = geometry.points(points)
    if not places:
        raise missing("anchors: points are missing; connect points")
    aims = geometry.points(targets)
    flags = [[bool(plain(item)) for item in listed(axis)] or [True] for axis in axes]
    rows = matched(places, aims, *flags)
    items = []
    for i, place in enumerate(rows[0]):
        held = "".join(name for name, flag in zip("xyz", rows[2:]) if flag[i])
        if held:
            items.append({"point": place, "target": rows[1][i] if aims else None, "axes": held})
    return text({"kind": "anchors", "source": source, "items": items})


def settings(fields):
    """The text of settings: `units`, `weld_tolerance`, `fast`, `all_particles`, and `settings` as a scene has them."""
    made = {"kind": "settings", "units": {}, "settings": {}}
    for name, value in sorted(fields.items()):
        items = listed(value)
        if not items:
            continue
        try:
            found = plain(items[0])
        except Unfit as unfit:
            raise Unfit("settings, %s: %s" % (name, unfit))
        if name == "solver" and isinstance(found, geometry.NUMBERS):
            found = SOLVERS[int(found)] if 0 <= found < len(SOLVERS) else found
        if name in WHOLE and isinstance(found, geometry.NUMBERS) and found == int(found):
            found = int(found)
        if name in UNITS:
            made["units"][name] = found
        elif name in ("weld_tolerance", "fast", "all_particles"):
            made[name] = found
        elif name != "floor" or found:
            made["settings"][name] = found
    return text(made)
