"""Analyses of a scene: the table of them, and the task that runs one. Runs in a worker; no physics here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, TypeVar

from pydantic import ValidationError

import hookean
from hookean.errors import InputError
from hookean.files.documents import plain
from hookean.running.run import bounded
from hookean.scene.scene import Scene
from hookean.scene.text import parse
from hookean.values.columns import Model
from hookean.values.faults import faults
from hookean.values.fields import Field
from hookean_server.http import answers
from hookean_server.problems import faulty
from hookean_server.workers.task import Cancelled, Clock, Done

Given = TypeVar("Given", bound=Model)

LARGEST = 5_000_000  # numbers in an answer


class Modes(Model):
    """How many modes."""

    count: int = Field(default=6, ge=1, le=200, description="How many modes")


CASE = "Load case or combination of which the shape is, frozen; null: none"


class Frequencies(Modes):
    """How many modes, of which masses and load case."""

    masses: float | tuple[float, ...] | Literal["self_weight"] | None = Field(
        default=None,
        description="Mass of all or of each particle [mass], or that of its self_weight; null: those of the scene",
    )
    case: str | None = Field(default=None, description=CASE)


class Mechanisms(Model):
    """Of which load case."""

    case: str | None = Field(default=None, description=CASE)


class Buckling(Modes):
    """How many factors, and which loads grow."""

    loads: tuple[str, ...] | None = Field(default=None, description="Names of the loads that grow; null: all")
    case: str | None = Field(default=None, description="Load case or combination whose loads these are; null: none")


class LoadPath(Model):
    """Which loads change, and how far."""

    loads: tuple[str, ...] | None = Field(default=None, description="Names of the loads that change; null: all")
    case: str | None = Field(default=None, description="Load case or combination whose loads these are; null: none")
    steps: int = Field(default=50, ge=1, le=1000, description="Points of the path at most")
    increment: float = Field(default=0.1, description="Load factor of the first step [-]")
    largest_factor: float | None = Field(default=None, description="End at this load factor [-]; null: after all steps")
    arc_length: float | None = Field(default=None, gt=0, description="Length of a step [length]; null: by increment")


class Patterns(Model):
    """How a surface is cut."""

    mesh: str | None = Field(default=None, description="Name of the mesh to cut; null: the only one")
    along: Literal["warp", "weft"] = Field(default="warp", description="Direction of the strips by the rows of a mesh")
    rows: int = Field(default=1, ge=1, description="Rows of faces to a strip")
    compensation: tuple[float, float] = Field(default=(0.0, 0.0), description="Strains along warp and weft [-]")
    allowance: float = Field(default=0.0, ge=0, description="Width of cloth beyond seams and edges [length]")


class Cables(Model):
    """What the workshop adds to the length of a cable."""

    stretch: float = Field(default=0.0, ge=0, description="Construction stretch of new rope [-]")
    fitting: float = Field(default=0.0, ge=0, description="Length of a fitting at each end [length]")


@dataclass(frozen=True)
class Analysis:
    """One analysis: its function, its options beside the scene, and the fields of its answer."""

    function: Callable[..., Any]
    options: type[Model]
    gives: tuple[str, ...]

    @property
    def summary(self) -> str:
        """The first line of the function's description."""
        return (self.function.__doc__ or "").strip().splitlines()[0]

    def size(self, scene: Scene, options: Model) -> int:
        """How many numbers its shapes have, about."""
        shapes = getattr(options, "count", getattr(options, "steps", 1))
        meshes = sum(len(mesh.vertices) for mesh in scene.meshes.values())
        return 3 * int(shapes) * (len(scene.particles) + meshes)


ANALYSES: dict[str, Analysis] = {
    "frequencies": Analysis(
        hookean.frequencies, Frequencies, ("frequencies", "modes", "effective_masses", "units", "notes")
    ),
    "buckling": Analysis(hookean.buckling, Buckling, ("factors", "modes", "particles", "loads", "units", "notes")),
    "load-path": Analysis(hookean.load_path, LoadPath, ("factors", "particles", "stable", "critical_points", "units")),
    "mechanisms": Analysis(
        hookean.mechanisms, Mechanisms, ("mechanisms", "free_turns", "self_stress_states", "modes", "left_out", "units")
    ),
    "patterns": Analysis(hookean.cutting_patterns, Patterns, ("strips", "seams", "compensation", "table", "units")),
    "cables": Analysis(hookean.cables, Cables, ("cables", "table", "units")),
}
"""Every analysis by the last part of its address; routes, description and tests walk this table."""


def analyse(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """Run the analysis `options["analysis"]` on the scene in `body`. Raises InputError with a pointer into the body."""
    clock = Clock()
    analysis = ANALYSES[options["analysis"]]
    scene, given = request(body, analysis.options, options["seconds"])
    if analysis.size(scene, given) > LARGEST:
        raise InputError("/", f"the answer would have more than {LARGEST:,} numbers; ask for fewer modes or steps")
    clock.lap("decode")
    try:
        found = analysis.function(scene, **given.model_dump())
    except InputError as error:
        raise InputError(placed(error.pointer), error.sentence) from None
    clock.lap("analyse")
    text = answers.dump(found.to_dict(), options.get("arrays") or "list")
    clock.lap("encode")
    return Done(text, timing=clock.parts)


def request(body: bytes, options: type[Given], seconds: float | None) -> tuple[Scene, Given]:
    """The scene in a body, with a time limit unless that is None, and the options beside it."""
    value = parse(body)
    if not isinstance(value, dict):
        raise InputError("/", "an object with a scene is expected")
    if "scene" not in value:
        raise InputError("/scene", "this is required")
    given = options.model_validate({name: v for name, v in value.items() if name != "scene"})
    scene = read_scene(value["scene"])
    return scene if seconds is None else bounded(scene, seconds), given


def placed(pointer: str) -> str:
    """The place of a fault of a function's argument in the body."""
    if pointer.startswith("/"):
        return f"/scene{pointer}".rstrip("/")
    return "/scene" if pointer in ("model", "result", "scene") else f"/{pointer}"


def read_scene(value: Any) -> Scene:
    """The scene in a body; its faults are those of an invalid scene, under /scene."""
    try:
        read = plain(value)
        scene = Scene.model_validate(read.scene)
        if read.unheld:
            raise InputError("/", read.unheld)
        return scene
    except InputError as error:
        found = list(error.faults)
    except ValidationError as error:
        found = faults(error)
    places = [f"/scene{f.pointer}".rstrip("/") for f in found]
    raise faulty("invalid-scene", [InputError(at, f.sentence) for at, f in zip(places, found, strict=True)])
