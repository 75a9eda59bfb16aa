"""The COMPAS components one after another on a stand-in of the canvas; run by test_compas_components in any Python.

Words: the file of the stand-ins, a file with the codes of components by name. Prints what came out as JSON.
"""

import importlib.util
import json
import sys
import time

spec = importlib.util.spec_from_file_location("stand_in", sys.argv[1])
stand_in = importlib.util.module_from_spec(spec)
spec.loader.exec_module(stand_in)
stand_in.Canvas().install()
with open(sys.argv[2]) as file:
    CODES = json.load(file)


def run(name, outputs, **inputs):
    """The outputs of a component once it schedules no more, and what it said last."""
    document = stand_in.Document()
    component = stand_in.Component(name, name, sorted(inputs), outputs, document=document)
    until = time.monotonic() + 60
    while True:
        document.scheduled[:], component.messages[:] = [], []
        names = dict(inputs, ghenv=stand_in.Environment(component))
        exec(compile(CODES[name], name, "exec"), names)
        if not document.scheduled or time.monotonic() > until:
            return [names[output] for output in outputs] + [component.messages]
        time.sleep(0.05)


def springs(structure, **more):
    names = ("_stiffness_", "_damping_", "rest_length_", "_rest_factor_", "name_")
    return run("CompasSprings", ["force"], _structure=structure, **dict(dict.fromkeys(names), **more))


def load(structure, **more):
    return run(
        "CompasLoad", ["force"], _structure=structure, **dict(dict.fromkeys(("vector_", "vertices_", "name_")), **more)
    )


def anchors(structure, **more):
    names = ("vertices_", "_x_", "_y_", "_z_", "targets_")
    return run("CompasAnchors", ["anchors"], _structure=structure, **dict(dict.fromkeys(names), **more))


def relax(structures, forces, anchors_, settings_=None):
    outputs = ["structures", "geometry", "status", "residual", "report"]
    return run("CompasRelax", outputs, _structures=structures, _forces=forces, anchors_=anchors_, settings_=settings_)


def square():
    """A Rhino mesh of 4 x 4 faces."""
    mesh = stand_in.Mesh()
    for i in range(5):
        for j in range(5):
            mesh.Vertices.Add(float(i), float(j), 0.0)
    for i in range(4):
        for j in range(4):
            a = 5 * i + j
            mesh.Faces.AddFace(a, a + 5, a + 6, a + 1)
    return mesh


def tree(*items):
    found = stand_in.DataTree()
    for i, item in enumerate(items):
        found.Add(item, stand_in.GH_Path(0, i))
    return found


stay = stand_in.Line(stand_in.Point3d(2, 2, 0), stand_in.Point3d(2, 2, 3))
(mesh, graph), said = run("CompasStructure", ["structures"], _geometry=[square(), stay])
corners = list(mesh.vertices_where({"vertex_degree": 2}))
mesh.vertices_attribute("is_support", True, keys=corners)
graph.edges_attribute("ea", 5.0)
forces, troubles = [], list(said)
parts = [
    springs(mesh, _stiffness_=[10.0], _rest_factor_=["0.5"], name_="net"),
    springs(graph, _stiffness_=["ea"], name_="stay"),
    load(mesh, vector_=[stand_in.Vector3d(0, 0, -1)]),
]
for force, said in parts:
    forces.append(force)
    troubles += said
held, said = anchors(mesh)
top = anchors(graph, vertices_=["1"])[0]
given = tree(mesh, graph)
found, geometry, status, residual, report, more = relax(given, tree(*forces), tree(held, top))
moved, tie = found.Branch(0, 0)[0], found.Branch(0, 1)[0]
told = {
    "python": list(sys.version_info[:2]),
    "hookean": "hookean" in sys.modules,
    "status": status,
    "residual": residual,
    "report": report,
    "troubles": troubles + said + more,
    "classes": [type(moved).__name__, type(tie).__name__],
    "points": [moved.vertex_coordinates(key) for key in moved.vertices()],
    "reactions": [moved.vertex_attribute(key, "reaction") for key in corners],
    "tension": [moved.edge_attribute(edge, "force") for edge in moved.edges()],
    "stay": tie.edge_attribute((0, 1), "force"),
    "drawn": [[v.X, v.Y, v.Z] for v in geometry.Branch(0, 0)[0].Vertices.ToPoint3dArray()],
    "line": geometry.Branch(0, 1)[0].Length,
    "faults": {
        "no structure": springs(None),
        "no mesh": springs("a mesh"),
        "no attribute": springs(mesh, _stiffness_=["ea"]),
        "no load": load(mesh),
        "no vertex": load(mesh, vector_=[stand_in.Vector3d(0, 0, -1)], vertices_=[99.0]),
        "no force": relax(mesh, None, held)[2:],
        "no structures": relax(None, forces, held)[2:],
        "no force at all": relax(mesh, ["load"], held)[2:],
        "an anchor beside": relax(mesh, forces[:1], [held, stand_in.Point3d(9, 9, 9)])[2:],
        "no geometry": run("CompasStructure", ["structures"], _geometry=None),
    },
}
print(json.dumps(told))
