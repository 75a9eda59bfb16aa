"""Stand-ins of what component code meets inside Rhino and Grasshopper, where there is neither.

    made = stand_in.Canvas()  # or Canvas(rhino3dm), whose classes then are Rhino.Geometry
    made.install()
    ghenv = stand_in.Environment(stand_in.Component("Engine", inputs=["_forces"]))

Geometry only carries its numbers: points, lines, polylines, NURBS curves and surfaces, meshes. Members are named and
behave as in McNeel's documentation of RhinoCommon and the Grasshopper SDK, no more than components use. This file is
alone: standard library, Python 2.7 to 3.13, and can be loaded by its path.
"""

import sys
import types
import uuid


class _Kind(type):
    """A class that may be written with a type in brackets, such as DataTree[object]."""

    def __getitem__(cls, item):
        return cls


_Generic = _Kind("_Generic", (object,), {})


class Point3d(object):
    """Coordinates X, Y, Z."""

    IsValid = True

    def __init__(self, X=0.0, Y=0.0, Z=0.0):
        self.X, self.Y, self.Z = float(X), float(Y), float(Z)

    def __eq__(self, other):
        return type(other) is type(self) and (self.X, self.Y, self.Z) == (other.X, other.Y, other.Z)

    def __ne__(self, other):
        return not self == other

    def __hash__(self):
        return hash((self.X, self.Y, self.Z))

    def __repr__(self):
        return "%s(%r, %r, %r)" % (type(self).__name__, self.X, self.Y, self.Z)

    def DistanceTo(self, other):
        """Distance to another point."""
        return ((self.X - other.X) ** 2 + (self.Y - other.Y) ** 2 + (self.Z - other.Z) ** 2) ** 0.5


class Vector3d(Point3d):
    """Components X, Y, Z."""

    @property
    def Length(self):
        """Its length."""
        return (self.X**2 + self.Y**2 + self.Z**2) ** 0.5


class Interval(object):
    """From T0 to T1."""

    def __init__(self, T0, T1):
        self.T0, self.T1 = T0, T1


class Line(object):
    """A straight line between two points."""

    IsValid = True

    def __init__(self, start, end):
        self.From, self.To = start, end

    @property
    def Length(self):
        """Its length."""
        return self.From.DistanceTo(self.To)

    def PointAt(self, t):
        """The point at a parameter from 0 to 1."""
        return _mixed(self.From, self.To, t)


class Polyline(list):
    """Corners, a list of points."""

    IsValid = True

    @property
    def Count(self):
        """How many corners."""
        return len(self)

    def ToPolylineCurve(self):
        """The same as a curve."""
        return PolylineCurve(self)


class PolylineCurve(object):
    """A curve of straight pieces."""

    IsValid = True

    def __init__(self, corners):
        self._corners = Polyline(corners)
        self.Domain = Interval(0.0, float(len(self._corners) - 1))

    def TryGetPolyline(self):
        """Whether it is one, and which: what .NET gives back through an out parameter."""
        return True, Polyline(self._corners)

    @property
    def PointAtStart(self):
        """Its first point."""
        return self._corners[0]

    @property
    def PointAtEnd(self):
        """Its last point."""
        return self._corners[-1]

    def PointAt(self, t):
        """The point at a parameter; whole ones are corners."""
        i = max(0, min(int(t), len(self._corners) - 2))
        return _mixed(self._corners[i], self._corners[i + 1], t - i)


class LineCurve(PolylineCurve):
    """A line as a curve."""

    def __init__(self, start, end=None):
        PolylineCurve.__init__(self, [start.From, start.To] if end is None else [start, end])

    @property
    def Line(self):
        """The same as a line."""
        return Line(*self._corners)


def _mixed(a, b, t):
    return Point3d(a.X + t * (b.X - a.X), a.Y + t * (b.Y - a.Y), a.Z + t * (b.Z - a.Z))


class ControlPoint(object):
    """A control point: where it is, without its weight, and its weight."""

    def __init__(self, Location, Weight=1.0):
        self.Location, self.Weight = Location, Weight


class _Controls(list):
    Count = property(len)

    def SetPoint(self, i, x, y, z, weight=1.0):
        """Put one somewhere."""
        self[i] = ControlPoint(Point3d(x, y, z), weight)
        return True


class NurbsCurve(object):
    """A NURBS curve; the first and the last knot are left out, as in Rhino."""

    IsValid = True

    def __init__(self, dimension, rational, order, count):
        self.IsRational, self.Order, self.Degree = rational, order, order - 1
        self.Points = _Controls(ControlPoint(Point3d()) for _ in range(count))
        self.Knots = [0.0] * (count + order - 2)

    def ToNurbsCurve(self):
        """Itself."""
        return self

    def TryGetPolyline(self):
        """Whether it is one, and which."""
        straight = self.Degree == 1
        return straight, Polyline([one.Location for one in self.Points]) if straight else None

    @property
    def Domain(self):
        """Its parameters."""
        return Interval(self.Knots[self.Degree - 1], self.Knots[len(self.Points) - 1])

    def PointAt(self, t):
        """The point at a parameter, by de Boor's algorithm."""
        p, knots = self.Degree, self.Knots[:1] + list(self.Knots) + self.Knots[-1:]
        k = p
        while k < len(self.Points) - 1 and knots[k + 1] <= t:
            k += 1
        rows = []
        for one in self.Points[k - p : k + 1]:
            place, w = one.Location, one.Weight
            rows.append([place.X * w, place.Y * w, place.Z * w, w])
        for r in range(1, p + 1):
            for j in range(p, r - 1, -1):
                low, high = knots[j + k - p], knots[j + 1 + k - r]
                f = (t - low) / (high - low)
                rows[j] = [(1.0 - f) * a + f * b for a, b in zip(rows[j - 1], rows[j])]
        return Point3d(*[part / rows[p][3] for part in rows[p][:3]])


class _Grid(object):
    def __init__(self, u, v):
        self.CountU, self.CountV = u, v
        self._rows = [[ControlPoint(Point3d()) for _ in range(v)] for _ in range(u)]

    def GetControlPoint(self, i, j):
        """One of them."""
        return self._rows[i][j]

    def SetPoint(self, i, j, x, y, z, weight=1.0):
        """Put one somewhere."""
        self._rows[i][j] = ControlPoint(Point3d(x, y, z), weight)
        return True


class NurbsSurface(object):
    """A NURBS surface."""

    IsValid = True

    def __init__(self, dimension, rational, order_u, order_v, u, v):
        self.OrderU, self.OrderV = order_u, order_v
        self.Points = _Grid(u, v)
        self.KnotsU, self.KnotsV = [0.0] * (u + order_u - 2), [0.0] * (v + order_v - 2)

    Create = classmethod(lambda cls, *parts: cls(*parts))

    def ToNurbsSurface(self):
        """Itself."""
        return self

    def Degree(self, direction):
        """The degree along one direction."""
        return (self.OrderV if direction else self.OrderU) - 1


class MeshFace(object):
    """Corners A, B, C, D; a triangle's D is its C."""

    def __init__(self, A, B, C, D=None):
        self.A, self.B, self.C, self.D = A, B, C, C if D is None else D

    @property
    def IsTriangle(self):
        """Whether it has three corners."""
        return self.C == self.D


class _Vertices(list):
    UseDoublePrecisionVertices = False
    Count = property(len)

    def Add(self, x, y=None, z=None):
        """One more vertex."""
        self.append(x if y is None else Point3d(x, y, z))
        return len(self) - 1

    def ToPoint3dArray(self):
        """All of them."""
        return list(self)

    def Point3dAt(self, i):
        """One of them."""
        return self[i]


class _Faces(list):
    Count = property(len)

    def AddFace(self, a, b=None, c=None, d=None):
        """One more face."""
        self.append(a if b is None else MeshFace(a, b, c, d))
        return len(self) - 1


class _Normals(list):
    def ComputeNormals(self):
        """Nothing is drawn here."""
        return True


class Mesh(object):
    """Vertices and faces of three or four of them."""

    IsValid = True

    def __init__(self):
        self.Vertices, self.Faces, self.Normals = _Vertices(), _Faces(), _Normals()


class Color(object):
    """System.Drawing.Color."""

    def __init__(self, A, R, G, B):
        self.A, self.R, self.G, self.B = A, R, G, B

    @classmethod
    def FromArgb(cls, *parts):
        """Of red, green, blue, or of opacity and these."""
        return cls(*((255,) + parts if len(parts) == 3 else parts))


class Plane(object):
    """An origin and a normal."""

    def __init__(self, origin, normal):
        self.Origin, self.Normal = origin, normal


class PointStyle(object):
    """How a point is drawn."""

    X = "X"


class CustomDisplay(object):
    """Rhino.Display.CustomDisplay: what is drawn, in lists."""

    def __init__(self, enable):
        self.Enabled = enable
        self.Clear()

    def Clear(self):
        """Take all away."""
        self.lines, self.points, self.texts = [], [], []

    def Dispose(self):
        """The end of it."""
        self.Clear()

    def AddLine(self, line, color, thickness):
        """A line."""
        self.lines.append((line, color))

    def AddPoint(self, point, color, style, radius):
        """A point."""
        self.points.append((point, color))

    def AddText(self, text, plane, size, color):
        """A text in a plane."""
        self.texts.append((text, color))


# Grasshopper


class GH_Path(object):
    """A path of a tree."""

    def __init__(self, *indices):
        self.Indices = tuple(int(i) for i in indices)

    def __str__(self):
        return "{%s}" % ";".join(str(i) for i in self.Indices)

    __repr__ = __str__

    def __eq__(self, other):
        return str(self) == str(other)

    def __ne__(self, other):
        return not self == other

    def __hash__(self):
        return hash(str(self))


class DataTree(_Generic):
    """Lists of items by paths, which are kept in their order."""

    def __init__(self):
        self._items = {}  # lists by paths: trees of thousands of branches are filled item by item

    @property
    def Paths(self):
        """Its paths, sorted as Grasshopper does."""
        return sorted(self._items, key=lambda path: path.Indices)

    @property
    def Branches(self):
        """Its lists in the order of the paths."""
        return [self._items[path] for path in self.Paths]

    @property
    def BranchCount(self):
        """How many paths."""
        return len(self._items)

    @property
    def DataCount(self):
        """How many items."""
        return sum(len(items) for items in self._items.values())

    def Branch(self, *path):
        """The list of a path, or of a number of one."""
        if len(path) == 1 and isinstance(path[0], int):
            path = (self.Paths[path[0]],)
        return self._items[path[0] if isinstance(path[0], GH_Path) else GH_Path(*path)]

    def EnsurePath(self, *path):
        """Add a path without items, unless it is there; returns it."""
        wanted = path[0] if isinstance(path[0], GH_Path) else GH_Path(*path)
        self._items.setdefault(wanted, [])
        return wanted

    def Add(self, item, path=None):
        """Put an item at the end of a path."""
        self._items[self.EnsurePath(path or GH_Path(0))].append(item)

    def AddRange(self, items, path=None):
        """Put items at the end of a path, which is made if it is new and there are items."""
        given = list(items)
        if given:
            self._items[self.EnsurePath(path or GH_Path(0))].extend(given)

    def AllData(self):
        """All items."""
        return [item for items in self.Branches for item in items]


class GH_RuntimeMessageLevel(object):
    """How bad a message is."""

    Blank, Remark, Warning, Error = "Blank", "Remark", "Warning", "Error"


class GH_Document(object):
    """The document's class, for its type of callback."""

    @staticmethod
    def GH_ScheduleDelegate(callback):
        """The callback."""
        return callback


class Document(GH_Document):
    """A definition: its id, its file and what it was asked to solve again, as (milliseconds, callback)."""

    _count = 0

    def __init__(self, path=None, identity=None):
        Document._count += 1
        self.RuntimeID = Document._count
        self.DocumentID = identity or uuid.uuid4()
        self.FilePath = path
        self.scheduled = []

    def ScheduleSolution(self, milliseconds, callback=None):
        """Ask for a solution."""
        self.scheduled.append((milliseconds, callback))


class Parameter(object):
    """An input or output: its names, and what it is wired to."""

    def __init__(self, name, sources=()):
        self.Name = self.NickName = name
        self.Sources, self.Recipients = list(sources), []
        self.InstanceGuid = uuid.uuid4()
        self.VolatileData = None


class _Parameters(object):
    def __init__(self, inputs, outputs):
        self.Input = [Parameter(name) for name in inputs]
        self.Output = [Parameter(name) for name in outputs]


class Component(object):
    """A component; `messages` are (level, text) of this solution, `expired` counts how often it was made to solve."""

    def __init__(self, name, nickname=None, inputs=(), outputs=(), guid=None, document=None):
        self.Name, self.NickName, self.Message = name, nickname or name, ""
        self.Params, self.InstanceGuid = _Parameters(inputs, outputs), guid or uuid.uuid4()
        self.RunCount, self.Hidden, self.Locked = 1, False, False
        self.messages, self.expired, self.document = [], 0, document

    def AddRuntimeMessage(self, level, text):
        """A message on it."""
        self.messages.append((level, text))

    def RuntimeMessages(self, level):
        """The messages of a level on it."""
        return [text for known, text in self.messages if known == level]

    def OnPingDocument(self):
        """The document it is in."""
        return self.document

    def ExpireSolution(self, recompute):
        """It has to be solved again."""
        self.expired += 1


class Environment(object):
    """`ghenv` of a component."""

    def __init__(self, component):
        self.Component = component


GEOMETRY = (Point3d, Vector3d, Interval, Line, Polyline, PolylineCurve, LineCurve, ControlPoint, NurbsCurve,
            NurbsSurface, MeshFace, Mesh, Plane)  # fmt: skip


class Canvas(object):
    """The modules that component code imports, with the classes of this file or another module as Rhino.Geometry."""

    def __init__(self, geometry=None):
        names = ("Rhino", "Rhino.Geometry", "Rhino.Display", "Grasshopper", "Grasshopper.Kernel",
                 "Grasshopper.Kernel.Data", "System", "System.Drawing")  # fmt: skip
        self.modules = {name: types.ModuleType(str(name)) for name in names}
        self._before = {}
        if geometry is not None:
            self.modules["Rhino.Geometry"] = geometry
        for kind in GEOMETRY if geometry is None else ():
            setattr(self.modules["Rhino.Geometry"], kind.__name__, kind)
        self.modules["Grasshopper"].DataTree = DataTree
        self.modules["Grasshopper.Kernel.Data"].GH_Path = GH_Path
        self.modules["Grasshopper.Kernel"].GH_RuntimeMessageLevel = GH_RuntimeMessageLevel
        self.modules["Grasshopper.Kernel"].GH_Document = GH_Document
        self.modules["System"].Object, self.modules["System"].Guid = object, uuid.UUID
        self.modules["System"].Exception = Exception
        self.modules["System.Drawing"].Color = Color
        self.modules["Rhino.Display"].CustomDisplay, self.modules["Rhino.Display"].PointStyle = (
            CustomDisplay,
            PointStyle,
        )
        for name, module in self.modules.items():
            above, _, last = name.rpartition(".")
            if above:
                setattr(self.modules[above], last, module)

    def install(self):
        """Put them where `import` finds them."""
        self._before = {name: sys.modules.get(name) for name in self.modules}
        sys.modules.update(self.modules)
        return self

    def remove(self):
        """Take them away again."""
        for name, module in self._before.items():
            if module is None:
                sys.modules.pop(name, None)
            else:
                sys.modules[name] = module
