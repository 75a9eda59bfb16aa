"""What a force is: columns that a person fills in, a kernel, and a declaration of what laws it obeys."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal, Protocol, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from hookean.values.columns import Model, fault
from hookean.values.fields import Field
from hookean.values.materials import Material
from hookean.values.sections import Section
from hookean.values.units import Units

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


OnFilm = Literal["whole", "across", "spread", "curve"]
"""Which part of a force counts at a particle of a soap film (see `hookean.films`): all of it; what is across the film;
the same if it acts on whole faces of the film, what is across a line of particles, or all of it at single ones (loads,
pulls to surfaces); and what is across a line of particles that are pulled to a curve and slide along it."""


def lengths(vectors: Floats) -> Floats:
    """Length of each row (n, 3); ten times as fast as the norm along an axis."""
    x, y, z = vectors.T
    found: Floats = np.sqrt(x * x + y * y + z * z)
    return found


def units(vectors: Floats) -> Floats:
    """Unit vectors (m, 3) along rows (m, 3), or (1, 3) along one vector (3,); none may have zero length."""
    rows = np.atleast_2d(vectors)
    rows = rows / np.abs(rows).max(axis=1, keepdims=True)  # squares of what is very small would be 0
    return np.asarray(rows / lengths(rows)[:, None])


def complete(faces: Ints) -> Ints:
    """The faces (m, 4) of a mesh whose corners all met particles."""
    return faces[(faces >= 0).all(axis=1)]


PLACES = ("particles", "points", "lines", "mesh")
"""The fields that say where a force acts; a force has some of them and is given exactly one."""


@dataclass
class Block:
    """One force compiled to arrays: what its kernel reads. All C-contiguous.

    `indices` (m, arity) particles of each element; `parameters` (m, p); `memory` (m, q), what elements remember
    (plastic rest lengths); `names` has the input that each column of `parameters` came from, so that a patch
    can write it.
    """

    indices: Ints
    parameters: Floats
    memory: Floats
    names: tuple[str, ...] = ()
    plan: list[Any] = field(default_factory=list)  # what `Force.pack` keeps for the next time
    rooms: tuple[Any, ...] = ()  # arrays whose addresses stand in the column `room`, to live as long

    @classmethod
    def of(cls, indices: Any, *, memory: int = 0, **columns: Any) -> Block:
        """Build a block from `indices` (m, arity) and named columns: one value, (m,) values or (m, k) rows."""
        index = np.ascontiguousarray(indices, dtype=np.int64)
        names: list[str] = []
        filled: list[tuple[int, Floats]] = []  # what is not zero for all elements
        for name, column in columns.items():
            values = np.asarray(column, dtype=np.float64)
            count = values.shape[1] if values.ndim > 1 else 1
            if values.size != count or values.tobytes() != bytes(8 * count):
                filled.append((len(names), values))
            names += [name] * count
        table = np.zeros((len(index), len(names)))
        for at, values in filled:
            if values.ndim > 1:
                for i in range(values.shape[1]):  # quicker than all of them at once
                    table[:, at + i] = values[:, i]
            else:
                table[:, at] = values
        return cls(index, table, np.zeros((len(index), memory)), tuple(names))

    def some(self, rows: Ints | slice) -> Block:
        """Some elements as a block of their own; of a slice its arrays are views."""
        return Block(self.indices[rows], self.parameters[rows], self.memory[rows], self.names, rooms=self.rooms)


class Places(Protocol):
    """Where a force's elements are, once coordinates have become particles (see `weld.Welded`)."""

    x: Floats

    def elements(self, force: Force) -> Ints:
        """Particles of every element of `force`, `(m, arity)`; -1 where a load or anchor met none."""
        ...

    def faces(self, name: str) -> Ints:
        """Faces `(m, 4)` of the scene's mesh `name`, in particles; a triangle repeats its last corner."""
        ...

    def warp(self, faces: Ints) -> Ints:
        """Edges (k, 2) of quads (m, 4) that run along the warp (see `discretize.warp_weft`)."""
        ...

    def geometry(self, name: str) -> tuple[Floats, Ints]:
        """Vertices (n, 3) and faces (m, 4) of the scene's mesh `name`, as drawn; raises InputError if it does not
        exist."""
        ...

    def material(self, name: str) -> Material:
        """The scene's material of this name, or a known one; raises InputError if it does not exist."""
        ...

    def section(self, name: str) -> Section:
        """The scene's section of this name; raises InputError if it does not exist."""
        ...

    @property
    def units(self) -> Units:
        """Units of the scene."""
        ...


class Force(Model):
    """Base of all forces. A force is one file in this folder: a class with columns, and its kernel.

    The kernel is `(x, v, indices, parameters, memory, f, w) -> energy`: it adds force `f[n, 3]` and lumped
    stiffness `w[n]` to the particles. `w` is a bound of the stiffness a particle feels: with it on the diagonal,
    `diag(w) - Hessian` has no negative eigenvalue (a spring adds 2k at both ends).
    """

    name: str = Field(default="", description="Name under which results list this force")

    kind_name: ClassVar[str] = ""  # the default of `kind`, by which scenes name the force
    # the declaration; the law tests hold every force to it
    kind_title: ClassVar[str] = ""
    formula: ClassVar[str] = ""
    role: ClassVar[Literal["internal", "load", "support"]] = "internal"  # internal: forces and moments sum to zero
    conservative: ClassVar[bool] = True  # force = -gradient of the energy the kernel returns
    bears: ClassVar[bool] = False  # a load that can also carry what is loaded, as water does
    bearing: ClassVar[bool] = False  # an elastic support of single particles: its forces count as reactions
    oriented: ClassVar[bool] = False  # internal, but of a direction fixed in space: a turned shape has other forces
    constant: ClassVar[bool] = False  # the force is the same wherever the particles are
    directed: ClassVar[bool] = False  # a load whose size follows the shape, while its direction stays
    # the column that bounds an element's stiffness in every shape (K <= k times the identity, of two particles k times
    # that of a spring); "" where stiffness has no such bound
    steady: ClassVar[str] = ""
    linear: ClassVar[str] = ""  # a column that multiplies all of the force: derivatives by it are exact
    # the column with the size of a force along lines that it keeps until they nearly vanish (see `linear.directions`)
    sharp: ClassVar[str] = ""
    damped: ClassVar[bool] = False  # the kernel reads the velocities; its column `damping` bounds that likewise
    remembers: ClassVar[bool] = False  # memory changes at the end of a step
    yielding: ClassVar[tuple[str, ...]] = ("plasticity",)  # only where one of these columns is not 0, if it has them
    arity: ClassVar[int] = 1
    everywhere: ClassVar[bool] = False  # may be given without a place, and then acts on all particles
    creates: ClassVar[bool] = True  # its coordinates become particles; else they must meet one
    shared: ClassVar[tuple[str, ...]] = ()  # columns of the force as a whole, not one row for each element
    outward: ClassVar[bool] = False  # a load along the normals of faces, so that it counts which way round these run
    solid: ClassVar[bool] = True  # something lies between the particles of an element, which others may touch
    pointed: ClassVar[bool] = False  # an element may start and end at one particle
    momentary: ClassVar[bool] = False  # no force: momentum at moments, by `kick` and `next_moment`; it has no kernel
    # acts only while things touch, at once with the lumped stiffness that its kernel adds before: steps of a motion
    # are short enough for that
    touches: ClassVar[bool] = False
    rewired: ClassVar[bool] = False  # which of its elements feel one another changes with the shape
    # its particles have orientations: the indices of its elements go on with their slots and references, and a column
    # `arm` for each particle gets the length of its slot (see `rotations`)
    turns: ClassVar[bool] = False
    # what it adds at those of its particles that have orientations by other forces; made by `Rider.of`
    rider: ClassVar[type[Rider] | None] = None
    zero: ClassVar[tuple[str, ...]] = ()  # conservative where these columns are all 0
    is_film: ClassVar[bool] = False  # has no stiffness along itself
    on_film: ClassVar[OnFilm] = "whole"
    # columns of a result with their unit: length, force, moment, angle or none
    outputs: ClassVar[dict[str, str]] = {}

    # where a line of it is divided into n pieces, columns are multiplied by n to these powers; None: it is not divided
    pieces: ClassVar[dict[str, int] | None] = None

    # other parts of a scene that its example comes to rest with, where it is no load and has no equilibrium by itself
    example_beside: ClassVar[dict[str, Any]] = {}

    variant: ClassVar[bool] = False  # no kind of its own, but what some forces of a kind compile to (`compiled_as`)

    kernel: ClassVar[Callable[..., float] | None] = None
    hessian: ClassVar[Callable[..., None] | None] = None
    blur: ClassVar[float] = 1e-9  # part of its tangent that may be wrong, where that has no `hessian`
    # the same, quicker, of forces along the line between two particles: stiffness along, across, and x y z of the line
    central: ClassVar[Callable[..., None] | None] = None
    # the same of `gathered` elements, from their block and the positions
    tangent: ClassVar[Callable[[Block, Floats], Floats] | None] = None
    # what the forces of a small movement add to its tangent; the kernel gets the movement after the memory
    stressed: ClassVar[Callable[..., None] | None] = None
    # the same of elements of its own, from its block, the positions and the movement: their particles and blocks
    bent: ClassVar[Callable[[Block, Floats, Floats], list[tuple[Ints, Floats]]] | None] = None
    # the part of its tangent that is not symmetric, from its block, memory and the positions, where slots are folded
    # (see `rotations`): particles and blocks of elements
    skew: ClassVar[Callable[[Block, Floats, Floats], list[tuple[Ints, Floats]]] | None] = None
    end_of_step: ClassVar[Callable[..., None] | None] = None
    impact: ClassVar[Callable[..., None] | None] = None
    support: ClassVar[Callable[..., None] | None] = None

    @classmethod
    def __pydantic_init_subclass__(cls, **given: Any) -> None:
        super().__pydantic_init_subclass__(**given)
        if "kind" in cls.model_fields:
            cls.called = cls.kind_name = str(cls.model_fields["kind"].default)

    @property
    def element_arity(self) -> int:
        """How many particles an element has; a force whose elements differ by its inputs overrides this."""
        return self.arity

    @property
    def compiled_as(self) -> type[Force]:
        """The class whose kernels and declaration count for it: its own, or a `variant`."""
        return type(self)

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        fields = [f for f in PLACES if f in type(self).model_fields]
        given = [f for f in fields if getattr(self, f) is not None]
        if len(given) > 1 or (fields and not given and not self.everywhere):
            said = f"{' and '.join(given)} given" if given else "its place is missing"
            raise fault(f"{said}; give exactly one of {', '.join(fields)}")
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel; raises InputError for an invalid element."""
        raise TypeError(f"{type(self).__name__} does not define compile()")

    @classmethod
    def pack(
        cls, block: Block, memory: Floats, damped: bool
    ) -> tuple[Ints, Floats] | tuple[Ints, Floats, Floats] | None:
        """Indices and parameters for the loops of solvers, that the kernel knows by their shape, and what it takes in
        the place of `memory` if that is something else; None: as they are.

        With them it adds to `f` alone (its stiffness and energy are not asked for), x, v and f have a fourth column of
        zeros, and without `damped` nothing moves. `memory` stays as it is meanwhile.
        """
        return None

    @classmethod
    def whole(cls, block: Block, memory: Floats) -> tuple[Ints, Floats, Floats]:
        """Indices, parameters and memory with which the kernel gives forces, stiffness and energy of the whole block,
        where there is a quicker way than element by element."""
        return block.indices, block.parameters, memory

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Elements that each have a tangent of their own at `x`, by classes with the same number of particles, where
        those of the block feel one another; None: they do not.

        With a `node`, elements may have unknowns of their own, from that number on: nodes with one axis, the first,
        that make the tangent sparse and change neither its solutions nor how many of its eigenvalues are negative.
        """
        return None

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """Why elements of a block have no tangent, as a sentence without its full stop; empty where they have one.

        `sparse`: whether `gathered` is given a `node`. Without a tangent, solvers relax and stability is unknown.
        """
        return ""

    @classmethod
    def steps(cls, block: Block) -> bool:
        """Whether elements of a block have a tangent for Newton steps alone, where `no_tangent` has a reason."""
        return False

    @classmethod
    def connected(cls, block: Block) -> Ints:
        """Particles that belong to the same component of the model, by rows (see `system.components`)."""
        return block.indices[:, : 2 * cls.arity] if cls.turns else block.indices  # without references, which are held

    @classmethod
    def amiss(cls, block: Block, x: Floats) -> str:
        """Why a shape `x` (n, 3) is no equilibrium although its forces balance, as a sentence without its full stop;
        empty where it may be one. Bodies that lie in each other so that nothing pushes them out are an example."""
        return ""

    @classmethod
    def holds(cls, block: Block) -> Floats | None:
        """Of a support: the projections (m, 3, 3) on the directions in which its elements can push, whatever the shape;
        None: in any."""
        return None

    @classmethod
    def taken(cls, block: Block, rows: Ints) -> tuple[Ints, Block]:
        """Elements of a block (sorted rows) as a block of their own, with those that they feel; and the rows of all."""
        return rows, block.some(rows)

    @classmethod
    def brace(cls, block: Block, held: NDArray[np.bool_], mass: Floats) -> None:
        """Write into the parameters of a block, if it matters, which particles (n,) the scene's anchors hold, and their
        masses (n,) [mass], infinite where they are held on all axes."""

    @classmethod
    def kick(cls, block: Block, x: Floats, since: float, until: float) -> Floats:
        """Momentum (m, 3) [force time] given to the first particle of each element at positions `x`, at the beginning
        of a time step from `since` until before `until` [time]; the same for the same arguments."""
        raise TypeError(f"{cls.__name__} does not define kick()")

    @classmethod
    def next_moment(cls, block: Block, since: float) -> float:
        """The first moment [time] from `since` on at which `kick` gives something; infinite if there is none."""
        raise TypeError(f"{cls.__name__} does not define next_moment()")

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """What a result reports of each element, by the names and units of `outputs`.

        `element_forces` (m, arity, 3): the force each element puts on each of its particles. Without a `measure` of
        its own, a class with the output `force` reports their sum.
        """
        return {"force": element_forces.sum(axis=1)} if "force" in self.outputs else {}

    @classmethod
    def example(cls) -> tuple[Force, Floats]:
        """A small generic instance on particle indices, and positions, for the law tests and the catalogue."""
        raise TypeError(f"{cls.__name__} gives no example")


class Rider(Force):
    """Elements that a force has beside its own, at the particles with orientations (see `Force.rider`)."""

    turns: ClassVar[bool] = True

    @classmethod
    def of(cls, force: Any, block: Block) -> Block:
        """Its elements, of the force and the rows of its block at particles with orientations."""
        raise TypeError(f"{cls.__name__} does not define of()")

    @classmethod
    def missing(cls, force: Any, block: Block) -> str:
        """A sentence on rows of a block at particles without orientations, if the force needs one there; else empty."""
        return ""

    @classmethod
    def measured(cls, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """What it adds to the columns of a result."""
        return {}
