"""Cables for the workshop: their unstressed lengths, compensated, and where things are clamped to them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.freezing import Frozen, freeze
from hookean.errors import InputError
from hookean.forces import Block, groups
from hookean.forces.anchor_spring import AnchorSpring
from hookean.forces.base import lengths
from hookean.forces.beam import Beam
from hookean.forces.sliding_cable import REST, K, SlidingCable
from hookean.forces.springs import Springs
from hookean.forces.support import Support
from hookean.scene.scene import Scene
from hookean.system.state import State
from hookean.system.system import System
from hookean.values.units import Units

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STRAIGHT = np.cos(np.pi / 4.0)  # elements that meet at a flatter angle are one cable


@dataclass(frozen=True)
class Cable:
    """A cable of the elastic model: its `force`, the `particles` (k + 1,) along it, and of its k elements the `tension`
    [force], `stressed` lengths in the form and `unstressed` lengths [length]. `cut` [length] is its length in the
    workshop, and `clamps` (k + 1,) [length] where its particles lie along the unstressed cable."""

    name: str
    force: str
    particles: Ints
    tension: Floats = field(repr=False)
    stressed: Floats = field(repr=False)
    unstressed: Floats = field(repr=False)
    cut: float

    @property
    def clamps(self) -> Floats:
        """Where its particles lie along the unstressed cable (k + 1,) [length]."""
        return np.concatenate([[0.0], np.cumsum(self.unstressed)])


@dataclass(frozen=True)
class Cables:
    """All cables of a form."""

    cables: tuple[Cable, ...]
    units: Units = field(default_factory=Units)

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        found = [
            {"name": cable.name, "particles": cable.particles.tolist(), "clamps": cable.clamps.tolist()}
            for cable in self.cables
        ]
        return {"cables": found, "table": self.table(), "units": self.units.model_dump()}

    def table(self) -> list[dict[str, Any]]:
        """A row for each cable: lengths, compensation and forces, with their units in their names."""
        length, force = self.units.length, self.units.force
        return [
            {
                "cable": cable.name,
                "force": cable.force,
                "from particle": int(cable.particles[0]),
                "to particle": int(cable.particles[-1]),
                "elements": len(cable.tension),
                f"stressed length [{length}]": float(cable.stressed.sum()),
                f"unstressed length [{length}]": float(cable.unstressed.sum()),
                f"cut length [{length}]": cable.cut,
                "elastic strain [-]": float(cable.stressed.sum() / cable.unstressed.sum() - 1.0),
                f"smallest force [{force}]": float(cable.tension.min()),
                f"largest force [{force}]": float(cable.tension.max()),
            }
            for cable in self.cables
        ]


def cables(model: Scene | Frozen, *, stretch: float = 0.0, fitting: float = 0.0) -> Cables:
    """Unstressed lengths of the cables of a form, compensated for the workshop.

    Elements of one force that continue each other, straight on where several meet, are a cable; where they turn by 45
    degrees or more at a support, a beam or an element in compression, such as a mast, it ends. Its unstressed length is
    the sum of l EA / (EA + T); cut it to unstressed length / (1 + stretch) - 2 fitting. A sliding cable continues over
    its saddles; its unstressed length is its own.

    - `model`: A scene whose form is found and frozen (see `freeze`), or a frozen one.
    - `stretch`: The construction stretch of new rope, which stays after its first loading [-].
    - `fitting`: What the fitting at each end takes off [length].

    Raises InputError where a form cannot be frozen, has no cables, or a cut length would not be positive.
    """
    for place, value in (("stretch", stretch), ("fitting", fitting)):
        if not (np.isfinite(value) and value >= 0.0):
            raise InputError(place, f"{value!r} given; a number of at least 0 is expected")
    frozen = model if isinstance(model, Frozen) else freeze(model)
    system, state = frozen.system()
    found: list[Cable] = []
    for force, particles, length, tension, rest in _lines(frozen, system, state):
        called = f"{force} {1 + sum(cable.force == force for cable in found)}"
        cut = float(rest.sum()) / (1.0 + stretch) - 2.0 * fitting
        if cut <= 0.0:
            raise InputError("fitting", f"{called} is shorter than its fittings; lower the value")
        found.append(Cable(called, force, particles, tension, length, rest, cut))
    if not found:
        raise InputError("model", "has no cables; add springs, sliding cables or lines of constant tension")
    return Cables(tuple(found), frozen.scene.units)


def _lines(frozen: Frozen, system: System, state: State) -> Iterator[tuple[str, Ints, Floats, Floats, Floats]]:
    """Of each cable the name of its force, the particles along it, and of its elements the length, tension and
    unstressed length."""
    held = _carrying(frozen, system, state)
    for group in system.groups:
        for part in group.parts:
            name, number, pairs = part.force.name or part.force.kind_name, part.number, group.block.indices[part.rows]
            if group.cls is Springs:
                rest = np.broadcast_to(np.asarray(part.force.rest_length), (len(pairs),))  # type: ignore[attr-defined]
                for rows, particles in chains(state.x, pairs, held):
                    length, tension = frozen.lengths[number][rows], frozen.tensions[number][rows]
                    yield name, particles, length, tension, rest[rows]
            elif isinstance(part.force, SlidingCable):
                known = None if frozen.form is None else frozen.form.forces[number]["force"]
                for particles, length, tension, rest in _sliding(group.of(part), state.x, known):
                    yield name, particles, length, tension, rest


def _carrying(frozen: Frozen, system: System, state: State) -> Ints:
    """The particles that are held, also elastically, or at which beams or elements in compression end."""
    found = [np.flatnonzero((state.free[: system.slots.count] == 0.0).all(axis=1))]
    for group in system.groups:
        if group.cls in (AnchorSpring, Beam, Support):
            found.append(group.block.indices[:, : group.cls.arity].ravel())
        for part in group.parts:
            if part.number in frozen.tensions:
                found.append(group.block.indices[part.rows][frozen.tensions[part.number] < 0.0].ravel())
    return np.unique(np.concatenate(found))


def _sliding(block: Block, x: Floats, known: Floats | None) -> Iterator[tuple[Ints, Floats, Floats, Floats]]:
    """Of each sliding cable of a force the particles along it, and of its lines the length, the tension, and their
    parts of L0: l EA / (EA + T), as much as makes their sum L0 where it is slack. With friction the tensions are those
    `known` (m,) of the form."""
    pairs, heads = block.indices, groups.heads(block)
    length = lengths(x[pairs[:, 1]] - x[pairs[:, 0]])
    whole, rest = block.parameters[:, REST], np.bincount(heads, length, len(pairs))[heads]
    axial = block.parameters[:, K] * whole
    tension = np.maximum(axial * (rest / whole - 1.0), 0.0) if known is None else np.asarray(known)
    parts = length * axial / np.maximum(axial + tension, 1e-300)
    parts *= whole / np.bincount(heads, parts, len(pairs))[heads]
    for head in np.unique(heads):
        own = np.flatnonzero(heads == head)
        for rows, particles in chains(x, pairs[own]):
            rows = own[rows]
            yield particles, length[rows], tension[rows], parts[rows]


def chains(x: Floats, pairs: Ints, held: Ints | None = None) -> list[tuple[Ints, Ints]]:
    """Elements (m, 2) that continue each other: of each chain the rows (k,) in order, and its particles (k + 1,).

    At a particle the two elements that are most nearly in line continue each other, if they turn by less than 45
    degrees, then the next two; two that are alone there always do, but for a particle that is `held`, such as that of a
    mast.
    """
    corners = set() if held is None else set(held.tolist())
    at: dict[int, list[int]] = {}
    for row, pair in enumerate(pairs.tolist()):
        for particle in pair:
            at.setdefault(particle, []).append(row)
    along = x[pairs[:, 1]] - x[pairs[:, 0]]
    along = along / np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
    following: dict[tuple[int, int], int] = {}
    for particle, rows in at.items():
        for a, b in _in_line(particle, rows, pairs, along, corner=particle in corners):
            following[a, particle], following[b, particle] = b, a
    left, found = dict.fromkeys(range(len(pairs))), list[tuple[Ints, Ints]]()
    ends = [(row, p) for row in left for p in pairs[row].tolist() if (row, p) not in following]
    for row, start in [*ends, *((row, int(pairs[row, 0])) for row in list(left))]:
        if row not in left:
            continue
        rows, particles = list[int](), [start]
        step: int | None = row
        while step is not None and step in left:
            del left[step]
            rows.append(step)
            a, b = pairs[step].tolist()
            particles.append(b if a == particles[-1] else a)
            step = following.get((step, particles[-1]))
        found.append((np.array(rows), np.array(particles)))
    return found


def _in_line(particle: int, rows: list[int], pairs: Ints, along: Floats, *, corner: bool) -> list[tuple[int, int]]:
    """Pairs of elements at a particle that continue each other."""
    out = {row: along[row] * (1.0 if pairs[row, 0] == particle else -1.0) for row in rows}
    if len(rows) == 2 and not corner:
        return [(rows[0], rows[1])]
    turns = [(-float(out[a] @ out[b]), a, b) for i, a in enumerate(rows) for b in rows[i + 1 :]]
    used: set[int] = set()
    found = []
    for straight, a, b in sorted(turns, key=lambda turn: (-turn[0], turn[1], turn[2])):
        if straight > STRAIGHT and not {a, b} & used:
            used |= {a, b}
            found.append((a, b))
    return found
