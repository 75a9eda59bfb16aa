"""Contacts and kinks: derivatives of what rests on a floor, and warnings where both sides have different ones."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean.designing.sensitivity import sensitivity
from hookean.running.run import relax
from hookean.scene.scene import Scene

from .test_gradients import cable, sag

LOW = -sag(100.0, 1.0, 5.0)  # where the string's middle hangs


def string(*more: dict[str, Any], **fields: Any) -> dict[str, Any]:
    """The string of two links with other forces beside it."""
    scene = cable()
    scene["forces"] = [{**scene["forces"][0], **fields}, scene["forces"][1], *more]
    return scene


def slopes(scene: dict[str, Any], axes: str = "z") -> tuple[float, list[str]]:
    """The derivative of the middle's place by the stiffness, and the warnings."""
    goals = [{"kind": "position", "particles": [1], "axes": axes}]
    found = sensitivity(scene, goals=goals, variables=[{"force": "string", "field": "stiffness", "tie": "all"}])
    return float(found.gradient[0][0]), found.warnings


def floor(height: float, **more: Any) -> dict[str, Any]:
    """A floor without friction."""
    return {"kind": "floor", "point": [0, 0, height], "static_friction": 0, "kinetic_friction": 0, **more}


def block(height: float) -> dict[str, Any]:
    """A soft solid below the string's middle."""
    top = [[x, y, height] for x, y in ((-3, -3), (3, -3), (3, 3), (-3, 3))]
    faces = [[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]]
    vertices = [*top, *([x, y, height - 1.0] for x, y, _ in top)]
    return {"kind": "collide_solid", "particles": [1], "vertices": vertices, "faces": faces, "strength": 50.0}


def test_what_rests_on_a_level_floor_stays_there() -> None:
    """The floor carries the middle: its height does not depend on the stiffness, with or without friction."""
    for more in ({}, {"static_friction": 0.6}):
        slope, said = slopes(string(floor(-0.2, **more)), "xyz")
        assert slope == pytest.approx(0.0, abs=1e-12) and said == []


def test_what_rests_on_a_slope_slides_along_it() -> None:
    """Against differences of whole solves: of second order with steps of 1e-3 of the stiffness, 1e-6 and rounding."""
    ground = floor(-0.2, normal=[0.3, 0.1, 1.0])
    places = []
    for k in (100.1, 99.9):
        scene = string(ground, stiffness=k)
        scene["settings"] = {"tolerance": 1e-12}
        places.append(relax(Scene.read(scene)).particles[1].sum())
    slope, said = slopes(string(ground), "xyz")
    assert slope == pytest.approx((places[0] - places[1]) / 0.2, rel=1e-5) and said == []


@pytest.mark.parametrize(("friction", "words"), [(0.0, []), (0.6, ["depends on its path"])])
def test_friction_that_stops_particles_on_their_way_is_reported(friction: float, words: list[str]) -> None:
    """The middle, pushed sideways, falls onto a floor: without friction derivatives are those of whole solves, with
    friction where it stops depends on its path."""
    ground = floor(-0.3, static_friction=friction, kinetic_friction=friction)

    def pushed(k: float) -> dict[str, Any]:
        scene = string(ground, stiffness=k)
        scene["forces"][1]["vector"], scene["settings"] = [2.0, 0.0, -8.0], {"tolerance": 1e-12}
        return scene

    places = [relax(Scene.read(pushed(k))).particles[1, 0] for k in (100.1, 99.9)]
    slope, said = slopes(pushed(100.0), "x")
    assert len(said) == len(words) and all(word in each for word, each in zip(words, said, strict=True))
    assert np.isclose(slope, (places[0] - places[1]) / 0.2, rtol=1e-5) == (not words)


@pytest.mark.parametrize("name", ["floor", "collide_solid", "springs"])
def test_a_contact_that_just_touches_is_reported(name: str) -> None:
    """At the height where the string hangs; a part of 1e-4 away from there nothing is, and both sides differ."""

    def beside(height: float) -> dict[str, Any]:
        if name == "springs":  # slack at its rest length
            scene = string({"kind": "springs", "particles": [[1, 3]], "rest_length": 1.0, "tension_only": True})
            scene["particles"].append([0, 0, height - 1.0])
            scene["anchors"].append({"particles": [3]})
            return scene
        return string(floor(height) if name == "floor" else block(height))

    said = slopes(beside(LOW))[1]
    assert len(said) == 1 and name in said[0] and "hold on one side" in said[0]
    low, high = slopes(beside(LOW - 1e-4)), slopes(beside(LOW + 1e-4))
    assert low[1] == high[1] == [] and not np.isclose(low[0], high[0], rtol=0.1)


def cloth(m: int, height: float, force: dict[str, Any], *, far: float = 0.0) -> dict[str, Any]:
    """A square of m x m meshes, `height` high at one corner, held along its rim; a held particle `far` away."""
    at = np.arange((m + 1) ** 2).reshape(m + 1, m + 1)
    u, v = np.divmod(at.ravel(), m + 1)
    points = np.stack([u / m, v / m, height * (u * v) / m**2], axis=1)
    faces = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=-1).reshape(-1, 4)
    rim = np.setdiff1d(at, at[1:-1, 1:-1]).tolist()
    return {
        "particles": [*points.tolist(), [far, 0.0, 0.0]],
        "meshes": {"skin": {"vertices": points.tolist(), "faces": faces.tolist()}},
        "forces": [{"name": "it", "mesh": "skin", **force}],
        "anchors": [{"name": "rim", "particles": [*rim, (m + 1) ** 2]}],
    }


def said_of(scene: dict[str, Any]) -> list[str]:
    """Warnings of a derivative by where the rim is."""
    goals = [{"kind": "position", "particles": [len(scene["meshes"]["skin"]["vertices"]) // 2], "axes": "z"}]
    return sensitivity(scene, goals=goals, variables=[{"anchor": "rim", "axes": "z", "tie": "all"}]).warnings


@pytest.mark.slow
@pytest.mark.parametrize("height", [0.0, 0.5])
@pytest.mark.parametrize("far", [0.0, 3000.0])
def test_a_smooth_film_has_no_kink(height: float, far: float) -> None:
    """The area of triangles is smooth. By the directions of its particles' steps some forces hardly change, and across
    a flat film they change by what is of second order alone; steps of 1e-7 of a scene that is 60,000 times as large as
    a triangle bend forces by a part of 6e-3 as well, beyond what sides of a kink may differ by."""
    assert not said_of(cloth(20, height, {"kind": "soapfilm", "tension": 2.0}, far=far))


def test_cloth_that_is_about_to_be_slack_is_reported() -> None:
    """Cloth with wrinkles resists being longer than it is woven, and nothing else: at that very size each triangle at
    the middle, which a spring holds, has a kink; cloth that is taut has none."""
    for prestress, count in ((0.0, 1), (1.0, 0)):
        pull = [prestress, prestress, 0.0]
        scene = cloth(2, 0.0, {"kind": "membrane", "warp_stiffness": 50.0, "wrinkling": True, "prestress": pull})
        scene["particles"].append([0.5, 0.5, 1.0])
        scene["forces"].append({"kind": "springs", "particles": [[4, 10]], "stiffness": 1.0, "rest_length": 1.0})
        scene["anchors"].append({"particles": [10]})
        said = said_of(scene)
        assert len(said) == count and all("membrane" in each for each in said)
