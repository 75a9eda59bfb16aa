"""The steps of the tutorial on the studio are those that the tests drive in the browser, with the same values."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "tutorials" / "studio-tasks.md").read_text("utf-8")
STUDIO = ROOT / "tests" / "studio"
TASKS = {
    function.name: function
    for function in ast.parse((STUDIO / "tasks.py").read_text("utf-8")).body
    if isinstance(function, ast.FunctionDef)
}
SECTIONS = {
    "A roof under snow": ["roof"],
    "A hanging vault": ["hanging", "turned"],
    "A tensegrity": ["tensegrity"],
    "A soap film, to its collapse and back": ["film", 'pulled(studio, "1")', "solved", "collapsed", "restored"],
    "Two variants": ["variants"],
}
"""The functions of `tasks.py` that make the steps of each section; with arguments: a call."""
DONE = {"add", "check", "fill", "filled", "get_by_role", "get_by_label", "get_by_text", "made", "opened", "press"}
"""Calls whose texts somebody chooses, presses or types."""
OUTCOME = {"wait_for", "set_input_files"}
"""Calls on what is awaited, or on what is behind a button: its name is no step."""


def steps(name: str) -> Iterator[str]:
    """The texts that a task chooses, presses and types, in their order."""
    call = ast.parse(name, mode="eval").body
    if isinstance(call, ast.Call):
        yield from told(call, {})
    else:
        for statement in TASKS[name].body:
            yield from of(statement, {})


def of(node: ast.AST, known: dict[str, str]) -> Iterator[str]:
    """The texts of what is under a node."""
    if isinstance(node, ast.Call):
        if isinstance(node.func, ast.Attribute) and node.func.attr in OUTCOME:
            return
        for part in (node.func, *node.args, *(keyword.value for keyword in node.keywords)):
            yield from of(part, known)
        yield from told(node, known)
        return
    for part in ast.iter_child_nodes(node):
        yield from of(part, known)


def told(call: ast.Call, known: dict[str, str]) -> Iterator[str]:
    """The texts of one call: of its own arguments, or of the task that it calls."""
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    texts = [known.get(a.id, "") if isinstance(a, ast.Name) else text(a) for a in call.args]
    if name == "solved":
        yield "Solve"
    elif name == "create":
        yield f"Make the {texts[-1].lower()}"
    elif name == "enter":
        yield texts[-1]
    elif name == "pulled":
        parameters = dict(zip((argument.arg for argument in TASKS[name].args.args), texts, strict=True))
        for statement in TASKS[name].body:
            yield from of(statement, parameters)
    elif name in DONE:
        named = [one for k in call.keywords if k.arg and k.arg[0].isupper() for one in (k.arg, text(k.value))]
        named += [text(k.value) for k in call.keywords if k.arg == "name"]
        yield from (one.replace("_", " ") for one in (*texts[name == "get_by_role" :], *named) if one)
        if name == "made":
            yield f"Make the {texts[1].lower()}"


def text(node: ast.expr) -> str:
    """A constant text; "" for anything else."""
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""


@pytest.mark.parametrize("title", SECTIONS)
def test_a_section_has_the_steps_of_its_task(title: str) -> None:
    """Every text that the task chooses, presses or types is in the section, in the same order."""
    [section] = re.findall(rf"^## {re.escape(title)}\n(.*?)(?=^## |^```python|\Z)", PAGE, re.S | re.M)
    written = re.sub(r"!\[.*?\]\(.*?\)", "", section, flags=re.S).replace("*", "")
    place, wanted = 0, [step for name in SECTIONS[title] for step in steps(name)]
    assert len(wanted) > 4
    for step in wanted:
        if step == "Close the notice":  # a notice is in nobody's way, but in that of the next wait for it
            continue
        found = re.search(rf"(?<![\w.-]){re.escape(step)}(?![\w]|\.\d)", written[place:])
        assert found, f"{step} is not after: ... {written[max(0, place - 60) : place]}"
        place += found.end()


def test_every_section_is_of_a_task() -> None:
    """The page has no section beside those of the tasks."""
    assert re.findall(r"^## (.*)$", PAGE, re.M) == [*SECTIONS]
