"""Parameters that families of scenes share: a type with its bounds, and a description that ends with the unit."""

from __future__ import annotations

from typing import Annotated, Literal

from hookean.values.fields import Field

LARGEST = 1e6

Span = Annotated[float, Field(gt=0, le=LARGEST, description="Distance of the supports [length]")]
Width = Annotated[float, Field(gt=0, le=LARGEST, description="Size of the plan along x [length]")]
Depth = Annotated[float, Field(gt=0, le=LARGEST, description="Size of the plan along y [length]")]
Radius = Annotated[float, Field(gt=0, le=LARGEST, description="Radius of the plan [length]")]
Rise = Annotated[float, Field(gt=0, le=LARGEST, description="Height of the highest particle at rest [length]")]
CornerRise = Annotated[
    float, Field(ge=-LARGEST, le=LARGEST, description="Height of two opposite corners above the other two [length]")
]
Mast = Annotated[
    float, Field(ge=-LARGEST, le=LARGEST, description="Height at which the middle is held, 0: it is free [length]")
]
Height = Annotated[float, Field(gt=0, le=LARGEST, description="Distance of the upper ring from the lower [length]")]

Parts = Annotated[int, Field(ge=1, le=2000, description="Number of springs in the row [-]")]
Across = Annotated[int, Field(ge=1, le=200, description="Number of faces along x [-]")]
Along = Annotated[int, Field(ge=1, le=200, description="Number of faces along y [-]")]
Rings = Annotated[int, Field(ge=1, le=200, description="Number of rings of faces [-]")]
Rays = Annotated[int, Field(ge=3, le=400, description="Number of rays, or of sides of a ring [-]")]
Struts = Annotated[int, Field(ge=3, le=12, description="Number of struts [-]")]

Stiffness = Annotated[float, Field(gt=0, description="Force that stretches a spring by one unit [force/length]")]
EdgeStiffness = Annotated[
    float, Field(ge=0, description="Stiffness of the cables along free edges, 0: none [force/length]")
]
RestFactor = Annotated[
    float,
    Field(
        ge=0,
        le=10,
        description="Rest length / drawn length: below 1 the net is stretched, 0 keeps the force / length ratio [-]",
    ),
]
Slack = Annotated[float, Field(gt=1, le=3, description="Length of a member / its length in the plan [-]")]
Load = Annotated[float, Field(ge=0, description="Weight of each free particle, downward [force]")]
HangingLoad = Annotated[float, Field(gt=0, description="Upward load on each free particle [force]")]
Tension = Annotated[float, Field(gt=0, description="Tension of the film per width [force/length]")]
Prestress = Annotated[float, Field(gt=0, description="Stress of the flat sheet, in every direction [force/length]")]
Sheet = Annotated[float, Field(gt=0, description="Stiffness of the sheet per width [force/length]")]
Overpressure = Annotated[float, Field(ge=0, description="Pressure from below [force/length^2]")]

Border = Literal["edges", "corners"]
Supports = Literal["edges", "two edges", "corners"]
