from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean.discretize import duplicates as module
from hookean.discretize import remove_duplicate_lines, remove_duplicate_points, unique_lines, unique_points
from hookean.errors import InputError
from soak import examples

few = settings(derandomize=True, deadline=None, max_examples=examples(150))
# a coarse lattice with a fine shift: many coincide, many nearly do, none is within rounding of the tolerance
coordinate = st.tuples(st.integers(0, 3), st.sampled_from([0.0, 0.3, 0.55])).map(lambda c: c[0] + c[1])
point = st.tuples(coordinate, coordinate, st.sampled_from([0.0, 0.2]))
TOLERANCE = 0.41


def greedy(items: np.ndarray, same: Any) -> tuple[list[int], list[int]]:
    """The definition, item by item."""
    kept: list[int] = []
    place = []
    for i in range(len(items)):
        match = next((k for k, j in enumerate(kept) if same(items[i], items[j])), None)
        if match is None:
            match = len(kept)
            kept.append(i)
        place.append(match)
    return kept, place


def near(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.linalg.norm(a - b) <= TOLERANCE)


def same_line(a: np.ndarray, b: np.ndarray) -> bool:
    return (near(a[0], b[0]) and near(a[1], b[1])) or (near(a[0], b[1]) and near(a[1], b[0]))


@few
@given(st.lists(point, min_size=1, max_size=60))
def test_points_as_the_definition_says(points: list[Any]) -> None:
    xyz = np.array(points)
    kept, place = greedy(xyz, near)
    first, inverse = unique_points(xyz, TOLERANCE)
    assert first.tolist() == kept and inverse.tolist() == place
    assert np.array_equal(remove_duplicate_points(xyz, TOLERANCE), xyz[kept])


@few
@given(st.lists(st.tuples(point, point), min_size=1, max_size=40))
def test_lines_as_the_definition_says(lines: list[Any]) -> None:
    ends = np.array(lines)
    kept, place = greedy(ends, same_line)
    first, inverse = unique_lines(ends, TOLERANCE)
    assert first.tolist() == kept and inverse.tolist() == place
    assert np.array_equal(remove_duplicate_lines(ends, TOLERANCE), ends[kept])


@few
@given(st.lists(st.tuples(point, point), min_size=1, max_size=40))
def test_zero_tolerance_drops_equal_lines_only(lines: list[Any]) -> None:
    kept = list(dict.fromkeys(frozenset([a, b]) for a, b in lines))
    assert len(remove_duplicate_lines(np.array(lines), 0.0)) == len(kept)


def test_blocks_of_any_size_give_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(3)
    points = np.concatenate([rng.normal(0, 0.02, (400, 3)), rng.uniform(-1, 1, (400, 3))])[rng.permutation(800)]
    whole = unique_points(points, 0.05)
    monkeypatch.setattr(module, "_MOST_NEIGHBOURS", 10)
    for a, b in zip(whole, unique_points(points, 0.05), strict=True):
        assert np.array_equal(a, b)
    kept, place = greedy(points, lambda a, b: np.linalg.norm(a - b) <= 0.05)
    assert whole[0].tolist() == kept and whole[1].tolist() == place


@pytest.mark.soak
def test_a_hundred_thousand_lines_given_twice_and_turned() -> None:
    rng = np.random.default_rng(1)
    lines = rng.uniform(0, 10, (50_000, 2, 3))
    again = lines[:, ::-1] + rng.uniform(-1e-8, 1e-8, lines.shape)
    first, inverse = unique_lines(np.concatenate([lines, again]), 1e-6)
    assert np.array_equal(first, np.arange(50_000))
    assert np.array_equal(inverse, np.tile(np.arange(50_000), 2))


@pytest.mark.slow
def test_many_points_in_few_places() -> None:
    rng = np.random.default_rng(2)
    places = rng.uniform(0, 1, (5, 3))
    points = np.repeat(places, 4000, axis=0) + rng.uniform(-1e-9, 1e-9, (20_000, 3))
    first, inverse = unique_points(points, 1e-6)
    assert first.tolist() == [0, 4000, 8000, 12000, 16000]
    assert np.array_equal(inverse, np.repeat(np.arange(5), 4000))


def test_first_wins_with_its_own_direction_and_signed_zeros() -> None:
    a, b = [0.0, 0, 0], [1.0, 0, 0]
    assert remove_duplicate_lines([[b, a], [a, b], [[-0.0, 0, 0], b]], 0.0).tolist() == [[b, a]]
    assert remove_duplicate_points(np.zeros((0, 3)), 1.0).shape == (0, 3)
    assert remove_duplicate_lines([], 1.0).shape == (0, 2, 3)


def test_a_chain_is_thinned_from_its_start() -> None:
    points = np.c_[np.arange(7) * 0.6, np.zeros((7, 2))]
    assert unique_points(points, 1.0)[0].tolist() == [0, 2, 4, 6]
    assert unique_points(points[::-1], 1.0)[0].tolist() == [0, 2, 4, 6]


@pytest.mark.parametrize(
    ("call", "given_", "tolerance", "says"),
    [
        (f, *case)
        for f, case in itertools.chain(
            (
                (remove_duplicate_points, c)
                for c in [
                    (np.zeros((3, 2)), 1.0, "shape"),
                    ([[0, 0, np.nan]], 1.0, "^points/0: it is not finite"),
                    (np.zeros((3, 3)), -1.0, "^tolerance"),
                    (np.zeros((3, 3)), np.nan, "^tolerance"),
                    ("ab", 1.0, "shape"),
                ]
            ),
            (
                (remove_duplicate_lines, c)
                for c in [
                    (np.zeros((3, 3)), 1.0, "shape"),
                    ([[[0, 0, 0], [np.inf, 0, 0]]], 1.0, "^lines/0: it is not finite"),
                ]
            ),
        )
    ],
)
def test_bad_input_gets_a_sentence(call: Any, given_: Any, tolerance: float, says: str) -> None:
    with pytest.raises(InputError, match=says):
        call(given_, tolerance)
