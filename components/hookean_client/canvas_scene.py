"""What travels from component to component as JSON text, and the scene that the engine makes of it.

A force is {"kind": "springs", "source": ..., and its fields}, arrays as buffers; anchors and settings likewise. For
Python 2.7 to 3.13.
"""

import hashlib
import json

from . import canvas_geometry as geometry
from . import canvas_link as link
from .canvas_geometry import Unfit, listed, matched

PLACES = ("lines", "points", "mesh", "particles")
EVERYWHERE = ("self_weight", "impulse")  # without a place they act on all particles
SHARED = ("control_points", "charges", "charge", "corners", "image", "path")  # rows of numbers as text
SURFACE = ("degree_u", "degree_v", "knots_u", "knots_v", "weights")
FIXED = PLACES + SHARED + SURFACE + ("kind", "edges", "name", "curve", "closed", "target", "vertices", "faces")
WHOLE = ("sub_iterations", "max_iterations")
SOLVERS = ("verlet", "yoshida", "momentum", "relaxation", "newton", "force_density")
UNITS = ("length", "force", "time")
WELD = 0.001  # the service's own distance at which points merge


def missing(said):
    """An `Unfit` for something that is not there yet, which is no fault."""
    found = Unfit(said)
    found.missing = True
    return found


def text(value):
    """A value as it travels, the same for the same value."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"))


# made by components


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
        return text(link.packed(made))
    items = _rows(kind, fields[place[0]], place[0])
    names = sorted(lists)
    rows = matched(items, *[lists[name] for name in names])
    if place == ["lines"]:
        made["lines"], spread = geometry.lines(rows[0])
    else:
        made[place[0]] = rows[0]
    for name, values, given in zip(names, rows[1:], [lists[name] for name in names]):
        if len(given) > 1 and spread is not None:
            values = [value for value, times in zip(values, spread) for _ in range(times)]
        made[name] = values if name == "targets" else _single(values if len(given) > 1 else given)
    return text(link.packed(made))


def _empty(value):
    return all(_empty(one) for one in value) if isinstance(value, tuple) else not listed(value)


def _columns(kind, fields):
    """Values of all fields that are no places, as lists."""
    found = {}
    for name, value in fields.items():
        if name not in PLACES + ("target", "curve") + SHARED:
            try:
                found[name] = [_value(item) for item in listed(value)]
            except Unfit as unfit:
                raise Unfit("%s, %s: %s" % (kind, name, unfit))
            if any(isinstance(one, (bool, str)) for one in found[name]):
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


def _value(item):
    """A number, a flag, a word or a vector."""
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
    flags = [[bool(_value(item)) for item in listed(axis)] or [True] for axis in axes]
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
            found = _value(items[0])
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


# read by the engine


def read(given, kinds, what):
    """Values of texts; `kinds`: None for forces, else the one kind that is taken. `Unfit` where one is something
    else."""
    found = []
    for item in listed(given):
        try:
            value = json.loads(item)
            kind = value["kind"]
        except (TypeError, ValueError, KeyError):
            raise Unfit(
                "%s: %s is not a hookean object; connect the output of a hookean component"
                % (what, geometry.called(item))
            )
        if (kind in ("anchors", "settings")) if kinds is None else kind != kinds:
            raise Unfit("%s: %s are connected here; they belong to another input" % (what, kind))
        found.append(value)
    return found


def compose(forces, anchors, setting, carried, lengths=None):
    """The scene of forces (as `read` gives them), anchors {"name", "point", "target", "axes"}, one settings or None
    and geometry that rides along; `lengths`: the document's unit, unless settings have another."""
    meshes, made = {}, []

    def shared(mesh):
        name = "mesh-" + hashlib.sha1(text(mesh).encode("ascii")).hexdigest()[:12]
        meshes[name] = mesh
        return name

    for one in forces:
        if one["kind"] == "grab":  # nothing drags where nothing plays
            continue
        entry = {name: value for name, value in one.items() if name != "source"}
        entry["name"] = str(one.get("name") or one["source"]["title"])
        if "mesh" in entry:
            entry["mesh"] = shared(entry["mesh"])
        made.append(entry)
    rides = [dict(one, mesh=shared(link.packed(one["mesh"]))) if "mesh" in one else dict(one) for one in carried]
    setting = setting or {"units": {}, "settings": {}}
    scene = {"forces": made, "geometry": rides, "meshes": meshes, "settings": setting["settings"]}
    scene["strict"] = False  # people drag points: what meets no particle is a warning on the component
    scene["units"] = dict({"length": lengths} if lengths else {}, **setting["units"])
    if "weld_tolerance" in setting:
        scene["weld_tolerance"] = setting["weld_tolerance"]
    if setting.get("all_particles"):
        scene["particles"] = distinct(spots(scene), float(setting.get("weld_tolerance", WELD)))
    scene["anchors"] = [
        {"name": one["name"], "points": [one["home"]], "targets": [one["target"]], "axes": one["axes"]}
        for one in anchors
    ]
    return scene


def structure(scene):
    """What cannot be patched, as text: two scenes of the same structure differ in numbers only."""
    forces = [{name: value if name in FIXED else None for name, value in one.items()} for one in scene["forces"]]
    anchors = [dict(one, targets=None) for one in scene["anchors"]]
    left = {name: value if name == "floor" else None for name, value in scene["settings"].items()}
    return text(dict(scene, forces=forces, anchors=anchors, settings=left))


def places(scene):
    """Where the forces act, as text."""
    return text([[one.get(name) for name in FIXED] for one in scene["forces"]] + [sorted(scene["meshes"])])


def spots(scene):
    """Every coordinate that the forces of a scene act on."""
    found = []
    for one in scene["forces"]:
        vertices = scene["meshes"][one["mesh"]]["vertices"] if "mesh" in one else []
        for rows in (one.get("points"), one.get("lines"), vertices):
            rows = link.unpacked(rows) or []
            while rows and isinstance(rows[0][0], (list, tuple)):
                rows = [row for several in rows for row in several]
            found.extend(rows)
    return found


def distinct(points, tolerance):
    """Points without those that are within the tolerance of one before."""
    size, cells, found = max(8.0 * tolerance, 1e-12), {}, []
    for place in points:
        ranges = [range(int((x - tolerance) // size), int((x + tolerance) // size) + 1) for x in place]
        keys = [(i, j, k) for i in ranges[0] for j in ranges[1] for k in ranges[2]]
        near = (other for key in keys for other in cells.get(key, ()))
        if not any(sum((p - q) ** 2 for p, q in zip(place, other)) <= tolerance**2 for other in near):
            cells.setdefault(tuple(int(x // size) for x in place), []).append(place)
            found.append(place)
    return found


def patch(old, new):
    """The edit that leads from a scene to another one of the same structure; {} where they are the same."""
    edit = {}
    moves = [
        {"anchor": after["name"], "targets": after["targets"]}
        for before, after in zip(old["anchors"], new["anchors"])
        if before["targets"] != after["targets"]
    ]
    forces = {}
    for i, (before, after) in enumerate(zip(old["forces"], new["forces"])):
        changed = {name: value for name, value in after.items() if before[name] != value}
        if changed:
            forces[str(i)] = changed
    setting = {name: value for name, value in new["settings"].items() if old["settings"][name] != value}
    for name, value in (("move", moves), ("forces", forces), ("settings", setting)):
        if value:
            edit[name] = value
    return edit


def ride(item):
    """The entry of a scene for geometry that rides along, and what makes geometry again of its moved points."""
    item = geometry.value(item)
    if geometry.is_mesh(item) and not hasattr(item, "Surfaces"):
        plain = geometry.mesh(item)
        return {"kind": "mesh", "mesh": plain}, lambda moved: geometry.to_mesh(dict(plain, vertices=moved))
    if hasattr(item, "Location") or (hasattr(item, "X") and hasattr(item, "Z")) or geometry.is_point(item):
        return {"kind": "points", "points": [geometry.point(item)]}, lambda moved: geometry.to_point(moved[0])
    try:
        plain = geometry.curve(item)
    except Unfit:
        said = "geometry: %s cannot be carried along; connect points, curves or meshes" % geometry.called(item)
        raise Unfit(said)
    if isinstance(plain, dict):
        return dict(plain, kind="curve"), lambda moved: geometry.to_curve(dict(plain, points=moved))
    if hasattr(item, "From"):
        return {"kind": "lines", "lines": [plain]}, geometry.to_line
    return {"kind": "polyline", "points": plain}, geometry.to_polyline
