"""Wavefront OBJ: every particle a vertex, carried and acting meshes as faces, springs as lines."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from hookean.system import System

Floats = NDArray[np.float64]


def text(system: System, particles: Floats, said: Mapping[str, str] | None = None) -> str:
    """Particles (n, 3) [length] of a system as OBJ text, in the scene's length unit, with all digits; `said` stands in
    comments. Springs along edges of faces are left out."""
    lines = [f"# hookean; lengths in {system.scene.units.length}"]
    lines += [f"# {key} {line}" for key, value in (said or {}).items() for line in value.splitlines()]
    lines += ["v " + " ".join(map(repr, point)) for point in particles.tolist()]
    sides: set[tuple[int, int]] = set()
    for name in system.scene.meshes:
        faces = [_corners(face) for face in system.places.faces(name).tolist()]
        lines += [f"g {_word(name)}", *("f " + " ".join(str(v + 1) for v in face) for face in faces)]
        sides |= {_side(a, b) for face in faces for a, b in zip(face, face[1:] + face[:1], strict=True)}
    for group in system.groups:
        if group.cls.role == "internal" and group.block.indices.shape[1] == 2:
            for part in group.parts:
                pairs = group.block.indices[part.rows].tolist()
                free = [(a, b) for a, b in pairs if _side(a, b) not in sides]
                lines += [f"g {_word(part.force.name or 'springs')}"] if free else []
                lines += [f"l {a + 1} {b + 1}" for a, b in free]
    return "\n".join(lines) + "\n"


def _corners(face: list[int]) -> list[int]:
    """A face without the repeated corner by which a triangle is stored."""
    return face[:3] if face[3] == face[2] else face


def _side(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a < b else (b, a)


def _word(name: str) -> str:
    """A name as OBJ takes it: without blanks."""
    return "_".join(name.split()) or "unnamed"
