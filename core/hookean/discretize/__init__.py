"""Curves to lines, surfaces to meshes, meshes to edges, corners, warp and weft; duplicates removed.

`import hookean.discretize` loads neither rhino3dm nor COMPAS nor scipy; names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hookean.discretize.adjacency import checkerboard as checkerboard
    from hookean.discretize.adjacency import fold_angle as fold_angle
    from hookean.discretize.adjacency import hinge_points as hinge_points
    from hookean.discretize.adjacency import vertex_neighbours as vertex_neighbours
    from hookean.discretize.arcs import arc as arc
    from hookean.discretize.arcs import arc_of_length as arc_of_length
    from hookean.discretize.arcs import arc_through as arc_through
    from hookean.discretize.arcs import interpolate as interpolate
    from hookean.discretize.breps import is_trimmed as is_trimmed
    from hookean.discretize.breps import mesh_faces as mesh_faces
    from hookean.discretize.cleaning import clean as clean
    from hookean.discretize.curves import divide as divide
    from hookean.discretize.curves import end_points as end_points
    from hookean.discretize.curves import explode as explode
    from hookean.discretize.curves import length as length
    from hookean.discretize.curves import shatter as shatter
    from hookean.discretize.duplicates import remove_duplicate_lines as remove_duplicate_lines
    from hookean.discretize.duplicates import remove_duplicate_points as remove_duplicate_points
    from hookean.discretize.duplicates import unique_lines as unique_lines
    from hookean.discretize.duplicates import unique_points as unique_points
    from hookean.discretize.graphs import bipartite as bipartite
    from hookean.discretize.graphs import interconnect_points as interconnect_points
    from hookean.discretize.grids import grid as grid
    from hookean.discretize.grids import quads as quads
    from hookean.discretize.ladders import align_quads as align_quads
    from hookean.discretize.ladders import strips as strips
    from hookean.discretize.ladders import turn_quads as turn_quads
    from hookean.discretize.ladders import unroll_strips as unroll_strips
    from hookean.discretize.mapping import mesh_map as mesh_map
    from hookean.discretize.measures import area as area
    from hookean.discretize.measures import volume as volume
    from hookean.discretize.meshes import as_mesh as as_mesh
    from hookean.discretize.meshes import boundary as boundary
    from hookean.discretize.meshes import clothed_vertices as clothed_vertices
    from hookean.discretize.meshes import corners as corners
    from hookean.discretize.meshes import diagonals as diagonals
    from hookean.discretize.meshes import edges as edges
    from hookean.discretize.meshes import join as join
    from hookean.discretize.meshes import naked_edges as naked_edges
    from hookean.discretize.meshes import naked_vertices as naked_vertices
    from hookean.discretize.meshes import on_boundary as on_boundary
    from hookean.discretize.meshes import triangles as triangles
    from hookean.discretize.meshes import vertices as vertices
    from hookean.discretize.meshes import weld as weld
    from hookean.discretize.meshing import mesh_surface as mesh_surface
    from hookean.discretize.moebius import moebius_transformation as moebius_transformation
    from hookean.discretize.nurbs import NurbsCurve as NurbsCurve
    from hookean.discretize.nurbs import NurbsSurface as NurbsSurface
    from hookean.discretize.nurbs import nurbs_curve as nurbs_curve
    from hookean.discretize.nurbs import nurbs_surface as nurbs_surface
    from hookean.discretize.pipe_meshes import pipes as pipes
    from hookean.discretize.polylines import split_at_corners as split_at_corners
    from hookean.discretize.reciprocal import reciprocal_diagram as reciprocal_diagram
    from hookean.discretize.remeshing import remesh as remesh
    from hookean.discretize.subdivision import diagonalize as diagonalize
    from hookean.discretize.subdivision import refine as refine
    from hookean.discretize.subdivision import refine_strips as refine_strips
    from hookean.discretize.surface_lines import height_lines as height_lines
    from hookean.discretize.surface_lines import water_lines as water_lines
    from hookean.discretize.surface_scalars import curvature as curvature
    from hookean.discretize.surface_scalars import slope as slope
    from hookean.discretize.warpweft import threads as threads
    from hookean.discretize.warpweft import warp_weft as warp_weft

_NAMES = {
    "adjacency": "checkerboard fold_angle hinge_points vertex_neighbours",
    "arcs": "arc arc_of_length arc_through interpolate",
    "breps": "is_trimmed mesh_faces",
    "cleaning": "clean",
    "curves": "divide end_points explode length shatter",
    "duplicates": "remove_duplicate_lines remove_duplicate_points unique_lines unique_points",
    "graphs": "bipartite interconnect_points",
    "grids": "grid quads",
    "mapping": "mesh_map",
    "measures": "area volume",
    "meshes": "as_mesh boundary clothed_vertices corners diagonals edges join naked_edges naked_vertices on_boundary "
    "triangles vertices weld",
    "moebius": "moebius_transformation",
    "nurbs": "NurbsCurve NurbsSurface nurbs_curve nurbs_surface",
    "meshing": "mesh_surface",
    "pipe_meshes": "pipes",
    "polylines": "split_at_corners",
    "reciprocal": "reciprocal_diagram",
    "remeshing": "remesh",
    "ladders": "align_quads strips turn_quads unroll_strips",
    "subdivision": "diagonalize refine refine_strips",
    "surface_lines": "height_lines water_lines",
    "surface_scalars": "curvature slope",
    "warpweft": "threads warp_weft",
}
_HOME = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value
