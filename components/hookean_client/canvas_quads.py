"""Components that read the quads, edges and strips of meshes. For Python 2.7 to 3.13."""

from . import canvas_words as words
from .canvas_branches import column
from .canvas_discretize import answers, each
from .canvas_values import flag, word


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

    return (words.told(ghenv, work) or [None])[0]


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


def strips(ghenv, meshes, direction):
    """The number of the strip of each face of each mesh."""

    def work():
        return each(ghenv, "strips", meshes, ["strips"], direction=word(direction, ("warp", "weft"), "direction"))

    return (words.told(ghenv, work) or [None])[0]


def reciprocal_diagram(ghenv, meshes):
    """The reciprocal figure of each flat mesh, and the force densities of its inner edges."""
    return each(ghenv, "reciprocal_diagram", meshes, ["lines", "densities"])
