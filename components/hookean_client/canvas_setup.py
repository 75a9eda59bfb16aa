"""Anchors as components get them, and sentences that name components. For Python 2.7 to 3.13."""

from . import canvas_geometry as geometry
from .canvas_scene import read

MANY = 8  # sentences on forces and anchors with points that met nothing


def anchors(ghenv, given):
    """Anchors {"name", "group", "label", "branch", "point", "target", "axes"} in the order they come."""
    found = []
    for path, items in geometry.branches(given):
        owners = _owners(ghenv, "anchors_", path, len(items))
        for number, item in enumerate(items):
            item = geometry.value(item)
            if item is None:
                continue
            if isinstance(item, geometry.TEXT) and '"kind"' in item:
                [value] = read([item], "anchors", "anchors_")
                source, ones = value["source"], value["items"]
                owner, branch = (source["component"], source["title"]), "run %d" % source["run"]
                rows = [(branch, i, one["point"], one["target"], one["axes"]) for i, one in enumerate(ones)]
            else:
                owner, first = owners[number]
                rows = [(path, number - first, geometry.point(item), None, "xyz")]
            for place, i, point, target, axes in rows:
                group = "%s %s" % (owner[0], place)
                label = "anchor %d of %s, branch %s" % (i, owner[1] or "anchors_", place)
                found.append({"name": "%s %d" % (group, i), "group": group, "label": label, "branch": path,
                              "point": point, "target": target, "axes": axes})  # fmt: skip
    return found


def _owners(ghenv, name, path, count):
    """For each item of a branch who it comes from, as (id, name), and the number of the first item from there."""
    params = [one for one in ghenv.Component.Params.Input if name in (one.NickName, one.Name)]
    sources = list(params[0].Sources) if params else []
    found = []
    for source in sources:
        owner = (str(source.InstanceGuid), str(getattr(source, "NickName", "")))
        size = count if len(sources) == 1 else _size(source, path)
        found += [(owner, len(found))] * size
    if len(found) != count:
        found = [(("input", name), 0)] * count
    return found


def _size(source, path):
    """How many items a source has on a path."""
    data = getattr(source, "VolatileData", None)
    if data is None:
        return 0
    for i, known in enumerate(data.Paths):
        if str(known) == path:
            return len(list(data.get_Branch(known) if hasattr(data, "get_Branch") else data.Branches[i]))
    return 0


def placed(forces, anchors, said):
    """A sentence on a scene of these forces and anchors with the names of components in the place of pointers."""
    for i, one in enumerate(forces):
        title = one["source"]["title"]
        for name in ("points", "lines", "mesh"):
            said = said.replace("/forces/%d/%s: %s: " % (i, name, one.get("name") or title), title + ": ")
        said = said.replace("/forces/%d/" % i, title + ", ")
    for i, one in enumerate(anchors):
        said = said.replace("/anchors/%d/points: %s: " % (i, one["name"]), one["label"] + ": ")
    said = said.replace("/settings/", "Settings, ").replace("weld_tolerance", "the tolerance in Settings")
    return said[:1].upper() + said[1:]


def sentences(report, forces, anchors):
    """The sentences of a report: what met no particle, a sentence for each force and anchor, then warnings."""
    missed = [placed(forces, anchors, one["message"]) + "." for one in report["missed"]]
    if len(missed) > MANY:
        missed[MANY:] = ["%d more forces or anchors have points that met no particle." % (len(missed) - MANY)]
    return missed + [placed(forces, anchors, one) for one in report["warnings"]]
