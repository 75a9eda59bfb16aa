"""What a person should know of a compiled scene before it runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces import Block

if TYPE_CHECKING:
    from hookean.system.system import System

Floats = NDArray[np.float64]


def coincide(x, indices, rest, touched, same, closed):  # type: ignore[no-untyped-def]
    """Note which particles elements touch, which of those between two begin and end at one, and which of the others
    have a rest length and no length at the start; how many of each."""
    alike, short = 0, 0
    for e in range(indices.shape[0]):
        for j in range(indices.shape[1]):
            touched[indices[e, j]] = 1
        if indices.shape[1] == 2:
            a, b = np.uint64(indices[e, 0]), np.uint64(indices[e, 1])
            here = x[a, 0] == x[b, 0] and x[a, 1] == x[b, 1] and x[a, 2] == x[b, 2]
            same[e] = a == b
            closed[e] = here and a != b and rest[e] > 0.0
            alike += same[e]
            short += closed[e]
    return alike, short


def _rests(block: Block) -> Floats:
    """Rest lengths (m,) [length] of elements that have one, else zeros."""
    rest = [block.parameters[:, i] for i, name in enumerate(block.names) if name in ("rest_length", "rest_factor")]
    return np.asarray(rest[0] * rest[1]) if len(rest) == 2 else np.zeros(len(block.indices))


def cautions(system: System) -> list[str]:
    """Warnings before a run: springs of zero length, loads on unsupported particles, rotations held of particles that
    have none."""
    warnings: list[str] = []
    touched = np.zeros(len(system.x), dtype=np.int8)
    for group in system.groups:
        if group.cls.role == "load":
            continue
        for part in group.parts:
            block = group.of(part)
            index = np.ascontiguousarray(group.particles[part.rows])
            same, closed = np.zeros((2, len(index)), dtype=np.int8)
            alike, short = dispatch.compiled(coincide)(system.x, index, _rests(block), touched, same, closed)
            if alike:
                warnings.append(
                    f"/forces/{part.number}: {alike} of {len(same)} elements start and end at one particle (first: "
                    f"element {int(np.argmax(same))}) and have no length; lengthen them or lower weld_tolerance"
                )
            if short:
                warnings.append(
                    f"/forces/{part.number}: {short} of {len(closed)} elements have zero length (first: element "
                    f"{int(np.argmax(closed))}), so their forces have no direction; move their ends apart"
                )
    for anchor in system.held:
        if not anchor.free.any():
            touched[anchor.particles] = 1
        if not anchor.turning.all() and (none := system.slots.rows(anchor.particles) < 0).any():
            warnings.append(
                f"/anchors/{anchor.number}/rotations: particle {anchor.particles[none][0]} has no rotation to hold: no "
                "beam ends there" + (f" (nor have {none.sum() - 1} more)" if none.sum() > 1 else "")
            )
    alone = np.flatnonzero(((system.load_count > 0) & (touched == 0))[: system.slots.count])
    if len(alone) and not system.contacts:
        warnings.append(
            f"particle {alone[0]} carries a load but is unsupported: no spring, other force or anchor holds it"
            + (f" (and {len(alone) - 1} more)" if len(alone) > 1 else "")
        )
    if sum(len(group.parts) for group in system.groups if group.cls.role == "internal") > 1:
        from hookean.system.near_misses import near_misses

        warnings += near_misses(system)
    return warnings
