"""What sliders and lists hold by themselves, with the expressions that people put on them."""

from __future__ import annotations

import json
import math
from typing import Any
from uuid import uuid4

import pytest

from canvas.kangaroo_samples import PLUGIN, Kangaroo
from hookean.errors import InputError
from hookean_canvas.archive import Type
from hookean_canvas.definitions.write import Definition
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from hookean_canvas.run.trees import Tree
from hookean_canvas.run.values import hurried


def shown(d: Definition, **settings: str) -> list[Any]:
    """What the panel of a definition shows."""
    return Canvas(graph.of(d.archive()), settings).run().panels["found"].values_in_order()


def test_an_expression_on_a_slider_acts_on_its_value_and_on_one_that_is_set() -> None:
    d = Definition("slid", "Slid", "A slider with an expression.")
    slider = d.slider("Angle", 90, 0, 180)
    slider.container.put("InternalExpression", Type.STRING, "x*Pi/180")
    d.panel("found", slider)
    assert shown(d) == [pytest.approx(math.pi / 2)]
    assert shown(d, Angle="180") == [pytest.approx(math.pi)]


@pytest.mark.parametrize(
    ("expression", "value"),
    [("2*Pi", 2 * math.pi), ("3", 3), ('"3"', "3"), ("true", True), ("1/4", 0.25), ("not this", "not this")],
)  # fmt: skip
def test_an_item_of_a_list_is_what_its_expression_gives_or_a_text(expression: str, value: Any) -> None:
    d = Definition("listed", "Listed", "A list of values.")
    d.panel("found", d.choice("Size", {"one": expression}, "one"))
    found = shown(d)
    assert found == ([pytest.approx(value)] if isinstance(value, float) else [value])


def test_settings_of_an_engine_say_fast_unless_they_speak_of_it_themselves() -> None:
    text = json.dumps({"kind": "settings", "units": {}, "settings": {"drag": 2.0}})
    (found,) = hurried(Tree.of([text])).values_in_order()
    assert json.loads(found) == {"kind": "settings", "units": {}, "settings": {"drag": 2.0}, "fast": True}
    assert json.loads(hurried(Tree()).values_in_order()[0])["fast"] is True
    slow = Tree.of([json.dumps({"kind": "settings", "units": {}, "settings": {}, "fast": False})])
    assert json.loads(hurried(slow).values_in_order()[0])["fast"] is False
    for odd in (Tree.of(["no settings"]), Tree.of([3]), Tree.of([text, text]), Tree.of(['{"kind": "springs"}'])):
        assert hurried(odd) == odd


@pytest.mark.parametrize(
    ("name", "library", "sentence"),
    [
        ("MD Slider", None, "how files store its values is not published; put them on a panel instead"),
        ("Solid Union", None, "it needs Rhino's kernel"),
        ("C# Script", None, "its code is not Python"),
        ("PlanktonMesh", "PlanktonGh 0.4.1", "the plug-in PlanktonGh 0.4.1 has no stand-in"),
        ("Unheard Of", None, "has no stand-in"),
    ],
)
def test_what_cannot_run_is_named_with_its_reason_or_its_plug_in(name: str, library: str | None, sentence: str) -> None:
    d = Kangaroo("strange", "Strange", "An object that cannot run.")
    d.panel("found", d.foreign(name, ["In"]) if library else d.native_like(name, str(uuid4()), ["In"], "Out"))
    root = d.archive()
    listed = root.chunk("Definition").chunk("GHALibraries")  # type: ignore[union-attr]
    for one in listed.chunks if listed is not None else ():
        if one.value("Id") == PLUGIN:
            one.put("Name", Type.STRING, "PlanktonGh").put("Version", Type.STRING, "0.4.1")
    with pytest.raises(InputError, match=f"1 x {name}.*{sentence}"):
        Canvas(graph.of(root))
