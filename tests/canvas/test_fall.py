"""Free fall on the canvas: where nothing holds a form, components that relax it warn, and report no error."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from compas.datastructures import Mesh
from hypothesis import given
from hypothesis import strategies as st

from canvas.canvasing import Bench, sentences
from canvas.test_engine import Cable
from canvas.test_tools import Placed
from canvas.test_tools_sweep import cable, tree
from hookean import Scene, relax
from hookean.forces import KINDS
from hookean_canvas.run import stand_in
from hookean_client import canvas_fall, canvas_packed, compas_canvas
from serving import Home

LINE = {"kind": "springs", "particles": [[0, 1], [1, 2]]}
DOWN = {"kind": "unary", "points": [[1, 0, 0]], "vector": [0, 0, -1]}
BOX = {
    "vertices": [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)],
    "faces": [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
}
OPEN = {"vertices": BOX["vertices"], "faces": BOX["faces"][:1] + BOX["faces"][2:]}  # without its top


def scene(*forces: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]], "forces": [LINE, *forces], **more}


def anchors(axes: str = "xyz") -> list[dict[str, Any]]:
    return [{"points": [[0, 0, 0]], "axes": axes}]


def shell(mesh: dict[str, Any], pressure: float) -> dict[str, Any]:
    springs = {"kind": "springs", "mesh": "box"}
    return {"meshes": {"box": mesh}, "forces": [springs, {"kind": "pressure", "mesh": "box", "pressure": pressure}]}


WEIGHT = {"kind": "self_weight", "total": 3.0}
PER_LENGTH = {
    "kind": "self_weight",
    "lines": [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]]],
    "per_length": [1.0, 2.0],
}
UP = {"kind": "unary", "points": [[0, 0, 0], [1, 0, 0], [2, 0, 0]], "vector": [0, 0, 1.0]}
FLOOR = {"kind": "floor"}

SCENES: dict[str, tuple[dict[str, Any], str]] = {
    "a load": (scene(DOWN), "z"),
    "two loads that cancel": (scene(DOWN, dict(DOWN, points=[[2, 0, 0]], vector=[0, 0, 1])), ""),
    "a vector for each particle": (scene(dict(UP, vector=[[1, 0, 0], [-1, 2, 0], [0, -2, 5]])), "z"),
    "a weight": (scene(WEIGHT), "z"),
    "a weight aslant": (scene(dict(WEIGHT, direction=[0, 3, -4])), "yz"),
    "a weight per length": (scene(PER_LENGTH), "z"),
    "a weight and a lift of the same size": (scene(WEIGHT, UP), ""),
    "a weight per length and a lift of the same size": (scene(PER_LENGTH, UP), ""),
    "no load": (scene(), ""),
    "an anchor": (scene(DOWN, anchors=anchors()), ""),
    "an anchor in another direction": (scene(DOWN, anchors=anchors("xy")), "z"),
    "a soft anchor": (scene(DOWN, {"kind": "anchor_spring", "points": [[0, 0, 0]]}), ""),
    "a floor below": (scene(DOWN, FLOOR), ""),
    "a floor of the settings": (scene(DOWN, settings={"floor": True}), ""),
    "a floor above": (scene(DOWN, dict(FLOOR, normal=[0, 0, -1])), "z"),
    "pressure in a closed mesh": (shell(BOX, 2.0), ""),
    "pressure in an open mesh": (shell(OPEN, 2.0), "z"),
}


@pytest.mark.parametrize(("told", "axes"), SCENES.values(), ids=SCENES)
def test_what_falls_is_what_moves_as_a_whole(told: dict[str, Any], axes: str) -> None:
    """Newton: the centre of mass of what nothing holds moves where the loads do not cancel, and only there."""
    sentence = canvas_fall.sentence(told)
    assert sentence is None if not axes else f"in {' and '.join(axes)}, and its loads" in str(sentence)
    if told.get("anchors") or any(f["kind"] in canvas_fall.HOLDING for f in told["forces"]) or "settings" in told:
        return
    physical = {"solver": "verlet", "drag": 0, "time_step": 1e-3, "tolerance": 0}
    start, end = (
        relax(Scene.read({**told, "settings": {**physical, "max_iterations": count}})).particles.mean(axis=0)
        for count in (0, 20)
    )
    moved = end - start
    # after t = 0.02 the centre has moved by a t^2 / 2 = 2e-4 |F| / m; rounding leaves 1e-16
    assert "".join(axis for axis, part in zip("xyz", moved, strict=True) if abs(part) > 1e-9) == axes


@pytest.mark.parametrize("kind", canvas_fall.HOLDING)
def test_what_can_hold_a_particle_is_no_fall(kind: str) -> None:
    """Forces against what stays where it is; it falls without them."""
    assert KINDS[kind].role == "support"
    assert canvas_fall.sentence(scene(DOWN, {"kind": kind})) is None and canvas_fall.sentence(scene(DOWN))


def test_anchors_that_meet_no_particle_hold_nothing() -> None:
    told = scene(DOWN, anchors=anchors())
    report = {"unmatched": [{"pointer": "/anchors/0/points/0"}, {"pointer": "/forces/1/points/0"}]}
    assert canvas_fall.unmatched(report) == [0]
    assert canvas_fall.sentence(told, canvas_fall.unmatched(report)) is not None


@given(st.lists(st.tuples(*[st.floats(-1e6, 1e6)] * 3), min_size=1, max_size=20))
def test_a_sum_that_rounding_leaves_is_no_fall(vectors: list[tuple[float, float, float]]) -> None:
    """Any loads and their opposites cancel; with one of them larger by a thousandth of all they do not."""
    both = [list(v) for v in vectors] + [[-p for p in v] for v in reversed(vectors)]
    load = {"kind": "unary", "points": [[0, 0, 0]] * len(both), "vector": both}
    assert canvas_fall.sentence({"forces": [load]}) is None
    size = float(np.linalg.norm(both, axis=1).sum())
    if size > 0:
        more = [[both[0][0] + 1e-3 * size, *both[0][1:]], *both[1:]]
        assert "in x," in str(canvas_fall.sentence({"forces": [dict(load, vector=more)]}))


def test_buffers_are_read_as_lists_are() -> None:
    told = shell(OPEN, 2.0)
    packed = dict(told, meshes={"box": canvas_packed.packed(OPEN)})
    assert packed != told and canvas_fall.sentence(packed) == canvas_fall.sentence(told) is not None


# ------------------------------------------------------------------------------------------------------- components


@pytest.fixture(scope="module", autouse=True)
def rhino() -> Iterator[None]:
    made = stand_in.Canvas().install()
    yield
    made.remove()


@pytest.mark.slow
@pytest.mark.parametrize("solver", ["momentum", "relaxation", "newton"])
def test_an_engine_without_anchors_warns_at_the_start_and_when_it_has_flown_apart(home: Home, solver: str) -> None:
    """Newton's first step has no last good shape but that of before the reset, which began another revision."""
    falling = Cable()
    falling.anchors, falling.settings = None, {"solver": solver, "fast": True}
    falling.hold()
    [said] = sentences(falling.engine)
    assert said.startswith("The form is unsupported in z, and its loads do not cancel there: it falls. Connect anchors")
    falling.run()
    assert falling.player.frame()["status"] == "diverged"
    told = sentences(falling.engine, "Warning")
    assert said in told and any(one.startswith("Diverged") for one in told)
    assert sentences(falling.engine, "Error") == [] and said in falling.out.report
    falling.anchors = Cable().anchors
    falling.hold()
    assert sentences(falling.engine) == []


def test_a_sweep_without_anchors_warns(home: Home) -> None:
    bench = Bench()
    inputs = {**cable(bench), "anchors_": None}
    made = Placed("Sweep", bench)
    given_ = {"_parameters": ["Springs.stiffness"], "_values": tree([1000.0, 2000.0]), "_run": True}
    made.run(**inputs, **given_)
    assert any(one.startswith("The form is unsupported in z") for one in sentences(made.ghenv, "Warning"))
    assert sentences(made.ghenv, "Error") == []


def test_a_compas_structure_without_anchors_warns(home: Home) -> None:
    bench = Bench()
    relaxes = bench.component("COMPAS Relax")
    mesh = Mesh.from_meshgrid(dx=2, nx=2)
    parts = [
        compas_canvas.springs(bench.component("Springs"), mesh, stiffness=[10.0]),
        compas_canvas.load(bench.component("Load"), mesh, vector=[stand_in.Vector3d(0, 0, -1)]),
    ]
    found = bench.run(relaxes, lambda: compas_canvas.relax(relaxes, mesh, parts))
    said = sentences(relaxes, "Warning")
    assert said[0].startswith("The form is unsupported in z") and sentences(relaxes, "Error") == []
    assert said[0] in found.report
