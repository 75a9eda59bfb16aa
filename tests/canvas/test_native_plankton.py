"""Halfedge meshes of Plankton: what its components give obeys the rules of the structure, on any mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from canvas.kangaroo_samples import Kangaroo
from canvas.native_values import called, near
from hookean_canvas.archive import Type
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from hookean_canvas.run.natives import PARAMETERS, Unfit, as_kind, shapes

Mesh = tuple[str, list[tuple[float, ...]], list[tuple[int, ...]]]
CUBE: Mesh = (
    "mesh",
    [(float(i & 1), float(i >> 1 & 1), float(i >> 2)) for i in range(8)],
    [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)],
)
STRIP: Mesh = (
    "mesh",
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 0), (2, 0, 0), (1, 1, 0), (9, 9, 9)],
    [(0, 1, 2, 3), (5, 4, 6)],
)
"""A quad and a triangle that is turned over, with vertices of its own at their common edge, and an unused vertex."""


@pytest.mark.parametrize(("given", "vertices", "edges", "rim"), [(CUBE, 8, 12, 0), (STRIP, 5, 6, 5)])
def test_halfedges_obey_the_rules_of_the_structure(given: Mesh, vertices: int, edges: int, rim: int) -> None:
    """Next and previous are inverse, a pair goes back, a face is its ring; Euler: V - E + F = 2, or 1 with a rim."""
    places, outgoing, start, face, following, before, pair, first = called("DeconstructPlankton", made(given))
    n, faces = len(start), len(given[2])
    assert (len(places), n, len(first)) == (vertices, 2 * edges, faces)
    assert vertices - edges + faces == (1 if rim else 2) and face.count(-1) == rim
    for half in range(n):
        assert pair[pair[half]] == half != pair[half]
        assert start[following[half]] == start[pair[half]]
        assert before[following[half]] == half and face[following[half]] == face[half]
    assert all(start[half] == vertex for vertex, half in enumerate(outgoing))
    for number, half in enumerate(first):
        ring = [half]
        while following[ring[-1]] != half:
            ring.append(following[ring[-1]])
        assert {face[one] for one in ring} == {number} and len(ring) == len(given[2][number])
    assert all(face[outgoing[start[half]]] == -1 for half in range(n) if face[half] == -1)


def made(given: Mesh) -> Any:
    """A mesh as an input for halfedge meshes takes it."""
    return as_kind("halfedge", shapes.mesh(*given[1:]))


def test_creating_welds_vertices_drops_unused_ones_and_turns_faces() -> None:
    vertices, faces = called("CreatePlankton", STRIP)[0]
    assert len(vertices) == 5 and sorted(map(len, faces)) == [3, 4]
    normals = [np.cross(np.subtract(vertices[f[1]], vertices[f[0]]), np.subtract(vertices[f[2]], vertices[f[0]]))
               for f in faces]  # fmt: skip
    assert all(normal[2] > 0 for normal in normals)


def test_points_take_the_places_of_vertices_and_those_without_one_stay() -> None:
    vertices, faces = called("PlanktonFromPoints", made(CUBE), [("point", 5, 6, 7)])[0]
    assert near(vertices[0], (5, 6, 7)) and near(vertices[7], (1, 1, 1)) and len(faces) == 6
    with pytest.raises(Unfit, match="9 points for 8 vertices; give at most one for each"):
        called("PlanktonFromPoints", made(CUBE), [("point", 0, 0, 0)] * 9)


def test_what_is_no_surface_is_refused() -> None:
    three: Mesh = ("mesh", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)], [(0, 1, 2), (0, 1, 3), (0, 1, 4)])
    with pytest.raises(Unfit, match="an edge has more than two faces"):
        called("DeconstructPlankton", made(three))
    bow: Mesh = ("mesh", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (-1, 0, 0), (-1, -1, 0)], [(0, 1, 2), (0, 3, 4)])
    with pytest.raises(Unfit, match="meet in a single vertex"):
        called("DeconstructPlankton", made(bow))


def test_a_mesh_passes_through_plankton_into_a_component_for_meshes() -> None:
    """A parameter PlanktonMesh takes a mesh, and gives one where a mesh is wanted."""
    d = Kangaroo("plankton", "Plankton", "A mesh through Plankton.")
    world = d.native("XY Plane", origin=d.point(0, 0, 0))
    of = d.native("Center Box", base=world, x=1, y=1, z=1)
    box = d.native("Mesh Box", base=of["Box"], x_count=1, y_count=1, z_count=1)
    held = d.parameter("Data", "Held", source=box)
    held.guid = next(guid for guid, (name, _) in PARAMETERS.items() if name == "PlanktonMesh")
    held.container.items = [item for item in held.container.items if item.name != "Name"]
    held.container.put("Name", Type.STRING, "PlanktonMesh")
    d.panel("count", d.native("List Length", list=d.native("Deconstruct Mesh", mesh=held)["Vertices"]))
    panels = Canvas(graph.of(d.archive())).run().panels
    assert panels["count"].values_in_order() == [8]
