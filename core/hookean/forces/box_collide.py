"""Box collide: boxes along the axes that keep their volume and proportions and push each other apart."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Places, lengths
from hookean.forces.collide import Crowd
from hookean.forces.groups import begins, following
from hookean.values.columns import IndexRows, Lines
from hookean.values.fields import Field, Maybe

# columns of the parameters, after the links of all boxes: stiffness of contacts, volume, proportions; size of the box
# at the start along each axis, negative where the first corner is the upper one, 0: all are flat; skin
STRENGTH, VOLUME, KEEP, SIZE, SKIN = 2, 3, 4, 5, 8
SHORTEST = 1e-40  # size below which a box is flat: products of what is shorter would be 0
SKIN_PART = 0.15  # of the mean size: how far apart boxes already count for the stiffness


@device
def side(x: Any, indices: Any, parameters: Any, e: Any, c: Any, upper: Any) -> Any:
    """Lower or upper end of a box along an axis."""
    second = (parameters[e, SIZE + c] > 0.0) == upper
    return x[indices[e, 1 if second else 0], c]


@device
def meet(x: Any, indices: Any, parameters: Any, e: Any, o: Any) -> Any:
    """The axis along which two boxes overlap least, how much (up to a skin less than 0), and 1 where the first box is
    below the other along it, else -1; the axis is -1 where they are farther apart."""
    axis, least, way = -1, np.inf, 1
    for c in range(3):
        if parameters[e, SIZE + c] == 0.0 or parameters[o, SIZE + c] == 0.0:
            continue
        below = side(x, indices, parameters, e, c, True) - side(x, indices, parameters, o, c, False)
        above = side(x, indices, parameters, o, c, True) - side(x, indices, parameters, e, c, False)
        overlap = min(below, above)
        if overlap <= -parameters[e, SKIN]:
            return -1, 0.0, 1
        if overlap < least:
            axis, least, way = c, overlap, 1 if below <= above else -1
    return axis, least, way


@device
def in_order(x: Any, indices: Any, parameters: Any, first: Any, member: Any, low: Any) -> Any:
    """Write the boxes of a crowd in the order of their lower ends along x, and these; returns how many there are."""
    count, e = 0, first
    while e >= 0:
        low[count] = min(x[indices[e, 0], 0], x[indices[e, 1], 0])
        member[count] = e
        count += 1
        e = following(parameters, e)
    order = np.argsort(low[:count], kind="mergesort")
    kept, at = member[:count].copy(), low[:count].copy()
    for i in range(count):
        member[i], low[i] = kept[order[i]], at[order[i]]
    return count


@device
def beyond(x: Any, indices: Any, parameters: Any, e: Any) -> Any:
    """From where on along x boxes do not touch a box; all do where boxes are flat there."""
    if parameters[e, SIZE] == 0.0:
        return np.inf
    return max(x[indices[e, 0], 0], x[indices[e, 1], 0]) + parameters[e, SKIN]


@device
def shape(x: Any, indices: Any, parameters: Any, e: Any, size: Any, start: Any, slope: Any) -> Any:
    """Sizes now and at the start, and the gradient of the volume's ratio by them; returns that ratio, the length for
    which it counts, and how large the box is by its proportions."""
    ratio, volume, whole, part, used = 1.0, 1.0, 0.0, 0.0, 0
    for c in range(3):
        given = parameters[e, SIZE + c]
        start[c] = np.abs(given)
        size[c] = x[indices[e, 1], c] - x[indices[e, 0], c]
        size[c] = size[c] if given > 0.0 else -size[c] if given < 0.0 else 0.0
        if given != 0.0:
            used += 1
            ratio *= size[c] / start[c]
            volume *= start[c]
            whole += start[c] * start[c]
            part += start[c] * size[c]
    for c in range(3):
        slope[c] = 1.0 / start[c] if start[c] > 0.0 else 0.0
        for d in range(3):
            slope[c] *= size[d] / start[d] if d != c and start[d] > 0.0 else 1.0
    return ratio, volume ** (1.0 / max(used, 1)), part / whole if whole > 0.0 else 0.0


@device
def hold_shape(x: Any, indices: Any, parameters: Any, e: Any, room: Any, f: Any, w: Any) -> Any:
    """Add the forces that keep the volume and proportions of a box; returns their energy."""
    size, start, slope = room[0], room[1], room[2]
    ratio, length, scale = shape(x, indices, parameters, e, size, start, slope)
    volume, keep = parameters[e, VOLUME] * length * length, parameters[e, KEEP]
    energy, total, steep, bend = 0.5 * volume * (ratio - 1.0) * (ratio - 1.0), 0.0, 0.0, 0.0
    for c in range(3):
        total += 2.0 * np.abs(slope[c])
        steep = max(steep, np.abs(slope[c]))
        for d in range(3):
            if d != c and start[c] > 0.0 and start[d] > 0.0:
                other = 3 - c - d
                bend += np.abs(size[other] / start[other] if start[other] > 0.0 else 1.0) / (start[c] * start[d])
    bound = volume * (steep * total + 2.0 * np.abs(ratio - 1.0) * bend) + 2.0 * keep
    w[indices[e, 0]] += bound
    w[indices[e, 1]] += bound
    for c in range(3):
        off = size[c] - scale * start[c]
        energy += 0.5 * keep * off * off
        push = volume * (ratio - 1.0) * slope[c] + keep * off
        push = push if parameters[e, SIZE + c] > 0.0 else -push
        f[indices[e, 0], c] += push
        f[indices[e, 1], c] -= push
    return energy


def box_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, room = 0.0, np.zeros((3, 3))
    member, low = np.empty(indices.shape[0], np.int64), np.empty(indices.shape[0])
    for first in range(indices.shape[0]):
        energy += hold_shape(x, indices, parameters, first, room, f, w)
        for i in range(2):
            w[indices[first, i]] += 2.0 * parameters[first, STRENGTH]
        if not begins(parameters, first):
            continue
        count = in_order(x, indices, parameters, first, member, low)
        for i in range(count):
            e, n = member[i], i + 1
            end = beyond(x, indices, parameters, e)
            while n < count and low[n] < end:
                o = member[n]
                n += 1
                axis, overlap, way = meet(x, indices, parameters, e, o)
                if axis < 0:
                    continue
                k = parameters[e, STRENGTH]
                # the ends that meet: upper of one box, lower of the other
                a = indices[e, 1 if (parameters[e, SIZE + axis] > 0.0) == (way > 0) else 0]
                b = indices[o, 1 if (parameters[o, SIZE + axis] > 0.0) == (way < 0) else 0]
                w[a] += 2.0 * k
                w[b] += 2.0 * k
                if overlap > 0.0:
                    energy += 0.5 * k * overlap * overlap
                    f[a, axis] -= way * k * overlap
                    f[b, axis] += way * k * overlap
    return energy


def box_contacts(x, indices, parameters, pair):  # type: ignore[no-untyped-def]
    """Write the particles of boxes that overlap, the axis and the row of one (k, 4), as many as there is place for;
    returns how many there are."""
    member, low, many = np.empty(indices.shape[0], np.int64), np.empty(indices.shape[0]), 0
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        count = in_order(x, indices, parameters, first, member, low)
        for i in range(count):
            e, n = member[i], i + 1
            end = beyond(x, indices, parameters, e)
            while n < count and low[n] < end:
                o = member[n]
                n += 1
                axis, overlap, way = meet(x, indices, parameters, e, o)
                if axis >= 0 and overlap > 0.0:
                    if many < pair.shape[0]:
                        pair[many, 0] = indices[e, 1 if (parameters[e, SIZE + axis] > 0.0) == (way > 0) else 0]
                        pair[many, 1] = indices[o, 1 if (parameters[o, SIZE + axis] > 0.0) == (way < 0) else 0]
                        pair[many, 2], pair[many, 3] = axis, e
                    many += 1
    return many


class BoxCollide(Crowd):
    """Boxes along the axes that keep their volume and proportions and push each other apart: E = sum k o^2 / 2 + sum K
    l^2 (V / V0 - 1)^2 / 2 + sum S |a - s a0|^2 / 2.

    Each box is given by two opposite corners, which are particles. o is how far two boxes overlap along the axis where
    that is least, and what is pushed are the faces that meet there. V / V0 is the volume of a box by that at the start,
    l^3 = V0; a are its sizes, a0 those at the start and s the scale of least squares: a box that grows or shrinks as a
    whole keeps its proportions. Where all boxes are flat along an axis, they are rectangles in the plane of the others.
    Forces sum to zero. Boxes do not turn: that is what their axes, which are fixed in space, hold, and why the moments
    of these forces do not sum to zero. All boxes of the force can touch. For boxes that are tilted in any way, or turn,
    use `rigid_body` and `rigid_collide`, each with the eight corners of every box as a group. Sources: Cohen et al.,
    "I-COLLIDE", 1995 (sorted ends); classic Kangaroo's BoxCollide.
    """

    kind: Literal["box_collide"] = "box_collide"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles in opposite corners of each box")
    lines: Maybe[Lines] = Field(default=None, description="Diagonals of boxes; their ends become particles")
    strength: float = Field(default=1000.0, ge=0, le=1e12, description="k, stiffness of a contact [force/length]")
    volume_strength: float = Field(default=1000.0, ge=0, le=1e12, description="K, of the volume [force/length]")
    proportion_strength: float = Field(
        default=1000.0, ge=0, le=1e12, description="S, of the proportions [force/length]"
    )

    formula: ClassVar[str] = "E = Σ k o²/2 + Σ K l² (V/V0 - 1)²/2 + Σ S |a - s a0|²/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    arity: ClassVar[int] = 2
    creates: ClassVar[bool] = True
    outputs: ClassVar[dict[str, str]] = {"volume": "", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(box_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of all boxes, stiffnesses, sizes at the start, skin."""
        index = places.elements(self)
        size = places.x[index[:, 1]] - places.x[index[:, 0]]
        met = (index >= 0).all(axis=1)
        least = max(1e-9 * float(np.abs(size[met]).max(initial=0.0)), SHORTEST)
        flat = ~(np.abs(size[met]).max(axis=0, initial=0.0) > least)
        size[:, flat] = 0.0
        thin = np.argwhere((np.abs(size) <= least) & ~flat & met.reshape(-1, 1))
        if len(thin):
            at, axis = thin[0].tolist()
            said = f"box {at} is flat along {'xyz'[axis]}, others are not; give it a size there"
            raise InputError("", said)
        return Block.of(
            index,
            links=groups.links(index, None),
            strength=self.strength,
            volume_strength=self.volume_strength,
            proportion_strength=self.proportion_strength,
            size=size,
            skin=SKIN_PART * float(lengths(size[met]).mean()) if met.any() else 0.0,
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Volume of each box by that at the start [-], and the sum of the forces on its corners [force]."""
        start = block.parameters[:, SIZE : SIZE + 3]
        size = x[block.indices[:, 1]] - x[block.indices[:, 0]]
        ratio = np.where(start != 0.0, size / np.where(start != 0.0, start, 1.0), 1.0).prod(axis=1)
        return {"volume": ratio, "force": element_forces.sum(axis=1)}

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Boxes by themselves, and the ends that meet."""
        x, pair = np.ascontiguousarray(x), np.empty((0, 4), np.int64)
        given = x, block.indices, block.parameters
        while (count := int(dispatch.compiled(box_contacts)(*given, pair))) > len(pair):
            pair = np.empty((count, 4), np.int64)
        met = np.zeros((len(pair), 2, 3, 2, 3))
        k, each = block.parameters[pair[:, 3], STRENGTH], np.arange(len(pair))
        for i in range(2):
            for j in range(2):
                met[each, i, pair[:, 2], j, pair[:, 2]] = k if i == j else -k
        parts = (block.indices, _stiffness(block, x)), (pair[:, :2].copy(), met.reshape(-1, 6, 6))
        return [(groups.Whole, groups.stiff(index, stiffness)) for index, stiffness in parts if len(index)]

    @classmethod
    def holds(cls, block: Block) -> Floats:
        """In no direction: the forces of all elements sum to zero."""
        return np.zeros((len(block.indices), 3, 3))

    @classmethod
    def example(cls) -> tuple[BoxCollide, Floats]:
        """Four boxes, three of which overlap, given by any opposite corners."""
        x = [[0, 0, 0], [2, 1.5, 1], [1.7, 0.3, 0.2], [3.5, 1.9, 1.4], [3.1, 1.6, 2.5], [2.2, 0.4, 1.1]]
        x += [[9, 9, 9], [8, 10, 8.5]]
        force = cls(particles=np.arange(8).reshape(4, 2), strength=50.0, volume_strength=20.0, proportion_strength=30.0)
        return force, np.array(x, float)


def _stiffness(block: Block, x: Floats) -> Floats:
    """Stiffness (m, 6, 6) of boxes by themselves."""
    given = block.parameters[:, SIZE : SIZE + 3]
    start, used = np.abs(given), given != 0.0
    size = np.sign(given) * (x[block.indices[:, 1]] - x[block.indices[:, 0]])
    part = np.where(used, size / np.where(used, start, 1.0), 1.0)
    rate = np.where(used, 1.0 / np.where(used, start, 1.0), 0.0)
    length = np.where(used, start, 1.0).prod(axis=1) ** (1.0 / np.maximum(used.sum(axis=1), 1))
    volume, ratio = block.parameters[:, VOLUME] * length**2, part.prod(axis=1)
    slope = rate * np.stack([np.delete(part, c, axis=1).prod(axis=1) for c in range(3)], axis=1)
    whole = volume[:, None, None] * slope[:, :, None] * slope[:, None]
    for c, d in ((0, 1), (0, 2), (1, 2)):
        bend = volume * (ratio - 1.0) * rate[:, c] * rate[:, d] * part[:, 3 - c - d]
        whole[:, c, d] += bend
        whole[:, d, c] += bend
    square = np.maximum((start**2).sum(axis=1), np.finfo(float).tiny)
    like = used[:, :, None] * np.eye(3) - start[:, :, None] * start[:, None] / square[:, None, None]
    whole += block.parameters[:, KEEP, None, None] * like
    sign = np.sign(given)
    whole *= sign[:, :, None] * sign[:, None]
    return np.block([[whole, -whole], [-whole, whole]])
