"""Magnet snap: particles that attract each other where they are near."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Places, lengths
from hookean.forces.groups import FIRST
from hookean.values.columns import IndexRows, Labels, Points
from hookean.values.fields import Field, Maybe

STRENGTH, RANGE = 2, 3  # columns of the parameters
LARGEST = 100  # members of a group up to which it is one element of a tangent
FAR = 1048576.0  # cells: what is farther away is in the last one


@device
def bucket(cell: Any, group: Any, size: Any) -> Any:
    """Where in a table of `size`, a power of 2, the members in a cell are."""
    mixed = int(cell[0]) * 73856093 ^ int(cell[1]) * 19349663 ^ int(cell[2]) * 83492791 ^ int(group) * 2654435761
    return mixed & (size - 1)


@device
def snap(x: Any, a: Any, b: Any, strength: Any, reach: Any, f: Any, w: Any) -> Any:
    """Attract two particles, if they are near enough; the energy, which is 0 at the range."""
    square = 0.0
    for c in range(3):
        square += (x[b, c] - x[a, c]) * (x[b, c] - x[a, c])
    if not square < reach * reach:
        return 0.0
    w[a] += 2.0 * strength
    w[b] += 2.0 * strength
    for c in range(3):
        pull = strength * (x[b, c] - x[a, c])
        f[a, c] += pull
        f[b, c] -= pull
    return 0.5 * strength * (square - reach * reach)


def magnet_snap_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    # cells as wide as the range, in a table of chains: each member meets those before it in 27 cells
    energy, count, size = 0.0, indices.shape[0], 16
    while size < count:
        size *= 2
    chains, cells, near = np.full(size + count, -1), np.zeros((count, 3)), np.zeros(3)
    for e in range(count):
        first = e - int(parameters[e, FIRST])
        a, start, strength, reach = indices[e, 0], indices[first, 0], parameters[e, STRENGTH], parameters[e, RANGE]
        for c in range(3):
            cells[e, c] = min(max(np.floor((x[a, c] - x[start, c]) / reach), -FAR), FAR)
        for i in range(27):
            near[0] = cells[e, 0] + i // 9 - 1
            near[1] = cells[e, 1] + i // 3 % 3 - 1
            near[2] = cells[e, 2] + i % 3 - 1
            other = chains[bucket(near, first, size)]
            while other >= 0:
                same = near[0] == cells[other, 0] and near[1] == cells[other, 1] and near[2] == cells[other, 2]
                if same and other - int(parameters[other, FIRST]) == first:
                    energy += snap(x, indices[other, 0], a, strength, reach, f, w)
                other = chains[size + other]
        place = bucket(cells[e], first, size)
        chains[size + e] = chains[place]
        chains[place] = e
    return energy


class Snapped(Force):
    """Whole groups as elements: for their tangents alone."""

    tangent: ClassVar[Any] = staticmethod(lambda block, x: _stiffness(block, x))


def _stiffness(block: Block, x: Floats) -> Floats:
    """Stiffness (k, 3 n, 3 n) of groups: k times the Laplacian of the pairs that attract each other."""
    corners = x[block.indices]
    apart = corners[:, :, None] - corners[:, None]
    near = (apart**2).sum(axis=3) < block.parameters[:, RANGE, None, None] ** 2
    pairs = np.where(near & ~np.eye(corners.shape[1], dtype=bool), block.parameters[:, STRENGTH, None, None], 0.0)
    whole = np.einsum("kij,cd->kicjd", -pairs, np.eye(3))
    each = np.arange(corners.shape[1])
    whole[:, each, :, each] += np.einsum("ki,cd->ikcd", pairs.sum(axis=2), np.eye(3))
    return np.asarray(whole.reshape(len(corners), 3 * len(each), 3 * len(each)))


class MagnetSnap(groups.Grouped):
    """Particles of a group that attract each other where they are nearer than the range R: E = k (d^2 - R^2) / 2.

    The force k d of each pair ends at once at the range, and the energy is 0 from there on; what is near meets, and
    what is far stays as it is. Which pairs are near is found in every step, in a time that grows with the number of
    particles. Groups of more than 100 particles have no tangent: such models relax, and their stability is unknown.
    """

    kind: Literal["magnet_snap"] = "magnet_snap"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of particles")
    group: Maybe[Labels] = Field(
        default=None, description="Number of the group of each particle; default: all are in one"
    )
    strength: float = Field(default=1000.0, ge=0, le=1e12, description="k of each pair [force/length]")
    range: float = Field(default=0.5, gt=0, le=1e12, description="R [length]")

    formula: ClassVar[str] = "E = k (d² - R²)/2, d < R"
    creates: ClassVar[bool] = False
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    kernel: ClassVar[Any] = staticmethod(magnet_snap_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the groups, strength and range."""
        index = places.elements(self)
        return Block.of(index, links=groups.links(index, self.group), strength=self.strength, range=self.range)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Size of the force on each particle [force]."""
        return {"force": lengths(element_forces[:, 0])}

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Whole groups; members of large ones by themselves, with k for each other member: a bound from above."""
        found: list[tuple[type[Force], Block]] = []
        for rows in groups.by_size(block):
            members, flat = rows.shape[1], rows.ravel()
            if members > LARGEST:
                bound = 2.0 * members * block.parameters[flat, STRENGTH]
                found.append((groups.Whole, groups.bounded(block.indices[flat], bound)))
            else:
                table = np.ascontiguousarray(block.parameters[rows[:, 0]])
                found.append((Snapped, Block(block.indices[rows, 0], table, np.zeros((len(rows), 0)))))
        return found

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """Which pairs are near changes from shape to shape."""
        most = int(np.unique(groups.heads(block), return_counts=True)[1].max(initial=0))
        return f"a group of {most} particles that snap is too large for a tangent" if most > LARGEST else ""

    @classmethod
    def example(cls) -> tuple[MagnetSnap, Floats]:
        """Two groups, in which some pairs are near and others far."""
        x = [[0, 0, 0], [1.0, 0.2, 0], [0.3, 1.1, -0.1], [5, 5, 5], [5.2, 6, 5.1], [0.4, 0.5, 1.2], [9, 5, 5.0]]
        return cls(particles=range(7), group=[1, 1, 1, 0, 0, 0, 0], strength=7.0, range=2.5), np.array(x)
