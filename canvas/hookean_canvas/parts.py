"""What stands in an archive, piece by piece, whole or damaged: objects, their inputs and outputs, their code."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeVar
from uuid import UUID

from . import guids
from .archive import Chunk

Value = TypeVar("Value")

_INPUTS, _OUTPUTS = ("InputParam", "param_input"), ("OutputParam", "param_output")
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
    if is_floating(container):
        return [container]
    return [port for place in _places(container) for port in place.chunks if port.name in _INPUTS]


def outputs(container: Chunk) -> list[Chunk]:
    """The outputs of a component; of a floating parameter, the container itself."""
    if is_floating(container):
        return [container]
    return [port for place in _places(container) for port in place.chunks if port.name in _OUTPUTS]


def is_floating(container: Chunk) -> bool:
    """Whether an object is a parameter by itself and no component."""
    if any(port.name in _INPUTS + _OUTPUTS for place in _places(container) for port in place.chunks):
        return False
    return container.item("SourceCount") is not None


def _places(container: Chunk) -> Iterator[Chunk]:
    yield container
    data = container.chunk("ParameterData")
    if data is not None:
        yield data


def sources(port: Chunk) -> list[UUID]:
    """The ids that the wires into an input come from."""
    return [item.value for item in port.items if item.name == "Source" and isinstance(item.value, UUID)]


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
