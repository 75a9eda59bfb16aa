"""Units of a scene: one consistent system, named so that every number can be shown with its unit."""

from __future__ import annotations

import re
from typing import Literal

from hookean.values.columns import Model
from hookean.values.fields import Field

METRES = {"mm": 1e-3, "cm": 1e-2, "dm": 0.1, "m": 1.0, "km": 1e3, "in": 0.0254, "ft": 0.3048, "yd": 0.9144}
NEWTONS = {"mN": 1e-3, "N": 1.0, "kN": 1e3, "MN": 1e6, "lbf": 4.4482216152605, "kip": 4448.2216152605}
SECONDS = {"ms": 1e-3, "s": 1.0, "min": 60.0}

Length = Literal["mm", "cm", "dm", "m", "km", "in", "ft", "yd"]
Force = Literal["mN", "N", "kN", "MN", "lbf", "kip"]
Time = Literal["ms", "s", "min"]


class Units(Model):
    """Length, force and time; the mass unit follows: force x time^2 / length (N, cm, s: 100 kg)."""

    length: Length = Field(default="m", description="Unit of lengths")
    force: Force = Field(default="N", description="Unit of forces")
    time: Time = Field(default="s", description="Unit of time")

    @property
    def mass(self) -> str:
        """The mass unit in words, such as `kg` or `100 kg`."""
        kilograms = NEWTONS[self.force] * SECONDS[self.time] ** 2 / METRES[self.length]
        return "kg" if abs(kilograms - 1.0) < 1e-12 else f"{kilograms:.9g} kg"

    def of(self, dimension: str) -> str:
        """The unit of a quantity: `length`, `force`, `time`, `mass`, `moment`, `energy`, `stiffness`, `angle`, and what
        is made of the first three, such as `length^2` and `force/length`."""
        derived = {
            "": "",
            "angle": "rad",
            "mass": self.mass,
            "moment": f"{self.force} {self.length}",
            "energy": f"{self.force} {self.length}",
            "stiffness": f"{self.force}/{self.length}",
        }
        if dimension in derived:
            return derived[dimension]
        return re.sub(r"\b(?:length|force|time|mass)\b", lambda word: str(getattr(self, word[0])), dimension)

    def factor(self, dimension: str, to: Units) -> float:
        """What a number of this dimension is multiplied by to be in the units `to`."""
        length = METRES[self.length] / METRES[to.length]
        force = NEWTONS[self.force] / NEWTONS[to.force]
        time = SECONDS[self.time] / SECONDS[to.time]
        return {
            "": 1.0,
            "angle": 1.0,
            "length": length,
            "force": force,
            "time": time,
            "mass": force * time**2 / length,
            "moment": force * length,
            "energy": force * length,
            "stiffness": force / length,
            "force/length": force / length,
            "force length": force * length,
            "force length^2": force * length**2,
            "force time/length": force * time / length,
            "length/time": length / time,
            "length^2": length**2,
            "force/length^2": force / length**2,
            "force/length^3": force / length**3,
        }[dimension]
