"""Scripts in the place of K2Engineering's components that calculate: sections, loads, lengths, displacements.

Units as there: model in m; mm, mm2, mm4, N, kN/m2, kg/m3 typed in. Formulas of mechanics; g = 9.82 m/s2 as there.
"""

from __future__ import annotations

from hookean_canvas.definitions.containers import Slot
from hookean_canvas.kangaroo.recipe import Recipe

_HEAD = '''"""%s"""

from hookean_client import canvas


def numbers(given, usual=None):
    return [canvas.geometry.number(item) for item in canvas.listed(given)] or ([] if usual is None else [usual])


def vectors(given):
    return canvas.geometry.points(given)


'''
CIRCLE = f"""{_HEAD % "Areas, second moments and torsion constants of round bars, or tubes with a thickness, in mm."}
import math

area, inertia, outer, torsion = [], [], [], []
for d, t in zip(*canvas.matched(numbers(_diameter), numbers(thickness_, 0.0))):
    inner = d - 2.0 * t if t else 0.0
    area.append(math.pi / 4.0 * (d ** 2 - inner ** 2))
    inertia.append(math.pi / 64.0 * (d ** 4 - inner ** 4))
    outer.append(d / 2.0)
    torsion.append(math.pi / 32.0 * (d ** 4 - inner ** 4))
"""
RECTANGLE = f"""{_HEAD % "Areas, second moments and torsion constants of rectangles, or boxes with a thickness, in mm."}
area, iy, iz, torsion = [], [], [], []
for w, h, t in zip(*canvas.matched(numbers(_width), numbers(_height), numbers(thickness_, 0.0))):
    v, k = (w - 2.0 * t, h - 2.0 * t) if t else (0.0, 0.0)
    area.append(w * h - v * k)
    iy.append((w * h ** 3 - v * k ** 3) / 12.0)
    iz.append((h * w ** 3 - k * v ** 3) / 12.0)
    a, b = max(w, h), min(w, h)
    if t:  # Bredt, of the wall's middle line
        torsion.append(2.0 * t * ((a - t) * (b - t)) ** 2 / (a + b - 2.0 * t))
    else:  # Roark, table 10.7
        torsion.append(a * b ** 3 * (1.0 / 3.0 - 0.21 * b / a * (1.0 - b ** 4 / (12.0 * a ** 4))))
"""
MATERIAL = f"""{_HEAD % "Density [kg/m3], E, G and strength [MPa] of a material by its number, as in K2Engineering."}
table = [
    ("Steel (S355)", 7850.0, 210000.0, 355.0),
    ("Aluminium (6061-T6)", 2700.0, 70000.0, 240.0),
    ("Birch plywood (t=6.5 mm)", 680.0, 8750.0, 39.95),
    ("ETFE", 1750.0, 965.0, 48.0),
    ("GFRP", 2100.0, 40000.0, 900.0),
    ("Carbon fiber", 1760.0, 230000.0, 3500.0),
    ("Kevlar (49)", 1440.0, 112400.0, 2800.0),
    ("Dyneema", 980.0, 116000.0, 3600.0),
]
index = [min(max(int(number), 0), 7) for number in numbers(_materialindex, 0.0)]
name, density, modulus, strength = ([table[i][column] for i in index] for column in range(4))
isotropic = {{0: 0.3, 1: 0.33}}  # Poisson's ratio
shear = [table[i][2] / (2.0 + 2.0 * isotropic[i]) if i in isotropic else None for i in index]
if None in shear:
    canvas.warning(ghenv, "%s has no shear modulus here; type G in." % table[index[shear.index(None)]][0])
"""
LENGTHS = f"""{_HEAD % "Ends of bars, each once, and half of the length of the bars there."}
points, nodallengths, known = [], [], {{}}
for item in canvas.listed(_bars):
    line = canvas.geometry.straight(item)
    half = 0.5 * sum((p - q) ** 2 for p, q in zip(line[0], line[-1])) ** 0.5
    for place in (line[0], line[-1]):
        spot = tuple(round(x, 3) for x in place)
        if spot not in known:
            known[spot] = len(points)
            points.append(canvas.geometry.to_point(place))
            nodallengths.append(0.0)
        nodallengths[known[spot]] += half
"""
WEIGHT = f"""{_HEAD % "Weights downwards [N] of lengths [m], an area [mm2] and a density [kg/m3], with 9.82 m/s2."}
rows = zip(*canvas.matched(numbers(_nodallengths), numbers(_area), numbers(_density)))
nodalselfweight = [canvas.geometry.to_vector([0.0, 0.0, -9.82e-6 * a * b * c]) for a, b, c in rows]
"""
FRAMES = f"""{_HEAD % "Planes at the ends of lines: X is horizontal, Y upwards; for vertical lines those of the world."}
import Rhino

startplane, endplane = [], []
flags = [bool(item) for item in canvas.listed(flipvertical_)] or [False]
for item, flip in zip(*canvas.matched(canvas.listed(_line), flags)):
    line = canvas.geometry.straight(item)
    edge = [q - p for p, q in zip(line[0], line[-1])]
    size = sum(x * x for x in edge) ** 0.5 or 1.0
    u, v, w = (x / size for x in edge)
    x, y = [v, -u, 0.0], [-u * w, -v * w, u * u + v * v]
    if u * u + v * v < 1e-24:
        x, y = ([0.0, -1.0, 0.0], [1.0, 0.0, 0.0]) if flip else ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    for planes, place in ((startplane, line[0]), (endplane, line[-1])):
        to_vector = canvas.geometry.to_vector
        planes.append(Rhino.Geometry.Plane(canvas.geometry.to_point(place), to_vector(x), to_vector(y)))
"""
MOVED = f"""{_HEAD % "Displacements [mm] of points [m], and the largest along x, y and z with their signs."}
pairs = zip(*canvas.matched(vectors(_initial), vectors(_final)))
moves = [[1000.0 * (q - p) for p, q in zip(a, b)] for a, b in pairs]
displacements = [canvas.geometry.to_vector(move) for move in moves]
x, y, z = ([max((move[i] for move in moves), key=abs)] if moves else [] for i in range(3))
"""
TENSION = f"""{_HEAD % "Forces of strength x (length - rest length), scaled to a largest one."}
trees = [canvas.geometry.branches(given) for given in (_rest, _strength, _length)]
found = []
for i, (path, items) in enumerate(trees[0]):
    others = [tree[min(i, len(tree) - 1)][1] if tree else [] for tree in trees[1:]]
    strengths, lengths = numbers(others[0]) or [0.0], numbers(others[1])
    found.append((path, [strengths[0] * (b - a) for a, b in zip(numbers(items), lengths)]))
largest = max((force for _, forces in found for force in forces), default=0.0) or 1.0
most = (numbers(_most) or [0.0])[0]
scaled = [(path, [most * force / largest for force in forces]) for path, forces in found]
distribution = canvas.geometry.to_tree(scaled)
"""
SNOW = f"""{_HEAD % "Loads [N] of snow [kN/m2] on areas [m2], the lengths of normals; none where they point down."}
snow, option = vectors(_snow), ([bool(item) for item in canvas.listed(_option_)] or [True])[0]
nodalload = []
for normal in vectors(_normals):
    size = sum(x * x for x in normal) ** 0.5 if normal[2] >= 0.0 or not option else 0.0
    nodalload.append(canvas.geometry.to_vector([1000.0 * size * x for x in (snow or [[0.0] * 3])[0]]))
"""
WIND = f"""{_HEAD % "Loads [N] of wind [kN/m2] on areas [m2], the lengths of normals; along the normals, or the wind."}
wind, option = (vectors(_wind) or [[0.0] * 3])[0], ([bool(item) for item in canvas.listed(_option_)] or [True])[0]
strong = sum(x * x for x in wind) ** 0.5
nodalload = []
for normal in vectors(_normals):
    size = sum(x * x for x in normal) ** 0.5
    against = sum(p * q for p, q in zip(normal, wind)) < 0.0
    along = [strong * x * (-1.0 if against else 1.0) for x in normal] if option else [size * x for x in wind]
    nodalload.append(canvas.geometry.to_vector([1000.0 * x for x in along]))
"""
MOMENT = f"""{_HEAD % "Moments about the X and Y of one horizontal plane as those about the X and Y of another."}
def plain(vector):
    return [vector.X, vector.Y, vector.Z]


transformed = []
for m, one, other in zip(*canvas.matched(vectors(_moment), canvas.listed(_plane_1), canvas.listed(_plane_2))):
    world = [m[0] * p + m[1] * q for p, q in zip(plain(one.XAxis), plain(one.YAxis))]
    about = [sum(p * q for p, q in zip(world, plain(axis))) for axis in (other.XAxis, other.YAxis)]
    transformed.append(canvas.geometry.to_vector(about + [0.0]))
"""


def _slots(text: str, access: int = 1) -> tuple[Slot, ...]:
    """Inputs or outputs by `name: what it is`, one a line."""
    pairs = (line.split(": ", 1) for line in text.strip().splitlines())
    return tuple(Slot(name, told, access) for name, told in pairs)


_ABOUT = "_option_: Whether normals matter. Default: True."
HELPERS = {
    "*circle": Recipe(
        "Circle Section", "Circle", "Numbers of a round section", CIRCLE,
        _slots("_diameter: d [mm]\nthickness_: t [mm]; 0 solid"),
        _slots("area: A [mm2]\ninertia: I [mm4]\nouter: To the outer fibre [mm]\ntorsion: It [mm4]"),
    ),
    "*rectangle": Recipe(
        "Rectangle Section", "Rectangle", "Numbers of a rectangular section", RECTANGLE,
        _slots("_width: w [mm]\n_height: h [mm]\nthickness_: t [mm]; 0 solid"),
        _slots("area: A [mm2]\niy: Iy [mm4]\niz: Iz [mm4]\ntorsion: It [mm4]"),
    ),
    "*material": Recipe(
        "Material by Number", "Material", "Numbers of a material", MATERIAL,
        _slots("_materialindex: 0 to 7. Default: 0."),
        _slots("name: Name\ndensity: [kg/m3]\nmodulus: E [MPa]\nshear: G [MPa]\nstrength: [MPa]"),
    ),
    "*lengths": Recipe(
        "Lengths at Nodes", "Lengths", "Half of the bars at each node", LENGTHS,
        _slots("_bars: Lines [m]"), _slots("points: Points\nnodallengths: Lengths [m]"),
    ),
    "*weight": Recipe(
        "Weights at Nodes", "Weights", "Weights of bars", WEIGHT,
        _slots("_nodallengths: Lengths [m]\n_area: A [mm2]\n_density: [kg/m3]"), _slots("nodalselfweight: Weights [N]"),
    ),
    "*frames": Recipe(
        "Planes of Beams", "Planes", "Planes at the ends of lines", FRAMES,
        _slots("_line: Lines\nflipvertical_: Whether planes of vertical lines are turned. Default: False."),
        _slots("startplane: Planes at the start\nendplane: Planes at the end"),
    ),
    "*moved": Recipe(
        "Displacements", "Displacements", "Displacements of points", MOVED,
        _slots("_initial: Points before [m]\n_final: Points now [m]"),
        _slots("displacements: Vectors [mm]\nx: [mm]\ny: [mm]\nz: [mm]"),
    ),
    "*tension": Recipe(
        "Pretension", "Pretension", "Forces scaled to a largest one", TENSION,
        _slots("_rest: Rest lengths [m]\n_strength: Strengths\n_length: Lengths [m]\n_most: The largest force [N]", 2),
        _slots("distribution: Forces [N]"),
    ),
    "*snow": Recipe(
        "Snow on Nodes", "Snow", "Loads of snow", SNOW,
        _slots(f"_snow: Vector [kN/m2]\n_normals: Normals with areas for lengths [m2]\n{_ABOUT}"),
        _slots("nodalload: Loads [N]"),
    ),
    "*gusts": Recipe(
        "Wind on Nodes", "Wind", "Loads of wind", WIND,
        _slots(f"_wind: Vector [kN/m2]\n_normals: Normals with areas for lengths [m2]\n{_ABOUT}"),
        _slots("nodalload: Loads [N]"),
    ),
    "*moment": Recipe(
        "Moment in another Plane", "Moment", "Moments in another plane", MOMENT,
        _slots("_moment: Vectors\n_plane_1: Their planes\n_plane_2: Other planes"), _slots("transformed: Vectors"),
    ),
}  # fmt: skip
