"""Clamped lengths: ropes that go slack, struts that lose contact, and limits in the wrong order."""

from __future__ import annotations

from typing import Any

import pytest

from hookean import InputError, Scene, relax


def hung(weight: float, start: float = 1.0, **columns: Any) -> Any:
    """A line downwards from an anchor with a weight at its end, and a weak spring (k = 1, rest length 1) beside it."""
    return relax(
        Scene(
            particles=[[0, 0, 0], [0, 0, -start]],
            forces=[
                {"kind": "clamp_length", "particles": [[0, 1]], "name": "line", "stiffness": 200.0, **columns},
                {"kind": "springs", "particles": [[0, 1]], "stiffness": 1.0, "rest_length": 1.0},
                {"kind": "unary", "particles": [1], "vector": [0, 0, -weight]},
            ],
            anchors=[{"particles": [0]}, {"particles": [1], "axes": "xy"}],
            settings={"tolerance": 1e-10},
        )
    )


@pytest.mark.parametrize(
    ("weight", "start", "length"),
    [
        (100.0, 1.0, (100.0 + 200.0 * 1.3 + 1.0) / 201.0),  # P = k (l - 1.3) + (l - 1)
        (0.2, 1.0, 1.2),  # free: the spring alone
        (-0.1, 1.0, 0.9),
        (-80.0, 0.5, (-80.0 + 200.0 * 0.8 + 1.0) / 201.0),  # the same; from above it would run past the anchor
    ],
)
def test_a_weight_stretches_a_line_beyond_its_limit(weight: float, start: float, length: float) -> None:
    """l = hi + (P - what the spring carries) / k above, the same with lo below; between them no force."""
    found = hung(weight, start, lower_limit=0.8, upper_limit=1.3)
    line = found.force("line")
    assert found.converged
    assert line["length"][0] == pytest.approx(length, abs=1e-9)
    assert line["force"][0] == pytest.approx(weight - (length - 1.0), abs=1e-7)


def test_by_default_it_is_a_rope_of_its_start_length() -> None:
    """Taut above the start length, slack below it."""
    assert hung(50.0).force("line")["length"][0] == pytest.approx((50.0 + 201.0) / 201.0, abs=1e-9)
    slack = hung(-0.3).force("line")
    assert slack["length"][0] == pytest.approx(0.7, abs=1e-9) and slack["force"][0] == 0.0


def test_a_limit_of_zero_is_none() -> None:
    """Only a lower limit: free upwards however far."""
    found = hung(4.0, lower_limit=0.9, upper_limit=0.0)
    assert found.force("line")["length"][0] == pytest.approx(5.0, abs=1e-8)
    assert hung(-40.0, lower_limit=0.9, upper_limit=0.0).force("line")["length"][0] == pytest.approx(
        (-40.0 + 200.0 * 0.9 + 1.0) / 201.0, abs=1e-9
    )


def test_limits_in_the_wrong_order_are_refused() -> None:
    said = r"/forces/0/lower_limit: 2 given, above the upper limit, 1.5; exchange them"
    with pytest.raises(InputError, match=said):
        hung(1.0, lower_limit=2.0, upper_limit=1.5)
    with pytest.raises(InputError, match="/forces/0/lower_limit: 2 given"):
        hung(1.0, lower_limit=[2.0], upper_limit=1.5)
    with pytest.raises(InputError, match="/forces/0/upper_limit: -1 given; at least 0 allowed"):
        hung(1.0, upper_limit=-1.0)
