"""A design problem: a scene, what in it may vary, and what its equilibrium should be like.

    problem = Problem(
        scene=scene,
        variables=[{"force": "cable", "field": "rest_length", "tie": "all", "lower": 0.1}],
        goals=[{"kind": "position", "particles": [5], "axes": "z", "target": -2.0}],
    )

It is the same in Python, JSON and TOML.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import StrictInt, StrictStr, model_validator

from hookean.designing.located import located
from hookean.designing.quantities import QUANTITIES
from hookean.designing.quantities.base import Quantity
from hookean.scene.scene import Scene
from hookean.scene.text import parse
from hookean.values.by_kind import ByKind
from hookean.values.columns import Indices, Model, Reals, Table, fault
from hookean.values.fields import Field, Maybe, Part, Parts

if TYPE_CHECKING:
    AnyQuantity = Quantity
else:
    AnyQuantity = Annotated[Quantity, ByKind(QUANTITIES)]

Axes = Literal["x", "y", "z", "xy", "xz", "yz", "xyz"]
PARTICLES = ("drawn", "mass")
METHODS = ("auto", "least_squares", "levenberg_marquardt", "l-bfgs-b", "slsqp", "augmented_lagrangian")


class Drive(Model):
    """A column of a force that follows a variable: factor x the variable's value, element by element."""

    force: StrictStr | StrictInt = Field(description="Name or number of a force")
    field: str = Field(description="Column of the force")
    factor: float = Field(default=1.0, description="Factor on the value [unit of the column by that of the variable]")

    @model_validator(mode="after")
    def _some_factor(self) -> Self:
        if self.factor == 0.0:
            raise fault("0 given; give a factor that is not 0, or leave the column out", "/factor")
        return self


class Variable(Model):
    """What may vary: a column of a force, where an anchor holds its particles, or where particles are drawn, from which
    rest lengths and angles are measured, and their mass. Values have the scene's units.

    `tie` makes one unknown of all elements (`all`), of each list of elements, or one of each element (`each`); elements
    in no list keep their values. What is tied of an anchor or a drawn form moves as a whole: its value is the shift.
    What a variable `drives` follows it: the area of a bar its stiffness, with E as factor, and its weight.
    """

    name: str = Field(default="", description="Name in the answer; default: what varies")
    force: StrictStr | StrictInt | None = Field(default=None, description="Name or number of a force")
    field: str = Field(
        default="", description="Column of the force; of particles `drawn` (where they are drawn) or `mass`"
    )
    anchor: StrictStr | StrictInt | None = Field(default=None, description="Name or number of an anchor")
    particles: Indices = Field(
        default=np.zeros(0, np.int64), description="Particles whose drawn position or mass varies, by `field`"
    )
    axes: Axes = Field(default="xyz", description="Axes that vary: of an anchor, a drawn position, a column of vectors")
    tie: Literal["each", "all"] | tuple[Indices, ...] = Field(
        default="each", description="Which elements have one value: each its own, all, or lists of elements"
    )
    lower: float | None = Field(default=None, description="Least value [unit of the column]")
    upper: float | None = Field(default=None, description="Largest value [unit of the column]")
    drives: Parts[Drive] = Field(default=(), description="Columns of forces that follow it, each by a factor")

    @model_validator(mode="after")
    def _one_thing(self) -> Self:
        if (self.force is not None) + (self.anchor is not None) + (len(self.particles) > 0) != 1:
            raise fault("give exactly one of force, anchor, particles")
        if len(self.particles) and self.field not in PARTICLES:
            raise fault(f"of particles {' or '.join(PARTICLES)} varies; give one of them as field", "/field")
        if len(self.particles) and self.drives:
            raise fault("particles drive no columns", "/drives")
        if self.force is not None and not self.field:
            raise fault("a variable of a force needs a field, the name of a column", "/field")
        if self.anchor is not None and self.field:
            raise fault("an anchor has no field that varies; give axes", "/field")
        if self.anchor is not None and self.drives:
            raise fault("an anchor drives no columns", "/drives")
        if not len(self.tie):
            raise fault("an empty list given; give lists of elements, or each or all", "/tie")
        if self.lower is not None and self.upper is not None and self.lower > self.upper:
            raise fault(f"lower is {self.lower:g}, more than upper, {self.upper:g}", "/lower")
        return self

    @property
    def title(self) -> str:
        """The name, or what varies."""
        if self.name:
            return self.name
        if len(self.particles):
            return "drawn position" if self.field == "drawn" else "mass"
        return f"{self.force}.{self.field}" if self.force is not None else f"anchor {self.anchor}"


class Goal(Model):
    """What the equilibrium should be like: a quantity and its target, or the range in which it should be; without them
    the quantity is minimised.

    The objective is the sum of weight (value - target)² over all values of goals with a target, and of weight x value
    over those of goals without. The target of a range is the value itself within it, and the nearest limit without.
    """

    quantity: AnyQuantity
    target: Maybe[Table] = Field(default=None, description="Target, one or one for each value [unit of the quantity]")
    lower: Maybe[Reals] = Field(default=None, description="Least value of a range [unit of the quantity]")
    upper: Maybe[Reals] = Field(default=None, description="Largest value of a range [unit of the quantity]")
    weight: float = Field(default=1.0, ge=1e-50, le=1e50, description="Weight in the objective [-]")
    name: str = Field(default="", description="Name in the answer; default: the kind")

    @model_validator(mode="before")
    @classmethod
    def _flat(cls, value: Any) -> Any:
        return _split(value, ("target", "lower", "upper", "weight", "name"))

    @model_validator(mode="after")
    def _one_aim(self) -> Self:
        if self.target is not None and not (self.lower is None and self.upper is None):
            raise fault("give a target or a range from lower to upper, not both", "/target")
        return self

    @property
    def aimed(self) -> bool:
        """Whether it has a target or a range."""
        return not (self.target is None and self.lower is None and self.upper is None)


class Constraint(Model):
    """What the equilibrium must be like: each value of a quantity at least `lower` and at most `upper`; equal: both."""

    quantity: AnyQuantity
    lower: Maybe[Reals] = Field(default=None, description="Least value, one or one for each [unit of the quantity]")
    upper: Maybe[Reals] = Field(default=None, description="Largest value, one or one for each [unit of the quantity]")
    name: str = Field(default="", description="Name in the answer; default: the kind")

    @model_validator(mode="before")
    @classmethod
    def _flat(cls, value: Any) -> Any:
        return _split(value, ("lower", "upper", "name"))

    @model_validator(mode="after")
    def _some_limit(self) -> Self:
        if self.lower is None and self.upper is None:
            raise fault("a constraint needs lower, upper or both")
        return self


def _split(value: Any, own: tuple[str, ...]) -> Any:
    """The fields of a quantity beside those of a goal or constraint, as one part."""
    if not isinstance(value, Mapping) or "quantity" in value:
        return value
    mine = {name: value[name] for name in own if name in value}
    return {**mine, "quantity": {name: item for name, item in value.items() if name not in own}}


class DesignSettings(Model):
    """How to search. `auto` takes least squares where all goals have targets and nothing is constrained (of many
    unknowns and values by Levenberg and Marquardt, sparse), L-BFGS-B without targets, SLSQP with constraints, an
    augmented Lagrangian with many values of these."""

    called: ClassVar[str] = "settings"

    method: Literal[METHODS] = Field(default="auto", description="Method; auto selects one and reports which")  # type: ignore[valid-type]
    tolerance: float = Field(default=1e-8, gt=0, le=1, description="Relative change at which the search ends [-]")
    max_iterations: int = Field(default=200, ge=1, le=10**6, description="Largest number of iterations")


class Problem(Model):
    """A scene with variables, goals and constraints."""

    scene: Part[Scene] = Field(description="The scene; its values are the start")
    variables: Parts[Variable] = Field(description="What may vary")
    goals: Parts[Goal] = Field(default=(), description="What the equilibrium should be like")
    constraints: Parts[Constraint] = Field(default=(), description="What it must be like")
    settings: Part[DesignSettings] = Field(default=DesignSettings(), description="How to search")

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.variables:
            raise fault("a problem needs at least one variable", "/variables")
        if not self.goals and not self.constraints:
            raise fault("a problem needs at least one goal or constraint", "/goals")
        return self

    @classmethod
    def read(cls, value: Any) -> Self:
        """A problem from a dict, or from JSON text or bytes; InputError with a pointer and one sentence."""
        return super().read(located(parse(value) if isinstance(value, str | bytes | bytearray) else value))
