"""Near misses: what lies on another force without being joined to it is reported, and nothing else is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from hookean import InputError, Scene, Simulation
from hookean.discretize import grid
from hookean.forces import KINDS
from hookean.forces.groups import Grouped
from hookean.system import near_misses
from hookean.system.system import System, compile
from soak import examples


def polyline(start: Any, end: Any, pieces: int) -> Any:
    points = np.linspace(start, end, pieces + 1)
    return np.stack([points[:-1], points[1:]], axis=1)


def mesh(count: int, size: float = 1.0, z: float = 0.0) -> dict[str, Any]:
    """A square of `count` x `count` faces from the origin."""
    steps = np.arange(count + 1) * size / count
    return vars(grid(steps, steps, z))


def springs(name: str, lines: Any) -> dict[str, Any]:
    return {"kind": "springs", "name": name, "lines": lines}


def found(*forces: dict[str, Any], **more: Any) -> list[str]:
    return compile(Scene.read({"forces": list(forces), **more})).report.warnings


NET = {"kind": "springs", "name": "net", "mesh": "m"}
ADVICE = "Divide both the same way or raise weld_tolerance"


@pytest.mark.parametrize("kind", ["springs", "soapfilm"])
def test_a_cable_of_15_pieces_on_an_edge_of_20(kind: str) -> None:
    """They share i / 15 = j / 20 where 3 divides i: 6 of 16 particles; the first other one is at 1 / 15 of the edge."""
    cable = springs("cable", polyline([0, 0, 0], [3, 0, 0], 15))
    said = found({**NET, "kind": kind}, cable, meshes={"m": mesh(20, 3.0)}, units={"length": "ft"})
    assert said == [
        "cable: 10 of 16 particles lie on edges of net, within a tenth of their length, but are not joined to it; the "
        f"first is particle 441 at (0.2, 0, 0), 0 ft away. {ADVICE}"
    ]


@pytest.mark.parametrize("pieces", [1, 2, 4, 20])
def test_what_is_joined_at_every_particle_or_by_its_ends_alone_is_no_near_miss(pieces: int) -> None:
    """The same division; and ties of 20, 10 or 5 edges, whose ends are joined to the net they run along."""
    cable = springs("cable", polyline([0, 0, 0], [3, 0, 0], pieces))
    assert found(NET, cable, meshes={"m": mesh(20, 3.0)}) == []


def test_each_of_two_divisions_of_which_one_is_twice_the_other() -> None:
    """All particles of the coarse cable are the net's, and every second one of the edge lies on the cable alone."""
    [said] = found(NET, springs("cable", polyline([0, 0, 0], [3, 0, 0], 10)), meshes={"m": mesh(20, 3.0)})
    assert said.startswith("net: 10 of 441 particles lie on lines of cable")


@pytest.mark.parametrize(("part", "near"), [(0.0, True), (0.099, True), (0.101, False)])
def test_a_tenth_of_the_length_is_the_limit(part: float, near: bool) -> None:
    """The end of a cable `part` of an edge of 2 m beside the middle of it, on either side of a face of that size."""
    other = mesh(1, 2.0)
    for end, what in (([1, -2 * part, 0], "edges"), ([1, 1, 2 * part], "faces")):
        away = springs("mast", [[end, [end[0], -9 if what == "edges" else 1, 9]]])
        said = found({"kind": "soapfilm", "name": "film", "mesh": "m"}, away, meshes={"m": other})
        assert len(said) == near
        assert all(f"mast: 1 of 2 particles lie on {what} of film" in one for one in said)
        assert all(f", {2 * part:.3g} m away" in one for one in said)


def test_ends_that_nearly_meet() -> None:
    """Two cables of 1 m whose ends are 5 mm apart, farther than they weld."""
    said = found(springs("a", [[[0, 0, 0], [1, 0, 0]]]), springs("b", [[[1.005, 0, 0], [2, 0, 0]]]))
    assert [one.split(" lie")[0] for one in said] == ["b: 1 of 2 particles"]
    assert found(springs("a", [[[0, 0, 0], [1, 0, 0]]]), springs("b", [[[1.0005, 0, 0], [2, 0, 0]]])) == []


def wheel(hub: float) -> list[dict[str, Any]]:
    """Spokes of 1 m from a rim to the ends of a hub of this height."""
    rim = [[np.cos(a), np.sin(a), 0] for a in np.arange(12) * np.pi / 6]
    upper, lower = [0, 0, hub / 2], [0, 0, -hub / 2]
    return [
        springs("upper", [[upper, p] for p in rim]),
        springs("lower", [[lower, p] for p in rim]),
        springs("hub", [[lower, upper]]),
    ]


STRUCTURES: dict[str, tuple[list[dict[str, Any]], dict[str, Any]]] = {
    "diagonals that cross": ([NET, {**NET, "name": "x", "edges": "diagonals"}], {"m": mesh(6)}),
    "warp and weft": ([{**NET, "edges": edges, "name": edges} for edges in ("warp", "weft", "naked")], {"m": mesh(6)}),
    "springs, film and shell on one mesh": (
        [NET, {"kind": "soapfilm", "mesh": "m"}, {"kind": "shell", "mesh": "m"}],
        {"m": mesh(6)},
    ),
    "two nets, one above the other": (
        [NET, {**NET, "name": "n", "mesh": "n"}],
        {"m": mesh(6), "n": mesh(6, 1.0, 0.02)},
    ),
    "chords of a truss": (
        [springs("a", polyline([0, 0, 0], [9, 0, 0], 9)), springs("b", polyline([0, 0.11, 0], [9, 0.11, 0], 9))],
        {},
    ),
    "a fine cable that leaves a coarse net": (
        [NET, springs("guy", polyline([1, 1, 0], [1.1, 1.1, 0.05], 60))],
        {"m": mesh(3)},
    ),
    "a fine cable that leaves along an edge": (
        [NET, springs("guy", polyline([0, 0, 0], [1, 0, 0.2], 60))],
        {"m": mesh(3)},
    ),
    "a spoked wheel with a flat hub": (wheel(0.06), {}),
    "a fine cable past a long strut": (
        [springs("strut", [[[0, 0, 0], [10, 0, 0]]]), springs("b", polyline([5.03, -3, 0.04], [5.03, 3, 0.04], 79))],
        {},
    ),
    "a mast through a face": (
        [NET, springs("mast", polyline([0.4, 0.5, -3.04], [0.4, 0.5, 3], 9))],
        {"m": mesh(2)},
    ),
    "neighbours, and those after the next, of a chain": (
        [springs(f"{k}", [[[i, 0, 0], [i + k, 0, 0]] for i in range(9 - k)]) for k in (1, 2)],
        {},
    ),
    "an arch and its tie": (
        [springs("arch", polyline([0, 0, 0], [9, 0, 0], 12)), springs("tie", [[[0, 0, 0], [9, 0, 0]]])],
        {},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", STRUCTURES)
def test_ordinary_structures_have_none(name: str) -> None:
    forces, meshes = STRUCTURES[name]
    assert found(*forces, meshes=meshes) == []


def test_pulls_loads_and_hinges_are_nothing_to_lie_on() -> None:
    """What pulls to a curve or a mesh is beside it on purpose, and a hinge joins particles of a net."""
    forces = [
        {**NET, "mesh": "m"},
        {"kind": "pull_to_curve", "points": [[0, 0, 0], [1, 0, 0]], "curve": [[0, 0.001, 0], [1, 0.001, 0]]},
        {"kind": "pull_to_mesh", "mesh": "m", "target": "n"},
        {"kind": "pressure", "mesh": "m"},
        {"kind": "hinge", "points": [[[0.25, 0.25, 0], [0.25, 0.5, 0], [0, 0.25, 0], [0.5, 0.25, 0]]]},
    ]
    assert found(*forces, meshes={"m": mesh(4), "n": mesh(3, 1.0, 0.004)}) == []


def test_a_cable_on_an_arc_of_another_division() -> None:
    """A quarter of a circle in 15 chords and in 20: a particle is off the other chords by L^2 / (8 R) at most, 1.3 % of
    L = pi R / 30, and no chord has both its ends on the other cable."""

    def arc(pieces: int) -> Any:
        angle = np.linspace(0, np.pi / 2, pieces + 1)
        points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        return np.stack([points[:-1], points[1:]], axis=1)

    [said] = found(springs("a", arc(15)), springs("b", arc(20)))
    assert said.startswith("b: 15 of 21 particles lie on lines of a")


def test_many_pairs_are_a_few_sentences() -> None:
    """Six cables of coprime divisions on one line are 15 pairs."""
    cables = [springs(f"c{n}", polyline([0, 0, 0], [1, 0, 0], n)) for n in (7, 8, 9, 10, 11, 13)]
    said = found(*cables)
    assert len(said) == 11 and said[-1] == "particles of 5 more pairs of forces nearly meet"


def test_forces_of_one_name_or_none_are_called_by_their_place() -> None:
    cables = [springs("c", polyline([0, 0, 0], [1, 0, 0], n)) for n in (4, 5)]
    assert found(*cables)[0].startswith("/forces/1: 4 of 6 particles lie on lines of /forces/0")


@pytest.mark.soak
def test_only_the_start_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not one force alone, and no patch of a running simulation."""
    cables = [springs(f"c{n}", polyline([0, 0, 0], [1, 0, 0], n)) for n in (4, 5)]
    running = Simulation(Scene.read({"forces": cables}))
    assert len(running.result().report.warnings) == 1
    monkeypatch.setattr(near_misses, "near_misses", None)
    running.patch({"forces": {"c4": {"stiffness": 5.0}}, "pin": [{"particles": [1]}]})
    running.step()
    assert len(running.result().report.warnings) == 1
    compile(Scene.read({"forces": [cables[0], {"kind": "self_weight", "total": 1.0}]}))


def oracle(points: Any, corners: Any) -> Any:
    """Distances from two triangles by their barycentric coordinates, of which 400 x 400 are tried."""
    u, v = np.meshgrid(np.linspace(0, 1, 400), np.linspace(0, 1, 400))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    least = np.full(len(points), np.inf)
    for a, b, c in ((0, 1, 2), (0, 2, 3)):
        for i, (p, q) in enumerate(zip(points, corners, strict=True)):
            on = q[a] + u[..., None] * (q[b] - q[a]) + v[..., None] * (q[c] - q[a])
            least[i] = min(least[i], np.sqrt(((on - p) ** 2).sum(axis=2).min()))
    return least


@pytest.mark.slow
def test_distances_are_those_of_the_nearest_of_many_points() -> None:
    """Faces, triangles, lines and points; what is tried lies within a step of 1 / 399 of the closest point."""
    random = np.random.default_rng(5)
    corners, points = random.normal(size=(24, 4, 3)), random.normal(size=(24, 3))
    corners[6:12, 3] = corners[6:12, 2]
    corners[12:18, 2:] = corners[12:18, 1:2]
    corners[18:20] = corners[18:20, :1]
    points[20:] = corners[20:].mean(axis=1)
    exact, tried = near_misses.distances(points, corners), oracle(points, corners)
    longest = np.ptp(corners, axis=1).max() * 2
    assert (tried >= exact - 1e-12).all() and (tried - exact <= longest / 399).all()


def cloud(seed: int, count: int) -> System:
    """Two forces of random lines of very different lengths, and a mesh, in a box; the same for the same seed."""
    random = np.random.default_rng(seed)
    starts = random.uniform(0, 1, size=(count, 3))
    ends = starts + random.normal(size=(count, 3)) * 10.0 ** random.uniform(-2, 0, size=(count, 1))
    lines = np.stack([starts, ends], axis=1)
    meshes = {"m": {"vertices": random.uniform(0, 1, size=(16, 3)), "faces": np.arange(16).reshape(4, 4)}}
    forces = [springs("a", lines[: count // 2]), springs("b", lines[count // 2 :]), {"kind": "soapfilm", "mesh": "m"}]
    return compile(Scene.read({"forces": forces, "meshes": meshes, "weld_tolerance": 0.0}))


def pairs(system: System) -> Any:
    """For each force the pairs that are near, by `near_misses` and by comparing all with all."""
    forces = [
        near_misses.Force(system, part, group.block.indices[part.rows])
        for group in system.groups
        for part in group.parts
    ]
    for force in forces:
        foreign = np.setdiff1d(np.arange(len(system.x)), force.index)
        near = near_misses.compared(system.x, force, foreign)
        count = len(force.lines) + len(force.faces)
        rows, particles = np.repeat(np.arange(count), len(foreign)), np.tile(foreign, count)
        elements = force.take(rows)
        away = near_misses.distances(system.x[particles], system.x[elements.corners])
        close = away < 0.1 * elements.length
        yield (
            set(zip(near.rows.tolist(), near.particles.tolist(), strict=True)),
            set(zip(rows[close].tolist(), particles[close].tolist(), strict=True)),
        )


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 60))
def test_cells_lose_no_pair(seed: int, count: int) -> None:
    """Elements of lengths from 0.01 to 1: what is compared, in cells, is all that is near."""
    for quick, whole in pairs(cloud(seed, count)):
        assert quick == whole


def test_a_tree_and_few_cells_find_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """The way of large scenes, on small ones."""
    monkeypatch.setattr(near_misses, "ALL_PAIRS", 0)
    monkeypatch.setattr(near_misses, "CELLS", 64)
    for seed in range(5):
        for quick, whole in pairs(cloud(seed, 50)):
            assert quick == whole and (seed or quick)


def test_of_very_many_particles_some_are_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every fourth of the 31 particles of a cable near the net, of which 10 are shared: a number that is too small."""
    monkeypatch.setattr(near_misses, "MOST", 8)
    [said] = found(NET, springs("cable", polyline([0, 0, 0], [1, 0, 0], 29)), meshes={"m": mesh(10)})
    count = int(said.split("cable: at least ")[1].split(" of 30")[0])
    assert 5 <= count <= 8


SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
PYRAMID = [[1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]]


def test_every_force_with_lines_or_faces_takes_part() -> None:
    """A cable across the middle of what each kind of force acts on, a tenth of it away at most. A force that is not
    solid, such as a power law, has nothing between its particles that it could lie on."""
    lying, solid = set(), set()
    # hinges and bends must meet particles
    corners = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0], [0, 1, 0], [2, 2, 1]]
    for kind, cls in KINDS.items():
        if cls.role != "internal" or (issubclass(cls, Grouped) and not cls.solid):
            continue
        if cls.solid and {"mesh", "lines"} & cls.model_fields.keys():
            solid.add(kind)
        needed = [name for name, field in cls.model_fields.items() if field.is_required()]
        elastic = {"beam": ["E", "G", "A", "Iy", "Iz", "J"], "membrane": ["warp_stiffness", "shear_stiffness"]}
        needed += elastic.get(kind, [])  # or a material
        other = {"kind": kind, "name": "it", **{name: getattr(cls.example()[0], name) for name in needed}}
        if "mesh" in cls.model_fields:
            other["mesh"] = "m"
        elif "lines" in cls.model_fields:
            other["lines"] = [[[0, 0, 0], [1, 0, 0]]]
        else:
            other["points"] = corners if cls.arity == 1 else [corners[: cls.arity]]
        cable = springs("c", [[[0.5, 0.4, 0.01], [0.5, 0.4, 5]], [[0.5, 0.01, 0], [0.5, -5, 0]]])
        try:
            said = found(other, cable, meshes={"m": mesh(1)}, particles=corners)
        except InputError:  # it takes closed meshes: the same square with four sides that meet below
            below = {"vertices": [*SQUARE, [0.5, 0.5, -1]], "faces": [[0, 1, 2, 3], *PYRAMID]}
            said = found(other, cable, meshes={"m": below}, particles=[*corners, [0.5, 0.5, -1]])
        if any(one.startswith("c:") and " of it, " in one for one in said):
            lying.add(kind)
    assert {"shell", "soapfilm", "springs"} <= solid and "power_law" not in solid
    assert lying == solid


def test_of_long_lines_across_one_another_a_bounded_number_of_pairs_is_compared() -> None:
    """Each of 3,000 points is within the length of each of 3,000 lines: 9,000,000 pairs, of which an even part is
    compared; of few, all are."""
    rng = np.random.default_rng(3)
    middle, points = rng.uniform(-0.1, 0.1, (2, 3000, 3))
    first, second, whole = near_misses._pairs(middle, points, 1.0)
    assert 0.9 * near_misses.PAIRS <= len(first) <= near_misses.PAIRS + 3000 and not whole
    assert len(np.unique(first)) == 3000 and np.ptp(np.diff(np.unique(second))) == 0
    first, second, whole = near_misses._pairs(middle, points, 0.01)
    apart = cdist(middle, points)
    found = np.zeros_like(apart, dtype=bool)
    found[first, second] = True
    assert whole and (found == (apart <= 0.01)).all() and len(first) == found.sum()
