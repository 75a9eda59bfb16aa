"""Runs the code of components in any Python from 2.7 on, with stand-ins for Rhino and Grasshopper and nothing else.

    python -I isolated.py stand_in.py < request.json

A request has `steps`, one component each: {"name", "code", "inputs": {name: value}, "outputs": [names], "guid",
"solutions": 400, "seconds": 60.0}, and `path` of the definition and `document`, its id. Values are plain, or geometry:
{"Point3d": [x, y, z]}, {"Vector3d": ...}, {"Line": [[..], [..]]}, {"Polyline": [..]}, {"Mesh": {"vertices", "faces"}},
{"NurbsCurve": {"degree", "points", "knots", "weights"}}, trees {"DataTree": {"{0}": [..]}}, or
{"output": [number of a step, name]}. The answer has a list of {"outputs", "messages", "message", "solutions"}. Standard
library; can be run by its path.
"""

import json
import sys
import time
import types
import uuid

now = getattr(time, "monotonic", time.time)


def stand_ins():
    """The module `stand_in` of the canvas."""
    path = sys.argv[1]
    module = types.ModuleType("stand_in")
    with open(path) as file:
        exec(compile(file.read(), path, "exec"), module.__dict__)
    return module


def execute(code, scope):
    """Run code in a scope; a function of its own, as Jython has no exec where names are closed over."""
    exec(code, scope)


class Run(object):
    """The components of a request in one process, as in Rhino."""

    def __init__(self, request):
        self.kinds = stand_ins()
        self.kinds.Canvas().install()
        identity = request.get("document")
        self.document = self.kinds.Document(request.get("path"), uuid.UUID(identity) if identity else None)
        self.steps = []

    def step(self, step):
        """Solve a component until nothing is scheduled, or as often and long as it may; its answer."""
        guid = uuid.UUID(step["guid"]) if step.get("guid") else uuid.uuid5(uuid.NAMESPACE_URL, str(step["name"]))
        names = sorted(step.get("inputs", {}))
        component = self.kinds.Component(step["name"], None, names, step["outputs"], guid, self.document)
        given = {name: self.value(value) for name, value in step.get("inputs", {}).items()}
        code = compile(step["code"], step["name"], "exec")
        until, count = now() + step.get("seconds", 60.0), 0
        while True:
            component.messages, self.document.scheduled = [], []
            scope = dict(given, ghenv=self.kinds.Environment(component), __name__="__main__")
            execute(code, scope)
            count += 1
            if not self.document.scheduled or count >= step.get("solutions", 400) or now() > until:
                break
            milliseconds, callback = self.document.scheduled[0]
            time.sleep(milliseconds / 1000.0)
            callback(self.document)
        outputs = {name: scope.get(name) for name in step["outputs"]}
        self.steps.append(outputs)
        plain = {name: self.plain(value) for name, value in outputs.items()}
        return {"outputs": plain, "messages": component.messages, "message": component.Message, "solutions": count}

    def value(self, given):
        """What an input gets."""
        if isinstance(given, list):
            return [self.value(one) for one in given]
        if not isinstance(given, dict):
            return given
        [(name, parts)] = given.items()
        return getattr(self, "_" + name.lower())(parts)

    def _output(self, parts):
        return self.steps[parts[0]][parts[1]]

    def _point3d(self, parts):
        return self.kinds.Point3d(*parts)

    def _vector3d(self, parts):
        return self.kinds.Vector3d(*parts)

    def _line(self, parts):
        return self.kinds.Line(*[self.kinds.Point3d(*end) for end in parts])

    def _polyline(self, parts):
        return self.kinds.PolylineCurve([self.kinds.Point3d(*corner) for corner in parts])

    def _mesh(self, parts):
        made = self.kinds.Mesh()
        for vertex in parts["vertices"]:
            made.Vertices.Add(*vertex)
        for face in parts["faces"]:
            made.Faces.AddFace(*face)
        return made

    def _nurbscurve(self, parts):
        made = self.kinds.NurbsCurve(3, True, parts["degree"] + 1, len(parts["points"]))
        weights = parts.get("weights") or [1.0] * len(parts["points"])
        for i, (place, weight) in enumerate(zip(parts["points"], weights)):
            made.Points.SetPoint(i, *(list(place) + [weight]))
        made.Knots = list(parts["knots"])
        return made

    def _nurbssurface(self, parts):
        rows = parts["points"]
        orders = parts["degree_u"] + 1, parts["degree_v"] + 1
        made = self.kinds.NurbsSurface(3, False, orders[0], orders[1], len(rows), len(rows[0]))
        for i, row in enumerate(rows):
            for j, place in enumerate(row):
                made.Points.SetPoint(i, j, *place)
        made.KnotsU, made.KnotsV = list(parts["knots_u"]), list(parts["knots_v"])
        return made

    def _datatree(self, parts):
        tree = self.kinds.DataTree()
        for path in sorted(parts):
            place = tree.EnsurePath(*[int(part) for part in path.strip("{}").split(";")])
            for item in parts[path]:
                tree.Add(self.value(item), place)
        return tree

    def plain(self, value):
        """A value as JSON has it."""
        kinds, kind = self.kinds, type(value).__name__
        if isinstance(value, (kinds.Point3d, kinds.Vector3d)):
            return {kind: [value.X, value.Y, value.Z]}
        if isinstance(value, kinds.Line):
            return {kind: [self.plain(end)["Point3d"] for end in (value.From, value.To)]}
        if isinstance(value, (kinds.PolylineCurve, kinds.Polyline)):
            corners = value.TryGetPolyline()[1] if isinstance(value, kinds.PolylineCurve) else value
            return {"Polyline": [self.plain(corner)["Point3d"] for corner in corners]}
        if isinstance(value, kinds.NurbsCurve):
            places = [self.plain(one.Location)["Point3d"] for one in value.Points]
            weights = [one.Weight for one in value.Points]
            return {kind: {"degree": value.Degree, "points": places, "knots": list(value.Knots), "weights": weights}}
        if isinstance(value, kinds.NurbsSurface):
            grid = value.Points
            places = [[self.plain(grid.GetControlPoint(i, j).Location)["Point3d"] for j in range(grid.CountV)]
                      for i in range(grid.CountU)]  # fmt: skip
            degrees = {"degree_u": value.Degree(0), "degree_v": value.Degree(1)}
            return {kind: dict(degrees, points=places, knots_u=list(value.KnotsU), knots_v=list(value.KnotsV))}
        if isinstance(value, kinds.Mesh):
            vertices = [[vertex.X, vertex.Y, vertex.Z] for vertex in value.Vertices]
            return {kind: {"vertices": vertices, "faces": [[f.A, f.B, f.C, f.D] for f in value.Faces]}}
        if isinstance(value, kinds.DataTree):
            return {kind: {str(path): self.plain(value.Branch(path)) for path in value.Paths}}
        if isinstance(value, dict):
            return {name: self.plain(one) for name, one in value.items()}
        if isinstance(value, (list, tuple)):
            return [self.plain(one) for one in value]
        return value


def main():
    """Answer the request on standard input."""
    request = json.loads(sys.stdin.read())
    run = Run(request)
    sys.stdout.write(json.dumps([run.step(step) for step in request["steps"]]))


if __name__ == "__main__":
    main()
