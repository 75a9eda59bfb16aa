"""Components of points. For Python 2.7 to 3.13."""

from . import canvas_geometry as geometry
from . import canvas_words as words
from .canvas_discretize import discretize
from .canvas_geometry import listed, matched, missing
from .canvas_values import default


def remove_duplicate_points(ghenv, points, tolerance):
    """The points of a branch without those that are near one before them."""
    found = discretize(ghenv, "remove_duplicate_points", points, tolerance=default(tolerance, 0.01)[0])
    return found and found["points"]


def interconnect_points(ghenv, points):
    """A line between every two points of a branch."""
    found = discretize(ghenv, "interconnect_points", points)
    return found and found["lines"]


def fold_angle(ghenv, starts, ends, tips_1, tips_2):
    """Angles between the triangles start-end-tip 1 and end-start-tip 2, matched by the longest list."""

    def work():
        names = ("start", "end", "tip_1", "tip_2")
        for name, given in zip(names, (starts, ends, tips_1, tips_2)):
            if not listed(given):
                raise missing("%s is missing; connect points" % name)
        rows = matched(*[geometry.points(given) for given in (starts, ends, tips_1, tips_2)])
        found = discretize(ghenv, "fold_angle", rows[0], **dict(zip(names[1:], rows[1:])))
        return found and found["angles"]

    return words.told(ghenv, work)


def mesh_map(ghenv, points, source, target, distance):
    """The points of a branch moved as their mesh is."""

    def work():
        for name, given in (("source", source), ("target", target)):
            if not listed(given):
                raise missing("%s is missing; connect a mesh" % name)
        meshes = {"source": source, "target": target}
        found = discretize(ghenv, "mesh_map", points, distance=default(distance, 1.0)[0], **meshes)
        return found and found["points"]

    return words.told(ghenv, work)


def moebius_transformation(ghenv, points, angle, axis, centre, radius):
    """The points of a branch moved so that spheres, circles and angles stay."""

    def work():
        if not listed(angle):
            raise missing("angle is missing; connect it")
        given = {"angle": listed(angle)[0], "radius": default(radius, 1.0)[0]}
        for name, one in (("axis", axis), ("centre", centre)):
            if listed(one):
                given[name] = listed(one)[0]
        found = discretize(ghenv, "moebius_transformation", points, **given)
        return found and found["points"]

    return words.told(ghenv, work)
