"""What the loops of solvers evaluate is the force that its kernel has in full."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean import Scene
from hookean.compiled import dispatch
from hookean.forces import KINDS, Block
from hookean.forces.shell_edges import angle_of
from hookean.forces.springs import SEVERAL
from hookean.solvers import solver
from hookean.system.packing import Desk, lean
from hookean.system.system import System, compile
from soak import examples, seeds

from .cases import example_system

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(30), database=None)
EPS = float(np.finfo(float).eps)


def springs(count: int = 12, **columns: object) -> System:
    """A dozen springs or more between ten particles, two of them without length, and one without any rest length."""
    rng = np.random.default_rng(5)
    x = rng.uniform(-1.0, 1.0, (10, 3))
    x[4] = x[3]
    pairs = [*rng.integers(0, 10, (count - 2, 2)).tolist(), [3, 4], [5, 5]]
    rest = rng.uniform(0.2, 2.0, count)
    rest[3] = 0.0
    force = {"kind": "springs", "particles": pairs, "rest_length": rest, "stiffness": rng.uniform(1, 1e4, count)}
    return compile(Scene(particles=x, forces=[{**force, **columns}]))


SPRINGS: dict[str, dict[str, object]] = {
    "plain": {"damping": 0.0},
    "damped": {"damping": np.linspace(0.0, 30.0, 12)},
    "cut off": {"upper_cutoff": 1.0},
    "many": {"count": 2 * SEVERAL + 5, "damping": 0.0},
    "many, damped": {"count": 2 * SEVERAL + 5},
}
KERNELS = [kind for kind, cls in KINDS.items() if cls.kernel is not None]


@cache
def system_of(name: str) -> System:
    """The example of a kind, or some springs."""
    return springs(**SPRINGS[name]) if name in SPRINGS else example_system(name)


@pytest.mark.parametrize("damped", [True, False])
@pytest.mark.parametrize("name", [*KERNELS, *SPRINGS])
@seeds(10, soak=30)
def test_lean_forces_are_the_forces(name: str, damped: bool, seed: int) -> None:
    """Packed blocks and summed loads push as the kernels in full do.

    An element's two ways differ by a few roundings of stiffness x coordinates and of its force, and the damping ones.
    """
    system, rng = system_of(name), np.random.default_rng(seed)
    state = system.start()
    far = 0.3 * system.size
    state.x += far * rng.uniform(-1.0, 1.0, state.x.shape) * (rng.random((len(state.x), 1)) < 0.8)
    state.v[:] = rng.normal(size=state.x.shape) if damped else 0.0
    expected, w, _ = system.evaluate(state, still=not damped)
    own = lean(system, state, damped=damped)
    x, v, f = Desk().lay(len(state.x), state.x, state.v, own.load)
    for kernel, arrays in own.calls[1]:
        dispatch.compiled(kernel, "force")(x, v, *arrays, f, np.zeros(len(x)))
    drag = 30.0 * np.abs(state.v).max() * len(system.groups[0].block.indices) if damped else 0.0
    size = w.max() * np.abs(state.x).max() + np.abs(expected).max() + drag
    assert np.abs(f[:, :3] - expected).max() <= 16.0 * EPS * size
    assert not f[:, 3].any() and not x[:, 3].any()


def test_springs_are_packed_where_they_can_be() -> None:
    """Two numbers each without damping, three with it; cutoffs need them all, and nothing else does."""
    numbers = {}
    for name in ("plain", "damped", "cut off"):
        system = system_of(name)
        numbers[name] = [lean(system, system.start(), damped=d).calls[1][0][1][1].size // 12 for d in (False, True)]
    whole = len(system_of("plain").groups[0].block.names)
    assert numbers == {"plain": [2, 2], "damped": [2, 3], "cut off": [whole, whole]}


def test_constant_forces_are_those_that_never_change() -> None:
    """A force that says it is constant is the same at any place, and one that does not say so changes somewhere."""
    rng = np.random.default_rng(3)
    for kind, cls in KINDS.items():
        if cls.kernel is not None:
            state = (system := example_system(kind)).start()
            first, _, _ = system.evaluate(state)
            state.x += 0.2 * rng.normal(size=state.x.shape)
            assert cls.constant == np.array_equal(first, system.evaluate(state)[0]), kind


def test_rows_on_a_desk_start_apart_and_hold_what_was_given() -> None:
    """Starts are aligned to a cache line and differ within a page; the next lay forgets what the last one left."""
    rows, desk = np.arange(30.0).reshape(10, 3), Desk()
    for _ in range(2):
        made = desk.lay(10, rows, None, rows, None, None)
        starts = [a.ctypes.data % 4096 for a in made]
        assert len(set(starts)) == 5 and not any(s % 64 for s in starts)
        assert all(np.array_equal(made[i][:, :3], rows) for i in (0, 2))
        assert not made[1].any() and not made[0][:, 3].any()
        for array in made:
            array[:] = np.nan


EDITS = ["nothing", "stiffness", "load", "place", "speed", "held", "floor", "another state"]


@pytest.mark.parametrize("damping", [0.0, 5.0])
@SEEDED
@given(seed=st.integers(0, 2**32 - 1), edits=st.lists(st.sampled_from(EDITS), min_size=1, max_size=6))
def test_what_verlet_keeps_between_calls_changes_no_bit(damping: float, seed: int, edits: list[str]) -> None:
    """A solver that goes on and one made anew for every call take the same steps, whatever is edited between them."""
    rng = np.random.default_rng(seed)
    forces = [
        {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3], [3, 4]], "stiffness": 50.0, "damping": damping},
        {"kind": "unary", "particles": [1, 2, 3, 4], "vector": [0.0, 0.1, -1.0]},
    ]
    floor = {"point": [0.0, 0.0, -0.2]} if seed % 2 else None
    settings = {"solver": "verlet", "time_step": 0.01, "floor": floor}
    system = compile(Scene(particles=rng.normal(size=(5, 3)), forces=forces, settings=settings))
    state, method = system.start(), solver("verlet")
    other = state.copy()
    for edit in edits:
        size, where = rng.uniform(0.5, 2.0), (int(rng.integers(5)), int(rng.integers(3)))
        if edit == "stiffness":
            system.groups[0].block.parameters[where[0] % 4, 0] *= size
        elif edit == "load":
            system.groups[1].block.parameters[where[0] % 4] *= size
        elif edit == "floor" and floor:
            system.contacts[0].block.parameters[0, 2] -= size
        elif edit == "another state":
            state, other = state.copy(), other.copy()
        for one in (state, other):
            if edit == "place":
                one.x[where] += size
            elif edit == "speed":
                one.v[where] -= size
            elif edit == "held":
                one.free[where[0]], one.v[where[0]] = 0.0, 0.0
        count = int(rng.integers(1, 4))
        method.advance(system, state, count, 0.0)
        solver("verlet").advance(system, other, count, 0.0)
        assert np.array_equal(state.x, other.x) and np.array_equal(state.v, other.v)
        assert state.time == other.time


def test_a_patched_shell_is_packed_anew() -> None:
    """Edges are found once, numbers are not: with another stiffness or rest angle the packed forces follow."""
    system = example_system("shell")
    state = system.start()
    state.x[4, 2] += 0.1
    (group,) = system.groups
    for column, factor in (("strength", 3.0), ("angle_factor", 0.5), ("strength", 1.0)):
        group.block.parameters[:, group.block.names.index(column)] *= factor
        expected, w, _ = system.evaluate(state)
        x, f = Desk().lay(len(state.x), state.x, None)
        ((kernel, arrays),) = lean(system, state, damped=True).calls[1]
        dispatch.compiled(kernel, "force")(x, x, *arrays, f, np.zeros(len(x)))
        assert np.abs(f[:, :3] - expected).max() <= 16.0 * EPS * w.max() * np.abs(state.x).max()


def skins() -> System:
    """A shell of mixed orientation, with naked edges and a band of one side, and a second one on some of its faces."""
    around = np.arange(12) * np.pi / 6.0
    rim = [[np.cos(t) * (2 + r * np.cos(t / 2)), np.sin(t) * (2 + r * np.cos(t / 2)), r * np.sin(t / 2)]
           for t in around for r in (-0.7, 0.6)]  # fmt: skip
    faces = []
    for i in range(12):
        a, b = 2 * i, 2 * i + 1
        c, d = (2 * i + 2, 2 * i + 3) if i < 11 else (1, 0)  # half a turn
        faces += [[a, b, d], [d, c, a] if i % 3 else [a, c, d]]
    meshes = {"band": {"vertices": rim, "faces": faces}, "part": {"vertices": rim, "faces": faces[3:11]}}
    shells = [
        {"kind": "shell", "mesh": "band", "strength": 30.0, "angle_factor": 0.3},
        {"kind": "shell", "mesh": "part", "strength": 7.0, "angle_factor": 1.0},
    ]
    return compile(Scene(particles=rim, meshes=meshes, forces=shells))


SKINS = skins()


@pytest.mark.parametrize("name", ["example", "skins"])
@SEEDED
@given(seed=st.integers(0, 2**32 - 1), part=st.sampled_from([0.0, 0.01, 0.3]))
def test_a_shell_as_a_whole_is_the_sum_of_its_elements(name: str, seed: int, part: float) -> None:
    """Forces and energy of element by element, within rounding of stiffness x coordinates; and at most their lumped
    stiffness, as moments on an edge that are opposite cancel before their size counts."""
    system, rng = (SKINS if name == "skins" else system_of("shell")), np.random.default_rng(seed)
    state = system.start()
    state.x += part * system.size * rng.uniform(-1.0, 1.0, state.x.shape)
    (group,) = system.groups
    block, kernel = group.block, dispatch.compiled(group.cls.kernel, "force")
    f, w, (energy,) = system.evaluate(state)
    expected, most = np.zeros_like(f), np.zeros_like(w)
    summed = kernel(state.x, 0.0 * f, block.indices, block.parameters, state.memory[0], expected, most)
    size = most.max() * np.abs(state.x).max() + np.abs(expected).max()
    assert np.abs(f - expected).max() <= 32.0 * EPS * size
    assert abs(energy - summed) <= 32.0 * EPS * (summed + size * np.abs(state.x).max())
    assert (w <= most * (1.0 + 1e-9)).all() and (w > 0.0).all()


@SEEDED
@given(kept=st.lists(st.booleans(), min_size=40, max_size=40))
def test_some_triangles_of_a_shell_bend_as_they_did_among_all(kept: list[bool]) -> None:
    """Forces, stiffness and energy of a part of the elements, whichever, as the kernel gives them one by one."""
    system = skins()
    state, (group,) = system.start(), system.groups
    state.x += 0.1 * np.random.default_rng(4).normal(size=state.x.shape)
    some = np.flatnonzero(kept[: len(group.block.indices)])
    group.block = Block(group.block.indices[some], group.block.parameters[some], group.block.memory[some])
    state.memory = [group.block.memory]
    f, w, (energy,) = system.evaluate(state)
    expected, most = np.zeros_like(f), np.zeros_like(w)
    kernel = dispatch.compiled(group.cls.kernel, "force")
    summed = kernel(state.x, 0.0 * f, group.block.indices, group.block.parameters, state.memory[0], expected, most)
    size = most.max() * np.abs(state.x).max() + np.abs(expected).max()
    assert np.abs(f - expected).max() <= 32.0 * EPS * size
    assert abs(energy - summed) <= 32.0 * EPS * (summed + size * np.abs(state.x).max())


@SEEDED
@given(angle=st.floats(-np.pi, np.pi), size=st.floats(1e-100, 1e100))
def test_small_angles_are_those_of_arctan2(angle: float, size: float) -> None:
    """A series below 1/8: it leaves out 2e-16 of the angle; rounding of its sums and arctan2 itself add 4 eps."""
    for small in (angle, 0.03 * angle, 1e-6 * angle):
        along, across = size * np.cos(small), size * np.sin(small)
        assert abs(angle_of(along, across) - np.arctan2(across, along)) <= 4.0 * EPS * abs(small)
