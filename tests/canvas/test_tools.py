"""Components that discretize: the numbers of the core, in branches as Grasshopper has them, and one sentence for what
does not fit."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from canvas.canvasing import Bench, let_go, line, point, sentences, xyz
from hookean.discretize import curves, interpolate, meshes, meshing, nurbs_surface, unique_lines, warp_weft
from hookean.discretize.catenary import catenary
from hookean.files.rhino import threedm
from hookean.values.mesh import Mesh
from hookean_canvas.components import bundles
from hookean_canvas.run import stand_in
from hookean_client import canvas_file, canvas_geometry
from serving import Home
from soak import examples

OURS = ("Divide", "Shatter", "Catenary", "MeshSurface", "MeshEdges", "MeshVertices", "MeshCorners", "NakedVertices",
        "WarpWeft", "Diagonals", "RemoveDuplicateLines", "Interpolate", "Sweep", "RhinoFile", "RemoveDuplicatePoints",
        "CombineClean", "Refine", "RefineStrips", "Diagonalize", "Checkerboard", "HingePoints", "FoldAngle",
        "VertexNeighbours", "MeshMap", "SplitAtCorners", "Remesh", "Counter", "Sequence", "Trail",
        "Grab", "InterconnectPoints", "Bipartite", "MoebiusTransformation", "Pipes", "AlignQuads", "TurnQuads",
        "Strips", "UnrollStrips", "ReciprocalDiagram", "LiveFilm")  # fmt: skip
EXAMPLES = Path(__file__).parents[2] / "gh_examples"
BENT = [(0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (3.0, 4.0, 1.0)]
QUADS = Mesh(
    np.array([[i, j, 0.1 * i * j] for i in range(4) for j in range(3)], dtype=float),
    np.array([[3 * i + j, 3 * i + j + 3, 3 * i + j + 4, 3 * i + j + 1] for i in range(3) for j in range(2)]),
)
SQUARE = Mesh(np.array([[0, 0, 5], [1, 0, 5], [1, 1, 5], [0, 1, 5]], dtype=float), np.array([[0, 1, 2, 3]]))


@pytest.fixture(scope="module", autouse=True)
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """A server that the components find."""
    patch = pytest.MonkeyPatch()
    found = Home(tmp_path_factory.mktemp("state"))
    found.serve()
    patch.setenv("HOOKEAN_STATE", str(found.folder))
    yield found
    let_go()
    patch.undo()
    found.end()


@pytest.fixture(params=["stand-ins", "rhino3dm"])
def rhino(request: pytest.FixtureRequest) -> Iterator[Any]:
    """Rhino.Geometry: of the stand-ins, and rhino3dm's."""
    made = stand_in.Canvas(rhino3dm if request.param == "rhino3dm" else None).install()
    yield made.modules["Rhino.Geometry"]
    made.remove()


class Placed:
    """A component of a bundle on a canvas."""

    def __init__(self, name: str, bench: Bench | None = None) -> None:
        self.bundle = bundles.read(name)
        self.bench = bench or Bench()
        self.ghenv = self.bench.component(self.bundle.nickname, tuple(p.name for p in self.bundle.inputs))
        self.code = compile(self.bundle.code, name, "exec")

    def once(self, **inputs: Any) -> dict[str, Any]:
        """What its code leaves in its outputs."""
        known = {parameter.name: None for parameter in (*self.bundle.inputs, *self.bundle.outputs)}
        assert set(inputs) <= set(known)
        scope = {**known, **inputs, "ghenv": self.ghenv}
        exec(self.code, scope)
        return {parameter.name: scope[parameter.name] for parameter in self.bundle.outputs}

    def run(self, until: Any = None, **inputs: Any) -> dict[str, Any]:
        """The same, once nothing is scheduled."""
        found: dict[str, Any] = self.bench.run(self.ghenv, lambda: self.once(**inputs), until)
        return found


def run(name: str, **inputs: Any) -> dict[str, Any]:
    """Outputs of a component that says nothing."""
    placed = Placed(name)
    found = placed.run(**inputs)
    assert not placed.ghenv.Component.messages
    return found


def said(name: str, **inputs: Any) -> str:
    """The one sentence of a component that has no outputs."""
    placed = Placed(name)
    found = placed.run(**inputs)
    assert all(value in (None, []) for value in found.values()), found
    [sentence] = sentences(placed.ghenv)
    return sentence


def places(points: Any) -> Any:
    return np.array([xyz(one) for one in points])


def ends(lines: Any) -> Any:
    return np.array([[xyz(one.From), xyz(one.To)] for one in lines])


def as_mesh(mesh: Mesh) -> Any:
    return canvas_geometry.to_mesh({"vertices": mesh.vertices.tolist(), "faces": mesh.faces.tolist()})


def branches(tree: Any) -> dict[str, Any]:
    return {str(path): list(tree.Branch(path)) for path in tree.Paths}


def test_divide_and_shatter(rhino: Any) -> None:
    bent = rhino.PolylineCurve([point(*corner) for corner in BENT])
    assert (places(run("Divide", _curve=[bent], _count_=[7])["points"]) == curves.divide(BENT, 7)).all()
    assert len(run("Divide", _curve=[line((0, 0, 0), (1, 0, 0))], _count_=[])["points"]) == 11
    found = run("Shatter", _curve=[bent], _count_=[7.0])
    wanted = curves.shatter(BENT, 7)
    assert (ends(found["lines"]) == wanted).all()
    assert found["lengths"] == pytest.approx(np.linalg.norm(wanted[:, 1] - wanted[:, 0], axis=1).tolist())
    exploded = run("Shatter", _curve=[bent], _count_=["0"])
    assert (ends(exploded["lines"]) == curves.explode(BENT)).all()
    assert exploded["lengths"] == [3.0, pytest.approx(17**0.5)]


def test_several_curves_have_a_branch_each_in_their_order(rhino: Any) -> None:
    lines = [line((0, 0, k), (10, 0, k)) for k in range(3)]
    found = branches(run("Divide", _curve=lines, _count_=[1, 2, 3])["points"])
    assert list(found) == ["{0;0}", "{0;1}", "{0;2}"]
    assert [len(row) for row in found.values()] == [2, 3, 4]
    assert [row[0].Z for row in found.values()] == [0, 1, 2]
    bent = rhino.PolylineCurve([point(*corner) for corner in BENT])
    mixed = branches(run("Shatter", _curve=[lines[0], bent, lines[1]], _count_=[2, 0, 1])["lines"])
    assert [len(row) for row in mixed.values()] == [2, 2, 1]


corner = st.tuples(*[st.floats(-100, 100).map(lambda x: round(x, 2))] * 3)
polyline = st.lists(corner, min_size=2, max_size=5, unique=True)


@settings(max_examples=examples(15), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(rows=st.lists(polyline, min_size=1, max_size=4), counts=st.lists(st.integers(1, 30), max_size=6))
def test_any_curves_and_counts_are_matched_by_the_longest_list(rhino: Any, rows: Any, counts: list[int]) -> None:
    given_curves = [rhino.PolylineCurve([point(*place) for place in row]) for row in rows]
    found = run("Divide", _curve=given_curves, _count_=counts)["points"]
    most = max(len(rows), len(counts))
    each = [(rows[min(i, len(rows) - 1)], (counts or [10])[min(i, len(counts or [10]) - 1)]) for i in range(most)]
    wanted = [curves.divide(row, count) for row, count in each]
    parts = [found] if most == 1 else list(branches(found).values())
    assert len(parts) == most
    assert all((places(part) == one).all() for part, one in zip(parts, wanted, strict=True))


def test_a_branch_is_below_the_one_it_comes_from(rhino: Any) -> None:
    """In the second of two branches."""
    placed = Placed("MeshVertices")
    tree = stand_in.DataTree()
    for path in ((0, 3), (2, 1)):
        tree.AddRange([1, 2], stand_in.GH_Path(*path))
    placed.ghenv.Component.Params.Input[0].VolatileData = tree
    placed.ghenv.Component.RunCount = 2
    found = placed.once(_mesh=[as_mesh(SQUARE), as_mesh(QUADS)])["points"]
    assert list(branches(found)) == ["{2;1;0}", "{2;1;1}"]


def test_catenary(rhino: Any) -> None:
    vector = rhino.Vector3d(0, 1, -3)
    given = {"_start": [point(0, 0, 0)], "_end": [point(5, 0, 1)], "_length": [8.0], "_count_": [6]}
    found = run("Catenary", **given, _gravity_=[vector])
    wanted = catenary([0, 0, 0], [5, 0, 1], 8.0, count=6, gravity=[0, 1, -3])
    assert (places(found["points"]) == wanted).all()
    assert (ends(found["lines"]) == np.stack([wanted[:-1], wanted[1:]], axis=1)).all()
    several = run("Catenary", **{**given, "_end": [point(5, 0, 1), point(4, 1, 0)], "_length": [8, "9"]})
    assert (places(branches(several["points"])["{0;1}"]) == catenary([0, 0, 0], [4, 1, 0], 9.0, count=6)).all()
    assert len(several["catenary"]) == 2
    assert said("Catenary", _start=[point(0, 0, 0)], _end=[point(5, 0, 0)], _length=[4]) == (
        "Length 0: 4 given; the ends are 5 apart and no shorter cable joins them. Give at least that, or bring the "
        "ends nearer."
    )


def test_interpolate(rhino: Any) -> None:
    corners = [(0, 0, 0), (1, 2, 0), (3, 1, 1), (4, 0, 0)]
    found = run("Interpolate", _points=[point(*corner) for corner in corners], _count_=[9])["curve"]
    assert (np.array(canvas_geometry.polyline(found)) == interpolate(corners, 9)).all()


def test_mesh_surface(rhino: Any) -> None:
    form = {"degree_u": 1, "degree_v": 2, "points": [[[i, j, i * j] for j in range(3)] for i in range(2)],
            "knots_u": [0.0, 1.0], "knots_v": [0.0, 0.0, 2.0, 2.0],
            "weights": [[1.0, 0.5, 1.0], [1.0, 1.0, 2.0]]}  # fmt: skip
    surface = canvas_file.to_surface(form)
    [mesh] = run("MeshSurface", _surface=[surface], _u_=[3])["mesh"]
    wanted = meshing.mesh_surface(nurbs_surface(**form), 3, 10)
    found = canvas_geometry.mesh(mesh)
    assert np.allclose(found["vertices"], wanted.vertices, atol=1e-14) and found["faces"] == wanted.faces.tolist()
    assert len(run("MeshSurface", _surface=[surface] * 2, _u_=[1, 2])["mesh"]) == 2


def test_parts_of_meshes(rhino: Any) -> None:
    mesh, v = as_mesh(QUADS), QUADS.vertices
    found = run("MeshEdges", _mesh=[mesh])
    assert (ends(found["edges"]) == v[meshes.edges(QUADS)]).all()
    assert (ends(found["naked"]) == v[meshes.naked_edges(QUADS)]).all()
    assert (places(run("MeshVertices", _mesh=[mesh])["points"]) == v).all()
    corners = run("MeshCorners", _mesh=[mesh])
    assert corners["indices"] == meshes.corners(QUADS).tolist() == [0, 2, 9, 11]
    assert (places(corners["corners"]) == v[corners["indices"]]).all()
    assert run("MeshCorners", _mesh=[mesh], _angle_=[3.5])["indices"] == meshes.corners(QUADS, 3.5).tolist()
    assert run("MeshCorners", _mesh=[mesh], _order_=["boundary"])["indices"] == [0, 9, 11, 2]
    sides = run("NakedVertices", _mesh=[mesh])
    assert sides["naked_index"] == meshes.naked_vertices(QUADS).tolist()
    assert sides["clothed_index"] == meshes.clothed_vertices(QUADS).tolist() == [4, 7]
    assert (places(sides["clothed_points"]) == v[[4, 7]]).all()
    assert (places(sides["naked_points"]) == v[sides["naked_index"]]).all()
    for pattern, name in (([], "both"), ([1], "one"), (["Other"], "other")):
        found = run("Diagonals", _mesh=[mesh], _pattern_=pattern)["diagonals"]
        assert (ends(found) == v[meshes.diagonals(QUADS, name)]).all()


def test_warp_and_weft(rhino: Any) -> None:
    found = run("WarpWeft", _mesh=[as_mesh(QUADS)])
    for name, edges in zip(("warp", "weft"), warp_weft(QUADS), strict=True):
        assert (ends(found[name]) == QUADS.vertices[edges]).all()
        naked = {tuple(pair) for pair in meshes.naked_edges(QUADS).tolist()}
        assert found[f"{name}_naked"] == [tuple(pair) in naked for pair in edges.tolist()]
    fan = Mesh(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [-1, 1, 0], [-1, 0, 0], [0, -1, 0]], float),
               np.array([[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 1]]))  # fmt: skip
    assert "warp and weft cannot agree" in said("WarpWeft", _mesh=[as_mesh(fan)])
    assert run("WarpWeft", _mesh=[as_mesh(fan)], _strict_=[False])["warp"]


def test_duplicate_lines(rhino: Any) -> None:
    given = [line((0, 0, 0), (1, 0, 0)), line((1, 0, 0.009), (0, 0, 0)), line((2, 0, 0), (1, 0, 0)),
             line((0, 0, 0.02), (1, 0, 0))]  # fmt: skip
    found = ends(run("RemoveDuplicateLines", _lines=given)["lines"])
    rows = ends(given)
    assert (found == rows[unique_lines(rows, 0.01)[0]]).all() and len(found) == 3
    assert len(run("RemoveDuplicateLines", _lines=given, _tolerance_=[0.1])["lines"]) == 2


@pytest.mark.parametrize(
    ("name", "inputs", "sentence"),
    [
        ("Divide", {}, "Curve is missing; connect one."),
        ("Divide", {"_curve": ["x"]}, 'The text "x" is not a curve; connect a curve.'),
        ("Divide", {"_curve": 1, "_count_": [0]}, "Count: 0 given; a whole number from 1 on is expected."),
        ("Divide", {"_curve": 1, "_count_": [2.5]}, "Count: 2.5 given; a whole number from 1 on is expected."),
        ("Divide", {"_curve": 1, "_count_": ["many"]}, 'Count: the text "many" is not a number.'),
        ("Shatter", {"_curve": []}, "Curve is missing; connect one."),
        ("Catenary", {"_start": ["0,0,0"], "_end": ["1,0,0"]}, "Length is missing; connect it."),
        ("MeshEdges", {"_mesh": []}, "Mesh is missing; connect it."),
        ("MeshVertices", {"_mesh": ["x"]}, 'The text "x" is not a mesh; connect a mesh.'),
        ("Diagonals", {"_mesh": 2, "_pattern_": [3]},
         "Pattern: 3 is unknown; give one of 0 both, 1 one, 2 other."),
        ("RhinoFile", {}, "File is missing; give the path of a .3dm file."),
        ("RhinoFile", {"_file": ["model.3dm"]},
         'File: "model.3dm" is relative to the definition; save the definition first, or give an absolute path.'),
        ("RhinoFile", {"_file": ["/nowhere/model.3dm"]}, "File: /nowhere/model.3dm does not exist; check the path."),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_one_sentence(rhino: Any, name: str, inputs: dict[str, Any], sentence: str) -> None:
    stand: dict[Any, Any] = {1: [line((0, 0, 0), (1, 0, 0))], 2: [as_mesh(SQUARE)]}
    given = {key: stand.get(value, value) if isinstance(value, int) else value for key, value in inputs.items()}
    placed = Placed(name, Bench(path=None))
    found = placed.run(**given)
    assert sentences(placed.ghenv) == [sentence]
    assert all(value in (None, []) for value in found.values())


def test_a_rhino_file_gives_what_is_drawn(rhino: Any) -> None:
    """Beside the definition, by layer and name; surfaces as surfaces and as meshes."""
    bench = Bench(str(EXAMPLES / "9.32-ribbon" / "definition.gh"))
    found = Placed("RhinoFile", bench).run(_file=["model.3dm"], _u_=[6], _v_=[4])
    drawn = threedm.read(EXAMPLES / "9.32-ribbon" / "model.3dm").foreign()
    assert found["names"] == [item.name for item in drawn] and found["unit"] == "m"
    assert found["layers"] == ["beams", "arcs::ends", "arcs::inner", "membrane"]
    bent = [item for item in drawn if item.kind == "NurbsCurve"]
    for mine, item in zip(found["curves"], bent, strict=True):
        plain = canvas_geometry.curve(mine)
        assert np.array(plain["points"]).shape == (len(item.geometry.Points), 3)
    wanted = meshing.mesh_surface(drawn[-1].geometry, 6, 4)
    [mesh] = found["meshes"]
    assert np.allclose(canvas_geometry.mesh(mesh)["vertices"], wanted.vertices, atol=1e-13)
    again = run("MeshSurface", _surface=found["surfaces"], _u_=[6], _v_=[4])["mesh"][0]
    assert np.allclose(canvas_geometry.mesh(again)["vertices"], wanted.vertices, atol=1e-13)
    some = Placed("RhinoFile", bench).run(_file=["model.3dm"], layer_=["inner"])
    assert some["names"] == [f"arc {i}" for i in range(2, 11)]
    assert Placed("RhinoFile", bench).run(_file=["model.3dm"], layer_=["arcs"], name_=["arc 1*"])["names"] == [
        "arc 1", "arc 10", "arc 11",
    ]  # fmt: skip


def test_a_rhino_file_says_what_there_is(tmp_path: Path) -> None:
    made = stand_in.Canvas().install()
    try:
        model = str(EXAMPLES / "9.7-anchors-moved" / "model.3dm")
        assert said("RhinoFile", _file=[model], layer_=["right", "roof"]) == (
            'Layer: no visible object is on "roof"; there are "cable", "left", "right".'
        )
        lines = run("RhinoFile", _file=[model], layer_=["cable"])
        assert len(lines["lines"]) == 1 and len(lines["curves"]) == 1
        assert len(run("RhinoFile", _file=[model], layer_=["left", "right"])["points"]) == 2
        damaged = tmp_path / "damaged.3dm"
        damaged.write_bytes(Path(model).read_bytes()[:3000])
        assert said("RhinoFile", _file=[str(damaged)]).startswith("File: ")
    finally:
        made.remove()


def test_surfaces_that_cannot_be_meshed_are_named(tmp_path: Path) -> None:
    """Trimmed Breps without a cached mesh: the first five each in a sentence, the rest counted."""
    made, file = stand_in.Canvas().install(), rhino3dm.File3dm()
    for number in range(7):
        attributes = rhino3dm.ObjectAttributes()
        attributes.Name = f"lid {number}"
        circle = rhino3dm.Circle(rhino3dm.Point3d(5.0 * number, 0, 0), 2.0).ToNurbsCurve()
        file.Objects.AddBrep(rhino3dm.Brep.CreateTrimmedPlane(rhino3dm.Plane.WorldXY(), circle), attributes)
    assert file.Write(str(tmp_path / "lids.3dm"), 7)
    try:
        placed = Placed("RhinoFile", Bench(str(tmp_path / "a.gh")))
        assert placed.run(_file=["lids.3dm"])["meshes"] == []
        said = sentences(placed.ghenv, "Warning")
        assert len(said) == 6 and said[0].startswith("lid 0 on layer ") and "trimmed" in said[0]
        assert said[-1] == "2 more surfaces cannot be meshed."
    finally:
        made.remove()


def test_a_file_that_was_saved_again_is_read_again(tmp_path: Path) -> None:
    made = stand_in.Canvas().install()
    try:
        file, placed = tmp_path / "model.3dm", Placed("RhinoFile", Bench(str(tmp_path / "a.gh")))
        for example, layer in (("9.4-cable", "cable"), ("9.24-membrane", "membrane")):
            file.write_bytes((EXAMPLES / example / "model.3dm").read_bytes())
            assert placed.run(_file=["model.3dm"])["layers"] == [layer]
    finally:
        made.remove()


def test_a_file_in_another_unit_than_the_document_is_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    made = stand_in.Canvas().install()
    monkeypatch.setattr(canvas_geometry, "length_unit", lambda: "mm")
    try:
        placed = Placed("RhinoFile")
        placed.run(_file=[str(EXAMPLES / "9.4-cable" / "model.3dm")])
        assert sentences(placed.ghenv, "Warning") == [
            "The lengths of this file are in m, those of the document in mm; they are not converted."
        ]
    finally:
        made.remove()


def test_a_file_is_read_once_for_all_components(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made = stand_in.Canvas().install()
    sent: list[str] = []
    real = canvas_file._sent
    monkeypatch.setattr(
        canvas_file, "_sent", lambda client, place, query: sent.append(place) or real(client, place, query)
    )
    try:
        file = tmp_path / "model.3dm"
        file.write_bytes((EXAMPLES / "9.32-ribbon" / "model.3dm").read_bytes())
        counts = [len(run("RhinoFile", _file=[str(file)], layer_=[name])["curves"]) for name in ("beams", "arcs")]
        assert counts == [2, 11] and sent == [str(file)]
    finally:
        made.remove()


@pytest.mark.parametrize("name", OURS)
def test_every_input_tells_unit_and_default(name: str) -> None:
    bundle = bundles.read(name)
    metadata = json.loads((bundles.folder() / name / "metadata.json").read_text("utf-8"))
    assert bundle.category == "Hookean" and bundle.subcategory in ("Geometry", "Mesh", "Engine")
    assert len(metadata["description"].splitlines()) == 2  # the second one is the formula
    for parameter in bundle.inputs:
        required, defaulted = parameter.name.startswith("_"), parameter.name.endswith("_")
        assert required or defaulted, parameter.name
        assert ("Default: " in parameter.description) == defaulted or parameter.name == "_run", parameter.name
        hint = next(p["typeHintID"] for p in metadata["ghpython"]["inputParameters"] if p["name"] == parameter.name)
        if hint in ("int", "float", "point"):
            assert re.search(r"\[.+\]", parameter.description), parameter.name
    assert all(parameter.description for parameter in bundle.outputs)
