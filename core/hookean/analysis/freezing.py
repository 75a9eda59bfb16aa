"""Freezing: a form that was found becomes an elastic model that is in equilibrium where it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.at_rest import AtRest
from hookean.analysis.frozen_films import balanced, frozen_film
from hookean.analysis.matrices import Unknowns, against_turns, factor
from hookean.errors import InputError
from hookean.forces import Block, Force, base, elastic, groups
from hookean.forces.base import Places
from hookean.forces.membrane import Membrane
from hookean.forces.self_weight import SelfWeight
from hookean.forces.sliding_cable import SlidingCable, taut
from hookean.forces.soapfilm import SoapFilm
from hookean.forces.springs import Springs
from hookean.linear.film_tangent import patterned
from hookean.linear.pattern import Pattern
from hookean.running.result import Result, Status, gather
from hookean.running.run import relax_state
from hookean.running.utilisation import breaking_force
from hookean.scene.load_cases import HEATED, ElasticLine, Stages, named
from hookean.scene.scene import Scene
from hookean.solvers import solver
from hookean.stability.equilibrium import assess
from hookean.system.balance import balance
from hookean.system.group import Part
from hookean.system.state import State
from hookean.system.system import System, a_scene, compile

Floats = NDArray[np.float64]

STEPS = 12  # of Newton's method that take a form to rounding
SETTLED = 1e-9  # part of the forces and of the size that counts as none
HEAVY = 0.03  # part of a weight by which that of the form may differ, as stretched cloth does
SEVERAL = (
    "/forces/{}: {} has several cables, which keep their tension where a factor acts on the prestress; give each cable"
    " a force of its own"
)
ELASTIC = ("anchor_spring", "bend", "gas", "hinge", "membrane", "beam", "power_law", "shell", "springs", "volume")
"""Internal forces and supports that stay as they are, besides those that `FREEZERS` turns into others."""


@dataclass(frozen=True)
class Line:
    """An element line of a form, to be frozen: the force that it is of, where that is in the scene, the lengths and
    tensions (m,) of its elements there, the rows of its block, and what it is to become."""

    force: Force
    pointer: str
    length: Floats
    tension: Floats
    block: Block
    wanted: ElasticLine

    @property
    def axial_stiffness(self) -> Floats:
        """EA [force], one or one for each element."""
        return np.asarray(self.wanted.axial_stiffness, dtype=np.float64)


@dataclass(frozen=True)
class Frozen:
    """An elastic model that is in equilibrium in a form.

    `scene` has the elastic elements; it keeps the start shape, meshes and load cases of the scene it comes from.
    `particles` (n, 3) [length] is the form, and `form` the result of finding it. `notes` are sentences on forces that
    stay as they were although they are not elastic, and on films. `lengths` and `tensions` (m,) are those of the
    elastic lines in the form, by the number of their force; `cloth` (m, 3) [force/length] are the stresses of triangles
    of membranes there, and `slides` the length and the strain of a sliding cable; `expansions` [1/K] are known of lines
    of a material, and `temperatures` [K], one or one for each element, of those that have one in the form; `rotations`
    (r, 4) are the unit quaternions w, x, y, z of the ends of beams.
    """

    scene: Scene
    particles: Floats
    form: Result | None = None
    notes: tuple[str, ...] = ()
    lengths: dict[int, Floats] = field(default_factory=dict)
    tensions: dict[int, Floats] = field(default_factory=dict)
    cloth: dict[int, Floats] = field(default_factory=dict)
    slides: dict[int, tuple[float, float]] = field(default_factory=dict)
    expansions: dict[int, float] = field(default_factory=dict)
    temperatures: dict[int, Floats] = field(default_factory=dict)
    rotations: Floats = field(default_factory=lambda: np.zeros((0, 4)))

    def system(self, scene: Scene | None = None) -> tuple[System, State]:
        """The elastic model compiled, and its state in the form."""
        system = compile(scene or self.scene)
        state = system.start()
        system.slots.put(state, self.particles, self.rotations)
        return system, state


def freeze(scene: Scene) -> Frozen:
    """Find the form of a scene and freeze it: elastic elements whose unstressed lengths give that very state.

    Loads of load cases do not act. The form is taken to rounding by Newton steps, so that the frozen model does not
    move. Springs keep stiffness and rest length, or take EA (`Scene.stages`): L0 = l EA / (EA + T), k = EA / L0, with
    the length l and the tension T of the form. Lines of constant tension and springs without a rest length need EA.
    Films become cloth (`Stages.films`) of the shape and stress of the form. Bending, hinges, shells and supports stay
    as they are; so do other forces, with a note.

    Raises InputError where no form is found, EA is missing, or an element pushes harder than its EA.
    Source: Schek, The force density method for form finding, 1974; Barnes, Form finding and analysis of tension
    structures by dynamic relaxation, 1999.
    """
    stages = a_scene(scene).stages or Stages()
    system, state, form = _form(scene, stages)
    notes = list[str]()
    if system.films is not None:
        system, state, notes = _clothed(system, state, stages)
        scene = system.scene
    forces = list(scene.forces)
    lengths: dict[int, Floats] = {}
    tensions: dict[int, Floats] = {}
    expansions: dict[int, float] = {}
    temperatures: dict[int, Floats] = {}
    cloth: dict[int, Floats] = {}
    slides: dict[int, tuple[float, float]] = {}
    for group, memory in zip(system.groups, state.memory, strict=True):
        element_forces = system.element_forces(group, state, memory) if group.cls.role == "internal" else None
        for part in group.parts:
            force = scene.forces[part.number] if part.number >= 0 else None
            if force is None or group.cls.role == "load":
                continue
            block = group.of(part)
            block.memory = memory[part.rows]
            if issubclass(group.cls, Membrane):
                cloth[part.number] = Membrane.second(block, state.x)
            if group.cls is SlidingCable:
                if (slide := taut(block, state.x)) is not None:
                    slides[part.number] = slide
                elif len(np.unique(groups.heads(block))) > 1:
                    notes.append(SEVERAL.format(part.number, force.name or force.kind_name))
            if group.cls.kind_name in FREEZERS and element_forces is not None:
                columns = part.force.measure(block, state.x, element_forces[part.rows])
                line = _line(system, stages, part, block, columns)
                forces[part.number] = FREEZERS[group.cls.kind_name](line)
                lengths[part.number], tensions[part.number] = line.length, line.tension
                if (expansion := _expansion(line, system.places)) is not None:
                    expansions[part.number] = expansion
                if (own := getattr(part.force, "temperature", None)) is not None:
                    temperatures[part.number] = np.asarray(own, dtype=np.float64)
            elif group.cls.kind_name in HEATED and (known := _own_expansion(part.force, system.places)) is not None:
                expansions[part.number] = known
            elif group.cls.role == "internal" and group.cls is not SlidingCable and group.cls.kind_name not in ELASTIC:
                name = force.name or force.kind_name
                notes.append(f"/forces/{part.number}: {name} is not elastic and acts on the frozen model as before")
    notes += _heavy(system, state)
    frozen = scene.replaced(forces=tuple(forces))
    turned = system.slots.quaternions(state.x)
    found = state.x[: system.slots.count].copy()
    model = Frozen(
        frozen, found, form, tuple(notes), lengths, tensions, cloth, slides, expansions, temperatures, turned
    )
    other = compile(frozen)
    if not np.array_equal(other.x, system.x):
        raise InputError("/forces", "the frozen model has other particles than the form; name particles by index")
    return model


def _heavy(system: System, state: State) -> list[str]:
    """Notes on weights that count the start shape, where the form is longer or larger or smaller."""
    notes, unit = list[str](), system.scene.units.force
    for number, force in enumerate(system.scene.forces):
        if not isinstance(force, SelfWeight) or (there := force.weight_at(system.places, state.x)) is None:
            continue
        start = force.weight_at(system.places, system.x) or 0.0
        if abs(start - there) > HEAVY * abs(there):
            name, other = force.name or force.kind_name, "line_weight" if force.element_arity == 2 else "area_weight"
            said = f"is the weight of the start shape, {start:.4g} {unit}"
            notes.append(f"/forces/{number}: {name} {said}; the form weighs {there:.4g} {unit}, which {other} gives")
    return notes


def _clothed(system: System, state: State, stages: Stages) -> tuple[System, State, list[str]]:
    """A form whose films are cloth that is at rest: its system and state, and notes."""
    scene = system.scene
    forces, films = list(scene.forces), list[int]()
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls is not SoapFilm:
            continue
        pulls = system.element_forces(group, state, memory)
        for part in group.parts:
            forces[part.number] = frozen_film(system, stages, part, state.x, pulls[part.rows])
            films.append(part.number)
    done = None if scene.stages is None else scene.stages.replaced(films={})
    cloth, notes = balanced(scene.replaced(forces=tuple(forces), stages=done), films, state)
    other = compile(cloth)
    there = other.start()
    there.x, there.free = state.x.copy(), state.free
    kept = {part.number: own[part.rows] for g, own in zip(system.groups, state.memory, strict=True) for part in g.parts}
    for group, own in zip(other.groups, there.memory, strict=True):
        for part in group.parts:
            if part.number not in films:
                own[part.rows] = kept[part.number]
    sharpen(other, there)
    if not balance(other, there).still(SETTLED):
        raise InputError(
            "/forces", "the cloth of a film is not at rest in the form; hold its edges or add cables there"
        )
    count = system.slots.count
    moved = float(base.lengths(there.x - state.x)[:count].max(initial=0.0))
    if moved > SETTLED * float(np.linalg.norm(np.ptp(state.x[:count], axis=0))):
        unit = scene.units.length
        notes.append(f"the form moved by up to {moved:.2g} {unit} to where the cloth is at rest")
    return other, there, notes


def _form(scene: Scene, stages: Stages) -> tuple[System, State, Result]:
    """The form of a scene: its system, its state and its result."""
    system = compile(scene)
    state = system.start()
    if stages.form == "drawn":
        found = balance(system, state)
        said = "The form is the start shape."
        return system, state, gather(system, state, found, None, Status.CONVERGED, said, "none", moving=False)
    method = solver(scene.settings.solver)
    result = relax_state(system, state, method)
    if not result.converged:
        raise InputError("model", f"no form was found: {result.message}")
    sharpen(system, state, method.pattern)
    found = balance(system, state)
    rest = assess(system, state, found)
    form = gather(system, state, found, rest, result.status, result.message, result.solver, moving=False)
    return system, state, form


def sharpen(system: System, state: State, known: Pattern | None = None) -> None:
    """Take a shape at rest to rounding by Newton steps, as long as they bring it nearer; `known` is the pattern of its
    tangent, if there is one."""
    if system.no_tangent() or system.contacts:
        return
    rest = AtRest.checked(system, state, True, "")
    unknowns = Unknowns.of(system, state, rest.free)
    plain = unknowns.sparse and system.films is None and not len(system.slots)
    pattern = patterned(system, state, rest.free, known) if plain else None  # worked out once for all steps
    left = system.evaluate(state)[0] * rest.free
    for _ in range(STEPS):
        if pattern is not None:
            found = pattern.factors.factor(pattern.tangent(system, state))
        else:
            found = factor(against_turns(unknowns.tangent(system, state), unknowns.dofs, system.slots.count)[0])
        if found is None or not left.any():
            return
        before = state.x
        state.x = before + unknowns.spread(found.solve(unknowns.gather(left)))
        after = system.evaluate(state)[0] * rest.free
        if not np.isfinite(after).all() or np.abs(after).max() >= np.abs(left).max():
            state.x = before
            return
        left = after


def _line(system: System, stages: Stages, part: Part, block: Block, columns: dict[str, Floats]) -> Line:
    wanted = ElasticLine()
    for name, given in stages.freeze.items():
        if part.number in named(system.scene, name):
            wanted = given
    wanted = _filled(wanted, part.force, system.places, f"/forces/{part.number}")
    return Line(part.force, f"/forces/{part.number}", columns["length"], columns["force"], block, wanted)


def _filled(wanted: ElasticLine, force: Force, places: Places, pointer: str) -> ElasticLine:
    """What a force is to become, with the EA and the breaking force of its material and section."""
    try:
        if wanted.material is not None:
            wanted = wanted.replaced(
                axial_stiffness=elastic.axial_stiffness(wanted, places),
                strength=breaking_force(wanted, places),
            )
        elif isinstance(force, Springs):
            section = wanted.section or force.section
            cut = force.replaced(section=section)
            strength = breaking_force(cut, places) if wanted.strength is None else wanted.strength
            wanted = wanted.replaced(section=section, strength=strength)
    except InputError as error:
        raise InputError(pointer, error.sentence) from None
    return wanted


def _expansion(line: Line, places: Places) -> float | None:
    """Thermal expansion [1/K] of a line, of the material that it becomes or has; None where it has none."""
    if line.wanted.material is not None:
        return places.material(line.wanted.material).expansion
    return _own_expansion(line.force, places)


def _own_expansion(force: Force, places: Places) -> float | None:
    material = getattr(force, "material", None)
    return None if material is None else places.material(material).expansion


def _place(force: Force) -> dict[str, object]:
    """The fields that say where a force along lines is."""
    found = {n: getattr(force, n) for n in ("particles", "lines", "mesh") if getattr(force, n, None) is not None}
    if getattr(force, "mesh", None) is not None:
        found["edges"] = getattr(force, "edges", "all")
    return found


def frozen_springs(line: Line) -> Force:
    """Springs with the rest lengths that they have now, or with EA and those that keep their tension."""
    p = line.block.parameters
    rest = p[:, 2] * p[:, 3] + line.block.memory[:, 0]
    if line.wanted.axial_stiffness is None:
        if (rest <= 0.0).any():
            raise _missing(line, "have no rest length")
        stiffness = p[:, 0]
    else:
        stiffness, rest = cut_to(line.axial_stiffness, line.length, line.tension, line.pointer, rest)
    own, high, low = line.force, np.maximum(p[:, 4], 0.0), np.maximum(p[:, 5], 0.0)
    assert isinstance(own, Springs)
    lower = np.maximum(low, rest) if line.wanted.tension_only and not own.tension_only else low
    return Springs(
        name=line.force.name,
        **_place(line.force),  # type: ignore[arg-type]
        stiffness=stiffness,
        damping=p[:, 1],
        rest_length=rest,
        upper_cutoff=high,
        lower_cutoff=lower,
        tension_only=own.tension_only,
        compression_only=own.compression_only,
        yield_extension=p[:, 6],
        section=line.wanted.section,
        strength=line.wanted.strength,
    )


def frozen_tension(line: Line) -> Force:
    """Lines of constant tension as springs with EA."""
    if line.wanted.axial_stiffness is None:
        raise _missing(line, "keep their tension at any length")
    stiffness, rest = cut_to(line.axial_stiffness, line.length, line.tension, line.pointer)
    lower = rest if line.wanted.tension_only else 0.0
    return Springs(
        name=line.force.name,
        **_place(line.force),  # type: ignore[arg-type]
        stiffness=stiffness,
        rest_length=rest,
        lower_cutoff=lower,
        section=line.wanted.section,
        strength=line.wanted.strength,
    )


def cut_to(
    given: Floats, length: Floats, tension: Floats, pointer: str, slack: Floats | None = None
) -> tuple[Floats, Floats]:
    """Stiffness [force/length] and rest length [length] of elements of EA (one, or m) [force] with a tension (m,) at
    their length (m,). Those without a tension have the rest length `slack` (m,), where that is given and not 0: they
    hang slack, or have a gap to close, and keep it."""
    count = len(tension)
    if given.ndim and len(given) != count:
        said = f"{len(given)} values of axial_stiffness for {count} elements; give one value or one for each"
        raise InputError(pointer, said)
    ea = np.broadcast_to(given, (count,))
    if (ea + tension <= 0.0).any():
        spot = int(np.argmax(ea + tension <= 0.0))
        said = f"element {spot} pushes with {-tension[spot]:.4g}, more than its axial stiffness {ea[spot]:.4g}"
        raise InputError(pointer, f"{said}; give a larger one")
    rest = length * ea / (ea + tension)
    if slack is not None:
        rest = np.where((tension == 0.0) & (slack > 0.0), slack, rest)
    if (rest <= 0.0).any():
        spot = int(np.argmin(rest))
        raise InputError(pointer, f"element {spot} has zero length in the form; move its ends apart")
    return ea / rest, rest


def _missing(line: Line, why: str) -> InputError:
    name = line.force.name or line.force.kind_name
    example = f'"stages": {{"freeze": {{"{name}": {{"axial_stiffness": 1e5}}}}}}'
    said = f"elements of {name} {why}; give their EA, as in {example}"
    return InputError(line.pointer, said)


FREEZERS: dict[str, Callable[[Line], Force]] = {"springs": frozen_springs, "constant_tension": frozen_tension}
"""By the kind of a force: what makes it elastic."""
