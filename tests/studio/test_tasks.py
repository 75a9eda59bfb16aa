"""Tasks of a designer, from an empty page by mouse and keyboard alone; what the page shows is what the Python API
finds of the same model. `tasks.py` has the steps, `tutorial.py` takes pictures of the same."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm as _rhino3dm
from scipy.optimize import brentq

from hookean import Anchor, AreaWeight, Result, Scene, Simulation, Springs, Unary, family, relax
from hookean import open as open_scene
from hookean.discretize import divide

from . import tasks
from .browser import Studio

rhino3dm: Any = _rhino3dm

WIGGLE = Path(__file__).parents[3] / "shared" / "data" / "rhino" / "v7_my_curves.3dm"
NEAR = 1e-4
"""Of a length or force: both solve to a residual of 1e-6 of the loads, from different starts."""


def unseen(name: str) -> None:
    """No picture."""


def sums(studio: Studio) -> list[float]:
    """The sums of the reactions along x, y and z, as the table shows them."""
    tasks.opened(studio, "Tables")
    studio.press("Reactions")
    cells = studio.page.locator("tfoot td").all_inner_texts
    studio.until(lambda: len(cells()) == 4)
    return [float(cell) for cell in cells()[:3]]


def column(studio: Studio, name: str) -> list[float]:
    """A column of the table that is shown, by number."""
    studio.page.get_by_role("columnheader", name=name).wait_for()
    heads = studio.page.locator("thead th").all_inner_texts()
    [place] = [i for i, head in enumerate(heads) if head.split("[")[0].strip() == name]
    cells = studio.page.locator(f"tbody tr > :nth-child({place + 1})").all_inner_texts()
    return [float(cell) for cell in cells]


def forces(result: Result) -> np.ndarray[Any, Any]:
    """The forces of all springs of a result."""
    return np.concatenate([np.asarray(one["force"]) for one in result.forces if one["kind"] == "springs"])


def same(studio: Studio, key: str, truth: Result) -> None:
    """A session has the shape, forces and reactions of a result."""
    state = studio.service.state(key)
    size = np.ptp(truth.particles, axis=0).max()
    assert np.abs(np.asarray(state["particles"]) - truth.particles).max() < NEAR * size
    for told, one in zip(state["forces"], truth.forces, strict=True):
        for name in ("force", "area", "tension"):
            if np.size(one.get(name, ())):
                largest = np.abs(one[name]).max()
                assert np.abs(np.asarray(told[name]) - one[name]).max() < 10 * NEAR * largest, one["name"]
    found, reactions = np.asarray(state["reactions"]["force"]), np.asarray(truth.reactions["force"])
    assert np.abs(found - reactions).max() < 10 * NEAR * np.abs(reactions).max()


def test_a_roof_is_formed_loaded_with_snow_saved_and_reopened(studio: Studio, tmp_path: Path):
    """The roof under snow is that of the Python API, and so is the file that was saved. The table of reactions adds up
    to the snow: 0.6 kN/m2 of the plan that the edge cables leave, by the corners of its faces. The longest arrow of a
    load is what the faces about a particle put on it, a third of each on every corner."""
    first, second = tasks.roof(studio, tmp_path, unseen)
    scene = family("saddle", {"force": "kN"}, rise=2.5, edge_stiffness=60)
    snow = AreaWeight(name="area weight", mesh="net", weight=0.6, per="plan")
    truth = relax(scene.replaced(forces=(*scene.forces, snow)))
    same(studio, first, truth)
    same(studio, second, truth)
    assert studio.service.scene(second) == studio.service.scene(first)
    assert Scene.read(studio.service.scene(second)).units.force == "kN"
    corners = truth.particles[np.asarray(scene.meshes["net"].faces)][:, :, :2]
    x, y = np.moveaxis(corners, 2, 0)
    plan = 0.5 * np.abs(np.sum(x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1), axis=1)).sum()
    assert sums(studio)[2] == pytest.approx(0.6 * plan, rel=1e-3)  # four digits are shown
    borne = np.zeros(len(truth.particles))
    weights = truth.forces[-1]
    np.add.at(borne, np.asarray(weights["particles"]), -np.asarray(weights["force"])[:, 2, None] / 3)
    legend = studio.page.get_by_role("group", name="Legend").inner_text
    found = studio.until(lambda: re.search(r"Load\s+up to ([\d.]+) kN", legend()))
    assert float(found[1]) == pytest.approx(borne.max(), rel=1e-2)  # three digits are shown


@pytest.mark.soak
def test_a_hanging_net_is_turned_over(studio: Studio):
    """Loads mirrored in the plane of the supports give the mirrored form with the same forces (Hooke, 1676)."""
    key = tasks.hanging(studio)
    net = {"stiffness": 4, "rest_factor": 0, "load": 2, "held": "edges"}
    scene = family("grid", {"force": "kN"}, width=8, depth=6, across=8, along=6, **net)
    hanging = relax(scene)
    same(studio, key, hanging)
    tasks.turned(studio, unseen)
    state = studio.service.state(key)
    assert np.abs(np.asarray(state["particles"]) - hanging.particles * [1, 1, -1]).max() < NEAR * 8
    found = np.asarray(state["forces"][0]["force"])
    assert np.abs(found - hanging.forces[0]["force"]).max() < 10 * NEAR * np.abs(found).max()
    assert sums(studio)[2] == pytest.approx(-2 * 7 * 5, rel=1e-3)


@pytest.mark.soak
def test_a_tensegrity_finds_its_twist(studio: Studio):
    """Struts in compression and cables in tension are those of the Python API, in the table, too."""
    key = tasks.tensegrity(studio, unseen)
    truth = relax(family("tensegrity", {"force": "kN"}, struts=4, height=3))
    same(studio, key, truth)
    shown = column(studio, "Force")
    assert shown == pytest.approx(forces(truth), rel=1e-3)
    assert sum(force < 0 for force in shown) == 4


@pytest.mark.soak
@pytest.mark.skipif(not WIGGLE.is_file(), reason="the files of Rhino are not here")
def test_a_rhino_file_is_imported_with_roles(studio: Studio, tmp_path: Path):
    """The cable is that of the Python API, made without a recipe: 24 equal arcs of the curve, in the inches of the
    file. The file that is saved holds the same scene, and its lines are the cable at rest."""
    saved = tasks.imported(studio, WIGGLE, tmp_path, unseen)
    drawn = rhino3dm.File3dm.Read(str(WIGGLE)).Objects
    [curve] = [item.Geometry for item in drawn if isinstance(item.Geometry, rhino3dm.NurbsCurve)]
    points = divide(curve, 24)
    cable = Springs(lines=np.stack([points[:-1], points[1:]], 1), stiffness=50, tension_only=True)
    load, ends = Unary(points=points, vector=(0, 0, -2)), Anchor(points=points[[0, -1]])
    truth = relax(Scene(forces=(cable, load), anchors=(ends,), units={"length": "in"}))
    same(studio, studio.key, truth)
    assert open_scene(saved).model_dump(mode="json") == studio.service.scene(studio.key)
    lines = [item.Geometry for item in rhino3dm.File3dm.Read(str(saved)).Objects]
    ends_of = [(line.PointAtStart, line.PointAtEnd) for line in lines if isinstance(line, rhino3dm.LineCurve)]
    written = np.array([[(p.X, p.Y, p.Z) for p in pair] for pair in ends_of])
    assert {len(written)} <= {24, 24 + 2}  # the cable, and the reactions at its ends
    middles = truth.particles[:-1] / 2 + truth.particles[1:] / 2
    away = np.linalg.norm(written.mean(axis=1)[:, None] - middles, axis=2).min(axis=0)
    assert away.max() < NEAR * np.ptp(truth.particles, axis=0).max()


def errors(particles: Any, area: Any, height: float) -> np.ndarray[Any, Any]:
    """How far a film between rings of 5 m is from the catenoid r = a cosh((z - h / 2) / a): its particles / 5 m, and
    its area / pi a (h + a sinh(h / a))."""
    a = brentq(lambda a: a * np.cosh(height / 2 / a) - 5.0, height / 2 / 1.1997, 50.0)
    x, y, z = np.asarray(particles).T
    away = np.abs(np.hypot(x, y) - a * np.cosh((z - height / 2) / a)).max()
    return np.array([away / 5.0, abs(np.sum(area) / (np.pi * a * (height + a * np.sinh(height / a))) - 1.0)])


def same_film(studio: Studio, key: str, truth: Result, height: float) -> None:
    """A session has a film as near to the catenoid as that of the Python API, within a factor of 2: particles slide on
    a film freely, so where they come to rest on it depends on where they come from."""
    state = studio.service.state(key)
    found = errors(state["particles"], state["forces"][0]["area"], height)
    assert (found < 2.0 * errors(truth.particles, truth.forces[0]["area"], height)).all(), found


@pytest.mark.soak
def test_a_film_is_pulled_to_its_collapse_and_back(studio: Studio):
    """At 5 m between the rings and at 6 m the film is the catenoid of the Python API. At 8 m, beyond 1.325 radii, no
    film spans them (Goldschmidt, 1831), and the page reports the collapse. Back at 5 m it is the catenoid again."""
    key = tasks.film(studio, unseen)
    scene = family("catenoid", {"force": "kN"}, rays=24, rings=8)
    simulation = Simulation(scene)
    same(studio, key, truth := simulation.relax())
    rim = np.flatnonzero(np.asarray(scene.particles)[:, 2] == 5.0)
    raised = np.asarray(scene.particles)[rim] + [0, 0, 1]
    simulation.patch({"pin": [{"particles": rim.tolist(), "targets": raised.tolist()}]})
    tasks.pulled(studio, "1")
    tasks.solved(studio)
    same_film(studio, key, simulation.relax(), 6.0)
    tasks.collapsed(studio, unseen)
    assert studio.service.summary(key)["status"] == "diverged"
    tasks.restored(studio, unseen)
    same_film(studio, key, truth, 5.0)


def measures(result: Result) -> dict[str, float | str]:
    """What the table of differences has of a result, with its units."""
    reactions, force = np.asarray(result.reactions["force"]), forces(result)
    return {
        "Particles": len(result.particles),
        "Springs": len(force),
        "Highest particle, z [m]": result.particles[:, 2].max(),
        "Lowest particle, z [m]": result.particles[:, 2].min(),
        "Largest tension [kN]": force.max(),
        "Largest compression [kN]": max(0.0, -force.min()),
        "Largest reaction [kN]": np.linalg.norm(reactions, axis=1).max(),
        "Sum of reactions, x [kN]": reactions[:, 0].sum(),
        "Sum of reactions, y [kN]": reactions[:, 1].sum(),
        "Sum of reactions, z [kN]": reactions[:, 2].sum(),
        "Energy [kN·m]": result.energy["total"],
        "Status": "at rest",
        "Stability": "stable",
    }


@pytest.mark.soak
def test_two_variants_are_compared(studio: Studio):
    """The table of differences has the numbers of the Python API for a saddle 4 m high, for its variant of 2 m, and
    what the second has more, to the four digits shown; sums that cancel are nothing beside the largest reaction. The
    legend names the variant while it is drawn over the form."""
    legends: dict[str, str] = {}
    legend = studio.page.get_by_role("group", name="Legend")
    tasks.variants(studio, lambda step: legends.update({step: legend.inner_text()}))
    assert re.match(r"This model\s+Variant low\s+Force", legends["variants-overlay"])
    assert "Variant" not in legends["variants-beside"]
    high, low = (
        measures(relax(family("saddle", {"force": "kN"}, across=8, along=8, rise=rise))) for rise in (4.0, 2.0)
    )
    table = studio.page.get_by_role("region", name="Table of differences").locator("tbody tr")
    shown = [row.locator("th, td").all_inner_texts() for row in table.all()]
    rows = {" ".join(cells[0].split()): [cell.strip() for cell in cells[1:]] for cells in shown}
    assert {*high} < {*rows}
    nothing = 1e-3 * float(high["Largest reaction [kN]"])
    for name, a in high.items():
        if isinstance(a, str):
            assert rows[name] == [a, low[name], ""]
            continue
        b = float(low[name])
        told = [float(cell.replace("−", "-")) for cell in rows[name]]
        assert told == pytest.approx([a, b, b - a], rel=1e-3, abs=nothing), name
