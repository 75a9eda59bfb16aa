"""Linear buckling of trusses, cables, cloth and shells that move before they buckle: closed forms, and a program for
trusses that is written here."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.linalg

import hookean
from hookean import Scene
from hookean.analysis.matrices import Unknowns
from hookean.analysis.stress_stiffness import stress_stiffness
from hookean.system.system import compile

Floats = np.ndarray
Spec = dict[str, Any]


def factors(x: Any, forces: list[Spec], anchors: list[Spec], count: int = 3, **more: Any) -> Floats:
    return hookean.buckling(Scene.read({"particles": x, "forces": forces, "anchors": anchors, **more}), count).factors


def springs(pairs: Any, stiffness: Any, **more: Any) -> Spec:
    return {"kind": "springs", "particles": np.asarray(pairs), "stiffness": stiffness, **more}


def push(particles: Any, vectors: Any) -> Spec:
    return {"kind": "unary", "particles": particles, "vector": vectors}


@pytest.mark.parametrize("rise", [0.02, 0.3, 2.0])
def test_von_mises_truss(rise: float) -> None:
    """Bars of span b and rise r, length l, have N = -P l / (2 r), so G is -b^2 / (l^2 r) downwards and -r / l^2
    sideways beside K = 2 k r^2 / l^2 and 2 k b^2 / l^2: P = 2 k r^3 / b^2 and 2 k b^2 / r. Of a shallow truss the
    first is 3 sqrt 3 times the limit load, 2 k r^3 / (3 sqrt 3 b^2) to r^2 / b^2 (von Mises 1923)."""
    k, b = 100.0, 1.0
    x, held = [[-b, 0, 0], [0, 0, rise], [b, 0, 0]], [{"particles": [0, 2]}, {"particles": [1], "axes": "y"}]
    forces = [springs([[0, 1], [1, 2]], k), push([1], [0, 0, -1e-3])]
    found = factors(x, forces, held)
    np.testing.assert_allclose(found, np.sort([2e3 * k * rise**3 / b**2, 2e3 * k * b**2 / rise]), rtol=1e-9)
    if rise < 0.1:
        path = hookean.load_path(
            Scene.read({"particles": x, "forces": forces, "anchors": held}), increment=found[0] / 50
        )
        assert found[0] / path.critical_points[0].factor == pytest.approx(3.0 * np.sqrt(3.0), rel=2.0 * rise**2)


def program(x: Floats, pairs: Floats, k: Floats, held: Floats, force: Floats) -> Floats:
    """All positive factors of a truss without prestress, the smallest first, by dense matrices."""
    size = x.size
    stiff, stress = np.zeros((size, size)), np.zeros((size, size))
    free = np.flatnonzero(~held.ravel())
    columns = np.zeros((size, len(pairs)))
    for i, (a, b) in enumerate(pairs):
        d = x[b] - x[a]
        columns[3 * a : 3 * a + 3, i], columns[3 * b : 3 * b + 3, i] = -d / np.linalg.norm(d), d / np.linalg.norm(d)
    stiff = columns @ np.diag(k) @ columns.T
    moved = np.zeros(size)
    moved[free] = np.linalg.solve(stiff[np.ix_(free, free)], force.ravel()[free])
    normal = k * (columns.T @ moved)
    for i, (a, b) in enumerate(pairs):
        d = x[b] - x[a]
        length = np.linalg.norm(d)
        across = np.eye(3) - np.outer(d, d) / length**2
        places = np.r_[3 * a : 3 * a + 3, 3 * b : 3 * b + 3]
        stress[np.ix_(places, places)] += normal[i] / length * np.kron([[1, -1], [-1, 1]], across)
    values = scipy.linalg.eigh(-stress[np.ix_(free, free)], stiff[np.ix_(free, free)], eigvals_only=True)
    return np.sort(1.0 / values[values > 1e-9 * np.abs(values).max()])


@pytest.mark.parametrize("seed", range(3))
def test_random_space_trusses_buckle_as_the_program_says(seed: int) -> None:
    """Irregular towers with stiffnesses over two decades and loads in all directions."""
    rng = np.random.default_rng(seed)
    x = np.concatenate([[[0, 0, z], [1, 0, z], [1, 1, z], [0, 1, z]] for z in range(4)]) + 0.15 * rng.normal(
        size=(16, 3)
    )
    near = [(a, b) for a in range(16) for b in range(a + 1, 16) if np.linalg.norm(x[a] - x[b]) < 1.9]
    pairs, held, force = np.array(near), np.zeros((16, 3), bool), rng.normal(size=(16, 3))
    held[:4] = True
    k = 10.0 ** rng.uniform(1.0, 3.0, len(pairs))
    found = factors(x, [springs(pairs, k), push(np.arange(16), force)], [{"particles": range(4)}], 5)
    np.testing.assert_allclose(found, program(x, pairs, k, held, force)[:5], rtol=1e-9)


def lattice(panels: int, height: float) -> tuple[Floats, dict[str, Floats]]:
    """A plane lattice of square panels in x z: particles 2 i of the chord z = 0 and 2 i + 1 of the other."""
    i = np.arange(panels)
    x = np.zeros((2 * panels + 2, 3))
    x[:, 0], x[:, 2] = np.repeat(np.arange(panels + 1.0), 2), np.tile([0.0, height], panels + 1)
    chords = np.concatenate([np.column_stack([2 * i + s, 2 * i + 2 + s]) for s in (0, 1)])
    posts = np.column_stack([2 * i + 2, 2 * i + 3])
    return x, {"chords": chords, "posts": posts, "diagonals": np.column_stack([2 * i, 2 * i + 3])}


@pytest.mark.parametrize("part", [0.01, 0.3, 1.0])
def test_a_laced_column_buckles_as_engesser_says(part: float) -> None:
    """A cantilever of two chords EA, h apart, laced by diagonals of stiffness k_d and rigid posts: Euler's
    P_E = pi^2 (EA h^2 / 2) / (4 L^2) becomes P_E / (1 + P_E / S), S = EA_d a h^2 / d^3 (Engesser 1891; Timoshenko and
    Gere, Theory of Elastic Stability, 1961, 2.18). The lacing makes it sway before it buckles. To
    1e-3 with 20 panels: their chords are straight pieces, which counts as 1 / 20^2."""
    panels, height, axial = 20, 1.0, 1e4
    x, bars = lattice(panels, height)
    euler = np.pi**2 * 0.5 * axial * height**2 / (4.0 * panels**2)
    diagonal = euler / part * (1.0 + height**2) / height**2  # S = k_d a h^2 / d^2 with a = 1
    forces = [springs(bars["chords"], axial), springs(bars["diagonals"], diagonal), springs(bars["posts"], 1e3 * axial)]
    forces.append(push([2 * panels, 2 * panels + 1], [-0.5, 0, 0]))
    held = [{"particles": [0, 1]}, {"particles": range(len(x)), "axes": "y"}]
    assert factors(x, forces, held, 1)[0] == pytest.approx(euler / (1.0 + part), rel=1e-3)


def test_the_chord_of_a_girder_buckles_sideways() -> None:
    """End moments F h press the top chord of n panels by F all along, and bend the girder. Springs c hold its joints
    sideways: F = c a / (4 sin^2(j pi / 2 n)), j = n - 1, n - 2 ... (a chain of pinned bars on springs)."""
    n, c = 8, 3.0
    x, bars = lattice(n, 0.7)
    tops = np.arange(3, 2 * n, 2)
    x = np.concatenate([x, x[tops] + [0, 1.0, 0]])
    props = np.column_stack([tops, np.arange(2 * n + 2, len(x))])
    webs = np.concatenate([bars["diagonals"], bars["posts"], [[0, 1]]])
    forces = [springs(bars["chords"], 2e3), springs(webs, 1e3), springs(props, c)]
    forces.append(push([0, 1, 2 * n, 2 * n + 1], [[-1.0, 0, 0], [1.0, 0, 0], [1.0, 0, 0], [-1.0, 0, 0]]))
    held = [{"particles": [0], "axes": "xz"}, {"particles": [2 * n], "axes": "z"}, {"particles": props[:, 1]}]
    held.append({"particles": [*range(0, 2 * n + 2, 2), 1, 2 * n + 1], "axes": "y"})
    wanted = c / (4.0 * np.sin(np.arange(n - 1, n - 4, -1) * np.pi / (2 * n)) ** 2)
    np.testing.assert_allclose(factors(x, forces, held), wanted, rtol=1e-9)


def test_a_strip_of_cloth_on_springs_buckles() -> None:
    """Pressed by p per width b and free to widen, its stress is p along it alone: the joints, each on a spring c, leave
    the plane at p = 2 c a / (4 b sin^2(j pi / 2 n)), alike on both edges or opposed, j = n - 1 first."""
    n, c, b = 6, 2.0, 0.8
    x = lattice(n, b)[0][:, [0, 2, 1]]
    inner = np.arange(2, 2 * n)
    x = np.concatenate([x, x[inner] - [0, 0, 1.0]])
    props = np.column_stack([inner, np.arange(2 * n + 2, len(x))])
    i = np.arange(n)
    faces = np.column_stack([2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1])
    mesh = {"strip": {"vertices": x[: 2 * n + 2], "faces": faces}}
    skin = {"kind": "membrane", "mesh": "strip", "warp_stiffness": 500.0, "poisson": 0.3, "warp": [1.0, 0, 0]}
    forces = [skin, springs(props, c), push([2 * n, 2 * n + 1], [-0.5 * b, 0, 0])]
    held = [{"particles": [0, 1], "axes": "xz"}, {"particles": [0], "axes": "y"}, {"particles": props[:, 1]}]
    held.append({"particles": [2 * n, 2 * n + 1], "axes": "z"})
    sines = 4.0 * np.sin(np.repeat([n - 1, n - 2], 2) * np.pi / (2 * n)) ** 2
    np.testing.assert_allclose(factors(x, forces, held, 4, meshes=mesh), 2.0 * c / (b * sines), rtol=1e-6)


@pytest.mark.parametrize("aside", [0.0, 0.02])
def test_a_pressed_plate_buckles_whether_it_bends_before_or_not(aside: float) -> None:
    """A strip of D and width b as cloth and shell, clamped by a first row of quads a wide and pressed by 1, also with a
    force across: pi^2 D b / (2 (L - a / 2))^2 (Euler), as its first folds are at a. To 1 / (4 8^2), of a chain of 8."""
    n, length, width, bending = 8, 2.0, 0.5, 3.0
    x = lattice(n, width)[0][:, [0, 2, 1]] * [length / n, 1.0, 1.0]
    i = np.arange(n)
    mesh = {"strip": {"vertices": x, "faces": np.column_stack([2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1])}}
    skin = {"kind": "membrane", "mesh": "strip", "warp_stiffness": 1e6, "poisson": 0.3, "warp": [1.0, 0, 0]}
    forces = [skin, {"kind": "shell", "mesh": "strip", "strength": bending, "poisson": 0.0}]
    forces.append(push([2 * n, 2 * n + 1], [-0.5, 0, aside]))
    found = factors(x, forces, [{"particles": range(4)}], 1, meshes=mesh)[0]
    euler = np.pi**2 * bending * width / (4.0 * (length * (1.0 - 0.5 / n)) ** 2)
    assert found == pytest.approx(euler, rel=0.25 / n**2)


FREE: list[Spec] = [
    springs([[0, 1], [1, 2], [0, 2], [2, 3]], [3.0, 5.0, 2.0, 7.0]),
    {"kind": "hinge", "particles": [[0, 2, 1, 3], [1, 2, 0, 3]], "strength": [3.0, 5.0]},
    {"kind": "shell", "mesh": "skin", "strength": 4.0, "poisson": 0.3},
    {"kind": "membrane", "mesh": "skin", "warp_stiffness": 60.0, "weft_stiffness": 20.0, "shear_stiffness": 9.0,
     "poisson": 0.2, "warp": [1.0, 0.4, 0.1]},
]  # fmt: skip


@pytest.mark.parametrize("force", FREE, ids=lambda force: force["kind"])
def test_forces_turn_with_their_elements(force: Spec) -> None:
    """The forces f = K u of a movement u turn with an element that turns by w: G(u) (w x X) = w x f at each particle;
    and a turn brings no forces, G(w x X) = 0, where the tangent turns along it. To rounding, without prestress."""
    rng = np.random.default_rng(5)
    x = np.array([[0, 0, 0], [1.0, 0.2, 0.1], [0.9, 1.1, 0.4], [-0.2, 1.0, 0.2]])
    mesh = {"skin": {"vertices": x, "faces": [[0, 1, 2], [0, 2, 3]]}}
    system = compile(Scene.read({"particles": x, "forces": [force], "meshes": mesh}))
    state = system.start()
    count = len(state.x)
    unknowns = Unknowns.of(system, state, np.ones((count, 3)))
    turn, moved = rng.normal(size=3), rng.normal(size=(count, 3))
    turned = np.cross(turn, state.x)
    stiff = stress_stiffness(unknowns, system, state, moved)
    forces = (unknowns.tangent(system, state) @ moved.ravel()).reshape(count, 3)
    size = np.abs(forces).max()
    assert size > 1.0
    np.testing.assert_allclose((stiff @ turned.ravel()).reshape(count, 3), np.cross(turn, forces), atol=1e-12 * size)
    assert abs(stress_stiffness(unknowns, system, state, turned)).max() < 1e-12 * size


def test_a_cable_over_a_pulley_leaves_it_without_hold() -> None:
    """A pulley hangs at depth r on a cable with the force T between ends 2 b apart, l to each, and is lifted by P.
    Then T / l changes by q = -P (r / l^2) (2 k - T / l) / K, K = 4 k r^2 / l^2 + 2 T b^2 / l^3: along the cable and
    across its plane only T / l holds, until q = -T / l, and up and down K + 2 q b^2 / l^2 = 0."""
    b, r, tension, axial = 1.2, 0.5, 4.0, 300.0
    length = np.hypot(b, r)
    x = [[-b, 0, 0], [0, 0, -r], [b, 0, 0]]
    forces = [
        {"kind": "sliding_cable", "particles": [[0, 1], [1, 2]], "axial_stiffness": axial, "force": tension},
        {**push([1], [0, 0, -2.0 * tension * r / length]), "name": "dead"},
        {**push([1], [0, 0, 1.0]), "name": "lift"},
    ]
    model = Scene.read({"particles": x, "forces": forces, "anchors": [{"particles": [0, 2]}]})
    k = (axial + tension) / (2.0 * length)  # EA / L0
    stiff = 4.0 * k * r**2 / length**2 + 2.0 * tension * b**2 / length**3
    q = -(r / length**2) * (2.0 * k - tension / length) / stiff
    sideways, lifted = -tension / length / q, -stiff * length**2 / (2.0 * q * b**2)
    found = hookean.buckling(model, loads=["lift"]).factors
    np.testing.assert_allclose(found, np.sort([sideways, sideways, lifted]), rtol=1e-8)
