"""Soap films: one tension in every direction, and so minimal surfaces; with yarns, woven membranes."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints, OnFilm, Places
from hookean.values.fields import Field

SLIVER = 1e-8
"""Triangles lower than this part of their size have no plane to speak of, and no film force."""
TENSION, YARNS, SHARE, THREADS, EVEN = 0, 1, 3, 4, 10  # columns of the parameters


@device
def plane(x, indices, e, g, n) -> Any:  # type: ignore[no-untyped-def]
    # g (3, 3): the edge opposite to each corner; n: the unit normal, 0 for a sliver. Returns twice the area.
    size = 0.0
    for i in range(3):
        p = indices[e, (i + 1) % 3]
        q = indices[e, (i + 2) % 3]
        for c in range(3):
            g[i, c] = x[q, c] - x[p, c]
            size += g[i, c] * g[i, c]
    n[0] = g[0, 1] * g[1, 2] - g[0, 2] * g[1, 1]
    n[1] = g[0, 2] * g[1, 0] - g[0, 0] * g[1, 2]
    n[2] = g[0, 0] * g[1, 1] - g[0, 1] * g[1, 0]
    double = np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    flat = double > SLIVER * size and size > 1e-140
    for c in range(3):
        n[c] = n[c] / double if flat else 0.0
    return double


@device
def thread(x, indices, parameters, e, family, d) -> Any:  # type: ignore[no-untyped-def]
    # d: start area x stretch vector of the yarns of one family; returns its length
    for c in range(3):
        d[c] = 0.0
        for i in range(3):
            d[c] += parameters[e, THREADS + 3 * family + i] * x[indices[e, i], c]
    return np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])


@device
def pull_yarns(x, indices, parameters, e, f, w, d) -> Any:  # type: ignore[no-untyped-def]
    # adds the pull of both families of yarns; returns their energy
    energy = 0.0
    for family in range(2):
        pull = parameters[e, YARNS + family] * parameters[e, SHARE]
        if pull == 0.0:
            continue
        length = thread(x, indices, parameters, e, family, d)
        energy += pull * length
        if not length > 1e-150:
            continue
        first = THREADS + 3 * family
        whole = np.abs(parameters[e, first]) + np.abs(parameters[e, first + 1]) + np.abs(parameters[e, first + 2])
        for i in range(3):
            part = pull * parameters[e, first + i]
            for c in range(3):
                f[indices[e, i], c] -= part * (d[c] / length)
            w[indices[e, i]] += np.abs(part) * whole / length
    return energy


def soapfilm_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g = np.zeros((3, 3))
    n = np.zeros(3)
    d = np.zeros(3)
    for e in range(indices.shape[0]):
        double = plane(x, indices, e, g, n)
        tension = parameters[e, TENSION] * parameters[e, SHARE]
        energy += 0.5 * tension * double
        flat = n[0] != 0.0 or n[1] != 0.0 or n[2] != 0.0
        for i in range(3):
            a = indices[e, i]
            # dA/dx = normal x opposite edge / 2
            f[a, 0] -= 0.5 * tension * (n[1] * g[i, 2] - n[2] * g[i, 1])
            f[a, 1] -= 0.5 * tension * (n[2] * g[i, 0] - n[0] * g[i, 2])
            f[a, 2] -= 0.5 * tension * (n[0] * g[i, 1] - n[1] * g[i, 0])
            if flat:
                dots = 0.0
                for j in range(3):
                    dots += np.abs(g[i, 0] * g[j, 0] + g[i, 1] * g[j, 1] + g[i, 2] * g[j, 2])
                # across the film cotangents, within it the constant second derivatives of an area
                w[a] += tension * max(0.5 * dots / double, 0.8660254037844387)
        energy += pull_yarns(x, indices, parameters, e, f, w, d)
    return energy


@device
def film_block(block, tension, g, n, double) -> Any:  # type: ignore[no-untyped-def]
    # second derivatives of tension A, as 3 x 3 blocks by corners
    if n[0] == 0.0 and n[1] == 0.0 and n[2] == 0.0:
        return
    for i in range(3):
        for j in range(3):
            dot = g[i, 0] * g[j, 0] + g[i, 1] * g[j, 1] + g[i, 2] * g[j, 2]
            for c in range(3):
                for k in range(3):
                    block[3 * i + c, 3 * j + k] += 0.5 * tension * dot / double * (n[c] * n[k])
        # within the plane the area is a sum of products: constant blocks +- [n] x
        j = (i + 1) % 3
        for c in range(3):
            up = (c + 1) % 3
            turn = 0.5 * tension * n[(c + 2) % 3]
            block[3 * i + c, 3 * j + up] += turn
            block[3 * i + up, 3 * j + c] -= turn
            block[3 * j + up, 3 * i + c] += turn
            block[3 * j + c, 3 * i + up] -= turn


def soapfilm_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    g = np.zeros((3, 3))
    n = np.zeros(3)
    d = np.zeros(3)
    for e in range(indices.shape[0]):
        block = blocks[e]
        block[:] = 0.0
        double = plane(x, indices, e, g, n)
        film_block(block, parameters[e, TENSION] * parameters[e, SHARE], g, n, double)
        for family in range(2):
            pull = parameters[e, YARNS + family] * parameters[e, SHARE]
            length = thread(x, indices, parameters, e, family, d)
            if pull == 0.0 or not length > 1e-150:
                continue
            for i in range(3):
                for j in range(3):
                    part = parameters[e, THREADS + 3 * family + i] * parameters[e, THREADS + 3 * family + j]
                    for c in range(3):
                        for k in range(3):
                            entry = -(d[c] / length) * (d[k] / length)
                            if c == k:
                                entry += 1.0
                            block[3 * i + c, 3 * j + k] += pull * part / length * entry


class SoapFilm(Force):
    """A film of constant tension T on a mesh: E = T A, whose equilibria are minimal surfaces.

    A is the sum of the triangles' areas; a quad is the mean of its two cuts into triangles, so neither diagonal is
    special. The area does not depend on where in the film a vertex lies, so a film has no stiffness along itself, and
    its equilibrium is that across it. The part along the film does not count at vertices on which films act alone, with
    pressure, or with loads on whole faces; nor, at the edge of a film that is pulled to a curve, the part along the
    edge, for sliding there does not change the film. At vertices of springs and other forces, all of it counts. An
    unsupported edge draws back: such a film has no equilibrium. Nor has one between rings too far apart, or under too
    large a load on a single vertex; the run then ends as diverged, with its last good shape.

    Vertices stay evenly spread, whatever they were when drawn: the solver `auto` fills a rim by one linear solve, and
    steps in time and of relaxation pull them along the film, with `evenness` as part of T. The film's shape does not
    depend on it but for the error of flat triangles, of the order h^2.

    Warp and weft are yarns that run with the material, warp along each face's first edge at the start, weft across:
    they pull with a constant force per start width, E = A0 (warp |du| + weft |dv|), |du| their stretch. (A constant
    force per present width in two directions has no energy.) Yarns of constant force cannot balance each other along
    the film unless both run straight in it, so of them, too, only what is across the film counts; the cloth bears the
    rest.

    Sources: Pinkall and Polthier, "Computing discrete minimal surfaces and their conjugates", 1993 (the gradient);
    Dziuk and Hutchinson, "The discrete Plateau problem", 1999 (the order of the error).
    """

    kind: Literal["soapfilm"] = "soapfilm"
    mesh: str = Field(description="Name of the mesh that is the film")
    tension: float = Field(default=1.0, ge=0, le=1e12, description="T, the same in every direction [force/length]")
    evenness: float = Field(
        default=1.0,
        ge=0,
        le=1e12,
        description="Strength of the even spacing of vertices, as a part of T; at most 1 counts [-]",
    )
    warp: float = Field(default=0.0, ge=0, le=1e12, description="Pull of the warp yarns per start width [force/length]")
    weft: float = Field(default=0.0, ge=0, le=1e12, description="Pull of the weft yarns per start width [force/length]")

    formula: ClassVar[str] = "E = T A"
    arity: ClassVar[int] = 3
    is_film: ClassVar[bool] = True
    on_film: ClassVar[OnFilm] = "across"
    outputs: ClassVar[dict[str, str]] = {"area": "length^2"}
    example_beside: ClassVar[dict[str, Any]] = {"anchors": [{"particles": [0, 1, 2, 3, 5, 6, 7, 8]}]}
    kernel: ClassVar[Any] = staticmethod(soapfilm_kernel)
    hessian: ClassVar[Any] = staticmethod(soapfilm_hessian)
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8], [4, 8, 7]]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: T, warp, weft, share, yarns by corners, evenness."""
        from hookean.discretize.meshes import tidy_faces

        faces = tidy_faces(places.faces(self.mesh))
        corners, share, face = halves(faces)
        first = places.x[faces[face, 1]] - places.x[faces[face, 0]]
        return Block.of(
            corners,
            tension=self.tension,
            warp=self.warp,
            weft=self.weft,
            share=share,
            threads=yarns(places.x, corners, first),
            evenness=self.evenness,
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Area of the film by triangles [length^2], halved where a quad is cut in two ways: the sum is A."""
        return {"area": block.parameters[:, SHARE] * shapes(x, block.indices)[0]}

    @classmethod
    def example(cls) -> tuple[SoapFilm, Floats]:
        """An irregular dome of quads and triangles (`example_faces`) with yarns in both directions."""
        x = [[0.0, 0.1, 0.0], [1.1, 0.0, 0.3], [2.0, -0.1, 0.1], [0.1, 1.0, 0.35], [0.9, 1.1, 0.7], [2.1, 0.9, 0.3]]
        x += [[-0.1, 2.0, 0.05], [1.0, 2.2, 0.4], [1.9, 2.1, -0.1]]
        return cls(mesh="skin", tension=20.0, warp=5.0, weft=2.0), np.array(x)


def halves(faces: Ints) -> tuple[Ints, Floats, Ints]:
    """Triangles (m, 3) of faces (k, 4), their share (m,) and their face (m,): a quad is the mean of its two cuts."""
    quad = faces[:, 2] != faces[:, 3]
    cuts = np.stack([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]], faces[:, [0, 1, 3]], faces[:, [1, 2, 3]]], axis=1)
    taken = np.stack([np.ones_like(quad), quad, quad, quad], axis=1).ravel()
    share = np.repeat(np.where(quad, 0.5, 1.0), 4)
    face = np.repeat(np.arange(len(faces)), 4)
    return np.ascontiguousarray(cuts.reshape(-1, 3)[taken]), share[taken], face[taken]


def shapes(x: Floats, corners: Ints) -> tuple[Floats, Floats]:
    """Areas (m,) [length^2] and quality (m,) of triangles: 4 sqrt(3) area / sum of squared edges, 1 where edges are
    equal, and 0 without area."""
    area, quality = np.empty(len(corners)), np.empty(len(corners))
    dispatch.compiled(measure)(x, corners, area, quality)
    return area, quality


def measure(x, corners, area, quality):  # type: ignore[no-untyped-def]
    """Write areas and qualities of triangles."""
    g = np.zeros((3, 3))
    n = np.zeros(3)
    for t in range(corners.shape[0]):
        double = plane(x, corners, t, g, n)
        size = 0.0
        for i in range(3):
            for c in range(3):
                size += g[i, c] * g[i, c]
        flat = n[0] != 0.0 or n[1] != 0.0 or n[2] != 0.0
        area[t] = 0.5 * double if flat else 0.0
        quality[t] = 2.0 * np.sqrt(3.0) * double / size if flat else 0.0


def yarns(x: Floats, corners: Ints, direction: Floats) -> Floats:
    """Start area x derivative along and across `direction` (m, 3), by the triangles' corners (m, 6)."""
    a, b, c = (x[corners[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    size = np.linalg.norm(normal, axis=1)
    normal /= np.where(size > 0.0, size, 1.0)[:, None]
    u = direction - (direction * normal).sum(axis=1)[:, None] * normal
    reach = np.linalg.norm(u, axis=1)
    u /= np.where(reach > 0, reach, 1.0)[:, None]
    # area x gradient of a corner's linear function = normal x opposite edge / 2
    slopes = 0.5 * np.stack([np.cross(normal, e) for e in (c - b, a - c, b - a)], axis=1)
    return np.concatenate(
        [np.einsum("mic,mc->mi", slopes, u), np.einsum("mic,mc->mi", slopes, np.cross(normal, u))], axis=1
    )
