"""Factors so large that loads have no meaning: refused, and what has no value is never in equilibrium."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene
from hookean.system.balance import balance
from hookean.system.system import compile


def pulled(load: float = 1.0, factor: float = 1.0, **combinations: Any) -> Scene:
    """A cable of two lines with a load in its middle, which is in a case."""
    return Scene.read(
        {
            "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
            "forces": [
                {"kind": "springs", "particles": [[0, 1], [1, 2]], "axial_stiffness": 100, "force": 5},
                {"kind": "unary", "name": "P", "particles": [1], "vector": [0, 0, -load]},
            ],
            "anchors": [{"particles": [0, 2]}],
            "load_cases": {"a": {"forces": ["P"], "factor": factor}},
            "combinations": combinations,
        }
    )


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"factor": 1e300}, r"/load_cases/a/factor: 1e\+300 given; at most 1e\+12 allowed"),
        ({"ULS": {"a": -1e13}}, r"/combinations/ULS/a: -1e\+13 is larger than the limit, 1e\+12"),
        ({"ULS": {"a": float("inf")}}, "/combinations/ULS/a"),
        ({"ULS": {"prestress": float("nan")}}, "/combinations/ULS/prestress"),
    ],
)
def test_factors_have_the_limit_of_loads(given: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        pulled(**given)


def test_so_have_loads_times_their_factors() -> None:
    """1e9 and 1e6 are allowed, their product of 1e15 is not."""
    with pytest.raises(InputError, match=r"vector of P times 1e\+06 is larger than the limit, 1e\+12"):
        hookean.load_cases(pulled(1e9, 1e3, ULS={"a": 1e3}), ["ULS"])


def test_what_has_no_value_is_not_in_equilibrium() -> None:
    """A load of 1e300, whose square is infinite, beside which all rounding would be excused."""
    system = compile(pulled().replaced(load_cases={}))
    load = next(group for group in system.groups if group.cls.role == "load")
    load.block.parameters[:] *= 1e300
    found = balance(system, system.start())
    assert not np.isfinite(found.residual)
    assert not found.still(1e-6) and not found.met(1e-6)


def test_no_case_is_asked_for() -> None:
    with pytest.raises(InputError, match="cases: none given; give some of a, or leave it out for all"):
        hookean.load_cases(pulled(), [])
