"""A hypar roof of cloth with edge cables: form, load cases and combinations, of real materials."""

import numpy as np

from hookean import Scene
from hookean.discretize import corners, grid
from hookean.values.mesh import Mesh

WARP, WEFT, STRENGTH = 800.0, 600.0, 79.0  # kN/m: stiffnesses of PVC-polyester II, and the smaller of its strengths


def scene(
    divisions: int = 16, side: float = 10.0, rise: float = 3.0, prestress: float = 2.5, edge_density: float = 8.0,
    snow: float = 0.6, wind: float = 0.5, gravity: float = 0.0088,
) -> Scene:  # fmt: skip
    """A square of a `side` [m] whose corners are in turn at 0 and at `rise` [m], in `divisions` by as many faces.

    Cloth is threads along warp and weft, each for the strip of the drawn width beside it. In the form it has a
    `prestress` [kN/m], edge cables a force density `edge_density` [kN/m] for each part of them. `gravity` is the weight
    of the cloth, `snow` that per plan area, `wind` the velocity pressure [kN/m2].
    """
    mesh, width = drawn(divisions, side, rise), side / divisions
    cloth = {"kind": "springs", "mesh": "roof", "rest_factor": 0.0, "stiffness": prestress}
    return Scene.read({
        "units": {"force": "kN"},
        "particles": mesh.vertices,
        "meshes": {"roof": {"vertices": mesh.vertices, "faces": mesh.faces}},
        "sections": {"edge rope": {"shape": "rope", "diameter": 0.02, "fill_factor": 0.75}},
        "forces": [
            {**cloth, "name": "warp", "edges": "warp"},
            {**cloth, "name": "weft", "edges": "weft"},
            {**cloth, "name": "edge", "edges": "naked", "stiffness": edge_density * divisions},
            {"kind": "area_weight", "name": "self-weight", "mesh": "roof", "weight": gravity},
            {"kind": "area_weight", "name": "snow", "mesh": "roof", "weight": snow, "per": "plan"},
            {"kind": "wind_pressure", "name": "wind", "mesh": "roof", "pressure": wind, "direction": [1, 0, 0],
             "angles": [60, 75, 90, 105, 120], "coefficient": [0.3, -0.2, -0.7, -0.5, -0.4]},
        ],
        "anchors": [{"name": "masts", "particles": corners(mesh)}],
        "geometry": [{"name": "roof", "kind": "mesh", "mesh": "roof"}],
        "load_cases": {"snow": {"forces": ["snow"]}, "wind": {"forces": ["wind"]}},
        "combinations": {
            "ULS snow": {"permanent": 1.35, "snow": 1.5},
            "ULS wind": {"permanent": 1.0, "wind": 1.5},
            "ULS snow and wind": {"permanent": 1.35, "snow": 1.5, "wind": 0.9},
            "SLS snow and wind": {"snow": 1.0, "wind": 0.6},
        },
        "stages": {"freeze": {
            "warp": {"axial_stiffness": WARP * width, "strength": STRENGTH * width, "tension_only": True},
            "weft": {"axial_stiffness": WEFT * width, "strength": STRENGTH * width, "tension_only": True},
            "edge": {"material": "spiral strand 1570", "section": "edge rope", "tension_only": True},
        }},
        "settings": {"tolerance": 1e-9},
    })  # fmt: skip


def drawn(divisions: int, side: float, rise: float) -> Mesh:
    """The grid as it is drawn: a hyperbolic paraboloid on straight edges."""
    along = np.linspace(0.0, 1.0, divisions + 1)
    u, v = np.meshgrid(along, along, indexing="ij")
    return grid(side * along, side * along, rise * (u + v - 2.0 * u * v))
