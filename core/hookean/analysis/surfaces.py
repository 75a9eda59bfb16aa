"""What the surface of a shape is like: displacement, slope, curvature, cloth, height lines, and where water runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.cloth_scalars import ClothScalars, cloth_scalars
from hookean.discretize.surface_lines import HeightLines, WaterLines, height_lines, water_lines
from hookean.discretize.surface_scalars import curvature, slope
from hookean.errors import InputError
from hookean.running.result import Result
from hookean.running.run import relax
from hookean.running.simulation import Simulation
from hookean.scene.scene import Scene
from hookean.system.system import System, compile
from hookean.values.mesh import Mesh
from hookean.values.units import Units

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False, repr=False)
class Surface:
    """The surface of a shape: numbers at its particles, and lines on it.

    `displacement` (n,) [length] of each particle from where it started; `slope` (n,) [degrees] to the horizontal,
    `mean_curvature` (n,) [1/length] and `gaussian_curvature` (n,) [1/length^2], nan at particles without faces, and the
    curvatures also on the boundary; `cloth` what membranes show; `heights` the lines of equal height; `water` the ways
    of drops.
    """

    mesh: Mesh
    displacement: Floats
    slope: Floats
    mean_curvature: Floats
    gaussian_curvature: Floats
    cloth: ClothScalars
    heights: HeightLines
    water: WaterLines
    units: Units

    def __repr__(self) -> str:
        return "\n".join(["Surface", *(f"  {line}" for line in self.summary())])

    def summary(self) -> list[str]:
        """The largest displacement and slope, the steps of height lines, and how many drops stay."""
        unit = self.units.length
        far = self.displacement
        lines = [f"moved by up to {far.max():.4g} {unit}, at particle {int(far.argmax())}"] if len(far) else []
        if np.isfinite(self.slope).any():
            angles = self.slope.round(6)  # without rounding of float64
            at = int(np.nanargmin(angles))
            lines.append(f"slope from {angles[at]:.4g} degrees, at particle {at}, to {np.nanmax(angles):.4g}")
        if np.isfinite(self.cloth.stress).any():
            at, unit_of = int(np.nanargmax(self.cloth.stress)), self.units.of("force/length")
            lines.append(f"cloth stressed by up to {self.cloth.stress[at]:.4g} {unit_of}, at particle {at}")
        lines.append(f"{len(np.unique(self.heights.heights))} height lines, {self.heights.step:g} {unit} apart")
        return [*lines, f"{len(self.water.lines)} drops of water, of which {int(self.water.stays.sum())} stay"]

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer; None for nan."""
        numbers = ("displacement", "slope", "mean_curvature", "gaussian_curvature")
        return {
            **{name: _plain(getattr(self, name)) for name in numbers},
            **{name: _plain(getattr(self.cloth, name)) for name in ("stress", "state", "utilisation")},
            "heights": {
                "step": self.heights.step,
                "pieces": self.heights.pieces.tolist(),
                "heights": self.heights.heights.tolist(),
            },
            "water": {"lines": [line.tolist() for line in self.water.lines], "stays": self.water.stays.tolist()},
            "units": self.units.model_dump(),
        }


def surface(model: Scene | Result | Simulation, step: float | None = None, drops: int = 200) -> Surface:
    """The surface of a shape: displacement, slope and curvature at its particles, stress, state and utilisation of
    cloth, height lines, and the ways of water.

    - `model`: A scene (which is relaxed), a result, or a simulation as it is now. Its surface has the faces of all its
      meshes.
    - `step`: From height line to height line [length]; default: a round one, for 20 lines at most.
    - `drops`: How many drops of water fall, at most; each on the middle of a triangle. 0: none.

    Formulas, errors and sources: `hookean.discretize.slope`, `curvature`, `height_lines` and `water_lines`. Raises
    InputError for another model, a step that is not positive or too short, or a number of drops that is not from 0 to
    10,000.
    """
    if not (isinstance(drops, int) and 0 <= drops <= 10_000):
        raise InputError("drops", f"{drops!r} given; a whole number from 0 to 10000 is expected")
    system, particles, units = _shape(model)
    mesh = Mesh(particles, _faces(system))
    mean, gaussian = curvature(mesh)
    return Surface(
        mesh,
        np.linalg.norm(particles - system.points, axis=1),
        slope(mesh),
        mean,
        gaussian,
        cloth_scalars(system, particles),
        height_lines(mesh, step),
        water_lines(mesh, count=drops),
        units,
    )


def _shape(model: Scene | Result | Simulation) -> tuple[System, Floats, Units]:
    if isinstance(model, Scene):
        model = relax(model)
    if isinstance(model, Simulation):
        system = model.system
        return system, model.state.x[: system.slots.count], system.scene.units
    if isinstance(model, Result) and model.scene is not None:
        system = compile(model.scene)
        if system.slots.count == len(model.particles):
            return system, np.asarray(model.particles), model.units
    said = f"a Scene, a Result of its own scene or a Simulation is expected, not this {type(model).__name__}"
    raise InputError("model", f"{said}; give one of these")


def _faces(system: System) -> Ints:
    """Faces (m, 4) of all meshes by particles, each once; those whose corners are no particles are left out."""
    scene = system.scene
    parts = [system.places.faces(name) for name in scene.meshes]
    for item, riders in zip(scene.geometry, system.carried, strict=True):
        if item.mesh is not None:
            parts.append(np.asarray(riders).reshape(-1)[np.asarray(scene.meshes[item.mesh].faces)])
    faces = np.concatenate([np.zeros((0, 4), np.int64), *parts])
    faces = faces[(faces >= 0).all(axis=1)]
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    found: Ints = faces[np.sort(first)]
    return found


def _plain(values: Floats) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
