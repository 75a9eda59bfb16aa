"""What a design problem is answered with: the best values, and how they stand to goals, constraints and bounds."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.running.result import Result, plain
from hookean.scene.scene import Scene

Floats = NDArray[np.float64]


class DesignStatus(StrEnum):
    """How a search ended."""

    CONVERGED = "converged"
    INFEASIBLE = "infeasible"
    UNBOUNDED = "unbounded"
    MAX_ITERATIONS = "max_iterations"
    STALLED = "stalled"
    CANCELLED = "cancelled"


@dataclass(repr=False)
class Design:
    """The best that a search found: values of `variables`, of `goals` and `constraints`, and the `result` of the scene
    with them. The objective is the sum of weight (value - target)² over goals with a target and of weight x value over
    the others.

    `gain` of a variable or constraint is the rate at which the objective falls as the bound or limit that it is at
    gives way by 1, in its unit; `gains` of a goal that is not met are its own parts of them by name, `conflicts` the
    names of goals that pull against it. They are None or empty where the constraints are not met."""

    status: DesignStatus
    message: str
    objective: float
    iterations: int
    method: str
    variables: list[dict[str, Any]]
    goals: list[dict[str, Any]]
    constraints: list[dict[str, Any]]
    result: Result
    scene: Scene
    warnings: list[str] = field(default_factory=list)

    def __repr__(self) -> str:
        lines = [f"Design: {self.status}. {self.message}"]
        lines += [f"  {entry['name']}: {shown(entry['value'])}" for entry in self.variables]
        lines += [
            f"  goal {entry['name']}: {shown(entry['value'])}, target {shown(entry['target'])}" for entry in self.goals
        ]
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        return {
            "status": str(self.status),
            "message": self.message,
            "objective": self.objective,
            "iterations": self.iterations,
            "method": self.method,
            "variables": plain(self.variables),
            "goals": plain(self.goals),
            "constraints": plain(self.constraints),
            "warnings": self.warnings,
            "result": self.result.to_dict(),
            "scene": self.scene.model_dump(mode="json"),
        }


def shown(value: Any) -> str:
    """A few numbers as text, how many there are where these are not all."""
    flat = np.atleast_1d(np.asarray(np.nan if value is None else value, dtype=np.float64)).ravel()
    shown = ", ".join(f"{v:.4g}" for v in flat[:6])
    return shown if len(flat) <= 6 else f"{shown}, ... ({len(flat)})"
