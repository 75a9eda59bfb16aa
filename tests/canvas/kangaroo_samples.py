"""Definitions with components of Kangaroo, small and made here, with the structure of files that Grasshopper saves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from uuid import UUID, uuid5

from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.guids import CLUSTER
from hookean_canvas.archive.parts import inputs, parts, sources
from hookean_canvas.definitions import containers
from hookean_canvas.definitions.write import Definition, Made
from hookean_canvas.kangaroo.ids import CLASSIC_LIBRARY, COMPONENTS, SECOND_LIBRARY, Known

CLASSIC = "KangarooPhysics"
NAMED = {known: guid for guid, known in reversed(COMPONENTS.items())}
SPRINGS = (
    ("Connection", None), ("Stiffness", 1000.0), ("Damping", 10.0), ("Rest Length", 0.0), ("UpperCutoff", 0.0),
    ("LowerCutoff", 0.0), ("Plasticity", 0.0),
)  # fmt: skip
PHYSICS = (
    ("Force objects", None),
    ("AnchorPoints", None),
    ("Settings", None),
    ("Geometry", None),
    ("SimulationReset", True),
)
PHYSICS_OUT = ("Out", "Iterations", "ParticlesOut", "GeometryOut", "KE")
SETTINGS = (
    ("Tolerance", 0.001), ("TimeStep", 0.01), ("SubIterations", 20), ("Floor", True), ("Drag", 1.0),
    ("Restitution", 0.7),
    ("StaticFriction", 10.0), ("KineticFriction", 10.0), ("Settle", 2.0), ("Tumble", 1.0), ("Sound", False),
    ("Solver", 0),
)  # fmt: skip
SOLVER = (("GoalObjects", None), ("Reset", False), ("Threshold", 1e-15), ("Tolerance", 0.01), ("On", True))
LENGTH = (("Line", None), ("Length", None), ("Strength", 10.0))
ANCHOR = (("P", None), ("T", None), ("Strength", 10000.0))

PLUGIN = UUID("59c7a9a5-5b1c-4d29-92b9-6e0f9d6a7c11")
"""A plug-in of others, made up."""

Inputs = Sequence[tuple[str, Any]]


class Kangaroo(Definition):
    """A definition that may hold components of Kangaroo."""

    def kangaroo(
        self, name: str, inputs: Inputs, outputs: Sequence[str], guid: UUID | None = None, classic: bool = False,
        **wires: Any,
    ) -> Made:  # fmt: skip
        """One of them: inputs with what is typed into them, wires by the inputs' names in lower case with _."""
        id_ = self._id("kangaroo", name)
        chunk = containers.container(id_, name, name, name)
        given: dict[str, tuple[UUID, Chunk]] = {}
        for i, (title, value) in enumerate(inputs):
            port = chunk.add("param_input", i)
            _named(port, uuid5(id_, f"in {i}"), title)
            if value is not None:
                store(port, [value])
            given[title.lower().replace(" ", "_")] = (port.value("InstanceGuid"), port)
        results = {}
        for i, title in enumerate(outputs):
            port = chunk.add("param_output", i)
            _named(port, uuid5(id_, f"out {i}"), title)
            results[title] = (port.value("InstanceGuid"), port)
        library, generation = (CLASSIC_LIBRARY, "classic") if classic else (SECOND_LIBRARY, "second")
        made = Made(
            id_,
            guid or NAMED[Known(generation, name)],
            name,
            chunk,
            given,
            results,
            (120.0, 24.0 + 20.0 * len(inputs)),
            library=library,
        )
        return self._component(made, wires, {})

    def archive(self) -> Chunk:
        """With the libraries of both generations listed."""
        root = super().archive()
        listed = root.chunk("Definition").chunk("GHALibraries")  # type: ignore[union-attr]
        assert listed is not None
        names = {CLASSIC_LIBRARY: "Kangaroo Components", SECOND_LIBRARY: "Kangaroo2 Components"}
        if any(made.library == PLUGIN for made in self._made):
            names[PLUGIN] = "Engineering"
        for id_, name in names.items():
            library = listed.add("Library", len(listed.chunks)).put("Id", Type.GUID, id_).put("Name", Type.STRING, name)
            version = "1.2" if id_ == PLUGIN else ""
            library.put("Author", Type.STRING, "Daniel Piker").put("Version", Type.STRING, version)
        listed.put("Count", Type.INT32, len(listed.chunks))
        return root

    def solved(self, *goals: Any, classic: bool = False, **wires: Any) -> Made:
        """A solver of these goals."""
        if classic:
            return self.kangaroo(
                CLASSIC,
                PHYSICS,
                PHYSICS_OUT,
                classic=True,
                **({"force_objects": list(goals)} if goals else {}),
                **wires,
            )
        return self.kangaroo(
            "Solver", SOLVER, ["I", "V", "O"], **({"goalobjects": list(goals)} if goals else {}), **wires
        )

    def native_like(self, name: str, guid: str, inputs: Sequence[str], output: str, **wires: Any) -> Made:
        """One of Grasshopper's own components by its id, with one output; inputs by their names."""
        made = self.kangaroo(name, [(one, None) for one in inputs], [output], guid=UUID(guid), **wires)
        made.library = None
        return made

    def cluster(self, name: str, document: bytes, *sources: Any) -> Made:
        """A cluster with one input and one output that holds a definition."""
        made = self.native_like(name, str(CLUSTER), ["In"], "Out", **({"in": list(sources)} if sources else {}))
        made.container.put("ClusterDocument", Type.BYTEARRAY, document)
        return made

    def foreign(self, name: str, inputs: Sequence[str] = (), plugin: UUID = PLUGIN, **wires: Any) -> Made:
        """A component of another plug-in, with one output."""
        made = self.kangaroo(name, [(one, None) for one in inputs], ["R"], guid=uuid5(plugin, name), **wires)
        made.library = plugin
        return made

    def springs(self, line: Any, typed: Mapping[str, Any] | None = None, **wires: Any) -> Made:
        """Classic springs; `typed` instead of what Kangaroo types in."""
        given = [(name, (typed or {}).get(name, value)) for name, value in SPRINGS]
        return self.kangaroo("SpringsFromLine", given, ["Springs"], classic=True, connection=line, **wires)

    def timer(self, target: Made) -> UUID:
        """A timer for a component."""
        id_ = self._id("timer", "timer")
        chunk = containers.container(id_, "Timer", "Timer", "A timer")
        chunk.put("Target", Type.GUID, target.id, 0).put("TargetCount", Type.INT32, 1).put(
            "TimerInterval", Type.INT32, 20
        )
        guid = UUID("5a2b0735-ba98-4b7d-a7d3-c1dfc04475ad")
        self._add(Made(id_, guid, "timer", chunk, {}, {"out": (id_, chunk)}, (100.0, 24.0)))
        return id_


def cable(stiffness: float = 1000.0, load: float = -10.0) -> Kangaroo:
    """A classic cable of ten springs of rest length 1 over ten, loads at the points between, held at both ends."""
    d = Kangaroo("cable", "Cable", "A classic cable.")
    first = d.point(d.native("Series", start=0, step=1, count=10), 0, 0)
    second = d.point(d.native("Series", start=1, step=1, count=10), 0, 0)
    line = d.native("Line", start_point=first, end_point=second)
    middle = d.point(d.native("Series", start=1, step=1, count=9), 0, 0)
    ends = d.point(d.native("Series", start=0, step=10, count=2), 0, 0)
    with d.group("Kangaroo"):
        springs = d.springs(line, {"Stiffness": stiffness, "Rest Length": 1.0})
        force = d.native("Unit Z", factor=load)
        vector = (("Point", None), ("Force", (0.0, 50.0, 0.0)))
        loads = d.kangaroo("UnaryForce", vector, ["UnaryForce"], classic=True, point=middle, force=force)
        toggle = d.toggle("Reset", True)
        physics = d.kangaroo(
            CLASSIC, PHYSICS, PHYSICS_OUT, classic=True, force_objects=[springs, loads], anchorpoints=ends,
            geometry=line, simulationreset=toggle,
        )  # fmt: skip
    d.timer(physics)
    d.panel("particles", physics["ParticlesOut"])
    d.panel("geometry", physics["GeometryOut"])
    return d


def star() -> Kangaroo:
    """Three springs of rest length 0 from a free particle to soft anchors, as Kangaroo 2 has them."""
    d = Kangaroo("star", "Star", "The example that kangaroo.py publishes with Kangaroo 2's answer.")
    tips = [d.point(*tip) for tip in ((-1, 1, 0), (1, 0, 0), (0, 2, 0))]
    middle = d.point(0, 0, 0)
    goals = []
    for tip, strength in zip(tips, (3.5355339059327373, 6.0, 2.5), strict=True):
        typed = (("Line", None), ("Length", 0.0), ("Strength", strength))
        line = d.native("Line", start_point=middle, end_point=tip)
        goals.append(d.kangaroo("Length(Line)", typed, ["S"], line=line))
    goals.append(d.kangaroo("Anchor", ANCHOR, ["A"], guid=UUID("3c30b1a1-4473-4ad4-a700-ea9770726c03"), p=tips))
    solver = d.kangaroo("Solver", SOLVER, ["I", "V", "O"], goalobjects=goals, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    d.panel("shown", solver["O"])
    return d


def tent() -> Kangaroo:
    """A Kangaroo 2 definition whose forces, anchors by axes and shown lines come to the solver as one stream."""
    d = Kangaroo("tent", "Tent", "Show, AnchorXYZ and goals through one parameter.")
    ends = [d.point(0, 0, 0), d.point(2, 0, 0)]
    middle = d.point(1, 0, 0)
    lines = [d.native("Line", start_point=end, end_point=middle) for end in ends]
    axes = (("P", None), ("X", True), ("Y", True), ("Z", True), ("Strength", 1000.0))
    goals = [
        d.kangaroo("Show", (("G", None),), ["G"], g=lines),
        d.kangaroo("AnchorXYZ", axes, ["A"], p=ends),
        d.kangaroo("Length(Line)", (("Line", None), ("Length", None), ("Strength", 100.0)), ["S"], line=lines),
        d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, 10.0))), ["U"], p=middle),
    ]
    merged = d.parameter("Data", "Goals", source=None)
    d._wire(merged, "in", goals)
    pause, threshold = d.toggle("On", True), d.slider("Threshold", 1, 0, 5)
    solver = d.kangaroo(
        "Solver",
        SOLVER,
        ["I", "V", "O"],
        goalobjects=merged,
        reset=d.toggle("Reset", False),
        on=pause,
        threshold=threshold,
    )
    d.panel("particles", solver["V"])
    d.panel("shown", solver["O"])
    return d


def in_units(made: Made, *idle: str) -> Made:
    """The outputs of a component moved into evaluation units: those in use into `mesh`, others, unused, into `idle`.

    Laid out as GH_SwitcherComponent.cs and EvaluationUnit.cs of github.com/mariuszhermansdorfer/SandWorm write it.
    """
    container = made.container
    held = [chunk for chunk in container.chunks if chunk.name == "param_output"]
    container.chunks = [chunk for chunk in container.chunks if chunk.name != "param_output"]
    container.add("ActiveUnit").put("unitname", Type.STRING, "mesh")
    units = container.add("EvalUnits").put("count", Type.INT32, 2)
    for number, (name, ports) in enumerate([("idle", []), ("mesh", held)]):
        params = units.add("unit", number).put("name", Type.STRING, name).add("params")
        params.add("input").put("count", Type.INT32, 0).put("index", Type.INT32, 0)
        output = params.add("output").put("count", Type.INT32, len(ports)).put("index", Type.INT32, 0)
        for i, port in enumerate(ports):
            port.name, port.index = "p", i
            output.chunks.append(port)
        for i, title in enumerate(idle if name == "idle" else ()):
            _named(output.add("p", i), uuid5(made.id, f"idle {i}"), title)
        units.chunks[number].add("context")
    return made


def store(port: Chunk, values: Sequence[Any], path: str = "{0}") -> None:
    """Type values into an input, in one branch."""
    port.chunks = [chunk for chunk in port.chunks if chunk.name != "PersistentData"]
    data = port.add("PersistentData").put("Count", Type.INT32, 1)
    branch = data.add("Branch", 0).put("Count", Type.INT32, len(values)).put("Path", Type.STRING, path)
    for i, value in enumerate(values):
        name, type_ = (
            ("boolean", Type.BOOL) if isinstance(value, bool)
            else ("vector", Type.POINT3D) if isinstance(value, tuple)
            else ("number", Type.DOUBLE if isinstance(value, float) else Type.INT32)
        )  # fmt: skip
        branch.add("Item", i).put(name, type_, value)


def wires(root: Chunk) -> set[tuple[UUID, UUID]]:
    """Every wire of a definition that comes from something there: ids of output and input."""
    there = {p.value("InstanceGuid") for part in parts(root) if part.container for p in part.container.walk()}
    there |= {part.id for part in parts(root)}
    return {
        (source, port.value("InstanceGuid"))
        for part in parts(root)
        if part.container
        for port in inputs(part.container)
        for source in sources(port)
        if source in there
    }


def solver_of(root: Chunk) -> str:
    """The solver that the only settings of a translated definition have."""
    panels = {part.id: part.container for part in parts(root)}
    [settings] = [chunk for chunk in panels.values() if chunk is not None and chunk.value("Name") == "Hookean Settings"]
    [given] = [port for port in inputs(settings) if str(port.value("Name")).strip("_") == "solver"]
    panel = panels[sources(given)[0]]
    assert panel is not None
    return str(panel.value("UserText"))


def _named(port: Chunk, id: UUID, name: str) -> None:
    port.put("InstanceGuid", Type.GUID, id).put("Name", Type.STRING, name).put("NickName", Type.STRING, name)
    port.put("Description", Type.STRING, name).put("Optional", Type.BOOL, False).put("SourceCount", Type.INT32, 0)
