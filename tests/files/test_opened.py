"""Files opened to be moved: OBJ and COMPAS JSON are taken as drawn, what is not taken is told, faults name their line.

Sources: Wavefront's "Object Files (.obj)" for the format; compas and rhino3dm's convention of `hookean relax` for what
becomes of it.
"""

from __future__ import annotations

import json
import random

import compas.data
import numpy as np
import pytest
from compas.datastructures import Graph, Mesh
from compas.geometry import Frame, Line, Pointcloud, Polygon, Polyline, Vector

from hookean import InputError, Scene, Simulation, relax
from hookean.files import obj, readers
from hookean.files.obj_read import read

GRID = "".join(f"v {i} {j} 0\n" for i in range(3) for j in range(3))
SHEET = GRID + "o sheet\nf 1 4 5 2\nf 2 5 6 3\nf 4 7 8 5\nf 5 8 9 6\n"
CUBE = (
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
)
CABLE = "v 0 0 0\nv 1 0 0\nv 2 0 0\ng cable\nl 1 2 3\n"


def opened(text: str | bytes, name: str = "a.obj") -> tuple[Scene, list[str]]:
    """The scene, and what is said of it: warnings, and that nothing is held."""
    found = readers.read(text.encode() if isinstance(text, str) else text, name)
    return found.scene, [*found.warnings, *([found.unheld] if found.unheld else [])]


def anchors(scene: Scene) -> dict[str, list[tuple[float, ...]]]:
    """Where each anchor stands, sorted."""
    return {a.name: sorted(map(tuple, np.asarray(a.points).tolist())) for a in scene.anchors}


# what becomes of it


def test_faces_are_a_membrane_held_along_its_rim() -> None:
    """Nine vertices, twelve edges of rest factor 0, all held but the middle one."""
    scene, warnings = opened(SHEET)
    (force,) = scene.forces
    assert (force.kind, force.name, force.mesh) == ("springs", "sheet", "sheet")
    assert np.all(np.asarray(force.rest_factor) == 0.0)
    assert not warnings and [len(a) for a in anchors(scene).values()] == [8]
    system = Simulation(scene).system
    assert len(system.x) == 9 and len(system.groups[0].block.indices) == 12
    assert scene.units.length == "m" and [g.kind for g in scene.geometry] == ["mesh"]


def test_lines_are_springs_held_at_loose_ends() -> None:
    scene, warnings = opened(CABLE)
    (force,) = scene.forces
    assert force.name == "cable" and np.all(np.asarray(force.rest_factor) == 1.0)
    assert anchors(scene) == {"loose ends": [(0, 0, 0), (2, 0, 0)]} and not warnings
    assert len(Simulation(scene).system.x) == 3


def test_points_are_anchors_and_then_nothing_else_is_held() -> None:
    scene, _ = opened(SHEET + "g posts\np 1 3\np 7\np 7\n")
    assert anchors(scene) == {"posts": [(0, 0, 0), (0, 2, 0), (2, 0, 0)]}


def test_points_taken_as_anchors_that_meet_nothing_are_warnings() -> None:
    """These files cannot set strict, and nobody said that their points hold: the rest is opened; none at all is an
    error."""
    document = [Line([0, 0, 0], [1, 0, 0]), Pointcloud([[0, 0, 0], [5, 0, 0]])]
    scene, _ = opened(compas.data.json_dumps(document), "a.json")
    [said] = relax(scene).report.left_out()
    assert said.startswith("/anchors/0/points: points: 1 of 2 points met no particle; the nearest is 4 m away")
    with pytest.raises(InputError, match="No anchor holds a particle"):
        relax(opened(compas.data.json_dumps([document[0], Pointcloud([[5, 0, 0]])]), "a.json")[0])


def test_a_closed_mesh_is_held_nowhere_and_that_is_said() -> None:
    scene, warnings = opened(CUBE)
    assert not scene.anchors and len(warnings) == 1 and "closed" in warnings[0] and "pin" in warnings[0]
    ring, warnings = opened("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3 1\n")
    assert not ring.anchors and "nothing is held" in warnings[0]


def test_seams_between_groups_are_no_rims() -> None:
    """Two groups that share vertices, as modellers write them for two materials, are one sheet: the middle is free and
    the edges between them are there once. Two that share none are two."""
    scene, _ = opened(GRID + "g red\nf 1 4 5 2\nf 2 5 6 3\ng blue\nf 4 7 8 5\nf 5 8 9 6\n")
    assert [f.name for f in scene.forces] == ["red"] and len(anchors(scene)["naked vertices"]) == 8
    assert len(Simulation(scene).system.groups[0].block.indices) == 12
    apart, _ = opened(SHEET + "v 9 0 0\nv 10 0 0\nv 9 1 0\no sail\nf -3 -2 -1\n")
    assert [f.name for f in apart.forces] == ["sheet", "sail"]


def test_vertices_that_every_face_has_for_itself_are_welded() -> None:
    """As some programs write: without it every vertex were naked and nothing could move."""
    corners = ((0, 0), (1, 0), (1, 1), (0, 1))
    rows = [f"v {i + a} {j + b} 0" for i in range(3) for j in range(3) for a, b in corners]
    rows += [f"f {k} {k + 1} {k + 2} {k + 3}" for k in range(1, 36, 4)]
    scene, _ = opened("\n".join(rows))
    assert len(Simulation(scene).system.x) == 16 and len(anchors(scene)["naked vertices"]) == 12


def test_small_models_keep_their_shape() -> None:
    """A sheet of 2 mm drawn in metres: vertices 1e-3 apart stay apart."""
    text = "".join(f"v {1e-3 * i} {1e-3 * j} 0\n" for i in range(3) for j in range(3)) + SHEET[len(GRID) :]
    assert len(Simulation(opened(text)[0]).system.x) == 9


# the format


def test_polygons_are_cut_into_triangles_and_that_is_said() -> None:
    """A pentagon gives three, a notched one too; areas stay: 1.25 and 0.75."""
    for top, area in (("0.5 1.5 0", 1.25), ("0.5 0.5 0", 0.75)):
        found = read(f"v 0 0 0\nv 1 0 0\nv 1 1 0\nv {top}\nv 0 1 0\nf 1 2 3 4 5\n".encode())
        mesh = found.meshes[0][1]
        a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
        assert len(mesh.faces) == 3
        assert 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() == pytest.approx(area, abs=1e-12)
        assert "1 face of more than four corners" in found.warnings[0]


def test_words_of_the_format() -> None:
    """Slashes, indices from behind, lines that go on, comments, colours after coordinates, any end of line."""
    text = (
        "\ufeff# a comment\r\nv 0 0 0 1.0\r\nv 1 0 0 0.5 0.5 0.5\rv 1 1 0 # here\nvn 0 0 1\nvt 0 0\n\n"
        "usemtl red\ns off\ncstype bezier\nwhatever 1 2\nf 1/1/1 2//1 \\\n  3/1\nl -3 -1\n"
    )
    found = read(text.encode())
    assert found.meshes[0][1].faces.tolist() == [[0, 1, 2, 2]] and found.lines[0][1].tolist() == [
        [[0, 0, 0], [1, 1, 0]]
    ]
    (said,) = found.warnings
    for name in ("normals", "texture coordinates", "materials", "smoothing", "free-form", '"whatever"'):
        assert name in said


def test_what_has_no_extent_is_left_out_and_that_is_said() -> None:
    found = read((SHEET + "f 1 1 2\nf 1 2 1\nl 1 1\n").encode())
    assert len(found.meshes[0][1].faces) == 4 and not found.lines
    assert found.warnings == ["3 faces or lines of zero size left out"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("v 0 0\n", "line 1: a vertex needs three coordinates"),
        ("v 0 0 x\n", "line 1: a vertex needs three coordinates"),
        ("v 0 0 1_0\n", "line 1: a vertex needs three coordinates"),
        ("\nv 0 0 nan\n", "line 2: a coordinate is not finite"),
        ("v 0 0 1e300\n", "line 1: a coordinate is not finite, or larger than 1e+12"),
        (GRID + "f 1 2 0\n", 'line 10: "0" is not a vertex number'),
        (GRID + "f 1 2 x\n", 'line 10: "x" is not a vertex number'),
        (GRID + "f 1 2 1.5\n", 'line 10: "1.5" is not a vertex number'),
        (GRID + "f 1 2 10\n", "line 10: vertex 10 does not exist; there are 9"),
        (GRID + "f 1 2 -10\n", "line 10: vertex -10 does not exist; there are 9 before this line"),
        (GRID + "f 1 2\n", "line 10: a face of 2 vertices given; it needs at least 3"),
        (GRID + "l 1\n", "line 10: a line of 1 vertices given; it needs at least 2 vertices"),
        (GRID + "p\n", "line 10: a point of 0 vertices given; it needs at least 1 vertex"),
        (GRID + "f 1 \\\n 9 \\\n 3 7 1 2 8\n", "line 10: this face crosses itself"),
        (GRID, "has no lines or faces"),
        ("# nothing\n", "has no vertices"),
        ("", "has no vertices"),
        ("\0\1\2", "has no vertices"),
    ],
)
def test_a_fault_is_a_sentence_with_its_line(text: str, said: str) -> None:
    with pytest.raises(InputError) as raised:
        opened(text)
    assert said in raised.value.sentence and "\n" not in str(raised.value)


def test_what_hookean_writes_it_reads() -> None:
    """A relaxed scene in mm written as OBJ: the same particles, in m, the mesh as faces, the cable as lines."""
    scene = Scene(
        units={"length": "mm"},
        meshes={"net": {"vertices": [[1000.0 * i, 1000.0 * j, 0] for i in range(3) for j in range(3)],
                        "faces": [[0, 3, 4, 1], [1, 4, 5, 2], [3, 6, 7, 4], [4, 7, 8, 5]]}},
        forces=[{"kind": "springs", "name": "net", "mesh": "net", "rest_factor": 0.5},
                {"kind": "springs", "name": "tie", "lines": [[[2000, 2000, 0], [3000, 3000, 0]]]},
                {"kind": "unary", "points": [[1000, 1000, 0]], "vector": [0, 0, 5]}],
        anchors=[{"points": [[0, 0, 0], [2000, 0, 0], [0, 2000, 0], [3000, 3000, 0]]}],
    )  # fmt: skip
    moved = Simulation(scene)
    moved.relax()
    again, warnings = opened(obj.text(moved.system, moved.state.x, moved.state.free))
    found = Simulation(again).system
    assert not warnings and [f.name for f in again.forces] == ["net", "tie"] and again.units.length == "m"
    order = [np.lexsort(x.round(9).T) for x in (found.x, 1e-3 * moved.state.x)]
    assert np.abs(found.x[order[0]] - 1e-3 * moved.state.x[order[1]]).max() < 1e-9
    assert len(found.groups[0].block.indices) == 13


# COMPAS and scenes


def test_documents_of_compas_are_taken_as_drawn() -> None:
    """Lines and polylines as springs, meshes as membranes, clouds as anchors; frames and vectors are told."""
    lines = [Line([0, 0, 0], [1, 0, 0]), Polyline([[1, 0, 0], [2, 0, 0], [3, 1, 0]])]
    scene, warnings = opened(compas.data.json_dumps(lines), "a.json")
    assert anchors(scene) == {"loose ends": [(0, 0, 0), (3, 1, 0)]} and not warnings
    more = [*lines, Polygon([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), Frame.worldXY(), Vector(0, 0, 1)]
    scene, warnings = opened(compas.data.json_dumps([*more, Pointcloud([[0, 0, 0]])]), "a.json")
    assert anchors(scene) == {"points": [(0, 0, 0)]}
    (said,) = warnings
    assert said.startswith("not read from the file: 2 documents") and "Frame" in said and "Vector" in said
    sheet = Mesh.from_meshgrid(2, 2)
    scene, warnings = opened(compas.data.json_dumps([sheet]), "a.json")
    assert len(anchors(scene)["naked vertices"]) == 8 and not warnings
    scene, warnings = opened(compas.data.json_dumps(sheet), "a.json")
    assert len(scene.anchors[0].particles) == 8 and not warnings, "alone: its vertices in their order"
    cube = Mesh.from_polyhedron(6)
    scene, warnings = opened(compas.data.json_dumps(cube), "a.json")
    assert not scene.anchors and "closed" in warnings[0]


def test_a_graph_alone_is_the_net_it_is_everywhere() -> None:
    graph = Graph.from_edges({(0, 1): {}, (1, 2): {}, (1, 3): {}})
    for i in range(4):
        graph.node_attributes(i, "xyz", [float(i == 2), float(i), 0.0])
    scene, warnings = opened(compas.data.json_dumps(graph), "a.json")
    assert sorted(scene.anchors[0].particles) == [0, 2, 3] and not warnings
    assert relax(scene).status == "converged"


def test_a_scene_is_as_it_says() -> None:
    given = opened(SHEET)[0]
    scene, warnings = opened(given.canonical, "a.json")
    assert scene.digest == given.digest and not warnings


@pytest.mark.parametrize(
    ("value", "pointer", "said"),
    [
        ({"forces": [{"kind": "sprngs"}]}, "/forces/0", "sprngs"),
        ([{"dtype": "compas.geometry/Line", "data": {"start": [0, 0, 0]}}], "/0/data/end", "three numbers"),
        ({"dtype": "compas.datastructures/Volmesh", "data": {}}, "/dtype", "supported are"),
        ([{"dtype": "os/system", "data": "x"}], "", "no lines or faces"),
        ([1, 2], "/0", "COMPAS document"),
        ([], "", "no lines or faces"),
        ({"status": "converged", "particles": []}, "/", "result"),
        (7, "/", ""),
    ],
)
def test_faults_of_json_are_pointed_at(value: object, pointer: str, said: str) -> None:
    with pytest.raises(InputError) as raised:
        opened(json.dumps(value), "a.json")
    assert raised.value.pointer == pointer and said in raised.value.sentence


@pytest.mark.parametrize(
    ("data", "name", "found"),
    [
        (b"", "a.OBJ", "obj"),
        (b"", "b.json", "json"),
        (b"", "../x/c.3DM", "3dm"),
        (b" \n{}", "upload", "json"),
        (b"\xef\xbb\xbf[1]", "", "json"),
        (b"3D Geometry File Format        7", "blob", "3dm"),
        (b"# made by\nmtllib x\nv 0 0 0", "noname", "obj"),
    ],
)
def test_kinds_are_told_apart(data: bytes, name: str, found: str) -> None:
    assert readers.reader(data, name).suffix == f".{found}"


@pytest.mark.parametrize(("data", "name"), [(b"solid ascii", "a.stl"), (b"\x89PNG", "a.png"), (b"", ""), (b"\0", "")])
def test_other_kinds_are_refused(data: bytes, name: str) -> None:
    with pytest.raises(InputError, match=r"give a \.3dm, \.obj, \.json, \.npz or \.hookean file"):
        readers.reader(data, name)


def _mutated(data: bytes, chance: random.Random) -> bytes:
    """A cut, a few changed bytes, or lines in another order."""
    changed = bytearray(data)
    what = chance.randrange(4)
    if what == 0:
        return data[: chance.randrange(len(data))]
    if what == 1:
        lines = data.splitlines(keepends=True)
        chance.shuffle(lines)
        return b"".join(lines[: chance.randrange(len(lines))])
    for _ in range(chance.randrange(1, 6)):
        place = chance.randrange(len(changed))
        if what == 2:
            changed[place] = chance.randrange(256)
        else:
            changed[place:place] = chance.choice([b"-", b"9", b"e9", b"/", b"\n", b"{", b'"', b"nan", b"\0", b"1e400"])
    return bytes(changed)


@pytest.mark.thinned
@pytest.mark.parametrize("seed", range(6))
def test_damaged_files_give_a_scene_or_a_sentence(seed: int) -> None:
    """Cuts and mutations of good files: nothing but InputError, whatever is in them."""
    chance = random.Random(seed)
    document = compas.data.json_dumps([Line([0, 0, 0], [1, 0, 0]), Mesh.from_meshgrid(2, 2), Pointcloud([[0, 0, 0]])])
    texts = {"a.obj": (SHEET + CUBE + CABLE + "f 1 2 3 6 9 8\n").encode(), "a.json": document.encode()}
    faults = 0
    for name, data in texts.items():
        for _ in range(150):
            try:
                scene, _ = opened(_mutated(data, chance), name)
                Simulation(scene)
            except InputError as error:
                faults += 1
                assert error.sentence and "\n" not in str(error)
    assert faults > 50


@pytest.mark.parametrize("name", ["", "a.obj", "a.json"])
def test_a_git_lfs_pointer_is_named(name: str) -> None:
    with pytest.raises(InputError, match="is a Git LFS pointer, not the file itself"):
        readers.read(b"version https://git-lfs.github.com/spec/v1\noid sha256:" + b"4d" * 32 + b"\nsize 1\n", name)
