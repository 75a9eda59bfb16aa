"""Running a definition for a person: its panels printed, its messages, its numbers compared with expected.json."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hookean.commands.examples import Example, Expected
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.run import graph
from hookean_canvas.run.clusters import opened
from hookean_canvas.run.evaluate import Canvas, Outcome
from hookean_canvas.run.references import fill
from hookean_canvas.run.trees import Tree, text_of
from hookean_canvas.run.trust import require


@dataclass(frozen=True)
class Compared:
    """A number that was expected: what its panel shows (None: nothing, or no panel has its name)."""

    name: str
    expected: Expected
    found: float | None

    @property
    def holds(self) -> bool:
        """Whether it is what was expected."""
        return self.found is not None and self.expected.holds(self.found)

    def __str__(self) -> str:
        shown = "nothing" if self.found is None else f"{self.found:.10g} {self.expected.unit}".rstrip()
        return f"{self.name}: {shown}, expected {self.expected}"


@dataclass(frozen=True)
class Checked:
    """A definition that was run: what it came to, and the numbers of expected.json where that lies beside it."""

    file: Path
    outcome: Outcome
    compared: list[Compared]

    @property
    def faults(self) -> list[str]:
        """Why it is not as it should be; empty where it is."""
        found = [f"{m.component}: {m.text}" for m in self.outcome.messages if m.level == "error"]
        found += [f"{text} It is paused; set its input on to True" for text in self.outcome.paused]
        if not self.outcome.at_rest and not self.outcome.paused:
            found.append(f"it was not at rest after {self.outcome.solutions} solutions; raise --seconds")
        return found + [str(one) for one in self.compared if not one.holds]

    def as_json(self) -> dict[str, Any]:
        """All of it, for other programs."""
        return {
            "file": self.file.name,
            "at_rest": self.outcome.at_rest,
            "solutions": self.outcome.solutions,
            "engines": self.outcome.engines,
            "panels": {name: _plain(tree) for name, tree in self.outcome.panels.items()},
            "messages": [{"component": m.component, "level": m.level, "text": m.text} for m in self.outcome.messages],
            "expected": [
                {"name": c.name, "found": c.found, "unit": c.expected.unit, "holds": c.holds} for c in self.compared
            ],
            "faults": self.faults,
        }


def check(
    path: Path,
    settings: Mapping[str, str] | None = None,
    seconds: float = 120.0,
    trust: bool | None = None,
    rhino: Path | None = None,
) -> Checked:
    """Run a definition and compare it; with settings other than its own nothing is compared.

    `rhino`: a .3dm file with the objects that it refers to; what that lacks is a warning, or an error if an Engine
    needs it.

    `trust`: False where its scripts may run only if they are trusted already, True where they are from now on (see
    `trust.require`); None: the caller has checked them. InputError where it cannot be read or run.
    """
    data = archive.read_bytes(path)
    definition = opened(graph.parse(data, path))
    if rhino is not None:
        fill(definition, rhino)
    canvas = Canvas(definition, settings)
    if trust is not None:
        require(definition, data, path, trust)
    os.environ.setdefault("HOOKEAN_PYTHON", sys.executable)  # a component may have to start the server
    outcome = canvas.run(seconds)
    folder = Path(path).resolve().parent
    compared: list[Compared] = []
    if not settings and (folder / "expected.json").is_file():
        for name, expected in Example(folder).expected.numbers.items():
            compared.append(Compared(name, expected, number(outcome.panels.get(name, Tree()))))
    return Checked(Path(path), outcome, compared)


def number(tree: Tree) -> float | None:
    """The one number that a panel shows; None where it shows anything else."""
    values = tree.values_in_order()
    if len(values) != 1 or not isinstance(values[0], (bool, int, float, str)):
        return None
    try:
        found = float(values[0])
    except ValueError:
        return None
    return found if math.isfinite(found) else None


def shown(tree: Tree) -> str:
    """What a panel shows, in one line: its items, those of branches by their paths, long lists cut short."""
    branches = [(path, [_text(value) for value in values]) for path, values in tree.branches()]
    parts = []
    for path, texts in branches[:4]:
        more = f", ... ({len(texts)} items)" if len(texts) > 6 else ""
        line = ", ".join(texts[:6]) + more
        parts.append(line if len(branches) == 1 else f"{text_of(path)} {line}")
    return "; ".join(parts) + (f"; ... ({len(branches)} branches)" if len(branches) > 4 else "")


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.12g}"
    if isinstance(value, str):
        return value if len(value) < 200 else value[:200] + "..."
    if hasattr(value, "Z"):
        return "{" + f"{value.X:.6g}, {value.Y:.6g}, {value.Z:.6g}" + "}"
    return str(value) if isinstance(value, (bool, int)) else type(value).__name__


def _plain(tree: Tree) -> dict[str, list[Any]]:
    return {
        text_of(path): [v if isinstance(v, (bool, int, float, str)) else _text(v) for v in values]
        for path, values in tree.branches()
    }


def settings_of(texts: list[str]) -> dict[str, str]:
    """`name=value` texts by name; InputError for one without =."""
    found = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals:
            raise InputError("--set", f"{text!r} has no =; write --set 'Stiffness [N/m]=500'")
        found[name.strip()] = value.strip()
    return found


def run(path: Path, texts: list[str], as_json: bool, seconds: float, trust: bool, rhino: Path | None = None) -> int:
    """`hookean canvas run`: prints what a definition came to; 0, or 1 where something is not as it should be."""
    checked = check(path, settings_of(texts), seconds, trust, rhino)
    if as_json:
        print(json.dumps(checked.as_json(), indent=2))
        return 1 if checked.faults else 0
    for name, tree in checked.outcome.panels.items():
        print(f"{name}: {shown(tree)}")
    for told in checked.outcome.engines:
        print(told)
    for message in checked.outcome.messages:
        print(f"{message.level}, {message.component}: {message.text}")
    if checked.compared:
        holding = sum(one.holds for one in checked.compared)
        print(f"{holding} of {len(checked.compared)} numbers of expected.json are as expected")
    for fault in checked.faults:
        print(f"fault: {fault}", file=sys.stderr)
    return 1 if checked.faults else 0
