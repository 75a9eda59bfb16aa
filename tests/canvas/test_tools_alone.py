"""The code inside the user objects that discretize, alone in the Pythons of Rhino: the numbers of the core itself."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hookean.discretize as hd
from canvas.test_isolated import CURVE, MOVED, PYTHONS, QUADS, SAMPLES, SURFACE, ask, step
from hookean.discretize import divide, interpolate, mesh_surface, meshes, nurbs_curve, nurbs_surface, shatter, threads
from hookean.discretize.catenary import catenary
from hookean.files.rhino import threedm
from hookean.running.live import live_film
from hookean.values.mesh import Mesh
from serving import Home

ROOF = Path(__file__).parents[2] / "gh_examples" / "9.24-membrane" / "model.3dm"
MESH = Mesh(np.array(QUADS["vertices"], dtype=float), np.array(QUADS["faces"]))
BENT = nurbs_curve(**CURVE["NurbsCurve"])
V = MESH.vertices


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    found = Home(tmp_path_factory.mktemp("alone") / "state")
    found.serve()
    yield found
    found.end()


def wanted() -> dict[str, dict[str, Any]]:
    """By component and output what the core gives for the samples."""
    cable = catenary([0, 0, 0], [3, 1, 0], 4.0, count=5)
    warp, weft, warp_naked, weft_naked = threads(MESH)
    surface = mesh_surface(nurbs_surface(**SURFACE["NurbsSurface"]), 3, 2)
    lines = shatter(BENT, 4)
    naked, clothed = meshes.boundary(MESH)
    row = [place["Point3d"] for place in SAMPLES["Interpolate"]["_points"]]
    hinges = dict(zip(("start", "end", "tip_1", "tip_2"), (V[i] for i in hd.hinge_points(MESH)), strict=True))
    moved = Mesh(np.array(MOVED["Mesh"]["vertices"], dtype=float), MESH.faces)
    pattern, first, second = hd.checkerboard(MESH)
    return {
        "Divide": {"points": divide(BENT, 7)},
        "Shatter": {"lines": lines, "lengths": np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1)},
        "Catenary": {"catenary": [cable], "points": cable, "lines": np.stack([cable[:-1], cable[1:]], axis=1)},
        "Interpolate": {"curve": interpolate(row, 6)},
        "MeshSurface": {"mesh": [surface]},
        "MeshEdges": {"edges": V[meshes.edges(MESH)], "naked": V[meshes.naked_edges(MESH)]},
        "MeshVertices": {"points": V},
        "MeshCorners": {"corners": V[meshes.corners(MESH)], "indices": meshes.corners(MESH)},
        "NakedVertices": {"naked_index": naked, "clothed_index": clothed, "naked_points": V[naked]},
        "WarpWeft": {"warp": V[warp], "weft": V[weft], "warp_naked": warp_naked, "weft_naked": weft_naked},
        "Diagonals": {"diagonals": V[meshes.diagonals(MESH)]},
        "RemoveDuplicateLines": {"lines": [[[0, 0, 0], [1, 0, 0]]]},
        "RemoveDuplicatePoints": {"points": row},
        "CombineClean": {"mesh": [hd.clean([MESH])]},
        "Refine": {"mesh": [hd.refine(MESH, smooth=True)]},
        "RefineStrips": {"mesh": [hd.refine_strips(MESH, 2)]},
        "Remesh": {"mesh": [hd.remesh(MESH, 0.4)]},
        "LiveFilm": {"mesh": [live_film(MESH, 0.4)]},
        "Diagonalize": {"mesh": [hd.diagonalize(MESH)]},
        "Checkerboard": {"pattern": pattern, "first": first, "second": second},
        "HingePoints": hinges,
        "FoldAngle": {"angle": [0.0, np.pi / 4]},
        "VertexNeighbours": {"points": V[[1, 4]], "normals": hd.vertex_neighbours(MESH, [1, 4])[1]},
        "MeshMap": {"points": hd.mesh_map(row, MESH, moved)},
        "SplitAtCorners": {"corners": [[2, 0, 0]]},
        "InterconnectPoints": {"lines": hd.interconnect_points(row)},
        "Bipartite": {"first": [[0, 0, 0], [2, 0, 1]], "second": [[1, 0, 0]]},
        "MoebiusTransformation": {"points": hd.moebius_transformation(row, 0.4)},
        "Pipes": {"mesh": [hd.pipes([[[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 1, 0.3]]], 0.1, 4, 0.01)]},
        "AlignQuads": {"mesh": [hd.align_quads(MESH)]},
        "TurnQuads": {"mesh": [hd.turn_quads(MESH, 3)]},
        "Strips": {"strips": hd.strips(MESH)},
        "UnrollStrips": {"mesh": [hd.unroll_strips(MESH, "weft", 0.25)]},
        "ReciprocalDiagram": {"densities": [1.0]},
    }


def plain(value: Any) -> Any:
    """An output without the names of Rhino's types; a mesh as vertices and faces."""
    if isinstance(value, dict):
        [found] = value.values()
        return found
    return [plain(one) for one in value] if isinstance(value, list) else value


@pytest.mark.parametrize("version", PYTHONS)
def test_surfaces_of_a_file_are_meshed_as_the_core_meshes_them(version: str, home: Home, tmp_path: Path) -> None:
    """From the file by the component of files, then by that of surfaces."""
    file = step(version, "RhinoFile", {"_file": [str(ROOF)], "_u_": [4], "_v_": [3]})
    given = {"_surface": {"output": [0, "surfaces"]}, "_u_": [4], "_v_": [3]}
    steps = [file, step(version, "MeshSurface", given)]
    drawn, meshed = (a["outputs"] for a in ask(version, {"steps": steps}, tmp_path / "alone", home))
    wanted = mesh_surface(threedm.read(ROOF).foreign()[0].geometry, 4, 3)
    for found in (drawn["meshes"], meshed["mesh"]):
        assert plain(found)[0]["faces"] == wanted.faces.tolist()
        assert np.allclose(plain(found)[0]["vertices"], wanted.vertices, rtol=0, atol=1e-13)
    assert plain(drawn["surfaces"])[0]["degree_u"] > 1


@pytest.mark.slow
@pytest.mark.parametrize("version", PYTHONS)
def test_components_give_the_numbers_of_the_core(version: str, home: Home, tmp_path: Path) -> None:
    expected = wanted()
    steps = [step(version, name, SAMPLES[name]) for name in expected]
    for name, answer in zip(expected, ask(version, {"steps": steps}, tmp_path / "alone", home), strict=True):
        assert not answer["messages"], (name, answer["messages"])
        for output, value in expected[name].items():
            found = plain(answer["outputs"][output])
            if output == "mesh":
                [made] = found if isinstance(found, list) else [found]
                assert np.array_equal(made["faces"], value[0].faces)
                found, value = made["vertices"], value[0].vertices
            assert np.shape(found) == np.shape(value), (name, output)
            assert np.allclose(found, value, rtol=0, atol=1e-14), (name, output)
