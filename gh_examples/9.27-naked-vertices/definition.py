"""Figure 9.27 on the canvas: a membrane held at its naked vertices, and the same one held at drawn points."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.27-naked-vertices").scene)

NUMBERS = """
points = [membrane.Vertices.Point3dAt(i) for i in range(len(membrane.Vertices))]
lifts = [reaction.Z for reaction in reactions.Branch(0)]
held = len(lifts)
middle = -points[len(points) // 2].Z
deepest = -min(p.Z for p in points)
largest = max(forces.Branch(0))
upward = sum(lifts)
inside = sum(z for z, p in zip(lifts, anchors) if (p.X - 5.0) ** 2 + (p.Y - 5.0) ** 2 < 10.0) / upward
"""
NAMES = {
    "held": "particles held", "middle": "sag in the middle", "deepest": "deepest sag", "largest": "largest force",
    "upward": "upward reactions together",
}  # fmt: skip


def definition() -> Definition:
    d = Definition(
        "9.27-naked-vertices",
        "Figure 9.27: held along its rim, and at corners and points inside",
        "A surface drawn in Rhino as a net of 20 x 20 cells, 20 N down on every particle. One engine holds the naked "
        "vertices of the mesh, the other one the points that are drawn.",
    )
    with d.group("Drawn in Rhino", "Layers of model.3dm beside this file."):
        file, mesh = parts.surface(d, GIVEN, 40)
        points = d.component("RhinoFile", file=file, layer=d.text("Points that are held", "anchors"))
        naked = d.component("NakedVertices", mesh=mesh)
        vertices = d.component("MeshVertices", mesh=mesh)
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [N/m]", GIVEN["stiffness"], 10, 5000)
        springs = d.component("Springs", connection=mesh, stiffness=stiffness)
        load = d.component("Unary", point=vertices, force=parts.down(d, GIVEN))
    with d.group("Settings"):
        settings = parts.solving(d, "relaxation", "1e-11")
        reset = d.toggle("Reset", True)
    for which, anchors in (("rim", naked["naked_points"]), ("points", points["points"])):
        with d.group(f"Held: {which}"):
            engine = d.component(
                "Engine", f"Engine {which}", forces=flat(springs, load), anchors=flat(anchors), settings=settings,
                geometry=mesh, reset=reset,
            )  # fmt: skip
            names = {variable: f"{which}: {name}" for variable, name in NAMES.items()}
            if which == "points":
                names["inside"] = "points: part of the load on the four inside"
            given = {"membrane": engine["geometry"], "forces": engine["forces"], "reactions": engine["reactions"]}
            trees = ["forces", "reactions"]
            d.numbers(NUMBERS, {**given, "anchors": anchors}, names, lists=["anchors"], trees=trees)
    return d
