"""What a design problem is answered with: the best values, and how they stand to goals, constraints and bounds."""

from __future__ import annotations

from collections.abc import Iterable
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
        return "\n".join([f"Design: {self.status}. {self.message}", *(f"  {line}" for line in self.lines())])

    def lines(self) -> list[str]:
        """A line for a person on each variable, goal and constraint."""

        def told(entry: dict[str, Any], value: Any) -> str:
            return f"{shown(value)} {self.result.units.of(entry['unit'])}".rstrip()

        found = []
        for entry in self.variables:
            bound = " (at a bound)" if np.any(entry["at_bound"]) else ""
            found.append(f"{entry['name']}: {told(entry, entry['value'])}{bound}")
        for entry in self.goals:
            target = "minimised" if entry["target"] is None else f"target {told(entry, entry['target'])}"
            found.append(f"goal {entry['name']}: {told(entry, entry['value'])}, {target}")
        for entry in self.constraints:
            met = "met" if entry["met"] else "not met"
            found.append(f"constraint {entry['name']}: {told(entry, entry['value'])}, {met}")
        return found

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
    flat = np.atleast_1d(np.asarray(value, dtype=np.float64)).ravel()
    shown = ", ".join(f"{v:.4g}" for v in flat[:6])
    return shown if len(flat) <= 6 else f"{shown}, ... ({len(flat)})"


def once(names: Iterable[str]) -> list[str]:
    """The names, with a number behind those that occurred before."""
    found: list[str] = []
    for name in names:
        number = 2
        title = name
        while title in found:
            title, number = f"{name} {number}", number + 1
        found.append(title)
    return found
