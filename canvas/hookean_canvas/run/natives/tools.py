"""Tools of Kangaroo that make geometry and need no solver, by their ids in public definitions.

Source: `hookean_canvas.kangaroo.ids`, and the tooltips of the components.
"""

from __future__ import annotations

from typing import Any

from hookean.discretize import meshes as core
from hookean.discretize.duplicates import unique_points
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import native
from hookean_canvas.run.natives.meshes import combined


@native("c8b01cec-6dd9-460b-b43f-254314ffdc2e", "MeshCorners", "MC",
        "Mesh (M): mesh; Angle (A): number = 2.356194490192345", "Corners (C): list")  # fmt: skip
def mesh_corners(mesh: Any, angle: float) -> list[Any]:
    """The vertices on the boundary of a mesh with an interior angle below one in radians."""
    vertices, faces = shapes.mesh_parts(mesh)
    return shapes.points(vertices[core.corners((vertices, faces), angle)])


@native("7a01aec4-142c-4319-836d-a550b6b63d2d 5e2f9e3f-d467-46f6-870c-6fa7cd01e1ed", "removeDuplicatePts", "dupPt",
        "points (P): point list; tolerance (T): number = 0.01", "unique points (Q): list")  # fmt: skip
def remove_duplicate_points(places: list[Any], tolerance: float) -> list[Any]:
    """Points without those that are within a tolerance of an earlier one."""
    found = [place for place in places if place is not None]
    kept, _ = unique_points(shapes.rows(found), tolerance)
    return [found[int(i)] for i in kept]


@native("2491e794-8360-4317-b0ad-4950f6e0906a 3ec0b1a3-d39a-4a47-abe2-96f68d5053c8", "Combine&Clean", "CC",
        "Meshes (M): mesh list", "Mesh (M)")  # fmt: skip
def combine_and_clean(meshes: list[Any]) -> Any:
    """Meshes as one, without unused vertices, and vertices in one place made one."""
    return combined(meshes)
