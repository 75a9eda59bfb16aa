"""What other programs take of membranes and shells: triangles of cloth and plates, what they are made of, and their
stress."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hookean.forces.base import Block, Force
from hookean.forces.cloth import ALIKE, numbers
from hookean.forces.elastic import plate
from hookean.forces.membrane import SLOPES, Membrane
from hookean.forces.shell import Shell
from hookean.forces.soapfilm import halves
from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STRESSES = ("warp", "weft", "shear")


@dataclass(frozen=True)
class Sheet:
    """The cloth of one membrane, and of the shell on the same mesh if there is one: `corners` (m, 3) of its triangles,
    with the `share` (m,) of each in the sheet, as a quad is the mean of its two cuts, and its `face` (m,) of `faces`
    (k, 4); `stiffness`, along warp and weft and in shear [force/length], and Poisson's ratio; `thickness` [length] of
    a shell or a solid material, else None; `bends`, whether there is a shell; `left`, what a file does not hold."""

    name: str
    corners: Ints
    share: Floats
    face: Ints
    faces: Ints
    stiffness: tuple[float, float, float, float]
    thickness: float | None
    material: str | None
    bends: bool
    left: tuple[str, ...]
    force: Membrane
    block: Block

    @property
    def isotropic(self) -> bool:
        """Whether it is alike in all directions."""
        warp, weft, shear, poisson = self.stiffness
        return abs(warp - weft) <= ALIKE * warp and abs(2.0 * shear * (1.0 + poisson) - warp) <= ALIKE * warp

    def axes(self, points: Floats) -> Floats:
        """Unit vectors (m, 3, 3) by rows in each triangle at the points: along the warp, across it, and the normal."""
        a, b, c = (points[self.corners[:, i]] for i in range(3))
        normal = _units(np.cross(b - a, c - a))
        slopes = self.block.parameters[:, SLOPES : SLOPES + 3]
        warp = _units(np.einsum("mi,mic->mc", slopes, points[self.corners]))
        return np.stack([warp, np.cross(normal, warp), normal], axis=1)

    def stress(self, points: Floats) -> Floats:
        """Stress (m, 3) per width [force/length] at the points: along the warp, across it, and in shear."""
        found = self.force.measure(self.block, points, np.zeros((0, 3)))
        return np.stack([found[name] for name in STRESSES], axis=1)


def _units(vectors: Floats) -> Floats:
    size = np.linalg.norm(vectors, axis=1)
    return vectors / np.where(size > 0.0, size, 1.0)[:, None]


def sheets(system: System) -> tuple[list[Sheet], set[int]]:
    """The membranes of a system, and the numbers of the forces that they stand for: of themselves and of shells that
    bend them."""
    shells = {n: force for n, force in enumerate(system.scene.forces) if isinstance(force, Shell)}
    found, held = list[Sheet](), set[int]()
    for group in system.groups:
        for part in group.parts:
            force = part.force
            if not isinstance(force, Membrane) or part.number < 0:
                continue
            block = group.of(part)
            faces = system.places.faces(force.mesh)
            _, share, face = halves(faces)
            stiffness = numbers(force, system.places)
            same = [n for n, shell in shells.items() if shell.mesh == force.mesh and n not in held]
            thickness, plates = force.thickness, _plates(system, stiffness, [shells[n] for n in same])
            if plates is not None:
                thickness = plates
                held.update(same)
            bends = plates is not None
            left = ["its wrinkles"] if force.wrinkling else []
            left += ["the bending that its shell has at the start"] if any(_folded(shells[n]) for n in same) else []
            name = force.name or force.kind_name
            made = Sheet(
                name, block.indices, share[part.inputs], face[part.inputs], faces, stiffness, thickness, force.material,
                bends, tuple(left), force, block,
            )  # fmt: skip
            found.append(made)
            held.add(part.number)
    return found, held


def _folded(shell: Shell) -> bool:
    """Whether a shell is not without stress as drawn."""
    return shell.angle_factor != 1.0


def _plates(system: System, stiffness: tuple[float, float, float, float], shells: Sequence[Force]) -> float | None:
    """The thickness [length] of a plate that has the stiffness of a membrane and of a shell, E t and D = E t^3 /
    (12 (1 - nu^2)); None without a shell, or where no plate has both."""
    if len(shells) != 1:
        return None
    bending, poisson = plate(shells[0], system.places)
    warp, weft, shear, own = stiffness
    alike = abs(warp - weft) <= ALIKE * warp and abs(2.0 * shear * (1.0 + own) - warp) <= ALIKE * warp
    if not alike or abs(own - poisson) > ALIKE or not bending > 0.0:
        return None
    return float(np.sqrt(12.0 * bending * (1.0 - own**2) / warp))
