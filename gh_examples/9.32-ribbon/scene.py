"""Figure 9.32: the concert hall ribbon, a membrane stretched over free-form beams and arcs, along which it slides."""

from pathlib import Path
from typing import Any

import numpy as np

from hookean import InputError, Scene
from hookean.discretize import mesh_surface, naked_vertices, warp_weft
from hookean.discretize.closest import distances, polyline
from hookean.files.rhino import threedm
from hookean.values.mesh import Mesh

PIECES = 2000  # of a curve that particles are pulled to


def scene(
    surface: Any = None, beams: Any = None, arcs: Any = None, end_arcs: Any = None, along: int = 60, across: int = 20,
    stiffness: float = 4.0, rest_factor: float = 0.5, strength: float = 2000.0, tolerance: float = 0.001,
) -> Scene:  # fmt: skip
    """A `surface` of rhino3dm or COMPAS with `along` by `across` faces, held where its rim lies on `end_arcs`; without
    a surface all four are those of model.3dm.

    Its edges are springs of a `stiffness` [kN/m] and a `rest_factor` [-]. Vertices of the rim slide along the `beams`
    they lie on, all others along the `arcs`, pulled to them with a `strength` [kN/m]. InputError where no vertex lies
    on one, to a `tolerance` [m].
    """
    if surface is None:
        surface, beams, arcs, end_arcs = drawn()
    mesh = mesh_surface(surface, along, across)
    warp, weft = warp_weft(mesh)
    rim, everywhere = naked_vertices(mesh), np.arange(len(mesh.vertices))
    pulls = pulled("beams", beams, mesh, rim, strength, tolerance)
    pulls += pulled("arcs", arcs, mesh, everywhere, strength, tolerance)
    ends = rim[apart(mesh.vertices[rim], end_arcs).min(axis=0) <= tolerance]
    if not len(ends):
        raise InputError("end_arcs", "no vertex of the rim lies on one; they are the short edges of the surface")
    springs = [
        {"kind": "springs", "name": name, "particles": pairs, "stiffness": stiffness, "rest_factor": rest_factor}
        for name, pairs in (("across", weft), ("along", warp))
    ]
    return Scene(
        units={"force": "kN"},
        particles=mesh.vertices,
        forces=[*springs, *pulls],
        anchors=[{"name": "ends", "particles": ends}],
        meshes={"membrane": {"vertices": mesh.vertices, "faces": mesh.faces}},
        geometry=[{"name": "membrane", "kind": "mesh", "mesh": "membrane"}],
        settings={"tolerance": 1e-10},
    )


def drawn() -> tuple[Any, Any, Any, Any]:
    """Surface, beams, inner arcs and those at the ends in model.3dm."""
    objects = threedm.read(Path(__file__).parent / "model.3dm").objects
    layers = ("membrane", "beams", "arcs::inner", "arcs::ends")
    surfaces, *curves = ([o.geometry for o in objects if o.layer == layer] for layer in layers)
    return surfaces[0], *curves


def apart(points: np.ndarray, curves: list[Any]) -> np.ndarray:
    """Distances (curves, points) [m]."""
    return np.array([distances(points, curve) for curve in curves])


def pulled(
    name: str, curves: list[Any], mesh: Mesh, chosen: np.ndarray, strength: float, tolerance: float
) -> list[dict[str, Any]]:
    """Pulls of the chosen vertices that lie on a curve, each to the nearest."""
    off = apart(mesh.vertices[chosen], curves)
    near = off.min(axis=0) <= tolerance
    if not near.any():
        raise InputError(name, f"no vertex lies on one; the nearest is {off.min():.6g} away")
    found = []
    for i in np.unique(off.argmin(axis=0)[near]):
        rows = near & (off.argmin(axis=0) == i)
        corners = polyline(curves[i], PIECES)
        closed = bool((corners[0] == corners[-1]).all())
        curve = {"curve": corners[:-1] if closed else corners, "closed": closed, "strength": strength}
        found.append({"kind": "pull_to_curve", "name": f"{name} {i + 1}", "particles": chosen[rows], **curve})
    return found
