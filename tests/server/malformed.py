"""Malformed scenes: a table of bodies, each with the beginning of the pointer that must be named."""

from __future__ import annotations

import base64
import copy
import json
from typing import Any

import numpy as np

GOOD: dict[str, Any] = {
    "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
    "velocities": [[0, 0, 0], [0, 0, 0], [0, 0, 0]],
    "masses": [1, 1, 1],
    "meshes": {"m": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2]]}},
    "forces": [
        {
            "kind": "springs",
            "particles": [[0, 1], [1, 2]],
            "stiffness": [1, 1],
            "damping": 1,
            "rest_length": 1,
            "rest_factor": 1,
            "plasticity": 0,
        },
        {"kind": "unary", "particles": [1], "vector": [0, 0, -1]},
        {"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]]]},
        {"kind": "self_weight", "total": 1, "direction": [0, 0, -1]},
        {"kind": "anchor_spring", "points": [[0, 0, 0]], "strength": 1},
    ],
    "anchors": [{"particles": [0, 2], "targets": [[0, 0, 0], [2, 0, 0]], "axes": "xyz"}],
    "geometry": [{"kind": "polyline", "particles": [0, 1, 2]}],
    "settings": {"solver": "auto", "tolerance": 1e-6, "max_iterations": 1000, "time_step": 0.01, "drag": 1},
    "units": {"length": "m", "force": "N"},
    "weld_tolerance": 0.001,
}


def put(path: str, token: str) -> bytes:
    """The good scene with the raw JSON text `token` at a pointer."""
    scene = copy.deepcopy(GOOD)
    steps = [int(s) if s.isdigit() else s for s in path.strip("/").split("/")]
    place: Any = scene
    for step in steps[:-1]:
        place = place[step]
    place[steps[-1]] = "@@"
    return json.dumps(scene).replace('"@@"', token).encode()


NUMBERS = [  # places of single numbers
    "/particles/1/2",
    "/velocities/0/0",
    "/masses/1",
    "/meshes/m/vertices/2/0",
    "/forces/0/stiffness/1",
    "/forces/0/damping",
    "/forces/0/rest_length",
    "/forces/1/vector/2",
    "/forces/2/lines/0/1/0",
    "/forces/3/total",
    "/forces/3/direction/0",
    "/forces/4/strength",
    "/forces/4/points/0/1",
    "/anchors/0/targets/1/1",
    "/settings/tolerance",
    "/settings/time_step",
    "/weld_tolerance",
]
NOT_NUMBERS = ["NaN", "Infinity", "-Infinity", "1e999", '"x"', "[[[1]]]", "{}"]
INDICES = ["/forces/0/particles/1/1", "/forces/1/particles/0", "/anchors/0/particles/1", "/geometry/0/particles/2"]
NOT_INDICES = ["-1", "3", "99999999999", "9" * 30, "9" * 6000, "1.5", '"1"', "null", "NaN", "[0, 0]"]
ARRAYS = [
    "/particles",
    "/velocities",
    "/forces/0/particles",
    "/forces/1/vector",
    "/anchors/0/targets",
    "/meshes/m/faces",
]
NOT_ARRAYS = ['"text"', "5", "true", "[[0,0,0],[1]]", '{"a":1}', '[["a","b","c"]]', "[[[[0]]]]"]


def buffer(**changes: Any) -> str:
    data = base64.b64encode(np.zeros((3, 3)).tobytes()).decode()
    return json.dumps({"dtype": "<f8", "shape": [3, 3], "base64": data} | changes)


def table() -> dict[str, tuple[bytes, str]]:
    """Name: body and the beginning of its pointer."""
    cases: dict[str, tuple[bytes, str]] = {}

    def add(name: str, body: bytes | str, pointer: str = "/") -> None:
        assert name not in cases
        cases[name] = (body.encode() if isinstance(body, str) else body, pointer)

    for path in NUMBERS:
        for token in NOT_NUMBERS:
            constant = token.lstrip("-")[0] in "NI"
            add(f"number {path} {token}", put(path, token), "/" if constant else "/" + path.split("/")[1])
    for path in NUMBERS[:14]:
        if path != "/forces/3/total":
            add(f"huge {path}", put(path, "1e308"), "/" + path.split("/")[1])
    for path in INDICES:
        for token in NOT_INDICES:
            add(
                f"index {path} {token[:20]} {len(token)}",
                put(path, token),
                "/",
            )
    for path in ARRAYS:
        for token in NOT_ARRAYS:
            add(f"array {path} {token}", put(path, token), "/" + path.split("/")[1])
    for path in ("/forces/0/stiffness/0", "/forces/0/damping", "/masses/0", "/settings/drag", "/weld_tolerance"):
        add(f"negative {path}", put(path, "-1"), "/" + path.split("/")[1])
    for path, token in [
        ("/masses/0", "0"),
        ("/masses", "[1, 1]"),
        ("/masses", "[]"),
        ("/velocities", "[[0, 0, 0]]"),
        ("/forces/0/particles", "[[0, 1, 2]]"),
        ("/forces/0/particles", "[0, 1]"),
        ("/forces/0/stiffness", "[1, 1, 1]"),
        ("/forces/0/stiffness", "[]"),
        ("/forces/0/kind", '"spring"'),
        ("/forces/0/kind", "5"),
        ("/forces/0/kind", "null"),
        ("/forces/0/kind", json.dumps("x" * 100_000)),
        ("/forces/0/kind", '"\\ud800"'),
        ("/forces/0", "{}"),
        ("/forces/0", "[]"),
        ("/forces/0", "null"),
        ("/forces/1", '{"kind": "unary", "particles": [0]}'),
        ("/forces/1", '{"kind": "unary", "vector": [0, 0, 1]}'),
        ("/forces/1", '{"kind": "unary", "particles": [0], "points": [[0, 0, 0]], "vector": [0, 0, 1]}'),
        ("/forces/1/vector", "[0, 0]"),
        ("/forces/1/vector", "[]"),
        ("/forces/2", '{"kind": "springs", "mesh": "other"}'),
        ("/forces/2", '{"kind": "springs", "mesh": 5}'),
        ("/forces/2", '{"kind": "springs", "mesh": "m", "edges": "some"}'),
        ("/forces/2/lines", "[[[0, 0, 0]]]"),
        ("/forces/3/direction", "[0, 0, 0]"),
        ("/forces", "{}"),
        ("/forces", "null"),
        ("/forces", '"springs"'),
        ("/anchors", "{}"),
        ("/anchors/0", "{}"),
        ("/anchors/0/targets", "[[0, 0, 0]]"),
        ("/anchors/0/axes", '"xyzz"'),
        ("/anchors/0/axes", "7"),
        ("/meshes", "[]"),
        ("/meshes/m", "{}"),
        ("/meshes/m", "null"),
        ("/meshes/m/faces", "[[0, 1]]"),
        ("/meshes/m/faces", "[[0, 1, 3]]"),
        ("/meshes/m/faces", "[[0, 1, -2]]"),
        ("/meshes/m/faces", "[[0, 1, 2, 0, 1]]"),
        ("/meshes/m/faces", "[0, 1, 2]"),
        ("/meshes/m", '{"dtype": "evil/Mesh", "data": {}}'),
        ("/meshes/m", '{"dtype": "compas.geometry/Point", "data": [0, 0, 0]}'),
        ("/meshes/m", '{"dtype": "compas.datastructures/Mesh", "data": {}}'),
        ("/meshes/m", '{"dtype": "compas.datastructures/Mesh", "data": {"vertex": {}, "face": {"0": [0, 1, 2]}}}'),
        ("/meshes/m", '{"dtype": "compas.datastructures/Mesh", "data": {"vertex": {"0": {"x": 1e999}}, "face": {}}}'),
        ("/geometry/0/kind", '"sphere"'),
        ("/geometry/0", '{"kind": "mesh", "mesh": "other"}'),
        ("/geometry/0", '{"kind": "lines", "particles": [0, 1, 2]}'),
        ("/settings/solver", '"guess"'),
        ("/settings/max_iterations", "1.5"),
        ("/settings/max_iterations", "-1"),
        ("/settings/max_iterations", "1" + "0" * 30),
        ("/settings/tolerance", "2"),
        ("/settings", "[]"),
        ("/units/length", '"furlong"'),
        ("/units", '"m"'),
        ("/extra", "1"),
        ("/settings/extra", "1"),
        ("/forces/0/extra", "1"),
        ("/" + "x" * 50_000, "1"),
        ("/particles", buffer(dtype="<f16")),
        ("/particles", buffer(dtype="|O")),
        ("/particles", buffer(dtype=None)),
        ("/particles", buffer(shape=[3, 4])),
        ("/particles", buffer(shape=[-3, 3])),
        ("/particles", buffer(shape=[2**50, 3])),
        ("/particles", buffer(shape="33")),
        ("/particles", buffer(shape=[9])),
        ("/particles", buffer(base64="@@@")),
        ("/particles", buffer(base64="AAAA")),
        ("/particles", buffer(base64=None)),
        ("/particles", buffer(base64="ä")),
        ("/particles", buffer(base64=base64.b64encode(np.full((3, 3), np.nan).tobytes()).decode())),
        ("/particles", buffer(base64=base64.b64encode(np.full((3, 3), -np.inf).tobytes()).decode())),
        ("/particles", buffer(base64=base64.b64encode(np.full((3, 3), 1e300).tobytes()).decode())),
        ("/particles", buffer(more=1)),
        ("/particles", "[" * 60 + "]" * 60),
        ("/particles", "[" * 900 + "]" * 900),
        ("/particles", "[" * 200_000 + "]" * 200_000),
        ("/particles", "[" * 200_000),
        ("/name", '{"a":' * 100_000 + "1" + "}" * 100_000),
    ]:
        add(f"{path[:30]} {len(path)} {token[:60]} {hash(token) % 10**6}", put(path, token))
    good = json.dumps(GOOD)
    for name, body in {
        "empty": "",
        "space": "   ",
        "null": "null",
        "number": "5",
        "text": '"scene"',
        "list": "[]",
        "list of scenes": f"[{good}]",
        "two scenes": good + good,
        "comma": good[:-1] + ",}",
        "comment": "// a scene\n" + good,
        "single quotes": good.replace('"', "'"),
        "yaml": "particles:\n  - [0, 0, 0]\n",
        "half": good[: len(good) // 2],
        "one less": good[:-1],
        "one more": good + "}",
        "repeated key": '{"particles": [[0, 0, 0]], "particles": []}',
        "repeated key inside": put("/settings", '{"drag": 1, "drag": 2}'),
        "repeated kind": put("/forces/1", '{"kind": "unary", "kind": "unary", "particles": [0], "vector": [0, 0, 1]}'),
        "control character": good.replace('"m"', '"m\x01"'),
        "bad escape": '{"a": "\\q"}',
        "half an escape": '{"a": "\\u12"}',
        "leading zeros": put("/weld_tolerance", "01"),
        "hexadecimal": put("/weld_tolerance", "0x1"),
        "plus": put("/weld_tolerance", "+1"),
        "dot": put("/weld_tolerance", ".5"),
        "bad UTF-8": b'{"a": "\xff"}',
        "overlong UTF-8": b'{"a": "\xc0\xaf"}',
        "UTF-16": good.encode("utf-16"),
        "two byte order marks": 2 * b"\xef\xbb\xbf" + good.encode(),
        "zero bytes": b"\0" * 1000,
        "gzip": b"\x1f\x8b\x08\x00" + b"\0" * 100,
        "spaces, 40 MB": b" " * 40_000_000,
        "numbers, 40 MB": b'{"particles": [' + b"[0,0,0]," * 5_000_000 + b"[0,0,0]]}",
        "brackets, 15 MB": b"[" * 15_000_000,
        "text, 15 MB": b'{"name": "' + b"x" * 15_000_000 + b'"}',
    }.items():
        add(name, body)
    return cases
