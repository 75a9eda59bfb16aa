"""Balance: how far a shape is from equilibrium, on what scale, and how near float64 lets it come.

Every connected component is judged by its own loads, every particle by the coordinates of its own elements: what is
heavy, stiff or far away excuses nothing elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces import groups
from hookean.forces.base import lengths
from hookean.system.components import Components
from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]

CHUNK = 2048  # elements
ROUNDING = float(np.finfo(np.float64).eps) / 2.0
COARSE = 1e-3  # a rounding floor above this leaves too little to call a shape known
UNSTRAINED = 1e-6  # strain below which the forces of a component without loads count as none
NO_PLANES = np.zeros((0, 9))
BALANCED = 1e-9  # part of the loads that may be left of their sum where they balance one another

OUT, WORST, BEYOND, NOISE, LOAD, LOADED, ALONG = 0, 1, 2, 3, 4, 5, slice(6, 9)
"""Columns of what `judge` finds of each component."""


@dataclass(frozen=True)
class Balance:
    """Out-of-balance forces of a shape.

    Of each connected component: residual = max over its particles |out of balance| / scale [-]; scale = mean |load|
    over its loaded particles, or the mean size of its internal element forces where nothing is loaded [force].
    Rounding of coordinates and sums leaves u (w |x| + |f| + |load|) at a particle of the exact answer, |x| the largest
    coordinate of the elements at it: `floors` is the most that it leaves in a component, / scale; `beyond` the largest
    residual of a particle that is more than it leaves there. `residual`, `scale`, `out_of_balance` and `worst` are
    those of the component with the largest residual, `floor` is the largest of all.
    """

    forces: Floats  # (n, 3) what is left on free particles
    reactions: Floats  # (n, 3) what anchors put on held ones
    contact: Floats  # (n, 3) what contacts put on particles
    components: Components
    found: Floats  # (k, 9) of each component what `judge` wrote
    scales: Floats  # (k,) [force]
    energies: Floats  # of each group of elements [force length]
    stiffness: Floats  # (n,) that particles feel [force/length]
    part: int  # the component with the largest residual; -1 where nothing may move
    residual: float  # the largest residual [-]
    floor: float  # the largest rounding floor [-]
    beyond: float  # the largest residual of a particle that is more than rounding leaves there [-]
    falls: bool  # whether some component is adrift
    planes: Floats  # (p, 9) parameters of those that nothing passes

    @property
    def residuals(self) -> Floats:
        """Of each component (k,) [-]."""
        return np.asarray(self.found[:, OUT] / self.scales)

    @property
    def floors(self) -> Floats:
        """Of each component (k,) [-]."""
        return np.asarray(self.found[:, NOISE] / self.scales)

    @property
    def scale(self) -> float:
        """The force by which the residual is measured [force]."""
        return float(self.scales[self.part]) if self.part >= 0 else 1.0

    @property
    def out_of_balance(self) -> float:
        """The force that the residual measures [force]."""
        return float(self.found[self.part, OUT]) if self.part >= 0 else 0.0

    @property
    def worst(self) -> int:
        """The particle with the largest residual."""
        return int(self.found[self.part, WORST]) if self.part >= 0 else 0

    @property
    def adrift(self) -> NDArray[np.int64]:
        """Components whose loads have a resultant in directions in which nothing can hold them."""
        along = np.abs(self.unheld).max(axis=1, initial=0.0)
        return np.flatnonzero(along > BALANCED * self.found[:, LOAD])

    @property
    def unheld(self) -> Floats:
        """Of the sum of the loads of each component (k, 3) [force] what no support can balance: neither one with
        directions of its own, nor the floor, which pushes and holds by friction."""
        left = np.einsum("kij,kj->ki", self.components.loose, self.found[:, ALONG])
        if not len(self.planes):
            return np.asarray(left)
        if len(self.planes) > 1:
            return np.zeros_like(left)
        normal, friction = self.planes[0, 3:6], self.planes[0, 7]
        up = self.components.loose @ normal  # where the floor pushes, but for what is held anyway
        square = (up * up).sum(axis=1)
        press = np.maximum(-(left * up).sum(axis=1) / np.where(square > 0.0, square, 1.0), 0.0)
        slid = left + press[:, None] * up
        size = lengths(slid)
        whole = np.trace(self.components.loose, axis1=1, axis2=2) > 2.5
        held = np.where(whole, friction * press, np.inf if friction > 0.0 else 0.0)
        part = np.minimum(held / np.where(size > 0.0, size, 1.0), 1.0)
        return np.asarray(slid * (1.0 - part)[:, None])

    @property
    def coarse(self) -> NDArray[np.int64]:
        """Components whose forces rounding hides."""
        return np.flatnonzero(self.floors > COARSE)

    def still(self, tolerance: float) -> bool:
        """Whether what is left at each particle is within the tolerance, or no more than rounding leaves there."""
        return self.beyond <= tolerance

    def met(self, tolerance: float) -> bool:
        """Converged: `still`, and that means something: no component is adrift, and rounding hides no forces."""
        return self.still(tolerance) and not self.falls and self.floor <= COARSE

    def goal(self, tolerance: float) -> float:
        """The out-of-balance force [force] that meets the tolerance in every component."""
        return float(dispatch.compiled(least_goal)(self.found, self.scales, tolerance))


def balance(system: System, state: State) -> Balance:
    """Judge a shape at rest."""
    loads = np.zeros(state.x.shape)
    f, w, energies = system.evaluate(state, loads=loads)
    left = f * state.free
    contact = system.support(state, left) if system.contacts else np.zeros(f.shape)
    if system.films is not None:
        system.films.across(state.x, state.free, left)
    parts = system.components(state)
    reactions, reach = np.empty(f.shape), np.zeros(len(f))
    found, scales = np.zeros((len(parts.first), 9)), np.empty(len(parts.first))
    for group in system.groups:
        if group.cls.role != "load" and len(group.block.indices):
            dispatch.compiled(reach_of)(group.block.indices, state.x, reach)
    planes = np.concatenate([group.block.parameters for group in system.contacts]) if system.contacts else NO_PLANES
    loose = np.zeros_like(parts.loose) if len(planes) else parts.loose
    given = state.x, f, w, state.free, loads, contact, reach, parts.label, left, reactions, found, scales, loose
    loaded, *summed, faint = dispatch.compiled(judge)(*given)
    if (faint or summed[-1]) and _cancelled(system, state, loads):
        found[:] = 0.0
        loaded, *summed, faint = dispatch.compiled(judge)(*given)
    if not loaded and ((scales <= 0.0) & parts.joined).any():
        scales = np.where(scales <= 0.0, _element_scales(system, state, parts, w, reach), scales)
    if not loaded:
        summed = list(dispatch.compiled(summary)(found, scales, loose))
    part, residual, floor, beyond, falls = summed
    judged = Balance(
        left, reactions, contact, parts, found, scales, energies, w, part, residual, floor, beyond, falls, planes
    )  # fmt: skip
    return replace(judged, falls=len(judged.adrift) > 0) if len(planes) else judged


def _cancelled(system: System, state: State, loads: Floats) -> bool:
    """Take from `loads` (n, 3) what is left of loads that cancel at a particle but for rounding; whether any was."""
    sizes, count = np.zeros(len(loads)), np.zeros(len(loads))
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.role == "load" and len(group.block.indices):
            index = group.block.indices.ravel()
            each = lengths(system.element_forces(group, state, memory).reshape(-1, 3))
            sizes += np.bincount(index, each, len(loads))
            count += np.bincount(index, minlength=len(loads))
    size = lengths(loads)
    rest = (size > 0.0) & (size <= ROUNDING * (count + 8.0) * sizes)
    loads[rest] = 0.0
    return bool(rest.any())


def extents(system: System, state: State) -> Floats:
    """The largest extent along an axis of the elements at each particle (n,) [length]."""
    extent = np.zeros(len(state.x))
    for group in system.groups:
        if group.cls.role != "load" and len(group.block.indices):
            wide = group.particles.shape[1]
            dispatch.compiled(extent_of)(group.block.indices, wide, state.x, extent)
    return extent


def wholes(system: System, state: State) -> Floats:
    """The largest extent along an axis (n,) [length] of the elements at each particle, and of the groups of these."""
    extent = extents(system, state)
    for group in system.groups:
        if issubclass(group.cls, groups.Grouped) and len(group.block.indices):
            wide = groups.extents(group.block, state.x)
            np.maximum.at(extent, group.block.indices, wide[:, None])
    return extent


def extent_of(indices, wide, x, extent):  # type: ignore[no-untyped-def]
    """The largest extent along an axis of the elements at each particle, the first `wide` indices of each, and slot."""
    for e in range(indices.shape[0]):
        size = 0.0
        for c in range(3):
            low = high = x[indices[e, 0], c]
            for j in range(1, wide):
                low, high = min(low, x[indices[e, j], c]), max(high, x[indices[e, j], c])
            size = max(size, high - low)
        if np.isfinite(size):
            for j in range(indices.shape[1]):
                extent[indices[e, j]] = max(extent[indices[e, j]], size)


def reach_of(indices, x, reach):  # type: ignore[no-untyped-def]
    """The largest coordinate of the elements at each particle."""
    for e in range(indices.shape[0]):
        far = 0.0
        for j in range(indices.shape[1]):
            i = np.uint64(indices[e, j])
            far = max(far, abs(x[i, 0]), abs(x[i, 1]), abs(x[i, 2]))
        if far < np.inf:
            for j in range(indices.shape[1]):
                i = np.uint64(indices[e, j])
                reach[i] = max(reach[i], far)


def least_goal(found, scales, tolerance):  # type: ignore[no-untyped-def]
    """The least force that meets the tolerance in some component; in one that rests but for rounding, though a softer
    particle does not, no force may be left; the tolerance where there are none."""
    least = np.inf
    for k in range(found.shape[0]):
        floor = found[k, 3] / scales[k]
        softer = found[k, 0] / scales[k] <= floor and found[k, 2] / scales[k] > tolerance
        least = min(least, max(0.0 if softer else floor, tolerance) * scales[k])
    return least if found.shape[0] > 0 else tolerance


@device
def summary(found: Any, scales: Any, loose: Any) -> Any:
    """The component with the largest residual, that residual, the largest rounding floor and residual beyond it, and
    whether the loads of a component have a resultant in a direction in which nothing supports it."""
    part, residual, floor, beyond, falls = -1, 0.0, 0.0, 0.0, False
    for k in range(found.shape[0]):
        if scales[k] <= 0.0:  # nothing pushes there: balanced if what is left is rounding
            scales[k] = 1.0
        own = found[k, 0] / scales[k]
        if part < 0 or own > residual or (np.isnan(own) and not np.isnan(residual)):
            part, residual = k, own
        floor = max(floor, found[k, 3] / scales[k])
        if not np.isnan(beyond):
            more = found[k, 2] / scales[k]
            beyond = more if np.isnan(more) else max(beyond, more)
        if loose[k, 0, 0] + loose[k, 1, 1] + loose[k, 2, 2] > 0.5:
            for i in range(3):
                along = loose[k, i, 0] * found[k, 6] + loose[k, i, 1] * found[k, 7] + loose[k, i, 2] * found[k, 8]
                falls = falls or abs(along) > BALANCED * found[k, 4]
    return part, residual, floor, beyond, falls


def judge(  # type: ignore[no-untyped-def]
    x, f, w, free, loads, contact, reach, label, left, reactions, found, scales, loose
):
    """Write the reactions; and of each component the largest force left, the particle with it, the largest beyond
    rounding and the most that rounding leaves [force], the sizes of loads on what may move: their sum, how many there
    are, and the loads added up along the axes; `scales` their mean. Whether all components are loaded, and then
    the `summary`; and whether some load is so faint beside rounding that it may be no more than that."""
    faint = False
    for i in range(x.shape[0]):
        largest, square, weight = 0.0, 0.0, 0.0
        for c in range(3):
            reactions[i, c] = -(f[i, c] + contact[i, c]) * (1.0 - free[i, c])
            square += left[i, c] * left[i, c]
            weight += loads[i, c] * free[i, c] * loads[i, c] * free[i, c]
            largest = max(largest, abs(f[i, c]))
        if label[i] < 0:
            continue
        part = found[label[i]]
        # where a position is none, neither is what its springs do
        size = np.sqrt(square) if np.isfinite(x[i, 0] + x[i, 1] + x[i, 2]) else np.nan
        weight = np.sqrt(weight)
        noise = ROUNDING * (w[i] * reach[i] + largest + weight)
        if size > part[0] or (np.isnan(size) and not np.isnan(part[0])):
            part[0], part[1] = size, i
        if (size > noise and size > part[2]) or not size < np.inf:  # rounding of what has no value excuses nothing
            part[2] = size
        part[3] = max(part[3], noise)
        if weight > 0.0:
            faint = faint or COARSE * weight < noise
            part[4] += weight
            part[5] += 1.0
            for c in range(3):
                part[6 + c] += loads[i, c]
    every = True
    for k in range(found.shape[0]):
        scales[k] = found[k, 4] / max(found[k, 5], 1.0)
        every = every and scales[k] > 0.0
    if every:
        return (True, *summary(found, scales, loose), faint)
    return (False, -1, 0.0, 0.0, 0.0, False, faint)


def _element_scales(system: System, state: State, parts: Components, w: Floats, reach: Floats) -> Floats:
    """The mean size of the internal element forces of each component (k,) [force]; `w` (n,) is the stiffness that
    particles feel [force/length], `reach` (n,) the largest coordinate of the elements at them."""
    k = len(parts.first)
    sums = np.zeros((k, 2))
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.role != "load" and len(group.block.indices):
            if group.cls.central is None:
                sizes = _element_sizes(system, group, state, memory)
                dispatch.compiled(tally)(group.block.indices, sizes, parts.label, sums)
            else:
                _tally_central(group, state, memory, parts, sums)
    now = sums[:, 0] / np.maximum(sums[:, 1], 1.0)
    # where stress dies out at equilibrium, the scale must not die with it
    if len(state.force_scale) != k:
        state.force_scale = np.zeros(k)
    state.force_scale = np.maximum(state.force_scale, now)
    scales = np.maximum(now, 1e-3 * state.force_scale)
    if scales.min() >= UNSTRAINED * 2.0 * (w * reach).max():  # no element is larger than twice that
        return np.asarray(scales)
    stiff = w * wholes(system, state)  # what particles resist to strains of 1 [force]
    if scales.min() < UNSTRAINED * stiff.max():
        own = np.zeros((k, 2))
        dispatch.compiled(tally)(np.arange(len(stiff))[:, None], stiff, parts.label, own)
        scales = np.maximum(scales, UNSTRAINED * own[:, 0] / np.maximum(own[:, 1], 1.0))
    return np.asarray(scales)


def _tally_central(group: Group, state: State, memory: Floats, parts: Components, sums: Floats) -> None:
    """Add the forces of elements between two particles, which act along them, to those of their components."""
    b, central = group.block, dispatch.compiled(group.cls.central, "central")
    for first in range(0, len(b.indices), CHUNK):  # few enough to stay in the nearest cache
        part = slice(first, first + CHUNK)
        stiffness = np.empty((len(b.indices[part]), 5))
        central(state.x, b.indices[part], b.parameters[part], memory[part], stiffness)
        dispatch.compiled(tally_central)(b.indices[part], state.x, stiffness, parts.label, sums)


def tally_central(indices, x, stiffness, label, sums):  # type: ignore[no-untyped-def]
    """Add the sizes of forces along elements, their stiffness across times their length, to those of their
    components, and how many there are."""
    for e in range(indices.shape[0]):
        a, b = np.uint64(indices[e, 0]), np.uint64(indices[e, 1])
        part = max(label[a], label[b])
        if part >= 0:
            dx, dy, dz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
            sums[part, 0] += abs(stiffness[e, 1]) * np.sqrt(dx * dx + dy * dy + dz * dz)
            sums[part, 1] += 1.0


def tally(indices, sizes, label, sums):  # type: ignore[no-untyped-def]
    """Add the sizes of elements to those of their components, and how many there are."""
    for e in range(indices.shape[0]):
        part = -1
        for j in range(indices.shape[1]):
            part = max(part, label[indices[e, j]])
        if part >= 0:
            sums[part, 0] += sizes[e]
            sums[part, 1] += 1.0


def _element_sizes(system: System, group: Group, state: State, memory: Floats) -> Floats:
    """The largest force that each element puts on one of its particles."""
    forces = system.element_forces(group, state, memory)
    # column by column: reducing an axis of two or three is slow
    return reduce(np.maximum, (lengths(forces[:, i]) for i in range(forces.shape[1])))
