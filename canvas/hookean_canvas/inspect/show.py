"""`hookean canvas show` and `hookean canvas check`: archives as a person reads them."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.text import Text
from rich.tree import Tree

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.inspect.describe import Data, describe, raw
from hookean_canvas.inspect.lint import faults
from hookean_canvas.inspect.lint_refused import refusals

SOME = 8
"""Values shown of a longer list."""


@dataclass
class Line:
    """A line of the tree with the lines under it."""

    text: str
    below: list[Line] = field(default_factory=list)


def show(file: Path, with_code: bool, as_json: bool, everything: bool, console: Console | None = None) -> None:
    """Print an archive: a tree on a terminal, indented lines in a pipe, or JSON; InputError where it cannot be read."""
    root = archive.read(file)
    described = {"kind": "archive", "root": raw(root)} if everything else describe(root)
    if as_json:
        print(json.dumps(described, indent=2, ensure_ascii=False))
        return
    top = lines(described, file.name, with_code)
    console = console or Console(highlight=False, soft_wrap=True)
    if console.is_terminal:
        console.print(_tree(top))
    else:
        console.file.write(text(top))


def check(files: Iterable[Path], strict: bool = False) -> int:
    """Print why Grasshopper would refuse each file, or with `strict` all that is wrong with it.

    0 where nothing is, 1 where something is, 2 where one cannot be read.
    """
    worst = 0
    for file in files:
        try:
            found = (faults if strict else refusals)(archive.read(file))
        except InputError as error:
            print(f"hookean: {error}", file=sys.stderr)
            worst = 2
            continue
        for fault in found or ["no faults"]:
            print(f"{file}: {fault}")
        worst = max(worst, 1 if found else 0)
    return worst


def text(top: Line) -> str:
    """The tree as lines of text, two spaces for each level."""
    return "".join("  " * depth + line + "\n" for depth, line in _flat(top, 0))


def _flat(line: Line, depth: int) -> Iterator[tuple[int, str]]:
    first, *more = line.text.splitlines() or [""]
    yield depth, first
    yield from ((depth + 1, part) for part in more)
    for below in line.below:
        yield from _flat(below, depth + 1)


def _tree(line: Line) -> Tree:
    tree = Tree(Text(line.text))
    for below in line.below:
        tree.children.append(_tree(below))
    return tree


# ------------------------------------------------------------------------------------------------------ what to print


def lines(described: Data, name: str, with_code: bool = False) -> Line:
    """The tree of a described archive, its first line the file's name."""
    if described["kind"] == "definition":
        return _definition(described, name, with_code)
    if described["kind"] == "user object":
        return _user_object(described, name, with_code)
    return Line(f"{name}: an archive", [_raw(described["root"])])


def _definition(described: Data, name: str, with_code: bool) -> Line:
    objects, groups = described["objects"], described["groups"]
    wires = sum(
        len(port["sources"]) for part in objects for port in [part, *part.get("inputs", [])] if "sources" in port
    )
    counts = ", ".join((_many(len(objects), "object"), _many(wires, "wire"), _many(len(groups), "group")))
    top = Line(f"{name}: a definition with {counts}, Grasshopper {described['grasshopper'] or 'unknown'}")
    if described["description"]:
        top.below.append(Line(described["description"]))
    for library in described["libraries"]:
        named = " ".join(library[key] for key in ("name", "version") if library[key])
        top.below.append(Line(f"needs {named or library['id']} ({library['author'] or 'author unknown'})"))
    top.below.extend(_object(part, with_code) for part in objects)
    for group in groups:
        top.below.append(Line(f"group {group['name']!r}: {', '.join(group['members']) or 'empty'}"))
    return top


def _many(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def _user_object(described: Data, name: str, with_code: bool) -> Line:
    top = Line(f"{name}: the user object {described['name']!r} ({described['nickname']})")
    top.below.append(Line(f"tab {described['category']}, panel {described['subcategory']}, icon {described['icon']}"))
    if described["description"]:
        top.below.append(Line(described["description"]))
    if "damage" in described:
        top.below.append(Line(described["damage"]))
        return top
    kind = described["known"] or f"unknown component {described['guid']}"
    top.below.append(_contents(Line(kind), described["object"], with_code))
    return top


def _object(part: Data, with_code: bool) -> Line:
    known, name, nickname, plugin = part["known"], part["name"], part["nickname"], part["plugin"]
    heading = name or known or "?"
    if nickname and nickname != name:
        heading += f" {nickname!r}"
    if part["label"].endswith(f" #{part['index']}"):
        heading += f" #{part['index']}"
    if plugin is not None:
        heading += f" ({plugin})" if known in (None, name) else f" ({known} of {plugin})"
    elif known is None:
        heading += f" (unknown component {part['guid']})"
    elif known != name:
        heading += f" ({known})"
    return _contents(Line(heading), part, with_code)


def _contents(line: Line, part: Data, with_code: bool) -> Line:
    values = part.get("values", {})
    if values.keys() == {"value", "from", "to", "decimals"}:
        line.below.append(Line(f"{_short(values['value'])}, from {_short(values['from'])} to {_short(values['to'])}"))
        values = {}
    for name, value in values.items():
        if isinstance(value, dict) and value.get("kind") in ("definition", "archive", "user object"):
            line.below.append(lines(value, name, with_code))
        elif name == "text":
            line.below.extend(Line(row) for row in value.splitlines())
        else:
            line.below.append(Line(f"{name}: {_short(value)}"))
    if part.get("floating"):
        line.below.extend(_fed(part))
    line.below.extend(_port("in ", port) for port in part.get("inputs", []))
    line.below.extend(_port("out", port) for port in part.get("outputs", []))
    if "language" in part:
        line.below.append(_code(part, with_code))
    return line


def _code(part: Data, with_code: bool) -> Line:
    count = len(part["code"].splitlines())
    heading = Line(f"script in {part['language']}, {_many(count, 'line')}")
    if with_code and part["code"]:
        heading.below.extend(Line(line) for line in part["code"].splitlines())
    return heading


def _port(side: str, port: Data) -> Line:
    notes = [] if port["access"] == "item" else [port["access"]]
    notes += [] if port["hint"] in (None, "none", "ghdoc") else [port["hint"]]
    notes += ["optional"] if port["optional"] and side == "in " else []
    notes += port["changes"]
    name = port["nickname"] or port["name"] or "?"
    return Line(f"{side} {name}" + (f" ({', '.join(notes)})" if notes else ""), list(_fed(port)))


def _fed(port: Data) -> Iterator[Line]:
    """What comes in over wires, else the values it holds itself."""
    for source in port["sources"]:
        if source["object"] is None:
            yield Line(f"<- {source['id']}, which is not in the file")
        else:
            yield Line(f"<- {source['object']}" + (f".{source['output']}" if source["output"] else ""))
    if not port["sources"]:
        for path, values in port["data"].items():
            more = f", ... {len(values)} in all" if len(values) > SOME else ""
            yield Line(f"= {path}: {', '.join(_short(value) for value in values[:SOME])}{more}")


def _raw(chunk: Data) -> Line:
    items = [Line(f"{name}: {_short(value)}") for name, value in chunk["items"].items()]
    return Line(chunk["name"], items + [_raw(inner) for inner in chunk["chunks"]])


def _short(value: Any) -> str:
    match value:
        case float():
            return f"{value:g}"
        case str():
            return value if len(value) <= 200 else f"{value[:197]}..."
        case list():
            return (
                f"({', '.join(_short(part) for part in value[: 2 * SOME])}{', ...' if len(value) > 2 * SOME else ''})"
            )
        case dict():
            return ", ".join(f"{name} {_short(part)}" for name, part in value.items())
    return str(value).lower() if isinstance(value, bool) else str(value)
