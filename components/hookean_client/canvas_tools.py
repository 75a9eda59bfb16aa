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


def mesh_corners(ghenv, meshes, angles, order):
    """Boundary vertices whose angle inside the mesh is below a number [rad], and their numbers."""

    def work():
        options = {"angle": default(angles, 2.356194490192345), "order": word(order, ("index", "boundary"), "order")}
        return each(ghenv, "corners", meshes, ["points", "indices"], **options)

    return canvas._told(ghenv, work) or (None, None)


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


def remove_duplicate_points(ghenv, points, tolerance):
    """The points of a branch without those that are near one before them."""
    found = canvas.discretize(ghenv, "remove_duplicate_points", points, tolerance=default(tolerance, 0.01)[0])
    return found and found["points"]


def combine_clean(ghenv, meshes, tolerance):
    """The meshes of a branch as one, welded, without duplicate faces and unused vertices."""
    found = canvas.discretize(ghenv, "clean", meshes, tolerance=default(tolerance, 0.01)[0])
    return found and found["mesh"]


def refine(ghenv, meshes, levels, smooth):
    """Each mesh with every face cut into four, so many times."""

    def work():
        return each(ghenv, "refine", meshes, ["mesh"], level=whole(levels, 1, "level", 0), smooth=flag(smooth, False))

    return (canvas._told(ghenv, work) or [None])[0]


def refine_strips(ghenv, meshes, levels, direction):
    """Each mesh with every face cut in two across one direction, so many times."""

    def work():
        way = word(direction, ("along", "warp", "weft"), "direction")
        return each(ghenv, "refine_strips", meshes, ["mesh"], level=whole(levels, 1, "level", 0), direction=way)

    return (canvas._told(ghenv, work) or [None])[0]


def diagonalize(ghenv, meshes):
    """A mesh with a face for each edge of each mesh."""
    return each(ghenv, "diagonalize", meshes, ["mesh"])[0]


def checkerboard(ghenv, meshes, strict):
    """Whether each face has the second colour, and the numbers of the faces of both."""
    names = ["pattern", "first", "second"]
    found = answers(ghenv, "checkerboard", meshes, strict=flag(strict, True))
    if found is None:
        return [None] * len(names)
    for one in found:
        one["pattern"] = [bool(value) for value in one["pattern"]]
    return [column(ghenv, [one[name] for one in found]) for name in names]


def hinge_points(ghenv, meshes):
    """Start and end of the fold and the two tips of the hinge at each inner edge of each mesh."""
    return each(ghenv, "hinge_points", meshes, ["start_points", "end_points", "tip_1_points", "tip_2_points"])


def fold_angle(ghenv, starts, ends, tips_1, tips_2):
    """Angles between the triangles start-end-tip 1 and end-start-tip 2, matched by the longest list."""

    def work():
        names = ("start", "end", "tip_1", "tip_2")
        for name, given in zip(names, (starts, ends, tips_1, tips_2)):
            if not listed(given):
                raise canvas.scene.missing("%s is missing; connect points" % name)
        rows = matched(*[geometry.points(given) for given in (starts, ends, tips_1, tips_2)])
        found = canvas.discretize(ghenv, "fold_angle", rows[0], **dict(zip(names[1:], rows[1:])))
        return found and found["angles"]

    return canvas._told(ghenv, work)


def vertex_neighbours(ghenv, meshes, vertices):
    """The vertices asked for, a branch of neighbours and of their numbers for each, and the normals."""

    def work():
        wanted = [int(geometry.number(one)) for one in listed(vertices)]
        found = answers(ghenv, "vertex_neighbours", meshes, vertices=[wanted] if wanted else None)
        if found is None:
            return None
        places, rings, numbers, above = [], [], [], path(ghenv).strip("{}")
        for i, (one, mesh) in enumerate(zip(found, listed(meshes))):
            corners = [geometry.to_point(place) for place in geometry.mesh(mesh)["vertices"]]
            places.append([corners[v] for v in wanted or range(len(corners))])
            branch = "{%s;%%d}" % (above if len(found) == 1 else "%s;%d" % (above, i))
            rings += [(branch % j, [corners[v] for v in ring]) for j, ring in enumerate(one["neighbours"])]
            numbers += [(branch % j, ring) for j, ring in enumerate(one["neighbours"])]
        normals = column(ghenv, [one["normals"] for one in found])
        return column(ghenv, places), geometry.to_tree(rings), geometry.to_tree(numbers), normals

    return canvas._told(ghenv, work) or [None] * 4


def mesh_map(ghenv, points, source, target, distance):
    """The points of a branch moved as their mesh is."""

    def work():
        for name, given in (("source", source), ("target", target)):
            if not listed(given):
                raise canvas.scene.missing("%s is missing; connect a mesh" % name)
        meshes = {"source": source, "target": target}
        found = canvas.discretize(ghenv, "mesh_map", points, distance=default(distance, 1.0)[0], **meshes)
        return found and found["points"]

    return canvas._told(ghenv, work)


def interconnect_points(ghenv, points):
    """A line between every two points of a branch."""
    found = canvas.discretize(ghenv, "interconnect_points", points)
    return found and found["lines"]


def bipartite(ghenv, lines, tolerance):
    """The ends of the lines of a branch in two groups, with lines only between these."""
    found = canvas.discretize(ghenv, "bipartite", lines, tolerance=default(tolerance, 0.01)[0])
    return (found["first_points"], found["second_points"]) if found else (None, None)


def moebius_transformation(ghenv, points, angle, axis, centre, radius):
    """The points of a branch moved so that spheres, circles and angles stay."""

    def work():
        if not listed(angle):
            raise canvas.scene.missing("angle is missing; connect it")
        given = {"angle": listed(angle)[0], "radius": default(radius, 1.0)[0]}
        for name, one in (("axis", axis), ("centre", centre)):
            if listed(one):
                given[name] = listed(one)[0]
        found = canvas.discretize(ghenv, "moebius_transformation", points, **given)
        return found and found["points"]

    return canvas._told(ghenv, work)


def pipes(ghenv, lines, radius, sides, tolerance):
    """Pipes about the lines of a branch, as one closed mesh."""

    def work():
        if not listed(radius):
            raise canvas.scene.missing("radius is missing; connect it")
        given = {"radius": listed(radius)[0], "tolerance": default(tolerance, 0.01)[0]}
        found = canvas.discretize(ghenv, "pipes", lines, sides=whole(sides, 6, "sides", 3)[0], **given)
        return found and found["mesh"]

    return canvas._told(ghenv, work)


def align_quads(ghenv, meshes, strict):
    """Each mesh with quads that have the same direction."""
    return each(ghenv, "align_quads", meshes, ["mesh"], strict=flag(strict, True))[0]


def turn_quads(ghenv, meshes, turns):
    """Each mesh with the direction of its quads turned by right angles."""

    def work():
        return each(ghenv, "turn_quads", meshes, ["mesh"], turns=whole(turns, 1, "turns"))

    return (canvas._told(ghenv, work) or [None])[0]


def strips(ghenv, meshes, direction):
    """The number of the strip of each face of each mesh."""

    def work():
        return each(ghenv, "strips", meshes, ["strips"], direction=word(direction, ("warp", "weft"), "direction"))

    return (canvas._told(ghenv, work) or [None])[0]


def unroll_strips(ghenv, meshes, direction, gaps):
    """The strips of each mesh unrolled into the plane z = 0."""

    def work():
        given = {"direction": word(direction, ("warp", "weft"), "direction"), "gap": default(gaps, 0.0)}
        return each(ghenv, "unroll_strips", meshes, ["mesh"], **given)

    return (canvas._told(ghenv, work) or [None])[0]


def reciprocal_diagram(ghenv, meshes):
    """The reciprocal figure of each flat mesh, and the force densities of its inner edges."""
    return each(ghenv, "reciprocal_diagram", meshes, ["lines", "densities"])


def live_film(ghenv, meshes, lengths, volumes):
    """The soap film on each mesh, made again while it relaxes."""

    def work():
        if not listed(lengths):
            raise canvas.scene.missing("length is missing; connect it")
        many = {"length": listed(lengths), "volume_factor": default(volumes, 0.0)}
        return each(ghenv, "live_film", meshes, ["mesh"], **many)

    return (canvas._told(ghenv, work) or [None])[0]


def split_at_corners(ghenv, curves, angles):
    """Points where each polyline turns by more than a number [rad], and its parts between them."""
    return each(ghenv, "split_at_corners", curves, ["points", "polylines"], turning_angle=default(angles, 1.0))


def remesh(ghenv, meshes, lengths, angles, rounds):
    """Each mesh as triangles with edges of about a length, folds above a number [rad] kept."""

    def work():
        if not listed(lengths):
            raise canvas.scene.missing("length is missing; connect it")
        many = {"length": listed(lengths), "feature_angle": default(angles, 0.5235987755982988)}
        return each(ghenv, "remesh", meshes, ["mesh"], iterations=whole(rounds, 15, "iterations"), **many)

    return (canvas._told(ghenv, work) or [None])[0]
