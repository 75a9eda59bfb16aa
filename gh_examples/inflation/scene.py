"""A pneumatic roof: a film on a round rim that pressure inflates to a cap, and a cushion of two on a square frame."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import grid, naked_vertices
from hookean.values.mesh import Mesh

ASIDE = 2.6  # radii from the middle of the rim to that of the frame


def scene(
    rings: int = 12, divisions: int = 16, radius: float = 5.0, pressure: float = 300.0, tension: float = 1000.0,
    **settings: Any,
) -> Scene:  # fmt: skip
    """A film in `rings` of triangles on a rim of a `radius` [m], and two films of `divisions` squares a side, above and
    below a square frame twice as wide, with a `pressure` [Pa] under the first and between the others.

    All films have a constant `tension` [N/m].
    """
    cap = disc(rings, radius)
    films = {"cap": cap} | {name: square(divisions, radius, side) for name, side in (("upper", 1.0), ("lower", -1.0))}
    held = [mesh.vertices[naked_vertices(mesh)] for name, mesh in films.items() if name != "lower"]
    return Scene(
        meshes={name: {"vertices": mesh.vertices, "faces": mesh.faces} for name, mesh in films.items()},
        forces=[
            *({"kind": "soapfilm", "name": f"film {name}", "mesh": name, "tension": tension} for name in films),
            *({"kind": "pressure", "name": f"air {name}", "mesh": name, "pressure": pressure} for name in films),
        ],
        anchors=[{"name": name, "points": points} for name, points in zip(("rim", "frame"), held, strict=True)],
        geometry=[{"name": name, "kind": "mesh", "mesh": name} for name in films],
        settings={"tolerance": 1e-9, **settings},
    )


def disc(rings: int, radius: float) -> Mesh:
    """A flat disc [m] of rings of six times 1, 2, 3 ... points round its middle, with normals up."""
    points, faces, inner = [np.zeros((1, 3))], [], np.zeros(1, int)
    for ring in range(1, rings + 1):
        turn = np.pi / 3.0 * np.arange(6 * ring) / ring
        points.append(radius * ring / rings * np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn]))
        outer = inner[-1] + 1 + np.arange(6 * ring)
        for k in range(6 * ring):
            side, step = divmod(k, ring)
            near = side * (ring - 1) + step
            a, b = inner[near % len(inner)], inner[(near + 1) % len(inner)]
            faces.append([a, outer[k], outer[(k + 1) % len(outer)], outer[(k + 1) % len(outer)]])
            if step < ring - 1:
                faces.append([a, outer[(k + 1) % len(outer)], b, b])
        inner = outer
    return Mesh(np.concatenate(points), np.array(faces))


def square(divisions: int, radius: float, side: float) -> Mesh:
    """A film [m] over or under the frame, a little off its plane but at the frame, with normals outwards."""
    along = radius * np.linspace(-1.0, 1.0, divisions + 1)
    off = 1.0 - (along / radius) ** 2
    mesh = grid(along, along, side * 0.4 * radius * np.outer(off, off))
    return Mesh(mesh.vertices + [ASIDE * radius, 0.0, 0.0], mesh.faces if side > 0 else mesh.faces[:, ::-1])
