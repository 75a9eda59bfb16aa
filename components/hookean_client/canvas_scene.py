"""The scene that the engine makes of what components give it, and the edits that lead from one to another. For Python
2.7 to 3.13."""

import hashlib
import json

from . import canvas_geometry as geometry
from .canvas_geometry import Unfit, listed
from .canvas_items import PLACES, SHARED, text
from .canvas_packed import packed, unpacked

SURFACE = ("degree_u", "degree_v", "knots_u", "knots_v", "weights")
FIXED = PLACES + SHARED + SURFACE + ("kind", "edges", "name", "curve", "closed", "target", "vertices", "faces")
WELD = 0.001  # the service's own distance at which points merge


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
    rides = [dict(one, mesh=shared(packed(one["mesh"]))) if "mesh" in one else dict(one) for one in carried]
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
            rows = unpacked(rows) or []
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
