"""What objects of a canvas have by themselves where no wire reaches them: sliders, toggles, lists, panels, swatches;
and what those do with data that only pass it on: graph mappers, data recorders."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from decimal import Decimal
from typing import Any
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.guids import (
    BOOLEAN_TOGGLE,
    BUTTON,
    CONTROL_KNOB,
    DIGIT_SCROLLER,
    GENE_POOL,
    NUMBER_SLIDER,
    PANEL,
    VALUE_LIST,
)
from hookean_canvas.archive.parts import given as typed
from hookean_canvas.run import stand_in as untyped
from hookean_canvas.run.graph import Node
from hookean_canvas.run.natives import Unfit, as_kind
from hookean_canvas.run.natives.display import SWATCH
from hookean_canvas.run.natives.expressions import evaluated
from hookean_canvas.run.trees import Tree

stand_in: Any = untyped


def chosen(node: Node, text: str) -> Any:
    """The value of an object that a person sets to a text; InputError for one that it cannot have."""
    if node.guid == PANEL:
        return text
    if node.guid == VALUE_LIST:
        items = [c for c in node.container.chunks if c.name == "ListItem"]
        names = {typed(c, "Name", ""): typed(c, "Expression", "") for c in items}
        if text not in names:
            raise InputError(node.nickname, f"{text} is not one of its choices {', '.join(names)}")
        return _expression(names[text])
    try:
        value = as_kind("boolean" if node.guid == BOOLEAN_TOGGLE else "number", text)
    except Unfit:
        raise InputError(
            node.nickname,
            f"{text} is not a {'truth value; give True or False' if node.guid == BOOLEAN_TOGGLE else 'number'}",
        ) from None
    slider = node.container.chunk("Slider")
    if slider is not None:
        low, high = _number(slider, "Min", -math.inf), _number(slider, "Max", math.inf)
        if not low <= value <= high:
            raise InputError(node.nickname, f"{text} is outside the slider, which ranges from {low:g} to {high:g}")
        return _slid(slider, value)
    return value


def _number(chunk: Chunk, name: str, default: float) -> float:
    """A stored number, of whatever type: versions of Grasshopper differ."""
    value = chunk.value(name)
    return float(value) if isinstance(value, (int, float, Decimal)) and not isinstance(value, bool) else default


def _slid(slider: Chunk, value: float) -> float | int:
    digits, whole = typed(slider, "Digits", 0), typed(slider, "Interval", 0)
    return round(value) if whole and math.isfinite(value) else round(float(value), digits)


def _expression(text: str) -> Any:
    """The value of an item of a value list: a text in quotes, a truth or a number."""
    text = text.strip()
    if len(text) > 1 and text[0] == text[-1] == '"':
        return text[1:-1]
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    try:
        number = float(text)
    except ValueError:
        return _calculated(text)
    return int(number) if number.is_integer() and "." not in text else number


def _calculated(text: str) -> Any:
    """The value of an expression such as 2*Pi; anything else is a text."""
    try:
        return evaluated(text, {})
    except Unfit:
        return text


def _slider_value(node: Node) -> list[Any]:
    slider = node.container.chunk("Slider")
    return [] if slider is None else [_slid(slider, _number(slider, "Value", 0.0))]


def _list_value(node: Node) -> list[Any]:
    items = [chunk for chunk in node.container.chunks if chunk.name == "ListItem"]
    return [_expression(typed(chunk, "Expression", "")) for chunk in items if typed(chunk, "Selected", False)]


def _gene_values(node: Node) -> list[Any]:
    """The genes of a pool, each rounded to its decimals."""
    pool = node.container.chunk("GeneData")
    if pool is None:
        return []
    genes = sorted((item.index, item.value) for item in pool.items if item.name == "Value")
    digits = typed(pool, "Decimals", 2)
    return [_tidy(round(float(value), max(digits, 0)), digits) for _, value in genes if isinstance(value, _STORED)]


def _tidy(value: float, digits: int) -> float | int:
    return value if digits > 0 else round(value)


def _own_number(node: Node) -> list[Any]:
    """The number of a digit scroller or a control knob: the one item called Value, wherever it is stored."""
    chunks = [one for one in node.container.walk() if one.name != "Attributes"]
    found = [item.value for one in chunks for item in one.items if item.name == "Value"]
    return [float(found[0])] if len(found) == 1 and isinstance(found[0], _STORED) else []


_STORED = (int, float, Decimal)


def _panel_value(node: Node) -> list[Any]:
    text = typed(node.container, "UserText", "")
    if not typed(node.container.chunk("PanelProperties"), "Multiline", True):
        return text.splitlines()
    return [text] if text else []


OWN: dict[UUID, Callable[[Node], list[Any]]] = {
    NUMBER_SLIDER: _slider_value,
    BOOLEAN_TOGGLE: lambda node: [typed(node.container, "ToggleValue", False)],
    VALUE_LIST: _list_value,
    PANEL: _panel_value,
    BUTTON: lambda _: [False],
    GENE_POOL: _gene_values,
    DIGIT_SCROLLER: _own_number,
    CONTROL_KNOB: _own_number,
    SWATCH: lambda node: [stand_in.Color(*i.value) for i in node.container.items if i.type is Type.DRAWING_COLOR][:1],
}
"""What an object has by itself, where no wire reaches it."""


def hurried(given: Tree) -> Tree:
    """The settings of an Engine that also say fast, as nobody watches it move; those that say it themselves stay."""
    texts = given.values_in_order()
    try:
        found = json.loads(texts[0]) if texts else {"kind": "settings", "units": {}, "settings": {}}
    except (TypeError, ValueError):
        return given  # no settings; the Engine reports it
    if len(texts) > 1 or not isinstance(found, dict) or found.get("kind") != "settings":
        return given
    return Tree.of([json.dumps({"fast": True, **found})])
