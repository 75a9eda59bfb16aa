"""Wavefront OBJ: every particle a vertex, carried and acting meshes as faces, springs as lines, anchors as points."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from hookean.system.system import System

Floats = NDArray[np.float64]
LACKS = (
    "An OBJ file stores the shape and the held particles, not forces, loads, stiffness, rest lengths and settings. "
    "When it is opened again, lines become springs of 1000 N/m as long as drawn, faces nets that draw tight."
)


def text(system: System, particles: Floats, free: Floats, said: Mapping[str, str] | None = None) -> str:
    """Particles (n, 3) [length] of a system as OBJ text, in the scene's length unit, with all digits; `said` is in
    comments.

    Each face and each line is written once, whichever meshes and forces share it; springs along edges of faces are left
    out. Particles that are held on all axes, where `free` (n, 3) is 0, are points.
    """
    lines = [f"# hookean; lengths in {system.scene.units.length}", f"# {LACKS}"]
    lines += [f"# {key} {line}" for key, value in (said or {}).items() for line in value.splitlines()]
    lines += ["v " + " ".join(map(repr, point)) for point in particles.tolist()]
    drawn: set[frozenset[int]] = set()
    sides: set[frozenset[int]] = set()
    for name in system.scene.meshes:
        faces = [_corners(face) for face in system.places.faces(name).tolist() if min(face) >= 0]
        lines += _group(name, "f", _fresh(faces, drawn))
        sides |= {frozenset(side) for face in faces for side in zip(face, face[1:] + face[:1], strict=True)}
    for group in system.groups:
        if group.cls.role == "internal" and group.particles.shape[1] == 2:
            for part in group.parts:
                pairs = group.particles[part.rows].tolist()
                lines += _group(part.force.name or "springs", "l", _fresh(pairs, sides))
    held = np.flatnonzero((free == 0).all(axis=1)[: len(particles)]).tolist()
    lines += _group("anchors", "p", [held] if held else [])
    return "\n".join(lines) + "\n"


def _fresh(elements: list[list[int]], known: set[frozenset[int]]) -> list[list[int]]:
    """Elements on particles that no known or earlier element has; they are known from now on."""
    found = []
    for element in elements:
        corners = frozenset(element)
        if corners not in known:
            known.add(corners)
            found.append(element)
    return found


def _group(name: str, statement: str, elements: list[list[int]]) -> list[str]:
    """A group of statements, if there are any."""
    lines = [f"{statement} " + " ".join(str(v + 1) for v in element) for element in elements]
    return [f"g {_word(name)}", *lines] if lines else []


def _corners(face: list[int]) -> list[int]:
    """A face without the repeated corner by which a triangle is stored."""
    return face[:3] if face[3] == face[2] else face


def _word(name: str) -> str:
    """A name as OBJ accepts it: without blanks."""
    return "_".join(name.split()) or "unnamed"
