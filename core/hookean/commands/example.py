"""`hookean example`: the figures of the chapter, listed, run and drawn."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hookean.commands import command, outputs
from hookean.commands.relax import bad, check_picture
from hookean.errors import InputError

if TYPE_CHECKING:
    from hookean.commands.examples import Example, Outcome

FULFILLED, MISSED, BAD_INPUT = 0, 1, 2


app = command.new()


@app.command()
def example(
    figure: Annotated[
        str | None, typer.Argument(help="Figure or name, such as 9.11, or the folder of a copy; default: list all")
    ] = None,
    picture: Annotated[
        str | None, typer.Option(metavar="PATH", help="Draw the result to this .png file or folder/")
    ] = None,
    copy: Annotated[
        str | None,
        typer.Option(metavar="FOLDER", help="Copy the example to this new folder, or into this existing one"),
    ] = None,
    all_to: Annotated[
        Path | None, typer.Option("--figures", help="Run and draw all examples, each into a subfolder of this folder")
    ] = None,
) -> None:
    """List the figures of the chapter that hookean implements, or run one and check its numbers.

    Exits with 0 if all numbers are as expected, 1 if one is not, 2 for bad input. A changed copy may give other
    numbers: they are printed beside the original ones.
    """
    if all_to is not None:
        raise typer.Exit(figures(all_to))
    if figure is None and picture is None and copy is None:
        raise typer.Exit(listing())
    raise typer.Exit(run(figure, picture, copy))


def listing() -> int:
    """All examples in a table; one line each if the output is a file or a pipe."""
    from rich.console import Console
    from rich.table import Table

    from hookean.commands.examples import examples

    rows = [(", ".join(e.expected.figures), e.name, e.expected.title) for e in examples()]
    console = Console()
    if console.is_terminal:
        table = Table("figure", "example", "what it shows", box=None, pad_edge=False)
        for row in rows:
            table.add_row(*row)
        console.print(table)
    else:
        wide = [max(len(row[column]) for row in rows) for column in (0, 1)]
        for figure, name, title in rows:
            typer.echo(f"{figure:<{wide[0]}}  {name:<{wide[1]}}  {title}")
    typer.echo("\nRun one with: hookean example 9.11 (--picture draws it, --copy copies its folder for you to change)")
    return FULFILLED


def run(wanted: str | None, picture: str | None, copy: str | None) -> int:
    """Run an example, or a copy of one that was changed: its numbers beside those expected; returns 1
    if a number of an unchanged example is off."""
    from hookean.commands.examples import find

    try:
        if wanted is None:
            option = f"--copy {copy}" if copy is not None else f"--picture {picture}"
            raise InputError(option.split()[0], f"needs a figure: hookean example 9.24 {option}")
        example = find(wanted)
        expected = example.expected
        drawn = outputs.place(picture, Path(f"{example.name}.png"), ".png")
        check_picture(drawn)
        if copy is not None:
            _copy(example, Path(copy))
            if drawn is None:
                return FULFILLED
        with outputs.folders([drawn]):
            outcome = example.run()
            if drawn is not None:
                example.draw(outcome, drawn)
    except InputError as error:
        return bad(error)
    typer.echo(f"{example.name}: {expected.title}\n")
    missed = _report(example, outcome)
    for message in outcome.failures:
        typer.echo(f"\nhookean: one of its runs did not converge: {message}", err=True)
    typer.echo(f"\ninput, picture and README: {example.folder}" + (f"\npicture: {drawn}" if drawn is not None else ""))
    return MISSED if missed and example.original else FULFILLED


def _report(example: Example, outcome: Outcome) -> int:
    """Print the numbers of a run; returns how many of them are off."""
    numbers, known = outcome.numbers, example.expected.numbers
    wide, missed = max(map(len, (*known, *numbers))), 0
    for name, number in numbers.items():
        expected = known.get(name)
        if expected is None:
            typer.echo(f"  {name:<{wide}}  {number:.9g}")
            continue
        held = expected.holds(number)
        missed += not held
        verdict = f"as expected: {expected}" if held else f"NOT as expected: {expected}"
        if not example.original:
            verdict = f"was {expected}"
        typer.echo(f"  {name:<{wide}}  {number:.9g} {expected.unit}  ({verdict})")
        if example.original:
            typer.echo(typer.style(f"  {'':<{wide}}  {expected.source}", dim=True))
    return missed


def figures(target: Path) -> int:
    """Run all examples, check their numbers, draw each to `target/NAME/picture.png` and write the gallery; returns 1
    if a number is off."""
    from hookean.commands.examples import examples, gallery

    missed = 0
    known = examples()
    try:
        target.mkdir(parents=True, exist_ok=True)
        (target / "README.md").write_text(gallery(known), encoding="utf-8")
    except OSError as error:
        typer.echo(f"hookean: {target}: cannot be written ({error.strerror})", err=True)
        return BAD_INPUT
    for example in known:
        outcome = example.run()
        wrong = [name for name, e in example.expected.numbers.items() if not e.holds(outcome.numbers[name])]
        missed += len(wrong)
        (target / example.name).mkdir(exist_ok=True)
        example.draw(outcome, target / example.name / "picture.png")
        checked = (
            f"not as expected: {', '.join(wrong)}" if wrong else f"{len(example.expected.numbers)} numbers as expected"
        )
        typer.echo(f"{example.name}: {checked}")
    return MISSED if missed else FULFILLED


def _copy(example: Example, target: Path) -> None:
    import shutil

    target = target / example.name if target.is_dir() else target
    if target.exists():
        raise InputError(str(target), "exists already; give a new folder")
    try:
        shutil.copytree(example.folder, target, ignore=shutil.ignore_patterns("__pycache__", "oracle.py"))
    except OSError as error:
        raise InputError(str(target), f"cannot be written ({error.strerror})") from None
    typer.echo(f"copied to {target}; its README.md suggests changes. Change its scene.py and run it:")
    run = str(target) if target.is_absolute() else f"{os.curdir}{os.sep}{target}"
    typer.echo(f"  hookean example {run}")
    if example.drawn:
        given = f"{target / 'model.3dm'} --recipe {target / 'recipe.toml'}"
        typer.echo(f"  hookean relax {given} --picture {target / 'relaxed.png'}")
