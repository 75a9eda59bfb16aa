"""The catalogue of forces, made from their classes: summary, fields and outputs of each, for people and programs."""

from __future__ import annotations

import re
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from pydantic.fields import FieldInfo
from pydantic.json_schema import GenerateJsonSchema

from hookean.forces import KINDS, Force
from hookean.forces.base import PLACES
from hookean.scene.examples import example_scene
from hookean.scene.scene import Scene

_UNIT = re.compile(r"\[([^\]]*)\]")
_BOUNDS = {"minimum": "minimum", "exclusiveMinimum": "more_than", "maximum": "maximum", "exclusiveMaximum": "less_than"}


def catalogue() -> list[dict[str, Any]]:
    """Every kind of force, in the order of `KINDS`, as plain values; see `entry`."""
    schemas = schema()["$defs"]
    return [entry(cls, schemas[cls.__name__]) for cls in KINDS.values()]


def entry(cls: type[Force], described: dict[str, Any] | None = None) -> dict[str, Any]:
    """One force as plain values.

    `kind, title, summary, description, formula, role, conservative, damped, remembers, particles_per_element,
    places` (the fields of which exactly one gives its place), `everywhere` (none of them: on all particles),
    `fields` (name, description, unit, type, required, default, bounds, choices), `outputs` (name and unit of every
    column of a result), `example`, a force of this kind, and `scene`, a whole scene with it that comes to rest.
    """
    described = described or schema()["$defs"][cls.__name__]
    words = (cls.__doc__ or "").strip()
    kind = cls.kind_name
    return {
        "kind": kind,
        "title": cls.kind_title or kind.replace("_", " ").capitalize(),
        "summary": " ".join(words.split("\n\n")[0].split()),
        "description": "\n\n".join(" ".join(part.split()) for part in words.split("\n\n")),
        "formula": cls.formula,
        "role": cls.role,
        "conservative": cls.conservative,
        "damped": cls.damped,
        "remembers": cls.remembers,
        "particles_per_element": cls.arity,
        "places": [name for name in PLACES if name in cls.model_fields],
        "everywhere": cls.everywhere,
        "fields": [
            field_entry(name, field, described["properties"][name])
            for name, field in sorted(cls.model_fields.items(), key=lambda item: _rank(item[0]))
            if name != "kind"
        ],
        "outputs": [{"name": name, "unit": unit or "-"} for name, unit in cls.outputs.items()],
        "example": _example(cls),
        "scene": _scene(cls),
    }


def schema() -> dict[str, Any]:
    """JSON schema of a scene; a force is identified by its `kind`."""
    return deepcopy(_schema())


@cache
def _schema() -> dict[str, Any]:
    return Scene.model_json_schema(schema_generator=PlainSchema)


def page() -> str:
    """The page docs/forces.md."""
    about = "Every force, with its formula, fields and units. `hookean forces KIND` prints the same for one of them."
    made = "<!-- made from the classes in core/hookean/forces by make docs -->"
    return f"# Forces\n\n{made}\n\n{about}\n\n{markdown()}"


def exports(text: str) -> str:
    """The text of `hookean/__init__.py` with the forces there are: as imports for type checkers, with the files that
    they are loaded from, and in `__all__`."""
    classes: list[type[Force]] = [*KINDS.values(), Force]
    before = re.findall(r"from hookean\.forces\.\w+ import (\w+)", text)
    lines = text.splitlines(keepends=True)
    first = lines.index("if TYPE_CHECKING:\n") + 1
    last = lines.index("\n", first)
    begin, end = lines.index("__all__ = [\n") + 1, lines.index("]\n")
    imports = {line for line in lines[first:last] if "hookean.forces" not in line}
    imports |= {f"    from {cls.__module__} import {cls.__name__} as {cls.__name__}\n" for cls in classes}
    names = {line for line in lines[begin:end] if line.strip(' ",\n') not in before}
    names |= {f'    "{cls.__name__}",\n' for cls in classes}
    listed = sorted(names, key=lambda line: (line[5].islower(), line))  # classes come before functions
    homes = [line for line in lines[last:begin] if '": "forces.' not in line]
    files = [f'    "{cls.__name__}": "{cls.__module__.removeprefix("hookean.")}",\n' for cls in classes]
    at = homes.index("_HOMES = {\n") + 1
    loaded = [*homes[:at], *sorted(files), *homes[at:]]
    return "".join([*lines[:first], *sorted(imports), *loaded, *listed, *lines[end:]])


def write_exports() -> None:
    """Bring `hookean/__init__.py` up to date."""
    path = Path(__file__).parents[1] / "__init__.py"
    path.write_text(exports(path.read_text(encoding="utf-8")), encoding="utf-8")


def markdown() -> str:
    """The catalogue as Markdown: a table of all forces, then one table of fields for each."""
    entries = catalogue()
    lines = ["| kind | description | acts on | energy |", "| --- | --- | --- | --- |"]
    for e in entries:
        places = [*e["places"], *(["everything"] if e["everywhere"] else [])]
        lines.append(
            f"| [`{e['kind']}`](#{e['kind']}) | {_cell(_words(e['summary']))} | {', '.join(places)} | "
            f"{_cell(e['formula'])} |"
        )
    for e in entries:
        lines += ["", f"## {e['kind']}", "", e["description"], ""]
        lines += ["| field | unit | default | allowed | meaning |", "| --- | --- | --- | --- | --- |"]
        for f in e["fields"]:
            default = "required" if f["required"] else "" if f["default"] in (None, "") else f"`{_said(f['default'])}`"
            cells = (f"`{f['name']}`", f["unit"], default, _allowed(f), _cell(f["description"]))
            lines.append(f"| {' | '.join(cells)} |")
        reported = ", ".join(f"`{o['name']}` [{o['unit']}]" for o in e["outputs"])
        if reported:
            lines += ["", f"A result reports {reported} for every element."]
    return "\n".join(lines) + "\n"


class PlainSchema(GenerateJsonSchema):
    """JSON schema with arrays as defaults."""

    def encode_default(self, dft: Any) -> Any:
        return dft.tolist() if isinstance(dft, np.ndarray) else super().encode_default(dft)


def _rank(name: str) -> int:
    """Places first, the name last, the rest as the class has them."""
    return PLACES.index(name) if name in PLACES else 99 if name == "name" else 50


def unit(field: FieldInfo) -> str:
    """The unit in the description of a field, such as `force/length`; empty where it has none."""
    found = _UNIT.search(field.description or "")
    return found.group(1) if found else ""


def field_entry(name: str, field: FieldInfo, described: dict[str, Any]) -> dict[str, Any]:
    """A field as plain values: name, description, unit, type, required, default, bounds, choices, and the
    names of a vector's components where they are not x, y and z."""
    default = None if field.is_required() else field.default
    kind = _type(described)
    coordinates = name in PLACES and kind in ("points", "lines", "rows of points")
    found: dict[str, Any] = {
        "name": name,
        "description": field.description or "",
        "unit": unit(field) or ("length" if coordinates else "-"),
        "type": kind,
        "required": field.is_required(),
        "default": np.asarray(default).tolist() if isinstance(default, tuple | np.ndarray) else default,
    }
    options = [described, *described.get("anyOf", [])]
    bounds = {said: o[key] for o in options for key, said in _BOUNDS.items() if key in o}
    if bounds:
        found["bounds"] = bounds
    choices = [c for o in options for c in o.get("enum", [])]
    if choices:
        found["choices"] = choices
    if "x-components" in described:
        found["components"] = described["x-components"]
    return found


def _type(described: dict[str, Any]) -> str:
    """`number`, `numbers` (one or one for each), `text`, `texts` (likewise), `points`, `lines`, `indices`, ..."""
    options = [
        o for o in described.get("anyOf", [described]) if o.get("type") != "null" and "base64" not in str(o)[:200]
    ]
    arrays = [o for o in options if o.get("type") == "array"]
    if not arrays:
        plain = {"string": "text", "number": "number", "integer": "whole number", "boolean": "yes or no"}
        return plain.get(str(options[0].get("type")), "object") if options else "object"
    depth, inner = 0, arrays[-1]
    while inner.get("type") == "array":
        depth, inner = depth + 1, inner.get("items", {})
    if inner.get("type") == "string":
        return "texts"
    if inner.get("type") == "integer" or "anyOf" in inner:
        return "indices"
    pairs = arrays[-1].get("items", {}).get("minItems") == 2
    names = {1: "numbers", 2: "points", 3: "lines" if pairs else "rows of points"}
    if depth == 1 and arrays[-1].get("minItems") == 3:
        return "vector"
    return "vectors" if len(arrays) > 1 else names[min(depth, 3)]


def _example(cls: type[Force]) -> dict[str, Any] | None:
    try:
        force, _ = cls.example()
    except TypeError:
        return None
    given = force.model_dump(mode="json", exclude_unset=True)
    return {"kind": cls.kind_name, **given}


def _scene(cls: type[Force]) -> dict[str, Any] | None:
    try:
        return example_scene(cls)
    except TypeError:
        return None


def _words(summary: str) -> str:
    """A summary up to its formula, which has a column of its own."""
    return re.split(r"[:,;] (?:moment )?\w+ = ", summary)[0].rstrip(".") + "."


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


def _said(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else str(value)


def _allowed(field: dict[str, Any]) -> str:
    if "choices" in field:
        return ", ".join(f"`{c}`" for c in field["choices"])
    signs = {"minimum": "≥", "more_than": ">", "maximum": "≤", "less_than": "<"}
    return ", ".join(f"{signs[key]} {_said(float(v))}" for key, v in field.get("bounds", {}).items())
