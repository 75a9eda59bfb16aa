"""Load cases, their combinations, and the stages from a form to them, as a scene describes them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

from pydantic import model_validator

from hookean.forces import KINDS
from hookean.forces.cloth import one_way
from hookean.values.columns import LARGEST, Directions, Lines, Model, Positives, fault
from hookean.values.fields import Field, Maybe, Named

if TYPE_CHECKING:
    from hookean.scene.scene import Scene

IDLE = "loads that do not act"  # the name of those of other cases in the scene of one
PRESTRESS, PERMANENT = "prestress", "permanent"
"""Names in combinations: what the form is stressed by, and the loads that are in no case."""
LINES = ("springs", "constant_tension")
"""Kinds along lines that freeze into elastic ones, and so have changes of temperature."""
HEATED = (*LINES, "beam", "membrane", "soapfilm")
"""Kinds that have changes of temperature in load cases: where they are elastic when the form is frozen."""


class LoadCase(Model):
    """Loads that act together, by their names (or kinds), and changes of temperature. They do not act while the form is
    found."""

    forces: tuple[str, ...] = Field(default=(), description="Names (or kinds) of loads")
    temperature: dict[str, float] = Field(
        default={}, description="Change of temperature [K] by the name (or kind) of springs, beams, membranes"
    )
    factor: float = Field(default=1.0, ge=-1e12, le=1e12, description="Factor on these loads and changes [-]")

    @model_validator(mode="after")
    def _some(self) -> LoadCase:
        if not self.forces and not self.temperature:
            raise fault("neither forces nor temperature given; give at least one of them")
        return self


class ElasticLine(Model):
    """What a force along lines becomes when the form is frozen: elastic, with the tension that it has there."""

    axial_stiffness: Maybe[Positives] = Field(
        default=None, description="EA [force], one or one for each element; default: stiffness x rest length"
    )
    material: str | None = Field(default=None, description="Name of a material, with a section in the place of EA")
    section: str | None = Field(
        default=None, description="Name of a section: with a material in the place of EA, or beside EA for the stress"
    )
    strength: Maybe[Positives] = Field(
        default=None, description="Breaking force, for the utilisation [force]; default: that of material and section"
    )
    tension_only: bool = Field(default=False, description="Whether it goes slack instead of into compression")

    @model_validator(mode="after")
    def _one_way(self) -> ElasticLine:
        if self.material is not None and self.section is None:
            raise fault("material given without a section; give both, or axial_stiffness", "/material")
        if self.material is not None and self.axial_stiffness is not None:
            raise fault("axial_stiffness and material given; give one of them", "/axial_stiffness")
        return self


class ElasticCloth(Model):
    """The cloth that a film becomes when the form is frozen: made in the shape and with the stress that it has there.

    The fields are those of a membrane.
    """

    material: str | None = Field(default=None, description="Name of a cloth, or of a solid with `thickness`")
    thickness: float | None = Field(default=None, gt=0, le=1e12, description="Thickness of a solid material [length]")
    warp_stiffness: float | None = Field(default=None, gt=0, le=1e12, description="Ew per width [force/length]")
    weft_stiffness: float | None = Field(
        default=None, gt=0, le=1e12, description="Ef per width [force/length]; default: that of the warp"
    )
    shear_stiffness: float | None = Field(
        default=None, gt=0, le=1e12, description="G per width [force/length]; default: that of an isotropic sheet"
    )
    poisson: float | None = Field(
        default=None, gt=-10, lt=10, description="nu, contraction along the weft by tension along the warp [-]; or 0"
    )
    warp: Maybe[Directions] = Field(
        default=None, description="Direction of the warp, one or one for each face; default: the yarns or mesh rows"
    )
    warp_lines: Maybe[Lines] = Field(default=None, description="Lines along which the warp runs: the nearest counts")
    wrinkling: bool = Field(default=False, description="Whether compression makes wrinkles, at no cost")

    @model_validator(mode="after")
    def _given(self) -> ElasticCloth:
        one_way(self)
        return self


class Stages(Model):
    """How a scene gets from its form to its load cases."""

    form: Literal["find", "drawn"] = Field(
        default="find", description="find: relax the scene to find the form; drawn: the start shape is the form"
    )
    freeze: Named[ElasticLine] = Field(default={}, description="By a force's name (or kind), its elastic properties")
    films: Named[ElasticCloth] = Field(default={}, description="By a film's name (or kind), the cloth that it becomes")


def named(scene: Scene, name: str) -> list[int]:
    """The numbers of the forces of a name, or else of a kind."""
    own = [i for i, force in enumerate(scene.forces) if force.name == name]
    return own or [i for i, force in enumerate(scene.forces) if force.kind_name == name]


def case_loads(scene: Scene) -> frozenset[int]:
    """The numbers of the loads that are in load cases."""
    names = (name for case in scene.load_cases.values() for name in case.forces)
    return frozenset(i for name in names for i in named(scene, name))


def asleep(scene: Scene) -> list[str]:
    """The names of the loads that are in load cases, which do not act by themselves, each once."""
    found = (scene.forces[i] for i in sorted(case_loads(scene)))
    return list(dict.fromkeys(force.name or force.kind_name for force in found if force.name != IDLE))


def check(scene: Scene) -> None:
    """Raise the fault of a load case, combination or stage that names what is not there."""
    loads = [f.name or f.kind_name for f in scene.forces if KINDS[f.kind_name].role == "load"]
    for name, case in scene.load_cases.items():
        pointer = f"/load_cases/{_escaped(name)}"
        if name in (PRESTRESS, PERMANENT):
            raise fault(f"{name} is a reserved name in combinations; choose another name for the case", pointer)
        for i, load in enumerate(case.forces):
            found = named(scene, load)
            if not found:
                raise fault(f"no load is called {load!r}; {_listed(loads)}", f"{pointer}/forces/{i}")
            if any(KINDS[scene.forces[number].kind_name].role != "load" for number in found):
                raise fault(f"{load!r} is not a load; {_listed(loads)}", f"{pointer}/forces/{i}")
        by = dict[int, str]()
        heated = [f.name or f.kind_name for f in scene.forces if f.kind_name in HEATED]
        for line in case.temperature:
            found = named(scene, line)
            if not found or any(scene.forces[number].kind_name not in HEATED for number in found):
                said = f"{line!r} names no springs, lines of constant tension, beams or membranes; {_listed(heated)}"
                raise fault(said, f"{pointer}/temperature/{_escaped(line)}")
            if twice := next((by[number] for number in found if by.setdefault(number, line) != line), ""):
                said = f"{line!r} and {twice!r} name the same force; give one change of temperature for it"
                raise fault(said, f"{pointer}/temperature/{_escaped(line)}")
    for name, factors in scene.combinations.items():
        _check_combination(scene, name, factors)
    for name in scene.stages.freeze if scene.stages is not None else ():
        if not named(scene, name):
            known = [f.name or f.kind_name for f in scene.forces]
            raise fault(f"no force is called {name!r}; {_listed(known)}", f"/stages/freeze/{_escaped(name)}")
        if not any(scene.forces[number].kind_name in LINES for number in named(scene, name)):
            known = [f.name or f.kind_name for f in scene.forces if f.kind_name in LINES]
            said = f"{name!r} names no springs or lines of constant tension; {_listed(known)}"
            raise fault(said, f"/stages/freeze/{_escaped(name)}")
    films = [f.name or f.kind_name for f in scene.forces if KINDS[f.kind_name].is_film]
    for name in scene.stages.films if scene.stages is not None else ():
        found = named(scene, name)
        if not found or any(not KINDS[scene.forces[number].kind_name].is_film for number in found):
            raise fault(f"no film is called {name!r}; {_listed(films)}", f"/stages/films/{_escaped(name)}")


def _check_combination(scene: Scene, name: str, factors: Mapping[str, Any]) -> None:
    pointer = f"/combinations/{_escaped(name)}"
    for key, factor in factors.items():
        if not abs(factor) <= LARGEST:
            raise fault(f"{factor:g} is larger than the limit, {LARGEST:g}", f"{pointer}/{_escaped(key)}")
    if name in scene.load_cases:
        raise fault("a load case has this name, too; rename one of them", pointer)
    for key in factors:
        if key not in scene.load_cases and key not in (PRESTRESS, PERMANENT):
            known = ", ".join([*scene.load_cases, PRESTRESS, PERMANENT])
            raise fault(f"no load case is called {key!r}; known: {known}", f"{pointer}/{_escaped(key)}")


def _listed(names: list[str]) -> str:
    return f"the scene has {', '.join(dict.fromkeys(names)) or 'none'}"


def _escaped(name: str) -> str:
    return name.replace("~", "~0").replace("/", "~1")
