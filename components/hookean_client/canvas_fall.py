"""Free fall: a form that nothing holds, under loads that do not cancel. For Python 2.7 to 3.13."""

from .canvas_packed import unpacked

HOLDING = (
    "anchor_spring", "support", "pull_to_curve", "pull_to_mesh", "pull_to_surface", "pull_to_plane", "pull_to_line",
    "level_set", "collide_solid", "collide_curve", "solid_plane_collide",
)  # fmt: skip
"""These hold particles, or may come to hold them."""
ROUNDING = 1e-6  # of the sizes of the loads: what rounding leaves of a sum that is zero


def sentence(scene, unmatched=()):
    """Why a scene that the service has taken falls freely, or None; `unmatched`: numbers of anchors without particle.

    It falls along x, y or z where nothing is held in that direction and the loads F of all forces do not cancel there:
    |sum F| > `ROUNDING` x sum |F|. A floor holds what the loads press onto it. Whatever holds a part of the form counts
    as holding all of it.
    """
    free = [axis for axis in "xyz" if axis not in _held(scene, set(unmatched))]
    if not free:
        return None
    total, size = _loads(scene)
    if any(sum(a * b for a, b in zip(normal, total)) < 0.0 for normal in _floors(scene)):
        return None
    falling = [axis for axis, part in zip("xyz", total) if axis in free and abs(part) > ROUNDING * size]
    if not falling:
        return None
    said = (
        "The form is unsupported in %s, and its loads do not cancel there: it falls. Connect anchors, or a force that "
    )
    return (said + "holds it: Anchor Spring, Pull To Curve, Pull To Mesh or Floor.") % " and ".join(falling)


def unmatched(report):
    """The numbers of the anchors that meet no particle, from the report of a result."""
    parts = [one["pointer"].split("/") for one in report["unmatched"]]
    return [int(names[2]) for names in parts if names[1] == "anchors"]


def _held(scene, lost):
    """The directions in which something holds the form."""
    if any(one["kind"] in HOLDING for one in scene["forces"]):
        return "xyz"
    axes = [one.get("axes") or "xyz" for i, one in enumerate(scene.get("anchors") or []) if i not in lost]
    return "".join("".join(one) for one in axes)


def _floors(scene):
    """The normals of all floors."""
    found = [unpacked(one.get("normal")) or (0.0, 0.0, 1.0) for one in scene["forces"] if one["kind"] == "floor"]
    return found + ([(0.0, 0.0, 1.0)] if (scene.get("settings") or {}).get("floor") else [])


def _loads(scene):
    """The sum of the loads as they are at the start, [x, y, z] [force], and the sum of their sizes [force]."""
    total, size = [0.0, 0.0, 0.0], 0.0
    for one in scene["forces"]:
        for vector, times in _LOADS[one["kind"]](scene, one) if one["kind"] in _LOADS else ():
            for axis in range(3):
                total[axis] += times * vector[axis]
            size += times * _size(vector)
    return total, size


def _unary(scene, one):
    vectors = unpacked(one.get("vector")) or [0.0, 0.0, 0.0]
    if isinstance(vectors[0], (list, tuple)):
        return [(vector, 1.0) for vector in vectors]
    places = unpacked(one.get("points")) or unpacked(one.get("particles"))
    return [(vectors, float(len(places if places is not None else _mesh(scene, one)[0])))]


def _self_weight(scene, one):
    """The weight, or 1 where the lengths of its lines are not known here."""
    direction = unpacked(one.get("direction")) or [0.0, 0.0, -1.0]
    weights, lines = unpacked(one.get("per_length")), unpacked(one.get("lines"))
    if one.get("total") is not None:
        weight = float(one["total"])
    elif lines:
        each = weights if isinstance(weights, list) else [weights] * len(lines)
        weight = sum(w * _size([b - a for a, b in zip(*line)]) for w, line in zip(each, lines))
    else:
        weight = 1.0 if any(weights if isinstance(weights, list) else [weights]) else 0.0
    return [(direction, weight / (_size(direction) or 1.0))]


def _pressure(scene, one):
    """p times the areas of the faces as vectors: of the triangles (a, b, c) of a fan half of (b - a) x (c - a)."""
    pressure, found = float(one.get("pressure", 1.0)), []
    vertices, faces = _mesh(scene, one)
    for face in faces:
        spokes = [[p - q for p, q in zip(vertices[i], vertices[face[0]])] for i in face[1:]]
        rows = [_cross(spokes[i - 1], spokes[i]) for i in range(1, len(spokes))]
        found.append(([0.5 * pressure * sum(row[axis] for row in rows) for axis in range(3)], 1.0))
    return found


_LOADS = {"unary": _unary, "self_weight": _self_weight, "pressure": _pressure}


def _mesh(scene, one):
    """Vertices and faces of the mesh of a force; none where it has none."""
    found = unpacked((scene.get("meshes") or {}).get(one.get("mesh"))) or {}
    return found.get("vertices") or [], found.get("faces") or []


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _size(vector):
    return sum(part * part for part in vector) ** 0.5
