"""Small scripts that an import puts before our components where they take other things than Kangaroo's goals.

Formulas of Kangaroo 2 are those of its published goals (github.com/Dan-Piker/K2Goals). Every script runs once for each
branch; those that take whole trees make a branch for each goal.
"""

from __future__ import annotations

from hookean_canvas.definitions.containers import Slot
from hookean_canvas.kangaroo.recipe import Recipe

_POINTS = tuple(Slot(f"point_{i}", f"Point {i} of each pair") for i in (1, 2, 3, 4))
_PAIR = (Slot("_lines", "Lines A", 1), Slot("_others", "Lines B, one for each", 1))
_STRENGTH = Slot("strength_", "Strength in Kangaroo", 1)

_PAIRS = '''"""%s"""

from hookean_client import canvas


def length(v):
    return sum(x * x for x in v) ** 0.5


def numbers(given, usual):
    return [canvas.geometry.number(value) for value in canvas.listed(given)] or [usual]


point_1, point_2, point_3, point_4, strengths = [], [], [], [], []
lines = [canvas.geometry.straight(item) for item in canvas.listed(_lines)]
others = [canvas.geometry.straight(item) for item in canvas.listed(_others)]
'''
_ENDS = """    corners = (one[0], one[-1], other[0], other[-1])
    for points, place in zip((point_1, point_2, point_3, point_4), corners):
        points.append(canvas.geometry.to_point(place))
"""
ENDS = f"""{_PAIRS % "Start and end of line A, start and end of line B, for each pair."}
for one, other in zip(*canvas.matched(lines, others)):
{_ENDS}"""
SNAP = f"""{_PAIRS % "Ends of pairs of lines, and strength / (2 |A + B|), a moment for each angle."}
for one, other, size in zip(*canvas.matched(lines, others, numbers(strength_, 1.0))):
    a, b = ([q - p for p, q in zip(line[0], line[-1])] for line in (one, other))
    together = max(length([p + q for p, q in zip(a, b)]), 0.001 * (length(a) + length(b)))
    strengths.append(0.5 * size / (together or 1.0))
{_ENDS}"""
CLAMP = f"""{_PAIRS % "Ends of pairs of lines, and the moment for each angle at the limit t that is nearer."}
import math

# strength (a b)^1.5 sin(t) / (2 |A + B|), of lines with lengths a and b
limits = numbers(_lower, 0.0), numbers(_upper, math.pi)
for one, other, low, high, size in zip(*canvas.matched(lines, others, *limits, numbers(strength_, 1.0))):
    u, w = ([q - p for p, q in zip(line[0], line[-1])] for line in (one, other))
    a, b = length(u), length(w)
    cosine = sum(p * q for p, q in zip(u, w)) / (a * b or 1.0)
    angle = math.acos(max(-1.0, min(1.0, cosine)))
    limit = low if abs(angle - low) < abs(angle - high) else high
    together = max((a * a + b * b + 2.0 * a * b * math.cos(limit)) ** 0.5, 0.001 * (a + b))
    strengths.append(0.5 * size * (a * b) ** 1.5 * abs(math.sin(limit)) / (together or 1.0))
{_ENDS}"""

_ROWS = '''"""%s"""

from hookean_client import canvas


def goals(*given):
    """Items that belong to one goal, each with a branch of its own."""
    trees = [canvas.geometry.branches(one) for one in given]
    for i, (path, items) in enumerate(trees[0]):
        columns = [[item for item in items if item is not None]]
        for tree in trees[1:]:
            branch = tree[min(i, len(tree) - 1)][1] if tree else []
            columns.append([item for item in branch if item is not None] or [None])
        for j, row in enumerate(zip(*canvas.matched(*columns)) if columns[0] else ()):
            yield path.replace("}", ";%%d}" %% j), row


def numbered(item, usual):
    return usual if item is None else canvas.geometry.number(item)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def length(v):
    return sum(x * x for x in v) ** 0.5


def between(a, b):
    return [q - p for p, q in zip(a, b)]


def sizes(plain):
    """Volume and area of a mesh."""
    volume, area = 0.0, 0.0
    for a, b, c, d in plain["faces"]:
        for corners in ((a, b, c), (a, c, d)):
            p, q, r = (plain["vertices"][corner] for corner in corners)
            normal = cross(between(p, q), between(p, r))
            volume += sum(x * y for x, y in zip(p, normal)) / 6.0
            area += length(normal) / 2.0
    return abs(volume), area


found = []
'''
VOLUME = f"""{_ROWS % "Bulk moduli, 6 x strength x volume / area, and the volumes that meshes are to have."}
for path, (item, volume, strength) in goals(_mesh, volume_, strength_):
    now, area = sizes(canvas.geometry.mesh(item))
    target = numbered(volume, now)
    found.append((path, item, 6.0 * numbered(strength, 1.0) * target / (area or 1.0), target / (now or 1.0)))
meshes, stiffness, factors = (canvas.geometry.to_tree([(row[0], [row[i]]) for row in found]) for i in (1, 2, 3))
"""
GAS = f"""{_ROWS % "Pressures of gas in meshes, K x volume at rest / volume, and K around them."}
for path, (item, volume, strength) in goals(_mesh, volume_, strength_):
    now, area = sizes(canvas.geometry.mesh(item))
    size = numbered(strength, 1.0)
    found.append((path, item, size * numbered(volume, now) / (now or 1.0), size))
meshes, pressures, outside = (canvas.geometry.to_tree([(row[0], [row[i]]) for row in found]) for i in (1, 2, 3))
"""
POLYGON = f"""{_ROWS % "Edges of polygons, stiffness 2 x strength x area x edges / length^2, areas they are to have."}
for path, (item, area, strength) in goals(_polyline, area_, strength_):
    corners = canvas.geometry.straight(item)
    closed = corners if length(between(corners[0], corners[-1])) < 1e-9 else corners + corners[:1]
    edges = list(zip(closed, closed[1:]))
    turns = [cross(a, b) for a, b in edges]
    now = length([sum(column) for column in zip(*turns)]) / 2.0
    target, around = numbered(area, now), sum(length(between(a, b)) for a, b in edges)
    stiffness = 2.0 * numbered(strength, 1.0) * target * len(edges) / (around ** 2 or 1.0)
    lines = [canvas.geometry.to_line([a, b]) for a, b in edges]
    found.append((path, lines, [stiffness], [target / (now or 1.0)]))
lines, stiffness, factors = (canvas.geometry.to_tree([(row[0], row[i]) for row in found]) for i in (1, 2, 3))
"""
FILM = '''"""One mesh of all triangles of the same strength; a branch of points is a triangle."""

from hookean_client import canvas

branches, strengths = canvas.geometry.branches(_points), canvas.geometry.branches(strength_)
films, order = {}, []
for i, (_, items) in enumerate(branches):
    typed = canvas.listed(strengths[min(i, len(strengths) - 1)][1]) if strengths else []
    size = canvas.geometry.number(typed[0]) if typed else 1.0
    if size not in films:
        films[size] = {"vertices": [], "faces": [], "known": {}}
        order.append(size)
    film, corners = films[size], []
    for place in canvas.geometry.points(items)[:3]:
        if tuple(place) not in film["known"]:
            film["known"][tuple(place)] = len(film["vertices"])
            film["vertices"].append(place)
        corners.append(film["known"][tuple(place)])
    if len(corners) == 3:
        film["faces"].append(corners + corners[-1:])
paths = ["{%d}" % i for i in range(len(order))]
meshes = canvas.geometry.to_tree([(path, [canvas.geometry.to_mesh(films[s])]) for path, s in zip(paths, order)])
tensions = canvas.geometry.to_tree([(path, [s]) for path, s in zip(paths, order)])
'''
FACES = '''"""One mesh of triangles, or of quads, by their corners; equal points are one vertex."""

from hookean_client import canvas

vertices, faces, known = [], [], {}
given = [canvas.geometry.points(one) for one in (_corner_1, _corner_2, _corner_3)]
last = canvas.geometry.points(corner_4_)
for row in zip(*canvas.matched(*(given + ([last] if last else [])))):
    corners = []
    for place in row:
        if tuple(place) not in known:
            known[tuple(place)] = len(vertices)
            vertices.append(place)
        corners.append(known[tuple(place)])
    faces.append(corners + corners[-1:] * (4 - len(corners)))
mesh = canvas.geometry.to_mesh({"vertices": vertices, "faces": faces}) if faces else None
'''
FAN = '''"""A mesh of triangles round each centre, from neighbour to neighbour."""

from hookean_client import canvas

centres, neighbours = canvas.geometry.points(_centre), canvas.geometry.points(_neighbours)
vertices, faces = [], []
for centre in centres:
    first, count = len(vertices), len(neighbours)
    vertices += [centre] + neighbours
    for i in range(count):
        corners = [first, first + 1 + i, first + 1 + (i + 1) % count]
        faces.append(corners + corners[-1:])
mesh = canvas.geometry.to_mesh({"vertices": vertices, "faces": faces}) if faces else None
words = ["uniform", "cotangent", "inverse_length"]
weights = [words[int(canvas.geometry.number(value)) % 3] for value in canvas.listed(weighting_)][:1]
'''
SIZE = '''"""The length of each vector, times a factor."""

from hookean_client import canvas

vectors = canvas.geometry.points(_vectors)
factors = [canvas.geometry.number(value) for value in canvas.listed(factors_)] or [1.0]
sizes = [sum(x * x for x in v) ** 0.5 * factor for v, factor in zip(*canvas.matched(vectors, factors))]
'''
AXIS = '''"""Vectors from points to points, and the points halfway."""

from hookean_client import canvas

pairs = list(zip(*canvas.matched(canvas.geometry.points(_start), canvas.geometry.points(_end))))
vectors = [canvas.geometry.to_vector([q - p for p, q in zip(a, b)]) for a, b in pairs]
middles = [canvas.geometry.to_point([0.5 * (p + q) for p, q in zip(a, b)]) for a, b in pairs]
'''
NEGATIVE = '''"""Each number with the other sign."""

from hookean_client import canvas

negative = [-canvas.geometry.number(value) for value in canvas.listed(_numbers)]
'''
INDEXED = '''"""Points of a list by their numbers in it; what is a point already stays."""

from hookean_client import canvas

points = canvas.geometry.points(_points)
given, chosen = canvas.listed(_places), canvas.listed(indices_)


def at(item):
    try:
        number = int(canvas.geometry.number(item))
    except canvas.Unfit:
        return canvas.geometry.point(item)
    if not 0 <= number < len(points):
        raise ValueError("there is no point %d; the solver has %d points" % (number, len(points)))
    return points[number]


places = [canvas.geometry.to_point(at(item)) for item in chosen or given]
targets = [canvas.geometry.to_point(at(item)) for item in given] or places
'''
_JOINED = """    for points, place, frame in zip(columns, places, [frame_a] * %d + [frame_b] * %d):
        points.append(canvas.geometry.to_point(place))
        if frame is not None:
            carriers.append(frame.Origin)
            carried.append(points[-1])
"""
_MATCHED = """carriers, carried = [], []
given = [canvas.listed(planes_) or [None], canvas.listed(planes_of_others_) or [None]]
for one, other, frame_a, frame_b in zip(*canvas.matched(canvas.listed(%s), canvas.listed(_others), *given)):
"""
MATES = f'''"""Three corners of each of two faces: of their outlines, or round the origins of their planes."""

from hookean_client import canvas


def corners(face, frame):
    """Where a plane is given, in it, counter-clockwise, as far from its origin as that is from the body's frame."""
    if not hasattr(face, "XAxis"):
        return canvas.geometry.straight(face)[:3]
    o, x, y = ([v.X, v.Y, v.Z] for v in (face.Origin, face.XAxis, face.YAxis))
    at = [frame.Origin.X, frame.Origin.Y, frame.Origin.Z] if frame is not None else o
    size = sum((p - q) ** 2 for p, q in zip(o, at)) ** 0.5 or 1.0
    ways = (1.0, 0.0), (-0.5, 0.75**0.5), (-0.5, -(0.75**0.5))
    return [[p + size * (c * u + s * v) for p, u, v in zip(o, x, y)] for c, s in ways]


columns = point_1, point_2, point_3, point_4, point_5, point_6 = [], [], [], [], [], []
{_MATCHED % "_faces"}    places = corners(one, frame_a) + corners(other, frame_b)
{_JOINED % (3, 3)}'''
AXLES = f'''"""Start and end of each of two axes."""

from hookean_client import canvas

columns = point_1, point_2, point_3, point_4 = [], [], [], []
{_MATCHED % "_lines"}    one, other = canvas.geometry.straight(one), canvas.geometry.straight(other)
    places = one[0], one[-1], other[0], other[-1]
{_JOINED % (2, 2)}'''
_PLANES = (
    Slot("planes_", "Planes of their bodies", 1, "plane"),
    Slot("planes_of_others_", "Planes of the bodies of others", 1, "plane"),
)
_CARRIED = (Slot("carriers", "Origins of the planes"), Slot("carried", "Points that move with these"))

HELPERS = {
    "*mates": Recipe(
        "Mates",
        "Mates",
        "Corners of pairs of faces",
        MATES,
        (Slot("_faces", "Planes or outlines of faces", 1), Slot("_others", "Others, one for each", 1), *_PLANES),
        (*(Slot(f"point_{i}", f"Point {i} of each pair") for i in (1, 2, 3, 4, 5, 6)), *_CARRIED),
    ),
    "*axles": Recipe(
        "Axles",
        "Axles",
        "Ends of pairs of axes",
        AXLES,
        (Slot("_lines", "Axes", 1), Slot("_others", "Axes, one for each", 1), *_PLANES),
        (*_POINTS, *_CARRIED),
    ),
    "*ends": Recipe("Ends", "Ends", "Ends of pairs of lines", ENDS, _PAIR, _POINTS),
    "*snap": Recipe(
        "Snap Strengths",
        "Snap",
        "Ends of pairs of lines, and moments",
        SNAP,
        (*_PAIR, _STRENGTH),
        (*_POINTS, Slot("strengths", "Moments for each angle")),
    ),
    "*clamp": Recipe(
        "Clamp Strengths",
        "Clamp",
        "Ends of pairs of lines, and moments",
        CLAMP,
        (*_PAIR, Slot("_lower", "Least angles", 1), Slot("_upper", "Greatest angles", 1), _STRENGTH),
        (*_POINTS, Slot("strengths", "Moments for each angle")),
    ),
    "*volume": Recipe(
        "Volumes",
        "Volumes",
        "Bulk moduli for meshes",
        VOLUME,
        (Slot("_mesh", "Meshes", 2), Slot("volume_", "Volumes", 2), Slot("strength_", "Strengths in Kangaroo", 2)),
        (Slot("meshes", "Meshes"), Slot("stiffness", "Bulk moduli"), Slot("factors", "Factors on the volumes")),
    ),
    "*gas": Recipe(
        "Gases",
        "Gases",
        "Pressures of gas in meshes",
        GAS,
        (Slot("_mesh", "Meshes", 2), Slot("volume_", "Volumes", 2), Slot("strength_", "K in Kangaroo", 2)),
        (Slot("meshes", "Meshes"), Slot("pressures", "Pressures inside"), Slot("outside", "Pressures outside")),
    ),
    "*polygon": Recipe(
        "Polygons",
        "Polygons",
        "Edges and stiffness of polygons",
        POLYGON,
        (Slot("_polyline", "Polylines", 2), Slot("area_", "Areas", 2), Slot("strength_", "Strengths in Kangaroo", 2)),
        (Slot("lines", "Edges"), Slot("stiffness", "Stiffness"), Slot("factors", "Factors on the areas")),
    ),
    "*film": Recipe(
        "Film",
        "Film",
        "Meshes of triangles",
        FILM,
        (Slot("_points", "Three points in each branch", 2), Slot("strength_", "Tensions", 2)),
        (Slot("meshes", "Meshes"), Slot("tensions", "Tensions")),
    ),
    "*faces": Recipe(
        "Faces",
        "Faces",
        "A mesh of faces",
        FACES,
        tuple(Slot(name, "Corners", 1, "point") for name in ("_corner_1", "_corner_2", "_corner_3", "corner_4_")),
        (Slot("mesh", "A mesh"),),
    ),
    "*fan": Recipe(
        "Fan",
        "Fan",
        "A mesh round a point",
        FAN,
        (
            Slot("_centre", "Points", 1, "point"),
            Slot("_neighbours", "Points round it", 1, "point"),
            Slot("weighting_", "0, 1 or 2", 1),
        ),
        (Slot("mesh", "A mesh"), Slot("weights", "Weights of the neighbours, in a word")),
    ),
    "*size": Recipe(
        "Sizes",
        "Sizes",
        "Lengths of vectors",
        SIZE,
        (Slot("_vectors", "Vectors", 1, "vector"), Slot("factors_", "Factors", 1)),
        (Slot("sizes", "Lengths"),),
    ),
    "*axis": Recipe(
        "Axes",
        "Axes",
        "Vectors from points to points",
        AXIS,
        (Slot("_start", "Points", 1, "point"), Slot("_end", "Points", 1, "point")),
        (Slot("vectors", "Vectors"), Slot("middles", "Points halfway")),
    ),
    "*negative": Recipe(
        "Negative",
        "Negative",
        "Numbers with the other sign",
        NEGATIVE,
        (Slot("_numbers", "Numbers", 1),),
        (Slot("negative", "Numbers"),),
    ),
    "*indexed": Recipe(
        "Points by Number",
        "By Number",
        "Points of the solver by their numbers",
        INDEXED,
        (
            Slot("_points", "Points of the solver", 1, "point"),
            Slot("_places", "Points, or their numbers", 1),
            Slot("indices_", "Numbers, where the points are targets", 1),
        ),
        (Slot("places", "Points"), Slot("targets", "Targets")),
    ),
}
TOLD = {
    "*mates": "a script for corners",
    "*axles": "a script for ends",
    "*ends": "a script for ends",
    "*snap": "a script for ends and moments",
    "*clamp": "a script for ends and moments",
    "*volume": "a script for volumes",
    "*gas": "a script for pressures",
    "*polygon": "a script for edges",
    "*film": "a script for a mesh",
    "*faces": "a script for a mesh",
    "*fan": "a script for a mesh",
    "*size": "a script for sizes",
    "*axis": "a script for vectors",
    "*negative": "a script for signs",
    "*indexed": "a script for points by number",
}
"""What helpers are called in the table of the documentation."""
