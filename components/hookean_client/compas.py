"""COMPAS structures as parts of a scene, and what was found as the same structures, relaxed.

    parts = compas.scene([mesh], [compas.springs(mesh, stiffness="ea")], [compas.anchors(mesh)])
    [found] = compas.relaxed([mesh], client.relax(parts))
    found.edges_attribute("force"), found.vertices_attribute("reaction")

A structure is a Mesh, a Graph (a Network before COMPAS 2), a Line, a Polyline, a Polygon, a Pointcloud or a Point.
For Python 2.7 to 3.13; compas itself is imported only to make a structure. What fails raises `Problem`.
"""

from __future__ import absolute_import, division

import base64
import json
import math
import struct

from hookean_client import Problem, buffer

SUPPORTS = ("is_support", "is_anchor", "is_fixed")
"""Attributes of vertices that are held, where any of them is true."""
LOADS = ("px", "py", "pz")
"""Attributes of vertices with the components of a load [force]."""
TOLERANCE = 0.001
try:
    TEXT = (str, unicode)
except NameError:
    TEXT = (str,)


def kind(structure):
    """`mesh`, `graph`, `line`, `polyline`, `polygon`, `points` or `point`; Problem for anything else."""
    if hasattr(structure, "face_vertices") and hasattr(structure, "vertices"):
        return "mesh"
    if hasattr(structure, "node_coordinates"):
        return "graph"
    names = [base.__name__.lower() for base in type(structure).__mro__]
    for name in ("line", "polyline", "polygon"):
        if name in names:
            return name
    if hasattr(structure, "points"):
        return "points"
    if all(hasattr(structure, axis) for axis in "xyz"):
        return "point"
    said = "A COMPAS Mesh, Graph, Line, Polyline, Polygon, Pointcloud or Point is expected, not %s."
    raise _fault(said % ("nothing" if structure is None else type(structure).__name__))


def keys(structure):
    """The keys of its vertices or nodes in their order; of geometry 0, 1, ..."""
    what = kind(structure)
    if what == "mesh":
        return list(structure.vertices())
    return list(structure.nodes()) if what == "graph" else list(range(len(points(structure))))


def points(structure):
    """Rows x, y, z [length] in the order of its keys."""
    what = kind(structure)
    if what == "mesh":
        found = [structure.vertex_coordinates(key) for key in structure.vertices()]
    elif what == "graph":
        found = [[structure.node_attribute(key, axis) for axis in "xyz"] for key in structure.nodes()]
    elif what == "line":
        found = [structure.start, structure.end]
    else:
        found = [structure] if what == "point" else structure.points
    rows = [[float(c) for c in point] for point in found]
    for key, row in zip(keys(structure) if what in ("mesh", "graph") else range(len(rows)), rows):
        if any(math.isnan(c) or math.isinf(c) for c in row):
            raise _fault("Vertex %s of the %s is not at finite coordinates; move or remove it." % (key, what))
    return rows


def edges(structure):
    """Pairs of keys: edges of a mesh or graph in their order, segments of a line, polyline or polygon."""
    what = kind(structure)
    if what in ("mesh", "graph"):
        return [tuple(edge) for edge in structure.edges()]
    count = len(points(structure)) if what in ("line", "polyline", "polygon") else 0
    found = [(i, i + 1) for i in range(count - 1)]
    return found + [(count - 1, 0)] if what == "polygon" and count > 2 else found


def faces(structure):
    """Rows of keys: the faces of a mesh; none of anything else."""
    if kind(structure) != "mesh":
        return []
    return [list(structure.face_vertices(face)) for face in structure.faces()]


def supports(structure, names=SUPPORTS):
    """Keys of the vertices where one of the attributes `names` is true; all of a structure without attributes."""
    if not _has_attributes(structure):
        return keys(structure)
    return [key for key in keys(structure) if any(_vertex(structure, key, name) for name in names)]


def springs(structure, name="", **columns):
    """A force: springs on its edges. A column is a number, a list of one for each edge, or the name of an attribute
    of edges: stiffness [force/length], rest_length [length], rest_factor [-], and all that springs have."""
    ends = edges(structure)
    if not ends:
        raise _fault("The %s has no edges; springs need at least one." % kind(structure))
    place = dict(zip(keys(structure), points(structure)))
    force = {"kind": "springs", "lines": buffer([[place[a], place[b]] for a, b in ends])}
    for column, value in columns.items():
        if isinstance(value, TEXT):
            value = [_of_edge(structure, edge, value) for edge in ends]
        if value is not None:
            force[column] = _column(column, value, len(ends), "edge")
    return dict(force, name=name) if name else force


def load(structure, vector=None, at=None, name=""):
    """A force: `vector` [force], one or one for each, at the keys `at` (none: at all); without a vector the
    attributes px, py, pz [force] of its vertices."""
    chosen = _chosen(structure, at)
    if vector is None:
        rows = [[float(_vertex(structure, key, axis) or 0.0) for axis in LOADS] for key in chosen]
        chosen = [key for key, row in zip(chosen, rows) if any(row)]
        rows = [row for row in rows if any(row)]
        if not rows:
            raise _fault("No vertex has a load in px, py, pz [force]; set one of them, or give a vector.")
    else:
        rows = _vectors(vector, len(chosen))
    place = dict(zip(keys(structure), points(structure)))
    force = {"kind": "unary", "points": buffer([place[key] for key in chosen]), "vector": buffer(rows)}
    return dict(force, name=name) if name else force


def anchors(structure, at=None, targets=None, axes="xyz", name=""):
    """Anchors at the keys `at` (none: where is_support, is_anchor or is_fixed is true), held where they are or at
    `targets` [length]."""
    chosen = supports(structure) if at is None else _chosen(structure, at)
    if not chosen:
        said = "No vertex is held: set %s of some vertices to True, or give their keys."
        raise _fault(said % " or ".join(SUPPORTS))
    place = dict(zip(keys(structure), points(structure)))
    anchor = {"points": buffer([place[key] for key in chosen]), "axes": axes}
    if targets is not None:
        rows = [[float(c) for c in row] for row in targets]
        if len(rows) != len(chosen) or any(len(row) != 3 for row in rows):
            raise _fault("%d targets x, y, z given for %d anchors; give one for each." % (len(rows), len(chosen)))
        anchor["targets"] = buffer(rows)
    return dict(anchor, name=name) if name else anchor


def scene(structures, forces, anchors=(), settings=None, units=None, tolerance=TOLERANCE):
    """The scene of these structures, forces and anchors; vertices within `tolerance` [length] are one particle."""
    particles, _ = numbers(structures, tolerance)
    found = {"forces": list(forces), "anchors": list(anchors), "weld_tolerance": tolerance}
    if particles:
        found["particles"] = buffer(particles)
    for name, value in (("settings", settings), ("units", units)):
        if value:
            found[name] = value
    return found


def numbers(structures, tolerance=TOLERANCE):
    """The places of all vertices, each once, and for every structure the number of the place of each of its keys."""
    places, cells, found = [], {}, []
    for structure in structures:
        index = {}
        for key, point in zip(keys(structure), points(structure)):
            cell = tuple(c // tolerance for c in point)
            near = [n for c in _around(cell) for n in cells.get(c, ())]
            near = [n for n in near if _distance(places[n], point) <= tolerance]
            if not near:
                near = [len(places)]
                cells.setdefault(cell, []).append(len(places))
                places.append(point)
            index[key] = min(near)
        found.append(index)
    return places, found


def relaxed(structures, result, tolerance=TOLERANCE):
    """Copies of the structures in the shape of the result of their `scene`.

    Edges of a mesh or graph get `force` [force] (tension +), `length` [length] and `strain` [-] where springs act;
    vertices `reaction` [force], three numbers, zero where nothing is held; the structure `status`, `message` and
    `residual` [-].
    """
    at = values(result["particles"])
    tension, held = _of_springs(result), _of_reactions(result)
    _, found = numbers(structures, tolerance)
    return [_relaxed(s, index, at, tension, held, result) for s, index in zip(structures, found)]


def values(array):
    """Rows or numbers of an array of a result, whether a list or a buffer."""
    if not isinstance(array, dict):
        return array
    raw, shape = base64.b64decode(array["base64"]), array["shape"]
    code, size = {"<f8": ("d", 8), "<i8": ("q", 8), "<f4": ("f", 4), "<i4": ("i", 4)}[array["dtype"]]
    flat = list(struct.unpack("<%d%s" % (len(raw) // size, code), raw))
    for width in reversed(shape[1:]):
        flat = [flat[i : i + width] for i in range(0, len(flat), width)] if width else [[] for _ in range(shape[0])]
    return flat


def document(structure):
    """The structure as COMPAS writes it to JSON, as plain data: what the service reads where geometry is expected."""
    from compas import json_dumps

    kind(structure)
    return json.loads(json_dumps(structure))


def to_mesh(vertices, faces, name=""):
    """A COMPAS Mesh of rows x, y, z [length] and rows of positions in them."""
    from compas.datastructures import Mesh

    mesh = Mesh.from_vertices_and_faces([list(v) for v in vertices], [list(f) for f in faces])
    mesh.name = name or mesh.name
    return mesh


def to_graph(lines, name="", tolerance=TOLERANCE):
    """A COMPAS Graph of pairs of ends [length]; ends within `tolerance` are one node, in order of appearance."""
    try:
        from compas.datastructures import Graph
    except ImportError:  # COMPAS 1
        from compas.datastructures import Network as Graph
    places, [index] = numbers([_Ends(lines)], tolerance)
    graph = Graph()
    for i, (x, y, z) in enumerate(places):
        graph.add_node(i, x=x, y=y, z=z)
    for i in range(0, len(index), 2):
        a, b = index[i], index[i + 1]
        if a != b and not graph.has_edge((a, b)) and not graph.has_edge((b, a)):
            graph.add_edge(a, b)
    graph.name = name or graph.name
    return graph


class _Ends(object):
    def __init__(self, lines):
        self.points = [end for line in lines for end in line]


def _relaxed(structure, index, at, tension, held, result):
    what = kind(structure)
    moved = [[float(c) for c in at[index[key]]] for key in keys(structure)]
    if what in ("mesh", "graph"):
        found = structure.copy()
        _set_vertices(found, index, moved, held)
        _set_edges(found, index, tension)
        found.attributes.update((name, result.get(name)) for name in ("status", "message", "residual"))
        return found
    if what == "line":
        return type(structure)(*moved)
    return type(structure)(*moved[0]) if what == "point" else type(structure)(moved)


def _set_vertices(structure, index, moved, held):
    mesh = kind(structure) == "mesh"
    attribute = structure.vertex_attribute if mesh else structure.node_attribute
    for key, row in zip(keys(structure), moved):
        for axis, value in zip("xyz", row):
            attribute(key, axis, value)
        attribute(key, "reaction", list(held.get(index[key], (0.0, 0.0, 0.0))))


def _set_edges(structure, index, tension):
    for edge in edges(structure):
        found = tension.get(_pair(index[edge[0]], index[edge[1]]), {})
        for name, value in found.items():
            structure.edge_attribute(edge, name, value)


def _of_springs(result):
    """Force, length and strain by pair of particles; forces of springs side by side are added."""
    found = {}
    for force in result["forces"]:
        if not isinstance(force, dict) or "length" not in force or "strain" not in force:
            continue
        columns = [values(force[name]) for name in ("particles", "force", "length", "strain")]
        for (a, b), tension, length, strain in zip(*columns):
            told = found.setdefault(_pair(a, b), {"force": 0.0, "length": length, "strain": strain})
            told["force"] += tension
    return found


def _of_reactions(result):
    told = result["reactions"]
    return dict(zip(values(told["particles"]), values(told["force"])))


def _chosen(structure, at):
    """The keys `at`, all of which the structure has; None: all."""
    known = keys(structure)
    if at is None:
        return known
    lookup = {str(key): key for key in known}
    chosen = []
    for key in at:
        if str(key) not in lookup:
            told = "its %d keys are %s to %s" % (len(known), known[0], known[-1]) if known else "it has none"
            raise _fault("%s is not a vertex of the %s; %s." % (key, kind(structure), told))
        chosen.append(lookup[str(key)])
    return chosen


def _has_attributes(structure):
    return kind(structure) in ("mesh", "graph")


def _vertex(structure, key, name):
    if not _has_attributes(structure):
        return None
    return structure.vertex_attribute(key, name) if kind(structure) == "mesh" else structure.node_attribute(key, name)


def _of_edge(structure, edge, name):
    value = structure.edge_attribute(edge, name) if _has_attributes(structure) else None
    if value is None:
        raise _fault('Edge %s has no attribute "%s"; set it for all edges, or give a number.' % (edge, name))
    return float(value)


def _column(name, value, count, element):
    if not hasattr(value, "__len__"):
        return value
    if len(value) == 1:
        return value[0]
    if len(value) != count:
        said = "%s has %d values for %d %ss; give one value, or one for each %s."
        raise _fault(said % (name, len(value), count, element, element))
    return buffer([float(v) for v in value])


def _vectors(vector, count):
    rows = list(vector)
    rows = rows if rows and hasattr(rows[0], "__len__") else [rows]
    rows = [[float(c) for c in row] for row in rows]
    if any(len(row) != 3 for row in rows) or len(rows) not in (1, count):
        raise _fault("%d vectors given for %d vertices; give one, or one for each." % (len(rows), count))
    return rows * count if len(rows) == 1 else rows


def _around(cell):
    x, y, z = cell
    return [(x + i, y + j, z + k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]


def _distance(a, b):
    return math.sqrt(sum((p - q) ** 2 for p, q in zip(a, b)))


def _pair(a, b):
    return (a, b) if a < b else (b, a)


def _fault(sentence):
    return Problem("invalid-input", sentence)
