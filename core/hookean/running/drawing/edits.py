"""What is drawn or deleted in one edit, as a person or the studio gives it."""

from __future__ import annotations

from typing import Self

import numpy as np
from pydantic import model_validator

from hookean.scene.scene import AnyForce
from hookean.values.columns import Faces, IndexRows, Indices, Model, Points, Vector, fault
from hookean.values.fields import Field, Parts, Switch

NONE = np.zeros(0, np.int64)


class Add(Model):
    """New particles, faces between particles, and forces on them. The numbers of new particles follow those of the
    particles that are there."""

    called = "add"

    points: Points = Field(default=np.zeros((0, 3)), description="Where new particles start [length]")
    weld: float = Field(
        default=0.0,
        ge=0,
        description="Within this distance of where a particle is, or of an earlier one of the points, a point is that "
        "particle, by both numbers; 0: each is a new one [length]",
    )
    faces: dict[str, Faces] = Field(
        default={}, description="By the name of a mesh, faces that it gets: 3 or 4 particles each"
    )
    forces: Parts[AnyForce] = Field(
        default=(), description="Forces on particles by number, or on a mesh; joined to one of their name and values"
    )


class Divide(Model):
    """Springs and faces divided into smaller ones that behave as they did."""

    called = "divide"

    springs: Indices = Field(default=NONE, description="Springs by their numbers in the topology")
    faces: dict[str, Indices] = Field(default={}, description="By the name of a mesh, numbers of its faces")
    pieces: int = Field(default=2, ge=2, le=1000, description="Pieces of each spring; faces are halved both ways [-]")


class Extrude(Model):
    """Edges moved by a vector, with faces and springs between them and where they were."""

    called = "extrude"

    edges: IndexRows = Field(description="Pairs of particles")
    by: Vector = Field(description="Where the edges are moved, from where they are [length]")
    mesh: str = Field(default="", description="Name of the mesh that gets the faces; empty: no faces")


class Delete(Model):
    """Particles, springs and faces that are deleted, with all that needs them."""

    called = "delete"

    particles: Indices = Field(default=NONE, description="Particles")
    springs: Indices = Field(default=NONE, description="Springs by their numbers in the topology")
    faces: dict[str, Indices] = Field(default={}, description="By the name of a mesh, numbers of its faces")


class Draw(Model):
    """One edit of what is drawn: exactly one of `add`, `divide`, `extrude`, `delete`."""

    called = "draw"

    add: Switch[Add] = Field(default=None, description="New particles, faces and forces")
    divide: Switch[Divide] = Field(default=None, description="Springs and faces to divide")
    extrude: Switch[Extrude] = Field(default=None, description="Edges to extrude")
    delete: Switch[Delete] = Field(default=None, description="Particles, springs and faces to delete")

    @model_validator(mode="after")
    def _one(self) -> Self:
        given = [name for name in type(self).model_fields if getattr(self, name) is not None]
        if len(given) != 1:
            raise fault(f"{' and '.join(given) or 'nothing'} given; give exactly one of add, divide, extrude, delete")
        return self
