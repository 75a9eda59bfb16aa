"""What stands in an archive, piece by piece, whole or damaged: objects, their inputs and outputs, their code."""

from __future__ import annotations

import base64
import binascii
from dataclasses import dataclass
from typing import TypeVar
from uuid import UUID

from hookean_canvas.archive import Chunk, Type, guids

Value = TypeVar("Value")
Rectangle = tuple[float, float, float, float]

FARTHEST = 1e6
"""Places and sizes on a canvas are below this [pixels]; anything above is damage."""

_NAMES = {"input": ("InputParam", "param_input"), "output": ("OutputParam", "param_output")}
SCRIPTS = {
    guids.SCRIPT,
    guids.PYTHON3_SCRIPT,
    guids.IRONPYTHON_SCRIPT,
    guids.CSHARP_SCRIPT,
    guids.GHPYTHON_SCRIPT,
}


@dataclass(frozen=True)
class Part:
    """An object of a definition: its id and name, and the container with all the rest (None where it has none)."""

    chunk: Chunk
    container: Chunk | None

    @property
    def guid(self) -> UUID | None:
        """What kind of object it is."""
        found = self.chunk.value("GUID")
        return found if isinstance(found, UUID) else None

    @property
    def name(self) -> str:
        """The name of its kind, as the file has it."""
        return str(self.chunk.value("Name", default=""))

    @property
    def label(self) -> str:
        """What a person calls it: its nickname, else the name of its kind."""
        nickname = self.container.value("NickName", default="") if self.container is not None else ""
        return str(nickname or self.name or "an object without a name")

    @property
    def id(self) -> UUID | None:
        """Its own id in the definition."""
        found = self.container.value("InstanceGuid") if self.container is not None else None
        return found if isinstance(found, UUID) else None


@dataclass(frozen=True)
class Code:
    """The source of a script and its language: "python 3", "python 2", "csharp" or what the file calls it."""

    text: str
    language: str


def given(chunk: Chunk | None, name: str, default: Value) -> Value:
    """The value of an item where it is there and of the default's type, else the default."""
    value = chunk.value(name) if chunk is not None else None
    return value if isinstance(value, type(default)) else default


def parts(root: Chunk) -> list[Part]:
    """The objects of a definition, in their order; none where it holds no definition."""
    definition = root.chunk("Definition")
    objects = definition.chunk("DefinitionObjects") if definition is not None else None
    return [Part(chunk, chunk.chunk("Container")) for chunk in objects.chunks] if objects is not None else []


def inputs(container: Chunk) -> list[Chunk]:
    """The inputs of a component; of a floating parameter (a slider, a panel, a point), the container itself."""
    return [container] if is_floating(container) else _ports(container, "input")


def outputs(container: Chunk) -> list[Chunk]:
    """The outputs of a component; of a floating parameter, the container itself."""
    return [container] if is_floating(container) else _ports(container, "output")


def is_floating(container: Chunk) -> bool:
    """Whether an object is a parameter by itself and no component."""
    if _ports(container, "input") or _ports(container, "output"):
        return False
    return container.item("SourceCount") is not None


def _ports(container: Chunk, side: str) -> list[Chunk]:
    """The inputs or outputs of a component, wherever its kind keeps them; those of evaluation units come last."""
    places = [container, container.chunk("ParameterData")]
    found = [port for place in places if place is not None for port in place.chunks if port.name in _NAMES[side]]
    for unit in _units(container):
        params = unit.chunk("params")
        group = params.chunk(side) if params is not None else None
        found += [port for port in group.chunks if port.name in ("p", "param")] if group is not None else []
    return found


def _units(container: Chunk) -> list[Chunk]:
    """The evaluation unit in use of a component that has several sets of inputs and outputs, as plug-ins write them.

    The chunk `EvalUnits` holds all units, `ActiveUnit` names the one whose inputs and outputs the canvas shows; where
    it names none of them, none is known to be out of use. Source: GH_SwitcherComponent.cs and EvaluationUnit.cs of
    github.com/mariuszhermansdorfer/SandWorm.
    """
    held, active = container.chunk("EvalUnits"), container.chunk("ActiveUnit")
    units = [unit for unit in held.chunks if unit.name == "unit"] if held is not None else []
    name = active.value("unitname") if active is not None else None
    return [unit for unit in units if unit.value("name") == name] or units


def sources(port: Chunk) -> list[UUID]:
    """The ids that the wires into an input come from, in the order of their numbers."""
    wires = [item for item in port.items if item.name == "Source" and isinstance(item.value, UUID)]
    return [item.value for item in sorted(wires, key=lambda item: item.index)]


def bounds_of(container: Chunk | None) -> Rectangle | None:
    """Where an object is on the canvas: x, y, width, height [pixels]; None where the file does not say, or not so."""
    attributes = container.chunk("Attributes") if container is not None else None
    bounds = attributes.item("Bounds") if attributes is not None else None
    if bounds is None or bounds.type not in (Type.DRAWING_RECTANGLE, Type.DRAWING_RECTANGLEF):
        return None
    x, y, width, height = map(float, bounds.value)
    # a number that is not finite compares as False
    return (x, y, max(width, 0.0), max(height, 0.0)) if all(abs(n) < FARTHEST for n in bounds.value) else None


def code(container: Chunk) -> Code | None:
    """The script in a component's container, or None; ValueError where its text cannot be decoded."""
    plain = container.item("CodeInput")
    if plain is not None:
        return Code(str(plain.value), "python 2")
    script = container.chunk("Script")
    if script is None:
        return None
    text = str(script.value("Text", default=""))
    try:
        return Code(base64.b64decode(text, validate=True).decode(), language(script))
    except (binascii.Error, UnicodeDecodeError) as error:
        raise ValueError(f"the script's text is no base64 of UTF-8 ({error})") from None


def language(script: Chunk) -> str:
    """The language of a Rhino 8 script chunk: `LanguageSpec` holds a taxon such as `*.*.python` and a version."""
    spec = script.chunk("LanguageSpec")
    if spec is None:
        return "an unknown language"
    taxon, version = str(spec.value("Taxon", default="")), str(spec.value("Version", default=""))
    kind = taxon.rsplit(".", 1)[-1] or "an unknown language"
    if kind != "python":
        return kind
    return "python 2" if "ironpython" in taxon or version.startswith("2") else "python 3"


def libraries(definition: Chunk) -> dict[UUID, str]:
    """The plug-ins that a definition lists, each with its name and version."""
    listed = definition.chunk("GHALibraries")
    found = {}
    for library in listed.chunks if listed is not None else ():
        words = [str(library.value(name, default="")) for name in ("Name", "Version")]
        found[library.value("Id")] = " ".join(word for word in words if word)
    return found
