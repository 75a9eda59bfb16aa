"""A sail in wind on the canvas: the load of every moment comes from a table of speeds."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("wind").scene)
CABLES = (("Sail", "all", "stiffness", "rest_factor"), ("Edge", "naked", "edge_stiffness", "edge_factor"))

NUMBERS = """
sail, edge, wind = [list(largest.Branch(path)) for path in largest.Paths]
start = [drawn.Vertices.Point3dAt(i) for i in range(len(drawn.Vertices))]
centre = min(range(len(start)), key=lambda i: (start[i].X - 3.0) ** 2 + (start[i].Y - 3.0) ** 2)
end = frames.Branch(frames.Paths[len(times) - 1])[0]
load = max(wind)
gust = max(edge)
when = times[edge.index(gust)]
middle = end.Vertices.Point3dAt(centre).Z
steady = edge[-1]
"""


def definition() -> Definition:
    d = Definition(
        "wind",
        "A sail in a stream of wind",
        "A sail of 6 m held at its corners. wind.csv has the speed of the wind every half second; its pressure goes "
        "with the square of the speed. Stream plays all of it, a frame every 0.1 s.",
    )
    with d.group("Drawn in Rhino", "The sail in model.3dm beside this file."):
        drawn = d.component(
            "RhinoFile", file=d.text("File", "model.3dm"), layer=d.text("Layer", "sail"),
            u=d.slider("U [-]", GIVEN["divisions"], 2, 30), v=d.slider("V [-]", GIVEN["divisions"], 2, 30),
        )  # fmt: skip
        mesh = drawn["meshes"]
        corners = d.component("MeshCorners", mesh=mesh)["corners"]
        vertices = d.component("MeshVertices", mesh=mesh)
    with d.group("Forces", "N s2/m2: 1.225 / 2 x 36 / 121 x coefficient, 0.5 along X and 0.8 upwards."):
        springs = [
            d.component(
                "Springs", name, connection=mesh, edges=d.text(f"Which: {name}", edges),
                stiffness=d.slider(f"{name} [N/m]", GIVEN[of], 100, 100000),
                rest_factor=d.slider(f"{name} factor [-]", GIVEN[factor], 0.5, 1.1, decimals=2),
            )
            for name, edges, of, factor in CABLES
        ]  # fmt: skip
        still = d.native("Unit Z", factor=d.slider("Load at the start [N]", 0, -100, 100))
        wind = d.component("Unary", point=vertices, force=still, name=d.text("Name", "wind"))
        along, up = d.text("Along X", "0.09111570247933884"), d.text("Upwards", "0.14578512396694215")
        scale = d.native("Vector XYZ", x_component=along, z_component=up)
    with d.group("Stream"):
        settings = d.component(
            "Settings", time_step=d.text("Time step [s]", "0.0025"), drag=d.slider("Drag [N s/m]", 3, 0, 10, decimals=1)
        )
        stream = d.component(
            "Stream", forces=flat(*springs, wind), anchors=flat(corners), settings=settings, geometry=mesh,
            file=d.text("Table", "wind.csv"), column=d.text("Column", "speed [m/s]"), force=d.text("Load", "wind"),
            scale=scale["Vector"], power=d.slider("Power [-]", 2, 1, 3),
            every=d.slider("Every [s]", 0.1, 0.05, 1, decimals=2),
        )  # fmt: skip
        d.panel("report", stream["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        d.numbers(
            NUMBERS,
            {"drawn": mesh, "frames": stream["geometry"], "largest": stream["largest"], "times": stream["times"]},
            {
                "load": "largest load on a particle", "gust": "largest force in an edge, in the gust",
                "when": "time of the largest force", "middle": "height of the middle at a steady 12 m/s",
                "steady": "largest force in an edge at a steady 12 m/s",
            },
            lists=["times"], trees=["frames", "largest"],
        )  # fmt: skip
    return d
