"""What the reference of the Python API shows of each class: its fields as a table, then its methods."""

from __future__ import annotations

import dataclasses
import inspect
import re
from enum import Enum
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

import hookean
from hookean.forces import KINDS, Force

STEPPED = ("step", "play", "patch", "undo", "redo", "relax", "reset", "frame", "result", "edited_scene", "save", "load")
"""Methods of a Simulation that programs call; the others serve the service."""


def expand(markdown: str) -> str:
    """A page with `::: hookean.Name` for each name, with fields and methods below it; `::: forces` is all kinds."""
    every = "\n".join(f"::: hookean.{cls.__name__}" for cls in KINDS.values())
    markdown = re.sub(r"^::: forces$", every, markdown, flags=re.M)
    listed = re.findall(r"^::: hookean\.(\w+)$", markdown, re.M)
    public = set(hookean.__all__) - {"Anchors"}  # Anchor by another name
    if sorted(listed) != sorted(public):
        raise SystemExit(f"The reference of the Python API should list these once: {sorted(set(listed) ^ public)}")
    return re.sub(r"^::: hookean\.(\w+)$", lambda m: _entry(m[1]), markdown, flags=re.M)


def _entry(name: str) -> str:
    what = getattr(hookean, name)
    directive = f"::: hookean.{name}"
    if not inspect.isclass(what):
        return f"{directive}\n"
    parts = [f"{directive}\n    options:\n      members: false\n      show_signature: false\n", _fields(what)]
    if not issubclass(what, Force):
        parts += [f"::: hookean.{name}.{method}\n    options:\n      heading_level: 4\n" for method in _methods(what)]
    return "\n".join(part for part in parts if part)


def _fields(cls: type) -> str:
    if issubclass(cls, Force):
        if cls is Force:
            return ""
        kind = cls.kind_name
        return f"Its formula, fields and units: [`{kind}`](../forces.md#{kind}).\n"
    if issubclass(cls, Enum):
        return f"Values: {', '.join(f'`{one.value}`' for one in cls)}.\n"
    if issubclass(cls, BaseModel):
        rows = [f"| `{k}` | {_default(f)} | {_cell(f.description or '')} |" for k, f in cls.model_fields.items()]
        return "\n".join(["| field | default | meaning |", "| --- | --- | --- |", *rows, ""])
    if dataclasses.is_dataclass(cls):
        public = [field for field in dataclasses.fields(cls) if not field.name.startswith("_")]
        return "\n".join(
            ["| field | type |", "| --- | --- |", *(f"| `{f.name}` | {_type(f.type)} |" for f in public), ""]
        )
    return ""


def _type(given: Any) -> str:
    words = str(given).replace("Floats", "numpy array")
    return f"`{_cell(words)}`" if "|" not in words else " or ".join(f"`{one.strip()}`" for one in words.split("|"))


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "required"
    given = field.get_default(call_default_factory=True)
    if given is None or isinstance(given, BaseModel) or not len(str(given)) or not isinstance(given, str | float | int):
        return ""
    return (
        f"`{given:g}`" if isinstance(given, float) else f"`{str(given).lower() if isinstance(given, bool) else given}`"
    )


def _methods(cls: type) -> list[str]:
    if cls is hookean.Simulation:
        return list(STEPPED)
    kinds = (classmethod, staticmethod, property)
    own = [name for name, value in vars(cls).items() if inspect.isfunction(value) or isinstance(value, kinds)]
    return [name for name in own if not name.startswith("_") and inspect.getdoc(getattr(cls, name))]


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")
