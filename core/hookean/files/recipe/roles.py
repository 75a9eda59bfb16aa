"""The roles that a drafted recipe gives to objects: their values, and the tables of the recipe that they become.

A role is for one family of objects: points, curves or surfaces (meshes, SubDs, surfaces, Breps and extrusions). Its
fields are its values, with defaults in m, N and s; user text of an object (see `convention`) overrides them.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal

from hookean.errors import InputError
from hookean.files.recipe import shapes
from hookean.files.recipe.convention import DEFAULT_DIVIDE, NUMBERS, edges_of, number_of, vector_of
from hookean.files.recipe.drawing import Item
from hookean.files.recipe.shapes import Split
from hookean.scene.catalogue import field_entry, unit
from hookean.values.columns import LARGEST, Model
from hookean.values.fields import Field
from hookean.values.units import Units

FAMILIES = {"points": shapes.is_point, "curves": shapes.is_curve, "surfaces": shapes.is_mesh}
"""What a family of objects is, by its name."""
SI = Units()

Stiffness = Annotated[float, Field(ge=0, le=LARGEST, description="Force that stretches it by one unit [force/length]")]
RestFactor = Annotated[float, Field(ge=0, le=10, description="Rest length / drawn length; 0: as a soap film [-]")]
Pieces = Annotated[
    int,
    Field(
        ge=0, le=2000, description=f"Pieces of each curve, 0: its straight segments, {DEFAULT_DIVIDE} if it is bent [-]"
    ),
]
Faces = Annotated[
    int, Field(ge=1, le=2000, description="Faces of each surface in this direction; meshes keep theirs [-]")
]
Load = Annotated[
    float, Field(ge=-LARGEST, le=LARGEST, description="Load on each of its particles along z, negative: down [force]")
]
Force = Annotated[float, Field(ge=-LARGEST, le=LARGEST, description="Load on each point in this direction [force]")]
PerWidth = Annotated[float, Field(gt=0, le=LARGEST, description="Stiffness per width [force/length]")]
Prestress = Annotated[float, Field(ge=0, le=LARGEST, description="Stress in every direction, as drawn [force/length]")]
Bending = Annotated[float, Field(ge=0, le=LARGEST, description="Plate bending stiffness D [force length]")]
Ends = Annotated[Literal["nothing", "loose ends", "ends"], Field(description="What of it is held in place [-]")]
Rim = Annotated[Literal["nothing", "edges", "corners", "all"], Field(description="What of it is held in place [-]")]
Axes = Annotated[
    Literal["xyz", "xy", "xz", "yz", "x", "y", "z"], Field(description="The directions in which it is held [-]")
]


Snap = Annotated[
    float, Field(ge=0, le=LARGEST, description="Moved to the nearest particle within this distance [length]")
]


@dataclass(frozen=True)
class Part:
    """A table of a recipe for one object: its group (`forces`, `anchors`, `geometry`), the field that selects the
    object, and the feature of it. Of a `curve` or `target` that pulls, the feature is what it pulls, edges or all, and
    `layer` of which layer; "": of all."""

    group: str
    table: Mapping[str, Any]
    place: str
    feature: str = ""
    layer: str = ""


class Role(Model):
    """Base of all roles."""

    role: ClassVar[str]
    family: ClassVar[str]
    summary: ClassVar[str]
    elastic: ClassVar[bool] = False

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        """Sentences call it by its role."""
        super().__pydantic_init_subclass__(**kwargs)
        cls.called = f"the role {getattr(cls, 'role', '')}".rstrip()

    @classmethod
    def defaults(cls, units: Units) -> dict[str, Any]:
        """Its values where nobody gives any, in these units."""
        return converted(cls, {name: field.default for name, field in cls.model_fields.items()}, SI, units)

    @classmethod
    def entry(cls, units: Units) -> dict[str, Any]:
        """It as plain values: role, family, summary, and fields as the catalogue of forces has them."""
        described, defaults = cls.model_json_schema().get("properties", {}), cls.defaults(units)
        names = sorted(cls.model_fields, key=lambda name: name.startswith("divide"))
        fields = [{**field_entry(n, cls.model_fields[n], described[n]), "default": defaults[n]} for n in names]
        return {"role": cls.role, "family": cls.family, "summary": cls.summary, "fields": fields}

    def split(self, item: Item) -> Split | None:
        """How it divides an object."""
        return None

    def divided(self, item: Item) -> dict[str, Any]:
        """The division as a recipe has it."""
        split = self.split(item)
        return {} if split is None else {"divide": list(split)}

    @abstractmethod
    def parts(self, item: Item, units: Units) -> list[Part]:
        """The tables that an object gives; InputError where it cannot have this role."""


def converted(role: type[Role], values: Mapping[str, Any], given: Units, wanted: Units) -> dict[str, Any]:
    """Values of a role in other units; unknown names stay."""
    dimensions = {name: unit(field).replace("-", "") for name, field in role.model_fields.items()}
    factors = {name: given.factor(dimension, wanted) for name, dimension in dimensions.items()}
    return {n: v if factors.get(n, 1.0) == 1.0 else float(f"{v * factors[n]:.12g}") for n, v in values.items()}


def _elastic(role: Role, item: Item, table: dict[str, Any], units: Units) -> list[Part]:
    """The parts of an elastic role with a load and a support: what it is, its load, what of it is held."""
    name = item.layer.replace("::", " ") or role.role
    curve = role.family == "curves"
    parts = [Part("forces", {**table, "name": name, **role.divided(item)}, "lines" if curve else "mesh")]
    given, load = dict(role), _load(item, units)
    vector = [load[0], load[1], given["load"]]
    if any(vector):
        parts.append(Part("forces", {"kind": "unary", "name": f"load {name}", "vector": vector}, "points", "vertices"))
    feature = {"loose ends": "loose", "edges": "rim", "all": "vertices", "nothing": ""}.get(
        given["held"], given["held"]
    )
    if feature:
        held = {"name": f"{name} {given['held']}"}
        parts.append(Part("anchors", held, "points", feature))
    return parts


def _load(item: Item, units: Units) -> list[float]:
    """The load that an object's user text gives to its particles."""
    factor = SI.factor("force", units)
    return [c * factor for c in vector_of(item, None)] if "load" in item.text else [0.0, 0.0, 0.0]


def _springs(item: Item, values: Mapping[str, Any], units: Units, **table: Any) -> dict[str, Any]:
    """A table of springs with what the user text of an object adds to the values of its role."""
    keys = {"damping": "force time/length", "rest_length": "length", "upper_cutoff": "length"}
    keys |= {"lower_cutoff": "length", "plasticity": ""}
    more: dict[str, Any] = {k: number_of(item, k) * SI.factor(d, units) for k, d in keys.items() if k in item.text}
    if "edges" in item.text and not shapes.is_curve(item):
        more["edges"] = edges_of(item)
    return {"kind": "springs", **{k: values[k] for k in ("stiffness", "rest_factor")}, **table, **more}


class Surface(Role):
    """Base of the roles of surfaces, which divide them."""

    family = "surfaces"
    divide_u: Faces = DEFAULT_DIVIDE
    divide_v: Faces = DEFAULT_DIVIDE
    divide_trimmed: Literal["mesh", "whole"] = Field(
        default="mesh", description="Trimmed faces: by their render mesh, or whole, without their cuts [-]"
    )

    def split(self, item: Item) -> Split | None:
        """How it divides a surface."""
        if not shapes.is_surface(item):
            return None
        pair = self.divide_u, self.divide_v
        return pair if self.divide_trimmed == "mesh" else (*pair, "whole")


class SpringRole(Role):
    """Curves as springs."""

    role, family, elastic = "springs", "curves", True
    summary = "Springs, elastic in tension and compression"
    stiffness: Stiffness = 1000.0
    rest_factor: RestFactor = 1.0
    divide: Pieces = 0
    held: Ends = "nothing"
    load: Load = 0.0

    def split(self, item: Item) -> Split | None:
        """How it divides a curve."""
        return _pieces(self.divide, item)

    def parts(self, item: Item, units: Units) -> list[Part]:
        """Springs, their load and what is held of them."""
        return _elastic(self, item, _springs(item, dict(self), units), units)


class CableRole(SpringRole):
    """Curves as cables."""

    role = "cables"
    summary = "Springs that act in tension only, and go slack"

    def parts(self, item: Item, units: Units) -> list[Part]:
        """Cables, their load and what is held of them."""
        return _elastic(self, item, _springs(item, dict(self), units, tension_only=True), units)


class NetRole(Surface):
    """Surfaces as nets."""

    role, elastic = "net", True
    summary = "Springs along the edges of faces; rest factor 0 draws it tight"
    stiffness: Stiffness = 1000.0
    rest_factor: RestFactor = 0.0
    held: Rim = "nothing"
    load: Load = 0.0

    def parts(self, item: Item, units: Units) -> list[Part]:
        """Springs, their load and what is held of them."""
        return _elastic(self, item, _springs(item, dict(self), units), units)


class MembraneRole(Surface):
    """Surfaces as membranes."""

    role, elastic = "membrane", True
    summary = "Cloth of finite elements with prestress"
    stiffness: PerWidth = 600e3
    prestress: Prestress = 2e3
    held: Rim = "nothing"
    load: Load = 0.0

    def parts(self, item: Item, units: Units) -> list[Part]:
        """A membrane, its load and what is held of it."""
        stress = [self.prestress, self.prestress, 0.0]
        return _elastic(self, item, {"kind": "membrane", "warp_stiffness": self.stiffness, "prestress": stress}, units)


class ShellRole(Surface):
    """Surfaces as thin shells."""

    role, elastic = "shell", True
    summary = "A thin elastic shell: stiff in its surface and against bending, without stress as drawn"
    stiffness: PerWidth = 600e3
    bending: Bending = 500.0
    held: Rim = "nothing"
    load: Load = 0.0

    def parts(self, item: Item, units: Units) -> list[Part]:
        """A membrane without prestress and its bending, a load and what is held."""
        sheet = _elastic(self, item, {"kind": "membrane", "warp_stiffness": self.stiffness}, units)
        name = f"bending {item.layer.replace('::', ' ') or self.role}"
        table = {"kind": "shell", "name": name, "strength": self.bending, **self.divided(item)}
        return [sheet[0], Part("forces", table, "mesh"), *sheet[1:]]


class HeldPoints(Role):
    """Points as anchors."""

    role, family = "anchors", "points"
    summary = "Held in place"
    axes: Axes = "xyz"
    snap: Snap = 0.0

    def parts(self, item: Item, units: Units) -> list[Part]:
        """An anchor at the point."""
        return [Part("anchors", {**_held(item, self.axes), **_snap(self.snap)}, "points")]


class HeldCurves(Role):
    """Curves as anchors."""

    role, family = "anchors", "curves"
    summary = "Particles at its vertices or ends are held in place"
    axes: Axes = "xyz"
    at: Literal["vertices", "ends"] = Field(default="vertices", description="The points of it that are held [-]")
    divide: Pieces = 0
    snap: Snap = 0.0

    def split(self, item: Item) -> Split | None:
        """How it divides a curve."""
        return _pieces(self.divide, item) if self.at == "vertices" else None

    def parts(self, item: Item, units: Units) -> list[Part]:
        """An anchor at points of the curve."""
        return [
            Part("anchors", {**_held(item, self.axes), **self.divided(item), **_snap(self.snap)}, "points", self.at)
        ]


class HeldSurfaces(Surface):
    """Surfaces as anchors."""

    role = "anchors"
    summary = "Particles at its vertices are held in place"
    axes: Axes = "xyz"
    at: Literal["all", "edges", "corners"] = Field(default="all", description="The points of it that are held [-]")

    def parts(self, item: Item, units: Units) -> list[Part]:
        """An anchor at vertices of the surface."""
        feature = {"all": "vertices", "edges": "naked"}.get(self.at, self.at)
        return [Part("anchors", {**_held(item, self.axes), **self.divided(item)}, "points", feature)]


class LoadedPoints(Role):
    """Points as loads."""

    role, family = "loads", "points"
    summary = "A load on the particle at the point"
    feature: ClassVar[str] = ""
    x: Force = 0.0
    y: Force = 0.0
    z: Force = -10.0

    def parts(self, item: Item, units: Units) -> list[Part]:
        """The load."""
        name = f"load {item.layer}".strip().replace("::", " ")
        table = {"kind": "unary", "name": name, "vector": [self.x, self.y, self.z]}
        return [Part("forces", table, "points", self.feature)]


class LoadedCurves(LoadedPoints):
    """Curves as loads."""

    role, family = "loads", "curves"
    summary = "A load on the particle at its start"
    feature = "start"


class CarriedPoints(Role):
    """Points that move with particles."""

    role, family = "geometry", "points"
    summary = "Moves with the particles, without forces"

    def parts(self, item: Item, units: Units) -> list[Part]:
        """The points."""
        return [Part("geometry", {"kind": "points", "name": item.layer or item.kind}, "points")]


class CarriedCurves(Role):
    """Curves that move with particles."""

    role, family = "geometry", "curves"
    summary = "Moves with the particles, without forces"

    def parts(self, item: Item, units: Units) -> list[Part]:
        """The curve, by its vertices or control points."""
        kind = "polyline" if shapes.straight(item) else "curve"
        return [Part("geometry", {"kind": kind, "name": item.layer or item.kind}, "points")]


class CarriedSurfaces(Surface):
    """Surfaces that move with particles."""

    role = "geometry"
    summary = "Moves with the particles, without forces"

    def parts(self, item: Item, units: Units) -> list[Part]:
        """The mesh."""
        return [Part("geometry", {"kind": "mesh", "name": item.layer or item.kind, **self.divided(item)}, "mesh")]


class Guide(Role):
    """Base of the roles of what stays where it is and pulls particles."""

    role = "guide"
    strength: float = Field(
        default=1000.0, ge=0, le=LARGEST, description="Pull on a particle one unit away from it [force/length]"
    )
    pulls: Literal["edges", "all", "nearest edges", "nearest"] = Field(
        default="edges",
        description="Particles it pulls: on edges of surfaces and at ends of curves, or all; nearest: only those of "
        "them that no other such guide is nearer to [-]",
    )
    layer: str = Field(default="", description="Layer of the particles it pulls; empty: all layers [-]")

    def pull(self, kind: str, item: Item, place: str, divided: Mapping[str, Any]) -> list[Part]:
        """The table of a pull."""
        name = item.layer.replace("::", " ") or self.role
        table = {"kind": kind, "name": name, "strength": self.strength, **divided}
        table |= {"nearest": True} if self.pulls.startswith("nearest") else {}
        return [Part("forces", table, place, "edges" if "edges" in self.pulls else "all", self.layer)]


class GuideCurves(Guide):
    """Curves that guide particles."""

    family = "curves"
    summary = "Stays where it is, and pulls particles onto itself along which they slide"
    divide: int = Field(
        default=100, ge=1, le=2000, description="Pieces of the polyline that stands for it, if it is bent [-]"
    )

    def parts(self, item: Item, units: Units) -> list[Part]:
        """A pull to the curve; of several with the same values each particle is pulled to the nearest."""
        return self.pull("pull_to_curve", item, "curve", {"curve_divide": self.divide})


class GuideSurfaces(Guide, Surface):
    """Surfaces that guide particles."""

    summary = "Stays where it is, and pulls particles onto itself on which they slide"

    def parts(self, item: Item, units: Units) -> list[Part]:
        """A pull to the nearest point of the mesh."""
        split = self.split(item)
        return self.pull("pull_to_mesh", item, "target", {} if split is None else {"target_divide": list(split)})


ROLES: dict[tuple[str, str], type[Role]] = {
    (role.family, role.role): role
    for role in (
        *(SpringRole, CableRole, NetRole, MembraneRole, ShellRole, HeldPoints, HeldCurves, HeldSurfaces),
        *(LoadedPoints, LoadedCurves, CarriedPoints, CarriedCurves, CarriedSurfaces, GuideCurves, GuideSurfaces),
    )
}
"""All roles with values, by family and name."""
IGNORE, FLOOR = "ignore", "floor"
"""Roles without values: left out, and a level floor at the top of the object."""


def role_names(family: str) -> list[str]:
    """The roles that objects of a family may have."""
    return [name for of, name in ROLES if of == family] + ([FLOOR] if family else []) + [IGNORE]


def told(role: type[Role], item: Item, units: Units) -> dict[str, Any]:
    """The values of a role that an object's user text gives. InputError where it cannot be read."""
    text, fields = item.text, role.model_fields
    found: dict[str, Any] = {k: number_of(item, k) for k in NUMBERS if k in text and k in fields}
    split = shapes.split_of(text.get("divide"), f"{item.label}, user text divide")
    if split is not None:
        given: dict[str, Any] = {"divide": split[0], "divide_u": split[0], "divide_v": split[1]}
        given |= {"divide_trimmed": "whole"} if len(split) > 2 else {}
        found |= {k: v for k, v in given.items() if k in fields}
    if "axes" in text and "axes" in fields:
        found["axes"] = "".join(sorted(text["axes"].strip().lower()))
    if "load" in text and "load" in fields:
        found["load"] = vector_of(item, None)[2]
    if "load" in text and role.role == "loads":
        along = shapes.direction(item) if role.family == "curves" else None
        found |= dict(zip("xyz", vector_of(item, along), strict=True))
    return converted(role, found, SI, units)


def _snap(reach: float) -> dict[str, Any]:
    return {"snap": reach} if reach else {}


def _held(item: Item, axes: str) -> dict[str, Any]:
    turned = "".join(sorted(item.text.get("rotations", "").strip().lower()))
    more = {"rotations": turned} if turned else {}
    return {"name": item.layer.replace("::", " ") or "anchors", "axes": axes, **more}


def _pieces(divide: int, item: Item) -> Split | None:
    """The division of a curve: as many pieces as given; bent ones are cut in any case."""
    if divide or shapes.straight(item):
        return (divide, divide) if divide else None
    return DEFAULT_DIVIDE, DEFAULT_DIVIDE


def usable(role: Role, item: Item) -> str:
    """Why an object cannot be divided as its role does, in a sentence; "" where it can."""
    try:
        if role.elastic:
            _ = (shapes.lines_of if role.family == "curves" else shapes.mesh_of)(item, role.split(item), "")
        elif role.family == "surfaces":
            shapes.mesh_of(item, role.split(item), "")
    except InputError as error:
        return shapes.short(error.sentence.removeprefix(item.label).lstrip(": "))
    return ""
