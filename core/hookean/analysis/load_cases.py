"""Load cases and combinations: the elastic model of a form under each of them, each on its own and from the form."""

from __future__ import annotations

import multiprocessing
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.at_rest import load_numbers
from hookean.analysis.envelope import Envelope, envelope
from hookean.analysis.freezing import Frozen, freeze
from hookean.analysis.load_factors import scaled, warmed
from hookean.analysis.prestressing import prestressed
from hookean.errors import InputError
from hookean.forces import KINDS, Force
from hookean.forces.springs import Springs
from hookean.running.result import Result
from hookean.running.run import relax_state
from hookean.scene.load_cases import IDLE, PERMANENT, PRESTRESS, LoadCase, case_loads, named
from hookean.scene.scene import Scene
from hookean.solvers import solver
from hookean.system.state import State
from hookean.system.system import System, a_scene, compile

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROUNDING = 1e-12  # strain below which a cable is as long as it was made, and not slack


@dataclass(repr=False)
class CaseResult:
    """The elastic model under one load case or combination.

    `factors` [-] on cases, prestress and permanent loads; `result` the shape in equilibrium with its forces and
    reactions; `displacements` (n, 3) [length] from the form; `slack` by the number of a force the elements of it that
    hang slack (tension-only ones shorter than their rest length).
    """

    name: str
    factors: dict[str, float]
    result: Result
    displacements: Floats
    slack: dict[int, Ints] = field(default_factory=dict)

    @property
    def slack_count(self) -> int:
        """How many elements are slack."""
        return sum(len(rows) for rows in self.slack.values())

    def summary(self) -> list[str]:
        """A few lines: factors, status, largest displacement, slack elements, forces, reactions, and what the report
        says."""
        unit, far = self.result.units.length, np.linalg.norm(self.displacements, axis=1)
        moved = f"moved by up to {far.max(initial=0.0):.4g} {unit}, at particle {int(far.argmax()) if len(far) else 0}"
        given = ", ".join(f"{factor:g} x {name}" for name, factor in self.factors.items())
        lines = [f"{given}: {self.result.status}, {self.result.stability}", moved]
        lines += [f"{self.slack_count} elements are slack"] if self.slack_count else []
        return [*lines, *self.result.summary()[1:], *self.result.report.sentences()]

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        return {
            "name": self.name,
            "factors": self.factors,
            "result": self.result.to_dict(),
            "displacements": self.displacements.tolist(),
            "slack": [{"force": number, "elements": rows.tolist()} for number, rows in self.slack.items()],
        }


@dataclass(repr=False)
class LoadCases:
    """A form and its elastic model under load cases and combinations, by their names, with their envelope."""

    frozen: Frozen
    cases: dict[str, CaseResult]

    @property
    def form(self) -> Result:
        """The result of finding the form."""
        assert self.frozen.form is not None
        return self.frozen.form

    @property
    def envelope(self) -> Envelope:
        """The extremes of all cases, and which case has each."""
        shown = {n: (c.result.forces, c.result.reactions, c.displacements) for n, c in self.cases.items()}
        return envelope(shown, self.form.units)

    def summary(self) -> list[str]:
        """Some lines for each case, and the notes on the elastic model."""
        cases = [line for case in self.cases.values() for line in (case.name, *(f"  {s}" for s in case.summary()))]
        return [*cases, *self.frozen.notes]

    def __repr__(self) -> str:
        return "\n".join(["Load cases", *(f"  {line}" for line in self.summary())])

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        return {
            "form": self.form.to_dict(),
            "notes": list(self.frozen.notes),
            "cases": [case.to_dict() for case in self.cases.values()],
            "envelope": self.envelope.to_dict(),
            "units": self.form.units.model_dump(),
        }


def load_cases(
    scene: Scene, names: Sequence[str] | None = None, *, processes: int = 1, executor: Executor | None = None
) -> LoadCases:
    """Find the form of a scene, freeze it, and put the elastic model under its load cases and combinations.

    Each case starts from the form and depends on nothing else: the same bits in any order, and on any executor.

    - `scene`: A scene with `load_cases`, and if wanted `combinations` and `stages`.
    - `names`: Which load cases and combinations; default: all.
    - `processes`: How many of them solve cases side by side; default: one after another. A script that asks for more
      has its own work behind `if __name__ == "__main__":`.
    - `executor`: Where the cases are solved instead, such as an executor that is kept.

    Raises InputError for an unknown name, a scene without load cases, or a form that cannot be frozen.
    """
    chosen = wanted(scene, names)
    if processes < 1:
        raise InputError("processes", f"{processes} given; a whole number from 1 is expected")
    frozen = freeze(scene)
    solve = partial(solve_case, frozen)
    if executor is None and min(processes, len(chosen)) > 1:
        new = multiprocessing.get_context("spawn")  # others would inherit locks of threads that they do not have
        with ProcessPoolExecutor(min(processes, len(chosen)), mp_context=new) as pool:
            found = list(pool.map(solve, chosen))
    else:
        found = list((map if executor is None else executor.map)(solve, chosen))
    return LoadCases(frozen, dict(zip(chosen, found, strict=True)))


def of_case(model: Any, case: str | None) -> Any:
    """A scene in equilibrium in one of its load cases or combinations, a result; without a case what is given."""
    if case is None:
        return model
    if not isinstance(model, Scene):
        raise InputError("case", f"{case!r} given with a {type(model).__name__}; give the scene that has this case")
    return load_cases(model, wanted(model, [case], "case")).cases[case].result


def wanted(scene: Scene, names: Sequence[str] | None, pointer: str = "cases") -> list[str]:
    """The names of all load cases and combinations of a scene, or those given, at `pointer`; InputError if the scene
    has none."""
    scene = a_scene(scene)
    if not scene.load_cases and not scene.combinations:
        said = 'the scene has none; add them, as in "load_cases": {"snow": {"forces": ["snow load"]}}'
        raise InputError("/load_cases", said)
    known = [*scene.load_cases, *scene.combinations]
    given = [names] if isinstance(names, str) else known if names is None else names
    if not len(given):
        raise InputError(pointer, f"none given; give some of {', '.join(known)}, or leave it out for all")
    for name in given:
        if name not in known:
            raise InputError(pointer, f"{name!r} is not a load case or combination; the scene has {', '.join(known)}")
    return list(dict.fromkeys(given))


def factors(scene: Scene, name: str) -> dict[str, float]:
    """The factors of a load case or combination on cases, prestress and permanent loads."""
    if name in scene.load_cases:
        return {name: 1.0}
    return dict(scene.combinations[name])


def case_scene(frozen: Frozen, name: str) -> Scene:
    """The elastic scene of one load case or combination: its loads times their factors, other cases' loads idle."""
    given = factors(frozen.scene, name)
    scene = prestressed(frozen, given.get(PRESTRESS, 1.0))
    later, acting = case_loads(scene), dict[int, float]()
    for case, factor in given.items():
        if case in (PRESTRESS, PERMANENT):
            continue
        for number in sorted({i for load in scene.load_cases[case].forces for i in named(scene, load)}):
            acting[number] = acting.get(number, 0.0) + factor * scene.load_cases[case].factor
    forces = list(scene.forces)
    for i, degrees in _temperatures(frozen, given).items():
        forces[i] = warmed(forces[i], frozen.expansions[i], degrees, frozen.temperatures.get(i, 0.0))
    for i, force in enumerate(forces):
        if i in later and i not in acting:
            forces[i] = force.replaced(name=IDLE)
        elif KINDS[force.kind_name].role == "load":
            forces[i] = scaled(force, acting[i] if i in acting else given.get(PERMANENT, 1.0))
    idle = {IDLE: LoadCase(forces=(IDLE,))} if any(i not in acting for i in later) else {}
    return scene.replaced(forces=tuple(forces), load_cases=idle, combinations={}, stages=None)


def _temperatures(frozen: Frozen, given: Mapping[str, float]) -> dict[int, float]:
    """Changes of temperature [K] by the numbers of forces; InputError where a force has no thermal expansion."""
    found = dict[int, float]()
    form = frozen.form
    drawn = (
        frozen.scene if form is None or form.scene is None else form.scene
    )  # its forces have the kinds that are named
    for name, factor in given.items():
        if name not in frozen.scene.load_cases:
            continue
        case = frozen.scene.load_cases[name]
        for line, degrees in case.temperature.items():
            for number in named(drawn, line):
                if number not in frozen.expansions:
                    said = f"{line} has no thermal expansion; give it, or freeze it to, a material that has one"
                    raise InputError(f"/load_cases/{name}/temperature/{line}", said)
                found[number] = found.get(number, 0.0) + factor * case.factor * degrees
    return found


def growing(scene: Scene, loads: Sequence[str] | None, case: str | None) -> tuple[System, State, tuple[int, ...]]:
    """What analyses of growing loads begin with: a system, its state, and the numbers of the loads that grow. With a
    load case or combination it is the elastic model of that case, in the form, under its loads times their factors.

    Raises InputError for loads or a case that is not there, and for loads of cases without a case.
    """
    if case is None:
        system = compile(scene)
        return system, system.start(), load_numbers(scene, loads)
    (name,) = wanted(scene, case, "case")
    frozen = freeze(scene)
    own = case_scene(frozen, name)
    return *frozen.system(own), load_numbers(own, loads)


def solve_case(frozen: Frozen, name: str) -> CaseResult:
    """The elastic model under one load case or combination, from the form."""
    scene = case_scene(frozen, name)
    system, state = frozen.system(scene)
    result = relax_state(system, state, solver(scene.settings.solver), near=True)
    for i, force in enumerate(frozen.scene.forces):
        result.forces[i]["name"] = force.name  # idle loads have another one meanwhile
    rows = {i: slack_elements(force, result.forces[i]) for i, force in enumerate(scene.forces)}
    slack = {i: some for i, some in rows.items() if len(some)}
    given = factors(frozen.scene, name)
    return CaseResult(name, given, result, result.particles - frozen.particles, slack)


def slack_elements(force: Force, columns: Mapping[str, Any]) -> Ints:
    """The elements of a force that hang slack: springs shorter than their lower cutoff, or than their rest length if
    they are `tension_only`. `columns` of its result."""
    if not isinstance(force, Springs) or "length" not in columns:
        return np.zeros(0, np.int64)
    length, lower = np.asarray(columns["length"]), np.asarray(force.lower_cutoff)
    short = np.asarray(columns["strain"]) < -ROUNDING if force.tension_only else False
    return np.flatnonzero(((lower > 0.0) & (length < lower)) | short)
