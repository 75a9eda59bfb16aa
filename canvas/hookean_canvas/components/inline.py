"""A component's script with the client inside: one text that needs nothing installed."""

from __future__ import annotations

import ast
import base64
import hashlib
import json
import re
import tokenize
import zlib
from collections.abc import Callable, Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from importlib.util import find_spec
from itertools import takewhile
from pathlib import Path
from typing import Literal

from hookean.errors import InputError

CLIENT = "hookean_client"
FLAVOURS = ("rhino8", "rhino7")
Flavour = Literal["rhino8", "rhino7"]

BOOTSTRAP = """
def _hookean_client(*packed):
    # {client} {version}, kept in sys.modules under a name of its own: versions live side by side, state survives
    import base64, sys, types, zlib

    loaded = []
    for names, sources in packed:
        sources = zlib.decompress(base64.{decode}("".join(sources.split()))).decode("ascii")
        for name, source in zip(names.split("|"), sources.split("\\0")):
            name = "{stamp}" + name
            if name in sys.modules:
                continue
            sys.modules[name] = module = types.ModuleType(name)
            loaded.append(name)
            module.__file__, module.__package__ = "<%s>" % name, "{stamp}"
            if "." in name:
                setattr(sys.modules["{stamp}"], name.split(".")[1], module)
            else:
                module.__path__ = []
            try:
                exec(compile(str(source), module.__file__, "exec", 0, 1), module.__dict__)
            except BaseException:
                for name in loaded:
                    sys.modules.pop(name, None)
                raise


_hookean_client(
"""
TOGETHER = (
    ("__init__", "canvas_geometry", "canvas_packed", "canvas_words", "canvas_items", "canvas"),
    ("transport", "finding", "client", "canvas_link", "canvas_ask"),
    ("canvas_branches", "canvas_values"),
)
"""Modules that travel as one: all scripts need the first, those that ask the service the second, tools the third. Each
imports no module but those of its own and of what every script that needs any of them carries."""
ENCODE = {"rhino8": ("b85decode", base64.b85encode), "rhino7": ("b64decode", base64.b64encode)}
"""Python 2.7 has no base 85."""


def inlined(code: str, flavour: Flavour = "rhino8", client: Path | None = None) -> str:
    """`code` with the client inside, for Rhino 8 and 9 ("rhino8", CPython) or GhPython ("rhino7").

    `client` is the package's folder (none: the installed one). The docstring and comments before it stay in front.
    InputError where an import of the client is written in a way that cannot be redirected.
    """
    if flavour not in FLAVOURS:
        raise InputError("flavour", f"{flavour!r} is not one of {', '.join(FLAVOURS)}.")
    sources = _sources(client or _installed())
    stamp, version = _stamped(sources)
    lines = redirected(code, stamp, "code.py").splitlines(keepends=True)
    cut = _after_docstring(code)
    decode, encode = ENCODE[flavour]
    first = "#! python 3\n" if flavour == "rhino8" and not code.startswith("#!") else ""
    whole = first + "".join(lines[:cut]) + BOOTSTRAP.format(stamp=stamp, client=CLIENT, version=version, decode=decode)
    for names in _blocks(carried(code, dict(sources)), dict(sources)):
        whole += _block(names, _packed(sources, names, encode), len(whole.encode("utf-8")))
    return whole + ")\n" + "".join(lines[cut:])


def _blocks(names: list[str], sources: dict[str, str]) -> list[tuple[str, ...]]:
    """Modules as they are packed, in their order."""
    joined = {name: tuple(one for one in block if one in sources) for block in TOGETHER for name in block}
    return list(dict.fromkeys(joined.get(name, (name,)) for name in names))


def _block(names: tuple[str, ...], packed: str, at: int) -> str:
    """The argument of the bootstrap for modules, at a byte of the script.

    Definitions hold scripts as base 64: what begins at a multiple of 3 bytes reads the same in every script, so that
    what several scripts carry is stored once in the compressed file.
    """
    known = "|".join("" if name == "__init__" else f".{name}" for name in names)
    head = f'    ("{known}", """'
    return head + " " * (-(at + len(head) + 1) % 3) + "\n" + packed + '\n"""),\n'


def stamp(client: Path | None = None) -> str:
    """The name of the packed client in sys.modules: its version and a digest of its files."""
    return _stamped(_sources(client or _installed()))[0]


def carried(code: str, sources: dict[str, str]) -> list[str]:
    """Modules of the client that `code` needs, each after those it imports when loaded; `__init__` first.

    What a function of the client imports only when it runs is needed where that function is named.
    """
    wanted = {"__init__"} | _imported(code, sources)
    named = _names(code)
    while True:
        more = set().union(*(_imported(sources[name], sources, named) for name in wanted))
        seen = named.union(*(_names(sources[name]) for name in wanted))
        if more <= wanted and seen <= named:
            return [name for name in _order(sources) if name in wanted]
        wanted, named = wanted | more, seen


def _imported(source: str, sources: dict[str, str], named: set[str] | None = None) -> set[str]:
    """Modules of the client that are imported at the top, and inside of functions that are `named`."""
    found: set[str] = set()
    for inside, modules in _imports(source):
        if not inside or named is None or inside in named:
            found |= modules & set(sources)
    return found


@cache
def _imports(source: str) -> list[tuple[str, set[str]]]:
    """What `source` may import of the client: name of the function or method it stands in, or "", and modules."""
    found = []
    for node in _parts(ast.parse(source)):
        inside = node.name if isinstance(node, ast.FunctionDef) else ""
        for at in ast.walk(node):
            if isinstance(at, ast.ImportFrom):
                path = [CLIENT] * at.level + (at.module or "").split(".")
                parts = [part for part in path[1:] if part] or [alias.name for alias in at.names]
                found.append((inside, set(parts) if path[0] == CLIENT else set()))
    return found


def _parts(tree: ast.Module) -> Iterator[ast.stmt]:
    """The statements of a module, those of its classes one by one."""
    for node in tree.body:
        yield from node.body if isinstance(node, ast.ClassDef) else [node]


@cache
def _names(source: str) -> set[str]:
    """Every name that is used anywhere: variables, and what stands behind a dot."""
    nodes = list(ast.walk(ast.parse(source)))
    names = {node.id for node in nodes if isinstance(node, ast.Name)}
    return names | {node.attr for node in nodes if isinstance(node, ast.Attribute)}


def redirected(source: str, to: str, where: str) -> str:
    """`source` with its imports of the client redirected to the module `to`.

    Only `import hookean_client` and `from hookean_client[.module] import ...` can be redirected.
    """
    lines = source.splitlines(keepends=True)
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import) and any(a.name.split(".")[0] == CLIENT for a in node.names):
            line = lines[node.lineno - 1]
            told = re.sub(rf"\bimport {CLIENT}(?= as |\s*$)", rf"import {to} as {CLIENT}", line)
            told = told.replace(f" as {CLIENT} as ", " as ")
            if told == line or len(node.names) > 1:
                raise InputError(f"{where}:{node.lineno}", f"cannot be redirected; write `import {CLIENT}` alone.")
            lines[node.lineno - 1] = told
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == CLIENT:
            line = lines[node.lineno - 1]
            lines[node.lineno - 1] = re.sub(rf"\bfrom {CLIENT}\b", f"from {to}", line, count=1)
    return "".join(lines)


def _installed() -> Path:
    spec = find_spec(CLIENT)
    if spec is None or not spec.submodule_search_locations:
        raise InputError(CLIENT, "is not installed; components are built from the source tree or an installed wheel.")
    return Path(spec.submodule_search_locations[0])


def _sources(client: Path) -> tuple[tuple[str, str], ...]:
    return tuple((p.stem, p.read_text(encoding="utf-8")) for p in sorted(client.glob("*.py")))


@cache
def _stamped(files: tuple[tuple[str, str], ...]) -> tuple[str, str]:
    """The name of the packed client, and its version."""
    sources = dict(files)
    for name, text in sources.items():
        if not text.isascii():
            raise InputError(f"{CLIENT}/{name}.py", "is not ASCII, which Python 2.7 cannot read.")
    found = re.search(r'(?m)^__version__ = "([^"]+)"', sources["__init__"])
    if not found:
        raise InputError(f"{CLIENT}/__init__.py", 'has no `__version__ = "..."`.')
    version = found.group(1)
    digest = hashlib.sha256(json.dumps(sources, sort_keys=True).encode()).hexdigest()[:12]
    return f"{CLIENT}_{re.sub('[^0-9]', '_', version)}_{digest}", version


@cache
def _packed(files: tuple[tuple[str, str], ...], names: tuple[str, ...], encode: Callable[[bytes], bytes]) -> str:
    """Modules of the client, compressed, as text in lines."""
    stamp = _stamped(files)[0]
    sources = [redirected(bare(dict(files)[name]), stamp, f"{CLIENT}/{name}.py") for name in names]
    data = encode(zlib.compress("\0".join(sources).encode("ascii"), 9)).decode("ascii")
    return "\n".join(data[i : i + 116] for i in range(0, len(data), 116))


def bare(source: str) -> str:
    """`source` without comments and docstrings, a space for each level; every statement stays in its line."""
    lines, inside = source.splitlines(keepends=True), set()
    for token in tokenize.generate_tokens(iter(lines).__next__):
        if token.type == tokenize.COMMENT:
            row, column = token.start
            lines[row - 1] = lines[row - 1][:column].rstrip() + "\n"
        if token.type == tokenize.STRING:
            inside |= set(range(token.start[0], token.end[0]))
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node, clean=False):
            first = node.body[0]
            start, end = first.lineno - 1, first.end_lineno or first.lineno
            lines[start] = lines[start][: first.col_offset] + ('""\n' if len(node.body) == 1 else "\n")
            lines[start + 1 : end] = ["\n"] * (end - start - 1)
    return "".join(line if i in inside else re.sub(r"^ +", _level, line) for i, line in enumerate(lines))


def _level(spaces: re.Match[str]) -> str:
    return " " * (len(spaces.group()) // 4)


def _order(sources: dict[str, str]) -> list[str]:
    """Modules so that each comes after those it imports when loaded; `__init__` first."""
    needs: dict[str, set[str]] = {"__init__": set()}
    for name in sorted(set(sources) - {"__init__"}):
        loaded = [modules for inside, modules in _imports(sources[name]) if not inside]
        needs[name] = {"__init__"}.union(*loaded) & set(sources)
    try:
        return list(TopologicalSorter(needs).static_order())
    except CycleError as error:
        raise InputError(CLIENT, f"has modules that import one another: {' > '.join(error.args[1])}.") from None


def _after_docstring(code: str) -> int:
    """The line after the docstring and `from __future__` imports, counted from 0."""
    cut = 0
    for i, node in enumerate(ast.parse(code).body):
        docstring = i == 0 and isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        if not docstring and not (isinstance(node, ast.ImportFrom) and node.module == "__future__"):
            break
        cut = node.end_lineno or 0
    comments = takewhile(lambda line: not line.strip() or line.startswith("#"), code.splitlines())
    return cut or len(list(comments))
