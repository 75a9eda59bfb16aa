"""Materials and sections of members in IFC files: profiles by their shapes, materials by their names."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hookean.files.exchange.structure import Lines, Structure
from hookean.values.sections import Section

Make = Callable[..., Any]

PROFILES = {
    "rod": ("IfcCircleProfileDef", {"Radius": 0.5}, ("diameter",)),
    "tube": ("IfcCircleHollowProfileDef", {"Radius": 0.5, "WallThickness": 1.0}, ("diameter", "thickness")),
    "rectangle": ("IfcRectangleProfileDef", {"XDim": 1.0, "YDim": 1.0}, ("width", "height")),
    "I": (
        "IfcIShapeProfileDef",
        {"OverallWidth": 1.0, "OverallDepth": 1.0, "FlangeThickness": 1.0, "WebThickness": 1.0},
        ("width", "height", "flange_thickness", "web_thickness"),
    ),
}
"""The profile of a shape, and its dimensions as parts of those of the section, in the same order."""
PLAIN = "IfcProfileDef"  # of a rope, or of a section that is given by its numbers


class Made:
    """What the members of a file are made of; each pair of material and section is written once."""

    def __init__(self, structure: Structure, make: Make) -> None:
        self.structure, self.make = structure, make
        self.materials: dict[str, Any] = {}
        self.sets: dict[tuple[str, str], Any] = {}

    def of(self, group: Lines) -> Any:
        """The material and the profile of the elements of a force, as IFC has these; None where none is named."""
        material, section = group.made_of
        if not (material or section):
            return None
        if material and material not in self.materials:
            self.materials[material] = self.make("IfcMaterial", Name=material)
        if not section:
            return self.materials[material]
        if group.made_of not in self.sets:
            own = self.materials.get(material)
            profile = self._profile(section, self.structure.sections[section])
            one = self.make("IfcMaterialProfile", Name=section, Material=own, Profile=profile)
            self.sets[group.made_of] = self.make("IfcMaterialProfileSet", Name=section, MaterialProfiles=[one])
        return self.sets[group.made_of]

    def _profile(self, name: str, section: Section) -> Any:
        kind, parts, sizes = PROFILES.get(section.shape or "", (PLAIN, {}, ()))
        given = {part: scale * getattr(section, size) for (part, scale), size in zip(parts.items(), sizes, strict=True)}
        if section.shape == "tube" and section.diameter == 2.0 * (section.thickness or 0.0):
            kind = PROFILES["rod"][0]  # a wall as thick as the radius leaves no hole
            given.pop("WallThickness")
        return self.make(kind, ProfileType="AREA", ProfileName=name, **given)
