"""Components of lines and curves. For Python 2.7 to 3.13."""

from . import canvas_geometry as geometry
from . import canvas_words as words
from .canvas_branches import column
from .canvas_discretize import answers, discretize, each
from .canvas_geometry import listed, matched
from .canvas_values import default, whole


def divide(ghenv, curves, counts):
    """Points that cut each curve into pieces of equal arc length."""
    return words.told(ghenv, lambda: each(ghenv, "divide", curves, ["points"], count=whole(counts, 10, "count"))[0])


def shatter(ghenv, curves, counts):
    """Lines along each curve and their lengths; a count of 0 takes a polyline apart as it is drawn."""
    return words.told(ghenv, lambda: _shatter(ghenv, listed(curves), whole(counts, 10, "count", 0))) or (None, None)


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


def interpolate(ghenv, points, counts, degrees):
    """A smooth curve through points, as a fine polyline."""

    def work():
        many = {"count": whole(counts, 100, "count")[0], "degree": whole(degrees, 3, "degree")[0]}
        found = discretize(ghenv, "interpolate", points, **many)
        return found and geometry.to_polyline([geometry.point(one) for one in found["points"]])

    return words.told(ghenv, work)


def split_at_corners(ghenv, curves, angles):
    """Points where each polyline turns by more than a number [rad], and its parts between them."""
    return each(ghenv, "split_at_corners", curves, ["points", "polylines"], turning_angle=default(angles, 1.0))
