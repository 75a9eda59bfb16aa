"""Whatever trees Hops sends, of any paths, types and counts, with right and with wrong data: every answer is one that
its component can use, and every description one that it can become. A tenth of 600 trees in `make test`;
`make soak` all."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hookean.discretize.meshes import as_mesh
from hookean_server.hops.functions import FUNCTIONS
from hookean_server.workers.discretize_task import OPERATIONS
from serving import SOAK

from .hops_canvas import Component, goo, listed, sent
from .hops_inside import Service, functions
from .hops_recording import OURS

TREES = 600 if SOAK else 24
LASTING = {"ribbon", "hypar_net", "chains_between_frames", "bridge_skin", "falling_sphere"}


@pytest.fixture(scope="module")
def service() -> Iterator[Service]:
    with functions({**FUNCTIONS, **OURS}):
        yield Service()


def component(service: Service, name: str) -> Component:
    if "/" not in name:
        return Component(service.call, f"/{name}")
    known = replace(OURS[name], title="A name of two parts has no address of its own here")
    with functions({"parts": known}):
        found = Component(Service().call, "/parts")
    found.call, found.path = service.call, f"/{name}"
    return found


# descriptions


def test_every_description_becomes_a_component_that_tells_all() -> None:
    """Types, accesses and defaults that Hops knows; every number has its unit, every input a word."""
    with functions(FUNCTIONS):
        found = {one.path.strip("/"): one for one in listed(Service().call)}
    assert set(found) == set(FUNCTIONS)
    for name, one in found.items():
        assert one.title and one.description and one.outputs and one.errors == []
        for side in (one.inputs, one.outputs):
            nicknames = [param.nickname for param in side]
            assert len(set(nicknames)) == len(nicknames) and max(map(len, nicknames)) <= 3, (name, nicknames)
        declared = FUNCTIONS[name].inputs + FUNCTIONS[name].outputs
        for param, known in zip([*one.inputs, *one.outputs], declared, strict=True):
            assert (param.name, param.kind, param.least, param.most) == (
                known.name,
                known.kind,
                known.least,
                known.most,
            )
            assert param.access in ("item", "list") and len(known.description) > 5, (name, param)
            if param.kind in ("Number", "Vector"):
                assert "[" in known.description, (name, known.description)
        needed = [param.name for param in one.inputs if param.default is None and param.least > 0]
        assert needed or FUNCTIONS[name].group == "Figures", name


def test_every_operation_is_a_function_and_every_figure_is_told_of() -> None:
    page = (Path(__file__).parents[2] / "docs" / "service.md").read_text(encoding="utf-8")
    assert set(OPERATIONS) <= set(FUNCTIONS)
    assert all(f"`{name}`" in page for name in FUNCTIONS if name not in OPERATIONS)


# every operation as a function


def quads() -> Any:
    mesh: Any = rhino3dm.Mesh()
    for i, j in np.ndindex(4, 3):
        mesh.Vertices.AddPoint3d(i / 3.0 + 1e6, float(j), 0.1 * i * j)
    for i, j in np.ndindex(3, 2):
        mesh.Faces.AddFace(3 * i + j, 3 * i + j + 3, 3 * i + j + 4, 3 * i + j + 1)
    return mesh


def curve() -> Any:
    return rhino3dm.NurbsCurve.Create(False, 3, [rhino3dm.Point3d(i, i * i % 3, 0.5 * i) for i in range(5)])


def polyline() -> Any:
    return rhino3dm.PolylineCurve([rhino3dm.Point3d(i, i % 2, 0) for i in range(4)])


def surface() -> Any:
    ends = [rhino3dm.LineCurve(rhino3dm.Point3d(0, y, 0), rhino3dm.Point3d(3, y, y)) for y in (0, 2)]
    return rhino3dm.NurbsSurface.CreateRuledSurface(*ends)


def flat() -> Any:
    """Two squares side by side."""
    mesh = rhino3dm.Mesh()
    for x, y in ((0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)):
        mesh.Vertices.Add(float(x), float(y), 0.0)
    mesh.Faces.AddFace(0, 1, 4, 3)
    mesh.Faces.AddFace(1, 2, 5, 4)
    return mesh


def brep() -> Any:
    return rhino3dm.Brep.CreateFromSurface(surface())


POINTS = [(0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (3.0, 1.0, 1.0), (3.0, 1.0, 1.0)]
LINES = [[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)], [(1.0, 0.0, 0.0), (0.0, 0.0, 0.0)], [(1.0, 0.0, 0.0), (1.0, 5.0, 0.0)]]
TAKEN = {"curve": curve, "surface": surface, "mesh": quads, "points": lambda: POINTS, "lines": lambda: LINES,
         "meshes": lambda: [quads(), quads()]}  # fmt: skip
FOLD = ([(1.0, 0.0, 0.0)] * 4, [(0.0, 0.0, 9.0)] * 4, [(0.5, -7.0, 2.0)] * 4)
MORE: dict[str, Any] = {
    "fold_angle": dict(zip(("Fold end", "Tip 1", "Tip 2"), FOLD, strict=True)),
    "remesh": {"Length": 1.0},
    "live_film": {"Length": 0.8},
    "moebius_transformation": {"Angle": 0.4},
    "pipes": {"Radius": 0.1},
    "mesh_map": {"Source": quads, "Target": quads},
}
"""Options that have no default, as Hops sends them."""
MADE = {
    "explode": polyline,
    "pipes": lambda: LINES[1:],
    "bipartite": lambda: LINES[1:],
    "reciprocal_diagram": flat,
    "split_at_corners": polyline,
    "fold_angle": lambda: [(0.0, 0.0, 0.0)] * 4,
    "arc": lambda: POINTS[:3],
    "mesh_faces": brep,
    "interpolate": lambda: POINTS[:3],
}
DIRECT = ("points", "lines", "warp_naked", "weft_naked", "pattern", "first", "second", "angles", "normals")
DIRECT += ("first_points", "second_points", "strips", "densities")
OWN = [name for name in OPERATIONS if name != "catenary"]  # which is one of its own


@pytest.mark.thinned
@pytest.mark.parametrize("name", OWN)
def test_an_operation_gives_what_its_function_gives(name: str, service: Service) -> None:
    """To the bit, with its options at their defaults."""
    operation, function = OPERATIONS[name], FUNCTIONS[name]
    one = component(service, name)
    geometry = MADE.get(name, TAKEN[operation.takes])()
    more = {key: value() if callable(value) else value for key, value in MORE.get(name, {}).items()}
    found = one.solve({function.inputs[0].name: geometry, **more})
    assert found.errors == found.warnings == []
    options = {key: 10 if default is None else default for key, (_, default) in operation.options.items()}
    source = np.array(geometry) if isinstance(geometry, list) else geometry
    if operation.takes in ("mesh", "meshes"):
        source = doubles(geometry) if operation.takes == "mesh" else [doubles(each) for each in geometry]
    for value, (key, _) in zip(more.values(), operation.options.items(), strict=False):
        options[key] = (
            np.array(value) if isinstance(value, list) else doubles(value) if hasattr(value, "Faces") else value
        )
    truth = operation.function(source, **options)
    truths = truth if len(operation.gives) > 1 else (truth,)
    expected = [plain(gives, value, source) for gives, value in zip(operation.gives, truths, strict=True)]
    outputs = iter(function.outputs)
    for parts in expected:
        for part in parts:
            output = next(outputs)
            values = found.all(output.name)
            values = [corners(one) for one in values] if output.kind == "Curve" else values
            assert (shape(values[0]) if output.kind == "Mesh" else values) == part, output.name
    assert next(outputs, None) is None


def doubles(mesh: Any) -> Any:
    """A mesh of rhino3dm, whose items have single precision."""
    rows = [(p.X, p.Y, p.Z) for p in mesh.Vertices.ToPoint3dArray()]
    return as_mesh((np.array(rows), [mesh.Faces[i] for i in range(len(mesh.Faces))]))


def corners(curve: Any) -> list[list[float]]:
    """The corners of a polyline."""
    return [[p.X, p.Y, p.Z] for p in (curve.Point(i) for i in range(curve.PointCount))]


def plain(gives: str, value: Any, source: Any) -> list[Any]:
    """What an operation gives, as the outputs have it."""
    if gives == "length":
        return [[value]]
    if gives == "mesh":
        return [shape(value)]
    if gives == "triangles":
        return [shape(as_mesh((source.vertices, value)))]
    if gives == "neighbours":
        return [[index for ring in value for index in ring.tolist()], [len(ring) for ring in value]]
    if gives == "polylines":
        return [[part.tolist() for part in value]]
    rows = np.asarray(value)
    if gives in DIRECT:
        return [rows.tolist()]
    places = source.vertices[rows].tolist()
    if gives == "edges":
        return [places, rows[:, 0].tolist(), rows[:, 1].tolist()]
    return [places] if gives in ("warp", "weft") else [places, rows.tolist()]


def shape(mesh: Any) -> Any:
    if hasattr(mesh, "Vertices"):
        rows = [[p.X, p.Y, p.Z] for p in mesh.Vertices.ToPoint3dArray()]
        return rows, as_mesh((np.array(rows), [mesh.Faces[i] for i in range(len(mesh.Faces))])).faces.tolist()
    return mesh.vertices.tolist(), mesh.faces.tolist()


def test_a_brep_of_one_face_is_its_surface(service: Service) -> None:
    """As which Grasshopper sends surfaces."""
    one = component(service, "mesh_surface")
    found, truth = (shape(one.solve({"Surface": given}).one("Mesh")) for given in (brep(), surface()))
    assert found == truth and len(found[0]) == 121


def test_a_tree_keeps_its_paths(service: Service) -> None:
    given = {"{3;0;1}": [1.0], "{0}": [2.0, 3.0], "{7}": []}
    assert component(service, "tree").solve({"T": given}).values["T"] == {
        "{3;0;1}": [2.0],
        "{0}": [4.0, 6.0],
        "{7}": [],
    }


# random trees


def decimals(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers as a slider has them, of six digits after the point."""
    return st.floats(low, high).map(lambda value: max(low, round(value, 6)))


NUMBERS = st.one_of(decimals(-1e6, 1e6), st.integers(-5, 20), decimals(0.1, 20.0))
ROWS = st.tuples(*[st.one_of(decimals(-100.0, 100.0), st.integers(-3, 3))] * 3)
RIGHT: dict[str, st.SearchStrategy[Any]] = {
    "Number": NUMBERS,
    "Integer": st.integers(-1, 12),
    "Boolean": st.booleans(),
    "Text": st.one_of(st.text(max_size=8), st.sampled_from(["both", "one", "none", "rim", "corners"])),
    "Point": ROWS,
    "Vector": ROWS,
    "Line": st.one_of(st.tuples(ROWS, ROWS), st.builds(polyline)),
    "Plane": st.tuples(ROWS, ROWS, ROWS),
    "Curve": st.one_of(st.builds(curve), st.builds(polyline)),
    "Surface": st.one_of(st.builds(surface), st.builds(brep)),
    "Mesh": st.builds(quads),
}
DAMAGED = json.dumps({"version": 10000, "archive3dm": 90, "opennurbs": 5, "data": "AAAA"})
RAW = ["", "null", "NaN", "1e999", "[]", "{}", '"x"', "true", "[1, 2, 3]", '{"X": 1}', '{"X": 1, "Y": "a", "Z": 0}',
       '{"From": {"X": 0, "Y": 0, "Z": 0}, "To": 1}', '{"archive3dm": 70}', "[" * 200, DAMAGED, "\ud800"]  # fmt: skip
WRONG = st.one_of(
    st.sampled_from(RAW).map(lambda data: {"type": "System.Double", "data": data}),
    st.sampled_from([None, 5, "x", [], {}, {"type": "System.Double"}, {"data": 5}, {"type": 1, "data": "1"}]),
    st.sampled_from(sorted(RIGHT)).flatmap(lambda kind: RIGHT[kind].map(lambda value: sent(kind, value))),
)
PATHS = st.lists(st.integers(0, 40), min_size=1, max_size=4).map(lambda p: "{" + ";".join(map(str, p)) + "}")
ODD = st.sampled_from(["{0}", "0", "{}", "{ 0 ; 1 }", "{-1}", "x", ""])
HEADS: dict[str, st.SearchStrategy[Any]] = {
    "absolutetolerance": st.sampled_from([0.001, 0.1, 0, -1, "x", None]),
    "modelunits": st.sampled_from(["Meters", "Millimeters", "Feet", "Parsecs", "None", 5, None]),
    "algo": st.none(),
    "errors": st.just([]),
}


@st.composite
def requests(draw: st.DrawFn, name: str, one: Component) -> dict[str, Any]:
    """A request of a function, more or less as its component would send it."""
    values = []
    faulty = draw(st.booleans())
    for param in one.inputs:
        kinds = ["right", "empty", "wrong", "odd", "absent", "many"]
        how = draw(st.sampled_from(kinds)) if faulty and draw(st.booleans()) else "right"
        loose = how == "absent" or how == "right" and param.least == 0 or param.default is not None
        if how == "absent" or loose and draw(st.booleans()):
            continue
        values.append({"ParamName": draw(st.sampled_from(["", "RH_IN:"])) + param.name,
                       "InnerTree": {} if how == "empty" else draw(trees(param, how))})  # fmt: skip
    extra = [{"ParamName": "Other", "InnerTree": {"{0}": [1]}}, {"ParamName": None}, 5, {"InnerTree": {"{0}": 1}}]
    values += draw(st.lists(st.sampled_from([*extra, *values[:1]]), max_size=1)) if faulty else []
    head = draw(st.fixed_dictionaries({}, optional=HEADS))
    return {**head, "pointer": draw(st.sampled_from(["", "/"])) + name, "values": draw(st.permutations(values))}


def trees(param: Any, how: str) -> st.SearchStrategy[dict[str, Any]]:
    """Branches of one input: as it takes them, or more of them, of wrong values or with odd paths."""
    items = RIGHT[param.kind]
    if how == "right" and param.kind in ("Number", "Integer") and param.minimum is not None:
        high = min(param.minimum + 12 if param.maximum is None else param.maximum, param.minimum + 12)
        low = max(int(param.minimum), 3)
        items = st.integers(low, max(int(high), low)) if param.kind == "Integer" else decimals(param.minimum, high)
    given = WRONG if how == "wrong" else items.map(lambda value: sent(param.kind, value))
    paths = ODD if how == "odd" else PATHS
    if param.access == "item" and how != "many":
        return st.dictionaries(paths, st.lists(given, min_size=1, max_size=1), min_size=1, max_size=1)
    return st.dictionaries(paths, st.lists(given, min_size=1, max_size=4), min_size=1, max_size=3)


def test_any_tree_has_an_answer_that_the_component_can_use(service: Service) -> None:
    """Values for every output, or sentences; never a page, a failure of the service or a word of its insides; the same
    again to the byte. Of what is drawn a good part is right, so that both kinds of answers are seen."""
    seen: Counter[int] = Counter()

    @settings(max_examples=TREES, deadline=None, derandomize=not SOAK, suppress_health_check=list(HealthCheck))
    @given(data=st.data())
    def answered(data: st.DataObject) -> None:
        name = data.draw(st.sampled_from(sorted(({*FUNCTIONS} - LASTING) | {*OURS})))
        one = component(service, name)
        request = data.draw(requests(name, one))
        if name in ("arc_frames", "bouncing_cable"):
            given = {"ParamName": "Time", "InnerTree": {"{0}": [sent("Number", 0.1)]}}
            request["values"] = [v for v in request["values"] if "Time" not in str(v)] + [given]
        answer = service.call("POST", "/solve", request)
        seen[answer.status_code] += 1
        check(service, one, request, answer)

    answered()
    assert set(seen) == {200, 422} and min(seen.values()) > 0.2 * seen.total() and seen.total() >= TREES


def check(service: Service, one: Component, request: dict[str, Any], answer: Any) -> None:
    """An answer that the component can use."""
    assert answer.status_code in (200, 422), answer.text[:600]
    found = one.read(answer)
    if answer.status_code == 200:
        assert list(found.values) == [param.name for param in one.outputs] and found.errors == []
        assert service.call("POST", "/solve", request).content == answer.content
    else:
        assert found.values == {} and len(found.errors) == 1
        assert not any(word in found.errors[0] for word in ("Traceback", "Error", "object at 0x")), found.errors
    assert all(len(said) < 1000 for said in found.errors + found.warnings)


def test_the_model_takes_each_kind_as_it_was_sent() -> None:
    """What is sent of a kind would be taken back on an output of it."""
    for kind, value in {"Number": 2.5, "Integer": 3, "Boolean": True, "Text": "é", "Point": [1.0, 2.0, 3.0]}.items():
        assert goo(sent(kind, value), kind) == value
