"""Load-displacement paths through limit points, by arc length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.arc_length import Follower, Point
from hookean.analysis.at_rest import divided, relaxed
from hookean.analysis.load_cases import growing
from hookean.errors import InputError
from hookean.scene.scene import Scene
from hookean.values.units import Units

Floats = NDArray[np.float64]

MOST = 10_000  # steps


@dataclass(frozen=True)
class CriticalPoint:
    """Where a path loses or regains stability. `kind`: limit (the load factor turns back) or bifurcation (another path
    crosses); the load `factor` [-]; `step`, the point of the path after which it comes; `particles` (n, 3) [length]."""

    kind: str
    factor: float
    step: int
    particles: Floats = field(repr=False)

    def to_dict(self) -> dict[str, Any]:
        """As plain values."""
        return {"kind": self.kind, "factor": self.factor, "step": self.step, "particles": self.particles.tolist()}


@dataclass(frozen=True)
class LoadPath:
    """Equilibrium shapes of a structure as some of its loads grow and shrink by one factor.

    `factors` (k,) [-], from 0; `particles` (k, n, 3) [length]; `stable` (k,): whether the tangent is positive definite;
    `critical_points` in the order of the path; `message`: why it ends.
    """

    factors: Floats
    particles: Floats = field(repr=False)
    stable: NDArray[np.bool_]
    critical_points: tuple[CriticalPoint, ...]
    message: str
    loads: tuple[str, ...] = ()
    units: Units = field(default_factory=Units)

    @property
    def displacements(self) -> Floats:
        """Movements (k, n, 3) [length] from the first shape."""
        return np.asarray(self.particles - self.particles[0])

    @property
    def limit(self) -> float | None:
        """The load factor of the first limit point or bifurcation [-]; None where there was none."""
        return self.critical_points[0].factor if self.critical_points else None

    def __repr__(self) -> str:
        return "\n".join(["Load path", *(f"  {line}" for line in self.summary())])

    def summary(self) -> list[str]:
        """A few lines: points, largest factor, critical points, why it ended."""
        unit, far = self.units.length, np.linalg.norm(self.displacements, axis=2).max(initial=0.0)
        lines = [f"{len(self.factors)} points, load factors {self.factors.min():.6g} to {self.factors.max():.6g}"]
        lines.append(f"moved by up to {far:.6g} {unit}")
        lines += [f"{point.kind} point at load factor {point.factor:.8g}" for point in self.critical_points]
        return [*lines, self.message]

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        return {
            "factors": self.factors.tolist(),
            "particles": self.particles.tolist(),
            "stable": self.stable.tolist(),
            "critical_points": [point.to_dict() for point in self.critical_points],
            "message": self.message,
            "loads": list(self.loads),
            "units": self.units.model_dump(),
        }


def load_path(
    scene: Scene,
    *,
    loads: Sequence[str] | None = None,
    steps: int = 50,
    increment: float = 0.1,
    largest_factor: float | None = None,
    arc_length: float | None = None,
    case: str | None = None,
) -> LoadPath:
    """Follow the equilibrium of a structure as some of its loads grow from nothing, also where they have to shrink.

    Crisfield's cylindrical arc length: each step ends where all movements of a step together have a given length, so
    the path passes limit points (snap-through) and turns back (snap-back). Limit points and bifurcations between two
    points are found to rounding by the rate of the load factor, or bracketed by the number of negative eigenvalues;
    where the points between do not lead to one, the step left its path and is taken again, shorter. So is a step that
    turns by more than 37 degrees from the path at one of its ends, that passes two limit points, or that ends where the
    structure is three times as stiff as before. The path goes straight on at bifurcations.

    - `scene`: The structure with its loads.
    - `loads`: Names (or kinds) of the loads that change; default: all. The others act in full from the start.
    - `steps`: How many points at most, after the first.
    - `increment`: Load factor of the first step [-], which sets the length of the arc.
    - `largest_factor`: End at this load factor [-], exactly; default: only after all steps.
    - `arc_length`: The length of a step [length], the root of the sum of squares of all movements; default: from
      `increment`.
    - `case`: A load case or combination: its elastic model, in the form, under its loads times their factors.

    Raises InputError where the structure has no stiffness without these loads, or is not in equilibrium.
    Source: Crisfield, A fast incremental/iterative solution procedure that handles snap-through, 1981; Wriggers and
    Simo, A general procedure for the direct computation of turning and bifurcation points, 1990.
    """
    _checked(steps, increment, largest_factor, arc_length)
    system, state, numbers = growing(scene, loads, case)
    if system.films is not None:
        raise InputError("model", "soap films have no load path; freeze the form and analyse the elastic model")
    (rest_system, start), alone = divided(system, state, numbers)
    rest = relaxed(rest_system, start, "without the loads")
    follower = Follower(rest, *alone)
    count = rest.system.slots.count
    points, critical = [follower.first()], list[CriticalPoint]()
    reach = arc_length or follower.reach(points[0], increment)
    message = f"all {steps} steps are done"
    for _ in range(steps):
        step, found = follower.onward(points, reach)
        if step is None:
            message = "no step is short enough: the path ends, or the structure has no stiffness there"
            break
        critical += [CriticalPoint(kind, at.factor, len(points) - 1, at.x[:count]) for kind, at in found]
        points.append(step)
        if largest_factor is not None and _passed(points, largest_factor):
            points[-1] = follower.at_factor(points[-2], points[-1], largest_factor)
            critical = [c for c in critical if c.step < len(points) - 2 or abs(c.factor) <= abs(largest_factor)]
            message = f"the load factor reached {largest_factor:g}"
            break
    names = tuple(system.scene.forces[i].name or system.scene.forces[i].kind_name for i in numbers)
    return LoadPath(
        np.array([p.factor for p in points]),
        np.array([p.x[:count] for p in points]),
        np.array([p.negatives == 0 for p in points]),
        tuple(critical),
        message,
        names,
        scene.units,
    )


def _passed(points: list[Point], factor: float) -> bool:
    return (points[-2].factor - factor) * (points[-1].factor - factor) <= 0.0


def _checked(steps: int, increment: float, largest_factor: float | None, arc_length: float | None) -> None:
    if not (isinstance(steps, int) and 1 <= steps <= MOST):
        raise InputError("steps", f"{steps!r} given; a whole number from 1 to {MOST} is expected")
    if not (np.isfinite(increment) and increment != 0.0):
        raise InputError("increment", f"{increment!r} given; a load factor that is not 0 is expected")
    if largest_factor is not None and not (np.isfinite(largest_factor) and largest_factor * increment > 0.0):
        raise InputError("largest_factor", f"{largest_factor!r} given; a factor of the sign of increment is expected")
    if arc_length is not None and not (np.isfinite(arc_length) and arc_length > 0.0):
        raise InputError("arc_length", f"{arc_length!r} given; a length above 0 is expected")
