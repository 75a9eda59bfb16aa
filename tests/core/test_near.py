"""Few points are found as a tree finds them, and a scene of few points is welded without scipy."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from hookean.values.near import FEW, Few, tree
from serving import HANG

# whole coordinates: distances are roots of whole numbers, which both sides round the same way
spots = st.lists(st.tuples(*[st.integers(-3, 3)] * 3), min_size=1, max_size=30)


@given(spots, spots, st.integers(0, 4))
def test_few_points_answer_as_a_tree_does(points, places, radius):
    """The same distances, and the same points within a radius; of equally near points the first."""
    points, places = np.array(points, dtype=float), np.array(places, dtype=float)
    few, whole = Few(points), cKDTree(points)
    distances, which = few.query(places, 2)
    expected, _ = whole.query(places, 2)
    assert (distances == expected).all()
    for place, row, found in zip(places, distances, which, strict=True):
        assert sorted(few.query_ball_point(place, radius)) == sorted(whole.query_ball_point(place, radius))
        assert found[0] == min(few.query_ball_point(place, row[0]))
    if len(points) == 1:
        assert (which[:, 1] == 1).all() and np.isinf(distances[:, 1]).all()


def test_many_points_are_left_to_scipy():
    assert isinstance(tree(np.zeros((FEW, 3))), Few)
    assert isinstance(tree(np.zeros((FEW + 1, 3))), cKDTree)


@pytest.mark.slow
def test_a_small_scene_of_lines_compiles_without_scipy():
    code = (
        "import sys; from hookean import Scene; from hookean.system.system import compile\n"
        "lines = [[[i, 0, 0], [i + 1, 0, 0]] for i in range(50)]\n"
        "system = compile(Scene(forces=[{'kind': 'springs', 'lines': lines}], anchors=[{'points': [[0, 0, 0]]}]))\n"
        "assert len(system.x) == 51 and list(system.held[0].particles) == [0]\n"
        "assert not any(name.startswith('scipy') for name in sys.modules)"
    )
    warm = code.rpartition("\n")[0]  # the first process of a new cache compiles, with numba, which imports scipy
    for each in (warm, code):
        subprocess.run([sys.executable, "-c", each], check=True, timeout=HANG)
