"""`_all_particles_` of Settings: what forces act on becomes particles, merged within the tolerance."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from canvas.canvasing import Bench, point
from hookean_canvas.run import stand_in
from hookean_client import canvas
from hookean_client.canvas_scene import compose, distinct, read

NEAR = st.sampled_from([0.0, 0.004, 0.008, 0.079, 0.0801, 0.085, 1.0, -0.003, -0.085])


@pytest.fixture(scope="module", autouse=True)
def rhino() -> Iterator[None]:
    made = stand_in.Canvas().install()
    yield
    made.remove()


@given(st.lists(st.tuples(NEAR, NEAR, NEAR), max_size=30))
def test_points_within_the_tolerance_of_one_before_are_left_out(places: list[tuple[float, float, float]]) -> None:
    """As a search among all that are kept finds them; cells are 8 tolerances wide, so 0.08 is a border."""
    kept: list[list[float]] = []
    for place in places:
        if all(sum((p - q) ** 2 for p, q in zip(place, one, strict=True)) > 0.01**2 for one in kept):
            kept.append(list(place))
    assert distinct([list(place) for place in places], 0.01) == kept


@pytest.mark.parametrize("every", [True, False])
def test_loads_alone_make_particles_only_where_settings_say_so(every: bool) -> None:
    bench = Bench()
    vector = [stand_in.Vector3d(0, 0, 1)]
    text = canvas.force(bench.component("Load"), "unary", points=[point(0, 0, 0), point(0, 0, 0.5)], vector=vector)
    found: dict[str, Any] = json.loads(canvas.settings(bench.component("Settings"), all_particles=every))
    scene = compose(read([text], None, "_forces"), [], found, [])
    assert scene.get("particles") == ([[0, 0, 0], [0, 0, 0.5]] if every else None)
