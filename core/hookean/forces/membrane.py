"""Membrane: elastic cloth of warp and weft, at finite displacements, that may wrinkle."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints, Places
from hookean.forces.cloth import grain, made, numbers, one_way, stresses
from hookean.forces.elastic import growth
from hookean.forces.soapfilm import halves, yarns
from hookean.forces.tension_field import respond, stiffen
from hookean.values.columns import Directions, Lines, Points, Vectors
from hookean.values.fields import Field, Maybe

AREA, SLOPES, CLOTH, STRAIN, WRINKLING = 0, 1, 7, 11, 14  # columns of the parameters
SLIVER = 1e-8
"""Triangles lower than this part of their size have no plane where they are made, and no force."""


@device
def deform(x: Any, indices: Any, parameters: Any, e: Any, g: Any, strain: Any) -> None:
    """Write the images `g` (2, 3) of unit vectors along warp and weft, and the strain (E11, E22, 2 E12)."""
    for c in range(3):
        for k in range(2):
            g[k, c] = 0.0
        start = x[indices[e, 0], c]
        for i in range(1, 3):
            apart = x[indices[e, i], c] - start
            g[0, c] += parameters[e, SLOPES + i] * apart
            g[1, c] += parameters[e, SLOPES + 3 + i] * apart
    strain[0] = 0.5 * (g[0, 0] * g[0, 0] + g[0, 1] * g[0, 1] + g[0, 2] * g[0, 2] - 1.0) + parameters[e, STRAIN]
    strain[1] = 0.5 * (g[1, 0] * g[1, 0] + g[1, 1] * g[1, 1] + g[1, 2] * g[1, 2] - 1.0) + parameters[e, STRAIN + 1]
    strain[2] = g[0, 0] * g[1, 0] + g[0, 1] * g[1, 1] + g[0, 2] * g[1, 2] + parameters[e, STRAIN + 2]


@device
def bound(indices: Any, parameters: Any, e: Any, g: Any, s: Any, own: Any, w: Any) -> None:
    """Add a bound of the stiffness at each corner: that of taut cloth, and that of the stress."""
    cloth = parameters[e, CLOTH:STRAIN]
    whole = 1.0 / (1.0 - cloth[3] * cloth[3] * cloth[1] / cloth[0])
    uu = g[0, 0] * g[0, 0] + g[0, 1] * g[0, 1] + g[0, 2] * g[0, 2]
    vv = g[1, 0] * g[1, 0] + g[1, 1] * g[1, 1] + g[1, 2] * g[1, 2]
    uv = g[0, 0] * g[1, 0] + g[0, 1] * g[1, 1] + g[0, 2] * g[1, 2]
    total = 0.0
    for i in range(3):
        p, q = parameters[e, SLOPES + i], parameters[e, SLOPES + 3 + i]
        size = whole * (cloth[0] * p * p * uu + cloth[1] * q * q * vv + 2.0 * cloth[3] * cloth[1] * p * q * uv)
        size += cloth[2] * (p * p * vv + q * q * uu + 2.0 * p * q * uv)
        own[i] = np.sqrt(max(size, 0.0))
        total += own[i]
    for i in range(3):
        stress = 0.0
        p, q = parameters[e, SLOPES + i], parameters[e, SLOPES + 3 + i]
        for j in range(3):
            r, t = parameters[e, SLOPES + j], parameters[e, SLOPES + 3 + j]
            stress += np.abs(s[0] * p * r + s[1] * q * t + s[2] * (p * t + q * r))
        w[indices[e, i]] += parameters[e, AREA] * (own[i] * total + stress)


def membrane_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g, strain, s, own = np.zeros((2, 3)), np.zeros(3), np.zeros(3), np.zeros(3)
    for e in range(indices.shape[0]):
        area = parameters[e, AREA]
        if area == 0.0:
            continue
        deform(x, indices, parameters, e, g, strain)
        stored, _, _ = respond(parameters[e, CLOTH:STRAIN], strain, s, parameters[e, WRINKLING] != 0.0)
        energy += area * stored
        for i in range(3):
            along = area * (s[0] * parameters[e, SLOPES + i] + s[2] * parameters[e, SLOPES + 3 + i])
            across = area * (s[2] * parameters[e, SLOPES + i] + s[1] * parameters[e, SLOPES + 3 + i])
            for c in range(3):
                f[indices[e, i], c] -= along * g[0, c] + across * g[1, c]
        bound(indices, parameters, e, g, s, own, w)
    return energy


@device
def strained(parameters: Any, e: Any, g: Any, slope: Any) -> None:
    """Write the derivatives (3, 9) of the strain (E11, E22, 2 E12) by the corners."""
    for i in range(3):
        p, q = parameters[e, SLOPES + i], parameters[e, SLOPES + 3 + i]
        for c in range(3):
            slope[0, 3 * i + c] = p * g[0, c]
            slope[1, 3 * i + c] = q * g[1, c]
            slope[2, 3 * i + c] = p * g[1, c] + q * g[0, c]


def membrane_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    g, strain, s, t, v = np.zeros((2, 3)), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    stiff, slope = np.zeros((3, 3)), np.zeros((3, 9))
    for e in range(indices.shape[0]):
        area = parameters[e, AREA]
        deform(x, indices, parameters, e, g, strain)
        _, state, u = respond(parameters[e, CLOTH:STRAIN], strain, s, parameters[e, WRINKLING] != 0.0)
        stiffen(parameters[e, CLOTH:STRAIN], strain, state, u, t, v, stiff)
        strained(parameters, e, g, slope)
        for i in range(9):
            for j in range(9):
                entry = 0.0
                for a in range(3):
                    for b in range(3):
                        entry += slope[a, i] * stiff[a, b] * slope[b, j]
                if i % 3 == j % 3:
                    p, q = parameters[e, SLOPES + i // 3], parameters[e, SLOPES + 3 + i // 3]
                    r, o = parameters[e, SLOPES + j // 3], parameters[e, SLOPES + 3 + j // 3]
                    entry += s[0] * p * r + s[1] * q * o + s[2] * (p * o + q * r)
                blocks[e, i, j] = area * entry


def membrane_stressed(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    """The stiffness of the stress that a small movement, `memory` (m, 9) of the corners, brings: its rate times the
    second derivatives of the strain."""
    g, strain, s, t, v = np.zeros((2, 3)), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    stiff, slope = np.zeros((3, 3)), np.zeros((3, 9))
    for e in range(indices.shape[0]):
        deform(x, indices, parameters, e, g, strain)
        _, state, u = respond(parameters[e, CLOTH:STRAIN], strain, s, parameters[e, WRINKLING] != 0.0)
        stiffen(parameters[e, CLOTH:STRAIN], strain, state, u, t, v, stiff)
        strained(parameters, e, g, slope)
        for a in range(3):
            strain[a] = 0.0
            for i in range(9):
                strain[a] += slope[a, i] * memory[e, i]
        for a in range(3):
            s[a] = stiff[a, 0] * strain[0] + stiff[a, 1] * strain[1] + stiff[a, 2] * strain[2]
        for i in range(3):
            p, q = parameters[e, SLOPES + i], parameters[e, SLOPES + 3 + i]
            for j in range(3):
                r, o = parameters[e, SLOPES + j], parameters[e, SLOPES + 3 + j]
                entry = s[0] * p * r + s[1] * q * o + s[2] * (p * o + q * r)
                for c in range(3):
                    blocks[e, 3 * i + c, 3 * j + c] = parameters[e, AREA] * entry


def membrane_stress(x, indices, parameters, found):  # type: ignore[no-untyped-def]
    """Write the stress per width as it is, along the warp, across it and in shear, and the state of each triangle."""
    g, strain, s = np.zeros((2, 3)), np.zeros(3), np.zeros(3)
    for e in range(indices.shape[0]):
        if parameters[e, AREA] == 0.0:
            continue
        deform(x, indices, parameters, e, g, strain)
        _, state, _ = respond(parameters[e, CLOTH:STRAIN], strain, s, parameters[e, WRINKLING] != 0.0)
        found[e, 3] = state
        uu = g[0, 0] * g[0, 0] + g[0, 1] * g[0, 1] + g[0, 2] * g[0, 2]
        vv = g[1, 0] * g[1, 0] + g[1, 1] * g[1, 1] + g[1, 2] * g[1, 2]
        uv = g[0, 0] * g[1, 0] + g[0, 1] * g[1, 1] + g[0, 2] * g[1, 2]
        grown = np.sqrt(max(uu * vv - uv * uv, 0.0))  # area now by area at the start
        long = np.sqrt(uu)
        if grown > 0.0 and long > 0.0:
            along, high = uv / long, grown / long
            found[e, 0] = (s[0] * uu + 2.0 * s[2] * uv + s[1] * along * along) / grown
            found[e, 1] = s[1] * high / long
            found[e, 2] = (s[2] * long + s[1] * along) / long


def membrane_second(x, indices, parameters, found):  # type: ignore[no-untyped-def]
    """Write the stress of each triangle per width of the start shape, along warp, weft and in shear (the second Piola-
    Kirchhoff stress), to which a prestress adds."""
    g, strain = np.zeros((2, 3)), np.zeros(3)
    for e in range(indices.shape[0]):
        if parameters[e, AREA] != 0.0:
            deform(x, indices, parameters, e, g, strain)
            respond(parameters[e, CLOTH:STRAIN], strain, found[e], parameters[e, WRINKLING] != 0.0)


class Membrane(Force):
    """Elastic cloth on a mesh, woven of warp and weft: E = A0 W(strain), at any displacement.

    W is the energy per start area of the Green strain along warp and weft, e C e / 2 (St. Venant-Kirchhoff), with
    C^-1 = [[1/Ew, -nu/Ew, 0], [-nu/Ew, 1/Ef, 0], [0, 0, 1/G]]: stiffnesses are per width [force/length], and nu is how
    much the cloth contracts along the weft where the warp is pulled. A sheet of modulus E and thickness t has Ew = E t.
    Strain is constant in each triangle, and a quad is the mean of its two cuts. The start shape, or another `shape`,
    has the `prestress` along warp, weft and in shear, and is free of strain without one. A `temperature` makes it
    larger by g = 1 + expansion x temperature: the strain e less (g^2 - 1) / 2 along warp and weft counts.

    The warp runs along a vector that is projected on each triangle; along the nearest of some lines; or, without
    either, along the rows of the mesh, from the first edge of its first face, which needs quads (or cloth that is alike
    in all directions).

    With `wrinkling` the cloth has no compression: it buckles into fine wrinkles, or goes slack, at no cost. Its energy
    is then the least of W(e + a) over shortenings a that wrinkles can take up (the relaxed energy of tension-field
    theory), so that forces are its gradient. Slack cloth has no stiffness; where nothing else holds a particle, its
    place is not determined.

    A result reports the stress per width as it is: along the present warp, across it, shear, the largest and the least,
    and the state of each triangle: 2 taut, 1 wrinkled, 0 slack. Sources: Pipkin, "Relaxed energy densities for large
    deformations of membranes", 1994; Steigmann, "Tension-field theory", 1990.
    """

    kind: Literal["membrane"] = "membrane"
    mesh: str = Field(description="Name of the mesh that is the cloth")
    material: str | None = Field(default=None, description="Name of a cloth, or of a solid with `thickness`")
    thickness: float | None = Field(default=None, gt=0, le=1e12, description="Thickness of a solid material [length]")
    warp_stiffness: float | None = Field(default=None, ge=1e-12, le=1e12, description="Ew per width [force/length]")
    weft_stiffness: float | None = Field(
        default=None, ge=1e-12, le=1e12, description="Ef per width [force/length]; default: that of the warp"
    )
    shear_stiffness: float | None = Field(
        default=None, ge=1e-12, le=1e12, description="G per width [force/length]; default: that of an isotropic sheet"
    )
    poisson: float | None = Field(
        default=None, gt=-10, lt=10, description="nu, contraction along the weft by tension along the warp [-]; or 0"
    )
    warp: Maybe[Directions] = Field(
        default=None, description="Direction of the warp, one or one for each face; its length is ignored"
    )
    warp_lines: Maybe[Lines] = Field(default=None, description="Lines along which the warp runs: the nearest counts")
    prestress: Vectors = Field(
        default=np.zeros(3),
        description="Stress of the start shape along warp, along weft, in shear, one or one for each face, or for each "
        "triangle (a quad has four) [force/length]",
        json_schema_extra={"x-components": ["warp", "weft", "shear"]},
    )
    temperature: float | None = Field(
        default=None, ge=-1e12, le=1e12, description="Change of temperature, of a material [K]"
    )
    shape: Maybe[Points] = Field(
        default=None, description="Vertices of the mesh in the shape with the `prestress` [length]; default: the start"
    )
    wrinkling: bool = Field(default=False, description="Whether compression makes wrinkles, at no cost")

    formula: ClassVar[str] = "E = A0 e·C·e/2"
    arity: ClassVar[int] = 3
    shared: ClassVar[tuple[str, ...]] = ("warp", "warp_lines", "prestress", "shape")
    outputs: ClassVar[dict[str, str]] = {
        "warp": "force/length",
        "weft": "force/length",
        "shear": "force/length",
        "largest": "force/length",
        "least": "force/length",
        "state": "",
    }
    kernel: ClassVar[Any] = staticmethod(membrane_kernel)
    hessian: ClassVar[Any] = staticmethod(membrane_hessian)
    stressed: ClassVar[Any] = staticmethod(membrane_stressed)
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8], [4, 8, 7]]

    @model_validator(mode="after")
    def _given(self) -> Membrane:
        one_way(self)
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: area, gradients along warp and weft, stiffnesses, prestrain, wrinkling."""
        corners, share, face = halves(places.faces(self.mesh))
        x, faces = made(self, places)
        at = halves(faces)[0]
        cloth = numbers(self, places)
        along = grain(self, x, faces, cloth, places)[face]
        double = twice_area(x, at)
        flat = _flat(x, at, double)
        slopes = yarns(x, at, along) / np.where(flat, 0.5 * double, 1.0)[:, None]
        warp, weft, shear, poisson = cloth
        first, second, third = stresses(self, face, len(faces)).T
        free = 0.5 * (growth(self, places) ** 2 - 1.0)  # Green strain that meets no resistance
        strain = [
            first / warp - poisson * second / warp - free,
            second / weft - poisson * first / warp - free,
            third / shear,
        ]
        return Block.of(
            corners,
            area=np.where(flat, 0.5 * double * share, 0.0),
            slopes=np.where(flat[:, None], slopes, 0.0),
            cloth=np.tile(cloth, (len(corners), 1)),
            prestrain=np.column_stack(strain),
            wrinkling=float(self.wrinkling),
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Stresses per width [force/length] along warp, across it, in shear, the largest and the least; the state."""
        found = np.zeros((len(block.indices), 4))
        dispatch.compiled(membrane_stress)(x, block.indices, block.parameters, found)
        warp, weft, shear, state = found.T
        middle, radius = 0.5 * (warp + weft), np.hypot(0.5 * (warp - weft), shear)
        least = np.where(state == 1.0, 0.0, middle - radius)
        return {
            "warp": warp, "weft": weft, "shear": shear, "largest": middle + radius, "least": least, "state": state,
        }  # fmt: skip

    @classmethod
    def second(cls, block: Block, x: Floats) -> Floats:
        """Stress (m, 3) of the triangles as `prestress` has it: per width of the start shape [force/length]."""
        found = np.zeros((len(block.indices), 3))
        dispatch.compiled(membrane_second)(x, block.indices, block.parameters, found)
        return found

    def prestressed(self, more: Floats, faces: Ints) -> Membrane:
        """The same cloth with more stress (m, 3) in each of the triangles of these faces (k, 4) of its mesh."""
        own = stresses(self, halves(faces)[2], len(faces))
        return self.replaced(prestress=own + more)

    @classmethod
    def example(cls) -> tuple[Membrane, Floats]:
        """An irregular dome of quads and triangles (`example_faces`), prestressed and taut, wrinkled and slack."""
        x = [[0.0, 0.1, 0.0], [1.1, 0.0, 0.3], [2.0, -0.1, 0.1], [0.1, 1.0, 0.35], [0.9, 1.1, 0.7], [2.1, 0.9, 0.3]]
        x += [[-0.1, 2.0, 0.05], [1.0, 2.2, 0.4], [1.9, 2.1, -0.1]]
        return cls(
            mesh="skin", warp_stiffness=60.0, weft_stiffness=50.0, shear_stiffness=5.0, poisson=0.3, warp=[1.0, 0.2, 0],
            prestress=[2.0, 1.0, 0.3], wrinkling=True,
        ), np.array(x)  # fmt: skip


def twice_area(x: Floats, corners: Ints) -> Floats:
    """Twice the area (m,) of triangles."""
    a, b, c = (x[corners[:, i]] for i in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1))


def _flat(x: Floats, corners: Ints, double: Floats) -> Any:
    """Which triangles have a plane at the start."""
    a, b, c = (x[corners[:, i]] for i in range(3))
    size = ((b - a) ** 2).sum(axis=1) + ((c - a) ** 2).sum(axis=1)
    return (double > SLIVER * size) & (size > 1e-140)
