"""Materials: solids by modulus and density, cloths by stiffnesses per width; and a table of known ones."""

from __future__ import annotations

import difflib
from typing import Self

from pydantic import model_validator

from hookean.errors import InputError
from hookean.values.columns import Model, fault
from hookean.values.fields import Field
from hookean.values.units import METRES, NEWTONS, SECONDS, Units

CLOTH = ("warp_stiffness", "weft_stiffness", "shear_stiffness", "warp_strength", "weft_strength", "area_density")
SOLID = ("E", "G", "density", "strength")
STIFFEST, HEAVIEST = 2e12, 25e3  # above diamond [N/m^2] and osmium [kg/m^3]: no material is


class Material(Model):
    """A solid, by its modulus E, or a cloth, by its stiffness per width along warp and weft; in the scene's units.

    Mass has the unit force time^2 / length. Poisson's ratio of a solid follows from E = 2 G (1 + nu) if G is given,
    and G from it; that of a cloth is the contraction along the weft by tension along the warp.
    """

    E: float | None = Field(default=None, gt=0, description="Young's modulus [force/length^2]")
    G: float | None = Field(default=None, gt=0, description="Shear modulus [force/length^2]")
    poisson: float | None = Field(default=None, gt=-10, lt=10, description="Poisson's ratio [-]")
    density: float | None = Field(default=None, ge=0, description="Mass per volume [mass/length^3]")
    strength: float | None = Field(
        default=None, gt=0, description="Stress that it bears: yield, or breaking [force/length^2]"
    )
    expansion: float | None = Field(default=None, gt=-1, lt=1, description="Thermal expansion [1/K]")
    warp_stiffness: float | None = Field(default=None, gt=0, description="Of a cloth, per width [force/length]")
    weft_stiffness: float | None = Field(
        default=None, gt=0, description="Of a cloth, per width [force/length]; default: that of the warp"
    )
    shear_stiffness: float | None = Field(
        default=None, gt=0, description="Of a cloth, per width [force/length]; default: as if isotropic"
    )
    warp_strength: float | None = Field(default=None, gt=0, description="Of a cloth, per width [force/length]")
    weft_strength: float | None = Field(default=None, gt=0, description="Of a cloth, per width [force/length]")
    area_density: float | None = Field(default=None, ge=0, description="Mass per area of a cloth [mass/length^2]")

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        cloth = [name for name in CLOTH if getattr(self, name) is not None]
        solid = [name for name in SOLID if getattr(self, name) is not None]
        if cloth and solid:
            raise fault(f"{solid[0]} and {cloth[0]} given; a material is either a solid, with E, or a cloth")
        if cloth and self.warp_stiffness is None:
            raise fault(f"{cloth[0]} given without warp_stiffness; a cloth needs it")
        if not cloth and self.E is None:
            raise fault("give E, or the warp_stiffness of a cloth")
        if cloth and self.poisson is not None:
            weft = self.weft_stiffness or self.warp_stiffness
            if not self.poisson**2 * float(weft or 0) < float(self.warp_stiffness or 0):
                raise fault(
                    f"{self.poisson:g} given; its square must be below warp_stiffness / weft_stiffness", "/poisson"
                )
        if solid and self.poisson is not None:
            if not -1.0 < self.poisson <= 0.5:
                raise fault(f"{self.poisson:g} given; more than -1 and at most 0.5 allowed", "/poisson")
            if self.G is not None:
                raise fault(
                    "G and poisson given; give one of them, the other follows from E = 2 G (1 + nu)", "/poisson"
                )
        return self

    def modulus(self, name: str) -> float:
        """E [force/length^2]; InputError if the material, which the sentence calls `name`, has none."""
        if self.E is None:
            raise InputError("", f"{name} is a cloth, which has no modulus E; give a solid material")
        return self.E

    def shear_modulus(self, name: str) -> float:
        """G [force/length^2]; InputError if it is not known."""
        if self.G is not None:
            return self.G
        if self.poisson is None:
            raise InputError("", f"{name} has neither G nor Poisson's ratio; give one of them")
        return self.modulus(name) / (2.0 * (1.0 + self.poisson))

    def contraction(self, name: str) -> float:
        """Poisson's ratio of a solid [-]; InputError if it is not known."""
        if self.poisson is not None:
            return self.poisson
        if self.G is None:
            raise InputError("", f"{name} has neither Poisson's ratio nor G; give one of them")
        found = self.modulus(name) / (2.0 * self.G) - 1.0
        if not -1.0 < found <= 0.5:
            raise InputError("", f"{name} is not isotropic: E / 2G - 1 is {found:.3g}; give Poisson's ratio")
        return found

    def doubts(self, units: Units) -> dict[str, str]:
        """Sentences, by the field, on a modulus or a density that no material has: its unit is another one."""
        metre, newton = METRES[units.length], NEWTONS[units.force]
        mass = newton * SECONDS[units.time] ** 2 / metre  # [kg]
        found = {}
        if self.E is not None and self.E * newton / metre**2 > STIFFEST:
            pressure = f"{units.force}/{units.length}^2"
            found["E"] = (
                f"{self.E:g} given, which is {self.E * newton / metre**2:.3g} N/m^2, more than any material has; give "
                f"it in {pressure}"
            )
        if self.density is not None and self.density * mass / metre**3 > HEAVIEST:
            found["density"] = (
                f"{self.density:g} given, which is {self.density * mass / metre**3:.3g} kg/m^3, more than any material "
                f"has; give it per {units.length}^3 in units of {mass:g} kg, as {units.force}, {units.length} and "
                f"{units.time} make it"
            )
        return found

    def mass_density(self, name: str) -> float:
        """Mass per volume [mass/length^3]; InputError if it is not known."""
        if self.density is None:
            raise InputError("", f"{name} has no density; give it")
        return self.density


def _solid(E: float, G: float, density: float, strength: float, expansion: float) -> Material:
    return Material(E=E, G=G, density=density, strength=strength, expansion=expansion)


def _cloth(stiff: tuple[float, float, float, float], strength: tuple[float, float], area_density: float) -> Material:
    warp, weft, shear, poisson = stiff
    return Material(
        warp_stiffness=warp, weft_stiffness=weft, shear_stiffness=shear, poisson=poisson, warp_strength=strength[0],
        weft_strength=strength[1], area_density=area_density,
    )  # fmt: skip


def known() -> dict[str, Material]:
    """Materials that a scene can name without giving them, in N, m and kg; docs/materials.md has their sources."""
    if not _KNOWN:
        _KNOWN.update(
            {
                "S235": _solid(210e9, 81e9, 7850, 235e6, 12e-6),
                "S355": _solid(210e9, 81e9, 7850, 355e6, 12e-6),
                "cable 1570": _solid(160e9, 61.5e9, 7850, 1570e6, 12e-6),
                "cable 1770": _solid(160e9, 61.5e9, 7850, 1770e6, 12e-6),
                "spiral strand 1570": _solid(150e9, 57.7e9, 7850, 1570e6, 12e-6),
                "spiral strand 1770": _solid(150e9, 57.7e9, 7850, 1770e6, 12e-6),
                "stainless spiral strand 1450": _solid(130e9, 50e9, 7900, 1450e6, 16e-6),
                "GL24h": _solid(11.5e9, 650e6, 420, 24e6, 5e-6),
                "aluminium": _solid(70e9, 27e9, 2700, 250e6, 23e-6),
                "GFRP": _solid(23e9, 3e9, 1800, 240e6, 10e-6),
                "PVC-polyester I": _cloth((600e3, 450e3, 10e3, 0.3), (60e3, 60e3), 0.75),
                "PVC-polyester II": _cloth((800e3, 600e3, 12e3, 0.3), (88e3, 79e3), 0.90),
                "PVC-polyester III": _cloth((1000e3, 800e3, 15e3, 0.3), (115e3, 102e3), 1.05),
                "PVC-polyester IV": _cloth((1300e3, 1000e3, 20e3, 0.3), (149e3, 128e3), 1.30),
                "PVC-polyester V": _cloth((1600e3, 1300e3, 25e3, 0.3), (196e3, 166e3), 1.45),
                "PTFE-glass": _cloth((1200e3, 900e3, 60e3, 0.8), (140e3, 120e3), 1.15),
            }
        )
    return _KNOWN


_KNOWN: dict[str, Material] = {}


def find(name: str, own: dict[str, Material], units: Units) -> Material:
    """The scene's own material of a name, or the known one in the scene's units; InputError for an unknown name."""
    if name in own:
        return own[name]
    if name not in known():
        raise InputError("", unknown(name, own))
    return converted(known()[name], units)


def unknown(name: str, own: dict[str, Material]) -> str:
    """The sentence about a name that no material has."""
    names = [*own, *known()]
    near = difflib.get_close_matches(name.lower(), {n.lower(): n for n in names}, 1)
    meant = next((n for n in names if near and n.lower() == near[0]), "")
    listed = f"the scene has {', '.join(own) or 'none'}, and known are {', '.join(known())}"
    return f'material "{name}" does not exist; {f"did you mean {meant}? " if meant else ""}{listed}'


def converted(material: Material, units: Units) -> Material:
    """A material in N, m, s and kg in other units."""
    force, length, time = NEWTONS[units.force], METRES[units.length], SECONDS[units.time]
    mass = force * time**2 / length
    factors = {
        "E": length**2 / force, "G": length**2 / force, "strength": length**2 / force,
        "density": length**3 / mass, "area_density": length**2 / mass,
        **dict.fromkeys(("warp_stiffness", "weft_stiffness", "shear_stiffness"), length / force),
        **dict.fromkeys(("warp_strength", "weft_strength"), length / force),
    }  # fmt: skip
    given = {name: getattr(material, name) for name in material.model_fields_set}
    return Material(**{n: v if v is None else v * factors.get(n, 1.0) for n, v in given.items()})


def gravity(units: Units) -> float:
    """Standard gravity, 9.80665 m/s^2, in [length/time^2]."""
    return 9.80665 * SECONDS[units.time] ** 2 / METRES[units.length]
