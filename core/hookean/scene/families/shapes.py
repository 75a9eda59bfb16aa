"""Plans on which families build their scenes: rectangles and discs of quads, what of them is held, what hangs there."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.grids import grid, quads
from hookean.discretize.meshes import edges
from hookean.forces.springs import Springs
from hookean.forces.unary import Unary
from hookean.scene.scene import Anchor, MeshData, Scene
from hookean.values.mesh import Mesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def rectangle(width: float, depth: float, across: int, along: int, z: Any = 0.0) -> Mesh:
    """Quads over 0..width, 0..depth at heights z (across + 1, along + 1) [length]; particles numbered along y first."""
    return grid(np.linspace(0, width, across + 1), np.linspace(0, depth, along + 1), z)


def held_of(supports: str, across: int, along: int) -> Ints:
    """Particles of a rectangle that are held: its four edges, the two edges at x = 0 and x = width, or its corners."""
    number = np.arange((across + 1) * (along + 1)).reshape(across + 1, along + 1)
    held = np.zeros(number.shape, bool)
    if supports == "corners":
        held[np.ix_([0, -1], [0, -1])] = True
    else:
        held[[0, -1]] = True
        held[:, [0, -1]] |= supports == "edges"
    return number[held]


def free_edges(supports: str, across: int, along: int) -> Ints:
    """Pairs of particles (n, 2) along those edges of a rectangle that are not held."""
    number = np.arange((across + 1) * (along + 1)).reshape(across + 1, along + 1)
    rows = [] if supports == "edges" else [number[:, 0], number[:, -1]]
    rows += [number[0], number[-1]] if supports == "corners" else []
    return np.concatenate([np.zeros((0, 2), np.int64), *(np.stack([r[:-1], r[1:]], axis=1) for r in rows)])


def disc(radius: float, rings: int, rays: int) -> Mesh:
    """Rings and rays about the particle 0, ring by ring outward; the innermost faces are triangles."""
    angles = 2 * np.pi * np.arange(rays) / rays
    ring = radius * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    vertices = np.concatenate([np.zeros((1, 3)), *(ring * i / rings for i in range(1, rings + 1))])
    first = 1 + np.arange(rays)
    after = np.roll(first, -1)
    faces = [np.stack([0 * first, first, after, after], axis=1)]
    for i in range(rings - 1):
        inner, outer = i * rays, (i + 1) * rays
        faces.append(np.stack([first + inner, first + outer, after + outer, after + inner], axis=1))
    return Mesh(vertices, np.concatenate(faces))


def tube(radius: float, height: float, rings: int, rays: int) -> Mesh:
    """A cylinder of quads from z = 0 to z = height, closed around; particles ring by ring upward."""
    angles = 2 * np.pi * np.arange(rays) / rays
    around = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rows = [np.column_stack([around, np.full(rays, height * i / rings)]) for i in range(rings + 1)]
    open_faces = quads(np.stack(rows)).faces
    number = np.arange((rings + 1) * rays).reshape(rings + 1, rays)
    seam = np.stack([number[:-1, -1], number[1:, -1], number[1:, 0], number[:-1, 0]], axis=1)
    return Mesh(np.concatenate(rows), np.concatenate([open_faces, seam])[:, ::-1])


def net(
    mesh: Mesh, held: Ints, stiffness: float, rest_factor: float, rim: Ints | None = None, edge_stiffness: float = 0.0
) -> Scene:
    """A scene of springs along the edges of a mesh, with cables along the pairs `rim`, held at some particles."""
    forces = [Springs(name="net", mesh="net", stiffness=stiffness, rest_factor=rest_factor)]
    if rim is not None and len(rim) and edge_stiffness:
        forces.append(Springs(name="edges", particles=rim, stiffness=edge_stiffness, rest_factor=rest_factor))
    return Scene(
        particles=mesh.vertices,
        meshes={"net": MeshData(vertices=mesh.vertices, faces=mesh.faces)},
        forces=forces,
        anchors=[Anchor(name="supports", particles=held)],
    )


def loaded(scene: Scene, load: float) -> Scene:
    """A scene with a force `load` along z on each free particle [force]; the same where that is 0."""
    free = np.setdiff1d(np.arange(len(scene.particles)), np.asarray(scene.anchors[0].particles))
    if not load or not len(free):
        return scene
    weight = Unary(name="loads", particles=free, vector=[0.0, 0.0, load])
    return scene.replaced(forces=(*scene.forces, weight))


def raised(scene: Scene, rise: float) -> Scene:
    """A scene of springs without rest length, with equal loads on the free particles that raise the highest one to
    `rise` [length]. Such springs have constant force densities, so heights are linear in the load (H.-J. Schek, The
    force density method, 1974)."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.linalg import spsolve

    count = len(scene.particles)
    pairs, densities = _branches(scene)
    free = np.setdiff1d(np.arange(count), np.asarray(scene.anchors[0].particles))
    if not len(free):
        return scene
    i, j = pairs.T
    rows, columns = np.concatenate([i, j, i, j]), np.concatenate([i, j, j, i])
    values = np.concatenate([densities, densities, -densities, -densities])
    matrix = coo_matrix((values, (rows, columns)), shape=(count, count)).tocsc()
    heights = spsolve(matrix[free][:, free], np.ones(len(free)))  # of unit loads
    return loaded(scene, rise / float(np.max(heights)))


def _branches(scene: Scene) -> tuple[Ints, Floats]:
    """Pairs of the springs of a scene and their stiffness."""
    pairs, densities = [], []
    for force in scene.forces:
        assert isinstance(force, Springs)
        own = np.asarray(force.particles) if force.mesh is None else edges(scene.meshes[force.mesh])
        pairs.append(own)
        densities.append(np.broadcast_to(np.asarray(force.stiffness, float), len(own)))
    return np.concatenate(pairs), np.concatenate(densities)
