"""Result: what a person gets back. Every array in the scene's units, failure a value with a sentence."""

from __future__ import annotations

import os
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces import KINDS
from hookean.forces.base import Rider
from hookean.running.loads import applied
from hookean.running.utilisation import NAME, STRESS, dimensions, stress, utilisation
from hookean.scene.load_cases import asleep
from hookean.scene.report import Report
from hookean.scene.scene import Scene
from hookean.stability.equilibrium import Equilibrium, Stability, unknown
from hookean.system.balance import LOADED, OUT, Balance
from hookean.system.state import State
from hookean.system.system import System
from hookean.values import html
from hookean.values.units import Units

if TYPE_CHECKING:
    from hookean.pictures.picture import Picture

Floats = NDArray[np.float64]

SMALL = (600, 450)  # pixels of the picture beside a summary
ROUNDING = 1e-14  # part of the largest value of a column that a summary shows as 0


class Status(StrEnum):
    """How a run stands or ended."""

    RUNNING = "running"
    CONVERGED = "converged"
    STALLED = "stalled"
    DIVERGED = "diverged"
    MAX_ITERATIONS = "max_iterations"
    TIME_LIMIT = "time_limit"
    CANCELLED = "cancelled"


@dataclass(repr=False)
class Result:
    """A shape and what holds it, of a `scene`. Notebooks show its summary and a picture.

    `particles` (n, 3) [length]; `forces` one dict of columns for each force of the scene (springs: length, force,
    strain), `reactions` the particles of anchors and elastic supports, the force (k, 3) [force] that these put on them,
    and whether an anchor holds them (`exact`); `contacts` the same for floors. Reactions + contacts + loads = 0,
    except for loads along soap films.
    `loads` has for each load of the scene its `name`, `kind` and number (`force`), the `resultant` (k, 3) [force], the
    `centre` (k, 3) [length], through which the resultant of parallel forces goes, and the `moment` (k, 3) about it
    [force length]. `rotations`: which `particles` have one (ends of beams), and the unit `quaternions` (r, 4) w, x, y,
    z that turn them from the start; reactions have the `moment` (k, 3) [force length] there, no rows where no particle
    has a rotation. `energy` by kind and in total [force length].
    """

    status: Status
    message: str
    particles: Floats
    geometry: list[dict[str, Any]]
    forces: list[dict[str, Any]]
    reactions: dict[str, Any]
    rotations: dict[str, Any]
    contacts: dict[str, Any]
    loads: dict[str, Any]
    components: dict[str, Any]
    residual: float
    rounding_floor: float
    out_of_balance: float
    stability: Stability
    stability_reason: str
    soft_particle: int | None
    soft_modes: int | None
    position_error: float | None
    position_reason: str
    energy: dict[str, float]
    iterations: int
    time: float
    solver: str
    report: Report
    units: Units = field(default_factory=Units)
    scene: Scene | None = field(default=None, repr=False)

    @property
    def converged(self) -> bool:
        """Whether the shape is in equilibrium within the tolerance, or as near as float64 allows."""
        return self.status is Status.CONVERGED

    def take_shape(self, system: System, state: State) -> None:
        """Take the positions and orientations of a state, which stays as it is."""
        folded = state.copy()
        system.slots.fold(folded)
        self.particles = folded.x[: system.slots.count].copy()
        self.rotations["quaternions"] = system.slots.quaternions(folded.x)

    def force(self, name: str) -> dict[str, Any]:
        """The columns of the first force of this name or kind; KeyError, with what there is, if there is none."""
        for columns in self.forces:
            if name in (columns["name"], columns["kind"]):
                return columns
        known = ", ".join(repr(columns["name"] or columns["kind"]) for columns in self.forces) or "none"
        raise KeyError(f"no force is called {name!r}; there are {known}")

    def summary(self) -> list[str]:
        """A few lines for a person: how many particles, the range of every column of force, the reactions."""
        lines = [f"{len(self.particles)} particles"]
        for entry in self.forces:
            title = f"{entry['name']} ({entry['kind']})" if entry["name"] else entry["kind"]
            said = [self._range(entry, c) for c in ("force", "moment", "warp", "weft") if np.size(entry.get(c, ()))]
            if not said:
                continue
            line = f"{title}: {len(entry['particles'])} elements, {', '.join(said if 'warp' in entry else said[:1])}"
            ends = [np.abs(entry[c]).max() for c in ("My0", "Mz0", "My1", "Mz1") if np.size(entry.get(c, ()))]
            line += f", moments up to {max(ends):.4g} {self.units.of('moment')}" if ends else ""
            used = f", utilisation up to {100.0 * np.max(entry[NAME]):.4g} %" if np.size(entry.get(NAME, ())) else ""
            lines.append(line + used)
        for title, found in (("reactions", self.reactions), ("contacts with floors", self.contacts)):
            if len(rows := np.asarray(found["force"]).reshape(-1, 3)):
                largest, together, unit = np.linalg.norm(rows, axis=1).max(), rows.sum(axis=0), self.units.force
                total = ", ".join(f"{c:.4g}" for c in np.where(np.abs(together) > 1e-9 * largest, together, 0.0))
                lines.append(f"{len(rows)} {title}: largest {largest:.4g} {unit}, together ({total}) {unit}")
        if self.scene is not None and (idle := asleep(self.scene)):
            lines.append(f"without {', '.join(idle)}, of load cases")
        return lines

    def _range(self, entry: dict[str, Any], column: str) -> str:
        """The smallest and the largest value of a column."""
        values = np.asarray(entry[column])
        sizes = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
        sizes = np.where(np.abs(sizes) > ROUNDING * np.abs(sizes).max(), sizes, 0.0)
        unit = self.units.of(KINDS[entry["kind"]].outputs[column])
        return f"{column} {sizes.min():.4g} to {sizes.max():.4g} {unit}"

    def __repr__(self) -> str:
        return "\n".join([f"Result: {self.status}. {self.message}", *(f"  {line}" for line in self.summary())])

    def _repr_html_(self) -> str:
        title, *lines = repr(self).splitlines()
        return html.summary(title, lines, self.plot(size=SMALL).png)

    def plot(
        self,
        *,
        title: str = "",
        size: tuple[int, int] = (1200, 900),
        view: str | tuple[float, float] | None = None,
    ) -> Picture:
        """A picture of the result, as `render` draws it, for a notebook or `save`. `view` is front, right, top,
        isometric or the two angles (azimuth, elevation) of the eye [degrees]. Raises InputError where the view or size
        makes no sense."""
        import hookean

        return hookean.picture(self, title=title, size=size, view=view)

    def table(self, name: str) -> list[dict[str, Any]]:
        """A row for each element of the first force of this name or kind: its particles, then its columns, with their
        units in their names; vectors are three columns. `pandas.DataFrame` and `polars.DataFrame` take the rows.
        Raises InputError, with the forces there are, if no force is called this."""
        try:
            entry = self.force(name)
        except KeyError as error:
            raise InputError("name", str(error.args[0])) from None
        columns: dict[str, Any] = {}
        particles = np.asarray(entry.get("particles", ())).reshape(-1, max(1, np.shape(entry.get("particles", ()))[-1]))
        for corner in range(particles.shape[1]):
            columns["particle" if particles.shape[1] == 1 else f"particle {corner + 1}"] = particles[:, corner]
        for column, dimension in dimensions(entry["kind"]).items():
            unit = self.units.of(dimension) if dimension else "-"
            if column in entry or column in KINDS[entry["kind"]].outputs:
                columns.update(_named(column, unit, np.asarray(entry.get(column, ()))))
        rows = zip(*(values.tolist() for values in columns.values()), strict=True)
        return [dict(zip(columns, row, strict=True)) for row in rows]

    def save(self, path: str | os.PathLike[str]) -> list[str]:
        """Write the result to a .3dm, .json, .obj, .csv or .png file, by the ending of `path`; sentences on what the
        file does not hold. Raises InputError for another ending, or where the file cannot be written."""
        import hookean

        return hookean.save(self, path)

    def to_dict(self) -> dict[str, Any]:
        """The result as plain lists and numbers, by the names of the HTTP answer."""
        report = {
            "merged": self.report.merged,
            "unmatched": [
                {
                    "pointer": u.pointer,
                    "name": u.name,
                    "point": list(u.point),
                    "nearest": u.nearest if u.nearest >= 0 else None,
                    "distance": u.distance if u.nearest >= 0 else None,
                    "message": u.sentence,
                }
                for u in self.report.unmatched
            ],
            "missed": [{**asdict(m), "point": list(m.point), "message": m.warning} for m in self.report.missed],
            "warnings": list(self.report.warnings),
        }
        return {
            "status": str(self.status),
            "message": self.message,
            "particles": self.particles.tolist(),
            "geometry": plain(self.geometry),
            "forces": plain(self.forces),
            "reactions": plain(self.reactions),
            "rotations": plain(self.rotations),
            "contacts": plain(self.contacts),
            "loads": plain(self.loads),
            "components": {**plain(self.components), "position_error": _known(self.components["position_error"])},
            "residual": self.residual,
            "rounding_floor": self.rounding_floor,
            "out_of_balance": self.out_of_balance,
            "stability": str(self.stability),
            "stability_reason": self.stability_reason,
            "soft_particle": self.soft_particle,
            "soft_modes": self.soft_modes,
            "position_error": self.position_error,
            "position_reason": self.position_reason,
            "energy": self.energy,
            "iterations": self.iterations,
            "time": self.time,
            "solver": self.solver,
            "report": report,
            "units": self.units.model_dump(),
        }


def _named(column: str, unit: str, values: Any) -> dict[str, Any]:
    """A column by its name and unit; one of vectors as three."""
    if values.ndim == 2:
        return {f"{column} {axis} [{unit}]": values[:, i] for i, axis in enumerate("xyz")}
    return {f"{column} [{unit}]": values}


def _known(values: Floats) -> list[float | None]:
    """Numbers, None where one is not known."""
    return [None if np.isnan(value) else float(value) for value in values]


def plain(value: Any) -> Any:
    """Arrays as lists, all the way down."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, dict):
        return {k: plain(v) for k, v in value.items()}
    return [plain(v) for v in value] if isinstance(value, list | tuple) else value


def gather(
    system: System,
    state: State,
    found: Balance,
    rest: Equilibrium | None,
    status: Status,
    message: str,
    solver: str,
    *,
    moving: bool,
) -> Result:
    """Collect a result from a state, its balance and, of a shape at rest, what is known of that."""
    report = system.report
    rest = rest or unknown("the shape is not at rest")
    energy: dict[str, float] = {}
    for group, value in zip(system.groups, found.energies, strict=True):
        kind = group.cls.kind_name
        energy[kind] = energy.get(kind, 0.0) + float(value)
    energy["kinetic"] = kinetic(system, state) if moving else 0.0
    energy["total"] = sum(energy.values())
    memories = zip(system.groups, state.memory, strict=True)
    acting = [system.element_forces(group, state, memory) for group, memory in memories]
    forces = _measures(system, state, acting)
    return Result(
        status=status,
        message=message,
        particles=state.x[: system.slots.count].copy(),
        geometry=carried(system, state),
        forces=forces,
        reactions=_reactions(system, state, found, forces),
        rotations={"particles": system.slots.particles.copy(), "quaternions": system.slots.quaternions(state.x)},
        contacts=_contacts(found),
        loads=applied(system, state, acting),
        components=_components(found, rest),
        residual=found.residual,
        rounding_floor=found.floor,
        out_of_balance=found.out_of_balance,
        stability=rest.stability,
        stability_reason=rest.stability_reason,
        soft_particle=None if rest.soft_particle is None else system.slots.owner(rest.soft_particle),
        soft_modes=rest.soft_modes,
        position_error=rest.position_error,
        position_reason=rest.position_reason,
        energy=energy,
        iterations=state.iteration,
        time=state.time,
        solver=solver,
        report=Report(report.merged, [*report.unmatched], [*report.warnings], report.beside, report.missed),
        units=system.scene.units,
        scene=system.scene,
    )


def kinetic(system: System, state: State) -> float:
    """Kinetic energy [force length] of what is free to move."""
    # no product of matrices: its threads would take longer to start than it takes
    return 0.5 * float(np.einsum("i,i->", system.mass, np.einsum("ij,ij->i", state.v * state.v, state.free)))


def carried(system: System, state: State) -> list[dict[str, Any]]:
    """The scene's geometry where its particles are now; points that ride on none stay."""
    moved = []
    for item, particles in zip(system.scene.geometry, system.carried, strict=True):
        if item.mesh is not None:
            start = system.scene.meshes[item.mesh].vertices
        elif item.particles is not None:
            start = system.x[item.particles]
        else:
            start = np.asarray(item.points if item.points is not None else item.lines).reshape(-1, 3)
        points = np.where((particles >= 0)[:, None], state.x[np.maximum(particles, 0)], start)
        entry: dict[str, Any] = {"name": item.name, "kind": item.kind}
        if item.kind == "mesh":
            entry.update(vertices=points, faces=system.scene.meshes[str(item.mesh)].faces)
        elif item.kind == "lines":
            entry.update(lines=points.reshape(-1, 2, 3))
        else:
            entry.update(points=points)
            if item.kind == "curve":
                entry.update(degree=item.degree, knots=item.knots, weights=item.weights)
        moved.append(entry)
    return moved


def _measures(system: System, state: State, acting: list[Floats]) -> list[dict[str, Any]]:
    """Columns of every force of the scene, in its order, by the element forces of every group; a floor has none."""
    entries: list[dict[str, Any]] = [{"kind": f.kind_name, "name": f.name} for f in system.scene.forces]
    for group, memory, forces in zip(system.groups, state.memory, acting, strict=True):
        for part in group.parts:
            block = group.of(part)
            block.memory = memory[part.rows]
            if issubclass(group.cls, Rider):
                _ridden(entries[part.number], group.cls.measured(block, state.x, forces[part.rows]), part.inputs)
                continue
            columns = part.force.measure(block, state.x, forces[part.rows])
            entries[part.number].update(particles=group.particles[part.rows], **columns)
            for name, rule in ((STRESS, stress), (NAME, utilisation)):
                found = rule(part.force, system.places, columns)
                if found is not None:
                    entries[part.number][name] = found
    return entries


def _ridden(entry: dict[str, Any], columns: dict[str, Floats], inputs: NDArray[np.int64]) -> None:
    """Put what a rider has of some elements of a force into its columns."""
    for name, values in columns.items():
        entry[name][inputs] = values


def _reactions(system: System, state: State, found: Balance, forces: list[dict[str, Any]]) -> dict[str, Any]:
    """What anchors and elastic supports put on particles, a row for each of these."""
    held = held_particles(system, state)
    elastic = [
        (np.asarray(entry["particles"]).reshape(-1), entry)
        for force, entry in zip(system.scene.forces, forces, strict=True)
        if force.bearing and "particles" in entry
    ]
    rows = np.unique(np.concatenate([held, *(particles for particles, _ in elastic)])) if elastic else held
    names = dict.fromkeys(rows.tolist(), "")
    for particles, entry in elastic:
        names.update(dict.fromkeys(particles.tolist(), entry["name"]))
    # what holds axes names a reaction before what holds rotations alone; else the last one
    for anchor in sorted(system.held, key=lambda anchor: anchor.some):
        names.update(dict.fromkeys(anchor.particles.tolist(), anchor.name))
    exact = np.isin(rows, held) if elastic else np.ones(len(held), dtype=bool)
    force, moment = found.reactions.take(rows, axis=0), system.slots.moments(found.reactions, rows)
    if elastic:
        force[~exact] = 0.0
        moment[~exact[: len(moment)]] = 0.0
    for particles, entry in elastic:
        at = np.searchsorted(rows, particles)
        np.add.at(force, at, entry["force"])
        if "moment" in entry and len(moment):
            np.add.at(moment, at, entry["moment"])
    return {
        "particles": rows,
        "force": force,
        "names": [names[p] for p in rows.tolist()],
        "moment": moment,
        "exact": exact.tolist(),
    }


def held_particles(system: System, state: State) -> NDArray[np.int64]:
    """Particles that are held on some axis, or whose rotations are, in their order."""
    held, slots = _any(state.free == 0), system.slots
    if len(slots):
        held[slots.particles] |= held[slots.first]
    return held[: slots.count].nonzero()[0]


COMPONENTS = (
    "first_particle", "particles", "supported", "loaded", "force_scale", "out_of_balance", "residual",
    "rounding_floor", "position_error",
)  # fmt: skip


def _components(found: Balance, rest: Equilibrium) -> dict[str, Any]:
    """Columns of the connected components, where there is more than one that something acts on."""
    parts, loaded = found.components, found.found[:, LOADED] > 0.0
    acting = np.flatnonzero(parts.joined | loaded) if len(parts.first) > 1 else parts.first
    if len(acting) < 2:
        return dict.fromkeys(COMPONENTS, np.zeros(0))
    counts = np.bincount(parts.label[parts.label >= 0], minlength=len(parts.first))
    errors = rest.position_errors if rest.position_errors is not None else np.full(len(parts.first), np.nan)
    columns = (
        parts.first, counts, parts.supported | (len(found.planes) > 0), loaded, found.scales, found.found[:, OUT],
        found.residuals, found.floors, errors,
    )  # fmt: skip
    return {name: column[acting] for name, column in zip(COMPONENTS, columns, strict=True)}


def _contacts(found: Balance) -> dict[str, Any]:
    touching = np.flatnonzero(_any(found.contact != 0)) if len(found.planes) else np.zeros(0, np.int64)  # never slots
    return {"particles": touching, "force": found.contact[touching]}


def _any(rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which rows (n, 3) have something."""
    x, y, z = rows.T
    return np.asarray(x | y | z)
