"""Shell: bending stiffness of a mesh, the same whatever its triangles."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints, Places
from hookean.forces.dihedral import bends, fold, fold_angles, wrapped
from hookean.forces.elastic import plate, without
from hookean.forces.shell_edges import Plan, bend, places
from hookean.forces.shell_geometry import (
    FIVE,
    curvature,
    elements,
    neighbours,
    renumbered,
    root_of_stiffness,
    rows,
    triangles,
)
from hookean.values.columns import fault
from hookean.values.fields import Field

# An element is a triangle 0 1 2 with edges (0 1), (1 2), (2 0), the tips 3 4 5 of the triangles across these edges, and
# the tips 6 7, 8 9, 10 11 of the next triangles beyond. HINGES: edge start, edge end, near tip, far tip; first the
# triangle's own edges, then those of its neighbours.
HINGES = np.array(
    [[0, 1, 2, 3], [1, 2, 0, 4], [2, 0, 1, 5]]
    + [[[i, 3 + i, (i + 1) % 3, 6 + 2 * i], [3 + i, (i + 1) % 3, i, 7 + 2 * i]][j] for i in range(3) for j in range(2)]
)
# columns of the parameters
STRENGTH, FACTOR, POISSON, AREA, REST, BOUND, AXES, PARTS, ACROSS, END = 0, 1, 2, 3, 4, 13, 22, 31, 46, 49


@device
def curve(x: Any, indices: Any, parameters: Any, e: Any, g: Any, turn: Any, bent: Any) -> None:
    """Write the turns of the nine edges, nan where there is none, with `g` as in `slopes`, and sqrt(A) K."""
    for h in range(9):
        a, b, c, d = (
            indices[e, HINGES[h, 0]], indices[e, HINGES[h, 1]], indices[e, HINGES[h, 2]], indices[e, HINGES[h, 3]]
        )  # fmt: skip
        turn[h] = np.nan
        if parameters[e, BOUND + h] != 0.0:
            angle = fold(x, a, b, c, d, g[h])
            turn[h] = wrapped(angle - parameters[e, FACTOR] * parameters[e, REST + h])
    bent[:] = 0.0
    for i in range(3):
        part = 0.0
        for j in range(5):
            if not np.isnan(turn[FIVE[i, j]]):
                part += parameters[e, PARTS + 5 * i + j] * turn[FIVE[i, j]]
        for k in range(3):
            bent[k] += parameters[e, AXES + 3 * k + i] * part


@device
def parts(parameters: Any, e: Any, row: Any) -> None:
    """Write the derivatives (9, 3) of sqrt(A) K by the turns of the nine edges."""
    row[:] = 0.0
    for i in range(3):
        for j in range(5):
            for k in range(3):
                part = parameters[e, AXES + 3 * k + i] * parameters[e, PARTS + 5 * i + j]
                row[FIVE[i, j], k] += part


@device
def add_turn(x: Any, indices: Any, e: Any, h: Any, moment: Any, g: Any, second: Any, block: Any) -> None:
    """Add a moment times the second derivatives of the turn of an edge to the block of a triangle."""
    a, b, c, d = (
        indices[e, HINGES[h, 0]], indices[e, HINGES[h, 1]], indices[e, HINGES[h, 2]], indices[e, HINGES[h, 3]]
    )  # fmt: skip
    bends(x, a, b, c, d, g[h], second)
    for i in range(12):
        for j in range(12):
            p, q = 3 * HINGES[h, i // 3] + i % 3, 3 * HINGES[h, j // 3] + j % 3
            block[p, q] += moment * second[i, j]


def shell_stressed(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    """The stiffness of the moments that a small movement, `memory` (m, 36), brings: their rates times the second
    derivatives of the turns."""
    g, second = np.zeros((9, 4, 5)), np.zeros((12, 12))
    turn, bent, row = np.zeros(9), np.zeros(3), np.zeros((9, 3))
    for e in range(indices.shape[0]):
        curve(x, indices, parameters, e, g, turn, bent)
        parts(parameters, e, row)
        bent[:] = 0.0
        for h in range(9):
            if not np.isnan(turn[h]):
                rate = 0.0
                for i in range(12):
                    rate += g[h, i // 3, i % 3] * memory[e, 3 * HINGES[h, i // 3] + i % 3]
                for k in range(3):
                    bent[k] += row[h, k] * rate
        for h in range(9):
            if not np.isnan(turn[h]):
                moment = 0.0
                for k in range(3):
                    moment += parameters[e, STRENGTH] * row[h, k] * bent[k]
                add_turn(x, indices, e, h, moment, g, second, blocks[e])


def shell_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    g, second = np.zeros((9, 4, 5)), np.zeros((12, 12))
    turn, bent, row, slope = np.zeros(9), np.zeros(3), np.zeros((9, 3)), np.zeros((3, 36))
    for e in range(indices.shape[0]):
        block = blocks[e]
        block[:] = 0.0
        slope[:] = 0.0
        curve(x, indices, parameters, e, g, turn, bent)
        parts(parameters, e, row)
        for h in range(9):
            if np.isnan(turn[h]):
                continue
            moment = 0.0
            for k in range(3):
                moment += parameters[e, STRENGTH] * row[h, k] * bent[k]
                for i in range(12):
                    slope[k, 3 * HINGES[h, i // 3] + i % 3] += row[h, k] * g[h, i // 3, i % 3]
            add_turn(x, indices, e, h, moment, g, second, block)
        for p in range(36):
            for q in range(36):
                for k in range(3):
                    block[p, q] += parameters[e, STRENGTH] * slope[k, p] * slope[k, q]


def shell_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    if indices.shape[0] == 1 and indices.shape[1] != 12:
        return bend(x, indices[0], parameters[0], memory[0], f, w)
    energy = 0.0
    g = np.zeros((9, 4, 5))
    turn, bent, on_part = np.zeros(9), np.zeros(3), np.zeros(3)
    for e in range(indices.shape[0]):
        curve(x, indices, parameters, e, g, turn, bent)
        strength = parameters[e, STRENGTH]
        energy += 0.5 * strength * (bent[0] * bent[0] + bent[1] * bent[1] + bent[2] * bent[2])
        for i in range(3):
            on_part[i] = 0.0
            for k in range(3):
                on_part[i] += strength * parameters[e, AXES + 3 * k + i] * bent[k]
        for h in range(9):
            if np.isnan(turn[h]):
                continue
            moment = 0.0
            for i in range(3):
                for j in range(5):
                    if FIVE[i, j] == h:
                        moment += parameters[e, PARTS + 5 * i + j] * on_part[i]
            for i in range(4):
                p = indices[e, HINGES[h, i]]
                w[p] += strength * parameters[e, BOUND + h] * g[h, i, 3] + np.abs(moment) * g[h, i, 4]
                for c in range(3):
                    f[p, c] -= moment * g[h, i, c]
    return energy


class Shell(Force):
    """Bending of a mesh as a thin plate or shell of bending stiffness D, from the fold angles of its edges.

    Energy per triangle A D ((1 - nu) |K|^2 + nu (tr K)^2) / 2, A its start area and K [1/length] its change of
    curvature, nu Poisson's ratio; a sheet of thickness t and modulus E has D = E t^3 / (12 (1 - nu^2)), so bending to
    the curvature k in one direction costs D k^2 / 2 per area. Give D, or a material and a thickness; with `membrane`
    on the same mesh it is a whole shell.

    K = sum over the three edges of (2 / h) phi n n^T, h the height on the edge, n its normal in the plane of the
    triangle, phi the part of the edge's change of fold angle theta - theta0 that lies on this side of the edge (the
    other triangle has the rest; Morley's plate element). phi is h / (h + h') (theta - theta0), corrected by the folds
    of the neighbouring edges as constant curvature of the start mesh requires. So constant curvature has its exact
    energy and its moments balance on any mesh, sheared or irregular. Naked edges turn freely (K has the least energy),
    so an edge that is held is simply supported; to clamp it, hold a second row of vertices as well, half a mesh width
    inside and half outside of the clamp. theta0 = angle factor x start angle. Quads are split along their shorter
    diagonal (a draw: first to third corner), which folds as any edge. Forces and moments of every triangle sum to zero,
    whatever its size.

    A result reports the largest fold of each triangle's edges, and the larger of its two principal bending moments per
    width, without its sign; with a thickness also the stress of bending at its faces, 6 M / t^2.

    The mesh may not have three faces at one edge; faces without area are left out. Sources: Morley, "The constant-
    moment plate-bending element", 1971; Grinspun et al., "Discrete shells", 2003; Grinspun et al., "Computing discrete
    shape operators on general meshes", 2006.
    """

    kind: Literal["shell"] = "shell"
    mesh: str = Field(description="Name of the mesh that bends")
    strength: float | None = Field(
        default=500.0, ge=0, le=1e12, description="D, plate bending stiffness [force length]"
    )
    angle_factor: float = Field(
        default=1.0, ge=-1e12, le=1e12, description="Factor on the start angles [-]; 0: flat, 1: as drawn"
    )
    poisson: float | None = Field(
        default=None, gt=-1, lt=1, description="nu, Poisson's ratio [-]; default: 0, or that of the material"
    )
    material: str | None = Field(default=None, description="Name of a solid, with a thickness in the place of D")
    thickness: float | None = Field(default=None, gt=0, le=1e12, description="t, of a material [length]")

    formula: ClassVar[str] = "E = A D ((1 - ν) |K - K0|² + ν tr²(K - K0))/2"
    arity: ClassVar[int] = 12
    outputs: ClassVar[dict[str, str]] = {"angle": "angle", "moment": "force"}
    kernel: ClassVar[Any] = staticmethod(shell_kernel)
    hessian: ClassVar[Any] = staticmethod(shell_hessian)
    stressed: ClassVar[Any] = staticmethod(shell_stressed)
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8], [4, 8, 7]]

    @model_validator(mode="before")
    @classmethod
    def _other_stiffness(cls, value: Any) -> Any:
        return without(value, "strength", ("material", "thickness"))

    @model_validator(mode="after")
    def _one_way(self) -> Shell:
        made = [name for name in ("material", "thickness") if getattr(self, name) is not None]
        if len(made) == 1 or (self.strength is None) == (not made):
            said = " and ".join([*(["strength"] if self.strength is not None else []), *made]) or "nothing"
            raise fault(f"{said} given; give either strength, or both material and thickness")
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: D, factor, nu, area, start angles, bounds, and sqrt(A) K by the nine fold angles."""
        strength, poisson = plate(self, places)
        corners = triangles(places.x, places.faces(self.mesh))
        across = neighbours(corners, f"/meshes/{self.mesh}/faces")
        bends = np.asarray((across >= 0).any(axis=1))
        corners, across = corners[bends], renumbered(across, bends)
        index, there = elements(corners, across)
        axes, parts, area = curvature(places.x, index, there, across, poisson)
        angles = fold_angles(places.x, index[:, HINGES])
        each = rows(axes, parts)
        bound = np.abs(np.einsum("mkh,mkl->mhl", each, each)).sum(axis=2)
        return Block.of(
            index,
            strength=strength,
            angle_factor=self.angle_factor,
            poisson=poisson,
            area=area,
            start_angles=np.where(bound > 0, angles, 0.0),
            bounds=bound,
            axes=axes.reshape(-1, 9),
            parts=parts.reshape(-1, 15),
            # so that blocks may stand anywhere among others
            across=np.where(across >= 0, across - np.arange(across.size).reshape(-1, 3), 0),
        )

    @classmethod
    def pack(cls, block: Block, memory: Floats, damped: bool) -> tuple[Ints, Floats, Floats] | None:
        """The edges and the triangles, each once; see `shell_edges`."""
        planned, table, room = cls._planned(block)
        return None if planned is None else (planned.quick, table, room)

    @classmethod
    def whole(cls, block: Block, memory: Floats) -> tuple[Ints, Floats, Floats]:
        """The same, with lumped stiffness."""
        planned, table, room = cls._planned(block)
        return (block.indices, block.parameters, memory) if planned is None else (planned.whole, table, room)

    @staticmethod
    def _planned(block: Block) -> tuple[Plan | None, Floats, Floats]:
        """Plan, numbers and room of a block; no plan where it lacks triangles that others of it bend with."""
        p, given = block.parameters, block.parameters[:, : POISSON + 1]
        if not block.plan:
            across = places(block.indices, p[:, ACROSS:END].astype(np.int64), p[:, FACTOR])
            made = Plan.of(block.indices[:, :3], across) if across is not None else None
            block.plan[:] = [made, given * np.nan, given, made.room() if made else given]
        planned, before, table, room = block.plan
        if planned is not None and not np.array_equal(before, given):
            rest, axes, parts = p[:, REST:BOUND], p[:, AXES:PARTS].reshape(-1, 3, 3), p[:, PARTS:ACROSS]
            bounds = planned.summed(p[:, STRENGTH, None] * p[:, BOUND:AXES])
            table = planned.numbers(p[:, STRENGTH], p[:, FACTOR, None] * rest[:, :3], bounds, axes, parts)
            block.plan[:] = [planned, given.copy(), table, room]
        return planned, table, room

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Largest fold of each triangle's edges away from rest [rad], the larger of its two principal bending moments
        per width, without its sign [force]."""
        parameters = block.parameters
        rest = parameters[:, FACTOR, None] * parameters[:, REST:BOUND]
        turn = wrapped(fold_angles(x, block.indices[:, HINGES]) - rest)
        turn = np.where(parameters[:, BOUND:AXES] > 0, turn, 0.0)
        each = rows(parameters[:, AXES:PARTS].reshape(-1, 3, 3), parameters[:, PARTS:ACROSS].reshape(-1, 3, 5))
        bent = np.einsum("mkh,mh->mk", each, turn)
        poisson = float(parameters[0, POISSON]) if len(parameters) else 0.0
        bent = bent @ root_of_stiffness(poisson)  # moments are D times what has the energy |bent|^2, times this again
        # by components xx, yy and sqrt(2) xy: the principal ones are half of their sum +- spread
        xx, yy, xy = bent.T
        mean, spread = 0.5 * (xx + yy), 0.5 * np.hypot(xx - yy, np.sqrt(2.0) * xy)
        moment = parameters[:, STRENGTH] * (np.abs(mean) + spread) / np.sqrt(parameters[:, AREA])
        return {"angle": np.abs(turn[:, :3]).max(axis=1, initial=0.0), "moment": moment}

    @classmethod
    def example(cls) -> tuple[Shell, Floats]:
        """An irregular dome of quads and triangles (`example_faces`) that wants to be half as deep."""
        x = [[0.0, 0.1, 0.0], [1.1, 0.0, 0.3], [2.0, -0.1, 0.1], [0.1, 1.0, 0.35], [0.9, 1.1, 0.7], [2.1, 0.9, 0.3]]
        x += [[-0.1, 2.0, 0.05], [1.0, 2.2, 0.4], [1.9, 2.1, -0.1]]
        return cls(mesh="skin", strength=20.0, angle_factor=0.5), np.array(x)
