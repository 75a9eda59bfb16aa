"""Pictures: not blank, true to the result, the same bytes every time, and honest about what cannot be drawn."""

from __future__ import annotations

import cProfile
import io
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread

from hookean.discretize import corners, edges, grid
from hookean.errors import InputError
from hookean.pictures import legends
from hookean.pictures.picture import legend, render
from hookean.pictures.visible import VIEWS, collect, eye_of
from hookean.running.result import Result
from hookean.running.run import relax
from hookean.scene.scene import Scene
from hookean.values import colours

SMALL = (480, 360)


def cable(**settings: Any) -> Scene:
    lines = [[[2 * i, 0, 0], [2 * i + 2, 0, 0]] for i in range(5)]
    return Scene.read(
        {
            "units": {"length": "cm"},
            "forces": [
                {"kind": "springs", "lines": lines},
                {"kind": "unary", "points": [[2 * i, 0, 0] for i in range(6)], "vector": [0, 0, -20]},
            ],
            "anchors": [{"points": [[0, 0, 0], [10, 0, 0]]}],
            "settings": settings,
        }
    )


def net(n: int, *, load: float = -20.0, mesh: bool = False, **more: Any) -> Scene:
    square = grid(np.arange(n + 1), np.arange(n + 1))
    x, faces = square.vertices, square.faces
    return Scene.read(
        {
            "particles": x,
            "meshes": {"m": {"vertices": x, "faces": faces}} if mesh else {},
            "forces": [
                {"kind": "springs", "particles": edges(square)},
                {"kind": "unary", "particles": np.arange(len(x)), "vector": [0, 0, load]},
            ],
            "anchors": [{"particles": corners(square)}],
            "geometry": [{"kind": "mesh", "mesh": "m"}] if mesh else [],
            **more,
        }
    )


def drawn(result: Result, folder: Path, **options: Any) -> np.ndarray:
    render(result, folder / "p.png", **{"size": SMALL, **options})
    return imread(io.BytesIO((folder / "p.png").read_bytes()))[..., :3]


def ink(pixels: np.ndarray, colour: str, near: float = 0.12) -> int:
    """How many pixels are of about this colour."""
    wanted = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    return int((np.abs(pixels - wanted).max(axis=2) < near).sum())


@pytest.mark.slow
def test_size_and_content(tmp_path: Path) -> None:
    scene = cable()
    pixels = drawn(relax(scene), tmp_path, scene=scene, title="Cable", size=(1600, 1200))
    assert pixels.shape == (1200, 1600, 3)
    painted = (pixels < 0.97).any(axis=2)
    assert 0.005 < painted.mean() < 0.5
    middle = painted[300:900, 100:1300]
    assert middle.any(axis=0).mean() > 0.8  # the cable spans the drawing
    for colour in (colours.LOAD, colours.REACTION, colours.INK):
        assert ink(pixels, colour) > 100


@pytest.mark.slow
def test_nothing_runs_off_the_edge(tmp_path: Path) -> None:
    scene = net(6, mesh=True, settings={"floor": {"point": [0, 0, -4]}})
    pixels = drawn(relax(scene), tmp_path, scene=scene, title="long " * 60, size=(1600, 1200))
    frame = np.ones(pixels.shape[:2], bool)
    frame[8:-8, 8:-8] = False
    assert (pixels[frame] > 0.99).all()


@pytest.mark.parametrize("scene", [cable(), net(5)], ids=["cable", "net"])
def test_legend_ends_are_the_extreme_forces(scene: Scene) -> None:
    result = relax(scene)
    forces = result.force("springs")["force"]
    assert legend(result) == (forces.min(), forces.max(), "N")


def test_the_drawn_bar_ends_where_the_legend_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []
    ticks = colours.ticks
    monkeypatch.setattr(legends, "ticks", lambda *given: seen.append(ticks(*given)) or seen[-1])
    result = relax(cable())
    drawn(result, tmp_path)
    assert (seen[0][0], seen[0][-1]) == legend(result)[:2]
    assert seen[0] == sorted(seen[0])


@pytest.mark.parametrize("low, high", [(-3.0, 5.0), (0.0, 7.0), (-7.0, -1.0), (2.0, 2.0), (0.0, 0.0), (-1e9, 1e-3)])
def test_colours_reach_both_ends(low: float, high: float) -> None:
    scale = colours.Scale(low, high, "N")
    first, last = scale.first, scale.last
    assert first <= low <= high <= last and first < last
    if low < 0.0 < high and high > 1e-9 * abs(low):
        assert first == -last


def test_pull_is_warm_and_push_is_cold(tmp_path: Path) -> None:
    def bar(load: float) -> np.ndarray:
        scene = {
            "forces": [
                {"kind": "springs", "lines": [[[0, 0, 0], [0, 0, 1]]]},
                {"kind": "unary", "points": [[0, 0, 1]], "vector": [0, 0, load]},
            ],
            # guided, so that a pressed one stays upright
            "anchors": [{"points": [[0, 0, 0]]}, {"points": [[0, 0, 1]], "axes": "xy"}],
        }
        pixels = drawn(relax(Scene.read(scene)), tmp_path, size=(1600, 1200))
        return pixels[600, 1408:1424].mean(axis=0)

    pull, push = bar(100.0), bar(-100.0)
    assert pull[0] > pull[2] and push[2] > push[0]


@pytest.mark.slow
def test_bytes_are_the_same_every_time(tmp_path: Path) -> None:
    scene = net(4, mesh=True)
    result = relax(scene)
    files = []
    for name in ("a.png", "b.png"):
        render(result, tmp_path / name, scene=scene, title="Twice", size=SMALL)
        files.append((tmp_path / name).read_bytes())
        time.sleep(1.1 if name == "a.png" else 0.0)
    assert files[0] == files[1]
    assert b"tEXt" not in files[0]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.png", "b.png"]


def test_the_global_figure_list_stays_empty(tmp_path: Path) -> None:
    drawn(relax(cable()), tmp_path)
    import matplotlib.pyplot as plt

    assert plt.get_fignums() == []


def test_slack_springs_are_grey(tmp_path: Path) -> None:
    lines = [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [3, 0, 0]]]
    scene = {
        "forces": [{"kind": "springs", "lines": lines, "upper_cutoff": [0, 1]}],
        "anchors": [{"points": [[0, 0, 0], [1, 0, 0], [3, 0, 0]], "targets": [[0, 0, 0], [1.5, 0, 0], [3.5, 0, 0]]}],
    }
    result = relax(Scene.read(scene))
    assert legend(result) == (0.0, 500.0, "N")
    assert ink(drawn(result, tmp_path, size=(1600, 1200)), colours.SLACK, near=0.04) > 500


def test_without_any_force_there_is_no_colour_bar(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = {"forces": [{"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]]], "rest_factor": 1.0}]}
    monkeypatch.setattr(legends, "ticks", lambda *given: pytest.fail("a bar of no forces"))
    result = relax(Scene.read(scene))
    assert legend(result) == (0.0, 0.0, "N")
    assert ink(drawn(result, tmp_path, size=(1600, 1200)), colours.SLACK, near=0.04) > 500


EDGES = {
    "one particle": {"particles": [[1, 2, 3]]},
    "far away": {"particles": [[1e9, 0, 0], [1e9 + 1, 0, 0]], "forces": [{"kind": "springs", "particles": [[0, 1]]}]},
    "tiny": {"forces": [{"kind": "springs", "lines": [[[0, 0, 0], [1e-3, 0, 1e-3]]]}], "weld_tolerance": 1e-6},
    "points along y": {"forces": [{"kind": "springs", "lines": [[[0, 0, 0], [0, 2, 0]]], "rest_factor": 1.0}]},
    "only a mesh": {
        "particles": [[0, 0, 0]],
        "meshes": {"m": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0.5]], "faces": [[0, 1, 2]]}},
        "geometry": [{"kind": "mesh", "mesh": "m"}],
    },
    "only a floor": {"particles": [[0, 0, 1]], "anchors": [{"particles": [0]}], "settings": {"floor": True}},
}


@pytest.mark.parametrize("name", EDGES)
def test_edge_cases(name: str, tmp_path: Path) -> None:
    scene = Scene.read(EDGES[name])
    pixels = drawn(relax(scene), tmp_path, scene=scene)
    assert 0.002 < (pixels < 0.97).any(axis=2).mean() < 0.7
    if not any(f.kind == "springs" for f in scene.forces):
        assert legend(relax(scene)) == (0.0, 0.0, "N")


def test_plane_shapes_are_seen_face_on() -> None:
    def eye(scene: Scene) -> np.ndarray:
        things = collect(relax(scene), scene)
        return eye_of(None, things)

    assert np.allclose(eye(cable()), [[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    slanted = eye(net(3))
    assert np.allclose(slanted, eye_of("isometric", None))  # type: ignore[arg-type]
    flat = eye(net(3, load=0.0))
    assert np.allclose(flat, np.eye(3))
    for view in (slanted, flat, *(eye_of(v, None) for v in VIEWS)):  # type: ignore[arg-type]
        assert np.allclose(view @ view.T, np.eye(3)) and np.allclose(np.cross(view[0], view[1]), view[2])


def test_arrows_are_loads_and_what_supports_carry() -> None:
    """A soft anchor carries the weight, 4 N each, as a reaction; forces within a body are neither, and reactions of
    rounding size are not drawn."""
    x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    body = {"kind": "rigid_body", "particles": range(4), "shape": 1.1 * x}
    weight = {"kind": "unary", "particles": [0], "vector": [0, 0, -4.0]}
    soft = {"kind": "anchor_spring", "particles": [0], "strength": 100.0}
    hung = {"particles": x, "forces": [body, weight, soft], "settings": {"tolerance": 1e-9}}
    things = collect(relax(Scene.read(hung)), None)
    assert things.loads[:, 1] == pytest.approx(np.array([[0, 0, -4.0]]))
    assert things.reactions[:, 1] == pytest.approx(np.array([[0, 0, 4.0]]), abs=1e-7)
    free = {"particles": x, "forces": [body], "anchors": [{"particles": [0]}]}
    things = collect(relax(Scene.read(free)), None)
    assert not len(things.loads) and not len(things.reactions)


def test_proportions_are_true(tmp_path: Path) -> None:
    square = [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [1, 0, 1]], [[1, 0, 1], [0, 0, 1]], [[0, 0, 1], [0, 0, 0]]]
    scene = Scene.read({"forces": [{"kind": "springs", "lines": square}]})
    pixels = drawn(relax(scene), tmp_path, size=(1600, 1200))[130:1050, 60:1380]
    rows, columns = np.nonzero((pixels < 0.9).any(axis=2))
    assert abs(np.ptp(rows) - np.ptp(columns)) <= 3


@pytest.mark.slow
def test_a_large_net_is_drawn_as_a_whole(tmp_path: Path) -> None:
    """Four times as many particles take a few calls each, about 70 of matplotlib's for labels and faces: nothing is
    drawn spring by spring, which takes hundreds, nor looked up in all the others."""
    calls, counts = [], []
    for side in (25, 50):
        scene = net(side, settings={"max_iterations": 5})
        result = relax(scene)
        with cProfile.Profile() as profile:
            drawn(result, tmp_path, scene=scene)
        calls.append(sum(entry.callcount for entry in profile.getstats()))  # type: ignore[attr-defined]
        counts.append(len(result.particles))
    assert calls[1] - calls[0] < 150 * (counts[1] - counts[0])


def refused(path: Path, **options: Any) -> str:
    with pytest.raises(InputError) as caught:
        render(relax(cable(max_iterations=1)), path, **options)
    return str(caught.value)


def test_refusals(tmp_path: Path) -> None:
    assert "does not exist" in refused(tmp_path / "no" / "p.png")
    assert "is a folder" in refused(tmp_path)
    assert ".png" in refused(tmp_path / "p.jpg")
    assert "invalid in file names" in refused(Path("a\0b.png"))
    assert "isometric" in refused(tmp_path / "p.png", view="sideways")
    assert "angles" in refused(tmp_path / "p.png", view=(1, 2, 3))
    assert "finite" in refused(tmp_path / "p.png", view=(float("nan"), 0.0))
    assert "10000" in refused(tmp_path / "p.png", size=(100_000, 10))
    assert list(tmp_path.iterdir()) == []


def test_a_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "p.png"
    path.write_bytes(b"before")

    def fail(*_: Any) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("os.replace", fail)
    assert "cannot be written" in refused(path)
    assert path.read_bytes() == b"before" and len(list(tmp_path.iterdir())) == 1
