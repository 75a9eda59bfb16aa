"""Results for other programs, read back by independent readers: ezdxf, meshio, ifcopenshell, compas."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Any

import compas
import ezdxf
import ifcopenshell
import ifcopenshell.validate
import meshio
import numpy as np
import pytest

import hookean
from hookean import InputError, Scene
from hookean.files.exchange.structure import Structure, plain_names
from hookean.running.result import Result


@pytest.fixture(scope="module")
def result() -> Result:
    """A small roof of 3 x 3 quads and one triangle, with an edge cable and a strut, under snow."""
    side = np.arange(4.0)
    points = [[x, y, 0.1 * x * y] for x in side for y in side] + [[4.0, 1.0, 0.2]]
    number = np.arange(16).reshape(4, 4)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    faces = [*quads.tolist(), [12, 16, 13]]
    cable = [[points[a], points[a + 1]] for a in range(3)]
    scene = Scene(
        units={"length": "m", "force": "kN"},
        meshes={"roof skin": hookean.MeshData(vertices=points, faces=faces)},
        forces=[
            hookean.Springs(name="net", mesh="roof skin", rest_factor=0.9, stiffness=40.0),
            hookean.Springs(name="edge cable", lines=cable, rest_factor=0.8, stiffness=300.0),
            hookean.ConstantTension(name="1 strut", particles=None, lines=[[points[5], points[10]]], tension=-0.5),
            hookean.Unary(name="snow", points=points[5:7], vector=[0, 0, -2.0]),
        ],
        anchors=[
            hookean.Anchors(points=[points[i] for i in (0, 3, 12, 15, 16)]),
            hookean.Anchors(points=[points[1]], axes="z"),
        ],
    )
    found = hookean.relax(scene)
    assert found.converged
    return found


def valid_ifc(path: Path) -> Any:
    """The model in a file, without a fault against its schema."""
    read = ifcopenshell.open(str(path))
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(read, log)
    assert not log.statements
    return read


def groups(result: Result) -> list[tuple[str, np.ndarray, np.ndarray]]:
    return [
        (entry["name"], np.asarray(entry["particles"]), np.asarray(entry["force"]))
        for entry in result.forces
        if entry["kind"] != "unary"
    ]


def test_dxf_has_lines_faces_supports_and_loads(result: Result, tmp_path: Path) -> None:
    result.save(tmp_path / "roof.dxf")
    read = ezdxf.readfile(tmp_path / "roof.dxf")
    assert not read.audit().errors and read.header["$INSUNITS"] == 6
    space = read.modelspace()
    for layer, (name, pairs, force) in zip(("NET", "EDGE_CABLE", "G_1_STRUT"), groups(result), strict=True):
        lines = list(space.query(f'LINE[layer=="{layer}"]'))
        assert len(lines) == len(pairs)
        for line, (a, b), pull in zip(lines, pairs.tolist(), force.tolist(), strict=True):
            np.testing.assert_allclose(tuple(line.dxf.start), result.particles[a], atol=1e-12)
            np.testing.assert_allclose(tuple(line.dxf.end), result.particles[b], atol=1e-12)
            said = [tag.value for tag in line.get_xdata("HOOKEAN")]
            assert f"force={name}" in said
            assert said[said.index("force [kN]") + 1] == pytest.approx(pull, rel=1e-12)
    faces = list(space.query('3DFACE[layer=="FACES_ROOF_SKIN"]'))
    assert len(faces) == 10
    supports = [tuple(p.dxf.location) for p in space.query("POINT")]
    np.testing.assert_allclose(supports, result.particles[result.reactions["particles"]], atol=1e-12)
    assert len(space.query('LINE[layer=="LOADS"]')) == 2


def test_vtu_has_cells_and_numbers(result: Result, tmp_path: Path) -> None:
    result.save(tmp_path / "roof.vtu")
    read = meshio.read(tmp_path / "roof.vtu")
    np.testing.assert_array_equal(read.points, result.particles)
    cells = {block.type: (i, block.data) for i, block in enumerate(read.cells)}
    assert {kind: len(data) for kind, (_, data) in cells.items()} == {
        "line": sum(len(pairs) for _, pairs, _ in groups(result)),
        "triangle": 1,
        "quad": 9,
    }
    place, lines = cells["line"]
    np.testing.assert_array_equal(lines, np.concatenate([pairs for _, pairs, _ in groups(result)]))
    np.testing.assert_array_equal(
        read.cell_data["force [kN]"][place], np.concatenate([force for _, _, force in groups(result)])
    )
    for number, (name, pairs, _) in enumerate(groups(result)):
        mine = read.cell_data[f"force {name}"][place]
        assert mine.sum() == len(pairs) and (read.cell_data["group"][place][mine > 0] == number).all()
    assert read.cell_data["mesh roof skin"][cells["quad"][0]].sum() == 9
    reactions = np.zeros(result.particles.shape)
    reactions[result.reactions["particles"]] = result.reactions["force"]
    np.testing.assert_array_equal(read.point_data["reaction [kN]"], reactions)
    np.testing.assert_allclose(read.point_data["load [kN]"].sum(axis=0), [0.0, 0.0, -4.0])
    assert read.point_data["held"].sum() == 16
    assert all(np.isfinite(values).all() for block in read.cell_data.values() for values in block)


def test_abaqus_has_elements_sets_stress_supports_and_loads(result: Result, tmp_path: Path) -> None:
    result.save(tmp_path / "roof.inp")
    read = meshio.read(tmp_path / "roof.inp")
    np.testing.assert_allclose(read.points, result.particles, rtol=1e-15, atol=1e-15)
    sprung = groups(result)[:2]  # a strut of constant force has no stiffness
    np.testing.assert_array_equal(read.cells[0].data, np.concatenate([pairs for _, pairs, _ in sprung]))
    assert len(read.cell_sets["NET"][0]) == len(sprung[0][1]) and len(read.cell_sets["EDGE_CABLE"][0]) == 3
    np.testing.assert_array_equal(read.point_sets["HELD"], result.reactions["particles"])
    text = (tmp_path / "roof.inp").read_text()
    assert "*ELEMENT, TYPE=T3D2" in text and "units m, kN, s" in text
    # EA of a section times its strain is the stress of its elements
    modulus = [float(m) for m in re.findall(r"\*ELASTIC\n([^,]*),", text)]
    stress = dict(re.findall(r"^(\d+), ([-\d.e]+)$", text.split("TYPE=STRESS\n")[1].split("*BOUNDARY")[0], re.M))
    strain = np.concatenate([np.asarray(result.force(name)["strain"]) for name, _, _ in sprung])
    for i, young in enumerate(modulus):
        for element in read.cell_sets[f"SECTION_{i + 1}"][0].tolist():
            assert float(stress[str(element + 1)]) == pytest.approx(young * strain[element], rel=1e-9)
    assert text.count("*SOLID SECTION") == len(modulus) == text.count("*MATERIAL")
    assert re.findall(r"\*CLOAD\n6, 3, -2.0\n7, 3, -2.0\n\*END STEP", text)
    assert "\n2, 3, 3\n" in text and "\n2, 1, 1\n" not in text


def test_ifc_has_a_valid_analysis_model(result: Result, tmp_path: Path) -> None:
    """Valid by ifcopenshell's checker of the schema."""
    result.save(tmp_path / "roof.ifc")
    read = valid_ifc(tmp_path / "roof.ifc")
    members = read.by_type("IfcStructuralCurveMember")
    wanted = [(name, pair, pull) for name, pairs, f in groups(result) for pair, pull in zip(pairs, f, strict=True)]
    assert len(members) == len(wanted)
    for member, (name, (a, b), pull) in zip(members, wanted, strict=True):
        assert member.ObjectType == name
        edge = member.Representation.Representations[0].Items[0]
        for vertex, particle in ((edge.EdgeStart, a), (edge.EdgeEnd, b)):
            np.testing.assert_array_equal(vertex.VertexGeometry.Coordinates, result.particles[particle])
        numbers = {
            p.Name: p.NominalValue.wrappedValue
            for own in member.IsDefinedBy
            for p in own.RelatingPropertyDefinition.HasProperties
        }
        assert numbers["force [kN]"] == pull
        assert member.PredefinedType == ("CABLE" if pull > 0 else "PIN_JOINED_MEMBER")
    held = [c for c in read.by_type("IfcStructuralPointConnection") if c.AppliedCondition]
    assert len(held) == 6 and len(read.by_type("IfcStructuralPointConnection")) == len(result.particles)
    partly = next(c for c in held if c.Name == "particle 1").AppliedCondition
    assert [partly[i].wrappedValue for i in (1, 2, 3)] == [False, False, True]
    loads = read.by_type("IfcStructuralPointAction")
    assert [load.AppliedLoad.ForceZ for load in loads] == [-2.0, -2.0]
    units = {u.UnitType: (u.Prefix, u.Name) for u in read.by_type("IfcSIUnit")}
    assert units == {"LENGTHUNIT": (None, "METRE"), "FORCEUNIT": ("KILO", "NEWTON")}
    assert len({entity.GlobalId for entity in read.by_type("IfcRoot")}) == len(read.by_type("IfcRoot"))


def test_compas_reads_the_graph(result: Result, tmp_path: Path) -> None:
    result.save(tmp_path / "roof.compas.json")
    graph = compas.json_load(str(tmp_path / "roof.compas.json"))
    assert graph.number_of_nodes() == len(result.particles)
    pairs = np.concatenate([pairs for _, pairs, _ in groups(result)])
    assert graph.number_of_edges() == len(np.unique(np.sort(pairs, axis=1), axis=0))
    a, b = result.force("net")["particles"][0].tolist()
    assert graph.edge_attribute((a, b), "force_name") == "net"
    assert graph.edge_attribute((a, b), "force") == result.force("net")["force"][0]
    assert graph.edge_attribute((a, b), "axial_stiffness") > 0.0
    assert graph.node_attributes(5, "xyz") == result.particles[5].tolist()
    assert graph.node_attributes(5, ["px", "py", "pz"]) == [0.0, 0.0, -2.0]
    held = result.reactions["particles"].tolist()
    assert [n for n in graph.nodes() if graph.node_attribute(n, "is_support")] == held
    assert graph.node_attribute(1, "fixed") == "z"
    reaction = graph.node_attributes(held[0], ["rx", "ry", "rz"])
    assert reaction == result.reactions["force"][0].tolist()
    assert graph.attributes["units"]["force"] == "kN"


@pytest.mark.parametrize("ending", ["dxf", "vtu", "inp", "ifc", "compas.json"])
def test_the_same_result_gives_the_same_bytes(result: Result, tmp_path: Path, ending: str) -> None:
    said = result.save(tmp_path / f"roof.{ending}")
    assert said[0] == f"A .{ending} file stores the shape, its lines and results, not the model; save the scene, too."
    has = "beams, membranes, lines with an axial stiffness, and elastic supports."
    left = f"1 strut: not in the file, which has {has}"
    assert said[1:] == ([left] if ending == "inp" else [])
    before = (tmp_path / f"roof.{ending}").read_bytes()
    result.save(tmp_path / f"roof.{ending}")
    assert (tmp_path / f"roof.{ending}").read_bytes() == before


def test_beams_and_springs_by_their_axial_stiffness_are_written(tmp_path: Path) -> None:
    """Springs given as EA or as a material and a section have that EA (Abaqus), one for each element; a clamp holds
    three rotations, and a foot on a ball none (IFC)."""
    steel = {"E": 210e6, "G": 81e6, "density": 7.85}
    spec = {
        "particles": [[0, 0, 0], [2, 0, 1], [4, 0, 0], [2, 1, 3]],
        "materials": {"steel": steel},
        "sections": {"tie": {"area": 1e-4}},
        "forces": [
            {"kind": "beam", "name": "frame", "particles": [[0, 1], [1, 2]], "E": 1e4, "G": 4e3, "A": 1.0, "Iy": 0.01,
             "Iz": 0.01, "J": 0.02},
            {"kind": "springs", "name": "stay", "particles": [[1, 3]], "axial_stiffness": 1e3, "force": 2.0},
            {"kind": "springs", "name": "tie", "particles": [[0, 2]], "material": "steel", "section": "tie"},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}, {"particles": [2, 3]}],
    }  # fmt: skip
    found = hookean.relax(Scene.read(spec))
    assert len(found.save(tmp_path / "frame.inp")) == 1
    lines = (tmp_path / "frame.inp").read_text(encoding="utf-8").splitlines()
    moduli = [float(lines[i + 1].split(",")[0]) for i, line in enumerate(lines) if line == "*ELASTIC"]
    areas = [float(lines[i + 1]) for i, line in enumerate(lines) if line.startswith("*SOLID SECTION")]
    assert sorted(e * a for e, a in zip(moduli, areas, strict=True)) == pytest.approx([1e3, 21e3], rel=1e-12)
    for ending in ("dxf", "vtu", "compas.json"):
        assert len(found.save(tmp_path / f"frame.{ending}")) == 1
    ifcopenshell = pytest.importorskip("ifcopenshell")
    found.save(tmp_path / "frame.ifc")
    model = ifcopenshell.open(str(tmp_path / "frame.ifc"))
    names = [member.Name for member in model.by_type("IfcStructuralCurveMember")]
    assert names == ["frame 0", "frame 1", "stay 0", "tie 0"]
    held = {}
    for point in model.by_type("IfcStructuralPointConnection"):
        if point.AppliedCondition is not None:
            held[point.Name] = [axis.wrappedValue for axis in list(point.AppliedCondition)[1:]]
    assert held == {f"particle {n}": [True] * 3 + [n == 0] * 3 for n in (0, 2, 3)}


@pytest.fixture(scope="module")
def mast() -> Result:
    """Two beams, hinged about y at the end, with an eccentric foot that two anchors clamp, under a moment alone."""
    spec = {
        "particles": [[0, 0, 0], [0, 0, 2], [2, 0, 2]],
        "forces": [
            {"kind": "beam", "name": "mast", "particles": [[0, 1]], "E": 1e6, "G": 4e5, "A": 1.0, "Iy": 0.01,
             "Iz": 0.02, "J": 0.02, "normal": [1, 0, 0], "offset_start": [0.1, 0, 0]},
            {"kind": "beam", "name": "arm", "particles": [[1, 2]], "E": 1e6, "G": 4e5, "A": 1.0, "Iy": 0.01,
             "Iz": 0.02, "J": 0.02, "normal": [0, 0, 1], "release_end": "y"},
            {"kind": "unary", "name": "push", "particles": [1], "vector": [0, 0, 0], "moment": [5, 1, 0]},
        ],
        "anchors": [{"name": "foot", "particles": [0]}, {"particles": [0], "axes": "", "rotations": "xyz"},
                    {"name": "end", "particles": [2]}],
        "units": {"length": "m", "force": "kN"},
    }  # fmt: skip
    found = hookean.relax(Scene.read(spec))
    assert found.converged and np.abs(found.reactions["moment"]).max() > 0.1
    return found


def test_moments_of_loads_and_supports_are_in_every_file(mast: Result, tmp_path: Path) -> None:
    moment = mast.reactions["moment"][mast.reactions["particles"].tolist().index(0)].tolist()
    for ending in ("ifc", "vtu", "dxf", "compas.json", "csv"):
        mast.save(tmp_path / f"mast.{ending}")
    read = ifcopenshell.open(str(tmp_path / "mast.ifc"))
    [load] = read.by_type("IfcStructuralLoadSingleForce")
    assert [load.ForceX, load.MomentX, load.MomentY, load.MomentZ] == [0.0, 5.0, 1.0, 0.0]
    foot = next(c for c in read.by_type("IfcStructuralPointConnection") if c.Name == "particle 0")
    numbers = {p.Name: p.NominalValue.wrappedValue
               for own in foot.IsDefinedBy for p in own.RelatingPropertyDefinition.HasProperties}  # fmt: skip
    assert [numbers[f"reaction moment {axis} [kN m]"] for axis in "xyz"] == moment
    points = meshio.read(tmp_path / "mast.vtu").point_data
    assert points["load moment [kN m]"][1].tolist() == [5, 1, 0]
    assert points["reaction moment [kN m]"][0].tolist() == moment
    graph = compas.json_load(str(tmp_path / "mast.compas.json"))
    assert graph.node_attributes(1, ["mx", "my", "mz"]) == [5, 1, 0] and graph.node_attribute(0, "clamped") == "xyz"
    assert graph.node_attributes(0, ["rmx", "rmy", "rmz"]) == moment
    told = [[value for code, value in thing.get_xdata("HOOKEAN")]
            for thing in ezdxf.readfile(tmp_path / "mast.dxf").modelspace().query("POINT")]  # fmt: skip
    assert ["reaction moment [kN m]", *moment] in [row[-4:] for row in told]
    assert ["moment [kN m]", 5.0, 1.0, 0.0] in told
    with open(tmp_path / "mast.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] == "reaction"]
    assert [row["force"] for row in rows] == ["foot", "end"]
    assert [float(rows[0][f"moment {axis} [kN m]"]) for axis in "xyz"] == moment


def test_beams_in_ifc_are_rigid_with_their_hinges_and_eccentric_ends(mast: Result, tmp_path: Path) -> None:
    """A release lets a beam turn about its own y alone; an offset is an eccentricity of the connection."""
    mast.save(tmp_path / "mast.ifc")
    read = valid_ifc(tmp_path / "mast.ifc")
    members = read.by_type("IfcStructuralCurveMember")
    assert [member.PredefinedType for member in members] == ["RIGID_JOINED_MEMBER"] * 2
    np.testing.assert_allclose(members[1].Axis.DirectionRatios, [0, 0, 1], atol=1e-12)
    joints = read.by_type("IfcRelConnectsStructuralMember")
    [free] = [joint for joint in joints if joint.AppliedCondition is not None]
    assert free.RelatingStructuralMember == members[1] and free.RelatedStructuralConnection.Name == "particle 2"
    assert [axis.wrappedValue for axis in list(free.AppliedCondition)[1:]] == [True, True, True, True, False, True]
    np.testing.assert_allclose(free.ConditionCoordinateSystem.RefDirection.DirectionRatios, [1, 0, 0], atol=1e-12)
    [off] = read.by_type("IfcRelConnectsWithEccentricity")
    assert off.RelatedStructuralConnection.Name == "particle 0"
    assert off.ConnectionConstraint.EccentricityInX == 0.1


def test_elastic_supports_have_their_stiffness_and_reaction_in_ifc(tmp_path: Path) -> None:
    """Along and about each axis the stiffness, true where an anchor holds, false where nothing does."""
    section = {"E": 1e6, "G": 4e5, "A": 1.0, "Iy": 0.01, "Iz": 0.02, "J": 0.02}
    bearing = {"kind": "support", "particles": [0, 1], "stiffness": [[10, 20, 30], [0, 5, 0]],
               "rotation_stiffness": [[0, 7, 0], [0, 0, 0]]}  # fmt: skip
    push = {"kind": "unary", "particles": [0], "vector": [0, 0, -3]}
    spec = {
        "particles": [[0, 0, 0], [2, 0, 0]],
        "forces": [{"kind": "beam", "particles": [[0, 1]], **section}, bearing, push],
        "anchors": [{"particles": [1], "axes": "xz", "rotations": "x"}],
    }
    found = hookean.relax(Scene.read(spec))
    found.save(tmp_path / "beam.ifc")
    read = valid_ifc(tmp_path / "beam.ifc")
    points = read.by_type("IfcStructuralPointConnection")
    conditions = [[axis.wrappedValue for axis in list(point.AppliedCondition)[1:]] for point in points]
    assert conditions == [[10.0, 20.0, 30.0, False, 7.0, False], [True, 5.0, True, True, False, False]]
    numbers = {p.Name: p.NominalValue.wrappedValue
               for own in points[0].IsDefinedBy for p in own.RelatingPropertyDefinition.HasProperties}  # fmt: skip
    assert numbers["reaction z [N]"] == found.reactions["force"][0, 2] > 0.0
    assert numbers["reaction moment y [N m]"] == found.reactions["moment"][0, 1] != 0.0


def test_vtu_has_the_stresses_of_membranes_on_their_faces(tmp_path: Path) -> None:
    """A quad and a triangle of cloth that is pulled: of each face the mean over its cuts, and the extremes of these;
    lines have none. Cloth of a known strength has its utilisation."""
    square = {
        "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0], [2, 0, 0.1]],
        "faces": [[0, 1, 2, 3], [1, 4, 2]],
    }
    cloth = {
        "kind": "membrane",
        "mesh": "sail",
        "material": "PVC-polyester I",
        "warp": [1, 0, 0],
        "prestress": [4, 3, 0],
    }
    spec = {
        "units": {"force": "kN"},
        "particles": square["vertices"],
        "meshes": {"sail": square},
        "forces": [cloth, {"kind": "springs", "particles": [[2, 4]]},
                   {"kind": "unary", "particles": [2], "vector": [0, 0, 1]}],
        "anchors": [{"particles": [0, 1, 3, 4]}],
    }  # fmt: skip
    found = hookean.relax(Scene.read(spec))
    found.save(tmp_path / "sail.vtu")
    read, own = meshio.read(tmp_path / "sail.vtu"), found.force("membrane")
    place = {block.type: i for i, block in enumerate(read.cells)}
    warp = read.cell_data["membrane warp [kN/m]"]
    assert warp[place["quad"]] == pytest.approx([own["warp"][:4].mean()], rel=1e-14)
    assert warp[place["triangle"]].tolist() == own["warp"][4:].tolist() and not warp[place["line"]].any()
    assert read.cell_data["membrane largest [kN/m]"][place["quad"]].tolist() == [own["largest"][:4].max()]
    assert read.cell_data["membrane least [kN/m]"][place["quad"]].tolist() == [own["least"][:4].min()]
    assert read.cell_data["membrane utilisation [-]"][place["quad"]].tolist() == [own["utilisation"][:4].max()]
    assert read.cell_data["membrane state [-]"][place["quad"]].tolist() == [own["state"][:4].min()]


def test_names_are_plain_and_each_there_once() -> None:
    assert plain_names(["edge cable", "edge-cable", "1", "é", "edge cable"]) == [
        "EDGE_CABLE", "EDGE_CABLE_2", "G_1", "GROUP", "EDGE_CABLE_3",
    ]  # fmt: skip


def test_what_a_file_cannot_hold_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    line = hookean.ConstantTension(lines=[[[0, 0, 0], [1, 0, 0]]])
    feet = Scene(units={"length": "ft"}, forces=[line], anchors=[hookean.Anchors(points=[[0, 0, 0], [1, 0, 0]])])
    result = hookean.relax(feet)
    with pytest.raises(InputError, match="units ft and N given"):
        result.save(tmp_path / "a.ifc")
    with pytest.raises(InputError, match="neither beams nor membranes nor springs with a rest length to write; freeze"):
        result.save(tmp_path / "a.inp")
    for package, ending, extra in (("meshio", "vtu", "exchange"), ("ifcopenshell", "ifc", "ifc")):
        monkeypatch.setitem(__import__("sys").modules, package, None)
        with pytest.raises(InputError, match=rf"needs the package {package}; .*hookean\[{extra}\]"):
            result.save(tmp_path / f"a.{ending}")
    assert not list(tmp_path.iterdir())
    assert Structure.of(result).pairs.tolist() == [[0, 1]]
