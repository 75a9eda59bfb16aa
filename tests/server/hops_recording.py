"""The components of the recorded traffic, made again: once for ghhops-server, once for ours."""

from __future__ import annotations

from typing import Any

from hookean.errors import InputError
from hookean_server.hops.model import Function, Parameter, item

TREE = {"least": -1, "most": -1}
BOTH = (
    ("I", "Integer"),
    ("F", "Boolean"),
    ("T", "Text"),
    ("P", "Point"),
    ("V", "Vector"),
    ("L", "Line"),
    ("PL", "Plane"),
)


def reference() -> Any:
    """A server of ghhops-server with the components; `solve` and `query` are its own."""
    import ghhops_server as hs
    import rhino3dm

    hops = hs.Hops()
    tree = hs.HopsParamAccess.TREE
    summands = [hs.HopsNumber("A", "A", "First"), hs.HopsNumber("B", "B", "Second", optional=True)]

    @hops.component("/add", name="Add", nickname="Add", description="Add numbers",
                    inputs=summands, outputs=[hs.HopsNumber("Sum", "S", "A+B")])  # fmt: skip
    def add(a: float, b: float = 2.0) -> float:
        return a + b

    echoed = [hs.HopsInteger, hs.HopsBoolean, hs.HopsString, hs.HopsPoint, hs.HopsVector, hs.HopsLine, hs.HopsPlane]
    sides = [[kind(name) for (name, _), kind in zip(BOTH, echoed, strict=True)] for _ in range(2)]

    @hops.component("/sub/types", name="Types", inputs=sides[0], outputs=sides[1])
    def types(i: Any, f: Any, t: Any, p: Any, v: Any, line: Any, plane: Any) -> Any:
        return i, f, t, p, v, line, plane

    @hops.component("/pts", name="Pts", inputs=[hs.HopsPoint("P", "P", "pts", hs.HopsParamAccess.LIST)],
                    outputs=[hs.HopsPoint("P"), hs.HopsInteger("N")])  # fmt: skip
    def pts(points: Any) -> Any:
        return [rhino3dm.Point3d(p.X, p.Y, p.Z + 1.0) for p in points], len(points)

    @hops.component("/tree", name="Tree", inputs=[hs.HopsNumber("T", "T", "tree", tree)],
                    outputs=[hs.HopsNumber("T", "T", "tree", tree)])  # fmt: skip
    def doubled(given: Any) -> Any:
        return {path: [2.0 * v for v in branch] for path, branch in given.items()}

    @hops.component("/mesh", name="Mesh", inputs=[hs.HopsMesh("M")], outputs=[hs.HopsMesh("M"), hs.HopsInteger("N")])
    def mesh(given: Any) -> Any:
        return given, len(given.Vertices)

    @hops.component("/crv", name="Crv", inputs=[hs.HopsCurve("C"), hs.HopsNumber("t")],
                    outputs=[hs.HopsPoint("P"), hs.HopsCurve("C")])  # fmt: skip
    def crv(curve: Any, t: float) -> Any:
        return curve.PointAt(t), curve

    @hops.component("/boom", name="Boom", inputs=[hs.HopsNumber("A")], outputs=[hs.HopsNumber("A")])
    def boom(a: float) -> Any:
        raise ValueError("no cables")

    return hops


def _plain(name: str, kind: str, **more: Any) -> Parameter:
    return item(name, None, kind, None, **more)  # type: ignore[arg-type]


def _boom(inputs: Any, cancelled: Any) -> Any:
    raise InputError("/A", "no cables")


def _add(inputs: Any, cancelled: Any) -> Any:
    return {"Sum": inputs.one("A") + inputs.one("B")}


def _types(inputs: Any, cancelled: Any) -> Any:
    found = {name: inputs.one(name) for name, _ in BOTH}
    found["L"] = found["L"][0]  # a line may be several pieces
    return found


def _pts(inputs: Any, cancelled: Any) -> Any:
    found = inputs.points("P")
    return {"P": found + [0.0, 0.0, 1.0], "N": len(found)}


def _tree(inputs: Any, cancelled: Any) -> Any:
    return {"T": {path: [2.0 * v for v in branch] for path, branch in inputs.tree("T").items()}}


def _mesh(inputs: Any, cancelled: Any) -> Any:
    return {"M": inputs.one("M"), "N": len(inputs.one("M").vertices)}


def _crv(inputs: Any, cancelled: Any) -> Any:
    point = inputs.one("C").PointAt(inputs.one("t"))
    return {"P": [point.X, point.Y, point.Z], "C": inputs.one("C")}


_SIDES = tuple(_plain(name, kind) for name, kind in BOTH)
_TREE = Parameter("T", "T", "Number", "tree", **TREE)

OURS: dict[str, Function] = {
    "add": Function("Add", "Add", "Add numbers",
                    (item("A", "A", "Number", "First"), item("B", "B", "Number", "Second", 2.0)),
                    (item("Sum", "S", "Number", "A+B"),), _add),
    "sub/types": Function("Types", "Types", "", _SIDES, _SIDES, _types),
    "pts": Function("Pts", "Pts", "", (Parameter("P", "P", "Point", "pts"),),
                    (Parameter("P", "P", "Point", ""), _plain("N", "Integer")), _pts),
    "tree": Function("Tree", "Tree", "", (_TREE,), (_TREE,), _tree),
    "mesh": Function("Mesh", "Mesh", "", (_plain("M", "Mesh"),), (_plain("M", "Mesh"), _plain("N", "Integer")), _mesh),
    "crv": Function("Crv", "Crv", "", (_plain("C", "Curve"), _plain("t", "Number")),
                    (_plain("P", "Point"), _plain("C", "Curve")), _crv),
    "boom": Function("Boom", "Boom", "", (_plain("A", "Number"),), (_plain("A", "Number"),), _boom),
}  # fmt: skip
