"""Quantities of an equilibrium that goals and constraints name, each with its derivatives.

A quantity has values (k,), their derivatives by all positions (k, 3n), and by the unknowns at fixed positions (k, u).
A new quantity is a class here.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import StrictInt, StrictStr

from hookean.errors import InputError
from hookean.values.columns import Indices, Model
from hookean.values.fields import Field, Maybe

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Column, Unknowns
    from hookean.forces.base import Block
    from hookean.system.system import Group, Part, System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Slopes = tuple[Any, Any]
"""Derivatives by positions (k, 3n) and by unknowns (k, u), sparse."""

Axes = Literal["x", "y", "z", "xy", "xz", "yz", "xyz"]
AXES = {"x": 0, "y": 1, "z": 2}


class Quantity(Model):
    """Base of all quantities."""

    unit: ClassVar[str] = ""  # dimension of its values, see `Units.of`

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """Its values (k,) at an equilibrium; InputError at the pointer where it does not fit the scene."""
        raise TypeError(f"{type(self).__name__} does not define values()")

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Their derivatives."""
        raise TypeError(f"{type(self).__name__} does not define slopes()")


def _nothing(rows: int, columns: int) -> Any:
    from scipy.sparse import csr_matrix

    return csr_matrix((rows, columns))


def _matrix(rows: Any, columns: Any, values: Any, shape: tuple[int, int]) -> Any:
    from scipy.sparse import coo_matrix

    flat = [np.asarray(each).ravel() for each in (values, rows, columns)]
    return coo_matrix((flat[0], (flat[1], flat[2])), shape=shape).tocsr()


class Position(Quantity):
    """Coordinates of particles [length], a row of axes for each particle."""

    kind: Literal["position"] = "position"
    particles: Indices = Field(description="Particles")
    axes: Axes = Field(default="xyz", description="Which coordinates")
    unit: ClassVar[str] = "length"

    def _places(self, found: Equilibrium, pointer: str) -> Ints:
        n = len(found.x)
        if len(self.particles) and self.particles.max() >= n:
            given = int(self.particles.max())
            raise InputError(f"{pointer}/particles", f"particle {given} does not exist; there are {n}, counted from 0")
        return (3 * self.particles[:, None] + np.array([AXES[a] for a in self.axes])).ravel()

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The coordinates."""
        return np.asarray(found.x.ravel()[self._places(found, pointer)])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Ones."""
        places = self._places(found, pointer)
        k = len(places)
        by_place = _matrix(np.arange(k), places, np.ones(k), (k, found.x.size))
        return by_place, _nothing(k, unknowns.count)


class Output(Quantity):
    """A column of what a result reports of a force's elements, such as strain; `equal`: minus the mean of all."""

    kind: Literal["output"] = "output"
    force: StrictStr | StrictInt = Field(description="Name or number of a force")
    column: str = Field(default="", description="Which column of the result")
    elements: Maybe[Indices] = Field(default=None, description="Elements; default: all")
    equal: bool = Field(default=False, description="Values minus their mean, which are 0 if all are equal")

    def _column(self, outputs: dict[str, str], pointer: str) -> str:
        """Which column of the result it is."""
        if self.column not in outputs:
            known = ", ".join(outputs) or "none"
            raise InputError(f"{pointer}/column", f"the result has no column {self.column!r} for it; it has {known}")
        return self.column

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The column."""
        whole = self._whole(found, pointer)
        chosen = whole[self._rows(whole, pointer)]
        return np.asarray(chosen - chosen.mean() if self.equal and len(chosen) else chosen)

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """By differences of what the force measures, with all elements changed at once."""
        by_place, by_unknown = self._whole_slopes(found, unknowns, pointer)
        rows = self._rows(np.zeros(by_place.shape[0]), pointer)
        by_place, by_unknown = by_place[rows], by_unknown[rows]
        if self.equal and len(rows):
            by_place, by_unknown = _less_mean(by_place), _less_mean(by_unknown)
        return by_place, by_unknown

    def _rows(self, whole: Floats, pointer: str) -> Ints:
        if self.elements is None:
            return np.arange(len(whole))
        if len(self.elements) and self.elements.max() >= len(whole):
            said = f"element {int(self.elements.max())} does not exist; there are {len(whole)}, counted from 0"
            raise InputError(f"{pointer}/elements", said)
        return np.asarray(self.elements)

    def _whole(self, found: Equilibrium, pointer: str) -> Floats:
        """Values of all elements."""
        return Measured(found, self.force, pointer).column(self._column)

    def _whole_slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Derivatives of all elements."""
        return Measured(found, self.force, pointer).slopes(self._column, unknowns)


class Force(Output):
    """The force, or else the moment, in elements of a force (tension is positive)."""

    kind: Literal["force"] = "force"
    unit: ClassVar[str] = "force"

    def _column(self, outputs: dict[str, str], pointer: str) -> str:
        found = next((name for name in ("force", "moment") if name in outputs), "")
        return super()._column(outputs, pointer) if self.column or not found else found


class Length(Output):
    """Lengths of the elements of a force between two particles [length]."""

    kind: Literal["length"] = "length"
    unit: ClassVar[str] = "length"

    def _column(self, outputs: dict[str, str], pointer: str) -> str:
        return "length"

    def _ends(self, found: Equilibrium, pointer: str) -> Ints:
        index = Measured(found, self.force, pointer).index
        if index.shape[1] != 2:
            raise InputError(f"{pointer}/force", f"its elements have {index.shape[1]} particles, not 2, and no length")
        return index

    def _whole(self, found: Equilibrium, pointer: str) -> Floats:
        index = self._ends(found, pointer)
        return np.asarray(np.linalg.norm(found.x[index[:, 1]] - found.x[index[:, 0]], axis=1))

    def _whole_slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        index = self._ends(found, pointer)
        along = found.x[index[:, 1]] - found.x[index[:, 0]]
        size = np.linalg.norm(along, axis=1)[:, None]
        along = np.divide(along, size, out=np.zeros_like(along), where=size > 0.0)
        rows = np.repeat(np.arange(len(index)), 6)
        columns = 3 * index[:, :, None] + np.arange(3)
        by_place = _matrix(rows, columns, np.stack([-along, along], axis=1), (len(index), found.x.size))
        return by_place, _nothing(len(index), unknowns.count)


class ForceDensity(Output):
    """Force by length of elements between two particles [force/length]."""

    kind: Literal["force_density"] = "force_density"
    unit: ClassVar[str] = "force/length"

    def _parts(self) -> tuple[Force, Length]:
        return Force(force=self.force), Length(force=self.force)

    def _whole(self, found: Equilibrium, pointer: str) -> Floats:
        force, length = (part._whole(found, pointer) for part in self._parts())
        return np.asarray(force / length)

    def _whole_slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        force, length = (part._whole(found, pointer) for part in self._parts())
        slopes = [part._whole_slopes(found, unknowns, pointer) for part in self._parts()]
        return _combined(slopes, [1.0 / length, -force / length**2])


class LoadPath(Output):
    """The sum of |force| x length over elements between two particles [force length]."""

    kind: Literal["load_path"] = "load_path"
    unit: ClassVar[str] = "force length"

    def _whole(self, found: Equilibrium, pointer: str) -> Floats:
        force, length = Force(force=self.force)._whole(found, pointer), Length(force=self.force)._whole(found, pointer)
        return np.asarray(np.abs(force) * length)

    def _whole_slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        parts = Force(force=self.force), Length(force=self.force)
        force, length = (part._whole(found, pointer) for part in parts)
        slopes = [part._whole_slopes(found, unknowns, pointer) for part in parts]
        return _combined(slopes, [np.sign(force) * length, np.abs(force)])

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The sum."""
        return np.array([super().values(found, pointer).sum()])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Sums of derivatives."""
        by_place, by_unknown = super().slopes(found, unknowns, pointer)
        return _summed(by_place), _summed(by_unknown)


class Reaction(Quantity):
    """Forces of an anchor on its particles [force], along axes; `total`: their sums, `size`: their sizes."""

    kind: Literal["reaction"] = "reaction"
    anchor: StrictStr | StrictInt = Field(description="Name or number of an anchor")
    axes: Axes = Field(default="xyz", description="Which components")
    total: bool = Field(default=False, description="The sum over the particles")
    size: bool = Field(default=False, description="Sizes of the forces along the axes, in the place of components")
    unit: ClassVar[str] = "force"

    def _parts(self, found: Equilibrium, pointer: str) -> tuple[Ints, Floats]:
        """Places (k, axes) among all coordinates, and the forces there."""
        from hookean.running.patch import named

        held = named(found.system.held, self.anchor, f"{pointer}/anchor")
        axes = [AXES[a] for a in self.axes if held.free[AXES[a]] == 0.0]
        if len(axes) < len(self.axes):
            raise InputError(f"{pointer}/axes", "the anchor does not hold its particles along all of these axes")
        forces = -found.system.evaluate(found.state)[0]
        return 3 * held.particles[:, None] + np.array(axes), forces[held.particles][:, axes]

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The forces."""
        _, forces = self._parts(found, pointer)
        forces = forces.sum(axis=0, keepdims=True) if self.total else forces
        return np.asarray(np.linalg.norm(forces, axis=1) if self.size else forces.ravel())

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """From the tangent stiffness and the forces' own derivatives: a reaction is what is out of balance."""
        places, forces = self._parts(found, pointer)
        k, wide = places.shape
        by_place = found.tangent.tocsr()[places.ravel()]
        by_unknown = -unknowns.slopes(found)[0].tocsr()[places.ravel()]
        if self.total:
            sums = _matrix(np.tile(np.arange(wide), k), np.arange(k * wide), np.ones(k * wide), (wide, k * wide))
            by_place, by_unknown, forces, k = sums @ by_place, sums @ by_unknown, forces.sum(axis=0, keepdims=True), 1
        if self.size:
            sizes = np.linalg.norm(forces, axis=1)[:, None]
            along = np.divide(forces, sizes, out=np.zeros_like(forces), where=sizes > 0.0)
            turn = _matrix(np.repeat(np.arange(k), wide), np.arange(k * wide), along, (k, k * wide))
            by_place, by_unknown = turn @ by_place, turn @ by_unknown
        return by_place, by_unknown


class Volume(Quantity):
    """The volume between a mesh of the scene and the origin, by the sides its faces show [length³]: of a closed mesh
    the volume inside."""

    kind: Literal["volume"] = "volume"
    mesh: str = Field(description="Name of a mesh")
    unit: ClassVar[str] = "length^3"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """Sums of a . (b x c) / 6 over triangles."""
        a, b, c = found.x[_triangles(found, self.mesh, pointer)].transpose(1, 0, 2)
        return np.array([np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Cross products of the other corners by 6."""
        corners = _triangles(found, self.mesh, pointer)
        a, b, c = found.x[corners].transpose(1, 0, 2)
        normals = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1) / 6.0
        return _of_corners(found, unknowns, corners, normals)


class Area(Quantity):
    """The area of a mesh of the scene [length²]."""

    kind: Literal["area"] = "area"
    mesh: str = Field(description="Name of a mesh")
    unit: ClassVar[str] = "length^2"

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """The sum over its triangles."""
        a, b, c = found.x[_triangles(found, self.mesh, pointer)].transpose(1, 0, 2)
        return np.array([0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()])

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Half of the opposite side, turned about the normal, at each corner."""
        corners = _triangles(found, self.mesh, pointer)
        a, b, c = found.x[corners].transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        size = np.linalg.norm(normal, axis=1)[:, None]
        normal = np.divide(normal, size, out=np.zeros_like(normal), where=size > 0.0)
        turned = np.stack([np.cross(normal, c - b), np.cross(normal, a - c), np.cross(normal, b - a)], axis=1) / 2.0
        return _of_corners(found, unknowns, corners, turned)


def _triangles(found: Equilibrium, mesh: str, pointer: str) -> Ints:
    """The triangles (m, 3) of a mesh, in particles."""
    system = found.system
    if mesh not in system.scene.meshes:
        known = ", ".join(repr(name) for name in system.scene.meshes) or "none"
        raise InputError(f"{pointer}/mesh", f"mesh {mesh!r} does not exist; the scene has {known}")
    faces = system.places.faces(mesh)
    if (faces < 0).any():
        raise InputError(f"{pointer}/mesh", f"vertices of mesh {mesh!r} meet no particle; let a force act on it")
    both = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    return np.asarray(both[(both[:, 0] != both[:, 1]) & (both[:, 1] != both[:, 2]) & (both[:, 2] != both[:, 0])])


def _of_corners(found: Equilibrium, unknowns: Unknowns, corners: Ints, vectors: Floats) -> Slopes:
    """One row of derivatives from vectors (m, 3, 3) at the corners of triangles."""
    columns = 3 * corners[:, :, None] + np.arange(3)
    row = np.zeros(columns.size, np.int64)
    return _matrix(row, columns, vectors, (1, found.x.size)), _nothing(1, unknowns.count)


def _combined(slopes: list[Slopes], weights: list[Floats]) -> Slopes:
    """Sums of derivatives, the rows of each by weights."""
    from scipy.sparse import diags

    by_place = sum(diags(weight) @ slope[0] for slope, weight in zip(slopes, weights, strict=True))
    by_unknown = sum(diags(weight) @ slope[1] for slope, weight in zip(slopes, weights, strict=True))
    return by_place.tocsr(), by_unknown.tocsr()


def _summed(matrix: Any) -> Any:
    from scipy.sparse import csr_matrix

    return csr_matrix(matrix.sum(axis=0))


def _less_mean(matrix: Any) -> Any:
    """Each row less the mean of all rows."""
    from scipy.sparse import csr_matrix

    return csr_matrix(matrix.toarray() - np.asarray(matrix.mean(axis=0)))


class Measured:
    """What a force's elements report at an equilibrium, and its derivatives by differences."""

    def __init__(self, found: Equilibrium, force: Any, pointer: str) -> None:
        from hookean.designing.unknowns import numbered, placed

        self.found, self.pointer = found, pointer
        system: System = found.system
        self.number = numbered(system.scene, force, f"{pointer}/force")
        self.group: Group
        self.part: Part
        self.group, self.part = placed(system, self.number, f"{pointer}/force")
        self.memory = found.state.memory[system.groups.index(self.group)][self.part.rows]
        self.index = self.group.block.indices[self.part.rows]

    def column(self, choose: Any) -> Floats:
        """The values (m,) of the column that `choose` names."""
        return self._values(self.group.of(self.part), self._chosen(choose))

    def _chosen(self, choose: Any) -> str:
        return str(choose(self.group.cls.outputs, self.pointer))

    def _values(self, block: Block, column: str, x: Floats | None = None, force: Any = None) -> Floats:
        from hookean.system.system import Group

        system, state = self.found.system, self.found.state
        state = state if x is None else replace(state, x=x)
        own = replace(block, memory=self.memory, plan=[])
        forces = system.element_forces(Group(self.group.cls, own, []), state, self.memory)
        found = np.asarray((force or self.part.force).measure(own, state.x, forces)[column])
        if found.ndim != 1:
            raise InputError(self.pointer, f"{column} of {self.group.cls.kind_name} is a vector; goals need numbers")
        return found

    def slopes(self, choose: Any, unknowns: Unknowns) -> Slopes:
        """Derivatives of the column."""
        from hookean.designing.unknowns import Column

        column, (m, arity) = self._chosen(choose), self.index.shape
        group, memory = self.group, self.found.state.memory[self.found.system.groups.index(self.group)]
        if group.cls.gathered(group.block, memory, self.found.x, None) is not None:
            said = f"elements of {group.cls.kind_name} feel one another; {column} cannot be a goal"
            raise InputError(f"{self.pointer}/force", said)
        private = self.found.x[self.index].reshape(-1, 3)
        alone = replace(group.of(self.part), indices=np.arange(m * arity, dtype=np.int64).reshape(m, arity), plan=[])
        reach = np.ptp(self.found.x[self.index], axis=1).max(axis=1) if m else np.zeros(0)
        steps = 1e-6 * np.where(reach > 0.0, reach, 1.0)
        by_corner = np.zeros((m, arity, 3))
        for corner in range(arity):
            for axis in range(3):
                sides = []
                for sign in (1.0, -1.0):
                    moved = private.copy()
                    moved[corner::arity, axis] += sign * steps
                    sides.append(self._values(alone, column, moved))
                by_corner[:, corner, axis] = (sides[0] - sides[1]) / (2.0 * steps)
        places = 3 * self.index[:, :, None] + np.arange(3)
        rows = np.repeat(np.arange(m), 3 * arity)
        by_place = _matrix(rows, places, by_corner, (m, self.found.x.size))
        by_unknown = _nothing(m, unknowns.count)
        for variable, part in zip(unknowns.variables, unknowns.slices, strict=True):
            if isinstance(variable, Column) and variable.number == self.number:
                by_unknown = by_unknown + self._by_column(variable, column, part.start, unknowns.count)
        return by_place, by_unknown

    def _by_column(self, variable: Column, column: str, first: int, count: int) -> Any:
        """Derivatives (m, u) by a column of the force itself."""
        total = _nothing(len(self.index), count)
        give = lambda force, block: self._values(block, column, force=force)  # noqa: E731
        for unknown, slope in variable.differences(self.found.system, give):
            rows = np.flatnonzero(unknown >= 0)
            total = total + _matrix(rows, unknown[rows] + first, slope[rows], total.shape)
        return total


QUANTITIES: dict[str, type[Quantity]] = {
    str(cls.model_fields["kind"].default): cls
    for cls in (Position, Length, Force, ForceDensity, LoadPath, Output, Reaction, Volume, Area)
}
"""All quantities by kind."""
