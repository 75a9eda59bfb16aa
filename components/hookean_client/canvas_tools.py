"""What the components of geometry share: inputs with defaults, branches for the results of several items.

For Python 2.7 to 3.13.
"""

from . import canvas
from . import canvas_geometry as geometry
from .canvas_geometry import Unfit, listed, matched


def default(given, value):
    """What is connected to an input, as a list, or a value where nothing is."""
    return listed(given) or [value]


def whole(given, value, name, least=1):
    """Whole numbers of an input, or a value where nothing is connected. Raises `Unfit` for anything else, or too small
    numbers."""
    found = []
    for item in default(given, value):
        try:
            number = geometry.number(item)
        except Unfit as unfit:
            raise Unfit("%s: %s" % (name, unfit))
        if number != int(number) or number < least:
            raise Unfit("%s: %s given; a whole number from %d on is expected" % (name, item, least))
        found.append(int(number))
    return found


def word(given, known, name):
    """The word connected to an input, which may be given as its number; the first one where nothing is."""
    item = default(given, known[0])[0]
    found = item.strip().lower() if isinstance(item, geometry.TEXT) else item
    if found not in known:
        try:
            found = known[int(geometry.number(found))]
        except (Unfit, IndexError):
            ways = ", ".join("%d %s" % pair for pair in enumerate(known))
            given = item if isinstance(item, geometry.NUMBERS) else geometry.called(item)
            raise Unfit("%s: %s is unknown; give one of %s" % (name, given, ways))
    return str(found)


def flag(given, value):
    """Whether an input is true; a value where nothing is connected."""
    return str(default(given, value)[0]).strip().lower() not in ("false", "0", "0.0", "no", "")


def each(ghenv, operation, items, gives, **options):
    """An output for each name in `gives`: what an operation makes of the items of a branch, None until it is there.

    Lists of one item are a list; those of several have a branch for each item, below that of the items.
    """
    found = answers(ghenv, operation, items, **options)
    return [found and column(ghenv, [one[name] for one in found]) for name in gives]


def answers(ghenv, operation, items, **options):
    """What an operation makes of each item of a branch; None until all are there."""
    found = canvas.discretize(ghenv, operation, items, many=True, **options)
    return None if found is None or None in found else found


def column(ghenv, values):
    """Values of several items as an output; see `each`."""
    if not values or not isinstance(values[0], list):
        return values
    return values[0] if len(values) == 1 else below(ghenv, values)


def below(ghenv, rows):
    """A tree with a branch for each row, below the branch that this run is about."""
    above = path(ghenv).strip("{}")
    return geometry.to_tree([("{%s;%d}" % (above, i), row) for i, row in enumerate(rows)])


def path(ghenv):
    """The path, as text, of the branch that this run of a component is about."""
    run, found = canvas.run_of(ghenv), []
    for parameter in ghenv.Component.Params.Input:
        paths = list(getattr(parameter.VolatileData, "Paths", None) or [])
        found = paths if len(paths) > len(found) else found
    return str(found[run - 1]) if run <= len(found) else "{%d}" % (run - 1)


# what components are


def divide(ghenv, curves, counts):
    """Points that cut each curve into pieces of equal arc length."""
    return canvas._told(ghenv, lambda: each(ghenv, "divide", curves, ["points"], count=whole(counts, 10, "count"))[0])


def shatter(ghenv, curves, counts):
    """Lines along each curve and their lengths; a count of 0 takes a polyline apart as it is drawn."""
    return canvas._told(ghenv, lambda: _shatter(ghenv, listed(curves), whole(counts, 10, "count", 0))) or (None, None)


def _shatter(ghenv, curves, counts):
    curves, counts = matched(curves, counts if curves else [])
    rows = {}
    for operation, wanted in (("explode", False), ("shatter", True)):
        places = [i for i, count in enumerate(counts) if bool(count) is wanted]
        if places or not curves:
            options = {"count": [counts[i] for i in places]} if wanted else {}
            found = answers(ghenv, operation, [curves[i] for i in places], **options)
            if found is None:
                return None
            rows.update(zip(places, [one["lines"] for one in found]))
    lines = [rows[i] for i in range(len(curves))]
    return column(ghenv, lines), column(ghenv, [[line.Length for line in row] for row in lines])


def catenary(ghenv, starts, ends, lengths, gravity, counts):
    """Cables of given lengths as curves, their points and the straight lines between these."""
    return canvas._told(ghenv, lambda: _catenary(ghenv, starts, ends, lengths, gravity, counts)) or (None, None, None)


def _catenary(ghenv, starts, ends, lengths, gravity, counts):
    names = ("start", "end", "length")
    for name, given in zip(names, (starts, ends, lengths)):
        if not listed(given):
            raise canvas.scene.missing("%s is missing; connect it" % name)
    rows = matched(geometry.points(starts), geometry.points(ends), [geometry.number(one) for one in listed(lengths)],
                   geometry.points(gravity) or [[0.0, 0.0, -1.0]])  # fmt: skip
    lines = [list(pair) for pair in zip(rows[0], rows[1])]
    options = {
        "length": rows[2],
        "gravity": [geometry.to_vector(one) for one in rows[3]],
        "count": whole(counts, 50, "count")[0],
    }
    found = canvas.discretize(ghenv, "catenary", lines, **options)
    if found is None:
        return None
    corners = [geometry.polyline(one) for one in found["polylines"]]
    points = [[geometry.to_point(one) for one in row] for row in corners]
    pieces = [[geometry.to_line(row[i : i + 2]) for i in range(len(row) - 1)] for row in corners]
    return found["polylines"], column(ghenv, points), column(ghenv, pieces)


def interpolate(ghenv, points, counts, degrees):
    """A smooth curve through points, as a fine polyline."""

    def work():
        many = {"count": whole(counts, 100, "count")[0], "degree": whole(degrees, 3, "degree")[0]}
        found = canvas.discretize(ghenv, "interpolate", points, **many)
        return found and geometry.to_polyline([geometry.point(one) for one in found["points"]])

    return canvas._told(ghenv, work)


def mesh_surface(ghenv, surfaces, u, v):
    """Each surface as a mesh of u by v quads."""
    sizes = {"u": u, "v": v}

    def work():
        for name in sizes:
            sizes[name] = whole(sizes[name], 10, name)
        return each(ghenv, "mesh_surface", surfaces, ["mesh"], **sizes)[0]

    return canvas._told(ghenv, work)


def mesh_edges(ghenv, meshes):
    """All edges of each mesh, and those at its boundary."""
    return each(ghenv, "edges", meshes, ["lines"]) + each(ghenv, "naked_edges", meshes, ["lines"])


def mesh_vertices(ghenv, meshes):
    """The vertices of each mesh; no service is asked."""

    def work():
        given = listed(meshes)
        if not given:
            raise canvas.scene.missing("mesh is missing; connect it")
        return column(ghenv, [[geometry.to_point(one) for one in geometry.mesh(mesh)["vertices"]] for mesh in given])

    return canvas._told(ghenv, work)


def mesh_corners(ghenv, meshes, angles):
    """Boundary vertices whose angle inside the mesh is below a number [rad], and their numbers."""
    limits = default(angles, 2.356194490192345)
    return each(ghenv, "corners", meshes, ["points", "indices"], angle=limits)


def naked_vertices(ghenv, meshes):
    """Numbers of the clothed and of the naked vertices, and where they are."""
    return each(ghenv, "boundary", meshes, ["clothed", "naked", "clothed_points", "naked_points"])


def warp_weft(ghenv, meshes, strict):
    """Warp and weft lines, and for each whether it is at the boundary."""
    names = ["warp_lines", "weft_lines", "warp_naked", "weft_naked"]
    found = answers(ghenv, "threads", meshes, strict=flag(strict, True))
    if found is None:
        return [None] * len(names)
    for one in found:
        one.update((name, [bool(value) for value in one[name]]) for name in names[2:])
    return [column(ghenv, [one[name] for one in found]) for name in names]


def diagonals(ghenv, meshes, pattern):
    """Diagonals of the quads of each mesh."""

    def work():
        return each(ghenv, "diagonals", meshes, ["lines"], pattern=word(pattern, ("both", "one", "other"), "pattern"))

    return (canvas._told(ghenv, work) or [None])[0]


def remove_duplicate_lines(ghenv, lines, tolerance):
    """The lines of a branch without those that are there before, either way round."""
    near = default(tolerance, 0.01)[0]
    found = canvas.discretize(ghenv, "remove_duplicate_lines", lines, tolerance=near)
    return found and found["lines"]
