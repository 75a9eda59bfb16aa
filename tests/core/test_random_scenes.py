"""Five hundred random scenes: forces and moments balance, and converged means converged.

`make test` runs a tenth of them; HOOKEAN_SOAK=1 all.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from hookean import Result, Scene, Status, relax
from serving import SOAK

from ..laws.evaluator import Evaluated, carried, evaluate
from ..laws.scenes import FAMILIES, random_scene

COUNT = 500 if SOAK else 50


@dataclass
class Outcome:
    """A scene, its result, and what the independent evaluator finds at the result's shape."""

    seed: int
    spec: dict[str, Any]
    result: Result
    found: Evaluated
    bends: bool


def run(seed: int) -> Outcome:
    """Relax the scene of a seed and evaluate the shape anew."""
    spec = random_scene(seed)
    result = relax(Scene.read(spec))
    plain = {**spec, "forces": [f for f in spec["forces"] if f["kind"] not in ("shell", "hinge", "bend")]}
    return Outcome(seed, spec, result, evaluate(plain, result.particles), len(plain["forces"]) < len(spec["forces"]))


@pytest.fixture(scope="module")
def outcomes() -> list[Outcome]:
    """All scenes, relaxed once."""
    return [run(seed) for seed in range(COUNT)]


def left_over(case: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Out-of-balance forces on free axes and what the floor carries, both by the independent evaluator."""
    contact = carried(case.spec["settings"].get("floor"), case.found, case.result.particles)
    return case.found.total * case.found.free + contact, contact


def supported(case: Outcome) -> np.ndarray:
    """Reactions, contacts, soft anchors and loads as the result tells them (n, 3)."""
    total = case.found.loads.copy()
    for told in (case.result.reactions, case.result.contacts):
        np.add.at(total, told["particles"], told["force"])
    for columns in case.result.forces:
        if columns["kind"] == "anchor_spring":
            np.add.at(total, columns["particles"][:, 0], columns["force"])
    return total


def bar(case: Outcome) -> float:
    """The force that a converged shape may be out of balance by, at one particle."""
    return max(case.spec["settings"]["tolerance"], case.result.rounding_floor) * case.found.scale


@pytest.mark.soak
def test_reactions_contacts_and_loads_sum_to_zero(outcomes: list[Outcome]) -> None:
    """Sum of reactions + contacts + soft anchors + loads = 0 in force and in moment, floors included.

    Internal forces cancel, so what is left is the sum of what free particles are out of balance by: n times the bar
    at most, times the reach for moments; 1e-12 of the sizes summed for rounding.
    """
    for case in outcomes:
        if not case.result.converged:
            continue
        x = case.result.particles - case.result.particles.mean(axis=0)
        total = supported(case)
        reach = float(np.linalg.norm(x, axis=1).max())
        rounding = 1e-12 * (np.abs(total).sum() + np.abs(case.found.internal).sum())
        allowed = len(x) * bar(case) + rounding
        assert np.linalg.norm(total.sum(axis=0)) <= allowed, case.seed
        assert np.linalg.norm(np.cross(x, total).sum(axis=0)) <= allowed * reach, case.seed


@pytest.mark.slow
def test_what_results_tell_balances_exactly_but_for_what_is_left(outcomes: list[Outcome]) -> None:
    """Reactions + contacts + soft anchors + loads = what free particles are out of balance by, to rounding.

    Converged or not: the sums close to 1e-11 of the sizes summed, seven digits beyond the tolerance.
    """
    for case in outcomes:
        if case.bends:
            continue
        x = case.result.particles - case.result.particles.mean(axis=0)
        left, _ = left_over(case)
        gap = supported(case) - left
        sizes = float(np.abs(case.found.internal).sum() + np.abs(gap).sum())
        reach = float(np.linalg.norm(x, axis=1).max())
        assert np.linalg.norm(gap.sum(axis=0)) <= 1e-11 * sizes, case.seed
        assert np.linalg.norm(np.cross(x, gap).sum(axis=0)) <= 1e-11 * sizes * reach, case.seed


@pytest.mark.slow
def test_converged_means_balanced(outcomes: list[Outcome]) -> None:
    """Converged: the residual recomputed by an evaluator of our own is <= max(tolerance, floor), to a part in 1e4."""
    for case in outcomes:
        if case.result.converged and not case.bends:
            left, _ = left_over(case)
            residual = np.linalg.norm(left, axis=1).max() / case.found.scale
            allowed = max(case.spec["settings"]["tolerance"], case.result.rounding_floor)
            assert residual <= allowed * (1 + 1e-4), case.seed


def test_the_floor_of_rounding_is_no_excuse(outcomes: list[Outcome]) -> None:
    """The rounding floor stays below the tolerance in all but a few: converged is not bought by a generous floor."""
    assert sum(c.result.rounding_floor > c.spec["settings"]["tolerance"] for c in outcomes) <= COUNT // 20


def test_anchors_hold_and_nothing_is_below_a_floor(outcomes: list[Outcome]) -> None:
    """Held axes are where they were, to the bit; no free particle is below a floor by more than 1e-12 of the size."""
    for case in outcomes:
        start, x = np.asarray(case.spec["particles"]), case.result.particles
        held = case.found.free == 0
        assert (x[held] == start[held]).all(), case.seed
        floor = case.spec["settings"].get("floor")
        if floor is not None:
            normal = np.asarray(floor["normal"]) / np.linalg.norm(floor["normal"])
            height = (x - floor["point"]) @ normal
            reach = (case.found.free * normal**2).sum(axis=1)
            assert height[reach > 1e-12].min() >= -1e-12 * (1.0 + np.abs(x).max()), case.seed


def test_result_columns_say_what_the_evaluator_says(outcomes: list[Outcome]) -> None:
    """Lengths and forces of springs in results: those of the independent evaluator, yielded ones included."""
    for case in outcomes:
        x = case.result.particles
        for force, columns in zip(case.spec["forces"], case.result.forces, strict=True):
            if force["kind"] != "springs":
                continue
            lengths = np.linalg.norm(x[force["particles"][:, 1]] - x[force["particles"][:, 0]], axis=1)
            assert np.abs(columns["length"] - lengths).max() <= 1e-12 * lengths.max()
            alone = evaluate({"particles": case.spec["particles"], "forces": [force]}, x)
            scale = np.abs(force["stiffness"]).max() * lengths.max()
            assert np.abs(np.abs(columns["force"]) - alone.element_sizes).max() <= 1e-11 * scale, case.seed


def test_nine_of_ten_scenes_converge(outcomes: list[Outcome]) -> None:
    """450 of 500; those that do not say why."""
    failed = [c for c in outcomes if c.result.status is not Status.CONVERGED]
    for case in failed:
        print(f"seed {case.seed} ({FAMILIES[case.seed % len(FAMILIES)]}): {case.result.message}")
    print(f"{COUNT - len(failed)} of {COUNT} random scenes converged")
    assert all("particle" in c.result.message for c in failed if c.result.status is Status.STALLED)
    assert COUNT - len(failed) >= 0.9 * COUNT


def test_every_kind_of_trouble_is_among_them(outcomes: list[Outcome]) -> None:
    """More than one element a scene is slack, cut off, yielded, and in contact with a floor: > 500 each of 500."""
    seen: Counter[str] = Counter()
    for case in outcomes:
        seen.update(slack=case.found.slack, cut=case.found.cut, yielded=case.found.yielded)
        seen.update(contact=int((left_over(case)[1] != 0).any(axis=1).sum()))
        seen.update(springs=sum(len(f["particles"]) for f in case.spec["forces"] if f["kind"] == "springs"))
    print(f"in {COUNT} scenes: " + ", ".join(f"{count} {name}" for name, count in seen.items()))
    assert min(seen[name] for name in ("slack", "cut", "yielded", "contact")) > COUNT


def test_stiffness_spans_four_decades(outcomes: list[Outcome]) -> None:
    """The scenes are as mixed as they say: the typical ratio of stiffnesses in one scene is over 1e3."""
    ratios = []
    for case in outcomes:
        k = np.concatenate([f["stiffness"] for f in case.spec["forces"] if f["kind"] == "springs"])
        ratios.append(k.max() / k.min())
    assert np.median(ratios) > 1e3


def test_the_evaluator_notices_a_shape_that_is_not_in_balance(outcomes: list[Outcome]) -> None:
    """Negative control: a free particle moved by 1e-3 of the size breaks the bar in every scene of springs."""
    for case in [c for c in outcomes if c.result.converged and not c.bends][:20]:
        x = case.result.particles.copy()
        particle = int(np.argmax(case.found.free.min(axis=1)))
        x[particle] += 1e-3 * np.ptp(x, axis=0).max()
        moved = evaluate(case.spec, x)
        left = moved.total * moved.free + carried(case.spec["settings"].get("floor"), moved, x)
        assert np.linalg.norm(left, axis=1).max() > 10.0 * bar(case), case.seed
