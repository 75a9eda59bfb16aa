"""Welding: coordinates become particles. Deterministic; the first point at a place wins."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, cached_property
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic.fields import FieldInfo

from hookean.errors import InputError
from hookean.forces import Block, Force
from hookean.forces.base import PLACES, lengths
from hookean.scene.report import Missed, Report, Unmatched
from hookean.scene.scene import Scene
from hookean.values import materials, near
from hookean.values.columns import Labels, Points, Vector, Vectors
from hookean.values.materials import Material
from hookean.values.mesh import Mesh
from hookean.values.sections import Section
from hookean.values.units import Units

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

NEARER = 0.01  # part of a distance that does not count


class Welded:
    """All particles of a scene and, for each force, anchor and geometry, which of them it means.

    Given particles come first, unmerged; then the coordinates of internal forces in order of first appearance.
    Loads, hinges, bends, anchors and geometry create none: their coordinates must meet a particle within the
    tolerance.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.report = Report()
        self.tolerance = scene.weld_tolerance
        self.take_materials(scene)
        self._patched: dict[int, Force] = {}  # rows are found by identity, so these must live as long as they do
        self._rows: dict[int, Ints] = {}
        self._lost: set[str] = set()  # pointers of points that met no particle
        self._meshes: dict[str, Ints] = {}
        self._families: dict[str, tuple[Ints, Ints]] = {}  # warp and weft of meshes
        self._warps: list[tuple[Ints, Ints]] = []  # faces, and edges along their warp
        self._edges: dict[tuple[str, str], Ints] = {}
        self._pointer: dict[int, str] = {id(f): f"/forces/{i}" for i, f in enumerate(scene.forces)}
        self._weld()

    def _weld(self) -> None:
        """Create particles: one list of candidates in order of appearance, then one pass of welding."""
        given = self.scene.particles
        candidates: list[Floats] = []
        owners: list[tuple[str, Any, tuple[int, ...]]] = []

        def add(kind: str, key: Any, points: Floats) -> None:
            candidates.append(points.reshape(-1, 3))
            owners.append((kind, key, points.shape[:-1]))

        for force in self.scene.forces:
            if not force.creates:
                continue
            fields = vars(force)  # asking a model for what it has not takes long
            for name in ("points", "lines"):
                points = fields.get(name)
                if points is not None:
                    add("force", id(force), points)
            mesh = fields.get("mesh")
            if mesh is not None and not any(o[:2] == ("mesh", mesh) for o in owners):
                add("mesh", mesh, self.scene.meshes[mesh].vertices)
        points = np.concatenate(candidates) if candidates else np.zeros((0, 3))
        self.x, which = weld(given, points, self.tolerance)
        self.report.merged = len(given) + len(points) - len(self.x)
        if self.report.merged:
            moved = np.abs(points - self.x[which]) > 0.01 * self.tolerance  # less is rounding
            self.report.beside = int(np.count_nonzero(moved.any(axis=1)))
        start = 0
        for kind, key, shape in owners:
            stop = start + int(np.prod(shape))
            (self._rows if kind == "force" else self._meshes)[key] = which[start:stop].reshape(shape)
            start = stop

    def elements(self, force: Force) -> Ints:
        """Particles of every element of `force`, `(m, arity)`; -1 where a load or anchor met none."""
        arity = force.element_arity
        pointer = self._pointer.get(id(force), "/settings/floor")
        fields = vars(force)
        particles = fields.get("particles")
        if particles is not None:
            rows: Ints = particles.reshape(-1, 1) if arity == 1 and particles.ndim == 1 else particles
            if not particles.size:
                return np.zeros((0, arity), np.int64)
            if rows.ndim != 2 or rows.shape[1] != arity:
                raise InputError(
                    f"{pointer}/particles",
                    f"shape {list(particles.shape)} given; each element needs {arity} particle{'s' * (arity > 1)}",
                )
            return rows
        for name in ("points", "lines"):
            points = fields.get(name)
            if points is not None:
                if id(force) not in self._rows:
                    self._rows[id(force)] = self.meet(points)
                rows = self._rows[id(force)]
                flat = rows.reshape(len(points), -1) if len(points) else np.zeros((0, arity), np.int64)
                return self._checked(flat, arity, f"{pointer}/{name}")
        mesh = fields.get("mesh")
        if mesh is not None:
            return self._of_mesh(force, mesh, arity)
        return np.arange(len(self.x)).reshape(-1, 1)

    def recompile(self, number: int, force: Force) -> Block:
        """The block of a changed force that stays where force `number` of the scene was."""
        first = self.scene.forces[number]
        if number in self._patched and self._patched[number] is not first:
            gone = id(self._patched[number])
            self._rows.pop(gone, None)
            self._pointer.pop(gone, None)
        self._patched[number] = force
        self._pointer[id(force)] = f"/forces/{number}"
        if id(first) in self._rows:
            self._rows[id(force)] = self._rows[id(first)]
        return self.block(force, f"/forces/{number}")

    def block(self, force: Force, pointer: str) -> Block:
        """A force compiled to arrays; InputError at its pointer or a place in the scene where it does not fit."""
        fits(force, pointer, self)
        try:
            return force.compile(self)
        except InputError as error:
            if error.pointer:
                raise
            raise InputError(pointer, error.sentence) from None  # of the force as a whole

    def _checked(self, rows: Ints, arity: int, pointer: str) -> Ints:
        if rows.shape[1] != arity and len(rows):
            raise InputError(pointer, f"{rows.shape[1]} points in an element given; each needs {arity}")
        return np.ascontiguousarray(rows.reshape(-1, arity))

    def _of_mesh(self, force: Force, mesh: str, arity: int) -> Ints:
        """Vertices of a mesh, or the edges that `force.edges` names."""
        if arity == 1:
            return self.vertices(mesh).reshape(-1, 1)
        choice = str(getattr(force, "edges", "all"))
        if (mesh, choice) not in self._edges:
            self._edges[mesh, choice] = self._edges_of(mesh, choice)
        return self._edges[mesh, choice]

    def _edges_of(self, mesh: str, choice: str) -> Ints:
        from hookean.discretize import meshes, warpweft

        vertices, data = self.vertices(mesh), self.scene.meshes[mesh]
        # edges of the welded mesh: vertices that became one particle share their edges
        _, first, which_one = np.unique(vertices, return_index=True, return_inverse=True)
        own = first[which_one]
        plain = Mesh(data.vertices, own[data.faces] if len(data.faces) else data.faces)
        which, _, pattern = choice.partition("_")
        if which in ("warp", "weft"):
            if mesh not in self._families:
                alike = len(first) == len(vertices)  # no two vertices became one
                self._families[mesh] = data.families if alike else warpweft.warp_weft(plain)
            pairs = self._families[mesh][which == "weft"]
        elif which == "diagonals":
            pairs = meshes.diagonals(plain, pattern or "both")
        else:
            pairs = {"all": meshes.edges, "naked": meshes.naked_edges}[which](plain)
        return np.ascontiguousarray(vertices[np.asarray(pairs, dtype=np.int64).reshape(-1, 2)])

    def vertices(self, mesh: str) -> Ints:
        """Particles of a mesh's vertices `(n,)`; -1 where one met none."""
        if mesh not in self._meshes:
            self._meshes[mesh] = self.meet(self.scene.meshes[mesh].vertices)
        return self._meshes[mesh]

    def faces(self, name: str) -> Ints:
        """Faces `(m, 4)` of the scene's mesh `name`, in particles; a triangle repeats its last corner."""
        return np.ascontiguousarray(self.vertices(name)[self.scene.meshes[name].faces])

    def warp(self, faces: Ints) -> Ints:
        """Edges (k, 2) of quads (m, 4) that run along the warp, found once for each mesh."""
        for known, warp in self._warps:
            if np.array_equal(known, faces):
                return warp
        from hookean.discretize.warpweft import warp_weft

        points = np.zeros((int(faces.max(initial=-1)) + 1, 3))  # only which faces share an edge counts
        advice = "give the membrane a warp; nets, shells and soap films need none"
        self._warps.append((faces.copy(), warp_weft(Mesh(points, faces), advice=advice)[0]))
        return self._warps[-1][1]

    def geometry(self, name: str) -> tuple[Floats, Ints]:
        """Vertices (n, 3) and faces (m, 4) of the scene's mesh `name`, as drawn; InputError if there is none."""
        if name not in self.scene.meshes:
            known = ", ".join(repr(n) for n in self.scene.meshes) or "none"
            raise InputError("/meshes", f"mesh {name!r} does not exist; the scene has {known}")
        return self.scene.meshes[name].vertices, self.scene.meshes[name].faces

    def take_materials(self, scene: Scene) -> None:
        """Have the materials and sections of a scene, as a patch has changed them."""
        self.materials, self.sections = scene.materials, scene.sections

    @property
    def units(self) -> Units:
        """Units of the scene."""
        return self.scene.units

    def material(self, name: str) -> Material:
        """The scene's material of this name, or a known one in its units; InputError if there is none."""
        return materials.find(name, self.materials, self.units)

    def section(self, name: str) -> Section:
        """The scene's section of this name; InputError if there is none."""
        if name not in self.sections:
            known = ", ".join(repr(n) for n in self.sections) or "none"
            raise InputError("/sections", f"section {name!r} does not exist; the scene has {known}")
        return self.sections[name]

    def meet(self, points: Floats) -> Ints:
        """The particle of each point: the first within the tolerance, as welding has it; -1 where there is none."""
        found = near.first(self.x, points.reshape(-1, 3), self.tolerance)
        return np.ascontiguousarray(found.reshape(points.shape[:-1]))

    def check_place(self, force: Force, pointer: str) -> None:
        """Report what of a load that does not act yet has met no particle."""
        if force.element_arity < 3 and vars(force).get("mesh") is None:
            self.elements(force)
        self.check_force(force, pointer)

    def check_force(self, force: Force, pointer: str) -> None:
        """Report the points, lines or vertices of a force that met no particle."""
        kinds: tuple[tuple[str, Literal["point", "line"]], ...] = (("points", "point"), ("lines", "line"))
        for name, what in kinds:
            points = vars(force).get(name)
            if points is not None and id(force) in self._rows:
                self.check(f"{pointer}/{name}", force.name, points, self._rows[id(force)], what, force.role)
                if not force.creates:
                    self.check_nearest(f"{pointer}/{name}", points, self._rows[id(force)])
        mesh = vars(force).get("mesh")
        if mesh is not None and (self.vertices(mesh) < 0).any():
            data, found = self.scene.meshes[mesh], self.vertices(mesh)
            used = np.arange(len(found)) if force.element_arity == 1 else np.unique(data.faces)
            at = [f"/meshes/{mesh}/vertices/{v}" for v in used]
            self.check(f"{pointer}/mesh", force.name, data.vertices[used], found[used], "vertex", force.role, at)

    def check(
        self,
        pointer: str,
        name: str,
        points: Floats,
        found: Ints,
        what: Literal["point", "line", "vertex"],
        role: str,
        at: Sequence[str] = (),
    ) -> None:
        """Report which of the `points` of a force or anchor met no particle: where `found` is -1.

        `at` are the pointers of the points, where these are not below `pointer`.
        """
        lost = found < 0
        if not lost.any():
            return
        distance, nearest = (column.ravel() for column in self._tree.query(points[lost], k=1))
        spots = [tuple(row) for row in points[lost].tolist()]
        least = int(np.argmin(distance))
        counts = int(np.count_nonzero(lost.reshape(len(lost), -1).any(axis=1))), len(lost)
        unit = self.scene.units.length
        self.report.missed.append(
            Missed(pointer, name, role, what, *counts, spots[least], float(distance[least]), unit)
        )
        for place, spot, i, away in zip(np.argwhere(lost).tolist(), spots, nearest, distance, strict=True):
            where = at[place[0]] if at else "/".join([pointer, *map(str, place)])
            if where not in self._lost:  # two forces may name the same mesh
                self._lost.add(where)
                self.report.unmatched.append(Unmatched(where, name, spot, int(i), float(away)))

    def check_nearest(self, pointer: str, points: Floats, found: Ints) -> None:
        """Report points that met the first particle within the tolerance, as welding has it, beside a nearer one."""
        spots, rows = points.reshape(-1, 3), found.ravel()
        met = np.flatnonzero(rows >= 0)
        away = np.zeros(len(rows))
        away[met] = lengths(spots[met] - self.x[rows[met]])
        apart = np.flatnonzero(away > NEARER * self.tolerance)
        if not len(apart):
            return
        distance, nearest = (column.ravel() for column in self._tree.query(spots[apart], k=1))
        nearer = np.flatnonzero(distance < (1.0 - NEARER) * away[apart])
        if len(nearer):
            i, unit = nearer[0], self.scene.units.length
            one = apart[i]
            self.report.warnings.append(
                f"{pointer}: {len(nearer)} of {len(spots)} points met a particle although another is nearer (first: "
                f"point {one} met particle {rows[one]}, {away[one]:.3g} {unit} away, and particle {nearest[i]} is "
                f"{distance[i]:.3g} {unit} away); lower weld_tolerance"
            )

    @cached_property
    def _tree(self) -> Any:
        return near.tree(self.x)


def weld(given: Floats, points: Floats, tolerance: float) -> tuple[Floats, Ints]:
    """Merge `points` `(m, 3)` into `given` `(n, 3)` and each other within `tolerance`; the first wins.

    Returns the particles (`given` first and unmerged) and, for each point, its particle.
    """
    count = len(given)
    if not len(points):
        return np.array(given, dtype=np.float64).reshape(-1, 3), np.zeros(0, np.int64)
    # equal coordinates first, in one sort; then only true near misses are looked at one by one
    unique, first, inverse = _distinct(points + 0.0)
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    merged = np.concatenate([given.reshape(-1, 3), unique[order]])
    keeper = np.arange(len(merged))
    met = near.first(merged[:count], merged[count:], tolerance)
    alone = count + np.flatnonzero(met < 0)
    keeper[count:][met >= 0] = met[met >= 0]
    keeper[alone] = alone[keepers(merged[alone], tolerance)]
    kept = keeper == np.arange(len(merged))
    number = np.cumsum(kept) - 1
    return np.ascontiguousarray(merged[kept]), number[keeper][count + rank[inverse]]


def _distinct(points: Floats) -> tuple[Floats, Ints, Ints]:
    """Distinct rows (k, 3), where each is first, and which of them each row is; as `np.unique`, in half the time."""
    order = np.lexsort(points.T)
    ordered = points[order]
    x, y, z = (ordered[1:] != ordered[:-1]).T
    new = np.concatenate([[True], x | y | z])
    which = np.empty(len(points), np.int64)
    which[order] = np.cumsum(new) - 1
    return ordered[new], order[new], which


def _bound(tolerance: float) -> float:
    """A little more than the tolerance, also squared: what is farther need not be looked for."""
    return max(tolerance * 1.001, 1e-150)


def keepers(points: Floats, tolerance: float) -> Ints:
    """For each of some distinct points the one it becomes: itself, or the first kept point within the tolerance.

    Kept points are farther apart than the tolerance, so that few of them are near any one point.
    """
    keeper = np.arange(len(points))
    if not len(points):
        return keeper
    tree = near.tree(points)
    near_one = tree.query(points, k=2, distance_upper_bound=_bound(tolerance))[0][:, 1] <= tolerance
    for a in np.flatnonzero(near_one):
        if keeper[a] != a:
            continue
        for b in tree.query_ball_point(points[a], tolerance):
            if b > a and keeper[b] == b:
                keeper[b] = a
    return keeper


def fits(force: Force, pointer: str, welded: Welded) -> None:
    """InputError where a column of `force` has neither one value nor one for each of its elements."""
    columns = element_columns(type(force))
    if not columns or (force.element_arity > 2 and getattr(force, "mesh", None) is not None):
        return
    count, given = len(welded.elements(force)), vars(force)
    for name, vector in [column for column in columns if isinstance(given[column[0]], np.ndarray)]:
        value = given[name]
        if len(value) != count and not (vector and value.shape == (3,)):
            allowed = "one for each" if _is_a(type(force), name, _EACH) else "one value or one for each"
            raise InputError(f"{pointer}/{name}", f"{len(value)} values for {count} elements; give {allowed}")


@cache
def element_columns(cls: type[Force]) -> list[tuple[str, bool]]:
    """Fields of a force that may have one value for each element, and whether three numbers are one value; none of a
    force without elements."""
    fields = cls.model_fields
    if not any(name in fields for name in PLACES):
        return []
    return [(n, takes_a_vector(cls, n)) for n in fields if n not in PLACES and n not in cls.shared]


def takes_a_vector(cls: type[Force], field: str) -> bool:
    """Whether a column's type is `Vector` or `Vectors`, so that three numbers are one value."""
    return _is_a(cls, field, _ONE_VECTOR)


def _is_a(cls: type[Force], field: str, kinds: tuple[Any, ...]) -> bool:
    """Whether a column's type has one of these validators."""
    column: FieldInfo = cls.model_fields[field]
    marks = [*column.metadata, *(mark for option in get_args(column.annotation) for mark in get_args(option)[1:])]
    return any(mark is kind for mark in marks for kind in kinds)


_EACH = (get_args(Labels)[1], get_args(Points)[1])  # of columns that have no one value for all
_ONE_VECTOR = (get_args(Vector)[1], get_args(Vectors)[1])
