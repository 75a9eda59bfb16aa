"""The geometry in a .3dm file, as Rhino's geometry by kind. For Python 2.7 to 3.13."""

import fnmatch
import hashlib
import os
import threading
import uuid
from collections import OrderedDict

from . import canvas_ask as asking
from .canvas_geometry import missing
from .canvas_packed import unpacked
from .canvas_values import whole
from . import canvas_words as words
from . import canvas_geometry as geometry
from .canvas_geometry import Unfit, listed

UNITS = {"Millimeters": "mm", "Centimeters": "cm", "Decimeters": "dm", "Meters": "m", "Kilometers": "km",
         "Inches": "in", "Feet": "ft", "Yards": "yd"}  # fmt: skip
FILES = 8  # whose geometry is kept
MANY = 5  # sentences on what cannot be meshed
_files, _lock = OrderedDict(), threading.Lock()


class Drawing(object):
    """What a file gave: lists by kind, names of all objects, the unit, and the layers with objects on them."""

    def __init__(self):
        self.names, self.layers, self.unit = [], [], None
        self.points, self.lines, self.curves, self.surfaces, self.meshes = [], [], [], [], []


def rhino_file(ghenv, given, layers, names, u, v):
    """What is drawn in a file on some layers, under some names; surfaces are meshed u by v. Empty until it is there."""
    return words.told(ghenv, lambda: _read(ghenv, given, layers, names, u, v)) or Drawing()


def _read(ghenv, given, layers, names, u, v):
    items = listed(given)
    if not items:
        raise missing("file is missing; give the path of a .3dm file")
    query = {"u": whole(u, 10, "u")[0], "v": whole(v, 10, "v")[0]}
    found = drawn(ghenv, file_of(ghenv, items[0]), query)
    if found is None:
        return None
    chosen = [one for one in found["objects"] if one["visible"]]
    there = _once(one["layer"] for one in chosen)
    for wanted, key, known in ((layers, "layer", there), (names, "name", _once(one["name"] for one in chosen))):
        chosen = _chosen(chosen, [_text(one) for one in listed(wanted)], key, known)
    made = Drawing()
    faults = [fault for fault in [_add(made, one) for one in chosen] if fault]
    for fault in faults[:MANY]:
        words.warning(ghenv, fault)
    if len(faults) > MANY:
        words.warning(ghenv, "%d more surfaces cannot be meshed." % (len(faults) - MANY))
    made.unit, made.layers = UNITS.get(found["unit"], found["unit"]), there
    for sentence in found["warnings"]:
        words.remark(ghenv, sentence)
    here = geometry.length_unit()
    if here is not None and here != made.unit:
        said = "The lengths of this file are in %s, those of the document in %s; they are not converted."
        words.warning(ghenv, said % (made.unit, here))
    return made


def _text(item):
    return item if isinstance(item, geometry.TEXT) else str(item)


def _once(items):
    seen = []
    for item in items:
        if item not in seen:
            seen.append(item)
    return seen


def _chosen(objects, patterns, key, known):
    """Objects whose layer or name fits one of the patterns; all where there are none."""
    if not patterns:
        return objects
    for pattern in patterns:
        if not any(_fits(one[key], pattern, key) for one in objects):
            names = ", ".join('"%s"' % name for name in known[:12] if name) or "none"
            raise Unfit('%s: no visible object is on "%s"; there are %s' % (key, pattern, names) if key == "layer"
                        else 'name: no object has the name "%s"; there are %s' % (pattern, names))  # fmt: skip
    return [one for one in objects if any(_fits(one[key], pattern, key) for pattern in patterns)]


def _fits(name, pattern, key):
    """Whether a name is a pattern, in which * stands for anything; a layer also by its last part, or those above."""
    name, pattern = name.lower(), pattern.strip().lower()
    names = [name]
    if key == "layer":
        parts = name.split("::")
        above = ["::".join(parts[: i + 1]) for i in range(len(parts))]
        names = above + parts
    return any(fnmatch.fnmatchcase(one, pattern.replace("[", "[[]")) for one in names)


def _add(made, one):
    """Put an object where it belongs; a sentence where it cannot be meshed."""
    kind = one["kind"]
    made.names.append(one["name"])
    if kind in ("point", "points"):
        made.points += [geometry.to_point(place) for place in one["points"]]
    elif kind in ("line", "polyline"):
        corners = one["points"]
        made.lines += [geometry.to_line(corners[i : i + 2]) for i in range(len(corners) - 1)]
        made.curves.append(geometry.to_polyline(corners))
    elif kind == "curve":
        made.curves.append(geometry.to_curve(one))
    elif kind == "mesh":
        made.meshes.append(geometry.to_mesh(one))
    else:
        if kind == "surface":
            made.surfaces.append(to_surface(one))
        if "mesh" in one:
            made.meshes.append(geometry.to_mesh(one["mesh"]))
        else:
            return "%s on layer %s: %s." % (one["name"] or "A " + kind, one["layer"], one.get("fault"))
    return None


def to_surface(plain):
    """NurbsSurface of degrees, points, knots and weights."""
    import Rhino.Geometry

    rows, columns = len(plain["points"]), len(plain["points"][0])
    weights = plain.get("weights")
    degrees = int(plain["degree_u"]), int(plain["degree_v"])
    kind = Rhino.Geometry.NurbsSurface
    made = kind.Create(3, weights is not None, degrees[0] + 1, degrees[1] + 1, rows, columns)
    for i in range(rows):
        for j in range(columns):
            x, y, z = [float(part) for part in plain["points"][i][j]]
            weight = float(weights[i][j]) if weights else 1.0
            if hasattr(made.Points, "SetPoint"):
                made.Points.SetPoint(i, j, x, y, z, weight)  # without the weight in it
            else:
                made.Points[(i, j)] = Rhino.Geometry.Point4d(x * weight, y * weight, z * weight, weight)
    for knots, wanted in ((made.KnotsU, plain["knots_u"]), (made.KnotsV, plain["knots_v"])):
        for i, knot in enumerate(wanted):
            knots[i] = float(knot)
    return made


# the file


def file_of(ghenv, given):
    """The path of a file: as given, or from the folder of the definition. `Unfit` where there is no such file."""
    name = os.path.expanduser(_text(given).strip().strip('"'))
    document = ghenv.Component.OnPingDocument()
    home = str(getattr(document, "FilePath", None) or "")
    places = [name] if os.path.isabs(name) else [os.path.join(os.path.dirname(home), name)] if home else []
    for place in places:
        if os.path.isfile(place):
            return place
    if not places:
        raise Unfit(
            'file: "%s" is relative to the definition; save the definition first, or give an absolute path' % name
        )
    raise Unfit("file: %s does not exist; check the path" % places[0])


def drawn(ghenv, place, query):
    """The geometry in a .3dm file (see the service's `POST /v1/geometry/3dm`); None until it is there."""
    try:
        told = os.stat(place)
    except EnvironmentError:
        raise Unfit("file: %s cannot be read" % place)
    text = repr((place, told.st_mtime, told.st_size, sorted(query.items())))
    signature = hashlib.sha1(text.encode("utf-8")).hexdigest()
    shared = _shared(signature)

    def work(client):
        with shared[0]:  # several components of a definition read the same file
            if len(shared) == 1:
                shared.append(_sent(client, place, query))
            return shared[1]

    return asking.ask(ghenv, (words.run_of(ghenv), "file"), signature, work)


def _shared(signature):
    """What all components know of a file: a lock, and what is drawn there once somebody asked."""
    with _lock:
        found = _files.pop(signature, None) or [threading.Lock()]
        _files[signature] = found
        while len(_files) > FILES:
            del _files[next(iter(_files))]
        return found


def _sent(client, place, query):
    with open(place, "rb") as file:
        data = file.read()
    line = uuid.uuid4().hex.encode("ascii")
    head = b'\r\nContent-Disposition: form-data; name="file"; filename="drawing.3dm"\r\n\r\n'
    body = b"--" + line + head + data + b"\r\n--" + line + b"--\r\n"
    kind = {"content-type": "multipart/form-data; boundary=" + line.decode("ascii")}
    asked = dict(query, arrays="buffer")
    return unpacked(client.request("POST", "/v1/geometry/3dm", body, asked, kind, timeout=300.0))
