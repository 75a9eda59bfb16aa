"""Breps and extrusions to one mesh whose faces share vertices along shared edges."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize import seams
from hookean.discretize.meshes import as_mesh, join, tidy_faces, weld
from hookean.discretize.surfaces import compact, counts, grid_faces, mesh_grid, sample
from hookean.discretize.triangulate import plane_coordinates, triangulate
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_SAME = 1e-6  # relative to the size of the whole


def mesh_faces(geometry: Any, u: int, v: int, name: str = "", *, whole: bool = False) -> Mesh:
    """A rhino3dm Brep, BrepFace, Extrusion or surface as one mesh, normals outward as of the Brep's faces.

    Untrimmed faces become u by v quads as `mesh_surface` makes them, and neighbours share the vertices
    of a shared edge. For that u and v may change places on a face, and where no exchange helps (the
    three directions of a box) a face gets u by u or v by v. An edge that meets only part of another
    face's side (a T) cannot agree: there only what coincides, within 1e-6 of the size, is welded.

    A trimmed face is meshed from the surface below it, without its cuts, only if `whole`. An extrusion's
    caps are filled with triangles on the vertices of its walls. In a Brep a trimmed face otherwise gives its
    cached render mesh; if all faces have one, all of them do (they fit each other, and u and v are unused).

    Raises InputError naming `name` and the trimmed faces without a cached mesh, or where `mesh_surface`
    does.
    """
    u, v = counts(u, v)
    pointer = name or "geometry"
    if hasattr(geometry, "ProfileCount"):
        brep = geometry.ToBrep(True)
        if brep is None:
            raise InputError(pointer, "this extrusion has no Brep form; it is invalid, rebuild it")
        return _mesh_walls_and_caps(geometry, brep, u, v, pointer)
    if hasattr(geometry, "OuterLoop"):
        return _mesh_brep([geometry], None, u, v, pointer, whole)
    if hasattr(geometry, "Faces") and hasattr(geometry, "Edges"):
        faces = [geometry.Faces[i] for i in range(len(geometry.Faces))]
        return _mesh_brep(faces, geometry.Edges, u, v, pointer, whole)
    if hasattr(geometry, "IsoCurve") or hasattr(geometry, "domain_u"):
        return mesh_grid(geometry, u, v)
    raise InputError(pointer, f"{type(geometry).__name__} has no faces; give a Brep, BrepFace, Extrusion or surface")


def is_trimmed(face: Any) -> bool:
    """Whether a rhino3dm BrepFace covers less than its underlying surface.

    A Brep of the face alone shows this: it is a surface only if the face has one loop, all of it on the
    four sides of the surface's domain.
    """
    alone = face.DuplicateFace(False)
    return alone is None or not alone.IsSurface


def _mesh_brep(faces: list[Any], edges: Any, u: int, v: int, pointer: str, whole: bool) -> Mesh:
    trimmed = [is_trimmed(f) for f in faces]
    if not any(trimmed):
        return _mesh_untrimmed(faces, edges, u, v, pointer)
    if whole:  # the sides of a surface are no edges of a face that is cut from it
        return _welded(join([_mesh_untrimmed([face], None, u, v, pointer) for face in faces]))
    import rhino3dm

    cached = [f.GetMesh(rhino3dm.MeshType.Any) for f in faces]
    missing = [i for i, mesh in enumerate(cached) if trimmed[i] and (mesh is None or not len(mesh.Faces))]
    if missing:
        which = f"face {missing[0]} is" if len(missing) == 1 else f"faces {', '.join(map(str, missing))} are"
        raise InputError(
            pointer,
            f"{which} trimmed and without a cached render mesh; only untrimmed faces are meshed here: "
            'save the file shaded, mesh them in Rhino, or leave out their cuts with divide = [u, v, "whole"]',
        )
    if all(mesh is not None and len(mesh.Faces) for mesh in cached):
        parts = [as_mesh(mesh) for mesh in cached]
    else:
        parts = [
            as_mesh(mesh) if is_cut else _mesh_untrimmed([face], None, u, v, pointer)
            for face, mesh, is_cut in zip(faces, cached, trimmed, strict=True)
        ]
    return _welded(join(parts))


def _welded(mesh: Mesh) -> Mesh:
    return weld(mesh, _SAME * float(np.ptp(mesh.vertices, axis=0).max()))


def _mesh_untrimmed(faces: list[Any], edges: Any, u: int, v: int, pointer: str) -> Mesh:
    points, same, quads, _ = _grids(faces, edges, u, v, pointer)
    return compact(points, same, quads)


def _mesh_walls_and_caps(extrusion: Any, brep: Any, u: int, v: int, pointer: str) -> Mesh:
    faces = [brep.Faces[i] for i in range(len(brep.Faces))]
    caps = [f for f in faces if is_trimmed(f)]
    walls = [f for f in faces if not is_trimmed(f)]
    points, same, quads, chains = _grids(walls, brep.Edges, u, v, pointer)
    try:
        cuts = [_cap(f, points, same, chains, pointer) for f in caps]
    except InputError:
        import rhino3dm

        cached = extrusion.GetMesh(rhino3dm.MeshType.Any)
        if cached is None:
            raise
        return _welded(as_mesh(cached))
    return compact(points, same, np.concatenate([quads, *cuts]))


def _grids(faces: list[Any], edges: Any, u: int, v: int, pointer: str) -> tuple[Array, Index, Index, dict[int, Index]]:
    """Points of all faces, what each is the same as, all quads, and the points along each edge."""
    sides = [seams.face_sides(f, edges) if edges is not None else [] for f in faces]
    size = seams.face_counts(sides, u, v)
    try:
        grids = [sample(f, *n) for f, n in zip(faces, size, strict=True)]
        ids, same, chains = seams.shared_ids(grids, sides)
    except InputError as error:
        raise InputError(pointer, f"{error.pointer}: {error.sentence}") from None
    points = np.concatenate([g.reshape(-1, 3) for g in grids])
    quads = [
        _flipped(grid_faces(i)) if f.OrientationIsReversed else grid_faces(i) for f, i in zip(faces, ids, strict=True)
    ]
    return points, same, np.concatenate(quads), chains


def _flipped(faces: Index) -> Index:
    # b a d c rather than d c b a: the first side stays the first
    return faces[:, [1, 0, 3, 2]]


def _cap(face: Any, points: Array, same: Index, chains: dict[int, Index], pointer: str) -> Index:
    """Triangles of a plane trimmed face on the points that lie along its edges."""
    loops = []
    for loop in (face.Loops[i] for i in range(len(face.Loops))):
        ring: list[int] = []
        for trim in (loop.Trims[i] for i in range(loop.TrimCount)):
            if trim.EdgeIndex not in chains:
                raise InputError(pointer, f"edge {trim.EdgeIndex} of a cap does not meet a wall; rebuild the extrusion")
            chain = same[chains[trim.EdgeIndex]]
            ring.extend((chain[::-1] if trim.IsReversed else chain)[:-1].tolist())
        loops.append(np.array(ring))
    middle = face.NormalAt(*(0.5 * (face.Domain(d).T0 + face.Domain(d).T1) for d in (0, 1)))
    normal = np.array([middle.X, middle.Y, middle.Z])
    if face.OrientationIsReversed:
        normal = -normal
    rim = np.unique(np.concatenate(loops))
    place = [np.searchsorted(rim, loop) for loop in loops]
    try:
        t = rim[triangulate(plane_coordinates(points[rim] - points[rim[0]], normal), place)]
    except InputError as error:
        raise InputError(pointer, f"a cap cannot be filled: {error.sentence}") from None
    return tidy_faces(np.concatenate([t, t[:, 2:]], axis=1))
