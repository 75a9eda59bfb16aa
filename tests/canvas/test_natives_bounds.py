"""Natives asked for too much, expressions that grow without end, nulls among points: refused in a sentence.

What is asked for would need hours or more memory than there is, so that a test ends only where it is refused.
"""

from __future__ import annotations

from typing import Any

import pytest

from canvas.native_values import called as run
from canvas.natives_table import XY
from canvas.test_evaluate import ran
from hookean_canvas.archive import Type
from hookean_canvas.definitions.write import Definition
from hookean_canvas.run.natives import Unfit
from hookean_canvas.run.natives.expressions import evaluated

MANY = 10**12
CURVE = [(0, 0, 0), (1, 0, 0)]
SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 0)]


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("Series", (0.0, 1.0, MANY)), ("Range", (("domain", 0, 1), MANY)), ("Repeat Data", ([1], MANY)),
        ("Duplicate Data", ([1, 2], MANY, True)), ("Duplicate Data", ([1, 2], MANY, False)),
        ("Stack Data", ([1], [MANY])), ("Sub List", ([1], ("domain", 0, 1e12), True)),
        ("Cross Reference", ([1] * 2000, [2] * 2000)), ("Divide Domain", (("domain", 0, 1), MANY)),
        ("Divide Curve", (CURVE, MANY, False)), ("Divide Length", (CURVE, 1e-12)), ("Divide Distance", (CURVE, 1e-12)),
        ("Polygon", (XY, 1.0, MANY, 0.0)), ("Mesh Sphere", (XY, 1.0, MANY, 3)), ("Mesh Plane", (SQUARE, MANY, 1)),
        ("Rectangular", (XY, 1.0, 1.0, 10**4, 10**4)), ("Hexagonal", (XY, 1.0, 1, MANY)),
        ("Triangular", (XY, 1.0, MANY, 1)), ("Radial", (XY, 1.0, 10**4, 10**4)),
        ("Linear Array", (("mesh", SQUARE[:3], [(0, 1, 2)]), ("vector", 1, 0, 0), MANY)),
    ],
)  # fmt: skip
def test_more_than_a_million_items_are_refused(name: str, given: Any) -> None:
    with pytest.raises(Unfit, match="makes more than 1000000 items"):
        run(name, *given)


@pytest.mark.parametrize("text", ["sqr(" * 150 + "9" + ")" * 150, "cube(" * 150 + "9" + ")" * 150, "9^9^9"])
def test_a_power_beyond_floating_point_is_an_error_in_one_short_sentence(text: str) -> None:
    with pytest.raises(Unfit, match="has no value") as caught:
        evaluated(text, {})
    assert len(str(caught.value)) < 200


def test_rounding_to_any_number_of_digits_ends() -> None:
    assert evaluated("round(5, -10^9)", {}) == 0.0
    assert evaluated("round(5.25, 10^9)", {}) == 5.25


def test_products_of_whole_numbers_are_exact_up_to_1024_bits_and_in_floating_point_beyond() -> None:
    assert evaluated("2^500 * 2^500", {}) == 2**1000
    assert evaluated("-2^600 * 3 * 1", {}) == -3 * 2**600
    with pytest.raises(Unfit, match="has no value"):
        evaluated("2^1000 * 2^1000", {})


def test_nulls_among_points_are_an_error_of_the_component() -> None:
    d = Definition("null", "Null", "A point of a list is missing.")
    missing = d.native("List Item", list=d.parameter("Number", "Numbers", [1.0]), index=5, wrap=False)
    d.panel("fit", d.native("Plane Fit", points=missing)["Plane"])
    found = ran(d)
    assert [m.level for m in found.messages if m.component == "PlFit"] == ["error"]


def test_an_expression_on_an_input_without_a_value_is_an_error_of_the_component() -> None:
    d = Definition("odd", "Odd", "An expression that divides by zero.")
    negative = d.native("Negative", value=d.parameter("Number", "Numbers", [2.0]))
    negative.inputs["value"][1].put("InternalExpression", Type.STRING, "x / 0")
    d.panel("found", negative)
    (said,) = ran(d).messages
    assert said.level == "error" and "has no value" in said.text
