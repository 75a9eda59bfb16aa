"""The bundles of the forces, made from their classes: inputs, tooltips, help and code."""

from __future__ import annotations

import json
import re
import textwrap
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from hookean.forces import KINDS
from hookean.scene.catalogue import catalogue
from hookean_canvas.components.bundles import identity

EXPOSURE = {"internal": 2, "load": 4, "support": 8}
"""The row of the panel a force stands in, by its role."""

FAMILIAR: dict[str, tuple[str, str]] = {
    "springs": ("Springs From Line", "Springs"),
    "unary": ("Unary Force", "UForce"),
}
"""Names and nicknames people know from Kangaroo 0.099; others are the name of the class."""

ORDER: dict[str, str] = {
    "springs": "lines stiffness damping rest_length upper_cutoff lower_cutoff plasticity rest_factor edges",
    "anchor_spring": "points strength targets",
    "self_weight": "lines points per_length total direction",
    "soapfilm": "mesh tension warp weft",
    "pull_to_curve": "curve points",
    "pull_to_mesh": "target points",
    "collide_curve": "curve points",
    "collide_solid": "target points",
    "pull_to_surface": "control_points points",
}
"""Fields that come first, where the order a Kangaroo user expects is not that of the class."""

VARIABLES = {
    "lines": "connection",
    "points": "point",
    ("unary", "vector"): "force",
    ("pull_to_surface", "control_points"): "surface",
}
"""Inputs named otherwise than their field."""

COVERED: dict[str, tuple[str, ...]] = {
    "": ("particles",),  # on a canvas a particle is a point
    "springs": ("mesh",),  # the connection takes meshes too
    "self_weight": ("mesh",),
    "pull_to_curve": ("mesh", "closed"),  # the curve knows whether it is closed
    "pull_to_mesh": ("mesh", "vertices", "faces"),  # the target is a mesh of the canvas
    "level_set": ("mesh",),
    # the surface has its numbers
    "pull_to_surface": ("mesh", "knots_u", "knots_v", "degree_u", "degree_v", "weights"),
    "collide_curve": ("mesh",),
    "collide_solid": ("mesh", "vertices", "faces"),
}
"""Fields that need no input of their own, for all kinds under the empty name."""

HINTS = {
    "number": "float",
    "numbers": "float",
    "whole number": "int",
    "vector": "vector",
    "vectors": "vector",
    "yes or no": "bool",
    "text": "str",
    "texts": "str",
    "points": "point",
    "rows of points": "point",
}

ASCII = {"²": "^2", "³": "^3", "·": ".", "≥": ">=", "≤": "<=", "×": "x", "√": "sqrt ", "½": "1/2", "→": "->"}


@dataclass(frozen=True)
class Entry:
    """One input of a force component: the field it feeds, its variable, type hint and tooltip."""

    field: str
    variable: str
    hint: str
    tooltip: str


def files() -> dict[str, dict[str, str]]:
    """Text files `code.py` and `metadata.json` of every force's bundle, by the name of its folder."""
    found = {}
    for described in catalogue():
        folder = KINDS[described["kind"]].__name__
        found[folder] = {"code.py": code(described), "metadata.json": metadata(folder, described)}
    return found


def metadata(folder: str, described: Mapping[str, Any]) -> str:
    """The text of metadata.json for a force as `catalogue.entry` describes it."""
    words = re.sub("(?<=[a-z])(?=[A-Z])", " ", folder)
    name, nickname = FAMILIAR.get(described["kind"], (words, folder))
    told = f"{described['summary']}\n{described['formula']}"
    inputs = [
        {
            "name": entry.variable,
            "nickname": entry.variable,
            "description": entry.tooltip,
            "optional": True,  # the component itself says in a sentence what is missing
            "allowTreeAccess": True,
            "showTypeHints": True,
            "scriptParamAccess": "list",
            "typeHintID": entry.hint,
        }
        for entry in entries(described)
    ]
    output = {"name": "force", "nickname": "force", "description": "The force, for the Engine's input _forces"}
    content = {
        "name": name,
        "nickname": nickname,
        "category": "Hookean",
        "subcategory": "Forces",
        "description": told,
        "exposure": EXPOSURE[described["role"]],
        "instanceGuid": str(identity(folder)),
        "ghpython": {
            "isAdvancedMode": False,
            "iconDisplay": 2,
            "inputParameters": inputs,
            "outputParameters": [output],
        },
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def code(described: Mapping[str, Any]) -> str:
    """The text of code.py: the force's help, and one call."""
    kind = described["kind"]
    paragraphs = [*described["description"].split("\n\n"), described["formula"]]
    help = "\n\n".join("\n".join(textwrap.wrap(ascii_text(p), 100)) for p in paragraphs).replace("\\", "/")
    arguments: dict[str, list[str]] = {}
    for entry in entries(described):
        arguments.setdefault(entry.field, []).append(entry.variable)
    lines = [f"    {field}={_argument(variables)}," for field, variables in arguments.items()]
    call = "\n".join(["force = canvas.force(", "    ghenv,", f'    "{kind}",', *lines, ")"])
    return f'"""{help}\n"""\n\nfrom hookean_client import canvas\n\n{call}\n'


def entries(described: Mapping[str, Any]) -> Iterator[Entry]:
    """The inputs of a force component in their order: where it acts, then its numbers, its name last."""
    kind = described["kind"]
    covered = (*COVERED[""], *COVERED.get(kind, ()))
    first = ORDER.get(kind, "").split()
    fields = [f for f in described["fields"] if f["name"] not in covered]
    fields.sort(key=lambda f: first.index(f["name"]) if f["name"] in first else len(first))  # stable
    for field in fields:
        entry = Entry(field["name"], _variable(described, field), _hint(field), _tooltip(described, field))
        if field["type"] != "rows of points" or field["name"] == "control_points":
            yield entry
            continue
        count = described["particles_per_element"]
        for i in range(1, count + 1):
            yield replace(entry, variable=f"{entry.variable}_{i}", tooltip=f"Point {i} of {count}. {entry.tooltip}")


def ascii_text(text: str) -> str:
    """Words and formulas in ASCII: `φ` is phi, `²` is ^2."""
    return "".join(c if c.isascii() else ASCII.get(c) or unicodedata.name(c).split()[-1].lower() for c in text)


def _argument(variables: list[str]) -> str:
    return variables[0] if len(variables) == 1 else f"({', '.join(variables)})"


def _variable(described: Mapping[str, Any], field: Mapping[str, Any]) -> str:
    """`_required`, `_with_default_` or `optional_`."""
    name = VARIABLES.get((described["kind"], field["name"])) or VARIABLES.get(field["name"], field["name"]).lower()
    if _required(described, field):
        return f"_{name}"
    return f"{name}_" if field["default"] in (None, "") else f"_{name}_"


def _required(described: Mapping[str, Any], field: Mapping[str, Any]) -> bool:
    place = field["name"] in described["places"] and not described["everywhere"]
    return field["required"] or place or field["name"] == "target"


def _hint(field: Mapping[str, Any]) -> str:
    if field["name"] in ("mesh", "target", "lines", "control_points", "image", "path"):
        return "none"  # the script looks at what it got
    if field["name"] == "curve":
        return "curve"
    return "point" if field["name"] == "point" else HINTS.get(field["type"], "none")


def _tooltip(described: Mapping[str, Any], field: Mapping[str, Any]) -> str:
    """What the input is, with its unit, what is allowed and its default."""
    told = TOLD.get((described["kind"], field["name"]), field["description"])
    if "[" not in told and (field["unit"] != "-" or field["type"] in ("number", "numbers", "vector", "vectors")):
        told += f" [{field['unit']}]"
    told = f"{told}."
    if "choices" in field:
        told += f" One of {', '.join(filter(None, field['choices']))}."
    if field["type"] in ("numbers", "texts", "vectors") and "for each" not in told:
        told += " One for all, or one for each."
    if not _required(described, field) and field["default"] not in (None, ""):
        told += f" Default: {_said(field['default'])}."
    return told


TOLD: dict[tuple[str, str], str] = {
    ("springs", "lines"): "Lines, curves that are straight, polylines or meshes (their edges); ends become particles",
    ("self_weight", "lines"): "Lines or meshes with a weight per length; or a mesh with a total",
    ("pull_to_curve", "curve"): "The curve; it stays where it is",
    ("pull_to_surface", "control_points"): "The NURBS surface, untrimmed [length]; it stays where it is",
    ("pull_to_mesh", "target"): "The mesh to pull to; it stays where it is",
    ("collide_curve", "curve"): "The closed curve; it stays where it is",
    ("collide_solid", "target"): "The solid, a closed mesh; it stays where it is",
    ("pressure", "mesh"): "The mesh under pressure; its vertices become particles",
    ("shell", "mesh"): "The mesh that bends; its vertices become particles",
    ("soapfilm", "mesh"): "The mesh that is the film; its vertices become particles",
}
"""Tooltips where the canvas accepts other data than the field."""


def _said(value: Any) -> str:
    if isinstance(value, list):
        return "(" + ", ".join(_said(v) for v in value) + ")"
    return f"{value:g}" if isinstance(value, float) else str(value)
