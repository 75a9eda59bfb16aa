"""`hookean simulate`: a file in motion, a row for each frame, and an exit code."""

from __future__ import annotations

import contextlib
import csv
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hookean.commands import outputs, relax
from hookean.commands.command import taking
from hookean.errors import InputError
from hookean.files import cells

if TYPE_CHECKING:
    from hookean.files.readers import Source
    from hookean.files.relax_file import FileResult
    from hookean.running.result import Result
    from hookean.running.simulation import Simulation

ENDED, BAD_INPUT, RESTLESS, STOPPED = relax.CONVERGED, relax.BAD_INPUT, relax.NOT_CONVERGED, relax.STOPPED
SHAPES = 4  # drawn over each other, at most twice as many: more would crowd the legend


@dataclass(frozen=True)
class Options:
    """Run a file in motion: it bounces, anchors move, loads change. The input is never changed.

    Ends at rest, after --frames, or at the end of the stream, with exit code 0; 2: bad input, 3: diverged or never at
    rest, 130: Ctrl-C. The frames until then are written in each case.
    """

    source: Annotated[Path, typer.Argument(metavar="FILE", help=".3dm, .obj, .json, .npz or .hookean file")]
    recipe: Annotated[
        Path | None, typer.Option("--recipe", "-r", help="Recipe (TOML, JSON); default: layer names define the model")
    ] = None
    script: Annotated[
        Path | None, typer.Option(help="Paths of anchors and forces, and drives (TOML, JSON), in the scene's units")
    ] = None
    stream: Annotated[str | None, typer.Option(help="Values over time for the drives (CSV); - is standard input")] = (
        None
    )
    frames: Annotated[int | None, typer.Option(help="Stop after this many frames", min=0)] = None
    csv: Annotated[
        str | None,
        typer.Option(metavar="PATH", help="Write a row for each frame as it is computed; - is standard output"),
    ] = None
    picture: Annotated[
        str | None, typer.Option(metavar="PATH", help="Draw the frames over each other in a picture (PNG)")
    ] = None
    output: Annotated[
        str | None, typer.Option("--output", "-o", metavar="PATH", help=".3dm, .json, .obj ... file for the last shape")
    ] = None
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only print errors and notes")] = False


@dataclass(frozen=True)
class _Targets:
    """The files to write."""

    output: Path | None
    picture: Path | None
    table: Path | None

    @property
    def files(self) -> tuple[Path | None, ...]:
        return self.output, self.picture, self.table


@dataclass
class _Seen:
    """The frames of a run so far: the last one, and some earlier shapes by time."""

    result: Result | None = None
    frames: int = 0
    stride: int = 1
    shapes: list[tuple[float, Any]] = field(default_factory=list)

    def note(self, result: Result) -> None:
        if self.result is not None:
            self.frames += 1
        self.result = result
        if self.frames % self.stride == 0:
            self.shapes.append((result.time, result.particles))
        if len(self.shapes) > 2 * SHAPES:
            self.shapes, self.stride = self.shapes[::2], 2 * self.stride


def run(options: Options) -> int:
    """Run the file in motion; frames before bad input or Ctrl-C are still written."""
    try:
        to = _targets(options)
        read, running = _ready(options)
        seen = _Seen()
        fault: InputError | None = None
        code = STOPPED
        with outputs.folders(to.files):
            with _table(options.csv, to.table) as write, contextlib.suppress(KeyboardInterrupt):
                try:
                    code = _go(running, options.frames, seen, write)
                except InputError as error:
                    fault, code = error, BAD_INPUT
            if seen.result is not None:
                _conclude(options, to, read, running, seen, code)
        return relax.bad(fault) if fault is not None else code
    except InputError as error:
        return relax.bad(error)
    except KeyboardInterrupt:
        typer.echo(f"hookean: {options.source.name}: stopped, nothing written", err=True)
        return STOPPED


def _targets(options: Options) -> _Targets:
    from hookean.files.relax_file import check_output

    source = options.source
    to = _Targets(
        outputs.place(options.output, source, source.suffix or ".3dm"),
        outputs.place(options.picture, source, ".png"),
        outputs.place(None if options.csv == "-" else options.csv, source, ".csv"),
    )
    stream = None if options.stream in (None, "-") else Path(str(options.stream))
    relax.check_picture(to.picture)
    outputs.check(to.files, (source, options.recipe, options.script, stream))
    check_output(to.output, source, folder=False)
    return to


def _ready(options: Options) -> tuple[Source, Simulation]:
    from hookean.files.readers import about
    from hookean.files.recipe.check import check_script
    from hookean.files.relax_file import open_file
    from hookean.running.script import Script
    from hookean.running.simulation import Simulation
    from hookean.scene.text import parse_tables
    from hookean.system.system import compile

    recipe = None if options.recipe is None else relax.text_of(options.recipe)
    name = str(options.recipe) if options.recipe is not None else ""
    read = open_file(options.source, recipe, name)
    with about(name or options.source.name):
        compile(read.scene)
    if options.script is None and options.stream is None and read.simulation is not None:
        return read, read.simulation
    if options.script is None:
        return read, Simulation(read.scene, None, options.stream)
    text = relax.text_of(options.script)
    with about(str(options.script)):
        check_script(parse_tables(text, str(options.script)))
    script = Script.read(text, str(options.script))
    with about(str(options.script)):
        return read, Simulation(read.scene, script, options.stream)


def _go(running: Simulation, frames: int | None, seen: _Seen, write: Callable[[list[Any]], None]) -> int:
    """Frame by frame to rest, to `frames` or to the end of the stream; else as far as the scene's iterations go."""
    result = running.result()
    write(_heading(result))
    seen.note(result)  # before its row: what stands in the table has been seen, whenever Ctrl-C comes
    write(_row(result, running))
    most = running.scene.settings.max_iterations
    while running.status == "running" and not running.over and (frames is None or seen.frames < frames):
        if frames is None and running.state.iteration >= most and not running.driven:
            return RESTLESS
        running.step()
        result = running.result()
        seen.note(result)
        write(_row(result, running))
    return RESTLESS if running.status == "diverged" else ENDED


def _heading(result: Result) -> list[Any]:
    units = result.units
    forces = [f"largest force of {name} [{units.of(unit)}]" for name, unit, _ in _forces(result)]
    return [
        f"time [{units.time}]", "iteration", "residual [-]", f"kinetic energy [{units.of('energy')}]", *forces,
        f"largest displacement [{units.length}]", f"largest reaction [{units.force}]",
    ]  # fmt: skip


def _row(result: Result, running: Simulation) -> list[Any]:
    import numpy as np

    moved = np.linalg.norm(result.particles - running.system.points, axis=1).max(initial=0.0)
    reactions = np.asarray(result.reactions["force"]).reshape(-1, 3)
    numbers = [
        result.energy["kinetic"], *(value for _, _, value in _forces(result)),
        moved, np.linalg.norm(reactions, axis=1).max(initial=0.0),
    ]  # fmt: skip
    return [f"{result.time:.10g}", result.iterations, f"{result.residual:.6g}", *(f"{n:.10g}" for n in numbers)]


def _forces(result: Result) -> list[tuple[str, str, float]]:
    """Name, unit and largest force (or moment) of each force that has one; tension +, compression -."""
    import numpy as np

    from hookean.forces import KINDS

    found: list[tuple[str, str, float]] = []
    for number, entry in enumerate(result.forces):
        outputs = KINDS[entry["kind"]].outputs
        column = next((c for c in ("force", "moment") if c in outputs), None)
        if column is None:
            continue
        values = np.asarray(entry.get(column, ()), dtype=float)
        sizes = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
        largest = float(sizes[np.argmax(np.abs(sizes))]) if len(sizes) else 0.0
        name = entry["name"] or entry["kind"]
        taken = any(name == other for other, _, _ in found)
        found.append((f"{name} (force {number})" if taken else name, outputs[column], largest))
    return found


@contextlib.contextmanager
def _table(given: str | None, target: Path | None) -> Iterator[Callable[[list[Any]], None]]:
    """Writes each row at once, so that no row is lost and a pipe receives it immediately."""
    if given is None:
        yield lambda row: None
        return
    try:
        whole: Any = contextlib.nullcontext(sys.stdout)
        if target is not None:
            whole = open(target, "w", encoding="utf-8", newline="")  # noqa: SIM115
    except OSError as error:
        raise InputError(given, f"cannot be written ({error.strerror}); check the path") from None
    full = "cannot be written ({}); check free space, and that what reads it still runs"
    try:
        with whole as file:
            lines = csv.writer(file, lineterminator="\n")

            def write(row: list[Any]) -> None:
                try:
                    lines.writerow(cells.row(row))
                    file.flush()
                except OSError as error:
                    raise error if target is None else InputError(given, full.format(error.strerror)) from None

            yield write
    except OSError as error:  # of what was left to write at the end
        raise error if target is None else InputError(given, full.format(error.strerror)) from None


def _conclude(options: Options, to: _Targets, read: Source, running: Simulation, seen: _Seen, code: int) -> None:
    from hookean.files.relax_file import conclude

    result = seen.result
    assert result is not None
    found = conclude(read, options.source, running.system, result, to.output)
    if to.picture is not None:
        from hookean.pictures.sheet import Panel, sheet

        frames = {f"{time:.4g} {result.units.time}": x for time, x in seen.shapes if time < result.time}
        sheet([Panel(result, read.scene, frames=frames)], to.picture, title=options.source.stem)
    _print(options, to, found, seen, code)


def _print(options: Options, to: _Targets, found: FileResult, seen: _Seen, code: int) -> None:
    result, name = found.result, options.source.name
    relax.print_notes(options.source, [*found.warnings, *relax.forgotten(options.source, options.recipe)])
    how = {STOPPED: "stopped", RESTLESS: "not at rest", BAD_INPUT: "aborted"}.get(code, "")
    ended = f"{seen.frames} frames, {result.time:.6g} {result.units.time}. {result.message}"
    if how:
        typer.echo(f"hookean: {name}: {how} after {ended}", err=True)
    elif not options.quiet:
        aside = options.csv == "-"  # which has standard output to itself
        written = ", ".join(str(target) for target in to.files if target is not None)
        typer.echo(f"{name}: {ended}{f' -> {written}' if written else ''}", err=aside)
        for line in relax.summary(found):
            typer.echo(f"  {line}", err=aside)


app = taking(Options, run)
