"""Sliding cable: a cable that runs over saddles, with one force all along it, or with friction on each saddle."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces import capstan, capstan_tangent, elastic, groups
from hookean.forces.base import Block, Floats, Force, Ints, Places, lengths
from hookean.forces.groups import begins, following
from hookean.forces.line_lengths import apart, length_and_force, line, pull
from hookean.values.columns import IndexRows, Labels, Lines, NonNegatives, fault
from hookean.values.fields import Field, Maybe

K, REST = groups.COLUMNS, groups.COLUMNS + 1  # columns of the parameters

LEAST = 1e-12  # length of a cable, below which EA / L0 has no meaning [length]
SHORTEST = 1e-6  # part of the mean rest length of a cable's lines that each has at least, with friction


@device
def stretch(x: Any, indices: Any, parameters: Any, first: Any) -> Any:
    """By how much a cable is longer than at rest, and of how many lines it is."""
    total, count = -parameters[first, REST], 0
    e = first
    while e >= 0:
        total += line(x, indices, e)[0]
        count += 1
        e = following(parameters, e)
    return total, count


@device
def faster(x: Any, indices: Any, moved: Any, e: Any, d: Any) -> Any:
    """Length of a line, and its rate along a movement (m, 6); write its direction, zero for length 0."""
    length, d[0], d[1], d[2] = line(x, indices, e)
    rate = 0.0
    for c in range(3):
        d[c] /= length if length > 0.0 else 1.0
        rate += d[c] * (moved[e, 3 + c] - moved[e, c])
    return length, rate


def sliding_cable_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        longer, count = stretch(x, indices, parameters, first)
        k = parameters[first, K]
        tension = k * max(longer, 0.0)
        energy += 0.5 * tension * max(longer, 0.0)
        e = first
        while e >= 0:
            length, dx, dy, dz = line(x, indices, e)
            density = tension / length if length > 0.0 else 0.0
            pull(indices, e, density, dx, dy, dz, f)
            for i in range(2):
                w[indices[e, i]] += 2.0 * (count * k + density)
            e = following(parameters, e)
    return energy


def sliding_cable_stressed(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    """Of each line, across it, the rate of its force density along a small movement, `memory` (m, 6) of both ends: the
    force follows the length of the whole cable."""
    d = np.zeros(3)
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        longer, _ = stretch(x, indices, parameters, first)
        if longer <= 0.0:
            continue
        rate, e = 0.0, first
        while e >= 0:
            rate += parameters[first, K] * faster(x, indices, memory, e, d)[1]
            e = following(parameters, e)
        e = first
        while e >= 0:
            length, more = faster(x, indices, memory, e, d)
            if length > 0.0:
                density = (rate - parameters[first, K] * longer * more / length) / length
                for i in range(3):
                    for j in range(3):
                        apart(blocks, e, i, j, density * ((1.0 if i == j else 0.0) - d[i] * d[j]))
            e = following(parameters, e)


class SlidingCable(groups.Grouped):
    """A cable that slides over saddles, with friction if given: E = EA (L - L0)^2 / (2 L0), L the length of its lines.

    The tension T = EA (L - L0) / L0 is the same in each line, whatever their lengths, so at a free pulley both lines
    make the same angle with what the pulley carries. Below L0 the cable is slack. Lines with the same number are one
    cable; without numbers all are. Give the stiffness as EA, or as a material and a section, and the prestress, if any,
    as the force at the start or as the rest length of a whole cable. A line of zero length has no direction and no
    force. For a tension that does not depend on the length, use `constant_tension`.

    With friction mu the forces before and after a saddle, where the cable turns by the angle phi, differ at most by the
    factor exp(mu phi). Within it nothing slips and each line is elastic on its own; at the limit the cable slips. It
    starts with one force all along. What has slipped stays so for the next run, and in physical time for the next step.
    The lines of a cable follow one another in the order of their rows then. Forces with friction have no energy, and a
    tangent for Newton steps alone: the stability of such a model is unknown, and it has no gradients.

    Sources: Aufaure, "A finite element of cable passing through a pulley", 1993; Euler, "Remarques sur l'effet du
    frottement dans l'equilibre", 1762, and Eytelwein, "Handbuch der Statik fester Koerper", 1808 (friction).
    """

    kind: Literal["sliding_cable"] = "sliding_cable"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends become particles")
    group: Maybe[Labels] = Field(default=None, description="Number of the cable of each line; default: all are one")
    axial_stiffness: float | None = Field(default=1000.0, ge=0, le=1e12, description="EA [force]")
    material: str | None = Field(default=None, description="Name of a material, with a section in the place of EA")
    section: str | None = Field(
        default=None, description="Name of a section: with a material in the place of EA, or beside EA for the stress"
    )
    rest_length: float | None = Field(
        default=None, gt=0, le=1e12, description="L0 of a whole cable [length]; default: the start length"
    )
    force: float | None = Field(default=None, ge=0, le=1e12, description="Prestress: tension at the start [force]")

    friction: NonNegatives = Field(
        default=0.0, description="mu [-], or one for each line: on the saddle between it and the line before it"
    )

    formula: ClassVar[str] = "E = EA (L - L0)²/(2 L0)"
    arity: ClassVar[int] = 2
    outputs: ClassVar[dict[str, str]] = {"length": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(sliding_cable_kernel)
    stressed: ClassVar[Any] = staticmethod(sliding_cable_stressed)

    @model_validator(mode="before")
    @classmethod
    def _other_stiffness(cls, value: Any) -> Any:
        return elastic.without(value, "axial_stiffness", ("material", "section"))

    @model_validator(mode="after")
    def _one_way(self) -> SlidingCable:
        names = ("axial_stiffness", "material", "section")
        made = [name for name in names if getattr(self, name) is not None]
        if made not in (["axial_stiffness"], ["axial_stiffness", "section"], ["material", "section"]):
            said = " and ".join(made) or "nothing"
            raise fault(f"{said} given; give either axial_stiffness, or both material and section")
        if self.rest_length is not None and self.force is not None:
            raise fault("rest_length and force given; give at most one of them")
        return self

    @property
    def compiled_as(self) -> type[Force]:
        """`RoughSlidingCable` where there is friction."""
        return RoughSlidingCable if np.any(self.friction) else SlidingCable

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the cables, EA / L0 and L0; InputError if one has no length. With friction
        also mu, how a line follows the one before it, and its own part of L0."""
        index = places.elements(self)
        links = groups.links(index, self.group)
        axial = self.axial_stiffness
        if axial is None:
            axial = elastic.axial_stiffness(self, places)
        elastic.known_area(self, places)
        head = np.arange(len(index)) - links[:, groups.FIRST].astype(np.int64)
        own = lengths(places.x[index[:, 1]] - places.x[index[:, 0]])
        rest = np.asarray(np.bincount(head, own, len(index))[head] if len(index) else own, dtype=np.float64)
        if self.rest_length is not None:
            rest = np.full(len(index), self.rest_length)
        elif self.force is not None:
            if not axial > 0.0:
                raise InputError("", "a cable without stiffness cannot have a force; give an axial_stiffness above 0")
            rest = rest * axial / (axial + self.force)
        if not (rest > LEAST).all():
            raise InputError("", "a cable of a sliding_cable has no length at the start; give a rest_length")
        if self.compiled_as is SlidingCable:
            return Block.of(index, links=links, stiffness=axial / rest, rest=rest)
        shared, count = (np.bincount(head, own, len(index))[head], np.bincount(head, minlength=len(index))[head])
        own = np.where(shared > 0.0, np.maximum(own, SHORTEST * shared / count), 1.0)
        share = rest * own / np.bincount(head, own, len(index))[head]
        return Block.of(
            index, memory=1, links=links, stiffness=axial / rest, rest=rest, friction=self.friction,
            way=_ways(index, links), share=share,
        )  # fmt: skip

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Length of each line [length], and the force of its cable [force]."""
        length = length_and_force(block, x, element_forces)["length"]
        if self.compiled_as is not SlidingCable:
            return length_and_force(block, x, element_forces)
        return {"length": length, "force": block.parameters[:, K] * longer(block, x)}

    @classmethod
    def second(cls, block: Block, memory: Floats, x: Floats) -> Floats:
        """Of each line, if it were a spring on its own, m times as stiff as its cable of m lines, by both ends and by
        how much of the cable is in it: the least over these is the energy of the cable."""
        apart = x[block.indices[:, 1]] - x[block.indices[:, 0]]
        length, more = lengths(apart), longer(block, x)
        long = length > 0.0
        u = apart / np.where(long, length, 1.0)[:, None]
        head = groups.heads(block)
        count = np.bincount(head, minlength=len(head))[head]
        k = np.asarray(np.where(more > 0.0, block.parameters[:, K], 0.0) * count, dtype=np.float64)
        slope = np.column_stack([-u, u, -np.ones(len(u))])
        density = np.where(long, block.parameters[:, K] * more / np.where(long, length, 1.0), 0.0)
        across = density[:, None, None] * (np.eye(3) - u[:, :, None] * u[:, None])
        found: Floats = k[:, None, None] * slope[:, :, None] * slope[:, None]
        found[:, :6, :6] += np.block([[across, -across], [-across, across]])
        return found

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Lines with the places along the cable where they meet as nodes, or whole cables without them; of large ones
        each line as if it could not slide, a bound from above."""
        if not len(block.indices):
            return []
        second = cls.second(block, memory, x)
        if node is not None:
            return _chained(block, second, node)
        found: list[tuple[type[Force], Block]] = []
        for rows in groups.by_size(block):
            members = rows.shape[1]
            if members > groups.LARGEST:
                found.append((groups.Whole, groups.stiff(block.indices[rows.ravel()], second[rows.ravel(), :6, :6])))
                continue
            tension = second[rows][:, :, :6, :6].copy()
            slope, stiff = _slopes(x, block.indices[rows]), second[rows[:, 0], 6, 6]
            tension -= stiff[:, None, None, None] * slope[..., :, None] * slope[..., None, :]
            whole = np.zeros((len(rows), members, 6, members, 6))
            whole[:, range(members), :, range(members)] = tension.transpose(1, 0, 2, 3)
            flat, total = whole.reshape(len(rows), 6 * members, 6 * members), slope.reshape(len(rows), -1)
            flat += (stiff / members)[:, None, None] * total[:, :, None] * total[:, None]
            found.append((groups.Whole, groups.stiff(block.indices[rows].reshape(len(rows), -1), flat)))
        return found

    @classmethod
    def example(cls) -> tuple[SlidingCable, Floats]:
        """Two cables of three and two lines, apart from each other, that take turns; both taut."""
        x = [[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.7, -0.1], [0.2, 0.4, 0.9]]
        x += [[4.0, 0.0, 0.3], [5.1, 0.2, 0.0], [5.0, 2.4, 0.4]]
        pairs = [[0, 1], [4, 5], [1, 2], [5, 6], [2, 3]]
        return cls(particles=pairs, group=[0, 7, 0, 7, 0], axial_stiffness=60.0, force=40.0), np.array(x)


class RoughSlidingCable(SlidingCable):
    """What `sliding_cable` compiles to where there is friction (see there)."""

    variant: ClassVar[bool] = True
    conservative: ClassVar[bool] = False
    remembers: ClassVar[bool] = True
    yielding: ClassVar[tuple[str, ...]] = ("friction",)
    kernel: ClassVar[Any] = staticmethod(capstan.rough_cable_kernel)
    end_of_step: ClassVar[Any] = staticmethod(capstan.rough_cable_note)
    skew: ClassVar[Any] = staticmethod(lambda block, memory, x: rough_cable_skew(block, memory, x))

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Whole cables, by the symmetric part of their tangent. Without nodes, and of large ones, particles by
        themselves, as stiff as they feel: a bound from above."""
        if not len(block.indices):
            return []
        if node is not None and cls.steps(block):
            found = capstan_tangent.tangents(block, memory, x)
            return [(groups.Whole, groups.stiff(i, 0.5 * (k + k.transpose(0, 2, 1)))) for i, k in found]
        own, w = np.unique(block.indices), np.zeros(len(x))
        dispatch.compiled(cls.kernel, "force")(
            x, np.zeros_like(x), block.indices, block.parameters, memory, np.zeros_like(x), w
        )
        return [(groups.Whole, groups.bounded(own[:, None], w[own]))]

    @classmethod
    def steps(cls, block: Block) -> bool:
        """Cables of a size that can be one element."""
        return int(np.unique(groups.heads(block), return_counts=True)[1].max(initial=0)) <= groups.LARGEST

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """Where a cable slips, its tangent is not symmetric: it has one for Newton steps alone."""
        return "a sliding_cable with friction has no tangent"


def rough_cable_skew(block: Block, memory: Floats, x: Floats) -> list[tuple[Ints, Floats]]:
    """Particles and what the tangents of whole cables have beside their symmetric part."""
    found = capstan_tangent.tangents(block, memory, x) if len(block.indices) else []
    return [(index, 0.5 * (k - k.transpose(0, 2, 1))) for index, k in found]


def longer(block: Block, x: Floats) -> Floats:
    """By how much (m,) the cable of each line is longer than at rest; 0 where it is slack."""
    head: Ints = groups.heads(block)
    length = lengths(x[block.indices[:, 1]] - x[block.indices[:, 0]])
    total = np.bincount(head, length, len(head))[head] if len(head) else length
    return np.maximum(total - block.parameters[:, REST], 0.0)


def taut(block: Block, x: Floats) -> tuple[float, float] | None:
    """The length [length] and the strain (L - L0) / L0 [-] of the cable of a force that has one, without friction; None
    where it has more, or that hangs slack."""
    more = longer(block, x)
    if not len(more) or len(np.unique(groups.heads(block))) > 1 or more[0] <= 0.0:
        return None
    rest = block.parameters[0, REST]
    return float(rest + more[0]), float(more[0] / rest)


def _ways(index: Ints, links: Floats) -> Floats:
    """For each line (m,) 1 where its direction goes on that of the line before it in its cable, -1 where one of the two
    is given from its end to its start: they then share their ends, or their starts."""
    found = np.ones(len(index))
    before = np.flatnonzero(links[:, groups.NEXT])
    after = before + links[before, groups.NEXT].astype(np.int64)
    (a, b), (c, d) = index[before].T, index[after].T
    found[after] = np.where((b != c) & (a != d) & ((a == c) | (b == d)), -1.0, 1.0)
    return found


def _slopes(x: Floats, index: Ints) -> Floats:
    """Derivatives (..., 6) of the lengths of lines (..., 2) by their ends; 0 for length 0."""
    apart = x[index[..., 1]] - x[index[..., 0]]
    length = np.linalg.norm(apart, axis=-1, keepdims=True)
    u = apart / np.where(length > 0.0, length, 1.0)
    return np.concatenate([-u, u], axis=-1)


def _chained(block: Block, second: Floats, node: int) -> list[tuple[type[Force], Block]]:
    """Elements of a line's ends and of the nodes between it and the lines before and after it: what is in a line is
    the difference of the two, and the ends of a cable do not move. Slack nodes have a little stiffness."""
    head = groups.heads(block)
    order = np.argsort(head, kind="stable")
    starts = block.parameters[order, groups.FIRST] == 0.0
    ends = np.append(starts[1:], True)
    after = np.full(len(order), -1)
    after[~ends] = node + np.arange(np.count_nonzero(~ends))
    before = np.full(len(order), -1)
    before[~starts] = after[~ends]
    size = second[order, 6, 6]
    size = np.where(size > 0.0, size, 1.0)
    found: list[tuple[type[Force], Block]] = []
    for first in (False, True):
        for last in (False, True):
            rows = np.flatnonzero((starts == first) & (ends == last))
            if not len(rows):
                continue
            own = second[order[rows]]
            # the unknown is what is in the line: that after it less that before it
            spread = np.zeros((8 - first - last, 7))
            spread[range(6), range(6)] = 1.0
            if not first:
                spread[6, 6] = -1.0
            if not last:
                spread[7 - first, 6] = 1.0
            table = spread @ own @ spread.T
            nodes = range(6, len(spread))
            table[:, nodes, nodes] += groups.LEAST * size[rows, None]
            columns = [c[rows, None] for c, there in ((before, not first), (after, not last)) if there]
            index = np.hstack([block.indices[order[rows]], *columns]).astype(np.int64)
            member = Block(np.ascontiguousarray(index), table.reshape(len(rows), -1), np.zeros((len(rows), 0)))
            found.append((groups.Member, member))
    return found
