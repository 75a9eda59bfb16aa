"""Isothermic: quads whose opposite sides have the same product of lengths."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places, lengths
from hookean.forces.line_angles import unit
from hookean.forces.mesh_edges import quads
from hookean.values.columns import IndexRows, PointRows
from hookean.values.fields import Field, Maybe


@device
def off_square(x: Any, indices: Any, e: Any, u: Any, reach: Any, slope: Any, bend: Any) -> Any:
    """How far a quad is from products of opposite sides that are the same; nan where it has no size.

    Writes the unit vectors `u` (4, 3) and lengths `reach` (4,) of its sides, and the first and second derivatives by
    these lengths, `slope` (4,) and `bend` (4, 4).
    """
    total = 0.0
    for i in range(4):
        for c in range(3):
            u[i, c] = 0.0
        reach[i] = unit(x, indices[e, i], indices[e, (i + 1) % 4], u[i])
        total += reach[i]
    if not total > 1e-70:
        return np.nan
    # with parts of the perimeter, as products of very short sides would be 0
    off = 2.0 * (reach[0] / total * (reach[2] / total) - reach[1] / total * (reach[3] / total))
    for i in range(4):
        sign = 1.0 if i % 2 == 0 else -1.0
        slope[i] = 2.0 * sign * reach[(i + 2) % 4] / total - off
    for i in range(4):
        for j in range(4):
            across = (2.0 if i % 2 == 0 else -2.0) if (i + j) % 2 == 0 and i != j else 0.0
            bend[i, j] = (across - slope[i] - slope[j]) / total
    return off * total


def isothermic_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, u, reach, slope, bend = 0.0, np.zeros((4, 3)), np.zeros(4), np.zeros(4), np.zeros((4, 4))
    for e in range(indices.shape[0]):
        k, off = parameters[e, 0], off_square(x, indices, e, u, reach, slope, bend)
        if np.isnan(off):
            continue
        energy += 0.5 * k * off * off
        steep = 2.0 * (np.abs(slope[0]) + np.abs(slope[1]) + np.abs(slope[2]) + np.abs(slope[3]))
        for i in range(4):
            a, b, force = indices[e, i], indices[e, (i + 1) % 4], k * off * slope[i]
            more = 0.0
            for j in range(4):
                more += np.abs(bend[i, j])
            bound = k * np.abs(slope[i]) * steep + 2.0 * k * np.abs(off) * more
            # sides in tension stiffen across
            bound += 2.0 * force / reach[i] if force > 0.0 and reach[i] > 0.0 else 0.0
            w[a] += bound
            w[b] += bound
            for c in range(3):
                f[a, c] += force * u[i, c]
                f[b, c] -= force * u[i, c]
    return energy


def isothermic_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    u, reach, slope, bend = np.zeros((4, 3)), np.zeros(4), np.zeros(4), np.zeros((4, 4))
    for e in range(indices.shape[0]):
        k, off = parameters[e, 0], off_square(x, indices, e, u, reach, slope, bend)
        if np.isnan(off):
            continue
        for i in range(4):
            density = k * off * slope[i] / reach[i] if reach[i] > 0.0 else 0.0
            for j in range(4):
                rate = k * (slope[i] * slope[j] + off * bend[i, j])
                for c in range(3):
                    for d in range(3):
                        part = rate * u[i, c] * u[j, d]
                        if i == j:
                            part += density * ((1.0 if c == d else 0.0) - u[i, c] * u[i, d])
                        p, q, r, s = 3 * i + c, 3 * ((i + 1) % 4) + c, 3 * j + d, 3 * ((j + 1) % 4) + d
                        blocks[e, p, r] += part
                        blocks[e, q, s] += part
                        blocks[e, p, s] -= part
                        blocks[e, q, r] -= part


class Isothermic(Force):
    """Quads whose opposite sides have the same product of lengths: E = k u^2 / 2 with u = 2 (L0 L2 - L1 L3) / (L0 + L1
    + L2 + L3).

    u is a length: of a rectangle it is the difference of its sides. Where the corners also lie on a circle (use
    `cyclic_quad`) the cross ratio of each quad is -1: the mesh is a discrete isothermic surface, a net of conformal
    squares along lines of curvature, as minimal surfaces and surfaces of revolution have. Scaling a quad scales u.
    Forces and moments of every quad sum to zero; a quad without any size has no force. Triangles of the mesh have none.
    Source: Bobenko and Pinkall, "Discrete isothermic surfaces", 1996.
    """

    kind: Literal["isothermic"] = "isothermic"
    particles: Maybe[IndexRows] = Field(default=None, description="Corners of each quad, in order")
    points: Maybe[PointRows] = Field(default=None, description="Coordinates of the corners of each quad, in order")
    mesh: str | None = Field(default=None, description="Name of a mesh: its quads")
    stiffness: float = Field(default=1.0, ge=0, le=1e12, description="k [force/length]")

    formula: ClassVar[str] = "E = 2 k ((L0 L2 - L1 L3)/(L0 + L1 + L2 + L3))²"
    arity: ClassVar[int] = 4
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(isothermic_kernel)
    hessian: ClassVar[Any] = staticmethod(isothermic_hessian)
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 2, 3], [1, 4, 5, 2], [3, 2, 6, 6]]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k."""
        if self.mesh is None:
            return Block.of(places.elements(self), stiffness=self.stiffness)
        return Block.of(quads(places.faces(self.mesh)), stiffness=self.stiffness)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """u of each quad, positive where the first side and that across are the longer ones [length], and k times this
        [force]."""
        corners = x[block.indices]
        side = np.stack([lengths(corners[:, (i + 1) % 4] - corners[:, i]) for i in range(4)])
        total = np.where((size := side.sum(axis=0)) > 1e-70, size, np.inf)
        part = side / total
        distance = 2.0 * (part[0] * part[2] - part[1] * part[3]) * size
        return {"distance": distance, "force": block.parameters[:, 0] * distance}

    @classmethod
    def example(cls) -> tuple[Isothermic, Floats]:
        """Two quads beside a triangle (`example_faces`)."""
        x = [[0, 0, 0.3], [2, 0.2, 0], [2.3, 1.9, 0.4], [-0.2, 1.5, -0.1], [4.7, -0.3, 0.5], [4.1, 2.2, -0.2]]
        return cls(mesh="skin", stiffness=30.0), np.array([*x, [1.0, 3.0, 0.5]])
