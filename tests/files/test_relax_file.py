"""Relaxing files: real ones, the same model in several units, own output, tables and limits, JSON."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm as _rhino3dm

from hookean import Scene
from hookean import relax as relax_scene
from hookean.errors import InputError
from hookean.files import limits as limit_file
from hookean.files import tables
from hookean.files.recipe.output import Palette
from hookean.files.relax_file import FileResult, LimitsError, explain_file, relax_file, report_json
from hookean.files.rhino import threedm
from hookean.files.rhino.archive import scan
from hookean.files.rhino.threedm import Additions, NewObject
from hookean.pictures.picture import legend
from hookean.running.result import Status
from hookean.system.system import compile
from hookean.values.colours import Scale
from hookean.values.mesh import Mesh
from soak import sampled

rhino: Any = _rhino3dm
CABLE = """
[[forces]]
kind = "springs"
name = "cable"
lines = "layer:cable"
divide = 5
stiffness = 1000

[[forces]]
kind = "unary"
points = "vertices:layer:cable"
vector = [0, 0, -20]

[[anchors]]
name = "ends"
points = "ends:layer:cable"

[settings]
tolerance = 1e-12
"""
NAKED = """
[[forces]]
kind = "springs"
mesh = "*"
divide = [6, 6]
rest_factor = 0

[[anchors]]
points = "naked:*"
"""
CURVES = """
[[forces]]
kind = "springs"
lines = "*"
divide = 4

[[anchors]]
points = "ends:*"
"""
LINE = np.array([[0.0, 0, 0], [10, 0, 0]])
DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "rhino"


def drawn(path: Path, objects: Sequence[NewObject], unit: str = "Meters") -> Path:
    threedm.write_new(path, Additions((), objects), unit=unit, own=False)
    return path


@pytest.fixture
def cable(tmp_path: Path) -> Path:
    """A straight cable of 10 m on a layer of its own."""
    return drawn(tmp_path / "cable.3dm", [NewObject(LINE, "cable", "main")])


def named(stem: str) -> Path:
    """One of the real files."""
    path = DATA / f"{stem}.3dm"
    if not path.exists():
        pytest.skip(f"no {path}")
    return path


def intact(source: Path, copy: Path) -> bool:
    """Whether every object record of the source is in the copy, in order and byte for byte (from Rhino 5 on)."""
    before, after = source.read_bytes(), copy.read_bytes()
    old, new = scan(before), scan(after)
    if old.version < 50:
        return len(new.objects) >= len(old.objects)
    pairs = zip(old.objects, new.objects, strict=False)
    return len(new.objects) >= len(old.objects) and all(
        before[a.start : a.end] == after[b.start : b.end] for a, b in pairs
    )


def rows_of(found: FileResult) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(found.csv)))


def test_a_cable_of_five_pieces_hangs_as_computed_by_hand(cable: Path, tmp_path: Path) -> None:
    found = relax_file(cable, tmp_path / "out.3dm", CABLE)
    assert found.result.converged
    pieces = [row for row in rows_of(found) if row["kind"] == "springs"]
    assert len(pieces) == 5
    assert sum(float(row["length [m]"]) for row in pieces) == pytest.approx(10.4679154891668, abs=1e-11)
    assert {row["name"] for row in pieces} == {"main"} and {row["layer"] for row in pieces} == {"cable"}
    assert {row["id"] for row in pieces} == {str(threedm.read(cable).objects[0].id)}


def test_reactions_carry_the_loads_and_belong_to_the_object_held(cable: Path) -> None:
    rows = [row for row in rows_of(relax_file(cable, None, CABLE)) if row["kind"] == "reaction"]
    # the loads on the held ends go straight into them: 6 x 20 in all
    assert sum(float(row["force z [N]"]) for row in rows) == pytest.approx(120.0, rel=1e-9)
    assert [row["force"] for row in rows] == ["ends", "ends"]
    assert {row["name"] for row in rows} == {"main"}


def test_results_are_drawn_below_their_own_layer(cable: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.3dm"
    found = relax_file(cable, out, CABLE)
    model = threedm.read(out)
    added = [item for item in model.objects if item.own]
    assert [str(item.id) for item in added] == found.ids
    lines = [item for item in added if item.layer == "hookean::cable"]
    reactions = [item for item in added if item.layer == "hookean::reactions"]
    assert (len(lines), len(reactions)) == (5, 2)
    text = lines[0].user_text
    source = threedm.read(cable).objects[0].id
    assert text["source"] == str(source)
    columns = found.result.force("cable")
    assert text["force"] == f"{columns['force'][0]:.6g} N"
    assert text["length"] == f"{columns['length'][0]:.6g} m"
    assert text["strain"] == f"{columns['strain'][0]:.6g}"
    assert lines[0].colour != lines[2].colour
    assert reactions[0].user_text["reaction"].endswith(" N")
    assert scan(out.read_bytes()).version == scan(cable.read_bytes()).version


def test_slack_springs_are_grey_and_meshes_have_colours(tmp_path: Path) -> None:
    square = Mesh(
        np.array([[i, j, 0.3 * i * j] for i in range(3) for j in range(3)], dtype=float),
        np.array([[0, 3, 4, 1], [1, 4, 5, 2], [3, 6, 7, 4], [4, 7, 8, 5]]),
    )
    source = drawn(
        tmp_path / "a.3dm",
        [NewObject(square, "net", "sail"), NewObject(np.array([[0.0, 0, 0], [0.5, -1, 0], [1, 0, 0]]), "cables")],
    )
    out = tmp_path / "out.3dm"
    recipe = (
        NAKED.replace("divide = [6, 6]", "")
        + '[[forces]]\nkind = "springs"\nlines = "*"\nname = "idle"\ntension_only = true\n'
        + '[[anchors]]\npoints = "vertices:layer:cables"\n'
    )
    relax_file(source, out, recipe)
    model = threedm.read(out)
    idle = [item for item in model.objects if item.layer == "hookean::idle"]
    assert len(idle) == 2 and {item.colour[:3] for item in idle} == {(150, 150, 150)}
    (sail,) = [item for item in model.objects if item.own and item.kind == "Mesh"]
    assert sail.name == "sail"
    assert len(sail.geometry.VertexColors) == 9 and len({tuple(c) for c in sail.geometry.VertexColors}) > 2


@pytest.mark.parametrize("unit", ["Millimeters", "Meters", "Inches"])
def test_the_unit_of_the_file_changes_no_force(tmp_path: Path, unit: str) -> None:
    metre = {"Millimeters": 1e3, "Meters": 1.0, "Inches": 1 / 0.0254}
    recipe = 'units = {length = "m", force = "N"}\n' + CABLE
    bare = drawn(tmp_path / "bare.3dm", [NewObject(LINE, "cable")])
    expected = relax_file(bare, None, recipe).result.force("cable")["force"]
    source = drawn(tmp_path / "in.3dm", [NewObject(LINE * metre[unit], "cable")], unit)
    found = relax_file(source, tmp_path / "out.3dm", recipe)
    assert np.allclose(found.result.force("cable")["force"], expected, rtol=1e-9, atol=0)
    # written back in the file's unit, where the line was
    item = next(i for i in threedm.read(tmp_path / "out.3dm").objects if i.layer == "hookean::cable")
    start = item.geometry.PointAtStart
    assert (start.X, start.Y, start.Z) == (0.0, 0.0, 0.0)
    lengths = [i for i in threedm.read(tmp_path / "out.3dm").objects if i.layer == "hookean::cable"]
    total = sum(i.geometry.PointAtStart.DistanceTo(i.geometry.PointAtEnd) for i in lengths)
    assert total == pytest.approx(10.4679154891668 * metre[unit], rel=1e-11)


def test_without_a_recipe_the_unit_of_the_file_changes_no_force(tmp_path: Path) -> None:
    found = []
    for unit, per_metre in (("Meters", 1.0), ("Millimeters", 1e3), ("Inches", 1 / 0.0254)):
        path = drawn(
            tmp_path / f"{unit}.3dm",
            [
                NewObject(LINE * per_metre, "springs", user_text={"divide": "5", "load": "-20", "rest_length": "1.5"}),
                NewObject((LINE + [0, 3, 0]) * per_metre, "cables", user_text={"divide": "4", "load": "0, 0, -5"}),
                *(NewObject((LINE[i] + [0, y, 0]) * per_metre, "anchors") for i in (0, 1) for y in (0, 3)),
            ],
            unit,
        )
        found.append(relax_file(path, tmp_path / f"{unit}-out.3dm"))
        assert any(line.startswith("units: m, N, s; the file is in ") for line in explain_file(path))
        assert found[-1].result.converged
    for name in ("springs", "cables"):
        first, *others = (f.result.force(name)["force"] for f in found)
        assert first.max() > 1.0
        for other in others:
            assert np.allclose(other, first, rtol=1e-9, atol=1e-9)


def test_own_output_relaxes_to_the_same_file(cable: Path, tmp_path: Path) -> None:
    first, again, third = (tmp_path / name for name in ("1.3dm", "2.3dm", "3.3dm"))
    one = relax_file(cable, first, CABLE)
    two = relax_file(cable, again, CABLE)
    assert first.read_bytes() == again.read_bytes() and one.csv == two.csv
    re_run = relax_file(first, third, CABLE)
    assert re_run.ids == one.ids
    assert re_run.csv == one.csv
    assert len(threedm.read(third).objects) == len(threedm.read(first).objects)
    assert third.read_bytes() == first.read_bytes()


@pytest.mark.slow
def test_each_real_file_keeps_its_objects(real: Path, tmp_path: Path) -> None:
    """Surfaces are meshed and held at their naked vertices, curves divided; the old records stay as they are."""
    out = tmp_path / "out.3dm"
    relaxed = 0
    for recipe in (NAKED, CURVES, None):
        try:
            found = relax_file(real, out, recipe)
        except InputError as error:
            assert error.sentence and not out.exists()
            continue
        relaxed += 1
        assert found.result.status is Status.CONVERGED
        old, new = threedm.read(real), threedm.read(out)
        assert len(new.objects) == len(old.objects) + len(found.ids) and found.ids
        assert intact(real, out)
        out.unlink()
    closed = ("v7_my_brep", "v7_my_mesh", "v7_rhino_logo_nurbs", "v7_my_points", "v7_my_trimmed_surface")
    assert (relaxed == 0) == (real.stem in closed)


@pytest.mark.slow
@pytest.mark.parametrize("stem", sampled(["v7_my_brep", "v7_rhino_logo_nurbs", "v7_my_mesh"], 2))
def test_closed_bodies_have_no_naked_vertices_and_relax_without(stem: str, tmp_path: Path) -> None:
    source, out = named(stem), tmp_path / "out.3dm"
    with pytest.raises(InputError, match="closed meshes have none"):
        relax_file(source, out, NAKED)
    assert not out.exists()
    found = relax_file(source, out, '[[forces]]\nkind = "springs"\nmesh = "*"\ndivide = 2\n')
    assert found.result.converged and len(found.objects) == len(found.ids) > 0
    assert intact(source, out)


@pytest.mark.slow
def test_trimmed_faces_are_refused_where_selected_and_left_out_otherwise() -> None:
    source = named("v7_my_trimmed_surface")
    with pytest.raises(InputError, match=r"Brep \(51696a5b.*trimmed"):
        relax_file(source, None, NAKED.replace('"*"', '"layer:trimmed surface"'))
    assert any("left out: face 0 is trimmed" in line for line in explain_file(source))
    mixed = named("v3_UntrimmedSurfaces")
    assert sum("trimmed and without a cached" in line for line in explain_file(mixed)) == 3


def test_a_file_cut_anywhere_is_refused_and_leaves_nothing(real: Path, tmp_path: Path) -> None:
    data = real.read_bytes()
    bad, out = tmp_path / "cut.3dm", tmp_path / "out.3dm"
    for part in (0.0, 0.001, 0.1, 0.5, 0.9, 0.999):
        bad.write_bytes(data[: int(part * len(data))])
        with pytest.raises(InputError) as caught:
            relax_file(bad, out, NAKED)
        assert "\n" not in str(caught.value)
        assert sorted(path.name for path in tmp_path.iterdir()) == ["cut.3dm"]


def test_a_shape_short_of_equilibrium_is_written_and_a_cancelled_one_is_not(cable: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.3dm"
    short = relax_file(cable, out, CABLE + "max_iterations = 1\n")
    assert short.result.status is Status.MAX_ITERATIONS and out.exists()
    stopped = relax_file(cable, tmp_path / "no.3dm", CABLE, cancelled=lambda: True)
    assert stopped.result.status is Status.CANCELLED and not (tmp_path / "no.3dm").exists()
    seen: list[int] = []
    relax_file(cable, None, CABLE, progress=lambda iteration, residual: seen.append(iteration))
    assert seen == sorted(seen) and seen[-1] > 1


def test_the_source_is_never_the_target(cable: Path, tmp_path: Path) -> None:
    before = cable.read_bytes()
    for target in (cable, tmp_path / "missing" / "out.3dm", tmp_path, tmp_path / "out.stl"):
        with pytest.raises(InputError):
            relax_file(cable, target, CABLE)
    assert cable.read_bytes() == before


def test_faults_of_a_recipe_are_told_with_its_name(cable: Path) -> None:
    with pytest.raises(InputError) as caught:
        relax_file(cable, None, CABLE.replace("layer:cable", "layer:rope"), recipe_name="bridge.toml")
    assert caught.value.pointer == "bridge.toml /forces/0/lines"
    with pytest.raises(InputError) as bare:
        relax_file(cable, None, CABLE.replace("layer:cable", "layer:rope"))
    assert bare.value.pointer == "/forces/0/lines"
    other = cable.with_name("scene.json")
    other.write_text("{}")
    with pytest.raises(InputError, match="recipes are for"):
        relax_file(other, None, CABLE)


def test_the_report_is_json_and_says_how_the_file_was_read(cable: Path) -> None:
    found = relax_file(cable, None, CABLE)
    report = json.loads(report_json(found))
    assert report["result"]["status"] == "converged"
    assert report["understood"] == explain_file(cable, CABLE)
    (entry,) = report["objects"]
    assert (entry["name"], entry["elements"]) == ("main", 5)
    assert entry["length [m]"] == pytest.approx(10.4679154891668)
    assert entry["max force [N]"] == max(r["force [N]"] for r in report["rows"] if r["kind"] == "springs")


def test_lines_drawn_twice_and_anchors_that_miss_are_told(tmp_path: Path) -> None:
    source = drawn(
        tmp_path / "a.3dm", [NewObject(LINE, "cable"), NewObject(LINE[::-1], "cable"), NewObject(LINE[0] + 3, "masts")]
    )
    recipe = '[[forces]]\nkind = "springs"\nlines = "layer:cable"\n[[anchors]]\npoints = "*, ends:layer:cable"\n'
    missed = r"1 of 3 points met no particle; the nearest is 5.19615 m away from \(3, 3, 3\)"
    with pytest.raises(InputError, match=rf"^r.toml /anchors/0/points: {missed}"):
        relax_file(source, None, recipe, recipe_name="r.toml")
    warnings = relax_file(source, None, "strict = false\n" + recipe).warnings
    assert any("1 element joins the same particles" in w for w in warnings)
    assert any(re.match(f"/anchors/0/points: {missed}", w) for w in warnings)


def test_a_file_read_by_its_layers_takes_the_rest_of_the_scene_from_a_recipe(tmp_path: Path) -> None:
    """A stray anchor is an error with the file's name; `strict` and `weld_tolerance` alone keep the layers' meaning."""
    there = [NewObject(LINE, "cables"), NewObject(LINE[0], "anchors"), NewObject(LINE[-1] + [0, 0, 0.1], "anchors")]
    source = drawn(tmp_path / "a.3dm", there)
    with pytest.raises(InputError, match=r"^a.3dm /anchors/0/points: anchors: 1 of 2 points met no particle; .* 0.1 m"):
        relax_file(source)
    found = relax_file(source, None, "strict = false", recipe_name="r.toml")
    assert any("anchors: 1 of 2 points met no particle" in w for w in found.warnings)
    assert len(found.result.reactions["particles"]) == 1
    found = relax_file(source, None, "weld_tolerance = 0.2\n[settings]\nsolver = 'relaxation'", recipe_name="r.toml")
    assert len(found.result.reactions["particles"]) == 2 and found.result.solver == "relaxation"
    with pytest.raises(InputError, match=r"^r.toml /units: .*uses layer names, in m, N and s"):
        relax_file(source, None, 'units = {length = "mm"}', recipe_name="r.toml")


def test_seams_and_objects_of_a_joined_mesh_keep_their_ids(tmp_path: Path) -> None:
    a = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2, 3]]))
    b = Mesh(a.vertices + [1, 0, 0], a.faces)
    source = drawn(tmp_path / "a.3dm", [NewObject(a, "net", "a"), NewObject(b, "net", "b")])
    found = relax_file(source, tmp_path / "out.3dm", NAKED.replace("divide = [6, 6]", ""))
    names = [row["name"] for row in rows_of(found) if row["kind"] == "springs"]
    assert (names.count("a"), names.count("b")) == (4, 3)  # the shared edge belongs to the first
    meshes = [item.name for item in threedm.read(tmp_path / "out.3dm").objects if item.own and item.kind == "Mesh"]
    assert meshes == ["a", "b"]


def test_a_shape_that_shrinks_to_a_point_is_told_and_the_file_written(tmp_path: Path) -> None:
    flat = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2, 3]]))
    source = drawn(tmp_path / "a.3dm", [NewObject(flat, "net", "bag"), NewObject(LINE, "cable")])
    recipe = (
        NAKED.replace("divide = [6, 6]", "")
        + "targets = [[3, 0, 0], [3, 0, 0], [3, 0, 0], [3, 0, 0]]\n"
        + '[[forces]]\nkind = "springs"\nlines = "*"\n'
        + '[[geometry]]\nkind = "polyline"\npoints = [[0, 0, 0]]\n[[geometry]]\nkind = "curve"\npoints = [[0, 0, 0]]\n'
    )
    found = relax_file(source, tmp_path / "out.3dm", recipe)
    assert any(w.startswith("result on layer springs bag is not written") for w in found.warnings)
    assert [i for i in threedm.read(tmp_path / "out.3dm").objects if i.own and i.kind == "LineCurve"]


LIMITS = {
    "max_force = 1": "model: max force",
    "min_force = 1000": "model: min force",
    "max_strain = 0.001": "model: max strain",
    "max_displacement = 0.5": "model: max displacement",
    "max_reaction = 100": "model: max reaction",
    "[force.cable]\nmax_force = 1": "force cable: max force",
    "[force.springs]\nmax_strain = 0.001": "force springs: max strain",
    "[layer.cable]\nmax_displacement = 0.5": "layer cable: max displacement",
    "[anchor.ends]\nmax_reaction = 100": "anchor ends: max reaction",
}


@pytest.mark.parametrize("text", LIMITS)
def test_limits_are_checked_where_they_stand(cable: Path, text: str) -> None:
    found = relax_file(cable, None, CABLE, limits=limit_file.read_limits(text))
    assert len(found.exceeded) == 1 and found.exceeded[0].startswith(LIMITS[text])


def test_limits_that_hold_say_nothing_and_units_count(cable: Path) -> None:
    wide = "max_force = 1e6\nmin_force = -1\nmax_strain = 1\nmax_displacement = 10\nmax_reaction = 1e6\n"
    assert relax_file(cable, None, CABLE, limits=limit_file.read_limits(wide)).exceeded == []
    strongest = float(relax_file(cable, None, CABLE).result.force("cable")["force"].max())
    for factor, count in ((0.999, 1), (1.001, 0)):
        limit = f'max_force = {strongest / 1000 * factor}\nunits = {{force = "kN"}}\n'
        found = relax_file(cable, None, CABLE, limits=limit_file.read_limits(limit)).exceeded
        assert len(found) == count and all("kN" in sentence for sentence in found)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("max_forse = 1", "unknown limit"),
        ("max_force = 'much'", "give a number"),
        ("max_force = nan", "give a number"),
        ("[force]\ncable = 1", "table"),
        ("layer = 3", "tables such as"),
        ("[force.rope]\nmax_force = 1", '"cable"'),
        ("[layer.rope]\nmax_force = 1", '"cable"'),
        ("[anchor.rope]\nmax_reaction = 1", '"ends"'),
        ("units = 3\nmax_force = 1", "units"),
    ],
)
def test_limits_that_could_never_be_exceeded_are_refused(cable: Path, text: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        relax_file(cable, None, CABLE, limits=limit_file.read_limits(text))


SCENE = {
    "units": {"length": "cm"},
    "forces": [
        {"kind": "springs", "lines": [[[0, 0, 0], [5, 0, 0]], [[5, 0, 0], [10, 0, 0]]], "stiffness": 100},
        {"kind": "unary", "points": [[5, 0, 0]], "vector": [0, 0, -10]},
    ],
    "anchors": [{"points": [[0, 0, 0], [10, 0, 0]]}],
}


def test_a_scene_in_json_gives_the_result_in_json_and_in_3dm(tmp_path: Path) -> None:
    source = tmp_path / "scene.json"
    source.write_text(json.dumps(SCENE), encoding="utf-8")
    found = relax_file(source, tmp_path / "out.json")
    expected = relax_scene(Scene.read(SCENE)).to_dict()
    assert json.loads((tmp_path / "out.json").read_text(encoding="utf-8")) == json.loads(json.dumps(expected))
    assert len([row for row in found.rows if row["kind"] == "springs"]) == 2
    relax_file(source, tmp_path / "out.3dm")
    model = threedm.read(tmp_path / "out.3dm")
    assert model.unit == "Centimeters"
    assert sorted({item.layer for item in model.objects}) == ["hookean::reactions", "hookean::springs"]


def test_a_compas_mesh_comes_back_as_one(tmp_path: Path) -> None:
    from compas.datastructures import Mesh as CompasMesh

    mesh = CompasMesh.from_meshgrid(4.0, 4)
    centre = next(v for v in mesh.vertices() if not mesh.is_vertex_on_boundary(v))
    mesh.vertex_attribute(centre, "z", 3.0)
    source, out = tmp_path / "mesh.json", tmp_path / "out.json"
    mesh.to_json(str(source))
    found = relax_file(source, out)
    assert found.result.converged and "COMPAS mesh" in found.understood[0]
    back = CompasMesh.from_json(str(out))
    assert back.number_of_faces() == mesh.number_of_faces()
    assert list(back.vertices()) == list(mesh.vertices())
    assert abs(back.vertex_attribute(centre, "z")) < 1e-9


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "3", '{"forces": 3}', '{"dtype": "compas.geometry/Point", "data": [0, 0, 0]}']
)
def test_json_that_is_no_scene_is_refused(tmp_path: Path, text: str) -> None:
    source = tmp_path / "scene.json"
    source.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"scene\.json"):
        relax_file(source, tmp_path / "out.json")
    assert not (tmp_path / "out.json").exists()


def test_a_mesh_tells_the_range_of_its_elements_in_the_colours_of_the_picture(tmp_path: Path) -> None:
    square = Mesh(
        np.array([[i, j, 0.3 * i * j] for i in range(3) for j in range(3)], dtype=float),
        np.array([[0, 3, 4, 1], [1, 4, 5, 2], [3, 6, 7, 4], [4, 7, 8, 5]]),
    )
    source = drawn(tmp_path / "a.3dm", [NewObject(square, "net", "sail"), NewObject(LINE + [0, 9, 0], "springs")])
    found = relax_file(source, tmp_path / "out.3dm")
    objects = threedm.read(tmp_path / "out.3dm").objects
    (text,) = [item.user_text for item in objects if item.own and item.kind == "Mesh"]
    rows = [row for row in found.rows if row["name"] == "sail" and row["kind"] == "springs"]
    for key, column, unit in (("force", "force [N]", " N"), ("strain", "strain [-]", "")):
        values = [row[column] for row in rows]
        assert text[key] == f"{min(values):.6g} to {max(values):.6g}{unit}"
    parts = [p for p in tables.sections(compile(found.scene), found.result) if p.internal]
    palette = Palette(parts)
    low, high, unit = legend(found.result)
    values = np.linspace(low + 0.01 * (high - low), high, 7)
    expected = Scale(low, high, unit).colours(values)[:, :3] * 255
    assert np.abs(palette(values) - expected).max() <= 2


def test_limits_on_what_is_not_there_are_told_after_everything_is_written(cable: Path, tmp_path: Path) -> None:
    limits = limit_file.read_limits("[force.rope]\nmax_force = 1", "l.toml")
    with pytest.raises(LimitsError, match=r"l\.toml /force/rope: cable\.3dm has no such force; it has") as caught:
        relax_file(cable, tmp_path / "out.3dm", CABLE, limits=limits, limits_name="l.toml")
    assert (tmp_path / "out.3dm").exists() and caught.value.found.result.converged
    with pytest.raises(InputError, match=r"^l\.toml /max_froce: "):
        limit_file.read_limits("max_froce = 1", "l.toml")
    for empty in ("", "{}", '[units]\nforce = "kN"\n', "[force.cable]\n"):  # would pass whatever the result
        with pytest.raises(InputError, match="has no limit"):
            limit_file.read_limits(empty, "l.toml")


def test_wrong_files_are_called_what_they_are(cable: Path, tmp_path: Path) -> None:
    relax_file(cable, tmp_path / "w.json", CABLE)
    with pytest.raises(InputError, match="is a result, not a scene"):
        relax_file(tmp_path / "w.json")
    with pytest.raises(InputError, match="is a recipe; pass it with -r"):
        relax_file(tmp_path / "good.toml")
    with pytest.raises(InputError, match=r"its folder .*missing does not exist"):
        relax_file(cable, tmp_path / "missing" / "out.3dm", CABLE)
    stiff = drawn(tmp_path / "s.3dm", [NewObject(LINE, "springs", user_text={"stiffness": "stiff"})])
    with pytest.raises(InputError, match=r"^s\.3dm: LineCurve .*user text stiffness"):
        relax_file(stiff)
