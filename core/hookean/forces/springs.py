"""Springs: Hooke's law along straight connections, with damping, cutoffs and plasticity."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces import spring_inputs
from hookean.forces.base import Block, Floats, Force, Ints, Places
from hookean.forces.elastic import without
from hookean.values.columns import IndexRows, Lines, NonNegatives, Positives, Reals
from hookean.values.fields import Field, Maybe

Edges = Literal["all", "warp", "weft", "naked", "diagonals", "diagonals_one", "diagonals_other"]


SEVERAL = 128  # packed springs at a time: what is between stays in the nearest cache


@device
def pull(x: Any, v: Any, indices: Any, parameters: Any, f: Any) -> None:
    """Forces of packed springs: one vector operation for the columns of a particle, and for the roots and quotients of
    several springs."""
    count = indices.shape[0]
    d, density, rate = np.empty((SEVERAL, 4)), np.empty(SEVERAL), np.empty(SEVERAL)
    for first in range(0, count, SEVERAL):
        some = min(SEVERAL, count - first)
        for j in range(some):
            i, (a, b) = np.uint64(j), ends(indices[np.uint64(first + j), 0])
            d0 = x[b, 0] - x[a, 0]
            d1 = x[b, 1] - x[a, 1]
            d2 = x[b, 2] - x[a, 2]
            d3 = x[b, 3] - x[a, 3]
            d[i, 0] = d0
            d[i, 1] = d1
            d[i, 2] = d2
            d[i, 3] = d3
            density[i] = d0 * d0 + d1 * d1 + d2 * d2
            if parameters.shape[0] == 3:
                rate[i] = (v[b, 0] - v[a, 0]) * d0 + (v[b, 1] - v[a, 1]) * d1 + (v[b, 2] - v[a, 2]) * d2
        if parameters.shape[0] == 3:
            viscous(parameters[0, first:], parameters[1, first:], parameters[2, first:], rate, density, some)
        else:
            elastic(parameters[0, first:], parameters[1, first:], density, some)
        for j in range(some):
            i, (a, b) = np.uint64(j), ends(indices[np.uint64(first + j), 0])
            d0 = d[i, 0] * density[i]
            d1 = d[i, 1] * density[i]
            d2 = d[i, 2] * density[i]
            d3 = d[i, 3] * density[i]
            f[a, 0] += d0
            f[a, 1] += d1
            f[a, 2] += d2
            f[a, 3] += d3
            f[b, 0] -= d0
            f[b, 1] -= d1
            f[b, 2] -= d2
            f[b, 3] -= d3


@device
def elastic(k: Any, tension: Any, squares: Any, count: Any) -> None:
    """Force densities k - k L0 / l of springs, in the place of the squares of their lengths."""
    for j in range(count):
        length = np.sqrt(squares[j])
        less = tension[j] / length
        squares[j] = k[j] - (less if length > 0.0 else 0.0)


@device
def viscous(k: Any, tension: Any, c: Any, rate: Any, squares: Any, count: Any) -> None:
    """`elastic` with c times the rate of stretching, by length: `rate` is that of half the square."""
    for j in range(count):
        square = squares[j]
        more = c[j] * rate[j] / square - tension[j] / np.sqrt(square)
        squares[j] = k[j] + (more if square > 0.0 else 0.0)


@device
def ends(pair: Any) -> Any:
    """The two particles of a packed spring; unsigned: no index counts from the end."""
    return np.uint64(pair) & np.uint64(0xFFFFFFFF), np.uint64(pair) >> np.uint64(32)


@device
def cutoffs(parameters: Any, e: Any, rest: Any) -> Any:
    """Upper and lower cutoff of a spring; negative: none. Columns below 0 are cutoffs that follow the rest length."""
    high, low = parameters[e, 4], parameters[e, 5]
    if high < 0.0:
        high = max(rest, 0.0)
    elif high == 0.0:
        high = -1.0
    return high, rest if low < 0.0 else low


def springs_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    if indices.shape[1] == 1:
        pull(x, v, indices, parameters, f)
        return energy
    for e in range(indices.shape[0]):
        a = np.uint64(indices[e, 0])  # unsigned: no index counts from the end
        b = np.uint64(indices[e, 1])
        dx = x[b, 0] - x[a, 0]
        dy = x[b, 1] - x[a, 1]
        dz = x[b, 2] - x[a, 2]
        k = parameters[e, 0]
        w[a] += 2.0 * k
        w[b] += 2.0 * k
        first = parameters[e, 2] * parameters[e, 3]
        rest = first + memory[e, 0]
        length = np.sqrt(dx * dx + dy * dy + dz * dz)
        if parameters[e, 4] != 0.0 or parameters[e, 5] != 0.0 or parameters[e, 6] > 0.0:
            reach = length
            high, low = cutoffs(parameters, e, rest)
            if high >= 0.0 and reach > high:
                reach = high
            if reach < low:
                reach = low
            stretch = reach - rest
            limit = parameters[e, 6]
            tension = k * stretch
            if limit > 0.0 and np.abs(stretch) > limit:
                tension = k * np.copysign(limit, stretch)
                energy += k * limit * (np.abs(stretch) - 0.5 * limit)
            else:
                energy += 0.5 * k * stretch * stretch
            if reach != length:
                continue
        else:
            tension = k * (length - rest)
            energy += 0.5 * tension * (length - rest)
        if length > 0.0:
            inverse = 1.0 / length  # one division serves all
            tension *= inverse
            if parameters[e, 1] > 0.0:
                rate = (v[b, 0] - v[a, 0]) * dx + (v[b, 1] - v[a, 1]) * dy + (v[b, 2] - v[a, 2]) * dz
                tension += parameters[e, 1] * rate * inverse * inverse
            dx *= tension
            dy *= tension
            dz *= tension
            f[a, 0] += dx
            f[a, 1] += dy
            f[a, 2] += dz
            f[b, 0] -= dx
            f[b, 1] -= dy
            f[b, 2] -= dz
    return energy


@device
def stiffness_of(x: Any, indices: Any, parameters: Any, memory: Any, e: Any) -> Any:
    """Of one spring: its stiffness along and across, and the unit vector along it, zero for length 0."""
    dx = x[indices[e, 1], 0] - x[indices[e, 0], 0]
    dy = x[indices[e, 1], 1] - x[indices[e, 0], 1]
    dz = x[indices[e, 1], 2] - x[indices[e, 0], 2]
    length = np.sqrt(dx * dx + dy * dy + dz * dz)
    first = parameters[e, 2] * parameters[e, 3]
    stretch = length - first - memory[e, 0]
    limit = parameters[e, 6]
    high, low = cutoffs(parameters, e, first + memory[e, 0])
    off = high >= 0.0 and length > high or length < low
    along = 0.0 if off else parameters[e, 0]
    across = along
    inverse = 1.0 / length if length > 0.0 else 0.0  # one division serves all; that of a square might overflow
    if length > 0.0:
        across = along * stretch * inverse
        if limit > 0.0 and np.abs(stretch) > limit:
            across = along * np.copysign(limit, stretch) * inverse
            along = 0.0
    return along, across, dx * inverse, dy * inverse, dz * inverse


def springs_central(x, indices, parameters, memory, stiffness):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        stiffness[e, 0], stiffness[e, 1], stiffness[e, 2], stiffness[e, 3], stiffness[e, 4] = stiffness_of(
            x, indices, parameters, memory, e
        )


def springs_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    d = np.zeros(3)
    for e in range(indices.shape[0]):
        along, across, d[0], d[1], d[2] = stiffness_of(x, indices, parameters, memory, e)
        for i in range(3):
            for j in range(3):
                entry = (along - across) * d[i] * d[j] + (across if i == j else 0.0)
                blocks[e, i, j] = entry
                blocks[e, 3 + i, 3 + j] = entry
                blocks[e, i, 3 + j] = -entry
                blocks[e, 3 + i, j] = -entry


def springs_yield(x, indices, parameters, memory):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):
        if parameters[e, 6] > 0.0:
            length = 0.0
            for c in range(3):
                length += (x[indices[e, 1], c] - x[indices[e, 0], c]) ** 2
            length = np.sqrt(length)
            first = parameters[e, 2] * parameters[e, 3]
            stretch = length - first - memory[e, 0]
            limit = parameters[e, 6]
            high, low = cutoffs(parameters, e, first + memory[e, 0])
            off = high >= 0.0 and length > high or length < low
            if limit > 0.0 and np.abs(stretch) > limit and not off:
                memory[e, 0] += stretch - np.copysign(limit, stretch)


def springs_measures(x, indices, parameters, memory, forces, length, force, strain):  # type: ignore[no-untyped-def]
    """Write the length, the force along (tension +) and the strain of each spring; `forces` (m, 2, 3) on its ends."""
    for e in range(indices.shape[0]):
        a, b = np.uint64(indices[e, 0]), np.uint64(indices[e, 1])
        dx, dy, dz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
        size = np.sqrt(dx * dx + dy * dy + dz * dz)
        along = dx * forces[e, 0, 0] + dy * forces[e, 0, 1] + dz * forces[e, 0, 2]
        rest = parameters[e, 2] * parameters[e, 3] + memory[e, 0]
        length[e] = size
        force[e] = along / size if size > 0.0 else along
        strain[e] = (size - rest) / rest if rest > 1e-300 * size else 0.0  # not more than there are numbers for


class Springs(Force):
    """Linear springs (Hooke): tension = k (l - L0), L0 = rest length x rest factor.

    Energy k (l - L0)^2 / 2; damping adds c times the rate of stretching along the spring. A spring works only
    at lengths up to its upper cutoff and from its lower cutoff on (0: no limit). Plasticity is the largest elastic
    deformation as a part of the rest length, yield extension the same as a length: beyond it the tension stays, and the
    rest length follows at the end of the step. A rest length of 0 makes a force-density spring. Source: the chapter,
    9.4, figures 9.11 to 9.13.

    Cables and bars: give the stiffness in one way, as k, as EA (k = EA / L0 of each element), or as a material and a
    section (EA = E x area); a section beside k or EA gives the area for the stress. With `tension_only` a spring is
    slack below its rest length, as a cable; with `compression_only` it has no force above it, as a strut. Give the
    prestress in one way, too: as the `force` that the spring has at its start length, the `strain` (l - L0) / L0 there,
    or the rest length. A rest factor multiplies the rest length that follows: with the default, 1, the force is as
    given. A temperature, of a material with thermal expansion, lengthens the rest length by 1 + expansion x
    temperature, on top of the prestress.
    """

    kind: Literal["springs"] = "springs"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends become particles")
    mesh: str | None = Field(default=None, description="Name of a mesh whose edges become springs")
    edges: Edges = Field(default="all", description="Which edges of the mesh; diagonals of quads both, or one a face")
    stiffness: Maybe[NonNegatives] = Field(default=1000.0, description="k [force/length]")
    axial_stiffness: Maybe[NonNegatives] = Field(default=None, description="EA, in the place of k [force]")
    material: str | None = Field(default=None, description="Name of a material, with a section in the place of k")
    section: str | None = Field(
        default=None,
        description="Name of a section: with a material in the place of k, or beside k or EA",
    )
    strength: Maybe[Positives] = Field(
        default=None, description="Breaking force, for the utilisation [force]; default: that of material and section"
    )
    damping: NonNegatives = Field(default=10.0, description="c along the spring [force time/length]")
    rest_length: Maybe[NonNegatives] = Field(default=None, description="L0 [length]; default: the start length")
    force: Maybe[Reals] = Field(default=None, description="Prestress: force at the start length [force; tension +]")
    strain: Maybe[Reals] = Field(default=None, description="Prestress: strain at the start length [-]")
    temperature: Maybe[Reals] = Field(default=None, description="Change of temperature, of a material [K]")
    rest_factor: NonNegatives = Field(default=1.0, description="Factor on the rest length [-]")
    tension_only: bool = Field(default=False, description="Whether springs are slack below their rest length")
    compression_only: bool = Field(default=False, description="Whether springs have no force above their rest length")
    upper_cutoff: NonNegatives = Field(default=0.0, description="Works only up to this length [length]; 0: always")
    lower_cutoff: NonNegatives = Field(default=0.0, description="Works only from this length on [length]; 0: always")
    plasticity: NonNegatives = Field(default=0.0, description="Elastic limit as a part of the rest length [-]; 0: none")
    yield_extension: NonNegatives = Field(
        default=0.0, description="Elastic limit as a length, in the place of plasticity [length]; 0: none"
    )

    formula: ClassVar[str] = "E = k (l - L0)²/2"
    arity: ClassVar[int] = 2
    linear: ClassVar[str] = "stiffness"
    pieces: ClassVar[dict[str, int] | None] = {
        **dict.fromkeys(("stiffness", "damping"), 1),
        **dict.fromkeys(("rest_length", "upper_cutoff", "lower_cutoff", "yield_extension"), -1),
    }
    steady: ClassVar[str] = "stiffness"  # across it is k (1 - L0 / l), which is less
    damped: ClassVar[bool] = True
    remembers: ClassVar[bool] = True
    outputs: ClassVar[dict[str, str]] = {"length": "length", "force": "force", "strain": ""}
    kernel: ClassVar[Any] = staticmethod(springs_kernel)
    hessian: ClassVar[Any] = staticmethod(springs_hessian)
    central: ClassVar[Any] = staticmethod(springs_central)
    end_of_step: ClassVar[Any] = staticmethod(springs_yield)

    @model_validator(mode="before")
    @classmethod
    def _other_stiffness(cls, value: Any) -> Any:
        return without(value, "stiffness", spring_inputs.OTHERS)

    @model_validator(mode="after")
    def _one_way(self) -> Springs:
        spring_inputs.one_way(self)
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k, c, rest length, factor, upper and lower cutoff, plasticity as a length."""
        index = places.elements(self)
        stiffness, rest = spring_inputs.resolved(self, places, index)
        limit = self.plasticity * (rest * self.rest_factor)
        if np.count_nonzero(self.yield_extension):
            limit = np.where(np.greater(self.yield_extension, 0.0), self.yield_extension, limit)
        return Block.of(
            index,
            memory=1,
            stiffness=stiffness,
            damping=self.damping,
            rest_length=rest,
            rest_factor=self.rest_factor,
            upper_cutoff=-1.0 if self.compression_only else self.upper_cutoff,
            lower_cutoff=-1.0 if self.tension_only else self.lower_cutoff,
            plasticity=limit,
        )

    @classmethod
    def pack(cls, block: Block, memory: Floats, damped: bool) -> tuple[Ints, Floats] | None:
        """Both ends in one number; and rows of k, k x rest length and where it counts c, each of all springs; not with
        cutoffs or plasticity. The one column of indices tells the kernel."""
        p, same = block.parameters, block.plan
        if same and same[0] == damped and np.array_equal(same[1], p) and np.array_equal(same[2], memory):
            return same[3], same[4]
        if p[:, 4:].any():
            return None
        table = [p[:, 0], p[:, 0] * (p[:, 2] * p[:, 3] + memory[:, 0])]
        if damped and p[:, 1].any():
            table.append(p[:, 1])
        index = block.indices[:, :1] | block.indices[:, 1:] << 32
        block.plan[:] = [damped, p.copy(), memory.copy(), index, np.array(table)]
        return index, block.plan[4]

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Length [length], force [force; tension +] and strain (l - L0)/L0 [-; 0 for rest length 0]."""
        length, force, strain = np.empty((3, len(block.indices)))
        dispatch.compiled(springs_measures)(
            x, block.indices, block.parameters, block.memory, element_forces, length, force, strain
        )
        return {"length": length, "force": force, "strain": strain}

    @classmethod
    def example(cls) -> tuple[Springs, Floats]:
        """Four springs on four particles: elastic, pre-tensioned, of rest length 0, plastic."""
        x = np.array([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [0.2, 0.4, 0.9]])
        springs = cls(
            particles=[[0, 1], [1, 2], [2, 3], [3, 0]],
            stiffness=[1000.0, 500.0, 20.0, 300.0],
            rest_factor=[1.0, 0.8, 0.0, 1.05],
            plasticity=[0.0, 0.0, 0.0, 0.2],
        )
        return springs, x
