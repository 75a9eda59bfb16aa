"""Sweeps: what their items are, and that a row depends on the scene and the patch alone."""

from __future__ import annotations

import itertools
import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean import InputError, Scene, relax
from hookean.running.sweep import MOST, Sweep, Table, columns, parameters, solve
from soak import examples

NET: dict[str, Any] = {
    "particles": [[float(i), 0.0, 0.1 * (i % 2)] for i in range(6)],
    "forces": [
        {"kind": "springs", "name": "net", "particles": [[i, i + 1] for i in range(5)], "stiffness": 50.0},
        {"kind": "unary", "name": "load", "particles": [1, 2, 3, 4], "vector": [0.0, 0.0, -2.0]},
        {"kind": "hinge", "particles": [[0, 1, 2, 3]], "strength": 1.0},
    ],
    "anchors": [{"name": "ends", "particles": [0, 5]}],
}
SCENE = Scene.read(NET)
TABLE = Table(SCENE)
numbers = st.floats(0.25, 4.0)
patches = st.fixed_dictionaries(
    {},
    optional={
        "forces": st.fixed_dictionaries(
            {},
            optional={
                "net": st.fixed_dictionaries({"stiffness": numbers.map(lambda n: 50 * n), "rest_factor": numbers}),
                "load": st.fixed_dictionaries({"vector": st.tuples(numbers, numbers, numbers).map(list)}),
            },
        ),
        "move": st.just([{"anchor": "ends", "shift": [0.0, 0.0, 0.5]}]),
        "release": st.just([5]),
        "settings": st.fixed_dictionaries({"tolerance": st.sampled_from([1e-3, 1e-6]), "max_iterations": st.just(300)}),
    },
)


def text(row: dict[str, Any]) -> str:
    return json.dumps(row, allow_nan=False)


@given(st.lists(st.lists(numbers, min_size=1, max_size=4), min_size=1, max_size=3))
def test_a_product_has_every_value_with_every_other_the_last_fastest(lists: list[list[float]]) -> None:
    names = ["stiffness", "rest_factor", "damping"][: len(lists)]
    sweep = Sweep.read({"forces": {"net": dict(zip(names, lists, strict=True))}})
    expected = [dict(zip(names, values, strict=True)) for values in itertools.product(*lists)]
    assert [sweep.patch(i)["forces"]["net"] for i in range(sweep.count)] == expected
    assert sweep.names == [f"net.{name}" for name in names]


def test_zip_pairs_the_lists() -> None:
    sweep = Sweep.read({"forces": {"net": {"stiffness": [1, 2]}}, "settings": {"tolerance": [0.1, 0.2]}, "mode": "zip"})
    assert [sweep.patch(i) for i in range(sweep.count)] == [
        {"forces": {"net": {"stiffness": 1}}, "settings": {"tolerance": 0.1}},
        {"forces": {"net": {"stiffness": 2}}, "settings": {"tolerance": 0.2}},
    ]


def test_patches_may_be_listed() -> None:
    listed = [{}, {"release": [5]}, {"forces": {"net": {"stiffness": 7}}, "settings": {"drag": 2}}]
    sweep = Sweep.read({"patches": listed})
    assert [sweep.patch(i) for i in range(sweep.count)] == listed
    assert sweep.names == ["net.stiffness", "settings.drag"]
    assert parameters(listed[2]) == {"net.stiffness": 7, "settings.drag": 2}
    for beyond in (-1, 3):
        with pytest.raises(IndexError):
            sweep.patch(beyond)


@pytest.mark.parametrize(
    ("value", "pointer", "said"),
    [
        ({}, "/", "needs lists of values"),
        ({"forces": {"net": {"stiffness": []}}}, "/forces/net/stiffness", "at least one"),
        ({"forces": {"a/b": {"stiffness": []}}}, "/forces/a~1b/stiffness", "at least one"),
        ({"forces": {"net": {"stiffness": 3}}}, "/forces/net/stiffness", "a list expected"),
        ({"settings": {"drag": [1], "tolerance": [0.1, 0.2]}, "mode": "zip"}, "/settings/tolerance", "2 values"),
        ({"mode": "other", "settings": {"drag": [1]}}, "/mode", "product"),
        ({"patches": []}, "/patches", "at least one"),
        ({"patches": [{}], "settings": {"drag": [1]}}, "/patches", "either"),
        ({"forces": {"net": {"stiffness": [1] * 400, "damping": [1] * 400}}}, "/", f"at most {MOST}"),
        ({"loads": {}}, "/loads", "no field"),
        ([], "/", "expected"),
    ],
)
def test_faults_have_a_place_and_a_sentence(value: Any, pointer: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        Sweep.read(value)
    assert caught.value.pointer == pointer
    assert said in caught.value.sentence


def test_counting_a_huge_sweep_costs_nothing() -> None:
    long = list(range(1000))
    with pytest.raises(InputError, match="1000000000000000 items"):
        Sweep.read({"settings": dict.fromkeys("abcde", long)})


@pytest.mark.soak
@settings(max_examples=examples(12), deadline=None)
@given(st.lists(patches, min_size=1, max_size=4), st.data())
def test_a_row_is_the_same_whatever_was_solved_before(several: list[dict[str, Any]], data: st.DataObject) -> None:
    first = [text(TABLE.row(patch)) for patch in several]
    order = data.draw(st.permutations(range(len(several))))
    with pytest.raises(InputError):
        TABLE.row({"forces": {"net": {"stiffness": -1.0}}})
    again = {i: text(TABLE.row(several[i])) for i in order}
    assert [again[i] for i in range(len(several))] == first
    assert text(solve(Scene.read(NET), several[0])) == first[0]


@settings(max_examples=examples(20), deadline=None)
@given(numbers, numbers, st.tuples(numbers, numbers, numbers))
def test_a_row_is_that_of_the_scene_with_these_values(
    stiffness: float, factor: float, vector: tuple[float, ...]
) -> None:
    net, load, hinge = NET["forces"]
    changed = {
        **NET,
        "forces": [
            {**net, "stiffness": 50 * stiffness, "rest_factor": factor}, {**load, "vector": list(vector)}, hinge,
        ],
    }  # fmt: skip
    values = {"net": {"stiffness": 50 * stiffness, "rest_factor": factor}, "load": {"vector": list(vector)}}
    row = TABLE.row({"forces": values})
    result = relax(Scene.read(changed))
    assert (row["status"], row["message"], row["iterations"]) == (result.status, result.message, result.iterations)
    assert row["residual"] == result.residual
    assert row["energy"] == result.energy["total"]
    assert row["forces"]["net"] == [min(result.force("net")["force"]), max(result.force("net")["force"])]
    assert row["displacement"] == np.linalg.norm(result.particles - np.array(NET["particles"]), axis=1).max()
    assert row["reaction"] == np.linalg.norm(result.reactions["force"], axis=1).max()


def test_the_figures_of_a_hanging_spring() -> None:
    spring = {
        "units": {"length": "cm"},
        "particles": [[0, 0, 0], [0, 0, -80]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1]], "stiffness": 2.0},
            {"kind": "unary", "particles": [1], "vector": [0, 0, -100]},
        ],
        "anchors": [{"particles": [0]}],
    }
    scene = Scene.read(spring)
    row = solve(scene, {})
    assert row["forces"]["springs"] == pytest.approx([100.0, 100.0])
    assert row["displacement"] == pytest.approx(50.0)
    assert row["reaction"] == pytest.approx(100.0)
    assert row["energy"] == pytest.approx(0.5 * 2.0 * 50.0**2 - 100.0 * 50.0 + relative(scene))
    twice = solve(scene, {"forces": {"1": {"vector": [0, 0, -200]}}})
    assert twice["displacement"] == pytest.approx(100.0)
    assert dict(columns(scene)) == {
        "iterations": "", "residual": "-", "energy": "N cm", "displacement": "cm", "reaction": "N",
        "springs.smallest": "N", "springs.largest": "N", "unary.smallest": "N", "unary.largest": "N",
    }  # fmt: skip


def relative(scene: Scene) -> float:
    """The energy of the load at the start: it counts from the origin."""
    return float(-np.array([0, 0, -100.0]) @ np.array([0, 0, -80.0]))


def test_columns_are_those_of_rows() -> None:
    assert [name for name, _ in columns(SCENE)][5:] == [
        f"{name}.{end}" for name in TABLE.row({})["forces"] for end in ("smallest", "largest")
    ]
    twins = Scene.read({**NET, "forces": [NET["forces"][0], NET["forces"][0]]})
    assert list(solve(twins, {})["forces"]) == ["net", "net (force 1)"]


def test_a_row_that_diverges_is_still_json() -> None:
    loose = {**NET, "anchors": [], "settings": {"solver": "verlet", "time_step": 10.0}}
    row = solve(Scene.read(loose), {})
    assert row["status"] == "diverged"
    assert json.loads(text(row)) == row


def test_an_item_can_be_cancelled_and_the_next_one_is_right() -> None:
    expected = text(TABLE.row({}))
    slow = {"settings": {"tolerance": 0, "max_iterations": 10**8, "solver": "verlet"}}
    assert TABLE.row(slow, lambda: True)["status"] == "cancelled"
    assert text(TABLE.row({})) == expected
