"""Soap films: one tension in every direction, and so minimal surfaces; with yarns, woven membranes."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.fields import Field
from hookean.forces.base import Block, Floats, Force, Ints, Places
from hookean.kernels import device

SLIVER = 1e-8
"""Triangles lower than this part of their size have no plane to speak of, and no film force."""
NEEDLE = 1e-4  # a film whose triangles become so much thinner than they were has collapsed
TENSION, YARNS, SHARE, THREADS, EVEN, START = 0, 1, 3, 4, 10, 11  # columns of the parameters


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
        even = tension * parameters[e, EVEN]
        tension -= even
        energy += 0.5 * tension * double
        flat = n[0] != 0.0 or n[1] != 0.0 or n[2] != 0.0
        for i in range(3):
            a = indices[e, i]
            # dA/dx = normal x opposite edge / 2
            f[a, 0] -= 0.5 * tension * (n[1] * g[i, 2] - n[2] * g[i, 1])
            f[a, 1] -= 0.5 * tension * (n[2] * g[i, 0] - n[0] * g[i, 2])
            f[a, 2] -= 0.5 * tension * (n[0] * g[i, 1] - n[1] * g[i, 0])
            # the opposite edge as a spring of rest length 0
            k = 0.5 * even * parameters[e, START + i]
            p = indices[e, (i + 1) % 3]
            q = indices[e, (i + 2) % 3]
            dots = 0.0
            for c in range(3):
                energy += 0.5 * k * g[i, c] * g[i, c]
                f[p, c] += k * g[i, c]
                f[q, c] -= k * g[i, c]
            for j in range(3):
                dots += np.abs(g[i, 0] * g[j, 0] + g[i, 1] * g[j, 1] + g[i, 2] * g[j, 2])
            w[p] += 2.0 * np.abs(k)
            w[q] += 2.0 * np.abs(k)
            if flat:
                # across the film cotangents, within it the constant second derivatives of an area
                w[a] += tension * max(0.5 * dots / double, 0.8660254037844387)
        energy += pull_yarns(x, indices, parameters, e, f, w, d)
    return energy


@device
def film_block(block, tension, even, start, e, g, n, double) -> Any:  # type: ignore[no-untyped-def]
    # second derivatives of tension A + even D, as 3 x 3 blocks by corners
    for i in range(3):
        k = 0.5 * even * start[e, START + i]
        p = 3 * ((i + 1) % 3)
        q = 3 * ((i + 2) % 3)
        for c in range(3):
            block[p + c, p + c] += k
            block[q + c, q + c] += k
            block[p + c, q + c] -= k
            block[q + c, p + c] -= k
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
        tension = parameters[e, TENSION] * parameters[e, SHARE]
        even = tension * parameters[e, EVEN]
        film_block(block, tension - even, even, parameters, e, g, n, double)
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
    special. The area does not tell where within the film a vertex lies, and the vertices of an area alone slide until
    triangles fold over. So every triangle has the small part s of its energy from D instead of A,
    E = T ((1 - s) A + s D), where D = sum(cot(a0) l^2) / 4 >= A, with equality where the triangle is similar to its
    start shape (angles a0, opposite edges l). s = evenness x start area / start area of the whole film, at most 1/2:
    it vanishes like h^2 as the mesh gets finer, like the error of flat triangles. Evenness 0 is the area alone.

    Warp and weft are yarns that run with the material, warp along each face's first edge at the start, weft across:
    they pull with a constant force per start width, E = A0 (warp |du| + weft |dv|), |du| their stretch. (A constant
    force per present width in two directions has no energy.) A film that has no equilibrium, such as between rings
    too far apart, collapses, and the run says so. The mesh's faces without area at the start are left out.

    Sources: Pinkall and Polthier, "Computing discrete minimal surfaces and their conjugates", 1993 (A, D and their
    gradients); Bletzinger and Ramm, "A general finite element approach to the form finding of tensile structures by
    the updated reference strategy", 1999 (the mixture).
    """

    kind: Literal["soapfilm"] = "soapfilm"
    mesh: str = Field(description="Name of the mesh that is the film")
    tension: float = Field(default=1.0, ge=0, le=1e12, description="T, the same in every direction [force/length]")
    evenness: float = Field(
        default=4.0, ge=0, le=1e12, description="How strongly triangles keep their start proportions [-]; 0: not at all"
    )
    warp: float = Field(default=0.0, ge=0, le=1e12, description="Pull of the warp yarns per start width [force/length]")
    weft: float = Field(default=0.0, ge=0, le=1e12, description="Pull of the weft yarns per start width [force/length]")

    formula: ClassVar[str] = "E = T A"
    arity: ClassVar[int] = 3
    collapses: ClassVar[bool] = True
    outputs: ClassVar[dict[str, str]] = {"area": "length^2"}
    kernel: ClassVar[Any] = staticmethod(soapfilm_kernel)
    hessian: ClassVar[Any] = staticmethod(soapfilm_hessian)
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8], [4, 8, 7]]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: T, warp, weft, share, yarns by corners, s, start cotangents."""
        faces = places.faces(self.mesh)
        corners, share, face = halves(faces)
        area, cotangents = shapes(places.x, corners)
        fine = area > 0
        corners, face, share, area, cotangents = corners[fine], face[fine], share[fine], area[fine], cotangents[fine]
        first = places.x[faces[face, 1]] - places.x[faces[face, 0]]
        whole = float((share * area).sum())
        return Block.of(
            corners,
            tension=self.tension,
            warp=self.warp,
            weft=self.weft,
            share=share,
            threads=yarns(places.x, corners, first),
            evenness=np.minimum(0.5, self.evenness * (area / (whole or 1.0))),
            start=cotangents,
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Area of the film by triangles [length^2], halved where a quad is cut in two ways: the sum is A."""
        return {"area": block.parameters[:, SHARE] * shapes(x, block.indices)[0]}

    def collapsed(self, block: Block, x: Floats) -> str:
        """A sentence once triangles have become needles: nothing spans the rims any more."""
        start = block.parameters[:, START : START + 3].sum(axis=1)
        now = shapes(x, block.indices)[1].sum(axis=1)
        # the sum of cotangents is edges squared over 4 areas: how thin a triangle is
        thin = ~(now * NEEDLE < start)
        if not thin.any():
            return ""
        a, b, c = block.indices[int(np.argmax(thin))]
        return (
            f"the film has collapsed: {int(thin.sum())} of {len(thin)} triangles have shrunk to needles, the first at "
            f"particles {a}, {b} and {c}. No film spans these edges from this start; bring the edges nearer to each "
            "other, or hold the film in between"
        )

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
    """Areas (m,) and cotangents of the angles (m, 3) of triangles; slivers have area 0 and infinite cotangents."""
    sides = [x[corners[:, (i + 2) % 3]] - x[corners[:, (i + 1) % 3]] for i in range(3)]
    double = np.linalg.norm(np.cross(sides[0], sides[1]), axis=1)
    size = sum((s**2).sum(axis=1) for s in sides)
    fine = (double > SLIVER * size) & (size > 1e-140)
    dots = np.stack([-(sides[(i + 1) % 3] * sides[(i + 2) % 3]).sum(axis=1) for i in range(3)], axis=1)
    cotangents = np.where(fine[:, None], dots / np.where(fine, double, 1.0)[:, None], np.inf)
    return np.where(fine, 0.5 * double, 0.0), cotangents


def yarns(x: Floats, corners: Ints, direction: Floats) -> Floats:
    """Start area x derivative along and across `direction` (m, 3), by the triangles' corners (m, 6)."""
    a, b, c = (x[corners[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    u = direction - (direction * normal).sum(axis=1)[:, None] * normal
    reach = np.linalg.norm(u, axis=1)
    u /= np.where(reach > 0, reach, 1.0)[:, None]
    # area x gradient of a corner's linear function = normal x opposite edge / 2
    slopes = 0.5 * np.stack([np.cross(normal, e) for e in (c - b, a - c, b - a)], axis=1)
    return np.concatenate(
        [np.einsum("mic,mc->mi", slopes, u), np.einsum("mic,mc->mi", slopes, np.cross(normal, u))], axis=1
    )
