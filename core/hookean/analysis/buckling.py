"""Linear buckling: the load factors at which a structure loses its stiffness, as seen from its unloaded shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.arc_length import _sum
from hookean.analysis.at_rest import AtRest, divided, relaxed
from hookean.analysis.frequencies import MOST, _scaled
from hookean.analysis.load_cases import growing
from hookean.analysis.matrices import Unknowns, against_turns, factor
from hookean.analysis.one_way import passing
from hookean.analysis.stress_stiffness import known, stress_stiffness
from hookean.errors import InputError
from hookean.scene.scene import Scene
from hookean.system.balance import extents
from hookean.values.units import Units

Floats = NDArray[np.float64]

STEP = 1e-4  # of the extent of the elements: the movement over which the tangent is differenced


@dataclass(frozen=True)
class Buckling:
    """Linear buckling of a structure under some of its loads.

    `factors` (k,) [-]: times these loads it buckles, the smallest first (all positive; none where the loads stiffen
    it). `modes` (k, n, 3) [-] how it buckles, the largest part of each 1. `particles` (n, 3) [length] is the shape
    without these loads, and `loads` their names. `notes` are sentences on elements that go slack or taut before the
    first factor.
    """

    factors: Floats
    modes: Floats
    particles: Floats = field(repr=False)
    loads: tuple[str, ...] = ()
    units: Units = field(default_factory=Units)
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return "\n".join(["Buckling", *(f"  {line}" for line in self.summary())])

    def summary(self) -> list[str]:
        """A line for each factor, and notes."""
        if not len(self.factors):
            return ["the loads do not make the structure buckle"]
        lines = [f"mode {i + 1}: buckles at {factor:.6g} times the loads" for i, factor in enumerate(self.factors)]
        return [*lines, *self.notes]

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        return {
            "factors": self.factors.tolist(),
            "modes": self.modes.tolist(),
            "particles": self.particles.tolist(),
            "loads": list(self.loads),
            "units": self.units.model_dump(),
            "notes": list(self.notes),
        }


def buckling(scene: Scene, count: int = 3, *, loads: Sequence[str] | None = None, case: str | None = None) -> Buckling:
    """Linear buckling factors and modes: (K + lambda G) phi = 0.

    K is the exact tangent stiffness in equilibrium without `loads`, with prestress and all other loads; u = K^-1 F the
    linear movement under `loads`; G the stiffness that the forces have which u brings to lines, cloth, shells, hinges,
    beams and rods, where they are, and the rate at which the tangent of all else changes along u, by central
    differences, with the tangent of loads that follow the shape. The factors hold as far as the structure moves little
    before it buckles; use `load_path` where it does not (shallow arches, cable nets).

    - `scene`: The structure with its loads.
    - `count`: How many factors.
    - `loads`: Names (or kinds) of the loads that grow; default: all.
    - `case`: A load case or combination: its elastic model, in the form, under its loads times their factors.

    Raises InputError where the structure has no stiffness without these loads, or is not in equilibrium.
    Source: Bathe, Finite Element Procedures, 1996, section 6.8.2.
    """
    if not (isinstance(count, int) and 1 <= count <= MOST):
        raise InputError("count", f"{count!r} given; a whole number from 1 to {MOST} is expected")
    system, state, numbers = growing(scene, loads, case)
    if system.films is not None:
        raise InputError("model", "soap films do not buckle linearly; freeze the form and analyse the elastic model")
    (rest_system, start), (load_system, load_state) = divided(system, state, numbers)
    rest = relaxed(rest_system, start, "without the loads")
    load_state.x = rest.state.x
    unknowns = Unknowns.of(rest_system, rest.state, rest.free)
    tangent = unknowns.tangent(rest_system, rest.state)
    stiffness = against_turns(tangent, unknowns.dofs, rest_system.slots.count)[0]
    found = factor(stiffness)
    if found is None or found.negatives:
        said = "without these loads the structure has no stiffness against some motion; brace it, prestress it or use"
        raise InputError("model", f"{said} load_path")
    force = unknowns.gather(load_system.evaluate(load_state)[0])
    moved = unknowns.spread(found.solve(force))
    change = _sum(_change(unknowns, rest, moved), unknowns.tangent(load_system, load_state))
    size = len(unknowns.dofs)
    inverse, vectors = _softest(stiffness, change, size, found, min(count, size))
    kept = inverse < -1e-12 * max(float(np.abs(inverse).max(initial=0.0)), 1e-300)
    modes = [_scaled(unknowns.spread(vector)) for vector in vectors.T[kept]]
    names = tuple(system.scene.forces[i].name or system.scene.forces[i].kind_name for i in numbers)
    shape = (-1, len(rest.state.x), 3)
    count = rest.system.slots.count
    shapes = np.array(modes).reshape(shape)[:, :count]
    factors = -1.0 / inverse[kept]
    notes = passing(rest, moved, float(factors[0])) if len(factors) else ()
    return Buckling(factors, shapes, rest.state.x[:count], names, scene.units, notes)


def _change(unknowns: Unknowns, rest: AtRest, moved: Floats) -> Any:
    """The stiffness of the forces that a movement (n, 3) brings; of elements without known strains the rate at which
    their tangent changes along it.

    Of what bends, the rate along a straight movement is no measure: its ends come nearer only by a term of second
    order, without which it is strained along itself, and that is many times stiffer than its forces."""
    rate = _rate(unknowns, _chosen(rest, [not known(group) for group in rest.system.groups]), moved)
    return _sum(rate, stress_stiffness(unknowns, rest.system, rest.state, moved))


def _chosen(rest: AtRest, kept: Sequence[bool]) -> AtRest:
    """The groups of a shape that are kept."""
    groups = [group for group, wanted in zip(rest.system.groups, kept, strict=True) if wanted]
    memory = [own for own, wanted in zip(rest.state.memory, kept, strict=True) if wanted]
    return replace(
        rest, system=replace(rest.system, groups=groups, _components=None), state=replace(rest.state, memory=memory)
    )


def _rate(unknowns: Unknowns, rest: AtRest, moved: Floats) -> Any:
    """The rate at which the tangent changes along a movement (n, 3)."""
    extent = extents(rest.system, rest.state)[:, None]
    part = float((np.abs(moved) / np.where(extent > 0.0, extent, np.inf)).max(initial=0.0))
    step = STEP / part if part > 0.0 else 1.0
    sides = []
    for sign in (1.0, -1.0):
        state = rest.state.copy()
        state.x = rest.state.x + sign * step * moved
        sides.append(unknowns.tangent(rest.system, state))
    return (sides[0] - sides[1]) / (2.0 * step)


def _softest(stiffness: Any, change: Any, size: int, found: Any, count: int) -> tuple[Floats, Floats]:
    """The lowest eigenvalues of G phi = mu K phi, mu = -1 / lambda, and their vectors."""
    total = stiffness.shape[0]
    if change.shape[0] < total:
        change.resize((total, total))
    if total <= 400 or count > total - 2:
        import scipy.linalg

        if total > size:  # unknowns of elements stay as they are: the pencil is as large as the tangent
            count = min(count, total)
        matrices = change.toarray(), stiffness.toarray()
        values, vectors = scipy.linalg.eigh(*matrices, subset_by_index=(0, count - 1))
        return values, vectors
    from scipy.sparse.linalg import LinearOperator, eigsh

    solve = LinearOperator((total, total), matvec=found.solve, dtype=np.float64)
    start = np.sin(12.9898 * np.arange(1.0, total + 1.0))
    values, vectors = eigsh(change, count, stiffness, which="SA", Minv=solve, v0=start, tol=1e-12)
    order = np.argsort(values, kind="stable")
    return np.asarray(values[order]), np.asarray(vectors[:, order])
