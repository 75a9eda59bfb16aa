"""The laws every force is held to, as functions of a case; the tests run them on forces, and on wrong ones."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled import dispatch

from .cases import Case
from .turned import moment_of, movable, moved_rigidly

EPS = float(np.finfo(float).eps)


def _at_most(case: Case, what: str, got: float, allowed: float) -> None:
    """A size within its tolerance; else which force, what, how large."""
    assert got <= allowed, f"{case.name}: {what}: {got:.6g}, at most {allowed:.6g} expected"


def force_is_the_gradient(case: Case, rng: np.random.Generator, amount: float = 0.15) -> None:
    """f = -dE/dx by central differences, to 1e-6 of the largest force.

    Step h = 1e-5 of the spacing: truncation h^2 E'''/6 ~ 1e-10 relative, rounding eps E / h ~ 1e-11 k spacing.
    """
    memory, x = case.past(rng), case.moved(rng, amount)
    f, _, _ = case.force(x, None, memory)
    h = 1e-5 * case.spacing
    slope = np.zeros_like(x)
    for spot in np.ndindex(movable(case), 3):
        sides = []
        for sign in (1.0, -1.0):
            shifted = x.copy()
            shifted[spot] += sign * h
            sides.append(case.force(shifted, None, memory)[2])
        slope[spot] = (sides[0] - sides[1]) / (2.0 * h)
    _at_most(case, "force + dE/dx", np.abs(f + slope).max(), 1e-6 * np.abs(f).max())


def nothing_from_outside(case: Case, rng: np.random.Generator, amount: float = 0.15) -> None:
    """Internal: sum f = 0 and sum x cross f + sum of moments = 0, to 1e-12 of the sizes summed, damping and memory
    included."""
    memory, x = case.past(rng), case.moved(rng, amount)
    f, w, _ = case.force(x, rng.normal(size=x.shape), memory)
    force, reach = case.scales(x, f, w)
    n = len(x) - 2 * len(case.arms)
    _at_most(case, "sum of forces", np.abs(f[:n].sum(axis=0)).max(), 1e-12 * force)
    moment = moment_of(case, x, f)
    _at_most(case, "sum of moments", np.abs(moment).max(), 1e-12 * force * reach)


def something_from_outside(case: Case, rng: np.random.Generator) -> None:
    """Loads and supports: a resultant that is not zero somewhere (else the force is internal and must say so)."""
    x = case.moved(rng)
    f, w, _ = case.force(x)
    force, reach = case.scales(x, f, w)
    moment = moment_of(case, x, f) if case.arms else np.cross(x, f).sum(axis=0)
    assert np.abs(f.sum(axis=0)).max() > 1e-9 * force or np.abs(moment).max() > 1e-9 * force * reach, (
        f"{case.name}: the resultant is zero, so role is internal"
    )


def rigid_motion_changes_nothing(case: Case, rng: np.random.Generator, amount: float = 0.15) -> None:
    """E(R x + t) = E(x) and f(R x + t) = R f(x), to 1e-10; a rigid velocity field is not damped.

    R = 1 where the force is of a direction fixed in space.
    """
    memory, x = case.past(rng), case.moved(rng, amount)
    v = rng.normal(size=x.shape)
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    rotation = np.eye(3) if case.oriented else rotation * np.sign(np.linalg.det(rotation))
    turned = moved_rigidly(case, x, rotation, rng.normal(size=3) * case.spacing)
    f, w, energy = case.force(x, v, memory)
    g, u, same = case.force(turned, np.ascontiguousarray(v @ rotation.T), memory)
    force, reach = case.scales(x, f, w)
    _at_most(case, "force turned - force of the turned shape", np.abs(g - f @ rotation.T).max(), 1e-10 * force)
    _at_most(case, "energy before - after a rigid motion", abs(energy - same), 1e-10 * force * reach)
    _at_most(case, "lumped stiffness w before - after a rigid motion", np.abs(u - w).max(), 1e-10 * w.max())
    rigid = rng.normal(size=3) + np.cross(rng.normal(size=3), x)
    still, _, _ = case.force(x, None, memory)
    _at_most(
        case,
        "force that a rigid velocity changes",
        np.abs(case.force(x, rigid, memory)[0] - still).max(),
        1e-10 * force,
    )


def zero_at_rest(case: Case) -> None:
    """Started at its rest values a force is zero and so is its energy, to 1e-12 of stiffness x size."""
    f, w, energy = case.force(case.x)
    force, reach = case.scales(case.x, f, w)
    _at_most(case, "force at rest", np.abs(f).max(), 1e-12 * w.max() * reach)
    _at_most(case, "energy at rest", abs(energy), 1e-12 * force * reach)
    shaken = case.moved(np.random.default_rng(0), 0.05)
    assert np.abs(case.force(shaken)[0]).max() > 1e-6 * w.max() * case.spacing * 0.05, (
        f"{case.name}: moved away from rest, there is no force"
    )


def degenerate_stays_finite(case: Case, x: np.ndarray, rng: np.random.Generator) -> None:
    """Whatever the positions: forces, stiffness, energy, tangent and memory are finite."""
    v = rng.normal(size=x.shape)
    memory = case.past(rng)
    f, w, energy = case.force(x, v, memory)
    assert np.isfinite(f).all() and np.isfinite(w).all() and np.isfinite(energy), (
        f"{case.name}: f, w or energy is not finite"
    )
    assert (w >= 0).all(), f"{case.name}: a lumped stiffness w is negative"
    assert np.isfinite(case.noted(x, memory)).all(), f"{case.name}: the memory is not finite"
    if case.hessian is not None:
        assert np.isfinite(_blocks(case, x, memory)).all(), f"{case.name}: the hessian is not finite"


def order_of_elements_does_not_matter(case: Case, rng: np.random.Generator) -> None:
    """Elements in another order: the same sums, to rounding (4 eps x the sizes summed)."""
    memory, x = case.past(rng), case.moved(rng)
    v = rng.normal(size=x.shape)
    order = rng.permutation(len(case.block.indices))
    b = case.block
    if case.reordered is not None:
        other = case.reordered(order)
    else:
        other = type(b)(*(np.ascontiguousarray(a[order]) for a in (b.indices, b.parameters, b.memory)), b.names)
    f, w, energy = case.force(x, v, memory)
    g, u, same = type(case)(**{**vars(case), "block": other}).force(x, v, np.ascontiguousarray(memory[order]))
    force, reach = case.scales(x, f, w)
    tolerance = 4.0 * EPS * (1 + len(order))
    _at_most(case, "force that the order of elements changes", np.abs(f - g).max(), tolerance * force)
    _at_most(case, "w that the order of elements changes", np.abs(w - u).max(), tolerance * w.max())
    _at_most(
        case, "energy that the order of elements changes", abs(energy - same), tolerance * (force * reach + abs(energy))
    )


def names_of_particles_do_not_matter(case: Case, rng: np.random.Generator) -> None:
    """Particles renumbered: the same forces, to the bit."""
    memory, x = case.past(rng), case.moved(rng)
    v = rng.normal(size=x.shape)
    number = rng.permutation(len(x))
    b = case.block
    other = type(b)(np.ascontiguousarray(number[b.indices]), b.parameters, b.memory, b.names)
    f, w, energy = case.force(x, v, memory)
    back = np.argsort(number)
    g, u, same = type(case)(**{**vars(case), "block": other}).force(
        np.ascontiguousarray(x[back]), np.ascontiguousarray(v[back]), memory
    )
    assert (g[number] == f).all() and (u[number] == w).all() and same == energy, (
        f"{case.name}: other numbers of particles give other forces, w or energy"
    )


def lumped_stiffness_bounds_the_tangent(case: Case, rng: np.random.Generator, amount: float) -> None:
    """Largest eigenvalue of W^-1/2 K W^-1/2 <= 1 + 1e-9 (1e-7 where K comes from differences of the force).

    Gershgorin's argument, on which relaxation's unit step stands: diag(w) - K >= 0. Barnes 1999, section 3.
    """
    x = case.moved(rng, amount)
    _, w, _ = case.force(x)
    stiff = w > 0
    together = case.reordered is not None
    tangent = _difference(case, x) if together else _assembled(case, _blocks(case, x, case.block.memory))
    weightless = np.repeat(~stiff, 3)
    # a particle without stiffness feels none
    _at_most(case, "tangent of a particle with w = 0", np.abs(tangent[weightless]).max(initial=0.0), 1e-9)
    scale = np.where(weightless, 0.0, 1.0 / np.sqrt(np.repeat(np.where(stiff, w, 1.0), 3)))
    top = np.linalg.eigvalsh(scale[:, None] * tangent * scale).max()
    _at_most(
        case,
        "largest eigenvalue of tangent / w (w too small?)",
        top,
        1.0 + (1e-9 if case.hessian is not None else 1e-7),
    )


def tangent_is_the_gradient_of_the_force(case: Case, rng: np.random.Generator, amount: float = 0.15) -> None:
    """The exact Hessian equals central differences of the force, element by element to 1e-6, and is symmetric.

    Of a force without energy it is the symmetric part: the other one cancels in sums where it has an energy after all
    (pressure on a closed mesh). Where a yield limit lies within the step of the differences the tangent jumps; such
    positions say nothing.
    """
    memory, x = case.past(rng), case.moved(rng, amount)
    exact, close = _blocks(case, x, memory), _differences(case, x, memory)
    for block, difference, jumps in zip(exact, close, _kinked(case, x, memory), strict=True):
        _at_most(case, "hessian - its transpose", np.abs(block - block.T).max(), 4 * EPS * np.abs(block).max())
        if not case.conservative:
            difference = 0.5 * (difference + difference.T)
        if not jumps:
            _at_most(
                case,
                "hessian - differences of the force",
                np.abs(block - difference).max(),
                1e-6 * np.abs(difference).max(),
            )


def damping_is_as_declared(case: Case, rng: np.random.Generator) -> None:
    """A damped force changes with v, linearly, and takes energy: v . (f(x, v) - f(x, 0)) <= 0; others do not change."""
    memory, x = case.past(rng), case.moved(rng)
    v = rng.normal(size=x.shape)
    still, w, energy = case.force(x, None, memory)
    moving, w_moving, energy_moving = case.force(x, v, memory)
    assert energy == energy_moving and (w == w_moving).all(), f"{case.name}: energy or w changes with the velocity"
    if not case.damped:
        assert (still == moving).all(), f"{case.name}: damped is False, but the force changes with the velocity"
        return
    scale, _ = case.scales(x, still, w)
    drag = moving - still
    _at_most(case, "power of damping (it must take energy)", float((v * drag).sum()), 1e-12 * scale * np.abs(v).max())
    double = case.force(x, 2.0 * v, memory)[0] - still
    _at_most(case, "damping at 2 v - 2 x damping at v", np.abs(double - 2.0 * drag).max(), 1e-12 * scale)


def memory_is_as_declared(case: Case, rng: np.random.Generator) -> None:
    """Kernels never write memory; the end of a step does, where declared, and noting the same shape twice is idle."""
    x = case.moved(rng)
    if not case.remembers:
        assert case.end_of_step is None and case.block.memory.shape[1] == 0, (
            f"{case.name}: remembers is False, but there is an end_of_step or memory"
        )
        return
    memory = case.noted(x)
    assert memory.shape[1] > 0, f"{case.name}: remembers is True, but the block has no memory"
    again = case.noted(x, memory)
    _at_most(
        case,
        "memory that noting the same shape twice changes",
        np.abs(again - memory).max(),
        8 * EPS * max(np.abs(memory).max(), case.spacing),
    )


def kernels_only_add(case: Case, rng: np.random.Generator) -> None:
    """A kernel adds to f and w and writes nothing else."""
    x, memory = case.moved(rng), case.past(rng)
    v, f, w = rng.normal(size=x.shape), rng.normal(size=x.shape), rng.uniform(1.0, 2.0, len(x))
    inputs = [x, v, case.block.indices, case.block.parameters, memory]
    before = [a.copy() for a in (*inputs, f, w)]
    energy = case.run(case.kernel, "force")(*inputs, f, w)
    for array, copy in zip(inputs, before, strict=False):
        assert (array == copy).all(), f"{case.name}: the kernel writes its inputs"
    alone, stiffness, same = case.force(x, v, memory)
    scale, _ = case.scales(x, alone, stiffness)
    _at_most(case, "f added - force alone", np.abs(f - before[5] - alone).max(), 1e-13 * (scale + 10.0))
    _at_most(case, "w added - w alone", np.abs(w - before[6] - stiffness).max(), 1e-13 * (stiffness.max() + 10.0))
    assert energy == same, f"{case.name}: the energy depends on what f and w hold"


def allocates_nothing_that_grows(case: Case, rng: np.random.Generator) -> None:
    """Machine code takes as many pieces of memory for four times the elements, few, and gives every one back."""
    from numba.core.runtime import _nrt_python as nrt

    if not nrt.memsys_stats_enabled():
        nrt.memsys_enable_stats()
    once = np.arange(len(case.block.indices))
    four = np.tile(once, 4)
    # made again: what a list of neighbours keeps of earlier shapes decides when the next one is made
    b = case.block if case.reordered is None else case.reordered(once)
    longer = b.some(four) if case.reordered is None else case.reordered(four)
    kernel, counts = case.kernel if case.plain else dispatch.compiled(case.kernel, "force"), []
    for block in (b, longer):
        x = case.moved(rng)
        memory, v, f, w = block.memory.copy(), np.zeros_like(x), np.zeros_like(x), np.zeros(len(x))
        kernel(x, v, block.indices, block.parameters, memory, f, w)  # what is compiled now takes memory, too
        taken, freed = nrt.memsys_get_stats_alloc(), nrt.memsys_get_stats_free()
        kernel(x, v, block.indices, block.parameters, memory, f, w)
        counts.append(nrt.memsys_get_stats_alloc() - taken)
        assert nrt.memsys_get_stats_free() - freed == counts[-1], f"{case.name}: memory taken is not given back"
    assert counts[0] == counts[1], f"{case.name}: more elements take more pieces of memory"
    # where numba runs it: a handle for each of the seven arrays; and a little room of fixed size
    _at_most(case, "pieces of memory taken", counts[0], 2 * 7 + 2)


class Guarded(np.ndarray):
    """An array that also refuses negative indices."""

    def __getitem__(self, key: Any) -> Any:
        self._check(key)
        return super().__getitem__(key)

    def __setitem__(self, key: Any, value: Any) -> None:
        self._check(key)
        super().__setitem__(key, value)

    @staticmethod
    def _check(key: Any) -> None:
        for part in key if isinstance(key, tuple) else (key,):
            if isinstance(part, int | np.integer) and part < 0:
                raise IndexError(f"index {part}")


def guarded(array: np.ndarray) -> np.ndarray:
    """A copy whose every index is checked."""
    return array.copy().view(Guarded)


def stays_inside_its_arrays(case: Case, x: np.ndarray, rng: np.random.Generator) -> None:
    """Run as plain Python, where every index is checked, a kernel gives what machine code gives (4 ulp of the sums)."""
    memory = case.past(rng)
    v = rng.normal(size=x.shape)
    f, w = guarded(np.zeros_like(x)), guarded(np.zeros(len(x)))
    inputs = [guarded(a) for a in (x, v, case.block.indices, case.block.parameters, memory)]
    with np.errstate(all="ignore"):
        energy = float(case.kernel(*inputs, f, w))
    g, u, same = case.force(x, v, memory)
    force, reach = case.scales(x, g, u)
    _at_most(case, "force of Python - of machine code", np.abs(np.asarray(f) - g).max(), 4 * EPS * force)
    _at_most(case, "w of Python - of machine code", np.abs(np.asarray(w) - u).max(), 4 * EPS * u.max())
    _at_most(case, "energy of Python - of machine code", abs(energy - same), 4 * EPS * (force * reach + abs(same)))
    if case.hessian is not None:
        blocks = guarded(np.zeros_like(_blocks(case, x, memory)))
        with np.errstate(all="ignore"):
            case.hessian(inputs[0], *inputs[2:], blocks)
        exact = _blocks(case, x, memory)
        size = np.abs(exact).max()
        if not case.conservative:  # the symmetric part is what remains where the other one cancels
            size = max(size, np.abs(_differences(case, x, memory)).max())
        _at_most(case, "hessian of Python - of machine code", np.abs(np.asarray(blocks) - exact).max(), 16 * EPS * size)
    if case.end_of_step is not None:
        with np.errstate(all="ignore"):
            case.end_of_step(inputs[0], *inputs[2:])
        _at_most(
            case,
            "memory of Python - of machine code",
            np.abs(np.asarray(inputs[4]) - case.noted(x, memory)).max(),
            4 * EPS * reach,
        )


def _blocks(case: Case, x: np.ndarray, memory: np.ndarray) -> np.ndarray:
    """Element tangents: from the force's Hessian, or by differences of its forces."""
    if case.hessian is None:
        return _differences(case, x, memory)
    count, arity = case.block.indices.shape
    blocks = np.zeros((count, 3 * arity, 3 * arity))
    case.run(case.hessian, "hessian")(x, case.block.indices, case.block.parameters, memory, blocks)
    return blocks


def _differences(case: Case, x: np.ndarray, memory: np.ndarray) -> np.ndarray:
    """Element tangents by fourth-order central differences: every element on particles of its own."""
    count, arity = case.block.indices.shape
    alone, private = _apart(case, x)
    h = 1e-5 * case.spacing
    blocks = np.zeros((count, 3 * arity, 3 * arity))
    for i in range(arity if not len(case.arms) else 2 * arity // 3):  # references do not move
        for c in range(3):
            for factor, weight in ((1.0, -2.0 / 3.0), (2.0, 1.0 / 12.0)):
                for sign in (1.0, -1.0):
                    shifted = private.copy()
                    shifted[i::arity, c] += sign * factor * h
                    f = alone.force(shifted, None, memory)[0]
                    blocks[:, :, 3 * i + c] += sign * weight / h * f.reshape(count, -1)
    return blocks


def _difference(case: Case, x: np.ndarray) -> np.ndarray:
    """The tangent of the whole case, dense, by fourth-order central differences: elements that feel one another."""
    h, columns = 1e-4 * case.spacing, []
    for spot in np.ndindex(*x.shape):
        column = np.zeros_like(x)
        for factor, weight in ((1.0, -2.0 / 3.0), (2.0, 1.0 / 12.0)):
            for sign in (1.0, -1.0):
                shifted = x.copy()
                shifted[spot] += sign * factor * h
                column += sign * weight / h * case.force(shifted)[0]
        columns.append(column.ravel())
    whole = np.array(columns)
    return 0.5 * (whole + whole.T)


def _kinked(case: Case, x: np.ndarray, memory: np.ndarray) -> np.ndarray:
    """Elements whose force changes slope within the step of `_differences`: by more than 1e-3, not by h/l = 1e-5."""
    count, arity = case.block.indices.shape
    alone, private = _apart(case, x)
    h, middle = 2e-5 * case.spacing, alone.force(private, None, memory)[0]
    bend, slope = np.zeros(count), np.zeros(count)
    for i in range(arity):
        for c in range(3):
            sides = []
            for sign in (1.0, -1.0):
                shifted = private.copy()
                shifted[i::arity, c] += sign * h
                sides.append(alone.force(shifted, None, memory)[0])
            second, first = sides[0] + sides[1] - 2.0 * middle, sides[0] - sides[1]
            bend = np.maximum(bend, np.abs(second.reshape(count, -1)).max(axis=1))
            slope = np.maximum(slope, np.abs(first.reshape(count, -1)).max(axis=1))
    return bend > 1e-3 * slope


def _apart(case: Case, x: np.ndarray) -> tuple[Case, np.ndarray]:
    """The same elements, each on particles of its own, and their positions."""
    count, arity = case.block.indices.shape
    b = case.block
    own = type(b)(np.arange(count * arity).reshape(count, arity), b.parameters, b.memory, b.names)
    return type(case)(**{**vars(case), "block": own}), np.ascontiguousarray(x[b.indices].reshape(-1, 3))


def _assembled(case: Case, blocks: np.ndarray) -> np.ndarray:
    """The tangent of the whole case, dense."""
    whole = np.zeros((case.x.size, case.x.size))
    for index, block in zip(case.block.indices, blocks, strict=True):
        degrees = (3 * index[:, None] + np.arange(3)).ravel()
        # an element may name a particle twice
        np.add.at(whole, np.ix_(degrees, degrees), block)
    return whole
