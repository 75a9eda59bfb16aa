"""Tangents of forces whose elements feel one another in groups, and what solvers do with groups of any size."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import InputError, Scene, relax
from hookean.forces import KINDS, Block, Force, groups
from hookean.linear.subsystem import cut
from hookean.system.system import compile
from soak import seeds

from . import laws
from .cases import Case, case_of, example_system, identity

GROUPED = [case_of(kind, *cls.example()) for kind, cls in KINDS.items() if issubclass(cls, groups.Grouped)]
every = pytest.mark.parametrize("case", GROUPED, ids=identity)


def assembled(elements: list[tuple[type[Force], Block]], x: np.ndarray) -> np.ndarray:
    """The stiffness of elements and of their own unknowns, which have one axis each."""
    nodes = max(int(block.indices.max()) + 1 for _, block in elements)
    whole = np.zeros((3 * nodes, 3 * nodes))
    for cls, block in elements:
        assert cls.tangent is not None
        for index, stiffness in zip(block.indices, cls.tangent(block, x), strict=True):
            axes = (3 * index[:, None] + np.arange(3)).ravel()
            np.add.at(whole, (axes[:, None], axes), stiffness)
    kept = [*range(x.size), *range(x.size, 3 * nodes, 3)]
    assert not np.delete(np.delete(whole, kept, 0), kept, 1).any()
    return whole[np.ix_(kept, kept)]


def tangent(case: Case, x: np.ndarray, node: int | None) -> np.ndarray:
    """What `gathered` gives, with the unknowns of groups condensed."""
    elements = KINDS[case.name].gathered(case.block, case.block.memory, x, node)
    assert elements is not None
    whole, size = assembled(elements, x), x.size
    own, cross = whole[size:, size:], whole[:size, size:]
    return np.asarray(whole[:size, :size] - (cross @ np.linalg.solve(own, cross.T) if len(own) else 0.0))


@every
@seeds(8, soak=25, most=0.1)
def test_the_tangent_of_groups_is_the_gradient_of_the_force(case: Case, seed: int, amount: float) -> None:
    """K = -df/dx by differences of order 4, step 1e-4: to 1e-6 of the largest entry, with and without nodes."""
    x = case.moved(np.random.default_rng(seed), amount)
    expected = laws._difference(case, x)
    for node in (None, len(x)):
        found = tangent(case, x, node)
        assert np.abs(found - expected).max() <= 1e-6 * np.abs(expected).max(), node


@every
def test_unknowns_of_groups_change_no_sign(case: Case) -> None:
    """With nodes there are as many negative eigenvalues: the energy is a minimum over the unknowns (Sylvester)."""
    for seed in range(5):
        x = case.moved(np.random.default_rng(seed), 0.05)
        scale = np.abs(dense := tangent(case, x, None)).max()
        elements = KINDS[case.name].gathered(case.block, case.block.memory, x, len(x))
        assert elements is not None
        sparse = np.linalg.eigvalsh(assembled(elements, x))
        assert (np.linalg.eigvalsh(dense) < -1e-7 * scale).sum() == (sparse < -1e-7 * scale).sum()


@every
def test_what_is_taken_of_a_block_is_whole_groups(case: Case) -> None:
    """One row asks for its group, which then has the forces that it had; numbers of groups may be any."""
    cls, head = KINDS[case.name], groups.heads(case.block)
    assert len(np.unique(head)) > 1 or "group" not in cls.model_fields
    for row in (0, len(head) - 1):
        rows, block = cls.taken(case.block, np.array([row]))
        assert (rows == np.flatnonzero(head == head[row])).all()
        x = case.moved(np.random.default_rng(row), 0.1)
        f = case.force(x)[0]
        part = type(case)(**{**vars(case), "block": block})
        mine = np.zeros(len(x), bool)
        mine[block.indices] = True
        others = np.delete(case.block.indices, rows, axis=0)
        mine[others] = False
        assert mine.any() and (part.force(x)[0][mine] == f[mine]).all()


@every
def test_members_of_a_group_are_one_component(case: Case) -> None:
    """Nothing else joins the particles: a component for each group, where groups share no particle."""
    system = example_system(case.name)
    found = system.components(system.start())
    head = groups.heads(case.block)
    for first in np.unique(head):
        assert len(np.unique(found.label[case.block.indices[head == first]])) == 1
    assert len(found.first) == len(np.unique(head))


@every
def test_a_part_of_a_net_has_whole_groups(case: Case) -> None:
    """Cut around one particle: its group comes along, with the same forces on it."""
    system = example_system(case.name)
    state = system.start()
    state.x[:] = case.moved(np.random.default_rng(5), 0.1)
    moving = np.zeros(len(state.x), bool)
    moving[case.block.indices[0, 0]] = True
    part, inner, particles = cut(system, state, moving)
    expected = system.evaluate(state)[0][moving]
    assert np.abs(part.evaluate(inner)[0][moving[particles]] - expected).max() <= 1e-13 * np.abs(expected).max()


def test_two_forces_with_the_same_numbers_are_two_groups() -> None:
    """Groups are those of one force, and a particle that met none leaves its group."""
    points = np.array([[0, 0, 0], [1, 0, 0.1], [0, 1, 0], [1, 1, 0], [5, 5, 5.0]])
    force = {"kind": "co_planar", "points": points, "group": [-3, -3, -3, -3, -3]}
    other = {"kind": "co_planar", "particles": [0, 1, 2]}
    system = compile(Scene(particles=points[:4], forces=[force, other], strict=False))
    (group,) = system.groups
    assert groups.heads(group.block).tolist() == [0, 0, 0, 0, 4, 4, 4]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ([0, 1], "/forces/0/group: 2 values for 4 elements"),
        ([0, 1, 1, 0.5], "/forces/0/group/3: whole numbers are expected"),
        ([[0, 1, 1, 0]], r"/forces/0/group: shape \[1, 4\] given; one whole number for each element"),
        ([True, False, True, True], "/forces/0/group/0: whole or decimal numbers are expected, not true or false"),
    ],
)
def test_numbers_of_groups_are_whole(given: object, message: str) -> None:
    """One for each element."""
    with pytest.raises(InputError, match=message):
        scene = {
            "particles": np.eye(4)[:, :3],
            "forces": [{"kind": "co_planar", "particles": range(4), "group": given}],
        }
        compile(Scene(**scene))


def crumpled(count: int, **settings: object) -> Scene:
    """Particles near a plane that are pulled into one, each also by a soft anchor."""
    rng = np.random.default_rng(2)
    x = rng.uniform(-1.0, 1.0, (count, 3)) * [1.0, 1.0, 0.1]
    forces = [{"kind": "co_planar", "particles": range(count)}, {"kind": "anchor_spring", "particles": range(count)}]
    forces[1]["strength"] = 10.0
    return Scene(particles=x, forces=forces, settings={"tolerance": 1e-10, **settings})


def test_a_large_group_is_solved_by_its_unknowns() -> None:
    """Beyond the largest group that is one dense element, Newton steps and stability come from nodes: stable, because
    both forces are; K between 10 and 1010 in every direction makes the steps few."""
    found = relax(crumpled(groups.LARGEST + 50, solver="newton"))
    assert found.converged and found.iterations < 20
    assert found.stability == "stable" and found.position_error < 1e-9


def test_where_multigrid_is_needed_a_large_group_leaves_stability_unknown() -> None:
    """Multigrid has no nodes; smaller groups have a tangent there."""
    for count, reason in ((groups.LARGEST + 1, "a group of 301 elements is too large for multigrid"), (20, "")):
        system = compile(crumpled(count))
        assert system.no_tangent(sparse=False) == reason
        assert not system.no_tangent()


@pytest.mark.parametrize("kind", [kind for kind, cls in KINDS.items() if cls.kernel is not None])
def test_a_force_without_elements_adds_nothing_to_the_tangent(kind: str) -> None:
    """As that of a mesh without interior vertices: a system has its other elements then."""
    system = example_system(kind)
    for group in system.groups:
        group.block = group.block.some(slice(0, 0))
    memory = [group.block.memory for group in system.groups]
    for sparse in (False, True):
        assert not any(len(group.block.indices) for group, _ in system.elements(system.x, memory, sparse=sparse))
