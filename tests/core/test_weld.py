"""Welding: coordinates become particles, deterministically, and what meets none is told."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean import InputError, Scene
from hookean.system import compile
from hookean.weld import weld


def lines(*ends: tuple[float, float]) -> list[list[list[float]]]:
    return [[[a, 0, 0], [b, 0, 0]] for a, b in ends]


def test_particles_come_in_order_of_first_appearance():
    """Given particles first, unmerged; then the ends of lines as they come, within the tolerance the first wins."""
    scene = Scene(
        particles=[[5, 0, 0], [5, 0, 0]],
        forces=[
            {"kind": "springs", "lines": lines((1, 0), (0.0005, 5))},
            {"kind": "springs", "lines": lines((2, 1.0009))},
        ],
    )
    system = compile(scene)
    assert system.x[:, 0].tolist() == [5, 5, 1, 0, 2]
    assert system.groups[0].block.indices.tolist() == [[2, 3], [3, 0], [4, 2]]
    assert system.report.merged == 3


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(st.tuples(*[st.integers(0, 6)] * 3), min_size=1, max_size=40), st.sampled_from([0.0, 0.5, 1.1, 2.0]))
def test_welding_is_the_plain_greedy_rule(points: list[tuple[int, int, int]], tolerance: float):
    """Each point joins the first kept point within the tolerance, else it is kept: checked against two loops."""
    array = np.array(points, dtype=float)
    kept: list[np.ndarray] = []
    which = []
    for point in array:
        near = [i for i, other in enumerate(kept) if np.linalg.norm(point - other) <= tolerance]
        which.append(near[0] if near else len(kept))
        if not near:
            kept.append(point)
    found, index = weld(np.zeros((0, 3)), array, tolerance)
    assert found.tolist() == np.array(kept).tolist()
    assert index.tolist() == which


def test_loads_and_anchors_create_no_particles_and_are_told_when_they_miss():
    """A warning by default with the nearest particle and its distance; an error with strict."""
    scene = {
        "forces": [
            {"kind": "springs", "lines": lines((0, 1))},
            {"kind": "unary", "name": "wind", "points": [[1, 0, 0], [3, 4, 0]], "vector": [0, 0, 1]},
        ],
        "anchors": [{"name": "foot", "points": [[0, 0, 0.5]]}],
    }
    system = compile(Scene.read(scene))
    assert len(system.x) == 2
    anchor, load = sorted(system.report.unmatched, key=lambda u: u.pointer)
    assert (anchor.pointer, anchor.nearest, anchor.distance) == ("/anchors/0/points/0", 0, 0.5)
    assert (load.pointer, load.name, load.nearest) == ("/forces/1/points/1", "wind", 1)
    assert load.distance == pytest.approx(np.hypot(2, 4))
    assert system.load_count.tolist() == [0, 1]
    with pytest.raises(InputError, match="no particle at"):
        compile(Scene.read({**scene, "strict": True}))


def test_columns_must_fit_their_elements():
    """Every number of a force is one value or one for each element."""
    scene = Scene.read({"forces": [{"kind": "springs", "lines": lines((0, 1), (1, 2)), "stiffness": [1, 2, 3]}]})
    with pytest.raises(InputError) as caught:
        compile(scene)
    assert caught.value.pointer == "/forces/0/stiffness"
    assert "3 values for 2 elements" in caught.value.sentence


def test_springs_on_a_mesh_choose_its_edges():
    """all, warp, weft, naked, diagonals of a 2 x 1 quad mesh."""
    mesh = {
        "vertices": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]],
        "faces": [[0, 1, 4, 3], [1, 2, 5, 4]],
    }
    counts = {}
    for edges in ("all", "warp", "weft", "naked", "diagonals"):
        scene = Scene(meshes={"net": mesh}, forces=[{"kind": "springs", "mesh": "net", "edges": edges}])
        counts[edges] = len(compile(scene).groups[0].block.indices)
    assert sorted([counts.pop("warp"), counts.pop("weft")]) == [3, 4]
    assert counts == {"all": 7, "naked": 6, "diagonals": 4}


def test_a_spring_without_length_is_told():
    """Both ends weld to one particle: it does nothing, and the report says so."""
    system = compile(Scene(forces=[{"kind": "springs", "lines": lines((0, 1), (1, 1.0001))}]))
    assert any("start and end at one particle" in w for w in system.report.warnings)
