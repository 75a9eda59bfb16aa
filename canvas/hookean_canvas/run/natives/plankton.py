"""Components of Plankton, halfedge meshes: here a mesh whose vertices are welded and whose faces have one direction.

Names, ids, inputs, outputs and what is cleaned: its source (github.com/meshmash/Plankton, src/PlanktonGh). Meshes of
Rhino have triangles and quads alone, so faces of more corners never come to these.
"""

from __future__ import annotations

from typing import Any

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.meshes import combined, sides, unify_mesh

_NUMBERS = "halfedges have other numbers"


def welded(mesh: Any) -> Any:
    """A mesh as Plankton takes it: vertices in one place made one, no unused ones, faces of one direction."""
    return unify_mesh(combined([mesh]))[0]


@native("047097d1-83bd-4f76-9994-dff721c24047", "CreatePlankton", "CreatePlankton", "Mesh (M): mesh",
        "PlanktonMesh (P)")  # fmt: skip
def create_plankton(mesh: Any) -> Any:
    """A halfedge mesh: vertices in one place made one, without unused ones, all faces in one direction."""
    return welded(mesh)


@native("c9377989-c89e-477d-8dd2-b35af0c3b25d", "PlanktonFromPoints", "PlanktonFromPoints",
        "PMesh (PMesh): halfedge; Vertices (Vertices): point list", "PlanktonMesh (P)")  # fmt: skip
def plankton_from_points(mesh: Any, places: list[Any]) -> Any:
    """A halfedge mesh with other places for its vertices, in their order; those without one stay."""
    vertices, faces = shapes.mesh_parts(mesh)
    if len(places) > len(vertices):
        raise Unfit(f"{len(places)} points for {len(vertices)} vertices; give at most one for each")
    vertices[: len(places)] = shapes.rows(places)
    return shapes.mesh(vertices, faces)


@native("97c28a7c-5d5a-4b3d-a935-b8730e88749b", "DeconstructPlankton", "DeconstructPlankton",
        "PMesh (PMesh): halfedge",
        "Vertex_Points (V): list; Vertex_Outgoing_Halfedge (V_He): list; Halfedge_StartVertex (He_V): list; "
        "Halfedge_AdjacentFace (He_F): list; Halfedge_NextHalfedge (He_Nxt): list; "
        "Halfedge_PrevHalfedge (He_Prv): list; Halfedge_Pair (He_P): list; Face_Halfedge (F_He): list",
        remark=_NUMBERS)  # fmt: skip
def deconstruct_plankton(mesh: Any) -> tuple[list[Any], ...]:
    """The vertices, halfedges and faces of a mesh: pairs of halfedges are 2 i and 2 i + 1, a boundary has face -1, and
    a vertex on it starts with its halfedge along it."""
    vertices, faces = shapes.mesh_parts(mesh)
    number: dict[tuple[int, int], int] = {}
    start: list[int] = []
    beside: list[int] = []
    for k, face in enumerate(faces):
        for pair in sides(face):
            if pair not in number:
                number[pair], number[pair[::-1]] = len(start), len(start) + 1
                start += pair
                beside += [-1, -1]
            if beside[number[pair]] != -1:
                raise Unfit("an edge has more than two faces; a halfedge mesh is a surface without branches")
            beside[number[pair]] = k
    following = _following(faces, number, start, beside)
    before = [-1] * len(start)
    for half, then in enumerate(following):
        before[then] = half
    outgoing = [-1] * len(vertices)
    for half, vertex in enumerate(start):
        if outgoing[vertex] == -1 or beside[half] == -1:
            outgoing[vertex] = half
    pairs = [half ^ 1 for half in range(len(start))]
    return (shapes.points(vertices), outgoing, start, beside, following, before, pairs,
            [number[next(iter(sides(face)))] for face in faces])  # fmt: skip


def _following(
    faces: shapes.Faces, number: dict[tuple[int, int], int], start: list[int], beside: list[int]
) -> list[int]:
    """The next halfedge of each: round its face, or along the boundary."""
    following = [-1] * len(start)
    for face in faces:
        round_it = [number[pair] for pair in sides(face)]
        for half, then in zip(round_it, [*round_it[1:], round_it[0]], strict=True):
            following[half] = then
    leaving = {start[half]: half for half in range(len(start)) if beside[half] == -1}
    for half in leaving.values():
        following[half] = leaving[start[half ^ 1]]
    if -1 in following:
        raise Unfit("parts of the mesh meet in a single vertex of their boundaries; a halfedge mesh has one there")
    return following
