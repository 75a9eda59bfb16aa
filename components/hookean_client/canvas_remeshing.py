"""Components that make other meshes of meshes. For Python 2.7 to 3.13."""

from . import canvas_words as words
from .canvas_discretize import discretize, each
from .canvas_geometry import listed, missing
from .canvas_values import default, flag, whole, word


def combine_clean(ghenv, meshes, tolerance):
    """The meshes of a branch as one, welded, without duplicate faces and unused vertices."""
    found = discretize(ghenv, "clean", meshes, tolerance=default(tolerance, 0.01)[0])
    return found and found["mesh"]


def refine(ghenv, meshes, levels, smooth):
    """Each mesh with every face cut into four, so many times."""

    def work():
        return each(ghenv, "refine", meshes, ["mesh"], level=whole(levels, 1, "level", 0), smooth=flag(smooth, False))

    return (words.told(ghenv, work) or [None])[0]


def refine_strips(ghenv, meshes, levels, direction):
    """Each mesh with every face cut in two across one direction, so many times."""

    def work():
        way = word(direction, ("along", "warp", "weft"), "direction")
        return each(ghenv, "refine_strips", meshes, ["mesh"], level=whole(levels, 1, "level", 0), direction=way)

    return (words.told(ghenv, work) or [None])[0]


def diagonalize(ghenv, meshes):
    """A mesh with a face for each edge of each mesh."""
    return each(ghenv, "diagonalize", meshes, ["mesh"])[0]


def align_quads(ghenv, meshes, strict):
    """Each mesh with quads that have the same direction."""
    return each(ghenv, "align_quads", meshes, ["mesh"], strict=flag(strict, True))[0]


def turn_quads(ghenv, meshes, turns):
    """Each mesh with the direction of its quads turned by right angles."""

    def work():
        return each(ghenv, "turn_quads", meshes, ["mesh"], turns=whole(turns, 1, "turns"))

    return (words.told(ghenv, work) or [None])[0]


def unroll_strips(ghenv, meshes, direction, gaps):
    """The strips of each mesh unrolled into the plane z = 0."""

    def work():
        given = {"direction": word(direction, ("warp", "weft"), "direction"), "gap": default(gaps, 0.0)}
        return each(ghenv, "unroll_strips", meshes, ["mesh"], **given)

    return (words.told(ghenv, work) or [None])[0]


def live_film(ghenv, meshes, lengths, volumes):
    """The soap film on each mesh, made again while it relaxes."""

    def work():
        if not listed(lengths):
            raise missing("length is missing; connect it")
        many = {"length": listed(lengths), "volume_factor": default(volumes, 0.0)}
        return each(ghenv, "live_film", meshes, ["mesh"], **many)

    return (words.told(ghenv, work) or [None])[0]


def remesh(ghenv, meshes, lengths, angles, rounds):
    """Each mesh as triangles with edges of about a length, folds above a number [rad] kept."""

    def work():
        if not listed(lengths):
            raise missing("length is missing; connect it")
        many = {"length": listed(lengths), "feature_angle": default(angles, 0.5235987755982988)}
        return each(ghenv, "remesh", meshes, ["mesh"], iterations=whole(rounds, 15, "iterations"), **many)

    return (words.told(ghenv, work) or [None])[0]
