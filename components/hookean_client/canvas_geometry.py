"""Geometry of Rhino as plain numbers for the service, and back; Grasshopper's trees as branches.

Plain are points [x, y, z], polylines as lists of points, NURBS curves and surfaces and meshes as dicts of lists, all
in the lengths of the document. What cannot be read raises `Unfit` with a sentence. For Python 2.7 to 3.13, Rhino's
classes or rhino3dm's; they are imported when first made.
"""

import json

try:
    TEXT = (str, unicode)
except NameError:  # Python 3
    TEXT = (str,)
NUMBERS = (int, float) if str is not bytes else (int, float, long)  # noqa: F821
PIECES = 200  # straight pieces of a curve where a polyline is needed


class Unfit(Exception):
    """Something that is no such geometry or number, with a sentence."""


def missing(said):
    """An `Unfit` for something that is not there yet, which is no fault."""
    found = Unfit(said)
    found.missing = True
    return found


def value(item):
    """What is inside Grasshopper's own wrapper of an item."""
    while hasattr(item, "ScriptVariable"):
        item = item.ScriptVariable()
    return item


def called(item):
    """What an item is called in a sentence."""
    if isinstance(item, TEXT):
        return "the text %s" % json.dumps(item[:40])
    return "%s %r" % (type(item).__name__, item) if isinstance(item, NUMBERS) else "a %s" % type(item).__name__


def listed(given):
    """Nothing, an item, a list or a tree as a list of items without those that are None."""
    if given is None:
        return []
    if hasattr(given, "Branches") and hasattr(given, "Paths"):
        given = [item for _, items in branches(given) for item in items]
    elif isinstance(given, TEXT + (dict,)) or not hasattr(given, "__iter__") or is_geometry(given):
        given = [given]
    return [value(item) for item in given if item is not None]


def is_geometry(item):
    """Whether an item that could be walked through, such as a Polyline, is one geometry."""
    return any(hasattr(item, name) for name in ("IsValid", "ToPolylineCurve", "Vertices", "ObjectType"))


def is_point(item):
    """Whether it is plain x, y, z."""
    return isinstance(item, (list, tuple)) and len(item) == 3 and all(isinstance(part, NUMBERS) for part in item)


def is_place(item):
    """Whether it is a point: plain, or one of Rhino's."""
    item = value(item)
    return is_point(item) or hasattr(item, "Location") or (hasattr(item, "X") and hasattr(item, "Z"))


def matrix(value):
    """The numbers of a transformation, row by row: of one of Rhino's, or as given."""
    items = listed(value)
    if len(items) == 1 and hasattr(items[0], "ToFloatArray"):
        return [float(item) for item in items[0].ToFloatArray(True)]
    return [number(item) for item in items]


def number(item):
    """A number; text that reads as one is one. Raises `Unfit` for anything else."""
    if isinstance(item, TEXT):
        try:
            item = float(item)
        except ValueError:
            raise Unfit("%s is not a number" % called(item))
    if isinstance(item, bool) or not isinstance(item, NUMBERS):
        try:
            item = float(item)  # .NET's other numbers
        except (TypeError, ValueError):
            raise Unfit("%s is not a number" % called(item))
    if not abs(item) <= 1e12:
        raise Unfit("%r is too large or not a number" % item)
    return item


def point(item):
    """[x, y, z] of a point, vector, plain point or text "{x, y, z}"."""
    item = value(item)
    if hasattr(item, "Location"):  # Point, the geometry
        item = item.Location
    if hasattr(item, "X") and hasattr(item, "Z"):
        return [number(float(item.X)), number(float(item.Y)), number(float(item.Z))]
    parts = item.strip("{}() ").split(",") if isinstance(item, TEXT) else item
    if isinstance(parts, (list, tuple)) and len(parts) == 3:
        return [float(number(part)) for part in parts]
    raise Unfit("%s is not a point; connect points" % called(item))


def points(items):
    """Plain points of points, or of one list of them."""
    return [point(item) for item in listed(items)]


def polyline(item):
    """Corners of a line, polyline or straight curve; None for anything else."""
    item = value(item)
    if isinstance(item, (list, tuple)) and len(item) > 1 and not is_point(item):
        return [point(corner) for corner in item]
    if hasattr(item, "From") and hasattr(item, "To"):
        return [point(item.From), point(item.To)]
    if hasattr(item, "ToPolylineCurve") and not hasattr(item, "TryGetPolyline"):
        return [point(item[i]) for i in range(_count(item))]
    if not hasattr(item, "TryGetPolyline"):
        return None
    if type(item).__name__ == "LineCurve":
        return [point(item.PointAtStart), point(item.PointAtEnd)]
    found = item.TryGetPolyline()  # a Polyline or None; in Rhino a flag and a Polyline
    if isinstance(found, tuple):
        found = found[1] if found[0] else None
    return [point(found[i]) for i in range(_count(found))] if found else None


def lines(items, points=False):
    """Straight lines [start, end] of lines, polylines and edges of meshes, and how many each item gives; with `points`,
    a point is a line that starts and ends there."""
    found, counts = [], []
    for item in listed(items):
        corners = [point(item)] * 2 if points and is_place(item) else polyline(item)
        if corners is not None:
            new = [corners[i : i + 2] for i in range(len(corners) - 1)]
        elif is_mesh(item):
            plain = mesh(item)
            new = [[plain["vertices"][a], plain["vertices"][b]] for a, b in edges(plain["faces"])]
        else:
            raise Unfit("%s is not straight; connect lines, polylines or meshes, or divide it first" % called(item))
        found.extend(new)
        counts.append(len(new))
    return found, counts


def curve(item):
    """A polyline as a list of points, any other curve as its NURBS form: degree, points, knots and weights."""
    corners = polyline(item)
    if corners is not None:
        return corners
    item = value(item)
    if isinstance(item, dict) and "knots" in item:
        return item
    if not hasattr(item, "ToNurbsCurve"):
        raise Unfit("%s is not a curve; connect a curve" % called(item))
    nurbs = item.ToNurbsCurve()
    if nurbs is None:
        raise Unfit("%s has no NURBS form; rebuild it" % called(item))
    controls = [_control(nurbs.Points[i]) for i in range(_count(nurbs.Points))]
    knots = [float(nurbs.Knots[i]) for i in range(_count(nurbs.Knots))]
    return _nurbs({"degree": int(nurbs.Degree), "knots": knots}, controls, [c[:3] for c in controls])


def straight(item):
    """Any curve as a polyline: its corners, or points at even steps of its parameter."""
    corners = polyline(item)
    item = value(item)
    if corners is None and hasattr(item, "PointAt"):
        first, last = float(item.Domain.T0), float(item.Domain.T1)
        steps = [first + (last - first) * i / PIECES for i in range(PIECES)] + [last]
        corners = [point(item.PointAt(step)) for step in steps]
    if corners is None:
        raise Unfit("%s is not a curve; connect a curve" % called(item))
    return corners


def surface(item):
    """A surface as its NURBS form, rows of points along u; a Brep of several or trimmed faces as Rhino encodes it."""
    item = value(item)
    if isinstance(item, dict):
        return item
    if hasattr(item, "Faces") and hasattr(item, "Surfaces"):
        if not getattr(item, "IsSurface", False):
            return encoded(item)
        item = item.Surfaces[0]
    if not hasattr(item, "ToNurbsSurface"):
        if hasattr(item, "ToBrep"):
            return encoded(item.ToBrep())
        raise Unfit("%s is not a surface; connect a surface or Brep" % called(item))
    nurbs = item.ToNurbsSurface()
    rows, columns = int(nurbs.Points.CountU), int(nurbs.Points.CountV)
    controls = [_control(nurbs.Points.GetControlPoint(i, j)) for i in range(rows) for j in range(columns)]
    places = [[control[:3] for control in controls[i * columns : (i + 1) * columns]] for i in range(rows)]
    plain = {"degree_u": int(nurbs.Degree(0)), "degree_v": int(nurbs.Degree(1))}
    for name, knots in (("knots_u", nurbs.KnotsU), ("knots_v", nurbs.KnotsV)):
        plain[name] = [float(knots[i]) for i in range(_count(knots))]
    plain = _nurbs(plain, controls, places)
    if "weights" in plain:
        plain["weights"] = [plain["weights"][i * columns : (i + 1) * columns] for i in range(rows)]
    return plain


def encoded(item):
    """Geometry as Rhino's own text for other programs: version, archive3dm, opennurbs and data."""
    if hasattr(item, "Encode"):  # rhino3dm
        return item.Encode()
    if not hasattr(item, "ToJSON"):
        raise Unfit("%s cannot be sent" % called(item))
    import Rhino

    options = Rhino.FileIO.SerializationOptions()
    options.RhinoVersion = 7
    return json.loads(item.ToJSON(options))


def is_mesh(item):
    """Whether it is a mesh, Rhino's or plain."""
    item = value(item)
    return isinstance(item, dict) and "vertices" in item or hasattr(item, "Vertices") and hasattr(item, "Faces")


def mesh(item):
    """{"vertices": points, "faces": rows of 4; a triangle repeats its last corner}; several meshes become one."""
    vertices, faces = [], []
    for one in listed(item):
        if not is_mesh(one) or hasattr(one, "Surfaces"):
            raise Unfit("%s is not a mesh; connect a mesh" % called(one))
        first = len(vertices)
        if isinstance(one, dict):
            vertices += one["vertices"]
            rows = [list(row) + list(row[-1:]) * (4 - len(row)) for row in one["faces"]]
        else:
            vertices += [[p.X, p.Y, p.Z] for p in one.Vertices.ToPoint3dArray()]
            rows = [_corners(one.Faces[i]) for i in range(_count(one.Faces))]
        faces += [[first + int(corner) for corner in row] for row in rows]
    return {"vertices": vertices, "faces": faces}


def edges(faces):
    """Pairs of vertices, each edge once, in order of first appearance."""
    found, seen = [], set()
    for row in faces:
        for a, b in zip(row, list(row[1:]) + list(row[:1])):
            key = (min(a, b), max(a, b))
            if a != b and key not in seen:
                seen.add(key)
                found.append(key)
    return found


def _corners(face):
    return [face.A, face.B, face.C, face.D] if hasattr(face, "A") else list(face)


def _control(control):
    """x, y, z and weight; rhino3dm gives x, y, z times the weight."""
    if hasattr(control, "Location"):
        return point(control.Location) + [float(control.Weight)]
    return [control.X / control.W, control.Y / control.W, control.Z / control.W, control.W]


def _nurbs(plain, controls, places):
    plain["points"] = places
    if any(control[3] != 1.0 for control in controls):
        plain["weights"] = [control[3] for control in controls]
    return plain


def _count(items):
    return int(items.Count) if hasattr(items, "Count") and not callable(items.Count) else len(items)


def length_unit():
    """The unit of the document in Rhino, None if hookean does not have it."""
    try:
        import Rhino

        name = str(Rhino.RhinoDoc.ActiveDoc.ModelUnitSystem)
    except (ImportError, AttributeError):
        return None
    units = {"Millimeters": "mm", "Centimeters": "cm", "Decimeters": "dm", "Meters": "m", "Kilometers": "km",
             "Inches": "in", "Feet": "ft", "Yards": "yd"}  # fmt: skip
    return units.get(name)


# back to Rhino


def _rhino():
    import Rhino

    return Rhino.Geometry


def to_point(plain):
    """Point3d."""
    return _rhino().Point3d(*[float(part) for part in plain])


def to_vector(plain):
    """Vector3d."""
    return _rhino().Vector3d(*[float(part) for part in plain])


def to_line(plain):
    """Line of [start, end]."""
    return _rhino().Line(to_point(plain[0]), to_point(plain[1]))


def to_polyline(plain):
    """PolylineCurve through points."""
    return _rhino().PolylineCurve(_many(_rhino().Point3d, [to_point(corner) for corner in plain]))


def _many(kind, items):
    """A list as .NET takes it, where there is .NET."""
    try:
        from System.Collections.Generic import List
    except ImportError:
        return items
    found = List[kind]()
    for item in items:
        found.Add(item)
    return found


def to_curve(plain):
    """NurbsCurve of degree, points, knots (the first and the last one may be there too) and weights."""
    places, degree = plain["points"], int(plain["degree"])
    weights = plain.get("weights") or [1.0] * len(places)
    knots = list(plain["knots"])
    if len(knots) == len(places) + degree + 1:
        knots = knots[1:-1]
    made = _rhino().NurbsCurve(3, any(weight != 1.0 for weight in weights), degree + 1, len(places))
    for i, weight in enumerate(weights):
        _put_control(made.Points, i, [float(part) for part in places[i]], float(weight))
    for i, knot in enumerate(knots):
        made.Knots[i] = float(knot)
    return made


def _put_control(controls, i, place, weight):
    if hasattr(controls, "SetPoint"):
        x, y, z = place
        controls.SetPoint(i, x, y, z, weight)  # without the weight in it
    else:
        controls[i] = _rhino().Point4d(place[0] * weight, place[1] * weight, place[2] * weight, weight)


def to_mesh(plain):
    """Mesh in double precision, normals computed."""
    made = _rhino().Mesh()
    made.Vertices.UseDoublePrecisionVertices = True
    add = getattr(made.Vertices, "AddPoint3d", None) or made.Vertices.Add
    for x, y, z in plain["vertices"]:
        add(float(x), float(y), float(z))
    for row in plain["faces"]:
        corners = [int(corner) for corner in row]
        if len(corners) > 3 and corners[3] == corners[2]:
            corners = corners[:3]
        made.Faces.AddFace(*corners)
    made.Normals.ComputeNormals()
    return made


# trees


def branches(given):
    """Pairs of a path as text and the items there; no tree is one branch {0}."""
    if hasattr(given, "Paths") and hasattr(given, "Branch"):
        return [(str(path), list(given.Branch(path))) for path in given.Paths]
    items = listed(given)
    return [("{0}", items)] if items else []


def to_tree(pairs):
    """A DataTree of pairs of a path as text and items; branches without items stay."""
    from Grasshopper import DataTree
    from Grasshopper.Kernel.Data import GH_Path
    import System

    tree = DataTree[System.Object]()
    for path, items in pairs:
        place = GH_Path(*[int(part) for part in path.strip("{}").split(";")])
        tree.EnsurePath(place)
        for item in items:
            tree.Add(item, place)
    return tree


def matched(*lists):
    """Lists matched by the longest: those that are shorter repeat their last value; empty ones stay."""
    longest = max([len(one) for one in lists] or [0])
    return [list(one) + list(one[-1:]) * (longest - len(one)) if one else [] for one in lists]
