"""Relax a file into a file: what the command line and the service share.

All files that `readers` reads: `.3dm` files by a recipe or by convention (see `recipe.recipe`), OBJ, scenes and COMPAS
documents in JSON, saved simulations. A .3dm file written for anything but a drawing holds the scene, too.
"""

from __future__ import annotations

import contextlib
import json
import math
import re
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hookean.atomic_write import check_target, put
from hookean.errors import InputError
from hookean.files import embedded, obj, tables
from hookean.files import limits as limit_file
from hookean.files.exchange.write import EXCHANGED, ending_of, exchange
from hookean.files.readers import Recipe, Source, about, read_path
from hookean.running.claims import document_text
from hookean.scene.scene import Scene

if TYPE_CHECKING:
    from hookean.files.recipe.build import Built
    from hookean.running.result import Result
    from hookean.system.system import System

WRITTEN = (".3dm", ".json", ".obj", ".dxf", ".vtu", ".inp", ".ifc")
"""Endings of files that results are written to."""
TOO_LONG = 10.0  # times the rest length; rubber tears before
Progress = Callable[[int, float], None]


@dataclass(eq=False)
class FileResult:
    """A relaxed file. `result` in the scene's units; `understood` lines on how the file was read; `rows` one for each
    element and reaction (see `tables.rows`); `objects` sums for each object; `ids` of the objects written to a .3dm
    file; `warnings` for a person, `unwritten` those on results that could not be written; `exceeded` a sentence for
    each limit that does not hold; `moved` how far a particle went from where it was drawn, at most."""

    result: Result
    scene: Scene
    understood: list[str]
    rows: list[dict[str, Any]]
    objects: list[dict[str, Any]]
    ids: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    exceeded: list[str] = field(default_factory=list)
    moved: float = 0.0
    unwritten: list[str] = field(default_factory=list)

    @property
    def csv(self) -> str:
        """The rows as CSV text."""
        return tables.csv_text(self.rows)

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain lists and numbers: the report."""
        plain: dict[str, Any] = {
            "result": self.result.to_dict(),
            "digest": self.scene.digest,
            "understood": self.understood,
            "objects": self.objects,
            "rows": self.rows,
            "ids": self.ids,
            "warnings": self.warnings,
            "exceeded": self.exceeded,
        }
        return {key: _finite(value) for key, value in plain.items()}


class LimitsError(InputError):
    """Limits that could never be exceeded, found out after the file was relaxed and written: `found`."""

    def __init__(self, error: InputError, found: FileResult) -> None:
        super().__init__(error.pointer, error.sentence)
        self.found = found


def read_scene(source: Path, recipe: Path | None = None) -> Scene:
    """The scene a file holds (see `readers`): a .3dm by its recipe or by convention. Raises InputError as
    `relax_file`."""
    text = None if recipe is None else recipe.read_text(encoding="utf-8")
    return open_file(source, text, "" if recipe is None else recipe.name).scene


def explain_file(source: Path, recipe_text: str | None = None, *, recipe_name: str = "") -> list[str]:
    """How a file would be read, in lines for a person; nothing is solved.

    Raises InputError as `relax_file`, but where the file can be read and its scene not be solved: the last line then
    has the error.
    """
    lines, fault = explained(source, recipe_text, recipe_name)
    return lines if fault is None else [*lines, str(fault)]


def explained(
    source: Path, recipe_text: str | None = None, recipe_name: str = ""
) -> tuple[list[str], InputError | None]:
    """How a file would be read, with what a person should know of its scene, and the error if that cannot be solved."""
    from hookean.system.system import compile

    read = read_path(source, _recipe(recipe_text, recipe_name))
    if read.nothing:
        return read.lines, None
    try:
        with about(recipe_name if recipe_text is not None else source.name):
            report = compile(read.scene).report
    except InputError as error:
        return read.lines, error
    return [*read.lines, *report.left_out(), *report.warnings], None


def relax_file(
    source: Path,
    target: Path | None = None,
    recipe_text: str | None = None,
    *,
    recipe_name: str = "",
    limits: Mapping[str, Any] | None = None,
    limits_name: str = "limits",
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
    reading: contextlib.AbstractContextManager[None] | None = None,
    seconds: float | None = None,
    case: str | None = None,
) -> FileResult:
    """Relax what `source` holds and write it to `target` (None: nowhere), replaced in one step or not at all.

    A saved simulation goes on from the shape that it has. A .3dm target is a copy of a .3dm source with results below
    the layer `hookean`, or a new file; a .json target is the result (of a COMPAS Mesh or Graph that document with its
    new shape), an .obj target the shape alone. A shape short of equilibrium is written too, a cancelled one is not.
    `limits` as `limits.read_limits` gives them; pointers into the recipe stand behind `recipe_name`. The source is
    never written. `reading` is entered while the source is read. A solve longer than `seconds` ends with the status
    `time_limit`. With a `case` the form is found and frozen, and the result is that of the load case or combination of
    this name; displacements are those from the form.

    Raises InputError: the file cannot be read, the recipe does not fit it, the target cannot be written; LimitsError,
    with everything written, where limits name what the file does not have.
    """
    from hookean.running.run import bounded, relax_state
    from hookean.solvers import solver
    from hookean.system.system import compile

    check_output(target, source)
    with reading or contextlib.nullcontext():
        read = open_file(Path(source), recipe_text, recipe_name)
    with about(recipe_name if recipe_text is not None else Path(source).name):
        began = time.monotonic()
        scene = read.scene if seconds is None else bounded(read.scene, seconds)
        if case is not None:
            system, result = _under_case(scene, case)
        else:
            system = compile(scene)
            state = system.start() if read.simulation is None else read.simulation.state
            result = relax_state(system, state, solver(read.scene.settings.solver), progress, cancelled, began)
    return conclude(read, Path(source), system, result, target, limits=limits, limits_name=limits_name)


def _under_case(scene: Scene, case: str) -> tuple[System, Result]:
    """The frozen model of a scene under a load case or combination; its system starts at the form."""
    from hookean.analysis.load_cases import load_cases

    found = load_cases(scene, [case])
    result = found.cases[case].result
    assert result.scene is not None
    system, state = found.frozen.system(result.scene)
    result.report.warnings[:0] = found.frozen.notes
    return replace(system, x=state.x), result


def check_output(target: Path | None, source: Path, *, folder: bool = True) -> None:
    """InputError where a result cannot be written to `target`; its folder may be missing where `folder` is False."""
    if target is not None:
        check_target(target, source, folder=folder)
        if target.suffix.lower() not in WRITTEN:
            raise InputError(target.name, f"must end in {', '.join(WRITTEN[:-1])} or {WRITTEN[-1]}; rename the output")


def open_file(source: Path, recipe_text: str | None = None, recipe_name: str = "") -> Source:
    """What a file holds; InputError where that cannot be relaxed as it is."""
    read = read_path(source, _recipe(recipe_text, recipe_name))
    if read.nothing or read.unheld:
        raise InputError(source.name, read.nothing or read.unheld)
    return read


def _recipe(text: str | None, name: str) -> Recipe | None:
    return None if text is None else (text, name)


def conclude(
    read: Source,
    source: Path,
    system: System,
    result: Result,
    target: Path | None = None,
    *,
    limits: Mapping[str, Any] | None = None,
    limits_name: str = "limits",
) -> FileResult:
    """A result as `relax_file` gives it, written to `target` and held to limits: of a system that `read` describes."""
    from hookean.running.result import Status

    parts = tables.sections(system, result, read.built)
    found = FileResult(
        result, read.scene, read.lines, tables.rows(parts, result), tables.per_object(parts, result.units)
    )
    found.warnings = [*read.warnings, *result.report.left_out(), *result.report.warnings]
    found.warnings += [*_doubled(parts), *_overstretched(parts, read.built), *_idle(parts, system)]
    found.moved = float(np.linalg.norm(result.particles - system.points, axis=1).max(initial=0.0))
    fault: InputError | None = None
    if limits is not None:
        try:
            found.exceeded = limit_file.exceeded(limits, parts, system, result, limits_name, source.name)
        except InputError as error:
            fault = error
    if target is not None and result.status is not Status.CANCELLED:
        _write(found, system, parts, read, source, target)
    if fault is not None:
        raise LimitsError(fault, found)
    return found


def _doubled(parts: list[tables.Section]) -> list[str]:
    """A warning for each force with elements on the same two particles: a line drawn twice pulls twice."""
    said = []
    for part in parts:
        if part.internal and part.particles.shape[1] == 2:
            twice = len(part.particles) - len(np.unique(np.sort(part.particles, axis=1), axis=0))
            if twice:
                from hookean.files.recipe.select import count

                join, pull = ("joins", "pulls") if twice == 1 else ("join", "pull")
                elements = count(twice, "element")
                said.append(f"{part.name}: {elements} {join} the same particles as another and {pull} twice")
    return said


def _overstretched(parts: list[tables.Section], built: Built | None) -> list[str]:
    """A note for each force whose springs become absurdly long: most likely numbers and size do not match."""
    said = []
    for part in parts:
        longest = 1.0 + float(part.columns["strain"].max(initial=0.0)) if "strain" in part.columns else 1.0
        if longest > TOO_LONG:
            size = ""
            if built is not None and built.size:
                counts = "its numbers are in"
                size = f": the model measures {built.size}, and {counts} {built.scene.units.length} and "
                size += str(built.scene.units.force)
            stretched = f'springs of "{part.name}" stretch to {longest:.4g} times their rest length{size}'
            said.append(f"{stretched}; adjust stiffness and loads to the size")
    return said


def _idle(parts: list[tables.Section], system: System) -> list[str]:
    """A note for each load that acts on held particles alone."""
    held = (system.start().free == 0).all(axis=1)
    forces = system.scene.forces
    loads = [p for p in parts if p.number >= 0 and type(forces[p.number]).role == "load" and p.particles.size]
    return [
        f'load "{p.name}" acts on held particles only, so it has no effect' for p in loads if held[p.particles].all()
    ]


def _write(
    found: FileResult, system: System, parts: list[tables.Section], read: Source, source: Path, target: Path
) -> None:
    if ending_of(target) in EXCHANGED:
        found.unwritten = exchange(found.result, target, system)
        return
    if target.suffix.lower() == ".json":
        put(target, _json(_finite(_answer(found, read, system))), lambda back: None)
        return
    if target.suffix.lower() == ".obj":
        said = document_text(found.result, found.warnings)
        put(target, obj.text(system, found.result.particles, system.start().free, said).encode(), lambda back: None)
        return
    from hookean.files.recipe.drawing import UNIT_NAMES
    from hookean.files.recipe.output import additions
    from hookean.files.rhino import threedm

    added, refused = additions(system, found.result, parts, read.built, read.unit, read.factor)
    found.unwritten = refused
    found.warnings += refused
    where = [f"{item.layer} {item.name}".strip() for item in added.objects]

    def text(notes: Sequence[str]) -> dict[str, str]:
        """The document text on the result, with the warnings that come with writing."""
        note(notes)
        stored = {embedded.KEY: embedded.packed(read.scene)} if read.built is None else {}
        return document_text(found.result, found.warnings) | stored

    def note(notes: Sequence[str]) -> None:
        said = [re.sub(r"^/objects/(\d+): ", lambda m: f"result on layer {where[int(m[1])]}: ", n) for n in notes]
        found.warnings = list(dict.fromkeys([*found.warnings, *said]))

    if source.suffix.lower() == ".3dm":
        written = threedm.write(source, target, added, text)
    else:
        names = {short: name for name, short in UNIT_NAMES.items()}
        written = threedm.write_new(target, added, unit=names[read.scene.units.length], text=text)
    note(written.warnings)
    found.ids = [str(id) for id in written.ids]


def _answer(found: FileResult, read: Source, system: System) -> Any:
    """The result, or a COMPAS document with its points moved."""
    document = read.compas
    if document is None:
        return found.result.to_dict()
    from hookean.files import compas_json, compas_write

    if read.stored:
        state = system.start()
        state.x[: system.slots.count] = found.result.particles
        return compas_write.document(system, state, read.scene)
    if document.kind == "mesh":
        return compas_json.mesh(found.result.particles, document.faces, document.keys)
    return compas_json.graph(found.result.particles, document.edges)


def report_json(found: FileResult) -> bytes:
    """The report as JSON text in UTF-8."""
    return _json(found.to_dict())


def _json(value: Any) -> bytes:
    return (json.dumps(value, ensure_ascii=False, allow_nan=False, indent=1) + "\n").encode()


def _finite(value: Any) -> Any:
    """JSON has no infinity and no NaN: both become null."""
    if isinstance(value, dict):
        return {str(k): _finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
