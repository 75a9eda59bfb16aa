"""A balloon and a pair of bubbles: boxes of film that the gas in them blows up until film and gas are in balance."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import join, quads

SIDE, APART = 1.0, 1.2  # m: of a box, from the balloon to the middle of the pair
END = 1  # side of a box of a pair that is the wall between them


def scene(
    divisions: int = 10, pressure: float = 8.0, outside: float = 1.0, tension: float = 1.0, **settings: Any
) -> Scene:
    """A box of film of `divisions` squares a side by itself, and two that share a wall; film of a `tension` [N/m].

    Each holds gas of a `pressure` [Pa] at the start, in a volume of 1 m3; `outside` [Pa] is the pressure around them.
    """
    single = box(divisions, [-APART - SIDE, -0.5, 0.0], [-APART, 0.5, SIDE])
    left = box(divisions, [0.0, -0.5, 0.0], [SIDE, 0.5, SIDE])
    right = box(divisions, [SIDE, -0.5, 0.0], [2.0 * SIDE, 0.5, SIDE])
    cells = {"balloon": single, "left": left, "right": right}
    films = {
        "film": single,
        "left cap": left[:END] + left[END + 1 :],
        "right cap": right[1:],
        "wall": [left[END]],
    }
    parts = {name: join(sides, tolerance=1e-6) for name, sides in (cells | films).items()}
    return Scene(
        meshes={name: {"vertices": mesh.vertices, "faces": mesh.faces} for name, mesh in parts.items()},
        forces=[
            *({"kind": "gas", "name": f"gas {name}", "mesh": name, "pressure": pressure, "outside": outside}
              for name in cells),
            *({"kind": "soapfilm", "name": name, "mesh": name, "tension": tension} for name in films),
        ],
        geometry=[{"name": name, "kind": "mesh", "mesh": name} for name in films],
        settings={"tolerance": 1e-7, "solver": "relaxation", **settings},
    )  # fmt: skip


def box(divisions: int, low: list[float], high: list[float]) -> list[Any]:
    """The six sides of a box as meshes with normals outwards: at the least and the greatest x, y and z."""
    corner, size = np.array(low), np.subtract(high, low)
    along = np.linspace(0.0, 1.0, divisions + 1)
    u, v = np.meshgrid(along, along, indexing="ij")
    sides = []
    for axis in range(3):
        for end in (0.0, 1.0):
            place = np.empty((*u.shape, 3))
            place[..., axis] = end
            # the other two axes in the order that turns the normal outwards
            one, other = (axis + 1) % 3, (axis + 2) % 3
            place[..., one], place[..., other] = (u, v) if end else (v, u)
            sides.append(quads(corner + place * size))
    return sides
