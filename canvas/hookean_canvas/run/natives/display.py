"""Natives that only show or colour, or set how Rhino meshes: they have no effect, and what they feed gets no data."""

from __future__ import annotations

from uuid import UUID

from hookean_canvas.archive import guids

INERT: dict[UUID, str] = {
    UUID(guid): name
    for guid, name in (
        line.split(" ", 1)
        for line in """
537b0419-bbc2-4ff4-bf08-afe526367b2c Custom Preview
76975309-75a6-446a-afed-f8653720a9f2 Create Material
6da9f120-3ad0-4b6e-9fe0-f8cde3a649b7 Gradient
2a3f7078-2e25-4dd4-96f7-0efb491bd61c Vector Display
11e95a7b-1e2c-4b66-bd95-fcad51f8662a Vector Display Ex
3b220754-4114-4170-b6c3-b286b86ed524 Text Tag
5a41528b-12b9-40dc-a3f2-842034d267c4 Text Tag 3D
4a0180e5-d8f9-46e7-bd34-ced804601462 Settings (Custom)
1b0ee096-cc76-4847-8941-04a9e256de76 Settings (Quality)
255ca3e9-2c1e-443a-a404-e76b5c63f4cb Settings (Speed)
6b1bd8b2-47a4-4aa6-a471-3fd91c62a486 Dot Display
cc14daa5-911a-4fcc-8b3b-1149bf7f2eeb Point List
1f18e802-4ab9-444f-bf3c-3e7e421a2acf Point List
f6867cdd-2216-4451-9134-7da94bdcd5af Legend
49d2e200-b34e-4e1c-82a3-07feb4cb9378 Colour RGB
a45d68b3-c299-4b17-bdae-7975f216cec6 Colour HSL
5958a658-20c2-4a2b-86ba-4d1b81bf5348 Colour HSV
8b4da37d-1124-436a-9de2-952e4224a220 Blend Colours
""".strip().split("\n")
    )
}
"""Components without effect, by their ids."""

INERT_NAMES = frozenset(
    """
Bar Graph|Cloud Display|Clock|Colour CMYK|Colour LCH|Colour L*ab|Colour Picker|Colour Wheel|Colour XYZ|Context Bake
Context Print|Curvature Graph|Data Output|Direction Display|Fitness Landscape|Galapagos|Perpendicular Display|Pie Chart
Point Order|Quick Graph|Scalar Display|Sketch|Symbol (Advanced)|Symbol (Simple)|Symbol Display|Tensor Display
Value Tracker
""".strip()
    .replace("\n", "|")
    .split("|")
)
"""Components and objects of Grasshopper itself without effect, by their names."""


def is_inert(guid: UUID, name: str, plugin: bool) -> bool:
    """Whether an object has no effect, and gives no data."""
    return guid in INERT or (not plugin and name in INERT_NAMES)


SWATCH = next(guid for guid, names in guids.NAMES.items() if "Colour Swatch" in names)
"""A colour that a person has chosen."""
