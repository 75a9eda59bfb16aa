"""Figure 9.26 on the canvas: a membrane whose corners are led up and down while it runs."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("9.26-membrane-anchors-moved").scene)

NUMBERS = """
start = [drawn.Vertices.Point3dAt(i) for i in range(len(drawn.Vertices))]
end = [membrane.Vertices.Point3dAt(i) for i in range(len(membrane.Vertices))]
centre = min(range(len(start)), key=lambda i: (start[i].X - 5.0) ** 2 + (start[i].Y - 5.0) ** 2)
springs = forces.Branch(0)
lifts = [reaction.Z for reaction in reactions.Branch(0)]
middle = end[centre].Z
largest = max(springs)
smallest = min(springs)
carried = sum(lifts[:2])
all_carried = sum(lifts)
highest = max(p.Z for p in end)
"""


def definition() -> Definition:
    d = Definition(
        "9.26-membrane-anchors-moved",
        "Figure 9.26: a membrane's corners are moved while it runs",
        "A surface drawn in Rhino as a net of 20 x 20 cells, 20 N down on every particle. "
        "Set Reset to False, then pull the corners up and down with the two sliders: an anchor takes its "
        "particle along.",
    )
    with d.group("Drawn in Rhino", "Layers of model.3dm beside this file."):
        file, mesh = parts.surface(d, GIVEN, 40)
        rising = d.component("RhinoFile", file=file, layer=d.text("Corners that rise", "rising"))
        sinking = d.component("RhinoFile", file=file, layer=d.text("Corners that sink", "sinking"))
        points = d.component("MeshVertices", mesh=mesh)
    with d.group("Forces"):
        springs = d.component(
            "Springs", connection=mesh, stiffness=d.slider("Stiffness [N/m]", GIVEN["stiffness"], 10, 5000),
            rest_factor=d.slider("Rest factor [-]", GIVEN["rest_factor"], 0, 1.2, decimals=2),
        )  # fmt: skip
        weight = d.component("Unary", point=points, force=parts.down(d, GIVEN))
    with d.group("Anchors", "Points say which particles are held, targets where."):
        anchors = []
        for name, corners, height in (("Rise [m]", rising, 4), ("Sink [m]", sinking, -1)):
            up = d.native("Unit Z", factor=d.slider(name, height, -5, 5, decimals=2))
            moved = d.native("Move", geometry=corners["points"], motion=up)
            anchors.append(d.component("Anchors", point=corners["points"], targets=moved["Geometry"]))
    with d.group("Engine"):
        engine = parts.engine(
            d, "relaxation", "1e-10", forces=flat(springs, weight), anchors=flat(*anchors), geometry=mesh
        )
    with d.group("Numbers", "What expected.json holds the figure to."):
        d.panel("report", engine["report"])
        d.numbers(
            NUMBERS,
            {"drawn": mesh, "membrane": engine["geometry"], "forces": engine["forces"],
             "reactions": engine["reactions"]},
            {
                "middle": "height of the middle", "largest": "largest force", "smallest": "smallest force",
                "carried": "carried by the rising corners", "all_carried": "carried by all corners",
                "highest": "rising corners",
            },
            trees=["forces", "reactions"],
        )  # fmt: skip
    return d
