"""Solid plane collide: corners of solids that a plane pushes back, with dry friction."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places, lengths, units
from hookean.values.columns import Directions, IndexRows, NonNegatives, Points, Vectors
from hookean.values.fields import Field, Maybe

STRENGTH, FRICTION, ORIGIN, NORMAL, START = 0, 1, 2, 5, 8  # columns of the parameters
STARTED, PLACE = 0, 1  # of the memory: whether a step has ended, and where a particle would be without friction


@device
def slip(x: Any, indices: Any, parameters: Any, memory: Any, e: Any, s: Any) -> Any:
    """Depth of a particle below its plane, how far it has slipped along it into `s`, and that as a distance."""
    depth, square = 0.0, 0.0
    for c in range(3):
        depth += (parameters[e, ORIGIN + c] - x[indices[e, 0], c]) * parameters[e, NORMAL + c]
        here = memory[e, PLACE + c] if memory[e, STARTED] != 0.0 else parameters[e, START + c]
        s[c] = x[indices[e, 0], c] - here
    along = s[0] * parameters[e, NORMAL] + s[1] * parameters[e, NORMAL + 1] + s[2] * parameters[e, NORMAL + 2]
    for c in range(3):
        s[c] -= along * parameters[e, NORMAL + c]
        square += s[c] * s[c]
    return depth, np.sqrt(square)


def solid_plane_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, s = 0.0, np.zeros(3)
    for e in range(indices.shape[0]):
        a, strength, rough = indices[e, 0], parameters[e, STRENGTH], parameters[e, FRICTION]
        depth, far = slip(x, indices, parameters, memory, e, s)
        # what does not touch counts as well: it may before the stiffness is asked for again
        w[a] += strength * (1.0 + 0.5 * rough)
        if depth <= 0.0:
            continue
        energy += 0.5 * strength * depth * depth
        held, most = 0.0, rough * depth
        if rough > 0.0:
            held = strength if far <= most else strength * most / far
            energy += 0.5 * strength * far * far if far <= most else strength * most * (far - 0.5 * most)
        for c in range(3):
            f[a, c] += strength * depth * parameters[e, NORMAL + c] - held * s[c]
    return energy


def solid_plane_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    s = np.zeros(3)
    for e in range(indices.shape[0]):
        strength, rough = parameters[e, STRENGTH], parameters[e, FRICTION]
        depth, far = slip(x, indices, parameters, memory, e, s)
        strength = strength if depth > 0.0 else 0.0
        sliding = far > rough * depth
        across = strength if not sliding else (strength * rough * depth / far if far > 0.0 else 0.0)
        across = across if rough > 0.0 else 0.0
        for i in range(3):
            for j in range(3):
                n, u = parameters[e, NORMAL + i], parameters[e, NORMAL + j]
                blocks[e, i, j] = strength * n * u + across * ((1.0 if i == j else 0.0) - n * u)
                if sliding and far > 0.0:  # the symmetric part: the friction grows with the depth
                    blocks[e, i, j] -= across * (s[i] / far) * (s[j] / far)
                    blocks[e, i, j] -= 0.5 * strength * rough * (s[i] * u + n * s[j]) / far


def solid_plane_note(x, indices, parameters, memory):  # type: ignore[no-untyped-def]
    s = np.zeros(3)
    for e in range(indices.shape[0]):
        if parameters[e, FRICTION] == 0.0:
            continue
        depth, far = slip(x, indices, parameters, memory, e, s)
        most = parameters[e, FRICTION] * max(depth, 0.0)
        kept = most / far if far > most else 1.0
        memory[e, STARTED] = 1.0
        for c in range(3):
            memory[e, PLACE + c] = x[indices[e, 0], c] - kept * s[c]


class SolidPlaneCollide(Force):
    """Particles that a plane pushes back to its front, with dry friction: E = k d^2 / 2, d the depth behind the plane.

    The plane goes through O, its front is where the normal n points, and it has no edge. A solid with its corners at
    these particles rests on it by them, and so by its edges and faces. A force F on a particle sinks it in by F / k.
    With friction a particle sticks where it touched the plane first, as stiff along the plane as across it, until that
    takes mu k d; then it slides. For what touches at the start, and when nothing moves in time, it sticks where it
    starts.
    Source: Cundall and Strack, "A discrete numerical model for granular assemblies", 1979.
    """

    kind: Literal["solid_plane_collide"] = "solid_plane_collide"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles at the corners of solids")
    points: Maybe[Points] = Field(default=None, description="Coordinates of the corners of solids")
    origin: Vectors = Field(default=np.zeros(3), description="O, a point of the plane [length], or one for each")
    normal: Directions = Field(
        default=np.array([0.0, 0.0, 1.0]), description="n, to the free side, or one for each; any length [-]"
    )
    strength: NonNegatives = Field(default=1000.0, description="k, stiffness of a contact [force/length]")
    friction: NonNegatives = Field(default=0.0, description="mu, friction [-]")

    formula: ClassVar[str] = "E = k d²/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    creates: ClassVar[bool] = False
    remembers: ClassVar[bool] = True
    yielding: ClassVar[tuple[str, ...]] = ("friction",)
    touches: ClassVar[bool] = True
    outputs: ClassVar[dict[str, str]] = {"depth": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(solid_plane_kernel)
    hessian: ClassVar[Any] = staticmethod(solid_plane_hessian)
    end_of_step: ClassVar[Any] = staticmethod(solid_plane_note)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k, mu, origin, unit normal, and where the particles start."""
        index = places.elements(self)
        return Block.of(
            index, memory=4, strength=self.strength, friction=self.friction, origin=np.atleast_2d(self.origin),
            normal=units(self.normal), start=places.x[np.maximum(index[:, 0], 0)],
        )  # fmt: skip

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Depth behind the plane [length] and the force on the particle [force]."""
        off = block.parameters[:, ORIGIN:NORMAL] - x[block.indices[:, 0]]
        depth = np.maximum(np.einsum("ij,ij->i", off, block.parameters[:, NORMAL:START]), 0.0)
        return {"depth": np.where(lengths(element_forces[:, 0]) > 0.0, depth, 0.0), "force": element_forces[:, 0]}

    @classmethod
    def example(cls) -> tuple[SolidPlaneCollide, Floats]:
        """Three particles behind planes of their own, and a rough one in front of its plane."""
        return cls(
            particles=[0, 1, 2, 3],
            origin=[[0, 0, 0.9], [2, 0, 0], [1, 1, 1], [0, 0, 0]],
            normal=[[0, 0, 1], [1, -2, 0], [1, 1, 3], [0, 0, 1]],
            strength=[100.0, 20.0, 3.0, 10.0],
            friction=[0.0, 0.0, 0.0, 0.5],
        ), np.array([[0.3, -0.5, 0.2], [1.0, 1.2, 0.5], [-4.0, -5.0, 1.0], [5.0, 1.0, 3.0]])
