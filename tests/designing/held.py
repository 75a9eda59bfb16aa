"""Scenes of one force each, held softly at every particle so that there is one equilibrium near the start."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.designing.problem import Problem
from hookean.forces import KINDS, Force
from hookean.scene.scene import Scene
from hookean.system.system import compile
from laws.cases import scene_of

FLAT = ("damping", "upper_cutoff", "lower_cutoff", "cutoff", "plasticity", "yield_extension", "limit", "sticky")
"""Columns that change nothing at rest, or at a jump alone; yielding is switched off."""

FLEEING = {"power_law"}  # the nearer, the more it repels: a soft hold lets go


def columns(force: Force) -> list[str]:
    """The columns of a force that are numbers and that an equilibrium depends on smoothly."""
    found = []
    for name in type(force).model_fields:
        value = getattr(force, name)
        number = isinstance(value, float | np.ndarray) and np.asarray(value).dtype.kind == "f"
        if number and name not in (*FLAT, "particles", "points", "lines"):
            found.append(name)
    return found


def held(kind: str, seed: int) -> dict[str, Any]:
    """The example of a kind on soft supports at all its particles, under random loads."""
    rng = np.random.default_rng(seed)
    force, x = KINDS[kind].example()
    elastic = {name: 0.0 for name in ("plasticity", "yield_extension", "limit") if name in type(force).model_fields}
    force = force.model_copy(update={"name": "it", **elastic})
    scene = scene_of(force, x)
    system = compile(scene)
    firm = 3.0 if type(force).conservative and kind not in FLEEING else 30.0  # what has no energy swirls out of a hold
    stiffness = firm * float(system.evaluate(system.start())[1].max(initial=0.0)) or 1.0
    reach = float(np.ptp(x, axis=0).max()) or 1.0
    particles = list(range(len(x)))
    targets = x + 0.01 * reach * rng.normal(size=x.shape)
    others = [
        {"kind": "anchor_spring", "name": "soft", "particles": particles, "targets": targets, "strength": stiffness},
        {"kind": "unary", "particles": particles, "vector": 0.01 * stiffness * reach * rng.normal(size=x.shape)},
    ]
    given = scene.model_dump()
    given["forces"] = [force, *others]
    given["settings"] = {"tolerance": 1e-12}
    return {"scene": Scene.read(given)}


def problem(kind: str, fields: list[str], seed: int) -> Problem:
    """Random weights on the positions of all particles, by columns of the force."""
    rng = np.random.default_rng(seed + 1)
    count = len(KINDS[kind].example()[1])
    goals = [
        {"kind": "position", "particles": [i], "axes": axis, "weight": float(rng.uniform(0.5, 1.5))}
        for i in range(count)
        for axis in "xyz"
    ]
    variables = [{"force": "it", "field": field} for field in fields]
    return Problem.read({**held(kind, seed), "variables": variables, "goals": goals})
