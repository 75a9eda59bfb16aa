"""Scene: everything a person describes. Frozen, validated, with a canonical form and a digest."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator, model_validator

from hookean.discretize.warpweft import warp_weft
from hookean.forces import KINDS, Force
from hookean.forces.floor import Floor
from hookean.scene import load_cases
from hookean.scene.load_cases import LoadCase, Stages
from hookean.scene.references import materials_exist, particles_exist
from hookean.scene.solver_names import SOLVERS
from hookean.scene.text import parse
from hookean.values import html
from hookean.values.by_kind import ByKind
from hookean.values.columns import (
    Faces,
    Indices,
    Lines,
    Model,
    NonNegatives,
    Points,
    Positives,
    fault,
)
from hookean.values.fields import Field, Maybe, Named, Part, Parts, Switch
from hookean.values.materials import Material
from hookean.values.mesh import Mesh
from hookean.values.sections import Section
from hookean.values.units import Units

AnyForce = Annotated[Force, ByKind(KINDS)]
"""A force of any kind."""


class MeshData(Model):
    """A mesh of the scene, shared by name: vertices `(n, 3)` [length] and faces of three or four vertices."""

    called: ClassVar[str] = "mesh"

    vertices: Points = Field(description="Coordinates [length]")
    faces: Faces = Field(description="Three or four vertices each, counted from 0")

    @model_validator(mode="after")
    def _faces_exist(self) -> Self:
        beyond = self.faces >= len(self.vertices)
        if beyond.any():
            row, column = np.argwhere(beyond)[0]
            given = self.faces[row, column]
            raise fault(
                f"vertex {given} does not exist; the mesh has {len(self.vertices)}, counted from 0",
                f"/faces/{row}/{column}",
            )
        return self

    @cached_property
    def families(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Warp and weft edges of a mesh of quads, found once for all scenes that have it."""
        return warp_weft(Mesh(self.vertices, self.faces))


class Anchor(Model):
    """Particles that are held exactly, on all or some axes, where they are or at targets, and their rotations if asked.

    An anchor never moves unless it is moved; its reaction is reported. For a soft one see `anchor_spring`. Rotations
    about held axes of space do not happen. If one or three are held, that is the orientation that remains possible; if
    it is one of three, what the free two add up to about it depends on the path, to second order of the rotation.
    """

    name: str = Field(default="", description="Name under which reactions list this anchor")
    particles: Maybe[Indices] = Field(default=None, description="Held particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of held particles")
    targets: Maybe[Points] = Field(
        default=None, description="Where to hold them [length]; default: at their start positions"
    )
    axes: Literal["x", "y", "z", "xy", "xz", "yz", "xyz", ""] = Field(default="xyz", description="Held directions")
    rotations: Literal["", "x", "y", "z", "xy", "xz", "yz", "xyz"] = Field(
        default="", description="Axes about which particles with rotations (ends of beams) do not turn"
    )

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        if (self.particles is None) == (self.points is None):
            raise fault("give exactly one of particles, points")
        count = len(self.particles if self.particles is not None else self.points)  # type: ignore[arg-type]
        if self.targets is not None and len(self.targets) != count:
            raise fault(f"{len(self.targets)} targets for {count} particles; give one for each", "/targets")
        if not self.axes and not self.rotations:
            raise fault("an anchor holds something: give axes or rotations", "/axes")
        return self


Anchors = Anchor
"""The same: one anchor may hold many particles."""


class Geometry(Model):
    """Carried geometry: each of its points that meets a particle moves with it.

    `points`, `polyline` and `curve` (control points of a NURBS curve) take points or particles; `lines` takes lines or
    pairs; `mesh` the name of one of the scene's meshes.
    """

    name: str = Field(default="", description="Name under which results list this geometry")
    kind: Literal["points", "lines", "polyline", "curve", "mesh"] = Field(description="Type of geometry")
    particles: Maybe[Indices] = Field(default=None, description="Particles it goes through (lines: start, end, ...)")
    points: Maybe[Points] = Field(default=None, description="Coordinates [length]")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines [length]")
    mesh: str | None = Field(default=None, description="Name of one of the scene's meshes")
    degree: int = Field(default=3, ge=1, le=11, description="Degree of a curve [-]")
    knots: tuple[float, ...] | None = Field(
        default=None, description="Knots, in the number that Rhino has; default: uniform"
    )
    weights: Maybe[NonNegatives] = Field(default=None, description="Weights of a curve's control points [-]")

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        given = [f for f in ("particles", "points", "lines", "mesh") if getattr(self, f) is not None]
        allowed = {"lines": ["lines", "particles"], "mesh": ["mesh"]}.get(self.kind, ["points", "particles"])
        if len(given) != 1 or given[0] not in allowed:
            raise fault(f"{' and '.join(given) or 'nothing'} given; {self.kind} needs one of {', '.join(allowed)}")
        if self.kind == "lines" and self.particles is not None and len(self.particles) % 2:
            raise fault("lines need an even number of particles: start, end, start, end", "/particles")
        return self


class Settings(Model):
    """How to solve. Defaults of time stepping are classic Kangaroo's."""

    solver: Literal[SOLVERS] = Field(default="auto", description="Solver; auto selects one and reports which")  # type: ignore[valid-type]
    tolerance: float = Field(default=1e-6, ge=0, le=1, description="Largest residual of a converged shape [-]")
    position_tolerance: float | None = Field(
        default=1e-6, ge=0, le=1, description="Largest position error / model size that auto accepts [-]; null: any"
    )
    allow_unstable: bool = Field(
        default=False, description="Accept unstable equilibria; else auto and newton search for a stable one"
    )
    max_iterations: int = Field(default=100_000, ge=0, le=10**9, description="Largest number of iterations")
    time_limit: float | None = Field(default=None, ge=0, description="Longest computing time [s]")
    time_step: float = Field(default=0.01, gt=0, description="Step of physical time [time]")
    divide_steps: bool = Field(
        default=True,
        description="Divide time steps that are too long; default: false if time_step is given",
    )
    sub_iterations: int = Field(default=20, ge=1, le=100_000, description="Time steps in a frame")
    drag: float = Field(default=1.0, ge=0, description="Viscous drag on every particle [force time/length]")
    floor: Switch[Floor] = Field(default=None, description="A floor: {} or true is the XY plane")

    @model_validator(mode="before")
    @classmethod
    def _who_chose(cls, value: Any) -> Any:
        if not isinstance(value, Mapping) or "divide_steps" in value:
            return value
        return {**value, "divide_steps": "time_step" not in value}

    @classmethod
    def changes(cls, given: Mapping[str, Any]) -> dict[str, Any]:
        """What changes with the given values: a step that is given is not divided, unless that is given too."""
        return {"divide_steps": False, **given} if "time_step" in given else dict(given)

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """As of any part of a scene; see `changes`."""
        return super().model_copy(update=self.changes(update or {}), deep=deep)

    @field_validator("floor", mode="before")
    @classmethod
    def _short_floor(cls, value: Any) -> Any:
        if value is True:
            return {}
        return None if value is False else value


class Origin(Model):
    """The family that a scene was made from, and its parameters; see `hookean.scene.families`."""

    name: str = Field(description="Name of the family")
    parameters: dict[str, float | str] = Field(default={}, description="Parameters by name, in the units of the scene")


class Scene(Model):
    """Particles, forces, anchors, carried geometry and settings; the same in Python and in JSON.

    Forces and anchors refer to particles by index (`particles`), by coordinates (`points`, `lines`) that are welded
    within `weld_tolerance`, or to a named mesh. `Scene(...)` and `Scene.read` raise InputError with the place of the
    first fault and one sentence; pydantic's `model_validate` raises ValidationError with all of them.
    """

    units: Part[Units] = Field(default=Units(), description="Units of all numbers")
    weld_tolerance: float = Field(
        default=0.001, ge=0, description="Points within this distance become one particle [length]"
    )
    strict: bool = Field(
        default=True, description="Whether anchors and loads that meet no particle are errors; false: warnings"
    )
    particles: Points = Field(
        default=np.zeros((0, 3)), description="Start positions [length]; never merged or renumbered"
    )
    masses: Positives = Field(
        default=1.0, description="Mass of the given particles [force time^2/length]; of welded ones 1"
    )
    velocities: Maybe[Points] = Field(default=None, description="Start velocities [length/time], one for each particle")
    meshes: Named[MeshData] = Field(default={}, description="Meshes by name")
    materials: Named[Material] = Field(default={}, description="Materials by name, for forces that name them")
    sections: Named[Section] = Field(default={}, description="Cross-sections by name, for forces that name them")
    forces: Parts[AnyForce] = Field(default=(), description="Forces on the particles")
    anchors: Parts[Anchor] = Field(default=(), description="Particles that are held")
    geometry: Parts[Geometry] = Field(default=(), description="Geometry that moves with the particles")
    settings: Part[Settings] = Field(default=Settings(), description="How to solve")
    load_cases: Named[LoadCase] = Field(default={}, description="Loads that act on the form, by the name of the case")
    combinations: dict[str, dict[str, float]] = Field(
        default={}, description="Factors on load cases, prestress and permanent [-], by the name of the combination"
    )
    stages: Switch[Stages] = Field(default=None, description="How the form becomes elastic for its load cases")
    family: Switch[Origin] = Field(default=None, description="Family of scenes that it was made from")

    @classmethod
    def read(cls, value: Any) -> Self:
        """A scene from a dict, or from JSON text or bytes; InputError with a pointer and one sentence."""
        return super().read(parse(value) if isinstance(value, str | bytes | bytearray) else value)

    def __repr__(self) -> str:
        return "\n".join(["Scene", *(f"  {line}" for line in self.summary())])

    __str__ = __repr__

    def _repr_html_(self) -> str:
        title, *lines = repr(self).splitlines()
        return html.summary(title, lines)

    def summary(self) -> list[str]:
        """A few lines for a person: its particles, forces, anchors, solver and units."""
        forces = [f"{f.name} ({f.called})" if f.name else f.called for f in self.forces]
        units = self.units
        return [
            f"particles: {len(self.particles)} given; points within {self.weld_tolerance:g} {units.length} become one",
            f"forces: {', '.join(forces) or 'none'}",
            f"anchors: {len(self.anchors)}, meshes: {len(self.meshes)}, carried geometry: {len(self.geometry)}",
            f"solver: {self.settings.solver}, tolerance {self.settings.tolerance:g} [-]",
            f"units: {units.length}, {units.force}, {units.time}",
        ]

    @property
    def canonical(self) -> str:
        """The scene as JSON with sorted keys and without white space: equal scenes, equal text."""
        return json.dumps(self.model_dump(mode="json"), sort_keys=True, separators=(",", ":"))

    @property
    def digest(self) -> str:
        """SHA-256 of the canonical form."""
        return hashlib.sha256(self.canonical.encode()).hexdigest()

    @model_validator(mode="after")
    def _references_exist(self) -> Self:
        count = len(self.particles)
        for group, items in (("forces", self.forces), ("anchors", self.anchors), ("geometry", self.geometry)):
            for i, item in enumerate(items):
                particles_exist(getattr(item, "particles", None), count, f"/{group}/{i}/particles")
                mesh = getattr(item, "mesh", None)
                if mesh is not None and mesh not in self.meshes:
                    names = ", ".join(repr(name) for name in self.meshes) or "none"
                    raise fault(f"mesh {mesh!r} does not exist; the scene has {names}", f"/{group}/{i}/mesh")
        for i, force in enumerate(self.forces):
            materials_exist(force, self.materials, self.sections, f"/forces/{i}")
        if self.velocities is not None and len(self.velocities) != count:
            raise fault(f"{len(self.velocities)} velocities for {count} particles; give one for each", "/velocities")
        if isinstance(self.masses, np.ndarray) and len(self.masses) != count:
            raise fault(f"{len(self.masses)} masses for {count} particles; give one value or one for each", "/masses")
        load_cases.check(self)
        return self


__all__ = [
    "Anchor",
    "Anchors",
    "Force",
    "Geometry",
    "Material",
    "MeshData",
    "Scene",
    "Section",
    "Settings",
    "Units",
]
