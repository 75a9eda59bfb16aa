"""What a result reports of a weight on a rope: forces, reactions, energy and carried geometry."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hookean import Scene, Simulation, relax
from hookean.scene.report import Report, Unmatched

ROPE: dict[str, Any] = {
    # particle 0 hangs at particle 1: 10 N / 100 N/m = 0.1 m below where the rope of 1 m has no force
    "particles": [[0, 0, -1], [0, 0, 0]],
    "masses": [2.0, 3.0],
    "forces": [
        {"kind": "springs", "name": "rope", "particles": [[0, 1]], "stiffness": 100, "rest_length": 1.0},
        {"kind": "unary", "particles": [0], "vector": [0, 0, -10]},
    ],
    "anchors": [{"name": "hook", "particles": [1]}],
    "meshes": {"flag": {"vertices": [[0, 0, -1], [0, 0, 0], [1, 0, 0]], "faces": [[0, 1, 2]]}},
    "geometry": [
        {"kind": "points", "name": "tip", "points": [[0, 0, -1], [9, 9, 9]]},
        {"kind": "lines", "lines": [[[0, 0, -1], [0, 0, 0]]]},
        {"kind": "mesh", "mesh": "flag"},
    ],
    "settings": {"tolerance": 1e-9},
}


def test_carried_geometry_moves_with_its_particles_and_the_rest_stays() -> None:
    tip, line, flag = relax(Scene.read(ROPE)).geometry
    assert tip["name"] == "tip" and tip["points"] == pytest.approx(np.array([[0, 0, -1.1], [9, 9, 9]]), abs=1e-9)
    assert line["lines"] == pytest.approx(np.array([[[0, 0, -1.1], [0, 0, 0]]]), abs=1e-9)
    assert flag["vertices"] == pytest.approx(np.array([[0, 0, -1.1], [0, 0, 0], [1, 0, 0]]), abs=1e-9)


def test_the_summary_names_forces_and_what_the_anchors_bear() -> None:
    assert relax(Scene.read(ROPE)).summary() == [
        "2 particles",
        "rope (springs): 1 elements, force 10 to 10 N",
        "unary: 1 elements, force 10 to 10 N",
        "1 reactions: largest 10 N, together (0, 0, 10) N",
    ]


def test_the_dict_is_json_with_the_same_numbers() -> None:
    """Lists, numbers and texts all the way down; of energies k u^2 / 2 = 0.5 J and -F z = -11 J."""
    result = relax(Scene.read(ROPE))
    told = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    assert told["particles"] == result.particles.tolist()
    assert told["geometry"][0] == {"name": "tip", "kind": "points", "points": result.geometry[0]["points"].tolist()}
    rope, load = told["forces"]
    assert (rope["kind"], rope["name"], rope["particles"]) == ("springs", "rope", [[0, 1]])
    assert rope["force"] == pytest.approx([10.0]) and load["force"] == [[0, 0, -10]]
    assert told["reactions"]["particles"] == [1] and told["reactions"]["names"] == ["hook"]
    assert told["reactions"]["force"][0] == pytest.approx([0, 0, 10])
    assert told["energy"]["springs"] == pytest.approx(0.5) and told["energy"]["kinetic"] == 0.0
    assert told["energy"]["total"] == pytest.approx(0.5 + told["energy"]["unary"])
    assert (told["status"], told["units"]) == ("converged", {"length": "m", "force": "N", "time": "s"})


def test_the_energy_of_motion_is_that_of_what_may_move() -> None:
    """m v^2 / 2 of the 2 kg at 3 m/s; the held 3 kg have none."""
    running = Simulation(Scene.read({**ROPE, "velocities": [[0, 3, 0], [0, 5, 0]]}))
    energy = running.result().energy
    assert energy["kinetic"] == pytest.approx(0.5 * 2.0 * 9.0)
    assert energy["total"] == pytest.approx(energy["springs"] + energy["unary"] + 9.0)


def test_a_point_that_met_nothing_has_a_nearest_particle_only_where_there_is_one() -> None:
    near, lost = (
        Unmatched("/forces/1/points/0", "", (1.0, 0.0, 0.0), 0, 0.25),
        Unmatched("/forces/2/points/0", "", (0.0,) * 3, -1, 0.0),
    )
    told = replace(relax(Scene.read(ROPE)), report=Report(unmatched=[near, lost])).to_dict()["report"]["unmatched"]
    assert [(u["pointer"], u["nearest"], u["distance"]) for u in told] == [
        ("/forces/1/points/0", 0, 0.25),
        ("/forces/2/points/0", None, None),
    ]


def test_each_component_is_listed_with_its_particles_and_loads() -> None:
    """Two ropes of two and of three particles that may move, and a loose pair that carries no load.

    The scale is the mean load: (1 + 3) / 2 N and 8 N. What may not move belongs to none.
    """
    x = [[0, 0, -z] for z in range(3)] + [[5, 0, -z] for z in range(4)] + [[9, 0, 0], [9, 0, -1]]
    forces = [
        {"kind": "springs", "particles": [[0, 1], [1, 2], [3, 4], [4, 5], [5, 6], [7, 8]]},
        {"kind": "unary", "particles": [1, 2, 6], "vector": [[0, 0, -1], [0, 0, -3], [0, 0, -8]]},
    ]
    result = relax(Scene(particles=x, forces=forces, anchors=[{"particles": [0, 3]}]))
    found = result.components
    assert found["first_particle"].tolist() == [1, 4, 7]
    assert found["particles"].tolist() == [2, 3, 2]
    assert found["supported"].tolist() == [True, True, False]
    assert found["loaded"].tolist() == [True, True, False]
    assert found["force_scale"][:2] == pytest.approx([2.0, 8.0])
    assert found["residual"] == pytest.approx(found["out_of_balance"] / found["force_scale"])
    errors = json.loads(json.dumps(result.to_dict(), allow_nan=False))["components"]["position_error"]
    assert np.isnan(found["position_error"]).all() and errors == [None] * 3  # the pair may lie anywhere
