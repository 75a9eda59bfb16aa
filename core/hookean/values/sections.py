"""Cross-sections of bars, beams and cables: numbers, or a shape from which they follow."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal, Self

from pydantic import model_validator

from hookean.values.columns import Model, fault
from hookean.values.fields import Field

Shape = Literal["rod", "tube", "rectangle", "I", "rope"]

DIMENSIONS: dict[str, tuple[str, ...]] = {
    "rod": ("diameter",),
    "tube": ("diameter", "thickness"),
    "rectangle": ("width", "height"),
    "I": ("width", "height", "flange_thickness", "web_thickness"),
    "rope": ("diameter", "fill_factor"),
}
QUANTITIES = ("area", "Iy", "Iz", "J", "Wy", "Wz")


class Section(Model):
    """A cross-section by its numbers, or by its shape, in the plane of its axes y (across) and z (up).

    rod: full circle. tube: outer diameter and thickness of the wall. rectangle: width along y, height along z. I: width
    of both flanges, whole height, without fillets; J is that of thin open walls, sum b t^3 / 3. rope: area =
    fill factor x pi d^2 / 4; the wires slide past each other, so it has no bending stiffness. J of a rectangle is
    Saint-Venant's series. Wy = Iy / (height / 2), and so on. Source: Timoshenko and Goodier, Theory of Elasticity, 109.
    """

    shape: Shape | None = Field(default=None, description="Shape from which the numbers follow")
    diameter: float | None = Field(default=None, gt=0, description="Outer diameter [length]")
    thickness: float | None = Field(default=None, gt=0, description="Thickness of a tube's wall [length]")
    width: float | None = Field(default=None, gt=0, description="Width along y [length]")
    height: float | None = Field(default=None, gt=0, description="Height along z [length]")
    flange_thickness: float | None = Field(default=None, gt=0, description="Thickness of both flanges [length]")
    web_thickness: float | None = Field(default=None, gt=0, description="Thickness of the web [length]")
    fill_factor: float | None = Field(default=None, gt=0, le=1, description="Metal in the circle round a rope [-]")
    area: float | None = Field(default=None, gt=0, description="A [length^2]")
    Iy: float | None = Field(default=None, gt=0, description="Second moment of area, z^2 dA [length^4]")
    Iz: float | None = Field(default=None, gt=0, description="Second moment of area, y^2 dA [length^4]")
    J: float | None = Field(default=None, gt=0, description="Torsion constant [length^4]")
    Wy: float | None = Field(default=None, gt=0, description="Section modulus about y [length^3]")
    Wz: float | None = Field(default=None, gt=0, description="Section modulus about z [length^3]")

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        sizes = [name for name in dict.fromkeys(sum(DIMENSIONS.values(), ())) if getattr(self, name) is not None]
        given = [name for name in QUANTITIES if getattr(self, name) is not None]
        if self.shape is None:
            if sizes:
                raise fault(f"{sizes[0]} given without a shape; shapes: {', '.join(DIMENSIONS)}")
            if self.area is None:
                raise fault("give a shape and its dimensions, or the area and what else is known")
            return self
        wanted = DIMENSIONS[self.shape]
        other = next((name for name in (*sizes, *given) if name not in wanted), None)
        missing = next((name for name in wanted if name not in sizes), None)
        if other is not None or missing is not None:
            said = f"{other} given" if other is not None else f"{missing} is missing"
            raise fault(f"{said}; the shape {self.shape} needs {' and '.join(wanted)}, and nothing else")
        self._fits()
        return self

    def _fits(self) -> None:
        """A fault where walls are thicker than there is room for."""
        if self.shape == "tube" and 2.0 * float(self.thickness or 0) > float(self.diameter or 0):
            raise fault(f"{self.thickness:g} given; at most half of the diameter allowed", "/thickness")
        if self.shape == "I":
            if 2.0 * float(self.flange_thickness or 0) >= float(self.height or 0):
                raise fault(
                    f"{self.flange_thickness:g} given; less than half of the height allowed", "/flange_thickness"
                )
            if float(self.web_thickness or 0) > float(self.width or 0):
                raise fault(f"{self.web_thickness:g} given; at most the width allowed", "/web_thickness")

    @property
    def properties(self) -> dict[str, float]:
        """Of `area`, `Iy`, `Iz`, `J`, `Wy` and `Wz` those that it has, in powers of [length]."""
        if self.shape is None:
            return {name: value for name in QUANTITIES if (value := getattr(self, name)) is not None}
        sizes = [float(getattr(self, name)) for name in DIMENSIONS[self.shape]]
        return _DERIVED[self.shape](*sizes)


def _rod(diameter: float) -> dict[str, float]:
    return _tube(diameter, 0.5 * diameter)


def _tube(diameter: float, thickness: float) -> dict[str, float]:
    inner = max(diameter - 2.0 * thickness, 0.0)
    second = math.pi / 64.0 * (diameter**4 - inner**4)
    modulus = second / (0.5 * diameter)
    area = math.pi * thickness * (diameter - thickness)
    return {"area": area, "Iy": second, "Iz": second, "J": 2.0 * second, "Wy": modulus, "Wz": modulus}


def _rectangle(width: float, height: float) -> dict[str, float]:
    return {
        "area": width * height,
        "Iy": width * height**3 / 12.0,
        "Iz": height * width**3 / 12.0,
        "J": _torsion(max(width, height), min(width, height)),
        "Wy": width * height**2 / 6.0,
        "Wz": height * width**2 / 6.0,
    }


def _torsion(long: float, short: float) -> float:
    """J of a rectangle: a b^3 (1/3 - 64 b / (pi^5 a) sum over odd n of tanh(n pi a / 2b) / n^5)."""
    terms = (math.tanh(0.5 * n * math.pi * long / short) / n**5 for n in range(199, 0, -2))  # the least first
    return long * short**3 * (1.0 / 3.0 - 64.0 / math.pi**5 * short / long * sum(terms))


def _i(width: float, height: float, flange: float, web: float) -> dict[str, float]:
    inside = height - 2.0 * flange
    along = (width * height**3 - (width - web) * inside**3) / 12.0
    across = (2.0 * flange * width**3 + inside * web**3) / 12.0
    return {
        "area": 2.0 * width * flange + inside * web,
        "Iy": along,
        "Iz": across,
        "J": (2.0 * width * flange**3 + inside * web**3) / 3.0,
        "Wy": along / (0.5 * height),
        "Wz": across / (0.5 * width),
    }


def _rope(diameter: float, fill_factor: float) -> dict[str, float]:
    return {"area": fill_factor * math.pi * diameter**2 / 4.0}


_DERIVED: dict[str, Callable[..., dict[str, float]]] = {
    "rod": _rod,
    "tube": _tube,
    "rectangle": _rectangle,
    "I": _i,
    "rope": _rope,
}
