"""What Grasshopper's Hops component does with a server, as a model: how it asks, and what it can make of an answer.

The rules are those of design/grasshopper.md 4.1, read from the component's source; whatever the component could not
use raises Unusable. `call` sends a request of httpx's kind: method, path, and JSON or none.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import rhino3dm

Tree = dict[str, list[Any]]

# ParamType, compared without regard to case -> the GUID of the parameter it becomes, where a sample shows it
PARAMETERS = {
    "Number": "3e8ca6be-fda8-4aaf-b5c0-3c54c8bb7312",
    "Point": "fbac3e32-f100-4292-8692-77240a42fd1a",
    "Curve": "d5967b9f-e8ee-436b-a8ad-29fdcecf32d5",
    "Surface": "deaf8653-5528-4286-807c-3de8b8dad781",
    "Brep": "919e146f-30ae-4aae-be34-4d72f555e7da",
    "Text": "3ede854e-c753-40eb-84cb-b48008f14fd4",
    "Integer": "2e3ab970-8545-46bb-836c-1c11e5610bce",
    **dict.fromkeys(("Arc", "Boolean", "Box", "Circle", "Line", "Mesh", "Plane", "Rectangle", "SubD", "Vector"), ""),
}
# what a parameter's own conversion takes
TAKES = {
    "Number": {"Number", "Integer"},
    "Integer": {"Integer"},
    "Boolean": {"Boolean"},
    "Text": {"Text"},
    "Point": {"Point"},
    "Vector": {"Vector"},
    "Line": {"Line"},
    "Plane": {"Plane"},
    "Curve": {"Curve", "Line"},
    "Surface": {"Brep"},
    "Mesh": {"Mesh"},
}
NET = {"Number": "System.Double", "Integer": "System.Int32", "Boolean": "System.Boolean", "Text": "System.String",
       "Point": "Rhino.Geometry.Point3d", "Vector": "Rhino.Geometry.Vector3d", "Line": "Rhino.Geometry.Line",
       "Plane": "Rhino.Geometry.Plane"}  # fmt: skip
GEOMETRY = {f"Rhino.Geometry.{name}" for name in ("Brep", "Curve", "Extrusion", "Mesh", "PolyCurve", "NurbsCurve",
                                                  "PolylineCurve", "SubD", "PointCloud")}  # fmt: skip


class Unusable(AssertionError):
    """The component fails on this, or treats the server as something else."""


@dataclass(frozen=True)
class Param:
    """A parameter as it stands on the component."""

    name: str
    nickname: str
    kind: str
    access: str
    least: int
    most: int
    default: Any
    minimum: float | None
    maximum: float | None


@dataclass
class Solved:
    """What a solution leaves on the component: branches by output, and its messages."""

    values: dict[str, Tree]
    errors: list[str]
    warnings: list[str]

    def all(self, name: str) -> list[Any]:
        """Every value of an output."""
        return [value for branch in self.values[name].values() for value in branch]

    def one(self, name: str) -> Any:
        """The only value of an output."""
        (value,) = self.all(name)
        return value


class Component:
    """A Hops component set to `path` on a server."""

    def __init__(self, call: Callable[..., Any], path: str) -> None:
        self.call, self.path = call, path
        answer = call("GET", path)
        if "json" not in answer.headers["content-type"].split(";")[0].lower():
            raise Unusable("no server of Hops: its address is sent to Rhino.Compute as a definition")
        if not answer.content:
            raise Unusable("a path to something that is not Hops related")
        said = json.loads(answer.content)
        if not isinstance(said, dict):
            raise Unusable("a description is one object")
        found = {key.lower(): value for key, value in said.items()}  # names are compared without regard to case
        self.errors = sentences(found.get("errors"))
        self.title, self.description = found.get("name"), found.get("description")
        icon = found.get("icon")
        if icon is not None and not re.fullmatch(r"[A-Za-z0-9+/]+=*", icon) and "xmlns" not in icon:
            raise Unusable("an icon is base64 of a PNG, or SVG")
        if not all(isinstance(found.get(side), list) for side in ("inputs", "outputs")):
            raise Unusable("without Inputs and Outputs the component fails with a null reference")
        self.inputs = _params(found["inputs"])
        self.outputs = _params(found["outputs"])

    def request(self, given: dict[str, Any], path: str = "{0}") -> dict[str, Any]:
        """What is posted: a value, a list, or a tree for each input, checked as the component checks them. An input
        that is left out has its default; None leaves it out of the request as well."""
        values = []
        for param in self.inputs:
            if param.name not in given and param.default is None and param.least > 0:
                raise Unusable(f"Input parameter {param.name} failed to collect data")
            value = given.get(param.name, param.default)
            if value is None and param.name in given:
                continue
            branch = [] if value is None else [value] if param.access == "item" else list(value)
            tree = value if _is_tree(value) else {path: branch}
            counted = sum(len(branch) for branch in tree.values())
            if param.access == "item" and counted != 1 or param.access != "tree" and len(tree) > 1:
                raise Unusable(f"{param.name} would be asked for once for each value or branch")
            if param.access == "list" and not param.least <= counted <= param.most:
                raise Unusable(f"{param.name}: {counted} values, {param.least} to {param.most} are needed")
            for number in [v for branch in tree.values() for v in branch if type(v) in (int, float)]:
                low, high = param.minimum, param.maximum
                if low is not None and number < low or high is not None and number > high:
                    raise Unusable(f"{param.name}: {number} is out of its bounds")
            inner = {p: [sent(param.kind, v) for v in branch] for p, branch in tree.items()}
            values.append({"ParamName": param.name, "InnerTree": inner})
        return {"absolutetolerance": 0.001, "angletolerance": 1.0, "modelunits": "Meters", "dataversion": 7,
                "algo": None, "pointer": self.path.removeprefix("/"), "cachesolve": False, "values": values,
                "warnings": [], "errors": []}  # fmt: skip

    def solve(self, given: dict[str, Any], path: str = "{0}") -> Solved:
        """One solution."""
        return self.post(self.request(given, path))

    def post(self, request: dict[str, Any]) -> Solved:
        """The answer to a request of any kind."""
        return self.read(self.call("POST", "/solve", request))

    def read(self, answer: Any) -> Solved:
        """What the component shows of an answer."""
        if answer.status_code == 408:
            raise Unusable("Request timeout")
        try:
            schema = json.loads(answer.content)
        except ValueError:
            raise Unusable("no JSON: the component fails with a null reference") from None
        if not isinstance(schema, dict):
            raise Unusable("no JSON object")
        errors, warnings = sentences(schema.get("errors")), sentences(schema.get("warnings"))
        if answer.status_code == 500 and errors[:1] == ["Bad inputs"]:
            raise Unusable("the component rebuilds itself")
        values = schema["values"]
        if len(values) != len(self.outputs) and not errors:
            raise Unusable("as many values as outputs are needed, or the component rebuilds itself")
        found = {}
        for entry in values:
            name = entry["ParamName"].removeprefix("RH_OUT:")
            (param,) = [p for p in self.outputs if p.name == name]
            found[name] = {path_of(key): [goo(item, param.kind) for item in items]
                           for key, items in entry["InnerTree"].items()}  # fmt: skip
        return Solved(found, errors, warnings)


def listed(call: Callable[..., Any]) -> list[Component]:
    """Every function of a server, as the function manager finds them."""
    answer = call("GET", "/")
    if "json" not in answer.headers["content-type"]:
        raise Unusable("no list")
    return [Component(call, one["Uri"]) for one in json.loads(answer.content)]


def sent(kind: str, value: Any) -> dict[str, str]:
    """A value as the component sends it: geometry as rhino3dm's Encode writes it, structures with more members than
    are needed. One that is a dict with `type` goes as it is."""
    if isinstance(value, dict) and set(value) == {"type", "data"}:
        return value
    if kind in ("Point", "Vector"):
        value = dict(zip("XYZ", map(float, value), strict=True))
    elif kind == "Line" and not hasattr(value, "Encode"):
        ends = [dict(zip("XYZ", map(float, end), strict=True)) for end in value]
        value = {"From": ends[0], "FromX": ends[0]["X"], "To": ends[1], "IsValid": True}
    elif kind == "Plane":
        rows = [dict(zip("XYZ", map(float, row), strict=True)) for row in value]
        value = {"Origin": rows[0], "XAxis": rows[1], "YAxis": rows[2], "ZAxis": rows[2], "OriginX": 0.0}
    elif hasattr(value, "Encode"):
        named = f"Rhino.Geometry.{type(value).__name__}"
        return {"type": named, "data": json.dumps({**value.Encode(), "archive3dm": 70})}
    return {"type": NET[kind], "data": json.dumps(value, ensure_ascii=False)}


def goo(item: Any, kind: str) -> Any:
    """A value of an answer as Grasshopper has it then, of a kind that the output takes."""
    if not isinstance(item, dict) or not isinstance(item.get("type"), str) or not isinstance(item.get("data"), str):
        raise Unusable(f"no value: {item}")
    made, value = _goo(item["type"], item["data"])
    if made not in TAKES[kind]:
        raise Unusable(f"{made} on an output of {kind}")
    return value


def _goo(kind: str, data: str) -> tuple[str, Any]:
    plain = data.strip('"')
    if kind == "System.Double":
        return "Number", float(_matched(r"[+-]?\d+(\.\d*)?([eE][+-]?\d+)?", plain))
    if kind == "System.Int32":
        number = int(_matched(r"[+-]?\d+", plain))
        if abs(number) >= 2**31:
            raise Unusable(f"{number} is no Int32")
        return "Integer", number
    if kind == "System.Boolean":
        return "Boolean", _matched(r"(?i:true|false)", plain).lower() == "true"
    if kind == "System.String":
        if json.loads(data) != plain:
            raise Unusable(f"a text is taken as it stands, escapes are not read: {data}")
        return "Text", plain
    if kind in ("Rhino.Geometry.Point3d", "Rhino.Geometry.Vector3d"):
        return "Point" if kind.endswith("Point3d") else "Vector", _row(json.loads(data))
    if kind == "Rhino.Geometry.Line":
        ends = json.loads(data)
        return "Line", [_row(ends["From"]), _row(ends["To"])]
    if kind == "Rhino.Geometry.Plane":
        axes = json.loads(data)
        return "Plane", [_row(axes[name]) for name in ("Origin", "XAxis", "YAxis")]
    if kind not in GEOMETRY:
        raise Unusable(f"unable to convert data of type {kind}")
    return _geometry(json.loads(data))


def _geometry(encoded: Any) -> tuple[str, Any]:
    if set(encoded) != {"version", "archive3dm", "opennurbs", "data"} or not 50 <= encoded["archive3dm"] <= 80:
        raise Unusable(f"no geometry: {set(encoded)}")
    found: Any = rhino3dm.CommonObject.Decode(encoded)
    name = type(found).__name__
    if isinstance(found, rhino3dm.Curve):
        return "Curve", found
    if name == "NurbsSurface":
        return "Brep", found  # becomes one
    if name not in ("Brep", "Mesh"):
        raise Unusable(f"geometry of type {name}")
    return name, found


def _row(value: Any) -> list[float]:
    row = [value[axis] for axis in "XYZ"]
    if not all(type(v) in (int, float) and abs(v) < float("inf") for v in row):
        raise Unusable(f"no coordinates: {value}")
    return row


def _matched(pattern: str, text: str) -> str:
    if not re.fullmatch(pattern, text):
        raise Unusable(f"{text!r} cannot be parsed")
    return text


def path_of(key: str) -> str:
    """A path: `0` and `{0}` are the same."""
    parts = [part for part in key.strip("{}").split(";") if part.strip()]
    return "{" + ";".join(str(int(_matched(r"\d+", part.strip()))) for part in parts) + "}"


def sentences(said: Any) -> list[str]:
    """Messages: a list of texts, or none."""
    if said is None:
        return []
    if not isinstance(said, list) or not all(isinstance(one, str) and one.strip() for one in said):
        raise Unusable(f"messages are texts: {said}")
    return said


def _params(described: Iterable[dict[str, Any]]) -> list[Param]:
    found: dict[str, Param] = {}
    known = {name.lower(): name for name in PARAMETERS}
    for one in described:
        if one["ParamType"].lower() not in known:
            raise Unusable(f"{one['ParamType']} becomes no parameter")
        if not isinstance(one["Name"], str) or not one["Name"] or one["Name"] in found:
            raise Unusable(f"a name of its own is needed: {one['Name']}")
        kind, least, most = known[one["ParamType"].lower()], one["AtLeast"], one["AtMost"]
        tree = one.get("TreeAccess") or least == most == -1
        access = "tree" if tree else "item" if least == most == 1 else "list"
        if access == "list" and not 0 <= least <= most <= 2**31 - 1:
            raise Unusable(f"counts of {least} to {most}")
        param = Param(one["Name"], one.get("Nickname") or one["Name"], kind, access, least, most, one.get("Default"),
                      one.get("Minimum"), one.get("Maximum"))  # fmt: skip
        _check_default(param)
        found[param.name] = param
    return list(found.values())


def _check_default(param: Param) -> None:
    """A default is a value of the parameter's own type, within its bounds."""
    types = {"Number": (int, float), "Integer": (int,), "Boolean": (bool,), "Text": (str,)}
    value = param.default
    if value is None:
        return
    if param.kind not in types or type(value) not in types[param.kind]:
        raise Unusable(f"{value!r} is no default of a {param.kind}")
    if param.minimum is not None and value < param.minimum or param.maximum is not None and value > param.maximum:
        raise Unusable(f"the default {value!r} is out of bounds")


def _is_tree(value: Any) -> bool:
    return isinstance(value, dict) and all(isinstance(key, str) and key.startswith("{") for key in value)
