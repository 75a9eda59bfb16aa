"""Operations of the service on geometry, as Rhino's geometry. For Python 2.7 to 3.13."""

import json

from . import canvas_ask as asking
from . import canvas_geometry as geometry
from . import canvas_words as words
from .canvas_branches import column
from .canvas_geometry import Unfit, listed, matched, missing
from .canvas_packed import packed, unpacked

TAKES = dict(
    [(name, "curve") for name in ("divide", "shatter", "explode", "end_points", "length", "split_at_corners")]
    + [(name, "surface") for name in ("mesh_surface", "mesh_faces")]
    + [(name, "points") for name in ("remove_duplicate_points", "arc", "interpolate", "fold_angle", "mesh_map")]
    + [(name, "points") for name in ("interconnect_points", "moebius_transformation")]
    + [(name, "lines") for name in ("remove_duplicate_lines", "catenary", "bipartite", "pipes")]
    + [("clean", "meshes")]
)  # what an operation takes; all others take a mesh
SHAPES = {"source": "mesh", "target": "mesh", "end": "points", "tip_1": "points", "tip_2": "points",
          "vertices": "indices"}  # fmt: skip
WHOLE = ("count", "u", "v", "degree", "level", "iterations", "sides", "turns")  # options that are whole numbers


def discretize(ghenv, operation, item, many=False, **options):
    """What an operation of the service makes of geometry, as Rhino's geometry by name; None until it is there. With
    `many`, one for each item of a list, options matched to the items."""
    return words.told(ghenv, lambda: _discretize(ghenv, operation, item, many, options))


def each(ghenv, operation, items, gives, **options):
    """An output for each name in `gives`: what an operation makes of the items of a branch, None until it is there.

    Lists of one item are a list; those of several have a branch for each item, below that of the items.
    """
    found = answers(ghenv, operation, items, **options)
    return [found and column(ghenv, [one[name] for one in found]) for name in gives]


def answers(ghenv, operation, items, **options):
    """What an operation makes of each item of a branch; None until all are there."""
    found = discretize(ghenv, operation, items, many=True, **options)
    return None if found is None or None in found else found


def _discretize(ghenv, operation, item, many, options):
    takes = TAKES.get(operation, "mesh")
    if not listed(item):
        raise missing("%s is missing; connect %s" % (takes, "one" if takes in ("curve", "surface") else "it"))
    each = listed(item) if many else [item]
    names = sorted(name for name in options if options[name] is not None)
    columns = [listed(options[name]) if many else [options[name]] for name in names]
    rows = matched(each, *columns)
    bodies = []
    for i, one in enumerate(rows[0]):
        body = {name: _option(name, column[i]) for name, column in zip(names, rows[1:])}
        bodies.append(dict(body, **{takes: _plain(takes, one)}))

    def work(client):
        path = "/v1/discretize/" + operation
        return [client.post(path, packed(body), {"arrays": "buffer"}, timeout=600.0) for body in bodies]

    signature = asking.digest(json.dumps([operation, bodies], sort_keys=True))
    found = asking.ask(ghenv, (words.run_of(ghenv), operation), signature, work)
    if found is None:
        return None
    made = [_made(unpacked(one)) for one in found]
    return made if many else made[0]


def _plain(takes, item):
    if takes == "lines":
        return geometry.lines(item)[0]
    if takes == "points":
        return geometry.points(item)
    if takes == "meshes":
        return [geometry.mesh(one) for one in listed(item)]
    if takes == "indices":
        return [int(geometry.number(one)) for one in listed(item)]
    return getattr(geometry, takes)(item if takes == "mesh" else listed(item)[0])


def _option(name, value):
    """An option as JSON has it: whole numbers stay whole, vectors become lists, one of a list stands alone."""
    if name in SHAPES:
        return _plain(SHAPES[name], value)
    items = [geometry.value(value)] if geometry.is_point(value) else listed(value)
    if len(items) > 1:
        return [_option(name, one) for one in items]
    value = items[0]
    if hasattr(value, "X") and hasattr(value, "Z"):
        return geometry.point(value)
    if isinstance(value, (bool,) + geometry.TEXT):
        return value
    try:
        value = geometry.number(value)
    except Unfit as unfit:
        raise Unfit("%s: %s" % (name, unfit))
    return int(value) if value == int(value) and name in WHOLE else value


def _made(answer):
    """Rhino's geometry of an answer by the names in it."""
    found = {}
    for name, value in answer.items():
        if name.endswith("polylines"):
            value = [geometry.to_polyline(one) for one in value]
        elif name.endswith("points"):
            value = [geometry.to_point(one) for one in value]
        elif name.endswith("lines"):
            value = [geometry.to_line(one) for one in value]
        elif name == "mesh":
            value = geometry.to_mesh(value)
        elif name == "normals":
            value = [geometry.to_vector(one) for one in value]
        found[name] = value
    return found
