"""Components: what is heavy, stiff or far away excuses nothing elsewhere. Oracles are own Newton steps and own sums."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from hookean import Result, Scene, relax
from hookean.forces import KINDS
from hookean.system.components import linked, sizes
from hookean.system.system import compile
from serving import SOAK

Spec = dict[str, Any]
SEEDS = range(500 if SOAK else 60)
SOLVERS = ("auto", "newton", "relaxation")


class Springs:
    """Springs and loads in numpy: the forces, the tangent and the components, by nothing of the engine's."""

    def __init__(self, x: Any, pairs: Any, stiffness: Any, rest: Any, loads: Any, held: Any) -> None:
        self.x = np.array(x, float)
        self.pairs = np.array(pairs, int).reshape(-1, 2)
        self.k = np.array(stiffness, float)
        self.rest = np.array(rest, float)
        self.loads = np.array(loads, float)
        self.free = np.ones(len(self.x), bool)
        self.free[np.array(held, int)] = False

    def spec(self, **settings: Any) -> Spec:
        """The scene."""
        loaded = np.flatnonzero(self.loads.any(axis=1))
        springs = {"kind": "springs", "name": "net", "particles": self.pairs, "stiffness": self.k, "damping": 0.0}
        forces: list[Spec] = [{**springs, "rest_length": self.rest}]
        if len(loaded):
            forces.append({"kind": "unary", "name": "load", "particles": loaded, "vector": self.loads[loaded]})
        anchors = [{"particles": np.flatnonzero(~self.free)}] if not self.free.all() else []
        return {"particles": self.x, "forces": forces, "anchors": anchors, "settings": settings}

    def solve(self, **settings: Any) -> Result:
        return relax(Scene.read(self.spec(**settings)))

    def tensions(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors along the springs, and k (l - L0)."""
        d = x[self.pairs[:, 1]] - x[self.pairs[:, 0]]
        length = np.linalg.norm(d, axis=1)
        return d / length[:, None], self.k * (length - self.rest)

    def left(self, x: np.ndarray) -> np.ndarray:
        """Out of balance (n, 3) on free particles."""
        along, tension = self.tensions(x)
        f = self.loads.copy()
        np.add.at(f, self.pairs[:, 0], tension[:, None] * along)
        np.add.at(f, self.pairs[:, 1], -tension[:, None] * along)
        return f * self.free[:, None]

    def tangent(self, x: np.ndarray) -> np.ndarray:
        """The dense tangent of the free particles: (k - T/l) d d^T + T/l I, a spring at a time."""
        along, tension = self.tensions(x)
        length = np.linalg.norm(x[self.pairs[:, 1]] - x[self.pairs[:, 0]], axis=1)
        whole = np.zeros((len(x), 3, len(x), 3))
        for (a, b), d, t, k in zip(self.pairs, along, tension / length, self.k, strict=True):
            block = (k - t) * np.outer(d, d) + t * np.eye(3)
            whole[a, :, a, :] += block
            whole[b, :, b, :] += block
            whole[a, :, b, :] -= block
            whole[b, :, a, :] -= block
        free = np.flatnonzero(self.free)
        return whole[free][:, :, free].reshape(3 * len(free), 3 * len(free))

    def components(self) -> tuple[np.ndarray, np.ndarray]:
        """The component of each particle, -1 of held ones; and which components hang on a held particle."""
        inner = self.free[self.pairs].all(axis=1)
        a, b = self.pairs[inner].T
        graph = coo_matrix((np.ones(len(a)), (a, b)), shape=(len(self.x), len(self.x)))
        label = connected_components(graph, directed=False)[1]
        half = self.free[self.pairs].any(axis=1) & ~inner
        hung = label[self.pairs[half][self.free[self.pairs[half]]]]
        supported = np.isin(label, hung)
        return np.where(self.free, label, -1), np.unique(label[supported & self.free])

    def verdict(self, x: np.ndarray, tolerance: float) -> str:
        """What a person would call it: "rest", "adrift" (loads that nothing holds), "coarse" (rounding hides the
        forces) or "moving". Rounding of a spring's coordinates leaves u k |x| on its ends; factors of 4 leave room for
        sums."""
        left, tension, start = np.linalg.norm(self.left(x), axis=1), self.tensions(x)[1], self.tensions(self.x)[1]
        label, supported = self.components()
        size = np.abs(x[self.pairs]).max(axis=(1, 2))
        noise = np.zeros(len(x))
        for end in (0, 1):
            np.add.at(noise, self.pairs[:, end], 1.1e-16 * (2.0 * self.k * size + np.abs(tension)))
        found = "rest"
        for part in np.unique(label[label >= 0]):
            mine = label == part
            loads = np.linalg.norm(self.loads[mine], axis=1)
            resultant = np.abs(self.loads[mine].sum(axis=0)).max()
            if part not in supported and resultant > 1e-6 * loads.sum():
                return "adrift"
            own = mine[self.pairs].any(axis=1)
            # without loads the forces, as they are and at least a thousandth of the largest that they were
            forces = max(np.abs(tension[own]).mean(), 2e-3 * np.abs(start[own]).mean()) if own.any() else 1.0
            scale = loads[loads > 0].mean() if loads.any() else forces
            if loads.any() and noise[mine].max() > 4e-3 * scale:
                return "coarse"
            if (left[mine] > np.maximum(1.01 * tolerance * scale, 4.0 * noise[mine])).any():
                found = "moving"
        return found


def chain(start: Any, count: int, k: float, rest: float, load: float) -> Springs:
    """Links of length 1 along x, both ends held, a load at each particle between."""
    x = np.array(start, float) + np.column_stack([np.arange(count + 1.0), *np.zeros((2, count + 1))])
    pairs = np.column_stack([np.arange(count), np.arange(count) + 1])
    loads = np.zeros((count + 1, 3))
    loads[:, 2] = -load
    return Springs(x, pairs, np.full(count, k), np.full(count, rest), loads, [0, count])


def joined(*parts: Springs) -> Springs:
    """Several structures as one."""
    starts = np.cumsum([0, *(len(p.x) for p in parts)])
    held = np.concatenate([np.flatnonzero(~p.free) + s for p, s in zip(parts, starts, strict=False)])
    return Springs(
        np.concatenate([p.x for p in parts]),
        np.concatenate([p.pairs + s for p, s in zip(parts, starts, strict=False)]),
        np.concatenate([p.k for p in parts]), np.concatenate([p.rest for p in parts]),
        np.concatenate([p.loads for p in parts]), held,
    )  # fmt: skip


def mast() -> Springs:
    """A chain that hangs from its top under 2e7 N."""
    x = [[0, 0, -float(i)] for i in range(5)]
    loads = np.zeros((5, 3))
    loads[-1, 2] = -2e7
    return Springs(x, [[i, i + 1] for i in range(4)], np.full(4, 1e10), np.ones(4), loads, [0])


def settled(structure: Springs) -> np.ndarray:
    """Positions by damped Newton steps of the test's own, to rounding."""
    x, free = structure.x.copy(), structure.free
    x[free, 2] -= 0.1
    for _ in range(200):
        f, shift = structure.left(x)[free].ravel(), 1e-6
        while True:
            try:
                step = np.linalg.solve(structure.tangent(x) + shift * np.eye(len(f)), f).reshape(-1, 3)
            except np.linalg.LinAlgError:
                step = np.full((free.sum(), 3), np.inf)
            trial = x.copy()
            trial[free] += step
            if np.isfinite(trial).all() and np.linalg.norm(structure.left(trial)) < np.linalg.norm(f):
                break
            if shift > 1e3 or np.linalg.norm(f) < 1e-12:
                return x
            shift *= 10.0
        x = trial
    return x


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_light_festoon_beside_a_heavy_mast_hangs_as_it_does_alone(solver: str) -> None:
    """0.5 N a node beside 2e7 N: positions of own Newton steps. What is left is at most 1e-6 of 0.5 N at each of five
    particles; the softest motion of the oracle's tangent turns that into a movement."""
    festoon = chain([10.0, 0.0, 0.0], 6, 100.0, 1.01, 0.5)
    found = joined(mast(), festoon).solve(solver=solver)
    expected = settled(festoon)
    softest = np.linalg.eigvalsh(festoon.tangent(expected))[0]
    assert found.converged, found.message
    assert np.abs(found.particles[5:] - expected).max() <= np.sqrt(5) * 0.5e-6 / softest + 1e-12
    assert expected[3, 2] < -0.7


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_light_festoon_that_nothing_holds_is_named_and_never_at_rest(solver: str) -> None:
    festoon = chain([10.0, 0.0, 0.0], 6, 100.0, 1.01, 0.5)
    festoon.free[:] = True
    found = joined(mast(), festoon).solve(solver=solver, max_iterations=3000)
    assert not found.converged
    sentence = joined(mast(), festoon).solve(solver=solver).message
    assert "Nothing supports the 7 particles connected with particle 5 (of /forces/0, springs)" in sentence
    assert "3.5 N" in sentence


@pytest.mark.slow
def test_a_small_load_on_a_large_part_that_nothing_holds_is_no_rest() -> None:
    """One newton on one of 401 particles: a residual of 1 / 401, but shared evenly it would pass 1e-2."""
    x = np.column_stack([np.arange(401.0), *np.zeros((2, 401))])
    loads = np.zeros((401, 3))
    loads[:, 0] = np.where(np.arange(401) % 2, 1.0, -1.0)
    loads[-1, 0] += 1.0 + 1e-5
    loads[0, 0] = 0.0
    row = Springs(x, [[i, i + 1] for i in range(400)], np.full(400, 1e3), np.ones(400), loads, [])
    found = row.solve(solver="relaxation", tolerance=1e-2)
    assert not found.converged and "Nothing supports" in found.message


def test_loads_that_balance_one_another_need_no_support() -> None:
    """A spring pulled at both ends by 5 N, with nothing to hold it: 5 / 100 longer, and free to move as a whole."""
    bar = Springs([[0, 0, 0], [1, 0, 0]], [[0, 1]], [100.0], [1.0], [[-5, 0, 0], [5, 0, 0]], [])
    found = bar.solve()
    assert found.converged
    assert np.ptp(found.particles[:, 0]) == pytest.approx(1.05, abs=1e-6)
    assert found.stability == "mechanism" and found.soft_modes == 3  # three translations; the pull turns it back


@pytest.mark.parametrize("far", [1e6, 1e10])
@pytest.mark.parametrize("solver", SOLVERS)
def test_a_stray_anchor_far_away_excuses_nothing(far: float, solver: str) -> None:
    """The cable's own coordinates decide how well its forces are known."""
    cable = chain([0.0, 0.0, 0.0], 5, 1000.0, 1.0, 1.0)
    stray = Springs([[far, 0, 0]], np.zeros((0, 2)), [], [], [[0, 0, 0]], [0])
    found = joined(cable, stray).solve(solver=solver)
    assert found.converged and found.rounding_floor < 1e-11
    assert np.linalg.norm(cable.left(found.particles[:6]), axis=1).max() <= 1e-6


@pytest.mark.parametrize("solver", SOLVERS)
def test_forces_that_rounding_hides_are_no_equilibrium(solver: str) -> None:
    """1e10 N/m at 1e6 m: coordinates of 1e-10 m leave 1 N, more than the loads of 1e-3 N."""
    found = joined(chain([0.0, 5.0, 0.0], 4, 10.0, 1.0, 1.0), chain([1e6, 0.0, 0.0], 4, 1e10, 1.0, 1e-3)).solve(
        solver=solver
    )
    assert not found.converged and found.rounding_floor > 1e-3
    assert "Rounding alone" in found.message and "particle 6 (of /forces/0, springs)" in found.message


def test_components_are_listed_where_there_are_several() -> None:
    """Two chains, a free bar without loads, an idle particle: three components, each with its own figures."""
    bar = Springs([[0, 9, 0], [1, 9, 0]], [[0, 1]], [10.0], [1.0], np.zeros((2, 3)), [])
    idle = Springs([[0, 20, 0]], np.zeros((0, 2)), [], [], np.zeros((1, 3)), [])
    chains = [chain([0.0, 5.0 * i, 0.0], 4, 100.0, 1.0, 2.0**i) for i in range(2)]
    found = joined(*chains, bar, idle).solve()
    listed = found.components
    assert listed["first_particle"].tolist() == [1, 6, 10] and listed["particles"].tolist() == [3, 3, 2]
    assert listed["supported"].tolist() == [True, True, False] and listed["loaded"].tolist() == [True, True, False]
    assert listed["force_scale"][:2] == pytest.approx([1.0, 2.0])
    assert listed["residual"] == pytest.approx(listed["out_of_balance"] / listed["force_scale"])
    assert (listed["position_error"] != listed["position_error"]).all()  # the free bar's tangent is singular
    assert found.to_dict()["components"]["position_error"] == [None, None, None]
    alone = chains[0].solve()
    assert all(len(column) == 0 for column in alone.components.values())


def scene_of(seed: int) -> tuple[Springs, str]:
    """Two to four structures in disorder: heavy and light, held and free, near and far, stiff and soft."""
    rng = np.random.default_rng([17, seed])
    parts = []
    for _ in range(rng.integers(2, 5)):
        count, load = int(rng.integers(2, 7)), 10.0 ** rng.uniform(-4, 7) * (rng.random() < 0.8)
        stiffness = (load or 1.0) * 10.0 ** rng.uniform(1, 4)
        away = 10.0 ** rng.uniform(0, 6) if rng.random() < 0.3 else 10.0
        part = chain(rng.uniform(-away, away, 3), count, stiffness, float(rng.uniform(0.9, 1.05)), load)
        kind = rng.random()
        if kind < 0.2:
            part.free[:] = True  # adrift
        elif kind < 0.5:
            part.free[-1] = True  # a pendulum
        if rng.random() < 0.3:
            part.loads[:] = rng.normal(size=part.loads.shape) * load
        part.x[part.free] += rng.normal(size=(int(part.free.sum()), 3)) * 0.1
        parts.append(part)
    if rng.random() < 0.3:
        parts.append(
            Springs([rng.normal(size=3) * 10.0 ** rng.uniform(0, 10)], np.zeros((0, 2)), [], [], [[0, 0, 0]], [0])
        )
    return joined(*parts), str(rng.choice(SOLVERS))


@pytest.mark.thinned
@pytest.mark.parametrize("seed", SEEDS)
def test_an_independent_evaluator_agrees_with_the_status(seed: int) -> None:
    """Converged is at rest in every component, and no component adrift; and what is at rest is called converged, unless
    a run ended for another reason. Stable has a positive definite tangent, and a position error is K^-1 f within 3."""
    structure, solver = scene_of(seed)
    found = structure.solve(solver=solver, max_iterations=20_000)
    verdict = structure.verdict(found.particles, 1e-6)
    if found.converged:
        assert verdict == "rest", found.message
    elif found.status == "stalled":
        assert verdict != "rest" or "position_tolerance" in found.message, found.message
    if found.stability in ("stable", "unstable"):
        values = np.linalg.eigvalsh(structure.tangent(found.particles))
        noise = 1e-13 * structure.k.max()
        assert values[0] > -noise if found.stability == "stable" else values[0] < noise
    if found.position_error is not None:
        free = structure.free
        step = np.linalg.solve(structure.tangent(found.particles), structure.left(found.particles)[free].ravel())
        exact = np.linalg.norm(step.reshape(-1, 3), axis=1).max(initial=0.0)
        rounding = 1e-15 * np.abs(found.particles).max() * structure.k.max() / np.abs(values[0])
        assert exact / 3.0 - rounding <= found.position_error <= 3.0 * exact + rounding


@pytest.mark.parametrize("floor", [False, True])
def test_what_slides_or_may_fall_on_a_floor_is_not_joined(floor: bool) -> None:
    """Two particles on a spring, one that an anchor holds on x alone, one that nothing touches, one held. What a floor
    holds depends on the loads; results list what may fall on it as supported."""
    springs = {"kind": "springs", "particles": [[0, 1]]}
    settings = {"floor": {"point": [0, 0, -5]}} if floor else {}
    spec = {"particles": [[i, 0, 0] for i in range(5)], "forces": [springs], "settings": settings}
    system = compile(Scene.read({**spec, "anchors": [{"particles": [2], "axes": "x"}, {"particles": [4]}]}))
    parts = system.components(system.start())
    assert parts.first.tolist() == [0, 2, 3] and parts.label.tolist() == [0, 0, 1, 2, -1]
    assert parts.joined.tolist() == [True, False, False]
    assert parts.supported.tolist() == [False, True, False]
    assert np.trace(parts.loose, axis1=1, axis2=2) == pytest.approx([3.0, 2.0, 3.0])
    loads = {"kind": "unary", "particles": [1, 3], "vector": [[0, 0, -1], [0, 0, -1]]}
    found = relax(Scene.read({**spec, "forces": [springs, loads], "settings": {**settings, "max_iterations": 3}}))
    assert found.components["supported"].tolist() == [floor, floor]


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e200])
def test_the_size_of_a_component_is_the_diagonal_of_its_box(scale: float) -> None:
    """3 x 4 x 12, with the held particle that its springs hold on to; of a particle alone its largest coordinate, and
    that of the first particle where squares are too large for a number."""
    x = np.array([[1.0, 2.0, 3.0], [4.0, -2.0, 3.0], [2.0, 2.0, 15.0], [-7.0, 3.0, 2.0]])
    springs = {"kind": "springs", "particles": [[0, 1], [1, 2]]}
    system = compile(Scene.read({"particles": x, "forces": [springs], "anchors": [{"particles": [2]}]}))
    found = sizes(system.components(system.start()), system.groups, x * scale)
    assert found / scale == pytest.approx([13.0 if scale < 1e100 else 3.0, 7.0], rel=1e-14)


def test_a_part_that_nothing_supports_is_named_when_iterations_run_out() -> None:
    """More iterations are no help: a chain that is held beside one that falls."""
    chains = [[[float(i), 0.0, z] for i in range(5)] for z in (0.0, 30.0)]
    springs = {"kind": "springs", "particles": [[i, i + 1] for i in (0, 1, 2, 3, 5, 6, 7, 8)], "stiffness": 1000.0}
    load = {"kind": "unary", "particles": [1, 2, 3], "vector": [0.0, 0.0, -1e-4]}
    scene = {"particles": [*chains[0], *chains[1]], "forces": [springs, load], "anchors": [{"particles": [5, 9]}]}
    found = relax(Scene.read({**scene, "settings": {"solver": "relaxation", "max_iterations": 50}}))
    assert found.status == "max_iterations" and "Raise max_iterations" not in found.message
    assert "Nothing supports the 5 particles connected with particle 0" in found.message


def a_bar(load: Any, *more: Spec, axes: str = "", **settings: Any) -> Spec:
    """Two particles on a spring along x, loaded at one end; the other held on some axes."""
    springs = {"kind": "springs", "particles": [[0, 1]], "stiffness": 1000.0}
    loads = {"kind": "unary", "particles": [1], "vector": load}
    anchors = [{"particles": [0], "axes": axes}] if axes else []
    spec = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": [springs, loads, *more], "anchors": anchors}
    return {**spec, "settings": {"max_iterations": 500, **settings}}


PLANE = {"kind": "pull_to_plane", "particles": [0, 1]}
LINE = {"kind": "pull_to_line", "particles": [0, 1]}
TURN = [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]]  # about z
LOOSE: list[tuple[str, list[float], tuple[Spec, ...], str, str]] = [
    ("x", [0, 5, 0], (), "y", "5"),
    ("xz", [3, 5, 7], (), "y", "5"),
    ("z", [3, 4, 7], (), "(0.6, 0.8, 0)", "5"),
    ("", [0, 5, 7], (PLANE,), "y", "5"),
    ("", [3, 4, 7], ({**PLANE, "normal": [1, 0, 1]},), "(-0.408, 0.816, 0.408)", "4.9"),
    ("", [3, 4, 7], (LINE,), "z", "7"),
    ("x", [3, 4, 7], (LINE,), "z", "7"),
    ("x", [3, 0, 5], ({"kind": "direction", "particles": [[0, 1]], "direction": [1, 0, 0]},), "z", "5"),
    ("y", [3, 5, 0], ({"kind": "translation_lock", "particles": [[0, 1]]},), "x", "3"),
    ("", [3, 4, 0], ({"kind": "mirror", "particles": [[0, 1]], "normal": [1, 0, 0]},), "y", "4"),
    ("", [3, 4, 7], ({"kind": "transform_lock", "particles": [[0, 1]], "matrix": TURN},), "z", "7"),
]


@pytest.mark.parametrize("solver", ["auto", "relaxation"])
@pytest.mark.parametrize(("axes", "load", "more", "along", "size"), LOOSE)
def test_what_is_held_on_some_axes_and_loaded_along_others_is_named(
    axes: str, load: Any, more: tuple[Spec, ...], along: str, size: str, solver: str
) -> None:
    """The forces between particles cancel, and a pull to a plane only acts along its normal, one to a line across that,
    one to an image square to what the image leaves in place: the loads have a resultant that nothing can balance."""
    found = relax(Scene.read(a_bar(load, *more, axes=axes, solver=solver)))
    assert not found.converged
    assert f"Nothing supports the 2 particles connected with particle 0 (of /forces/0, springs) along {along}, " in (
        found.message
    )
    assert f"a load of {size} N: hold them in that direction too" in found.message


@pytest.mark.parametrize("solver", ["auto", "newton", "relaxation"])
def test_what_is_held_on_one_axis_is_not_converged_by_a_loose_tolerance(solver: str) -> None:
    """A resultant of a thousandth of the loads, and a tolerance of a hundredth."""
    loads = {"kind": "unary", "particles": [0], "vector": [0, -0.999, 0]}
    found = relax(Scene.read(a_bar([0, 1, 0], loads, axes="x", solver=solver, tolerance=0.01)))
    assert not found.converged and "along y, where they carry a load of 0.001 N" in found.message


@pytest.mark.parametrize("axes", ["y", "xyz"])
def test_what_is_held_along_its_loads_converges(axes: str) -> None:
    found = relax(Scene.read(a_bar([0, 5, 0], axes=axes)))
    assert found.converged, found.message
    slides = relax(Scene.read(a_bar([0, 5, 0], {**PLANE, "normal": [0, 1, 0]}, max_iterations=100_000)))
    assert slides.converged, slides.message


FLOOR: list[tuple[list[float], float, str, bool]] = [
    ([0, 0, -5], 0.0, "", True),
    ([0, 0, 5], 0.5, "", False),
    ([2, 0, -5], 0.5, "", True),
    ([3, 0, -5], 0.5, "", False),
    ([1, 0, -5], 0.0, "", False),
    ([1, 0, -5], 0.0, "x", True),
    ([1, 1, -5], 0.0, "x", False),
    ([0, 0, 5], 0.5, "z", True),
]


@pytest.mark.parametrize(("load", "friction", "axes", "rests"), FLOOR)
def test_what_a_floor_cannot_hold_is_named(load: Any, friction: float, axes: str, rests: bool) -> None:
    """It pushes and does not pull, and holds mu N by friction: Coulomb's cone."""
    floor = {"static_friction": friction, "kinetic_friction": friction}
    both = {"kind": "unary", "particles": [0], "vector": load}
    found = relax(Scene.read(a_bar(load, both, axes=axes, floor=floor, solver="relaxation")))
    assert found.converged == rests, found.message
    assert ("The floor cannot hold the 2 particles connected with particle 0" in found.message) != rests


@pytest.mark.parametrize("kind", ["collide", "collide_lines", "collide_2d", "box_collide", "rigid_collide"])
def test_crowds_of_two_forces_are_two_components(kind: str) -> None:
    """Elements of one force may come to rest on one another, those of two forces may not: far apart, one held and one
    under 1e6 times the load, they are judged apart."""
    example, start = KINDS[kind].example()
    x = np.concatenate([start, start + [1e3, 0.0, 0.0]])
    n, given = len(start), {"kind": kind, **example.model_dump(exclude_unset=True)}
    other = {**given, "particles": np.asarray(given["particles"]) + n}
    spec = {"particles": x, "forces": [given, other], "anchors": [{"particles": [0]}]}
    parts = compile(Scene.read(spec)).components(compile(Scene.read(spec)).start())
    assert len(np.intersect1d(parts.label[1:n], parts.label[n:])) == 0
    assert (parts.label[n:] == parts.label[n]).all() and parts.joined.all()
    assert not parts.supported[parts.label[n]] and parts.supported[parts.label[n - 1]]


@pytest.mark.parametrize("links", [0, 3, 30, 90])
def test_links_connect_points_as_graphs_do(links: int) -> None:
    """Two points have one label if a path of links joins them: as the components of a graph, which SciPy finds."""
    pairs = np.random.default_rng(links).integers(0, 60, (links, 2))
    expected = connected_components(coo_matrix((np.ones(links), (pairs[:, 0], pairs[:, 1])), (60, 60)))[1]
    label = linked(pairs, 60)
    assert np.array_equal(label[:, None] == label, expected[:, None] == expected)
