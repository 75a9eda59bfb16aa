"""What forces on the volume inside closed meshes share: the volume, its gradient, and their tangent.

The energy of a mesh is a function phi of its volume V. Each particle feels p dV/dx with p = -phi'(V), the pressure.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Ints, OnFilm, Places, complete
from hookean.forces.groups import begins, following
from hookean.forces.soapfilm import halves

SHARE, STIFF, START, OUTSIDE, LAW = 2, 3, 4, 5, 6  # columns of the parameters, after the links
ELASTIC, GAS = 0.0, 1.0  # laws: K (V - V0)^2 / (2 V0), and p0 V0 ln(1 / V) + p_out V
LEAST = 1e-3  # part of the start volume below which a gas is as stiff as there
LARGEST = 300  # particles of a mesh up to which it is one element of a tangent


@device
def respond(parameters: Any, first: Any, volume: Any) -> Any:
    """Of a mesh with a volume: its energy, its pressure against the outside, and how much more that falls by volume."""
    stiff, start, outside = parameters[first, STIFF], parameters[first, START], parameters[first, OUTSIDE]
    if parameters[first, LAW] == ELASTIC:
        apart = (volume - start) / start
        return 0.5 * stiff * apart * apart * start, -stiff * apart, stiff / start
    amount, least = stiff * start, LEAST * start
    if volume >= least:
        return outside * volume - amount * np.log(volume / start), amount / volume - outside, amount / volume / volume
    below, fall = volume - least, amount / least / least
    energy = outside * volume - amount * np.log(LEAST) - amount / least * below + 0.5 * fall * below * below
    return energy, amount / least - fall * below - outside, fall


@device
def stiffening(parameters: Any, first: Any, volume: Any) -> Any:
    """How many times as stiff a mesh may become on its way to where its pressure is 0, and twice that: steps that are
    stable for its one stiff mode alone go past that, and would turn it inside out."""
    start, outside = parameters[first, START], parameters[first, OUTSIDE]
    if parameters[first, LAW] == ELASTIC:
        # the square of the gradient grows with the volume to the power of 4/3
        return 2.0 * max(1.0, start / max(volume, LEAST * start)) ** (4.0 / 3.0)
    least = max(parameters[first, STIFF] * start / outside, LEAST * start) if outside > 0.0 else volume
    return 2.0 * max(1.0, volume / max(least, LEAST * start)) ** (2.0 / 3.0)  # times that of 1 / V^2


@device
def cross_of(x: Any, indices: Any, e: Any, n: Any) -> None:
    """Twice the area vector of a triangle."""
    a, b, c = indices[e, 0], indices[e, 1], indices[e, 2]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        n[i] = (x[b, j] - x[a, j]) * (x[c, k] - x[a, k]) - (x[b, k] - x[a, k]) * (x[c, j] - x[a, j])


def enclosed_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    total, n = 0.0, np.zeros(3)
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        volume, slopes, start, e = 0.0, 0.0, indices[first, 0], first
        while e >= 0:
            cross_of(x, indices, e, n)
            part = parameters[e, SHARE] / 6.0
            slopes += 3.0 * part * np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
            for c in range(3):
                volume += part * n[c] * (x[indices[e, 0], c] - x[start, c])
            e = following(parameters, e)
        energy, pressure, fall = respond(parameters, first, volume)
        total += energy
        fall *= stiffening(parameters, first, volume)
        e = first
        while e >= 0:
            cross_of(x, indices, e, n)
            part, reach = parameters[e, SHARE] / 6.0, 0.0
            for i in range(3):
                a, b, square = indices[e, i], indices[e, (i + 1) % 3], 0.0
                for c in range(3):
                    square += (x[b, c] - x[a, c]) * (x[b, c] - x[a, c])
                reach += np.sqrt(square)
            own = part * np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
            for i in range(3):
                a = indices[e, i]
                # of a rank-one tangent g g: |g_i| times the sum of all |g|; of the pressure: its edges
                w[a] += fall * own * slopes + np.abs(pressure) * part * reach
                for c in range(3):
                    f[a, c] += pressure * part * n[c]
            e = following(parameters, e)
    return total


class Enclosed(groups.Grouped):
    """Base of these forces. Their meshes are closed; each is a group of triangles, quads the mean of their two cuts."""

    formula: ClassVar[str] = "E = φ(V)"
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 3
    solid: ClassVar[bool] = False  # the skin itself is other forces
    on_film: ClassVar[OnFilm] = "across"
    outputs: ClassVar[dict[str, str]] = {"force": "force", "volume": "", "pressure": ""}
    kernel: ClassVar[Any] = staticmethod(enclosed_kernel)

    def blocked(self, places: Places, name: str, stiff: float, outside: float, law: float, factor: float) -> Block:
        """The block of the scene's mesh `name`; InputError unless it is closed and has a volume at the start."""
        faces = complete(places.faces(name))
        corners, share, _ = halves(faces)
        reason = "the mesh has no faces; give a closed mesh" if not len(faces) else unclosed(faces)
        volume = float((share * volumes(places.x[corners], places.x[corners[:1, 0]])).sum())
        size = np.ptp(places.x[corners].reshape(-1, 3), axis=0).max() if len(faces) else 0.0
        if not reason and not factor * volume > 1e-12 * size**3:
            unit = places.units.of("length^3")
            what = "turn its faces outwards" if volume < -1e-12 * size**3 else "give a mesh that is not flat"
            reason = f"a volume of {volume:g} {unit} is enclosed; more than 0 is needed: {what}"
        if reason:
            raise InputError(f"/meshes/{name}/faces", reason)
        return Block.of(
            corners,
            links=groups.links(corners, None),
            share=share,
            stiffness=stiff,
            volume=factor * volume,
            outside=outside,
            law=law,
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Force on each triangle [force], the volume of its mesh [length^3] and the pressure [force/length^2]."""
        volume, pressure, _ = responses(block, x)
        return {"force": element_forces.sum(axis=1), "volume": volume, "pressure": pressure}

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Whole meshes; particles of large ones by themselves, as stiff as they feel: a bound from above."""
        _, pressure, fall = responses(block, x)
        found: list[tuple[type[Force], Block]] = []
        for row in (row for rows in groups.by_size(block) for row in rows):
            own, place = np.unique(block.indices[row], return_inverse=True)
            if len(own) <= LARGEST:
                table = np.column_stack([place.reshape(-1, 3), block.parameters[row, SHARE]]).ravel()
                numbers = np.concatenate([[pressure[row[0]], fall[row[0]]], table])
                found.append((Inflated, Block(own[None, :], numbers[None, :], np.zeros((1, 0)))))
                continue
            part, w = cls.taken(block, row[:1])[1], np.zeros(len(x))
            dispatch.compiled(cls.kernel, "force")(
                x, np.zeros_like(x), part.indices, part.parameters, part.memory, np.zeros_like(x), w
            )
            found.append((groups.Whole, groups.bounded(own[:, None], w[own])))
        return found

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """All particles of a mesh feel one another, whichever unknowns there are."""
        head = groups.heads(block)
        most = max((len(np.unique(block.indices[head == first])) for first in np.unique(head)), default=0)
        return f"a closed mesh of {most} particles under pressure is too large for a tangent" if most > LARGEST else ""


class Inflated(Force):
    """Whole meshes as elements of any number of particles: for their tangents alone, see `Enclosed.gathered`."""

    tangent: ClassVar[Any] = staticmethod(lambda block, x: _stiffness(block, x))


def _stiffness(block: Block, x: Floats) -> Floats:
    """Stiffness (k, 3 n, 3 n) of meshes: phi'' g g - p d2V, g the gradient of the volume."""
    found = np.zeros((len(block.indices), 3 * block.indices.shape[1], 3 * block.indices.shape[1]))
    for own, parameters, whole in zip(block.indices, block.parameters, found, strict=True):
        pressure, fall, table = parameters[0], parameters[1], parameters[2:].reshape(-1, 4)
        corners, share = table[:, :3].astype(np.int64), table[:, 3] / 6.0
        place = x[own] - x[own[0]]
        slope, blocks = np.zeros_like(place), whole.reshape(len(own), 3, len(own), 3)
        for i in range(3):
            a, b, c = corners[:, i], corners[:, (i + 1) % 3], corners[:, (i + 2) % 3]
            np.add.at(slope, a, share[:, None] * np.cross(place[b], place[c]))
            for k in range(3):
                p, q = (k + 1) % 3, (k + 2) % 3  # (b x c)_k = b_p c_q - b_q c_p
                for one, axis, part in (
                    (b, p, place[c, q]),
                    (b, q, -place[c, p]),
                    (c, q, place[b, p]),
                    (c, p, -place[b, q]),
                ):
                    np.add.at(blocks, (a, k, one, axis), -pressure * share * part)
        whole += fall * slope.reshape(-1, 1) * slope.ravel()
    return found


def responses(block: Block, x: Floats) -> tuple[Floats, Floats, Floats]:
    """Volume, pressure and its fall by volume of the mesh of each triangle (m,)."""
    head = groups.heads(block)
    own = block.parameters[:, SHARE] * volumes(x[block.indices], x[block.indices[head, 0]])
    volume = np.asarray(np.bincount(head, own, len(head))[head], np.float64)
    found = np.array([respond(block.parameters, row, v) for row, v in enumerate(volume)]).reshape(-1, 3)
    return volume, found[:, 1], found[:, 2]


def volumes(corners: Floats, origin: Floats) -> Floats:
    """Of the cones over triangles (m, 3, 3) to a point for all or for each."""
    a, b, c = (corners - origin[:, None]).transpose(1, 0, 2)
    return np.asarray(np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0)


def unclosed(faces: Ints, corners: str = "particles") -> str:
    """A sentence unless every edge of faces (m, k) is met once in each direction; `corners`: what they number."""
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    ends = ends[ends[:, 0] != ends[:, 1]]
    count = int(faces.max()) + 1
    there, times = np.unique(ends[:, 0] * count + ends[:, 1], return_counts=True)
    back = np.unique(ends[:, 1] * count + ends[:, 0])
    lost = np.setdiff1d(there, back)
    if len(lost) or (times > 1).any():
        edge = int(lost[0] if len(lost) else there[np.argmax(times)])
        return f"the mesh is not closed at the edge of {corners} {edge // count} and {edge % count}; give a closed mesh"
    return ""
