"""Components of straight lines and cables. For Python 2.7 to 3.13."""

from . import canvas_geometry as geometry
from . import canvas_words as words
from .canvas_branches import column
from .canvas_discretize import discretize
from .canvas_geometry import listed, matched, missing
from .canvas_values import default, whole


def catenary(ghenv, starts, ends, lengths, gravity, counts):
    """Cables of given lengths as curves, their points and the straight lines between these."""
    return words.told(ghenv, lambda: _catenary(ghenv, starts, ends, lengths, gravity, counts)) or (None, None, None)


def _catenary(ghenv, starts, ends, lengths, gravity, counts):
    names = ("start", "end", "length")
    for name, given in zip(names, (starts, ends, lengths)):
        if not listed(given):
            raise missing("%s is missing; connect it" % name)
    rows = matched(geometry.points(starts), geometry.points(ends), [geometry.number(one) for one in listed(lengths)],
                   geometry.points(gravity) or [[0.0, 0.0, -1.0]])  # fmt: skip
    lines = [list(pair) for pair in zip(rows[0], rows[1])]
    options = {
        "length": rows[2],
        "gravity": [geometry.to_vector(one) for one in rows[3]],
        "count": whole(counts, 50, "count")[0],
    }
    found = discretize(ghenv, "catenary", lines, **options)
    if found is None:
        return None
    corners = [geometry.polyline(one) for one in found["polylines"]]
    points = [[geometry.to_point(one) for one in row] for row in corners]
    pieces = [[geometry.to_line(row[i : i + 2]) for i in range(len(row) - 1)] for row in corners]
    return found["polylines"], column(ghenv, points), column(ghenv, pieces)


def remove_duplicate_lines(ghenv, lines, tolerance):
    """The lines of a branch without those that are there before, either way round."""
    near = default(tolerance, 0.01)[0]
    found = discretize(ghenv, "remove_duplicate_lines", lines, tolerance=near)
    return found and found["lines"]


def bipartite(ghenv, lines, tolerance):
    """The ends of the lines of a branch in two groups, with lines only between these."""
    found = discretize(ghenv, "bipartite", lines, tolerance=default(tolerance, 0.01)[0])
    return (found["first_points"], found["second_points"]) if found else (None, None)


def pipes(ghenv, lines, radius, sides, tolerance):
    """Pipes about the lines of a branch, as one closed mesh."""

    def work():
        if not listed(radius):
            raise missing("radius is missing; connect it")
        given = {"radius": listed(radius)[0], "tolerance": default(tolerance, 0.01)[0]}
        found = discretize(ghenv, "pipes", lines, sides=whole(sides, 6, "sides", 3)[0], **given)
        return found and found["mesh"]

    return words.told(ghenv, work)
