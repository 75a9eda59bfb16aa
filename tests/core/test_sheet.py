"""Sheets: every panel is there, to scale, with a legend that ends where its forces do; frames, curves and graphs."""

from __future__ import annotations

import io
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.image import imread

from hookean import Scene, relax
from hookean.discretize import grid, naked_vertices
from hookean.errors import InputError
from hookean.pictures import legends
from hookean.pictures.page import Page, _few
from hookean.pictures.painter import Drawing
from hookean.pictures.picture import legend
from hookean.pictures.sheet import Graph, Panel, sheet
from hookean.pictures.visible import collect, eye_of, smooth
from hookean.values.colours import LINES
from soak import examples, sampled


def cable(stiffness: float = 1000.0, **more: Any) -> Scene:
    """Five springs of 2 m between two anchors, 20 N on every particle."""
    return Scene(
        particles=[[2.0 * i, 0.0, 0.0] for i in range(6)],
        forces=[
            {"kind": "springs", "particles": [[i, i + 1] for i in range(5)], "stiffness": stiffness},
            {"kind": "unary", "particles": list(range(6)), "vector": [0, 0, -20]},
        ],
        anchors=[{"particles": [0, 5]}],
        **more,
    )


def square(side: float, unit: str = "m") -> Scene:
    """Four springs without force around a square of the plane XZ."""
    x = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]) * side
    springs = {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3], [3, 0]]}
    return Scene.read({"units": {"length": unit}, "particles": x, "forces": [springs]})


def film(n: int) -> Scene:
    """A soap film in a frame that is no plane; no springs."""
    side = np.linspace(0.0, 1.0, n + 1)
    mesh = grid(side, side, np.outer(side, side))
    return Scene.read(
        {
            "particles": mesh.vertices,
            "meshes": {"film": {"vertices": mesh.vertices, "faces": mesh.faces}},
            "forces": [{"kind": "soapfilm", "mesh": "film"}],
            "anchors": [{"particles": naked_vertices(mesh)}],
            "geometry": [{"kind": "mesh", "mesh": "film"}],
        }
    )


def drawn(panels: list[Panel | Graph], folder: Path, **options: Any) -> np.ndarray:
    sheet(panels, folder / "s.png", **options)
    return imread(io.BytesIO((folder / "s.png").read_bytes()))[..., :3]


def near(pixels: np.ndarray, colour: str | tuple[float, ...], within: float = 0.06) -> np.ndarray:
    """Where pixels are of about this colour."""
    if isinstance(colour, str):
        colour = tuple(int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return (np.abs(pixels - np.array(colour)).max(axis=2) < within) & True


@pytest.fixture
def bars(monkeypatch: pytest.MonkeyPatch) -> list[tuple[float, float, str, list[float]]]:
    """The legends of forces as they were drawn: their ends, what they stand for, their ticks."""
    found: list[Any] = []
    bar, ticks = legends.colour_bar, legends.ticks

    def record(page: Page, box: Any, scale: Any, words: str = "") -> None:
        marks: list[float] = []
        monkeypatch.setattr(legends, "ticks", lambda *given: marks.extend(ticks(*given)) or marks)
        bar(page, box, scale, words)
        found.append((scale.low, scale.high, words, marks))

    monkeypatch.setattr(legends, "colour_bar", record)
    return found


@pytest.fixture
def words(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """All words on the page."""
    found: list[str] = []
    text = Page.text

    def record(page: Page, x: float, y: float, words: str, *style: Any, **more: Any) -> None:
        found.append(words)
        text(page, x, y, words, *style, **more)

    monkeypatch.setattr(Page, "text", record)
    return found


THREE = [cable(k) for k in (500.0, 1000.0, 4000.0)]


def panels(scenes: list[Scene], **more: Any) -> list[Panel | Graph]:
    return [Panel(relax(scene), scene, title=f"Panel {i}", **more) for i, scene in enumerate(scenes)]


@pytest.mark.slow
def test_one_legend_for_all_ends_at_the_extremes_over_all(tmp_path: Path, bars: list[Any], words: list[str]) -> None:
    given = panels(THREE)
    drawn(given, tmp_path)
    ends = [legend(p.result)[:2] for p in given]  # type: ignore[union-attr, arg-type]
    low, high = min(e[0] for e in ends), max(e[1] for e in ends)
    ((first, last, said, ticks),) = bars
    assert (first, last, said) == (low, high, "all panels")
    assert (ticks[0], ticks[-1]) == (low, high) and ticks == sorted(ticks)
    for a, b in ends:  # and every panel tells its own
        assert f"force {a:.4g} to {b:.4g} N" in words


def test_legends_of_their_own_end_at_the_extremes_of_each(tmp_path: Path, bars: list[Any]) -> None:
    given = panels(THREE)
    drawn(given, tmp_path, same_scale=False)
    assert [(b[0], b[1]) for b in bars] == [legend(p.result)[:2] for p in given]  # type: ignore[union-attr, arg-type]
    assert all((b[3][0], b[3][-1]) == (b[0], b[1]) for b in bars)


def test_springs_of_another_unit_of_force_have_their_own_legend(tmp_path: Path, bars: list[Any]) -> None:
    given = panels([cable(), cable(units={"force": "kN"})])
    drawn(given, tmp_path)
    assert [b[2] for b in bars] == ["", ""]


@pytest.mark.slow
def test_a_film_has_no_legend_of_forces_but_shaded_faces_with_thin_edges(tmp_path: Path, bars: list[Any]) -> None:
    scene = film(8)
    result = relax(scene)
    things = collect(result, scene)
    assert things.shape.edged.all() and len(things.shape.faces) == 64
    pixels = drawn([Panel(result, scene)], tmp_path)
    assert not bars
    shaded = (pixels[..., 2] > pixels[..., 0] + 0.03) & (pixels.min(axis=2) < 0.9)
    assert shaded.mean() > 0.1
    rows, columns = np.nonzero(shaded)
    inside = pixels[rows.min() : rows.max(), columns.min() : columns.max()]
    dark = (inside.max(axis=2) < 0.65) & (inside[..., 2] >= inside[..., 0])
    assert 0.01 < dark.mean() < 0.25  # the edges: there, and thin


def test_edges_with_springs_are_not_drawn_twice() -> None:
    """Every edge of a mesh whose edges are springs is one; an edge without a spring marks its face."""
    x = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    base = {
        "particles": x,
        "meshes": {"m": {"vertices": x, "faces": [[0, 1, 2, 3]]}},
        "geometry": [{"kind": "mesh", "mesh": "m"}],
    }
    for pairs, edged in (([[0, 1], [2, 1], [2, 3], [0, 3]], False), ([[0, 1], [2, 1], [2, 3], [0, 2]], True)):
        scene = Scene.read({**base, "forces": [{"kind": "springs", "particles": pairs}]})
        assert collect(relax(scene), scene).shape.edged.tolist() == [edged]


@pytest.mark.soak
def test_frames_are_drawn_behind_the_first_one_faintest(tmp_path: Path, words: list[str]) -> None:
    scene = cable()
    result = relax(scene)
    down = result.particles - [0, 0, 1.5]
    frames = {"t = 0.0 s": scene.particles, "t = 0.2 s": down}
    things = collect(result, scene, frames)
    shades = Drawing(things, eye_of(None, things))._shades()
    assert list(shades) == list(frames)
    assert np.mean(shades["t = 0.0 s"]) > np.mean(shades["t = 0.2 s"]) > 0.3
    bare = drawn([Panel(result, scene)], tmp_path)
    pixels = drawn([Panel(result, scene, frames=frames)], tmp_path)
    assert set(frames) <= set(words)
    for shade in shades.values():
        assert near(pixels, shade, 0.015).sum() > 1500 > 3 * near(bare, shade, 0.015).sum()
    # the second one hangs under the result: its lowest part is below the result's
    result_rows = np.nonzero(near(pixels[:, :1200], "#f3b58e", 0.04))[0]
    frame_rows = np.nonzero(near(pixels[:-200, :1200], shades["t = 0.2 s"], 0.015))[0]
    assert frame_rows.max() > result_rows.max() + 50


def test_what_is_carried_moves_with_the_particles_of_a_frame() -> None:
    scene = film(3)
    result = relax(scene)
    moved = result.particles * [1.0, 2.0, 3.0]
    frame = collect(result, scene, {"moved": moved}).frames["moved"]
    assert np.array_equal(frame.faces, moved[scene.meshes["film"].faces])


@pytest.mark.slow
def test_curves_are_drawn_and_named(tmp_path: Path, words: list[str]) -> None:
    scene = cable()
    result = relax(scene)
    x = np.linspace(0.0, 10.0, 50)
    curve = np.stack([x, 0 * x, -0.04 * x * (10 - x) - 0.5], axis=1)
    bare = drawn([Panel(result, scene)], tmp_path)
    pixels = drawn([Panel(result, scene, curves={"parabola": curve})], tmp_path)
    assert "parabola" in words
    # some 1200 pixels long, six in ten of them dashes, at least one pixel of the full colour across
    assert near(pixels, LINES[0]).sum() > 700 and near(bare, LINES[0]).sum() < 50
    # dashed: there are gaps along it
    columns = near(pixels[150:600, 200:1100], LINES[0]).any(axis=0)
    assert 0.3 < columns.mean() < 0.95


def test_curves_alone_are_drawn_solid_with_their_unit(tmp_path: Path, words: list[str]) -> None:
    curve = np.array([[0.0, 0, 0], [5, 0, 2], [10, 0, 0]])
    pixels = drawn([Panel(curves={"roof": curve, "point": curve[1:2] - [0, 0, 1]}, unit="cm")], tmp_path)
    assert any(w.endswith(" cm") for w in words)
    _, columns = np.nonzero(near(pixels[:-170], LINES[0]))
    assert len(np.unique(columns)) == np.ptp(columns) + 1 > 1000
    assert near(pixels, LINES[1]).sum() > 50


@pytest.mark.soak
def test_a_panels_length_in_pixels_is_the_same_in_all(tmp_path: Path) -> None:
    """Squares of 2 m and of 100 cm: twice as wide. Tolerance: the line's thickness, under 5 pixels on both sides."""
    given = panels([square(2.0), square(100.0, "cm")])
    widths = {}
    for same in (True, False):
        pixels = drawn(given, tmp_path, same_scale=same, size=(2000, 1000))[230:800]
        grey = near(pixels, "#b9c0c7", 0.03)
        halves = (grey[:, :840], grey[:, 960:1700]) if same else (grey[:, :960], grey[:, 1010:1900])
        widths[same] = [np.ptp(np.nonzero(half)[1]) for half in halves]
    assert abs(widths[True][0] - 2 * widths[True][1]) <= 10
    assert abs(widths[False][0] - widths[False][1]) <= 10


@pytest.mark.soak
@pytest.mark.parametrize("count", sampled([5, 4, 3, 2, 1], 5))
def test_no_panel_is_blank_and_nothing_runs_off_the_edge(count: int, tmp_path: Path) -> None:
    scene, mesh = cable(), film(4)
    graph = Graph("long " * 40, "x [m]", "y [m]", {"line " * 9 + str(i): ([0, 1], [0, i]) for i in range(5)})
    every = [*panels([scene, mesh, scene]), graph, Panel(curves={"c": np.eye(3)}, title="long " * 40)][:count]
    pixels = drawn(every, tmp_path, title="long " * 60)
    painted = (pixels < 0.97).any(axis=2)
    edge = np.ones(painted.shape, bool)
    edge[8:-8, 8:-8] = False
    assert not painted[edge].any()
    columns = {1: 1, 2: 2, 4: 2}.get(count, 3)
    assert pixels.shape[1] == (1600 if columns == 1 else 2000)
    rows = -(-count // columns)
    for i in range(count):
        height, width = pixels.shape[0] / rows, pixels.shape[1] / columns
        part = painted[int(i // columns * height) :, int(i % columns * width) :][: int(height), : int(width)]
        assert part.mean() > 0.01


@pytest.mark.slow
@pytest.mark.parametrize("size", [(777, 555), (2000, 700), (1001, 1999)])
def test_a_given_size_is_the_size(size: tuple[int, int], tmp_path: Path) -> None:
    pixels = drawn(panels(THREE), tmp_path, size=size, columns=2)
    assert pixels.shape == (size[1], size[0], 3)
    assert (pixels < 0.97).any(axis=2).mean() > 0.01


@pytest.mark.soak
def test_equal_input_gives_equal_bytes_and_small_files(tmp_path: Path) -> None:
    scene = film(20)
    result = relax(scene)
    graph = Graph("Graph", "time [s]", "height [m]", {"h": ([0, 1, 2], [0, 2, 1])}, {"h": ([1], [2])})
    made = []
    for name in ("a.png", "b.png"):
        sheet([Panel(result, scene, frames={"start": scene.particles}), graph], tmp_path / name, title="Twice")
        made.append((tmp_path / name).read_bytes())
    assert made[0] == made[1]
    assert len(made[0]) < 250_000
    assert b"tEXt" not in made[0]


@pytest.mark.slow
@settings(derandomize=True, deadline=None, max_examples=examples(50), database=None)
@given(st.integers(0, 2**32 - 1))
def test_a_palette_keeps_white_what_is_kept_and_areas(seed: int) -> None:
    """White and the colours of a legend to the bit; 1.5 of 255 off in the mean, 24 but for one pixel in 10,000."""
    random = np.random.default_rng(seed)
    pixels = np.full((120, 160, 3), 255, np.uint8)
    ends = random.integers(0, 256, (2, 3))
    pixels[20:100, 20:] = np.linspace(*ends, 140).round().astype(np.uint8)
    pixels[40:60, 30:150] = np.clip(pixels[40:60, 30:150] + random.integers(-12, 13, (20, 120, 3)), 0, 255)
    pixels[60:100, 20:120] = np.clip(pixels[60:100, 20:120] + random.integers(-12, 13, (40, 100, 3)), 0, 255)
    kept = [(200, 30, 40), (20, 60, 120)]
    pixels[2:4, :80], pixels[2:4, 80:] = kept
    image = _few(pixels, kept)
    if image is None:  # a palette would spoil it: then full colour is kept
        return
    off = np.abs(np.asarray(image.convert("RGB")).astype(int) - pixels)
    far = np.linalg.norm(off, axis=2)
    assert (far > 24).mean() <= 1e-4 and far.mean() <= 1.5
    assert not off[(pixels == 255).all(axis=2)].any() and not off[2:4].any()


@pytest.mark.soak
def test_a_graph_has_its_lines_dots_grid_and_words(tmp_path: Path, words: list[str]) -> None:
    x = np.linspace(0.0, 3.0, 40)
    graph = Graph(
        "Swing", "time [s]", "height [m]", {"sine": (x, np.sin(x)), "cosine": (x, np.cos(x))}, {"peak": ([1.57], [1.0])}
    )
    pixels = drawn([graph], tmp_path)
    assert {"Swing", "sine", "cosine", "peak"} <= set(words)
    counts = [int(near(pixels, colour).sum()) for colour in LINES[:3]]
    assert counts[0] > 3000 and counts[1] > 3000 and 50 < counts[2] < 1000
    assert near(pixels, "#dfe4e8", 0.02).sum() > 3000
    # the sine is at its top where the dot is: its rows are the smallest there
    rows, columns = np.nonzero(near(pixels[:-200], LINES[2]))
    sine = near(pixels[:-200], LINES[0])
    assert abs(rows.mean() - np.nonzero(sine)[0].min()) < 12
    assert 0.45 < columns.mean() / pixels.shape[1] < 0.65


@pytest.mark.slow
def test_logarithmic_axes_make_a_power_law_straight(tmp_path: Path) -> None:
    x = np.logspace(0, 3, 60)
    pixels = drawn([Graph("", "n [-]", "error [m]", {"law": (x, x**-2.0)}, x_log=True, y_log=True)], tmp_path)
    rows, columns = np.nonzero(near(pixels[:-120], LINES[0]))
    slope, offset = np.polyfit(columns, rows, 1)
    assert slope > 0 and np.abs(rows - slope * columns - offset).max() < 6  # half a line of 2.2 points, and its ends


def test_a_line_and_dots_of_one_label_share_colour_and_entry(tmp_path: Path, words: list[str]) -> None:
    drawn([Graph(lines={"both": ([0, 1], [0, 1])}, dots={"both": ([0.5], [0.5])})], tmp_path)
    assert words.count("both") == 1


@settings(derandomize=True, deadline=None, max_examples=examples(50), database=None)
@given(st.integers(0, 2**32 - 1), st.integers(2, 5), st.integers(0, 6), st.booleans())
def test_carried_curves_are_rhinos_own(seed: int, degree: int, more: int, weighted: bool) -> None:
    """Against rhino3dm's evaluation. Tolerance: rounding of some ten products of numbers up to 10."""
    random = np.random.default_rng(seed)
    count = degree + 1 + more
    points = random.uniform(-10, 10, (count, 3))
    weights = random.uniform(0.2, 3.0, count) if weighted else None
    inner = np.sort(random.uniform(0, 1, more))
    knots = [*[0.0] * degree, *inner, *[1.0] * degree]
    curve = rhino3dm.NurbsCurve(3, True, degree + 1, count)
    for i, (p, w) in enumerate(zip(points, np.ones(count) if weights is None else weights, strict=True)):
        curve.Points[i] = rhino3dm.Point4d(*(p * w), w)
    for i, knot in enumerate(knots):
        curve.Knots[i] = knot
    line = smooth(points, {"degree": degree, "knots": tuple(knots), "weights": weights})
    assert np.allclose(line[[0, -1]], points[[0, -1]], atol=1e-12)
    spans = np.unique(knots)
    at = np.unique(np.concatenate([np.linspace(a, b, 17) for a, b in pairwise(spans)]))
    wanted = [curve.PointAt(t) for t in at]
    assert np.allclose(line, [[p.X, p.Y, p.Z] for p in wanted], atol=1e-9)


def test_a_quarter_circle_of_three_control_points_is_round() -> None:
    """The rational quadratic with weights 1, sqrt(1/2), 1 is the circle, exactly."""
    corner = np.array([[1.0, 0, 0], [1, 1, 0], [0, 1, 0]])
    line = smooth(corner, {"degree": 2, "knots": (0.0, 0, 1, 1), "weights": np.array([1.0, 0.5**0.5, 1.0])})
    assert len(line) >= 17 and np.allclose(np.linalg.norm(line, axis=1), 1.0, atol=1e-14)


def test_carried_curves_appear(tmp_path: Path, words: list[str]) -> None:
    scene = cable(geometry=[{"kind": "curve", "particles": list(range(6))}])
    things = collect(relax(scene), scene)
    assert len(things.shape.strokes) == 1 and len(things.shape.strokes[0]) > 40
    drawn([Panel(relax(scene), scene)], tmp_path)
    assert "carried geometry" in words


RESULT = relax(cable())
X = RESULT.particles
REFUSALS: list[tuple[str, Any, dict[str, Any]]] = [
    ("panels: is empty", [], {}),
    ("panels/0: is a int", [3], {}),
    ("panels/1/view: 'sideways' given", [Panel(RESULT), Panel(RESULT, view="sideways")], {}),
    (r"panels/0/frame 'a': has the shape \(5, 3\); give \(6, 3\)", [Panel(RESULT, frames={"a": X[1:]})], {}),
    ("panels/0/frame 'a': has a coordinate that is not finite", [Panel(RESULT, frames={"a": X * np.nan})], {}),
    (r"panels/0/curve 'c': has the shape \(6, 2\)", [Panel(RESULT, curves={"c": X[:, :2]})], {}),
    ("panels/0/curve 'c': is not an array of numbers", [Panel(RESULT, curves={"c": "abc"})], {}),  # type: ignore[dict-item]
    ("panels/0/panel: has frames but no result", [Panel(frames={"a": X}, curves={"c": X})], {}),
    ("panels/0/panel: has nothing to draw", [Panel()], {}),
    ("panels/0/unit: 'furlong' given", [Panel(curves={"c": X}, unit="furlong")], {}),
    ("panels/0/graph: has neither lines nor dots", [Graph()], {}),
    ("panels/0/line 'a': has x of the shape", [Graph(lines={"a": ([1, 2], [1])})], {}),  # type: ignore[dict-item]
    ("panels/0/line 'a': is not a pair", [Graph(lines={"a": [1]})], {}),  # type: ignore[dict-item]
    ("panels/0/dots 'a': has a number that is not finite", [Graph(dots={"a": ([1], [np.inf])})], {}),  # type: ignore[dict-item]
    ("panels/0/line 'a': .*not positive", [Graph(lines={"a": ([1], [0])}, y_log=True)], {}),  # type: ignore[dict-item]
    ("columns: 0 given", [Panel(RESULT)], {"columns": 0}),
    ("size: .* 200 to 10000", [Panel(RESULT)], {"size": (10, 10)}),
]


@pytest.mark.parametrize("said, given_panels, options", REFUSALS, ids=[r[0] for r in REFUSALS])
def test_refusals_say_where_and_what(said: str, given_panels: Any, options: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"^{said}"):
        sheet(given_panels, tmp_path / "s.png", **options)
    assert not list(tmp_path.iterdir())


def test_only_png(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"is not a \.png file"):
        sheet([Panel(RESULT)], tmp_path / "s.pdf")
