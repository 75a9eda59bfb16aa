"""Definitions for Kangaroo of a kind that people make, drawn at random: a net or mesh, goals on it, a solver.

Goals come with the inputs and typed values that public files have them with. What is wired to an input is chosen by the
name of the input, so a goal acts on what it is made for.
"""

from __future__ import annotations

from itertools import pairwise
from random import Random
from typing import Any
from uuid import UUID

from canvas.kangaroo_samples import Inputs, Kangaroo
from hookean_canvas import archive
from hookean_canvas.archive import Type
from hookean_canvas.definitions.write import Made, Output, Wired

GOALS = (
    """
Length(Line)|091bae84-8fa9-4b35-8aad-b25b859055f6|Line=edges;Length;Strength=10.0|Spring
EdgeLengths|24e2b0d2-d7b8-4478-8a83-1f04cba701a1|Mesh=mesh;LengthFactor=1.0;Strength=1.0|EL
Load|580a1a0c-314d-4033-a54c-c129400b4b58|Point=vertices;Force vector=load|Unary
Load|2019c995-53af-4eb2-976d-95b1fdc823fa|Point=vertices;Force vector=load;Weighting=1.0|Unary
Anchor|3c30b1a1-4473-4ad4-a700-ea9770726c03|Point=corners;Target;Strength=10000.0|A
Anchor|b476d3d0-4daf-489c-b91a-49f5dd72a256|Point=corners;Index;Strength=1000.0|A
AnchorXYZ|2128cde3-9694-40b0-874c-670c89341acd|Point=corners;X=True;Y=True;Z=True;Strength=1000.0|A
SphereCollide|4b106d6a-0e09-4edc-941c-27d734ac4d59|Points=vertices;Radius=0.6;Strength=1.0|S
Floor|14ac13f4-c22d-487c-be01-c6daf952f1be|Strength=1.0|Floor
Smooth|0b7b2ba2-7ecd-4f33-b138-883f6e96d08c|M=mesh;Strength=1.0|Smooth
SolidPointCollide|763c5b56-3dc6-4fe0-be7b-6b60cd27f744|
  Points=vertices;Solid=ball;Interior=False;Unidirectional=True;Strength=1.0|S
OnMesh|6c1c3018-487b-4573-afc5-3af263ae5808|Points=corners;Mesh=ball;Strength=1.0|P
OnCurve|8b4dbe32-0c6c-4304-972e-3f60ed613114|Points=rim;Curve=circle;Strength=1.0|P
Angle|f5f95b51-7431-4e80-a32f-d33e5dee53a5|LineA=first;LineB=second;RestAngle=0.0;Strength=1.0|Angle
OnPlane|d4d13384-1914-42ed-b1f2-687c1959bd14|Points=rim;Plane=plane;Strength=1.0|P
Pressure|2e1fb4fb-22a8-4853-a9f5-ab65602aad77|M=mesh;Strength=0.3|Pressure
RigidBody|559ec10e-2671-4bba-b5a7-11816e8fb17b|Part=box;Points=corners;Strength=1.0|RigidBody
RigidBody|e245de5b-6d3b-48d3-8092-3bf0202ebf8f|Part=box;Plane;Points=corners;Strength=10.0|RigidBody,Planes
RigidPointSet|8aa5774d-422a-433b-9a3f-667946bde157|Points=corners;Plane;Strength=10.0|RigidBody,Planes
Collider|94bf912d-4d0c-4764-a100-5813a98a8b73|Objects=edges;Radii=0.05;IgnoreA;IgnoreB;Strength=1.0|Collider
Coincident|c955cf0a-2294-423d-bf1a-fc5cba5d2103|Point0=start;Point1=end;Strength=100.0|Coincident
Hinge|b6b6632e-a164-491a-8874-9a214dcc79bc|
  FoldStart=hinge 1;FoldEnd=hinge 2;Tip1=hinge 3;Tip2=hinge 4;RestAngle=0.0;Strength=0.1|Hinge
NoFoldThrough|8f083dbb-357b-4172-80d0-b584b21b6d75|
  FoldStart=hinge 1;FoldEnd=hinge 2;Tip1=hinge 3;Tip2=hinge 4;Strength=1.0|HingeLimit
TangentIncircles|56e9e40d-6d2f-4daf-9316-034f30cf24a0|
  EdgeStart=hinge 1;EdgeEnd=hinge 2;Tip1=hinge 3;Tip2=hinge 4;Strength=1.0|TangentIncircles
Volume|26efde70-0c5c-4181-af3e-1a767d64b449|Mesh=ball;Volume=number;Strength=0.1|Volume
Planarize|e29cdc8a-b58e-4854-aa1d-f09b43a9b6a3|M=mesh;Strength=1.0|Planarize
PlasticAnchor|c2d6c6db-37d4-4c95-928f-7afc27842a1e|Point=corners;Limit=0.01;Strength=0.001|A
ClampLength|0822cf4a-be2e-4352-aed2-dad197f0611e|Line=edges;LowerLimit=1.0;UpperLimit=999999999.0;Strength=1.0|Clamp
SolidPlaneCollide|81cc6201-6cda-4954-8503-66be5363aac8|
  Solid=box;SolidPlane;CollisionPlane=plane;Strength=3.0|SolidPlaneCollide
EqualLength|537e7b52-4f3e-4bb6-b5f5-98233a66b79d|Line=edges;Strength=0.2|Equal
Wind|928b2951-2a01-4b6b-8ccb-6fbeb3e490ad|Mesh=mesh;WindVector=load|Wind
Direction|6d36a97d-811f-423a-a4a1-35a7a7637697|Line=first;Direction=load;Strength=1.0|Direction
Rod|51cbcf97-8cf9-4f52-9941-a9b484593db2|
  Polyline=polyline;LengthFactor=1.0;AngleFactor=1.0;AxialStrength=1000.0;BendStrength=100.0|R
VertexLoads|2b3f5029-cfec-4f95-96d1-757bd9c51da1|Mesh=mesh;Strength=1.0|L
CyclicQuad|5d81faae-befc-4c12-b558-beaf2ebee8f1|M=mesh;Strength=1.0|Cyclic
CoPlanar|8f78572b-7fd0-4795-b444-3de3ca5933ae|Points=corners;Strength=1.0|Coplanar
Collide2d|4dd9ea95-2ec8-44e3-a772-0e5889d95344|Polylines=loops;Plane=plane;Strength=1.0|C
PolygonArea|f4b4e68f-150f-4c3f-bc52-cf5ec4047f79|Polyline=loop;Area=number;Strength=1.0|A
CurvePointCollide|02b1c69b-b3f7-4528-988e-449a59963e5e|
  Points=vertices;Curve=circle;Plane=plane;Interior=True;Strength=10.0|S
Grab|4c53ba00-f4bd-4ede-8d26-55106278268d|On=True;Strength=1.0;Range=3.0|Grab,Anchors
Show|0ed5e67d-539d-480e-88cb-d81fa795d66c|G=mesh|G
""".strip()
    .replace("\n  ", "")
    .splitlines()
)
"""Name, id, inputs with what is typed or wired, and outputs."""

CLASSIC = (
    """
SpringsFromLine|c5a96f87-dae5-407c-9180-0c0e6ef7ddf9|
  Connection=edges;Stiffness=1000.0;Damping=10.0;Rest Length=0.0;UpperCutoff=0.0;LowerCutoff=0.0;
  Plasticity=0.0|Springs
SpringsFromLine|3ba652e9-f566-441d-8d04-02151edf69b4|
  Connection=edges;Stiffness=1000.0;Damping=10.0;Rest Length=lengths;Cutoff=0.0;Compression Fail=0.0;
  Tensile Fail=0.0;Plasticity=0.0|Springs
UnaryForce|e097cb71-d5d0-4bba-a0d3-a35fae35b384|Point=vertices;Force=load|UnaryForce
""".strip()
    .replace("\n  ", "")
    .splitlines()
)

SOLVERS = (
    """
Solver|8f9f19c0-207a-419d-90f6-2fcadaa845f9|GoalObjects;Reset;Threshold=1e-15;Tolerance=0.01;On=True|I,V,O
Solver|313490f5-8e38-4dde-9e9a-05e4d739b35d|GoalObjects;Reset=False;Threshold=1e-15;Tolerance=0.01;On=True|I,V,O
Solver|a54d250e-e285-4f38-9fb3-8dd9c886c659|
  GoalObjects;Points;Reset;Restart=False;Parallel=True;Threshold=1e-15;Tolerance=0.01;AddCurrent=False;
  On=True|V,O
BouncySolver|0febdb68-70bd-4882-b5e4-f68d1cddc4ae|
  GoalObjects;Reset=False;Threshold=1e-15;Tolerance=0.01;Damping=0.99;Iterations=10;On=True|I,V,O
ZombieSolver|4408343b-577e-4fd8-96ff-df7549189186|GoalObjects;Threshold=1e-10;Tolerance=0.01;MaxIterations=50000|I,V,O
""".strip()
    .replace("\n  ", "")
    .splitlines()
)
PHYSICS = (
    "KangarooPhysics|0db23e16-f91a-4105-3067-8d7ab0c60e4f|Force objects;AnchorPoints;Settings;Geometry;"
    "SimulationReset=True|Out,Iterations,ParticlesOut,GeometryOut,KE"
)
SETTINGS = (
    "Kangaroo Settings|3aee0d21-e730-472d-bbbc-ed14d1d835ed|Tolerance=0.001;TimeStep=0.01;SubIterations=20;Floor=False;"
    "Drag=1.0;Restitution=0.7;StaticFriction=10.0;KineticFriction=10.0;Settle=2.0;Tumble=1.0;Sound=False;Solver=0|Settings"
)


class Drawn(Kangaroo):
    """A definition drawn from a seed; `told` lists its parts."""

    def __init__(self, seed: int, goals: tuple[str, ...] = (), solver: str = "") -> None:
        super().__init__(f"drawn {seed}", f"Drawn {seed}", "A definition drawn at random.")
        self.random = Random(seed)
        self.told: list[str] = []
        self._shapes()
        self.classic = not goals and self.random.random() < 0.2
        if self.classic:
            self._play()
        else:
            self._solve(goals or self._some(), solver or self.random.choice(SOLVERS))

    def _shapes(self) -> None:
        """A mesh of a rectangle with its edges and vertices, and what goals act against."""
        chance = self.random
        size = self._number("Size", 4.0)
        world = self.native("XY Plane", origin=self.point(0, 0, 0))
        rectangle = self.native("Rectangle", plane=world, x_size=size, y_size=size)
        made = self.native("Mesh Plane", boundary=rectangle["Rectangle"], width_count=chance.randint(2, 4),
                           height_count=chance.randint(2, 4))  # fmt: skip
        mesh: Any = made["Mesh"]
        if chance.random() < 0.3:
            mesh = self.native("Triangulate", mesh=mesh)["Mesh"]
        edges, taken = self.native("Mesh Edges", mesh=mesh), self.native("Deconstruct Mesh", mesh=mesh)
        lines = self.native("Merge", data_1=[edges["Naked Edges"], edges["Interior Edges"]])
        corners = self._like("MeshCorners|c8b01cec-6dd9-460b-b43f-254314ffdc2e|Mesh;Angle=2.356|Corners", mesh=mesh)
        naked = self._like(
            "NakedVertices|ddb24b31-1192-448f-ace3-b5b3d2399831|Mesh|ClothedIndex,NakedIndex,ClothedPts,NakedPts",
            mesh=mesh,
        )
        low = self.native("XY Plane", origin=self.point(2, 2, -2))
        row = [self.point(x, 0, 0) for x in (0, 1, 2, 4)]
        first, second = (self.native("Line", start_point=a, end_point=b) for a, b in pairwise(row[:3]))
        one = self._number("Side", 1.0)
        loops = [self.native("Rectangle", plane=self.native("XY Plane", origin=p), x_size=one, y_size=one) for p in row]
        box = self.native("Center Box", base=world, x=1.0, y=1.0, z=1.0)
        self.shapes: dict[str, Any] = {
            "mesh": mesh, "edges": lines, "vertices": taken["Vertices"], "corners": corners["Corners"],
            "rim": naked["NakedPts"], "first": first, "second": second, "start": row[0], "end": row[1],
            "plane": low, "circle": self.native("Circle", plane=self.native("XY Plane", origin=self.point(2, 2, 0)),
                                                radius=3),
            "ball": self.native("Mesh Sphere", base=low, radius=1.5),
            "polyline": self.native("PolyLine", vertices=row), "loops": [one["Rectangle"] for one in loops],
            "loop": loops[0]["Rectangle"], "lengths": self.native("Length", curve=lines),
            "number": self._number("Target", 2.0),
            "load": self.native("Unit Z", factor=self._number("Load", -1.0)),
            "box": self.native("Mesh Box", base=box["Box"], x_count=1, y_count=1, z_count=1),
        }  # fmt: skip
        hinges = self._like("HingePoints|24f82a13-a700-45e0-9528-8646323d4af2|Mesh|1,2,3,4", mesh=mesh)
        self.shapes |= {f"hinge {i}": hinges[str(i)] for i in range(1, 5)}

    def _some(self) -> tuple[str, ...]:
        """Goals with which a shape can come to rest: something elastic, something held, and a few others."""
        chance = self.random
        first = chance.sample(GOALS[:2], 1)
        held = chance.sample(GOALS[4:7], 1)
        return tuple(dict.fromkeys([*first, *held, *chance.sample(GOALS, chance.randint(1, 3))]))

    def _solve(self, goals: tuple[str, ...], solver: str) -> None:
        """Goals of Kangaroo 2 as a stream into a solver."""
        chance = self.random
        self.told = [one.split("|")[0] for one in (*goals, solver)]
        made = [self._goal(one) for one in goals]
        stream: list[Any] = made
        way = chance.random()
        if way < 0.3:
            stream = [self.native("Merge", data_1=made)]
        elif way < 0.6:
            merged = self.parameter("Data", "Goals")
            self._wire(merged, "in", stream)
            stream = [merged]
        wired = {"goalobjects": Wired(tuple(stream), 1)}
        if "Reset" in solver and chance.random() < 0.7:
            wired["reset"] = self.toggle("Reset", chance.random() < 0.5)  # type: ignore[assignment]
        if "On=" in solver and chance.random() < 0.4:
            wired["on"] = self.toggle("On", chance.random() < 0.5)  # type: ignore[assignment]
        with self.group("Kangaroo"):
            engine = self._like(solver, **wired)
        self.panel("particles", engine["V"])
        if chance.random() < 0.5:
            self.panel("shown", engine["O"])

    def _play(self) -> None:
        """Classic forces into KangarooPhysics."""
        chance = self.random
        springs = chance.choice(CLASSIC[:2])
        made = [self._goal(springs, classic=True), self._goal(CLASSIC[2], classic=True)]
        self.told = ["SpringsFromLine", "UnaryForce", "KangarooPhysics"]
        wired: dict[str, Any] = {"force_objects": Wired(tuple(made), 1), "anchorpoints": self.shapes["corners"]}
        if chance.random() < 0.5:
            wired["settings"] = self._like(SETTINGS, classic=True)
        wired["geometry"] = self.shapes[chance.choice(["mesh", "edges"])]
        wired["simulationreset"] = self.toggle("Reset", True)
        engine = self._like(PHYSICS, classic=True, **wired)
        self.timer(engine)
        self.panel("particles", engine["ParticlesOut"])

    def _goal(self, line: str, classic: bool = False) -> Output:
        """A goal with its inputs wired, some of them through a parameter."""
        wired: dict[str, Any] = {}
        for one in line.split("|")[2].split(";"):
            name, _, given = one.partition("=")
            if given in self.shapes:
                shape = self.shapes[given]
                if self.random.random() < 0.15 and not isinstance(shape, list):
                    shape = self.parameter("Data", name, source=shape)
                elif self.random.random() < 0.15 and given in ("vertices", "edges"):
                    shape = Wired((shape,), self.random.choice((1, 2)))
                wired[name.lower().replace(" ", "_")] = shape
            elif name == "Strength" and self.random.random() < 0.3:
                wired["strength"] = self._number("Strength", float(given))
        made = self._like(line, classic, **wired)
        return made[line.split("|")[3].split(",")[0]]

    def _number(self, name: str, value: float) -> Made:
        """A slider, some of them with an expression on it that gives the value."""
        if self.random.random() < 0.3:
            made = self.slider(name, round(value / 2, 4), min(value, 0.0), max(2 * value, 1.0), 4)
            made.container.put("InternalExpression", Type.STRING, "x*2")
            return made
        return self.slider(name, value, min(value, 0.0), max(2 * value, 1.0), 4)

    def _like(self, of: str, classic: bool = False, **wires: Any) -> Made:
        """A component of a line of the tables."""
        name, guid, inputs, outputs = of.split("|")
        parts = (one.partition("=") for one in inputs.split(";"))
        given: Inputs = [(title, _typed(value)) for title, _, value in parts]
        return self.kangaroo(name, given, outputs.split(","), guid=UUID(guid), classic=classic, **wires)


class Varied(Drawn):
    """A definition drawn from a seed, with objects between its shapes and its goals that real ones have: clusters,
    groups, recorders, older versions of components, disabled objects, and objects that only show."""

    def _shapes(self) -> None:
        super()._shapes()
        for key in ("mesh", "edges", "vertices", "corners", "ball", "circle", "load"):
            if self.random.random() < 0.5:
                way = self.random.choice((self._clustered, self._recorded, self._grouped, self._moved, self._older))
                self.shapes[key] = way(key, self.shapes[key])
        if self.random.random() < 0.5:
            self.foreign("Strange Preview", ["G"], g=self.shapes["mesh"]).container.put("Locked", Type.BOOL, True)
        if self.random.random() < 0.5:
            self.native_like("Quick Graph", str(UUID(int=31)), ["Data"], "R", data=self.shapes["lengths"])

    def _clustered(self, key: str, source: Any) -> Any:
        """Through a cluster, some of them with another one in it."""
        document = _handing(key, b"")
        return self.cluster(
            f"Cluster {key}", _handing(key, document) if self.random.random() < 0.5 else document, source
        )

    def _recorded(self, key: str, source: Any) -> Any:
        made = self.parameter("Data", f"Recorder {key}", source=source)
        made.guid = UUID(int=32)
        made.container.put("Name", Type.STRING, "Data Recorder")
        return made

    def _grouped(self, key: str, source: Any) -> Any:
        return self.native("Ungroup", group=self.native("Group", objects=source))

    def _moved(self, key: str, source: Any) -> Any:
        """There and back again, by new natives."""
        if key == "load":
            return source
        motion = self.native("Unit X", factor=3.0)
        there = self.native("Move", geometry=source, motion=motion)
        back = self.native("Inverse Transform", transform=there["Transform"])
        return self.native("Transform", geometry=there["Geometry"], transform=back)

    def _older(self, key: str, source: Any) -> Any:
        made = self.native("Flatten Tree", tree=source)
        made.guid = UUID(int=33)
        return made


def _handing(key: str, nested: bytes) -> bytes:
    """A cluster that hands on what it gets, through another one if there is one."""
    inner = Kangaroo(f"cluster {key}", "Cluster", "It hands on what it gets.")
    given = inner.parameter("Data", "In")
    passed = inner.cluster("Inner", nested, given) if nested else inner.parameter("Data", "Held", source=given)
    last = inner.parameter("Data", "Out", source=passed)
    for made, side in ((given, "Input"), (last, "Output")):
        made.container.items = [item for item in made.container.items if item.name != "Name"]
        made.container.put("Name", Type.STRING, f"Cluster {side}")
    return archive.to_bytes(inner.archive())


def _typed(text: str) -> Any:
    """What is typed into an input: a number, a truth, or nothing where a shape is wired."""
    if text in ("True", "False"):
        return text == "True"
    try:
        return float(text) if "." in text or "e" in text else int(text)
    except ValueError:
        return None
