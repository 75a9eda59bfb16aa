"""Scripts that make our forces of the goals of K2Engineering, and give their results as it does.

Units as there: metres, MPa, mm2, mm4 and N in; kN, kNm, MPa and mm out. A goal writes into the source of its force what
its output needs; the Engine's results carry that along.
"""

from __future__ import annotations

from hookean_canvas.definitions.containers import Slot
from hookean_canvas.kangaroo.recipe import Recipe

_GOAL = '''"""%s"""

import json

from hookean_client import canvas


def numbers(given, usual=None):
    return [canvas.geometry.number(item) for item in canvas.listed(given)] or ([] if usual is None else [usual])


def rows(**given):
    """Rows of values that belong together; nothing, and a warning, where an input is empty."""
    empty = sorted(name for name, items in given.items() if not items)
    if empty:
        canvas.warning(ghenv, "%%s missing; connect it." %% " and ".join(empty))
        return []
    return list(zip(*canvas.matched(*given.values())))


def ends(lines):
    found = [canvas.geometry.straight(item) for item in canvas.listed(lines)]
    return [canvas.geometry.to_line([line[0], line[-1]]) for line in found]


def goal(text, kind, **columns):
    """A force with what its output needs."""
    if text is None:
        return None
    made = json.loads(text)
    made["source"]["goal"] = dict(columns, kind=kind)
    return json.dumps(made, sort_keys=True)


'''
BAR = f"""{_GOAL % "Bars: springs with the axial stiffness E A, in MPa and mm2."}
found = rows(line=ends(_line), e_modulus=numbers(_e_modulus), area=numbers(_area))
force = found and goal(
    canvas.force(ghenv, "springs", lines=[row[0] for row in found], axial_stiffness=[e * a for _, e, a in found]),
    "bar",
    area=[row[2] for row in found],
) or None
"""
CABLE = f"""{_GOAL % "Cables: springs that take tension only; at the start length they have the pre-tension in N."}
found = rows(
    line=ends(_line), e_modulus=numbers(_e_modulus), area=numbers(_area), pretension=numbers(pretension_, 0.0)
)
force = found and goal(
    canvas.force(
        ghenv,
        "springs",
        lines=[row[0] for row in found],
        axial_stiffness=[row[1] * row[2] for row in found],
        force=[row[3] for row in found],
        tension_only=True,
    ),
    "bar",
    area=[row[2] for row in found],
) or None
"""
ROD = f"""{_GOAL % "Corners that bend with E I, in MPa and mm4; straight at rest, or as drawn with the option 1."}
def near(p, q):
    return sum((a - b) ** 2 for a, b in zip(p, q))


def corner(one, other):
    ends = [(p, q) for p in (one[::-1], one) for q in (other, other[::-1])]
    before, after = min(ends, key=lambda pair: near(pair[0][0], pair[1][0]))
    return [canvas.geometry.to_point(place) for place in (before[-1], before[0], after[-1])]


found = rows(
    linea=[canvas.geometry.straight(item) for item in canvas.listed(_linea)],
    lineb=[canvas.geometry.straight(item) for item in canvas.listed(_lineb)],
    e_modulus=numbers(_e_modulus),
    inertia=numbers(_inertia),
    distance=numbers(z_distance_, 0.0),
    option=numbers(restangleoption_, 0.0),
)
force = found and goal(
    canvas.force(
        ghenv,
        "bend",
        points=tuple(list(column) for column in zip(*[corner(row[0], row[1]) for row in found])),
        stiffness=[row[2] * row[3] * 1e-6 for row in found],
        angle_factor=[0.0 if row[5] < 1.0 else 1.0 for row in found],
        sections="free",
    ),
    "rod",
    distance=[row[4] for row in found],
    inertia=[row[3] for row in found],
) or None
"""
BEAM = f"""{_GOAL % "Beams between planes, their X and Y the axes y and z of the section; in MPa, mm2 and mm4."}
def plain(vector):
    return [vector.X, vector.Y, vector.Z]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


found = rows(
    startplane=canvas.listed(_startplane),
    endplane=canvas.listed(_endplane),
    e=numbers(_e_modulus),
    g=numbers(_g_modulus),
    a=numbers(_a),
    iy=numbers(_iy),
    iz=numbers(_iz),
    it=numbers(_it),
)
lines = [[plain(row[0].Origin), plain(row[1].Origin)] for row in found]
tilted = [
    abs(dot(plain(axis), [q - p for p, q in zip(*line)])) > 1e-6
    for row, line in zip(found, lines)
    for plane in row[:2]
    for axis in (plane.XAxis, plane.YAxis)
]
sides = []
for row, (start, end) in zip(found, lines):
    x, z, y = [q - p for p, q in zip(start, end)], plain(row[0].YAxis), plain(row[0].XAxis)
    turned = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]]
    sides.append(1.0 if dot(turned, y) >= 0.0 else -1.0)
force = found and goal(
    canvas.force(
        ghenv,
        "beam",
        lines=[canvas.geometry.to_line(line) for line in lines],
        E=[row[2] * 1e6 for row in found],
        G=[row[3] * 1e6 for row in found],
        A=[row[4] * 1e-6 for row in found],
        Iy=[row[5] * 1e-12 for row in found],
        Iz=[row[6] * 1e-12 for row in found],
        J=[row[7] * 1e-12 for row in found],
        normal=[row[0].YAxis for row in found],
        curvature="straight" if any(tilted) else "drawn",
    ),
    "beam",
    side=sides,
    axes=[[[plain(plane.XAxis), plain(plane.YAxis)] for plane in row[:2]] for row in found],
) or None
"""
SUPPORT = f"""{_GOAL % "Points that are held exactly in the directions that are True."}
points = canvas.listed(_point)
force = goal(canvas.anchors(ghenv, points, x=_x_, y=_y_, z=_z_), "support")
"""
SUPPORT_6 = f"""{_GOAL % "Points on springs along, and about, the axes that are True; the strength in N/m and N m."}
flags = {{name: [bool(item) for item in canvas.listed(given)] or [True] for name, given in (
    ("x", _x_), ("y", _y_), ("z", _z_), ("rx", _rx_), ("ry", _ry_), ("rz", _rz_)
)}}
found = rows(point=canvas.listed(_point), strength=numbers(_strength_, 1e9), **flags)
force = found and goal(
    canvas.force(
        ghenv,
        "support",
        points=[row[0] for row in found],
        stiffness=[canvas.geometry.to_vector([row[1] * flag for flag in row[2:5]]) for row in found],
        rotation_stiffness=[canvas.geometry.to_vector([row[1] * flag for flag in row[5:8]]) for row in found],
    ),
    "support6",
) or None
"""
LOAD = f"""{_GOAL % "Loads in N."}
force = goal(canvas.force(ghenv, "unary", points=_point, vector=_nodalforce), "load")
"""
OUTPUTS = '''"""Outputs of goals in the tree of the goals: data for Bar Output, circles, or geometry; at rest."""

import json

import Rhino

from hookean_client import canvas

results = [json.loads(text) for text in canvas.listed(_results)]
reactions, moved = canvas.listed(_reactions), canvas.listed(geometry_)


def plain(vector):
    return None if vector is None else [vector.X, vector.Y, vector.Z]


def shape(points):
    places = [canvas.geometry.to_point(place) for place in points]
    return places[0] if len(places) == 1 else canvas.geometry.to_polyline(points) if len(places) > 2 else (
        canvas.geometry.to_line(points)
    )


def key(place):
    return tuple(round(float(x), 6) for x in place)


now = {
    key(start): end for found in results for row in zip(found["start"], found["points"]) for start, end in zip(*row)
}


def held(made):
    """An output for each anchor, where its particle is now."""
    told = made["source"].get("goal")
    for item in made["items"]:
        reaction = plain(reactions.pop(0)) if reactions else None
        place = now.get(key(item["point"]), item["target"] or item["point"])
        yield canvas.geometry.to_point(place) if told is None else json.dumps(
            dict(told, points=[place], force=reaction), sort_keys=True
        )


def moving(found):
    """An output for each element of a force."""
    told = found["source"].get("goal")
    if found["kind"] == "collide_curve":
        return  # it holds circles inside, which are outputs already
    for i, points in enumerate(found["points"]):
        if found["kind"] == "circle_image":
            yield Rhino.Geometry.Circle(canvas.geometry.to_point(points[0]), found["radius"][i])
            continue
        record = {"points": points}
        for column, values in list(found.items()) + list((told or {}).items()):
            if isinstance(values, list) and len(values) == len(found["points"]):
                record[column] = values[i]
        yield shape(points) if told is None else json.dumps(dict(record, kind=told["kind"]), sort_keys=True)


def outputs_of(item):
    try:
        made = json.loads(item)
        kind = made["kind"]
    except (TypeError, ValueError, KeyError):
        return [moved.pop(0) if moved else item]
    if kind == "anchors":
        return list(held(made))
    return [] if kind in ("grab", "settings") else list(moving(results.pop(0)))


pairs = [
    (path, [one for item in items if item is not None for one in outputs_of(item)])
    for path, items in (canvas.geometry.branches(_goals) if results else [])
]
outputs = canvas.geometry.to_tree(pairs) if pairs else None
'''
_DATA = '''"""%s"""

import json

from hookean_client import canvas


def records(kinds, name):
    """The outputs of goals of these kinds; others are an error."""
    for item in canvas.listed(_data):
        try:
            record = json.loads(item)
            right = record["kind"] in kinds
        except (TypeError, ValueError, KeyError):
            right = False
        if not right:
            canvas.error(ghenv, "an item is not the output of a %%s; connect its output by the Solver." %% name)
        elif record.get("force", 0.0) is not None:
            yield record


def vector(values, factor=1e-3):
    return canvas.geometry.to_vector([factor * value for value in values])


'''
_FRAME = """def plane(origin, x, y):
    import Rhino

    return Rhino.Geometry.Plane(
        canvas.geometry.to_point(origin), canvas.geometry.to_vector(x), canvas.geometry.to_vector(y)
    )


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def turned(quaternion, vector):
    w, r = quaternion[0], quaternion[1:]
    over = cross(r, vector)
    return [v + 2.0 * (w * c + a) for v, c, a in zip(vector, over, cross(r, over))]


"""
BAR_OUTPUT = f"""{_DATA % "Lines, axial forces in kN and stresses in MPa; compression is negative."}
line, axialforce, axialstress = [], [], []
for one in records(("bar",), "Bar or Cable"):
    line.append(canvas.geometry.to_line(one["points"]))
    axialforce.append(1e-3 * one["force"])
    axialstress.append(one["force"] / one["area"])
"""
ROD_OUTPUT = f"""{_DATA % "Planes of bending, moments in kNm and stresses in MPa."}{_FRAME}
def unit(v):
    size = sum(x * x for x in v) ** 0.5
    return [x / (size or 1.0) for x in v]


planes, bendingmoment, bendingstress = [], [], []
for one in records(("rod",), "Rod"):
    before, at, after = one["points"]
    a, b = ([q - p for p, q in zip(at, end)] for end in (before, after))
    out = [-p - q for p, q in zip(unit(a), unit(b))]
    if sum(x * x for x in out) < 1e-24:  # straight: any side
        out = [1.0, 0.0, 0.0] if abs(unit(b)[0]) < 0.9 else [0.0, 1.0, 0.0]
    planes.append(plane(at, [q - p for p, q in zip(before, after)], out))
    bendingmoment.append(1e-3 * abs(one["moment"]))
    bendingstress.append(1e3 * abs(one["moment"]) * one["distance"] / one["inertia"])
"""
BEAM_OUTPUT = f"""{_DATA % "End planes, forces in kN and moments in kNm of beams, in the axes of their planes."}{_FRAME}
p0, p1, n, vy, vz, mt, my0, mz0, my1, mz1 = ([] for _ in range(10))
for one in records(("beam",), "Beam"):
    for planes, place, axes, quaternion in zip((p0, p1), one["points"], one["axes"], one["rotations"]):
        planes.append(plane(place, turned(quaternion, axes[0]), turned(quaternion, axes[1])))
    side = one["side"]  # of the plane's X to our y; moments there act on the beam, here in a section
    for values, value in (
        (n, one["force"]), (vy, side * one["Vy"]), (vz, one["Vz"]), (mt, -side * one["Mt"]),
        (my0, -one["My0"]), (mz0, -side * one["Mz0"]), (my1, one["My1"]), (mz1, side * one["Mz1"]),
    ):
        values.append(1e-3 * value)
"""
SUPPORT_OUTPUT = f"""{_DATA % "Points and reactions in kN."}
supportpt, reactionforce = [], []
for one in records(("support",), "Support"):
    supportpt.append(canvas.geometry.to_point(one["points"][0]))
    reactionforce.append(vector(one["force"]))
"""
SUPPORT_6_OUTPUT = f"""{_DATA % "Planes, reactions in kN and moments in kNm."}{_FRAME}
supportplane, reactionforce, reactionmoment = [], [], []
for one in records(("support6",), "Support6DOF"):
    turn = one.get("rotations", [[1.0, 0.0, 0.0, 0.0]])[0]
    supportplane.append(plane(one["points"][0], turned(turn, [1.0, 0.0, 0.0]), turned(turn, [0.0, 1.0, 0.0])))
    reactionforce.append(vector(one["force"]))
    reactionmoment.append(vector(one["moment"]))
"""


def _slots(text: str, hint: str = "none") -> tuple[Slot, ...]:
    """Inputs or outputs by `name: what it is`, one a line."""
    pairs = (line.split(": ", 1) for line in text.strip().splitlines())
    return tuple(Slot(name, told, 1, hint) for name, told in pairs)


_GIVEN = (Slot("_data", "Outputs of the solver for goals of this kind", 1),)
_FORCE = (Slot("force", "The force, for the Engine"),)
_ELASTIC = "_line: Lines [m]\n_e_modulus: E [MPa]\n_area: Areas [mm2]"
_HELD = "\n".join(f"_{axis}_: Whether {axis} is held. Default: True." for axis in "xyz")
_TURNED = "\n".join(f"_r{axis}_: Whether turns about {axis} are held. Default: True." for axis in "xyz")

HELPERS = {
    "*bar": Recipe("Bars in MPa and mm2", "Bar", "Bars with E and A", BAR, _slots(_ELASTIC), _FORCE),
    "*cable": Recipe(
        "Cables in MPa and mm2", "Cable", "Cables with E, A and a pre-tension", CABLE,
        _slots(f"{_ELASTIC}\npretension_: Forces at the start length [N]"), _FORCE,
    ),
    "*rod": Recipe(
        "Rods in MPa and mm4", "Rod", "Corners that bend with E I", ROD,
        _slots(
            "_linea: Lines [m]\n_lineb: Lines that go on from them [m]\n_e_modulus: E [MPa]\n_inertia: I [mm4]\n"
            "z_distance_: From the axis to the outer fibre [mm]\n"
            "restangleoption_: 0 straight at rest, 1 as drawn. Default: 0."
        ), _FORCE,
    ),
    "*beam": Recipe(
        "Beams in MPa and mm4", "Beam", "Beams between planes", BEAM,
        _slots(
            "_startplane: Planes at the start; X and Y are the section's y and z\n_endplane: Planes at the end\n"
            "_e_modulus: E [MPa]\n_g_modulus: G [MPa]\n_a: A [mm2]\n_iy: Iy [mm4]\n_iz: Iz [mm4]\n_it: It [mm4]"
        ), _FORCE,
    ),
    "*support": Recipe(
        "Supports", "Support", "Points that are held", SUPPORT, _slots(f"_point: Points\n{_HELD}"), _FORCE,
    ),
    "*support6": Recipe(
        "Supports with Rotations", "Support", "Points on springs", SUPPORT_6,
        _slots(f"_point: Points [m]\n{_HELD}\n{_TURNED}\n_strength_: k [N/m], kr [N m]. Default: 1000000000."), _FORCE,
    ),
    "*load": Recipe(
        "Loads in N", "Load", "Loads", LOAD, _slots("_point: Points [m]\n_nodalforce: Vectors [N]"), _FORCE,
    ),
    "*outputs": Recipe(
        "Goal Outputs", "Outputs", "Outputs of goals in their tree", OUTPUTS,
        (
            Slot("_goals", "Goals as they came to the solver", 2), Slot("_results", "Results of the Engine", 1),
            Slot("_reactions", "Reactions of the Engine", 1), Slot("geometry_", "Geometry of the Engine", 1),
        ),
        (Slot("outputs", "An output for each goal"),),
    ),
    "*baroutput": Recipe(
        "Bar Output", "BarOutput", "Forces of bars and cables", BAR_OUTPUT, _GIVEN,
        _slots("line: Lines\naxialforce: Forces [kN]\naxialstress: Stresses [MPa]"),
    ),
    "*rodoutput": Recipe(
        "Rod Output", "RodOutput", "Moments of rods", ROD_OUTPUT, _GIVEN,
        _slots("planes: Planes of bending\nbendingmoment: Moments [kNm]\nbendingstress: Stresses [MPa]"),
    ),
    "*beamoutput": Recipe(
        "Beam Output", "BeamOutput", "Forces and moments of beams", BEAM_OUTPUT, _GIVEN,
        _slots(
            "p0: Planes at the start\np1: Planes at the end\nn: N [kN]\nvy: Vy [kN]\nvz: Vz [kN]\nmt: Mt [kNm]\n"
            "my0: My at the start [kNm]\nmz0: Mz at the start [kNm]\nmy1: My at the end [kNm]\nmz1: Mz at the end [kNm]"
        ),
    ),
    "*supportoutput": Recipe(
        "Support Output", "SupportOutput", "Reactions", SUPPORT_OUTPUT, _GIVEN,
        _slots("supportpt: Points\nreactionforce: Reactions [kN]"),
    ),
    "*support6output": Recipe(
        "Support Output with Moments", "SupportOutput", "Reactions", SUPPORT_6_OUTPUT, _GIVEN,
        _slots("supportplane: Planes\nreactionforce: Reactions [kN]\nreactionmoment: Moments [kNm]"),
    ),
}  # fmt: skip
