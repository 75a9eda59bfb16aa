"""Derivatives through equilibrium: the adjoint against differences of whole solves for every force, closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.designing.columns import Column
from hookean.designing.equilibrium import Equilibrium, settle
from hookean.designing.problem import Problem
from hookean.designing.sensitivity import sensitivity
from hookean.designing.unknowns import Unknowns
from hookean.errors import InputError
from hookean.forces import KINDS
from hookean.system.system import compile
from soak import SOAK

from .held import columns, problem

FOUND = {kind for kind, cls in KINDS.items() if cls.kernel is not None and columns(cls.example()[0])}
RIGID = "rigid_collide"  # has no tangent
ELSEWHERE = {"floor", "impulse"}  # a contact, see test_kinks; a load of motions alone, which no equilibrium feels
SEEDS = range(50 if SOAK else 1)


def value(given: Problem, unknowns: np.ndarray) -> float:
    """The value of the goals at other values of the variables: a whole solve of its own."""
    system = compile(given.scene)
    own = Unknowns(given, system)
    state = system.start()
    own.put(system, state, unknowns)
    found = settle(system, state)
    return sum(g.weight * g.quantity.values(found, "/goals")[0] for g in given.goals)


def step_of(start: np.ndarray, unknown: int, part: float) -> float:
    """A step of an unknown: a part of its value, or of the mean of its column."""
    return part * max(abs(start[unknown]), float(np.abs(start).mean()) or 1.0)


def difference(given: Problem, start: np.ndarray, lower: np.ndarray, unknown: int, part: float = 1e-3) -> float:
    """The derivative by one unknown, by differences of fourth order, or of third order on one side of a bound."""
    step = step_of(start, unknown, part)
    away = np.zeros(len(start))
    away[unknown] = step
    if start[unknown] - 2.0 * step >= lower[unknown]:
        weights = {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12}
    else:
        weights = {0: -25 / 12, 1: 4, 2: -3, 3: 4 / 3, 4: -1 / 4}
    return sum(weight * value(given, start + way * away) for way, weight in weights.items()) / step


def test_every_force_is_differentiated_or_refused() -> None:
    """All kinds of the catalogue are in the law below, but for one without a tangent, which is refused in a sentence,
    and those that act otherwise."""
    assert set(KINDS) - FOUND == ELSEWHERE
    with pytest.raises(InputError, match="have no tangent, so nothing can be differentiated"):
        sensitivity(problem(RIGID, ["strength"], 0))


@pytest.mark.thinned
@pytest.mark.parametrize("kind", sorted(FOUND - {RIGID}))
def test_the_adjoint_is_the_difference_of_whole_solves(kind: str) -> None:
    """dg/du = y . df/du with K y = dg/dx, for every force by its columns: the column and element of the largest
    derivative, and a random one. Differences of order 4 with steps of 1e-3 leave 1e-9 or less of smooth functions;
    forces whose tangent is itself a difference add 1e-7 (see `Force.blur`): 1e-6 of the largest derivative. A kink
    within such a step lies outside a shorter one, or is reported. Values are rounded to 1e-15 of their sum, and of
    shapes to 1e-12 of the residual: by the step 1e-14 of them."""
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        fields = [name for name in columns(KINDS[kind].example()[0]) if varies(kind, name)]
        assert fields
        field = fields[int(rng.integers(len(fields)))] if not SOAK else fields[seed % len(fields)]
        given = problem(kind, [field], seed)
        found = sensitivity(given)
        assert found.result.converged and not found.warnings
        gradient = np.concatenate([part.ravel() for part in found.gradient])
        own = Unknowns(given, compile(given.scene))
        largest = float(np.abs(gradient).max())
        size = sum(g.weight * np.abs(v).sum() for g, v in zip(given.goals, found.values, strict=True))
        for unknown in {int(np.argmax(np.abs(gradient))), int(rng.integers(len(gradient)))}:
            for part in (1e-3, 1e-4, 1e-5):
                expected = difference(given, own.start, own.lower, unknown, part)
                rounding = 1e-14 * size / step_of(own.start, unknown, part)
                close = gradient[unknown] == pytest.approx(expected, abs=1e-6 * largest + rounding)
                if close:
                    break
            assert close, (seed, field, unknown, gradient[unknown], expected)


@pytest.mark.thinned
@pytest.mark.parametrize("kind", sorted(FOUND - {RIGID}))
def test_products_by_elements_are_those_of_the_matrices(kind: str) -> None:
    """y . df/du and some rows of K^T y, summed element by element, are products with the sparse df/du and the
    tangent: sums of the same products, so that they differ by rounding. Derivatives of columns are differences of
    values that are rounded to 1e-16 of their sum, by a step of 1e-5: 1e-11 of forces that may be a hundred times as
    large as what changes, 1e-9 of the largest."""
    fields = [name for name in columns(KINDS[kind].example()[0]) if varies(kind, name)]
    given = problem(kind, fields[:2], 3)
    system = compile(given.scene)
    unknowns, state = Unknowns(given, system), system.start()
    found = settle(system, state, once=True)
    y = np.random.default_rng(3).normal(size=state.x.shape)
    forces, _ = unknowns.slopes(found)
    work, largest = unknowns.work(found, y), np.abs(forces.T @ np.abs(y.ravel())).max()
    assert work == pytest.approx(forces.T @ y.ravel(), abs=1e-9 * largest)
    places = np.arange(0, y.size, 2)
    resisted = found.resisted(y.ravel(), places)
    whole = found.tangent.T @ y.ravel()
    size = np.abs(found.tangent).sum(axis=0).max() * np.abs(y).max()
    assert resisted[places] == pytest.approx(whole[places], abs=1e-13 * size)
    assert not np.delete(resisted, places).any()


@pytest.mark.parametrize("kind", sorted(kind for kind, cls in KINDS.items() if cls.linear))
def test_forces_that_are_linear_in_a_column_are_exact(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """`Force.linear` is a column that multiplies all of the force, so that forces at 1 are the derivatives: those that
    differences give, within 1e-9 of the largest as above, and at every shape."""
    given = problem(kind, [KINDS[kind].linear], 5)
    system = compile(given.scene)
    unknowns, state = Unknowns(given, system), system.start()
    state.x = state.x + 0.02 * system.size * np.random.default_rng(5).normal(size=state.x.shape)
    found = Equilibrium(system, state, None, once=True)
    assert unknowns.variables[0]._units(system)
    exact = unknowns.slopes(found)[0].toarray()
    monkeypatch.setattr(Column, "_units", lambda self, system: [])
    differences = unknowns.slopes(found)[0].toarray()
    assert exact == pytest.approx(differences, abs=1e-9 * np.abs(differences).max())


def varies(kind: str, field: str) -> bool:
    """Whether a column can be differentiated at all."""
    try:
        sensitivity(problem(kind, [field], 0))
    except InputError:
        return False
    return True


def cable(**more: Any) -> dict[str, Any]:
    """Two springs of stiffness k and rest length 1 that hold a load P at their middle, between supports 2 apart."""
    return {
        "particles": [[-1, 0, 0], [0, 0, -0.2], [1, 0, 0]],
        "forces": [
            {"kind": "springs", "name": "string", "particles": [[0, 1], [1, 2]], "stiffness": 100, "rest_length": 1},
            {"kind": "unary", "name": "load", "particles": [1], "vector": [0, 0, -5]},
        ],
        "anchors": [{"name": "left", "particles": [0]}, {"name": "right", "particles": [2]}],
        **more,
    }


def sag(k: float, rest: float, load: float) -> float:
    """The sag d of P = 2 k (l - L0) d / l, l² = 1 + d², by bisection."""
    low, high = 0.0, 10.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        length = np.hypot(1.0, middle)
        low, high = (middle, high) if 2.0 * k * (length - rest) * middle / length < load else (low, middle)
    return 0.5 * (low + high)


@pytest.mark.parametrize("field, force", [("stiffness", "string"), ("rest_length", "string")])
def test_the_sag_of_a_string_of_two_links(field: str, force: str) -> None:
    """dd/dk and dd/dL0 of the closed form (analytic-tests.md, two-link string), by differences of its root."""
    found = sensitivity(
        cable(),
        goals=[{"kind": "position", "particles": [1], "axes": "z"}],
        variables=[{"force": force, "field": field, "tie": "all"}],
    )
    step = {"stiffness": 1e-2, "rest_length": 1e-4}[field]
    change = {"stiffness": (step, 0.0), "rest_length": (0.0, step)}[field]
    both = [sag(100.0 + s * change[0], 1.0 + s * change[1], 5.0) for s in (1, -1)]
    assert found.value == pytest.approx(-sag(100.0, 1.0, 5.0), rel=1e-10)
    assert found.gradient[0] == pytest.approx([-(both[0] - both[1]) / (2 * step)], rel=1e-6)


def test_reactions_carry_the_load() -> None:
    """The sum of the vertical reactions is minus the load, whatever the stiffness: derivatives 0 and -1."""
    variables = [
        {"force": "string", "field": "stiffness"},
        {"force": "load", "field": "vector", "tie": "all", "axes": "z"},
        {"anchor": "left", "axes": "z"},
    ]
    goals = [{"kind": "reaction", "anchor": side, "axes": "z"} for side in ("left", "right")]
    found = sensitivity(cable(), goals=goals, variables=variables)
    assert found.value == pytest.approx(5.0, abs=1e-9)
    assert found.gradient[0] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert found.gradient[1] == pytest.approx([-1.0], abs=1e-9)
    assert found.gradient[2] == pytest.approx([0.0], abs=1e-6)


@pytest.mark.soak
def test_the_height_of_a_cap_by_its_pressure() -> None:
    """A bubble of radius R = 2 T / p over a rim of radius 1 has volume pi h (3 + h²) / 6 with h = R - sqrt(R² - 1);
    dV/dp of the closed form. The film of 32 x 12 triangles has the error of its mesh, of order 2: 3 %."""
    rings, around = 12, 32
    turn = 2.0 * np.pi * np.arange(around) / around
    points = [[0.0, 0.0, 0.0]]
    for r in np.arange(1, rings + 1) / rings:
        points += [[r * np.cos(t), r * np.sin(t), 0.2 * (1.0 - r * r)] for t in turn]
    faces = [[0, 1 + j, 1 + (j + 1) % around] for j in range(around)]
    for i in range(rings - 1):
        a, b = 1 + i * around, 1 + (i + 1) * around
        for j in range(around):
            k = (j + 1) % around
            faces += [[a + j, b + j, b + k], [a + j, b + k, a + k]]
    scene = {
        "meshes": {"cap": {"vertices": points, "faces": faces}},
        "forces": [
            {"kind": "soapfilm", "mesh": "cap", "tension": 1.0},
            {"kind": "pressure", "name": "air", "mesh": "cap", "pressure": 0.8},
        ],
        "anchors": [{"points": points[-around:]}],
    }

    def volume(p: float) -> float:
        radius = 2.0 / p
        height = radius - np.sqrt(radius**2 - 1.0)
        return float(np.pi * height * (3.0 + height**2) / 6.0)

    goals, variables = [{"kind": "volume", "mesh": "cap"}], [{"force": "air", "field": "pressure"}]
    found = sensitivity(scene, goals=goals, variables=variables)
    exact = (volume(0.8001) - volume(0.7999)) / 2e-4
    assert found.value == pytest.approx(volume(0.8), rel=0.03)
    assert found.gradient[0] == pytest.approx([exact], rel=0.03)
    steps = [sensitivity({**scene, "forces": [scene["forces"][0], {**scene["forces"][1], "pressure": p}]},
                         goals=goals, variables=variables).value for p in (0.801, 0.799)]  # fmt: skip
    assert found.gradient[0] == pytest.approx([(steps[0] - steps[1]) / 2e-3], rel=1e-4)


def test_what_cannot_vary_is_refused_in_a_sentence() -> None:
    """Unknown forces, columns, anchors; axes that an anchor leaves free; elements that do not exist."""
    goal = [{"kind": "position", "particles": [1], "axes": "z"}]
    for variable, at in (
        ({"force": "rope", "field": "stiffness"}, "/variables/0/force"),
        ({"force": "string", "field": "stifness"}, "/variables/0/field"),
        ({"force": "string", "field": "stiffness", "tie": [[0, 7]]}, "/variables/0/tie/0"),
        ({"anchor": "middle"}, "/variables/0/anchor"),
        ({"force": "string"}, "/variables/0/field"),
        ({}, "/variables/0"),
        ({"anchor": "left", "lower": 2, "upper": 1}, "/variables/0/lower"),
    ):
        with pytest.raises(InputError) as error:
            sensitivity(cable(), goals=goal, variables=[variable])
        assert error.value.pointer == at
    with pytest.raises(InputError, match="particle 9 does not exist"):
        sensitivity(cable(), goals=[{"kind": "position", "particles": [9]}], variables=[{"anchor": "left"}])
    with pytest.raises(InputError, match="no column 'colour'"):
        sensitivity(
            cable(),
            goals=[{"kind": "output", "force": "string", "column": "colour"}],
            variables=[{"anchor": "left"}],
        )


def test_a_column_that_switches_at_zero_is_refused() -> None:
    """A shear area of 0 stands for none of that deformation: no derivative there, and one for the beam that has one."""
    with pytest.raises(InputError, match="shear_y is 0, where beam changes by a jump"):
        sensitivity(problem("beam", ["shear_y"], 0))
    given = problem("beam", ["shear_y"], 0)
    given = given.replaced(variables=(given.variables[0].replaced(tie=[[1]]),))
    own = Unknowns(given, compile(given.scene))
    expected = difference(given, own.start, own.lower, 0)
    assert sensitivity(given).gradient[0] == pytest.approx([expected], rel=1e-6)


def test_vertices_of_a_solid_may_be_negative() -> None:
    """Coordinates have no least value: the scene's own shape is the one that is differentiated."""
    given = problem("collide_solid", ["vertices"], 0)
    assert np.isneginf(Unknowns(given, compile(given.scene)).lower).all()


def test_a_mechanism_is_reported() -> None:
    """The middle of a straight slack string moves freely: a warning or an error says so, and no gradient is NaN."""
    scene = cable()
    scene["particles"][1] = [0, 0, 0]
    scene["forces"] = scene["forces"][:1]
    try:
        found = sensitivity(scene, goals=[{"kind": "position", "particles": [1]}], variables=[{"anchor": "left"}])
    except InputError as error:
        assert "singular" in error.sentence
    else:
        assert "mechanism" in found.warnings[0] and all(np.isfinite(part).all() for part in found.gradient)


def test_yielded_springs_are_reported() -> None:
    """A string loaded beyond its elastic limit takes another way back than it came: derivatives are one-sided."""
    scene = cable()
    scene["forces"][0]["plasticity"] = 0.5
    goals, variables = [{"kind": "position", "particles": [1]}], [{"force": "string", "field": "stiffness"}]
    assert sensitivity(scene, goals=goals, variables=variables).warnings == []
    scene["forces"][0]["plasticity"] = 0.05
    assert "yielded" in sensitivity(scene, goals=goals, variables=variables).warnings[0]


@pytest.mark.parametrize(
    "prestress", [{}, {"force": 5.0}, {"strain": 0.02}, {"rest_length": 0.9}, {"rest_length": 0.9, "rest_factor": 0.97}]
)
def test_stiffness_of_prestressed_springs_by_differences_of_solves(prestress: dict[str, Any]) -> None:
    """The rest length of springs with a given force depends on their stiffness; with a given strain or length it does
    not. Central differences of whole solves, steps of 1e-4: 1e-8 and the accuracy of the solves, within 1e-6."""

    def scene(stiffness: np.ndarray) -> dict[str, Any]:
        chain = {"kind": "springs", "name": "chain", "particles": [[i, i + 1] for i in range(5)], **prestress}
        return {
            "particles": [[i, 0.0, 0.3 * (i % 2)] for i in range(6)],
            "forces": [
                {**chain, "stiffness": stiffness.tolist()},
                {"kind": "unary", "particles": [1, 2, 3, 4], "vector": [0, 0, -1]},
            ],
            "anchors": [{"particles": [0, 5]}],
            "settings": {"tolerance": 1e-12},
        }

    stiffness = np.array([50.0, 60.0, 70.0, 55.0, 45.0])
    found = sensitivity(
        scene(stiffness),
        goals=[{"kind": "position", "particles": [2], "axes": "z"}],
        variables=[{"force": "chain", "field": "stiffness"}],
    ).gradient[0]
    wanted = []
    for i, step in enumerate(1e-4 * stiffness):
        change = step * (np.arange(5) == i)
        up, down = (relax(Scene.read(scene(stiffness + way * change))).particles[2, 2] for way in (1.0, -1.0))
        wanted.append((up - down) / (2.0 * step))
    np.testing.assert_allclose(found, wanted, atol=1e-6 * np.abs(wanted).max())
