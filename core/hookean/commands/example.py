"""`hookean example`: the figures of the chapter, listed, run and drawn."""

from __future__ import annotations

from pathlib import Path

import typer
from rich.console import Console
from rich.table import Table

from hookean.errors import InputError

FULFILLED, MISSED, BAD_INPUT = 0, 1, 2


def listing() -> int:
    """All examples in a table."""
    from hookean.example import examples

    table = Table("figure", "example", "what it shows", box=None, pad_edge=False)
    for example in examples():
        table.add_row(", ".join(example.expected.figures), example.name, example.expected.title)
    Console().print(table)
    typer.echo("\nhookean example 9.11 runs one, --picture draws it, --copy takes its folder along to change it.")
    return FULFILLED


def run(wanted: str, picture: Path | None, copy: Path | None) -> int:
    """Run one example and print its numbers beside those expected; 1 where one is off."""
    from hookean.example import find

    try:
        example = find(wanted)
        if copy is not None:
            return _copy(example.folder, copy)
        outcome = example.run()
        if picture is not None:
            example.draw(outcome, picture)
    except InputError as error:
        typer.echo(f"hookean: {error}", err=True)
        return BAD_INPUT
    typer.echo(f"{example.name}: {example.expected.title}\n")
    missed = 0
    wide = max(len(name) for name in example.expected.numbers)
    for name, expected in example.expected.numbers.items():
        held = expected.holds(outcome.numbers[name])
        missed += not held
        verdict = f"{'as expected' if held else 'NOT as expected'}: {expected}"
        typer.echo(f"  {name:<{wide}}  {outcome.numbers[name]:.9g} {expected.unit}  ({verdict})")
        typer.echo(typer.style(f"  {'':<{wide}}  {expected.source}", dim=True))
    typer.echo(f"\ninput, picture and README: {example.folder}")
    return MISSED if missed else FULFILLED


def figures(target: Path) -> int:
    """Run all examples, check their numbers, draw each to `target/NAME/picture.png` and write the gallery; 1 where a
    number is off."""
    from hookean.example import examples, gallery

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
        said = f"not as expected: {', '.join(wrong)}" if wrong else f"{len(example.expected.numbers)} numbers hold"
        typer.echo(f"{example.name}: {said}")
    return MISSED if missed else FULFILLED


def _copy(folder: Path, target: Path) -> int:
    import shutil

    target = target / folder.name if target.is_dir() else target
    if target.exists():
        raise InputError(str(target), "is there already; give a folder that is not")
    try:
        shutil.copytree(folder, target, ignore=shutil.ignore_patterns("__pycache__", "oracle.py", "expected.json"))
    except OSError as error:
        raise InputError(str(target), f"cannot be written ({error.strerror})") from None
    typer.echo(f"copied to {target}")
    return FULFILLED
