"""A wall of loose bricks on the canvas: rigid bodies that collide, on a slab that is held."""

from hookean.commands.examples import defaults, figure
from hookean_canvas.definitions import parts
from hookean_canvas.definitions.write import Definition, flat

GIVEN = defaults(figure("rigid_boxes").scene)

WALL = """
import Rhino

long, wide, high = 0.5, 0.25, 0.2  # m, with the joints
mesh = Rhino.Geometry.Mesh()
corners, numbers, slab, loaded, loads = [], [], [], [], []


def box(left, right, low, up, breadth):
    first = len(corners)
    for z in (low, up):
        for y in (-0.5 * breadth, 0.5 * breadth):
            for x in (left, right):
                corners.append(Rhino.Geometry.Point3d(x, y, z))
                numbers.append(first // 8)
                mesh.Vertices.Add(x, y, z)
    for face in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
        mesh.Faces.AddFace(*[first + corner for corner in face])
    return corners[first:]


courses, across = int(courses), int(across)
slab = box(-0.25, across * long + 0.25, -high, 0.0, 1.4 * wide)
for course in range(courses):
    ends = [float(i) for i in range(across + 1)]
    if course % 2:
        ends = [0.0] + [i + 0.5 for i in range(across)] + [float(across)]
    low = course * high + (course + 1) * gap
    for left, right in zip(ends, ends[1:]):
        brick = box(long * left + 0.5 * gap, long * right - 0.5 * gap, low, low + high, wide)
        loaded += brick
        loads += 8 * [Rhino.Geometry.Vector3d(0, 0, -weight * (right - left) / 8.0)]
"""
NUMBERS = """
import math

x = [mesh.Vertices.Point3dAt(i) for i in range(8, len(mesh.Vertices))]
bricks = [x[i : i + 8] for i in range(0, len(x), 8)]
height = max(p.Z for p in x)
lowest = bricks[: int(across)]
sinking = -sum(p.Z for brick in lowest for p in brick[:4]) / (4.0 * len(lowest))
carried = sum(v.Z for path in reactions.Paths for v in reactions.Branch(path))


def middle(points, axis):
    return sum(getattr(p, axis) for p in points) / len(points)


drawn = [starts[i : i + 8] for i in range(8, len(starts), 8)]
pairs = [(brick, before, axis) for brick, before in zip(bricks, drawn) for axis in "XY"]
aside = max(abs(middle(brick, axis) - middle(before, axis)) for brick, before, axis in pairs)
tilt = 0.0
for brick in bricks:
    heights, places = [p.Z for p in brick[:4]], [p.X for p in brick[:4]]
    tilt = max(tilt, math.degrees(math.atan((max(heights) - min(heights)) / (max(places) - min(places)))))
"""
NAMES = {
    "height": "height of the wall",
    "sinking": "sinking of the lowest course",
    "carried": "force on the slab",
    "aside": "movement aside, largest",
    "tilt": "tilt of a brick, largest",
}


def definition() -> Definition:
    d = Definition(
        "rigid_boxes",
        "A wall of loose bricks",
        "Each brick is a rigid body of its eight corners, and Rigid Collide keeps bricks apart, with friction. Set "
        "Reset to False: they fall onto each other by the width of a joint, and stay.",
    )
    with d.group("Wall"):
        sliders = {
            "courses": d.slider("Courses [-]", GIVEN["courses"], 1, 20),
            "across": d.slider("Across [-]", GIVEN["across"], 2, 25),
            "gap": d.slider("Joint [m]", GIVEN["gap"], 0.002, 0.02, decimals=3),
            "weight": d.slider("Weight [N]", GIVEN["weight"], 1, 5000),
        }
        wall = d.script("Wall", WALL, sliders, ["mesh", "corners", "numbers", "slab", "loaded", "loads"])
    with d.group("Forces"):
        strength = d.slider("Strength [N/m3]", GIVEN["strength"], 1e6, 1e9)
        bodies = d.component(
            "RigidBody", point=wall["corners"], group=wall["numbers"],
            strength=d.slider("Strength [N/m]", 0.1 * GIVEN["strength"], 1e5, 1e8),
        )  # fmt: skip
        contacts = d.component(
            "RigidCollide", point=wall["corners"], group=wall["numbers"], strength=strength,
            friction=d.slider("Friction [-]", GIVEN["friction"], 0, 1, decimals=2),
        )  # fmt: skip
        weight = d.component("Unary", point=wall["loaded"], force=wall["loads"])
        anchors = d.component("Anchors", point=wall["slab"])
    with d.group("Engine"):
        engine = parts.engine(
            d, "relaxation", "1e-5", forces=flat(bodies, contacts, weight), anchors=anchors, geometry=wall["mesh"]
        )
        d.panel("report", engine["report"])
    with d.group("Numbers", "What expected.json holds it to."):
        given = {"mesh": engine["geometry"], "reactions": engine["reactions"], "starts": wall["corners"]}
        d.numbers(NUMBERS, {**given, "across": sliders["across"]}, NAMES, lists=["starts"], trees=["reactions"])
    return d
