"""Tables of results: what the rows of a file of comma-separated values add up to."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hookean
from hookean import Scene
from hookean.files import limits as limit_file
from hookean.files import tables
from hookean.forces import KINDS
from hookean.system.system import compile

LIFTED = {
    "particles": [[0, 0, 0], [2, 0, 1.5], [0, 2, 1.5], [3, 3, 0], [1, 1, 0], [1.5, 0, 0.4]],
    "forces": [
        {"kind": "springs", "particles": [[1, 4], [2, 4], [3, 4], [4, 5]], "stiffness": 20, "rest_factor": 0.9},
        {"kind": "unary", "name": "crate", "particles": [4], "vector": [1, 2, -60]},
        {"kind": "unary", "name": "wind", "particles": [5], "vector": [0.5, 0, 1]},
        {"kind": "self_weight", "particles": [4, 5], "total": 0.4},
        {"kind": "support", "name": "soil", "particles": [3], "stiffness": [300, 200, 500]},
        {"kind": "floor", "name": "ground", "static_friction": 1.0},
        {"kind": "floor", "name": "wall", "point": [9, 0, 0], "normal": [-1, 0, 0]},
    ],
    "anchors": [{"name": "top", "particles": [1, 2]}, {"name": "rail", "particles": [5], "axes": "y"}],
}  # fmt: skip


def rows(path: Path) -> list[dict[str, Any]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_loads_and_what_supports_and_floors_carry_add_up_to_zero(tmp_path: Path) -> None:
    """Forces in the file balance to the residual, and so do the moments about the origin; what the floor carries is a
    row with its name, and is as the result has it."""
    result = hookean.relax(Scene.read(LIFTED))
    assert result.converged
    result.save(tmp_path / "lifted.csv")
    loads = {kind for kind, force in KINDS.items() if force.role == "load"}
    outside = [row for row in rows(tmp_path / "lifted.csv") if row["kind"] in {*loads, "reaction", "contact"}]
    force = np.array([[float(row[f"force {axis} [N]"]) for axis in "xyz"] for row in outside])
    at = np.array([[float(row[f"{axis} [m]"]) for axis in "xyz"] for row in outside])
    most = 2.0 * result.residual * np.abs(force).sum() + 1e-12  # of each of the free particles
    assert np.abs(force.sum(axis=0)).max() < most and np.abs(np.cross(at, force).sum(axis=0)).max() < 3.0 * most
    (ground,) = (row for row in outside if row["kind"] == "contact")
    assert ground["force"] == "ground" and ground["particles"] == "4" and float(ground["force z [N]"]) > 40.0
    assert [float(ground[f"force {axis} [N]"]) for axis in "xyz"] == result.contacts["force"][0].tolist()
    assert {row["force"] for row in outside if row["kind"] == "reaction"} == {"top", "soil", "rail"}


def test_a_particle_in_a_corner_has_the_names_of_both_floors() -> None:
    """One that is pushed into a corner; another one lies on the ground alone."""
    spec = {
        "particles": [[0, 0, 0], [1, 0, 0]],
        "forces": [
            {"kind": "unary", "particles": [0, 1], "vector": [[-1, 0, -2], [0, 0, -3]]},
            {"kind": "floor", "name": "ground"},
            {"kind": "floor", "name": "wall", "normal": [1, 0, 0]},
        ],
    }
    scene = Scene.read(spec)
    result, system = hookean.relax(scene), compile(scene)
    (part,) = (part for part in tables.sections(system, result) if part.kind == "contact")
    assert part.names == ["ground, wall", "ground"] and part.columns["force"].tolist() == [[1, 0, 2], [0, 0, 3]]


@pytest.mark.parametrize(("limit", "count"), [(44.0, 1), (1e3, 0)])
def test_a_limit_of_reactions_holds_for_floors(limit: float, count: int) -> None:
    """The floor carries more than any support, so that it is what exceeds the limit."""
    scene = Scene.read(LIFTED)
    result = hookean.relax(scene)
    carried = np.linalg.norm(result.contacts["force"], axis=1).max()
    assert np.linalg.norm(result.reactions["force"], axis=1).max() < 44.0 < carried < 1e3
    system = compile(scene)
    said = limit_file.exceeded({"max_reaction": limit}, tables.sections(system, result), system, result)
    assert said == [f"model: max reaction {carried:.6g} N at particle 4 exceeds the limit 44 N"] * count
