"""The stack: which room of the sources may import which, and that no two files need each other.

The rooms of the core are listed from the ground up in LAYERS. A file imports only from its own room and from rooms
below it; imports inside of functions and by `import_module` count, imports for type checkers alone do not.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
HOMES = {"hookean": "core", "hookean_server": "server", "hookean_canvas": "canvas"}
LAYERS = (
    *("errors", "atomic_write", "values", "compiled", "discretize", "forces", "films", "scene", "system", "linear"),
    *("stability", "solvers", "running", "analysis", "designing", "workshop", "pictures", "files", "commands", "cli"),
)


@cache
def modules() -> dict[str, Path]:
    """All source files by their dotted names; a room by its `__init__.py`."""
    found = {}
    for package, home in HOMES.items():
        for path in sorted((ROOT / home / package).rglob("*.py")):
            parts = path.relative_to(ROOT / home).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def imported(name: str) -> frozenset[str]:
    """The files of ours that a file imports."""
    nodes = ast.parse(modules()[name].read_text(encoding="utf-8"))
    return frozenset(home for wanted in _wanted(nodes) if (home := _home(wanted)) and home != name)


def _wanted(node: ast.AST) -> Iterator[str]:
    """Dotted names that a piece of code imports, not those that type checkers alone do."""
    if isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
        for other in node.orelse:
            yield from _wanted(other)
        return
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        assert not node.level, "imports name their module in full"
        yield from (f"{node.module}.{alias.name}" for alias in node.names)
    elif isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] in ("import_module", "__import__"):
        yield from (argument.value for argument in node.args[:1] if isinstance(argument, ast.Constant))
    for child in ast.iter_child_nodes(node):
        yield from _wanted(child)


def _home(wanted: str) -> str:
    """The file of ours that a dotted name, of a module or of something in one, stands for; "" for those of others."""
    while wanted and wanted not in modules():
        wanted = wanted.rpartition(".")[0]
    return wanted


def layer(name: str) -> int:
    room = name.split(".")[1]
    assert room in LAYERS, f"{name} lies in no room: put it in one, or add its room to LAYERS in tests/test_layers.py"
    return LAYERS.index(room)


@pytest.mark.parametrize("room", LAYERS)
def test_a_room_imports_only_rooms_below(room: str) -> None:
    """The core is a stack (see the head of this file). What all its rooms share is the package's own name."""
    names = [name for name in modules() if name.split(".")[:2] == ["hookean", room]]
    assert names
    upward = [
        f"{name} imports {other}: move what it needs below {room}, or {name} above {other.split('.')[1]}"
        for name in names
        for other in sorted(imported(name))
        if other != "hookean" and (other.split(".")[0] != "hookean" or layer(other) > layer(name))
    ]
    assert not upward, "\n".join(upward)


def test_every_file_has_a_room() -> None:
    """And each room a place in the stack."""
    assert {LAYERS[layer(name)] for name in modules() if name.startswith("hookean.")} == set(LAYERS)


@pytest.mark.parametrize("package", HOMES)
def test_no_files_need_each_other(package: str) -> None:
    """Of two files that import each other neither can be read, tested or moved alone."""
    needs = {name: imported(name) for name in modules() if name.split(".")[0] == package and name != package}
    try:
        TopologicalSorter(needs).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))
