"""What other programs take of a result: points, lines with their forces, faces, supports, loads and reactions."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hookean.files.exchange.beams import Beams
from hookean.files.exchange.sheets import Sheet, sheets
from hookean.forces import elastic
from hookean.forces.base import complete
from hookean.forces.beam import Beam
from hookean.forces.membrane import Membrane
from hookean.forces.soapfilm import halves
from hookean.forces.springs import Springs
from hookean.forces.support import Support
from hookean.running.result import Result
from hookean.running.utilisation import NAME, dimensions
from hookean.system.system import System, compile
from hookean.values.materials import Material
from hookean.values.sections import Section
from hookean.values.units import Units

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Lines:
    """The elements of one force along lines: `pairs` (m, 2) of particles, `columns` of numbers (m,) by name, with the
    `dimensions` of these, and of springs `axial_stiffness` EA (m,) [force] and `rest_length` (m,) [length], 0 where
    an element has none; `one_way`: whether they go slack, `compression` or `tension` or, beyond a length, `other`;
    `area` [length^2] of the section and the name of the `material`, where they are known; `made_of`, the names of
    material and section that the force is given by, empty for none."""

    name: str
    kind: str
    pairs: Ints
    columns: dict[str, Floats]
    dimensions: dict[str, str]
    axial_stiffness: Floats
    rest_length: Floats
    one_way: str
    area: float | None = None
    material: str | None = None
    made_of: tuple[str, str] = ("", "")

    @property
    def force(self) -> Floats:
        """The force in each element (m,) [force], tension +; 0 where it has none."""
        return self.columns.get("force", np.zeros(len(self.pairs)))


@dataclass(frozen=True)
class Structure:
    """A result for other programs. All of `points` (n, 3) [length], `displacements` (n, 3) [length] from the start,
    `loads` and `reactions` (n, 3) [force], `moments` and `reaction_moments` (n, 3) [force length] of both, `held`
    (n, 3) axes, `clamped` (n, 3) rotations about axes, `elastic` (n, 6) the stiffness of elastic supports along and
    about axes [force/length, force length]; `faces` (m, 4) of meshes by name, in particles; `beams` of each force that
    has some; `others` are the names of forces between particles that are neither; `cloth` has the stresses of membranes
    by the name of their mesh, of each of its faces (see `_cloth`); `sheets` are membranes with their shells,
    `materials` those that are used, and `sections`; `touching` is how many particles lie on floors."""

    points: Floats
    displacements: Floats
    lines: tuple[Lines, ...]
    faces: dict[str, Ints]
    held: NDArray[np.bool_]
    clamped: NDArray[np.bool_]
    loads: Floats
    moments: Floats
    reactions: Floats
    reaction_moments: Floats
    units: Units
    beams: tuple[Beams, ...] = ()
    others: tuple[str, ...] = ()
    elastic: Floats = field(default_factory=lambda: np.zeros((0, 6)))
    cloth: dict[str, dict[str, Floats]] = field(default_factory=dict)
    sheets: tuple[Sheet, ...] = ()
    materials: dict[str, Material] = field(default_factory=dict)
    sections: dict[str, Section] = field(default_factory=dict)
    touching: int = 0

    @classmethod
    def of(cls, result: Result, system: System | None = None) -> Structure:
        """The structure of a result, and of its compiled scene if that is at hand."""
        assert result.scene is not None
        system = system or compile(result.scene)
        state = system.start()
        system.slots.put(state, result.particles, result.rotations["quaternions"])
        count = system.slots.count
        reactions, held = np.zeros((2, count, 3)), np.asarray(result.reactions["particles"], dtype=np.int64)
        reactions[0, held] = np.asarray(result.reactions["force"]).reshape(-1, 3)
        if len(system.slots.particles):
            reactions[1, held] = result.reactions["moment"]
        clamped = np.zeros((count, 3), dtype=bool)
        clamped[system.slots.particles] = state.free[system.slots.first] == 0
        faces = {name: system.places.faces(name) for name in system.scene.meshes}
        loads = system.evaluate(state, only="load")[0]
        moments = np.zeros((count, 3))
        moments[system.slots.particles] = system.slots.moments(loads, system.slots.particles)
        cloth, written = sheets(system)
        lines = tuple(_lines(system, result))
        used = {line.material for line in lines} | {sheet.material for sheet in cloth}
        return cls(
            state.x[:count],
            (state.x - system.x)[:count],
            lines,
            {name: found[(found >= 0).all(axis=1)] for name, found in faces.items()},
            state.free[:count] == 0,
            clamped,
            loads[:count],
            moments,
            reactions[0],
            reactions[1],
            result.units,
            tuple(
                Beams.of(force, np.asarray(entry["particles"]), system)
                for force, entry in zip(system.scene.forces, result.forces, strict=True)
                if isinstance(force, Beam) and np.size(entry.get("particles", ()))
            ),
            tuple(_others(result, written)),
            _elastic(result, count),
            _cloth(system, result),
            tuple(cloth),
            {name: system.places.material(name) for name in sorted(filter(None, used))},
            {name: system.places.section(name) for name in sorted(filter(None, (line.made_of[1] for line in lines)))},
            len(result.contacts["particles"]),
        )

    @property
    def supported(self) -> Ints:
        """Particles that are held, or that an elastic support carries."""
        return np.flatnonzero((self.held | self.clamped).any(axis=1) | self.elastic.any(axis=1))

    @property
    def started(self) -> bool:
        """Whether Abaqus files have the points of the start, where beams and shells lie without stress."""
        return bool(self.beams) or any(sheet.bends for sheet in self.sheets)

    @property
    def start(self) -> Floats:
        """Where the points were at the start (n, 3) [length]."""
        return self.points - self.displacements

    @property
    def pairs(self) -> Ints:
        """The pairs (m, 2) of all lines."""
        return np.concatenate([np.zeros((0, 2), np.int64), *(group.pairs for group in self.lines)])


def _lines(system: System, result: Result) -> list[Lines]:
    found, axial = [], _axial(system)
    for number, (force, entry) in enumerate(zip(system.scene.forces, result.forces, strict=True)):
        pairs = np.asarray(entry.get("particles", ()))
        if type(force).role != "internal" or pairs.ndim != 2 or pairs.shape[1] != 2:
            continue
        known = dimensions(force.kind_name)
        columns = {n: np.asarray(entry[n], dtype=float) for n in known if np.ndim(entry.get(n, 0.0)) == 1}
        stiffness, rest = axial.get(number, (np.zeros(len(pairs)), np.zeros(len(pairs))))
        name = force.name or force.kind_name
        free = _one_way(force, rest) if isinstance(force, Springs) else ""
        section, material = getattr(force, "section", None), getattr(force, "material", None)
        area = elastic.area(force, system.places) if section is not None and number in axial else None
        made = material if area is not None else None
        of = (material or "", section or "")
        found.append(Lines(name, force.kind_name, pairs, columns, known, stiffness, rest, free, area, made, of))
    return found


def _elastic(result: Result, count: int) -> Floats:
    """The stiffness (count, 6) of elastic supports along and about the axes of space."""
    assert result.scene is not None
    found = np.zeros((count, 6))
    for force, entry in zip(result.scene.forces, result.forces, strict=True):
        if isinstance(force, Support) and "particles" in entry:
            at = np.asarray(entry["particles"]).reshape(-1)
            for first, given in ((0, force.stiffness), (3, force.rotation_stiffness)):
                np.add.at(found[:, first : first + 3], at, np.broadcast_to(given, (len(at), 3)))
    return found


def _cloth(system: System, result: Result) -> dict[str, dict[str, Floats]]:
    """Columns of membranes, with their units, by mesh and face: of a quad the mean of its triangles, the largest and
    least stress and the utilisation of any, and the loosest state."""
    found: dict[str, dict[str, Floats]] = {}
    for force, entry in zip(system.scene.forces, result.forces, strict=True):
        if not isinstance(force, Membrane) or "particles" not in entry:
            continue
        faces = system.places.faces(force.mesh)
        _, share, face = halves(complete(faces))
        own: dict[str, Floats] = {}
        for name, dimension in dimensions(force.kind_name).items():
            if name not in entry:
                continue
            values, size = np.asarray(entry[name], dtype=float), int(face.max(initial=-1)) + 1
            if name in ("least", "state"):
                column = np.full(size, np.inf)
                np.minimum.at(column, face, values)
            elif name in ("largest", NAME):
                column = np.full(size, -np.inf)
                np.maximum.at(column, face, values)
            else:
                column = np.bincount(face, values * share, size) / np.bincount(face, share, size)
            own[f"{force.kind_name} {name} [{system.scene.units.of(dimension) or '-'}]"] = column
        found.setdefault(force.mesh, own)
    return found


def _one_way(force: Springs, rest: Floats) -> str:
    """How springs go slack: below a cutoff that is the rest length, in `compression`."""
    low, high = np.asarray(force.lower_cutoff), np.asarray(force.upper_cutoff)
    if force.tension_only or force.compression_only:
        other = high if force.tension_only else low
        return "other" if other.any() else "compression" if force.tension_only else "tension"
    if not (low.any() or high.any()):
        return ""
    same = np.size(low) in (1, len(rest)) and bool((np.abs(low - rest) <= 1e-12 * rest).all())
    return "compression" if same and not high.any() else "other"


def _others(result: Result, written: set[int]) -> list[str]:
    """The names of forces that are neither loads nor along lines, nor those of these numbers."""
    assert result.scene is not None
    found = []
    for number, (force, entry) in enumerate(zip(result.scene.forces, result.forces, strict=True)):
        pairs = np.asarray(entry.get("particles", ()))
        role, here = type(force).role, number in written or isinstance(force, Support)
        if not here and (role == "support" or (role == "internal" and pairs.shape[1:] != (2,))):
            found.append(force.name or force.kind_name)
    return found


def _axial(system: System) -> dict[int, tuple[Floats, Floats]]:
    """EA (m,) [force] of the elements of springs, k L0 however they are given, and L0 (m,) [length], by the number of
    their force."""
    found = {}
    for group in system.groups:
        if group.cls is not Springs:
            continue
        for part in group.parts:
            p = group.block.parameters[part.rows]
            rest = p[:, 2] * p[:, 3] + group.block.memory[part.rows, 0]
            found[part.number] = (p[:, 0] * rest, rest)
    return found


def plain_names(names: list[str], longest: int = 80) -> list[str]:
    """Names of letters, digits and underscores that begin with a letter, each once."""
    found: list[str] = []
    for name in names:
        plain = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_") or "group"
        plain = (plain if plain[0].isalpha() else f"G_{plain}")[: longest - 4].upper()
        several = sum(other == plain or other.startswith(f"{plain}_") for other in found)
        found.append(plain if plain not in found else f"{plain}_{several + 1}")
    return found
